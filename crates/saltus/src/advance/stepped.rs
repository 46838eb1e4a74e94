//! An arc whose flow is stepped.

use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::automaton::refusal::{flow_undefined, wrong_dimension};
use crate::certainty::{FEW, MINUTE, ROUGHLY, ROUNDINGS, SMALL};
use crate::control::{Controller, first_step};
use crate::cross::Evidence;
use crate::ending::Stop;
use crate::error::{Error, ErrorKind, Place, not_finite};
use crate::inspection::Inspection;
use crate::observe::Observer;
use crate::piece::{Piece, horner};
use crate::poly::value_and_slope;
use crate::state::State;
use crate::step::{Stepper, Trial};
use crate::time::{Span, Time, resolution};

use super::affine::exceeds;
use super::crossing::{OnStep, Range};
use super::grazing::is_alike;
use super::memory::Kept;
use super::shared::Step;
use super::smooth::Arrival;
use super::{Advance, ArcEnd};

/// The shortest step, in spacings of time.
pub(super) const SHORTEST: f64 = 2.0;

/// After a crossing a step may be so many times as long as the arc that it ended: a flight takes
/// twice as long as the drop before. A flow whose error estimate is zero would lengthen it at every
/// arc, until its crossings were lost at its start. Ten times, and
/// `far::a_span_of_any_length_shows_the_same_bounces` fails; a tenth, and
/// `steppers::a_crossing_costs_one_more_step` does.
const NEXT_ARC: f64 = 2.0;

