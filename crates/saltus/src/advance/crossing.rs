//! The first crossing on a piece of an arc, and the state on its inner side.

use std::ops;

use crate::automaton::Automaton;
use crate::automaton::refusal::guard_undefined;
use crate::certainty::{FAR, FEW, ROUGHLY, SMALL, SURELY};
use crate::cross::{
    AT_START, Crossing, Evidence, FirstFall, Powers, SAMPLES, Searched, Start, Undefined, first_fall_of_polynomial,
    first_fall_on_step, settle, stay_clear,
};
use crate::error::Error;
use crate::inspection::Inspection;
use crate::observe::Observer;
use crate::piece::{LONG, horner};
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Time, resolution};

use super::Advance;
use super::affine::Along;
use super::memory::CROWDED;
use super::near::Near;
use super::noise::Carried;
use super::shared::{Shared, Step};

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// The earliest crossing within a range of a dense output; an observer gets how guards were
    /// searched. A guard that is no number beyond it does not matter. Long, since what one edge
    /// shows bounds what is looked for of the next.
    pub(super) fn first_crossing(
        &mut self,
        mode: A::Mode,
        step: Step<'_, A::State>,
        range: Range,
        mut observer: Option<&mut dyn Observer<A>>,
    ) -> Result<Option<OnStep<A>>, Error> {
        let mut found: Option<OnStep<A>> = None;
        let mut powers = Powers::new();
        let mut undefined: Option<(f64, A::Edge)> = None;
        let mut spent = None;
        let (zero, mut shared) = (step.c[0].with(|_| 0.0), Shared::new());
        let Step { now, c, scale, .. } = step;
        let Range { limit, first, roughly } = range;
        for edge in self.automaton.edges(mode).iter() {
            let (start, level) = (self.start(edge, first), self.level(edge));
            if !self.memory.walls.is_empty()
                && let Some(&wall) = self.memory.wall(edge).filter(|wall| wall.stays || wall.falls)
                && !(wall.stays && self.rises_from(wall, step, limit, &mut shared))
            {
                if observer.is_some() && !self.memory.resolved {
                    self.hold_down(edge, step, limit);
                }
                if let Some(crossing) = self.leaves(mode, wall, step, (limit, start)) {
                    if let Some(observer) = &mut observer
                        && let Some(evidence) = self.sank(edge, step, crossing.root)
                    {
                        observer.inspection(&Inspection { mode, edge, start: now, span: limit, evidence });
                    }
                    self.keep_earlier(&mut found, now, OnStep { edge, crossing, near: None, slope: None });
                }
                continue;
            }
            let affine = self.automaton.about(edge).affine;
            let along = if affine {
                self.along(edge, step, limit / scale, (start, level), (&zero, &mut shared), &mut powers)
            } else {
                None
            };
            let by_powers = along.as_ref().map_or(FirstFall::Unclear, |along| along.first_fall(start));
            // As most are on most steps: nothing of what is looked for of others is set up.
            if matches!(by_powers, FirstFall::Nowhere)
                && along.as_ref().is_some_and(|along| along.powers.turns().is_none())
            {
                spent = if start == Start::Spent { spent.or(Some(edge)) } else { spent };
                if let Some(observer) = &mut observer {
                    let evidence = Evidence::Excluded;
                    observer.inspection(&Inspection { mode, edge, start: now, span: limit, evidence });
                }
                continue;
            }
            let mut near = None;
            let searched = match by_powers {
                FirstFall::Nowhere => Searched::solved(None),
                FirstFall::At(fall) if roughly => Searched::solved(Some(Crossing::after(fall.u * limit))),
                FirstFall::At(fall) => {
                    let s = fall.u * limit;
                    near = (c.len() > LONG).then(|| Near::around(c, scale, s));
                    self.falls_by_powers(edge, step, &near, s, level)
                }
                FirstFall::Unclear => {
                    let searched = match along.as_ref().and_then(Along::bernstein) {
                        Some((p, margin, bend)) => self.searched(edge, step, level, |above| {
                            first_fall_of_polynomial(&p, margin, bend, above, limit, start)
                        }),
                        None => match self.unclear(edge, step, limit, (start, level), &mut shared) {
                            Some(values) => self.falls_by_values(edge, step, limit, (start, level), &values),
                            None => Ok(Searched::solved(None)),
                        },
                    };
                    match searched {
                        Ok(searched) => searched,
                        Err(Undefined(s)) => {
                            undefined = undefined.filter(|&(first, _)| first <= s).or(Some((s, edge)));
                            continue;
                        }
                    }
                }
            };
            let Searched { fall, mut evidence, turn } = searched;
            let derivatives = by_powers.derivatives(limit);
            if start == Start::Spent && fall.is_none() {
                spent = spent.or(Some(edge));
            }
            if let Some(observer) = &mut observer {
                let grazing = if let Some(crossing) = fall {
                    self.grazes(edge, (step, range), crossing.root, derivatives)
                } else {
                    let by_powers = || along.as_ref()?.powers.turns().map(|turn| turn.times(limit));
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
                self.keep_earlier(&mut found, now, OnStep { edge, crossing, near, slope });
            }
        }
        let first = found.as_ref().map_or(f64::INFINITY, |found| found.crossing.inside);
        match undefined.filter(|&(s, _)| s < first) {
            Some((s, edge)) => Err(self.undefined(mode, edge, now, s, &step.at(s))),
            None => {
                // Where the arc ends before, it is looked at there: another edge may be due at
                // once.
                if let (Some(edge), None) = (spent, &found)
                    && let Err(fell_on) = self.stays_in(mode, edge, (now, &c[0]), (now.after(limit), &step.at(limit)))
                {
                    // One that falls from rest, as far as noise shows, has come to its wall again.
                    let soon = self.on(edge, step, SMALL * limit).abs();
                    if soon > ROUGHLY * self.on(edge, step, limit).abs()
                        || self.carried(mode, edge, now.seconds(), &c[0], step.size) != Carried::Along
                    {
                        return Err(fell_on);
                    }
                    let crossing = Crossing::at_start(limit * AT_START);
                    return Ok(Some(OnStep { edge, crossing, near: None, slope: None }));
                }
                Ok(found)
            }
        }
    }

    /// The fall of the guard of `edge` that its powers show at a time `s` of a step, `near` which
    /// the dense output may be summed up.
    #[inline(always)] // what it finds is looked at at once, and need not lie in memory
    fn falls_by_powers(
        &mut self,
        edge: A::Edge,
        Step { now, c, scale, .. }: Step<'_, A::State>,
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

    /// Where the guard of `edge` falls on a step, by its `values` and further ones.
    #[inline(never)] // few need it
    fn falls_by_values(
        &mut self,
        edge: A::Edge,
        step: Step<'_, A::State>,
        limit: f64,
        (start, level): (Start, f64),
        values: &[f64; SAMPLES],
    ) -> Result<Searched, Undefined> {
        // How far it bends tells what it is rough by near a zero at the start alone.
        let at_zero = start == Start::Spent || values[0] == 0.0;
        let bend = if at_zero { self.bend(edge, step, limit) } else { 0.0 };
        let tick = resolution(step.now.seconds().abs() + limit);
        let search = |above: &mut dyn FnMut(f64) -> f64| first_fall_on_step(above, values, limit, start, bend, tick);
        self.searched(edge, step, level, search)
    }

    /// The first samples of the guard of `edge` less its `level`, unless they show at a glance that
    /// it does not fall: they are taken where those of the other guards are.
    #[inline(never)] // of promised guards none need it
    fn unclear<'c>(
        &mut self,
        edge: A::Edge,
        step: Step<'c, A::State>,
        limit: f64,
        (start, level): (Start, f64),
        shared: &mut Shared<'c, A::State>,
    ) -> Option<[f64; SAMPLES]> {
        self.memory.stats.guards += SAMPLES as u64;
        let automaton = self.automaton;
        let values = shared.values(step, limit, self.smooth, |t, x| automaton.guard(edge, t, x) - level);
        (start == Start::Spent || !stay_clear(&values)).then_some(values)
    }

    /// What a `search` finds of the guard of `edge` less its `level` on a step, of the guard
    /// itself.
    #[inline(never)] // few need it: what is always done stays short
    fn searched(
        &mut self,
        edge: A::Edge,
        Step { now, c, scale, .. }: Step<'_, A::State>,
        level: f64,
        search: impl FnOnce(&mut dyn FnMut(f64) -> f64) -> Result<Searched, Undefined>,
    ) -> Result<Searched, Undefined> {
        let (automaton, smooth, count) = (self.automaton, self.smooth, &mut self.memory.stats.guards);
        let mut guard = |s: f64| {
            *count += 1;
            automaton.guard(edge, smooth.within(now.after(s).seconds()), &horner(c, s / scale))
        };
        let searched = search(&mut |s: f64| guard(s) - level)?;
        Ok(unlevelled(searched, level, &mut guard))
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
        let about = self.automaton.about(edge);
        let mut guard = |x: &A::State| {
            self.memory.stats.guards += 1;
            self.guard(edge, t, x)
        };
        let nearest = at(root);
        let g = guard(&nearest);
        let (state, g) =
            if g >= 0.0 { (nearest, g) } else { innermost(&mut guard, &nearest, &at(span), about.read(nearest.len())) };
        (self.memory.slack, self.memory.leapt) = (FEW * g.abs().max(outer.abs()), leaps);
        // Of the arc, of which this is the last piece: a stiff flow steps shortly to its crossing.
        let before = now.since(self.began);
        let short = self.memory.is_short(before + root);
        let resolved = before + root > SURELY * f64::EPSILON * t.abs();
        let again = self.memory.spent_as(edge).is_some();
        let hidden =
            short && resolved && before == 0.0 && !(by_formula && again) && self.hides(edge, now, root, &at, &state);
        self.memory.hidden = if hidden { self.memory.hidden + 1 } else { 0 };
        let doubtful = self.memory.last == Some(edge) && (hidden || short && !resolved && !by_formula);
        let crowded = !resolved && self.time_rounding(edge, t, &state, g) > 0.0;
        self.memory.crowded = if crowded { self.memory.crowded + 1 } else { 0 };
        self.memory.spurious = doubtful && self.rises(edge, now, root, &at) || self.memory.crowded >= CROWDED;
        Close { span, time, state }
    }

    /// Whether on a short arc from `now` to its `end` after `duration` the guard moves away from
    /// zero by so little that its rounding at the end shows: what the state's coordinates are
    /// rounded by, or what time is, where the guard moves with it.
    #[cold]
    fn hides(&mut self, edge: A::Edge, now: Time, duration: f64, at: impl Fn(f64) -> A::State, end: &A::State) -> bool {
        self.memory.stats.guards += 5;
        let t = now.after(duration).seconds();
        // One that falls on through its root, and rises again, may be zero in the middle.
        let away = [0.25, 0.5, 0.75].map(|part| {
            let s = part * duration;
            self.guard(edge, now.after(s).seconds(), &at(s)).abs()
        });
        let rise = away.into_iter().fold(0.0, f64::max);
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
        let guard = |s: f64| self.guard(edge, now.after(s).seconds(), &at(s));
        guard(root + far) > guard(root - far)
    }

    /// The guard of `edge` is not a number a time `s` after `now`.
    pub(super) fn undefined(&self, mode: A::Mode, edge: A::Edge, now: Time, s: f64, x: &A::State) -> Error {
        guard_undefined(self.automaton, mode, edge, now.after(s).seconds(), x)
    }

    /// Keeps the earlier of the crossing `found` on a step and a `further` one; of two that time
    /// cannot tell apart the first.
    #[inline]
    fn keep_earlier(&mut self, found: &mut Option<OnStep<A>>, now: Time, further: OnStep<A>) {
        if let Some(first) = found {
            if let Some(both) = together(&first.crossing, &further.crossing) {
                first.crossing = both;
                return;
            }
            self.may_be_tied(first.edge, first.crossing.inside, now, further.crossing.outside);
        }
        *found = Some(further);
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

/// The first crossing on a step.
pub(super) struct OnStep<A: Automaton> {
    pub(super) edge: A::Edge,
    pub(super) crossing: Crossing,
    /// The dense output near it, if it is long and its powers showed the crossing.
    pub(super) near: Option<Near<A::State>>,
    /// dg/dt there, if its powers showed it.
    pub(super) slope: Option<f64>,
}

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
/// takes to stay inside, and of those that the guard may `read`: a ball's height, not its speed.
///
/// Returns the state and its guard, for a nearest one that is outside.
#[inline]
fn innermost<S: State>(mut guard: impl FnMut(&S) -> f64, nearest: &S, inner: &S, read: ops::Range<usize>) -> (S, f64) {
    for k in read {
        let mixed = nearest.with(|i| if i == k { inner.get(i) } else { nearest.get(i) });
        let g = guard(&mixed);
        if g >= 0.0 {
            return (mixed, g);
        }
    }
    (inner.clone(), guard(inner))
}

/// Of two crossings that time cannot tell apart the first, with the inner end of both, so that
/// neither guard is past zero there; nothing if the second is earlier.
#[inline]
pub(super) fn together(first: &Crossing, second: &Crossing) -> Option<Crossing> {
    let same = second.outside >= first.inside;
    same.then(|| Crossing { inside: first.inside.min(second.inside), ..*first })
}
