//! Dop853: order 8(5, 3), twelve flow evaluations a step, dense output of order 7.

use super::{Differences, Stepper, Trial, closing, difference, weighted};
use crate::state::State;

/// The explicit Runge–Kutta method of order 8 by Dormand and Prince with the error estimate and the
/// dense output of Hairer and Wanner.
///
/// Twelve flow evaluations a step (the thirteenth is the first of the next step) and three more for
/// the dense output of an accepted one, which has order 7 and is continuous with its first
/// derivative. The error estimate joins those of embedded solutions of order 5 and 3, e = e₅² /
/// √(e₅² + e₃² / 100), and shrinks as h⁸.
///
/// Use it for smooth flows that are not stiff wherever accuracy is worth having, from a relative
/// tolerance of about 1e-7 down: on the Arenstorf orbit it needs half the evaluations of
/// [`Tsit5`](super::Tsit5) for an error of 1e-6 and a quarter of them for 1e-9. Its steps are long,
/// so arcs that end by a jump after a step or two gain less. A flow with a kink inside an arc takes
/// its order away.
///
/// Source: E. Hairer, S. P. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*, 2nd
/// edition, Springer 1993, II.5 (the method, p. 181), II.6 (the dense output, p. 191) and the
/// appendix (the program DOP853), doi:10.1007/978-3-540-78862-1; P. J. Prince, J. R. Dormand, *High
/// order embedded Runge–Kutta formulae*, J. Comput. Appl. Math. 7 (1981) 67–75,
/// doi:10.1016/0771-050X(81)90010-3.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dop853;

/// The times of stages 2 to 11; the twelfth is at the end.
const C: [f64; 10] = [
    0.052_600_151_958_767_73,
    0.078_900_227_938_151_6,
    0.118_350_341_907_227_4,
    0.281_649_658_092_772_6,
    1.0 / 3.0,
    0.25,
    4.0 / 13.0,
    0.651_282_051_282_051_3,
    0.6,
    6.0 / 7.0,
];
const A3: [f64; 1] = [0.059_175_170_953_613_7];
const A4: [f64; 1] = [0.088_762_756_430_420_54];
const A5: [f64; 2] = [-0.884_549_479_328_286_1, 0.924_834_003_261_792];
const A6: [f64; 2] = [0.170_828_608_729_473_86, 0.125_467_687_566_822_42];
const A7: [f64; 3] = [0.170_252_211_019_544_05, 0.060_216_538_980_455_96, -0.017_578_125];
const A8: [f64; 4] =
    [0.170_383_925_712_239_98, 0.107_262_030_446_373_28, -0.015_319_437_748_624_402, 0.008_273_789_163_814_023];
