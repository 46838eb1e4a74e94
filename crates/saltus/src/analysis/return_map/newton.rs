//! Newton's method for equations that a run evaluates, down to the rounding of the run.

use std::fmt;

use nalgebra::{DMatrix, DVector};

use crate::error::Error;

/// Why a return map could not be evaluated, or a fixed point not be found. Written with `{}` or
/// `{:?}`, it is a sentence that says what to do.
///
/// ```
/// use saltus::return_map::MapError;
/// let error = MapError::Singular { q: vec![0.5] };
/// assert!(error.to_string().contains("a multiplier is 1"));
/// ```
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum MapError {
    /// A run failed.
    Run(Error),
    /// A run ended before it was back at the section.
    NoReturn {
        /// How it ended, in words.
        why: String,
        /// When, in seconds.
        t: f64,
        /// From where on the section it started.
        q: Vec<f64>,
    },
    /// The equations have no unique solution near here: a multiplier is one.
    Singular {
        /// Where on the section, and after it the parameter if one is varied.
        q: Vec<f64>,
    },
    /// Newton's method came to a stand before P(q) = q held.
    NoConvergence {
        /// Where on the section, and after it the parameter if one is varied.
        q: Vec<f64>,
        /// P(q) - q there.
        residual: Vec<f64>,
    },
    /// What was asked for cannot be.
    Question(String),
}

impl MapError {
    /// With the place from which the run started.
    pub(super) fn starting(self, from: &[f64]) -> Self {
        match self {
            Self::NoReturn { why, t, .. } => Self::NoReturn { why, t, q: from.to_vec() },
            other => other,
        }
    }
}

impl From<Error> for MapError {
    fn from(error: Error) -> Self {
        Self::Run(error)
    }
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Run(error) => error.fmt(f),
            Self::NoReturn { why, t, q } => write!(
                f,
                "a run from {q:?} on the section did not return to it: choose an edge that each period takes, or start closer to the periodic run (at t = {t}, {why})"
            ),
            Self::Singular { q } => write!(
                f,
                "near {q:?} a multiplier is 1, so that P(q) = q has no unique solution: at a fold start elsewhere; if something is conserved, take it out of the section's coordinates"
            ),
            Self::NoConvergence { q, residual } => write!(
                f,
                "Newton's method stands at {q:?}, where P(q) - q = {residual:?}: start closer to the fixed point, or tighten the simulation's tolerance"
            ),
            Self::Question(what) => f.write_str(what),
        }
    }
}

/// The sentence, which is what a `main` shows that returns the error.
impl fmt::Debug for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl std::error::Error for MapError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Run(error) => Some(error),
            _ => None,
        }
    }
}

/// An equation at a place: what should be zero, by how much it may be off, its derivative, and what
/// else was found there.
pub(super) struct Equation<T> {
    pub(super) residual: DVector<f64>,
    pub(super) allowed: DVector<f64>,
    pub(super) jacobian: DMatrix<f64>,
    pub(super) found: T,
}

impl<T> Equation<T> {
    /// The largest residual in units of what is allowed.
    fn size(&self) -> f64 {
        let sizes = self.residual.iter().zip(&self.allowed).map(|(residual, allowed)| residual.abs() / allowed);
        sizes.fold(0.0, |most, size| if size > most || size.is_nan() { size } else { most })
    }
}

/// A root, what was found at it, and after how many Newton steps.
pub(super) struct Root<T> {
    pub(super) at: DVector<f64>,
    pub(super) found: T,
    pub(super) steps: u32,
}

/// Solves an equation from `at` by Newton's method, damped where a full step does not help, until
/// rounding stops it.
///
/// It has converged if the residual is then within a thousand times of what one run may err.
/// Source: P. Deuflhard, *Newton Methods for Nonlinear Problems*, Springer 2004, section 3.2 (the
/// damping is by halving).
pub(super) fn newton<T>(
    at: DVector<f64>,
    mut equation: impl FnMut(&DVector<f64>) -> Result<Equation<T>, MapError>,
) -> Result<Root<T>, MapError> {
    const MOST_STEPS: u32 = 60;
    const FURTHEST: f64 = 1e3;
    let mut at = at;
    let mut here = equation(&at)?;
    let mut steps = 0;
    while here.size() > 0.0 && steps < MOST_STEPS {
        steps += 1;
        let singular = || MapError::Singular { q: at.as_slice().to_vec() };
        let step = here.jacobian.clone().lu().solve(&here.residual).ok_or_else(singular)?;
        if step.iter().any(|s| !s.is_finite()) {
            return Err(singular());
        }
        // Near the root one try is enough: what does not improve there is rounding.
        let close = here.size() < FURTHEST;
        let tries = if close { 1 } else { 12 };
        let better = (0..tries).find_map(|halvings| {
            let next = &at - &step * 0.5_f64.powi(halvings);
            let there = equation(&next).ok()?;
            (there.size() < here.size()).then_some((next, there))
        });
        let Some((next, there)) = better else { break };
        let stands = close && there.size() > 0.5 * here.size();
        (at, here) = (next, there);
        if stands {
            break;
        }
    }
    if here.size() < FURTHEST {
        return Ok(Root { at, found: here.found, steps });
    }
    Err(MapError::NoConvergence { q: at.as_slice().to_vec(), residual: here.residual.as_slice().to_vec() })
}
