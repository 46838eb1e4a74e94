//! Planted faults are found and named: outliers, missed and doubled contacts, misread times; and
//! what tolerances allow.

use crate::noise::Noise;
use saltus_fit::{Fit, Loss, ReadOptions, Report, Table, Verdict};

fn parse(text: &str) -> Table {
    Table::parse("planted", text.as_bytes(), &ReadOptions::default()).expect("a table")
}

fn contacts(e: f64, count: usize) -> Vec<f64> {
    std::iter::successors(Some((0.1, 0.8)), |&(t, d)| Some((t + d, d * e))).map(|(t, _)| t).take(count).collect()
}

fn cor(report: &Report) -> (f64, f64) {
    let cor = report.cor().unwrap_or_else(|| panic!("{report}"));
    (cor.value, cor.standard_error.unwrap_or(f64::NAN))
}

/// Trials of contact times, each with a fault of its own.
fn launches(seed: u64, sigma: f64, mut fault: impl FnMut(usize, &mut Vec<f64>, &mut Noise)) -> String {
    let mut noise = Noise(seed);
    let mut text = "trial,bounce,time_s\n".to_owned();
    for trial in 0..6 {
        let mut times = contacts(0.85, 10);
        times.iter_mut().for_each(|t| *t += noise.normal(sigma));
        fault(trial, &mut times, &mut noise);
        for (n, t) in times.iter().enumerate() {
            text += &format!("{trial},{n},{t:.6}\n");
        }
    }
    text
}

#[test]
fn missed_and_doubled_contacts_cost_nothing() {
    for seed in 0..20 {
        let text = launches(seed, 0.001, |_, times, noise| {
            let at = 1 + (noise.uniform() * 7.0) as usize;
            if noise.uniform() < 0.5 {
                times.remove(at);
            } else {
                times.insert(at + 1, times[at] + 0.02);
            }
        });
        let report = Fit::new().sigma_time(0.001).run(&parse(&text)).unwrap();
        let (value, error) = cor(&report);
        assert!((value - 0.85).abs() < 4.0 * error && error < 0.002, "{seed}\n{report}");
        assert!(report.repairs().len() >= 6, "{report}");
        let raw = Fit::new().sigma_time(0.001).repair(false).run(&parse(&text)).unwrap();
        assert!(raw.repairs().is_empty() && cor(&raw).1 > 3.0 * error, "{raw}");
    }
}

#[test]
fn misread_times_are_left_out_by_name() {
    for seed in 0..20 {
        let text = launches(seed, 0.001, |trial, times, noise| {
            if trial < 3 {
                let at = 2 + (noise.uniform() * 5.0) as usize;
                times[at] += 0.3 * (times[at + 1] - times[at]);
            }
        });
        let report = Fit::new().sigma_time(0.001).run(&parse(&text)).unwrap();
        let (value, error) = cor(&report);
        assert!((value - 0.85).abs() < 4.0 * error && error < 0.002, "{seed}\n{report}");
        assert!(report.repairs().len() >= 3, "{report}");
    }
}

#[test]
fn heights_of_which_a_quarter_are_wild() {
    for seed in 0..20 {
        let mut noise = Noise(seed);
        let mut text = "trial,bounce,height_cm\n".to_owned();
        for trial in 0..8 {
            for n in 0..6 {
                let mut h = 100.0 * 0.8f64.powi(2 * n) + noise.normal(0.3);
                if noise.uniform() < 0.25 {
                    h += if noise.uniform() < 0.5 { 15.0 } else { 30.0 };
                }
                text += &format!("{trial},{n},{:.2}\n", h.max(0.5));
            }
        }
        let table = parse(&text);
        let report = Fit::new().sigma_height(0.003).run(&table).unwrap();
        let (value, error) = cor(&report);
        assert!((value - 0.8).abs() < 4.0 * error && error < 0.003, "{seed}\n{report}");
        let raw = Fit::new().sigma_height(0.003).repair(false).run(&table).unwrap();
        assert!((cor(&raw).0 - 0.8).abs() > 0.005, "{seed}\n{raw}");
    }
}

#[test]
fn clean_readings_are_left_alone() {
    for seed in 0..30 {
        let mut noise = Noise(seed);
        let heights: Vec<f64> = (0..7).map(|n| 0.8f64.powi(2 * n) + noise.normal(0.004)).collect();
        let report = Fit::new().run(&Table::from_heights(&heights).unwrap()).unwrap();
        assert!(report.repairs().is_empty(), "{report}");
        let report = Fit::new().sigma_time(0.001).run(&parse(&launches(seed, 0.001, |_, _, _| {}))).unwrap();
        assert!(report.repairs().is_empty(), "{report}");
    }
}

