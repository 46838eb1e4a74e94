//! Units change nothing: what rounding leaves of a guard is the same part of the motion in each.

use proptest::prelude::*;
use saltus::nalgebra::{self, Vector2, vector};
use saltus::{Edge, ErrorKind, Failed, Filippov, Hybrid, Run, Sides, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// A ball that falls from one `unit` on a floor, whose reset leaves it `below` the floor by this
/// part of the fall.
fn bounces(unit: f64, below: f64) -> Result<usize, ErrorKind> {
    let floor = Edge::new(|_t, x: &Vector2<f64>| x[0], move |_t, x: &Vector2<f64>| vector![-below * unit, -0.8 * x[1]]);
    let flight = move |_t: f64, x: &Vector2<f64>| vector![x[1], -unit];
    let ball = Hybrid::new().mode("flight", flight).edge_with("flight", "flight", floor);
    let simulation = Simulation::of(&ball).absolute_tolerance(1e-12 * unit);
    match simulation.run("flight", vector![unit, 0.0], 0.0..6.0) {
        Ok(run) => {
            assert_eq!(run.end.stop, Stop::Time);
            Ok(run.trajectory.jumps().len())
        }
        Err(failed) => Err(failed.error.kind()),
    }
}

#[test]
fn a_reset_is_off_by_the_rounding_of_the_motion() {
    for unit in (-40..=40).map(|k| 10_f64.powi(k)) {
        // A fall of √2 s, and flights of 1.6 √2 s and 0.8 times that: three impacts in 6 s.
        assert_eq!(bounces(unit, 0.0), Ok(3), "{unit:e}");
        // A few units in the last place of the fall are rounding; a millionth of a millionth is
        // not.
        for roundings in [0.5, 1.0, 2.0, 4.0] {
            assert_eq!(bounces(unit, roundings * f64::EPSILON), Ok(3), "{unit:e}, {roundings} roundings");
        }
        for part in [1e-12, 1e-9, 1e-3] {
            assert_eq!(bounces(unit, part), Err(ErrorKind::Entry), "{unit:e}, {part:e} of the fall");
        }
    }
}

/// A start is stated to within the absolute tolerance.
#[test]
fn a_start_is_off_by_the_absolute_tolerance() {
    for unit in (-40..=40).map(|k| 10_f64.powi(k)) {
        let flight = move |_t: f64, x: &Vector2<f64>| vector![x[1], -unit];
        let floor = |_t: f64, x: &Vector2<f64>| vector![0.0, -0.8 * x[1]];
        let ball = Hybrid::new().mode("flight", flight).edge("flight", "flight", |_t, x: &Vector2<f64>| x[0], floor);
        let simulation = Simulation::of(&ball).absolute_tolerance(1e-12 * unit);
        let thrown = |below: f64| simulation.run("flight", vector![-below * unit, unit], 0.0..3.0);
        for below in [0.0, 1e-18, 1e-13, 1e-12] {
            let run = thrown(below).unwrap_or_else(|error| panic!("{unit:e}, {below:e}: {error}"));
            let first = run.trajectory.jumps()[0].t();
            assert!((first - 2.0).abs() < 1e-11, "{unit:e}, {below:e}: {first}");
        }
        assert!(thrown(1e-9).is_err(), "{unit:e}");
    }
}

/// Units as powers of two, so that nothing is rounded otherwise: of the state, and of guards.
#[derive(Clone, Copy)]
struct Units {
    state: f64,
    guard: f64,
}

/// A motion at a `phase` of 0 to 1 in units, by one of three methods.
type Motion = fn(f64, Units, usize) -> Shown;

/// The times and states of the jumps and of the end, in units of one, or what the run failed for.
type Shown = Result<Vec<(f64, Vector2<f64>)>, ErrorKind>;

type Outcome<M, E> = Result<Run<M, E, Vector2<f64>>, Box<Failed<M, E, Vector2<f64>>>>;

fn shown<M: Copy + PartialEq, E: Copy + PartialEq>(run: Outcome<M, E>, Units { state, .. }: Units) -> Shown {
    let run = run.map_err(|failed| failed.error.kind())?;
    let jumps = run.trajectory.jumps().iter().map(|jump| (jump.t(), jump.after / state));
    Ok(jumps.chain([(run.end.time.seconds(), run.end.state / state)]).collect())
}

macro_rules! by_method {
    ($model:expr, $start:expr, $end:expr, $units:expr, $method:expr) => {{
        let (mode, x) = $start;
        let (model, x) = ($model, x * $units.state);
        let run = Simulation::of(&model).most_jumps(200).absolute_tolerance(1e-9 * $units.state);
        shown(run.stepper(methods()[$method]).run(mode, x, 0.0..$end), $units)
    }};
}

/// A ball in air between a floor and a ceiling whose guard touches zero as a cube.
fn ball(phase: f64, units: Units, method: usize) -> Shown {
    let Units { state, guard } = units;
    let floor = [0.0, 1.0, 1e3][(phase * 1e3) as usize % 3];
    let bounced = move |_t: f64, x: &Vector2<f64>| vector![x[0], -(0.3 + 0.6 * phase) * x[1]];
    let ball = Hybrid::new()
        .mode("air", move |_t, x: &Vector2<f64>| {
            let v = x[1] / state;
            vector![v, -9.81 - 0.1 * phase * v * v.abs()] * state
        })
        .edge("air", "air", move |_t, x| guard * (x[0] / state - floor), bounced)
        .edge("air", "air", move |_t, x| guard * (floor + 1.5 - x[0] / state).powi(3), bounced);
    by_method!(ball, ("air", vector![floor + 1.0, 6.0]), 4.0, units, method)
}

/// A ratchet whose guard leaps below zero where its tooth ends, and is near zero before.
fn ratchet(phase: f64, units: Units, method: usize) -> Shown {
    let Units { state, guard } = units;
    let leap = move |x: f64| if x < 1.0 { 0.3 * (1.2 - x) } else { -5.0 * phase };
    let ratchet = Hybrid::new().mode("on", move |t: f64, x: &Vector2<f64>| vector![x[1], 0.1 * state * t.sin()]).edge(
        "on",
        "on",
        move |_t, x| guard * leap(x[0] / state),
        move |_t, x| vector![x[0] - 0.5 * state, x[1]],
    );
    by_method!(ratchet, ("on", vector![phase - 1.0, 1.5]), 6.0, units, method)
}

/// A relay against a push that grows past its grip, on a surface that moves and is no coordinate.
fn relay(phase: f64, units: Units, method: usize) -> Shown {
    let Units { state, guard } = units;
    let (tilt, unit) = (0.3 + phase, guard / state);
    let flow = move |t: f64, x: &Vector2<f64>, grip: f64| {
        let x = x / state;
        let push = (1.1 + 0.3 * phase) * ((1.0 + phase) * t + 7.0 * phase).sin();
        vector![grip + push + tilt * x[0].cos() + 0.2 * t.cos(), x[0].cos()] * state
    };
    let relay = Sides::new(
        move |t, x: &Vector2<f64>| flow(t, x, -1.0),
        move |t, x| flow(t, x, 1.0),
        move |t: f64, x| unit * (x[0] - tilt * x[1] - state * 0.2 * t.sin()),
        move |_, _| vector![unit, -unit * tilt],
    );
    let relay = Filippov::of(relay.moving(move |t: f64, _: &Vector2<f64>| -unit * state * 0.2 * t.cos()));
    by_method!(relay, (saltus::Side::Above, vector![3.0, 0.5]), 20.0, units, method)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// To the last digit: a guard is compared with what it is made of, never with a number.
    #[test]
    fn the_units_of_state_and_guard_change_nothing(
        motion in prop::sample::select(vec![ball as Motion, ratchet, relay]),
        phase in 0.01..1.0_f64,
        method in 0..3_usize,
        (state, guard) in (-150..150_i32, -150..150_i32),
    ) {
        let plain = motion(phase, Units { state: 1.0, guard: 1.0 }, method);
        let scaled = motion(phase, Units { state: 2.0_f64.powi(state), guard: 2.0_f64.powi(guard) }, method);
        prop_assert!(plain.as_ref().is_ok_and(|shown| shown.len() > 3), "{plain:?}");
        prop_assert_eq!(plain, scaled);
    }
}
