//! A guard that turns within the error of a step: the crossing is right, or doubted.

use std::f64::consts::TAU;

use nalgebra::{Vector2, vector};
use proptest::prelude::*;
use saltus::cross::Doubt;
use saltus::{Certificate, Entry, Filippov, Hybrid, Side, Sides, Simulation};
use saltus_cases::cases;

use crate::methods::methods;

/// How often a guard falls that turns `miss` above zero (below, if negative) three times, at x = -1
/// of an oscillator, in three forms; and how often that is doubted. With the `sign` -1 it is below
/// zero elsewhere, and comes up to there.
fn falls(
    method: usize,
    tolerance: f64,
    (form, affine, sign): (usize, bool, f64),
    (miss, scale): (f64, f64),
    (phase, rate): (f64, f64),
) -> (usize, usize) {
    let mut oscillator = Hybrid::new()
        .mode("swing", move |_t, x: &[f64; 2]| [x[1] * rate, -x[0] * rate])
        .edge(
            "swing",
            "swing",
            move |_t, x| {
                sign * scale
                    * match form {
                        0 => x[0] + 1.0 + miss,
                        1 => (1.0 + miss - x[0]) * (1.0 + miss + x[0]) * (2.0 - x[0]),
                        _ => (1.0 + miss + x[0]) * (3.0 + x[1]),
                    }
            },
            |_t, x| *x,
        )
        .entry(Entry::Wait);
    if affine && form == 0 {
        oscillator = oscillator.affine();
    }
    let mut certificate = Certificate::new();
    let simulation = Simulation::of(&oscillator).stepper(methods()[method]).tolerance(tolerance);
    let (x, span) = ([phase.cos(), -phase.sin()], 0.0..3.0 * TAU / rate);
    let end = simulation.drive("swing", x, span, &mut certificate);
    let doubts = certificate.doubts();
    // Which of the others it is, rounding decides.
    let far = |doubt: Doubt| matches!(doubt, Doubt::Unresolved | Doubt::Missed);
    assert!(!doubts.iter().any(|doubt| doubt.evidence.doubt().is_some_and(far)), "{doubts:?}");
    (end.unwrap().jumps, doubts.len())
}

/// How often an edge is taken that changes nothing but a count, and whose guard falls once, at
/// `fall`, with a `slope` that may be below what the steps are off by; and whether that is certain.
fn slow_falls(method: usize, tolerance: f64, slope: f64, (rate, fall): (f64, f64)) -> (f64, bool) {
    let wave = Hybrid::new()
        .mode("run", move |t, _: &Vector2<f64>| vector![rate * (rate * t).cos(), 0.0])
        .edge("run", "run", move |t, x| slope * (fall - t) + (x[0] - (rate * t).sin()), |_t, x| x + Vector2::y())
        .entry(Entry::Wait);
    let simulation = Simulation::of(&wave).stepper(methods()[method]).tolerance(tolerance).most_jumps(300);
    let run = simulation.run("run", Vector2::zeros(), 0.0..10.0).unwrap();
    // What the tolerance allows in x, |x| ≤ 1, after so many steps.
    let allowed = 4.0 * run.end.stats.steps as f64 * 2.0 * tolerance;
    let missed = run.end.jumps == 0 && slope * (10.0 - fall) <= allowed;
    (run.end.state[1], run.trajectory.doubts().is_empty() && !missed)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// A fall that is slower than the error of the steps, or than rounding shows, is taken once, or
    /// in doubt.
    #[test]
    fn a_fall_slower_than_its_error_is_taken_once_or_doubted(
        method in 0..4_usize,
        digits in 3.0..14.0_f64,
        share in -1.0..9.0_f64,
        rate in 0.5..10.0_f64,
        fall in 0.7..9.0_f64,
    ) {
        let tolerance = 10.0_f64.powf(-digits);
        let (count, certain) = slow_falls(method, tolerance, tolerance * 10.0_f64.powf(share), (rate, fall));
        prop_assert!(count == 1.0 || !certain, "{count}");
    }

    /// What the error of the steps decides is doubted, and nothing else is.
    #[test]
    fn what_the_error_of_a_step_decides_is_doubted(turn in turns()) {
        decided(1.0, turn)?;
    }

    /// The same from below, for an edge that waits.
    #[test]
    fn what_comes_up_to_within_the_error_of_a_step_is_doubted(turn in turns()) {
        decided(-1.0, turn)?;
    }
}

/// A guard that turns near zero: the method and the digits of its tolerance; the form of the guard,
/// whether that is promised affine and whether it misses zero; by how much, and in which unit; the
/// phase and the rate.
type Turn = (usize, f64, usize, (bool, bool), (f64, f64), (f64, f64));

fn turns() -> impl Strategy<Value = Turn> {
    (
        0..4_usize,
        3.0..12.0_f64,
        0..3_usize,
        any::<(bool, bool)>(),
        (2.0..14.0_f64, -3.0..3.0_f64),
        (0.0..3.0_f64, -1.0..1.5_f64),
    )
}

