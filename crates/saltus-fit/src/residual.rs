//! Measured points for a picture, and how far each lies from the fitted motion.

use serde::Serialize;

/// Which quantity was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// A height, in metres.
    Height,
    /// A time, in seconds.
    Time,
}

/// One reading beside what the fit predicts for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Residual {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// What was read, such as `apex 1` or `contact 2`.
    pub label: String,
    /// Whether a height or a time was read.
    pub kind: Measure,
    /// Where to draw it on the time axis of the fitted motion, in seconds.
    pub time: f64,
    /// The reading, in metres or seconds.
    pub measured: f64,
    /// The prediction, in the same unit.
    pub predicted: f64,
    /// The standard error of the reading, in the same unit.
    pub sigma: f64,
    /// (measured − predicted)/σ.
    pub z: f64,
}

impl Residual {
    pub(crate) fn new(trial: usize, label: String, kind: Measure, time: f64, values: (f64, f64), sigma: f64) -> Self {
        let (measured, predicted) = values;
        Self { trial, label, kind, time, measured, predicted, sigma, z: (measured - predicted) / sigma }
    }
}

/// A measured point of the height–time picture.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Point {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// What was read, such as `release`, `apex 1` or `contact 2`.
    pub label: String,
    /// On the time axis of the fitted motion, in seconds. An apex whose time was not read stands midway between its contacts.
    pub time: f64,
    /// The height in metres: zero for a contact.
    pub height: f64,
    /// The standard error of the time, in seconds, if the time was read.
    pub sigma_time: Option<f64>,
    /// The standard error of the height, in metres, if the height was read.
    pub sigma_height: Option<f64>,
}
