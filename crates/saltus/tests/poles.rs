//! Guards that change sign without coming to zero: a pole is no crossing, a leap is one that is
//! doubted, and a steep root is neither.

use std::f64::consts::PI;

use proptest::prelude::*;
use saltus::cross::Doubt;
use saltus::{Certificate, Entry, Hybrid, Simulation};
use saltus_cases::cases;

/// The times of the jumps where `guard` of time falls, and of the doubts that its continuity
/// leaves.
fn falls(guard: impl Fn(f64) -> f64 + Send + Sync, start: f64, span: f64) -> (Vec<f64>, Vec<f64>) {
    let clock = Hybrid::new()
        .mode("run", |_t, _x: &f64| 1.0)
        .edge("run", "run", move |t, _x| guard(t), |_t, x| *x)
        .entry(Entry::Wait);
    let mut certificate = Certificate::new();
    let mut times = Vec::new();
    let simulation = Simulation::of(&clock).most_jumps(1000);
    let run = simulation.run("run", 0.0, start..start + span).unwrap();
    times.extend(run.trajectory.jumps().iter().map(saltus::Jump::t));
    simulation.drive("run", 0.0, start..start + span, &mut certificate).unwrap();
    let broken = |doubt: &&saltus::Inspection<_, _>| doubt.evidence.doubt() == Some(Doubt::Discontinuous);
    let doubts = certificate.doubts().iter().filter(broken).filter_map(|doubt| Some(doubt.doubt()?.start));
    (times, doubts.collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(128)))]

    #[test]
    fn a_pole_is_no_crossing(
        place in 0.05..0.95_f64, order in 0_i32..3, start in prop::sample::select(vec![0.0, 1.0, 1e3]),
        size in -12..12_i32, span in -3..3_i32,
    ) {
        let (size, span) = (10.0_f64.powi(size), 10.0_f64.powi(span));
        let pole = start + place * span;
        let (times, doubts) = falls(|t| size / ((pole - t) / span).powi(2 * order + 1), start, span);
        prop_assert_eq!(times, Vec::<f64>::new());
        prop_assert_eq!(doubts.len(), 1);
        prop_assert!((doubts[0] - pole).abs() < 1e-9 * span.max(start), "{} instead of {pole}", doubts[0]);
    }

    #[test]
    fn a_leap_is_a_crossing_with_a_doubt(place in 0.05..0.95_f64, high in 0.1..10.0_f64, low in 0.1..10.0_f64) {
        let (times, doubts) = falls(|t| if t < place { high } else { -low }, 0.0, 1.0);
        prop_assert!(times.len() == 1 && (times[0] - place).abs() < 1e-15, "{times:?}");
        prop_assert_eq!(doubts.len(), 1);
    }

    /// Also a guard whose slope is endless at its root, and one that is flat there.
    #[test]
    fn a_root_is_not_doubted(place in 0.05..0.95_f64, size in -12..12_i32, kind in 0..3) {
        let size = 10.0_f64.powi(size);
        let guard = move |t: f64| size * match kind {
            0 => place - t,
            1 => (place - t).cbrt(),
            _ => (place - t).powi(3),
        };
        let (times, doubts) = falls(guard, 0.0, 1.0);
        prop_assert!(times.len() == 1 && (times[0] - place).abs() < 1e-5, "{times:?}");
        prop_assert_eq!(doubts, Vec::<f64>::new());
    }

    /// 1/tan falls through zero between poles through which it rises, tan through poles only.
    #[test]
    fn roots_between_poles_are_found(omega in 0.3..3.0_f64, phase in 0.1..3.0_f64) {
        let falls_of = |shift: f64| ((omega * 10.0 + phase - shift) / PI).floor() - ((phase - shift) / PI).floor();
        prop_assume!((1..40).all(|k| (omega * 10.0 + phase - f64::from(k) * PI / 2.0).abs() > 1e-6));
        let (times, _) = falls(|t| 1.0 / (omega * t + phase).tan(), 0.0, 10.0);
        prop_assert_eq!(times.len() as f64, falls_of(PI / 2.0), "{:?}", times);
        let (times, doubts) = falls(|t| (omega * t + phase).tan(), 0.0, 10.0);
        prop_assert_eq!(times, Vec::<f64>::new());
        prop_assert!(!doubts.is_empty() || falls_of(PI / 2.0) == 0.0);
    }
}
