//! Return maps: where a run next meets a Poincaré section, its fixed points, their Floquet
//! multipliers, branches and basins.
//!
//! A [`Section`] is an edge of the automaton together with K coordinates q of the states just after
//! it. The [`ReturnMap`] takes q to the coordinates P(q) at the next time that the edge is taken. A
//! periodic run is a fixed point P(q) = q; its Floquet multipliers, the eigenvalues of ∂P/∂q, say
//! whether neighbouring runs come closer (all inside the unit circle) or go away.
//!
//! | | |
//! |---|---|
//! | [`Selection`] | the section that keeps some of the state's own coordinates |
//! | [`ReturnMap::apply`], [`ReturnMap::jacobian`] | P(q) and ∂P/∂q, exact to the tolerance of the run: saltation matrices at each jump |
//! | [`ReturnMap::fixed_point`] | Newton's method: a periodic run with its multipliers |
//! | [`Continuation`] | a branch of periodic runs as a parameter changes: folds, period doublings, grazing |
//! | [`ReturnMap::fates`] | basins of attraction by sampling |
//!
//! Source: Yu. A. Kuznetsov, *Elements of Applied Bifurcation Theory*, Springer 2004, chapters 1, 4
//! and 10; for jumps: M. di Bernardo, C. J. Budd, A. R. Champneys, P. Kowalczyk, *Piecewise-smooth
//! Dynamical Systems*, Springer 2008, chapter 2.

mod basin;
mod continuation;
mod fixed_point;
mod grazing;
mod newton;
mod selection;

pub use basin::Fate;
pub use continuation::{Bifurcation, Branch, Continuation, End, Kind, Point};
pub use fixed_point::FixedPoint;
pub use newton::MapError;
pub use selection::Selection;

use std::fmt;
use std::ops::ControlFlow;

use nalgebra::{DMatrix, SMatrix};
use num_dual::Dual64;

use crate::analysis::linearize::{Lift, Linearize, Number, Over, Sensitive, Wrt};
use crate::automaton::Automaton;
use crate::jump::JumpOf;
use crate::observe::Observer;
use crate::simulation::Simulation;
use crate::state::State;
use crate::step::{Auto, Stepper};

/// A Poincaré section of `A`: an edge, and K coordinates q for the states just after it.
///
/// Coordinates leave out what a return need not repeat or cannot change: a position along the road,
/// an energy that is kept, a velocity that is zero at an apex. [`place`](Self::place) gives the
/// state that belongs to q, [`read`](Self::read) the q of a state; `read(place(q)) = q`. Both are
/// written once over numbers that carry derivatives, like the model itself ([`Linearize`]). Where
/// some coordinates of the state are q, [`Selection`] does it.
///
/// A ball on a table that moves as A sin(ω t), just after it was hit: the table's phase and the
/// ball's velocity.
///
/// ```
/// use std::f64::consts::{PI, TAU};
/// use saltus::nalgebra::Vector2;
/// use saltus::return_map::{ReturnMap, Section};
/// use saltus::{Automaton, Edges, Linearize, Number, Over, Refusal, Simulation};
///
/// struct Table { g: f64, amplitude: f64, omega: f64, cor: f64 }
///
/// impl Linearize for Table {
///     type Parameters = [f64; 0];
///     fn parameters(&self) -> [f64; 0] {
///         []
///     }
///     fn flow_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] {
///         [v, D::from(-self.g)]
///     }
///     fn guard_over<D: Number>(&self, _: (), t: D, [y, _]: [D; 2], _: [D; 0]) -> D {
///         y - (t * self.omega).sin() * self.amplitude
///     }
///     fn reset_over<D: Number>(&self, _: (), t: D, [y, v]: [D; 2], _: [D; 0]) -> [D; 2] {
///         [y, -v * self.cor + (t * self.omega).cos() * (self.amplitude * self.omega * (1.0 + self.cor))]
///     }
/// }
/// # impl Automaton for Table {
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
///
/// struct Impact<'a>(&'a Table);
///
/// impl Section<Table, 2> for Impact<'_> {
///     fn edge(&self) {}
///     fn start(&self) -> ((), Vector2<f64>) {
///         ((), Vector2::zeros())
///     }
///     fn time<D: Number>(&self, [phase, _]: [D; 2], _: [D; 0]) -> D {
///         phase / self.0.omega
///     }
///     fn place<D: Number>(&self, [phase, v]: [D; 2], _: [D; 0]) -> [D; 2] {
///         [phase.sin() * self.0.amplitude, v]
///     }
///     fn read<D: Number>(&self, t: D, [_, v]: [D; 2], _: [D; 0]) -> [D; 2] {
///         [t * self.0.omega - TAU, v] // once per period of the table
///     }
/// }
///
/// let table = Table { g: 9.81, amplitude: 0.0036, omega: 50.0, cor: 0.8 };
/// let map = ReturnMap::of(Simulation::of(&table).tolerance(1e-13), Impact(&table));
/// let orbit = map.fixed_point([1.2, 0.6])?;
///
/// // The ball flies for one period, so that v = g T/2, and is hit where A ω cos φ makes up for what the impact takes.
/// let v: f64 = 0.5 * table.g * TAU / table.omega;
/// let phase = (v * (1.0 - table.cor) / (table.amplitude * table.omega * (1.0 + table.cor))).acos();
/// assert!((orbit.q[0] - phase).abs() < 1e-12 && (orbit.q[1] - v).abs() < 1e-12);
/// // The product of the multipliers is e², whatever the table does.
/// assert!(orbit.multipliers.iter().all(|m| (m.norm() - 0.8).abs() < 1e-9) && orbit.is_stable());
/// # Ok::<(), saltus::return_map::MapError>(())
/// ```
pub trait Section<A: Linearize, const K: usize> {
    /// The edge that is the section.
    fn edge(&self) -> A::Edge;

