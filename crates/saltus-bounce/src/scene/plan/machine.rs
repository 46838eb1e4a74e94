//! A model with its start, ready to run, and the run read in terms of the scene.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::Vector3;
use saltus::cross::Evidence;
use saltus::step::Stepper;
use saltus::{
    Automaton, Cause, Ending, Inspection, Jump, Observer, Piece, Run, Simulation, Solution, Time, Trajectory,
};

use super::RunError;
use super::explain::{Advance, ModePlan};
use super::method::Method;
use super::outcome::{Outcome, Watch};
use super::record::{Cost, End, Event, Impact, Moment, Record, Recorded, Segment, Sides, With};

/// How to run a machine.
#[derive(Clone, Copy, Debug)]
pub(super) struct How {
    pub(super) until: Option<f64>,
    pub(super) most_jumps: usize,
    pub(super) most_evaluations: u64,
    pub(super) method: Method,
    pub(super) tolerance: f64,
    /// Whether a formula solves every mode.
    pub(super) solved: bool,
    /// Whether to step through it all the same.
    pub(super) stepped: bool,
    /// Frames per second, to run frame by frame.
    pub(super) frames: Option<f64>,
    /// Where a coordinate is near zero; a thousandth of the tolerance unless given.
    pub(super) absolute: Option<f64>,
}

/// How much of a motion that ends by itself is kept beyond its end.
const SHOWN_AFTER_REST: f64 = 0.05;
/// How much of one that is at rest from the start, in s.
const SHOWN_AT_REST: f64 = 1.0;

/// Until when to show a motion that ends by itself at `last`.
fn shown(last: f64) -> f64 {
    if last > 0.0 { last * (1.0 + SHOWN_AFTER_REST) } else { SHOWN_AT_REST }
}

impl How {
    /// Until when a run that reached `until` is shown: what lies still or rolls on beyond the `last` jump needs no end, and a little of it is shown.
    fn shown(&self, end: End, until: f64, last: f64, rest: Option<f64>) -> Result<f64, RunError> {
        if self.until.is_some() {
            Ok(until)
        } else if end == End::Time && until > last && (last > 0.0 || rest.is_some()) {
            Ok(shown(last))
        } else if until.is_finite() {
            Ok(until)
        } else {
            let says =
                "without gravity the ball may never land: say when to stop, by --until or by `until` under [run]";
            Err(RunError::new(says.to_owned()))
        }
    }
}

/// What a jump means in the scene.
pub(super) struct Happening {
    pub(super) edge: &'static str,
    /// The balls that take part; none means all.
    pub(super) balls: [Option<usize>; 2],
    pub(super) hit: Option<Hit>,
}

impl Happening {
    /// Something that is no impact, with ball 0 or with all.
    pub(super) const fn of(edge: &'static str) -> Self {
        Self { edge, balls: [None; 2], hit: None }
    }
}

/// An impact: with what, along which normal, and how fast that itself moves along it.
pub(super) struct Hit {
    pub(super) with: With,
    pub(super) normal: Vector3<f64>,
    pub(super) speed: f64,
}

/// Reads the states, modes and jumps of a model in terms of the scene.
pub(super) trait Reader<A: Automaton>: Send + Sync + 'static {
    /// The stepper to compile the model for: the whole choice, or, where a formula solves every mode, one that is never asked.
    type Stepper: Stepper + From<Method>;
    fn balls(&self) -> usize {
        1
    }
    /// What of a moment is linear in the state.
    fn linear(&self, x: &A::State, ball: usize) -> Moment;
    /// And what is added to it.
    fn origin(&self, ball: usize) -> Moment {
        let _ = ball;
        Moment::ZERO
    }
    fn mode(&self, mode: A::Mode, ball: usize) -> &'static str;
    fn flies(&self, mode: A::Mode, ball: usize) -> bool;
    /// Whether nothing moves any more.
    fn rests(&self, mode: A::Mode, x: &A::State) -> bool;
    /// The modes before and after the jump at an apex, where a flight has one.
    fn apex_jump(&self) -> Option<(A::Mode, A::Mode)> {
        None
    }
    /// A jump by an edge.
    fn happening(&self, model: &A, jump: &Jump<A>, edge: A::Edge) -> Happening;
    /// The modes a run may enter, as far as they differ in how they are advanced.
    fn modes(&self, model: &A) -> Vec<A::Mode>;
    /// How an edge is listed.
    fn edge(&self, model: &A, edge: A::Edge) -> String;
    /// How the edges of a mode are listed.
    fn edges(&self, model: &A, mode: A::Mode) -> Vec<String> {
        model.edges(mode).iter().map(|edge| self.edge(model, edge)).collect()
    }
    /// Why a mode is advanced as it is.
    fn why(&self, mode: A::Mode, advance: Advance) -> &'static str;
    /// Contacts that take time.
    fn contacts(&self, model: &A, run: &Trajectory<A>) -> Option<Vec<Impact>> {
        let _ = (model, run);
        None
    }
    fn hysteresis(&self, model: &A, run: &Trajectory<A>, contact: usize, count: usize) -> Vec<[f64; 2]> {
        let _ = (model, run, contact, count);
        Vec::new()
    }
}

