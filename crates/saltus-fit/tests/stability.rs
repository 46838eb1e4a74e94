//! The same COR whatever the unit, the size and the weights of a table: to 1e-9 that of the
//! well-scaled one.

use crate::noise::Noise;
use saltus_fit::{Fit, ReadOptions, Report, Table};

fn cor(report: &Report) -> f64 {
    report.cor().unwrap_or_else(|| panic!("{report}")).value
}

fn parse(text: &str) -> Table {
    Table::parse("planted", text.as_bytes(), &ReadOptions::default()).expect("a table")
}

const READ: [f64; 6] = [1.0, 0.642, 0.408, 0.263, 0.167, 0.108];

#[test]
fn from_micrometres_to_thousands_of_kilometres() {
    let run = |scale: f64| {
        let heights: Vec<f64> = READ.iter().map(|h| h * scale).collect();
        // The zero and the air are of a size of their own: they are stated.
        let fit = Fit::new().sigma_height(0.002 * scale).sigma_zero(0.0).drag(0.0);
        fit.run(&Table::from_heights(&heights).unwrap()).unwrap()
    };
    let reference = run(1.0);
    for exponent in -6..=6 {
        let scaled = run(10f64.powi(exponent));
        assert!((cor(&scaled) - cor(&reference)).abs() < 1e-9, "1e{exponent}: {}", cor(&scaled));
        assert_eq!(scaled.verdict(), reference.verdict(), "1e{exponent}\n{scaled}");
        let error = |r: &Report| r.cor().unwrap().standard_error.unwrap();
        assert!((error(&scaled) / error(&reference) - 1.0).abs() < 1e-6, "1e{exponent}");
    }
}

#[test]
fn from_microseconds_to_days() {
    let times = [0.587, 1.549, 2.403, 3.164, 3.845, 4.452, 5.002, 5.497];
    let run = |scale: f64| {
        let times: Vec<f64> = times.iter().map(|t| t * scale).collect();
        Fit::new().sigma_time(0.005 * scale).run(&Table::from_contacts(&times).unwrap()).unwrap()
    };
    let reference = cor(&run(1.0));
    for exponent in -6..=5 {
        assert!((cor(&run(10f64.powi(exponent))) - reference).abs() < 1e-9, "1e{exponent}");
    }
}

#[test]
fn from_two_rows_to_a_hundred_thousand() {
    for trials in [1usize, 10, 1000, 10_000] {
        let mut text = "trial,bounce,height_m\n".to_owned();
        for trial in 0..trials {
            for n in 0..if trials == 1 { 2 } else { 10 } {
                text += &format!("{trial},{n},{:.17}\n", 0.8f64.powi(2 * n) * (1.0 + 1e-6 * trial as f64));
            }
        }
        let report = Fit::new().sigma_height(0.001).run(&parse(&text)).unwrap();
        assert!((cor(&report) - 0.8).abs() < 1e-9, "{trials}: {}", cor(&report));
    }
}

#[test]
fn heights_that_are_nearly_equal() {
    for loss in [1e-3, 1e-5, 1e-7] {
        let e: f64 = 1.0 - loss;
        let heights: Vec<f64> = (0..6).map(|n| e.powi(2 * n)).collect();
        let report = Fit::new().sigma_height(1e-9).run(&Table::from_heights(&heights).unwrap()).unwrap();
        assert!((cor(&report) - e).abs() < 1e-12, "{loss}: {}", cor(&report));
    }
}

#[test]
fn a_cor_of_nearly_nought() {
    for e in [1e-2, 1e-3, 1e-4f64] {
        let report = Fit::new().sigma_height(1e-12).run(&Table::from_heights(&[1.0, e * e]).unwrap()).unwrap();
        assert!((cor(&report) - e).abs() < 1e-9, "{e}: {}", cor(&report));
    }
}

#[test]
fn weights_over_twelve_orders_of_magnitude() {
    for seed in 0..20 {
        let mut noise = Noise(seed);
        let mut text = "bounce,height_m,height_error_m\n".to_owned();
        for n in 0..8 {
            text += &format!(
                "{n},{:.17},{:e}\n",
                0.7f64.powi(2 * n),
                10f64.powf((-6.0 + noise.normal(4.0)).clamp(-12.0, 0.0))
            );
        }
        let report = Fit::new().run(&parse(&text)).unwrap();
        assert!((cor(&report) - 0.7).abs() < 1e-9, "{seed}: {}", cor(&report));
    }
}
