//! Recordings as people make them, each with a truth that the plainest model misses: what is told,
//! doubted, or found out.

use crate::noise::Noise;
use saltus_fit::{Fit, ReadOptions, Report, Severity, Table, Verdict};

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

/// The height of a ball at `t` that is let go from `drop` at `start` and keeps `e` of its speed,
/// and the times of its contacts.
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

/// Reaction times of a hand on a stopwatch: most contacts are read wrongly, and those that go
/// together do so by chance.
#[test]
fn contacts_of_which_many_do_not_follow_are_doubted() {
    let text = "# a bouncing ball\ntrial,t1 (s),t2 (s),t3 (s),t4 (s),t5 (s)\n0,0.70,1.26,1.74,1.92,2.18\n1,0.72,1.24,1.65,2.02,2.21\n\
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
    let mut text = "h0_cm,trial,bounce,time_s\n".to_owned();
    for (drop, e) in [("40", 0.85), ("5", 0.8)] {
        for trial in 0..4 {
            let (mut t, mut lasts) = (0.0, 0.8);
            for bounce in 0..7 {
                text += &format!("{drop},{trial},{bounce},{:.5}\n", t + noise.normal(0.001));
                (t, lasts) = (t + lasts, e * lasts);
            }
        }
    }
    let reason = fit(&text).reason().to_owned();
    let of = |drop: &str| -> f64 {
        let (before, _) = reason.split_once(&format!(" for h0_cm {drop}")).unwrap_or_else(|| panic!("{reason}"));
        before.rsplit(' ').next().unwrap().parse().unwrap()
    };
    assert!((of("40") - 0.85).abs() < 0.003 && (of("5") - 0.8).abs() < 0.003, "{reason}");
}

/// No model follows a table bounce by bounce that names the thousandth and first, or a far greater
/// one; below that they are tried.
#[test]
fn a_bounce_of_a_great_number_is_not_followed() {
    let rows = |of: &dyn Fn(usize) -> String, n: usize| [0, 1, 2, 3, n, n + 1].map(|n| of(n) + "\n").concat();
    let e = |n: usize| 0.9985f64.powi(i32::try_from(n).unwrap());
    let height = |n: usize| format!("{n},{:.4}", 50.0 * e(n).powi(2));
    let heights = |n: usize| fit(&format!("bounce,height_cm\n{}", rows(&height, n))).models().len();
    // A contact lasts, so that none is at the time of another.
    let clock = |n: usize| 0.32 + 0.64 * (1.0 - e(n)) / (1.0 - e(1)) + 0.01 * f64::from(u32::try_from(n).unwrap());
    let time = |n: usize| format!("{n},{:.5},{:.4}", clock(n), 50.0 * e(n).powi(2));
    let both = |n: usize| fit(&format!("bounce,time_s,height_cm\n{}", rows(&time, n))).models().len();
    assert!(heights(900) > 1, "{}", heights(900));
    for n in [1001, 211_606, 999_990] {
        assert_eq!((heights(n), both(n)), (0, 0), "{n}");
    }
}

/// A film whose times are written to 10 ms or 1 ms: the frames come evenly, so each gets its own
/// time back.
#[test]
fn rounded_times_of_frames_are_restored() {
    let mut noise = Noise(41);
    let mut all_held = 0;
    for (rate, decimals, step) in
        [(30.0, 2, 0.01), (29.97, 2, 0.01), (30.0, 3, 0.001), (60.0, 2, 0.01), (240.0, 3, 0.001)]
    {
        let (mut held, mut narrower) = (0, 0);
        for run in 0..24 {
            let start = 0.37 + noise.uniform();
            let (mut exact, mut rounded) = ("time_s,height_m\n".to_owned(), "time_s,height_m\n".to_owned());
            // A frame that the tracker lost, but not where it touches.
            for n in (0..(2.3 * rate) as u32).filter(|n| *n != 5 + run % 3) {
                let t = f64::from(n) / rate;
                let h = height(t, 1.0, 0.05, 0.8) + noise.normal(0.002);
                exact += &format!("{:.7},{h:.5}\n", start + t);
                rounded += &format!("{:.decimals$},{h:.5}\n", start + t);
            }
            let (exact, rounded, raw) =
                (fit(&exact), fit(&rounded), Fit::new().repair(false).run(&parse(&rounded)).unwrap());
            let told =
                |r: &Report| r.repairs().iter().filter(|line| line.contains("frames a second, rounded to")).count();
            assert_eq!((told(&exact), told(&rounded), told(&raw)), (0, 1, 0), "{rate} {step}\n{rounded}");
            let width = |r: &Report| r.cor().map_or(f64::INFINITY, |cor| cor.high - cor.low);
            let apart = (exact.cor().unwrap().value - rounded.cor().unwrap().value).abs();
            assert!(apart < 0.1 * width(&exact), "{rate} {step} {apart}\n{rounded}");
            held += u32::from(holds(&rounded, 0.8));
            narrower += u32::from(width(&rounded) < 0.7 * width(&raw));
        }
        assert!(held >= 21, "{rate} {step}: {held}");
        all_held += held;
        // Rounding to a third of a frame costs, to less it hardly does.
        assert!(step < 0.005 || narrower >= 12, "{rate} {step}: {narrower}");
    }
    assert!(all_held >= 110, "{all_held} of 120");
    // Four digits, as Tracker writes them: 9.667E-1, 1.033E0.
    let rows = (0..70).map(|n| f64::from(n) / 30.0);
    let text = rows.fold("t\ty\n".to_owned(), |text, t| {
        text + &format!("{t:.3E}\t{:.4}\n", height(t, 1.0, 0.05, 0.8) + noise.normal(0.002))
    });
    let report = fit(&text);
    assert!(report.repairs().iter().any(|line| line.contains("frames a second, rounded to 1 ms")), "{report}");
    // A camera that does not keep time: what it wrote down is taken as it is.
    let mut text = "time_s,height_m\n".to_owned();
    let mut t = 0.0;
    for _ in 0..70 {
        text +=
            &format!("{t:.2},{:.5}\n", height((100.0f64 * t).round() / 100.0, 1.0, 0.05, 0.8) + noise.normal(0.002));
        t += 0.02 + 0.03 * noise.uniform();
    }
    let report = fit(&text);
    assert!(report.repairs().iter().all(|line| !line.contains("frames a second")), "{report}");
}

