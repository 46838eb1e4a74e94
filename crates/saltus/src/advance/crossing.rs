//! The first crossing on a piece of an arc, and the state on its inner side.

use crate::automaton::Automaton;
use crate::automaton::refusal::guard_undefined;
use crate::certainty::{FAR, FEW, ROUGHLY, SURELY, TINY};
use crate::cross::{
    Crossing, FirstFall, Powers, Searched, Start, Undefined, first_fall_of_polynomial, first_fall_on_arc, settle,
};
use crate::error::Error;
use crate::inspection::Inspection;
use crate::observe::Observer;
use crate::piece::{LONG, horner};
use crate::poly::{Bernstein, MAX_DEGREE, SUMMED};
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Time, resolution};

use super::Advance;
use super::near::Near;

/// The exponent of the largest coordinate of a state that a guard's constant, of an exponent far
/// below it, costs no digits: half of what numbers have, so that the guard is one.
const LARGER: i64 = 511;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// The earliest crossing within a range of a dense output; an observer is told how guards were
    /// searched. A guard that is no number beyond it does not matter. Long, since what one edge
    /// shows bounds what is looked for of the next.
    pub(super) fn first_crossing(
        &mut self,
        mode: A::Mode,
        step: Step<'_, A::State>,
        range: Range,
        mut observer: Option<&mut impl Observer<A>>,
    ) -> Result<Option<OnStep<A>>, Error> {
        let mut found: Option<OnStep<A>> = None;
        let mut powers = Powers::new();
        let mut undefined: Option<(f64, A::Edge)> = None;
        let Step { now, c, scale } = step;
        let Range { limit, first, roughly } = range;
        for edge in self.automaton.edges(mode).iter() {
            let (start, level) = (self.start(edge, first), self.level(edge));
            if !self.memory.walls.is_empty()
                && let Some(wall) = self.memory.wall(edge).filter(|wall| wall.stays || wall.falls)
            {
                let wall = *wall;
                if let Some(crossing) = self.leaves(mode, wall, step, (limit, start)) {
                    if let Some(observer) = &mut observer
                        && let Some(evidence) = self.sank(edge, step, crossing.root)
                    {
                        observer.inspection(&Inspection { mode, edge, start: now, span: limit, evidence });
                    }
                    keep_earlier(&mut found, OnStep { edge, crossing, near: None, slope: None });
                }
                continue;
            }
            let affine = self.automaton.about(edge).affine;
            let along = if affine { self.along(edge, step, limit / scale, start, level, &mut powers) } else { None };
            let by_powers = along.as_ref().map_or(FirstFall::Unclear, |along| along.first_fall(start));
            let mut near = None;
            let searched = match by_powers {
                FirstFall::Nowhere => Searched::solved(None),
                FirstFall::At(fall) if roughly => Searched::solved(Some(Crossing::after(fall.u * limit))),
                FirstFall::At(fall) => {
                    let s = fall.u * limit;
                    near = (c.len() > LONG).then(|| Near::around(c, scale, s));
                    self.falls_by_powers(edge, step, &near, s, level)
                }
                FirstFall::Unclear => match self.falls_by_values(edge, step, limit, (start, level), along.as_ref()) {
                    Ok(searched) => searched,
                    Err(Undefined(s)) => {
                        undefined = undefined.filter(|&(first, _)| first <= s).or(Some((s, edge)));
                        continue;
                    }
                },
            };
            let Searched { fall, mut evidence, turn } = searched;
            let derivatives = by_powers.derivatives(limit);
            if start == Start::Spent && fall.is_none() {
                self.stays_in(mode, edge, (now, &c[0]), (now.after(limit), &step.at(limit)))?;
            }
            if let Some(observer) = &mut observer {
                let grazing = if let Some(crossing) = fall {
                    self.grazes(edge, (step, range), crossing.root, derivatives)
                } else {
                    let by_powers = || along.as_ref()?.powers.turns().map(|turn| turn.map(|u| u * limit));
                    turn.or_else(by_powers).and_then(|turn| {
                        let leaves = first && (start == Start::Spent || self.memory.wall(edge).is_some());
                        self.missed(edge, (step, range), turn, leaves)
                    })
                };
                evidence = grazing.map_or(evidence, |grazing| evidence.and(grazing));
                observer.inspection(&Inspection { mode, edge, start: now, span: limit, evidence });
            }
            if let Some(crossing) = fall {
                let slope = derivatives.map(|[slope, _]| slope);
                keep_earlier(&mut found, OnStep { edge, crossing, near, slope });
            }
        }
        let first = found.as_ref().map_or(f64::INFINITY, |found| found.crossing.inside);
        match undefined.filter(|&(s, _)| s < first) {
            Some((s, edge)) => Err(self.undefined(mode, edge, now, s, &step.at(s))),
            None => Ok(found),
        }
    }

    /// The fall of the guard of `edge` that its powers show at a time `s` of a step, `near` which
    /// the dense output may be summed up.
    #[inline(always)] // what it finds is looked at at once, and need not lie in memory
    fn falls_by_powers(
        &mut self,
        edge: A::Edge,
        Step { now, c, scale }: Step<'_, A::State>,
        near: &Option<Near<A::State>>,
        s: f64,
        level: f64,
    ) -> Searched {
        let (automaton, smooth, count) = (self.automaton, self.smooth, &mut self.memory.stats.guards);
        let mut guard = |s: f64| {
            *count += 1;
            automaton.guard(edge, smooth.within(now.after(s).seconds()), &at(near, c, scale, s))
        };
        let searched = Searched::solved(settle(|s| guard(s) - level, s));
        unlevelled(searched, level, &mut guard)
    }

    /// Where the guard of `edge` falls on a step, by its values, or by the sign of its powers in
    /// the Bernstein basis.
    #[inline(never)] // of promised guards few need it: what is always done stays short
    fn falls_by_values(
        &mut self,
        edge: A::Edge,
        Step { now, c, scale }: Step<'_, A::State>,
        limit: f64,
        (start, level): (Start, f64),
        along: Option<&Along<'_>>,
    ) -> Result<Searched, Undefined> {
        let p = along.and_then(Along::bernstein);
        let (value, bend) = if p.is_none() {
            self.memory.stats.guards += 1;
            let value = self.guard(edge, now.seconds(), &c[0]) - level;
            // How far it bends tells what it is rough by near a zero at the start alone.
            let at_zero = start == Start::Spent || value == 0.0;
            (value, if at_zero { self.bend(edge, now, c) } else { 0.0 })
        } else {
            (0.0, 0.0)
        };
        let (automaton, smooth, count) = (self.automaton, self.smooth, &mut self.memory.stats.guards);
        let mut guard = |s: f64| {
            *count += 1;
            automaton.guard(edge, smooth.within(now.after(s).seconds()), &horner(c, s / scale))
        };
        let mut above = |s: f64| guard(s) - level;
        let searched = match &p {
            Some((p, margin, bend)) => first_fall_of_polynomial(p, *margin, *bend, &mut above, limit, start)?,
            None => {
                let tick = resolution(now.seconds().abs() + limit);
                first_fall_on_arc(&mut above, value, limit, start, bend, tick)?
            }
        };
        Ok(unlevelled(searched, level, &mut guard))
    }

    /// An affine guard less its `level` along a polynomial over `0..=stretch` times its scale, g(Σ
    /// cₖ θᵏ) = g(c₀) + Σ (g(cₖ) - g(0)) θᵏ, and its rounding.
    #[inline]
    fn along<'p>(
        &mut self,
        edge: A::Edge,
        Step { now, c, .. }: Step<'_, A::State>,
        stretch: f64,
        start: Start,
        level: f64,
        powers: &'p mut Powers,
    ) -> Option<Along<'p>> {
        if c.len() > MAX_DEGREE + 1 {
            return None;
        }
        let t = now.seconds();
        self.memory.stats.guards += c.len() as u64 + 1;
        let guard = |x: &A::State| self.automaton.guard(edge, t, x);
        let (constant, g) = (guard(&c[0].with(|_| 0.0)), guard(&c[0]));
        powers.fill(g - level, &c[1..], |c| less_constant(guard, constant, c), stretch);
        let count = &mut self.memory.stats.guards;
        if let (Start::Spent, Some(slope)) = (start, c.get(1))
            && only_touched(powers.coefficients(), &guard, constant, slope, count)
        {
            powers.drop_slope();
        }
        Some(Along { powers, start: g, constant })
    }

    /// How an arc's last piece ends at a crossing, where the state a time `s` after `now` is
    /// `at(s)`; notes how far from zero rounding may leave the guard there. The time of a crossing
    /// `by_formula` from a spent root is not spoilt by where rounding has left the guard before.
    #[inline(always)] // an exact solution has the scale 1, by which nothing need then be divided
    pub(super) fn close(
        &mut self,
        (edge, crossing): (A::Edge, Crossing),
        now: Time,
        at: impl Fn(f64) -> A::State,
        remaining: f64,
        by_formula: bool,
    ) -> Close<A::State> {
        let Crossing { inside, outside, root, rest, leaps } = crossing;
        let span = inside.min(remaining);
        // The time of the jump, at which the next arc begins: what the guard is then is what it is
        // here.
        let time = if root < remaining { now.after(root).after(rest) } else { now.after(remaining) };
        let t = time.seconds();
        self.memory.stats.guards += 1;
        let outer = self.guard(edge, now.after(outside).seconds(), &at(outside));
        let mut guard = |x: &A::State| {
            self.memory.stats.guards += 1;
            self.guard(edge, t, x)
        };
        let nearest = at(root);
        let g = guard(&nearest);
        let (state, g) = if g >= 0.0 { (nearest, g) } else { innermost(&mut guard, &nearest, &at(span)) };
        (self.memory.slack, self.memory.leapt) = (FEW * g.abs().max(outer.abs()), leaps);
        let short = self.memory.is_short(root);
        let resolved = root > SURELY * f64::EPSILON * t.abs();
        let again = self.memory.spent_as(edge).is_some();
        let hidden =
            short && resolved && !(by_formula && again) && self.hides(edge, now, root, &at(0.5 * root), &state);
        self.memory.hidden = if hidden { self.memory.hidden + 1 } else { 0 };
        let doubtful = self.memory.last == Some(edge) && (hidden || short && !resolved && !by_formula);
        self.memory.spurious = doubtful && self.rises(edge, now, root, &at);
        Close { span, time, state }
    }

    /// Whether on a short arc from `now` to its `end` after `duration` the guard rises so little
    /// that its rounding at the end shows: what the state's coordinates are rounded by, or what
    /// time is, where the guard moves with it.
    #[cold]
    fn hides(&mut self, edge: A::Edge, now: Time, duration: f64, middle: &A::State, end: &A::State) -> bool {
        self.memory.stats.guards += 3;
        let t = now.after(duration).seconds();
        let rise = self.guard(edge, now.after(0.5 * duration).seconds(), middle);
        let g = self.guard(edge, t, end);
        let moved = (self.guard(edge, t + duration, end) - g).abs() / duration;
        let by_time = moved * resolution(t);
        rise < FAR * SURELY * self.guard_rounding(edge, t, end, g, end) + SURELY * by_time
    }

    /// Whether the guard rises through its fall at `root`, looked at from so far on both sides that
    /// rounding does not matter: such a fall, on an arc so short that rounding shows, is the
    /// rounding's, while the state is on its way up.
    #[cold]
    fn rises(&mut self, edge: A::Edge, now: Time, root: f64, at: impl Fn(f64) -> A::State) -> bool {
        self.memory.stats.guards += 2;
        // So that the rounding of time and what the guard bends by weigh alike.
        let (longest, t) = (self.memory.longest_duration, now.seconds());
        let far = ROUGHLY * longest * (resolution(t) / longest).cbrt();
        let [before, after] = [root - far, root + far].map(|s| self.guard(edge, now.after(s).seconds(), &at(s)));
        after > before
    }

    /// The guard of `edge` is not a number a time `s` after `now`.
    pub(super) fn undefined(&self, mode: A::Mode, edge: A::Edge, now: Time, s: f64, x: &A::State) -> Error {
        guard_undefined(self.automaton, mode, edge, now.after(s).seconds(), x)
    }
}

