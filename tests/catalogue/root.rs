//! Crossings that are hard to find, hard to tell apart, or not there.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Auto, Automaton, Dop853, Entry, ErrorKind, Hybrid, Jump, Polynomial, Run, RunOf, Simulation, State};
use saltus_tests::watched::{watched, watched_affine};

use crate::report::Report;

cases! {
    graze_touch = "graze-touch";
    graze_miss = "graze-miss-1e-9";
    graze_cross = "graze-cross-1e-9";
    graze_cross_closer = "graze-cross-1e-12";
    double_cross = "double-cross-1e-6";
    even_root = "even-root";
    cubic_root = "cubic-root";
    guard_nan = "guard-nan";
    guard_jump = "guard-jump";
    event_at_the_start = "event-at-t0";
    event_at_a_step_end = "event-at-step-end";
    fast_guard = "fast-guard";
    newton_killer = "newton-killer";
    grazing_impact = "grazing-impact";
}

pub(crate) fn times<M: Copy, E, S: State>(run: &Run<M, E, S>) -> Vec<f64> {
    run.trajectory.jumps().iter().map(Jump::t).collect()
}

pub(crate) fn tight<A: Automaton>(automaton: &A) -> Simulation<'_, A, Auto> {
    Simulation::of(automaton).stepper(Auto::from(Dop853)).tolerance(1e-14)
}

/// x' = 1 from 0, exactly, with a watched guard.
fn clock(case: &mut Report, guard: impl Fn(f64) -> f64 + Send + Sync + Copy + 'static) -> Vec<f64> {
    let automaton = watched(|_t, _x: &f64| 1.0, move |_t, x| guard(*x)).exact("run", |_t, x| [*x, 1.0].into());
    let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
    case.ran(&run.end.stats);
    times(&run)
}

/// sin t and its slope, with a watched guard.
fn swing(
    case: &mut Report,
    guard: impl Fn(&Vector2<f64>) -> f64 + Send + Sync + Copy + 'static,
) -> RunOf<Hybrid<'static, Vector2<f64>>> {
    let automaton = watched(|_t, x: &Vector2<f64>| vector![x[1], -x[0]], move |_t, x| guard(x));
    // A touch is a touch only for a solution that does not overshoot it.
    let run = tight(&automaton).tolerance(1e-15).run("run", vector![0.0, 1.0], 0.0..3.0).unwrap();
    case.ran(&run.end.stats);
    run
}

fn graze_touch(case: &mut Report) {
    let c = case.param("c");
    let run = swing(case, move |x| x[0] - c);
    let t = times(&run);
    case.outcome("n_events", t.len());
    match t.first() {
        Some(&t) => case.check("t_event_if_reported", t),
        None => case.absent("t_event_if_reported", "none is reported"),
    }
    case.check("x(3)", run.end.state[0]);
    case.check("v(3)", run.end.state[1]);
}

fn graze_miss(case: &mut Report) {
    let c = case.param("c");
    let run = swing(case, move |x| x[0] - c);
    case.check("n_events", times(&run).len() as f64);
    case.check("x(3)", run.end.state[0]);
    // The greatest x is where v falls through zero.
    let run = swing(case, |x| x[1]);
    case.check("x_max", run.trajectory.jumps()[0].before[0]);
}

fn graze_cross(case: &mut Report) {
    let c = case.param("c");
    let run = swing(case, move |x| x[0] - c);
    let t = times(&run);
    case.check("n_events", t.len() as f64);
    case.check("t_1", t[0]);
    case.check("t_2", t[1]);
    case.check("dt", t[1] - t[0]);
    case.check("v(t_1)", run.trajectory.jumps()[0].before[1]);
}

fn graze_cross_closer(case: &mut Report) {
    graze_cross(case);
}

/// By steps, by the exact parabola, and with the guard promised affine.
fn double_cross(case: &mut Report) {
    let [x0, v0, a] = case.params(["x0", "v0", "a"]);
    let flow = move |_t: f64, x: &Vector2<f64>| vector![x[1], a];
    let exact = move |_t: f64, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], a], vector![0.5 * a, 0.0]]);
    let steps = || watched(flow, |_t, x| x[0]);
    for automaton in [steps(), steps().exact("run", exact), watched_affine(flow, |_t, x| x[0]).exact("run", exact)] {
        let run = Simulation::of(&automaton).run("run", vector![x0, v0], 0.0..1.0).unwrap();
        case.ran(&run.end.stats);
        let t = times(&run);
        case.check("n_events", t.len() as f64);
        case.check("t_1", t[0]);
        case.check("t_2", t[1]);
        case.check("dt", t[1] - t[0]);
    }
}

fn even_root(case: &mut Report) {
    let r = case.param("r");
    let t = clock(case, move |x| (x - r).powi(4));
    case.outcome("n_events", t.len());
    case.absent("t_event_if_reported", "none is reported");
}

