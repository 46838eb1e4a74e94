//! How a guard leaves a root at the start: by a fall, by a rise that rounding hides, or by a touch.

use crate::certainty::{FEW, ROUGHLY, ROUNDINGS, SMALL, SURELY};

use super::departure::Departure;
use super::probe::{AT_START, Part, Search, Side};
use super::proxy::Proxy;
use super::{Undefined, neighbours};

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
        // Of a smooth guard the margin would have shrunk with the stretch; of one that is walked
        // number by number its steps have an order.
        let stays = |then: f64| ROUGHLY * then < margin && margin < SURELY * then;
        Ok(self.rise.is_some_and(stays)
            && nowhere_below
            && p.end() < SURELY * FEW * margin
            && self.is_rough(0.0, ROUGHLY * b)?)
    }

    /// When a guard that is zero at an open start, and then for a while, is no longer, or is no
    /// number; none where rounding makes these zeros, whose first step then stands for a good part
    /// of their time.
    pub(super) fn plateau(&mut self) -> Option<f64> {
        let mut beyond = self.span * AT_START;
        if self.spent || (self.guard)(beyond) != 0.0 {
            return None;
        }
        while beyond < self.span && (self.guard)(beyond) == 0.0 {
            beyond = self.span.min(2.0 * beyond);
        }
        let sign = |s: f64| if (self.guard)(s) == 0.0 { 0.0 } else { -1.0 };
        let (last, first) = neighbours(sign, 0.0, beyond);
        let stands = (self.guard)(first) == (self.guard)(first + SMALL * last);
        Some(last).filter(|_| !stands)
    }

    /// The guard has left the root at the start to below zero within `0..=b`, as tᵐ with m =
    /// `order` where that is found.
    ///
    /// If the root is spent and m is odd, this is the fall that was spent; with m even it only
    /// touched zero there, and falls again, unless it came to fall. Where rounding hides which it
    /// was, what longer stretches have shown decides; and if they show that the guard rises first,
    /// it falls where their polynomial does.
    pub(super) fn left(&mut self, order: Option<f64>, b: f64) -> Part {
        if !self.spent {
            return Part::AtStart;
        }
        let shown = self.departure.filter(|it| order.is_none() || it.is_far(b));
        if let Some(it) = shown.filter(Departure::rises)
            && let Some(fall) = it.falls()
            && fall > self.tick
        {
            return Part::Hidden(fall);
        }
        let linear = order.is_some_and(|order| order.round() <= 1.0);
        let touched = if order.is_some_and(is_even) {
            Some(b)
        } else {
            shown.filter(|it| !linear && it.touches()).map(|it| it.length())
        };
        if touched.is_some_and(|b| !self.came_to_fall(b)) { Part::AtStart } else { Part::None(Side::Outside) }
    }

    /// Whether the guard came to its spent root from above or along a plateau, on the flow that
    /// leaves it: a time `b` before the root it is above it by half of what it is below it as long
    /// after, or more; or it has been zero for long, and not for a step of rounding.
    fn came_to_fall(&mut self, b: f64) -> bool {
        let [before, after] = [-b, b].map(|s| (self.guard)(s) - self.base);
        let mut is_zero = |times: f64| (self.guard)(-times * b) == 0.0;
        before > -0.5 * after || self.base == 0.0 && [1.0, FEW, ROUNDINGS, SURELY].into_iter().all(&mut is_zero)
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

fn is_even(order: f64) -> bool {
    order.round().rem_euclid(2.0) == 0.0
}
