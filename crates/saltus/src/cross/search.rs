//! Halving an interval until bounds exclude a fall in each part, or show one.

use crate::poly::{Bernstein, Shape};

use super::departure::Departure;
use super::looks::{Look, order};
use super::refine::Passage;
use super::{Crossing, Doubt, Evidence, Searched, Start, Undefined, chebyshev, settle};

/// Halvings after which signs at the ends decide.
const DEEPEST: u32 = 64;
/// A fall within this fraction of the interval from its start is at its start.
pub(crate) const AT_START: f64 = 1.0 / (1_u64 << 60) as f64;
/// An interval that holds no more numbers than this is looked at number by number.
const FEW: f64 = 64.0;
/// Rounding is smaller than this fraction of the guard's largest magnitude.
pub(super) const ROUNDING: f64 = 1.0 / (1_u64 << 30) as f64;
/// The roughness of a guard on a step, as a part of how far it bends there: a dense output starts with the exact slope, but its
/// higher powers carry the error of the step and the rounding of its stages.
pub(crate) const ROUGH: f64 = 1e-6;
/// Roundings of a guard's largest value that its values near zero may be off by, where it cancels: what is rougher is no rounding.
const CANCELLED: f64 = 1024.0;
/// Evaluations within one search, after which halving stops.
const MOST_EVALUATIONS: u32 = 20_000;

/// A guard that falls from a spent root by this more than its samples leave open does so: that is the fall that was spent.
const SURELY: f64 = 1024.0;

/// Compiled once for every guard: it is much code, and a call through a table costs little beside a guard on a dense output.
pub(super) struct Search<'a> {
    pub(super) guard: &'a mut dyn FnMut(f64) -> f64,
    pub(super) span: f64,
    /// The spacing of the guard's own time, which may be coarser than that of numbers within the interval.
    pub(super) tick: f64,
    /// Whether the root at the start is spent.
    pub(super) spent: bool,
    /// The guard's value at a spent start.
    pub(super) base: f64,
    /// How the guard leaves a spent root at the start, as far as its samples have shown.
    pub(super) departure: Option<Departure>,
    /// What a guard on a step is rough by: close to its start, where the solution is zero but for rounding, it is known no better than
    /// to this times the square of the part of the step.
    rough: f64,
    /// Whether the guard falls from zero at the start as smoothly as a polynomial, so that zeros after it are rounding and no plateau.
    falls_smoothly: bool,
    /// How far a guard that is zero at an open start may have been off on the shortest stretch on which it was seen to rise from there.
    pub(super) rise: Option<f64>,
    evaluations: u32,
    /// The largest magnitude of the guard met so far.
    pub(super) largest: f64,
    /// Where the stretch on which the guard is zero, or nothing but rounding, began, if it is on one.
    pub(super) flat: Option<f64>,
    evidence: Evidence,
    /// Between which times the samples of the whole interval turn up from their least.
    turn: Option<[f64; 2]>,
}

/// On which side of its zero the guard is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Inside,
    Outside,
    /// On a root at the start, not yet left.
    Wall,
}

impl Side {
    /// A zero leaves the guard on the side it came from.
    pub(super) fn of(value: f64, came_from: Self) -> Self {
        if value > 0.0 {
            Self::Inside
        } else if value < 0.0 {
            Self::Outside
        } else {
            came_from
        }
    }
}

/// An interval of the search.
pub(super) struct Stretch {
    a: f64,
    b: f64,
    depth: u32,
    /// How far the guard may be from its polynomial: from the one that is known, or from the interpolant on the interval of which this is a half.
    margin: f64,
    known: Option<Bernstein>,
}

/// What a part of the interval holds.
pub(super) enum Part {
    /// Its first fall lies between these times; with the root, where the polynomial is exact.
    Fall { a: f64, b: f64, near: Option<f64> },
    /// Its only fall lies between these times, close to the `guess` of an interpolant.
    Falls { a: f64, b: f64, guess: f64 },
    /// The guard falls at once from the root at the start.
    AtStart,
    /// Rounding hides a rise and the fall after it, which lies here.
    Hidden(f64),
    /// No fall; this is where the guard is at the end.
    None(Side),
}

impl<'a> Search<'a> {
    /// A search for a guard that bends by `bend` on a step, or by nothing where no step's rounding spoils it, and sees times that are `tick` apart.
    pub(super) fn new(guard: &'a mut dyn FnMut(f64) -> f64, span: f64, bend: f64, tick: f64) -> Self {
        Self {
            guard,
            span,
            tick,
            spent: false,
            base: 0.0,
            departure: None,
            rough: ROUGH * bend,
            falls_smoothly: false,
            rise: None,
            evaluations: 0,
            largest: 0.0,
            flat: None,
            evidence: Evidence::Excluded,
            turn: None,
        }
    }

