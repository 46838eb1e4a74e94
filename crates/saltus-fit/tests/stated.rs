//! What stands beside the numbers of a table says what they are: units in a line or a member of
//! their own, words of a letter, of a simulation, of a loss.

use crate::typed;

use crate::typed::{fit, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::Verdict;

const NAMES: [&str; 4] = ["bounce height", "height after bounce", "rebound_height", "rebounds"];

fn series(e: f64) -> Vec<String> {
    (0..5).map(|n| format!("{:.2}", 150.0 * e.powi(2 * n))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(48), failure_persistence: None, ..ProptestConfig::default() })]

    /// A unit is that of the numbers, wherever a record states it.
    #[test]
    fn a_unit_stated_in_a_record_is_that_of_its_numbers(
        e in 0.5f64..0.85, name in prop::sample::select(NAMES.to_vec()), unit in prop::sample::select(vec!["cm", "in", "mm"]), shape in 0..7usize,
    ) {
        let heights = series(e);
        let (list, counts) = (heights.join(","), "0,1,2,3,4");
        let rows = |of: &dyn Fn(usize, &str) -> String| {
            heights.iter().enumerate().map(|(n, h)| of(n, h)).collect::<Vec<_>>().join(",")
        };
        let text = match shape {
            0 => format!("{{\"unit\": \"{unit}\", \"bounce\": [{counts}], \"{name}\": [{list}]}}"),
            1 => format!("{{\"bounce\": [{counts}], \"{name}\": [{list}], \"height_unit\": \"{unit}\"}}"),
            2 => format!("{{\"bounce\": [{counts}], \"{name}\": {{\"unit\": \"{unit}\", \"values\": [{list}]}}}}"),
            3 => format!("{{\"units\": {{\"height\": \"{unit}\", \"time\": \"s\"}}, \"data\": {{\"bounce\": [{counts}], \"{name}\": [{list}]}}}}"),
            4 => format!("[{}]", rows(&|n, h| format!("{{\"bounce\": {n}, \"{name}\": {{\"value\": {h}, \"unit\": \"{unit}\"}}}}"))),
            5 => format!("[{}]", rows(&|n, h| format!("{{\"bounce\": {n}, \"{name}\": {h}, \"unit\": \"{unit}\"}}"))),
            _ => format!("{{\"units\": \"{unit}\", \"trials\": [{{\"name\": \"run 1\", \"{name}\": [{list}]}}, {{\"name\": \"run 2\", \"{name}\": [{list}]}}]}}"),
        };
        let cor = fit(&text).cor().expect("a COR").value;
        prop_assert!((cor - e).abs() < 2e-3, "{}", text);
    }

    /// Rows of an object or of a list of lists are rows, by the names that stand beside them.
    #[test]
    fn rows_of_records_may_be_called_by_numbers(e in 0.5f64..0.85, shape in 0..4usize) {
        let rows = |mark: &str, of: &dyn Fn(usize, &str) -> String| {
            series(e).iter().enumerate().map(|(n, h)| of(n, h)).collect::<Vec<_>>().join(mark)
        };
        let text = match shape {
            0 => format!("{{\"bounces\": {{{}}}}}", rows(",", &|n, h| format!("\"{n}\": {{\"height_cm\": {h}}}"))),
            1 => format!("{{\"bounce_height_cm\": {{{}}}}}", rows(",", &|n, h| format!("\"{n}\": {h}"))),
            2 => format!("{{\"columns\": [\"bounce\", \"height_cm\"], \"data\": [{}]}}", rows(",", &|n, h| format!("[{n}, {h}]"))),
            _ => format!("[[\"bounce\", \"height (cm)\"], {}]", rows(",", &|n, h| format!("[{n}, {h}]"))),
        };
        prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
    }

    /// A comment right above numbers that names all of their columns is their header.
    #[test]
    fn a_comment_may_be_the_header(e in 0.5f64..0.85, mark in prop::sample::select(vec![",", ";", " ", "\t"])) {
        let rows: String = series(e).iter().enumerate().map(|(n, h)| format!("{n}{mark}{h}\n")).collect();
        let text = format!("# filmed by Zorb\n# bounce{mark}height_cm\n{rows}");
        prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
    }

    /// A table of something else before, or behind, that of the readings is left aside.
    #[test]
    fn a_table_of_materials_is_left_aside(e in 0.5f64..0.85, first: bool) {
        let rows: String = series(e).iter().enumerate().map(|(n, h)| format!("| {n} | {h} |\n")).collect();
        let (items, data) = ("| Item | Quantity |\n|---|---|\n| Ball | 1 |\n| Stick | 2 |\n", format!("| Bounce | Height (cm) |\n|---|---|\n{rows}"));
        let text = if first { format!("{items}\n{data}") } else { format!("{data}\n{items}") };
        prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
    }

    /// A line that states units and nothing else is no header, and holds for all numbers.
    #[test]
    fn a_line_of_units_is_for_what_bears_none(e in 0.5f64..0.85, line in prop::sample::select(vec!["Unit: cm", "Units: cm, s", "Einheit: cm", "units = cm"])) {
        let rows: String = series(e).iter().enumerate().map(|(n, h)| format!("{n},{h}\n")).collect();
        let text = format!("{line}\nbounce,height\n{rows}");
        prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
    }

    /// A letter tells around its readings; what it measures in passing is not passed over.
    #[test]
    fn readings_stand_within_a_letter(e in 0.5f64..0.85) {
        let lines: String = series(e).iter().enumerate().map(|(n, h)| format!("bounce {n}: {h} cm\n")).collect();
        let told = "Hi all, I filmed a tennis ball in front of a rule.\nThese are the heights that I have read:\n\n";
        let asked = "\nIs that what a ball of grade 9 should do? Thanks, Tom\n";
        let text = format!("{told}{lines}{asked}");
        prop_assert!((trusted(&text) - e).abs() < 4e-3, "{}", text);
        let typed: String = series(e).iter().enumerate().map(|(n, h)| format!("bounce {n} ~{h}cm (hard to see)\n")).collect();
        prop_assert!((trusted(&typed) - e).abs() < 4e-3, "{}", typed);
        let titled = format!("golf ball dropped on the kitchen tiles, heights in cm: {}\n", series(e).join(", "));
        prop_assert!((trusted(&titled) - e).abs() < 4e-3, "{}", titled);
    }

    /// A comment of which every word is understood says what a title says.
    #[test]
    fn simulated_readings_are_no_readings(
        e in 0.5f64..0.85, mark in prop::sample::select(vec!["# ", ""]), said in prop::sample::select(vec!["simulated heights", "expected values", "output of the simulation", "theoretical bounce", "readings: simulated"]),
    ) {
        let rows: String = series(e).iter().enumerate().map(|(n, h)| format!("{n},{h}\n")).collect();
        let report = fit(&format!("{mark}{said}\nbounce,height (cm)\n{rows}"));
        prop_assert!(report.verdict() == Verdict::Doubtful && report.reason().contains("were the readings below it measured"), "{}", report);
        let stated = "# filmed by Zorb, who calls the expected scatter small\n# gravity: 9.8 m/s^2\n# frame rate: 30\n";
        let report = fit(&format!("{stated}bounce,height (cm)\n{rows}"));
        prop_assert!(report.verdict() == Verdict::Trusted, "{}", report);
    }

    /// A drop without a unit has that of what was lost beside it.
    #[test]
    fn a_loss_tells_the_unit_of_its_drop(e in 0.5f64..0.85, unit in prop::sample::select(vec!["cm", "m"])) {
        let scale = if unit == "cm" { 100.0 } else { 1.0 };
        let row = |h: f64| format!("{:.4},{:.4}\n", scale * h, scale * h * (1.0 - e * e));
        let rows: String = [1.0, 1.5, 2.0].map(row).concat();
        let text = format!("Drop,Lost height ({unit})\n{rows}");
        prop_assert!((trusted(&text) - e).abs() < 2e-3, "{}", text);
    }

    /// A mean, or an extreme, that differs from the only readings beside it in every row is another
    /// way to read them, and one that repeats is theirs.
    #[test]
    fn a_mean_of_nothing_is_a_question(e in 0.5f64..0.7, word in prop::sample::select(vec!["mean", "max"]), higher in 1.05f64..1.4) {
        let row = |n: i32| format!("{n},{:.2},{:.2}\n", 100.0 * e.powi(2 * n), 100.0 * (higher * e).powi(2 * n));
        let rows: String = (0..5).map(row).collect();
        let text = format!("bounce,height (cm),{word} height (cm)\n{rows}");
        let error = typed::read(&text).expect_err("a question");
        prop_assert!(error.is_question() && error.to_string().contains("which one is meant"), "{}", error);
        let repeats: String = [1.0, 1.01, 0.99, 1.0].map(|f| format!("100,{:.2},{:.2}\n", 100.0 * e * e * f, 100.0 * e * e)).concat();
        let text = format!("drop (cm),rebound (cm),mean rebound (cm)\n{repeats}");
        prop_assert!((trusted(&text) - e).abs() < 4e-3, "{}", text);
    }
}