#[test]
fn tolerances_allow_a_range_or_nothing() {
    let rounded: Vec<f64> = (0..5).map(|n| (100.0 * 0.8f64.powi(2 * n)).round() / 100.0).collect();
    let table = Table::from_heights(&rounded).unwrap();
    let allowed = |within: f64| Fit::new().tolerance_height(within).run(&table).unwrap().allowed()[0].clone();
    // Rounding to a centimetre moves nothing by more than half of one, so the truth is among what
    // that allows.
    let half = allowed(0.005 + 1e-9);
    let (low, high) = half.range.expect("rounding allows the truth");
    assert!(low <= 0.8 && 0.8 <= high && high - low < 0.02, "{half:?}");
    assert!(half.smallest <= 0.005 && low <= half.cor && half.cor <= high, "{half:?}");
    // By the definition of the range: with two heights, e² = h₁/h₀ at the corners of the
    // tolerances.
    let two = Fit::new().tolerance_height(0.01).run(&Table::from_heights(&[1.0, 0.64]).unwrap()).unwrap();
    let (low, high) = two.allowed()[0].range.unwrap();
    assert!(
        (low - (0.63f64 / 1.01).sqrt()).abs() < 1e-5 && (high - (0.65f64 / 0.99).sqrt()).abs() < 1e-5,
        "{low} {high}"
    );
    let none = allowed(half.smallest * 0.9);
    assert!(none.range.is_none() && (none.smallest / half.smallest - 1.0).abs() < 1e-3, "{none:?}");
    let times = Table::from_contacts(&contacts(0.9, 8)).unwrap();
    let report = Fit::new().sigma_time(0.002).tolerance_time(0.002).run(&times).unwrap();
    let (low, high) = report.allowed()[0].range.unwrap();
    assert!(low < 0.9 && 0.9 < high && high - low < 0.02, "{report}");
}

#[test]
fn other_losses_agree_on_clean_readings_and_differ_on_spoilt_ones() {
    let mut heights: Vec<f64> = (0..8).map(|n| 0.8f64.powi(2 * n)).collect();
    let by = |heights: &[f64], method: &str| {
        let report = Fit::new().sigma_height(0.01).losses(&Loss::ALL).repair(false);
        let report = report.run(&Table::from_heights(heights).unwrap()).unwrap();
        report.estimates().iter().find(|e| e.method == method).and_then(|e| e.value).unwrap()
    };
    for method in ["heights", "heights-huber", "heights-absolute", "heights-largest"] {
        assert!((by(&heights, method) - 0.8).abs() < 1e-5, "{method}");
    }
    heights[4] += 0.1;
    let off = |method: &str| (by(&heights, method) - 0.8).abs();
    assert!(off("heights-absolute") < 1e-5 && off("heights-huber") < off("heights"), "{}", off("heights-huber"));
    assert!(off("heights-largest") > 0.01);
}

#[test]
fn a_bootstrap_repeats_itself_and_agrees_with_the_jackknife() {
    let mut noise = Noise(4);
    let mut text = "trial,bounce,height_m\n".to_owned();
    for trial in 0..12 {
        let e: f64 = 0.8 + noise.normal(0.01);
        for n in 0..5 {
            text += &format!("{trial},{n},{:.5}\n", e.powi(2 * n) + noise.normal(0.002));
        }
    }
    let run = |seed| Fit::new().sigma_height(0.002).bootstrap(500, seed).run(&parse(&text)).unwrap();
    let report = run(7);
    let drawn = *report.bootstrap().expect("twelve trials");
    assert_eq!((drawn.rounds, drawn.seed), (500, 7));
    assert_eq!(run(7).bootstrap(), Some(&drawn));
    assert_ne!(run(8).bootstrap(), Some(&drawn));
    let (value, error) = cor(&report);
    assert!((0.6..1.5).contains(&(drawn.standard_error / error)), "{report}");
    assert!(drawn.low < value && value < drawn.high && report.to_string().contains("seed 7"), "{report}");
    let few = Fit::new().bootstrap(100, 1).run(&Table::from_heights(&[1.0, 0.64, 0.41]).unwrap()).unwrap();
    assert!(few.bootstrap().is_none() && few.warnings().iter().any(|n| n.contains("at least five")), "{few}");
}

/// Six drops of which only heights were read outvote the one whose times were read too, or are
/// contradicted by it: it does not speak for all.
#[test]
fn one_drop_does_not_speak_for_seven() {
    let table = |e: f64| {
        let mut noise = Noise(3);
        let mut text = "trial,event,time_s,height_m\n0,release,0,1.0\n".to_owned();
        let (mut t, mut v) = ((2.0f64 / 9.81).sqrt(), (2.0f64 * 9.81).sqrt());
        for n in 1..=4 {
            text += &format!("0,contact,{:.4},\n0,apex,,{:.4}\n", t, 0.8f64.powi(2 * n));
            v *= 0.8;
            t += 2.0 * v / 9.81;
        }
        for trial in 1..=6 {
            for n in 0..5 {
                let height = e.powi(2 * n) + noise.normal(0.002);
                text += &format!("{trial},{},,{height:.4}\n", if n == 0 { "release" } else { "apex" });
            }
        }
        Fit::new().sigma_height(0.002).sigma_time(0.001).run(&parse(&text)).unwrap()
    };
    let same = table(0.8);
    assert_eq!(same.verdict(), Verdict::Trusted, "{same}");
    assert!(same.reason().contains("1 of 7 trials"), "{same}");
    let other = table(0.76);
    assert_eq!(other.verdict(), Verdict::Doubtful, "{other}");
    let cor = other.cor().unwrap();
    assert!(cor.low < 0.77 && cor.high > 0.79, "{other}");
}
