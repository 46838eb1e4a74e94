//! From polynomials in time to Bézier curves on the page.
//!
//! Time and height go to the page by affine maps, so a polynomial of degree two *is* one quadratic
//! Bézier curve and one of degree three one cubic; nothing is sampled. Higher degrees are cut into
//! cubic pieces until a bound on the error, taken from the fourth derivative, is below
//! [`TOLERANCE`].

use std::fmt::Write;

use crate::data::Arc;
use crate::polynomial::{derivative, shifted, trimmed, value};
use crate::svg::number;

/// Farthest a piece of a curve of degree four or more may be from the truth, in px.
pub(crate) const TOLERANCE: f64 = 0.02;

/// Arcs narrower than this, in px, are drawn together.
pub(crate) const NARROW: f64 = 0.3;

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

    /// The same map for values `size` times as large: from an axis' unit to seconds or metres.
    pub(crate) fn per_unit(self, size: f64) -> Self {
        Self { origin: self.origin, scale: self.scale / size, zero: self.zero * size }
    }
}

/// The path data of one motion; one curve command per flight, one subpath as long as the arcs join
/// up.
pub(crate) fn path(arcs: &[Arc], x: Affine, y: Affine) -> String {
    let mut pen = Pen { data: String::new(), at: None };
    let mut rest = arcs;
    while let [first, tail @ ..] = rest {
        if first.span() == 0.0 {
            rest = tail;
            continue;
        }
        let narrow = gathered(rest, x);
        if narrow.len() > 1 {
            pen.together(narrow, x, y);
            rest = &rest[narrow.len()..];
        } else {
            pen.arc(first, x, y);
            rest = tail;
        }
    }
    pen.data
}

/// The leading arcs that together are no wider than [`NARROW`]; always at least one.
fn gathered(arcs: &[Arc], x: Affine) -> &[Arc] {
    let Some(first) = arcs.first() else {
        return arcs;
    };
    let from = x.at(first.start());
    let count = arcs.iter().take_while(|arc| (x.at(arc.end()) - from).abs() <= NARROW).count();
    &arcs[..count.max(1)]
}

struct Pen {
    data: String,
    at: Option<(f64, f64)>,
}

impl Pen {
    fn push(&mut self, command: char, points: &[(f64, f64)]) {
        self.data.push(command);
        for (i, &(px, py)) in points.iter().enumerate() {
            let gap = if i == 0 { "" } else { " " };
            // Writing to a String cannot fail.
            let _ = write!(self.data, "{gap}{} {}", number(px, 3), number(py, 3));
        }
        self.at = points.last().copied();
    }

    /// Start here, unless the pen already stands here.
    fn start(&mut self, to: (f64, f64)) {
        let joined = self.at.is_some_and(|(px, py)| (px - to.0).abs() <= TOLERANCE && (py - to.1).abs() <= TOLERANCE);
        if !joined {
            self.push('M', &[to]);
        }
    }

    fn arc(&mut self, arc: &Arc, x: Affine, y: Affine) {
        let c = trimmed(arc.coefficients());
        let span = arc.length();
        let (x0, x1) = (x.at(arc.start()), x.at(arc.end()));
        let across = |part: f64| x0 + (x1 - x0) * part;
        let (start, end) = (value(c, 0.0), value(c, span));
        self.start((x0, y.at(start)));
        match c.len() {
            0..=2 => self.push('L', &[(x1, y.at(end))]),
            3 => {
                let middle = start + 0.5 * span * c[1];
                self.push('Q', &[(across(0.5), y.at(middle)), (x1, y.at(end))]);
            }
            _ => self.cubics(c, span, (0.0, 1.0), &across, y, 0),
        }
    }

