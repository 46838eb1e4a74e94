//! One arc: from the state just after a jump to the first crossing, by the exact solution or by steps.

use crate::automaton::{Automaton, Entry, Polynomial};
use crate::control::{Controller, first_step};
use crate::cross::{Crossing, Start, Undefined, first_fall, first_fall_of_polynomial, settle};
use crate::error::{Error, ErrorKind, Place};
use crate::observe::Observer;
use crate::poly::{Bernstein, MAX_DEGREE, quadratic_fall};
use crate::simulation::{Options, Stats, Stop};
use crate::state::State;
use crate::step::{Stepper, Trial};
use crate::time::Time;
use crate::trajectory::{Piece, horner};

/// The span of a run and where it stands.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Clock {
    pub(crate) start: Time,
    pub(crate) now: Time,
    pub(crate) end: Time,
}

/// How an arc ended.
pub(crate) enum ArcEnd<A: Automaton> {
    /// At a crossing; `before` is the state at its inner side.
    Crossing { edge: A::Edge, before: A::State },
    /// The run ends here.
    Stop { stop: Stop<A::Edge>, state: A::State },
}

/// The edge just taken, whose root is spent, and how far from zero its guard is there for rounding alone.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Spent<E> {
    edge: E,
    slack: f64,
}

/// How many edges that were taken at one time, and go on falling, are remembered.
const MOST_IDLE: usize = 16;

/// A guard farther from zero than this is not asked whether it crosses at the time of the last jump.
const NEAR: f64 = 1e-9;

type Found<A> = Option<(<A as Automaton>::Edge, Crossing)>;

/// What is kept from arc to arc.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Memory<E> {
    pub(crate) stats: Stats,
    controller: Controller,
    step: Option<f64>,
    spent: Option<Spent<E>>,
    /// Edges taken earlier at this time whose guards went on falling: not taken again before they have risen.
    idle: [Option<Spent<E>>; MOST_IDLE],
    /// When a scheduled edge was last taken.
    clock_took: Option<f64>,
    slack: f64,
    last_duration: f64,
}

impl<E: Copy + PartialEq> Memory<E> {
    pub(crate) fn new(error_order: f64, first_step: Option<f64>) -> Self {
        Self {
            stats: Stats::default(),
            controller: Controller::new(error_order),
            step: first_step,
            spent: None,
            idle: [None; MOST_IDLE],
            clock_took: None,
            slack: 0.0,
            last_duration: 0.0,
        }
    }

    /// The edge among those taken earlier at this time that go on falling.
    #[inline]
    fn idle_as(&self, edge: E) -> Option<Spent<E>> {
        self.idle.iter().map_while(|idle| *idle).find(|idle| idle.edge == edge)
    }

    /// Whether the last jump took this very edge.
    pub(crate) fn just_took(&self, edge: E) -> bool {
        self.spent.is_some_and(|spent| spent.edge == edge)
    }

    /// After a jump that no edge made.
    pub(crate) fn beyond(&mut self) {
        self.spent = None;
    }
}

