//! The loop: advance an arc to its first crossing, jump, look again.

use std::fmt;

use crate::advance::{Advance, ArcEnd, Begun, doubt, later_stop};
use crate::automaton::solution::Fall;
use crate::automaton::{Automaton, Limit};
use crate::checkpoint::{Checkpoint, CheckpointOf, Stage, StageOf};
use crate::cross::Doubt;
use crate::ending::{Ending, EndingOf, Limits, Options, Stats, Stop};
use crate::error::{Error, ErrorKind, Place, Refusal, listed};
use crate::jump::{Cause, Jump};
use crate::observe::Observer;
use crate::piece::Piece;
use crate::recent::Recent;
use crate::state::State;
use crate::step::{Auto, Stepper};
use crate::ticks::Due;
use crate::time::{Span, Time, resolution};
use crate::zeno::{Ahead, Cascade, Contraction};

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
    arc: Advance<'a, A, M>,
    at: StageOf<A>,
}

/// Where a run stands just after a jump, handed on to the next arc: read back from where it is
/// kept, it would be waited for.
#[derive(Clone)]
struct Stand<M, S> {
    mode: M,
    state: S,
    now: Time,
    /// The time since the run began.
    elapsed: f64,
}

type StandOf<A> = Stand<<A as Automaton>::Mode, <A as Automaton>::State>;

/// The end of an arc where a jump follows.
struct Crossed<A: Automaton> {
    edge: A::Edge,
    time: Time,
    /// x⁻.
    before: A::State,
    /// Whether a clock made it.
    ticked: bool,
}

/// What comes after an arc and the jump at its end.
enum Next<A: Automaton> {
    Arc,
    /// Infinitely many jumps up to a limit ahead.
    Limit(Ahead),
    Stop(Stop<A::Edge>),
}

impl<A: Automaton, M> fmt::Debug for Course<'_, A, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.at.fmt(f)
    }
}

impl<'a, A: Automaton, M: Stepper> Course<'a, A, M> {
    #[inline(always)]
    pub(crate) fn new(arc: Advance<'a, A, M>, at: StageOf<A>) -> Self {
        Self { arc, at }
    }

    /// Goes on from a checkpoint; no longer ended by a limit that these options have raised.
    pub(crate) fn from(automaton: &'a A, stepper: M, options: Options, checkpoint: CheckpointOf<A>) -> Self {
        let Checkpoint { mut at, memory, .. } = checkpoint;
        at.stop = at.stop.filter(|stop| !stop.is_lifted(&options));
        Self::new(Advance::new(automaton, stepper, options, memory), at)
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
        self.at.state.clone()
    }

    /// How many jumps there have been.
    #[must_use]
    pub fn jumps(&self) -> usize {
        self.at.jumps
    }

    /// What it has cost so far.
    #[must_use]
    pub fn stats(&self) -> Stats {
        Stats { jumps: self.at.jumps, ..self.arc.memory.stats }
    }

    /// What it takes to go on from here.
    #[must_use]
    pub fn checkpoint(&self) -> CheckpointOf<A> {
        Checkpoint::new(self.at.clone(), self.arc.memory.clone())
    }

    /// The run begins just after a jump by `edge`, whose root is spent.
    #[cfg(feature = "num-dual")]
    pub(crate) fn begin_behind(&mut self, edge: A::Edge) {
        let Stage { mode, span: Span { now, .. }, .. } = self.at;
        self.arc.begin_behind(mode, edge, now.seconds(), &self.at.state);
    }

    /// Advances to the end.
    ///
    /// # Errors
    /// See [`Error`]; the observer has had everything before it, and the course stays
    /// where it was.
    #[inline]
    pub fn finish(&mut self, observer: &mut impl Observer<A>) -> Result<EndingOf<A>, Error> {
        let Stand { mode, state, now, .. } = self.stand();
        self.finish_from(mode, &state, now, observer)
    }

