//! One arc: from the state just after a jump to the first crossing, by the exact solution or by steps.

mod closed;
mod crossing;
mod enter;
mod exact;
mod series;
mod solved;
mod start;
mod stepped;

pub(crate) use series::Held;

use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::copies::copied;
use crate::control::Controller;
use crate::cross::{Leaves, Move, Start};
use crate::error::Error;
use crate::observe::Observer;
use crate::series::Tape;
use crate::simulation::{Options, Stats, Stop};
use crate::step::Stepper;
use crate::time::Time;

/// The span of a run and where it stands.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Clock {
    pub(crate) start: Time,
    pub(crate) now: Time,
    pub(crate) end: Time,
}

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

/// What an edge is ready for that is not armed, as one is whose guard is positive.
///
/// An edge is a Schmitt trigger on its guard: armed above zero, it fires where the guard falls below.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum Trigger {
    /// It has just been taken, and what its guard does next is not decided: its root is spent where
    /// the guard is within `slack` of zero.
    Taken { slack: f64 },
    /// It is armed, and its guard rises from zero, known to within `noise`, by this `slope`.
    Rises { slope: f64, noise: f64 },
    /// Its guard is zero to within `noise`, and no derivative leads away: it touches.
    Touches { noise: f64 },
    /// Its guard is below zero, or falls from a zero known to within `noise`: it waits until the guard
    /// has risen.
    Outside { noise: Option<f64> },
}

/// The arc before the present one.
pub(crate) struct LastArc<A: Automaton> {
    mode: A::Mode,
    state: A::State,
    t: f64,
    duration: f64,
}

copied!(LastArc);

/// What is kept from arc to arc.
pub(crate) struct Memory<A: Automaton> {
    pub(crate) stats: Stats,
    controller: Controller,
    step: Option<f64>,
    /// The edges that are not armed. They survive every jump, as long as the mode entered has them.
    triggers: Vec<(A::Edge, Trigger)>,
    /// The edge of the last jump.
    last: Option<A::Edge>,
    /// The last arc that took time.
    last_arc: Option<LastArc<A>>,
    /// When a scheduled edge was last taken.
    clock_took: Option<f64>,
    slack: f64,
    last_duration: f64,
    longest_duration: f64,
    /// How many arcs in a row, up to the last one, were so short that the rounding of a guard spoils their duration.
    hidden: u32,
    /// Whether the last crossing was the rounding of its guard, on an arc that leads away from zero: jumps have accumulated as far as can be told.
    pub(crate) spurious: bool,
}

impl<A: Automaton> Clone for Memory<A> {
    fn clone(&self) -> Self {
        Self { triggers: self.triggers.clone(), ..*self }
    }
}

impl<A: Automaton> Memory<A> {
    pub(crate) fn new(stepper: &impl Stepper, first_step: Option<f64>) -> Self {
        Self {
            stats: Stats::default(),
            controller: Controller::new(stepper),
            step: first_step,
            triggers: Vec::new(),
            last: None,
            last_arc: None,
            clock_took: None,
            slack: 0.0,
            last_duration: 0.0,
            longest_duration: 0.0,
            hidden: 0,
            spurious: false,
        }
    }

    /// What `edge` is ready for, if it is not armed.
    #[inline]
    fn trigger(&self, edge: A::Edge) -> Option<Trigger> {
        self.triggers.iter().find(|(other, _)| *other == edge).map(|&(_, trigger)| trigger)
    }

    /// Sets what `edge` is ready for.
    fn set(&mut self, edge: A::Edge, trigger: Trigger) {
        match self.triggers.iter_mut().find(|(other, _)| *other == edge) {
            Some((_, old)) => *old = trigger,
            None => self.triggers.push((edge, trigger)),
        }
    }

    /// Arms `edge`: its guard is above zero.
    fn arm(&mut self, edge: A::Edge) {
        self.triggers.retain(|(other, _)| *other != edge);
    }

    /// An arc has led on from where edges were taken: they are armed.
    #[inline]
    fn arm_taken(&mut self) {
        if !self.triggers.is_empty() {
            self.triggers.retain(|(_, trigger)| !matches!(trigger, Trigger::Taken { .. } | Trigger::Rises { .. }));
            for (_, trigger) in &mut self.triggers {
                if let Trigger::Outside { noise } = trigger {
                    *noise = None;
                }
            }
        }
    }

    /// An arc ends after `duration` at a crossing on its last step. The rest of that step was not
    /// used, so the next one grows from this arc and the one before by no more than a step may grow:
    /// a flow whose error estimate is zero would lengthen the step at every arc, until its crossings
    /// were lost at its start. One short arc among long ones does not shorten it.
    #[inline]
    fn cut_at(&mut self, duration: f64) {
        let most = Controller::LARGEST * duration.max(self.last_duration);
        self.step = self.step.map(|step| if step > most && most > 0.0 { most } else { step });
    }

    /// Whether a time after a jump is so short that rounding cannot tell it from that jump's.
    #[inline]
    pub(crate) fn at_once(&self, since: f64) -> bool {
        since <= 4.0 * f64::EPSILON * self.last_duration
    }

