//! Where in a text its tables lie: which lines name the columns, and which rows stand below them.

use std::collections::BTreeSet;

use super::aside::{LeftAside, Part, Why};
use super::cell::Cell;
use super::columns::{LEVEL, of_samples};
use super::grid::{View, shown};
use super::heading::{Heading, Meaning};
use super::units::{Dimension, Unit};
use crate::error::TableError;

/// One table of a text.
#[derive(Clone)]
pub(super) struct Region<'a> {
    pub(super) view: View<'a>,
    /// What tells it from the other tables of the text.
    pub(super) label: String,
    /// A name for each column; a column without one is not part of this table.
    pub(super) header: Vec<String>,
    /// The row that the names stand in.
    pub(super) header_row: usize,
    pub(super) rows: Vec<usize>,
    /// The units of times and lengths, where neither header nor options name one.
    pub(super) units: (Option<Unit>, Option<Unit>),
    /// Rows are frames, and no column counts them.
    pub(super) frames: bool,
    /// How long a frame lasts, s.
    pub(super) frame: Option<f64>,
    /// The columns were chosen here, `--column` heeded.
    pub(super) chosen: bool,
    /// The names were given beside the file.
    pub(super) given: bool,
    pub(super) aside: Vec<LeftAside>,
}

impl<'a> Region<'a> {
    pub(super) fn new(view: View<'a>, header: Vec<String>, header_row: usize, rows: Vec<usize>) -> Self {
        let label = String::new();
        let (units, aside) = ((None, None), Vec::new());
        Self {
            view,
            label,
            header,
            header_row,
            rows,
            units,
            frames: false,
            frame: None,
            chosen: false,
            given: false,
            aside,
        }
    }

    pub(super) fn cell(&self, row: usize, column: usize) -> &str {
        self.view.cell(row, column)
    }

    /// Whether the cells of a column count something: whole numbers from 0 or 1 on, none of them
    /// left out.
    pub(super) fn counts(&self, column: usize) -> bool {
        let cells = self.rows.iter().map(|&row| self.cell(row, column)).filter(|cell| !cell.is_empty());
        let numbers: Option<BTreeSet<usize>> = cells.map(|cell| cell.parse().ok()).collect();
        numbers.is_some_and(|numbers| {
            let first = numbers.first().copied().unwrap_or(2);
            first < 2 && numbers.iter().enumerate().all(|(n, number)| *number == first + n)
        })
    }

    /// An error of the table as a whole.
    pub(super) fn error(&self, message: impl Into<String>) -> TableError {
        TableError::new(self.view.grid.name, message)
    }

    /// An error at the name of a column.
    pub(super) fn header_error(&self, column: usize, message: impl Into<String>) -> TableError {
        self.view.error(self.header_row, column, message)
    }

    /// An error at a column in the line `line`.
    pub(super) fn line_error(&self, line: u64, column: usize, message: impl Into<String>) -> TableError {
        let row = if self.view.across { line_across(self, line) } else { self.view.grid.row_of(line) };
        self.view.error(row, column, message)
    }
}

fn line_across(region: &Region<'_>, line: u64) -> usize {
    region.rows.iter().copied().find(|&row| region.view.line(row, 0) == line).unwrap_or(region.header_row)
}

/// Lines that may stand above the names of the columns, and between two tables.
const HEAD: usize = 60;

/// A header: its names, the first of its lines, the first row below, and how much of it is
/// understood.
struct Header {
    names: Vec<String>,
    at: usize,
    below: usize,
    score: usize,
}

/// The tables of a view, each below the names of its columns; none where no names are understood.
pub(super) fn tables<'a>(view: View<'a>) -> Vec<Region<'a>> {
    let (mut found, mut from): (Vec<Region<'a>>, usize) = (Vec::new(), 0);
    let end = view.rows();
    while let Some(header) = next_header(view, from, end, found.last()) {
        let above = texts(view, from..header.at);
        if let Some(last) = found.last_mut() {
            last.rows.retain(|row| *row < header.at);
        }
        // Remarks between names and units.
        let within = (header.at + 1..header.below).filter(|&row| remark(view, row, &header.names));
        let remarks: Vec<LeftAside> = within.flat_map(|row| texts(view, row..row + 1)).collect();
        let mut region = Region::new(view, header.names, header.at, (header.below..end).collect());
        region.aside = above.into_iter().chain(remarks).collect();
        found.push(region);
        from = header.below;
    }
    found
}

