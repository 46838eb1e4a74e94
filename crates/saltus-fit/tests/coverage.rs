//! A 95 % interval holds the truth 95 times in a hundred.

use crate::noise::Noise;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Table};

/// Of a thousand runs the coverage of a 95 % interval is known to ± 0.7 % (one standard error).
fn runs() -> usize {
    cases(1000) as usize
}

/// Two percent, or three standard errors of the coverage that so many runs show.
fn allowed() -> f64 {
    (3.0 * (0.95 * 0.05 / runs() as f64).sqrt()).max(0.02)
}

/// The part of runs whose interval holds `truth`.
fn coverage(truth: f64, mut run: impl FnMut(&mut Noise) -> (Fit, Table)) -> f64 {
    let mut noise = Noise(20_240_607);
    let held = (0..runs()).filter(|_| {
        let (fit, table) = run(&mut noise);
        // In a vacuum and from the true zero: what is tested is what the interval makes of the
        // readings.
        let report = fit.drag(0.0).sigma_zero(0.0).sigma_scale(0.0).run(&table).expect("a fit");
        let cor = *report.cor().expect("a COR");
        cor.low <= truth && truth <= cor.high
    });
    held.count() as f64 / runs() as f64
}

fn within_two_percent(what: &str, coverage: f64) {
    println!("{what}: {:.1} % of {} intervals hold the truth", 100.0 * coverage, runs());
    assert!((coverage - 0.95).abs() <= allowed(), "{what}: {coverage}");
}

fn heights(noise: &mut Noise, e: f64, sigma: f64, count: i32) -> Vec<f64> {
    (0..count).map(|n| e.powi(2 * n) + noise.normal(sigma)).collect()
}

fn times(noise: &mut Noise, e: f64, sigma: f64, count: i32) -> Vec<f64> {
    (0..count).map(|n| 0.9 * (1.0 - e.powi(n)) / (1.0 - e) + noise.normal(sigma)).collect()
}

/// Rounding is not normal, and a few intervals do not tell whose errors they have: more may hold
/// the truth.
fn at_least(what: &str, coverage: f64) {
    println!("{what}: {:.1} % of the intervals hold the truth", 100.0 * coverage);
    assert!(coverage >= 0.95 - allowed(), "{what}: {coverage}");
}

#[test]
fn of_intervals_rounded_one_by_one() {
    for (what, step, e, count) in [("intervals to 10 ms", 0.01, 0.9, 11), ("intervals to a frame", 1.0 / 30.0, 0.8, 7)]
    {
        let held = coverage(e, |noise| {
            let mut text = "bounce,interval_s\n".to_owned();
            let mut flight = 0.64 + 0.32 * noise.uniform();
            for n in 1..=count {
                text += &format!("{n},{:.4}\n", (flight / step).round() * step);
                flight *= e;
            }
            (Fit::new(), Table::parse("planted", text.as_bytes(), &ReadOptions::default()).unwrap())
        });
        at_least(what, held);
    }
}

#[test]
fn of_times_rounded_to_10_ms() {
    let held = coverage(0.8, |noise| {
        let (mut time, mut flight) = (noise.uniform(), 0.64 + 0.32 * noise.uniform());
        let mut text = "time_s\n".to_owned();
        for _ in 0..8 {
            text += &format!("{time:.2}\n");
            time += flight;
            flight *= 0.8;
        }
        (Fit::new(), Table::parse("planted", text.as_bytes(), &ReadOptions::default()).unwrap())
    });
    at_least("times to 10 ms", held);
}

#[test]
fn of_heights_with_a_stated_error() {
    let held = coverage(0.8, |noise| {
        (Fit::new().sigma_height(0.01), Table::from_heights(&heights(noise, 0.8, 0.01, 6)).unwrap())
    });
    within_two_percent("heights", held);
}

#[test]
fn of_heights_with_an_error_from_the_scatter() {
    let held = coverage(0.8, |noise| (Fit::new(), Table::from_heights(&heights(noise, 0.8, 0.004, 8)).unwrap()));
    within_two_percent("heights, scatter", held);
}

#[test]
fn of_times_with_a_stated_error() {
    let held = coverage(0.85, |noise| {
        (Fit::new().sigma_time(0.004), Table::from_contacts(&times(noise, 0.85, 0.004, 9)).unwrap())
    });
    within_two_percent("times", held);
}

#[test]
fn of_heights_and_times_together() {
    let held = coverage(0.7, |noise| {
        let fall = (2.0f64 / 9.81).sqrt();
        let mut text = "event,time_s,height_m,height_error_m\nrelease,0,1,1e-6\n".to_owned();
        let mut contact = fall;
        for n in 1..5 {
            text += &format!(
                "contact,{},,\napex,,{},0.005\n",
                contact + noise.normal(0.005),
                0.7f64.powi(2 * n) + noise.normal(0.005)
            );
            contact += 2.0 * fall * 0.7f64.powi(n);
        }
        let table = Table::parse("planted", text.as_bytes(), &ReadOptions::default()).unwrap();
        (Fit::new().sigma_height(0.005).sigma_time(0.005), table)
    });
    // One table in a hundred is said to contradict itself and gets a wide range instead.
    within_two_percent("both", held);
}

#[test]
fn of_trials_whose_cor_differs() {
    // Ten launches, the COR of each 0.8 ± 0.01: the spread between launches, not the reading error,
    // sets the interval.
    let held = coverage(0.8, |noise| {
        let mut text = "trial,bounce,height_m\n".to_owned();
        for trial in 0..10 {
            let e = 0.8 + noise.normal(0.01);
            for (n, h) in heights(noise, e, 0.002, 5).iter().enumerate() {
                text += &format!("{trial},{n},{h}\n");
            }
        }
        (Fit::new().sigma_height(0.002), Table::parse("planted", text.as_bytes(), &ReadOptions::default()).unwrap())
    });
    within_two_percent("trials", held);
}

#[test]
fn of_bounces_that_scatter() {
    // Eight launches on a rough floor: every impact has a COR of its own, 0.9 ± 1 %, and the clock
    // is good to 0.2 ms.
    let held = coverage(0.9, |noise| {
        let mut text = "trial,bounce,time_s\n".to_owned();
        for trial in 0..8 {
            let (mut t, mut d) = (0.0, 0.8);
            for n in 0..8 {
                text += &format!("{trial},{n},{}\n", t + noise.normal(0.0002));
                t += d;
                d *= 0.9 * (1.0 + noise.normal(0.01));
            }
        }
        (Fit::new(), Table::parse("planted", text.as_bytes(), &ReadOptions::default()).unwrap())
    });
    within_two_percent("bounces", held);
}
