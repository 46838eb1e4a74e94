//! Frame by frame, as game loops and animators' scripts run: what event location is measured
//! against.

use std::ops::Range;

use crate::automaton::refusal::{flow_undefined, guard_undefined};
use crate::automaton::{Automaton, Entry};
use crate::ending::{Ending, Limits, Run, RunOf, Stats, Stop};
use crate::error::{Error, ErrorKind, Place, listed};
use crate::jump::{Cause, Jump};
use crate::piece::Piece;
use crate::state::State;
use crate::ticks::Ticks;
use crate::time::Span;
use crate::time::Time;
use crate::trajectory::Trajectory;

/// How many edges are taken at the end of one frame.
const MOST_AT_ONCE: usize = 16;

/// Runs at a fixed rate, as a game loop does: a foil, to be compared with
/// [`Simulation`](crate::Simulation).
///
/// A frame is one step of the classical Runge–Kutta method of order 4 (W. Kutta, Z. Math. Phys. 46,
/// 435 (1901)), so what is off is not the flow. Guards are looked at where frames end, and nowhere
/// else: an edge whose guard has turned negative is taken then, at a state that is already outside
/// the mode's domain. No crossing is located, one that comes and goes within a frame is missed,
/// accumulating jumps are not recognised, and the error falls with the first power of the time of a
/// frame, not with the fourth. `rate` in frames per second; the last frame is cut at the end of the
/// span.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Hybrid, frame_by_frame};
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -10.0])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.8 * x[1]]);
/// let run = frame_by_frame(&ball, "flight", vector![1.0, 0.0], 0.0..0.6, 24.0, 1_000)?;
/// // The impact at 0.4472 s is noticed at frame 11, up to a frame late.
/// assert!((run.trajectory.jumps()[0].t() - 11.0 / 24.0).abs() < 1e-15);
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// # Errors
/// [`Error`] if the span, the rate, the flow, a guard or a reset is not a number, with time, mode,
/// edge and state.
pub fn frame_by_frame<A: Automaton>(
    automaton: &A,
    mode: A::Mode,
    state: A::State,
    span: Range<f64>,
    rate: f64,
    most_jumps: usize,
) -> Result<RunOf<A>, Error> {
    let place = |t: f64, mode: A::Mode, x: &A::State| Place::new(t, mode, None::<A::Edge>, x);
    if !(span.start.is_finite() && span.end.is_finite() && span.start <= span.end) {
        let note = Some(format!("{}..{}", span.start, span.end));
        return Err(Error::new(ErrorKind::Span, place(span.start, mode, &state)).noting(note));
    }
    if !(rate > 0.0 && rate.is_finite()) {
        return Err(Error::new(ErrorKind::StepLimit, place(span.start, mode, &state)));
    }
    let start = Time::new(span.start);
    let (mut now, mut run) = (start, begun::<A>(mode, state, start));
    let mut ticks = Ticks::new();
    let mut may = Vec::new();
    for frame in 1_u64.. {
        #[allow(clippy::cast_precision_loss)] // a count of frames
        let next = start.after((frame as f64 / rate).min(span.end - span.start));
        let h = next.since(now);
        if h <= 0.0 {
            break;
        }
        let (mode, x) = (run.end.mode, run.end.state.clone());
        if let Some(flaw) = automaton.edges(mode).flaw() {
            return Err(Error::new(ErrorKind::Model, place(now.seconds(), mode, &x)).noting(Some(flaw)));
        }
        // One that waits was negative before the frame; any other is taken as soon as it is.
        held(automaton, mode, now.seconds(), &x, &mut run.end.stats, &mut may, |entry| entry != Entry::Wait);
        let (slope, end) = kutta(automaton, mode, now.seconds(), &x, h);
        run.end.stats.flows += 4;
        run.end.stats.steps += 1;
        if !end.is_finite() {
            return Err(flow_undefined(automaton, mode, now.seconds(), &x, None));
        }
        run.trajectory.push_piece(&Piece::new(now, h, h, &between(&x, &slope, &end, h)));
        let frame = Span { start, now, end: next };
        now = next;
        run.end.state = end;
        run.end.stop = jumps(automaton, &mut may, now, &mut run)?;
        // Then the clocks that have ticked since the last frame.
        while run.end.stop == Stop::Time
            && let Some(due) = ticks.next(automaton, run.end.mode, &run.end.state, &frame)?
        {
            ticks.take(&due, now.seconds());
            run.end.stop = jump(automaton, due.edge, now, &mut run)?;
        }
        if run.end.stop == Stop::Time && run.end.stats.jumps >= most_jumps {
            run.end.stop = Stop::Jumps { most: most_jumps };
        }
        if run.end.stop != Stop::Time {
            break;
        }
    }
    run.trajectory.finish(now);
    (run.end.time, run.end.jumps) = (now, run.end.stats.jumps);
    Ok(run)
}

/// A run at its start.
fn begun<A: Automaton>(mode: A::Mode, state: A::State, time: Time) -> RunOf<A> {
    let (stop, stats, limits) = (Stop::Time, Stats::default(), Limits::default());
    let trajectory = Trajectory::starting(mode, state.clone(), time);
    Run { trajectory, end: Ending { stop, stats, time, jumps: 0, mode, state, limits } }
}

/// Which edges of a mode, by their places, may be taken once their guards are negative: those whose
/// guards are not so yet, and those with such an `entry`.
fn held<A: Automaton>(
    automaton: &A,
    mode: A::Mode,
    t: f64,
    x: &A::State,
    stats: &mut Stats,
    may: &mut Vec<bool>,
    entry: impl Fn(Entry) -> bool,
) {
    may.clear();
    for edge in automaton.edges(mode).iter() {
        stats.guards += 1;
        may.push(automaton.guard(edge, t, x) >= 0.0 || entry(automaton.about(edge).entry));
    }
}

