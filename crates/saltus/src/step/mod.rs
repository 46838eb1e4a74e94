//! Steppers: each advances a smooth flow by one trial step and offers a polynomial in between. They know nothing of guards.

mod tsit5;

pub use tsit5::Tsit5;

use crate::state::State;

/// A one-step method with an error estimate and dense output.
///
/// A stepper is asked for a [`trial`](Stepper::trial); only if the trial is accepted is its [`dense`](Stepper::dense) output asked for.
pub trait Stepper: Copy {
    /// What a trial hands on to its dense output.
    type Stages<S: State>;
    /// The coefficients of the dense output in powers of (t - t₀)/h, lowest first.
    type Dense<S: State>: AsRef<[S]>;

    /// The power of h with which the error estimate shrinks.
    const ERROR_ORDER: f64;

    /// One step of size `h` from `x` at `t`, where the flow is `slope`.
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, Self::Stages<S>>;

    /// The polynomial between the two ends of an accepted trial.
    fn dense<S: State>(&self, x: &S, h: f64, trial: &Trial<S, Self::Stages<S>>) -> Self::Dense<S>;
}

/// One trial step.
#[derive(Clone, Copy, Debug)]
pub struct Trial<S, K> {
    /// The state at the end.
    pub end: S,
    /// The flow at the end.
    pub slope: S,
    /// The estimated local error of `end`.
    pub error: S,
    /// What the dense output needs.
    pub stages: K,
}
