//! Errors of parameters outside the domain of a law: what is wrong, and what to give.

use std::fmt;

/// A number that is outside the domain of a law's parameter: what it was to be, what was given,
/// what to give instead.
///
/// ```
/// use saltus_bounce::effects::LinearDrag;
/// let error = LinearDrag::new(-1.0).unwrap_err();
/// assert_eq!(error.to_string(), "-1 is not a drag rate in 1/s: give a finite number, zero or more");
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct ParameterError {
    what: &'static str,
    value: f64,
    give: &'static str,
}

impl ParameterError {
    pub(crate) const fn new(what: &'static str, value: f64, give: &'static str) -> Self {
        Self { what, value, give }
    }

    /// The number that was refused.
    #[must_use]
    pub const fn value(&self) -> f64 {
        self.value
    }
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is not {}: give {}", self.value, self.what, self.give)
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for ParameterError {}

/// `value` if it is finite and above zero.
pub(crate) const fn positive(what: &'static str, value: f64) -> Result<f64, ParameterError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(ParameterError::new(what, value, "a finite number above zero"))
    }
}

/// `value` if it is finite and not below zero.
pub(crate) const fn not_negative(what: &'static str, value: f64) -> Result<f64, ParameterError> {
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(ParameterError::new(what, value, "a finite number, zero or more"))
    }
}

/// `value` if it lies between `low` and `high`, both included; `give` says so in words.
pub(crate) const fn between(
    what: &'static str,
    value: f64,
    low: f64,
    high: f64,
    give: &'static str,
) -> Result<f64, ParameterError> {
    if value >= low && value <= high { Ok(value) } else { Err(ParameterError::new(what, value, give)) }
}

/// `value` if it is finite.
pub(crate) const fn finite(what: &'static str, value: f64) -> Result<f64, ParameterError> {
    if value.is_finite() { Ok(value) } else { Err(ParameterError::new(what, value, "a finite number")) }
}
