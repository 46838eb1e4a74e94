//! A COR by one method, with its error.

use serde::{Deserialize, Serialize};

use crate::quantity::Method;

/// A COR by one method.
///
/// In JSON every number that does not exist is `null`: a fit without degrees of freedom has no `p`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Estimate {
    /// By which.
    pub method: Method,
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
    /// The sum of squared residuals, each divided by its standard error; none if that error was
    /// taken from the scatter itself.
    pub chi_square: Option<f64>,
    /// The number of readings less the number of unknowns.
    pub degrees_of_freedom: Option<usize>,
    /// The probability of a chi-square at least as large by chance, if the model holds.
    pub p: Option<f64>,
    /// The number of trials that contribute.
    pub trials: usize,
}

impl Estimate {
    pub(crate) fn new(method: Method, value: f64, error: f64, quantile: f64) -> Self {
        let known = |x: f64| x.is_finite().then_some(x);
        Self {
            method,
            about: String::new(),
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
