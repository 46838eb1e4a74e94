//! Auto: Tsit5 or Dop853, by the tolerance.

use super::{Dop853, Stepper, Trial, Tsit5};
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
pub struct Auto {
    tight: bool,
}

/// The loosest relative tolerance for which Tsit5 is not the choice.
const TIGHT: f64 = 1e-7;

/// What one of two methods keeps.
#[derive(Clone, Copy, Debug)]
pub enum Either<L, T> {
    /// Of [`Tsit5`].
    Loose(L),
    /// Of [`Dop853`].
    Tight(T),
}

impl<S, L: AsRef<[S]>, T: AsRef<[S]>> AsRef<[S]> for Either<L, T> {
    #[inline]
    fn as_ref(&self) -> &[S] {
        match self {
            Self::Loose(dense) => dense.as_ref(),
            Self::Tight(dense) => dense.as_ref(),
        }
    }
}

impl Auto {
    /// As [`default`](Default::default), where a constant is needed.
    #[must_use]
    pub const fn new() -> Self {
        Self { tight: false }
    }
}

impl Stepper for Auto {
    type Stages<S: State> = Either<<Tsit5 as Stepper>::Stages<S>, <Dop853 as Stepper>::Stages<S>>;
    type Dense<S: State> = Either<<Tsit5 as Stepper>::Dense<S>, <Dop853 as Stepper>::Dense<S>>;

    fn for_tolerance(self, relative: f64) -> Self {
        Self { tight: relative < TIGHT }
    }

    fn predictive(&self) -> bool {
        self.tight
    }

    #[inline]
    fn error_order(&self) -> f64 {
        if self.tight { Dop853.error_order() } else { Tsit5.error_order() }
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
        if self.tight {
            Dop853.trial(flow, t, x, slope, h).with_stages(Either::Tight)
        } else {
            Tsit5.trial(flow, t, x, slope, h).with_stages(Either::Loose)
        }
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: &Trial<S, Self::Stages<S>>, norm: impl Fn(&S) -> f64) -> f64 {
        let Trial { end, slope, stages } = *trial;
        match stages {
            Either::Loose(stages) => Tsit5.error(h, &Trial { end, slope, stages }, norm),
            Either::Tight(stages) => Dop853.error(h, &Trial { end, slope, stages }, norm),
        }
    }

    #[inline]
    fn dense<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        h: f64,
        trial: &Trial<S, Self::Stages<S>>,
    ) -> Self::Dense<S> {
        let Trial { end, slope, stages } = *trial;
        match stages {
            Either::Loose(stages) => Either::Loose(Tsit5.dense(flow, t, x, h, &Trial { end, slope, stages })),
            Either::Tight(stages) => Either::Tight(Dop853.dense(flow, t, x, h, &Trial { end, slope, stages })),
        }
    }
}