/// Advances one arc.
pub(crate) struct Advance<'a, A: Automaton, M> {
    pub(crate) automaton: &'a A,
    pub(crate) stepper: M,
    pub(crate) options: &'a Options,
    pub(crate) memory: &'a mut Memory<A::Edge>,
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// After a jump by `edge` at the end of the arc that began at `x` in `mode`: its root is spent.
    #[inline]
    pub(crate) fn jumped(&mut self, mode: A::Mode, x: &A::State, edge: A::Edge, duration: f64, t: f64) {
        if duration > 0.0 {
            if self.memory.idle[0].is_some() {
                self.memory.idle = [None; MOST_IDLE];
            }
        } else if let Some(last) = self.memory.spent.filter(|last| last.edge != edge) {
            let g = self.automaton.guard(last.edge, t, x);
            if g.abs() <= last.slack && self.guard_slope(mode, last.edge, t, x, g) < 0.0 {
                self.memory.idle.rotate_right(1);
                self.memory.idle[0] = Some(last);
            }
        }
        self.memory.spent = Some(Spent { edge, slack: self.memory.slack });
        self.memory.last_duration = duration;
    }

    /// From `x` in `mode` to the first crossing or the end of the span.
    #[inline]
    pub(crate) fn arc(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        clock: &mut Clock,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        if let Some(edge) = self.enter(mode, x, clock.now)? {
            return Ok(ArcEnd::Crossing { edge, before: *x });
        }
        let scheduled = self.scheduled(mode, clock);
        let horizon = scheduled.map_or(clock.end, |(t, _)| Time::new(t));
        let state = if horizon.since(clock.now) <= 0.0 {
            *x
        } else {
            let mut within = Clock { end: horizon, ..*clock };
            let end = match self.automaton.exact(mode, clock.now.seconds(), x) {
                Some(solution) => self.exact(mode, &solution, &mut within, observer),
                None => self.stepped(mode, *x, &mut within, observer),
            };
            clock.now = within.now;
            match end? {
                ArcEnd::Stop { stop: Stop::Time, state } => state,
                end => return Ok(end),
            }
        };
        Ok(match scheduled {
            Some((t, edge)) => {
                self.memory.clock_took = Some(t);
                ArcEnd::Crossing { edge, before: state }
            }
            None => ArcEnd::Stop { stop: Stop::Time, state },
        })
    }

    /// The next scheduled edge after the start of the span; one that falls on the present time is due unless one was just taken.
    #[inline]
    fn scheduled(&self, mode: A::Mode, clock: &Clock) -> Option<(f64, A::Edge)> {
        let now = clock.now.seconds();
        let taken = self.memory.clock_took == Some(now);
        let after = if taken { now } else { now.next_down().max(clock.start.seconds()) };
        let next = self.automaton.scheduled(mode, after)?;
        (next.0 > after && next.0 <= clock.end.seconds()).then_some(next)
    }

    /// Looks at every guard as the mode is entered; an edge to be taken at once is returned.
    #[inline]
    fn enter(&mut self, mode: A::Mode, x: &A::State, now: Time) -> Result<Option<A::Edge>, Error> {
        let t = now.seconds();
        for edge in self.automaton.edges(mode).iter() {
            self.memory.stats.guards += 1;
            let g = self.automaton.guard(edge, t, x);
            let spent = self.memory.spent.filter(|spent| spent.edge == edge).or_else(|| self.memory.idle_as(edge));
            if spent.is_none() && g >= 0.0 && (g == 0.0 || self.memory.spent.is_some() && g <= NEAR) {
                // Zero, or so near after a jump that time cannot tell this crossing from the last: taken now if it falls.
                let slope = self.guard_slope(mode, edge, t, x, g);
                if slope < 0.0 && g <= -slope * 8.0 * f64::EPSILON * self.memory.last_duration {
                    return Ok(Some(edge));
                }
                continue;
            }
            if g > 0.0 && spent.is_none() || g == 0.0 || spent.is_some_and(|spent| g.abs() <= spent.slack) {
                continue;
            }
            if g.is_nan() {
                return Err(Error::new(ErrorKind::Guard, Place::new(t, mode, Some(edge), x)));
            }
            let slope = self.guard_slope(mode, edge, t, x, g);
            let size = (0..x.len()).map(|i| x.get(i).abs()).fold(1.0, f64::max);
            let rounding = (slope.abs() * 4.0 * (t.abs().next_up() - t.abs())).max(4.0 * f64::EPSILON * size);
            let on_wall = g.abs() <= rounding;
            match (on_wall, spent.is_some()) {
                (true, true) => {}
                (_, _) if g > 0.0 && !self.memory.just_took(edge) => {}
                (_, _) if g > 0.0 => self.memory.spent = None, // the reset led away from the wall: no root to spend
                (true, false) if slope > 0.0 => {}
                (true, false) => return Ok(Some(edge)),
                (false, _) => match self.automaton.entry(edge) {
                    Entry::Refuse => return Err(Error::new(ErrorKind::Entry, Place::new(t, mode, Some(edge), x))),
                    Entry::Fire => return Ok(Some(edge)),
                    Entry::Wait => {}
                },
            }
        }
        Ok(None)
    }

    /// dg/dt along the flow, by a difference over a time short against the last arc; where dg/dt is zero, its sign is that of d²g/dt².
    ///
    /// The shortest time is taken over which the change of the guard doubles (or quadruples) with time twice in a row: longer than
    /// rounding, shorter than the way to the guard's next root.
    fn guard_slope(&mut self, mode: A::Mode, edge: A::Edge, t: f64, x: &A::State, g: f64) -> f64 {
        let longest = if self.memory.last_duration > 0.0 { self.memory.last_duration * 1e-6 } else { 1e-6 };
        let slope = self.flow(mode, t, x);
        let middle = self.flow(mode, t + 0.5 * longest, &x.with(|i| x.get(i) + 0.5 * longest * slope.get(i)));
        let mut h = longest / f64::from(1_u32 << 30);
        loop {
            let mut change = |h: f64| {
                self.memory.stats.guards += 1;
                let bend = h / longest;
                let ahead = x.with(|i| x.get(i) + h * (slope.get(i) + bend * (middle.get(i) - slope.get(i))));
                self.automaton.guard(edge, t + h, &ahead) - g
            };
            let far = change(h);
            if h >= longest || h == 0.0 {
                return far / h.max(f64::MIN_POSITIVE);
            }
            let (half, quarter) = (change(0.5 * h), change(0.25 * h));
            let grows =
                |by: f64| (far - by * half).abs() < 0.1 * far.abs() && (half - by * quarter).abs() < 0.1 * half.abs();
            if grows(2.0) || grows(4.0) {
                return far / h;
            }
            h = (8.0 * h).min(longest);
        }
    }

    /// How the search for `edge` starts on the first piece of an arc.
    #[inline]
    fn start(&self, edge: A::Edge, first: bool) -> Start {
        if first && (self.memory.just_took(edge) || self.memory.idle_as(edge).is_some()) {
            Start::Spent
        } else {
            Start::Open
        }
    }

    // --- a mode whose flow is solved exactly ---

    #[inline]
    fn exact(
        &mut self,
        mode: A::Mode,
        solution: &Polynomial<A::State>,
        clock: &mut Clock,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        self.memory.stats.exact += 1;
        let c = solution.coefficients();
        let remaining = clock.end.since(clock.now);
        let mut found: Found<A> = None;
        for edge in self.automaton.edges(mode).iter() {
            let limit = found.map_or(past(remaining), |(_, crossing)| crossing.outside);
            let start = self.start(edge, true);
            let crossing = if c.len() <= 3 && self.automaton.affine(edge) {
                self.fall_of_parabola(edge, clock.now, c, limit, start)
            } else {
                self.fall_in_windows(edge, clock.now, c, limit, start)
                    .map_err(|s| self.undefined(mode, edge, clock.now, c, 1.0, s))?
            };
            found = earlier(found, edge, crossing);
        }
        let close = match found {
            Some(found) => self.close(found, clock.now, c, 1.0, remaining),
            None => Close { span: remaining, time: clock.end, state: end_of(c, remaining) },
        };
        let told = observer.piece(mode, &Piece::new(clock.now, close.span, 1.0, c));
        clock.now = close.time;
        Ok(match found {
            _ if told.is_break() => ArcEnd::Stop { stop: Stop::Observer, state: close.state },
            Some((edge, _)) => ArcEnd::Crossing { edge, before: close.state },
            None => ArcEnd::Stop { stop: Stop::Time, state: close.state },
        })
    }

    /// An affine guard along a parabola is a parabola.
    #[inline]
    fn fall_of_parabola(
        &mut self,
        edge: A::Edge,
        now: Time,
        c: &[A::State],
        limit: f64,
        start: Start,
    ) -> Option<Crossing> {
        let g = |x: &A::State| self.automaton.guard(edge, now.seconds(), x);
        self.memory.stats.guards += c.len() as u64 + 1;
        let constant = g(&c[0].with(|_| 0.0));
        let power = |k: usize| c.get(k).map_or(0.0, |c| g(c) - constant);
        let near = quadratic_fall([g(&c[0]), power(1), power(2)], start == Start::Spent)?;
        if near > limit {
            return None;
        }
        if near == 0.0 {
            return Some(Crossing::at_start(f64::MIN_POSITIVE));
        }
        let (automaton, count) = (self.automaton, &mut self.memory.stats.guards);
        settle(
            |s| {
                *count += 1;
                automaton.guard(edge, now.after(s).seconds(), &horner(c, s))
            },
            near,
        )
    }

    /// Searches ever longer windows, the first as long as it takes the solution to change by its own size.
    fn fall_in_windows(
        &mut self,
        edge: A::Edge,
        now: Time,
        c: &[A::State],
        limit: f64,
        start: Start,
    ) -> Result<Option<Crossing>, Undefined> {
        let size = |k: usize| (0..c[k].len()).map(|i| c[k].get(i).abs()).fold(0.0, f64::max);
        let natural = (1..c.len())
            .flat_map(|k| (0..k).map(move |j| (j, k)))
            .filter(|&(j, k)| size(j) > 0.0 && size(k) > 0.0)
            .map(|(j, k)| (size(j) / size(k)).powf(1.0 / (k - j) as f64))
            .fold(0.0, f64::max);
        let mut window = if natural > 0.0 { natural.min(limit) } else { limit.min(1.0) };
        let mut from = 0.0;
        let mut start = start;
        let (automaton, count) = (self.automaton, &mut self.memory.stats.guards);
        let mut guard = |s: f64| {
            *count += 1;
            automaton.guard(edge, now.after(s).seconds(), &horner(c, s))
        };
        loop {
            let to = if from + window < limit { from + window } else { limit };
            if let Some(crossing) =
                first_fall(|s| guard(from + s), to - from, start).map_err(|Undefined(s)| Undefined(from + s))?
            {
                let here = from + crossing.inside;
                return Ok(if here == 0.0 { Some(crossing) } else { settle(&mut guard, here) });
            }
            if to >= limit || !to.is_finite() {
                return Ok(None);
            }
            from = to;
            window *= 2.0;
            start = Start::Open;
        }
    }

    // --- a mode whose flow is stepped ---

    fn stepped(
        &mut self,
        mode: A::Mode,
        mut x: A::State,
        clock: &mut Clock,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let mut slope = self.flow(mode, clock.now.seconds(), &x);
        if !slope.is_finite() {
            return Err(Error::new(ErrorKind::Flow, Place::new(clock.now.seconds(), mode, None::<A::Edge>, &x)));
        }
        let mut first = true;
        let began = clock.now;
        let (mut shortened, mut retries) = (f64::INFINITY, 0);
        loop {
            let remaining = clock.end.since(clock.now);
            if remaining <= 0.0 {
                return Ok(ArcEnd::Stop { stop: Stop::Time, state: x });
            }
            if self.memory.stats.steps >= self.options.most_steps {
                return Ok(ArcEnd::Stop { stop: Stop::Steps { most: self.options.most_steps }, state: x });
            }
            let (h, trial) = self.accepted(mode, clock.now, &x, &slope, remaining.min(shortened))?;
            let dense = self.dense(mode, clock.now.seconds(), &x, h, &trial);
            let c = dense.as_ref();
            let last = h >= remaining;
            let limit = if last { h + 8.0 * f64::EPSILON * h.max(clock.now.since(began)) } else { h };
            let found = self.first_crossing(mode, clock.now, c, h, limit, first)?;
            if let Some((_, crossing)) = found
                && crossing.inside < 1e-3 * h
                && retries < 8
            {
                // A dense output of a step a thousand times too long rounds too coarsely to say what happens so near its start.
                shortened = (100.0 * crossing.outside).max(1e-4 * h);
                retries += 1;
                continue;
            }
            (shortened, retries) = (f64::INFINITY, 0);
            let Some(rough) = found else {
                let state = horner(c, 1.0);
                let told = observer.piece(mode, &Piece::new(clock.now, h, h, c));
                clock.now = if last { clock.end } else { clock.now.after(h) };
                if told.is_break() {
                    return Ok(ArcEnd::Stop { stop: Stop::Observer, state });
                }
                (x, slope, first) = (state, trial.slope, false);
                continue;
            };
            let relocated = self.relocated(mode, clock.now, &x, &slope, c, h, rough, limit, first)?;
            let (found, c, scale) = match &relocated {
                Some((found, dense, scale)) => (*found, dense.as_ref(), *scale),
                None => (rough, c, h),
            };
            let close = self.close(found, clock.now, c, scale, remaining);
            let told =
                close.span > 0.0 && observer.piece(mode, &Piece::new(clock.now, close.span, scale, c)).is_break();
            clock.now = close.time;
            return Ok(if told {
                ArcEnd::Stop { stop: Stop::Observer, state: close.state }
            } else {
                ArcEnd::Crossing { edge: found.0, before: close.state }
            });
        }
    }

    /// A step that the error estimate accepts, and its size.
    #[allow(clippy::type_complexity)] // a pair
    fn accepted(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        slope: &A::State,
        remaining: f64,
    ) -> Result<(f64, Trial<A::State, M::Stages<A::State>>), Error> {
        let t = now.seconds();
        let longest = remaining.min(self.options.longest_step);
        let tolerance = self.options.tolerance;
        let mut h = match self.memory.step {
            Some(h) => h,
            None => first_step(|t, x| self.flow(mode, t, x), t, x, slope, &tolerance, M::ERROR_ORDER, longest),
        };
        loop {
            // The last step is stretched or halved a little rather than followed by a tiny one.
            let size = if h * 1.01 >= longest {
                longest
            } else if h * 2.0 > longest {
                longest * 0.5
            } else {
                h
            };
            let trial = self.trial(mode, t, x, slope, size);
            let norm = self.stepper.error(size, &trial, |error| tolerance.norm(error, x, &trial.end));
            let finite = norm.is_finite() && trial.end.is_finite() && trial.slope.is_finite();
            let (accepted, factor) = self.memory.controller.judge(if finite { norm } else { f64::INFINITY });
            if accepted {
                self.memory.stats.steps += 1;
                self.memory.step = Some(if size < h { (size * factor).max(h) } else { size * factor });
                return Ok((size, trial));
            }
            self.memory.stats.rejected += 1;
            h = size * factor;
            if h <= 2.0 * (t.abs().next_up() - t.abs()) {
                let kind = if finite { ErrorKind::StepSize } else { ErrorKind::Flow };
                return Err(Error::new(kind, Place::new(t, mode, None::<A::Edge>, x)));
            }
        }
    }

    fn trial(
        &mut self,
        mode: A::Mode,
        t: f64,
        x: &A::State,
        slope: &A::State,
        h: f64,
    ) -> Trial<A::State, M::Stages<A::State>> {
        self.memory.stats.jacobians += M::JACOBIANS;
        let (automaton, count) = (self.automaton, &mut self.memory.stats.flows);
        let mut flow = |t: f64, x: &A::State| {
            *count += 1;
            automaton.flow(mode, t, x)
        };
        self.stepper.trial(&mut flow, t, x, slope, h)
    }

    fn dense(
        &mut self,
        mode: A::Mode,
        t: f64,
        x: &A::State,
        h: f64,
        trial: &Trial<A::State, M::Stages<A::State>>,
    ) -> M::Dense<A::State> {
        let (automaton, count) = (self.automaton, &mut self.memory.stats.flows);
        let mut flow = |t: f64, x: &A::State| {
            *count += 1;
            automaton.flow(mode, t, x)
        };
        self.stepper.dense(&mut flow, t, x, h, trial)
    }

    fn flow(&mut self, mode: A::Mode, t: f64, x: &A::State) -> A::State {
        self.memory.stats.flows += 1;
        self.automaton.flow(mode, t, x)
    }

    /// A real step to the crossing found on a dense output gives it the stepper's own order: the dense output of that step,
    /// looked at close to its end, where it errs by the square of the correction only.
    #[allow(clippy::too_many_arguments, clippy::type_complexity)]
    fn relocated(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        slope: &A::State,
        c: &[A::State],
        scale: f64,
        rough: (A::Edge, Crossing),
        limit: f64,
        first: bool,
    ) -> Result<Option<((A::Edge, Crossing), M::Dense<A::State>, f64)>, Error> {
        let (edge, crossing) = rough;
        let mut h = crossing.outside;
        if h <= scale * 1e-9 {
            return Ok(None); // at the start, where the dense output is exact
        }
        let near = (crossing.inside - scale * 1e-3).max(0.0);
        let rise = self.guard_on(edge, now, c, scale, near) - self.guard_on(edge, now, c, scale, crossing.inside);
        let fall = rise / (crossing.inside - near); // -dg/dt
        for _ in 0..3 {
            let trial = self.trial(mode, now.seconds(), x, slope, h);
            if !(trial.end.is_finite() && trial.slope.is_finite()) {
                return Ok(None);
            }
            let dense = self.dense(mode, now.seconds(), x, h, &trial);
            self.memory.stats.guards += 1;
            let shift = self.automaton.guard(edge, now.after(h).seconds(), &trial.end) / fall;
            if shift.is_nan() || shift.abs() > 0.1 * h {
                return Ok(None);
            }
            if shift.abs() <= 1e-5 * h {
                let ahead = (h + 2.0 * shift.abs() + 16.0 * f64::EPSILON * h).min(limit);
                let found = self.first_crossing(mode, now, dense.as_ref(), h, ahead, first)?;
                return Ok(found.map(|found| (found, dense, h)));
            }
            h = (h + shift).min(limit);
        }
        Ok(None)
    }

    // --- both ---

    /// The earliest crossing within `0..=limit` of a dense output.
    fn first_crossing(
        &mut self,
        mode: A::Mode,
        now: Time,
        c: &[A::State],
        scale: f64,
        limit: f64,
        first: bool,
    ) -> Result<Found<A>, Error> {
        let mut found: Found<A> = None;
        for edge in self.automaton.edges(mode).iter() {
            let start = self.start(edge, first);
            let affine = self.automaton.affine(edge);
            let p = if affine { self.stretched(edge, now, c, limit / scale) } else { None };
            let (automaton, count) = (self.automaton, &mut self.memory.stats.guards);
            let guard = |s: f64| {
                *count += 1;
                automaton.guard(edge, now.after(s).seconds(), &horner(c, s / scale))
            };
            let crossing = match &p {
                Some(p) => first_fall_of_polynomial(p, guard, limit, start),
                None => first_fall(guard, limit, start),
            };
            let crossing = crossing.map_err(|s| self.undefined(mode, edge, now, c, scale, s))?;
            found = earlier(found, edge, crossing);
        }
        Ok(found)
    }

    /// The powers of an affine guard along a polynomial: g(Σ cₖ θᵏ) = g(c₀) + Σ (g(cₖ) - g(0)) θᵏ.
    ///
    /// The differences are taken of the states a power of two larger, so that the guard's constant does not cost them digits.
    #[inline]
    fn composed(&mut self, edge: A::Edge, now: Time, c: &[A::State]) -> [f64; MAX_DEGREE + 1] {
        let t = now.seconds();
        self.memory.stats.guards += c.len() as u64 + 1;
        let constant = self.automaton.guard(edge, t, &c[0].with(|_| 0.0));
        let mut p = [0.0; MAX_DEGREE + 1];
        p[0] = self.automaton.guard(edge, t, &c[0]);
        for (p, c) in p[1..].iter_mut().zip(&c[1..]) {
            const LARGER: f64 = (1_u128 << 70) as f64;
            let far = self.automaton.guard(edge, t, &c.with(|i| LARGER * c.get(i))) - constant;
            *p = if far.is_finite() { far / LARGER } else { self.automaton.guard(edge, t, c) - constant };
        }
        p
    }

    /// The same in the Bernstein basis over `0..=stretch` times the scale.
    fn stretched(&mut self, edge: A::Edge, now: Time, c: &[A::State], stretch: f64) -> Option<Bernstein> {
        let mut p = self.composed(edge, now, c);
        let mut power = 1.0;
        for value in &mut p {
            *value *= power;
            power *= stretch;
        }
        Bernstein::from_powers(p[..].get(..c.len())?)
    }

    fn guard_on(&mut self, edge: A::Edge, now: Time, c: &[A::State], scale: f64, s: f64) -> f64 {
        self.memory.stats.guards += 1;
        self.automaton.guard(edge, now.after(s).seconds(), &horner(c, s / scale))
    }

    /// How the arc's last piece ends at a crossing; notes how far from zero rounding may leave the guard there.
    #[inline]
    fn close(
        &mut self,
        (edge, crossing): (A::Edge, Crossing),
        now: Time,
        c: &[A::State],
        scale: f64,
        remaining: f64,
    ) -> Close<A::State> {
        let Crossing { inside, outside, root } = crossing;
        let span = inside.min(remaining);
        let outer = self.guard_on(edge, now, c, scale, outside);
        let t = now.after(root).seconds();
        let mut guard = |x: &A::State| {
            self.memory.stats.guards += 1;
            self.automaton.guard(edge, t, x)
        };
        let nearest = horner(c, root / scale);
        let g = guard(&nearest);
        let (state, g) =
            if g >= 0.0 { (nearest, g) } else { innermost(&mut guard, &nearest, &horner(c, span / scale)) };
        self.memory.slack = 4.0 * g.abs().max(outer.abs());
        Close { span, time: now.after(root.min(remaining)), state }
    }

    fn undefined(&self, mode: A::Mode, edge: A::Edge, now: Time, c: &[A::State], scale: f64, at: Undefined) -> Error {
        let Undefined(s) = at;
        Error::new(ErrorKind::Guard, Place::new(now.after(s).seconds(), mode, Some(edge), &horner(c, s / scale)))
    }
}

