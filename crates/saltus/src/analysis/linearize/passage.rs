//! What a jump does to neighbouring runs: they cross a little earlier or later, at another place,
//! and land elsewhere.

use nalgebra::{DMatrix, RowDVector};
use num_dual::{Dual2_64, Dual64};

use super::{Lift, Linearize, moving, moving_in, velocity};
use crate::advance::Smooth;
use crate::error::{Error, ErrorKind, Place, Refusal};
use crate::state::State;
use crate::time::resolution;

/// A jump to first order: what becomes of a small change of the state x⁻ before it and of the
/// parameters.
///
/// With n⁻ coordinates before the jump, n⁺ after it and P parameters:
///
/// | field | shape | equation |
/// |---|---|---|
/// | `state` | n⁺ × n⁻ | `Ξ = R_x + (f⁺ - R_x f⁻ - R_t) g_x / ġ` |
/// | `parameters` | n⁺ × P | `R_p + (f⁺ - R_x f⁻ - R_t) g_p / ġ` |
/// | `time_by_state` | 1 × n⁻ | `-g_x / ġ` |
/// | `time_by_parameters` | 1 × P | `-g_p / ġ` |
///
/// where g is the guard, R the reset, f⁻ and f⁺ the flows at both sides, and `ġ = g_t + g_x f⁻ < 0`
/// the rate at which the guard falls. An edge that a clock takes has no guard, and a time τ(p) that
/// the state does not move: `Ξ = R_x`, `R_p - (f⁺ - R_x f⁻ - R_t) τ_p`, and the times 0 and `τ_p`
/// ([`Linearize::tick_over`]). Units are those of the quotients: a coordinate after by a coordinate
/// before, seconds by a coordinate, and so on.
#[derive(Clone, Debug, PartialEq)]
pub struct Saltation {
    /// The saltation matrix Ξ: δx⁺ = Ξ δx⁻ at one and the same time.
    pub state: DMatrix<f64>,
    /// How the state after the jump depends on the parameters, the state before held fixed.
    pub parameters: DMatrix<f64>,
    /// How the time of the jump depends on the state before.
    pub time_by_state: RowDVector<f64>,
    /// How the time of the jump depends on the parameters.
    pub time_by_parameters: RowDVector<f64>,
}

/// The saltation matrix of `edge`, taken out of `mode` at time `t` from the state `x` just before;
/// rectangular where the dimension changes.
///
/// `Ξ = R_x + (f⁺ - R_x f⁻ - R_t) g_x / (g_t + g_x f⁻)`; see [`Saltation`] for the rest. The
/// derivatives are exact to rounding (dual numbers).
///
/// Sources: M. A. Aizerman, F. R. Gantmacher, *On the stability of periodic motions*, J. Appl.
/// Math. Mech. 22 (1958) 1065; R. I. Leine, H. Nijmeijer, *Dynamics and Bifurcations of Non-Smooth
/// Mechanical Systems*, Springer 2004, chapter 7; N. J. Kong, J. J. Payne, J. Zhu, A. M. Johnson,
/// *Saltation matrices: the essential tool for linearizing hybrid dynamical systems*, Proc. IEEE
/// 112 (2024) 585.
///
/// An example is at [`Linearize`].
///
/// # Errors
/// [`ErrorKind::Grazing`] if the guard does not fall at `x` with a rate that exceeds rounding: the
/// jump has no derivative there. [`ErrorKind::ClockDerivative`] if a clock takes the edge, there
/// are parameters, and [`Linearize::tick_over`] does not say how they move its time.
pub fn saltation<A: Linearize>(
    automaton: &A,
    mode: A::Mode,
    edge: A::Edge,
    t: f64,
    x: &A::State,
) -> Result<Saltation, Error> {
    let failed = |refusal: Refusal| refusal.at("reset", Place::new(t, mode, Some(edge), x));
    let passage = Passage::of(automaton, mode, edge, t, x).map_err(failed)?;
    if passage.grazes(f64::INFINITY) {
        return Err(failed(Refusal::of(ErrorKind::Grazing)));
    }
    let (rows, columns, parameters) = (passage.after.len(), x.len(), automaton.parameters().len());
    let zero = x.with(|_| 0.0);
    let mut jump = Saltation {
        state: DMatrix::zeros(rows, columns),
        parameters: DMatrix::zeros(rows, parameters),
        time_by_state: RowDVector::zeros(columns),
        time_by_parameters: RowDVector::zeros(parameters),
    };
    for k in 0..columns {
        let unit = x.with(|i| if i == k { 1.0 } else { 0.0 });
        let delay = passage.delay(&unit, None).map_err(failed)?;
        let after = passage.across(&unit, None, delay);
        jump.time_by_state[k] = delay;
        (0..rows).for_each(|i| jump.state[(i, k)] = after.get(i));
    }
    for k in 0..parameters {
        let delay = passage.delay(&zero, Some(k)).map_err(failed)?;
        let after = passage.across(&zero, Some(k), delay);
        jump.time_by_parameters[k] = delay;
        (0..rows).for_each(|i| jump.parameters[(i, k)] = after.get(i));
    }
    Ok(jump)
}

