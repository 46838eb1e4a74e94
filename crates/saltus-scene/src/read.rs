//! From bytes to a scene, and from what the TOML reader says to what a person can use.

use std::fs;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;
use toml::de::DeTable;

use super::error::{Fault, SceneError};
use super::file::File;
use super::source::Source;
use super::{ReadError, Run, Scene, schema};

/// UTF-8's byte-order mark.
const MARK: &[u8] = b"\xef\xbb\xbf";

pub(super) fn from_path(path: &Path) -> Result<Scene, ReadError> {
    let file = |error| ReadError::File { path: path.to_owned(), error };
    let mut bytes = Vec::new();
    // One byte too many is enough to know.
    let most = Scene::LARGEST as u64 + 1;
    fs::File::open(path).and_then(|source| source.take(most).read_to_end(&mut bytes)).map_err(file)?;
    Scene::parse(&path.to_string_lossy(), &bytes).map_err(ReadError::Scene)
}

pub(super) fn scene(name: &str, bytes: &[u8], run: Run) -> Result<Scene, SceneError> {
    let bytes = unmarked(bytes);
    let inner = || {
        let text = text(bytes)?;
        let mut scene = made(text, table(text)?, run)?;
        scene.source = Source::new(name, text);
        Ok(scene)
    };
    inner().map_err(|fault| SceneError::new(name, bytes, fault))
}

/// What follows the byte-order mark.
pub(super) fn unmarked(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(MARK).unwrap_or(bytes)
}

/// The bytes as text of a size that is read.
pub(super) fn text(bytes: &[u8]) -> Result<&str, Fault> {
    if bytes.len() > Scene::LARGEST {
        return Err(Fault::new(
            0..0,
            "the file is larger than 1 MiB: a scene is a page of text; is this the right file?",
        ));
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(Fault::new(0..1, "the file is UTF-16: save it as UTF-8"));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        Fault::new(at..at + 1, "the file is not UTF-8 from here on: save it as UTF-8 text")
    })?;
    if text.trim().is_empty() {
        return Err(Fault::new(
            0..0,
            "the file is empty: write at least `restitution = 0.8`, [ball] and `height = \"1 m\"`",
        ));
    }
    Ok(text)
}

/// Where and what the TOML reader says.
fn said(error: &toml::de::Error) -> (Range<usize>, String) {
    (error.span().unwrap_or(0..0), error.message().trim().replace('\n', ", "))
}

/// The text as TOML.
pub(super) fn table(text: &str) -> Result<Spanned<DeTable<'_>>, Fault> {
    DeTable::parse(text).map_err(|error| {
        let (span, message) = said(&error);
        syntax(text, span, &message)
    })
}

/// The scene in a table that was read from `text`.
pub(super) fn made(text: &str, table: Spanned<DeTable<'_>>, run: Run) -> Result<Scene, Fault> {
    let file = File::deserialize(toml::de::Deserializer::from(table)).map_err(|error| {
        let (span, message) = said(&error);
        translate(text, span, &message)
    })?;
    file.scene(run)
}

/// The name most like `text`, if any is like it at all.
pub(super) fn nearest<'a>(text: &str, known: &[&'a str]) -> Option<&'a str> {
    let text = text.trim().to_lowercase();
    let like = |name: &&str| strsim::jaro_winkler(&text, name);
    known.iter().copied().max_by(|a, b| like(a).total_cmp(&like(b))).filter(|name| like(name) > 0.8)
}

/// What stands between backticks, after the first so many.
fn quoted(message: &str, after: usize) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).skip(after).collect()
}

