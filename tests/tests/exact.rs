//! Balls against closed forms and reference values, by the exact arc and by steps.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::ops::ControlFlow;

use saltus::nalgebra::{Vector2, vector};
use saltus::{ErrorKind, Hybrid, Jump, Observer, Run, Simulation, Stop};
use saltus_bounce::{Ball, Cor, Drop, Mode};
use saltus_tests::reference::Case;

fn ball(g: f64, e: f64) -> Ball {
    Ball::new(g, Cor::new(e).unwrap()).unwrap()
}

fn run(ball: &Ball, start: Vector2<f64>, end: f64) -> Run<Ball> {
    Simulation::of(ball).run(Mode::Flight, start, 0.0..end).unwrap()
}

fn impact(run: &Run<Ball>, n: usize) -> &Jump<Ball> {
    &run.trajectory.jumps()[n - 1]
}

fn rest_time(run: &Run<Ball>) -> f64 {
    run.trajectory.jumps().iter().find(|jump| jump.to == Mode::Rest).unwrap().t()
}

fn impacts_until(run: &Run<Ball>, t: f64) -> f64 {
    run.trajectory.jumps().iter().filter(|jump| jump.t() <= t && jump.edge().is_some()).count() as f64
}

fn first_slower(run: &Run<Ball>, speed: f64) -> f64 {
    run.trajectory.jumps().iter().find(|jump| jump.after[1] < speed).unwrap().j as f64
}

#[test]
fn zeno_e_half() {
    let case = Case::named("zeno-e0.5");
    let run = run(&ball(case.param("g"), case.param("e")), vector![case.param("h"), 0.0], 10.0);
    for n in [1, 2, 10, 40] {
        case.check(&format!("t_{n}"), impact(&run, n).t());
    }
    case.check("v_post_40", impact(&run, 40).after[1]);
    case.check("t_zeno", rest_time(&run));
    case.check("n_slow", first_slower(&run, 1e-6));
    let x = run.trajectory.at(4.2).unwrap();
    case.check("x(4.2)", x[0]);
    case.check("v(4.2)", x[1]);
    case.check("n(4.2)", impacts_until(&run, 4.2));
    case.check("x(10)", run.state[0]);
    case.check("v(10)", run.state[1]);
}

#[test]
fn zeno_e_nine_tenths() {
    let case = Case::named("zeno-e0.9");
    let run = run(&ball(case.param("g"), case.param("e")), vector![case.param("h"), 0.0], 20.0);
    for n in [1, 10, 100, 200] {
        case.check(&format!("t_{n}"), impact(&run, n).t());
    }
    case.check("v_post_200", impact(&run, 200).after[1]);
    case.check("t_zeno", rest_time(&run));
    case.check("n_slow", first_slower(&run, 1e-9));
    let x = run.trajectory.at(8.0).unwrap();
    case.check("x(8)", x[0]);
    case.check("v(8)", x[1]);
    case.check("n(8)", impacts_until(&run, 8.0));
    case.check("x(20)", run.state[0]);
    case.check("v(20)", run.state[1]);
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
        assert_eq!((run.mode, run.stop), (Mode::Rest, Stop::Time));
        for k in 0..=100_000_u32 {
            let x = run.trajectory.at(f64::from(k) * 1e-3).unwrap();
            assert!(x[0] >= 0.0, "e = {e}: {x:?} at step {k}");
        }
    }
}

#[test]
fn plastic() {
    let case = Case::named("zeno-plastic");
    let run = run(&ball(case.param("g"), case.param("e")), vector![case.param("h"), 0.0], 3.0);
    case.check("t_1", impact(&run, 1).t());
    case.check("n_impacts", run.trajectory.jumps().len() as f64);
    case.check("x(3)", run.state[0]);
    case.check("v(3)", run.state[1]);
    assert_eq!(run.mode, Mode::Rest);
}

/// A million impacts without loss: neither time nor energy drifts.
#[test]
fn elastic_million() {
    let case = Case::named("elastic-1e6");
    struct Watch {
        case: Case,
        height: f64,
        g: f64,
        drift: f64,
    }
    impl Observer<Ball> for Watch {
        fn jump(&mut self, jump: &Jump<Ball>) -> ControlFlow<()> {
            let apex = jump.after[1] * jump.after[1] / (2.0 * self.g);
            self.drift = self.drift.max((apex / self.height - 1.0).abs());
            if [1, 1000, 1_000_000].contains(&jump.j) {
                self.case.check(&format!("t_{}", jump.j), jump.t());
            }
            ControlFlow::Continue(())
        }
    }
    let (g, height) = (case.param("g"), case.param("h"));
    let mut watch = Watch { case, height, g, drift: 0.0 };
    let simulation = ball(g, 1.0);
    let ending =
        Simulation::of(&simulation).drive(Mode::Flight, vector![height, 0.0], 0.0..9.0305e5, &mut watch).unwrap();
    assert_eq!(ending.stop, Stop::Time);
    watch.case.check("max_rel_energy_drift", watch.drift);
}

#[test]
fn tiny_height() {
    let case = Case::named("tiny-height");
    let run = run(&ball(case.param("g"), case.param("e")), vector![case.param("h"), 0.0], 1e-5);
    case.check("t_1", impact(&run, 1).t());
    case.check("t_5", impact(&run, 5).t());
    case.check("v_post_5", impact(&run, 5).after[1]);
    case.check("t_zeno", rest_time(&run));
    let x = run.trajectory.at(1e-6).unwrap();
    case.check("x(1e-6)", x[0]);
    case.check("v(1e-6)", x[1]);
    case.check("n(1e-6)", impacts_until(&run, 1e-6));
}

