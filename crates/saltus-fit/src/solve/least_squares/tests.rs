//! What the conic solver does not say by itself, each guarded.

use super::*;

fn bounds(low: f64, high: f64) -> Bounds {
    Bounds { low, high }
}

/// Eighteen bounces of a ball with e = 0.8, as rows of (1, 2n) against ln h.
fn ladder(weight: f64) -> (DMatrix<f64>, DVector<f64>) {
    let x = DMatrix::from_fn(18, 2, |i, j| weight * if j == 0 { 1.0 } else { 2.0 * i as f64 });
    let wobble = |i: usize| 0.01 * ((i * i * 7919 % 13) as f64 - 6.0);
    let y = DVector::from_fn(18, |i, _| weight * (2.0 * i as f64 * 0.8f64.ln() + wobble(i)));
    (x, y)
}

#[test]
fn not_a_number_is_refused_before_the_solver_sees_it() {
    let (x, y) = ladder(1.0);
    let free = [bounds(-10.0, 10.0), bounds(-20.0, 0.0)];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (mut x_bad, mut y_bad) = (x.clone(), y.clone());
        x_bad[(3, 1)] = bad;
        y_bad[5] = bad;
        assert_eq!(solve(&x_bad, &y, &free).unwrap_err(), Failure::Malformed);
        assert_eq!(solve(&x, &y_bad, &free).unwrap_err(), Failure::Malformed);
        assert_eq!(solve(&x, &y, &[free[0], bounds(bad, 0.0)]).unwrap_err(), Failure::Malformed);
    }
    assert_eq!(solve(&x, &y, &[free[0], bounds(1.0, 0.0)]).unwrap_err(), Failure::Malformed, "crossed bounds");
    assert_eq!(solve(&x, &y, &free[..1]).unwrap_err(), Failure::Malformed, "a bound for every unknown");
    assert_eq!(solve(&x, &DVector::zeros(3), &free).unwrap_err(), Failure::Malformed);
}

#[test]
fn the_scale_of_the_weights_does_not_matter() {
    let free = [bounds(-10.0, 10.0), bounds(-20.0, 0.0)];
    let (x, y) = ladder(1.0);
    let reference = solve(&x, &y, &free).unwrap().x;
    for exponent in -12..=12 {
        let (x, y) = ladder(10f64.powi(exponent));
        let found = solve(&x, &y, &free).unwrap().x;
        assert!((&found - &reference).amax() < 1e-12, "weights of 1e{exponent}: {found}");
    }
}

#[test]
fn columns_of_very_different_size_are_no_trouble() {
    let x = DMatrix::from_row_slice(4, 2, &[1e-9, 0.0, 1e-9, 1e6, 1e-9, 2e6, 1e-9, 3e6]);
    let truth = DVector::from_vec(vec![3e9, -2e-6]);
    let y = &x * &truth;
    let found = solve(&x, &y, &[bounds(-1e10, 1e10), bounds(-1.0, 1.0)]).unwrap().x;
    assert!((found[0] / truth[0] - 1.0).abs() < 1e-12 && (found[1] / truth[1] - 1.0).abs() < 1e-12, "{found}");
}

#[test]
fn what_the_rows_do_not_determine_is_refused() {
    let free = [bounds(-10.0, 10.0), bounds(-20.0, 0.0)];
    let one = DMatrix::from_row_slice(1, 2, &[1.0, 2.0]);
    assert_eq!(solve(&one, &DVector::from_vec(vec![1.0]), &free).unwrap_err(), Failure::NotIdentified, "one point");
    let same = DMatrix::from_fn(3, 2, |_, j| if j == 0 { 1.0 } else { 2.0 });
    let y = DVector::from_vec(vec![1.0, 1.1, 0.9]);
    assert_eq!(solve(&same, &y, &free).unwrap_err(), Failure::NotIdentified, "three equal abscissae");
    let nearly = DMatrix::from_fn(3, 2, |i, j| if j == 0 { 1.0 } else { 2.0 + 1e-10 * i as f64 });
    assert_eq!(solve(&nearly, &y, &free).unwrap_err(), Failure::NotIdentified, "condition above 1e8");
    let zero = DMatrix::from_fn(3, 2, |_, j| if j == 0 { 1.0 } else { 0.0 });
    assert_eq!(solve(&zero, &y, &free).unwrap_err(), Failure::NotIdentified, "an empty column");
}

#[test]
fn an_unknown_at_its_bound_is_on_it_exactly() {
    // Heights that grow: L would be positive, and the bound holds it at zero.
    let x = DMatrix::from_fn(4, 2, |i, j| if j == 0 { 1.0 } else { 2.0 * i as f64 });
    let y = DVector::from_fn(4, |i, _| 0.1 * i as f64);
    let found = solve(&x, &y, &[bounds(-10.0, 10.0), bounds(-20.0, 0.0)]).unwrap();
    assert_eq!(found.x[1], 0.0);
    assert_eq!(found.active, [false, true]);
    assert!((found.x[0] - 0.15).abs() < 1e-14, "the other unknown is then the mean: {}", found.x[0]);
    assert_eq!(found.covariance[(1, 1)], 0.0);
    assert!((found.covariance[(0, 0)] - 0.25).abs() < 1e-14);
    // The same from below, and both at once.
    let below = solve(&x, &y, &[bounds(1.0, 10.0), bounds(-20.0, -0.5)]).unwrap();
    assert!((below.x[0] - 1.65).abs() < 1e-14 && below.x[1] == -0.5, "{below:?}");
    let corner = solve(&x, &y, &[bounds(5.0, 10.0), bounds(0.5, 1.0)]).unwrap();
    assert_eq!((corner.x[0], corner.x[1], corner.active), (5.0, 0.5, vec![true, true]));
}

