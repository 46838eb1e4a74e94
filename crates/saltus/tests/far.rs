//! Spans of any length, endless ones among them, and runs of very many jumps: the same motion, at
//! the same cost a jump.

use std::ops::ControlFlow;

use proptest::prelude::*;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Auto, Hybrid, JumpOf, Observer, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

const GRAVITY: f64 = 9.81;

type Flight = Vector2<f64>;
type Ball = Hybrid<'static, Flight>;

/// A ball over a floor that keeps `e` of its speed, and rests where its impacts accumulate.
fn ball(e: f64) -> Ball {
    Hybrid::new()
        .mode("flight", |_t, x: &Flight| vector![x[1], -GRAVITY])
        .edge("flight", "flight", |_t, x| x[0], move |_t, x| vector![0.0, -e * x[1]])
        .mode("rest", |_t, _x| vector![0.0, 0.0])
        .beyond("flight", "rest", |_t, _x| vector![0.0, 0.0])
}

/// The time of impact n, counted from zero, of a ball dropped from `height`.
fn impact(n: i32, e: f64, height: f64) -> f64 {
    let drop = (2.0 * height / GRAVITY).sqrt();
    drop * (1.0 + 2.0 * (1..=n).map(|k| e.powi(k)).sum::<f64>())
}

fn bounces_as_it_should(ball: &Ball, stepper: Auto, e: f64, height: f64, end: f64) {
    let run = Simulation::of(ball).stepper(stepper).most_jumps(60).most_steps(100_000);
    let run = run.run("flight", vector![height, 0.0], 0.0..end).unwrap();
    let whole = if end == f64::INFINITY { Stop::Forever } else { Stop::Time };
    assert!(run.end.stop == whole || matches!(run.end.stop, Stop::Jumps { .. }), "{}", run.end.stop);
    let limit = impact(20_000, e, height);
    for (n, jump) in run.trajectory.jumps().iter().enumerate() {
        let exact = if jump.edge().is_some() { impact(n as i32, e, height) } else { limit };
        assert!((jump.t() - exact).abs() < 1e-9 * exact, "e = {e} to {end}: {jump:?} instead of {exact}");
    }
    assert!(run.end.stop != whole || end < limit || run.end.mode == "rest", "e = {e} to {end}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(48)))]
    /// A parabola's error estimate is zero, and the step would grow tenfold with every arc until
    /// the next crossing was lost in the rounding at its start.
    #[test]
    fn a_span_of_any_length_shows_the_same_bounces(
        e in 0.2..1.0_f64,
        height in -3.0..3.0_f64,
        end in prop_oneof![Just(f64::INFINITY), (1.0..299.0_f64).prop_map(|power| 10_f64.powf(power))],
        affine in any::<bool>(),
    ) {
        let height = 10_f64.powf(height);
        let ball = if affine { ball(e).affine() } else { ball(e) };
        for method in &methods()[..3] {
            bounces_as_it_should(&ball, *method, e, height, end);
        }
    }

    /// A series that ends has no error: its steps would be as long as the span.
    #[test]
    fn nor_is_one_lost_in_a_series_that_ends(
        e in 0.2..0.9_f64,
        height in -3.0..3.0_f64,
        power in 1.0..33.0_f64,
        endless: bool,
        digits in 3.0..14.0_f64,
        affine: bool,
    ) {
        let (height, end) = (10_f64.powf(height), if endless { f64::INFINITY } else { 10_f64.powf(power) });
        let ball = Hybrid::new()
            .mode("flight", |_t, x: &[f64; 2]| [x[1], -GRAVITY])
            .series("flight", |t, [_, v]| [v, t * 0.0 - GRAVITY])
            .edge("flight", "flight", |_t, x| x[0], move |_t, x| [0.0, -e * x[1]]);
        let ball = if affine { ball.affine() } else { ball };
        let ball = ball.mode("rest", |_t, _x| [0.0, 0.0]).beyond("flight", "rest", |_t, _x| [0.0, 0.0]);
        let run = Simulation::of(&ball).tolerance(10_f64.powf(-digits)).run("flight", [height, 0.0], 0.0..end).unwrap();
        prop_assert!(run.trajectory.doubts().is_empty());
        let limit = impact(20_000, e, height);
        let rest = run.end.limits.last.map_or(f64::INFINITY, |rest| (rest - limit).abs());
        prop_assert!(end < limit || rest < 1e-9 * limit, "rest after {:?} instead of {limit}", run.end.limits.last);
    }
}

/// Energies after some jumps.
struct Energies(Vec<f64>, usize);

impl Observer<Ball> for Energies {
    fn jump(&mut self, jump: &JumpOf<Ball>) -> ControlFlow<()> {
        self.1 += 1;
        if [1, 10, 100, 1000, 10_000, 100_000].contains(&self.1) {
            self.0.push(0.5 * jump.after[1] * jump.after[1] + GRAVITY * jump.after[0]);
        }
        ControlFlow::Continue(())
    }
}

/// A random walk of roundings is some √n of them after n bounces: 7e-14 after 10⁵. What the
/// crossing on the dense output of a step much longer than the arc is off by, always to one side,
/// was 5e-9.
fn keeps_its_energy(stepper: Auto, of_one: f64) {
    let mut energies = Energies(Vec::new(), 0);
    let ball = ball(1.0);
    let simulation = Simulation::of(&ball).stepper(stepper).most_jumps(100_000);
    let end = simulation.drive("flight", vector![1.0, 0.0], 0.0..f64::INFINITY, &mut energies).unwrap();
    assert_eq!(end.stop, Stop::Jumps { most: 100_000 });
    for (energy, jumps) in energies.0.iter().zip([1.0_f64, 1e1, 1e2, 1e3, 1e4, 1e5]) {
        let off = (energy / GRAVITY - 1.0).abs();
        assert!(off <= of_one * jumps.sqrt(), "{off:e} after {jumps} bounces");
    }
    assert!(end.stats.guards < 70 * 100_000, "{} evaluations of the guard", end.stats.guards);
}

#[test]
fn an_elastic_ball_keeps_its_energy() {
    let [tsit5, dop853, rodas5p, _] = methods();
    keeps_its_energy(tsit5, 16.0 * f64::EPSILON);
    keeps_its_energy(dop853, 16.0 * f64::EPSILON);
    // The solutions of linear systems within a step carry the rounding of differences.
    keeps_its_energy(rodas5p, 1e-12);
}

#[test]
fn every_limit_ends_a_run_over_an_endless_span() {
    let tank = Hybrid::new().mode("fill", |_t, _x: &f64| 1.0).edge("fill", "fill", |_t, x| 1.0 - x, |_t, _x| 0.0);
    let endless = 0.0..f64::INFINITY;
    let run = Simulation::of(&tank).most_jumps(50).run("fill", 0.0, endless.clone()).unwrap();
    assert_eq!(run.end.stop, Stop::Jumps { most: 50 });
    assert!((run.trajectory.jumps()[49].t() - 50.0).abs() < 1e-12);
    let run = Simulation::of(&tank).most_steps(50).run("fill", 0.0, endless.clone()).unwrap();
    assert_eq!(run.end.stop, Stop::Steps { most: 50 });
    let still = Hybrid::new().mode("still", |_t, _x: &f64| 0.0).edge("still", "still", |_t, x| *x, |_t, x| *x);
    let run = Simulation::of(&still).run("still", 1.0, endless).unwrap();
    assert_eq!((run.end.stop, run.end.state), (Stop::Forever, 1.0));
}
