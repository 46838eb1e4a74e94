//! Models that describe one kind of reading by one COR.

use std::sync::Arc;

use super::least_squares::Failure;
use super::successive::{Fitted, fit};
use crate::elementary::{exp, ln};
use crate::error::FitError;
use crate::evidence::{ASSUMED_TIME, Evidence, Height, Moment};
use crate::model::{Contacts, Heights, Model};
use crate::quantity::Readings;
use crate::statistics::median;

/// Turns a failure into an error, except that of a table that determines nothing.
pub(crate) fn identified<T>(what: &str, result: Result<T, Failure>) -> Result<Option<T>, FitError> {
    match result {
        Ok(found) => Ok(Some(found)),
        // Numbers so large or small that their squares overflow determine nothing either.
        Err(Failure::NotIdentified | Failure::Malformed) => Ok(None),
        Err(Failure::Solver(reason)) => Err(FitError::Solver { what: what.to_owned(), reason }),
    }
}

/// A model that describes one kind of reading by one COR.
pub(crate) trait OneKind: Model + Clone {
    const READINGS: Readings;
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
    const READINGS: Readings = Readings::Heights;
    const ASSUMED: f64 = 0.01;

    fn with_sigma(evidence: &Evidence, sigma: f64) -> Self {
        Self {
            trials: Arc::new(evidence.heights(sigma)),
            high: 0.0,
            trend: false,
            logarithms: false,
            supposed: evidence.supposed,
        }
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
        Arc::make_mut(&mut self.trials).iter_mut().flatten().for_each(|h| h.2 = tolerance);
        self
    }

    fn minimise(&self) -> Result<Fitted, Failure> {
        let first = |t: &Vec<Height>| vec![t.first().map_or(0.0, |h| ln(h.1))];
        let start = self.trials.iter().map(first).collect();
        let straight = fit(&Self { logarithms: true, ..self.clone() }, &[-0.3], start)?;
        fit(self, &straight.shared, straight.own)
    }

    fn cor(shared: f64) -> (f64, f64) {
        (exp(shared), exp(shared))
    }

    fn usable(&self) -> bool {
        self.trials.iter().any(|t| t.len() >= 2)
    }
}

impl OneKind for Contacts {
    const READINGS: Readings = Readings::Times;
    const ASSUMED: f64 = ASSUMED_TIME;

    fn with_sigma(evidence: &Evidence, sigma: f64) -> Self {
        Self {
            trials: evidence.moments(sigma),
            high: 1.0,
            trend: false,
            added_up: evidence.added_up(),
            supposed: evidence.supposed,
        }
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
