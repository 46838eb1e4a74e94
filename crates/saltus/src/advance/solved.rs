//! The first crossing on an exact solution, and the end of the arc there.

use crate::automaton::Automaton;
use crate::automaton::solution::Fall;
use crate::cross::{Crossing, Evidence, Searched, Start, Undefined, settle};
use crate::error::Error;
use crate::inspection::Inspection;
use crate::observe::Observer;
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Span, Time};

use super::Advance;
use super::crossing::{Close, together};

/// The first crossing on a solution.
pub(super) struct First<A: Automaton> {
    pub(super) edge: A::Edge,
    pub(super) crossing: Crossing,
    /// Whether a formula gave its time, which the rounding of a spent root does not spoil then.
    by_formula: bool,
    /// The state there, where a formula gave that too.
    state: Option<A::State>,
}

impl<A: Automaton> First<A> {
    /// When it is, after the start of the arc.
    pub(super) fn time(&self) -> f64 {
        self.crossing.inside
    }

    /// Whether a formula gave its place, so that nobody has looked at the guard on the solution
    /// there.
    pub(super) fn is_told(&self) -> bool {
        self.state.is_some()
    }
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// The first crossing on a solution `at` from `x`: by the model's formula where it has one, by
    /// `search` elsewhere, which tells whether it is one too.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)] // one call each for the two kinds of solutions
    pub(super) fn first_on_solution(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        clock: &Span,
        at: impl Fn(f64) -> A::State + Copy,
        mut search: impl FnMut(&mut Self, A::Edge, f64, Start) -> Result<(Searched, bool), Undefined>,
        observer: &mut impl Observer<A>,
    ) -> Result<Option<First<A>>, Error> {
        let mut found: Option<First<A>> = None;
        let mut undefined = None;
        let (now, past) = (clock.now, past(clock));
        for edge in self.automaton.edges(mode).iter() {
            let fall = found.as_ref().map_or(past, |first| first.crossing.outside);
            let limit = undefined.map_or(fall, |(s, _)| fall.min(s));
            let mut arrival = None;
            let (Searched { fall, evidence, .. }, by_formula) = match self.automaton.falls(mode, edge, now.seconds(), x)
            {
                Fall::Unknown => match search(self, edge, limit, self.start(edge, true)) {
                    Ok(searched) => searched,
                    Err(Undefined(s)) => {
                        undefined = Some((s, edge));
                        continue;
                    }
                },
                Fall::In(s, state) if self.arrives(edge, now, s, &state, limit) => {
                    arrival = Some(state);
                    (Searched::solved(Some(Crossing::after(s))), true)
                }
                formula => (Searched::solved(self.fall_by_formula(edge, now, formula, at, limit)), true),
            };
            observer.inspection(&Inspection { mode, edge, start: now, span: limit, evidence });
            let first = |crossing| First { edge, crossing, by_formula, state: arrival };
            found = match (found, fall) {
                (found, None) => found,
                (None, Some(crossing)) => Some(first(crossing)),
                (Some(found), Some(crossing)) => Some(match together(&found.crossing, &crossing) {
                    Some(crossing) => First { crossing, ..found },
                    None => {
                        self.may_be_tied(found.edge, found.crossing.inside, now, crossing.outside);
                        first(crossing)
                    }
                }),
            };
        }
        if let Some((s, edge)) = undefined
            && found.as_ref().is_none_or(|first| s < first.crossing.inside)
        {
            return Err(self.undefined(mode, edge, now, s, &at(s)));
        }
        Ok(found)
    }

    /// Whether an arc of a mode with one edge ends a time `s` ahead in a state on its guard, as a
    /// formula gives them. Nothing is then searched, nor the solution asked for, if no observer
    /// wants its pieces.
    #[inline]
    pub(crate) fn falls(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        (s, state): (f64, &A::State),
        clock: Span,
        observer: &mut impl Observer<A>,
    ) -> bool {
        let (now, remaining) = (clock.now, clock.remaining());
        if !(s < remaining && self.arrives(edge, now, s, state, remaining)) {
            return false;
        }
        self.memory.stats.exact += 1;
        self.arrived();
        let span = past(&clock);
        observer.inspection(&Inspection { mode, edge, start: now, span, evidence: Evidence::Isolated });
        true
    }

    /// An arc has ended on its guard exactly: rounding has left nothing.
    #[inline]
    fn arrived(&mut self) {
        self.memory.slack = 0.0;
        (self.memory.hidden, self.memory.spurious) = (0, false);
    }

    /// How an arc ends at the first crossing on its solution.
    #[inline(always)]
    pub(super) fn close_on_solution(
        &mut self,
        first: &First<A>,
        now: Time,
        at: impl Fn(f64) -> A::State,
        remaining: f64,
    ) -> Close<A::State> {
        let First { edge, crossing, by_formula, ref state } = *first;
        // Not where another edge's crossing, just before it, has moved the inner end.
        let arrived = crossing.inside == crossing.root && crossing.root < remaining;
        match state.as_ref().filter(|_| arrived) {
            Some(state) => {
                self.arrived();
                Close { span: crossing.root, time: now.after(crossing.root), state: state.clone() }
            }
            None => self.close((edge, crossing), now, at, remaining, by_formula),
        }
    }

    /// How much of `span` a recorded piece may take, for the guard not to be negative at its end: a
    /// formula's time may be a rounding late. No part of the search, and so not counted.
    pub(super) fn span_inside(&self, edge: A::Edge, now: Time, at: impl Fn(f64) -> A::State, span: f64) -> f64 {
        let guard = |s: f64| self.automaton.guard(edge, now.after(s).seconds(), &at(s));
        if guard(span) >= 0.0 { span } else { settle(guard, span).map_or(span, |crossing| crossing.inside) }
    }

    /// Whether a formula's state a time `s` ahead is on its guard.
    #[inline]
    fn arrives(&mut self, edge: A::Edge, now: Time, s: f64, state: &A::State, limit: f64) -> bool {
        if !(s > 0.0 && s <= limit && state.is_finite()) {
            return false;
        }
        self.memory.stats.guards += 1;
        self.automaton.guard(edge, now.after(s).seconds(), state) == 0.0
    }

    /// The fall that the model's own formula gives, at a time at which the guard is not negative.
    fn fall_by_formula(
        &mut self,
        edge: A::Edge,
        now: Time,
        formula: Fall<A::State>,
        at: impl Fn(f64) -> A::State,
        limit: f64,
    ) -> Option<Crossing> {
        let (Fall::After(s) | Fall::In(s, _)) = formula else { return None };
        if s > limit {
            return None;
        }
        if s <= 0.0 {
            return Some(Crossing::at_start(f64::MIN_POSITIVE));
        }
        let (automaton, count) = (self.automaton, &mut self.memory.stats.guards);
        let mut guard = |s: f64| {
            *count += 1;
            automaton.guard(edge, now.after(s).seconds(), &at(s))
        };
        if guard(s) >= 0.0 { Some(Crossing::after(s)) } else { settle(guard, s) }
    }
}

/// A hair past the end of the span, so that a crossing that rounding puts just behind it is taken
/// at it.
#[inline]
fn past(clock: &Span) -> f64 {
    clock.remaining() + clock.grace()
}
