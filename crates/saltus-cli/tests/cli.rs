//! The command as its user meets it: what it prints, writes and answers, and how it ends.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

fn saltus() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_saltus"));
    command.env("NO_COLOR", "1");
    command
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn squash() -> PathBuf {
    root().join("examples/data/squash-on-cement.csv")
}

fn run(arguments: &[&str]) -> Output {
    saltus().args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A command that must succeed and say nothing on standard error; its standard output.
fn done(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    text(&output.stdout)
}

/// A command that must fail with status 2 and nothing on standard output; its message.
fn refused(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert_eq!(text(&output.stdout), "");
    text(&output.stderr)
}

/// A table in a folder of its own.
fn table(content: impl AsRef<[u8]>) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("table.csv");
    fs::write(&path, content).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

/// Compares with a file in the project; `SALTUS_BLESS=1` rewrites it instead.
fn golden(path: &Path, got: &str) {
    if std::env::var_os("SALTUS_BLESS").is_some() {
        fs::write(path, got).unwrap();
    }
    let expected = fs::read_to_string(path).unwrap_or_default().replace("\r\n", "\n");
    assert!(expected == got, "{} differs from:\n{got}\nLook at it; SALTUS_BLESS=1 accepts it.", path.display());
}

#[test]
fn the_main_job() {
    let folder = TempDir::new().unwrap();
    let svg = folder.path().join("squash.svg");
    let output = saltus().arg("fit").arg(squash()).arg("--plot").arg(&svg).output().unwrap();
    assert!(output.status.success());
    golden(&root().join("crates/saltus-cli/tests/golden/squash.txt"), &text(&output.stdout));
    golden(&root().join("docs/squash-on-cement.svg"), &fs::read_to_string(&svg).unwrap());
    assert!(text(&output.stderr).contains("squash.svg"), "where the picture went is said");
    // The report quoted in the README is the report printed.
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let quoted = readme.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    assert!(text(&output.stdout).starts_with(quoted.trim_end()), "the README quotes another report");
}

#[test]
fn pictures_of_a_fit() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (profile, ladder, squash) = (path("profile.svg"), path("ladder.svg"), squash());
    let squash = squash.to_str().unwrap();
    done(&["-q", "fit", squash, "--plot-profile", &profile, "--plot-ladder", &ladder]);
    golden(&root().join("docs/squash-profile.svg"), &fs::read_to_string(&profile).unwrap());
    let ladder = fs::read_to_string(&ladder).unwrap();
    assert!(ladder.contains("Apex (cm)") && ladder.contains("one COR of 0.496"), "{ladder}");
    // What there is nothing to draw of is said, and no file is made.
    let (_folder, one) = table("bounce,height_cm\n0,100\n");
    let none = [
        ("--plot", "the table has no motion to draw"),
        ("--plot-cor", "the table does not give it at several speeds"),
        ("--plot-ladder", "the table gives no two heights of apexes"),
        ("--plot-profile", "no COR was fitted to heights or times of bounces"),
    ];
    for (option, says) in none {
        let output = run(&["fit", &one, option, &path("none.svg")]);
        assert!(output.status.success() && text(&output.stderr).contains(says), "{option}: {}", text(&output.stderr));
        assert!(!folder.path().join("none.svg").exists());
    }
}

#[test]
fn a_report_for_programs() {
    let json: Value = serde_json::from_str(&done(&["fit", squash().to_str().unwrap(), "--format", "json"])).unwrap();
    assert_eq!(json["schema"], 1);
    assert_eq!(json["verdict"], "doubtful");
    for field in ["value", "standard_error", "low", "high"] {
        assert!(json["cor"].get(field).is_some(), "cor.{field}");
    }
    for estimate in json["estimates"].as_array().unwrap() {
        for field in ["method", "value", "standard_error", "chi_square", "degrees_of_freedom", "p"] {
            assert!(estimate.get(field).is_some(), "estimates[].{field}");
        }
    }
    assert!(json["warnings"].is_array() && json["repairs"].is_array());
    let agreement = &json["agreement"];
    assert!((agreement["chi_square"].as_f64().unwrap() - 73.2).abs() < 0.1);
    assert_eq!(agreement["degrees_of_freedom"], 4);
}

