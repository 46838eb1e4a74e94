//! What stands in a table of many runs: cells of a row, and of a column.

use std::borrow::Cow;

use crate::number::number;

/// The content of a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// An empty cell: the run has no such result.
    None,
    /// A number in SI units.
    Number(f64),
    /// A number as text.
    Written(String),
    /// A count, such as that of impacts.
    Count(u64),
    /// A word, such as why a run ended.
    Word(String),
}

impl Cell {
    pub(crate) fn text(&self) -> Cow<'_, str> {
        match self {
            Self::None => Cow::Borrowed(""),
            Self::Number(value) => number(*value).into(),
            Self::Written(text) | Self::Word(text) => text.into(),
            Self::Count(count) => count.to_string().into(),
        }
    }

    #[allow(clippy::cast_precision_loss)] // 53 bits
    pub(crate) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value).filter(|value| value.is_finite()),
            Self::Count(count) => Some(*count as f64),
            Self::Written(number) => number.parse().ok(),
            Self::None | Self::Word(_) => None,
        }
    }
}

impl From<Option<f64>> for Cell {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::None, Self::Number)
    }
}

/// The cells of a column, from run to run; `None` where nothing stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Counts.
    Counts(Vec<Option<u64>>),
    /// Numbers in SI units, or in that of what varies.
    Numbers(Vec<Option<f64>>),
    /// Words.
    Words(Vec<Option<String>>),
}

impl Cells {
    pub(crate) const COUNTS: Self = Self::Counts(Vec::new());
    pub(crate) const NUMBERS: Self = Self::Numbers(Vec::new());
    pub(crate) const WORDS: Self = Self::Words(Vec::new());

    /// Takes the cell of a further run; what is not of its kind is nothing.
    pub fn push(&mut self, cell: Cell) {
        match self {
            Self::Numbers(cells) => cells.push(cell.number()),
            Self::Counts(cells) => cells.push(if let Cell::Count(count) = cell { Some(count) } else { None }),
            Self::Words(cells) => cells.push(match cell {
                Cell::Word(word) | Cell::Written(word) => Some(word),
                _ => None,
            }),
        }
    }
}
