//! The definition of a hybrid automaton: modes, flows, edges, guards, resets.

use std::fmt::Debug;

use crate::error::ErrorKind;
use crate::series::Series;
use crate::state::State;

/// A hybrid automaton: in each mode a flow x' = f(t, x); out of each mode edges, each with a guard and a reset.
///
/// A **guard** is a margin: positive inside the mode's domain. Its edge is taken where the guard *falls* through zero.
/// A **reset** is pure physics: it maps the state x⁻ just before the jump to the state x⁺ just after it and
/// never adds an epsilon to keep the edge from being taken twice; the engine knows which edge it took and treats that root as spent.
///
/// ```
/// use saltus::nalgebra::{Vector2, vector};
/// use saltus::{Automaton, Edges, Simulation};
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
///     fn edges(&self, _: ()) -> Edges<()> {
///         Edges::from([()])
///     }
///     fn guard(&self, _: (), _t: f64, x: &Vector2<f64>) -> f64 {
///         x[0]
///     }
///     fn reset(&self, _: (), _t: f64, x: &Vector2<f64>) -> ((), Vector2<f64>) {
///         ((), vector![0.0, -0.8 * x[1]])
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

    /// The edges out of `mode`, in the order in which crossings that time cannot tell apart are taken.
    fn edges(&self, mode: Self::Mode) -> Edges<Self::Edge>;

    /// The guard of `edge`: positive inside the domain; the edge is taken where it falls through zero.
    fn guard(&self, edge: Self::Edge, t: f64, x: &Self::State) -> f64;

    /// The mode and state just after `edge` is taken from the state `x` just before.
    fn reset(&self, edge: Self::Edge, t: f64, x: &Self::State) -> (Self::Mode, Self::State);

    /// Takes `edge` out of `mode`: what a run does at a jump. The default is the [`reset`](Self::reset) and never fails.
    ///
    /// Models leave this alone. It is for automata made of others, whose jump depends on the mode left
    /// (the flow before it, say) or may not exist; the run then fails with an error of the kind returned.
    ///
    /// # Errors
    /// What kind of failure it is; the run adds the time, mode, edge and state.
    #[inline]
    fn take(
        &self,
        mode: Self::Mode,
        edge: Self::Edge,
        t: f64,
        x: &Self::State,
    ) -> Result<(Self::Mode, Self::State), ErrorKind> {
        let _ = mode;
        Ok(self.reset(edge, t, x))
    }

    /// What to do when the guard of `edge` is already negative as its mode is entered. The default refuses, with an error.
    fn entry(&self, edge: Self::Edge) -> Entry {
        let _ = edge;
        Entry::Refuse
    }

    /// Promises that the guard of `edge` is g(t, x) = a·x + b with constants a and b.
    ///
    /// The guard along a step is then a polynomial known exactly, and a crossing costs next to nothing to exclude.
    /// A promise that does not hold breaks the guarantee that no crossing is missed; the default promises nothing.
    fn affine(&self, edge: Self::Edge) -> bool {
        let _ = edge;
        false
    }

    /// Whether the run ends where `edge` is taken (its reset is applied, then the run stops). The default never ends.
    fn terminal(&self, edge: Self::Edge) -> bool {
        let _ = edge;
        false
    }

    /// The exact solution of the flow in `mode` from `x` at time `t`, where it is a polynomial in time: no step is then taken.
    fn exact(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Option<Polynomial<Self::State>> {
        let _ = (mode, t, x);
        None
    }

    /// The exact solution of the flow in `mode` where a formula gives it that is no polynomial: the state at `t + s`, for s ≥ 0, if it is
    /// `x` at `t`. No step is then taken; the trajectory's pieces interpolate it to twelve digits.
    ///
    /// A mode answers always or never. Asked only where [`exact`](Self::exact) says nothing.
    fn flown(&self, mode: Self::Mode, t: f64, x: &Self::State, s: f64) -> Option<Self::State> {
        let _ = (mode, t, x, s);
        None
    }

    /// The flow of `mode` once more, written over [`Jet`](crate::Jet)s and given to [`Series::flow`]; `false` where there is none. Steps are then taken by Taylor series,
    /// of an order that the tolerance asks for: a whole arc is often one or two of them, and a further digit costs little.
    ///
    /// Worth it where crossings are many or errors are to be small, and the flow is smooth and not stiff. It must be the same flow as
    /// [`flow`](Self::flow), which is looked at where each step ends: beyond a switch the two differ, and the step is shortened. At the kinks of
    /// [`Jet::abs`](crate::Jet::abs) it ends of itself. Where there is no series (√x at x = 0), the stepper goes on. Asked only where [`exact`](Self::exact) and [`flown`](Self::flown) say nothing.
    ///
    /// ```
    /// use saltus::nalgebra::{Vector2, vector};
    /// use saltus::{Automaton, Edges, Series, Simulation};
    ///
    /// /// x'' = -sin x; each passage through the lowest point is a jump.
    /// struct Pendulum;
    ///
    /// impl Automaton for Pendulum {
    ///     type Mode = bool; // to the right of it?
    ///     type State = Vector2<f64>; // angle and its rate
    ///     type Edge = bool;
    ///
    ///     fn flow(&self, _: bool, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
    ///         vector![x[1], -x[0].sin()]
    ///     }
    ///     fn series(&self, _: bool, series: &mut Series<'_, Vector2<f64>>) -> bool {
    ///         series.flow(|_t, [x, v]| [v, -x.sin()])
    ///     }
    ///     fn edges(&self, right: bool) -> Edges<bool> {
    ///         Edges::from([right])
    ///     }
    ///     fn guard(&self, right: bool, _t: f64, x: &Vector2<f64>) -> f64 {
    ///         if right { x[0] } else { -x[0] }
    ///     }
    ///     fn affine(&self, _: bool) -> bool {
    ///         true
    ///     }
    ///     fn reset(&self, right: bool, _t: f64, x: &Vector2<f64>) -> (bool, Vector2<f64>) {
    ///         (!right, *x)
    ///     }
    /// }
    ///
    /// // From a right angle it takes K(1/√2) to get down: the quarter of a period.
    /// let quarter = 1.854_074_677_301_371_9;
    /// let run = Simulation::of(&Pendulum).run(true, vector![std::f64::consts::FRAC_PI_2, 0.0], 0.0..7.0)?;
    /// for (k, jump) in run.trajectory.jumps().iter().enumerate() {
    ///     assert!((jump.t() - (2 * k + 1) as f64 * quarter).abs() < 1e-9);
    /// }
    /// assert!(run.stats.steps < 25); // with Dop853 it takes 40
    /// # Ok::<(), saltus::Error>(())
    /// ```
    fn series(&self, mode: Self::Mode, series: &mut Series<'_, Self::State>) -> bool {
        let _ = (mode, series);
        false
    }

    /// When the guard of `edge` first falls through zero on the solution from `x` at `t` that [`exact`](Self::exact) or [`flown`](Self::flown) gives, where a
    /// formula says so. The default has it searched for.
    ///
    /// A wrong answer is believed: it breaks the guarantee that no crossing is missed.
    fn falls(&self, mode: Self::Mode, edge: Self::Edge, t: f64, x: &Self::State) -> Fall<Self::State> {
        let _ = (mode, edge, t, x);
        Fall::Unknown
    }

    /// What lies beyond a Zeno limit: the mode and state in which the run goes on from `t`, where infinitely many jumps
    /// have accumulated at the state `x` of `mode`, any mode of the pattern that they make. The default says nothing, and the run ends with [`Stop::Zeno`](crate::Stop::Zeno).
    fn beyond(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Option<(Self::Mode, Self::State)> {
        let _ = (mode, t, x);
        None
    }

    /// The first edge that the clock takes in `mode` strictly after time `t`, and when: a kick each second, a switch at 3 s.
    ///
    /// A crossing at the same time is taken first; one scheduled edge is taken at any one time. What is due at the very start of a run is not taken. Such an edge needs no guard and is not listed in [`edges`](Self::edges).
    /// A time that is not a number, or not after `t`, is ignored.
    fn scheduled(&self, mode: Self::Mode, t: f64) -> Option<(f64, Self::Edge)> {
        let _ = (mode, t);
        None
    }

    /// What is wrong with the automaton itself for a run that starts in `mode`, found before it does: a sentence that names it and says what
    /// to do. Then no run starts. The default finds nothing; [`Hybrid`](crate::Hybrid) finds misspelt modes.
    fn flaw(&self, mode: Self::Mode) -> Option<String> {
        let _ = mode;
        None
    }

    /// Whether `mode` is a mode of this automaton; a run that starts in or jumps to another one is refused.
    fn has_mode(&self, mode: Self::Mode) -> bool {
        let _ = mode;
        true
    }
}

/// When a guard falls on a solution that is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fall<S> {
    /// No formula says: it is searched for.
    #[default]
    Unknown,
    /// It never does.
    Never,
    /// After this time, in seconds.
    After(f64),
    /// After this time, in seconds, in this state, which the guard must not find outside: the cheapest answer, for the solution need then not be evaluated
    /// to see where it stands.
    In(f64, S),
}

