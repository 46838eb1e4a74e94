//! A flow or a guard that is not a number, with the automaton's own reason where it gives one; a
//! flow of another dimension: the failure of a run.

use std::fmt;

use super::Automaton;
use crate::error::{Error, ErrorKind, Place};
use crate::state::State;

/// The flow is not finite at (t, x); `which` coordinates, if only they are at fault.
#[cold]
pub(crate) fn flow_undefined<A: Automaton>(
    automaton: &A,
    mode: A::Mode,
    t: f64,
    x: &A::State,
    which: Option<String>,
) -> Error {
    let place = Place::new(t, mode, None::<A::Edge>, x);
    match automaton.refusal(mode, None, t, x) {
        Some(refusal) => refusal.at("flow", place),
        None => Error::new(ErrorKind::Flow, place).noting(which),
    }
}

/// The guard of `edge` is not a number at (t, x).
#[cold]
pub(crate) fn guard_undefined<A: Automaton>(
    automaton: &A,
    mode: A::Mode,
    edge: A::Edge,
    t: f64,
    x: &A::State,
) -> Error {
    let place = Place::new(t, mode, Some(edge), x);
    match automaton.refusal(mode, Some(edge), t, x) {
        Some(refusal) => refusal.at("guard", place),
        None => Error::new(ErrorKind::Guard, place),
    }
}

/// The flow, or its series, has another `dimension` than the state `x`.
#[cold]
pub(crate) fn wrong_dimension<X: State>(dimension: usize, mode: impl fmt::Debug, t: f64, x: &X) -> Error {
    let place = Place::new(t, mode, None::<()>, x);
    Error::new(ErrorKind::Dimension, place).noting(Some(dimension.to_string()))
}
