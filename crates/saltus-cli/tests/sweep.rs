//! `saltus sweep` as its user meets it.

use crate::tool;

use std::fs;
use std::process::{Command, Output};

use crate::tool::place::{DRAG, DROP, Place};
use serde_json::Value;

impl Place {
    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = self.sweep();
        command.args(arguments);
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// The output and the messages of a command that has to succeed.
    fn done(&self, arguments: &[&str]) -> (String, String) {
        let output = self.run(arguments);
        let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        assert!(output.status.success(), "{err}");
        (out, err)
    }

    /// Must fail with status 2 and nothing on standard output; the message.
    fn refused(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(String::from_utf8(output.stdout).unwrap(), "");
        String::from_utf8(output.stderr).unwrap()
    }
}

/// The cells of a column.
fn column<'a>(csv: &'a str, name: &str) -> Vec<&'a str> {
    let at = csv.lines().next().unwrap().split(',').position(|header| header == name);
    let at = at.unwrap_or_else(|| panic!("no column {name} in {csv}"));
    csv.lines().skip(1).map(|line| line.split(',').nth(at).unwrap()).collect()
}

fn numbers(csv: &str, name: &str) -> Vec<f64> {
    column(csv, name).into_iter().map(|cell| cell.parse().unwrap_or_else(|_| panic!("{name}: {cell}"))).collect()
}

#[test]
fn every_row_is_the_run_it_says() {
    let place = Place::of(DROP);
    let (csv, said) = place.done(&["--vary", "restitution=0.3:0.9:3", "--vary", "ball.height=50cm:2m:4"]);
    assert_eq!(said, "");
    assert_eq!(column(&csv, "run").len(), 12);
    // The first varies slowest; the second end is in the unit of the first.
    assert_eq!(column(&csv, "restitution")[3..5], ["0.3", "0.6"]);
    assert_eq!(column(&csv, "ball.height_cm")[..4], ["50", "100", "150", "200"]);
    let cells = |name| numbers(&csv, name);
    let (cor, height) = (cells("restitution"), cells("ball.height_cm"));
    let (first, apex, rest) = (cells("first_impact_s"), cells("first_apex_m"), cells("rest_s"));
    for k in 0..12 {
        let (e, h) = (cor[k], height[k] / 100.0);
        let fall = (2.0 * h / 9.806_65_f64).sqrt();
        assert!((first[k] - fall).abs() < 1e-14 && (apex[k] - e * e * h).abs() < 1e-14, "run {k}");
        assert!((rest[k] - fall * (1.0 + e) / (1.0 - e)).abs() < 1e-12, "run {k}");
    }
    assert!(column(&csv, "end").iter().all(|end| *end == "time") && cells("height_m").iter().all(|h| *h == 0.0));
}

#[test]
fn values_of_all_kinds() {
    let place = Place::of(DROP);
    let (csv, _) = place.done(&["--vary", "gravity=moon,earth", "--columns", "impacts,first_impact_s"]);
    assert_eq!(csv.lines().next(), Some("run,gravity,impacts,first_impact_s"));
    let times = numbers(&csv, "first_impact_s");
    assert_eq!(column(&csv, "gravity"), ["moon", "earth"]);
    assert!((times[0] / times[1] - (9.806_65_f64 / 1.62).sqrt()).abs() < 1e-14);
    // A key the file does not have; equal factors; whole numbers where they are wanted.
    let (csv, _) = place.done(&["--vary", "drag.per_length=1e-3:10:5:log", "--vary", "run.most_jumps=1:3:3"]);
    assert_eq!(
        column(&csv, "drag.per_length").iter().step_by(3).copied().collect::<Vec<_>>(),
        ["0.001", "0.01", "0.1", "1", "10"]
    );
    assert_eq!(column(&csv, "jumps")[..3], ["1", "2", "3"]);
    assert_eq!(column(&csv, "end")[..3], ["jumps"; 3]);
    // Lists inside the scene.
    let place = Place::of(
        "restitution = 0.7\nball = { radius = '3 cm', position = [0, 1], velocity = [1, 0] }\nrun = { until = '1 s' }\n[[floor]]\n[[floor]]\nkind = 'wall'\nat = '1 m'\n",
    );
    let (csv, _) = place.done(&["--vary", "ball.velocity.0=1m/s,-1m/s", "--vary", "floor.1.at=0.5:1m:2"]);
    assert_eq!(column(&csv, "ball.velocity.0_m_per_s"), ["1", "1", "-1", "-1"]);
    assert_eq!(numbers(&csv, "floor.1.at_m"), [0.5, 1.0, 0.5, 1.0]);
    assert!(numbers(&csv, "x_m")[2] < -0.9 && numbers(&csv, "x_m")[0] < 0.5);
}

