//! An automaton of traced and called functions, with its parameters as numbers.

use std::sync::Arc;

use pyo3::prelude::*;
use saltus::{
    About, Automaton, Clock, Clocks, Coords, Edges, Entry, Fall, Filippov, Formula, Lift, Limit, Linearize, Number,
    Over, Passage, Polynomial, Refusal, Series, Side, Solution,
};

use super::called::{Called, Raised};
use super::names::{Edge, Mode};
use super::slide::{Pair, SlideOf};
use super::tape::Tape;

/// How many parameters a model may have.
pub(crate) const MOST_PARAMETERS: usize = 64;

/// How many coordinates a guard or a reset that is called is handed without asking for room.
const FEW: usize = 16;

/// The state of a model: a list of coordinates whose length a program sets as it runs.
pub(crate) trait Vector: Lift + Send + Sync + 'static {
    fn of(values: &[f64]) -> Option<Self>;

    fn list(&self) -> Vec<f64> {
        (0..self.len()).map(|i| self.get(i)).collect()
    }
}

impl Vector for [f64; 2] {
    fn of(values: &[f64]) -> Option<Self> {
        values.try_into().ok()
    }
}

impl<const CAP: usize> Vector for Coords<CAP> {
    fn of(values: &[f64]) -> Option<Self> {
        values.try_into().ok()
    }
}

/// A function as it is given.
pub(crate) enum Function {
    Traced(Arc<Tape>),
    Called(Called),
}

impl Function {
    pub(crate) fn clone_ref(&self, py: Python<'_>) -> Self {
        match self {
            Self::Traced(tape) => Self::Traced(Arc::clone(tape)),
            Self::Called(called) => Self::Called(called.clone_ref(py)),
        }
    }
}

/// A function with its parameters bound.
struct Ready {
    /// As it is given: for numbers that carry a derivative by a parameter.
    given: Function,
    bound: Option<Tape>,
}

impl Ready {
    fn new(given: Function, p: &[f64]) -> Self {
        let bound = match &given {
            Function::Traced(tape) => Some(tape.bound(p)),
            Function::Called(_) => None,
        };
        Self { given, bound }
    }

    /// The same over numbers that carry a derivative; a function that is called has none.
    fn over<D: Number>(&self, t: D, x: impl Fn(usize) -> D, p: impl Fn(usize) -> D, mut out: impl FnMut(usize, D)) {
        match &self.given {
            Function::Traced(tape) => tape.run(t, x, p, out),
            Function::Called(_) => out(0, D::from(f64::NAN)),
        }
    }
}

/// An edge as it is given.
pub(crate) struct EdgeOf {
    pub(crate) to: Mode,
    pub(crate) guard: Function,
    pub(crate) reset: Option<Function>,
    pub(crate) entry: Entry,
    pub(crate) terminal: bool,
}

/// An edge that a clock takes, as it is given.
pub(crate) struct ClockOf {
    pub(crate) to: Mode,
    pub(crate) clock: Clock,
    pub(crate) reset: Option<Function>,
}

/// A mode as it is given.
pub(crate) struct ModeOf {
    pub(crate) mode: Mode,
    /// None of one that slides.
    pub(crate) flow: Option<Function>,
    pub(crate) edges: Vec<EdgeOf>,
    pub(crate) clocks: Vec<ClockOf>,
    pub(crate) beyond: Option<(Mode, Option<Function>)>,
}

/// What takes an edge.
enum Taken {
    By(Ready),
    /// A passage of a surface, by its place.
    Passage(usize, Passage),
    /// A clock.
    Ticking,
}

struct ReadyEdge {
    id: Edge,
    taken: Taken,
    reset: Option<Ready>,
    about: About,
    /// The row a and the constant b of an affine guard a·x + b.
    affine: Option<(Vec<f64>, f64)>,
}

struct ReadyMode {
    /// None of one that slides, along the surface at a place.
    flow: Result<Ready, usize>,
    /// Those with guards, then those that clocks take.
    edges: Vec<ReadyEdge>,
    clocks: Vec<(Clock, Edge)>,
    beyond: Option<(Mode, Option<Ready>)>,
    /// The rows of A, where x' = A x + b with A³ = 0.
    nilpotent: Option<Vec<Vec<f64>>>,
    series: Option<Formula>,
}

/// A model with its parameters, for states of one kind.
pub(crate) struct Model<S> {
    modes: Vec<ReadyMode>,
    slides: Vec<SlideOf>,
    p: Vec<f64>,
    /// The same for functions that are called.
    named: Option<Py<PyAny>>,
    pub(crate) raised: Raised,
    /// A state of the model's dimension.
    like: S,
}

