//! The house: arrows between the files of a crate go one way, files are short, and so are the lines
//! of comments.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A module of a crate: the names that lead to it from the root, which is empty.
type Module = Vec<String>;

/// The modules of a crate, each with its text: without comments and without what stands at the end
/// of a file, its tests.
fn modules(source: &Path) -> BTreeMap<Module, String> {
    let mut found = Vec::new();
    files(source, &mut found);
    let module = |path: &Path| {
        let names = path.strip_prefix(source).unwrap().with_extension("");
        let names = names.iter().map(|name| name.to_str().unwrap().to_owned());
        names.filter(|name| !["mod", "lib", "main"].contains(&name.as_str())).collect()
    };
    let text = |path: &Path| {
        let text = fs::read_to_string(path).unwrap();
        let code = text.split("#[cfg(test)]\nmod ").next().unwrap();
        code.lines().map(|line| line.split("//").next().unwrap()).collect::<Vec<_>>().join("\n")
    };
    found.iter().map(|path| (module(path), text(path))).collect()
}

/// The paths in a tree of imports, such as `a::{b, c::{d, e}}`.
fn paths(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((start, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap().trim().to_owned()];
    };
    let inner = rest.trim_end().strip_suffix('}').unwrap_or_default();
    let (mut parts, mut deep) = (vec![String::new()], 0);
    for letter in inner.chars() {
        deep += i32::from(letter == '{') - i32::from(letter == '}');
        match letter {
            ',' if deep == 0 => parts.push(String::new()),
            letter => parts.last_mut().unwrap().push(letter),
        }
    }
    let whole = |part: &String| paths(part).into_iter().map(|path| format!("{start}{path}")).collect::<Vec<_>>();
    parts.iter().filter(|part| !part.trim().is_empty()).flat_map(whole).collect()
}

/// What a module imports, and which of it only to hand it on; and its other code.
fn imports(text: &str) -> (Vec<(String, bool)>, String) {
    let (mut found, mut code) = (Vec::new(), String::new());
    for statement in text.split_inclusive(';') {
        let alone =
            |before: &str| before.is_empty() || before == "pub" || before.starts_with("pub(") && before.ends_with(')');
        let line = |at: usize| statement[..at].rsplit('\n').next().unwrap_or_default();
        let head = statement.rfind("use ").filter(|&at| alone(line(at).trim()));
        let Some(at) = head else {
            code.push_str(statement);
            continue;
        };
        code.push_str(&statement[..at]);
        let handed = !line(at).trim().is_empty();
        let tree = statement[at + 4..].trim_end_matches(';');
        found.extend(paths(tree).into_iter().map(|path| (path, handed)));
    }
    (found, code)
}

/// Paths in code that start at the root, at a parent or at the module itself.
fn named(code: &str) -> Vec<String> {
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = Vec::new();
    for start in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(start) {
            if !code[..at].ends_with(|c| letter(c) || c == ':') {
                let end = code[at..].find(|c| !letter(c) && c != ':').map_or(code.len(), |length| at + length);
                found.push(code[at..end].trim_end_matches(':').to_owned());
            }
        }
    }
    found
}

/// A path from the root of the crate, if it leads into the crate.
fn absolute(from: &Module, path: &str, modules: &BTreeMap<Module, String>) -> Option<Module> {
    let mut names: Vec<String> = path.split("::").map(|name| name.trim().to_owned()).collect();
    let mut place = from.clone();
    match names[0].as_str() {
        "crate" => place.clear(),
        "self" => {}
        "super" => {
            while names[0] == "super" {
                place.pop();
                if names.len() == 1 {
                    return Some(place);
                }
                names.remove(0);
            }
            place.extend(names);
            return Some(place);
        }
        first => {
            place.push(first.to_owned());
            modules.contains_key(&place).then_some(())?;
        }
    }
    place.extend(names.into_iter().skip(1));
    Some(place)
}

/// Where the item at a path is defined: modules hand on what they import.
fn home(path: &Module, modules: &BTreeMap<Module, String>, handed: &BTreeMap<(Module, String), Module>) -> Module {
    let mut path = path.clone();
    for _ in 0..8 {
        let depth = (0..=path.len()).rev().find(|&depth| modules.contains_key(&path[..depth])).unwrap_or(0);
        let place = path[..depth].to_vec();
        let on = path.get(depth).and_then(|name| handed.get(&(place.clone(), name.clone())));
        match on {
            Some(on) if *on != path[..=depth] => path = on.iter().chain(&path[depth + 1..]).cloned().collect(),
            _ => return place,
        }
    }
    path
}

