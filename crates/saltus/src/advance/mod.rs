//! One arc: from the state just after a jump to the first crossing, by the exact solution or by
//! steps.

mod closed;
mod crossing;
mod enter;
mod exact;
mod grazing;
mod noise;
mod promises;
mod series;
mod smooth;
mod solved;
mod stepped;
mod stiff;

pub(crate) use series::Held;
use smooth::Switched;
pub(crate) use smooth::{Smooth, later_stop};

use self::stiff::Gait;

use std::ops::ControlFlow;

use crate::automaton::solution::Solution;
use crate::automaton::{Automaton, Entry};
use crate::control::Controller;
use crate::cross::{Doubt, Evidence, Start};
use crate::ending::Options;
use crate::ending::{Stats, Stop};
use crate::error::{Error, ErrorKind, Place};
use crate::inspection::Inspection;
use crate::observe::Observer;
use crate::series::Tape;
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Span, Time};

/// How an arc ended.
pub(crate) enum ArcEnd<A: Automaton> {
    /// At a crossing; `before` is the state at its inner side.
    Crossing { edge: A::Edge, time: Time, before: A::State },
    /// The run ends here.
    Stop { stop: Stop<A::Edge>, time: Time, state: A::State },
}

impl<A: Automaton> ArcEnd<A> {
    /// At `state`, after a piece to whose end this was found and of which the observer was told.
    #[inline]
    fn after(found: Option<A::Edge>, told: ControlFlow<()>, time: Time, state: A::State) -> Self {
        match found {
            _ if told.is_break() => Self::Stop { stop: Stop::Observer, time, state },
            Some(edge) => Self::Crossing { edge, time, before: state },
            None => Self::Stop { stop: Stop::Time, time, state },
        }
    }
}

/// An edge taken, whose root is spent, and how far from zero its guard is there for rounding alone.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Spent<E> {
    edge: E,
    slack: f64,
}

/// An edge at whose wall the state is: its guard is zero, but for rounding or the drift of the
/// steps.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Wall<E> {
    edge: E,
    /// What rounding or drift has left of the guard.
    level: f64,
    /// Whether the flow runs along the wall, as far as rounding shows: the edge stays, and is taken
    /// only where the flow carries the guard down.
    stays: bool,
}

/// How many edges that were taken at one time, and go on falling, are remembered.
const MOST_IDLE: usize = 16;

/// Why a guard below zero at the end of an arc is one at its entry.
const FELL_ON: &str = "goes on falling after its own reset, out of the mode";

/// A jump this many roundings of the last arc's duration after another is at once after it.
const AT_ONCE: f64 = 4.0;

/// The root of an edge that was taken is spent as far as so many times what was left of its guard.
const SLACK: f64 = 4.0;

/// An arc this small a part of the longest one is short.
const SHORT: f64 = 1e-4;

/// What is kept from arc to arc.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Memory<E, S> {
    pub(crate) stats: Stats,
    /// What each coordinate was summed up from, over the arcs so far that took time, since it was
    /// last exactly zero: the largest of |xᵢ| at the start of an arc and of |xᵢ'| times its
    /// duration.
    largest: Option<S>,
    /// x' on the last piece of an arc that ends at a crossing.
    slope: Option<S>,
    controller: Controller,
    gait: Gait,
    step: Option<f64>,
    spent: Option<Spent<E>>,
    /// The edge of the last jump.
    last: Option<E>,
    /// Edges taken earlier whose guards went on falling, and how fast: not taken again before they
    /// have risen, or are driven on.
    idle: [Option<(Spent<E>, f64)>; MOST_IDLE],
    idle_count: usize,
    /// Edges whose guards are zero, but for rounding, as the mode is entered, and were not just
    /// taken.
    walls: [Option<Wall<E>>; MOST_IDLE],
    wall_count: usize,
    /// How far the search of this exact arc went before a limit of the run cut it.
    cut_at: Option<f64>,
    slack: f64,
    last_duration: f64,
    longest_duration: f64,
    /// How many arcs in a row, up to the last one, were so short that the rounding of a guard
    /// spoils their duration.
    hidden: u32,
    /// How many arcs there were.
    arcs: u64,
    /// Whether a guard has been farther from zero, on a step with a crossing, than the error of the
    /// step.
    resolved: bool,
    /// Edges that were taken in the last stop because their guards switch there.
    pub(super) switched: Switched<E>,
    /// Whether the last crossing was the rounding of its guard, on an arc that leads away from
    /// zero: jumps have accumulated as far as numbers resolve.
    pub(crate) spurious: bool,
}

