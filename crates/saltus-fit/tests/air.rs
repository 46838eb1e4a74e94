//! The air in times of contacts: where they show it, the COR is that of the contacts alone.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{FindingKind, Fit, ReadOptions, Report, Table, Verdict};

use crate::noise::Noise;

const G: f64 = 9.81;

/// When a ball touches the floor that is dropped from `height`: v' = −g ∓ k v² in closed form, with
/// a COR by the speed of impact. Times are off by 0.1 ms each.
fn contacts(height: f64, k: f64, count: usize, cor: impl Fn(f64) -> f64, seed: u64) -> Vec<f64> {
    let falls = |height: f64| {
        let a = (k * height).exp();
        ((a + (a * a - 1.0).sqrt()).ln() / (k * G).sqrt(), (G / k * (1.0 - (-2.0 * k * height).exp())).sqrt())
    };
    let rises =
        |speed: f64| ((speed * (k / G).sqrt()).atan() / (k * G).sqrt(), (1.0 + k * speed * speed / G).ln() / (2.0 * k));
    let mut noise = Noise(seed);
    let (mut time, mut speed) = falls(height);
    let mut found = Vec::new();
    for _ in 0..count {
        found.push(time + noise.normal(1e-4));
        let (up, height) = rises(cor(speed) * speed);
        let (down, next) = falls(height);
        (time, speed) = (time + up + down, next);
    }
    found
}

/// The fit of times read by a clock that runs so many times as fast.
fn fitted(times: &[f64], clock: f64) -> Report {
    let rows: String = times.iter().enumerate().map(|(n, t)| format!("{},{:.5}\n", n + 1, clock * t)).collect();
    let text = format!("bounce,time_s\n{rows}");
    Fit::new().run(&Table::parse("contacts.csv", text.as_bytes(), &ReadOptions::default()).unwrap()).unwrap()
}

fn shows(report: &Report) -> bool {
    report.findings().iter().any(|finding| matches!(finding.kind, FindingKind::AirShows { .. }))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(40)))]

    /// A light ball loses much of its speed in the air: the COR is found beside that, whatever the
    /// clock runs at.
    #[test]
    fn the_air_of_a_light_ball_is_no_loss_of_its_bounces(
        e in 0.85..0.93_f64, k in 0.11..0.14_f64, height in 0.4..1.2_f64, count in 14..24_usize, slow: bool, seed: u64,
    ) {
        let times = contacts(height, k, count, |_| e, seed);
        let report = fitted(&times, if slow { 4.0 } else { 1.0 });
        let cor = report.cor().unwrap();
        prop_assert!(shows(&report) && report.verdict() == Verdict::Trusted, "{}", report);
        prop_assert!((cor.value - e).abs() < 0.004 && cor.low < e && e < cor.high, "{}", report);
    }

    /// A heavy ball whose COR falls with speed is not taken for a light one.
    #[test]
    fn a_cor_that_falls_with_speed_is_no_air(
        e in 0.7..0.9_f64, falls in 0.02..0.08_f64, count in 8..20_usize, seed: u64,
    ) {
        let first = (2.0 * G).sqrt();
        let report = fitted(&contacts(1.0, 1e-6, count, |v| e * (1.0 - falls * v / first), seed), 1.0);
        prop_assert!(!shows(&report), "{}", report);
    }
}
