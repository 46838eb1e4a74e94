//! From polynomials to Bézier curves on the page.
//!
//! Both coordinates go to the page by affine maps, so a stroke of degree two *is* one quadratic
//! Bézier curve and one of degree three one cubic; nothing is sampled. Higher degrees are cut into
//! cubic pieces until a bound on the error, taken from the fourth derivative, is below
//! [`TOLERANCE`].

use std::fmt::Write;

use crate::polynomial::{derivative, shifted, value};
use crate::stroke::Stroke;
use crate::svg::number;

/// Farthest a piece of a curve of degree four or more may be from the truth, in px.
const TOLERANCE: f64 = 0.02;

/// Strokes that together are narrower than this, in px, are drawn as how far they reach.
const NARROW: f64 = 0.3;

/// An affine map from one axis to px: `origin + scale · value`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Affine {
    pub(crate) origin: f64,
    pub(crate) scale: f64,
    /// The value that lies at `origin`; kept apart so that late times lose no digits.
    pub(crate) zero: f64,
}

impl Affine {
    pub(crate) fn at(&self, value: f64) -> f64 {
        self.origin + self.scale * (value - self.zero)
    }

    /// This map for values `size` times as large: from an axis' unit to seconds or metres.
    pub(crate) fn per_unit(self, size: f64) -> Self {
        Self { origin: self.origin, scale: self.scale / size, zero: self.zero * size }
    }

    /// The places of the ends of an interval, the lesser first.
    fn of(&self, (low, high): (f64, f64)) -> (f64, f64) {
        let (a, b) = (self.at(low), self.at(high));
        (a.min(b), a.max(b))
    }
}

/// The path data of strokes: one curve command each, one subpath as long as they join up.
pub(crate) fn path(strokes: &[Stroke], x: Affine, y: Affine) -> String {
    let mut pen = Pen { data: String::new(), at: None, x, y };
    let mut rest = strokes;
    while let [first, tail @ ..] = rest {
        if first.span == 0.0 {
            rest = tail;
            continue;
        }
        let (count, reach) = pen.narrow(rest);
        match &rest[..count] {
            [first, .., last] => pen.together(first, last, reach),
            _ => pen.stroke(first),
        }
        rest = &rest[count..];
    }
    pen.data
}

type Point = (f64, f64);

fn apart(a: Point, b: Point) -> f64 {
    (a.0 - b.0).abs().max((a.1 - b.1).abs())
}

struct Pen {
    data: String,
    /// The end of the last command.
    at: Option<Point>,
    x: Affine,
    y: Affine,
}

impl Pen {
    fn page(&self, (x, y): Point) -> Point {
        (self.x.at(x), self.y.at(y))
    }

    fn push(&mut self, command: char, points: &[Point]) {
        self.data.push(command);
        for (i, &(px, py)) in points.iter().enumerate() {
            let gap = if i == 0 { "" } else { " " };
            // Writing to a String cannot fail.
            let _ = write!(self.data, "{gap}{} {}", number(px, 2), number(py, 2));
        }
        self.at = points.last().copied();
    }

    /// A `command` to a point, unless the pen already stands there.
    fn to(&mut self, command: char, point: Point) {
        if !self.at.is_some_and(|at| apart(at, point) <= TOLERANCE) {
            self.push(command, &[point]);
        }
    }

    /// The number of leading strokes that touch each other and together are no wider than
    /// [`NARROW`], one at least, and their reach up the page.
    fn narrow(&self, strokes: &[Stroke]) -> (usize, (f64, f64)) {
        let reach = |stroke: &Stroke| {
            let [across, up] = stroke.reach();
            [self.x.of(across), self.y.of(up)]
        };
        let touch = |a: (f64, f64), b: (f64, f64)| a.0 <= b.1 + TOLERANCE && b.0 <= a.1 + TOLERANCE;
        let (mut count, mut all) = (1, reach(&strokes[0]));
        for next in strokes[1..].iter().map(reach) {
            let both: [(f64, f64); 2] = [0, 1].map(|k| (all[k].0.min(next[k].0), all[k].1.max(next[k].1)));
            if both[0].1 - both[0].0 > NARROW || !touch(all[1], next[1]) {
                break;
            }
            (count, all) = (count + 1, both);
        }
        (count, all[1])
    }

