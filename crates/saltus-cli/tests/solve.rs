//! `saltus solve` as its user meets it: every answer is run again, and compared with a formula that
//! the command does not use.

use crate::tool;

use std::fs;

use saltus_scene::Scene;
use saltus_scene::plan::Record;
use tempfile::TempDir;

const G: f64 = 9.806_65;

/// Status, standard output and standard error.
fn solve(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = tool::saltus().arg("solve").args(arguments).output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, err)
}

/// The scene and the messages of a command that has to succeed.
fn solved(arguments: &[&str]) -> (Scene, String) {
    let (status, out, err) = solve(arguments);
    assert_eq!(status, Some(0), "{arguments:?}: {err}");
    (Scene::parse("solved.toml", out.as_bytes()).unwrap(), err)
}

fn run(scene: &Scene) -> Record {
    scene.plan().unwrap().run().unwrap()
}

/// Must fail with nothing on standard output; the message.
fn refused(arguments: &[&str]) -> String {
    let (status, out, err) = solve(arguments);
    assert_eq!((status, out.as_str()), (Some(2), ""), "{arguments:?}: {err}");
    err
}

fn near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9 * expected.abs().max(1.0), "{value} is not {expected}");
}

fn cor(scene: &Scene) -> f64 {
    run(scene).impacts()[0].cor().unwrap()
}

#[test]
fn what_a_formula_answers() {
    let (height, _) = solved(&["touch 1 at frame 24", "--free", "height"]);
    near(height.balls[0].lowest().z, 0.5 * G);
    let (gravity, said) = solved(&["touch 1 at frame 30", "--fps", "30", "--free", "gravity"]);
    near(gravity.gravity.value(), 2.0);
    assert!(said.contains("gravity is 0.204 times the Earth's"), "{said}");
    let (throw, _) = solved(&["touch 1 at 1s", "--free", "throw"]);
    near(throw.balls[0].velocity.z, 0.5 * G - 1.0);
    // The apex after one bounce of a drop is the second: the first is where it starts.
    near(cor(&solved(&["apex 2 at 50cm", "--free", "cor"]).0), 0.5_f64.sqrt());
    near(cor(&solved(&["apex 4 at 12.5cm", "--free", "cor"]).0), 0.125_f64.powf(1.0 / 6.0));
    let fall = (2.0 / G).sqrt();
    near(cor(&solved(&["hop 1 for 12 frames", "--free", "cor"]).0), 0.5 / (2.0 * fall));
    let x = (3.0 - fall) * G / (2.0 * (2.0 * G).sqrt());
    near(cor(&solved(&["rest at 3s", "--free", "cor"]).0), x / (1.0 + x));
    let (forward, _) = solved(&["touch 3 at 2m", "--free", "forward"]);
    near(forward.balls[0].velocity.x, 2.0 / (fall * (1.0 + 2.0 * 0.7 + 2.0 * 0.49)));
    near(run(&forward).at(0, run(&forward).impacts()[2].t).unwrap().position.x, 2.0);
}

#[test]
fn two_wishes_by_two_freedoms() {
    let (scene, said) = solved(&["touch 1 at frame 24", "apex 2 at 60cm", "--free", "throw,cor"]);
    near(scene.balls[0].velocity.z, 0.5 * G - 1.0);
    near(cor(&scene), (0.6 / (1.0 + (0.5 * G - 1.0).powi(2) / (2.0 * G))).sqrt());
    assert!(said.contains("not said, and so taken: height 1 m, gravity the Earth's"), "{said}");
    // Frames are counted from the first.
    let (one, _) = solved(&["touch 1 at frame 25", "--first-frame", "1", "--free", "height"]);
    near(one.balls[0].lowest().z, 0.5 * G);
    let (many, said) = solved(&["touch 2 at frame 24", "--free", "height,throw,cor"]);
    near(run(&many).impacts()[1].t, 1.0);
    assert!(said.contains("many scenes do that"), "{said}");
}

#[test]
fn any_number_of_any_scene() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("ball.toml");
    let toml = "# a beach ball\nrestitution = 0.8 # on sand\n[ball]\nheight = \"150 cm\" # of its underside\n[drag]\nper_length = \"0.2 1/m\"\n";
    fs::write(&path, toml).unwrap();
    let path = path.to_str().unwrap();
    // Planted: what another restitution and drag do.
    let planted =
        run(&Scene::parse("s.toml", toml.replace("0.8", "0.72").replace("0.2 1/m", "0.31 1/m").as_bytes()).unwrap());
    let (touch, apex) = (planted.impacts()[2].t, planted.apexes(0)[0].height);
    let wishes = [format!("touch 3 at {touch}s"), format!("apex 2 at {apex}m")];
    let (status, out, err) = solve(&[&wishes[0], &wishes[1], "--free", "drag.per_length,cor", "--scene", path]);
    assert_eq!(status, Some(0), "{err}");
    let scene = Scene::parse("solved.toml", out.as_bytes()).unwrap();
    let record = run(&scene);
    near(record.impacts()[2].t, touch);
    near(record.apexes(0)[0].height, apex);
    assert!((cor(&scene) - 0.72).abs() < 1e-6, "{out}");
    // What was not asked for stays as it was written.
    assert!(out.starts_with("# a beach ball\nrestitution = 0.") && out.contains(" # on sand\n"), "{out}");
    assert!(out.contains("height = \"150 cm\" # of its underside\n") && out.contains(" 1/m\"\n"), "{out}");
    let out = folder.path().join("out.toml");
    let (status, stdout, _) =
        solve(&["touch 1 at 1s", "--free", "height", "--scene", path, "-o", out.to_str().unwrap()]);
    assert_eq!((status, stdout.as_str()), (Some(0), ""));
    near(run(&Scene::parse("out.toml", &fs::read(out).unwrap()).unwrap()).impacts()[0].t, 1.0);
    // Lists, and the throw of a ball that flies sideways.
    let path = folder.path().join("thrown.toml");
    fs::write(&path, "restitution = 0.7\nball = { height = 1, velocity = [3, 4] }\nrun = { until = '9 s' }\n").unwrap();
    let (scene, _) =
        solved(&["touch 2 at 8m", "apex 1 at 3m", "--free", "throw,forward", "--scene", path.to_str().unwrap()]);
    near(scene.balls[0].velocity.z, (2.0 * G * 2.0_f64).sqrt());
    near(run(&scene).at(0, run(&scene).impacts()[1].t).unwrap().position.x, 8.0);
}

