//! docs/fitting-inside.md lists every finding, and the constants that decide with the values that
//! they have.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn page() -> String {
    fs::read_to_string(root().join("../../../docs/fitting-inside.md")).unwrap()
}

/// The files whose constants decide what is found.
fn files() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        ["statistics.rs", "model/physics.rs", "model/altered.rs", "solve/outliers.rs", "solve/choice.rs"]
            .map(|file| root().join(file))
            .to_vec();
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
            let Some((name, rest)) =
                line.trim_start_matches("pub(crate) ").strip_prefix("const ").and_then(|l| l.split_once(": "))
            else {
                continue;
            };
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

#[test]
fn every_finding_is_listed() {
    let page = page();
    let findings = page.split_once("## Findings").unwrap().1.split_once("## Constants").unwrap().0;
    let listed: Vec<&str> = findings
        .lines()
        .filter_map(|line| line.strip_prefix("| ")?.split(" | ").next())
        .flat_map(|names| names.split(", "))
        .collect();
    let source = fs::read_to_string(root().join("finding/kind.rs")).unwrap();
    let body = source.split_once("pub enum FindingKind {").unwrap().1;
    let kinds = body.lines().filter_map(|line| line.strip_prefix("    ")?.split([' ', ',', '{']).next());
    let kinds: Vec<&str> = kinds.filter(|word| word.starts_with(|c: char| c.is_ascii_uppercase())).collect();
    assert!(kinds.len() > 60, "{kinds:?}");
    for kind in kinds {
        let kebab: String = kind
            .char_indices()
            .flat_map(|(n, c)| (n > 0 && c.is_uppercase()).then_some('-').into_iter().chain(c.to_lowercase()))
            .collect();
        assert!(listed.contains(&kebab.as_str()), "{kebab} is not listed");
    }
}
