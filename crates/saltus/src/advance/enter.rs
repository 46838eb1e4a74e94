//! What a mode's guards say as it is entered.

use crate::automaton::{Automaton, Entry};
use crate::error::{Error, ErrorKind, Place};
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;

use super::Advance;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Looks at every guard as the mode is entered; an edge to be taken at once is returned.
    #[inline]
    pub(super) fn enter(&mut self, mode: A::Mode, x: &A::State, now: Time) -> Result<Option<A::Edge>, Error> {
        let t = now.seconds();
        let mut zero = None;
        for edge in self.automaton.edges(mode).iter() {
            self.memory.stats.guards += 1;
            let g = self.automaton.guard(edge, t, x);
            if g.is_nan() {
                return Err(Error::new(ErrorKind::Guard, Place::new(t, mode, Some(edge), x)));
            }
            let spent = self.memory.spent_as(edge);
            if spent.is_some_and(|spent| g.abs() <= spent.slack) {
                continue;
            }
            if g >= 0.0 {
                if spent.is_some() {
                    self.memory.unspend(edge); // the reset led away from the wall
                }
                if g == 0.0 && spent.is_none() {
                    zero = zero.or(Some(edge));
                }
                continue; // a zero that falls at once is found like every other crossing
            }
            let slope = self.guard_slope(mode, edge, t, x, g);
            let on_wall =
                -g <= 4.0 * (slope.abs() * (t.abs().next_up() - t.abs()) + self.guard_rounding(edge, t, x, g, 1.0));
            if on_wall {
                if spent.is_none() && slope < 0.0 {
                    return Ok(Some(self.first_of(mode, t, x, zero, edge)));
                }
                continue;
            }
            match self.automaton.entry(edge) {
                Entry::Refuse => return Err(Error::new(ErrorKind::Entry, Place::new(t, mode, Some(edge), x))),
                Entry::Fire => return Ok(Some(self.first_of(mode, t, x, zero, edge))),
                Entry::Wait => self.memory.unspend(edge),
            }
        }
        Ok(None)
    }

    /// Of an edge to be taken at once and one listed before it whose guard is zero, the latter if its guard falls.
    fn first_of(&mut self, mode: A::Mode, t: f64, x: &A::State, zero: Option<A::Edge>, edge: A::Edge) -> A::Edge {
        zero.filter(|&zero| self.guard_slope(mode, zero, t, x, 0.0) < 0.0).unwrap_or(edge)
    }

    /// How far rounding each coordinate, taken for no smaller than `least`, may move the guard: Σ |∂g/∂xᵢ| max(|xᵢ|, `least`) units in the last place.
    pub(super) fn guard_rounding(&mut self, edge: A::Edge, t: f64, x: &A::State, g: f64, least: f64) -> f64 {
        const NUDGE: f64 = 1.0 / (1 << 20) as f64;
        let mut sum = 0.0;
        for k in 0..x.len() {
            self.memory.stats.guards += 1;
            let nudged = x.with(|i| if i == k { x.get(i) + NUDGE * x.get(i).abs().max(least) } else { x.get(i) });
            let change = (self.automaton.guard(edge, t, &nudged) - g).abs();
            sum += if change.is_finite() { change } else { 0.0 };
        }
        sum * (f64::EPSILON / NUDGE)
    }

    /// dg/dt along the flow, by a difference over a time short against the last arc; where dg/dt is zero, its sign is that of d²g/dt².
    ///
    /// The shortest time is taken over which the change of the guard doubles (or quadruples) with time twice in a row: longer than
    /// rounding, shorter than the way to the guard's next root.
    pub(super) fn guard_slope(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, g: f64) -> f64 {
        let longest = if self.memory.last_duration > 0.0 { self.memory.last_duration * 1e-6 } else { 1e-6 };
        let slope = self.flow(mode, t, x);
        let middle = self.flow(mode, t + 0.5 * longest, &x.with(|i| x.get(i) + 0.5 * longest * slope.get(i)));
        let mut h = longest / (1_u64 << 60) as f64;
        loop {
            let mut change = |h: f64| {
                self.memory.stats.guards += 1;
                let bend = h / longest;
                let ahead = x.with(|i| x.get(i) + h * (slope.get(i) + bend * (middle.get(i) - slope.get(i))));
                self.automaton.guard(edge, t + h, &ahead) - g
            };
            let far = change(h);
            if h >= longest || h == 0.0 {
                return far / h.max(f64::MIN_POSITIVE);
            }
            let (half, quarter) = (change(0.5 * h), change(0.25 * h));
            let grows =
                |by: f64| (far - by * half).abs() < 0.1 * far.abs() && (half - by * quarter).abs() < 0.1 * half.abs();
            if grows(2.0) || grows(4.0) {
                return far / h;
            }
            h = (8.0 * h).min(longest);
        }
    }
}