#[test]
fn strictness() {
    let squash = squash();
    let squash = squash.to_str().unwrap();
    assert_eq!(run(&["fit", squash, "--strict"]).status.code(), Some(1));
    let (_folder, good) = table("bounce,height_cm\n0,100\n1,64\n2,41\n3,26.2\n");
    assert_eq!(run(&["fit", &good, "--strict"]).status.code(), Some(0));
    let (_folder, none) = table("bounce,time_s\n1,0.45\n2,0.85\n");
    assert_eq!(run(&["fit", &none]).status.code(), Some(0));
    assert_eq!(run(&["fit", &none, "--strict"]).status.code(), Some(1));
    let json: Value = serde_json::from_str(&done(&["fit", &none, "--format", "json"])).unwrap();
    assert_eq!((&json["verdict"], &json["cor"]), (&Value::from("refused"), &Value::Null));
}

#[test]
fn tables_as_people_write_them() {
    let plain = "bounce,height_cm\n0,100\n1,64\n2,41\n3,26.2\n";
    let cor = |content: &[u8], more: &[&str]| {
        let (_folder, path) = table(content);
        let json = done(&[&["fit", &path, "--format", "json"], more].concat());
        serde_json::from_str::<Value>(&json).unwrap()["cor"]["value"].as_f64().unwrap()
    };
    let expected = cor(plain.as_bytes(), &[]);
    assert!((expected - 0.8).abs() < 0.002);
    for (content, more) in [
        ("\u{feff}bounce,height_cm\n0,100\n1,64\n2,41\n3,26.2\n", &[][..]),
        ("bounce,height_cm\r\n0,100\r\n1,64\r\n2,41\r\n3,26.2\r\n", &[]),
        ("bounce;height (cm)\n0;100\n1;64\n2;41\n3;26,2\n", &[]),
        ("bounce\theight [m]\n0\t1\n1\t0,64\n2\t0,41\n3\t0,262\n", &["--sigma-height", "1cm"]),
        ("bounce,height\n0,1000\n1,640\n2,410\n3,262\n", &["--height-unit", "mm", "--sigma-height", "1cm"]),
        ("# by hand\n\nheight_cm\n100\n64\n41\n26.2\n", &[]),
    ] {
        let got = cor(content.as_bytes(), more);
        assert!((got - expected).abs() < 1e-9, "{content:?}: {got}");
    }
}

/// Each refusal names the place and says what to do.
#[test]
fn tables_that_cannot_be_read() {
    for (content, parts) in [
        ("", &["empty"][..]),
        ("bounce,height_cm\n", &["no row"]),
        ("bounce,height_cm\n0,100\n1,NaN\n", &[":3:3:", "1,NaN", "^^^"]),
        ("bounce,height_cm\n0,100\n1,-3\n", &[":3:3:", "1,-3", "below the floor"]),
        ("bounce,height_furlong\n0,100\n1,30\n", &["furlong"]),
        ("bounce,heihgt_cm\n0,100\n1,30\n", &["heihgt_cm", "height"]),
        ("bounce,height\n0,100\n1,30\n", &["--height-unit"]),
    ] {
        let (_folder, path) = table(content);
        let message = refused(&["fit", &path]);
        assert!(message.starts_with("error: "), "{message}");
        for part in parts {
            assert!(message.to_lowercase().contains(&part.to_lowercase()), "{content:?}: no '{part}' in:\n{message}");
        }
    }
    assert!(refused(&["fit", "no/such/table.csv"]).contains("no/such/table.csv"));
    assert!(refused(&["fit", root().to_str().unwrap()]).contains("directory"));
}

/// Rising heights are never silently a COR of one.
#[test]
fn heights_that_rise() {
    let (_folder, path) = table("bounce,height_cm\n0,50\n1,60\n2,75\n");
    let json: Value = serde_json::from_str(&done(&["fit", &path, "--format", "json"])).unwrap();
    assert_ne!(json["verdict"], "trusted");
    assert!(!json["warnings"].as_array().unwrap().is_empty());
}

/// What a file was taken for is said in one line, and nothing is said to a quiet command.
#[test]
fn what_was_recognised_is_said() {
    let (_folder, path) = table("height (cm)\n100\n64\n41\n");
    let output = run(&["fit", &path]);
    let said = text(&output.stderr);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("3 rows, 1 trial; read as heights 'height (cm)' in order"), "{said}");
    assert_eq!(text(&run(&["-q", "fit", &path]).stderr), "");
}

