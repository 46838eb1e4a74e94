//! Elastic contact of spheres.

use super::{Collision, ContactLaw, happens};
use crate::parameter::{ParameterError, between, positive};
use crate::restitution::Cor;

/// T v/d of a Hertz collision: (4√π/5) Γ(2/5)/Γ(9/10).
const DURATION: f64 = 2.943_275_184_324_704_7;

/// Hertz contact: F = k d^(3/2), without loss.
///
/// k in N/m^(3/2); for a sphere of radius R on a plane k = (4/3) E √R, 1/E = (1 - ν₁²)/E₁ + (1 -
/// ν₂²)/E₂. A collision deforms by d = (5 m v²/(4k))^(2/5), lasts 2.9433 d/v, and ends with e = 1.
///
/// Limits: deformations small against R, slow against the speed of sound, no friction, no plastic
/// flow. The force is only once differentiable at d = 0. Source: H. Hertz, J. reine angew. Math.
/// 92, 156 (1882), doi:10.1515/crll.1882.92.156.
///
/// ```
/// use saltus_bounce::contact::{ContactLaw, Elastic, Hertz};
/// let steel = Elastic::new(210e9, 0.3)?;
/// let law = Hertz::sphere(0.01, steel, steel)?;
/// let hit = law.collision(0.0327, 1.0).unwrap(); // a ball of 2 cm at 1 m/s
/// assert!((hit.duration * 1e6 - 68.957).abs() < 1e-3);
/// assert_eq!(hit.cor.value(), 1.0);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    constant: f64,
}

/// The elasticity of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    young: f64,
    poisson: f64,
}

impl Elastic {
    /// Young's modulus in Pa and Poisson's ratio.
    ///
    /// # Errors
    /// [`ParameterError`] unless the modulus is finite and positive and the ratio between -1 and
    /// 1/2.
    pub fn new(young: f64, poisson: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            young: positive("Young's modulus in Pa", young)?,
            poisson: between("Poisson's ratio", poisson, -1.0, 0.5, "a number from -1 to 0.5 (0.3 for steel)")?,
        })
    }

    /// (1 - ν²)/E in 1/Pa.
    fn compliance(self) -> f64 {
        (1.0 - self.poisson) * (1.0 + self.poisson) / self.young
    }
}

impl Hertz {
    /// A Hertz contact with k = `constant` in N/m^(3/2).
    ///
    /// # Errors
    /// [`ParameterError`] unless it is finite and positive.
    pub const fn new(constant: f64) -> Result<Self, ParameterError> {
        match positive("a Hertz stiffness in N/m^1.5", constant) {
            Ok(constant) => Ok(Self { constant }),
            Err(error) => Err(error),
        }
    }

    /// The contact of a ball of `radius` in m on a flat floor.
    ///
    /// # Errors
    /// [`ParameterError`] unless the radius is finite and positive, and one of the two bodies at
    /// least is compressible along the surface (Poisson's ratio not -1).
    pub fn sphere(radius: f64, ball: Elastic, floor: Elastic) -> Result<Self, ParameterError> {
        let radius = positive("a radius in m", radius)?;
        Self::new(4.0 / 3.0 * radius.sqrt() / (ball.compliance() + floor.compliance()))
    }

    /// The law by which `mass` in kg at `speed` in m/s is in contact for `duration` in s.
    ///
    /// # Errors
    /// [`ParameterError`] unless all are finite and positive.
    pub fn from_collision(mass: f64, speed: f64, duration: f64) -> Result<Self, ParameterError> {
        let m = positive("a mass in kg", mass)?;
        let v = positive("a speed in m/s", speed)?;
        let d = positive("a duration in s", duration)? * v / DURATION;
        Self::new(1.25 * m * v * v / (d * d * d.sqrt()))
    }

    /// k in N/m^(3/2).
    #[must_use]
    pub const fn constant(self) -> f64 {
        self.constant
    }
}

impl ContactLaw for Hertz {
    #[inline]
    fn force(&self, deformation: f64, _rate: f64) -> f64 {
        let d = deformation.max(0.0);
        self.constant * d * d.sqrt()
    }

    #[inline]
    fn stiffness(&self, deformation: f64, _rate: f64) -> f64 {
        1.5 * self.constant * deformation.max(0.0).sqrt()
    }

    #[inline]
    fn damping(&self, _deformation: f64, _rate: f64) -> f64 {
        0.0
    }

    fn collision(&self, mass: f64, speed: f64) -> Option<Collision> {
        happens(mass, speed).then(|| {
            let deformation = (1.25 * mass / self.constant * speed * speed).powf(0.4);
            let duration = DURATION * deformation / speed;
            Collision {
                cor: Cor::within(1.0),
                duration,
                compression: 0.5 * duration,
                deformation,
                force: self.force(deformation, 0.0),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_planted_duration(log_t in -6.0..0.0_f64, m in 1e-3..10.0_f64, v in 1e-3..100.0_f64) {
            let t = 10.0_f64.powf(log_t);
            let hit = Hertz::from_collision(m, v, t).unwrap().collision(m, v).unwrap();
            prop_assert!((hit.duration / t - 1.0).abs() < 1e-14);
        }
    }
}