/// Whether x' = A x + b comes to an end as a polynomial of degree three: A³ = 0.
fn is_nilpotent(a: &[Vec<f64>]) -> bool {
    let times = |x: &[f64]| -> Vec<f64> { a.iter().map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect() };
    (0..a.len()).all(|j| {
        let column: Vec<f64> = a.iter().map(|row| row[j]).collect();
        times(&times(&column)).iter().all(|value| *value == 0.0)
    })
}

impl<S: Vector> Model<S> {
    /// A model whose states are like this one; `stepped`: neither solved nor expanded in series.
    pub(crate) fn new(
        (modes, slides): (Vec<ModeOf>, Vec<SlideOf>),
        like: S,
        p: Vec<f64>,
        named: Option<Py<PyAny>>,
        stepped: bool,
    ) -> Self {
        let n = like.len();
        let ready = |function: Function| Ready::new(function, &p);
        let made = modes.into_iter().map(|ModeOf { mode, flow, edges, clocks, beyond }| {
            let along = slides.iter().position(|slide| slide.sliding == mode);
            let flow = flow.map(ready).ok_or(along.unwrap_or_default());
            let mut all = Vec::new();
            let place = |all: &Vec<ReadyEdge>, to: Mode| Edge { from: mode, to, place: all.len() as u32 };
            for edge in edges {
                let guard = ready(edge.guard);
                let affine = guard.bound.as_ref().and_then(|tape| tape.affine(n)?.pop());
                let about = About::new().entry(edge.entry).terminal_if(edge.terminal);
                let about = about.affine_if(affine.is_some());
                let (id, reset) = (place(&all, edge.to), edge.reset.map(ready));
                all.push(ReadyEdge { id, taken: Taken::By(guard), reset, about, affine });
            }
            for (at, slide) in slides.iter().enumerate() {
                for (passage, to) in slide.side(mode).map(|side| slide.passages(side)).unwrap_or_default() {
                    let (id, affine, about) = (place(&all, to), slide.guard(passage), About::new());
                    all.push(ReadyEdge { id, taken: Taken::Passage(at, passage), reset: None, about, affine });
                }
            }
            let mut ticking = Vec::new();
            for clock in clocks {
                let (id, reset) = (place(&all, clock.to), clock.reset.map(ready));
                ticking.push((clock.clock, id));
                all.push(ReadyEdge { id, taken: Taken::Ticking, reset, about: About::new(), affine: None });
            }
            let bound = flow.as_ref().ok().and_then(|flow| flow.bound.as_ref()).filter(|_| !stepped);
            let linear = bound.and_then(|tape| tape.affine(n));
            let rows = linear.map(|rows| rows.into_iter().map(|(row, _)| row).collect::<Vec<_>>());
            let nilpotent = rows.filter(|rows| is_nilpotent(rows));
            let series = bound.filter(|_| nilpotent.is_none()).and_then(|tape| tape.formula(n));
            let beyond = beyond.map(|(to, reset)| (to, reset.map(ready)));
            ReadyMode { flow, edges: all, clocks: ticking, beyond, nilpotent, series }
        });
        let modes = made.collect();
        Self { modes, slides, p, named, raised: Raised::default(), like }
    }

    fn sides<'a>(&'a self, slide: &'a SlideOf) -> Filippov<Pair<'a, Self>> {
        Pair::of(slide, self, &self.like)
    }

    /// The flow of a mode, which does not slide.
    fn flow_of(&self, mode: Mode, t: f64, x: &S) -> S {
        self.mode(mode).flow.as_ref().map_or_else(|_| x.with(|_| f64::NAN), |flow| self.vector(flow, t, x))
    }

    fn mode(&self, mode: Mode) -> &ReadyMode {
        &self.modes[mode.place as usize]
    }

    fn edge(&self, edge: Edge) -> &ReadyEdge {
        &self.mode(edge.from).edges[edge.place as usize]
    }

    /// What a function comes to, output by output.
    #[inline]
    fn run(&self, function: &Ready, t: f64, x: &S, out: impl FnMut(usize, f64)) {
        match (&function.bound, &function.given) {
            (Some(tape), _) => tape.run(t, |i| x.get(i), |i| self.p[i], out),
            (None, Function::Called(called)) => {
                let (mut few, n) = ([0.0; FEW], x.len());
                let named = self.named.as_ref();
                if n > FEW {
                    return called.run(t, &x.list(), named, &self.raised, out);
                }
                few.iter_mut().zip(0..n).for_each(|(place, i)| *place = x.get(i));
                called.run(t, &few[..n], named, &self.raised, out);
            }
            (None, Function::Traced(_)) => {}
        }
    }

    #[inline]
    fn vector(&self, function: &Ready, t: f64, x: &S) -> S {
        if x.len() <= FEW {
            let mut list = [f64::NAN; FEW];
            self.run(function, t, x, |i, value| list[i % FEW] = value);
            return x.with(|i| list[i % FEW]);
        }
        let mut list = vec![f64::NAN; x.len()];
        self.run(function, t, x, |i, value| list[i] = value);
        x.with(|i| list[i])
    }

