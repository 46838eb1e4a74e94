//! Derivatives of a Filippov slide: two flows and a surface written over numbers that carry a
//! derivative.

use num_dual::{Dual, Dual64};

use super::{Lift, Linearize, Number, Over, moving_in};
use crate::filippov::{Filippov, Passage, Side, TwoSided};
use crate::state::State;

/// A two-sided system whose flows and surface can be differentiated: each is written once, over any
/// [`Number`], and [`Filippov`] of it is [`Linearize`].
///
/// The methods of [`TwoSided`] are then one line each. With `n = h_x` and `L± = n · f± + h_t`, the
/// derivative of h along each flow:
///
/// | where | equation |
/// |---|---|
/// | along a slide | `S' = f_x S + f_q` of `f = α f₊ + (1 - α) f₋`, `α = L₋/(L₋ - L₊)` |
/// | into it, from the flow f⁻ | `S⁺ = S⁻ + (f - f⁻)(n S⁻ + h_q)/(n f⁻ + h_t)`: then `n S⁺ + h_q = 0` |
/// | out of it, where `L₊` or `L₋` reaches zero | `S⁺ = S⁻`: the two flows are one there |
/// | out of it, where a hold g gives way | `S⁺ = S⁻ + (f⁺ - f)(g_x S⁻ + g_q)/ġ` |
/// | at an end that is not determined | `S⁺ = S⁻`, and no `dt*/dq` (NaN) |
///
/// The component of S across the surface is lost where a slide begins: S has one rank less from
/// there on. Rows 2 to 4 are the [`saltation`](super::saltation) of their edges.
///
/// Sources: A. F. Filippov, *Differential Equations with Discontinuous Righthand Sides* (Kluwer,
/// 1988), 2.4; R. I. Leine, H. Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical
/// Systems* (Springer, 2004), 7.3; L. Dieci, L. Lopez, *Fundamental matrix solutions of piecewise
/// smooth differential systems*, Math. Comput. Simul. 81 (2011) 932.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Filippov, LinearizeSides, Number, Sensitive, Side, Simulation, TwoSided, Wrt};
///
/// /// A block of 1 kg on a spring of `stiffness` N/m, rubbing with `rub` N.
/// struct Block {
///     stiffness: f64,
///     rub: f64,
/// }
///
/// impl LinearizeSides for Block {
///     type Parameters = [f64; 2];
///     fn parameters(&self) -> [f64; 2] {
///         [self.stiffness, self.rub]
///     }
///     fn shape(&self) -> Vector2<f64> {
///         vector![0.0, 0.0] // position in m, velocity in m/s
///     }
///     fn above_over<D: Number>(&self, _t: D, [x, v]: [D; 2], [k, rub]: [D; 2]) -> [D; 2] {
///         [v, -k * x - rub]
///     }
///     fn below_over<D: Number>(&self, _t: D, [x, v]: [D; 2], [k, rub]: [D; 2]) -> [D; 2] {
///         [v, -k * x + rub]
///     }
///     fn surface_over<D: Number>(&self, _t: D, [_, v]: [D; 2], _: [D; 2]) -> D {
///         v
///     }
/// }
///
/// impl TwoSided for Block {
///     type State = Vector2<f64>;
///     fn above(&self, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         self.above_at(t, x)
///     }
///     fn below(&self, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         self.below_at(t, x)
///     }
///     fn surface(&self, t: f64, x: &Vector2<f64>) -> f64 {
///         self.surface_at(t, x)
///     }
///     fn normal(&self, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         self.normal_at(t, x)
///     }
///     fn affine(&self) -> bool {
///         true
///     }
/// }
///
/// let block = Filippov::of(Block { stiffness: 100.0, rub: 3.0 });
/// let sensitive = Sensitive::of(&block, [Wrt::Parameter(1), Wrt::Initial(0)]);
/// let run = Simulation::of(&sensitive).run(Side::Below, sensitive.start(0.0, vector![0.1, 0.0]), 0.0..10.0)?;
/// // From x it swings to -x + 2 rub/k, and sticks after two swings: at x - 4 rub/k.
/// assert_eq!(run.end.mode, Side::Sliding);
/// let [by_rub, by_x] = run.end.state.columns;
/// assert!((by_rub[0] + 4.0 / 100.0).abs() < 1e-9 && (by_x[0] - 1.0).abs() < 1e-9);
/// // It stands still, whatever they are.
/// assert!(by_rub[1].abs() < 1e-12 && by_x[1].abs() < 1e-12);
/// # Ok::<(), saltus::Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be differentiated",
    note = "write the system as a type that implements `TwoSided` and `LinearizeSides`: the closures of `Sides` carry no derivatives"
)]
pub trait LinearizeSides: TwoSided<State: Lift> {
    /// The parameters, `[f64; P]` for P of them (P may be zero).
    type Parameters: Lift;