/// What to do with an edge whose guard is already negative when its mode is entered.
///
/// ```
/// use saltus::{Entry, ErrorKind, Hybrid, Simulation};
/// let heater = |entry| Hybrid::new()
///     .mode("on", |_t, _x: &f64| 1.0)
///     .mode("off", |_t, _x| -1.0)
///     .edge("on", "off", |_t, x| 22.0 - x, |_t, x| *x)
///     .entry("on", "off", entry);
/// // Switched on at 25 °C, which is too warm already.
/// let mode = |entry| Simulation::of(&heater(entry)).run("on", 25.0, 0.0..1.0).map(|run| run.mode);
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

/// The edges out of a mode, in order of priority, kept without allocation.
///
/// ```
/// use saltus::Edges;
/// let edges = Edges::from(['a', 'b']);
/// assert_eq!(edges.iter().collect::<String>(), "ab");
/// assert_eq!(Edges::<char>::none().len(), 0);
/// assert_eq!(Edges::indexed(100, |i| i).iter().sum::<usize>(), 4950);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Edges<E> {
    len: usize,
    list: List<E>,
}

#[derive(Clone, Copy, Debug)]
enum List<E> {
    Inline([Option<E>; Edges::<()>::INLINE]),
    Indexed(fn(usize) -> E),
}

