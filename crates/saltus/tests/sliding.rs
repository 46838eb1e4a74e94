//! Sliding on a surface of discontinuity: ways in and out, drift, and what has no answer.

use proptest::prelude::*;
use saltus::nalgebra::{self, Vector2, vector};
use saltus::{Auto, Automaton, Dop853, ErrorKind, Filippov, Rodas5P, Side, Sides, Simulation, Stop, Tsit5, TwoSided};
use saltus_cases::cases;

/// Slides begin and end many times, at every phase, on a surface that moves and is no coordinate:
/// each slide is one arc, and nothing chatters.
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
        // Sliding ends where |force| grows past 1, to the side the force points to; at most a way
        // out and a way in per half period.
        let half_periods = 50.0 * w / std::f64::consts::PI + 2.0;
        assert!((jumps.len() as f64) <= 2.0 * half_periods, "{k}: {} jumps", jumps.len());
        for (jump, next) in jumps.iter().zip(&jumps[1..]) {
            assert!(next.t() - jump.t() > 1e-9, "{k}: {jump:?} then {next:?}");
        }
        for jump in jumps.iter().filter(|jump| jump.from == Side::Sliding) {
            let up = jump.to == Side::Above;
            let expected = if up { 1.0 } else { -1.0 };
            assert!((force(jump.t()) - expected).abs() < 1e-7, "{k}: {jump:?}");
            // The surface is left tangentially: the state is on it but for the rounding of its
            // coordinates.
            let edge = if up { saltus::Passage::FromAbove } else { saltus::Passage::FromBelow };
            let size = unit * (jump.after[0].abs() + origin + c * jump.after[1].abs() + 0.2);
            let h = system.guard(edge, jump.t(), &jump.after);
            assert!(h >= -4.0 * f64::EPSILON * size, "{k}: {h:e}, {jump:?}");
        }
    }
}

/// A relay against a sine that outgrows it, on a surface that moves or rests, near the origin or
/// far from it.
struct Driven {
    push: f64,
    rate: f64,
    phase: f64,
    tilt: f64,
    sway: f64,
    origin: f64,
}

impl Driven {
    fn force(&self, t: f64) -> f64 {
        self.push * (self.rate * t + self.phase).sin()
    }

    fn flow(&self, t: f64, x: &Vector2<f64>, grip: f64) -> Vector2<f64> {
        vector![grip + self.force(t) + self.tilt * x[0].cos() + self.sway * t.cos(), x[0].cos()]
    }
}

impl TwoSided for Driven {
    type State = Vector2<f64>;
    fn above(&self, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow(t, x, -1.0)
    }
    fn below(&self, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow(t, x, 1.0)
    }
    fn surface(&self, t: f64, x: &Vector2<f64>) -> f64 {
        x[0] - self.origin - self.tilt * x[1] - self.sway * t.sin()
    }
    fn normal(&self, _t: f64, _x: &Vector2<f64>) -> Vector2<f64> {
        vector![1.0, -self.tilt]
    }
    fn surface_rate(&self, t: f64, _x: &Vector2<f64>) -> f64 {
        -self.sway * t.cos()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(2000)))]

    /// By every method at every tolerance each slide is one arc, left where the force outgrows the
    /// grip, and not met again at once.
    #[test]
    fn a_slide_is_left_once(
        (push, rate, phase) in (1.05..1.55_f64, 0.5..3.5_f64, 0.0..7.0_f64),
        tilt in 0.0..1.2_f64,
        sway in prop::sample::select(vec![0.0, 0.2]),
        origin in prop::sample::select(vec![0.0, 1e3]),
        digits in 3.0..12.0_f64,
        method in 0..4_usize,
    ) {
        let driven = Filippov::of(Driven { push, rate, phase, tilt, sway, origin });
        let tolerance = 10.0_f64.powf(-digits);
        let method = [Auto::new(), Tsit5.into(), Dop853.into(), Rodas5P.into()][method];
        let run = Simulation::of(&driven).stepper(method).tolerance(tolerance);
        let run = run.run(Side::Above, vector![origin + 1.0, 0.5], 0.0..20.0).unwrap();
        let jumps = run.trajectory.jumps();
        for (jump, next) in jumps.iter().zip(&jumps[1..]) {
            prop_assert!(next.t() - jump.t() > 1e-6, "{jump:?} then {next:?}");
        }
        for jump in jumps.iter().filter(|jump| jump.from == Side::Sliding) {
            let expected = if jump.to == Side::Above { 1.0 } else { -1.0 };
            let force = push * (rate * jump.t() + phase).sin();
            prop_assert!((force - expected).abs() < 1e-9 + 10.0 * tolerance, "{jump:?}: {force}");
        }
    }
}

/// Both flows push towards a circle, and a wind along its radius grows until it carries the state
/// off, to either side in turn.
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
        assert_eq!(run.end.stop, Stop::Time);
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
    assert!((run.end.state.norm() - 1.0).abs() < 1e-10, "{:e}", run.end.state.norm() - 1.0);
    assert_eq!(run.end.stats.jumps, 0);
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
        assert!((run.end.state - end).abs() < 1e-15 && run.end.stats.jumps == 0);
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
    assert_eq!((run.end.mode, run.end.stats.jumps), (Side::Below, 1));
    assert!((run.trajectory.jumps()[0].t() - 0.45).abs() < 1e-15);
    assert!((run.end.state + 0.45).abs() < 1e-14);
}
