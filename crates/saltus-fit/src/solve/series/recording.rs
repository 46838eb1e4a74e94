//! A fitted recording in the table's own units.

use serde::{Deserialize, Serialize};

use crate::finding::At;
use crate::quantity::{CorModel, Measured};

/// A recording of one drop, as a motion fitted through its samples.
///
/// Lengths are in the unit of the table's heights (metres, unless the scale is wrong), times in
/// seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Track {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// How many samples the motion was fitted to.
    pub samples: usize,
    /// How many were left out before the fall and after the last flight, and how many as outliers
    /// between.
    pub left_out: [usize; 3],
    /// The impacts, each with its own COR.
    pub impacts: Vec<Impact>,
    /// The gravity of the recording: that of the place, if scale and clock are right.
    pub gravity: Measured,
    /// The drag coefficient k of v' = −g ∓ k v², per unit of length; none where the motion has no
    /// drag.
    pub drag: Option<Measured>,
    /// The speed at which the floor moves on the table's scale, as where the camera turns; none
    /// where it stands still.
    pub drift: Option<Measured>,
    /// The time that the ball stays on the floor at the speed of about the first impact, in
    /// seconds; none where that is too short to show.
    pub contact: Option<Measured>,
    /// The height of the ball in contact with the floor, on the table's scale; where that drifts,
    /// at the first impact.
    pub floor: Measured,
    /// The root mean square of what is left between motion and samples.
    pub rms: f64,
    /// The scatter from sample to sample, without any model.
    pub noise: f64,
    /// The models tried, that with the least BIC first.
    pub models: Vec<Variant>,
    /// What drag that was not fitted, and the lens, can do to the COR.
    #[serde(skip)]
    pub(crate) unseen: Option<Unseen>,
    /// The drag of the model of one COR that leaves it free, 1/m by the recording's own gravity.
    #[serde(skip)]
    pub(crate) free_drag: Option<Measured>,
    /// What a pattern as large as the motion leaves can do to the COR.
    #[serde(skip)]
    pub(crate) reach: f64,
    #[serde(skip)]
    pub(crate) course: Course,
}

/// By how much the COR is off by what the samples do not show: by all of it, by the air, by the
/// lens; each a mean and a standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unseen {
    pub(crate) shift: Measured,
    pub(crate) air: Measured,
    pub(crate) lens: Measured,
    /// Of one impact, which does not show drag and COR both: the most drag that the samples allow,
    /// up to that of the lightest ball, 1/m, and by how much the COR is higher with it.
    pub(crate) light: Option<(f64, f64)>,
}

/// Gravity within this part of the expected means metres and seconds.
const METRES: f64 = 0.2;

impl Track {
    /// Where its findings belong.
    pub(crate) fn place(&self) -> At {
        At { trial: Some(self.trial), name: format!("trial {}", self.trial + 1), ..At::default() }
    }

    /// Whether lengths are in metres and times in seconds, going by the recording's gravity where
    /// `gravity` is expected, m/s².
    #[must_use]
    pub fn in_metres(&self, gravity: f64) -> bool {
        in_metres(self.gravity.value, gravity)
    }
}

/// The same of a gravity that was found.
pub(crate) fn in_metres(found: f64, expected: f64) -> bool {
    (found / expected - 1.0).abs() <= METRES
}

/// One impact of a recorded ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Impact {
    /// The number of the impact, from 1.
    pub bounce: usize,
    /// When, in seconds.
    pub time: f64,
    /// The speed of arrival.
    pub speed: f64,
    /// The ratio of the speeds after and before.
    pub cor: Measured,
}

/// One model of a recording beside the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Variant {
    /// The COR: `constant`, `linear` in speed, or one for `each` impact.
    pub law: CorModel,
    /// Whether there is drag in it.
    pub drag: bool,
    /// How many unknowns it has.
    pub unknowns: usize,
    /// The root mean square of what it leaves.
    pub rms: f64,
    /// Its BIC less the least.
    pub bic: f64,
    /// Its COR; if it has several, their mean, each weighing by its error.
    pub cor: Measured,
}

/// The fitted course of a ball, in the table's units with the floor at zero, for pictures.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Course {
    /// Impact times, and time and height of each apex, that of the fall first.
    pub(crate) contacts: Vec<f64>,
    pub(crate) apexes: Vec<(f64, f64)>,
    pub(crate) gravity: f64,
    pub(crate) drag: f64,
    /// How long each impact lasts.
    pub(crate) lasting: Vec<f64>,
    /// Sample times, heights above the floor, and what the motion leaves of them.
    pub(crate) samples: Vec<(f64, f64, f64)>,
}
