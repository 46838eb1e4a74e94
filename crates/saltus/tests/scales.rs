//! What a motion's own scales are changes nothing: long and short times, far origins, flat and
//! steep guards, small coordinates beside large ones.

use std::f64::consts::PI;
use std::fmt;

use proptest::prelude::*;
use saltus::{
    Automaton, Edge, Edges, Entry, ErrorKind, Failed, Filippov, Hybrid, Limit, Refusal, Run, Side, Sides, Simulation,
    Stop,
};
use saltus_cases::cases;

use crate::methods::methods;

const GRAVITY: f64 = 9.81;
/// Bounces lower than so many roundings of their height are hidden by these: what `FAR` times
/// `SURELY` of them are.
const HIDDEN: f64 = 65_536.0;

type Outcome<M, E, S> = Result<Run<M, E, S>, Box<Failed<M, E, S>>>;

/// The times of a run's jumps, or what it failed for; none of its searches is in doubt.
fn times<M: Copy + PartialEq + fmt::Debug, E: Copy + PartialEq + fmt::Debug, S: saltus::State>(
    run: Outcome<M, E, S>,
) -> Result<Vec<f64>, ErrorKind> {
    let run = run.map_err(|failed| failed.error.kind())?;
    assert!(run.trajectory.doubts().is_empty(), "{:?}", run.trajectory.doubts().first());
    Ok(run.trajectory.jumps().iter().map(saltus::Jump::t).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(64)))]

    /// A speed that is beyond numbers in what the tolerance allows: of a coordinate at zero whose
    /// tolerance is no more than that, or beside a large state.
    #[test]
    fn a_coordinate_at_zero_beside_any_tolerance(decades in -300.0..-9.0_f64, size in 0.0..300.0_f64, small: bool) {
        let swing = Hybrid::new().mode("swing", |_, x: &[f64; 2]| [x[1], -x[0]]).terminal("swing", |_, x| x[0]);
        let (absolute, size) = if small { (10_f64.powf(decades), 1.0) } else { (1e-9, 10_f64.powf(size)) };
        for stepper in methods() {
            let simulation = Simulation::of(&swing).stepper(stepper).absolute_tolerance(absolute);
            let found = times(simulation.run("swing", [size, 0.0], 0.0..3.0)).unwrap();
            prop_assert!(found.len() == 1 && (found[0] - 0.5 * PI).abs() < 1e-8, "{:?} {:?}", stepper, found);
        }
    }

    /// Powers of one second are tiny where a motion takes a day, beside a guard's constant.
    #[test]
    fn a_series_in_any_time(decades in -9.0..9.0_f64, level in -0.95..0.95_f64, digits in 6.0..12.5_f64) {
        let period = 10_f64.powf(decades);
        let omega = 2.0 * PI / period;
        let swing = Hybrid::new()
            .mode("on", move |_t, x: &[f64; 2]| [omega * x[1], -omega * x[0]])
            .series("on", move |_t, [x, v]| [v * omega, x * -omega])
            .edge_with("on", "on", Edge::new(move |_t, x: &[f64; 2]| x[0] - level, |_t, x| *x).affine().entry(Entry::Wait));
        let tolerance = 10_f64.powf(-digits);
        let jumps = times(Simulation::of(&swing).tolerance(tolerance).run("on", [1.0, 0.0], 0.0..3.99 * period)).unwrap();
        prop_assert_eq!(jumps.len(), 4);
        for (turn, t) in jumps.iter().enumerate() {
            let exact = level.acos() / (2.0 * PI) + turn as f64;
            prop_assert!((t / period - exact).abs() < 100.0 * tolerance + 1e-13, "{} instead of {exact}", t / period);
        }
    }

    /// A second is no unit of its own: not where a motion takes 2²⁰⁰ of them.
    #[test]
    fn the_unit_of_time_changes_nothing(power in -200_i32..=200, phase in 0.0..1.0_f64, start in 0_usize..3, method in 0_usize..4) {
        let jumps = |unit: f64| {
            let ball = Hybrid::new()
                .mode("air", move |_t, x: &[f64; 2]| [x[1], -GRAVITY - 0.1 * x[1] * x[1].abs()].map(|rate| rate / unit))
                .edge("air", "air", |_t, x| x[0], move |_t, x| [0.0, -(0.3 + 0.6 * phase) * x[1]])
                .edge("air", "air", |_t, x| 4.0 - x[0], |_t, x| [x[0], -0.5 * x[1]]);
            let x = [[1.0, 4.0 * phase], [0.0, 1.0 + phase], [1.0, 0.0]][start];
            times(Simulation::of(&ball).stepper(methods()[method]).run("air", x, 0.0..0.9 * unit))
                .map(|times| times.iter().map(|t| t / unit).collect::<Vec<_>>())
        };
        let (one, other) = (jumps(1.0).unwrap(), jumps(2_f64.powi(power)).unwrap());
        prop_assert_eq!(one.len(), other.len());
        prop_assert!(one.iter().zip(&other).all(|(t, u)| (t - u).abs() < 1e-7), "{:?} {:?}", one, other);
    }

    /// A coordinate that is small for its unit has its own differences for a Jacobian.
    #[test]
    fn a_small_coordinate_beside_a_large_one(power in 0_i32..=100, e in 0.2..0.9_f64) {
        let slow = 2_f64.powi(-power);
        let ball = Hybrid::new()
            .mode("air", move |_t, x: &[f64; 2]| [x[1], -GRAVITY * slow * slow - 0.1 * x[1] * x[1].abs()])
            .edge("air", "air", |_t, x| x[0], move |_t, x| [0.0, -e * x[1]]);
        let simulation = Simulation::of(&ball).stepper(methods()[2]);
        let jumps = |power: i32| {
            let slow = 2_f64.powi(-power);
            let ball = Hybrid::new()
                .mode("air", move |_t, x: &[f64; 2]| [x[1], -GRAVITY * slow * slow - 0.1 * x[1] * x[1].abs()])
                .edge("air", "air", |_t, x| x[0], move |_t, x| [0.0, -e * x[1]]);
            let run = Simulation::of(&ball).stepper(methods()[0]).run("air", [0.0, 3.5 * slow], 0.0..0.9 / slow).unwrap();
            run.trajectory.jumps().iter().map(|jump| slow * jump.t()).collect::<Vec<_>>()
        };
        let run = simulation.run("air", [0.0, 3.5 * slow], 0.0..0.9 / slow).unwrap();
        let (own, exact) = (run.trajectory.jumps(), jumps(0));
        prop_assert_eq!(own.len(), exact.len());
        prop_assert!(own.iter().zip(&exact).all(|(jump, t)| (slow * jump.t() - t).abs() < 1e-6));
    }

    /// A floor at any height, and any tolerance: a reset that does not turn the ball is an error.
    #[test]
    fn no_ball_falls_through_a_far_floor(
        height in 0.0..9.0_f64,
        digits in 3.0..12.0_f64,
        kept in 0.05..1.0_f64,
        exact: bool,
    ) {
        let (floor, tolerance) = (10_f64.powf(height), 10_f64.powf(-digits));
        // What the tolerance allows for some steps is less than the 40 m that it falls on.
        prop_assume!(tolerance * floor < 0.1);
        let air = |_t: f64, x: &[f64; 2]| [x[1], -GRAVITY];
        let ball = if exact {
            Hybrid::new().exact("air", |_t, x: &[f64; 2]| [*x, [x[1], -GRAVITY], [-0.5 * GRAVITY, 0.0]].into())
        } else {
            Hybrid::new().mode("air", air)
        };
        let ball = ball.edge("air", "air", move |_t, x| x[0] - floor, move |_t, x| [floor, kept * x[1]]);
        let run = Simulation::of(&ball).tolerance(tolerance).run("air", [floor + 1.0, 0.0], 0.0..3.0);
        prop_assert_eq!(run.map(|run| run.end.state[0] - floor).map_err(|failed| failed.error.kind()), Err(ErrorKind::Entry));
    }

    /// A surface is where its function is zero, whatever that is multiplied by.
    #[test]
    fn a_surface_in_any_unit(factor in -15.0..15.0_f64, start in 0.1..1.0_f64, belt in prop_oneof![Just(0.0), 0.01..0.5_f64]) {
        let unit = 10_f64.powf(factor);
        let block = Filippov::of(Sides::new(
            move |t: f64, x: &[f64; 2]| [x[1], -x[0] - 0.4 + 0.3 * t.sin()],
            move |t: f64, x: &[f64; 2]| [x[1], -x[0] + 0.4 + 0.3 * t.sin()],
            move |_t, x: &[f64; 2]| unit * (x[1] - belt),
            move |_t, _x| [0.0, unit],
        ));
        let x = [0.5 + 2.0 * start, 0.0];
        let side = block.side(0.0, &x).unwrap_or(Side::Below);
        let run = Simulation::of(&block).run(side, x, 0.0..20.0);
        prop_assert!(run.is_ok(), "{}", run.err().map(|failed| failed.error.to_string()).unwrap_or_default());
    }

    /// A guard of many turns rounds more than the time at which it is asked, near zero.
    #[test]
    fn a_guard_of_its_own_arithmetic_is_entered(rate in 1.0..9.0_f64, bend in 0.0..0.3_f64, phase in 0.0..3.0_f64) {
        let turn = move |t: f64| (rate * (t + 40.0) + bend * (t + 40.0).powi(2) * 0.25 + phase).sin();
        let relay = Hybrid::new()
            .mode("up", |_t, _x: &f64| 1.0)
            .mode("down", |_t, _x| -1.0)
            .edge("up", "down", move |t, _x| turn(t), |_t, x| *x)
            .edge("down", "up", move |t, _x| -turn(t), |_t, x| *x);
        let mode = if turn(-40.0) > 0.0 { "up" } else { "down" };
        let run = Simulation::of(&relay).run(mode, 0.0, -40.0..20.0);
        prop_assert!(run.is_ok(), "{}", run.err().map(|failed| failed.error.to_string()).unwrap_or_default());
    }

    /// The slow solution of a stiff flow is found between the ends of a step as well.
    #[test]
    fn a_stiff_flow_is_dense(stiff in 1.0..9.0_f64, digits in 4.0..10.0_f64, level in -0.85..0.85_f64, auto: bool) {
        let rate = 10_f64.powf(stiff);
        let relaxed = Hybrid::new()
            .mode("on", move |t: f64, x: &f64| -rate * (x - t.cos()) - t.sin())
            .edge_with("on", "off", Edge::new(move |_t, x: &f64| x - level, |_t, x| *x))
            .mode("off", move |t: f64, x: &f64| -rate * (x - t.cos()) - t.sin())
            .edge_with("off", "on", Edge::new(move |_t, x: &f64| level + 0.1 - x, |_t, x| *x));
        let tolerance = 10_f64.powf(-digits);
        let simulation = Simulation::of(&relaxed).tolerance(tolerance).most_steps(100_000);
        let span = 0.0..8.0 * PI;
        let run = simulation.stepper(methods()[if auto { 3 } else { 2 }]).run("on", 1.0, span);
        let run = run.unwrap();
        prop_assume!(run.end.stop == Stop::Time);
        let (down, up) = (level.acos(), 2.0 * PI - (level + 0.1).acos());
        let exact: Vec<f64> = (0..8).map(|k| [down, up][k % 2] + 2.0 * PI * (k / 2) as f64).collect();
        let found: Vec<f64> = run.trajectory.jumps().iter().map(saltus::Jump::t).collect();
        prop_assert_eq!(found.len(), exact.len());
        for (t, exact) in found.iter().zip(&exact) {
            prop_assert!((t - exact).abs() < 300.0 * tolerance, "{t} instead of {exact}");
        }
    }
}

