//! How the state of a mode goes on: by steps, a polynomial, a formula or a Taylor series.

use std::fmt;

use crate::automaton::Automaton;
use crate::series::Series;
use crate::sparsity::Sparsity;
use crate::state;

/// A formula of an automaton: the state at `t + s` in a mode, if it is `x` at `t`.
pub(crate) type Formula<A> = fn(&A, Mode<A>, f64, &State<A>, f64) -> State<A>;
/// A flow of an automaton over jets.
pub(crate) type Flow<A> = fn(&A, Mode<A>, &mut Series<'_, State<A>>);
type Mode<A> = <A as Automaton>::Mode;
type State<A> = <A as Automaton>::State;

/// How the state of a mode goes on from where it is: what a model gives of its own flow. A mode
/// answers with the same kind wherever it is entered.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Automaton, Edges, Refusal, Simulation, Solution};
///
/// /// A weight on a spring, x'' = -x, and a stop at x = 0 that sends it back.
/// struct Weight;
///
/// impl Weight {
///     fn swing(&self, (): (), _t: f64, x: &Vector2<f64>, s: f64) -> Vector2<f64> {
///         let (sin, cos) = s.sin_cos();
///         vector![x[0] * cos + x[1] * sin, x[1] * cos - x[0] * sin]
///     }
/// }
///
/// impl Automaton for Weight {
///     type Mode = ();
///     type State = Vector2<f64>;
///     type Edge = ();
///
///     fn flow(&self, (): (), _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         vector![x[1], -x[0]]
///     }
///     fn solution(&self, (): (), _t: f64, _x: &Vector2<f64>) -> Solution<Self> {
///         Solution::Formula(Self::swing)
///     }
///     fn edges(&self, (): ()) -> Edges<'_, ()> {
///         Edges::from([()])
///     }
///     fn guard(&self, (): (), _t: f64, x: &Vector2<f64>) -> f64 {
///         x[0]
///     }
///     fn reset(&self, (): (), (): (), _t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
///         Ok(((), vector![0.0, -x[1]]))
///     }
/// }
///
/// let run = Simulation::of(&Weight).run((), vector![1.0, 0.0], 0.0..2.0)?;
/// assert!((run.trajectory.jumps()[0].t() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
/// assert_eq!(run.end.stats.steps, 0);
/// # Ok::<(), saltus::Error>(())
/// ```
#[non_exhaustive]
pub enum Solution<A: Automaton + ?Sized> {
    /// The flow is stepped.
    Steps,
    /// The flow is stepped, and its Jacobian has no entries but these: where it is stiff a step's
    /// cost grows with their number, and not with the cube of that of the coordinates.
    Sparse(Sparsity),
    /// The exact solution is this polynomial in time: no step is taken.
    Polynomial(Polynomial<A::State>),
    /// A formula gives the exact solution: the state at `t + s`, for s ≥ 0, if it is `x` at `t`. No
    /// step is taken; the trajectory's pieces interpolate it to twelve digits.
    Formula(Formula<A>),
    /// The flow, written once more over [`Jet`](crate::Jet)s and given to [`Series::flow`]: steps
    /// are Taylor series, of an order that the tolerance asks for. A whole arc is often one or two
    /// of them, and a further digit costs little.
    ///
    /// Worth it where crossings are many or errors are to be small, and the flow is smooth and not
    /// stiff. It must be the same flow as [`Automaton::flow`], with which it is compared where each
    /// step ends: beyond a switch the two differ, and the step is shortened. At the kinks of
    /// [`Jet::abs`](crate::Jet::abs) it ends of itself. Where there is no series (√x at x = 0), the
    /// stepper goes on.
    ///
    /// ```
    /// use saltus::nalgebra::{self, Vector2, vector};
    /// use saltus::{Automaton, Edges, Refusal, Series, Simulation, Solution};
    ///
    /// /// x'' = -sin x; each passage through the lowest point is a jump.
    /// struct Pendulum;
    ///
    /// impl Pendulum {
    ///     fn series(&self, _: bool, series: &mut Series<'_, Vector2<f64>>) {
    ///         series.flow(|_t, [x, v]| [v, -x.sin()]);
    ///     }
    /// }
    ///
    /// impl Automaton for Pendulum {
    ///     type Mode = bool; // to the right of it?
    ///     type State = Vector2<f64>; // angle and its rate
    ///     type Edge = bool;
    ///
    ///     fn flow(&self, _: bool, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
    ///         vector![x[1], -x[0].sin()]
    ///     }
    ///     fn solution(&self, _: bool, _t: f64, _x: &Vector2<f64>) -> Solution<Self> {
    ///         Solution::Series(Self::series)
    ///     }
    ///     fn edges(&self, right: bool) -> Edges<'_, bool> {
    ///         Edges::from([right])
    ///     }
    ///     fn guard(&self, right: bool, _t: f64, x: &Vector2<f64>) -> f64 {
    ///         if right { x[0] } else { -x[0] }
    ///     }
    ///     fn reset(
    ///         &self,
    ///         right: bool,
    ///         _: bool,
    ///         _t: f64,
    ///         x: &Vector2<f64>,
    ///     ) -> Result<(bool, Vector2<f64>), Refusal> {
    ///         Ok((!right, *x))
    ///     }
    /// }
    ///
    /// // From a right angle it takes K(1/√2) to get down: the quarter of a period.
    /// let quarter = 1.854_074_677_301_371_9;
    /// let run = Simulation::of(&Pendulum).run(true, vector![std::f64::consts::FRAC_PI_2, 0.0], 0.0..7.0)?;
    /// for (k, jump) in run.trajectory.jumps().iter().enumerate() {
    ///     assert!((jump.t() - (2 * k + 1) as f64 * quarter).abs() < 1e-9);
    /// }
    /// assert!(run.end.stats.steps < 25); // with Dop853 it takes 40
    /// # Ok::<(), saltus::Error>(())
    /// ```
    Series(Flow<A>),
}

impl<A: Automaton + ?Sized> Solution<A> {
    /// The state at `t + s` on the solution of `automaton` from `x` at `t` in `mode`, for s ≥ 0,
    /// where a polynomial or a formula gives it.
    #[inline]
    pub fn at(&self, automaton: &A, mode: A::Mode, t: f64, x: &A::State, s: f64) -> Option<A::State> {
        match self {
            Self::Polynomial(polynomial) => Some(polynomial.at(s)),
            Self::Formula(formula) => Some(formula(automaton, mode, t, x, s)),
            Self::Steps | Self::Sparse(_) | Self::Series(_) => None,
        }
    }

    /// Whether no step is taken: a polynomial or a formula gives the state.
    #[must_use]
    pub const fn is_exact(&self) -> bool {
        matches!(self, Self::Polynomial(_) | Self::Formula(_))
    }
}

impl<A: Automaton + ?Sized> fmt::Debug for Solution<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steps => f.write_str("Steps"),
            Self::Sparse(sparsity) => f.debug_tuple("Sparse").field(sparsity).finish(),
            Self::Polynomial(polynomial) => f.debug_tuple("Polynomial").field(polynomial).finish(),
            Self::Formula(_) => f.write_str("Formula"),
            Self::Series(_) => f.write_str("Series"),
        }
    }
}

