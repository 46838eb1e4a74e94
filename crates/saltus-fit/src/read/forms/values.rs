//! Values in a line, parted by commas or blanks, or in the brackets of a program.

use super::super::cell::{self, Cell, length};
use super::super::clause;
use super::super::heading::{Heading, Meaning, What};
use super::super::named::bounce;
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Unit};
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Word, split};

/// A name in a line by itself stands before at least so many numbers.
pub(super) const LIST: usize = 3;

/// Lines of the name of a bounce, or of a trial, and a bare number, `bounce 1: 64`, below one that
/// says what all are and in which unit, `Heights (cm):`, as a table; lines below them are remarks.
pub(super) fn titled(text: &str) -> Option<String> {
    let parted = |line: &'_ str| -> Option<(String, String)> {
        let (name, number) = line.split_once(": ").or_else(|| line.split_once('='))?;
        let bare = matches!(cell::read(number, false), Cell::Number(m) if m.unit.is_none());
        let named = bounce(name.trim()).map(|n| n.to_string()).or_else(|| trial(name.trim()));
        Some((named.filter(|_| bare)?, number.trim().to_owned()))
    };
    let lines: Vec<&str> = text.lines().collect();
    let first = lines.iter().position(|line| parted(line).is_some())?;
    let at = lines[..first].iter().rposition(|line| !line.trim().is_empty())?;
    let title = lines[at].trim().trim_end_matches(':');
    let heading = Heading::parse(title);
    let measured = heading.unit.is_some_and(|u| matches!(u.dimension, Dimension::Length | Dimension::Time));
    let rows: Vec<Option<(String, String)>> = lines.iter().map(|line| parted(line)).collect();
    let mut others = lines[first..].iter().zip(&rows[first..]).filter(|(_, row)| row.is_none());
    let count = rows.iter().flatten().count();
    if !(measured && heading.understood() && count > 1 && others.all(|(line, _)| super::silent(line))) {
        return None;
    }
    let plain = |line: &str| line.split([':', '=']).next().is_some_and(|name| name.trim().parse::<usize>().is_ok());
    let counted = lines.iter().zip(&rows).any(|(line, row)| row.is_some() && plain(line));
    let trials = rows.iter().flatten().any(|(name, _)| name.parse::<usize>().is_err());
    let key = if counted {
        ""
    } else if trials {
        "trial"
    } else {
        "bounce"
    };
    let spelt = |(n, line): (usize, &&str)| match &rows[n] {
        Some((name, number)) => format!("{name}\t{number}"),
        None if n == at => format!("{key}\t{title}"),
        None if n < at || line.trim().is_empty() => (*line).to_owned(),
        None => format!("#{line}"),
    };
    Some(lines.iter().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// Lines of a name and bare numbers, `red ball: 60, 62, 61`, below one that states the unit of all,
/// with the unit behind each.
pub(super) fn of_one_unit(text: &str) -> Option<String> {
    let list = |line: &'_ str| -> Option<(String, Vec<String>)> {
        let (name, numbers) = line.split_once(": ")?;
        let numbers = listed_numbers(numbers)?;
        let named = name.contains(char::is_alphabetic) && name.split_whitespace().count() < super::TOLD;
        named.then(|| (name.to_owned(), numbers.into_iter().map(str::to_owned).collect()))
    };
    let first = text.lines().position(|line| list(line).is_some())?;
    let unit = text.lines().take(first).find_map(clause::of_clauses)?;
    let below = || text.lines().skip(first).filter(|line| !line.trim().is_empty());
    if below().count() < 2 || !below().all(|line| list(line).is_some()) {
        return None;
    }
    let words = text.lines().take(first).flat_map(|line| line.split(|c: char| !c.is_alphanumeric()));
    let sign = words.filter(|word| !word.is_empty()).find(|word| Unit::parse(word) == Some(unit))?;
    let spelt = |line: &str| match list(line) {
        Some((name, numbers)) => {
            let values: Vec<String> = numbers.iter().map(|number| format!("{number} {sign}")).collect();
            format!("{name}: {}", values.join(", "))
        }
        None => line.to_owned(),
    };
    Some(text.lines().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The trial that a name is of, and of nothing else: `trial 2`, `Versuch B`.
fn trial(name: &str) -> Option<String> {
    let heading = Heading::parse(name);
    let value = heading.value().filter(|value| value.what == What::Unsaid && heading.unknown.is_empty())?;
    Some(value.trial.clone()).filter(|trial| !trial.is_empty())
}

/// The parts of a list that commas part, or blanks within brackets; a unit behind the last is that
/// of all, `64, 41, 26 cm`.
pub(super) fn listed_values(list: &str) -> Vec<String> {
    let bare = list.trim_end_matches(';').trim_end();
    // What a program calls on brackets: `c(64, 41)`, `np.array([64, 41])`.
    let called = |name: &str| name.chars().all(|c| c.is_alphanumeric() || matches!(c, '.' | '_'));
    let inside = |text: &str, open: char, close: char| {
        let (name, inside) = text.strip_suffix(close)?.split_once(open)?;
        called(name).then(|| inside.to_owned())
    };
    let bracketed = |text: &str| [('(', ')'), ('[', ']'), ('{', '}')].iter().find_map(|(o, c)| inside(text, *o, *c));
    let outer = bracketed(bare);
    let within = outer.as_deref().and_then(bracketed).or(outer);
    let values: Vec<&str> = match &within {
        Some(inside) => inside.split([',', ' ']).filter(|value| !value.is_empty()).collect(),
        None => list.split(", ").map(str::trim).collect(),
    };
    let plain = |value: &str| value.parse::<f64>().is_ok();
    let last = values.last().copied().unwrap_or_default();
    let unit = last.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | ' '));
    let shared = values.len() > 1 && Unit::parse(unit).is_some() && values[..values.len() - 1].iter().all(|v| plain(v));
    values.iter().map(|v| if shared && plain(v) { format!("{v} {unit}") } else { (*v).to_owned() }).collect()
}

