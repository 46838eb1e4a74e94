//! A guard looked at sample by sample, where no polynomial fits it: close to the numbers' own
//! spacing, or down in its rounding.

use super::departure::order;
use super::probe::{LOOKS, MOST_TURNS, Part, Search, Side};
use super::{Doubt, Evidence, Undefined};
use crate::certainty::{FEW, ROUGHLY};

/// So many samples are taken of each step at least: with fewer, halves that are rounded to even
/// could hide every other one.
const PER_STEP: usize = 4;
impl Search<'_> {
    fn walk(&mut self, a: f64, side: Side) -> Walk {
        Walk { side, last: self.flat.take().unwrap_or(a), base: self.base, tick: self.tick, rose: f64::NEG_INFINITY }
    }

    /// Number by number.
    pub(super) fn walked(&mut self, a: f64, b: f64, side: Side) -> Result<Part, Undefined> {
        let mut walk = self.walk(a, side);
        let mut s = a;
        while s < b {
            s = s.next_up();
            match walk.to(s, self.value(s)?, self.roughness(s)) {
                Tread::Falls => return Ok(Part::Fall { a: walk.last, b: s, near: None }),
                Tread::FallsAtStart if !self.spent => return Ok(Part::AtStart),
                _ => {}
            }
        }
        Ok(self.passed(side, walk.side, b))
    }

    /// A walk from one side to another, on which no sample falls but from the start; the signs
    /// of its steps count.
    fn passed(&mut self, from: Side, to: Side, b: f64) -> Part {
        if from == Side::Wall && to == Side::Outside { self.left(Some(1.0), b) } else { Part::None(to) }
    }

    /// Samples of a guard that no polynomial fits.
    pub(super) fn looked(&mut self, a: f64, b: f64, side: Side) -> Result<Look, Undefined> {
        let (samples, turns) = self.samples(a, b)?;
        let last = samples[LOOKS - 1].1;
        let steps = samples.chunk_by(|x, y| x.1 == y.1).count();
        if turns > MOST_TURNS {
            return Ok(Look::Rounding(self.seen_through(&samples, a, b, side)));
        }
        if steps > LOOKS / PER_STEP {
            return Ok(Look::Smooth);
        }
        let mut walk = self.walk(a, side);
        for (s, value) in samples {
            match walk.to(s, value, self.roughness(s)) {
                Tread::Falls => return Ok(Look::Steps(Part::Fall { a: walk.last, b: s, near: None })),
                // Samples may be too far apart to see that the guard rises first.
                Tread::FallsAtStart if !self.spent && a == 0.0 && self.rises_first(b)? => return Ok(Look::Smooth),
                Tread::FallsAtStart if !self.spent => return Ok(Look::Steps(Part::AtStart)),
                _ => {}
            }
        }
        if side == Side::Wall && walk.side == Side::Outside {
            // Steps of rounding are of one length where the guard falls with speed; without speed
            // it stands longest on the first.
            let lengths = || samples.chunk_by(|x, y| x.1 == y.1).map(<[_]>::len);
            let (first, second) = (lengths().next().unwrap_or(0), lengths().nth(1).unwrap_or(0));
            let (half, at_half) = samples[LOOKS / 2];
            let slow = samples[0].1 == self.base && first > second;
            // Ups and downs hide that, and so do values that are rounded this way and that (of
            // time, the steps are of one length always); a longer stretch may show it.
            let whole = || lengths().take(steps - 1);
            let of_value = whole().max() > whole().min().map(|least| 3 * least);
            let far = self.departure.filter(|it| it.touches() && it.is_far(b));
            // The slope that it allows is too small for this fall: two steps, one twice as far as
            // the other, are not its sign.
            let without_speed = far.is_some_and(|it| it.steepest() * b < ROUGHLY * (self.base - last));
            let slow = slow || far.is_some() && turns > 0 || without_speed && of_value;
            let order = if slow && without_speed {
                2.0
            } else if slow {
                order(at_half - self.base, last - self.base, half, b)
            } else {
                1.0
            };
            return Ok(Look::Steps(self.left(Some(order), b)));
        }
        Ok(Look::Steps(Part::None(walk.side)))
    }

    /// What is left of samples when all that is as small as their rounding counts as zero.
    fn seen_through(&mut self, samples: &[(f64, f64); LOOKS], a: f64, b: f64, side: Side) -> Part {
        let bend = |three: &[(f64, f64)]| (three[1].1 - 0.5 * (three[0].1 + three[2].1)).abs();
        let rounding = FEW * samples.windows(3).map(bend).fold(0.0, f64::max);
        let came_from = side;
        let mut side = side;
        let mut hidden: Option<(f64, f64)> = None;
        let mut seen = false;
        for &(s, value) in samples {
            if value.abs() <= rounding {
                hidden = Some((hidden.map_or(s, |(from, _)| from), s));
                continue;
            }
            let next = Side::beside(value, side, self.base);
            if side == Side::Inside && next == Side::Outside {
                return Part::Fall { a: self.flat.unwrap_or(a), b: s, near: None };
            }
            (side, seen) = (next, true);
        }
        // A guard that leaves the wall slowly is nothing but rounding of its values at first, which
        // hides nothing.
        let leaves = came_from == Side::Wall && !self.is_rougher_than_rounding(rounding);
        if let Some((from, to)) = hidden.filter(|_| !leaves) {
            self.weaken(Evidence::doubtful(Doubt::Rounding, from, to));
        }
        self.flat = if seen { None } else { Some(self.flat.unwrap_or(a)) };
        if came_from == Side::Wall && side == Side::Outside {
            return self.left(None, b);
        }
        Part::None(side)
    }
}

/// What samples of a guard show that no polynomial fits.
pub(super) enum Look {
    /// Steps of rounding, sampled one by one: their signs count.
    Steps(Part),
    /// Ups and downs without order, and what stands out of them.
    Rounding(Part),
    /// Neither: it is to be looked at more closely.
    Smooth,
}

/// A walk from sample to sample.
struct Walk {
    side: Side,
    /// The last sample that was inside, or on the wall.
    last: f64,
    base: f64,
    /// How far apart times are: what rises from below zero and falls within as much has not risen.
    tick: f64,
    /// When it last rose from below zero.
    rose: f64,
}

impl Walk {
    /// What the guard has done on the way to `s`.
    fn to(&mut self, s: f64, value: f64, roughness: f64) -> Tread {
        let side = match self.side {
            Side::Wall if (value - self.base).abs() <= roughness => Side::Wall,
            Side::Wall => Side::of(value - self.base, Side::Wall),
            side => Side::beside(value, side, self.base),
        };
        if (self.side, side) == (Side::Outside, Side::Inside) {
            self.rose = s;
        }
        let tread = match (self.side, side) {
            (Side::Inside, Side::Outside) if s - self.rose >= self.tick => return Tread::Falls,
            (Side::Wall, Side::Outside) => Tread::FallsAtStart,
            _ => Tread::Stays,
        };
        (self.side, self.last) = (side, s);
        tread
    }
}

/// What the guard does between two samples.
enum Tread {
    Falls,
    FallsAtStart,
    Stays,
}
