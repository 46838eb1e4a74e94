//! The definition of a hybrid automaton: modes, flows, edges, guards, resets.

use std::borrow::Cow;
use std::fmt::Debug;
use std::ops::Range;

pub(crate) mod clocks;
pub(crate) mod edges;
pub(crate) mod refusal;
pub(crate) mod solution;

use self::clocks::{Clock, Clocks};
use self::edges::Edges;
use self::solution::{Fall, Solution};
use crate::error::Refusal;
use crate::state::State;

/// A hybrid automaton: in each mode a flow x' = f(t, x); out of each mode edges, each with a guard
/// and a reset.
///
/// A **guard** is a margin: positive inside the mode's domain. Its edge is taken where the guard
/// *falls* through zero. A **reset** is pure physics: it maps the state x⁻ just before the jump to
/// the state x⁺ just after it and never adds an epsilon to keep the edge from being taken twice;
/// the engine knows which edge it took and treats that root as spent.
///
/// Four methods are the model: [`flow`](Self::flow), [`edges`](Self::edges), [`guard`](Self::guard)
/// and [`reset`](Self::reset). The others have defaults that say nothing.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Automaton, Edges, Refusal, Simulation};
///
/// /// A ball that keeps 0.8 of its speed at each impact.
/// struct Ball;
///
/// impl Automaton for Ball {
///     type Mode = ();
///     type State = Vector2<f64>; // height in m, velocity in m/s
///     type Edge = ();
///
///     fn flow(&self, _: (), _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         vector![x[1], -9.81]
///     }
///     fn edges(&self, _: ()) -> Edges<'_, ()> {
///         Edges::from([()])
///     }
///     fn guard(&self, _: (), _t: f64, x: &Vector2<f64>) -> f64 {
///         x[0]
///     }
///     fn reset(&self, _: (), _: (), _t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
///         Ok(((), vector![0.0, -0.8 * x[1]]))
///     }
/// }
///
/// let run = Simulation::of(&Ball).run((), vector![1.0, 0.0], 0.0..1.0)?;
/// let first = &run.trajectory.jumps()[0];
/// assert!((first.t() - (2.0_f64 / 9.81).sqrt()).abs() < 1e-9);
/// # Ok::<(), saltus::Error>(())
/// ```
pub trait Automaton {
    /// Names a mode. May carry data frozen while the mode lasts: `Stance { foot: f64 }`.
    type Mode: Copy + PartialEq + Debug;
    /// The continuous state; its dimension may differ by mode if it is [`Coords`](crate::Coords).
    type State: State;
    /// Names an edge; carries what its guard and reset need: `Liftoff { foot: f64 }`.
    type Edge: Copy + PartialEq + Debug;

    /// The flow f of x' = f(t, x) in `mode`, in units of the state per second.
    fn flow(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Self::State;

    /// The edges out of `mode`, in the order in which crossings that time cannot tell apart are
    /// taken.
    fn edges(&self, mode: Self::Mode) -> Edges<'_, Self::Edge>;

    /// The guard of `edge`: positive inside the domain; the edge is taken where it falls through
    /// zero.
    fn guard(&self, edge: Self::Edge, t: f64, x: &Self::State) -> f64;

    /// The mode and state just after `edge` is taken out of `mode` from the state `x` just before.
    ///
    /// A function of these four alone. It is asked of nearby times and states as well, where the
    /// rounding of a coordinate decides and depends on whether the reset keeps the coordinate or
    /// gives it anew.
    ///
    /// # Errors
    /// A [`Refusal`] where there is no state after: the run fails with it, with time, mode, edge
    /// and state.
    fn reset(
        &self,
        mode: Self::Mode,
        edge: Self::Edge,
        t: f64,
        x: &Self::State,
    ) -> Result<(Self::Mode, Self::State), Refusal>;

    /// What holds of `edge` wherever it is met: see [`About`]. The default promises nothing.
    #[inline]
    fn about(&self, edge: Self::Edge) -> About {
        let _ = edge;
        About::default()
    }

    /// How the state goes on in `mode` from `x` at time `t`: see [`Solution`]. By default it is
    /// stepped.
    #[inline]
    fn solution(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Solution<Self> {
        let _ = (mode, t, x);
        Solution::Steps
    }

    /// When the guard of `edge` first falls through zero on the exact solution from `x` at `t` (see
    /// [`Solution::is_exact`]), where a formula says so. By default it is searched for.
    ///
    /// A wrong answer is believed: it breaks the guarantee that no crossing is missed. Where the
    /// guard is below zero when the arc ends, that is a
    /// [`Doubt::Missed`](crate::cross::Doubt::Missed).
    #[inline]
    fn falls(&self, mode: Self::Mode, edge: Self::Edge, t: f64, x: &Self::State) -> Fall<Self::State> {
        let _ = (mode, edge, t, x);
        Fall::Unknown
    }

    /// The mode and state in which a run goes on from a [`Limit`], where infinitely many jumps have
    /// accumulated. By default it ends there, with [`Stop::Zeno`](crate::Stop::Zeno).
    #[inline]
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Self::Mode, Self::State)> {
        let _ = limit;
        None
    }

    /// The clocks that run in `mode`, each with the edge that it takes: see [`Clocks`]. Such an
    /// edge needs no guard and is not listed in [`edges`](Self::edges). By default there are none.
    #[inline]
    fn clocks(&self, mode: Self::Mode) -> Clocks<'_, Self::Edge> {
        let _ = mode;
        Clocks::none()
    }