/// A last step is lengthened by up to this factor rather than followed by a tiny one.
const STRETCHED: f64 = 1.01;
/// With no more coordinates than these a guard is probed in each of them.
const MOST_PROBED: usize = 8;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// From `x`, where the arc begins or (not `first`) has come to by other means.
    /// A long loop: each of its parts decides what goes on to the next step.
    pub(super) fn stepped(
        &mut self,
        mode: A::Mode,
        start: A::State,
        mut clock: Span,
        mut first: bool,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        self.stepper = self.stepper.adapted(self.memory.gait.stiff);
        let rate = self.slope(mode, clock.now, &start)?;
        let before = self.memory.before.take();
        self.memory.kept = before.and_then(|(y, fell)| match (is_alike(&fell, &rate), is_alike(&y, &start)) {
            (true, _) => Some(Kept::Slope),
            (false, true) => Some(Kept::State),
            (false, false) => None,
        });
        if !rate.is_finite() {
            let which = Some(not_finite(&rate));
            return Err(flow_undefined(self.automaton, mode, clock.now.seconds(), &start, which));
        }
        // Copies: what others refer to is kept in memory, and waited for at every step.
        let (mut x, mut slope) = (start, rate);
        let unguarded = self.automaton.edges(mode).is_empty();
        let began = clock.now;
        loop {
            let remaining = clock.remaining();
            if let Some(stop) = self.over(remaining) {
                return self.ended(mode, stop, clock.now, x);
            }
            let to_stop = self.smooth.ahead(clock.now);
            let Some((h, trial)) = self.accepted(mode, clock.now, (&x, &slope), remaining.min(to_stop)) else {
                return self.too_short(mode, clock.now, (&x.clone(), &slope.clone()));
            };
            let Arrival { time: arrival, at_stop } = self.arrival(&clock, h, (remaining, to_stop));
            let clear = unguarded || !first && self.clear(mode, clock.now, &x, h, &trial, observer);
            if clear {
                self.memory.walls.clear(); // clear of zero
                if !at_stop && !observer.wants_pieces() {
                    self.memory.reaches(&x, |i| h * slope.get(i));
                    (clock.now, x, first, slope) = (arrival, trial.end, false, trial.slope);
                    continue;
                }
            }
            let dense = self.dense(mode, clock.now.seconds(), &x.clone(), h, &trial.clone());
            let step = Step { now: clock.now, c: dense.as_ref(), scale: h, size: h };
            if first
                && h > f64::EPSILON * clock.now.seconds().abs()
                && self.contradicted(mode, &x.clone(), &slope.clone(), step)
            {
                self.memory.stats.steps -= 1;
                self.memory.stats.rejected += 1;
                self.memory.step = Some(ROUGHLY * h); // far shorter, for a motion that is far slower
                continue;
            }
            if first {
                self.find_staying(mode, step, &slope.clone());
            }
            let limit = if h < remaining { h } else { h + clock.grace() };
            let range = Range { limit, first, roughly: true };
            let found = if clear {
                None
            } else if limit > 2.0 * h {
                self.on_line(mode, (&slope.clone(), step), range, observer)?
            } else {
                self.first_crossing(mode, step, range, Some(observer))?
            };
            if first && !self.memory.idle.is_empty() {
                let reached = found.as_ref().map_or(limit, |found| found.crossing.inside);
                if let Some(edge) = self.chatters(mode, step, reached) {
                    return Ok(ArcEnd::Crossing { edge, time: clock.now, before: x });
                }
            }
            if let Some(rough) = found {
                // The rest of the step was not used, and says nothing of the next.
                self.memory.cut(h.max(NEXT_ARC * (clock.now.since(began) + rough.crossing.root)));
                return self.closed_in(mode, (&x.clone(), &slope.clone(), step), (&rough, range), remaining, observer);
            }
            // Where guards were looked at, the state goes on from where they were asked last.
            let state = if clear { trial.end.clone() } else { horner(step.c, 1.0) };
            if observer.piece(mode, &Piece::new(clock.now, h, h, step.c)).is_break() {
                return Ok(ArcEnd::Stop { stop: Stop::Observer, time: arrival, state });
            }
            self.memory.reaches(&x.clone(), |i| h * slope.get(i));
            (clock.now, x, first, slope) = (arrival, state, false, trial.slope);
            if at_stop {
                if let Some(edge) = self.pass_stop(mode, clock.now, &x.clone())? {
                    return Ok(ArcEnd::Crossing { edge, time: clock.now, before: x });
                }
                slope = self.slope(mode, clock.now, &x.clone())?;
            }
            if !self.memory.walls.is_empty() {
                self.keep_staying(mode, clock.now, &x.clone(), h);
            }
        }
    }

    /// The first crossing on a last step that is shorter than the rounding of time: on a line,
    /// which goes on beyond its end.
    #[cold]
    #[inline(never)]
    fn on_line(
        &mut self,
        mode: A::Mode,
        (slope, step): (&A::State, Step<'_, A::State>),
        range: Range,
        observer: &mut impl Observer<A>,
    ) -> Result<Option<OnStep<A>>, Error> {
        let line = [step.c[0].clone(), slope.with(|i| step.scale * slope.get(i))];
        self.first_crossing(mode, Step { c: &line, ..step }, range, Some(observer))
    }

    /// The end of the arc at a crossing that the dense output of a `step` shows only roughly:
    /// looked for again on a real step to it.
    fn closed_in(
        &mut self,
        mode: A::Mode,
        (x, slope, step): (&A::State, &A::State, Step<'_, A::State>),
        (rough, range): (&OnStep<A>, Range),
        remaining: f64,
        observer: &mut impl Observer<A>,
    ) -> Result<ArcEnd<A>, Error> {
        let settled = Range { roughly: false, ..range };
        if let Some(Closer { dense, h, ahead, slope: arrived }) = self.closer(mode, x, slope, step, rough, range.limit)
        {
            let closer = Step { now: step.now, c: dense.as_ref(), scale: h, size: h };
            let range = Range { limit: ahead, ..settled };
            if let Some(again) = self.first_crossing(mode, closer, range, None)? {
                if again.edge != rough.edge {
                    self.tied.push(rough.edge);
                }
                return Ok(self.crossed(mode, &again, (closer, Some(arrived)), remaining, observer));
            }
        }
        let found = self.first_crossing(mode, step, settled, None)?;
        let found = found.as_ref().unwrap_or(rough);
        let slope = slope_of(step.c, step.scale, found.crossing.root);
        Ok(self.crossed(mode, found, (step, Some(slope)), remaining, observer))
    }

    /// Why no further step is taken with so much of the span `remaining`, if none is.
    #[inline]
    pub(super) fn over(&self, remaining: f64) -> Option<Stop<A::Edge>> {
        if remaining <= 0.0 { Some(Stop::Time) } else { self.options.exceeded(&self.memory.stats) }
    }

    /// The end of the arc at a crossing `found` on its last piece, with x' there if that is a step.
    #[inline]
    pub(super) fn crossed(
        &mut self,
        mode: A::Mode,
        found: &OnStep<A>,
        (Step { now, c, scale, .. }, slope): (Step<'_, A::State>, Option<A::State>),
        remaining: f64,
        observer: &mut impl Observer<A>,
    ) -> ArcEnd<A> {
        if let Some(slope) = c.get(1) {
            let part = found.crossing.root / scale;
            self.memory.reaches(&c[0], |i| part * slope.get(i));
        }
        let close = self.close((found.edge, found.crossing), now, |s| found.at(c, scale, s), remaining, false);
        self.memory.before = slope.map(|slope| (close.state.clone(), slope));
        let told = if close.span > 0.0 {
            observer.piece(mode, &Piece::new(now, close.span, scale, c))
        } else {
            ControlFlow::Continue(())
        };
        ArcEnd::after(Some(found.edge), told, close.time, close.state)
    }

    /// A step that the error estimate accepts, no longer than what is `ahead`, and its size; none
    /// where that is as short as the spacing of time.
    #[inline(always)] // else a trial would be moved, and waited for
    fn accepted(
        &mut self,
        mode: A::Mode,
        now: Time,
        (x, slope): (&A::State, &A::State),
        ahead: f64,
    ) -> Option<SizedTrial<A, M>> {
        self.change_method();
        let longest = ahead.min(self.options.longest_step);
        let tolerance = self.options.tolerance;
        let mut wanted = match self.memory.step {
            Some(h) => h,
            None => {
                let order = self.stepper.error_order();
                first_step(
                    |t, x| self.flow(mode, t, x),
                    now.seconds(),
                    &x.clone(),
                    &slope.clone(),
                    &tolerance,
                    order,
                    longest,
                )
            }
        };
        loop {
            let h = evened(wanted, longest);
            let trial = self.trial(mode, now.seconds(), x, slope, h);
            let error = self.square_of_error(x, h, &trial);
            let (accepted, factor) = self.memory.controller.judge(error, h);
            if accepted {
                self.memory.stats.steps += 1;
                self.memory.step = Some(if h < wanted { (h * factor).max(wanted) } else { h * factor });
                self.notice_stiffness(mode, now.seconds(), x, h, &trial, slope);
                return Some((h, trial));
            }
            self.memory.stats.rejected += 1;
            self.memory.gait.rejected();
            wanted = h * factor;
            if wanted <= SHORTEST * resolution(now.seconds()) {
                self.memory.step = Some(h);
                return None;
            }
        }
    }

    /// The square of the error of a `trial` of the size `h` from `x`, in what the tolerance allows;
    /// no number where it leads to none.
    #[inline(always)]
    fn square_of_error(&self, x: &A::State, h: f64, trial: &Trial<A::State, M::Stages<A::State>>) -> f64 {
        let tolerance = self.options.tolerance;
        let error = self.stepper.error(h, trial.as_ref(), |error| tolerance.square(error, x, &trial.end));
        if trial.end.is_finite() && trial.slope.is_finite() { error } else { f64::NAN }
    }

    /// The end of an arc on which no step is accepted, at a crossing where its flow ends or by an
    /// error.
    #[cold]
    #[inline(never)]
    fn too_short(&mut self, mode: A::Mode, now: Time, (x, slope): (&A::State, &A::State)) -> Result<ArcEnd<A>, Error> {
        let place = Place::new(now.seconds(), mode, None::<A::Edge>, x);
        let h = self.memory.step.unwrap_or_default();
        let trial = self.retried(mode, now.seconds(), x, slope, h);
        if !self.square_of_error(x, h, &trial).is_nan() {
            return Err(Error::new(ErrorKind::StepSize, place));
        }
        let which = Some(not_finite(&trial.slope)).filter(|which| !which.is_empty());
        self.edge_of_flow(mode, now, x, slope, Error::new(ErrorKind::Flow, place).noting(which))
    }

    #[inline(always)] // else a trial would be moved, and waited for
    fn trial(
        &mut self,
        mode: A::Mode,
        t: f64,
        x: &A::State,
        slope: &A::State,
        h: f64,
    ) -> Trial<A::State, M::Stages<A::State>> {
        self.memory.stats.jacobians += self.stepper.jacobians();
        let (automaton, smooth, count) = (self.automaton, self.smooth, &mut self.memory.stats.flows);
        let mut flow = |t: f64, x: &A::State| {
            *count += 1;
            automaton.flow(mode, smooth.within(t), x)
        };
        self.stepper.sparse(&mut flow, t, x, slope, (h, self.sparsity.as_ref()))
    }

    /// Once more, for a step to a crossing: out of line, so that what every step runs through stays
    /// short.
    #[inline(never)]
    fn retried(
        &mut self,
        mode: A::Mode,
        t: f64,
        x: &A::State,
        slope: &A::State,
        h: f64,
    ) -> Trial<A::State, M::Stages<A::State>> {
        self.trial(mode, t, x, slope, h)
    }

    fn dense(
        &mut self,
        mode: A::Mode,
        t: f64,
        x: &A::State,
        h: f64,
        trial: &Trial<A::State, M::Stages<A::State>>,
    ) -> M::Dense<A::State> {
        let (automaton, smooth, count) = (self.automaton, self.smooth, &mut self.memory.stats.flows);
        let mut flow = |t: f64, x: &A::State| {
            *count += 1;
            automaton.flow(mode, smooth.within(t), x)
        };
        self.stepper.dense(&mut flow, t, x, h, trial.as_ref())
    }

    /// The crossing within rounding of a state `x` beyond which the flow is no number: of a contact
    /// that ends where its force does, as d^1.5. Without one, the `error` or why the flow refuses.
    #[cold]
    fn edge_of_flow(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        slope: &A::State,
        error: Error,
    ) -> Result<ArcEnd<A>, Error> {
        // A step is tried until it is shorter than the spacing of time; the one before failed too.
        let by = SHORTEST / Controller::SMALLEST * resolution(now.seconds());
        let ahead = |s: f64| x.with(|i| x.get(i) + s * slope.get(i));
        for edge in self.automaton.edges(mode).iter() {
            self.memory.stats.guards += 4;
            let guard = |s: f64| self.guard(edge, now.after(s).seconds(), &ahead(s));
            let (here, there) = (guard(0.0), guard(by));
            if here >= 0.0 && there < 0.0 {
                let root = by * here / (here - there);
                // A state a little inside where rounding leaves the nearest one outside.
                let s = [root, (1.0 - ROUGHLY) * root].into_iter().find(|&s| guard(s) >= 0.0).unwrap_or(0.0);
                self.memory.slack = FEW * (here - there);
                return Ok(ArcEnd::Crossing { edge, time: now.after(root), before: ahead(s) });
            }
        }
        let refusal = self.automaton.refusal(mode, None, now.after(by).seconds(), &ahead(by));
        Err(refusal.map_or(error, |refusal| refusal.at("flow", Place::new(now.seconds(), mode, None::<A::Edge>, x))))
    }

    /// The flow, of as many coordinates as the state.
    #[inline]
    pub(super) fn slope(&mut self, mode: A::Mode, time: Time, x: &A::State) -> Result<A::State, Error> {
        let slope = self.flow(mode, time.seconds(), x);
        if slope.len() == x.len() { Ok(slope) } else { Err(wrong_dimension(slope.len(), mode, time.seconds(), x)) }
    }

    pub(super) fn flow(&mut self, mode: A::Mode, t: f64, x: &A::State) -> A::State {
        self.memory.stats.flows += 1;
        self.automaton.flow(mode, self.smooth.within(t), x)
    }

    /// Whether no guard can come to zero over a step, for how far the dense output reaches from its
    /// start at most: then it need not be computed.
    ///
    /// Only affine guards say how far they follow the state. The answer is the same whoever
    /// observes.
    #[inline]
    fn clear(
        &mut self,
        mode: A::Mode,
        now: Time,
        x: &A::State,
        h: f64,
        trial: &Trial<A::State, M::Stages<A::State>>,
        observer: &mut impl Observer<A>,
    ) -> bool {
        if x.len() > MOST_PROBED {
            return false;
        }
        let Some(reach) = self.stepper.reach(h, trial.as_ref()) else { return false };
        let (edges, t) = (self.automaton.edges(mode), now.seconds());
        for edge in edges.iter() {
            if !self.automaton.about(edge).affine {
                return false;
            }
            self.memory.stats.guards += x.len() as u64 + 2;
            let guard = |x: &A::State| self.guard(edge, t, x);
            let (constant, start) = (guard(&x.with(|_| 0.0)), guard(x));
            let mut most = 0.0;
            for k in 0..x.len() {
                let probe = x.with(|i| if i == k { reach.get(i) } else { 0.0 });
                most += (guard(&probe) - constant).abs();
            }
            if !exceeds(start, most, constant) {
                return false;
            }
        }
        for edge in edges.iter() {
            observer.inspection(&Inspection { mode, edge, start: now, span: h, evidence: Evidence::Excluded });
        }
        true
    }

    /// A real step to the crossing found on a dense output gives it the stepper's own order: the
    /// dense output of that step, to be looked at close to its end, where it errs by the square of
    /// the correction only.
    fn closer(
        &mut self,
        mode: A::Mode,
        x: &A::State,
        slope: &A::State,
        step: Step<'_, A::State>,
        &OnStep { edge, crossing, slope: dg_dt, .. }: &OnStep<A>,
        limit: f64,
    ) -> Option<CloserOf<A, M>> {
        let Step { now, scale, .. } = step;
        let mut h = crossing.outside;
        // So close to the start the dense output is exact.
        if h <= MINUTE * scale {
            return None;
        }
        let fall = -dg_dt.unwrap_or_else(|| self.slope_before(edge, step, crossing.inside));
        for _ in 0..3 {
            let trial = self.retried(mode, now.seconds(), x, slope, h);
            if !(trial.end.is_finite() && trial.slope.is_finite()) {
                return None;
            }
            let dense = self.dense(mode, now.seconds(), x, h, &trial);
            self.memory.stats.guards += 1;
            let shift = self.guard(edge, now.after(h).seconds(), &trial.end) / fall;
            if shift.is_nan() || shift.abs() > ROUGHLY * h {
                return None;
            }
            // A correction this small leaves its square of what the dense output errs by within.
            if shift.abs() <= SMALL * h {
                let ahead = (h + 2.0 * shift.abs() + ROUNDINGS * f64::EPSILON * h).min(limit);
                return Some(Closer { dense, h, ahead, slope: trial.slope });
            }
            h = (h + shift).min(limit);
        }
        None
    }

    /// dg/dt shortly before a time `s` of a step, by differences.
    #[inline(never)]
    fn slope_before(&mut self, edge: A::Edge, step: Step<'_, A::State>, s: f64) -> f64 {
        let near = (s - SMALL * step.scale).max(0.0);
        (self.on(edge, step, s) - self.on(edge, step, near)) / (s - near)
    }
}

/// The size of a step, and what it is tried to lead to.
type SizedTrial<A, M> = (f64, Trial<<A as Automaton>::State, <M as Stepper>::Stages<<A as Automaton>::State>>);

type CloserOf<A, M> = Closer<<A as Automaton>::State, <M as Stepper>::Dense<<A as Automaton>::State>>;

/// A step `h` that ends closer to a crossing, with x' there, and how far `ahead` that may be.
struct Closer<S, D> {
    dense: D,
    h: f64,
    ahead: f64,
    slope: S,
}

/// x' a time `s` after the start of a dense output.
#[cold]
#[inline(never)]
fn slope_of<S: State>(c: &[S], scale: f64, s: f64) -> S {
    c[0].with(|i| value_and_slope(c, |c| c.get(i), s / scale).1 / scale)
}

/// A step of `h`, with `longest` left to go: the last one is stretched or halved a little rather
/// than followed by a tiny one.
#[inline]
pub(super) fn evened(h: f64, longest: f64) -> f64 {
    if h * STRETCHED >= longest {
        longest
    } else if h * 2.0 > longest {
        longest * 0.5
    } else {
        h
    }
}