/// The end of an arc's last piece.
struct Close<S> {
    span: f64,
    time: Time,
    state: S,
}

/// Of the states within rounding of a crossing, the one nearest to the root whose guard is not negative.
///
/// Always keeping the inner end would make every crossing early by half a rounding, and an elastic ball lose energy at each impact.
/// So coordinates are taken from the inner end only as far as it takes to stay inside: a ball's height, not its speed.
///
/// Returns the state and its guard, for a nearest one that is outside.
#[inline]
fn innermost<S: State>(mut guard: impl FnMut(&S) -> f64, nearest: &S, inner: &S) -> (S, f64) {
    for k in 0..nearest.len() {
        let mixed = nearest.with(|i| if i == k { inner.get(i) } else { nearest.get(i) });
        let g = guard(&mixed);
        if g >= 0.0 {
            return (mixed, g);
        }
    }
    (*inner, guard(inner))
}

/// The state at the end of a piece that may last for ever.
fn end_of<S: State>(c: &[S], span: f64) -> S {
    if span.is_finite() || c.len() > 1 { horner(c, span) } else { c[0] }
}

/// A hair past the end of the span, so that a crossing that rounding puts just behind it is taken at it.
#[inline]
fn past(remaining: f64) -> f64 {
    remaining * (1.0 + 4.0 * f64::EPSILON)
}

/// The earlier of two crossings; those that time cannot tell apart keep the order of their edges.
#[inline]
fn earlier<E: Copy>(found: Option<(E, Crossing)>, edge: E, crossing: Option<Crossing>) -> Option<(E, Crossing)> {
    match (found, crossing) {
        (found, None) => found,
        (None, Some(crossing)) => Some((edge, crossing)),
        (Some((first, a)), Some(b)) => {
            let same = b.inside >= a.inside * (1.0 - 4.0 * f64::EPSILON);
            // Of two at one time the inner end of both is kept, so that neither guard is past zero there.
            if same { Some((first, Crossing { inside: a.inside.min(b.inside), ..a })) } else { Some((edge, b)) }
        }
    }
}
