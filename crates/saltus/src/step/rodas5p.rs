//! `Rodas5P`: L-stable, order 5(4), one Jacobian and ten linear solves a step, dense output of
//! order 4.

use super::system::{Dense, Room, Sparse, System};
use super::{Stepper, Trial, closing, moved, weighted};
use crate::sparsity::Sparsity;
use crate::state::State;
use crate::time::resolution;

/// The Rosenbrock–Wanner method of order 5(4) by Steinebach: the stepper for stiff flows.
///
/// Eight stages, each a linear system with the matrix 1 - h γ J and γ = 0.2119; no iteration, so
/// nothing that can fail to converge. Stiffly accurate, with the stability function R(z) =
/// P(z)/(1 - γ z)⁸ of a polynomial P of degree at most 7:
/// |R(z)| ≤ 1 for Re z ≤ 0 and R(∞) = 0 (L-stable). On the problem of Prothero and Robinson its error is O(h⁴) however stiff that is.
/// The error estimate has order 4, and counts what the dense output is off by half way where the
/// flow is stiff; order 4 has the dense output too, which is continuous, with its first
/// derivative where the flow is not stiff.
///
/// Use it where a flow is *stiff*: where it forces nearby solutions together on a time scale far
/// below that of the solution itself (a hard contact, a fast reaction, a relaxation oscillator), so
/// that an explicit stepper takes many short steps however loose the tolerance. Where nothing is
/// stiff, [`Tsit5`](super::Tsit5) costs less.
///
/// The Jacobian J = ∂f/∂x comes from central differences of the flow, 2 n evaluations for n
/// coordinates (or two for each colour of its pattern, see [`Sparsity`]), and ∂f/∂t from one
/// evaluation if it is zero and from two otherwise. They probe the flow within 1e-5 of the scale of
/// each coordinate, |x| or |h f|, or of what f changes by over a step where both are below a
/// millionth of the largest; where it is undefined on one side, the other side serves. Their
/// rounding shows in the work, not in the result: below a relative tolerance of about 1e-10 the
/// steps shrink faster than the order would have it.
///
/// Up to 16 coordinates nothing is allocated; more cost a few allocations per trial, which is
/// little beside their n³, or beside the n of a band.
///
/// Source: G. Steinebach, *Construction of Rosenbrock–Wanner method `Rodas5P` and numerical
/// benchmarks within the Julia Differential Equations package*, BIT Numerical Mathematics 63 (2023)
/// 27, doi:10.1007/s10543-023-00967-x. In the form without matrix-vector products of E. Hairer, G.
/// Wanner, *Solving Ordinary Differential Equations II*, 2nd edition, Springer 1996, IV.7.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rodas5P;

const GAMMA: f64 = 0.211_937_563_194_290_14;
/// The times of stages 2 to 5; those of 6 to 8 are at the end.
const C: [f64; 4] =
    [0.635_812_689_582_870_4, 0.409_579_839_339_753_5, 0.976_930_672_506_071_6, 0.428_840_360_955_866_4];
/// The weights of ∂f/∂t in stages 1 to 5; the others have none.
const D: [f64; 5] =
    [GAMMA, -0.423_875_126_388_580_27, -0.338_462_712_623_592_4, 1.804_645_287_288_273_4, 2.325_825_639_765_069];
const A2: [f64; 1] = [3.0];
const A3: [f64; 2] = [2.849_394_379_747_939, 0.458_422_422_044_639_23];
const A4: [f64; 3] = [-6.954_028_509_809_101, 2.489_845_061_869_568, -10.358_996_098_473_584];
const A5: [f64; 4] =
    [2.802_998_627_562_896_4, 0.507_246_473_622_820_6, -0.398_831_254_177_052_4, -0.047_211_872_304_046_41];
