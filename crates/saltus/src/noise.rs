//! What rounding leaves open, and how sure a decision has to be.

/// How many times what one rounding of each of its terms moves a number by, its value may be off.
///
/// A sum of n products rounds 2n - 1 times and starts from numbers that were rounded themselves: a
/// guard of up to five coordinates and a constant stays below sixteen.
pub(crate) const ROUNDINGS: f64 = 16.0;

/// How many times what rounding leaves open something must be, where a wrong answer cannot be mended
/// by a later one: an edge that counts as taken loses a ball, one that is looked at again does not.
pub(crate) const SURELY: f64 = ROUNDINGS * ROUNDINGS;

/// How many times larger than what it is compared with something is that is so by no chance: the root
/// of [`ROUNDINGS`], as a number between one rounding and all of them.
pub(crate) const CLEARLY: f64 = 4.0;

/// Two rates that are taken over unlike times are one rate if they differ by no more than this part.
pub(crate) const ALIKE: f64 = 0.1;

/// How far rounding may take a sum whose terms have this `size` together.
#[inline]
pub(crate) const fn rounding(size: f64) -> f64 {
    ROUNDINGS * f64::EPSILON * size
}
