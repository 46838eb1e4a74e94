//! A flow or a guard that is not a number: the failure of a run, with the automaton's own reason
//! where it gives one.

use super::Automaton;
use crate::error::{Error, ErrorKind, Place};

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
