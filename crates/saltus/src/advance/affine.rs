//! An affine guard g(x) = a·x + b along a dense output: a polynomial of time.

use std::ops::Range;

use crate::automaton::Automaton;
use crate::certainty::{FEW, SURELY, TINY};
use crate::cross::{FirstFall, Powers, Start};
use crate::piece::LONG;
use crate::poly::{Bernstein, MAX_DEGREE, SUMMED};
use crate::state::State;
use crate::step::Stepper;

use super::Advance;
use super::shared::{Far, Shared, Step};

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// An affine guard less its `level` along a polynomial over `0..=stretch` times its scale, g(Σ
    /// cₖ θᵏ) = g(c₀) + Σ (g(cₖ) - g(0)) θᵏ, and its rounding.
    #[inline]
    pub(super) fn along<'p, 'c>(
        &mut self,
        edge: A::Edge,
        Step { now, c, .. }: Step<'c, A::State>,
        stretch: f64,
        (start, level): (Start, f64),
        (zero, shared): (&A::State, &mut Shared<'c, A::State>),
        powers: &'p mut Powers,
    ) -> Option<Along<'p>> {
        if c.len() > MAX_DEGREE + 1 {
            return None;
        }
        let t = now.seconds();
        self.memory.stats.guards += c.len() as u64 + 1;
        let guard = |x: &A::State| self.automaton.guard(edge, t, x);
        let (constant, g) = (guard(zero), guard(&c[0]));
        if constant != 0.0 && c.len() <= LONG {
            powers.fill(g - level, shared.far(c), |far| far.less_constant(&guard, constant), stretch);
        } else {
            powers.fill(g - level, &c[1..], |c| less_constant(guard, constant, c), stretch);
        }
        let count = &mut self.memory.stats.guards;
        if let (Start::Spent, Some(slope)) = (start, c.get(1))
            && only_touched(
                powers.coefficients(),
                &guard,
                constant,
                (slope, self.automaton.about(edge).read(slope.len())),
                count,
            )
        {
            powers.drop_slope();
        }
        Some(Along { powers, start: g, constant })
    }
}

/// An affine guard along a step in powers of time.
pub(super) struct Along<'p> {
    pub(super) powers: &'p Powers,
    /// The guard at the start, and its constant.
    start: f64,
    constant: f64,
}

impl Along<'_> {
    /// How far its value at the start may be off.
    fn rounding(&self) -> f64 {
        FEW * f64::EPSILON * (self.constant.abs() + self.start.abs())
    }

    /// Where it first falls, as far as its powers show it at once.
    pub(super) fn first_fall(&self, start: Start) -> FirstFall {
        let powers = self.powers;
        // What rounding has left of the guard at a wall is above zero all the same if nothing moves
        // by as much.
        if start != Start::Spent && exceeds(self.start, powers.change(), self.constant) {
            return FirstFall::Nowhere;
        }
        let margin = powers.rounding();
        // From a wall, be it spent or not, only the change counts.
        if start == Start::Spent || powers.coefficients()[0].abs() <= self.rounding() + margin {
            powers.first_fall(1, TINY * powers.bend() + margin)
        } else {
            powers.first_fall(0, self.rounding() + margin)
        }
    }

    /// The same in the Bernstein basis, how far it may be off, and how far it bends.
    pub(super) fn bernstein(&self) -> Option<(Bernstein, f64, f64)> {
        let p = Bernstein::from_powers(self.powers.coefficients())?;
        Some((p, self.rounding() + p.rounding(), self.powers.bend()))
    }
}

/// Whether a guard of the value `start` stays above zero when it changes by `most`,
/// with room for the digits that its `constant` costs.
#[inline]
pub(super) fn exceeds(start: f64, most: f64, constant: f64) -> bool {
    let rounding = SURELY * f64::EPSILON * (constant.abs() + start.abs() + most);
    start > most + rounding && rounding < f64::INFINITY
}

/// What an affine guard of this `constant` adds to it for the state `x`: taken of a state a power
/// of two larger, so that the constant does not cost it digits.
#[inline]
pub(super) fn less_constant<S: State>(guard: impl Fn(&S) -> f64, constant: f64, x: &S) -> f64 {
    if constant == 0.0 { guard(x) } else { less(&guard, constant, x) }
}

#[inline(never)] // few guards have a constant
fn less<S: State>(guard: &dyn Fn(&S) -> f64, constant: f64, x: &S) -> f64 {
    Far::of(x).less_constant(guard, constant)
}

/// Whether an affine guard of these `powers` that seems to fall from its root only touched zero
/// there: it bends down, and its slope, that of the state, is no more than rounding.
#[inline]
pub(super) fn only_touched<S: State>(
    powers: &[f64],
    guard: &dyn Fn(&S) -> f64,
    constant: f64,
    of: (&S, Range<usize>),
    count: &mut u64,
) -> bool {
    matches!(powers, [_, slope, bend, ..] if *slope < 0.0 && *bend < 0.0) && is_rounding(guard, constant, of, count)
}

/// Whether what an affine guard of this `constant` adds to it for the state `x` is no more than the
/// rounding of what each coordinate adds that it may `read`.
#[cold]
pub(super) fn is_rounding<S: State>(
    guard: &dyn Fn(&S) -> f64,
    constant: f64,
    (x, read): (&S, Range<usize>),
    count: &mut u64,
) -> bool {
    *count += read.len() as u64 + 1;
    let part = |k: usize| less_constant(guard, constant, &x.with(|i| if i == k { x.get(i) } else { 0.0 }));
    let parts: f64 = read.map(|k| part(k).abs()).sum();
    less_constant(guard, constant, x).abs() <= SUMMED * f64::EPSILON * parts
}
