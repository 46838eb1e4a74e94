//! A model with its start, ready to run, and the run read in terms of the scene.

use std::ops::ControlFlow;
use std::sync::Arc;

use nalgebra::Vector3;
use saltus::cross::Doubt;
use saltus::step::Stepper;
use saltus::{
    Automaton, Cause, EndingOf, InspectionOf, Jump, JumpOf, Observer, Piece, Run, RunOf, Simulation, Solution, Time,
    Trajectory, TrajectoryOf,
};

use super::RunError;
use super::explain::{Advance, ModePlan};
use super::method::Method;
use super::outcome::{Outcome, OutcomeObserver};
use super::record::{Cost, End, Event, Impact, Moment, RecordedRun, Segment, Sides, With};

/// The options of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunOptions {
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

impl RunOptions {
    /// Until when a run that reached `until` is shown: what lies still or rolls on beyond the
    /// `last` jump needs no end, and a little of it is shown.
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

/// A jump as an event of the scene.
pub(super) struct SceneEvent {
    pub(super) edge: &'static str,
    /// The balls that take part; none means all.
    pub(super) balls: [Option<usize>; 2],
    pub(super) collision: Option<Collision>,
}

impl SceneEvent {
    /// Something that is no impact, with ball 0 or with all.
    pub(super) const fn of(edge: &'static str) -> Self {
        Self { edge, balls: [None; 2], collision: None }
    }
}

/// An impact: with what, along which normal, and how fast that itself moves along it.
pub(super) struct Collision {
    pub(super) with: With,
    pub(super) normal: Vector3<f64>,
    pub(super) speed: f64,
}

/// How the states, modes and jumps of a model are seen in the scene.
pub(super) trait SceneView<A: Automaton>: Send + Sync + 'static {
    /// The stepper to compile the model for: the whole choice, or, where a formula solves every
    /// mode, one that is never asked.
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
    fn scene_event(&self, model: &A, jump: &JumpOf<A>, edge: A::Edge) -> SceneEvent;
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
    fn contacts(&self, model: &A, run: &TrajectoryOf<A>) -> Option<Vec<Impact>> {
        let _ = (model, run);
        None
    }
    fn hysteresis(&self, model: &A, run: &TrajectoryOf<A>, contact: usize, count: usize) -> Vec<[f64; 2]> {
        let _ = (model, run, contact, count);
        Vec::new()
    }
}

/// A model that may be sent between threads and shared, with all its runs.
pub(super) trait Shared:
    Automaton<Mode: Send + Sync, State: Send + Sync, Edge: Send + Sync> + Send + Sync + 'static
{
}
impl<A> Shared for A where A: Automaton<Mode: Send + Sync, State: Send + Sync, Edge: Send + Sync> + Send + Sync + 'static
{}

/// A run that was recorded, up to where it is shown.
pub(super) struct Recording {
    pub(super) run: Box<dyn RecordedRun>,
    pub(super) until: f64,
    pub(super) end: End,
    pub(super) rest: Option<f64>,
}

/// A model bound to its start, of whatever kind.
pub(super) trait Runner: Send + Sync {
    fn run(&self, options: &RunOptions) -> Result<Recording, RunError>;
    fn outcome(&self, options: &RunOptions) -> Result<Outcome, RunError>;
    fn modes(&self, method: Method) -> Vec<ModePlan>;
    fn coordinates(&self) -> usize;
}

/// A model, how its states, modes and jumps are seen in the scene, and where it starts.
pub(super) struct BoundModel<A: Automaton, R> {
    pub(super) automaton: Arc<A>,
    pub(super) view: Arc<R>,
    pub(super) mode: A::Mode,
    pub(super) state: A::State,
}

impl<A: Automaton, R: SceneView<A>> BoundModel<A, R> {
    pub(super) fn boxed(automaton: A, view: R, mode: A::Mode, state: A::State) -> Box<dyn Runner>
    where
        A: Shared,
    {
        Box::new(Self { automaton: Arc::new(automaton), view: Arc::new(view), mode, state })
    }
}

impl<A: Automaton, R: SceneView<A>> BoundModel<A, R> {
    fn simulation(&self, options: &RunOptions) -> Simulation<'_, A, R::Stepper> {
        let simulation = Simulation::of(&*self.automaton)
            .stepper(R::Stepper::from(options.method))
            .tolerance(options.tolerance)
            .most_jumps(options.most_jumps)
            .most_evaluations(options.most_evaluations);
        let simulation = match options.absolute {
            Some(absolute) => simulation.absolute_tolerance(absolute),
            None => simulation,
        };
        if options.stepped { simulation.stepped() } else { simulation }
    }

    /// Runs from the start until `until`. Whoever observes, the engine is compiled once for a
    /// model.
    fn drive(
        &self,
        simulation: &Simulation<'_, A, R::Stepper>,
        until: f64,
        mut observer: &mut dyn Observer<A>,
    ) -> Result<EndingOf<A>, saltus::Error> {
        simulation.drive(self.mode, self.state, 0.0..until, &mut observer)
    }

    /// Until when to run.
    fn until(&self, options: &RunOptions, simulation: &Simulation<'_, A, R::Stepper>) -> Result<f64, saltus::Error> {
        match options.until {
            Some(until) => Ok(until),
            None if options.solved => Ok(f64::INFINITY),
            // Steps would go on for ever: the run is made twice, first to see when it ends.
            None => {
                let mut resting = Resting { view: &*self.view };
                let ending = self.drive(simulation, f64::INFINITY, &mut resting)?;
                Ok(shown(ending.time.seconds()))
            }
        }
    }
}

