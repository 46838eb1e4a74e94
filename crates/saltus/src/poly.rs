//! Polynomials over a step, in the Bernstein basis: their coefficients bound them, and halving them
//! isolates their roots.

/// The highest degree handled.
pub(crate) const MAX_DEGREE: usize = 28;

/// Roundings of its largest term by which a sum of some ten terms may be off.
pub(crate) const SUMMED: f64 = 8.0;

/// So many times the margin of a guard is that of its slope at the start, with the root there
/// divided out: twice the degree of its interpolant, eight.
pub(crate) const DIVIDED: f64 = 16.0;

/// C(n, k) in row n.
const BINOMIALS: [[f64; MAX_DEGREE + 1]; MAX_DEGREE + 1] = {
    let mut rows = [[0.0; MAX_DEGREE + 1]; MAX_DEGREE + 1];
    let mut n = 0;
    while n <= MAX_DEGREE {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

/// A polynomial on `[0, 1]` by its Bernstein coefficients, p(u) = Σ bᵢ C(n,i) uⁱ (1-u)ⁿ⁻ⁱ.
///
/// p lies between the smallest and the largest bᵢ, starts at b₀ and ends at bₙ; if the bᵢ fall
/// (rise) throughout, so does p (R. Farouki, *The Bernstein polynomial basis: a centennial
/// retrospective*, CAGD 29 (2012) 379, doi:10.1016/j.cagd.2012.03.001).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bernstein {
    b: [f64; MAX_DEGREE + 1],
    degree: usize,
}

/// What the Bernstein coefficients say about the sign of the polynomial on its interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Positive throughout.
    Above,
    /// Negative throughout.
    Below,
    /// Falling throughout, faster than the margin could undo, and not within the margin of zero
    /// throughout.
    Falling,
    /// Rising throughout, likewise.
    Rising,
    /// Zero throughout, but for the margin.
    Flat,
    /// Not decided: halve the interval.
    Unclear,
}

impl Bernstein {
    /// From the coefficients of 1, u, u², …; `None` beyond [`MAX_DEGREE`].
    pub(crate) fn from_powers(c: &[f64]) -> Option<Self> {
        let degree = c.len().checked_sub(1).filter(|&n| n <= MAX_DEGREE)?;
        let mut b = [0.0; MAX_DEGREE + 1];
        b[..=degree].copy_from_slice(c);
        // Scale to cₖ / C(n,k), then sum down the Pascal triangle: bᵢ = Σₖ C(i,k) cₖ / C(n,k).
        for (value, binomial) in b[..=degree].iter_mut().zip(&BINOMIALS[degree]) {
            *value /= binomial;
        }
        for level in 1..=degree {
            for i in (level..=degree).rev() {
                b[i] += b[i - 1];
            }
        }
        Some(Self { b, degree })
    }

    /// From Bernstein coefficients.
    pub(crate) fn new(coefficients: &[f64]) -> Self {
        let degree = coefficients.len().saturating_sub(1).min(MAX_DEGREE);
        let mut b = [0.0; MAX_DEGREE + 1];
        b[..=degree].copy_from_slice(&coefficients[..=degree]);
        Self { b, degree }
    }

    /// The coefficients.
    pub(crate) fn coefficients(&self) -> &[f64] {
        &self.b[..=self.degree]
    }

    /// The largest magnitude among the coefficients.
    pub(crate) fn scale(&self) -> f64 {
        self.coefficients().iter().fold(0.0, |most, b| b.abs().max(most))
    }

    /// What rounding leaves of its values.
    pub(crate) fn rounding(&self) -> f64 {
        SUMMED * f64::EPSILON * self.scale()
    }

    /// What holds when every value may be off by `margin`.
    pub(crate) fn shape(&self, margin: f64) -> Shape {
        let b = self.coefficients();
        if b.iter().all(|&b| b > margin) {
            Shape::Above
        } else if b.iter().all(|&b| b < -margin) {
            Shape::Below
        } else if b.iter().all(|&b| b.abs() <= margin) {
            Shape::Flat
        } else {
            self.trend(margin)
        }
    }

    fn trend(&self, margin: f64) -> Shape {
        let least = 8.0 * margin;
        let b = self.coefficients();
        if b.windows(2).all(|pair| pair[0] - pair[1] > least) {
            Shape::Falling
        } else if b.windows(2).all(|pair| pair[1] - pair[0] > least) {
            Shape::Rising
        } else {
            Shape::Unclear
        }
    }

    /// The value at the start.
    pub(crate) fn start(&self) -> f64 {
        self.b[0]
    }

