//! An automaton put together from closures.

mod clocked;
mod edge;
mod link;
mod model;
mod names;

pub use edge::Edge;
pub use link::Link;

use std::borrow::Cow;
use std::fmt;
use std::sync::{Arc, OnceLock};

use self::names::kept;
use crate::automaton::Entry;
use crate::automaton::clocks::Clock;
use crate::automaton::solution::Polynomial;
use crate::error::Refusal;
use crate::series::{Jet, Series};
use crate::sparsity::Sparsity;
use crate::state::State;

type Flow<'a, S> = Box<dyn Fn(f64, &S) -> S + Send + Sync + 'a>;
type Expand<'a, S> = Box<dyn Fn(&mut Series<'_, S>) + Send + Sync + 'a>;
type Refuses<'a, S> = Box<dyn Fn(f64, &S) -> Option<Refusal> + Send + Sync + 'a>;
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
///     .edge("heating", "cooling", |_t, x| 22.0 - x, |_t, x| x.clone())
///     .edge("cooling", "heating", |_t, x| x - 20.0, |_t, x| x.clone());
/// let run = Simulation::of(&thermostat).run("heating", 20.0, 0.0..2.0)?;
///
/// let first = &run.trajectory.jumps()[0];
/// assert!((first.t() - (10.0_f64 / 8.0).ln()).abs() < 1e-9);
/// assert_eq!((first.from, first.to), ("heating", "cooling"));
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// Where speed matters, implement [`Automaton`](crate::Automaton) instead: the closures are called
/// through pointers.
///
/// A name may be made as a program runs: an owned one is kept until the program ends, once however
/// often it is given. [`name`](Self::name) finds it again.
///
/// A name that is misspelt (a mode that an edge leads to or from, an edge that
/// [`entry`](Self::entry) or [`affine`](Self::affine) is about) is found when a run starts, which
/// then fails with an error that names it and suggests the nearest.
///
/// ```
/// use saltus::{ErrorKind, Hybrid, Simulation};
/// let lamp = Hybrid::new()
///     .mode("dark", |_t, _x: &f64| 1.0)
///     .mode("lit", |_t, _x| 0.0)
///     .edge("dark", "lid", |_t, x| 1.0 - x, |_t, x| x.clone());
/// let error = Simulation::of(&lamp).run("dark", 0.0, 0.0..3.0).unwrap_err().error;
/// assert_eq!(error.kind(), ErrorKind::Model);
/// assert!(error.to_string().contains("did you mean \"lit\"?"));
/// ```
pub struct Hybrid<'a, S> {
    modes: Vec<Mode<'a, S>>,
    /// Whether any mode has clocks.
    clocked: bool,
    /// Whether any mode has stops, and those of every mode.
    stopped: bool,
    everywhere: Vec<Clock>,
    /// The mode of the edge declared last.
    last: Option<&'static str>,
    /// The first method that was to say something of an edge declared last that has no guard, or
    /// before there was one.
    misplaced: Option<&'static str>,
    /// The method that was called twice for a mode, and the mode.
    twice: Option<(&'static str, &'static str)>,
    /// What is wrong with it as a whole, once it was asked.
    flaw: OnceLock<Option<String>>,
}

struct Mode<'a, S> {
    name: &'static str,
    flow: Option<Flow<'a, S>>,
    /// Why the flow is not a number, where it may fail.
    refusal: Option<Refuses<'a, S>>,
    series: Option<Expand<'a, S>>,
    sparsity: Option<Sparsity>,
    exact: Option<Exact<'a, S>>,
    beyond: Option<(&'static str, Flow<'a, S>)>,
    /// Each with the mode it leads to.
    edges: Vec<(&'static str, Edge<'a, S>)>,
    /// Those of the edges that have guards, and those that clocks take.
    guarded: Vec<Link>,
    clocks: Vec<(Clock, Link)>,
    stops: Vec<Clock>,
}

