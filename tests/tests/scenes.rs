//! Scene files: the examples, the page about them, the schema, and whatever else a reader may be
//! given.
//!
//! `SCENES=1000000 cargo test --release -p saltus-tests scenes::` is the long run of the
//! fuzzing.

use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use saltus_scene::{Contact, Scene, Shape, schema};
use saltus_tests::any_scene::answered;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The example scenes, by name.
fn examples() -> Vec<(String, String)> {
    let mut files: Vec<_> = fs::read_dir(root().join("examples/scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| (path.file_stem().unwrap().to_string_lossy().into_owned(), fs::read_to_string(&path).unwrap()))
        .collect();
    files.sort();
    files
}

fn example(name: &str) -> Scene {
    Scene::read(root().join(format!("examples/scenes/{name}.toml"))).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_example_is_a_scene() {
    let examples = examples();
    assert!(examples.len() >= 12);
    for (name, text) in &examples {
        let scene = Scene::parse(name, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
        assert!(
            text.starts_with("#:schema scene.schema.json\n# "),
            "{name} has no schema line, or says not what it is"
        );
        assert!((1..=3).contains(&scene.dimensions));
    }
}

#[test]
fn what_examples_say_is_what_is_read() {
    let tennis = example("tennis");
    let [low, high] = tennis.law(0, 0).unwrap().range(7.0).map(|cor| cor.value());
    assert!((low - 0.729).abs() < 1e-3 && (high - 0.761).abs() < 1e-3);
    let topspin = example("topspin");
    assert_eq!(topspin.dimensions, 2);
    assert!((topspin.balls[0].planar_spin().unwrap() + 80.0 * std::f64::consts::PI).abs() < 1e-12);
    assert!(
        topspin.effects.magnus(&topspin.balls[0]).is_some() && topspin.effects.linear_drag(&topspin.balls[0]).is_none()
    );
    let wind = example("wind");
    assert_eq!((wind.dimensions, wind.effects.wind.unwrap().y), (3, 5.0));
    assert!(example("newtons-cradle").floors.is_empty());
    assert!(matches!(example("slow-contact").contact, Contact::KelvinVoigt(_)));
    assert!(matches!(example("stairs").floors[0].shape, Shape::Stairs { count: Some(12), .. }));
    let table = example("vibrating-table");
    let motion = table.floors[0].motion.as_ref().unwrap();
    assert!((motion.offset(0.01) - 1e-3).abs() < 1e-15);
}

/// From impact to impact the billiard balls keep v + (2/5) R ω along the cloth, so what rolls has
/// 5/7 of it; ω counts as topspin.
#[test]
fn a_draw_shot_by_the_textbook() {
    let scene = example("billiards");
    let (ball, e, friction) = (&scene.balls[0], 0.95, scene.floors[0].friction.coefficient());
    let (radius, speed, push) = (ball.radius.unwrap(), ball.velocity.x, friction * scene.gravity.value());
    // The cue ball slides as far as the object ball: d = v t - μ g t²/2.
    let way = scene.balls[1].centre().x - 2.0 * radius;
    let t = (speed - (speed * speed - 2.0 * push * way).sqrt()) / push;
    let (met, topspin) = (speed - push * t, -ball.planar_spin().unwrap() * radius + 2.5 * push * t);
    assert!(topspin < 0.0, "there is backspin left to draw it back");
    let after = [(0.5 * (1.0 - e) * met, topspin), (0.5 * (1.0 + e) * met, 0.0)];
    let record = scene.plan().unwrap().run().unwrap();
    let impacts = record.impacts();
    let hit = impacts.iter().find(|impact| impact.t > 0.0).unwrap();
    assert!((hit.t - t).abs() < 1e-9, "{} is not {t}", hit.t);
    for (n, (v, topspin)) in after.into_iter().enumerate() {
        let rolls = (v + 0.4 * topspin) * 5.0 / 7.0;
        let end = record.at(n, record.until()).unwrap();
        assert_eq!(record.mode(n, record.until()), Some("hold"));
        assert!((end.velocity.x - rolls).abs() < 1e-8, "ball {n}: {} m/s, not {rolls}", end.velocity.x);
        assert!((end.spin.y * radius - rolls).abs() < 1e-8, "ball {n} does not roll");
        assert!(end.height().abs() < 1e-9 && end.velocity.y == 0.0);
    }
    let last = |n: usize| record.at(n, record.until()).unwrap().velocity.x;
    assert!(last(0) < 0.0 && last(1) > 0.0, "the cue ball comes back");
}

/// Each block of TOML in the page is a scene, and no key is left out.
#[test]
fn the_page_about_scenes() {
    let page = fs::read_to_string(root().join("docs/use/scenes.md")).unwrap();
    let blocks: Vec<&str> = page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(blocks.len() >= 10);
    for block in blocks {
        Scene::parse("docs/use/scenes.md", block.as_bytes()).unwrap_or_else(|error| panic!("{error}\nin:\n{block}"));
    }
    let words: Vec<&str> = page.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
    let mut missing: Vec<String> =
        keys().into_iter().map(|(_, key)| key).filter(|key| !words.contains(&&**key)).collect();
    missing.dedup();
    assert!(missing.is_empty(), "docs/use/scenes.md says nothing of {missing:?}");
}

/// Every table of the schema with each of its keys.
fn keys() -> Vec<(String, String)> {
    let schema: serde_json::Value = serde_json::from_str(schema()).unwrap();
    let list = |name: &str, table: &serde_json::Value| -> Vec<(String, String)> {
        let keys = table["properties"].as_object().into_iter().flatten();
        keys.map(|(key, _)| (name.to_owned(), key.clone())).collect()
    };
    let mut keys = list("", &schema);
    keys.extend(schema["definitions"].as_object().unwrap().iter().flat_map(|(name, table)| list(name, table)));
    keys
}

/// The schema beside the examples is the one that is printed, every key in it says what it is, and
/// the reader knows every one.
#[test]
fn the_schema_is_that_of_the_reader() {
    let path = root().join("examples/scenes/scene.schema.json");
    if std::env::var_os("SALTUS_BLESS").is_some() {
        fs::write(&path, schema()).unwrap();
    }
    let kept = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    assert!(kept == schema(), "{} is not what `saltus schema` prints; SALTUS_BLESS=1 rewrites it", path.display());
    let value: serde_json::Value = serde_json::from_str(&kept).unwrap();
    assert!(
        kept.matches("\"additionalProperties\": false").count() >= 14,
        "unknown keys are refused by the schema too"
    );
    for (table, key) in keys() {
        let at = if table.is_empty() { &value } else { &value["definitions"][&table] };
        assert!(at["properties"][&key]["description"].is_string(), "{table}.{key} is not described");
        // Whatever is wrong with this line, it is not that the key is unknown.
        let toml = match table.as_str() {
            "" => format!("{key} = []\n"),
            "elastic" => format!("[contact]\nlaw = 'hertz'\nball.{key} = []\n"),
            "motion" => format!("[floor]\nmotion.{key} = []\n"),
            name => format!("[{}]\n{key} = []\n", name.replace('-', "_")),
        };
        let message = Scene::parse("keys", toml.as_bytes()).unwrap_err().to_string();
        assert!(!message.contains("is no key here"), "{toml}{message}");
    }
}

/// A reader that is given anything answers, and what it reads ends.
fn answers(bytes: &[u8]) -> Result<(), TestCaseError> {
    answered(bytes).map_err(TestCaseError::fail)
}

fn runner(share: u32) -> TestRunner {
    let asked = std::env::var("SCENES").ok().and_then(|text| text.parse().ok());
    TestRunner::new(Config { cases: asked.unwrap_or(2000) / share, failure_persistence: None, ..Config::default() })
}

/// What a hand or a program may put into a file.
const SNIPPETS: [&str; 28] = [
    "nan",
    "-inf",
    "1e999",
    "-1",
    "0",
    "\"1 m\"",
    "\"-3 kg\"",
    "\"NaN s\"",
    "\"1e400 m\"",
    "[",
    "]",
    "[[ball]]\n",
    "[ball]\n",
    "{ }",
    "=",
    "\"",
    "\n",
    "'''",
    "\u{0}",
    "\u{feff}",
    "é",
    "𝔘",
    "1979-05-27",
    "true",
    "[[[[",
    "height = 1\n",
    "9223372036854775807",
    "\r",
];

fn edit(text: &str, edits: &[(usize, usize, usize)]) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    for &(at, what, length) in edits {
        let at = at % (chars.len() + 1);
        let end = (at + length).min(chars.len());
        match what % 3 {
            0 => drop(chars.drain(at..end)),
            1 => drop(chars.splice(at..end, SNIPPETS[what / 3 % SNIPPETS.len()].chars())),
            _ => {
                let copy: Vec<char> = chars[at..end].to_vec();
                let to = what / 3 % (chars.len() + 1);
                drop(chars.splice(to..to, copy));
            }
        }
    }
    chars.into_iter().collect()
}

#[test]
fn mutated_scenes_are_read_or_refused() {
    let examples = examples();
    let edits = prop::collection::vec((any::<usize>(), any::<usize>(), 0..20_usize), 1..6);
    runner(1)
        .run(&(0..examples.len(), edits), |(which, edits)| answers(edit(&examples[which].1, &edits).as_bytes()))
        .unwrap_or_else(|error| panic!("{error}"));
}

/// Values are exchanged between keys: what was a mass becomes an angle.
#[test]
fn exchanged_values_are_read_or_refused() {
    let examples = examples();
    let lines: Vec<(String, String)> = examples
        .iter()
        .flat_map(|(_, text)| text.lines().filter_map(|line| line.split_once(" = ")))
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .collect();
    runner(2)
        .run(&(0..examples.len(), any::<usize>(), any::<usize>()), |(which, line, value)| {
            let mut text: Vec<String> = examples[which].1.lines().map(str::to_owned).collect();
            let line = line % text.len();
            if let Some((key, _)) = text[line].clone().split_once(" = ") {
                let snippet = SNIPPETS[value % SNIPPETS.len()];
                let other = lines.get(value % (lines.len() + 8)).map_or(snippet, |(_, value)| value);
                text[line] = format!("{key} = {other}");
            }
            answers(text.join("\n").as_bytes())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn noise_is_refused() {
    runner(2)
        .run(&prop::collection::vec(any::<u8>(), 0..300), |bytes| answers(&bytes))
        .unwrap_or_else(|error| panic!("{error}"));
    runner(2).run(&".{0,200}", |text| answers(text.as_bytes())).unwrap_or_else(|error| panic!("{error}"));
}
