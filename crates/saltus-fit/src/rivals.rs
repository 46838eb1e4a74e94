//! Other models of the same heights and times: a COR that depends on speed, one for every bounce, air drag, a wrong zero of the scale.
//!
//! All are the motion of [`Flight`] with one thing more set free. They are compared by BIC and `AICc`, and by how they do on trials that
//! they were not fitted to.

use crate::bounces::Measured;
use crate::choice::ModelChoice;
use crate::error::FitError;
use crate::estimate::identified;
use crate::evidence::Evidence;
use crate::model::{Flight, FlightTrial, Height};
use crate::successive::{Fitted, fit};

/// A table with more readings is left to the models of one COR.
const READINGS: usize = 5000;
/// So many spare readings a model must leave to be worth comparing.
const SPARE: usize = 3;
/// Speeds must differ by this factor before a dependence on speed, or drag, can be told from one COR.
const SPEEDS: f64 = 1.6;
/// A COR for every bounce is tried for up to so many.
const BOUNCES: usize = 12;
/// A model whose BIC is worse by more is out of the question.
const DISPUTED: f64 = 2.0;
/// Leaving out each trial in turn is tried for up to so many trials and readings.
const TRIALS: usize = 30;
const LEFT_OUT: usize = 1500;

/// What the readings are, for the comparison.
pub(crate) struct Readings {
    pub(crate) trials: Vec<FlightTrial>,
    pub(crate) gravity: f64,
    /// The errors were taken from the scatter: only ratios of sums of squares mean something.
    pub(crate) scattered: bool,
}

impl Readings {
    /// Heights alone, with a release height that is a reading like the others.
    pub(crate) fn heights(evidence: &Evidence, sigma: f64) -> Vec<FlightTrial> {
        let one = |heights: Vec<Height>| FlightTrial {
            release: heights.first().filter(|h| h.0 == 0).map(|h| (h.1, Some(h.2))),
            // No reading asks for the time; a known one keeps the clock from being an unknown.
            release_time: Some(0.0),
            heights: heights.into_iter().filter(|h| h.0 > 0).collect(),
            moments: Vec::new(),
        };
        evidence.heights(sigma).into_iter().filter(|h| h.len() > 1).map(one).collect()
    }

    /// Times alone: neither the height nor the time of release is used.
    pub(crate) fn times(evidence: &Evidence, sigma: f64) -> Vec<FlightTrial> {
        let one = |moments| FlightTrial { moments, ..FlightTrial::default() };
        evidence.moments(sigma).into_iter().filter(|m| m.len() > 2).map(one).collect()
    }
}

