//! Every number that decides between a step and a jump, as the sources have it: the thresholds
//! themselves in `docs/trust/numerics.md`, the counts and steps beside them in
//! `docs/trust/thresholds.md`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Where the engine decides.
const SOURCES: [&str; 4] = ["certainty.rs", "cross", "advance", "zeno.rs"];

const HEAD: &str = "# Counts and steps

The named numbers beside the twelve [thresholds](numerics.md#certainty-and-nearness) by which the
engine decides how often something is looked at, what a step may be, and when jumps accumulate. For
whoever changes the engine. The page is written from the sources by `SALTUS_BLESS=1 cargo test -p
saltus-tests thresholds::`, and the same test holds it to them.
";

/// Where the twelve stand on their page.
const BEGIN: &str = "<!-- written by the test thresholds: begin -->\n";
const END: &str = "<!-- end -->\n";

/// What a threshold decides, and the most that there may be of a kind, where that is limited.
struct Kind {
    title: &'static str,
    text: &'static str,
    most: usize,
    holds: fn(&Constant) -> bool,
}

const KINDS: [Kind; 3] = [
    Kind {
        title: "Between a step and a jump",
        text: "",
        most: 12,
        holds: |it| !it.is_count() && !it.is_of_steps() && it.file != "advance/closed.rs" && !it.is_derived(),
    },
    Kind {
        title: "Counts",
        text: "How often something is done at most, or looked at. More would cost time, fewer would leave more\ndoubts.\n\n",
        most: usize::MAX,
        holds: Constant::is_count,
    },
    Kind {
        title: "Steps, methods, and what is derived",
        text: "How long steps and pieces are, when the method changes, numbers of published methods and formats,\nand what is made of the thresholds above.\n\n",
        most: usize::MAX,
        holds: |_| true,
    },
];

const LIMITS: &str = "
## Limits

The tables say what a number is for, not that its value could not be another: most could be several
times larger or smaller, and no test would tell. Lists of places to look at, halves and doubles in
formulas and the coefficients of steppers are not listed.
";

struct Constant {
    name: String,
    file: String,
    kind: String,
    value: String,
    what: String,
    /// The test that fails if it is ten times larger or smaller.
    held_by: String,
}

impl Constant {
    fn is_count(&self) -> bool {
        self.kind != "f64"
    }

    /// Whether it decides on the size of a step or of the method, or belongs to one.
    fn is_of_steps(&self) -> bool {
        ["advance/series.rs", "advance/stiff.rs", "advance/stepped.rs"].contains(&&*self.file)
            || self.name == "TRUNCATION"
    }

    /// Whether it is made of others alone, or a power of two that scales numbers without rounding.
    fn is_derived(&self) -> bool {
        self.file != "certainty.rs" && (self.value.contains(" * ") || self.value.contains("<<"))
    }
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

/// The first sentence of a comment, and the test that it names after "Held by".
fn sentence(comment: &[&str]) -> [String; 2] {
    let text = comment.join(" ").replace('|', "\\|");
    let first = text.split_once(". ").map_or(text.clone(), |(first, _)| format!("{first}."));
    let held_by = text.split_once("Held by ").map_or("", |(_, test)| test.trim_end_matches('.'));
    [first, held_by.to_owned()]
}

/// The names of tests in the sources below a folder.
fn names_of_tests(path: &Path) -> Vec<String> {
    let mut paths = Vec::new();
    files(path, &mut paths);
    let sources = paths.iter().filter(|path| path.extension().is_some_and(|end| end == "rs"));
    let names = |path: &PathBuf| {
        let source = fs::read_to_string(path).unwrap();
        let of = |line: &str| Some(line.trim().strip_prefix("fn ")?.split_once('(')?.0.to_owned());
        source.lines().filter_map(of).collect::<Vec<_>>()
    };
    sources.flat_map(names).collect()
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
            let [name, kind, file] = [name, kind, file].map(str::to_owned);
            let value = value.trim_end_matches(';').to_owned();
            let [what, held_by] = sentence(&comment);
            found.push(Constant { name, file, kind, value, what, held_by });
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
    let mut all: Vec<Constant> = paths
        .iter()
        .flat_map(|path| {
            let file = path.strip_prefix(&source).unwrap().display().to_string();
            constants(&fs::read_to_string(path).unwrap(), &file)
        })
        .collect();
    assert!(all.len() > 20 && all[0].name == "FEW");
    let tests: Vec<_> =
        ["tests", "crates/saltus"].iter().flat_map(|folder| names_of_tests(&root.join(folder))).collect();
    let (mut twelve, mut page) = (String::new(), HEAD.to_owned());
    for Kind { title, text, most, holds } in KINDS {
        let (of, rest): (Vec<_>, Vec<_>) = all.into_iter().partition(holds);
        all = rest;
        assert!(of.len() <= most, "{title}: {}, and {most} at most", of.len());
        let held = most < usize::MAX;
        if held {
            twelve.push_str("| constant | value | what it is for | file | held by |\n|---|---|---|---|---|\n");
        } else {
            let columns = "| constant | value | what it is for | file |\n|---|---|---|---|";
            writeln!(page, "\n## {title}\n\n{text}{columns}").unwrap();
        }
        let page = if held { &mut twelve } else { &mut page };
        for Constant { name, file, value, what, held_by, .. } in &of {
            write!(page, "| `{name}` | `{value}` | {what} | `{file}` |").unwrap();
            if held {
                let test = held_by.trim_matches('`').rsplit("::").next().unwrap();
                assert!(tests.iter().any(|name| name == test), "{name} is held by no test: {held_by:?}");
                write!(page, " {held_by} |").unwrap();
            }
            page.push('\n');
        }
    }
    page.push_str(LIMITS);
    holds(&root.join("docs/trust/thresholds.md"), &page);
    let numerics = root.join("docs/trust/numerics.md");
    let kept = fs::read_to_string(&numerics).unwrap();
    let (before, rest) = kept.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    holds(&numerics, &format!("{before}{BEGIN}{twelve}{END}{after}"));
}

/// The page at `path` is what is written of the sources, or becomes it.
fn holds(path: &Path, page: &str) {
    if std::env::var_os("SALTUS_BLESS").is_some() {
        fs::write(path, page).unwrap();
        return;
    }
    let kept = fs::read_to_string(path).unwrap_or_default();
    let differs = format!("{} differs: SALTUS_BLESS=1 rewrites it", path.display());
    for (kept, new) in kept.lines().zip(page.lines()) {
        assert_eq!(kept, new, "{differs}");
    }
    assert_eq!(kept.len(), page.len(), "{differs}");
}
