//! From bytes to text: UTF-8, UTF-16, Latin-1, and every way to end a line.

use std::borrow::Cow;

use super::cell::{self, Cell};
use super::forms;
use super::heading::Heading;
use crate::error::TableError;

/// The text of a file and, where it is not UTF-8, the name of its encoding.
pub(super) struct Text<'a> {
    pub(super) text: Cow<'a, str>,
    pub(super) encoding: Option<&'static str>,
}

/// Nobody types more than this by hand, bytes: a longer text is of cells side by side.
const TYPED: usize = 1 << 20;

/// The bytes as text, or the reason why they are none.
pub(super) fn text<'a>(name: &str, bytes: &'a [u8]) -> Result<Text<'a>, TableError> {
    let (text, encoding) = decoded(bytes);
    let control = |c: char| c.is_ascii_control() && !matches!(c, '\t' | '\n' | '\r' | '\x0C' | '\x1A');
    if text.contains(control) {
        return Err(TableError::new(name, "this is not a text file: it contains control characters")
            .help("give a table as text or as a workbook (.xlsx, .xls), or save it as CSV and try again"));
    }
    // Old Macintosh files end their lines with a lone carriage return.
    let old = text.contains('\r') && !text.contains('\n');
    let text = if old { Cow::Owned(text.replace('\r', "\n")) } else { text };
    let text = counted(&text).map_or(text, Cow::Owned);
    let text = match names_in_comment(&text) {
        Some(at) => Cow::Owned([&text[..at], text[at..].trim_start_matches(['#', ' '])].concat()),
        None => text,
    };
    let text = if text.len() > TYPED { text } else { unstamped(&text).map_or(text, Cow::Owned) };
    let text = if text.len() > TYPED { text } else { forms::table(&text).map_or(text, Cow::Owned) };
    let text = aligned(&text).map_or(text, Cow::Owned);
    Ok(Text { text, encoding })
}

/// A text without the time of day that a monitor writes before each of its lines, `15:21:07.112
/// ->`; `None` where it writes none.
fn unstamped(text: &str) -> Option<String> {
    let bare = |line: &'_ str| -> Option<usize> {
        let (stamp, _) = line.split_once("->")?;
        (stamp.matches(':').count() == 2 && cell::clock(stamp.trim()).is_some()).then_some(stamp.len() + 2)
    };
    let filled = || text.lines().filter(|line| !line.trim().is_empty());
    if filled().count() < 2 || !filled().all(|line| bare(line).is_some()) {
        return None;
    }
    let lines = text.lines().map(|line| bare(line).map_or(line, |at| line[at..].trim_start()));
    Some(lines.collect::<Vec<_>>().join("\n") + "\n")
}

/// A text whose cells `#`, which name a count, are no comments; `None` where there are none.
pub(super) fn counted(text: &str) -> Option<String> {
    let found = numeros(text);
    // As long as before: what stands where does not change.
    (!found.is_empty()).then(|| {
        let mut text = text.to_owned();
        found.into_iter().for_each(|at| text.replace_range(at..=at, "n"));
        text
    })
}

/// Where lines begin with a `#` that is a cell, and no comment: `#,time (s)`, or `#,cm` below the
/// names.
fn numeros(text: &str) -> Vec<usize> {
    let cell = |at: &usize| {
        let after = text[*at..].strip_prefix('#').map(|after| after.trim_start_matches(' '));
        after.is_some_and(|after| after.starts_with([',', ';', '\t']))
    };
    let starts = text.match_indices('\n').map(|(at, _)| at + 1);
    let first = text.find(|c: char| !c.is_whitespace());
    let mut found: Vec<usize> = first.into_iter().chain(starts).filter(cell).collect();
    found.dedup();
    found
}

/// Where the `#` stands of a comment that names the columns of the numbers below it, `# t (s)  y
/// (m)`: as many names as they have, each of them understood.
fn names_in_comment(text: &str) -> Option<usize> {
    let (mut at, mut comment) = (0, None);
    let first = text.split_inclusive('\n').find(|line| {
        if line.starts_with('#') {
            comment = Some((at, line.trim_start_matches('#')));
        }
        at += line.len();
        !line.starts_with('#') && !line.trim().is_empty()
    })?;
    let (at, comment) = comment?;
    let cells = |line: &'_ str, mark: &str| -> Vec<String> {
        line.split(mark).map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_owned).collect()
    };
    let numbers = |mark: &str| {
        let found = cells(first, mark);
        Some(found.len()).filter(|count| *count > 1 && found.iter().all(|cell| cell.parse::<f64>().is_ok()))
    };
    let (mark, count) = [",", ";", "\t", "  ", " "].iter().find_map(|mark| Some((*mark, numbers(mark)?)))?;
    let names = |mark: &str| {
        let names = cells(comment, mark);
        names.len() == count && names.iter().all(|name| Heading::parse(name).understood())
    };
    // Names that blanks part may hold one.
    (names(mark) || mark == " " && names("  ")).then_some(at)
}

