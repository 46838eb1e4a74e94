//! Filippov sliding: two smooth flows and a surface between them become an automaton with a third
//! mode on the surface.

mod sides;
mod slopes;

pub use sides::Sides;

use std::borrow::Cow;

use crate::advance::Smooth;
use crate::automaton::clocks::Clock;
use crate::automaton::edges::Edges;
use crate::automaton::{About, Automaton, Entry};
use crate::certainty::{FAR, FEW};
use crate::error::Refusal;
use crate::state::State;

/// Two smooth flows on the two sides of a surface h(t, x) = 0.
///
/// | | |
/// |---|---|
/// | above, h > 0 | x' = f₊(t, x) |
/// | below, h < 0 | x' = f₋(t, x) |
/// | speed away from the surface, upwards | L± = n · f± + ∂h/∂t, with n = ∂h/∂x |
///
/// Each flow and the surface must be smooth on both sides of it, at least within one step of the
/// stepper: a step may look past the surface before the crossing is found. The gradient must not
/// vanish on the surface. [`Filippov`] makes an [`Automaton`] of it; [`Sides`] makes it of
/// closures.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Filippov, Side, Simulation, TwoSided};
///
/// /// A block of 1 kg on a spring of 100 N/m, rubbing with 3 N.
/// struct Block;
///
/// impl TwoSided for Block {
///     type State = Vector2<f64>; // position in m, velocity in m/s
///     fn above(&self, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         vector![x[1], -100.0 * x[0] - 3.0]
///     }
///     fn below(&self, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         vector![x[1], -100.0 * x[0] + 3.0]
///     }
///     fn surface(&self, _t: f64, x: &Vector2<f64>) -> f64 {
///         x[1]
///     }
///     fn normal(&self, _t: f64, _x: &Vector2<f64>) -> Vector2<f64> {
///         vector![0.0, 1.0]
///     }
///     fn affine(&self) -> bool {
///         true
///     }
/// }
///
/// let block = Filippov::of(Block);
/// let run = Simulation::of(&block).run(Side::Below, vector![0.1, 0.0], 0.0..10.0)?;
/// // Each half cycle takes 6 cm off: from 10 cm it swings to -4 cm and then to -2 cm, where the spring pulls with less than 3 N.
/// assert_eq!(run.end.mode, Side::Sliding);
/// assert!((run.end.state[0] + 0.02).abs() < 1e-9 && run.end.state[1].abs() < 1e-15);
/// # Ok::<(), saltus::Error>(())
/// ```
pub trait TwoSided {
    /// The continuous state.
    type State: State;

    /// The flow f₊ above the surface, in units of the state per second.
    fn above(&self, t: f64, x: &Self::State) -> Self::State;

    /// The flow f₋ below the surface, in units of the state per second.
    fn below(&self, t: f64, x: &Self::State) -> Self::State;

    /// h(t, x): positive above, negative below, zero on the surface; in any unit.
    fn surface(&self, t: f64, x: &Self::State) -> f64;

    /// The gradient n = ∂h/∂x, in units of h per unit of the state.
    fn normal(&self, t: f64, x: &Self::State) -> Self::State;

    /// ∂h/∂t, in units of h per second; zero for a surface at rest.
    fn surface_rate(&self, t: f64, x: &Self::State) -> f64 {
        let _ = (t, x);
        0.0
    }

    /// The margin by which the surface holds the state against leaving upwards, in units of h per
    /// second; the default is -L₊.
    ///
    /// More than that is a surface that holds more than it drags: static friction above kinetic
    /// friction.
    fn hold_above(&self, t: f64, x: &Self::State) -> f64 {
        -normal_speed(self, t, x, &self.above(t, x))
    }

    /// The margin by which the surface holds the state against leaving downwards, in units of h per
    /// second; the default is L₋.
    fn hold_below(&self, t: f64, x: &Self::State) -> f64 {
        normal_speed(self, t, x, &self.below(t, x))
    }

    /// Promises that h(t, x) = a · x + b with constants a and b: crossings cost less, and sliding
    /// needs no correction.
    fn affine(&self) -> bool {
        false
    }

