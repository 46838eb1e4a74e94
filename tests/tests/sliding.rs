//! Sliding on a surface of discontinuity: relays, dry friction, a block on a belt.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use nalgebra::{Vector2, vector};
use saltus::{Automaton, Dop853, ErrorKind, Filippov, Jump, Run, Side, Sides, Simulation, Stop, TwoSided};
use saltus_tests::reference::Case;

fn run<T: TwoSided>(system: &Filippov<T>, x: T::State, end: f64) -> Run<Filippov<T>> {
    let mode = system.side(0.0, &x).unwrap();
    let run = Simulation::of(system).stepper(Dop853).tolerance(1e-13).run(mode, x, 0.0..end).unwrap();
    assert_eq!(run.stop, Stop::Time);
    run
}

fn into<T: TwoSided>(run: &Run<Filippov<T>>, side: Side) -> Vec<Jump<Filippov<T>>> {
    run.trajectory.jumps().iter().filter(|jump| jump.to == side).copied().collect()
}

#[test]
fn relay() {
    let case = Case::named("relay");
    let relay = Filippov::of(Sides::new(|_, _: &f64| -1.0, |_, _| 1.0, |_, x| *x, |_, _| 1.0).affine());
    let run = run(&relay, case.param("x0"), 10.0);
    case.check("t_reach", run.trajectory.jumps()[0].t());
    case.check("x(1)", run.trajectory.at(1.0).unwrap());
    case.check("x(10)", run.state);
    assert_eq!(run.trajectory.jumps().len(), 1);
    assert!(run.stats.steps < 20, "{:?}", run.stats);
}

#[test]
fn relay_sine() {
    let case = Case::named("relay-sine");
    let a = case.param("A");
    let relay = Sides::new(
        move |t: f64, _: &f64| -1.0 + a * t.sin(),
        move |t: f64, _| 1.0 + a * t.sin(),
        |_, x| *x,
        |_, _| 1.0,
    );
    for relay in [relay, relay.affine()] {
        let relay = Filippov::of(relay);
        let run = run(&relay, case.param("x0"), 20.0);
        let slides = into(&run, Side::Sliding);
        let exits: Vec<_> = run.trajectory.jumps().iter().filter(|jump| jump.from == Side::Sliding).collect();
        case.check("t_enter_1", slides[0].t());
        case.check("t_exit_1", exits[0].t());
        case.check("t_enter_2", slides[1].t());
        case.check("t_exit_2", exits[1].t());
        case.check("t_enter_3", slides[2].t());
        case.check("x(20)", run.state);
        // The lowest point is where the flow below turns: sin t = -1/A, rising.
        let lowest = 2.0 * std::f64::consts::PI - (1.0 / a).asin();
        assert!(exits[0].t() < lowest && lowest < slides[1].t());
        case.check("x_min", run.trajectory.at(lowest).unwrap());
        // A slide and a way out each half period of the sine.
        assert_eq!(run.trajectory.jumps().len(), 2 * slides.len() - usize::from(run.mode == Side::Sliding));
        assert_eq!(slides.len(), 6);
    }
}