impl<S> Default for Hybrid<'_, S> {
    fn default() -> Self {
        Self {
            modes: Vec::new(),
            stopped: false,
            clocked: false,
            everywhere: Vec::new(),
            last: None,
            misplaced: None,
            twice: None,
            flaw: OnceLock::new(),
        }
    }
}

impl<S> fmt::Debug for Hybrid<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let edges = |mode: &Mode<'_, S>| mode.edges.iter().map(|(to, _)| *to).collect::<Vec<_>>();
        f.debug_map().entries(self.modes.iter().map(|mode| (mode.name, edges(mode)))).finish()
    }
}

impl<'a, S: State> Hybrid<'a, S> {
    /// Without modes yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Declares a mode and its flow f of x' = f(t, x). From an automaton that declares one twice no
    /// run starts.
    #[must_use]
    pub fn mode(mut self, name: impl Into<Cow<'static, str>>, flow: impl Fn(f64, &S) -> S + Send + Sync + 'a) -> Self {
        let name = kept(name);
        let before = self.entry_of(name).flow.replace(Box::new(flow));
        self.twice = self.twice.or(before.map(|_| ("mode", name)));
        self
    }

    /// Declares a mode whose flow may fail: it is asked for no further than it answers, and a run
    /// that cannot end or jump before fails with the [`Refusal`].
    ///
    /// ```
    /// use saltus::{ErrorKind, Hybrid, Refusal, Simulation};
    /// // A drag coefficient that is tabulated up to 30 m/s.
    /// let ball = Hybrid::new().fallible("fall", |_t, v: &f64| {
    ///     if *v <= 30.0 { Ok(9.81 - 0.001 * v * v) } else { Err(Refusal::new(format!("no drag is given for {v} m/s"))) }
    /// });
    /// let error = Simulation::of(&ball).run("fall", 0.0, 0.0..9.0).unwrap_err().error;
    /// assert_eq!((error.kind(), error.state()[0].round()), (ErrorKind::Refused, 30.0));
    /// assert!(error.to_string().starts_with("the flow refused: no drag is given for 30.0"));
    /// ```
    #[must_use]
    pub fn fallible(
        self,
        name: impl Into<Cow<'static, str>>,
        flow: impl Fn(f64, &S) -> Result<S, Refusal> + Send + Sync + 'a,
    ) -> Self {
        let (name, flow) = (kept(name), Arc::new(flow));
        let refusal = Arc::clone(&flow);
        let mut hybrid = self.mode(name, move |t, x| flow(t, x).unwrap_or_else(|_| x.with(|_| f64::NAN)));
        hybrid.entry_of(name).refusal = Some(Box::new(move |t, x| refusal(t, x).err()));
        hybrid
    }

