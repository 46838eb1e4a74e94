//! A model with its start, ready to run, and the run read in terms of the scene.

use std::ops::ControlFlow;
use std::sync::Arc;

use saltus::cross::Doubt;
use saltus::{
    Automaton, EndingOf, InspectionOf, Jump, JumpOf, Observer, Piece, Run, RunOf, Simulation, Solution, Time,
    Trajectory,
};
use saltus_bounce::units::Quantity;

use super::RunError;
use super::explain::{Advance, ModePlan};
use super::method::Method;
use super::outcome::{Outcome, OutcomeObserver};
use super::record::{Cost, End, Event, Impact, Moment, RecordedRun, Segment, Sides};
use super::view::{SceneView, impact, moment, scene_event, segment};

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
    /// The absolute tolerance, for coordinates near zero; a thousandth of the tolerance unless
    /// given.
    pub(super) absolute: Option<f64>,
    /// The time from which no floor moves, in s.
    pub(super) still: f64,
}

/// The part of a motion that ends by itself that is kept beyond its end.
const SHOWN_AFTER_REST: f64 = 0.05;
/// A ball that slides or rolls through air never quite stops: its run ends at so many times the
/// time of its last jump, which is then taken to be the last of all. The test
/// `what_moves_sideways_may_end_by_itself` has a second jump at 1.4 times the first.
const QUIET: f64 = 2.0;
/// The part that is kept of a motion at rest from the start, in s.
const SHOWN_AT_REST: f64 = 1.0;

/// Until when to show a motion that ends by itself at `last`.
fn shown(last: f64) -> f64 {
    if last > 0.0 { last * (1.0 + SHOWN_AFTER_REST) } else { SHOWN_AT_REST }
}

impl RunOptions {
    /// Until when a run that reached `until` is shown: what lies still or rolls on beyond the
    /// `last` jump needs no end, and a little of it is shown.
    fn shown(&self, end: End, until: f64, last: f64, rest: Option<f64>) -> Result<f64, RunError> {
        const STOP: &str = "say when to stop, by --until or by `until` under [run]";
        let until = if self.until.is_none() && end == End::Time && until > last && (last > 0.0 || rest.is_some()) {
            shown(last)
        } else {
            until
        };
        if until.is_infinite() {
            return Err(RunError::new(format!("without gravity the ball may never land: {STOP}")));
        }
        let largest = Quantity::Time.largest();
        if until > largest {
            let says =
                format!("the run ends at {until:.1e} s, beyond the times that can be right, {largest:e} s: {STOP}");
            return Err(RunError::new(says));
        }
        Ok(until)
    }
}

/// Fewer evaluations than any stepper needs for a step: it is flows that are solved whose steps
/// this limits.
const EVALUATIONS_PER_STEP: u64 = 5;

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

/// A callback between steps and jumps, by which the caller may end the run.
pub(super) type Ask<'a> = &'a mut dyn FnMut() -> ControlFlow<()>;

/// An observer that ends a run where its callback does.
struct Asking<'a> {
    ask: Ask<'a>,
    is_over: bool,
}

impl Asking<'_> {
    fn look(&mut self) -> ControlFlow<()> {
        let answer = (self.ask)();
        self.is_over |= answer.is_break();
        answer
    }
}

impl<A: Automaton> Observer<A> for Asking<'_> {
    fn piece(&mut self, _: A::Mode, _: &Piece<'_, A::State>) -> ControlFlow<()> {
        self.look()
    }
    fn jump(&mut self, _: &JumpOf<A>) -> ControlFlow<()> {
        self.look()
    }
}

/// A model bound to its start, of whatever kind.
pub(super) trait Runner: Send + Sync {
    fn run(&self, options: &RunOptions, ask: Ask<'_>) -> Result<Recording, RunError>;
    fn outcome(&self, options: &RunOptions) -> Result<Outcome, RunError>;
    fn modes(&self, method: Method) -> Vec<ModePlan>;
    fn coordinates(&self) -> usize;
}

/// A model, its view in the scene, and its start.
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
            .most_evaluations(options.most_evaluations)
            .most_steps(options.most_evaluations / EVALUATIONS_PER_STEP);
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
        simulation.drive(self.mode, self.state.clone(), 0.0..until, &mut observer)
    }

    /// Until when to run.
    fn until(
        &self,
        options: &RunOptions,
        simulation: &Simulation<'_, A, R::Stepper>,
        observer: &mut dyn Observer<A>,
    ) -> Result<f64, saltus::Error> {
        match options.until {
            Some(until) => Ok(until),
            None if options.solved => Ok(f64::INFINITY),
            // Steps would go on for ever: the run is made twice, first to see when it ends.
            None => {
                let mut resting = Resting { view: &*self.view, still: options.still, last: 0.0 };
                self.drive(simulation, f64::INFINITY, &mut (&mut resting, observer))?;
                Ok(shown(resting.last))
            }
        }
    }
}

