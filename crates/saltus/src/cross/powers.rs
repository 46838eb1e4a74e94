//! The first fall of a polynomial by its powers, where they show it to be the only one up to there.

use crate::certainty::{MINUTE, ROUGHLY, SURELY, TINY};
use crate::poly::MAX_DEGREE;

use super::Turn;

/// How often a stretch is halved on which the terms that rise do not outweigh those that fall.
const DEEPEST: u32 = 4;
/// Corrections after which the root is given up.
const MOST_CORRECTIONS: usize = 40;

/// Where a polynomial on `0..=1` first falls through zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FirstFall {
    /// Here, to rounding.
    At(Fall),
    /// Nowhere.
    Nowhere,
    /// The powers do not show it.
    Unclear,
}

/// A fall of a polynomial through zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fall {
    pub(crate) u: f64,
    /// The first derivative there, and half the second.
    pub(crate) slope: f64,
    pub(crate) bend: f64,
}

/// A polynomial on `0..=1` by its powers.
pub(crate) struct Powers {
    a: [f64; MAX_DEGREE + 1],
    len: usize,
    /// Of all but the first.
    rest: Sums,
}

/// The sum of some numbers and that of their sizes.
#[derive(Clone, Copy)]
struct Sums {
    sum: f64,
    size: f64,
}

impl Sums {
    const ZERO: Self = Self { sum: 0.0, size: 0.0 };

    fn of(a: &[f64]) -> Self {
        a.iter().fold(Self::ZERO, |sums, &a| sums.and(a))
    }

    #[inline]
    fn and(self, a: f64) -> Self {
        Self { sum: self.sum + a, size: self.size + a.abs() }
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, size: self.size + other.size }
    }

    /// How much the numbers below zero are below.
    #[inline]
    fn below(&self) -> f64 {
        0.5 * (self.size - self.sum)
    }
}

impl FirstFall {
    /// The first two derivatives at a fall, by the time, which is `limit` at u = 1.
    #[inline]
    pub(crate) fn derivatives(self, limit: f64) -> Option<[f64; 2]> {
        match self {
            Self::At(Fall { slope, bend, .. }) => Some([slope / limit, 2.0 * bend / (limit * limit)]),
            Self::Nowhere | Self::Unclear => None,
        }
    }
}

impl Fall {
    /// The same of uᵏ times the polynomial.
    #[inline]
    fn times_power(self, k: usize) -> Self {
        let Self { u, slope, bend } = self;
        match k {
            0 => self,
            1 => Self { u, slope: u * slope, bend: slope + u * bend },
            _ => self.times_power(1).times_power(k - 1),
        }
    }
}

impl Powers {
    /// Room for one: filled where it stands, it need not be carried about.
    #[inline]
    pub(crate) const fn new() -> Self {
        Self { a: [0.0; MAX_DEGREE + 1], len: 0, rest: Sums::ZERO }
    }

    /// Becomes `start` and the coefficients `of` at most [`MAX_DEGREE`] others times the powers of
    /// a `stretch`, the first of them that of one.
    #[inline]
    pub(crate) fn fill<T>(&mut self, start: f64, rest: &[T], mut of: impl FnMut(&T) -> f64, stretch: f64) {
        self.a[0] = start;
        // Two at a time, so that no number waits long for the one before.
        let [mut even, mut odd] = [Sums::ZERO; 2];
        let (mut power, square) = (stretch, stretch * stretch);
        let (pairs, last) = rest.as_chunks();
        let (places, _) = self.a[1..].as_chunks_mut();
        for ([a, b], place) in pairs.iter().zip(&mut *places) {
            *place = [of(a) * power, of(b) * (power * stretch)];
            (even, odd) = (even.and(place[0]), odd.and(place[1]));
            power *= square;
        }
        if let ([last], Some([place, _])) = (last, places.get_mut(pairs.len())) {
            *place = of(last) * power;
            even = even.and(*place);
        }
        self.len = 1 + rest.len();
        self.rest = even.plus(odd);
    }

    pub(crate) fn coefficients(&self) -> &[f64] {
        &self.a[..self.len]
    }

    /// How much it changes by at most.
    #[inline]
    pub(crate) fn change(&self) -> f64 {
        self.rest.size
    }

    /// How far the rounding of its terms may take it.
    #[inline]
    pub(crate) fn rounding(&self) -> f64 {
        SURELY * f64::EPSILON * (self.a[0].abs() + self.change())
    }

    /// What it is at 1.
    #[inline]
    pub(crate) fn end(&self) -> f64 {
        self.a[0] + self.rest.sum
    }

