//! What is planted is found, and what does not matter does not matter.

use crate::noise::Noise;
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn heights(e: f64, h0: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| h0 * e.powi(2 * n as i32)).collect()
}

fn contacts(e: f64, start: f64, first: f64, count: usize) -> Vec<f64> {
    let next = |&(t, d): &(f64, f64)| Some((t + d, d * e));
    std::iter::successors(Some((start, first)), next).map(|(t, _)| t).take(count).collect()
}

fn cor(report: &Report) -> f64 {
    report.cor().expect("a COR").value
}

fn parse(text: &str) -> Table {
    Table::parse("planted", text.as_bytes(), &ReadOptions::default()).expect("a table")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(200), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn exact_heights_give_their_cor_back(e in 0.05..0.999f64, h0 in 0.02..20.0f64, count in 2usize..9) {
        let report = Fit::new().sigma_height(1e-3 * h0).run(&Table::from_heights(&heights(e, h0, count)).unwrap()).unwrap();
        prop_assert!((cor(&report) - e).abs() < 1e-9, "{} {e}", cor(&report));
    }

    #[test]
    fn exact_contacts_give_their_cor_back(
        e in 0.05..0.999f64, start in -5.0..5.0f64, first in 0.05..3.0f64, count in 3usize..12,
    ) {
        let times = contacts(e, start, first, count);
        prop_assume!(times.windows(2).all(|w| w[1] - w[0] > 1e-6));
        let report = Fit::new().sigma_time(1e-3).run(&Table::from_contacts(&times).unwrap()).unwrap();
        prop_assert!((cor(&report) - e).abs() < 1e-9, "{} {e}", cor(&report));
    }

    #[test]
    fn exact_motions_give_their_cor_back_from_both_columns(e in 0.1..0.98f64, h0 in 0.1..5.0f64, bounces in 2usize..6) {
        let g = 9.81;
        let fall = (2.0 * h0 / g).sqrt();
        let times = contacts(e, fall, 2.0 * fall * e, bounces + 1);
        let mut text = format!("# gravity: 9.81 m/s^2\nevent,time_s,height_m\nrelease,0,{h0}\n");
        for (n, time) in times.iter().enumerate() {
            text += &format!("contact,{time},\n");
            if n < bounces {
                text += &format!("apex,,{}\n", h0 * e.powi(2 * n as i32 + 2));
            }
        }
        let report = Fit::new().sigma_height(1e-3 * h0).sigma_time(1e-3).run(&parse(&text)).unwrap();
        prop_assert!((cor(&report) - e).abs() < 1e-9, "{} {e}", cor(&report));
        prop_assert_eq!(report.verdict(), Verdict::Trusted);
        let motion = report.motion().unwrap();
        prop_assert!(motion.contacts.iter().zip(&times).all(|(a, b)| (a - b).abs() < 1e-8));
    }

    #[test]
    fn pooled_trials_with_their_own_clocks_give_the_common_cor(e in 0.3..0.95f64, seed in 0u64..1000) {
        let mut noise = Noise(seed);
        let mut text = "trial,bounce,time_ms\n".to_owned();
        for trial in 0..6 {
            let times = contacts(e, noise.normal(3.0), 0.5 + noise.uniform(), 5);
            for (n, t) in times.iter().enumerate() {
                text += &format!("{trial},{n},{}\n", 1000.0 * t);
            }
        }
        let report = Fit::new().sigma_time(1e-3).run(&parse(&text)).unwrap();
        prop_assert!((cor(&report) - e).abs() < 1e-8, "{} {e}", cor(&report));
    }

    #[test]
    fn unit_order_delimiter_and_decimal_comma_do_not_matter(seed in 0u64..10_000) {
        let mut noise = Noise(seed);
        let e = 0.4 + 0.5 * noise.uniform();
        let mut rows: Vec<(usize, f64)> =
            heights(e, 1.5, 6).iter().map(|h| (h * 1e4 + noise.normal(20.0)).max(1.0).round() / 100.0).enumerate().collect();
        let fit = Fit::new().sigma_height(0.002);
        let table = |unit: &str, per_cm: f64, delimiter: char, comma: bool, rows: &[(usize, f64)]| {
            let mut text = format!("bounce{delimiter}height ({unit})\r\n");
            for (n, cm) in rows {
                let number = format!("{:.6}", cm * per_cm);
                text += &format!("{n}{delimiter}{}\r\n", if comma { number.replace('.', ",") } else { number });
            }
            fit.run(&parse(&text)).unwrap()
        };
        let reference = table("cm", 1.0, ',', false, &rows);
        rows.reverse();
        let last = rows.len() - 1;
        rows.swap(1, last);
        for other in [
            table("mm", 10.0, ',', false, &rows),
            table("m", 0.01, ';', true, &rows),
            table("cm", 1.0, '\t', true, &rows),
            table("cm", 1.0, '\t', false, &rows),
        ] {
            prop_assert!((cor(&other) - cor(&reference)).abs() < 1e-9);
            prop_assert_eq!(other.verdict(), reference.verdict());
        }
    }

    #[test]
    fn a_shifted_or_stretched_clock_gives_the_same_cor(shift in -100.0..100.0f64, stretch in 0.1..10.0f64) {
        let times = [0.587, 1.549, 2.403, 3.164, 3.845, 4.452, 5.002, 5.497, 5.930];
        let moved: Vec<f64> = times.iter().map(|t| shift + stretch * t).collect();
        let run = |times: &[f64], sigma| Fit::new().sigma_time(sigma).run(&Table::from_contacts(times).unwrap()).unwrap();
        let (a, b) = (run(&times, 0.005), run(&moved, 0.005 * stretch));
        prop_assert!((cor(&a) - cor(&b)).abs() < 1e-9);
        let error = |r: &Report| r.cor().unwrap().standard_error.unwrap();
        prop_assert!((error(&a) / error(&b) - 1.0).abs() < 1e-5);
    }
}