/// By folder which of its files and folders name which others; the root's own items are `lib`.
fn arrows(source: &Path) -> BTreeMap<String, BTreeMap<String, BTreeSet<String>>> {
    let modules = modules(source);
    let read: BTreeMap<_, _> = modules.iter().map(|(module, text)| (module.clone(), imports(text))).collect();
    let mut handed = BTreeMap::new();
    for (module, (imported, _)) in &read {
        for (path, _) in imported {
            if let Some(to) = absolute(module, path, &modules) {
                handed.insert((module.clone(), to.last().cloned().unwrap_or_default()), to);
            }
        }
    }
    let mut arrows: BTreeMap<String, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (from, (imported, code)) in &read {
        let own = imported.iter().filter(|(_, handed)| !handed).map(|(path, _)| path.clone());
        for path in own.chain(named(code)) {
            let Some(to) = absolute(from, &path, &modules).map(|to| home(&to, &modules, &handed)) else { continue };
            let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
            let root = |module: &Module| if module.is_empty() { vec!["lib".to_owned()] } else { module.clone() };
            let (from, to) = (root(from), root(&to));
            if let (Some(a), Some(b)) = (from.get(shared), to.get(shared)) {
                let folder = arrows.entry(from[..shared].join("/")).or_default();
                folder.entry(a.clone()).or_default().insert(b.clone());
                folder.entry(b.clone()).or_default();
            }
        }
    }
    arrows
}

#[test]
fn no_ring_of_imports() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("crates");
    let mut rings = Vec::new();
    for entry in fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_name().unwrap().to_str().unwrap();
        for (folder, mut arrows) in arrows(&entry.join("src")) {
            // What names nothing that is left is below everything that is left.
            while let Some(lowest) = arrows.iter().find(|(_, below)| below.is_empty()).map(|(name, _)| name.clone()) {
                arrows.remove(&lowest);
                for below in arrows.values_mut() {
                    below.remove(&lowest);
                }
            }
            if !arrows.is_empty() {
                rings.push(format!("{name}/{folder} has a ring of imports among {arrows:?}"));
            }
        }
    }
    assert!(rings.is_empty(), "{}", rings.join("\n"));
}

/// The law finds a ring through a list of imports, through what the root hands on, and through a
/// parent.
#[test]
fn a_ring_is_found_however_it_is_named() {
    let folder = std::env::temp_dir().join(format!("rings-{}", std::process::id()));
    for (low, high, ring) in [
        ("use crate::{c::C, high::High};", "use super::low::Low;", true),
        ("use crate::High;", "fn f() -> crate::low::Low {}", true),
        ("use super::High as Other;", "pub(crate) use crate::low::Low; fn f(low: super::Low) {}", true),
        ("// crate::high\nuse std::High;", "use crate::Low;", false),
        ("", "use crate::Low; #[cfg(test)]\nmod tests { use crate::high; }", false),
    ] {
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("lib.rs"), "mod low; mod high;\npub use low::Low;\npub use high::High;").unwrap();
        fs::write(folder.join("low.rs"), low).unwrap();
        fs::write(folder.join("high.rs"), high).unwrap();
        let arrows = &arrows(&folder)[""];
        let to = |from: &str, to: &str| arrows[from].contains(to);
        assert!(to("high", "low"), "{low} {high}: {arrows:?}");
        assert_eq!(to("low", "high"), ring, "{low} {high}: {arrows:?}");
    }
    fs::remove_dir_all(&folder).unwrap();
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
/// may be wider. Numbers are computed, stated or read: comments on sources name which.
#[test]
fn files_and_comments_are_short_and_name_what_is_computed() {
    const LINES: usize = 500;
    const COLUMNS: usize = 100;
    const OF_PEOPLE: [&str; 3] = ["told", "said", "seen"];
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for folder in ["crates", "examples", "tests"] {
        files(&root.join(folder), &mut found);
    }
    assert!(found.len() > 300);
    let mut wrong = Vec::new();
    for path in found {
        let text = fs::read_to_string(&path).unwrap();
        let source = path.components().any(|part| part.as_os_str() == "src");
        if text.lines().count() > LINES && source {
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
            let of_people = |word: &str| OF_PEOPLE.contains(&word.trim_matches(|c: char| !c.is_alphabetic()));
            if source && !listing && words.split_whitespace().any(of_people) {
                wrong.push(format!("{}:{}: a verb of people: {line}", path.display(), number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
