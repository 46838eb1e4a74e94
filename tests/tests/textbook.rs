//! The systems that every course on hybrid automata starts with, against their reference values.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use nalgebra::{Vector2, vector};
use saltus::{Coords, Dop853, Hybrid, Simulation, Stop};
use saltus_tests::reference::Case;

/// A mass on a springy leg. In flight the state is (height, speed); in stance the ground's impulse is a third coordinate.
#[test]
fn a_hopper_whose_modes_differ_in_dimension() {
    let case = Case::named("vertical-hopper");
    let p = |name| case.param(name);
    let (m, k, l0, g, h) = (p("m"), p("k"), p("l0"), p("g"), p("h"));
    let push = move |y: f64| k * (l0 - y);
    let hopper = Hybrid::new()
        .mode("flight", move |_, x: &Coords<3>| [x[1], -g].into())
        .mode("stance", move |_, x| [x[1], push(x[0]) / m - g, push(x[0])].into())
        .edge("flight", "stance", move |_, x| x[0] - l0, |_, x| [x[0], x[1], 0.0].into())
        .edge("stance", "flight", move |_, x| l0 - x[0], |_, x| [x[0], x[1]].into());
    let simulation = Simulation::of(&hopper).stepper(Dop853).tolerance(1e-14);
    let run = simulation.run("flight", [h, 0.0].into(), 0.0..800.0).unwrap();
    assert_eq!(run.stop, Stop::Time);
    let jumps = run.trajectory.jumps();
    case.check("t_touchdown_1", jumps[0].t());
    case.check("stance_time", jumps[1].t() - jumps[0].t());
    case.check("period", jumps[2].t() - jumps[0].t());
    let middle = 0.5 * (jumps[0].t() + jumps[1].t());
    case.check("y_min", run.trajectory.at(middle).unwrap()[0]);
    // The ground turns the speed round: its impulse is that change of momentum and what gravity takes meanwhile.
    let (down, up) = (jumps[0].before, jumps[1].before);
    let impulse = m * (up[1] - down[1]) + m * g * (jumps[1].t() - jumps[0].t());
    assert!((up[2] / impulse - 1.0).abs() < 1e-12, "{}", up[2] / impulse);
    // The apex after the thousandth stance, from the state at its lift-off.
    let lift = jumps[1999];
    let v = lift.after[1];
    case.check("t_apex_1000", lift.t() + v / g);
    case.check("apex_1000", lift.after[0] + v * v / (2.0 * g));
}

#[test]
fn a_thermostat_switches_a_hundred_thousand_times() {
    let case = Case::named("thermostat");
    let p = |name| case.param(name);
    let (a, te, q, low, high) = (p("a"), p("Te"), p("q"), p("Tlo"), p("Thi"));
    let thermostat = Hybrid::new()
        .mode("heating", move |_, x: &f64| -a * (x - te) + q)
        .mode("cooling", move |_, x| -a * (x - te))
        .edge("heating", "cooling", move |_, x| high - x, |_, x| *x)
        .affine("heating", "cooling")
        .edge("cooling", "heating", move |_, x| x - low, |_, x| *x)
        .affine("cooling", "heating");
    let simulation = Simulation::of(&thermostat).stepper(Dop853).tolerance(1e-13).most_jumps(100_003);
    let run = simulation.run("heating", 20.0, 0.0..5e5).unwrap();
    let t = |n: usize| run.trajectory.jumps()[n - 1].t();
    for n in [1, 2, 3, 100_001] {
        case.check(&format!("t_{n}"), t(n));
    }
    case.check("period", t(3) - t(1));
}

#[test]
fn two_tanks_run_dry_at_the_zeno_limit() {
    let case = Case::named("water-tanks");
    let (w, v1, v2) = (case.param("w"), case.param("v1"), case.param("v2"));
    let tanks = Hybrid::new()
        .mode("first", move |_, _: &Vector2<f64>| vector![w - v1, -v2])
        .mode("second", move |_, _| vector![-v1, w - v2])
        .edge("first", "second", |_, x| x[1], |_, x| *x)
        .edge("second", "first", |_, x| x[0], |_, x| *x)
        .mode("dry", |_, _| vector![0.0, 0.0])
        .beyond("first", "dry", |_, _| vector![0.0, 0.0])
        .beyond("second", "dry", |_, _| vector![0.0, 0.0]);
    let run =
        Simulation::of(&tanks).stepper(Dop853).tolerance(1e-13).run("first", vector![1.0, 1.0], 0.0..8.0).unwrap();
    assert_eq!((run.stop, run.mode), (Stop::Time, "dry"));
    let jumps = run.trajectory.jumps();
    for n in [1, 2, 10] {
        case.check(&format!("t_{n}"), jumps[n - 1].t());
    }
    case.check("t_zeno", jumps.last().unwrap().t());
    let level = |n: usize| jumps[n].after[0].max(jumps[n].after[1]);
    case.check("n_level_1e-9", ((0..).position(|n| level(n) < 1e-9).unwrap() + 1) as f64);
    case.check("ratio_per_cycle", level(12) / level(10));
    case.check("x1_at_zeno", run.state[0]);
    case.check("x2_at_zeno", run.state[1]);
}

/// Levels fall like squares and never below zero, so a margin that falls through zero is their root; the root is the better coordinate anyway:
/// with h = u², u' = -k/2 while h' = -k √h has no unique past.
#[test]
fn draining_tanks_empty_in_finite_time() {
    let case = Case::named("torricelli");
    let (k1, k2) = (case.param("k1"), case.param("k2"));
    let tanks = Hybrid::new()
        .mode("both", move |_, u: &Vector2<f64>| vector![-0.5 * k1, (k1 * u[0] / u[1] - k2) / 2.0])
        .mode("second", move |_, _| vector![0.0, -0.5 * k2])
        .mode("empty", |_, _| vector![0.0, 0.0])
        .edge("both", "second", |_, u| u[0], |_, u| vector![0.0, u[1]])
        .edge("second", "empty", |_, u| u[1], |_, _| vector![0.0, 0.0]);
    let start = vector![case.param("h10").sqrt(), case.param("h20").sqrt()];
    let run = Simulation::of(&tanks).stepper(Dop853).tolerance(1e-13).run("both", start, 0.0..20.0).unwrap();
    let jumps = run.trajectory.jumps();
    case.check("t_empty_1", jumps[0].t());
    case.check("h2(t_empty_1)", jumps[0].after[1].powi(2));
    case.check("t_empty_2", jumps[1].t());
    let levels = run.trajectory.at(2.0).unwrap().map(|u| u * u);
    case.check("h1(2)", levels[0]);
    case.check("h2(2)", levels[1]);
    case.check("h1(20)", run.state[0]);
    case.check("h2(20)", run.state[1]);
}
