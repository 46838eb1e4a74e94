//! `saltus library` and the way to it from a table: folders whole or not at all, and every file as
//! its index says.

use crate::tool;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::tool::{done, refused, root};
use saltus_scene::Scene;
use serde_json::Value;
use tempfile::TempDir;

fn saltus(arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = tool::saltus().args(arguments).output().unwrap();
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, err)
}

fn example(name: &str) -> String {
    root().join("examples").join(name).to_string_lossy().into_owned()
}

/// A folder that does not exist, in one that goes when the test ends.
fn folder() -> (TempDir, String) {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("library").to_string_lossy().into_owned();
    (parent, path)
}

fn names(folder: &str) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect()
}

fn index(folder: &str) -> Value {
    serde_json::from_slice(&fs::read(Path::new(folder).join("index.json")).unwrap()).unwrap()
}

#[test]
fn every_motion_is_a_file_that_moves_as_the_index_says() {
    let (_parent, folder) = folder();
    let scene = example("scenes/squash.toml");
    let vary = ["--vary", "restitution=0.5,0.7", "--vary", "gravity=earth,moon", "--vary", "fps=24,25"];
    let mut arguments = vec!["library", &scene, "--to", "glb,usd", "--snap", "gravity", "-o", &folder];
    arguments.extend(vary);
    let (status, _, said) = saltus(&arguments);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("8 motions and index.json in"), "{said}");

    let index = index(&folder);
    assert_eq!(index["vary"], serde_json::json!(["restitution=0.5,0.7", "gravity=earth,moon", "fps=24,25"]));
    let motions = index["motions"].as_array().unwrap();
    let mut listed = BTreeSet::from(["index.json".to_owned()]);
    for (run, motion) in motions.iter().enumerate() {
        assert_eq!(motion["run"], run);
        let values = &motion["values"];
        let [cor, fps] = ["restitution", "fps"].map(|key| values[key].as_f64().unwrap());
        let g = if values["gravity"] == "moon" { 1.62 } else { 9.81 };
        let contacts: Vec<f64> =
            motion["contacts"].as_array().unwrap().iter().map(|contact| contact["frame"].as_f64().unwrap()).collect();
        // The fall and the first hop, to the nearest frame.
        let fall = (2.0_f64 / g).sqrt() * fps;
        assert!((contacts[0] - fall).abs() < 0.6, "{values}: {contacts:?}");
        assert!((contacts[1] - contacts[0] - 2.0 * cor * fall).abs() < 0.6, "{values}: {contacts:?}");
        assert!(contacts.iter().all(|frame| frame.fract() == 0.0), "{contacts:?}");

        for format in ["glb", "usd"] {
            let file = motion["files"][format]["name"].as_str().unwrap();
            listed.insert(file.to_owned());
            // As a scene of its own would be exported.
            let toml = fs::read_to_string(&scene).unwrap();
            let toml = toml.replace("restitution = 0.55", &format!("restitution = {cor}"));
            let toml = toml.replace("\"9.8 m/s^2\"", &values["gravity"].to_string());
            let own = Path::new(&folder).with_file_name("own.toml");
            fs::write(&own, toml).unwrap();
            let path = Path::new(&folder).join(file);
            let (status, out, err) = saltus(&[
                "check",
                &path.to_string_lossy(),
                &own.to_string_lossy(),
                "--snap",
                "gravity",
                "--fps",
                &fps.to_string(),
            ]);
            assert_eq!(status, Some(0), "{file}: {out}{err}");
        }
    }
    assert_eq!(motions.len(), 8);
    assert_eq!(names(&folder), listed);
    assert!(listed.contains("5-restitution=0.7-gravity=earth-fps=25.glb"), "{listed:?}");
}

