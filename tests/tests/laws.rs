//! What holds for every ball: the floor holds, time goes forwards, energy is not made, spans may be
//! split and units changed.

use proptest::prelude::*;
use saltus::nalgebra::{Vector2, vector};
use saltus::{RunOf, Simulation};
use saltus_bounce::{Ball, Cor, Mode};
use saltus_cases::cases;

fn run(g: f64, e: f64, start: Vector2<f64>, span: std::ops::Range<f64>) -> RunOf<Ball> {
    let ball = Ball::new(g, Cor::new(e).unwrap()).unwrap();
    Simulation::of(&ball).most_jumps(2000).run(Mode::Flight, start, span).unwrap()
}

fn energy(g: f64, x: &Vector2<f64>) -> f64 {
    g * x[0] + 0.5 * x[1] * x[1]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(400), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_floor_holds_and_energy_is_not_made(
        g in 1e-3..100.0_f64, e in 0.0..=1.0_f64, h in 0.0..10.0_f64, v in -20.0..20.0_f64, end in 0.0..50.0_f64,
    ) {
        prop_assume!(h > 0.0 || v >= 0.0);
        let run = run(g, e, vector![h, v], 0.0..end);
        let mut last = (0.0, energy(g, &vector![h, v]));
        for jump in run.trajectory.jumps() {
            prop_assert!(jump.t() >= last.0, "time went back to {}", jump.t());
            prop_assert!(jump.before[0] >= 0.0 && jump.after[0] >= 0.0);
            prop_assert!(jump.before[1] <= 0.0 || jump.edge().is_none());
            // The reset is the law, to the bit.
            if jump.edge().is_some() {
                prop_assert_eq!(jump.after[1], e * -jump.before[1]);
            }
            let now = energy(g, &jump.after);
            prop_assert!(now <= last.1 * (1.0 + 1e-14), "energy rose from {} to {now}", last.1);
            last = (jump.t(), now);
        }
        let last = run.trajectory.end().seconds();
        for k in 0..=500_u32 {
            let t = last * (f64::from(k) / 500.0);
            let x = run.trajectory.at(t).unwrap();
            prop_assert!(x[0] >= 0.0, "{} at {t}", x[0]);
        }
    }

    #[test]
    fn splitting_the_span_changes_nothing(e in 0.1..0.95_f64, h in 0.1..5.0_f64, cut in 0.01..3.0_f64) {
        let whole = run(9.81, e, vector![h, 0.0], 0.0..3.0);
        let first = run(9.81, e, vector![h, 0.0], 0.0..cut);
        prop_assume!(first.end.mode == Mode::Flight);
        let ball = Ball::new(9.81, Cor::new(e).unwrap()).unwrap();
        let second = Simulation::of(&ball).run(first.end.mode, first.end.state, cut..3.0).unwrap();
        let (x, y) = (whole.end.state, second.end.state);
        // A split flight rounds its start; the difference grows with each flight that remains.
        prop_assert!((x - y).norm() < 1e-9, "{x:?} {y:?}");
    }

    #[test]
    fn units_do_not_matter(e in 0.1..0.95_f64, h in 0.1..5.0_f64, power in -40_i32..40) {
        // Lengths scaled by a power of four, times by its root: the same motion to the bit.
        let (length, time) = (4.0_f64.powi(power), 2.0_f64.powi(power));
        let one = run(9.81, e, vector![h, 0.0], 0.0..2.0);
        let two = run(9.81, e, vector![h * length, 0.0], 0.0..2.0 * time);
        prop_assert_eq!(one.trajectory.jumps().len(), two.trajectory.jumps().len());
        for (a, b) in one.trajectory.jumps().iter().zip(two.trajectory.jumps()) {
            prop_assert_eq!(a.t() * time, b.t());
            prop_assert_eq!(a.after[1] * (length / time), b.after[1]);
        }
    }
}
