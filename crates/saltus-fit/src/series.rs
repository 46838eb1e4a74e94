//! Series of heights in time: a tracked ball, frame by frame.
//!
//! The series is cut into flights, parabolas give a first sketch, and the whole motion is fitted through every sample, with drag and
//! without, with one COR, one that depends on speed, and one for every impact; and again with impacts that last. What the samples prefer decides.
//! Neither gravity nor the scale nor the unit of time enters the COR, so they are fitted too, and reported.

mod flights;
mod frames;
mod judge;
mod motion;
mod parabolas;
mod pool;
mod track;
mod wild;

use serde::Serialize;

use crate::bounces::Measured;
use crate::error::FitError;
use crate::estimate::identified;
use crate::least_squares::Failure;
use crate::orientation::falls_upwards;
use crate::table::{Event, Table, Trial};
use flights::NoFlights;

pub(crate) use judge::judge;
pub(crate) use pool::Pooled;

/// More samples of one recording than this are thinned.
const SAMPLES: usize = 50_000;

/// A recording of one drop, as a motion fitted through its samples.
///
/// Lengths are in the unit of the table's heights (metres, unless the scale is wrong), times in seconds.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Track {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// How many samples the motion was fitted to.
    pub samples: usize,
    /// How many were left out before the fall and after the last flight, and how many as outliers between.
    pub left_out: [usize; 3],
    /// The impacts, each with its own COR.
    pub impacts: Vec<Impact>,
    /// The gravity of the recording: that of the place, if scale and clock are right.
    pub gravity: Measured,
    /// The drag coefficient k of v' = −g ∓ k v², per unit of length; none where the motion has no drag.
    pub drag: Option<Measured>,
    /// The speed at which the floor moves on the table's scale, as where the camera turns; none where it stands still.
    pub drift: Option<Measured>,
    /// The time that the ball stays on the floor at the speed of about the first impact, in seconds; none where that is too short to be seen.
    pub contact: Option<Measured>,
    /// The height of the ball in contact with the floor, on the table's scale; where that drifts, at the first impact.
    pub floor: Measured,
    /// The root mean square of what is left between motion and samples.
    pub rms: f64,
    /// The scatter from sample to sample, without any model.
    pub noise: f64,
    /// The models tried, that with the least BIC first.
    pub models: Vec<Variant>,
    #[serde(skip)]
    pub(crate) course: track::Course,
}

/// Gravity within this part of the expected means metres and seconds.
const METRES: f64 = 0.2;

