//! Interpolation at the nine Chebyshev points of the second kind (L. N. Trefethen, *Approximation
//! Theory and Approximation Practice*, 2013, ch. 3).

/// cos(j pi / 8), from -1 up to 1.
pub(crate) const NODES: [f64; 9] = [
    -1.0,
    -0.923_879_532_511_286_7,
    -std::f64::consts::FRAC_1_SQRT_2,
    -0.382_683_432_365_089_8,
    0.0,
    0.382_683_432_365_089_8,
    std::f64::consts::FRAC_1_SQRT_2,
    0.923_879_532_511_286_7,
    1.0,
];

/// Where a guard is compared with its interpolant: away from the nodes, and at no fraction that a
/// guard is likely to have a period of.
pub(crate) const CHECKS: [f64; 2] = [-0.557_350_921, 0.271_828_183];

/// How many samples are taken of an interval: at the Chebyshev points and at two checks.
pub(crate) const SAMPLES: usize = NODES.len() + CHECKS.len();

/// The times of the samples on `[a, b]`: the Chebyshev points from `a` up to `b`, then the checks.
#[inline]
pub(crate) fn sample_times(a: f64, b: f64) -> [f64; SAMPLES] {
    let (centre, radius) = (0.5 * (a + b), 0.5 * (b - a));
    let mut times = [a; SAMPLES];
    for (time, node) in times[1..].iter_mut().zip(NODES[1..].iter().chain(&CHECKS)) {
        *time = centre + radius * node;
    }
    times[NODES.len() - 1] = b;
    times
}

/// Row j: what node j adds to the coefficient of each `T_k`.
const WEIGHTS: [[f64; 9]; 9] = weights();

const fn weights() -> [[f64; 9]; 9] {
    let mut rows = [[0.0; 9]; 9];
    let mut k = 0;
    while k < 9 {
        let mut j = 0;
        while j < 9 {
            // T_k at node j, whose angle is (8 - j) π / 8, is cos(k (8 - j) π / 8): a node itself,
            // once its angle is folded back into 0..=π.
            let turn = (k * (8 - j)) % 16;
            let fold = if turn > 8 { 16 - turn } else { turn };
            let whole = if k == 0 || k == 8 { 8.0 } else { 4.0 };
            let end = if j == 0 || j == 8 { 0.5 } else { 1.0 };
            rows[j][k] = end * NODES[8 - fold] / whole;
            j += 1;
        }
        k += 1;
    }
    rows
}

/// The coefficients of `T_0` to `T_8` of the interpolant.
pub(crate) fn series(values: &[f64; 9]) -> [f64; 9] {
    combined(values, &WEIGHTS)
}

/// The sum of rows, each times its factor: side by side, so that no sum waits for itself.
#[inline]
fn combined(factors: &[f64; 9], rows: &[[f64; 9]; 9]) -> [f64; 9] {
    let mut sums = [0.0; 9];
    for (factor, row) in factors.iter().zip(rows) {
        for (sum, part) in sums.iter_mut().zip(row) {
            *sum += factor * part;
        }
    }
    sums
}

/// Clenshaw's sum of the series at `x`.
pub(crate) fn sum(series: &[f64; 9], x: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for &c in series[1..].iter().rev() {
        (next, after) = (2.0 * x * next - after + c, next);
    }
    x * next - after + series[0]
}

/// The Bernstein coefficients of degree eight on the interval.
pub(crate) fn bernstein(series: &[f64; 9]) -> [f64; 9] {
    const TABLE: [[f64; 9]; 9] = table();
    combined(series, &TABLE)
}

/// The coefficients of 1, u, … u⁸ of the interpolant, u = (x + 1)/2 in `0..=1`.
pub(crate) fn powers(values: &[f64; 9]) -> [f64; 9] {
    // From the Bernstein coefficients: cₖ = C(8,k) Δᵏb₀.
    let mut differences = bernstein(&series(values));
    for level in 1..9 {
        for i in (level..9).rev() {
            differences[i] -= differences[i - 1];
        }
    }
    std::array::from_fn(|k| binomial(8, k) * differences[k])
}

/// Row k: `T_k` in the Bernstein basis, (-1)^(k-i) C(2k, 2i) / C(k, i), raised to degree eight.
const fn table() -> [[f64; 9]; 9] {
    let mut rows = [[0.0; 9]; 9];
    let mut k = 0;
    while k < 9 {
        let mut row = [0.0; 9];
        let mut i = 0;
        while i <= k {
            let sign = if (k - i) % 2 == 0 { 1.0 } else { -1.0 };
            row[i] = sign * binomial(2 * k, 2 * i) / binomial(k, i);
            i += 1;
        }
        let mut degree = k;
        while degree < 8 {
            let mut raised = [0.0; 9];
            let mut i = 0;
            while i <= degree + 1 {
                let w = i as f64 / (degree + 1) as f64;
                let left = if i > 0 { row[i - 1] } else { 0.0 };
                let here = if i <= degree { row[i] } else { 0.0 };
                raised[i] = w * left + (1.0 - w) * here;
                i += 1;
            }
            row = raised;
            degree += 1;
        }
        rows[k] = row;
        k += 1;
    }
    rows
}

const fn binomial(n: usize, k: usize) -> f64 {
    let mut value = 1.0;
    let mut i = 0;
    while i < k {
        value = value * (n - i) as f64 / (i + 1) as f64;
        i += 1;
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_eight_is_reproduced() {
        let f = |x: f64| ((x - 0.3) * (x + 0.7)).powi(4) - 0.1 * x;
        let values = NODES.map(f);
        let series = series(&values);
        for x in [-0.9, -0.2, 0.44, 0.99] {
            assert!((sum(&series, x) - f(x)).abs() < 1e-14);
            let u = 0.5 * (x + 1.0);
            let b = bernstein(&series);
            let total: f64 =
                (0..9).map(|i| b[i] * binomial(8, i) * u.powi(i as i32) * (1.0 - u).powi(8 - i as i32)).sum();
            assert!((total - f(x)).abs() < 1e-13);
        }
    }
}