const A9: [f64; 5] = [
    -3.360_892_629_446_941_4,
    -0.868_219_346_841_726,
    27.592_099_699_446_71,
    20.154_067_550_477_894,
    -43.489_884_181_069_96,
];
const A10: [f64; 6] = [
    -2.488_114_619_971_667_7,
    -0.590_290_826_836_843,
    21.230_051_448_181_193,
    15.279_233_632_882_423,
    -33.288_210_968_984_86,
    -0.020_331_201_708_508_627,
];
const A11: [f64; 7] = [
    5.186_372_428_844_064,
    1.091_437_348_996_729_5,
    -8.149_787_010_746_927,
    -18.520_065_659_996_96,
    22.739_487_099_350_505,
    2.493_605_552_679_652_3,
    -3.046_764_471_898_219_6,
];
const A12: [f64; 8] = [
    -10.534_495_466_737_25,
    -2.000_872_058_224_862_5,
    -17.958_931_863_118_8,
    27.948_884_529_419_96,
    -2.858_998_277_135_023_5,
    -8.872_856_933_530_63,
    12.360_567_175_794_303,
    0.643_392_746_015_763_6,
];
/// The weights of the solution, for the stages kept (1 and 6 to 12).
const B: [f64; 7] = [
    4.450_312_892_752_409,
    1.891_517_899_314_500_3,
    -5.801_203_960_010_585,
    0.311_164_366_957_819_9,
    -0.152_160_949_662_516_1,
    0.201_365_400_804_030_34,
    0.044_710_615_727_772_59,
];
/// Weights of the solution less those of the embedded one of order 5, and less those of the one of
/// order 3.
const E5: [f64; 7] = [
    -1.225_156_446_376_204_4,
    -0.495_758_949_657_250_2,
    1.664_377_182_454_986_4,
    -0.350_328_848_749_973_66,
    0.334_179_118_713_017_5,
    0.081_923_206_485_115_71,
    -0.022_355_307_863_886_294,
];
const E3: [f64; 7] = [
    4.450_312_892_752_409,
    1.891_517_899_314_500_3,
    -5.801_203_960_010_585,
    -0.422_682_321_323_791_97,
    -0.152_160_949_662_516_1,
    0.201_365_400_804_030_34,
    0.022_651_792_198_360_825,
];
/// The times of the three stages of the dense output, which are the fourteenth to the sixteenth.
const CD: [f64; 3] = [0.1, 0.2, 7.0 / 9.0];
const A14: [f64; 7] = [
    0.253_500_210_216_624_83,
    -0.246_239_037_470_802_5,
    -0.124_191_423_263_816_37,
    0.153_291_798_278_765_68,
    0.008_201_052_295_634_69,
    0.007_567_897_660_545_699,
    -0.008_298,
];
const A15: [f64; 7] = [
    0.028_300_909_672_366_776,
    0.053_541_988_307_438_566,
    -0.054_923_748_571_390_99,
    -0.000_108_347_328_697_249_32,
    0.000_382_571_090_835_658_4,
    -0.000_340_465_008_687_404_56,
    0.141_312_443_674_632_5,
];
const A16: [f64; 7] = [
    -4.697_621_415_361_164,
    7.683_421_196_062_599,
    4.068_989_818_397_11,
    0.356_727_187_455_281_1,
    -0.001_399_024_165_159_014_5,
    2.947_514_789_152_772_4,
    -9.150_958_472_179_87,
];
/// The weights, in the last four terms of the dense output, of the stages kept, the slope at the
/// end and the three stages above.
const D: [[f64; 11]; 4] = [
    [
        0.566_714_953_519_377_7,
        -3.068_949_945_949_891_7,
        2.384_667_656_512_07,
        2.117_034_582_445_028,
        -0.871_391_583_777_973,
        2.240_437_430_260_788_3,
        0.631_578_778_769_468_8,
        -0.088_990_336_451_333_31,
        18.148_505_520_854_727,
        -9.194_632_392_478_356,
        -4.436_036_387_594_894,
    ],
    [
        242.283_491_775_258_17,
        165.200_451_717_270_28,
        -374.546_754_722_690_2,
        -22.113_666_853_125_306,
        7.733_432_668_472_264,
        -30.674_084_731_089_398,
        -9.332_130_526_430_229,
        15.697_238_121_770_845,
        -31.139_403_219_565_178,
        -9.352_924_358_844_48,
        35.816_841_486_394_08,
    ],
    [
        -387.037_308_749_351_8,
        -189.178_138_195_167_58,
        527.808_159_205_423_6,
        -11.573_902_539_959_63,
        6.881_232_694_696_3,
        -1.000_605_096_691_083_8,
        0.777_713_779_805_344_3,
        -2.778_205_752_353_508,
        -60.196_695_231_264_12,
        84.320_405_506_677_16,
        11.992_291_136_182_79,
    ],
    [
        -154.189_748_690_236_43,
        -231.529_379_176_045_5,
        357.639_117_910_614_1,
        93.405_324_183_624_32,
        -37.458_323_136_451_63,
        104.099_649_508_962_3,
        29.840_293_426_660_5,
        -43.533_456_590_011_14,
        96.324_553_959_188_28,
        -39.177_261_675_615_44,
        -149.726_836_257_985_64,
    ],
];

impl Stepper for Dop853 {
    /// k₁, and k₆ - k₁ to k₁₂ - k₁; the others serve only to reach these.
    type Stages<S: State> = [S; 8];
    type Dense<S: State> = [S; 8];

    fn predictive(&self) -> bool {
        true
    }

    #[inline]
    fn error_order(&self) -> f64 {
        8.0
    }

