//! The stretch of time on which a flow is smooth, between the stops of its mode.

use crate::automaton::Automaton;
use crate::automaton::clocks::{Clock, Source};
use crate::certainty::FEW;
use crate::ending::Stop;
use crate::error::{Error, ErrorKind, Place};
use crate::step::Stepper;
use crate::time::{Span, Time, grace};

use super::{Advance, ArcEnd};

/// The times strictly between two stops, at which a step asks for the flow: at a stop itself the
/// flow may have the value of either side.
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

    /// The time `to`, or the last one before the first stop after `from`.
    pub(crate) fn before_stop(stops: &[Clock], from: f64, to: f64) -> f64 {
        let next = |clock: &Clock| tick(clock, from.next_up()).ok().flatten();
        stops.iter().filter_map(next).map(f64::next_down).fold(to, f64::min)
    }

    /// The time at which the flow is asked for instead of `t`.
    #[inline]
    pub(crate) fn within(&self, t: f64) -> f64 {
        // One instruction each; those that heed a time that is no number take five.
        let t = if t < self.from { self.from } else { t };
        if t > self.until { self.until } else { t }
    }

    /// The stop in which it begins, if it begins in one.
    fn start(&self) -> Option<f64> {
        (self.from > f64::NEG_INFINITY).then(|| self.from.next_down())
    }

    /// The stop at the same instant as `t`, if there is one.
    pub(crate) fn stop_at(stops: &[Clock], t: f64) -> Option<f64> {
        if stops.is_empty() { None } else { Self::beginning(stops, t).ok()?.start() }
    }

    /// How long it lasts from `now` on.
    #[inline]
    pub(super) fn ahead(&self, now: Time) -> f64 {
        if self.stop < f64::INFINITY { Time::new(self.stop).since(now) } else { f64::INFINITY }
    }
}

/// The edges that were taken in a stop because their guards switch there, each with the bits of the
/// stop: a format that rounds numbers must not make it another. Each is taken once in it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Switched<E>(Vec<(u64, E)>);

impl<E: Copy + PartialEq> Switched<E> {
    pub(super) const fn none() -> Self {
        Self(Vec::new())
    }

    fn has(&self, stop: f64, edge: E) -> bool {
        self.0.contains(&(stop.to_bits(), edge))
    }

    fn take(&mut self, stop: f64, edge: E) {
        self.0.retain(|&(other, _)| other == stop.to_bits());
        self.0.push((stop.to_bits(), edge));
    }
}

/// The first stop at the same instant as `time` and not before it, or `time` itself: what a clock's
/// tick reads of an input that switches there is the value behind.
#[inline]
pub(crate) fn later_stop(stops: &[Clock], time: Time) -> Time {
    if stops.is_empty() { time } else { later(stops, time) }
}

#[cold]
fn later(stops: &[Clock], time: Time) -> Time {
    let t = time.seconds();
    let ticks = stops.iter().filter_map(|clock| tick(clock, t.next_up()).ok().flatten());
    // The last of several: all of them are of this instant.
    let last = ticks.filter(|&stop| stop <= t + grace(t)).max_by(f64::total_cmp);
    last.map_or(time, Time::new)
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
    #[cold]
    #[inline(never)]
    pub(super) fn smooth_from(&mut self, mode: A::Mode, now: Time, x: &A::State) -> Result<(), Error> {
        let stops = self.automaton.stops(mode);
        self.smooth = if stops.is_empty() { Smooth::ALWAYS } else { self.between(&stops, mode, now, x)? };
        Ok(())
    }

    /// Goes on behind a stop; the first edge whose guard falls across it is returned.
    #[cold]
    pub(super) fn pass_stop(&mut self, mode: A::Mode, time: Time, x: &A::State) -> Result<Option<A::Edge>, Error> {
        let before = self.smooth;
        self.smooth_from(mode, time, x)?;
        let fallen = self.automaton.edges(mode).iter().find(|&edge| self.fell_at_stop(edge, x).is_some());
        if let Some(edge) = fallen {
            self.note_switch(edge, x);
            self.smooth = before; // in which the arc ends
        }
        Ok(fallen)
    }

    /// The stop behind which the state is, if the guard of `edge` switches from inside to outside
    /// in it: smooth in time on both sides of it, as the flow is, it falls there all the same.
    #[cold]
    #[inline(never)]
    pub(super) fn fell_at_stop(&mut self, edge: A::Edge, x: &A::State) -> Option<f64> {
        let stop = self.smooth.start().filter(|&stop| !self.memory.switched.has(stop, edge))?;
        self.memory.stats.guards += 2;
        let guard = |t: f64| self.automaton.guard(edge, t, x);
        let (before, behind) = (guard(stop.next_down()), guard(stop.next_up()));
        let clear = self.memory.wall(edge).is_none() || -behind > self.guard_rounding(edge, stop, x, behind, x);
        let fell = before >= 0.0 && behind < 0.0 && clear;
        fell.then(|| {
            (self.memory.slack, self.memory.leapt) = (FEW * before.max(-behind), true);
            stop
        })
    }

    /// `edge` is taken, for the switch of its guard or for another reason.
    #[cold]
    pub(super) fn note_switch(&mut self, edge: A::Edge, x: &A::State) {
        if let Some(stop) = self.fell_at_stop(edge, x) {
            self.memory.switched.take(stop, edge);
        }
    }

    /// The end of an arc for which no further step is taken; at a stop in its end a guard may yet
    /// fall.
    pub(super) fn ended(
        &mut self,
        mode: A::Mode,
        stop: Stop<A::Edge>,
        time: Time,
        x: A::State,
    ) -> Result<ArcEnd<A>, Error> {
        let t = time.seconds();
        let fallen =
            if stop == Stop::Time && self.smooth.stop <= t + grace(t) { self.pass_stop(mode, time, &x)? } else { None };
        Ok(match fallen {
            Some(edge) => ArcEnd::Crossing { edge, time, before: x },
            None => ArcEnd::Stop { stop, time, state: x },
        })
    }

    #[cold]
    fn between(&self, stops: &[Clock], mode: A::Mode, now: Time, x: &A::State) -> Result<Smooth, Error> {
        Smooth::beginning(stops, now.seconds()).map_err(|why| {
            let place = Place::new(now.seconds(), mode, None::<A::Edge>, x);
            Error::new(ErrorKind::Clock, place).noting(Some(why))
        })
    }

    /// Where a step of `h` from the present time ends: at the end of the span, at a stop, or before
    /// both.
    #[inline]
    pub(super) fn arrival(&self, clock: &Span, h: f64, (remaining, to_stop): (f64, f64)) -> Arrival {
        if h >= remaining {
            Arrival { time: clock.end, at_stop: false }
        } else if h >= to_stop {
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