#[test]
fn growing_heights_are_never_a_silent_one() {
    let report = Fit::new().run(&Table::from_heights(&[0.1, 0.3, 1.0]).unwrap()).unwrap();
    assert_eq!(report.verdict(), Verdict::Doubtful);
    assert!(cor(&report) > 1.7);
    let bounded = report.estimates().iter().find(|e| e.method == "heights").unwrap();
    assert_eq!((bounded.value, bounded.standard_error), (Some(1.0), None));
    assert!(report.warnings().iter().any(|w| w.contains("energy")));
    let times = Fit::new().run(&Table::from_contacts(&[0.0, 0.4, 0.9, 1.5, 2.2]).unwrap()).unwrap();
    assert_eq!(times.verdict(), Verdict::Doubtful);
    assert!(cor(&times) > 1.1);
}

#[test]
fn too_little_is_refused_and_says_why() {
    let refused = |table: Table, part: &str| {
        let report = Fit::new().run(&table).unwrap();
        assert_eq!(report.verdict(), Verdict::Refused);
        assert!(report.cor().is_none() && report.motion().is_none());
        assert!(report.reason().contains(part), "{}", report.reason());
    };
    refused(Table::from_heights(&[1.0]).unwrap(), "before and after");
    refused(Table::from_contacts(&[1.0]).unwrap(), "two flights");
    refused(Table::from_contacts(&[1.0, 2.0]).unwrap(), "three contacts");
    refused(parse("t (s),y (m)\n0,1\n0.1,0.95\n0.2,0.8\n0.3,0.56\n"), "no bounce");
    refused(parse("t (s),y (m)\n0,1\n0.2,0.8\n0.45,0.01\n0.6,0.3\n0.8,0.1\n"), "too few");
}

#[test]
fn one_bounce_gives_a_number_that_nothing_checks() {
    let report = Fit::new().run(&Table::from_heights(&[1.0, 0.3]).unwrap()).unwrap();
    assert_eq!(report.verdict(), Verdict::Doubtful);
    let cor = report.cor().unwrap();
    assert!((cor.value - 0.3f64.sqrt()).abs() < 1e-9);
    // σ_e/e = ½ √((σ/h₁)² + (σ/h₀)²)
    let expected = 0.3f64.sqrt() * 0.5 * (1.0f64 / 900.0 + 1e-4).sqrt();
    assert!((cor.standard_error.unwrap() / expected - 1.0).abs() < 1e-3);
    assert_eq!(report.estimates()[0].p, None);
}

#[test]
fn a_release_height_and_one_flight_give_a_number_that_nothing_checks() {
    let report = Fit::new().gravity(9.8).run(&parse("h0_cm,bounce,time_s\n100,1,0.45\n100,2,0.85\n")).unwrap();
    assert_eq!(report.verdict(), Verdict::Doubtful);
    assert!((cor(&report) - 0.4427).abs() < 1e-3, "{}", cor(&report));
}

