//! Whether a flow is stiff: an explicit method's steps are short for stability alone.

use crate::automaton::Automaton;
use crate::control::Controller;
use crate::state::State;
use crate::step::{Stepper, Trial};

use super::Advance;

/// A step is looked at after this many at the earliest, as long as nothing speaks for a change.
///
/// A look costs two evaluations of the flow: with one in 32 steps and ever fewer a flow that is
/// not stiff loses less than two percent (tests/stiffness.rs, `what_is_not_stiff_loses_little`);
/// after twice as many a short stiff arc would be over (`no_more_than_twice_the_best_choice`).
const SELDOM: u64 = 32;

/// Each look in vain makes the steps to the next one more by one in so many: a run notices that it
/// has become stiff later by no more than this part of its steps, and n steps that are not stiff
/// are looked at log n times.
const LATER: u64 = 4;

/// As so many steps counts one that is rejected.
const REJECTED: u64 = 8;

/// So many looks in a row must speak for a change of method, the first time, for it to be made: one
/// long step may be so by chance (E. Hairer, G. Wanner, *Solving Ordinary Differential Equations
/// II*, IV.2).
const SIGNS: u32 = 5;

/// After each change twice as many, up to this many: a flow that is stiff now and then does not
/// change its method all the time.
const MOST_SIGNS: u32 = 128;

/// The part of the stable length that a step limited by stability has at least: around that length
/// steps grow and are rejected in turn.
const NEAR: f64 = 0.7;

/// How far a coordinate is moved to see how the flow changes, relative to its size: the square root
/// of the rounding of a double.
const NUDGE: f64 = 1.5e-8;

/// Products with the Jacobian after which the largest eigenvalue is good to a few parts in ten.
const PRODUCTS: usize = 2;

/// Which kind of method a run uses, and what speaks for the other.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Gait {
    pub(super) stiff: bool,
    signs: u32,
    patience: u32,
    /// Steps from one look to the next.
    wait: u64,
    /// Those until the next one.
    left: u64,
    /// Whether the next step is the first of another method.
    changes: bool,
}

impl Gait {
    pub(super) const START: Self =
        Self { stiff: false, signs: 0, patience: SIGNS, wait: SELDOM, left: SELDOM, changes: false };

    /// A step was rejected, as those are that stability limits.
    pub(super) fn rejected(&mut self) {
        self.left = self.left.saturating_sub(REJECTED);
    }
}

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// After an accepted step: changes the method of a stepper that has two, where the flow has
    /// become stiff or is so no more.
    #[inline]
    pub(super) fn notice_stiffness(
        &mut self,
        mode: A::Mode,
        t: f64,
        x: &A::State,
        h: f64,
        trial: &Trial<A::State, M::Stages<A::State>>,
        slope: &A::State,
    ) {
        let Some(limit) = self.stepper.stable_to() else { return };
        self.memory.stats.stiff += u64::from(self.memory.gait.stiff);
        self.memory.gait.left = self.memory.gait.left.saturating_sub(1);
        if self.memory.gait.left == 0 {
            let change = x.with(|i| trial.slope.get(i) - slope.get(i));
            // Copies: what others refer to is kept in memory.
            let (end, slope) = (trial.end.clone(), trial.slope.clone());
            self.look_at_stiffness(mode, t + h, (&end, &slope), change, h / limit);
        }
    }

    #[cold]
    #[inline(never)]
    fn look_at_stiffness(
        &mut self,
        mode: A::Mode,
        t: f64,
        (end, slope): (&A::State, &A::State),
        change: A::State,
        part: f64,
    ) {
        self.memory.gait.left = self.memory.gait.wait;
        // Of a state that the tolerance does not resolve nothing tells what its guards want of a
        // method.
        if self.options.tolerance.norm(end, end, end) < 1.0 && !self.automaton.edges(mode).is_empty() {
            return;
        }
        let stiff = part * self.damping(mode, t, (end, slope), change) > NEAR;
        let gait = &mut self.memory.gait;
        if stiff == gait.stiff {
            (gait.signs, gait.wait) = (0, gait.wait + gait.wait / LATER);
            return;
        }
        (gait.signs, gait.left) = (gait.signs + 1, 0);
        if gait.signs >= gait.patience {
            let patience = MOST_SIGNS.min(2 * gait.patience);
            *gait = Gait { stiff, patience, changes: true, ..Gait::START };
        }
    }

    /// Before a step: the method that was chosen after the last one, whose dense output was still
    /// to be made by its own.
    #[inline]
    pub(super) fn change_method(&mut self) {
        if self.memory.gait.changes {
            self.memory.gait.changes = false;
            self.stepper = self.stepper.adapted(self.memory.gait.stiff);
            self.memory.controller = Controller::new(&self.stepper);
        }
    }

    /// How fast the flow at `x` forces nearby solutions together, in 1/s: the size of the largest
    /// eigenvalue of its Jacobian, by powers of it from `v` on (B. Sommeijer, L. Shampine, J.
    /// Verwer, J. Comput. Appl. Math. 88 (1998) 315); nothing where that turns them round or drives
    /// them apart.
    fn damping(&mut self, mode: A::Mode, t: f64, (x, slope): (&A::State, &A::State), v: A::State) -> f64 {
        let tolerance = self.options.tolerance;
        let size = |v: &A::State| tolerance.norm(v, x, x);
        let (mut v, mut largest) = (if size(&v) > 0.0 { v } else { slope.clone() }, 0.0);
        for _ in 0..PRODUCTS {
            let length = size(&v);
            if !(length > 0.0 && length.is_finite()) {
                return 0.0;
            }
            let by = NUDGE / (tolerance.relative * length);
            let ahead = self.flow(mode, t, &x.with(|i| x.get(i) + by * v.get(i)));
            let product = x.with(|i| (ahead.get(i) - slope.get(i)) / by);
            // |v + J v/λ| < |v|: the product points back, to within sixty degrees.
            let rate = size(&product) / length;
            let left = x.with(|i| v.get(i) + product.get(i) / rate);
            largest = if size(&left) < length { rate } else { 0.0 };
            v = product;
        }
        largest
    }
}
