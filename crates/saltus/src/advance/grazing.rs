//! Where a guard comes so close to zero, and turns, that the error of the step decides whether it
//! falls.

use crate::automaton::Automaton;
use crate::certainty::{ROUGHLY, ROUNDINGS, SMALL, SURELY};
use crate::cross::{Doubt, Evidence, Turn};
use crate::state::State;
use crate::step::Stepper;

use super::Advance;
use super::crossing::Range;
use super::memory::Kept;
use super::shared::Step;

/// Halvings, by the golden section, of the stretch on which a guard turns: its least value is then
/// below what the tolerance allows off by the square of 0.618⁴⁰.
const SECTIONS: usize = 40;

impl<A: Automaton, M: Stepper> Advance<'_, A, M> {
    /// Of a guard that does not fall on a step, and turns between two times: whether its least
    /// value is within the error of the step, and when. Of a guard that `leaves` zero at the start
    /// of the step a least value that reaches back to there is that zero.
    ///
    /// Of a guard below zero, as that of an edge that waits, the same from there: the value
    /// nearest to zero. At the start of an arc it has come up from nowhere.
    #[cold]
    #[inline(never)]
    pub(super) fn missed(
        &mut self,
        edge: A::Edge,
        (step, range): (Step<'_, A::State>, Range),
        Turn { between: turn, below }: Turn,
        leaves: bool,
    ) -> Option<Evidence> {
        let ends = [self.on(edge, step, turn[0]), self.on(edge, step, turn[1])];
        let side = if below { -1.0 } else { 1.0 };
        let (ends, leaves) = (ends.map(|g| side * g), leaves || below && range.first);
        let (s, least) = self.least(edge, step, turn, side);
        let rise = ends[0].max(ends[1]) - least;
        if !(least >= 0.0 && least <= ROUGHLY * rise) {
            return None;
        }
        // Where it is nearest at the start of the step it may have fallen from there all along.
        let near = SMALL * step.size;
        if below && s <= near && -self.on(edge, step, s - near) <= least {
            return None;
        }
        let room = self.error_of(edge, (step, range), s, side * least) - least;
        // As far to both sides as a parabola through the least value and an end stays within it.
        let half = |end: usize| (turn[end] - s).abs() * (room / (ends[end] - least)).sqrt().min(1.0);
        let (from, to) = (s - half(0), s + half(1));
        (room >= 0.0 && !(leaves && from <= 0.0)).then(|| Evidence::doubtful(Doubt::Grazing, from, to))
    }

    /// Of a guard that falls at `root`: whether the error of the step decides that. Its first two
    /// derivatives there are given where its powers are.
    #[inline]
    pub(super) fn grazes(
        &mut self,
        edge: A::Edge,
        (step, range): (Step<'_, A::State>, Range),
        root: f64,
        derivatives: Option<[f64; 2]>,
    ) -> Option<Evidence> {
        // Before a fall at the start of the step nothing shows how the guard came there.
        if root >= SMALL * step.size
            && let Some(evidence) =
                self.dips(edge, (step, range), root, derivatives).or_else(|| self.unresolved(edge, step, root))
        {
            return Some(evidence);
        }
        self.hovers(edge, (step, range), root)
    }

    /// Of a guard that falls at `root`: whether it rises again from within the error of the step,
    /// or has come up to zero by no more than that, and when.
    #[inline]
    fn dips(
        &mut self,
        edge: A::Edge,
        (step, range): (Step<'_, A::State>, Range),
        root: f64,
        derivatives: Option<[f64; 2]>,
    ) -> Option<Evidence> {
        let [slope, bend] = derivatives.unwrap_or_else(|| self.derivatives(edge, step, root));
        let soon = -slope < bend.abs() * (ROUGHLY * step.size);
        soon.then(|| self.shallow(edge, (step, range), root, (-slope / bend, bend)))?
    }

    /// The first two derivatives of a guard at its `root`, by differences.
    #[inline(never)]
    fn derivatives(&mut self, edge: A::Edge, step: Step<'_, A::State>, root: f64) -> [f64; 2] {
        let by = SMALL * step.size;
        // Zero between them.
        let (before, after) = (self.on(edge, step, root - by), self.on(edge, step, root + by));
        [(after - before) / (2.0 * by), (before + after) / (by * by)]
    }

    #[cold]
    #[inline(never)]
    fn shallow(
        &mut self,
        edge: A::Edge,
        (step, range): (Step<'_, A::State>, Range),
        root: f64,
        (turn, bend): (f64, f64),
    ) -> Option<Evidence> {
        let (depth, far) = (0.5 * bend.abs() * turn * turn, turn.abs());
        if bend < 0.0 && !self.came_up(edge, (step, range), root, (far, depth)) {
            return None;
        }
        let close = depth <= self.error_of(edge, (step, range), root, 0.0);
        let [before, after] = if bend < 0.0 { [3.0, 0.0] } else { [1.0, 2.0] };
        close.then(|| Evidence::doubtful(Doubt::Grazing, (root - before * far).max(0.0), root + after * far))
    }

    /// Whether a guard that falls at `root`, and turned a time `turn` before at a height of
    /// `depth`, came up from below zero: not from zero at the start of the arc. By a parabola it
    /// was three times as far below three times as long before.
    fn came_up(
        &mut self,
        edge: A::Edge,
        (step, range): (Step<'_, A::State>, Range),
        root: f64,
        (turn, depth): (f64, f64),
    ) -> bool {
        if range.first && root - 2.0 * turn <= ROUGHLY * root {
            return false;
        }
        let before = root - 3.0 * turn;
        let before = if range.first { before.max(0.0) } else { before };
        self.on(edge, step, before) < -depth
    }

    /// Whether a guard that falls at `root` has been no farther from zero on the step than what the
    /// absolute tolerance leaves open, nor any other on a step of this run before: all that moves
    /// is of a size that this tolerance does not resolve.
    #[inline]
    fn unresolved(&mut self, edge: A::Edge, step: Step<'_, A::State>, root: f64) -> Option<Evidence> {
        if self.memory.resolved { None } else { self.resolve(edge, step, root) }
    }

    #[cold]
    #[inline(never)]
    fn resolve(&mut self, edge: A::Edge, step: Step<'_, A::State>, root: f64) -> Option<Evidence> {
        let middle = 0.5 * root;
        let (start, half) = (self.on(edge, step, 0.0), self.on(edge, step, middle));
        let (absolute, x) = (self.options.tolerance.absolute, step.at(middle));
        let off = self.moved(edge, step.time(middle), &x, half, &|_| ROUNDINGS * absolute);
        self.memory.resolved = start.abs().max(half.abs()) > SURELY * off;
        (!self.memory.resolved).then_some(Evidence::doubtful(Doubt::Grazing, 0.0, root))
    }

    /// Notes a guard that stays at its wall on a step up to `limit` where what it reads moves, and
    /// is of a size there that the absolute tolerance does not resolve: whether the flow carries
    /// it up or down then says nothing. Later steps of the arc may show it.
    #[cold]
    #[inline(never)]
    pub(super) fn hold_down(&mut self, edge: A::Edge, step: Step<'_, A::State>, limit: f64) {
        let (start, later) = (step.at(0.0), [0.5 * limit, limit].map(|s| step.at(s)));
        let (absolute, t, g) = (self.options.tolerance.absolute, step.time(0.0), self.on(edge, step, 0.0));
        let most = |i: usize, from: f64| later.iter().fold(0.0, |most: f64, x| most.max((x.get(i) - from).abs()));
        let mut moved = |by: &dyn Fn(usize) -> f64| self.moved(edge, t, &start, g, by);
        if moved(&|i| most(i, start.get(i))) > 0.0 {
            let size = moved(&|i| most(i, 0.0).max(start.get(i).abs()));
            let off = moved(&|_| ROUNDINGS * absolute);
            self.memory.resolved = size > SURELY * off;
            self.held_down = (!self.memory.resolved).then_some(edge);
        }
    }

    /// Whether the error of the step decides that a guard falls at `root`: where the jump before
    /// gave it no cause to fall again, or at the edge's wall, on which it may have stayed.
    #[inline]
    pub(super) fn hovers(
        &mut self,
        edge: A::Edge,
        (step, range): (Step<'_, A::State>, Range),
        root: f64,
    ) -> Option<Evidence> {
        let may = self.memory.kept.is_some() || !self.memory.walls.is_empty();
        if may { self.hovering(edge, (step, range), root) } else { None }
    }

    #[cold]
    #[inline(never)]
    fn hovering(&mut self, edge: A::Edge, (step, range): (Step<'_, A::State>, Range), root: f64) -> Option<Evidence> {
        let goes_on = match self.memory.kept {
            Some(Kept::Slope) => true,
            Some(Kept::State) => self.memory.last == Some(edge),
            None => false,
        };
        if !goes_on && self.memory.wall(edge).is_none() {
            return None;
        }
        let [middle, after] = [0.5 * root, root + ROUGHLY * range.limit];
        let mut within = |s: f64| {
            let g = self.on(edge, step, s);
            let rounding = ROUNDINGS * self.still(edge, step.time(s), &step.at(s), g);
            g.abs() <= rounding + self.error_of(edge, (step, range), s, g)
        };
        // From the jump on, or for a good part of a step.
        let close = within(0.0) && within(middle) && (range.first && goes_on || within(after));
        close.then_some(Evidence::doubtful(Doubt::Grazing, 0.0, root))
    }

    /// Whether the guard of an edge that stays where its own jump has left it, and falls at `root`,
    /// has sunk beyond rounding up to there: it may have gone on falling from that jump.
    pub(super) fn sank(&mut self, edge: A::Edge, step: Step<'_, A::State>, root: f64) -> Option<Evidence> {
        self.memory.spent_as(edge)?;
        let g = self.on(edge, step, root);
        let sunk = g < -self.still(edge, step.time(root), &step.at(root), g);
        sunk.then(|| Evidence::doubtful(Doubt::Grazing, 0.0, root))
    }

    /// The guard of `edge` a time `s` after the start of a step.
    #[inline(never)]
    pub(super) fn on(&mut self, edge: A::Edge, step: Step<'_, A::State>, s: f64) -> f64 {
        self.memory.stats.guards += 1;
        self.guard(edge, step.time(s), &step.at(s))
    }

    /// By how much a step, searched over a `range`, may be off in the guard of `edge`, which is `g`
    /// a time `s` after its start: Σ |∂g/∂xᵢ| so many times what the tolerance allows.
    ///
    /// The error estimate is that of a step's end, to the order below the method's own; within the
    /// step and after a few of them more has gathered (tests/grazing.rs, `the_error_of_a_step`).
    fn error_of(&mut self, edge: A::Edge, (step, range): (Step<'_, A::State>, Range), s: f64, g: f64) -> f64 {
        let (tolerance, start, end) = (self.options.tolerance, &step.c[0], step.at(range.limit));
        let allowed = |i| tolerance.allowed(start.get(i), end.get(i));
        ROUNDINGS * self.moved(edge, step.time(s), &step.at(s), g, &allowed)
    }

    /// Where a guard times its `side` of zero, 1 or -1, which turns up between two times, is
    /// least, and its value there.
    fn least(&mut self, edge: A::Edge, step: Step<'_, A::State>, [mut a, mut b]: [f64; 2], side: f64) -> (f64, f64) {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let inner = |a: f64, b: f64| [b - golden * (b - a), a + golden * (b - a)];
        let mut on = |s: f64| side * self.on(edge, step, s);
        let mut at = inner(a, b);
        let mut values = [on(at[0]), on(at[1])];
        for _ in 0..SECTIONS {
            if values[0] <= values[1] {
                b = at[1];
                at = [inner(a, b)[0], at[0]];
                values = [on(at[0]), values[0]];
            } else {
                a = at[0];
                at = [at[1], inner(a, b)[1]];
                values = [values[1], on(at[1])];
            }
        }
        (a.midpoint(b), values[0].min(values[1]))
    }
}

/// Whether two states, or two slopes, agree in each coordinate.
#[inline]
pub(super) fn is_alike<S: State>(x: &S, y: &S) -> bool {
    let agree = |a: f64, b: f64| (a - b).abs() <= ROUGHLY * a.abs().max(b.abs());
    x.len() == y.len() && (0..x.len()).all(|i| agree(x.get(i), y.get(i)))
}