    /// The cubic that shares values and slopes at both ends of `part`, halved until it is close
    /// enough.
    fn cubics(&mut self, c: &[f64], span: f64, part: (f64, f64), across: &impl Fn(f64) -> f64, y: Affine, depth: u32) {
        let width = span * (part.1 - part.0);
        let middle = 0.5 * (part.0 + part.1);
        // |error| <= max |h''''| width⁴ / 384, the maximum bounded on the piece by its Taylor coefficients.
        let fourth: f64 = shifted(c, span * middle)
            .iter()
            .zip(0i32..)
            .skip(4)
            .map(|(c, k)| {
                let falling = f64::from(k * (k - 1) * (k - 2) * (k - 3));
                (c * falling).abs() * (0.5 * width).powi(k - 4)
            })
            .sum();
        if fourth * width.powi(4) / 384.0 * y.scale.abs() > TOLERANCE && depth < 12 {
            self.cubics(c, span, (part.0, middle), across, y, depth + 1);
            self.cubics(c, span, (middle, part.1), across, y, depth + 1);
            return;
        }
        let slope = derivative(c);
        let (a, b) = (span * part.0, span * part.1);
        let third = width / 3.0;
        let (ha, hb) = (value(c, a), value(c, b));
        let one = ha + third * value(&slope, a);
        let two = hb - third * value(&slope, b);
        let step = (part.1 - part.0) / 3.0;
        self.push(
            'C',
            &[(across(part.0 + step), y.at(one)), (across(part.1 - step), y.at(two)), (across(part.1), y.at(hb))],
        );
    }

    /// Arcs too narrow to tell apart: up to the highest point they reach, down to the lowest, on to
    /// where they end.
    fn together(&mut self, arcs: &[Arc], x: Affine, y: Affine) {
        let (Some(first), Some(last)) = (arcs.first(), arcs.last()) else {
            return;
        };
        self.start((x.at(first.start()), y.at(first.height(first.start()))));
        let (low, high) = arcs
            .iter()
            .map(Arc::extent)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (l, h)| (low.min(l), high.max(h)));
        let end = (x.at(last.end()), y.at(last.height(last.end())));
        if (y.at(high) - y.at(low)).abs() > NARROW {
            let from = x.at(first.start());
            self.push('L', &[(from + (end.0 - from) / 3.0, y.at(high))]);
            self.push('L', &[(end.0 - (end.0 - from) / 3.0, y.at(low))]);
        }
        self.push('L', &[end]);
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
        let arc = Arc::new(0.2, 0.7, vec![0.1, 3.3, -4.9]);
        let data = path(std::slice::from_ref(&arc), X, Y);
        let kinds: String = commands(&data).iter().map(|c| c.0).collect();
        assert_eq!(kinds, "MQ");
        // Rounding to thousandths of a px is all that is lost; the slope turns a step aside into a
        // step up.
        assert!(farthest(&data, |t| arc.height(t)) < 3e-3, "{data}");
    }

    #[test]
    fn a_cubic_is_one_cubic_curve() {
        let arc = Arc::new(0.1, 0.8, vec![0.1, 2.0, -6.0, 4.0]);
        let data = path(std::slice::from_ref(&arc), X, Y);
        assert_eq!(commands(&data).iter().map(|c| c.0).collect::<String>(), "MC");
        assert!(farthest(&data, |t| arc.height(t)) < 3e-3);
    }

    #[test]
    fn higher_degrees_stay_within_tolerance_and_few() {
        let arc = Arc::new(0.0, 1.0, vec![0.5, 2.0, -9.0, 8.0, 5.0, -9.0, 1.0, 2.0]);
        let data = path(std::slice::from_ref(&arc), X, Y);
        let count = commands(&data).len() - 1;
        assert!((2..=32).contains(&count), "{count} pieces");
        let error = farthest(&data, |t| arc.height(t));
        assert!(error < TOLERANCE + 5e-3, "{error}");
    }

    #[test]
    fn flights_that_join_make_one_subpath() {
        let (a, b) = (Arc::new(0.0, 1.0, vec![0.0, 4.9, -4.9]), Arc::new(1.0, 0.5, vec![0.0, 2.45, -4.9]));
        let apart = Arc::new(1.6, 0.1, vec![0.2]);
        let kinds: String = commands(&path(&[a, b, apart], X, Y)).iter().map(|c| c.0).collect();
        assert_eq!(kinds, "MQQML");
    }

    #[test]
    fn narrow_arcs_are_drawn_together_but_reach_as_high() {
        let span = 1e-5;
        let arcs: Vec<_> =
            (0..10_000).map(|i| Arc::new(f64::from(i) * span, span, vec![0.0, 2e10 * span, -2e10])).collect();
        let data = path(&arcs, X, Y);
        assert!(data.len() < 20_000, "{} bytes", data.len());
        let top = Y.at(arcs[0].extent().1);
        let highest =
            commands(&data).iter().flat_map(|c| c.1.chunks(2).map(|p| p[1]).collect::<Vec<_>>()).fold(1e9, f64::min);
        assert!((highest - top).abs() < 2e-3, "{highest} against {top}");
    }
}
