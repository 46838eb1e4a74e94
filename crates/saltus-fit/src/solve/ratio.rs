//! The COR from neighbouring heights as they are, hₙ₊₁ = κ hₙ with κ = e²: a rebound of zero height
//! may be one of them.

use nalgebra::{DMatrix, DVector};

use super::estimate::Estimate;
use super::least_squares::solve;
use super::profile::ONE_SIDED;
use crate::evidence::Evidence;
use crate::model::Bounds;
use crate::quantity::Method;
use crate::statistics::NORMAL;

/// Weights depend on κ, and hardly change after this many rounds.
const ROUNDS: usize = 4;

/// A pair of neighbouring heights, each with its variance; the trial and the bounce before.
struct Pair {
    before: (f64, f64),
    after: (f64, f64),
    place: (usize, usize),
}

fn pairs(evidence: &Evidence, sigma: f64) -> Vec<Pair> {
    let mut list = Vec::new();
    for trial in &evidence.trials {
        let own = trial.heights.iter().map(|&(n, h, s)| (n, h, s.unwrap_or(sigma)));
        let mut heights: Vec<(usize, f64, f64)> = own.chain(trial.zeros.iter().map(|&n| (n, 0.0, sigma))).collect();
        heights.sort_by_key(|h| h.0);
        for pair in heights.windows(2).filter(|p| p[1].0 == p[0].0 + 1) {
            let ((n, h, s), (_, next, t)) = (pair[0], pair[1]);
            list.push(Pair { before: (h, s * s), after: (next, t * t), place: (trial.trial, n) });
        }
    }
    list
}

/// The square of each misfit over its variance, Σ (h′ − κh)²/(σ′² + κ²σ²).
fn cost(pairs: &[Pair], kappa: f64) -> f64 {
    let one = |p: &Pair| (p.after.0 - kappa * p.before.0).powi(2) / (p.after.1 + kappa * kappa * p.before.1);
    pairs.iter().map(one).sum()
}

/// Least squares within 0 ≤ κ ≤ 1, reweighted; `None` where there is no pair.
///
/// Noise in the height before makes κ too small, by about (σ/h)². At a bound the estimate has a
/// one-sided limit, no standard error.
pub(crate) fn estimate(evidence: &Evidence, sigma: f64) -> Option<Estimate> {
    let pairs = pairs(evidence, sigma);
    let (mut kappa, mut active) = (0.5, false);
    for _ in 0..ROUNDS {
        let weight = |p: &Pair| 1.0 / (p.after.1 + kappa * kappa * p.before.1).sqrt();
        // A rotation leaves one row of those of all pairs that says anything of κ.
        let long = pairs.iter().map(|p| (weight(p) * p.before.0).powi(2)).sum::<f64>().sqrt();
        let along = pairs.iter().map(|p| weight(p).powi(2) * p.before.0 * p.after.0).sum::<f64>() / long;
        let (x, y) = (DMatrix::from_element(1, 1, long), DVector::from_element(1, along));
        // Numbers so large that their squares overflow give no estimate.
        let Ok(found) = solve(&x, &y, &[Bounds { low: 0.0, high: 1.0 }]) else { return None };
        // All rebounds zero: the minimum is on the bound without pressing against it.
        (kappa, active) = (found.x[0], found.active[0] || found.x[0] <= 0.0 || found.x[0] >= 1.0);
    }
    let e = kappa.sqrt();
    let mut estimate = Estimate::new(Method::HeightsRatio, e, f64::NAN, NORMAL);
    let mut trials: Vec<usize> = pairs.iter().map(|p| p.place.0).collect();
    trials.dedup();
    estimate.trials = trials.len();
    estimate.degrees_of_freedom = Some(pairs.len() - 1);
    if active {
        let allowed = |k: f64| cost(&pairs, k) - cost(&pairs, kappa) <= ONE_SIDED;
        let (mut inside, mut outside) = (kappa, 1.0 - kappa);
        if allowed(outside) {
            inside = outside;
        }
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if allowed(middle) { inside = middle } else { outside = middle }
        }
        (estimate.low, estimate.high) = (Some(e.min(inside.sqrt())), Some(e.max(inside.sqrt())));
    } else {
        let error = error(&pairs, kappa) / (2.0 * e);
        let Estimate { standard_error, low, high, .. } = Estimate::new(Method::HeightsRatio, e, error, NORMAL);
        (estimate.standard_error, estimate.low, estimate.high) = (standard_error, low, high);
    }
    Some(estimate)
}

/// The standard error of κ. A height is the second of one pair and the first of the next, so its
/// error counts in both.
fn error(pairs: &[Pair], kappa: f64) -> f64 {
    let weight = |p: &Pair| 1.0 / (p.after.1 + kappa * kappa * p.before.1);
    let total: f64 = pairs.iter().map(|p| weight(p) * p.before.0.powi(2)).sum();
    let mut variance = 0.0;
    for (i, p) in pairs.iter().enumerate() {
        let own = weight(p) * p.before.0;
        let next = pairs.get(i + 1).filter(|q| q.place == (p.place.0, p.place.1 + 1));
        let shared = next.map_or(0.0, |q| kappa * weight(q) * q.before.0);
        variance += p.after.1 * (own - shared).powi(2);
        let first = i == 0 || pairs[i - 1].place != (p.place.0, p.place.1.wrapping_sub(1));
        if first {
            variance += p.before.1 * (kappa * own).powi(2);
        }
    }
    variance.sqrt() / total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::Table;

    fn of(heights: &[f64], sigma: f64) -> Estimate {
        let table = Table::from_heights(heights).unwrap();
        estimate(&Evidence::of(&table, None, false), sigma).unwrap()
    }

    #[test]
    fn the_closed_form_of_one_pair() {
        let found = of(&[1.0, 0.3], 0.01);
        assert!((found.value.unwrap() - 0.3f64.sqrt()).abs() < 1e-9);
        // σ_e/e = ½ √((σ/h₁)² + (σ/h₀)²)
        let expected = 0.3f64.sqrt() * 0.5 * (1.0f64 / 900.0 + 1e-4).sqrt();
        assert!((found.standard_error.unwrap() / expected - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_closed_form_of_many() {
        let (h, sigma) = ([1.0, 0.63, 0.42, 0.25, 0.0], 0.02);
        let found = of(&h, sigma);
        // All weights are alike: κ = Σ h h′/Σ h².
        let kappa: f64 = h.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / h[..4].iter().map(|h| h * h).sum::<f64>();
        assert!((found.value.unwrap() - kappa.sqrt()).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn at_nought_the_cost_gives_a_limit() {
        let found = of(&[1.0, 0.0, 0.0], 0.01);
        assert_eq!((found.value, found.standard_error, found.low), (Some(0.0), None, Some(0.0)));
        // κ²/(σ²(1 + κ²)) = 2.7055: at small σ, κ = 1.6449 σ.
        assert!((found.high.unwrap().powi(2) / 0.016_450_8 - 1.0).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn at_one_too() {
        let found = of(&[1.0, 1.01, 1.02], 0.01);
        assert_eq!((found.value, found.standard_error, found.high), (Some(1.0), None, Some(1.0)));
        let low = found.low.unwrap();
        let cost = |k: f64| ((1.01 - k).powi(2) + (1.02 - k * 1.01).powi(2)) / (1e-4 * (1.0 + k * k));
        assert!((cost(low * low) - cost(1.0) - ONE_SIDED).abs() < 1e-6, "{found:?}");
    }
}