#[test]
fn friction_oscillator() {
    let case = Case::named("friction-oscillator");
    let (m, k) = (case.param("m"), case.param("k"));
    let drag = case.param("mu") * case.param("g");
    let block = Filippov::of(
        Sides::new(
            move |_, x: &Vector2<f64>| vector![x[1], -k / m * x[0] - drag],
            move |_, x| vector![x[1], -k / m * x[0] + drag],
            |_, x| x[1],
            |_, _| vector![0.0, 1.0],
        )
        .affine(),
    );
    let start = vector![case.param("x0"), 0.0];
    assert_eq!(block.side(0.0, &start), Some(Side::Below));
    let run = run(&block, start, 10.0);
    let turns = run.trajectory.jumps();
    case.check("n_half_cycles", turns.len() as f64);
    let stop = turns.last().unwrap();
    assert_eq!(stop.to, Side::Sliding);
    case.check("t_stop", stop.t());
    case.check("x_stop", stop.after[0]);
    case.check("x(10)", run.state[0]);
    assert_eq!(run.state[1], 0.0);
    let (x0, w) = (start[0], (k / m).sqrt());
    let quarter = run.trajectory.at(0.5 * std::f64::consts::PI / w).unwrap();
    assert!((quarter[0] - m * drag / k).abs() < 1e-12 && x0 > 0.0);
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

#[test]
fn belt_stick_slip() {
    let case = Case::named("belt-stick-slip");
    let p = |name| case.param(name);
    let belt = Filippov::of(Belt { k: p("k"), m: p("m"), speed: p("V"), hold: p("Fs"), drag: p("Fk") });
    let run = run(&belt, vector![0.0, p("V")], 1000.0);
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

/// Slides begin and end many times, at every phase, on a surface that moves and is no coordinate: each slide is one arc, and nothing chatters.
#[test]
fn tangential_exits_do_not_chatter() {
    for k in 0..210_u32 {
        let phase = f64::from(k) * 0.017;
        // In any unit, and far from the origin.
        let (unit, origin) = ([1.0, 1e6, 1e-6][k as usize % 3], [0.0, 1e3][k as usize % 2]);
        let (a, w, c) = (1.2 + 0.001 * f64::from(k), 1.0 + 0.01 * f64::from(k), 0.3 + 0.1 * f64::from(k % 7));
        // y = x0 - c x1 - 0.2 sin t is a relay driven by a sine; x1 runs away.
        let force = move |t: f64| a * (w * t + phase).sin();
        let system = Filippov::of(
            Sides::new(
                move |t: f64, x: &Vector2<f64>| vector![-1.0 + force(t) + c * x[0].cos() + 0.2 * t.cos(), x[0].cos()],
                move |t: f64, x| vector![1.0 + force(t) + c * x[0].cos() + 0.2 * t.cos(), x[0].cos()],
                move |t: f64, x| unit * (x[0] - origin - c * x[1] - 0.2 * t.sin()),
                move |_, _| vector![unit, -unit * c],
            )
            .moving(move |t: f64, _: &Vector2<f64>| -0.2 * unit * t.cos()),
        );
        let x = vector![origin + 1.0, 0.5];
        let mode = system.side(0.0, &x).unwrap();
        let run = Simulation::of(&system).run(mode, x, 0.0..50.0).unwrap();
        let jumps = run.trajectory.jumps();
        // Sliding ends where |force| grows past 1, to the side the force points to; at most a way out and a way in per half period.
        let half_periods = 50.0 * w / std::f64::consts::PI + 2.0;
        assert!((jumps.len() as f64) <= 2.0 * half_periods, "{k}: {} jumps", jumps.len());
        for (jump, next) in jumps.iter().zip(&jumps[1..]) {
            assert!(next.t() - jump.t() > 1e-9, "{k}: {jump:?} then {next:?}");
        }
        for jump in jumps.iter().filter(|jump| jump.from == Side::Sliding) {
            let up = jump.to == Side::Above;
            let expected = if up { 1.0 } else { -1.0 };
            assert!((force(jump.t()) - expected).abs() < 1e-7, "{k}: {jump:?}");
            assert!(
                system.guard(
                    if up { saltus::Passage::FromAbove } else { saltus::Passage::FromBelow },
                    jump.t(),
                    &jump.after
                ) >= 0.0
            );
        }
    }
}

/// Both flows push towards a circle, and a wind along its radius grows until it carries the state off, to either side in turn.
fn windy_circle(w: f64) -> Filippov<impl TwoSided<State = Vector2<f64>>> {
    let flow = move |t: f64, x: &Vector2<f64>, push: f64| {
        let radial = push + 1.1 * (w * t).sin();
        vector![-x[1] + radial * x[0], x[0] + radial * x[1]]
    };
    Filippov::of(Sides::new(
        move |t, x: &Vector2<f64>| flow(t, x, -1.0),
        move |t, x| flow(t, x, 1.0),
        |_, x| x.norm_squared() - 1.0,
        |_, x| 2.0 * x,
    ))
}

#[test]
fn a_curved_surface_is_kept_to_and_left() {
    for k in 0..60_u32 {
        let w = 0.3 + 0.043 * f64::from(k);
        let rim = windy_circle(w);
        let run = Simulation::of(&rim).run(Side::Sliding, vector![1.0, 0.0], 0.0..30.0).unwrap();
        assert_eq!(run.stop, Stop::Time);
        let jumps = run.trajectory.jumps();
        assert!(jumps.len() as f64 <= 2.0 * (30.0 * w / std::f64::consts::PI + 1.0), "{k}: {} jumps", jumps.len());
        for jump in jumps {
            assert!((jump.before.norm() - 1.0).abs() < 1e-9, "{k}: {jump:?}");
            let wind = 1.1 * (w * jump.t()).sin();
            match (jump.from, jump.to) {
                (Side::Sliding, Side::Above) => assert!((wind - 1.0).abs() < 1e-8, "{k}: {jump:?}"),
                (Side::Sliding, Side::Below) => assert!((wind + 1.0).abs() < 1e-8, "{k}: {jump:?}"),
                (_, Side::Sliding) => assert!(wind.abs() < 1.0, "{k}: {jump:?}"),
                other => panic!("{k}: {other:?}"),
            }
        }
    }
}

#[test]
fn a_long_slide_does_not_drift() {
    let rim = windy_circle(0.0);
    let run = Simulation::of(&rim).run(Side::Sliding, vector![1.0, 0.0], 0.0..1000.0).unwrap();
    assert!((run.state.norm() - 1.0).abs() < 1e-10, "{:e}", run.state.norm() - 1.0);
    assert_eq!(run.stats.jumps, 0);
}

/// Where both flows lead away, the future is the model's to choose.
#[test]
fn an_escaping_surface_is_a_decision() {
    let hill = Filippov::of(Sides::new(|_, _: &f64| 1.0, |_, _| -1.0, |_, x| *x, |_, _| 1.0).affine());
    assert_eq!(hill.side(0.0, &0.0), None);
    let failed = Simulation::of(&hill).run(Side::Sliding, 0.0, 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Entry);
    for (side, end) in [(Side::Above, 1.0), (Side::Below, -1.0)] {
        let run = Simulation::of(&hill).run(side, 0.0, 0.0..1.0).unwrap();
        assert!((run.state - end).abs() < 1e-15 && run.stats.jumps == 0);
    }
}

/// A mode that does not fit the state is refused, not run in the wrong domain.
#[test]
fn the_wrong_side_is_refused() {
    let relay = Filippov::of(Sides::new(|_, _: &f64| -1.0, |_, _| 1.0, |_, x| *x, |_, _| 1.0));
    assert_eq!(relay.side(0.0, &-0.5), Some(Side::Below));
    let failed = Simulation::of(&relay).run(Side::Above, -0.5, 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Entry);
}

/// Where both flows go the same way, the state goes through, once per crossing.
#[test]
fn a_refracting_surface_is_crossed() {
    let glass = Filippov::of(Sides::new(|_, _: &f64| -2.0, |_, _| -1.0, |_, x| x - 0.1, |_, _| 1.0));
    let run = Simulation::of(&glass).run(Side::Above, 1.0, 0.0..1.0).unwrap();
    assert_eq!((run.mode, run.stats.jumps), (Side::Below, 1));
    assert!((run.trajectory.jumps()[0].t() - 0.45).abs() < 1e-15);
    assert!((run.state + 0.45).abs() < 1e-14);
}
