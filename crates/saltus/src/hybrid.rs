//! An automaton put together from closures.

use std::fmt;

use crate::automaton::{Automaton, Edges, Entry, Polynomial};
use crate::state::State;

type Flow<'a, S> = Box<dyn Fn(f64, &S) -> S + Send + Sync + 'a>;
type Guard<'a, S> = Box<dyn Fn(f64, &S) -> f64 + Send + Sync + 'a>;
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
/// Where speed matters, implement [`Automaton`] instead: the closures are called through pointers.
pub struct Hybrid<'a, S> {
    modes: Vec<Mode<'a, S>>,
}

struct Mode<'a, S> {
    name: &'static str,
    flow: Option<Flow<'a, S>>,
    exact: Option<Exact<'a, S>>,
    beyond: Option<(&'static str, Flow<'a, S>)>,
    edges: Vec<EdgeOf<'a, S>>,
}

struct EdgeOf<'a, S> {
    to: &'static str,
    when: When<'a, S>,
    reset: Flow<'a, S>,
    entry: Entry,
    affine: bool,
    terminal: bool,
}

/// What takes an edge: the state, or the clock.
enum When<'a, S> {
    Guard(Guard<'a, S>),
    Clock(Box<dyn Fn(f64) -> Option<f64> + Send + Sync + 'a>),
}

/// Names an edge of a [`Hybrid`]: the modes it joins, and which of the edges out of the first it is.
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

impl<'a, S> EdgeOf<'a, S> {
    fn new(to: &'static str, when: When<'a, S>, reset: Flow<'a, S>) -> Self {
        Self { to, when, reset, entry: Entry::Refuse, affine: false, terminal: false }
    }
}

/// The multiples of a `period` in seconds: the first one strictly after a time, for [`Hybrid::scheduled`].
///
/// Multiple k is k · period rounded once, so the hundred-thousandth is as exact as the first. A period that is not positive has no multiples.
///
/// ```
/// let next = saltus::every(0.1);
/// assert_eq!((next(0.0), next(0.3), next(0.1 * 3.0)), (Some(0.1), Some(0.1 * 3.0), Some(0.4)));
/// ```
pub fn every(period: f64) -> impl Fn(f64) -> Option<f64> + Copy + Send + Sync {
    move |t| {
        let near = (t / period).round();
        [near - 1.0, near, near + 1.0, near + 2.0].into_iter().map(|k| k * period).find(|&multiple| multiple > t)
    }
}

impl<S> Default for Hybrid<'_, S> {
    fn default() -> Self {
        Self { modes: Vec::new() }
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

    /// Declares a mode and its flow f of x' = f(t, x). Declared again, the flow is replaced.
    #[must_use]
    pub fn mode(mut self, name: &'static str, flow: impl Fn(f64, &S) -> S + Send + Sync + 'a) -> Self {
        self.entry_of(name).flow = Some(Box::new(flow));
        self
    }

    /// Gives the mode's exact solution from (t, x), where it is a polynomial in time; no step is then taken in it.
    #[must_use]
    pub fn exact(mut self, name: &'static str, solution: impl Fn(f64, &S) -> Polynomial<S> + Send + Sync + 'a) -> Self {
        self.entry_of(name).exact = Some(Box::new(solution));
        self
    }

    /// Declares an edge: its guard, positive inside the domain of `from`, and its reset x⁺ = r(t, x⁻) into `to`.
    ///
    /// Edges that cross at one time are taken in the order in which they are declared. A mode has at most [`Edges::INLINE`] edges;
    /// more are a reason to implement [`Automaton`] and are not watched: a run refuses such a mode.
    #[must_use]
    pub fn edge(
        mut self,
        from: &'static str,
        to: &'static str,
        guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.entry_of(from).edges.push(EdgeOf::new(to, When::Guard(Box::new(guard)), Box::new(reset)));
        self
    }

    /// Declares an edge that the clock takes: `next` gives the first time strictly after its argument; see [`every`].
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation, every};
    /// let kicked = Hybrid::new()
    ///     .mode("drift", |_t, _x: &f64| 0.0)
    ///     .scheduled("drift", "drift", every(0.1), |_t, x| x + 1.0);
    /// let run = Simulation::of(&kicked).run("drift", 0.0, 0.0..1.05)?;
    /// assert_eq!(run.state, 10.0);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn scheduled(
        mut self,
        from: &'static str,
        to: &'static str,
        next: impl Fn(f64) -> Option<f64> + Send + Sync + 'a,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.entry_of(from).edges.push(EdgeOf::new(to, When::Clock(Box::new(next)), Box::new(reset)));
        self
    }

    /// An edge at which the run ends, without a reset.
    #[must_use]
    pub fn terminal(mut self, from: &'static str, guard: impl Fn(f64, &S) -> f64 + Send + Sync + 'a) -> Self {
        let edge = EdgeOf::new(from, When::Guard(Box::new(guard)), Box::new(|_, x| *x));
        self.entry_of(from).edges.push(EdgeOf { terminal: true, ..edge });
        self
    }

    /// What to do if a guard out of `from` towards `to` is already negative as `from` is entered; see [`Entry`].
    #[must_use]
    pub fn entry(mut self, from: &'static str, to: &'static str, entry: Entry) -> Self {
        for edge in self.entry_of(from).edges.iter_mut().filter(|edge| edge.to == to) {
            edge.entry = entry;
        }
        self
    }

    /// Promises that the guards declared so far from `from` to `to` are affine in the state; see [`Automaton::affine`].
    #[must_use]
    pub fn affine(mut self, from: &'static str, to: &'static str) -> Self {
        for edge in self.entry_of(from).edges.iter_mut().filter(|edge| edge.to == to) {
            edge.affine = true;
        }
        self
    }

    /// What lies beyond a Zeno limit reached in `from`: the mode `to`, with the state given by `reset` from the state at the limit.
    #[must_use]
    pub fn beyond(
        mut self,
        from: &'static str,
        to: &'static str,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.entry_of(from).beyond = Some((to, Box::new(reset)));
        self
    }

    fn entry_of(&mut self, name: &'static str) -> &mut Mode<'a, S> {
        let index = self.modes.iter().position(|mode| mode.name == name).unwrap_or_else(|| {
            self.modes.push(Mode { name, flow: None, exact: None, beyond: None, edges: Vec::new() });
            self.modes.len() - 1
        });
        &mut self.modes[index]
    }

    fn find(&self, name: &str) -> Option<&Mode<'a, S>> {
        self.modes.iter().find(|mode| mode.name == name)
    }

    fn edge_of(&self, link: Link) -> Option<&EdgeOf<'a, S>> {
        self.find(link.from)?.edges.get(link.place)
    }
}

