//! The columns of a table of many runs, and the forms in which it is written.

use crate::cell::Cells;

/// A result of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Column {
    /// The number of impacts.
    Impacts,
    /// The time of the first impact.
    FirstImpact,
    /// The time of the last impact.
    LastImpact,
    /// The height of the first ball's apex after its first impact.
    FirstApex,
    /// The time from which everything is at rest.
    Rest,
    /// The reason of the end: "time", "jumps", "zeno", "evaluations", "cascade"; or "refused" or
    /// "failed", and there was no run.
    End,
    /// The time of the end.
    EndTime,
    /// The place of each ball at the end.
    Position,
    /// The velocity of each ball at the end.
    Velocity,
    /// The spin of each ball at the end.
    Spin,
    /// The number of jumps.
    Jumps,
    /// The number of trial steps.
    Steps,
    /// The number of evaluations of flows and guards.
    Evaluations,
    /// The reason why there was no run.
    Why,
}

impl Column {
    /// All columns, in the order in which they are written.
    pub const ALL: [Self; 14] = [
        Self::Impacts,
        Self::FirstImpact,
        Self::LastImpact,
        Self::FirstApex,
        Self::Rest,
        Self::End,
        Self::EndTime,
        Self::Position,
        Self::Velocity,
        Self::Spin,
        Self::Jumps,
        Self::Steps,
        Self::Evaluations,
        Self::Why,
    ];

    /// The name of the column, which heads its cells where it has one for all balls.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Impacts => "impacts",
            Self::FirstImpact => "first_impact_s",
            Self::LastImpact => "last_impact_s",
            Self::FirstApex => "first_apex_m",
            Self::Rest => "rest_s",
            Self::End => "end",
            Self::EndTime => "end_s",
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Spin => "spin",
            Self::Jumps => "jumps",
            Self::Steps => "steps",
            Self::Evaluations => "evaluations",
            Self::Why => "why",
        }
    }

    /// A sentence about the column.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Impacts => "How many impacts there were",
            Self::FirstImpact => "When the first began",
            Self::LastImpact => "And the last",
            Self::FirstApex => "How high the first ball rose after its first impact",
            Self::Rest => "From when on everything was at rest",
            Self::End => {
                "Why the run ended: \"time\", \"jumps\", \"zeno\", \"evaluations\", \"cascade\"; or \"refused\" or \"failed\", and there was no run"
            }
            Self::EndTime => "When it ended",
            Self::Position => "Where each ball was then",
            Self::Velocity => "How fast each ball was then",
            Self::Spin => "How fast each ball turned then",
            Self::Jumps => "How many jumps there were",
            Self::Steps => "How many steps were tried",
            Self::Evaluations => "How often flows and guards were evaluated",
            Self::Why => "Why there was no run",
        }
    }

    /// A column of its kind, without cells.
    pub(crate) const fn cells(self) -> Cells {
        match self {
            Self::Impacts | Self::Jumps | Self::Steps | Self::Evaluations => Cells::COUNTS,
            Self::End | Self::Why => Cells::WORDS,
            _ => Cells::NUMBERS,
        }
    }
}

/// A form in which rows are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowFormat {
    /// CSV, for a spreadsheet.
    Csv,
    /// JSON Lines, for programs: an object in each line.
    Jsonl,
}

impl RowFormat {
    /// Both forms.
    pub const ALL: [Self; 2] = [Self::Csv, Self::Jsonl];

    /// The name of the form, which is also the ending of its files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Jsonl => "jsonl",
        }
    }

    /// A sentence about the form.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Csv => "For a spreadsheet",
            Self::Jsonl => "For programs: an object of JSON in each line",
        }
    }
}
