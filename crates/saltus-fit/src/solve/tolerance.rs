//! The COR by other losses, and the CORs that readings allow if each is only trusted to a
//! tolerance.

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::{Deserialize, Serialize};

use super::estimate::Estimate;
use super::kind::Kind;
use super::one::{OneKind, identified};
use super::robust::{self, Robust};
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::quantity::{Loss, Method, Readings};

/// Halvings of the distance to an end of the range.
const HALVINGS: usize = 30;

/// The CORs under which every reading lies within its tolerance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Allowed {
    /// Of which kind they are.
    pub readings: Readings,
    /// The tolerance of a reading, in metres or seconds.
    pub tolerance: f64,
    /// The smallest tolerance under which one COR explains all readings.
    pub smallest: f64,
    /// The COR that needs only that.
    pub cor: f64,
    /// The lowest and highest COR that the tolerance allows; none if no single COR explains the
    /// readings at this precision.
    pub range: Option<(f64, f64)>,
}

/// The estimates by other losses, without errors: those would need a bootstrap.
pub(crate) fn losses<M: OneKind + Sync>(
    evidence: &Evidence,
    kind: &Kind<M>,
    wanted: &[Loss],
) -> Result<Vec<Estimate>, FitError> {
    let model = M::with_sigma(evidence, kind.sigma.value);
    let one = |&loss: &Loss| {
        let found = robust::fit(&model, loss, &kind.fitted.shared, &kind.fitted.own, false);
        let found = identified(M::READINGS.name(), found)?.flatten();
        Ok(found.map(|found| {
            let cor = M::cor(found.shared[0]).0;
            let mut estimate = Estimate::new(Method::under(M::READINGS, loss), cor, f64::NAN, f64::NAN);
            estimate.trials = kind.estimate.trials;
            estimate
        }))
    };
    let found: Result<Vec<Option<Estimate>>, FitError> = wanted.par_iter().map(one).collect();
    Ok(found?.into_iter().flatten().collect())
}

/// The CORs under which all readings of a kind lie within the tolerance of their values; `None`
/// where the table is too large.
pub(crate) fn allowed<M: OneKind>(
    evidence: &Evidence,
    kind: &Kind<M>,
    tolerance: f64,
) -> Result<Option<Allowed>, FitError> {
    let model = M::with_sigma(evidence, tolerance).same_tolerance(tolerance);
    let run = |shared: f64, own: &[Vec<f64>], pinned: bool| {
        identified(M::READINGS.name(), robust::fit(&model, Loss::Largest, &[shared], own, pinned)).map(Option::flatten)
    };
    let Some(best) = run(kind.fitted.shared[0], &kind.fitted.own, false)? else { return Ok(None) };
    let middle = best.shared[0];
    let fits = |found: &Option<Robust>| found.as_ref().is_some_and(|f| f.loss <= 1.0 + 1e-7);
    let mut range = None;
    if best.loss <= 1.0 {
        let bounds = model.ranges()[0].0;
        let mut ends = [bounds.low, bounds.high];
        for end in &mut ends {
            if fits(&run(*end, &best.own, true)?) {
                continue;
            }
            let (mut inside, mut outside) = (middle, *end);
            let mut own = best.own.clone();
            for _ in 0..HALVINGS {
                let half = 0.5 * (inside + outside);
                let found = run(half, &own, true)?;
                if fits(&found) {
                    inside = half;
                    own = found.map_or(own, |f| f.own);
                } else {
                    outside = half;
                }
            }
            *end = inside;
        }
        range = Some((M::cor(ends[0]).0, M::cor(ends[1]).0));
    }
    Ok(Some(Allowed {
        readings: M::READINGS,
        tolerance,
        smallest: best.loss * tolerance,
        cor: M::cor(middle).0,
        range,
    }))
}