    /// The mode that the edge leads into, and any state of it: of the state only the number of
    /// coordinates counts.
    fn start(&self) -> (A::Mode, A::State);

    /// When a run starts from `q`, in seconds: of interest where the flow, a guard or a reset
    /// depends on time. The default is zero.
    fn time<D: Number>(&self, q: [D; K], p: Over<A::Parameters, D>) -> D {
        let _ = (q, p);
        D::zero()
    }

    /// The state just after the edge that has the coordinates `q`, the parameters being `p`.
    ///
    /// It enters its mode like the start of any run: no guard may fall from zero there.
    fn place<D: Number>(&self, q: [D; K], p: Over<A::Parameters, D>) -> Over<A::State, D>;

    /// Why the state `x` just after the edge, from which `q` was read, is none that
    /// [`place`](Self::place) gives: then there is no return map, and it says what to do. The
    /// default finds nothing.
    fn flaw(&self, x: &A::State) -> Option<String> {
        let _ = x;
        None
    }

    /// The coordinates of the state `x` just after the edge, taken at `t`. Where a system is
    /// periodic in time, take the periods off.
    fn read<D: Number>(&self, t: D, x: Over<A::State, D>, p: Over<A::Parameters, D>) -> [D; K];
}

/// The return map P of a [`Section`]: from the coordinates just after the edge to those just after
/// it is taken the next time.
///
/// What a run may cost, its tolerance and its stepper are those of the [`Simulation`]; besides, a
/// return may take at most 10⁵ steps and 10⁴ jumps. An example is at [`Section`].
pub struct ReturnMap<'a, A, X, const K: usize, M = Auto> {
    simulation: Simulation<'a, A, M>,
    section: X,
    returns: usize,
}

impl<A, X: fmt::Debug, const K: usize, M: fmt::Debug> fmt::Debug for ReturnMap<'_, A, X, K, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { simulation, section, returns } = self;
        let mut shown = f.debug_struct("ReturnMap");
        shown.field("simulation", simulation).field("section", section).field("returns", returns).finish()
    }
}

/// Where a run came back to the section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Return<const K: usize> {
    /// The coordinates, P(q).
    pub q: [f64; K],
    /// How long it took, in seconds.
    pub duration: f64,
}

/// P at a place, and what it is there to first order along C directions.
pub(crate) struct Linear<E, const K: usize, const C: usize> {
    pub(crate) image: Return<K>,
    pub(crate) columns: [[f64; K]; C],
    /// The edges taken on the way.
    pub(crate) edges: Vec<E>,
}

