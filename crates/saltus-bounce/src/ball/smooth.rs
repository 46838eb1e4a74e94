//! Balls whose law of flight is smooth from one impact to the next: two modes, one edge.

use nalgebra::{Vector2, vector};
use saltus::{Automaton, Edges, Fall, Polynomial};

use super::Ball;
use crate::flight::{LinearDragFlight, VacuumFlight, VerticalFlight};
use crate::restitution::Restitution;

/// What the ball is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// In the air.
    Flight,
    /// Lying on the floor.
    Rest,
}

/// The one edge: the ball meets the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Floor;

/// A law of vertical flight whose acceleration is a smooth function of the velocity, upwards and downwards: no apex needs an edge.
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
    fn edges(&self, mode: Mode) -> Edges<Floor> {
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
    fn affine(&self, Floor: Floor) -> bool {
        true
    }

    #[inline]
    fn reset(&self, Floor: Floor, _t: f64, x: &Vector2<f64>) -> (Mode, Vector2<f64>) {
        let rebound = self.rebound(x[1]);
        let mode = if rebound > 0.0 { Mode::Flight } else { Mode::Rest };
        (mode, vector![0.0, rebound])
    }

    #[inline]
    fn exact(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Option<Polynomial<Vector2<f64>>> {
        match mode {
            Mode::Flight => self.flight.polynomial(x),
            Mode::Rest => Some(Polynomial::from([*x])),
        }
    }

    #[inline]
    fn flown(&self, _mode: Mode, _t: f64, x: &Vector2<f64>, s: f64) -> Option<Vector2<f64>> {
        // In flight: rest is solved exactly.
        Some(if s == 0.0 { *x } else { self.flight.after(s, x) })
    }

    #[inline]
    fn falls(&self, _mode: Mode, Floor: Floor, _t: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        self.flight.impact(x).map_or(Fall::Never, |impact| Fall::In(impact.time, vector![0.0, -impact.speed]))
    }

    fn beyond(&self, _mode: Mode, _t: f64, _x: &Vector2<f64>) -> Option<(Mode, Vector2<f64>)> {
        Some((Mode::Rest, vector![0.0, 0.0]))
    }
}
