//! Where a guard first falls through zero: excluded by bounds, isolated by halving, refined to neighbouring times.

pub(crate) mod chebyshev;
mod refine;

use crate::poly::{Bernstein, Shape};

pub(crate) use refine::settle;

/// A fall through zero between two neighbouring times: the guard is not negative at `inside` and negative at `outside`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The last time still inside the domain.
    pub inside: f64,
    /// The first time outside.
    pub outside: f64,
    /// The best estimate of the root, within rounding of both: where `inside` lies early by up to a rounding, this has no bias.
    pub root: f64,
    /// What rounding takes from the root: it lies at `root + rest`, by the guard's values on both sides.
    pub rest: f64,
}

impl Crossing {
    /// A crossing at the very start.
    pub(crate) const fn at_start(outside: f64) -> Self {
        Self { inside: 0.0, outside, root: 0.0, rest: 0.0 }
    }
}

/// What the guard does at the start of the interval searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Nothing special: a fall that begins with a zero at the start counts.
    Open,
    /// The guard is zero at the start but for rounding because its edge was just taken: that root is divided out.
    Spent,
    /// The search goes on where an earlier one ended: a guard that is zero here is on the side it came from.
    Resumed,
}

/// How a search came to its result.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Evidence {
    /// Bounds on the guard over the whole interval leave no room for a fall.
    Excluded,
    /// The interval was halved until bounds left no room for a fall in any part, or a single fall in the first part that has one.
    Isolated,
    /// Between these times the guard is nothing but rounding: a touch, or two crossings so close that its values do not show them.
    /// It was taken for zero there.
    Rounding {
        /// Where that begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// Between these times the guard varies too fast to be resolved within the limit on evaluations: only the signs at both ends were used.
    Unresolved {
        /// Where that begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
}

impl Evidence {
    /// Whether a crossing may have been missed.
    #[must_use]
    pub const fn is_doubtful(&self) -> bool {
        matches!(self, Self::Rounding { .. } | Self::Unresolved { .. })
    }

    /// The weaker of two.
    pub(crate) fn and(self, other: Self) -> Self {
        let rank = |evidence: &Self| match evidence {
            Self::Excluded => 0,
            Self::Isolated => 1,
            Self::Rounding { .. } => 2,
            Self::Unresolved { .. } => 3,
        };
        match (self, other) {
            (Self::Rounding { from, .. }, Self::Rounding { to, .. }) => Self::Rounding { from, to },
            (Self::Unresolved { from, .. }, Self::Unresolved { to, .. }) => Self::Unresolved { from, to },
            _ if rank(&other) > rank(&self) => other,
            _ => self,
        }
    }

    /// The same with its times counted from a moment `s` earlier.
    pub(crate) fn later(self, s: f64) -> Self {
        match self {
            Self::Rounding { from, to } => Self::Rounding { from: from + s, to: to + s },
            Self::Unresolved { from, to } => Self::Unresolved { from: from + s, to: to + s },
            other => other,
        }
    }
}

/// The outcome of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Searched {
    /// The first fall, if there is one.
    pub fall: Option<Crossing>,
    /// What speaks for it.
    pub evidence: Evidence,
}

impl Searched {
    /// By a formula.
    pub(crate) const fn solved(fall: Option<Crossing>) -> Self {
        Self { fall, evidence: if fall.is_some() { Evidence::Isolated } else { Evidence::Excluded } }
    }
}

/// The outcome of a search that could not finish: the guard is not a number at this time, before any fall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undefined(pub f64);

/// Halvings after which signs at the ends decide.
const DEEPEST: u32 = 64;
/// A fall within this fraction of the interval from its start is at its start.
const AT_START: f64 = 1.0 / (1_u64 << 60) as f64;
/// An interval that holds no more numbers than this is looked at number by number.
const FEW: f64 = 64.0;
/// How many samples are taken of a guard that seems to be nothing but rounding.
const LOOKS: usize = 128;
/// If they change direction no more often than this, they are not rounding and their signs count.
const MOST_TURNS: usize = 8;
/// Rounding is smaller than this fraction of the guard's largest magnitude.
const ROUNDING: f64 = 1.0 / (1_u64 << 30) as f64;
/// The roughness of a guard on a step, as a part of how far it bends there: a dense output starts with the exact slope, but its
/// higher powers carry the error of the step and the rounding of its stages.
const ROUGH: f64 = 1e-6;
/// Evaluations within one search, after which halving stops.
const MOST_EVALUATIONS: u32 = 20_000;

