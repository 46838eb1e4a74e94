//! `saltus accuracy` and `saltus simulate --target` as their user meets them.

use crate::tool;

use std::process::Output;

use serde_json::Value;

fn saltus(arguments: &[&str]) -> Output {
    tool::saltus().args(arguments).current_dir(tool::root()).output().unwrap()
}

fn done(arguments: &[&str]) -> (String, String) {
    let output = saltus(arguments);
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success(), "{err}");
    (out, err)
}

const TOPSPIN: &str = "examples/scenes/topspin.toml";

#[test]
fn the_advice_comes_first() {
    let (text, _) = done(&["accuracy", TOPSPIN]);
    assert!(text.starts_with("What accuracy costs: topspin\n\n1 mm and 1 ms everywhere: tolerance 1e-"), "{text}");
    assert!(text.contains("measured against a run by Dop853 1e-14, itself off by about"), "{text}");
    assert!(text.contains("\n  a further digit  costs × 1."), "{text}");
    assert!(text.contains("\n  in the scene     `stepper = \""), "{text}");
    assert!(text.contains("\n  24 frames/s ") && text.contains("\nwithout lift by spin         matters "), "{text}");
    // The advice is marked in the table, which has what is worth taking, or all.
    let timed = |line: &str| [" ns (", " µs (", " ms ("].iter().any(|unit| line.contains(unit));
    let rows =
        |text: &str| text.lines().filter(|line| timed(line) && line.contains("e-") && line.contains(" 1e-")).count();
    assert_eq!(text.lines().filter(|line| line.starts_with("> ")).count(), 2, "{text}");
    let (all, _) = done(&["accuracy", TOPSPIN, "--all"]);
    assert!(rows(&text) < 15 && rows(&all) >= 30, "{text}{all}");
    let shows: usize = text.split("(--all shows ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert_eq!(all.lines().count() - text.lines().count(), shows + 3, "three gaps between four methods");
}

#[test]
fn a_scene_that_formulas_solve_needs_no_advice() {
    let (text, _) = done(&["accuracy", "examples/scenes/squash.toml"]);
    assert!(text.starts_with("What accuracy costs: A squash ball on cement\n"), "{text}");
    assert!(text.contains("Errors against the solution by formulas. Shown are formulas (--all shows 30 "), "{text}");
    assert!(
        text.contains("formulas solve this scene, and nothing is to be chosen.\n  off by           about "),
        "{text}"
    );
    assert!(text.contains("e-16 m and ") && text.contains(", by rounding\n"), "{text}");
}

#[test]
fn reasons_are_lines_without_places_in_a_scene_that_nobody_wrote() {
    let stacked = "examples/scenes/stacked.toml";
    for arguments in [&["accuracy", stacked][..], &["explain", stacked, "--cost"]] {
        let (text, _) = done(arguments);
        assert!(text.contains("its stiffness is not known: give [contact]\n"), "{text}");
        assert!(!text.contains("stacked.toml:") && !text.contains("^^^") && !text.contains("added_mass:"), "{text}");
    }
}

/// In five seconds three balls in a box hit each other so often that the last bit of gravity moves
/// them by millimetres.
#[test]
fn chaos_is_said() {
    let (text, _) = done(&["accuracy", "examples/scenes/box.toml", "--target", "1um", "--until", "5s"]);
    assert!(
        text.contains("no setting is known to meet 1 µm: rounding puts even the solution by formulas off by about"),
        "{text}"
    );
    // Frames of which no impact is where it should be have no time to compare.
    assert!(text.contains("\n  24 frames/s              -         - "), "{text}");
    let output = saltus(&["simulate", "examples/scenes/box.toml", "--target", "1um", "--until", "5s"]);
    assert_eq!(output.status.code(), Some(2));
    done(&["simulate", "examples/scenes/box.toml", "--target", "1um", "--until", "1s"]);
}

#[test]
fn programs_get_the_same_as_json() {
    let (text, _) = done(&["accuracy", TOPSPIN, "--target", "10um, 1us", "--format", "json"]);
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["trials"].as_array().unwrap().len(), 45);
    assert_eq!((json["target"]["length_m"].as_f64(), json["target"]["time_s"].as_f64()), (Some(1e-5), Some(1e-6)));
    let recommended = &json["recommended"];
    let run = json["trials"].as_array().unwrap().iter().find(|trial| trial["run"] == recommended["run"]).unwrap();
    assert!(run["error"]["places_m"].as_f64().unwrap() < 1e-5 && run["error"]["impacts_s"].as_f64().unwrap() < 1e-6);
    assert!(run["flows"].as_u64().unwrap() > 0 && run["seconds"].as_f64().unwrap() > 0.0);
    assert!(recommended["cost_of_a_digit"].as_f64().unwrap() > 1.0);
}

