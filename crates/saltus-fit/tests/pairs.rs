//! Columns and lines that say together what neither says alone: times of blocking a gate, begins
//! and ends of contacts, from where and up to where, heights beside the time until all is quiet,
//! and lists below a sentence that tells from where a ball was dropped.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, Note, ReadOptions, Report, Table};

fn near(found: f64, e: f64, by: f64) -> bool {
    (found - e).abs() < by
}

fn named(name: &str, text: &str) -> Report {
    let table = Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Fit::new().run(&table).unwrap()
}

/// Contacts of a ball whose contacts last so long, each with its begin and end, in ms.
fn contacts(e: f64, lasts: f64, first: f64) -> Vec<(f64, f64)> {
    let mut at = 1000.0;
    (0..7)
        .map(|n| {
            let begin = at;
            at += lasts + first * e.powi(n);
            (begin, begin + lasts)
        })
        .collect()
}

fn on_and_off(names: (&str, &str), contacts: &[(f64, f64)]) -> String {
    let rows = contacts.iter().enumerate().map(|(n, (on, off))| format!("{},{on:.1},{off:.1}\n", n + 1));
    format!("impact,{},{}\n{}", names.0, names.1, rows.collect::<String>())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(16), failure_persistence: None, ..ProptestConfig::default() })]

    /// A gate is blocked for the longer the slower the ball is: the COR is the ratio of the times
    /// turned over.
    #[test]
    fn times_at_a_gate_are_speeds_turned_over(
        e in 0.5..0.9_f64,
        names in prop::sample::select(vec![
            ("Gate time down (ms)", "Gate time up (ms)"),
            ("gate time before (ms)", "gate time after (ms)"),
            ("Blocked before bounce (ms)", "Blocked after bounce (ms)"),
        ]),
    ) {
        let row = |n: usize| {
            let down = 10.0 + 0.4 * n as f64;
            format!("{},{down:.2},{:.2}\n", n + 1, down / e)
        };
        let rows: String = (0..8).map(row).collect();
        let text = format!("Run,{},{}\n{rows}Ball diameter,40.0 mm,\n", names.0, names.1);
        let report = named("ball.csv", &text);
        prop_assert!(near(report.cor().unwrap().value, e, 0.005), "{}", report);
        prop_assert!(report.verdict() == saltus_fit::Verdict::Trusted, "{}", report);
    }

    /// Contacts have a begin and an end: flights are from the end of each to the begin of the next.
    #[test]
    fn contacts_begin_and_end(
        e in 0.7..0.9_f64,
        lasts in 5.0..20.0_f64,
        names in prop::sample::select(vec![
            ("t_on_ms", "t_off_ms"),
            ("contact start (ms)", "contact end (ms)"),
            ("Kontakt Beginn (ms)", "Kontakt Ende (ms)"),
            ("on (ms)", "off (ms)"),
        ]),
    ) {
        let report = fit(&on_and_off(names, &contacts(e, lasts, 900.0)));
        prop_assert!(near(report.cor().unwrap().value, e, 5e-4), "{}", report);
    }

    /// From where a ball was dropped, and up to where it came back.
    #[test]
    fn from_stands_beside_up_to(
        e in 0.5..0.9_f64,
        names in prop::sample::select(vec![("from", "up to"), ("From (cm)", "To (cm)"), ("van", "tot")]),
        unit in any::<bool>(),
    ) {
        let bare = names.0.contains('(');
        let unit = if bare { "" } else if unit { " cm" } else { "cm" };
        let row = |h: f64| format!("{h}{unit},{:.1}{unit}\n", h * e * e);
        let rows: String = [60.0, 80.0, 100.0, 120.0, 140.0].map(row).concat();
        let found = trusted(&format!("bouncing ball,\n{},{}\n{rows}", names.0, names.1));
        prop_assert!(near(found, e, 0.004));
    }

    /// Heights beside the time until all is quiet are those of release.
    #[test]
    fn heights_beside_the_time_until_rest_are_of_release(
        e in 0.6..0.9_f64,
        name in prop::sample::select(vec!["total time until silent (s)", "time until rest (s)", "time until quiet (s)"]),
    ) {
        let row = |h: f64| {
            let fall = (2.0 * h / 9.81f64).sqrt();
            format!("{},{:.3}\n", 100.0 * h, fall * (1.0 + e) / (1.0 - e))
        };
        let report = fit(&format!("h (cm),{name}\n{}", [0.1, 0.2, 0.3, 0.4, 0.5].map(row).concat()));
        prop_assert!(near(report.cor().unwrap().value, e, 0.005), "{}", report);
    }

    /// A sentence states from where a ball was dropped, whoever did it and whatever else it states;
    /// the list below it is of the rebounds.
    #[test]
    fn a_sentence_states_the_release_of_a_list(
        e in 0.5..0.85_f64,
        lines in prop::sample::select(vec![
            ("We always dropped the ball from 1.50 m and filmed how high it comes:", "Trial"),
            ("Wir haben den Ball immer aus 1,50 m fallen lassen", "Versuch"),
            ("Today Zorb dropped the football from 1.50 m", "Trial"),
            ("Die Fallhöhe war immer (150,0 ± 0,5) cm", "Versuch"),
        ]),
    ) {
        let (sentence, trial) = lines;
        let rows: String = (1..6).map(|n| format!("{trial} {n}: {:.1} cm\n", 150.0 * e * e + 0.3 * (n % 3) as f64)).collect();
        let report = fit(&format!("{sentence}\n\n{rows}"));
        prop_assert!(near(report.cor().unwrap().value, e, 0.006), "{}\n{}", sentence, report);
    }

    /// What a console is asked further below, and answers, says nothing of the frame above it.
    #[test]
    fn a_console_is_asked_more_below_a_frame(e in 0.5..0.85_f64) {
        let row = |n: usize| format!("{n}     A      1.{n}   {:.3}\n", (1.0 + 0.1 * n as f64) * e * e);
        let rows: String = (1..7).map(row).collect();
        let text = format!(
            "> bounce\n   rep h_drop_m h_reb_m\n{rows}> fit <- lm(h)\n> summary(fit)\n         Estimate  Std. Error\nh_drop_m 0.588 0.001\n>\n"
        );
        prop_assert!(near(trusted(&text), e, 0.004));
    }
}

