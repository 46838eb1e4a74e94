//! Recordings as people make them, each with a truth that the plainest model misses: what is told, doubted, or found out.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod noise;

use noise::Noise;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

const G: f64 = 9.81;

fn parse(text: &str) -> Table {
    Table::parse("recording", text.as_bytes(), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn fit(text: &str) -> Report {
    Fit::new().run(&parse(text)).expect("a fit")
}

fn holds(report: &Report, truth: f64) -> bool {
    report.cor().is_some_and(|cor| cor.low <= truth && truth <= cor.high)
}

/// The height of a ball at `t` that is let go from `drop` at `start` and keeps `e` of its speed, and the times of its contacts.
fn height(t: f64, drop: f64, start: f64, e: f64) -> f64 {
    let fall = (2.0 * drop / G).sqrt();
    if t < start + fall {
        return drop - 0.5 * G * (t - start).max(0.0).powi(2);
    }
    let (mut from, mut lasts) = (start + fall, 2.0 * e * fall);
    while lasts > 1e-3 {
        if t < from + lasts {
            return 0.5 * G * (t - from) * (from + lasts - t);
        }
        (from, lasts) = (from + lasts, e * lasts);
    }
    0.0
}

#[test]
fn tables_in_other_languages_and_under_two_lines_of_names() {
    for (text, unit) in [
        ("Versuch 3: Basketball;\nAufprall;Höhe (cm)\n0;100\n1;64,0\n2;41,0\n3;26,2\n", 1),
        ("Versuch;Fallhöhe (cm);Sprunghöhe (cm)\n1;100;64\n2;100;64,2\n3;80;51,2\n", 1),
        ("rebond;hauteur (cm)\n0;100\n1;64,0\n2;41,0\n3;26,2\n", 1),
        ("essai;hauteur initiale (cm);hauteur du rebond (cm)\n1;100;64\n2;100;64,2\n3;80;51,2\n", 1),
        ("rebond;durée (s)\n1;0,7225\n2;0,578\n3;0,4624\n4;0,3699\n", 1),
        ("Nr.\tAufprallzeit in s\n1\t0,4515\n2\t1,1740\n3\t1,7520\n4\t2,2144\n", 1),
        ("rimbalzo;altezza (cm)\n0;100\n1;64,0\n2;41,0\n3;26,2\n", 1),
        ("rebote;altura (cm)\n0;100\n1;64,0\n2;41,0\n3;26,2\n", 1),
        ("bounce,height\n,cm\n0,100\n1,64.0\n2,41.0\n3,26.2\n", 1),
        (
            "Drop height (in),Rebound height (in),,\n,Trial 1,Trial 2,Average\n72,46.1,46.0,46.05\n60,38.4,38.5,38.45\n",
            1,
        ),
    ] {
        let report = fit(text);
        let cor = report.cor().unwrap_or_else(|| panic!("{text}{report}"));
        assert!((cor.value - 0.8).abs() < 0.003 * f64::from(unit), "{text}{report}");
        assert_eq!(report.verdict(), Verdict::Trusted, "{text}{report}");
    }
}

#[test]
fn a_film_with_much_noise_and_a_long_rest_is_not_turned_over() {
    let mut noise = Noise(11);
    for drop in [0.6, 0.8, 1.2] {
        let mut text = "t (s),y (m)\n".to_owned();
        for n in 0..180 {
            let t = f64::from(n) / 60.0;
            text += &format!("{t:.5},{:.5}\n", height(t, drop, 0.15, 0.68) + noise.normal(0.015));
        }
        let report = fit(&text);
        let cor = report.cor().unwrap_or_else(|| panic!("{report}"));
        assert!((cor.value - 0.68).abs() < 0.04, "{drop}\n{report}");
    }
}

#[test]
fn a_camera_that_drifts_costs_nothing() {
    let mut noise = Noise(5);
    for (drift, e) in [(0.03, 0.8), (-0.05, 0.7), (0.04, 0.87), (0.0, 0.8)] {
        let mut text = "t (s),y (m)\n".to_owned();
        for n in 0..150 {
            let t = f64::from(n) / 60.0;
            text += &format!("{t:.5},{:.5}\n", height(t, 1.0, 0.2, e) + drift * t + noise.normal(0.002));
        }
        let report = fit(&text);
        let cor = report.cor().unwrap_or_else(|| panic!("{report}"));
        assert!((cor.value - e).abs() < 0.003, "{drift}\n{report}");
        let found = report.series()[0].drift;
        assert_eq!(found.is_some(), drift != 0.0, "{drift}\n{report}");
        assert!(found.is_none_or(|d| (d.value - drift).abs() < 4.0 * d.standard_error.max(5e-4)), "{found:?}");
    }
}

#[test]
fn what_is_stated_of_the_way_up_against_the_ball_is_the_first_thing_said() {
    let mut text = "t (s),y (m)\n".to_owned();
    for n in 0..140 {
        let t = f64::from(n) / 60.0;
        text += &format!("{t:.5},{:.5}\n", 1.2 - height(t, 1.0, 0.2, 0.8));
    }
    let options = ReadOptions::default().y_down(false);
    let report = Fit::new().run(&Table::parse("film", text.as_bytes(), &options).unwrap()).unwrap();
    assert_ne!(report.verdict(), Verdict::Trusted, "{report}");
    assert!(report.reason().contains("--y-down"), "{}", report.reason());
}

/// Dropped from the bottom, read at the top: a basketball, 24 cm in diameter.
#[test]
fn rebounds_read_at_another_point_of_the_ball_are_found_out() {
    let mut noise = Noise(9);
    let mut text = "drop (cm),rebound (cm)\n".to_owned();
    for drop in [180.0, 180.0, 150.0, 150.0, 120.0, 120.0, 90.0, 90.0, 60.0, 60.0] {
        text += &format!("{drop},{:.1}\n", drop * 0.77 * 0.77 + 24.0 + noise.normal(0.5));
    }
    let report = fit(&text);
    assert_eq!(report.verdict(), Verdict::Doubtful, "{report}");
    assert!(report.reason().contains("rebounds are read 2"), "{}", report.reason());
    assert!(holds(&report, 0.77), "{report}");
    let model = report.models().iter().find(|m| m.name == "rebounds").expect("the model");
    assert!((model.cor.value - 0.77).abs() < 3.0 * model.cor.standard_error, "{model:?}");
    assert!((model.offset_m.unwrap().value - 0.24).abs() < 0.02, "{model:?}");
    // No ball gains speed at a bounce: drag that would need that is no explanation.
    assert!(report.models().iter().all(|m| m.chosen || m.cor.value <= 1.0), "{report}");
}

#[test]
fn a_rebound_that_is_not_in_the_table_is_named() {
    for gone in 1..5 {
        let mut noise = Noise(20 + gone);
        let mut heights: Vec<f64> = (0..8).map(|n| 100.0 * 0.64f64.powi(n) + noise.normal(0.5)).collect();
        heights.remove(usize::try_from(gone).unwrap());
        let rows: String = heights.iter().map(|h| format!("{h:.1}\n")).collect();
        let report = fit(&format!("height_cm\n{rows}"));
        assert_eq!(report.verdict(), Verdict::Doubtful, "{gone}\n{report}");
        assert!(report.reason().contains(&format!("a rebound is missing before number {gone} (")), "{report}");
        assert!(holds(&report, 0.8), "{gone}\n{report}");
    }
}

/// Reaction times of a hand on a stopwatch: most contacts are read wrongly, and those that go together do so by chance.
#[test]
fn contacts_of_which_many_do_not_follow_are_doubted() {
    let text = "trial,t1 (s),t2 (s),t3 (s),t4 (s),t5 (s)\n0,0.70,1.26,1.74,1.92,2.18\n1,0.72,1.24,1.65,2.02,2.21\n\
                2,0.68,1.19,1.61,2.00,2.15\n3,0.71,1.33,1.69,2.00,2.14\n4,0.68,1.33,1.71,2.04,2.17\n";
    let report = fit(text);
    assert_eq!(report.verdict(), Verdict::Doubtful, "{report}");
    assert!(report.reason().contains("do not follow"), "{report}");
}

/// Contacts of a soft ball take 15 ms each: the intervals shrink less than the flights do.
#[test]
fn contacts_that_take_time_are_tried() {
    let mut noise = Noise(4);
    let (mut held, mut tried) = (0, 0);
    for _ in 0..20 {
        let (mut t, mut lasts, mut text) = (0.45, 0.72, "time_s\n".to_owned());
        for _ in 0..10 {
            text += &format!("{:.5}\n", t + noise.normal(0.0005));
            (t, lasts) = (t + lasts + 0.015, 0.8 * lasts);
        }
        let report = Fit::new().sigma_time(0.0005).run(&parse(&text)).unwrap();
        tried += usize::from(report.models().iter().any(|m| m.name == "contact" && (m.cor.value - 0.8).abs() < 0.004));
        held += usize::from(report.verdict() == Verdict::Doubtful && holds(&report, 0.8));
    }
    assert!(tried == 20 && held >= 17, "{tried} {held}");
}

#[test]
fn heights_that_do_not_shrink_are_doubted() {
    for shrink in [0.0, 1e-7] {
        let rows: String = (0..500).map(|n| format!("{:.8}\n", 1.0 - shrink * f64::from(n))).collect();
        let report = fit(&format!("height_m\n{rows}"));
        assert_eq!(report.verdict(), Verdict::Doubtful, "{report}");
    }
}

#[test]
fn settings_that_differ_are_told_with_the_cor_of_each_by_itself() {
    let mut noise = Noise(6);
    let mut text = "ball,trial,bounce,time_s\n".to_owned();
    for (ball, e) in [("golf", 0.85), ("tennis", 0.8)] {
        for trial in 0..4 {
            let (mut t, mut lasts) = (0.0, 0.8);
            for bounce in 0..7 {
                text += &format!("{ball},{trial},{bounce},{:.5}\n", t + noise.normal(0.001));
                (t, lasts) = (t + lasts, e * lasts);
            }
        }
    }
    let reason = fit(&text).reason().to_owned();
    let of = |ball: &str| -> f64 {
        let (before, _) = reason.split_once(&format!(" for ball {ball}")).unwrap_or_else(|| panic!("{reason}"));
        before.rsplit(' ').next().unwrap().parse().unwrap()
    };
    assert!((of("golf") - 0.85).abs() < 0.003 && (of("tennis") - 0.8).abs() < 0.003, "{reason}");
}

/// A table of few rows that names a bounce of a very great number is answered at once.
#[test]
fn a_great_number_of_a_bounce_takes_no_time() {
    let start = std::time::Instant::now();
    let text = "bounce,trial 1 (cm),trial 2 (cm)\n0,50,1\n211606,5,\n2,4,\n3,3,\n";
    let _ = Fit::new().run(&parse(text));
    let text = "bounce,time_s,height_cm\n0,0,100\n1,0.45,60\n2,1.1,40\n900000,5,1\n900001,5.1,1\n900002,5.15,1\n";
    let _ = Fit::new().run(&parse(text));
    assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
}
