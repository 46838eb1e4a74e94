//! A polynomial in place of a guard: its interpolant at nine Chebyshev points, and how far off that
//! may be.

use crate::poly::{Bernstein, SUMMED};

use super::probe::Search;
use super::{Undefined, chebyshev};

impl Search<'_> {
    /// The guard at the Chebyshev points of `[a, b]` and at two checks between them.
    pub(super) fn sampled(&mut self, a: f64, b: f64) -> Result<Samples, Undefined> {
        let (centre, radius) = (0.5 * (a + b), 0.5 * (b - a));
        let mut values = [0.0; 9];
        values[0] = if a == 0.0 { self.start()? } else { self.value(a)? };
        self.values(&mut values[1..8], |k| centre + radius * chebyshev::NODES[k + 1])?;
        values[8] = self.value(b)?;
        let series = chebyshev::series(&values);
        let mut checks = [0.0; 2];
        self.values(&mut checks, |k| centre + radius * CHECKS[k])?;
        let far = |k: usize| (checks[k] - chebyshev::sum(&series, CHECKS[k])).abs();
        let off = far(0).max(far(1));
        let off = (series[7].abs() + series[8].abs()).max(off);
        let varies = series[1..].iter().map(|c| c.abs()).sum();
        // The nodes themselves are rounded, and the state at them likewise.
        let least = values.into_iter().fold(f64::INFINITY, f64::min);
        let spacing = (b.next_up() - b) / (b - a);
        Ok(Samples { series, varies, off, spacing, start: values[0], end: values[8], least, values })
    }
}

/// Where a guard is compared with its interpolant: away from the nodes, and at no fraction that a
/// guard is likely to have a period of.
const CHECKS: [f64; 2] = [-0.557_350_921, 0.271_828_183];
/// Elsewhere a guard may be so many times as far from its interpolant.
/// Held by `cross::tests::a_floor_that_lets_go`.
const UNCHECKED: f64 = 8.0;

/// A guard sampled at the Chebyshev points of an interval.
pub(super) struct Samples {
    series: [f64; 9],
    /// What its interpolant varies by at most, to each side of its first coefficient.
    varies: f64,
    /// How far the guard is from its interpolant, by its checks.
    off: f64,
    /// The spacing of numbers, as a part of the interval.
    spacing: f64,
    /// The guard at both ends.
    start: f64,
    end: f64,
    /// The least sample.
    least: f64,
    /// All of them.
    values: [f64; 9],
}

impl Samples {
    /// Between which places in -1..=1 the interpolant turns up from its least value, unless that is
    /// at an end or clear of zero: above a half of what the interpolant varies by.
    pub(super) fn turn(&self) -> Option<[f64; 2]> {
        if self.series[0] > 2.0 * self.varies {
            return None;
        }
        // T'ₖ(1) = k², T'ₖ(-1) = (-1)ᵏ⁻¹ k².
        let slope = |odd: f64| {
            let c = &self.series;
            odd * (c[1] + 9.0 * c[3] + 25.0 * c[5] + 49.0 * c[7]) + 4.0 * c[2] + 16.0 * c[4] + 36.0 * c[6] + 64.0 * c[8]
        };
        let lowest = (1..9).fold(0, |low, k| if self.values[k] < self.values[low] { k } else { low });
        let turns = match lowest {
            0 => slope(-1.0) > 0.0,
            8 => slope(1.0) > 0.0,
            _ => true,
        };
        turns.then(|| [chebyshev::NODES[lowest.max(1) - 1], chebyshev::NODES[(lowest + 1).min(8)]])
    }

    /// Whether the guard is positive on the whole interval for the size of the series alone
    /// (|`T_k`| ≤ 1, and its slope ≤ k²).
    pub(super) fn stay_above(&self) -> bool {
        let (mut steepest, mut square) = (0.0, 1.0);
        for (k, c) in self.series.iter().enumerate().skip(1) {
            steepest += 2.0 * square * c.abs();
            square += (2 * k + 1) as f64;
        }
        let scale = self.series[0].abs() + self.varies;
        self.series[0]
            > self.varies + UNCHECKED * (self.off + steepest * self.spacing) + 2.0 * SUMMED * f64::EPSILON * scale
    }

    pub(super) fn proxy(&self) -> Proxy {
        let p = Bernstein::new(&chebyshev::bernstein(&self.series));
        let margin = UNCHECKED * (self.off + p.steepest() * self.spacing) + 2.0 * p.rounding();
        let margin = if margin.is_finite() { margin } else { f64::INFINITY };
        Proxy { p, margin, start: self.start, end: self.end, least: self.least }
    }
}

/// A polynomial in place of the guard on an interval.
pub(super) struct Proxy {
    pub(super) p: Bernstein,
    /// How far the guard may be from it.
    pub(super) margin: f64,
    /// The guard at both ends.
    pub(super) start: f64,
    pub(super) end: f64,
    /// Its least sample.
    pub(super) least: f64,
}
