//! Measured points for a picture, and how far each lies from the fitted motion.

use serde::{Deserialize, Serialize};

use crate::word::words;

words! {
    /// What a reading was taken of.
    pub enum Mark {
        /// The ball is let go.
        Release = "release",
        /// The ball touches the floor.
        Contact = "contact",
        /// The ball is at the top of a flight.
        Apex = "apex",
        /// The ball is somewhere in flight.
        Sample = "sample",
    }
}

/// Which reading of a trial: its kind, and its number; an apex bears the number of the contact
/// before it.
pub(super) type Which = (Mark, usize);

fn label((mark, number): Which) -> String {
    if mark == Mark::Release { mark.name().to_owned() } else { format!("{mark} {number}") }
}

/// Which quantity was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Measure {
    /// A height, in metres.
    Height,
    /// A time, in seconds.
    Time,
}

/// One reading beside what the fit predicts for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Residual {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// What was read.
    pub mark: Mark,
    /// Its number.
    pub number: usize,
    /// Both, for people, such as `apex 1` or `contact 2`.
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
    pub(super) fn new(trial: usize, which: Which, kind: Measure, time: f64, values: (f64, f64), sigma: f64) -> Self {
        let ((mark, number), (measured, predicted)) = (which, values);
        let z = (measured - predicted) / sigma;
        Self { trial, mark, number, label: label(which), kind, time, measured, predicted, sigma, z }
    }
}

/// A measured point of the height–time picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Point {
    /// The trial's place in the table, from 0.
    pub trial: usize,
    /// What was read.
    pub mark: Mark,
    /// Its number.
    pub number: usize,
    /// Both, for people, such as `release`, `apex 1` or `contact 2`.
    pub label: String,
    /// On the time axis of the fitted motion, in seconds. An apex whose time was not read stands
    /// midway between its contacts.
    pub time: f64,
    /// The height in metres: zero for a contact.
    pub height: f64,
    /// The standard error of the time, in seconds, if the time was read.
    pub sigma_time: Option<f64>,
    /// The standard error of the height, in metres, if the height was read.
    pub sigma_height: Option<f64>,
}

impl Point {
    /// A point whose errors are not known.
    pub(super) fn new(trial: usize, which: Which, time: f64, height: f64) -> Self {
        let (mark, number) = which;
        Self { trial, mark, number, label: label(which), time, height, sigma_time: None, sigma_height: None }
    }
}
