//! What can go wrong before there is anything to report: a table that cannot be read, an option
//! that makes no sense.

use std::fmt;

use serde::ser::{Serialize, SerializeStruct, Serializer};

use crate::finding::Spot;

/// A table that could not be read: what is wrong, in which line and column, and what to do about
/// it.
///
/// Its `Display` form shows the line itself with a caret below the cell:
///
/// ```
/// use saltus_fit::{ReadOptions, Table};
///
/// let csv = b"bounce,height_cm\n0,100\n1,thirty\n";
/// let error = Table::parse("drop.csv", csv, &ReadOptions::default()).unwrap_err();
/// assert_eq!((error.line(), error.column()), (Some(3), Some(3)));
/// let shown = [
///     "drop.csv:3:3: 'thirty' is not a number",
///     "    3 | 1,thirty",
///     "      |   ^^^^^^",
///     "  help: write a plain number; the unit belongs in the header",
/// ];
/// assert_eq!(error.to_string(), shown.join("\n"));
/// ```
#[derive(Clone, PartialEq, Eq)]
pub struct TableError {
    name: String,
    place: Option<Box<Place>>,
    message: String,
    help: Option<String>,
    kind: Kind,
}

/// What an error asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    /// A file or a cell to be corrected.
    #[default]
    Fault,
    /// A question that an option answers.
    Question,
    /// There is no table of bounces.
    Nothing,
}

/// Where in the file: 1-based line and column (in characters), and the line as it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) line: u64,
    pub(crate) column: usize,
    pub(crate) width: usize,
    pub(crate) text: String,
    /// In a workbook, the sheet and the number of the cell in its row.
    pub(crate) cell: Option<(String, usize)>,
}

impl Place {
    /// The cell as a spreadsheet names it, such as `B3`.
    fn address(&self, index: usize) -> String {
        let mut letters = Vec::new();
        let mut rest = index + 1;
        while rest > 0 {
            rest -= 1;
            letters.push(char::from(b'A' + u8::try_from(rest % 26).unwrap_or_default()));
            rest /= 26;
        }
        format!("{}{}", letters.iter().rev().collect::<String>(), self.line)
    }
}

impl TableError {
    pub(crate) fn new(name: &str, message: impl Into<String>) -> Self {
        Self { name: name.to_owned(), place: None, message: message.into(), help: None, kind: Kind::Fault }
    }

    pub(crate) fn at(mut self, place: Place) -> Self {
        self.place = Some(Box::new(place));
        self
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// It is a question that an option answers.
    pub(crate) fn question(self) -> Self {
        Self { kind: Kind::Question, ..self }
    }

    /// There is no table of bounces, rather than one that is wrong.
    pub(crate) fn nothing(self) -> Self {
        Self { kind: Kind::Nothing, ..self }
    }

    pub(crate) fn is_of_nothing(&self) -> bool {
        self.kind == Kind::Nothing
    }

    /// Whether two readings are possible, and an option that the message names says which is meant.
    #[must_use]
    pub fn is_question(&self) -> bool {
        self.kind == Kind::Question
    }

    /// Where it is, without the line itself.
    pub(crate) fn spot(&self) -> Spot {
        let cell = self.place.as_ref().and_then(|place| Some((place, place.cell.as_ref()?)));
        Spot {
            file: self.name.clone(),
            line: self.line(),
            column: self.column(),
            sheet: cell.map(|(_, (sheet, _))| sheet.clone()),
            cell: cell.map(|(place, (_, index))| place.address(*index)),
        }
    }

    /// The line the problem is in (the row, in a workbook), counted from 1; `None` when it is the
    /// file as a whole.
    #[must_use]
    pub fn line(&self) -> Option<u64> {
        self.place.as_ref().map(|place| place.line)
    }

    /// The column the problem starts at, in characters (in a workbook, cells) counted from 1;
    /// `None` when it is the file as a whole.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        self.place.as_ref().map(|place| place.cell.as_ref().map_or(place.column, |(_, index)| index + 1))
    }
}

/// `kind` (`fault`, `question`, `nothing`), `message`, `file`, `line`, `column`, of a workbook
/// `sheet` and `cell`, and `advice`; null where there is none.
impl Serialize for TableError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let spot = self.spot();
        let mut fields = serializer.serialize_struct("TableError", 8)?;
        fields.serialize_field("kind", &self.kind)?;
        fields.serialize_field("message", &self.message)?;
        fields.serialize_field("file", &spot.file)?;
        fields.serialize_field("line", &spot.line)?;
        fields.serialize_field("column", &spot.column)?;
        fields.serialize_field("sheet", &spot.sheet)?;
        fields.serialize_field("cell", &spot.cell)?;
        fields.serialize_field("advice", &self.help)?;
        fields.end()
    }
}

/// `drop.csv:3:3`, or `book.xlsx, sheet 'Data', cell B3`.
impl fmt::Display for Spot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        match (&self.sheet, &self.cell, self.line, self.column) {
            (Some(sheet), Some(cell), ..) => write!(f, ", sheet '{sheet}', cell {cell}"),
            (_, _, Some(line), Some(column)) => write!(f, ":{line}:{column}"),
            _ => Ok(()),
        }
    }
}

/// The longest part of a line that is shown; a longer line is cut around the caret.
const SHOWN: usize = 90;

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.spot(), self.message)?;
        if let Some(place) = &self.place {
            let at = place.column.saturating_sub(1);
            let from = if at + place.width > SHOWN { at.saturating_sub(SHOWN / 2) } else { 0 };
            let shown: String = place
                .text
                .chars()
                .skip(from)
                .take(SHOWN)
                .map(|c| if c.is_control() || c == char::REPLACEMENT_CHARACTER { ' ' } else { c })
                .collect();
            let number = place.line.to_string();
            let carets = "^".repeat(place.width.clamp(1, SHOWN.saturating_sub(at - from).max(1)));
            write!(f, "\n  {number:>3} | {}", shown.trim_end())?;
            write!(f, "\n  {:>w$} | {}{carets}", "", " ".repeat(at - from), w = number.len().max(3))?;
        }
        match &self.help {
            Some(help) => write!(f, "\n  help: {help}"),
            None => Ok(()),
        }
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for TableError {}

/// A fit that could not be started: an option out of its range, or a solver that failed.
///
/// A table that simply does not determine a COR is no error: it gives a report whose verdict is
/// *refused*.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// An option is not a positive finite number.
    Option {
        /// Which option.
        name: &'static str,
        /// The value given.
        value: f64,
    },
    /// The least-squares solver gave no answer that passes its checks; this is a defect worth
    /// reporting.
    Solver {
        /// What was being fitted.
        what: String,
        /// The message of the solver.
        reason: String,
    },
    /// Who asked for the fit ended it: see [`Fit::run_with`](crate::Fit::run_with).
    Ended,
}

/// `kind` (`option`, `solver`, `ended`) and `message`.
impl Serialize for FitError {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let kind = match self {
            Self::Option { .. } => "option",
            Self::Solver { .. } => "solver",
            Self::Ended => "ended",
        };
        let mut fields = serializer.serialize_struct("FitError", 2)?;
        fields.serialize_field("kind", kind)?;
        fields.serialize_field("message", &self.to_string())?;
        fields.end()
    }
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Option { name, value } => write!(f, "{name} is {value}: it must be a positive, finite number"),
            Self::Solver { what, reason } => {
                write!(f, "the fit of {what} failed: {reason}; please report it together with the table")
            }
            Self::Ended => f.write_str("the fit was ended before it was done"),
        }
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for FitError {}
