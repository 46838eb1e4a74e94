//! A scene that cannot be read: what is wrong, where, and what to do.

use std::fmt;
use std::ops::Range;

/// A scene that could not be read: what is wrong, in which line and column, and what to do about
/// it.
///
/// Its `Display` form shows the line itself with a caret below the place:
///
/// ```
/// use saltus_scene::Scene;
///
/// let error = Scene::parse("drop.toml", b"restitution = 1.2\n[ball]\nheight = \"1 m\"\n").unwrap_err();
/// assert_eq!((error.line(), error.column()), (1, 15));
/// let shown = [
///     "drop.toml:1:15: 1.2 is not a coefficient of restitution",
///     "    1 | restitution = 1.2",
///     "      |               ^^^",
///     "  help: give a number from 0 (stays where it lands) to 1 (loses nothing)",
/// ];
/// assert_eq!(error.to_string(), shown.join("\n"));
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct SceneError {
    name: String,
    line: usize,
    column: usize,
    width: usize,
    text: String,
    message: String,
    help: Option<String>,
}

/// The longest part of a line that is shown; a longer line is cut around the caret.
const SHOWN: usize = 90;

impl SceneError {
    /// The problem at bytes `fault.span` of `source`; a byte that is no text counts as one
    /// character.
    pub(super) fn new(name: &str, source: &[u8], fault: Fault) -> Self {
        let start = fault.span.start.min(source.len());
        let first = source[..start].iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        let last = source[start..].iter().position(|&byte| byte == b'\n').map_or(source.len(), |at| start + at);
        let end = fault.span.end.clamp(start, last);
        let count = |bytes: &[u8]| String::from_utf8_lossy(bytes).chars().count();
        Self {
            name: name.to_owned(),
            line: 1 + source[..first].iter().filter(|&&byte| byte == b'\n').count(),
            column: 1 + count(&source[first..start]),
            width: count(&source[start..end]).max(1),
            text: String::from_utf8_lossy(&source[first..last]).into_owned(),
            message: shortened(legible(&fault.message)),
            help: fault.help.as_deref().map(|help| shortened(legible(help))),
        }
    }

    /// The line the problem is in, counted from 1.
    #[must_use]
    pub const fn line(&self) -> usize {
        self.line
    }

    /// The column the problem starts at, in characters counted from 1.
    #[must_use]
    pub const fn column(&self) -> usize {
        self.column
    }

    /// The message without the place.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Advice: what to do about it.
    #[must_use]
    pub fn help(&self) -> Option<&str> {
        self.help.as_deref()
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, line, column, message, .. } = self;
        write!(f, "{name}:{line}:{column}: {message}")?;
        if !self.text.trim().is_empty() {
            let at = column - 1;
            let from = if at + self.width > SHOWN { at.saturating_sub(SHOWN / 2) } else { 0 };
            let plain = |c: char| if c.is_control() || c == char::REPLACEMENT_CHARACTER { ' ' } else { c };
            let shown: String = self.text.chars().skip(from).take(SHOWN).map(plain).collect();
            let carets = "^".repeat(self.width.clamp(1, SHOWN.saturating_sub(at - from).max(1)));
            let gutter = line.to_string().len().max(3);
            write!(f, "\n  {line:>3} | {}", shown.trim_end())?;
            write!(f, "\n  {:>gutter$} | {}{carets}", "", " ".repeat(at - from))?;
        }
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for SceneError {}

/// An error about a scene or its run: what is wrong, and what to do.
///
/// ```
/// use saltus_scene::{Sampling, Scene};
/// let record = Scene::parse("drop.toml", b"restitution = 0.5\nball = { height = 1 }\n")?.plan()?.run()?;
/// let error = record.table(Some(Sampling::Every(1e-9))).unwrap_err();
/// assert!(error.to_string().ends_with("the samples are more than 10000000: sample less often, or end the run earlier"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct Error(String);

impl Error {
    pub(super) fn new(says: impl fmt::Display) -> Self {
        Self(says.to_string())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}

/// A fault at a range of bytes, before its file has a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    pub(super) span: Range<usize>,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

impl Fault {
    /// The fault `says` at `span`; what follows the first ": " of `says` is the help.
    pub(super) fn new(span: Range<usize>, says: impl fmt::Display) -> Self {
        let says = says.to_string();
        let (message, help) = match says.split_once(": ") {
            Some((message, help)) => (message.to_owned(), Some(help.to_owned())),
            None => (says, None),
        };
        Self { span, message, help }
    }
}

/// A sentence that quotes long words of a file: its beginning and its end.
fn shortened(says: String) -> String {
    /// The longest sentence that is shown whole, in characters: of ours none is half as long.
    const MOST: usize = 800;
    let count = says.chars().count();
    if count <= MOST {
        return says;
    }
    let part = |from: usize| says.chars().skip(from).take(MOST / 2).collect::<String>();
    format!("{} … {}", part(0), part(count - MOST / 2))
}

/// The text with numbers of more digits than anybody counts by powers of ten.
pub(super) fn legible(text: &str) -> String {
    const MOST: usize = 21;
    let digit = |c: char| c.is_ascii_digit() || c == '.';
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(digit) {
        let (before, from) = rest.split_at(at);
        let (number, after) = from.split_at(from.find(|c| !digit(c)).unwrap_or(from.len()));
        let value = number.parse::<f64>().ok().filter(|_| number.len() > MOST);
        shown.push_str(before);
        shown.push_str(&value.map_or_else(|| number.to_owned(), |value| format!("{value:e}")));
        rest = after;
    }
    shown + rest
}

/// The number with at most six significant digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let decimals = (5.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The name most like `text`, if any is like it at all.
pub(super) fn nearest<'a>(text: &str, known: &[&'a str]) -> Option<&'a str> {
    let text = text.trim().to_lowercase();
    let like = |name: &&str| strsim::jaro_winkler(&text, name);
    known.iter().copied().max_by(|a, b| like(a).total_cmp(&like(b))).filter(|name| like(name) > 0.8)
}
