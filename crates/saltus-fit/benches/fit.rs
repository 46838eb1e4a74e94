//! What a fit costs, from the text of a table to its report: the study's table, launches that were
//! only heard, a film, and a bootstrap.
//!
//! `cargo bench -p saltus-fit --bench fit`

#![allow(clippy::unwrap_used)] // a benchmark of a fit that fails should stop

use divan::Bencher;
use saltus_fit::{Fit, Loss, ReadOptions, Report, Table};

fn main() {
    divan::main();
}

fn run(fit: &Fit, text: &str) -> Report {
    let table = Table::parse("bench.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
    fit.run(&table).unwrap()
}

/// A number between −1 and 1 that looks like chance, for the `n`-th reading.
fn scatter(n: u32) -> f64 {
    2.0 * (f64::from(n) * 0.754_877_666_246_692_7).fract() - 1.0
}

/// `trials` launches of `count` contacts, a COR of 0.85.
fn launches(trials: u32, count: u32) -> String {
    let mut text = "trial,bounce,time_s\n".to_owned();
    for trial in 0..trials {
        let (mut time, mut flight) = (0.1, 0.8);
        for n in 0..count {
            text += &format!("{trial},{n},{:.6}\n", time + 0.001 * scatter(trial * count + n));
            (time, flight) = (time + flight, 0.85 * flight);
        }
    }
    text
}

/// A ball dropped from 1 m, a COR of 0.8, without drag.
fn film(rate: f64, samples: u32) -> String {
    let (gravity, e) = (9.81, 0.8);
    let (mut began, mut up, mut height) = (0.0, 0.0, 1.0f64);
    let mut text = "time_s,height_m\n".to_owned();
    for n in 0..samples {
        let t = f64::from(n) / rate;
        let lands = |up: f64, height: f64| (up + (up * up + 2.0 * gravity * height).sqrt()) / gravity;
        while t - began > lands(up, height) {
            let after = lands(up, height);
            (began, up, height) = (began + after, e * (gravity * after - up), 0.0);
        }
        let s = t - began;
        text += &format!("{t:.6},{:.6}\n", height + up * s - 0.5 * gravity * s * s + 0.002 * scatter(n));
    }
    text
}

#[divan::bench]
fn study(bencher: Bencher) {
    let text = include_str!("../../../examples/data/squash-on-cement.csv");
    bencher.bench(|| run(&Fit::new(), text));
}

/// With what would settle it, as the tool and the Python package do it.
#[divan::bench]
fn study_advised(bencher: Bencher) {
    let text = include_str!("../../../examples/data/squash-on-cement.csv");
    bencher.bench(|| {
        let table = Table::parse("bench.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
        let fit = Fit::new();
        fit.advised(&table, fit.run(&table).unwrap(), None).unwrap()
    });
}

#[divan::bench]
fn thirty_launches_by_huber(bencher: Bencher) {
    let (text, fit) = (launches(30, 20), Fit::new().sigma_time(0.001).losses(&[Loss::Huber]));
    bencher.bench(|| run(&fit, &text));
}

#[divan::bench(sample_count = 20)]
fn film_of_two_seconds(bencher: Bencher) {
    let text = film(60.0, 120);
    bencher.bench(|| run(&Fit::new(), &text));
}

#[divan::bench(sample_count = 3)]
fn series_of_20_000(bencher: Bencher) {
    let text = film(8000.0, 20_000);
    bencher.bench(|| run(&Fit::new(), &text));
}

#[divan::bench(sample_count = 3)]
fn a_million_rows(bencher: Bencher) {
    let text = launches(100_000, 10);
    bencher.bench(|| run(&Fit::new().sigma_time(0.001), &text));
}

#[divan::bench(sample_count = 10)]
fn bootstrap_1000_of_ten_trials(bencher: Bencher) {
    let (text, fit) = (launches(10, 8), Fit::new().bootstrap(1000, 1));
    bencher.bench(|| run(&fit, &text));
}