/// The first time in `0..=span` at which `guard` falls from positive or zero to negative.
///
/// On an interval the guard is replaced by its interpolant at nine Chebyshev points, whose tail and two checks away from the nodes bound how far off it is.
/// The interval is halved until the interpolant's Bernstein coefficients, taken with that margin, exclude a fall or show the guard to fall strictly;
/// where the interpolant is too flat for that, down to neighbouring numbers. A root at the start that is spent is divided out, so that it cannot hide the next one.
/// A touch without a change of sign is no fall; a zero on a whole interval falls once, where it ends.
///
/// Guaranteed for guards that are smooth at the scale of the sampling (a feature narrower than about a ninth of `span`, and alone, can be missed);
/// where that could not be established, the [`Evidence`] says so.
///
/// ```
/// use saltus::cross::{Evidence, Start, first_fall};
/// // Two crossings a millionth apart are not one, nor none.
/// let found = first_fall(|s| (s - 0.5) * (s - 0.500_001), 1.0, Start::Open).unwrap();
/// let fall = found.fall.unwrap();
/// assert!((fall.inside - 0.5).abs() < 1e-10 && fall.inside < fall.outside);
/// assert_eq!(found.evidence, Evidence::Isolated);
/// // A root that was just spent is not found again; the next one is.
/// let next = first_fall(|s| s * (1.0 - s), 2.0, Start::Spent).unwrap();
/// assert_eq!(next.fall.unwrap().inside, 1.0);
/// ```
///
/// # Errors
/// [`Undefined`] if the guard is not a number somewhere before its first fall.
pub fn first_fall(guard: impl FnMut(f64) -> f64, span: f64, start: Start) -> Result<Searched, Undefined> {
    searched(Search::new(guard, span), start)
}

/// The same for a guard on the dense output of a step, which bends by `bend` over it.
pub(crate) fn first_fall_on_step(
    guard: impl FnMut(f64) -> f64,
    span: f64,
    start: Start,
    bend: f64,
) -> Result<Searched, Undefined> {
    let mut search = Search::new(guard, span);
    search.rough = ROUGH * bend;
    searched(search, start)
}

fn searched<G: FnMut(f64) -> f64>(mut search: Search<G>, start: Start) -> Result<Searched, Undefined> {
    let side = search.side_at(start)?;
    let all = Stretch { a: 0.0, b: search.span, depth: DEEPEST, margin: f64::INFINITY, known: None };
    let part = search.part(&all, side)?;
    search.conclude(part)
}

/// The same for a guard on a step, which bends by `bend` over it, that is known to be the polynomial `p(s / span)` to within `margin`; where that decides, `guard` is not asked.
pub(crate) fn first_fall_of_polynomial(
    p: &Bernstein,
    margin: f64,
    bend: f64,
    guard: impl FnMut(f64) -> f64,
    span: f64,
    start: Start,
) -> Result<Searched, Undefined> {
    let (p, margin, side) = match start {
        // Away from the wall only the change counts, and it carries no rounding of the value at the wall.
        Start::Spent => {
            let p = p.less_start();
            (p, 8.0 * f64::EPSILON * p.scale(), Side::Wall)
        }
        Start::Open | Start::Resumed => (*p, margin, Side::Inside),
    };
    if side == Side::Inside && p.shape(margin) == Shape::Above {
        return Ok(Searched { fall: None, evidence: Evidence::Excluded });
    }
    let mut search = Search::new(guard, span);
    search.rough = ROUGH * bend;
    let side = search.side_at(start)?;
    let all = Stretch { a: 0.0, b: span, depth: DEEPEST, margin, known: Some(p) };
    let part = search.part(&all, side)?;
    search.conclude(part)
}

