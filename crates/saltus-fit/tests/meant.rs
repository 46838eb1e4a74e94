//! What a table says beside its numbers: words that are not known, rows that do not count, units in
//! a column of their own, titles above lists, letters around a table. Each says what the plain
//! table of the same numbers says, or doubts.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

mod typed;

use proptest::prelude::*;
use saltus_fit::{ReadOptions, Table, Verdict, Why};
use typed::{fit, trusted};

/// Heights of a drop and its bounces, cm.
fn heights(e: f64, count: i32) -> Vec<f64> {
    (0..count).map(|n| 150.0 * e.powi(2 * n)).collect()
}

fn near(found: f64, e: f64) -> bool {
    (found - e).abs() < 3e-3
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    /// A column but for a word is read where no other holds what it does, and doubted; several that
    /// differ in that word alone have a COR each; beside one that is understood it is left aside.
    #[test]
    fn words_that_are_not_known_leave_what_is_known(e in 0.5f64..0.85) {
        let rows = |columns: &[f64]| -> String {
            let row = |h: f64| format!("{h},{}\n", columns.iter().map(|e| format!("{:.2}", h * e * e)).collect::<Vec<_>>().join(","));
            [150.0, 120.0, 100.0, 80.0].map(row).concat()
        };
        let one = fit(&format!("Drop (cm),Rebound zorb (cm)\n{}", rows(&[e])));
        prop_assert!(one.verdict() == Verdict::Doubtful && one.reason().contains("'zorb'"), "{}", one);
        prop_assert!(near(one.cor().unwrap().value, e));
        let two = fit(&format!("Drop (cm),Rebound zorb (cm),Rebound quax (cm)\n{}", rows(&[e, e + 0.1])));
        let found: Vec<(&str, f64)> = two.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect();
        prop_assert!(matches!(found.as_slice(), [("zorb", a), ("quax", b)] if near(*a, e) && near(*b, e + 0.1)), "{}", two);
        let beside = fit(&format!("Drop (cm),Rebound (cm),Rebound zorb (cm)\n{}", rows(&[e, e + 0.1])));
        prop_assert!(near(beside.cor().unwrap().value, e), "{}", beside);
        prop_assert!(beside.left_aside().iter().any(|aside| aside.name == "Rebound zorb (cm)"));
        let short = trusted(&format!("Drop (cm),Reb (cm)\n{}", rows(&[e])));
        prop_assert!(near(short, e));
    }

    /// Rows that a column says do not count, or a remark, are left aside and named.
    #[test]
    fn rows_that_do_not_count_are_left_aside(e in 0.5f64..0.85, form in 0usize..6) {
        let (name, yes, no) = [
            ("valid?", "yes", "no - hit my foot"),
            ("ok", "y", "n"),
            ("exclude", "", "x"),
            ("Gültig", "ja", "nein"),
            ("remark", "", "discarded, hit the wall"),
            ("notes", "fine", "not used"),
        ][form];
        let row = |n: usize| {
            let (counts, wrong) = if n % 3 == 2 { (no, 0.7) } else { (yes, 1.0) };
            let high = 150.0 * e * e * wrong * (1.0 + 0.004 * (n % 4) as f64);
            format!("{n},150,{high:.1},{counts}\n")
        };
        let text = format!("trial,drop (cm),rebound (cm),{name}\n{}", (0..9).map(row).collect::<String>());
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 5e-3, "{}{}", text, report);
        prop_assert_eq!(report.left_aside().iter().filter(|aside| aside.why == Why::Void).count(), 3);
    }

    /// What bears the mark of a note that says that it was worked out is left aside; another note
    /// changes nothing.
    #[test]
    fn a_note_below_says_what_was_not_measured(e in 0.5f64..0.8, mark in prop::sample::select(vec!["*", "†"]), on_count: bool) {
        let row = |(n, h): (usize, f64)| {
            let (made, mark) = if n > 3 { (h * 1.2f64.powi(n as i32 - 3), mark) } else { (h, "") };
            if on_count { format!("{n}{mark},{made:.1}\n") } else { format!("{n},{made:.1}{mark}\n") }
        };
        let rows: String = heights(e, 7).into_iter().enumerate().map(row).collect();
        let report = fit(&format!("bounce,height (cm)\n{rows}\n{mark} not measured, calculated with e = 0.85\n"));
        let cor = report.cor().unwrap().value;
        prop_assert!(near(cor, e), "{}", report);
        prop_assert_eq!(report.left_aside().iter().filter(|aside| aside.why == Why::Void).count(), 3);
    }

    /// A column that names the unit of each row.
    #[test]
    fn a_unit_may_stand_beside_each_number(e in 0.5f64..0.85) {
        let row = |(n, h): (usize, f64)| match n % 2 {
            0 => format!("{n},{h:.2},cm\n"),
            _ => format!("{n},{:.3},in\n", h / 2.54),
        };
        let rows: String = heights(e, 5).into_iter().enumerate().map(row).collect();
        let found = trusted(&format!("bounce,height,unit\n{rows}"));
        prop_assert!(near(found, e));
    }

    /// Lists of names and values below titles are a row each.
    #[test]
    fn lists_below_titles_are_trials_of_each(e in 0.5f64..0.75, mark in prop::sample::select(vec![",", ": ", ";", "\t", " = "])) {
        let list = |title: &str, e: f64| {
            let values = heights(e, 4).into_iter().enumerate().map(|(n, h)| match n {
                0 => format!("Drop height{mark}{h:.2} cm\n"),
                _ => format!("Bounce {n}{mark}{h:.2} cm\n"),
            });
            format!("{title}\n{}\n", values.collect::<String>())
        };
        let report = fit(&format!("{}{}", list("Zorb A", e), list("Zorb B", e + 0.1)));
        let found: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert!(matches!(found.as_slice(), [a, b] if near(*a, e) && near(*b, e + 0.1)), "{}", report);
    }

    /// Columns that a letter tells apart are trials where they are level, else balls.
    #[test]
    fn letters_tell_columns_apart(e in 0.5f64..0.8) {
        let text = |other: f64| {
            let row = |(h, by): (f64, f64)| format!("{h},{:.2},{:.2}\n", h * e * e + by, h * other * other - by);
            let rows = [(150.0, 0.1), (120.0, -0.2), (100.0, 0.2), (80.0, -0.1)].map(row).concat();
            format!("Drop height (cm),Bounce height A (cm),Bounce height B (cm)\n{rows}")
        };
        prop_assert!(near(trusted(&text(e)), e));
        let two = fit(&text(e + 0.1));
        let found: Vec<(&str, f64)> = two.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect();
        prop_assert!(matches!(found.as_slice(), [("A", a), ("B", b)] if near(*a, e) && near(*b, e + 0.1)), "{}", two);
        prop_assert_eq!(two.verdict(), Verdict::Trusted);
    }

    /// The unit of a height of release above a table is that of heights that bear none and are no
    /// higher, and of no others.
    #[test]
    fn a_unit_of_the_release_is_that_of_the_rebounds(e in 0.6f64..0.85) {
        let rows = |times: f64| -> String { (1..5).map(|n| format!("{n},{:.2}\n", times * e.powi(2 * n))).collect() };
        let found = trusted(&format!("Drop height: 150 cm\nbounce,height\n{}", rows(150.0)));
        prop_assert!(near(found, e));
        let other = format!("Drop height: 1.5 m\nbounce,height\n{}", rows(150.0));
        let asked = Table::parse("t.csv", other.as_bytes(), &ReadOptions::default()).unwrap_err();
        prop_assert!(asked.is_question() && asked.to_string().contains("--height-unit"), "{}", asked);
    }

    /// Numbers in the brackets of a program, and behind dashes, are a list of bounces where they
    /// fall.
    #[test]
    fn lists_of_programs_are_bounces(e in 0.5f64..0.85, form in 0usize..3) {
        let values: Vec<String> = heights(e, 5).iter().skip(1).map(|h| format!("{h:.2}")).collect();
        let list = match form {
            0 => format!("height_cm = 150\nrebounds_cm = [{}]\n", values.join(", ")),
            1 => format!("% a ball on tiles\nrelease_cm = 150;\nrebounds_cm = np.array([{}]);\n", values.join(" ")),
            _ => format!("unit: cm\nrelease: 150\nbounces:\n{}", values.iter().map(|h| format!("  - {h}\n")).collect::<String>()),
        };
        prop_assert!(near(trusted(&list), e), "{}", list);
    }

    /// A letter below `Sample` names what was dropped.
    #[test]
    fn a_letter_in_a_sample_names_a_ball(e in 0.5f64..0.8) {
        let row = |(n, h): (usize, f64)| {
            let (name, own) = if n % 2 == 0 { ("A", e) } else { ("B", e + 0.1) };
            format!("{name},{h},{:.2}\n", h * own * own)
        };
        let rows: String = [150.0, 150.0, 120.0, 120.0, 80.0, 80.0].into_iter().enumerate().map(row).collect();
        let report = fit(&format!("Sample,Drop (cm),Rebound (cm)\n{rows}"));
        let found: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert!(matches!(found.as_slice(), [a, b] if near(*a, e) && near(*b, e + 0.1)), "{}", report);
    }

    /// A letter around a table changes nothing.
    #[test]
    fn a_table_stands_within_a_letter(e in 0.5f64..0.85) {
        let rows: String = heights(e, 5).into_iter().enumerate().map(|(n, h)| format!("{n}        {h:.2}\n")).collect();
        let text = format!(
            "Hi,\n\nhere are my numbers from yesterday, we dropped the ball in the gym; it was\nfun, and filmed it:\n\n\
             bounce   height (cm)\n{rows}\nThe last one is a bit of a guess. Can you help?\n\nThanks\nTom\n"
        );
        prop_assert!(near(trusted(&text), e));
    }

    /// A row of units stands below the names, or below the numbers.
    #[test]
    fn units_may_stand_below_the_numbers(e in 0.5f64..0.85) {
        let rows: String = [150.0, 120.0, 100.0].map(|h| format!("{h},{:.2}\n", h * e * e)).concat();
        let found = trusted(&format!("drop,rebound\n{rows}cm,cm\n"));
        prop_assert!(near(found, e));
    }

    /// Contacts and tops in turn are events.
    #[test]
    fn every_other_height_may_be_that_of_the_floor(e in 0.5f64..0.85) {
        let (mut text, mut time) = ("t (s),h (m)\n0,1.5\n".to_owned(), (2.0f64 * 1.5 / 9.81).sqrt());
        for n in 1..5 {
            let half = (2.0f64 * 1.5 / 9.81).sqrt() * e.powi(n);
            text += &format!("{time:.4},0\n{:.4},{:.4}\n", time + half, 1.5 * e.powi(2 * n));
            time += 2.0 * half;
        }
        let report = fit(&text);
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
        prop_assert!(report.notes().iter().any(|note| note.to_string().contains("events")), "{}", report);
    }

    /// Heights before each bounce that are those after the one before, times a factor.
    #[test]
    fn heights_that_repeat_others_are_no_readings(e in 0.5f64..0.85, factor in prop::sample::select(vec![0.9, 0.95, 1.05, 0.01])) {
        let pairs: Vec<f64> = heights(e, 6);
        let rows = |factor: f64| -> String { pairs.windows(2).map(|w| format!("{:.4},{:.4}\n", factor * w[0], w[1])).collect() };
        let report = fit(&format!("height before bounce (cm),height after bounce (cm)\n{}", rows(factor)));
        prop_assert!(report.verdict() == Verdict::Doubtful, "{}", report);
        let found = trusted(&format!("height before bounce (cm),height after bounce (cm)\n{}", rows(1.0)));
        prop_assert!(near(found, e));
    }
}

