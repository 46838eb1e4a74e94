//! Forward sensitivities as an automaton of its own: the state together with its derivatives.

use std::borrow::Cow;

use num_dual::Dual64;

use super::passage::Passage;
use super::{Linearize, moving, moving_in, velocity};
use crate::automaton::clocks::{Clock, Clocks};
use crate::automaton::edges::Edges;
use crate::automaton::solution::{Fall, Polynomial, Solution};
use crate::automaton::{About, Automaton, Entry, Limit};
use crate::certainty::TINY;
use crate::error::{ErrorKind, Refusal};
use crate::jump::JumpOf;
use crate::state::State;

/// What a derivative is taken with respect to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrt {
    /// A coordinate of the initial state, by its place.
    Initial(usize),
    /// A parameter, by its place in [`Linearize::parameters`].
    Parameter(usize),
}

/// A state together with its derivatives with respect to K numbers q₁ … `q_K`.
///
/// Its coordinates are those of `x`, then those of each column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent<S, const K: usize> {
    /// The state.
    pub x: S,
    /// Column k is `∂x/∂q_k` at fixed time, in the unit of the state by that of `q_k`.
    pub columns: [S; K],
    /// How the time of the last jump depends on `q_k`, `dt*/dq_k`, in seconds by the unit of `q_k`;
    /// zero before the first.
    pub dt: [f64; K],
    /// When that was, or when the run started.
    jumped: f64,
    /// Whether nothing has come since the columns were given.
    given: bool,
}

impl<S: State, const K: usize> State for Tangent<S, K> {
    #[inline]
    fn len(&self) -> usize {
        self.x.len() * (K + 1)
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        let n = self.x.len();
        if i < n { self.x.get(i) } else { self.columns[i / n - 1].get(i % n) }
    }
    #[inline]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        let n = self.x.len();
        let x = self.x.with(&mut f);
        let (mut columns, mut k) = (self.columns.clone(), 0);
        while k < columns.len() {
            columns[k] = columns[k].with(|i| f(n * (k + 1) + i));
            k += 1;
        }
        Self { x, columns, dt: self.dt, jumped: self.jumped, given: self.given }
    }
    /// That of the state; `voltage by q1` in the column of q₁.
    fn name(&self, i: usize) -> Cow<'static, str> {
        let n = self.x.len();
        let name = self.x.name(i % n);
        if i < n { name } else { format!("{name} by q{}", i / n).into() }
    }
    /// That of the state; in a column none, for it depends on that of q.
    fn unit(&self, i: usize) -> &'static str {
        if i < self.x.len() { self.x.unit(i) } else { "" }
    }
}

