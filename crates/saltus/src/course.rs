//! The loop: advance an arc to its first crossing, jump, look again.

use std::fmt;
use std::ops::Range;

use crate::advance::{Advance, ArcEnd, Held, Memory, Smooth, later_stop};
use crate::automaton::{Automaton, Limit};
use crate::ending::Options;
use crate::ending::{Ending, EndingOf, Limits, Stats, Stop};
use crate::error::{Error, ErrorKind, Place, Refusal, listed};
use crate::jump::{Cause, Jump};
use crate::observe::Observer;
use crate::piece::Piece;
use crate::recent::Recent;
use crate::series::Tape;
use crate::state::State;
use crate::step::{Auto, Stepper};
use crate::ticks::Ticks;
use crate::time::{Span, Time};
use crate::zeno::{Cascade, Contraction};

/// A run in progress, advanced one arc and its jump at a time: for loops that belong to somebody
/// else, and for runs that must survive a pause.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Hybrid, Simulation};
///
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.8 * x[1]]);
/// let simulation = Simulation::of(&ball);
/// let mut course = simulation.start("flight", vector![1.0, 0.0], 0.0..3.0)?;
///
/// course.advance(&mut ())?; // to just after the first impact
/// assert_eq!(course.jumps(), 1);
/// let pause = course.checkpoint();
///
/// let (one, other) = (course.finish(&mut ())?, simulation.resume(pause).finish(&mut ())?);
/// assert_eq!(one.state, other.state);
/// # Ok::<(), saltus::Error>(())
/// ```
pub struct Course<'a, A: Automaton, M = Auto> {
    automaton: &'a A,
    stepper: M,
    options: Options,
    at: CheckpointOf<A>,
    tape: Tape,
    held: Held<A>,
}

/// Where a run stands just after a jump, handed on to the next arc: read back from where it is
/// kept, it would be waited for, by a fifth of a ball's impact.
struct Stand<A: Automaton> {
    mode: A::Mode,
    state: A::State,
    now: Time,
    /// See [`Checkpoint`]; nothing where that is now, as it mostly is.
    instant: Option<Time>,
}

/// What comes after an arc and the jump at its end.
enum Next<A: Automaton> {
    Arc,
    /// Infinitely many jumps in the time that remains; not `certified` where rounding hides
    /// whether.
    Limit {
        remaining: f64,
        certified: bool,
    },
    Stop(Stop<A::Edge>),
}

/// Everything a run needs to go on from just after a jump, to the bit. [`Course::checkpoint`] takes
/// it, [`Simulation::resume`](crate::Simulation::resume) goes on from it; the feature `serde`
/// writes and reads it.
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
    mode: M,
    state: S,
    span: Span,
    jumps: usize,
    /// The time of the last jump that was not at once after another.
    instant: Time,
    cascade: Cascade,
    contraction: Contraction<S>,
    recent: Recent<E>,
    ticks: Ticks<M>,
    limits: Limits,
    memory: Memory<E, S>,
    stop: Option<Stop<E>>,
}

/// The format of a checkpoint that is written: a number, raised whenever a field is added, removed
/// or changes its meaning (tests/running.rs, `another_format_is_refused`).
#[derive(Clone, Copy, Debug)]
struct Format;

#[cfg(feature = "serde")]
mod format {
    use super::Format;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    const NUMBER: u32 = 8;

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

impl<M: Copy + PartialEq + fmt::Debug, E: Copy + PartialEq, S: State> Checkpoint<M, E, S> {
    pub(crate) fn start(mode: M, state: S, span: Range<f64>, memory: Memory<E, S>) -> Self {
        let start = Time::new(span.start);
        let span = Span { start, now: start, end: Time::new(span.end) };
        Self {
            format: Format,
            mode,
            state,
            span,
            jumps: 0,
            instant: start,
            cascade: Cascade::NONE,
            contraction: Contraction::new(&state),
            recent: Recent::new(),
            ticks: Ticks::new(),
            limits: Limits::default(),
            memory,
            stop: None,
        }
    }

    /// When it was taken.
    #[must_use]
    pub fn time(&self) -> Time {
        self.span.now
    }

