//! Uniform gravity.

use nalgebra::SVector;

use super::{Effect, JetMotion, JetSum, Motion, Spin};
use crate::parameter::{ParameterError, not_negative};

/// Gravity on Earth by convention, 9.80665 m/s² (third General Conference on Weights and Measures,
/// 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Uniform gravity: a = -g along the last coordinate, g in m/s².
///
/// The bodies by name: at the surface on the equator, rotation included; at the 1 bar level for the
/// gas giants. Earth has the conventional value. Source: D. R. Williams, *Planetary Fact Sheet*,
/// NASA Goddard Space Flight Center, nssdc.gsfc.nasa.gov/planetary/factsheet.
///
/// ```
/// use saltus_bounce::effects::Gravity;
/// assert_eq!(Gravity::named("Moon"), Some(Gravity::MOON));
/// assert_eq!(Gravity::MOON.value(), 1.62);
/// assert!(Gravity::new(-9.81).is_err()); // it points down by itself
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity(f64);

impl Gravity {
    /// 3.7 m/s².
    pub const MERCURY: Self = Self(3.7);
    /// 8.9 m/s².
    pub const VENUS: Self = Self(8.9);
    /// 9.80665 m/s², by convention.
    pub const EARTH: Self = Self(STANDARD_GRAVITY);
    /// 1.62 m/s².
    pub const MOON: Self = Self(1.62);
    /// 3.7 m/s².
    pub const MARS: Self = Self(3.7);
    /// 23.1 m/s².
    pub const JUPITER: Self = Self(23.1);
    /// 9.0 m/s².
    pub const SATURN: Self = Self(9.0);
    /// 8.7 m/s².
    pub const URANUS: Self = Self(8.7);
    /// 11.0 m/s².
    pub const NEPTUNE: Self = Self(11.0);
    /// 0.7 m/s².
    pub const PLUTO: Self = Self(0.7);

    /// The bodies that have names here, in small letters.
    pub const NAMED: [(&'static str, Self); 10] = [
        ("mercury", Self::MERCURY),
        ("venus", Self::VENUS),
        ("earth", Self::EARTH),
        ("moon", Self::MOON),
        ("mars", Self::MARS),
        ("jupiter", Self::JUPITER),
        ("saturn", Self::SATURN),
        ("uranus", Self::URANUS),
        ("neptune", Self::NEPTUNE),
        ("pluto", Self::PLUTO),
    ];

    /// Gravity of `value` in m/s².
    ///
    /// # Errors
    /// [`ParameterError`] unless it is finite and not negative.
    pub const fn new(value: f64) -> Result<Self, ParameterError> {
        match not_negative("a gravity in m/s^2", value) {
            Ok(value) => Ok(Self(value)),
            Err(error) => Err(error),
        }
    }

    /// The gravity of the body of this name, in letters of any case.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.iter().find(|(known, _)| known.eq_ignore_ascii_case(name.trim())).map(|&(_, gravity)| gravity)
    }

    /// g in m/s².
    #[must_use]
    pub const fn value(self) -> f64 {
        self.0
    }
}

impl<const N: usize, S: Spin> Effect<N, S> for Gravity {
    #[inline]
    fn uniform(&self) -> bool {
        true
    }

    #[inline]
    fn acceleration(&self, _motion: &Motion<N, S>) -> SVector<f64, N> {
        upwards(-self.0)
    }

    #[inline(always)]
    fn series<'j>(&self, _motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        sum.lift(-self.0);
        true
    }
}

/// A vector of this length along the last coordinate.
#[inline]
pub(super) fn upwards<const N: usize>(length: f64) -> SVector<f64, N> {
    const { assert!(N > 0, "a ball has at least its height") };
    let mut up = SVector::zeros();
    up[N - 1] = length;
    up
}
