//! Edges whose guards are zero at one time, but for rounding: the first in the order listed is
//! taken.

use std::mem;

use crate::automaton::Automaton;
use crate::certainty::{FEW, MINUTE, SURELY};
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;

use super::{Advance, ArcEnd};

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Notes an `edge` that falls so shortly after a time `s`, at which one listed behind it does,
    /// that rounding may have put them in this order.
    #[inline]
    pub(super) fn may_be_tied(&mut self, edge: A::Edge, falls: f64, now: Time, s: f64) {
        if falls - s <= MINUTE * (now.seconds().abs() + s) {
            self.tied.push(edge);
        }
    }

    /// The end of an arc from `x`: of the edges that may be tied with the one that ends it, and are
    /// listed before it, by the first whose guard rounding alone keeps from zero there.
    ///
    /// Its guard was above zero as the arc began, and was not found to fall before. Of arcs that
    /// time does not resolve no order is better than another.
    #[cold]
    #[inline(never)]
    pub(super) fn in_order(&mut self, mode: A::Mode, x: &A::State, now: Time, end: ArcEnd<A>) -> ArcEnd<A> {
        let tied = mem::take(&mut self.tied);
        let ArcEnd::Crossing { edge: last, time, before } = end else { return end };
        let t = time.seconds();
        if time.since(now) <= SURELY * f64::EPSILON * t.abs() {
            return ArcEnd::Crossing { edge: last, time, before };
        }
        let sizes = self.summed_from(mode, (x, now), (&before, time));
        let listed = self.automaton.edges(mode);
        for edge in listed.iter().take_while(|&edge| edge != last).filter(|edge| tied.contains(edge)) {
            self.memory.stats.guards += 2;
            if self.memory.spent_as(edge).is_some() || self.guard(edge, now.seconds(), x) <= 0.0 {
                continue;
            }
            let g = self.guard(edge, t, &before);
            if self.is_zero(edge, (t, &before), g, &sizes).is_some() {
                (self.memory.slack, self.memory.leapt) = (FEW * g.abs(), false);
                return ArcEnd::Crossing { edge, time, before };
            }
        }
        ArcEnd::Crossing { edge: last, time, before }
    }

    /// The edge by which an arc from `x` ends where its span does, at `time` in the state `y`: the
    /// first whose guard rounding alone keeps from zero there, and falls on. A span's end, and a
    /// tick, come behind what crosses then.
    pub(super) fn due_at_end(
        &mut self,
        mode: A::Mode,
        (x, now): (&A::State, Time),
        (y, time): (&A::State, Time),
    ) -> Option<A::Edge> {
        let t = time.seconds();
        if time.since(now) <= SURELY * f64::EPSILON * t.abs() {
            return None;
        }
        let (nudged, mut sizes) = (self.nudged(y), None);
        for edge in self.automaton.edges(mode).iter() {
            if self.memory.spent_as(edge).is_some() {
                continue;
            }
            self.memory.stats.guards += 1;
            let g = self.guard(edge, t, y);
            if g < 0.0 || self.is_clear(edge, t, &nudged, g) || self.guard(edge, now.seconds(), x) <= 0.0 {
                continue;
            }
            let sizes = sizes.get_or_insert_with(|| self.summed_from(mode, (x, now), (y, time)));
            let Some(rounding) = self.is_zero(edge, (t, y), g, sizes) else { continue };
            if self.falls_on_from(mode, edge, t, y, (g, rounding)) {
                (self.memory.slack, self.memory.leapt) = (FEW * g, false);
                return Some(edge);
            }
        }
        None
    }

    /// What the coordinates at the end of an arc were summed up from, on it and before: on its
    /// pieces, or on the whole of a solution.
    fn summed_from(&self, mode: A::Mode, (x, now): (&A::State, Time), (y, time): (&A::State, Time)) -> A::State {
        match self.memory.reach.as_ref().filter(|reach| reach.len() == x.len()) {
            Some(reach) => reach.with(|i| reach.get(i).abs().max(y.get(i).abs()).max(self.size(x, i))),
            None => {
                let reach = self.reach_of(mode, [now.seconds(), time.seconds()], [x, y]);
                reach.with(|i| reach.get(i).max(self.size(x, i)))
            }
        }
    }

    /// The rounding of a guard `g`, where that alone keeps it from zero: by its slopes, and by what
    /// some roundings of its coordinates and of time move it by. Slopes are taken over more than
    /// that, beyond roots that are near each other.
    fn is_zero(&mut self, edge: A::Edge, (t, x): (f64, &A::State), g: f64, sizes: &A::State) -> Option<f64> {
        let rounding = self.rounding(edge, t, x, g, sizes);
        if g.abs() > FEW * rounding {
            return None;
        }
        let by = SURELY * f64::EPSILON;
        let later = self.guard(edge, t + SURELY * self.tick(t), x) - g;
        let moved = self.moved(edge, t, x, g, &|i| by * sizes.get(i)) + later.abs();
        self.memory.stats.guards += 1;
        (g.abs() <= moved).then_some(rounding)
    }
}
