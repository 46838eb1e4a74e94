//! A jump: its time and cause, and both limits of the state.

use std::fmt;

use crate::automaton::Automaton;
use crate::state::State;
use crate::time::Time;

/// Why a jump happened.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Cause<E> {
    /// An edge was taken.
    Edge(E),
    /// Jumps accumulated here, and the model gave what lies beyond.
    Zeno,
}

/// A jump, with both its limits.
///
/// ```
/// use saltus::{Cause, Hybrid, Simulation};
/// let heater = Hybrid::new()
///     .mode("on", |_t, _x: &f64| 1.0)
///     .mode("off", |_t, _x| -1.0)
///     .edge("on", "off", |_t, x| 22.0 - x, |_t, x| x - 0.5);
/// let run = Simulation::of(&heater).run("on", 20.0, 0.0..3.0)?;
/// let jump = run.trajectory.jumps()[0];
/// assert!((jump.t() - 2.0).abs() < 1e-12 && (jump.before - 22.0).abs() < 1e-12);
/// assert_eq!((jump.from, jump.to, jump.j), ("on", "off", 1));
/// assert_eq!(jump.after, jump.before - 0.5);
/// assert!(matches!(jump.cause, Cause::Edge(edge) if Some(edge) == jump.edge()));
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone, Copy)]
pub struct Jump<M, E, S> {
    /// When.
    pub time: Time,
    /// How many jumps there have been, this one included: the j of hybrid time just after it.
    pub j: usize,
    /// Why.
    pub cause: Cause<E>,
    /// The mode before.
    pub from: M,
    /// The state just before, x⁻; inside the domain of the mode before.
    pub before: S,
    /// The mode after.
    pub to: M,
    /// The state just after, x⁺.
    pub after: S,
}

/// A jump of the automaton `A`.
pub type JumpOf<A> = Jump<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

impl<M: fmt::Debug, E: fmt::Debug, S: State> fmt::Debug for Jump<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, j, cause, from, before, to, after } = self;
        write!(f, "(t = {}, j = {j}) by {cause:?}: {from:?} {before:?} -> {to:?} {after:?}", time.seconds())
    }
}

impl<M, E, S> Jump<M, E, S> {
    /// When, to the nearest double, in seconds.
    #[must_use]
    pub const fn t(&self) -> f64 {
        self.time.seconds()
    }

    /// The edge taken, if one was.
    #[must_use]
    pub fn edge(&self) -> Option<E>
    where
        E: Copy,
    {
        match self.cause {
            Cause::Edge(edge) => Some(edge),
            Cause::Zeno => None,
        }
    }
}
