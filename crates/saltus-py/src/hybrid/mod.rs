//! Hybrid systems of plain functions, for Python.

mod called;
mod ensemble;
mod model;
mod names;
mod run;
mod slide;
mod tape;

use std::sync::Arc;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use saltus::{Clock, Coords, Entry, Wrt};

use crate::fail;
use called::Called;
use model::{ClockOf, EdgeOf, Function, MOST_PARAMETERS, ModeOf, Model, Vector};
use names::{Mode, Name};
use run::{Course, End, Failure, Options, Recorded};
use slide::SlideOf;

/// How many coordinates a state may have.
const MOST_COORDINATES: usize = 64;

/// What a function became when it was called with symbols.
#[pyclass(frozen, module = "saltus._core")]
pub(crate) struct Tape(Arc<tape::Tape>);

#[pymethods]
impl Tape {
    /// Operations as (name, place, place, place, number), and the places of what they come to.
    #[new]
    fn new(
        ops: Vec<(String, usize, usize, usize, f64)>,
        outputs: Vec<usize>,
        coordinates: usize,
        parameters: usize,
    ) -> PyResult<Self> {
        use tape::{One, Op, Two};
        let op = |(name, a, b, c, number): (String, usize, usize, usize, f64)| {
            Some(match name.as_str() {
                "constant" => Op::Constant(number),
                "time" => Op::Time,
                "coordinate" => Op::Coordinate(a),
                "parameter" => Op::Parameter(a),
                "neg" => Op::One(One::Neg, a),
                "abs" => Op::One(One::Abs, a),
                "sqrt" => Op::One(One::Sqrt, a),
                "exp" => Op::One(One::Exp, a),
                "log" => Op::One(One::Ln, a),
                "sin" => Op::One(One::Sin, a),
                "cos" => Op::One(One::Cos, a),
                "tan" => Op::One(One::Tan, a),
                "atan" => Op::One(One::Atan, a),
                "tanh" => Op::One(One::Tanh, a),
                "add" => Op::Two(Two::Add, a, b),
                "sub" => Op::Two(Two::Sub, a, b),
                "mul" => Op::Two(Two::Mul, a, b),
                "div" => Op::Two(Two::Div, a, b),
                "atan2" => Op::Two(Two::Atan2, a, b),
                "power" => Op::Power(a, number),
                "choose" => Op::Choose(a, b, c),
                _ => return None,
            })
        };
        let ops: Option<Vec<_>> = ops.into_iter().map(op).collect();
        let tape = ops.and_then(|ops| tape::Tape::new(ops, outputs, coordinates, parameters));
        tape.map(|tape| Self(Arc::new(tape))).ok_or_else(|| fail::value("these operations are no formula"))
    }
}

/// A function as Python gives it.
#[derive(FromPyObject)]
enum Given<'py> {
    Traced(PyRef<'py, Tape>),
    Called(Bound<'py, PyAny>),
}

impl Given<'_> {
    fn function(self, what: String, outputs: usize) -> PyResult<Function> {
        match self {
            Self::Traced(tape) if tape.0.outputs() == outputs => Ok(Function::Traced(Arc::clone(&tape.0))),
            Self::Traced(tape) => {
                let given = tape.0.outputs();
                Err(fail::value(format!("{what} gives {given} numbers and not {outputs}")))
            }
            Self::Called(function) => Ok(Function::Called(Called::new(function.unbind(), what, outputs))),
        }
    }
}

/// Where and when a run starts, and when it ends.
type Start = (usize, Vec<f64>, (f64, f64));
/// How the end and the times of the jumps depend on one number.
type Row = (Vec<f64>, Vec<f64>);
type GivenEdge<'py> = (usize, Given<'py>, Option<Given<'py>>, String, bool);
/// When a clock ticks: its period, its times, its phase, and whether also as a run starts.
type Ticks = (Option<f64>, Option<Vec<f64>>, Option<f64>, bool);
type GivenClock<'py> = (usize, Ticks, Option<Given<'py>>);
type Beyond<'py> = Option<(usize, Option<Given<'py>>)>;
type GivenMode<'py> = (String, Option<Given<'py>>, Vec<GivenEdge<'py>>, Vec<GivenClock<'py>>, Beyond<'py>);
/// The modes above, below and along a surface.
type GivenSlide<'py> = ([usize; 3], PyRef<'py, Tape>);

