//! How far a guard's value may be off: by the rounding of the state and of time, and by the error
//! of the steps.

use crate::automaton::Automaton;
use crate::certainty::{FAR, FEW, ROUGHLY, ROUNDINGS, SMALL, SURELY, TINY};
use crate::cross::{self, AT_START, Crossing, Start, sample_times};
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Time, resolution};

use super::affine::{is_rounding, less_constant};
use super::enter::weight;
use super::shared::{Shared, Step};
use super::{Advance, Spent, Wall};

/// Of how many values a guard's scatter is taken: among so few, a typical one and a large one.
/// Held by `scales::a_guard_of_its_own_arithmetic_is_entered`.
const SAMPLES: usize = 9;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// How far rounding each coordinate may move the guard: Σ |∂g/∂xᵢ| sᵢ units in the last place,
    /// with the size sᵢ that the coordinate was summed up from.
    ///
    /// Each is moved by a part of its size that is large beside rounding and small beside what a
    /// guard bends over.
    pub(super) fn guard_rounding(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64, sizes: &A::State) -> f64 {
        self.moved(edge, t, x, g, &|i| TINY * sizes.get(i).abs()) * (f64::EPSILON / TINY)
    }

    /// What the coordinates of `x` were summed up from: max(|xᵢ|, |xᵢ| at the start of a piece of
    /// an arc, |xᵢ'| there times how long it lasts), over the arcs since it was last exactly zero.
    ///
    /// A coordinate that is a rounding of what it was has the rounding of what it was, until a
    /// reset gives it anew (`renewed`). At the start of a run nothing was summed up: |xᵢ|.
    #[cold]
    pub(super) fn sizes(&self, x: &A::State) -> A::State {
        x.with(|i| self.size(x, i))
    }

    /// The same of coordinate `i`.
    #[inline]
    pub(super) fn size(&self, x: &A::State, i: usize) -> f64 {
        match (x.get(i).abs(), self.memory.largest.as_ref().filter(|largest| largest.len() == x.len())) {
            (0.0, _) => 0.0,
            (here, largest) => largest.map_or(here, |largest| here.max(largest.get(i))),
        }
    }

    /// How far rounding the coordinates and the time may move the guard of `edge`, `g` at `x`.
    pub(super) fn still(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64) -> f64 {
        let sizes = self.sizes(x);
        self.rounding(edge, t, x, g, &sizes)
    }

    /// The same of coordinates that were summed up from these `sizes`.
    pub(super) fn rounding(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64, sizes: &A::State) -> f64 {
        self.time_rounding(edge, t, x, g) + self.guard_rounding(edge, t, x, g, sizes)
    }

    /// How far a guard scatters by its own arithmetic: how far its values at times and states some
    /// roundings apart are from a line, as those of a cosine of many turns are. A single leap among
    /// them, off a line by two, is none.
    #[cold]
    pub(super) fn scatter(&mut self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        self.memory.stats.guards += SAMPLES as u64;
        let values: [f64; SAMPLES] = std::array::from_fn(|k| {
            let by = k as f64 - 0.5 * (SAMPLES - 1) as f64;
            let near = x.with(|i| x.get(i) + by * f64::EPSILON * weight(i) * self.size(x, i));
            self.guard(edge, t + by * self.tick(t), &near)
        });
        let bend = |k: usize| finite((values[k + 1] - 0.5 * (values[k] + values[k + 2])).abs());
        let mut bends: [f64; SAMPLES - 2] = std::array::from_fn(bend);
        bends.sort_unstable_by(f64::total_cmp);
        bends[bends.len() - 3]
    }

    /// How far a guard below zero may be off: by rounding, and at the start of a run, which is
    /// stated to within the absolute tolerance, by that.
    pub(super) fn entry_error(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64) -> f64 {
        let absolute = self.options.tolerance.absolute;
        let stated = if self.memory.largest.is_none() {
            steady([1.0, 2.0].map(|times| self.moved(edge, t, x, g, &|_| times * absolute)))
        } else {
            0.0
        };
        self.still(edge, t, x, g) + stated
    }

    /// How far rounding may move the guard, and what the tolerance allows in each coordinate for
    /// each step of this arc: Σ |∂g/∂xᵢ| so many times that. An exact arc has none.
    pub(super) fn within_tolerance(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64) -> f64 {
        self.within_steps(edge, t, x, g, self.memory.stats.steps - self.memory.steps_before)
    }

    /// The same after so many steps.
    fn within_steps(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64, steps: u64) -> f64 {
        let rounding = FAR * self.still(edge, t, x, g);
        if steps == 0 {
            return rounding;
        }
        let tolerance = self.options.tolerance;
        rounding + FEW * steps as f64 * self.moved(edge, t, x, g, &|i| tolerance.allowed(x.get(i), x.get(i)))
    }

    /// How far the guard, `g` at `x`, moves with each coordinate i that is moved by `by(i)`, all
    /// together.
    pub(super) fn moved(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64, by: &dyn Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for k in self.automaton.about(edge).read(x.len()) {
            self.memory.stats.guards += 1;
            let nudged = x.with(|i| if i == k { x.get(i) + by(i) } else { x.get(i) });
            sum += finite((self.guard(edge, t, &nudged) - g).abs());
        }
        sum
    }

    /// How far apart times at the end `t` of an arc are: no nearer than those of its duration,
    /// about zero either.
    #[inline]
    pub(super) fn tick(&self, t: f64) -> f64 {
        resolution(t).max(f64::EPSILON * self.memory.last_duration)
    }

    /// How far rounding the time may move a guard that moves by itself: |∂g/∂t| ticks, measured
    /// over some of them.
    pub(super) fn time_rounding(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64) -> f64 {
        let change = |this: &mut Self, times: f64| {
            this.memory.stats.guards += 1;
            finite((this.guard(edge, t + times * FAR * this.tick(t), x) - g).abs())
        };
        let once = change(self, 1.0);
        if once == 0.0 { 0.0 } else { steady([once, change(self, 2.0)]) / FAR }
    }

    /// How far the guard bends along a dense output up to `limit`: by its powers from the second
    /// on, as the guard moves with the state at the start.
    #[cold]
    pub(super) fn bend(&mut self, edge: A::Edge, Step { now, c, scale, .. }: Step<'_, A::State>, limit: f64) -> f64 {
        self.memory.stats.guards += 2;
        let part = limit / scale;
        let bent = c[0].with(|i| {
            let higher = c.iter().skip(2).rev().fold(0.0, |sum, c| part * sum + c.get(i).abs());
            c[0].get(i) + TINY * part * part * higher
        });
        let guard = |x: &A::State| self.guard(edge, now.seconds(), x);
        finite((guard(&bent) - guard(&c[0])).abs() / TINY)
    }

    /// On the first step `c` of an arc: finds the edges that stay, for the flow runs along their
    /// walls, g = 0 and n·f + ∂g/∂t = 0 to rounding.
    #[inline]
    pub(super) fn find_staying(&mut self, mode: A::Mode, step: Step<'_, A::State>, slope: &A::State) {
        if let Some(Spent { edge, slack }) = self.memory.spent
            && self.memory.wall(edge).is_none()
            && self.has(mode, edge)
        {
            let (t, x, by) = (step.now.seconds(), &step.c[0], SMALL * step.size);
            self.memory.stats.guards += 2;
            let guard = |s: f64| self.guard(edge, t + s, &x.with(|i| x.get(i) + s * slope.get(i)));
            let moved = (guard(by) - guard(-by)).abs();
            // Of a crossing at once rounding has left nothing.
            let slack = if slack > 0.0 { slack } else { self.own_rounding(edge, t, x) };
            // A guard that moves by more than a million times what rounding leaves of it has left
            // its wall.
            if moved <= FAR * FAR * slack {
                self.memory.at_wall(edge, 0.0);
            }
        }
        if !self.memory.walls.is_empty() {
            self.sort_walls(mode, step);
        }
    }

    /// Whether an arc that leaves a wall by the flow, or stands on it, falls from it at once by a
    /// dense output whose slope at its start is not the flow's: the step is too long for a motion
    /// this slow, and would lose the state behind the wall.
    pub(super) fn contradicted(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        slope: &A::State,
        Step { now, c, size: h, .. }: Step<'_, A::State>,
    ) -> bool {
        let Some(c1) = c.get(1) else { return false };
        if (0..slope.len()).all(|i| c1.get(i) == h * slope.get(i)) {
            return false;
        }
        let t = now.seconds();
        for edge in self.automaton.edges(mode).iter() {
            if self.memory.spent_as(edge).is_none() && self.memory.wall(edge).is_none() {
                continue;
            }
            // What the guard rises by on the way of the flow and on that of the dense output; and
            // whether a fall on the latter is beyond rounding.
            let (rate, told, falls) = if self.automaton.about(edge).affine {
                self.memory.stats.guards += 3;
                let guard = |x: &A::State| self.automaton.guard(edge, t, x);
                let constant = guard(&slope.with(|_| 0.0));
                let told = less_constant(guard, constant, c1);
                let rate = h * less_constant(guard, constant, slope);
                (
                    rate,
                    told,
                    told < 0.0
                        && !is_rounding(
                            &guard,
                            constant,
                            (c1, self.automaton.about(edge).read(c1.len())),
                            &mut self.memory.stats.guards,
                        ),
                )
            } else {
                self.memory.stats.guards += 5;
                let s = SMALL * h;
                let rise = |rate: &A::State, by: f64| {
                    let at = |by: f64| x.with(|i| x.get(i) + by * rate.get(i));
                    self.guard(edge, t + s, &at(by)) - self.guard(edge, t - s, &at(-by))
                };
                let (rate, told) = (rise(slope, s), rise(c1, SMALL));
                let g = self.guard(edge, t, x);
                (rate, told, told < 0.0 && -told > ROUNDINGS * self.guard_rounding(edge, t, x, g, x))
            };
            if rate > 0.0 && told < 0.5 * rate || falls && rate > 0.5 * told {
                return true;
            }
        }
        false
    }

    #[cold]
    fn sort_walls(&mut self, mode: A::Mode, step: Step<'_, A::State>) {
        let Step { now, c, size, .. } = step;
        let (t, x) = (now.seconds(), &c[0]);
        self.sift(
            |memory| &mut memory.walls,
            |this, wall| {
                let edge = wall.edge;
                let by = SMALL * size;
                let rate = this.guard_rate(mode, edge, t, x, by);
                let rounding = this.rate_rounding(edge, t, x, by);
                // A guard that falls or rises as a power of time does so within a small part of
                // the step.
                let s = ROUGHLY * size;
                let soon = this.carried(mode, edge, step.time(s), &step.at(s), size);
                wall.stays = rate.abs() <= rounding && soon == Carried::Along;
                let spent = this.memory.spent_as(edge).is_some();
                let sinks = !spent && rate < -rounding;
                wall.rises = sinks && soon == Carried::Up && this.carried(mode, edge, t, x, size) == Carried::Along;
                wall.falls = sinks && !wall.rises && this.falls_at_once(mode, edge, (t, x), by, (rate, rounding));
                wall.stays || !spent
            },
        );
    }

    /// How far rounding the state and the time may move a guard.
    #[cold]
    fn own_rounding(&mut self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        self.memory.stats.guards += 1;
        let g = self.guard(edge, t, x);
        self.rounding(edge, t, x, g, x)
    }

    /// How far rounding may take the rate of a guard from differences over `by`.
    fn rate_rounding(&mut self, edge: A::Edge, t: f64, x: &A::State, by: f64) -> f64 {
        ROUNDINGS * self.own_rounding(edge, t, x) / by
    }

    /// Where the flow carries the guard of `edge` at `x`: the sign of n·f + ∂g/∂t, beyond what
    /// rounding and the error of a step of size `h` leave open.
    ///
    /// What the dense output does is not asked: along a surface that the flow keeps, it drifts.
    pub(super) fn carried(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, h: f64) -> Carried {
        let by = SMALL * h;
        let rate = self.guard_rate(mode, edge, t, x, by);
        let mut noise = self.rate_rounding(edge, t, x, by);
        for k in 0..x.len() {
            let size = self.size(x, k);
            let off = ROUNDINGS * self.options.tolerance.allowed(size, size);
            let nudged = x.with(|i| if i == k { x.get(i) + off } else { x.get(i) });
            noise += finite((self.guard_rate(mode, edge, t, &nudged, by) - rate).abs());
        }
        let later = t + ROUNDINGS * self.tick(t);
        noise += finite((self.guard_rate(mode, edge, later, x, by) - rate).abs());
        if rate > noise {
            Carried::Up
        } else if rate < -noise {
            Carried::Down
        } else {
            Carried::Along
        }
    }

    /// dg/dt along the flow at `x`, by differences over `by` and half of it to both sides, from
    /// which the square of the distance is taken out (L. F. Richardson, Phil. Trans. A 210 (1911)
    /// 307). Over a small part of a step, what four powers of it leave out is below every
    /// tolerance, and roundings are below that.
    fn guard_rate(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, by: f64) -> f64 {
        let slope = self.flow(mode, t, x);
        self.memory.stats.guards += 4;
        let guard = |s: f64| self.guard(edge, t + s, &x.with(|i| x.get(i) + s * slope.get(i)));
        let rate = |s: f64| (guard(s) - guard(-s)) / (2.0 * s);
        (4.0 * rate(0.5 * by) - rate(by)) / 3.0
    }

    /// Whether a guard that falls at this `rate` by differences over `by`, beyond their `rounding`,
    /// does so beyond that of the flow, and on the side ahead alone as well, where a guard may bend
    /// sharply.
    ///
    /// A rate that lasts is the same over half the way. What differences leave of a guard that
    /// rises as a higher power of time is a quarter then, or less.
    #[cold]
    fn falls_at_once(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        (t, x): (f64, &A::State),
        by: f64,
        (rate, rounding): (f64, f64),
    ) -> bool {
        let sizes = self.sizes(x);
        let mut off = (self.guard_rate(mode, edge, t + TINY * t.abs(), x, by) - rate).abs();
        for k in 0..x.len() {
            let nudged = x.with(|i| if i == k { x.get(i) + TINY * sizes.get(i) } else { x.get(i) });
            off += (self.guard_rate(mode, edge, t, &nudged, by) - rate).abs();
        }
        let noise = rounding + ROUNDINGS * f64::EPSILON / TINY * off;
        let slope = self.flow(mode, t, x);
        self.memory.stats.guards += 4;
        let guard = |s: f64| self.guard(edge, t + s, &x.with(|i| x.get(i) + s * slope.get(i)));
        let start = guard(0.0);
        let rate_over = |s: f64| (guard(s) - start) / s;
        let (far, near, nearest) = (rate_over(by), rate_over(0.5 * by), rate_over(0.25 * by));
        let ahead = [2.0 * near - far, 2.0 * nearest - near];
        let lasts = |[rate, sooner]: [f64; 2]| rate < -noise && sooner <= 0.5 * rate;
        lasts(ahead) && lasts([rate, self.guard_rate(mode, edge, t, x, 0.5 * by)])
    }

    /// Whether the guard of an edge that stays rises from its wall on a step up to its `limit`,
    /// surely beyond what rounding and the tolerance leave open: it is then armed like any other.
    #[cold]
    pub(super) fn rises_from<'c>(
        &mut self,
        Wall { edge, level, .. }: Wall<A::Edge>,
        step: Step<'c, A::State>,
        limit: f64,
        shared: &mut Shared<'c, A::State>,
    ) -> bool {
        self.memory.stats.guards += cross::SAMPLES as u64;
        let automaton = self.automaton;
        let values = shared.values(step, limit, self.smooth, |t, x| automaton.guard(edge, t, x) - level);
        let highest = sample_times(0.0, limit).into_iter().zip(values).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((s, above)) = highest.filter(|&(_, above)| above > 0.0) else { return false };
        let steps = self.memory.stats.steps - self.memory.steps_before + 1;
        above > SURELY * self.within_steps(edge, step.time(s), &step.at(s), above + level, steps)
    }

    /// Where on a step an edge leaves its wall, on which it stays or from which it falls: where the
    /// flow begins to carry its guard down, if it does so at the end of the search, after `limit`.
    /// From a spent root at the start of an arc it goes on falling.
    #[cold]
    pub(super) fn leaves(
        &mut self,
        mode: A::Mode,
        Wall { edge, falls, .. }: Wall<A::Edge>,
        step: Step<'_, A::State>,
        (limit, start): (f64, Start),
    ) -> Option<Crossing> {
        let at_start = Crossing::at_start(limit * AT_START);
        if falls {
            return Some(at_start);
        }
        if let Some(leap) = self.leap_off(edge, step, limit) {
            return Some(leap);
        }
        let mut sinks = |s: f64| self.sinks(mode, edge, step.time(s), &step.at(s), step.size);
        if !sinks(limit) {
            return None;
        }
        if sinks(0.0) {
            return (start == Start::Open).then_some(at_start);
        }
        let [on, _] = neighbours_of(step, limit, sinks);
        Some(Crossing::after(on))
    }

    /// Where on a step a guard leaps below zero that was exactly zero from its start on: its rate
    /// is none on either side.
    fn leap_off(&mut self, edge: A::Edge, step: Step<'_, A::State>, limit: f64) -> Option<Crossing> {
        let surely_below = |this: &mut Self, s: f64| {
            let g = this.on(edge, step, s);
            -g > this.within_tolerance(edge, step.time(s), &step.at(s), g)
        };
        if self.on(edge, step, 0.0) != 0.0 || !surely_below(self, limit) {
            return None;
        }
        let [on, off] = neighbours_of(step, limit, |s| self.on(edge, step, s) < 0.0);
        (on > AT_START * limit && surely_below(self, off)).then(|| Crossing::after(on))
    }

    /// Whether the flow carries the guard of `edge` down at `x`, on the way behind as well: ahead
    /// of a plateau's end a difference to both sides shows what comes.
    fn sinks(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, h: f64) -> bool {
        if self.carried(mode, edge, t, x, h) != Carried::Down {
            return false;
        }
        let (by, slope) = (SMALL * h, self.flow(mode, t, x));
        self.memory.stats.guards += 2;
        self.guard(edge, t - by, &x.with(|i| x.get(i) - by * slope.get(i))) != self.guard(edge, t, x)
    }

    /// After a step without a crossing to `x`: which edges stay, whose guards are zero to within
    /// the tolerance and are carried neither up nor down. One that is farther below has fallen by
    /// less than rounding showed: it is taken now, unless it falls on from a spent root.
    #[cold]
    pub(super) fn keep_staying(&mut self, mode: A::Mode, now: Time, x: &A::State, h: f64) {
        let t = now.seconds();
        self.sift(
            |memory| &mut memory.walls,
            |this, wall| {
                let edge = wall.edge;
                if !wall.stays {
                    return false;
                }
                let carried = this.carried(mode, edge, t, x, h);
                this.memory.stats.guards += 1;
                let g = this.guard(edge, t, x);
                if carried != Carried::Along {
                    this.held_down = this.held_down.filter(|_| carried == Carried::Down);
                    // Below zero by rounding already, it does not fall through zero any more.
                    wall.falls = carried == Carried::Down && g < 0.0 && this.memory.spent_as(edge).is_none();
                    return wall.falls;
                }
                let allowed = this.within_tolerance(edge, t, x, g);
                wall.stays = g.abs() <= allowed;
                wall.falls = g < -allowed && this.memory.spent_as(edge).is_none();
                wall.stays || wall.falls
            },
        );
    }
}

/// A change, or none where the guard is no number on the way.
fn finite(change: f64) -> f64 {
    if change.is_finite() { change } else { 0.0 }
}

/// The change over a way of a guard that changes over it, and over twice as long a way, by this
/// much: a leap on the first half is no part of it.
fn steady([once, twice]: [f64; 2]) -> f64 {
    once.min((twice - once).abs())
}

/// Neighbouring times of a step between which something turns that holds at its `limit`, and not
/// at its start.
fn neighbours_of<S: State>(step: Step<'_, S>, limit: f64, mut holds: impl FnMut(f64) -> bool) -> [f64; 2] {
    let (mut on, mut off) = (0.0, limit);
    while off - on > resolution(step.time(off)).max(off.next_up() - off) {
        let middle = on.midpoint(off);
        *(if holds(middle) { &mut off } else { &mut on }) = middle;
    }
    [on, off]
}

/// Where the flow carries a guard.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Carried {
    Up,
    Down,
    Along,
}
