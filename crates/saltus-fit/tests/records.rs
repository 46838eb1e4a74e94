//! What is written as records, as a line of names and numbers, with errors beside readings, or as a
//! time from the release: each says what the plain table of the same numbers says. Columns that are
//! no readings of the same thing are not told apart by the name of a ball.

use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn doubted(report: &Report, words: &str) -> bool {
    report.verdict() == Verdict::Doubtful && report.reason().contains(words)
}

/// No ball keeps a factor better than to this part.
const OFF: f64 = 1e-3;

fn drops(e: f64) -> [(f64, f64); 4] {
    [60.0, 80.0, 100.0, 120.0].map(|h: f64| (h, h * e * e * (1.0 + OFF * h.sin())))
}

fn joined<T>(all: impl IntoIterator<Item = T>, mark: &str, text: impl Fn(T) -> String) -> String {
    all.into_iter().map(text).collect::<Vec<_>>().join(mark)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(32), failure_persistence: None, ..ProptestConfig::default() })]

    /// An object a row, a line each or in a list, or a list a column: the same COR as in a table.
    #[test]
    fn records_are_rows_and_lists_are_columns(e in 0.4f64..0.9, inside: bool) {
        let record = |(h, r): (f64, f64)| format!("{{\"drop (cm)\": {h}, \"rebound (cm)\": {r}, \"by\": \"Ann\"}}");
        let (list, lines) = (joined(drops(e), ",\n", record), joined(drops(e), "\n", record));
        let columns = [("drop_cm", joined(drops(e), ",", |d| d.0.to_string())), ("rebound_cm", joined(drops(e), ",", |d| d.1.to_string()))];
        let columns = joined(columns, ", ", |(name, list)| format!("\"{name}\": [{list}]"));
        let whole = |value: String| if inside { format!("{{\"made by\": \"an app\", \"data\": {value}}}") } else { value };
        for text in [whole(format!("[{list}]")), whole(format!("{{{columns}}}")), lines] {
            prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
        }
    }

    /// Objects within an object, or a list, are balls by their names.
    #[test]
    fn records_within_records_are_groups(e in 0.4f64..0.85, listed: bool) {
        let of = |name: &str, e: f64| {
            let drop = joined(drops(e), ",", |d| d.0.to_string());
            let rebound = joined(drops(e), ",", |d| d.1.to_string());
            let lists = format!("\"drop_cm\": [{drop}], \"rebound_cm\": [{rebound}]");
            if listed { format!("{{\"ball\": \"{name}\", {lists}}}") } else { format!("\"{name}\": {{{lists}}}") }
        };
        let both = format!("{}, {}", of("tennis", e), of("golf", e + 0.1));
        let report = fit(&if listed { format!("[{both}]") } else { format!("{{{both}}}") });
        let found: Vec<(&str, f64)> = report.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect();
        prop_assert!(matches!(found.as_slice(), [("tennis", a), ("golf", b)] if (a - e).abs() < 2e-3 && (b - e - 0.1).abs() < 2e-3), "{:?}", found);
    }

    /// Objects of a list that state a condition, and no words, are told apart by it.
    #[test]
    fn conditions_of_objects_tell_them_apart(
        e in 0.4f64..0.8,
        condition in prop::sample::select(vec![
            ("ball_temp_C", 23, 45), ("temperature (°C)", 5, 60), ("pressure_kPa", 40, 70), ("ball temp F", 41, 140),
        ]),
        lists: bool,
    ) {
        let of = |state: i32, e: f64| {
            let shots = if lists {
                let lists = |of: fn((f64, f64)) -> f64| joined(drops(e), ",", |d| of(d).to_string());
                format!("{{\"drop_cm\": [{}], \"rebound_cm\": [{}]}}", lists(|d| d.0), lists(|d| d.1))
            } else {
                format!("[{}]", joined(drops(e), ",", |(h, r)| format!("{{\"drop_cm\": {h}, \"rebound_cm\": {r}}}")))
            };
            format!("{{\"{}\": {state}, \"shots\": {shots}}}", condition.0)
        };
        let report = fit(&format!("{{\"series\": [{}, {}]}}", of(condition.1, e), of(condition.2, e + 0.1)));
        let found: Vec<(&str, f64)> = report.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect();
        let right = matches!(found.as_slice(), [(_, a), (_, b)] if (a - e).abs() < 2e-3 && (b - e - 0.1).abs() < 2e-3);
        prop_assert!(right && found.iter().all(|(name, _)| name.contains(condition.0)), "{:?}", found);
    }

    /// A record that says that it does not count is left aside, and named.
    #[test]
    fn records_that_were_withdrawn_do_not_count(
        e in 0.5f64..0.85, word in prop::sample::select(vec![("discarded", true), ("rejected", true), ("valid", false)]),
    ) {
        let run = |n: usize, e: f64, said: &str| {
            let list: Vec<String> = (0..5).map(|k| format!("{:.1}", 200.0 * e.powi(2 * k))).collect();
            format!("{{\"run\": {n}{said}, \"heights_cm\": [{}]}}", list.join(", "))
        };
        let withdrawn = format!(", \"{}\": {}", word.0, word.1);
        let kept = format!(", \"{}\": {}", word.0, !word.1);
        for beside in ["", kept.as_str()] {
            let report = fit(&format!("[{}, {}, {}]", run(1, e, beside), run(2, e - 0.1, &withdrawn), run(3, e, beside)));
            prop_assert!(report.groups().is_empty() && (report.cor().unwrap().value - e).abs() < 2e-3, "{}", report);
            prop_assert!(report.left_aside().iter().any(|aside| aside.why == saltus_fit::Why::Void), "{}", report);
        }
    }

    /// Names and numbers of one drop in a line, however they are parted.
    #[test]
    fn one_drop_in_a_line(
        e in 0.5f64..0.9, apart in prop::sample::select(vec![", ", "; ", "  ", " "]), sign in prop::sample::select(vec!["=", " = "]), lines in 1usize..4,
    ) {
        let line = |n: usize| joined(0..5, apart, |k| format!("h{k}{sign}{:.3} m", (1.0 + 0.2 * n as f64) * e.powi(2 * k)));
        let text = joined(0..lines, "\n", line);
        prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
    }

    /// An arrow, or a word, between two heights says nothing of a bounce: a line beside them does.
    #[test]
    fn what_stands_between_heights_says_nothing_of_a_bounce(
        e in 0.5f64..0.9, mark in prop::sample::select(vec!["->", "→", "=>", "vs", "vs."]), chain: bool,
    ) {
        let line = |(h, r): (f64, f64)| {
            let next = if chain { format!(" {mark} {:.2} cm", r * e * e) } else { String::new() };
            format!("{h} cm {mark} {r:.2} cm{next}")
        };
        let text = joined(drops(e), "\n", line);
        let report = fit(&text);
        prop_assert!((report.cor().unwrap().value - e).abs() < 2e-3, "{}{}", text, report);
        prop_assert!(doubted(&report, "something bounces"), "{}{}", text, report);
        let found = trusted(&format!("Ball dropped on wood\n{text}"));
        prop_assert!((found - e).abs() < 2e-3);
    }

    /// The time from release to one contact tells the COR where it says that it lasts until then.
    #[test]
    fn times_from_release_to_a_contact(e in 0.5f64..0.9, contact in 2i32..5, until in prop::sample::select(vec!["to", "until"])) {
        let fall = |h: f64| (2.0 * h / 9.81f64).sqrt();
        let time = |h: f64| fall(h) * (1.0 + 2.0 * (1..contact).map(|k| e.powi(k)).sum::<f64>());
        let nth = ["second", "3rd", "4th"][contact as usize - 2];
        let rows = joined([0.5, 0.8, 1.1, 1.5, 2.0], "\n", |h| format!("{h},{:.5}", time(h)));
        let found = trusted(&format!("Drop height (m),Time {until} {nth} bounce (s)\n{rows}\n"));
        prop_assert!((found - e).abs() < 2e-3);
    }

    /// `dh` beside `h`, the same in every row, is its error; what differs from row to row is asked.
    #[test]
    fn a_constant_beside_heights_is_their_error(e in 0.6f64..0.9, mark in prop::sample::select(vec!["d", "Δ", "δ", "u"])) {
        let rows = |error: &dyn Fn(f64) -> f64| joined(drops(e), "\n", |(h, r)| format!("{h},0.5,{r:.2},{:.2}", error(r)));
        let header = format!("H (cm),{mark}H (cm),h (cm),{mark}h (cm)\n");
        let text = format!("{header}{}\nRubber ball dropped\n", rows(&|_| 0.7));
        prop_assert!((trusted(&text) - e).abs() < 2e-3);
        let sigmas = read(&text).unwrap().trials()[0].readings().iter().map(|r| r.sigma_height).collect::<Vec<_>>();
        prop_assert!(matches!(sigmas.as_slice(), [Some(a), Some(b)] if (a - 0.005).abs() < 1e-9 && (b - 0.007).abs() < 1e-9), "{:?}", sigmas);
        let other = read(&format!("{header}{}\n", rows(&|r| 100.0 - r)));
        let used = other.is_ok_and(|t| t.trials()[0].readings()[1].sigma_height.is_some());
        prop_assert!(!used);
    }

    /// Several units of one kind above cells that name theirs; flights named by their ends, in any
    /// language.
    #[test]
    fn cells_that_name_their_units_and_their_ends(e in 0.6f64..0.9, and in prop::sample::select(vec!["and", "e", "y", "et", "und", "en", "och"])) {
        let cell = |inches: f64| format!("\"{}' {:.2}\"\"\"", (inches / 12.0).floor(), inches % 12.0);
        let rows = joined(drops(e), "\n", |(h, r)| format!("{},{}", cell(h), cell(r)));
        let found = trusted(&format!("\"Dropped from (ft, in)\",\"Came back to (ft, in)\"\n{rows}\n"));
        prop_assert!((found - e).abs() < 2e-3);
        let rows = joined(1..6, "\n", |n| format!("bounce {n} {and} {},{:.4}", n + 1, 0.9 * e.powi(n)));
        let found = trusted(&format!("Interval,Duration (s)\n{rows}\n"));
        prop_assert!((found - e).abs() < 2e-3);
    }

    /// A height above all others of its row is where the ball was dropped: those are bounces, or
    /// repeats where they are level.
    #[test]
    fn a_plain_height_above_the_others_is_the_release(
        e in 0.5f64..0.9, name in prop::sample::select(vec!["H", "Height"]), repeats: bool, trials: bool,
    ) {
        let other = |n: i32| if trials && repeats { format!("Try {n} (cm)") } else if repeats { format!("Bounce {n} (cm)") } else { format!("h{n} (cm)") };
        let rows = joined(drops(e), "\n", |(h, _)| {
            let cell = |n: i32| format!("{:.1}", if repeats { h * e * e * (1.0 + 0.004 * f64::from(n - 2)) } else { h * e.powi(2 * n) });
            format!("{h},{}", joined(1..4, ",", cell))
        });
        let table = format!("Ball dropped on wood\n{name} (cm),{}\n{rows}\n", joined(1..4, ",", other));
        let found = trusted(&table);
        prop_assert!((found - e).abs() < 4e-3, "{} {}", found, table);
        let (readings, trials) = (read(&table).unwrap(), if repeats { 12 } else { 4 });
        prop_assert_eq!(readings.trials().len(), trials, "{}", table);
    }

    /// A letter behind a condition is its unit, and no ball whose rebounds stand below it; of COR
    /// and its square the COR is that which is worked out.
    #[test]
    fn conditions_and_squares_are_no_readings(e in 0.5f64..0.9, letter in prop::sample::select(vec!["C", "F", "K"])) {
        let rows = joined(0..6, "\n", |n| format!("{n},21,36,{:.2},{:.3},{:.3}", 36.0 * e * e * (1.0 + 0.002 * f64::from(n)), e * e, e));
        let report = fit(&format!("Test #,Temp ({letter}),Drop (in),Bounce (in),e^2,e\n{rows}\n"));
        prop_assert!(report.groups().is_empty() && report.verdict() == Verdict::Trusted, "{}", report);
        prop_assert!((report.cor().unwrap().value - e).abs() < 5e-3);
    }

    /// A column of words under the name of a ball or a surface tells groups apart; under another
    /// name, what differs by it is a doubt.
    #[test]
    fn words_under_the_name_of_a_ball_tell_apart(
        e in 0.4f64..0.75, name in prop::sample::select(vec!["Tennis ball", "Golf ball", "Ball", "Wooden floor"]), parts in prop::sample::select(vec![["new", "old"], ["wet", "dry"]]),
    ) {
        let row = |part: &str, e: f64| joined([40.0, 60.0, 80.0, 100.0], "\n", |h| format!("{part},{h},{:.2}", h * e * e));
        let rows = format!("{}\n{}", row(parts[0], e), row(parts[1], e + 0.1));
        let report = fit(&format!("{name},Drop (in),Rebound (in)\n{rows}\n"));
        let found: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert!(matches!(found.as_slice(), [a, b] if (a - e).abs() < 4e-3 && (b - e - 0.1).abs() < 4e-3), "{}", report);
        // Below any other name too, since the COR differs by them.
        let other = fit(&format!("By,Drop (in),Rebound (in)\n{rows}\n"));
        let found: Vec<f64> = other.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert!(matches!(found.as_slice(), [a, b] if (a - e).abs() < 4e-3 && (b - e - 0.1).abs() < 4e-3), "{}", other);
    }

    /// Names and numbers that colons part, several in a line.
    #[test]
    fn names_and_colons_in_a_line(e in 0.4f64..0.9, unit in prop::sample::select(vec!["cm", " cm"])) {
        let text = joined(drops(e), "\n", |(h, r)| format!("Drop: {h}{unit} Bounce: {r:.2}{unit}"));
        let found = trusted(&text);
        prop_assert!((found - e).abs() < 2e-3);
    }

    /// A title or a remark may hold a comma, whatever parts the cells below it.
    #[test]
    fn titles_may_hold_commas(e in 0.5f64..0.9, title in prop::sample::select(vec!["Ball bounce lab, group 4", "Ann, Bob: bounces", "Bounces, in the gym"])) {
        let rows = joined(0..5, "\n", |n| format!("{n:<9} {:.3}", 1.5 * e.powi(2 * n)));
        let found = trusted(&format!("{title}\n\nBounce #   Height [m]\n---------------------\n{rows}\n"));
        prop_assert!((found - e).abs() < 4e-3);
        let lines = joined(0..5, "\n", |n| format!("h{n} = {:.3} m", 1.5 * e.powi(2 * n)));
        let found = trusted(&format!("{lines}\nBouncing ball, all by eye\n"));
        prop_assert!((found - e).abs() < 4e-3);
    }

    /// A place and a height are not told apart by the name of a ball that one of them bears: which
    /// is read is a question.
    #[test]
    fn a_place_beside_heights_is_no_other_ball(
        e in 0.5f64..0.9, rises: bool, place in prop::sample::select(vec!["Distance (m)", "Position (m)"]), ball in prop::sample::select(vec!["Light", "Tennis", "Golf ball"]),
    ) {
        let at = |n: i32| if rises { f64::from(n + 1) } else { 3.0 * 0.8f64.powi(n) };
        let rows = joined(0..4, "\n", |n| format!("{:.3},{:.2}", at(n), 100.0 * e.powi(2 * n)));
        let error = read(&format!("Bouncing ball\n{place},{ball} height (cm)\n{rows}\n")).unwrap_err().to_string();
        prop_assert!(error.contains("hold the same quantity"), "{}", error);
    }

    /// Where rows are bounces only because one follows another, a trial that rises along them
    /// speaks against it, and so against the others.
    #[test]
    fn rows_that_rise_in_one_column_are_no_bounces(e in 0.5f64..0.9, rise in 1.02f64..1.4, first: bool) {
        let rows = |other: f64| joined(0..5, "\n", |n| {
            let cells = [100.0 * e.powi(2 * n), 90.0 * other.powi(n)].map(|h| format!("{h:.2}"));
            if first { cells.join(",") } else { [cells[1].as_str(), &cells[0]].join(",") }
        });
        let names = if first { "Tennis height (cm),Golf height (cm)" } else { "Golf height (cm),Tennis height (cm)" };
        let (sound, risen) = (fit(&format!("Balls dropped\n{names}\n{}\n", rows(0.7))), fit(&format!("Balls dropped\n{names}\n{}\n", rows(rise))));
        prop_assert!(sound.groups().iter().all(|g| g.report.verdict() == Verdict::Trusted), "{}", sound);
        let order = risen.groups().iter().all(|g| g.report.verdict() == Verdict::Doubtful);
        prop_assert!(risen.groups().len() == 2 && order && risen.to_string().contains("rise along them"), "{}", risen);
    }
}