    /// No longer ended by a limit that these options have raised.
    pub(crate) fn under(mut self, options: &Options) -> Self {
        self.stop = self.stop.filter(|stop| !stop.is_lifted(options));
        self
    }
}

impl<M: fmt::Debug, E, S: State> fmt::Debug for Checkpoint<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, state, span, jumps, .. } = self;
        write!(f, "{mode:?} {state:?} at (t = {}, j = {jumps})", span.now.seconds())
    }
}

impl<A: Automaton, M> fmt::Debug for Course<'_, A, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.at.fmt(f)
    }
}

impl<'a, A: Automaton, M: Stepper> Course<'a, A, M> {
    pub(crate) fn new(automaton: &'a A, stepper: M, options: Options, at: CheckpointOf<A>) -> Self {
        Self { automaton, stepper, options, at, tape: Tape::new(), held: Held::default() }
    }

    /// The time reached.
    #[must_use]
    pub fn time(&self) -> Time {
        self.at.span.now
    }

    /// The mode reached.
    #[must_use]
    pub fn mode(&self) -> A::Mode {
        self.at.mode
    }

    /// The state reached, x⁺ of the last jump.
    #[must_use]
    pub fn state(&self) -> A::State {
        self.at.state
    }

    /// How many jumps there have been.
    #[must_use]
    pub fn jumps(&self) -> usize {
        self.at.jumps
    }

    /// What it has cost so far.
    #[must_use]
    pub fn stats(&self) -> Stats {
        Stats { jumps: self.at.jumps, ..self.at.memory.stats }
    }

    /// What it takes to go on from here.
    #[must_use]
    pub fn checkpoint(&self) -> CheckpointOf<A> {
        self.at.clone()
    }

    /// Advances to the end.
    ///
    /// # Errors
    /// See [`Error`]; the observer has had everything before it, and the course stays
    /// where it was.
    pub fn finish(&mut self, observer: &mut impl Observer<A>) -> Result<EndingOf<A>, Error> {
        let stop = match self.stopped() {
            Some(stop) => stop,
            None => {
                let mut stand = self.stand();
                loop {
                    if let Some(stop) = self.step(&mut stand, observer)? {
                        break stop;
                    }
                }
            }
        };
        self.at.stop = Some(stop);
        let Checkpoint { mode, state, span, jumps, limits, .. } = self.at;
        Ok(Ending { stop, stats: self.stats(), time: span.now, jumps, mode, state, limits })
    }

    /// Advances through one arc and the jump at its end; says why the run is over, once it is.
    ///
    /// # Errors
    /// See [`Error`].
    #[inline]
    pub fn advance(&mut self, observer: &mut impl Observer<A>) -> Result<Option<Stop<A::Edge>>, Error> {
        self.at.stop = self.stopped();
        if self.at.stop.is_none() {
            self.at.stop = self.step(&mut self.stand(), observer)?;
        }
        Ok(self.at.stop)
    }

    /// Why it goes no further, before another arc.
    fn stopped(&self) -> Option<Stop<A::Edge>> {
        let most = self.options.most_jumps;
        self.at.stop.or((self.at.jumps >= most).then_some(Stop::Jumps { most }))
    }

    #[inline]
    fn stand(&self) -> Stand<A> {
        let Checkpoint { mode, state, span: Span { now, .. }, instant, .. } = self.at;
        Stand { mode, state, now, instant: (instant != now).then_some(instant) }
    }

    #[inline]
    fn step(&mut self, stand: &mut Stand<A>, observer: &mut impl Observer<A>) -> Result<Option<Stop<A::Edge>>, Error> {
        Ok(match self.arc_and_jump(stand, observer)? {
            Next::Arc => None,
            Next::Stop(stop) => Some(stop),
            Next::Limit { remaining, certified } => {
                if let Some(stop) = self.stopped() {
                    return Ok(Some(stop));
                }
                let stop = self.at_limit(remaining, certified, observer)?;
                *stand = self.stand();
                stop.or_else(|| self.stopped())
            }
        })
    }

