//! The numbers of a line, each with its unit and the words before it.

use super::super::cell::length;
use super::super::phrases::Phrase;
use super::super::units::Unit;
use super::super::vocabulary::folded;

/// Marks between one height and the next.
const ARROWS: [&str; 9] = ["-->", "->", "=>", ">", "→", "⟶", "⇒", "➔", "➜"];

/// Those marks, and words that stand for one.
pub(super) fn arrows() -> impl Iterator<Item = &'static str> {
    ARROWS.into_iter().chain(Phrase::Versus.all().iter().copied())
}

/// A number of a line with its unit, and the words before it.
pub(super) struct Part<'a> {
    pub(super) words: &'a str,
    pub(super) number: &'a str,
}

impl Part<'_> {
    /// Whether its words do nothing but join its number to the one before, by a word or by `marks`.
    pub(super) fn joins(&self, marks: &[char]) -> bool {
        let word = self.words.trim_matches(marks);
        word.is_empty() || Phrase::And.is(&folded(word))
    }
}

/// The numbers of a line, each with the words before it, and the words behind the last.
pub(super) fn parts(line: &str) -> (Vec<Part<'_>>, &str) {
    let (mut found, mut from, mut at) = (Vec::new(), 0, 0);
    while let Some(start) = line[at..].find(|c: char| c.is_ascii_digit()).map(|n| at + n) {
        let digits = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',');
        let run = line[start..].find(|c: char| !digits(c)).map_or(line.len(), |n| start + n);
        let end = start + line[start..run].trim_end_matches(['.', ',']).len();
        at = end;
        // `h1`, `2nd` are words.
        let letter = |c: Option<char>| c.is_some_and(|c| c.is_alphabetic() || c == '_');
        if letter(line[..start].chars().next_back()) {
            continue;
        }
        let blank = line[end..].len() - line[end..].trim_start_matches(' ').len();
        let spelt = &line[end + blank..];
        let stop = spelt.find(|c: char| !(c.is_alphabetic() || matches!(c, '%' | '"'))).unwrap_or(spelt.len());
        // What stands before a sign is a name, `hit 1 t=3885 ms`, and a unit before an arrow.
        let sign = spelt[stop..].trim_start();
        let name = sign.starts_with(['=', ':', '_']) && !arrows().any(|arrow| sign.starts_with(arrow));
        let unit = (stop > 0 && !name && Unit::parse(&spelt[..stop]).is_some()).then(|| end + blank + stop);
        let unit = feet(&line[start..]).map(|length| start + length).or(unit);
        if unit.is_none() && blank == 0 && letter(spelt.chars().next()) {
            continue;
        }
        let end = unit.unwrap_or(end);
        found.push(Part { words: line[from..start].trim(), number: &line[start..end] });
        (from, at) = (end, end);
    }
    (found, line[from..].trim())
}

/// How long the feet and inches are that a text begins with: `4'0"`, `6 ft 2 in`.
fn feet(text: &str) -> Option<usize> {
    let marks = ["\"", "″", "”", "''", "in", "inches"];
    let ends = marks.iter().filter_map(|mark| text.find(mark).map(|at| at + mark.len()));
    let both = |part: &str| {
        let units = part.chars().filter(|c| c.is_ascii_digit() || *c == ' ').count();
        units < part.len() && part.split(|c: char| !c.is_ascii_digit()).filter(|n| !n.is_empty()).count() > 1
    };
    ends.filter(|&end| both(&text[..end]) && length(&text[..end]).is_some()).max()
}
