//! Curved ground and round obstacles.

use std::fmt;

use nalgebra::{SVector, Vector2};

use super::{Face, Walls};
use crate::parameter::{ParameterError, finite, positive};

/// Ground whose height is a function of x: φ = y - f(x), from f, f' and f''.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Ground, Walls};
/// let bowl = Ground::new(|x: f64| 0.5 * x * x, |x| x, |_| 1.0);
/// assert_eq!(bowl.margin(Face::default(), 0.0, &vector![2.0, 3.0]), 1.0);
/// assert_eq!(bowl.gradient(Face::default(), 0.0, &vector![2.0, 2.0]), vector![-2.0, 1.0]);
/// ```
#[derive(Clone, Copy)]
pub struct Ground<F, D, C> {
    height: F,
    slope: D,
    curve: C,
}

impl<F: Fn(f64) -> f64, D: Fn(f64) -> f64, C: Fn(f64) -> f64> Ground<F, D, C> {
    /// The ground of the `height` f(x) in m, its derivative `slope` f', and the second one `curve`
    /// f'' in 1/m.
    #[must_use]
    pub const fn new(height: F, slope: D, curve: C) -> Self {
        Self { height, slope, curve }
    }
}

impl<F, D, C> fmt::Debug for Ground<F, D, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Ground").finish_non_exhaustive()
    }
}

impl<F: Fn(f64) -> f64, D: Fn(f64) -> f64, C: Fn(f64) -> f64> Walls<2> for Ground<F, D, C> {
    #[inline]
    fn margin(&self, _: Face, _: f64, p: &Vector2<f64>) -> f64 {
        p[1] - (self.height)(p[0])
    }
    #[inline]
    fn gradient(&self, _: Face, _: f64, p: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(-(self.slope)(p[0]), 1.0)
    }
    #[inline]
    fn bend(&self, _: Face, _: f64, p: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        -(self.curve)(p[0]) * v[0] * v[0]
    }
}

/// A circle or sphere: an obstacle, or a bowl to be in. φ = ±(|p - c|² - R²)/(2R).
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Round, Walls};
/// let disk = Round::obstacle(vector![0.0, 0.0], 0.5)?;
/// assert_eq!(disk.margin(Face::default(), 0.0, &vector![0.0, 1.0]), 0.75);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Round<const N: usize> {
    centre: SVector<f64, N>,
    radius: f64,
    sign: f64,
}

impl<const N: usize> Round<N> {
    /// The outside of a round obstacle: all within `radius` of `centre`, in m, is solid.
    ///
    /// # Errors
    /// [`ParameterError`] unless the centre is finite and the radius finite and positive.
    pub fn obstacle(centre: SVector<f64, N>, radius: f64) -> Result<Self, ParameterError> {
        for &part in &centre {
            finite("a coordinate of a centre in m", part)?;
        }
        Ok(Self { centre, radius: positive("a radius in m", radius)?, sign: 1.0 })
    }

    /// The inside of a round bowl: all beyond `radius` from `centre`, in m, is solid.
    ///
    /// # Errors
    /// [`ParameterError`] unless the centre is finite and the radius finite and positive.
    pub fn bowl(centre: SVector<f64, N>, radius: f64) -> Result<Self, ParameterError> {
        Ok(Self { sign: -1.0, ..Self::obstacle(centre, radius)? })
    }
}

impl<const N: usize> Walls<N> for Round<N> {
    #[inline]
    fn margin(&self, _: Face, _: f64, p: &SVector<f64, N>) -> f64 {
        let r = self.radius;
        self.sign * 0.5 * ((p - self.centre).norm_squared() / r - r)
    }
    #[inline]
    fn gradient(&self, _: Face, _: f64, p: &SVector<f64, N>) -> SVector<f64, N> {
        (p - self.centre) * (self.sign / self.radius)
    }
    #[inline]
    fn bend(&self, _: Face, _: f64, _: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.sign * v.norm_squared() / self.radius
    }
}
