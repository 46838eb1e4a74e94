//! Derivatives of runs: a model written once over numbers that carry a derivative, and what jumps
//! do to derivatives.

mod passage;
mod sensitive;
mod sliding;

pub use passage::{Saltation, saltation};
pub use sensitive::{Sensitive, Tangent, Wrt};
pub use sliding::LinearizeSides;

use nalgebra::SVector;
use num_dual::{Dual64, DualNum};

use crate::automaton::Automaton;
use crate::automaton::solution::{Polynomial, Solution};
use crate::state::{Coords, State};

/// A number that a model may be written over: `f64`, or a dual number that carries derivatives
/// along.
///
/// Has the arithmetic of `f64`, with `f64` on the right side of an operator, and its functions
/// (`sin`, `sqrt`, `powi`, `abs`, …) by the same names. Comparisons look at the value alone.
///
/// ```
/// use saltus::Number;
/// use saltus::num_dual::Dual64;
///
/// fn drag<D: Number>(v: D, k: D) -> D {
///     -k * v * v.abs()
/// }
/// assert_eq!(drag(-3.0, 0.1), 0.1 * 3.0 * 3.0);
/// // d/dv at v = -3: -2 k |v|
/// assert!((drag(Dual64::new(-3.0, 1.0), Dual64::from(0.1)).eps + 0.6).abs() < 1e-15);
/// ```
pub trait Number: DualNum<Primitive = f64> + Copy {}

impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

/// A state whose coordinates can be made dual numbers.
///
/// Over a number D, `f64` becomes `D`, and `[f64; N]`, [`SVector<f64, N>`] and
/// [`Coords<N>`](Coords) become `[D; N]`; where a state has fewer than N coordinates the rest are
/// zeros, and ignored where they come back.
///
/// A struct is given the type of its numbers as a parameter, and `#[derive(Lift)]` (feature
/// `derive`): over D, `Ball<f64>` becomes `Ball<D>`, and its fields keep their names. So do
/// parameters.
///
#[cfg_attr(feature = "derive", doc = "```")]
#[cfg_attr(not(feature = "derive"), doc = "```ignore")]
/// use saltus::{Automaton, Edges, Lift, Linearize, Number, Refusal};
/// use saltus::{Sensitive, Simulation, State, Wrt};
///
/// #[derive(Clone, Copy, Debug, State, Lift)]
/// struct Swing<D = f64> {
///     #[unit("rad")]
///     angle: D,
///     #[unit("rad/s")]
///     rate: D,
/// }
///
/// #[derive(Clone, Copy, Debug, State, Lift)]
/// struct Given<D = f64> {
///     damping: D,
/// }
///
/// struct Clapper(Given);
///
/// impl Linearize for Clapper {
///     type Parameters = Given;
///     fn parameters(&self) -> Given {
///         self.0
///     }
///     fn flow_over<D: Number>(&self, (): (), _t: D, x: Swing<D>, p: Given<D>) -> Swing<D> {
///         Swing { angle: x.rate, rate: -x.angle.sin() - p.damping * x.rate }
///     }
///     fn guard_over<D: Number>(&self, (): (), _t: D, x: Swing<D>, _: Given<D>) -> D {
///         x.angle
///     }
///     fn reset_over<D: Number>(&self, (): (), _t: D, x: Swing<D>, _: Given<D>) -> Swing<D> {
///         Swing { angle: D::zero(), rate: -x.rate }
///     }
/// }
/// # impl Automaton for Clapper {
/// #     type Mode = ();
/// #     type State = Swing;
/// #     type Edge = ();
/// #     fn flow(&self, mode: (), t: f64, x: &Swing) -> Swing { self.flow_at(mode, t, x) }
/// #     fn edges(&self, (): ()) -> Edges<'_, ()> { Edges::from([()]) }
/// #     fn guard(&self, edge: (), t: f64, x: &Swing) -> f64 { self.guard_at(edge, t, x) }
/// #     fn reset(&self, (): (), edge: (), t: f64, x: &Swing) -> Result<((), Swing), Refusal> {
/// #         Ok(((), self.reset_at(edge, t, x)))
/// #     }
/// # }
///
/// let clapper = Clapper(Given { damping: 0.1 });
/// let by_damping = Sensitive::of(&clapper, [Wrt::Parameter(0)]);
/// let start = by_damping.start(0.0, Swing { angle: 0.5, rate: 0.0 });
/// let run = Simulation::of(&by_damping).run((), start, 0.0..10.0)?;
/// let angle = |damping| {
///     let clapper = Clapper(Given { damping });
///     let run = Simulation::of(&clapper).run((), start.x, 0.0..10.0)?;
///     Ok::<_, saltus::Error>(run.end.state.angle)
/// };
/// let difference = (angle(0.1001)? - angle(0.0999)?) / 0.0002;
/// assert!((run.end.state.columns[0].angle - difference).abs() < 1e-6);
/// # Ok::<(), saltus::Error>(())
/// ```
pub trait Lift: State {
    /// The coordinates over another number.
    type Over<D: Number>: Copy;