impl<'a, A: Linearize, X: Section<A, K>, const K: usize, M: Stepper> ReturnMap<'a, A, X, K, M> {
    /// The map of `section` for the automaton of `simulation`.
    #[must_use]
    pub fn of(simulation: Simulation<'a, A, M>, section: X) -> Self {
        let options = simulation.options();
        let (steps, jumps) = (options.most_steps.min(100_000), options.most_jumps.min(10_000));
        Self { simulation: simulation.most_steps(steps).most_jumps(jumps), section, returns: 1 }
    }

    /// The map of `returns` returns at once, Pⁿ: its fixed points are the orbits of period n. At
    /// least one.
    #[must_use]
    pub fn every(mut self, returns: usize) -> Self {
        self.returns = returns.max(1);
        self
    }

    /// P(q): runs from `q` until the section's edge is taken.
    ///
    /// # Errors
    /// [`MapError::Run`] if the run fails, [`MapError::NoReturn`] if it ends before it is back,
    /// [`MapError::Question`] if the edge leads to another mode than the section's, or its
    /// [`Section::flaw`] finds one.
    pub fn apply(&self, q: [f64; K]) -> Result<Return<K>, MapError> {
        let (mode, t, x) = self.place(&q);
        let jump = self.jump(&self.simulation, mode, x, t, &mut Vec::new()).map_err(|error| error.starting(&q))?;
        self.fits(jump.to, &jump.after)?;
        let p = self.simulation.automaton().parameters().over();
        Ok(Return { q: self.section.read(jump.t(), jump.after.over(), p), duration: jump.t() - t })
    }

    /// P(q) and the matrix ∂P/∂q, K × K, coordinates of the return by coordinates of the start.
    ///
    /// Its derivatives are those of the run itself, carried through each jump by its saltation
    /// matrix ([`Sensitive`]): no differences are taken.
    ///
    /// # Errors
    /// As [`apply`](Self::apply); also where a jump on the way grazes,
    /// [`ErrorKind::Grazing`](crate::ErrorKind::Grazing).
    pub fn jacobian(&self, q: [f64; K]) -> Result<(Return<K>, SMatrix<f64, K, K>), MapError> {
        let linear = self.linear(&q, std::array::from_fn::<_, K, _>(Wrt::Initial))?;
        Ok((linear.image, SMatrix::from_fn(|i, k| linear.columns[k][i])))
    }

    /// The mode, time and state that `q` stands for.
    pub fn place(&self, q: &[f64; K]) -> (A::Mode, f64, A::State) {
        let (mode, shape) = self.section.start();
        let p = || self.simulation.automaton().parameters().over();
        let x = self.section.place(*q, p());
        (mode, self.section.time(*q, p()), shape.with(|i| shape.pick(&x, i)))
    }

