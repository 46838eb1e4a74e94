//! Scenes: planned, run, explained, solved, and handed on as arrays, pictures and files.

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use saltus_bounce::units::Quantity;
use saltus_motion::{Format, Frames};
use saltus_plot::record as pictures;
use saltus_scene::accuracy::{Accuracy, Target};
use saltus_scene::plan::{End, Moment, Record, With};
use saltus_scene::solve::{Clock, Wish};
use saltus_scene::{Kind, Sampling, Scene, Staging, Values};

use crate::fail::{self, named};
use crate::fit::Amount;
use crate::signal::{Signals, patiently};

/// What a run is asked for beside its scene.
fn ending(until: Option<f64>, most_jumps: Option<u32>, tolerance: Option<f64>) -> saltus_scene::Run {
    let mut run = saltus_scene::Run::default();
    (run.until, run.most_jumps, run.tolerance) = (until, most_jumps, tolerance);
    run
}

/// A run of a scene.
#[pyfunction]
#[pyo3(signature = (name, toml, until=None, most_jumps=None, tolerance=None))]
pub(crate) fn simulate(
    py: Python<'_>,
    name: &str,
    toml: &[u8],
    until: Option<f64>,
    most_jumps: Option<u32>,
    tolerance: Option<f64>,
) -> PyResult<Motion> {
    let scene = Scene::parse_with(name, toml, ending(until, most_jumps, tolerance)).map_err(fail::scene)?;
    let plan = scene.plan().map_err(fail::scene)?;
    let (mut signals, mut signal) = (Signals::new(), None);
    let record = py.detach(|| plan.run_while(&mut || signals.look().map_break(|raised| signal = Some(raised))));
    signal.map_or_else(|| record.map(Motion).map_err(fail::run), Err)
}

/// How a scene would be run, and why, in words.
#[pyfunction]
pub(crate) fn explain(name: &str, toml: &[u8]) -> PyResult<String> {
    let scene = Scene::parse(name, toml).map_err(fail::scene)?;
    Ok(scene.plan().map_err(fail::scene)?.explain().to_string())
}

/// What accuracy costs in a scene, as JSON, up to `until` in s, with the setting to take for places
/// within a `length` and impacts within a `time`.
#[pyfunction]
#[pyo3(signature = (name, toml, length=None, time=None, until=None))]
pub(crate) fn accuracy(
    py: Python<'_>,
    name: &str,
    toml: &[u8],
    length: Option<Amount>,
    time: Option<Amount>,
    until: Option<f64>,
) -> PyResult<String> {
    let scene = Scene::parse_with(name, toml, ending(until, None, None)).map_err(fail::scene)?;
    let within = |amount: Option<Amount>, quantity: Quantity| {
        let value = amount.map(|amount| amount.of(quantity)).transpose()?;
        match value {
            Some(value) if value > 0.0 => Ok(Some(value)),
            Some(value) => Err(fail::value(format!("an accuracy of {value} is not above zero"))),
            None => Ok(None),
        }
    };
    let target = Target { length: within(length, Quantity::Length)?, time: within(time, Quantity::Time)? };
    let measured = py.detach(move || Accuracy::timed(&scene).map(|accuracy| (accuracy.toggled(&scene), accuracy)));
    let (toggles, accuracy) = measured.map_err(|error| fail::value(error.to_string()))?;
    accuracy.json(&toggles, target).map_err(fail::scene)
}

/// The scene, in TOML, in which wishes come true; whether they do; and a line about each.
#[pyfunction]
#[pyo3(signature = (wishes, free, begin=None, fps=24.0, first_frame=0))]
pub(crate) fn solve(
    py: Python<'_>,
    wishes: Vec<String>,
    free: Vec<String>,
    begin: Option<(String, Vec<u8>)>,
    fps: f64,
    first_frame: i32,
) -> PyResult<(String, bool, Vec<String>)> {
    let clock = Clock { fps, first: first_frame };
    patiently(py, move |_| {
        let wishes: Result<Vec<_>, _> = wishes.iter().map(|text| Wish::parse(text, clock)).collect();
        let free: Vec<&str> = free.iter().map(String::as_str).collect();
        let begin = begin.as_ref().map(|(name, toml)| (name.as_str(), toml.as_slice()));
        let solved = saltus_scene::solve::solve(begin, &free, &wishes.map_err(fail::value)?).map_err(fail::scene)?;
        Ok((solved.toml().map_err(fail::scene)?, solved.meets(), solved.says(clock)))
    })?
}

/// A recorded run of a scene.
#[pyclass(frozen, module = "saltus._core")]
pub(crate) struct Motion(Record);

/// A row of nine numbers: place, velocity and spin, each x, y, up.
fn row(moment: Option<Moment>) -> [f64; 9] {
    let Some(moment) = moment else { return [f64::NAN; 9] };
    let parts = [moment.position, moment.velocity, moment.spin];
    std::array::from_fn(|i| parts[i / 3][i % 3])
}

#[pymethods]
impl Motion {
    /// Why it ended, the same in a sentence, when, and from when on all is at rest.
    fn end(&self) -> (&'static str, String, f64, Option<f64>) {
        let Self(record) = self;
        (record.end().name(), record.end().to_string(), record.until(), record.rest())
    }

    /// Whether it ended as it was asked to.
    fn is_in_time(&self) -> bool {
        matches!(self.0.end(), End::Time)
    }

    fn gravity(&self) -> f64 {
        self.0.scene().gravity.value()
    }

    fn balls(&self) -> usize {
        self.0.balls()
    }