    /// The coordinates of a state of this shape, `f(i)` the i-th.
    fn lift<D: Number>(&self, f: impl FnMut(usize) -> D) -> Self::Over<D>;

    /// Coordinate `i` of one that has this shape.
    fn pick<D: Number>(&self, over: &Self::Over<D>, i: usize) -> D;

    /// The coordinates as they are.
    fn over(&self) -> Self::Over<f64> {
        self.lift(|i| self.get(i))
    }
}

/// The coordinates of a state `S` over the number `D`: see [`Lift`].
pub type Over<S, D> = <S as Lift>::Over<D>;

impl Lift for f64 {
    type Over<D: Number> = D;
    #[inline]
    fn lift<D: Number>(&self, mut f: impl FnMut(usize) -> D) -> D {
        f(0)
    }
    #[inline]
    fn pick<D: Number>(&self, over: &D, _: usize) -> D {
        *over
    }
}

impl<const N: usize> Lift for [f64; N] {
    type Over<D: Number> = [D; N];
    #[inline]
    fn lift<D: Number>(&self, f: impl FnMut(usize) -> D) -> [D; N] {
        std::array::from_fn(f)
    }
    #[inline]
    fn pick<D: Number>(&self, over: &[D; N], i: usize) -> D {
        over[i]
    }
}

impl<const N: usize> Lift for SVector<f64, N> {
    type Over<D: Number> = [D; N];
    #[inline]
    fn lift<D: Number>(&self, f: impl FnMut(usize) -> D) -> [D; N] {
        std::array::from_fn(f)
    }
    #[inline]
    fn pick<D: Number>(&self, over: &[D; N], i: usize) -> D {
        over[i]
    }
}

impl<const CAP: usize> Lift for Coords<CAP> {
    type Over<D: Number> = [D; CAP];
    #[inline]
    fn lift<D: Number>(&self, mut f: impl FnMut(usize) -> D) -> [D; CAP] {
        std::array::from_fn(|i| if i < self.len() { f(i) } else { D::zero() })
    }
    #[inline]
    fn pick<D: Number>(&self, over: &[D; CAP], i: usize) -> D {
        over[i]
    }
}

/// An automaton whose flow, guards and resets can be differentiated: each is written once, over any
/// [`Number`].
///
/// The methods of [`Automaton`] are then one line each. The **parameters** p are the numbers in the
/// model with respect to which derivatives may be wanted; they have the same units in every mode.
///
/// A ball with gravity and coefficient of restitution as parameters:
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Automaton, Edges, Linearize, Number, Refusal, saltation};
///
/// struct Ball {
///     gravity: f64,
///     cor: f64,
/// }
///
/// impl Linearize for Ball {
///     type Parameters = [f64; 2];
///
///     fn parameters(&self) -> [f64; 2] {
///         [self.gravity, self.cor]
///     }
///     fn flow_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], [g, _]: [D; 2]) -> [D; 2] {
///         [v, -g]
///     }
///     fn guard_over<D: Number>(&self, _: (), _t: D, [y, _]: [D; 2], _: [D; 2]) -> D {
///         y
///     }
///     fn reset_over<D: Number>(&self, _: (), _t: D, [_, v]: [D; 2], [_, e]: [D; 2]) -> [D; 2] {
///         [D::zero(), -e * v]
///     }
/// }
///
/// impl Automaton for Ball {
///     type Mode = ();
///     type State = Vector2<f64>; // height in m, velocity in m/s
///     type Edge = ();
///
///     fn flow(&self, mode: (), t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         self.flow_at(mode, t, x)
///     }
///     fn edges(&self, _: ()) -> Edges<'_, ()> {
///         Edges::from([()])
///     }
///     fn guard(&self, edge: (), t: f64, x: &Vector2<f64>) -> f64 {
///         self.guard_at(edge, t, x)
///     }
///     fn reset(&self, _: (), edge: (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
///         Ok(((), self.reset_at(edge, t, x)))
///     }
/// }
///
/// // An impact at 4 m/s turns both the height and the velocity of a neighbour round: Ξ = -e [1 0; g (1 + e)/(e v⁻) 1].
/// let ball = Ball { gravity: 10.0, cor: 0.5 };
/// let jump = saltation(&ball, (), (), 0.0, &vector![0.0, -4.0])?;
/// assert_eq!(jump.state, saltus::nalgebra::dmatrix![-0.5, 0.0; 3.75, -0.5]);
/// // Raised by 1 m, it would have landed a quarter of a second later.
/// assert_eq!(jump.time_by_state[0], 0.25);
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// The numbers that decide events are those of [`Automaton`]; of the methods here the derivatives
/// count. The two must describe the same model. What a mode or edge carries frozen
/// (`Stance { foot }`) counts as constant: if it depends on the state, make it a coordinate that
/// stands still.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be differentiated",
    note = "write the model as a type that implements `Automaton` and `Linearize`: the closures of a `Hybrid` carry no derivatives"
)]
pub trait Linearize: Automaton<State: Lift> {
    /// The parameters, `[f64; P]` for P of them (P may be zero).
    type Parameters: Lift;