/// An automaton and the derivatives of its runs with respect to initial values and parameters, as
/// one automaton.
///
/// Modes, edges, guards and the state `x` are those of `A`; beside `x` stand K columns S = ∂x/∂q
/// ([`Tangent`]):
///
/// - along an arc `S' = f_x S + f_q`, the variational equation, each column by one dual number;
/// - at a jump S⁺ = Ξ S⁻ + …, the [`saltation`](super::saltation), and the derivative of the jump's
///   time `dt*/dq = -(g_x S⁻ + g_q)/(g_t + g_x f⁻)`, which [`Tangent::dt`] keeps until the next
///   jump;
/// - at a Zeno limit dt∞/dq = lim dt*ₙ/dq, which the contraction of the durations brings to
///   rounding together with the limit itself.
///
/// Stepping, crossings, hybrid time and Zeno limits are the engine's, as for any automaton. Where
/// `A` has exact arcs and [`Linearize::exact_over`], no step is taken and the events are those of a
/// run without derivatives to the bit. Elsewhere the columns take part in the control of the step
/// size: the tolerance holds for them too, and steps may differ from those of a run without them.
///
/// ```
/// # use saltus::nalgebra::{self, Vector2, vector};
/// # use saltus::{Automaton, Edges, Linearize, Number, Refusal};
/// # struct Ball { gravity: f64, cor: f64 }
/// # impl Linearize for Ball {
/// #     type Parameters = [f64; 2];
/// #     fn parameters(&self) -> [f64; 2] { [self.gravity, self.cor] }
/// #     fn flow_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], [g, _]: [D; 2]) -> [D; 2] { [v, -g] }
/// #     fn guard_over<D: Number>(&self, _: (), _t: D, [y, _]: [D; 2], _: [D; 2]) -> D { y }
/// #     fn reset_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], [_, e]: [D; 2]) -> [D; 2] { [D::zero(), -e * v] }
/// # }
/// # impl Automaton for Ball {
/// #     type Mode = ();
/// #     type State = Vector2<f64>;
/// #     type Edge = ();
/// #     fn flow(&self, mode: (), t: f64, x: &Vector2<f64>) -> Vector2<f64> { self.flow_at(mode, t, x) }
/// #     fn edges(&self, _: ()) -> Edges<'_, ()> { Edges::from([()]) }
/// #     fn guard(&self, edge: (), t: f64, x: &Vector2<f64>) -> f64 { self.guard_at(edge, t, x) }
/// #     fn reset(&self, _: (), edge: (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
/// #         Ok(((), self.reset_at(edge, t, x)))
/// #     }
/// # }
/// use saltus::{Sensitive, Simulation, Stop, Wrt};
///
/// // `Ball` is the example at `Linearize`: parameters g and e, here dropped from 2 m.
/// let ball = Ball { gravity: 9.81, cor: 0.8 };
/// let sensitive = Sensitive::of(&ball, [Wrt::Parameter(1), Wrt::Initial(0)]); // by e, by the height
/// let run = Simulation::of(&sensitive).run((), sensitive.start(0.0, vector![2.0, 0.0]), 0.0..10.0)?;
///
/// // The first impact is at t₁ = √(2h/g), the second at (1 + 2e) t₁.
/// let t1 = (2.0 * 2.0 / 9.81_f64).sqrt();
/// let second = &run.trajectory.jumps()[1];
/// assert!((second.after.dt[0] - 2.0 * t1).abs() < 1e-9);
/// assert!((second.after.dt[1] - 2.6 * t1 / (2.0 * 2.0)).abs() < 1e-9);
///
/// // It lies still at (1 + e)/(1 - e) t₁, and that moves by 2/(1 - e)² t₁ with e.
/// assert!(matches!(run.end.stop, Stop::Zeno { limit } if (limit - 9.0 * t1).abs() < 1e-8));
/// assert!((run.end.state.dt[0] - 50.0 * t1).abs() < 1e-6);
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// A jump that the guard reaches without speed has no derivative: the run fails there with
/// [`ErrorKind::Grazing`].
#[derive(Debug)]
pub struct Sensitive<'a, A, const K: usize> {
    automaton: &'a A,
    wrt: [Wrt; K],
}

impl<A, const K: usize> Clone for Sensitive<'_, A, K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A, const K: usize> Copy for Sensitive<'_, A, K> {}

impl<'a, A: Linearize, const K: usize> Sensitive<'a, A, K> {
    /// `automaton` with a column for each of `wrt`.
    #[must_use]
    pub const fn of(automaton: &'a A, wrt: [Wrt; K]) -> Self {
        Self { automaton, wrt }
    }

    /// The start of a run from `x` at time `t`: unit columns for initial values, zeros for
    /// parameters.
    ///
    /// Where the initial state depends on a parameter, add that to the column. From a coordinate or
    /// parameter that there is not, whose column is NaN, a run refuses to start.
    pub fn start(&self, t: f64, x: A::State) -> Tangent<A::State, K> {
        let parameters = self.automaton.parameters().len();
        let columns = self.wrt.map(|wrt| match wrt {
            Wrt::Initial(k) if k < x.len() => x.with(|i| if i == k { 1.0 } else { 0.0 }),
            Wrt::Parameter(k) if k < parameters => x.with(|_| 0.0),
            _ => x.with(|_| f64::NAN),
        });
        Tangent { x, columns, dt: [0.0; K], jumped: t, given: true }
    }

    /// How the state x⁻ just before the jump depends on each q as the jump moves in time, dx⁻/dq =
    /// S⁻ + f⁻ dt*/dq: the derivative of "the speed at the third impact", where the columns are
    /// that of the state at a fixed time.
    pub fn before(&self, jump: &JumpOf<Self>) -> [A::State; K] {
        self.riding(jump.from, jump.t(), &jump.before, &jump.after.dt)
    }

    /// The same for the state x⁺ just after the jump, dx⁺/dq = S⁺ + f⁺ dt*/dq.
    pub fn after(&self, jump: &JumpOf<Self>) -> [A::State; K] {
        self.riding(jump.to, jump.t(), &jump.after, &jump.after.dt)
    }

    fn riding(&self, mode: A::Mode, t: f64, x: &Tangent<A::State, K>, dt: &[f64; K]) -> [A::State; K] {
        let flow = self.automaton.flow(mode, t, &x.x);
        std::array::from_fn(|k| x.columns[k].with(|i| x.columns[k].get(i) + flow.get(i) * dt[k]))
    }

