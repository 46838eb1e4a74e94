//! The first fall of a polynomial by its powers, where they show it to be the only one up to there.

use crate::poly::{MAX_DEGREE, value_and_slope};

/// How often a stretch is halved on which the terms that rise do not outweigh those that fall.
const DEEPEST: u32 = 4;
/// A correction of the root by this part of it leaves an error of its square.
const CLOSE: f64 = 1e-8;
/// Corrections after which the root is given up.
const MOST_CORRECTIONS: usize = 40;

/// Where a polynomial on `0..=1` first falls through zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum FirstFall {
    /// Here, to rounding.
    At(f64),
    /// Nowhere.
    Nowhere,
    /// The powers do not show it.
    Unclear,
}

/// Where Σ aₖ uᵏ, which is positive at its start and may be off by `margin`, first falls through zero on `0..=1`.
///
/// A root r is found by Newton's method. With Aₖ = aₖ rᵏ and v = u/r the polynomial is (1 - v) Σ Wₖ vᵏ, where Wₖ = A₀ + … + Aₖ: if the second factor is
/// positive on `0..=1`, no root is earlier and the polynomial falls at this one. It is bounded from below on ever shorter stretches.
pub(crate) fn first_fall(a: &[f64], margin: f64) -> FirstFall {
    let sum: f64 = a.iter().sum();
    let Some((&start, rest)) = a.split_first() else { return FirstFall::Unclear };
    if start <= margin || !sum.is_finite() {
        return FirstFall::Unclear;
    }
    if sum > margin {
        return if is_above(a, margin) { FirstFall::Nowhere } else { FirstFall::Unclear };
    }
    let Some(root) = root(a, start, rest.first().copied().unwrap_or(0.0), sum) else { return FirstFall::Unclear };
    let mut factor = [0.0; MAX_DEGREE + 1];
    let (mut sum, mut power) = (0.0, 1.0);
    for (w, a) in factor.iter_mut().zip(a) {
        sum += a * power;
        *w = sum;
        power *= root;
    }
    if is_above(&factor[..a.len() - 1], margin) { FirstFall::At(root) } else { FirstFall::Unclear }
}

/// A root in `0..=1` of a polynomial that is positive at 0 and, but for rounding, not at 1.
fn root(a: &[f64], start: f64, slope: f64, end: f64) -> Option<f64> {
    // Where the parabola with this start, slope and end falls.
    let bend = end - start - slope;
    let discriminant = (slope * slope - 4.0 * bend * start).max(0.0).sqrt();
    let guess = if slope < 0.0 { 2.0 * start / (discriminant - slope) } else { (-slope - discriminant) / (2.0 * bend) };
    let (mut low, mut high) = (0.0, 1.0);
    let mut u = if guess > low && guess <= high { guess } else { 0.5 };
    for _ in 0..MOST_CORRECTIONS {
        let (value, slope) = value_and_slope(a, |a| *a, u);
        if value > 0.0 {
            low = u;
        } else {
            high = u;
        }
        let next = u - value / slope;
        if (next - u).abs() <= CLOSE * u {
            return (next <= 1.0).then_some(next);
        }
        u = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    None
}

/// Whether Σ aₖ uᵏ exceeds `margin` on `0..=1`.
fn is_above(a: &[f64], margin: f64) -> bool {
    let (rising, falling) = a.iter().fold((0.0, 0.0), |(up, down), a| (up + a.max(0.0), down + (-a).max(0.0)));
    let Some((&first, rest)) = a.split_first() else { return false };
    if first - falling > margin {
        return true;
    }
    let slope = rest.first().map_or(0.0, |a| a.max(0.0));
    let start = Terms { u: 0.0, rising: first.max(0.0), slope, falling: (-first).max(0.0) };
    exceeds(a, margin, &start, &Terms { u: 1.0, rising, slope: 0.0, falling }, DEEPEST)
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

/// Whether the tangent of the rising terms is above the chord of the falling ones, from one place to another or on both of its halves.
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

    #[test]
    fn what_is_clear_is_said() {
        assert_eq!(first_fall(&[1.0, -0.5], MARGIN), FirstFall::Nowhere);
        assert_eq!(first_fall(&[1.0, 0.0, -4.0], MARGIN), FirstFall::At(0.5));
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
        let FirstFall::At(u) = first_fall(&sine(3.5), MARGIN) else { panic!() };
        assert!((3.5 * u - std::f64::consts::PI).abs() < 1e-14);
    }

    #[test]
    fn what_is_not_is_not() {
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
            match first_fall(&a, MARGIN * a.iter().map(|a| a.abs()).sum::<f64>()) {
                FirstFall::At(u) => prop_assert!((u - roots[0]).abs() < 1e-4 * roots[0], "{u} {roots:?}"),
                FirstFall::Nowhere => prop_assert_eq!(within, 0),
                FirstFall::Unclear => {}
            }
        }
    }
}