const A6: [f64; 5] = [
    -7.502_846_399_306_121,
    2.561_846_144_803_919,
    -11.627_539_656_261_098,
    -0.182_687_676_599_422_56,
    0.030_198_172_008_377_946,
];
const G2: [f64; 1] = [-14.155_112_264_123_755];
const G3: [f64; 2] = [-17.972_960_358_859_52, -2.859_693_295_451_294];
const G4: [f64; 3] = [147.121_502_757_117_16, -1.412_214_027_182_13, 71.689_402_513_023_58];
const G5: [f64; 4] = [165.435_170_248_716_76, -0.459_282_345_649_112_6, 42.909_383_369_586_03, -5.961_986_721_573_306];
const G6: [f64; 5] = [
    24.854_864_614_690_072,
    -3.000_922_700_283_218_6,
    47.493_111_002_076_8,
    5.581_419_782_155_812_5,
    -0.661_069_182_524_947_1,
];
const G7: [f64; 6] = [
    30.912_732_140_285_99,
    -3.120_824_334_993_797_4,
    77.799_546_460_708_92,
    34.286_460_282_947_83,
    -19.097_331_116_725_623,
    -28.087_943_162_872_662,
];
const G8: [f64; 7] = [
    37.802_771_233_905_63,
    -3.257_196_902_907_227_6,
    112.269_188_494_963_27,
    66.934_723_124_404_7,
    -40.066_189_370_910_02,
    -54.667_802_628_779_68,
    -9.488_616_523_096_27,
];
/// The weights of the stages in the three terms of the dense output.
const H: [[f64; 8]; 3] = [
    [
        25.948_786_856_663_858,
        -2.557_972_484_584_623_5,
        10.433_815_404_888_879,
        -2.367_925_102_268_520_4,
        0.524_948_541_321_073,
        1.124_108_831_045_040_4,
        0.427_287_619_443_187_4,
        -0.172_022_210_701_554_93,
    ],
    [
        -9.915_688_506_951_71,
        -0.968_994_459_411_515_4,
        3.043_803_724_297_845_3,
        -24.495_224_566_215_796,
        20.176_138_334_709_044,
        15.980_663_614_246_51,
        -6.789_040_303_419_874,
        -6.710_236_069_923_372,
    ],
    [
        11.419_903_575_922_262,
        2.887_964_514_613_699_4,
        72.921_379_959_960_29,
        80.125_118_346_226_43,
        -52.072_871_366_152_654,
        -59.789_936_252_667_29,
        -0.155_826_842_827_519_13,
        4.883_087_185_713_722,
    ],
];

/// Half way, what the stages add to the mean of both ends, and to the slope between them.
const HALF_WAY: [[f64; 8]; 2] = half_way();

const fn half_way() -> [[f64; 8]; 2] {
    let mut rows = [[0.0; 8]; 2];
    let mut k = 0;
    while k < 8 {
        rows[0][k] = 0.25 * (H[0][k] + 0.5 * (H[1][k] + 0.5 * H[2][k]));
        rows[1][k] = 0.25 * (H[1][k] + H[2][k]);
        k += 1;
    }
    rows
}

impl Stepper for Rodas5P {
    /// The stages, the slope at the start, and how far the dense output is off half way.
    type Stages<S: State> = ([S; 8], S, S);
    type Dense<S: State> = [S; 5];

    fn jacobians(&self) -> u64 {
        1
    }

