//! `saltus sweep --into`: a folder of parts, whatever happens to those who write it.

use crate::tool;

use std::collections::BTreeMap;
use std::fs;
use std::process::{Child, Command, Output, Stdio};

use crate::tool::place::{DROP, Place};
use proptest::prelude::*;
use saltus_cases::cases;

const GRID: [&str; 4] = ["--vary", "restitution=0.5:0.9:12", "--vary", "ball.height=1m:9m:10"];

impl Place {
    fn command_into(&self, folder: &str, more: &[&str]) -> Command {
        let mut command = self.sweep();
        command.args(["--into", folder]).args(GRID).args(more);
        command
    }

    fn run_into(&self, folder: &str, more: &[&str]) -> Output {
        self.command_into(folder, more).output().unwrap()
    }

    fn done_into(&self, folder: &str, more: &[&str]) -> String {
        let output = self.run_into(folder, more);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && output.stdout.is_empty(), "{said}");
        said
    }

    fn refused_into(&self, folder: &str, more: &[&str]) -> String {
        let output = self.run_into(folder, more);
        assert_eq!(output.status.code(), Some(2), "{folder} {more:?}");
        String::from_utf8(output.stderr).unwrap()
    }

    /// All files of a folder.
    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let files = fs::read_dir(self.path(folder)).unwrap().map(Result::unwrap);
        files.map(|file| (file.file_name().into_string().unwrap(), fs::read(file.path()).unwrap())).collect()
    }

    fn parts(&self, folder: &str) -> usize {
        fs::read_dir(self.path(folder)).map_or(0, |files| {
            files.flatten().filter(|file| file.file_name().to_string_lossy().starts_with("part-")).count()
        })
    }
}

#[test]
fn shares_make_the_whole() {
    let place = Place::of(DROP);
    assert_eq!(place.done_into("whole", &["--chunk", "7"]), "");
    let whole = place.files("whole");
    assert_eq!(whole.len(), 1 + 18);
    assert!(whole.contains_key("_sweep.json") && whole.contains_key("part-000.parquet"));
    for (n, share) in ["3/4", "1/4", "4/4", "2/4"].into_iter().enumerate() {
        let said = place.done_into("shares", &["--chunk", "7", "--part", share, "--threads", "1"]);
        assert_eq!(said.contains("other shares make them"), n < 3, "{said}");
    }
    assert!(place.files("shares") == whole);
    // Who comes again changes nothing.
    let when = |name: &str| fs::metadata(place.path("whole").join(name)).unwrap().modified().unwrap();
    let before: Vec<_> = whole.keys().map(|name| when(name)).collect();
    place.done_into("whole", &[]);
    assert_eq!(whole.keys().map(|name| when(name)).collect::<Vec<_>>(), before);
}

#[test]
fn several_write_to_one_folder() {
    let place = Place::of(DROP);
    place.done_into("whole", &["--chunk", "1"]);
    let whole = place.files("whole");
    for n in 0..3 {
        let folder = format!("shared{n}");
        let silent = |_: usize| {
            let mut command = place.command_into(&folder, &["--chunk", "1"]);
            command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
        };
        for writer in (0..4).map(silent).collect::<Vec<Child>>() {
            let output = writer.wait_with_output().unwrap();
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        }
        assert!(place.files(&folder) == whole);
    }
}