/// Takes the edges that a frame has crossed, one after the other, in the order in which the mode
/// lists them.
fn jumps<A: Automaton>(
    automaton: &A,
    may: &mut Vec<bool>,
    now: Time,
    run: &mut RunOf<A>,
) -> Result<Stop<A::Edge>, Error> {
    let t = now.seconds();
    for _ in 0..MOST_AT_ONCE {
        let (mode, x) = (run.end.mode, &run.end.state);
        let mut crossed = None;
        for (edge, &may) in automaton.edges(mode).iter().zip(&*may) {
            run.end.stats.guards += 1;
            let g = automaton.guard(edge, t, x);
            if g.is_nan() {
                return Err(guard_undefined(automaton, mode, edge, t, x));
            }
            if g < 0.0 && may {
                crossed = Some(edge);
                break;
            }
        }
        let Some(edge) = crossed else { return Ok(Stop::Time) };
        let stop = jump(automaton, edge, now, run)?;
        if stop != Stop::Time {
            return Ok(stop);
        }
        // What a reset leaves negative is not crossed again before the next frame.
        held(automaton, run.end.mode, t, &run.end.state, &mut run.end.stats, may, |entry| entry == Entry::Fire);
    }
    Ok(Stop::Time)
}

/// Takes an edge.
fn jump<A: Automaton>(automaton: &A, edge: A::Edge, now: Time, run: &mut RunOf<A>) -> Result<Stop<A::Edge>, Error> {
    let (mode, x, t) = (run.end.mode, run.end.state.clone(), now.seconds());
    let place = || Place::new(t, mode, Some(edge), &x);
    let (to, after) = automaton.reset(mode, edge, t, &x).map_err(|refusal| refusal.at("reset", place()))?;
    if !after.is_finite() {
        return Err(Error::new(ErrorKind::Reset, place()).noting(Some(listed(&after))));
    }
    run.end.stats.jumps += 1;
    let (j, cause) = (run.end.stats.jumps, Cause::Edge(edge));
    run.trajectory.push_jump(Jump { time: now, j, cause, from: mode, before: x, to, after: after.clone() });
    (run.end.mode, run.end.state) = (to, after);
    Ok(if automaton.about(edge).terminal { Stop::Terminal { edge } } else { Stop::Time })
}

/// One step of the classical method: the slope at its start, and its end.
fn kutta<A: Automaton>(automaton: &A, mode: A::Mode, t: f64, x: &A::State, h: f64) -> (A::State, A::State) {
    let ahead = |slope: &A::State, s: f64| x.with(|i| x.get(i) + s * slope.get(i));
    let a = automaton.flow(mode, t, x);
    let b = automaton.flow(mode, t + 0.5 * h, &ahead(&a, 0.5 * h));
    let c = automaton.flow(mode, t + 0.5 * h, &ahead(&b, 0.5 * h));
    let d = automaton.flow(mode, t + h, &ahead(&c, h));
    let mean = |i: usize| (a.get(i) + 2.0 * (b.get(i) + c.get(i)) + d.get(i)) / 6.0;
    let end = x.with(|i| x.get(i) + h * mean(i));
    (a, end)
}

/// The parabola through both ends of a frame with the slope at its first: nobody sees what lies
/// between frames.
fn between<S: State>(x: &S, slope: &S, end: &S, h: f64) -> [S; 3] {
    [x.clone(), x.with(|i| h * slope.get(i)), x.with(|i| end.get(i) - x.get(i) - h * slope.get(i))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Hybrid, Simulation};
    use nalgebra::{Vector2, vector};

    #[test]
    fn a_smooth_flow_has_order_four_and_a_contact_order_one() {
        let turning = Hybrid::new().mode("turn", |_t, x: &Vector2<f64>| vector![x[1], -x[0]]).edge(
            "turn",
            "turn",
            |_t, x| x[0],
            |_t, x| vector![0.0, -0.8 * x[1]],
        );
        let error = |rate: f64, end: f64| {
            let exact = Simulation::of(&turning).tolerance(1e-13).run("turn", vector![1.0, 0.0], 0.0..end).unwrap();
            let framed = frame_by_frame(&turning, "turn", vector![1.0, 0.0], 0.0..end, rate, 100).unwrap();
            (exact.end.state - framed.end.state).norm()
        };
        let smooth = error(20.0, 1.5) / error(40.0, 1.5);
        assert!((14.0..18.0).contains(&smooth), "{smooth}");
        // After three contacts the error is a sum of what is left of three frames.
        let worst = |rate: f64| (0..20).map(|k| error(rate + f64::from(k), 6.0)).fold(0.0, f64::max);
        let contact = worst(200.0) / worst(2000.0);
        assert!((3.0..30.0).contains(&contact), "{contact}");
    }

    #[test]
    fn bad_input_is_refused() {
        let still = Hybrid::new().mode("still", |_t, _x: &f64| 0.0);
        let kind = |end: f64, rate: f64| frame_by_frame(&still, "still", 0.0, 0.0..end, rate, 1).unwrap_err().kind();
        assert_eq!(kind(f64::INFINITY, 24.0), ErrorKind::Span);
        assert_eq!(kind(1.0, 0.0), ErrorKind::StepLimit);
        let wild = Hybrid::new().mode("wild", |_t, x: &f64| 1.0 / x);
        assert_eq!(frame_by_frame(&wild, "wild", 0.0, 0.0..1.0, 24.0, 1).unwrap_err().kind(), ErrorKind::Flow);
    }
}
