//! The derivatives are those of the residuals, the elimination is exact, and two ways to the same
//! COR meet.

use super::*;
use crate::evidence::Moment;
use crate::model::{Contacts, CorLaw, Flight, FlightTrial, Heights};

fn contacts(times: &[f64], sigma: f64) -> Contacts {
    let one = |(flights, &time): (usize, &f64)| Moment { flights, apex: false, time, sigma };
    Contacts {
        trials: vec![times.iter().enumerate().map(one).collect()],
        high: 1.0,
        trend: false,
        added_up: false,
        supposed: false,
    }
}

/// Compares filled derivatives with central differences of filled residuals.
fn derivatives_match(model: &impl Model, shared: &[f64], own: &[f64]) {
    let (m, q) = model.size(0);
    let n = shared.len();
    let filled = |shared: &[f64], own: &[f64]| {
        let mut rows = DMatrix::zeros(m, q + n + 1);
        model.fill(0, shared, own, &mut rows);
        rows
    };
    let here = filled(shared, own);
    for j in 0..q + n {
        let residual = |sign: f64| {
            let (mut shared, mut own) = (shared.to_vec(), own.to_vec());
            let x = if j < q { &mut own[j] } else { &mut shared[j - q] };
            *x += sign * 1e-6;
            filled(&shared, &own).column(q + n).into_owned()
        };
        let difference = (residual(-1.0) - residual(1.0)) / 2e-6;
        for i in 0..m {
            let (exact, numeric) = (here[(i, j)], difference[i]);
            assert!(
                (exact - numeric).abs() < 1e-6 * (1.0 + exact.abs() * 1e2),
                "row {i}, unknown {j}: {exact} {numeric}"
            );
        }
    }
}

#[test]
fn derivatives_are_those_of_the_residuals() {
    for trend in [false, true] {
        let shared = if trend { vec![-0.2, 0.003] } else { vec![-0.2] };
        for logarithms in [false, true] {
            let trials = vec![vec![(0, 1.0, 0.01), (1, 0.7, 0.02), (3, 0.3, 0.01)]];
            derivatives_match(
                &Heights { trials: trials.into(), high: 0.0, trend, logarithms, supposed: false },
                &shared,
                &[0.1],
            );
        }
        let mut model = Contacts { trend, ..contacts(&[0.1, 0.9, 1.5, 2.0], 0.1) };
        model.trials[0][2].apex = true;
        // Its trend is a test for one, from a fit without: it starts from zero.
        derivatives_match(&model, if trend { &[0.6, 0.0] } else { &[0.6] }, &[0.1, 0.8]);
    }
    let moment = |flights, apex, time| Moment { flights, apex, time, sigma: 0.1 };
    for release in [None, Some((1.0, None)), Some((1.0, Some(0.01)))] {
        for release_time in [None, Some(0.0)] {
            for (offset, lag) in [(false, false), (true, false), (false, true), (true, true)] {
                let trial = FlightTrial {
                    release,
                    release_time,
                    heights: vec![(1, 0.5, 0.1), (2, 0.3, 0.1)],
                    moments: vec![
                        moment(0, false, 0.4),
                        moment(0, true, 0.7),
                        moment(1, false, 1.0),
                        moment(3, true, 2.0),
                    ],
                };
                let (low, high, middle) = (0.7, 4.2, 2.1);
                for (law, unknowns, drag) in [
                    (CorLaw::Constant, vec![0.6], false),
                    (CorLaw::Each(2), vec![0.6, 0.5], false),
                    (CorLaw::Each(4), vec![0.6; 4], true),
                    (CorLaw::Linear { low, high }, vec![0.65, 0.55], false),
                    (CorLaw::Linear { low, high }, vec![0.65, 0.55], true),
                    (CorLaw::Viscoelastic { high }, vec![0.7], true),
                    (CorLaw::Plastic { middle }, vec![0.6], false),
                    (CorLaw::Power { middle }, vec![0.6, 0.2], false),
                    (CorLaw::Knots(vec![0.7, 1.3, 2.5, 4.2]), vec![0.8, 0.95, 0.9, 0.85], false),
                ] {
                    let (trials, zero) = (vec![trial.clone()], offset.then_some(Bounds { low: 0.0, high: 0.2 }));
                    // What is unknown beside the law does not depend on it: half of the cases are
                    // of contacts that last, and of rebounds read higher.
                    let (lasting, rebounds) = (drag.then_some(0.04), drag);
                    let of = Flight { trials, gravity: 9.8, law, offset: zero, lag, drag, ..Flight::default() };
                    let model = Flight { lasting, rebounds, ..of };
                    let mut shared = unknowns;
                    shared.extend(offset.then_some(0.05));
                    shared.extend(lag.then_some(0.02));
                    shared.extend(drag.then_some(0.15));
                    shared.extend(lasting.map(|_| 0.013));
                    let mut own = Vec::new();
                    own.extend((!matches!(release, Some((_, None)))).then_some(4.3));
                    own.extend(release_time.is_none().then_some(0.41));
                    assert_eq!(model.size(0).1, own.len());
                    derivatives_match(&model, &shared, &own);
                }
            }
        }
    }
}