/// Where on a dense output guards are looked at.
#[derive(Clone, Copy)]
pub(super) struct Range {
    /// From its start on, up to this.
    pub(super) limit: f64,
    /// Whether it begins the arc.
    pub(super) first: bool,
    /// Whether the crossing is looked for again on a real step to it, and need not be settled
    /// between neighbouring times here.
    pub(super) roughly: bool,
}

/// Whether a guard of the value `start` stays above zero when it changes by `most`,
/// with room for the digits that its `constant` costs.
#[inline]
pub(super) fn exceeds(start: f64, most: f64, constant: f64) -> bool {
    let rounding = SURELY * f64::EPSILON * (constant.abs() + start.abs() + most);
    start > most + rounding && rounding < f64::INFINITY
}

/// What an affine guard of this `constant` adds to it for the state `x`: taken of a state a power
/// of two larger, so that the constant does not cost it digits.
#[inline]
pub(super) fn less_constant<S: State>(guard: impl Fn(&S) -> f64, constant: f64, x: &S) -> f64 {
    if constant == 0.0 { guard(x) } else { less(&guard, constant, x) }
}

fn less<S: State>(guard: &dyn Fn(&S) -> f64, constant: f64, x: &S) -> f64 {
    let size = (0..x.len()).fold(0.0, |size: f64, i| size.max(x.get(i).abs()));
    if size == 0.0 {
        return 0.0;
    }
    // A guard that is large itself may have no number there, or a constant beside which this is
    // nothing.
    for exponent in [LARGER, LARGER / 4] {
        let by = power_of_two(exponent - exponent_of(size));
        let far = guard(&x.with(|i| by * x.get(i))) - constant;
        if far.abs() >= constant.abs() && far.is_finite() {
            return far / by;
        }
        if far.is_finite() {
            break;
        }
    }
    guard(x) - constant
}