    /// Between which times it turns up, where it falls at the start and rises at the end; unless
    /// even the sum of all terms that fall leaves it far from zero beside how much it changes. Of
    /// one that starts below zero the same from there: where it turns down.
    #[inline]
    pub(crate) fn turns(&self) -> Option<Turn> {
        let a = self.coefficients();
        if a[0] < 0.0 {
            return self.turns_below();
        }
        let falls = a.len() > 2 && a[1] < 0.0 && a[0] - self.rest.below() <= ROUGHLY * self.change();
        (falls && self.slope_at_end() > 0.0).then_some(Turn { between: [0.0, 1.0], below: false })
    }

    #[cold]
    fn turns_below(&self) -> Option<Turn> {
        let a = self.coefficients();
        let above = self.rest.sum + self.rest.below();
        let rises = a.len() > 2 && a[1] > 0.0 && a[0] + above >= -ROUGHLY * self.change();
        (rises && self.slope_at_end() < 0.0).then_some(Turn { between: [0.0, 1.0], below: true })
    }

    #[inline(never)]
    fn slope_at_end(&self) -> f64 {
        self.coefficients().iter().zip(0..).skip(1).map(|(a, k)| f64::from(k) * a).sum()
    }

    /// How far it bends: by its powers from the second on.
    #[inline]
    pub(crate) fn bend(&self) -> f64 {
        (self.rest.size - self.a[1].abs()).max(0.0)
    }

    /// Takes away the slope at its start.
    #[cold]
    pub(crate) fn drop_slope(&mut self) {
        self.a[1] = 0.0;
        self.rest = Sums::of(&self.a[2..self.len]);
    }

    /// Where what is left from the power `k` on, of which the first is divided out, first falls
    /// through zero: it may be off by `margin`, and is positive at its start.
    ///
    /// A root r is found by Chebyshev's method (J. Traub, *Iterative Methods for the Solution of
    /// Equations*, 1964, chapter 5): Newton's with a term for the bend, of order three, for little
    /// more than the wait for the value itself. With Aₖ = aₖ rᵏ and v = u/r the polynomial is (1 -
    /// v) Σ Wₖ vᵏ, where Wₖ = A₀ + … + Aₖ: if the second factor is positive on `0..=1`, no root is
    /// earlier and the polynomial falls at this one. It is bounded from below on ever shorter
    /// stretches.
    pub(crate) fn first_fall(&self, k: usize, margin: f64) -> FirstFall {
        let a = &self.coefficients()[k.min(self.len)..];
        let sums = match k {
            0 => self.rest.and(self.a[0]),
            1 => self.rest,
            _ => Sums::of(a),
        };
        match first_fall(a, sums, margin) {
            FirstFall::At(fall) => FirstFall::At(fall.times_power(k)),
            other => other,
        }
    }
}

fn first_fall(a: &[f64], sums: Sums, margin: f64) -> FirstFall {
    if !(a.first().is_some_and(|&start| start > margin) && sums.size.is_finite()) {
        return FirstFall::Unclear;
    }
    if sums.sum > margin {
        return if is_above(a, sums, margin) { FirstFall::Nowhere } else { FirstFall::Unclear };
    }
    let Some(root) = root(a, sums.sum) else { return FirstFall::Unclear };
    let mut factor = [0.0; MAX_DEGREE + 1];
    let sums = divide(a, root.u, &mut factor);
    if is_above(&factor[..a.len() - 1], sums, margin) { FirstFall::At(root) } else { FirstFall::Unclear }
}

/// Puts down the Wₖ of a polynomial with a `root`.
#[inline]
fn divide(a: &[f64], root: f64, factor: &mut [f64]) -> Sums {
    let [mut even, mut odd] = [Sums::ZERO; 2];
    let (mut before, mut power, square) = (0.0, 1.0, root * root);
    for (w, [a, b]) in factor.as_chunks_mut().0.iter_mut().zip(a.as_chunks().0) {
        let first = a * power;
        let both = first + b * (power * root);
        *w = [before + first, before + both];
        (even, odd) = (even.and(w[0]), odd.and(w[1]));
        before = w[1];
        power *= square;
    }
    even.plus(odd)
}

