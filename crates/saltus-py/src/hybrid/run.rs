//! Runs of a model: recorded, with derivatives, and many at once.

use std::ops::{ControlFlow, Range};

use pyo3::prelude::*;
use saltus::{
    Auto, Automaton, Cause, Dop853, Ending, Error, JumpOf, Lift, Observer, Piece, Rodas5P, Sensitive, Simulation,
    State, Stats, Stop, Tangent, Time, Trajectory, Tsit5, Wrt,
};

use super::model::{Model, Vector};
use super::names::{Edge, Mode};
use crate::signal::Signals;

/// How a model is run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options {
    pub(crate) method: String,
    rtol: f64,
    atol: Option<f64>,
    longest_step: Option<f64>,
    most_jumps: usize,
    most_steps: u64,
    most_bytes: usize,
}

impl Options {
    /// Whether nothing is solved and nothing expanded in series.
    pub(crate) fn is_stepped(&self) -> bool {
        !matches!(self.method.as_str(), "auto" | "series")
    }

    fn stepper(&self) -> Auto {
        match self.method.as_str() {
            "tsit5" => Tsit5.into(),
            "dop853" => Dop853.into(),
            "rodas5p" => Rodas5P.into(),
            _ => Auto::new(),
        }
    }

    fn of<'a, A: Automaton>(&self, automaton: &'a A) -> Simulation<'a, A> {
        let simulation = Simulation::of(automaton).stepper(self.stepper()).tolerance(self.rtol);
        let simulation = simulation.most_jumps(self.most_jumps).most_steps(self.most_steps);
        let simulation = match self.atol {
            Some(atol) => simulation.absolute_tolerance(atol),
            None => simulation,
        };
        match self.longest_step {
            Some(h) => simulation.longest_step(h),
            None => simulation,
        }
    }
}

/// Where and when a run starts, and where it ends.
pub(crate) struct Course {
    pub(crate) mode: Mode,
    pub(crate) state: Vec<f64>,
    pub(crate) span: Range<f64>,
}

/// Ends a run on a signal, and where its record takes too many bytes.
struct Watch {
    signals: Signals,
    room: usize,
    signal: Option<PyErr>,
}

impl Watch {
    fn new(room: usize) -> Self {
        Self { signals: Signals::new(), room, signal: None }
    }

    #[inline]
    fn look(&mut self, bytes: usize) -> ControlFlow<()> {
        self.room = self.room.saturating_sub(bytes);
        if self.room == 0 {
            return ControlFlow::Break(());
        }
        self.signals.look().map_break(|signal| self.signal = Some(signal))
    }
}

impl<A: Automaton> Observer<A> for Watch {
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        self.look(size_of_val(piece.coefficients()))
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.look(2 * size_of_val(jump))
    }
}

/// How a run ended, for Python.
#[derive(Clone)]
pub(crate) struct End {
    pub(crate) stop: &'static str,
    /// Where jumps accumulate, if that is why.
    pub(crate) limit: Option<f64>,
    pub(crate) t: f64,
    pub(crate) mode: Mode,
    pub(crate) state: Vec<f64>,
    pub(crate) jumps: usize,
    pub(crate) stats: Stats,
}

impl End {
    fn of<S: State>(end: &Ending<Mode, Edge, S>, state: Vec<f64>, full: bool) -> Self {
        let (stop, limit) = match end.stop {
            Stop::Time => ("time", None),
            Stop::Forever => ("forever", None),
            Stop::Zeno { limit } => ("zeno", Some(limit)),
            Stop::Resolution { limit } => ("resolution", Some(limit)),
            Stop::Terminal { .. } => ("terminal", None),
            Stop::Jumps { .. } => ("jumps", None),
            Stop::Steps { .. } => ("steps", None),
            Stop::Cascade { .. } => ("cascade", None),
            Stop::Observer if full => ("bytes", None),
            _ => ("other", None),
        };
        Self { stop, limit, t: end.time.seconds(), mode: end.mode, state, jumps: end.jumps, stats: end.stats }
    }
}

/// Why there is no run: an error of the engine, or what Python raised.
pub(crate) struct Failure {
    pub(crate) error: Option<Error>,
    pub(crate) raised: Option<PyErr>,
}

impl From<PyErr> for Failure {
    fn from(raised: PyErr) -> Self {
        Self { error: None, raised: Some(raised) }
    }
}

/// A state of so many numbers that there is room for.
fn start<S: Vector>(state: &[f64]) -> Result<S, Failure> {
    S::of(state).ok_or_else(|| crate::fail::value(format!("{} coordinates are too many", state.len())).into())
}

/// A recorded run, whatever its states are.
pub(crate) trait Recorded: Send + Sync {
    /// The states after (or before) any jumps at each of the times, n numbers each; none outside.
    fn at(&self, times: &[f64], before: bool) -> Vec<f64>;
    fn jumps(&self) -> Vec<Jumped>;
    fn modes(&self, times: &[f64]) -> Vec<Option<u32>>;
    fn doubts(&self) -> Vec<String>;
    fn picture(&self, names: &[String]) -> Result<String, saltus_plot::PlotError>;
    fn phase(&self, axes: [usize; 2], names: &[String]) -> Result<String, saltus_plot::PlotError>;
}