    /// The times at which a flow or the surface is not smooth, as [`Automaton::stops`]; by default
    /// there are none.
    fn stops(&self) -> &[Clock] {
        &[]
    }

    /// The rate κ, in 1/s, at which a deviation from the surface decays while sliding: h' = -κ h.
    /// Not used where the surface is affine.
    ///
    /// Anything slow against a step and fast against the slide will do: it acts on deviations of
    /// the size of the tolerance. The default is 1/s.
    fn pull(&self) -> f64 {
        1.0
    }
}

impl<T: TwoSided + ?Sized> TwoSided for &T {
    type State = T::State;
    fn above(&self, t: f64, x: &T::State) -> T::State {
        (**self).above(t, x)
    }
    fn below(&self, t: f64, x: &T::State) -> T::State {
        (**self).below(t, x)
    }
    fn surface(&self, t: f64, x: &T::State) -> f64 {
        (**self).surface(t, x)
    }
    fn normal(&self, t: f64, x: &T::State) -> T::State {
        (**self).normal(t, x)
    }
    fn surface_rate(&self, t: f64, x: &T::State) -> f64 {
        (**self).surface_rate(t, x)
    }
    fn hold_above(&self, t: f64, x: &T::State) -> f64 {
        (**self).hold_above(t, x)
    }
    fn hold_below(&self, t: f64, x: &T::State) -> f64 {
        (**self).hold_below(t, x)
    }
    fn affine(&self) -> bool {
        (**self).affine()
    }
    fn stops(&self) -> &[Clock] {
        (**self).stops()
    }
    fn pull(&self) -> f64 {
        (**self).pull()
    }
}

/// So many roundings of its terms h may be off zero where a state is on the surface: what is left
/// of a curved surface, of a state that was worked out elsewhere.
const OFF: f64 = FAR * FAR;

/// How far ahead two flows that agree are looked at once more, as a part of the time, in s at zero:
/// far enough for a difference to show, near enough for nothing else to happen.
const AHEAD: f64 = 1.0 / (1_u64 << 26) as f64;

/// Whether two flows agree but for rounding.
fn agree<S: State>(f: &S, g: &S) -> bool {
    let apart = |i: usize| (f.get(i) - g.get(i)).abs() > FEW * f64::EPSILON * (f.get(i).abs() + g.get(i).abs());
    !(0..f.len()).any(apart)
}

/// L = n · f + ∂h/∂t: how fast h grows along the flow `f`.
fn normal_speed<T: TwoSided + ?Sized>(system: &T, t: f64, x: &T::State, f: &T::State) -> f64 {
    let n = system.normal(t, x);
    (0..x.len()).map(|i| n.get(i) * f.get(i)).sum::<f64>() + system.surface_rate(t, x)
}

/// Where a state of a [`Filippov`] automaton is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// h > 0.
    Above,
    /// h < 0.
    Below,
    /// On the surface, held there by the flows of both sides.
    Sliding,
}

/// The edges of a [`Filippov`] automaton.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Passage {
    /// The surface is met from above: into the slide, or through.
    FromAbove,
    /// The surface is met from below: into the slide, or through.
    FromBelow,
    /// The slide ends upwards.
    LeaveAbove,
    /// The slide ends downwards.
    LeaveBelow,
    /// The run ends where a slide loses both flows at once: where the state goes is not unique.
    Undecided,
    /// The run ends where a slide begins on a surface against which neither flow pushes.
    Unpushed,
}

