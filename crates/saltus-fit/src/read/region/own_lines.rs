//! Units and errors of readings that stand in lines of their own, below the names of columns.

use super::super::grid::View;
use super::super::heading::{Heading, Meaning, Value};
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Unit};
use super::super::vocabulary::{ROWS, meanings};

/// The names of columns below which a unit in brackets stands alone at the end, above no number:
/// it is that of all that bear none, `drop  rebound  (cm)`.
pub(super) fn united(view: View<'_>, names: &[String], next: usize) -> Option<Vec<String>> {
    let last = names.iter().rposition(|name| !name.is_empty())?;
    let bare = names[last].strip_prefix(['(', '['])?.strip_suffix([')', ']'])?;
    let unit = Unit::parse(bare).filter(|unit| matches!(unit.dimension, Dimension::Length | Dimension::Time))?;
    let empty = (next..view.rows()).take(ROWS).all(|row| view.cell(row, last).is_empty());
    let counts = |n: usize| (next..view.rows()).take(ROWS).all(|row| view.cell(row, n).parse::<usize>().is_ok());
    let named = |(n, name): (usize, &String)| {
        let heading = Heading::parse(name);
        let measured = format!("{name} {}", names[last]);
        let fits = |v: &Value| v.what.dimension().is_none_or(|d| d == unit.dimension);
        // `rebound` above anything but a count is of a height.
        let counted = matches!(heading.meaning, Meaning::Number { .. }) && !counts(n);
        let of_unit =
            heading.value().is_some_and(fits) || counted && Heading::parse(&measured).value().is_some_and(fits);
        if of_unit && heading.unit.is_none() { measured } else { name.clone() }
    };
    let found: Vec<String> = names[..last].iter().enumerate().map(named).collect();
    (empty && last > 0 && found[..] != names[..last]).then_some(found)
}

/// A unit in a line of them without the brackets around it, and without the word before it: `(cm)`,
/// `in cm`.
pub(super) fn spelt(cell: &str) -> &str {
    let bare = cell.trim_matches(['(', ')', '[', ']']).trim();
    bare.split_once(' ').filter(|(word, _)| Phrase::In.is(word)).map_or(bare, |(_, unit)| unit.trim())
}

/// What stands for the unit of a count, in a line of units.
pub(super) const UNITLESS: [&str; 9] = ["#", "n", "no.", "nr.", "-", "–", "—", "/", "1"];

/// Whether a line holds errors of reading, and units of columns without one, and nothing else: `±1
/// °C`, `(± 0.01 m)`, `cm`.
pub(super) fn of_errors(line: &[String]) -> bool {
    let filled = || line.iter().filter(|cell| !cell.is_empty());
    filled().any(|cell| is_error(cell)) && filled().all(|cell| is_error(cell) || of_units(std::slice::from_ref(cell)))
}

/// Whether a cell is an error of reading.
fn is_error(cell: &str) -> bool {
    let bare = cell.trim_start_matches(['(', '[']);
    let size = ["±", "+/-", "+-"].iter().find_map(|mark| bare.strip_prefix(mark));
    size.is_some_and(|size| size.trim_start().starts_with(|c: char| c.is_ascii_digit()))
}

/// The names of columns, each with the error that stands below the name in `upper` that spans it.
pub(super) fn with_errors(upper: &[String], names: Vec<String>, errors: &[String]) -> Vec<String> {
    let mut spanning = "";
    let mut name = |(n, name): (usize, String)| {
        if upper.get(n).is_some_and(|cell| !cell.is_empty()) {
            spanning = errors.get(n).map_or("", String::as_str);
        }
        match spanning {
            _ if name.is_empty() || spanning.is_empty() => name,
            error if is_error(error) => format!("{name} {error}"),
            unit => format!("{name} ({})", spelt(unit)),
        }
    };
    names.into_iter().enumerate().map(&mut name).collect()
}

/// Whether a line holds units and nothing else.
pub(super) fn of_units(line: &[String]) -> bool {
    let unit = |cell: &str| Unit::parse(spelt(cell)).is_some();
    let cells = || line.iter().filter(|cell| !UNITLESS.contains(&cell.as_str()));
    // In brackets there may be others that are not known.
    let bracketed = |cell: &str| cell.starts_with(['(', '[']) && cell.ends_with([')', ']']);
    // A letter by itself is a sign of what stands below: `t`, `h`.
    let sign =
        |cell: &str| line.len() == 1 && meanings(cell).is_some_and(|atoms| atoms.iter().any(|atom| atom.measures()));
    let known = cells().any(|cell| unit(cell) && !sign(cell));
    known && cells().all(|cell| cell.is_empty() || unit(cell) || bracketed(cell))
}
