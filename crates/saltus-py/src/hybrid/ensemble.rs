//! Many runs of one model at once, on all cores.

use std::ops::ControlFlow;

use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::model::Vector;
use super::run::{Course, End, Failure, Options, drive};
use super::{Hybrid, Model};
use crate::signal::Signals;

/// What comes of each run, by columns.
#[derive(Default)]
struct Columns {
    t: Vec<f64>,
    state: Vec<f64>,
    mode: Vec<i64>,
    jumps: Vec<i64>,
    stop: Vec<&'static str>,
    limit: Vec<f64>,
    why: Vec<(usize, String)>,
}

impl Columns {
    fn push(&mut self, run: usize, n: usize, came: Result<End, String>) {
        match came {
            Ok(end) => {
                self.t.push(end.t);
                self.state.extend(end.state);
                self.mode.push(end.mode.place.into());
                self.jumps.push(i64::try_from(end.jumps).unwrap_or(i64::MAX));
                self.stop.push(end.stop);
                self.limit.push(end.limit.unwrap_or(f64::NAN));
            }
            Err(why) => {
                self.t.push(f64::NAN);
                self.state.extend(std::iter::repeat_n(f64::NAN, n));
                self.mode.push(-1);
                self.jumps.push(0);
                self.stop.push("failed");
                self.limit.push(f64::NAN);
                self.why.push((run, why));
            }
        }
    }
}

/// Runs from each state with its parameters; a run that fails is a row like any other.
pub(super) fn run<'py, S: Vector>(
    py: Python<'py>,
    hybrid: &Hybrid,
    course: &Course,
    states: &[f64],
    p: &[f64],
    options: &Options,
) -> PyResult<Bound<'py, PyDict>> {
    let n = hybrid.coordinates;
    let count = states.len() / n;
    let width = p.len() / count;
    let parameters = |run: usize| &p[run * width..(run + 1) * width];
    let shared: Option<Model<S>> = if width == 0 { Some(hybrid.model(py, Vec::new(), None, options)?) } else { None };
    let one = |run: usize| -> Result<End, String> {
        let state = states[run * n..(run + 1) * n].to_vec();
        let course = Course { mode: course.mode, state, span: course.span.clone() };
        let came = match &shared {
            Some(model) => drive(model, &course, options),
            None => {
                let model = Python::attach(|py| hybrid.model::<S>(py, parameters(run).to_vec(), None, options));
                model.map_err(Failure::from).and_then(|model| drive(&model, &course, options))
            }
        };
        came.map_err(|Failure { error, raised }| {
            error.map(|e| e.to_string()).or(raised.map(|e| e.to_string())).unwrap_or_default()
        })
    };
    let (mut columns, mut signals) = (Columns::default(), Signals::new());
    let done = py.detach(|| {
        saltus::ensemble(0..count, one, |run, came| {
            columns.push(run, n, came);
            signals.ask()
        })
    });
    if let ControlFlow::Break(signal) = done {
        return Err(signal);
    }
    let all = PyDict::new(py);
    all.set_item("t", columns.t.into_pyarray(py))?;
    all.set_item("state", columns.state.into_pyarray(py).reshape([count, n])?)?;
    all.set_item("mode", columns.mode.into_pyarray(py))?;
    all.set_item("jumps", columns.jumps.into_pyarray(py))?;
    all.set_item("limit", columns.limit.into_pyarray(py))?;
    all.set_item("stop", columns.stop)?;
    all.set_item("why", columns.why)?;
    Ok(all)
}
