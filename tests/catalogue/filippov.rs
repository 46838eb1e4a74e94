//! Sliding, sticking, switching: relays, dry friction, tanks, a thermostat, and the switches of an
//! optimal control that accumulate.

use std::f64::consts::{FRAC_PI_2, TAU};

use saltus::nalgebra::{Vector2, vector};
use saltus::{Dop853, Filippov, Hybrid, Jump, Polynomial, Run, RunOf, Side, Sides, Simulation, State, Stop, TwoSided};

use crate::report::Report;

cases! {
    relay = "relay";
    relay_sine = "relay-sine";
    friction_oscillator = "friction-oscillator";
    belt_stick_slip = "belt-stick-slip";
    water_tanks = "water-tanks";
    torricelli = "torricelli";
    thermostat = "thermostat";
    fuller = "fuller";
}

fn run<T: TwoSided>(case: &mut Report, system: &Filippov<T>, x: T::State, end: f64) -> RunOf<Filippov<T>> {
    let mode = system.side(0.0, &x).unwrap();
    let run = Simulation::of(system).stepper(Dop853).tolerance(1e-13).run(mode, x, 0.0..end).unwrap();
    assert_eq!(run.end.stop, Stop::Time);
    case.ran(&run.end.stats);
    run
}

fn into<E: Copy, S: State>(run: &Run<Side, E, S>, side: Side) -> Vec<Jump<Side, E, S>> {
    run.trajectory.jumps().iter().filter(|jump| jump.to == side).cloned().collect()
}

fn relay(case: &mut Report) {
    let relay = Filippov::of(Sides::new(|_, _: &f64| -1.0, |_, _| 1.0, |_, x| *x, |_, _| 1.0).affine());
    let x0 = case.param("x0");
    let run = run(case, &relay, x0, 10.0);
    case.check("t_reach", run.trajectory.jumps()[0].t());
    case.check("x(1)", run.trajectory.at(1.0).unwrap());
    case.check("x(10)", run.end.state);
    assert_eq!(run.trajectory.jumps().len(), 1);
    assert!(run.end.stats.steps < 20, "{:?}", run.end.stats);
}

fn relay_sine(case: &mut Report) {
    let [x0, a] = case.params(["x0", "A"]);
    let relay = Sides::new(
        move |t: f64, _: &f64| -1.0 + a * t.sin(),
        move |t: f64, _| 1.0 + a * t.sin(),
        |_, x| *x,
        |_, _| 1.0,
    );
    for relay in [relay.clone(), relay.affine()] {
        let run = run(case, &Filippov::of(relay), x0, 20.0);
        let slides = into(&run, Side::Sliding);
        let exits: Vec<_> = run.trajectory.jumps().iter().filter(|jump| jump.from == Side::Sliding).collect();
        for (n, slide) in (1..=3).zip(&slides) {
            case.check(&format!("t_enter_{n}"), slide.t());
        }
        for (n, exit) in (1..=2).zip(&exits) {
            case.check(&format!("t_exit_{n}"), exit.t());
        }
        case.check("x(20)", run.end.state);
        // The lowest point is where the flow below turns: sin t = -1/A, rising.
        let lowest = TAU - (1.0 / a).asin();
        assert!(exits[0].t() < lowest && lowest < slides[1].t());
        case.check("x_min", run.trajectory.at(lowest).unwrap());
        // A slide and a way out each half period of the sine.
        assert_eq!(run.trajectory.jumps().len(), 2 * slides.len() - usize::from(run.end.mode == Side::Sliding));
        assert_eq!(slides.len(), 6);
    }
}

fn friction_oscillator(case: &mut Report) {
    let [m, k, mu, g, x0] = case.params(["m", "k", "mu", "g", "x0"]);
    let drag = mu * g;
    let block = Filippov::of(
        Sides::new(
            move |_, x: &Vector2<f64>| vector![x[1], -k / m * x[0] - drag],
            move |_, x| vector![x[1], -k / m * x[0] + drag],
            |_, x| x[1],
            |_, _| vector![0.0, 1.0],
        )
        .affine(),
    );
    let run = run(case, &block, vector![x0, 0.0], 10.0);
    let turns = run.trajectory.jumps();
    case.check("n_half_cycles", turns.len() as f64);
    let stop = turns.last().unwrap();
    assert_eq!(stop.to, Side::Sliding);
    case.check("t_stop", stop.t());
    case.check("x_stop", stop.after[0]);
    case.check("x(10)", run.end.state[0]);
    assert_eq!(run.end.state[1], 0.0);
    let quarter = run.trajectory.at(FRAC_PI_2 / (k / m).sqrt()).unwrap();
    assert!((quarter[0] - m * drag / k).abs() < 1e-12);
    case.check("v_1", quarter[1]);
}