impl<S: State> Automaton for Hybrid<'_, S> {
    type Mode = &'static str;
    type State = S;
    type Edge = Link;

    fn flow(&self, mode: &'static str, t: f64, x: &S) -> S {
        match self.find(mode).and_then(|mode| mode.flow.as_ref()) {
            Some(flow) => flow(t, x),
            None => x.with(|_| f64::NAN),
        }
    }

    fn edges(&self, mode: &'static str) -> Edges<Link> {
        let edges = self.find(mode).map_or(&[][..], |mode| &mode.edges[..]);
        let guarded = edges.iter().enumerate().filter(|(_, edge)| matches!(edge.when, When::Guard(_)));
        guarded.map(|(place, edge)| Link { from: mode, to: edge.to, place }).collect()
    }

    fn guard(&self, edge: Link, t: f64, x: &S) -> f64 {
        match self.edge_of(edge).map(|edge| &edge.when) {
            Some(When::Guard(guard)) => guard(t, x),
            _ => f64::NAN,
        }
    }

    fn scheduled(&self, mode: &'static str, t: f64) -> Option<(f64, Link)> {
        let edges = self.find(mode)?.edges.iter().enumerate();
        let due = edges.filter_map(|(place, edge)| match &edge.when {
            When::Clock(next) => Some((next(t)?, Link { from: mode, to: edge.to, place })),
            When::Guard(_) => None,
        });
        due.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn reset(&self, edge: Link, t: f64, x: &S) -> (&'static str, S) {
        (edge.to, self.edge_of(edge).map_or(*x, |edge| (edge.reset)(t, x)))
    }

    fn entry(&self, edge: Link) -> Entry {
        self.edge_of(edge).map_or(Entry::Refuse, |edge| edge.entry)
    }

    fn affine(&self, edge: Link) -> bool {
        self.edge_of(edge).is_some_and(|edge| edge.affine)
    }

    fn terminal(&self, edge: Link) -> bool {
        self.edge_of(edge).is_some_and(|edge| edge.terminal)
    }

    fn exact(&self, mode: &'static str, t: f64, x: &S) -> Option<Polynomial<S>> {
        self.find(mode)?.exact.as_ref().map(|solution| solution(t, x))
    }

    fn beyond(&self, mode: &'static str, t: f64, x: &S) -> Option<(&'static str, S)> {
        let (to, reset) = self.find(mode)?.beyond.as_ref()?;
        Some((to, reset(t, x)))
    }

    fn has_mode(&self, mode: &'static str) -> bool {
        self.find(mode).is_some_and(|mode| {
            (mode.flow.is_some() || mode.exact.is_some()) && mode.edges.len() <= Edges::<Link>::INLINE
        })
    }
}
