//! Every code listing in README and docs compiles in a crate of its own, with only the dependencies
//! that it names and the features that its page names.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The crates of the project, as a program names them, with their place and the features that a
/// page may name.
const CRATES: [(&str, &str, &[&str]); 7] = [
    ("saltus", "crates/saltus", &["num-dual", "rayon", "serde", "derive"]),
    ("saltus_bounce", "crates/saltus-bounce", &[]),
    ("saltus_scene", "crates/saltus-scene", &[]),
    ("saltus_fit", "crates/saltus-fit", &[]),
    ("saltus_plot", "crates/saltus-plot", &[]),
    ("saltus_motion", "crates/saltus-motion", &[]),
    ("saltus_examples", "examples", &[]),
];

struct Listing {
    page: String,
    line: usize,
    code: String,
    /// The lines of `[dependencies]`.
    dependencies: String,
}

impl Listing {
    /// A program: the listing itself if it has a `main`, else within one.
    fn program(&self) -> String {
        let shown = |line: &str| line.strip_prefix("# ").unwrap_or(if line == "#" { "" } else { line }).to_owned();
        let code = self.code.lines().map(shown).collect::<Vec<_>>().join("\n");
        if code.contains("fn main()") {
            code
        } else if code.trim_end().ends_with("(())") {
            format!(
                "fn main() {{\nfn listing() -> Result<(), impl core::fmt::Debug> {{\n{code}\n}}\nlisting().unwrap();\n}}\n"
            )
        } else {
            format!("fn main() {{\n{code}\n}}\n")
        }
    }
}

/// The listings of a page.
fn listings(root: &Path, page: &Path) -> Vec<Listing> {
    let text = fs::read_to_string(page).unwrap();
    let mut found = Vec::new();
    let mut open: Option<(usize, String)> = None;
    for (line, content) in text.lines().enumerate() {
        match &mut open {
            None if content.starts_with("```rust") => open = Some((line + 2, String::new())),
            None => {}
            Some((line, code)) if content.starts_with("```") => {
                let dependencies = dependencies(root, &text, code);
                found.push(Listing {
                    page: page.display().to_string(),
                    line: *line,
                    code: std::mem::take(code),
                    dependencies,
                });
                open = None;
            }
            Some((_, code)) => {
                code.push_str(content);
                code.push('\n');
            }
        }
    }
    found
}

/// What a listing names, with the features that its page names.
fn dependencies(root: &Path, page: &str, code: &str) -> String {
    let names = |name: &str| code.contains(&format!("{name}::"));
    CRATES.iter().filter(|(name, ..)| names(name)).fold(String::new(), |mut lines, (name, place, features)| {
        let named: Vec<_> =
            features.iter().filter(|feature| page.contains(**feature)).map(|f| format!("{f:?}")).collect();
        let (package, path) = (name.replace('_', "-"), root.join(place));
        writeln!(lines, "{package} = {{ path = {path:?}, features = [{}] }}", named.join(", ")).unwrap();
        lines
    })
}

#[test]
fn listings_compile_with_what_they_name() {
    if !saltus_cases::thorough() {
        println!("skipped: THOROUGH=1 compiles each listing in a crate of its own");
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let inside = |folder: &Path| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let mut pages: Vec<PathBuf> = inside(&root.join("docs"));
    pages = pages.iter().filter(|path| path.is_dir()).flat_map(|folder| inside(folder)).collect();
    pages.push(root.join("README.md"));
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    let mut crates: BTreeMap<String, Vec<Listing>> = BTreeMap::new();
    for listing in pages.iter().flat_map(|page| listings(root, page)) {
        crates.entry(listing.dependencies.clone()).or_default().push(listing);
    }
    assert!(crates.values().map(Vec::len).sum::<usize>() > 30);

    // A workspace of crates of the same dependencies each, a program for each listing.
    let at = Path::new(env!("CARGO_TARGET_TMPDIR")).join("listings");
    let _ = fs::remove_dir_all(&at);
    let mut places = BTreeMap::new();
    let mut members = Vec::new();
    for (n, (dependencies, listings)) in crates.iter().enumerate() {
        let (name, programs) = (format!("listings-{n}"), at.join(format!("listings-{n}/src/bin")));
        fs::create_dir_all(&programs).unwrap();
        let manifest = format!("[package]\nname = {name:?}\nedition = \"2024\"\n\n[dependencies]\n{dependencies}");
        fs::write(at.join(&name).join("Cargo.toml"), manifest).unwrap();
        for (k, listing) in listings.iter().enumerate() {
            let program = format!("of_{n}_{k}");
            fs::write(programs.join(format!("{program}.rs")), listing.program()).unwrap();
            places.insert(program, format!("{}:{}", listing.page, listing.line));
        }
        members.push(format!("{name:?}"));
    }
    fs::write(at.join("Cargo.toml"), format!("[workspace]\nresolver = \"3\"\nmembers = [{}]\n", members.join(", ")))
        .unwrap();
    fs::copy(root.join("Cargo.lock"), at.join("Cargo.lock")).unwrap();

    let cargo = env::var_os("CARGO").unwrap_or("cargo".into());
    let mut check = Command::new(cargo);
    check.args(["check", "--workspace", "--offline", "--keep-going", "--quiet", "--color", "never"]).current_dir(&at);
    check.env("CARGO_TARGET_DIR", at.join("../listings-target"));
    let output = check.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let wrong: Vec<_> = places
        .iter()
        .filter(|(program, _)| said.contains(&format!("bin \"{program}\")")) && said.contains(&format!("{program}.rs")))
        .collect();
    assert!(output.status.success(), "{wrong:#?}\n{said}");
}
