//! `saltus accuracy` and `saltus simulate --target` as their user meets them.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn saltus(arguments: &[&str]) -> Output {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    Command::new(env!("CARGO_BIN_EXE_saltus")).args(arguments).current_dir(root).env("NO_COLOR", "1").output().unwrap()
}

fn done(arguments: &[&str]) -> (String, String) {
    let output = saltus(arguments);
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success(), "{err}");
    (out, err)
}

const TOPSPIN: &str = "examples/scenes/topspin.toml";

#[test]
fn it_ends_in_advice() {
    let (text, _) = done(&["accuracy", TOPSPIN]);
    assert!(text.contains("Errors are differences from a run by Dop853 1e-14, which is itself off by about"), "{text}");
    assert!(text.contains("\n24 frames/s "), "{text}");
    assert!(text.contains("\n1 mm and 1 ms everywhere: tolerance 1e-"), "{text}");
    assert!(text.contains("\nIn the scene: `stepper = \""), "{text}");
    assert!(text.contains("\nwithout lift by spin         matters "), "{text}");
}

#[test]
fn a_scene_that_formulas_solve_needs_no_advice() {
    let (text, _) = done(&["accuracy", "examples/scenes/squash.toml"]);
    assert!(text.contains("Errors are differences from the solution by formulas."), "{text}");
    assert!(text.contains("formulas solve this scene, and nothing is to be chosen"), "{text}");
}

#[test]
fn programs_get_the_same_as_json() {
    let (text, _) = done(&["accuracy", TOPSPIN, "--target", "10um, 1us", "--format", "json"]);
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["trials"].as_array().unwrap().len(), 35);
    assert_eq!((json["target"]["length_m"].as_f64(), json["target"]["time_s"].as_f64()), (Some(1e-5), Some(1e-6)));
    let recommended = &json["recommended"];
    let run = json["trials"].as_array().unwrap().iter().find(|trial| trial["run"] == recommended["run"]).unwrap();
    assert!(run["error"]["places_m"].as_f64().unwrap() < 1e-5 && run["error"]["impacts_s"].as_f64().unwrap() < 1e-6);
    assert!(run["flows"].as_u64().unwrap() > 0 && run["seconds"].as_f64().unwrap() > 0.0);
    assert!(recommended["cost_of_a_digit"].as_f64().unwrap() > 1.0);
}

#[test]
fn a_picture_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("accuracy.svg");
    done(&["accuracy", TOPSPIN, "--plot", path.to_str().unwrap()]);
    let svg = std::fs::read_to_string(path).unwrap();
    assert!(svg.contains("Farthest place off (m)") && svg.contains("frame by frame") && svg.contains("10⁻"), "{svg}");
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
    for (target, says) in [("1kg", "is no accuracy"), ("1mm,2mm", "is no accuracy"), ("0mm", "is no accuracy")] {
        let output = saltus(&["accuracy", TOPSPIN, "--target", target]);
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(err.contains(says) && err.contains("1mm,1ms"), "{err}");
    }
    let output = saltus(&["simulate", TOPSPIN, "--target", "1e-15m"]);
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(err.contains("no setting is known to meet 1e-15 m: the reference itself is off by"), "{err}");
}