    /// A loop that keeps its registers to itself, whoever calls it; what it begins with is handed
    /// on.
    #[inline(never)]
    fn finish_from(
        &mut self,
        mode: A::Mode,
        state: &A::State,
        now: Time,
        observer: &mut impl Observer<A>,
    ) -> Result<EndingOf<A>, Error> {
        let stop = match self.stopped() {
            Some(stop) => stop,
            None => {
                let mut stand = Stand { mode, state: state.clone(), now, elapsed: now.since(self.at.span.start) };
                loop {
                    if let Some(stop) = self.step(&mut stand, observer)? {
                        break stop;
                    }
                }
            }
        };
        self.at.stop = Some(stop);
        let Stage { mode, span, jumps, limits, .. } = self.at;
        let state = self.at.state.clone();
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
        let most = self.arc.options.most_jumps;
        self.at.stop.or((self.at.jumps >= most).then_some(Stop::Jumps { most }))
    }

    #[inline]
    fn stand(&self) -> StandOf<A> {
        let Stage { mode, span: Span { start, now, .. }, .. } = self.at;
        Stand { mode, state: self.at.state.clone(), now, elapsed: now.since(start) }
    }

    #[inline]
    fn step(
        &mut self,
        stand: &mut StandOf<A>,
        observer: &mut impl Observer<A>,
    ) -> Result<Option<Stop<A::Edge>>, Error> {
        Ok(match self.arc_and_jump(stand, observer)? {
            Next::Arc => None,
            Next::Stop(stop) => Some(stop),
            Next::Limit(ahead) => {
                if let Some(stop) = self.stopped() {
                    return Ok(Some(stop));
                }
                let stop = self.at_limit(ahead, observer)?;
                *stand = self.stand();
                stop.or_else(|| self.stopped())
            }
        })
    }

    /// An arc and the jump at its end.
    ///
    /// Where a formula gives the end, the jump is compiled into the loop, and its state stays in
    /// registers; each other arc is long beside a copy by way of memory.
    #[inline(always)]
    fn arc_and_jump(&mut self, stand: &mut StandOf<A>, observer: &mut impl Observer<A>) -> Result<Next<A>, Error> {
        let automaton = self.arc.automaton;
        // x is x⁺ of the last jump, or the initial state.
        let Stand { mode, state: x, now, elapsed } = stand.clone();
        let Span { start, end, .. } = self.at.span;
        let due = self.at.ticks.next(automaton, mode, &x, &Span { start, now, end })?;
        let end = due.as_ref().map_or(end, |due| later_stop(&automaton.stops(mode), due.time));
        let span = Span { start, now, end };
        let only = automaton.edges(mode).only();
        let begun = self.arc.begin((mode, only), &x, now, (span.remaining(), elapsed))?;
        if let Begun::Open { exact: true } = begun
            && !observer.wants_pieces()
            && let Some(edge) = only
            && let Fall::In(s, before) = automaton.falls(mode, edge, now.seconds(), &x)
            && self.arc.falls(mode, edge, (s, &before), span, observer)
        {
            return self.jump(stand, Crossed { edge, time: now.after(s), before, ticked: false }, observer);
        }
        if let Some(edge) = only {
            self.arc.wall_near(edge, &x, now);
        }
        let next = self.go_and_jump(&{ span }, due.as_ref(), begun, observer)?;
        *stand = self.stand();
        Ok(next)
    }

    #[inline(never)]
    fn go_and_jump(
        &mut self,
        span: &Span,
        due: Option<&Due<A::Mode, A::Edge>>,
        begun: Begun<A::Edge>,
        observer: &mut impl Observer<A>,
    ) -> Result<Next<A>, Error> {
        let mut stand = self.stand();
        let Stand { mode, state: x, now, .. } = stand.clone();
        let end = match begun {
            Begun::Crossing(edge) => ArcEnd::Crossing { edge, time: now, before: x },
            Begun::Over => ArcEnd::Stop { stop: Stop::Time, time: span.end, state: x },
            Begun::Open { exact } => self.arc.go(mode, &x, span, exact, observer)?,
        };
        let crossed = match (end, due) {
            (ArcEnd::Crossing { edge, time, before }, _) => Crossed { edge, time, before, ticked: false },
            (ArcEnd::Stop { stop: Stop::Time, time, state: before }, Some(due)) => {
                self.at.ticks.take(due, time.seconds());
                Crossed { edge: due.edge, time, before, ticked: true }
            }
            (ArcEnd::Stop { stop, time, state }, _) => {
                let at = &mut self.at;
                (at.span.now, at.state) = (time, state);
                let endless = matches!(stop, Stop::Time) && at.span.end.seconds() == f64::INFINITY;
                return Ok(Next::Stop(if endless { Stop::Forever } else { stop }));
            }
        };
        if std::mem::take(&mut self.arc.memory.spurious) {
            let (at, Crossed { edge, time, before, .. }) = (&mut self.at, crossed);
            (at.span.now, at.state) = (time, before);
            at.recent.push(edge);
            let ahead = at.contraction.limit(time.since(at.span.start), true);
            return Ok(Next::Limit(Ahead::now(ahead.is_some_and(|ahead| ahead.certified))));
        }
        self.jump(&mut stand, crossed, observer)
    }