/// The automaton of a discontinuous flow in Filippov's sense: three modes, [`Side::Above`],
/// [`Side::Below`] and [`Side::Sliding`].
///
/// **At the surface** the two normal speeds decide. If both point to the same side, the state
/// crosses. If they point at each other (L₊ < 0 < L₋), it slides, along the one convex combination
/// of the two flows that stays on the surface,
///
/// x' = α f₊ + (1 - α) f₋, α = L₋/(L₋ - L₊).
///
/// **The slide ends** where α reaches 1 (upwards: L₊ rises to zero) or 0 (downwards: L₋ falls to
/// zero). These are guards like any other, so the exit is found to full accuracy although the state
/// leaves tangentially, and nothing chatters: a slide is one arc.
///
/// **If they point away** from each other (L₋ < 0 < L₊, an escaping surface) the future is not
/// unique. No run reaches such a place; one that starts there must say to which side it goes:
/// [`side`](Self::side) answers `None`, and a run started there in [`Side::Sliding`] is refused.
///
/// **If neither points anywhere** (L₊ = L₋ = 0, a surface along which both flows run, or the point
/// at which a slide loses both), the future is not unique either: a slide ends there, with one of
/// the terminal edges [`Passage::Unpushed`] and [`Passage::Undecided`].
///
/// **Drift.** On entry and exit the state is put on the surface, by no more than its rounding where
/// the surface is affine. In between, an affine surface keeps the state to rounding, because
/// Runge-Kutta methods conserve linear invariants; for a curved or moving one α is chosen such that
/// h' = -κ h instead of h' = 0 (see [`TwoSided::pull`]), which stays within the same convex set.
///
/// **The derivatives of the surface** are compared with its differences wherever a state comes to
/// it: a gradient or a rate that they contradict (a surface that moves without
/// [`surface_rate`](TwoSided::surface_rate), a normal of another length) is an error of the model.
/// At a kink, and where rounding hides the differences, they are believed.
///
/// Limits: one surface. Where two meet, Filippov's solution need not be unique.
///
/// ```
/// use saltus::{Filippov, Side, Sides, Simulation};
///
/// // A relay: x' = -sign(x).
/// let relay = Filippov::of(Sides::new(|_, _: &f64| -1.0, |_, _| 1.0, |_, x| *x, |_, _| 1.0));
/// let run = Simulation::of(&relay).run(Side::Above, 1.5, 0.0..10.0)?;
/// assert_eq!((run.end.mode, run.end.state), (Side::Sliding, 0.0));
/// assert_eq!(run.trajectory.jumps().len(), 1);
/// assert!((run.trajectory.jumps()[0].t() - 1.5).abs() < 1e-15);
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// A. F. Filippov, *Differential Equations with Discontinuous Righthand Sides* (Kluwer, 1988), 2.4;
/// L. Dieci, L. Lopez, J. Comput. Appl. Math. 236 (2012) 3967, doi:10.1016/j.cam.2012.02.011.
#[derive(Clone, Copy, Debug)]
pub struct Filippov<T> {
    pub(crate) system: T,
}

impl<T: TwoSided> Filippov<T> {
    /// The automaton of `system`, which may be a reference.
    #[must_use]
    pub const fn of(system: T) -> Self {
        Self { system }
    }

    /// The mode in which the state `x` at time `t` is; `None` on an escaping surface, where the
    /// model must choose.
    ///
    /// A state counts as on the surface when h is zero but for the rounding of its coordinates.
    #[must_use]
    pub fn side(&self, t: f64, x: &T::State) -> Option<Side> {
        let h = self.system.surface(t, x);
        if h.abs() > self.rounding(t, x) {
            return Some(if h > 0.0 { Side::Above } else { Side::Below });
        }
        match (self.system.hold_above(t, x) >= 0.0, self.system.hold_below(t, x) >= 0.0) {
            (true, true) => Some(Side::Sliding),
            (false, true) => Some(Side::Above),
            (true, false) => Some(Side::Below),
            (false, false) => None,
        }
    }

    /// What rounding of t and of the coordinates may make of h = 0.
    fn rounding(&self, t: f64, x: &T::State) -> f64 {
        let n = self.system.normal(t, x);
        let size: f64 = (0..x.len()).map(|i| (n.get(i) * x.get(i)).abs()).sum();
        FEW * f64::EPSILON * (size + (self.system.surface_rate(t, x) * t).abs())
    }