#[test]
fn moments_stand_below_what_happens() {
    let times: String = [0.0, 0.8, 1.44, 1.952, 2.3616].map(|t| format!("{:.3} s\n", 1.5 + t)).concat();
    let cor = fit(&format!("Ball hits the floor at:\n{times}")).cor().expect("a COR").value;
    assert!((cor - 0.8).abs() < 3e-3, "{cor}");
}

#[test]
fn time_in_air_is_no_inch() {
    let rows: String = (0..5).map(|n| format!("{},{:.3}\n", n + 1, 0.8 * 0.8f64.powi(n))).collect();
    assert!((trusted(&format!("Bounce,Time in air (s)\n{rows}")) - 0.8).abs() < 3e-3);
    let heights: String = (0..5).map(|n| format!("{n},{:.2}\n", 50.0 * 0.64f64.powi(n))).collect();
    assert!((trusted(&format!("Bounce,Height in\n{heights}")) - 0.8).abs() < 3e-3);
}

/// A height of release in feet and inches, or in metres and centimetres, is that of both parts.
#[test]
fn a_height_of_release_may_have_two_parts() {
    for (said, metres) in [
        ("Ball dropped from 5 ft 7 in", 67.0 * 0.0254),
        ("The ball was dropped from a height of 5 feet 7 inches.", 67.0 * 0.0254),
        ("dropped from 5 feet and 7 inches", 67.0 * 0.0254),
        ("Drop height: 5'7\"", 67.0 * 0.0254),
        ("Ball dropped from 5' 7\" onto oak", 67.0 * 0.0254),
        ("ball dropped from 67 1/2 in", 67.5 * 0.0254),
        ("dropped from 1 m 45 cm", 1.45),
        ("dropped from 1.45 m", 1.45),
    ] {
        let row = |n: usize| format!("{},{:.2}\n", n + 1, 100.0 * metres * 0.5476 * (1.0 + 0.004 * (n as f64).sin()));
        let text =
            format!("\"{}\"\n\nno,rebound (cm)\n{}", said.replace('"', "\"\""), (0..6).map(row).collect::<String>());
        assert!((trusted(&text) - 0.74).abs() < 0.005, "{text}");
    }
}

/// What a record refers its heights to is no reference that was looked up.
#[test]
fn what_heights_refer_to_is_no_prediction() {
    for said in ["\"reference\": \"bottom of ball, floor = 0\"", "\"Referenz\": \"Boden\""] {
        let text = format!("{{{said}, \"bounce\": [0, 1, 2, 3, 4], \"height_cm\": [{}]}}", series(0.8).join(", "));
        assert!((trusted(&text) - 0.8).abs() < 2e-3, "{text}");
    }
    let text = format!(
        "{{\"reference\": \"values of the book\", \"bounce\": [0, 1, 2, 3, 4], \"height_cm\": [{}]}}",
        series(0.8).join(", ")
    );
    assert_ne!(fit(&text).verdict(), Verdict::Trusted);
}
