//! One of two steppers, chosen as a program runs.

use super::{Stepper, Trial};
use crate::state::State;

/// One of two methods, or what one of them keeps: a choice that is made at run time, where a model is to be compiled once.
///
/// A step pays a branch and some copies for it. Of methods that count Jacobians, none are counted.
///
/// ```
/// use saltus::step::{Either, Stepper};
/// use saltus::{Dop853, Rodas5P, Tsit5};
/// let stiff = true;
/// let stepper: Either<Tsit5, Rodas5P> = if stiff { Either::Tight(Rodas5P) } else { Either::Loose(Tsit5) };
/// assert_eq!(stepper.error_order(), Rodas5P.error_order());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Either<L, T> {
    /// The first, for loose tolerances.
    Loose(L),
    /// The second, for tight ones.
    Tight(T),
}

impl<L: Default, T> Default for Either<L, T> {
    fn default() -> Self {
        Self::Loose(L::default())
    }
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

/// What a trial kept says which method made it.
impl<L: Stepper + Default, T: Stepper + Default> Stepper for Either<L, T> {
    type Stages<S: State> = Either<L::Stages<S>, T::Stages<S>>;
    type Dense<S: State> = Either<L::Dense<S>, T::Dense<S>>;

    fn jacobians(&self) -> u64 {
        match self {
            Self::Loose(method) => method.jacobians(),
            Self::Tight(method) => method.jacobians(),
        }
    }

    fn predictive(&self) -> bool {
        match self {
            Self::Loose(method) => method.predictive(),
            Self::Tight(method) => method.predictive(),
        }
    }

    #[inline]
    fn error_order(&self) -> f64 {
        match self {
            Self::Loose(method) => method.error_order(),
            Self::Tight(method) => method.error_order(),
        }
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
        match self {
            Self::Loose(method) => method.trial(flow, t, x, slope, h).with_stages(Either::Loose),
            Self::Tight(method) => method.trial(flow, t, x, slope, h).with_stages(Either::Tight),
        }
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>, square: impl Fn(&S) -> f64) -> f64 {
        let Trial { end, slope, stages } = trial;
        match stages {
            Either::Loose(stages) => L::default().error(h, Trial { end, slope, stages }, square),
            Either::Tight(stages) => T::default().error(h, Trial { end, slope, stages }, square),
        }
    }

    #[inline]
    fn reach<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>) -> Option<S> {
        let Trial { end, slope, stages } = trial;
        match stages {
            Either::Loose(stages) => L::default().reach(h, Trial { end, slope, stages }),
            Either::Tight(stages) => T::default().reach(h, Trial { end, slope, stages }),
        }
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
        let Trial { end, slope, stages } = trial;
        match stages {
            Either::Loose(stages) => Either::Loose(L::default().dense(flow, t, x, h, Trial { end, slope, stages })),
            Either::Tight(stages) => Either::Tight(T::default().dense(flow, t, x, h, Trial { end, slope, stages })),
        }
    }
}
