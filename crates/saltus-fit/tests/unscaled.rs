//! A COR is a ratio: of heights in any scale, of times in any. What has none of its own is read all
//! the same, and says the same.

use std::fmt::Write as _;

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{FindingKind, Fit, ReadOptions, Report, Table, Verdict};

fn fit(text: &str, options: &ReadOptions) -> Report {
    let table = Table::parse("t.csv", text.as_bytes(), options).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Fit::new().run(&table).unwrap()
}

fn value(report: &Report) -> f64 {
    report.cor().unwrap_or_else(|| panic!("{report}")).value
}

/// Places of a ball of this COR, dropped from 900 px, by the frame; a frame lasts `per` of the
/// fall.
fn film(e: f64, per: f64) -> String {
    let (mut contacts, mut speeds) = (vec![1.0], vec![2.0 * e]);
    for n in 0..3 {
        contacts.push(contacts[n] + speeds[n]);
        speeds.push(speeds[n] * e);
    }
    let mut text = "frame,y (px)\n".to_owned();
    for frame in 0..200 {
        let t = f64::from(frame) * per;
        let Some(next) = contacts.iter().position(|contact| *contact > t) else { break };
        let high = match next.checked_sub(1) {
            None => 1.0 - t * t,
            Some(n) => (t - contacts[n]) * (speeds[n] - (t - contacts[n])),
        };
        // Read to a tenth of a pixel, one way and the other.
        let off = 0.1 * f64::from((frame * 7) % 5 - 2);
        writeln!(text, "{frame},{:.1}", 950.0 - 900.0 * high + off).unwrap();
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(16)))]

    /// A film without a scale needs no rate of frames: its COR is that by any, and the rate that
    /// stands in for it is named.
    #[test]
    fn a_film_without_a_scale_needs_no_rate(e in 0.6f64..0.85, per in 0.03f64..0.06, fps in 25.0f64..240.0) {
        let text = film(e, per);
        let (open, stated) = (fit(&text, &ReadOptions::default()), fit(&text, &ReadOptions::default().fps(fps)));
        prop_assert!((value(&open) - e).abs() < 0.01 && (value(&open) - value(&stated)).abs() < 1e-3, "{}", open);
        prop_assert!(open.notes().iter().any(|note| note.contains("of unknown rate") && note.contains(": 24 a second")), "{}", open);
        // Where heights have a scale, or no flight is seen, a rate is asked for.
        let asked = |text: &str| Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).unwrap_err().to_string();
        prop_assert!(asked(&text.replace("(px)", "(mm)")).contains("--fps"));
        let falls: String = text.lines().take(8).fold(String::new(), |all, line| all + line + "\n");
        prop_assert!(asked(&falls).contains("--fps"));
    }

    /// The drag of a ball bends flights by how fast they are in metres a second. Where nothing
    /// shows that, at a rate that stands in for another or by a clock that gravity does not check,
    /// the COR is the same whichever ball is named.
    #[test]
    fn a_clock_that_nothing_checks_takes_no_air_out(e in 0.6f64..0.85, per in 0.03f64..0.06, slow in 1.0f64..8.0) {
        let text = film(e, per);
        let timed = |unit: &str| {
            let row = |line: &str| {
                let (frame, y) = line.split_once(',').unwrap();
                let y: f64 = y.parse().unwrap();
                let y = if unit == "m" { (950.0 - y) * 1e-3 } else { y };
                format!("{:.4},{y}\n", slow * frame.parse::<f64>().unwrap() / 60.0)
            };
            format!("t (s),y ({unit})\n{}", text.lines().skip(1).map(row).collect::<String>())
        };
        for ball in ["golf", "table tennis", "basketball"] {
            for text in [&text, &timed("px")] {
                let report = fit(&format!("# {ball} ball\n{text}"), &ReadOptions::default());
                prop_assert!((value(&report) - e).abs() < 0.01, "{} {}", ball, report);
                prop_assert!(report.findings().iter().any(|f| f.kind == FindingKind::DragNotHeeded), "{}", report);
            }
            let open = Table::parse("t.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
            let stated = Fit::new().drag(0.1).run(&open).unwrap();
            prop_assert!((value(&stated) - e).abs() < 0.01, "{}", stated);
        }
    }

    /// Heights in pixels beside times have the scale by which they agree, whatever it is.
    #[test]
    fn pixels_beside_times_have_the_scale_of_their_flights(e in 0.6f64..0.85, drop in 0.5f64..2.0, tall in 300.0f64..3000.0) {
        let fall = (2.0 * drop / 9.81).sqrt();
        let (mut time, mut text) = (fall, "event,time (s),y\n".to_owned());
        writeln!(text, "release,0,{:.1}", 5000.0 - tall).unwrap();
        for n in 1..5 {
            let flight = 2.0 * fall * e.powi(n);
            writeln!(text, "contact {n},{time:.4},5000\napex {n},,{:.1}", 5000.0 - tall * e.powi(2 * n)).unwrap();
            time += flight;
        }
        writeln!(text, "contact 5,{time:.4},5000").unwrap();
        let report = fit(&text, &ReadOptions::default().height_unit("px"));
        prop_assert!((value(&report) - e).abs() < 0.01 && report.verdict() == Verdict::Trusted, "{}", report);
        prop_assert!(report.notes().iter().any(|note| note.contains("by which their flights last")), "{}", report);
    }

    /// Roman numbers count trials as others do.
    #[test]
    fn roman_numbers_count_trials(e in 0.5f64..0.9) {
        let table = |names: [&str; 3]| {
            let rows: String = [60.0, 90.0, 120.0].iter().map(|h| format!("{h},{0:.1},{1:.1},{0:.1}\n", h * e * e, h * e * e + 0.2)).collect();
            let names = names.map(|n| format!("Trial {n} (cm)")).join(",");
            value(&fit(&format!("Drop (cm),{names}\n{rows}"), &ReadOptions::default()))
        };
        prop_assert_eq!(table(["I", "II", "III"]), table(["1", "2", "3"]));
    }

    /// An address is a name, whatever its words mean, and doubts nothing.
    #[test]
    fn an_address_says_nothing(word in prop::sample::select(vec!["theory", "predicted", "simulated", "expected"])) {
        let rows = "drop (cm),bounce (cm)\n60,38.2\n80,51.5\n100,64\n120,76.6\n";
        let said = |line: String| fit(&format!("{line}\n{rows}"), &ReadOptions::default()).verdict();
        prop_assert_eq!(said(format!("To: {word}@school.example")), Verdict::Trusted);
        prop_assert_eq!(said(format!("See https://school.example/{word}")), Verdict::Trusted);
        prop_assert_eq!(said(format!("{word} heights")), Verdict::Doubtful);
    }
}
