//! What a mode's guards say as it is entered.

use std::cell::Cell;
use std::mem;

use crate::automaton::refusal::guard_undefined;
use crate::automaton::solution::Fall;
use crate::automaton::{Automaton, Entry};
use crate::certainty::{FAR, FEW, NOTHING, ROUGHLY, ROUNDINGS, SURELY, TINY};
use crate::cross::AT_START;
use crate::error::{Error, ErrorKind, Place};
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;

use super::memory::Left;
#[cfg(feature = "num-dual")]
use super::memory::Spent;
use super::shared::Step;
use super::{Advance, Wall};

/// A guard that falls this many times as fast as its own reset left it was driven on since.
/// Held by `retaken::falls_a_hair_apart_are_taken_once_each`.
const DRIVEN: f64 = 2.0;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Looks at every guard as the mode is entered; an edge to be taken at once is returned. A
    /// guard above zero that is the `only` one is left to `wall_near`.
    #[inline]
    pub(super) fn enter(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        now: Time,
        only: Option<A::Edge>,
    ) -> Result<Option<A::Edge>, Error> {
        let t = now.seconds();
        let mut nudged = None;
        self.memory.walls.clear();
        let edges = self.automaton.edges(mode);
        if let Some(flaw) = edges.flaw() {
            return Err(Error::new(ErrorKind::Model, Place::new(t, mode, None::<A::Edge>, x)).noting(Some(flaw)));
        }
        for edge in edges.iter() {
            self.memory.stats.guards += 1;
            let g = self.guard(edge, t, x);
            let spent = self.memory.spent_as(edge);
            if spent.is_some_and(|spent| g.abs() <= spent.slack) {
                if self.memory.idle.is_empty() || !self.is_driven(mode, edge, t, &x.clone(), g) {
                    continue;
                }
            } else if spent.is_none() && g > 0.0 {
                if only.is_none() {
                    let nudged = nudged.get_or_insert_with(|| self.nudged(x));
                    self.look_near(edge, t, x, nudged, g);
                }
                continue;
            }
            let x = &x.clone();
            match self.is_entered(mode, edge, t, x, g) {
                Ok(false) => {}
                due => {
                    let first = match self.first_of(mode, t, x) {
                        Some(first) => first,
                        None => due.map(|_| edge)?,
                    };
                    self.note_switch(first, x);
                    return Ok(Some(first));
                }
            }
        }
        Ok(None)
    }

    /// The run begins at `x` just after a jump by `edge`: where its guard is zero, but for
    /// rounding, that root is spent.
    #[cfg(feature = "num-dual")]
    pub(crate) fn begin_behind(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State) {
        if !self.has(mode, edge) {
            return;
        }
        self.memory.stats.guards += 1;
        let g = self.guard(edge, t, x);
        if g.abs() <= ROUNDINGS * self.still(edge, t, x, g) {
            (self.memory.spent, self.memory.last) = (Some(Spent { edge, slack: FEW * g.abs() }), Some(edge));
        }
    }

    /// Whether the state is at the wall of a mode's `only` edge as it is entered: counts where no
    /// formula gives the edge's fall.
    #[inline]
    pub(crate) fn wall_near(&mut self, only: A::Edge, x: &A::State, now: Time) {
        if self.memory.spent_as(only).is_none() {
            self.look_at_wall(only, x, now.seconds());
        }
    }

    #[inline(never)]
    fn look_at_wall(&mut self, only: A::Edge, x: &A::State, t: f64) {
        self.memory.stats.guards += 1;
        let g = self.guard(only, t, x);
        if g > 0.0 {
            let nudged = self.nudged(x);
            self.look_near(only, t, x, &nudged, g);
        }
    }

    /// The state with each coordinate moved by a millionth of what it is made of.
    #[inline]
    pub(super) fn nudged(&self, x: &A::State) -> A::State {
        x.with(|i| x.get(i) + TINY * weight(i) * self.size(x, i))
    }

    /// Whether a guard `g` above zero is clear of it: it moves by less between the state and the
    /// one that is `nudged`. If not, rounding alone may have left it.
    #[inline]
    fn look_near(&mut self, edge: A::Edge, t: f64, x: &A::State, nudged: &A::State, g: f64) {
        if !self.is_clear(edge, t, nudged, g) {
            self.find_wall(edge, t, x, g);
        }
    }

    /// Whether a guard `g` above zero moves by less than that, between a state and the one that is
    /// `nudged`.
    #[inline]
    pub(super) fn is_clear(&mut self, edge: A::Edge, t: f64, nudged: &A::State, g: f64) -> bool {
        self.memory.stats.guards += 1;
        g > (self.guard(edge, t + FAR * self.tick(t), nudged) - g).abs()
    }

    /// The state is at a wall if rounding alone may have left its guard `g`.
    #[cold]
    fn find_wall(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64) {
        let still = self.still(edge, t, x, g);
        if g <= ROUNDINGS * self.renewed(edge, t, x, g, still) {
            self.memory.at_wall(edge, g);
        }
    }

    /// Whether an edge whose guard is neither clear of zero nor spent is to be taken at once.
    #[inline(never)]
    fn is_entered(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, g: f64) -> Result<bool, Error> {
        if g.is_nan() {
            return Err(guard_undefined(self.automaton, mode, edge, t, x));
        }
        self.memory.slack = 0.0;
        // Within its slack a spent root is here only where it was driven on, and is then no longer
        // spent.
        let spent = self.memory.spent_as(edge).is_some_and(|spent| g.abs() > spent.slack);
        if !spent || g >= 0.0 {
            self.unspend(edge); // the reset led away from the wall
        }
        if g >= 0.0 {
            if !spent && g == 0.0 {
                self.memory.at_wall(edge, g); // one that falls at once is found like every other crossing
            } else if !spent {
                self.find_wall(edge, t, x, g);
            }
            return Ok(false);
        }
        let still = self.entry_error(edge, t, x, g);
        let still = self.renewed(edge, t, x, g, still);
        let Leaving { slope, straight } = self.leaving(mode, edge, t, x, g, still);
        // A flow that is no number here says nothing.
        let rounding = if slope.is_nan() { still } else { slope.abs() * self.tick(t) + still };
        if -g <= ROUNDINGS * rounding || -g <= FEW * self.scatter(edge, t, x) {
            let sure = slope.abs() * self.glance(mode, t, x) > SURELY * rounding;
            let leaves = sure && (slope < 0.0 || straight);
            if !spent && !leaves && matches!(self.automaton.falls(mode, edge, t, x), Fall::Unknown) {
                self.memory.at_wall(edge, g);
                return Ok(false);
            }
            // As far from zero as this it may be after its jump.
            self.memory.slack = FEW * -g;
            return Ok(!spent && slope < 0.0);
        }
        match self.automaton.about(edge).entry {
            // What fell as the run starts was before it, as a tick there is.
            _ if self.memory.last.is_some() && self.fell_at_stop(edge, x).is_some() => Ok(true),
            // One that leaps above zero within rounding is entered there.
            Entry::Refuse if !spent && self.shortly(mode, edge, t, x) > 0.0 => {
                self.unspend(edge);
                Ok(false)
            }
            Entry::Refuse => Err(Error::new(ErrorKind::Entry, Place::new(t, mode, Some(edge), x))),
            Entry::Fire => Ok(true),
            Entry::Wait => {
                self.unspend(edge);
                Ok(false)
            }
        }
    }

    /// How far a guard `g` at `x` may be off, `still` by the roundings of what the coordinates were
    /// before the last jump: where they decide whether it is zero, by what its reset makes of them.
    ///
    /// Moved by a part of what it was summed up from, a coordinate that the reset gives anew stays
    /// as it is, and one that it keeps moves with it.
    fn renewed(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64, still: f64) -> f64 {
        if self.memory.left.is_none() || g.abs() > ROUNDINGS * still {
            return still;
        }
        let (Some(last), Some(Left { from, before, to })) = (self.memory.last, self.memory.left.take()) else {
            return still;
        };
        let reset = |t: f64, y: &A::State| {
            let (mode, after) = self.automaton.reset(from, last, t, y).ok()?;
            (mode == to && after.len() == x.len() && after.is_finite()).then_some(after)
        };
        // Not `x` itself, which has moved on where a limit of the run ended the arc.
        let Some(after) = reset(t, &before) else { return still };
        let (moved, later) = (reset(t, &self.nudged(&before)), reset(t + FAR * self.tick(t), &before));
        let (Some(moved), Some(later)) = (moved, later) else { return still };
        let sizes = x.with(|i| {
            let here = after.get(i);
            let by = |other: &A::State, part: f64| (other.get(i) - here).abs() / part;
            here.abs().max(by(&moved, TINY * weight(i))).max(by(&later, FAR * f64::EPSILON))
        });
        if (0..x.len()).all(|i| 2.0 * sizes.get(i) >= self.size(x, i)) {
            return still;
        }
        self.memory.largest = Some(sizes);
        self.still(edge, t, x, g)
    }

    /// After the jump by `edge` from `before` in mode `from` to `after` in mode `to`: a guard that
    /// leapt there has no root to be spent, unless it leaps there still.
    #[inline]
    pub(crate) fn landed(
        &mut self,
        (from, edge, before): (A::Mode, A::Edge, &A::State),
        (to, t, after): (A::Mode, f64, &A::State),
    ) {
        self.memory.left = self.memory.shrinks(after).then(|| Left { from, before: before.clone(), to });
        if mem::take(&mut self.memory.leapt) {
            let (before, after) = (before.clone(), after.clone()); // else both would be kept in memory
            self.has_leapt(edge, &before, (to, t, &after));
        }
    }

    #[cold]
    #[inline(never)]
    fn has_leapt(&mut self, edge: A::Edge, before: &A::State, (to, t, after): (A::Mode, f64, &A::State)) {
        if !self.has(to, edge) || !is_moved(before, after) {
            return;
        }
        self.memory.stats.guards += 1;
        let g = self.guard(edge, t, after);
        if g > 0.0 {
            let still = self.still(edge, t, after, g);
            let slope = self.guard_slope(to, edge, t, after, g, still);
            if g > SURELY * (slope.abs() * self.tick(t) + still) && self.shortly(to, edge, t, after) >= 0.0 {
                self.unspend(edge);
            }
        }
    }

    /// The guard of `edge` on the way from `x` beyond the rounding of time and state.
    fn shortly(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        let slope = self.flow(mode, t, x);
        let by = FAR * self.tick(t);
        let ahead = x.with(|i| {
            let (rate, rounding) = (slope.get(i), FAR * f64::EPSILON * self.size(x, i));
            if rate == 0.0 { x.get(i) } else { x.get(i) + (by * rate.abs() + rounding).copysign(rate) }
        });
        self.memory.stats.guards += 1;
        self.guard(edge, t + by, &ahead)
    }

    /// Whether a guard that went on falling from its spent root, by no more than the rounding of
    /// what it falls by now, was driven on by a jump since: a ball that is squeezed between others
    /// and the floor until its rebounds are rounding, and struck again.
    #[cold]
    fn is_driven(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, g: f64) -> bool {
        let then = self.memory.idle.iter().find(|(spent, _)| spent.edge == edge).map(|&(_, slope)| slope);
        then.is_some_and(|then| self.guard_slope(mode, edge, t, x, g, 0.0) < DRIVEN * then)
    }

    /// One of the edges taken in turn at the start of a step that leads out of the mode by it, up
    /// to `reached`: so small have their jumps become that none drives its guard up beyond
    /// rounding, and as far as numbers resolve they have accumulated.
    #[cold]
    pub(super) fn chatters(&mut self, mode: A::Mode, step: Step<'_, A::State>, reached: f64) -> Option<A::Edge> {
        let (time, x) = (step.now.after(reached), step.at(reached));
        let left = self.automaton.edges(mode).iter().find(|&edge| {
            self.memory.spent_as(edge).is_some()
                && self.automaton.about(edge).entry != Entry::Wait
                && self.clear_of_zero(edge, time, &x) < 0.0
        });
        self.memory.spurious = left.is_some();
        left
    }

    /// Of the edges listed before one that is due at once, or refused, the first whose guard is
    /// zero but for rounding and falls: in the order listed it is taken before.
    #[cold]
    pub(super) fn first_of(&mut self, mode: A::Mode, t: f64, x: &A::State) -> Option<A::Edge> {
        for k in 0..self.memory.walls.len() {
            let Wall { edge, level, .. } = self.memory.walls[k];
            let still = self.still(edge, t, x, level);
            if self.falls_on_from(mode, edge, t, x, (level, still)) {
                self.memory.slack = FEW * level.abs();
                return Some(edge);
            }
        }
        None
    }

    /// Whether a guard that is zero but for `rounding`, which leaves `g` of it, falls along the
    /// flow by more than that.
    pub(super) fn falls_on_from(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        t: f64,
        x: &A::State,
        (g, rounding): (f64, f64),
    ) -> bool {
        let slope = self.guard_slope(mode, edge, t, x, g, rounding);
        let longest = self.glance(mode, t, x).max(FAR * self.tick(t));
        slope < 0.0 && -slope * longest > ROUNDINGS * rounding
    }

    /// The longest time over which a guard's slope is looked at: a part of the last arc's duration;
    /// where there was none, of a second, or of the time in which a coordinate changes by its own
    /// size, if all take longer.
    fn glance(&mut self, mode: A::Mode, t: f64, x: &A::State) -> f64 {
        if self.memory.last_duration > 0.0 {
            return TINY * self.memory.last_duration;
        }
        let slope = self.flow(mode, t, x);
        let times = (0..x.len()).filter(|&i| slope.get(i) != 0.0).map(|i| (x.get(i) / slope.get(i)).abs());
        let least = times.fold(f64::INFINITY, f64::min);
        TINY * if least < f64::INFINITY { least.max(1.0) } else { 1.0 }
    }

    /// dg/dt along the flow.
    pub(super) fn guard_slope(
        &mut self,
        mode: A::Mode,
        edge: A::Edge,
        t: f64,
        x: &A::State,
        g: f64,
        rounding: f64,
    ) -> f64 {
        self.leaving(mode, edge, t, x, g, rounding).slope
    }

    /// dg/dt along the flow, by a difference over a time short against the last arc; where dg/dt is
    /// zero, its sign is that of d²g/dt².
    ///
    /// The shortest time is taken over which the change of the guard doubles (or, where it never
    /// does, quadruples) with time twice in a row: longer than rounding, shorter than the way to
    /// the guard's next root. A change by no more than `rounding` is none. That of a guard promised
    /// affine doubles over every time along a line: the longest one has the least rounding.
    fn leaving(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, g: f64, rounding: f64) -> Leaving {
        let spacing = self.tick(t);
        // An arc may be as short as rounding, over which nothing changes.
        let longest = self.glance(mode, t, x).max(FAR * spacing);
        let slope = self.flow(mode, t, x);
        if self.automaton.about(edge).affine && self.smooth.within(t + longest) == t + longest {
            self.memory.stats.guards += 1;
            let ahead = x.with(|i| x.get(i) + longest * slope.get(i));
            let change = self.automaton.guard(edge, t + longest, &ahead) - g;
            if change.abs() > ROUNDINGS * rounding {
                return Leaving { slope: change / longest, straight: true };
            }
        }
        let middle = self.flow(mode, t + 0.5 * longest, &x.with(|i| x.get(i) + 0.5 * longest * slope.get(i)));
        let (automaton, smooth, guards) = (self.automaton, self.smooth, Cell::from_mut(&mut self.memory.stats.guards));
        let change = |h: f64, bends: f64| {
            guards.set(guards.get() + 1);
            let bend = bends * h / longest;
            let ahead = x.with(|i| x.get(i) + h * (slope.get(i) + bend * (middle.get(i) - slope.get(i))));
            automaton.guard(edge, smooth.within(t + h), &ahead) - g
        };
        // A guard that moves changes by no less than some roundings of time.
        guards.set(guards.get() + 1);
        let tick = if automaton.guard(edge, smooth.within(t + longest), x) == g { 0.0 } else { spacing };
        let shortest = (AT_START * longest).max(FAR * tick).min(longest);
        for (bends, by) in [(0.0, 2.0), (1.0, 4.0)] {
            let mut h = shortest;
            while h < longest && h > 0.0 {
                let (far, half, quarter) = (change(h, bends), change(0.5 * h, bends), change(0.25 * h, bends));
                let doubles =
                    (far - by * half).abs() < ROUGHLY * far.abs() && (half - by * quarter).abs() < ROUGHLY * half.abs();
                if doubles && far.abs() > ROUNDINGS * rounding {
                    return Leaving { slope: far / h, straight: bends == 0.0 };
                }
                h /= ROUGHLY;
            }
        }
        Leaving { slope: change(longest, 1.0) / longest.max(f64::MIN_POSITIVE), straight: false }
    }
}

/// How a guard goes on from where a mode is entered.
struct Leaving {
    /// dg/dt along the flow.
    slope: f64,
    /// Whether the guard changes in proportion to time.
    straight: bool,
}

/// Whether a coordinate differs by more than roundings.
fn is_moved<S: State>(x: &S, y: &S) -> bool {
    x.len() != y.len() || (0..x.len()).any(|i| (x.get(i) - y.get(i)).abs() > NOTHING * x.get(i).abs())
}

/// How far coordinate `i` is nudged beside the others, from 1 to 2: no two alike, so that a guard
/// of their difference is nudged as well.
#[inline]
pub(super) fn weight(i: usize) -> f64 {
    // What multiples of the golden ratio have behind the point, which lies as far apart as it can.
    let turns = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    f64::from_bits(1.0_f64.to_bits() | turns >> 12)
}