impl<A: Shared, R: SceneView<A>> Runner for BoundModel<A, R> {
    fn run(&self, options: &RunOptions) -> Result<Recording, RunError> {
        let simulation = self.simulation(options);
        let until = self.until(options, &simulation)?;
        let run = match options.frames {
            None => {
                let mut trajectory = Trajectory::starting(self.mode, self.state, Time::new(0.0));
                let end = self.drive(&simulation, until, &mut trajectory)?;
                trajectory.finish(end.time);
                Run { trajectory, end }
            }
            Some(rate) => {
                saltus::frame_by_frame(&*self.automaton, self.mode, self.state, 0.0..until, rate, options.most_jumps)?
            }
        };
        let end = End::of(&run.end.stop);
        let last = run.trajectory.jumps().last().map_or(0.0, Jump::t);
        let rest = (end == End::Time && self.view.rests(run.end.mode, &run.end.state)).then_some(last);
        let until = options.shown(end, run.trajectory.end().seconds(), last, rest)?;
        let read = BoundRun { automaton: Arc::clone(&self.automaton), view: Arc::clone(&self.view), run };
        Ok(Recording { run: Box::new(read), until, end, rest })
    }

    fn outcome(&self, options: &RunOptions) -> Result<Outcome, RunError> {
        let simulation = self.simulation(options);
        let until = self.until(options, &simulation)?;
        let mut observer = OutcomeObserver::new(&*self.automaton, &*self.view);
        let ending = self.drive(&simulation, until, &mut observer)?;
        let (end, last) = (End::of(&ending.stop), observer.last_jump());
        let rest = (end == End::Time && self.view.rests(ending.mode, &ending.state)).then_some(last);
        let until = options.shown(end, ending.time.seconds(), last, rest)?;
        let state = if until < ending.time.seconds() {
            let (t, mode, state) = observer.left.unwrap_or((0.0, self.mode, self.state));
            let mut nothing: &mut dyn Observer<A> = &mut ();
            simulation.drive(mode, state, t..until, &mut nothing)?.state
        } else {
            ending.state
        };
        Ok(observer.outcome(&ending, end, until, &state, rest))
    }

    fn modes(&self, method: Method) -> Vec<ModePlan> {
        let plan = |mode: A::Mode| {
            let (automaton, view) = (&*self.automaton, &*self.view);
            let advance = match automaton.solution(mode, 0.0, &self.state) {
                Solution::Polynomial(_) => Advance::Exact,
                Solution::Formula(_) => Advance::Formula,
                _ if method.is_stiff() => Advance::Stiff(method.name()),
                _ => Advance::Explicit(method.name()),
            };
            let mut edges = view.edges(automaton, mode);
            edges.dedup();
            ModePlan { name: view.mode(mode, 0), advance, why: view.why(mode, advance), edges }
        };
        self.view.modes(&self.automaton).into_iter().map(plan).collect()
    }

    fn coordinates(&self) -> usize {
        saltus::State::len(&self.state)
    }
}

/// Ends a run as everything has come to rest.
struct Resting<'a, R> {
    view: &'a R,
}

impl<A: Automaton, R: SceneView<A>> Observer<A> for Resting<'_, R> {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        if self.view.rests(jump.to, &jump.after) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A ball in a state.
pub(super) fn moment<A: Automaton>(view: &impl SceneView<A>, x: &A::State, ball: usize) -> Moment {
    view.linear(x, ball) + view.origin(ball)
}

/// A ball along a piece.
pub(super) fn segment<A: Automaton>(
    view: &impl SceneView<A>,
    mode: A::Mode,
    piece: &Piece<'_, A::State>,
    ball: usize,
) -> Segment {
    let mut factor = 1.0;
    let mut coefficients: Vec<Moment> = Vec::with_capacity(piece.coefficients().len());
    for c in piece.coefficients() {
        coefficients.push(view.linear(c, ball) * factor);
        factor /= piece.scale();
    }
    if let Some(first) = coefficients.first_mut() {
        *first = *first + view.origin(ball);
    }
    let (start, span) = (piece.start().seconds(), piece.span());
    Segment { start, span, mode: view.mode(mode, ball), flight: view.flies(mode, ball), coefficients }
}

