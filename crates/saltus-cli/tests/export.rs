//! `export` and `check`: a scene's motion as files for animation programs.

use std::fs;
use std::path::Path;

use crate::tool::{done, refused, root, run, text};
use tempfile::TempDir;

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
            ("usdz", "ball.usdz"),
            ("lottie", "lottie.json"),
            ("dotlottie", "ball.lottie"),
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
    for (name, content) in [
        ("a.glb", "no glb"),
        ("a.json", "{}"),
        ("a.usda", "#usda 1.0"),
        ("a.svg", "<svg/>"),
        ("a.csv", "a,b\n1,2\n"),
        ("a.usdz", "no zip"),
        ("a.lottie", "{}"),
    ] {
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

/// A unit and an axis are read off the file: no option is needed to check it.
#[test]
fn files_in_other_units_read_back() {
    let scene = root().join("examples/scenes/topspin.toml");
    let scene = scene.to_str().unwrap();
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    for (units, up) in [("cm", "z"), ("mm", "y"), ("in", "z"), ("ft", "y"), ("m", "z")] {
        for (format, name) in [("usd", "a.usda"), ("usd-splines", "b.usda"), ("usdz", "c.usdz"), ("csv", "d.csv")] {
            let file = path(name);
            let up: &[&str] = if format == "csv" { &[] } else { &["--up", up] };
            let export = ["-q", "export", scene, "--to", format, "--units", units, "-o", &file, "--force"];
            done(&[&export[..], up].concat());
            let says = done(&["-q", "check", &file, scene]);
            assert!(says.contains("contacts touch; within"), "{format} {units}: {says}");
        }
    }
    // What a format cannot have is refused before there is a file.
    for (format, option, value, says) in [
        ("glb", "--units", "cm", "glb cannot be in cm: glTF is in metres by its specification; leave out the unit"),
        ("gltf", "--up", "z", "in glTF y is up by its specification"),
        ("blender", "--up", "y", "in Blender z is always up"),
        ("maya", "--up", "z", "which a script should leave alone"),
        ("csv", "--up", "z", "go by the names x, y and height"),
        ("json", "--units", "ft", "metres by its contract"),
        ("lottie", "--units", "mm", "a picture has the size of its page"),
        ("html", "--up", "z", "a picture is upright"),
        ("wav", "--units", "in", "a sound has no lengths"),
    ] {
        let file = path(format);
        let refusal = refused(&["-q", "export", scene, "--to", format, option, value, "-o", &file]);
        assert!(refusal.contains(says), "{format}: {refusal}");
        assert!(!Path::new(&file).exists(), "{format}");
    }
    // What a format has anyway may be asked for.
    done(&["-q", "export", scene, "--to", "glb", "--units", "m", "--up", "y", "-o", &path("own.glb")]);
    // A file that is there stays as it is when the next one is refused.
    let before = fs::read(path("own.glb")).unwrap();
    refused(&["-q", "export", scene, "--to", "glb", "--units", "cm", "-o", &path("own.glb"), "--force"]);
    assert_eq!(fs::read(path("own.glb")).unwrap(), before);
}

/// What an animator may do by mistake, or asks for beyond keys.
#[test]
fn what_animators_ask_for() {
    let squash = root().join("examples/scenes/squash.toml");
    let squash = squash.to_str().unwrap();
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let begins = [
        ("ball.html", "<!doctype html>"),
        ("ball.gltf", "{"),
        ("ball.wav", "RIFF"),
        ("ball.usdz", "PK"),
        ("ball.lottie", "PK"),
    ];
    for (name, begins) in begins {
        assert!(run(&["-q", "export", squash, "-o", &path(name)]).status.success());
        assert!(fs::read(path(name)).unwrap().starts_with(begins.as_bytes()), "{name}");
    }
    assert!(done(&["-q", "export", squash, "--to", "contacts"]).starts_with("ball,frame,time_s,"));
    let keys = |more: &[&str]| done(&[&["-q", "export", squash, "--to", "csv"], more].concat()).lines().count();
    assert!(keys(&["--apexes"]) > keys(&[]) + 3);
    // A drawing is exact where it is drawn.
    let output = run(&["export", squash, "--to", "csv", "--on-twos"]);
    let said = text(&output.stderr);
    assert!(said.contains("each drawing stands for two frames"), "{said}");
    assert!(said.contains("worst height error: 8.38 mm; hops of up to 8.38 mm left out"), "{said}");
    // A table is no scene, and a moment no motion.
    let table = root().join("examples/data/squash-on-cement.csv");
    let message = refused(&["export", table.to_str().unwrap(), "-o", &path("ball.glb")]);
    assert!(message.contains("is a table, not a scene: fit it first, by `saltus fit "), "{message}");
    let message = refused(&["export", squash, "--until", "1e-9s", "-o", &path("short.glb")]);
    assert!(
        message.contains("less than a hundredth of a frame") && !Path::new(&path("short.glb")).exists(),
        "{message}"
    );
}

#[test]
fn what_the_request_alone_shows_to_be_too_much_is_refused_before_the_run() {
    let scene = root().join("examples/scenes/topspin.toml");
    let folder = TempDir::new().unwrap();
    let picture = folder.path().join("path.svg");
    // A run says where it stopped, which is sooner, and what else had to be said of it.
    let until = [scene.to_str().unwrap(), "--until", "1e12s"];
    let said = refused(&[&["export", "--to", "glb"], &until[..]].concat());
    assert!(said.starts_with("error: 1000000000000 s are more than 1000000 frames"), "{said}");
    let drawn = ["--fps", "24", "--format", "csv", "--plot", picture.to_str().unwrap()];
    let said = refused(&[&["simulate"], &until[..], &drawn[..]].concat());
    assert!(said.starts_with("error: the samples are more than 10000000"), "{said}");
    assert!(!picture.exists());
}
