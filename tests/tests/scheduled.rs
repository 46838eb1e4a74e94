//! Edges that the clock takes, alone and together with those that the state takes.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use saltus::nalgebra::{Vector2, vector};
use saltus::{Hybrid, Polynomial, Simulation, every};
use saltus_tests::reference::Case;

/// A ball reaches the floor at the moment at which its restitution changes: both happen, the impact first.
#[test]
fn an_impact_and_a_switch_at_one_time() {
    let case = Case::named("coincident");
    let (g, e1, e2) = (case.param("g"), case.param("e1"), case.param("e2"));
    let fall = move |_t: f64, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], -g], vector![-0.5 * g, 0.0]]);
    let at_one = |t: f64| (t < 1.0).then_some(1.0);
    let ball = Hybrid::new()
        .exact("hard", fall)
        .exact("soft", fall)
        .edge("hard", "hard", |_t, x| x[0], move |_t, x| vector![0.0, -e1 * x[1]])
        .edge("soft", "soft", |_t, x| x[0], move |_t, x| vector![0.0, -e2 * x[1]])
        .scheduled("hard", "soft", at_one, |_t, x| *x);
    let run = Simulation::of(&ball).run("hard", vector![case.param("h"), 0.0], 0.0..1.2).unwrap();
    let jumps = run.trajectory.jumps();
    case.check("n_events", jumps.len() as f64);
    for jump in jumps {
        case.check("t_both", jump.t());
    }
    assert_eq!((jumps[0].to, jumps[1].to), ("hard", "soft"));
    case.check("x(1.2)_state_first", run.state[0]);
}

#[test]
fn a_square_wave() {
    let case = Case::named("square-wave");
    let period = case.param("p");
    let oscillator = Hybrid::new()
        .mode("up", |_t, x: &Vector2<f64>| vector![x[1], 1.0 - x[0]])
        .mode("down", |_t, x| vector![x[1], -1.0 - x[0]])
        .scheduled("up", "down", every(period), |_t, x| *x)
        .scheduled("down", "up", every(period), |_t, x| *x);
    let simulation = Simulation::of(&oscillator).tolerance(1e-13).absolute_tolerance(1e-14);
    let run = simulation.run("up", vector![0.0, 0.0], 0.0..71.0).unwrap();
    for n in [1, 10, 100] {
        let jump = &run.trajectory.jumps()[n - 1];
        assert_eq!(jump.t(), n as f64 * period);
        case.check(&format!("x_switch_{n}"), jump.before[0]);
        case.check(&format!("v_switch_{n}"), jump.before[1]);
    }
}

#[test]
fn a_schedule_starts_after_the_start_and_ends_with_the_span() {
    let count =
        Hybrid::new().mode("count", |_t, _x: &f64| 0.0).scheduled("count", "count", every(0.25), |_t, x| x + 1.0);
    let run = |from: f64, to: f64| Simulation::of(&count).run("count", 0.0, from..to).unwrap().state;
    assert_eq!(run(0.0, 1.0), 4.0);
    assert_eq!(run(0.25, 1.0), 3.0, "a tick at the very start is over");
    assert_eq!(run(0.3, 0.4), 0.0);
    assert_eq!(run(-1.0, 0.0), 4.0);
}

/// Ten thousand kicks of a millisecond each: none lost to rounding, none taken twice.
#[test]
fn many_ticks() {
    let count = Hybrid::new().exact("count", |_t, x: &f64| Polynomial::from([*x])).scheduled(
        "count",
        "count",
        every(1e-3),
        |_t, x| x + 1.0,
    );
    let run = Simulation::of(&count).run("count", 0.0, 0.0..10.0).unwrap();
    assert_eq!(run.state, 10_000.0);
    assert!(run.trajectory.jumps().iter().all(|jump| jump.t() == jump.j as f64 * 1e-3));
}
