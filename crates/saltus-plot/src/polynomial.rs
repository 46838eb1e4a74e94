//! Polynomials by their coefficients, in rising powers.

/// Σ cₖ sᵏ.
pub(crate) fn value(c: &[f64], s: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &c| sum * s + c)
}

pub(crate) fn derivative(c: &[f64]) -> Vec<f64> {
    c.iter().zip(0u32..).skip(1).map(|(&c, k)| c * f64::from(k)).collect()
}

pub(crate) fn trimmed(c: &[f64]) -> &[f64] {
    let kept = c.iter().rposition(|&c| c != 0.0).map_or(0, |last| last + 1);
    &c[..kept]
}

/// The polynomial in s of Σ cₖ (s + shift)ᵏ.
pub(crate) fn shifted(c: &[f64], shift: f64) -> Vec<f64> {
    let mut c = c.to_vec();
    for first in 0..c.len() {
        for k in (first..c.len().saturating_sub(1)).rev() {
            c[k] += shift * c[k + 1];
        }
    }
    c
}

/// The changes of sign of the polynomial in (0, span), in rising order.
///
/// Between two neighbouring turning points it is monotone, so bisection there finds every change of
/// sign.
fn sign_changes(c: &[f64], span: f64) -> Vec<f64> {
    let c = trimmed(c);
    if c.len() < 2 {
        return Vec::new();
    }
    let mut knots = vec![0.0];
    knots.extend(sign_changes(&derivative(c), span));
    knots.push(span);
    let mut roots = Vec::new();
    for pair in knots.windows(2) {
        let (mut a, mut b) = (pair[0], pair[1]);
        let rising = value(c, b) > 0.0;
        if (value(c, a) > 0.0) == rising {
            continue;
        }
        for _ in 0..64 {
            let middle = 0.5 * (a + b);
            if (value(c, middle) > 0.0) == rising {
                b = middle;
            } else {
                a = middle;
            }
        }
        roots.push(b);
    }
    roots
}

/// Lowest and highest value over `[0, span]`.
pub(crate) fn extent(c: &[f64], span: f64) -> (f64, f64) {
    let turns = sign_changes(&derivative(c), span);
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for s in turns.into_iter().chain([0.0, span]) {
        let h = value(c, s);
        if !h.is_finite() {
            return (h, h);
        }
        low = low.min(h);
        high = high.max(h);
    }
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_are_found_for_any_degree() {
        assert!((extent(&[1.0, 2.0, -4.9], 1.0).1 - (1.0 + 1.0 / 4.9)).abs() < 1e-12);
        // (s - 0.2)² (s - 0.7)² has its lowest points at 0.2 and 0.7, and the value 0.0625²
        // between.
        let quartic = [0.0196, -0.252, 1.09, -1.8, 1.0];
        let (low, high) = extent(&quartic, 0.8);
        assert!(low.abs() < 1e-15, "{low}");
        assert!((high - 0.0196).abs() < 1e-15, "{high}");
        assert_eq!(extent(&[], 3.0), (0.0, 0.0));
        assert_eq!(extent(&[2.0], 0.0), (2.0, 2.0));
    }
}
