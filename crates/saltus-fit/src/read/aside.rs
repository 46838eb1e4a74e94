//! What a file holds and the readings do not: each thing with its place and the reason.

use serde::{Deserialize, Serialize};

/// A part of a file that was not used.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LeftAside {
    /// What kind of part it is.
    pub what: Part,
    /// What it is called: a heading, the name of a sheet, the text itself.
    pub name: String,
    /// Why it was not used.
    pub why: Why,
    /// The sheet or the file it belongs to, where there are several.
    #[serde(rename = "in")]
    pub within: Option<String>,
    /// The line, or row, counted from 1.
    pub line: Option<u64>,
}

/// The kind of a part of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Part {
    /// A column.
    Column,
    /// A row.
    Row,
    /// A cell.
    Cell,
    /// A line of text above, below or beside the table.
    Text,
    /// A sheet of a workbook, or a file of an archive.
    Sheet,
    /// A track of a film.
    Track,
    /// Sounds, by their times.
    Sound,
    /// Pulses of a sensor, by their times.
    Pulse,
}

/// Why a part was not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Why {
    /// A word of it is not understood.
    NotUnderstood,
    /// It sums up other rows or columns: a mean, a scatter, an extreme.
    Statistic,
    /// It was predicted, calculated or looked up, and not measured.
    Predicted,
    /// It is a goal.
    Goal,
    /// It was worked out from other columns.
    Derived,
    /// It holds another quantity than heights and times.
    Other,
    /// It is a remark.
    Note,
    /// Nothing stands above it.
    Unnamed,
    /// The file hides it.
    Hidden,
    /// It holds no table of bounces.
    NoTable,
    /// Nothing stands in it.
    Empty,
    /// Another was asked for.
    NotChosen,
    /// The same events stand elsewhere, and all of them.
    Elsewhere,
    /// The program that wrote it works it out from the times.
    Computed,
    /// It hardly moves.
    Still,
    /// The table says itself that it does not count.
    Void,
    /// It counts frames, and how many were filmed in a second is not stated.
    NoRate,
    /// Its time is that of the event before it: the clock does not tell them apart.
    Unresolved,
    /// The event was not heard: the time is zero.
    NotHeard,
    /// They follow a contact as its echo or its ringing.
    Echo,
    /// They are contacts whose times no longer tell their flights.
    Close,
    /// They come when no contact is due.
    NoBounce,
    /// Contacts stand out more in another.
    Fainter,
}

impl LeftAside {
    pub(crate) fn new(what: Part, name: impl Into<String>, why: Why) -> Self {
        Self { what, name: name.into(), why, within: None, line: None }
    }

    pub(crate) fn at(self, line: u64) -> Self {
        Self { line: Some(line), ..self }
    }
}