    #[inline]
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, [S; 8]> {
        let mut stages = Differences { flow, t, x, slope, h };
        let d2 = stages.next(C[0], &[], []);
        let d3 = stages.next(C[1], &A3, [&d2]);
        let d4 = stages.next(C[2], &A4, [&d3]);
        let d5 = stages.next(C[3], &A5, [&d3, &d4]);
        let d6 = stages.next(C[4], &A6, [&d4, &d5]);
        let d7 = stages.next(C[5], &A7, [&d4, &d5, &d6]);
        let d8 = stages.next(C[6], &A8, [&d4, &d5, &d6, &d7]);
        let d9 = stages.next(C[7], &A9, [&d4, &d5, &d6, &d7, &d8]);
        let d10 = stages.next(C[8], &A10, [&d4, &d5, &d6, &d7, &d8, &d9]);
        let d11 = stages.next(C[9], &A11, [&d4, &d5, &d6, &d7, &d8, &d9, &d10]);
        let d12 = stages.next(1.0, &A12, [&d4, &d5, &d6, &d7, &d8, &d9, &d10, &d11]);
        let end = stages.state(1.0, &B, [&d6, &d7, &d8, &d9, &d10, &d11, &d12]);
        Trial { slope: flow(t + h, &end), end, stages: [slope.clone(), d6, d7, d8, d9, d10, d11, d12] }
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &[S; 8]>, square: impl Fn(&S) -> f64) -> f64 {
        let [_, d @ ..] = trial.stages.each_ref();
        let fifth = square(&trial.end.with(|i| h * weighted(&E5, d, i)));
        let third = square(&trial.end.with(|i| h * weighted(&E3, d, i)));
        if fifth == 0.0 { 0.0 } else { fifth * (fifth / (fifth + 0.01 * third)) }
    }

