//! `simulate`, `explain` and `schema`: scenes run, drawn, explained and refused.

use std::fs;

use crate::tool::{done, fed, golden, refused, root, run, run_quietly, scene, text};
use serde_json::Value;
use tempfile::TempDir;

#[test]
fn simulating_for_programs() {
    let json = done(&[
        "simulate",
        "--drop",
        "1m",
        "--cor",
        "0.5",
        "--gravity",
        "9.8m/s^2",
        "--until",
        "4s",
        "--format",
        "json",
    ]);
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["schema"], 1);
    let jumps = json["jumps"].as_array().unwrap();
    assert_eq!(jumps.len(), 53);
    for (index, jump) in jumps.iter().enumerate() {
        assert_eq!(jump["j"], index + 1);
        assert!(jump["before"]["height"].as_f64().unwrap() >= 0.0);
    }
    assert_eq!((&jumps[0]["edge"], &jumps[52]["edge"]), (&Value::from("floor"), &Value::from("zeno")));
    assert!((jumps[52]["t"].as_f64().unwrap() - 1.355_261_854_357_876_8).abs() < 1e-15);
    assert_eq!((&json["stop"]["reason"], &json["stop"]["mode"]), (&Value::from("time"), &Value::from("rest")));
}

#[test]
fn simulating_for_spreadsheets() {
    let csv = done(&["simulate", "--drop", "1m", "--cor", "0.5", "--fps", "24", "--format", "csv"]);
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("time_s,jumps,mode,height_m,velocity_m_per_s"));
    let rows: Vec<(f64, usize)> = lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            assert!(cells[3].parse::<f64>().unwrap() >= 0.0, "{line}");
            (cells[0].parse().unwrap(), cells[1].parse().unwrap())
        })
        .collect();
    assert!(rows.windows(2).all(|pair| pair[0] <= pair[1]), "rows are in the order of hybrid time");
    assert!((0..30).all(|k| rows.iter().any(|row| row.0 == f64::from(k) / 24.0)), "every frame is there");
}

/// A scene that says what the options say gives the same bytes in every format.
#[test]
fn a_scene_is_the_same_motion_as_its_options() {
    let (folder, path) =
        scene("gravity = '9.81 m/s^2'\nrestitution = 0.5\nball = { height = '1 m', velocity = '-2 m/s' }\n");
    let options = ["simulate", "--drop", "1m", "--cor", "0.5", "--velocity", "-2m/s"];
    for more in [&[][..], &["--format", "csv", "--fps", "24"], &["--format", "json", "--until", "3s"]] {
        assert_eq!(done(&[&["simulate", &path], more].concat()), done(&[&options[..], more].concat()));
    }
    let pictures = ["scene.svg", "options.svg"].map(|name| folder.path().join(name));
    done(&["simulate", &path, "--plot", pictures[0].to_str().unwrap()]);
    done(&[&options[..], &["--plot", pictures[1].to_str().unwrap()]].concat());
    assert_eq!(fs::read(&pictures[0]).unwrap(), fs::read(&pictures[1]).unwrap());
}

#[test]
fn a_range_of_restitution_is_said_to_be_one() {
    let tennis = root().join("examples/scenes/tennis.toml");
    let output = run(&["simulate", tennis.to_str().unwrap()]);
    assert!(output.status.success());
    assert!(text(&output.stderr).contains("e = 0.729 to 0.761"), "{}", text(&output.stderr));
    assert_eq!(text(&run(&["-q", "simulate", tennis.to_str().unwrap()]).stderr), "");
}

#[test]
fn a_scene_that_ends_by_itself_or_when_told() {
    let (_folder, path) = scene("restitution = 1\nball = { height = 1 }\nrun = { until = '2 s' }\n");
    let end = |more: &[&str]| {
        let json = done(&[&["simulate", &path, "--format", "json"], more].concat());
        serde_json::from_str::<Value>(&json).unwrap()["stop"]["t"].as_f64().unwrap()
    };
    assert_eq!((end(&[]), end(&["--until", "1s"])), (2.0, 1.0));
}

#[test]
fn scenes_that_cannot_be_run() {
    let (_folder, path) = scene("restitution = 0.8\n\n[ball]\nheigth = '1 m'\n");
    let message = refused(&["simulate", &path]);
    let shown = format!(
        "error: {path}:4:1: `heigth` is no key here\n    4 | heigth = '1 m'\n      | ^^^^^^\n  help: did you mean `height`?\n"
    );
    assert_eq!(message, shown);
    assert!(refused(&["simulate", "no/such/scene.toml"]).contains("cannot read 'no/such/scene.toml'"));
    assert!(refused(&["simulate", root().to_str().unwrap()]).contains("cannot read"));
    assert!(refused(&["simulate"]).contains("give a scene file, or both --drop and --cor"));
    assert!(refused(&["simulate", &path, "--drop", "1m"]).contains("cannot be used with"));
    let (_folder, path) = scene(
        "restitution = 0.8\nball = { radius = 1, mass = 1, height = 1 }\nfriction = 0.1\ncontact = { law = 'rigid' }\n[[floor]]\nkind = 'stairs'\ntread = 1\nrise = 1\n[[floor]]\nkind = 'stairs'\ntread = 1\nrise = 1\n[run]\nuntil = 1\n",
    );
    let message = refused(&["simulate", &path]);
    assert!(message.contains(&format!("{path}:9:1: there are stairs already\n    9 | [[floor]]\n")), "{message}");
}

