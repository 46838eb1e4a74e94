//! An arc whose flow is solved exactly.

use std::cell::LazyCell;

use crate::automaton::{Automaton, Fall, Polynomial};
use crate::cross::{Crossing, Evidence, Searched, Start, Undefined, first_fall, narrowed, settle};
use crate::error::Error;
use crate::observe::{Inspection, Observer};
use crate::poly::{quadratic_fall, quadratic_touch};
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;
use crate::trajectory::{Piece, horner};

use super::crossing::{Close, earlier, less_constant};
use super::{Advance, ArcEnd, Clock, Found};

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    #[inline]
    pub(super) fn exact(
        &mut self,
        mode: A::Mode,
        solution: &Polynomial<A::State>,
        clock: &mut Clock,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        self.memory.stats.exact += 1;
        let c = solution.coefficients();
        let remaining = clock.end.since(clock.now);
        let mut found: Found<A> = None;
        let mut by_formula = false;
        let natural = LazyCell::new(|| natural(c));
        for edge in self.automaton.edges(mode).iter() {
            let limit = found.map_or(past(remaining), |(_, crossing)| crossing.outside);
            let start = self.start(edge, true);
            let formula = self.automaton.falls(mode, edge, clock.now.seconds(), &c[0]);
            let parabola = c.len() <= 3 && self.automaton.affine(edge);
            let Searched { fall, evidence } = match formula {
                Fall::Unknown if parabola => self.fall_of_parabola(edge, clock.now, c, limit, start),
                Fall::Unknown => self
                    .fall_in_windows(edge, clock.now, *natural, |s| horner(c, s), limit, start)
                    .map_err(|Undefined(s)| self.undefined(mode, edge, clock.now, s, &horner(c, s)))?,
                formula => Searched::solved(self.fall_by_formula(edge, clock.now, formula, |s| horner(c, s), limit)),
            };
            observer.inspection(&Inspection { mode, edge, start: clock.now, span: limit, evidence });
            found = earlier(found, edge, fall);
            if found.is_some_and(|(first, _)| first == edge) {
                by_formula = parabola || !matches!(formula, Fall::Unknown);
            }
        }
        let close = match found {
            Some(found) => self.close(found, clock.now, |s| horner(c, s), remaining, by_formula),
            None => Close { span: remaining, time: clock.end, state: end_of(c, remaining) },
        };
        let told = observer.piece(mode, &Piece::new(clock.now, close.span, 1.0, c));
        clock.now = close.time;
        Ok(ArcEnd::after(found, told, close.state))
    }

    /// An affine guard along a parabola is a parabola.
    #[inline]
    fn fall_of_parabola(&mut self, edge: A::Edge, now: Time, c: &[A::State], limit: f64, start: Start) -> Searched {
        let g = |x: &A::State| self.automaton.guard(edge, now.seconds(), x);
        self.memory.stats.guards += c.len() as u64 + 1;
        let constant = g(&c[0].with(|_| 0.0));
        let power = |k: usize| c.get(k).map_or(0.0, |c| less_constant(g, constant, c));
        let powers = [g(&c[0]), power(1), power(2)];
        let Some(near) = quadratic_fall(powers, start == Start::Spent).filter(|&near| near <= limit) else {
            return match quadratic_touch(powers).filter(|&at| start != Start::Spent && at <= limit) {
                Some(at) => Searched { fall: None, evidence: Evidence::Rounding { from: at, to: at } },
                None => Searched::solved(None),
            };
        };
        if near == 0.0 {
            return Searched::solved(Some(Crossing::at_start(f64::MIN_POSITIVE)));
        }
        let (automaton, count) = (self.automaton, &mut self.memory.stats.guards);
        Searched::solved(settle(
            |s| {
                *count += 1;
                automaton.guard(edge, now.after(s).seconds(), &horner(c, s))
            },
            near,
        ))
    }

    /// The fall that the model's own formula gives, at a time at which the guard is not negative.
    pub(super) fn fall_by_formula(
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

    /// Searches ever longer windows of a solution `at`, the first of a length that is natural to it.
    pub(super) fn fall_in_windows(
        &mut self,
        edge: A::Edge,
        now: Time,
        natural: f64,
        at: impl Fn(f64) -> A::State,
        limit: f64,
        start: Start,
    ) -> Result<Searched, Undefined> {
        let longest = self.options.longest_step;
        let mut window = if natural > 0.0 { natural.min(limit) } else { limit.min(1.0) }.min(longest);
        let mut from = 0.0;
        let mut start = start;
        let (automaton, count) = (self.automaton, &mut self.memory.stats.guards);
        let mut guard = |s: f64| {
            *count += 1;
            automaton.guard(edge, now.after(s).seconds(), &at(s))
        };
        let mut evidence = Evidence::Excluded;
        loop {
            let to = if from + window < limit { from + window } else { limit };
            let searched =
                first_fall(|s| guard(from + s), to - from, start).map_err(|Undefined(s)| Undefined(from + s))?;
            evidence = evidence.and(searched.evidence.later(from));
            if let Some(crossing) = searched.fall {
                let fall = if from == 0.0 { Some(crossing) } else { later(&mut guard, from, &crossing) };
                return Ok(Searched { fall, evidence });
            }
            if to >= limit || !to.is_finite() {
                return Ok(Searched { fall: None, evidence });
            }
            from = to;
            window = (2.0 * window).min(longest);
            start = Start::Resumed;
        }
    }
}

/// A crossing found `from` after the start of the guard's clock.
fn later(guard: &mut impl FnMut(f64) -> f64, from: f64, crossing: &Crossing) -> Option<Crossing> {
    let [inside, outside, root] = [crossing.inside, crossing.outside, crossing.root].map(|s| from + s);
    if inside < outside && guard(inside) >= 0.0 && guard(outside) < 0.0 {
        let (inside, outside) = narrowed(guard, inside, outside);
        Some(Crossing { inside, outside, root: root.clamp(inside, outside), rest: 0.0 })
    } else {
        settle(guard, root)
    }
}

/// The time in which the fastest coordinate of a polynomial changes by its own size, but no thousandth of that of the slowest one.
pub(super) fn natural<S: State>(c: &[S]) -> f64 {
    let of = |i: usize| {
        (1..c.len())
            .flat_map(|k| (0..k).map(move |j| (j, k)))
            .map(|(j, k)| (j, k, c[j].get(i).abs(), c[k].get(i).abs()))
            .filter(|&(_, _, low, high)| low > 0.0 && high > 0.0)
            .map(|(j, k, low, high)| (low / high).powf(1.0 / (k - j) as f64))
            .fold(0.0, f64::max)
    };
    let times = || (0..c[0].len()).map(of).filter(|&time| time > 0.0);
    let slowest = times().fold(0.0, f64::max);
    times().fold(slowest, f64::min).max(1e-3 * slowest)
}

/// The state at the end of a piece that may last for ever.
fn end_of<S: State>(c: &[S], span: f64) -> S {
    if span.is_finite() || c.len() > 1 { horner(c, span) } else { c[0] }
}

/// A hair past the end of the span, so that a crossing that rounding puts just behind it is taken at it.
#[inline]
pub(super) fn past(remaining: f64) -> f64 {
    remaining * (1.0 + 4.0 * f64::EPSILON)
}
