//! Where a flow has kinks along a series: where a number comes to zero of which it takes the absolute value.

use std::cell::RefCell;

use super::Row;
use crate::cross::{FirstFall, Powers};

/// How far a number must be from zero, as a part of what it changes by, not to be there but for rounding.
const SURELY: f64 = 64.0 * f64::EPSILON;

/// A number of which a flow takes the absolute value.
#[derive(Clone, Copy)]
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NextKink {
    /// None as far as was asked.
    Nowhere,
    /// After so many units of time the number at this `place` changes its sign; after none, it is about to.
    At { units: f64, place: usize },
    /// The coefficients do not show whether there is one up to there.
    Unclear { units: f64 },
}

impl Kinks {
    pub(super) const fn new() -> Self {
        Self(RefCell::new(Vec::new()))
    }

    pub(super) fn clear(&mut self) {
        self.0.get_mut().clear();
    }

    pub(super) fn clear_but(&mut self, kept: Option<usize>) {
        self.0.get_mut().retain(|kink| Some(kink.place) == kept);
    }

    /// The sign of the number at a place whose first coefficient that is not zero, as far as is known, is this: that of it, unless the number has turned.
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
        let (mut next, mut span) = (NextKink::Nowhere, span);
        let kinks = self.0.borrow();
        let mut unclear = 0;
        for kink in kinks.iter() {
            match kink.next(rows(kink.place), order, span) {
                NextKink::Nowhere => {}
                NextKink::Unclear { .. } => unclear += 1,
                at @ NextKink::At { units, .. } => (next, span) = (at, units),
            }
        }
        // What is not clear up to another kink, or beyond it?
        let still = |kink: &Kink| matches!(kink.next(rows(kink.place), order, span), NextKink::Unclear { .. });
        if unclear > 0 && kinks.iter().any(still) { NextKink::Unclear { units: span } } else { next }
    }
}

impl Kink {
    fn next(&self, row: &Row, order: usize, span: f64) -> NextKink {
        if self.sign == 0.0 {
            return NextKink::Nowhere;
        }
        let (place, sign) = (self.place, self.sign);
        let mut powers = Powers::new();
        powers.fill(sign * row[0].get(), &row[1..=order], |c| sign * c.get(), span);
        let a = powers.coefficients();
        let margin = SURELY * (a[0].abs() + powers.change());
        // What it leaves zero by, if it starts there.
        let Some(leading) = a.iter().position(|a| a.abs() > margin) else { return NextKink::Unclear { units: span } };
        if leading > 0 && a[leading] < 0.0 && !self.turned {
            return NextKink::At { units: 0.0, place };
        }
        let fall = if leading == 0 { powers.first_fall(margin) } else { powers.first_fall_from(leading, margin) };
        match fall {
            FirstFall::Nowhere => NextKink::Nowhere,
            // At the very end it is the next step's.
            FirstFall::At(_) if a.iter().sum::<f64>() >= -margin => NextKink::Nowhere,
            FirstFall::At(u) => NextKink::At { units: u * span, place },
            FirstFall::Unclear => NextKink::Unclear { units: span },
        }
    }
}