/// Static friction holds with more than kinetic friction drags.
struct Belt {
    k: f64,
    m: f64,
    speed: f64,
    hold: f64,
    drag: f64,
}

impl TwoSided for Belt {
    type State = Vector2<f64>;
    fn above(&self, _: f64, x: &Vector2<f64>) -> Vector2<f64> {
        vector![x[1], (-self.k * x[0] - self.drag) / self.m]
    }
    fn below(&self, _: f64, x: &Vector2<f64>) -> Vector2<f64> {
        vector![x[1], (-self.k * x[0] + self.drag) / self.m]
    }
    fn surface(&self, _: f64, x: &Vector2<f64>) -> f64 {
        x[1] - self.speed
    }
    fn normal(&self, _: f64, _: &Vector2<f64>) -> Vector2<f64> {
        vector![0.0, 1.0]
    }
    fn hold_above(&self, _: f64, x: &Vector2<f64>) -> f64 {
        (self.k * x[0] + self.hold) / self.m
    }
    fn hold_below(&self, _: f64, x: &Vector2<f64>) -> f64 {
        (-self.k * x[0] + self.hold) / self.m
    }
    fn affine(&self) -> bool {
        true
    }
}

fn belt_stick_slip(case: &mut Report) {
    let [k, m, speed, hold, drag] = case.params(["k", "m", "V", "Fs", "Fk"]);
    let belt = Filippov::of(Belt { k, m, speed, hold, drag });
    let run = run(case, &belt, vector![0.0, speed], 1000.0);
    let (slips, sticks) = (into(&run, Side::Below), into(&run, Side::Sliding));
    case.check("t_slip_1", slips[0].t());
    case.check("t_stick_1", sticks[0].t());
    case.check("slip_duration", sticks[0].t() - slips[0].t());
    case.check("stick_duration", slips[1].t() - sticks[0].t());
    case.check("period", slips[1].t() - slips[0].t());
    case.check("t_slip_100", slips[99].t());
    assert_eq!(run.trajectory.jumps().len(), slips.len() + sticks.len());
    assert!(slips.len().abs_diff(sticks.len()) <= 1 && slips.len() > 300);
    // The extremes of position are where the block stands: v = 0 twice per slip.
    let still = |mut a: f64, mut b: f64| {
        let falls = run.trajectory.at(a).unwrap()[1] > 0.0;
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if (run.trajectory.at(middle).unwrap()[1] > 0.0) == falls { a = middle } else { b = middle }
        }
        run.trajectory.at(a).unwrap()[0]
    };
    let middle = 0.5 * (slips[0].t() + sticks[0].t());
    case.check("x_max", still(slips[0].t(), middle));
    case.check("x_min", still(middle, sticks[0].t()));
}

fn water_tanks(case: &mut Report) {
    let [w, v1, v2] = case.params(["w", "v1", "v2"]);
    let tanks = Hybrid::new()
        .mode("first", move |_, _: &Vector2<f64>| vector![w - v1, -v2])
        .mode("second", move |_, _| vector![-v1, w - v2])
        .edge("first", "second", |_, x| x[1], |_, x| *x)
        .edge("second", "first", |_, x| x[0], |_, x| *x)
        .mode("dry", |_, _| vector![0.0, 0.0])
        .beyond("first", "dry", |_, _| vector![0.0, 0.0])
        .beyond("second", "dry", |_, _| vector![0.0, 0.0]);
    let simulation = Simulation::of(&tanks).stepper(Dop853).tolerance(1e-13);
    let run = simulation.run("first", vector![1.0, 1.0], 0.0..8.0).unwrap();
    case.ran(&run.end.stats);
    assert_eq!((run.end.stop, run.end.mode), (Stop::Time, "dry"));
    let jumps = run.trajectory.jumps();
    for n in [1, 2, 10] {
        case.check(&format!("t_{n}"), jumps[n - 1].t());
    }
    case.check("t_zeno", jumps.last().unwrap().t());
    let level = |n: usize| jumps[n].after[0].max(jumps[n].after[1]);
    case.check("n_level_1e-9", ((0..).position(|n| level(n) < 1e-9).unwrap() + 1) as f64);
    case.check("ratio_per_cycle", level(12) / level(10));
    case.check("x1_at_zeno", run.end.state[0]);
    case.check("x2_at_zeno", run.end.state[1]);
}

