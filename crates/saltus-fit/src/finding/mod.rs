//! What the stages find beside the COR, as data: pushed where it is computed, worded in
//! `report/words.rs` alone.

mod detail;
mod doubt;
mod kind;
mod place;
mod remark;

use serde::{Deserialize, Serialize};

pub use detail::{Air, Basis, By, Cause, Gives, Missing, Need, Untried, Widening};
pub use doubt::{Change, Doubt};
pub use kind::FindingKind;
pub use place::{Lines, Spot};
pub use remark::{Named, Note, Pace, Parts, Program, Remark, Repair, Shape, Warning};

use crate::word::words;

words! {
    /// What a finding means for the COR.
    pub enum Severity {
        /// Worth knowing; the COR stands.
        Note = "note",
        /// Something speaks against the COR.
        Doubt = "doubt",
        /// There is no COR, for this reason.
        Refusal = "refusal",
    }
}

/// Where in the table a finding belongs; all of it where nothing is set.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct At {
    /// The trial's place in the table, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trial: Option<usize>,
    /// The name of the trial; empty where the table holds one trial without a name.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// The number of the bounce, from 1; 0 is the release.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bounce: Option<usize>,
    /// The line of the file, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub row: Option<u64>,
}

/// One thing that was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Finding {
    /// What it means for the COR.
    pub severity: Severity,
    /// What was found, with its numbers.
    #[serde(flatten)]
    pub kind: FindingKind,
    /// Where.
    #[serde(default)]
    pub at: At,
}

impl Finding {
    /// A finding about the table as a whole.
    pub(crate) fn new(severity: Severity, kind: FindingKind) -> Self {
        Self { severity, kind, at: At::default() }
    }

    pub(crate) fn note(kind: FindingKind) -> Self {
        Self::new(Severity::Note, kind)
    }

    pub(crate) fn doubt(kind: FindingKind) -> Self {
        Self::new(Severity::Doubt, kind)
    }

    pub(crate) fn refusal(kind: FindingKind) -> Self {
        Self::new(Severity::Refusal, kind)
    }

    pub(crate) fn at(mut self, at: At) -> Self {
        self.at = at;
        self
    }
}

impl At {
    pub(crate) fn bounce(mut self, bounce: usize) -> Self {
        self.bounce = Some(bounce);
        self
    }
}