    /// Whether the rounding of a guard spoils the durations of the last arcs: of three in a row, for one may be short by chance.
    pub(crate) fn hides_durations(&self) -> bool {
        self.hidden >= 3
    }

    /// Whether the last jump took this very edge.
    pub(crate) fn just_took(&self, edge: A::Edge) -> bool {
        self.last == Some(edge)
    }

    /// After a jump that no edge made.
    pub(crate) fn beyond(&mut self) {
        self.triggers.clear();
        self.last = None;
    }
}

/// Advances one arc.
pub(crate) struct Advance<'a, A: Automaton, M> {
    pub(crate) automaton: &'a A,
    pub(crate) stepper: M,
    pub(crate) options: &'a Options,
    pub(crate) memory: &'a mut Memory<A>,
    pub(crate) tape: &'a mut Tape,
    pub(crate) held: &'a mut Held<A>,
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// After a jump by `edge` at the end of the arc of this `duration` that began at `x` in `mode`,
    /// `at_once` after another jump or not: its root is spent.
    #[inline]
    pub(crate) fn jumped(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        edge: A::Edge,
        (duration, at_once): (f64, bool),
        t: f64,
    ) {
        if duration > 0.0 {
            self.memory.arm_taken();
        }
        if !at_once {
            self.memory.last_arc = Some(LastArc { mode, state: *x, t: t - duration, duration });
            self.memory.last_duration = duration;
            if duration > self.memory.longest_duration {
                self.memory.longest_duration = duration;
            }
        }
        self.memory.set(edge, Trigger::Taken { slack: self.memory.slack });
        self.memory.last = Some(edge);
    }

    /// From `x` in `mode` to the first crossing or the end of the span.
    #[inline]
    pub(crate) fn arc(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        clock: &Clock,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let &Clock { now, .. } = clock;
        if let Some(edge) = self.enter(mode, x, now)? {
            return Ok(ArcEnd::Crossing { edge, time: now, before: *x });
        }
        let scheduled = self.scheduled(mode, clock);
        let horizon = scheduled.map_or(clock.end, |(t, _)| Time::new(t));
        // What is left of the span may be the rounding of the jumps' times.
        let (time, state) = if horizon.since(now) <= 2.0 * f64::EPSILON * now.since(clock.start) {
            (now, *x)
        } else {
            let stepped = self.options.stepped;
            if !stepped
                && !observer.wants_pieces()
                && let Some(end) = self.told(mode, x, now, horizon.since(now), observer)
            {
                return Ok(end);
            }
            let (t, within) = (now.seconds(), Clock { end: horizon, ..*clock });
            let solution = if stepped { None } else { self.automaton.exact(mode, t, x) };
            let end = if let Some(solution) = solution {
                self.exact(mode, &solution, &within, observer)
            } else if !stepped && self.automaton.flown(mode, t, x, 0.0).is_some() {
                self.closed(mode, x, &within, observer)
            } else if stepped {
                self.stepped(mode, *x, within, true, observer)
            } else {
                self.by_series(mode, *x, within, observer)
            };
            match end? {
                ArcEnd::Stop { stop: Stop::Time, time, state } => (time, state),
                end => return Ok(end),
            }
        };
        Ok(match scheduled {
            Some((t, edge)) => {
                self.memory.clock_took = Some(t);
                ArcEnd::Crossing { edge, time, before: state }
            }
            None => ArcEnd::Stop { stop: Stop::Time, time: clock.end, state },
        })
    }

    /// The next scheduled edge after the start of the span; one that falls on the present time is due unless one was just taken.
    #[inline]
    fn scheduled(&self, mode: A::Mode, clock: &Clock) -> Option<(f64, A::Edge)> {
        let now = clock.now.seconds();
        let taken = self.memory.clock_took == Some(now);
        let after = if taken { now } else { now.next_down().max(clock.start.seconds()) };
        let next = self.automaton.scheduled(mode, after)?;
        (next.0 > after && next.0 <= clock.end.seconds()).then_some(next)
    }

    /// How the search for `edge` starts on a piece, the first of its arc or a later one, and how its
    /// guard leaves a root there.
    #[inline]
    fn start(&self, edge: A::Edge, first: bool) -> (Start, Leaves) {
        if !first || self.memory.triggers.is_empty() { (Start::Open, Leaves::Ask) } else { self.start_of(edge) }
    }

    fn start_of(&self, edge: A::Edge) -> (Start, Leaves) {
        match self.memory.trigger(edge) {
            Some(Trigger::Taken { .. }) => (Start::Spent, Leaves::Ask),
            Some(Trigger::Rises { slope, noise }) => (Start::Spent, Leaves::Known { first: Move::Rises { slope }, noise }),
            Some(Trigger::Touches { noise }) => (Start::Spent, Leaves::Known { first: Move::Stays, noise }),
            Some(Trigger::Outside { noise: Some(noise) }) => {
                (Start::Spent, Leaves::Known { first: Move::Falls { order: 1 }, noise })
            }
            Some(Trigger::Outside { noise: None }) | None => (Start::Open, Leaves::Ask),
        }
    }
}