    /// The values of the parameters.
    fn parameters(&self) -> Self::Parameters;

    /// A state with as many coordinates as all others, of any values.
    fn shape(&self) -> Self::State;

    /// The flow f₊ above the surface, as [`TwoSided::above`].
    fn above_over<D: Number>(
        &self,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Over<Self::State, D>;

    /// The flow f₋ below the surface, as [`TwoSided::below`].
    fn below_over<D: Number>(
        &self,
        t: D,
        x: Over<Self::State, D>,
        p: Over<Self::Parameters, D>,
    ) -> Over<Self::State, D>;

    /// h(t, x, p), as [`TwoSided::surface`].
    fn surface_over<D: Number>(&self, t: D, x: Over<Self::State, D>, p: Over<Self::Parameters, D>) -> D;

    /// The margin against leaving upwards, as [`TwoSided::hold_above`]: -L₊ unless given. Whoever
    /// gives one of the two gives the other.
    fn hold_above_over<D: Number>(&self, t: D, x: Over<Self::State, D>, p: Over<Self::Parameters, D>) -> D {
        -speed_over(self, t, &x, &p, &self.above_over(t, x, p))
    }

    /// The margin against leaving downwards, as [`TwoSided::hold_below`]: L₋ unless given. Whoever
    /// gives one of the two gives the other.
    fn hold_below_over<D: Number>(&self, t: D, x: Over<Self::State, D>, p: Over<Self::Parameters, D>) -> D {
        speed_over(self, t, &x, &p, &self.below_over(t, x, p))
    }

    /// Promises that no parameter moves the [stops](TwoSided::stops), as
    /// [`Linearize::stops_stand`].
    fn stops_stand(&self) -> bool {
        false
    }

    /// What [`TwoSided::above`] may answer.
    #[inline]
    fn above_at(&self, t: f64, x: &Self::State) -> Self::State {
        let slope = self.above_over(t, x.over(), self.parameters().over());
        x.with(|i| x.pick(&slope, i))
    }

    /// What [`TwoSided::below`] may answer.
    #[inline]
    fn below_at(&self, t: f64, x: &Self::State) -> Self::State {
        let slope = self.below_over(t, x.over(), self.parameters().over());
        x.with(|i| x.pick(&slope, i))
    }

    /// What [`TwoSided::surface`] may answer.
    #[inline]
    fn surface_at(&self, t: f64, x: &Self::State) -> f64 {
        self.surface_over(t, x.over(), self.parameters().over())
    }

    /// What [`TwoSided::normal`] may answer: the gradient of the surface, by dual numbers.
    #[inline]
    fn normal_at(&self, t: f64, x: &Self::State) -> Self::State {
        let p = moving_in(&self.parameters(), None);
        x.with(|i| self.surface_over(Dual64::from(t), moving_in(x, Some(i)), p).eps)
    }

    /// What [`TwoSided::surface_rate`] may answer: ∂h/∂t, by dual numbers.
    #[inline]
    fn surface_rate_at(&self, t: f64, x: &Self::State) -> f64 {
        let p = moving_in(&self.parameters(), None);
        self.surface_over(Dual64::new(t, 1.0), moving_in(x, None), p).eps
    }
}

impl<T: LinearizeSides + ?Sized> LinearizeSides for &T {
    type Parameters = T::Parameters;
    fn parameters(&self) -> T::Parameters {
        (**self).parameters()
    }
    fn shape(&self) -> T::State {
        (**self).shape()
    }
    fn above_over<D: Number>(&self, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> Over<T::State, D> {
        (**self).above_over(t, x, p)
    }
    fn below_over<D: Number>(&self, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> Over<T::State, D> {
        (**self).below_over(t, x, p)
    }
    fn surface_over<D: Number>(&self, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> D {
        (**self).surface_over(t, x, p)
    }
    fn hold_above_over<D: Number>(&self, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> D {
        (**self).hold_above_over(t, x, p)
    }
    fn hold_below_over<D: Number>(&self, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> D {
        (**self).hold_below_over(t, x, p)
    }
    fn stops_stand(&self) -> bool {
        (**self).stops_stand()
    }
}

/// L = n · f + ∂h/∂t, the derivative of h along the flow `f`: by a dual number about the number D,
/// so that what D carries is that of L, the curvature of the surface included.
fn speed_over<T: LinearizeSides + ?Sized, D: Number>(
    system: &T,
    t: D,
    x: &Over<T::State, D>,
    p: &Over<T::Parameters, D>,
    f: &Over<T::State, D>,
) -> D {
    let (like, given) = (system.shape(), system.parameters());
    let along = like.lift(|i| Dual::new(like.pick(x, i), like.pick(f, i)));
    let standing = given.lift(|i| Dual::new(given.pick(p, i), D::zero()));
    system.surface_over(Dual::new(t, D::one()), along, standing).eps
}

impl<T: LinearizeSides> Filippov<T> {
    /// The flow along the surface, as [`Filippov`] has it.
    fn slide_over<D: Number>(&self, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> Over<T::State, D> {
        let (system, like) = (&self.system, self.system.shape());
        let (above, below) = (system.above_over(t, x, p), system.below_over(t, x, p));
        let [at, one, other] = [&x, &above, &below].map(|over| like.with(|i| like.pick(over, i).re()));
        if self.are_one(t.re(), &at, &one, &other) {
            return above;
        }
        let [up, down] = [&above, &below].map(|flow| speed_over(system, t, &x, &p, flow));
        let pull = if system.affine() { D::zero() } else { system.surface_over(t, x, p) * system.pull() };
        let (up, down, gap) = (up + pull, down + pull, down - up);
        like.lift(|i| (down * like.pick(&above, i) - up * like.pick(&below, i)) / gap)
    }
}

impl<T: LinearizeSides> Linearize for Filippov<T> {
    type Parameters = T::Parameters;

    fn parameters(&self) -> T::Parameters {
        self.system.parameters()
    }

    fn flow_over<D: Number>(
        &self,
        mode: Side,
        t: D,
        x: Over<T::State, D>,
        p: Over<T::Parameters, D>,
    ) -> Over<T::State, D> {
        match mode {
            Side::Above => self.system.above_over(t, x, p),
            Side::Below => self.system.below_over(t, x, p),
            Side::Sliding => self.slide_over(t, x, p),
        }
    }

    fn guard_over<D: Number>(&self, edge: Passage, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> D {
        match edge {
            Passage::FromAbove => self.system.surface_over(t, x, p),
            Passage::FromBelow => -self.system.surface_over(t, x, p),
            Passage::LeaveAbove => self.system.hold_above_over(t, x, p),
            Passage::LeaveBelow => self.system.hold_below_over(t, x, p),
            // Where neither flow pushes the slide has no velocity that is known: no derivative.
            Passage::Undecided | Passage::Unpushed => D::from(f64::NAN),
        }
    }

    /// A neighbour meets the surface where it meets it: it is put on it by its rounding alone.
    fn reset_over<D: Number>(
        &self,
        _: Passage,
        _: D,
        x: Over<T::State, D>,
        _: Over<T::Parameters, D>,
    ) -> Over<T::State, D> {
        x
    }

    fn surface_over<D: Number>(&self, mode: Side, t: D, x: Over<T::State, D>, p: Over<T::Parameters, D>) -> Option<D> {
        (mode == Side::Sliding).then(|| self.system.surface_over(t, x, p))
    }

    fn stops_stand(&self, _: Side) -> bool {
        self.system.stops_stand()
    }
}
