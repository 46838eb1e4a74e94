//! One arc: from the state just after a jump to the first crossing, by the exact solution or by
//! steps.

mod affine;
mod closed;
mod crossing;
mod enter;
mod exact;
mod grazing;
mod memory;
mod near;
mod noise;
mod order;
mod promises;
mod series;
mod shared;
mod smooth;
mod solved;
mod stepped;
mod stiff;

pub(crate) use memory::Memory;
use memory::{Few, Spent, Wall};
use series::Held;
pub(crate) use smooth::{Smooth, later_stop};

use std::ops::ControlFlow;

use crate::automaton::solution::Solution;
use crate::automaton::{Automaton, Entry};
use crate::certainty::FEW;
use crate::cross::{Doubt, Evidence, Start};
use crate::ending::{Options, Stop};
use crate::error::{Error, ErrorKind, Place};
use crate::inspection::Inspection;
use crate::observe::Observer;
use crate::series::Tape;
use crate::sparsity::Sparsity;
use crate::step::Stepper;
use crate::time::{Span, Time};

/// How an arc begins.
#[derive(Clone, Copy)]
pub(crate) enum Begun<E> {
    /// An edge is taken at once.
    Crossing(E),
    /// Nothing of the span is left.
    Over,
    /// It is still to be gone, by an exact solution where there is one and `exact` holds.
    Open { exact: bool },
}

/// How an arc ended.
pub(crate) enum ArcEnd<A: Automaton> {
    /// At a crossing; `before` is the state at its inner side.
    Crossing { edge: A::Edge, time: Time, before: A::State },
    /// The run ends here.
    Stop { stop: Stop<A::Edge>, time: Time, state: A::State },
}

impl<A: Automaton> ArcEnd<A> {
    /// At `state`, after a piece to whose end this was found and which the observer has had.
    #[inline]
    fn after(found: Option<A::Edge>, told: ControlFlow<()>, time: Time, state: A::State) -> Self {
        match found {
            _ if told.is_break() => Self::Stop { stop: Stop::Observer, time, state },
            Some(edge) => Self::Crossing { edge, time, before: state },
            None => Self::Stop { stop: Stop::Time, time, state },
        }
    }
}

/// Why a guard below zero at the end of an arc is one at its entry.
const FELL_ON: &str = "goes on falling after its own reset, out of the mode";

/// Advances arcs, one after the other.
pub(crate) struct Advance<'a, A: Automaton, M> {
    pub(crate) automaton: &'a A,
    pub(crate) stepper: M,
    pub(crate) options: Options,
    pub(crate) memory: Memory<A::Mode, A::Edge, A::State>,
    /// When the arc began.
    began: Time,
    tape: Tape,
    held: Held<A>,
    /// An edge that has stayed at its wall on this arc, where all that its guard reads is below
    /// what the absolute tolerance resolves.
    held_down: Option<A::Edge>,
    /// Edges of this arc that may fall at the time at which one listed behind them does.
    tied: Few<A::Edge>,
    /// The stretch of time on which the flow of the arc's mode is smooth.
    smooth: Smooth,
    /// The pattern of its Jacobian, where that is given.
    sparsity: Option<Sparsity>,
}

impl<'a, A: Automaton, M> Advance<'a, A, M> {
    #[inline(always)]
    pub(crate) fn new(
        automaton: &'a A,
        stepper: M,
        options: Options,
        memory: Memory<A::Mode, A::Edge, A::State>,
    ) -> Self {
        let (tape, held, smooth) = (Tape::new(), Held::default(), Smooth::ALWAYS);
        Self {
            automaton,
            stepper,
            options,
            memory,
            began: Time::new(0.0),
            tape,
            held,
            held_down: None,
            tied: Few::new_const(),
            smooth,
            sparsity: None,
        }
    }
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// After a jump by `edge` at the end of the arc that began at `x` in `mode` and came to
    /// `before`: its root is spent. Without a duration, it was at once after another.
    ///
    /// An edge taken before whose guard has fallen on since, beyond a root that is spent, has not
    /// come to be taken again.
    #[inline(always)]
    pub(crate) fn jumped(
        &mut self,
        (mode, x, began): (A::Mode, &A::State, f64),
        (edge, before, t): (A::Edge, &A::State, f64),
        duration: Option<f64>,
    ) {
        if duration.is_some() && !self.memory.idle.is_empty() {
            self.forget_risen(mode, t, &before.clone());
        }
        if let Some(last) = self.memory.spent.filter(|last| last.edge != edge)
            && duration.is_none_or(|s| self.memory.is_short(s))
        {
            let (x, before) = (x.clone(), before.clone());
            self.falls_on(mode, last, (&x, began), duration.map(|_| (&before, t)));
        }
        if let Some(duration) = duration {
            self.memory.went(x);
            self.memory.last_duration = duration;
            if duration > self.memory.longest_duration {
                self.memory.longest_duration = duration;
            }
        }
        self.memory.spent = Some(Spent { edge, slack: self.memory.slack });
        self.memory.last = Some(edge);
    }

    /// Notes a spent root from which the guard fell on, over an arc from `x` to `end` too short for
    /// rounding to show where it came from; without an end, the arc had no duration.
    #[cold]
    #[inline(never)]
    fn falls_on(
        &mut self,
        mode: A::Mode,
        last: Spent<A::Edge>,
        (x, began): (&A::State, f64),
        end: Option<(&A::State, f64)>,
    ) {
        let falls = match end {
            Some((before, t)) => self.is_below(mode, last.edge, t, before),
            None => self.has(mode, last.edge),
        };
        if !falls {
            return;
        }
        let g = self.guard(last.edge, began, x);
        let slope = if g.abs() <= last.slack { self.guard_slope(mode, last.edge, began, x, g, 0.0) } else { 0.0 };
        if slope < 0.0 {
            self.sift(|memory| &mut memory.idle, |_, (idle, _)| idle.edge != last.edge);
            self.memory.idle.push((last, slope));
        }
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
        self.sift(|memory| &mut memory.idle, |this, (spent, _)| this.is_below(mode, spent.edge, t, x));
    }

