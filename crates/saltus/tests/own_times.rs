//! An arc is judged by its own time and its own numbers: after a phase as long as may be before it,
//! on a stiff flow that steps shortly to its crossing, from a reset out of a pole.

use std::f64::consts::{FRAC_PI_2, TAU};

use proptest::prelude::*;
use saltus::{Entry, Hybrid, Simulation, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// Waits, then turns so fast, and counts its passages through zero; what lies beyond a limit is
/// another mode.
fn wait_and_turn(until: f64, rate: f64) -> Hybrid<'static, [f64; 2]> {
    Hybrid::new()
        .mode("wait", |_t, _x: &[f64; 2]| [0.0; 2])
        .switch("wait", "turn", move |t, _x| until - t)
        .mode("turn", move |_t, x| [rate * x[1], -rate * x[0]])
        .edge("turn", "turn", |_t, x| x[0], |_t, x| *x)
        .entry(Entry::Wait)
        .mode("lost", |_t, x| *x)
        .beyond("turn", "lost", |_t, x| *x)
}

/// x'' = μ (1 - x²) x' - x, whose passages through zero are counted.
fn relaxation(mu: f64) -> Hybrid<'static, [f64; 2]> {
    Hybrid::new()
        .mode("run", move |_t, x: &[f64; 2]| [x[1], mu * (1.0 - x[0] * x[0]) * x[1] - x[0]])
        .edge("run", "run", |_t, x| x[0], |_t, x| *x)
        .entry(Entry::Wait)
        .mode("lost", |_t, x| *x)
        .beyond("run", "lost", |_t, x| *x)
}

/// x' = x² up to `cap`, and again from `start`.
fn spike(cap: f64, start: f64) -> Hybrid<'static, f64> {
    Hybrid::new().mode("rise", |_t, x: &f64| x * x).edge("rise", "rise", move |_t, x| cap - x, move |_t, _x| start)
}