    /// How far L₋ - L₊, by which the flows push the state against the surface, is above what
    /// rounding may make of zero.
    ///
    /// Where both flows are one no push is needed.
    fn push(&self, t: f64, x: &T::State) -> f64 {
        let (above, below) = (self.system.above(t, x), self.system.below(t, x));
        if self.are_one(t, x, &above, &below) {
            return 1.0;
        }
        let (n, rate) = (self.system.normal(t, x), self.system.surface_rate(t, x));
        let size: f64 = (0..x.len()).map(|i| n.get(i).abs() * (above.get(i).abs() + below.get(i).abs())).sum();
        let gap: f64 = (0..x.len()).map(|i| n.get(i) * (below.get(i) - above.get(i))).sum();
        gap - f64::MIN_POSITIVE - FEW * f64::EPSILON * (size + 2.0 * rate.abs())
    }

    /// Whether both flows are one from here on, and not only at this point: a brake that is
    /// released.
    pub(crate) fn are_one(&self, t: f64, x: &T::State, above: &T::State, below: &T::State) -> bool {
        if !agree(above, below) {
            return false;
        }
        // No farther than to the next stop, in which another brake may be applied.
        let far = t + if t == 0.0 { AHEAD } else { AHEAD * t.abs() };
        let then = Smooth::before_stop(self.system.stops(), t, far);
        let (t, x) = (then, x.with(|i| x.get(i) + (then - t) * above.get(i)));
        agree(&self.system.above(t, &x), &self.system.below(t, &x))
    }

    fn slide(&self, t: f64, x: &T::State) -> T::State {
        let (above, below) = (self.system.above(t, x), self.system.below(t, x));
        if self.are_one(t, x, &above, &below) {
            return above;
        }
        let (up, down) = (normal_speed(&self.system, t, x, &above), normal_speed(&self.system, t, x, &below));
        let pull = if self.system.affine() { 0.0 } else { self.system.pull() * self.system.surface(t, x) };
        // Weighted like this, a coordinate that both flows hold against each other stands still
        // exactly.
        let (up, down, gap) = (up + pull, down + pull, down - up);
        if gap == 0.0 {
            return above; // neither moves h beside the other
        }
        x.with(|i| (down * above.get(i) - up * below.get(i)) / gap)
    }

    /// The state moved to h = `target`, each coordinate in proportion to its own rounding.
    fn moved_to(&self, target: f64, t: f64, x: &T::State) -> T::State {
        let n = self.system.normal(t, x);
        let weight = |i: usize| (n.get(i) * x.get(i)) * x.get(i);
        let total: f64 = (0..x.len()).map(|i| n.get(i) * weight(i)).sum();
        let missing = target - self.system.surface(t, x);
        if missing == 0.0 {
            return x.clone();
        }
        let by = if total > 0.0 {
            x.with(|i| missing * (weight(i) / total))
        } else {
            let total: f64 = (0..x.len()).map(|i| n.get(i) * n.get(i)).sum();
            x.with(|i| missing * (n.get(i) / total))
        };
        // What cancels but for rounding is zero: what is left of it says nothing of its size.
        let cancels = |i: usize| (x.get(i) + by.get(i)).abs() <= FEW * f64::EPSILON * x.get(i).abs();
        let y = x.with(|i| if cancels(i) { 0.0 } else { x.get(i) + by.get(i) });
        if y.is_finite() { y } else { x.clone() }
    }

    /// The surface where it leaps in a stop at the same instant as `t`: when that is, and h behind
    /// it.
    fn leap(&self, t: f64, x: &T::State) -> Option<(f64, f64)> {
        let stop = Smooth::stop_at(self.system.stops(), t)?;
        let [before, behind] = [stop.next_down(), stop.next_up()].map(|t| self.system.surface(t, x));
        ((behind - before).abs() > self.rounding(stop, x)).then_some((stop, behind))
    }

    /// The margin of a slide from which the surface has leapt just before `t`, so that the state is
    /// `above` it (1), or below (-1): how far that is, and negative.
    fn leapt(&self, above: f64, t: f64, x: &T::State) -> Option<f64> {
        self.leap(t, x).filter(|&(stop, h)| t > stop && above * h > 0.0).map(|(_, h)| -h.abs())
    }

