//! What findings are made of: causes, bases, needs.

use serde::{Deserialize, Serialize};

use crate::quantity::{Ball, CorModel, Measured, Readings};

/// What one model of the readings gives: one COR, or those at the slowest and the fastest impact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Gives {
    /// One COR.
    #[serde(rename = "one")]
    One(Measured),
    /// Speed (m/s) and COR of the slowest and of the fastest impact.
    #[serde(rename = "range")]
    Range([[f64; 2]; 2]),
}

/// Why one COR does not describe the readings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "cause", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Cause {
    /// The COR depends on the speed of impact; without CORs where that was not tried.
    Speed {
        /// The CORs over the speeds.
        gives: Option<Gives>,
    },
    /// Air drag slows the ball.
    Drag {
        /// The COR with drag.
        gives: Gives,
    },
    /// The height scale reads too high.
    Offset {
        /// By how much, m.
        offset_m: f64,
        /// The COR with that taken off.
        gives: Gives,
    },
    /// Rebounds are read higher on the ball than the release.
    Rebounds {
        /// By how much, m.
        offset_m: f64,
        /// The COR with that taken off.
        gives: Gives,
    },
    /// Every contact takes time.
    Contact {
        /// How long, s.
        contact_s: f64,
        /// The COR with that taken off.
        gives: Gives,
    },
    /// A rebound is not in the table.
    Missed {
        /// Before which number, and in which trial where there are several.
        place: Missing,
        /// The COR with the later ones counted on.
        gives: Gives,
    },
    /// The COR differs from bounce to bounce.
    Each,
}

/// The place of a rebound that is not in the table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Missing {
    /// The number of the rebound that follows it in the table.
    pub before: usize,
    /// The trial's place in the table, from 0, where there are several.
    pub trial: Option<usize>,
}

/// Trials by one kind of reading, or by both together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct By {
    /// The kind of reading; both where it is none.
    pub readings: Option<Readings>,
    /// How many trials, where the two that are compared differ in that.
    pub trials: Option<usize>,
}

/// What else air drag may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Air {
    /// There is no drag.
    None,
    /// There is drag.
    Drag,
    /// Drag, or a COR that depends on speed: the samples cannot tell which.
    DragOrSpeed,
}

/// What a trusted COR rests on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "by", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Basis {
    /// One COR fits one kind of reading.
    One {
        /// The kind.
        readings: Readings,
    },
    /// Heights and times agree on one COR.
    Both,
    /// The same in some of the trials, which are all that have both.
    BothInSome {
        /// How many trials have both.
        both: usize,
        /// How many trials there are.
        trials: usize,
    },
    /// Heights and times agree in every drop; the COR is the mean over drops that differ.
    BothInEach,
    /// The COR is the mean over drops that differ by more than their readings.
    Mean,
    /// One motion fits the recordings.
    Recordings {
        /// How many there are.
        recordings: usize,
        /// Whether there is air drag in it.
        air: Air,
        /// How long the first impact lasts, s, where it shows.
        contact_s: Option<Measured>,
    },
    /// The model that was asked for fits.
    Model {
        /// The model.
        model: CorModel,
        /// What it gives.
        gives: Gives,
    },
}

/// Why other models of the readings were not compared with one COR.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "why", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Untried {
    /// The readings do not settle on one COR.
    Unsettled,
    /// The errors of times between contacts add up.
    AddedUp,
    /// Bounces scatter: of their ratios only three models are fitted.
    Scattering,
    /// Bounces scatter, and drops differ.
    ScatteringDrops,
    /// Heights and times are of different trials, or there is one flight only.
    Apart,
    /// Drops differ: other models would take that for their own.
    DropsDiffer,
    /// There are more readings than this.
    Readings {
        /// The limit.
        most: usize,
    },
    /// There are more bounces in a trial than this.
    Bounces {
        /// The limit.
        most: usize,
    },
    /// One COR is not between 0.01 and 1.
    Extreme,
    /// The model needs more than the readings give.
    Needs {
        /// What.
        need: Need,
    },
}

/// What a model needs of the readings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "of", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Need {
    /// Heights.
    Heights,
    /// The height of release of every drop.
    Releases,
    /// Times.
    Times,
    /// Up to so many bounces.
    FewBounces {
        /// The limit.
        most: usize,
    },
    /// Bounces at speeds that differ by a factor.
    Speeds {
        /// How many bounces, where that is asked for.
        bounces: Option<usize>,
        /// The factor.
        factor: f64,
        /// How many there are.
        here: usize,
        /// By which factor they differ.
        here_factor: f64,
    },
    /// More readings than unknowns.
    Spare {
        /// How many more.
        readings: usize,
    },
}

/// Why the interval reaches further than the error of the COR.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "takes_in", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Widening {
    /// Each of the balls, floors or drop heights.
    Settings,
    /// Models that fit as well with another COR.
    Models,
    /// All that the COR may be under the models that fit.
    Speeds,
    /// Both of two models of a recording.
    BothModels,
    /// Impacts that take time, and such that take none.
    ImpactTime,
    /// An impact whose duration does not show.
    SingleImpact {
        /// The time that is allowed for, s.
        contact_s: f64,
        /// By how much the COR would be lower.
        lower: f64,
    },
    /// The COR of every impact.
    EveryImpact,
    /// The zero of the height scale, which no height shows.
    Zero {
        /// By how much it may be off at most, m.
        zero_m: f64,
        /// By how much the COR may be off.
        share: f64,
    },
    /// The scale of lengths, which ties heights to times.
    Scale {
        /// By which part lengths may be wrong at most.
        part: f64,
        /// By how much the COR may be off.
        share: f64,
    },
    /// The height of release, which was taken as set.
    Release {
        /// Its standard error, m.
        sigma_m: f64,
        /// By how much the COR may be off.
        share: f64,
    },
    /// The drag of an ordinary ball, which the readings do not show.
    Air {
        /// The most drag that is allowed for, 1/m.
        most_per_m: f64,
        /// By how much the COR may be higher.
        share: f64,
        /// The ball that the table names, if it does.
        #[serde(default)]
        ball: Option<Ball>,
    },
    /// Readings that are means, which hide how far the COR scatters from drop to drop.
    Averages {
        /// Of how many readings each is the mean, as far as that is stated.
        drops: f64,
        /// By how much the COR may be off.
        share: f64,
    },
    /// The bend of the lens, which the samples do not show.
    Lens {
        /// By how much the COR may be off.
        share: f64,
    },
    /// A pattern in what the motion leaves of the samples.
    Misfit {
        /// What the motion leaves, and the scatter from sample to sample, in the recording's unit.
        rms: f64,
        /// The scatter from sample to sample.
        noise: f64,
        /// By how much the COR may be off.
        share: f64,
    },
}
