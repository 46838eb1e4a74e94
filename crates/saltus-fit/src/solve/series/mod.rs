//! Series of heights in time: a tracked ball, frame by frame.
//!
//! The series is cut into flights, parabolas give a first sketch, and the whole motion is fitted
//! through every sample, with drag and without, with one COR, one that depends on speed, and one
//! for every impact; and again with impacts that last. What the samples prefer decides. Neither
//! gravity nor the scale nor the unit of time enters the COR, so they are fitted too, and reported.

mod flights;
mod frames;
mod parabolas;
mod pool;
mod recording;
mod samples;
mod track;
mod wild;

use crate::error::FitError;
use crate::evidence::at;
use crate::finding::{Finding, FindingKind};
use crate::read::Table;
use flights::NoFlights;
pub(crate) use pool::Pooled;
pub(crate) use recording::{Course, Unseen, in_metres};
pub use recording::{Impact, Track, Variant};
use samples::samples;
pub(crate) use track::Choice;

use super::one::identified;

/// What became of every series of a table.
#[derive(Clone, Debug, Default)]
pub(crate) struct Series {
    pub(crate) tracks: Vec<Track>,
    pub(crate) pooled: Option<Pooled>,
    /// The same with contacts that take no time where these do, and the other way round; and by how
    /// much its BIC is worse.
    pub(crate) otherwise: Option<(Pooled, Vec<Track>, f64)>,
    /// Trials whose series show no bounce that can be fitted, and why.
    pub(crate) refused: Vec<Finding>,
    /// What was done to put the samples in order, and where a ball is dropped again after the last
    /// flight that is fitted.
    pub(crate) repairs: Vec<Finding>,
    /// What was stated about the way that heights count, where the ball then falls upwards.
    pub(crate) falls_upwards: Option<bool>,
}

/// Fits every series of the table, with wild samples left out if `repair`, drag held at `drag`
/// (1/m) where that is stated; `None` if it has none.
pub(crate) fn fit(table: &Table, repair: bool, drag: Option<f64>) -> Result<Option<Series>, FitError> {
    let mut series = Series { falls_upwards: table.metadata.falls_upwards, ..Series::default() };
    let mut seen = false;
    let mut recordings = Vec::new();
    for (n, trial) in table.trials().iter().enumerate() {
        let Some((samples, repairs)) = samples(trial, table.metadata.oriented, repair) else { continue };
        seen = true;
        let place = at(table, n);
        let found = match track::Recording::of(n, &samples, (repair, drag)) {
            Ok(found) => {
                let (drops, aside, elsewhere) = drops(n, found, samples, (repair, drag));
                let doubt = |time_s| Finding::doubt(FindingKind::DroppedAgain { time_s }).at(place.clone());
                series.repairs.extend(aside.map(doubt));
                let doubt =
                    |(from_s, to_s)| Finding::doubt(FindingKind::OtherMotion { from_s, to_s }).at(place.clone());
                series.repairs.extend(elsewhere.map(doubt));
                let doubt = |samples| Finding::doubt(FindingKind::AnotherBody { samples }).at(place.clone());
                series.repairs.extend(drops.iter().filter_map(track::Recording::another_body).map(doubt));
                drops
            }
            Err(track::Refusal::Flights(why)) => {
                let samples = samples.times.len();
                let kind = match why {
                    NoFlights::NoBounce => FindingKind::NoBounce { samples },
                    NoFlights::TooFew => FindingKind::TooFewSamples { samples },
                };
                series.refused.push(Finding::refusal(kind).at(place.clone()));
                Vec::new()
            }
            Err(track::Refusal::Fit(failure)) => {
                let unidentified: Option<()> = identified("a series of heights", Err(failure))?;
                debug_assert!(unidentified.is_none());
                series.refused.push(Finding::refusal(FindingKind::MotionUndetermined).at(place.clone()));
                Vec::new()
            }
        };
        recordings.push((place, repairs, found));
    }
    if !seen {
        return Ok(None);
    }
    let fitted = || recordings.iter().flat_map(|(_, _, found)| found);
    // Positive where contacts that take time are better.
    let gain: f64 = fitted().filter_map(track::Recording::gain).sum();
    let under = |lasting: bool| {
        let candidates: Vec<&track::Candidates> = fitted().map(|found| found.under(lasting)).collect();
        let choice = track::weigh::choose(&candidates);
        let tracks: Vec<Track> = candidates.iter().filter_map(|candidates| candidates.track(choice)).collect();
        (pool::pool(&tracks, choice), tracks)
    };
    (series.pooled, series.tracks) = under(gain > 0.0);
    if fitted().any(|found| found.gain().is_some()) {
        let (pooled, tracks) = under(gain <= 0.0);
        series.otherwise = pooled.map(|pooled| (pooled, tracks, gain.abs()));
    }
    for (place, mut repairs, found) in recordings {
        repairs.extend(found.iter().flat_map(|found| found.under(gain > 0.0).repairs()));
        series.repairs.extend(repairs.into_iter().map(|kind| Finding::note(kind).at(place.clone())));
    }
    Ok(Some(series))
}

/// The drops of a trial, the first of which was found; when one meets the floor that is left aside;
/// and from when to when the ball bounces otherwise than in them.
fn drops(
    trial: usize,
    first: track::Recording,
    samples: samples::Samples,
    how: (bool, Option<f64>),
) -> (Vec<track::Recording>, Option<f64>, Option<(f64, f64)>) {
    let (mut found, mut left) = (vec![first], samples);
    while let Some((time, later)) = found[found.len() - 1].dropped_again(&left, how) {
        match track::Recording::of(trial, &later, how) {
            Ok(next) => found.push(next),
            Err(_) => return (found, Some(time), None),
        }
        left = later;
    }
    let elsewhere = found[found.len() - 1].elsewhere(&left, how.0);
    (found, None, elsewhere)
}