    /// The values of the parameters.
    fn parameters(&self) -> Self::Parameters;

    /// The flow, as [`Automaton::flow`].
    fn flow_over<D: Number>(
        &self,
        mode: Self::Mode,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Over<Self::State, D>;

    /// The guard, as [`Automaton::guard`].
    fn guard_over<D: Number>(&self, edge: Self::Edge, t: D, x: Over<Self::State, D>, p: Over<Self::Parameters, D>)
    -> D;

    /// The state after the jump, as [`Automaton::reset`].
    fn reset_over<D: Number>(
        &self,
        edge: Self::Edge,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Over<Self::State, D>;

    /// The state beyond a Zeno limit, as [`Automaton::beyond`]. Without it, a run with derivatives
    /// ends at the limit.
    fn beyond_over<D: Number>(
        &self,
        mode: Self::Mode,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Option<Over<Self::State, D>> {
        let _ = (mode, t, x, p);
        None
    }

    /// The time of the tick at `t` by which a clock takes `edge` out of `mode`, as the parameters
    /// move it: τ(p) with τ = t where they are what they are. Only its derivative counts. The time
    /// itself, `D::from(t)`, says that they do not move it.
    ///
    /// Without it a derivative by a parameter cannot be carried across the tick: the run fails with
    /// [`ErrorKind::ClockDerivative`](crate::ErrorKind::ClockDerivative).
    fn tick_over<D: Number>(
        &self,
        mode: Self::Mode,
        edge: Self::Edge,
        t: f64,
        p: Over<Self::Parameters, D>,
    ) -> Option<D> {
        let _ = (mode, edge, t, p);
        None
    }

    /// The surface h(t, x, p) = 0 that the states of `mode` keep to, by its left side; `None` where
    /// they are free to go anywhere.
    ///
    /// A neighbour that starts off the surface starts in another mode, and its derivative depends
    /// on the side: a run whose columns leave it where they start, `h_x S + h_q ≠ 0`, is
    /// refused.
    fn surface_over<D: Number>(
        &self,
        mode: Self::Mode,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Option<D> {
        let _ = (mode, t, x, p);
        None
    }

    /// Promises that no parameter moves the [stops](Automaton::stops) of `mode`.
    ///
    /// The state does not jump at a stop, and so its derivative by a parameter that moves the stop
    /// is not carried across it. Without the promise a run with derivatives by parameters does not
    /// enter a mode that has stops. Of a stop that a parameter moves make a clock, whose edge
    /// leaves the state as it is and whose time is given by [`tick_over`](Self::tick_over).
    fn stops_stand(&self, mode: Self::Mode) -> bool {
        let _ = mode;
        false
    }

    /// The exact solution, as [`Automaton::solution`]. Without it, a run with derivatives takes
    /// steps.
    fn exact_over<D: Number>(
        &self,
        mode: Self::Mode,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Option<Polynomial<Over<Self::State, D>>> {
        let _ = (mode, t, x, p);
        None
    }

    /// What [`Automaton::flow`] may answer.
    #[inline]
    fn flow_at(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Self::State {
        let slope = self.flow_over(mode, t, x.over(), self.parameters().over());
        x.with(|i| x.pick(&slope, i))
    }

    /// What [`Automaton::guard`] may answer.
    #[inline]
    fn guard_at(&self, edge: Self::Edge, t: f64, x: &Self::State) -> f64 {
        self.guard_over(edge, t, x.over(), self.parameters().over())
    }

    /// The state that [`Automaton::reset`] may answer, where the jump leaves the number of
    /// coordinates as it is.
    #[inline]
    fn reset_at(&self, edge: Self::Edge, t: f64, x: &Self::State) -> Self::State {
        let after = self.reset_over(edge, t, x.over(), self.parameters().over());
        x.with(|i| x.pick(&after, i))
    }

    /// What [`Automaton::solution`] may answer: the exact solution where there is one, else steps.
    #[inline]
    fn solution_at(&self, mode: Self::Mode, t: f64, x: &Self::State) -> Solution<Self>
    where
        Self: Sized,
    {
        match self.exact_over(mode, t, x.over(), self.parameters().over()) {
            Some(solution) => Solution::Polynomial(solution.map(|_, c| x.with(|i| x.pick(c, i)))),
            None => Solution::Steps,
        }
    }
}

/// `x` moving with velocity `dx`.
#[inline]
fn moving<S: Lift>(x: &S, dx: &S) -> Over<S, Dual64> {
    x.lift(|i| Dual64::new(x.get(i), dx.get(i)))
}

/// `x` with its coordinate `moves`, if any, moving with unit velocity.
#[inline]
fn moving_in<S: Lift>(x: &S, moves: Option<usize>) -> Over<S, Dual64> {
    x.lift(|i| Dual64::new(x.get(i), if moves == Some(i) { 1.0 } else { 0.0 }))
}

/// The velocity of coordinates, in the shape of `like`.
#[inline]
fn velocity<S: Lift>(over: &Over<S, Dual64>, like: &S) -> S {
    like.with(|i| like.pick(over, i).eps)
}
