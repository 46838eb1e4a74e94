//! How much speed an impact leaves: the coefficient of restitution, constant or dependent on the
//! speed of impact.
//!
//! [`Cor`] is one number; [`Linear`], [`Knots`], [`Viscoelastic`] and [`Plastic`] depend on the
//! speed. All are [`Restitution`] laws, and none ever returns more speed than it was given.

mod knots;
mod linear;
mod plastic;
mod viscoelastic;

use std::fmt;

use crate::walls::Face;

pub use knots::{Knots, KnotsError};
pub use linear::Linear;
pub use plastic::Plastic;
pub use viscoelastic::Viscoelastic;

/// A law of normal impact: v⁺ = -e(v⁻) v⁻.
///
/// Guaranteed for every `impact` ≥ 0 and finite: 0 ≤ `rebound(impact)` ≤ `impact`, so that no
/// impact gains energy, and `rebound(0)` = 0. Speeds in m/s, normal to the wall and relative to it.
///
/// ```
/// use saltus_bounce::restitution::{Cor, Linear, Restitution};
/// let laws: [&dyn Restitution; 2] = [&Cor::new(0.8)?, &Linear::new(Cor::new(0.75)?, -0.0125, 0.0, 20.0)?];
/// assert_eq!(laws.map(|law| law.rebound(10.0)), [8.0, 6.25]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Restitution {
    /// The speed of rebound after an impact at the speed `impact`, both in m/s and not negative.
    fn rebound(&self, impact: f64) -> f64;

    /// The law of one face of the walls, where faces differ; the default is the same for all.
    #[inline]
    fn on(&self, face: Face) -> impl Restitution
    where
        Self: Sized,
    {
        let _ = face;
        self
    }
}

impl Restitution for Cor {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        Self::rebound(*self, impact)
    }
}

impl<R: Restitution + ?Sized> Restitution for &R {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        (**self).rebound(impact)
    }
}

/// A coefficient of restitution (COR) e: the rebound speed over the impact speed, v⁺ = -e v⁻ normal
/// to the floor.
///
/// Dimensionless, 0 ≤ e ≤ 1: at 0 the ball stays where it lands, at 1 it loses nothing. No other
/// value exists, by type. Source: I. Newton, *Principia* (1687), scholium to the laws of motion,
/// corollary 6.
///
/// ```
/// use saltus_bounce::Cor;
/// let e = Cor::new(0.55)?;
/// assert_eq!(e.rebound(2.0), 1.1);
/// assert!(Cor::new(1.2).is_err());
/// # Ok::<(), saltus_bounce::CorError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Cor(f64);

impl Cor {
    /// A coefficient of restitution of `value`.
    ///
    /// # Errors
    /// [`CorError`] unless 0 ≤ `value` ≤ 1.
    pub const fn new(value: f64) -> Result<Self, CorError> {
        if value >= 0.0 && value <= 1.0 { Ok(Self(value)) } else { Err(CorError { value }) }
    }

    /// The COR that a drop from `drop` and a rebound to `rebound` show, e = √(rebound / drop); both
    /// heights in one unit, above the floor.
    ///
    /// # Errors
    /// [`CorError`] if that is not between 0 and 1: a rebound above the drop, a negative height, a
    /// drop of zero.
    ///
    /// ```
    /// use saltus_bounce::Cor;
    /// assert_eq!(Cor::from_heights(100.0, 25.0)?.value(), 0.5);
    /// # Ok::<(), saltus_bounce::CorError>(())
    /// ```
    pub fn from_heights(drop: f64, rebound: f64) -> Result<Self, CorError> {
        Self::new((rebound / drop).sqrt())
    }

    /// The coefficient nearest to `value`, which a law has kept within 0..=1 but for rounding; what
    /// is not a number gives 0.
    ///
    /// ```
    /// use saltus_bounce::Cor;
    /// assert_eq!([1.0 + f64::EPSILON, 0.3, f64::NAN].map(|e| Cor::within(e).value()), [1.0, 0.3, 0.0]);
    /// ```
    #[must_use]
    pub const fn within(value: f64) -> Self {
        Self(value.max(0.0).min(1.0))
    }

    /// The number e.
    #[must_use]
    pub const fn value(self) -> f64 {
        self.0
    }

    /// The rebound speed for an impact speed, both in m/s and not negative.
    #[must_use]
    pub const fn rebound(self, impact: f64) -> f64 {
        self.0 * impact
    }
}

impl fmt::Display for Cor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A number that is no coefficient of restitution.
#[derive(Clone, Copy, PartialEq)]
pub struct CorError {
    value: f64,
}

impl fmt::Display for CorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} is not a coefficient of restitution: give a number from 0 (stays where it lands) to 1 (loses nothing)",
            self.value
        )
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for CorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for CorError {}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cor(e: f64) -> Cor {
        Cor::new(e).unwrap()
    }

    proptest! {
        /// Whatever the law and its parameters, no impact gains speed, and none turns it round.
        #[test]
        fn no_law_gains_energy(
            e in 0.0..=1.0_f64, other in 0.0..=1.0_f64, top in 1e-3..1e3_f64, log_v in -300.0..300.0_f64, scale in -6.0..6.0_f64,
        ) {
            let v = 10.0_f64.powf(log_v);
            let linear = Linear::new(cor(e), (other - e) / top * 0.999_999, 0.0, top).unwrap();
            let knots = Knots::new(&[(0.5 * top, cor(e)), (top, cor(other)), (2.0 * top, cor(e))]).unwrap();
            let soft = Viscoelastic::new(10.0_f64.powf(scale), 1e6, 0.1).unwrap();
            let plastic = Plastic::new(10.0_f64.powf(scale)).unwrap();
            let laws: [&dyn Restitution; 5] = [&cor(e), &linear, &knots, &soft, &plastic];
            for (n, law) in laws.into_iter().enumerate() {
                let rebound = law.rebound(v);
                prop_assert!((0.0..=v).contains(&rebound), "law {n}: {v} to {rebound}");
                prop_assert_eq!(law.rebound(0.0), 0.0);
            }
        }
    }
}
