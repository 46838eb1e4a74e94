//! A box to be in.

use nalgebra::SVector;

use super::{Face, Walls};
use crate::parameter::{ParameterError, finite};

/// The inside of a rectangle or cuboid, between two opposite corners: 2N faces, face 2k at the low
/// end of coordinate k, 2k + 1 at the high end.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Cuboid, Face, Walls};
/// let room = Cuboid::between(vector![0.0, 0.0], vector![4.0, 2.5])?;
/// assert_eq!(room.faces(0), 4);
/// assert_eq!(room.margin(Face { cell: 0, index: 3 }, 0.0, &vector![1.0, 2.0]), 0.5); // to the ceiling
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<const N: usize> {
    low: SVector<f64, N>,
    high: SVector<f64, N>,
}

impl<const N: usize> Cuboid<N> {
    /// The box between the corner `low` and the corner `high`, in m.
    ///
    /// # Errors
    /// [`ParameterError`] unless every coordinate is finite and that of `high` above that of `low`.
    pub fn between(low: SVector<f64, N>, high: SVector<f64, N>) -> Result<Self, ParameterError> {
        for (&low, &high) in low.iter().zip(&high) {
            finite("a coordinate of a corner in m", low)?;
            finite("a coordinate of a corner in m", high)?;
            if high <= low {
                return Err(ParameterError::new(
                    "a coordinate of a box's high corner",
                    high,
                    "one above the low corner's",
                ));
            }
        }
        Ok(Self { low, high })
    }
}

impl<const N: usize> Walls<N> for Cuboid<N> {
    fn faces(&self, _cell: usize) -> usize {
        2 * N
    }
    #[inline]
    fn margin(&self, face: Face, _: f64, p: &SVector<f64, N>) -> f64 {
        let k = face.index / 2;
        if face.index.is_multiple_of(2) { p[k] - self.low[k] } else { self.high[k] - p[k] }
    }
    #[inline]
    fn gradient(&self, face: Face, _: f64, _: &SVector<f64, N>) -> SVector<f64, N> {
        let mut normal = SVector::zeros();
        normal[face.index / 2] = if face.index.is_multiple_of(2) { 1.0 } else { -1.0 };
        normal
    }
    #[inline]
    fn straight(&self, _: Face) -> bool {
        true
    }
}
