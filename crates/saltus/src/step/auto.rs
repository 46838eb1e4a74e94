//! Auto: Tsit5 or Dop853, by the tolerance; Rodas5P where a flow is stiff; or one of them alone.

use super::{Dop853, Either, Rodas5P, Stepper, Trial, Tsit5};
use crate::sparsity::Sparsity;
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
/// `Auto::from(Rodas5P)` takes the very steps of that method, whatever the flow: a choice by name
/// as a program runs, where a model is to be compiled once for all methods.
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
    choice: Choice,
    method: Method,
}

/// What is chosen from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Choice {
    /// Tsit5, and Rodas5P where the flow is stiff.
    #[default]
    Loose,
    /// Dop853, and Rodas5P where the flow is stiff.
    Tight,
    /// The one method.
    One,
}

type Method = Either<Either<Tsit5, Dop853>, Rodas5P>;

impl Auto {
    /// The loosest relative tolerance for which [`Tsit5`] is not the choice.
    pub const TIGHT: f64 = 1e-7;

    /// As [`default`](Default::default), where a constant is needed.
    #[must_use]
    pub const fn new() -> Self {
        Self { choice: Choice::Loose, method: Either::Loose(Either::Loose(Tsit5)) }
    }

    const fn one(method: Method) -> Self {
        Self { choice: Choice::One, method }
    }
}

impl From<Tsit5> for Auto {
    fn from(method: Tsit5) -> Self {
        Self::one(Either::Loose(Either::Loose(method)))
    }
}

impl From<Dop853> for Auto {
    fn from(method: Dop853) -> Self {
        Self::one(Either::Loose(Either::Tight(method)))
    }
}

impl From<Rodas5P> for Auto {
    fn from(method: Rodas5P) -> Self {
        Self::one(Either::Tight(method))
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
        match self.choice {
            Choice::One => self,
            _ if relative < Self::TIGHT => Self { choice: Choice::Tight, method: Self::from(Dop853).method },
            _ => Self::new(),
        }
    }

    fn stable_to(&self) -> Option<f64> {
        match self.choice {
            Choice::Loose => Some(TSIT5),
            Choice::Tight => Some(DOP853),
            Choice::One => None,
        }
    }

    fn adapted(self, stiff: bool) -> Self {
        let Self { method, .. } = match self.choice {
            Choice::One => self,
            _ if stiff => Self::from(Rodas5P),
            Choice::Loose => Self::from(Tsit5),
            Choice::Tight => Self::from(Dop853),
        };
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
        self.sparse(flow, t, x, slope, (h, None))
    }

    #[inline]
    fn sparse<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        step: (f64, Option<&Sparsity>),
    ) -> Trial<S, Self::Stages<S>> {
        self.method.sparse(flow, t, x, slope, step)
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
