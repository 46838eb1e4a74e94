//! Dense output at the ends of steps, and runs side by side.

use saltus::nalgebra::vector;
use saltus::step::{Auto, Dop853, Rodas5P, Tsit5};
use saltus::{Clock, Hybrid, Simulation, Stats};

use super::{Flight, G, PATHS, ball};

fn largest_gap(stepper: Auto) -> f64 {
    let automaton = Hybrid::new().mode("run", |_t, x: &Flight| vector![x[1], (1.0 - x[0] * x[0]) * x[1] - x[0]]);
    let run = Simulation::of(&automaton).stepper(stepper).run("run", vector![2.0, 0.0], 0.0..10.0).unwrap();
    let pieces: Vec<_> = run.trajectory.pieces(0).collect();
    assert!(pieces.len() > 10);
    let gap = |a: &Flight, b: &Flight| (0..2).map(|i| (a[i] - b[i]).abs() / b[i].abs().max(1.0)).fold(0.0, f64::max);
    let inner = pieces.windows(2).map(|pair| gap(&pair[0].at(pair[0].span()), &pair[1].at(0.0))).fold(0.0, f64::max);
    let end = pieces[pieces.len() - 1];
    inner.max(gap(&end.at(end.span()), &run.end.state))
}

/// A dense output that is off near the ends of its steps; here it meets the step's own values to a
/// rounding.
#[test]
fn the_dense_output_meets_the_steps() {
    for gap in [Tsit5.into(), Dop853.into(), Rodas5P.into()].map(largest_gap) {
        assert!(gap <= f64::EPSILON, "{gap:e}");
    }
}

/// Runs side by side differ from the same runs alone; here they are the same to the last bit.
#[test]
fn runs_side_by_side_are_the_runs_alone() {
    for path in PATHS {
        let automaton = ball(G, 0.8, path);
        let lane = |k: u32| {
            let start = vector![0.1 + 0.1 * f64::from(k), 0.3];
            let run = Simulation::of(&automaton).run("flight", start, 0.0..2.0).unwrap();
            run.trajectory.jumps().iter().map(|jump| (jump.t().to_bits(), jump.after[1].to_bits())).collect::<Vec<_>>()
        };
        let alone: Vec<_> = (0..16).map(lane).collect();
        let beside: Vec<_> = std::thread::scope(|scope| {
            let lanes: Vec<_> = (0..16).map(|k| scope.spawn(move || lane(k))).collect();
            lanes.into_iter().map(|lane| lane.join().unwrap()).collect()
        });
        assert_eq!(alone, beside, "{path:?}");
    }
}

/// A method of many steps begins again at order one after each jump; one of a single step has
/// nothing to forget, and keeps the size of its step.
#[test]
fn a_stiff_run_restarts_cheaply() {
    // x' = -10⁴ (x - cos t), with a jump each 0.1 s that changes nothing, and one that kicks x away
    // by 1.
    let run = |kick: Option<f64>| -> Stats {
        let automaton = Hybrid::new().mode("run", |t: f64, x: &f64| -1e4 * (x - t.cos()));
        let automaton = match kick {
            Some(kick) => automaton.clock("run", "run", Clock::every(0.1), move |_t, x| x + kick),
            None => automaton,
        };
        let run = Simulation::of(&automaton)
            .stepper(Auto::from(Rodas5P))
            .tolerance(1e-6)
            .run("run", 1.0, 0.0..10.05)
            .unwrap();
        assert_eq!(run.end.stats.jumps, if kick.is_some() { 100 } else { 0 });
        run.end.stats
    };
    let [smooth, still, kicked] = [run(None), run(Some(0.0)), run(Some(1.0))];
    assert!(still.steps <= smooth.steps + 100, "{smooth:?} {still:?}");
    // What is paid for is the decay of the kick.
    assert!(kicked.steps <= smooth.steps + 2500 && kicked.rejected <= 700, "{smooth:?} {kicked:?}");
}