/// A root in `0..=1` of a polynomial that is positive at 0 and, but for rounding, not at 1, where
/// it is `end`.
fn root(a: &[f64], end: f64) -> Option<Fall> {
    let &[start, slope, ..] = a else { return None };
    // Where the parabola with this start, slope and end falls.
    let bend = end - start - slope;
    let discriminant = (slope * slope - 4.0 * bend * start).max(0.0).sqrt();
    let guess = if slope < 0.0 { 2.0 * start / (discriminant - slope) } else { (-slope - discriminant) / (2.0 * bend) };
    let (mut low, mut high) = (0.0, 1.0);
    let mut u = if guess > low && guess <= high { guess } else { 0.5 };
    for _ in 0..MOST_CORRECTIONS {
        let [value, slope, bend] = value_slope_and_bend(a, u);
        if value > 0.0 {
            low = u;
        } else {
            high = u;
        }
        let by = value / slope;
        let bent = by * (bend / slope);
        let next = u - by * (1.0 + bent);
        let off = (next - u).abs();
        // What is left is the square of the correction, and so no more than rounding.
        if off <= MINUTE * u || off <= TINY * u && bent.abs() <= TINY {
            return (next <= 1.0).then_some(Fall { u: next, slope, bend });
        }
        u = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    None
}

/// The value, the slope and half the second derivative at `u`, in two chains each.
#[inline]
fn value_slope_and_bend(a: &[f64], u: f64) -> [f64; 3] {
    let square = u * u;
    let (pairs, last) = a.as_chunks::<2>();
    let mut value = [last.first().copied().unwrap_or(0.0), 0.0];
    let [mut slope, mut bend] = [[0.0; 2]; 2]; // by u²
    for pair in pairs.iter().rev() {
        for i in 0..2 {
            bend[i] = bend[i] * square + slope[i];
            slope[i] = slope[i] * square + value[i];
            value[i] = value[i] * square + pair[i];
        }
    }
    [
        value[0] + u * value[1],
        value[1] + 2.0 * (u * slope[0] + square * slope[1]),
        slope[0] + 3.0 * u * slope[1] + 4.0 * square * (bend[0] + u * bend[1]),
    ]
}

/// Whether Σ aₖ uᵏ exceeds `margin` on `0..=1`.
#[inline]
fn is_above(a: &[f64], sums: Sums, margin: f64) -> bool {
    let falling = sums.below();
    a[0] - falling > margin || is_above_in_parts(a, sums, margin)
}

/// The same where the terms that fall could outweigh the first.
fn is_above_in_parts(a: &[f64], sums: Sums, margin: f64) -> bool {
    let slope = a.get(1).map_or(0.0, |a| a.max(0.0));
    let start = Terms { u: 0.0, rising: a[0].max(0.0), slope, falling: (-a[0]).max(0.0) };
    let end = Terms { u: 1.0, rising: sums.sum + sums.below(), slope: 0.0, falling: sums.below() };
    exceeds(a, margin, &start, &end, DEEPEST)
}

/// The terms of either sign at a place `u`: both sums are convex, and rise with it.
struct Terms {
    u: f64,
    rising: f64,
    /// The slope of the rising ones, which the last place does without.
    slope: f64,
    falling: f64,
}

impl Terms {
    #[inline]
    fn at(a: &[f64], u: f64) -> Self {
        let (mut rising, mut slope, mut falling) = (0.0, 0.0, 0.0);
        for a in a.iter().rev() {
            slope = slope * u + rising;
            rising = rising * u + a.max(0.0);
            falling = falling * u + (-a).max(0.0);
        }
        Self { u, rising, slope, falling }
    }
}

/// Whether the tangent of the rising terms is above the chord of the falling ones, from one place
/// to another or on both of its halves.
fn exceeds(a: &[f64], margin: f64, from: &Terms, to: &Terms, depth: u32) -> bool {
    let above = from.rising - from.falling > margin && to.rising - to.falling > margin;
    let tangent = from.rising + from.slope * (to.u - from.u);
    if !above || tangent - to.falling > margin {
        return above;
    }
    if depth == 0 {
        return false;
    }
    let middle = Terms::at(a, 0.5 * (from.u + to.u));
    exceeds(a, margin, from, &middle, depth - 1) && exceeds(a, margin, &middle, to, depth - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MARGIN: f64 = 1e-13;

    /// The powers of `scale` (1 + `bend` u²) Π (1 - u/rᵢ).
    fn with_roots(roots: &[f64], scale: f64, bend: f64) -> Vec<f64> {
        let times = |p: &[f64], q: &[f64]| -> Vec<f64> {
            let mut product = vec![0.0; p.len() + q.len() - 1];
            for (i, p) in p.iter().enumerate() {
                for (j, q) in q.iter().enumerate() {
                    product[i + j] += p * q;
                }
            }
            product
        };
        roots.iter().fold(vec![scale, 0.0, scale * bend], |p, r| times(&p, &[1.0, -1.0 / r]))
    }

    /// How well its rounded powers determine a root.
    fn within_rounding(a: &[f64], root: f64) -> f64 {
        let [_, slope, _] = value_slope_and_bend(a, root);
        let size = a.iter().rev().fold(0.0, |size, a| size * root + a.abs());
        1e-14 * (root + size / slope.abs())
    }

    #[test]
    fn roots_that_lie_close() {
        for digits in 1..=12 {
            // The second is just beyond the end.
            let off = 0.1_f64.powi(digits);
            let a = with_roots(&[1.0 - off, 1.0 + 2.0 * off], 1.0, 0.3);
            let u = root(&a, Sums::of(&a).sum).unwrap().u;
            assert!((u - (1.0 - off)).abs() <= within_rounding(&a, u), "{digits} {u}");
        }
    }

    #[test]
    fn what_is_clear_is_said() {
        let first_fall = |a: &[f64], margin: f64| first_fall(a, Sums::of(a), margin);
        assert_eq!(first_fall(&[1.0, -0.5], MARGIN), FirstFall::Nowhere);
        assert_eq!(first_fall(&[1.0, 0.0, -4.0], MARGIN), FirstFall::At(Fall { u: 0.5, slope: -4.0, bend: -4.0 }));
        // sin(s)/s on 0..=3 and on 0..=3.5
        let sine = |span: f64| -> Vec<f64> {
            let mut term = 1.0;
            let mut powers = vec![1.0];
            for k in 1..=24_u32 {
                term *= span / f64::from(k + 1);
                powers.push([1.0, 0.0, -1.0, 0.0][k as usize % 4] * term);
            }
            powers
        };
        assert_eq!(first_fall(&sine(3.0), MARGIN), FirstFall::Nowhere);
        let FirstFall::At(Fall { u, .. }) = first_fall(&sine(3.5), MARGIN) else { panic!() };
        assert!((3.5 * u - std::f64::consts::PI).abs() < 1e-14);
    }

    #[test]
    fn what_is_not_is_not() {
        let first_fall = |a: &[f64], margin: f64| first_fall(a, Sums::of(a), margin);
        assert_eq!(first_fall(&[], MARGIN), FirstFall::Unclear);
        assert_eq!(first_fall(&[0.0, -1.0], MARGIN), FirstFall::Unclear);
        assert_eq!(first_fall(&[1.0, f64::NAN], MARGIN), FirstFall::Unclear);
        assert_eq!(first_fall(&[1.0, f64::NEG_INFINITY], MARGIN), FirstFall::Unclear);
        assert_eq!(first_fall(&with_roots(&[0.5, 0.5], 1.0, 0.0), MARGIN), FirstFall::Unclear);
    }

    proptest! {
        /// Never another fall than the first, never none where there is one, however the roots lie.
        #[test]
        fn planted_roots(roots in prop::collection::vec(0.02..1.6_f64, 1..7), scale in 0.1..10.0_f64, bend in 0.0..2.0_f64) {
            let mut roots = roots;
            roots.sort_by(f64::total_cmp);
            let a = with_roots(&roots, scale, bend);
            let within = roots.iter().filter(|&&r| r <= 1.0).count();
            let mut powers = Powers::new();
            powers.fill(a[0], &a[1..], |a| *a, 1.0);
            match powers.first_fall(0, MARGIN * a.iter().map(|a| a.abs()).sum::<f64>()) {
                FirstFall::At(Fall { u, slope, bend }) => {
                    prop_assert!((u - roots[0]).abs() <= within_rounding(&a, roots[0]), "{u} {roots:?}");
                    // And its derivatives, of that times a power as well, from just before the last
                    // correction.
                    for k in 0..3 {
                        let times: Vec<_> = std::iter::repeat_n(0.0, k).chain(a.iter().copied()).collect();
                        let [_, slope_there, bend_there] = value_slope_and_bend(&times, u);
                        let fall = Fall { u, slope, bend }.times_power(k);
                        let size: f64 = times.iter().zip(0..).map(|(a, k)| a.abs() * f64::from(k * k)).sum();
                        prop_assert!((fall.slope - slope_there).abs() <= 1e-5 * size, "{k} {fall:?} {slope_there}");
                        prop_assert!((fall.bend - bend_there).abs() <= 1e-4 * size, "{k} {fall:?} {bend_there}");
                    }
                }
                FirstFall::Nowhere => prop_assert_eq!(within, 0),
                FirstFall::Unclear => {}
            }
        }
    }
}