    /// Strokes too near to each other to be drawn apart: through the ends of how far they reach up,
    /// to where they end.
    fn together(&mut self, first: &Stroke, last: &Stroke, (top, bottom): (f64, f64)) {
        let (start, end) = (self.page(first.start()), self.page(last.end()));
        self.to('M', start);
        let third = |a: f64, b: f64| a + (b - a) / 3.0;
        // The end that lies behind the start comes first.
        let ends = if end.1 > start.1 { [top, bottom] } else { [bottom, top] };
        self.to('L', (third(start.0, end.0), ends[0]));
        self.to('L', (third(end.0, start.0), ends[1]));
        self.to('L', end);
    }

    fn stroke(&mut self, stroke: &Stroke) {
        let end = self.page(stroke.end());
        self.to('M', self.page(stroke.start()));
        let degree = |c: &[f64]| c.iter().rposition(|&c| c != 0.0).unwrap_or(0);
        match degree(&stroke.x).max(degree(&stroke.y)) {
            0 | 1 => self.push('L', &[end]),
            2 => {
                let half = 0.5 * stroke.span;
                let slope = |c: &[f64]| c.get(1).copied().unwrap_or(0.0);
                let (a, b) = stroke.start();
                let middle = self.page((a + half * slope(&stroke.x), b + half * slope(&stroke.y)));
                self.push('Q', &[middle, end]);
            }
            _ => self.cubics(stroke, (0.0, 1.0), 0),
        }
    }

