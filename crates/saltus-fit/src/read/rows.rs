//! Which rows of a table hold readings, what their first cells call them, and which are left aside.

use std::collections::{HashMap, HashSet};

use super::aside::{LeftAside, Part, Why};
use super::cell::Cell;
use super::columns::{Column, Columns, Kind};
use super::grid::shown;
use super::heading::{Heading, Meaning, Role, Value, What};
use super::judged;
use super::named::{OFF, bounce, names_floor};
use super::region::Region;
use super::units::Unit;
use super::vocabulary::Atom;
use super::words::joined;
use super::written::{rounds_to, step};
use crate::error::TableError;

/// A row of readings.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) at: usize,
    /// The number of the bounce, where the row names it; 0 is the release.
    pub(super) bounce: Option<usize>,
    /// What else its name tells it apart by.
    pub(super) name: String,
    /// The ball or surface that its name is of.
    pub(super) group: String,
}

/// The rows of a table, sorted out.
#[derive(Debug, Default)]
pub(super) struct Rows {
    pub(super) rows: Vec<Row>,
    pub(super) aside: Vec<LeftAside>,
    /// What the scale reads at the floor: the row, and the column of heights.
    pub(super) floor: Option<(usize, usize)>,
    /// Numbers of bounces were rounded to whole ones.
    pub(super) rounded: bool,
    /// A word that stands for the release before bounces that are counted.
    pub(super) start: Option<String>,
}

