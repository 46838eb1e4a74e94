//! An edge of an automaton of closures, and what holds of it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::{Flow, Refuses};
use crate::automaton::{About, Entry};
use crate::error::Refusal;
use crate::state::State;

type Guard<'a, S> = Box<dyn Fn(f64, &S) -> f64 + Send + Sync + 'a>;
type Jump<'a, S> = Box<dyn Fn(f64, &S) -> Result<S, Refusal> + Send + Sync + 'a>;

/// An edge of a [`Hybrid`](super::Hybrid): a guard, a reset, and what holds of them.
///
/// ```
/// use saltus::{Edge, Entry, Hybrid, Simulation};
/// // Two edges alike, one of which waits: only the other one refuses to be entered beyond its mark.
/// let tank = Hybrid::new()
///     .mode("fill", |_t, _x: &f64| 1.0)
///     .edge_with("fill", "fill", Edge::new(|_t, x: &f64| 1.0 - x, |_t, x| *x).affine().entry(Entry::Wait))
///     .edge_with("fill", "fill", Edge::new(|_t, x: &f64| 2.0 - x, |_t, _x| 0.0).affine());
/// let run = Simulation::of(&tank).run("fill", 1.5, 0.0..3.0)?;
/// let places: Vec<_> = run.trajectory.jumps().iter().filter_map(|jump| Some(jump.edge()?.place)).collect();
/// assert_eq!(places, [1, 0, 1]);
/// # Ok::<(), saltus::Error>(())
/// ```
pub struct Edge<'a, S> {
    /// None of an edge that a clock takes.
    pub(super) guard: Option<Guard<'a, S>>,
    pub(super) reset: Jump<'a, S>,
    pub(super) about: About,
    pub(super) inverse: Option<(Guard<'a, S>, Flow<'a, S>)>,
    /// Why the guard is not a number, where it may fail.
    pub(super) refusal: Option<Refuses<'a, S>>,
}

impl<'a, S: State> Edge<'a, S> {
    /// With a guard g(t, x), positive inside the mode it leaves, and a reset x⁺ = r(t, x⁻).
    #[must_use]
    pub fn new(
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        Self::of(Some(Box::new(guard)), Box::new(move |t, x| Ok(reset(t, x))))
    }

    /// With a guard and a reset that may fail: the run then fails with the [`Refusal`], with time,
    /// mode, edge and state. A guard is asked again for its reason.
    ///
    /// ```
    /// use saltus::{Edge, ErrorKind, Hybrid, Refusal, Simulation};
    /// let full = Edge::fallible(|_t, x: &f64| Ok(1.0 - x), |t, _x| {
    ///     if t < 2.5 { Ok(0.0) } else { Err(Refusal::new("the valve is stuck")) }
    /// });
    /// let tank = Hybrid::new().mode("fill", |_t, _x: &f64| 1.0).edge_with("fill", "fill", full);
    /// let error = Simulation::of(&tank).run("fill", 0.0, 0.0..9.0).unwrap_err().error;
    /// assert_eq!((error.kind(), error.t()), (ErrorKind::Refused, 3.0));
    /// ```
    #[must_use]
    pub fn fallible(
        guard: impl Fn(f64, &S) -> Result<f64, Refusal> + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> Result<S, Refusal> + Send + Sync + 'a,
    ) -> Self {
        let guard = Arc::new(guard);
        let refusal = Arc::clone(&guard);
        let edge = Self::of(Some(Box::new(move |t, x| guard(t, x).unwrap_or(f64::NAN))), Box::new(reset));
        Self { refusal: Some(Box::new(move |t, x| refusal(t, x).err())), ..edge }
    }

    /// Taken by a clock.
    pub(super) fn clocked(reset: impl Fn(f64, &S) -> Result<S, Refusal> + Send + Sync + 'a) -> Self {
        Self::of(None, Box::new(reset))
    }

    fn of(guard: Option<Guard<'a, S>>, reset: Jump<'a, S>) -> Self {
        Self { guard, reset, about: About::new(), inverse: None, refusal: None }
    }

    /// With what to do if the guard is already negative as its mode is entered; see [`Entry`].
    #[must_use]
    pub fn entry(mut self, entry: Entry) -> Self {
        self.about = self.about.entry(entry);
        self
    }

    /// Promises that the guard is a·x + b with constants a and b, and does not read the time; see
    /// [`About::affine`].
    #[must_use]
    pub fn affine(mut self) -> Self {
        self.about = self.about.affine();
        self
    }

    /// Promises that the guard reads the coordinates of this range and no others; see
    /// [`About::reads`].
    #[must_use]
    pub fn reads(mut self, coordinates: Range<usize>) -> Self {
        self.about = self.about.reads(coordinates);
        self
    }

    /// The run ends where it is taken, after its reset.
    #[must_use]
    pub fn terminal(mut self) -> Self {
        self.about = self.about.terminal();
        self
    }

    /// With its inverse, so that a run can go [backwards](crate::Reversed) through it: the `image`
    /// margin, positive in the mode it leads to and zero just after the jump, and x⁻ from x⁺. See
    /// [`Invertible`](crate::Invertible).
    ///
    /// A run backwards is refused where it could meet an edge without an inverse. An edge that is
    /// never met backwards may be given the margin 1.
    ///
    /// ```
    /// use saltus::nalgebra::{self, Vector2, vector};
    /// use saltus::{Edge, Hybrid, Reversed, Simulation};
    ///
    /// let floor = Edge::new(|_t, x: &Vector2<f64>| x[0], |_t, x| vector![0.0, -0.7 * x[1]])
    ///     .inverse(|_t, x| x[0], |_t, x| vector![0.0, -x[1] / 0.7]);
    /// let ball = Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81]).edge_with("flight", "flight", floor);
    /// let there = Simulation::of(&ball).run("flight", vector![1.0, 0.0], 0.0..1.5)?;
    /// let back = Simulation::of(&Reversed::of(&ball)).run("flight", there.end.state, Reversed::span(1.5, 0.0))?;
    /// assert!((back.end.state - vector![1.0, 0.0]).norm() < 1e-9);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn inverse(
        mut self,
        image: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        undo: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.inverse = Some((Box::new(image), Box::new(undo)));
        self
    }
}

impl<S> fmt::Debug for Edge<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (inverse, clocked) = (self.inverse.is_some(), self.guard.is_none());
        f.debug_struct("Edge")
            .field("about", &self.about)
            .field("clocked", &clocked)
            .field("inverse", &inverse)
            .finish()
    }
}
