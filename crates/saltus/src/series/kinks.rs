//! Where a flow has kinks along a series: where a number comes to zero of which it takes the
//! absolute value.

use std::cell::RefCell;

use super::Row;
use crate::cross::{Fall, FirstFall, Powers};

/// A number of which a flow takes the absolute value.
struct Kink {
    /// Its place among the numbers that the flow comes by.
    place: usize,
    /// Its sign just after the start of the series; 0 as long as its coefficients are.
    sign: f64,
    /// Whether it is at zero there, and the sign is that with which it leaves.
    turned: bool,
}

/// The numbers of which a flow takes the absolute value.
pub(crate) struct Kinks(RefCell<Vec<Kink>>);

/// The next kink along a series.
pub(crate) enum NextKink {
    /// None as far as was asked.
    Nowhere,
    /// After so many units of time the number at this `place` changes its sign; after none, it is
    /// about to.
    At { units: f64, place: usize },
    /// The coefficients do not show whether there is one up to there.
    Unclear { units: f64 },
}

impl Kinks {
    pub(super) const fn new() -> Self {
        Self(RefCell::new(Vec::new()))
    }

    /// Forgets all but the one at a place, if that is where a series is to start.
    pub(super) fn clear_but(&mut self, kept: Option<usize>) {
        self.0.get_mut().retain(|kink| Some(kink.place) == kept);
    }

    /// The sign of the number at a place whose first coefficient that is not zero, as far as is
    /// given, is this: that of it, unless the number has turned.
    pub(super) fn sign(&self, place: usize, leading: f64) -> f64 {
        let sign = if leading == 0.0 { 0.0 } else { leading.signum() };
        let mut kinks = self.0.borrow_mut();
        let Some(kink) = kinks.iter_mut().find(|kink| kink.place == place) else {
            kinks.push(Kink { place, sign, turned: false });
            return sign;
        };
        if !kink.turned {
            kink.sign = sign;
        }
        kink.sign
    }

    /// The number at a place has changed its sign where a series is to start.
    pub(super) fn turn(&mut self, place: usize) {
        for kink in self.0.get_mut() {
            if kink.place == place {
                (kink.sign, kink.turned) = (-kink.sign, true);
            }
        }
    }

    /// The next kink along a series of this `order` with these `rows`, up to so many units of time.
    pub(super) fn next<'a>(&self, rows: impl Fn(usize) -> &'a Row, order: usize, span: f64) -> NextKink {
        let (mut next, mut span, mut unclear) = (NextKink::Nowhere, span, false);
        let kinks = self.0.borrow();
        let fall = |kink: &Kink, span: f64| kink.fall(rows(kink.place), order, span);
        for kink in kinks.iter() {
            match fall(kink, span) {
                FirstFall::Nowhere => {}
                FirstFall::Unclear => unclear = true,
                FirstFall::At(Fall { u: 0.0, .. }) => return NextKink::At { units: 0.0, place: kink.place },
                FirstFall::At(Fall { u, .. }) => {
                    span *= u;
                    next = NextKink::At { units: span, place: kink.place };
                }
            }
        }
        // What is not clear up to another kink, or beyond it?
        unclear = unclear && kinks.iter().any(|kink| fall(kink, span) == FirstFall::Unclear);
        if unclear { NextKink::Unclear { units: span } } else { next }
    }
}

impl Kink {
    /// Where on the way to `span` the number falls through zero from the side on which it starts:
    /// at once, if it starts at zero and is about to.
    fn fall(&self, row: &Row, order: usize, span: f64) -> FirstFall {
        let sign = self.sign;
        if sign == 0.0 {
            return FirstFall::Nowhere;
        }
        let mut powers = Powers::new();
        powers.fill(sign * row[0].get(), &row[1..=order], |c| sign * c.get(), span);
        let (a, margin) = (powers.coefficients(), powers.rounding());
        // What it leaves zero by, if it starts there.
        let Some(leading) = a.iter().position(|a| a.abs() > margin) else { return FirstFall::Unclear };
        if leading > 0 && a[leading] < 0.0 && !self.turned {
            return FirstFall::At(Fall { u: 0.0, slope: a[1], bend: a.get(2).copied().unwrap_or(0.0) });
        }
        match powers.first_fall(leading, margin) {
            // At the very end it is the next step's.
            FirstFall::At(_) if powers.end() >= -margin => FirstFall::Nowhere,
            fall => fall,
        }
    }
}
