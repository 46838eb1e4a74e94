//! The steppers of the engine as one, chosen as a plan is made: so that each model is compiled
//! once.

use std::fmt;

use saltus::step::{Stepper as Step, Trial};
use saltus::{Auto, Dop853, Rodas5P, State, Tsit5};

use crate::Stepper;

/// A way to run a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Way {
    /// Formulas for every flight.
    Formulas,
    /// Steps to a relative tolerance.
    Steps {
        /// The stepper.
        stepper: Stepper,
        /// The tolerance.
        tolerance: f64,
    },
    /// Frame by frame, with contacts at the ends of frames, as game loops do.
    Frames {
        /// The rate in frames per second.
        rate: f64,
    },
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Formulas => f.write_str("formulas"),
            Self::Steps { stepper, tolerance } => write!(f, "{} {tolerance:.0e}", stepper.name()),
            Self::Frames { rate } => write!(f, "{rate} frames/s"),
        }
    }
}

/// One of the engine's methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Method(pub(super) Stepper);

impl Method {
    /// The method that the scene names, or that is fit for its tolerance.
    pub(super) fn of(named: Option<Stepper>, tolerance: f64) -> Self {
        let named = named.filter(|named| *named != Stepper::Series);
        Self(named.unwrap_or(if tolerance < Auto::TIGHT { Stepper::Dop853 } else { Stepper::Tsit5 }))
    }

    pub(super) const fn name(self) -> &'static str {
        self.0.name()
    }

    pub(super) const fn is_stiff(self) -> bool {
        matches!(self.0, Stepper::Rodas5p)
    }
}

impl From<Method> for Auto {
    fn from(method: Method) -> Self {
        match method.0 {
            Stepper::Tsit5 => Tsit5.into(),
            Stepper::Dop853 | Stepper::Series => Dop853.into(),
            Stepper::Rodas5p => Rodas5P.into(),
        }
    }
}

/// A stepper for models that a formula solves in every mode: it takes no step.
#[derive(Clone, Copy, Debug)]
pub(super) struct NoStepper;

impl From<Method> for NoStepper {
    fn from(_: Method) -> Self {
        Self
    }
}

impl Step for NoStepper {
    type Stages<S: State> = ();
    type Dense<S: State> = [S; 1];

    fn error_order(&self) -> f64 {
        1.0
    }
    fn trial<S: State>(&self, _: &mut impl FnMut(f64, &S) -> S, _: f64, x: &S, slope: &S, _: f64) -> Trial<S, ()> {
        Trial { end: x.with(|_| f64::NAN), slope: slope.clone(), stages: () }
    }
    fn error<S: State>(&self, _: f64, _: Trial<&S, &()>, _: impl Fn(&S) -> f64) -> f64 {
        f64::NAN
    }
    fn dense<S: State>(&self, _: &mut impl FnMut(f64, &S) -> S, _: f64, x: &S, _: f64, _: Trial<&S, &()>) -> [S; 1] {
        [x.clone()]
    }
}
