//! Edges that the clock takes, alone and together with those that the state takes.

use saltus::nalgebra::{Vector2, Vector3, vector};
use saltus::{Clock, Hybrid, Polynomial, Simulation};

use crate::report::Report;
use crate::root::tight;

cases! {
    square_wave = "square-wave";
    coincident = "coincident";
    pulse = "pulse";
    kicked = "kicked";
}

fn square_wave(case: &mut Report) {
    let period = case.param("p");
    let oscillator = Hybrid::new()
        .mode("up", |_t, x: &Vector2<f64>| vector![x[1], 1.0 - x[0]])
        .mode("down", |_t, x| vector![x[1], -1.0 - x[0]])
        .clock("up", "down", Clock::every(period), |_t, x| *x)
        .clock("down", "up", Clock::every(period), |_t, x| *x);
    let simulation = Simulation::of(&oscillator).tolerance(1e-13).absolute_tolerance(1e-14);
    let run = simulation.run("up", vector![0.0, 0.0], 0.0..71.0).unwrap();
    case.ran(&run.end.stats);
    for n in [1, 10, 100] {
        let jump = &run.trajectory.jumps()[n - 1];
        assert_eq!(jump.t(), n as f64 * period);
        case.check(&format!("x_switch_{n}"), jump.before[0]);
        case.check(&format!("v_switch_{n}"), jump.before[1]);
    }
}

/// A ball reaches the floor at the moment at which its restitution changes: both happen, the impact
/// first.
fn coincident(case: &mut Report) {
    let [g, e1, e2, h] = case.params(["g", "e1", "e2", "h"]);
    let fall = move |_t: f64, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], -g], vector![-0.5 * g, 0.0]]);
    let ball = Hybrid::new()
        .exact("hard", fall)
        .exact("soft", fall)
        .edge("hard", "hard", |_t, x| x[0], move |_t, x| vector![0.0, -e1 * x[1]])
        .edge("soft", "soft", |_t, x| x[0], move |_t, x| vector![0.0, -e2 * x[1]])
        .clock("hard", "soft", Clock::at([1.0]), |_t, x| *x);
    let run = Simulation::of(&ball).run("hard", vector![h, 0.0], 0.0..1.2).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    case.check("n_events", jumps.len() as f64);
    for jump in jumps {
        case.check("t_both", jump.t());
    }
    case.outcome("which", if jumps[0].to == "hard" { "state_first" } else { "time_first" });
    case.check("x(1.2)_state_first", run.end.state[0]);
    case.absent("x(1.2)_time_first", "the other order; here the crossing is first, as model.md says");
}

/// The clock switches, so no step can miss it.
fn pulse(case: &mut Report) {
    let [t1, t2] = case.params(["t1", "t2"]);
    let automaton = Hybrid::new()
        .mode("before", |_t, _x: &f64| 0.0)
        .mode("pulse", |_t, _x| 1e6)
        .mode("after", |_t, _x| 0.0)
        .clock("before", "pulse", Clock::at([t1]), |_t, x| *x)
        .clock("pulse", "after", Clock::at([t2]), |_t, x| *x);
    let run = Simulation::of(&automaton).run("before", 0.0, 0.0..1.0).unwrap();
    case.ran(&run.end.stats);
    assert_eq!(run.trajectory.jumps().iter().map(saltus::Jump::t).collect::<Vec<_>>(), [t1, t2]);
    case.check("x(1)", run.end.state);
}

/// By the clock, and as crossings of a clock that is part of the state.
fn kicked(case: &mut Report) {
    let w = case.param("w");
    let automaton = Hybrid::new().mode("run", move |_t, x: &Vector2<f64>| vector![x[1], -w * w * x[0]]).clock(
        "run",
        "run",
        Clock::every(1.0),
        |_t, x| vector![x[0], x[1] + 1.0],
    );
    let run = tight(&automaton).run("run", vector![0.0, 0.0], 0.0..100.5).unwrap();
    case.ran(&run.end.stats);
    case.check("n_kicks", run.trajectory.jumps().len() as f64);
    case.check("x(100.5)", run.end.state[0]);
    case.check("v(100.5)", run.end.state[1]);

    let automaton = Hybrid::new().mode("run", move |_t, x: &Vector3<f64>| vector![x[1], -w * w * x[0], 1.0]).edge(
        "run",
        "run",
        |_t, x| 1.0 - x[2],
        |_t, x| vector![x[0], x[1] + 1.0, 0.0],
    );
    let run = tight(&automaton).run("run", vector![0.0, 0.0, 0.0], 0.0..100.5).unwrap();
    case.ran(&run.end.stats);
    case.check("n_kicks", run.trajectory.jumps().len() as f64);
    case.check("x(100.5)", run.end.state[0]);
    case.check("v(100.5)", run.end.state[1]);
}
