//! What lines of their own, and signs, say of the numbers around them: rows that name the rows
//! below them, heights counted from the release on, frames and clocks that a title names, factors
//! that heights were computed by.

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Doubt, FindingKind, Report, Verdict};

/// Scatter of the reading `n`, a part of it.
fn off(n: usize) -> f64 {
    [0.004, -0.006, 0.001, 0.007, -0.005, 0.0, -0.002][n % 7]
}

/// The groups of a report, each with its COR.
fn groups(report: &Report) -> Vec<(&str, f64)> {
    report.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect()
}

fn computed(report: &Report) -> bool {
    let is = |kind: &FindingKind| matches!(kind, FindingKind::ReadDoubt { doubt: Doubt::Computed { .. } });
    report.findings().iter().any(|finding| is(&finding.kind))
}

/// Rows of drops from heights of 100 and 150 cm, and their rebounds.
fn drops(e: f64, blanks: &str) -> String {
    let row = |n: usize| {
        let drop = [100.0, 150.0][n % 2];
        format!("{},{drop},{:.1}{blanks}\n", n + 1, drop * e * e * (1.0 + off(n)))
    };
    (0..6).map(row).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(32), failure_persistence: None, ..ProptestConfig::default() })]

    /// A row of one name stands for what stands below it: balls and floors are groups, and never
    /// one mixture, however alike they are.
    #[test]
    fn rows_that_name_a_section_are_groups(e in 0.5f64..0.75, apart in 0.0f64..0.1, of in 0usize..4, filled: bool) {
        let names = [["Concrete", "Carpet"], ["Tennis ball", "Golf ball"], ["floor in the hall", "yard"], ["Beton", "Koberec"]];
        let commas = if filled { ",," } else { "" };
        let [one, other] = names[of];
        let rows = [drops(e, ""), drops(e + apart, "")];
        let table = format!("Trial,Drop (cm),Rebound (cm)\n{one}{commas}\n{}{other}{commas}\n{}", rows[0], rows[1]);
        let report = fit(&table);
        let found = groups(&report);
        prop_assert_eq!(found.iter().map(|(name, _)| *name).collect::<Vec<_>>(), vec![one, other], "{}", report);
        for ((_, cor), planted) in found.iter().zip([e, e + apart]) {
            prop_assert!((cor - planted).abs() < 0.01, "{}{}", table, report);
        }
    }

    /// Sections of drops from a height each, and of trials, are those.
    #[test]
    fn rows_that_name_a_height_or_a_trial_are_no_groups(e in 0.55f64..0.85, stated: bool) {
        let from = |drop: f64, first: usize| {
            let row = |n: usize| format!("{n},{:.1}\n", drop * e * e * (1.0 + off(first + n)));
            let name = if stated { format!("Drop from {drop} cm") } else { format!("{drop} cm") };
            format!("{name}\n{}", (1..5).map(row).collect::<String>())
        };
        let table = format!("Try,Rebound (cm)\n{}{}", from(100.0, 0), from(160.0, 4));
        prop_assert!((trusted(&table) - e).abs() < 0.01, "{}", table);
        let of_trial = |trial: usize| {
            let row = |n: i32| format!("{n},{:.1}\n", 150.0 * e.powi(2 * n) * if n == 0 { 1.0 } else { 1.0 + off(trial) });
            format!("Trial {trial}\n{}", (0..4).map(row).collect::<String>())
        };
        let table = format!("Bounce,Height (cm)\n{}{}{}", of_trial(1), of_trial(2), of_trial(3));
        let report = fit(&table);
        prop_assert!(report.groups().is_empty() && (report.cor().unwrap().value - e).abs() < 0.01, "{}{}", table, report);
    }

    /// A release `h1` is where counting begins: `h2`, in one column or in several repeats, is the
    /// first rebound.
    #[test]
    fn signs_count_from_the_release_on(e in 0.5f64..0.9, from in 0usize..3, repeats in 1usize..4) {
        let sign = |n: usize| [format!("h{}", from + n), format!("h_{}", from + n), format!("(H{})", from + n)][n % 3].clone();
        let mut head = format!("Drop height {} in cm;Rebound height {} in cm (1st try)", sign(0), sign(1));
        (2..=repeats).for_each(|n| head += &format!(";{n}. try"));
        let row = |n: usize| {
            let drop = 100.0 + 20.0 * n as f64;
            let tries = (0..repeats).map(|k| format!(";{:.1}", drop * e * e * (1.0 + off(n + 3 * k))));
            format!("{drop}{}\n", tries.collect::<String>())
        };
        let table = format!("{head}\n{}", (0..6).map(row).collect::<String>());
        prop_assert!((trusted(&table) - e).abs() < 0.01, "{}", table);
    }

    /// So are heights behind one that a line states by its sign, also in words: `Height 2`.
    #[test]
    fn names_count_from_a_stated_release_on(e in 0.5f64..0.9, of in 0usize..3) {
        let name = ["h", "Height ", "H_"][of];
        let row = |n: usize| {
            let height = |k: i32| format!("{:.1}", 150.0 * e.powi(2 * k) * (1.0 + 0.3 * off(n + k as usize)));
            format!("{n},{},{}\n", height(1), height(2))
        };
        let rows: String = (1..6).map(row).collect();
        let table = format!("Drop height H1 = 150 cm\nTrial,{name}2 (cm),{name}3 (cm)\n{rows}");
        prop_assert!((trusted(&table) - e).abs() < 0.01, "{}", table);
    }

    /// Numbers without a unit are what a title says: frames, or a clock. When the ball was let go
    /// is then a time as well.
    #[test]
    fn titles_name_frames_and_clocks(e in 0.6f64..0.9, of in 0usize..6, released: bool) {
        let title = [
            "# 240 fps - frame number when the ball touches the table",
            "Filmed at 240 fps; frame numbers",
            "# frame at which the ball hits the floor (read in a player), 240 fps",
            "Contacts of a ball; seconds from the start of the recording",
            "Ball on stone; milliseconds after the start",
            "All times in s",
        ][of];
        let unit = [1.0 / 240.0, 1.0 / 240.0, 1.0 / 240.0, 1.0, 0.001, 1.0][of];
        let row = |clip: usize| {
            let (begin, first) = (0.8 + 0.3 * clip as f64, 0.7 + 0.02 * clip as f64);
            let contact = |n: i32| begin + 0.4 + first * (1.0 - e.powi(n)) / (1.0 - e);
            let times = released.then_some(begin).into_iter().chain((0..6).map(contact));
            let places = if unit < 0.01 { 0 } else { 3 };
            format!("clip {clip}{}\n", times.map(|t| format!(",{:.places$}", t / unit)).collect::<String>())
        };
        let go = if released { ",let go" } else { "" };
        let hits: String = (1..7).map(|n| format!(",hit {n}")).collect();
        let table = format!("{title}\nclip{go}{hits}\n{}", (0..4).map(row).collect::<String>());
        let report = fit(&table);
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.01, "{}{}", table, report);
    }

    /// Lines of prose that list what came back from a height are drops, or bounces where they fall.
    #[test]
    fn lines_of_prose_list_rebounds(e in 0.5f64..0.85, words in 0usize..5, falls: bool) {
        let (from, back, and) = [
            ("dropped from", "it came back to ", "and"),
            ("- released at", "", "and"),
            ("losgelaten op", "kwam terug tot ", "en"),
            ("aus", "", "und"),
            ("* lâchée de", "", "et"),
        ][words];
        let line = |n: usize| {
            let drop = 80.0 + 40.0 * n as f64;
            let height = |k: usize| {
                let power = if falls { 2 * (k as i32 + 1) } else { 2 };
                format!("{:.1}", drop * e.powi(power) * (1.0 + off(n + 3 * k)))
            };
            format!("{from} {drop} cm: {back}{}, {} {and} {} cm\n", height(0), height(1), height(2))
        };
        let table = format!("The ball was dropped on the floor.\n\n{}\nThanks\n", (0..4).map(line).collect::<String>());
        let report = fit(&table);
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.01, "{}{}", table, report);
    }

    /// Frames of contacts tell the COR without their rate, in columns or in rows.
    #[test]
    fn contacts_need_no_rate_of_frames(e in 0.6f64..0.9, wide: bool, start in 50.0f64..500.0) {
        let contact = |n: i32| start + 150.0 * (1.0 - e.powi(n)) / (1.0 - e);
        let table = if wide {
            let names: String = (1..7).map(|n| format!(",hit {n} (frame)")).collect();
            let row = |clip: usize| format!("{clip}{}\n", (0..6).map(|n| format!(",{:.0}", contact(n) + clip as f64)).collect::<String>());
            format!("Ball dropped on the floor\nclip{names}\n{}", (1..4).map(row).collect::<String>())
        } else {
            let rows: String = (0..6).map(|n| format!("{},{:.0}\n", n + 1, contact(n))).collect();
            format!("bounce,frame\n{rows}")
        };
        prop_assert!((trusted(&table) - e).abs() < 0.01, "{}", table);
    }

    /// Heights that keep to a COR that the text states, to their last digits, were worked out from
    /// it; those that scatter about it were not.
    #[test]
    fn heights_of_a_stated_cor_were_computed(hundredths in 60u32..92, scatters: bool) {
        let e = f64::from(hundredths) / 100.0;
        let height = |n: i32| 200.0 * e.powi(2 * n) * if scatters && n > 0 { 1.0 + off(n as usize) } else { 1.0 };
        let rows: String = (0..7).map(|n| format!("{n},{:.2}\n", height(n))).collect();
        let table = format!("Successive bounces of a ball, e = {e}\nBounce,Height (cm)\n{rows}");
        let report = fit(&table);
        prop_assert!(computed(&report) != scatters, "{}{}", table, report);
        prop_assert!(scatters || report.verdict() != Verdict::Trusted);
    }
}

/// A sentence in the middle of a table, and a name below it, are remarks.
#[test]
fn sentences_name_no_section() {
    let table = |first: &str, second: &str| {
        format!("Trial,Drop (cm),Rebound (cm)\n{first}\n{}{second}\n{}", drops(0.7, ""), drops(0.7, ""))
    };
    for (first, second) in [
        ("we used the same ball for all of these drops", "and the same one again here in the afternoon"),
        ("(measured by hand)", "(measured by hand)"),
    ] {
        assert!(fit(&table(first, second)).groups().is_empty(), "{}", table(first, second));
    }
    let below = format!("Trial,Drop (cm),Rebound (cm)\n{}Concrete\n", drops(0.7, ""));
    assert!(fit(&below).groups().is_empty());
}
