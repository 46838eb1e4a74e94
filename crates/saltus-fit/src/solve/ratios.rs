//! Times again, where the bounces themselves scatter: every impact has a COR of its own around the
//! mean.
//!
//! A rough floor makes the COR a random quantity (Montaine, Heckel, Kruelle, Schwager and Pöschel
//! 2011, arXiv:1104.0049). Its scatter adds up along the times, which then are no longer a curve
//! with independent errors; but the logarithms of the ratios of neighbouring intervals stay
//! independent but for the reading errors that they share: yₖ = ln(Δₖ₊₁/Δₖ) = L + ηₖ + B δt, with
//! covariance s² I + σ² B Bᵀ.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::choice::ModelChoice;
use super::estimate::Estimate;
use crate::elementary::{exp, ln};
use crate::evidence::{Evidence, TrialEvidence};
use crate::model::LONGEST_CONTACT;
use crate::quantity::{CorModel, Measured, Method, Source, Sourced};
use crate::statistics::{CLEAR, REPLICATED, SCATTER, student, variance_ratio_p};

/// A trial with more ratios than this is left to the fit of the times: its covariance would be too
/// large a matrix.
const LARGEST: usize = 400;

/// A table with more ratios than this is left to the fit of the times too.
const MOST: usize = 20_000;

/// One trial's log-ratios and the covariance that a reading error of 1 s gives them.
struct Ratios {
    trial: usize,
    y: DVector<f64>,
    /// The flight before each middle contact, s.
    before: DVector<f64>,
    reading: DMatrix<f64>,
}

/// A trial's log-ratios with the factor of their covariance s² I + σ² B Bᵀ, which every fit to them
/// divides by.
struct Weighted<'a> {
    ratios: &'a Ratios,
    factor: Cholesky<f64, Dyn>,
    log_det: f64,
}

/// Generalised least squares at given variances.
struct Solved {
    mean: f64,
    /// 1/Σ 1ᵀC⁻¹1.
    variance: f64,
    /// Σ rᵀC⁻¹r.
    square: f64,
    /// Twice the negative restricted log-likelihood, with a common factor of the covariance
    /// profiled out.
    deviance: f64,
    /// The same of the whole likelihood, and a price for each unknown.
    bic: f64,
    /// For each trial 1ᵀC⁻¹1 and 1ᵀC⁻¹y.
    parts: Vec<(f64, f64)>,
}

/// A COR from the ratios, with the scatter of the bounces.
#[derive(Clone, Debug)]
pub(crate) struct FromRatios {
    pub(crate) estimate: Estimate,
    /// The standard deviation of the COR from bounce to bounce, relative to the COR.
    pub(crate) scatter: f64,
    pub(crate) trend: Option<f64>,
    /// How much of the scatter goes with the number of the bounce: from 0 to 1.
    pub(crate) followed: f64,
    pub(crate) replicated: bool,
    /// For each trial of the table its information on ln e, and its own ln e less that of all.
    pub(crate) separate: Vec<(f64, f64)>,
    /// What else the ratios may depend on beside their scatter, one COR among it, the best first.
    pub(crate) models: Vec<ModelChoice>,
}

fn collect(trial: &TrialEvidence) -> Option<Ratios> {
    let contacts: Vec<(usize, f64)> = trial.moments.iter().filter(|m| !m.1).map(|m| (m.0, m.2)).collect();
    let whole: Vec<&[(usize, f64)]> =
        contacts.windows(3).filter(|w| w[2].0 == w[0].0 + 2 && w[1].1 > w[0].1 && w[2].1 > w[1].1).collect();
    // The covariance below counts on neighbouring rows being neighbouring bounces.
    if whole.is_empty() || whole.len() > LARGEST || whole.len() + 2 != contacts.len() {
        return None;
    }
    let n = whole.len();
    let y = DVector::from_iterator(n, whole.iter().map(|w| ln((w[2].1 - w[1].1) / (w[1].1 - w[0].1))));
    let before = DVector::from_iterator(n, whole.iter().map(|w| w[1].1 - w[0].1));
    let mut b = DMatrix::zeros(n, n + 2);
    for (k, w) in whole.iter().enumerate() {
        let (before, after) = (1.0 / (w[1].1 - w[0].1), 1.0 / (w[2].1 - w[1].1));
        if trial.added_up {
            // One error for each interval.
            b[(k, k)] = -before;
            b[(k, k + 1)] = after;
        } else {
            b[(k, k)] = before;
            b[(k, k + 1)] = -before - after;
            b[(k, k + 2)] = after;
        }
    }
    Some(Ratios { trial: trial.trial, y, before, reading: &b * b.transpose() })
}

