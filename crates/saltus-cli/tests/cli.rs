//! The command as its user meets it: what it prints, writes and answers, and how it ends.

use std::fs;

use crate::tool::{done, fed, golden, refused, root, run, saltus, squash, table, text};
use serde_json::Value;
use tempfile::TempDir;

#[test]
fn the_main_job() {
    let folder = TempDir::new().unwrap();
    let svg = folder.path().join("squash.svg");
    let output = saltus().arg("fit").arg(squash()).arg("--plot").arg(&svg).output().unwrap();
    assert!(output.status.success());
    golden(&root().join("crates/saltus-cli/tests/golden/squash.txt"), &text(&output.stdout));
    golden(&root().join("docs/use/squash-on-cement.svg"), &fs::read_to_string(&svg).unwrap());
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
    golden(&root().join("docs/use/squash-profile.svg"), &fs::read_to_string(&profile).unwrap());
    let ladder = fs::read_to_string(&ladder).unwrap();
    assert!(ladder.contains("Apex (cm)") && ladder.contains("one COR of 0.496"), "{ladder}");
    // A picture without content is an error, and no file is made.
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
        ("bounce,hoighte_cm\n0,100\n1,30\n", &["hoighte_cm", "height"]),
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

/// A line names what a file was taken for, unless the command is quiet.
#[test]
fn what_was_recognised_is_said() {
    let (_folder, path) = table("height (cm)\n100\n64\n41\n");
    let output = run(&["fit", &path]);
    let said = text(&output.stderr);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("3 rows, 1 trial; read as heights 'height (cm)' in order"), "{said}");
    assert_eq!(text(&run(&["-q", "fit", &path]).stderr), "");
}

/// Two files are one experiment; a track of pixels is read with a frame rate.
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
    assert!(fed(&["fit", "-"], b"bounce,height_cm\n0,100\n1,64\n2,41\n").contains("COR"));
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
fn what_is_read_is_not_written_over() {
    let folder = TempDir::new().unwrap();
    let put = |name: &str, from: &str| {
        let path = folder.path().join(name);
        fs::copy(root().join(from), &path).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let scene = put("ball.toml", "examples/scenes/squash.toml");
    let table = put("table.csv", "examples/data/squash-on-cement.csv");
    // By another name it is the same file.
    let link = folder.path().join("link.toml");
    std::os::unix::fs::symlink(&scene, &link).unwrap();
    for to in [&scene, link.to_str().unwrap()] {
        for command in [
            &["export", &scene, "--to", "csv", "--force", "-o", to][..],
            &["simulate", &scene, "--format", "csv", "-o", to],
            &["sweep", &scene, "--format", "csv", "--force", "--vary", "restitution=0.3:0.9:3", "-o", to],
        ] {
            let says = refused(command);
            assert!(says.contains("is what is read: name another file to write"), "{command:?}: {says}");
        }
    }
    for command in [&["fit", &table, "-o", &table][..], &["fit", &table, "--force", "--scene", &table]] {
        let says = refused(command);
        assert!(says.contains("is what is read"), "{command:?}: {says}");
    }
    let same = |path: &str, from: &str| fs::read(path).unwrap() == fs::read(root().join(from)).unwrap();
    assert!(same(&scene, "examples/scenes/squash.toml") && same(&table, "examples/data/squash-on-cement.csv"));
}

#[test]
fn a_name_that_says_another_format_is_refused() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let scene = root().join("examples/scenes/squash.toml");
    let scene = scene.to_str().unwrap();
    let vary = "restitution=0.3:0.9:3";
    for (name, command, better) in [
        ("ball.svg", &["export", scene, "--to", "glb"][..], "ball.glb"),
        ("ball.lottie", &["export", scene, "--to", "lottie"], "ball.json"),
        ("ball.PY", &["export", scene, "--to", "usd"], "ball.usda"),
        ("ball.csv", &["simulate", scene, "--format", "json"], "ball.json"),
        ("ball.json", &["simulate", scene, "--format", "text"], "ball.txt"),
        ("runs.csv", &["sweep", scene, "--vary", vary, "--format", "jsonl"], "runs.jsonl"),
    ] {
        let file = path(name);
        let says = refused(&[command, &["-o", &file]].concat());
        assert!(says.contains(&format!("name the file '{}'", path(better))), "{says}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    // Names that several formats share, and those that say nothing, are as they are.
    for (name, format) in [("a.svg", "chart"), ("b.json", "lottie"), ("c.csv", "contacts"), ("d.txt", "csv")] {
        done(&["-q", "export", scene, "--to", format, "-o", &path(name)]);
    }
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
        .stdout(std::process::Stdio::piped())
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