/// A jump for Python.
pub(crate) struct Jumped {
    pub(crate) t: f64,
    /// None at the limit of infinitely many.
    pub(crate) edge: Option<u32>,
    pub(crate) from: u32,
    pub(crate) to: u32,
    pub(crate) before: Vec<f64>,
    pub(crate) after: Vec<f64>,
}

impl<S: Vector> Recorded for (Trajectory<Mode, Edge, S>, usize) {
    fn at(&self, times: &[f64], before: bool) -> Vec<f64> {
        let (trajectory, n) = self;
        let state = |t: f64| if before { trajectory.before(t) } else { trajectory.at(t) };
        let list = |t: &f64| state(*t).map_or_else(|| vec![f64::NAN; *n], |x| x.list());
        times.iter().flat_map(list).collect()
    }
    fn jumps(&self) -> Vec<Jumped> {
        let jumped = |jump: &saltus::Jump<Mode, Edge, S>| Jumped {
            t: jump.t(),
            edge: match jump.cause {
                Cause::Edge(edge) => Some(edge.place),
                _ => None,
            },
            from: jump.from.place,
            to: jump.to.place,
            before: jump.before.list(),
            after: jump.after.list(),
        };
        self.0.jumps().iter().map(jumped).collect()
    }
    fn modes(&self, times: &[f64]) -> Vec<Option<u32>> {
        times.iter().map(|t| self.0.mode_at(*t).map(|mode| mode.place)).collect()
    }
    fn doubts(&self) -> Vec<String> {
        self.0.doubts().iter().map(ToString::to_string).collect()
    }
    fn picture(&self, names: &[String]) -> Result<String, saltus_plot::PlotError> {
        saltus_plot::Panels::of(&self.0).named(names.to_vec()).svg()
    }
    fn phase(&self, [across, up]: [usize; 2], names: &[String]) -> Result<String, saltus_plot::PlotError> {
        saltus_plot::Phase::of(&self.0, across, up).named(names.to_vec()).svg()
    }
}

/// Runs and records.
pub(crate) fn record<S: Vector>(
    model: &Model<S>,
    course: &Course,
    options: &Options,
) -> Result<(Box<dyn Recorded>, End), Failure> {
    let state = start::<S>(&course.state)?;
    let mut trajectory = Trajectory::starting(course.mode, state.clone(), Time::new(course.span.start));
    let mut watch = Watch::new(options.most_bytes);
    let span = course.span.clone();
    let ended = options.of(model).drive(course.mode, state, span, &mut (&mut trajectory, &mut watch));
    if let Some(signal) = watch.signal {
        return Err(signal.into());
    }
    let end = ended.map_err(|error| Failure { error: Some(error), raised: model.raised.take() })?;
    trajectory.finish(end.time);
    let said = End::of(&end, end.state.list(), watch.room == 0);
    Ok((Box::new((trajectory, course.state.len())), said))
}

/// Runs without a record.
pub(crate) fn drive<S: Vector>(model: &Model<S>, course: &Course, options: &Options) -> Result<End, Failure> {
    let state = start::<S>(&course.state)?;
    let end = options.of(model).drive(course.mode, state, course.span.clone(), &mut ());
    let end = end.map_err(|error| Failure { error: Some(error), raised: model.raised.take() })?;
    Ok(End::of(&end, end.state.list(), false))
}

/// How the end and the times of the jumps depend on something.
pub(crate) struct Gradient {
    pub(crate) end: Vec<f64>,
    pub(crate) times: Vec<f64>,
}

/// Keeps how the time of each jump depends on what is asked for.
struct Delays {
    times: Vec<f64>,
    watch: Watch,
}

impl<'a, S: Vector + Lift> Observer<Sensitive<'a, Model<S>, 1>> for Delays {
    fn jump(&mut self, jump: &JumpOf<Sensitive<'a, Model<S>, 1>>) -> ControlFlow<()> {
        self.times.push(jump.after.dt[0]);
        self.watch.look(size_of_val(jump))
    }
    fn piece(&mut self, _: Mode, _: &Piece<'_, Tangent<S, 1>>) -> ControlFlow<()> {
        self.watch.look(0)
    }
}

/// The derivative of a run by one number.
pub(crate) fn gradient<S: Vector>(
    model: &Model<S>,
    course: &Course,
    options: &Options,
    wrt: Wrt,
) -> Result<Gradient, Failure> {
    let sensitive = Sensitive::of(model, [wrt]);
    let state = sensitive.start(course.span.start, start::<S>(&course.state)?);
    let mut delays = Delays { times: Vec::new(), watch: Watch::new(usize::MAX) };
    let ended = options.of(&sensitive).drive(course.mode, state, course.span.clone(), &mut delays);
    if let Some(signal) = delays.watch.signal {
        return Err(signal.into());
    }
    let end = ended.map_err(|error| Failure { error: Some(error), raised: None })?;
    Ok(Gradient { end: end.state.columns[0].list(), times: delays.times })
}
