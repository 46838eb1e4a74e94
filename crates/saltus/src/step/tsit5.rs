//! Tsit5: order 5(4), six flow evaluations a step, dense output of order 4.

use super::{Differences, Stepper, Trial, closing, difference, weighted};
use crate::state::State;

/// The explicit Runge–Kutta pair of order 5(4) by Tsitouras: the everyday stepper.
///
/// Six flow evaluations a step (the seventh is the first of the next step), an error estimate of
/// order 4 and a dense output of order 4 that is continuous with its first derivative.
///
/// Use it for smooth flows that are not stiff, at relative tolerances of about 1e-3 to 1e-7, and
/// where jumps come so often that a step seldom gets far. Below that [`Dop853`](super::Dop853)
/// needs far fewer evaluations; a stiff flow wants [`Rodas5P`](super::Rodas5P).
///
/// Source: Ch. Tsitouras, *Runge–Kutta pairs of order 5(4) satisfying only the first column
/// simplifying assumption*, Computers & Mathematics with Applications 62 (2011) 770–775,
/// doi:10.1016/j.camwa.2011.06.002.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tsit5;

/// The times of stages 2 to 6 and of the end, which are the sums of their rows.
const C: [f64; 6] = [0.161, 0.327, 0.9, 0.980_025_540_904_509_7, 1.0, 1.0];
// The rows, for k₂ - k₁, k₃ - k₁, …: what k₁ itself gets is given by the sums.
const A3: [f64; 1] = [0.335_480_655_492_357];
const A4: [f64; 2] = [-6.359_448_489_975_075, 4.362_295_432_869_581_5];
const A5: [f64; 3] = [-11.748_883_564_062_828, 7.495_539_342_889_836_5, -0.092_495_066_361_755_25];
const A6: [f64; 4] =
    [-12.920_969_317_847_11, 8.159_367_898_576_159, -0.071_584_973_281_401, -0.028_269_050_394_068_383];
const B: [f64; 5] =
    [0.01, 0.479_889_650_414_499_6, 1.379_008_574_103_742, -3.290_069_515_436_081, 2.324_710_524_099_774];
/// Weights of the fifth-order solution less those of the fourth-order one.
const E: [f64; 6] = [
    -0.000_816_434_459_656_746_9,
    0.007_880_878_010_261_995,
    -0.144_711_007_173_262_9,
    0.582_357_165_452_555_2,
    -0.458_082_105_929_186_97,
    1.0 / 66.0,
];
/// The weights of the stages and of the slope at the end in θ³ and θ⁴ of the dense output. In θ the
/// first stage stands alone, and what is left of the step belongs to θ².
const D: [[f64; 6]; 2] = [
    [-0.223_4, -5.941_033_872_131_505, 30.338_188_630_282_32, -88.178_904_894_766_4, 65.091_894_674_793_66, -4.0],
    [0.101_7, 2.490_627_285_651_253, -16.548_102_889_244_902, 47.379_521_962_819_28, -34.870_657_861_496_61, 2.5],
];

/// The largest weights of the differences anywhere in the dense output, rounded up.
const MOST: [f64; 6] = [0.0125, 0.4939, 1.3791, 3.2901, 2.3248, 0.0678];

impl Stepper for Tsit5 {
    /// k₁, and k₂ - k₁ to k₆ - k₁.
    type Stages<S: State> = [S; 6];
    type Dense<S: State> = [S; 5];

    #[inline]
    fn error_order(&self) -> f64 {
        5.0
    }

    #[inline]
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, [S; 6]> {
        let mut stages = Differences { flow, t, x, slope, h };
        let d2 = stages.next(C[0], &[], []);
        let d3 = stages.next(C[1], &A3, [&d2]);
        let d4 = stages.next(C[2], &A4, [&d2, &d3]);
        let d5 = stages.next(C[3], &A5, [&d2, &d3, &d4]);
        let d6 = stages.next(C[4], &A6, [&d2, &d3, &d4, &d5]);
        let end = stages.state(C[5], &B, [&d2, &d3, &d4, &d5, &d6]);
        Trial { slope: flow(t + h, &end), end, stages: [slope.clone(), d2, d3, d4, d5, d6] }
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &[S; 6]>, square: impl Fn(&S) -> f64) -> f64 {
        let last = last(trial);
        square(&trial.end.with(|i| h * weighted(&E, all(trial, &last), i)))
    }

