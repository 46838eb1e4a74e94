//! The data of a picture: measurements and residuals.

use crate::error::{PlotError, finite, magnitude};

/// The kind of moment that a measurement belongs to; it decides the shape of its mark.
///
/// # Example
///
/// ```
/// use saltus_plot::Mark;
///
/// assert_eq!(Mark::default(), Mark::Sample);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[non_exhaustive]
pub enum Mark {
    /// The release of the ball: a square.
    Release,
    /// The top of a flight: a disc.
    Apex,
    /// A touch-down: a diamond.
    Contact,
    /// Any other reading, such as one frame of a film: a small dot.
    #[default]
    Sample,
}

impl Mark {
    pub(crate) const ALL: [Self; 4] = [Self::Release, Self::Apex, Self::Contact, Self::Sample];

    /// The word for it, for example `"apex"`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Apex => "apex",
            Self::Contact => "contact",
            Self::Sample => "reading",
        }
    }
}

/// A measured point: a time and a height, each with the error it was read with.
///
/// An error is one standard error; zero (the default) draws no bar.
///
/// # Example
///
/// ```
/// use saltus_plot::{HeightTime, Mark, Measured};
///
/// let apex = Measured::new(0.70, 0.30).height_error(0.01).mark(Mark::Apex);
/// let svg = HeightTime::new("One apex").measured([apex]).svg()?;
/// assert!(svg.contains("measured apex"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    pub(crate) time: f64,
    pub(crate) height: f64,
    pub(crate) time_error: f64,
    pub(crate) height_error: f64,
    pub(crate) mark: Mark,
}

impl Measured {
    /// A point at `time` (s) and `height` (m) without errors, marked as a plain sample.
    #[must_use]
    pub fn new(time: f64, height: f64) -> Self {
        Self { time, height, time_error: 0.0, height_error: 0.0, mark: Mark::Sample }
    }

    /// The standard error of the time (s): a horizontal bar.
    #[must_use]
    pub fn time_error(mut self, seconds: f64) -> Self {
        self.time_error = seconds;
        self
    }

    /// The standard error of the height (m): a vertical bar.
    #[must_use]
    pub fn height_error(mut self, metres: f64) -> Self {
        self.height_error = metres;
        self
    }

    /// The kind of moment.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.mark = mark;
        self
    }

    pub(crate) fn check(&self, number: usize) -> Result<(), PlotError> {
        finite(self.time, || format!("the time of measurement {number}"))?;
        finite(self.height, || format!("the height of measurement {number}"))?;
        magnitude(self.time_error, || format!("the time error of measurement {number}"))?;
        magnitude(self.height_error, || format!("the height error of measurement {number}"))?;
        Ok(())
    }
}

/// The distance of a measurement from the model, in its own standard errors: z = (measured −
/// model)/σ.
///
/// # Example
///
/// ```
/// use saltus_plot::{HeightTime, Mark, Residual};
///
/// let late = Residual::new(0.85, -2.9).mark(Mark::Contact);
/// let svg = HeightTime::new("One residual").residuals([late]).svg()?;
/// assert!(svg.contains("1 residual"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    pub(crate) time: f64,
    pub(crate) z: f64,
    pub(crate) mark: Mark,
}

impl Residual {
    /// A residual of `z` standard errors at `time` (s), marked as a plain sample.
    #[must_use]
    pub fn new(time: f64, z: f64) -> Self {
        Self { time, z, mark: Mark::Sample }
    }

    /// The kind of moment; use the mark of the measurement it belongs to.
    #[must_use]
    pub fn mark(mut self, mark: Mark) -> Self {
        self.mark = mark;
        self
    }

    pub(crate) fn check(&self, number: usize) -> Result<(), PlotError> {
        finite(self.time, || format!("the time of residual {number}"))?;
        finite(self.z, || format!("the value of residual {number}"))?;
        Ok(())
    }
}