#[test]
fn a_minimum_exactly_on_a_bound_is_found() {
    let x = DMatrix::from_fn(3, 1, |_, _| 1.0);
    let y = DVector::from_vec(vec![-1.0, 0.0, 1.0]);
    let found = solve(&x, &y, &[bounds(-5.0, 0.0)]).unwrap();
    assert!(found.x[0].abs() < 1e-15, "{}", found.x[0]);
}

#[test]
fn bounds_as_large_as_infinity_are_no_trouble() {
    let (x, y) = ladder(1.0);
    let narrow = solve(&x, &y, &[bounds(-10.0, 10.0), bounds(-20.0, 0.0)]).unwrap().x;
    for huge in [1e6, 1e8, 1e15, 1e20, 1e300] {
        let wide = solve(&x, &y, &[bounds(-huge, huge), bounds(-huge, huge)]).unwrap().x;
        assert!((&wide - &narrow).amax() < 1e-13, "bounds of {huge:e}");
    }
}

#[test]
fn nothing_to_find_is_found() {
    let none = solve(&DMatrix::zeros(3, 0), &DVector::zeros(3), &[]).unwrap();
    assert!(none.x.is_empty() && none.active.is_empty());
}

#[test]
fn a_right_hand_side_of_zero_gives_zero() {
    let (x, y) = ladder(1.0);
    let found = solve(&x, &(y * 0.0), &[bounds(-10.0, 10.0), bounds(-20.0, 5.0)]).unwrap();
    assert_eq!((found.x[0], found.x[1]), (0.0, 0.0));
}

#[test]
fn solver_and_factorisation_agree_on_many_problems() {
    let mut state = 7u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    for case in 0..200 {
        let n = 1 + case % 4;
        let x = DMatrix::from_fn(n + 1 + case % 5, n, |_, _| next());
        let y = DVector::from_fn(x.nrows(), |_, _| next());
        let limits: Vec<Bounds> = (0..n).map(|_| bounds(-0.3 - next().abs(), 0.3 + next().abs())).collect();
        let Ok(found) = solve(&x, &y, &limits) else { continue };
        // At a minimum every feasible small move raises the sum of squares.
        let cost = |z: &DVector<f64>| (&x * z - &y).norm_squared();
        let here = cost(&found.x);
        for j in 0..n {
            for move_by in [-1e-4, 1e-4] {
                let mut z = found.x.clone();
                z[j] = (z[j] + move_by).clamp(limits[j].low, limits[j].high);
                assert!(cost(&z) >= here - 1e-12, "case {case}, unknown {j}");
            }
        }
    }
}

#[test]
fn nearly_dependent_unknowns_keep_to_their_bounds() {
    // Two columns that differ by 1e-5: the free minimum lies far outside, and the solver alone
    // leaves open which bounds hold.
    for tilt in [1e-2, 1e-4, 1e-6] {
        for height in [-1.0, -0.1, 0.1, 1.0] {
            let x = DMatrix::from_fn(6, 2, |i, j| 1.0 + if j == 0 { 0.0 } else { tilt * (i * i) as f64 });
            let y = DVector::from_fn(6, |i, _| 1.0 + height * i as f64);
            let limits = [bounds(-0.1, 0.1), bounds(-0.3, 0.05)];
            let found = solve(&x, &y, &limits).unwrap();
            assert!((0..2).all(|j| limits[j].low <= found.x[j] && found.x[j] <= limits[j].high));
            let cost = |a: f64, b: f64| (&x * DVector::from_vec(vec![a, b]) - &y).norm_squared();
            let here = cost(found.x[0], found.x[1]);
            for (a, b) in (0..=20).flat_map(|a| (0..=20).map(move |b| (a, b))) {
                let there = cost(-0.1 + 0.01 * f64::from(a), -0.3 + 0.0175 * f64::from(b));
                assert!(here <= there + 1e-12, "tilt {tilt}, height {height}: {:?} but {a} {b}", found.x);
            }
        }
    }
}

#[test]
fn a_step_of_almost_nothing_between_distant_bounds() {
    // The right-hand side is orthogonal to the columns but for 1e-8, and the bounds are hundreds
    // away: here the solver alone runs out of iterations far from the minimum, with vanishing
    // residuals of feasibility.
    let x = DMatrix::from_row_slice(3, 2, &[1.0, 0.999, 0.0, 0.0447, 0.0, 0.0]);
    let y = DVector::from_vec(vec![-2.581e-8, 4.856e-8, 1.0]);
    let limits = [bounds(-690.26, 1e5), bounds(-442.8, 406.5)];
    let found = solve(&x, &y, &limits).unwrap();
    let expected = 4.856e-8 / 0.0447;
    assert!((found.x[1] / expected - 1.0).abs() < 1e-9, "{}", found.x);
    assert!((found.x[0] / (-2.581e-8 - 0.999 * expected) - 1.0).abs() < 1e-9, "{}", found.x);
}
