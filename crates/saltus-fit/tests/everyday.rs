//! What pupils, programs and devices write beside their readings: signs, legends, counters, places
//! that were not found.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{FindingKind, Fit, Verdict};

fn lines(rows: impl IntoIterator<Item = String>) -> String {
    rows.into_iter().map(|row| row + "\n").collect()
}

fn off(n: usize) -> f64 {
    (2.4 * n as f64).sin()
}

/// The times of contacts of a ball from 1.2 m, s.
fn contacts(e: f64, count: i32) -> Vec<f64> {
    let fall = (2.0 * 1.2 / 9.81_f64).sqrt();
    (0..count).map(|n| fall + (1..=n).map(|n| 2.0 * fall * e.powi(n)).sum::<f64>()).collect()
}

/// The height of the same ball, released at 0.3 s, m.
fn height(e: f64, t: f64) -> f64 {
    let at: Vec<f64> = contacts(e, 30).iter().map(|at| at + 0.3).collect();
    match at.iter().rposition(|at| *at <= t) {
        _ if t < 0.3 => 1.2,
        None => 1.2 - 4.905 * (t - 0.3).powi(2),
        Some(n) => at.get(n + 1).map_or(0.0, |next| 4.905 * (t - at[n]) * (next - t)),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// The sign of an error above a column, or behind a mean, is that of the readings before it.
    #[test]
    fn signs_of_an_error_are_one(e in 0.5f64..0.85, form in 0usize..6) {
        let (header, cell): (&str, fn(f64) -> String) = [
            ("bounce,height (m),+/- (m)", (|h| format!("{h:.2},0.01")) as fn(f64) -> String),
            ("bounce,height (m),± (m)", |h| format!("{h:.2},0.01")),
            ("bounce,height (m),+- (m)", |h| format!("{h:.2},0.01")),
            ("bounce,\"Height, mean ± SD (m)\"", |h| format!("{h:.2} ± 0.01")),
            ("bounce,Height mean +/- SD (m)", |h| format!("{h:.2} +/- 0.01")),
            ("bounce,height (m) ± 0.01", |h| format!("{h:.2}")),
        ][form];
        let rows = (0..6).map(|n| format!("{n},{}", cell(1.5 * e.powi(2 * n))));
        let text = format!("{header}\n{}", lines(rows));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// A number before what it counts is its place where words are not parted.
    #[test]
    fn counters_stand_behind_their_numbers(e in 0.5f64..0.85, form in 0usize..4) {
        let names = [
            ["落とした高さ", "はね返った高さ 1回目", "はね返った高さ 2回目", "はね返った高さ 3回目"],
            ["落下高さ", "リバウンド 1回目", "リバウンド 2回目", "リバウンド 3回目"],
            ["下落高度", "反弹高度 第1次", "反弹高度 第2次", "反弹高度 第3次"],
            ["drop height", "rebound height 1st time", "rebound height 2nd time", "rebound height 3rd time"],
        ][form];
        let read = |h: f64, n: usize| h * e * e + 0.4 * off(n);
        let rows = [60.0, 90.0, 120.0, 150.0];
        let rows = rows.iter().zip(0..).map(|(h, n)| format!("{h},{:.0},{:.0},{:.0}", read(*h, n), read(*h, n + 5), read(*h, n + 9)));
        let text = format!("{} (cm)\n{}", names.join(" (cm),"), lines(rows));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// Heights beside flights, a drop a row, are those of release, however the flights are called
    /// and counted, in whatever order; those of the flights themselves are not.
    #[test]
    fn heights_beside_flights_are_those_of_release(e in 0.5f64..0.85, form in 0usize..5, turned in any::<bool>()) {
        let (header, columns) = [
            ("height (m),flight time (s)", 1),
            ("h (m),time between first and second bounce (s)", 1),
            ("# t is the time between 1st and 2nd hit\nh (m),time between bounces trial 1 (s),time between bounces trial 2 (s)", 2),
            ("# Dropped from h, t = time between the 1st and 2nd time it hits the bench\nh (m),t1 (s),t2 (s),t3 (s),t mean (s)", 4),
            ("h (m),time between bounces 1 (s),time between bounces 2 (s)", 2),
        ][form];
        let flight = |h: f64, n: usize| 2.0 * e * (2.0 * h / 9.81).sqrt() + 0.003 * off(n);
        let row = |(n, h): (usize, f64)| {
            let flights: Vec<String> = (0..columns).map(|k| format!("{:.3}", flight(h, n + 3 * k))).collect();
            format!("{h:.2},{}", flights.join(","))
        };
        let heights = [0.3, 0.5, 0.8, 1.1, 1.4].into_iter().enumerate().map(row);
        let rows: Vec<String> = if turned { heights.rev().collect() } else { heights.collect() };
        let text = format!("{header}\n{}", lines(rows));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// What a device sends with its time is a recording, whatever it says in place of a reading
    /// that it lost, in whichever language.
    #[test]
    fn a_device_may_lose_a_reading(e in 0.6f64..0.85, form in 0usize..4) {
        let (start, name, lost) = [
            ("HC-SR04 ready", "Distance", "Out of range"),
            ("14:22:04.900 -> boot v2 Jun 8 2016\n14:22:04.910 -> Sensor listo", "Distancia", "Fuera de rango"),
            ("Sensor gestartet", "Abstand", "kein Echo"),
            ("Датчик готов", "Расстояние", "нет сигнала"),
        ][form];
        let row = |n: usize| {
            let t = 0.03 * n as f64;
            let stamp = format!("14:22:{:06.3}", 5.0 + t);
            match n % 17 {
                9 => format!("{stamp} -> {lost}"),
                _ => format!("{stamp} -> {name}: {:.1} cm", 150.0 - 100.0 * height(e, t)),
            }
        };
        let text = format!("{start}\n{}", lines((0..90).map(row)));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// Frames of contacts with a floor, one below the other or in a line, below what they are.
    #[test]
    fn frames_of_contacts_with_the_floor_are_times(e in 0.55f64..0.85, form in 0usize..6, in_line in any::<bool>()) {
        let (rate, name) = [
            ("240 fps", "Contact with the floor at frames"),
            ("240 images/s", "Contact avec le sol aux images"),
            ("240 Bilder/s", "Bilder, in denen der Ball den Boden berührt"),
            ("240 fps", "floor contact frames"),
            ("240 fps", "frames when the ball hits the ground"),
            ("240 fps", "Fotogramas de contacto con el suelo"),
        ][form];
        let frames: Vec<String> = contacts(e, 6).iter().map(|t| format!("{:.0}", 100.0 + 240.0 * t)).collect();
        let text = if in_line { format!("{rate}\n{name}:\n{}\n", frames.join(", ")) } else { format!("{rate}\n{name}\n{}\n", frames.join("\n")) };
        prop_assume!(!(form == 2 && in_line));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// Blanks part numbers with decimal commas, as programs save them where those are usual.
    #[test]
    fn blanks_part_decimal_commas(e in 0.6f64..0.85, marked in any::<bool>()) {
        let row = |n: usize| {
            let t = n as f64 / 60.0;
            format!("0:00:{t:05.2} {:.2} {:.2}", 40.0 + off(n), 100.0 * height(e, t)).replace('.', ",")
        };
        let header = if marked { "#Trajectory of a ball\n#T X Y" } else { "T X Y" };
        let text = format!("{header}\n{}", lines((0..150).map(row)));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// Feet and inches lead to feet and inches.
    #[test]
    fn feet_and_inches_lead_to_others(e in 0.5f64..0.85, form in 0usize..3) {
        let spelt = |inches: f64| {
            let (feet, inches) = ((inches.round() / 12.0).floor(), inches.round() % 12.0);
            [format!("{feet}'{inches}\""), format!("{feet} ft {inches} in"), format!("{feet}′{inches}″")][form].clone()
        };
        let rows = [48.0, 60.0, 72.0, 84.0, 96.0].map(|drop| format!("{} -> {}", spelt(drop), spelt(drop * e * e)));
        let text = format!("rubber ball\ndropped from -> came back up to\n{}", lines(rows));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// A number in place of all places that were not found is no place.
    #[test]
    fn places_that_were_not_found_are_left_out(e in 0.6f64..0.85, lost in prop::sample::select(vec!["-1", "-999"])) {
        let row = |n: usize| {
            let place = |h: f64| if n % 19 == 3 { lost.to_owned() } else { format!("{:.1}", 700.0 - 400.0 * h + 0.3 * off(n)) };
            format!("{n},{},{}", if n % 19 == 3 { lost.to_owned() } else { "488.1".to_owned() }, place(height(e, n as f64 / 120.0)))
        };
        let text = format!("# fps=120\nframe,cx,cy\n{}", lines((0..240).map(row)));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
        prop_assert!(fit(&text).repairs().iter().any(|r| r.contains("no position")), "{}", text);
    }

    /// The times that gates were dark are those by which speeds were worked out.
    #[test]
    fn speeds_are_worked_out_from_dark_times(e in 0.5f64..0.85) {
        let row = |n: usize| {
            let (v, w) = (2.0 + 0.2 * n as f64, (2.0 + 0.2 * n as f64) * e + 0.005 * off(n));
            format!("{},{:.2},{v:.3},{:.2},{w:.3}", n + 1, 25.0 / v, 25.0 / w)
        };
        let text = format!("Steel ball against a wall\nrun,t1 (ms),v before (m/s),t2 (ms),v after (m/s)\n{}", lines((0..8).map(row)));
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// Rebounds that are level with one another, and of no height of release, may be of drops that
    /// repeat each other.
    #[test]
    fn level_rebounds_without_a_release_are_not_trusted(high in 40.0f64..90.0, seed in 0usize..50) {
        let row = |ball: &str, k: usize| {
            let reads: Vec<String> = (0..3).map(|n| format!("{:.0}", high + 5.0 * k as f64 + 2.0 * off(seed + 4 * k + n))).collect();
            format!("{ball},{}", reads.join(","))
        };
        let text = format!("Ball,Rebound 1 (cm),Rebound 2 (cm),Rebound 3 (cm)\n{}", lines([row("Tennis", 0), row("Rubber", 1), row("Golf", 2)]));
        if let Ok(table) = read(&text) {
            let report = Fit::new().run(&table).unwrap();
            prop_assert!(report.groups().iter().all(|g| g.report.verdict() != Verdict::Trusted), "{}{}", text, report);
        }
    }

    /// Flights that are called by their number are repeats beside the mean of them, whatever that
    /// is called, and a name, a number and a unit in cells of their own state the release.
    #[test]
    fn repeats_have_a_mean_beside_them(e in 0.5f64..0.85, form in 0usize..3) {
        let rows = [40.0, 60.0, 80.0, 100.0, 125.0];
        let flight = |h: f64, n: usize| 2.0 * e * (2.0 * h / 981.0).sqrt() + 0.003 * off(n);
        let rebound = |n: usize| 120.0 * e * e + 0.4 * off(n);
        let text = match form {
            0 => format!("Fallhöjd (cm);Flygtid 1 (s);Flygtid 2 (s);Medel (s)\n{}", lines(rows.iter().zip(0..).map(|(h, n)| {
                let (a, b) = (flight(*h, n), flight(*h, n + 7));
                format!("{h};{a:.3};{b:.3};{:.3}", 0.5 * (a + b))
            }))),
            1 => format!("t – time between the first and second bounce (stopwatch)\nh [m],t1 [s],t2 [s],Average [s]\n{}", lines(rows.iter().zip(0..).map(|(h, n)| {
                let (a, b) = (flight(*h, n), flight(*h, n + 7));
                format!("{},{a:.3},{b:.3},{:.3}", 0.01 * h, 0.5 * (a + b))
            }))),
            _ => format!("Rubber balls on steel,,,\nDrop height,120,cm,Limits 60-90 cm\nBall,Bounce 1 (cm),Bounce 2 (cm),Mean (cm)\n{}", lines((0..8).map(|n| {
                let (a, b) = (rebound(n), rebound(n + 5));
                format!("{},{a:.1},{b:.1},{:.2}", n + 1, 0.5 * (a + b))
            }))),
        };
        let report = fit(&text);
        let cors: Vec<f64> = if report.groups().is_empty() { vec![report.cor().unwrap().value] } else { report.groups().iter().filter_map(|g| Some(g.report.cor()?.value)).collect() };
        prop_assert!(!cors.is_empty() && cors.iter().all(|cor| (cor - e).abs() < 0.02), "{}{}", text, report);
    }

    /// Programs write thousandths behind a colon, names of their own above those of columns, and
    /// units in the remark behind a list.
    #[test]
    fn programs_write_what_they_record(e in 0.6f64..0.85, form in 0usize..3) {
        let samples = || (0..150).map(|n| 0.02 * n as f64).map(|t| (t, height(e, t)));
        let text = match form {
            0 => format!("Trajectory of a ball\nTime;X (cm);Y (cm)\n{}", lines(samples().map(|(t, h)| format!("0:00:{:02.0}:{:03.0};42.1;{:.2}", t.floor(), 1000.0 * (t - t.floor()), 100.0 * h)))),
            1 => format!("FREQUENCY\t50\nMARKER_NAMES\tball\nFrame\tTime\tball X\tball Y\tball Z\n{}", lines(samples().zip(1..).map(|((t, h), n)| format!("{n}\t{t:.3}\t{:.2}\t{:.2}\t{:.2}", 210.7 + off(n), -88.1 + off(n + 3), 1000.0 * h)))),
            _ => {
                let list = |values: Vec<String>| values.chunks(10).map(|part| part.join(" ")).collect::<Vec<_>>().join(" ...\n ");
                let (t, d): (Vec<_>, Vec<_>) = samples().map(|(t, h)| (format!("{t:.2}"), format!("{:.4}", 1.6 - h))).unzip();
                format!("% laser above a ball\nt = [{}]; % s\nd = [{}]; % m, distance from sensor\n", list(t), list(d))
            }
        };
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// A COR that changes from bounce to bounce by less than what may be called one is one, however
    /// surely it does, and the interval takes in both ends; by more it is doubted.
    #[test]
    fn a_cor_may_change_a_little_from_bounce_to_bounce(e in 0.7f64..0.85, form in any::<bool>()) {
        let changes = if form { 0.010 } else { 0.09 };
        let cor = |n: i32| e - changes * f64::from(n) / 7.0;
        let flights = (1..8).scan(0.7, |flight, n| {
            *flight *= cor(n);
            Some(*flight)
        });
        let times = std::iter::once(0.7).chain(flights).scan(0.45, |t, flight| {
            let at = *t;
            *t += flight;
            Some(at)
        });
        let report = fit(&format!("Ball on wood\ntime of impact (s)\n{}", lines(times.map(|t| format!("{t:.4}")))));
        let trends = report.findings().iter().any(|f| matches!(f.kind, FindingKind::Trend { .. }));
        prop_assert!((report.verdict() == Verdict::Trusted) == form && (trends || !form), "{}", report);
        let found = report.cor().unwrap();
        prop_assert!(!form || found.low < cor(7) + 2e-3 && cor(1) - 2e-3 < found.high, "{}", report);
    }

    /// A COR that changes from drop to drop by less than what may be called one is one, and the
    /// interval takes in both ends; by more it is doubted.
    #[test]
    fn a_cor_may_change_a_little_from_drop_to_drop(e in 0.6f64..0.85, form in any::<bool>()) {
        let changes = if form { 0.012 } else { 0.08 };
        let row = |n: usize| {
            let e = e - changes * n as f64 / 9.0;
            format!("100,{:.2}", 100.0 * e * e)
        };
        let report = fit(&format!("drop (cm),rebound (cm)\n{}", lines((0..10).map(row))));
        let drifts = report.findings().iter().any(|f| matches!(f.kind, FindingKind::OrderDrift { .. }));
        prop_assert!(drifts && (report.verdict() == Verdict::Trusted) == form, "{}", report);
        let cor = report.cor().unwrap();
        prop_assert!(cor.low < e - changes + 1e-3 && e - 1e-3 < cor.high, "{}", report);
    }
}

/// What was aimed at and stands behind its name is none of the readings; what the name is of is.
#[test]
fn an_aim_that_stands_by_itself_is_no_reading() {
    let rows = lines((0..6).map(|n| format!("{},{:.1}", 50 + 20 * n, (50 + 20 * n) as f64 * 0.64 + 0.3 * off(n))));
    for aim in ["Allowed: 30 to 34 inches. Room 72 F", "target: rigid steel plate", "Required: COR 0.75 to 0.85"] {
        assert!((trusted(&format!("Ball lot 7\n{aim}\ndrop (cm),rebound (cm)\n{rows}")) - 0.8).abs() < 0.02, "{aim}");
    }
    let report = fit(&format!("Target: rebound heights\ndrop (cm),rebound (cm)\n{rows}"));
    assert_ne!(report.verdict(), Verdict::Trusted, "{report}");
}

/// Labels that count the contacts of each ball, signs of flights by their contacts, and pixels in
/// any language.
#[test]
fn names_count_contacts_and_flights() {
    let times = |from: f64, e: f64| contacts(e, 6).into_iter().map(move |t| t + from);
    let labels = |name: &'static str, from: f64, e: f64| {
        times(from, e).zip(1..).map(move |(t, n)| format!("{t:.4}\t{t:.4}\t{name} {n}"))
    };
    let report = fit(&lines(labels("golf", 1.0, 0.85).chain(labels("tennis", 9.0, 0.7))));
    let cors: Vec<f64> = report.groups().iter().filter_map(|g| Some(g.report.cor()?.value)).collect();
    let near = |e: f64| cors.iter().any(|cor| (cor - e).abs() < 0.01);
    let pooled = report.series().is_empty() && report.cor().is_some();
    assert!(pooled || cors.len() == 2 && near(0.85) && near(0.7), "{report}");

    let fall = |h: f64| 2.0 * (2.0 * h / 9.81_f64).sqrt();
    let row = |n: usize| {
        let h = 0.2 + 0.1 * n as f64;
        format!("{h:.2},{:.3},{:.3}", 0.8 * fall(h) + 0.002 * off(n), 0.64 * fall(h) + 0.002 * off(n + 5))
    };
    assert!((trusted(&format!("drop_height_m,t12_s,t23_s\n{}", lines((0..8).map(row)))) - 0.8).abs() < 0.02);

    for unit in ["пикс", "像素", "píxeles", "pikseli"] {
        let row = |n: usize| format!("{n};{:.3};{:.0}", n as f64 / 60.0, 900.0 - 600.0 * height(0.8, n as f64 / 60.0));
        let text = format!("n;t (s);y, {unit}\n{}", lines((0..120).map(row)));
        assert!((trusted(&text) - 0.8).abs() < 0.02, "{text}");
    }
}

/// A title ends in what it says of all readings, whatever it says of the ball before a dash and of
/// the recording behind a comma.
#[test]
fn a_title_states_between_a_dash_and_a_comma() {
    let rows = || lines((1..7).map(|n| format!("{n},{:.3},{:.3}", 0.8 * 0.8f64.powi(n), 0.75 * 0.8f64.powi(n))));
    for title in [
        "Golf ball on kitchen tiles - times between bounces in seconds, from a sound recording",
        "Rubber ball, garage - time between bounces in s",
        "kitchen – times between bounces (s), phone",
    ] {
        let text = format!("{title}\nflight,run A,run B\n{}", rows());
        assert!((trusted(&text) - 0.8).abs() < 0.01, "{text}");
    }
    assert!(read(&format!("kitchen tiles\nflight,run A,run B\n{}", rows())).is_err());
}
