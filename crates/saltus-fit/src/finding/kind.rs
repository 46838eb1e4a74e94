//! What can be found.

use serde::{Deserialize, Serialize};

use super::detail::{Basis, By, Cause, Gives, Missing, Untried};
use super::doubt::Doubt;
use super::remark::{Note, Remark, Repair, Warning};
use crate::quantity::{Ball, CorModel, Measured, Readings, Sourced};

/// What was found, with its numbers: SI units, but for recordings of unknown scale.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
// docs/change/fitting-inside.md lists every kind with what raises it; the fields are named in full.
#[allow(missing_docs)]
pub enum FindingKind {
    // The reading of the table.
    ReadNote {
        note: Remark<Note>,
    },
    ReadRepair {
        repair: Remark<Repair>,
    },
    ReadWarning {
        warning: Remark<Warning>,
    },
    ReadDoubt {
        doubt: Doubt,
    },
    /// The table holds several balls or surfaces, each with a fit of its own.
    Groups {
        groups: usize,
        trusted: usize,
        refused: usize,
    },
    /// The table names the ball: the interval allows for its size and its air.
    BallNamed {
        ball: Ball,
        /// Whether its air is taken out of the COR, since the readings show it.
        air: bool,
    },
    /// The ball falls upwards under what is stated of the way that heights count.
    FallsUpwards {
        /// Whether they are stated to count downwards.
        down: bool,
    },

    // Evidence: contacts and heights put in order.
    Pairs {
        heard: usize,
        apart_s: f64,
    },
    ReleaseAmongContacts,
    ContactMissed {
        after_s: f64,
    },
    ContactTwice {
        at_s: f64,
    },
    ContactMisread {
        at_s: f64,
    },
    RunEnded {
        at_s: f64,
        left_out: usize,
        before: bool,
    },
    HeightLeftOut {
        height_m: f64,
    },
    TimeLeftOut {
        time_s: f64,
    },

    // Recordings: samples put in order.
    SameTime {
        samples: usize,
    },
    FramesRestored {
        rate: f64,
        rounded_s: f64,
    },
    Thinned {
        samples: usize,
        every: usize,
    },
    TurnedOver,
    EndsLeftOut {
        before: usize,
        after: usize,
        brief: bool,
    },
    WildLeftOut {
        samples: usize,
    },
    NoBounce {
        samples: usize,
    },
    TooFewSamples {
        samples: usize,
    },
    MotionUndetermined,
    NoSamples,

    // One kind of reading.
    Unbounded {
        readings: Readings,
        cor: f64,
    },
    Grows {
        readings: Readings,
        surely: bool,
    },
    JustEnough {
        readings: Readings,
    },
    SpreadDecides {
        readings: Readings,
        times: f64,
    },
    Misfit {
        readings: Readings,
        chi_square: f64,
        degrees_of_freedom: usize,
    },
    Widened {
        times: f64,
    },
    ErrorsTooLarge {
        readings: Readings,
        times: f64,
    },
    Lossless {
        readings: Readings,
    },
    SettingsDiffer {
        readings: Readings,
        low: (String, f64),
        high: (String, f64),
        p: f64,
    },
    MeanOfSettings,
    /// The COR differs by what stands in a column that was left aside.
    AsideDiffers {
        column: String,
        /// The cell of the trials with the lowest COR, and that COR; and of those with the highest.
        low: (String, f64),
        high: (String, f64),
        p: f64,
    },
    Loud {
        readings: Readings,
        part: f64,
    },
    /// Rebounds that do not follow the heights of release, of which these are the least and the
    /// greatest.
    Unmoved {
        low_m: f64,
        high_m: f64,
        rebound_m: f64,
    },
    OrderDrift {
        first: f64,
        last: f64,
        p: f64,
    },
    DropsDiffer {
        spread: f64,
        drops: usize,
    },
    BouncesScatter {
        readings: Readings,
        scatter: f64,
        sigma: Sourced,
    },
    Trend {
        p: f64,
    },
    TrendCauses,

    /// The contacts can be read in another way about as well, with another COR.
    ReadOtherwise {
        cor: f64,
        /// Which way: the flights that it counts from the first contact to the last, of the first
        /// trial that differs.
        flights: usize,
        instead_of: usize,
    },

