//! A polynomial in place of a guard: its interpolant at nine Chebyshev points, and how far off that
//! may be.

use crate::poly::{Bernstein, SUMMED};

use super::chebyshev::{CHECKS, SAMPLES, sample_times};
use super::probe::Search;
use super::{Turn, Undefined, chebyshev};

/// How many times as far as samples differ from the first the guard is above zero, for
/// [`stay_clear`].
///
/// Of samples within r of their middle m, 2 c₀² + Σ cₖ² + 2 c₈² ≤ 2 r² holds for the interpolant of
/// the differences: the first coefficient is m - r at least, the others sum up to √15 r in size at
/// most, and at the checks the guard is within 5 r of it, so that m > (5 + √15 + 5 `UNCHECKED`) r
/// is enough; a tenth more is for rounding. Held by `clear_samples_stay_above`.
const CLEAR: f64 = 1.1 * (9.0 + 5.0 * UNCHECKED);

/// Whether samples show at a glance that the guard is above zero on the whole interval: they hardly
/// differ. [`Samples::stay_above`] then holds.
#[inline]
pub(crate) fn stay_clear(values: &[f64; SAMPLES]) -> bool {
    let most = values[0] / CLEAR;
    // All of them, side by side: what is no number is not near.
    values.iter().fold(true, |clear, value| clear & ((value - values[0]).abs() <= most))
}

impl Search<'_> {
    /// The guard at the sample times of `[a, b]`.
    pub(super) fn sampled(&mut self, a: f64, b: f64) -> Result<Samples, Undefined> {
        Samples::of(&self.values(a, b)?, a, b)
    }
}

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
    /// Of values at the sample times of `[a, b]`, if all of them are numbers.
    pub(super) fn of(values: &[f64; SAMPLES], a: f64, b: f64) -> Result<Self, Undefined> {
        if let Some(k) = values.iter().position(|value| value.is_nan()) {
            return Err(Undefined(sample_times(a, b)[k]));
        }
        let (nodes, checks) = values.split_first_chunk().unwrap_or((&[0.0; 9], &[]));
        let series = chebyshev::series(nodes);
        let far = checks.iter().zip(CHECKS).map(|(check, at)| (check - chebyshev::sum(&series, at)).abs());
        let off = far.fold(series[7].abs() + series[8].abs(), f64::max);
        let varies = series[1..].iter().map(|c| c.abs()).sum();
        // The nodes themselves are rounded, and the state at them likewise.
        let spacing = (b.next_up() - b) / (b - a);
        let least = nodes.iter().fold(f64::INFINITY, |least, &value| least.min(value));
        Ok(Self { series, varies, off, spacing, start: nodes[0], end: nodes[8], least, values: *nodes })
    }

    /// Between which times in 0..=b, the interval, the interpolant turns up from its least value,
    /// unless that is at an end or clear of zero: above a half of what the interpolant varies by.
    /// Of a guard that is below zero all along, where it turns down from its greatest one.
    pub(super) fn turn(&self, b: f64) -> Option<Turn> {
        let below = self.values.iter().all(|&value| value < 0.0);
        let side = if below { -1.0 } else { 1.0 };
        if side * self.series[0] > 2.0 * self.varies {
            return None;
        }
        // T'ₖ(1) = k², T'ₖ(-1) = (-1)ᵏ⁻¹ k².
        let slope = |odd: f64| {
            let c = &self.series;
            let even = 4.0 * c[2] + 16.0 * c[4] + 36.0 * c[6] + 64.0 * c[8];
            side * (odd * (c[1] + 9.0 * c[3] + 25.0 * c[5] + 49.0 * c[7]) + even)
        };
        let value = |k: usize| side * self.values[k];
        let lowest = (1..9).fold(0, |low, k| if value(k) < value(low) { k } else { low });
        let turns = match lowest {
            0 => slope(-1.0) > 0.0,
            8 => slope(1.0) > 0.0,
            _ => true,
        };
        let time = |node: usize| 0.5 * b * (1.0 + chebyshev::NODES[node]);
        turns.then(|| Turn { between: [time(lowest.max(1) - 1), time((lowest + 1).min(8))], below })
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_hardly_differs_is_clear_and_what_is_no_number_is_not() {
        let mut values: [f64; SAMPLES] = std::array::from_fn(|k| 2.0 + 0.02 * (k as f64).sin());
        assert!(stay_clear(&values) && !stay_clear(&values.map(|value| -value)));
        for k in 0..SAMPLES {
            let before = std::mem::replace(&mut values[k], f64::NAN);
            assert!(!stay_clear(&values), "{k}");
            values[k] = before;
        }
    }

    proptest! {
        /// Samples that differ by as much as they may, most of them at one of the ends.
        #[test]
        fn clear_samples_stay_above(ends in prop::array::uniform11(prop_oneof![Just(-1.0), Just(1.0), -1.0..1.0_f64]), scale in -300..300_i32) {
            let first = 10.0_f64.powi(scale);
            let all: [f64; SAMPLES] = std::array::from_fn(|k| if k == 0 { first } else { first + 0.999 / CLEAR * first * ends[k] });
            prop_assert!(stay_clear(&all));
            prop_assert!(Samples::of(&all, 0.0, 1.0).unwrap().stay_above());
        }
    }
}
