//! Samples as an input in time: held, joined by lines, or by monotone cubics.

use std::fmt;
use std::sync::Arc;

use crate::automaton::clocks::Clock;
use crate::series::Jet;

/// An input u(t) through samples: what was measured, or what a schedule says.
///
/// | | between samples (tₖ, uₖ) | |
/// |---|---|---|
/// | [`held`](Self::held) | u = uₖ for tₖ ≤ t < tₖ₊₁ | leaps at the knots |
/// | [`linear`](Self::linear) | u = uₖ + (uₖ₊₁ - uₖ) (t - tₖ)/(tₖ₊₁ - tₖ) | kinks there |
/// | [`cubic`](Self::cubic) | the cubic with slopes mₖ at both ends, which rises and falls where the samples do | has a slope everywhere |
///
/// The slope mₖ of a cubic is the harmonic mean of the slopes to both sides, weighted by their
/// lengths, and zero at a peak (F. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300,
/// doi:10.1137/0905021); at an end it is that of the parabola through three samples, limited so
/// that the cubic stays monotone.
///
/// Times are in seconds and rise; values are in any unit. Before the first sample the input has its
/// value, after the last one that one's, unless the input is [`repeated`](Self::repeated).
///
/// Its knots are [`stops`](Self::stops) of a flow that uses it: steps end there, and none goes over
/// a short pulse.
///
/// ```
/// use saltus::{Hybrid, Signal, Simulation};
/// // A heater by a schedule, in kW, and the energy that it takes.
/// let power = Signal::held([(0.0, 0.0), (60.0, 2.0), (90.0, 0.5)])?;
/// let heater = Hybrid::new().mode("on", |t, _x: &f64| power.at(t)).stops("on", power.stops());
/// let energy = Simulation::of(&heater).run("on", 0.0, 0.0..120.0)?.end.state;
/// assert!((energy - (2.0 * 30.0 + 0.5 * 30.0)).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Limits
/// Each knot costs a step, and without its stops an input costs more: steps are rejected at its
/// kinks, and errors are 25 to 150 tolerances at 1e-9. Only of a smooth record with many samples in
/// the time in which the state changes, at 1e-6 or looser, are fewer steps taken without.
#[derive(Clone, Debug)]
pub struct Signal {
    knots: Arc<[Knot]>,
    kind: Kind,
    period: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    t: f64,
    value: f64,
    slope: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Held,
    Linear,
    Cubic,
}

/// Why samples are no input.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SignalError {
    /// There are none.
    Empty,
    /// A time or a value is not a finite number.
    NotFinite {
        /// Its place, counted from 0.
        place: usize,
        /// The sample, time and value.
        sample: (f64, f64),
    },
    /// A time is not after the one before.
    NotRising {
        /// The place of the later one, counted from 0.
        place: usize,
        /// Both times.
        times: [f64; 2],
    },
    /// The period is not a finite number above zero, or shorter than the samples last.
    Period {
        /// The period, in seconds.
        period: f64,
        /// How long the samples last.
        lasts: f64,
    },
    /// The first and the last sample are a period apart and differ.
    Ends {
        /// Their values.
        values: [f64; 2],
    },
}

impl fmt::Display for SignalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "an input without samples: give one at least"),
            Self::NotFinite { place, sample: (t, value) } => {
                write!(f, "sample {place} is {value} at t = {t}: leave out what is not a number")
            }
            Self::NotRising { place, times: [before, t] } => write!(
                f,
                "sample {place} is at t = {t}, not after the one before it at t = {before}: sort the samples by time, and give one for each time"
            ),
            Self::Period { period, lasts } => write!(
                f,
                "a period of {period} s for samples that last {lasts} s: give a finite one above zero that is no shorter"
            ),
            Self::Ends { values: [first, last] } => write!(
                f,
                "the first and the last sample are a period apart, with values {first} and {last}: leave out the last one, or make them equal"
            ),
        }
    }
}

impl std::error::Error for SignalError {}

