//! Forms in which readings are typed other than one a cell: several in a cell, in lines of text, in
//! tables of a wiki, beside columns of rates and of row numbers. Each says what the plain table of
//! the same numbers says.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, Verdict};

/// The COR of a table, which is trusted, and how many readings it has.
fn counted(text: &str) -> (f64, usize) {
    let readings = read(text).unwrap().trials().iter().map(|trial| trial.readings().len()).sum();
    (trusted(text), readings)
}

/// Heights of drops from which repeats are read: each drop, and `count` rebounds of it.
fn drops(e: f64, count: usize) -> Vec<(u32, Vec<f64>)> {
    let repeat = |h: u32, n: usize| f64::from(h) * e * e * (1.0 + 0.01 * (n as f64 - 0.5 * (count - 1) as f64));
    [60, 80, 100, 120].into_iter().map(|h| (h, (0..count).map(|n| repeat(h, n)).collect())).collect()
}

fn joined(numbers: &[f64], mark: &str) -> String {
    numbers.iter().map(|h| format!("{h:.2}")).collect::<Vec<_>>().join(mark)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(48), failure_persistence: None, ..ProptestConfig::default() })]

    /// A cell that is no number, and whose parts are, alike in size, holds repeats: it says what a
    /// column for each of them says.
    #[test]
    fn repeats_in_one_cell(
        e in 0.4f64..0.9, count in 2usize..5, unit: bool,
        mark in prop::sample::select(vec!["/", " / ", ";", "; ", ", ", " ", " & "]),
    ) {
        let drops = drops(e, count);
        let names: Vec<String> = (1..=count).map(|n| format!("trial {n}: Rebound (cm)")).collect();
        let mut plain = format!("Drop (cm)\t{}\n", names.join("\t"));
        let mut typed = format!("Drop (cm)\tRebound{}\n", if unit { "" } else { " (cm)" });
        for (drop, rebounds) in &drops {
            plain += &format!("{drop}\t{}\n", joined(rebounds, "\t"));
            typed += &format!("{drop}\t{}{}\n", joined(rebounds, mark), if unit { " cm" } else { "" });
        }
        let (plain, typed) = (counted(&plain), counted(&typed));
        prop_assert!((plain.0 - typed.0).abs() < 1e-9 && plain.1 == typed.1, "{:?} {:?}", plain, typed);
        prop_assert!((typed.0 - e).abs() < 3e-3);
    }

    /// Lines that differ in their numbers only: a row each, whatever words or arrows stand between.
    #[test]
    fn a_drop_a_line(e in 0.5f64..0.9, form in 0usize..5, title: bool) {
        let mut text = if title { "All heights in cm, group 3\n".to_owned() } else { String::new() };
        for h in [150.0, 120.0, 100.0, 80.0] {
            let [a, b] = [h * e * e, h * e.powi(4)];
            text += &match form {
                0 => format!("{h:.0} cm -> {a:.1} cm -> {b:.1} cm\n"),
                1 => format!("{h:.0}cm→{a:.1}cm\n"),
                2 => format!("dropped from {:.2} m, came back up to {a:.1} cm\n", h / 100.0),
                3 => format!("Dropped from {h:.0} cm and bounced to {a:.1} cm.\n"),
                _ => format!("Drop height {h:.0} cm gave a rebound height of {a:.1} cm\n"),
            };
        }
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}{}", text, report);
    }

    /// A table of a wiki says what the table without its marks says.
    #[test]
    fn tables_of_a_wiki(e in 0.5f64..0.9, inline: bool, bold: bool) {
        let heights: Vec<f64> = (0..5).map(|n| 100.0 * e.powi(2 * n)).collect();
        let plain = heights.iter().enumerate().fold("Bounce\tHeight (cm)\n".to_owned(), |t, (n, h)| t + &format!("{n}\t{h:.1}\n"));
        let mut text = "Our results:\n\n{| class=\"wikitable\"\n|+ Ball on wood\n! Bounce !! Height (cm)\n".to_owned();
        for (n, h) in heights.iter().enumerate() {
            let h = if bold { format!("'''{h:.1}'''") } else { format!("{h:.1}") };
            text += &if inline { format!("|-\n| {n} || {h}\n") } else { format!("|-\n| {n}\n| align=\"right\" | {h}\n") };
        }
        prop_assert_eq!(counted(&(text + "|}\n")), counted(&plain));
    }

    /// A column or a line that states a rate is the rate of the frames, or samples, beside it.
    #[test]
    fn rates_in_a_column(e in 0.6f64..0.9, form in 0usize..4, rate in prop::sample::select(vec![240u32, 480, 1000])) {
        let fall = (2.0 * 1.0 / 9.81f64).sqrt();
        let time = |n: i32| 0.3 + fall + 2.0 * fall * (1..=n).map(|k| e.powi(k)).sum::<f64>();
        let frames: Vec<f64> = (0..6).map(|n| (time(n) * f64::from(rate)).round()).collect();
        let rows = |more: &str| frames.iter().enumerate().map(|(n, f)| format!("{},{f}{more}\n", n + 1)).collect::<String>();
        let text = match form {
            0 => format!("bounce,frame,fps\n{}", rows(&format!(",{rate}"))),
            1 => format!("Bounce,Frame,Frame rate (Hz)\n{}", rows(&format!(",{rate}"))),
            2 => format!("Frame rate,{rate}\nBounce,Frame\n{}", rows("")),
            _ => format!("Frame rate,{rate} fps\nBounce,Frame\n{}", rows("")),
        };
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 0.02, "{}{}", text, report);
        // Rates that differ are none.
        let two = format!("bounce,frame,fps\n{}", rows(",240").replacen(",240", ",120", 1));
        prop_assert!(read(&two).unwrap_err().is_question());
    }

    /// What is lost so far, beside a height of release that is stated: as the heights that are
    /// left.
    #[test]
    fn losses_that_add_up(e in 0.5f64..0.9, name in prop::sample::select(vec![
        "Height lost so far (cm)", "Total height lost (cm)", "Cumulative loss (cm)", "Total loss of height (cm)",
    ])) {
        let lost = |n: i32| 120.0 * (1.0 - e.powi(2 * n));
        let rows: String = (1..6).map(|n| format!("{n},{:.2}\n", lost(n))).collect();
        let report = fit(&format!("Drop height: 120 cm\nBounce,{name}\n{rows}"));
        prop_assert!((report.cor().unwrap().value - e).abs() < 2e-3, "{}", report);
        prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}", report);
        let asked = read(&format!("Bounce,{name}\n{rows}")).unwrap_err();
        prop_assert!(asked.is_question(), "{}", asked);
    }

    /// Numbers of rows without a name, as programs print them, shift no column.
    #[test]
    fn rows_that_a_program_numbers(e in 0.5f64..0.9, drops: bool) {
        let mut text = if drops { "   drop_cm  rebound_cm\n" } else { "   bounce  height_cm\n" }.to_owned();
        for n in 0..5 {
            let (first, second) = if drops {
                (format!("{:.1}", 120.0 - 10.0 * f64::from(n)), (120.0 - 10.0 * f64::from(n)) * e * e)
            } else {
                (n.to_string(), 100.0 * e.powi(2 * n))
            };
            text += &format!("{n}  {first:>7}  {second:>9.2}\n");
        }
        prop_assert!((counted(&text).0 - e).abs() < 2e-3);
    }

    /// A letter missing, too many, wrong, or changed over in a word of six or more: it is read, and
    /// said.
    #[test]
    fn a_slip_in_a_name(e in 0.5f64..0.9, at in 1usize..6, slip in 0usize..3) {
        let mut word: Vec<char> = "rebound".chars().collect();
        match slip {
            0 => drop(word.remove(at)),
            1 => word.insert(at, word[at]),
            _ => word.swap(at, at + 1),
        }
        let name: String = word.into_iter().collect();
        let rows: String = [60.0, 80.0, 100.0].map(|h| format!("{h},{:.2}\n", h * e * e)).concat();
        match read(&format!("Drop (cm),{name} (cm)\n{rows}")) {
            Ok(table) => {
                let report = Fit::new().run(&table).unwrap();
                prop_assert!((report.cor().unwrap().value - e).abs() < 1e-3, "{}", report);
                // Without its u it is French.
                let said = name == "rebond" || table.notes().iter().any(|note| note.to_string().starts_with(&format!("'{name}' in")));
                prop_assert!(said, "{:?}", table.notes());
            }
            Err(error) => prop_assert!(error.is_question() && error.to_string().contains("did you mean"), "{}", error),
        }
    }

    /// In a table that commas part, quoted numbers have decimal commas where some have other than
    /// three digits behind one.
    #[test]
    fn quoted_decimal_commas(e in 0.5f64..0.9) {
        let number = |h: f64, digits: usize| format!("\"{h:.digits$}\"").replace('.', ",");
        let rows: String = [1.0, 1.5, 2.0, 2.5].map(|h| format!("{},{}\n", number(h, 2), number(h * e * e, 3))).concat();
        let (cor, _) = counted(&format!("Drop (m),Rebound (m)\n{rows}"));
        prop_assert!((cor - e).abs() < 2e-3);
    }

    /// Attributes of a page need no quotes.
    #[test]
    fn spans_without_quotes(e in 0.5f64..0.9, quote: bool) {
        let q = if quote { "\"" } else { "" };
        let mut text = format!(
            "<table border=1><tr><th rowspan={q}2{q}>Drop (cm)</th><th colspan={q}2{q}>Rebound (cm)</th></tr>\
             <tr><th>Trial 1</th><th>Trial 2</th></tr>"
        );
        for h in [80.0, 100.0, 120.0] {
            text += &format!("<tr><td>{h}<td>{:.2}<td>{:.2}</tr>", 1.005 * h * e * e, 0.995 * h * e * e);
        }
        prop_assert!((counted(&(text + "</table>")).0 - e).abs() < 2e-3);
    }

    /// Hundredths are of the release: releases in hundredths that differ are of something else.
    #[test]
    fn releases_are_no_hundredths(fall in 10.0f64..60.0, part in 0.3f64..0.9) {
        let rows: String = [1.0, 1.2, 0.8, 1.1].map(|n| format!("{:.1},{:.1}\n", n * fall, n * fall * part)).concat();
        let asked = read(&format!("Drop (%),Rebound (%)\n{rows}")).unwrap_err();
        prop_assert!(asked.is_question() && asked.to_string().contains("hundredths"), "{}", asked);
    }

    /// A notebook: a line of words and what was read, below a title; or one line of a name and all
    /// numbers.
    #[test]
    fn lines_of_a_notebook(e in 0.5f64..0.9, words in 0usize..3) {
        let lines = |name: &dyn Fn(i32) -> String| {
            let line = |n: i32| format!("{} {:.2} cm\n", name(n), 150.0 * e.powi(2 * n));
            (1..5).map(line).fold("Golf ball on tile\nRelease 150 cm\n".to_owned(), |text, line| text + &line)
        };
        let text = match words {
            0 => lines(&|n| format!("Bounce {n}")),
            1 => lines(&|n| format!("after bounce {n}")),
            _ => lines(&|n| format!("{} bounce", ["1st", "2nd", "3rd", "4th"][n as usize - 1])),
        };
        prop_assert!((fit(&text).cor().unwrap().value - e).abs() < 2e-3, "{}", text);
        let times: Vec<String> = (0..6).map(|n| format!("{:.4}", 1.0 + (1.0 - e.powi(n)) / (1.0 - e))).collect();
        let report = fit(&format!("Bounce times (s): {}\n", times.join(", ")));
        prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}", report);
    }

    /// Times without a unit are in that in which a ball bounces so long; the COR needs none.
    #[test]
    fn times_without_a_unit(e in 0.6f64..0.9, milli: bool, between: bool) {
        let unit = if milli { 1000.0 } else { 1.0 };
        let flights = (1..7).map(|n| 0.9 * e.powi(n));
        let read = |name: &str, time: f64, n: usize| if name.is_empty() { format!("{n},{time:.5}\n") } else { name.to_owned() };
        let mut clock = 1.3;
        let rows: String = flights.enumerate().map(|(n, flight)| {
            clock += flight;
            read("", unit * if between { flight } else { clock }, n + 1)
        }).collect();
        let name = if between { "Time between bounces" } else { "Time of impact" };
        let report = fit(&format!("Bounce,{name}\n{rows}"));
        prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}", report);
    }

    /// Flights that are named by their ends, whatever that column is called.
    #[test]
    fn flights_named_by_their_ends(e in 0.6f64..0.9, name in prop::sample::select(vec!["Bounce pair", "Gap", "Which", "Pair"])) {
        let rows: String = (1..6).map(|n| format!("{n}-{},{:.4}\n", n + 1, 0.9 * e.powi(n))).collect();
        let report = fit(&format!("{name},Time of flight between bounces (s)\n{rows}"));
        prop_assert!((report.cor().unwrap().value - e).abs() < 3e-3, "{}", report);
    }

    /// Numbers of one unit under the names of two are doubted; those of two are not.
    #[test]
    fn units_that_were_mixed_up(e in 0.4f64..0.9) {
        let table = |drop: &str, rebound: &str, [of, to]: [f64; 2]| {
            let rows: String = [1.0, 1.5, 2.0].map(|h| format!("{},{:.3}\n", of * h, to * h * e * e)).concat();
            fit(&format!("Drop ({drop}),Rebound ({rebound})\n{rows}"))
        };
        for (drop, rebound, of) in [("m", "cm", 1.0), ("ft", "in", 4.0), ("cm", "mm", 100.0)] {
            let slip = table(drop, rebound, [of, of]);
            prop_assert_eq!(slip.verdict(), Verdict::Doubtful, "{}", slip);
        }
        for (drop, rebound, units) in [("m", "cm", [1.0, 100.0]), ("cm", "mm", [100.0, 1000.0]), ("ft", "in", [4.0, 48.0])] {
            let sound = table(drop, rebound, units);
            prop_assert_eq!(sound.verdict(), Verdict::Trusted, "{}", sound);
        }
    }

    /// Letters, or numbers, before a colon count columns, where no two hold the same.
    #[test]
    fn columns_that_are_counted(e in 0.5f64..0.9, letters: bool) {
        let [one, two] = if letters { ["A", "B"] } else { ["1", "2"] };
        let rows: String = [60.0, 80.0, 100.0].map(|h| format!("{h},{:.2}\n", h * e * e)).concat();
        let (cor, _) = counted(&format!("{one}: height dropped (cm),{two}: height bounced (cm)\n{rows}"));
        prop_assert!((cor - e).abs() < 2e-3);
    }

    /// A table that speaks of another motion, in which heights and speeds fall alike, is doubted,
    /// wherever it says so.
    #[test]
    fn another_motion_is_doubted(e in 0.5f64..0.9, list: bool, said in 0usize..3, motion in prop::sample::select(vec![
        "Pendulum with a steel ball", "Ball rolling down and up a ramp", "Bungee jump", "Two carts collide", "Pendel", "Swinging ball",
    ])) {
        let rows: String = if list {
            (0..5).map(|n| format!("{n},{:.2}\n", 100.0 * e.powi(2 * n))).collect()
        } else {
            [60.0, 80.0, 100.0].map(|h| format!("{h},{:.2}\n", h * e * e)).concat()
        };
        let table = format!("{}\n{rows}", if list { "Bounce,Height (cm)" } else { "Drop (cm),Rebound (cm)" });
        prop_assert_eq!(fit(&table).verdict(), Verdict::Trusted, "{}", table);
        let text = match said {
            0 => format!("{motion}\n{table}"),
            1 => format!("# {motion}\n{table}"),
            _ => format!("{table}\n{motion}\n"),
        };
        let report = fit(&text);
        prop_assert!(report.verdict() == Verdict::Doubtful && report.reason().contains("another motion"), "{}{}", text, report);
    }
}