impl<E: Copy + PartialEq, S: State> Memory<E, S> {
    pub(crate) fn new(stepper: &impl Stepper, first_step: Option<f64>) -> Self {
        Self {
            stats: Stats::default(),
            largest: None,
            slope: None,
            controller: Controller::new(stepper),
            gait: Gait::START,
            step: first_step,
            spent: None,
            last: None,
            idle: [None; MOST_IDLE],
            idle_count: 0,
            walls: [None; MOST_IDLE],
            wall_count: 0,
            cut_at: None,
            slack: 0.0,
            last_duration: 0.0,
            longest_duration: 0.0,
            hidden: 0,
            arcs: 0,
            resolved: false,
            switched: Switched::none(),
            spurious: false,
        }
    }

    /// The edge among those whose root at this time is spent.
    #[inline]
    fn spent_as(&self, edge: E) -> Option<Spent<E>> {
        let idle = self.idle[..self.idle_count].iter().flatten().map(|(spent, _)| spent);
        self.spent.iter().chain(idle).find(|spent| spent.edge == edge).copied()
    }

    /// The guard of `edge` is away from zero: no root is spent.
    fn unspend(&mut self, edge: E) {
        self.spent = self.spent.filter(|spent| spent.edge != edge);
        for idle in &mut self.idle[..self.idle_count] {
            *idle = idle.filter(|(idle, _)| idle.edge != edge);
        }
    }

    /// The guard of `edge` is zero as the mode is entered, but for rounding, which has left `g` of
    /// it.
    fn at_wall(&mut self, edge: E, g: f64) {
        if self.wall_count < MOST_IDLE {
            self.walls[self.wall_count] = Some(Wall { edge, level: g, stays: false });
            self.wall_count += 1;
        }
    }

    #[cold]
    #[inline(never)]
    fn level(&self, edge: E) -> f64 {
        self.wall(edge).map_or(0.0, |wall| wall.level)
    }

    fn wall(&self, edge: E) -> Option<&Wall<E>> {
        self.walls[..self.wall_count].iter().flatten().find(|wall| wall.edge == edge)
    }

    /// An arc ends at a crossing on a step of `size`: the rest of the step was not used, and says
    /// nothing of how long the next one may be. A flow whose error estimate is zero would lengthen
    /// it at every arc, until its crossings were lost at its start.
    #[inline]
    fn cut(&mut self, size: f64) {
        self.step = self.step.map(|step| step.min(size));
    }

    /// An arc from `x` that took time has ended.
    #[inline]
    fn went(&mut self, x: &S, duration: f64) {
        let alike = |y: &S| y.len() == x.len();
        let (largest, slope) = (self.largest.filter(alike), self.slope.take().filter(alike));
        self.largest = Some(x.with(|i| {
            let here = x.get(i).abs();
            let before = largest.map_or(0.0, |largest| if here == 0.0 { 0.0 } else { largest.get(i) });
            let way = slope.map_or(0.0, |slope| (slope.get(i) * duration).abs());
            here.max(before).max(way)
        }));
    }

    /// Whether an arc is so short beside the longest one that rounding may show in what guards do
    /// on it.
    #[inline]
    fn is_short(&self, duration: f64) -> bool {
        duration < SHORT * self.longest_duration
    }

    /// Whether a time after a jump is so short that rounding cannot tell it from that jump's.
    #[inline]
    pub(crate) fn at_once(&self, since: f64) -> bool {
        since <= AT_ONCE * f64::EPSILON * self.last_duration
    }

    /// Whether the rounding of a guard spoils the durations of the last arcs: of three in a row,
    /// for one may be short by chance.
    pub(crate) fn hides_durations(&self) -> bool {
        self.hidden >= 3
    }

    /// Whether the last jump took this very edge.
    pub(crate) fn just_took(&self, edge: E) -> bool {
        self.spent.is_some_and(|spent| spent.edge == edge)
    }

    /// After a jump that no edge made.
    pub(crate) fn beyond(&mut self) {
        (self.spent, self.last) = (None, None);
    }
}

