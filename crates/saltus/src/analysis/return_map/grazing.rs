//! Which guard a periodic run touches.

use num_dual::Dual64;

use super::Section;
use super::continuation::{Continuation, Here};
use crate::analysis::linearize::{Lift, Linearize};
use crate::automaton::Automaton;
use crate::state::State;
use crate::step::Stepper;
use crate::trajectory::TrajectoryOf;

/// A guard is touched where it comes as near to zero, in units of its largest value on the arc, or
/// is crossed as slowly.
const TOUCH: f64 = 1e-3;

impl<A, X, F, const K: usize, M> Continuation<'_, '_, A, X, F, K, M>
where
    A: Linearize,
    X: Section<A, K>,
    F: Fn(f64) -> A,
    M: Stepper,
{
    /// The edge whose guard the run touches without crossing it, or crosses without speed.
    pub(super) fn touched(&self, here: &Here<A::Edge, K>) -> Option<A::Edge> {
        let automaton = (self.family)(here.point.parameter);
        let map = self.map.with(&automaton);
        let (mode, t, x) = map.place(&here.point.orbit.q);
        let period = here.point.orbit.period;
        let run = map.simulation.run(mode, x, t..t + period).ok()?;
        let mut near = touches(&automaton, &run.trajectory);
        near.extend(slow_crossings(&automaton, &run.trajectory, period));
        near.retain(|(_, size)| *size < TOUCH);
        near.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(edge, _)| edge)
    }
}

/// A guard along an arc.
struct Along<E> {
    edge: E,
    /// Times, and the guard at them.
    samples: Vec<(f64, f64)>,
    /// The guard's largest size.
    largest: f64,
}

/// The guards of arc `index` in turn.
fn guards<A: Automaton>(automaton: &A, run: &TrajectoryOf<A>, index: usize) -> Vec<Along<A::Edge>> {
    const SAMPLES: u32 = 64;
    let pieces: Vec<_> = run.pieces(index).collect();
    let along = |edge| {
        let samples: Vec<_> = pieces
            .iter()
            .flat_map(|piece| {
                (0..SAMPLES).map(move |k| {
                    let s = piece.span() * f64::from(k) / f64::from(SAMPLES);
                    let t = piece.start().seconds() + s;
                    (t, automaton.guard(edge, t, &piece.at(s)))
                })
            })
            .collect();
        let largest = samples.iter().fold(0.0, |most: f64, (_, guard)| most.max(guard.abs()));
        Along { edge, samples, largest }
    };
    run.arcs().get(index).map_or_else(Vec::new, |arc| automaton.edges(arc.mode()).iter().map(along).collect())
}

/// The least of each guard's minima inside an arc, where it turned round without being crossed.
fn touches<A: Automaton>(automaton: &A, run: &TrajectoryOf<A>) -> Vec<(A::Edge, f64)> {
    let mut all = Vec::new();
    for index in 0..run.arcs().len() {
        for Along { edge, samples, largest } in guards(automaton, run, index) {
            for three in samples.windows(3) {
                let [(before, a), (_, b), (after, c)] = three else { continue };
                if a >= b && b <= c && *b >= -TOUCH * largest {
                    let guard = |t| run.at(t).map_or(f64::NAN, |x| automaton.guard(edge, t, &x));
                    all.push((edge, least(guard, *before, *after).abs() / largest));
                }
            }
        }
    }
    all
}

/// The least value between two times, by golden section.
fn least(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    for _ in 0..40 {
        let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if f(left) < f(right) { high = right } else { low = left }
    }
    f(0.5 * (low + high))
}

/// The speed of each crossing, in units of the guard's largest value before it and of the period.
fn slow_crossings<A: Linearize>(automaton: &A, run: &TrajectoryOf<A>, period: f64) -> Vec<(A::Edge, f64)> {
    let p = automaton.parameters();
    let crossing = |(index, jump): (usize, &crate::jump::JumpOf<A>)| {
        let taken = jump.edge()?;
        let Along { largest, .. } = guards(automaton, run, index).into_iter().find(|along| along.edge == taken)?;
        let flow = automaton.flow(jump.from, jump.t(), &jump.before);
        let moving = jump.before.lift(|i| Dual64::new(jump.before.get(i), flow.get(i)));
        let fixed = p.lift(|i| Dual64::from(p.get(i)));
        let rate = automaton.guard_over(taken, Dual64::new(jump.t(), 1.0), moving, fixed).eps;
        Some((taken, rate.abs() * period / largest))
    };
    run.jumps().iter().enumerate().filter_map(crossing).collect()
}