    /// The value at the end.
    pub(crate) fn end(&self) -> f64 {
        self.b[self.degree]
    }

    /// A bound on the magnitude of the slope.
    pub(crate) fn steepest(&self) -> f64 {
        let most = self.coefficients().windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        most * self.degree as f64
    }

    /// The coefficients times their binomials, for [`value`].
    fn weighted(&self) -> [f64; MAX_DEGREE + 1] {
        let mut weighted = self.b;
        for (value, binomial) in weighted[..=self.degree].iter_mut().zip(&BINOMIALS[self.degree]) {
            *value *= binomial;
        }
        weighted
    }

    /// Where it changes sign, if its signs at both ends differ: by regula falsi, to rounding. An
    /// end that stays is weighed down as if a parabola ran through the last three points (N.
    /// Anderson, Å. Björck, BIT 13 (1973) 253, doi:10.1007/BF01951936).
    pub(crate) fn root(&self) -> Option<f64> {
        let (mut a, mut b, mut at_a, mut at_b) = (0.0, 1.0, self.start(), self.end());
        if at_a == 0.0 || at_b == 0.0 || (at_a > 0.0) == (at_b > 0.0) {
            return None;
        }
        let weighted = self.weighted();
        for _ in 0..100 {
            let u = b - at_b * (b - a) / (at_b - at_a);
            if (u - b).abs() <= f64::EPSILON * u {
                return Some(u);
            }
            let at_u = value(&weighted[..=self.degree], u);
            if at_u == 0.0 {
                return Some(u);
            }
            if (at_u > 0.0) != (at_b > 0.0) {
                (a, at_a) = (b, at_b);
            } else {
                let weight = 1.0 - at_u / at_b;
                at_a *= if weight > 0.0 { weight } else { 0.5 };
            }
            (b, at_b) = (u, at_u);
        }
        Some(b)
    }

    /// p(u) - p(0).
    pub(crate) fn less_start(&self) -> Self {
        let mut b = self.b;
        for value in &mut b[..=self.degree] {
            *value -= self.b[0];
        }
        Self { b, degree: self.degree }
    }

    /// What changes from the start on, divided by u: (p(u) - p(0)) / u. The root at the start is
    /// spent, and its value there is rounding.
    pub(crate) fn without_root_at_start(&self) -> Self {
        let mut b = [0.0; MAX_DEGREE + 1];
        #[allow(clippy::cast_precision_loss)]
        for (i, value) in b.iter_mut().enumerate().take(self.degree) {
            *value = (self.b[i + 1] - self.b[0]) * self.degree as f64 / (i + 1) as f64;
        }
        Self { b, degree: self.degree.saturating_sub(1) }
    }

    /// The left and right halves, each again on `[0, 1]` (de Casteljau).
    pub(crate) fn halves(&self) -> (Self, Self) {
        let mut left = *self;
        let mut work = self.b;
        let n = self.degree;
        for level in 1..=n {
            for i in 0..=n - level {
                work[i] = 0.5 * (work[i] + work[i + 1]);
            }
            left.b[level] = work[0];
        }
        (left, Self { b: work, degree: n })
    }
}

/// The value at `u` of the polynomial of these weighted coefficients, by Horner's rule in u/(1-u)
/// or its reciprocal, whichever is at most one (L. Schumaker, W. Volk, *Efficient evaluation of
/// multivariate polynomials*, CAGD 3 (1986) 149).
#[inline]
fn value(weighted: &[f64], u: f64) -> f64 {
    let v = 1.0 - u;
    let (ratio, base) = if u <= 0.5 { (u / v, v) } else { (v / u, u) };
    let (mut sum, mut power) = (0.0, 1.0 / base);
    let mut step = |w: &f64| (sum, power) = (sum * ratio + w, power * base);
    if u <= 0.5 {
        weighted.iter().rev().for_each(&mut step);
    } else {
        weighted.iter().for_each(&mut step);
    }
    sum * power
}

/// Σ aₖ uᵏ and its derivative, where `of` gives aₖ of the list's number k: even and odd powers
/// apart, half as long a chain.
#[inline]
pub(crate) fn value_and_slope<T>(a: &[T], of: impl Fn(&T) -> f64, u: f64) -> (f64, f64) {
    let square = u * u;
    let (pairs, last) = a.as_chunks();
    let mut even = last.first().map_or(0.0, &of);
    let (mut odd, mut even_slope, mut odd_slope) = (0.0, 0.0, 0.0); // slopes by u²
    for [a, b] in pairs.iter().rev() {
        even_slope = even_slope * square + even;
        odd_slope = odd_slope * square + odd;
        even = even * square + of(a);
        odd = odd * square + of(b);
    }
    (even + u * odd, odd + 2.0 * (u * even_slope + square * odd_slope))
}

