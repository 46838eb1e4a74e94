//! Balls against closed forms, by the exact arc and by steps.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Hybrid, JumpOf, RunOf, Simulation, Stop};
use saltus_bounce::{Ball, Cor, Drop, Mode};

fn ball(g: f64, e: f64) -> Ball {
    Ball::new(g, Cor::new(e).unwrap()).unwrap()
}

fn run(ball: &Ball, start: Vector2<f64>, end: f64) -> RunOf<Ball> {
    Simulation::of(ball).run(Mode::Flight, start, 0.0..end).unwrap()
}

fn impact(run: &RunOf<Ball>, n: usize) -> &JumpOf<Ball> {
    &run.trajectory.jumps()[n - 1]
}

fn rest_time(run: &RunOf<Ball>) -> f64 {
    run.trajectory.jumps().iter().find(|jump| jump.to == Mode::Rest).unwrap().t()
}

/// The numbers of impacts that floating-point time can tell apart.
#[test]
fn impacts_until_rest() {
    for (e, impacts, limit) in [
        (0.5, 52, 1.355_261_854_357_876_8),
        (0.7, 99, 2.559_939_058_231_544_6),
        (0.9, 322, 8.583_325_077_599_888),
        (0.99, 3163, 89.899_036_339_072_5),
    ] {
        let run = run(&ball(9.8, e), vector![1.0, 0.0], 100.0);
        assert_eq!(run.trajectory.jumps().len(), impacts + 1, "e = {e}");
        assert!((rest_time(&run) - limit).abs() <= 4e-15 * limit, "e = {e}: {}", rest_time(&run));
        assert_eq!((run.end.mode, run.end.stop), (Mode::Rest, Stop::Time));
        for k in 0..=100_000_u32 {
            let x = run.trajectory.at(f64::from(k) * 1e-3).unwrap();
            assert!(x[0] >= 0.0, "e = {e}: {x:?} at step {k}");
        }
    }
}

/// Three hundred launches from exactly zero come down again, each after 2 v/g.
#[test]
fn launches_from_the_floor() {
    for k in 1..=300_u32 {
        let v = f64::from(k) / 32.0;
        let run = run(&ball(9.8, 0.5), vector![0.0, v], 100.0);
        let t = impact(&run, 1).t();
        assert!((t - 2.0 * v / 9.8).abs() <= 2.0 * f64::EPSILON * t, "v = {v}");
    }
}

/// A rebound height over the drop height is the COR squared.
#[test]
fn rebound_heights() {
    for (e, ratio) in [(0.3, 0.09), (0.5, 0.25), (0.8, 0.64), (0.95, 0.9025)] {
        let v = impact(&run(&ball(9.8, e), vector![1.0, 0.0], 1.0), 1).after[1];
        assert!((v * v / 19.6 - ratio).abs() < 1e-12, "e = {e}");
    }
}

/// The impact at exactly the end of the span has both its limits.
#[test]
fn an_impact_at_the_end() {
    let run = run(&ball(10.0, 1.0), vector![45.0, 0.0], 15.0);
    assert_eq!(run.trajectory.jumps().len(), 3);
    assert_eq!(run.trajectory.before(15.0).unwrap()[1], -30.0);
    assert_eq!(run.trajectory.at(15.0).unwrap()[1], 30.0);
}

/// The same ball in closed form, exactly solved, and by steps with and without a promise about the
/// guard: one list of impacts.
#[test]
fn every_path_gives_the_same_impacts() {
    let (g, e) = (9.8, 0.8);
    let exact = Drop::new(1.0, g, Cor::new(e).unwrap());
    let arcs = run(&ball(g, e), vector![1.0, 0.0], 3.0);
    let stepped = Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -g]).edge(
        "flight",
        "flight",
        |_t, x| x[0],
        |_t, x| vector![0.0, -e * x[1]],
    );
    let general = Simulation::of(&stepped).run("flight", vector![1.0, 0.0], 0.0..3.0).unwrap();
    let stepped = stepped.affine();
    let affine = Simulation::of(&stepped).run("flight", vector![1.0, 0.0], 0.0..3.0).unwrap();
    assert_eq!(arcs.trajectory.jumps().len(), 6);
    for n in 1..=6_usize {
        let t = exact.impact_time(n as u32);
        for (path, got) in [
            ("arcs", impact(&arcs, n).t()),
            ("affine", affine.trajectory.jumps()[n - 1].t()),
            ("general", general.trajectory.jumps()[n - 1].t()),
        ] {
            // A parabola is beyond no stepper; what is left is the rounding of stages whose weights
            // are up to thirteen.
            let rounding = if path == "arcs" { 2e-15 } else { 2e-13 };
            assert!((got - t).abs() < rounding, "{path}, impact {n}: {got} instead of {t}");
        }
    }
    // What it costs: the exact arc takes no step, and excluding or finding a crossing takes no more
    // flow than the step it lies in, twice.
    assert_eq!((arcs.end.stats.steps, arcs.end.stats.flows), (0, 0));
    assert_eq!((affine.end.stats.steps, affine.end.stats.rejected), (general.end.stats.steps, 0));
}
