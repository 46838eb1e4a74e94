//! An automaton put together from closures.

use std::fmt;
use std::sync::OnceLock;

use crate::automaton::{About, Automaton, Entry, Limit};
use crate::clocks::{Clock, Clocks};
use crate::edges::Edges;
use crate::error::Refusal;
use crate::reverse::Invertible;
use crate::series::{Jet, Series};
use crate::solution::{Polynomial, Solution};
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
/// Where speed matters, implement [`Automaton`] instead: the closures are called through pointers.
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

    /// Gives the mode's flow once more, over [`Jet`]s: steps are then taken by Taylor series, see [`Solution::Series`].
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
    /// the `image` margin, positive in `to` and zero just after the jump, and x⁻ from x⁺. See [`Invertible`].
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

    fn declares(&self, name: &str) -> bool {
        self.find(name).is_some_and(|mode| mode.flow.is_some() || mode.exact.is_some())
    }

    /// What to do about a mode that is not declared.
    fn declare(&self, name: &str) -> String {
        let declared = self.modes.iter().map(|mode| mode.name).filter(|name| self.declares(name));
        let near = declared.map(|other| (distance(name, other), other)).min_by_key(|near| near.0);
        let most = (name.chars().count() / 3).max(1);
        match near.filter(|near| near.0 <= most) {
            Some((_, other)) => format!("did you mean {other:?}? If not, declare it with Hybrid::mode"),
            None => "declare it with Hybrid::mode".into(),
        }
    }

    /// Looks for the very name first, which is what a run mostly has: to compare letters takes longer than many a guard.
    #[inline]
    fn find(&self, name: &str) -> Option<&Mode<'a, S>> {
        let same = self.modes.iter().find(|mode| std::ptr::eq(mode.name, name));
        same.or_else(|| self.modes.iter().find(|mode| mode.name == name))
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
        let mode = self.find(mode);
        if let Some(flow) = mode.and_then(|mode| mode.flow.as_ref()) {
            return flow(t, x);
        }
        match mode.and_then(|mode| mode.exact.as_ref()) {
            // The solution's slope where it starts.
            Some(solution) => solution(t, x).coefficients().get(1).copied().unwrap_or_else(|| x.with(|_| 0.0)),
            None => x.with(|_| f64::NAN),
        }
    }

    fn edges(&self, mode: &'static str) -> Edges<'_, Link> {
        self.find(mode).map_or(Edges::none(), |mode| Edges::kept(&mode.guarded))
    }

    fn guard(&self, edge: Link, t: f64, x: &S) -> f64 {
        self.edge_of(edge).and_then(|edge| edge.guard.as_ref()).map_or(f64::NAN, |guard| guard(t, x))
    }

    fn clocks(&self, mode: &'static str) -> Clocks<'_, Link> {
        self.find(mode).map_or(Clocks::none(), |mode| Clocks::kept(&mode.clocks))
    }

    fn reset(&self, _: &'static str, link: Link, t: f64, x: &S) -> Result<(&'static str, S), Refusal> {
        let edge = self.edge_of(link).ok_or_else(|| Refusal::new("there is no such edge"))?;
        Ok((link.to, (edge.reset)(t, x)))
    }

    fn about(&self, edge: Link) -> About {
        self.edge_of(edge).map_or(About::new(), |edge| edge.about)
    }

    fn solution(&self, mode: &'static str, t: f64, x: &S) -> Solution<Self> {
        match self.find(mode) {
            Some(Mode { exact: Some(solution), .. }) => Solution::Polynomial(solution(t, x)),
            Some(Mode { series: Some(_), .. }) => Solution::Series(Self::expand),
            _ => Solution::Steps,
        }
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(&'static str, S)> {
        let (to, reset) = self.find(limit.mode)?.beyond.as_ref()?;
        Some((to, reset(limit.t, limit.x)))
    }

    fn validate(&self, mode: &'static str) -> Result<(), String> {
        if !self.declares(mode) {
            return Err(format!("the automaton has no mode {mode:?}: {}", self.declare(mode)));
        }
        self.flaw.get_or_init(|| self.find_flaw()).as_ref().map_or(Ok(()), |flaw| Err(flaw.clone()))
    }
}

impl<S: State> Hybrid<'_, S> {
    fn expand(&self, mode: &'static str, series: &mut Series<'_, S>) {
        if let Some(flow) = self.find(mode).and_then(|mode| mode.series.as_ref()) {
            flow(series);
        }
    }

    /// What keeps every run from starting.
    fn find_flaw(&self) -> Option<String> {
        if let Some((method, name)) = self.twice {
            return Some(format!(
                "Hybrid::{method} says twice what holds in mode {name:?}: say it once, or give one of them its own name"
            ));
        }
        for mode in &self.modes {
            let name = mode.name;
            if !self.declares(name) {
                let what = if mode.edges.is_empty() { "is named" } else { "has an edge" };
                return Some(format!("mode {name:?} {what} but is not declared: {}", self.declare(name)));
            }
            if let Some((link, edge)) = Self::links(mode).find(|(_, edge)| !self.declares(edge.to)) {
                let to = self.declare(edge.to);
                return Some(format!("edge {link:?} leads to mode {:?}, which is not declared: {to}", edge.to));
            }
            if let Some((to, _)) = mode.beyond.as_ref().filter(|(to, _)| !self.declares(to)) {
                let declare = self.declare(to);
                return Some(format!("beyond a limit in {name:?} lies mode {to:?}, which is not declared: {declare}"));
            }
            for (clock, link) in &mode.clocks {
                if let Err(flaw) = clock.validate() {
                    return Some(format!("the clock of edge {link:?} {flaw}"));
                }
            }
        }
        let (method, from, to) = self.misses.first()?;
        Some(format!(
            "Hybrid::{method} is about an edge {from} -> {to} that was not declared before it: declare it first, or mend the names"
        ))
    }
}

impl<S: State> Invertible for Hybrid<'_, S> {
    fn edges_into(&self, mode: &'static str) -> Edges<'_, Link> {
        let links = self.modes.iter().flat_map(Self::links);
        links.filter(|(link, edge)| link.to == mode && !edge.about.terminal).map(|(link, _)| link).collect()
    }

    fn image(&self, edge: Link, t: f64, x: &S) -> f64 {
        let inverse = self.edge_of(edge).and_then(|edge| edge.inverse.as_ref());
        inverse.map_or(f64::NAN, |(image, _)| image(t, x))
    }

    fn undo(&self, edge: Link, t: f64, x: &S) -> (&'static str, S) {
        let inverse = self.edge_of(edge).and_then(|edge| edge.inverse.as_ref());
        (edge.from, inverse.map_or_else(|| x.with(|_| f64::NAN), |(_, undo)| undo(t, x)))
    }

    /// Looks at every edge that a run backwards from `mode` could meet.
    fn validate_backwards(&self, mode: &'static str) -> Result<(), String> {
        let mut met = vec![mode];
        let mut next = 0;
        while let Some(&mode) = met.get(next) {
            next += 1;
            let into = || self.modes.iter().flat_map(Self::links).filter(move |(link, _)| link.to == mode);
            for (link, edge) in into().filter(|(_, edge)| !edge.about.terminal) {
                if edge.inverse.is_none() {
                    return Err(format!(
                        "edge {link:?} has no inverse, so that a run cannot go backwards into mode {:?}: give one with Hybrid::inverse",
                        link.from
                    ));
                }
                if !met.contains(&link.from) {
                    met.push(link.from);
                }
            }
        }
        Ok(())
    }
}

/// How many characters must be changed, added, left out or exchanged with their neighbour to make one name of another
/// (optimal string alignment).
fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut rows = [Vec::new(), (0..=other.len()).collect::<Vec<_>>()];
    let mut last = None;
    for (i, c) in one.chars().enumerate() {
        let mut row = vec![i + 1];
        for (j, &d) in other.iter().enumerate() {
            let [before, above] = &rows;
            let mut least = (above[j] + usize::from(c != d)).min(above[j + 1] + 1).min(row[j] + 1);
            if j > 0 && i > 0 && Some(d) == last && other[j - 1] == c {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        let [_, above] = rows;
        rows = [above, row];
        last = Some(c);
    }
    rows[1][other.len()]
}
