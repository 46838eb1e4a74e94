//! What is kept from arc to arc.

use smallvec::SmallVec;

use crate::certainty::{FEW, SMALL};
use crate::control::Controller;
use crate::ending::Stats;
use crate::state::State;
use crate::step::Stepper;

use super::smooth::Switched;
use super::stiff::Gait;

/// An edge taken, whose root is spent, and how far from zero its guard is there for rounding alone.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Spent<E> {
    pub(super) edge: E,
    pub(super) slack: f64,
}

/// An edge at whose wall the state is: its guard is zero, but for rounding or the drift of the
/// steps.
#[derive(Clone, Copy)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Wall<E> {
    pub(super) edge: E,
    /// What rounding or drift has left of the guard.
    pub(super) level: f64,
    /// Whether the flow runs along the wall, as far as rounding shows: the edge stays, and is taken
    /// only where the flow carries the guard down.
    pub(super) stays: bool,
    /// Whether the flow leads down from it, beyond what rounding shows: the edge is taken at once.
    pub(super) falls: bool,
    /// Whether the flow leads up from it by and by, at a rate that is none at first as far as noise
    /// shows: its zero is spent.
    pub(super) rises: bool,
}

/// So few edges at a time lie at their walls, or go on falling, in most systems: a list of no more
/// is kept in place, and nothing is allocated for it.
const FEW_EDGES: usize = 4;

/// So many arcs in a row whose durations rounding spoils have accumulated: one may be short by
/// chance.
const IN_A_ROW: u32 = 3;

/// So many arcs in a row so short that time does not resolve them make no headway: a guard that
/// moves with time has but a few values on each.
/// Held by `late::a_plastic_ball_on_a_table_rests`.
pub(super) const CROWDED: u32 = 64;

/// A list of edges, of any length.
pub(super) type Few<T> = SmallVec<[T; FEW_EDGES]>;

/// What is kept from arc to arc.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Memory<M, E, S> {
    pub(crate) stats: Stats,
    /// What each coordinate was summed up from, over the arcs so far that took time, since it was
    /// last exactly zero: the largest of |xᵢ| at the start of an arc and of its `reach`.
    pub(super) largest: Option<S>,
    /// What each coordinate was summed up from on the arc so far: the largest, over its pieces, of
    /// |xᵢ| at their start and of |xᵢ'| there times how long they last.
    pub(super) reach: Option<S>,
    /// The last jump, where it left a coordinate far smaller than what that was summed up from
    /// before.
    pub(super) left: Option<Left<M, S>>,
    pub(super) controller: Controller,
    pub(super) gait: Gait,
    pub(super) step: Option<f64>,
    pub(super) spent: Option<Spent<E>>,
    /// The edge of the last jump.
    pub(super) last: Option<E>,
    /// Edges taken earlier whose guards went on falling, and how fast: not taken again before they
    /// have risen, or are driven on.
    pub(super) idle: Few<(Spent<E>, f64)>,
    /// Edges whose guards are zero, but for rounding, as the mode is entered, and were not just
    /// taken.
    pub(super) walls: Few<Wall<E>>,
    /// How far the search of this exact arc went before a limit of the run cut it.
    pub(super) cut_at: Option<f64>,
    pub(super) slack: f64,
    /// Whether the guard leapt at the last crossing.
    pub(super) leapt: bool,
    pub(super) last_duration: f64,
    pub(super) longest_duration: f64,
    /// How many arcs in a row, up to the last one, were so short that the rounding of a guard
    /// spoils their duration.
    pub(super) hidden: u32,
    /// How many arcs in a row, up to the last one, no longer than a few spacings of time, ended by
    /// a guard that moves with time itself.
    pub(super) crowded: u32,
    /// How many arcs there were.
    pub(super) arcs: u64,
    /// How many steps there were before this arc.
    pub(super) steps_before: u64,
    /// Whether a guard has been farther from zero, on a step with a crossing, than the error of the
    /// step.
    pub(super) resolved: bool,
    /// x⁻ of the last crossing on a step, and x' there.
    pub(super) before: Option<(S, S)>,
    /// What the last jump has left as it was, if anything.
    pub(super) kept: Option<Kept>,
    /// Edges that were taken in the last stop because their guards switch there.
    pub(super) switched: Switched<E>,
    /// Whether the last crossing was the rounding of its guard, on an arc that leads away from
    /// zero: jumps have accumulated as far as numbers resolve.
    pub(crate) spurious: bool,
}

/// A jump from the state `before` in the mode `from` to the mode `to`.
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Left<M, S> {
    pub(super) from: M,
    pub(super) before: S,
    pub(super) to: M,
}

/// What a jump has left as it was, so that it gave no guard a cause to fall that had fallen.
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone, Copy)]
pub(crate) enum Kept {
    /// The slope: no guard moves otherwise than before.
    Slope,
    /// The state alone: the edge just taken is where it was.
    State,
}

