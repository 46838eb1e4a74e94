//! Places in a file that findings name.

use serde::{Deserialize, Serialize};

/// A place in a file, counted from 1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Spot {
    /// The file.
    pub file: String,
    /// The line, or the row of a sheet; none for the file as a whole.
    pub line: Option<u64>,
    /// The column, in characters; of a sheet, in cells.
    pub column: Option<usize>,
    /// The sheet of a workbook.
    pub sheet: Option<String>,
    /// The cell, as a spreadsheet names it.
    pub cell: Option<String>,
}

/// Lines of a file: the first few, and how many there are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Lines {
    /// The first few, counted from 1.
    pub first: Vec<u64>,
    /// How many there are.
    pub count: usize,
}

impl Lines {
    /// Of lines, readings and sounds so many are named: as many as one glance counts.
    pub(crate) const NAMED: usize = 5;

    pub(crate) fn of(all: &[u64]) -> Self {
        Self { first: all.iter().copied().take(Self::NAMED).collect(), count: all.len() }
    }
}