    /// Gives the mode's flow once more, over [`Jet`]s: steps are then taken by Taylor series, see
    /// [`Solution::Series`](crate::Solution::Series).
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// // A ball that falls 2 m through air: v² = g/k (1 - exp(-2 k h)).
    /// let (g, k, h) = (9.8, 0.1, 2.0_f64);
    /// let ball = Hybrid::new()
    ///     .mode("flight", |_t, x: &[f64; 2]| [x[1], k * x[1] * x[1] - g])
    ///     .series("flight", |_t, [_, v]| [v, k * v * v - g])
    ///     .edge("flight", "flight", |_t, x| x[0], |_t, x| x.clone())
    ///     .affine();
    /// let run = Simulation::of(&ball).tolerance(1e-13).most_jumps(1).run("flight", [h, 0.0], 0.0..9.0)?;
    /// assert!((run.end.state[1] + (g / k * (1.0 - (-2.0 * k * h).exp())).sqrt()).abs() < 1e-14);
    /// assert!(run.end.stats.steps <= 3);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn series<const N: usize>(
        mut self,
        name: impl Into<Cow<'static, str>>,
        flow: impl for<'j> Fn(Jet<'j>, [Jet<'j>; N]) -> [Jet<'j>; N] + Send + Sync + 'a,
    ) -> Self {
        #[allow(clippy::redundant_closure)] // the flow is inlined here; a reference to it would be called at every pass
        let series = Box::new(move |series: &mut Series<'_, S>| series.flow(|t, x| flow(t, x)));
        let name = kept(name);
        let before = self.entry_of(name).series.replace(series);
        self.twice = self.twice.or(before.map(|_| ("series", name)));
        self
    }

    /// Gives the pattern of the Jacobian of a mode's flow, of one without a series or an exact
    /// solution: see [`Sparsity`].
    #[must_use]
    pub fn sparse(mut self, name: impl Into<Cow<'static, str>>, sparsity: Sparsity) -> Self {
        let name = kept(name);
        let before = self.entry_of(name).sparsity.replace(sparsity);
        self.twice = self.twice.or(before.map(|_| ("sparse", name)));
        self
    }

    /// Gives the mode's exact solution from (t, x), where it is a polynomial in time; no step is
    /// then taken in it, and it needs no flow.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let ball = Hybrid::new()
    ///     .exact("flight", |_t, x: &[f64; 2]| [*x, [x[1], -9.8], [-4.9, 0.0]].into())
    ///     .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]])
    ///     .affine();
    /// let run = Simulation::of(&ball).run("flight", [4.9, 0.0], 0.0..1.5)?;
    /// assert_eq!((run.trajectory.jumps()[0].t(), run.end.stats.steps), (1.0, 0));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn exact(
        mut self,
        name: impl Into<Cow<'static, str>>,
        solution: impl Fn(f64, &S) -> Polynomial<S> + Send + Sync + 'a,
    ) -> Self {
        let name = kept(name);
        let before = self.entry_of(name).exact.replace(Box::new(solution));
        self.twice = self.twice.or(before.map(|_| ("exact", name)));
        self
    }

    /// Declares an edge: its guard, positive inside the domain of `from`, and its reset x⁺ = r(t,
    /// x⁻) into `to`.
    ///
    /// Edges that cross at one time are taken in the order in which they are declared. A reset that
    /// may fail: [`Edge::fallible`].
    #[must_use]
    pub fn edge(
        self,
        from: impl Into<Cow<'static, str>>,
        to: impl Into<Cow<'static, str>>,
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.edge_with(from, to, Edge::new(guard, reset))
    }

    /// Declares an [`edge`](Self::edge) that keeps the state: only the mode changes.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let thermostat = Hybrid::new()
    ///     .mode("heating", |_t, x: &f64| 30.0 - x)
    ///     .mode("cooling", |_t, x| 10.0 - x)
    ///     .switch("heating", "cooling", |_t, x| 22.0 - x)
    ///     .switch("cooling", "heating", |_t, x| x - 20.0);
    /// let run = Simulation::of(&thermostat).run("heating", 20.0, 0.0..2.0)?;
    /// assert!((run.trajectory.jumps()[0].after - 22.0).abs() < 1e-12);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn switch(
        self,
        from: impl Into<Cow<'static, str>>,
        to: impl Into<Cow<'static, str>>,
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
    ) -> Self {
        self.edge(from, to, guard, |_t, x| x.clone())
    }

    /// Declares an edge that was put together before, or that may fail: see [`Edge`].
    #[must_use]
    pub fn edge_with(
        mut self,
        from: impl Into<Cow<'static, str>>,
        to: impl Into<Cow<'static, str>>,
        edge: Edge<'a, S>,
    ) -> Self {
        let (from, to) = (kept(from), kept(to));
        let mode = self.entry_of(from);
        mode.guarded.push(Link { from, to, place: mode.edges.len() });
        mode.edges.push((to, edge));
        self.last = Some(from);
        self
    }

    /// An edge at which the run ends, without a reset; it leads from its mode to itself.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation, Stop};
    /// let tank = Hybrid::new().mode("drain", |_t, _x: &f64| -0.5).terminal("drain", |_t, x| x.clone());
    /// let run = Simulation::of(&tank).run("drain", 2.0, 0.0..f64::INFINITY)?;
    /// assert!(matches!(run.end.stop, Stop::Terminal { .. }));
    /// assert!((run.trajectory.end().seconds() - 4.0).abs() < 1e-12);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn terminal(
        self,
        from: impl Into<Cow<'static, str>>,
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
    ) -> Self {
        let from = kept(from);
        self.edge_with(from, from, Edge::new(guard, |_t, x: &S| x.clone()).terminal())
    }

    /// [`Edge::entry`] of the edge declared last.
    ///
    /// ```
    /// use saltus::{Entry, Hybrid, Simulation};
    /// // A counter of passages through zero, and a mark that ends the run.
    /// let swing = Hybrid::new()
    ///     .mode("swing", |_t, x: &[f64; 2]| [x[1], -x[0]])
    ///     .edge("swing", "swing", |_t, x| x[0], |_t, x| x.clone())
    ///     .entry(Entry::Wait)
    ///     .terminal("swing", |t, _x| 20.0 - t);
    /// assert_eq!(Simulation::of(&swing).run("swing", [-1.0, 0.0], 0.0..1e9)?.end.stats.jumps, 4);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn entry(self, entry: Entry) -> Self {
        self.of_last("entry", |edge| edge.entry(entry))
    }

    /// [`Edge::affine`] of the edge declared last.
    #[must_use]
    pub fn affine(self) -> Self {
        self.of_last("affine", Edge::affine)
    }

    /// [`Edge::inverse`] of the edge declared last.
    #[must_use]
    pub fn inverse(
        self,
        image: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        undo: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.of_last("inverse", |edge| edge.inverse(image, undo))
    }

    /// What lies beyond a Zeno limit reached in `from`: the mode `to`, with the state given by
    /// `reset` from the state at the limit.
    ///
    /// Where jumps accumulate that go from mode to mode, the limit may be reached in any of them:
    /// say it for each.
    #[must_use]
    pub fn beyond(
        mut self,
        from: impl Into<Cow<'static, str>>,
        to: impl Into<Cow<'static, str>>,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        let (from, to) = (kept(from), kept(to));
        let before = self.entry_of(from).beyond.replace((to, Box::new(reset)));
        self.twice = self.twice.or(before.map(|_| ("beyond", from)));
        self
    }

    /// The mode of this name, to start a run in; nothing if it is not declared.
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let floors = (0..3).fold(Hybrid::new(), |lift, floor| {
    ///     let (here, next) = (format!("floor {floor}"), format!("floor {}", (floor + 1) % 3));
    ///     lift.mode(here.clone(), |_t, _x: &f64| 1.0).edge(here, next, |_t, x| 1.0 - x, |_t, _x| 0.0)
    /// });
    /// let start = floors.name("floor 1").unwrap();
    /// let run = Simulation::of(&floors).run(start, 0.0, 0.0..4.5)?;
    /// assert_eq!((run.end.mode, floors.name("cellar")), ("floor 2", None));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn name(&self, name: &str) -> Option<&'static str> {
        self.find(name).filter(|mode| self.declares(mode.name)).map(|mode| mode.name)
    }

    /// What a `method` says of the guard, or of the inverse, of the edge declared last.
    fn of_last(mut self, method: &'static str, about: impl FnOnce(Edge<'a, S>) -> Edge<'a, S>) -> Self {
        let last = self.last.and_then(|name| self.modes.iter_mut().find(|mode| mode.name == name));
        match last.and_then(|mode| mode.edges.pop_if(|(_, edge)| edge.guard.is_some()).map(|edge| (mode, edge))) {
            Some((mode, (to, edge))) => mode.edges.push((to, about(edge))),
            None => self.misplaced = self.misplaced.or(Some(method)),
        }
        self
    }
}
