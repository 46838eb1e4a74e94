//! The estimators: each gives a COR with its standard error, and how well its model describes the
//! readings.

use std::marker::PhantomData;

use super::choice::ModelChoice;
use super::estimate::Estimate;
use super::one::{OneKind, identified};
use super::profile::limit;
use super::ratios::scattering;
use super::spread::{Across, across, apart};
use super::successive::{Fitted, score_gain};
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::model::Contacts;
use crate::quantity::{Measured, Method, Source, Sourced};
use crate::statistics::{NORMAL, REJECT, REPLICATED, SCATTER, chi_square_p, rounding, student, variance_ratio_p};

/// The fit of one kind of reading.
#[derive(Clone, Debug)]
pub(crate) struct Kind<M> {
    pub(crate) model: PhantomData<M>,
    pub(crate) estimate: Estimate,
    /// Without the bound e ≤ 1, where that bound holds the fit.
    pub(crate) unbounded: Option<Estimate>,
    /// The fit, without the bound where the bound would hold it.
    pub(crate) fitted: Fitted,
    pub(crate) sigma: Sourced,
    /// The probability of a trend from bounce to bounce as strong as this by chance.
    pub(crate) trend: Option<f64>,
    /// The error was set by the spread between trials.
    pub(crate) replicated: bool,
    /// For each trial of the table its information on the COR, and its own COR less that of all.
    separate: Vec<(f64, f64)>,
    /// The error that rounding alone leaves, in errors of a reading.
    rounded: f64,
    /// How much the COR scatters from bounce to bounce, relative to it, where the estimate allows
    /// for that.
    pub(crate) scatter: Option<f64>,
    /// The standard deviation of the COR from drop to drop, where the drops differ by more than the
    /// reading errors.
    pub(crate) spread: Option<f64>,
    /// The models of ratios beside one COR, where the bounces scatter.
    pub(crate) models: Vec<ModelChoice>,
}

/// What each trial says of the COR by itself.
#[derive(Clone, Copy)]
pub(crate) struct Each<'a> {
    /// Trial by trial, its information on the COR, and its own COR less that of all.
    pub(crate) own: &'a [(f64, f64)],
    /// The variance that rounding alone leaves, in that of a reading: trials that repeat each other
    /// exactly were rounded, not perfect.
    pub(crate) least: f64,
}

impl<M> Kind<M> {
    /// What each trial says of the COR by itself.
    pub(crate) fn each(&self) -> Each<'_> {
        Each { own: &self.separate, least: self.rounded.powi(2) }
    }
}

/// Fits one kind of reading; `None` where the table does not determine a COR by it.
pub(crate) fn one_kind<M: OneKind>(evidence: &Evidence, known: Option<Sourced>) -> Result<Option<Kind<M>>, FitError> {
    let run = |model: &M| identified(M::READINGS.name(), model.minimise());
    let mut sigma = known.unwrap_or(Sourced { value: M::ASSUMED, source: Source::Assumed });
    let mut model = M::with_sigma(evidence, sigma.value);
    if !model.usable() {
        return Ok(None);
    }
    let Some(mut fitted) = run(&model)? else { return Ok(None) };
    if known.is_none() && fitted.freedom >= SCATTER && !fitted.active[0] {
        #[allow(clippy::cast_precision_loss)]
        let factor = (fitted.chi_square / fitted.freedom as f64).sqrt().max(rounding(&M::read(evidence)) / M::ASSUMED);
        // Readings without any scatter at all leave the usual error in place: zero would claim too
        // much.
        if factor * M::ASSUMED > 1e-9 {
            sigma = Sourced { value: factor * M::ASSUMED, source: Source::Scatter };
            model = M::with_sigma(evidence, sigma.value);
            // All weights change alike: the minimum stays where it is.
            fitted.chi_square /= factor * factor;
            fitted.covariance *= factor * factor;
            fitted.separate.iter_mut().for_each(|s| s.0 /= factor * factor);
        }
    }
    let (mut estimate, mut replicated) = describe::<M>(&fitted, sigma, Method::of(M::READINGS));
    let pooled = estimate.value;
    let mut spread = None;
    // Above all where each drop by itself is explained by the reading errors, and only all together
    // are not.
    if !fitted.active[0]
        && known.is_some()
        && estimate.p.is_some_and(|p| p < REJECT)
        && let Some(apart) = apart::<M>(evidence, sigma)?
        && apart.explains(fitted.chi_square, sigma.source, REJECT)
        && let Some(across) = across(&apart.cors)
    {
        spread = Some(across.spread);
        estimate = with_spread(estimate, &across);
        replicated = true;
    }
    let rounded = rounding(&M::read(evidence)) / sigma.value;
    let trend = trend(&model, &fitted, sigma, rounded);
    let mut separate = in_cor(&fitted.separate, M::cor(fitted.shared[0]).1);
    if let (Some(pooled), Some(mean)) = (pooled, estimate.value) {
        // Each is counted from the estimate.
        separate.iter_mut().for_each(|(_, shift)| *shift += pooled - mean);
    }
    let mut unbounded = None;
    if fitted.active[0] {
        at_bound(&mut estimate, &model, &fitted)?;
    }
    if fitted.active[0]
        && let Some(free) = run(&model.without_bound())?
    {
        unbounded = Some(describe::<M>(&free, sigma, Method::unbounded(M::READINGS)).0);
        fitted = free;
    }
    Ok(Some(Kind {
        model: PhantomData,
        estimate,
        unbounded,
        fitted,
        sigma,
        trend,
        replicated,
        separate,
        rounded,
        scatter: None,
        spread,
        models: Vec::new(),
    }))
}

