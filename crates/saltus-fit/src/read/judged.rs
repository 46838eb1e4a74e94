//! Rows that a table says itself do not count: by a column that judges them, `valid?`, or by a
//! remark, `discarded`.

use std::collections::HashSet;

use super::Event;
use super::answers::{Answer, answer};
use super::cell::Cell;
use super::columns::{Column, Columns, Kind};
use super::heading::{Heading, What};
use super::named::event;
use super::phrases::Phrase;
use super::region::Region;
use super::vocabulary::{Atom, ROWS, folded, footnotes};
use super::words::{Word, split};

/// Whether a name and the cell beside it say that what they stand in does not count: `discarded:
/// true`, `valid: no`.
pub(super) fn withdraws(name: &str, cell: &str) -> bool {
    let heading = Heading::parse(name);
    heading.has(Atom::Void) && answer(cell) == Answer::Yes || heading.has(Atom::Counts) && answer(cell) == Answer::No
}

/// Whether a remark says that its row does not count: `discarded`, `not used`.
fn voids(cell: &str) -> bool {
    let words = split(cell);
    let not = |word: &Word| Phrase::Not.is(&word.text.to_lowercase());
    let denied = |n: usize| words[..n].iter().any(not) || words.get(n + 1).is_some_and(not);
    words.iter().enumerate().any(|(n, word)| word.is(Atom::Void) && !denied(n) || word.is(Atom::Counts) && denied(n))
}

/// The marks whose note says that what bears them was not measured, or does not count: `*
/// calculated`.
fn notes(region: &Region<'_>) -> Vec<char> {
    let grid = region.view.grid;
    let says = |mark: char| {
        let line = |row: usize| (0..grid.width(row)).map(|n| grid.cell(row, n)).collect::<Vec<_>>().join(" ");
        (0..grid.rows().min(ROWS)).map(line).any(|line| {
            let note = line.trim().trim_start_matches('(').strip_prefix(mark).unwrap_or_default().to_owned();
            let turned = [Atom::Predicted, Atom::Derived, Atom::Goal];
            let words = split(&note);
            words.len() > 1 && turned.iter().any(|atom| words.iter().any(|word| word.is(*atom))) || voids(&note)
        })
    };
    footnotes().filter(|mark| says(*mark)).collect()
}

/// The rows that do not count.
pub(super) fn void(region: &Region<'_>, columns: &Columns) -> HashSet<usize> {
    let mut found = HashSet::new();
    if region.rows.len() <= ROWS {
        let marks = notes(region);
        let marked = |cell: &str| marks.iter().any(|mark| cell.len() > mark.len_utf8() && cell.ends_with(*mark));
        let number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit());
        found
            .extend(region.rows.iter().filter(|&&row| region.view.cells(row).any(|cell| number(cell) && marked(cell))));
    }
    let timed = columns.values().all(|(_, _, v)| v.what == What::Time) && region.rows.len() <= ROWS;
    // What passes a rule, or fails, was measured all the same: `PASS`, `FAIL`.
    let ruled =
        |index: usize| region.rows.iter().any(|&row| Phrase::Passed.is(&folded(region.cell(row, index).trim())));
    for (index, column) in columns.columns.iter().enumerate() {
        if !column.heading.has(Atom::Counts) && ruled(index) {
            continue;
        }
        let judges = column.heading.has(Atom::Counts) || column.heading.has(Atom::Void);
        if judges && matches!(column.kind, Kind::Aside | Kind::Setting) {
            found.extend(judged(region, index, column));
        } else if matches!(column.kind, Kind::Aside | Kind::Setting | Kind::Event) && timed {
            found.extend(others_than_hits(region, index, column.kind != Kind::Event));
        } else if remarks(column) && region.rows.len() <= ROWS {
            found.extend(region.rows.iter().filter(|&&row| voids(region.cell(row, index))));
        }
    }
    // A table of which no row counts says something else.
    if region.rows.iter().all(|row| found.contains(row)) { HashSet::new() } else { found }
}

/// Of a log whose times are mostly those of contacts, called alike, the rows that name no event of
/// a ball: `session_start`, `battery low`.
fn others_than_hits(region: &Region<'_>, index: usize, starts: bool) -> Vec<usize> {
    let named = |&row: &usize| (row, event(region.cell(row, index)));
    let names: Vec<(usize, Option<Event>)> = region.rows.iter().map(named).collect();
    let hits = names.iter().filter(|(_, event)| *event == Some(Event::Contact)).count();
    // `start` by itself may be that of the log.
    let other = |event: Option<Event>| event.is_none() || starts && event == Some(Event::Release);
    let others: Vec<usize> = names.iter().filter(|(_, event)| other(*event)).map(|(row, _)| *row).collect();
    let words = others.iter().all(|&row| region.view.read(row, index) == Cell::Words);
    if hits + others.len() == names.len() && 2 * hits > names.len() && words { others } else { Vec::new() }
}

/// Whether a column holds remarks.
fn remarks(column: &Column) -> bool {
    column.kind == Kind::Aside && column.heading.unit.is_none() && !column.heading.turns()
}

/// The rows that a column says do not count: where it says no, or nothing where it marks others; of
/// one that names what does not count, where it says so.
fn judged(region: &Region<'_>, index: usize, column: &Column) -> Vec<usize> {
    let answers: Vec<(usize, Answer)> = region.rows.iter().map(|&row| (row, answer(region.cell(row, index)))).collect();
    let any = |of: Answer| answers.iter().any(|(_, answer)| *answer == of);
    let leaves_out = |answer: Answer| match answer {
        Answer::No => !column.heading.has(Atom::Void),
        Answer::Yes => column.heading.has(Atom::Void),
        // Marks of those that count leave the others out; else their text is a reason.
        Answer::Empty => !column.heading.has(Atom::Void) && any(Answer::Yes) && !any(Answer::No) && !any(Answer::Other),
        Answer::Other => column.heading.has(Atom::Void),
    };
    answers.iter().filter(|(_, answer)| leaves_out(*answer)).map(|(row, _)| *row).collect()
}
