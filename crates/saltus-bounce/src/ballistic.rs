//! Free flight and constant restitution in closed form: when the ball lands, how high it flies,
//! when it comes to rest.

use crate::restitution::Cor;

/// A ball dropped from rest at height h onto a level floor, with constant gravity g and constant
/// COR e, in closed form.
///
/// With t₀ = √(2h/g), for n = 1, 2, …:
/// impact n at tₙ = t₀ (1 + 2 (e + … + eⁿ⁻¹)), apex n at height h e²ⁿ, rest at t₀ (1 + e)/(1 - e).
///
/// Units: m, s, m/s². The reference against which stepped runs are checked, and the model that the
/// fit uses.
///
/// ```
/// use saltus_bounce::{Cor, Drop};
/// let drop = Drop::new(1.0, 9.8, Cor::new(0.5)?);
/// assert!((drop.impact_time(1) - 0.451_753_951_452_625_6).abs() < 1e-15);
/// assert_eq!(drop.apex_height(1), 0.25);
/// assert!((drop.rest_time().unwrap() - 1.355_261_854_357_876_8).abs() < 1e-15);
/// # Ok::<(), saltus_bounce::CorError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    height: f64,
    gravity: f64,
    cor: Cor,
}

impl Drop {
    /// A drop from `height` in m under `gravity` in m/s², both positive (otherwise the times are
    /// not numbers).
    #[must_use]
    pub const fn new(height: f64, gravity: f64, cor: Cor) -> Self {
        Self { height, gravity, cor }
    }

    /// The time of the fall to the floor, t₀ = √(2h/g), in s.
    #[must_use]
    pub fn fall_time(&self) -> f64 {
        (2.0 * self.height / self.gravity).sqrt()
    }

    /// The time of impact `n`, counted from 1, in s; 0 for `n` = 0.
    #[must_use]
    pub fn impact_time(&self, n: u32) -> f64 {
        if n == 0 {
            return 0.0;
        }
        self.fall_time() * (1.0 + 2.0 * (self.geometric_sum(n) - 1.0))
    }

    /// The height of the apex after impact `n`, h e²ⁿ, in m.
    #[must_use]
    pub fn apex_height(&self, n: u32) -> f64 {
        self.height * self.cor.value().powf(2.0 * f64::from(n))
    }

    /// The time when the bounces have died out, t₀ (1 + e)/(1 - e), in s; `None` for e = 1, which
    /// never rests.
    #[must_use]
    pub fn rest_time(&self) -> Option<f64> {
        let e = self.cor.value();
        (e < 1.0).then(|| self.fall_time() * (1.0 + e) / (1.0 - e))
    }

    /// 1 + e + … + eⁿ⁻¹, without cancellation near e = 1.
    fn geometric_sum(&self, n: u32) -> f64 {
        let e = self.cor.value();
        if n <= 64 {
            return (0..n).fold(0.0, |sum, _| sum * e + 1.0);
        }
        if e == 1.0 { f64::from(n) } else { -(f64::from(n) * e.ln()).exp_m1() / (1.0 - e) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_elastic_ball_keeps_its_beat() {
        let drop = Drop::new(45.0, 10.0, Cor::new(1.0).unwrap());
        assert_eq!([1, 2, 3].map(|n| drop.impact_time(n)), [3.0, 9.0, 15.0]);
        assert_eq!(drop.impact_time(1000), 3.0 * 1999.0);
        assert_eq!(drop.rest_time(), None);
    }

    #[test]
    fn a_plastic_ball_lands_once() {
        let drop = Drop::new(1.0, 9.8, Cor::new(0.0).unwrap());
        assert_eq!(drop.rest_time(), Some(drop.impact_time(1)));
        assert_eq!(drop.apex_height(1), 0.0);
    }

    proptest! {
        #[test]
        fn impacts_follow_each_other_by_the_flight_time(e in 0.0..=1.0_f64, n in 1_u32..200) {
            let drop = Drop::new(2.0, 9.81, Cor::new(e).unwrap());
            let flight = drop.impact_time(n + 1) - drop.impact_time(n);
            let expected = 2.0 * drop.fall_time() * e.powf(f64::from(n));
            prop_assert!((flight - expected).abs() <= 4e-14 * drop.impact_time(n));
        }
    }
}