/// Advances one arc.
pub(crate) struct Advance<'a, A: Automaton, M> {
    pub(crate) automaton: &'a A,
    pub(crate) stepper: M,
    pub(crate) options: &'a Options,
    pub(crate) memory: &'a mut Memory<A::Edge, A::State>,
    pub(crate) tape: &'a mut Tape,
    pub(crate) held: &'a mut Held<A>,
    /// The stretch of time on which the flow of the arc's mode is smooth.
    pub(crate) smooth: Smooth,
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// After a jump by `edge` at the end of the arc that began at `x` in `mode` and came to
    /// `before`: its root is spent. Without a duration, it was at once after another.
    ///
    /// An edge taken before whose guard has fallen on since, beyond a root that is spent, has not
    /// come to be taken again.
    #[inline]
    pub(crate) fn jumped(
        &mut self,
        (mode, x, began): (A::Mode, &A::State, f64),
        (edge, before, t): (A::Edge, &A::State, f64),
        duration: Option<f64>,
    ) {
        if duration.is_some() && self.memory.idle_count > 0 {
            self.forget_risen(mode, t, before);
        }
        if let Some(last) = self.memory.spent.filter(|last| last.edge != edge)
            && match duration {
                Some(s) => self.memory.is_short(s) && self.is_below(mode, last.edge, t, before),
                None => self.has(mode, last.edge),
            }
        {
            let g = self.guard(last.edge, began, x);
            let slope = if g.abs() <= last.slack { self.guard_slope(mode, last.edge, began, x, g, 0.0) } else { 0.0 };
            if slope < 0.0 {
                self.memory.idle.rotate_right(1);
                self.memory.idle[0] = Some((last, slope));
                self.memory.idle_count = MOST_IDLE.min(self.memory.idle_count + 1);
            }
        }
        if let Some(duration) = duration {
            self.memory.went(x, duration);
            self.memory.last_duration = duration;
            if duration > self.memory.longest_duration {
                self.memory.longest_duration = duration;
            }
        }
        self.memory.spent = Some(Spent { edge, slack: self.memory.slack });
        self.memory.last = Some(edge);
    }

    /// Whether the guard of an edge that this mode has, and another mode may not, is below zero at
    /// `x`.
    fn is_below(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State) -> bool {
        if !self.has(mode, edge) {
            return false;
        }
        self.memory.stats.guards += 1;
        self.guard(edge, t, x) < 0.0
    }

    /// Whether an edge leads out of this mode: elsewhere its guard may not even be asked.
    pub(super) fn has(&self, mode: A::Mode, edge: A::Edge) -> bool {
        self.automaton.edges(mode).iter().any(|other| other == edge)
    }

    /// Forgets the edges that the mode does not have, and those whose guards have risen since they
    /// were taken.
    #[cold]
    fn forget_risen(&mut self, mode: A::Mode, t: f64, x: &A::State) {
        let count = self.memory.idle_count;
        for k in 0..count {
            self.memory.idle[k] = self.memory.idle[k].filter(|(spent, _)| self.is_below(mode, spent.edge, t, x));
        }
        if self.memory.idle[..count].iter().all(Option::is_none) {
            self.memory.idle_count = 0;
        }
    }

    /// From `x` in `mode` to the first crossing or the end of the span.
    #[inline]
    pub(crate) fn arc(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        clock: &Span,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let &Span { now, .. } = clock;
        let smooth = self.automaton.stops(mode).is_empty();
        if !smooth {
            self.smooth_from(mode, now, x)?;
        }
        if let Some(edge) = self.enter(mode, x, now)? {
            return Ok(ArcEnd::Crossing { edge, time: now, before: *x });
        }
        // What is left of the span may be the rounding of the jumps' times.
        if clock.end.since(now) <= 2.0 * f64::EPSILON * now.since(clock.start) {
            return Ok(ArcEnd::Stop { stop: Stop::Time, time: clock.end, state: *x });
        }
        let stepped = self.options.stepped;
        let exact = !stepped && (smooth || self.smooth == Smooth::ALWAYS);
        if exact
            && !observer.wants_pieces()
            && let Some(end) = self.told(mode, x, now, clock.end.since(now), observer)
        {
            return Ok(end);
        }
        let solution = if stepped { Solution::Steps } else { self.automaton.solution(mode, now.seconds(), x) };
        let end = match solution {
            Solution::Polynomial(polynomial) if exact => self.exact(mode, &polynomial, clock, observer),
            Solution::Formula(formula) if exact => self.closed(mode, x, formula, clock, observer),
            Solution::Series(flow) => self.by_series(mode, *x, flow, *clock, observer),
            // Nor is an exact solution cut in stops.
            _ => self.stepped(mode, *x, *clock, true, observer),
        };
        let end = end?;
        self.stayed_inside(mode, x, now, &end, observer)?;
        self.promises(mode, x, now, &end)?;
        match end {
            ArcEnd::Stop { stop: Stop::Time, state, .. } => {
                Ok(ArcEnd::Stop { stop: Stop::Time, time: clock.end, state })
            }
            end => Ok(end),
        }
    }

    /// Looks at the guards of the edges that did not end an arc, at its end.
    #[inline]
    fn stayed_inside(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        began: Time,
        end: &ArcEnd<A>,
        observer: &mut impl Observer<A>,
    ) -> Result<(), Error> {
        let (taken, time, state) = match end {
            ArcEnd::Crossing { edge, time, before } => (Some(*edge), *time, before),
            ArcEnd::Stop { time, state, .. } => (None, *time, state),
        };
        for edge in self.automaton.edges(mode).iter().filter(|&edge| Some(edge) != taken) {
            self.memory.stats.guards += 1;
            if self.guard(edge, time.seconds(), state) < 0.0 {
                self.outside(mode, edge, (began, x), (time, state), observer)?;
            }
        }
        Ok(())
    }

    /// The guard of `edge` is below zero at the end of an arc that it did not end. Beyond what
    /// rounding and the tolerance leave open it was crossed on the way, which the search missed, or
    /// fell on from its spent root, which is a negative guard at entry: a doubt, or an error. An
    /// edge that waits may have been outside from the start.
    #[cold]
    #[inline(never)]
    fn outside(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        (began, x): (Time, &A::State),
        (time, state): (Time, &A::State),
        observer: &mut impl Observer<A>,
    ) -> Result<(), Error> {
        if self.clear_of_zero(edge, time, state) == 0.0 {
            return Ok(());
        }
        self.stays_in(mode, edge, (began, x), (time, state))?;
        let entry = self.automaton.about(edge).entry;
        if entry != Entry::Wait || self.clear_of_zero(edge, began, x) > 0.0 {
            let span = time.since(began);
            let evidence = Evidence::doubtful(Doubt::Missed, 0.0, span);
            observer.inspection(&Inspection { mode, edge, start: began, span, evidence });
        }
        Ok(())
    }

    /// Whether an edge just taken, on an arc from `x` on which it has not fallen again up to
    /// `state`, is inside there: if not it went on falling, which is a negative guard at entry.
    #[cold]
    #[inline(never)]
    fn stays_in(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        (began, x): (Time, &A::State),
        (time, state): (Time, &A::State),
    ) -> Result<(), Error> {
        if self.memory.just_took(edge) && self.automaton.about(edge).entry == Entry::Refuse {
            self.memory.stats.guards += 1;
            if self.guard(edge, time.seconds(), state) < 0.0 && self.clear_of_zero(edge, time, state) < 0.0 {
                let place = Place::new(began.seconds(), mode, Some(edge), x);
                return Err(Error::new(ErrorKind::Entry, place).noting(Some(FELL_ON.to_owned())));
            }
        }
        Ok(())
    }

    /// The guard of `edge`, of the stretch between two stops as the flow is.
    #[inline]
    fn guard(&self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        self.automaton.guard(edge, self.smooth.within(t), x)
    }

    /// The guard of `edge` at `x`, or zero where rounding and the tolerance leave open which side
    /// it is on.
    fn clear_of_zero(&mut self, edge: A::Edge, time: Time, x: &A::State) -> f64 {
        let t = time.seconds();
        let g = self.guard(edge, t, x);
        if g.abs() > self.within_tolerance(edge, t, x, g) { g } else { 0.0 }
    }

    /// How the search for `edge` starts on the first piece of an arc.
    #[inline]
    fn start(&self, edge: A::Edge, first: bool) -> Start {
        if first && self.memory.spent_as(edge).is_some() { Start::Spent } else { Start::Open }
    }

    /// What rounding has left of the guard of `edge` on the first piece of an arc, if it is zero
    /// but for that at its start: it is to be seen without, so that the rise or fall from there
    /// decides, and not the rounding.
    #[inline]
    fn level(&self, edge: A::Edge) -> f64 {
        if self.memory.wall_count > 0 { self.memory.level(edge) } else { 0.0 }
    }
}
