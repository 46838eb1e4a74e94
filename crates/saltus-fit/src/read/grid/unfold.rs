//! Cells that hold several readings, `64/65/63`: a column for each.

use super::super::cell::{self, Cell};
use super::super::heading::Heading;
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Unit, names_unit};
use super::super::vocabulary::ROWS;
use super::Grid;

/// What stands between readings of one cell, words beside these; blanks last, since units stand
/// behind them.
const MARKS: [&str; 7] = [";", "/", ", ", ",", " & ", "\n", " "];

/// The readings of a cell that is no number itself and whose parts are, alike in size; the unit of
/// the last is that of all.
fn readings(cell: &str, comma: bool) -> Option<Vec<String>> {
    let digits = cell.starts_with(|c: char| c.is_ascii_digit());
    if !digits || matches!(cell::read(cell, comma), Cell::Number(_) | Cell::Empty) || cell::clock(cell).is_some() {
        return None;
    }
    let (numbers, unit) = cell.split_at(cell.rfind(|c: char| c.is_ascii_digit())? + 1);
    if !unit.is_empty() && Unit::parse(unit.trim()).is_none() {
        return None;
    }
    let words = Phrase::And.all().iter().map(|word| format!(" {word} "));
    let marks = MARKS[..5]
        .iter()
        .map(|mark| (*mark).to_owned())
        .chain(words)
        .chain(MARKS[5..].iter().map(|mark| (*mark).to_owned()));
    marks.into_iter().find_map(|mark| {
        let parts: Vec<&str> = numbers.split(&*mark).map(str::trim).filter(|part| !part.is_empty()).collect();
        let number = |part: &&str| match cell::read(part, false) {
            Cell::Number(measured) => Some(measured),
            _ => None,
        };
        let found = parts.iter().map(number).collect::<Option<Vec<_>>>()?;
        let (low, high) = found.iter().fold((f64::INFINITY, 0.0f64), |(l, h), m| (l.min(m.value), h.max(m.value)));
        // Two numbers with a comma between them are one, whose thousands it parts.
        let least = if mark == "," { 3 } else { 2 };
        let alike = low > 0.0 && high <= cell::RANGE * low && found.len() >= least;
        let whole = |(part, m): (&&'_ str, &cell::Measured)| match m.unit {
            None if !unit.is_empty() => format!("{part}{unit}"),
            _ => (*part).to_owned(),
        };
        alike.then(|| parts.iter().zip(&found).map(whole).collect())
    })
}

