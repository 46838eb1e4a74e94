//! The state of a ball that flies: position, velocity, and spin if it has one.

use nalgebra::{SVector, Vector3};
use saltus::State;

use crate::effects::{Motion, Spin};

/// Position, velocity and spin: 2N coordinates, and those of the spin where there is one.
///
/// ```
/// use nalgebra::vector;
/// use saltus::State;
/// use saltus_bounce::Moving;
/// let ball = Moving::new(vector![0.0, 1.5], vector![3.0, 0.0]);
/// assert_eq!(ball.len(), 4); // no spin, no coordinate for it
/// assert_eq!(ball.spinning(30.0).len(), 5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving<const N: usize, S = ()> {
    /// The place in m.
    pub position: SVector<f64, N>,
    /// The velocity in m/s.
    pub velocity: SVector<f64, N>,
    /// The spin in rad/s.
    pub spin: S,
}

impl<const N: usize> Moving<N> {
    /// A ball at `position` in m with `velocity` in m/s, whose spin does not matter.
    #[must_use]
    pub const fn new(position: SVector<f64, N>, velocity: SVector<f64, N>) -> Self {
        Self { position, velocity, spin: () }
    }

    /// This motion with `spin` in rad/s.
    #[must_use]
    pub const fn spinning<S: Turning>(self, spin: S) -> Moving<N, S> {
        Moving { position: self.position, velocity: self.velocity, spin }
    }
}

impl<const N: usize, S: Spin> Moving<N, S> {
    /// The motion for an effect, at time `t`.
    #[inline]
    pub(crate) fn at(&self, t: f64) -> Motion<N, S> {
        Motion { t, position: self.position, velocity: self.velocity, spin: self.spin }
    }
}

/// A spin that is part of a state.
pub trait Turning: Spin {
    /// The number of coordinates.
    const LEN: usize;
    /// Coordinate `i`, for `i < LEN`.
    fn coordinate(&self, i: usize) -> f64;
    /// The spin whose coordinate `i` is `f(i)`.
    fn from_coordinates(f: impl FnMut(usize) -> f64) -> Self;
}

impl Turning for () {
    const LEN: usize = 0;
    #[inline]
    fn coordinate(&self, _: usize) -> f64 {
        0.0
    }
    #[inline]
    fn from_coordinates(_: impl FnMut(usize) -> f64) -> Self {}
}

impl Turning for f64 {
    const LEN: usize = 1;
    #[inline]
    fn coordinate(&self, _: usize) -> f64 {
        *self
    }
    #[inline]
    fn from_coordinates(mut f: impl FnMut(usize) -> f64) -> Self {
        f(0)
    }
}

impl Turning for Vector3<f64> {
    const LEN: usize = 3;
    #[inline]
    fn coordinate(&self, i: usize) -> f64 {
        self[i]
    }
    #[inline]
    fn from_coordinates(mut f: impl FnMut(usize) -> f64) -> Self {
        Self::new(f(0), f(1), f(2))
    }
}

impl<const N: usize, S: Turning> State for Moving<N, S> {
    #[inline]
    fn len(&self) -> usize {
        2 * N + S::LEN
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        if i < N {
            self.position[i]
        } else if i < 2 * N {
            self.velocity[i - N]
        } else {
            self.spin.coordinate(i - 2 * N)
        }
    }
    #[inline]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        Self {
            position: self.position.with(&mut f),
            velocity: self.velocity.with(|i| f(N + i)),
            spin: S::from_coordinates(|i| f(2 * N + i)),
        }
    }
}