/// When a guard falls on an exact solution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Fall<S> {
    /// No formula says: it is searched for.
    #[default]
    Unknown,
    /// It never does.
    Never,
    /// After this time, in seconds.
    After(f64),
    /// After this time, in seconds, in this state, at which the guard must not be negative: the
    /// cheapest answer, for the solution need then not be evaluated there.
    In(f64, S),
}

/// A solution that is a polynomial in time, x(t + s) = c₀ + c₁ s + c₂ s² + c₃ s³, of degree at most
/// three.
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
    pub(crate) fn map<R>(&self, mut f: impl FnMut(usize, &S) -> R) -> Polynomial<R> {
        Polynomial { coefficients: std::array::from_fn(|k| f(k, &self.coefficients[k])), len: self.len }
    }
}

impl<S: state::State> Polynomial<S> {
    /// The state a time `s` after the start.
    #[must_use]
    pub fn at(&self, s: f64) -> S {
        crate::piece::horner(self.coefficients(), s)
    }
}

impl<S: Clone, const N: usize> From<[S; N]> for Polynomial<S> {
    #[inline]
    fn from(list: [S; N]) -> Self {
        const { assert!(1 <= N && N <= 4, "a polynomial has one to four coefficients") };
        // Behind the last one anything may stand.
        Self { coefficients: std::array::from_fn(|k| list[if k < N { k } else { 0 }].clone()), len: N }
    }
}