    /// Which parameter column `k` is by, if it is by one.
    #[inline]
    fn parameter(&self, k: usize) -> Option<usize> {
        match self.wrt[k] {
            Wrt::Parameter(p) => Some(p),
            Wrt::Initial(_) => None,
        }
    }

    /// Whether column `k` leads off the surface that the states of `mode` keep to, by more than
    /// rounding.
    fn leaves(&self, mode: A::Mode, t: f64, x: &Tangent<A::State, K>, k: usize) -> bool {
        let p = self.automaton.parameters();
        let slope = |column: &A::State, by: Option<usize>| {
            let surface = self.automaton.surface_over(mode, Dual64::from(t), moving(&x.x, column), moving_in(&p, by));
            surface.map_or(0.0, |h| h.eps)
        };
        let column = &x.columns[k];
        let part = |i: usize| slope(&column.with(|j| if i == j { column.get(i) } else { 0.0 }), None).abs();
        let by_parameter = slope(&column.with(|_| 0.0), self.parameter(k));
        let size = (0..x.x.len()).map(part).sum::<f64>() + by_parameter.abs();
        slope(column, self.parameter(k)).abs() > TINY * size
    }

    /// The derivatives of a polynomial's coefficients at fixed t are the coefficients of the
    /// columns.
    fn polynomial(&self, mode: A::Mode, t: f64, x: &Tangent<A::State, K>) -> Option<Polynomial<Tangent<A::State, K>>> {
        let Solution::Polynomial(solution) = self.automaton.solution(mode, t, &x.x) else { return None };
        let p = self.automaton.parameters();
        let columns: [_; K] = std::array::from_fn(|k| {
            let parameters = moving_in(&p, self.parameter(k));
            self.automaton.exact_over(mode, Dual64::from(t), moving(&x.x, &x.columns[k]), parameters)
        });
        if columns.iter().any(Option::is_none) {
            return None;
        }
        Some(solution.map(|power, c| {
            let columns = std::array::from_fn(|k| {
                let column = columns[k].as_ref().and_then(|column| column.coefficients().get(power));
                column.map_or_else(|| c.with(|_| 0.0), |column| velocity(column, c))
            });
            Tangent { x: c.clone(), columns, dt: x.dt, jumped: x.jumped, given: x.given }
        }))
    }
}

