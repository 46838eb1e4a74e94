//! Where the balls of a flock are, and what each is doing.

use nalgebra::Vector3;
use saltus::State;

use crate::flyer::{Moving, Stance};

/// The stances of at most N balls: the mode of a flock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stances<const N: usize>([Stance<3>; N]);

impl<const N: usize> Stances<N> {
    /// The stances of balls that all fly, in a space that is not cut into cells.
    pub const FLIGHT: Self = Self([Stance::FLIGHT; N]);

    /// The stance of `ball`; flight if there is no such ball.
    #[must_use]
    pub fn of(&self, ball: usize) -> Stance<3> {
        self.0.get(ball).copied().unwrap_or(Stance::FLIGHT)
    }

    /// These stances with another one of `ball`.
    #[must_use]
    pub fn with(mut self, ball: usize, stance: Stance<3>) -> Self {
        if let Some(of) = self.0.get_mut(ball) {
            *of = stance;
        }
        self
    }
}

/// The state of up to N balls: nine coordinates each, the lowest point, its velocity and the spin.
///
/// It also has the stance of each ball, since the guard of an edge between balls depends on the
/// state alone, and no coordinate shows the stance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flying<const N: usize> {
    balls: [Moving<3, Vector3<f64>>; N],
    count: usize,
    stances: Stances<N>,
}

const NOWHERE: Moving<3, Vector3<f64>> = {
    let zero = Vector3::new(0.0, 0.0, 0.0);
    Moving { position: zero, velocity: zero, spin: zero }
};

impl<const N: usize> Flying<N> {
    /// Balls in flight, of which N are kept; see [`doing`](Self::doing) for others.
    #[must_use]
    pub fn new(balls: &[Moving<3, Vector3<f64>>]) -> Self {
        let at = |i: usize| balls.get(i).copied().unwrap_or(NOWHERE);
        Self { balls: std::array::from_fn(at), count: balls.len().min(N), stances: Stances::FLIGHT }
    }

    /// These balls with the stances `stances`.
    #[must_use]
    pub const fn doing(self, stances: Stances<N>) -> Self {
        Self { stances, ..self }
    }

    /// The stances of the balls: the mode to start in.
    #[must_use]
    pub const fn stances(&self) -> Stances<N> {
        self.stances
    }

    /// The number of balls.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }

    /// The motion of a ball; at rest at the origin if there is none of this number.
    #[must_use]
    pub fn ball(&self, ball: usize) -> Moving<3, Vector3<f64>> {
        self.balls.get(ball).copied().unwrap_or(NOWHERE)
    }

    pub(super) fn put(&mut self, ball: usize, stance: Stance<3>, moving: Moving<3, Vector3<f64>>) {
        self.stances = self.stances.with(ball, stance);
        if let Some(of) = self.balls.get_mut(ball) {
            *of = moving;
        }
    }

    /// The state whose balls are `f` of their numbers.
    pub(super) fn map(&self, f: impl Fn(usize) -> Option<Moving<3, Vector3<f64>>>) -> Option<Self> {
        let mut after = *self;
        for ball in 0..self.count {
            after.balls[ball] = f(ball)?;
        }
        Some(after)
    }
}

impl<const N: usize> State for Flying<N> {
    #[inline]
    fn len(&self) -> usize {
        9 * self.count
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        self.balls[i / 9].get(i % 9)
    }
    #[inline]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        let mut state = *self;
        for (n, ball) in state.balls.iter_mut().take(self.count).enumerate() {
            *ball = ball.with(|i| f(9 * n + i));
        }
        state
    }
}
