//! Steppers: each advances a smooth flow by one trial step and offers a polynomial in between. They
//! know nothing of guards.
//!
//! | stepper | order | dense output | flows per step | made for |
//! |---|---|---|---|---|
//! | [`Auto`] | | | | the default: the next or the one after it, by the tolerance, and the last where a flow is stiff |
//! | [`Tsit5`] | 5(4) | 4 | 6 | everyday work, relative tolerances of 1e-3 to 1e-7 |
//! | [`Dop853`] | 8(5, 3) | 7 | 12, and 3 for the dense output | tight tolerances, 1e-7 to 1e-14 |
//! | [`Rodas5P`] | 5(4) | 4 | 8, and 2 n + 1 for the Jacobian of n coordinates | stiff flows |

mod auto;
mod band;
mod dop853;
mod either;
mod rodas5p;
#[cfg(feature = "sparse")]
mod scattered;
mod system;
mod tsit5;

pub use auto::Auto;
pub use dop853::Dop853;
pub use either::Either;
pub use rodas5p::Rodas5P;
pub use tsit5::Tsit5;

use std::ops::RangeInclusive;

use crate::sparsity::Sparsity;
use crate::state::State;

/// A one-step method with an error estimate and dense output.
///
/// A stepper is asked for a [`trial`](Stepper::trial) and then for the size of its
/// [`error`](Stepper::error); only if the trial is accepted is its [`dense`](Stepper::dense) output
/// asked for. It remembers nothing from one step to the next.
pub trait Stepper: Copy {
    /// What a trial hands on to its error estimate and its dense output.
    type Stages<S: State>: Clone;
    /// The coefficients of the dense output in powers of (t - t₀)/h, lowest first.
    type Dense<S: State>: AsRef<[S]>;

    /// How many Jacobians a trial evaluates.
    #[inline]
    fn jacobians(&self) -> u64 {
        0
    }

    /// Whether the next step is predicted from how error and step changed together over the last
    /// two.
    ///
    /// That saves evaluations where accuracy alone limits the step, as it does for a stiff stepper
    /// or a tight tolerance. Where stability limits it, as it may an explicit stepper's, the
    /// proportional-integral control that is used otherwise rejects fewer steps.
    fn predictive(&self) -> bool {
        false
    }

    /// The power of h with which the error estimate shrinks.
    fn error_order(&self) -> f64;

    /// The method to use at this relative tolerance; asked for once, as a run starts. Most methods
    /// are one for all.
    #[must_use]
    fn for_tolerance(self, relative: f64) -> Self {
        let _ = relative;
        self
    }

    /// The h·|λ| up to which the explicit method is stable, of a stepper that has another for stiff
    /// flows; none of one that has not.
    ///
    /// Where steps are as long as that for a flow whose Jacobian has the eigenvalue λ, stability
    /// limits them, and [`adapted`](Self::adapted) is asked for the other method.
    #[inline]
    fn stable_to(&self) -> Option<f64> {
        None
    }

    /// The method for a flow that is stiff, or is not so.
    #[must_use]
    #[inline]
    fn adapted(self, stiff: bool) -> Self {
        let _ = stiff;
        self
    }

    /// One step of size `h` from `x` at `t`, where the flow is `slope`.
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, Self::Stages<S>>;

    /// [`trial`](Self::trial) by a flow of whose Jacobian the pattern is given, if one is. Only a
    /// method that asks for a Jacobian has a use for it.
    #[inline]
    fn sparse<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        (h, sparsity): (f64, Option<&Sparsity>),
    ) -> Trial<S, Self::Stages<S>> {
        let _ = sparsity;
        self.trial(flow, t, x, slope, h)
    }

    /// The square of how large the estimated local error of a trial is, as `square` measures the
    /// error of a state.
    ///
    /// A method with one estimate returns `square` of it; one with several combines their squares.
    /// At most 1 is accepted. The next step waits for the answer: no root is taken.
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>, square: impl Fn(&S) -> f64) -> f64;

    /// How far each coordinate of the dense output is from the start of the step at most; `None`
    /// where only the dense output itself can tell.
    ///
    /// Where that shows that no guard comes near zero, the dense output is not asked for.
    #[inline]
    fn reach<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>) -> Option<S> {
        let _ = (h, trial);
        None
    }

    /// The polynomial between the two ends of an accepted trial; summed from the highest power down
    /// at θ = 1, it is the end to rounding.
    fn dense<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        h: f64,
        trial: Trial<&S, &Self::Stages<S>>,
    ) -> Self::Dense<S>;
}

/// One trial step.
#[derive(Clone, Copy, Debug)]
pub struct Trial<S, K> {
    /// The state at the end.
    pub end: S,
    /// The flow at the end.
    pub slope: S,
    /// What the error estimate and the dense output need.
    pub stages: K,
}

impl<S, K> Trial<S, K> {
    /// The same, borrowed.
    #[inline]
    pub const fn as_ref(&self) -> Trial<&S, &K> {
        Trial { end: &self.end, slope: &self.slope, stages: &self.stages }
    }

    /// The same with its stages kept as something else.
    #[inline]
    fn with_stages<L>(self, keep: impl FnOnce(K) -> L) -> Trial<S, L> {
        Trial { end: self.end, slope: self.slope, stages: keep(self.stages) }
    }
}

/// Coordinate `i` of Σ wₖ kₖ.
#[inline]
fn weighted<S: State, const N: usize>(weights: &[f64; N], slopes: [&S; N], i: usize) -> f64 {
    weights.iter().zip(slopes).map(|(w, k)| w * k.get(i)).sum()
}

/// x + h Σ wₖ kₖ.
#[inline]
fn moved<S: State, const N: usize>(x: &S, h: f64, weights: &[f64; N], slopes: [&S; N]) -> S {
    x.with(|i| x.get(i) + h * weighted(weights, slopes, i))
}

