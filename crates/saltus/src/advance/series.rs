//! An arc whose flow is known over jets: each step is as long as its Taylor series allows, and exact to the tolerance all along.

use crate::automaton::Automaton;
use crate::control::Tolerance;
use crate::error::{Error, ErrorKind, Place};
use crate::observe::Observer;
use crate::poly::{MAX_DEGREE, value_and_slope};
use crate::series::{MOST_COEFFICIENTS, Series};
use crate::simulation::Stop;
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Time, resolution};
use crate::trajectory::Piece;

use super::exact::natural;
use super::stepped::{evened, wrong_dimension};
use super::{Advance, ArcEnd, Clock};

/// The lowest and the highest order: no higher than guards along it can be bounded.
const LOWEST: usize = 6;
const HIGHEST: usize = MAX_DEGREE;
/// How many orders more there are where they may save a step.
const FURTHER: usize = 8;
/// An arc is expected to last no longer than this many times the last one.
const AS_LAST: f64 = 1.05;
/// How much of the way to which the last coefficients reach within the tolerance a step takes.
const SAFETY: f64 = 0.85;
/// By how much a step is shortened at whose end the flow is not the slope of the series.
const SHORTER: f64 = 0.5;
/// How much of a slope may be missing at the start of a series before it is taken for that of another flow.
const OTHER: f64 = 1e-6;
/// How many of its natural times a step takes whose series ends.
const LONGEST: f64 = 16.0;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// By series as long as there are any, and from there on by steps.
    pub(super) fn by_series(
        &mut self,
        mode: A::Mode,
        mut x: A::State,
        mut clock: Clock,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let tolerance = self.options.tolerance;
        let order = order(tolerance.relative);
        let began = clock.now;
        let mut first = true;
        let mut c = [x; MOST_COEFFICIENTS];
        loop {
            let remaining = clock.end.since(clock.now);
            if let Some(stop) = self.over(remaining) {
                return Ok(ArcEnd::Stop { stop, time: clock.now, state: x });
            }
            let longest = remaining.min(self.options.longest_step);
            let wanted = longest.min(AS_LAST * self.memory.last_duration);
            let Some(mut expansion) = self.expanded(mode, clock.now, &x, order, &mut c)? else {
                return self.stepped(mode, x, clock, first, observer);
            };
            if expansion.reach < wanted {
                self.expand_further(mode, clock.now, &x, &mut expansion, &mut c);
            }
            let Expansion { unit, order, reach } = expansion;
            let c = &c[..=order];
            let Some((h, end)) = self.believed(mode, clock.now, c, unit, reach, longest)? else {
                return self.stepped(mode, x, clock, first, observer);
            };
            self.memory.stats.steps += 1;
            let last = h >= remaining;
            let limit = if last { h + 8.0 * f64::EPSILON * h.max(clock.now.since(began)) } else { h };
            let found = self.first_crossing(mode, clock.now, c, unit, limit, first, observer)?;
            let Some(found) = found else {
                let told = observer.piece(mode, &Piece::new(clock.now, h, unit, c));
                clock.now = if last { clock.end } else { clock.now.after(h) };
                if told.is_break() {
                    return Ok(ArcEnd::Stop { stop: Stop::Observer, time: clock.now, state: end });
                }
                (x, first) = (end, false);
                continue;
            };
            return Ok(self.crossed(mode, found, clock.now, c, unit, remaining, observer));
        }
    }

    /// Works out the Taylor coefficients `c` of the solution from `x`, in units of a second, unless they are out of the range of numbers then. Nothing where there
    /// is no series.
    #[inline]
    fn expanded(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        order: usize,
        c: &mut [A::State; MOST_COEFFICIENTS],
    ) -> Result<Option<Expansion>, Error> {
        let mut unit = 1.0;
        loop {
            let mut series = Series::around(self.tape, now.seconds(), x, 0, order, unit);
            if !self.automaton.series(mode, &mut series) {
                return Ok(None);
            }
            if let Some(dimension) = series.mismatch() {
                return Err(wrong_dimension(dimension, mode, now, x));
            }
            self.memory.stats.flows += order as u64;
            series.read(c);
            let reach = unit * reach(&self.options.tolerance, &c[..=order]);
            if reach < f64::INFINITY {
                return Ok(Some(Expansion { unit, order, reach }));
            }
            // A series that ends may be a polynomial, or its numbers too small for this unit.
            if unit != 1.0 {
                let finite = c[..=order].iter().all(State::is_finite);
                return Ok(finite.then_some(Expansion { unit, order, reach }));
            }
            unit = own_unit(&self.options.tolerance, x, &self.slope(mode, now, x)?);
        }
    }

    /// Goes on to a higher order, with which the step may be long enough: one that is shorter costs as much again, and its search too.
    fn expand_further(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        expansion: &mut Expansion,
        c: &mut [A::State; MOST_COEFFICIENTS],
    ) {
        let (known, order) = (expansion.order, (expansion.order + FURTHER).min(HIGHEST));
        let mut series = Series::around(self.tape, now.seconds(), x, known, order, expansion.unit);
        if order == known || !self.automaton.series(mode, &mut series) {
            return;
        }
        self.memory.stats.flows += (order - known) as u64;
        series.read(c);
        let reach = expansion.unit * reach(&self.options.tolerance, &c[..=order]);
        if reach > expansion.reach && reach < f64::INFINITY {
            *expansion = Expansion { order, reach, ..*expansion };
        }
    }

    /// A step over which the series is believed, and where it ends: as long as its last coefficients allow, and no longer than the flow at its end agrees, which
    /// it does not beyond a kink. Nothing if there is no such step.
    fn believed(
        &mut self,
        mode: A::Mode,
        now: Time,
        c: &[A::State],
        unit: f64,
        reach: f64,
        longest: f64,
    ) -> Result<Option<(f64, A::State)>, Error> {
        let tolerance = self.options.tolerance;
        let mut h = reach.min(longest);
        if h == f64::INFINITY {
            h = LONGEST * unit * natural(c);
        }
        h = evened(h, longest);
        let allowed = c.len() as f64;
        while h > 2.0 * resolution(now.seconds()) && h.is_finite() {
            let (end, slope) = end_and_slope(c, h / unit);
            let flow = self.slope(mode, now.after(h), &end)?;
            let defect = end.with(|i| {
                let off = (h * flow.get(i) - (h / unit) * slope.get(i)).abs();
                (off - 64.0 * f64::EPSILON * (h * flow.get(i)).abs()).max(0.0)
            });
            if end.is_finite() && flow.is_finite() && tolerance.norm(&defect, &c[0], &end) <= allowed {
                return Ok(Some((h, end)));
            }
            self.memory.stats.rejected += 1;
            self.same_flow(mode, now, &c[0], &c[1], unit)?;
            h *= SHORTER;
        }
        Ok(None)
    }

    /// An error where a series does not start with the slope of the flow.
    #[cold]
    fn same_flow(&mut self, mode: A::Mode, now: Time, x: &A::State, first: &A::State, unit: f64) -> Result<(), Error> {
        let flow = self.slope(mode, now, x)?;
        let most = (0..flow.len()).map(|i| flow.get(i).abs()).fold(0.0, f64::max);
        if !flow.is_finite() || (0..flow.len()).all(|i| (first.get(i) / unit - flow.get(i)).abs() <= OTHER * most) {
            return Ok(());
        }
        Err(Error::new(ErrorKind::Series, Place::new(now.seconds(), mode, None::<A::Edge>, x)))
    }
}