/// The `trials` by bounces that scatter by `scatter` and times that are read to `reading` seconds.
fn weigh(trials: &[Ratios], scatter: f64, reading: f64) -> Option<Vec<Weighted<'_>>> {
    let weighted = trials.iter().map(|ratios| {
        let n = ratios.y.len();
        let covariance = DMatrix::from_diagonal_element(n, n, scatter * scatter) + reading * reading * &ratios.reading;
        let factor = covariance.cholesky()?;
        let log_det = 2.0 * factor.l_dirty().diagonal().iter().map(|d| ln(*d)).sum::<f64>();
        Some(Weighted { ratios, factor, log_det })
    });
    weighted.collect()
}

#[allow(clippy::cast_precision_loss)]
fn solve(trials: &[Weighted<'_>]) -> Option<Solved> {
    let parts = trials.iter().map(|Weighted { ratios, factor, .. }| {
        let ones = factor.solve(&DVector::from_element(ratios.y.len(), 1.0));
        (ones.sum(), ones.dot(&ratios.y))
    });
    let parts: Vec<(f64, f64)> = parts.collect();
    let (weight, sum) = parts.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
    let mean = sum / weight;
    let squares = trials.iter().map(|Weighted { ratios, factor, .. }| {
        let r = ratios.y.add_scalar(-mean);
        r.dot(&factor.solve(&r))
    });
    let square: f64 = squares.sum();
    let log_det: f64 = trials.iter().map(|trial| trial.log_det).sum();
    let count = trials.iter().map(|trial| trial.ratios.y.len()).sum::<usize>() as f64;
    let deviance = log_det + ln(weight) + (count - 1.0) * ln(square);
    let bic = log_det + count * ln(square) + ln(count);
    let good = mean.is_finite() && square.is_finite() && weight > 0.0;
    good.then_some(Solved { mean, variance: 1.0 / weight, square, deviance, bic, parts })
}

/// The COR from ratios, where the readings favour bounces that scatter over times that are read
/// badly; else `None`.
///
/// With a known reading error the scatter of the bounces is what is left over (the estimate of
/// Paule and Mandel, J. Res. NBS 87, 377, 1982); without one, the two explanations are compared,
/// and the better is taken.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn scattering(evidence: &Evidence, sigma: Sourced) -> Option<FromRatios> {
    let trials: Vec<Ratios> = evidence.trials.iter().filter_map(collect).collect();
    let count: usize = trials.iter().map(|t| t.y.len()).sum();
    if !(SCATTER + 1..=MOST).contains(&count) {
        return None;
    }
    let freedom = count - 1;
    let (scatter, reading) = if sigma.source == Source::Scatter || sigma.source == Source::Assumed {
        let bouncing = timed_worse(&trials)?;
        ((bouncing.square / freedom as f64).sqrt(), 0.0)
    } else {
        let excess = |s: f64| Some(solve(&weigh(&trials, s, sigma.value)?)?.square - freedom as f64);
        if excess(0.0)? <= 0.0 {
            return None;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if excess(middle)? > 0.0 { low = middle } else { high = middle }
        }
        (high, sigma.value)
    };
    if scatter <= 0.0 {
        return None;
    }
    let weighted = weigh(&trials, scatter, reading)?;
    let found = solve(&weighted)?;
    let value = exp(found.mean);
    let mut error = found.variance.sqrt();
    let mut quantile = student(freedom);
    let replicated = trials.len() >= REPLICATED;
    if replicated {
        let (weight, sum) = found.parts.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
        let without: Vec<f64> = found.parts.iter().map(|(x, y)| (sum - y) / (weight - x)).collect();
        let n = without.len() as f64;
        let mean = without.iter().sum::<f64>() / n;
        let spread = ((n - 1.0) / n * without.iter().map(|l| (l - mean).powi(2)).sum::<f64>()).sqrt();
        (error, quantile) = (spread, student(trials.len() - 1));
    }
    let mut separate = vec![(0.0, 0.0); evidence.trials.len()];
    for (trial, (weight, sum)) in trials.iter().zip(&found.parts) {
        separate[trial.trial] = (*weight, sum / weight - found.mean);
    }
    let mut estimate = Estimate::new(Method::Times, value, value * error, quantile);
    estimate.trials = trials.len();
    estimate.degrees_of_freedom = Some(freedom);
    let models = beside(&weighted, &estimate);
    let (trend, followed) = trend(&weighted, evidence).unzip();
    Some(FromRatios {
        estimate,
        scatter,
        trend: trend.flatten(),
        followed: followed.unwrap_or(0.0),
        replicated,
        separate,
        models,
    })
}

