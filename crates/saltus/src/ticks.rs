//! Which clock ticks next, and which have ticked at this instant.

use std::fmt::Debug;

use crate::automaton::Automaton;
use crate::automaton::clocks::{Clocks, Source};
use crate::error::{Error, ErrorKind, Place};
use crate::time::{self, Span, Time, resolution};

/// The ticks of a run near the present time.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Ticks<M> {
    /// Those taken so lately that rounding might show them as due again.
    taken: Vec<Tick<M>>,
    /// Those that functions have named, each of which is asked once for a tick.
    named: Vec<Tick<M>>,
    /// When the last one was taken.
    instant: Option<f64>,
}

/// A tick at a `time`, of the clock at a `place` in the list of a `mode`.
///
/// The time is written bit by bit: it is compared with what the clock says, and a format that
/// rounds numbers must not make it another.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Tick<M> {
    mode: M,
    place: usize,
    #[cfg_attr(feature = "serde", serde(with = "bits"))]
    time: f64,
}

#[cfg(feature = "serde")]
mod bits {
    use serde::{Deserialize, Deserializer, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref)] // as serde calls it
    pub(super) fn serialize<S: Serializer>(time: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u64(time.to_bits())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        u64::deserialize(deserializer).map(f64::from_bits)
    }
}

/// The tick that comes next, and when it is taken.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Due<M, E> {
    pub(crate) edge: E,
    pub(crate) time: Time,
    tick: Tick<M>,
}

/// How long an instant about the time `t` lasts, in a run whose times are counted since another.
fn grace(t: f64, since: f64) -> f64 {
    time::grace(t.abs().max(since.abs()))
}

impl<M: Copy + PartialEq + Debug> Ticks<M> {
    pub(crate) const fn new() -> Self {
        Self { taken: Vec::new(), named: Vec::new(), instant: None }
    }

    /// The next tick in `mode` within the span, if there is one.
    #[inline]
    #[allow(clippy::type_complexity)] // an option
    pub(crate) fn next<A: Automaton<Mode = M>>(
        &mut self,
        automaton: &A,
        mode: M,
        x: &A::State,
        span: &Span,
    ) -> Result<Option<Due<M, A::Edge>>, Error> {
        let clocks = automaton.clocks(mode);
        if clocks.is_empty() { Ok(None) } else { self.first(automaton, &clocks, mode, &x.clone(), span) }
    }

    /// The tick is taken now.
    pub(crate) fn take<E>(&mut self, due: &Due<M, E>, now: f64) {
        self.taken.push(due.tick);
        self.instant = Some(now);
    }

    #[inline(never)]
    #[allow(clippy::type_complexity)] // an option
    fn first<A: Automaton<Mode = M>>(
        &mut self,
        automaton: &A,
        clocks: &Clocks<'_, A::Edge>,
        mode: M,
        x: &A::State,
        span: &Span,
    ) -> Result<Option<Due<M, A::Edge>>, Error> {
        let (now, start, end) = (span.now.seconds(), span.start.seconds(), span.end.seconds());
        let behind = (0..clocks.len()).filter_map(|place| Some(clocks.get(place)?.0.behind()));
        let since = behind.fold(start.abs(), f64::max);
        let instant = grace(now, since);
        // A tick of the last instant is no later than its end, and looked for from one instant
        // before now.
        self.taken.retain(|tick| tick.time >= now - 2.0 * instant);
        self.named.retain(|tick| tick.time >= now - instant);
        let mut first: Option<Due<M, A::Edge>> = None;
        for place in 0..clocks.len() {
            let Some((source, edge)) = clocks.get(place) else { continue };
            let failed = |why: String| {
                let place = Place::new(now, mode, Some(edge), x);
                Err(Error::new(ErrorKind::Clock, place).noting(Some(why)))
            };
            let look = Look { automaton, clocks, mode, place, source, start, since, instant };
            let Some(time) = look.next(self, now).or_else(failed)? else { continue };
            // Of those within one instant the one listed first; so an earlier one must be earlier
            // by more.
            if first.as_ref().is_none_or(|first| time < first.tick.time - grace(first.tick.time, since)) {
                let tick = Tick { mode, place, time };
                first = Some(Due { edge, time: Time::new(time), tick });
                if time <= now {
                    break; // none is earlier by more than an instant
                }
            }
        }
        let grace = grace(end, since);
        let Some(due) = first.filter(|due| due.tick.time <= end + grace) else { return Ok(None) };
        // At an instant at which one was taken already, time stands.
        let at_once = due.tick.time <= now || self.instant == Some(now) && due.tick.time <= now + instant;
        let time = if at_once { span.now } else { Time::new(due.tick.time.min(end)) };
        Ok(Some(Due { time, ..due }))
    }
}

