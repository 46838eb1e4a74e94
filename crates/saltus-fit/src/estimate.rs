//! The estimators: each gives a COR with its standard error, and how well its model describes the readings.

use std::marker::PhantomData;

use serde::Serialize;

use crate::bounces::Measured;
use crate::choice::ModelChoice;
use crate::diagnose::REJECT;
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::least_squares::Failure;
use crate::model::{Contacts, Height, Heights, Moment};
use crate::profile::limit;
use crate::ratios::scattering;
use crate::spread::{Across, across, apart};
use crate::statistics::{NORMAL, chi_square_p, median, student, variance_ratio_p};
use crate::successive::{Fitted, Model, fit, score_gain};

/// From this many trials on, the spread between them sets the error.
pub(crate) const REPLICATED: usize = 5;
/// From this many degrees of freedom on, the scatter can stand for a reading error that nobody stated.
pub(crate) const SCATTER: usize = 4;

/// A COR by one method.
///
/// In JSON every number that does not exist is `null`: a fit without degrees of freedom has no `p`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Estimate {
    /// A fixed word: `heights`, `heights-mean`, `times`, `times-mean`, `first-flight`, `joint`; with `-unbounded` where the bound e ≤ 1 is lifted.
    pub method: String,
    /// What was done, for people.
    pub about: String,
    /// The COR, without unit.
    pub value: Option<f64>,
    /// Its standard error.
    pub standard_error: Option<f64>,
    /// The lower end of its 95 % interval.
    pub low: Option<f64>,
    /// The upper end of its 95 % interval.
    pub high: Option<f64>,
    /// The sum of squared residuals, each divided by its standard error; none if that error was taken from the scatter itself.
    pub chi_square: Option<f64>,
    /// The number of readings less the number of unknowns.
    pub degrees_of_freedom: Option<usize>,
    /// The probability of a chi-square at least as large by chance, if the model holds.
    pub p: Option<f64>,
    /// The number of trials that contribute.
    pub trials: usize,
}

impl Estimate {
    pub(crate) fn new(method: &str, about: &str, value: f64, error: f64, quantile: f64) -> Self {
        let known = |x: f64| x.is_finite().then_some(x);
        Self {
            method: method.to_owned(),
            about: about.to_owned(),
            value: known(value),
            standard_error: known(error),
            low: known((value - quantile * error).max(0.0)),
            high: known(value + quantile * error),
            chi_square: None,
            degrees_of_freedom: None,
            p: None,
            trials: 1,
        }
    }
}

/// Where a number came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Source {
    /// The caller stated it.
    Stated,
    /// The table states it.
    Table,
    /// One frame of the camera, 1/fps, over √12: the standard deviation of rounding to whole frames.
    #[serde(rename = "frame rate")]
    FrameRate,
    /// The scatter of the readings about the fit.
    Scatter,
    /// Nobody stated it: a usual value.
    Assumed,
}

/// A number with its origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Sourced {
    /// The value in SI units.
    pub value: f64,
    /// Where it came from.
    pub source: Source,
}

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
    pub(crate) separate: Vec<(f64, f64)>,
    /// How much the COR scatters from bounce to bounce, relative to it, where the estimate allows for that.
    pub(crate) scatter: Option<f64>,
    /// The standard deviation of the COR from drop to drop, where the drops differ by more than the reading errors.
    pub(crate) spread: Option<f64>,
    /// The models of ratios beside one COR, where the bounces scatter.
    pub(crate) models: Vec<ModelChoice>,
}

/// A model that describes one kind of reading by one COR.
pub(crate) trait OneKind: Model + Clone {
    const METHOD: &'static str;
    const ABOUT: &'static str;
    const ASSUMED: f64;
    fn with_sigma(evidence: &Evidence, sigma: f64) -> Self;
    /// The numbers that were read.
    fn read(evidence: &Evidence) -> Vec<f64>;
    fn without_bound(&self) -> Self;
    fn with_trend(&self) -> Self;
    /// Every reading with the same error, whatever its row states.
    fn same_tolerance(self, tolerance: f64) -> Self;
    /// The least sum of squares.
    fn minimise(&self) -> Result<Fitted, Failure>;
    /// The COR and its derivative with respect to the shared unknown.
    fn cor(shared: f64) -> (f64, f64);
    fn usable(&self) -> bool;
}

impl OneKind for Heights {
    const METHOD: &'static str = "heights";
    const ABOUT: &'static str = "rebound heights, least squares with an unknown release height in every trial";
    const ASSUMED: f64 = 0.01;

    fn with_sigma(evidence: &Evidence, sigma: f64) -> Self {
        Self { trials: evidence.heights(sigma), high: 0.0, trend: false, logarithms: false }
    }

