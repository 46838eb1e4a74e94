//! Signals, such as Ctrl-C: Python hears of them where it is asked.

use std::ops::ControlFlow;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use crate::fail;

/// How often Python is asked: sooner than one who waits notices.
const PATIENCE: Duration = Duration::from_millis(20);

/// Asks Python for a signal, now and then.
pub(crate) struct Signals {
    until: Instant,
}

impl Signals {
    pub(crate) fn new() -> Self {
        Self { until: Instant::now() + PATIENCE }
    }

    /// What the handler of a signal raised, if there was one.
    pub(crate) fn ask(&mut self) -> ControlFlow<PyErr> {
        if Instant::now() < self.until {
            return ControlFlow::Continue(());
        }
        self.until = Instant::now() + PATIENCE;
        match Python::attach(|py| py.check_signals()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(signal) => ControlFlow::Break(signal),
        }
    }
}

/// As much room for calls as the first thread of a program has as a rule, in bytes.
const STACK: usize = 8 << 20;

/// Does a piece of work that asks nobody, and meanwhile asks Python: where a signal came, the
/// caller goes on at once, and the work ends by itself.
pub(crate) fn patiently<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    let (done, came) = mpsc::channel();
    let thread = thread::Builder::new().stack_size(STACK).spawn(move || {
        // Who is gone asks for nothing.
        let _ = done.send(work());
    });
    thread.map_err(fail::saltus)?;
    py.detach(move || {
        loop {
            match came.recv_timeout(PATIENCE) {
                Ok(value) => return Ok(value),
                Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(fail::saltus("this came to no end: it is a fault of saltus"));
                }
            }
        }
    })
}