    /// The guard of `edge` is away from zero: no root is spent.
    fn unspend(&mut self, edge: A::Edge) {
        self.memory.spent = self.memory.spent.filter(|spent| spent.edge != edge);
        self.sift(|memory| &mut memory.idle, |_, (idle, _)| idle.edge != edge);
    }

    /// Keeps of a list in memory what is to be kept, item by item where it is: a list moved out and
    /// back costs more than what most guards do.
    #[inline]
    fn sift<T: Copy>(
        &mut self,
        list: impl Fn(&mut Memory<A::Mode, A::Edge, A::State>) -> &mut Few<T>,
        mut keep: impl FnMut(&mut Self, &mut T) -> bool,
    ) {
        let mut kept = 0;
        for k in 0..list(&mut self.memory).len() {
            let mut item = list(&mut self.memory)[k];
            if keep(self, &mut item) {
                list(&mut self.memory)[kept] = item;
                kept += 1;
            }
        }
        list(&mut self.memory).truncate(kept);
    }

    /// Looks at the guards as an arc from `x` in `mode` begins, whose `only` edge it may have, with
    /// so much of the span `remaining` and so much of the run `elapsed`.
    #[inline]
    pub(crate) fn begin(
        &mut self,
        (mode, only): (A::Mode, Option<A::Edge>),
        x: &A::State,
        now: Time,
        (remaining, elapsed): (f64, f64),
    ) -> Result<Begun<A::Edge>, Error> {
        let smooth = self.automaton.stops(mode).is_empty();
        self.smooth = Smooth::ALWAYS;
        if !smooth {
            self.smooth_from(mode, now, &x.clone())?;
        }
        if let Some(edge) = self.enter(mode, x, now, only)? {
            return Ok(Begun::Crossing(edge));
        }
        // What is left of the span may be the rounding of the jumps' times.
        if remaining <= FEW * f64::EPSILON * elapsed {
            let due = if self.memory.walls.is_empty() { None } else { self.first_of(mode, now.seconds(), x) };
            return Ok(due.map_or(Begun::Over, Begun::Crossing));
        }
        Ok(Begun::Open { exact: !self.options.stepped && (smooth || self.smooth == Smooth::ALWAYS) })
    }

    /// From `x` in `mode` to the first crossing or the end of the span.
    #[inline(never)]
    pub(crate) fn go(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        clock: &Span,
        exact: bool,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let &Span { now, .. } = clock;
        self.memory.steps_before = self.memory.stats.steps;
        (self.memory.kept, self.memory.reach) = (None, None);
        self.began = now;
        self.sparsity = None;
        let end = match self.automaton.solution(mode, now.seconds(), x) {
            Solution::Sparse(sparsity) => {
                self.sparsity = Some(self.fitting(sparsity, mode, now, x)?);
                self.stepped(mode, x.clone(), clock.in_numbers(), true, observer)
            }
            Solution::Polynomial(polynomial) if exact => {
                self.memory.before = None;
                self.exact(mode, &polynomial, clock, observer)
            }
            Solution::Formula(formula) if exact => {
                self.memory.before = None;
                self.closed(mode, x, formula, clock, observer)
            }
            Solution::Series(flow) if !self.options.stepped => {
                self.by_series(mode, x.clone(), flow, clock.in_numbers(), observer)
            }
            // Nor is an exact solution cut in stops.
            _ => self.stepped(mode, x.clone(), clock.in_numbers(), true, observer),
        };
        let mut end = end?;
        if !self.tied.is_empty() {
            end = self.in_order(mode, x, now, end);
        }
        if let ArcEnd::Stop { stop: Stop::Time, time, state } = &end {
            let (time, state) = (*time, state.clone());
            if let Some(edge) = self.due_at_end(mode, (x, now), (&state, time)) {
                end = ArcEnd::Crossing { edge, time, before: state };
            }
        }
        if let Some(edge) = self.held_down.take() {
            let (ArcEnd::Crossing { time, .. } | ArcEnd::Stop { time, .. }) = end;
            doubt::<A>(Doubt::Grazing, mode, edge, (now, time), observer);
        }
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
            doubt::<A>(Doubt::Missed, mode, edge, (began, time), observer);
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
        let alone = self.memory.just_took(edge) && self.memory.idle.is_empty();
        if alone && self.automaton.about(edge).entry == Entry::Refuse {
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
        let spent = || self.memory.spent_as(edge).is_some() || self.memory.wall(edge).is_some_and(|wall| wall.rises);
        if first && spent() { Start::Spent } else { Start::Open }
    }

    /// What rounding has left of the guard of `edge` on the first piece of an arc, if it is zero
    /// but for that at its start: it is left out, so that the rise or fall from there
    /// decides, and not the rounding.
    #[inline]
    fn level(&self, edge: A::Edge) -> f64 {
        if self.memory.walls.is_empty() { 0.0 } else { self.memory.level(edge) }
    }
}

/// Tells an observer of a doubt that is of a whole arc.
#[cold]
#[inline(never)]
pub(crate) fn doubt<A: Automaton>(
    why: Doubt,
    mode: A::Mode,
    edge: A::Edge,
    (began, time): (Time, Time),
    observer: &mut impl Observer<A>,
) {
    let span = time.since(began);
    let evidence = Evidence::doubtful(why, 0.0, span);
    observer.inspection(&Inspection { mode, edge, start: began, span, evidence });
}
