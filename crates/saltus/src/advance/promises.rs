//! Whether guards that are promised affine are, exact solutions those of their flows, and patterns
//! those of their Jacobians.

use crate::automaton::Automaton;
use crate::automaton::solution::Solution;
use crate::certainty::{FAR, FEW, ROUGHLY, SMALL, SURELY, TINY};
use crate::error::{Error, ErrorKind, Place};
use crate::sparsity::{Sparsity, listed};
use crate::state::State;
use crate::step::Stepper;
use crate::time::Time;

use super::affine::less_constant;
use super::enter::weight;
use super::{Advance, ArcEnd};

/// The first arcs of a run are all looked at: as many as modes follow each other in a cycle of most
/// models. Later ones at ever longer intervals.
const FIRST: u64 = 8;

/// The parts of the states at both ends of an arc whose sum is looked at: neither on the line
/// through the ends nor on that through zero.
const PARTS: [f64; 2] = [0.37, 0.41];

/// Whether the promises of a run's `arc`, counted from 1, are looked at.
fn is_due(arc: u64) -> bool {
    arc <= FIRST || arc.is_power_of_two()
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Looks, now and then, at the promises of the guards of `mode` on the arc from `x` to its
    /// `end`. No part of the search, and so not counted.
    #[inline]
    pub(super) fn promises(&mut self, mode: A::Mode, x: &A::State, began: Time, end: &ArcEnd<A>) -> Result<(), Error> {
        self.memory.arcs += 1;
        if !is_due(self.memory.arcs) {
            return Ok(());
        }
        // Copies: what others refer to is kept in memory, and waited for.
        let (ArcEnd::Crossing { time, before: y, .. } | ArcEnd::Stop { time, state: y, .. }) = end;
        let (x, y) = (x.clone(), y.clone());
        self.promised(mode, [began.seconds(), time.seconds()], [&x, &y])
    }

    #[cold]
    #[inline(never)]
    fn promised(&mut self, mode: A::Mode, times: [f64; 2], ends: [&A::State; 2]) -> Result<(), Error> {
        let ([began, _], [x, _]) = (times, ends);
        if !(self.options.stepped || self.solves(mode, began, x) && self.goes_on(mode, times, x)) {
            return Err(Error::new(ErrorKind::Series, Place::new(began, mode, None::<A::Edge>, x)));
        }
        self.hold(mode, times, ends)
    }

    /// Whether the exact solution from `x` starts there, and with the slope of the flow.
    fn solves(&self, mode: A::Mode, t: f64, x: &A::State) -> bool {
        let flow = self.automaton.flow(mode, self.smooth.within(t), x);
        let is = |one: &A::State, other: &A::State| {
            let most = (0..other.len()).map(|i| other.get(i).abs()).fold(0.0, f64::max);
            !other.is_finite() || (0..other.len()).all(|i| (one.get(i) - other.get(i)).abs() <= TINY * most)
        };
        match self.automaton.solution(mode, t, x) {
            Solution::Polynomial(solution) => {
                let c = solution.coefficients();
                is(&c[0], x) && c.get(1).map_or(is(&flow, &x.with(|_| 0.0)), |slope| is(slope, &flow))
            }
            Solution::Formula(formula) => is(&formula(self.automaton, mode, t, x, 0.0), x),
            _ => true,
        }
    }

    /// Whether the exact solution from `x` goes on with the slope of the flow: within the arc, for
    /// where it ends the flow may switch.
    fn goes_on(&self, mode: A::Mode, [began, ended]: [f64; 2], x: &A::State) -> bool {
        let [part, _] = PARTS;
        let (s, solution) = (part * (ended - began), self.automaton.solution(mode, began, x));
        let Some(y) = solution.at(self.automaton, mode, began, x, s).filter(|_| s > 0.0) else { return true };
        let flow = |t: f64, x: &A::State| self.automaton.flow(mode, self.smooth.within(t), x);
        let (first, slope) = (flow(began, x), flow(began + s, &y));
        // What a coordinate moves by on the arc, for one that turns has no slope of its own.
        let size = |i: usize| first.get(i).abs().max(slope.get(i).abs()).max((y.get(i) - x.get(i)).abs() / s);
        let differs = |one: &A::State, most: &dyn Fn(usize) -> f64| {
            (0..y.len()).any(|i| (one.get(i) - slope.get(i)).abs() > most(i))
        };
        // So short a time that the flow hardly changes.
        let mut h = SMALL * s;
        let turns =
            |h: f64| differs(&flow(began + s + h, &y.with(|i| y.get(i) + h * slope.get(i))), &|i| SMALL * size(i));
        while h > FAR * f64::EPSILON * s && turns(h) {
            h *= ROUGHLY;
        }
        let [before, after] = [s - h, s + h].map(|s| solution.at(self.automaton, mode, began, x, s));
        let (Some(before), Some(after)) = (before, after) else { return true };
        let across = y.with(|i| (after.get(i) - before.get(i)) / (2.0 * h));
        // Numbers below the smallest normal one are rounded as that is.
        let made_of = |i: usize| x.get(i).abs() + y.get(i).abs() + s * size(i) + f64::MIN_POSITIVE;
        let rounding = |i: usize| FEW * f64::EPSILON * made_of(i) / h;
        let resolved = (0..y.len()).all(|i| rounding(i) <= SMALL * size(i) || size(i) == 0.0);
        !(resolved
            && across.is_finite()
            && slope.is_finite()
            && differs(&across, &|i| FEW * SMALL * size(i) + rounding(i)))
    }

    /// The pattern of the Jacobian of `mode` at `x`, where it has as many coordinates as the state
    /// and, on the arcs whose promises are looked at, leaves out none that the flow reads.
    pub(super) fn fitting(
        &self,
        sparsity: Sparsity,
        mode: A::Mode,
        now: Time,
        x: &A::State,
    ) -> Result<Sparsity, Error> {
        let (t, looked_at) = (now.seconds(), is_due(self.memory.arcs + 1));
        let flow = |list: &[f64]| self.automaton.flow(mode, self.smooth.within(t), &x.with(|i| list[i]));
        let flaw = sparsity.flaw(&listed(x), looked_at.then_some(&mut |list| listed(&flow(list))), &|i| x.name(i));
        let Some(flaw) = flaw else { return Ok(sparsity) };
        let place = Place::new(t, mode, None::<A::Edge>, x);
        Err(Error::new(ErrorKind::Sparsity, place).noting(Some(flaw)))
    }

    fn hold(&mut self, mode: A::Mode, times: [f64; 2], ends: [&A::State; 2]) -> Result<(), Error> {
        let [x, y] = ends;
        let [a, b] = PARTS;
        let (zero, sum) = (y.with(|_| 0.0), y.with(|i| a * x.get(i) + b * y.get(i)));
        if let Some((edge, flaw)) = self.reads_more(mode, times[0], x, &sum) {
            return Err(Error::new(ErrorKind::Promise, Place::new(times[0], mode, Some(edge), x)).noting(Some(flaw)));
        }
        let reach = self.reach_of(mode, times, ends);
        for edge in self.automaton.edges(mode).iter() {
            if !self.automaton.about(edge).affine {
                continue;
            }
            let flaw = self.broken(edge, times, ends, (&zero, &sum));
            if let Some(flaw) = flaw.or_else(|| self.bends_far_out(edge, times[1], (&zero, &reach))) {
                let place = Place::new(times[0], mode, Some(edge), ends[0]);
                return Err(Error::new(ErrorKind::Promise, place).noting(Some(format!(
                    "affine and {flaw}: it must be a sum of coordinates times constants, and a constant"
                ))));
            }
        }
        Ok(())
    }

    /// Of the edges of the mode the one whose turn it is, and why it does not read what it is
    /// promised to, if it does not: with the coordinates that it does not read of another state.
    fn reads_more(&self, mode: A::Mode, t: f64, x: &A::State, other: &A::State) -> Option<(A::Edge, String)> {
        let edges = self.automaton.edges(mode);
        let count = edges.len() as u64;
        let edge = edges.iter().nth(usize::try_from(self.memory.arcs.checked_rem(count)?).ok()?)?;
        let (first, end) = self.automaton.about(edge).reads?;
        let n = x.len();
        if first >= end || end > n {
            return Some((edge, format!("to read the coordinates {first}..{end}, and there are {n}, counted from 0")));
        }
        let mixed = x.with(|i| if (first..end).contains(&i) { x.get(i) } else { other.get(i) });
        let (here, there) = (self.guard(edge, t, x), self.guard(edge, t, &mixed));
        let flaw = format!("to read the coordinates {first}..{end} alone, and changes with another");
        (here.is_finite() && here != there).then_some((edge, flaw))
    }

    /// A state of what each coordinate is or changes by on an arc, no two alike.
    pub(super) fn reach_of(&self, mode: A::Mode, [began, time]: [f64; 2], [x, y]: [&A::State; 2]) -> A::State {
        let flow = self.automaton.flow(mode, self.smooth.within(began), x);
        let by = |i: usize| if i < flow.len() { ((time - began) * flow.get(i)).abs() } else { 0.0 };
        let larger = |size: f64, other: f64| if other.is_finite() { size.max(other) } else { size };
        x.with(|i| weight(i) * larger(larger(x.get(i).abs(), y.get(i).abs()), by(i)))
    }

    /// Whether a guard a·x + b, of this arc's states, is another where the search asks it for what
    /// a state adds to it: of the state a power of two larger, so that its constant costs no
    /// digits (`less_constant`). Both ways from zero, for a guard may be cut off on one.
    fn bends_far_out(
        &mut self,
        edge: A::Edge,
        time: f64,
        (zero, reach): (&A::State, &A::State),
    ) -> Option<&'static str> {
        let constant = self.guard(edge, time, zero);
        for way in [1.0, -1.0] {
            let x = reach.with(|i| way * reach.get(i));
            let here = self.guard(edge, time, &x);
            let far = less_constant(|x: &A::State| self.guard(edge, time, x), constant, &x);
            let off = far - (here - constant);
            if off.abs() > TINY * (constant.abs() + here.abs())
                && off.abs() > SURELY * self.guard_rounding(edge, time, &x, here, &x)
            {
                return Some("bends far outside the states of the run, where it is asked as well");
            }
        }
        None
    }

    /// Why the guard is not a·x + b, if it is not at two states, at the state `zero` and at the
    /// `sum` of parts of the two, and at two times.
    fn broken(
        &mut self,
        edge: A::Edge,
        [before, time]: [f64; 2],
        [x, y]: [&A::State; 2],
        (zero, sum): (&A::State, &A::State),
    ) -> Option<&'static str> {
        let g = |time: f64, x: &A::State| self.guard(edge, time, x);
        let zero = g(time, zero);
        let (here, there) = (g(time, x), g(time, y));
        if (g(before, x) - here).abs() > 0.0 {
            return Some("changes with time while the state stands still");
        }
        let [a, b] = PARTS;
        let off = g(time, sum) - (zero + a * (here - zero) + b * (there - zero));
        // More than the digits that guards lose to cancellation, less than what bends.
        if off.abs() <= TINY * (zero.abs() + here.abs() + there.abs()) {
            return None;
        }
        let rounding = self.guard_rounding(edge, time, x, here, x) + self.guard_rounding(edge, time, y, there, y);
        (off.abs() > SURELY * rounding).then_some("bends")
    }
}
