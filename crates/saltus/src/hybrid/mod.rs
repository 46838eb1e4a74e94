//! An automaton put together from closures.

mod model;
mod names;

use std::fmt;
use std::sync::OnceLock;

use crate::automaton::{About, Entry};
use crate::clocks::Clock;
use crate::series::{Jet, Series};
use crate::solution::Polynomial;
use crate::state::State;

type Flow<'a, S> = Box<dyn Fn(f64, &S) -> S + Send + Sync + 'a>;
type Guard<'a, S> = Box<dyn Fn(f64, &S) -> f64 + Send + Sync + 'a>;
type Expand<'a, S> = Box<dyn Fn(&mut Series<'_, S>) + Send + Sync + 'a>;
type Exact<'a, S> = Box<dyn Fn(f64, &S) -> Polynomial<S> + Send + Sync + 'a>;

/// A hybrid automaton built from closures, its modes named by strings.
///
/// A thermostat heats until 22 °C and cools until 20 °C:
///
/// ```
/// use saltus::{Hybrid, Simulation};
///
/// let thermostat = Hybrid::new()
///     .mode("heating", |_t, x: &f64| 30.0 - x)
///     .mode("cooling", |_t, x| 10.0 - x)
///     .edge("heating", "cooling", |_t, x| 22.0 - x, |_t, x| *x)
///     .edge("cooling", "heating", |_t, x| x - 20.0, |_t, x| *x);
/// let run = Simulation::of(&thermostat).run("heating", 20.0, 0.0..2.0)?;
///
/// let first = &run.trajectory.jumps()[0];
/// assert!((first.t() - (10.0_f64 / 8.0).ln()).abs() < 1e-9);
/// assert_eq!((first.from, first.to), ("heating", "cooling"));
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// Where speed matters, implement [`Automaton`](crate::Automaton) instead: the closures are called through pointers.
///
/// A name that is misspelt (a mode that an edge leads to or from, an edge that [`entry`](Self::entry) or [`affine`](Self::affine) is about)
/// is found when a run starts, which then fails with an error that names it and suggests the nearest.
///
/// ```
/// use saltus::{ErrorKind, Hybrid, Simulation};
/// let lamp = Hybrid::new()
///     .mode("dark", |_t, _x: &f64| 1.0)
///     .mode("lit", |_t, _x| 0.0)
///     .edge("dark", "lid", |_t, x| 1.0 - x, |_t, x| *x);
/// let error = Simulation::of(&lamp).run("dark", 0.0, 0.0..3.0).unwrap_err().error;
/// assert_eq!(error.kind(), ErrorKind::Model);
/// assert!(error.to_string().contains("did you mean \"lit\"?"));
/// ```
pub struct Hybrid<'a, S> {
    modes: Vec<Mode<'a, S>>,
    /// What was said of edges that were not there, and of which.
    misses: Vec<(&'static str, &'static str, &'static str)>,
    /// By which method something was said twice of a mode, and of which.
    twice: Option<(&'static str, &'static str)>,
    /// What is wrong with it as a whole, once it was asked.
    flaw: OnceLock<Option<String>>,
}

struct Mode<'a, S> {
    name: &'static str,
    flow: Option<Flow<'a, S>>,
    series: Option<Expand<'a, S>>,
    exact: Option<Exact<'a, S>>,
    beyond: Option<(&'static str, Flow<'a, S>)>,
    edges: Vec<EdgeOf<'a, S>>,
    /// Those of the edges that have guards, and those that clocks take.
    guarded: Vec<Link>,
    clocks: Vec<(Clock, Link)>,
}

struct EdgeOf<'a, S> {
    to: &'static str,
    /// None of an edge that a clock takes.
    guard: Option<Guard<'a, S>>,
    reset: Flow<'a, S>,
    about: About,
    inverse: Option<(Guard<'a, S>, Flow<'a, S>)>,
}

/// Names an edge of a [`Hybrid`]: the modes it joins, and which of the edges out of the first it is.
///
/// ```
/// use saltus::Link;
/// let link = Link { from: "flight", to: "rest", place: 1 };
/// assert_eq!(format!("{link:?}"), "flight -> rest (edge 1)");
/// ```
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Link {
    /// The mode it leaves.
    pub from: &'static str,
    /// The mode it leads to.
    pub to: &'static str,
    /// Its place among the edges out of `from`, in the order in which they were declared.
    pub place: usize,
}

impl fmt::Debug for Link {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} -> {} (edge {})", self.from, self.to, self.place)
    }
}

impl<'a, S> Mode<'a, S> {
    /// Adds an edge with a guard.
    fn guarded_by(&mut self, edge: EdgeOf<'a, S>) {
        self.guarded.push(Link { from: self.name, to: edge.to, place: self.edges.len() });
        self.edges.push(edge);
    }
}

impl<'a, S> EdgeOf<'a, S> {
    fn new(to: &'static str, guard: Option<Guard<'a, S>>, reset: Flow<'a, S>) -> Self {
        Self { to, guard, reset, about: About::new(), inverse: None }
    }
}