/// Waits, then bounces without loss over a floor, so low that no flight is a spacing of the time.
fn wait_and_bounce(until: f64, speed: f64) -> Hybrid<'static, [f64; 2]> {
    Hybrid::new()
        .mode("wait", |_t, _x: &[f64; 2]| [0.0; 2])
        .edge("wait", "bounce", move |t, _x| until - t, move |_t, _x| [0.0, speed])
        .exact("bounce", |_t, x: &[f64; 2]| [*x, [x[1], -2.0], [-1.0, 0.0]].into())
        .edge("bounce", "bounce", |_t, x| x[0], |_t, x| [0.0, -x[1]])
        .affine()
        .mode("rest", |_t, _x| [0.0; 2])
        .beyond("bounce", "rest", |_t, _x| [0.0; 2])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(96)))]

    /// A turn may be as short as a hundred spacings of the time.
    #[test]
    fn passages_after_a_quiet_phase_are_all_counted(
        method in 0..4_usize, exponent in 0.0..9.0_f64, spacings in 2.3..6.0_f64, turns in 1.0..40.0_f64,
        digits in 6.0..10.0_f64,
    ) {
        let until = 10_f64.powf(exponent);
        let rate = TAU / (10_f64.powf(spacings) * f64::EPSILON * until);
        let angle = TAU * (turns.floor() + 0.5);
        let model = wait_and_turn(until, rate);
        let simulation = Simulation::of(&model).stepper(methods()[method]).tolerance(10_f64.powf(-digits));
        // A step may be shorter than a spacing of the time, and says so.
        let Ok(run) = simulation.run("wait", [1.0, 0.0], 0.0..until + angle / rate) else { return Ok(()) };
        // The end of the span is rounded by a part of a turn.
        let due = |angle: f64| 1 + ((angle - FRAC_PI_2) / TAU).floor() as usize;
        prop_assert!(run.end.stop == Stop::Time && run.end.mode == "turn", "{:?}", run.end);
        let counted = run.end.jumps - 1;
        prop_assert!((due(angle - 0.2)..=due(angle + 0.2)).contains(&counted), "{counted} of {}", due(angle));
    }

    /// Their times come from a tolerance of 1e-10, and agree to what is left of it.
    #[test]
    fn a_stiff_flow_passes_its_guard_as_often_by_every_tolerance(exponent in 3.0..6.5_f64, digits in 7.0..9.5_f64) {
        let mu = 10_f64.powf(exponent);
        let model = relaxation(mu);
        let run = Simulation::of(&model).tolerance(10_f64.powf(-digits)).run("run", [2.0, 0.0], 0.0..6.0 * mu).unwrap();
        prop_assert_eq!((run.end.stop, run.end.jumps, run.end.limits.count), (Stop::Time, 4, 0));
        let period = run.trajectory.jumps()[1].t() - run.trajectory.jumps()[0].t();
        prop_assert!((period / mu / (3.0 - 2.0 * 2_f64.ln()) - 1.0).abs() < 0.08, "{}", period / mu);
    }

    /// x = 1/(1/start - t): the edge is taken at its guard, not from inside.
    #[test]
    fn a_reset_out_of_a_pole_begins_anew(
        method in 0..4_usize, scale in -9.0..3.0_f64, decades in 2.0..40.0_f64, digits in 7.0..10.0_f64,
    ) {
        let start = 10_f64.powf(scale);
        let cap = start * 10_f64.powf(decades);
        let model = spike(cap, start);
        let simulation = Simulation::of(&model).stepper(methods()[method]).tolerance(10_f64.powf(-digits));
        let Ok(run) = simulation.absolute_tolerance(1e-12 * start).run("rise", start, 0.0..3.5 / start) else {
            return Ok(());
        };
        for (n, jump) in (1..).zip(run.trajectory.jumps()) {
            prop_assert!((jump.before / cap - 1.0).abs() < 1e-6, "{}: {:?}", n, jump);
            let due = f64::from(n) * (1.0 / start - 1.0 / cap);
            prop_assert!((jump.t() / due - 1.0).abs() < 1e-4, "{}: {:?}", n, jump);
        }
        prop_assert_eq!(run.end.jumps, if decades < 2.5 { run.end.jumps } else { 3 });
    }

    /// Ratios of one but for rounding are no contraction.
    #[test]
    fn a_ball_that_loses_nothing_never_rests(exponent in 0.0..10.0_f64, part in 0.01..1.0_f64) {
        let until = 10_f64.powf(exponent);
        let model = wait_and_bounce(until, part * f64::EPSILON * until);
        let simulation = Simulation::of(&model).most_jumps(2000);
        let end = simulation.drive("wait", [0.0, 0.0], 0.0..10.0 * until, &mut ()).unwrap();
        prop_assert!(end.stop == Stop::Jumps { most: 2000 } && end.limits.count == 0, "{:?}", end);
    }

    /// A ball that loses only in one bounce of a few rests where the series has its limit.
    #[test]
    fn losses_that_come_in_turn_add_up(count in 1..=8_i32, e in 0.2..0.9_f64, method in 0..4_usize) {
        let model = Hybrid::new()
            .mode("flight", |_t, x: &[f64; 3]| [x[1], -2.0, 0.0])
            .edge("flight", "flight", |_t, x| x[0], move |_t, x| {
                let next = (x[2] + 1.0) % f64::from(count);
                [0.0, -x[1] * if next == 0.0 { e } else { 1.0 }, next]
            })
            .mode("rest", |_t, _x| [0.0; 3])
            .beyond("flight", "rest", |_t, _x| [0.0; 3]);
        let limit = f64::from(count) / (1.0 - e);
        let run = Simulation::of(&model).stepper(methods()[method]).run("flight", [0.0, 1.0, 0.0], 0.0..2.0 * limit);
        let found = run.unwrap().end.limits;
        prop_assert!(found.count == 1 && found.last.is_some_and(|last| (last / limit - 1.0).abs() < 1e-9), "{:?}", found);
    }
}
