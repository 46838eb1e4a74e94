//! Restitution of bodies that yield: e falls with the fourth root of the speed.

use super::{Cor, Restitution};
use crate::parameter::{ParameterError, positive};

/// A plastic impact: e = (v₁/v)^(1/4) above the speed v₁, e = 1 below it.
///
/// Speeds in m/s. The fourth root is the asymptote for a sphere indenting a body with a constant
/// mean contact pressure; v₁ is where it reaches 1. The speed at which yield first begins is a
/// little lower, and the true curve leaves 1 smoothly there: near v₁ the law overestimates e.
/// Source: K. L. Johnson, *Contact Mechanics* (1985), section 11.5, doi:10.1017/CBO9781139171731.
///
/// ```
/// use saltus_bounce::restitution::{Plastic, Restitution};
/// let steel = Plastic::new(0.1)?;
/// assert_eq!(steel.rebound(0.05), 0.05);
/// assert!((steel.rebound(1.6) - 0.8).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    yield_speed: f64,
}

impl Plastic {
    /// Plastic impact with e = 1 up to `yield_speed` in m/s.
    ///
    /// # Errors
    /// [`ParameterError`] unless `yield_speed` is finite and positive.
    pub const fn new(yield_speed: f64) -> Result<Self, ParameterError> {
        match positive("a yield speed in m/s", yield_speed) {
            Ok(yield_speed) => Ok(Self { yield_speed }),
            Err(error) => Err(error),
        }
    }

    /// The law that gives `cor` at the speed `impact` in m/s, which is to be above yield: v₁ = e⁴
    /// v.
    ///
    /// # Errors
    /// [`ParameterError`] unless `cor` is above zero and `impact` is finite and positive.
    pub fn through(cor: Cor, impact: f64) -> Result<Self, ParameterError> {
        let e = positive("a coefficient of restitution of a plastic impact", cor.value())?;
        Self::new(e.powi(4) * positive("a speed of impact in m/s", impact)?)
    }

    /// e at the speed `impact` in m/s.
    #[must_use]
    pub fn cor(&self, impact: f64) -> Cor {
        if impact <= self.yield_speed {
            Cor::within(1.0)
        } else {
            Cor::within((self.yield_speed / impact).sqrt().sqrt())
        }
    }
}

impl Restitution for Plastic {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        self.cor(impact).rebound(impact)
    }
}