    /// The times at which the flow of `mode` is not smooth: a step ends there, and nothing else
    /// happens.
    ///
    /// A switch, a pulse or a kink of an input in time is then met exactly and never stepped over.
    /// Flow and guards are asked for strictly between two stops: whether they have their values of
    /// before or after a stop at the stop itself does not matter. A guard that is inside just
    /// before a stop and outside just after it has fallen there: its edge is taken, at the time of
    /// the stop. A mode with stops ahead is stepped, or expanded in series, even if it has an exact
    /// solution. By default there are none.
    #[inline]
    fn stops(&self, mode: Self::Mode) -> Cow<'_, [Clock]> {
        let _ = mode;
        Cow::Borrowed(&[])
    }

    /// Why the flow in `mode`, or the guard of `edge`, is not a number at (t, x): asked where the
    /// engine meets one that is not, so that the run fails with the reason. By default there is
    /// none.
    fn refusal(&self, mode: Self::Mode, edge: Option<Self::Edge>, t: f64, x: &Self::State) -> Option<Refusal> {
        let _ = (mode, edge, t, x);
        None
    }

    /// Whether a run can be in `mode` with the state `x` at time `t`: asked as a run starts, before
    /// anything else, and as a jump leads to another mode. By default it can.
    ///
    /// # Errors
    /// A sentence that says what is wrong and what to do.
    #[inline]
    fn validate(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Result<(), String> {
        let _ = (mode, t, x);
        Ok(())
    }
}

/// What holds of an edge wherever it is met.
///
/// ```
/// use saltus::{About, Entry};
/// let floor = About::new().affine().entry(Entry::Wait);
/// assert!(floor.affine && !floor.terminal);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct About {
    /// What to do when the guard is already negative as the mode is entered.
    pub entry: Entry,
    /// Whether the guard is g(t, x) = a·x + b with constants a and b.
    pub affine: bool,
    /// Whether the run ends where the edge is taken.
    pub terminal: bool,
    /// Whether the run ends there because the model does not determine how the state goes on.
    pub undetermined: bool,
    /// The coordinates that the guard reads, where it names them: from the first on, up to the
    /// second and without it.
    pub reads: Option<(usize, usize)>,
}

impl About {
    /// Nothing is promised: [`Entry::Refuse`], not affine, not terminal.
    #[must_use]
    #[inline]
    pub const fn new() -> Self {
        Self { entry: Entry::Refuse, affine: false, terminal: false, undetermined: false, reads: None }
    }

    /// With what to do when the guard is already negative as the mode is entered.
    #[must_use]
    #[inline]
    pub const fn entry(self, entry: Entry) -> Self {
        Self { entry, ..self }
    }

    /// Promises that the guard is g(t, x) = a·x + b with constants a and b: it does not read the
    /// time.
    ///
    /// The guard along a step is then a polynomial without error, and a crossing costs next to
    /// nothing to exclude. It holds of all states: so that the constant costs no digits, the guard
    /// is asked far outside those of the run. One that is cut off out there (`clamp`, `min`), or
    /// bends ever so little, is not affine. A promise that does not hold is an error
    /// ([`ErrorKind::Promise`](crate::ErrorKind::Promise)) where the ends of an arc show it, or
    /// states far outside, which are looked at on the first eight arcs and ever more seldom later;
    /// where they do not show it, crossings may be missed.
    #[must_use]
    #[inline]
    pub const fn affine(self) -> Self {
        self.affine_if(true)
    }

    /// The same promise where it holds of some edges only.
    #[must_use]
    #[inline]
    pub const fn affine_if(self, affine: bool) -> Self {
        Self { affine, ..self }
    }

