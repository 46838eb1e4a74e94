//! What a file holds and the readings do not, in words.

use std::fmt;

use crate::read::{LeftAside, Part, Why};

/// Why, in words: "left aside: 'ratio', which ...".
impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotUnderstood => "not understood",
            Self::Statistic => "sums up the others",
            Self::Predicted => "not measured",
            Self::Goal => "a goal",
            Self::Derived => "worked out from others",
            Self::Other => "neither a height nor a time of a bounce",
            Self::Note => "a remark",
            Self::Unnamed => "no name above it",
            Self::Hidden => "hidden",
            Self::NoTable => "no table of bounces",
            Self::Empty => "empty",
            Self::NotChosen => "another was asked for",
            Self::Elsewhere => "all of its events stand in another",
            Self::Computed => "computed from the times by the program that wrote it",
            Self::Still => "it hardly moves (choose with --column)",
            Self::Void => "marked as one that does not count",
            Self::NoRate => "frames of unknown rate, and heights that need no clock (--fps)",
            Self::Unresolved => "at the time of the event before it, as is what follows",
            Self::NotHeard => "a time of 0 is one that was not heard",
            Self::Echo => "an echo of a contact, or its ringing",
            Self::Close => "contacts too close together for their times to tell the COR",
            Self::NoBounce => "not when a contact of the ball is due",
            Self::Fainter => "contacts show more in another",
        })
    }
}

impl fmt::Display for LeftAside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.what {
            Part::Column => "column",
            Part::Row => "row",
            Part::Cell => "cell",
            Part::Text => "text",
            Part::Sheet => "sheet",
            Part::Track => "track",
            Part::Sound => "sound",
            Part::Pulse => "pulse",
        };
        if let Some(within) = &self.within {
            write!(f, "{within}: ")?;
        }
        write!(f, "{what} '{}'", self.name)?;
        if let Some(line) = self.line {
            write!(f, " in line {line}")?;
        }
        write!(f, ": {}", self.why)
    }
}
