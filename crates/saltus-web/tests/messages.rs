//! Messages: every question has an answer; sliders write what they read.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use saltus_fit::{Fit, ReadOptions, Table};
use saltus_web::answered;
use serde_json::{Value, json};

/// The answer to a question, and the bytes behind it.
fn ask(question: &Value, bytes: &[u8]) -> (Value, Vec<u8>) {
    let json = question.to_string();
    let length = u32::try_from(json.len()).unwrap().to_le_bytes();
    let answer = answered(&[&length, json.as_bytes(), bytes].concat());
    let (length, rest) = answer.split_first_chunk::<4>().unwrap();
    let (json, bytes) = rest.split_at(u32::from_le_bytes(*length) as usize);
    (serde_json::from_slice(json).unwrap(), bytes.to_vec())
}

fn run(toml: &str, more: Value) -> (Value, Vec<u8>) {
    let mut question = json!({ "ask": "run", "toml": toml, "knobs": true });
    question.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    ask(&question, &[])
}

/// The example scenes by name.
fn scenes() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    scenes.map(|path| (path.display().to_string(), fs::read_to_string(&path).unwrap())).collect()
}

#[test]
fn a_fit_is_that_of_the_library() {
    let table = b"bounce,height_cm\n0,100\n1,64\n2,41\n3,26.2\n";
    let question = json!({ "ask": "fit", "files": [["a.csv", table.len()]], "options": { "sigma_height": "5 mm" } });
    let (answer, _) = ask(&question, table);
    let read = Table::parse("a.csv", table, &ReadOptions::default()).unwrap();
    let fit = Fit::new().sigma_height(0.005);
    let report = fit.advised(&read, fit.run(&read).unwrap(), None).unwrap();
    assert_eq!(answer["report"], serde_json::to_string_pretty(&report).unwrap() + "\n");
    assert_eq!(answer["text"], report.to_string());

    let (answer, _) = ask(&json!({ "ask": "fit", "files": [["a.csv", 9]], "options": { "gravity": "9" } }), table);
    assert_eq!((&answer["error"]["kind"], &answer["error"]["option"]), (&json!("option"), &json!("gravity")));
    for part in ["4s", "4s..1s", "-1s..", "x.."] {
        let (answer, _) = ask(&json!({ "ask": "fit", "files": [["a.csv", 9]], "options": { "listen": part } }), table);
        assert_eq!(answer["error"]["option"], "listen", "{part}");
    }
    let (answer, _) = ask(&json!({ "ask": "fit", "files": [["a.csv", 999]], "options": {} }), table);
    assert_eq!(answer["error"]["kind"], "question");
    let cell = b"bounce,height_cm\n0,100\n1,thirty\n";
    let (answer, _) = ask(&json!({ "ask": "fit", "files": [["a.csv", cell.len()]], "options": {} }), cell);
    assert_eq!((&answer["error"]["line"], &answer["error"]["column"]), (&json!(3), &json!(3)));
}

#[test]
fn every_example_runs_and_samples_its_motion() {
    for (name, toml) in scenes() {
        let (answer, places) = run(&toml, json!({ "pictures": ["height", "energy"] }));
        assert_eq!(answer["error"], Value::Null, "{name}");
        let (samples, balls) = (answer["samples"].as_u64().unwrap(), answer["balls"].as_array().unwrap().len());
        assert_eq!(places.len() as u64, 16 * samples * balls as u64, "{name}");
        assert_eq!(answer["pictures"].as_array().unwrap().len(), 2, "{name}");
    }
}

/// A slider's value is read back from the scene that it was written into, and what else the scene
/// says stays, comments too.
#[test]
fn sliders_write_what_they_read() {
    for (name, toml) in scenes() {
        let (answer, _) = run(&toml, json!({}));
        let known = answer["knobs"]["values"].as_object().unwrap().clone();
        assert!(!known.is_empty(), "{name}");
        for (knob, value) in &known {
            let value = value.as_f64().unwrap();
            for part in [1.0, 0.9] {
                let (set, _) = run(&toml, json!({ "set": [knob, part * value] }));
                let read = set["knobs"]["values"][knob].as_f64();
                assert!(read.is_some_and(|read| (read - part * value).abs() < 1e-5), "{name}: {knob} {set}");
                for (other, before) in known.iter().filter(|(other, _)| *other != knob) {
                    let after = set["knobs"]["values"][other].as_f64().unwrap_or(f64::NAN);
                    assert!((after - before.as_f64().unwrap()).abs() < 1e-9, "{name}: {knob} moves {other}");
                }
                let comments = |text: &str| text.lines().filter_map(|line| line.split_once('#')).count();
                assert_eq!(comments(set["toml"].as_str().unwrap()), comments(&toml), "{name}: {knob}");
            }
        }
    }
}

#[test]
fn mistakes_have_their_place() {
    let (answer, _) = run("restitution = 1.2\nball = { height = '1 m' }\n", json!({}));
    let error = &answer["error"];
    assert_eq!((&error["kind"], &error["line"], &error["column"]), (&json!("scene"), &json!(1), &json!(15)));
    let (answer, _) = ask(&json!({ "ask": "export", "toml": "", "format": "psd", "fps": "24" }), &[]);
    assert_eq!(answer["error"]["message"], "'psd' is no format of motion");
}

proptest! {
    /// Whatever is asked is answered, by something that can be read.
    #[test]
    fn every_message_is_answered(length in 0..40_u32, rest in prop::collection::vec(any::<u8>(), 0..60), toml in ".{0,80}", value in any::<f64>()) {
        let answer = answered(&[&length.to_le_bytes(), &rest[..]].concat());
        prop_assert!(serde_json::from_slice::<Value>(&answer[4..]).is_ok_and(|answer| answer["error"]["kind"] == "question"));
        for knob in ["drop", "cor", "gravity", "drag", "spin", "slope"] {
            let (answer, _) = run(&toml, json!({ "set": [knob, value] }));
            prop_assert!(answer.is_object());
            let drop = "restitution = 0.5\nball = { height = '1 m', radius = '2 cm', mass = '1 g' }\nrun = { until = '1 s' }\n";
            let (answer, _) = run(drop, json!({ "set": [knob, value] }));
            prop_assert!(answer["until"].is_f64() || answer["error"]["kind"].is_string());
        }
    }
}