    /// On the surface: two of Newton's steps.
    fn onto(&self, t: f64, x: &T::State) -> T::State {
        self.moved_to(0.0, t, &self.moved_to(0.0, t, x))
    }
}

impl<T: TwoSided> Automaton for Filippov<T> {
    type Mode = Side;
    type State = T::State;
    type Edge = Passage;

    fn flow(&self, mode: Side, t: f64, x: &T::State) -> T::State {
        match mode {
            Side::Above => self.system.above(t, x),
            Side::Below => self.system.below(t, x),
            Side::Sliding => self.slide(t, x),
        }
    }

    fn edges(&self, mode: Side) -> Edges<'_, Passage> {
        match mode {
            Side::Above => Edges::from([Passage::FromAbove]),
            Side::Below => Edges::from([Passage::FromBelow]),
            Side::Sliding => {
                // First what is found at the same time as both exits; last what is asked of a slide
                // that neither exit refuses.
                Edges::from([Passage::Undecided, Passage::LeaveAbove, Passage::LeaveBelow, Passage::Unpushed])
            }
        }
    }

    fn guard(&self, edge: Passage, t: f64, x: &T::State) -> f64 {
        match edge {
            Passage::FromAbove => self.system.surface(t, x),
            Passage::FromBelow => -self.system.surface(t, x),
            Passage::LeaveAbove => self.leapt(1.0, t, x).unwrap_or_else(|| self.system.hold_above(t, x)),
            Passage::LeaveBelow => self.leapt(-1.0, t, x).unwrap_or_else(|| self.system.hold_below(t, x)),
            Passage::Undecided | Passage::Unpushed => self.push(t, x),
        }
    }

    fn reset(&self, _: Side, edge: Passage, t: f64, x: &T::State) -> Result<(Side, T::State), Refusal> {
        // A surface that leaps leaves the state where it is.
        let leap = self.leap(t, x).map_or(0.0, |(_, h)| h);
        Ok(match edge {
            Passage::FromAbove | Passage::LeaveBelow if leap < 0.0 => (Side::Below, x.clone()),
            Passage::FromBelow | Passage::LeaveAbove if leap > 0.0 => (Side::Above, x.clone()),
            Passage::FromAbove if self.system.hold_below(t, x) < 0.0 => (Side::Below, x.clone()),
            Passage::FromBelow if self.system.hold_above(t, x) < 0.0 => (Side::Above, x.clone()),
            Passage::FromAbove | Passage::FromBelow => (Side::Sliding, self.onto(t, x)),
            Passage::LeaveAbove => (Side::Above, self.onto(t, x)),
            Passage::LeaveBelow => (Side::Below, self.onto(t, x)),
            Passage::Undecided | Passage::Unpushed => (Side::Sliding, x.clone()),
        })
    }

    fn stops(&self, _: Side) -> Cow<'_, [Clock]> {
        self.system.stops().into()
    }

    fn validate(&self, mode: Side, t: f64, x: &T::State) -> Result<(), String> {
        let h = self.system.surface(t, x);
        let on_surface = h.is_nan() || h.abs() <= OFF * self.rounding(t, x);
        if let Some(untrue) =
            (on_surface || mode == Side::Sliding).then(|| slopes::untrue(&self.system, t, x)).flatten()
        {
            return Err(untrue.to_string());
        }
        if on_surface || mode != Side::Sliding {
            return Ok(());
        }
        let side = if h > 0.0 { Side::Above } else { Side::Below };
        Err(format!(
            "{mode:?} is on the surface, and h = {h} here: start in {side:?}, or in the mode that Filippov::side gives"
        ))
    }

    #[inline]
    fn about(&self, edge: Passage) -> About {
        match edge {
            Passage::FromAbove | Passage::FromBelow => About::new().affine_if(self.system.affine()),
            Passage::LeaveAbove | Passage::LeaveBelow => About::new(),
            Passage::Undecided => About::new().entry(Entry::Wait).undetermined(),
            Passage::Unpushed => About::new().entry(Entry::Fire).undetermined(),
        }
    }
}
