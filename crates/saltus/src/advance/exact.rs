//! An arc whose flow is solved exactly.

use std::cell::LazyCell;
use std::fmt::Debug;

use crate::automaton::Automaton;
use crate::automaton::solution::Polynomial;
use crate::certainty::{FAR, ROUNDINGS, SMALL, TINY};
use crate::cross::{
    Crossing, Doubt, Evidence, Searched, Start, Undefined, first_fall_on_arc, neighbours, sample_times, settle,
};
use crate::ending::Stop;
use crate::error::{Error, ErrorKind, Place};
use crate::observe::Observer;
use crate::piece::{Piece, horner};
use crate::poly::{quadratic_fall, quadratic_touch};
use crate::state::State;
use crate::step::Stepper;
use crate::time::{LAST, Span, Time, resolution};

use super::affine::{less_constant, only_touched};
use super::crossing::{Close, unlevelled};
use super::enter::weight;
use super::solved::First;
use super::{Advance, ArcEnd};

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    #[inline]
    pub(super) fn exact(
        &mut self,
        mode: A::Mode,
        solution: &Polynomial<A::State>,
        clock: &Span,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        self.memory.stats.exact += 1;
        let c = solution.coefficients();
        let (now, remaining) = (clock.now, clock.remaining());
        let natural = LazyCell::new(|| natural(c));
        let at = |s: f64| horner(c, s);
        let search = |this: &mut Self, edge, limit, start| {
            if c.len() <= 3 && this.automaton.about(edge).affine {
                return Ok((this.fall_of_parabola(edge, now, c, limit, start), true));
            }
            this.fall_in_windows(edge, now, *natural, at, limit, start).map(|searched| (searched, false))
        };
        let first = self.first_on_solution(mode, &c[0], clock, at, search, observer)?;
        if let Some((cut, stop)) = self.cut_before(first.as_ref()) {
            let time = now.after(cut);
            let state = in_numbers(mode, time, at(cut))?;
            let told = observer.piece(mode, &Piece::new(now, cut, 1.0, c));
            let stop = if told.is_break() { Stop::Observer } else { stop };
            return Ok(ArcEnd::Stop { stop, time, state });
        }
        let close = match &first {
            Some(first) => {
                let duration = first.crossing.root;
                self.memory.reach = c.get(1).map(|slope| slope.with(|i| duration * slope.get(i)));
                self.close_on_solution(first, now, at, remaining)
            }
            None => {
                let state = in_numbers(mode, clock.in_numbers().end, at(remaining.min(LAST)))?;
                Close { span: remaining, time: clock.end, state }
            }
        };
        let span = match &first {
            Some(first) if first.is_told() && observer.wants_pieces() => {
                self.span_inside(first.edge, now, at, close.span)
            }
            _ => close.span,
        };
        let told = observer.piece(mode, &Piece::new(now, span, 1.0, c));
        Ok(ArcEnd::after(first.map(|first| first.edge), told, close.time, close.state))
    }

    /// An affine guard along a parabola is a parabola.
    #[inline]
    fn fall_of_parabola(&mut self, edge: A::Edge, now: Time, c: &[A::State], limit: f64, start: Start) -> Searched {
        let g = |x: &A::State| self.automaton.guard(edge, now.seconds(), x);
        self.memory.stats.guards += c.len() as u64 + 1;
        let constant = g(&c[0].with(|_| 0.0));
        let power = |k: usize| c.get(k).map_or(0.0, |c| less_constant(g, constant, c));
        let mut powers = [g(&c[0]) - self.level(edge), power(1), power(2)];
        if start == Start::Spent
            && only_touched(
                &powers,
                &g,
                constant,
                (&c[1], self.automaton.about(edge).read(c[1].len())),
                &mut self.memory.stats.guards,
            )
        {
            powers[1] = 0.0;
        }
        let Some(near) = quadratic_fall(powers, start == Start::Spent).filter(|&near| near <= limit) else {
            return match quadratic_touch(powers).filter(|&at| start != Start::Spent && at <= limit) {
                Some(at) => {
                    Searched { evidence: Evidence::doubtful(Doubt::Rounding, at, at), ..Searched::solved(None) }
                }
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

    /// Searches ever longer windows of a solution `at`, the first of a length that is natural to
    /// it; no further than the run's limits allow, which is then noted.
    pub(super) fn fall_in_windows(
        &mut self,
        edge: A::Edge,
        now: Time,
        natural: f64,
        at: impl Fn(f64) -> A::State,
        limit: f64,
        start: Start,
    ) -> Result<Searched, Undefined> {
        let (longest, limit) = (self.options.longest_step, limit.min(LAST));
        let mut window = if natural > 0.0 { natural.min(limit) } else { limit.min(1.0) }.min(longest);
        let mut from = 0.0;
        let (mut start, mut level) = (start, self.level(edge));
        let automaton = self.automaton;
        let guard_at = |count: &mut u64, s: f64| {
            *count += 1;
            automaton.guard(edge, now.after(s).seconds(), &at(s))
        };
        let mut evidence = Evidence::Excluded;
        let mut on_wall = start == Start::Spent || self.memory.wall(edge).is_some();
        loop {
            let to = if from + window < limit { from + window } else { limit };
            let mut guard = |s: f64| guard_at(&mut self.memory.stats.guards, s);
            let tick = resolution(now.seconds().abs() + to);
            let mut above = |s| guard(from + s) - level;
            let value = above(0.0);
            let searched = first_fall_on_arc(&mut above, value, (from, to - from), start, tick)
                .map_err(|Undefined(s)| Undefined(from + s))?;
            let searched = unlevelled(searched, level, &mut guard);
            // What falls and rises along a wall is rounding. Another edge may have cut the window.
            let whole = to.max(from + natural.max(self.memory.longest_duration));
            on_wall = on_wall && self.runs_along(edge, now, (from, whole), &at);
            let searched = if on_wall { Searched::solved(None) } else { searched };
            evidence = evidence.and(searched.evidence.later(from));
            if let Some(crossing) = searched.fall {
                let mut guard = |s: f64| guard_at(&mut self.memory.stats.guards, s);
                let fall = if from == 0.0 { Some(crossing) } else { later(&mut guard, from, &crossing) };
                return Ok(Searched { evidence, ..Searched::solved(fall) });
            }
            if to >= limit {
                return Ok(Searched { evidence, ..Searched::solved(None) });
            }
            self.memory.stats.windows += 1;
            if self.options.exceeded::<A::Edge>(&self.memory.stats).is_some() {
                self.memory.cut_at = Some(self.memory.cut_at.map_or(to, |earlier| earlier.min(to)));
                return Ok(Searched { evidence, ..Searched::solved(None) });
            }
            from = to;
            // However short it is to be, it must move time on.
            window = (2.0 * window).min(longest).max(2.0 * resolution(from));
            (start, level) = (Start::Resumed, 0.0);
        }
    }

    /// Whether the guard of `edge` moves on no part of a window of a solution `at` beyond what
    /// rounding the coordinates, none smaller than at the solution's start, and the time leaves.
    #[cold]
    #[inline(never)]
    fn runs_along(&mut self, edge: A::Edge, now: Time, (from, to): (f64, f64), at: &impl Fn(f64) -> A::State) -> bool {
        let start = at(0.0);
        sample_times(from, to).into_iter().rev().all(|s| {
            let (t, x) = (now.after(s).seconds(), at(s));
            let sizes = x.with(|i| x.get(i).abs().max(start.get(i).abs()));
            self.memory.stats.guards += 2;
            let g = self.guard(edge, t, &x);
            // Most guards are clear of zero at a glance.
            let nudged = x.with(|i| x.get(i) + TINY * weight(i) * sizes.get(i));
            if g.abs() > (self.guard(edge, t + FAR * self.tick(t), &nudged) - g).abs() {
                return false;
            }
            g.abs() <= ROUNDINGS * self.rounding(edge, t, &x, g, &sizes)
        })
    }

    /// How far the search of an exact arc went, where a limit of the run cut it before any
    /// crossing.
    #[inline]
    pub(super) fn cut_before(&mut self, first: Option<&First<A>>) -> Option<(f64, Stop<A::Edge>)> {
        let cut = self.memory.cut_at.take().filter(|&cut| first.is_none_or(|first| cut < first.time()))?;
        Some((cut, self.options.exceeded(&self.memory.stats)?))
    }
}

/// A crossing found `from` after the start of the guard's clock.
fn later(guard: &mut impl FnMut(f64) -> f64, from: f64, crossing: &Crossing) -> Option<Crossing> {
    let (inside, outside, root) = (from + crossing.inside, from + crossing.outside, from + crossing.root);
    if inside < outside && guard(inside) >= 0.0 && guard(outside) < 0.0 {
        let (inside, outside) = neighbours(guard, inside, outside);
        Some(Crossing { inside, outside, root: root.clamp(inside, outside), rest: 0.0, ..*crossing })
    } else {
        Some(Crossing { leaps: crossing.leaps, ..settle(guard, root)? })
    }
}

/// The time in which the fastest coordinate of a polynomial changes by its own size, but no less
/// than a part of that of the slowest one.
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
    // One that is faster still says nothing of how the guard moves.
    times().fold(slowest, f64::min).max(SMALL * slowest)
}

/// The state of an exact solution at a time to which the run was to go: an error where it is no
/// number.
pub(super) fn in_numbers<M: Copy + Debug, S: State>(mode: M, time: Time, state: S) -> Result<S, Error> {
    if state.is_finite() {
        return Ok(state);
    }
    let place = Place::new(time.seconds(), mode, None::<()>, &state);
    Err(Error::new(ErrorKind::Flow, place).noting(Some("the exact solution leaves the range of numbers".to_owned())))
}
