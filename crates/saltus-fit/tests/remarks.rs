//! Remarks that change what the numbers beside them mean are doubts; those that change nothing are
//! none; what bears a name that says so is no reading.

use crate::written;

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_fit::{Change, Doubt, FindingKind, Fit, ReadOptions, Report, Table, Verdict, Why};

/// A language, a tab, a remark as it stands in a sound table.
const HARMLESS: &str = include_str!("tables/remarks-harmless.tsv");
/// What a remark changes, its language, the remark.
const ALARMING: &str = include_str!("tables/remarks-alarming.tsv");

fn rows(e: f64) -> Vec<String> {
    (0..5).map(|n| format!("{n},{:.1}", 120.0 * e.powi(2 * n))).collect()
}

/// A sound table with a remark above it, below it, as a comment or beside a row.
fn remarked(remark: &str, n: usize) -> String {
    let (quoted, e) = (format!("\"{}\"", remark.replace('"', "'")), 0.6 + 0.02 * (n % 13) as f64);
    let mut lines = rows(e);
    lines.insert(0, "bounce,height (cm)".to_owned());
    match n % 4 {
        0 => lines.insert(0, quoted),
        1 => lines.push(quoted),
        2 => lines.insert(0, format!("# {remark}")),
        _ => {
            lines[0] += ",remarks";
            lines[3] += &format!(",{quoted}");
        }
    }
    format!("Ball dropped on the floor\n{}\n", lines.join("\n"))
}

/// The remarks whose tables are trusted, and how many there are.
fn trusted_of(remarks: impl Iterator<Item = &'static str>) -> (Vec<&'static str>, usize) {
    let remarks: Vec<&str> = remarks.collect();
    let verdict = |n: usize| read(&remarked(remarks[n], n)).ok().map(|table| Fit::new().run(&table).unwrap().verdict());
    let found = (0..remarks.len()).filter(|n| verdict(*n) == Some(Verdict::Trusted)).map(|n| remarks[n]).collect();
    (found, remarks.len())
}

