//! Cases on which event-driven integrators are known to fail, each with its right answer.
//!
//! The references are closed forms; unless a test says otherwise g = 9.8 m/s².

#![allow(clippy::excessive_precision)] // references keep all their digits

mod at_once;
mod floor;
mod missed;
mod order;
mod other;
mod twice;

use std::ops::Range;

use saltus::nalgebra::{Vector2, vector};
use saltus::{Edge, Hybrid, Link, Polynomial, Run, RunOf, Simulation, State};
use saltus_tests::watched::{watched, watched_affine};

/// Gravity, m/s².
const G: f64 = 9.8;

/// Height and velocity.
type Flight = Vector2<f64>;

/// Which way a guard went through zero.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Down,
    Up,
}

use Way::{Down, Up};

/// How a mode is advanced and what is promised of its guards.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Path {
    /// Exact arcs, guards promised affine.
    ExactAffine,
    /// Exact arcs, nothing promised.
    Exact,
    /// Steps, guards promised affine.
    Affine,
    /// Steps, nothing promised.
    General,
}

const PATHS: [Path; 4] = [Path::ExactAffine, Path::Exact, Path::Affine, Path::General];

impl Path {
    /// An edge whose guard is affine, promised or not.
    fn edge<'a, S: State>(
        self,
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Edge<'a, S> {
        let edge = Edge::new(guard, reset);
        if self.promises() { edge.affine() } else { edge }
    }

    fn promises(self) -> bool {
        matches!(self, Self::ExactAffine | Self::Affine)
    }

    fn prepare<'a, S: State>(
        self,
        automaton: Hybrid<'a, S>,
        mode: &'static str,
        solution: impl Fn(f64, &S) -> Polynomial<S> + Send + Sync + 'a,
    ) -> Hybrid<'a, S> {
        if matches!(self, Self::ExactAffine | Self::Exact) { automaton.exact(mode, solution) } else { automaton }
    }
}

/// The parabola of free fall.
fn parabola(g: f64) -> impl Fn(f64, &Flight) -> Polynomial<Flight> + Send + Sync {
    move |_t, x| Polynomial::from([*x, vector![x[1], -g], vector![-0.5 * g, 0.0]])
}

/// A ball that keeps `e` of its speed at each impact on a floor at height zero, by the given path;
/// beyond the limit it rests.
fn ball(g: f64, e: f64, path: Path) -> Hybrid<'static, Flight> {
    let automaton = Hybrid::new()
        .mode("flight", move |_t, x: &Flight| vector![x[1], -g])
        .edge_with("flight", "flight", path.edge(|_t, x: &Flight| x[0], move |_t, x| vector![0.0, -e * x[1]]))
        .mode("rest", |_t, _x| vector![0.0, 0.0])
        .exact("rest", |_t, x| Polynomial::from([*x]))
        .beyond("flight", "rest", |_t, _x| vector![0.0, 0.0]);
    path.prepare(automaton, "flight", parabola(g))
}

/// The crossings of a watched guard in order.
fn crossings<S: State>(run: &RunOf<Hybrid<'_, S>>) -> Vec<(f64, Way)> {
    let way = |link: Link| if link.place == 0 { Down } else { Up };
    run.trajectory.jumps().iter().map(|jump| (jump.t(), way(jump.edge().unwrap()))).collect()
}

/// The crossings of a throw from `start` through the height `level`, by the given path.
fn throw(g: f64, start: Flight, level: f64, end: f64, path: Path) -> Vec<(f64, Way)> {
    let flow = move |_t: f64, x: &Flight| vector![x[1], -g];
    let height = move |_t: f64, x: &Flight| x[0] - level;
    let automaton = if path.promises() { watched_affine(flow, height) } else { watched(flow, height) };
    let automaton = path.prepare(automaton, "run", parabola(g));
    crossings(&Simulation::of(&automaton).run("run", start, 0.0..end).unwrap())
}

/// The crossings of a guard of time alone.
fn of_time(guard: impl Fn(f64) -> f64 + Send + Sync + Copy, span: Range<f64>) -> Vec<(f64, Way)> {
    let automaton = watched(|_t, _x: &f64| 1.0, move |t, _x| guard(t));
    crossings(&Simulation::of(&automaton).run("run", 0.0, span).unwrap())
}

/// Asserts that the crossings are those expected, each within `tolerance` in time.
#[track_caller]
fn assert_crossings(got: &[(f64, Way)], expected: &[(f64, Way)], tolerance: f64) {
    let close = got.len() == expected.len()
        && got.iter().zip(expected).all(|(a, b)| a.1 == b.1 && (a.0 - b.0).abs() <= tolerance);
    assert!(close, "crossings {got:?} instead of {expected:?} (within {tolerance:e})");
}

/// The lowest first coordinate anywhere on the recorded arcs, at their ends and between.
fn lowest<M: Copy, E, S: State>(run: &Run<M, E, S>) -> f64 {
    let mut low = f64::INFINITY;
    for arc in 0..run.trajectory.arcs().len() {
        for piece in run.trajectory.pieces(arc).filter(|piece| piece.span().is_finite()) {
            for k in 0..=32 {
                low = low.min(piece.at(piece.span() * f64::from(k) / 32.0).get(0));
            }
        }
    }
    run.trajectory.jumps().iter().fold(low, |low, jump| low.min(jump.before.get(0)).min(jump.after.get(0)))
}

/// The number of pieces a run recorded.
fn pieces<M: Copy, E, S: State>(run: &Run<M, E, S>) -> usize {
    (0..run.trajectory.arcs().len()).map(|arc| run.trajectory.pieces(arc).count()).sum()
}