/// Fits the models, that of one COR first, and returns them with the best first; empty where there is nothing to compare.
pub(crate) fn compare(readings: &Readings, cor: f64) -> Result<Vec<ModelChoice>, FitError> {
    let rows: usize = readings.trials.iter().map(|t| t.heights.len() + t.moments.len()).sum();
    let base = Flight { trials: readings.trials.clone(), gravity: readings.gravity, cors: 1, ..Flight::default() };
    let bounces = base.bounces();
    if rows > READINGS || bounces < 2 || !(0.01..1.0).contains(&cor) {
        return Ok(Vec::new());
    }
    let Some(constant) = run(&base, &[cor], None)? else { return Ok(Vec::new()) };
    let e = constant.shared[0];
    let first = base.first_contact(0, &constant.shared, &constant.own[0]).0;
    // The middle speed, where value and slope are nearly independent.
    let exponent = i32::try_from(bounces - 1).unwrap_or(i32::MAX);
    let middle = first * e.powi(exponent).sqrt();
    let dependent = e.powi(-exponent) > SPEEDS && middle.is_finite() && middle > 0.0;
    let heights = readings.trials.iter().any(|t| !t.heights.is_empty());
    let mut models = vec![("constant", "one COR", base.clone(), vec![e])];
    if dependent {
        let slope = Flight { slope: Some(middle), ..base.clone() };
        models.push(("linear", "a COR linear in the speed of impact", slope, vec![e, 0.0]));
        let drag = Flight { drag: true, ..base.clone() };
        models.push(("drag", "one COR and air drag", drag, vec![e, 0.01]));
    }
    if heights {
        let offset = Flight { offset: true, ..base.clone() };
        models.push(("offset", "one COR and a wrong zero of the height scale", offset, vec![e, 0.0]));
    }
    // Times alone do not tell how fast the ball came to the first contact, and so not the COR there.
    if heights && (2..=BOUNCES).contains(&bounces) {
        models.push(("each", "a COR for every bounce", Flight { cors: bounces, ..base }, vec![e; bounces]));
    }
    let mut list = Vec::new();
    for (name, about, model, start) in models {
        let Some(fitted) = run(&model, &start, Some(&constant.own))? else { continue };
        if fitted.freedom < SPARE {
            continue;
        }
        let n = used(&model) as f64;
        let p = n - fitted.freedom as f64;
        let misfit = if readings.scattered { n * (fitted.chi_square / n).max(1e-300).ln() } else { fitted.chi_square };
        let places = usize::from(model.slope.is_some()) + model.cors - 1;
        let measured = |j: usize, scale: f64| Measured {
            value: scale * fitted.shared[j],
            standard_error: scale * fitted.covariance[(j, j)].sqrt(),
        };
        let mut choice = ModelChoice::new(name, about, mean(&fitted, model.cors), misfit + p * n.ln());
        choice.aicc = (n > p + 1.0).then(|| misfit + 2.0 * p + 2.0 * p * (p + 1.0) / (n - p - 1.0));
        choice.slope = model.slope.map(|speed| measured(1, 1.0 / speed));
        choice.offset_m = model.offset.then(|| measured(places + 1, 1.0));
        choice.drag = model.drag.then(|| measured(places + 1, 1.0));
        choice.chosen = name == "constant";
        list.push((choice, model, fitted));
    }
    let Some(reference) = list.iter().find(|m| m.0.chosen).map(|m| (m.0.bic, m.0.aicc)) else { return Ok(Vec::new()) };
    for (choice, ..) in &mut list {
        choice.bic -= reference.0;
        choice.aicc = choice.aicc.zip(reference.1).map(|(a, b)| a - b);
    }
    list.sort_by(|a, b| a.0.bic.total_cmp(&b.0.bic));
    // Where one COR stands alone there is nothing for the trials to decide.
    let disputed = list.iter().filter(|m| m.0.bic < DISPUTED).count() > 1;
    for (choice, model, fitted) in list.iter_mut().filter(|m| disputed && m.0.bic < DISPUTED) {
        choice.left_out = left_out(model, fitted)?;
    }
    Ok(list.into_iter().map(|m| m.0).collect())
}

/// Fits one model, from other own unknowns if they are given.
fn run(model: &Flight, shared: &[f64], own: Option<&Vec<Vec<f64>>>) -> Result<Option<Fitted>, FitError> {
    let own = own.cloned().unwrap_or_else(|| model.start(shared[0]));
    identified("a model of heights and times", fit(model, shared, own))
}

/// The readings of blocks that say something.
fn used(model: &Flight) -> usize {
    use crate::successive::Model;
    (0..model.trials.len()).map(|b| model.size(b)).filter(|(m, q)| m > q).map(|(m, _)| m).sum()
}

/// The mean of the CORs, each weighing by its own variance.
fn mean(fitted: &Fitted, cors: usize) -> Measured {
    let weights: Vec<f64> = (0..cors).map(|j| 1.0 / fitted.covariance[(j, j)].max(1e-24)).collect();
    let total: f64 = weights.iter().sum();
    let value = (0..cors).map(|j| weights[j] * fitted.shared[j]).sum::<f64>() / total;
    let mut variance = 0.0;
    for i in 0..cors {
        for j in 0..cors {
            variance += weights[i] * weights[j] * fitted.covariance[(i, j)] / (total * total);
        }
    }
    Measured { value, standard_error: variance.max(0.0).sqrt() }
}

/// The chi-square per reading of each trial under the model fitted to the others.
fn left_out(model: &Flight, whole: &Fitted) -> Result<Option<f64>, FitError> {
    let count = model.trials.len();
    if !(2..=TRIALS).contains(&count) || used(model) > LEFT_OUT {
        return Ok(None);
    }
    let (mut sum, mut rows) = (0.0, 0);
    for j in 0..count {
        let (mut rest, mut own) = (model.clone(), whole.own.clone());
        let trial = rest.trials.remove(j);
        let left = own.remove(j);
        let Some(others) = run(&rest, &whole.shared, Some(&own))? else { return Ok(None) };
        let alone = Flight { trials: vec![trial], pinned: Some(others.shared.clone()), ..model.clone() };
        if used(&alone) == 0 {
            continue;
        }
        let Some(found) = run(&alone, &others.shared, Some(&vec![left]))? else { return Ok(None) };
        (sum, rows) = (sum + found.chi_square, rows + used(&alone));
    }
    Ok((rows > 0).then(|| sum / rows as f64))
}