#[test]
fn rebounds_too_low_to_read_give_an_upper_limit() {
    let report = Fit::new().run(&Table::from_heights(&[1.0, 0.0, 0.0]).unwrap()).unwrap();
    let cor = report.cor().unwrap();
    assert_eq!((report.verdict(), cor.value, cor.low, cor.standard_error), (Verdict::Doubtful, 0.0, 0.0, None));
    // κ²/(σ² (1 + κ²)) = 2.7055: one-sided, 95 %.
    assert!((cor.high * cor.high / 0.016_450_8 - 1.0).abs() < 1e-5);
}

#[test]
fn missed_and_doubled_contacts_are_mended_and_listed() {
    let mut text = "trial,bounce,time_s\n".to_owned();
    for trial in 0..4 {
        let mut times = contacts(0.9, 0.1 * f64::from(trial), 0.7, 9);
        if trial == 1 {
            times.remove(5);
        }
        if trial == 2 {
            times.insert(5, times[4] + 0.03);
        }
        for (n, t) in times.iter().enumerate() {
            text += &format!("{trial},{n},{t}\n");
        }
    }
    let report = Fit::new().sigma_time(0.001).run(&parse(&text)).unwrap();
    assert!((cor(&report) - 0.9).abs() < 1e-6, "{}", cor(&report));
    assert_eq!(report.repairs().len(), 2, "{:?}", report.repairs());
    assert!(report.repairs()[0].contains("trial 1") && report.repairs()[0].contains("missed"));
    assert!(report.repairs()[1].contains("trial 2") && report.repairs()[1].contains("twice"));
}

#[test]
fn two_balls_are_not_pooled_in_silence() {
    let mut noise = Noise(5);
    let mut table = |second: f64| {
        let mut text = "ball,trial,bounce,height_cm\n".to_owned();
        for trial in 0..10 {
            let (ball, e) = if trial < 5 { ("red", 0.8) } else { ("blue", second) };
            for (n, h) in heights(e, 100.0, 5).iter().enumerate() {
                text += &format!("{ball},{trial},{n},{:.3}\n", h + noise.normal(0.2));
            }
        }
        Fit::new().sigma_height(0.002).run(&parse(&text)).unwrap()
    };
    let different = table(0.7);
    let of = |report: &Report| report.groups().iter().map(|g| (g.name.clone(), cor(&g.report))).collect::<Vec<_>>();
    assert!(different.cor().is_none() && different.differences()[0].low > 0.0, "{different}");
    let cors = of(&different);
    assert!(cors[0].0 == "red" && (cors[0].1 - 0.8).abs() < 0.003, "{different}");
    assert!(cors[1].0 == "blue" && (cors[1].1 - 0.7).abs() < 0.003, "{different}");
    let alike = table(0.8);
    assert!(alike.differences()[0].low < 0.0 && alike.differences()[0].high > 0.0, "{alike}");
}

#[test]
fn heights_and_times_that_agree_are_trusted_together() {
    let text = "event,time_s,height_m\nrelease,0,1.000\ncontact,0.4515,\napex,,0.641\ncontact,1.1745,\napex,,0.409\n\
                contact,1.7525,\napex,,0.262\ncontact,2.2150,\n";
    let report = Fit::new().sigma_height(0.002).sigma_time(0.002).run(&parse(text)).unwrap();
    assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
    assert!(report.hypotheses().is_empty() && report.agreement().unwrap().p.unwrap() > 0.05, "{report}");
    assert!((cor(&report) - 0.8).abs() < 0.002);
}

#[test]
fn a_million_rows_give_their_common_cor() {
    let mut noise = Noise(3);
    let mut text = String::with_capacity(20_000_000);
    text.push_str("trial,bounce,height_cm\n");
    for trial in 0..100_000 {
        for n in 0..10 {
            use std::fmt::Write;
            let height = 100.0 * 0.8f64.powi(2 * n) + noise.normal(0.1);
            writeln!(text, "{trial},{n},{height:.4}").unwrap();
        }
    }
    let report = Fit::new().sigma_height(0.001).run(&parse(&text)).unwrap();
    assert!((cor(&report) - 0.8).abs() < 5e-6, "{}", cor(&report));
}