/// y - x.
#[inline]
fn difference<S: State>(y: &S, x: &S) -> S {
    x.with(|i| y.get(i) - x.get(i))
}

/// The differences of so many coordinates are all in registers. There the optimiser packs them as
/// it finds them, such that those that are ready wait for those that are not: places, known from
/// the speeds of an earlier stage, for speeds. To look at each by itself, whether it is finite,
/// keeps them apart, and costs less than that wait (`cargo bench -p saltus --bench steps`). One or
/// two are best packed, and more are in memory.
const APART: RangeInclusive<usize> = 3..=6;

/// The stages of an explicit step, kept as differences dₖ from the slope at its start.
///
/// With x + h (c f + Σ wₖ dₖ) in place of x + h Σ wₖ kₖ the large weights of opposite signs that
/// methods have act on differences only: where the slope hardly changes they add no rounding, and a
/// constant slope is integrated to the last digit.
struct Differences<'a, F, S> {
    flow: &'a mut F,
    t: f64,
    x: &'a S,
    slope: &'a S,
    h: f64,
}

impl<S: State, F: FnMut(f64, &S) -> S> Differences<'_, F, S> {
    /// The state that is `c` of the step ahead by these weights. The last difference, for which the
    /// others have waited, enters last.
    #[inline]
    fn state<const N: usize>(&self, c: f64, weights: &[f64; N], differences: [&S; N]) -> S {
        let Self { x, slope, h, .. } = self;
        x.with(|i| {
            // A plain loop: each stage of each method is compiled for each model.
            let (mut earlier, mut k) = (-0.0, 0); // to which a first -0.0 is added as it is
            while k + 1 < N {
                earlier += weights[k] * differences[k].get(i);
                k += 1;
            }
            let along = x.get(i) + h * (c * slope.get(i) + earlier);
            if k < N { along + (h * weights[k]) * differences[k].get(i) } else { along }
        })
    }

    /// The flow there, less the one at the start.
    #[inline]
    fn next<const N: usize>(&mut self, c: f64, weights: &[f64; N], differences: [&S; N]) -> S {
        let state = self.state(c, weights, differences);
        let flow = (self.flow)(self.t + c * self.h, &state);
        let less = |i: usize| flow.get(i) - self.slope.get(i);
        if APART.contains(&flow.len()) { self.slope.with(|i| apart(less(i))) } else { self.slope.with(less) }
    }
}

/// The value, which is not packed with others: the optimiser leaves apart what a call may come
/// between. What this one notes is of no use.
#[inline]
fn apart(value: f64) -> f64 {
    #[cold]
    #[inline(never)]
    fn note(odd: &mut bool) {
        *odd = true;
    }
    let mut odd = false;
    if !value.is_finite() {
        note(&mut odd);
    }
    value
}

/// The coefficient of θ² with which the polynomial that starts at `x` and has these `first` (of θ)
/// and `higher` (of θ³, θ⁴, …) coefficients ends at `end`, whatever their rounding.
///
/// The coefficient of θ must not serve for this: an arc that ends in a small part of a step sees
/// nothing else, and the rounding of the others may exceed it.
#[inline]
fn closing<S: State>(x: &S, end: &S, first: &S, higher: &[S]) -> S {
    x.with(|i| {
        let rest = higher.iter().rev().fold(0.0, |sum, c| sum + c.get(i));
        (end.get(i) - x.get(i)) - first.get(i) - rest
    })
}

/// What the tests of the methods share.
#[cfg(test)]
mod testing {
    use super::Stepper;
    use crate::piece::horner;

    /// x' = x cos t, x(0) = 1, so x = exp(sin t): the largest errors over `0..=1` with steps of
    /// `h`, at their ends and inside them.
    pub(super) fn errors_with(stepper: impl Stepper, h: f64) -> (f64, f64) {
        let mut flow = |t: f64, x: &f64| x * t.cos();
        let (mut t, mut x) = (0.0, 1.0_f64);
        let (mut at_ends, mut inside) = (0.0_f64, 0.0_f64);
        while t < 1.0 - 1e-9 {
            let slope = flow(t, &x);
            let trial = stepper.trial(&mut flow, t, &x, &slope, h);
            let dense = stepper.dense(&mut flow, t, &x, h, trial.as_ref());
            let dense = dense.as_ref();
            for theta in [0.1, 0.3, 0.5, 0.8] {
                inside = inside.max((horner(dense, theta) - (t + theta * h).sin().exp()).abs());
            }
            assert_eq!(horner(dense, 0.0), x);
            assert!((horner(dense, 1.0) - trial.end).abs() <= f64::EPSILON * trial.end.abs());
            (t, x) = (t + h, trial.end);
            at_ends = at_ends.max((x - t.sin().exp()).abs());
        }
        (at_ends, inside)
    }

    /// The orders at the ends of the steps and inside them, from steps of `h` and half of it.
    pub(super) fn orders(stepper: impl Stepper, h: f64) -> (f64, f64) {
        let (coarse, fine) = (errors_with(stepper, h), errors_with(stepper, 0.5 * h));
        ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2())
    }

    /// The power of h with which the error estimate shrinks.
    pub(super) fn error_order(stepper: impl Stepper, h: f64) -> f64 {
        let mut flow = |t: f64, x: &f64| x * t.cos();
        let (t, x) = (0.3_f64, 0.3_f64.sin().exp());
        let slope = flow(t, &x);
        let mut square = |h: f64| {
            let trial = stepper.trial(&mut flow, t, &x, &slope, h);
            stepper.error(h, trial.as_ref(), |e| e * e)
        };
        0.5 * (square(h) / square(0.5 * h)).log2()
    }
}
