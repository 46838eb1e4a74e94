//! Restitution that changes linearly with the speed of impact.

use super::{Cor, Restitution};
use crate::parameter::{ParameterError, finite, not_negative};

/// e(v) = e₀ + b v between two speeds, constant below and above them.
///
/// v: speed of impact in m/s; b in s/m. What a fit of rebounds over a moderate range of heights
/// gives: beyond the range measured the law does not extrapolate. Source: R. Cross, Am. J. Phys.
/// 67, 222 (1999), doi:10.1119/1.19229, measures such slopes.
///
/// ```
/// use saltus_bounce::restitution::{Cor, Linear, Restitution};
/// let law = Linear::new(Cor::new(0.8)?, -0.02, 1.0, 5.0)?;
/// assert_eq!(law.cor(2.0).value(), 0.76);
/// assert_eq!(law.cor(0.0), law.cor(1.0));
/// assert_eq!(law.rebound(100.0), 70.0);
/// assert!(Linear::new(Cor::new(0.8)?, 0.1, 0.0, 5.0).is_err()); // 1.3 at 5 m/s
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    at_rest: f64,
    slope: f64,
    slowest: f64,
    fastest: f64,
}

impl Linear {
    /// The line through `at_rest` at v = 0 with `slope` in s/m, used between the speeds `slowest`
    /// and `fastest` in m/s.
    ///
    /// # Errors
    /// [`ParameterError`] if a number is not finite, the speeds are negative or out of order, or e
    /// leaves 0..=1 between them.
    pub fn new(at_rest: Cor, slope: f64, slowest: f64, fastest: f64) -> Result<Self, ParameterError> {
        let slope = finite("a slope of e over speed in s/m", slope)?;
        let slowest = not_negative("a speed in m/s", slowest)?;
        let fastest = not_negative("a speed in m/s", fastest)?;
        if fastest < slowest {
            return Err(ParameterError::new("the fastest of two speeds", fastest, "the slower speed first"));
        }
        let law = Self { at_rest: at_rest.value(), slope, slowest, fastest };
        for speed in [slowest, fastest] {
            let e = law.at_rest + slope * speed;
            if !(0.0..=1.0).contains(&e) {
                return Err(ParameterError::new(
                    "a coefficient of restitution",
                    e,
                    "a slope and a range of speeds within which e stays between 0 and 1",
                ));
            }
        }
        Ok(law)
    }

    /// e at the speed `impact` in m/s.
    #[must_use]
    pub fn cor(&self, impact: f64) -> Cor {
        Cor::within(self.at_rest + self.slope * impact.clamp(self.slowest, self.fastest))
    }
}

impl Restitution for Linear {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        self.cor(impact).rebound(impact)
    }
}
