//! What goes into a picture: arcs, measurements, residuals.

use crate::error::{PlotError, finite, magnitude};
use crate::polynomial;

/// One smooth stretch of motion: a polynomial in the time since its start.
///
/// h(t) = Σ cₖ (t − start)ᵏ for start ≤ t ≤ start + span, in metres and seconds. A flight under
/// gravity has three coefficients (height, velocity, −g/2); a ball at rest has one.
///
/// # Example
///
/// ```
/// use saltus_plot::Arc;
///
/// let drop = Arc::new(0.0, 0.4, vec![1.0, 0.0, -4.9]);
/// assert!((drop.height(0.3) - 0.559).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Arc {
    start: f64,
    span: f64,
    /// The unit of time of the coefficients, in seconds.
    scale: f64,
    coefficients: Vec<f64>,
}

impl Arc {
    /// An arc from `start` (s) over `span` (s) with `coefficients` in rising powers (m, m/s, m/s²,
    /// ...).
    ///
    /// No coefficients at all mean height zero. A span of zero draws nothing.
    #[must_use]
    pub fn new(start: f64, span: f64, coefficients: Vec<f64>) -> Self {
        Self { start, span, scale: 1.0, coefficients }
    }

    /// The same with coefficients of the powers of (t − start)/`scale`: those of a short step
    /// neither overflow nor vanish.
    pub(crate) fn scaled(start: f64, span: f64, scale: f64, coefficients: Vec<f64>) -> Self {
        Self { start, span, scale, coefficients }
    }

    /// The height (m) at time `t` (s); the polynomial goes on beyond the arc's ends.
    #[must_use]
    pub fn height(&self, t: f64) -> f64 {
        polynomial::value(&self.coefficients, (t - self.start) / self.scale)
    }

    pub(crate) fn start(&self) -> f64 {
        self.start
    }

    pub(crate) fn span(&self) -> f64 {
        self.span
    }

    /// How long it lasts in the unit of the coefficients.
    pub(crate) fn length(&self) -> f64 {
        self.span / self.scale
    }

    pub(crate) fn end(&self) -> f64 {
        self.start + self.span
    }

    pub(crate) fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The lowest and highest point, both ends included.
    pub(crate) fn extent(&self) -> (f64, f64) {
        polynomial::extent(&self.coefficients, self.length())
    }

    pub(crate) fn check(&self, name: impl Fn() -> String) -> Result<(), PlotError> {
        finite(self.start, || format!("the start of {}", name()))?;
        magnitude(self.span, || format!("the span of {}", name()))?;
        finite(self.end(), || format!("the end of {}", name()))?;
        for (k, &c) in self.coefficients.iter().enumerate() {
            finite(c, || format!("coefficient {k} of {}", name()))?;
        }
        let (low, high) = self.extent();
        finite(low, || format!("a height on {}", name()))?;
        finite(high, || format!("a height on {}", name()))?;
        Ok(())
    }
}

/// What kind of moment a measurement belongs to; it decides the shape of its mark.
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
    /// Where the ball was let go: a square.
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

/// How far a measurement lies from the model, in its own standard errors: z = (measured − model)/σ.
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
