//! Vertical flight with linear drag.

use nalgebra::{Vector2, vector};

use super::{Apex, Impact, VacuumFlight, VerticalFlight};
use crate::parameter::{ParameterError, not_negative};
use crate::stable::{increasing_root, log_excess, log_ratio, phi1, phi2};

/// v' = -g - c v: v = v₀ e^(-cs) - g s φ₁(-cs), y = y₀ + v₀ s φ₁(-cs) - g s² φ₂(-cs).
///
/// g in m/s², c in 1/s; φ₁(z) = (eᶻ - 1)/z, φ₂(z) = (eᶻ - 1 - z)/z². The apex is at s = ln(1 +
/// cv₀/g)/c. The time of a fall is Newton's root of the height: a Lambert function, whose arguments
/// cancel where drag is weak, while this does not. Terminal velocity g/c.
///
/// For a sphere of radius R and mass m in a fluid of viscosity μ, c = 6πμR/m, at Reynolds numbers
/// below 1. Source: G. G. Stokes, Trans. Cambridge Phil. Soc. 9, 8 (1851).
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::flight::{LinearDragFlight, VerticalFlight};
/// let flight = LinearDragFlight::new(9.81, 0.5)?;
/// let impact = flight.impact(&vector![20.0, 0.0]).unwrap();
/// assert!((impact.time - 2.424_234_946_397_889).abs() < 1e-14);
/// assert!((impact.speed - 13.781_744_824_163_3).abs() < 1e-13);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearDragFlight {
    gravity: f64,
    drag: f64,
}

impl LinearDragFlight {
    /// A flight under `gravity` in m/s² with the drag rate c = `drag` in 1/s.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite and not negative.
    pub fn new(gravity: f64, drag: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            gravity: not_negative("a gravity in m/s^2", gravity)?,
            drag: not_negative("a drag rate in 1/s", drag)?,
        })
    }

    /// The depth fallen after `s` seconds from `speed` downwards, and the speed then: sums of
    /// positive terms.
    fn fallen(&self, s: f64, speed: f64) -> (f64, f64) {
        let (g, c, z) = (self.gravity, self.drag, -self.drag * s);
        // (1 - e^(-cs))/c and its integral, without dividing by a small c.
        let (span, area) = if z < -1.0 {
            let span = -z.exp_m1() / c;
            (span, (s - span) / c)
        } else {
            (s * phi1(z), s * s * phi2(z))
        };
        (speed * span + g * area, speed * z.exp() + g * span)
    }
}

impl VerticalFlight for LinearDragFlight {
    #[inline]
    fn acceleration(&self, velocity: f64) -> f64 {
        -self.gravity - self.drag * velocity
    }

    #[inline]
    fn after(&self, s: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let (depth, speed) = self.fallen(s, -x[1]);
        vector![x[0] - depth, -speed]
    }

    fn apex(&self, velocity: f64) -> Option<Apex> {
        let g = self.gravity;
        (velocity > 0.0 && g > 0.0).then(|| {
            let (time, z) = (velocity / g, self.drag * (velocity / g));
            Apex { time: time * log_ratio(z), rise: velocity * (time * log_excess(z)) }
        })
    }

    fn fall(&self, depth: f64, speed: f64) -> Option<Impact> {
        let (g, c) = (self.gravity, self.drag);
        if g == 0.0 {
            // The speed lost is c times the depth: beyond the stopping distance nothing arrives.
            let left = speed - c * depth;
            return if depth == 0.0 {
                Some(Impact { time: 0.0, speed })
            } else {
                (left > 0.0).then(|| Impact { time: depth / speed * log_ratio(-c * depth / speed), speed: left })
            };
        }
        // Drag delays: the fall takes longer than in a vacuum. And depth = (g/c) s - (g/c -
        // speed)(1 - e^(-cs))/c, whose last factor lies between 0 and 1: the root lies between
        // where it is 0 and where it is 1.
        let early = VacuumFlight::new(g).ok()?.fall(depth, speed)?.time;
        if early == 0.0 || c == 0.0 {
            return Some(Impact { time: early, speed: self.fallen(early, speed).1 });
        }
        let terminal = c / g * depth;
        let settled = terminal + (1.0 - speed * (c / g)) / c;
        let steady = |s: f64| {
            let (fallen, rate) = self.fallen(s, speed);
            (fallen - depth, rate)
        };
        let low = early.max(terminal.min(settled));
        let high = terminal.max(settled).max(2.0 * low);
        let time = increasing_root(steady, low, high, low);
        Some(Impact { time, speed: self.fallen(time, speed).1 })
    }
}
