//! The house: arrows between the files of a crate go one way, files are short, and so are the lines
//! of comments.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The crates that are held to it, module by module of their root.
const CRATES: [&str; 5] = ["saltus", "saltus-scene", "saltus-fit", "saltus-motion", "saltus-cli"];

/// The text of a module: its file, or all files of its folder.
fn text(path: &Path) -> String {
    let mut found = Vec::new();
    if path.is_file() {
        found.push(path.to_owned());
    } else {
        files(path, &mut found);
    }
    found.iter().map(|file| fs::read_to_string(file).unwrap()).collect()
}

/// Which modules of the root each module names.
fn arrows(source: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let modules: BTreeMap<String, String> = fs::read_dir(source)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), text(&path)))
        .filter(|(name, _)| name != "main" && name != "lib")
        .collect();
    let named = |text: &str, from: &str| {
        let other = |name: &&String| **name != from && text.contains(&format!("crate::{name}"));
        modules.keys().filter(other).cloned().collect()
    };
    modules.iter().map(|(name, text)| (name.clone(), named(text, name))).collect()
}

#[test]
fn no_ring_of_imports() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("crates");
    for name in CRATES {
        let mut arrows = arrows(&crates.join(name).join("src"));
        assert!(arrows.len() > 5, "{name}: {arrows:?}");
        // What names nothing that is left is below everything that is left.
        while let Some(lowest) = arrows.iter().find(|(_, below)| below.is_empty()).map(|(name, _)| name.clone()) {
            arrows.remove(&lowest);
            for below in arrows.values_mut() {
                below.remove(&lowest);
            }
        }
        assert!(arrows.is_empty(), "{name} has a ring of imports among {arrows:?}");
    }
}

/// All files of Rust in the folders of the project.
fn files(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// A file is read at a sitting, and a comment without turning one's head: listings and tables in it
/// may be wider.
#[test]
fn files_and_comments_are_short() {
    const LINES: usize = 500;
    const COLUMNS: usize = 100;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for folder in ["crates", "examples", "tests"] {
        files(&root.join(folder), &mut found);
    }
    assert!(found.len() > 300);
    let mut wrong = Vec::new();
    for path in found {
        let text = fs::read_to_string(&path).unwrap();
        if text.lines().count() > LINES && path.components().any(|part| part.as_os_str() == "src") {
            wrong.push(format!("{}: {} lines", path.display(), text.lines().count()));
        }
        let mut listing = false;
        for (number, line) in text.lines().enumerate() {
            let comment = line.trim_start();
            let Some(words) = comment.strip_prefix("//").map(|rest| rest.trim_start_matches(['/', '!']).trim_start())
            else {
                listing = false;
                continue;
            };
            listing ^= words.starts_with("```");
            let one = words.split_whitespace().count() == 1;
            if line.chars().count() > COLUMNS && !listing && !one && !words.starts_with(['|', '`']) {
                wrong.push(format!("{}:{}: {line}", path.display(), number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