/// Those who begin a folder without saying how long its parts are go by what the first says.
#[test]
fn of_several_that_begin_a_folder_one_says_how_long_parts_are() {
    let place = Place::of(DROP);
    let begin = |n: usize| {
        let chunk = (n + 3).to_string();
        let more: &[&str] = if n == 3 { &[] } else { &["--chunk", &chunk] };
        place.command_into("rows", more).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let writers: Vec<Child> = (0..4).map(begin).collect();
    let outputs: Vec<Output> = writers.into_iter().map(|writer| writer.wait_with_output().unwrap()).collect();
    assert!(outputs.iter().any(|output| output.status.success()));
    for output in outputs.iter().filter(|output| !output.status.success()) {
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(said.contains("rows, and not"), "{said}");
    }
    let plan: serde_json::Value = serde_json::from_slice(&place.files("rows")["_sweep.json"]).unwrap();
    assert_eq!(place.parts("rows") as u64, 120_u64.div_ceil(plan["chunk"].as_u64().unwrap()));
}

/// Killed where it stands, as often as need be, it ends in the bytes of a sweep that nobody
/// touched, and makes nothing again.
#[cfg(unix)]
#[test]
fn killed_and_gone_on_with() {
    use std::os::unix::fs::MetadataExt;
    use std::time::{Duration, Instant};

    let place = Place::of(tool::place::DRAG);
    place.done_into("whole", &["--chunk", "2"]);
    let (whole, clock) = (place.files("whole"), Instant::now());
    let inode = |name: &str| fs::metadata(place.path("rows").join(name)).unwrap().ino();
    let (mut kills, mut made) = (0, BTreeMap::<String, u64>::new());
    loop {
        let mut child = place.command_into("rows", &["--chunk", "2"]).stderr(Stdio::null()).spawn().unwrap();
        let wanted = made.len() + 8;
        while child.try_wait().unwrap().is_none() && place.parts("rows") < wanted {
            assert!(clock.elapsed() < Duration::from_secs(300));
        }
        child.kill().unwrap();
        let over = child.wait().unwrap().success();
        assert!(made.iter().all(|(name, number)| inode(name) == *number), "what is there is not made again");
        for (name, bytes) in place.files("rows").iter().filter(|(name, _)| name.starts_with("part-")) {
            assert!(bytes == &whole[name], "{name} is not whole");
            made.insert(name.clone(), inode(name));
        }
        if over {
            break;
        }
        kills += 1;
    }
    assert!(kills >= 2, "it was never killed in the middle");
    assert!(place.files("rows") == whole);
}

#[test]
fn another_sweep_is_refused() {
    let place = Place::of(DROP);
    place.done_into("rows", &["--chunk", "20"]);
    let whole = place.files("rows");
    let said = place.refused_into("rows", &["--until", "2s"]);
    assert!(
        said.contains("'rows' holds another sweep: its `until_s` is null, here it is 2.0; name another folder"),
        "{said}"
    );
    let said = place.refused_into("rows", &["--chunk", "30"]);
    assert!(said.contains("have 20 rows, and not 30"), "{said}");
    fs::write(place.path("scene.toml"), DROP.replace("0.5", "0.6")).unwrap();
    let said = place.refused_into("rows", &[]);
    assert!(said.contains("the scene is not the same"), "{said}");
    assert!(place.files("rows") == whole);
    // A part of it in another folder.
    place.done_into("others", &["--chunk", "20"]);
    fs::copy(place.path("rows/part-020.parquet"), place.path("others/part-020.parquet")).unwrap();
    let said = place.refused_into("others", &[]);
    assert!(said.contains("belongs to another sweep"), "{said}");
    fs::remove_file(place.path("rows/_sweep.json")).unwrap();
    let said = place.refused_into("rows", &[]);
    assert!(said.contains("has parts and no _sweep.json"), "{said}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let place = Place::of(DROP);
    for (more, says) in [
        (&["--part", "0/4"][..], "'0/4' is no share"),
        (&["--part", "5/4"], "'5/4' is no share"),
        (&["--part", "half"], "'half' is no share"),
        (&["--chunk", "0"], "0"),
        (&["-o", "rows.csv"], "cannot be used with"),
        (&["--resume"], "--resume"),
        (&["--plot", "rows.svg"], "cannot be used with"),
    ] {
        let said = place.refused_into("rows", more);
        assert!(said.contains(says), "{more:?}: {said}");
    }
    assert!(!place.path("rows").exists());
    let said = place.refused_into("scene.toml", &[]);
    assert!(said.contains("scene.toml"), "{said}");
}

#[test]
fn runs_that_come_to_nothing_are_rows_and_named() {
    let place = Place::of(DROP);
    let said = place.done_into("rows", &["--vary", "drag.per_length=0,-1", "--chunk", "50"]);
    assert!(said.contains("120 runs came to nothing; the first is run 1, "), "{said}");
    assert_eq!(place.parts("rows"), 5);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(12), ..ProptestConfig::default() })]
    /// Parts that are missing, cut off or padded are made again; what was left over is gone.
    #[test]
    fn what_is_missing_or_torn_is_made_again(
        chunk in 5_usize..40,
        gone in prop::collection::vec(any::<prop::sample::Index>(), 0..4),
        torn in any::<prop::sample::Index>(),
        cut in 0.0..1.0_f64,
        padding in prop::option::of(prop::sample::select(vec![0_u8, 0xff])),
    ) {
        let place = Place::of(DROP);
        let chunk = chunk.to_string();
        place.done_into("rows", &["--chunk", &chunk]);
        let whole = place.files("rows");
        let names: Vec<&String> = whole.keys().filter(|name| name.starts_with("part-")).collect();
        let torn = torn.get(&names);
        let mut bytes = whole[*torn].clone();
        let (kept, length) = ((cut * bytes.len() as f64) as usize, bytes.len());
        bytes.truncate(kept);
        if let Some(byte) = padding {
            bytes.resize(length, byte);
        }
        fs::write(place.path("rows").join(torn), bytes).unwrap();
        for index in gone {
            let _ = fs::remove_file(place.path("rows").join(index.get(&names)));
        }
        fs::write(place.path("rows/.part-000.parquet.0123.part"), "left by one who was killed").unwrap();
        place.done_into("rows", &[]);
        prop_assert!(place.files("rows") == whole);
    }
}
