//! Halving an interval until bounds exclude a fall in each part, or show one.

use crate::certainty::{FAR, MINUTE, ROUGHLY, ROUNDINGS, SMALL, SURELY};
use crate::poly::{Bernstein, DIVIDED, Shape};

use super::departure::{Departure, order};
use super::looks::Look;
use super::probe::{AT_START, Part, Search, Side};
use super::proxy::Proxy;
use super::refine::Passage;
use super::{Crossing, Doubt, Evidence, Searched, Start, Undefined, settle};

/// Halvings after which signs at the ends decide.
const DEEPEST: u32 = 64;
/// Evaluations within one search, after which halving stops.
const MOST_EVALUATIONS: u32 = 20_000;

/// A rise from a root at the start is looked for at so many times, each nearer by the same part,
/// down to 2⁻³³ of the stretch.
const LOOKS_BACK: usize = 11;

/// An interval of the search.
pub(super) struct Stretch {
    a: f64,
    b: f64,
    depth: u32,
    /// How far the guard may be from its polynomial: from the given one, or from the
    /// interpolant on the interval of which this is a half.
    margin: f64,
    known: Option<Bernstein>,
}

/// What a stretch of the search looks like.
#[allow(clippy::large_enum_variant)] // looked at on the stack at once
enum Seen {
    /// A sample of the guard is no number.
    Undefined,
    /// The guard is above zero on the whole of it.
    Above,
    As(Proxy),
}

/// How the search goes on after a look at the shape of a polynomial.
enum Next {
    Part(Part),
    /// The guard is zero, and on this side of it.
    Zero(Side),
    /// Both halves are to be looked at.
    Halves,
    /// Samples are to be looked at.
    Looks,
}

