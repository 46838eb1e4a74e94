//! What is uncertain of a guard at a point of an arc, and what the guard does first from there.

use crate::automaton::Automaton;
use crate::cross::{BEYOND_NOISE, Move, first_move};
use crate::error::{Error, ErrorKind, Place};
use crate::state::State;
use crate::step::Stepper;
use crate::time::resolution;

use super::Advance;

/// Coordinates are moved by so many of their roundings to find how far rounding moves the guard:
/// more than its own roundings, and little enough for it to be straight over them.
const NUDGE: f64 = (1_u64 << 20) as f64;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// What each coordinate of `x` was summed up from: its rounding is a part of that, however little
    /// is left of it. A ball that lands has fallen from its apex.
    fn sizes(&mut self, x: &A::State) -> A::State {
        let Some(last) = self.memory.last_arc.filter(|last| last.state.len() == x.len()) else {
            let largest = (0..x.len()).map(|i| x.get(i).abs()).fold(0.0, f64::max);
            return x.with(|_| largest);
        };
        let slope = self.flow(last.mode, last.t, &last.state);
        x.with(|i| x.get(i).abs().max(last.state.get(i).abs()).max((slope.get(i) * last.duration).abs()))
    }

    /// By how much the guard may be off at `x`: Σ |∂g/∂xᵢ| ε sizeᵢ + |∂g/∂t| times the spacing of time.
    fn noise(&mut self, edge: A::Edge, t: f64, x: &A::State, sizes: &A::State) -> f64 {
        self.noise_of_state(edge, t, x, sizes) + self.noise_of_time(edge, t, x)
    }

    /// The part of coordinates of these `sizes`.
    pub(super) fn noise_of_state(&mut self, edge: A::Edge, t: f64, x: &A::State, sizes: &A::State) -> f64 {
        let g = self.guard_at(edge, t, x);
        self.memory.stats.guards += x.len() as u64;
        let mut sum = 0.0;
        for k in 0..x.len() {
            let by = NUDGE * f64::EPSILON * sizes.get(k);
            let nudged = x.with(|i| if i == k { x.get(i) + by } else { x.get(i) });
            sum += finite(self.automaton.guard(edge, t, &nudged) - g) / NUDGE;
        }
        sum
    }

    /// The part of time.
    pub(super) fn noise_of_time(&mut self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        let later = NUDGE.sqrt();
        let g = self.guard_at(edge, t, x);
        finite(self.guard_at(edge, t + later * resolution(t), x) - g) / later
    }

    /// By how much a guard may be below zero without being outside: as if every coordinate had been
    /// summed up from the largest one. What earlier arcs left of a coordinate is not remembered.
    pub(super) fn within(&mut self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        let all = |x: &A::State| (0..x.len()).map(|i| x.get(i).abs()).fold(0.0, f64::max);
        let largest = self.memory.last_arc.map_or(0.0, |last| all(&last.state)).max(all(x));
        BEYOND_NOISE * self.noise(edge, t, x, &x.with(|_| largest))
    }

    /// By how much a guard is zero for all that is certain of it at `x`.
    pub(super) fn zero(&mut self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        let sizes = self.sizes(x);
        BEYOND_NOISE * self.noise(edge, t, x, &sizes)
    }

    /// What the guard of `edge` does first on the way from `x`, where it is zero.
    #[cold]
    #[inline(never)]
    pub(super) fn first_move(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State) -> Result<Move, Error> {
        let sizes = self.sizes(x);
        let noise = self.noise(edge, t, x, &sizes);
        let longest = self.outlook(mode, t, x);
        let this = std::cell::RefCell::new(&mut *self);
        let changes = |x: &A::State, stretch: f64| {
            let this = &mut *this.borrow_mut();
            let start = this.guard_at(edge, t, x);
            [0.25, 0.5, 0.75, 1.0].map(|part| {
                let s = part * stretch;
                let ahead = this.state_after(mode, t, x, s);
                this.guard_at(edge, t + s, &ahead) - start
            })
        };
        let doubt = |weights: &[f64; 4], stretch: f64| {
            let sum = |x: &A::State| weights.iter().zip(changes(x, stretch)).map(|(w, c)| w * c).sum::<f64>();
            let here = sum(x);
            let mut doubt = 0.0;
            for k in 0..x.len() {
                let by = NUDGE * f64::EPSILON * sizes.get(k);
                doubt += finite(sum(&x.with(|i| if i == k { x.get(i) + by } else { x.get(i) })) - here) / NUDGE;
            }
            doubt
        };
        let found: Result<Move, ()> =
            first_move(longest, |stretch| Ok(changes(x, stretch)), |_| noise, doubt);
        found.map_err(|()| Error::new(ErrorKind::Guard, Place::new(t, mode, Some(edge), x)))
    }

    fn guard_at(&mut self, edge: A::Edge, t: f64, x: &A::State) -> f64 {
        self.memory.stats.guards += 1;
        self.automaton.guard(edge, t, x)
    }

    /// How far ahead the first move is looked for at most: as far as the flow is resolved at a step.
    fn outlook(&mut self, mode: A::Mode, t: f64, x: &A::State) -> f64 {
        let step = self.memory.step.unwrap_or(0.0);
        let longest = self.memory.last_duration.max(self.memory.longest_duration).max(step);
        if longest > 0.0 {
            return longest;
        }
        let slope = self.flow(mode, t, x);
        let norm = |x: &A::State| (0..x.len()).map(|i| x.get(i).abs()).sum::<f64>();
        let natural = norm(x) / norm(&slope);
        if natural > 0.0 && natural.is_finite() { natural } else { 1.0 }
    }

    /// The state a time `s` after `x`, by the model's own solution or by one classical Runge–Kutta step.
    fn state_after(&mut self, mode: A::Mode, t: f64, x: &A::State, s: f64) -> A::State {
        if !self.options.stepped {
            if let Some(solution) = self.automaton.exact(mode, t, x) {
                return solution.at(s);
            }
            if let Some(state) = self.automaton.flown(mode, t, x, s) {
                return state;
            }
        }
        let along = |slope: &A::State, s: f64| x.with(|i| x.get(i) + s * slope.get(i));
        let k1 = self.flow(mode, t, x);
        let k2 = self.flow(mode, t + 0.5 * s, &along(&k1, 0.5 * s));
        let k3 = self.flow(mode, t + 0.5 * s, &along(&k2, 0.5 * s));
        let k4 = self.flow(mode, t + s, &along(&k3, s));
        x.with(|i| x.get(i) + s / 6.0 * (k1.get(i) + 2.0 * (k2.get(i) + k3.get(i)) + k4.get(i)))
    }
}

/// The size of a change, or none if it is no number.
fn finite(change: f64) -> f64 {
    if change.is_finite() { change.abs() } else { 0.0 }
}