/// Each example scene is drawn; where its picture stands beside it, that is the one.
#[test]
fn example_scenes_are_drawn() {
    let folder = TempDir::new().unwrap();
    let mut count = 0;
    for entry in fs::read_dir(root().join("examples/scenes")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let svg = folder.path().join("picture.svg");
        done(&["-q", "simulate", path.to_str().unwrap(), "-o", svg.to_str().unwrap()]);
        let picture = fs::read_to_string(&svg).unwrap();
        assert!(picture.len() < 100_000, "{}: {} bytes", path.display(), picture.len());
        let kept = path.with_extension("svg");
        if kept.exists() || std::env::var_os("SALTUS_BLESS").is_some() {
            golden(&kept, &picture);
        }
        count += 1;
    }
    assert!(count >= 15);
}

/// Each kind of picture, of a scene that has it; refused in words where there is nothing to draw.
#[test]
fn a_picture_to_standard_output_is_alone_there() {
    let (_folder, scene) = scene("restitution = 0.5\nball = { height = 1 }\n");
    let picture = done(&["simulate", &scene, "--plot", "-"]);
    assert!(picture.starts_with("<svg") && picture.trim_end().ends_with("</svg>"), "{picture}");
    let folder = TempDir::new().unwrap();
    let csv = folder.path().join("motion.csv");
    assert_eq!(done(&["simulate", &scene, "--plot", "-", "-o", csv.to_str().unwrap()]), picture);
    assert!(fs::read_to_string(&csv).unwrap().starts_with("time_s,"));
    for motion in [&["--format", "csv"][..], &["-o", "-"]] {
        assert!(refused(&[&["simulate", &scene, "--plot", "-"], motion].concat()).contains("name a file for one"));
    }
}

/// A ball on a table that shakes too little to throw it moves with it; the run has no rest, and
/// nothing slides.
#[test]
fn a_ball_on_a_shaken_table_rests_on_it() {
    let (_folder, path) = scene(
        "restitution = 0.2\nball = { height = '1 cm' }\nfloor = { motion = { amplitude = '1 mm', frequency = '5 Hz' } }\nrun = { until = '2 s' }\n",
    );
    assert!(done(&["simulate", &path]).contains("The run ends at 2.000000000 s, resting at "));
    let json: Value = serde_json::from_str(&done(&["simulate", &path, "--format", "json"])).unwrap();
    assert_eq!((&json["stop"]["mode"], &json["stop"]["rest"]), (&Value::from("rest"), &Value::Null));
    assert!(done(&["explain", &path]).contains("\nmode         rest: "));
}

/// Balls that spin are written with their spin, each by its name.
#[test]
fn a_draw_shot_is_written_with_its_spins() {
    let scene = root().join("examples/scenes/billiards.toml");
    let scene = scene.to_str().unwrap();
    assert!(done(&["simulate", scene]).contains("object ball on cue ball"));
    let csv = done(&["simulate", scene, "--format", "csv"]);
    let (header, rows) = csv.split_once('\n').unwrap();
    assert!(header.ends_with(",spin_rad_per_s"), "{header}");
    let spin: f64 = rows.lines().next().unwrap().rsplit(',').next().unwrap().parse().unwrap();
    assert!((spin - 30.0 * std::f64::consts::PI).abs() < 1e-12);
}

#[test]
fn kinds_of_pictures() {
    let squash = root().join("examples/scenes/squash.toml");
    for kind in ["height", "velocity", "energy", "phase", "ladder", "ghost"] {
        let folder = TempDir::new().unwrap();
        let svg = folder.path().join("picture.svg");
        done(&["simulate", squash.to_str().unwrap(), "--kind", kind, "-o", svg.to_str().unwrap()]);
        assert!(fs::read_to_string(&svg).unwrap().starts_with("<svg"));
    }
    for (kind, part) in [("path", "only moves up and down"), ("hysteresis", "needs a contact that takes time")] {
        assert!(refused(&["simulate", squash.to_str().unwrap(), "--kind", kind, "-o", "never.svg"]).contains(part));
    }
}