/// Contacts that fall into one frame of a film end the list: those before it are read.
#[test]
fn contacts_of_one_frame_end_the_list() {
    let read = |times: &[f64]| {
        typed::read(&format!("contact time (s)\n{}", times.iter().map(|t| format!("{t}\n")).collect::<String>()))
    };
    let table = read(&[0.5, 1.3, 1.9, 2.3, 2.3, 2.4]).unwrap();
    assert_eq!(table.trials()[0].readings().len(), 4);
    assert_eq!(table.left_aside().iter().filter(|aside| aside.why == Why::Unresolved).count(), 2);
    // Of two in order nothing tells that they are.
    assert!(read(&[0.5, 1.3, 1.3, 2.3]).is_err() && read(&[0.5, 1.3, 1.9, 1.2]).is_ok());
}

/// Means of nobody says how many are those of two.
#[test]
fn means_of_an_unknown_number_are_of_few() {
    let table = |title: &str| format!("{title}\nbounce,height_cm\n0,200\n1,98\n2,48\n3,23.5\n4,11.5\n");
    let length = |title: &str| {
        let report = saltus_fit::Fit::new()
            .drag(0.0)
            .sigma_zero(1e-4)
            .sigma_height(0.003)
            .run(&typed::read(&table(title)).unwrap())
            .unwrap();
        report.cor().map(|cor| cor.high - cor.low).unwrap()
    };
    assert!(length("Means") > length("Means of 4 drops") && length("Means of 4 drops") > length("Means of 9 drops"));
}

/// A remark in one of a hundred rows says what the numbers are of.
#[test]
fn words_are_looked_for_among_two_hundred_rows() {
    let row = |n: usize| {
        let drop = 100.0 + n as f64;
        format!("{drop},{:.1},{}\n", drop * 0.64, if n == 60 { "a bounce on wood" } else { "" })
    };
    let table = |rows: usize| format!("before (cm),after (cm),remark\n{}", (0..rows).map(row).collect::<String>());
    assert_eq!(fit(&table(100)).verdict(), Verdict::Trusted);
    assert_eq!(fit(&table(50)).verdict(), Verdict::Doubtful);
}

#[test]
fn ends_of_the_ball_that_differ_are_doubted() {
    let text =
        |end: &str| format!("drop height to bottom (cm),rebound height to {end} (cm)\n150,84.4\n180,101.2\n210,118\n");
    let report = fit(&text("top"));
    assert!(report.verdict() == Verdict::Doubtful && report.reason().contains("ends of the ball"), "{report}");
    assert!((trusted(&text("bottom")) - 0.75).abs() < 2e-3);
}
