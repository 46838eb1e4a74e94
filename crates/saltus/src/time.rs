//! Time kept as a sum of two doubles, so that a jump late in a run is as exact as an early one.

/// A moment t = hi + lo in seconds, the unevaluated sum of two doubles with |lo| at most half a
/// unit in the last place of hi.
///
/// A flight of a microsecond that starts at t = 10^6 s keeps its sixteen digits: [`Time::since`]
/// returns the difference of two moments without the cancellation that subtracting two doubles
/// would suffer.
///
/// ```
/// use saltus::Time;
/// let start = Time::new(1e6);
/// let mut t = start;
/// for _ in 0..1000 {
///     t = t.after(1e-6);
/// }
/// assert_eq!(t.since(start), 1e-3);
/// ```
///
/// The sum is Knuth's two-sum (D. Knuth, *The Art of Computer Programming*, vol. 2, 4.2.2, theorem
/// B).
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Time {
    hi: f64,
    lo: f64,
}

/// How far apart doubles are next to `t`, towards larger magnitudes: what a time is rounded by.
#[inline]
pub(crate) fn resolution(t: f64) -> f64 {
    t.abs().next_up() - t.abs()
}

/// How many units in the last place two times may differ by and be at one instant. A tick k·T is
/// off the time that is meant by the relative roundings of T and of the product, 2⁻⁵³ each, and so
/// is what it is compared with, a tick of another clock, a crossing or the end of a span: by 2⁻⁵¹
/// of the time together, which is less than four units.
///
/// Without it a clock of a tenth of a second misses the instants of one of three tenths
/// (tests/clocks.rs, `ticks_against_integers`), and a crossing is taken after a tick at the same
/// instant (`crossings_that_coincide`).
const GRACE: f64 = 4.0;

/// The last time of a run, in seconds: where an endless span ends. Later ones leave the range of
/// numbers where a stepper multiplies them (tests/endings.rs, `every_limit_stops_every_run`).
pub(crate) const LAST: f64 = 1e300;

/// How much later than `t` is still at the same instant.
#[inline]
pub(crate) fn grace(t: f64) -> f64 {
    if t.is_finite() { GRACE * resolution(t) } else { 0.0 }
}

impl Time {
    /// The moment `t`, in seconds.
    #[must_use]
    pub const fn new(t: f64) -> Self {
        Self { hi: t, lo: 0.0 }
    }

    /// The double nearest to this moment, in seconds.
    #[must_use]
    pub const fn seconds(self) -> f64 {
        self.hi
    }

    /// The moment a duration `s` later.
    #[inline]
    #[must_use]
    pub fn after(self, s: f64) -> Self {
        let sum = self.hi + s;
        if sum.is_infinite() {
            return Self { hi: sum, lo: 0.0 };
        }
        let back = sum - self.hi;
        let lost = (self.hi - (sum - back)) + (s - back) + self.lo;
        let hi = sum + lost;
        Self { hi, lo: lost - (hi - sum) }
    }

    /// The duration from `earlier` to this moment, rounded once.
    #[inline]
    #[must_use]
    pub fn since(self, earlier: Self) -> f64 {
        (self.hi - earlier.hi) + (self.lo - earlier.lo)
    }
}

/// The span of a run and where it stands.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Span {
    pub(crate) start: Time,
    pub(crate) now: Time,
    pub(crate) end: Time,
}

impl Span {
    /// How much of it is left.
    #[inline]
    pub(crate) fn remaining(&self) -> f64 {
        self.end.since(self.now)
    }

    /// The same as far as a stepper can go: an endless one ends near the end of numbers, where a
    /// state at rest still stands and any other is infinite, which is an error.
    #[inline]
    pub(crate) fn in_numbers(self) -> Self {
        Self { end: if self.end.seconds() < LAST { self.end } else { Time::new(LAST) }, ..self }
    }

    /// How far past its end is still at it: what rounding has made of times counted from its start.
    #[inline]
    pub(crate) fn grace(&self) -> f64 {
        grace(self.end.seconds().abs().max(self.start.seconds().abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_seconds_in_milliseconds_lose_nothing() {
        let p = 0.001_f64;
        let mut t = Time::new(0.0);
        for k in 1..=1_000_000_u32 {
            t = t.after(p);
            if k % 1000 == 0 {
                assert!((t.seconds() - f64::from(k) * p).abs() <= f64::EPSILON * t.seconds());
            }
        }
        assert_eq!(t.seconds(), 1000.0);
    }

    #[test]
    fn flights_below_the_spacing_of_time() {
        let start = Time::new(1e9);
        let t = start.after(1e-8).after(9e-9).after(8.1e-9);
        assert!((t.since(start) - 2.71e-8).abs() < 1e-23);
        assert_eq!(t.seconds(), 1e9);
    }
}