    fn vector_over<D: Number>(&self, function: &Ready, t: D, x: &Over<S, D>, p: &[D]) -> Over<S, D> {
        let (mut list, like) = (vec![D::from(f64::NAN); self.like.len()], &self.like);
        function.over(t, |i| like.pick(x, i), |i| p[i], |i, value| list[i] = value);
        like.lift(|i| list[i])
    }

    /// The coefficients of the state as a polynomial in time, where it is one.
    #[inline]
    fn polynomial(&self, mode: Mode, t: f64, x: &S) -> Option<[S; 4]> {
        let of = self.mode(mode);
        let rows = of.nilpotent.as_ref()?;
        let times = |x: &S, by: f64| x.with(|i| by * rows[i].iter().zip(0..).map(|(a, j)| a * x.get(j)).sum::<f64>());
        let first = self.flow_of(mode, t, x);
        let second = times(&first, 0.5);
        let third = times(&second, 1.0 / 3.0);
        Some([x.clone(), first, second, third])
    }

    fn series(&self, mode: Mode, series: &mut Series<'_, S>) {
        if let Some(formula) = &self.mode(mode).series {
            series.formula(formula);
        }
    }

    fn refused(&self) -> Result<(), Refusal> {
        self.raised.says().map_or(Ok(()), |says| Err(Refusal::new(says)))
    }
}

impl<S: Vector> Automaton for Model<S> {
    type Mode = Mode;
    type State = S;
    type Edge = Edge;

    fn flow(&self, mode: Mode, t: f64, x: &S) -> S {
        match &self.mode(mode).flow {
            Ok(flow) => self.vector(flow, t, x),
            Err(slide) => self.sides(&self.slides[*slide]).flow(Side::Sliding, t, x),
        }
    }

    fn edges(&self, mode: Mode) -> Edges<'_, Edge> {
        let of = self.mode(mode);
        of.edges[..of.edges.len() - of.clocks.len()].iter().map(|edge| edge.id).collect()
    }

    fn clocks(&self, mode: Mode) -> Clocks<'_, Edge> {
        Clocks::kept(&self.mode(mode).clocks)
    }

    fn validate(&self, mode: Mode, t: f64, x: &S) -> Result<(), String> {
        let mut sides = self.slides.iter().filter_map(|slide| Some((slide, slide.side(mode)?)));
        sides.try_for_each(|(slide, side)| self.sides(slide).validate(side, t, x))
    }

    fn guard(&self, edge: Edge, t: f64, x: &S) -> f64 {
        match &self.edge(edge).taken {
            Taken::By(guard) => {
                let mut value = f64::NAN;
                self.run(guard, t, x, |_, guard| value = guard);
                value
            }
            Taken::Passage(slide, passage) => self.sides(&self.slides[*slide]).guard(*passage, t, x),
            Taken::Ticking => f64::NAN,
        }
    }

    fn reset(&self, _: Mode, edge: Edge, t: f64, x: &S) -> Result<(Mode, S), Refusal> {
        if let Taken::Passage(slide, passage) = self.edge(edge).taken {
            let slide = &self.slides[slide];
            let from = slide.side(edge.from).unwrap_or(Side::Sliding);
            let (side, after) = self.sides(slide).reset(from, passage, t, x)?;
            self.refused()?;
            return Ok((slide.mode(side), after));
        }
        let after = self.edge(edge).reset.as_ref().map_or_else(|| x.clone(), |reset| self.vector(reset, t, x));
        self.refused()?;
        Ok((edge.to, after))
    }

    fn about(&self, edge: Edge) -> About {
        match self.edge(edge).taken {
            Taken::Passage(slide, passage) => self.sides(&self.slides[slide]).about(passage),
            _ => self.edge(edge).about,
        }
    }

    fn solution(&self, mode: Mode, t: f64, x: &S) -> Solution<Self> {
        if let Some(solution) = self.polynomial(mode, t, x) {
            let is_parabola = (0..x.len()).all(|i| solution[3].get(i) == 0.0);
            let [c0, c1, c2, _] = solution.clone();
            return Solution::Polynomial(if is_parabola { [c0, c1, c2].into() } else { solution.into() });
        }
        let of = self.mode(mode);
        if of.series.is_some() { Solution::Series(Self::series) } else { Solution::Steps }
    }

    /// The root of an affine guard on a parabola: that to which its value falls.
    fn falls(&self, mode: Mode, edge: Edge, t: f64, x: &S) -> Fall<S> {
        let Some((row, rest)) = &self.edge(edge).affine else { return Fall::Unknown };
        let Some(solution) = self.polynomial(mode, t, x) else { return Fall::Unknown };
        let along = |c: &S| row.iter().zip(0..).map(|(a, i)| a * c.get(i)).sum::<f64>();
        let [c0, c1, c2, c3] = solution.each_ref().map(along);
        let c0 = c0 + rest;
        if c0 < 0.0 || c3 != 0.0 || c2 > 0.0 {
            return Fall::Unknown;
        }
        if c2 == 0.0 && c1 >= 0.0 {
            return Fall::Never;
        }
        let root = (c1 * c1 - 4.0 * c2 * c0).sqrt();
        let s = if c1 > 0.0 { (c1 + root) / (-2.0 * c2) } else { 2.0 * c0 / (root - c1) };
        if s > 0.0 && s.is_finite() { Fall::After(s) } else { Fall::Unknown }
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Mode, S)> {
        let (to, reset) = self.mode(limit.mode).beyond.as_ref()?;
        Some((*to, reset.as_ref().map_or_else(|| limit.x.clone(), |reset| self.vector(reset, limit.t, limit.x))))
    }

    fn refusal(&self, _: Mode, _: Option<Edge>, _: f64, _: &S) -> Option<Refusal> {
        self.refused().err()
    }
}