/// Anything that runs.
pub(super) trait Machine: Send + Sync {
    fn run(&self, how: &How) -> Result<Record, RunError>;
    fn outcome(&self, how: &How) -> Result<Outcome, RunError>;
    fn modes(&self, method: Method) -> Vec<ModePlan>;
    fn coordinates(&self) -> usize;
}

/// A model, who reads it, and where it starts.
pub(super) struct Ready<A: Automaton, R> {
    pub(super) automaton: Arc<A>,
    pub(super) reader: Arc<R>,
    pub(super) mode: A::Mode,
    pub(super) state: A::State,
}

impl<A: Automaton, R: Reader<A>> Ready<A, R> {
    pub(super) fn boxed(automaton: A, reader: R, mode: A::Mode, state: A::State) -> Box<dyn Machine>
    where
        A: Send + Sync + 'static,
        A::Mode: Send + Sync,
        A::State: Send + Sync,
    {
        Box::new(Self { automaton: Arc::new(automaton), reader: Arc::new(reader), mode, state })
    }
}

impl<A: Automaton, R: Reader<A>> Ready<A, R> {
    fn simulation(&self, how: &How) -> Simulation<'_, A, R::Stepper> {
        let simulation = Simulation::of(&*self.automaton)
            .stepper(R::Stepper::from(how.method))
            .tolerance(how.tolerance)
            .most_jumps(how.most_jumps)
            .most_evaluations(how.most_evaluations);
        let simulation = match how.absolute {
            Some(absolute) => simulation.absolute_tolerance(absolute),
            None => simulation,
        };
        if how.stepped { simulation.stepped() } else { simulation }
    }

    /// Runs from the start until `until`. Whoever observes, the engine is compiled once for a model.
    fn drive(
        &self,
        simulation: &Simulation<'_, A, R::Stepper>,
        until: f64,
        mut observer: &mut dyn Observer<A>,
    ) -> Result<Ending<A>, saltus::Error> {
        simulation.drive(self.mode, self.state, 0.0..until, &mut observer)
    }

    /// Until when to run.
    fn until(&self, how: &How, simulation: &Simulation<'_, A, R::Stepper>) -> Result<f64, saltus::Error> {
        match how.until {
            Some(until) => Ok(until),
            None if how.solved => Ok(f64::INFINITY),
            // Steps would go on for ever: the run is made twice, first to see when it ends.
            None => {
                let mut resting = Resting { reader: &*self.reader };
                let ending = self.drive(simulation, f64::INFINITY, &mut resting)?;
                Ok(shown(ending.time.seconds()))
            }
        }
    }
}