/// The names of all fields, however deep.
fn names(json: &Value) -> Vec<String> {
    match json {
        Value::Object(fields) => {
            fields.iter().flat_map(|(name, value)| [vec![name.clone()], names(value)].concat()).collect()
        }
        Value::Array(values) => values.iter().flat_map(names).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn every_field_of_json_is_in_the_page_that_help_names() {
    for command in [&["accuracy", TOPSPIN][..], &["explain", TOPSPIN, "--cost"]] {
        let (help, _) = done(&[command[0], "--help"]);
        let page = help.split_whitespace().find(|word| word.starts_with("docs/")).unwrap();
        let page = tool::root().join(page);
        let page = std::fs::read_to_string(page).unwrap();
        let (text, _) = done(&[command, &["--format", "json"]].concat());
        for name in names(&serde_json::from_str(&text).unwrap()) {
            assert!(page.contains(&format!("`{name}`")), "{}: {name}", command[0]);
        }
    }
}

#[test]
fn a_picture_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("accuracy.svg");
    let drawn = |scene: &str, target: &str| {
        let (_, said) = done(&["accuracy", scene, "--target", target, "--plot", path.to_str().unwrap()]);
        assert_eq!(said, format!("picture: {}\n", path.display()));
        std::fs::read_to_string(&path).unwrap()
    };
    let svg = drawn(TOPSPIN, "1mm");
    for words in [
        "What accuracy costs: topspin",
        "Farthest place off (m)",
        "frame by frame",
        "10⁻",
        ">target 1 mm<",
        ">series 1e-3: ",
    ] {
        assert!(svg.contains(words), "{words}: {svg}");
    }
    assert!(!svg.contains("≤ 10⁻¹⁵"), "nothing is that exact here: {svg}");
    let svg = drawn(TOPSPIN, "1us");
    assert!(svg.contains("Worst impact time off (s)") && svg.contains(">target 1 µs<"), "{svg}");
    // The solution by formulas is exact but for rounding, and the axis says what it cannot show.
    let svg = drawn("examples/scenes/squash.toml", "1mm");
    assert!(svg.contains(">≤ 10⁻¹⁵<") && svg.contains(">formulas: "), "{svg}");
}

#[test]
fn the_picture_and_the_report_do_not_share_a_stream() {
    let output = saltus(&["accuracy", TOPSPIN, "--plot", "-"]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(String::from_utf8(output.stderr).unwrap().contains("name a file for the picture instead of '-'"));
}

#[test]
fn simulate_meets_a_target() {
    let (motion, said) = done(&["simulate", TOPSPIN, "--target", "0.1mm"]);
    assert!(said.contains("100 µm everywhere: tolerance 1e-"), "{said}");
    assert!(motion.contains("impact"), "{motion}");
    let (_, said) = done(&["simulate", "--drop", "1m", "--cor", "0.5", "--target", "1um"]);
    assert!(said.contains("1 µm everywhere: formulas solve this scene"), "{said}");
}

#[test]
fn bad_targets_are_refused() {
    for (target, says) in [
        ("1kg", "is no accuracy"),
        ("1mm,2mm", "is no accuracy"),
        ("0mm", "is no accuracy"),
        ("-1mm", "above zero"),
        ("banana", "is no accuracy"),
    ] {
        let output = saltus(&["accuracy", TOPSPIN, "--target", target]);
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(err.contains(says) && err.contains("1mm,1ms"), "{err}");
    }
    let output = saltus(&["simulate", TOPSPIN, "--target", "1e-15m"]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(err.contains("no setting is known to meet 1e-15 m: the reference itself is off by"), "{err}");
    // Formulas round, too.
    let output = saltus(&["simulate", "--drop", "1m", "--cor", "0.5", "--target", "1e-20m"]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("rounding puts even the solution by formulas off by about"), "{err}");
}