/// How the next tick of one clock is looked for.
struct Look<'a, A: Automaton> {
    automaton: &'a A,
    clocks: &'a Clocks<'a, A::Edge>,
    mode: A::Mode,
    place: usize,
    source: Source<'a>,
    start: f64,
    since: f64,
    instant: f64,
}

impl<A: Automaton> Look<'_, A> {
    /// Its first tick that is not over: neither taken at this instant nor before it.
    fn next(&self, ticks: &mut Ticks<A::Mode>, now: f64) -> Result<Option<f64>, String> {
        if let Source::Clock(clock) = self.source {
            clock.validate()?;
        }
        let mut from = now - self.instant;
        if !self.source.starts() {
            from = from.max((self.start + grace(self.start, self.since)).next_up());
        }
        let earlier = if ticks.taken.is_empty() { 0 } else { self.equal_before() };
        loop {
            let Some(time) = self.tick(ticks, from)? else { return Ok(None) };
            let taken = ticks.taken.iter().filter(|tick| tick.time == time && self.is(tick)).count();
            if taken <= earlier {
                return Ok(Some(time));
            }
            from = time.next_up();
        }
    }

    /// The first tick at `from` or later.
    fn tick(&self, ticks: &mut Ticks<A::Mode>, from: f64) -> Result<Option<f64>, String> {
        let ask = match self.source.next(from) {
            Ok(time) => return self.resolved(time, from),
            Err(ask) => ask,
        };
        let named = ticks.named.iter().filter(|tick| tick.time >= from && self.is(tick)).map(|tick| tick.time);
        if let Some(time) = named.min_by(f64::total_cmp) {
            return Ok(Some(time));
        }
        let t = from.next_down();
        let Some(time) = ask.after(t).filter(|&time| time != f64::INFINITY) else { return Ok(None) };
        if time <= t || time.is_nan() {
            return Err(format!(
                "answers {time} when asked for its first tick after t = {t}: count ticks by an integer k and answer k·T, or use Clock::every"
            ));
        }
        ticks.named.push(Tick { mode: self.mode, place: self.place, time });
        Ok(Some(time))
    }

    /// A period that is shorter than two instants has ticks that time cannot tell apart.
    fn resolved(&self, time: Option<f64>, from: f64) -> Result<Option<f64>, String> {
        let Source::Clock(clock) = self.source else { return Ok(time) };
        let Some((period, phase)) = clock.period() else { return Ok(time) };
        let largest = from.abs().max(phase);
        if period > 2.0 * grace(largest, self.since) {
            return Ok(time);
        }
        let spacing = resolution(largest);
        Err(format!(
            "has a period of {period} s, too short beside the spacing of time there, {spacing:e} s: count time from a later start"
        ))
    }

    /// How many equal clocks are listed before it.
    fn equal_before(&self) -> usize {
        (0..self.place).filter_map(|place| self.clocks.get(place)).filter(|(other, _)| self.source.is(other)).count()
    }

    /// Whether a tick is one of this clock, or of an equal one in this or another mode.
    fn is(&self, tick: &Tick<A::Mode>) -> bool {
        if tick.mode == self.mode && tick.place == self.place {
            return true;
        }
        let clocks = self.automaton.clocks(tick.mode);
        clocks.get(tick.place).is_some_and(|(source, _)| self.source.is(&source))
    }
}
