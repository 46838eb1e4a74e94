//! Failures as Python exceptions, with the words of the library.

use std::fmt;

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyValueError};
use pyo3::prelude::*;

create_exception!(saltus, SaltusError, PyException, "What saltus cannot do, and why.");
create_exception!(saltus, TableError, SaltusError, "A table that cannot be read: where, why, and what to do.");
create_exception!(saltus, SceneError, SaltusError, "A scene that cannot be run: where, why, and what to do.");
create_exception!(saltus, RunError, SaltusError, "A run that failed: when, in which mode and state, and why.");

/// A value that an argument cannot have.
pub(crate) fn value(error: impl fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A scene that cannot be run.
pub(crate) fn scene(error: impl fmt::Display) -> PyErr {
    SceneError::new_err(error.to_string())
}

/// A run that failed.
pub(crate) fn run(error: impl fmt::Display) -> PyErr {
    RunError::new_err(error.to_string())
}

/// One of a list of things that have names.
pub(crate) fn named<T: Copy>(wanted: &str, what: &str, all: &[T], name: impl Fn(T) -> &'static str) -> PyResult<T> {
    all.iter().copied().find(|one| name(*one) == wanted).ok_or_else(|| {
        let known: Vec<_> = all.iter().map(|one| name(*one)).collect();
        value(format!("'{wanted}' is no {what}: use one of {}", known.join(", ")))
    })
}

/// What saltus cannot do, in its own words.
pub(crate) fn saltus(error: impl fmt::Display) -> PyErr {
    SaltusError::new_err(error.to_string())
}

/// A table that cannot be read, with its kind, place and advice as a dict in `.data`.
pub(crate) fn table(py: Python<'_>, error: &saltus_fit::TableError) -> PyErr {
    let failed = TableError::new_err(error.to_string());
    let data = serde_json::to_string(error).map_err(value);
    let data = data.and_then(|data| py.import("json")?.call_method1("loads", (data,)));
    match data.and_then(|data| failed.value(py).setattr("data", data)) {
        Ok(()) => failed,
        Err(other) => other,
    }
}
