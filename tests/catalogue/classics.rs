//! Known test problems for event location: orbits, Bessel functions, limits, stiff oscillators,
//! chemistry.

use saltus::nalgebra::{Vector2, Vector3, Vector4, vector};
use saltus::{Auto, Dop853, Entry, Hybrid, Jump, Polynomial, Rodas5P, RunOf, Simulation};
use saltus_tests::watched::{watched, watched_affine};

use crate::report::Report;
use crate::root::{tight, times};

cases! {
    two_rate_switch = "two-rate-switch";
    kepler_events = "kepler-events";
    bessel_zeros = "bessel-zeros";
    limiter = "limiter";
    sticking = "sticking";
    bang_bang_oscillator = "bang-bang-oscillator";
    chebyshev_roots = "chebyshev-roots";
    van_der_pol = "vdp-100";
    robertson = "robertson-events";
}

fn two_rate_switch(case: &mut Report) {
    let high = case.param("Y");
    let automaton = Hybrid::new()
        .mode("grow", |_t, y: &f64| *y)
        .mode("decay", |_t, y| -0.5 * y)
        .edge("grow", "decay", move |_t, y| high - y, |_t, y| *y)
        .edge("decay", "grow", |_t, y| y - 1.0, |_t, y| *y);
    let run = tight(&automaton).run("grow", 1.0, 0.0..10.0).unwrap();
    case.ran(&run.end.stats);
    for (n, t) in (1..).zip(times(&run)) {
        case.check(&format!("t_{n}"), t);
    }
    case.check("n(10)", times(&run).len() as f64);
    case.check("y(10)", run.end.state);
}

/// Position and velocity on the orbit, from pericentre, with a watched guard.
fn kepler(
    case: &mut Report,
    guard: impl Fn(&Vector4<f64>) -> f64 + Send + Sync + Copy + 'static,
    end: f64,
) -> RunOf<Hybrid<'static, Vector4<f64>>> {
    let flow = |_t: f64, x: &Vector4<f64>| {
        let r3 = (x[0] * x[0] + x[1] * x[1]).powf(1.5);
        vector![x[2], x[3], -x[0] / r3, -x[1] / r3]
    };
    let ec = case.param("ec");
    let speed = ((1.0 + ec) / (1.0 - ec)).sqrt();
    case.check("v0", speed);
    let automaton = watched(flow, move |_t, x| guard(x));
    let run = tight(&automaton).run("run", vector![1.0 - ec, 0.0, 0.0, speed], 0.0..end).unwrap();
    case.ran(&run.end.stats);
    run
}

fn kepler_events(case: &mut Report) {
    let radius = times(&kepler(case, |x| x[0].hypot(x[1]) - 1.0, 6.0));
    case.check("t_r1_first", radius[0]);
    case.check("t_r1_second", radius[1]);
    let apsides = kepler(case, |x| x[0] * x[2] + x[1] * x[3], 63.0);
    let apsides: Vec<_> = apsides.trajectory.jumps().iter().filter(|jump| jump.t() > 0.0).collect();
    case.check("t_apo_1", apsides[0].t());
    case.check("r_apo", apsides[0].before[0].hypot(apsides[0].before[1]));
    case.check("t_peri_1", apsides[1].t());
    case.check("t_peri_10", apsides[19].t());
    let line = times(&kepler(case, |x| x[1], 63.0));
    case.check("n_y_crossings(63)", line.iter().filter(|&&t| t > 0.0).count() as f64);
}

fn bessel_zeros(case: &mut Report) {
    let [a, b] = case.params(["a", "b"]);
    let automaton = watched(|t, x: &Vector2<f64>| vector![x[1], -x[1] / t - x[0]], |_t, x| x[0]);
    let run = tight(&automaton).run("run", vector![a, b], 1.0..314.0).unwrap();
    case.ran(&run.end.stats);
    let t = times(&run);
    case.check("n(314)", t.len() as f64);
    for n in [1, 2, 10, 50, 99] {
        case.check(&format!("t_{n}"), t[n - 1]);
    }
    case.check("J0_zero_100", t[99]);
}