impl Grid<'_> {
    /// Moves the units that a column of its own names, `height,unit` above `150,cm` and `36,in`, to
    /// the numbers before them, or to the names of the quantities that rows hold, `drop,cm,60,80`.
    pub(super) fn united(&mut self) {
        let width = (0..self.rows()).map(|row| self.width(row)).max().unwrap_or(0);
        let bare = |cell: &str| matches!(cell::read(cell, false), Cell::Number(m) if m.unit.is_none());
        let of = |column: usize| -> Option<(usize, usize, bool)> {
            let names = (0..self.rows().min(ROWS)).find(|&row| names_unit(self.cell(row, column)))?;
            let rows = || (names + 1..self.rows()).filter(|&row| !self.cell(row, column).is_empty());
            let unit =
                |row: usize| Unit::parse(self.cell(row, column)).is_some_and(|u| u.dimension != Dimension::Other);
            let words = |row: usize| cell::read(self.cell(row, column - 1), false) == Cell::Words;
            let number =
                (0..column).rev().find(|&n| rows().all(|row| bare(self.cell(row, n)))).map(|n| (names, n, false));
            let name = || rows().all(words).then_some((names, column - 1, true));
            number.or_else(name).filter(|_| rows().count() > 1 && rows().all(unit))
        };
        let found: Vec<(usize, (usize, usize, bool))> = (1..width).filter_map(|n| Some((n, of(n)?))).collect();
        if found.is_empty() {
            return;
        }
        self.rewrite(|grid, row, column, cells| {
            let unit = found.iter().find(|(_, (names, of, _))| row > *names && *of == column);
            let moved = found.iter().any(|(unit, (names, ..))| *unit == column && row >= *names);
            if !moved {
                cells.push_str(grid.cell(row, column));
            }
            match unit.map(|(unit, (_, _, name))| (grid.cell(row, *unit), name)) {
                None | Some(("", _)) => {}
                Some((unit, true)) => cells.push_str(&format!(" ({unit})")),
                Some((unit, false)) => cells.push_str(&format!(" {unit}")),
            }
        });
    }

    /// Parts columns whose cells hold several readings into one for each, named as trials.
    pub(super) fn unfold(&mut self) {
        let width = (0..self.rows()).map(|row| self.width(row)).max().unwrap_or(0);
        // Of each column the row of its name, and how many readings its cells hold at most.
        let mut parted: Vec<Option<(usize, usize)>> = (0..width).map(|column| self.several(column)).collect();
        let Some((name, count)) = parted.iter().flatten().next().copied() else { return };
        // So are cells beside them that hold as many, whatever their name.
        let parts = |row: usize, column: usize| readings(self.cell(row, column), self.thousands());
        let alike = |column: usize| {
            let rows = || (name + 1..self.rows()).filter(|&row| !self.cell(row, column).is_empty());
            let missing = |row: usize| !self.cell(row, column).contains(|c: char| c.is_ascii_digit());
            let as_many = |row: usize| parts(row, column).is_some_and(|found| found.len() == count);
            rows().any(as_many) && rows().all(|row| missing(row) || as_many(row))
        };
        for (column, parted) in parted.iter_mut().enumerate().filter(|(_, parted)| parted.is_none()) {
            *parted = alike(column).then_some((name, count));
        }
        self.relay(|grid, row, push| {
            for (column, parted) in parted.iter().enumerate().take(grid.width(row)) {
                let cell = grid.cell(row, column);
                let count = parted.map_or(1, |(_, count)| count);
                let named = parted.is_some_and(|(name, _)| name == row);
                let found = if named { None } else { readings(cell, grid.thousands()).filter(|_| count > 1) };
                for n in 0..count {
                    match &found {
                        Some(found) => push(found.get(n).map_or("", |part| part)),
                        None if named => push(&format!("trial {}: {cell}", n + 1)),
                        None => push(if n == 0 { cell } else { "" }),
                    }
                }
            }
        });
        self.origin =
            (0..width).flat_map(|n| std::iter::repeat_n(n, parted[n].map_or(1, |(_, count)| count))).collect();
    }

    /// Whether cells of a column hold several readings below a name that is understood: the row of
    /// the name, and the most that a cell holds.
    fn several(&self, column: usize) -> Option<(usize, usize)> {
        let found = |row: usize| readings(self.cell(row, column), self.thousands()).map(|found| found.len());
        let first = (1..self.rows()).find(|&row| found(row).is_some())?;
        let most = (first..self.rows()).filter_map(found).max()?;
        let words = |row: &usize| cell::read(self.cell(*row, column), self.thousands()) == Cell::Words;
        let name = (0..first).rev().find(words)?;
        let heading = Heading::parse(self.cell(name, column));
        let one = heading.value().is_some_and(|value| value.trial.is_empty());
        // Names that may only count hold readings where these bear units.
        let measured = || {
            readings(self.cell(first, column), self.thousands()).is_some_and(|found| {
            matches!(cell::read(&found[0], false), Cell::Number(m) if m.unit.is_some_and(|u| u.dimension != Dimension::Other))
        })
        };
        (heading.understood() && (one || measured())).then_some((name, most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_may_stand_in_a_column_of_their_own() {
        let grid = Grid::open("a", None, "bounce,height,unit,by\n0,150,cm,Kim\n1,36,in,Bob\n").unwrap();
        let row = |n: usize| (0..4).map(|column| grid.cell(n, column)).collect::<Vec<_>>();
        assert_eq!(row(0), ["bounce", "height", "", "by"]);
        assert_eq!(row(2), ["1", "36 in", "", "Bob"]);
        let grid = Grid::open("a", None, "quantity,unit,1,2\ndrop,cm,60,80\nfall,s,0.35,0.4\n").unwrap();
        assert_eq!((grid.cell(1, 0), grid.cell(2, 0), grid.cell(2, 1)), ("drop (cm)", "fall (s)", ""));
        let grid = Grid::open("a", None, "ball,height,unit\na,150,A7\nb,36,A9\n").unwrap();
        assert_eq!(grid.cell(1, 2), "A7");
    }

    #[test]
    fn a_cell_may_hold_several_readings() {
        for (cell, expected) in [
            ("64/65/63", &["64", "65", "63"][..]),
            ("64; 65; 63 cm", &["64 cm", "65 cm", "63 cm"]),
            ("64, 65, 63", &["64", "65", "63"]),
            ("64 65 63", &["64", "65", "63"]),
            ("64 65 cm", &["64 cm", "65 cm"]),
            ("64 cm / 65 cm", &["64 cm", "65 cm"]),
            ("0,64 / 0,66", &["0,64", "0,66"]),
        ] {
            assert_eq!(readings(cell, false).unwrap_or_default(), expected, "{cell}");
        }
        for cell in
            ["64", "40 1/2", "12/03/2024", "5/11", "1:02.5", "64 ± 1", "1 500", "5' 3\"", "62 wobbles", "-", "1,001"]
        {
            assert_eq!(readings(cell, false), None, "{cell}");
        }
    }
}