/// A series as far as it is known.
#[derive(Clone, Copy)]
struct Expansion {
    /// The unit of time of its coefficients, in seconds.
    unit: f64,
    order: usize,
    /// Over how many seconds its last coefficients are within the tolerance.
    reach: f64,
}

/// The order for a relative tolerance: the tighter, the higher.
fn order(relative: f64) -> usize {
    ((3.0 - 0.6 * relative.ln()) as usize).clamp(LOWEST, HIGHEST)
}

/// Over how many units of time the last two coefficients are within the tolerance (À. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99, 3.2.1): without end if
/// they are zero, or no numbers.
#[inline]
fn reach<S: State>(tolerance: &Tolerance, c: &[S]) -> f64 {
    let p = c.len() - 1;
    let [mut last, mut before] = [0.0; 2];
    for i in 0..c[0].len() {
        let by = 1.0 / (tolerance.absolute + tolerance.relative * c[0].get(i).abs());
        let [a, b] = [p, p - 1].map(|k| by * c[k].get(i));
        (last, before) = (last + a * a, before + b * b);
    }
    // The mean square of what is allowed in the power of -1/(2 k).
    if last == 0.0 && before == 0.0 || !(last + before).is_finite() {
        return f64::INFINITY;
    }
    let [last, before] = [(p, last), (p - 1, before)].map(|(k, sum)| binary_logarithm(sum) / (2 * k) as f64);
    SAFETY * power_of_two(-last.max(before))
}

/// log₂ x to within 0.09, read off the number's exponent and mantissa (N. Schraudolph, Neural Computation 11 (1999) 853): all that a step's size needs, at a tenth of
/// the time.
fn binary_logarithm(x: f64) -> f64 {
    x.to_bits() as f64 / MANTISSA - EXPONENT
}

/// 2ˣ, and up to six parts in a hundred more, likewise.
fn power_of_two(x: f64) -> f64 {
    if x < EXPONENT { f64::from_bits(((x + EXPONENT) * MANTISSA) as u64) } else { f64::INFINITY }
}

/// A mantissa's unit in the place of an exponent's, and the exponent of one.
const MANTISSA: f64 = (1_u64 << 52) as f64;
const EXPONENT: f64 = 1023.0;

/// Σ cₖ sᵏ and Σ k cₖ sᵏ⁻¹.
#[inline]
fn end_and_slope<S: State>(c: &[S], s: f64) -> (S, S) {
    let mut slope = c[0];
    let end = c[0].with(|i| {
        let (value, rate) = value_and_slope(c, |c| c.get(i), s);
        slope = slope.with(|j| if i == j { rate } else { slope.get(j) });
        value
    });
    (end, slope)
}

/// Another unit of time than a second, a power of two of it, in which a state changes by about its size.
#[cold]
fn own_unit<S: State>(tolerance: &Tolerance, x: &S, slope: &S) -> f64 {
    let (size, speed) = (tolerance.norm(x, x, x), tolerance.norm(slope, x, x));
    let exponent = (size / speed).log2().round().clamp(-900.0, 900.0);
    if exponent.is_finite() && exponent != 0.0 { exponent.exp2() } else { 2.0 }
}
