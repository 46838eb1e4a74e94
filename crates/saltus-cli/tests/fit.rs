//! `saltus fit` as a newcomer meets it: the first example of its guide, several films, options
//! without a unit.

use crate::tool;

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::tool::text;
use tempfile::TempDir;

fn saltus(folder: &Path, arguments: &[&str]) -> Output {
    tool::saltus().current_dir(folder).args(arguments).output().unwrap()
}

/// What stands between this fence and the next, for the first time.
fn fenced<'a>(guide: &'a str, fence: &str) -> &'a str {
    guide.split(fence).nth(1).and_then(|rest| rest.split("```").next()).unwrap()
}

/// A film of a ball with a COR of 0.8, dropped from a height in metres.
fn film(drop: f64) -> String {
    let (g, mut text) = (9.81f64, "time_s,height_m\n".to_owned());
    let (mut start, mut speed, mut height) = (0.0, 0.0, drop);
    for n in 0..200 {
        let t = 0.01 * f64::from(n);
        let at = |start: f64, speed: f64, height: f64| height + speed * (t - start) - 0.5 * g * (t - start).powi(2);
        while at(start, speed, height) < 0.0 {
            let arrival = (speed * speed + 2.0 * g * height).sqrt();
            (start, speed, height) = (start + (speed + arrival) / g, 0.8 * arrival, 0.0);
        }
        // Read to a millimetre.
        text += &format!("{t:.2},{:.3}\n", at(start, speed, height));
    }
    text
}

/// Every file by itself: a line for each group, in the order of the files, as a table and as JSON;
/// what cannot be read is a line too.
#[test]
fn files_are_fitted_each_by_itself() {
    let folder = TempDir::new().unwrap();
    let mut names: Vec<String> = (0..20).map(|n| format!("t{n}.csv")).collect();
    for (n, name) in names.iter().enumerate() {
        let e = 0.5 + 0.02 * f64::from(u8::try_from(n).unwrap());
        let rows: String = (0..5).map(|k| format!("{k},{:.3}\n", 100.0 * e.powi(2 * k))).collect();
        fs::write(folder.path().join(name), format!("bounce,height_cm\n{rows}")).unwrap();
    }
    for (name, text) in
        [("two.csv", "ball,drop_cm,rebound_cm\nA,100,55\nA,100,54\nB,100,25\nB,100,26\n"), ("none.csv", "a,b\n1,2\n")]
    {
        fs::write(folder.path().join(name), text).unwrap();
        names.push(name.to_owned());
    }
    let run = |more: &[&str]| {
        let arguments: Vec<&str> =
            ["fit", "--each"].iter().chain(more).copied().chain(names.iter().map(String::as_str)).collect();
        let done = saltus(folder.path(), &arguments);
        assert!(done.status.success(), "{}", text(&done.stderr));
        (text(&done.stdout).lines().map(str::to_owned).collect::<Vec<_>>(), text(&done.stderr).to_owned())
    };
    let (lines, said) = run(&[]);
    assert_eq!(lines.len(), 1 + 20 + 2 + 1, "{lines:?}");
    for (n, line) in lines[1..21].iter().enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        let (e, cor): (f64, f64) = (0.5 + 0.02 * f64::from(u8::try_from(n).unwrap()), cells[2].parse().unwrap());
        assert!(cells[0] == format!("t{n}.csv") && (cor - e).abs() < 2e-3, "{line}");
    }
    assert!(lines[21].starts_with("two.csv,A,0.7") && lines[22].starts_with("two.csv,B,0.5"), "{lines:?}");
    assert!(lines[23].starts_with("none.csv,,,,,,not read,"), "{lines:?}");
    assert!(said.contains("22 tables in ") && said.contains(" a second: ") && said.contains("1 not read"), "{said}");
    let (objects, _) = run(&["--format", "json"]);
    let objects: Vec<serde_json::Value> = objects.iter().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(objects.len(), 22);
    assert!(objects[0]["report"]["cor"]["value"].is_f64() && objects[21]["error"]["kind"].is_string(), "{objects:?}");
}