/// A jump and what it takes to follow a neighbouring run through it.
///
/// A neighbour, off by δx at the time of the jump, crosses the guard later by the **delay**
/// `τ = -(g_x δx + g_p δp)/ġ`, where it has been carried to x + δx + f⁻ τ. There it is reset.
/// Carried back to the time of the jump by the flow after it, it is off by
/// `δx⁺ = R_x (δx + f⁻ τ) + R_t τ + R_p δp - f⁺ τ`: the saltation matrix times δx, without the
/// matrix.
pub(super) struct Passage<'a, A: Linearize> {
    automaton: &'a A,
    mode: A::Mode,
    edge: A::Edge,
    t: f64,
    x: &'a A::State,
    /// The mode after.
    pub(super) to: A::Mode,
    /// The state after, x⁺.
    pub(super) after: A::State,
    /// The flows f⁻ and f⁺.
    flows: (A::State, A::State),
    /// The guard's value, its gradient `g_x`, and its first and second derivative by time along the
    /// flow before.
    guard: f64,
    gradient: A::State,
    rate: f64,
    bend: f64,
    at: At,
}

/// What says when a jump happens.
#[derive(Clone, Copy, PartialEq)]
enum At {
    /// A guard, which reaches zero along the flow.
    Guard,
    /// A clock, at a time that only parameters move.
    Clock,
    /// A guard that switches in a stop, at a time that nothing moves.
    Stop,
    /// An end that the model does not determine, at a time without a derivative.
    Open,
}

impl<'a, A: Linearize> Passage<'a, A> {
    pub(super) fn of(automaton: &'a A, mode: A::Mode, edge: A::Edge, t: f64, x: &'a A::State) -> Result<Self, Refusal> {
        let (to, after) = automaton.reset(mode, edge, t, x)?;
        let flows = (automaton.flow(mode, t, x), automaton.flow(to, t, &after));
        let p = automaton.parameters();
        let standing = Self {
            automaton,
            mode,
            edge,
            t,
            x,
            to,
            after,
            flows,
            guard: 0.0,
            gradient: x.with(|_| 0.0),
            rate: 0.0,
            bend: 0.0,
            at: At::Clock,
        };
        if automaton.clocks(mode).edges().any(|other| other == edge) {
            return Ok(standing);
        }
        if standing.switches() {
            return Ok(Self { at: At::Stop, ..standing });
        }
        // Along the flow x moves with velocity f and acceleration df/dt.
        let f = &standing.flows.0;
        let changing = automaton.flow_over(mode, Dual64::new(t, 1.0), moving(x, f), moving_in(&p, None));
        let along = x.lift(|i| Dual2_64::new(x.get(i), f.get(i), x.pick(&changing, i).eps));
        let fixed = p.lift(|i| Dual2_64::new(p.get(i), 0.0, 0.0));
        let guard = automaton.guard_over(edge, Dual2_64::new(t, 1.0, 0.0), along, fixed);
        let slope = |i| automaton.guard_over(edge, Dual64::from(t), moving_in(x, Some(i)), moving_in(&p, None)).eps;
        let gradient = x.with(slope);
        let (guard, rate, bend) = (guard.re, guard.v1, guard.v2);
        if guard.is_nan() && automaton.about(edge).undetermined {
            return Ok(Self { at: At::Open, ..standing });
        }
        Ok(Self { guard, gradient, rate, bend, at: At::Guard, ..standing })
    }

    /// Whether the guard switches from inside to outside in a stop.
    fn switches(&self) -> bool {
        let stop = Smooth::stop_at(&self.automaton.stops(self.mode), self.t);
        let guard = |t: f64| self.automaton.guard(self.edge, t, self.x);
        stop.is_some_and(|stop| guard(stop.next_down()) >= 0.0 && guard(stop.next_up()) < 0.0)
    }