/// The e of a number from 2ᵉ up to twice that.
#[inline]
fn exponent_of(x: f64) -> i64 {
    (x.to_bits() >> 52 & 0x7ff).cast_signed() - 1023
}

/// 2ᵉ, as far as there is such a number.
#[inline]
fn power_of_two(e: i64) -> f64 {
    f64::from_bits((e.clamp(-1022, 1023) + 1023).cast_unsigned() << 52)
}

/// Whether an affine guard of these `powers` that seems to fall from its root only touched zero
/// there: it bends down, and its slope, that of the state `x`, is no more than rounding.
#[inline]
pub(super) fn only_touched<S: State>(
    powers: &[f64],
    guard: &dyn Fn(&S) -> f64,
    constant: f64,
    x: &S,
    count: &mut u64,
) -> bool {
    matches!(powers, [_, slope, bend, ..] if *slope < 0.0 && *bend < 0.0) && is_rounding(guard, constant, x, count)
}

/// Whether what an affine guard of this `constant` adds to it for the state `x` is no more than the
/// rounding of what each coordinate adds.
#[cold]
pub(super) fn is_rounding<S: State>(guard: &dyn Fn(&S) -> f64, constant: f64, x: &S, count: &mut u64) -> bool {
    *count += x.len() as u64 + 1;
    let part = |k: usize| less_constant(guard, constant, &x.with(|i| if i == k { x.get(i) } else { 0.0 }));
    let parts: f64 = (0..x.len()).map(|k| part(k).abs()).sum();
    less_constant(guard, constant, x).abs() <= SUMMED * f64::EPSILON * parts
}

