//! Where in a text its tables lie: which lines name the columns, and which rows stand below them.

mod counted;
mod header;
mod keys;
mod legend;
mod own_lines;

use std::collections::BTreeSet;
use std::ops::Range;

use super::aside::{LeftAside, Part, Why};
use super::cell::{Cell, clock};
use super::datum::Zero;
use super::grid::{View, shown};
use super::heading::{DropHeight, Heading};
use super::units::{Dimension, Unit};
use crate::error::TableError;
pub(super) use header::repeated;
use header::{Header, SHARE, VALUE, both, headers, names_only, remark};
use legend::Legend;
use own_lines::of_units;

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
    /// The unit of all speeds, where a line states one and none of times or lengths.
    pub(super) speed: Option<Unit>,
    /// The height of release that stands above.
    pub(super) drop: Option<DropHeight>,
    /// What the scale of heights reads at the floor, as a line states.
    pub(super) zero: Option<Zero>,
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
            speed: None,
            drop: None,
            zero: None,
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

    /// The numbers of a column in the rows that hold readings, each in its own unit.
    pub(super) fn numbers(&self, column: usize) -> impl Iterator<Item = f64> {
        self.rows.iter().filter_map(move |&row| self.view.number(row, column))
    }

    /// The time in a cell, s: a number in its unit, or that of a clock, `1:02.35`.
    pub(super) fn time(&self, row: usize, column: usize, unit: Unit) -> Option<f64> {
        self.view.number(row, column).map(|time| unit.si(time)).or_else(|| clock(self.cell(row, column)))
    }

    /// Whether all numbers of a column are the same, there being several.
    pub(super) fn constant(&self, column: usize) -> bool {
        let mut numbers = self.numbers(column);
        let first = numbers.next();
        let mut rest = numbers.peekable();
        rest.peek().is_some() && rest.all(|n| Some(n) == first)
    }

    /// Whether the cells of a column count something: whole numbers from 0 or 1 on, none of them
    /// left out, beside the names of rows that sum others up, and remarks.
    pub(super) fn counts(&self, column: usize) -> bool {
        let counted = |row: usize| self.cell(row, column).parse::<usize>().ok();
        let remark = |row: usize| !(0..self.header.len()).any(|n| self.view.is_number(row, n));
        let named = |row: usize| Heading::parse(self.cell(row, column)).sums_up() || remark(row);
        let cells = self.rows.iter().copied().filter(|&row| !self.cell(row, column).is_empty());
        let cells = cells.filter(|&row| counted(row).is_some() || !named(row));
        let numbers: Option<BTreeSet<usize>> = cells.map(counted).collect();
        numbers.is_some_and(|numbers| {
            let first = numbers.first().copied().unwrap_or(2);
            first < 2 && numbers.iter().enumerate().all(|(n, number)| *number == first + n)
        })
    }

    /// The letters of codes that are numbered in a column, `ITF-` of `ITF-400` and `ITF-401`: those
    /// of most of its cells are the same, and say nothing of the row.
    pub(super) fn codes(&self, column: usize) -> Option<String> {
        let letters = |cell: &str| {
            let letters = cell.trim_end_matches(|c: char| c.is_ascii_digit());
            let bare = letters.trim_end_matches(['-', '_', '#', ' ', '.', '/']);
            let code = letters.len() < cell.len() && !bare.is_empty() && bare.chars().all(|c| c.is_ascii_uppercase());
            code.then(|| letters.to_owned())
        };
        let cells: Vec<&str> = self.rows.iter().map(|&row| self.cell(row, column)).collect();
        let codes: Vec<(&str, String)> = cells.iter().filter_map(|cell| Some((*cell, letters(cell)?))).collect();
        let apart: BTreeSet<&str> = codes.iter().map(|(cell, _)| *cell).collect();
        let alike = codes.windows(2).all(|pair| pair[0].1 == pair[1].1) && apart.len() == codes.len();
        let most = codes.len() > 1 && 2 * codes.len() > cells.len();
        codes.first().filter(|_| alike && most).map(|(_, letters)| letters.clone())
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
        self.view.error(self.row_of(line), column, message)
    }

    /// The row of a reading in the line `line`.
    pub(super) fn row_of(&self, line: u64) -> usize {
        if self.view.across { line_across(self, line) } else { self.view.grid.row_of(line) }
    }
}

fn line_across(region: &Region<'_>, line: u64) -> usize {
    region.rows.iter().copied().find(|&row| region.view.line(row, 0) == line).unwrap_or(region.header_row)
}

/// Lines that may stand above the names of the columns, and between two tables.
const HEAD: usize = 60;

/// The tables of a view, each below the names of its columns; none where no names are understood.
pub(super) fn tables<'a>(view: View<'a>) -> Vec<Region<'a>> {
    let (mut found, mut from): (Vec<Region<'a>>, usize) = (Vec::new(), 0);
    let (end, legend) = (view.rows(), Legend::of(view));
    while let Some(header) = next_header(view, &legend, from, end, found.last()) {
        let above = texts(view, from..header.at);
        if let Some(last) = found.last_mut() {
            last.rows.retain(|row| *row < header.at);
        }
        // Remarks between names and units.
        let within = (header.at + 1..header.below).filter(|&row| remark(view, row, &header.names));
        let remarks: Vec<LeftAside> = within.flat_map(|row| texts(view, row..row + 1)).collect();
        let mut region = Region::new(view, header.names, header.at, (header.below..end).collect());
        region.aside = above.into_iter().chain(remarks).collect();
        units_below(&mut region);
        keys::leave(&mut region);
        found.push(region);
        from = header.below;
    }
    found
}

