//! The pages: each link leads to a file and a heading that are there, and each page ends in its
//! limits; a heading or a list that has become prose is neither.

use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// What a page shows: the anchors and titles of its headings, where its links lead, its prose.
#[derive(Default)]
struct Page {
    anchors: BTreeSet<String>,
    headings: Vec<(HeadingLevel, String)>,
    links: Vec<String>,
    /// What stands in a line between marks.
    prose: Vec<String>,
}

impl Page {
    fn read(text: &str) -> Self {
        let mut page = Self::default();
        let (mut heading, mut listing) = (None, false);
        for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::Heading { level, .. }) => heading = Some((level, String::new())),
                Event::End(TagEnd::Heading(_)) => page.headings.extend(heading.take()),
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(dest_url.into_string());
                }
                Event::Start(Tag::CodeBlock(_)) => listing = true,
                Event::End(TagEnd::CodeBlock) => listing = false,
                Event::Text(words) | Event::Code(words) if heading.is_some() => {
                    heading.iter_mut().for_each(|(_, title): &mut (_, String)| title.push_str(&words));
                }
                Event::Text(words) if !listing => page.prose.push(words.into_string()),
                Event::Html(html) | Event::InlineHtml(html) => page.links.extend(sources(&html)),
                _ => {}
            }
        }
        for (_, title) in &page.headings {
            let anchor = title.to_lowercase().replace(' ', "-");
            page.anchors.insert(anchor.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect());
        }
        page
    }
}

/// Where the pictures and links of a piece of HTML lead.
fn sources(html: &CowStr<'_>) -> Vec<String> {
    let after =
        |name: &str| html.split(name).skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned).collect();
    let [mut all, links]: [Vec<String>; 2] = ["src=\"", "href=\""].map(after);
    all.extend(links);
    all
}

/// The pages beside the sources: in docs, and wherever else a person reads one.
fn pages(root: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root.join("docs"), root.join("crates"), root.join("examples"), root.join("web")];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match path.extension().is_some_and(|extension| extension == "md") {
                true => found.push(path),
                // Tables that people handed in lie in `tests`, some of them as pages.
                false if path.is_dir() && !["tests", "node_modules", "target"].contains(&&*name) => folders.push(path),
                false => {}
            }
        }
    }
    found.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "tests/README.md"].map(|page| root.join(page)));
    found.iter().map(|path| path.canonicalize().unwrap()).collect()
}

#[test]
fn links_lead_to_what_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let pages: BTreeMap<PathBuf, Page> =
        pages(root).into_iter().map(|path| (path.clone(), Page::read(&fs::read_to_string(path).unwrap()))).collect();
    let mut wrong = Vec::new();
    let mut followed = 0;
    for (path, page) in &pages {
        for link in page.links.iter().filter(|link| !link.contains("://") && !link.starts_with("mailto:")) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            let there = target.canonicalize().is_ok_and(|target| {
                anchor.is_empty() || pages.get(&target).is_none_or(|page| page.anchors.contains(anchor))
            });
            followed += 1;
            if !there {
                wrong.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(followed > 100, "{followed} links");
    assert!(wrong.is_empty(), "no such file or heading:\n{}", wrong.join("\n"));
}

#[test]
fn pages_end_in_their_limits() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join("docs").canonicalize().unwrap();
    let mut wrong = Vec::new();
    for path in pages(docs.parent().unwrap()).iter().filter(|path| path.starts_with(&docs)) {
        let page = Page::read(&fs::read_to_string(path).unwrap());
        let last = page.headings.iter().rfind(|(level, _)| *level <= HeadingLevel::H2);
        if path.file_name().is_none_or(|name| name != "README.md") && last.is_none_or(|(_, title)| title != "Limits") {
            wrong.push(format!("{}: the last heading is {last:?}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Two spaces between the words of one line: a list, a heading or a table that has been filled as
/// prose.
#[test]
fn prose_is_prose() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut wrong = Vec::new();
    for path in pages(root) {
        let page = Page::read(&fs::read_to_string(&path).unwrap());
        for words in page.prose.iter().filter(|words| words.trim().contains("  ")) {
            wrong.push(format!("{}: {words}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
