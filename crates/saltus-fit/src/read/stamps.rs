//! Times of day beside readings: those of samples, or those at which somebody wrote them down.

use super::cell::clock;
use crate::statistics::median;

/// So many readings,
const MANY: usize = 20;
/// of which the usual two are no further apart than this, s, are samples of a sensor: a ball that
/// bounces so often does for a second or two.
const APART: f64 = 0.11;

/// Whether stamps are those of samples, in order and close to one another.
pub(super) fn of_samples<'a>(stamps: impl Iterator<Item = &'a str>) -> bool {
    let Some(times) = stamps.map(clock).collect::<Option<Vec<f64>>>() else { return false };
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.len() >= MANY
        && steps.iter().all(|step| *step >= 0.0)
        && median(&mut steps).is_some_and(|step| 0.0 < step && step < APART)
}