impl Search<'_> {
    /// The search, for a polynomial that is given to within a margin or for interpolants.
    pub(super) fn first_fall(mut self, start: Start, known: Option<(Bernstein, f64)>) -> Result<Searched, Undefined> {
        let side = self.side_at(start)?;
        let margin = known.map_or(f64::INFINITY, |(_, margin)| margin);
        let all = Stretch { a: 0.0, b: self.span, depth: DEEPEST, margin, known: known.map(|(p, _)| p) };
        let mut part = self.part(&all, side)?;
        let fall = loop {
            let (a, b, guess) = match part {
                Part::None(_) => break None,
                Part::AtStart => {
                    let Some(end) = self.plateau() else { break Some(Crossing::at_start(self.span * AT_START)) };
                    self.flat = None;
                    let behind = Stretch { a: end, margin: f64::INFINITY, known: None, ..all };
                    part = self.part(&behind, Side::Inside)?;
                    continue;
                }
                Part::Hidden(near) => break Some(Crossing::after(self.inside_near(near)?)),
                Part::Fall { near: Some(near), .. } => break settle(&mut self.guard, near),
                Part::Fall { a, b, near: None } => (a, b, None),
                Part::Falls { a, b, guess } => (a, b, Some(guess)),
            };
            let found = self.refined(a, b, guess)?;
            let (passage, crossing) = (self.passage(&found), found.0);
            if passage != Passage::Pole {
                break Some(Crossing { leaps: passage == Passage::Leap, ..crossing });
            }
            (self.flat, self.largest) = (None, 0.0);
            let behind = Stretch { a: crossing.outside, margin: f64::INFINITY, known: None, ..all };
            part = self.part(&behind, Side::Outside)?;
        };
        if fall.is_some() {
            self.weaken(Evidence::Isolated);
        }
        Ok(Searched { fall, evidence: self.evidence, turn: self.turn })
    }

    /// On which side the search starts.
    fn side_at(&mut self, start: Start) -> Result<Side, Undefined> {
        let value = self.start()?;
        Ok(match start {
            Start::Spent => {
                (self.spent, self.base) = (true, value);
                Side::Wall
            }
            Start::Resumed if value == 0.0 => self.side_before(),
            Start::Open | Start::Resumed => Side::of(value, Side::Wall),
        })
    }

    /// On which side the guard was before it became zero at the start: at the last time that
    /// differs from it, however long ago in the same arc.
    fn side_before(&mut self) -> Side {
        let mut back = self.behind.min(self.span * MINUTE);
        while back > 0.0 {
            match Side::of((self.guard)(-back), Side::Wall) {
                Side::Wall if back < self.behind => back = self.behind.min(2.0 * back),
                side => return side,
            }
        }
        Side::Wall
    }

    fn part(&mut self, stretch: &Stretch, side: Side) -> Result<Part, Undefined> {
        let &Stretch { a, b, depth, ref known, .. } = stretch;
        if b - a <= SURELY * (b.next_up() - b) {
            return self.walked(a, b, side);
        }
        if side == Side::Wall && b <= self.span * AT_START {
            self.flat = Some(a);
            return Ok(Part::None(Side::Wall));
        }
        if depth == 0 || self.evaluations > MOST_EVALUATIONS {
            self.weaken(Evidence::doubtful(Doubt::Unresolved, a, b));
            return self.by_sign(a, b, side);
        }
        let proxy = match self.seen(stretch, side) {
            Seen::Above => {
                self.flat = None;
                return Ok(Part::None(Side::Inside));
            }
            Seen::As(proxy) => proxy,
            Seen::Undefined => return self.halved(stretch, f64::INFINITY, side),
        };
        let leaving = side == Side::Wall && a == 0.0;
        let mut margin = proxy.margin;
        if side == Side::Wall {
            let (roughness, base) = (self.roughness(b), self.base_of(stretch));
            if proxy.p.coefficients().iter().all(|value| (value - base).abs() < roughness) {
                return Ok(Part::None(Side::Wall));
            }
            margin += roughness;
        }
        if leaving && known.is_none() && !self.spent && self.is_under_a_rise(&proxy, b)? {
            return Ok(Part::None(Side::Inside));
        }
        let next = self.by_shape(stretch, &proxy, side, margin)?;
        match next {
            Next::Part(part) => {
                self.flat = None;
                Ok(part)
            }
            Next::Zero(side) => {
                self.flat = Some(self.flat.unwrap_or(a));
                Ok(Part::None(side))
            }
            Next::Halves => self.halved(stretch, margin, side),
            Next::Looks => self.by_looks(stretch, proxy.p.scale(), side, margin),
        }
    }

    /// The polynomial in place of the guard on a stretch: the one that is known, or its
    /// interpolant.
    fn seen(&mut self, stretch: &Stretch, side: Side) -> Seen {
        let &Stretch { a, b, depth, margin, known } = stretch;
        if let Some(p) = known {
            // Zero at the start: every power of time keeps its digits.
            let margin = if side == Side::Wall && a == 0.0 { p.rounding() } else { margin };
            return Seen::As(Proxy { p, margin, start: p.start(), end: p.end(), least: p.start() });
        }
        let Ok(samples) = self.sampled(a, b) else { return Seen::Undefined };
        if depth == DEEPEST && a == 0.0 {
            self.turn = samples.turn(b);
        }
        if side == Side::Inside && samples.stay_above() { Seen::Above } else { Seen::As(samples.proxy()) }
    }

    /// What the shape of the polynomial says of the guard, which is within `margin` of it. Long,
    /// for each case is an arm.
    fn by_shape(&mut self, stretch: &Stretch, proxy: &Proxy, side: Side, margin: f64) -> Result<Next, Undefined> {
        let &Stretch { a, b, margin: whole, ref known, .. } = stretch;
        let &Proxy { ref p, margin: sampled, start, end, least, .. } = proxy;
        let (leaving, scale) = (side == Side::Wall && a == 0.0, p.scale());
        let base = self.base_of(stretch);
        let (q, q_margin) = if leaving { (p.without_root_at_start(), DIVIDED * margin) } else { (*p, margin) };
        // A stretch of zeros has no slope, and no margin for one.
        if leaving && self.spent && known.is_none() && q.scale() > 0.0 {
            self.departure = Some(Departure::seen(self.departure, &q, b, sampled, self.roughness(b)));
            self.doubt_noise(&q, b, sampled)?;
        }
        // Halving shrinks the error of a smooth guard by hundreds; what does not shrink is the
        // guard's own rounding.
        let resolved = known.is_some() || margin <= SMALL * scale || margin >= ROUGHLY * whole;
        let from = self.flat.unwrap_or(a);
        if leaving
            && !self.spent
            && q.start() < -q_margin
            && (known.is_some() || least < -margin && self.falls_from_start(b, q.start())?)
        {
            // The samples may be too far apart to see that the guard rises first, unless it is a
            // polynomial as far as they show.
            let rises = known.is_none() && margin > MINUTE * scale && self.rises_first(b)?;
            return Ok(if rises { Next::Halves } else { Next::Part(Part::AtStart) });
        }
        let order = || Some(order(start - base, end - base, a, b));
        Ok(Next::Part(match q.shape(q_margin) {
            Shape::Above if side == Side::Outside => Part::None(Side::beside(start.max(end), side, base)),
            Shape::Above => Part::None(Side::Inside),
            Shape::Below => match side {
                Side::Inside => Part::Fall { a: from, b, near: None },
                Side::Outside => Part::None(Side::Outside),
                // The samples may be too far apart to see that the guard rises first.
                Side::Wall
                    if leaving
                        && known.is_none()
                        && (self.spent && q.start() > -FAR * sampled || self.rises_first(b)?) =>
                {
                    return Ok(Next::Halves);
                }
                Side::Wall if leaving => self.left(None, b),
                Side::Wall => self.left(order(), b),
            },
            Shape::Falling if resolved => match side {
                Side::Outside => Part::None(Side::Outside),
                Side::Wall if !leaving => self.left(order(), b),
                Side::Wall if q.start() <= q_margin => return Ok(Next::Looks),
                // Falling strictly from a zero, the rest of which is rounding, unless that goes on.
                Side::Inside if start == 0.0 => {
                    let falls = known.is_some() || self.value(a + AT_START * (b - a))? < 0.0;
                    Part::Fall { a, b, near: Some(a).filter(|_| falls) }
                }
                _ if end < 0.0 => match (q.root().map(|u| a + (b - a) * u), known) {
                    (Some(guess), None) if from == a => Part::Falls { a, b, guess },
                    (near, Some(_)) => Part::Fall { a: from, b, near },
                    (_, None) => Part::Fall { a: from, b, near: None },
                },
                _ => Part::None(Side::Inside),
            },
            Shape::Rising if resolved => match side {
                Side::Wall if q.end().abs() <= q_margin => return Ok(Next::Looks),
                // It falls first, and comes up again before the next sample.
                Side::Wall if leaving && !self.spent && q.start() < -q_margin => return Ok(Next::Halves),
                Side::Wall if !self.spent && self.rough == 0.0 && q.start() <= q_margin => return Ok(Next::Looks),
                Side::Wall => Part::None(Side::of(q.end(), side)),
                _ => Part::None(Side::beside(end, side, base)),
            },
            Shape::Flat if scale == 0.0 => return Ok(Next::Zero(side)),
            _ => return Ok(Next::Looks),
        }))
    }

    /// What samples say of a guard of this `scale` that is near zero by no more than a few margins,
    /// or goes in steps.
    fn by_looks(&mut self, stretch: &Stretch, scale: f64, side: Side, margin: f64) -> Result<Part, Undefined> {
        let &Stretch { a, b, ref known, .. } = stretch;
        let rounding = scale <= ROUNDINGS * margin && (known.is_some() || margin <= MINUTE * self.largest);
        // So large an error may come from a guard that goes in steps.
        if rounding || margin > SMALL * scale && self.stands(a, b)? {
            match self.looked(a, b, side)? {
                Look::Steps(part) => return Ok(part),
                Look::Rounding(part) if rounding => return Ok(part),
                // Too close to zero for the given polynomial, whose margin is that of the
                // whole step: its own values tell more.
                Look::Smooth if known.is_some() => {
                    return self.part(&Stretch { margin: f64::INFINITY, known: None, ..*stretch }, side);
                }
                Look::Rounding(_) | Look::Smooth => {}
            }
        }
        self.halved(stretch, margin, side)
    }

    /// A guard that comes up from its spent root as the square of time, the curve `q` with that
    /// root divided out, and is rough until then by more than rounding, its `margin`: two more
    /// crossings may hide there.
    fn doubt_noise(&mut self, q: &Bernstein, b: f64, margin: f64) -> Result<(), Undefined> {
        let (slope, bend) = (q.start().abs(), q.end());
        // A parabola through the root is nowhere before that farther from it than slope² / 4 bend.
        let hidden = bend > 0.0 && slope * slope < 4.0 * margin * bend;
        if hidden && self.is_rougher_than_rounding(margin) {
            let to = b * (slope / bend + (margin / bend).sqrt());
            if self.is_rough(0.0, to)? {
                self.weaken(Evidence::doubtful(Doubt::Rounding, 0.0, to));
            }
        }
        Ok(())
    }

    /// Where a spent root at the start lies on a stretch: a given polynomial is the change from it.
    fn base_of(&self, stretch: &Stretch) -> f64 {
        if stretch.known.is_some() { 0.0 } else { self.base }
    }

    /// Whether the guard is above its start, a root, anywhere in a row of times that shrink towards
    /// it.
    pub(super) fn rises_first(&mut self, b: f64) -> Result<bool, Undefined> {
        let mut s = b;
        for _ in 0..LOOKS_BACK {
            s *= ROUGHLY;
            if self.value(s)? - self.base > self.roughness(s) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the slope at the start, a `change` over `0..=b`, is the same over shorter
    /// times, and so not rounding.
    fn falls_from_start(&mut self, b: f64, change: f64) -> Result<bool, Undefined> {
        for part in [0.5, 0.25] {
            let shorter = self.sampled(0.0, part * b)?.proxy().p.without_root_at_start().start();
            if (shorter - part * change).abs() > ROUGHLY * part * change.abs() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn halved(&mut self, stretch: &Stretch, margin: f64, side: Side) -> Result<Part, Undefined> {
        self.weaken(Evidence::Isolated);
        let &Stretch { a, b, depth, ref known, .. } = stretch;
        let middle = 0.5 * (a + b);
        let (left, right) = match known.as_ref().map(Bernstein::halves) {
            Some((left, right)) => (Some(left), Some(right)),
            None => (None, None),
        };
        match self.part(&Stretch { a, b: middle, depth: depth - 1, margin, known: left }, side)? {
            Part::None(side) => self.part(&Stretch { a: middle, b, depth: depth - 1, margin, known: right }, side),
            found => Ok(found),
        }
    }

    /// The sign at the end alone.
    fn by_sign(&mut self, a: f64, b: f64, side: Side) -> Result<Part, Undefined> {
        let end = Side::beside(self.value(b)?, side, self.base);
        self.flat = None;
        Ok(if side == Side::Inside && end == Side::Outside { Part::Fall { a, b, near: None } } else { Part::None(end) })
    }
}
