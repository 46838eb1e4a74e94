//! The stretch of time on which a flow is smooth, between the stops of its mode.

use crate::automaton::Automaton;
use crate::automaton::clocks::{Clock, Source};
use crate::error::{Error, ErrorKind, Place};
use crate::step::Stepper;
use crate::time::{Span, Time, grace};

use super::Advance;

/// The times strictly between two stops, at which a step asks for the flow: at a stop itself the flow may have the value of
/// either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Smooth {
    from: f64,
    until: f64,
    /// The stop in which it ends.
    stop: f64,
}

impl Smooth {
    /// A flow without stops.
    pub(crate) const ALWAYS: Self = Self { from: f64::NEG_INFINITY, until: f64::INFINITY, stop: f64::INFINITY };

    /// The stretch that begins at `t`, or at a stop at the same instant.
    fn beginning(stops: &[Clock], t: f64) -> Result<Self, String> {
        let instant = grace(t);
        let (mut from, mut stop) = (f64::NEG_INFINITY, f64::INFINITY);
        for clock in stops {
            clock.validate()?;
            if let Some(here) = tick(clock, t - instant)?.filter(|&here| here <= t + instant) {
                from = from.max(here.next_up());
            }
            stop = stop.min(tick(clock, (t + instant).next_up())?.unwrap_or(f64::INFINITY));
        }
        Ok(Self { from, until: if stop < f64::INFINITY { stop.next_down() } else { stop }, stop })
    }

    /// The time at which the flow is asked for instead of `t`.
    #[inline]
    pub(crate) fn within(&self, t: f64) -> f64 {
        t.max(self.from).min(self.until)
    }

    /// How long it lasts from `now` on.
    #[inline]
    pub(super) fn ahead(&self, now: Time) -> f64 {
        if self.stop < f64::INFINITY { Time::new(self.stop).since(now) } else { f64::INFINITY }
    }
}

/// The first tick at `from` or later.
fn tick(clock: &Clock, from: f64) -> Result<Option<f64>, String> {
    let time = match Source::Clock(clock).next(from) {
        Ok(time) => time,
        Err(ask) => {
            let t = from.next_down();
            let time = ask.after(t).filter(|&time| time != f64::INFINITY);
            if let Some(wrong) = time.filter(|time| time.is_nan() || *time <= t) {
                return Err(format!(
                    "answers {wrong} when asked for its first stop after t = {t}: answer a later time"
                ));
            }
            time
        }
    };
    Ok(time.filter(|time| time.is_finite()))
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Looks for the stops about the present time, where the mode has any.
    #[inline]
    pub(super) fn smooth_from(&mut self, mode: A::Mode, now: Time, x: &A::State) -> Result<(), Error> {
        let stops = self.automaton.stops(mode);
        self.smooth = if stops.is_empty() { Smooth::ALWAYS } else { self.between(stops, mode, now, x)? };
        Ok(())
    }

    #[cold]
    fn between(&self, stops: &[Clock], mode: A::Mode, now: Time, x: &A::State) -> Result<Smooth, Error> {
        Smooth::beginning(stops, now.seconds()).map_err(|why| {
            let place = Place::new(now.seconds(), mode, None::<A::Edge>, x);
            Error::new(ErrorKind::Clock, place).noting(Some(why))
        })
    }

    /// Where a step of `h` from the present time ends: at the end of the span, at a stop, or before both.
    #[inline]
    pub(super) fn arrival(&self, clock: &Span, h: f64, remaining: f64) -> Arrival {
        if h >= remaining {
            Arrival { time: clock.end, at_stop: false }
        } else if h >= self.smooth.ahead(clock.now) {
            Arrival { time: Time::new(self.smooth.stop), at_stop: true }
        } else {
            Arrival { time: clock.now.after(h), at_stop: false }
        }
    }
}

/// The end of a step.
pub(super) struct Arrival {
    pub(super) time: Time,
    pub(super) at_stop: bool,
}
