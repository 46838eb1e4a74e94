//! The steppers of the engine as one, chosen as a plan is made: so that each model is compiled once.

use saltus::step::{Either, Stepper as Step, Trial};
use saltus::{Dop853, Rodas5P, State, Tsit5};

use crate::scene::Stepper;

/// Tolerances below this are [`Dop853`]'s, as for [`saltus::Auto`].
const TIGHT: f64 = 1e-7;

/// One of the engine's methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Method(pub(super) Stepper);

impl Method {
    /// What the scene names, or what its tolerance asks for.
    pub(super) fn of(named: Option<Stepper>, tolerance: f64) -> Self {
        Self(named.unwrap_or(if tolerance < TIGHT { Stepper::Dop853 } else { Stepper::Tsit5 }))
    }

    pub(super) const fn name(self) -> &'static str {
        match self.0 {
            Stepper::Tsit5 => "Tsit5",
            Stepper::Dop853 => "Dop853",
            Stepper::Rodas5p => "Rodas5P",
        }
    }

    pub(super) const fn is_stiff(self) -> bool {
        matches!(self.0, Stepper::Rodas5p)
    }
}

/// For models that a formula solves in every mode: it is never asked for a step, and would have none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unasked;

impl From<Method> for Unasked {
    fn from(_: Method) -> Self {
        Self
    }
}

impl Step for Unasked {
    type Stages<S: State> = ();
    type Dense<S: State> = [S; 1];

    fn error_order(&self) -> f64 {
        1.0
    }
    fn trial<S: State>(&self, _: &mut impl FnMut(f64, &S) -> S, _: f64, x: &S, slope: &S, _: f64) -> Trial<S, ()> {
        Trial { end: x.with(|_| f64::NAN), slope: *slope, stages: () }
    }
    fn error<S: State>(&self, _: f64, _: &Trial<S, ()>, _: impl Fn(&S) -> f64) -> f64 {
        f64::NAN
    }
    fn dense<S: State>(&self, _: &mut impl FnMut(f64, &S) -> S, _: f64, x: &S, _: f64, _: &Trial<S, ()>) -> [S; 1] {
        [*x]
    }
}

/// Of an explicit method, or of the stiff one.
type Either3<A, B, C> = Either<Either<A, B>, C>;

impl Step for Method {
    type Stages<S: State> =
        Either3<<Tsit5 as Step>::Stages<S>, <Dop853 as Step>::Stages<S>, <Rodas5P as Step>::Stages<S>>;
    type Dense<S: State> = Either3<<Tsit5 as Step>::Dense<S>, <Dop853 as Step>::Dense<S>, <Rodas5P as Step>::Dense<S>>;

    fn predictive(&self) -> bool {
        match self.0 {
            Stepper::Tsit5 => Tsit5.predictive(),
            Stepper::Dop853 => Dop853.predictive(),
            Stepper::Rodas5p => Rodas5P.predictive(),
        }
    }

    fn error_order(&self) -> f64 {
        match self.0 {
            Stepper::Tsit5 => Tsit5.error_order(),
            Stepper::Dop853 => Dop853.error_order(),
            Stepper::Rodas5p => Rodas5P.error_order(),
        }
    }

    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, Self::Stages<S>> {
        match self.0 {
            Stepper::Tsit5 => {
                let Trial { end, slope, stages } = Tsit5.trial(flow, t, x, slope, h);
                Trial { end, slope, stages: Either::Loose(Either::Loose(stages)) }
            }
            Stepper::Dop853 => {
                let Trial { end, slope, stages } = Dop853.trial(flow, t, x, slope, h);
                Trial { end, slope, stages: Either::Loose(Either::Tight(stages)) }
            }
            Stepper::Rodas5p => {
                let Trial { end, slope, stages } = Rodas5P.trial(flow, t, x, slope, h);
                Trial { end, slope, stages: Either::Tight(stages) }
            }
        }
    }

    fn error<S: State>(&self, h: f64, trial: &Trial<S, Self::Stages<S>>, norm: impl Fn(&S) -> f64) -> f64 {
        let Trial { end, slope, stages } = *trial;
        match stages {
            Either::Loose(Either::Loose(stages)) => Tsit5.error(h, &Trial { end, slope, stages }, norm),
            Either::Loose(Either::Tight(stages)) => Dop853.error(h, &Trial { end, slope, stages }, norm),
            Either::Tight(stages) => Rodas5P.error(h, &Trial { end, slope, stages }, norm),
        }
    }

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
            Either::Loose(Either::Loose(stages)) => {
                Either::Loose(Either::Loose(Tsit5.dense(flow, t, x, h, &Trial { end, slope, stages })))
            }
            Either::Loose(Either::Tight(stages)) => {
                Either::Loose(Either::Tight(Dop853.dense(flow, t, x, h, &Trial { end, slope, stages })))
            }
            Either::Tight(stages) => Either::Tight(Rodas5P.dense(flow, t, x, h, &Trial { end, slope, stages })),
        }
    }
}