#[test]
fn elimination_agrees_with_the_whole_problem() {
    // Three trials of one line each with a common slope: against the normal equations of all
    // unknowns at once.
    let trials = vec![
        vec![(0, 1.0, 0.01), (1, 0.62, 0.01), (2, 0.42, 0.02)],
        vec![(0, 0.8, 0.01), (1, 0.53, 0.01)],
        vec![(1, 0.66, 0.02), (2, 0.40, 0.01), (4, 0.17, 0.01)],
    ];
    let model = Heights { trials: trials.clone().into(), high: 0.0, trend: false, logarithms: true, supposed: false };
    let found = fit(&model, &[-0.3], vec![vec![0.0]; 3]).unwrap();
    let (mut normal, mut right) = (DMatrix::<f64>::zeros(4, 4), DVector::<f64>::zeros(4));
    for (j, trial) in trials.iter().enumerate() {
        for &(n, h, s) in trial {
            let w = h / s;
            let mut row = DVector::zeros(4);
            row[j] = w;
            row[3] = 2.0 * n as f64 * w;
            normal += &row * row.transpose();
            right += row * (w * f64::ln(h));
        }
    }
    let inverse = normal.try_inverse().unwrap();
    let whole = &inverse * right;
    assert!((found.shared[0] - whole[3]).abs() < 1e-14);
    assert!((0..3).all(|j| (found.own[j][0] - whole[j]).abs() < 1e-13));
    assert!((found.covariance[(0, 0)] / inverse[(3, 3)] - 1.0).abs() < 1e-12);
    assert_eq!(found.freedom, 4);
    // Leaving out a block, for good.
    for out in 0..3 {
        let rest: Vec<_> = trials.iter().enumerate().filter(|(j, _)| *j != out).map(|(_, t)| t.clone()).collect();
        let without = fit(&Heights { trials: rest.into(), ..model.clone() }, &[-0.3], vec![vec![0.0]; 2]).unwrap();
        assert!((without.shared[0] - found.shared[0] - found.influence[out]).abs() < 1e-13);
    }
}

/// The other way to the COR: logarithms of intervals, whitened by the Cholesky factor of their
/// covariance diag(1/Δ) tridiag(−1, 2, −1) diag(1/Δ) σ².
fn whitened_intervals(times: &[f64], sigma: f64) -> (f64, f64, f64) {
    let d: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let m = d.len();
    let covariance = DMatrix::from_fn(m, m, |i, j| {
        let c = if i == j {
            2.0
        } else if i.abs_diff(j) == 1 {
            -1.0
        } else {
            0.0
        };
        sigma * sigma * c / d[i] / d[j]
    });
    let factor = covariance.cholesky().unwrap().l();
    let x = factor.solve_lower_triangular(&DMatrix::from_fn(m, 2, |i, j| if j == 0 { 1.0 } else { i as f64 })).unwrap();
    let y = factor.solve_lower_triangular(&DVector::from_fn(m, |i, _| d[i].ln())).unwrap();
    let inverse = (x.transpose() * &x).try_inverse().unwrap();
    let line = &inverse * x.transpose() * &y;
    let e = line[1].exp();
    (e, e * inverse[(1, 1)].sqrt(), (y - x * line).norm_squared())
}

const SOUNDS: [f64; 12] = [0.587, 1.549, 2.403, 3.164, 3.845, 4.452, 5.002, 5.497, 5.93, 6.334, 6.687, 7.009];

#[test]
fn times_and_whitened_intervals_give_the_same() {
    let model = contacts(&SOUNDS, 0.005);
    let found = fit(&model, &[0.7], model.start(0.7)).unwrap();
    let (e, error, chi_square) = whitened_intervals(&SOUNDS, 0.005);
    assert!((found.shared[0] - e).abs() < 1e-4, "{} {e}", found.shared[0]);
    assert!((found.covariance[(0, 0)].sqrt() / error - 1.0).abs() < 0.02);
    assert!((found.chi_square - chi_square).abs() < 0.2, "{} {chi_square}", found.chi_square);
    assert_eq!(found.freedom, 9);
    assert!((found.chi_square - 10.1).abs() < 0.05, "{}", found.chi_square);
}

#[test]
fn the_start_does_not_matter() {
    for e in [0.05, 0.3, 0.7, 0.99, 1.0] {
        let model = contacts(&SOUNDS, 0.005);
        let found = fit(&model, &[e], model.start(e)).unwrap();
        assert!((found.shared[0] - 0.896_008).abs() < 1e-6, "from {e}: {}", found.shared[0]);
    }
}

/// `RᵀR` is `XᵀX`, over several panels; numbers too small to be squared spoil nothing.
#[test]
fn reflections_keep_the_normal_equations() {
    for tiny in [1.0, 1e-158, 1e-162, 0.0] {
        let entry = |i: usize, j: usize| ((7 * i + 13 * j * j) as f64).sin() * if j == 1 { tiny } else { 1.0 };
        let rows = DMatrix::from_fn(2 * PANEL + 3, 4, entry);
        let mut triangle = Triangle::new(4);
        triangle.reflect(&mut rows.clone());
        let r = DMatrix::from_row_slice(4, 4, &triangle.r);
        let apart = (r.tr_mul(&r) - rows.tr_mul(&rows)).abs().max();
        assert!(apart < 1e-10, "{tiny}: {apart}");
        assert!((0..4).all(|j| r[(j, j)] >= 0.0), "{tiny}: {r}");
    }
}
