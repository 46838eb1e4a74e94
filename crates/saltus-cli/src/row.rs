//! A run in a report for programs: what was measured, or why there is nothing.

use saltus::Timing;
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Row<T> {
    /// What was run: "as it is", "without wind", "Tsit5 1e-6".
    pub(crate) run: String,
    /// What came of it.
    #[serde(flatten)]
    pub(crate) came: Came<T>,
}

#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum Came<T> {
    Measured(T),
    /// Why there is no such run.
    Refused {
        refused: String,
    },
}

/// Wall-clock times of a run in s: the median, the least and the greatest.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Seconds {
    seconds: f64,
    seconds_low: f64,
    seconds_high: f64,
}

impl From<Timing> for Seconds {
    fn from(Timing { median, least, greatest }: Timing) -> Self {
        Self { seconds: median, seconds_low: least, seconds_high: greatest }
    }
}

impl Seconds {
    /// The median, the least and the greatest.
    pub(crate) const fn all(self) -> [f64; 3] {
        [self.seconds, self.seconds_low, self.seconds_high]
    }
}