fn last(line: &'static str) -> &'static str {
    line.rsplit('\t').next().unwrap()
}

#[test]
fn remarks_that_change_the_readings_are_doubts() {
    let (found, all) = trusted_of(ALARMING.lines().map(last));
    println!("{} of {all} are trusted: {found:#?}", found.len());
    assert!(10 * found.len() <= 2 * all, "{} of {all}", found.len());
}

#[test]
fn remarks_that_change_nothing_are_none() {
    let (found, all) = trusted_of(HARMLESS.lines().map(last));
    println!("{} of {all} are trusted", found.len());
    assert!(found.len() * 100 >= 95 * all, "{} of {all}", found.len());
}

fn change(report: &Report) -> Option<Change> {
    report.findings().iter().find_map(|finding| match &finding.kind {
        FindingKind::ReadDoubt { doubt: Doubt::Remark { change, .. } } => Some(*change),
        _ => None,
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// A doubt says what the remark changes, but nothing where the remark denies it.
    #[test]
    fn each_change_is_named(e in 0.5f64..0.85, place in 0usize..3) {
        for (remark, wanted) in [
            ("the ball was thrown down hard", Change::Thrown),
            ("done under water", Change::Medium),
            ("only every other bounce is here", Change::Counted),
            ("the rule stood on a box", Change::Shifted),
            ("please do not use these", Change::Void),
            ("numbers come from a simulation run", Change::Unread),
            ("rows are sorted by size", Change::Order),
            ("from row 3 on with a new ball", Change::Changed),
            ("not sure about any of these", Change::Unsure),
        ] {
            let report = fit(&remarked(remark, 4 * (100.0 * e) as usize + place));
            prop_assert_eq!(change(&report), Some(wanted), "{}: {}", remark, report);
        }
        for denied in ["the ball was not thrown at all", "no bounce was skipped", "nothing was copied from others"] {
            let report = fit(&remarked(denied, 4 * (100.0 * e) as usize + place));
            prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}: {}", denied, report);
        }
    }

    /// The name of a file that is a sentence says what a remark does; a word by itself does not.
    #[test]
    fn names_that_are_sentences_are_remarks(e in 0.5f64..0.85) {
        let text = format!("bounce,height (cm)\n{}", rows(e).join("\n"));
        for (name, wanted) in
            [("sorted", false), ("these_rows_are_sorted", true), ("swapped", false), ("balls swapped", true)]
        {
            let table = Table::parse(&format!("{name}.csv"), text.as_bytes(), &ReadOptions::default()).unwrap();
            let report = Fit::new().run(&table).unwrap();
            prop_assert_eq!(change(&report).is_some(), wanted, "{}: {}", name, report);
        }
    }

    /// A remark of which hardly a word is understood may change anything.
    #[test]
    fn what_is_not_understood_may_change_anything(e in 0.5f64..0.85, place in 0usize..4) {
        let story = "zorbing quuxes perched glumly upon blorps while fribbles yonked the wuzzle";
        prop_assert_eq!(change(&fit(&remarked(story, 4 * (100.0 * e) as usize + place))), Some(Change::Unclear));
    }

    /// Feet and inches in one number are none of either.
    #[test]
    fn a_unit_of_two_parts_is_not_read(e in 0.5f64..0.85) {
        let row = |n: usize| format!("{n},5.11,{:.1}\n", 5.11 * e * e);
        let text = format!("try,drop (ft.in),rebound (ft.in)\n{}", (1..6).map(row).collect::<String>());
        prop_assert!(read(&text).is_err() || fit(&text).verdict() != Verdict::Trusted, "{}", text);
    }

    /// Blocks, sheets and tracks whose names say that they are not to be used, or were not
    /// measured, are left aside; the others are trusted.
    #[test]
    fn what_is_called_no_reading_is_none(e in 0.5f64..0.7, wrong in 0.75f64..0.85, name in 0usize..6) {
        let (name, why) = [
            ("Run 1 - wrong ball, please ignore", Why::Void),
            ("Durchgang 1 (Kugeln verwechselt)", Why::Void),
            ("Simulation", Why::Predicted),
            ("Simulazione al computer", Why::Predicted),
            ("essai 1, ne pas utiliser", Why::Void),
            ("invented for practice", Why::Predicted),
        ][name];
        let block = |e: f64| format!("bounce,height (cm)\n{}\n", rows(e).join("\n"));
        let text = format!("\"{name}\"\n{}\n\"Run 2 - the real thing\"\n{}", block(wrong), block(e));
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.01, "{}", report);
        prop_assert!(report.left_aside().iter().any(|aside| aside.why == why), "{}{:?}", text, report.left_aside());
        let sheets = [(name, written::cells(&block(wrong))), ("Data", written::cells(&block(e)))];
        let table = Table::parse("t.xlsx", &written::xlsx(&sheets), &ReadOptions::default()).unwrap();
        let report = Fit::new().run(&table).unwrap();
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.01, "{}", report);
        prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}", report);
    }

    /// A remark on a cell of a workbook is one of its sheet.
    #[test]
    fn remarks_on_cells_are_read(e in 0.5f64..0.85) {
        let cells = written::cells(&format!("bounce,height (cm)\n{}", rows(e).join("\n")));
        for (remark, wanted) in [("the rule had slipped, do not use", true), ("read by eye &amp; ruler", false)] {
            let bytes = written::remarked(&cells, &["checked twice", remark]);
            let table = Table::parse("t.xlsx", &bytes, &ReadOptions::default()).unwrap();
            let report = Fit::new().run(&table).unwrap();
            prop_assert_eq!(change(&report).is_some(), wanted, "{}", report);
        }
    }

    /// A decimal point that slipped in one of several drops is named, whatever the heights.
    #[test]
    fn a_slipped_point_among_repeats_is_named(e in 0.55f64..0.85, drop in 80.0f64..250.0, at in 0usize..6, down: bool) {
        let height = |n: usize| {
            let height = drop * e * e * (1.0 + 0.008 * (2.4 * n as f64).sin());
            format!("{:.1}", if n != at { height } else if down { height / 10.0 } else { height * 10.0 })
        };
        let lines: String = (0..6).map(|n| format!("{},{drop:.0},{}\n", n + 1, height(n))).collect();
        let report = fit(&format!("Trial,Drop height (cm),Bounce height (cm)\n{lines}"));
        let named = report.findings().iter().any(|finding| finding.to_string().contains(&height(at)));
        prop_assert!(named && report.verdict() != Verdict::Trusted, "{}", report);
    }

    /// Which of two letters is the rebound no sign tells, where no clock makes a track of them.
    #[test]
    fn coordinates_without_a_clock_are_doubted(e in 0.75f64..0.85) {
        let row = |drop: f64| format!("{drop},{:.1},{:.1}\n", drop * (1.0 - e * e), drop * e * e);
        let report = fit(&format!("Drop (cm),x (cm),y (cm)\n{}", [100.0, 150.0, 200.0, 250.0].map(row).concat()));
        prop_assert!(report.verdict() != Verdict::Trusted, "{}", report);
    }

    /// A column that is not understood and names what another one does may be the one that counts.
    #[test]
    fn a_second_rebound_that_is_not_understood_is_a_doubt(e in 0.55f64..0.85, other in 0usize..3) {
        let name = ["rebound zweckdienlich (cm)", "rebound quux (cm)", "rebound blorp (cm)"][other];
        let row = |n: usize| format!("{n},130,{:.1},{:.1}\n", 130.0 * e * e, 110.0 * e * e + 0.1 * n as f64);
        let lines: String = (1..6).map(row).collect();
        let report = fit(&format!("trial,drop (cm),rebound (cm),{name}\n{lines}"));
        prop_assert!(report.verdict() != Verdict::Trusted, "{}", report);
    }

    /// Speeds along a path at angles are no speeds across the floor.
    #[test]
    fn speeds_beside_angles_are_doubted(e in 0.55f64..0.85, word in 0usize..4) {
        let angle = ["angle before (deg)", "Winkel vorher (°)", "angle d'arrivée (deg)", "angolo (deg)"][word];
        let row = |v: f64| format!("{v:.2},{:.2},50\n", v * e);
        let lines = [4.8, 5.0, 5.2, 5.4].map(row).concat();
        let report = fit(&format!("Bounce pass\nspeed before (m/s),speed after (m/s),{angle}\n{lines}"));
        prop_assert!(report.verdict() != Verdict::Trusted, "{}", report);
    }

    /// A release whose name says where it is measured is one, whatever else the word counts.
    #[test]
    fn a_drop_from_somewhere_is_a_height(e in 0.55f64..0.85, form in 0usize..4) {
        let (drop, rebound) = [
            ("Drop (bottom of ball)", "Rebound (bottom of ball)"),
            ("Drop (from floor)", "Rebound (from floor)"),
            ("Drop above the floor", "Rebound above the floor"),
            ("Drop bottom of ball", "Rebound bottom of ball"),
        ][form];
        let row = |n: usize| format!("{n},72 in,{:.2} in\n", 72.0 * e * e + 0.1 * (2.4 * n as f64).sin());
        let lines: String = (1..6).map(row).collect();
        let text = format!("Try,{drop},{rebound}\n{lines}");
        prop_assert!((trusted(&text) - e).abs() < 0.01, "{}", text);
    }

    /// Columns that bear the names of people are repeats of one drop.
    #[test]
    fn names_of_people_tell_trials_apart(e in 0.55f64..0.85, of in 0usize..4) {
        let names = [["Amir", "Beth", "Clara"], ["Anna", "Jonas", "Mehmet"], ["Léa", "Hugo", "Inès"], ["Giulia", "Marco", "Sofia"]][of];
        let row = |n: i32| {
            let height = |k: i32| 200.0 * e.powi(2 * n) + if n == 0 { 0.0 } else { 0.5 * (2.4 * f64::from(n + 7 * k)).sin() };
            format!("{n},{:.1},{:.1},{:.1}\n", height(0), height(1), height(2))
        };
        let header = names.map(|name| format!("{name} (cm)")).join(",");
        let text = format!("bounce,{header}\n{}", (0..5).map(row).collect::<String>());
        prop_assert!((trusted(&text) - e).abs() < 0.02, "{}", text);
    }

    /// A comment says what a list below it is of.
    #[test]
    fn a_comment_names_a_list(e in 0.55f64..0.85, form in 0usize..3) {
        let header = ["# impact times (s)", "# golf ball on granite, times of the impacts in s", "# Zeiten der Aufpralle in s"][form];
        let time = |n: i32| format!("{:.3}\n", 0.4 + 1.2 * (1.0 - e.powi(n)) / (1.0 - e));
        let report = fit(&format!("{header}\n{}", (0..7).map(time).collect::<String>()));
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.01, "{}", report);
    }

    /// One unit stated of all lengths holds in every record.
    #[test]
    fn a_unit_of_all_lengths_holds_below(e in 0.55f64..0.85, word in 0usize..3) {
        let name = ["length_unit", "unit_of_length", "unit of lengths"][word];
        let rebounds = [0, 1, 2].map(|n| format!("{:.1}", 150.0 * e * e + 0.3 * (2.4 * f64::from(n)).sin())).join(", ");
        let text = format!("{{\"{name}\": \"cm\", \"drop_height\": 150, \"rebound_heights\": [{rebounds}]}}");
        prop_assert!((trusted(&text) - e).abs() < 0.01);
    }
}