impl Track {
    /// Whether lengths are in metres and times in seconds, going by the recording's gravity where `gravity` is expected, m/s².
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Variant {
    /// The COR: `constant`, `linear` in speed, or one for `each` impact.
    pub law: &'static str,
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

/// What became of every series of a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Series {
    pub(crate) tracks: Vec<Track>,
    pub(crate) pooled: Option<Pooled>,
    /// The same with contacts that take no time where these do, and the other way round; and by how much its BIC is worse.
    pub(crate) otherwise: Option<(Pooled, f64)>,
    /// Trials whose series show no bounce that can be fitted, and why.
    pub(crate) refused: Vec<(usize, String)>,
    pub(crate) repairs: Vec<String>,
    /// What was stated about the way that heights count, where the ball then falls upwards.
    pub(crate) falls_upwards: Option<&'static str>,
}

/// Fits every series of the table, with wild samples left out if `repair`; `None` if it has none.
pub(crate) fn fit(table: &Table, repair: bool) -> Result<Option<Series>, FitError> {
    let mut series = Series { falls_upwards: table.metadata.falls_upwards, ..Series::default() };
    let mut seen = false;
    let mut recordings = Vec::new();
    for (n, trial) in table.trials().iter().enumerate() {
        let Some((samples, repairs)) = samples(trial, table.metadata.oriented, repair) else { continue };
        seen = true;
        let of = match (trial.label(), table.trials().len()) {
            (_, 1) => String::new(),
            ("", _) => format!("trial {}: ", n + 1),
            (label, _) => format!("{label}: "),
        };
        let found = match track::Recording::of(n, &samples, repair) {
            Ok(found) => Some(found),
            Err(track::Refusal::Flights(why)) => {
                series.refused.push((n, format!("{of}{}", reason(why, samples.times.len()))));
                None
            }
            Err(track::Refusal::Fit(failure)) => {
                let unidentified: Option<()> = identified("a series of heights", Err(failure))?;
                debug_assert!(unidentified.is_none());
                let why = "the samples of the flights do not determine a motion: they are too few, too rough, or not of a ball in flight";
                series.refused.push((n, format!("{of}{why}")));
                None
            }
        };
        recordings.push((of, repairs, found));
    }
    if !seen {
        return Ok(None);
    }
    let fitted = || recordings.iter().filter_map(|(_, _, found)| found.as_ref());
    // Positive where contacts that take time are better.
    let gain: f64 = fitted().filter_map(track::Recording::gain).sum();
    let under = |lasting: bool| {
        let candidates: Vec<&track::Candidates> = fitted().map(|found| found.under(lasting)).collect();
        let choice = track::choose(&candidates);
        let tracks: Vec<Track> = candidates.iter().filter_map(|candidates| candidates.track(choice)).collect();
        (pool::pool(&tracks, choice), tracks)
    };
    (series.pooled, series.tracks) = under(gain > 0.0);
    if fitted().any(|found| found.gain().is_some()) {
        series.otherwise = under(gain <= 0.0).0.map(|pooled| (pooled, gain.abs()));
    }
    for (of, mut repairs, found) in recordings {
        repairs.extend(found.iter().flat_map(|found| found.under(gain > 0.0).repairs()));
        series.repairs.extend(repairs.into_iter().map(|r| format!("{of}{r}")));
    }
    Ok(Some(series))
}

/// Times and heights of a series, ascending in time and each time once; heights upwards.
#[derive(Clone, Debug)]
pub(crate) struct Samples {
    pub(crate) times: Vec<f64>,
    pub(crate) heights: Vec<f64>,
    /// Whether the heights were counted downwards, and turned over.
    pub(crate) turned: bool,
}

/// The series of a trial, put in order and the right way up unless that was stated, with the times of its frames if `repair`, and what had to be done
/// for it; `None` if it has none.
fn samples(trial: &Trial, oriented: bool, repair: bool) -> Option<(Samples, Vec<String>)> {
    let mut rows: Vec<(f64, f64, u64)> = trial
        .readings()
        .iter()
        .filter(|r| r.event == Event::Sample)
        .filter_map(|r| Some((r.time?, r.height?, r.line)))
        .collect();
    if rows.is_empty() {
        return None;
    }
    let mut repairs = Vec::new();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    let before = rows.len();
    rows.dedup_by(|b, a| a.0 == b.0);
    if rows.len() < before {
        let many = before - rows.len();
        repairs.push(format!("{many} samples at a time that another sample has: the first of each was used"));
    }
    let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
    if let Some(frames) = frames::of(&times).filter(|_| repair) {
        rows.iter_mut().zip(frames.times).for_each(|(row, time)| row.0 = time);
        repairs.push(format!(
            "the times are those of {:.5} frames a second, rounded to {} ms: each frame was given its own time",
            frames.rate,
            1000.0 * frames.rounded
        ));
    }
    let every = rows.len().div_ceil(SAMPLES);
    if every > 1 {
        repairs.push(format!(
            "of {} samples one in {every} is used: more would hardly make the COR more certain",
            rows.len()
        ));
        rows = rows.into_iter().step_by(every).collect();
    }
    let times: Vec<f64> = rows.iter().map(|r| r.0).collect();
    let heights: Vec<f64> = rows.iter().map(|r| r.1).collect();
    let recording = [(times, heights)];
    let turned = !oriented && falls_upwards(&recording) == Some(true);
    let [(times, mut heights)] = recording;
    if turned {
        heights.iter_mut().for_each(|h| *h = -*h);
        repairs
            .push("the heights grow downwards (the ball turns sharply at the top): they were turned over".to_owned());
    }
    Some((Samples { times, heights, turned }, repairs))
}

fn reason(why: NoFlights, samples: usize) -> String {
    match why {
        NoFlights::NoBounce => {
            format!("there is no bounce in this series of {samples} heights: the ball never falls and rises again")
        }
        NoFlights::TooFew => format!(
            "this series of {samples} heights has too few samples beside its bounce: a flight needs at least four before and after"
        ),
    }
}

impl From<Failure> for track::Refusal {
    fn from(failure: Failure) -> Self {
        Self::Fit(failure)
    }
}
