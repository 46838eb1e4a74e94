//! Tsit5: order 5(4), six flow evaluations a step, dense output of order 4.

use super::{Stepper, Trial};
use crate::state::State;

/// The explicit Runge–Kutta pair of order 5(4) by Tsitouras: the everyday stepper.
///
/// Six flow evaluations a step (the seventh is the first of the next step), an error estimate of order 4 and a dense output of order 4
/// that is continuous with its first derivative.
///
/// Source: Ch. Tsitouras, *Runge–Kutta pairs of order 5(4) satisfying only the first column simplifying assumption*,
/// Computers & Mathematics with Applications 62 (2011) 770–775, doi:10.1016/j.camwa.2011.06.002.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tsit5;

const C: [f64; 4] = [0.161, 0.327, 0.9, 0.980_025_540_904_509_7];
const A2: [f64; 1] = [0.161];
const A3: [f64; 2] = [-0.008_480_655_492_356_989, 0.335_480_655_492_357];
const A4: [f64; 3] = [2.897_153_057_105_493_5, -6.359_448_489_975_075, 4.362_295_432_869_581_5];
const A5: [f64; 4] =
    [5.325_864_828_439_257, -11.748_883_564_062_828, 7.495_539_342_889_836_5, -0.092_495_066_361_755_25];
const A6: [f64; 5] = [
    5.861_455_442_946_42,
    -12.920_969_317_847_11,
    8.159_367_898_576_159,
    -0.071_584_973_281_401,
    -0.028_269_050_394_068_383,
];
const B: [f64; 6] = [
    0.096_460_766_818_065_23,
    0.01,
    0.479_889_650_414_499_6,
    1.379_008_574_103_742,
    -3.290_069_515_436_081,
    2.324_710_524_099_774,
];
/// Weights of the fifth-order solution less those of the fourth-order one.
const E: [f64; 7] = [
    -0.001_780_011_052_225_777,
    -0.000_816_434_459_656_746_9,
    0.007_880_878_010_261_995,
    -0.144_711_007_173_262_9,
    0.582_357_165_452_555_2,
    -0.458_082_105_929_186_97,
    1.0 / 66.0,
];
/// Row i: the weight of stage i in powers θ, θ², θ³, θ⁴ of the dense output.
const D: [[f64; 4]; 7] = [
    [1.0, -2.763_706_197_274_826, 2.913_255_461_821_912_6, -1.053_088_497_729_021_6],
    [0.0, 0.131_7, -0.223_4, 0.101_7],
    [0.0, 3.930_296_236_894_751_6, -5.941_033_872_131_505, 2.490_627_285_651_253],
    [0.0, -12.411_077_166_933_676, 30.338_188_630_282_32, -16.548_102_889_244_902],
    [0.0, 37.509_313_416_511_04, -88.178_904_894_766_4, 47.379_521_962_819_28],
    [0.0, -27.896_526_289_197_286, 65.091_894_674_793_66, -34.870_657_861_496_61],
    [0.0, 1.5, -4.0, 2.5],
];

impl Stepper for Tsit5 {
    type Stages<S: State> = [S; 7];
    type Dense<S: State> = [S; 5];

    const ERROR_ORDER: f64 = 5.0;

    #[inline]
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, [S; 7]> {
        let k1 = *slope;
        let k2 = flow(t + C[0] * h, &x.with(|i| x.get(i) + h * A2[0] * k1.get(i)));
        let k3 = flow(t + C[1] * h, &x.with(|i| x.get(i) + h * (A3[0] * k1.get(i) + A3[1] * k2.get(i))));
        let k4 =
            flow(t + C[2] * h, &x.with(|i| x.get(i) + h * (A4[0] * k1.get(i) + A4[1] * k2.get(i) + A4[2] * k3.get(i))));
        let k5 = flow(
            t + C[3] * h,
            &x.with(|i| x.get(i) + h * (A5[0] * k1.get(i) + A5[1] * k2.get(i) + A5[2] * k3.get(i) + A5[3] * k4.get(i))),
        );
        let k6 = flow(
            t + h,
            &x.with(|i| {
                let early = A6[0] * k1.get(i) + A6[1] * k2.get(i) + A6[2] * k3.get(i);
                x.get(i) + h * (early + A6[3] * k4.get(i) + A6[4] * k5.get(i))
            }),
        );
        let end = x.with(|i| {
            let early = B[0] * k1.get(i) + B[1] * k2.get(i) + B[2] * k3.get(i);
            x.get(i) + h * (early + B[3] * k4.get(i) + B[4] * k5.get(i) + B[5] * k6.get(i))
        });
        let k7 = flow(t + h, &end);
        let stages = [k1, k2, k3, k4, k5, k6, k7];
        let error = x.with(|i| h * E.iter().zip(&stages).map(|(e, k)| e * k.get(i)).sum::<f64>());
        Trial { end, slope: k7, error, stages }
    }

    #[inline]
    fn dense<S: State>(&self, x: &S, h: f64, trial: &Trial<S, [S; 7]>) -> [S; 5] {
        let power = |p: usize| x.with(|i| h * D.iter().zip(&trial.stages).map(|(d, k)| d[p] * k.get(i)).sum::<f64>());
        [*x, power(0), power(1), power(2), power(3)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::horner;

    /// x' = x cos t, x(0) = 1, so x = exp(sin t).
    fn error_after(h: f64) -> (f64, f64) {
        let mut flow = |t: f64, x: &f64| x * t.cos();
        let (mut t, mut x) = (0.0, 1.0_f64);
        let mut inside = 0.0_f64;
        while t < 1.0 - 1e-9 {
            let slope = flow(t, &x);
            let trial = Tsit5.trial(&mut flow, t, &x, &slope, h);
            let dense = Tsit5.dense(&x, h, &trial);
            for theta in [0.3, 0.5, 0.8] {
                inside = inside.max((horner(&dense, theta) - (t + theta * h).sin().exp()).abs());
            }
            assert!((horner(&dense, 1.0) - trial.end).abs() < 1e-14);
            (t, x) = (t + h, trial.end);
        }
        ((x - 1.0_f64.sin().exp()).abs(), inside)
    }

    #[test]
    fn the_orders_are_five_and_four() {
        let (coarse, fine) = (error_after(1.0 / 16.0), error_after(1.0 / 32.0));
        let order = (coarse.0 / fine.0).log2();
        let order_inside = (coarse.1 / fine.1).log2();
        assert!((4.7..5.6).contains(&order), "{order}");
        assert!(order_inside > 3.8, "{order_inside}");
        assert!(fine.0 < 1e-9 && fine.1 < 1e-8, "{fine:?}");
    }

    #[test]
    fn rows_are_consistent() {
        for (row, c) in [(&A3[..], C[1]), (&A4, C[2]), (&A5, C[3]), (&A6, 1.0), (&B, 1.0)] {
            assert!((row.iter().sum::<f64>() - c).abs() < 1e-14);
        }
        assert!(E.iter().sum::<f64>().abs() < 1e-15);
        for (d, b) in D.iter().zip(B) {
            assert!((d.iter().sum::<f64>() - b).abs() < 1e-14);
        }
    }
}