/// What is JSON and no table of numbers is an error that says so; what declares more cells than it
/// has makes no table.
#[test]
fn what_holds_no_records_is_named() {
    let wide: String = (0..3000).map(|n| format!("{{\"a{n}\": 1}},")).collect();
    let long = vec!["1"; 20_000].join(",");
    let thin = (0..900).map(|n| format!("\"b{n}\": [1]")).collect::<Vec<_>>().join(",");
    for text in [
        "{\"name\": \"an app\", \"version\": \"1.2\"}".to_owned(),
        "{\"h\": [[1, 2], {\"a\": null}]}".to_owned(),
        format!("[{}{{\"a\": 1}}]", wide),
        format!("{{\"h\": [{long}], {thin}}}"),
        "[".repeat(5000),
    ] {
        let error = read(&text).unwrap_err().to_string();
        assert!(!error.is_empty() && error.len() < 1000, "{error}");
    }
}

/// Lists of numbers in a list that has a name are repeats, of the ball that the record is of.
#[test]
fn lists_within_a_list_are_repeats() {
    let heights =
        |e: f64, off: f64| (0..4).map(|k| format!("{:.1}", (160.0 + off) * e.powi(2 * k))).collect::<Vec<_>>();
    let lists = |e: f64| [0.0, -1.0, 1.5].map(|off| format!("[{}]", heights(e, off).join(", "))).join(", ");
    let ball = |name: &str, e: f64| format!(r#"{{"name": "{name}", "heights_cm": [{}]}}"#, lists(e));
    let text = format!(r#"{{"who": "8b", "balls": [{}, {}]}}"#, ball("superball", 0.86), ball("hockey ball", 0.57));
    let table = Table::parse("balls.json", text.as_bytes(), &ReadOptions::default()).unwrap();
    let report = Fit::new().run(&table).unwrap();
    let cors: Vec<f64> = report.groups().iter().map(|group| group.report.cor().unwrap().value).collect();
    assert!(cors.len() == 2 && (cors[0] - 0.86).abs() < 0.01 && (cors[1] - 0.57).abs() < 0.01, "{report}");
}

/// The drops of a ball are within it, each a record with its list.
#[test]
fn drops_within_balls_are_those_of_the_balls() {
    let balls = |names: [&str; 2], key: &str| {
        let drop = |(e, n): (f64, usize)| {
            let high =
                |k: i32| format!("{:.0}", 1500.0 * e.powi(2 * k) * (1.0 + 0.004 * ((n + k as usize) as f64).sin()));
            let tops = (1..5).map(high).collect::<Vec<_>>().join(", ");
            format!("{{\"id\": {n}, \"release\": 1500, \"apexes\": [{tops}]}}")
        };
        let ball = |(name, e): (&str, f64)| {
            let drops = (1..4).map(|n| drop((e, n))).collect::<Vec<_>>().join(", ");
            format!("{{\"name\": \"{name}\", \"drops\": [{drops}]}}")
        };
        let all = [ball((names[0], 0.86)), ball((names[1], 0.71))].join(", ");
        format!("{{\"experiment\": \"bounce\", \"unit\": \"mm\", \"{key}\": [{all}]}}")
    };
    for (names, key) in [(["zorb 31 mm", "marble (old)"], "balls"), (["oak", "felt"], "surfaces")] {
        let report = fit(&balls(names, key));
        let found: Vec<(&str, f64)> =
            report.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect();
        let near = |found: &(&str, f64), name: &str, e: f64| found.0 == name && (found.1 - e).abs() < 0.01;
        let whole = matches!(found.as_slice(), [a, b] if near(a, names[0], 0.86) && near(b, names[1], 0.71));
        assert!(whole, "{found:?} {report}");
    }
}

/// What a console prints of a frame has a count before each row, cells where nothing was read, and
/// what it sums up below.
#[test]
fn a_printed_frame_may_lack_readings() {
    let row = |n: usize| {
        let h = 0.6 + 0.3 * (n / 2) as f64;
        let high = |k: i32| h * 0.77_f64.powi(2 * k) * (1.0 + 0.003 * (n as f64).cos());
        let second = if n % 3 == 1 { "  NaN".to_owned() } else { format!("{:.3}", high(2)) };
        format!("{n}    {h:.2}      {:.3}      {second}\n", high(1))
    };
    let rows: String = (0..8).map(row).collect();
    for (asked, below) in [
        ("", ""),
        (">>> df\n", ">>> df.mean()\ndrop_m       1.05\nbounce1_m    0.62\n"),
        (
            "In [3]: df\nOut[3]:\n",
            "In [4]: df.describe()\n        drop_m  bounce1_m  bounce2_m\nmean  1.05   0.62   0.37\nstd   0.33   0.20   0.12\n",
        ),
    ] {
        let text = format!("{asked}   drop_m  bounce1_m  bounce2_m\n{rows}{below}");
        assert!((trusted(&text) - 0.77).abs() < 0.01, "{text}");
    }
}