/// Who did something else from there as well states no release, and 'from' beside 'to' says
/// nothing of a bounce.
#[test]
fn what_may_be_of_something_else_is_not_trusted() {
    for text in [
        "We dropped the ball and recorded it from 2 m\n\nTrial 1: 64 cm\nTrial 2: 63 cm\nTrial 3: 64 cm\n",
        "from (cm),to (cm)\n100,64\n80,51\n60,38\n",
    ] {
        let report = read(text).map(|table| Fit::new().run(&table).unwrap());
        assert!(report.is_err() || report.is_ok_and(|r| r.verdict() != saltus_fit::Verdict::Trusted), "{text}");
    }
}

/// A range of readings in words has its middle for a reading.
#[test]
fn a_range_may_be_in_words() {
    for (between, and) in [("between", "and"), ("entre", "e"), ("zwischen", "und")] {
        let row = |h: f64| format!("{h};{between} {:.1} {and} {:.1}\n", 0.64 * h - 1.0, 0.64 * h + 1.0);
        let found = trusted(&format!("drop (cm);rebound (cm)\n{}", [60.0, 80.0, 100.0, 120.0].map(row).concat()));
        assert!(near(found, 0.8, 0.003), "{between}: {found}");
    }
}

/// Contacts are shorter than the flights between them: of two times that are as far apart as the
/// next ones nothing tells which are the contacts.
#[test]
fn contacts_are_shorter_than_flights() {
    let taken = |lasts: f64| read(&on_and_off(("t_on_ms", "t_off_ms"), &contacts(0.9, lasts, 200.0))).is_ok();
    assert!(taken(14.0) && taken(30.0));
    assert!(!taken(300.0) && !taken(150.0));
}