    // Heights and times, and the table as a whole.
    SigmaAssumed {
        heights: bool,
        times: bool,
    },
    Disagree,
    Adrift {
        read: usize,
        adrift: usize,
    },
    FewFollow {
        read: usize,
        used: usize,
    },
    ZeroTooHigh {
        height_m: f64,
    },
    MethodsDiffer {
        first: By,
        first_cor: f64,
        second: By,
        second_cor: f64,
    },
    FirstFlightDiffers {
        cor: f64,
    },
    /// The table works out another COR than its readings give.
    StatedDiffers {
        /// The COR that the table works out, the median of all.
        stated: f64,
        /// That of its readings.
        cor: f64,
    },
    Vague {
        low: f64,
        high: f64,
    },
    FirstFlightAlone,
    NoReboundRead {
        high: f64,
    },
    OneHeight,
    OneContact,
    OneFlight,
    Undetermined,
    ExplanationsThinned {
        every: usize,
    },
    NoBootstrap {
        trials: usize,
    },

    // Models beside one COR.
    NotCompared {
        untried: Untried,
    },
    SpeedNotTried {
        bounces: usize,
        factor: f64,
        needs_bounces: usize,
        needs_factor: f64,
    },
    ModelFits {
        model: CorModel,
        missing: Option<Missing>,
        bic: f64,
        better: bool,
        gives: Gives,
    },
    OneCorFails {
        causes: Vec<Cause>,
    },
    MeasureZero,
    ErrorDecides {
        readings: Readings,
        sigma: Sourced,
        model: CorModel,
        about_best: f64,
        about_one: f64,
        doubted: bool,
    },
    ModelNotFitted {
        model: CorModel,
        untried: Option<Untried>,
        instead: bool,
    },
    ModelMisfit {
        model: CorModel,
        gives: Gives,
    },
    ModelBeaten {
        model: CorModel,
        gives: Gives,
    },
    ModelNotHeeded,
    DragNotHeeded,

    // Recordings: the motion.
    DragNeeded {
        bic: f64,
        cor_without: f64,
    },
    ContactShows {
        contact_s: Measured,
        bic: f64,
        cor_without: f64,
    },
    ModelsAlike {
        bic: f64,
        model: CorModel,
        cor: f64,
        other: CorModel,
        other_cor: f64,
    },
    ContactOpen {
        bic: f64,
        cor_instant: f64,
        cor_lasting: f64,
    },
    ImpactsDiffer {
        low: f64,
        high: f64,
    },
    /// A film goes on with another drop, which is not fitted.
    DroppedAgain {
        time_s: f64,
    },
    Rough {
        rms: f64,
        noise: f64,
    },
    /// Impacts that last a good part of the fall.
    Soft {
        contact_s: f64,
        fall_s: f64,
    },
    FloorDrifts {
        part_per_second: f64,
    },
    Drops {
        drops: usize,
    },
    AnotherBody {
        samples: usize,
    },
    /// The ball bounces then too, and not in the motion that is fitted.
    OtherMotion {
        from_s: f64,
        to_s: f64,
    },
    ManyWild {
        wild: usize,
        samples: usize,
    },
    GravityOff {
        gravity: f64,
        expected: f64,
        pixels: bool,
    },
    GainsSpeed,
    /// The times show the air, and the COR is that beside it.
    AirShows {
        /// Per metre.
        drag: Measured,
    },
    /// The COR is that without the air, whose drag was stated.
    DragHeld {
        drag_per_m: f64,
    },
    /// A film that keeps more of its speed than any ball.
    KeepsAll,
    /// Films of one bounce each ask for more drag than an ordinary ball has.
    DragUnheld {
        drag_per_m: f64,
        cor_with: f64,
    },
    /// The drag that was fitted is that of no ball.
    DragUnphysical {
        drag_per_m: f64,
    },
    /// Films of one table in pixels whose gravity is not the same.
    GravitiesDiffer {
        low: f64,
        high: f64,
    },
    /// A quantity that the COR rests on is not determined.
    GravityUndetermined,
    OneRecording,

    /// What a trusted COR rests on.
    RestsOn {
        basis: Basis,
    },
}