fn scene_event<A: Automaton>(model: &A, view: &impl SceneView<A>, jump: &JumpOf<A>) -> SceneEvent {
    match jump.cause {
        Cause::Edge(edge) => view.scene_event(model, jump, edge),
        _ => SceneEvent::of("zeno"),
    }
}

/// The impact that a jump is; `None` if it is none.
pub(super) fn impact<A: Automaton>(model: &A, view: &impl SceneView<A>, jump: &JumpOf<A>) -> Option<Impact> {
    let scene_event = scene_event(model, view, jump);
    let Collision { with, normal, speed } = scene_event.collision?;
    let ball = scene_event.balls[0].unwrap_or(0);
    let approach = |x: &A::State| {
        let other = match with {
            With::Ball(other) => moment(view, x, other).velocity.dot(&normal),
            With::Floor(_) => speed,
        };
        other - moment(view, x, ball).velocity.dot(&normal)
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
struct BoundRun<A: Automaton, R> {
    automaton: Arc<A>,
    view: Arc<R>,
    run: RunOf<A>,
}

impl<A: Automaton, R: SceneView<A>> BoundRun<A, R> {
    fn moment(&self, x: &A::State, ball: usize) -> Moment {
        moment(&*self.view, x, ball)
    }
}

impl<A: Shared, R: SceneView<A>> RecordedRun for BoundRun<A, R> {
    fn balls(&self) -> usize {
        self.view.balls()
    }

    fn at(&self, ball: usize, t: f64) -> Option<(&'static str, Moment)> {
        let mode = self.run.trajectory.mode_at(t)?;
        Some((self.view.mode(mode, ball), self.moment(&self.run.trajectory.at(t)?, ball)))
    }

    fn before(&self, ball: usize, t: f64) -> Option<Moment> {
        Some(self.moment(&self.run.trajectory.before(t)?, ball))
    }

    fn segments(&self, ball: usize) -> Vec<Segment> {
        let trajectory = &self.run.trajectory;
        let mut segments = Vec::new();
        for (index, arc) in trajectory.arcs().iter().enumerate() {
            segments.extend(trajectory.pieces(index).map(|piece| segment(&*self.view, arc.mode(), &piece, ball)));
        }
        segments
    }

    fn events(&self) -> Vec<Event> {
        let event = |jump: &JumpOf<A>| {
            let scene_event = scene_event(&*self.automaton, &*self.view, jump);
            let side = |ball: usize| Sides {
                ball,
                from: self.view.mode(jump.from, ball),
                before: self.moment(&jump.before, ball),
                to: self.view.mode(jump.to, ball),
                after: self.moment(&jump.after, ball),
            };
            let all = || (0..self.balls()).map(side);
            let sides = match scene_event.balls {
                [None, None] => all().collect(),
                // What touches hands an impact on at the same time: then others take part.
                some => {
                    let passed =
                        all().filter(|s| !some.contains(&Some(s.ball)) && s.before.velocity != s.after.velocity);
                    some.into_iter().flatten().map(side).chain(passed).collect()
                }
            };
            Event { t: jump.t(), j: jump.j, edge: scene_event.edge, sides }
        };
        self.run.trajectory.jumps().iter().map(event).collect()
    }

    fn impacts(&self) -> Vec<Impact> {
        if let Some(contacts) = self.view.contacts(&self.automaton, &self.run.trajectory) {
            return contacts;
        }
        let jumps = self.run.trajectory.jumps().iter();
        jumps.filter_map(|jump| impact(&*self.automaton, &*self.view, jump)).collect()
    }

    fn hysteresis(&self, contact: usize, count: usize) -> Vec<[f64; 2]> {
        self.view.hysteresis(&self.automaton, &self.run.trajectory, contact, count)
    }

    fn cost(&self) -> Cost {
        self.run.end.stats.into()
    }

    fn doubts(&self) -> Vec<String> {
        let said = |doubt: &InspectionOf<A>| {
            let edge = self.view.edge(&self.automaton, doubt.edge);
            // What follows a colon says what the edge is.
            let name = edge.split(':').next().unwrap_or(&edge);
            let mode = self.view.mode(doubt.mode, 0);
            let times = doubt.doubt().unwrap_or_default();
            let why = match doubt.evidence.doubt() {
                Some(Doubt::Grazing) => "the error of the steps decides whether it came to that",
                Some(Doubt::Rounding) => "rounding hides whether it came to that",
                Some(Doubt::Discontinuous) => "what decides it is not continuous",
                Some(Doubt::Missed) => "it was passed by the end, and its time was not found",
                _ => "the search for it was given up",
            };
            format!("{name} in mode {mode}, {:.9} s to {:.9} s: {why}", times.start, times.end)
        };
        self.run.trajectory.doubts().iter().map(said).collect()
    }
}
