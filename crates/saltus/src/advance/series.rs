//! An arc whose flow is given over jets: each step is as long as its Taylor series allows, and
//! exact to the tolerance all along.

use crate::automaton::Automaton;
use crate::automaton::refusal::wrong_dimension;
use crate::automaton::solution::Flow;
use crate::certainty::TINY;
use crate::control::Tolerance;
use crate::ending::Stop;
use crate::error::{Error, ErrorKind, Place};
use crate::inspection::InspectionOf;
use crate::observe::Observer;
use crate::piece::Piece;
use crate::poly::MAX_DEGREE;
use crate::series::{MOST_COEFFICIENTS, NextKink, RECIPROCALS, Series};
use crate::state::State;
use crate::step::Stepper;
use crate::time::{Span, Time, resolution};

use super::crossing::{OnStep, Range};
use super::exact::natural;
use super::near::Near;
use super::shared::Step;
use super::smooth::Arrival;
use super::stepped::{SHORTEST, evened};
use super::{Advance, ArcEnd};

/// The lowest order.
const LOWEST: usize = 6;
/// The highest order: no higher than guards along it can be bounded.
const HIGHEST: usize = MAX_DEGREE;
/// How many orders more there are where they may save a step.
const FURTHER: usize = 8;
/// An arc is expected to last no longer than this many times the last one.
const AS_LAST: f64 = 1.05;
/// How much of the way to which the last coefficients reach within the tolerance a step takes.
const SAFETY: f64 = 0.85;
/// By how much a step is shortened at whose end the flow is not the slope of the series.
const SHORTER: f64 = 0.5;
/// How often a step is shortened for a kink that may be on it.
const MOST_HALVINGS: usize = 4;
/// How many of its natural times a step takes whose series ends: more, and falls on it are lost in
/// the rounding of its end.
const LONGEST: f64 = 16.0;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// By series as long as there are any, and from there on by steps. A long loop: each of its
    /// parts decides what goes on to the next step.
    pub(super) fn by_series(
        &mut self,
        mode: A::Mode,
        mut x: A::State,
        flow: Flow<A>,
        mut clock: Span,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let tolerance = self.options.tolerance;
        let order = order(tolerance.relative);
        let began = clock.now;
        let unguarded = self.automaton.edges(mode).is_empty();
        let mut first = true;
        let mut c: [A::State; MOST_COEFFICIENTS] = std::array::from_fn(|_| x.clone());
        self.tape.anew(None);
        loop {
            let remaining = clock.remaining();
            if let Some(stop) = self.over(remaining) {
                return self.ended(mode, stop, clock.now, x);
            }
            let to_stop = self.smooth.ahead(clock.now);
            let longest = remaining.min(self.options.longest_step).min(to_stop);
            let wanted = longest.min(AS_LAST * self.memory.last_duration - clock.now.since(began));
            let Some(mut expansion) = self.expanded(mode, flow, clock.now, &x, order, &mut c)? else {
                return self.stepped(mode, x, clock, first, observer);
            };
            let mut ahead = self.ahead(&expansion, &c, longest, unguarded);
            if ahead.kink.is_none() && expansion.reach < wanted {
                self.expand_further(mode, flow, clock.now, &x, &mut expansion, &mut c);
                ahead = self.ahead(&expansion, &c, longest, unguarded);
            }
            if let Some(place) = ahead.kink
                && ahead.step <= SHORTEST * resolution(clock.now.seconds())
            {
                self.tape.turn(place); // at once: no step is that short
                continue;
            }
            let Expansion { unit, order, .. } = expansion;
            let c = &c[..=order];
            if first {
                let slope = x.with(|i| c[1].get(i) / unit);
                self.find_staying(mode, Step { now: clock.now, c, scale: unit, size: ahead.step }, &slope);
            }
            let way = Way { mode, now: clock.now, remaining, grace: clock.grace(), first };
            let Some(Believed { h, found, end }) = self.believed(&way, c, unit, ahead.step)? else {
                return self.stepped(mode, x, clock, first, observer);
            };
            self.held.0.iter().for_each(|inspection| observer.inspection(inspection));
            self.memory.stats.steps += 1;
            if let Some(found) = found {
                return Ok(self.crossed(
                    mode,
                    &found,
                    (Step { now: clock.now, c, scale: unit, size: h }, None),
                    remaining,
                    observer,
                ));
            }
            let told = observer.piece(mode, &Piece::new(clock.now, h, unit, c));
            let Arrival { time, at_stop } = self.arrival(&clock, h, (remaining, to_stop));
            clock.now = time;
            if told.is_break() {
                return Ok(ArcEnd::Stop { stop: Stop::Observer, time: clock.now, state: end });
            }
            self.memory.reaches(&c[0], |i| h / unit * c[1].get(i));
            self.tape.anew(ahead.kink.filter(|_| h == ahead.step && !at_stop));
            (x, first) = (end, false);
            if at_stop && let Some(edge) = self.pass_stop(mode, clock.now, &x)? {
                return Ok(ArcEnd::Crossing { edge, time: clock.now, before: x });
            }
            if !self.memory.walls.is_empty() {
                self.keep_staying(mode, clock.now, &x, h);
            }
        }
    }

    /// How far a step may go by its series: no further than its last coefficients
    /// allow, nor beyond a kink.
    #[inline]
    fn ahead(&self, expansion: &Expansion, c: &[A::State; MOST_COEFFICIENTS], longest: f64, unguarded: bool) -> Ahead {
        let &Expansion { unit, order, reach } = expansion;
        let reach = if reach < f64::INFINITY || unguarded { reach } else { self.own_reach(unit, &c[..=order]) };
        let mut step = evened(reach.min(longest), longest);
        for _ in 0..MOST_HALVINGS {
            match self.tape.next_kink(order, step / unit) {
                NextKink::Nowhere => break,
                NextKink::At { units, place } => return Ahead { step: units * unit, kink: Some(place) },
                NextKink::Unclear { units } => step = SHORTER * units * unit,
            }
        }
        Ahead { step, kink: None }
    }

    /// How far a step goes whose series ends, and whose polynomial has no error: no farther than a
    /// fall early on it is resolved.
    #[cold]
    fn own_reach(&self, unit: f64, c: &[A::State]) -> f64 {
        let natural = unit * natural(c);
        if natural > 0.0 {
            return LONGEST * natural;
        }
        // Powers from zero have no time scale of their own, but for what the tolerance allows.
        let speed = self.options.tolerance.norm(&c[1], &c[0], &c[0]) / unit;
        LONGEST * self.memory.last_duration.max(if speed > 0.0 { 1.0 / speed } else { f64::INFINITY })
    }

    /// Works out the Taylor coefficients `c` of the solution from `x`, in units of a second, unless
    /// they are out of the range of numbers then. Nothing where there is no series.
    #[inline]
    fn expanded(
        &mut self,
        mode: A::Mode,
        flow: Flow<A>,
        now: Time,
        x: &A::State,
        order: usize,
        c: &mut [A::State; MOST_COEFFICIENTS],
    ) -> Result<Option<Expansion>, Error> {
        let mut unit = 1.0;
        loop {
            let mut series = Series::around(&mut self.tape, self.smooth.within(now.seconds()), x, 0, order, unit);
            flow(self.automaton, mode, &mut series);
            if let Some(dimension) = series.mismatch() {
                return Err(wrong_dimension(dimension, mode, now.seconds(), x));
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
            let slope = self.slope(mode, now, x)?;
            unit = own_unit(&self.options.tolerance, x, &slope);
        }
    }

    /// Goes on to a higher order, with which the step may be long enough: one that is shorter costs
    /// as much again, and its search too.
    fn expand_further(
        &mut self,
        mode: A::Mode,
        flow: Flow<A>,
        now: Time,
        x: &A::State,
        expansion: &mut Expansion,
        c: &mut [A::State; MOST_COEFFICIENTS],
    ) {
        let (known, order) = (expansion.order, (expansion.order + FURTHER).min(HIGHEST));
        let mut series = Series::around(&mut self.tape, now.seconds(), x, known, order, expansion.unit);
        if order == known {
            return;
        }
        flow(self.automaton, mode, &mut series);
        self.memory.stats.flows += (order - known) as u64;
        series.read(c);
        let reach = expansion.unit * reach(&self.options.tolerance, &c[..=order]);
        if reach > expansion.reach && reach < f64::INFINITY {
            *expansion = Expansion { order, reach, ..*expansion };
        }
    }

    /// A step of `h` or less over which the series is believed, and what ends it: no longer than
    /// the flow at its end agrees, which it does not beyond a switch. Nothing if there is no such
    /// step.
    fn believed(&mut self, way: &Way<A>, c: &[A::State], unit: f64, mut h: f64) -> Result<Option<Believed<A>>, Error> {
        let &Way { mode, now, remaining, grace, first } = way;
        while h > SHORTEST * resolution(now.seconds()) && h.is_finite() {
            let limit = if h < remaining { h } else { h + grace };
            let mut held = std::mem::take(&mut self.held);
            held.0.clear();
            let found = self.first_crossing(
                mode,
                Step { now, c, scale: unit, size: h },
                Range { limit, first, roughly: false },
                Some(&mut held),
            );
            self.held = held;
            let near = match &found {
                Ok(Some(OnStep { crossing, near: Some(near), .. })) => near.moved(c, unit, crossing.root),
                Ok(Some(OnStep { crossing, .. })) => Near::around(c, unit, crossing.root),
                _ => Near::around(c, unit, h),
            };
            if self.agrees(mode, now, &c[0], &near, c.len())? {
                return Ok(Some(Believed { h, found: found?, end: near.state }));
            }
            self.memory.stats.rejected += 1;
            self.same_flow(mode, now, &c[0], &c[1], unit)?;
            h = SHORTER * near.s;
        }
        Ok(None)
    }

    /// Whether the flow at the end of a step from `x` is the slope of the series there, as far as
    /// so many coefficients have it within the tolerance.
    #[inline]
    fn agrees(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        end: &Near<A::State>,
        most: usize,
    ) -> Result<bool, Error> {
        let Near { s, state, slope } = end;
        let flow = self.slope(mode, now.after(*s), state)?;
        let off = |i: usize| s * ((flow.get(i) - slope.get(i)).abs() - 64.0 * f64::EPSILON * flow.get(i).abs());
        let agrees = |i: usize| off(i) <= most as f64 * self.options.tolerance.allowed(x.get(i), state.get(i));
        Ok(state.is_finite() && (0..state.len()).all(agrees))
    }

    /// An error where a series does not start with the slope of the flow.
    #[cold]
    fn same_flow(&mut self, mode: A::Mode, now: Time, x: &A::State, first: &A::State, unit: f64) -> Result<(), Error> {
        let flow = self.slope(mode, now, x)?;
        let most = (0..flow.len()).map(|i| flow.get(i).abs()).fold(0.0, f64::max);
        if !flow.is_finite() || (0..flow.len()).all(|i| (first.get(i) / unit - flow.get(i)).abs() <= TINY * most) {
            return Ok(());
        }
        Err(Error::new(ErrorKind::Series, Place::new(now.seconds(), mode, None::<A::Edge>, x)))
    }
}

