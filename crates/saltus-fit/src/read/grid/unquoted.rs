//! Commas within names that no quotes hold together: `Drop height, cm`.

use super::Grid;
use crate::read::units::Unit;

impl Grid<'_> {
    /// Joins what commas part within the names of columns: a bare unit belongs to the name before
    /// it, and so does what stands in a bracket that is open; where each cell has a name then.
    pub(super) fn unquoted(&mut self) {
        if self.delimiter != b',' {
            return;
        }
        let Some(names) = (0..self.rows()).find(|&row| self.width(row) > 1) else { return };
        let Some(cells) = self.level(names + 1).filter(|cells| *cells < self.width(names)) else { return };
        let joined = self.joined(names);
        if joined.len() != cells {
            return;
        }
        self.relay(|grid, row, push| {
            if row == names {
                joined.iter().for_each(|name| push(name));
            } else {
                (0..grid.width(row)).for_each(|n| push(grid.cell(row, n)));
            }
        });
    }

    /// How many cells each row of several from `row` on has.
    fn level(&self, row: usize) -> Option<usize> {
        let mut widths = (row..self.rows()).map(|row| self.width(row)).filter(|width| *width > 1);
        let first = widths.next()?;
        widths.all(|width| width == first).then_some(first)
    }

    fn joined(&self, row: usize) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for cell in (0..self.width(row)).map(|n| self.cell(row, n)) {
            let open = |name: &String| name.matches('(').count() > name.matches(')').count();
            match names.last_mut() {
                Some(name) if open(name) => *name = format!("{name}, {cell}"),
                Some(name) if Unit::parse(cell).is_some() => *name = format!("{name} ({cell})"),
                _ => names.push(cell.to_owned()),
            }
        }
        names
    }
}