/// A length without the words behind it that say no more than that a ball came so high: `64 cm
/// high`, `64 cm hoch gesprungen`.
pub(super) fn risen(text: &str) -> &str {
    let says = |word: &Word| {
        word.is(Atom::Rebound) || word.is(Atom::Filler) || word.is(Atom::Height) || Phrase::Rose.is(&folded(&word.text))
    };
    let ends = text.char_indices().filter(|(_, c)| *c == ' ').map(|(at, _)| at);
    let high = |at: &usize| {
        let words = split(&text[*at..]);
        length(&text[..*at]).is_some() && !words.is_empty() && words.iter().all(says)
    };
    let end = ends.filter(high).min();
    end.filter(|end| !text[*end..].contains(|c: char| c.is_ascii_digit())).map_or(text, |end| &text[..end])
}

/// The numbers of a line that holds several, which blanks or commas part, and nothing else.
pub(super) fn listed_numbers(line: &str) -> Option<Vec<&str>> {
    let values: Vec<&str> = line.split([',', ' ']).filter(|value| !value.is_empty()).collect();
    (values.len() >= LIST && values.iter().all(|value| value.parse::<f64>().is_ok())).then_some(values)
}

/// The only part of a line, between commas, that names a quantity and its unit, or frames of
/// contacts: `Heights (m), first the drop`.
pub(in crate::read) fn named_list(line: &str) -> Option<&str> {
    let names = |part: &&str| {
        let heading = Heading::parse(part);
        let frames = heading.meaning == Meaning::Frame && heading.has(Atom::Impact);
        (heading.unit.is_some() || frames) && heading.understood()
    };
    // As many names as commas part are those of columns.
    let columns = |line: &str| line.split(',').filter(|part| Heading::parse(part).unit.is_some()).count() > 1;
    let mut found = Some(line)
        .filter(|line| !columns(line))?
        .split(", ")
        .map(|part| part.trim().trim_end_matches([':', ' ']))
        .filter(names);
    found.next().filter(|_| found.next().is_none())
}
