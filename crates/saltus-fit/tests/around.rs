//! What stands around the numbers of a table: lines that name them all, paragraphs of a page,
//! the codes of what was dropped, remarks below. Each says what the plain table says, or nothing.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

/// A drop and its rebounds, or the times of contacts, of a ball of this COR.
fn heights(e: f64) -> Vec<f64> {
    (0..5).map(|n| 150.0 * e.powi(2 * n)).collect()
}

fn contacts(e: f64) -> Vec<f64> {
    (0..6).map(|n| 1.2 + 0.9 * (1.0 - e.powi(n)) / (1.0 - e)).collect()
}

/// Rebounds of drops from `from`, which scatter by half a hundredth.
fn rebounds(e: f64, from: f64) -> Vec<f64> {
    [0.0, 0.004, -0.005, 0.002, -0.001, 0.003].map(|off| from * e * e * (1.0 + off)).to_vec()
}

fn named(name: &str, text: &str) -> Report {
    let table = Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Fit::new().run(&table).unwrap()
}

fn near(found: f64, e: f64) -> bool {
    (found - e).abs() < 4e-3
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// A line says what all numbers below it are, and in which unit; each stands behind its name.
    #[test]
    fn a_line_names_the_numbers_of_a_list(
        e in 0.6f64..0.85, words in 0..6usize, mark in prop::sample::select(vec![": ", " = ", " : "]), colon: bool, counted: bool,
    ) {
        let (title, name, timed) = [
            ("Rebound heights (cm)", "bounce", false),
            ("Hauteurs de rebond (cm)", "rebond", false),
            ("Höhe nach dem Aufprall in cm", "Aufprall", false),
            ("Times of the hits (s)", "hit", true),
            ("A koppanások időpontjai (s)", "koppanás", true),
            ("Aufprallzeiten [s]", "Aufprall", true),
        ][words];
        let numbers = if timed { contacts(e) } else { heights(e)[1..].to_vec() };
        let row = |(n, value): (usize, &f64)| {
            let n = n + 1;
            let name = if counted { format!("{n}. {name}") } else { format!("{name} {n}") };
            format!("{name}{mark}{value:.3}\n")
        };
        let rows: String = numbers.iter().enumerate().map(row).collect();
        let text = format!("Bouncing ball\n{title}{}\n{rows}\nZorb measured it\n", if colon { ":" } else { "" });
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// A sentence may tell what a line of the list tells again; where they differ it is not read.
    #[test]
    fn a_list_may_tell_its_drop_twice(e in 0.6f64..0.85, words in 0..3usize) {
        let (told, first, name) = [
            ("We dropped the ball from 150.0 cm and filmed how it bounced, as Zorb did.", "drop height: 150.0 cm", "bounce"),
            ("On lâche la balle de 150,0 cm (bas de la balle) et on relève la hauteur après chaque rebond.", "hauteur de départ : 150,0 cm", "rebond"),
            ("Wir haben den Ball aus 150,0 cm fallen lassen und die Höhen abgelesen.", "Fallhöhe: 150,0 cm", "Aufprall"),
        ][words];
        let mark = if first.contains(" :") { " : " } else { ": " };
        let row = |n: usize| format!("{name} {n}{mark}{:.1} cm\n", heights(e)[n]);
        let text = |told: &str| format!("Zorb\n{told}\n\n{first}\n{}", (1..5).map(row).collect::<String>());
        prop_assert!(near(trusted(&text(told)), e), "{}", text(told));
        let other = text(&told.replace("150", "180"));
        if let Ok(table) = read(&other) {
            let report = Fit::new().run(&table).unwrap();
            prop_assert!(report.verdict() != Verdict::Trusted || near(report.cor().unwrap().value, e), "{}{}", other, report);
        }
    }

    /// What a page tells around its table is told of it, whatever script it holds.
    #[test]
    fn a_page_tells_around_its_table(e in 0.5f64..0.85, words in 0..4usize, caption: bool) {
        let (drop, unit, head) = [
            ("Dropped from <b>180&nbsp;cm</b> onto tiles.", "All heights in cm.", "<th>Trial</th><th>Rebound height</th>"),
            ("Piłkę upuszczano z wysokości 180 cm.", "W tabeli podano wysokość po odbiciu w cm.", "<th>nr</th><th>próba 1</th><th>próba 2</th>"),
            ("Der Ball fiel aus 1,80 m.", "Alle Höhen in cm.", "<th>Versuch</th><th>Höhe nach dem Aufprall</th>"),
            ("La balle est lâchée de 1,80 m.", "Toutes les hauteurs en cm.", "<th>essai</th><th>hauteur du rebond</th>"),
        ][words];
        let cells = rebounds(e, 180.0);
        let wide = head.matches("<th>").count() - 1;
        let row = |(n, pair): (usize, &[f64])| {
            let cells: String = pair.iter().map(|h| format!("<td>{h:.1}</td>")).collect();
            format!("<tr><td>{}</td>{cells}</tr>", n + 1)
        };
        let rows: String = cells.chunks(wide).enumerate().map(row).collect();
        let (above, inside) = if caption { (drop, format!("<caption>{unit}</caption>")) } else { (drop, String::new()) };
        let told = if caption { String::new() } else { format!("<p>{unit}</p>") };
        let page = format!(
            "<html><head><style>td {{ height: 12 cm }}</style></head><body><h1>Zorb</h1><p>{above}</p>{told}\
             <table>{inside}<tr>{head}</tr>{rows}</table><p>Class 8b, group 4</p></body></html>"
        );
        let report = named("a.html", &page);
        prop_assert!(near(report.cor().unwrap().value, e) && report.verdict() == Verdict::Trusted, "{}{}", page, report);
    }

    /// The letters and numbers at the edges of a spreadsheet are no part of a page of it.
    #[test]
    fn a_page_of_a_spreadsheet(e in 0.5f64..0.85) {
        let cell = |text: &str| format!("<td>{text}</td>");
        let line = |(n, cells): (usize, &Vec<String>)| format!("<tr><th>{}</th>{}</tr>", n + 1, cells.iter().map(|c| cell(c)).collect::<String>());
        let mut lines = vec![vec!["Zorb ball".to_owned(), String::new()], vec!["drop height (cm)".to_owned(), "rebound (cm)".to_owned()]];
        lines.extend([60.0, 80.0, 100.0, 120.0].map(|h: f64| vec![format!("{h}"), format!("{:.2}", h * e * e)]));
        let rows: String = lines.iter().enumerate().map(line).collect();
        let page = format!("<table><tr><th></th><th>A</th><th>B</th></tr>{rows}</table>");
        prop_assert!(near(named("Sheet1.html", &page).cor().unwrap().value, e), "{}", page);
    }

    /// Codes, numbers and names of trials that are others in every row part no balls.
    #[test]
    fn codes_of_what_was_dropped_tell_nothing_apart(e in 0.5f64..0.85, form in 0..7usize) {
        let row = |(n, h): (usize, f64)| {
            let n = n + 1;
            let (letter, place) = (char::from(b'A' + u8::try_from(n).unwrap()), 10 * n);
            let name = match form {
                0 => format!("GX-{}", 100 + n),
                1 => format!("SN{:04}", 7000 + n),
                2 => format!("golf ball trial {n}"),
                3 => format!("tennis ball {n}"),
                4 => format!("ball {letter}"),
                5 => format!("{n}"),
                _ => format!("TB-{place}"),
            };
            format!("{name},180,{h:.2}\n")
        };
        let head = ["Serial no.", "Seriennummer", "Ball", "Ball", "Ball", "Which lab table are you at?", "Zorb"][form];
        let rows: String = rebounds(e, 180.0).into_iter().enumerate().map(row).collect();
        let report = fit(&format!("{head},Drop (cm),Rebound (cm)\n{rows}"));
        prop_assert!(report.groups().is_empty() && near(report.cor().unwrap().value, e), "{}", report);
        prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}", report);
        // Balls that differ are told apart.
        let other = "golf ball,180,20\n";
        let report = fit(&format!("Ball,Drop (cm),Rebound (cm)\ntennis ball,180,{:.2}\n{other}", 180.0 * e * e));
        prop_assert_eq!(report.groups().len(), 2);
    }

    /// In a log of impacts that nothing else was measured of, what else happened is no contact.
    #[test]
    fn a_log_of_impacts_names_other_things(e in 0.6f64..0.9, first in prop::sample::select(vec!["app opened", "session_start", "zorb"]), json: bool, head in prop::sample::select(vec!["event", "type"])) {
        let mut events = vec![(0.1, first)];
        events.extend(contacts(e).into_iter().map(|t| (t, "impact")));
        events.push((9.5, "session_end"));
        let text = if json {
            let row = |(t, name): &(f64, &str)| format!("{{\"{head}\": \"{name}\", \"time_s\": {t:.4}}}");
            format!("[{}]", events.iter().map(row).collect::<Vec<_>>().join(","))
        } else {
            format!("time_s,{head}\n{}", events.iter().map(|(t, name)| format!("{t:.4},{name}\n")).collect::<String>())
        };
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// The time between the first two contacts, in any language, is the flight after the drop
    /// beside it.
    #[test]
    fn the_first_flight_beside_a_height(e in 0.5f64..0.85, names in 0..5usize) {
        let names = [
            "H (m),tempo entre o 1º e o 2º quique (s)",
            "height (m),time between 1st and 2nd bounce (s)",
            "hauteur (m),durée entre le 1er et le 2e rebond (s)",
            "h (m),Zeit zwischen 1. und 2. Aufprall (s)",
            "drop height (m),time between first and second bounce (s)",
        ][names];
        let row = |h: f64| format!("{h},{:.4}\n", 2.0 * e * (2.0 * h / 9.81f64).sqrt());
        let text = format!("{names}\n{}", [0.5, 0.5, 1.0, 1.5, 2.0].map(row).concat());
        prop_assert!(near(trusted(&text), e), "{}", text);
    }

    /// What led to a height and what it came back to may be said by two small words.
    #[test]
    fn arrows_lead_back_up(e in 0.5f64..0.85, words in 0..5usize) {
        let (from, to) = [("van", "terug tot"), ("aus", "zurück auf"), ("from", "back up to"), ("van", "naar"), ("from", "up to")][words];
        let row = |h: f64| format!("{from} {h} cm -> {to} {:.1} cm\n", h * e * e);
        let text = format!("Bouncing ball\n\n{}\nZorb read it to about 1 cm.\n", [60.0, 80.0, 100.0, 120.0].map(row).concat());
        prop_assert!(near(fit(&text).cor().unwrap().value, e), "{}", text);
    }

    /// Lengths of a ball or of an error place no floor, and an example above the results is none of
    /// them.
    #[test]
    fn remarks_around_a_table_turn_nothing(e in 0.5f64..0.85, remark in 0..6usize) {
        let (above, below) = [
            ("Ball: super ball 27 mm, floor: granite", ""),
            ("", "Note: the heights were read with a tape, uncertainty 1 cm."),
            ("", "Nota: las alturas se leyeron con cinta métrica, incertidumbre 1 cm."),
            ("Example: a ball dropped from 50 cm bounces to 40 cm\nMy results", ""),
            ("ITF style test of rebound", ""),
            ("", "Mass of ball (kg),0.0102"),
        ][remark];
        let rows = [60.0, 80.0, 100.0, 120.0].map(|h: f64| format!("{h},{:.2}\n", h * e * e)).concat();
        let above = above.replace(", ", ",\t").replace(',', ";").replace(";\t", ", ");
        let quoted = |line: &str| if line.contains(", ") { format!("\"{line}\"") } else { line.to_owned() };
        let above: String = above.lines().map(|line| quoted(line) + "\n").collect();
        let below = if below.contains(", ") { quoted(below) } else { below.to_owned() };
        let text = format!("{above}Drop (cm),Rebound (cm)\n{rows}{below}\n");
        prop_assert!(near(trusted(&text), e), "{}", text);
    }
}

/// What stands in a line by itself still says that what follows was not measured.
#[test]
fn what_was_predicted_is_doubted() {
    for title in ["My results\nPredicted heights", "Example", "ITF limits"] {
        let report = fit(&format!("{title}\nDrop (cm),Rebound (cm)\n100,64\n80,51.2\n60,38.4\n"));
        assert_eq!(report.verdict(), Verdict::Doubtful, "{title} {report}");
    }
    // A floor that is stated is none of the ball.
    let report = fit("tennis ball, the floor is at the 12 cm mark\nbounce,height (cm)\n0,112\n1,76\n2,53\n");
    assert!(report.verdict() == Verdict::Doubtful || report.notes().iter().any(|n| n.to_string().contains("12")));
    assert!(read("Zorb heights (cm):\nzorb 1: 64\nzorb 2: 41\n").is_err());
}

/// Several people type the name of a ball in capitals of their own, and with blanks.
#[test]
fn a_name_in_any_capitals_is_of_one_ball() {
    let mut text = String::from("ball,drop height (cm),rebound height (cm)\n");
    let names = [("Tennis ball", 0.74), ("golf ball", 0.85), ("tennis ball", 0.74), ("Golf  Ball", 0.85)];
    for (name, e) in names {
        let rows = rebounds(e, 150.0).into_iter().map(|h| format!("{name},150,{h:.1}\n"));
        text.extend(rows);
    }
    let table = read(&text).unwrap();
    assert_eq!(table.groups(), ["Tennis ball", "golf ball"]);
}

/// What stands above is not written again: a mark stands for it, in every column.
#[test]
fn a_mark_of_repetition_is_what_stands_above() {
    for mark in ["\"", "''", "-\"-", "-//-", "〃", "ditto", "idem", "то же"] {
        for blank in ["    ", "\t"] {
            let mut text = ["drop (cm)", "rebound (cm)", "floor"].join(blank) + "\n";
            for (from, first) in [("200", true), ("150", true), ("100", true)] {
                let height: f64 = from.parse().unwrap();
                for (n, h) in rebounds(0.78, height).into_iter().take(3).enumerate() {
                    let from = if n == 0 { from } else { mark };
                    let floor = if n == 0 && first { "tile" } else { mark };
                    text += &[from, &format!("{h:.1}"), floor].join(blank);
                    text.push('\n');
                }
            }
            let report = fit(&text);
            let e = report.cor().unwrap_or_else(|| panic!("{text}")).value;
            assert!(near(e, 0.78), "{e} {text}");
        }
    }
}
