//! Rows that name the rows below them, `Concrete` above four drops and `Carpet` above four more: a
//! column of what they name.

use std::collections::BTreeSet;

use super::super::cell::{self, Cell};
use super::super::clause;
use super::super::heading::Heading;
use super::super::vocabulary::ROWS;
use super::Grid;

/// A name of a section has no more words: what has more is a sentence.
const WORDS: usize = 4;

/// What the names of sections name: a heading for their column.
fn heading(names: &[&str]) -> &'static str {
    let all = |is: fn(&str) -> bool| names.iter().all(|name| is(name));
    let of_trial = |name: &str| Heading::parse(name).value().is_some_and(|value| !value.trial.is_empty());
    match () {
        () if all(|name| cell::length(name).is_some()) => "drop height",
        () if all(of_trial) => "trial",
        () => "ball",
    }
}

impl Grid<'_> {
    /// Gives each row the name of its section, in a last column.
    pub(super) fn section(&mut self) {
        let Some((header, sections)) = self.sections() else { return };
        let names: Vec<String> = sections.iter().map(|&row| self.named(row)).collect();
        let heading = heading(&names.iter().map(String::as_str).collect::<Vec<_>>());
        let width = (0..self.rows()).map(|row| self.width(row)).max().unwrap_or(0);
        self.relay(|grid, row, push| {
            let section = sections.iter().rposition(|&of| of < row);
            let name = match section {
                _ if sections.contains(&row) => return,
                None => (row == header).then_some(heading),
                Some(of) => Some(names[of].as_str()),
            };
            let count = name.map_or(grid.width(row), |_| width);
            (0..count).map(|column| grid.cell(row, column)).chain(name).for_each(push);
        });
    }

    /// The name in a row that holds one cell of words, without what a height of release is stated
    /// by: `Drop from 1 m` is `1 m`.
    fn named(&self, row: usize) -> String {
        let mut cells = (0..self.width(row)).map(|column| self.cell(row, column));
        let name = cells.find(|cell| !cell.is_empty()).unwrap_or_default().trim_end_matches(':').trim();
        match clause::drop(name) {
            Some(drop) => format!("{} m", drop.metres()),
            None => name.to_owned(),
        }
    }

    /// The row of the names of columns and those that name sections: the first right below it, each
    /// above rows of numbers, no two alike, and below the first nothing but them and such rows.
    fn sections(&self) -> Option<(usize, Vec<usize>)> {
        let filled = |row: usize| (0..self.width(row)).map(move |n| self.cell(row, n)).filter(|cell| !cell.is_empty());
        let number = |cell: &str| matches!(cell::read(cell, false), Cell::Number(_));
        let numbers = |row: usize| filled(row).any(number);
        let lone = |row: usize| {
            let mut cells = filled(row);
            let words = cells.next().filter(|cell| !number(cell) || cell::length(cell).is_some());
            words.is_some_and(|name| name.split_whitespace().count() <= WORDS) && cells.next().is_none()
        };
        let header = (0..self.rows().min(ROWS)).find(|&row| filled(row).count() > 1 && !numbers(row))?;
        let sections: Vec<usize> = (header + 1..self.rows()).filter(|&row| lone(row)).collect();
        // A word that ends the table is a remark.
        let leads = |&row: &usize| row + 1 < self.rows() && numbers(row + 1) && !lone(row + 1);
        let all = |row: usize| numbers(row) || lone(row);
        let names: BTreeSet<String> = sections.iter().map(|&row| self.named(row)).collect();
        let fits = sections.len() > 1
            && sections[0] == header + 1
            && names.len() == sections.len()
            && sections.iter().all(leads)
            && (header + 1..self.rows()).all(all);
        fits.then_some((header, sections))
    }
}