#[test]
fn more_wishes_than_freedoms_share_what_is_missed() {
    let (scene, said) = solved(&["apex 2 at 30cm", "apex 3 at 10cm", "--free", "cor"]);
    // Least squares in e: the best of 10 000 values tried.
    let off = |e: f64| (e * e - 0.3).powi(2) + (e.powi(4) - 0.1).powi(2);
    let best = (1..10_000).map(|k| f64::from(k) * 1e-4).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap();
    assert!((cor(&scene) - best).abs() < 1e-4);
    assert!(said.contains("m more than asked") || said.contains("m less than asked"), "{said}");
    assert!(said.contains("2 wishes and 1 to change"), "{said}");
    // What matters more is missed by less.
    let (tight, _) = solved(&["apex 2 at 30cm within 0.1mm", "apex 3 at 10cm", "--free", "cor"]);
    assert!((cor(&tight).powi(2) - 0.3).abs() < 1e-5);
}

#[test]
fn contradictions_are_named() {
    let said = refused(&["apex 2 at 3m", "--free", "cor"]);
    assert!(said.contains("'apex 2 at 3m' cannot be by cor alone: the nearest is 1 m, with cor = 1"), "{said}");
    let said = refused(&["touch 1 at frame 24", "touch 2 at frame 20", "--free", "throw,cor"]);
    assert!(said.contains("'touch 1 at frame 24' and 'touch 2 at frame 20' contradict each other"), "{said}");
    let said = refused(&["touch 1 at 1s", "apex 2 at 30cm", "--free", "cor,forward"]);
    assert!(said.contains("'touch 1 at 1s' cannot be by cor, forward alone"), "{said}");
}

#[test]
fn of_several_balls_one_is_named() {
    let scene = tool::root().join("examples/scenes/stacked.toml");
    let scene = scene.to_str().unwrap();
    let said = refused(&["touch 1 at 1s", "--free", "throw", "--scene", scene]);
    assert!(
        said.contains("'throw' is of one ball, and the scene has a list") && said.contains("`ball.0.velocity`"),
        "{said}"
    );
    let (_, said) = solved(&["touch 1 at 1s", "--free", "ball.0.height", "--scene", scene]);
    assert!(said.contains("ball.0.height = "), "{said}");
}

#[test]
fn what_is_no_wish_is_said() {
    for (wish, says) in [
        ("bounce 1 at 1s", "begins with touch, apex, hop or rest"),
        ("touch at 1s", "say which, such as 'touch 1'"),
        ("touch 0 at 1s", "counted from 1"),
        ("touch 1", "say when or where"),
        ("touch 1 at 24", "write 'frame 24', '1.2s' or '60cm'"),
        ("touch 1 at 0", "write 'frame 24', '1.2s' or '60cm'"),
        ("touch 1 at frame x", "'x' is no number of frames"),
        ("touch 1 at 24 frames", "say which frame"),
        ("touch 1 at frame -3", "before the motion starts"),
        ("hop 1 at 20cm", "a hop takes a time"),
        ("hop 1 for frame 12", "say how many frames"),
        ("rest at 2m", "comes to rest at a time"),
        ("apex 1 at 1m within 1s", "'within' wants an amount"),
        ("apex 1 at 1m within", "say when or where"),
        ("", "say what is to happen"),
    ] {
        let said = refused(&[wish, "--free", "cor"]);
        assert!(said.contains(says), "{wish}: {said}");
    }
    assert!(refused(&["rest at 1s", "--free", "mass"]).contains("'mass' is neither height"));
    assert!(refused(&["rest at 1s", "--free", "cor,cor"]).contains("free twice"));
}

/// Two wishes of one thing are no wish, however many numbers are free; nothing is written.
#[test]
fn wishes_of_one_thing_that_differ() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("never.toml");
    let free = ["--free", "throw,height,gravity", "-o", path.to_str().unwrap()];
    let (status, out, message) = solve(&[&["touch 1 at frame 10", "touch 1 at frame 20"], &free[..]].concat());
    assert_eq!((status, out.as_str()), (Some(2), ""));
    assert!(message.contains("'touch 1 at frame 10' and 'touch 1 at frame 20' contradict each other"), "{message}");
    assert!(!path.exists());
}