    /// Whether the crossing has no speed, but for rounding, at the end of an arc of `duration`.
    ///
    /// The rate ġ must be negative and exceed its own rounding; it must not be what g̈ makes of it
    /// within the rounding of time; and unless g̈ has had just the arc to build it up (as in the
    /// last of a ball's bounces, however low), the guard must have fallen from further away than
    /// its rounding, ġ²/2g̈.
    pub(super) fn grazes(&self, duration: f64) -> bool {
        if self.at != At::Guard {
            return false;
        }
        let (rate, bend) = (self.rate.abs(), self.bend.abs());
        let low = rate * rate <= 2.0 * bend * 4.0 * f64::EPSILON * self.size(self.x);
        self.rate >= 0.0
            || rate <= 8.0 * f64::EPSILON * self.size(&self.flows.0)
            || duration.is_finite() && rate <= 16.0 * f64::EPSILON * bend * duration
            || low && rate * 64.0 <= bend * duration
    }

    /// Whether the state before is outside the guard by more than rounding, as only an edge that
    /// fires on entry allows.
    pub(super) fn is_outside(&self) -> bool {
        self.at == At::Guard
            && self.guard < -8.0 * (self.rate.abs() * resolution(self.t)).max(f64::EPSILON * self.size(self.x))
    }

    /// How much later the neighbour crosses, τ: off by `dx`, and with the parameter `p`, if any,
    /// moving.
    pub(super) fn delay(&self, dx: &A::State, p: Option<usize>) -> Result<f64, Refusal> {
        match self.at {
            At::Guard => return Ok(-(self.along(dx) + self.by_parameter(p)) / self.rate),
            At::Clock if p.is_some() => {}
            At::Clock | At::Stop => return Ok(0.0),
            At::Open => return Ok(f64::NAN),
        }
        let parameters = moving_in(&self.automaton.parameters(), p);
        let tick = self.automaton.tick_over(self.mode, self.edge, self.t, parameters);
        tick.map(|tick: Dual64| tick.eps).ok_or_else(|| Refusal::of(ErrorKind::ClockDerivative))
    }

    /// Whether the neighbour crosses later by `last`, the delay of the jump before, as far as the
    /// rounding of the guard's terms can tell.
    pub(super) fn keeps(&self, last: f64, dx: &A::State, p: Option<usize>) -> bool {
        if self.at != At::Guard {
            return false;
        }
        let by_parameter = self.by_parameter(p);
        let off = self.along(dx) + by_parameter + self.rate * last;
        let terms = self.size(dx) + by_parameter.abs() + self.size(&self.flows.0) * last.abs();
        off.abs() <= 64.0 * f64::EPSILON * terms
    }

    /// Whether an arc of `duration` was too short for time to tell its ends apart, but for
    /// rounding.
    pub(super) fn is_at_once(&self, duration: f64) -> bool {
        duration <= 64.0 * resolution(self.t)
    }

    /// `g_x y`, and the sum of its terms' sizes.
    fn along(&self, y: &A::State) -> f64 {
        (0..y.len()).map(|i| self.gradient.get(i) * y.get(i)).sum()
    }
    fn size(&self, y: &A::State) -> f64 {
        (0..y.len()).map(|i| (self.gradient.get(i) * y.get(i)).abs()).sum()
    }

    /// `g_p` for the parameter `p`, zero for none.
    fn by_parameter(&self, p: Option<usize>) -> f64 {
        if p.is_none() {
            return 0.0;
        }
        let parameters = moving_in(&self.automaton.parameters(), p);
        self.automaton.guard_over(self.edge, Dual64::from(self.t), moving_in(self.x, None), parameters).eps
    }

    /// Where the neighbour that crosses with this `delay` is after the jump, δx⁺.
    pub(super) fn across(&self, dx: &A::State, p: Option<usize>, delay: f64) -> A::State {
        let (before, after) = &self.flows;
        // Where nobody crosses later the flows play no part: they may be undetermined.
        let delay = if self.at == At::Open { 0.0 } else { delay };
        let later = |flow: &A::State, i: usize| if delay == 0.0 { 0.0 } else { flow.get(i) * delay };
        let carried = dx.with(|i| dx.get(i) + later(before, i));
        let parameters = moving_in(&self.automaton.parameters(), p);
        let reset =
            self.automaton.reset_over(self.edge, Dual64::new(self.t, delay), moving(self.x, &carried), parameters);
        let landed = velocity(&reset, &self.after);
        landed.with(|i| landed.get(i) - later(after, i))
    }
}
