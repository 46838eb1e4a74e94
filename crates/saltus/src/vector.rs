//! States of any length, whose memory is used again.

use std::cell::RefCell;
use std::fmt;
use std::ops::{Deref, DerefMut};

use crate::state::State;

/// So many buffers are kept by each thread for the next states: more than any method holds at once
/// from step to step. A tenth of it, and `allocations::a_step_of_any_length_allocates_nothing`
/// fails; ten times, and `allocations::what_is_dropped_is_given_back` does.
const KEPT: usize = 128;

thread_local! {
    static FREE: RefCell<Vec<Vec<f64>>> = const { RefCell::new(Vec::new()) };
}

/// A continuous state of a length that is chosen as the program runs: x ∈ ℝⁿ for any n.
///
/// Read and written as a slice of its coordinates; `n` may differ from mode to mode. For n up to a
/// few dozen that the program knows as it is compiled, an array `[f64; N]` is faster: it is kept in
/// registers or on the stack.
///
/// A step, a jump and a search for a crossing allocate nothing once a few of each have been made: a
/// vector that is dropped leaves its memory to the next one of its thread. Recorded trajectories
/// keep theirs.
///
/// ```
/// use saltus::{Hybrid, Simulation, Vector};
/// // A hundred tanks that drain at rates of their own; the first is refilled at a tenth.
/// let n = 100;
/// let tanks = Hybrid::new()
///     .mode("drain", |_t, x: &Vector| Vector::from_fn(x.len(), |i| -x[i] / (1.0 + i as f64)))
///     .edge("drain", "drain", |_t, x| x[0] - 0.1, |_t, x| {
///         let mut after = x.clone();
///         after[0] = 1.0;
///         after
///     })
///     .affine();
/// let run = Simulation::of(&tanks).run("drain", vec![1.0; n].into(), 0.0..5.0)?;
/// assert_eq!(run.end.jumps, 2);
/// let first = &run.trajectory.jumps()[0];
/// assert!((first.t() - 10.0_f64.ln()).abs() < 1e-8);
/// assert!((run.end.state[99] - (-5.0_f64 / 100.0).exp()).abs() < 1e-8);
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// Linear algebra on it takes views, which copy nothing: `DVectorView::from_slice(&x, x.len())` of
/// `nalgebra`.
///
/// # Limits
/// Every stepper, exact solutions and Taylor series by a [`Formula`](crate::Formula) take it;
/// derivatives of runs (`Linearize`) want a number of coordinates that is fixed as the program is
/// compiled. [`Rodas5P`](crate::Rodas5P) solves dense systems, of n² numbers and n³ operations a
/// step, unless the pattern of the Jacobian is given: [`Sparsity`](crate::Sparsity).
///
/// A coordinate beyond the length is [`f64::NAN`] for [`State::get`], so that a flow of another
/// length than its state fails with an error; by index, `x[i]`, it panics as a slice does.
pub struct Vector {
    values: Vec<f64>,
}

impl Vector {
    /// The vector of `n` coordinates of which coordinate `i` is `f(i)`.
    #[must_use]
    #[inline]
    pub fn from_fn(n: usize, f: impl FnMut(usize) -> f64) -> Self {
        let mut of = Self::empty();
        of.values.extend((0..n).map(f));
        of
    }

    /// Without a coordinate, in memory that was used before if there is some.
    #[inline]
    fn empty() -> Self {
        // As a thread ends there is none.
        let values = FREE.try_with(|free| free.borrow_mut().pop()).ok().flatten();
        Self { values: values.unwrap_or_default() }
    }
}

impl Drop for Vector {
    #[inline]
    fn drop(&mut self) {
        let mut values = std::mem::take(&mut self.values);
        if values.capacity() == 0 {
            return;
        }
        values.clear();
        // As a thread ends the memory goes back to the system.
        let _ = FREE.try_with(|free| {
            let mut free = free.borrow_mut();
            if free.len() < KEPT {
                free.push(values);
            }
        });
    }
}

impl Clone for Vector {
    #[inline]
    fn clone(&self) -> Self {
        let mut of = Self::empty();
        of.values.extend_from_slice(&self.values);
        of
    }
}

impl fmt::Debug for Vector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.values.fmt(f)
    }
}

impl PartialEq for Vector {
    fn eq(&self, other: &Self) -> bool {
        self.values == other.values
    }
}

/// The coordinates as a slice.
impl Deref for Vector {
    type Target = [f64];
    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values
    }
}

impl DerefMut for Vector {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }
}

impl From<Vec<f64>> for Vector {
    fn from(values: Vec<f64>) -> Self {
        Self { values }
    }
}

impl From<&[f64]> for Vector {
    fn from(values: &[f64]) -> Self {
        values.iter().copied().collect()
    }
}

impl<const N: usize> From<[f64; N]> for Vector {
    fn from(values: [f64; N]) -> Self {
        values.into_iter().collect()
    }
}

impl FromIterator<f64> for Vector {
    #[inline]
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut of = Self::empty();
        of.values.extend(values);
        of
    }
}

/// Written as the list of its coordinates.
#[cfg(feature = "serde")]
impl serde::Serialize for Vector {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.values.serialize(serializer)
    }
}

/// Read from a list of numbers.
#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for Vector {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::from)
    }
}

impl State for Vector {
    #[inline]
    fn len(&self) -> usize {
        self.values.len()
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        self.values.get(i).copied().unwrap_or(f64::NAN)
    }
    #[inline]
    fn with(&self, f: impl FnMut(usize) -> f64) -> Self {
        Self::from_fn(self.values.len(), f)
    }
    fn heap(&self) -> usize {
        self.values.capacity() * size_of::<f64>()
    }
}
