//! Readings that are no readings of the ball: found by the sum of absolute residuals, which a third
//! of them hardly moves.

use super::one::{OneKind, identified};
use super::robust;
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::quantity::{Loss, Sourced};
use crate::statistics::{FAR, REJECT, SCATTER, chi_square_p, median, rounding};

/// How many standard errors from the robust fit a reading is left out where the standard error is
/// only the scatter of the others.
const FAR_BY_SCATTER: f64 = 8.0;
/// More than this part cannot be outliers: then it is the model that is wrong.
const MOST: f64 = 0.4;
/// More than this part of the trials cannot be outliers for the most part: then the trials differ.
const MOST_TRIALS: f64 = 0.25;
/// The scatter, in assumed errors, below which numbers are exact to their own rounding: 10 nm of
/// heights, 10 ns of times.
const LEAST_SCATTER: f64 = 1e-6;

/// The evidence without the readings that do not belong to the model: `drop` takes them out by
/// trial and place.
pub(crate) fn without<M: OneKind>(
    evidence: Evidence,
    known: Option<Sourced>,
    drop: impl Fn(&mut Evidence, &[(usize, usize)]),
) -> Result<Evidence, FitError> {
    let (sigma, stated) = (known.map_or(M::ASSUMED, |s| s.value), known.is_some());
    let (mut left, mut all) = (evidence, None);
    let mut dropped = 0;
    // Where many are wild another look finds those that the first ones hid.
    loop {
        let (wrong, count) = find::<M>(&left, all.as_ref().unwrap_or(&left), (sigma, stated))?;
        if wrong.is_empty() {
            return Ok(left);
        }
        dropped += wrong.len();
        if dropped as f64 > MOST * (count + dropped - wrong.len()) as f64 {
            return Ok(all.unwrap_or(left));
        }
        all.get_or_insert_with(|| left.clone());
        drop(&mut left, &wrong);
    }
}

/// For each trial the places of readings that do not belong to the model; empty where all do.
///
/// Beside them the number of readings that were looked at. `read` holds all that were read.
/// `stated` says whether the errors are known: then a reading must be far off by them, and not only
/// by the scatter of the others.
fn find<M: OneKind>(
    evidence: &Evidence,
    read: &Evidence,
    (sigma, stated): (f64, bool),
) -> Result<(Vec<(usize, usize)>, usize), FitError> {
    let none = Ok((Vec::new(), 0));
    let model = M::with_sigma(evidence, sigma);
    if !model.usable() {
        return none;
    }
    let Some(start) = identified(M::READINGS.name(), model.minimise())? else { return none };
    // With fewer readings to spare nobody can tell which are wrong.
    if start.freedom < if stated { SCATTER } else { 2 * SCATTER } {
        return none;
    }
    // A clean table needs no second look: nothing is far off by the scatter that least squares
    // finds.
    let scatter = (start.chi_square / start.freedom as f64).sqrt();
    if stated && scatter < 1.5 {
        return none;
    }
    let found = identified(M::READINGS.name(), robust::fit(&model, Loss::Absolute, &start.shared, &start.own, false));
    let Ok(Some(Some(found))) = found else { return none };
    let mut sizes: Vec<f64> = found.left.iter().flatten().map(|r| r.abs()).collect();
    let count = sizes.len();
    // As many residuals are zero as there are unknowns: they say nothing of the scatter.
    sizes.sort_unstable_by(f64::total_cmp);
    let unknowns = count - start.freedom;
    let Some(middle) = median(&mut sizes[unknowns.min(count - 1)..]) else { return none };
    let own = 1.4826 * middle;
    // Readings that agree to the last digit agree to its rounding, and no better.
    let scale = own.max(if stated { 1.0 } else { rounding(&M::read(evidence)) / sigma }).max(LEAST_SCATTER);
    let limit = if stated { FAR } else { FAR_BY_SCATTER };
    let far = |r: &f64| r.abs() > limit * scale;
    let mut wrong: Vec<(usize, usize)> = found
        .left
        .iter()
        .enumerate()
        .flat_map(|(trial, left)| left.iter().enumerate().filter(|(_, r)| far(r)).map(move |(n, _)| (trial, n)))
        .collect();
    // Where most of a trial is far off it is not its readings that are wrong: the trial is another
    // one.
    let far_in = |trial: usize| wrong.iter().filter(|(of, _)| *of == trial).count();
    let others = found.left.iter().enumerate().filter(|(trial, left)| 2 * far_in(*trial) > left.len()).count();
    if others as f64 > MOST_TRIALS * found.left.len() as f64 {
        return none;
    }
    // Where most trials with far readings follow a COR of their own, nothing is misread: drops
    // differ. One alone may be of another ball, and of many with misread readings a few may look so
    // by chance.
    let odd: Vec<usize> = (0..found.left.len()).filter(|trial| far_in(*trial) > 0).collect();
    let another = |trial: &&usize| follows_its_own::<M>(read, **trial, sigma * scale);
    let own: Vec<usize> = odd.iter().filter(another).copied().collect();
    if own.len() > 1 && 2 * own.len() > odd.len() {
        wrong.retain(|(trial, _)| !own.contains(trial));
    }
    let few = wrong.len() as f64 <= MOST * count as f64 && count - wrong.len() >= unknowns + 2;
    Ok((if few { wrong } else { Vec::new() }, count))
}

/// Whether the readings of a trial follow one COR by themselves, within this error; two always do,
/// which says nothing.
fn follows_its_own<M: OneKind>(evidence: &Evidence, trial: usize, sigma: f64) -> bool {
    let Some(own) = evidence.trials.get(trial) else { return false };
    let model = M::with_sigma(&Evidence::supposed(vec![own.clone()]), sigma);
    let fitted = model.usable().then(|| identified(M::READINGS.name(), model.minimise()).ok().flatten()).flatten();
    fitted.is_some_and(|fit| chi_square_p(fit.chi_square, fit.freedom).is_some_and(|p| p >= REJECT))
}