fn cubic_root(case: &mut Report) {
    let r = case.param("r");
    let factored = clock(case, move |x| (x - r).powi(3));
    let expanded = clock(case, move |x| ((x - 3.0 * r) * x + 3.0 * r * r) * x - r * r * r);
    for (name, t) in [("a_t_event", factored), ("b_t_event", expanded)] {
        case.check("n_events", t.len() as f64);
        case.check(name, t[0]);
    }
}

fn guard_nan(case: &mut Report) {
    let [p, q] = case.params(["p", "q"]);
    // Not a number at the start: refused, with the edge and the time.
    let automaton = watched(|_t, _x: &f64| 1.0, move |_t, x| (x - p).sqrt() - 0.5);
    let refused = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap_err();
    assert_eq!((refused.error.kind(), refused.error.t()), (ErrorKind::Guard, 0.0));
    case.absent("a_t_event", "refused with an explicit error, which the case allows");
    case.absent("a_n", "refused with an explicit error, which the case allows");
    // Not a number beyond the crossing: found, though every sample of the whole span overshoots.
    let automaton =
        Hybrid::new().exact("run", |_t, x: &f64| [*x, 1.0].into()).terminal("run", move |_t, x| (q - x).sqrt() - 0.1);
    let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
    case.ran(&run.end.stats);
    case.check("b_n", times(&run).len() as f64);
    case.check("b_t_event", times(&run)[0]);
}

fn guard_jump(case: &mut Report) {
    let c = case.param("c");
    let t = clock(case, move |x| if x < c { -1.0 } else { 1.0 });
    case.check("n_events", t.len() as f64);
    case.check("t_event", t[0]);
}

fn event_at_the_start(case: &mut Report) {
    let automaton = Hybrid::new()
        .exact("run", |_t, x: &f64| [*x, 1.0].into())
        .edge("run", "run", |_t, x| -x, |_t, x| *x)
        .entry(Entry::Wait)
        .edge("run", "run", |_t, x| 0.5 - x, |_t, x| *x)
        .entry(Entry::Wait);
    let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
    case.ran(&run.end.stats);
    let of =
        |place: usize| run.trajectory.jumps().iter().filter(move |j| j.edge().unwrap().place == place).map(Jump::t);
    assert!(of(0).all(|t| t == 0.0));
    case.outcome("n_A", of(0).count());
    case.check("n_B", of(1).count() as f64);
    case.check("t_B", of(1).next().unwrap());
}

/// Exactly, and by steps of an eighth; the times are asked to the bit of the exact flow only.
fn event_at_a_step_end(case: &mut Report) {
    for exact in [true, false] {
        let automaton = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).edge("run", "run", |_t, x| 0.5 - x, |_t, _x| 0.0);
        let automaton = if exact { automaton.exact("run", |_t, x| [*x, 1.0].into()) } else { automaton };
        let run = Simulation::of(&automaton).first_step(0.125).longest_step(0.125).run("run", 0.0, 0.0..4.0).unwrap();
        case.ran(&run.end.stats);
        case.check("n_events", times(&run).len() as f64);
        if exact {
            case.check("t_8", times(&run)[7]);
            case.check("x(4)", run.end.state);
        }
    }
}

fn fast_guard(case: &mut Report) {
    let w = case.param("w");
    let t = clock(case, move |x| (w * x + 1.0).sin());
    case.check("n_events", t.len() as f64);
    case.check("t_1", t[0]);
    case.mark(
        "t_last",
        8e-15..2.4e-14,
        "each of the 317 restarts rounds the clock x once, and the last crossing sees the sum",
    );
    case.check("t_last", t[t.len() - 1]);
}

fn newton_killer(case: &mut Report) {
    let r = case.param("r");
    let t = clock(case, move |x| (x - r).signum() * (x - r).abs().sqrt());
    case.check("n_events", t.len() as f64);
    case.check("t_event", t[0]);
}

fn grazing_impact(case: &mut Report) {
    let [d, e] = case.params(["d", "e"]);
    let automaton = Hybrid::new().mode("run", |_t, x: &Vector2<f64>| vector![x[1], -x[0]]).edge(
        "run",
        "run",
        move |_t, x| d - x[0],
        move |_t, x| vector![x[0], -e * x[1]],
    );
    let run = tight(&automaton).run("run", vector![0.0, 1.0], 0.0..20.0).unwrap();
    case.ran(&run.end.stats);
    case.check("n(20)", times(&run).len() as f64);
    for (n, jump) in (1..).zip(run.trajectory.jumps()) {
        case.check(&format!("t_{n}"), jump.t());
        case.check(&format!("v_pre_{n}"), jump.before[1]);
    }
    case.check("x(20)", run.end.state[0]);
    case.check("v(20)", run.end.state[1]);
}