    #[inline]
    fn reach<S: State>(&self, h: f64, trial: Trial<&S, &[S; 6]>) -> Option<S> {
        let last = last(trial);
        let differences = all(trial, &last);
        let most = |i: usize| MOST.iter().zip(differences).map(|(most, d)| most * d.get(i).abs()).sum::<f64>();
        Some(trial.end.with(|i| h * (trial.stages[0].get(i).abs() + most(i))))
    }

    #[inline]
    fn dense<S: State>(
        &self,
        _: &mut impl FnMut(f64, &S) -> S,
        _: f64,
        x: &S,
        h: f64,
        trial: Trial<&S, &[S; 6]>,
    ) -> [S; 5] {
        let last = last(trial);
        let c1 = x.with(|i| h * trial.stages[0].get(i));
        let higher = |d: &[f64; 6]| x.with(|i| h * weighted(d, all(trial, &last), i));
        let (c3, c4) = (higher(&D[0]), higher(&D[1]));
        let higher = [c3, c4];
        let c2 = closing(x, trial.end, &c1, &higher);
        let [c3, c4] = higher;
        [x.clone(), c1, c2, c3, c4]
    }
}

/// k₇ - k₁.
#[inline]
fn last<S: State>(trial: Trial<&S, &[S; 6]>) -> S {
    difference(trial.slope, &trial.stages[0])
}

/// The differences k₂ - k₁ to k₇ - k₁, of which `last` is the last.
#[inline]
fn all<'a, S>(trial: Trial<&'a S, &'a [S; 6]>, last: &'a S) -> [&'a S; 6] {
    let [_, d2, d3, d4, d5, d6] = trial.stages;
    [d2, d3, d4, d5, d6, last]
}

#[cfg(test)]
mod tests {
    use super::super::testing::{error_order, errors_with, orders};
    use super::*;

    #[test]
    fn the_orders_are_five_and_four() {
        let (order, inside) = orders(Tsit5, 1.0 / 16.0);
        assert!((4.7..5.6).contains(&order), "{order}");
        assert!(inside > 3.8, "{inside}");
        let (at_ends, inside) = errors_with(Tsit5, 1.0 / 32.0);
        assert!(at_ends < 1e-9 && inside < 1e-8, "{at_ends:e} {inside:e}");
        let estimate = error_order(Tsit5, 1.0 / 16.0);
        assert!((Tsit5.error_order() - estimate).abs() < 0.3, "{estimate}");
    }

    #[test]
    fn no_dense_output_reaches_farther() {
        for (k, most) in MOST.into_iter().enumerate() {
            let end = B[..].get(k).copied().unwrap_or(0.0);
            let weight = |s: f64| ((D[1][k] * s + D[0][k]) * s + (end - D[0][k] - D[1][k])) * s * s;
            let largest = (0..=100_000).map(|n| weight(f64::from(n) * 1e-5).abs()).fold(0.0, f64::max);
            assert!((largest..largest + 1e-3).contains(&most), "{k}: {largest} {most}");
        }
    }

    #[test]
    fn rows_are_consistent() {
        // With what the source gives k₁ the rows add up to their times, and to nothing.
        let rows = [
            (&A3[..], -0.008_480_655_492_356_989, C[1]),
            (&A4, 2.897_153_057_105_493_5, C[2]),
            (&A5, 5.325_864_828_439_257, C[3]),
            (&A6, 5.861_455_442_946_42, C[4]),
            (&B, 0.096_460_766_818_065_23, C[5]),
            (&E, -0.001_780_011_052_225_777, 0.0),
            (&D[0], 2.913_255_461_821_912_6, 0.0),
            (&D[1], -1.053_088_497_729_021_6, 0.0),
        ];
        for (row, first, sum) in rows {
            assert!((row.iter().sum::<f64>() + first - sum).abs() < 1e-13, "{row:?}");
        }
        for n in 1..5 {
            let sum: f64 = B.iter().zip(C).map(|(b, c)| b * c.powi(n)).sum();
            assert!((sum - 1.0 / f64::from(n + 1)).abs() < 1e-14, "{n}");
        }
        // The weights of θ², which the closing of the step leaves: those of the source.
        for (k, c2) in [0.131_7, 3.930_296_236_894_751_6, -12.411_077_166_933_676].into_iter().enumerate() {
            assert!((D[0][k] + D[1][k] + c2 - B[k]).abs() < 1e-14);
        }
    }
}
