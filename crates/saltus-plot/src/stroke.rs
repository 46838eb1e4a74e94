//! Smooth stretches of a curve whose coordinates are polynomials of one parameter.

use crate::error::{PlotError, finite, magnitude};
use crate::polynomial::{extent, value};

/// A smooth stretch of a curve: x = Σ aₖ sᵏ and y = Σ bₖ sᵏ for 0 ≤ s ≤ span, in SI units.
///
/// No coefficients at all mean zero. A span of zero draws nothing.
///
/// ```
/// use saltus_plot::{Chart, Measure, Stroke};
/// // A throw: x = 3 t, y = 1 + 2 t - 4.9 t².
/// let throw = Stroke::new(0.7, vec![0.0, 3.0], vec![1.0, 2.0, -4.9]);
/// let svg = Chart::new("A throw", ("x", Measure::Length), ("Height", Measure::Length)).line("", [throw]).svg()?;
/// assert_eq!(svg.matches('Q').count(), 1); // a parabola is one quadratic curve
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    pub(crate) span: f64,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
}

impl Stroke {
    /// The stroke with these coefficients of x and of y in rising powers.
    #[must_use]
    pub fn new(span: f64, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { span, x, y }
    }

    /// A polynomial in the time since its start, against time: y = Σ cₖ (t - start)ᵏ for
    /// start ≤ t ≤ start + span.
    ///
    /// A flight under gravity has three coefficients (height, velocity, -g/2); a ball at rest has
    /// one.
    ///
    /// ```
    /// use saltus_plot::Stroke;
    /// let drop = Stroke::over_time(2.0, 0.4, vec![1.0, 0.0, -4.9]);
    /// let (t, height) = drop.at(0.3);
    /// assert!((t - 2.3).abs() < 1e-12 && (height - 0.559).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn over_time(start: f64, span: f64, coefficients: Vec<f64>) -> Self {
        Self::new(span, vec![start, 1.0], coefficients)
    }

    /// The straight line between two points.
    #[must_use]
    pub fn between(from: [f64; 2], to: [f64; 2]) -> Self {
        let [x, y] = [0, 1].map(|k| vec![from[k], to[k] - from[k]]);
        Self { span: 1.0, x, y }
    }

    /// The corners of an open polygon as strokes.
    #[must_use]
    pub fn polygon(points: &[[f64; 2]]) -> Vec<Self> {
        points.windows(2).map(|pair| Self::between(pair[0], pair[1])).collect()
    }

    /// The start.
    #[must_use]
    pub fn start(&self) -> (f64, f64) {
        self.at(0.0)
    }

    /// The end.
    #[must_use]
    pub fn end(&self) -> (f64, f64) {
        self.at(self.span)
    }

    /// The point at `s`; the polynomials go on beyond the ends.
    #[must_use]
    pub fn at(&self, s: f64) -> (f64, f64) {
        (value(&self.x, s), value(&self.y, s))
    }

    /// The lowest and the highest x, and the lowest and the highest y.
    pub(crate) fn reach(&self) -> [(f64, f64); 2] {
        [extent(&self.x, self.span), extent(&self.y, self.span)]
    }

    pub(crate) fn check(&self, name: impl Fn() -> String) -> Result<[(f64, f64); 2], PlotError> {
        magnitude(self.span, || format!("the span of {}", name()))?;
        for c in [&self.x, &self.y] {
            for (k, &c) in c.iter().enumerate() {
                finite(c, || {
                    if k == 0 { format!("the start of {}", name()) } else { format!("coefficient {k} of {}", name()) }
                })?;
            }
        }
        let reach = self.reach();
        for (low, high) in reach {
            finite(low, || format!("a point of {}", name()))?;
            finite(high, || format!("a point of {}", name()))?;
        }
        Ok(reach)
    }
}