    #[inline]
    fn dense<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        h: f64,
        trial: Trial<&S, &[S; 8]>,
    ) -> [S; 8] {
        let Trial { end, slope, stages: [k1, d6, d7, d8, d9, d10, d11, d12] } = trial;
        let d13 = &difference(slope, k1);
        let mut stages = Differences { flow, t, x, slope: k1, h };
        let d14 = &stages.next(CD[0], &A14, [d7, d8, d9, d10, d11, d12, d13]);
        let d15 = &stages.next(CD[1], &A15, [d6, d7, d8, d11, d12, d13, d14]);
        let d16 = &stages.next(CD[2], &A16, [d6, d7, d8, d9, d13, d14, d15]);
        let all = [d6, d7, d8, d9, d10, d11, d12, d13, d14, d15, d16];
        // x + θ(f₀ + (1-θ)(f₁ + θ(f₂ + (1-θ)(f₃ + θ(f₄ + (1-θ)(f₅ + θ f₆)))))), multiplied out.
        let f = |d: &[f64; 11]| x.with(|i| h * weighted(d, all, i));
        let (f3, f4, f5, f6) = (f(&D[0]), f(&D[1]), f(&D[2]), f(&D[3]));
        // The coefficient of θ² is then f₂ + f₃ - f₁, but is taken from what is left of the step.
        let c1 = x.with(|i| h * k1.get(i));
        let f1 = |i| c1.get(i) - (end.get(i) - x.get(i));
        let f2 = |i| (end.get(i) - x.get(i)) - h * slope.get(i) - f1(i);
        let higher = [
            x.with(|i| f4.get(i) + f5.get(i) - 2.0 * f3.get(i) - f2(i)),
            x.with(|i| f6.get(i) - 3.0 * f5.get(i) - 2.0 * f4.get(i) + f3.get(i)),
            x.with(|i| 3.0 * (f5.get(i) - f6.get(i)) + f4.get(i)),
            x.with(|i| 3.0 * f6.get(i) - f5.get(i)),
            x.with(|i| -f6.get(i)),
        ];
        let c2 = closing(x, end, &c1, &higher);
        let [c3, c4, c5, c6, c7] = higher;
        [x.clone(), c1, c2, c3, c4, c5, c6, c7]
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{error_order, errors_with, orders};
    use super::*;

    #[test]
    fn the_orders_are_eight_and_seven() {
        let (order, inside) = orders(Dop853, 0.25);
        assert!((7.6..8.4).contains(&order), "{order}");
        assert!(inside > 7.6, "{inside}");
        let (at_ends, inside) = errors_with(Dop853, 1.0 / 8.0);
        assert!(at_ends < 1e-12 && inside < 1e-10, "{at_ends:e} {inside:e}");
        let estimate = error_order(Dop853, 1.0);
        assert!((Dop853.error_order() - estimate).abs() < 0.6, "{estimate}");
    }

    #[test]
    fn rows_are_consistent() {
        // With what the source gives k₁ the rows add up to their times.
        let rows = [
            (&A3[..], 0.019_725_056_984_537_9, C[1]),
            (&A4, 0.029_587_585_476_806_85, C[2]),
            (&A5, 0.241_365_134_159_266_7, C[3]),
            (&A6, 0.037_037_037_037_037_035, C[4]),
            (&A7, 0.037_109_375, C[5]),
            (&A8, 0.037_092_000_118_504_79, C[6]),
            (&A9, 0.624_110_958_716_075_7, C[7]),
            (&A10, 0.477_662_536_438_264_34, C[8]),
            (&A11, -0.937_142_430_085_987_3, C[9]),
            (&A12, 2.273_310_147_516_538, 1.0),
            (&B, 0.054_293_734_116_568_765, 1.0),
            (&A14, 0.056_167_502_283_047_954, CD[0]),
            (&A15, 0.031_834_648_163_502_14, CD[1]),
            (&A16, -0.428_896_301_583_791_94, CD[2]),
            (&E5, 0.013_120_044_994_194_88, 0.0),
            (&E3, -0.189_800_754_072_407_62, 0.0),
            (&D[0], -8.428_938_276_109_013, 0.0),
            (&D[1], 10.427_508_642_579_134, 0.0),
            (&D[2], 19.985_053_242_002_433, 0.0),
            (&D[3], -25.693_933_462_703_75, 0.0),
        ];
        for (row, first, sum) in rows {
            assert!((row.iter().sum::<f64>() + first - sum).abs() < 1e-13, "{row:?}");
        }
        // Σ bₖ cₖⁿ = 1/(n+1) up to the seventh power.
        let c = [C[4], C[5], C[6], C[7], C[8], C[9], 1.0];
        for n in 1..8 {
            let sum: f64 = B.iter().zip(c).map(|(b, c)| b * c.powi(n)).sum();
            assert!((sum - 1.0 / f64::from(n + 1)).abs() < 1e-15, "{n}");
        }
    }

    #[test]
    fn the_dense_output_keeps_the_slopes_at_both_ends() {
        let mut flow = |t: f64, x: &[f64; 2]| [x[1], -x[0] + t.sin()];
        let (t, x, h) = (0.7, [1.0, -0.3], 0.4);
        let slope = flow(t, &x);
        let trial = Dop853.trial(&mut flow, t, &x, &slope, h);
        let dense = Dop853.dense(&mut flow, t, &x, h, trial.as_ref());
        for i in 0..2 {
            assert_eq!(dense[1][i], h * slope[i]);
            let at_end: f64 = (1..8).map(|k| f64::from(k as u32) * dense[k][i]).sum();
            assert!((at_end - h * trial.slope[i]).abs() < 1e-14);
        }
    }

    /// The driver `dr_dop853.f` that comes with the program: Van der Pol's equation with ε = 1e-3
    /// over `0..=2`, tolerances 1e-9. It reports 1348 steps accepted, 121 rejected and 21553
    /// evaluations. Two of them serve its start, where one is needed, and it spares the slope at
    /// the end of a rejected step.
    #[test]
    fn the_steps_are_those_of_the_reference_program() {
        let mut count = 0;
        let mut flow = |_: f64, x: &[f64; 2]| {
            count += 1;
            [x[1], ((1.0 - x[0] * x[0]) * x[1] - x[0]) / 1e-3]
        };
        let (mut t, mut x, mut h, end) = (0.0, [2.0, 0.0], 1e-6, 2.0);
        let (mut accepted, mut rejected, mut just_rejected) = (0, 0, false);
        let mut slope = flow(t, &x);
        loop {
            let last = t + 1.01 * h > end;
            if last {
                h = end - t;
            }
            let trial = Dop853.trial(&mut flow, t, &x, &slope, h);
            let square = |e: &[f64; 2]| {
                let part = |i: usize| (e[i] / (1e-9 + 1e-9 * x[i].abs().max(trial.end[i].abs()))).powi(2);
                0.5 * (part(0) + part(1))
            };
            let error = Dop853.error(h, trial.as_ref(), square);
            let factor = (error.powf(0.0625) / 0.9).clamp(1.0 / 6.0, 1.0 / 0.333);
            if error <= 1.0 {
                accepted += 1;
                let _ = Dop853.dense(&mut flow, t, &x, h, trial.as_ref());
                (t, x, slope) = (t + h, trial.end, trial.slope);
                if last {
                    break;
                }
                h = if just_rejected { h.min(h / factor) } else { h / factor };
                just_rejected = false;
            } else {
                h /= factor.min(1.0 / 0.333);
                rejected += 1;
                just_rejected = true;
            }
        }
        assert_eq!((accepted, rejected), (1348, 121));
        assert_eq!(count, 21553 - 1 + rejected);
        assert!((x[0] - 1.763_234_540_172_087).abs() < 1e-13);
        assert!((x[1] + 8.356_886_819_301_91e-1).abs() < 1e-12);
    }
}