/// A hybrid automaton: its functions, without numbers for their parameters.
#[pyclass(frozen, module = "saltus._core")]
pub(crate) struct Hybrid {
    coordinates: usize,
    modes: Vec<ModeOf>,
    slides: Vec<([Mode; 3], Arc<tape::Tape>)>,
}

fn clock((period, times, phase, from_start): Ticks) -> Clock {
    let clock = match (period, times) {
        (Some(period), Some(times)) => Clock::at(times).repeated(period),
        (None, times) => Clock::at(times.unwrap_or_default()),
        (Some(period), None) => Clock::every(period),
    };
    let clock = if let Some(phase) = phase { clock.after(phase) } else { clock };
    if from_start { clock.from_start() } else { clock }
}

/// Does the same for the kind of states that has room for so many coordinates.
macro_rules! for_size {
    ($n:expr, $S:ident => $body:expr) => {
        match $n {
            2 => {
                type $S = [f64; 2];
                $body
            }
            0..=4 => {
                type $S = Coords<4>;
                $body
            }
            5..=16 => {
                type $S = Coords<16>;
                $body
            }
            _ => {
                type $S = Coords<64>;
                $body
            }
        }
    };
}

#[pymethods]
impl Hybrid {
    #[new]
    fn new(
        coordinates: usize,
        parameters: usize,
        modes: Vec<GivenMode<'_>>,
        slides: Vec<GivenSlide<'_>>,
    ) -> PyResult<Self> {
        if coordinates == 0 || coordinates > MOST_COORDINATES {
            return Err(fail::value(format!("a state has 1 to {MOST_COORDINATES} coordinates, and not {coordinates}")));
        }
        if parameters > MOST_PARAMETERS {
            return Err(fail::value(format!(
                "a system has at most {MOST_PARAMETERS} parameters, and not {parameters}"
            )));
        }
        let names: Vec<Mode> = (0..).zip(&modes).map(|(place, of)| Mode { place, name: Name::new(&of.0) }).collect();
        let known = |place: usize| names.get(place).copied().ok_or_else(|| fail::value("an edge leads to no mode"));
        let mode = |(mode, (name, flow, edges, clocks, beyond)): (Mode, GivenMode<'_>)| {
            let edge = |(to, guard, reset, entry, terminal): GivenEdge<'_>| {
                let to = known(to)?;
                let what = format!("the edge {name} -> {}", to.name.text());
                let guard = guard.function(format!("the guard of {what}"), 1)?;
                let reset = reset.map(|reset| reset.function(format!("the reset of {what}"), coordinates));
                let entry = match entry.as_str() {
                    "refuse" => Entry::Refuse,
                    "wait" => Entry::Wait,
                    "fire" => Entry::Fire,
                    other => {
                        let says = format!("'{other}' is no entry: an edge refuses, waits or fires ('fire')");
                        return Err(fail::value(says));
                    }
                };
                Ok(EdgeOf { to, guard, reset: reset.transpose()?, entry, terminal })
            };
            let edges = edges.into_iter().map(edge).collect::<PyResult<Vec<_>>>()?;
            let ticking = |(to, ticks, reset): GivenClock<'_>| {
                let to = known(to)?;
                let what = format!("the reset of the clock {name} -> {}", to.name.text());
                let reset = reset.map(|reset| reset.function(what, coordinates)).transpose()?;
                PyResult::Ok(ClockOf { to, clock: clock(ticks), reset })
            };
            let clocks = clocks.into_iter().map(ticking).collect::<PyResult<Vec<_>>>()?;
            let flow = flow.map(|flow| flow.function(format!("the flow of {name}"), coordinates)).transpose()?;
            let beyond = beyond.map(|(to, reset)| {
                let reset = reset.map(|reset| reset.function(format!("what lies beyond {name}"), coordinates));
                PyResult::Ok((known(to)?, reset.transpose()?))
            });
            PyResult::Ok(ModeOf { mode, flow, edges, clocks, beyond: beyond.transpose()? })
        };
        let modes = names.iter().copied().zip(modes).map(mode).collect::<PyResult<Vec<_>>>()?;
        let slide = |(sides, surface): GivenSlide<'_>| {
            let [above, below, sliding] = sides.map(known);
            PyResult::Ok(([above?, below?, sliding?], Arc::clone(&surface.0)))
        };
        Ok(Self { coordinates, modes, slides: slides.into_iter().map(slide).collect::<PyResult<_>>()? })
    }

    /// Runs from a state in a mode, and records.
    fn run(
        &self,
        py: Python<'_>,
        start: Start,
        p: Vec<f64>,
        named: Option<Py<PyAny>>,
        options: Options,
    ) -> PyResult<Run> {
        let course = self.course(start)?;
        for_size!(self.coordinates, S => {
            let model = self.model::<S>(py, p, named, &options)?;
            let run = py.detach(|| run::record(&model, &course, &options));
            let (recorded, end) = run.map_err(failed)?;
            Ok(Run { recorded, end, n: self.coordinates })
        })
    }

    /// How the end and the times of the jumps depend on parameters and on the state at the start:
    /// rows of numbers, one for each.
    fn gradient(
        &self,
        py: Python<'_>,
        start: Start,
        p: Vec<f64>,
        wrt: Vec<(bool, usize)>,
        options: Options,
    ) -> PyResult<Vec<Row>> {
        let course = self.course(start)?;
        for_size!(self.coordinates, S => {
            let model = self.model::<S>(py, p, None, &options)?;
            let of = |(initial, place): (bool, usize)| {
                let wrt = if initial { Wrt::Initial(place) } else { Wrt::Parameter(place) };
                run::gradient(&model, &course, &options, wrt).map(|row| (row.end, row.times))
            };
            py.detach(|| wrt.into_iter().map(of).collect::<Result<Vec<_>, _>>()).map_err(failed)
        })
    }

    /// Runs from each of the states, with the parameters of the same row: what came of each.
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        start: (usize, (f64, f64)),
        states: PyReadonlyArray1<'py, f64>,
        p: PyReadonlyArray1<'py, f64>,
        count: usize,
        options: Options,
    ) -> PyResult<Bound<'py, PyDict>> {
        let course = self.course((start.0, vec![0.0; self.coordinates], start.1))?;
        let (states, p) = (states.as_slice().map_err(fail::value)?, p.as_slice().map_err(fail::value)?);
        if states.len() != count * self.coordinates || count == 0 || p.len() % count != 0 {
            return Err(fail::value("there are not as many states as runs"));
        }
        for_size!(self.coordinates, S => ensemble::run::<S>(py, self, &course, states, p, &options))
    }
}

