//! The stages are folders whose arrows point downwards only, and no files import each other in a
//! ring.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// From what everything rests on to what rests on everything. A file uses its own stage and those
/// before it.
const STAGES: [&[&str]; 11] = [
    &["elementary", "word", "statistics", "error", "quantity", "orientation", "finding"],
    &["sound"],
    &["read"],
    &["evidence"],
    &["model"],
    &["solve"],
    &["compare"],
    &["verdict"],
    &["report"],
    &["fit"],
    &["plan", "lib"],
];

fn stage(module: &str) -> usize {
    let place = STAGES.iter().position(|stage| stage.contains(&module));
    place.unwrap_or_else(|| panic!("the module {module} belongs to no stage"))
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The module path of a file, such as `solve::series::track`.
fn module(root: &Path, file: &Path) -> Vec<String> {
    let relative = file.strip_prefix(root).unwrap().with_extension("");
    let mut parts: Vec<String> = relative.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    parts
}

/// The paths that a file's `use` items name, each from `crate` or `super` on, braces taken apart.
fn imports(text: &str) -> Vec<Vec<String>> {
    let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    // Unit tests look at what they test.
    let code = code.split("#[cfg(test)]").next().unwrap_or("").to_owned();
    let mut found = Vec::new();
    // Paths in the code itself.
    for (at, _) in ["crate::", "super::"].iter().flat_map(|word| code.match_indices(word)) {
        let name = |c: char| c.is_alphanumeric() || c == '_';
        if !code[..at].ends_with(|c| name(c) || c == ':') && !code[..at].ends_with("pub(in ") {
            let rest = &code[at..];
            let path = &rest[..rest.find(|c| !name(c) && c != ':').unwrap_or(rest.len())];
            found.push(path.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect());
        }
    }
    for start in ["use ", "pub use ", "pub(crate) use ", "pub(super) use "] {
        for (at, _) in code.match_indices(&format!("\n{start}")) {
            let rest = &code[at + 1 + start.len()..];
            let item = rest[..rest.find(';').unwrap_or(0)].replace(" as ", "@").replace(['\n', ' '], "");
            expand(&item, &mut Vec::new(), &mut found);
        }
    }
    found
}

fn expand(item: &str, before: &mut Vec<String>, found: &mut Vec<Vec<String>>) {
    let (head, rest) = item.split_once("::").unwrap_or((item, ""));
    if let Some(inside) = item.strip_prefix('{') {
        let (mut depth, mut from) = (0, 0);
        let inside = &inside[..inside.len() - 1];
        for (at, c) in inside.char_indices().chain([(inside.len(), ',')]) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    if at > from {
                        expand(&inside[from..at], &mut before.clone(), found);
                    }
                    from = at + 1;
                }
                _ => {}
            }
        }
        return;
    }
    before.push(head.split('@').next().unwrap_or(head).to_owned());
    if rest.is_empty() { found.push(before.clone()) } else { expand(rest, before, found) }
}

/// The longest known module that a path names, seen from a module.
fn target(path: &[String], from: &[String], is_folder: bool, known: &BTreeSet<Vec<String>>) -> Option<Vec<String>> {
    let mut at: Vec<String> = match path[0].as_str() {
        "crate" => Vec::new(),
        "super" => from[..from.len().saturating_sub(1)].to_vec(),
        "self" => from.to_vec(),
        _ if is_folder => from.to_vec(),
        _ => return None,
    };
    let mut rest = if ["crate", "super", "self"].contains(&path[0].as_str()) { &path[1..] } else { path };
    while rest.first().is_some_and(|part| part == "super") {
        at.pop();
        rest = &rest[1..];
    }
    let mut longest = (!at.is_empty()).then(|| at.clone());
    for part in rest {
        at.push(part.clone());
        if !known.contains(&at) {
            break;
        }
        longest = Some(at.clone());
    }
    longest.filter(|found| known.contains(found))
}

#[test]
fn arrows_point_downwards_and_close_no_ring() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    files.retain(|file| !file.ends_with("tests.rs"));
    let known: BTreeSet<Vec<String>> = files.iter().map(|file| module(&root, file)).collect();
    let folders: BTreeSet<Vec<String>> =
        known.iter().filter(|m| known.iter().any(|n| n.len() > m.len() && n.starts_with(m))).cloned().collect();
    let mut arrows: BTreeMap<Vec<String>, BTreeSet<Vec<String>>> = BTreeMap::new();
    let mut upwards = Vec::new();
    for file in &files {
        let from = module(&root, file);
        for path in imports(&fs::read_to_string(file).unwrap()) {
            let Some(to) = target(&path, &from, folders.contains(&from), &known).filter(|to| *to != from) else {
                continue;
            };
            if stage(&to[0]) > stage(&from[0]) {
                upwards.push(format!("{} uses {}", from.join("::"), to.join("::")));
            }
            arrows.entry(from.clone()).or_default().insert(to);
        }
    }
    assert!(arrows.values().map(BTreeSet::len).sum::<usize>() > 150, "the imports were not found");
    assert!(upwards.is_empty(), "{upwards:#?}");
    // The reader's files are arranged by themselves.
    arrows.retain(|from, _| !["read"].contains(&from[0].as_str()));
    // What nothing left uses, or uses nothing left, is in no ring.
    loop {
        let before = arrows.len();
        let left: BTreeSet<Vec<String>> = arrows.keys().cloned().collect();
        arrows.values_mut().for_each(|to| to.retain(|to| left.contains(to)));
        let used: BTreeSet<Vec<String>> = arrows.values().flatten().cloned().collect();
        arrows.retain(|from, to| !to.is_empty() && used.contains(from));
        if arrows.len() == before {
            break;
        }
    }
    let ring: Vec<String> = arrows.iter().map(|(from, to)| format!("{} -> {to:?}", from.join("::"))).collect();
    assert!(ring.is_empty(), "{ring:#?}");
}