    fn read(evidence: &Evidence) -> Vec<f64> {
        evidence.trials.iter().flat_map(|t| t.heights.iter().map(|h| h.1)).collect()
    }

    fn without_bound(&self) -> Self {
        Self { high: 20.0, ..self.clone() }
    }

    fn with_trend(&self) -> Self {
        Self { trend: true, high: 20.0, ..self.clone() }
    }

    fn same_tolerance(mut self, tolerance: f64) -> Self {
        self.trials.iter_mut().flatten().for_each(|h| h.2 = tolerance);
        self
    }

    fn minimise(&self) -> Result<Fitted, Failure> {
        let first = |t: &Vec<Height>| vec![t.first().map_or(0.0, |h| h.1.ln())];
        let start = self.trials.iter().map(first).collect();
        let straight = fit(&Self { logarithms: true, ..self.clone() }, &[-0.3], start)?;
        fit(self, &straight.shared, straight.own)
    }

    fn cor(shared: f64) -> (f64, f64) {
        (shared.exp(), shared.exp())
    }

    fn usable(&self) -> bool {
        self.trials.iter().any(|t| t.len() >= 2)
    }
}

impl OneKind for Contacts {
    const METHOD: &'static str = "times";
    const ABOUT: &'static str =
        "contact times, least squares on the times themselves; needs neither gravity nor heights";
    const ASSUMED: f64 = 0.01;

    fn with_sigma(evidence: &Evidence, sigma: f64) -> Self {
        Self { trials: evidence.moments(sigma), high: 1.0, trend: false, added_up: evidence.added_up() }
    }

    fn read(evidence: &Evidence) -> Vec<f64> {
        evidence.trials.iter().flat_map(|t| t.moments.iter().map(|m| m.2)).collect()
    }

    fn without_bound(&self) -> Self {
        Self { high: 10.0, ..self.clone() }
    }

    fn with_trend(&self) -> Self {
        Self { trend: true, high: 10.0, ..self.clone() }
    }

    fn same_tolerance(mut self, tolerance: f64) -> Self {
        self.trials.iter_mut().flatten().for_each(|m| m.sigma = tolerance);
        self
    }

    fn minimise(&self) -> Result<Fitted, Failure> {
        let ratio = |m: &[Moment]| {
            let same = m[1].apex == m[0].apex && m[2].apex == m[0].apex;
            let next = m[1].flights == m[0].flights + 1 && m[2].flights == m[0].flights + 2;
            let ratio = (m[2].time - m[1].time) / (m[1].time - m[0].time);
            (same && next && ratio.is_finite()).then_some(ratio)
        };
        let mut ratios: Vec<f64> = self.trials.iter().flat_map(|t| t.windows(3).filter_map(ratio)).collect();
        let e = median(&mut ratios).unwrap_or(0.7).clamp(0.05, self.high.min(1.5));
        fit(self, &[e], self.start(e))
    }

    fn cor(shared: f64) -> (f64, f64) {
        (shared, 1.0)
    }

    fn usable(&self) -> bool {
        self.trials.iter().any(|t| t.len() >= 3)
    }
}

/// The standard deviation of rounding to the decimal that all these numbers are given to. A scatter that happens to be smaller claims too much.
fn rounding(values: &[f64]) -> f64 {
    let steps = [1.0, 0.1, 0.01, 0.001, 1e-4];
    let whole = |step: &f64| values.iter().all(|v| (v / step - (v / step).round()).abs() < 1e-6);
    steps.into_iter().find(whole).map_or(0.0, |step| step / 12f64.sqrt())
}

/// Turns a failure into an error, except that of a table that determines nothing.
pub(crate) fn identified<T>(what: &str, result: Result<T, Failure>) -> Result<Option<T>, FitError> {
    match result {
        Ok(found) => Ok(Some(found)),
        // Numbers so large or small that their squares overflow determine nothing either.
        Err(Failure::NotIdentified | Failure::Malformed) => Ok(None),
        Err(Failure::Solver(reason)) => Err(FitError::Solver { what: what.to_owned(), reason }),
    }
}