impl<S: Vector> Linearize for Model<S> {
    type Parameters = Coords<MOST_PARAMETERS>;

    fn parameters(&self) -> Self::Parameters {
        // As many as there is room for: see `Hybrid`.
        self.p[..self.p.len().min(MOST_PARAMETERS)].try_into().unwrap_or_else(|_| [0.0].into())
    }

    fn flow_over<D: Number>(&self, mode: Mode, t: D, x: Over<S, D>, p: [D; MOST_PARAMETERS]) -> Over<S, D> {
        match &self.mode(mode).flow {
            Ok(flow) => self.vector_over(flow, t, &x, &p),
            Err(slide) => self.sides(&self.slides[*slide]).flow_over(Side::Sliding, t, x, p),
        }
    }

    fn guard_over<D: Number>(&self, edge: Edge, t: D, x: Over<S, D>, p: [D; MOST_PARAMETERS]) -> D {
        let (mut value, like) = (D::from(f64::NAN), &self.like);
        match &self.edge(edge).taken {
            Taken::By(guard) => guard.over(t, |i| like.pick(&x, i), |i| p[i], |_, guard| value = guard),
            Taken::Passage(slide, passage) => {
                value = self.sides(&self.slides[*slide]).guard_over(*passage, t, x, p);
            }
            Taken::Ticking => {}
        }
        value
    }

    fn reset_over<D: Number>(&self, edge: Edge, t: D, x: Over<S, D>, p: [D; MOST_PARAMETERS]) -> Over<S, D> {
        match &self.edge(edge).reset {
            Some(reset) => self.vector_over(reset, t, &x, &p),
            None => x,
        }
    }

    fn beyond_over<D: Number>(&self, mode: Mode, t: D, x: Over<S, D>, p: [D; MOST_PARAMETERS]) -> Option<Over<S, D>> {
        let (_, reset) = self.mode(mode).beyond.as_ref()?;
        Some(reset.as_ref().map_or(x, |reset| self.vector_over(reset, t, &x, &p)))
    }

    /// Clocks are numbers: no parameter moves them.
    fn tick_over<D: Number>(&self, _: Mode, _: Edge, t: f64, _: [D; MOST_PARAMETERS]) -> Option<D> {
        Some(D::from(t))
    }

    fn surface_over<D: Number>(&self, mode: Mode, t: D, x: Over<S, D>, p: [D; MOST_PARAMETERS]) -> Option<D> {
        let slide = self.mode(mode).flow.as_ref().err()?;
        self.sides(&self.slides[*slide]).surface_over(Side::Sliding, t, x, p)
    }

    fn exact_over<D: Number>(
        &self,
        mode: Mode,
        t: D,
        x: Over<S, D>,
        p: [D; MOST_PARAMETERS],
    ) -> Option<Polynomial<Over<S, D>>> {
        let (of, like) = (self.mode(mode), &self.like);
        of.nilpotent.as_ref()?;
        let given = of.flow.as_ref().ok()?;
        let flow = |x: &Over<S, D>| self.vector_over(given, t, x, &p);
        let rest = flow(&like.lift(|_| D::zero()));
        // A v is the flow at v, less that at zero.
        let times = |v: &Over<S, D>, by: f64| {
            let at = flow(v);
            like.lift(|i| (like.pick(&at, i) - like.pick(&rest, i)) * D::from(by))
        };
        let first = flow(&x);
        let second = times(&first, 0.5);
        Some([x, first, second, times(&second, 1.0 / 3.0)].into())
    }
}