impl<A, R: Reader<A>> Machine for Ready<A, R>
where
    A: Automaton + Send + Sync + 'static,
    A::Mode: Send + Sync,
    A::State: Send + Sync,
{
    fn run(&self, how: &How) -> Result<Record, RunError> {
        let simulation = self.simulation(how);
        let until = self.until(how, &simulation)?;
        let run = match how.frames {
            None => {
                let mut trajectory = Trajectory::starting(self.mode, self.state, Time::new(0.0));
                let Ending { stop, stats, time, mode, state, limits, .. } =
                    self.drive(&simulation, until, &mut trajectory)?;
                trajectory.finish(time);
                Run { trajectory, stop, stats, mode, state, limits }
            }
            Some(rate) => {
                saltus::frame_by_frame(&*self.automaton, self.mode, self.state, 0.0..until, rate, how.most_jumps)?
            }
        };
        let end = End::of(&run.stop);
        let last = run.trajectory.jumps().last().map_or(0.0, Jump::t);
        let rest = (end == End::Time && self.reader.rests(run.mode, &run.state)).then_some(last);
        let until = how.shown(end, run.trajectory.end().seconds(), last, rest)?;
        let read = Read { automaton: Arc::clone(&self.automaton), reader: Arc::clone(&self.reader), run };
        Ok(Record { run: Box::new(read), until, end, rest })
    }

    fn outcome(&self, how: &How) -> Result<Outcome, RunError> {
        let simulation = self.simulation(how);
        let until = self.until(how, &simulation)?;
        let mut watch = Watch::new(&*self.automaton, &*self.reader);
        let ending = self.drive(&simulation, until, &mut watch)?;
        let (end, last) = (End::of(&ending.stop), watch.last_jump());
        let rest = (end == End::Time && self.reader.rests(ending.mode, &ending.state)).then_some(last);
        let until = how.shown(end, ending.time.seconds(), last, rest)?;
        let state = if until < ending.time.seconds() {
            let (t, mode, state) = watch.left.unwrap_or((0.0, self.mode, self.state));
            let mut nothing: &mut dyn Observer<A> = &mut ();
            simulation.drive(mode, state, t..until, &mut nothing)?.state
        } else {
            ending.state
        };
        Ok(watch.outcome(&ending, end, until, &state, rest))
    }

    fn modes(&self, method: Method) -> Vec<ModePlan> {
        let plan = |mode: A::Mode| {
            let (automaton, reader) = (&*self.automaton, &*self.reader);
            let advance = match automaton.solution(mode, 0.0, &self.state) {
                Solution::Polynomial(_) => Advance::Exact,
                Solution::Formula(_) => Advance::Formula,
                _ if method.is_stiff() => Advance::Stiff(method.name()),
                _ => Advance::Explicit(method.name()),
            };
            let mut edges = reader.edges(automaton, mode);
            edges.dedup();
            ModePlan { name: reader.mode(mode, 0), advance, why: reader.why(mode, advance), edges }
        };
        self.reader.modes(&self.automaton).into_iter().map(plan).collect()
    }

    fn coordinates(&self) -> usize {
        saltus::State::len(&self.state)
    }
}

/// Ends a run as everything has come to rest.
struct Resting<'a, R> {
    reader: &'a R,
}

impl<A: Automaton, R: Reader<A>> Observer<A> for Resting<'_, R> {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &Jump<A>) -> ControlFlow<()> {
        if self.reader.rests(jump.to, &jump.after) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A ball in a state.
pub(super) fn moment<A: Automaton>(reader: &impl Reader<A>, x: &A::State, ball: usize) -> Moment {
    reader.linear(x, ball) + reader.origin(ball)
}

/// A ball along a piece.
pub(super) fn segment<A: Automaton>(
    reader: &impl Reader<A>,
    mode: A::Mode,
    piece: &Piece<'_, A::State>,
    ball: usize,
) -> Segment {
    let mut factor = 1.0;
    let mut coefficients: Vec<Moment> = Vec::with_capacity(piece.coefficients().len());
    for c in piece.coefficients() {
        coefficients.push(reader.linear(c, ball) * factor);
        factor /= piece.scale();
    }
    if let Some(first) = coefficients.first_mut() {
        *first = *first + reader.origin(ball);
    }
    let (start, span) = (piece.start().seconds(), piece.span());
    Segment { start, span, mode: reader.mode(mode, ball), flight: reader.flies(mode, ball), coefficients }
}

fn happening<A: Automaton>(model: &A, reader: &impl Reader<A>, jump: &Jump<A>) -> Happening {
    match jump.cause {
        Cause::Edge(edge) => reader.happening(model, jump, edge),
        _ => Happening::of("zeno"),
    }
}

