//! Bounds instead of samples: how large a function gets, and how far two motions are apart.

use crate::motion::{Motion, Piece, Point, norm};

/// A bound is above what occurs by at most this part of it: rounded up to three digits it stays
/// what it would be.
pub(crate) const SLACK: f64 = 1.0 / 65_536.0;
/// Parts of a span after which a bound is taken as it is: a bound that is not sharp still holds.
const PARTS: u32 = 4096;
/// The slack of a bound of an error, in m: a millionth of a millimetre is shown as 0.
const FINE: f64 = 1e-12;

/// The largest distance of a curve, or of another motion, from a motion, in m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Miss {
    /// The largest difference of heights.
    pub height: f64,
    /// The largest distance in space.
    pub place: f64,
}

impl Miss {
    /// The same distances in another unit, of which `factor` make one of this.
    pub(crate) const fn times(self, factor: f64) -> Self {
        Self { height: self.height * factor, place: self.place * factor }
    }

    /// The worse of two.
    #[must_use]
    pub const fn or(self, other: Self) -> Self {
        Self { height: self.height.max(other.height), place: self.place.max(other.place) }
    }
}

/// The greatest value of `f` on a span, from above, or `least`; too large by at most [`SLACK`] of
/// it and by `fine`.
///
/// On [a, b] a function whose second derivative is at least -`curvature` is at most the greater of
/// f(a) and f(b) and curvature (b - a)²/8 more. A part in which that may be exceeded is halved.
pub(crate) fn most([a, b]: [f64; 2], curvature: f64, fine: f64, least: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut bound, mut occurs) = (least, f64::NEG_INFINITY);
    let (mut open, mut parts) = (vec![[(a, f(a)), (b, f(b))]], 0);
    while let Some([(a, p), (b, q)]) = open.pop() {
        let above = p.max(q) + 0.125 * curvature * (b - a) * (b - a);
        if above > bound {
            let middle = 0.5 * (a + b);
            let value = f(middle);
            occurs = occurs.max(p).max(q).max(value);
            parts += 1;
            if above <= occurs + SLACK * occurs.abs() + fine || parts > PARTS {
                bound = above;
            } else {
                open.extend([[(a, p), (middle, value)], [(middle, value), (b, q)]]);
            }
        }
    }
    bound
}

/// The distance of two motions in height and in space, as an upper bound: of pieces in order of
/// time, where both last.
pub(crate) fn apart<'a>(ones: impl Iterator<Item = &'a Piece>, others: impl Iterator<Item = &'a Piece>) -> Miss {
    let (mut ones, mut others) = (ones.peekable(), others.peekable());
    let mut miss = Miss::default();
    while let (Some(one), Some(other)) = (ones.peek(), others.peek()) {
        let [p, q] = [one, other].map(|piece| piece.start + piece.span);
        let (from, to) = (one.start.max(other.start), p.min(q));
        if to > from {
            miss = difference(one, other, [from, to]).most(miss);
        }
        if p <= q {
            ones.next();
        } else {
            others.next();
        }
    }
    miss
}

impl Motion {
    /// The distance of another motion of the same balls from this one, as an upper bound, while
    /// both last.
    ///
    /// ```
    /// use saltus_motion::{Motion, Piece, Stretch, Track};
    /// let still = |up: f64| {
    ///     let piece = Piece { start: 0.0, span: 1.0, coefficients: vec![[0.0, 0.0, up]], spin: Vec::new() };
    ///     let stretch = Stretch { contact: None, flight: true, pieces: vec![piece] };
    ///     Motion::new("still", vec![Track { name: "ball".into(), radius: 0.02, stretches: vec![stretch] }], Vec::new())
    /// };
    /// assert_eq!(still(2.0)?.apart(&still(1.5)?).height, 0.5);
    /// # Ok::<(), saltus_motion::MotionError>(())
    /// ```
    #[must_use]
    pub fn apart(&self, other: &Self) -> Miss {
        let pairs = self.tracks.iter().zip(&other.tracks);
        pairs.map(|(one, other)| apart(one.pieces(), other.pieces())).fold(Miss::default(), Miss::or)
    }
}

/// One piece less another, on a span that is within both.
pub(crate) fn difference(one: &Piece, other: &Piece, [from, to]: [f64; 2]) -> Piece {
    let [mut less, other] = [one, other].map(|piece| piece.part(from - piece.start, to - from));
    less.start = 0.0;
    less.coefficients.resize(less.coefficients.len().max(other.coefficients.len()), [0.0; 3]);
    for (c, by) in less.coefficients.iter_mut().zip(&other.coefficients) {
        *c = std::array::from_fn(|axis| c[axis] - by[axis]);
    }
    less
}

impl Piece {
    /// An upper bound of the length, in height and in space, or `known` where that is larger.
    fn most(&self, known: Miss) -> Miss {
        let (span, curvature) = ([0.0, self.span], self.bound(2));
        Miss {
            height: most(span, curvature[2], FINE, known.height, |s| self.at(s)[2].abs()),
            place: most(span, norm(&curvature), FINE, known.place, |s| norm(&self.at(s))),
        }
    }

    /// Whether no coordinate gets farther from 0 than `within`, nor a bound of it, which may be a
    /// little larger than it is.
    pub(crate) fn stays(&self, within: f64) -> bool {
        let (curvature, within) = (self.bound(2), (1.0 - 2.0 * SLACK) * within);
        (0..3).all(|axis| {
            let most = most([0.0, self.span], curvature[axis], 0.0, (1.0 - SLACK) * within, |s| self.at(s)[axis].abs());
            most <= within
        })
    }

    /// An upper bound of the derivative of an order, in each coordinate.
    pub(crate) fn bound(&self, order: usize) -> Point {
        let mut sum = [0.0; 3];
        // Horner's rule on Σ k (k - 1) ⋯ (k - order + 1) |cₖ| spanᵏ⁻ᵒʳᵈᵉʳ.
        for (k, c) in self.coefficients.iter().enumerate().skip(order).rev() {
            let falling: f64 = (0..order).map(|n| (k - n) as f64).product();
            sum = std::array::from_fn(|axis| sum[axis] * self.span + falling * c[axis].abs());
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bound of a parabola is its top, and of a wave hardly more than its own.
    #[test]
    fn a_bound_is_sharp_and_holds() {
        let parabola = |s: f64| s * (1.0 - s);
        assert_eq!(most([0.0, 1.0], 2.0, 0.0, 0.0, parabola), 0.25);
        for phase in 0..100_u32 {
            let wave = |s: f64| (7.0 * s + f64::from(phase)).sin();
            let bound = most([0.0, 3.0], 49.0, 0.0, 0.0, wave);
            assert!((1.0..=1.0 + 2.0 * SLACK).contains(&bound), "{bound}");
        }
        assert_eq!(most([0.0, 1.0], 2.0, 0.0, 0.5, parabola), 0.5);
        assert!(most([0.0, 1.0], f64::NAN, 0.0, 0.5, parabola) >= 0.5);
    }
}