/// Two balls in one state, the second of which comes to rest while the first one falls.
struct Two {
    floor: f64,
    e: f64,
}

impl Automaton for Two {
    type Mode = bool;
    type State = [f64; 4];
    type Edge = usize;

    fn flow(&self, rests: bool, _t: f64, x: &[f64; 4]) -> [f64; 4] {
        if rests { [x[1], -GRAVITY, 0.0, 0.0] } else { [x[1], -GRAVITY, x[3], -GRAVITY] }
    }

    fn edges(&self, rests: bool) -> Edges<'_, usize> {
        if rests { Edges::from([0]) } else { Edges::from([0, 1]) }
    }

    fn guard(&self, ball: usize, _t: f64, x: &[f64; 4]) -> f64 {
        x[2 * ball] - self.floor
    }

    fn reset(&self, rests: bool, ball: usize, _t: f64, x: &[f64; 4]) -> Result<(bool, [f64; 4]), Refusal> {
        let mut after = *x;
        after[2 * ball] = self.floor;
        after[2 * ball + 1] *= -self.e;
        Ok((rests, after))
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(bool, [f64; 4])> {
        Some((true, [limit.x[0], limit.x[1], self.floor, 0.0]))
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(48)))]

    /// At a limit what does not come to rest goes on: the rounding of the floor hides the last of
    /// the bounces, and the time that they take is not nothing.
    #[test]
    fn the_others_go_on_at_a_limit(height in -4.0..3.0_f64, above in 5.0..30.0_f64, e in 0.2..0.8_f64, method in 0_usize..4) {
        let floor = 10_f64.powf(height);
        let two = Two { floor, e };
        let lands = (2.0 * above / GRAVITY).sqrt();
        let x = [floor + above, 0.0, floor + 0.05, 0.0];
        let run = times(Simulation::of(&two).stepper(methods()[method]).run(false, x, 0.0..lands + 0.1)).unwrap();
        let low = (0.1 / GRAVITY).sqrt() * (1.0 + e) / (1.0 - e);
        prop_assume!(low < 0.9 * lands);
        let landed = run.iter().copied().find(|t| (t - lands).abs() < 0.05).unwrap();
        // Dropped from the height that is hidden, a ball comes to rest in so long a time that the
        // other, going straight, is off its parabola by this.
        let off = HIDDEN * f64::EPSILON * (floor + above) * ((1.0 + e) / (1.0 - e)).powi(2);
        let late = (off / (GRAVITY * lands)).max(1e-9 * lands);
        prop_assert!((landed - lands).abs() < late, "{:e} late", landed - lands);
    }

    /// Whatever the time at which a span ends, zero too, a crossing at its end is taken, and none
    /// that is not there.
    #[test]
    fn the_end_of_a_span(origin in -9.0..9.0_f64, sign: bool, at_zero: bool, speed in 0.5..4.0_f64, hair in 0.0..3.0_f64, method in 0_usize..4) {
        let ramp = Hybrid::new()
            .mode("up", move |_t, _x: &f64| speed)
            .edge("up", "up", |_t, x| 1.0 - x, |_t, _x| 0.0);
        let turn = 1.0 / speed;
        let start = if at_zero { -3.0 * turn } else { 10_f64.powf(origin) * if sign { 1.0 } else { -1.0 } };
        let end = if at_zero { 0.0 } else { start + 3.0 * turn };
        let spacing = start.abs().max(end.abs()).max(1.0) * f64::EPSILON;
        let jumps = times(Simulation::of(&ramp).stepper(methods()[method]).run("up", 0.0, start..end + hair * spacing)).unwrap();
        prop_assert_eq!(jumps.len(), 3, "{:?}", jumps);
    }
}
