//! Headers in which numbers stand: trials that are counted, and what was set.

use std::ops::Range;

use super::super::cell::{Cell, read};
use super::super::grid::View;
use super::super::heading::{Heading, Meaning, What};
use super::super::sequence::LEVEL;
use super::super::units::{Dimension, Unit};
use super::super::vocabulary::ROWS;
use super::header::{Header, VALUE, names_only, score};

/// The header that a row with numbers may be.
pub(super) fn header(view: View<'_>, row: usize, end: usize) -> Option<Header> {
    if names_only(view, row) {
        return None;
    }
    let found = counted(view, row, end).or_else(|| graded(view, row, end));
    found.or_else(|| continued(view, row, end))
}

/// `Drop height (cm),1,2,3` above rows of numbers: the trials are only counted.
fn counted(view: View<'_>, row: usize, end: usize) -> Option<Header> {
    let width = view.width(row);
    let named = (0..width).take_while(|&c| !view.cell(row, c).is_empty() && !view.is_number(row, c)).count();
    let count = (named..width).take_while(|&c| view.cell(row, c).parse() == Ok(c + 1 - named)).count();
    let rest = (named + count..width).all(|c| !view.is_number(row, c));
    if named == 0 || count < 2 || !rest || row + 1 >= end {
        return None;
    }
    let first = Heading::parse(view.cell(row, 0));
    // Below the name of what was dropped stand names, but none of a quantity.
    let below = view.cell(row + 1, 0);
    let called = named == 1 && matches!(first.meaning, Meaning::Setting) && !below.is_empty();
    let called = called && Heading::parse(below).value().is_none_or(|value| value.what == What::Unsaid);
    let begins = view.is_number(row + 1, if called { named } else { 0 });
    let of = if falling(view, row + 1..end, named, count) { "bounce" } else { "trial" };
    let names: Vec<String> = (0..width)
        .map(|c| match view.cell(row, c) {
            cell if (named..named + count).contains(&c) => format!("{of} {cell}"),
            cell => cell.to_owned(),
        })
        .collect();
    // What the numbers are, lines above may state.
    let score = score(&names).max(VALUE);
    (begins && first.understood()).then_some(Header { names, at: row, below: row + 1, score })
}

/// `Trial,4 °C,21 °C,50 °C`, or `Trial,50 cm,100 cm`, above rows of numbers: what was set heads each
/// column, a condition or a height of release.
fn graded(view: View<'_>, row: usize, end: usize) -> Option<Header> {
    let width = (0..view.width(row)).rfind(|&c| !view.cell(row, c).is_empty())? + 1;
    let unit = |c: usize| match view.read(row, c) {
        Cell::Number(m) => m.unit.map(|unit| (unit, m.value)),
        _ => None,
    };
    let set: Vec<(Unit, f64)> = (1..width).filter_map(unit).collect();
    let apart = (0..set.len()).all(|n| set[..n].iter().all(|(of, value)| *of == set[0].0 && *value != set[n].1));
    if set.len() < 2 || set.len() + 1 != width || !apart || view.is_number(row, 0) {
        return None;
    }
    // Beside the name of a quantity they are readings of it.
    let first = Heading::parse(view.cell(row, 0));
    if first.value().is_some_and(|v| v.what != What::Unsaid || !v.group.is_empty()) {
        return None;
    }
    // Bare numbers below them, each column with some, and nothing that bears a unit.
    let rows = || (row + 1..end).filter(|&r| (1..width).any(|c| view.is_number(r, c)));
    let bare =
        |r: usize| (1..width).all(|c| !matches!(view.read(r, c), Cell::Number(m) if m.unit.is_some() || m.value < 0.0));
    let stated = rows().take(ROWS).all(bare) && (1..width).all(|c| rows().any(|r| view.is_number(r, c)));
    let heights = set[0].0.dimension == Dimension::Length;
    let drops = heights && matches!(first.meaning, Meaning::Trial | Meaning::Number { .. } | Meaning::Empty);
    if !stated || !(drops || set[0].0.dimension == Dimension::Other) {
        return None;
    }
    let name = |c: usize| match view.cell(row, c) {
        cell if drops && c > 0 => format!("dropped from {cell}"),
        cell => cell.to_owned(),
    };
    let names: Vec<String> = (0..width).map(name).collect();
    let score = score(&names);
    Some(Header { names, at: row, below: row + 1, score })
}

/// `Rebound (cm) (1),(2),(3)`: a number in brackets behind a name that ends in the one before it is
/// the next of that name.
fn continued(view: View<'_>, row: usize, end: usize) -> Option<Header> {
    // The first of them is behind its name.
    if !view.cells(row).any(|cell| cell == "(2)") {
        return None;
    }
    let mut names: Vec<String> = Vec::new();
    let mut bare = false;
    for cell in view.cells(row) {
        let count =
            cell.strip_prefix('(').and_then(|cell| cell.strip_suffix(')')).and_then(|n| n.parse::<usize>().ok());
        let before = count.and_then(|n| Some(format!("({})", n.checked_sub(1)?)));
        match before.and_then(|before| names.last()?.strip_suffix(before.as_str()).map(str::to_owned)) {
            Some(name) => names.push(format!("{name}{cell}")),
            None => names.push(cell.to_owned()),
        }
        bare |= names.last().is_some_and(|name| name != cell);
    }
    let words = names.iter().all(|name| !matches!(read(name, false), Cell::Number(_)));
    let rows = row + 1 < end && (0..view.width(row + 1)).any(|c| view.is_number(row + 1, c));
    let score = score(&names);
    (bare && words && rows).then_some(Header { names, at: row, below: row + 1, score })
}

/// Whether numbers fall from column to column in every row that has any, each to less than `LEVEL`
/// of the one before: bounces one after the other, and no repeats.
fn falling(view: View<'_>, rows: Range<usize>, first: usize, count: usize) -> bool {
    let mut pairs = rows
        .flat_map(|row| {
            (first + 1..first + count).filter_map(move |c| view.number(row, c - 1).zip(view.number(row, c)))
        })
        .peekable();
    pairs.peek().is_some() && pairs.all(|(before, after)| after < LEVEL * before)
}
