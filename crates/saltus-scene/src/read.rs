//! The way from bytes to a scene, and from errors of the TOML reader to errors in the words of
//! scenes.

use std::fmt;
use std::fs;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;
use toml::de::DeTable;

use super::error::{Fault, SceneError, nearest};
use super::file::File;
use super::run::Run;
use super::scene::Scene;
use super::schema;
use super::source::Source;

/// UTF-8's byte-order mark.
const MARK: &[u8] = b"\xef\xbb\xbf";

impl Scene {
    /// The largest file that is read, in bytes.
    pub const LARGEST: usize = 1 << 20;

    /// Reads a scene from TOML; `name` stands for the file in messages. A byte-order mark is passed
    /// over.
    ///
    /// # Errors
    /// [`SceneError`], with line, column and advice, when the text is no TOML or no scene: an
    /// unknown key, a wrong unit, a number outside its domain, settings that contradict each other,
    /// a ball inside a floor, a run without end.
    pub fn parse(name: &str, toml: &[u8]) -> Result<Self, SceneError> {
        Self::parse_with(name, toml, Run::default())
    }

    /// Reads a scene as [`Scene::parse`] does, with the settings of `run` before those under
    /// `[run]`: a scene without an end can be given one.
    ///
    /// ```
    /// use saltus_scene::{Run, Scene};
    /// let endless = b"restitution = 1\nball = { height = '1 m' }\n";
    /// assert!(Scene::parse("drop.toml", endless).is_err());
    /// let mut run = Run::default();
    /// run.until = Some(5.0);
    /// assert_eq!(Scene::parse_with("drop.toml", endless, run)?.run.until, Some(5.0));
    /// # Ok::<(), saltus_scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn parse_with(name: &str, toml: &[u8], run: Run) -> Result<Self, SceneError> {
        let bytes = unmarked(toml);
        let inner = || {
            let text = text(bytes)?;
            let mut scene = made(text, table(text)?, run)?;
            scene.source = Source::new(name, text);
            Ok(scene)
        };
        inner().map_err(|fault| SceneError::new(name, bytes, fault))
    }

    /// Reads a scene from a file.
    ///
    /// # Errors
    /// [`ReadError`]: the file cannot be read, or its content is no scene.
    ///
    /// ```
    /// use saltus_scene::Scene;
    /// let error = Scene::read("no/such/scene.toml").unwrap_err();
    /// assert!(error.to_string().starts_with("cannot read 'no/such/scene.toml'"));
    /// ```
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let file = |error| ReadError::File { path: path.to_owned(), error };
        let mut bytes = Vec::new();
        // One byte too many is enough to refuse the file.
        let most = Self::LARGEST as u64 + 1;
        fs::File::open(path).and_then(|source| source.take(most).read_to_end(&mut bytes)).map_err(file)?;
        Self::parse(&path.to_string_lossy(), &bytes).map_err(ReadError::Scene)
    }
}

/// A scene file that could not be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum ReadError {
    /// The file itself.
    File {
        /// Its path.
        path: std::path::PathBuf,
        /// The error of the system.
        error: std::io::Error,
    },
    /// The error in the text of the file.
    Scene(SceneError),
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { path, error } => write!(f, "cannot read '{}': {error}", path.display()),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {}

/// The bytes behind the byte-order mark.
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

/// The place and the message of an error of the TOML reader.
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

/// A value of at most so many bytes is shown in a message.
const SHORT: usize = 40;

/// The texts between backticks, after the first so many.
fn quoted(message: &str, after: usize) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).skip(after).collect()
}

/// The error of the TOML reader, in the words of scenes.
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
            // What stands there, as it was written.
            let written = text.get(span.clone()).filter(|text| text.len() <= SHORT && !text.contains('\n'));
            let found = match found {
                "map" => "a table",
                "sequence" => "a list",
                other => {
                    let told = other.split('`').nth(1).filter(|told| told.len() <= SHORT);
                    written.or(told).unwrap_or("this value")
                }
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

/// Parts of messages of the TOML reader, the message instead, and the advice.
const WORDS: [(&str, &str, Option<&str>); 9] = [
    ("cannot recurse", TOO_DEEP, Some("take brackets and braces away: a scene has four levels of them")),
    ("recursion limit", TOO_DEEP, Some("take brackets and braces away: a scene has four levels of them")),
    (
        "floating-point number overflow",
        "this number is larger than any that can be computed with",
        Some("write a smaller one"),
    ),
    ("number too large", "this number is larger than any that can be computed with", Some("write a smaller one")),
    ("unexpected leading zero", "a number does not begin with a zero here", Some("leave the zero out")),
    ("unclosed inline table", "these braces are not closed", Some("write `}`, and close the quotes before it")),
    ("unclosed array", "these brackets are not closed", Some("write `]`, and close the quotes before it")),
    ("unclosed table", "the name of this table is not closed", Some("write `]` behind it")),
    (
        "missing escaped value",
        "a backslash does not stand for itself in these quotes",
        Some("write two, or single quotes"),
    ),
];
const TOO_DEEP: &str = "lists and tables are too deep in each other here";

/// The fault of a line that is no TOML.
fn syntax(text: &str, span: Range<usize>, message: &str) -> Fault {
    let (message, help) = if message.starts_with("duplicate key") {
        let help = "keep one; several balls or floors stand each under [[ball]] or [[floor]]";
        ("this key is given twice", Some(help))
    } else {
        let known = WORDS.iter().find(|(theirs, _, _)| message.starts_with(theirs));
        let (ours, help) = known.map_or((message, None), |&(_, ours, help)| (ours, help));
        (ours, help.or_else(|| slip(text, &span)))
    };
    // What the reader expects is advice where there is no better.
    let (message, wanted) = message.split_once(", expected ").unwrap_or((message, "nothing"));
    let wanted = (wanted != "nothing").then(|| format!("write {wanted}"));
    Fault { message: message.to_owned(), help: help.map(str::to_owned).or(wanted), span }
}

/// Rust's names of types in words.
fn plain(wanted: &str) -> &str {
    match wanted {
        "u32" => "a whole number from 0 to 4294967295, without quotes",
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

/// Advice about an unknown key.
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
