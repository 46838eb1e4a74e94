//! Drag in proportion to the square of the speed.

use nalgebra::SVector;

use super::jets::times;
use super::{Effect, JetMotion, JetSum, Motion, Spin};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::sphere::Sphere;

/// Quadratic drag: a = -k |v| v, k = ρ C A/(2m) in 1/m, v relative to the air.
///
/// ρ: density of the air in kg/m³ ([`AIR_DENSITY`](super::AIR_DENSITY)); C: drag coefficient; A:
/// area of the cross-section in m²; m in kg. C is nearly constant for Reynolds numbers between some
/// 10³ and the drag crisis (3×10⁵ for a smooth sphere): about 0.47 for a smooth sphere, 0.507 ±
/// 0.024 for new tennis balls (R. Cross and C. Lindsey, Sports Eng. 17, 89 (2014)).
///
/// In one dimension v|v| has a kink in its second derivative at v = 0: a flight of high order is
/// two arcs, rising and falling. Source: I. Newton, *Principia* (1687), book 2, section 7.
///
/// ```
/// use saltus_bounce::{Sphere, effects::{AIR_DENSITY, QuadraticDrag}};
/// let tennis = Sphere::hollow(0.033, 0.058)?;
/// let drag = QuadraticDrag::sphere(&tennis, AIR_DENSITY, 0.507)?;
/// assert!((drag.per_length() - 0.018_318).abs() < 1e-6);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticDrag {
    per_length: f64,
}

impl QuadraticDrag {
    /// Quadratic drag with k = `per_length` in 1/m.
    ///
    /// # Errors
    /// [`ParameterError`] unless it is finite and not negative.
    pub const fn new(per_length: f64) -> Result<Self, ParameterError> {
        match not_negative("a quadratic drag in 1/m", per_length) {
            Ok(per_length) => Ok(Self { per_length }),
            Err(error) => Err(error),
        }
    }

    /// The drag of a sphere in air of `density` in kg/m³, with the drag `coefficient` C.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite, the density positive, the coefficient not
    /// negative.
    pub fn sphere(ball: &Sphere, density: f64, coefficient: f64) -> Result<Self, ParameterError> {
        Self::body(ball.mass(), ball.cross_section(), density, coefficient)
    }

    /// The drag of a body of `mass` in kg with a cross-section of `area` in m², in air of `density`
    /// in kg/m³, with the drag `coefficient` C.
    ///
    /// # Errors
    /// [`ParameterError`] unless all are finite and positive; the coefficient may be zero.
    pub fn body(mass: f64, area: f64, density: f64, coefficient: f64) -> Result<Self, ParameterError> {
        let mass = positive("a mass in kg", mass)?;
        let area = positive("an area in m^2", area)?;
        let density = positive("a density in kg/m^3", density)?;
        Self::new(0.5 * density * not_negative("a drag coefficient", coefficient)? * area / mass)
    }

    /// k in 1/m.
    #[must_use]
    pub const fn per_length(self) -> f64 {
        self.per_length
    }
}

impl<const N: usize, S: Spin> Effect<N, S> for QuadraticDrag {
    #[inline]
    fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N> {
        motion.velocity * (-self.per_length * motion.velocity.norm())
    }

    /// v|v| is smooth wherever v is not zero, which only a ball that moves along a line passes.
    #[inline]
    fn kink(&self, motion: &Motion<N, S>) -> Option<f64> {
        (N == 1).then(|| motion.velocity[0])
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        let factor = motion.speed * -self.per_length;
        sum.accelerate(times(&motion.velocity, factor));
        true
    }
}