/// Sorts the rows of a table out.
pub(super) fn sifted(region: &Region<'_>, columns: &Columns) -> Result<Rows, TableError> {
    let mut found = Rows { rows: Vec::with_capacity(region.rows.len()), ..Rows::default() };
    let used: Vec<usize> = (0..columns.columns.len())
        .filter(|&n| !matches!(columns.columns[n].kind, Kind::Aside | Kind::Setting))
        .collect();
    let key = columns.number().map(|(n, _)| n).or(columns.one(&Kind::Label));
    let diagram = columns.number().map_or_else(HashMap::new, |(key, _)| off_a_diagram(region, key));
    let lettered = columns.number().map_or_else(HashMap::new, |(key, _)| lettered(region, key));
    let begun = columns.number().map_or_else(HashMap::new, |(key, _)| begun(region, columns, key));
    let void = judged::void(region, columns);
    let summary = summary(region, columns, &used);
    let told_apart = told_apart(region, columns);
    let codes: Vec<Option<String>> = (0..columns.columns.len()).map(|n| region.codes(n)).collect();
    let code = |n: usize, row: usize| {
        codes.get(n).and_then(Option::as_ref).is_some_and(|letters| region.cell(row, n).starts_with(letters.as_str()))
    };
    let mut last = region.rows.first().map_or(0, |&row| region.view.line(row, 0));
    for &row in &region.rows {
        let line = region.view.line(row, key.unwrap_or(0));
        let apart = line > last + 1 && !region.view.across;
        last = line;
        let numbers = used.iter().any(|&n| region.view.is_number(row, n) || region.view.read(row, n) == Cell::Lost);
        let read = || columns.values().map(|(n, _, _)| n).chain(columns.one(&Kind::Share));
        let values = read().any(|n| region.view.is_number(row, n) || region.view.read(row, n) == Cell::Lost);
        let leave = |why: Why, what: Part| {
            let words: Vec<&str> = region.view.cells(row).filter(|cell| !cell.is_empty()).collect();
            LeftAside::new(what, shown(&words.join(" ")), why).at(line)
        };
        if region.view.cells(row).eq(region.header.iter().map(String::as_str)) {
            found.aside.push(leave(Why::Note, Part::Text));
            continue;
        }
        if void.contains(&row) {
            found.aside.push(leave(Why::Void, Part::Row));
            continue;
        }
        if summary.contains(&row) && (numbers || values) {
            found.aside.push(leave(Why::Statistic, Part::Row));
            continue;
        }
        let predicted = |&n: &usize| Heading::parse(region.cell(row, n)).is_predicted() && !code(n, row);
        if told_apart.iter().any(predicted) {
            found.aside.push(leave(Why::Predicted, Part::Row));
            continue;
        }
        match name(region, columns, row, &used) {
            Some((column, heading)) if numbers || values => {
                if values && is_floor(&heading) {
                    found.floor =
                        columns.values().find(|(n, _, _)| region.view.is_number(row, *n)).map(|(n, _, _)| (row, n));
                    continue;
                }
                // A number of another kind than those above it is none of theirs: `Ball diameter`
                // below times.
                let other = |(n, c, _): (usize, &Column, &Value)| match region.view.read(row, n) {
                    Cell::Number(m) => {
                        m.unit.zip(c.heading.unit).is_some_and(|(own, of)| own.dimension != of.dimension)
                    }
                    _ => false,
                };
                // Elsewhere numbers stand in place of its name.
                let counted = || region.rows.iter().any(|&row| region.view.is_number(row, column));
                // So is what its name gives a unit of: `Mass (kg)`.
                let of_none = |unit: Unit| {
                    columns.values().all(|(_, c, _)| c.unit.is_some_and(|of| of.dimension != unit.dimension))
                };
                let another = columns.values().any(other) || heading.unit.is_some_and(of_none);
                if another && bounce(region.cell(row, column)).is_none() && counted() {
                    found.aside.push(leave(Why::Note, Part::Text));
                    continue;
                }
                // What is a number elsewhere and words here sums the others up, or is no number.
                let placed = bounce(region.cell(row, column)).is_some();
                // `Max` among names of persons is one.
                let person =
                    columns.columns[column].heading.has(Atom::Repeat) && heading.only() && heading.has(Atom::Max);
                if heading.sums_up() && !placed && !person && !code(column, row) {
                    found.aside.push(leave(Why::Statistic, Part::Row));
                    continue;
                }
                if Some(column) == key
                    && apart
                    && !placed
                    && matches!(columns.columns[column].kind, Kind::Number { .. })
                {
                    found.aside.push(leave(Why::NotUnderstood, Part::Row));
                    continue;
                }
            }
            Some((column, _)) if columns.columns[column].kind != Kind::Event => {
                found.aside.push(leave(Why::Note, Part::Text));
                continue;
            }
            _ => {}
        }
        let event = columns.one(&Kind::Event).is_some_and(|n| !region.cell(row, n).is_empty());
        let empty = read().chain(columns.one(&Kind::Frame)).all(|n| region.cell(row, n).is_empty());
        if empty && !event {
            if used.iter().any(|&n| !region.cell(row, n).is_empty()) {
                found.aside.push(leave(Why::Empty, Part::Row));
            }
            continue;
        }
        if sums(region, columns, row, &found.rows) {
            found.aside.push(leave(Why::Statistic, Part::Row));
            continue;
        }
        let read = named(region, columns, row, key, [&diagram, &lettered, &begun])?;
        found.rounded |= diagram.contains_key(&row);
        found.start = found.start.or(begun.get(&row).and(key).map(|key| shown(region.cell(row, key))));
        found.rows.push(read);
    }
    Ok(found)
}

/// The rows that stand apart below the others, each named as a count or a statistic, one of them a
/// mean or an error: `n`, `mean`, `max`.
fn summary(region: &Region<'_>, columns: &Columns, used: &[usize]) -> HashSet<usize> {
    let line = |row: usize| region.view.line(row, 0);
    let statistic = |row: usize| {
        let (_, heading) = name(region, columns, row, used)?;
        (heading.sums_up() || heading.has(Atom::Number)).then(|| event_named(&heading) || heading.has(Atom::Median))
    };
    let parts: Vec<&[usize]> = region.rows.chunk_by(|&a, &b| line(b) <= line(a) + 1).collect();
    let below = parts.into_iter().skip(1).filter(|_| !region.view.across);
    let all = |part: &&[usize]| {
        let named: Option<Vec<bool>> = part.iter().map(|&row| statistic(row)).collect();
        named.is_some_and(|means| means.contains(&true))
    };
    below.filter(all).flatten().copied().collect()
}

