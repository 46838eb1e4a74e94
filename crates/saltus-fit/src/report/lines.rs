//! Lines and paragraphs of the report for people.

use std::fmt::{self, Formatter};

/// Lines are broken before this column.
const WIDTH: usize = 96;
/// A heading and its lines; nothing where there are none.
pub(super) fn section(f: &mut Formatter<'_>, title: &str, lines: &[String]) -> fmt::Result {
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(f, "\n{title}")?;
    for line in lines {
        let end = if line.ends_with(['.', '?']) { "" } else { "." };
        paragraph(f, 2, 4, &format!("- {line}{end}"))?;
    }
    Ok(())
}

/// The same with a capital first letter.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A text as a sentence: with a capital first letter, and a full stop where it does not ask.
pub(super) fn sentence(text: &str) -> String {
    let end = if text.ends_with('?') { "" } else { "." };
    format!("{}{end}", capital(text))
}

/// Writes a paragraph broken at spaces, with its own indent for the first line.
pub(super) fn paragraph(f: &mut Formatter<'_>, first: usize, rest: usize, text: &str) -> fmt::Result {
    let mut line = " ".repeat(first);
    let mut used = first;
    let mut fresh = true;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if !fresh && used + 1 + length > WIDTH {
            writeln!(f, "{line}")?;
            line = " ".repeat(rest);
            used = rest;
            fresh = true;
        }
        if !fresh {
            line.push(' ');
            used += 1;
        }
        line.push_str(word);
        used += length;
        fresh = false;
    }
    writeln!(f, "{line}")
}