/// Contacts of a ball on the floor last alike, and for tens of milliseconds at most. What gets
/// longer as the ball gets slower is a beam that it blocks, what gets shorter rings, what is one
/// and the same was set, and what a sound names says nothing of the floor: those begin, and that
/// is all.
#[test]
fn contacts_on_the_floor_last_alike() {
    let taken = |names: (&str, &str), lasts: &dyn Fn(i32) -> f64| {
        let mut at = 1000.0;
        let row = |n: i32| {
            let begin = at;
            at += lasts(n) + 600.0 * 0.8f64.powi(n);
            format!("{},{begin:.4},{:.4}\n", n + 1, begin + lasts(n))
        };
        let rows: String = (0..7).map(row).collect();
        let table = read(&format!("impact,{},{}\n{rows}", names.0, names.1)).unwrap();
        let aloft = table.notes().iter().any(|note| matches!(note.kind, Note::Aloft { .. }));
        let cor = Fit::new().run(&table).unwrap().cor().unwrap().value;
        assert!(!aloft || near(cor, 0.8, 5e-4), "{cor}");
        aloft
    };
    let plate = ("t_on_ms", "t_off_ms");
    let wavers = |n: i32| if n % 2 == 0 { 1.0 } else { 1.06 };
    for lasts in [2.0, 10.0, 30.0] {
        assert!(taken(plate, &|n| lasts * wavers(n)), "{lasts}");
        // Of a solid ball by the fifth root of the speed, and a little shorter by a threshold.
        assert!(taken(plate, &|n| lasts * 0.8f64.powf(-0.2 * f64::from(n))), "{lasts}");
        assert!(taken(plate, &|n| lasts * (1.0 - 0.02 * f64::from(n))), "{lasts}");
    }
    assert!(!taken(plate, &|n| 60.0 * wavers(n)));
    assert!(!taken(plate, &|n| 10.0 * [1.0, 1.5, 0.7, 1.4, 0.6, 1.3, 0.8][n as usize]));
    assert!(!taken(plate, &|n| 10.0 * 0.8f64.powi(-n)));
    assert!(!taken(plate, &|n| 10.0 * 0.9f64.powi(n)));
    assert!(!taken(plate, &|n| 10.0 + 0.0025 * (wavers(n) - 1.0) / 0.06) && !taken(plate, &|_| 10.0));
    assert!(taken(plate, &|n| 10.0 + 0.05 * (wavers(n) - 1.0) / 0.06));
    assert!(!taken(("sound on (ms)", "sound off (ms)"), &|n| 10.0 * wavers(n)));
    assert!(!taken(("blocked (ms)", "unblocked (ms)"), &|n| 10.0 * wavers(n)));
}

/// Times that nothing blocks, words that name no gate, and times of contacts that overlap are
/// asked.
#[test]
fn other_pairs_of_columns_are_not_coupled() {
    for text in [
        "impact,t_on_ms,t_off_ms\n1,1000,2100\n2,2000,2900\n3,2800,3500\n",
        "Run,Wobble time down (ms),Wobble time up (ms)\n1,10,12\n2,11,13\n3,10,12\n",
    ] {
        assert!(read(text).is_err(), "{text}");
    }
}

/// The time until a ball hits for the last of so many times, counted in a column, is that of this
/// contact; where rows count differently it is not.
#[test]
fn hits_are_counted_beside_a_total_time() {
    let until = |h: f64, e: f64, hits: i32| {
        let flights: f64 = (1..hits).map(|k| 2.0 * e.powi(k)).sum();
        (2.0 * h / 9.81).sqrt() * (1.0 + flights)
    };
    for (count, hits) in [("number of hits", 4), ("bounces", 3), ("number of bounces", 6)] {
        for e in [0.6, 0.8] {
            let mut text = format!("Ball drop times\ntrial,drop height (m),{count},total time (s)\n");
            for (n, h) in [0.8, 0.8, 1.2, 1.6].into_iter().enumerate() {
                text += &format!("{},{h},{hits},{:.2}\n", n + 1, until(h, e, hits) + 0.004 * (n as f64 - 1.5));
            }
            let cor = fit(&text).cor().unwrap().value;
            assert!((cor - e).abs() < 0.01, "{cor} for {e}\n{text}");
        }
    }
}