/// What the TOML reader says, as a person would say it.
fn translate(text: &str, span: Range<usize>, message: &str) -> Fault {
    let date = text.get(span.clone()).is_some_and(|value| value.starts_with(|c: char| c.is_ascii_digit()))
        && message.starts_with("invalid type: map");
    if date || message.contains("$__toml_private") {
        return Fault::new(span, "a date or a time of day does not belong here: write a quantity such as \"1 s\"");
    }
    if let Some(key) = message.strip_prefix("unknown field `").and_then(|rest| rest.split('`').next()) {
        return Fault {
            message: format!("`{key}` is no key here"),
            help: Some(unknown(key, &quoted(message, 1))),
            span,
        };
    }
    if let Some(word) = message.strip_prefix("unknown variant `").and_then(|rest| rest.split('`').next()) {
        let known = quoted(message, 1);
        let list = known.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        let near = nearest(word, &known).map_or(String::new(), |near| format!("did you mean \"{near}\"? "));
        return Fault {
            message: format!("\"{word}\" is not known here"),
            help: Some(format!("{near}choose one of {list}")),
            span,
        };
    }
    if let Some(key) = message.strip_prefix("missing field `").and_then(|rest| rest.split('`').next()) {
        return Fault { message: format!("`{key}` is missing here"), help: Some(format!("give `{key} = ...`")), span };
    }
    for wrong in ["invalid type: ", "invalid value: ", "wanted "] {
        if let Some((found, wanted)) = message.strip_prefix(wrong).and_then(|rest| rest.split_once(", expected ")) {
            let found = match found {
                "map" => "a table",
                "sequence" => "a list",
                other => other,
            };
            return Fault {
                message: format!("{found} does not belong here"),
                help: Some(format!("write {}", plain(wanted))),
                span,
            };
        }
    }
    if let Some((_, wanted)) = message.strip_prefix("invalid length ").and_then(|rest| rest.split_once(", expected ")) {
        return Fault {
            message: "this list has the wrong length".to_owned(),
            help: Some(format!("write {}", plain(wanted))),
            span,
        };
    }
    Fault::new(span, message)
}

/// What is wrong with a line that is no TOML.
fn syntax(text: &str, span: Range<usize>, message: &str) -> Fault {
    let (message, help) = if message.starts_with("duplicate key") {
        let help = "keep one; several balls or floors stand each under [[ball]] or [[floor]]";
        ("this key is given twice", Some(help))
    } else {
        (message, slip(text, &span))
    };
    Fault { message: message.to_owned(), help: help.map(str::to_owned), span }
}

/// Rust's names of types in words.
fn plain(wanted: &str) -> &str {
    match wanted {
        "u32" => "a whole number, zero or more, without quotes",
        "a boolean" => "true or false",
        "a string" => "text in quotes",
        "a tuple of size 2" | "an array of length 2" => "two values, such as [0.7, 0.8]",
        "struct BallTable" => "a table, such as { height = \"1 m\" }",
        "struct FloorTable" => "a table, such as { kind = \"incline\", angle = \"30 deg\" }",
        "struct CollisionTable" => "a table, such as { restitution = 0.85 }",
        "struct AirTable" => "a table, such as { wind = \"-2 m/s\" }",
        "struct DragTable" => "a table, such as { coefficient = 0.47 }",
        "struct MagnusTable" => "a table, such as { slope = 1 }",
        "struct SpinDecayTable" => "a table, such as { time = \"20 s\" }",
        "struct RunTable" => "a table, such as { until = \"5 s\" }",
        "struct PictureTable" => "a table, such as { kind = \"velocity\" }",
        other if other.starts_with("struct ") || other == "map" => "a table, such as { key = value }",
        other => other,
    }
}

/// What to do with a key that is not known where it stands.
fn unknown(key: &str, known: &[&str]) -> String {
    let mut homes = schema::homes(key);
    if !homes.is_empty() {
        homes.truncate(3);
        return format!("`{key}` belongs {}", homes.join(" or "));
    }
    if let Some(near) = nearest(key, known) {
        return format!("did you mean `{near}`?");
    }
    let all = schema::keys();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    if let Some(near) = nearest(key, &all) {
        return format!("did you mean `{near}`? That belongs {}", schema::homes(near).join(" or "));
    }
    let list: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
    format!("the keys are {}", list.join(", "))
}

/// Usual slips of the pen in a line that is no TOML.
fn slip(text: &str, span: &Range<usize>) -> Option<&'static str> {
    let start = text.get(..span.start)?.rfind('\n').map_or(0, |at| at + 1);
    let line = text.get(start..)?.lines().next()?;
    let Some((_, value)) = line.split_once('=') else {
        return Some("write `key = value`, a table `[name]`, or a comment after `#`");
    };
    let value = value.split('#').next()?.trim();
    let number = value.trim_start_matches(['+', '-']).starts_with(|c: char| c.is_ascii_digit());
    let comma = number && value.split_once(',').is_some_and(|(_, rest)| rest.starts_with(|c: char| c.is_ascii_digit()));
    match value {
        "" => Some("give the key a value, such as \"1 m\""),
        _ if comma => Some("write a decimal point, not a comma"),
        _ if number => Some("a number with a unit stands in quotes, such as \"1 m\""),
        _ if value.starts_with(char::is_alphabetic) => Some("text stands in quotes"),
        _ => None,
    }
}
