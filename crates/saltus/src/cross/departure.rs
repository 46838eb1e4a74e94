//! Which way a guard leaves a spent root where rounding hides it: its slope there decides, which a
//! long stretch shows to more digits than a short one.

use crate::certainty::{FAR, SURELY};
use crate::poly::{Bernstein, DIVIDED};

/// What the stretches that begin at a spent root have shown of the guard there.
///
/// On a long stretch the interpolant errs by what it leaves out, on a short one by the guard's
/// rounding over its length. The slope is best determined on one between them, which is remembered:
/// so a rebound of 10⁻¹⁰ m/s is found though it rises by 10⁻²¹ m, a thousandth of what the guard is
/// rounded by.
#[derive(Clone, Copy)]
pub(super) struct Departure {
    /// The slope at the root, and by how much it may be off.
    slope: f64,
    doubt: f64,
    /// The guard with that root divided out, on the stretch that shows the slope best, and its
    /// length.
    rest: Bernstein,
    length: f64,
    /// The m of the power tᵐ as which the guard falls from the root, on the shortest stretch on
    /// which its samples fall.
    order: Option<f64>,
}

/// A slope up counts from this part of what it may be off by, which is taken with room: of ten
/// million guards with clustered roots, two that fall at once seem to rise with 0.27 and 0.30 of
/// it, by chance.
/// Held by `planted::a_run_finds_each_crossing_once`.
const SURE: f64 = 0.4;

impl Departure {
    /// The guard with its root at the start of `0..=length` divided out, whose values are exact to
    /// within `margin`, and away from the start to `roughness` more.
    pub(super) fn seen(last: Option<Self>, rest: &Bernstein, length: f64, margin: f64, roughness: f64) -> Self {
        let (slope, doubt) = (rest.start() / length, DIVIDED * margin / length);
        let mut best = match last {
            Some(last) if last.doubt <= doubt => last,
            _ => Self { slope, doubt, rest: *rest, length, order: last.and_then(|last| last.order) },
        };
        let (half, end) = (0.5 * rest.halves().0.end(), rest.end());
        if half < -SURELY * (margin + roughness) {
            best.order = Some(order(half, end, 0.5, 1.0));
        }
        best
    }

    /// Whether the guard rises from the root.
    pub(super) fn rises(&self) -> bool {
        self.slope > SURE * self.doubt
    }

    /// Whether no slope stands out of the rounding for sure, and the guard falls as the square of
    /// time: the jump at a touch may change the slope's sign, and it is not to be lost then.
    pub(super) fn touches(&self) -> bool {
        self.slope > -SURELY * self.doubt && self.order.is_some_and(|order| order.round() == 2.0)
    }

    /// When the polynomial on the best stretch falls through zero.
    pub(super) fn falls(&self) -> Option<f64> {
        self.rest.root().map(|root| root * self.length)
    }

    /// How long that stretch is.
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// The steepest fall that the slope allows.
    pub(super) fn steepest(&self) -> f64 {
        self.slope.abs() + self.doubt
    }

    /// Whether it comes from a stretch so long that it is better than steps of rounding within
    /// `0..=b`.
    pub(super) fn is_far(&self, b: f64) -> bool {
        self.length > FAR * b
    }
}

/// The m with which c tᵐ takes these values at times `a` and `b`.
pub(super) fn order(at_a: f64, at_b: f64, a: f64, b: f64) -> f64 {
    (at_b / at_a).ln() / (b / a).ln()
}
