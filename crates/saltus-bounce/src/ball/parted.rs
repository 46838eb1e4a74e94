//! Balls under quadratic drag, whose law of flight is smooth on either side of the apex: rising and
//! falling are two modes.

use nalgebra::{Vector2, vector};
use saltus::{About, Automaton, Edges, Entry, Fall, Limit, Refusal, Solution};

use super::Ball;
use crate::flight::{QuadraticDragFlight, VerticalFlight};
use crate::restitution::Restitution;

/// The phase of a ball under quadratic drag: rising, falling, or at rest.
///
/// ```
/// use saltus_bounce::{Ball, Phase};
/// assert_eq!(Phase::of(&Ball::launched_from(0.0, 3.0)), Phase::Rising);
/// assert_eq!(Phase::of(&Ball::dropped_from(1.0)), Phase::Falling);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// v' = -g - k v², until the apex.
    Rising,
    /// v' = -g + k v², until the floor.
    Falling,
    /// Lying on the floor.
    Rest,
}

impl Phase {
    /// The phase in which a flight starts from the state `x`.
    #[must_use]
    pub fn of(x: &Vector2<f64>) -> Self {
        if x[1] > 0.0 { Self::Rising } else { Self::Falling }
    }
}

/// The end of a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// v falls through zero.
    Apex,
    /// The ball meets the floor.
    Floor,
}

impl<R: Restitution> Ball<QuadraticDragFlight, R> {
    /// A time `s` later in flight.
    fn flown(&self, _phase: Phase, _t: f64, x: &Vector2<f64>, s: f64) -> Vector2<f64> {
        if s == 0.0 { *x } else { self.flight.after(s, x) }
    }
}

impl<R: Restitution> Automaton for Ball<QuadraticDragFlight, R> {
    type Mode = Phase;
    type State = Vector2<f64>;
    type Edge = Turn;

    #[inline]
    fn flow(&self, phase: Phase, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        match phase {
            // Smooth past the apex, so that a step that ends beyond it is no shorter for that.
            Phase::Rising => vector![x[1], self.flight.rising(x[1])],
            // A ball thrown upwards that is called falling rises first.
            Phase::Falling => vector![x[1], self.flight.acceleration(x[1])],
            Phase::Rest => vector![0.0, 0.0],
        }
    }

    #[inline]
    fn edges(&self, phase: Phase) -> Edges<'_, Turn> {
        match phase {
            Phase::Rising => Edges::from([Turn::Apex]),
            Phase::Falling => Edges::from([Turn::Floor]),
            Phase::Rest => Edges::none(),
        }
    }

    #[inline]
    fn guard(&self, turn: Turn, _t: f64, x: &Vector2<f64>) -> f64 {
        match turn {
            Turn::Apex => x[1],
            Turn::Floor => x[0],
        }
    }

    /// A start that is called rising and falls goes on falling.
    #[inline]
    fn about(&self, turn: Turn) -> About {
        let entry = if turn == Turn::Apex { Entry::Fire } else { Entry::Refuse };
        About::new().entry(entry).affine()
    }

    #[inline]
    fn reset(&self, _: Phase, turn: Turn, _t: f64, x: &Vector2<f64>) -> Result<(Phase, Vector2<f64>), Refusal> {
        Ok(match turn {
            Turn::Apex => (Phase::Falling, vector![x[0], x[1].min(0.0)]),
            Turn::Floor => {
                let rebound = self.rebound(x[1]);
                (if rebound > 0.0 { Phase::Rising } else { Phase::Rest }, vector![0.0, rebound])
            }
        })
    }

    #[inline]
    fn solution(&self, phase: Phase, _t: f64, x: &Vector2<f64>) -> Solution<Self> {
        match phase {
            Phase::Rising | Phase::Falling => Solution::Formula(Self::flown),
            Phase::Rest => Solution::Polynomial([*x].into()),
        }
    }

    #[inline]
    fn falls(&self, _phase: Phase, turn: Turn, _t: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        let arrival = match turn {
            Turn::Apex => self.flight.apex(x[1]).map(|apex| Fall::In(apex.time, vector![x[0] + apex.rise, 0.0])),
            Turn::Floor => self.flight.impact(x).map(|impact| Fall::In(impact.time, vector![0.0, -impact.speed])),
        };
        arrival.unwrap_or(Fall::Never)
    }

    fn beyond(&self, _: &Limit<'_, Self>) -> Option<(Phase, Vector2<f64>)> {
        Some((Phase::Rest, vector![0.0, 0.0]))
    }
}