impl<A: Shared, R: SceneView<A>> Runner for BoundModel<A, R> {
    fn run(&self, options: &RunOptions, ask: Ask<'_>) -> Result<Recording, RunError> {
        let simulation = self.simulation(options);
        let mut asking = Asking { ask, is_over: false };
        let until = self.until(options, &simulation, &mut asking)?;
        let run = match options.frames {
            None => {
                let mut trajectory = Trajectory::starting(self.mode, self.state.clone(), Time::new(0.0));
                let end = self.drive(&simulation, until, &mut (&mut trajectory, &mut asking))?;
                trajectory.finish(end.time);
                Run { trajectory, end }
            }
            Some(rate) => saltus::frame_by_frame(
                &*self.automaton,
                self.mode,
                self.state.clone(),
                0.0..until,
                rate,
                options.most_jumps,
            )?,
        };
        if asking.is_over {
            return Err(RunError::ended());
        }
        let end = End::of(&run.end.stop);
        let last = run.trajectory.jumps().last().map_or(0.0, Jump::t);
        let rest = (end == End::Time && self.view.rests(run.end.mode, &run.end.state)).then_some(last);
        let until = options.shown(end, run.trajectory.end().seconds(), last, rest)?;
        let read = BoundRun { automaton: Arc::clone(&self.automaton), view: Arc::clone(&self.view), run };
        Ok(Recording { run: Box::new(read), until, end, rest })
    }

    fn outcome(&self, options: &RunOptions) -> Result<Outcome, RunError> {
        let simulation = self.simulation(options);
        let until = self.until(options, &simulation, &mut ())?;
        let mut observer = OutcomeObserver::new(&*self.automaton, &*self.view);
        let ending = self.drive(&simulation, until, &mut observer)?;
        let (end, last) = (End::of(&ending.stop), observer.last_jump());
        let rest = (end == End::Time && self.view.rests(ending.mode, &ending.state)).then_some(last);
        let until = options.shown(end, ending.time.seconds(), last, rest)?;
        let state = if until < ending.time.seconds() {
            let (t, mode, state) = observer.left.take().unwrap_or_else(|| (0.0, self.mode, self.state.clone()));
            let mut nothing: &mut dyn Observer<A> = &mut ();
            simulation.drive(mode, state, t..until, &mut nothing)?.state
        } else {
            ending.state.clone()
        };
        Ok(observer.outcome(&ending, end, until, &state, rest))
    }

    fn modes(&self, method: Method) -> Vec<ModePlan> {
        let plan = |mode: A::Mode| {
            let (automaton, view) = (&*self.automaton, &*self.view);
            let advance = match automaton.solution(mode, 0.0, &self.state) {
                Solution::Polynomial(_) => Advance::Exact,
                Solution::Formula(_) => Advance::Formula,
                Solution::Series(_) => Advance::Series,
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

/// Ends a run as everything has come to rest, or lies, slides and rolls on alone.
struct Resting<'a, R> {
    view: &'a R,
    /// The time from which no floor moves, in s.
    still: f64,
    /// The time of the last jump, in s.
    last: f64,
}

impl<A: Automaton, R: SceneView<A>> Observer<A> for Resting<'_, R> {
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let flies = (0..self.view.balls()).any(|ball| self.view.flies(mode, ball));
        let quiet = !flies && self.last > 0.0 && piece.start().seconds() > (QUIET * self.last).max(self.still);
        if quiet { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.last = jump.t();
        if self.view.rests(jump.to, &jump.after) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// A run whose record is made on demand.
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
            let edge = self.view.edge(&self.automaton, doubt.mode, doubt.edge);
            // A colon and an explanation may follow the name of an edge.
            let name = edge.split(':').next().unwrap_or(&edge);
            // Of several balls each is in a mode of its own.
            let mode = if self.view.balls() > 1 {
                String::new()
            } else {
                format!(" in mode {}", self.view.mode(doubt.mode, 0))
            };
            let times = doubt.doubt().unwrap_or_default();
            let why = match doubt.evidence.doubt() {
                Some(Doubt::Grazing) => "the error of the steps decides whether it came to that",
                Some(Doubt::Rounding) => "rounding hides whether it came to that",
                Some(Doubt::Discontinuous) => "what decides it is not continuous",
                Some(Doubt::Accumulated) => "rounding hides whether its bounces end there",
                Some(Doubt::Missed) => "it was passed by the end, and its time was not found",
                _ => "the search for it was given up",
            };
            format!("{name}{mode}, {:.9} s to {:.9} s: {why}", times.start, times.end)
        };
        self.run.trajectory.doubts().iter().map(said).collect()
    }
}