/// The columns whose words tell rows apart: settings, and those that are left aside and name every
/// row, some alike: `source` above `simulation` and `experiment`.
fn told_apart(region: &Region<'_>, columns: &Columns) -> Vec<usize> {
    let words = |n: usize| {
        let cells = || region.rows.iter().map(|&row| region.cell(row, n));
        let named = cells().all(|cell| !cell.is_empty() && !cell.contains(|c: char| c.is_ascii_digit()));
        named && cells().collect::<HashSet<&str>>().len() < region.rows.len()
    };
    let kind = |n: usize| &columns.columns[n].kind;
    (0..columns.columns.len()).filter(|&n| *kind(n) == Kind::Setting || *kind(n) == Kind::Aside && words(n)).collect()
}

/// The words that a row begins with, and what they mean; those of trials may be anything.
fn name(region: &Region<'_>, columns: &Columns, row: usize, used: &[usize]) -> Option<(usize, Heading)> {
    let words = |n: &&usize| {
        let cell = region.cell(row, **n);
        !cell.is_empty() && region.view.read(row, **n) == Cell::Words && super::cell::clock(cell).is_none()
    };
    // Text in a column of numbers names the row only if it is the first in it.
    let column = *used.iter().find(words)?;
    let before = used.iter().take_while(|&&n| n != column).any(|&n| region.view.is_number(row, n));
    let event = columns.columns[column].kind == Kind::Event;
    let heading = Heading::parse(region.cell(row, column));
    (!before && (!event || heading.sums_up() && event_named(&heading))).then_some((column, heading))
}

/// `Mean` in a column of events, but not `max`, which is the apex.
fn event_named(heading: &Heading) -> bool {
    [Atom::Mean, Atom::Error, Atom::Derived].iter().any(|atom| heading.has(*atom))
}

/// Whether a row tells where the floor is on the scale.
fn is_floor(heading: &Heading) -> bool {
    matches!(heading.meaning, Meaning::Setting) && names_floor(&heading.text)
}

/// A row without a name below rows with one, whose numbers are the means of those above, rounded to
/// the last digit of their column.
fn sums(region: &Region<'_>, columns: &Columns, row: usize, above: &[Row]) -> bool {
    let key = columns.columns.iter().position(|c| matches!(c.kind, Kind::Trial | Kind::Number { .. } | Kind::Label));
    let Some(key) = key.filter(|&key| region.cell(row, key).is_empty()) else { return false };
    if above.len() < 2 || above.iter().any(|r| region.cell(r.at, key).is_empty()) {
        return false;
    }
    let is_mean = |column: usize| {
        let own = region.view.number(row, column)?;
        let all: Vec<f64> = above.iter().filter_map(|r| region.view.number(r.at, column)).collect();
        #[allow(clippy::cast_precision_loss)] // rows of a table
        let mean = Some(all.iter().sum::<f64>() / all.len() as f64).filter(|_| !all.is_empty())?;
        Some(rounds_to(mean, own, step(all.into_iter().chain([own]))))
    };
    let mut found = columns.values().filter_map(|(n, _, _)| is_mean(n)).peekable();
    found.peek().is_some() && found.all(|mean| mean)
}

fn named(
    region: &Region<'_>,
    columns: &Columns,
    row: usize,
    key: Option<usize>,
    counted: [&HashMap<usize, usize>; 3],
) -> Result<Row, TableError> {
    let mut found = Row { at: row, bounce: None, name: String::new(), group: String::new() };
    let Some(key) = key else { return Ok(found) };
    let cell = region.cell(row, key);
    let number = matches!(columns.columns[key].kind, Kind::Number { .. });
    found.bounce = bounce(cell).or_else(|| counted.iter().find_map(|numbers| numbers.get(&row).copied()));
    if found.bounce.is_some() {
        return Ok(found);
    }
    // `First drop` above `first bounce`.
    let heading = Heading::parse(cell);
    if number && heading.unknown.is_empty() && heading.has(Atom::Release) && !heading.has(Atom::Impact) {
        found.bounce = Some(0);
        return Ok(found);
    }
    if number {
        let message = match region.view.read(row, key) {
            Cell::Empty => "the cell is empty".to_owned(),
            Cell::Number(_) => "the number of a bounce is 0, 1, 2 and so on".to_owned(),
            _ => format!("'{}' is not a number", shown(cell)),
        };
        return Err(region
            .view
            .error(row, key, message)
            .help("count the bounces in whole numbers, 0 being the release"));
    }
    found.group = heading.value().map_or(String::new(), |v| v.group.clone());
    cell.clone_into(&mut found.name);
    Ok(found)
}