/// The first fall through zero of c₀ + c₁ s + c₂ s² at s ≥ 0, with c₀ taken to be zero and its root
/// skipped if `spent`.
///
/// The roots come from the form that does not cancel; the discriminant is computed with a fused
/// multiply-add (W. Kahan, *On the cost of floating-point computation without extra-precise
/// arithmetic*, 2004).
#[inline]
pub(crate) fn quadratic_fall(c: [f64; 3], spent: bool) -> Option<f64> {
    let [c0, c1, c2] = c;
    if spent {
        // s (c₁ + c₂ s): what is left falls at -c₁/c₂ if it starts positive; from a double root it
        // falls at once.
        return if c1 > 0.0 && c2 < 0.0 {
            Some(-c1 / c2)
        } else if c1 == 0.0 && c2 < 0.0 {
            Some(0.0)
        } else {
            None
        };
    }
    if c2 == 0.0 {
        return if c1 < 0.0 && c0 >= 0.0 { Some(c0 / -c1) } else { None };
    }
    let product = 4.0 * c0 * c2;
    let error = f64::mul_add(4.0 * c0, c2, -product);
    let square = c1 * c1;
    let discriminant = (square - product) + (f64::mul_add(c1, c1, -square) - error);
    if discriminant < 0.0 || (discriminant == 0.0 && c0 != 0.0) {
        return None; // no root, or a touch without a crossing
    }
    // The slope at the falling root is minus the root of the discriminant.
    let root = discriminant.sqrt();
    let s = if c1 < 0.0 { 2.0 * c0 / (root - c1) } else { (-c1 - root) / (2.0 * c2) };
    (s >= 0.0).then_some(s)
}

/// Where c₀ + c₁ s + c₂ s² touches zero from above at s > 0 without crossing it.
pub(crate) fn quadratic_touch([c0, c1, c2]: [f64; 3]) -> Option<f64> {
    let product = 4.0 * c0 * c2;
    let exact = f64::mul_add(4.0 * c0, c2, -product) == f64::mul_add(c1, c1, -(c1 * c1));
    (c0 > 0.0 && c1 < 0.0 && c1 * c1 == product && exact).then(|| -c1 / (2.0 * c2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn eval(c: &[f64], s: f64) -> f64 {
        c.iter().rev().fold(0.0, |sum, &c| sum * s + c)
    }

    #[test]
    fn powers_and_bernstein_agree() {
        let p = Bernstein::from_powers(&[1.0, -6.0, 11.0, -6.0]).unwrap(); // (1-u)(1-2u)(1-3u)
        let (left, right) = p.halves();
        assert!((left.coefficients()[3] - eval(&[1.0, -6.0, 11.0, -6.0], 0.5)).abs() < 1e-15);
        assert_eq!(left.coefficients()[3], right.coefficients()[0]);
        assert!((right.coefficients()[3]).abs() < 1e-15);
    }

    #[test]
    fn a_spent_root_is_divided_out() {
        let p = Bernstein::from_powers(&[0.0, 2.0, -3.0, 1.0]).unwrap(); // u (1-u)(2-u)
        let q = p.without_root_at_start();
        let expected = Bernstein::from_powers(&[2.0, -3.0, 1.0]).unwrap();
        for (got, want) in q.coefficients().iter().zip(expected.coefficients()) {
            assert!((got - want).abs() < 1e-15);
        }
    }

    proptest! {
        #[test]
        fn bounds_hold(c in prop::collection::vec(-10.0..10.0_f64, 1..9), u in 0.0..1.0_f64) {
            let p = Bernstein::from_powers(&c).unwrap();
            let value = eval(&c, u);
            let (low, high) = p.coefficients().iter().fold((f64::MAX, f64::MIN), |(l, h), &b| (b.min(l), b.max(h)));
            prop_assert!(low - 1e-12 <= value && value <= high + 1e-12);
        }

        #[test]
        fn planted_falls_of_parabolas(rise in -5.0..2.0_f64, width in 1e-6..5.0_f64, steep in 0.01..100.0_f64) {
            // -steep (s - rise)(s - rise - width): falls at rise + width.
            let fall = rise + width;
            let c = [-steep * rise * fall, steep * (rise + fall), -steep];
            let got = quadratic_fall(c, false);
            if fall >= 1e-9 {
                let conditioning = 1.0 + (rise.abs() + fall.abs()) / width;
                prop_assert!((got.unwrap() - fall).abs() <= 1e-14 * conditioning * (rise.abs() + fall.abs()));
            }
        }
    }
}