struct Search<G> {
    guard: G,
    span: f64,
    /// Whether the root at the start is spent.
    spent: bool,
    /// The guard's value at a spent start.
    base: f64,
    /// What a guard on a step is rough by: close to its start, where the solution is zero but for rounding, it is known no better than
    /// to this times the square of the part of the step.
    rough: f64,
    /// Whether the guard falls from zero at the start as smoothly as a polynomial, so that zeros after it are rounding and no plateau.
    falls_smoothly: bool,
    evaluations: u32,
    /// The largest magnitude of the guard met so far.
    largest: f64,
    /// Where the stretch on which the guard is zero, or nothing but rounding, began, if it is on one.
    flat: Option<f64>,
    evidence: Evidence,
}

/// On which side of its zero the guard is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Inside,
    Outside,
    /// On a root at the start, not yet left.
    Wall,
}

impl Side {
    /// A zero leaves the guard on the side it came from.
    fn of(value: f64, came_from: Self) -> Self {
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
struct Stretch {
    a: f64,
    b: f64,
    depth: u32,
    /// How far the guard may be from its polynomial: from the one that is known, or from the interpolant on the interval of which this is a half.
    margin: f64,
    known: Option<Bernstein>,
}

/// What a part of the interval holds.
enum Part {
    /// Its first fall lies between these times; with the root, as far as the polynomial knows it.
    Fall { a: f64, b: f64, near: Option<f64> },
    /// The guard falls at once from the root at the start.
    AtStart,
    /// No fall; this is where the guard is at the end.
    None(Side),
}

impl<G: FnMut(f64) -> f64> Search<G> {
    fn new(guard: G, span: f64) -> Self {
        Self {
            guard,
            span,
            spent: false,
            base: 0.0,
            rough: 0.0,
            falls_smoothly: false,
            evaluations: 0,
            largest: 0.0,
            flat: None,
            evidence: Evidence::Excluded,
        }
    }

    fn value(&mut self, s: f64) -> Result<f64, Undefined> {
        self.evaluations += 1;
        let value = (self.guard)(s);
        self.largest = self.largest.max(value.abs());
        if value.is_nan() { Err(Undefined(s)) } else { Ok(value) }
    }

    /// On which side the search starts.
    fn side_at(&mut self, start: Start) -> Result<Side, Undefined> {
        let value = self.value(0.0)?;
        Ok(match start {
            Start::Spent => {
                (self.spent, self.base) = (true, value);
                Side::Wall
            }
            Start::Resumed if value == 0.0 && (self.guard)(-self.span * ROUNDING) < 0.0 => Side::Outside,
            Start::Open | Start::Resumed => Side::of(value, Side::Wall),
        })
    }

    fn weaken(&mut self, evidence: Evidence) {
        self.evidence = self.evidence.and(evidence);
    }

    fn conclude(mut self, part: Part) -> Result<Searched, Undefined> {
        let fall = match part {
            Part::None(_) => None,
            Part::AtStart => Some(Crossing::at_start(self.span * AT_START)),
            Part::Fall { near: Some(near), .. } => settle(&mut self.guard, near),
            Part::Fall { a, b, near: None } => Some(self.refined(a, b)?),
        };
        if fall.is_some() {
            self.weaken(Evidence::Isolated);
        }
        Ok(Searched { fall, evidence: self.evidence })
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
            self.weaken(Evidence::Unresolved { from: a, to: b });
            return self.by_sign(a, b, side);
        }
        let proxy = match known {
            Some(p) => Ok(Proxy { p: *p, margin: whole, start: p.start(), end: p.end() }),
            None => self.proxy(a, b),
        };
        let Ok(Proxy { p, mut margin, start, end }) = proxy else {
            return self.halved(stretch, f64::INFINITY, side);
        };
        let leaving = side == Side::Wall && a == 0.0;
        if leaving && known.is_some() {
            margin = 8.0 * f64::EPSILON * p.scale(); // zero at the start: every power of time keeps its digits
        }
        if side == Side::Wall {
            let roughness = self.roughness(b);
            if p.coefficients().iter().all(|value| (value - self.base).abs() < roughness) {
                return Ok(Part::None(Side::Wall));
            }
            margin += roughness;
        }
        let (q, q_margin) = if leaving { (p.without_root_at_start(), 16.0 * margin) } else { (p, margin) };
        // Halving shrinks the error of a smooth guard by hundreds; what does not shrink is the guard's own rounding.
        let resolved = known.is_some() || margin <= 1e-4 * p.scale() || margin >= 0.1 * whole;
        let scale = p.scale();
        let from = self.flat.unwrap_or(a);
        if leaving
            && !self.spent
            && q.start() < -q_margin
            && (known.is_some() || self.falls_from_start(b, q.start())?)
        {
            return Ok(Part::AtStart);
        }
        let decided = match q.shape(q_margin) {
            Shape::Above => Some(Part::None(Side::Inside)),
            Shape::Below => Some(match side {
                Side::Inside => Part::Fall { a: from, b, near: None },
                Side::Outside => Part::None(Side::Outside),
                Side::Wall if leaving => self.left(None),
                Side::Wall => self.left(Some(order(p.start(), p.end(), a, b))),
            }),
            Shape::Falling if resolved => match side {
                Side::Outside => Some(Part::None(Side::Outside)),
                Side::Wall if !leaving => Some(self.left(Some(order(p.start(), p.end(), a, b)))),
                Side::Wall if q.start() <= q_margin => {
                    self.falls_smoothly = true;
                    None
                }
                // Falling strictly from a zero, the rest of which is rounding.
                Side::Inside if start == 0.0 => Some(Part::Fall { a, b, near: Some(a) }),
                _ if end < 0.0 => {
                    let near = known.as_ref().and_then(|_| q.root()).map(|u| a + (b - a) * u);
                    Some(Part::Fall { a: from, b, near })
                }
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
                Look::Rounding(_) | Look::Smooth => {}
            }
        }
        self.halved(stretch, margin, side)
    }

    /// How far a guard on a step may be off a time `s` after its start, if it is zero there.
    fn roughness(&self, s: f64) -> f64 {
        self.rough * (s / self.span).powi(2)
    }

    /// Whether the slope at the start, seen as a `change` over `0..=b`, is the same over shorter times, and so not rounding.
    fn falls_from_start(&mut self, b: f64, change: f64) -> Result<bool, Undefined> {
        for part in [0.5, 0.25] {
            let shorter = self.proxy(0.0, part * b)?.p.without_root_at_start().start();
            if (shorter - part * change).abs() > 0.2 * part * change.abs() {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The guard has left the root at the start to below zero, as tᵐ with m = `order` where that is not one.
    ///
    /// If the root is spent and m is odd, this is the fall that was spent; with m even it only touched zero there, and falls again.
    fn left(&self, order: Option<f64>) -> Part {
        let even = order.is_some_and(|order| order.round().rem_euclid(2.0) == 0.0);
        if self.spent && !even { Part::None(Side::Outside) } else { Part::AtStart }
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

    /// Number by number.
    fn walked(&mut self, a: f64, b: f64, side: Side) -> Result<Part, Undefined> {
        let mut walk = Walk { side, last: self.flat.take().unwrap_or(a), base: self.base };
        let mut s = a;
        while s < b {
            s = s.next_up();
            match walk.to(s, self.value(s)?, self.roughness(s)) {
                Tread::Falls => return Ok(Part::Fall { a: walk.last, b: s, near: None }),
                Tread::FallsAtStart if !self.spent => return Ok(Part::AtStart),
                _ => {}
            }
        }
        Ok(Part::None(walk.side))
    }

    /// Whether the guard seems to go in steps: it stands still between neighbouring samples.
    fn stands(&mut self, a: f64, b: f64) -> Result<bool, Undefined> {
        for at in [0.3, 0.6] {
            let s = a + at * (b - a);
            if self.value(s)? == self.value(s + (b - a) / LOOKS as f64)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Samples of a guard that no polynomial fits.
    fn looked(&mut self, a: f64, b: f64, side: Side) -> Result<Look, Undefined> {
        let mut samples = [(0.0, 0.0); LOOKS];
        let (mut last, mut direction, mut turns) = (self.value(a)?, 0.0, 0);
        for (k, sample) in samples.iter_mut().enumerate() {
            #[allow(clippy::cast_precision_loss)] // small
            let s = if k + 1 == LOOKS { b } else { a + (b - a) * ((k + 1) as f64 / LOOKS as f64) };
            let value = self.value(s)?;
            *sample = (s, value);
            let change = value - last;
            if change != 0.0 {
                turns += usize::from(direction * change < 0.0);
                direction = change.signum();
            }
            last = value;
        }
        let steps = samples.chunk_by(|x, y| x.1 == y.1).count();
        if turns > MOST_TURNS {
            return Ok(Look::Rounding(self.seen_through(&samples, a, b, side)));
        }
        if steps > LOOKS / 2 {
            return Ok(Look::Smooth);
        }
        let mut walk = Walk { side, last: self.flat.take().unwrap_or(a), base: self.base };
        for (s, value) in samples {
            match walk.to(s, value, self.roughness(s)) {
                Tread::Falls => return Ok(Look::Steps(Part::Fall { a: walk.last, b: s, near: None })),
                Tread::FallsAtStart if !self.spent => return Ok(Look::Steps(Part::AtStart)),
                _ => {}
            }
        }
        if side == Side::Wall && walk.side == Side::Outside {
            // Steps of rounding are of one length where the guard falls with speed; without speed it stands longest on the first.
            let mut steps = samples.chunk_by(|x, y| x.1 == y.1).map(<[_]>::len);
            let (first, second) = (steps.next().unwrap_or(0), steps.next().unwrap_or(0));
            let (half, at_half) = samples[LOOKS / 2];
            let slow = samples[0].1 == self.base && first > second;
            return Ok(Look::Steps(self.left(slow.then(|| order(at_half - self.base, last - self.base, half, b)))));
        }
        Ok(Look::Steps(Part::None(walk.side)))
    }

    /// What is left of samples when all that is as small as their rounding counts as zero.
    fn seen_through(&mut self, samples: &[(f64, f64); LOOKS], a: f64, b: f64, side: Side) -> Part {
        let bend = |three: &[(f64, f64)]| (three[1].1 - 0.5 * (three[0].1 + three[2].1)).abs();
        let rounding = 4.0 * samples.windows(3).map(bend).fold(0.0, f64::max);
        let (mut side, mut hidden) = (side, true);
        for &(s, value) in samples {
            if value.abs() <= rounding {
                continue;
            }
            let next = Side::of(value, side);
            if side == Side::Inside && next == Side::Outside {
                return Part::Fall { a: self.flat.unwrap_or(a), b: s, near: None };
            }
            (side, hidden) = (next, false);
        }
        if hidden {
            self.weaken(Evidence::Rounding { from: a, to: b });
            self.flat = Some(self.flat.unwrap_or(a));
        } else {
            self.flat = None;
        }
        Part::None(side)
    }

    /// The interpolant at the Chebyshev points of `[a, b]`, and how far the guard may be from it.
    fn proxy(&mut self, a: f64, b: f64) -> Result<Proxy, Undefined> {
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
        let p = Bernstein::new(&chebyshev::bernstein(&series));
        let mut off = 0.0_f64;
        for x in [-0.557_350_921, 0.271_828_183] {
            off = off.max((self.value(centre + radius * x)? - chebyshev::sum(&series, x)).abs());
        }
        let margin = 8.0 * (series[7].abs() + series[8].abs()).max(off) + 16.0 * f64::EPSILON * p.scale();
        Ok(Proxy {
            p,
            margin: if margin.is_finite() { margin } else { f64::INFINITY },
            start: values[0],
            end: values[8],
        })
    }
}

/// The m with which c tᵐ takes these values at times `a` and `b`.
fn order(at_a: f64, at_b: f64, a: f64, b: f64) -> f64 {
    (at_b / at_a).ln() / (b / a).ln()
}

/// What samples of a guard show that no polynomial fits.
enum Look {
    /// Steps of rounding, seen one by one: their signs count.
    Steps(Part),
    /// Ups and downs without order, and what can be seen through them.
    Rounding(Part),
    /// Neither: it is to be looked at more closely.
    Smooth,
}

/// A polynomial in place of the guard on an interval.
struct Proxy {
    p: Bernstein,
    margin: f64,
    /// The guard at both ends.
    start: f64,
    end: f64,
}

/// A walk from sample to sample.
struct Walk {
    side: Side,
    /// The last sample that was inside, or on the wall.
    last: f64,
    base: f64,
}

impl Walk {
    /// What the guard has done on the way to `s`.
    fn to(&mut self, s: f64, value: f64, roughness: f64) -> Tread {
        let side = match self.side {
            Side::Wall if (value - self.base).abs() <= roughness => Side::Wall,
            Side::Wall => Side::of(value - self.base, Side::Wall),
            side => Side::of(value, side),
        };
        let tread = match (self.side, side) {
            (Side::Inside, Side::Outside) => return Tread::Falls,
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn fall(guard: impl FnMut(f64) -> f64, span: f64) -> Option<f64> {
        first_fall(guard, span, Start::Open).unwrap().fall.map(|c| c.inside)
    }

    #[test]
    fn a_touch_is_no_fall() {
        assert_eq!(fall(|s| (s - 0.5).powi(2), 1.0), None);
        assert_eq!(fall(|s| (s - 0.3).powi(4), 1.0), None);
        assert_eq!(fall(|s| -(s - 0.5).powi(2), 1.0), None);
    }

    #[test]
    fn a_plateau_falls_once_where_it_ends() {
        let found = fall(
            |s| {
                if s < 0.25 {
                    0.25 - s
                } else if s < 0.75 {
                    0.0
                } else {
                    0.75 - s
                }
            },
            1.0,
        )
        .unwrap();
        assert!((found - 0.75).abs() < 1e-15, "{found}");
    }

    #[test]
    fn a_fall_at_the_start_counts_unless_spent() {
        assert_eq!(fall(|s| -s, 1.0), Some(0.0));
        assert_eq!(first_fall(|s| -s, 1.0, Start::Spent).unwrap().fall, None);
    }

    #[test]
    fn undefined_before_the_fall_is_said_and_after_it_is_not() {
        assert!(matches!(first_fall(|s| (0.5 - s).sqrt() + 1.0, 1.0, Start::Open), Err(Undefined(s)) if s > 0.49));
        let found = fall(|s| if s > 0.6 { f64::NAN } else { 0.25 - s }, 1.0);
        assert!((found.unwrap() - 0.25).abs() < 1e-15);
    }

    #[test]
    fn a_fast_guard_gives_its_first_fall() {
        let found = fall(|s| (1000.0 * s + 0.1).sin(), 1.0).unwrap();
        assert!((found - (std::f64::consts::PI - 0.1) / 1000.0).abs() < 1e-15, "{found}");
    }

    proptest! {
        /// Plant falls and rises in turn, clustered, dyadic or at an end; the first fall is found, as a polynomial and as a function.
        #[test]
        fn planted_roots(mut roots in prop::collection::vec((0_u32..=64, -3_i32..=3), 1..=6)) {
            roots.sort_unstable();
            let roots: Vec<f64> = roots.iter().map(|&(k, hair)| f64::from(k) / 64.0 + f64::from(hair) * 1e-4).collect();
            let value = |s: f64| roots.iter().map(|r| r - s).product::<f64>();
            // Count the roots at each place: an even group is a touch, an odd one a change of sign.
            let mut sign = 1.0;
            let mut expected = None;
            let mut i = 0;
            while i < roots.len() {
                let same = roots[i..].iter().take_while(|&&r| r == roots[i]).count();
                if same % 2 == 1 {
                    if roots[i] >= 0.0 && roots[i] < 1.0 && sign > 0.0 {
                        expected = Some((roots[i], same));
                        break;
                    }
                    sign = -sign;
                }
                i += same;
            }
            let found = fall(value, 1.0);
            match expected {
                None => prop_assert!(found.is_none(), "{found:?}"),
                Some((root, multiplicity)) => {
                    let tolerance = if multiplicity == 1 { 1e-9 } else { 1e-3 };
                    prop_assert!(found.is_some_and(|s| (s - root).abs() < tolerance), "{found:?} {root}");
                }
            }
        }
    }
}