impl<E: Copy> Edges<E> {
    /// How many edges [`Edges::from`] takes; a mode with more names them by index, see [`Edges::indexed`].
    pub const INLINE: usize = 16;

    /// No edges: the mode is never left.
    #[must_use]
    pub const fn none() -> Self {
        Self { len: 0, list: List::Inline([None; Edges::<()>::INLINE]) }
    }

    /// The edges `edge(0)`, `edge(1)`, … `edge(count - 1)`.
    #[must_use]
    pub const fn indexed(count: usize, edge: fn(usize) -> E) -> Self {
        Self { len: count, list: List::Indexed(edge) }
    }

    /// How many edges there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Whether the mode is never left.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The edge, if there is just one.
    #[inline]
    pub(crate) fn only(&self) -> Option<E> {
        if self.len == 1 { self.iter().next() } else { None }
    }

    /// The edges in order.
    #[inline]
    pub fn iter(&self) -> impl Iterator<Item = E> {
        (0..self.len).filter_map(|i| match &self.list {
            List::Inline(list) => list[i],
            List::Indexed(edge) => Some(edge(i)),
        })
    }
}

impl<E: Copy, const N: usize> From<[E; N]> for Edges<E> {
    #[inline]
    fn from(edges: [E; N]) -> Self {
        const { assert!(N <= Edges::<()>::INLINE, "too many edges for a list: use Edges::indexed") };
        let mut list = [None; Edges::<()>::INLINE];
        for (place, edge) in list.iter_mut().zip(edges) {
            *place = Some(edge);
        }
        Self { len: N, list: List::Inline(list) }
    }
}

impl<E: Copy> FromIterator<E> for Edges<E> {
    /// The first [`Edges::INLINE`] items.
    fn from_iter<I: IntoIterator<Item = E>>(edges: I) -> Self {
        let mut all = Self::none();
        if let List::Inline(list) = &mut all.list {
            for (place, edge) in list.iter_mut().zip(edges) {
                *place = Some(edge);
                all.len += 1;
            }
        }
        all
    }
}

/// A solution that is a polynomial in time, x(t + s) = c₀ + c₁ s + c₂ s² + c₃ s³, of degree at most three.
///
/// ```
/// use saltus::Polynomial;
/// // A ball thrown up from the floor at 5 m/s: height and velocity.
/// let arc = Polynomial::from([[0.0, 5.0], [5.0, -9.8], [-4.9, 0.0]]);
/// let [height, velocity] = arc.at(0.5);
/// assert_eq!(height, 0.5 * (5.0 - 4.9 * 0.5));
/// assert_eq!(velocity, 5.0 - 9.8 * 0.5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Polynomial<S> {
    coefficients: [S; 4],
    len: usize,
}

impl<S> Polynomial<S> {
    /// The coefficients c₀, c₁, …, lowest first.
    #[must_use]
    #[inline]
    pub fn coefficients(&self) -> &[S] {
        &self.coefficients[..self.len]
    }

    /// The polynomial whose coefficient k is `f(k, cₖ)`.
    #[cfg(feature = "num-dual")]
    pub(crate) fn map<R>(&self, mut f: impl FnMut(usize, &S) -> R) -> Polynomial<R> {
        Polynomial { coefficients: std::array::from_fn(|k| f(k, &self.coefficients[k])), len: self.len }
    }
}

impl<S: State> Polynomial<S> {
    /// The state a time `s` after the start.
    #[must_use]
    pub fn at(&self, s: f64) -> S {
        crate::trajectory::horner(self.coefficients(), s)
    }
}

impl<S: Copy, const N: usize> From<[S; N]> for Polynomial<S> {
    #[inline]
    fn from(list: [S; N]) -> Self {
        const { assert!(1 <= N && N <= 4, "a polynomial has one to four coefficients") };
        let mut coefficients = [list[0]; 4];
        coefficients[..N].copy_from_slice(&list);
        Self { coefficients, len: N }
    }
}