impl Hybrid {
    fn course(&self, (mode, state, (from, to)): Start) -> PyResult<Course> {
        let mode = self.modes.get(mode).map(|of| of.mode).ok_or_else(|| fail::value("there is no such mode"))?;
        if state.len() != self.coordinates {
            let (given, wanted) = (state.len(), self.coordinates);
            return Err(fail::value(format!("the state has {given} coordinates and not {wanted}")));
        }
        Ok(Course { mode, state, span: from..to })
    }

    fn model<S: Vector>(
        &self,
        py: Python<'_>,
        p: Vec<f64>,
        named: Option<Py<PyAny>>,
        options: &Options,
    ) -> PyResult<Model<S>> {
        let like = S::of(&vec![0.0; self.coordinates]).ok_or_else(|| fail::value("too many coordinates"))?;
        let again = |function: &Function| function.clone_ref(py);
        let modes = self.modes.iter().map(|of| ModeOf {
            mode: of.mode,
            flow: of.flow.as_ref().map(again),
            edges: of
                .edges
                .iter()
                .map(|edge| EdgeOf { guard: again(&edge.guard), reset: edge.reset.as_ref().map(again), ..*edge })
                .collect(),
            clocks: of
                .clocks
                .iter()
                .map(|of| ClockOf { to: of.to, clock: of.clock.clone(), reset: of.reset.as_ref().map(again) })
                .collect(),
            beyond: of.beyond.as_ref().map(|(to, reset)| (*to, reset.as_ref().map(again))),
        });
        let slide = |([above, below, sliding], surface): &([Mode; 3], Arc<tape::Tape>)| {
            let (given, surface) = (Arc::clone(surface), surface.bound(&p));
            let affine = surface.affine(self.coordinates).and_then(|mut rows| rows.pop());
            SlideOf { above: *above, below: *below, sliding: *sliding, given, surface, affine }
        };
        let slides = self.slides.iter().map(slide).collect();
        Ok(Model::new((modes.collect(), slides), like, p, named, options.is_stepped()))
    }
}

