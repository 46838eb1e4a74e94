//! What can go wrong between data and picture.

use std::error::Error;
use std::fmt;

/// An error of a picture: what is wrong, where, and what to do about it.
///
/// # Example
///
/// ```
/// use saltus_plot::{HeightTime, PlotError, Stroke};
///
/// let empty = HeightTime::new("Nothing yet").svg();
/// assert!(matches!(empty, Err(PlotError::Empty)));
///
/// let broken = HeightTime::new("Broken").motion("model", [Stroke::over_time(0.0, 1.0, vec![f64::NAN])]).svg();
/// let message = broken.unwrap_err().to_string();
/// assert!(message.contains("the start of stroke 1 of motion 1"), "{message}");
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum PlotError {
    /// There is nothing to draw: no stroke, no measurement, no contact, no residual.
    Empty,
    /// A number is NaN, infinite, or so far out (beyond 10³⁰⁰) that it might as well be.
    NotFinite {
        /// The number, in words: "the time of measurement 3".
        what: String,
        /// The value of the number.
        value: f64,
    },
    /// A number that must not be negative is: a span or an error.
    Negative {
        /// The number, in words.
        what: String,
        /// The value of the number.
        value: f64,
    },
    /// The picture's size is not a number of pixels that can be drawn.
    Size {
        /// The width asked for.
        width: f64,
        /// The height asked for.
        height: f64,
    },
    /// The run has nothing that such a picture shows: what is missing, and what to do.
    Missing(&'static str),
    /// The state has no such coordinate.
    Coordinate {
        /// The coordinate asked for: its name or its place.
        asked: String,
        /// The names of the coordinates.
        names: Vec<String>,
    },
    /// A sweep has no such result, or one that is no number.
    Column {
        /// The result asked for; `None` if one was to be found.
        asked: Option<String>,
        /// The headings of the results that are numbers.
        names: Vec<String>,
    },
    /// The part of a run that is to be drawn has no length.
    Window {
        /// The start and the end of the part.
        part: (f64, f64),
        /// The start and the end of the run.
        run: (f64, f64),
    },
    /// There are more names than coordinates.
    Names {
        /// The first name too many.
        name: String,
        /// The number of coordinates.
        coordinates: usize,
    },
    /// The drawing library could not place an element.
    Drawing(String),
}

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(
                f,
                "there is nothing to draw: give the picture something to show (a motion, a measurement, a contact, a residual, a coordinate)"
            ),
            Self::NotFinite { what, value } => {
                write!(f, "{what} is {value}, which has no place on an axis: leave it out or correct it")
            }
            Self::Negative { what, value } => {
                write!(f, "{what} is {value}, but must not be negative: give its magnitude")
            }
            Self::Size { width, height } => write!(
                f,
                "a picture of {width} by {height} px cannot be drawn: each side must lie between {} and {} px",
                crate::theme::SMALLEST,
                crate::theme::LARGEST
            ),
            Self::Drawing(reason) => {
                write!(f, "the drawing library could not place an element ({reason}): try a larger size")
            }
            Self::Missing(says) => f.write_str(says),
            Self::Window { part: (from, to), run: (start, end) } => write!(
                f,
                "the part from {from} to {to} has no length within the run, which is from {start} to {end}: draw one between these, its start first"
            ),
            Self::Names { name, coordinates } => {
                write!(f, "there is no coordinate for the name {name:?}: the state has {coordinates}, name no more")
            }
            Self::Column { asked, names } if names.is_empty() => {
                let which = asked.as_deref().unwrap_or("result");
                write!(f, "no run of the sweep came to a number, so that there is no {which} to draw")
            }
            Self::Column { asked, names } => {
                let names = names.join(", ");
                match asked {
                    Some(asked) => write!(f, "the sweep has no number called '{asked}': choose one of {names}"),
                    None => write!(f, "which result is to be drawn? Choose one of {names}"),
                }
            }
            Self::Coordinate { asked, names } => write!(
                f,
                "the state has no coordinate {asked}, only {}: name one of these, or its place counted from 0",
                names.join(", ")
            ),
        }
    }
}

impl Error for PlotError {}

/// The largest number of which differences and squares are safe from overflow.
const FARTHEST: f64 = 1e300;

/// `value` if it is finite, else an error naming `what`.
pub(crate) fn finite(value: f64, what: impl FnOnce() -> String) -> Result<f64, PlotError> {
    if value.abs() <= FARTHEST { Ok(value) } else { Err(PlotError::NotFinite { what: what(), value }) }
}

/// `value` if it is finite and not negative, else an error naming `what`.
pub(crate) fn magnitude(value: f64, what: impl Fn() -> String) -> Result<f64, PlotError> {
    if finite(value, &what)? < 0.0 { Err(PlotError::Negative { what: what(), value }) } else { Ok(value) }
}
