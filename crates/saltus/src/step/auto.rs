//! Auto: Tsit5 or Dop853, by the tolerance; Rodas5P where a flow is stiff.

use super::{Dop853, Either, Rodas5P, Stepper, Trial, Tsit5};
use crate::state::State;

/// The default: [`Tsit5`] down to a relative tolerance of 1e-7, [`Dop853`] below, and [`Rodas5P`]
/// where the flow is stiff.
///
/// Between the first two it is chosen once, at the start of a run; a step pays a branch and some
/// copies for it. Where the two cost the same for the same error was measured: at a tolerance of
/// 1e-5 to 1e-6 on the Arenstorf orbit, where steps are many, and of 1e-7 to 1e-8 for a ball in
/// air, whose arcs end after a step or two. A flow with a kink inside an arc keeps [`Tsit5`] ahead
/// down to 1e-9.
///
/// After 32 steps, and then after a quarter more each time, the largest eigenvalue λ of the flow's
/// Jacobian is estimated, for two evaluations: a run of n steps pays for log n of them, and notices
/// that it has become stiff within a quarter of its steps. If steps h are so long time and again
/// that h |λ| is as large as the explicit method is stable to, stability limits them, the flow is
/// stiff, and [`Rodas5P`] goes on; and the other way round. [`Stats::stiff`](crate::Stats::stiff)
/// counts its steps.
///
/// ```
/// use saltus::{Hybrid, Simulation};
/// // A cooling that takes a microsecond follows a heater that takes a second.
/// let rod = Hybrid::new().mode("heat", |t, x: &f64| 1e6 * (t.sin() - x));
/// let run = Simulation::of(&rod).run("heat", 0.0, 0.0..3.0)?;
/// assert!((run.end.state - 3.0_f64.sin()).abs() < 1e-5);
/// assert!(run.end.stats.stiff > 0 && run.end.stats.flows < 10_000); // explicit steps would take millions
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Auto {
    tight: bool,
    method: Method,
}

type Method = Either<Either<Tsit5, Dop853>, Rodas5P>;

impl Auto {
    /// The loosest relative tolerance for which [`Tsit5`] is not the choice.
    pub const TIGHT: f64 = 1e-7;

    /// As [`default`](Default::default), where a constant is needed.
    #[must_use]
    pub const fn new() -> Self {
        Self { tight: false, method: Either::Loose(Either::Loose(Tsit5)) }
    }

    const fn explicit(tight: bool) -> Either<Tsit5, Dop853> {
        if tight { Either::Tight(Dop853) } else { Either::Loose(Tsit5) }
    }
}

/// How far along the negative real axis the methods are stable (E. Hairer, G. Wanner, *Solving
/// Ordinary Differential Equations II*, IV.2, for the second).
const TSIT5: f64 = 3.5;
const DOP853: f64 = 6.1;

impl Stepper for Auto {
    type Stages<S: State> = <Method as Stepper>::Stages<S>;
    type Dense<S: State> = <Method as Stepper>::Dense<S>;

    fn jacobians(&self) -> u64 {
        self.method.jacobians()
    }

    fn for_tolerance(self, relative: f64) -> Self {
        let tight = relative < Self::TIGHT;
        Self { tight, method: Either::Loose(Self::explicit(tight)) }
    }

    fn stable_to(&self) -> Option<f64> {
        Some(if self.tight { DOP853 } else { TSIT5 })
    }

    fn adapted(self, stiff: bool) -> Self {
        let method = if stiff { Either::Tight(Rodas5P) } else { Either::Loose(Self::explicit(self.tight)) };
        Self { method, ..self }
    }

    fn predictive(&self) -> bool {
        self.method.predictive()
    }

    #[inline]
    fn error_order(&self) -> f64 {
        self.method.error_order()
    }

    #[inline]
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, Self::Stages<S>> {
        self.method.trial(flow, t, x, slope, h)
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>, square: impl Fn(&S) -> f64) -> f64 {
        self.method.error(h, trial, square)
    }

    #[inline]
    fn reach<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>) -> Option<S> {
        self.method.reach(h, trial)
    }

    #[inline]
    fn dense<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        h: f64,
        trial: Trial<&S, &Self::Stages<S>>,
    ) -> Self::Dense<S> {
        self.method.dense(flow, t, x, h, trial)
    }
}
