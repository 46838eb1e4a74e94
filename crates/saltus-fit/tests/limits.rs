//! Limits that decide what is found, each met from both sides: with ten times more or less of any
//! of them a test here fails.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod noise;

use noise::Noise;
use saltus_fit::{FindingKind, Fit, ReadOptions, Report, Table};

fn read(text: &str) -> Table {
    Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).unwrap()
}

fn fit(text: &str) -> Report {
    Fit::new().run(&read(text)).unwrap()
}

/// Contacts in pairs are heard twice up to 50 ms apart; further apart they are two events.
#[test]
fn what_comes_later_than_an_echo_is_none() {
    let heard_twice = |apart: f64| {
        let (mut time, mut flight, mut times) = (0.3, 2.4, Vec::new());
        for _ in 0..6 {
            times.extend([time, time + apart]);
            time += flight;
            flight *= 0.8;
        }
        let report = Fit::new().run(&Table::from_contacts(&times).unwrap()).unwrap();
        report.findings().iter().any(|f| matches!(f.kind, FindingKind::Pairs { .. }))
    };
    assert!(heard_twice(0.045) && heard_twice(0.01));
    assert!(!heard_twice(0.055) && !heard_twice(0.2));
}

/// CORs that differ between heights of release speak of the speed only where the heights differ by
/// more than a twentieth.
#[test]
fn heights_that_hardly_differ_are_no_speeds() {
    let compared = |heights: [f64; 3]| {
        let mut noise = Noise(11);
        let mut text = "h0_cm,trial,bounce,height_cm\n".to_owned();
        for (&h, e) in heights.iter().zip([0.80f64, 0.76, 0.72]) {
            for trial in 1..=4 {
                for n in 0..4 {
                    let read = if n == 0 { h } else { h * e.powi(2 * n) + noise.normal(0.05) };
                    text += &format!("{h},{trial},{n},{read:.2}\n");
                }
            }
        }
        !fit(&text).models().is_empty()
    };
    assert!(compared([80.0, 100.0, 125.0]), "a quarter");
    assert!(compared([90.0, 97.0, 105.0]), "a thirteenth");
    assert!(!compared([98.0, 100.0, 102.0]), "a fiftieth");
}
