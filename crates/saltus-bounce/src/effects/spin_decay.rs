//! Spin that the air slows down.

use nalgebra::SVector;

use super::jets::times;
use super::{Effect, JetMotion, JetSum, Motion, Spin};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::sphere::Sphere;

/// Decay of spin: ω' = -(1/τ) ω, or ω' = -C (|v|/R) ω. No acceleration.
///
/// τ: a time constant in s, for spin at a nearly constant speed. C: measured 2×10⁻⁵ for golf balls,
/// about 4 % a second at the start of a drive; v relative to the air in m/s, R in m. Source: A. J.
/// Smits and D. R. Smith, *A new aerodynamic model of a golf ball in flight*, in Science and Golf
/// II (1994), 340-347.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::{Sphere, effects::{Effect, Motion, SpinDecay}};
/// let golf = Sphere::solid(0.02134, 0.04593)?;
/// let motion = Motion { t: 0.0, position: vector![0.0, 0.0], velocity: vector![60.0, 0.0], spin: 300.0 };
/// let rate = SpinDecay::in_flight(&golf, 2e-5)?.spin_rate(&motion);
/// assert!((rate / 300.0 + 0.0562).abs() < 1e-4);
/// assert_eq!(SpinDecay::within(20.0)?.spin_rate(&motion), -15.0);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinDecay {
    /// 1/τ in 1/s.
    steady: f64,
    /// C/R in 1/m.
    per_length: f64,
}

impl SpinDecay {
    /// A decay to a fraction 1/e within `time` τ in s, whatever the speed.
    ///
    /// # Errors
    /// [`ParameterError`] unless τ is finite and positive.
    pub fn within(time: f64) -> Result<Self, ParameterError> {
        Ok(Self { steady: 1.0 / positive("a time constant in s", time)?, per_length: 0.0 })
    }

    /// A decay in proportion to the speed, with the `coefficient` C.
    ///
    /// # Errors
    /// [`ParameterError`] unless C is finite and not negative.
    pub fn in_flight(ball: &Sphere, coefficient: f64) -> Result<Self, ParameterError> {
        Ok(Self { steady: 0.0, per_length: not_negative("a coefficient of spin decay", coefficient)? / ball.radius() })
    }
}

macro_rules! decay {
    ($n:literal, $spin:ty) => {
        impl Effect<$n, $spin> for SpinDecay {
            #[inline]
            fn acceleration(&self, _motion: &Motion<$n, $spin>) -> SVector<f64, $n> {
                SVector::zeros()
            }

            #[inline]
            fn spin_rate(&self, motion: &Motion<$n, $spin>) -> $spin {
                motion.spin.times(-(self.steady + self.per_length * motion.velocity.norm()))
            }

            #[inline(always)]
            fn series<'j>(&self, motion: &JetMotion<'j, $n>, sum: &mut JetSum<'j, $n>) -> bool {
                let rate = if self.per_length == 0.0 {
                    (-self.steady).into()
                } else {
                    motion.speed * -self.per_length - self.steady
                };
                sum.turn(times(&motion.spin, rate));
                true
            }
        }
    };
}

decay!(2, f64);
decay!(3, nalgebra::Vector3<f64>);
