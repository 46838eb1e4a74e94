//! Auto: Tsit5 or Dop853, by the tolerance.

use super::{Dop853, Either, Stepper, Trial, Tsit5};
use crate::state::State;

/// The default: [`Tsit5`] down to a relative tolerance of 1e-7, [`Dop853`] below.
///
/// Chosen once, at the start of a run; a step pays a branch and some copies for it. Where the two cost the same for the same error was measured: at a
/// tolerance of 1e-5 to 1e-6 on the Arenstorf orbit, where steps are many, and of 1e-7 to 1e-8 for a ball in air, whose arcs end after a
/// step or two. A flow with a kink inside an arc keeps [`Tsit5`] ahead down to 1e-9.
///
/// A stiff flow wants [`Rodas5P`](super::Rodas5P), which is never chosen.
///
/// ```
/// use saltus::step::{Auto, Stepper};
/// assert_eq!(Auto::default().for_tolerance(1e-6).error_order(), 5.0);
/// assert_eq!(Auto::default().for_tolerance(1e-9).error_order(), 8.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Auto(Either<Tsit5, Dop853>);

impl Auto {
    /// The loosest relative tolerance for which [`Tsit5`] is not the choice.
    pub const TIGHT: f64 = 1e-7;

    /// As [`default`](Default::default), where a constant is needed.
    #[must_use]
    pub const fn new() -> Self {
        Self(Either::Loose(Tsit5))
    }
}

impl Stepper for Auto {
    type Stages<S: State> = <Either<Tsit5, Dop853> as Stepper>::Stages<S>;
    type Dense<S: State> = <Either<Tsit5, Dop853> as Stepper>::Dense<S>;

    fn for_tolerance(self, relative: f64) -> Self {
        Self(if relative < Self::TIGHT { Either::Tight(Dop853) } else { Either::Loose(Tsit5) })
    }

    fn predictive(&self) -> bool {
        self.0.predictive()
    }

    #[inline]
    fn error_order(&self) -> f64 {
        self.0.error_order()
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
        self.0.trial(flow, t, x, slope, h)
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>, square: impl Fn(&S) -> f64) -> f64 {
        self.0.error(h, trial, square)
    }

    #[inline]
    fn reach<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>) -> Option<S> {
        self.0.reach(h, trial)
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
        self.0.dense(flow, t, x, h, trial)
    }
}
