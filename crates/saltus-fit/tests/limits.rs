//! Limits that decide what is found, each met from both sides: with ten times more or less of any
//! of them a test here fails.

use crate::noise::Noise;
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

/// Means hide how far the COR differs from drop to drop: where the table says that its readings are
/// means, the interval allows for a twentieth of it, over the root of as many as are said.
#[test]
fn means_do_not_hide_how_far_drops_differ() {
    let mut noise = Noise(3);
    let mut held = [0; 2];
    let mut longer = 0;
    for _ in 0..200 {
        let mut heights = [0.0; 4];
        for _ in 0..5 {
            let e = 0.7 * (1.0 + noise.normal(0.05));
            for (n, height) in (1..).zip(&mut heights) {
                *height += 200.0 * e.powi(2 * n) / 5.0;
            }
        }
        let rows: String = (1..).zip(heights).map(|(n, h)| format!("{n},{:.1}\n", h + noise.normal(0.3))).collect();
        let table = format!("bounce,height_cm\n0,200\n{rows}");
        // The zero and the air are known.
        let fit = |text: &str| Fit::new().drag(0.0).sigma_zero(1e-4).sigma_height(0.003).run(&read(text)).unwrap();
        let both = [fit(&table), fit(&format!("Means of five drops\n{table}"))].map(|report| *report.cor().unwrap());
        for (held, cor) in held.iter_mut().zip(&both) {
            *held += usize::from((cor.low..=cor.high).contains(&0.7));
        }
        longer += usize::from(both[1].high - both[1].low > both[0].high - both[0].low);
    }
    assert!(held[0] < 120 && held[1] > 180 && longer == 200, "{held:?} {longer}");
}