/// Nobody states the error of reading, or somebody states it as large as the scatter about one COR:
/// where that turns the verdict, both reports say so.
#[test]
fn where_the_error_of_reading_decides_it_is_said() {
    let mut noise = Noise(8);
    let mut turned = 0;
    for _ in 0..120 {
        let (mut t, mut lasts, mut text) = (0.6, 0.96, "time_s\n".to_owned());
        for _ in 0..12 {
            text += &format!("{:.4}\n", t + noise.normal(0.003));
            (t, lasts) = (t + lasts, lasts * (0.905 - 0.0035 * 0.5 * G * lasts));
        }
        let table = parse(&text);
        // In air that is not stated, the drag of a light ball would explain it, and the interval
        // allows for that.
        let alone = Fit::new().drag(0.0).run(&table).unwrap();
        let sigma = alone.sigma_time().unwrap().value;
        let stated = Fit::new().drag(0.0).sigma_time(sigma).run(&table).unwrap();
        if !alone.reason().contains("one COR does not do") || stated.reason().contains("one COR does not do") {
            continue;
        }
        turned += 1;
        let says = |report: &Report, part: &str| report.warnings().iter().any(|line| line.contains(part));
        assert!(says(&alone, "nobody stated how well the times were read, and that decides it"), "{alone}");
        assert!(says(&alone, "(--sigma-time "), "{alone}");
        assert!(says(&stated, "the error of reading decides it: with times"), "{stated}");
        assert!(holds(&alone, alone.cor().unwrap().value) && holds(&stated, alone.cor().unwrap().value));
    }
    assert!(turned >= 5, "{turned}");
}

/// A rough floor, nothing stated: the readings could be to blame as well.
#[test]
fn bounces_that_scatter_are_told_from_readings_by_what_is_stated() {
    let mut noise = Noise(3);
    let mut seen = 0;
    for _ in 0..20 {
        let (mut t, mut lasts, mut text) = (0.6, 0.8, "time_s\n".to_owned());
        for _ in 0..9 {
            text += &format!("{t:.4}\n");
            (t, lasts) = (t + lasts, lasts * (0.8 + noise.normal(0.03)));
        }
        let report = fit(&text);
        let Some(line) = report.warnings().iter().find(|line| line.contains("themselves scatter")) else { continue };
        let (_, option) = line.split_once("(--sigma-time ").unwrap_or_else(|| panic!("{report}"));
        let sigma: f64 = option.split_once("ms)").unwrap().0.parse().unwrap();
        let stated = Fit::new().sigma_time(1e-3 * sigma).run(&parse(&text)).unwrap();
        assert!(stated.warnings().iter().all(|line| !line.contains("themselves scatter")), "{stated}");
        seen += 1;
    }
    assert!(seen >= 10, "{seen}");
}

#[test]
fn drops_that_change_in_their_order_do_not_repeat_each_other() {
    let table = |last: f64, from: [f64; 2]| {
        let mut noise = Noise(12);
        let mut text = "trial,bounce,height_cm\n".to_owned();
        for trial in 0..12 {
            let part = f64::from(trial) / 11.0;
            let (e, drop) = (0.75 + (last - 0.75) * part, from[0] + (from[1] - from[0]) * part);
            for bounce in 0..5 {
                text += &format!("{trial},{bounce},{:.1}\n", drop * e.powi(2 * bounce) + noise.normal(0.3));
            }
        }
        fit(&text)
    };
    let told = |report: &Report, severity: Severity| {
        let words = "in the order of the table, from 0.75";
        report.findings().iter().any(|f| f.severity == severity && f.to_string().contains(words))
    };
    let (warming, steady) = (table(0.81, [100.0, 100.0]), table(0.75, [100.0, 100.0]));
    assert!(told(&warming, Severity::Doubt) && warming.verdict() == Verdict::Doubtful, "{warming}");
    let cor = warming.cor().unwrap();
    assert!(cor.low < 0.755 && cor.high > 0.805, "{warming}");
    assert!(!told(&steady, Severity::Doubt) && !told(&steady, Severity::Note), "{steady}");
    // Drops from other heights may have other CORs.
    let ladder = table(0.81, [100.0, 200.0]);
    assert!(told(&ladder, Severity::Note) && !told(&ladder, Severity::Doubt), "{ladder}");
}
