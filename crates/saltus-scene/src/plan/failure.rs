//! Why a scene cannot be planned, and why a run of it failed.

use std::fmt;

use crate::SceneError;
use crate::source::Source;

/// An error of planning: why a scene cannot be run, the place in the scene, and what to do.
///
/// ```
/// use saltus_scene::Scene;
/// let toml = b"collisions = { restitution = 0.9 }\ncontact = { law = 'hertz', stiffness = 1e8 }\nrun = { until = 1 }\n\
///     ball = [{ height = 1, radius = 0.1, mass = 1 }, { height = 2, radius = 0.1, mass = 1 }]\n";
/// let error = Scene::parse("two.toml", toml)?.plan().unwrap_err();
/// assert!(error.to_string().starts_with("two.toml:2:1: contact that takes time is simulated for one ball"));
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanError {
    place: String,
    number: Option<usize>,
    says: String,
    /// The error in the text that the scene was read from.
    found: Option<Box<SceneError>>,
}

impl PlanError {
    pub(super) fn new(place: &str, says: &str) -> Self {
        Self { place: place.to_owned(), number: None, says: says.to_owned(), found: None }
    }

    pub(super) fn floor(owner: usize, says: &str) -> Self {
        Self { number: Some(owner), ..Self::new(&format!("[[floor]] number {}", owner + 1), says) }
    }

    /// The error with its line, where it has one.
    pub(super) fn found(mut self, source: &Source) -> Self {
        let key = self.place.trim_start_matches('[').split(']').next().unwrap_or_default();
        self.found = source.fault(key, self.number, &self.says).map(Box::new);
        self
    }

    /// The message with line and column, where the scene was read from a text that names the place.
    #[must_use]
    pub fn in_text(&self) -> Option<&SceneError> {
        self.found.as_deref()
    }

    /// The key or table that asks for it.
    #[must_use]
    pub fn place(&self) -> &str {
        &self.place
    }
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.found {
            Some(found) => found.fmt(f),
            None => write!(f, "{}: {}", self.place, self.says),
        }
    }
}

impl std::error::Error for PlanError {}

/// An error of a run: the reason why it failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunError(String);

impl RunError {
    pub(crate) const fn new(says: String) -> Self {
        Self(says)
    }

    pub(super) fn ended() -> Self {
        Self("the run was ended before it was done".to_owned())
    }
}

/// Messages of the engine, which are for who writes a model, in words for who writes a scene.
impl From<saltus::Error> for RunError {
    fn from(error: saltus::Error) -> Self {
        use saltus::ErrorKind::{Entry, Flow, Guard, InitialState, Promise, Reset, Series, StepSize};
        let what = match error.kind() {
            Flow | Guard | InitialState | Promise | Reset | Series => {
                "a number has grown beyond all that can be computed with"
            }
            StepSize => "it changes faster than moments can be told apart",
            Entry => "a ball is in what it touches, by more than rounding",
            _ => return Self(error.to_string()),
        };
        let (t, mode) = (error.t(), error.mode());
        Self(crate::error::legible(&format!(
            "the run breaks off at {t} s, in mode {mode}: {what}; numbers of the scene are too far apart: bring masses, sizes, speeds, drags and stiffnesses nearer to each other"
        )))
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for RunError {}