/// Where a step starts.
struct Way<A: Automaton> {
    mode: A::Mode,
    now: Time,
    /// How much of the span is left, and how far past its end is still at it.
    remaining: f64,
    grace: f64,
    first: bool,
}

/// A step, the first crossing on it, and where the one or the other ends.
struct Believed<A: Automaton> {
    h: f64,
    found: Option<OnStep<A>>,
    end: A::State,
}

/// Holds back the inspections of guards until the step is believed.
pub(crate) struct Held<A: Automaton>(Vec<InspectionOf<A>>);

impl<A: Automaton> Default for Held<A> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<A: Automaton> Observer<A> for Held<A> {
    #[inline]
    fn inspection(&mut self, inspection: &InspectionOf<A>) {
        self.0.push(*inspection);
    }
}

/// How far a step may go, and the place on the tape of the number that has its kink there, if one
/// has.
struct Ahead {
    step: f64,
    kink: Option<usize>,
}

/// A series as far as it is computed.
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

/// Over how many units of time the last two coefficients are within the tolerance (À. Jorba, M.
/// Zou, Experimental Mathematics 14 (2005) 99, 3.2.1): without end if they are zero, or no numbers.
#[inline]
fn reach<S: State>(tolerance: &Tolerance, c: &[S]) -> f64 {
    let p = c.len() - 1;
    let [mut last, mut before] = [0.0; 2];
    for i in 0..c[0].len() {
        let by = 1.0 / (tolerance.absolute + tolerance.relative * c[0].get(i).abs());
        let (a, b) = (by * c[p].get(i), by * c[p - 1].get(i));
        (last, before) = (last + a * a, before + b * b);
    }
    // The mean square of what is allowed in the power of -1/(2 k).
    if last == 0.0 && before == 0.0 || !(last + before).is_finite() {
        return f64::INFINITY;
    }
    let [last, before] = [(p, last), (p - 1, before)].map(|(k, sum)| binary_logarithm(sum) * (0.5 * RECIPROCALS[k]));
    SAFETY * about_two_to(-last.max(before))
}

