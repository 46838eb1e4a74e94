//! How far drops differ from one another: each trial fitted by itself, and the mean over all.

use super::one::{OneKind, identified};
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::quantity::{Measured, Source, Sourced};
use crate::statistics::{NORMAL, chi_square_p, student, variance_ratio_p};

/// The mean of values that scatter by more than their errors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Across {
    pub(crate) mean: Measured,
    /// The factor from standard error to 95 % interval.
    pub(crate) quantile: f64,
    /// The standard deviation of the true values from one to the next.
    pub(crate) spread: f64,
}

/// The mean of `DerSimonian` and Laird (1986), its error from the values' own scatter (Hartung and
/// Knapp 2001) but never below what their errors allow.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn across(values: &[Measured]) -> Option<Across> {
    let first = values.first()?;
    if values.len() == 1 {
        return Some(Across { mean: *first, quantile: NORMAL, spread: 0.0 });
    }
    let freedom = values.len() - 1;
    let variance = |m: &Measured| m.standard_error.max(1e-12).powi(2);
    let weighted = |extra: f64| {
        let weights: Vec<f64> = values.iter().map(|m| 1.0 / (variance(m) + extra)).collect();
        let total: f64 = weights.iter().sum();
        let mean = weights.iter().zip(values).map(|(w, m)| w * m.value).sum::<f64>() / total;
        let square: f64 = weights.iter().zip(values).map(|(w, m)| w * (m.value - mean).powi(2)).sum();
        (total, weights.iter().map(|w| w * w).sum::<f64>(), mean, square)
    };
    let (total, squares, _, q) = weighted(0.0);
    let extra = ((q - freedom as f64) / (total - squares / total)).max(0.0);
    let (total, _, value, q) = weighted(extra);
    let own = (1.0 / total).sqrt();
    let scattered = (q / (freedom as f64 * total)).sqrt();
    let standard_error = own.max(scattered);
    let mean = Measured { value, standard_error };
    value.is_finite().then_some(Across { mean, quantile: student(freedom), spread: extra.sqrt() })
}

/// What trials fitted one by one leave: the sum of their chi-squares, its degrees of freedom, and
/// each trial's COR.
#[derive(Clone, Debug, Default)]
pub(crate) struct Apart {
    pub(crate) chi_square: f64,
    pub(crate) freedom: usize,
    pub(crate) cors: Vec<Measured>,
}

impl Apart {
    /// Whether one COR for all is ruled out and one for each trial is not; `whole` is the
    /// chi-square of one COR for all.
    #[allow(clippy::cast_precision_loss)]
    pub(crate) fn explains(&self, whole: f64, sigma: Source, reject: f64) -> bool {
        let Some(above) = self.cors.len().checked_sub(1).filter(|n| *n > 0) else { return false };
        let between = (whole - self.chi_square).max(0.0);
        if sigma == Source::Scatter {
            let ratio = (between / above as f64) / (self.chi_square / self.freedom.max(1) as f64);
            return variance_ratio_p(ratio, above, self.freedom).is_some_and(|p| p < reject);
        }
        let holds = chi_square_p(self.chi_square, self.freedom).is_none_or(|p| p >= reject);
        holds && chi_square_p(between, above).is_some_and(|p| p < reject)
    }
}

/// Fits every trial of one kind of reading by itself; `None` where one of them determines no COR.
pub(crate) fn apart<M: OneKind>(evidence: &Evidence, sigma: Sourced) -> Result<Option<Apart>, FitError> {
    let mut found = Apart::default();
    for trial in &evidence.trials {
        let alone = Evidence::supposed(vec![trial.clone()]);
        let model = M::with_sigma(&alone, sigma.value);
        if !model.usable() {
            continue;
        }
        let Some(fitted) = identified(M::READINGS.name(), model.minimise())? else { return Ok(None) };
        let (value, slope) = M::cor(fitted.shared[0]);
        let standard_error = slope * fitted.covariance[(0, 0)].sqrt();
        if fitted.active[0] || !standard_error.is_finite() || standard_error <= 0.0 {
            return Ok(None);
        }
        found.chi_square += fitted.chi_square;
        found.freedom += fitted.freedom;
        found.cors.push(Measured { value, standard_error });
    }
    Ok((found.cors.len() > 1).then_some(found))
}
