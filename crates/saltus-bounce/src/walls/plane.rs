//! Level floors, inclines, walls: planes that stand still.

use nalgebra::{SVector, Vector2};

use super::{Face, Walls};
use crate::parameter::{ParameterError, finite};

/// A plane: φ = n·p + d, with the unit normal n towards the ball's side and d in m.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Plane, Walls};
/// let floor = Plane::<3>::floor(-1.0)?;
/// assert_eq!(floor.margin(Face::default(), 0.0, &vector![7.0, 8.0, 0.5]), 1.5);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane<const N: usize> {
    normal: SVector<f64, N>,
    offset: f64,
}

impl<const N: usize> Plane<N> {
    /// The level floor at `height` in m.
    ///
    /// # Errors
    /// [`ParameterError`] unless `height` is finite.
    pub fn floor(height: f64) -> Result<Self, ParameterError> {
        let mut up = SVector::zeros();
        up[N - 1] = 1.0;
        Self::wall(up, -height)
    }

    /// The plane of all points p with n·p + `offset` = 0; n is `normal`, towards the ball's side
    /// and of any length.
    ///
    /// # Errors
    /// [`ParameterError`] unless every number is finite and the normal is not zero.
    pub fn wall(normal: SVector<f64, N>, offset: f64) -> Result<Self, ParameterError> {
        let length = finite("the length of a normal", normal.norm())?;
        if length == 0.0 {
            return Err(ParameterError::new("the length of a normal", length, "a normal that is not zero"));
        }
        let offset = finite("the offset of a plane in m", offset)?;
        Ok(if length == 1.0 {
            Self { normal, offset }
        } else {
            Self { normal: normal / length, offset: offset / length }
        })
    }

    /// The plane through `point` with this `normal` of any length, towards the ball's side.
    ///
    /// # Errors
    /// [`ParameterError`] unless every number is finite and the normal is not zero.
    pub fn through(point: SVector<f64, N>, normal: SVector<f64, N>) -> Result<Self, ParameterError> {
        Self::wall(normal, -normal.dot(&point))
    }

    /// The unit normal.
    #[must_use]
    pub const fn normal(&self) -> &SVector<f64, N> {
        &self.normal
    }
}

impl Plane<2> {
    /// An incline through the origin that rises towards positive x at `angle` in rad.
    ///
    /// # Errors
    /// [`ParameterError`] unless `angle` is finite.
    pub fn incline(angle: f64) -> Result<Self, ParameterError> {
        let angle = finite("an angle in rad", angle)?;
        Self::wall(Vector2::new(-angle.sin(), angle.cos()), 0.0)
    }
}

impl<const N: usize> Walls<N> for Plane<N> {
    #[inline]
    fn margin(&self, _: Face, _: f64, p: &SVector<f64, N>) -> f64 {
        self.normal.dot(p) + self.offset
    }
    #[inline]
    fn gradient(&self, _: Face, _: f64, _: &SVector<f64, N>) -> SVector<f64, N> {
        self.normal
    }
    #[inline]
    fn straight(&self, _: Face) -> bool {
        true
    }
}
