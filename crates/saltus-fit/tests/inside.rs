//! docs/change/fitting-inside.md lists every finding, and the constants that decide with the values
//! that they have.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn page() -> String {
    fs::read_to_string(root().join("../../../docs/change/fitting-inside.md")).unwrap()
}

/// The files whose constants decide what is found.
fn files() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = [
        "statistics.rs",
        "quantity.rs",
        "model/physics.rs",
        "model/altered.rs",
        "solve/outliers.rs",
        "solve/choice.rs",
    ]
    .into_iter()
    .chain([
        "read/alarms.rs",
        "read/said.rs",
        "read/words.rs",
        "read/forms.rs",
        "read/forms/values.rs",
        "read/order.rs",
        "read/vocabulary.rs",
        "read/lasting.rs",
        "read/layout.rs",
        "read/limits.rs",
        "read/check.rs",
        "read/computed.rs",
        "read/strange.rs",
        "read/grid/grouped.rs",
        "read/grid/sections.rs",
        "read/columns/conditions.rs",
        "read/columns/coordinates.rs",
        "read/columns/gates.rs",
        "read/columns/signals.rs",
        "read/columns/specimens.rs",
        "read/samples.rs",
        "read/sensed/clock.rs",
        "read/sensed/events.rs",
        "read/sensed/felt.rs",
        "read/sensed/speeds.rs",
        "read/stamps.rs",
        "read/sequence.rs",
        "read/heading/inside.rs",
        "read/phrases.rs",
        "read/programs.rs",
        "read/programs/bare.rs",
        "read/region/keys.rs",
        "read/title.rs",
        "sound/ears.rs",
        "sound/fade.rs",
        "sound/onset.rs",
        "sound/chain.rs",
        "sound/pulse.rs",
    ])
    .map(|file| root().join(file))
    .collect();
    for folder in ["evidence", "compare", "verdict"] {
        found.extend(fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path()));
    }
    found
}

#[test]
fn every_constant_that_decides_is_listed() {
    let page = page();
    let mut count = 0;
    for file in files() {
        let source = fs::read_to_string(&file).unwrap();
        let of = file.strip_prefix(root()).unwrap().with_extension("");
        for line in source.lines() {
            let Some((name, rest)) = line
                .trim_start_matches("pub(crate) ")
                .trim_start_matches("pub(super) ")
                .strip_prefix("const ")
                .and_then(|l| l.split_once(": "))
            else {
                continue;
            };
            // Words are no numbers.
            if rest.starts_with("&str") || rest.starts_with("[&str") || rest.starts_with("[(&str") {
                continue;
            }
            let value = rest.split_once(" = ").expect("a value").1.trim_end_matches(';');
            let value = value.replace("std::f64::consts::SQRT_2", "√2");
            let row = format!("| {} | `{name}` | {value} | ", of.display());
            let listed = page.lines().find(|line| line.starts_with(&row));
            assert!(listed.is_some_and(|line| line.len() > row.len() + 10), "{row} is not listed, or without a reason");
            count += 1;
        }
    }
    assert_eq!(
        page.lines().filter(|line| line.split(" | ").nth(1).is_some_and(|name| name.starts_with('`'))).count(),
        count
    );
}

/// The names of the functions in the sources below a folder.
fn functions(folder: &Path, found: &mut Vec<String>) {
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            functions(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let source = fs::read_to_string(&path).unwrap();
            let name = |line: &str| Some(line.trim().strip_prefix("fn ")?.split_once('(')?.0.to_owned());
            found.extend(source.lines().filter_map(name));
        }
    }
}

/// Every constant names a test that fails without it.
#[test]
fn every_constant_names_a_test_that_is_there() {
    let mut tests = Vec::new();
    ["src", "tests"].iter().for_each(|folder| functions(&root().join("..").join(folder), &mut tests));
    let page = page();
    let constants = page.split_once("## Constants").unwrap().1;
    for row in constants.lines().filter(|line| line.split(" | ").nth(1).is_some_and(|name| name.starts_with('`'))) {
        let test = row.trim_end_matches(" |").rsplit(" | ").next().unwrap().trim_matches('`');
        assert!(tests.iter().any(|name| name == test), "{row} names no test");
    }
}

/// The variants of an enumeration, as JSON has them.
fn kinds(file: &str, name: &str) -> Vec<String> {
    let source = fs::read_to_string(root().join(file)).unwrap();
    let body = source.split_once(&format!("pub enum {name} {{")).unwrap().1.split_once("\n}").unwrap().0;
    let first = body.lines().filter_map(|line| line.strip_prefix("    ")?.split([' ', ',', '{']).next());
    let kebab = |kind: &str| {
        let spelt = kind.char_indices();
        spelt
            .flat_map(|(n, c)| (n > 0 && c.is_uppercase()).then_some('-').into_iter().chain(c.to_lowercase()))
            .collect()
    };
    first.filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase())).map(kebab).collect()
}

/// The kinds in a column of the tables of a section.
fn listed(section: &str, column: usize) -> Vec<&str> {
    let rows =
        section.lines().filter_map(|line| line.strip_prefix("| ")?.trim_end_matches(" |").split(" | ").nth(column));
    rows.flat_map(|names| names.split(", ")).collect()
}

#[test]
fn every_finding_is_listed() {
    let page = page();
    let section = page.split_once("## Findings").unwrap().1.split_once("## Constants").unwrap().0;
    let (findings, remarks) = section.split_once("### Remarks").unwrap();
    let found = kinds("finding/kind.rs", "FindingKind");
    assert!(found.len() > 60, "{found:?}");
    for kind in found {
        assert!(listed(findings, 0).contains(&kind.as_str()), "{kind} is not listed");
    }
    for name in ["Note", "Repair", "Warning"] {
        for kind in kinds("finding/remark.rs", name) {
            assert!(listed(remarks, 1).contains(&kind.as_str()), "{kind} is not listed");
        }
    }
}