/// The region below the line that comes nearest to a header.
pub(super) fn nearest(view: View<'_>) -> Region<'_> {
    let end = view.rows();
    let numbers = |row: usize| (0..view.width(row)).any(|c| view.is_number(row, c));
    let row = (0..end.min(HEAD))
        .find(|&row| names_only(view, row) && view.width(row) > 1 && row + 1 < end && numbers(row + 1));
    let row =
        row.or((0..end.min(HEAD)).find(|&row| names_only(view, row) && row + 1 < end && numbers(row + 1))).unwrap_or(0);
    Region::new(view, view.cells(row).map(str::to_owned).collect(), row, (row + 1..end).collect())
}

/// The lines of text in rows of `span`, as left aside.
fn texts(view: View<'_>, span: std::ops::Range<usize>) -> Vec<LeftAside> {
    let text = |row: usize| {
        let words: Vec<&str> = view.cells(row).filter(|cell| !cell.is_empty()).collect();
        // A number of something else, such as a frame rate, is none of a table.
        let other = |c: usize| matches!(view.read(row, c), Cell::Number(m) if m.unit.is_some_and(|u| u.dimension == Dimension::Other));
        let numbers = (0..view.width(row)).filter(|&c| view.is_number(row, c) && !other(c)).count();
        (numbers * 2 <= words.len())
            .then(|| LeftAside::new(Part::Text, shown(&words.join(" ")), Why::Note).at(view.line(row, 0)))
    };
    span.filter_map(text).collect()
}

/// The best header from row `from` on; below a table the next, which has to be as good as a first.
fn next_header(view: View<'_>, from: usize, end: usize, before: Option<&Region<'_>>) -> Option<Header> {
    let mut best: Option<Header> = None;
    let last = if before.is_some() { end } else { end.min(from + HEAD) };
    // A name by itself names no rows of several cells.
    let filled = |row: usize| view.cells(row).filter(|cell| !cell.is_empty()).count();
    let wide = |row: usize| (row + 1..end).find(|&n| !names_only(view, n)).is_some_and(|n| filled(n) > 1);
    for row in from..last {
        if before.is_some_and(|b| remark(view, row, &b.header) && wide(row)) {
            continue;
        }
        for header in headers(view, row, end) {
            // Below a table a single word, or names without rows, are no header.
            let next = before.is_none()
                || header.below < end && (0..view.width(header.below)).any(|c| view.is_number(header.below, c));
            let least = if before.is_some() { VALUE } else { SHARE };
            let values = header.score >= least && next;
            if values && best.as_ref().is_none_or(|b| header.score > b.score) {
                best = Some(header);
            }
        }
        // Below a table the next header ends it, however good those further down are.
        if before.is_some() && best.is_some() {
            break;
        }
        // A better header stands next to the first, not below its rows.
        if best.as_ref().is_some_and(|b| row > b.below + 1) {
            break;
        }
    }
    best
}

/// What a column of numbers adds to the score of a header; a column of names adds one.
const VALUE: usize = 100;
/// What a column of ratios of heights, or of energies, adds, which are read where nothing else is.
const SHARE: usize = 50;

/// The headers that may begin in a row: one line, or two.
fn headers(view: View<'_>, row: usize, end: usize) -> Vec<Header> {
    let mut found = Vec::new();
    if !names_only(view, row) {
        if let Some(header) = counted(view, row, end) {
            found.push(header);
        }
        return found;
    }
    let line = |n: usize| -> Vec<String> { view.cells(n).map(str::to_owned).collect() };
    let one = line(row);
    let below = |n: usize| n < end && names_only(view, n);
    // Units are no names; and one name alone above several is a title.
    let names = |n: usize| view.cells(n).filter(|cell| !cell.is_empty()).count();
    let titled =
        names(row) == 1 && !one[0].is_empty() && row + 1 < end && names_only(view, row + 1) && names(row + 1) > 1;
    if of_units(&one) || titled || Unit::listed(&one.join(" ")).is_some() {
        return found;
    }
    let mut push = |names: Vec<String>, next: usize| {
        let score = score(&names);
        let counted = measured(view, &names, next) || sampled(view, &names, next..end);
        let score = if (1..VALUE).contains(&score) && counted { score + VALUE } else { score };
        let numbers = |n: usize| (0..view.width(n).max(1)).any(|c| view.is_number(n, c));
        // A row of words may stand between, such as of units that are not known, and remarks; a
        // header without rows is one too.
        let remarks = (next..end).take_while(|&n| remark(view, n, &names)).count();
        let rows = next + remarks;
        if score > 0 && (rows >= end || numbers(rows) || rows + 1 < end && numbers(rows + 1) || events(view, rows)) {
            found.push(Header { names, at: row, below: next, score });
        }
    };
    push(one.clone(), row + 1);
    if let Some(names) = (row + 1 < end).then(|| numbered(view, &one, row + 1)).flatten() {
        push(names, row + 2);
    }
    // Units may stand below remarks.
    let remarks = (row + 1..end).take_while(|&n| remark(view, n, &one)).count();
    let units = row + 1 + remarks;
    if remarks > 0
        && below(units)
        && of_units(&line(units))
        && let Some(names) = both(&one, &line(units))
    {
        push(names, units + 1);
    }
    if below(row + 1)
        && !events(view, row + 1)
        && let Some(names) = both(&one, &line(row + 1))
    {
        if below(row + 2)
            && let Some(names) = both(&names, &line(row + 2)).filter(|_| of_units(&line(row + 2)))
        {
            push(names, row + 3);
        }
        push(names, row + 2);
    }
    found
}

/// Whether a row holds a cell of words and nothing else, where several columns are named: it is no
/// header of theirs, nor of a table below them.
fn remark(view: View<'_>, row: usize, names: &[String]) -> bool {
    names.iter().filter(|name| !name.is_empty()).count() > 1
        && names_only(view, row)
        && view.cells(row).filter(|cell| !cell.is_empty()).count() == 1
        && !events(view, row)
        && !of_units(&view.cells(row).map(str::to_owned).collect::<Vec<_>>())
}

/// Whether a cell of a row bears a unit, below a name that is understood.
fn measured(view: View<'_>, names: &[String], row: usize) -> bool {
    names.iter().enumerate().any(|(n, name)| {
        let unit = matches!(view.read(row, n), Cell::Number(m) if m.unit.is_some_and(|u| u.dimension != Dimension::Other && !u.unscaled()));
        unit && Heading::parse(name).understood()
    })
}

/// Whether a name of samples stands above numbers of them, in the first rows.
fn sampled(view: View<'_>, names: &[String], rows: std::ops::Range<usize>) -> bool {
    names
        .iter()
        .enumerate()
        .any(|(n, name)| of_samples(&Heading::parse(name), rows.clone().take(2).map(|row| view.cell(row, n))))
}

/// Whether a row holds the name of an event and nothing else.
fn events(view: View<'_>, row: usize) -> bool {
    let alone = (1..view.width(row)).all(|n| view.cell(row, n).is_empty());
    alone && matches!(view.cell(row, 0).to_lowercase().as_str(), "release" | "drop" | "start" | "contact" | "apex")
}

/// Whether a row holds words and no number.
fn names_only(view: View<'_>, row: usize) -> bool {
    let (mut words, mut numbers) = (0, 0);
    for column in 0..view.width(row) {
        numbers += usize::from(view.is_number(row, column));
        words += usize::from(!view.cell(row, column).is_empty());
    }
    words > 0 && numbers == 0
}

/// `Drop height (cm),1,2,3` above rows of numbers: the trials are only counted.
fn counted(view: View<'_>, row: usize, end: usize) -> Option<Header> {
    let width = view.width(row);
    let named = (0..width).take_while(|&c| !view.cell(row, c).is_empty() && !view.is_number(row, c)).count();
    let count = (named..width).take_while(|&c| view.cell(row, c).parse() == Ok(c + 1 - named)).count();
    let rest = (named + count..width).all(|c| !view.is_number(row, c));
    if named == 0 || count < 2 || !rest || row + 1 >= end || !view.is_number(row + 1, 0) {
        return None;
    }
    let first = Heading::parse(view.cell(row, 0));
    let of = if falling(view, row + 1..end, named, count) { "bounce" } else { "trial" };
    let names: Vec<String> = (0..width)
        .map(|c| match view.cell(row, c) {
            cell if (named..named + count).contains(&c) => format!("{of} {cell}"),
            cell => cell.to_owned(),
        })
        .collect();
    let score = score(&names);
    first.understood().then_some(Header { names, at: row, below: row + 1, score })
}

/// Whether numbers fall from column to column in every row that has any, each to less than `LEVEL`
/// of the one before: bounces one after the other, and no repeats.
fn falling(view: View<'_>, rows: std::ops::Range<usize>, first: usize, count: usize) -> bool {
    let number = |row: usize, column: usize| match view.read(row, column) {
        Cell::Number(m) => Some(m.value),
        _ => None,
    };
    let mut pairs = rows
        .flat_map(|row| (first + 1..first + count).filter_map(move |c| number(row, c - 1).zip(number(row, c))))
        .peekable();
    pairs.peek().is_some() && pairs.all(|(before, after)| after < LEVEL * before)
}

/// `Rebound (cm)` over `1,2,3`: the columns that a name spans are counted in the line below it.
fn numbered(view: View<'_>, upper: &[String], row: usize) -> Option<Vec<String>> {
    let width = view.width(row).max(upper.len());
    let above = |n: usize| upper.get(n).filter(|cell| !cell.is_empty());
    let (mut spanning, mut count, mut names, mut counted) = (String::new(), 0, Vec::new(), 0);
    for n in 0..width {
        if let Some(name) = above(n) {
            (spanning, count) = (name.clone(), 0);
        }
        let cell = view.cell(row, n);
        if cell.is_empty() {
            names.push(above(n).cloned().unwrap_or_default());
            continue;
        }
        count += 1;
        if cell.parse() != Ok(count) || spanning.is_empty() {
            return None;
        }
        counted += usize::from(count > 1);
        names.push(format!("{spanning} {count}"));
    }
    (counted > 0 && view.cell(row, 0).is_empty()).then_some(names)
}

/// How much of a header is understood.
fn score(names: &[String]) -> usize {
    let of = |name: &String| {
        let heading = Heading::parse(name);
        match heading.meaning {
            _ if !heading.unknown.is_empty() => 0,
            Meaning::Value(_) => VALUE + usize::from(heading.unit.is_some()),
            // A frame tells a time.
            Meaning::Frame => VALUE,
            Meaning::Aside(_) if heading.share.is_some() || heading.energy.is_some() => SHARE,
            Meaning::Empty | Meaning::Aside(_) => 0,
            _ => 1,
        }
    };
    names.iter().map(of).sum()
}

/// The names that two lines give together; `None` where the upper is a title.
fn both(upper: &[String], lower: &[String]) -> Option<Vec<String>> {
    let width =
        upper.iter().rposition(|cell| !cell.is_empty())?.max(lower.iter().rposition(|cell| !cell.is_empty())?) + 1;
    let cell = |line: &[String], n: usize| line.get(n).cloned().unwrap_or_default();
    if of_units(lower) {
        let name = |n: usize| match (cell(upper, n), cell(lower, n)) {
            (name, unit) if !name.is_empty() && !unit.is_empty() && !UNITLESS.contains(&unit.as_str()) => {
                format!("{name} ({})", unit.trim_matches(['(', ')', '[', ']']).trim())
            }
            (name, _) => name,
        };
        // What has a unit has a name.
        return (0..width)
            .all(|n| cell(lower, n).is_empty() || !cell(upper, n).is_empty())
            .then(|| (0..width).map(name).collect());
    }
    // A title stands alone, above the first name.
    let first = |line: &[String]| line.iter().position(|cell| !cell.is_empty());
    if upper.iter().filter(|cell| !cell.is_empty()).count() == 1 && first(upper) <= first(lower) {
        return None;
    }
    // A merged cell holds its text in the first of the columns that it spans.
    let mut spanning = String::new();
    let above: Vec<String> = (0..width)
        .map(|n| {
            if !cell(upper, n).is_empty() {
                spanning = cell(upper, n);
            } else if cell(lower, n).is_empty() {
                spanning.clear();
            }
            spanning.clone()
        })
        .collect();
    let merged = (0..width).any(|n| cell(upper, n).is_empty() != cell(lower, n).is_empty());
    let repeated = (0..width).any(|n| !cell(lower, n).is_empty() && (0..n).any(|m| cell(lower, m) == cell(lower, n)));
    let name = |n: usize| match (above[n].as_str(), cell(lower, n)) {
        (name, lower) if lower.is_empty() => name.to_owned(),
        ("", lower) => lower,
        // `Trial 1` above `Time (s)`, and `Trial 2` above another: runs side by side.
        (name, lower) if repeated => format!("{name}: {lower}"),
        (name, lower) => spanned(name, &lower),
    };
    merged.then(|| (0..width).map(name).collect())
}

/// What an upper name adds to a lower: `Rebound (cm)` above `Trial 1`, whose unit is for both.
fn spanned(name: &str, lower: &str) -> String {
    let own = Heading::parse(lower);
    let said = own.value().is_some_and(|v| v.what != super::heading::What::Unsaid);
    if said || matches!(own.meaning, Meaning::Aside(_)) && own.unknown.is_empty() {
        lower.to_owned()
    } else {
        format!("{lower}, {name}")
    }
}

/// What stands for the unit of a count, in a line of units.
const UNITLESS: [&str; 9] = ["#", "n", "no.", "nr.", "-", "–", "—", "/", "1"];

/// Whether a line holds units and nothing else.
fn of_units(line: &[String]) -> bool {
    let unit = |cell: &str| Unit::parse(cell.trim_matches(['(', ')', '[', ']'])).is_some();
    let line = || line.iter().filter(|cell| !UNITLESS.contains(&cell.as_str()));
    // In brackets there may be others that are not known.
    let bracketed = |cell: &str| cell.starts_with(['(', '[']) && cell.ends_with([')', ']']);
    let known = line().any(|cell| unit(cell));
    known && line().all(|cell| cell.is_empty() || unit(cell) || bracketed(cell))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::grid::Grid;

    fn names(text: &str) -> (Vec<String>, usize, usize) {
        let grid = Grid::open("a", None, text).unwrap();
        let found = tables(View { grid: &grid, across: false });
        let region = found.first().unwrap_or_else(|| panic!("{text}"));
        (region.header.clone(), region.header_row, region.rows[0])
    }

    #[test]
    fn two_lines_are_one_header() {
        for (text, expected, at) in [
            ("bounce,height_cm\n0,100", "bounce|height_cm", (0, 1)),
            ("My drops,\nbounce,height_cm\n0,100", "bounce|height_cm", (1, 2)),
            ("time,height\ns,cm\n0,100", "time (s)|height (cm)", (0, 2)),
            ("bounce,height\n,cm\n0,100", "bounce|height (cm)", (0, 2)),
            ("time,height\n(s),[cm]\n0,100", "time (s)|height (cm)", (0, 2)),
            ("Mass (g),58\nbounce,height_cm\n0,100", "bounce|height_cm", (1, 2)),
            (
                "Drop (in),Rebound (in),\n,Trial 1,Trial 2\n72,40,41",
                "Drop (in)|Trial 1, Rebound (in)|Trial 2, Rebound (in)",
                (0, 2),
            ),
            (
                "Title,,\n,Rebound (in),\nDrop (in),Trial 1,Trial 2\n72,40,41",
                "Drop (in)|Trial 1, Rebound (in)|Trial 2, Rebound (in)",
                (1, 3),
            ),
            (
                "Trial 1,,Trial 2,\nTime (s),y (m),Time (s),y (m)\n0,1,0,1",
                "Trial 1: Time (s)|Trial 1: y (m)|Trial 2: Time (s)|Trial 2: y (m)",
                (0, 2),
            ),
            ("Drop height (cm),1,2,3\n100,64,63,65", "Drop height (cm)|trial 1|trial 2|trial 3", (0, 1)),
        ] {
            let (names, header, rows) = names(text);
            assert_eq!(names.join("|"), expected, "{text}");
            assert_eq!((header, rows), at, "{text}");
        }
    }
}