/// Every trial has its curve and its rungs, and groups have one picture that compares them.
#[test]
fn trials_and_groups_are_all_drawn() {
    let folder = TempDir::new().unwrap();
    let draw = |option: &str, rows: &str| {
        fs::write(folder.path().join("t.csv"), rows).unwrap();
        let drawn = saltus(folder.path(), &["fit", "t.csv", option, "p.svg"]);
        assert!(drawn.status.success(), "{}", text(&drawn.stderr));
        fs::read_to_string(folder.path().join("p.svg")).unwrap()
    };
    let (one, three) = ("drop_cm,rebound_cm\n100,55\n", "drop_cm,rebound_cm\n100,55\n150,82\n200,108\n");
    let several = draw("--plot", three);
    assert!(several.contains("3 trials") && several.contains("Contacts of the model: 6"), "{several}");
    assert!(draw("--plot", one).contains("Contacts of the model: 2"));
    let rungs = draw("--plot-ladder", three);
    assert!(rungs.matches("<path").count() >= draw("--plot-ladder", one).matches("<path").count() + 2, "{rungs}");
    let groups = draw("--plot", "ball,drop_cm,rebound_cm\nA,100,55\nA,100,54\nB,100,25\nB,100,26\n");
    assert!(groups.contains(">A<") && groups.contains(">B<") && groups.contains("95 % interval"), "{groups}");
}

/// A plan before the first drop, as the guide prints it; with a table, for its ball; wrong numbers
/// are refused.
#[test]
fn a_measurement_is_planned() {
    let folder = TempDir::new().unwrap();
    let guide = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/use/fitting.md")).unwrap();
    let planned = saltus(folder.path(), &["fit", "--want", "0.005", "--ball", "tennis"]);
    assert!(planned.status.success() && guide.contains(&text(&planned.stdout)), "{}", text(&planned.stdout));
    let values = ["fit", "--values", "100 64 41 26 cm", "--want", "0.004", "--format", "json", "--sigma-zero", "0"];
    let json: serde_json::Value = serde_json::from_slice(&saltus(folder.path(), &values).stdout).unwrap();
    assert!((json["plan"]["cor"].as_f64().unwrap() - 0.8).abs() < 0.01 && json["plan"]["drop_m"] == 1.0, "{json}");
    for wrong in
        [["--want", "0", "--expect", "0.8"], ["--want", "0.01", "--expect", "1.2"], ["--want", "0.01", "--drop", "2"]]
    {
        let refused = saltus(folder.path(), &[&["fit"], wrong.as_slice()].concat());
        assert!(!refused.status.success() && text(&refused.stderr).contains("give a"), "{}", text(&refused.stderr));
    }
}

/// The first examples of the guide and of the crate's README: table, command, and what is printed.
#[test]
fn the_first_example_of_a_page_is_what_is_printed() {
    for page in ["../../docs/use/fitting.md", "README.md"] {
        let folder = TempDir::new().unwrap();
        let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(page)).unwrap();
        fs::write(folder.path().join("drop.csv"), fenced(&page, "```csv\n")).unwrap();
        let command: Vec<&str> = fenced(&page, "```sh\n").split_whitespace().skip(1).collect();
        let output = saltus(folder.path(), &command);
        assert_eq!(text(&output.stdout), fenced(&page, "```text\n"));
    }
}

