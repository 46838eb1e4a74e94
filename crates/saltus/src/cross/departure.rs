//! Which way a guard leaves a spent root where rounding hides it: its slope there decides, which a long stretch shows to more digits than a short one.

use crate::poly::Bernstein;

use super::Undefined;
use super::search::{Part, Search, Side};
use super::{Leaves, Move};

/// What the stretches that begin at a spent root have shown of the guard there.
///
/// On a long stretch the interpolant errs by what it leaves out, on a short one by the guard's rounding over its length. The slope is known best on one
/// between them, which is remembered: so a rebound of 10⁻¹⁰ m/s is told though it rises by 10⁻²¹ m, a thousandth of what the guard is rounded by.
#[derive(Clone, Copy)]
pub(super) struct Departure {
    /// The slope at the root, and by how much it may be off.
    slope: f64,
    doubt: f64,
    /// The guard with that root divided out, on the stretch that shows the slope best, and its length.
    rest: Bernstein,
    length: f64,
}

/// A guard that is zero at the start is seen to rise from there where it is by this larger than it may be off.
const RISEN: f64 = 4.0;
/// A guard no larger than this many times its rounding may be hidden by it, where it was seen to rise on a longer stretch.
const HIDDEN: f64 = 64.0 * RISEN;
/// A slope up counts from this part of what it may be off by, which is taken with room: of ten million guards with clustered roots, two that fall at once seem to
/// rise with 0.27 and 0.30 of it, by chance.
const SURE: f64 = 0.4;

impl Departure {
    /// The guard with its root at the start of `0..=length` divided out, whose values are known to within `margin`.
    pub(super) fn seen(last: Option<Self>, rest: &Bernstein, length: f64, margin: f64) -> Self {
        let (slope, doubt) = (rest.start() / length, 16.0 * margin / length);
        match last {
            Some(last) if last.doubt <= doubt => last,
            _ => Self { slope, doubt, rest: *rest, length },
        }
    }

    /// Whether the guard rises from the root.
    fn rises(&self) -> bool {
        self.slope > SURE * self.doubt
    }

}

impl Search<'_> {
    /// Whether the guard, as `p` known to within `margin` and `least` of its values on `0..=b`, is nothing but rounding there, and was seen to rise on a longer
    /// stretch: so a floor lets go of a ball, which rises as the cube of time, for long not by a step of rounding.
    pub(super) fn is_under_a_rise(
        &mut self,
        p: &Bernstein,
        b: f64,
        least: f64,
        margin: f64,
    ) -> Result<bool, Undefined> {
        let nowhere_below = least > -margin;
        if nowhere_below && p.halves().0.end().min(p.end()) > RISEN * (margin + self.roughness(b)) {
            self.rise = Some(margin);
            return Ok(false);
        }
        // Of a smooth guard the margin would have shrunk with the stretch; of one that is seen number by number its steps have an order.
        let stays = |then: f64| 0.125 * then < margin && margin < 64.0 * then;
        Ok(self.rise.is_some_and(stays)
            && nowhere_below
            && p.end() < HIDDEN * margin
            && self.is_rough(0.0, 0.25 * b)?)
    }

    /// The guard is below the root at the start somewhere in `a..=b`, and was not above it before as
    /// far as its values show; by `change` at `b`. What it does first decides what that is.
    pub(super) fn left(&self, a: f64, b: f64, change: f64) -> Part {
        if !self.spent {
            return Part::AtStart;
        }
        match self.leaves {
            Leaves::Ask => Part::Unsure,
            Leaves::Known { first: Move::Falls { order }, .. } if order % 2 == 0 => Part::AtStart,
            Leaves::Known { first: Move::Falls { .. }, .. } => Part::None(Side::Outside),
            Leaves::Known { first: Move::Rises { slope }, noise } => {
                let hop = self.departure.filter(Departure::rises).and_then(|it| Some(it.rest.root()? * it.length));
                match hop.filter(|&root| root < b) {
                    Some(root) => Part::Hidden(root),
                    // What is left when the root is divided out falls from the slope to the chord.
                    None if change < -noise && slope > 0.0 => Part::Hidden(b * slope / (slope - change / b)),
                    None if change < -noise => Part::Hidden(a),
                    None => Part::None(Side::Wall),
                }
            }
            Leaves::Known { first: Move::Stays, .. } => Part::None(Side::Wall),
        }
    }

    /// Of the times close to a fall that rounding hides, the nearest at which rounding leaves the guard inside; or the fall, if there is none.
    pub(super) fn inside_near(&mut self, fall: f64) -> Result<f64, Undefined> {
        for k in 0..=16 {
            for s in [fall * (1.0 + f64::from(k) / 64.0), fall * (1.0 - f64::from(k) / 64.0)] {
                if self.value(s)? >= 0.0 {
                    return Ok(s);
                }
            }
        }
        Ok(fall)
    }
}