#[test]
fn a_scene_is_explained() {
    let squash = root().join("examples/scenes/squash.toml");
    let text = done(&["explain", squash.to_str().unwrap()]);
    for part in ["coordinates  2: height above the floor, velocity up", "flight: exact arc", "effects out  linear drag"]
    {
        assert!(text.contains(part), "no '{part}' in:\n{text}");
    }
    let topspin = root().join("examples/scenes/topspin.toml");
    let json: Value = serde_json::from_str(&done(&["explain", topspin.to_str().unwrap(), "--format", "json"])).unwrap();
    assert_eq!((&json["schema"], &json["model"]), (&Value::from(1), &Value::from("flyer")));
    assert_eq!(json["coordinates"].as_array().unwrap().len(), 5);
    assert_eq!(json["modes"][0]["advance"], "explicit stepper Dop853");
    // What spin does, with numbers: k = ρ π R³/(2m), and lift k ω v/(1 + 2 R ω/v) of a spin across
    // the velocity.
    let (radius, mass, v): (f64, f64, f64) = (0.033, 0.058, 30.0_f64.hypot(2.0));
    let spin = 80.0 * std::f64::consts::PI;
    let k = 1.225 * std::f64::consts::PI * radius.powi(3) / (2.0 * mass);
    let start = k * spin * v / (1.0 + 2.0 * radius * spin / v);
    let effects = json["effects"].to_string();
    let lift = format!("lift by spin, a = {k:.8} × ω × v / (1 + 0.066 m × |ω × v|/v²), {start:.5} m/s² at the start");
    assert!(effects.contains(&lift), "no '{lift}' in {effects}");
    assert!(effects.contains("spin decay, ω' = -ω/(20 s)"), "{effects}");
    // A ball twice as heavy as its air drags a quarter of its mass along.
    let (_folder, light) = scene(
        "restitution = 0.5\nadded_mass = true\nair = { density = 2 }\nball = { radius = 1, mass = 16.755160819145562, height = 1 }\n",
    );
    assert!(done(&["explain", &light]).contains("added mass, which leaves 0.8 of every acceleration\n"));
}

/// What each effect changes and costs: exact where nothing changes, refused in words where there is
/// nothing to toggle.
#[test]
fn what_effects_cost() {
    let tennis = root().join("examples/scenes/table-tennis.toml");
    let arguments = ["explain", tennis.to_str().unwrap(), "--cost", "--until", "4s"];
    let json: Value = serde_json::from_str(&done(&[&arguments[..], &["--format", "json"]].concat())).unwrap();
    let rows = json["cost"].as_array().unwrap();
    let row = |run: &str| rows.iter().find(|row| row["run"] == run).unwrap();
    let first = |run: &str, what: &str| row(run)[what][0].as_f64().unwrap();
    assert_eq!(rows.len(), 11);
    assert_eq!(row("as it is")["impacts"].as_array().unwrap().len(), 5);
    // From 2 m in a vacuum, and later where the air holds back or carries.
    let fall = (2.0 * 2.0 / 9.80665_f64).sqrt();
    assert!(first("without quadratic drag", "impacts") > fall && first("as it is", "impacts") > 1.03 * fall);
    assert!(first("without buoyancy", "impacts") < first("as it is", "impacts"));
    assert!(first("with added mass", "apexes") != first("as it is", "apexes"));
    assert_eq!((row("as it is")["flows"].as_u64(), row("as it is")["steps"].as_u64()), (Some(0), Some(0)));
    assert!(row("with linear drag")["flows"].as_u64().unwrap() > 0, "no formula has both kinds of drag");
    for row in rows.iter().filter(|row| row.get("refused").is_none()) {
        let seconds = |key: &str| row[key].as_f64().unwrap();
        assert!(0.0 < seconds("seconds_low") && seconds("seconds_low") <= seconds("seconds"));
        assert!(seconds("seconds") <= seconds("seconds_high"));
    }
    for (run, part) in [
        ("without gravity", "nothing comes down"),
        ("with wind", "its speed is not known"),
        ("with lift by spin", "does not spin"),
        ("with friction", "only moves up and down"),
    ] {
        assert!(row(run)["refused"].as_str().unwrap().contains(part), "{run}");
    }
    let table = done(&arguments);
    for part in ["model        ball", "as it is", "without buoyancy", "µs (", "not run: without it nothing comes down"]
    {
        assert!(table.contains(part), "no '{part}' in:\n{table}");
    }
    assert!(
        serde_json::from_str::<Value>(&done(&["explain", tennis.to_str().unwrap(), "--format", "json"]))
            .unwrap()
            .get("cost")
            .is_none()
    );
}