    fn predictive(&self) -> bool {
        true
    }

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
    ) -> Trial<S, ([S; 8], S, S)> {
        self.sparse(flow, t, x, slope, (h, None))
    }

    #[inline]
    fn sparse<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        (h, sparsity): (f64, Option<&Sparsity>),
    ) -> Trial<S, ([S; 8], S, S)> {
        let (mut few, mut some, mut many);
        let mut system = match x.len() {
            n @ 0..=4 => {
                few = Room::<4>::new();
                System::Dense(few.first(n))
            }
            n @ 5..=16 => {
                some = Room::<16>::new();
                System::Dense(some.first(n))
            }
            n => match sparsity {
                Some(sparsity) => System::Sparse(Sparse::of(sparsity)),
                None => {
                    many = (vec![0.0; n * n], vec![0.0; n], vec![0; n]);
                    System::Dense(Dense { matrix: &mut many.0, work: &mut many.1, order: &mut many.2 })
                }
            },
        };
        system.fill(flow, t, x, slope, (h, GAMMA));
        let drift = time_derivative(flow, t, x, slope, h);
        let forced = |f: S, d: f64| f.with(|i| h * GAMMA * (f.get(i) + h * d * drift.get(i)));

        let u1 = system.solve(&forced(slope.clone(), D[0]));
        let f = flow(t + C[0] * h, &moved(x, 1.0, &A2, [&u1]));
        let u2 = system.solve(&moved(&forced(f, D[1]), GAMMA, &G2, [&u1]));
        let f = flow(t + C[1] * h, &moved(x, 1.0, &A3, [&u1, &u2]));
        let u3 = system.solve(&moved(&forced(f, D[2]), GAMMA, &G3, [&u1, &u2]));
        let f = flow(t + C[2] * h, &moved(x, 1.0, &A4, [&u1, &u2, &u3]));
        let u4 = system.solve(&moved(&forced(f, D[3]), GAMMA, &G4, [&u1, &u2, &u3]));
        let f = flow(t + C[3] * h, &moved(x, 1.0, &A5, [&u1, &u2, &u3, &u4]));
        let u5 = system.solve(&moved(&forced(f, D[4]), GAMMA, &G5, [&u1, &u2, &u3, &u4]));
        // From here on each stage is a solution at the end of the step, and the next one its
        // correction.
        let x6 = moved(x, 1.0, &A6, [&u1, &u2, &u3, &u4, &u5]);
        let f = flow(t + h, &x6);
        let u6 = system.solve(&moved(&forced(f, 0.0), GAMMA, &G6, [&u1, &u2, &u3, &u4, &u5]));
        let x7 = x6.with(|i| x6.get(i) + u6.get(i));
        let f = flow(t + h, &x7);
        let u7 = system.solve(&moved(&forced(f, 0.0), GAMMA, &G7, [&u1, &u2, &u3, &u4, &u5, &u6]));
        let x8 = x7.with(|i| x7.get(i) + u7.get(i));
        let f = flow(t + h, &x8);
        let u8 = system.solve(&moved(&forced(f, 0.0), GAMMA, &G8, [&u1, &u2, &u3, &u4, &u5, &u6, &u7]));
        let end = x8.with(|i| x8.get(i) + u8.get(i));
        let u = [u1, u2, u3, u4, u5, u6, u7, u8];
        let off = off_half_way(&mut system, flow, (t, h), (x, &end), &u);
        Trial { slope: flow(t + h, &end), end, stages: (u, slope.clone(), off) }
    }

    #[inline]
    fn error<S: State>(&self, _: f64, trial: Trial<&S, &([S; 8], S, S)>, square: impl Fn(&S) -> f64) -> f64 {
        let (end, half_way) = (square(&trial.stages.0[7]), square(&trial.stages.2));
        if half_way > end { half_way } else { end }
    }

    #[inline]
    fn dense<S: State>(
        &self,
        _: &mut impl FnMut(f64, &S) -> S,
        _: f64,
        x: &S,
        h: f64,
        trial: Trial<&S, &([S; 8], S, S)>,
    ) -> [S; 5] {
        // (1-θ) x + θ (end + (1-θ)(b₀ + θ (b₁ + θ b₂))), multiplied out.
        let (u, slope) = (trial.stages.0.each_ref(), &trial.stages.1);
        let [b0, b1, b2] = inner(x, u);
        // Where the slope at the start agrees with that of the flow to within the error estimate or
        // rounding, it becomes the flow's, by a multiple of θ (1-θ)³: an arc that ends in a small
        // part of the step sees nothing else. Where the flow is stiff the two do not agree, and
        // must not.
        let bend = x.with(|i| {
            let own = (trial.end.get(i) - x.get(i)) + b0.get(i);
            let rounding: f64 = H[0].iter().zip(u).map(|(b, u)| (b * u.get(i)).abs()).sum::<f64>() * 1e-14;
            let bend = h * slope.get(i) - own;
            if bend.abs() <= 16.0 * u[7].get(i).abs() + rounding { bend } else { 0.0 }
        });
        let c1 =
            x.with(|i| if bend.get(i) == 0.0 { (trial.end.get(i) - x.get(i)) + b0.get(i) } else { h * slope.get(i) });
        let higher = [x.with(|i| b2.get(i) - b1.get(i) + 3.0 * bend.get(i)), x.with(|i| -b2.get(i) - bend.get(i))];
        let c2 = closing(x, trial.end, &c1, &higher);
        let [c3, c4] = higher;
        [x.clone(), c1, c2, c3, c4]
    }
}

/// The b₀, b₁, b₂ of the dense output.
#[inline]
fn inner<S: State>(x: &S, u: [&S; 8]) -> [S; 3] {
    [of_stages(x, u, &H[0]), of_stages(x, u, &H[1]), of_stages(x, u, &H[2])]
}

/// The stages, weighted.
#[inline]
fn of_stages<S: State>(x: &S, u: [&S; 8], weights: &[f64; 8]) -> S {
    x.with(|i| weighted(weights, u, i))
}