/// A model, x, and the sign that c must have; 0 where either will do.
type Follows = (CorModel, fn(f64) -> f64, f64);

/// What scattering ratios Δₖ₊₁/Δₖ may follow, to first order in ln(Δₖ₊₁/Δₖ) = ln e + c x(Δₖ): a COR
/// linear in speed, x = Δ; drag, x = Δ², the height of the flight; contacts that take time, x =
/// 1/Δ. Drag makes the first ratios smaller, and so do contacts that take time.
const FOLLOWS: [Follows; 3] = [
    (CorModel::Linear, |flight| flight, 0.0),
    (CorModel::Drag, |flight| flight * flight, -1.0),
    (CorModel::Contact, |flight| 1.0 / flight, 1.0),
];
/// The longest flight must be so many times the shortest.
const SPANS: f64 = 2.0;

/// One COR by bounces that scatter, where these explain the ratios better than times that are read
/// badly do.
///
/// The two are compared by their restricted likelihood beside what the ratios clearly follow: what
/// follows air or the speed would be a scatter of the bounces beside one COR, however well times
/// were read.
fn timed_worse(trials: &[Ratios]) -> Option<Solved> {
    let either = [weigh(trials, 0.0, 1.0)?, weigh(trials, 1.0, 0.0)?];
    let follows = |(_, x, sign): Follows| {
        let lines = either.each_ref().map(|weighted| line(weighted, |t, k| x(t.before[k])));
        let likely = |line: Option<Line>| {
            line.filter(|line| line.slope * sign >= 0.0).map(|line| (line.bic + CLEAR, line.deviance))
        };
        let [Some(timing), Some(bouncing)] = lines.map(likely) else { return None };
        Some([timing, bouncing])
    };
    let (timing, bouncing) = (solve(&either[0])?, solve(&either[1])?);
    let level = [&timing, &bouncing].map(|found| (found.bic, found.deviance));
    let all = FOLLOWS.into_iter().filter_map(follows).chain([level]);
    let best = all.min_by(|a, b| a[0].0.min(a[1].0).total_cmp(&b[0].0.min(b[1].0)))?;
    (best[1].1 < best[0].1).then_some(bouncing)
}