/// Whether the errors of times between contacts are to be taken as adding up along the times, as
/// where each was read or rounded by itself.
///
/// A few intervals do not tell whether the contacts were timed, or each interval: what leaves the
/// larger error is taken, unless the stated error of reading rules that out. Of many trials the
/// spread tells.
pub(crate) fn add_up(evidence: &Evidence, known: Option<Sourced>) -> Result<bool, FitError> {
    let contacts = Contacts::with_sigma(evidence, known.map_or(Contacts::ASSUMED, |s| s.value));
    let usable = contacts.trials.iter().filter(|t| t.len() > 2).count();
    if !(1..REPLICATED).contains(&usable) {
        return Ok(false);
    }
    let run = |added_up| identified("times", Contacts { added_up, ..contacts.clone() }.minimise());
    let (Some(timed), Some(added_up)) = (run(false)?, run(true)?) else { return Ok(false) };
    let holds = |f: &Fitted| known.is_none() || chi_square_p(f.chi_square, f.freedom).is_none_or(|p| p >= REJECT);
    let variance = |f: &Fitted| f.covariance[(0, 0)] * if known.is_none() { f.chi_square } else { 1.0 };
    Ok(variance(&added_up) > variance(&timed) && (holds(&added_up) || !holds(&timed)))
}

/// Fits the times; where the bounces scatter more than the readings, by the ratios of intervals.
pub(crate) fn times(evidence: &Evidence, known: Option<Sourced>) -> Result<Option<Kind<Contacts>>, FitError> {
    let Some(mut kind) = one_kind::<Contacts>(evidence, known)? else { return Ok(None) };
    let unexplained = known.is_none() || kind.estimate.p.is_some_and(|p| p < REJECT);
    if unexplained
        && kind.spread.is_none()
        && kind.unbounded.is_none()
        && let Some(found) = scattering(evidence, kind.sigma)
        // Ratios that follow the number of the bounce do not scatter: their cause is looked for
        // among the models.
        && found.followed < 0.5
    {
        let Estimate { chi_square, p, .. } = kind.estimate;
        kind.estimate = Estimate { chi_square, p, ..found.estimate };
        if p.is_some() {
            kind.estimate.degrees_of_freedom = Some(kind.fitted.freedom);
        }
        kind.separate = in_cor(&found.separate, kind.estimate.value.unwrap_or(1.0));
        (kind.trend, kind.replicated, kind.scatter) = (found.trend, found.replicated, Some(found.scatter));
        kind.rounded = 0.0;
        kind.models = found.models;
    }
    Ok(Some(kind))
}

