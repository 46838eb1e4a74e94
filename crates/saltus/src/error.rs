//! What can go wrong in a run: what, where, and what to do.

use std::fmt;

use crate::state::State;

/// Why a run failed, with the time, mode, edge and state where it did.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: ErrorKind,
    place: Place,
}

/// Where a run failed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Place {
    pub(crate) t: f64,
    pub(crate) mode: String,
    pub(crate) edge: Option<String>,
    pub(crate) state: Vec<f64>,
}

impl Place {
    pub(crate) fn new(t: f64, mode: impl fmt::Debug, edge: Option<impl fmt::Debug>, state: &impl State) -> Self {
        Self {
            t,
            mode: format!("{mode:?}"),
            edge: edge.map(|edge| format!("{edge:?}")),
            state: (0..state.len()).map(|i| state.get(i)).collect(),
        }
    }
}

/// The kinds of failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The span runs backwards or is not a number.
    Span,
    /// The tolerances are not positive finite numbers.
    Tolerance,
    /// The initial state is not finite.
    InitialState,
    /// The mode is not one of the automaton's.
    UnknownMode,
    /// The flow is not finite, however short the step.
    Flow,
    /// The guard is not a number.
    Guard,
    /// The reset gave a state that is not finite.
    Reset,
    /// A guard is already negative as its mode is entered, and its edge refuses that.
    Entry,
    /// A crossing without speed, where derivatives were asked for: they do not exist there.
    Grazing,
    /// The step size fell below the spacing of time.
    StepSize,
}

impl Error {
    pub(crate) fn new(kind: ErrorKind, place: Place) -> Self {
        Self { kind, place }
    }

    /// What kind of failure it is.
    #[must_use]
    pub const fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// When it happened, in seconds.
    #[must_use]
    pub const fn t(&self) -> f64 {
        self.place.t
    }

    /// The mode it happened in, as its `Debug` writes it.
    #[must_use]
    pub fn mode(&self) -> &str {
        &self.place.mode
    }

    /// The edge concerned, if any, as its `Debug` writes it.
    #[must_use]
    pub fn edge(&self) -> Option<&str> {
        self.place.edge.as_deref()
    }

    /// The state it happened at.
    #[must_use]
    pub fn state(&self) -> &[f64] {
        &self.place.state
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Place { t, mode, edge, state } = &self.place;
        let edge = edge.as_deref().unwrap_or("?");
        match self.kind {
            ErrorKind::Span => {
                return write!(
                    f,
                    "the span must run forwards from a finite time: give start..end with start < end; to run backwards, implement Invertible and run Reversed"
                );
            }
            ErrorKind::Tolerance => {
                return write!(
                    f,
                    "the tolerances must be positive and finite: relative at least 1e-15, absolute above zero"
                );
            }
            ErrorKind::InitialState => write!(f, "the initial state is not finite: give finite coordinates")?,
            ErrorKind::UnknownMode => {
                f.write_str("there is no such mode: declare it, or start in and reset to a declared one")?;
            }
            ErrorKind::Flow => write!(
                f,
                "the flow is not finite, however short the step: check it for division by zero or roots of negative numbers near this state"
            )?,
            ErrorKind::Guard => write!(
                f,
                "the guard of edge {edge} is not a number: define it on the whole domain, or end the mode before"
            )?,
            ErrorKind::Reset => write!(f, "the reset of edge {edge} gave a state that is not finite")?,
            ErrorKind::Entry => write!(
                f,
                "the guard of edge {edge} is already negative as the mode is entered: correct the state or the reset, or let Automaton::entry answer Wait or Fire"
            )?,
            ErrorKind::Grazing => write!(
                f,
                "edge {edge} is crossed without speed (its guard's rate is zero to rounding), where the jump has no derivative: change the initial state or a parameter a little, or run without sensitivities"
            )?,
            ErrorKind::StepSize => write!(
                f,
                "the step size fell below the spacing of time: the solution may blow up, or the flow jump; loosen the tolerance or split the mode there"
            )?,
        }
        write!(f, " (t = {t}, mode {mode}, state {state:?})")
    }
}

impl std::error::Error for Error {}