    /// Place, velocity and spin of a ball at the times, a row each; no numbers outside the run.
    fn at<'py>(
        &self,
        times: PyReadonlyArray1<'py, f64>,
        ball: usize,
        before: bool,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let py = times.py();
        let times = times.as_slice().map_err(fail::value)?;
        let moment = |t: f64| if before { self.0.before(ball, t) } else { self.0.at(ball, t) };
        let rows: Vec<f64> = py.detach(|| times.iter().flat_map(|t| row(moment(*t))).collect());
        rows.into_pyarray(py).reshape([times.len(), 9])
    }

    /// The impacts by columns: what there is none of is no number, and -1 of counts.
    fn impacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let impacts = self.0.impacts();
        let columns = PyDict::new(py);
        let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        let counts = |of: &dyn Fn(&saltus_scene::plan::Impact) -> i64| -> Bound<'py, PyArray1<i64>> {
            impacts.iter().map(of).collect::<Vec<_>>().into_pyarray(py)
        };
        let numbers = |of: &dyn Fn(&saltus_scene::plan::Impact) -> Option<f64>| -> Bound<'py, PyArray1<f64>> {
            impacts.iter().map(|impact| of(impact).unwrap_or(f64::NAN)).collect::<Vec<_>>().into_pyarray(py)
        };
        columns.set_item("t", numbers(&|impact| Some(impact.t)))?;
        columns.set_item("ball", counts(&|impact| count(impact.ball)))?;
        columns.set_item(
            "floor",
            counts(&|impact| match impact.with {
                With::Floor(floor) => count(floor),
                _ => -1,
            }),
        )?;
        columns.set_item(
            "other",
            counts(&|impact| match impact.with {
                With::Ball(other) => count(other),
                _ => -1,
            }),
        )?;
        columns.set_item("approach", numbers(&|impact| Some(impact.approach)))?;
        columns.set_item("rebound", numbers(&|impact| impact.rebound))?;
        columns.set_item("cor", numbers(&|impact| impact.cor()))?;
        columns.set_item("duration", numbers(&|impact| impact.press.and_then(|press| press.duration)))?;
        columns.set_item("force", numbers(&|impact| impact.press.map(|press| press.force)))?;
        columns.set_item("deformation", numbers(&|impact| impact.press.map(|press| press.deformation)))?;
        Ok(columns)
    }

    /// The tops of a ball's flights: when, and how high its lowest point is.
    fn apexes(&self, ball: usize) -> Vec<(f64, f64)> {
        self.0.apexes(ball).iter().map(|apex| (apex.t, apex.height)).collect()
    }

    /// Both sides of every jump, the samples if any, and the end: names and columns.
    #[pyo3(signature = (every=None, fps=None))]
    fn table<'py>(
        &self,
        py: Python<'py>,
        every: Option<f64>,
        fps: Option<f64>,
    ) -> PyResult<Vec<(&'static str, Bound<'py, PyAny>)>> {
        let table = self.0.table(sampling(every, fps)).map_err(fail::value)?;
        let column = |values: Values| -> PyResult<Bound<'py, PyAny>> {
            Ok(match values {
                Values::Numbers(values) => values.into_pyarray(py).into_any(),
                Values::Counts(values) => values.into_pyarray(py).into_any(),
                Values::Words(values) => values.into_pyobject(py)?.into_any(),
            })
        };
        let named = table.headers.into_iter().zip(table.columns);
        named.map(|(name, values)| Ok((name, column(values)?))).collect()
    }

    /// The same as JSON: docs/use/simulating.md.
    #[pyo3(signature = (every=None, fps=None))]
    fn json(&self, every: Option<f64>, fps: Option<f64>) -> PyResult<String> {
        self.0.json(sampling(every, fps)).map_err(fail::value)
    }

    fn text(&self) -> String {
        self.0.to_string()
    }

    fn doubts(&self) -> Vec<String> {
        self.0.doubts()
    }

    /// What it cost, in counts.
    fn cost<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (columns, cost) = (PyDict::new(py), self.0.cost());
        columns.set_item("jumps", cost.jumps)?;
        columns.set_item("steps", cost.steps)?;
        columns.set_item("flows", cost.flows)?;
        columns.set_item("guards", cost.guards)?;
        Ok(columns)
    }

    /// A picture, of the kind that the scene asks for unless given.
    #[pyo3(signature = (kind=None))]
    fn picture(&self, py: Python<'_>, kind: Option<&str>) -> PyResult<String> {
        let kind = kind.map(|kind| named(kind, "picture of a run", &Kind::ALL, Kind::name)).transpose()?;
        let kind = kind.unwrap_or(self.0.scene().picture.kind);
        py.detach(|| pictures::svg(&self.0, kind)).map_err(fail::saltus)
    }

    /// A file for animators, and the line about its error.
    fn file<'py>(
        &self,
        py: Python<'py>,
        format: &str,
        fps: &str,
        tolerance: f64,
    ) -> PyResult<(Bound<'py, PyBytes>, String)> {
        let format = named(format, "format of motion", &Format::ALL, Format::name)?;
        let rate = fps.parse().map_err(fail::value)?;
        let (bytes, says) = py.detach(|| {
            let stage = Staging::new(Frames::new(rate)).stage(&self.0).map_err(fail::saltus)?;
            let file = stage.file(format, tolerance).map_err(fail::saltus)?;
            let says = stage.says(&file);
            PyResult::Ok((file.bytes, says))
        })?;
        Ok((PyBytes::new(py, &bytes), says))
    }
}

fn sampling(every: Option<f64>, fps: Option<f64>) -> Option<Sampling> {
    every.map(Sampling::Every).or(fps.map(Sampling::Rate))
}
