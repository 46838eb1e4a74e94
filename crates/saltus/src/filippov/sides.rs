//! Two-sided systems of closures.

use std::marker::PhantomData;

use super::TwoSided;
use crate::automaton::clocks::Clock;
use crate::state::State;

/// A [`TwoSided`] system made of closures: the flows above and below, h and its gradient.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Filippov, Side, Sides, Simulation};
///
/// // Two uniform flows against a unit circle that both must keep to: the state runs round it at speed 1.
/// let rim = Sides::new(
///     |_, x: &Vector2<f64>| vector![-x[1] - x[0], x[0] - x[1]],
///     |_, x| vector![-x[1] + x[0], x[0] + x[1]],
///     |_, x| x.norm_squared() - 1.0,
///     |_, x| 2.0 * x,
/// );
/// let rim = Filippov::of(rim);
/// let start = vector![1.0, 0.0];
/// assert_eq!(rim.side(0.0, &start), Some(Side::Sliding));
/// let run = Simulation::of(&rim).run(Side::Sliding, start, 0.0..100.0)?;
/// assert!((run.end.state - vector![100.0_f64.cos(), 100.0_f64.sin()]).norm() < 1e-6);
/// assert!((run.end.state.norm() - 1.0).abs() < 1e-9);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone)]
pub struct Sides<S, F, G, H, N, R = fn(f64, &S) -> f64> {
    above: F,
    below: G,
    surface: H,
    normal: N,
    rate: R,
    affine: bool,
    pull: f64,
    stops: Vec<Clock>,
    state: PhantomData<fn(&S) -> S>,
}

impl<S, F, G, H, N> Sides<S, F, G, H, N>
where
    S: State,
    F: Fn(f64, &S) -> S,
    G: Fn(f64, &S) -> S,
    H: Fn(f64, &S) -> f64,
    N: Fn(f64, &S) -> S,
{
    /// The flow where h > 0, the flow where h < 0, h itself, and its gradient with respect to the
    /// state.
    #[must_use]
    pub fn new(above: F, below: G, surface: H, normal: N) -> Self {
        Self {
            above,
            below,
            surface,
            normal,
            rate: |_, _| 0.0,
            affine: false,
            pull: 1.0,
            stops: Vec::new(),
            state: PhantomData,
        }
    }
}

impl<S, F, G, H, N, R> Sides<S, F, G, H, N, R> {
    /// Lets the surface move: `rate` is ∂h/∂t.
    #[must_use]
    pub fn moving<Q: Fn(f64, &S) -> f64>(self, rate: Q) -> Sides<S, F, G, H, N, Q> {
        let Self { above, below, surface, normal, affine, pull, stops, state, .. } = self;
        Sides { above, below, surface, normal, rate, affine, pull, stops, state }
    }

    /// Promises that the surface is affine and at rest; see [`TwoSided::affine`].
    #[must_use]
    pub fn affine(mut self) -> Self {
        self.affine = true;
        self
    }

    /// Says when a flow is not smooth in time, as at the knots of an input; see
    /// [`TwoSided::stops`].
    ///
    /// ```
    /// use saltus::{Clock, Filippov, Side, Sides, Simulation};
    ///
    /// // A block of 1 kg that friction holds with 2 N is pushed with 5 N for 10 ms.
    /// let push = |t: f64| if (1.0..1.01).contains(&t) { 5.0 } else { 0.0 };
    /// let block = Sides::new(move |t, _: &f64| push(t) - 2.0, move |t, _| push(t) + 2.0, |_, v| *v, |_, _| 1.0);
    /// let block = Filippov::of(block.affine().stops(Clock::at([1.0, 1.01])));
    /// let run = Simulation::of(&block).run(Side::Sliding, 0.0, 0.0..10.0)?;
    /// let jumps: Vec<_> = run.trajectory.jumps().iter().map(|jump| (jump.to, jump.t())).collect();
    /// assert_eq!(jumps[0], (Side::Above, 1.0));
    /// assert!(jumps[1].0 == Side::Sliding && (jumps[1].1 - 1.025).abs() < 1e-12); // 5·0.01/2 after it began
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn stops(mut self, stops: Clock) -> Self {
        self.stops.push(stops);
        self
    }

    /// The rate at which a deviation from the surface decays while sliding, in 1/s; see
    /// [`TwoSided::pull`].
    #[must_use]
    pub fn pull(mut self, rate: f64) -> Self {
        self.pull = rate;
        self
    }
}

impl<S, F, G, H, N, R> std::fmt::Debug for Sides<S, F, G, H, N, R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sides").field("affine", &self.affine).field("pull", &self.pull).finish_non_exhaustive()
    }
}

impl<S, F, G, H, N, R> TwoSided for Sides<S, F, G, H, N, R>
where
    S: State,
    F: Fn(f64, &S) -> S,
    G: Fn(f64, &S) -> S,
    H: Fn(f64, &S) -> f64,
    N: Fn(f64, &S) -> S,
    R: Fn(f64, &S) -> f64,
{
    type State = S;
    fn above(&self, t: f64, x: &S) -> S {
        (self.above)(t, x)
    }
    fn below(&self, t: f64, x: &S) -> S {
        (self.below)(t, x)
    }
    fn surface(&self, t: f64, x: &S) -> f64 {
        (self.surface)(t, x)
    }
    fn normal(&self, t: f64, x: &S) -> S {
        (self.normal)(t, x)
    }
    fn surface_rate(&self, t: f64, x: &S) -> f64 {
        (self.rate)(t, x)
    }
    fn affine(&self) -> bool {
        self.affine
    }
    fn stops(&self) -> &[Clock] {
        &self.stops
    }
    fn pull(&self) -> f64 {
        self.pull
    }
}