    /// The same section, of another automaton.
    fn with<'b>(&self, automaton: &'b A) -> ReturnMap<'b, A, &X, K, M> {
        ReturnMap { simulation: self.simulation.over(automaton), section: &self.section, returns: self.returns }
    }

    /// P to first order along each of `by`: coordinates of the section ([`Wrt::Initial`]) or
    /// parameters.
    fn linear<const C: usize>(&self, q: &[f64; K], by: [Wrt; C]) -> Result<Linear<A::Edge, K, C>, MapError> {
        let automaton = self.simulation.automaton();
        let (mode, t, x) = self.place(q);
        let slope = automaton.flow(mode, t, &x);
        let parameters = automaton.parameters();
        let p = |wrt: Wrt| parameters.lift(|i| Dual64::new(parameters.get(i), unit(wrt == Wrt::Parameter(i))));

        let sensitive = Sensitive::of(automaton, by);
        let mut start = sensitive.start(t, x.clone());
        for (column, wrt) in start.columns.iter_mut().zip(by) {
            let moving = std::array::from_fn(|i| Dual64::new(q[i], unit(wrt == Wrt::Initial(i))));
            let (state, later) = (self.section.place(moving, p(wrt)), self.section.time(moving, p(wrt)).eps);
            // At one and the same time, a neighbour that starts later has not yet flowed so far.
            *column = x.with(|i| x.pick(&state, i).eps - slope.get(i) * later);
        }
        let mut edges = Vec::new();
        let simulation = self.simulation.over(&sensitive);
        let jump = self.jump(&simulation, mode, start, t, &mut edges).map_err(|error| error.starting(q))?;
        self.fits(jump.to, &jump.after.x)?;

        let after = sensitive.after(&jump);
        let columns = std::array::from_fn(|c| {
            let x = after[c].lift(|i| Dual64::new(jump.after.x.get(i), after[c].get(i)));
            self.section.read(Dual64::new(jump.t(), jump.after.dt[c]), x, p(by[c])).map(|q| q.eps)
        });
        let q = self.section.read(jump.t(), jump.after.x.over(), parameters.over());
        Ok(Linear { image: Return { q, duration: jump.t() - t }, columns, edges })
    }

    /// Whether what the edge led to is on the section.
    fn fits(&self, to: A::Mode, x: &A::State) -> Result<(), MapError> {
        let (start, edge) = (self.section.start().0, self.section.edge());
        let led = || {
            format!(
                "edge {edge:?} leads to mode {to:?}, the section starts in {start:?}: give it the mode just after its edge"
            )
        };
        let flaw = if to == start { self.section.flaw(x) } else { Some(led()) };
        flaw.map_or(Ok(()), |flaw| Err(MapError::Question(flaw)))
    }

    /// Runs from `x` until the edge has been taken as often as asked for, noting the edges on the
    /// way.
    fn jump<B: Automaton<Mode = A::Mode, Edge = A::Edge>>(
        &self,
        simulation: &Simulation<'_, B, M>,
        mode: A::Mode,
        x: B::State,
        t: f64,
        edges: &mut Vec<A::Edge>,
    ) -> Result<JumpOf<B>, MapError> {
        let mut until = Until { edge: self.section.edge(), left: self.returns, edges, back: None };
        let mut course = simulation.start(mode, x, t..f64::INFINITY)?;
        course.begin_behind(self.section.edge());
        let end = course.finish(&mut until)?;
        until.back.ok_or_else(|| MapError::NoReturn { why: end.stop.to_string(), t: end.time.seconds(), q: Vec::new() })
    }

    /// ∂P/∂q as a matrix that decompositions accept, and P.
    fn dense(&self, q: &[f64; K]) -> Result<(Linear<A::Edge, K, K>, DMatrix<f64>), MapError> {
        let linear = self.linear(q, std::array::from_fn::<_, K, _>(Wrt::Initial))?;
        let matrix = DMatrix::from_fn(K, K, |i, k| linear.columns[k][i]);
        Ok((linear, matrix))
    }
}

impl<A: Linearize, X: Section<A, K>, const K: usize> Section<A, K> for &X {
    fn edge(&self) -> A::Edge {
        (**self).edge()
    }
    fn start(&self) -> (A::Mode, A::State) {
        (**self).start()
    }
    fn time<D: Number>(&self, q: [D; K], p: Over<A::Parameters, D>) -> D {
        (**self).time(q, p)
    }
    fn place<D: Number>(&self, q: [D; K], p: Over<A::Parameters, D>) -> Over<A::State, D> {
        (**self).place(q, p)
    }
    fn flaw(&self, x: &A::State) -> Option<String> {
        (**self).flaw(x)
    }
    fn read<D: Number>(&self, t: D, x: Over<A::State, D>, p: Over<A::Parameters, D>) -> [D; K] {
        (**self).read(t, x, p)
    }
}

const fn unit(is: bool) -> f64 {
    if is { 1.0 } else { 0.0 }
}

/// Ends a run when an edge has been taken often enough.
struct Until<'e, B: Automaton> {
    edge: B::Edge,
    left: usize,
    edges: &'e mut Vec<B::Edge>,
    back: Option<JumpOf<B>>,
}

impl<B: Automaton> Observer<B> for Until<'_, B> {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<B>) -> ControlFlow<()> {
        self.edges.extend(jump.edge());
        if jump.edge() != Some(self.edge) {
            return ControlFlow::Continue(());
        }
        self.left -= 1;
        if self.left > 0 {
            return ControlFlow::Continue(());
        }
        self.back = Some(jump.clone());
        ControlFlow::Break(())
    }
}