    pub(super) fn value(&mut self, s: f64) -> Result<f64, Undefined> {
        self.evaluations += 1;
        let value = (self.guard)(s);
        self.largest = self.largest.max(value.abs());
        if value.is_nan() { Err(Undefined(s)) } else { Ok(value) }
    }

    /// The search, for a polynomial that is known to within a margin or for interpolants.
    pub(super) fn first_fall(mut self, start: Start, known: Option<(Bernstein, f64)>) -> Result<Searched, Undefined> {
        let side = self.side_at(start)?;
        let margin = known.map_or(f64::INFINITY, |(_, margin)| margin);
        let all = Stretch { a: 0.0, b: self.span, depth: DEEPEST, margin, known: known.map(|(p, _)| p) };
        let mut part = self.part(&all, side)?;
        let fall = loop {
            let (a, b, guess) = match part {
                Part::None(_) => break None,
                Part::AtStart => break Some(Crossing::at_start(self.span * AT_START)),
                Part::Hidden(near) => break Some(Crossing::after(self.inside_near(near)?)),
                Part::Fall { near: Some(near), .. } => break settle(&mut self.guard, near),
                Part::Fall { a, b, near: None } => (a, b, None),
                Part::Falls { a, b, guess } => (a, b, Some(guess)),
            };
            let crossing = self.refined(a, b, guess)?;
            if self.passage(&crossing)? != Passage::Pole {
                break Some(crossing);
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
        let value = self.value(0.0)?;
        Ok(match start {
            Start::Spent => {
                (self.spent, self.base) = (true, value);
                Side::Wall
            }
            Start::Resumed if value == 0.0 => self.side_before(),
            Start::Open | Start::Resumed => Side::of(value, Side::Wall),
        })
    }

    /// On which side the guard was shortly before it became zero at the start: at the last time that differs from it.
    fn side_before(&mut self) -> Side {
        let mut back = self.span * ROUNDING;
        while back < self.span {
            match Side::of((self.guard)(-back), Side::Wall) {
                Side::Wall => back *= 2.0,
                side => return side,
            }
        }
        Side::Wall
    }

    pub(super) fn weaken(&mut self, evidence: Evidence) {
        self.evidence = self.evidence.and(evidence);
    }

    fn part(&mut self, stretch: &Stretch, side: Side) -> Result<Part, Undefined> {
        let &Stretch { a, b, depth, margin: whole, ref known } = stretch;
        if b - a <= FEW * (b.next_up() - b) {
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
        let proxy = if let Some(p) = known {
            Proxy { p: *p, margin: whole, start: p.start(), end: p.end(), least: p.start() }
        } else if let Ok(samples) = self.sampled(a, b) {
            if depth == DEEPEST && a == 0.0 {
                self.turn = samples.turn().map(|x| x.map(|x| 0.5 * b * (1.0 + x)));
            }
            if side == Side::Inside && samples.stay_above() {
                self.flat = None;
                return Ok(Part::None(Side::Inside));
            }
            samples.proxy()
        } else {
            return self.halved(stretch, f64::INFINITY, side);
        };
        let Proxy { p, mut margin, start, end, least } = proxy;
        let leaving = side == Side::Wall && a == 0.0;
        if leaving && known.is_some() {
            margin = 8.0 * f64::EPSILON * p.scale(); // zero at the start: every power of time keeps its digits
        }
        let sampled = margin;
        if side == Side::Wall {
            let (roughness, base) = (self.roughness(b), if known.is_some() { 0.0 } else { self.base });
            if p.coefficients().iter().all(|value| (value - base).abs() < roughness) {
                return Ok(Part::None(Side::Wall));
            }
            margin += roughness;
        }
        let (q, q_margin) = if leaving { (p.without_root_at_start(), 16.0 * margin) } else { (p, margin) };
        if leaving && !self.spent && known.is_none() && self.is_under_a_rise(&p, b, least, sampled)? {
            return Ok(Part::None(Side::Inside));
        }
        // A stretch of zeros tells nothing, and least of all that it is sure of it.
        if leaving && self.spent && known.is_none() && q.scale() > 0.0 {
            self.departure = Some(Departure::seen(self.departure, &q, b, sampled, self.roughness(b)));
            self.doubt_noise(&q, b, sampled)?;
        }
        // Halving shrinks the error of a smooth guard by hundreds; what does not shrink is the guard's own rounding.
        let resolved = known.is_some() || margin <= 1e-4 * p.scale() || margin >= 0.1 * whole;
        let scale = p.scale();
        let from = self.flat.unwrap_or(a);
        if leaving
            && !self.spent
            && q.start() < -q_margin
            && (known.is_some() || least < -margin && self.falls_from_start(b, q.start())?)
        {
            return Ok(Part::AtStart);
        }
        let decided = match q.shape(q_margin) {
            Shape::Above => Some(Part::None(Side::Inside)),
            Shape::Below => Some(match side {
                Side::Inside => Part::Fall { a: from, b, near: None },
                Side::Outside => Part::None(Side::Outside),
                // The samples may be too far apart to see that the guard rises first.
                Side::Wall
                    if leaving
                        && self.spent
                        && known.is_none()
                        && (q.start() > -SURELY * sampled || self.rises_first(b)?) =>
                {
                    return self.halved(stretch, margin, side);
                }
                Side::Wall if leaving => self.left(None, b),
                Side::Wall => self.left(Some(order(p.start(), p.end(), a, b)), b),
            }),
            Shape::Falling if resolved => match side {
                Side::Outside => Some(Part::None(Side::Outside)),
                Side::Wall if !leaving => Some(self.left(Some(order(p.start(), p.end(), a, b)), b)),
                Side::Wall if q.start() <= q_margin => {
                    self.falls_smoothly = true;
                    None
                }
                // Falling strictly from a zero, the rest of which is rounding.
                Side::Inside if start == 0.0 => Some(Part::Fall { a, b, near: Some(a) }),
                _ if end < 0.0 => Some(match (q.root().map(|u| a + (b - a) * u), known) {
                    (Some(guess), None) if from == a => Part::Falls { a, b, guess },
                    (near, Some(_)) => Part::Fall { a: from, b, near },
                    (_, None) => Part::Fall { a: from, b, near: None },
                }),
                _ => Some(Part::None(Side::Inside)),
            },
            Shape::Rising if resolved => match side {
                Side::Wall if q.end().abs() <= q_margin => None,
                Side::Wall if !self.spent && self.rough == 0.0 && q.start() <= q_margin => None,
                Side::Wall => Some(Part::None(Side::of(q.end(), side))),
                _ => Some(Part::None(Side::of(end, side))),
            },
            Shape::Flat if scale == 0.0 => {
                self.flat = Some(from);
                let plateau = side == Side::Wall && !self.spent && !self.falls_smoothly;
                return Ok(Part::None(if plateau { Side::Inside } else { side }));
            }
            _ => None,
        };
        if let Some(decided) = decided {
            self.flat = None;
            return Ok(decided);
        }
        let rounding = scale <= 8.0 * margin && (known.is_some() || margin <= ROUNDING * self.largest);
        if rounding || margin > 1e-3 * scale && self.stands(a, b)? {
            match self.looked(a, b, side)? {
                Look::Steps(part) => return Ok(part),
                Look::Rounding(part) if rounding => return Ok(part),
                // Too close to zero for the polynomial that is known, whose margin is that of the whole step: its own values tell more.
                Look::Smooth if known.is_some() => {
                    return self.part(&Stretch { margin: f64::INFINITY, known: None, ..*stretch }, side);
                }
                Look::Rounding(_) | Look::Smooth => {}
            }
        }
        self.halved(stretch, margin, side)
    }

    /// A guard that comes up from its spent root as the square of time, the curve `q` with that root divided out, and is rough until then by more than
    /// rounding, its `margin`: two more crossings may hide there.
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

    /// Whether values off by so much are off by more than a guard's cancellation explains.
    pub(super) fn is_rougher_than_rounding(&self, off: f64) -> bool {
        off > CANCELLED * f64::EPSILON * self.largest
    }

    /// How far a guard on a step may be off a time `s` after its start, if it is zero there.
    pub(super) fn roughness(&self, s: f64) -> f64 {
        self.rough * (s / self.span).powi(2)
    }

    /// Whether the guard is above its spent start anywhere in a row of times that shrink towards it.
    fn rises_first(&mut self, b: f64) -> Result<bool, Undefined> {
        let mut s = b;
        for _ in 0..8 {
            s *= 1.0 / 16.0;
            if self.value(s)? - self.base > self.roughness(s) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether the slope at the start, seen as a `change` over `0..=b`, is the same over shorter times, and so not rounding.
    fn falls_from_start(&mut self, b: f64, change: f64) -> Result<bool, Undefined> {
        for part in [0.5, 0.25] {
            let shorter = self.sampled(0.0, part * b)?.proxy().p.without_root_at_start().start();
            if (shorter - part * change).abs() > 0.2 * part * change.abs() {
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
        let end = Side::of(self.value(b)?, side);
        self.flat = None;
        Ok(if side == Side::Inside && end == Side::Outside { Part::Fall { a, b, near: None } } else { Part::None(end) })
    }

    /// The guard at the Chebyshev points of `[a, b]` and at two checks between them.
    fn sampled(&mut self, a: f64, b: f64) -> Result<Samples, Undefined> {
        let (centre, radius) = (0.5 * (a + b), 0.5 * (b - a));
        let mut values = [0.0; 9];
        for (value, x) in values.iter_mut().zip(chebyshev::NODES) {
            let s = if x == -1.0 {
                a
            } else if x == 1.0 {
                b
            } else {
                centre + radius * x
            };
            *value = self.value(s)?;
        }
        let series = chebyshev::series(&values);
        let mut off = 0.0_f64;
        for x in [-0.557_350_921, 0.271_828_183] {
            off = off.max((self.value(centre + radius * x)? - chebyshev::sum(&series, x)).abs());
        }
        let off = (series[7].abs() + series[8].abs()).max(off);
        // The nodes themselves are rounded, and the state at them likewise.
        let least = values.into_iter().fold(f64::INFINITY, f64::min);
        let spacing = (b.next_up() - b) / (b - a);
        Ok(Samples { series, off, spacing, start: values[0], end: values[8], least, values })
    }
}

/// A guard seen at the Chebyshev points of an interval.
struct Samples {
    series: [f64; 9],
    /// How far the guard is from its interpolant, as far as seen.
    off: f64,
    /// The spacing of numbers, as a part of the interval.
    spacing: f64,
    /// The guard at both ends.
    start: f64,
    end: f64,
    /// The least value seen.
    least: f64,
    /// All of them.
    values: [f64; 9],
}

impl Samples {
    /// Between which places in -1..=1 the interpolant turns up from its least value, unless that is at an end or clear of zero: above a half of what the
    /// interpolant varies by.
    fn turn(&self) -> Option<[f64; 2]> {
        let varies: f64 = self.series[1..].iter().map(|c| c.abs()).sum();
        if self.series[0] > 2.0 * varies {
            return None;
        }
        // T'ₖ(1) = k², T'ₖ(-1) = (-1)ᵏ⁻¹ k².
        let slope = |odd: f64| {
            let c = &self.series;
            odd * (c[1] + 9.0 * c[3] + 25.0 * c[5] + 49.0 * c[7]) + 4.0 * c[2] + 16.0 * c[4] + 36.0 * c[6] + 64.0 * c[8]
        };
        let lowest = (1..9).fold(0, |low, k| if self.values[k] < self.values[low] { k } else { low });
        let turns = match lowest {
            0 => slope(-1.0) > 0.0,
            8 => slope(1.0) > 0.0,
            _ => true,
        };
        turns.then(|| [chebyshev::NODES[lowest.max(1) - 1], chebyshev::NODES[(lowest + 1).min(8)]])
    }

    /// Whether the guard is positive on the whole interval for the size of the series alone (|`T_k`| ≤ 1, and its slope ≤ k²).
    fn stay_above(&self) -> bool {
        let (mut most, mut steepest, mut square) = (0.0, 0.0, 1.0);
        for (k, c) in self.series.iter().enumerate().skip(1) {
            most += c.abs();
            steepest += 2.0 * square * c.abs();
            square += (2 * k + 1) as f64;
        }
        let scale = self.series[0].abs() + most;
        self.series[0] > most + 8.0 * (self.off + steepest * self.spacing) + 16.0 * f64::EPSILON * scale
    }

    fn proxy(&self) -> Proxy {
        let p = Bernstein::new(&chebyshev::bernstein(&self.series));
        let margin = 8.0 * (self.off + p.steepest() * self.spacing) + 16.0 * f64::EPSILON * p.scale();
        let margin = if margin.is_finite() { margin } else { f64::INFINITY };
        Proxy { p, margin, start: self.start, end: self.end, least: self.least }
    }
}

/// A polynomial in place of the guard on an interval.
struct Proxy {
    p: Bernstein,
    margin: f64,
    /// The guard at both ends.
    start: f64,
    end: f64,
    /// The least value seen of it.
    least: f64,
}
