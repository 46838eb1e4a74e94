//! A guard as a search asks it: its values and what they are exact to, and the sides of its zero.

use crate::certainty::{FAR, NOTHING, TINY};

use super::chebyshev::{SAMPLES, sample_times};
use super::departure::Departure;
use super::{Evidence, Turn, Undefined};

/// A fall within this fraction of the interval from its start is at its start.
pub(crate) const AT_START: f64 = NOTHING * TINY;
/// How many samples are taken of a guard that seems to be nothing but rounding.
pub(super) const LOOKS: usize = 128;
/// If they change direction no more often than this, they are not rounding and their signs count.
pub(super) const MOST_TURNS: usize = 8;
/// Where on a stretch two neighbouring samples are compared, to see whether the guard stands still.
const STANDS_AT: [f64; 2] = [0.3, 0.6];

/// Compiled once for every guard: it is much code, and a call through a table costs little beside a
/// guard on a dense output.
pub(super) struct Search<'a> {
    pub(super) guard: &'a mut dyn FnMut(f64) -> f64,
    pub(super) span: f64,
    /// How long before the start the guard may be asked.
    pub(super) behind: f64,
    /// The spacing of the guard's own time, which may be coarser than that of numbers within the
    /// interval.
    pub(super) tick: f64,
    /// Whether the root at the start is spent.
    pub(super) spent: bool,
    /// The guard's value at the start, once it was asked.
    pub(super) start: Option<f64>,
    /// Its values at the sample times of the whole interval, if it was asked there.
    pub(super) samples: Option<&'a [f64; SAMPLES]>,
    /// That at a spent start.
    pub(super) base: f64,
    /// How the guard leaves a spent root at the start, as far as its samples have shown.
    pub(super) departure: Option<Departure>,
    /// What a guard on a step is rough by: close to its start, where the solution is zero but for
    /// rounding, it is exact to no more than this times the square of the part of the step.
    pub(super) rough: f64,
    /// How far a guard that is zero at an open start may have been off on the shortest stretch on
    /// which its samples rise from there.
    pub(super) rise: Option<f64>,
    pub(super) evaluations: u32,
    /// The largest magnitude of the guard met so far.
    pub(super) largest: f64,
    /// Where the stretch on which the guard is zero, or nothing but rounding, began, if it is on
    /// one.
    pub(super) flat: Option<f64>,
    pub(super) evidence: Evidence,
    /// Where the samples of the whole interval turn.
    pub(super) turn: Option<Turn>,
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
        Self::beside(value, came_from, 0.0)
    }

    /// The same where rounding has left a spent root at `base`: what has fallen from there is
    /// outside until it is above that.
    pub(super) fn beside(value: f64, came_from: Self, base: f64) -> Self {
        if came_from == Self::Outside && value <= base {
            Self::Outside
        } else if value > 0.0 {
            Self::Inside
        } else if value < 0.0 {
            Self::Outside
        } else {
            came_from
        }
    }
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
    /// A search for a guard that bends by `bend` on a step, or by nothing where no step's rounding
    /// spoils it, and sees times that are `tick` apart.
    pub(super) fn new(guard: &'a mut dyn FnMut(f64) -> f64, span: f64, bend: f64, tick: f64) -> Self {
        Self {
            guard,
            span,
            behind: span,
            tick,
            spent: false,
            start: None,
            samples: None,
            base: 0.0,
            departure: None,
            // A dense output starts with the exact slope, but its higher powers carry the error of
            // the step and the rounding of its stages.
            rough: TINY * bend,
            rise: None,
            evaluations: 0,
            largest: 0.0,
            flat: None,
            evidence: Evidence::Excluded,
            turn: None,
        }
    }

    /// The same, where the guard has this `value` at the start.
    pub(super) fn at_start(self, value: f64) -> Self {
        Self { start: Some(value), largest: value.abs(), ..self }
    }

    /// The same, where the guard has these `values` at the sample times of the interval.
    pub(super) fn sampled_at(self, values: &'a [f64; SAMPLES]) -> Self {
        Self { samples: Some(values), ..self.at_start(values[0]) }
    }

    /// The guard at the start.
    pub(super) fn start(&mut self) -> Result<f64, Undefined> {
        let value = match self.start {
            Some(value) if value.is_nan() => return Err(Undefined(0.0)),
            Some(value) => value,
            None => self.value(0.0)?,
        };
        self.start = Some(value);
        Ok(value)
    }

    pub(super) fn value(&mut self, s: f64) -> Result<f64, Undefined> {
        self.evaluations += 1;
        let value = (self.guard)(s);
        self.largest = self.largest.max(value.abs());
        if value.is_nan() { Err(Undefined(s)) } else { Ok(value) }
    }

    /// The guard at its sample times on `[a, b]`, of which the first is `a`.
    #[inline]
    pub(super) fn values(&mut self, a: f64, b: f64) -> Result<[f64; SAMPLES], Undefined> {
        let mut values = sample_times(a, b);
        if let Some(samples) = self.samples.filter(|_| a == 0.0 && b == self.span) {
            values = *samples;
        } else {
            let first = if a == 0.0 { Some(self.start()?) } else { None };
            values[0] = first.unwrap_or_else(|| (self.guard)(a));
            values[1..].iter_mut().for_each(|value| *value = (self.guard)(*value));
        }
        self.evaluations += SAMPLES as u32;
        self.largest = values.iter().fold(self.largest, |largest, value| largest.max(value.abs()));
        Ok(values)
    }

    pub(super) fn weaken(&mut self, evidence: Evidence) {
        self.evidence = self.evidence.and(evidence);
    }

    /// Whether values off by so much are off by more than a guard's cancellation explains.
    pub(super) fn is_rougher_than_rounding(&self, off: f64) -> bool {
        off > FAR * f64::EPSILON * self.largest
    }

    /// How far a guard on a step may be off a time `s` after its start, if it is zero there.
    pub(super) fn roughness(&self, s: f64) -> f64 {
        self.rough * (s / self.span).powi(2)
    }

    /// Whether the guard seems to go in steps: it stands still between neighbouring samples.
    pub(super) fn stands(&mut self, a: f64, b: f64) -> Result<bool, Undefined> {
        for at in STANDS_AT {
            let s = a + at * (b - a);
            if self.value(s)? == self.value(s + (b - a) / LOOKS as f64)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Many samples, and how often they change direction.
    pub(super) fn samples(&mut self, a: f64, b: f64) -> Result<([(f64, f64); LOOKS], usize), Undefined> {
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
        Ok((samples, turns))
    }

    /// Whether the samples go up and down without order.
    pub(super) fn is_rough(&mut self, a: f64, b: f64) -> Result<bool, Undefined> {
        Ok(self.samples(a, b)?.1 > MOST_TURNS)
    }
}
