//! Signals, such as Ctrl-C: Python hears of them where it is asked.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

use crate::fail;

/// How often Python is asked: sooner than one who waits notices.
const PATIENCE: Duration = Duration::from_millis(20);

/// How many looks pass for one at the clock, which takes as long as a step.
const LOOKS: u32 = 32;

/// Asks Python for a signal, now and then.
pub(crate) struct Signals {
    until: Instant,
    looks: u32,
}

impl Signals {
    pub(crate) fn new() -> Self {
        Self { until: Instant::now() + PATIENCE, looks: 0 }
    }

    /// The same as [`Self::ask`], for what comes by often: steps and jumps.
    #[inline]
    pub(crate) fn look(&mut self) -> ControlFlow<PyErr> {
        self.looks = self.looks.wrapping_add(1);
        if self.looks.is_multiple_of(LOOKS) { self.ask() } else { ControlFlow::Continue(()) }
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

/// Whether who waits for a piece of work is still there.
pub(crate) struct Wanted(Arc<AtomicBool>);

impl Wanted {
    pub(crate) fn ask(&self) -> ControlFlow<()> {
        if self.0.load(Ordering::Relaxed) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

/// Does a piece of work on another thread, and checks Python's signals meanwhile: after one the
/// caller goes on at once, and the work ends at its next check.
pub(crate) fn patiently<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Wanted) -> T + Send + 'static,
) -> PyResult<T> {
    let (done, came) = mpsc::channel();
    let waits = Arc::new(AtomicBool::new(true));
    let wanted = Wanted(Arc::clone(&waits));
    let thread = thread::Builder::new().stack_size(STACK).spawn(move || {
        // Who is gone asks for nothing.
        let _ = done.send(work(&wanted));
    });
    thread.map_err(fail::saltus)?;
    py.detach(move || {
        loop {
            match came.recv_timeout(PATIENCE) {
                Ok(value) => return Ok(value),
                Err(RecvTimeoutError::Timeout) => {
                    Python::attach(|py| py.check_signals()).inspect_err(|_| waits.store(false, Ordering::Relaxed))?;
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(fail::saltus("this came to no end: it is a fault of saltus"));
                }
            }
        }
    })
}
