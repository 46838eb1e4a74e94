//! Vertical flight under gravity alone.

use nalgebra::{Vector2, vector};

use super::{Apex, Impact, VerticalFlight};
use crate::parameter::{ParameterError, not_negative};

/// v' = -g: v = v₀ - g s, y = y₀ + v₀ s - g s²/2.
///
/// The apex is at s = v₀/g, v₀²/(2g) above the start; a fall through h from speed u downwards takes
/// 2h/(u + w) and ends at the speed w = √(u² + 2gh). SI units. Source: G. Galilei, *Discorsi*
/// (1638), third day.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::flight::{Impact, VacuumFlight, VerticalFlight};
/// let flight = VacuumFlight::new(10.0)?;
/// assert_eq!(flight.impact(&vector![45.0, 0.0]), Some(Impact { time: 3.0, speed: 30.0 }));
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VacuumFlight {
    gravity: f64,
}

impl VacuumFlight {
    /// A flight under `gravity` in m/s², downwards.
    ///
    /// # Errors
    /// [`ParameterError`] unless `gravity` is finite and not negative.
    pub const fn new(gravity: f64) -> Result<Self, ParameterError> {
        match not_negative("a gravity in m/s^2", gravity) {
            Ok(gravity) => Ok(Self { gravity }),
            Err(error) => Err(error),
        }
    }
}

impl VerticalFlight for VacuumFlight {
    #[inline]
    fn acceleration(&self, _velocity: f64) -> f64 {
        -self.gravity
    }

    #[inline]
    fn after(&self, s: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let g = self.gravity;
        vector![x[0] + s * (x[1] - 0.5 * g * s), x[1] - g * s]
    }

    #[inline]
    fn apex(&self, velocity: f64) -> Option<Apex> {
        let g = self.gravity;
        (velocity > 0.0 && g > 0.0).then(|| Apex { time: velocity / g, rise: 0.5 * velocity * (velocity / g) })
    }

    #[inline]
    fn fall(&self, depth: f64, speed: f64) -> Option<Impact> {
        let w = (2.0 * self.gravity * depth + speed * speed).sqrt();
        if depth == 0.0 {
            return Some(Impact { time: 0.0, speed });
        }
        (w > 0.0).then(|| Impact { time: 2.0 * depth / (speed + w), speed: w })
    }

    /// As for every flight; on the way up too without the apex in between.
    #[inline]
    fn impact(&self, x: &Vector2<f64>) -> Option<Impact> {
        let (y, v, g) = (x[0], x[1], self.gravity);
        if v <= 0.0 {
            return if y >= 0.0 { self.fall(y, -v) } else { None };
        }
        if y == 0.0 {
            // As a branch: where the processor foresees it, no impact waits for the square root of
            // the one before.
            return (g > 0.0).then(|| Impact { time: 2.0 * v / g, speed: v });
        }
        let square = v * v + 2.0 * g * y;
        (g > 0.0 && square >= 0.0).then(|| {
            let w = square.sqrt();
            Impact { time: (v + w) / g, speed: w }
        })
    }
}
