//! A Python function that could not be traced: called where its value is wanted.

use std::sync::{Mutex, PoisonError};

use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The first exception of a called function, until the run that called it takes it.
#[derive(Default)]
pub(crate) struct Raised(Mutex<Option<PyErr>>);

impl Raised {
    pub(crate) fn put(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }

    pub(crate) fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// The message of the exception, if there is one.
    pub(crate) fn says(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(ToString::to_string)
    }
}

/// A function of (t, x), and of the parameters where there are any, which gives so many numbers.
pub(crate) struct Called {
    function: Py<PyAny>,
    what: String,
    outputs: usize,
}

impl Called {
    pub(crate) fn new(function: Py<PyAny>, what: String, outputs: usize) -> Self {
        Self { function, what, outputs }
    }

    pub(crate) fn clone_ref(&self, py: Python<'_>) -> Self {
        Self { function: self.function.clone_ref(py), what: self.what.clone(), outputs: self.outputs }
    }

    /// Hands over its values; no numbers, and the error kept, where it raises one.
    pub(crate) fn run(
        &self,
        t: f64,
        x: &[f64],
        p: Option<&Py<PyAny>>,
        raised: &Raised,
        mut out: impl FnMut(usize, f64),
    ) {
        let values = if raised.says().is_some() { None } else { self.values(t, x, p, raised) };
        match values {
            Some(values) => values.into_iter().enumerate().for_each(|(i, value)| out(i, value)),
            None => (0..self.outputs).for_each(|i| out(i, f64::NAN)),
        }
    }

    fn values(&self, t: f64, x: &[f64], p: Option<&Py<PyAny>>, raised: &Raised) -> Option<Vec<f64>> {
        Python::attach(|py| {
            let x = PyArray1::from_slice(py, x);
            let result = match p {
                Some(p) => self.function.bind(py).call1((t, x, p)),
                None => self.function.bind(py).call1((t, x)),
            };
            result.and_then(|result| self.read(&result)).map_err(|error| raised.put(error)).ok()
        })
    }

    fn read(&self, result: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        let values = if let Ok(array) = result.cast::<PyArray1<f64>>() {
            array.to_vec()?
        } else if self.outputs == 1 && !result.hasattr("__len__")? {
            vec![result.extract()?]
        } else {
            result.extract()?
        };
        if values.len() == self.outputs {
            return Ok(values);
        }
        let (what, given, wanted) = (&self.what, values.len(), self.outputs);
        Err(PyValueError::new_err(format!("{what} gives {given} numbers and not {wanted}")))
    }
}
