//! Which way a guard leaves a spent root where rounding hides it: its slope there decides, which a
//! long stretch shows to more digits than a short one.

use crate::certainty::{FAR, FEW, ROUGHLY, SURELY};
use crate::poly::{Bernstein, DIVIDED};

use super::Undefined;
use super::looks::order;
use super::proxy::Proxy;
use super::search::{Part, Search, Side};

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
    /// which it is seen to.
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
    fn rises(&self) -> bool {
        self.slope > SURE * self.doubt
    }

    /// Whether no slope stands out of the rounding for sure, and the guard falls as the square of
    /// time: the jump at a touch may change the slope's sign, and it is not to be lost then.
    pub(super) fn touches(&self) -> bool {
        self.slope > -SURELY * self.doubt && self.order.is_some_and(|order| order.round() == 2.0)
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

fn is_even(order: f64) -> bool {
    order.round().rem_euclid(2.0) == 0.0
}

impl Search<'_> {
    /// Whether the guard on `0..=b` is nothing but rounding, and rises on a longer
    /// stretch: so a floor lets go of a ball, which rises as the cube of time, for long not by a
    /// step of rounding.
    pub(super) fn is_under_a_rise(
        &mut self,
        &Proxy { ref p, margin, least, .. }: &Proxy,
        b: f64,
    ) -> Result<bool, Undefined> {
        let nowhere_below = least > -margin;
        if nowhere_below && p.halves().0.end().min(p.end()) > FEW * (margin + self.roughness(b)) {
            self.rise = Some(margin);
            return Ok(false);
        }
        // Of a smooth guard the margin would have shrunk with the stretch; of one that is seen
        // number by number its steps have an order.
        let stays = |then: f64| ROUGHLY * then < margin && margin < SURELY * then;
        Ok(self.rise.is_some_and(stays)
            && nowhere_below
            && p.end() < SURELY * FEW * margin
            && self.is_rough(0.0, ROUGHLY * b)?)
    }

    /// The guard has left the root at the start to below zero within `0..=b`, as tᵐ with m =
    /// `order` where that was seen.
    ///
    /// If the root is spent and m is odd, this is the fall that was spent; with m even it only
    /// touched zero there, and falls again. Where rounding hides which it was, what longer
    /// stretches have shown decides; and if they show that the guard rises first, it falls where
    /// their polynomial does.
    pub(super) fn left(&mut self, order: Option<f64>, b: f64) -> Part {
        if !self.spent {
            return Part::AtStart;
        }
        let told = self.departure.filter(|it| order.is_none() || it.is_far(b));
        if let Some(it) = told.filter(Departure::rises)
            && let Some(root) = it.rest.root()
            && root * it.length > self.tick
        {
            return Part::Hidden(root * it.length);
        }
        let linear = order.is_some_and(|order| order.round() <= 1.0);
        let touched = if order.is_some_and(is_even) {
            Some(b)
        } else {
            told.filter(|it| !linear && it.touches()).map(|it| it.length)
        };
        if touched.is_some_and(|b| !self.comes_from_above(b)) { Part::AtStart } else { Part::None(Side::Outside) }
    }

    /// Whether the guard came to its spent root from above, along the flow that leaves it: a time
    /// `b` before the root it is above it by half of what it is below it as long after, or more.
    fn comes_from_above(&mut self, b: f64) -> bool {
        let [before, after] = [-b, b].map(|s| (self.guard)(s) - self.base);
        before > -0.5 * after
    }

    /// Of the times close to a fall that rounding hides, the nearest at which rounding leaves the
    /// guard inside; or the fall, if there is none.
    pub(super) fn inside_near(&mut self, fall: f64) -> Result<f64, Undefined> {
        for k in 0..=16 {
            for s in [fall * (1.0 + f64::from(k) * ROUGHLY * ROUGHLY), fall * (1.0 - f64::from(k) * ROUGHLY * ROUGHLY)]
            {
                if self.value(s)? >= 0.0 {
                    return Ok(s);
                }
            }
        }
        Ok(fall)
    }
}