/// A row of units may stand among those of the numbers, or below them.
fn units_below(region: &mut Region<'_>) {
    let line = |row: usize| region.view.cells(row).map(str::to_owned).collect::<Vec<String>>();
    let Some(at) =
        region.rows.iter().copied().skip(1).find(|&row| names_only(region.view, row) && of_units(&line(row)))
    else {
        return;
    };
    let known = |name: &String| Heading::parse(name).unit.is_some();
    if let Some(names) = both(&region.header, &line(at)).filter(|_| !region.header.iter().any(known)) {
        region.header = names;
        region.rows.retain(|row| *row != at);
    }
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
fn texts(view: View<'_>, span: Range<usize>) -> Vec<LeftAside> {
    let text = |row: usize| {
        let words: Vec<&str> = view.cells(row).filter(|cell| !cell.is_empty()).collect();
        // A number of something else, such as a frame rate, is none of a table.
        let other = |c: usize| matches!(view.read(row, c), Cell::Number(m) if m.unit.is_some_and(|u| u.dimension == Dimension::Other));
        // In brackets stands what was written before them, in another unit.
        let repeat = |c: usize| c > 0 && view.cell(row, c).starts_with('(') && view.is_number(row, c - 1);
        let numbers = (0..view.width(row)).filter(|&c| view.is_number(row, c) && !other(c) && !repeat(c)).count();
        (numbers * 2 <= words.len())
            .then(|| LeftAside::new(Part::Text, shown(&words.join(" ")), Why::Note).at(view.line(row, 0)))
    };
    span.filter_map(text).collect()
}

/// The best header from row `from` on; below a table the next, which has to be as good as a first.
fn next_header(
    view: View<'_>,
    legend: &Legend,
    from: usize,
    end: usize,
    before: Option<&Region<'_>>,
) -> Option<Header> {
    let mut best: Option<Header> = None;
    let last = if before.is_some() { end } else { end.min(from + HEAD) };
    // A name by itself names no rows of several cells.
    let filled = |row: usize| view.cells(row).filter(|cell| !cell.is_empty()).count();
    let wide = |row: usize| (row + 1..end).find(|&n| !names_only(view, n)).is_some_and(|n| filled(n) > 1);
    // Names stand next to their numbers, but for remarks: what stands above a line that names each
    // of its numbers is a title, whatever it says.
    let numbers = |row: usize| row < end && (0..view.width(row)).any(|c| view.is_number(row, c));
    let rows_of = |header: &Header| {
        header.below + (header.below..end).take_while(|&row| remark(view, row, &header.names)).count()
    };
    let rank = |header: &Header| {
        let row = rows_of(header);
        let near = header.score >= VALUE && numbers(row);
        (near, near && header.is_line() && header.names_all(view, row), header.score)
    };
    for row in from..last {
        if before.is_some_and(|b| remark(view, row, &b.header) && wide(row)) {
            continue;
        }
        for header in headers(view, legend, row, end).into_iter().chain(counted::header(view, row, end)) {
            // Below a table a single word, or names without rows, are no header.
            let next = before.is_none() || numbers(header.below);
            let least = if before.is_some() { VALUE } else { SHARE };
            let values = header.score >= least && next;
            if values && best.as_ref().is_none_or(|b| rank(&header) > rank(b)) {
                best = Some(header);
            }
        }
        // Below a table the next header ends it, however good those further down are.
        if before.is_some() && best.is_some() {
            break;
        }
        // A better header stands next to the first, not below its rows; a title has none.
        if best.as_ref().is_some_and(|b| row > b.below + 1 && numbers(rows_of(b))) {
            break;
        }
    }
    best
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
            ("REBOUND TEST,form 3\nLot,22-a\nBy,Ida\nWhere,hall\nbounce,height_cm\n0,100", "bounce|height_cm", (4, 5)),
            ("Heights, cm\nbounce,height_cm\n0,100", "bounce|height_cm", (1, 2)),
            ("Hi, the rebound heights in cm, the times in s\nbounce,height\n0,100", "bounce|height", (1, 2)),
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
            ("Rebound in cm,,,\nBall,1,2,Mean\nGolf,64,63,63.5", "Ball|trial 1|trial 2|Mean", (1, 2)),
            ("Ball:,Super,\nDrop #,Drop (in),Rebound (in)\n1,72,40", "Drop #|Drop (in)|Rebound (in)", (1, 2)),
            (
                "Drop (in),Rebound (in):,\n,Trial 1,Trial 2\n72,40,41",
                "Drop (in)|Trial 1, Rebound (in):|Trial 2, Rebound (in):",
                (0, 2),
            ),
        ] {
            let (names, header, rows) = names(text);
            assert_eq!(names.join("|"), expected, "{text}");
            assert_eq!((header, rows), at, "{text}");
        }
    }
}
