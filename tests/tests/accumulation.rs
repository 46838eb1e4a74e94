//! Where jumps accumulate: the two tanks of the textbooks, and what the rounding of coordinates
//! makes of a limit.

use proptest::prelude::*;
use saltus::cross::Doubt;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Cause, Certificate, Hybrid, Simulation, Stop};
use saltus_cases::cases;

/// Inflow and leaks, marks and volumes at the start.
type Case = (f64, [f64; 2], [f64; 2], [f64; 2]);

/// Johansson, Egerstedt, Lygeros, Sastry, Systems & Control Letters 38 (1999) 141: switching
/// accumulates at Σ(x - r)/(v₁ + v₂ - w).
fn meets_the_limit(cases: &[Case]) {
    for &(w, v, marks, start) in cases {
        let limit = (start[0] + start[1] - marks[0] - marks[1]) / (v[0] + v[1] - w);
        let stepped = || {
            Hybrid::new()
                .mode("first", move |_t, _x: &[f64; 2]| [w - v[0], -v[1]])
                .mode("second", move |_t, _x| [-v[0], w - v[1]])
                .edge("first", "second", move |_t, x| x[1] - marks[1], |_t, x| *x)
                .affine()
                .edge("second", "first", move |_t, x| x[0] - marks[0], |_t, x| *x)
                .affine()
        };
        let exact = stepped()
            .exact("first", move |_t, x| [*x, [w - v[0], -v[1]]].into())
            .exact("second", move |_t, x| [*x, [-v[0], w - v[1]]].into());
        for tanks in [stepped(), exact] {
            let run = Simulation::of(&tanks).most_jumps(1000).run("first", start, 0.0..2.0 * limit).unwrap();
            let Stop::Zeno { limit: found } = run.end.stop else { panic!("{}", run.end.stop) };
            assert!((found - limit).abs() < 1e-12 * limit, "{found} {limit}");
            assert!(run.trajectory.doubts().is_empty());
            for jump in run.trajectory.jumps() {
                assert!((0..2).all(|i| jump.before[i] >= marks[i]), "{jump:?}");
            }
            let tanks = tanks.beyond("first", "second", move |_t, _x| marks.map(|mark| mark + 1.0)).beyond(
                "second",
                "second",
                move |_t, _x| marks.map(|mark| mark + 1.0),
            );
            let run = Simulation::of(&tanks).run("first", start, 0.0..limit * (1.0 + 1e-9)).unwrap();
            assert_eq!((run.end.stop, run.end.mode), (Stop::Time, "second"));
            assert_eq!(run.trajectory.jumps().last().map(|jump| jump.cause), Some(Cause::Zeno));
        }
    }
}

#[test]
fn two_tanks() {
    meets_the_limit(&[
        (1.8, [1.0, 1.0], [1.0, 1.0], [2.0, 3.0]),
        (1.5, [1.25, 1.0], [0.5, 0.25], [0.75, 4.0]),
        (0.8, [0.6, 0.7], [0.0, 0.0], [1.0, 1.0]),
    ]);
}

#[test]
fn two_tanks_whose_rounding_is_coarser_than_that_of_time() {
    meets_the_limit(&[(30.0, [20.0, 16.0], [1e3, 1e2], [1005.0, 101.0])]);
}

/// A ball on a floor that is not at zero. Flights lower than half a rounding of the height end late
/// by the time in which it is fallen through, which gives back as much speed as the impact takes:
/// from 5.8e-9 s on, at a height of 1 m, they no longer shrink.
#[test]
fn a_floor_above_zero() {
    for floor in [1e-9, 1.0, 10.0, 1000.0] {
        let ball = Hybrid::new().mode("flight", |_t, x: &[f64; 2]| [x[1], -9.8]).edge(
            "flight",
            "flight",
            move |_t, x| x[0] - floor,
            move |_t, x| [floor, -0.5 * x[1]],
        );
        let run = Simulation::of(&ball).most_jumps(1000).run("flight", [floor + 1.0, 0.0], 0.0..3.0).unwrap();
        let Stop::Zeno { limit } = run.end.stop else { panic!("floor at {floor}: {}", run.end.stop) };
        assert!((limit - 3.0 * (2.0_f64 / 9.8).sqrt()).abs() < 1e-6 * floor.max(1e-6).sqrt(), "{limit}");
    }
}