fn limiter(case: &mut Report) {
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
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    let hits: Vec<f64> = jumps.iter().filter(|jump| jump.from == "free").map(Jump::t).collect();
    let releases: Vec<f64> = jumps.iter().filter(|jump| jump.to == "free").map(Jump::t).collect();
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

fn sticking(case: &mut Report) {
    let s = case.param("s");
    let automaton = Hybrid::new()
        .exact("A", |_t, y: &f64| [*y, 1.0].into())
        .exact("B", |_t, y| [*y, 0.5].into())
        .edge("A", "B", move |_t, y| s - y, |_t, y| *y)
        .edge("B", "A", move |_t, y| y - s, |_t, y| *y);
    let run = Simulation::of(&automaton).run("A", 0.0, 0.0..2.0).unwrap();
    case.ran(&run.end.stats);
    case.check("n_transitions", times(&run).len() as f64);
    case.check("t_1", times(&run)[0]);
    case.check("y(2)", run.end.state);
}

fn bang_bang_oscillator(case: &mut Report) {
    let x0 = case.param("x0");
    let arc = |a: f64| move |_t: f64, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], a], vector![0.5 * a, 0.0]]);
    let automaton = Hybrid::new()
        .exact("right", arc(-1.0))
        .exact("left", arc(1.0))
        .edge("right", "left", |_t, x| x[0], |_t, x| *x)
        .affine()
        .edge("left", "right", |_t, x| -x[0], |_t, x| *x)
        .affine();
    let run = Simulation::of(&automaton).run("right", vector![x0, 0.0], 0.0..14143.0).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    case.check("n(14143)", jumps.len() as f64);
    for n in [1, 2, 5000] {
        case.check(&format!("t_{n}"), jumps[n - 1].t());
    }
    case.check("v_1", jumps[0].before[1]);
    let drift = jumps.iter().map(|j| (0.5 * j.before[1] * j.before[1] + j.before[0].abs() - x0).abs());
    case.check("energy_drift", drift.fold(0.0, f64::max));
}

fn chebyshev_roots(case: &mut Report) {
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
    case.ran(&run.end.stats);
    let t = times(&run);
    case.check("n_events", t.len() as f64);
    for n in [1, 2, 8, 9, 16] {
        case.check(&format!("t_{n}"), t[n - 1]);
    }
}

/// By an explicit method, whose steps stability limits.
fn van_der_pol(case: &mut Report) {
    let mu = case.param("mu");
    let flow = move |_t: f64, x: &Vector2<f64>| vector![x[1], mu * (1.0 - x[0] * x[0]) * x[1] - x[0]];
    let automaton = watched_affine(flow, |_t, x| x[0]);
    let run = Simulation::of(&automaton).stepper(Auto::from(Dop853)).tolerance(1e-13).run(
        "run",
        vector![2.0, 0.0],
        0.0..330.0,
    );
    let run = run.unwrap();
    case.ran(&run.end.stats);
    for (n, jump) in (1..=3).zip(run.trajectory.jumps()) {
        case.check(&format!("t_{n}"), jump.t());
        case.check(&format!("z_{n}"), jump.before[1]);
    }
}

fn robertson(case: &mut Report) {
    let [k1, k2, k3, lev1, lev3] = case.params(["k1", "k2", "k3", "lev1", "lev3"]);
    let flow = move |_t: f64, y: &Vector3<f64>| {
        let (decay, back, fast) = (k1 * y[0], k3 * y[1] * y[2], k2 * y[1] * y[1]);
        vector![back - decay, decay - back - fast, fast]
    };
    let automaton = Hybrid::new()
        .mode("run", flow)
        .edge("run", "run", move |_t, y| lev3 - y[2], |_t, y| *y)
        .affine()
        .entry(Entry::Wait)
        .edge("run", "run", move |_t, y| y[0] - lev1, |_t, y| *y)
        .affine()
        .entry(Entry::Wait);
    let simulation = Simulation::of(&automaton).stepper(Auto::from(Rodas5P)).tolerance(1e-12).absolute_tolerance(1e-20);
    let run = simulation.run("run", vector![1.0, 0.0, 0.0], 0.0..1e8).unwrap();
    case.ran(&run.end.stats);
    let [first, second] = run.trajectory.jumps() else { panic!("{:?}", run.trajectory.jumps()) };
    case.check("t_y3", first.t());
    case.check("y1_at_y3", first.before[0]);
    case.check("y2_at_y3", first.before[1]);
    case.check("t_y1", second.t());
    case.check("y2_at_y1", second.before[1]);
    case.check("y3_at_y1", second.before[2]);
}