#[test]
fn draws_depend_on_the_seed_alone() {
    let place = Place::of(DRAG);
    let draw = |more: &[&str]| {
        let vary = ["--vary", "restitution=0.2:0.6", "--vary", "drag.per_length=1e-3:10:log", "--random", "200"];
        place.done(&[&vary, more].concat()).0
    };
    let one = draw(&["--threads", "1"]);
    assert_eq!(one, draw(&["--threads", "2"]));
    assert_eq!(one, draw(&["--threads", "8"]));
    let cor = numbers(&one, "restitution");
    assert!(cor.iter().all(|e| (0.2..0.6).contains(e)));
    // Even: the mean of 200 draws is within four of its standard errors.
    let mean = |values: &[f64]| values.iter().sum::<f64>() / 200.0;
    assert!((mean(&cor) - 0.4).abs() < 4.0 * 0.4 / 12.0_f64.sqrt() / 200.0_f64.sqrt());
    let powers: Vec<f64> = numbers(&one, "drag.per_length").iter().map(|k| k.log10()).collect();
    assert!((mean(&powers) + 1.0).abs() < 4.0 * 4.0 / 12.0_f64.sqrt() / 200.0_f64.sqrt());
    assert_ne!(one, draw(&["--seed", "2"]));
}

#[test]
fn programs_get_an_object_in_each_line() {
    let place = Place::of(DROP);
    place.done(&["--vary", "restitution=0:1:3", "--until", "3s", "-o", "rows.jsonl"]);
    let rows: Vec<Value> = place.read("rows.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(rows.len(), 3);
    assert_eq!((&rows[1]["run"], &rows[1]["restitution"]), (&Value::from(1), &Value::from(0.5)));
    // A ball that stays has no apex; one that loses nothing does not rest.
    assert!(rows[0]["first_apex_m"].is_null() && rows[2]["rest_s"].is_null());
    assert!(rows[2]["evaluations"].as_u64().is_some() && rows[2]["end"] == "time");
}

#[test]
fn a_run_that_comes_to_nothing_is_a_row() {
    let place = Place::of(DROP);
    let (csv, said) = place.done(&["--vary", "floor.height=0m:2m:5"]);
    assert_eq!(column(&csv, "end"), ["time", "time", "time", "refused", "refused"]);
    assert_eq!(column(&csv, "impacts")[2..4], ["0", ""]);
    let why = csv.lines().nth(4).unwrap();
    assert!(why.ends_with(",\"the ball starts below the floor, at a height of 1 m: the floor is at 1.5 m there, start at or above it\""), "{why}");
    assert!(said.contains("2 of 5 runs came to nothing; the first is run 3, floor.height = 1.5 m: "), "{said}");
}

#[test]
fn what_is_wrong_is_said_before_anything_is_written() {
    let place = Place::of(DROP);
    for (vary, says) in [
        ("restitution", "have `=` between them"),
        ("restitution=", "a value is missing"),
        ("restitution=0.5,,0.6", "a value is missing"),
        ("=1:2:3", "is no key"),
        ("ball height=1:2:3", "is no key"),
        ("restitution=0:1:0", "a count above zero"),
        ("restitution=0:1:-3", "'-3' is no count"),
        ("restitution=0:1:1", "a count of two or more"),
        ("restitution=0:1:2:3", "is no range"),
        ("restitution=0:one:3", "'one' is not a number"),
        ("restitution=nan:1:3", "'nan' is not a number"),
        ("restitution=0:1:3:log", "above zero"),
        ("ball.height=1m:10s:3", "do not measure the same"),
        ("ball.height='1m':'2m':3", "without quotes"),
        ("restitution=0:1", "it is not said how many values `restitution` takes"),
        (
            "restitution=1.2,0.5",
            "run 0, restitution = 1.2: scene.toml as varied:1:15: 1.2 is not a coefficient of restitution",
        ),
        ("ball.heigth=1m:2m:3", "did you mean `height`?"),
        ("ball.height=1s:2s:3", "not a unit of length but of time"),
        ("restitution.pick=0:1:3", "`restitution` is one value and has no keys"),
        ("ball=1:2:3", "does not belong here"),
        ("ball.name=1:2:3", "does not belong here"),
        ("ball.0.height=1m,2m", "`0` is no key here"),
        ("run.until=-1s,2s", "a time to stop at"),
    ] {
        let said = place.refused(&["--vary", vary, "-o", "rows.csv"]);
        assert!(said.contains(says), "{vary}: {said}");
        assert!(!place.path("rows.csv").exists(), "{vary}");
    }
    for (vary, option) in [("run.until=1s,2s", "--until=3s"), ("run.most_jumps=5,6", "--most-jumps=9")] {
        let said = place.refused(&["--vary", vary, option, "-o", "rows.csv"]);
        assert!(said.contains("given for every run as well"), "{vary}: {said}");
    }
    let said = place.refused(&["--vary", "restitution=0.1,0.2", "--vary", "restitution=0.1,0.2"]);
    assert!(said.contains("`restitution` varies twice"), "{said}");
    let said = place.refused(&["--vary", "restitution=0:1:1000000", "--vary", "ball.height=1:2:10000000"]);
    assert!(said.contains("10000000000000 runs, and a sweep has 100000000 at most: vary in fewer"), "{said}");
    for many in [&["restitution=0:1:99999999999"][..], &["restitution=0:1", "--random=100000001"]] {
        let said = place.refused(&[&["--vary"], many, &["-o", "rows.csv"]].concat());
        assert!(said.contains("a sweep has 100000000 at most"), "{said}");
    }
    let all: Vec<String> = (0..12).map(|key| format!("--vary=key{key}=0:1:99999999999")).collect();
    let said = place.refused(&all.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said.contains("a sweep has 100000000 at most"), "{said}");
    assert!(!place.path("rows.csv").exists() && !place.path("rows.csv.sweep").exists());
    let several = Place::of(
        "floor = [{ restitution = 0.5 }, { kind = 'wall', at = '2 m', restitution = 0.5 }]\nball = { position = [0, 1] }\nrun = { until = '1 s' }\n",
    );
    for key in ["floor.friction", "floor.2.friction"] {
        let said = several.refused(&["--vary", &format!("{key}=0.1,0.2")]);
        assert!(said.contains("`floor` is a list of 2\n") && said.contains("write `floor.0` to `floor.1`"), "{said}");
    }
}

/// A line, lines, a map, dots; and what cannot be drawn is refused before a run is made.
/// A design has a run for each of its rows, whatever order they are in, and the rows are those of
/// the runs by themselves.
#[test]
fn a_design_has_a_run_for_each_row() {
    let place = Place::of(DROP);
    fs::write(place.path("design.csv"), "restitution,ball.height (cm)\n0.7,80\n0.5,120\n0.6,80\n").unwrap();
    let (csv, _) = place.done(&["--design", "design.csv"]);
    assert_eq!(column(&csv, "restitution"), ["0.7", "0.5", "0.6"]);
    assert_eq!(numbers(&csv, "ball.height_cm"), [80.0, 120.0, 80.0]);
    let (grid, _) = place.done(&["--vary", "restitution=0.5,0.6,0.7", "--vary", "ball.height=80cm,120cm"]);
    let rest = |csv: &str, e: &str, h: f64| {
        let rows =
            column(csv, "restitution").into_iter().zip(numbers(csv, "ball.height_cm")).zip(numbers(csv, "rest_s"));
        rows.filter(|((own, height), _)| *own == e && *height == h).map(|(_, at)| at).next().unwrap()
    };
    for (e, h) in [("0.7", 80.0), ("0.5", 120.0), ("0.6", 80.0)] {
        assert_eq!(rest(&csv, e, h), rest(&grid, e, h));
    }
    place.done(&["--design", "design.csv", "--into", "rows", "--chunk", "2"]);
    assert!(place.path("rows/part-2.parquet").exists());
    for (text, says) in [
        ("restitution\n", "has no rows"),
        ("restitution,ball.height\n0.5\n", "line"),
        ("restitution,ball.height\n0.5,\n", "line 2, `ball.height`: a value is missing"),
        ("restitution\n\"0.5,0.6\"\n", "one value is wanted"),
        ("no key\n0.5\n", "is no key"),
    ] {
        fs::write(place.path("bad.csv"), text).unwrap();
        let said = place.refused(&["--design", "bad.csv"]);
        assert!(said.contains("bad.csv") && said.contains(says), "{text}: {said}");
    }
    assert!(place.refused(&["--design", "none.csv"]).contains("none.csv"));
    assert!(place.refused(&["--design", "design.csv", "--plot", "p.svg", "-o", "t.csv"]).contains("one key"));
    assert!(place.refused(&["--design", "design.csv", "--vary", "restitution=0.5"]).contains("--vary"));
}

#[test]
fn sweeps_are_drawn() {
    let place = Place::of(DROP);
    let drawn = |vary: &[&str]| {
        let mut arguments = vary.to_vec();
        arguments.extend(["-o", "table.csv", "--force", "--plot", "picture.svg"]);
        place.done(&arguments);
        let svg = place.read("picture.svg");
        assert!(svg.starts_with("<svg") && place.read("table.csv").lines().count() > 3, "{svg}");
        svg
    };
    let line = drawn(&["--vary", "restitution=0.3:0.7:5"]);
    assert!(line.contains("Rest by restitution") && line.contains("rest (s)"));
    let lines = drawn(&["--vary", "restitution=0.3:0.7:5", "--vary", "ball.height=1m:2m:2", "--show", "impacts"]);
    assert!(lines.contains("ball.height = 2 m") && lines.contains("Impacts by"), "{lines}");
    let words = drawn(&["--vary", "gravity=earth,moon", "--vary", "restitution=0.3:0.7:5", "--show", "first_apex_m"]);
    assert!(words.contains("gravity = moon") && words.contains("first apex (cm)"), "{words}");
    let map = drawn(&["--vary", "restitution=0.3:0.7:9", "--vary", "ball.height=1cm:10m:8:log"]);
    assert!(map.contains("fill-opacity") && map.contains("ball.height (cm)"), "{map}");
    drawn(&["--vary", "restitution=0.3:0.7", "--random", "9"]);
    // Gone on with in either format, the picture is that of the whole sweep.
    for table in ["again.csv", "again.jsonl"] {
        let vary = ["--vary", "restitution=0.3:1.2:9", "--vary", "gravity=earth,moon", "--plot", "picture.svg"];
        place.done(&[&vary[..], &["-o", table]].concat());
        let (whole, picture) = (place.read(table), place.read("picture.svg"));
        for kept in [1, 7, 18] {
            let lines: Vec<&str> = whole.lines().take(kept).collect();
            fs::write(place.path(table), lines.join("\n") + "\n4,0.").unwrap();
            place.done(&[&vary[..], &["-o", table, "--resume"]].concat());
            assert!(place.read(table) == whole && place.read("picture.svg") == picture, "{table}: {kept}");
        }
    }

    let refused = |arguments: &[&str]| place.refused(&[arguments, &["--plot", "p.svg", "-o", "t.csv"]].concat());
    let text = refused(&["--vary", "restitution=0.3:0.7:5", "--show", "rest"]);
    assert!(text.contains("no number called 'rest': choose one of impacts, first_impact_s"), "{text}");
    assert!(refused(&["--vary", "gravity=earth,moon"]).contains("an axis is made of numbers"));
    assert!(refused(&["--vary", "restitution=0.3:0.7:500", "--vary", "ball.height=1m:2m:500"]).contains("100000 runs"));
    let three = ["--vary", "restitution=0.3:0.7:2", "--vary", "ball.height=1m:2m:2", "--vary", "gravity=9.8,1.6"];
    assert!(refused(&three).contains("one key, or a grid of two"));
    for (plot, says) in [("p.png", "name the file 'p.svg'"), ("no/p.svg", "no folder 'no'"), ("-", "cannot both go")] {
        let output = if plot == "-" { "-" } else { "t.csv" };
        let said = place.refused(&["--vary", "restitution=0.3:0.7:5", "--plot", plot, "-o", output]);
        assert!(said.contains(says), "{said}");
    }
    assert!(!place.path("t.csv").exists() && !place.path("p.svg").exists());
}

#[test]
fn files_are_not_lost() {
    let place = Place::of(DROP);
    let vary = ["--vary", "restitution=0.1:0.9:9"];
    let run = |more: &[&'static str]| [&vary[..], more].concat();
    for (output, says) in [
        ("no/such/rows.csv", "there is no folder"),
        (".", "is a folder"),
        ("rows.json", "use .jsonl"),
        ("rows.xlsx", "no format goes by the extension '.xlsx'"),
    ] {
        assert!(place.refused(&run(&["-o", output])).contains(says), "{output}");
    }
    place.done(&run(&["-o", "rows.csv"]));
    let whole = place.read("rows.csv");
    assert!(place.refused(&run(&["-o", "rows.csv"])).contains("--resume goes on with it, --force starts anew"));
    // Nothing is left to be made, and nothing changes.
    place.done(&run(&["-o", "rows.csv", "--resume"]));
    assert_eq!(place.read("rows.csv"), whole);
    // Another sweep's file is not touched.
    for (more, says) in [
        (&["--until", "2s"][..], "its `until_s` is null, here it is \"2\""),
        (&["--columns", "end"], "its `columns` is"),
        (&["--random", "9"], "its `random` is null, here it is 9"),
        (&["--vary", "ball.height=1m,2m"], "its `vary` is [\"restitution=0.1:0.9:9\"]"),
    ] {
        let said = place.refused(&run(&[more, &["-o", "rows.csv", "--resume"]].concat()));
        assert!(said.contains("belongs to another sweep: ") && said.contains(says), "{said}");
        assert_eq!(place.read("rows.csv"), whole);
    }
    fs::write(place.path("scene.toml"), DROP.replace("1 m", "2 m")).unwrap();
    assert!(place.refused(&run(&["-o", "rows.csv", "--resume"])).contains("the scene is not the same"));
    place.done(&run(&["-o", "rows.csv", "--force"]));
    assert_ne!(place.read("rows.csv"), whole);
    fs::remove_file(place.path("rows.csv.sweep")).unwrap();
    assert!(place.refused(&run(&["-o", "rows.csv", "--resume"])).contains("it is not known which sweep"));
    assert!(place.refused(&run(&["--resume"])).contains("--output"));
}

#[test]
fn a_torn_row_is_made_again() {
    for name in ["rows.csv", "rows.jsonl"] {
        let place = Place::of(DROP);
        let all = ["--vary", "restitution=0.1:0.9:9", "-o", name, "--resume"];
        // --resume of nothing starts.
        place.done(&all);
        let whole = place.read(name);
        for cut in 0..whole.len() {
            if cut % 97 == 0 || cut < 8 || cut == whole.len() - 1 {
                fs::write(place.path(name), &whole[..cut]).unwrap();
                place.done(&all);
                assert_eq!(place.read(name), whole, "cut at {cut}");
            }
        }
        let changed: String = whole
            .lines()
            .filter(|line| !line.contains("0.4,") && !line.contains("0.4}"))
            .map(|line| format!("{line}\n"))
            .collect();
        assert_ne!(changed, whole);
        fs::write(place.path(name), &changed).unwrap();
        let said = place.refused(&all);
        assert!(said.contains("was changed since: its line"), "{said}");
        assert_eq!(place.read(name), changed);
    }
}

/// Killed where it stands, as often as need be, it ends in the bytes of a sweep that nobody
/// touched.
#[cfg(unix)]
#[test]
fn killed_and_gone_on_with() {
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    let place = Place::of(DRAG);
    let sweep = ["--vary", "restitution=0.5:0.9:60", "--vary", "ball.height=1m:10m:60", "--threads", "2"];
    place.done(&[&sweep[..], &["-o", "whole.csv"]].concat());
    let whole = place.read("whole.csv");
    let resumed = [&sweep[..], &["-o", "rows.csv", "--resume"]].concat();
    let mut kills = 0;
    let mut before = 0;
    let clock = Instant::now();
    loop {
        let mut child = place.command(&resumed).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // Wait for some more rows, then kill; the last time is left alone.
        let length = || fs::metadata(place.path("rows.csv")).map_or(0, |found| found.len());
        while child.try_wait().unwrap().is_none() && length() < before + whole.len() as u64 / 8 {
            std::thread::sleep(Duration::from_millis(1));
        }
        if let Some(status) = child.try_wait().unwrap() {
            assert!(status.success());
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        before = length();
        kills += u32::from(before < whole.len() as u64);
        assert!(clock.elapsed() < Duration::from_secs(300));
    }
    assert!(kills >= 1, "it was never killed in the middle");
    assert_eq!(place.read("rows.csv"), whole);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_failure() {
    let place = Place::of(DROP);
    let said = place.refused(&["--vary", "restitution=0.1:0.9:9", "-o", "/dev/full", "--format", "csv"]);
    assert!(said.contains("cannot write '/dev/full'"), "{said}");
    assert!(!std::path::Path::new("/dev/full.sweep").exists());
    let said = place.refused(&["--vary", "restitution=0.1:0.9:9", "-o", "/dev/full", "--resume"]);
    assert!(said.contains("is no file that can be gone on with"), "{said}");
}

/// A disk that is full after so many rows: what is written are whole rows or a torn one that
/// --resume makes again, and no half picture is left.
#[cfg(unix)]
#[test]
fn a_disk_that_fills_loses_nothing() {
    let place = Place::of(DROP);
    let sweep = "sweep scene.toml --vary restitution=0.1:0.9:900 --plot p.svg -o";
    let arguments = |file: &str, more: &str| -> Vec<String> {
        format!("{sweep} {file} {more}").split_whitespace().skip(2).map(str::to_owned).collect()
    };
    let run = |arguments: &[String]| place.done(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    run(&arguments("whole.csv", ""));
    let (whole, picture) = (place.read("whole.csv"), place.read("p.svg"));
    fs::remove_file(place.path("p.svg")).unwrap();
    // Files of at most 16 KiB, as the system's limit says it.
    let saltus = tool::saltus().get_program().to_owned();
    let limited = format!("trap '' XFSZ; ulimit -f 32; exec {} {sweep} rows.csv", saltus.display());
    let output = Command::new("sh").args(["-c", &limited]).current_dir(place.0.path()).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("make room") && said.contains("--resume goes on behind them"), "{said}");
    assert!(!said.contains("os error") && whole.starts_with(&place.read("rows.csv")), "{said}");
    let mut names: Vec<_> = fs::read_dir(place.0.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["rows.csv", "rows.csv.sweep", "scene.toml", "whole.csv", "whole.csv.sweep"]);
    run(&arguments("rows.csv", "--resume"));
    assert!(place.read("rows.csv") == whole && place.read("p.svg") == picture);
}