#[test]
fn starts_on_the_floor() {
    let case = Case::named("rest-on-floor");
    let still = run(&ball(case.param("g"), case.param("e")), vector![0.0, 0.0], 10.0);
    case.check("x(10)", still.state[0]);
    case.check("v(10)", still.state[1]);
    assert!(still.trajectory.jumps().len() <= 1 && still.mode == Mode::Rest);

    let case = Case::named("floor-start-up");
    let up = run(&ball(case.param("g"), case.param("e")), vector![0.0, case.param("v0")], 2.0);
    case.check("t_1", impact(&up, 1).t());
    case.check("t_2", impact(&up, 2).t());
    case.check("t_zeno", rest_time(&up));
    case.check("x(0.3)", up.trajectory.at(0.3).unwrap()[0]);
    case.check("x(2)", up.state[0]);

    // Three hundred launches from exactly zero come down again, each after 2 v / g.
    for k in 1..=300_u32 {
        let v = f64::from(k) / 32.0;
        let run = run(&ball(9.8, 0.5), vector![0.0, v], 100.0);
        let t = impact(&run, 1).t();
        assert!((t - 2.0 * v / 9.8).abs() <= 2.0 * f64::EPSILON * t, "v = {v}");
    }
}

#[test]
fn starts_below_the_floor() {
    let case = Case::named("below-floor");
    let ball = ball(case.param("g"), case.param("e"));
    let refused = Simulation::of(&ball).run(Mode::Flight, vector![-1e-3, 0.0], 0.0..1.0).unwrap_err();
    assert_eq!(refused.error.kind(), ErrorKind::Entry);
    let still = run(&ball, vector![-1e-18, 0.0], 1.0);
    case.check("b_x(1)", still.state[0]);
    let up = run(&ball, vector![-1e-18, 1.0], 1.0);
    case.check("c_t_1", impact(&up, 1).t());
}

#[test]
fn without_gravity() {
    let case = Case::named("g-zero");
    let down = run(&ball(case.param("g"), case.param("e")), vector![1.0, -1.0], 5.0);
    case.check("run1_t_1", impact(&down, 1).t());
    case.check("run1_x(5)", down.state[0]);
    case.check("run1_n", down.trajectory.jumps().len() as f64);
    let still = run(&ball(0.0, 0.5), vector![1.0, 0.0], 5.0);
    case.check("run2_x(5)", still.state[0]);
    case.check("run2_n", still.trajectory.jumps().len() as f64);
}

/// Flights of a microsecond at a million seconds keep their digits.
#[test]
fn flights_that_shrink_by_twelve_orders() {
    let case = Case::named("ratio-1e12");
    let run = run(&ball(case.param("g"), case.param("e")), vector![case.param("h"), 0.0], 2e6);
    let flight = |n: usize| impact(&run, n + 1).time.since(impact(&run, n).time);
    case.check("t_1", impact(&run, 1).t());
    case.check("v_pre_1", impact(&run, 1).before[1]);
    for n in [1, 3, 6] {
        case.check(&format!("flight_{n}"), flight(n));
    }
    case.check("t_7", impact(&run, 7).t());
    case.check("t_zeno", rest_time(&run));
    let v = impact(&run, 6).after[1];
    case.check("apex_6", v * v / (2.0 * case.param("g")));
}

/// Bounces far below the spacing of doubles at the time they happen.
#[test]
fn bounces_at_a_billion_seconds() {
    let case = Case::named("t0-1e9");
    let ball = ball(case.param("g"), case.param("e"));
    let start = vector![0.0, case.param("v0")];
    let run = Simulation::of(&ball).run(Mode::Flight, start, 1e9..1e9 + 1e-6).unwrap();
    let since = |jump: &Jump<Ball>| jump.time.since(run.trajectory.start());
    case.check("t_1-t0", since(impact(&run, 1)));
    case.check("t_10-t0", since(impact(&run, 10)));
    let rest = run.trajectory.jumps().iter().find(|jump| jump.to == Mode::Rest).unwrap();
    case.check("t_zeno-t0", since(rest));
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

/// The same ball in closed form, exactly solved, and by steps with and without a promise about the guard: one list of impacts.
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
    let stepped = stepped.affine("flight", "flight");
    let affine = Simulation::of(&stepped).run("flight", vector![1.0, 0.0], 0.0..3.0).unwrap();
    assert_eq!(arcs.trajectory.jumps().len(), 6);
    for n in 1..=6_usize {
        let t = exact.impact_time(n as u32);
        for (path, got) in [
            ("arcs", impact(&arcs, n).t()),
            ("affine", affine.trajectory.jumps()[n - 1].t()),
            ("general", general.trajectory.jumps()[n - 1].t()),
        ] {
            // A parabola is beyond no stepper; what is left is the rounding of stages whose weights are up to thirteen.
            let rounding = if path == "arcs" { 2e-15 } else { 2e-13 };
            assert!((got - t).abs() < rounding, "{path}, impact {n}: {got} instead of {t}");
        }
    }
    // What it costs: the exact arc takes no step, and excluding or finding a crossing takes no more flow than the step it lies in, twice.
    assert_eq!((arcs.stats.steps, arcs.stats.flows), (0, 0));
    assert_eq!((affine.stats.steps, affine.stats.rejected), (general.stats.steps, 0));
}