    /// The jump at the end of an arc, whose state x⁻ is still inside the domain of the mode.
    #[inline(always)]
    fn jump(
        &mut self,
        stand: &mut StandOf<A>,
        crossed: Crossed<A>,
        observer: &mut impl Observer<A>,
    ) -> Result<Next<A>, Error> {
        let Stand { mode, state: x, now: began, .. } = stand.clone();
        let Crossed { edge, time, before, ticked } = crossed;
        let Self { arc, at } = self;
        let automaton = arc.automaton;
        let now = time.seconds();
        let (to, after) = automaton
            .reset(mode, edge, now, &before)
            .map_err(|refusal| refused(refusal, now, mode, edge, before.clone()))?;
        let duration = time.since(began);
        let since = time.since(at.instant);
        let at_once = arc.memory.at_once(since);
        // The same edge taken again at once changes nothing: the limit is here.
        let stands =
            duration == 0.0 && !ticked && to == mode && arc.memory.just_took(edge) && same(&x.clone(), &after.clone());
        if !stands {
            if at_once {
                at.cascade = at.cascade.and(x.clone(), after.clone());
            } else {
                at.instant = time;
                if at.cascade.jumps() > 0 {
                    at.cascade = Cascade::NONE;
                }
            }
            if !after.is_finite() || to != mode && automaton.validate(to, now, &after.clone()).is_err() {
                let (kind, note) = wrong(automaton, to, now, after.clone());
                return Err(Error::new(kind, Place::new(now, mode, Some(edge), &before.clone())).noting(Some(note)));
            }
            // From where it was computed, not by way of the jump, which lies in memory.
            (at.span.now, at.mode, at.state, at.jumps) = (time, to, after.clone(), at.jumps + 1);
            let jump = Jump {
                time: at.instant,
                j: at.jumps,
                cause: Cause::Edge(edge),
                from: mode,
                before: before.clone(),
                to,
                after: after.clone(),
            };
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
        arc.landed((mode, edge, &before), (to, now, &after));
        at.recent.push(edge);
        let elapsed = time.since(at.span.start);
        let (lapse, short) = if at_once { (0.0, true) } else { (duration, arc.memory.is_short(duration)) };
        at.contraction.push(lapse, short, &at.state);
        let limit =
            if stands { Some(Ahead::now(true)) } else { at.contraction.limit(elapsed, arc.memory.hides_durations()) };
        if let Some(ahead) = limit.filter(|ahead| time.after(ahead.remaining).seconds() <= at.span.end.seconds()) {
            return Ok(Next::Limit(ahead));
        }
        let next = self.after_jump(edge, now, at_once);
        if matches!(next, Next::Arc) {
            *stand = Stand { mode: to, state: after, now: time, elapsed };
        }
        Ok(next)
    }

    /// What follows a jump at time `t`, `at_once` after another: another arc, unless jumps at one
    /// time contract or a limit of the run is reached.
    #[inline(always)]
    fn after_jump(&self, edge: A::Edge, t: f64, at_once: bool) -> Next<A> {
        if at_once || self.over().is_some() { self.after_last_jump(edge, t, at_once) } else { Next::Arc }
    }

    /// Which limit of the run is reached.
    #[inline(always)]
    fn over(&self) -> Option<Stop<A::Edge>> {
        let options = &self.arc.options;
        if self.at.jumps >= options.most_jumps {
            Some(Stop::Jumps { most: options.most_jumps })
        } else if self.arc.memory.stats.evaluations() >= options.most_evaluations {
            Some(Stop::Evaluations { most: options.most_evaluations })
        } else {
            options.overdue()
        }
    }

    /// The same where jumps come at one time, or this may be the last one.
    #[cold]
    #[inline(never)]
    fn after_last_jump(&self, edge: A::Edge, t: f64, at_once: bool) -> Next<A> {
        let over = self.over();
        if at_once
            && !matches!(over, Some(Stop::Jumps { .. }))
            && let Some(next) = self.after_cascade(edge, t)
        {
            return next;
        }
        over.map_or(Next::Arc, Next::Stop)
    }

    /// What follows jumps that go on at one time, where they contract, which is the model's to say,
    /// or are too many.
    #[cold]
    #[inline(never)]
    fn after_cascade(&self, edge: A::Edge, t: f64) -> Option<Next<A>> {
        let Self { arc: Advance { automaton, options, .. }, at } = self;
        let beyond = |edges: &[A::Edge]| automaton.beyond(&Limit::new(at.mode, edges, t, &at.state));
        if at.cascade.contracts(options.longest_cascade) && at.recent.cycle().with(beyond).is_some() {
            Some(Next::Limit(Ahead::now(true)))
        } else {
            (at.cascade.jumps() >= options.longest_cascade).then_some(Next::Stop(Stop::Cascade { edge }))
        }
    }

    /// Jumps have accumulated: the state goes on to their limit, or stands for a time too short to
    /// resolve, and the model says what lies beyond.
    #[cold]
    fn at_limit(&mut self, ahead: Ahead, observer: &mut impl Observer<A>) -> Result<Option<Stop<A::Edge>>, Error> {
        let Self { arc, at } = self;
        let automaton = arc.automaton;
        let (mode, last, remaining) = (at.mode, at.state.clone(), ahead.remaining);
        let x = at.contraction.at(&ahead, &last);
        if remaining > 0.0 {
            let difference = x.with(|i| x.get(i) - last.get(i));
            let way = [last, difference];
            if observer.piece(mode, &Piece::new(at.span.now, remaining, remaining, &way)).is_break() {
                return Ok(Some(Stop::Observer));
            }
        }
        (at.span.now, at.state) = (at.span.now.after(remaining), x.clone());
        let limit = at.span.now.seconds();
        let beyond = |edges: &[A::Edge]| automaton.beyond(&Limit::new(mode, edges, limit, &x));
        let Some((to, after)) = at.recent.cycle().with(beyond) else {
            return Ok(Some(if ahead.certified { Stop::Zeno { limit } } else { Stop::Resolution { limit } }));
        };
        if !after.is_finite() || automaton.validate(to, limit, &after).is_err() {
            let (kind, note) = wrong(automaton, to, limit, after.clone());
            let note = if kind == ErrorKind::Model { format!("Automaton::beyond {note}") } else { note };
            return Err(Error::new(kind, Place::new(limit, mode, None::<A::Edge>, &x)).noting(Some(note)));
        }
        at.instant = at.span.now;
        if !ahead.certified {
            // Up to the limit, from a spacing of time before it on at the latest.
            let began = at.span.now.after(-remaining.max(resolution(limit)));
            let mut unsure = |edge: A::Edge| doubt::<A>(Doubt::Accumulated, mode, edge, (began, at.span.now), observer);
            at.recent.cycle().with(|edges: &[A::Edge]| edges.iter().for_each(|edge| unsure(*edge)));
        }
        let Limits { count, uncertified, .. } = at.limits;
        let uncertified = uncertified + usize::from(!ahead.certified);
        at.limits = Limits { count: count + 1, uncertified, last: Some(limit) };
        let jump = Jump { time: at.instant, j: at.jumps + 1, cause: Cause::Zeno, from: mode, before: x, to, after };
        (at.mode, at.state, at.jumps) = (to, jump.after.clone(), jump.j);
        (at.contraction, at.recent, at.cascade) = (Contraction::new(), Recent::new(), Cascade::NONE);
        arc.memory.beyond();
        Ok(observer.jump(&jump).is_break().then_some(Stop::Observer))
    }
}

/// The failure of a run whose reset refuses.
#[cold]
#[inline(never)]
fn refused<X: State>(refusal: Refusal, t: f64, mode: impl fmt::Debug, edge: impl fmt::Debug, x: X) -> Error {
    refusal.at("reset", Place::new(t, mode, Some(edge), &x))
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
#[cold]
#[inline(never)]
fn same<S: State>(x: &S, y: &S) -> bool {
    x.len() == y.len() && (0..x.len()).all(|i| x.get(i) == y.get(i))
}
