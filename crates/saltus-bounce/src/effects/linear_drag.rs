//! Drag in proportion to the speed.

use std::f64::consts::PI;

use nalgebra::SVector;

use super::jets::times;
use super::{Effect, JetMotion, JetSum, Motion, Spin};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::sphere::Sphere;

/// Linear drag: a = -c v, c in 1/s, v relative to the air.
///
/// For slow, small bodies in a viscous fluid: Reynolds numbers 2Rvρ/μ below 1, where c = 6πμR/m.
/// Balls in air are beyond it. Source: G. G. Stokes, Trans. Cambridge Phil. Soc. 9, 8 (1851).
///
/// ```
/// use saltus_bounce::{Sphere, effects::LinearDrag};
/// let bead = Sphere::solid(1e-4, 1e-8)?;
/// let drag = LinearDrag::stokes(&bead, 1.0)?; // glycerine, about 1 Pa s
/// assert!((drag.rate() - 188_495.559_215_387_6).abs() < 1e-9);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearDrag {
    rate: f64,
}

impl LinearDrag {
    /// Linear drag with c = `rate` in 1/s.
    ///
    /// # Errors
    /// [`ParameterError`] unless it is finite and not negative.
    pub const fn new(rate: f64) -> Result<Self, ParameterError> {
        match not_negative("a drag rate in 1/s", rate) {
            Ok(rate) => Ok(Self { rate }),
            Err(error) => Err(error),
        }
    }

    /// Stokes drag of a sphere in a fluid of `viscosity` μ in Pa s: c = 6πμR/m.
    ///
    /// # Errors
    /// [`ParameterError`] unless the viscosity is finite and positive.
    pub fn stokes(ball: &Sphere, viscosity: f64) -> Result<Self, ParameterError> {
        Self::new(6.0 * PI * positive("a viscosity in Pa s", viscosity)? * ball.radius() / ball.mass())
    }

    /// c in 1/s.
    #[must_use]
    pub const fn rate(self) -> f64 {
        self.rate
    }
}

impl<const N: usize, S: Spin> Effect<N, S> for LinearDrag {
    #[inline]
    fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N> {
        motion.velocity * -self.rate
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        sum.accelerate(times(&motion.velocity, (-self.rate).into()));
        true
    }
}
