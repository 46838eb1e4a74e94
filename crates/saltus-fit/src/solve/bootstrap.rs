//! The error of the COR by drawing whole trials anew: it needs no assumption on how readings
//! scatter within a trial.

use std::ops::ControlFlow;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

use super::fits::Fits;
use super::one::{OneKind, identified};
use super::{joint, kind};
use crate::elementary::exp;
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::model::Heights;
use crate::statistics::REPLICATED;

/// Gets how many rounds are done, and answers whether to go on.
pub(crate) type Progress<'a> = &'a mut dyn FnMut(usize) -> ControlFlow<()>;

/// What repeated draws of trials give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Bootstrap {
    /// How often trials were drawn.
    pub rounds: usize,
    /// The seed of the draws: the same seed gives the same numbers.
    pub seed: u64,
    /// The standard deviation of the COR over the draws.
    pub standard_error: f64,
    /// The 2.5 % point.
    pub low: f64,
    /// The 97.5 % point.
    pub high: f64,
}

/// Draws as many trials as there are, with replacement, fits, and repeats; `None` with fewer than
/// five trials.
///
/// Rounds whose draw determines no COR are drawn
/// again, up to twice the number wanted.
pub(crate) fn run(
    fits: &Fits<'_>,
    (rounds, seed): (usize, u64),
    progress: Progress<'_>,
) -> Result<Option<Bootstrap>, FitError> {
    let evidence = fits.evidence;
    let count = evidence.trials.len();
    if count < REPLICATED || rounds < 2 {
        return Ok(None);
    }
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = || ((u128::from(random.next_u64()) * count as u128) >> 64) as usize;
    let mut found = Vec::with_capacity(rounds);
    for _ in 0..2 * rounds {
        let trials = (0..count).map(|n| {
            let mut trial = evidence.trials[draw()].clone();
            trial.trial = n;
            trial
        });
        let drawn = Evidence::supposed(trials.collect());
        found.extend(cor(&drawn, fits)?);
        if progress(found.len()).is_break() {
            return Err(FitError::Ended);
        }
        if found.len() == rounds {
            break;
        }
    }
    if found.len() < rounds {
        return Ok(None);
    }
    found.sort_unstable_by(f64::total_cmp);
    let mean = found.iter().sum::<f64>() / rounds as f64;
    let variance = found.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (rounds - 1) as f64;
    let point = |part: f64| found[((part * rounds as f64) as usize).min(rounds - 1)];
    Ok(Some(Bootstrap { rounds, seed, standard_error: variance.sqrt(), low: point(0.025), high: point(0.975) }))
}

/// The COR of one draw, by the method that the report rests on.
fn cor(drawn: &Evidence, fits: &Fits<'_>) -> Result<Option<f64>, FitError> {
    let Fits { gravity, sigma_height, sigma_time, .. } = *fits;
    if fits.joint.is_some() {
        let found = joint::joint(drawn, gravity.value, sigma_height.value, sigma_time.value)?;
        return Ok(found.and_then(|j| j.estimate.value));
    }
    if fits.times.is_some() {
        return Ok(kind::times(drawn, Some(sigma_time))?.and_then(|k| k.estimate.value));
    }
    let model = Heights::with_sigma(drawn, sigma_height.value);
    if !model.usable() {
        return Ok(None);
    }
    Ok(identified(Heights::READINGS.name(), model.minimise())?.map(|f| exp(f.shared[0])))
}
