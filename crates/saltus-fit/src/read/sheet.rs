//! A table of a file of several, as text: a sheet of a workbook, or a file of an archive.

use super::aside::Why;
use super::limits::{self, MANY};

/// One table of a file of several.
pub(super) struct Part {
    /// The name of the sheet, or of the file in the archive.
    pub(super) name: String,
    /// What encloses it and tells it from others: a ball that holds its drops.
    pub(super) within: String,
    /// Why it is not read unless asked for: the file hides it, or says that it does not count.
    pub(super) aside: Option<Why>,
    /// The sheet's cells, separated by tabs, or the bytes of the file.
    pub(super) content: Content,
}

impl Part {
    pub(super) fn new(name: String, aside: Option<Why>, content: Content) -> Self {
        Self { name, within: String::new(), aside, content }
    }
}

/// Two parts of a name, of which either may be missing.
pub(super) fn joined(one: &str, other: &str) -> String {
    [one, other].iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(", ")
}

pub(super) enum Content {
    Cells(String),
    Bytes(Vec<u8>),
}

/// Cells, in ascending order, as lines of cells separated by tabs.
pub(super) struct Rows {
    pub(super) text: String,
    /// Where the next cell would be put.
    at: (u32, u32),
    pub(super) left: usize,
}

/// What the cells of a workbook hold is more than is read.
pub(super) fn too_much() -> String {
    format!("its cells hold more than {} MB", limits::bytes() >> 20)
}

impl Rows {
    pub(super) fn new(left: usize) -> Self {
        Self { text: String::new(), at: (0, 0), left }
    }

    pub(super) fn put(&mut self, (row, column): (u32, u32), value: &str) -> Result<(), String> {
        if (row, column) < self.at {
            return Err("its cells are not in order".to_owned());
        }
        let down = (row - self.at.0) as usize;
        let right = if down > 0 { column } else { column - self.at.1 } as usize;
        let value: String =
            value.chars().take(MANY).map(|c| if c.is_control() || c == '"' { ' ' } else { c }).collect();
        self.left = self.left.checked_sub(down + right + value.len()).ok_or_else(too_much)?;
        self.text.extend(std::iter::repeat_n('\n', down));
        self.text.extend(std::iter::repeat_n('\t', right));
        self.text.push_str(&value);
        self.at = (row, column);
        Ok(())
    }

    /// Puts a remark on a cell below all cells, as a comment.
    pub(super) fn remark(&mut self, text: &str) -> Result<(), String> {
        let below = (self.at.0.saturating_add(u32::from(!self.text.is_empty())), 0);
        self.put(below, &format!("# {text}"))
    }
}
