//! `docs/thresholds.md`: every number that decides between a step and a jump, as the sources have it.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Where the engine decides.
const SOURCES: [&str; 4] = ["certainty.rs", "cross", "advance", "zeno.rs"];

const HEAD: &str = "# Thresholds

The named numbers by which the engine decides whether, where and how a guard falls, what a step may
be, and when jumps accumulate: the value of each and what it is for. For whoever changes the engine. The table
is written from the sources by `SALTUS_BLESS=1 cargo test -p saltus-tests --test thresholds`, and the
same test holds it to them.

The first four are one scale of certainty, in multiples of a value's noise: what one rounding of each
number that it is made from changes it by. A comparison of a guard, a slope, a time or a duration
with its noise is to use one of them; time.rs keeps a 4 of its own, whose derivation is its own.

";

const LIMITS: &str = "
## Limits

The table says what a number is for, not that its value could not be another: most could be several
times larger or smaller, and no test would tell. Lists of places to look at, numbers without a name
and the coefficients of steppers are not listed.
";

struct Constant {
    name: String,
    file: String,
    value: String,
    what: String,
}

fn files(path: &Path, found: &mut Vec<PathBuf>) {
    if path.is_file() {
        found.push(path.to_owned());
        return;
    }
    let mut entries: Vec<_> = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    entries.iter().for_each(|entry| files(entry, found));
}

/// The first sentence of a comment.
fn sentence(comment: &[&str]) -> String {
    let text = comment.join(" ").replace('|', "\\|");
    text.split_once(". ").map_or(text.clone(), |(first, _)| format!("{first}."))
}

/// The single numbers among the constants of a source.
fn constants(source: &str, file: &str) -> Vec<Constant> {
    let mut comment: Vec<&str> = Vec::new();
    let mut found = Vec::new();
    for line in source.lines().map(str::trim).take_while(|line| *line != "mod tests {") {
        if let Some(words) = line.strip_prefix("///") {
            comment.push(words.trim());
            continue;
        }
        let after = line.strip_prefix("const ").or_else(|| line.split_once(" const ").map(|(_, after)| after));
        let number = |kind: &&str| matches!(*kind, "f64" | "usize" | "u64" | "u32");
        if let Some((name, rest)) = after.and_then(|after| after.split_once(": "))
            && let Some((kind, value)) = rest.split_once(" = ")
            && number(&kind)
        {
            assert!(!comment.is_empty(), "{file}: {name} has no comment");
            let (name, value, file) = (name.to_owned(), value.trim_end_matches(';').to_owned(), file.to_owned());
            found.push(Constant { name, file, value, what: sentence(&comment) });
        }
        comment.clear();
    }
    found
}

#[test]
fn the_page_lists_every_threshold() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let source = root.join("crates/saltus/src");
    let mut paths = Vec::new();
    SOURCES.iter().for_each(|name| files(&source.join(name), &mut paths));
    let all: Vec<Constant> = paths
        .iter()
        .flat_map(|path| {
            let file = path.strip_prefix(&source).unwrap().display().to_string();
            constants(&fs::read_to_string(path).unwrap(), &file)
        })
        .collect();
    assert!(all.len() > 20 && all[0].name == "FEW");
    let mut page = HEAD.to_owned();
    page.push_str("| constant | value | what it is for | file |\n|---|---|---|---|\n");
    for Constant { name, file, value, what } in &all {
        writeln!(page, "| `{name}` | `{value}` | {what} | `{file}` |").unwrap();
    }
    page.push_str(LIMITS);
    let path = root.join("docs/thresholds.md");
    if std::env::var_os("SALTUS_BLESS").is_some() {
        fs::write(&path, page).unwrap();
        return;
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    for (kept, new) in kept.lines().zip(page.lines()) {
        assert_eq!(kept, new, "docs/thresholds.md differs: SALTUS_BLESS=1 rewrites it");
    }
    assert_eq!(kept.len(), page.len(), "docs/thresholds.md differs: SALTUS_BLESS=1 rewrites it");
}