/// How far the dense output is off half way in the directions in which the flow is stiff.
///
/// There the ends of a step, and with them the error estimate, lie on the slow solution however
/// long the step is. Between them it is off by e, from which the flow, less the slope of the dense
/// output, differs by J e. Of that (1 - hγJ)⁻¹ hγ makes e where hγJ is large; what else there is of
/// it, where it is not, is taken off by once more (1 - hγJ)⁻¹.
#[inline]
fn off_half_way<S: State>(
    system: &mut System<'_>,
    flow: &mut impl FnMut(f64, &S) -> S,
    (t, h): (f64, f64),
    (x, end): (&S, &S),
    u: &[S; 8],
) -> S {
    let (bent, turned) = (of_stages(x, u.each_ref(), &HALF_WAY[0]), of_stages(x, u.each_ref(), &HALF_WAY[1]));
    let f = flow(t + 0.5 * h, &x.with(|i| 0.5 * (x.get(i) + end.get(i)) + bent.get(i)));
    let slope = |i: usize| end.get(i) - x.get(i) + turned.get(i);
    let off = system.solve(&x.with(|i| GAMMA * (h * f.get(i) - slope(i))));
    let slow = system.solve(&off);
    x.with(|i| off.get(i) - slow.get(i))
}

/// ∂f/∂t by a difference of order 2 that looks only ahead, within the step.
#[inline]
fn time_derivative<S: State>(flow: &mut impl FnMut(f64, &S) -> S, t: f64, x: &S, slope: &S, h: f64) -> S {
    // Within the step, yet far enough for the resolution of time not to matter.
    let resolution = resolution(t) / h;
    let reach = if resolution <= 1e-12 { 1e-4 * h } else { h * resolution.cbrt() };
    // Where the step is shorter than the spacing of time, the next times there are.
    let near = (t + reach).max(t.next_up());
    let far = (t + 2.0 * reach).max(near.next_up());
    let f1 = flow(near, x);
    if (0..x.len()).all(|i| f1.get(i) == slope.get(i)) {
        return x.with(|_| 0.0); // the flow does not depend on time
    }
    let f2 = flow(far, x);
    let (a, b) = (near - t, far - t);
    x.with(|i| ((f1.get(i) - slope.get(i)) * (b / a) - (f2.get(i) - slope.get(i)) * (a / b)) / (b - a))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{error_order, errors_with, orders};
    use super::*;
    use crate::piece::horner;
    use crate::state::Coords;

    /// One step from `x` at `t`: its end, and its dense output half way.
    fn step<S: State>(mut flow: impl FnMut(f64, &S) -> S, t: f64, x: S, h: f64) -> (S, S) {
        let slope = flow(t, &x);
        let trial = Rodas5P.trial(&mut flow, t, &x, &slope, h);
        let dense = Rodas5P.dense(&mut flow, t, &x, h, trial.as_ref());
        (trial.end, horner(&dense, 0.5))
    }

    #[test]
    fn the_orders_are_five_and_four() {
        let (order, inside) = orders(Rodas5P, 1.0 / 8.0);
        assert!((4.7..5.8).contains(&order), "{order}");
        assert!(inside > 3.8, "{inside}");
        let (at_ends, inside) = errors_with(Rodas5P, 1.0 / 32.0);
        assert!(at_ends < 1e-9 && inside < 1e-8, "{at_ends:e} {inside:e}");
        let estimate = error_order(Rodas5P, 1.0 / 8.0);
        assert!((Rodas5P.error_order() - estimate).abs() < 0.4, "{estimate}");
    }

    #[test]
    fn it_is_l_stable() {
        for exponent in -20..=40 {
            let y = 10.0_f64.powf(0.2 * f64::from(exponent));
            let (end, _) = step(|_, x: &[f64; 2]| [-y * x[1], y * x[0]], 0.0, [1.0, 0.0], 1.0);
            let modulus = end[0].hypot(end[1]);
            assert!(modulus <= 1.0 + 1e-10, "|R({y}i)| = {modulus}");
            let (end, half) = step(|_, x: &f64| -y * x, 0.0, 1.0, 1.0);
            assert!(end.abs() <= 1.0 && half.abs() <= 1.5, "R(-{y}) = {end}, half way {half}");
        }
        let (end, _) = step(|_, x: &f64| -1e9 * x, 0.0, 1.0, 1.0);
        assert!(end.abs() < 1e-7, "R(-1e9) = {end}");
    }

    /// A. Prothero, A. Robinson, Math. Comp. 28 (1974) 145: x' = λ (x - sin t) + cos t, however
    /// large -λ is.
    #[test]
    fn stiffness_does_not_take_the_order_away() {
        for lambda in [-1e2, -1e4, -1e6] {
            let errors = [1.0 / 4.0, 1.0 / 8.0, 1.0 / 16.0].map(|h| {
                let (mut t, mut x, mut inside) = (0.0_f64, 0.0_f64, 0.0_f64);
                while t < 2.0 - 1e-9 {
                    let half;
                    (x, half) = step(|t: f64, x: &f64| lambda * (x - t.sin()) + t.cos(), t, x, h);
                    inside = inside.max((half - (t + 0.5 * h).sin()).abs());
                    t += h;
                }
                ((x - t.sin()).abs(), inside)
            });
            for ((error, inside), h) in errors.into_iter().zip([4.0, 8.0, 16.0].map(f64::recip)) {
                assert!(error < 3e-4 * h.powi(4), "λ = {lambda:e}, h = {h}: {error:e}");
                assert!(inside < 6e-4 * h.powi(4), "λ = {lambda:e}, h = {h}: {inside:e} inside the steps");
            }
        }
    }

    #[test]
    fn any_number_of_coordinates_will_do() {
        fn decays<S: State>(x: S) {
            // Each coordinate follows the next, from very fast to slow; the last decays alone.
            let rate = |i: usize| 10.0_f64.powi(6 - 2 * (i as i32 % 5));
            let flow = |_: f64, x: &S| {
                x.with(|i| if i + 1 < x.len() { rate(i) * (x.get(i + 1) - x.get(i)) } else { -x.get(i) })
            };
            let n = x.len();
            let (end, _) = step(flow, 0.0, x.clone(), 0.01);
            let last = x.get(n - 1) * (-0.01_f64).exp();
            assert!((end.get(n - 1) - last).abs() < 1e-12, "{n}: {end:?}");
            assert!(end.is_finite());
            if n > 1 {
                // The fast first coordinate has reached its neighbour.
                assert!((end.get(0) - end.get(1)).abs() < 2e-2, "{n}: {end:?}");
            }
        }
        decays(1.0);
        decays([1.0; 2]);
        decays(Coords::<16>::from([1.0, 2.0, 3.0]));
        decays(Coords::<16>::from([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        decays([1.0; 16]);
        decays([1.0; 20]);
    }

    #[test]
    fn rows_are_interchanged_where_a_pivot_is_small() {
        let mut room = Room::<4>::new();
        let mut system = room.first(3);
        let matrix = [[0.0, 1.0, 2.0], [1e-20, 1.0, 1.0], [-1.0, 1.0, 0.0]];
        system.matrix.copy_from_slice(matrix.as_flattened());
        system.factor();
        let planted = [3.0, -2.0, 0.5];
        let right = matrix.map(|row: [f64; 3]| row.iter().zip(planted).map(|(a, x)| a * x).sum::<f64>());
        let found = system.solve(&right);
        for (found, planted) in found.into_iter().zip(planted) {
            assert!((found - planted).abs() < 1e-15, "{found}");
        }
    }

    #[test]
    fn a_flow_may_be_undefined_on_one_side() {
        // A tank that fills another, while a third has run dry: below, its square root is not
        // defined.
        let (end, _) = step(|_, x: &[f64; 3]| [-x[0].sqrt(), x[0].sqrt(), -x[2].sqrt()], 0.0, [1.0, 0.5, 0.0], 0.1);
        assert!((end[0] - 0.95_f64.powi(2)).abs() < 1e-7, "{end:?}");
        assert!((end[0] + end[1] - 1.5).abs() < 1e-12 && end[2] == 0.0, "{end:?}");
    }

    /// A step below the spacing of time, wherever between its powers of two, takes the flow for
    /// what it is at its start.
    #[test]
    fn steps_shorter_than_the_spacing_of_time() {
        for power in -30..300 {
            for t in [1.0, 1.0_f64.next_up(), 1.3, 2.0_f64.next_down()].map(|t| t * 2.0_f64.powi(power)) {
                for t in [t, -t] {
                    for part in [1e-20, 1e-6, 0.1, 0.3, 0.6, 1.0, 2.0] {
                        let h = part * resolution(t);
                        let (end, _) = step(|s: f64, x: &f64| (s - t) / t - x + 1.0, t, 0.0, h);
                        assert!((end - h).abs() <= 1e-9 * h + h * h, "{end:e} after {h:e} from {t:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn time_derivatives_hold_late_in_a_run() {
        let t = 1e6_f64;
        let (end, _) = step(|t: f64, x: &f64| -1e3 * (x - t.sin()) + t.cos(), t, t.sin(), 1e-2);
        assert!((end - (t + 1e-2).sin()).abs() < 1e-9, "{:e}", end - (t + 1e-2).sin());
    }
}