/// A flight after each of several drops is that of its own drop, in whatever order they stand: it
/// is no running clock where the drops grow.
#[test]
fn flights_of_drops_may_grow_with_them() {
    let heights = [0.5f64, 0.75, 1.0, 1.25, 1.5];
    for order in [[0, 1, 2, 3, 4], [4, 3, 2, 1, 0], [2, 0, 4, 1, 3]] {
        let rows: String =
            order.map(|n| format!("{},{:.3}\n", heights[n], 1.6 * (2.0 * heights[n] / 9.81).sqrt())).concat();
        let cor = trusted(&format!("drop height (m),flight time (s)\n{rows}"));
        assert!((cor - 0.8).abs() < 0.003, "{order:?}: {cor}");
    }
}

/// What counts peaks or rebounds numbers them, and a title with a unit is the name of the numbers
/// below it.
#[test]
fn peaks_are_counted_and_titles_name_what_is_below_them() {
    for text in [
        "Peak no.,Height of bounce (cm)\n0,100\n1,64\n2,41\n3,26.2\n",
        "Height of bounce (cm)\ndrop 100\n1st 64\n2nd 41\n3rd 26.2\n",
        "Bounce height [cm]\n\ndrop 100\nfirst 64\nsecond 41\nthird 26.2\n",
        "跌落高度 (cm),反弹高度 (cm)\n100,64\n80,51.2\n60,38.4\n",
    ] {
        let cor = trusted(text);
        assert!((cor - 0.8).abs() < 0.003, "{text}: {cor}");
    }
}