    #[inline]
    fn arc_and_jump(&mut self, stand: &mut Stand<A>, observer: &mut impl Observer<A>) -> Result<Next<A>, Error> {
        let Self { automaton, stepper, options, at, tape, held } = self;
        // x is x⁺ of the last jump, or the initial state.
        let Stand { mode, state: x, now: began, instant } = *stand;
        let mut span = Span { now: began, ..at.span };
        let due = at.ticks.next(*automaton, mode, &x, &span)?;
        if let Some(due) = &due {
            span.end = later_stop(&automaton.stops(mode), due.time);
        }
        let memory = &mut at.memory;
        let mut arc = Advance {
            automaton: *automaton,
            stepper: *stepper,
            options: &*options,
            memory,
            tape,
            held,
            smooth: Smooth::ALWAYS,
        };
        let (edge, time, before, ticked) = match arc.arc(mode, &x, &span, observer)? {
            ArcEnd::Crossing { edge, time, before } => (edge, time, before, false),
            ArcEnd::Stop { stop, time, state } => match due {
                Some(due) if matches!(stop, Stop::Time) => {
                    at.ticks.take(&due, time.seconds());
                    (due.edge, time, state, true)
                }
                _ => {
                    (at.span.now, at.state) = (time, state);
                    let endless = matches!(stop, Stop::Time) && at.span.end.seconds() == f64::INFINITY;
                    return Ok(Next::Stop(if endless { Stop::Forever } else { stop }));
                }
            },
        };
        if std::mem::take(&mut arc.memory.spurious) {
            (at.span.now, at.state) = (time, before);
            at.recent.push(edge);
            let certified = at.contraction.remaining(time.since(at.span.start), true).is_some();
            return Ok(Next::Limit { remaining: 0.0, certified });
        }
        // Here x⁻ = before, still inside the domain of the mode.
        let now = time.seconds();
        let (to, after) =
            automaton.reset(mode, edge, now, &before).map_err(|refusal| refused(refusal, now, mode, edge, &before))?;
        let duration = time.since(began);
        let since = instant.map_or(duration, |instant| time.since(instant));
        let at_once = arc.memory.at_once(since);
        let held = if at_once { Some(instant.unwrap_or(began)) } else { None };
        let instant = held.unwrap_or(time);
        // The same edge taken again at once changes nothing: the limit is here.
        let stands = !ticked && duration == 0.0 && arc.memory.just_took(edge) && to == mode && same(&x, &after);
        if !stands {
            if at_once {
                at.cascade = at.cascade.and(&x, &after);
            } else if at.cascade.jumps() > 0 {
                at.cascade = Cascade::NONE;
            }
            at.instant = instant;
            if !after.is_finite() || to != mode && automaton.validate(to, now, &after).is_err() {
                let (kind, note) = wrong(*automaton, to, now, after);
                return Err(Error::new(kind, Place::new(now, mode, Some(edge), &before)).noting(Some(note)));
            }
            // From where it was computed, not by way of the jump, which lies in memory: that copy
            // alone took a fifth of a ball's impact.
            (at.span.now, at.mode, at.state, at.jumps) = (time, to, after, at.jumps + 1);
            let jump = Jump { time: instant, j: at.jumps, cause: Cause::Edge(edge), from: mode, before, to, after };
            if observer.jump(&jump).is_break() {
                return Ok(Next::Stop(Stop::Observer));
            }
            let about = automaton.about(edge);
            if about.terminal || about.undetermined {
                return Ok(Next::Stop(if about.terminal {
                    Stop::Terminal { edge }
                } else {
                    Stop::Undetermined { edge }
                }));
            }
        }
        arc.jumped((mode, &x, began.seconds()), (edge, &before, now), (!at_once).then_some(duration));
        arc.landed(edge, &before, (to, now, &after));
        at.recent.push(edge);
        at.contraction.push(if at_once { 0.0 } else { duration }, &after);
        let elapsed = time.since(at.span.start);
        let remaining = if stands { Some(0.0) } else { at.contraction.remaining(elapsed, at.memory.hides_durations()) };
        if let Some(remaining) = remaining.filter(|&s| time.after(s).seconds() <= at.span.end.seconds()) {
            return Ok(Next::Limit { remaining, certified: true });
        }
        let next = self.after_jump(edge, now);
        if matches!(next, Next::Arc) {
            *stand = Stand { mode: to, state: after, now: time, instant: held };
        }
        Ok(next)
    }