    /// The cubic that shares points and slopes at both ends of `part`, halved until it is close
    /// enough.
    fn cubics(&mut self, stroke: &Stroke, part: (f64, f64), depth: u32) {
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
        let off = (fourth(&stroke.x) * self.x.scale.abs()).max(fourth(&stroke.y) * self.y.scale.abs());
        if off * width.powi(4) / 384.0 > TOLERANCE && depth < 12 {
            self.cubics(stroke, (part.0, middle), depth + 1);
            self.cubics(stroke, (middle, part.1), depth + 1);
            return;
        }
        let (a, b) = (stroke.span * part.0, stroke.span * part.1);
        let third = width / 3.0;
        let (dx, dy) = (derivative(&stroke.x), derivative(&stroke.y));
        let ahead = |s: f64, by: f64| {
            let (px, py) = stroke.at(s);
            self.page((px + by * value(&dx, s), py + by * value(&dy, s)))
        };
        self.push('C', &[ahead(a, third), ahead(b, -third), ahead(b, 0.0)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Affine = Affine { origin: 60.0, scale: 640.0, zero: 0.0 };
    const Y: Affine = Affine { origin: 480.0, scale: -280.0, zero: 0.0 };

    /// The commands of a path with their numbers.
    fn commands(data: &str) -> Vec<(char, Vec<f64>)> {
        let mut found: Vec<(char, String)> = Vec::new();
        for c in data.chars() {
            match (c.is_ascii_alphabetic(), found.last_mut()) {
                (true, _) => found.push((c, String::new())),
                (false, Some(last)) => last.1.push(c),
                (false, None) => panic!("a path begins with a command: {data}"),
            }
        }
        found
            .into_iter()
            .map(|(c, numbers)| (c, numbers.split_whitespace().map(|n| n.parse().unwrap()).collect()))
            .collect()
    }

    /// The height at a time, of a stroke over time.
    fn height(stroke: &Stroke, t: f64) -> f64 {
        stroke.at(t - stroke.start().0).1
    }

    fn bezier(points: &[(f64, f64)], u: f64) -> (f64, f64) {
        let mut points = points.to_vec();
        while points.len() > 1 {
            points =
                points.windows(2).map(|p| (p[0].0 + u * (p[1].0 - p[0].0), p[0].1 + u * (p[1].1 - p[0].1))).collect();
        }
        points[0]
    }

    /// The farthest that any curve of `data` is from the polynomial, in px up and down.
    fn farthest(data: &str, truth: impl Fn(f64) -> f64) -> f64 {
        let mut at = (0.0, 0.0);
        let mut worst: f64 = 0.0;
        for (command, numbers) in commands(data) {
            let ends: Vec<_> = numbers.chunks(2).map(|p| (p[0], p[1])).collect();
            if command != 'M' {
                let points: Vec<_> = std::iter::once(at).chain(ends.iter().copied()).collect();
                for i in 0..=64 {
                    let (px, py) = bezier(&points, f64::from(i) / 64.0);
                    worst = worst.max((py - Y.at(truth((px - X.origin) / X.scale))).abs());
                }
            }
            at = *ends.last().unwrap();
        }
        worst
    }

    #[test]
    fn a_parabola_is_one_quadratic_curve() {
        let arc = Stroke::over_time(0.2, 0.7, vec![0.1, 3.3, -4.9]);
        let data = path(std::slice::from_ref(&arc), X, Y);
        let kinds: String = commands(&data).iter().map(|c| c.0).collect();
        assert_eq!(kinds, "MQ");
        // Rounding to hundredths of a px is all that is lost; the slope turns a step aside into a
        // step up.
        assert!(farthest(&data, |t| height(&arc, t)) < 3e-2, "{data}");
    }

    #[test]
    fn a_cubic_is_one_cubic_curve() {
        let arc = Stroke::over_time(0.1, 0.8, vec![0.1, 2.0, -6.0, 4.0]);
        let data = path(std::slice::from_ref(&arc), X, Y);
        assert_eq!(commands(&data).iter().map(|c| c.0).collect::<String>(), "MC");
        assert!(farthest(&data, |t| height(&arc, t)) < 3e-2);
    }

    #[test]
    fn higher_degrees_stay_within_tolerance_and_few() {
        let arc = Stroke::over_time(0.0, 1.0, vec![0.5, 2.0, -9.0, 8.0, 5.0, -9.0, 1.0, 2.0]);
        let data = path(std::slice::from_ref(&arc), X, Y);
        let count = commands(&data).len() - 1;
        assert!((2..=32).contains(&count), "{count} pieces");
        let error = farthest(&data, |t| height(&arc, t));
        assert!(error < TOLERANCE + 5e-3, "{error}");
    }

    #[test]
    fn flights_that_join_make_one_subpath() {
        let (a, b) =
            (Stroke::over_time(0.0, 1.0, vec![0.0, 4.9, -4.9]), Stroke::over_time(1.0, 0.5, vec![0.0, 2.45, -4.9]));
        let apart = Stroke::over_time(1.6, 0.1, vec![0.2]);
        let kinds: String = commands(&path(&[a, b, apart], X, Y)).iter().map(|c| c.0).collect();
        assert_eq!(kinds, "MQQML");
    }

    #[test]
    fn narrow_arcs_are_drawn_together_but_reach_as_high() {
        let span = 1e-5;
        let arcs: Vec<_> =
            (0..10_000).map(|i| Stroke::over_time(f64::from(i) * span, span, vec![0.0, 2e10 * span, -2e10])).collect();
        let data = path(&arcs, X, Y);
        assert!(data.len() < 20_000, "{} bytes", data.len());
        let top = Y.at(arcs[0].reach()[1].1);
        let highest =
            commands(&data).iter().flat_map(|c| c.1.chunks(2).map(|p| p[1]).collect::<Vec<_>>()).fold(1e9, f64::min);
        assert!((highest - top).abs() < 2e-3, "{highest} against {top}");
    }
}