/// A scene without an end is refused, unless the command line gives one, wherever its table for
/// that stands.
#[test]
fn the_command_line_ends_a_scene() {
    let endless = "restitution = 1\nball = { height = 1 }\n";
    for run in ["", "run = { tolerance = 1e-6 }\n", "run.tolerance = 1e-6\n", "[run]\ntolerance = 1e-6\n"] {
        let (_folder, path) = scene(&format!("{endless}{run}"));
        assert!(refused(&["simulate", &path]).contains("nothing ends this run"));
        let json: Value =
            serde_json::from_str(&done(&["simulate", &path, "--until", "3s", "--format", "json"])).unwrap();
        assert_eq!(json["stop"]["t"], 3.0);
        assert!(run_quietly(&["simulate", &path, "--most-jumps", "4"]));
        assert!(done(&["explain", &path, "--until", "3s"]).contains("model        ball"));
    }
    // The option ends a run; it mends nothing else, and the error of the file stays.
    let (_folder, path) = scene("restitution = 1\nball = { height = 1 }\nrun = { until = -1 }\n");
    assert_eq!(refused(&["simulate", &path, "--until", "3s"]), refused(&["simulate", &path]));
}

/// An error in a scene bears its place, and nothing panics.
#[test]
fn bad_scenes() {
    let noise = "\u{1}x".repeat(5_000_000);
    for (toml, parts) in [
        ("restitution = 0.8\nball = { height = '1 m', mass = '-1 kg' }\n", &[":2:", "mass"][..]),
        ("restitution = 1.2\nball = { height = '1 m' }\n", &[":1:15", "1.2 is not a coefficient"]),
        ("restitution = 0.8\nball = { height = '-1 cm' }\n", &[":2:", "below the floor"]),
        ("restitution = 0.8\nball = { height = '1 s' }\n", &[":2:19", "length"]),
        ("restitution = nan\nball = { height = 1 }\n", &[":1:15", "finite"]),
        ("", &["empty"]),
        (&noise, &["larger than 1 MiB"]),
    ] {
        let (_folder, path) = scene(toml);
        let message = refused(&["simulate", &path]);
        for part in parts {
            assert!(message.contains(part), "no '{part}' in:\n{message}");
        }
        assert_eq!(refused(&["explain", &path]), message);
    }
}

#[test]
fn a_scene_from_standard_input() {
    assert!(fed(&["simulate", "-"], b"restitution = 0.5\nball = { height = '1 m' }\n").contains("At rest"));
}

#[test]
fn the_schema_of_scenes() {
    let schema = fs::read_to_string(root().join("examples/scenes/scene.schema.json")).unwrap();
    assert_eq!(done(&["schema"]), schema.replace("\r\n", "\n"));
}

#[test]
fn simulating_what_cannot_be() {
    for (arguments, part) in [
        (&["--drop", "1", "--cor", "0.5"][..], "give a unit of length"),
        (&["--drop", "1m", "--cor", "1.2"], "'1.2' is not a number from 0 to 1"),
        (&["--drop", "1s", "--cor", "0.5"], "'s' in '1s' is not a unit of length"),
        (&["--drop", "-1m", "--cor", "0.5"], "below the floor"),
        (&["--drop", "1m", "--cor", "0.5", "--gravity", "-9.81m/s^2"], "not a gravity"),
        (&["--drop", "1m", "--cor", "0.5", "--gravity", "0m/s^2"], "--until"),
        (&["--drop", "1m", "--cor", "0.5", "--until", "0s"], "not above zero"),
        (&["--drop", "1m", "--cor", "0.5", "-o", "motion.xls"], "'.xls'"),
        (&["--drop", "1m", "--cor", "0.5", "--plot", "bounce.png"], "bounce.svg"),
    ] {
        let message = refused(&[&["simulate"], arguments].concat());
        assert!(message.contains(part), "{arguments:?}: no '{part}' in:\n{message}");
    }
}

#[test]
fn an_elastic_ball_never_rests_and_says_when_it_stopped() {
    let output = run(&["simulate", "--drop", "1m", "--cor", "1", "--most-jumps", "50"]);
    assert!(output.status.success());
    let said = text(&output.stderr);
    assert!(said.contains("stopped after 50 jumps"), "{said}");
    // Advice for a command that has the option, and for one that has not.
    assert!(said.contains("`most_jumps` under [run], or --most-jumps where a command has it, allows more"), "{said}");
}

/// Numbers beyond any that can be right are refused at once, with the range.
#[test]
fn numbers_have_ranges() {
    let message = refused(&["simulate", "--drop", "1m", "--cor", "0.5", "--velocity", "1e160m/s"]);
    assert!(
        message.contains("'1e160m/s' is beyond the numbers that can be right: a speed is at most 299792458 m/s"),
        "{message}"
    );
    let (_folder, path) = scene("restitution = 1\nball = { height = 1 }\nrun = { until = '1e300 s' }\n");
    assert!(refused(&["simulate", &path]).contains("a time is at most 1e12 s"));
}