#[test]
fn what_comes_to_nothing_is_in_the_index_with_its_reason() {
    let (_parent, folder) = folder();
    let scene = example("scenes/squash.toml");
    let (status, _, said) = saltus(&["library", &scene, "--vary", "loop=1,2,99", "--to", "svg", "-o", &folder]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("1 of 3 came to nothing; the first is motion 2, loop = 99: there is no hop 99"), "{said}");
    let index = index(&folder);
    assert_eq!(index["motions"].as_array().unwrap().len(), 2);
    assert_eq!(index["motions"][1]["loops"], true);
    assert_eq!(index["nothing"][0]["values"]["loop"], 99.0);
}

#[test]
fn nothing_is_lost_and_nothing_is_half_done() {
    let (parent, folder) = folder();
    let scene = example("scenes/squash.toml");
    let library = |vary: &str, more: &[&str]| {
        let mut arguments = vec!["library", &scene, "--vary", vary, "--to", "csv", "-o", &folder];
        arguments.extend(more);
        saltus(&arguments)
    };
    // An error in the first motion comes before there is a folder.
    for (vary, says) in [
        ("restitution=1.2,1.3", "motion 0, restitution = 1.2: "),
        ("resttution=0.5", "did you mean `restitution`?"),
        ("fps=0,24", "motion 0, fps = 0: '0' is not a frame rate"),
        ("squash=2", "motion 0, squash = 2: '2' is not a number from 0 to 0.9"),
        ("ball.height=1m:2m:100000", "100000 motions are more than 10000: vary less"),
    ] {
        let (status, out, said) = library(vary, &[]);
        assert_eq!((status, out.as_str()), (Some(2), ""), "{vary}");
        assert!(said.contains(says), "{said}");
        assert!(!Path::new(&folder).exists(), "{vary}");
    }
    assert_eq!(library("restitution=0.5,0.6", &[]).0, Some(0));
    let before = names(&folder);
    let (status, _, said) = library("restitution=0.7", &[]);
    assert_eq!(status, Some(2));
    assert!(said.contains("is not empty: name a new one, or say --force"), "{said}");
    assert_eq!(names(&folder), before);
    assert_eq!(library("restitution=0.7", &["--force"]).0, Some(0));
    assert_eq!(index(&folder)["motions"].as_array().unwrap().len(), 1);

    let file = parent.path().join("file").to_string_lossy().into_owned();
    fs::write(&file, "mine").unwrap();
    let (status, _, said) = saltus(&["library", &scene, "--vary", "restitution=0.7", "--to", "csv", "-o", &file]);
    assert_eq!(status, Some(2));
    assert!(said.contains("is a file: name a folder"), "{said}");
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

#[test]
fn the_same_on_every_run() {
    let scene = example("scenes/topspin.toml");
    let made = || {
        let (parent, folder) = folder();
        let random = ["--random", "5", "--seed", "3"];
        let mut arguments = vec!["library", &scene, "--vary", "ball.height=50cm:2m", "--to", "json", "-o", &folder];
        arguments.extend(random);
        let (status, _, said) = saltus(&arguments);
        assert_eq!(status, Some(0), "{said}");
        let files: Vec<(String, Vec<u8>)> = names(&folder)
            .into_iter()
            .map(|name| (name.clone(), fs::read(Path::new(&folder).join(&name)).unwrap()))
            .collect();
        drop(parent);
        files
    };
    assert_eq!(made(), made());
}

#[test]
fn from_a_table_to_an_animation() {
    let parent = tempfile::tempdir().unwrap();
    let path = |name: &str| parent.path().join(name).to_string_lossy().into_owned();
    let (table, scene, ball) = (example("data/squash-on-cement.csv"), path("ball.toml"), path("ball.glb"));
    let (status, _, said) = saltus(&["fit", &table, "--scene", &scene]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains(&format!("to see it move: saltus export {scene} -o")), "{said}");
    let fitted = Scene::parse("fitted", &fs::read(&scene).unwrap()).unwrap();
    // The one COR for heights and times together, of which the report speaks.
    assert!((fitted.law(0, 0).unwrap().constant().unwrap().value() - 0.496).abs() < 5e-4);
    assert_eq!(saltus(&["export", &scene, "--snap", "gravity", "-o", &ball]).0, Some(0));
    assert_eq!(saltus(&["check", &ball, &scene, "--snap", "gravity"]).0, Some(0));

    // A scene may have been worked on since.
    fs::write(&scene, "mine").unwrap();
    let (status, out, said) = saltus(&["fit", &table, "--scene", &scene]);
    assert_eq!((status, out.as_str()), (Some(2), ""));
    assert!(said.contains("exists: name another file, or say --force"), "{said}");
    assert_eq!(fs::read_to_string(&scene).unwrap(), "mine");
    assert_eq!(saltus(&["fit", &table, "--scene", &scene, "--force"]).0, Some(0));
    assert_ne!(fs::read_to_string(&scene).unwrap(), "mine");

    // What determines no COR gives no scene, and no library.
    let one = path("one.csv");
    fs::write(&one, "bounce,height_cm\n0,100\n").unwrap();
    let (status, _, said) = saltus(&["fit", &one, "--scene", &path("none.toml")]);
    assert_eq!(status, Some(2));
    assert!(said.contains("no scene was written: "), "{said}");
    assert!(!Path::new(&path("none.toml")).exists());
    let (status, _, said) = saltus(&["library", &one, "--vary", "gravity=moon", "--to", "svg", "-o", &path("lib")]);
    assert_eq!(status, Some(2));
    assert!(said.contains("gives no motion: "), "{said}");

    let (status, _, said) =
        saltus(&["library", &table, "--vary", "gravity=earth,moon", "--to", "svg", "-o", &path("lib")]);
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(names(&path("lib")).len(), 3);
}

#[test]
fn what_contradicts_itself_is_refused() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let scene = root().join("examples/scenes/squash.toml");
    let scene = scene.to_str().unwrap();
    let to = path("lib");
    let library = ["library", scene, "--to", "csv", "-o", &to, "--vary"];
    for (varied, given) in [
        ("fps=24,25", &["--fps", "30"][..]),
        ("snap=gravity,heights", &["--snap", "gravity"]),
        ("on-twos=true,false", &["--on-twos"]),
        ("squash=0.1,0.2", &["--squash", "0.3"]),
        ("stretch=0.1,0.2", &["--stretch", "0.1"]),
        ("exaggerate=1,2", &["--exaggerate", "1"]),
        ("hold=1,2", &["--hold", "3"]),
        ("loop=1,2", &["--loop"]),
        ("mirror=true,false", &["--mirror"]),
        ("run.until=1,2", &["--until", "3s"]),
    ] {
        let key = varied.split('=').next().unwrap();
        let says = refused(&[&library, &[varied][..], given].concat());
        assert!(says.contains(&format!("`{key}`")) && says.contains("leave one of them out"), "{says}");
    }
    let dash = ["library", scene, "--to", "csv", "-o", "-", "--vary", "fps=24,25"];
    assert!(refused(&dash).contains("name a folder"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    done(&[&library, &["fps=24,25"][..]].concat());
}

#[cfg(unix)]
#[test]
fn a_library_that_breaks_off_counts_what_is_whole() {
    let folder = TempDir::new().unwrap();
    let to = folder.path().join("lib");
    // A folder stands where the third motion is to go.
    fs::create_dir_all(to.join("2-restitution=0.6.csv")).unwrap();
    let scene = root().join("examples/scenes/squash.toml");
    let (scene, to) = (scene.to_str().unwrap(), to.to_str().unwrap());
    let says =
        refused(&["-q", "library", scene, "--vary", "restitution=0.4:0.8:5", "--to", "csv", "--force", "-o", to]);
    assert!(says.contains("has 2 whole motions and no index"), "{says}");
}