/// What was found of a guard less its `level` at the start, of the `guard` itself.
#[inline]
pub(super) fn unlevelled(searched: Searched, level: f64, guard: &mut dyn FnMut(f64) -> f64) -> Searched {
    if level == 0.0 { searched } else { off_level(searched, guard) }
}

/// Seldom, and so out of the way of what is always done.
#[cold]
fn off_level(searched: Searched, guard: &mut dyn FnMut(f64) -> f64) -> Searched {
    let later = searched.fall.filter(|fall| fall.inside > 0.0);
    Searched { fall: later.and_then(|fall| settle(guard, fall.root)).or(searched.fall), ..searched }
}

/// A step's start, dense output and size.
#[derive(Clone, Copy)]
pub(super) struct Step<'c, S> {
    pub(super) now: Time,
    pub(super) c: &'c [S],
    pub(super) scale: f64,
}

impl<S: State> Step<'_, S> {
    /// The time `s` after its start.
    pub(super) fn time(&self, s: f64) -> f64 {
        self.now.after(s).seconds()
    }

    /// The state then.
    #[inline(never)] // where guards are searched it is summed up in place
    pub(super) fn at(&self, s: f64) -> S {
        horner(self.c, s / self.scale)
    }
}

/// The first crossing on a step.
pub(super) struct OnStep<A: Automaton> {
    pub(super) edge: A::Edge,
    pub(super) crossing: Crossing,
    /// The dense output near it, if it is long and its powers showed the crossing.
    pub(super) near: Option<Near<A::State>>,
    /// dg/dt there, if its powers showed it.
    pub(super) slope: Option<f64>,
}