/// Levels fall like squares and never below zero, so a margin that falls through zero is their
/// root; the root is the better coordinate anyway: with h = u², u' = -k/2 while h' = -k √h has no
/// unique past.
fn torricelli(case: &mut Report) {
    let [k1, k2, h1, h2] = case.params(["k1", "k2", "h10", "h20"]);
    let tanks = Hybrid::new()
        .mode("both", move |_, u: &Vector2<f64>| vector![-0.5 * k1, (k1 * u[0] / u[1] - k2) / 2.0])
        .mode("second", move |_, _| vector![0.0, -0.5 * k2])
        .mode("empty", |_, _| vector![0.0, 0.0])
        .edge("both", "second", |_, u| u[0], |_, u| vector![0.0, u[1]])
        .edge("second", "empty", |_, u| u[1], |_, _| vector![0.0, 0.0]);
    let simulation = Simulation::of(&tanks).stepper(Dop853).tolerance(1e-13);
    let run = simulation.run("both", vector![h1.sqrt(), h2.sqrt()], 0.0..20.0).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    case.check("t_empty_1", jumps[0].t());
    case.check("h2(t_empty_1)", jumps[0].after[1].powi(2));
    case.check("t_empty_2", jumps[1].t());
    let levels = run.trajectory.at(2.0).unwrap().map(|u| u * u);
    case.check("h1(2)", levels[0]);
    case.check("h2(2)", levels[1]);
    case.check("h1(20)", run.end.state[0].powi(2));
    case.check("h2(20)", run.end.state[1].powi(2));
}

fn thermostat(case: &mut Report) {
    let [a, te, q, low, high] = case.params(["a", "Te", "q", "Tlo", "Thi"]);
    let thermostat = Hybrid::new()
        .mode("heating", move |_, x: &f64| -a * (x - te) + q)
        .mode("cooling", move |_, x| -a * (x - te))
        .edge("heating", "cooling", move |_, x| high - x, |_, x| *x)
        .affine()
        .edge("cooling", "heating", move |_, x| x - low, |_, x| *x)
        .affine();
    let simulation = Simulation::of(&thermostat).stepper(Dop853).tolerance(1e-13).most_jumps(100_003);
    let run = simulation.run("heating", 20.0, 0.0..5e5).unwrap();
    case.ran(&run.end.stats);
    let t = |n: usize| run.trajectory.jumps()[n - 1].t();
    for n in [1, 2, 3, 100_001] {
        case.check(&format!("t_{n}"), t(n));
    }
    case.check("period", t(3) - t(1));
}

/// Each arc is a parabola; the switches accumulate at the origin, where the state stays.
fn fuller(case: &mut Report) {
    let c = case.param("C");
    let curve = move |x: &Vector2<f64>| x[0] + c * x[1] * x[1].abs();
    let arc = |u: f64| move |_t: f64, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], u], vector![0.5 * u, 0.0]]);
    let system = Hybrid::new()
        .exact("left", arc(-1.0))
        .exact("right", arc(1.0))
        .edge("left", "right", move |_t, x| curve(x), |_t, x| *x)
        .edge("right", "left", move |_t, x| -curve(x), |_t, x| *x)
        .exact("rest", |_t, x| [*x].into())
        .beyond("left", "rest", |_t, _x| vector![0.0, 0.0])
        .beyond("right", "rest", |_t, _x| vector![0.0, 0.0]);
    let run = Simulation::of(&system).run("left", vector![1.0, 0.0], 0.0..5.0).unwrap();
    case.ran(&run.end.stats);
    assert_eq!((run.end.stop, run.end.mode), (Stop::Time, "rest"));
    let jumps = run.trajectory.jumps();
    for n in [1, 2, 5] {
        case.check(&format!("t_{n}"), jumps[n - 1].t());
    }
    case.check("v_1", jumps[0].before[1]);
    case.check("v_5", jumps[4].before[1]);
    case.check("t_zeno", jumps.last().unwrap().t());
    let speed = |n: usize| jumps[n - 1].before[1].abs();
    case.check("ratio", speed(6) / speed(5));
    case.check("n_v_1e-6", (1..).find(|&n| speed(n) < 1e-6).unwrap() as f64);
    case.check("x(5)", run.end.state[0]);
    case.check("v(5)", run.end.state[1]);
    // J = ∫ x² over the parabolas.
    let cost = jumps.iter().enumerate().map(|(n, jump)| {
        let from = &run.trajectory.arcs()[n];
        let (s, a, b) = (jump.time.since(from.start()), from.state()[0], from.state()[1]);
        let half = if from.mode() == "right" { 0.5 } else { -0.5 };
        let [c3, c4, c5] = [(b * b + 2.0 * a * half) / 3.0, 0.5 * b * half, half * half / 5.0];
        (((c5 * s + c4) * s + c3) * s + a * b) * s * s + a * a * s
    });
    case.check("cost", cost.sum());
    case.check("C_exact", c);
}