impl<A: Linearize, const K: usize> Automaton for Sensitive<'_, A, K> {
    type Mode = A::Mode;
    type State = Tangent<A::State, K>;
    type Edge = A::Edge;

    /// `x' = f`, `S' = f_x S + f_q`.
    #[inline]
    fn flow(&self, mode: A::Mode, t: f64, x: &Self::State) -> Self::State {
        let p = self.automaton.parameters();
        let columns = std::array::from_fn(|k| {
            let parameters = moving_in(&p, self.parameter(k));
            let slope = self.automaton.flow_over(mode, Dual64::from(t), moving(&x.x, &x.columns[k]), parameters);
            velocity(&slope, &x.x)
        });
        Tangent { x: self.automaton.flow(mode, t, &x.x), columns, dt: x.dt, jumped: x.jumped, given: x.given }
    }

    fn edges(&self, mode: A::Mode) -> Edges<'_, A::Edge> {
        self.automaton.edges(mode)
    }

    #[inline]
    fn guard(&self, edge: A::Edge, t: f64, x: &Self::State) -> f64 {
        self.automaton.guard(edge, t, &x.x)
    }

    /// The reset of the state, and what it makes of the columns.
    fn reset(&self, mode: A::Mode, edge: A::Edge, t: f64, x: &Self::State) -> Result<(A::Mode, Self::State), Refusal> {
        let passage = Passage::of(self.automaton, mode, edge, t, &x.x)?;
        let duration = t - x.jumped;
        let (grazes, at_once) = (passage.grazes(duration), passage.is_at_once(duration));
        // An edge that fires where the last jump led happens when that jump happens.
        let follows = self.automaton.about(edge).entry == Entry::Fire && passage.is_outside();
        let columns = std::array::from_fn(|_| passage.after.clone());
        let mut after = Tangent { x: passage.after.clone(), columns, dt: x.dt, jumped: t, given: false };
        for (k, column) in x.columns.iter().enumerate() {
            let p = self.parameter(k);
            // So does one that neighbouring runs, too, take at once after the last: a ball that
            // lies lands again, at the end of a Zeno sequence every jump is within rounding of the
            // next.
            let keeps = follows || passage.keeps(x.dt[k], column, p);
            if grazes && !(follows || keeps && at_once) {
                return Err(Refusal::of(ErrorKind::Grazing));
            }
            if !keeps {
                after.dt[k] = passage.delay(column, p)?;
            }
            after.columns[k] = passage.across(column, p, after.dt[k]);
        }
        Ok((passage.to, after))
    }

    #[inline]
    fn about(&self, edge: A::Edge) -> About {
        self.automaton.about(edge)
    }

    fn solution(&self, mode: A::Mode, t: f64, x: &Self::State) -> Solution<Self> {
        self.polynomial(mode, t, x).map_or(Solution::Steps, Solution::Polynomial)
    }

    /// Where the solution is exact, its columns are exact at every time.
    fn falls(&self, mode: A::Mode, edge: A::Edge, t: f64, x: &Self::State) -> Fall<Self::State> {
        match self.automaton.falls(mode, edge, t, &x.x) {
            Fall::Unknown => Fall::Unknown,
            Fall::Never => Fall::Never,
            Fall::After(s) => Fall::After(s),
            Fall::In(s, state) => match self.polynomial(mode, t, x) {
                Some(solution) => Fall::In(s, Tangent { x: state, ..solution.at(s) }),
                None => Fall::Unknown,
            },
        }
    }

    /// At a limit the jumps' times t*ₙ have converged, and so have their derivatives.
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(A::Mode, Self::State)> {
        let &Limit { mode, edges, t, x } = limit;
        let (to, after) = self.automaton.beyond(&Limit::new(mode, edges, t, &x.x))?;
        let (before, onward) = (self.automaton.flow(mode, t, &x.x), self.automaton.flow(to, t, &after));
        let p = self.automaton.parameters();
        let columns = std::array::from_fn(|_| after.clone());
        let mut beyond = Tangent { x: after.clone(), columns, dt: x.dt, jumped: t, given: false };
        for (k, dt) in x.dt.into_iter().enumerate() {
            let carried = x.columns[k].with(|i| x.columns[k].get(i) + before.get(i) * dt);
            let parameters = moving_in(&p, self.parameter(k));
            let landed = self.automaton.beyond_over(mode, Dual64::new(t, dt), moving(&x.x, &carried), parameters)?;
            let landed = velocity(&landed, &after);
            beyond.columns[k] = landed.with(|i| landed.get(i) - onward.get(i) * dt);
        }
        Some((to, beyond))
    }

    #[inline]
    fn clocks(&self, mode: A::Mode) -> Clocks<'_, A::Edge> {
        self.automaton.clocks(mode)
    }

    #[inline]
    fn stops(&self, mode: A::Mode) -> Cow<'_, [Clock]> {
        self.automaton.stops(mode)
    }

    fn refusal(&self, mode: A::Mode, edge: Option<A::Edge>, t: f64, x: &Self::State) -> Option<Refusal> {
        self.automaton.refusal(mode, edge, t, &x.x)
    }

    fn validate(&self, mode: A::Mode, t: f64, x: &Self::State) -> Result<(), String> {
        let count = self.automaton.parameters().len();
        if let Some(p) = (0..K).filter_map(|k| self.parameter(k)).find(|&p| p >= count) {
            return Err(format!("there is no parameter {p}: the model has {count}, counted from 0"));
        }
        let coordinates = x.x.len();
        let initial = self.wrt.iter().filter_map(|wrt| if let Wrt::Initial(i) = wrt { Some(*i) } else { None });
        if let Some(i) = initial.max().filter(|&i| i >= coordinates && !x.is_finite()) {
            return Err(format!("there is no initial coordinate {i}: the state has {coordinates}, counted from 0"));
        }
        let by_parameter = (0..K).any(|k| self.parameter(k).is_some());
        if by_parameter && !self.automaton.stops(mode).is_empty() && !self.automaton.stops_stand(mode) {
            return Err(format!(
                "mode {mode:?} has stops, and whether a parameter moves them is not given: promise that none does with `Linearize::stops_stand`, or make each a clock with `Linearize::tick_over`"
            ));
        }
        self.automaton.validate(mode, t, &x.x)?;
        match (0..K).find(|&k| x.given && self.leaves(mode, t, x, k)) {
            Some(k) => Err(format!(
                "mode {mode:?} keeps to a surface, and {:?} leads off it, where the derivative is another to each side: take it by what leads along the surface, add to its column what keeps the start there (Sensitive::start), or start beside the surface",
                self.wrt[k]
            )),
            None => Ok(()),
        }
    }
}
