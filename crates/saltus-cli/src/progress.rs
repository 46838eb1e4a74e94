//! A bar on standard error, once a second has passed.

use std::time::{Duration, Instant};

use indicatif::ProgressBar;

/// How much of a task is done.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
    whole: u64,
    quiet: bool,
}

impl Progress {
    pub(crate) fn new(whole: u64, quiet: bool) -> Self {
        Self { bar: None, start: Instant::now(), whole, quiet }
    }

    pub(crate) fn reached(&mut self, done: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        } else if !self.quiet && self.start.elapsed() > Duration::from_secs(1) {
            self.bar = Some(ProgressBar::new(self.whole).with_position(done));
        }
    }

    pub(crate) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