/// Two files are one experiment; a track of pixels is read once its frame rate is known.
#[test]
fn several_files_and_bare_pixels() {
    let (_a, first) = table("bounce,height_cm\n0,100\n1,64\n2,41\n");
    let (_b, second) = table("bounce;height_mm\n0;1000\n1;650\n2;420\n");
    let json: Value = serde_json::from_str(&done(&["fit", &first, &second, "--format", "json"])).unwrap();
    assert_eq!(json["trials"], 2);
    let (_c, pixels) = table("7;100;\n7;103;\n7;109;\n7;118;\n");
    let message = refused(&["fit", &pixels]);
    assert!(message.contains(":1:1: the table has no header") && message.contains("--fps 100"), "{message}");
    let scaled = ["fit", &pixels, "--fps", "50", "--scale", "1.371m/911px", "--y-down", "--format", "json"];
    assert_eq!(serde_json::from_str::<Value>(&done(&scaled)).unwrap()["trials"], 1);
    for (arguments, part) in [
        (&["--scale", "2"][..], "give a unit of length"),
        (&["--scale", "1m/0"], "is not a scale"),
        (&["--zero", "low"], "is not a number"),
        (&["--y-up", "--y-down"], "cannot be used with"),
        (&["--sheet", "All"], "this file has no sheets"),
    ] {
        let message = refused(&[&["fit", pixels.as_str()], arguments].concat());
        assert!(message.contains(part), "{arguments:?}: no '{part}' in:\n{message}");
    }
}

