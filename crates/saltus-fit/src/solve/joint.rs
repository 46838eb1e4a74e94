//! Heights and times under one motion.

use super::estimate::Estimate;
use super::kind::with_spread;
use super::one::identified;
use super::spread::{Apart, across};
use super::successive::{Fitted, fit};
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::model::{Bounds, CorLaw, FOLLOWED, Flight, FlightTrial, READINGS};
use crate::quantity::{Measured, Method, Source};
use crate::statistics::{NORMAL, REJECT, chi_square_p};

/// After so many drops fitted one by one, a chi-square less probable than this is the end of it.
const MANY: usize = 500;
const HOPELESS: f64 = 1e-9;

/// The joint fit and what it was fitted to.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) estimate: Estimate,
    pub(crate) model: Flight,
    pub(crate) fitted: Fitted,
    /// For each block the trial's place in the table.
    pub(crate) trials: Vec<usize>,
    /// The standard deviation of the COR from drop to drop, where heights and times agree in every
    /// drop, but not on one COR for all.
    pub(crate) spread: Option<f64>,
}

impl Joint {
    /// Explanations are tried on one trial in so many.
    pub(crate) fn thinned(&self) -> usize {
        let rows: usize = self.model.trials.iter().map(|t| t.heights.len() + t.moments.len()).sum();
        rows.div_ceil(READINGS).max(1)
    }
}

/// What the variants of the joint model suppose.
#[derive(Clone, Copy, Default)]
pub(crate) struct Suppose {
    pub(crate) offset: bool,
    pub(crate) lag: bool,
    pub(crate) per_bounce: bool,
    pub(crate) drag: bool,
    /// A COR linear in speed, between these speeds.
    pub(crate) slope: Option<(f64, f64)>,
    /// The readings are supposed.
    pub(crate) readings: bool,
}

/// The sum of squares may have several minima: the lowest that the starts lead to.
pub(crate) fn run(
    trials: &[FlightTrial],
    gravity: f64,
    suppose: Suppose,
    starts: &[f64],
) -> Result<Option<(Flight, Fitted)>, FitError> {
    let mut model = Flight {
        trials: trials.to_vec(),
        gravity,
        lag: suppose.lag,
        drag: suppose.drag,
        supposed: suppose.readings,
        ..Flight::default()
    };
    if suppose.offset {
        let tallest = model.tallest();
        model.offset = Some(Bounds { low: -tallest, high: 0.9 * tallest });
    }
    if suppose.per_bounce {
        model.law = CorLaw::Each(model.bounces().max(1));
    } else if let Some((low, high)) = suppose.slope {
        model.law = CorLaw::Linear { low, high };
    }
    let extra = usize::from(suppose.offset) + usize::from(model.lag);
    let mut best: Option<(Flight, Fitted)> = None;
    for &e in starts {
        let mut shared = model.law.start(e);
        shared.extend(vec![0.0; extra]);
        shared.extend(suppose.drag.then_some(0.01));
        let own = model.start(e);
        let Some(found) = identified("heights and times together", fit(&model, &shared, own))? else { continue };
        if best.as_ref().is_none_or(|(_, b)| found.chi_square < b.chi_square) {
            best = Some((model.clone(), found));
        }
    }
    Ok(best)
}

/// Fits one COR to heights and times together; `None` where no trial has both.
pub(crate) fn joint(
    evidence: &Evidence,
    gravity: f64,
    sigma_height: f64,
    sigma_time: f64,
) -> Result<Option<Joint>, FitError> {
    let (places, trials): (Vec<usize>, Vec<FlightTrial>) =
        FlightTrial::of_both(evidence, sigma_height, sigma_time).into_iter().unzip();
    let bounces = |t: &FlightTrial| t.heights.last().map_or(0, |h| h.0).max(t.moments.last().map_or(0, |m| m.flights));
    if trials.is_empty() || trials.iter().any(|t| bounces(t) > FOLLOWED) {
        return Ok(None);
    }
    let suppose = Suppose { readings: evidence.supposed, ..Suppose::default() };
    let Some((model, fitted)) = run(&trials, gravity, suppose, &[0.3, 0.55, 0.8, 0.95])? else {
        return Ok(None);
    };
    if fitted.freedom == 0 || fitted.active[0] {
        return Ok(None);
    }
    let error = fitted.covariance[(0, 0)].sqrt();
    let mut estimate = Estimate::new(Method::Joint, fitted.shared[0], error, NORMAL);
    estimate.trials = trials.len();
    estimate.chi_square = Some(fitted.chi_square);
    estimate.degrees_of_freedom = Some(fitted.freedom);
    estimate.p = chi_square_p(fitted.chi_square, fitted.freedom);
    let mut joint = Joint { estimate, model, fitted, trials: places, spread: None };
    if joint.estimate.p.is_some_and(|p| p < REJECT)
        && let Some(apart) = apart(&joint)?
        && apart.explains(joint.fitted.chi_square, Source::Stated, REJECT)
        && let Some(across) = across(&apart.cors)
    {
        joint.spread = Some(across.spread);
        joint.estimate = with_spread(joint.estimate, &across);
        joint.estimate.chi_square = Some(apart.chi_square);
        joint.estimate.degrees_of_freedom = Some(apart.freedom);
        joint.estimate.p = chi_square_p(apart.chi_square, apart.freedom);
    }
    Ok(Some(joint))
}

/// Heights and times together, trial by trial; `None` where one of them determines no COR.
fn apart(joint: &Joint) -> Result<Option<Apart>, FitError> {
    let mut found = Apart::default();
    for trial in &joint.model.trials {
        let starts = [joint.fitted.shared[0], 0.5];
        let alone = std::slice::from_ref(trial);
        let suppose = Suppose { readings: true, ..Suppose::default() };
        let Some((_, fitted)) = run(alone, joint.model.gravity, suppose, &starts)? else { return Ok(None) };
        let cor = fitted.measured(0);
        if fitted.active[0] || !cor.standard_error.is_finite() || cor.standard_error <= 0.0 {
            return Ok(None);
        }
        found.chi_square += fitted.chi_square;
        found.freedom += fitted.freedom;
        // So many drops that are not explained by themselves are not made good by the rest.
        if found.cors.len() > MANY && chi_square_p(found.chi_square, found.freedom).is_some_and(|p| p < HOPELESS) {
            return Ok(None);
        }
        found.cors.push(cor);
    }
    Ok((found.cors.len() > 1).then_some(found))
}

/// The slope of a COR that is known at two speeds, per m/s.
pub(crate) fn slope(fitted: &Fitted, (low, high): (f64, f64)) -> Measured {
    let apart = high - low;
    let standard_error = fitted.error_of(&[-1.0 / apart, 1.0 / apart]);
    Measured { value: (fitted.shared[1] - fitted.shared[0]) / apart, standard_error }
}