    /// What follows a jump at time `t`: another arc, unless jumps at one time contract or a limit
    /// of the run is reached.
    #[inline]
    fn after_jump(&self, edge: A::Edge, t: f64) -> Next<A> {
        let Self { automaton, options, at, .. } = self;
        // Collisions that go on at one time: where they contract, what lies beyond them is the
        // model's to say.
        let beyond = |edges: &[A::Edge]| automaton.beyond(&Limit::new(at.mode, edges, t, &at.state));
        if at.jumps >= options.most_jumps {
            Next::Stop(Stop::Jumps { most: options.most_jumps })
        } else if at.cascade.contracts(options.longest_cascade) && at.recent.cycle().with(beyond).is_some() {
            Next::Limit { remaining: 0.0, certified: true }
        } else if at.cascade.jumps() >= options.longest_cascade {
            Next::Stop(Stop::Cascade { edge })
        } else if at.memory.stats.evaluations() >= options.most_evaluations {
            Next::Stop(Stop::Evaluations { most: options.most_evaluations })
        } else {
            options.overdue().map_or(Next::Arc, Next::Stop)
        }
    }

    /// Jumps have accumulated: the state stands for the rest of the time to the limit, too short to
    /// resolve, and the model says what lies beyond.
    #[cold]
    fn at_limit(
        &mut self,
        remaining: f64,
        certified: bool,
        observer: &mut impl Observer<A>,
    ) -> Result<Option<Stop<A::Edge>>, Error> {
        let Self { automaton, at, .. } = self;
        let (mode, x) = (at.mode, at.state);
        if remaining > 0.0 && observer.piece(mode, &Piece::new(at.span.now, remaining, 1.0, &[x])).is_break() {
            return Ok(Some(Stop::Observer));
        }
        at.span.now = at.span.now.after(remaining);
        let limit = at.span.now.seconds();
        let beyond = |edges: &[A::Edge]| automaton.beyond(&Limit::new(mode, edges, limit, &x));
        let Some((to, after)) = at.recent.cycle().with(beyond) else {
            return Ok(Some(if certified { Stop::Zeno { limit } } else { Stop::Resolution { limit } }));
        };
        if !after.is_finite() || automaton.validate(to, limit, &after).is_err() {
            let (kind, note) = wrong(*automaton, to, limit, after);
            let note = if kind == ErrorKind::Model { format!("Automaton::beyond {note}") } else { note };
            return Err(Error::new(kind, Place::new(limit, mode, None::<A::Edge>, &x)).noting(Some(note)));
        }
        at.instant = at.span.now;
        at.limits = Limits { count: at.limits.count + 1, last: Some(limit) };
        let jump = Jump { time: at.instant, j: at.jumps + 1, cause: Cause::Zeno, from: mode, before: x, to, after };
        (at.mode, at.state, at.jumps) = (to, after, jump.j);
        (at.contraction, at.recent, at.cascade) = (Contraction::new(&after), Recent::new(), Cascade::NONE);
        at.memory.beyond();
        Ok(observer.jump(&jump).is_break().then_some(Stop::Observer))
    }
}

/// The failure of a run whose reset refuses.
#[cold]
#[inline(never)]
fn refused<X: State>(refusal: Refusal, t: f64, mode: impl fmt::Debug, edge: impl fmt::Debug, x: &X) -> Error {
    refusal.at(Place::new(t, mode, Some(edge), x))
}

/// What is wrong with a mode and a state that a jump led to and that cannot be gone on from.
#[cold]
fn wrong<A: Automaton>(automaton: &A, to: A::Mode, t: f64, x: A::State) -> (ErrorKind, String) {
    match automaton.validate(to, t, &x) {
        Err(flaw) if x.is_finite() => (ErrorKind::Model, format!("leads to mode {to:?}: {flaw}")),
        _ => (ErrorKind::Reset, listed(&x)),
    }
}

/// Whether two states are equal coordinate by coordinate.
fn same<S: State>(x: &S, y: &S) -> bool {
    x.len() == y.len() && (0..x.len()).all(|i| x.get(i) == y.get(i))
}
