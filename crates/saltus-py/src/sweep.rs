//! Sweeps of a scene: which runs there are, and rows of them by columns.

use std::ops::ControlFlow;

use numpy::IntoPyArray;
use pyo3::prelude::*;
use saltus_scene::Run;
use saltus_scene::sweep::{Cells, Column, Identity, RowFormat, Sweep};
use saltus_scene::vary::{Variation, Vary};

use crate::fail::{self, named};
use crate::signal::Signals;

/// The values of a key as Python gives them.
#[derive(FromPyObject)]
pub(crate) enum Given {
    /// As the tool has them: `0.5:0.9:41`.
    Text(String),
    Words(Vec<String>),
    Numbers(Vec<f64>),
}

/// What a sweep is asked for beside its values.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked {
    rows: bool,
    random: Option<u64>,
    seed: u64,
    until_s: Option<f64>,
    most_jumps: Option<u32>,
    asked: Option<Vec<String>>,
}

/// What varies, and how.
fn vary(values: Vec<(String, Given)>, asked: &Asked) -> PyResult<Vary> {
    let variation = |(key, given): (String, Given)| match given {
        Given::Text(text) => format!("{key}={text}").parse(),
        Given::Words(words) => Variation::words(&key, &words),
        Given::Numbers(numbers) => Variation::numbers(&key, numbers),
    };
    let variations = values.into_iter().map(variation).collect::<Result<_, _>>().map_err(fail::value)?;
    Ok(Vary { variations, random: asked.random, seed: asked.seed, rows: asked.rows })
}

/// The sweep that is asked for.
fn planned<'a>(name: &str, toml: &'a [u8], vary: &'a Vary, asked: &Asked) -> PyResult<Sweep<'a>> {
    let mut run = Run::default();
    (run.until, run.most_jumps) = (asked.until_s, asked.most_jumps);
    let column = |wanted: &String| named(wanted, "column of a sweep", &Column::ALL, Column::name);
    let columns = asked.asked.as_ref().map(|names| names.iter().map(column).collect::<PyResult<Vec<_>>>());
    Sweep::new(name, toml, vary, run, RowFormat::Csv, columns.transpose()?.as_deref()).map_err(fail::scene)
}

/// All that the rows depend on, as JSON with a hash of itself.
#[pyfunction]
pub(crate) fn sweep_identity(
    py: Python<'_>,
    name: &str,
    toml: &[u8],
    values: Vec<(String, Given)>,
    asked: Asked,
) -> PyResult<String> {
    let vary = vary(values, &asked)?;
    let sweep = planned(name, toml, &vary, &asked)?;
    py.detach(|| Identity::of(&sweep)).map(|identity| identity.said().to_owned()).map_err(fail::scene)
}

/// How many rows are a part, as long as rows take here.
#[pyfunction]
pub(crate) fn sweep_pace(
    py: Python<'_>,
    name: &str,
    toml: &[u8],
    values: Vec<(String, Given)>,
    asked: Asked,
) -> PyResult<u64> {
    let vary = vary(values, &asked)?;
    let sweep = planned(name, toml, &vary, &asked)?;
    Ok(py.detach(|| saltus_scene::sweep::pace(&sweep)))
}

/// What first tells the sweep that is `found` from the one here, in words; both as JSON.
#[pyfunction]
pub(crate) fn sweep_difference(here: &str, found: &str) -> Option<String> {
    saltus_scene::sweep::difference(here, found)
}

/// The first run of each part, and that after its last.
#[pyfunction]
pub(crate) fn sweep_parts(runs: u64, chunk: u64) -> Vec<(u64, u64)> {
    saltus_scene::sweep::parts(runs, chunk).map(|part| (part.start, part.end)).collect()
}

/// The name of the part that begins with a run.
#[pyfunction]
pub(crate) fn sweep_part(start: u64, runs: u64) -> String {
    saltus_scene::sweep::part(start, runs)
}

/// Rows of some runs, by columns with their names; on all cores, or on this one.
#[pyfunction]
pub(crate) fn sweep_rows<'py>(
    py: Python<'py>,
    name: &str,
    toml: &[u8],
    values: Vec<(String, Given)>,
    asked: Asked,
    runs: (usize, usize),
    cores: bool,
) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let ((from, to), vary) = (runs, vary(values, &asked)?);
    let sweep = planned(name, toml, &vary, &asked)?;
    if to as u64 > sweep.runs() {
        return Err(fail::value(format!("there are {} runs, and none with the number {}", sweep.runs(), to - 1)));
    }
    let (mut columns, mut signals) = (sweep.columns(), Signals::new());
    let mut push = |cells: Vec<_>| {
        columns.iter_mut().zip(cells).for_each(|(column, cell)| column.push(cell));
        signals.ask()
    };
    let ended = py.detach(|| {
        if cores {
            saltus::ensemble(from..to, |run| sweep.cells(run as u64), |_, cells| push(cells))
        } else {
            (from..to).try_for_each(|run| push(sweep.cells(run as u64)))
        }
    });
    if let ControlFlow::Break(signal) = ended {
        return Err(signal);
    }
    let column = |cells: Cells| -> PyResult<Bound<'py, PyAny>> {
        Ok(match cells {
            Cells::Numbers(values) => {
                let values = values.into_iter().map(|value| value.unwrap_or(f64::NAN));
                values.collect::<Vec<_>>().into_pyarray(py).into_any()
            }
            Cells::Counts(values) => {
                let count = |value: Option<u64>| value.and_then(|value| i64::try_from(value).ok()).unwrap_or(-1);
                values.into_iter().map(count).collect::<Vec<_>>().into_pyarray(py).into_any()
            }
            Cells::Words(values) => values.into_pyobject(py)?.into_any(),
        })
    };
    let named = sweep.headers().iter().cloned().zip(columns);
    named.map(|(name, cells)| Ok((name, column(cells)?))).collect()
}
