//! The COR bounce by bounce, and the means that weigh every bounce alike.

use serde::{Deserialize, Serialize};

use super::estimate::Estimate;
use crate::elementary::{exp, ln};
use crate::evidence::{Evidence, TrialEvidence};
use crate::quantity::{Measured, Method};
use crate::statistics::{NORMAL, REPLICATED};

/// Bounces beyond this number are not listed one by one.
const LISTED: usize = 24;

/// The COR at one bounce, from the heights before and after it, and from the flights before and
/// after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BounceCor {
    /// The number of the contact, from 1.
    pub bounce: usize,
    /// √(hₙ/hₙ₋₁).
    pub heights: Option<Measured>,
    /// The ratio of the flights after and before; at bounce 1 the fall √(2h₀/g) counts as half a
    /// flight, so h₀ and g enter.
    pub times: Option<Measured>,
}

/// A logarithm of a COR with its variance.
type Log = (f64, f64);

pub(crate) struct Setting {
    pub(crate) gravity: f64,
    pub(crate) sigma_height: f64,
    pub(crate) sigma_time: f64,
}

impl Setting {
    /// ln √(h₂/h₁) and its variance.
    fn height_ratio(&self, before: (f64, Option<f64>), after: (f64, Option<f64>)) -> Log {
        let relative = |(h, s): (f64, Option<f64>)| (s.unwrap_or(self.sigma_height) / h).powi(2);
        (0.5 * ln(after.0 / before.0), 0.25 * (relative(before) + relative(after)))
    }

    /// The fall from a release height, s.
    pub(crate) fn fall(&self, height: f64) -> f64 {
        (2.0 * height / self.gravity).sqrt()
    }

    /// ln of a ratio of intervals that share a contact, and its variance.
    fn interval_ratio(&self, before: f64, after: f64) -> Log {
        let (a, b) = (self.sigma_time / before, self.sigma_time / after);
        (ln(after / before), 2.0 * (a * a + b * b + a * b))
    }

    /// ln of the first flight over twice the fall, and its variance.
    fn first_flight(&self, trial: &TrialEvidence) -> Option<Log> {
        let (height, _) = trial.release_height?;
        let flight = trial.contact(2)? - trial.contact(1)?;
        Some((ln(flight / (2.0 * self.fall(height))), 2.0 * (self.sigma_time / flight).powi(2)))
    }
}

/// The weighted mean of logarithms as a value with its error: from the spread where there are
/// enough of them.
#[allow(clippy::cast_precision_loss)]
fn mean(logs: &[Log]) -> Option<Measured> {
    let weight: f64 = logs.iter().map(|l| 1.0 / l.1).sum();
    let log = logs.iter().map(|l| l.0 / l.1).sum::<f64>() / weight;
    let mut error = (1.0 / weight).sqrt();
    if logs.len() >= REPLICATED {
        let n = logs.len() as f64;
        let spread = logs.iter().map(|l| ((l.0 - log) / l.1).powi(2)).sum::<f64>().sqrt() / weight;
        error = error.max(spread * (n / (n - 1.0)).sqrt());
    }
    let value = exp(log);
    (value.is_finite() && error.is_finite()).then_some(Measured { value, standard_error: value * error })
}

/// The COR of each bounce, over all trials.
pub(crate) fn list(evidence: &Evidence, setting: &Setting) -> Vec<BounceCor> {
    let mut heights: Vec<Vec<Log>> = vec![Vec::new(); LISTED + 1];
    let mut times: Vec<Vec<Log>> = vec![Vec::new(); LISTED + 1];
    for trial in &evidence.trials {
        for pair in trial.heights.windows(2).filter(|p| p[1].0 == p[0].0 + 1 && p[1].0 <= LISTED) {
            heights[pair[1].0].push(setting.height_ratio((pair[0].1, pair[0].2), (pair[1].1, pair[1].2)));
        }
        times[1].extend(setting.first_flight(trial));
        for (flights, before, after, _) in trial.ratios().filter(|r| r.0 < LISTED) {
            times[flights + 1].push(setting.interval_ratio(before, after));
        }
    }
    (1..=LISTED)
        .map(|n| BounceCor { bounce: n, heights: mean(&heights[n]), times: mean(&times[n]) })
        .filter(|b| b.heights.is_some() || b.times.is_some())
        .collect()
}

/// `heights-mean`, `first-flight` and `times-mean`: every bounce weighing alike, the last flight
/// compared with the first.
pub(crate) fn means(evidence: &Evidence, setting: &Setting) -> Vec<Estimate> {
    let mut found = Vec::new();
    let mut push = |method: Method, logs: &[Log]| {
        if let Some(m) = mean(logs) {
            let mut estimate = Estimate::new(method, m.value, m.standard_error, NORMAL);
            estimate.trials = logs.len();
            found.push(estimate);
        }
    };
    #[allow(clippy::cast_precision_loss)]
    let per_bounce = |(log, variance): Log, n: usize| (log / n as f64, variance / (n * n) as f64);
    let ends = |t: &TrialEvidence| {
        let (first, last) = (t.heights.first()?, t.heights.last()?);
        let ratio = setting.height_ratio((first.1, first.2), (last.1, last.2));
        (last.0 >= first.0 + 2).then(|| per_bounce(ratio, last.0 - first.0))
    };
    let logs: Vec<Log> = evidence.trials.iter().filter_map(ends).collect();
    push(Method::HeightsMean, &logs);

    let logs: Vec<Log> = evidence.trials.iter().filter_map(|t| setting.first_flight(t)).collect();
    push(Method::FirstFlight, &logs);

    let ends = |t: &TrialEvidence| {
        let (height, _) = t.release_height?;
        t.contact(1)?;
        let (last, interval) = t.intervals().last()?;
        let fall = 2.0 * setting.fall(height);
        let log = (ln(interval / fall), 2.0 * (setting.sigma_time / interval).powi(2));
        (last >= 2).then(|| per_bounce(log, last))
    };
    let logs: Vec<Log> = evidence.trials.iter().filter_map(ends).collect();
    push(Method::TimesMean, &logs);
    found
}