impl<S> Default for Hybrid<'_, S> {
    fn default() -> Self {
        Self { modes: Vec::new(), misses: Vec::new(), twice: None, flaw: OnceLock::new() }
    }
}

impl<S> fmt::Debug for Hybrid<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let edges = |mode: &Mode<'_, S>| mode.edges.iter().map(|edge| edge.to).collect::<Vec<_>>();
        f.debug_map().entries(self.modes.iter().map(|mode| (mode.name, edges(mode)))).finish()
    }
}

impl<'a, S: State> Hybrid<'a, S> {
    /// Without modes yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares a mode and its flow f of x' = f(t, x). From an automaton that declares one twice no run starts.
    #[must_use]
    pub fn mode(mut self, name: &'static str, flow: impl Fn(f64, &S) -> S + Send + Sync + 'a) -> Self {
        let before = self.entry_of(name).flow.replace(Box::new(flow));
        self.twice = self.twice.or(before.map(|_| ("mode", name)));
        self
    }

    /// Gives the mode's flow once more, over [`Jet`]s: steps are then taken by Taylor series, see [`Solution::Series`](crate::Solution::Series).
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// // A ball that falls 2 m through air: v² = g/k (1 - exp(-2 k h)).
    /// let (g, k, h) = (9.8, 0.1, 2.0_f64);
    /// let ball = Hybrid::new()
    ///     .mode("flight", |_t, x: &[f64; 2]| [x[1], k * x[1] * x[1] - g])
    ///     .series("flight", |_t, [_, v]| [v, k * v * v - g])
    ///     .edge("flight", "flight", |_t, x| x[0], |_t, x| *x)
    ///     .affine("flight", "flight");
    /// let run = Simulation::of(&ball).tolerance(1e-13).most_jumps(1).run("flight", [h, 0.0], 0.0..9.0)?;
    /// assert!((run.state[1] + (g / k * (1.0 - (-2.0 * k * h).exp())).sqrt()).abs() < 1e-14);
    /// assert!(run.stats.steps <= 3);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn series<const N: usize>(
        mut self,
        name: &'static str,
        flow: impl for<'j> Fn(Jet<'j>, [Jet<'j>; N]) -> [Jet<'j>; N] + Send + Sync + 'a,
    ) -> Self {
        #[allow(clippy::redundant_closure)] // the flow is inlined here; a reference to it would be called at every pass
        let series = Box::new(move |series: &mut Series<'_, S>| series.flow(|t, x| flow(t, x)));
        let before = self.entry_of(name).series.replace(series);
        self.twice = self.twice.or(before.map(|_| ("series", name)));
        self
    }

    /// Gives the mode's exact solution from (t, x), where it is a polynomial in time; no step is then taken in it, and it needs no flow.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let ball = Hybrid::new()
    ///     .exact("flight", |_t, x: &[f64; 2]| [*x, [x[1], -9.8], [-4.9, 0.0]].into())
    ///     .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]])
    ///     .affine("flight", "flight");
    /// let run = Simulation::of(&ball).run("flight", [4.9, 0.0], 0.0..1.5)?;
    /// assert_eq!((run.trajectory.jumps()[0].t(), run.stats.steps), (1.0, 0));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn exact(mut self, name: &'static str, solution: impl Fn(f64, &S) -> Polynomial<S> + Send + Sync + 'a) -> Self {
        let before = self.entry_of(name).exact.replace(Box::new(solution));
        self.twice = self.twice.or(before.map(|_| ("exact", name)));
        self
    }

    /// Declares an edge: its guard, positive inside the domain of `from`, and its reset x⁺ = r(t, x⁻) into `to`.
    ///
    /// Edges that cross at one time are taken in the order in which they are declared.
    #[must_use]
    pub fn edge(
        mut self,
        from: &'static str,
        to: &'static str,
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        let edge = EdgeOf::new(to, Some(Box::new(guard)), Box::new(reset));
        self.entry_of(from).guarded_by(edge);
        self
    }

    /// Declares an edge that a clock takes; see [`Clock`].
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// let kicked = Hybrid::new()
    ///     .mode("drift", |_t, _x: &f64| 0.0)
    ///     .clock("drift", "drift", Clock::every(0.1), |_t, x| x + 1.0);
    /// let run = Simulation::of(&kicked).run("drift", 0.0, 0.0..1.05)?;
    /// assert_eq!(run.state, 10.0);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn clock(
        mut self,
        from: &'static str,
        to: &'static str,
        clock: Clock,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        let mode = self.entry_of(from);
        let place = mode.edges.len();
        mode.edges.push(EdgeOf::new(to, None, Box::new(reset)));
        mode.clocks.push((clock, Link { from, to, place }));
        self
    }

    /// An edge at which the run ends, without a reset; it leads from its mode to itself.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation, Stop};
    /// let tank = Hybrid::new().mode("drain", |_t, _x: &f64| -0.5).terminal("drain", |_t, x| *x);
    /// let run = Simulation::of(&tank).run("drain", 2.0, 0.0..f64::INFINITY)?;
    /// assert!(matches!(run.stop, Stop::Terminal { .. }));
    /// assert!((run.trajectory.end().seconds() - 4.0).abs() < 1e-12);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn terminal(mut self, from: &'static str, guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a) -> Self {
        let edge = EdgeOf::new(from, Some(Box::new(guard)), Box::new(|_, x| *x));
        self.entry_of(from).guarded_by(EdgeOf { about: About::new().terminal(), ..edge });
        self
    }

    /// What to do if a guard declared so far from `from` to `to` is already negative as `from` is entered; see [`Entry`].
    /// A [`terminal`](Self::terminal) edge leads from its mode to itself.
    #[must_use]
    pub fn entry(mut self, from: &'static str, to: &'static str, entry: Entry) -> Self {
        self.between("entry", from, to, |edge| edge.about.entry = entry);
        self
    }

    /// Promises that the guards declared so far from `from` to `to` are affine in the state; see [`About::affine`].
    #[must_use]
    pub fn affine(mut self, from: &'static str, to: &'static str) -> Self {
        self.between("affine", from, to, |edge| edge.about.affine = true);
        self
    }

    /// Gives the inverse of the edge declared last from `from` to `to`, so that a run can go [backwards](crate::Reversed) through it:
    /// the `image` margin, positive in `to` and zero just after the jump, and x⁻ from x⁺. See [`Invertible`](crate::Invertible).
    ///
    /// A run backwards is refused where it could meet an edge without an inverse. An edge that is never met backwards may be given
    /// the margin 1.
    ///
    /// ```
    /// use saltus::nalgebra::{Vector2, vector};
    /// use saltus::{Hybrid, Reversed, Simulation};
    ///
    /// let ball = Hybrid::new()
    ///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81])
    ///     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.7 * x[1]])
    ///     .inverse("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -x[1] / 0.7]);
    /// let there = Simulation::of(&ball).run("flight", vector![1.0, 0.0], 0.0..1.5)?;
    /// let back = Simulation::of(&Reversed::of(&ball)).run("flight", there.state, Reversed::span(1.5, 0.0))?;
    /// assert!((back.state - vector![1.0, 0.0]).norm() < 1e-9);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn inverse(
        mut self,
        from: &'static str,
        to: &'static str,
        image: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        undo: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        match self.entry_of(from).edges.iter_mut().rfind(|edge| edge.to == to) {
            Some(edge) => edge.inverse = Some((Box::new(image), Box::new(undo))),
            None => self.misses.push(("inverse", from, to)),
        }
        self
    }

    /// What lies beyond a Zeno limit reached in `from`: the mode `to`, with the state given by `reset` from the state at the limit.
    ///
    /// Where jumps accumulate that go from mode to mode, the limit may be reached in any of them: say it for each.
    #[must_use]
    pub fn beyond(
        mut self,
        from: &'static str,
        to: &'static str,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        let before = self.entry_of(from).beyond.replace((to, Box::new(reset)));
        self.twice = self.twice.or(before.map(|_| ("beyond", from)));
        self
    }

    fn entry_of(&mut self, name: &'static str) -> &mut Mode<'a, S> {
        self.flaw = OnceLock::new();
        let index = self.modes.iter().position(|mode| mode.name == name).unwrap_or_else(|| {
            let (edges, guarded, clocks) = (Vec::new(), Vec::new(), Vec::new());
            self.modes.push(Mode { name, flow: None, series: None, exact: None, beyond: None, edges, guarded, clocks });
            self.modes.len() - 1
        });
        &mut self.modes[index]
    }

    fn between(
        &mut self,
        method: &'static str,
        from: &'static str,
        to: &'static str,
        mut change: impl FnMut(&mut EdgeOf<'a, S>),
    ) {
        let mut any = false;
        for edge in self.entry_of(from).edges.iter_mut().filter(|edge| edge.to == to) {
            change(edge);
            any = true;
        }
        if !any {
            self.misses.push((method, from, to));
        }
    }

    /// Every edge of `mode`, also those of clocks.
    fn links<'m>(mode: &'m Mode<'a, S>) -> impl Iterator<Item = (Link, &'m EdgeOf<'a, S>)> {
        let from = mode.name;
        mode.edges.iter().enumerate().map(move |(place, edge)| (Link { from, to: edge.to, place }, edge))
    }

    #[inline]
    fn find(&self, name: &str) -> Option<&Mode<'a, S>> {
        let same = self.modes.iter().find(|mode| std::ptr::eq(mode.name, name));
        same.or_else(|| self.modes.iter().find(|mode| mode.name == name))
    }

    fn edge_of(&self, link: Link) -> Option<&EdgeOf<'a, S>> {
        self.find(link.from)?.edges.get(link.place)
    }
}
