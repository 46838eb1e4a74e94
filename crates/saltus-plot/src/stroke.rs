//! Curves in the plane whose coordinates are polynomials of one parameter, as Bézier curves.

use std::fmt::Write;

use crate::curve::{Affine, NARROW, TOLERANCE};
use crate::error::{PlotError, finite, magnitude};
use crate::polynomial::{derivative, extent, shifted, value};
use crate::svg::number;

/// One smooth stretch of a curve: x = Σ aₖ sᵏ and y = Σ bₖ sᵏ for 0 ≤ s ≤ span, in SI units.
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
    /// From the coefficients of x and of y in rising powers.
    #[must_use]
    pub fn new(span: f64, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self { span, x, y }
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

    /// Where it starts.
    #[must_use]
    pub fn start(&self) -> (f64, f64) {
        self.at(0.0)
    }

    /// Where it ends.
    #[must_use]
    pub fn end(&self) -> (f64, f64) {
        self.at(self.span)
    }

    pub(crate) fn at(&self, s: f64) -> (f64, f64) {
        (value(&self.x, s), value(&self.y, s))
    }

    pub(crate) fn check(&self, name: impl Fn() -> String) -> Result<[(f64, f64); 2], PlotError> {
        magnitude(self.span, || format!("the span of {}", name()))?;
        for &c in self.x.iter().chain(&self.y) {
            finite(c, || format!("a coefficient of {}", name()))?;
        }
        let reach = [extent(&self.x, self.span), extent(&self.y, self.span)];
        for (low, high) in reach {
            finite(low, || format!("a point of {}", name()))?;
            finite(high, || format!("a point of {}", name()))?;
        }
        Ok(reach)
    }
}

/// The path data of strokes, one subpath as long as they join up.
pub(crate) fn path(strokes: &[Stroke], x: Affine, y: Affine) -> String {
    let mut pen = Pen { data: String::new(), at: None, from: None };
    for stroke in strokes.iter().filter(|stroke| stroke.span > 0.0) {
        pen.stroke(stroke, x, y);
    }
    pen.lift();
    pen.data
}

type Point = (f64, f64);

fn apart(a: Point, b: Point) -> f64 {
    (a.0 - b.0).abs().max((a.1 - b.1).abs())
}

struct Pen {
    data: String,
    /// Where the last command ended.
    at: Option<Point>,
    /// Where small strokes that are not yet drawn have come to.
    from: Option<Point>,
}

impl Pen {
    fn push(&mut self, command: char, points: &[Point]) {
        self.data.push(command);
        for (i, &(px, py)) in points.iter().enumerate() {
            let gap = if i == 0 { "" } else { " " };
            // Writing to a String cannot fail.
            let _ = write!(self.data, "{gap}{} {}", number(px, 2), number(py, 2));
        }
        self.at = points.last().copied();
    }

    /// Draws what was gathered.
    fn lift(&mut self) {
        if let Some(to) = self.from.take()
            && self.at.is_some_and(|at| apart(at, to) > TOLERANCE)
        {
            self.push('L', &[to]);
        }
    }

    fn stroke(&mut self, stroke: &Stroke, x: Affine, y: Affine) {
        let page = |(a, b): Point| (x.at(a), y.at(b));
        let (start, end) = (page(stroke.at(0.0)), page(stroke.at(stroke.span)));
        let stands = self.from.or(self.at);
        if !stands.is_some_and(|at| apart(at, start) <= NARROW) {
            self.lift();
            self.push('M', &[start]);
        }
        let ((x0, x1), (y0, y1)) = (extent(&stroke.x, stroke.span), extent(&stroke.y, stroke.span));
        let size = ((x1 - x0) * x.scale).abs().max(((y1 - y0) * y.scale).abs());
        // Strokes too small to see are gathered until together they are large enough.
        if size <= NARROW {
            self.from = Some(end);
            if self.at.is_some_and(|at| apart(at, end) > NARROW) {
                self.lift();
            }
            return;
        }
        self.lift();
        let degree = |c: &[f64]| c.iter().rposition(|&c| c != 0.0).unwrap_or(0);
        match degree(&stroke.x).max(degree(&stroke.y)) {
            0 | 1 => self.push('L', &[end]),
            2 => {
                let half = 0.5 * stroke.span;
                let slope = |c: &[f64]| c.get(1).copied().unwrap_or(0.0);
                let (a, b) = stroke.at(0.0);
                let middle = page((a + half * slope(&stroke.x), b + half * slope(&stroke.y)));
                self.push('Q', &[middle, end]);
            }
            _ => self.cubics(stroke, (0.0, 1.0), x, y, 0),
        }
    }

    /// The cubic that shares points and slopes at both ends of `part`, halved until it is close
    /// enough.
    fn cubics(&mut self, stroke: &Stroke, part: (f64, f64), x: Affine, y: Affine, depth: u32) {
        let width = stroke.span * (part.1 - part.0);
        let middle = 0.5 * (part.0 + part.1);
        // |error| <= max |c''''| width⁴ / 384 for each coordinate, the maximum bounded by its Taylor coefficients.
        let fourth = |c: &[f64]| -> f64 {
            let terms = shifted(c, stroke.span * middle).into_iter().zip(0i32..).skip(4);
            terms
                .map(|(c, k)| {
                    let falling = f64::from(k * (k - 1) * (k - 2) * (k - 3));
                    (c * falling).abs() * (0.5 * width).powi(k - 4)
                })
                .sum()
        };
        let off = (fourth(&stroke.x) * x.scale.abs()).max(fourth(&stroke.y) * y.scale.abs());
        if off * width.powi(4) / 384.0 > TOLERANCE && depth < 12 {
            self.cubics(stroke, (part.0, middle), x, y, depth + 1);
            self.cubics(stroke, (middle, part.1), x, y, depth + 1);
            return;
        }
        let (a, b) = (stroke.span * part.0, stroke.span * part.1);
        let third = width / 3.0;
        let (dx, dy) = (derivative(&stroke.x), derivative(&stroke.y));
        let ahead = |s: f64, by: f64| {
            let (px, py) = stroke.at(s);
            (x.at(px + by * value(&dx, s)), y.at(py + by * value(&dy, s)))
        };
        self.push('C', &[ahead(a, third), ahead(b, -third), ahead(b, 0.0)]);
    }
}
