//! How much speed an impact leaves: the coefficient of restitution.

use std::fmt;

/// A coefficient of restitution (COR) e: the rebound speed over the impact speed, v⁺ = -e v⁻ normal to the floor.
///
/// Dimensionless, 0 ≤ e ≤ 1: at 0 the ball stays where it lands, at 1 it loses nothing. No other value exists, by type.
/// Source: I. Newton, *Principia* (1687), scholium to the laws of motion, corollary 6.
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

    /// The COR that a drop from `drop` and a rebound to `rebound` show, e = √(rebound / drop); both heights in one unit, above the floor.
    ///
    /// # Errors
    /// [`CorError`] if that is not between 0 and 1: a rebound above the drop, a negative height, a drop of zero.
    ///
    /// ```
    /// use saltus_bounce::Cor;
    /// assert_eq!(Cor::from_heights(100.0, 25.0)?.value(), 0.5);
    /// # Ok::<(), saltus_bounce::CorError>(())
    /// ```
    pub fn from_heights(drop: f64, rebound: f64) -> Result<Self, CorError> {
        Self::new((rebound / drop).sqrt())
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
#[derive(Clone, Copy, Debug, PartialEq)]
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

impl std::error::Error for CorError {}