/// Of a guard that comes near zero from this `side` its falls are as many as they are, or doubted;
/// and doubted only where the error of the steps is as large as what it misses zero by.
fn decided(side: f64, turn: Turn) -> Result<(), TestCaseError> {
    let (method, digits, form, (affine, misses), (miss, scale), (phase, rate)) = turn;
    let [tolerance, scale, rate] = [-digits, scale, rate].map(|power| 10_f64.powf(power));
    let miss = 10_f64.powf(-miss) * if misses { 1.0 } else { -1.0 };
    let (jumps, doubts) = falls(method, tolerance, (form, affine, side), (miss, scale), (phase, rate));
    let right = if misses {
        0
    } else if form == 1 {
        6
    } else {
        3
    };
    prop_assert!(jumps == right || doubts > 0, "{jumps} falls instead of {right}, and no doubt");
    prop_assert!(miss.abs() < 1e4 * tolerance || doubts == 0, "{doubts} doubts, {jumps} falls");
    Ok(())
}

/// The end of ten bounces of a ball with drag, dropped from a height in a unit in which that is
/// `size`; and the doubts.
fn bounces(size: f64, tolerance: f64) -> (f64, usize) {
    let ball = Hybrid::new()
        .mode("flight", move |_t, x: &[f64; 2]| [x[1], -9.81 * size - 0.3 / size * x[1] * x[1].abs()])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| [x[0], -0.85 * x[1]]);
    let mut certificate = Certificate::new();
    let simulation = Simulation::of(&ball).tolerance(tolerance).most_jumps(10).most_steps(2000);
    let end = simulation.drive("flight", [size, 0.0], 0.0..f64::INFINITY, &mut certificate).unwrap();
    (end.time.seconds(), certificate.doubts().len())
}

/// Units do not matter, or the run is doubted: where two digits of a bounce are below the absolute
/// tolerance.
#[test]
fn a_motion_below_the_absolute_tolerance_is_doubted() {
    for tolerance in [1e-6, 1e-9, 1e-11] {
        let (right, _) = bounces(1.0, tolerance);
        for power in -40..=24 {
            let size = 10_f64.powf(0.5 * f64::from(power));
            let (end, doubts) = bounces(size, tolerance);
            let off = (end - right).abs() / right;
            assert!(off < 1e-3 || doubts > 0, "of size {size:e} at {tolerance:e}: off by {off:e}, and no doubt");
            assert!(doubts == 0 || size < 1e4 * tolerance, "of size {size:e} at {tolerance:e}: {doubts} doubts");
        }
    }
}

proptest! {
    /// A slide is left tangentially, from zero: that start is no least value in doubt, at any
    /// tolerance.
    #[test]
    fn a_slide_is_left_without_a_doubt(strength in 1.05..4.0_f64, phase in 0.0..TAU, decades in 6..13_i32, method in 0..4_usize) {
        let push = move |t: f64| strength * (t + phase).sin();
        let relay = Sides::new(move |t, _: &f64| push(t) - 1.0, move |t, _| push(t) + 1.0, |_, x| *x, |_, _| 1.0);
        let relay = Filippov::of(relay.affine());
        let simulation = Simulation::of(&relay).stepper(methods()[method]).tolerance(10.0_f64.powi(-decades));
        let run = simulation.run(Side::Above, 1.0, 0.0..30.0).unwrap();
        prop_assert!(run.trajectory.jumps().len() > 6);
        let left = |t| run.trajectory.jumps().iter().any(|jump| jump.from == Side::Sliding && jump.time == t);
        prop_assert!(!run.trajectory.doubts().iter().any(|doubt| left(doubt.start)), "{:?}", run.trajectory.doubts());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// A motion along a wall and off it, from rest, in any unit: it meets the wall again where it
    /// does, or that is doubted, which it is where the absolute tolerance is large beside it.
    #[test]
    fn a_start_at_a_wall_below_the_absolute_tolerance_is_doubted(
        method in 0..4_usize,
        digits in 3.0..11.0_f64,
        (size, time) in (-8.0..8.0_f64, -6.0..6.0_f64),
        power in 2..4_i32,
        affine: bool,
    ) {
        let tolerance = 10_f64.powf(-digits);
        let (size, time) = (1e-3 * tolerance * 10_f64.powf(size), 10_f64.powf(time));
        // y = s^m - s^(m + 1), with s = t / time.
        let m = f64::from(power);
        let pull = move |s: f64| m * (m - 1.0) * s.powi(power - 2) - (m + 1.0) * m * s.powi(power - 1);
        let hill = Hybrid::new()
            .mode("up", move |t, x: &[f64; 2]| [x[1] / time, size * pull(t / time) / time])
            .terminal("up", |_t, x| x[0]);
        let hill = if affine { hill.affine() } else { hill };
        let simulation = Simulation::of(&hill).stepper(methods()[method]).tolerance(tolerance);
        let run = simulation.run("up", [0.0, 0.0], 0.0..1.5 * time).unwrap();
        let (landed, doubts) = (run.trajectory.end().seconds() / time, run.trajectory.doubts().len());
        let right = run.end.jumps == 1 && (landed - 1.0).abs() < 0.01 + 100.0 * tolerance;
        prop_assert!(right || doubts > 0, "size {size:e} time {time:e}: {} jumps, at {landed}", run.end.jumps);
        let grazes = run.trajectory.doubts().iter().any(|doubt| doubt.evidence.doubt() == Some(Doubt::Grazing));
        prop_assert!(!grazes || size < 1e4 * tolerance, "{:?}", run.trajectory.doubts());
    }
}
