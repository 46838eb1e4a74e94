//! Arrows between the files of a crate go one way: no ring of imports.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The crates that are held to it, module by module of their root.
const CRATES: [&str; 5] = ["saltus", "saltus-scene", "saltus-fit", "saltus-motion", "saltus-cli"];

/// The text of a module: its file, or all files of its folder.
fn text(path: &Path) -> String {
    if path.is_file() {
        return fs::read_to_string(path).unwrap();
    }
    fs::read_dir(path).unwrap().map(|entry| text(&entry.unwrap().path())).collect()
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