    /// Promises that the guard reads the coordinates of this range and no others.
    ///
    /// How far its value may be off is then asked of these alone: of a state of n coordinates,
    /// which of them a crossing depends on takes as many evaluations of the guard as the range has
    /// places, in place of n. A promise that does not hold, or that names a coordinate that the
    /// state does not have, is an error ([`ErrorKind::Promise`](crate::ErrorKind::Promise)) where
    /// the ends of an arc show it: the edges of a mode are looked at in turn, one at each arc where
    /// promises are looked at.
    ///
    /// ```
    /// use saltus::{About, Edge, ErrorKind, Hybrid, Simulation, Vector};
    /// let net = |read| Hybrid::new()
    ///     .mode("run", |_t, x: &Vector| x.iter().map(|x| 1.5 - x).collect())
    ///     .edge_with("run", "run", Edge::new(|_t, x: &Vector| 1.0 - x[7], |_t, x| x.iter().map(|_| 0.0).collect())
    ///         .affine().reads(read));
    /// let start = || Vector::from_fn(100, |i| 0.01 * i as f64);
    /// assert!(Simulation::of(&net(7..8)).run("run", start(), 0.0..5.0)?.end.jumps > 3);
    /// for wrong in [3..5, 100..101] {
    ///     let error = Simulation::of(&net(wrong)).run("run", start(), 0.0..5.0).unwrap_err().error;
    ///     assert_eq!(error.kind(), ErrorKind::Promise);
    /// }
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    #[inline]
    #[allow(clippy::needless_pass_by_value)] // a range is no list
    pub const fn reads(self, coordinates: Range<usize>) -> Self {
        Self { reads: Some((coordinates.start, coordinates.end)), ..self }
    }

    /// Those of `n` coordinates that the guard may read.
    #[inline]
    pub(crate) fn read(&self, n: usize) -> Range<usize> {
        self.reads.map_or(0..n, |(first, end)| first..end.min(n))
    }

    /// The run ends where the edge is taken: its reset is applied, then the run stops.
    #[must_use]
    #[inline]
    pub const fn terminal(self) -> Self {
        self.terminal_if(true)
    }

    /// The run ends where it is taken, and not as it was asked to: the model does not determine how
    /// the state goes on. [`Stop::Undetermined`](crate::Stop::Undetermined) names it.
    #[must_use]
    #[inline]
    pub const fn undetermined(self) -> Self {
        Self { undetermined: true, ..self }
    }

    /// The same where some edges only end the run.
    #[must_use]
    #[inline]
    pub const fn terminal_if(self, terminal: bool) -> Self {
        Self { terminal, ..self }
    }
}

/// Where infinitely many jumps have accumulated: what [`Automaton::beyond`] is given.
#[non_exhaustive]
pub struct Limit<'a, A: Automaton + ?Sized> {
    /// The mode of the last jump: any mode of the cycle of jumps.
    pub mode: A::Mode,
    /// The edges of the cycle, in the order in which they were taken, the last one last; every
    /// edge that took part where they repeat in no order.
    ///
    /// Of several balls in one mode it says which have come to rest.
    pub edges: &'a [A::Edge],
    /// The time of the limit, in seconds.
    pub t: f64,
    /// The state there.
    pub x: &'a A::State,
}

impl<'a, A: Automaton + ?Sized> Limit<'a, A> {
    /// The limit at time `t` of jumps by a cycle of `edges`, in the state `x` of `mode`.
    #[must_use]
    pub const fn new(mode: A::Mode, edges: &'a [A::Edge], t: f64, x: &'a A::State) -> Self {
        Self { mode, edges, t, x }
    }
}

impl<A: Automaton + ?Sized> Debug for Limit<'_, A> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { mode, edges, t, x } = self;
        write!(f, "mode {mode:?} after jumps by {edges:?} at t = {t}, state {x:?}")
    }
}

/// What to do with an edge whose guard is already negative when its mode is entered.
///
/// ```
/// use saltus::{Entry, ErrorKind, Hybrid, Simulation};
/// let heater = |entry| Hybrid::new()
///     .mode("on", |_t, _x: &f64| 1.0)
///     .mode("off", |_t, _x| -1.0)
///     .edge("on", "off", |_t, x| 22.0 - x, |_t, x| *x)
///     .entry(entry);
/// // Switched on at 25 °C, which is too warm already.
/// let mode = |entry| Simulation::of(&heater(entry)).run("on", 25.0, 0.0..1.0).map(|run| run.end.mode);
/// assert_eq!(mode(Entry::Refuse).unwrap_err().error.kind(), ErrorKind::Entry);
/// assert_eq!(mode(Entry::Wait).unwrap(), "on");
/// assert_eq!(mode(Entry::Fire).unwrap(), "off");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Entry {
    /// Stop with an error that names the edge: the model did not foresee this state.
    #[default]
    Refuse,
    /// Go on; the edge is taken at the first fall after the guard has risen.
    Wait,
    /// Take the edge at once.
    Fire,
}