/// The models of [`FOLLOWS`] beside one COR, with bounces that scatter.
#[allow(clippy::cast_precision_loss)]
fn beside(trials: &[Weighted<'_>], one: &Estimate) -> Vec<ModelChoice> {
    let flights = || trials.iter().flat_map(|t| t.ratios.before.iter().copied());
    let (shortest, longest) = (flights().fold(f64::INFINITY, f64::min), flights().fold(0.0, f64::max));
    let (Some(value), Some(standard_error), count) = (one.value, one.standard_error, flights().count() as f64) else {
        return Vec::new();
    };
    let mut constant = ModelChoice::new(CorModel::Constant, Measured { value, standard_error }, 0.0);
    constant.chosen = true;
    let mut list = vec![constant];
    if longest < SPANS * shortest || count < 6.0 {
        return Vec::new();
    }
    for (name, x, sign) in FOLLOWS {
        // Drag and the time of contact are counted from none of either, speed from its middle.
        let zero = if sign == 0.0 { x((shortest * longest).sqrt()) } else { 0.0 };
        let Some(line) = line(trials, |t, k| x(t.before[k]) - zero) else { continue };
        let Measured { value, standard_error } = line.level;
        let (e, left) = (exp(value), line.left / line.alone);
        if line.slope * sign < 0.0 || !(0.0..=1.0).contains(&e) || left <= 0.0 {
            continue;
        }
        let bic = count * ln(left) + ln(count);
        let cor = Measured { value: e, standard_error: e * standard_error };
        let mut model = ModelChoice::new(name, cor, bic);
        if name == CorModel::Contact && e < 1.0 {
            let lasts = line.slope / (1.0 / e - 1.0);
            if lasts > LONGEST_CONTACT {
                continue;
            }
            model.contact_s = Some(Measured { value: lasts, standard_error: lasts * line.slope_error / line.slope });
        }
        list.push(model);
    }
    list.sort_by(|a, b| a.bic.total_cmp(&b.bic));
    list
}

/// A straight line through the logarithms of ratios.
struct Line {
    level: Measured,
    slope: f64,
    slope_error: f64,
    /// The weighted sum of squares that it leaves, and that a level alone leaves.
    left: f64,
    alone: f64,
    count: usize,
    /// As those of [`Solved`].
    deviance: f64,
    bic: f64,
}

/// The line over `x`, by generalised least squares; its errors are those of the scatter about it.
#[allow(clippy::cast_precision_loss)]
fn line(trials: &[Weighted<'_>], x: impl Fn(&Ratios, usize) -> f64) -> Option<Line> {
    let mut normal = DMatrix::<f64>::zeros(2, 2);
    let mut right = DVector::<f64>::zeros(2);
    let (mut total, mut log_det, mut count) = (0.0, 0.0, 0);
    for Weighted { ratios, factor, log_det: det } in trials {
        let n = ratios.y.len();
        let x = DMatrix::from_fn(n, 2, |i, j| if j == 0 { 1.0 } else { x(ratios, i) });
        let weighted = factor.solve(&x);
        normal += x.transpose() * &weighted;
        right += weighted.transpose() * &ratios.y;
        total += ratios.y.dot(&factor.solve(&ratios.y));
        log_det += det;
        count += n;
    }
    let factor = normal.clone().cholesky()?;
    let (found, inverse) = (factor.solve(&right), factor.inverse());
    let left = (total - found.dot(&right)).max(0.0);
    let freedom = count.checked_sub(2).filter(|n| *n > 0)?;
    let variance = left / freedom as f64;
    let unexplained = log_det + freedom as f64 * ln(left);
    Some(Line {
        level: Measured { value: found[0], standard_error: (variance * inverse[(0, 0)]).sqrt() },
        slope: found[1],
        slope_error: (variance * inverse[(1, 1)]).sqrt(),
        left,
        alone: total - right[0] * right[0] / normal[(0, 0)],
        count,
        deviance: unexplained + ln(normal.determinant()),
        bic: unexplained + 2.0 * (ln(left) + ln(count as f64)),
    })
}

/// The probability that chance alone makes the ratios follow the number of the bounce as closely as
/// they do, and how much of their squares that is.
#[allow(clippy::cast_precision_loss)]
fn trend(trials: &[Weighted<'_>], evidence: &Evidence) -> Option<(Option<f64>, f64)> {
    let first = |trial: &Ratios| evidence.trials.get(trial.trial).and_then(|t| t.moments.first()).map_or(0, |m| m.0);
    let line = line(trials, |trial, i| (first(trial) + i) as f64)?;
    let (gain, freedom) = ((line.alone - line.left).max(0.0), line.count - 2);
    Some((variance_ratio_p(gain / (line.left / freedom as f64), 1, freedom), gain / line.alone))
}
