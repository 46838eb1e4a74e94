//! What a measurement would bring, before it is made.

use serde::{Deserialize, Serialize};

use crate::finding::Widening;
use crate::quantity::Readings;
use crate::word::words;

words! {
    /// A way to measure bounces.
    pub enum Way {
        /// Heights by eye beside a ruler, to 1 cm.
        Ruler = "ruler",
        /// Heights off a film beside a ruler, to 3 mm.
        FilmedRuler = "filmed-ruler",
        /// Contact times off a film of 30 frames a second.
        Film30 = "film-30",
        /// Contact times off a film of 60 frames a second.
        Film60 = "film-60",
        /// Contact times off a film of 120 frames a second.
        Film120 = "film-120",
        /// Contact times off a film of 240 frames a second.
        Film240 = "film-240",
        /// Contact times off a sound recording, to 1 ms.
        Sound = "sound",
    }
}

impl Way {
    /// All of them, the simplest first.
    pub const ALL: [Self; 7] =
        [Self::Ruler, Self::FilmedRuler, Self::Film30, Self::Film60, Self::Film120, Self::Film240, Self::Sound];

    /// What it reads.
    #[must_use]
    pub const fn readings(self) -> Readings {
        match self {
            Self::Ruler | Self::FilmedRuler => Readings::Heights,
            _ => Readings::Times,
        }
    }

    /// The standard error of one reading: metres, or seconds. On a film a time is that of a frame,
    /// off by its duration over √12.
    #[must_use]
    pub fn sigma(self) -> f64 {
        let frame = |rate: f64| 1.0 / rate / 12f64.sqrt();
        match self {
            Self::Ruler => 0.01,
            Self::FilmedRuler => 0.003,
            Self::Film30 => frame(30.0),
            Self::Film60 => frame(60.0),
            Self::Film120 => frame(120.0),
            Self::Film240 => frame(240.0),
            Self::Sound => 0.001,
        }
    }
}

/// Ways to know a COR to within what is wanted: see [`Fit::plan`](crate::Fit::plan).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Plan {
    /// The half-width of the 95 % interval that is wanted.
    pub want: f64,
    /// The COR that is expected.
    pub cor: f64,
    /// The height of the drop, m.
    pub drop_m: f64,
    /// What each way needs, in the order of [`Way::ALL`]; a way that shows no bounce of this ball
    /// is not there.
    pub ways: Vec<Planned>,
}

/// A planned measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Planned {
    /// How it is made.
    pub way: Way,
    /// How many drops.
    pub drops: usize,
    /// How many bounces of each: so many rebounds, or flights between contacts.
    pub bounces: usize,
    /// How many readings that makes.
    pub readings: usize,
    /// The half-width of the 95 % interval that it brings, by the longer side.
    pub half_width: f64,
    /// Whether that is what was wanted; if not, more drops hardly help, and this is what stands in
    /// the way.
    pub enough: bool,
    /// What the interval takes in that no number of drops removes.
    pub takes_in: Vec<Widening>,
}