/// A run that failed: in the engine's words, with what Python raised as the cause; Ctrl-C as it is.
fn failed(failure: Failure) -> PyErr {
    let Failure { error, raised } = failure;
    let Some(error) = error else { return raised.unwrap_or_else(|| fail::saltus("the run failed")) };
    let run = fail::RunError::new_err(error.to_string());
    Python::attach(|py| {
        if let Some(raised) = raised {
            if !raised.is_instance_of::<pyo3::exceptions::PyException>(py) {
                return raised;
            }
            run.set_cause(py, Some(raised));
        }
        let value = run.value(py);
        let set = value.setattr("t", error.t()).and_then(|()| value.setattr("mode", error.mode().trim_matches('"')));
        match set.and_then(|()| value.setattr("state", error.state().to_vec())) {
            Ok(()) => run,
            Err(other) => other,
        }
    })
}

/// A recorded run.
#[pyclass(frozen, module = "saltus._core")]
pub(crate) struct Run {
    recorded: Box<dyn Recorded>,
    end: End,
    n: usize,
}

#[pymethods]
impl Run {
    /// The states at the times, a row each.
    fn at<'py>(&self, times: PyReadonlyArray1<'py, f64>, before: bool) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let py = times.py();
        let times = times.as_slice().map_err(fail::value)?;
        let values = py.detach(|| self.recorded.at(times, before));
        values.into_pyarray(py).reshape([times.len(), self.n])
    }

    /// The places of the modes at the times; -1 outside the run.
    fn modes<'py>(&self, times: PyReadonlyArray1<'py, f64>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let modes = self.recorded.modes(times.as_slice().map_err(fail::value)?);
        let place = |mode: Option<u32>| mode.map_or(-1, i64::from);
        Ok(modes.into_iter().map(place).collect::<Vec<_>>().into_pyarray(times.py()))
    }

    /// The jumps by columns.
    fn jumps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let jumps = self.recorded.jumps();
        let columns = PyDict::new(py);
        let count = jumps.len();
        let place = |of: fn(&run::Jumped) -> i64| jumps.iter().map(of).collect::<Vec<_>>().into_pyarray(py);
        columns.set_item("t", jumps.iter().map(|jump| jump.t).collect::<Vec<_>>().into_pyarray(py))?;
        columns.set_item("from", place(|jump| jump.from.into()))?;
        columns.set_item("to", place(|jump| jump.to.into()))?;
        columns.set_item("edge", place(|jump| jump.edge.map_or(-1, i64::from)))?;
        let states = |of: fn(&run::Jumped) -> &[f64]| {
            let all: Vec<f64> = jumps.iter().flat_map(|jump| of(jump).iter().copied()).collect();
            all.into_pyarray(py).reshape([count, self.n])
        };
        columns.set_item("before", states(|jump| &jump.before)?)?;
        columns.set_item("after", states(|jump| &jump.after)?)?;
        Ok(columns)
    }

    /// How it ended: why, where jumps accumulate, when, in which mode and state, how many jumps.
    fn end(&self) -> (&'static str, Option<f64>, f64, u32, Vec<f64>, usize) {
        let End { stop, limit, t, mode, state, jumps, .. } = &self.end;
        (stop, *limit, *t, mode.place, state.clone(), *jumps)
    }

    /// What it cost, in counts.
    fn cost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (cost, stats) = (PyDict::new(py), self.end.stats);
        cost.set_item("jumps", stats.jumps)?;
        for (name, count) in [
            ("steps", stats.steps),
            ("rejected", stats.rejected),
            ("exact", stats.exact),
            ("stiff", stats.stiff),
            ("flows", stats.flows),
            ("guards", stats.guards),
        ] {
            cost.set_item(name, count)?;
        }
        Ok(cost)
    }

    fn doubts(&self) -> Vec<String> {
        self.recorded.doubts()
    }

    fn picture(&self, names: Vec<String>) -> PyResult<String> {
        self.recorded.picture(&names).map_err(fail::saltus)
    }

    fn phase(&self, across: usize, up: usize, names: Vec<String>) -> PyResult<String> {
        self.recorded.phase([across, up], &names).map_err(fail::saltus)
    }
}
