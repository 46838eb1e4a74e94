//! Moving air.

use nalgebra::SVector;

use super::{Effect, JetMotion, JetSum, Motion, Spin};
use crate::parameter::{ParameterError, finite};

/// Effects in air that moves with a constant velocity w: they see v - w.
///
/// Put drag and lift inside; gravity may stand inside or outside, it does not look. w in m/s, in
/// the coordinates of the scene; an updraught is a wind with a last coordinate.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::effects::{Effect, Gravity, LinearDrag, Motion, Wind};
/// let scene = (Gravity::new(10.0)?, Wind::new(vector![3.0, 0.0], LinearDrag::new(2.0)?)?);
/// let motion = Motion { t: 0.0, position: vector![0.0, 1.0], velocity: vector![0.0, 0.0], spin: () };
/// assert_eq!(scene.acceleration(&motion), vector![6.0, -10.0]);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wind<const N: usize, E> {
    velocity: SVector<f64, N>,
    effects: E,
}

impl<const N: usize, E> Wind<N, E> {
    /// `effects` in air that moves at `velocity` in m/s.
    ///
    /// # Errors
    /// [`ParameterError`] unless every component is finite.
    pub fn new(velocity: SVector<f64, N>, effects: E) -> Result<Self, ParameterError> {
        for &component in &velocity {
            finite("a component of a wind in m/s", component)?;
        }
        Ok(Self { velocity, effects })
    }

    #[inline]
    fn seen<S: Spin>(&self, motion: &Motion<N, S>) -> Motion<N, S> {
        Motion { velocity: motion.velocity - self.velocity, ..*motion }
    }
}

impl<const N: usize, S: Spin, E: Effect<N, S>> Effect<N, S> for Wind<N, E> {
    #[inline]
    fn uniform(&self) -> bool {
        self.effects.uniform()
    }

    #[inline]
    fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N> {
        self.effects.acceleration(&self.seen(motion))
    }

    #[inline]
    fn spin_rate(&self, motion: &Motion<N, S>) -> S {
        self.effects.spin_rate(&self.seen(motion))
    }

    #[inline]
    fn kink(&self, motion: &Motion<N, S>) -> Option<f64> {
        self.effects.kink(&self.seen(motion))
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        if self.velocity.iter().all(|&v| v == 0.0) {
            return self.effects.series(motion, sum);
        }
        let mut velocity = motion.velocity;
        velocity.iter_mut().zip(self.velocity.as_slice()).for_each(|(v, wind)| *v -= *wind);
        self.effects.series(&JetMotion::new(velocity, motion.spin), sum)
    }
}