/// The impact that a jump is; `None` if it is none.
pub(super) fn impact<A: Automaton>(model: &A, reader: &impl Reader<A>, jump: &Jump<A>) -> Option<Impact> {
    let happening = happening(model, reader, jump);
    let Hit { with, normal, speed } = happening.hit?;
    let ball = happening.balls[0].unwrap_or(0);
    let approach = |x: &A::State| {
        let other = match with {
            With::Ball(other) => moment(reader, x, other).velocity.dot(&normal),
            With::Floor(_) => speed,
        };
        other - moment(reader, x, ball).velocity.dot(&normal)
    };
    let (before, after) = (approach(&jump.before), -approach(&jump.after));
    // What comes to lie where it starts hits nothing. Rounding may leave a hair of the wrong sign.
    (before > 0.0 || after > 0.0).then(|| Impact {
        t: jump.t(),
        ball,
        with,
        approach: before.max(0.0),
        rebound: Some(after.max(0.0)),
        press: None,
    })
}

/// A run that is read when it is asked.
struct Read<A: Automaton, R> {
    automaton: Arc<A>,
    reader: Arc<R>,
    run: Run<A>,
}

impl<A: Automaton, R: Reader<A>> Read<A, R> {
    fn moment(&self, x: &A::State, ball: usize) -> Moment {
        moment(&*self.reader, x, ball)
    }
}

impl<A: Automaton, R: Reader<A>> Recorded for Read<A, R> {
    fn balls(&self) -> usize {
        self.reader.balls()
    }

    fn at(&self, ball: usize, t: f64) -> Option<(&'static str, Moment)> {
        let mode = self.run.trajectory.mode_at(t)?;
        Some((self.reader.mode(mode, ball), self.moment(&self.run.trajectory.at(t)?, ball)))
    }

    fn before(&self, ball: usize, t: f64) -> Option<Moment> {
        Some(self.moment(&self.run.trajectory.before(t)?, ball))
    }

    fn segments(&self, ball: usize) -> Vec<Segment> {
        let trajectory = &self.run.trajectory;
        let mut segments = Vec::new();
        for (index, arc) in trajectory.arcs().iter().enumerate() {
            segments.extend(trajectory.pieces(index).map(|piece| segment(&*self.reader, arc.mode(), &piece, ball)));
        }
        segments
    }

    fn events(&self) -> Vec<Event> {
        let event = |jump: &Jump<A>| {
            let happening = happening(&*self.automaton, &*self.reader, jump);
            let side = |ball: usize| Sides {
                ball,
                from: self.reader.mode(jump.from, ball),
                before: self.moment(&jump.before, ball),
                to: self.reader.mode(jump.to, ball),
                after: self.moment(&jump.after, ball),
            };
            let all = || (0..self.balls()).map(side);
            let sides = match happening.balls {
                [None, None] => all().collect(),
                // What touches hands an impact on at the same time: then others take part.
                some => {
                    let passed =
                        all().filter(|s| !some.contains(&Some(s.ball)) && s.before.velocity != s.after.velocity);
                    some.into_iter().flatten().map(side).chain(passed).collect()
                }
            };
            Event { t: jump.t(), j: jump.j, edge: happening.edge, sides }
        };
        self.run.trajectory.jumps().iter().map(event).collect()
    }

    fn impacts(&self) -> Vec<Impact> {
        if let Some(contacts) = self.reader.contacts(&self.automaton, &self.run.trajectory) {
            return contacts;
        }
        let jumps = self.run.trajectory.jumps().iter();
        jumps.filter_map(|jump| impact(&*self.automaton, &*self.reader, jump)).collect()
    }

    fn hysteresis(&self, contact: usize, count: usize) -> Vec<[f64; 2]> {
        self.reader.hysteresis(&self.automaton, &self.run.trajectory, contact, count)
    }

    fn cost(&self) -> Cost {
        self.run.stats.into()
    }

    fn doubts(&self) -> Vec<String> {
        let said = |doubt: &Inspection<A>| {
            let edge = self.reader.edge(&self.automaton, doubt.edge);
            // What follows a colon says what the edge is.
            let name = edge.split(':').next().unwrap_or(&edge);
            let mode = self.reader.mode(doubt.mode, 0);
            let times = doubt.doubt().unwrap_or_default();
            let why = match doubt.evidence {
                Evidence::Grazing { .. } => "the error of the steps decides whether it came to that",
                Evidence::Rounding { .. } => "rounding hides whether it came to that",
                Evidence::Discontinuous { .. } => "what decides it is not continuous",
                _ => "the search for it was given up",
            };
            format!("{name} in mode {mode}, {:.9} s to {:.9} s: {why}", times.start, times.end)
        };
        self.run.trajectory.doubts().iter().map(said).collect()
    }
}
