//! What reading a table brought up beside its readings: how it was taken, what was mended, what to
//! keep in mind.

use serde::{Deserialize, Serialize};

use super::place::{Lines, Spot};
use crate::word::words;

words! {
    /// What wrote a file, or how it is laid out as no table by hand is.
    pub enum Program {
        /// A track of labels of a sound program, such as Audacity.
        Labels = "labels",
        /// `ImageJ`, its table of tracks.
        ImageJ = "imagej",
        /// Tracker.
        Tracker = "tracker",
        /// A program by Vernier.
        Vernier = "vernier",
        /// Runs side by side, a blank column between.
        SideBySide = "side-by-side",
    }
}

/// A remark on a table, or on those parts of it that it holds for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Remark<K> {
    /// What it says.
    #[serde(flatten)]
    pub kind: K,
    /// The parts it holds for, files before the sheets in them; all of the table if there are none.
    #[serde(default = "Vec::new", skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Parts>,
}

/// Parts of one kind, such as sheets: the first, the last, and how many there are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Parts {
    /// The name of the first.
    pub first: String,
    /// The name of the last; that of the first, if there is one only.
    pub last: String,
    /// How many there are.
    pub count: usize,
}

impl<K> From<K> for Remark<K> {
    fn from(kind: K) -> Self {
        Self { kind, parts: Vec::new() }
    }
}

impl<K> Remark<K> {
    /// The remark, made of one part of a larger table.
    pub(crate) fn of(mut self, part: &str) -> Self {
        self.parts.insert(0, Parts { first: part.to_owned(), last: part.to_owned(), count: 1 });
        self
    }
}

/// What the columns of a table were taken for; names are those of columns.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "layout", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Shape {
    /// Releases, contacts and apexes, a row each.
    Events,
    /// The moments and the heights of tops.
    Tops {
        /// The times.
        times: String,
        /// The heights.
        heights: String,
    },
    /// Times of contacts, and the heights reached after them.
    ContactsAndHeights {
        /// The times.
        times: String,
        /// The heights.
        heights: String,
    },
    /// Times of contacts.
    Contacts {
        /// The times.
        times: String,
    },
    /// Times between contacts.
    Intervals {
        /// The times.
        intervals: String,
    },
    /// Heights, and times between contacts.
    IntervalsAndHeights {
        /// The times.
        intervals: String,
        /// The heights.
        heights: String,
    },
    /// Heights, the release among them.
    Heights {
        /// The heights.
        heights: String,
        /// Whether a number tells the bounce, or the order of the rows.
        numbered: bool,
    },
    /// A drop a row.
    Drops {
        /// What tells the release, where one column does.
        release: Option<String>,
        /// What tells the rebound, where one column does.
        rebound: Option<String>,
    },
    /// A trial a row, a bounce a column.
    Wide,
    /// Where the ball was, in time.
    Series {
        /// The heights.
        heights: String,
        /// The times; none where the rows are frames.
        times: Option<String>,
    },
}