#[test]
fn a_table_from_standard_input() {
    let mut child = saltus().args(["fit", "-"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(b"bounce,height_cm\n0,100\n1,64\n2,41\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && text(&output.stdout).contains("COR"));
}

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

/// A scene in a folder of its own.
fn scene(toml: &str) -> (TempDir, String) {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("drop.toml");
    fs::write(&path, toml).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
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

/// A ball on a table that shakes too little to throw it moves with it; the run has no rest, and nothing slides.
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
    // What spin does, with numbers: k = ρ π R³/(2m), and lift k ω v/(1 + 2 R ω/v) of a spin across the velocity.
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

/// What each effect changes and costs: exact where nothing changes, refused in words where there is nothing to toggle.
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

/// A scene without an end is refused, unless the command line gives one, wherever its table for that stands.
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
    // It ends a run; it mends nothing else, and says of the file what it said before.
    let (_folder, path) = scene("restitution = 1\nball = { height = 1 }\nrun = { until = -1 }\n");
    assert_eq!(refused(&["simulate", &path, "--until", "3s"]), refused(&["simulate", &path]));
}

fn run_quietly(arguments: &[&str]) -> bool {
    run(&[&["-q"], arguments].concat()).status.success()
}

/// What is wrong in a scene is said with its place, and nothing panics.
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
    let mut child = saltus().args(["simulate", "-"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(b"restitution = 0.5\nball = { height = '1 m' }\n").unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && text(&output.stdout).contains("At rest"));
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
        (&["--drop", "1m", "--cor", "1.2"], "1.2 is not a coefficient of restitution"),
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
    assert!(text(&output.stderr).contains("stopped after 50 jumps"), "{}", text(&output.stderr));
}

/// A file that is there stays whole when it cannot be written, and is replaced whole when it can.
#[test]
fn files_are_whole() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("bounce.csv");
    fs::write(&path, "precious").unwrap();
    let before = || fs::read_dir(folder.path()).unwrap().count();
    refused(&["simulate", "--drop", "1m", "--cor", "2", "-o", path.to_str().unwrap()]);
    assert_eq!(fs::read_to_string(&path).unwrap(), "precious");
    done(&["simulate", "--drop", "1m", "--cor", "0.5", "-o", path.to_str().unwrap()]);
    assert!(fs::read_to_string(&path).unwrap().starts_with("time_s,"));
    assert_eq!(before(), 1, "no temporary file is left");
    let nowhere = folder.path().join("no/such/folder/bounce.csv");
    assert!(
        refused(&["simulate", "--drop", "1m", "--cor", "0.5", "-o", nowhere.to_str().unwrap()])
            .contains("there is no folder")
    );
    assert!(
        refused(&[
            "simulate",
            "--drop",
            "1m",
            "--cor",
            "0.5",
            "--format",
            "csv",
            "-o",
            folder.path().to_str().unwrap()
        ])
        .contains("is a folder")
    );
}

#[cfg(unix)]
#[test]
fn devices_are_written_to_and_not_replaced() {
    done(&["simulate", "--drop", "1m", "--cor", "0.5", "--format", "csv", "-o", "/dev/null"]);
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[cfg(unix)]
#[test]
fn nobody_reading_on_is_no_failure() {
    let mut child = saltus()
        .args(["simulate", "--drop", "1m", "--cor", "0.99", "--fps", "1000", "--format", "csv"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
}

#[test]
fn completions_and_the_manual() {
    assert!(done(&["completions", "bash"]).contains("_saltus"));
    assert!(done(&["completions", "zsh"]).contains("#compdef saltus"));
    let manual = done(&["man"]);
    for part in [".TH saltus 1", "saltus\\-fit", "\\-\\-sigma\\-height"] {
        assert!(manual.contains(part), "{part}");
    }
}

#[test]
fn a_scene_is_exported_for_animators_and_says_how_exactly() {
    let scene = root().join("examples/scenes/squash.toml");
    let scene = scene.to_str().unwrap();
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("ball.glb");
    let output = run(&["export", scene, "--fps", "24", "--snap", "gravity", "-o", file.to_str().unwrap()]);
    assert!(output.status.success());
    let said = text(&output.stderr);
    assert!(said.contains("farthest contact from a frame: 0.00 frames; worst height error: 2.13 mm"), "{said}");
    assert_eq!(fs::read(&file).unwrap()[..4], *b"glTF");
    let keys = done(&["--quiet", "export", scene, "--to", "csv", "--first-frame", "1"]);
    assert!(keys.lines().nth(1).unwrap().starts_with("squash ball,1,0,0,0,1,"), "{keys}");
    assert!(refused(&["export", scene, "--fps", "0", "--to", "csv"]).contains("'0' is not a frame rate"));
    assert!(refused(&["export", scene, "-o", "ball.xyz"]).contains("no format goes by the extension '.xyz'"));
    assert!(refused(&["-q", "export", scene, "-o", "no-such-folder/ball.glb"]).contains("there is no folder"));
}

#[test]
fn what_exists_is_written_over_only_when_that_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    let (path, scene) = (file.to_str().unwrap(), root().join("examples/scenes/squash.toml"));
    let scene = scene.to_str().unwrap();
    for command in
        [&["export", scene, "--to", "csv", "-o", path][..], &["solve", "touch 1 at 1s", "--free", "height", "-o", path]]
    {
        fs::write(&file, "mine").unwrap();
        let says = format!("'{path}' exists: name another file, or say --force to write it anew");
        assert!(refused(command).contains(&says));
        assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
        done(&[&["-q"], command, &["--force"]].concat());
        assert_ne!(fs::read_to_string(&file).unwrap(), "mine");
        // There is nothing to lose in an empty file, nor with standard output.
        fs::write(&file, "").unwrap();
        done(&[&["-q"], command].concat());
    }
    done(&["-q", "export", scene, "--to", "csv", "-o", "-"]);
}

#[test]
fn what_is_exported_reads_back_as_promised() {
    let scenes = root().join("examples/scenes");
    let folder = TempDir::new().unwrap();
    for (scene, options) in [
        ("squash.toml", &["--snap", "gravity", "--squash", "0.3", "--stretch", "0.1"][..]),
        ("slow-contact.toml", &["--squash", "law", "--fps", "25"]),
        ("topspin.toml", &["--stretch", "0.2"]),
        ("box.toml", &["--on-twos"]),
    ] {
        let scene = scenes.join(scene);
        let scene = scene.to_str().unwrap();
        for (format, name) in [
            ("glb", "ball.glb"),
            ("usd", "ball.usda"),
            ("usd-splines", "splines.usda"),
            ("lottie", "lottie.json"),
            ("json", "ball.json"),
            ("svg", "ball.svg"),
            ("csv", "ball.csv"),
        ] {
            // A table of frames says where the ball is on them, and nothing of between.
            if options.contains(&"--on-twos") && format == "csv" {
                continue;
            }
            let file = folder.path().join(name);
            let file = file.to_str().unwrap();
            done(
                &[&["-q", "export", scene, "--to", format, "-o", file, "--force", "--first-frame", "1"], options]
                    .concat(),
            );
            let said = done(&[&["-q", "check", file, scene], options].concat());
            assert!(
                said.contains("contacts touch; within") && !said.contains("not within"),
                "{scene} {format}: {said}"
            );
            // Single precision cannot be this near.
            let other = run(&[&["-q", "check", file, scene, "--tolerance", "0.000001mm"], options].concat());
            if format == "glb" {
                assert_eq!(other.status.code(), Some(1), "{}", text(&other.stdout));
            }
        }
    }
}

#[test]
fn a_file_that_is_wrong_is_found_out() {
    let scene = root().join("examples/scenes/squash.toml");
    let scene = scene.to_str().unwrap();
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let file = path("ball.csv");
    done(&["-q", "export", scene, "-o", &file]);
    // The motion of another gravity, a contact lowered by 3 mm, a file cut short.
    let found = run(&["-q", "check", &file, scene, "--snap", "gravity"]);
    assert_eq!(found.status.code(), Some(1), "{}", text(&found.stdout));
    let keys = fs::read_to_string(&file).unwrap();
    let lines: Vec<&str> = keys.lines().collect();
    let cells: Vec<&str> = lines[2].split(',').collect();
    let lowered = [&cells[..5], &["-0.003"], &cells[6..]].concat().join(",");
    fs::write(&file, [&lines[..2], &[&lowered], &lines[3..]].concat().join("\n")).unwrap();
    let found = run(&["-q", "check", &file, scene]);
    assert_eq!(found.status.code(), Some(1));
    assert!(text(&found.stdout).contains("a contact is 3.00 mm too low"), "{}", text(&found.stdout));
    fs::write(&file, lines[..4].join("\n")).unwrap();
    let found = run(&["-q", "check", &file, scene]);
    assert!(text(&found.stdout).contains("; it ends at") && found.status.code() == Some(1));
    for (name, says) in
        [("ball.py", "a script can only be run"), ("ball.fbx", "can be read back"), ("none.glb", "cannot read")]
    {
        assert!(refused(&["check", &path(name), scene]).contains(says));
    }
    for (name, content) in
        [("a.glb", "no glb"), ("a.json", "{}"), ("a.usda", "#usda 1.0"), ("a.svg", "<svg/>"), ("a.csv", "a,b\n1,2\n")]
    {
        fs::write(path(name), content).unwrap();
        assert!(refused(&["check", &path(name), scene]).contains("cannot be read back"), "{name}");
    }
}

#[test]
fn squash_and_stretch_are_never_silent() {
    let scenes = root().join("examples/scenes");
    let said = |scene: &str, options: &[&str]| {
        let scene = scenes.join(scene);
        let output = run(&[&["export", scene.to_str().unwrap(), "--to", "csv"], options].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stderr)
    };
    let by_hand = said("squash.toml", &["--squash", "0.3", "--stretch", "0.1", "--exaggerate", "1.5", "--hold", "3"]);
    for part in [
        "squashed to 0.55 of its height by hand",
        "stretched to 1.15 of its length by hand",
        "contacts held for 3 frames, the end ",
        "outline moved by up to ",
        "volume kept within 0.0",
    ] {
        assert!(by_hand.contains(part), "{part}: {by_hand}");
    }
    // The greatest deformation of the first contact, 46.9 mm of a ball of 10 cm.
    let law = said("slow-contact.toml", &["--squash", "law"]);
    assert!(law.contains("squashed to 0.53 of its height as the contact's law has it"), "{law}");
    let half = said("slow-contact.toml", &["--squash", "law", "--exaggerate", "0.5"]);
    assert!(half.contains("0.500 times as far as the contact's law has it"), "{half}");
    assert!(said("topspin.toml", &[]).contains("keys added to its turning"));
    let refuse = |scene: &str, options: &[&str]| {
        let scene = scenes.join(scene);
        refused(&[&["export", scene.to_str().unwrap(), "--to", "csv"], options].concat())
    };
    assert!(refuse("squash.toml", &["--squash", "law"]).contains("no law says how far"));
    assert!(refuse("box.toml", &["--squash", "0.3"]).contains("several balls cannot wait"));
    assert!(refuse("squash.toml", &["--squash", "2"]).contains("not a number from 0 to 0.9, nor `law`"));
    assert!(refuse("squash.toml", &["--squash", "0.5", "--exaggerate", "4"]).contains("squash it by 0 to 0.9"));
}