/// The numbers of bounces behind letters that are the same in all cells, `M1`, `M2`, row by row,
/// one after the other.
fn lettered(region: &Region<'_>, key: usize) -> HashMap<usize, usize> {
    let parts = |row: usize| joined(region.cell(row, key)).and_then(|(letters, n)| Some((letters, n.parse().ok()?)));
    let all: Option<Vec<(&str, usize)>> = region.rows.iter().map(|&row| parts(row)).collect();
    let one =
        |all: &Vec<(&str, usize)>| all.windows(2).all(|pair| pair[0].0 == pair[1].0 && pair[0].1 + 1 == pair[1].1);
    let all = all.filter(one).into_iter().flatten();
    region.rows.iter().copied().zip(all.map(|(_, number)| number)).collect()
}

/// The rows of releases in a count of bounces that has one word in their place, `start`, `1`, `2`:
/// whatever it says, it stands before the first bounce, and its height is above that.
fn begun(region: &Region<'_>, columns: &Columns, key: usize) -> HashMap<usize, usize> {
    let cell = |row: usize| region.cell(row, key);
    let read = |v: &Value| v.role == Role::Reading && matches!(v.what, What::Height | What::Unsaid);
    let number = |row: usize, n: usize| region.view.number(row, n);
    let heights = || columns.values().filter(|(_, _, v)| read(v)).map(|(n, _, _)| n);
    // Remarks below hold no reading.
    let rows = region.rows.iter().copied().filter(|&row| heights().any(|n| number(row, n).is_some()));
    let rows: Vec<usize> = rows.collect();
    let word = rows.first().map_or("", |&row| cell(row));
    let named = rows.first().is_some_and(|&row| region.view.read(row, key) == Cell::Words) && bounce(word).is_none();
    let starts = |row: usize| cell(row) == word;
    let follows = |pair: &[usize]| match (starts(pair[0]), starts(pair[1])) {
        (true, next) => !next && bounce(cell(pair[1])) == Some(1),
        (false, true) => true,
        // A bounce whose height was not read leaves its number out.
        (false, false) => bounce(cell(pair[0])) < bounce(cell(pair[1])),
    };
    let falls = |pair: &[usize]| {
        let mut pairs = heights().filter_map(|n| number(pair[0], n).zip(number(pair[1], n))).peekable();
        pairs.peek().is_some() && pairs.all(|(before, after)| after < before)
    };
    let begun = |pair: &[usize]| !starts(pair[0]) || falls(pair);
    let counted = named && rows.len() > 2 && rows.windows(2).all(|pair| follows(pair) && begun(pair));
    rows.into_iter().filter(|&row| counted && starts(row)).map(|row| (row, 0)).collect()
}

/// The numbers of bounces that were read off a diagram, row by row: near whole numbers, each near
/// another one. None where a cell holds anything else, or all are whole.
fn off_a_diagram(region: &Region<'_>, key: usize) -> HashMap<usize, usize> {
    let near = |row: usize| match region.view.read(row, key) {
        Cell::Number(m) if m.unit.is_none() && (m.value - m.value.round()).abs() <= OFF && m.value > -OFF => {
            // In range and whole: the cast is exact.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            Some((row, m.value.round().clamp(0.0, 1e6) as usize))
        }
        _ => None,
    };
    let whole = region.rows.iter().all(|&row| bounce(region.cell(row, key)).is_some());
    let all: Option<Vec<(usize, usize)>> = region.rows.iter().map(|&row| near(row)).collect();
    let all = all.filter(|all| !whole && all.windows(2).all(|pair| pair[1].1 > pair[0].1));
    all.into_iter().flatten().collect()
}