impl<M, E: Copy + PartialEq, S: State> Memory<M, E, S> {
    #[inline(always)]
    pub(crate) fn new(stepper: &impl Stepper, first_step: Option<f64>) -> Self {
        Self {
            stats: Stats::default(),
            largest: None,
            reach: None,
            left: None,
            controller: Controller::new(stepper),
            gait: Gait::START,
            step: first_step,
            spent: None,
            last: None,
            idle: Few::new_const(),
            walls: Few::new_const(),
            cut_at: None,
            slack: 0.0,
            leapt: false,
            last_duration: 0.0,
            longest_duration: 0.0,
            hidden: 0,
            crowded: 0,
            arcs: 0,
            steps_before: 0,
            resolved: false,
            before: None,
            kept: None,
            switched: Switched::none(),
            spurious: false,
        }
    }

    /// The edge among those whose root at this time is spent.
    #[inline]
    pub(super) fn spent_as(&self, edge: E) -> Option<Spent<E>> {
        let idle = self.idle.iter().map(|(spent, _)| spent);
        self.spent.iter().chain(idle).find(|spent| spent.edge == edge).copied()
    }

    /// The guard of `edge` is zero as the mode is entered, but for rounding, which has left `g` of
    /// it.
    pub(super) fn at_wall(&mut self, edge: E, g: f64) {
        self.walls.push(Wall { edge, level: g, stays: false, falls: false, rises: false });
    }

    #[cold]
    #[inline(never)]
    pub(super) fn level(&self, edge: E) -> f64 {
        self.wall(edge).map_or(0.0, |wall| wall.level)
    }

    pub(super) fn wall(&self, edge: E) -> Option<&Wall<E>> {
        self.walls.iter().find(|wall| wall.edge == edge)
    }

    /// The next step is to be no longer than this.
    #[inline]
    pub(super) fn cut(&mut self, longest: f64) {
        self.step = self.step.map(|step| step.min(longest));
    }

    /// A piece of the arc from `x` lasted so long that each coordinate changed `by` so much, if it
    /// went on as at its start; a step of an implicit method is not summed up from that. What is
    /// within a factor of two of what there was is left.
    #[inline]
    pub(super) fn reaches(&mut self, x: &S, by: impl Fn(usize) -> f64) {
        let stiff = self.gait.stiff;
        let here = |i: usize| larger(x.get(i).abs(), if stiff { 0.0 } else { by(i).abs() });
        self.reach = match self.reach.take() {
            Some(reach) if (0..x.len()).all(|i| here(i) <= 2.0 * reach.get(i)) => Some(reach),
            Some(reach) => Some(x.with(|i| larger(reach.get(i), here(i)))),
            None => Some(x.with(here)),
        };
    }

    /// An arc from `x` that took time has ended.
    #[inline(always)]
    pub(super) fn went(&mut self, x: &S) {
        let alike = |y: &S| y.len() == x.len();
        let (largest, reach) = (self.largest.take().filter(alike), self.reach.take().filter(alike));
        self.largest = Some(x.with(|i| {
            let here = x.get(i).abs();
            let before = largest.as_ref().map_or(0.0, |largest| if here == 0.0 { 0.0 } else { largest.get(i) });
            let way = reach.as_ref().map_or(0.0, |reach| reach.get(i).abs());
            larger(larger(here, before), way)
        }));
    }

    /// Whether a jump to `after` leaves a coordinate far smaller than what that was summed up from
    /// before, and not exactly zero.
    #[inline]
    pub(super) fn shrinks(&self, after: &S) -> bool {
        let small = |x: f64, largest: f64| x != 0.0 && x.abs() < SMALL * largest;
        let Some(largest) = self.largest.as_ref().filter(|largest| largest.len() == after.len()) else { return false };
        (0..after.len()).any(|i| small(after.get(i), largest.get(i)))
    }

    /// Whether an arc is so short beside the longest one that rounding may show in what guards do
    /// on it.
    #[inline]
    pub(crate) fn is_short(&self, duration: f64) -> bool {
        duration < SMALL * self.longest_duration
    }

    /// Whether a time after a jump is so short that rounding cannot tell it from that jump's.
    #[inline]
    pub(crate) fn at_once(&self, since: f64) -> bool {
        since <= FEW * f64::EPSILON * self.last_duration
    }

    /// Whether the rounding of a guard spoils the durations of the last arcs.
    pub(crate) fn hides_durations(&self) -> bool {
        self.hidden >= IN_A_ROW
    }

    /// Whether the last jump took this very edge.
    pub(crate) fn just_took(&self, edge: E) -> bool {
        self.spent.is_some_and(|spent| spent.edge == edge)
    }

    /// After a jump that no edge made.
    pub(crate) fn beyond(&mut self) {
        (self.spent, self.last, self.left) = (None, None, None);
    }
}

/// The larger of two numbers, the first where the second is none.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}
