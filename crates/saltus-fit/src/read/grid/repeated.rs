//! Cells that say that what stands above them holds here too: `"`, `-"-`, `ditto`.

use super::super::phrases::Phrase;
use super::Grid;

/// Whether a cell repeats the one above it. Strokes around the mark say no more.
fn repeats(cell: &str) -> bool {
    let bare = cell.trim_matches(['-', '–', '—', ' ']);
    let marks = ["〃", "″", "''", "\"", "//", "„", "“", "”"];
    marks.contains(&bare) || Phrase::Ditto.is(&cell.to_lowercase())
}

impl Grid<'_> {
    /// Puts what a cell repeats into it: the cell above, as far as one is filled.
    pub(super) fn repeat(&mut self) {
        let any = (0..self.rows()).any(|row| (0..self.width(row)).any(|column| repeats(self.cell(row, column))));
        if !any {
            return;
        }
        let mut above: Vec<String> = Vec::new();
        self.rewrite(|grid, row, column, cells| {
            above.resize(above.len().max(column + 1), String::new());
            let (cell, last) = (grid.cell(row, column), &mut above[column]);
            if !repeats(cell) || last.is_empty() {
                cell.clone_into(last);
            }
            cells.push_str(last);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wrapped;
    use super::*;

    #[test]
    fn what_stands_above_is_repeated() {
        for mark in ["\"", "''", "-\"-", "- \" -", "-//-", "〃", "ditto", "Idem", "同上"] {
            let text =
                format!("drop (cm)\trebound (cm)\tfloor\n200\t122\ttile\n{mark}\t119\t{mark}\n{mark}\t\t{mark}\n");
            let text = wrapped::repeated(&text).unwrap_or(text);
            let grid = Grid::open("a", None, &text).unwrap();
            let row = |n: usize| (0..3).map(|column| grid.cell(n, column)).collect::<Vec<_>>();
            assert_eq!((row(2), row(3)), (vec!["200", "119", "tile"], vec!["200", "", "tile"]), "{mark}");
        }
    }

    #[test]
    fn a_cell_that_says_nothing_repeats_nothing() {
        assert!(!["-", "--", "", "1", "x", "n/a", "/", "id", "item"].into_iter().any(repeats));
    }
}