impl<A: Automaton> Clone for OnStep<A> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A: Automaton> Copy for OnStep<A> {}

impl<A: Automaton> OnStep<A> {
    /// The state after a time `s`, as the search computes it.
    #[inline]
    pub(super) fn at(&self, c: &[A::State], scale: f64, s: f64) -> A::State {
        at(&self.near, c, scale, s)
    }
}

/// The state after a time `s` on a dense output that may be summed up `near` it.
#[inline]
fn at<S: State>(near: &Option<Near<S>>, c: &[S], scale: f64, s: f64) -> S {
    match near {
        Some(near) => near.at(c, scale, s),
        None => horner(c, s / scale),
    }
}

/// The end of an arc's last piece.
pub(super) struct Close<S> {
    pub(super) span: f64,
    pub(super) time: Time,
    pub(super) state: S,
}

/// Of the states within rounding of a crossing, the one nearest to the root whose guard is not
/// negative.
///
/// Always keeping the inner end would make every crossing early by half a rounding, and an elastic
/// ball lose energy at each impact. So coordinates are taken from the inner end only as far as it
/// takes to stay inside: a ball's height, not its speed.
///
/// Returns the state and its guard, for a nearest one that is outside.
#[inline]
fn innermost<S: State>(mut guard: impl FnMut(&S) -> f64, nearest: &S, inner: &S) -> (S, f64) {
    for k in 0..nearest.len() {
        let mixed = nearest.with(|i| if i == k { inner.get(i) } else { nearest.get(i) });
        let g = guard(&mixed);
        if g >= 0.0 {
            return (mixed, g);
        }
    }
    (*inner, guard(inner))
}

/// An affine guard along a step in powers of time.
struct Along<'p> {
    powers: &'p Powers,
    /// The guard at the start, and its constant.
    start: f64,
    constant: f64,
}

impl Along<'_> {
    /// How far its value at the start may be off.
    fn rounding(&self) -> f64 {
        FEW * f64::EPSILON * (self.constant.abs() + self.start.abs())
    }

    /// Where it first falls, as far as its powers show it at once.
    fn first_fall(&self, start: Start) -> FirstFall {
        let powers = self.powers;
        // What rounding has left of the guard at a wall is above zero all the same if nothing moves
        // by as much.
        if start != Start::Spent && exceeds(self.start, powers.change(), self.constant) {
            return FirstFall::Nowhere;
        }
        let margin = powers.rounding();
        // From a wall, be it spent or not, only the change counts.
        if start == Start::Spent || powers.coefficients()[0].abs() <= self.rounding() + margin {
            powers.first_fall(1, TINY * powers.bend() + margin)
        } else {
            powers.first_fall(0, self.rounding() + margin)
        }
    }

    /// The same in the Bernstein basis, how far it may be off, and how far it bends.
    fn bernstein(&self) -> Option<(Bernstein, f64, f64)> {
        let p = Bernstein::from_powers(self.powers.coefficients())?;
        Some((p, self.rounding() + p.rounding(), self.powers.bend()))
    }
}

/// Keeps the earlier of the crossing `found` on a step and a `further` one; of two that time cannot
/// tell apart the first.
#[inline]
fn keep_earlier<A: Automaton>(found: &mut Option<OnStep<A>>, further: OnStep<A>) {
    if let Some(first) = found
        && let Some(both) = together(&first.crossing, &further.crossing)
    {
        first.crossing = both;
    } else {
        *found = Some(further);
    }
}

/// Of two crossings that time cannot tell apart the first, with the inner end of both, so that
/// neither guard is past zero there; nothing if the second is earlier.
#[inline]
pub(super) fn together(first: &Crossing, second: &Crossing) -> Option<Crossing> {
    let same = second.outside >= first.inside;
    same.then(|| Crossing { inside: first.inside.min(second.inside), ..*first })
}
