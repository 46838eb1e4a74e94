//! The ball as a body: radius, mass, and where the mass sits.

use std::f64::consts::PI;

use crate::parameter::{ParameterError, between, positive};

/// A sphere: radius R in m, mass m in kg, moment of inertia I = α m R².
///
/// α is 2/5 for a solid ball, 2/3 for a thin shell, and lies between for a ball with a thick wall.
///
/// ```
/// use saltus_bounce::Sphere;
/// let tennis = Sphere::hollow(0.033, 0.058)?;
/// assert_eq!(tennis.inertia_factor(), 2.0 / 3.0);
/// assert!((tennis.density() - 385.3).abs() < 0.1);
/// assert!(Sphere::solid(0.0, 1.0).is_err());
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f64,
    mass: f64,
    inertia: f64,
}

impl Sphere {
    /// A sphere of `radius` in m and `mass` in kg, filled evenly: α = 2/5.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite and positive.
    pub fn solid(radius: f64, mass: f64) -> Result<Self, ParameterError> {
        Self::with_inertia(radius, mass, 2.0 / 5.0)
    }

    /// A thin spherical shell of `radius` in m and `mass` in kg: α = 2/3.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite and positive.
    pub fn hollow(radius: f64, mass: f64) -> Result<Self, ParameterError> {
        Self::with_inertia(radius, mass, 2.0 / 3.0)
    }

    /// A sphere whose moment of inertia is `factor` m R².
    ///
    /// # Errors
    /// [`ParameterError`] unless radius and mass are finite and positive and 0 < `factor` ≤ 2/3.
    pub fn with_inertia(radius: f64, mass: f64, factor: f64) -> Result<Self, ParameterError> {
        let what = "an inertia factor of a sphere";
        Ok(Self {
            radius: positive("a radius in m", radius)?,
            mass: positive("a mass in kg", mass)?,
            inertia: between(
                what,
                positive(what, factor)?,
                0.0,
                2.0 / 3.0,
                "a number above 0 and up to 2/3 (2/5 solid, 2/3 a thin shell)",
            )?,
        })
    }

    /// R in m.
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// m in kg.
    #[must_use]
    pub const fn mass(&self) -> f64 {
        self.mass
    }

    /// α = I/(m R²).
    #[must_use]
    pub const fn inertia_factor(&self) -> f64 {
        self.inertia
    }

    /// The area of the cross-section, πR², in m².
    #[must_use]
    pub const fn cross_section(&self) -> f64 {
        PI * self.radius * self.radius
    }

    /// Mass over volume, in kg/m³.
    #[must_use]
    pub const fn density(&self) -> f64 {
        0.75 * self.mass / (self.cross_section() * self.radius)
    }
}