impl Signal {
    /// Each sample is held until the next.
    ///
    /// # Errors
    /// [`SignalError`]: no samples, numbers that are not finite, times that do not rise.
    pub fn held(samples: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, SignalError> {
        Self::new(samples, Kind::Held)
    }

    /// Samples are joined by straight lines.
    ///
    /// ```
    /// use saltus::Signal;
    /// let ramp = Signal::linear([(1.0, 0.0), (3.0, 4.0)])?;
    /// assert_eq!([0.0, 1.5, 3.0, 9.0].map(|t| ramp.at(t)), [0.0, 1.0, 4.0, 4.0]);
    /// # Ok::<(), saltus::SignalError>(())
    /// ```
    ///
    /// # Errors
    /// As [`held`](Self::held).
    pub fn linear(samples: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, SignalError> {
        Self::new(samples, Kind::Linear)
    }

    /// Samples are joined by cubics that rise and fall only where the samples do.
    ///
    /// ```
    /// use saltus::Signal;
    /// let step = Signal::cubic([(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (3.0, 1.0)])?;
    /// assert_eq!([0.5, 1.5, 2.5].map(|t| step.at(t)), [0.0, 0.5, 1.0]); // it does not overshoot
    /// # Ok::<(), saltus::SignalError>(())
    /// ```
    ///
    /// # Errors
    /// As [`held`](Self::held).
    pub fn cubic(samples: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, SignalError> {
        Self::new(samples, Kind::Cubic)
    }

    /// The same over and over, before the first sample as well: u(t + `period`) = u(t).
    ///
    /// The last sample is joined to the first of the next period. If they are a whole period apart,
    /// they must be equal, unless samples are held.
    ///
    /// ```
    /// use saltus::Signal;
    /// let triangle = Signal::linear([(0.0, 0.0), (1.0, 1.0)])?.repeated(2.0)?;
    /// assert_eq!([-0.5, 0.5, 1.5, 2.5].map(|t| triangle.at(t)), [0.5; 4]);
    /// # Ok::<(), saltus::SignalError>(())
    /// ```
    ///
    /// # Errors
    /// [`SignalError::Period`], [`SignalError::Ends`].
    pub fn repeated(self, period: f64) -> Result<Self, SignalError> {
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        let lasts = last.t - first.t;
        let whole = lasts == period || last.t == first.t + period;
        if !(period > 0.0 && period.is_finite() && (lasts < period || whole)) {
            return Err(SignalError::Period { period, lasts });
        }
        let mut knots = self.knots.to_vec();
        if whole {
            if self.kind != Kind::Held && first.value != last.value {
                return Err(SignalError::Ends { values: [first.value, last.value] });
            }
            knots.pop();
        }
        let mut repeated = Self { knots: knots.into(), period: Some(period), ..self };
        repeated.lean();
        Ok(repeated)
    }

    /// The input at `t`, in seconds.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let Some([before, after]) = self.around(t) else { return self.beyond(t) };
        let length = after.t - before.t;
        let u = (t - before.t) / length;
        let rise = after.value - before.value;
        match self.kind {
            Kind::Held => before.value,
            Kind::Linear => before.value + u * rise,
            Kind::Cubic => {
                let (m, n) = (length * before.slope, length * after.slope);
                before.value + u * (m + u * ((3.0 * rise - 2.0 * m - n) + u * (m + n - 2.0 * rise)))
            }
        }
    }

    /// The rate at which the input changes at `t`, in its unit per second; at a sample that behind
    /// it.
    ///
    /// ```
    /// use saltus::Signal;
    /// let ramp = Signal::linear([(0.0, 1.0), (2.0, 5.0)])?;
    /// assert_eq!([ramp.rate(-1.0), ramp.rate(0.0), ramp.rate(2.0)], [0.0, 2.0, 0.0]);
    /// # Ok::<(), saltus::SignalError>(())
    /// ```
    #[must_use]
    pub fn rate(&self, t: f64) -> f64 {
        let (from, [_, slope, bend, twist]) = self.piece(t);
        let s = t - from;
        slope + s * (2.0 * bend + s * (3.0 * twist))
    }

    /// The input at a time that carries a derivative, in a model for
    /// [`Linearize`](crate::Linearize): a guard that asks for `at(t.re())` instead would lose how
    /// the input changes.
    ///
    /// ```
    /// use saltus::Signal;
    /// use saltus::num_dual::Dual64;
    /// let ramp = Signal::linear([(0.0, 1.0), (2.0, 5.0)])?;
    /// assert_eq!(ramp.over(Dual64::new(1.0, 1.0)), Dual64::new(3.0, 2.0));
    /// # Ok::<(), saltus::SignalError>(())
    /// ```
    #[cfg(feature = "num-dual")]
    #[must_use]
    pub fn over<D: crate::Number>(&self, t: D) -> D {
        let (from, [value, slope, bend, twist]) = self.piece(t.re());
        let s = t - from;
        (((s * twist) + bend) * s + slope) * s + value
    }

    /// The input along a series, in a flow for [`Hybrid::series`](crate::Hybrid::series); its knots
    /// are stops of the mode all the same.
    ///
    /// ```
    /// use saltus::{Hybrid, Signal, Simulation};
    /// let ramp = Signal::linear([(0.0, 0.0), (2.0, 2.0)])?;
    /// let filled = Hybrid::new()
    ///     .mode("fill", |t, _x: &[f64; 1]| [ramp.at(t)])
    ///     .series("fill", |t, [_]| [ramp.along(t)])
    ///     .stops("fill", ramp.stops());
    /// let run = Simulation::of(&filled).run("fill", [0.0], 0.0..3.0)?;
    /// assert!((run.end.state[0] - 4.0).abs() < 1e-14 && run.end.stats.steps <= 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn along<'a>(&self, t: Jet<'a>) -> Jet<'a> {
        let (from, [value, slope, bend, twist]) = self.piece(t.value());
        let s = t - from;
        ((s * twist + bend) * s + slope) * s + value
    }

    /// Before the first sample and after the last.
    fn beyond(&self, t: f64) -> f64 {
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        if t < first.t { first.value } else { last.value }
    }

    /// The polynomial at `t`: from when it counts, and its coefficients.
    fn piece(&self, t: f64) -> (f64, [f64; 4]) {
        let Some([before, after]) = self.around(t) else { return (t, [self.beyond(t), 0.0, 0.0, 0.0]) };
        let length = after.t - before.t;
        let secant = (after.value - before.value) / length;
        let (m, n) = (before.slope, after.slope);
        let coefficients = match self.kind {
            Kind::Held => [before.value, 0.0, 0.0, 0.0],
            Kind::Linear => [before.value, secant, 0.0, 0.0],
            Kind::Cubic => {
                let (bend, twist) = ((3.0 * secant - 2.0 * m - n) / length, (m + n - 2.0 * secant) / length / length);
                [before.value, m, bend, twist]
            }
        };
        (before.t, coefficients)
    }

    /// When it is not smooth: at its knots, for [`Hybrid::stops`](crate::Hybrid::stops) or
    /// [`Automaton::stops`](crate::Automaton::stops).
    #[must_use]
    pub fn stops(&self) -> Clock {
        let knots = Clock::at(self.knots.iter().map(|knot| knot.t).collect::<Vec<_>>());
        match self.period {
            Some(period) => knots.repeated(period),
            None => knots,
        }
    }

    fn new(samples: impl IntoIterator<Item = (f64, f64)>, kind: Kind) -> Result<Self, SignalError> {
        let knots: Vec<_> = samples.into_iter().map(|(t, value)| Knot { t, value, slope: 0.0 }).collect();
        if knots.is_empty() {
            return Err(SignalError::Empty);
        }
        let finite = |knot: &Knot| knot.t.is_finite() && knot.value.is_finite();
        if let Some(place) = knots.iter().position(|knot| !finite(knot)) {
            return Err(SignalError::NotFinite { place, sample: (knots[place].t, knots[place].value) });
        }
        if let Some(place) = knots.windows(2).position(|pair| pair[0].t >= pair[1].t) {
            return Err(SignalError::NotRising { place: place + 1, times: [knots[place].t, knots[place + 1].t] });
        }
        let mut signal = Self { knots: knots.into(), kind, period: None };
        signal.lean();
        Ok(signal)
    }

    /// Gives each knot of a cubic its slope.
    fn lean(&mut self) {
        if self.kind != Kind::Cubic {
            return;
        }
        let count = self.knots.len();
        let secant = |place: usize| self.pair(place).map(|[a, b]| (b.t - a.t, (b.value - a.value) / (b.t - a.t)));
        let slope = |place: usize| {
            let before = if place > 0 { secant(place - 1) } else { self.period.and(secant(count - 1)) };
            match (before, secant(place)) {
                (Some(before), Some(after)) => mean(before, after),
                (None, Some(first)) => at_end(first, secant(place + 1)),
                (Some(last), None) => at_end(last, place.checked_sub(2).and_then(secant)),
                (None, None) => 0.0,
            }
        };
        let knots = self.knots.iter().enumerate().map(|(place, knot)| Knot { slope: slope(place), ..*knot });
        self.knots = knots.collect();
    }

    /// A knot and the one after it, in the next period if it is the last of one.
    fn pair(&self, place: usize) -> Option<[Knot; 2]> {
        let before = *self.knots.get(place)?;
        match (self.knots.get(place + 1), self.period) {
            (Some(after), _) => Some([before, *after]),
            (None, Some(period)) => Some([before, Knot { t: self.knots[0].t + period, ..self.knots[0] }]),
            (None, None) => None,
        }
    }

    /// The knots between which `t` lies, the first of which may be at it; none beyond the samples.
    fn around(&self, t: f64) -> Option<[Knot; 2]> {
        let cycle = self.cycle(t);
        let place = self
            .guess(t, cycle)
            .unwrap_or_else(|| self.knots.partition_point(|knot| self.late(knot, cycle) <= t).wrapping_sub(1));
        let mut pair = self.pair(place)?;
        for knot in &mut pair {
            knot.t = self.late(knot, cycle);
        }
        Some(pair)
    }

    /// The place of the last knot at or before `t` if samples follow each other evenly.
    fn guess(&self, t: f64, cycle: f64) -> Option<usize> {
        let last = self.knots.len() - 1;
        let (start, end) = (self.late(&self.knots[0], cycle), self.late(&self.knots[last], cycle));
        #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a place
        let place = ((t - start) / (end - start) * last as f64) as usize;
        let follows = |place: usize| self.knots.get(place).map(|knot| self.late(knot, cycle));
        let here = follows(place)? <= t && follows(place + 1)? > t;
        here.then_some(place)
    }

    /// Of which period `t` is, counted from that of the samples.
    fn cycle(&self, t: f64) -> f64 {
        let Some(period) = self.period else { return 0.0 };
        let near = ((t - self.knots[0].t) / period).floor();
        let starts = |cycle: f64| self.late(&self.knots[0], cycle);
        if starts(near) > t {
            near - 1.0
        } else if starts(near + 1.0) <= t {
            near + 1.0
        } else {
            near
        }
    }

    /// When a knot is, so many periods later.
    fn late(&self, knot: &Knot, cycle: f64) -> f64 {
        self.period.map_or(knot.t, |period| cycle.mul_add(period, knot.t))
    }
}

/// The slope between two stretches of these lengths and slopes.
fn mean((length, slope): (f64, f64), (next_length, next): (f64, f64)) -> f64 {
    if slope * next <= 0.0 {
        return 0.0;
    }
    let (w, v) = (2.0 * next_length + length, next_length + 2.0 * length);
    (w + v) / (w / slope + v / next)
}

/// The slope at the outer end of a stretch, by the parabola through the one beside it as well.
fn at_end((length, slope): (f64, f64), beside: Option<(f64, f64)>) -> f64 {
    let Some((next_length, next)) = beside else { return slope };
    let end = ((2.0 * length + next_length) * slope - length * next) / (length + next_length);
    if end * slope <= 0.0 {
        0.0
    } else if slope * next <= 0.0 && end.abs() > 3.0 * slope.abs() {
        3.0 * slope
    } else {
        end
    }
}
