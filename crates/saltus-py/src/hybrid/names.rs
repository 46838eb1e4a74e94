//! Modes and edges as numbers with names: what the engine copies, and shows in its words.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Names by their numbers, each once for as long as the program runs.
#[derive(Default)]
struct Names {
    numbers: BTreeMap<Arc<str>, u32>,
    names: Vec<Arc<str>>,
}

static NAMES: Mutex<Option<Names>> = Mutex::new(None);

fn with<R>(of: impl FnOnce(&mut Names) -> R) -> R {
    of(NAMES.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default())
}

/// A name that can be copied.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Name(u32);

impl Name {
    pub(crate) fn new(name: &str) -> Self {
        with(|kept| {
            if let Some(&number) = kept.numbers.get(name) {
                return Self(number);
            }
            let (name, number) = (Arc::<str>::from(name), kept.names.len() as u32);
            kept.names.push(Arc::clone(&name));
            kept.numbers.insert(name, number);
            Self(number)
        })
    }

    pub(crate) fn text(self) -> Arc<str> {
        with(|kept| kept.names.get(self.0 as usize).cloned()).unwrap_or_default()
    }
}

/// A mode by its place among those of the model.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Mode {
    pub(crate) place: u32,
    pub(crate) name: Name,
}

impl fmt::Debug for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.name.text())
    }
}

/// An edge by its place among those out of its mode.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Edge {
    pub(crate) from: Mode,
    pub(crate) to: Mode,
    pub(crate) place: u32,
}

impl fmt::Debug for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from, to) = (self.from.name.text(), self.to.name.text());
        write!(f, "{from} -> {to} (edge {})", self.place)
    }
}