/// log₂ x to within 0.09, read off the number's exponent and mantissa (N. Schraudolph, Neural
/// Computation 11 (1999) 853): all that a step's size needs.
fn binary_logarithm(x: f64) -> f64 {
    x.to_bits().cast_signed() as f64 / MANTISSA - EXPONENT
}

/// 2ˣ, and up to six parts in a hundred more, likewise.
fn about_two_to(x: f64) -> f64 {
    if x < EXPONENT { f64::from_bits(((x + EXPONENT) * MANTISSA).max(0.0) as i64 as u64) } else { f64::INFINITY }
}

/// A mantissa's unit in the place of an exponent's.
const MANTISSA: f64 = (1_u64 << 52) as f64;
/// The exponent of one.
const EXPONENT: f64 = 1023.0;

/// Another unit of time than a second, a power of two of it, in which a state changes by about its
/// size, if it has one.
#[cold]
fn own_unit<S: State>(tolerance: &Tolerance, x: &S, slope: &S) -> f64 {
    let (size, speed) = (tolerance.norm(x, x, x), tolerance.norm(slope, x, x));
    let exponent = (size / speed).log2().round();
    if exponent.is_finite() && exponent != 0.0 { exponent.clamp(-900.0, 900.0).exp2() } else { 2.0 }
}
