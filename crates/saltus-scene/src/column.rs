//! What a table of many runs may have of each, and how it is written.

use crate::cell::Cells;

/// A result of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Column {
    /// How many impacts there were.
    Impacts,
    /// When the first began.
    FirstImpact,
    /// And the last.
    LastImpact,
    /// How high the first ball rose after its first impact.
    FirstApex,
    /// From when on everything was at rest.
    Rest,
    /// Why the run ended: "time", "jumps", "zeno", "evaluations", "cascade"; or "refused" or
    /// "failed", and there was no run.
    End,
    /// When it ended.
    EndTime,
    /// Where each ball was then.
    Position,
    /// How fast each ball was then.
    Velocity,
    /// How fast each ball turned then.
    Spin,
    /// How many jumps there were.
    Jumps,
    /// How many steps were tried.
    Steps,
    /// How often flows and guards were evaluated.
    Evaluations,
    /// Why there was no run.
    Why,
}

impl Column {
    /// Every one, in the order in which they are written.
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

    /// Its name, which heads its cells where it has one for all balls.
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

    /// What it says of a run.
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

/// How rows are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowFormat {
    /// For a spreadsheet: cells with commas between.
    Csv,
    /// For programs: an object of JSON in each line.
    Jsonl,
}

impl RowFormat {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Csv, Self::Jsonl];

    /// Its name, which is what its files end in.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Jsonl => "jsonl",
        }
    }

    /// What it is for.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Csv => "For a spreadsheet",
            Self::Jsonl => "For programs: an object of JSON in each line",
        }
    }
}