/// Information and shifts of another unknown as those of the COR, whose derivative by it is
/// `slope`.
fn in_cor(separate: &[(f64, f64)], slope: f64) -> Vec<(f64, f64)> {
    separate.iter().map(|(weight, shift)| (weight / (slope * slope), shift * slope)).collect()
}

/// The estimate a fit amounts to, and whether the spread between trials set its error.
fn describe<M: OneKind>(fitted: &Fitted, sigma: Sourced, method: Method) -> (Estimate, bool) {
    let (value, slope) = M::cor(fitted.shared[0]);
    let mut error = slope * fitted.covariance[(0, 0)].sqrt();
    let scattered = sigma.source == Source::Scatter;
    let mut quantile = if scattered { student(fitted.freedom) } else { NORMAL };
    let contributing = fitted.influence.iter().filter(|d| **d != 0.0).count();
    let mut replicated = false;
    if contributing >= REPLICATED && !fitted.active[0] {
        let spread = slope * jackknife(&fitted.influence, contributing);
        replicated = true;
        // A stated reading error is a floor under the spread: readings that repeat exactly were
        // rounded, not perfect.
        if scattered || spread > error {
            (error, quantile) = (spread, student(contributing - 1));
        }
    }
    let mut estimate = Estimate::new(method, value, error, quantile);
    estimate.trials = contributing.max(1);
    estimate.degrees_of_freedom = Some(fitted.freedom);
    if !scattered && fitted.freedom > 0 {
        estimate.chi_square = Some(fitted.chi_square);
        estimate.p = chi_square_p(fitted.chi_square, fitted.freedom);
    }
    if fitted.active[0] {
        (estimate.standard_error, estimate.low, estimate.high) = (None, None, None);
    }
    (estimate, replicated)
}

/// The estimate with the mean over drops that differ.
pub(crate) fn with_spread(estimate: Estimate, across: &Across) -> Estimate {
    let Measured { value, standard_error } = across.mean;
    let Estimate { chi_square, degrees_of_freedom, p, trials, .. } = estimate;
    let means = Estimate::new(estimate.method, value, standard_error, across.quantile);
    Estimate { chi_square, degrees_of_freedom, p, trials, ..means }
}

/// A one-sided limit for an estimate at a bound, where no covariance means anything.
fn at_bound<M: OneKind>(estimate: &mut Estimate, model: &M, fitted: &Fitted) -> Result<(), FitError> {
    let Some(limit) = identified("a limit", limit(model, fitted, 0))? else { return Ok(()) };
    let (bound, limit) = (M::cor(fitted.shared[0]).0, M::cor(limit).0);
    (estimate.low, estimate.high) = (Some(bound.min(limit)), Some(bound.max(limit)));
    Ok(())
}

/// The delete-one-trial standard error from the shifts that deletions cause.
#[allow(clippy::cast_precision_loss)]
fn jackknife(influence: &[f64], contributing: usize) -> f64 {
    let n = contributing as f64;
    let shifts = || influence.iter().filter(|d| **d != 0.0);
    let mean = shifts().sum::<f64>() / n;
    ((n - 1.0) / n * shifts().map(|d| (d - mean).powi(2)).sum::<f64>()).sqrt()
}

/// The probability that chance alone improves the fit as much as a COR that changes from bounce to
/// bounce does; `rounded` is what rounding alone leaves, in errors of a reading.
fn trend<M: OneKind>(model: &M, fitted: &Fitted, sigma: Sourced, rounded: f64) -> Option<f64> {
    if fitted.freedom < 2 || fitted.active[0] {
        return None;
    }
    let changed = model.with_trend();
    let score = score_gain(&changed, &[fitted.shared[0], 0.0], &fitted.own);
    // A linear step that nobody can solve tests nothing; the fit itself does not rest on it.
    let Ok((gain, left)) = score else { return None };
    let gain = gain.max(0.0);
    if sigma.source != Source::Scatter {
        return chi_square_p(gain, 1);
    }
    #[allow(clippy::cast_precision_loss)]
    let variance = (left / (fitted.freedom - 1) as f64).max(rounded * rounded);
    variance_ratio_p(gain / variance, 1, fitted.freedom - 1)
}