/// How a table was taken.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Note {
    /// How much it holds.
    Size {
        /// Rows that hold readings.
        rows: usize,
        /// Drops, or recordings.
        trials: usize,
    },
    /// What its columns are.
    ReadAs {
        /// The layout.
        #[serde(flatten)]
        shape: Shape,
        /// How many tables of the kind stand side by side.
        side_by_side: usize,
        /// Whether speeds stand for heights.
        speeds: bool,
    },
    /// The program that wrote it.
    Recognised {
        /// The program.
        program: Program,
    },
    /// How its text is encoded, where that is not UTF-8.
    Encoded {
        /// The encoding's name.
        encoding: String,
    },
    /// A line states the frame rate, or that of the samples of a sound; or the name of the file.
    Rate {
        /// The rate, 1/s.
        rate: f64,
        /// The line; none for the name.
        line: Option<u64>,
    },
    /// A sound was listened to.
    Heard {
        /// How many sounds stand out of the noise.
        sounds: usize,
        /// How many of them are contacts that count.
        contacts: usize,
        /// The part that was listened to, s.
        from: f64,
        /// Its end, s.
        to: f64,
    },
    /// The samples of a sensor have pulses.
    Felt {
        /// The column.
        column: String,
        /// How many pulses stand out of the noise.
        pulses: usize,
        /// How many of them are contacts that count.
        contacts: usize,
    },
    /// Speeds of a ball in flight tell when it was at its tops.
    Flown {
        /// The column.
        column: String,
        /// How many flights show.
        flights: usize,
    },
    /// A sound was recorded too loud.
    Overdriven {
        /// The part of its samples that are as large as can be.
        part: f64,
    },
    /// Of several coordinates this one is the height.
    Vertical {
        /// Its name.
        column: String,
    },
    /// Tracks that hardly move were left aside.
    Still {
        /// Their names.
        tracks: Vec<String>,
    },
    /// The sheets that hold tables.
    Sheets {
        /// Their names.
        sheets: Vec<String>,
        /// Whether the names are heights of release.
        drops: bool,
    },
    /// The sheets that hold none.
    SheetsAside {
        /// Their names.
        sheets: Vec<String>,
    },
    /// A filter was asked for.
    Filtered {
        /// Rows that pass it.
        kept: usize,
        /// Rows that do not.
        left_out: usize,
    },
    /// Words of a column that is not understood tell groups apart, by which the COR differs.
    Apart {
        /// The column.
        column: String,
    },
    /// The height of release is stated beside the readings.
    Dropped {
        /// It, m.
        height_m: f64,
    },
    /// A row tells what the scale reads at the floor.
    Floor {
        /// The cell as it stands.
        reading: String,
        /// Whether the scale counts downwards.
        down: bool,
    },
    /// Contacts begin and end: flights are from the end of each to the begin of the next.
    Aloft {
        /// How long a contact lasts, the median, s.
        contact_s: f64,
    },
    /// Times fall from bounce to bounce: they are times between contacts.
    FallingTimes,
    /// Times between contacts rise from row to row: they are those of a running clock.
    RisingTimes {
        /// The column.
        column: String,
    },
    /// Marks that part thousands, and are no decimal ones.
    Thousands {
        /// A number with such a mark.
        cell: String,
    },
    /// A word before the first of the bounces that are counted stands for the release.
    Start {
        /// The word.
        name: String,
    },
    /// Losses add up from bounce to bounce.
    Losses {
        /// The column.
        column: String,
    },
    /// Numbered columns are repeats, and not bounces one after another.
    Repeats {
        /// The columns.
        columns: Vec<String>,
    },
    /// Columns of one name are repeats.
    Namesakes {
        /// The name.
        column: String,
    },
    /// Heights were left aside that phyphox computes from the times.
    Computed,
    /// A column of ratios is of heights.
    Share {
        /// The column.
        column: String,
        /// Whether the ratios are to the release, or of each rebound to its drop.
        of_release: bool,
    },
    /// A column of energies stands for heights.
    Energy {
        /// The column.
        column: String,
    },
    /// A column without a unit has that of another.
    SameUnit {
        /// The column.
        column: String,
        /// The other.
        of: String,
    },
    /// A column without a unit has the one in which it lasts as long as a ball bounces.
    UnitBySize {
        /// The column.
        column: String,
        /// The unit.
        unit: String,
    },
    /// A column without a unit is in pixels.
    Pixels {
        /// The column.
        column: String,
    },
    /// A count of frames without a rate, beside places without a scale.
    AnyRate {
        /// The column.
        column: String,
        /// Frames a second that stand in for those that nobody states.
        rate: f64,
    },
    /// Heights in pixels beside times: their scale is the one by which flights last as they do.
    ByFlights {
        /// A pixel, m.
        metres: f64,
    },
    /// A word of a heading is misspelt.
    Misspelt {
        /// The word as it stands.
        written: String,
        /// The heading.
        heading: String,
        /// The word that is meant.
        meant: String,
    },
    /// The clock of a series starts again.
    Restarts {
        /// How often.
        times: usize,
    },
    /// Heights of a series count downwards.
    Downwards {
        /// Whether the ball's fall shows it; else it is so in pictures.
        shown: bool,
    },
    /// Rebounds follow from their times.
    ByTime {
        /// Gravity, m/s².
        gravity: f64,
    },
}

/// A trial by its place in the table, from 1, and its name, which may be empty.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Named {
    /// Its place.
    pub trial: usize,
    /// Its name.
    pub name: String,
}

/// What was left out or mended in reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Repair {
    /// A file was given twice.
    SameFile {
        /// The second.
        file: String,
        /// The first.
        as_file: String,
    },
    /// A row says what the row before it says.
    SameLine {
        /// Its line.
        line: u64,
    },
    /// Samples were given twice alike.
    SameSamples {
        /// How many.
        samples: usize,
    },
    /// A trial repeats another, reading by reading.
    SameTrial {
        /// The second.
        trial: Named,
        /// The first.
        as_trial: Named,
    },
    /// Numbers of bounces are nearly whole, as if read off a diagram.
    RoundedNumbers,
    /// Rows of a series hold no position.
    NoPosition {
        /// The lines.
        lines: Lines,
    },
}

/// The rate at which a series would fall as balls do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "pace", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Pace {
    /// The rate that would be right, where one is stated, 1/s.
    Frames {
        /// The rate.
        rate: f64,
    },
    /// The recording runs slower, or faster, than life.
    Clock {
        /// The rate at which it was filmed, as a part of that at which it is played.
        factor: f64,
        /// The rate at which it is played, 1/s.
        played: f64,
    },
}

/// What to keep in mind of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Warning {
    /// The highest reading is beyond any usual drop.
    Size {
        /// It, m.
        height_m: f64,
        /// Its line.
        line: u64,
    },
    /// Rebounds are of zero height.
    Zeros {
        /// The lines.
        lines: Lines,
    },
    /// A series falls with another gravity than that of the place.
    Gravity {
        /// As it falls, m/s².
        found: f64,
        /// As is due, m/s².
        due: f64,
        /// What would mend it.
        #[serde(flatten)]
        pace: Pace,
    },
    /// The stated unit is another than the one that a column names.
    UnitAgainstName {
        /// The column.
        column: String,
        /// The stated unit.
        unit: String,
    },
    /// A height is out of line with the others of its trial.
    Stray {
        /// Where.
        at: Spot,
        /// The cell as it stands.
        reading: String,
        /// By how much it would have to be multiplied.
        factor: f64,
        /// The number that it would be then, in the unit of its column.
        instead: f64,
    },
    /// More heights are out of line than are named.
    MoreStrays {
        /// How many more.
        heights: usize,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_are_named_as_one_glance_counts() {
        assert_eq!(Lines::of(&[2, 3, 5, 7, 11, 13, 17]), Lines { first: vec![2, 3, 5, 7, 11], count: 7 });
    }
}
