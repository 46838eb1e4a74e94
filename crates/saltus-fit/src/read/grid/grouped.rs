//! Marks that part thousands, where they might as well be decimal ones: `1.250` below `500` and
//! `750`.

use super::super::cell;
use super::super::heading::{Heading, What};
use super::super::vocabulary::ROWS;
use super::Grid;

/// A column whose numbers go up to less than this writes no thousands.
const HUNDRED: f64 = 100.0;

/// A number as it is written, and what follows it: a unit.
fn number(cell: &str) -> Option<(&str, &str)> {
    let end = cell.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ','))).unwrap_or(cell.len());
    let (number, unit) = cell.split_at(end);
    let plain = number.starts_with(|c: char| c.is_ascii_digit()) && !unit.contains(|c: char| c.is_ascii_digit());
    plain.then_some((number, unit))
}

/// Whether a mark stands before three digits each time, as thousands are parted.
fn grouped(number: &str, mark: char) -> bool {
    let mut parts = number.split(mark);
    let first = parts.next().unwrap_or_default();
    (1..=3).contains(&first.len())
        && !first.starts_with('0')
        && parts.all(|part| part.len() == 3 && part.chars().all(|c| c.is_ascii_digit()))
}

/// The largest factor between numbers that follow each other in size.
fn gap(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = numbers.filter(|number| *number > 0.0).collect();
    all.sort_by(f64::total_cmp);
    all.windows(2).map(|pair| pair[1] / pair[0]).fold(1.0, f64::max)
}

/// Numbers of a column: those without the mark, those with it as a decimal one, and whether one of
/// these ends in a zero.
#[derive(Clone, Default)]
struct Column {
    named: bool,
    plain: Vec<f64>,
    marked: Vec<f64>,
    zero: bool,
}

impl Column {
    /// Whether its numbers lie closer together if the mark parts thousands; where it makes no
    /// difference, whoever writes zeros at an end writes them in all numbers.
    fn of_thousands(&self) -> bool {
        let most = self.plain.iter().copied().fold(0.0, f64::max);
        let of = |factor: f64| gap(self.plain.iter().copied().chain(self.marked.iter().map(|n| n * factor)));
        let (decimal, thousands) = (of(1.0), of(1000.0));
        self.named
            && !self.marked.is_empty()
            && (HUNDRED..1000.0).contains(&most)
            && (thousands < decimal || thousands <= decimal && self.zero)
    }
}

impl Grid<'_> {
    /// Takes marks that part thousands out of numbers: each stands before three digits in the whole
    /// table, and a column tells by its other numbers that it is no decimal one.
    pub(super) fn ungroup(&mut self) {
        for mark in ['.', ','] {
            if let Some(shown) = self.parted_by(mark) {
                self.unmark(mark);
                self.grouped = Some(shown);
            }
        }
    }

    /// A number that shows what the mark parts; `None` if nothing does, or it is a decimal one.
    fn parted_by(&self, mark: char) -> Option<String> {
        if !self.cells.contains(mark) {
            return None;
        }
        let mut columns: Vec<Column> = Vec::new();
        for row in 0..self.rows() {
            for at in 0..self.width(row) {
                if columns.len() <= at {
                    columns.resize(at + 1, Column::default());
                }
                let (cell, column) = (self.cell(row, at), &mut columns[at]);
                let Some((number, unit)) = number(cell).filter(|_| !cell::date(cell)) else {
                    let name = || Heading::parse(cell).value().is_some_and(|value| value.what != What::Unsaid);
                    column.named |= row < ROWS && column.plain.is_empty() && column.marked.is_empty() && name();
                    continue;
                };
                let marked = number.contains(mark);
                if marked && (!grouped(number, mark) || unit.contains('±')) {
                    return None;
                }
                let value: Option<f64> = number.replace(',', ".").parse().ok();
                column.zero |= marked && number.ends_with('0');
                if marked { column.marked.extend(value) } else { column.plain.extend(value) }
            }
        }
        let at = columns.iter().position(Column::of_thousands)?;
        let shows = |row: &usize| number(self.cell(*row, at)).is_some_and(|(number, _)| number.contains(mark));
        (0..self.rows()).find(shows).map(|row| self.cell(row, at).to_owned())
    }

    fn unmark(&mut self, mark: char) {
        self.rewrite(|grid, row, column, cells| {
            let cell = grid.cell(row, column);
            match number(cell) {
                Some((number, unit)) => cells.extend([&*number.replace(mark, ""), unit]),
                None => cells.push_str(cell),
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::Grid;

    fn parts(text: &str) -> bool {
        Grid::open("a", None, text).unwrap().grouped.is_some()
    }

    /// A mark parts thousands where the numbers lie closer together so.
    #[test]
    fn marks_before_three_digits_are_of_thousands_where_numbers_lie_closer_so() {
        for mark in [".", ","] {
            for (cells, thousands) in [
                ("500 750 1.000 1.250", true),
                ("1.200 850 600 420 300 210 150 105 74", true),
                ("100 81.125 65.375", false),
                ("1 1.250 1.500 2", false),
                ("1.250 1.500", false),
                ("120 1.200", true),
                ("1.200 85 60", false),
                ("500 750.5 1.250", false),
                ("500 0.750 1.250", false),
            ] {
                let text = format!("height (mm)\tball\n{}", cells.replace('.', mark).replace(' ', "\ta\n"));
                assert_eq!(parts(&(text + "\ta\n")), thousands, "{cells} {mark}");
            }
        }
        // Numbers of several things in a column say nothing of each other.
        assert!(!parts("what\tvalue\nmass (g)\t450\nheight (m)\t1.500\n"));
    }
}
