//! Where a run stands between two jumps: all that it takes to go on.

use std::fmt;
use std::ops::Range;

use crate::advance::Memory;
use crate::automaton::Automaton;
use crate::ending::{Limits, Stop};
use crate::recent::Recent;
use crate::state::State;
use crate::ticks::Ticks;
use crate::time::{Span, Time};
use crate::zeno::{Cascade, Contraction};

/// Everything a run needs to go on from just after a jump, to the bit.
///
/// [`Course::checkpoint`](crate::Course::checkpoint) takes it,
/// [`Simulation::resume`](crate::Simulation::resume) goes on from it; the feature `serde` writes
/// and reads it.
///
/// What is written bears the number of its format, and one of another number is refused: a run goes
/// on to the bit only with what it was begun with. Modes and edges of a [`Hybrid`](crate::Hybrid)
/// are names, which are borrowed from the text that is read: let it last by [`String::leak`]. Lists
/// of more than 32 coordinates are read and written as `SVector`.
///
/// ```
/// use saltus::{Hybrid, Simulation, Stop};
/// let tank = Hybrid::new()
///     .mode("fill", |_t, _x: &f64| 1.0)
///     .edge("fill", "fill", |_t, x| 2.0 - x, |_t, _x| 0.0);
/// let mut first = Simulation::of(&tank).most_jumps(3).start("fill", 0.0, 0.0..10.5)?;
/// assert_eq!(first.finish(&mut ())?.stop, Stop::Jumps { most: 3 });
/// let checkpoint = first.checkpoint();
/// assert!((checkpoint.time().seconds() - 6.0).abs() < 1e-12);
/// // With a higher limit it goes on from there.
/// let end = Simulation::of(&tank).resume(checkpoint).finish(&mut ())?;
/// assert_eq!((end.stop, end.jumps), (Stop::Time, 5));
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone)]
pub struct Checkpoint<M, E, S> {
    #[cfg_attr(not(feature = "serde"), allow(dead_code))] // what is written and read
    format: Format,
    pub(crate) at: Stage<M, E, S>,
    pub(crate) memory: Memory<M, E, S>,
}

/// Where a run stands, without what the search for crossings remembers.
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone)]
pub(crate) struct Stage<M, E, S> {
    pub(crate) mode: M,
    pub(crate) state: S,
    pub(crate) span: Span,
    pub(crate) jumps: usize,
    /// The time of the last jump that was not at once after another.
    pub(crate) instant: Time,
    pub(crate) cascade: Cascade,
    pub(crate) contraction: Contraction<S>,
    pub(crate) recent: Recent<E>,
    pub(crate) ticks: Ticks<M>,
    pub(crate) limits: Limits,
    pub(crate) stop: Option<Stop<E>>,
}

/// The format of a checkpoint that is written: a number, raised whenever a field is added, removed
/// or changes its meaning (tests/running.rs, `another_format_is_refused`).
#[derive(Clone, Copy, Debug)]
struct Format;

#[cfg(feature = "serde")]
mod format {
    use super::Format;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    const NUMBER: u32 = 20;

    impl Serialize for Format {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            NUMBER.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for Format {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            match u32::deserialize(deserializer)? {
                NUMBER => Ok(Self),
                other => Err(D::Error::custom(format_args!(
                    "a checkpoint of format {other}, and this version of saltus reads format {NUMBER}: go on with the version that wrote it, or run again from the start"
                ))),
            }
        }
    }
}

/// A checkpoint of the automaton `A`.
pub type CheckpointOf<A> = Checkpoint<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

/// Where a run of the automaton `A` stands.
pub(crate) type StageOf<A> = Stage<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

impl<M: Copy + PartialEq + fmt::Debug, E: Copy + PartialEq, S: State> Stage<M, E, S> {
    #[inline(always)]
    pub(crate) fn start(mode: M, state: S, span: Range<f64>) -> Self {
        let start = Time::new(span.start);
        let span = Span { start, now: start, end: Time::new(span.end) };
        Self {
            mode,
            state,
            span,
            jumps: 0,
            instant: start,
            cascade: Cascade::NONE,
            contraction: Contraction::new(),
            recent: Recent::new(),
            ticks: Ticks::new(),
            limits: Limits::default(),
            stop: None,
        }
    }
}

impl<M, E, S> Checkpoint<M, E, S> {
    pub(crate) const fn new(at: Stage<M, E, S>, memory: Memory<M, E, S>) -> Self {
        Self { format: Format, at, memory }
    }

    /// When it was taken.
    #[must_use]
    pub const fn time(&self) -> Time {
        self.at.span.now
    }
}

impl<M: fmt::Debug, E, S: State> fmt::Debug for Stage<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, state, span, jumps, .. } = self;
        write!(f, "{mode:?} {state:?} at (t = {}, j = {jumps})", span.now.seconds())
    }
}

impl<M: fmt::Debug, E, S: State> fmt::Debug for Checkpoint<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.at.fmt(f)
    }
}
