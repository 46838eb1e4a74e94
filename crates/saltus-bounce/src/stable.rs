//! Small functions whose textbook form cancels or divides zero by zero, and the root of a monotone
//! function.

/// (eᶻ - 1)/z, 1 at z = 0.
#[inline]
pub(crate) fn phi1(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { z.exp_m1() / z }
}

/// (eᶻ - 1 - z)/z², 1/2 at z = 0.
#[inline]
pub(crate) fn phi2(z: f64) -> f64 {
    if z.abs() > 0.5 {
        return (phi1(z) - 1.0) / z;
    }
    // Σ zⁿ/(n + 2)!: with |z| ≤ 1/2 the next term is below 1e-18.
    (2..=15).rev().fold(1.0, |sum, n| 1.0 + sum * z / f64::from(n + 1)) / 2.0
}

/// (z - ln(1 + z))/z² for z > -1, 1/2 at z = 0.
#[inline]
pub(crate) fn log_excess(z: f64) -> f64 {
    if !(-0.2..=0.25).contains(&z) {
        return (1.0 - z.ln_1p() / z) / z;
    }
    // ln(1 + z) = 2 artanh w with w = z/(2 + z), so z - ln(1 + z) = z w - 2 (w³/3 + w⁵/5 + …), and
    // w/z = 1/(2 + z).
    let w = z / (2.0 + z);
    let tail = (0..10).rev().fold(0.0, |sum, k| sum * w * w + 1.0 / f64::from(2 * k + 3));
    (1.0 - 2.0 * w * tail / (2.0 + z)) / (2.0 + z)
}

/// ln(1 + z)/z for z > -1, 1 at z = 0.
#[inline]
pub(crate) fn log_ratio(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { ln_1p(z) / z }
}

/// artanh(z)/z for z < 1, 1 at z = 0.
#[inline]
pub(crate) fn artanh_ratio(z: f64) -> f64 {
    log_ratio(2.0 * z / (1.0 - z)) / (1.0 - z)
}

/// ln(1 + z), from the logarithm of the sum and what was lost in summing: in half the time of the
/// function of this name in many systems' libraries.
#[inline]
pub(crate) fn ln_1p(z: f64) -> f64 {
    let sum = 1.0 + z;
    // Beyond 2⁵³ the one is lost altogether, and at infinity there is no difference to take.
    if sum < 9e15 { sum.ln() + (z - (sum - 1.0)) / sum } else { z.ln_1p() }
}

/// f(z)/z, 1 at z = 0: for functions that begin like z (sin, tan, tanh, atan, artanh).
#[inline]
pub(crate) fn ratio(f: impl Fn(f64) -> f64, z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { f(z) / z }
}

/// The root of an increasing function with its slope, between `low` (where it is not positive) and
/// `high`, from `guess`.
///
/// Newton's steps where they stay inside the bracket of the root, halving where they do not; ends
/// when the bracket no longer shrinks.
pub(crate) fn increasing_root(f: impl Fn(f64) -> (f64, f64), mut low: f64, mut high: f64, guess: f64) -> f64 {
    let mut x = guess.clamp(low, high);
    for _ in 0..200 {
        let (value, slope) = f(x);
        if value == 0.0 {
            return x;
        }
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        if (newton - x).abs() <= f64::EPSILON * x.abs() {
            return newton;
        }
        let next = if newton > low && newton < high { newton } else { low + 0.5 * (high - low) };
        if next <= low || next >= high {
            return x;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_values() {
        // Sixty digits, rounded.
        for (got, reference) in [
            (phi2(-1e-12), 0.499_999_999_999_833_33),
            (phi2(-0.3), 0.453_535_785_352_420_74),
            (phi2(-0.5), 0.426_122_638_850_533_7),
            (phi2(-0.51), 0.424_819_603_276_685_67),
            (phi2(-30.0), 0.032_222_222_222_222_33),
            (log_excess(1e-12), 0.499_999_999_999_666_67),
            (log_excess(0.25), 0.429_703_178_972_643_9),
            (log_excess(0.26), 0.427_341_405_867_061_7),
            (log_excess(-0.2), 0.578_588_782_855_244),
            (log_excess(-0.21), 0.583_272_868_958_500_5),
            (log_excess(20.0), 0.042_388_693_905_691_44),
            (ln_1p(1e-300), 1e-300),
            (ln_1p(3e-9), 2.999_999_995_5e-9),
            (ln_1p(0.7), 0.530_628_251_062_170_4),
            (ln_1p(-0.3), -0.356_674_943_938_732_4),
            (ln_1p(1e300), 690.775_527_898_213_7),
            (artanh_ratio(1e-4), 1.000_000_003_333_333_4),
            (artanh_ratio(0.5), 1.098_612_288_668_109_8),
        ] {
            assert!((got - reference).abs() <= 1e-15 * reference.abs(), "{got} instead of {reference}");
        }
        assert_eq!(
            (phi1(0.0), phi2(0.0), log_excess(0.0), log_ratio(0.0), ratio(f64::tan, 0.0)),
            (1.0, 0.5, 0.5, 1.0, 1.0)
        );
    }

    proptest! {
        #[test]
        fn a_planted_root_is_found(root in -10.0..10.0_f64, guess in -20.0..20.0_f64) {
            let found = increasing_root(|x| ((x - root).powi(3) + x - root, 3.0 * (x - root).powi(2) + 1.0), -20.0, 20.0, guess);
            prop_assert!((found - root).abs() <= 1e-14 * root.abs().max(1.0));
        }
    }
}
