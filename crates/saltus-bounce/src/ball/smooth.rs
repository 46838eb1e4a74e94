//! Balls whose law of flight is smooth from one impact to the next: two modes, one edge.

use nalgebra::{Vector2, vector};
use saltus::{About, Automaton, Edges, Fall, Limit, Polynomial, Refusal, Solution};

use super::Ball;
use crate::flight::{LinearDragFlight, VacuumFlight, VerticalFlight};
use crate::restitution::Restitution;

/// The mode of the ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Flight.
    Flight,
    /// Lying on the floor.
    Rest,
}

/// The one edge: the ball meets the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Floor;

/// A law of vertical flight whose acceleration is a smooth function of the velocity, upwards and
/// downwards: no apex needs an edge.
///
/// Quadratic drag, -k v|v|, is none: a ball under it has the modes of [`Phase`](super::Phase).
pub trait SmoothFlight: VerticalFlight {
    /// The flight from the state `x` as a polynomial in time, where it is one.
    #[inline]
    fn polynomial(&self, x: &Vector2<f64>) -> Option<Polynomial<Vector2<f64>>> {
        let _ = x;
        None
    }
}

impl SmoothFlight for VacuumFlight {
    #[inline]
    fn polynomial(&self, x: &Vector2<f64>) -> Option<Polynomial<Vector2<f64>>> {
        let a = self.acceleration(x[1]);
        Some(Polynomial::from([*x, vector![x[1], a], vector![0.5 * a, 0.0]]))
    }
}

impl SmoothFlight for LinearDragFlight {}

impl<F: SmoothFlight, R: Restitution> Ball<F, R> {
    /// A time `s` later in flight.
    fn flown(&self, _mode: Mode, _t: f64, x: &Vector2<f64>, s: f64) -> Vector2<f64> {
        if s == 0.0 { *x } else { self.flight.after(s, x) }
    }
}

impl<F: SmoothFlight, R: Restitution> Automaton for Ball<F, R> {
    type Mode = Mode;
    type State = Vector2<f64>;
    type Edge = Floor;

    #[inline]
    fn flow(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        match mode {
            Mode::Flight => vector![x[1], self.flight.acceleration(x[1])],
            Mode::Rest => vector![0.0, 0.0],
        }
    }

    #[inline]
    fn edges(&self, mode: Mode) -> Edges<'_, Floor> {
        match mode {
            Mode::Flight => Edges::from([Floor]),
            Mode::Rest => Edges::none(),
        }
    }

    #[inline]
    fn guard(&self, Floor: Floor, _t: f64, x: &Vector2<f64>) -> f64 {
        x[0]
    }

    #[inline]
    fn about(&self, Floor: Floor) -> About {
        About::new().affine()
    }

    #[inline]
    fn reset(&self, _: Mode, Floor: Floor, _t: f64, x: &Vector2<f64>) -> Result<(Mode, Vector2<f64>), Refusal> {
        let rebound = self.rebound(x[1]);
        let mode = if rebound > 0.0 { Mode::Flight } else { Mode::Rest };
        Ok((mode, vector![0.0, rebound]))
    }

    #[inline]
    fn solution(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Solution<Self> {
        match mode {
            Mode::Flight => self.flight.polynomial(x).map_or(Solution::Formula(Self::flown), Solution::Polynomial),
            Mode::Rest => Solution::Polynomial([*x].into()),
        }
    }

    #[inline]
    fn falls(&self, _mode: Mode, Floor: Floor, _t: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        self.flight.impact(x).map_or(Fall::Never, |impact| Fall::In(impact.time, vector![0.0, -impact.speed]))
    }

    fn beyond(&self, _: &Limit<'_, Self>) -> Option<(Mode, Vector2<f64>)> {
        Some((Mode::Rest, vector![0.0, 0.0]))
    }
}