/// Fits one kind of reading; `None` where the table does not determine a COR by it.
pub(crate) fn one_kind<M: OneKind>(evidence: &Evidence, known: Option<Sourced>) -> Result<Option<Kind<M>>, FitError> {
    let run = |model: &M| identified(M::METHOD, model.minimise());
    let mut sigma = known.unwrap_or(Sourced { value: M::ASSUMED, source: Source::Assumed });
    let mut model = M::with_sigma(evidence, sigma.value);
    if !model.usable() {
        return Ok(None);
    }
    let Some(mut fitted) = run(&model)? else { return Ok(None) };
    if known.is_none() && fitted.freedom >= SCATTER && !fitted.active[0] {
        #[allow(clippy::cast_precision_loss)]
        let factor = (fitted.chi_square / fitted.freedom as f64).sqrt().max(rounding(&M::read(evidence)) / M::ASSUMED);
        // Readings without any scatter at all leave the usual error in place: zero would claim too much.
        if factor * M::ASSUMED > 1e-9 {
            sigma = Sourced { value: factor * M::ASSUMED, source: Source::Scatter };
            model = M::with_sigma(evidence, sigma.value);
            // All weights change alike: the minimum stays where it is.
            fitted.chi_square /= factor * factor;
            fitted.covariance *= factor * factor;
            fitted.separate.iter_mut().for_each(|s| s.0 /= factor * factor);
        }
    }
    let (mut estimate, mut replicated) = describe::<M>(&fitted, sigma, "");
    let pooled = estimate.value;
    let mut spread = None;
    // Above all where each drop by itself is explained by the reading errors, and only all together are not.
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
    let trend = trend(&model, &fitted, sigma)?;
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
        unbounded = Some(describe::<M>(&free, sigma, "-unbounded").0);
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
        scatter: None,
        spread,
        models: Vec::new(),
    }))
}

/// Whether the errors of times between contacts are to be taken as adding up along the times, as where each was read or rounded by itself.
///
/// A few intervals do not tell whether the contacts were timed, or each interval: what leaves the larger error is taken, unless the stated error of
/// reading rules that out. Of many trials the spread tells.
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
        // Ratios that follow the number of the bounce do not scatter: their cause is looked for among the models.
        && found.followed < 0.5
    {
        let Estimate { chi_square, p, .. } = kind.estimate;
        kind.estimate = Estimate { chi_square, p, ..found.estimate };
        if p.is_some() {
            kind.estimate.degrees_of_freedom = Some(kind.fitted.freedom);
        }
        kind.separate = in_cor(&found.separate, kind.estimate.value.unwrap_or(1.0));
        (kind.trend, kind.replicated, kind.scatter) = (found.trend, found.replicated, Some(found.scatter));
        kind.models = found.models;
    }
    Ok(Some(kind))
}

/// Information and shifts of another unknown as those of the COR, whose derivative by it is `slope`.
fn in_cor(separate: &[(f64, f64)], slope: f64) -> Vec<(f64, f64)> {
    separate.iter().map(|(weight, shift)| (weight / (slope * slope), shift * slope)).collect()
}

/// The estimate a fit amounts to, and whether the spread between trials set its error.
fn describe<M: OneKind>(fitted: &Fitted, sigma: Sourced, suffix: &str) -> (Estimate, bool) {
    let (value, slope) = M::cor(fitted.shared[0]);
    let mut error = slope * fitted.covariance[(0, 0)].sqrt();
    let scattered = sigma.source == Source::Scatter;
    let mut quantile = if scattered { student(fitted.freedom) } else { NORMAL };
    let contributing = fitted.influence.iter().filter(|d| **d != 0.0).count();
    let mut replicated = false;
    if contributing >= REPLICATED && !fitted.active[0] {
        let spread = slope * jackknife(&fitted.influence, contributing);
        replicated = true;
        // A stated reading error is a floor under the spread: readings that repeat exactly were rounded, not perfect.
        if scattered || spread > error {
            (error, quantile) = (spread, student(contributing - 1));
        }
    }
    let mut estimate = Estimate::new(&format!("{}{suffix}", M::METHOD), M::ABOUT, value, error, quantile);
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
    let means = Estimate::new(&estimate.method, &estimate.about, value, standard_error, across.quantile);
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

/// The probability that chance alone improves the fit as much as a COR that changes from bounce to bounce does.
fn trend<M: OneKind>(model: &M, fitted: &Fitted, sigma: Sourced) -> Result<Option<f64>, FitError> {
    if fitted.freedom < 2 || fitted.active[0] {
        return Ok(None);
    }
    let changed = model.with_trend();
    let score = score_gain(&changed, &[fitted.shared[0], 0.0], &fitted.own);
    let Some((gain, left)) = identified("a trend", score)? else { return Ok(None) };
    let gain = gain.max(0.0);
    if sigma.source != Source::Scatter {
        return Ok(chi_square_p(gain, 1));
    }
    #[allow(clippy::cast_precision_loss)]
    let variance = left / (fitted.freedom - 1) as f64;
    Ok(variance_ratio_p(gain / variance, 1, fitted.freedom - 1))
}
