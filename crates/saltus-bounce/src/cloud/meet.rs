//! When two balls in flight meet, and when a ball meets a wall.

/// The time at which two balls whose centres are `r` apart and part at the velocity `v` first come
/// as close as `reach`; `None` if they do not, or only graze.
///
/// |r + v s| = R with b = r·v < 0: s = (|r| - R)(|r| + R)/(-b + √(|v|² (R² - p²))), where p = |r × v|/|v| is how closely the centres pass
/// each other: neither difference cancels but by the coordinates themselves. Balls that overlap by
/// rounding, and approach, meet at once.
#[inline]
pub(crate) fn balls<const D: usize>(r: [f64; D], v: [f64; D], reach: f64) -> Option<f64> {
    let b = dot(&r, &v);
    if b >= 0.0 {
        return None;
    }
    let distance = dot(&r, &r).sqrt();
    let gap = distance - reach;
    if gap <= 0.0 {
        return Some(0.0);
    }
    let speed = dot(&v, &v);
    let mut area = 0.0;
    for i in 0..D {
        for j in i + 1..D {
            let cross = difference_of_products(r[i], v[j], r[j], v[i]);
            area += cross * cross;
        }
    }
    let (span, pass) = (speed.sqrt() * reach, area.sqrt());
    (pass < span).then(|| gap * (distance + reach) / (((span - pass) * (span + pass)).sqrt() - b))
}

/// The time at which a gap `c` to a wall that changes at the rate `v` and bends at `a` (m/s²) first
/// falls through zero.
#[inline]
pub(super) fn wall(c: f64, v: f64, a: f64) -> Option<f64> {
    let c = c.max(0.0);
    if a == 0.0 {
        return (v < 0.0).then(|| c / -v);
    }
    if a > 0.0 {
        // The gap opens again: it falls before its least value or never.
        let discriminant = difference_of_products(v, v, 2.0 * a, c);
        return (v < 0.0 && discriminant > 0.0).then(|| 2.0 * c / (discriminant.sqrt() - v));
    }
    let root = difference_of_products(v, v, 2.0 * a, c).max(0.0).sqrt();
    Some(if v > 0.0 {
        (v + root) / -a
    } else if c == 0.0 {
        0.0
    } else {
        2.0 * c / (root - v)
    })
}

#[inline]
pub(super) fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// ab - cd with one rounding more than none (W. Kahan, *On the cost of floating-point computation
/// without extra-precise arithmetic*, 2004).
#[inline]
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let product = c * d;
    let error = f64::mul_add(-c, d, product);
    f64::mul_add(a, b, -product) + error
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, max_global_rejects: 20_000, ..ProptestConfig::default() })]

        /// Planted meetings are found: the balls are placed as they touch, and the clock turned
        /// back.
        #[test]
        fn planted_meetings(angle in 0.0..6.3_f64, turn in -1.5..1.5_f64, reach in 1e-3..1.0_f64, speed in 0.1..10.0_f64, s in 1e-6..10.0_f64) {
            let (n, u) = ([angle.cos(), angle.sin()], angle + std::f64::consts::PI + turn);
            let v = [speed * u.cos(), speed * u.sin()];
            let touch = [reach * n[0], reach * n[1]];
            let r = [touch[0] - v[0] * s, touch[1] - v[1] * s];
            let found = balls(r, v, reach).unwrap();
            let blur = 1e-15 * (reach + speed * s) / (speed * turn.cos());
            prop_assert!((found - s).abs() <= 8.0 * blur * (1.0 + 1.0 / turn.cos()), "{found} {s}");
            prop_assert_eq!(balls(r, v.map(|v| -v), reach), None);
        }

        #[test]
        fn planted_walls(v in -5.0..-1e-3_f64, a in -10.0..10.0_f64, s in 1e-3..5.0_f64) {
            // The gap falls through zero at s at the rate v.
            let (start, c) = (v - a * s, -(v * s - 0.5 * a * s * s));
            prop_assume!(c > 0.0);
            let found = wall(c, start, a);
            // With a > 0 the fall at s is the only one; with a < 0 too, since the gap starts
            // positive.
            let found = found.unwrap();
            prop_assert!((found - s).abs() <= 1e-13 * (1.0 + s) / v.abs() * (1.0 + start.abs()), "{found} {s}");
        }
    }
}