/// A ball chatters on a table that shakes, in a model that knows no rest and whose reset leaves the
/// height as it is: early and late in time the run ends at the limit, and the ball is never lost
/// below the table.
#[test]
fn no_ball_is_lost_at_the_end_of_a_chatter() {
    let mut seed = 1_u64;
    let mut random = |low: f64, high: f64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let mut limits = 0;
    for late in [0.0, 1.0, 10.0, 240.0, 1e3, 1e5] {
        for _ in 0..100 {
            let (g, a, omega, e) = (9.81, random(0.002, 0.012), random(20.0, 60.0), random(0.2, 0.7));
            let table = Hybrid::new()
                .exact("flight", move |_t, x: &Vector2<f64>| [*x, vector![x[1], -g], vector![-0.5 * g, 0.0]].into())
                .edge(
                    "flight",
                    "flight",
                    move |t, x| x[0] - a * (omega * t).sin(),
                    move |t, x| vector![x[0], a * omega * (omega * t).cos() * (1.0 + e) - e * x[1]],
                );
            let start = late + random(0.0, 1.0);
            let x = vector![random(0.02, 0.12), 0.0];
            let run = Simulation::of(&table).most_jumps(5000).run("flight", x, start..start + 5.0).unwrap();
            let gap = run.end.state[0] - a * (omega * run.trajectory.end().seconds()).sin();
            assert!(gap > -1e-4, "lost at {start}: a = {a}, omega = {omega}, e = {e}: {gap} m, {:?}", run.end.stop);
            limits += usize::from(matches!(run.end.stop, Stop::Zeno { .. }));
        }
    }
    assert!(limits > 450, "{limits} of 600");
}

/// A ball on a floor so high up that rounding hides its flights, whose rebound is a function of the
/// speed of impact.
fn hidden<'a>(floor: f64, rebound: impl Fn(f64) -> f64 + Send + Sync + 'a) -> Hybrid<'a, [f64; 2]> {
    Hybrid::new()
        .mode("fly", |_t, x: &[f64; 2]| [x[1], -9.81])
        .edge("fly", "fly", move |_t, x| x[0] - floor, move |_t, x| [floor, rebound(-x[1])])
        .affine()
        .mode("rest", |_t, _x| [0.0; 2])
        .beyond("fly", "rest", move |_t, _x| [floor, 0.0])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(64)))]

    /// v (1 - (v/c)ᵖ) rests late, v/(1 + v/c) never: the last ratio bounds neither.
    #[test]
    fn ratios_that_rise_to_one_certify_no_limit(
        floor in 1.5..4.0_f64, power in 0.2..1.0_f64, loss in 0.1..0.6_f64, harmonic: bool, drop in 0.02..2.0_f64,
    ) {
        let floor = 10_f64.powf(floor);
        let loses = move |v: f64| if harmonic { v / (1.0 + v / loss) } else { v * (1.0 - loss * v.min(1.0).powf(power)) };
        let ball = hidden(floor, loses);
        let mut certificate = Certificate::new();
        let start = [floor + drop, 0.0];
        let end = Simulation::of(&ball).most_jumps(20_000).drive("fly", start, 0.0..100.0, &mut certificate);
        let Ok(end) = end else { return Ok(()) };
        prop_assert_eq!(end.limits.count, end.limits.uncertified, "{:?}", end);
        // Who goes on from such a limit is warned.
        let doubts = certificate.doubts().iter().filter(|doubt| doubt.evidence.doubt() == Some(Doubt::Accumulated));
        prop_assert_eq!(doubts.count(), end.limits.count);
    }

    #[test]
    fn ratios_that_stay_certify_their_limit(
        floor in 1.5..4.0_f64, cor in 0.1..0.97_f64, drop in 0.02..2.0_f64, fast in 0.0..0.05_f64,
    ) {
        let floor = 10_f64.powf(floor);
        // Faster impacts lose some more.
        let ball = hidden(floor, move |v| v * cor / (1.0 + fast * v));
        let run = Simulation::of(&ball).most_jumps(20_000).run("fly", [floor + drop, 0.0], 0.0..1000.0).unwrap();
        prop_assert_eq!((run.end.limits.count, run.end.limits.uncertified), (1, 0), "{:?}", run.end);
    }
}
