//! What speaks against trusting the readings of a table.

use serde::{Deserialize, Serialize};

use crate::word::words;

words! {
    /// What a remark changes of what the readings beside it mean.
    pub enum Change {
        /// The ball was not simply let go.
        Thrown = "thrown",
        /// It flew through something else than air, or met another floor than a level one at rest.
        Medium = "medium",
        /// Not every bounce is there.
        Counted = "counted",
        /// Readings are off, and were not corrected.
        Shifted = "shifted",
        /// Readings are not to be used.
        Void = "void",
        /// Numbers were not measured.
        Unread = "unread",
        /// A clock went slower or faster.
        Clock = "clock",
        /// Rows are in another order than that of bounces.
        Order = "order",
        /// The ball, or the floor, was another from some reading on, or readings are means over
        /// several.
        Changed = "changed",
        /// Whoever read them is not sure of them.
        Unsure = "unsure",
        /// So much of the remark is not understood that it may change anything.
        Unclear = "unclear",
    }
}

/// What speaks against trusting the readings, as far as the file tells.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Doubt {
    /// A title speaks of numbers that were not measured.
    Title {
        /// The title.
        text: String,
        /// Its line.
        line: u64,
    },
    /// A line speaks of heights and states a length that no reading takes in.
    Length {
        /// The line, as it stands.
        text: String,
        /// Its number.
        line: u64,
    },
    /// Heights are stated to be of another point of the ball than its lowest, and by how much they
    /// are too high is not stated.
    End {
        /// What says so.
        text: String,
        /// Its line.
        line: u64,
    },
    /// Nothing in the table says that something bounces, and the readings may be of anything.
    Unsaid {
        /// A column of the readings.
        column: String,
    },
    /// A heading, a title or a remark speaks of another motion than a bounce.
    Motion {
        /// What it says.
        text: String,
    },
    /// A column whose words are not understood rises and falls as the readings do, and says
    /// something else: it may be the one that holds them.
    Rival {
        /// The column that was left aside.
        column: String,
        /// The column that was read.
        of: String,
    },
    /// Releases are read at another end of the ball than rebounds.
    Datum {
        /// The column of the releases.
        drop: String,
        /// The column of the rebounds.
        rebound: String,
    },
    /// Each height that a bounce begins at is that of the row before times one factor.
    Repeated {
        /// The column of the heights before.
        column: String,
        /// That of the heights after, which it repeats.
        of: String,
    },
    /// A column was read of which a word is not understood, since no other holds what it does.
    Word {
        /// The column.
        column: String,
        /// The word.
        word: String,
    },
    /// Releases and rebounds are in different units, and their numbers are those of one.
    Units {
        /// The column of the releases.
        drop: String,
        /// The column of the rebounds.
        rebound: String,
    },
    /// Speeds before bounces are not those of a fall from the heights of release.
    Fall {
        /// The column of the heights of release, or what states one.
        drop: String,
        /// The column of the speeds.
        speed: String,
    },
    /// Two balls, floors or heights of release have the same readings to the last digit.
    Copied {
        /// One of the two.
        one: String,
        /// The one before it.
        other: String,
    },
    /// Each height is the one before it times one factor, to more digits than a ball keeps to.
    Computed {
        /// The factor.
        factor: String,
        /// How many heights follow from the one before.
        heights: usize,
    },
    /// Rows are taken for the bounces of one drop, one after the other, and in one trial of them
    /// the heights rise.
    Order {
        /// The trial.
        trial: String,
    },
    /// Sounds, or pulses of a sensor, were taken for contacts of a ball, and chance may have made
    /// them come as those do.
    Chance {
        /// How many there are.
        contacts: usize,
        /// Chance makes such contacts once in so many recordings like this.
        once_in: u64,
    },
    /// Sounds were taken for contacts of a ball, and do not grow fainter as those of a ball do.
    Undying {
        /// By how much they do from the first to the last, dB.
        lost_db: i32,
        /// By how much the energy of the impacts does.
        due_db: i32,
    },
    /// A remark changes what the readings mean.
    Remark {
        /// The remark.
        text: String,
        /// Its line, where it has one.
        line: Option<u64>,
        /// What it changes.
        change: Change,
    },
    /// Speeds stand beside the angles of their paths: of an oblique bounce the COR is of the
    /// components across the floor.
    Oblique {
        /// The column of the angles.
        column: String,
    },
    /// The COR follows from the time until the ball rests, and the last contacts are not those of a
    /// ball in flight.
    UntilRest,
}