/// A text whose columns are made by runs of spaces, with a tab at the end of each run in their
/// place; `None` if it is none.
fn aligned(text: &str) -> Option<String> {
    let lines = || text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with('#') && !drawn(line));
    let numbers = |line: &str| line.split_whitespace().all(|cell| cell.parse::<f64>().is_ok());
    let width = lines().find(|line| numbers(line)).map_or(0, |line| line.split_whitespace().count());
    let spaced = |line: &str| line.starts_with(' ') || line.trim().contains("  ");
    let rows = lines().filter(|line| numbers(line));
    let of_numbers = width > 1
        && !text.contains(['\t', ';', ','])
        && rows.clone().all(|line| line.split_whitespace().count() == width)
        && 2 * rows.count() >= lines().count()
        && lines().any(spaced);
    if !of_numbers && !of_cells(text, lines()) {
        return None;
    }
    let width = if of_numbers { width } else { 0 };
    // Names that begin beyond the first cells of the rows leave the first column without a name.
    let ends = lines().filter(|line| numbers(line)).map(first_end);
    let beyond = ends.max().filter(|_| of_numbers).unwrap_or(usize::MAX);
    let mut found = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        if drawn(line) {
            found.push_str(&line[line.trim_end().len()..]);
            continue;
        }
        // A name may hold single spaces, unless there are as many words as columns.
        let least = if line.split_whitespace().count() == width { 1 } else { 2 };
        let indent = line.len() - line.trim_start().len();
        let unnamed = indent >= beyond && !numbers(line.trim());
        found.push_str(&line[..indent - usize::from(unnamed)]);
        found.push_str(if unnamed { "\t" } else { "" });
        let (inner, end) = line[indent..].split_at(line.trim().len());
        let mut run = 0;
        for c in inner.chars() {
            if c == ' ' {
                run += 1;
                continue;
            }
            if run > 0 {
                found.push_str(&" ".repeat(run - 1));
                found.push(if run >= least { '\t' } else { ' ' });
            }
            run = 0;
            found.push(c);
        }
        found.push_str(end);
    }
    Some(found)
}

/// Where the first cell of a line ends, in bytes.
fn first_end(line: &str) -> usize {
    let start = line.len() - line.trim_start_matches(' ').len();
    line[start..].find(' ').map_or(line.len(), |end| start + end)
}

/// Whether a line is drawn, and holds nothing: `-----  ------`, `=====`.
fn drawn(line: &str) -> bool {
    let bare = line.trim();
    (bare.contains("---") || bare.contains("===")) && bare.chars().all(|c| matches!(c, '-' | '=' | ' '))
}

/// The cells of a line that are parted by two blanks or more.
fn parted(line: &str) -> impl Iterator<Item = &str> {
    line.trim().split("  ").map(str::trim).filter(|cell| !cell.is_empty())
}

/// A line of so many words tells something.
const TOLD: usize = 5;

/// Whether two blanks or more part the cells of lines, some of them words: as many in most lines,
/// and in two of these a number; a comma is a decimal one.
fn of_cells<'a>(text: &str, lines: impl Iterator<Item = &'a str> + Clone) -> bool {
    let decimal = |line: &str| {
        let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let inside = |(at, _)| digit(line[..at].chars().next_back()) && digit(line[at + 1..].chars().next());
        line.match_indices(',').all(inside)
    };
    // Lines that tell something may hold any mark.
    let told = |line: &str| line.split_whitespace().filter(|word| word.contains(char::is_alphabetic)).count() >= TOLD;
    if text.lines().any(|line| line.contains(['\t', ';', '|', '&']) && (line.contains("  ") || !told(line))) {
        return false;
    }
    let number = |line: &&str| {
        parted(line).nth(1).is_some() && parted(line).any(|cell| matches!(cell::read(cell, false), Cell::Number(_)))
    };
    let Some(width) = lines.clone().find(number).map(|line| parted(line).count()) else {
        return false;
    };
    let alike = |line: &&str| parted(line).count() == width;
    let rows = lines.clone().filter(alike).filter(number).count();
    // A title may hold any comma.
    let table = lines.clone().filter(alike).count();
    // Of the lines around it most tell something, or greet.
    let around = lines.clone().filter(|line| !alike(line) && parted(line).nth(1).is_none()).count();
    rows > 1
        && lines.clone().filter(alike).all(decimal)
        && (3 * table >= 2 * lines.clone().count() || table > rows && rows > 2 && table + around == lines.count())
}

fn decoded(bytes: &[u8]) -> (Cow<'_, str>, Option<&'static str>) {
    if let Some(little) = utf16(bytes) {
        let bytes = bytes.strip_prefix(&[0xFF, 0xFE]).or(bytes.strip_prefix(&[0xFE, 0xFF])).unwrap_or(bytes);
        let unit = |pair: &[u8]| match *pair {
            [a, b] if little => u16::from_le_bytes([a, b]),
            [a, b] => u16::from_be_bytes([a, b]),
            // Half a character at the end.
            _ => 0xFFFD,
        };
        let characters = char::decode_utf16(bytes.chunks(2).map(unit));
        let text = characters.map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        return (Cow::Owned(text), Some("UTF-16"));
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => (Cow::Borrowed(text), None),
        // What is no UTF-8 was written by a program that knew one byte a character: Latin-1, near
        // enough.
        Err(_) => (Cow::Owned(bytes.iter().map(|&b| char::from(b)).collect()), Some("Latin-1")),
    }
}

/// Whether this is UTF-16, and then whether its low byte comes first: by its mark, or by the zeros
/// between Latin letters.
fn utf16(bytes: &[u8]) -> Option<bool> {
    match bytes {
        [0xFF, 0xFE, ..] => Some(true),
        [0xFE, 0xFF, ..] => Some(false),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some(true),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some(false),
        _ => None,
    }
}
