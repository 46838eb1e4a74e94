//! Which other models are fitted beside one COR, and to which of the readings.

use super::rivals::{Compared, Readings, compare};
use super::settings::{SAME_HEIGHT, differ};
use crate::error::FitError;
use crate::finding::{Finding, FindingKind, Untried};
use crate::model::{Contacts, FlightTrial, Heights};
use crate::quantity::{self, CorModel, Loss, Source};
use crate::solve::fits::Fits;
use crate::solve::kind::Each;
use crate::solve::one::OneKind;
use crate::statistics::{REJECT, rounding};

/// What the caller wants of the comparison.
pub(crate) struct Wanted {
    /// Models that are not out of the question are fitted by these losses too.
    pub(crate) losses: Vec<Loss>,
    /// This model is tried in any case.
    pub(crate) model: Option<CorModel>,
    /// The diameter of the ball, m, where it is stated.
    pub(crate) ball: Option<f64>,
}

impl Fits<'_> {
    /// Whether drops differ for another cause than the height they fall from: then no model of the
    /// speed can be distinguished from that cause.
    fn drops_differ(&self, cor: f64) -> bool {
        let of = |spread: Option<f64>, each: Each<'_>| {
            let settings = differ(self.table.trials(), each, cor).is_some_and(|d| d.p < REJECT);
            if settings { !self.set_by_height() } else { spread.is_some() }
        };
        self.heights.as_ref().is_some_and(|k| of(k.spread, k.each()))
            || self.times.as_ref().is_some_and(|k| of(k.spread, k.each()))
            || self.joint.as_ref().is_some_and(|j| j.spread.is_some())
    }

    /// Whether the settings are three heights of release or more, and nothing else.
    fn set_by_height(&self) -> bool {
        let mut heights: Vec<(f64, &str)> = Vec::new();
        for (trial, found) in self.table.trials().iter().zip(&self.evidence.trials) {
            let Some((height, _)) = found.release_height else { return false };
            match heights.iter().find(|h| h.1 == trial.setting) {
                Some(known) if (known.0 / height - 1.0).abs() < SAME_HEIGHT => {}
                Some(_) => return false,
                None => heights.push((height, &trial.setting)),
            }
        }
        heights.sort_by(|a, b| a.0.total_cmp(&b.0));
        heights.len() > 2 && heights.windows(2).all(|w| w[1].0 > (1.0 + SAME_HEIGHT) * w[0].0)
    }
}

/// Fits other models to the readings that one COR was fitted to; `cor` is none where they do not
/// settle on one.
pub(crate) fn models(fits: &Fits<'_>, cor: Option<f64>, wanted: &Wanted) -> Result<Compared, FitError> {
    let none = |untried: Untried| Ok(Compared { untried: Some(untried), ..Compared::default() });
    let Some(cor) = cor else { return none(Untried::Unsettled) };
    let scattering = fits.times.as_ref().is_some_and(|k| k.scatter.is_some());
    let heights = || rounding(&Heights::read(fits.evidence)) / fits.sigma_height.value;
    let times = || rounding(&Contacts::read(fits.evidence)) / fits.sigma_time.value;
    let (kind, trials, source, rounded) = match (&fits.joint, &fits.heights, &fits.times) {
        (Some(joint), _, _) => (None, joint.model.trials.clone(), fits.sigma_time.source, heights().min(times())),
        (None, Some(_), None) => {
            let trials = FlightTrial::of_heights(fits.evidence, fits.sigma_height.value);
            (Some(quantity::Readings::Heights), trials, fits.sigma_height.source, heights())
        }
        // Where bounces scatter, times have errors that add up: ratios are compared instead.
        (None, None, Some(_)) if !scattering && fits.evidence.added_up() => return none(Untried::AddedUp),
        (None, None, Some(_)) if !scattering => {
            let trials = FlightTrial::of_times(fits.evidence, fits.sigma_time.value);
            (Some(quantity::Readings::Times), trials, fits.sigma_time.source, times())
        }
        (None, None, Some(times)) => {
            if fits.drops_differ(cor) {
                return none(Untried::ScatteringDrops);
            }
            let untried = Some(Untried::Scattering);
            return Ok(Compared { models: times.models.clone(), untried, ..Compared::default() });
        }
        _ => return none(Untried::Apart),
    };
    if fits.drops_differ(cor) {
        let untried = Untried::DropsDiffer;
        let notes = vec![Finding::note(FindingKind::NotCompared { untried })];
        return Ok(Compared { notes, untried: Some(untried), ..Compared::default() });
    }
    let readings = Readings {
        trials,
        gravity: fits.gravity.value,
        scattered: source == Source::Scatter,
        least: rounded * rounded,
        ball: wanted.ball,
        joint: fits.joint.is_some(),
        losses: wanted.losses.clone(),
        wanted: wanted.model,
    };
    Ok(Compared { kind, ..compare(&readings, cor)? })
}
