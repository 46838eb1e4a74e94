//! What a table says beside its numbers: words that are not known, rows that do not count, units in
//! a column of their own, titles above lists, letters around a table. Each says what the plain
//! table of the same numbers says, or doubts.

use crate::typed;

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{ReadOptions, Table, Verdict, Why};

/// Heights of a drop and its bounces, cm.
fn heights(e: f64, count: i32) -> Vec<f64> {
    (0..count).map(|n| 150.0 * e.powi(2 * n)).collect()
}

fn near(found: f64, e: f64) -> bool {
    (found - e).abs() < 3e-3
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(12), failure_persistence: None, ..ProptestConfig::default() })]

    /// Where names of balls stand above numbers by themselves, one that is not known is a name too.
    #[test]
    fn a_name_among_names_of_balls_names_one(e in 0.5f64..0.85, name in prop::sample::select(vec!["Zorb", "Quax xyl"]), form in 0usize..3) {
        let cell = |h: f64, e: f64| match form {
            0 => format!("{:.1}%", 100.0 * e * e),
            1 => format!("{:.1} cm", h * e * e),
            _ => format!("{:.1}", h * e * e),
        };
        let row = |h: f64| format!("{h},{},{},{}\n", cell(h, 0.9), cell(h, e), cell(h, 0.8));
        let report = fit(&format!("Drop (cm),Golf ball,{name},Tennis ball\n{}", [150.0, 120.0, 100.0, 80.0].map(row).concat()));
        let found = report.groups().iter().find(|g| g.name == name);
        prop_assert!(found.is_some_and(|g| (g.report.cor().unwrap().value - e).abs() < 0.01), "{}", report);
    }

    /// Words where most are numbers say why a reading is missing: the drop is left aside.
    #[test]
    fn words_in_place_of_a_reading(e in 0.5f64..0.85, word in prop::sample::select(vec!["n/d", "too dark to see", "fehlt", "zorb"]), at in 0usize..6) {
        let row = |n: usize| if n == at { format!("100,{word}\n") } else { format!("100,{:.2}\n", 100.0 * e * e) };
        let report = fit(&format!("drop (cm),rebound (cm)\n{}", (0..6).map(row).collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
        prop_assert!(report.left_aside().iter().any(|aside| aside.line == Some(at as u64 + 2)), "{}", report);
    }

    /// Times until rest that are counted are repeats of each drop, and not its bounces.
    #[test]
    fn times_until_rest_are_repeated(e in 0.6f64..0.9, count in 2usize..4) {
        let names: Vec<String> = (1..=count).map(|n| format!("total time {n} (s)")).collect();
        let row = |h: f64| {
            let fall = (2.0 * h / 9.81f64).sqrt();
            let cells: Vec<String> = (0..count).map(|_| format!("{:.3}", fall * (1.0 + e) / (1.0 - e))).collect();
            format!("{},{}\n", 100.0 * h, cells.join(","))
        };
        let report = fit(&format!("drop height (cm),{}\n{}", names.join(","), [0.2, 0.3, 0.4, 0.5].map(row).concat()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
    }

    /// `T1` counts trials where no unit of time is stated, below the name of a ball or not, and the
    /// heights of release stand beside all balls.
    #[test]
    fn a_capital_t_counts_trials(e in 0.5f64..0.85, balls: bool, unit in prop::sample::select(vec!["cm", "inches"])) {
        let row = |h: f64| {
            let cells = [e, e, e - 0.1, e - 0.1].map(|e| format!("{:.2}", h * e * e));
            format!("{h},{}\n", cells[..if balls { 4 } else { 2 }].join(","))
        };
        let names = if balls { "Drop,Golf,,Tennis,\n,T1,T2,T1,T2" } else { "Drop,T1,T2" };
        let report = fit(&format!("all heights in {unit}\n{names}\n{}", [60.0, 48.0, 36.0, 24.0].map(row).concat()));
        let found: Vec<f64> = if balls { report.groups().iter().map(|g| g.report.cor().unwrap().value).collect() } else { vec![report.cor().unwrap().value] };
        prop_assert!(found.iter().zip([e, e - 0.1]).all(|(a, b)| near(*a, b)) && found.len() == if balls { 2 } else { 1 }, "{}", report);
    }

    /// What an arrow points from at the end of a line is a remark, and so is a line below bars.
    #[test]
    fn remarks_behind_arrows_and_below_bars(e in 0.5f64..0.85, arrow in prop::sample::select(vec!["<- released", "<-- let go here", "← dropped"]), bars: bool) {
        let by = if bars { " | " } else { "    " };
        let row = |n: i32| format!("{n}{by}{:.1}{}\n", 150.0 * e.powi(2 * n), if n == 0 { format!("   {arrow}") } else { String::new() });
        let report = fit(&format!("bounce{by}height\n{}(cm, read at the bottom)\n", (0..5).map(row).collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
    }

    /// Lengths of lines that were drawn are heights, and the brightness along them is none.
    #[test]
    fn lines_drawn_in_pictures(e in 0.5f64..0.85) {
        let row = |n: i32| format!("{n},shot{n}.jpg,{}.2,{}.7,40,180,90.1,{:.2}\n", 9 - n, 95 + 7 * n % 20, 140.0 * e.powi(2 * n));
        let report = fit(&format!(" ,Label,Area,Mean,Min,Max,Angle,Length\n{}", (0..5).map(row).collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
    }

    /// Velocities in time are no speeds of bounces, one after the other.
    #[test]
    fn velocities_in_time_are_a_question(e in 0.5f64..0.9, run in prop::sample::select(vec!["", " Run #3"])) {
        let (mut v, mut text) = (0.0, format!("Time (s){run},Velocity (m/s){run}\n"));
        for n in 0..60 {
            v = if n % 12 == 11 { -e * v } else { v - 0.196 };
            text += &format!("{:.2},{v:.3}\n", 0.02 * f64::from(n));
        }
        let error = typed::read(&text).expect_err("a question").to_string();
        prop_assert!(error.contains("velocity of a ball in flight") && error.contains("export the position"), "{}", error);
    }

    /// The name of a file may state the rate of its frames.
    #[test]
    fn the_name_of_a_file_states_a_rate(e in 0.6f64..0.85, name in prop::sample::select(vec!["impacts 240fps.csv", "drop_240_fps.csv", "a/b/Video-240fps.csv"])) {
        let rows = (0..6).map(|n| format!("{n},{:.0}\n", 100.0 + 2400.0 * (1.0 - e.powi(n)) / (1.0 - e)));
        let text = format!("impact,frame\n{}", rows.collect::<String>());
        let table = Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap();
        prop_assert_eq!(table.frame_rate(), Some(240.0));
        let bare = Table::parse("impacts.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
        prop_assert!(bare.notes().iter().any(|note| note.to_string().contains("unknown rate")));
    }

    /// A remark of as many names above numbers is their heading, whatever one of them is of.
    #[test]
    fn names_in_a_remark(e in 0.5f64..0.85, other in prop::sample::select(vec!["x", "mass"]), by in prop::sample::select(vec![" ", "  ", "\t"])) {
        let rows = (0..6).map(|n| format!("{n}{by}{}{by}{:.2}\n", 12 + 7 * n, 150.0 * e.powi(2 * n)));
        let report = fit(&format!("# made by a program\n# bounce{by}{other}{by}height_cm\n{}", rows.collect::<String>()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
    }

    /// Beside the speeds before and after a bounce the height of release is left aside.
    #[test]
    fn speeds_say_more_than_heights_of_release(e in 0.4f64..0.95, slow in 0.9f64..0.97) {
        let row = |h: f64| { let v = slow * (2.0 * 9.81 * h).sqrt(); format!("{:.0},{v:.3},{:.3}\n", 100.0 * h, e * v) };
        let report = fit(&format!("Bouncing ball\ndrop (cm),v_in (m/s),v_out (m/s)\n{}", [0.5, 0.75, 1.0, 1.25].map(row).concat()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
        prop_assert!(report.left_aside().iter().any(|aside| aside.name == "drop (cm)"), "{}", report);
    }

    /// The unit of an upper name is that of the names below it, and the name of a file states one.
    #[test]
    fn units_stand_above_and_in_the_name(e in 0.5f64..0.85, upper: bool) {
        let rows: String = [1.5, 1.2, 1.0].map(|h| format!("1,{h},{:.3}\n", h * e * e)).concat();
        let names = if upper { "Trial,Height (m),\n,release,rebound" } else { "Trial,release,rebound" };
        let name = if upper { "t.csv" } else { "our balls_heights_m.csv" };
        let table = Table::parse(name, format!("{names}\n{rows}").as_bytes(), &ReadOptions::default()).unwrap();
        let cor = saltus_fit::Fit::new().run(&table).unwrap().cor().unwrap().value;
        prop_assert!(near(cor, e), "{}", cor);
    }

    /// Speeds on the way down and on the way up are those before and after the bounce.
    #[test]
    fn speeds_of_both_ways(e in 0.4f64..0.95, ways in prop::sample::select(vec![("down", "up"), ("runter", "rauf"), ("giu", "salita")]), turned: bool) {
        let row = |v: f64| if turned { format!("{:.3};{v}\n", v * e) } else { format!("{v};{:.3}\n", v * e) };
        let (down, up) = (format!("v {} (m/s)", ways.0), format!("v {} (m/s)", ways.1));
        let names = if turned { format!("{up};{down}") } else { format!("{down};{up}") };
        let report = fit(&format!("{names}\n{}", [2.0, 2.5, 3.0, 4.0].map(row).concat()));
        prop_assert!(near(report.cor().unwrap().value, e), "{}", report);
    }

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
             bounce   height (cm)\n{rows}\nThe last one was hard to read. Can you help?\n\nThanks\nTom\n"
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
        let pairs: Vec<f64> = (0..6).zip(heights(e, 6)).map(|(n, h)| h * (1.0 + 0.003 * f64::from(n % 2))).collect();
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