#[test]
fn several_films_are_drawn() {
    let folder = TempDir::new().unwrap();
    for (name, drop) in [("low.csv", 0.8), ("high.csv", 1.1)] {
        fs::write(folder.path().join(name), film(drop)).unwrap();
    }
    let output = saltus(folder.path(), &["fit", "low.csv", "high.csv", "--plot", "a.svg", "--plot-cor", "b.svg"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    for (name, part) in [("a.svg", "first of 2 trials: the fitted motion"), ("b.svg", "Speed of impact (m/s)")] {
        let svg = fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(svg.contains("Low and high") && svg.contains(part), "{svg}");
    }
    let one: String = film(0.8).lines().take(75).map(|line| format!("{line}\n")).collect();
    fs::write(folder.path().join("one.csv"), one).unwrap();
    let output = saltus(folder.path(), &["fit", "one.csv", "--plot-cor", "c.svg"]);
    assert!(text(&output.stderr).contains("which takes two bounces; --plot draws one"), "{}", text(&output.stderr));
}

#[test]
fn a_small_length_without_a_unit_is_offered_a_small_one() {
    let folder = TempDir::new().unwrap();
    for (option, such) in [
        ("--ball=4", "'4 cm'"),
        ("--ball=0.04", "'0.04 m'"),
        ("--sigma-height=5", "'5 mm'"),
        ("--sigma-time=10", "'10 ms'"),
    ] {
        let output = saltus(folder.path(), &["fit", "drop.csv", option]);
        assert!(text(&output.stderr).contains(&format!("such as {such}")), "{}", text(&output.stderr));
    }
}

#[test]
fn help_on_help_and_no_line_broken_twice() {
    let folder = TempDir::new().unwrap();
    assert_eq!(saltus(folder.path(), &["help", "--help"]).stdout, saltus(folder.path(), &["help"]).stdout);
    assert_eq!(saltus(folder.path(), &["help", "fit", "-h"]).stdout, saltus(folder.path(), &["help", "fit"]).stdout);
    assert!(saltus(folder.path(), &["help", "--help"]).status.success());
    // A command has a line in the list of all, and says the same of itself.
    let said = |args: &[&str]| {
        let text = String::from_utf8(saltus(folder.path(), args).stdout).unwrap();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let list = said(&["--help"]);
    for command in ["fit", "simulate", "explain", "accuracy", "export", "library", "check", "solve", "sweep"] {
        let own = said(&[command, "-h"]);
        let first = own.split(" Usage:").next().unwrap();
        assert!(list.contains(&format!(" {command} {first}")), "{command}: {first}");
    }
}

/// The reader of old workbooks may panic; nobody hears of it.
#[test]
fn a_broken_workbook_is_one_error() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("broken.xls"), [&b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"[..], &[7; 4000]].concat())
        .unwrap();
    let said = text(&saltus(folder.path(), &["fit", "broken.xls"]).stderr);
    assert!(
        said.starts_with("error: broken.xls: this workbook cannot be read") && !said.contains("panicked"),
        "{said}"
    );
}

#[test]
fn groups_are_chosen_by_their_columns() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("balls.csv"), "drop (cm),wilson (cm),penn (cm)\n100,55,53\n100,56,54\n").unwrap();
    let doubted = text(&saltus(folder.path(), &["fit", "balls.csv"]).stdout);
    assert!(doubted.starts_with("balls.csv: DOUBTFUL") && doubted.contains("'wilson'"), "{doubted}");
    let output = saltus(folder.path(), &["fit", "balls.csv", "--group", "wilson (cm),penn (cm)"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("wilson") && text(&output.stdout).contains("penn"));
}

#[test]
fn numbers_on_the_line_are_a_table() {
    let folder = TempDir::new().unwrap();
    let output = saltus(folder.path(), &["fit", "--values", "100 64 41 26 cm", "--gravity", "9.8"]);
    let said = text(&output.stdout);
    assert!(
        said.starts_with("values: TRUSTED") && said.contains("COR  0.800") && said.contains("g = 9.8 m/s² (stated)"),
        "{said}"
    );
    let none = saltus(folder.path(), &["fit", "--values", "100 64 41"]);
    assert!(none.status.code() == Some(2) && text(&none.stderr).contains("ends in no unit"), "{}", text(&none.stderr));
}

#[test]
fn errors_are_data_where_the_report_is() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("drop.csv"), "bounce,height_cm\n0,100\n1,thirty\n").unwrap();
    for (arguments, kind, line, advice) in [
        (&["drop.csv"][..], "fault", Some(3), true),
        (&["none.csv"], "fault", None, false),
        (&["--values", "100 64 41"], "command", None, false),
    ] {
        let output = saltus(folder.path(), &[&["fit", "--format", "json"], arguments].concat());
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let error = &json["error"];
        assert!(error["kind"] == kind && error["line"].as_u64() == line && output.status.code() == Some(2), "{json}");
        assert!(error["message"].is_string() && !advice || error["advice"].is_string(), "{json}");
        assert!(!text(&output.stderr).contains("error:"), "{}", text(&output.stderr));
    }
}
