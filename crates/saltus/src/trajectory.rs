//! What a run leaves behind: arcs on hybrid time (t, j), the jumps between them, and both limits at
//! each jump.

use std::fmt;
use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::inspection::{Doubts, Inspection, InspectionOf};
use crate::jump::{Jump, JumpOf};
use crate::observe::Observer;
use crate::piece::Piece;
use crate::state::State;
use crate::time::Time;

/// An arc: the stay in one mode between two jumps. Between two jumps at one time it has no
/// duration.
///
/// ```
/// use saltus::{Hybrid, Simulation};
/// let lamp = Hybrid::new()
///     .mode("dark", |_t, _x: &f64| 1.0)
///     .mode("lit", |_t, _x| 0.0)
///     .edge("dark", "lit", |_t, x| 1.0 - x, |_t, x| *x);
/// let run = Simulation::of(&lamp).run("dark", 0.0, 0.0..3.0)?;
/// let arcs = run.trajectory.arcs();
/// assert_eq!((arcs[0].mode(), arcs[1].mode()), ("dark", "lit"));
/// assert!((arcs[1].start().seconds() - 1.0).abs() < 1e-12 && (arcs[1].state() - 1.0).abs() < 1e-12);
/// assert_eq!(arcs[1].j(), 1);
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone, Copy)]
pub struct Arc<M, S> {
    mode: M,
    start: Time,
    state: S,
    j: usize,
    first_piece: usize,
}

impl<M: fmt::Debug, S: State> fmt::Debug for Arc<M, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, start, state, j, .. } = self;
        write!(f, "{mode:?} from (t = {}, j = {j}) at {state:?}", start.seconds())
    }
}

impl<M: Copy, S> Arc<M, S> {
    /// The mode.
    #[must_use]
    pub const fn mode(&self) -> M {
        self.mode
    }

    /// When the arc starts.
    #[must_use]
    pub const fn start(&self) -> Time {
        self.start
    }

    /// The state it starts from.
    #[must_use]
    pub const fn state(&self) -> &S {
        &self.state
    }

    /// How many jumps came before it.
    #[must_use]
    pub const fn j(&self) -> usize {
        self.j
    }
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Stored {
    start: Time,
    span: f64,
    scale: f64,
    first: usize,
    len: usize,
}

/// A hybrid arc: the state as a function of hybrid time (t, j).
///
/// At a jump the state has two limits: [`before`](Self::before) and [`at`](Self::at). Several jumps
/// may share one time. Any time within it can be asked for; that changes nothing about the jumps.
///
/// ```
/// use saltus::{Hybrid, Simulation};
/// // A tank that fills by 1 L/s and is emptied at 2 L.
/// let tank = Hybrid::new()
///     .mode("fill", |_t, _x: &f64| 1.0)
///     .edge("fill", "fill", |_t, x| 2.0 - x, |_t, _x| 0.0);
/// let hybrid_arc = Simulation::of(&tank).run("fill", 0.0, 0.0..5.0)?.trajectory;
/// let emptied = hybrid_arc.jumps()[0];
/// assert_eq!(hybrid_arc.before(emptied.t()), Some(emptied.before));
/// assert_eq!(hybrid_arc.at(emptied.t()), Some(0.0));
/// assert!((hybrid_arc.at(4.5).unwrap() - 0.5).abs() < 1e-12);
/// assert_eq!((hybrid_arc.at(5.1), hybrid_arc.mode_at(4.5)), (None, Some("fill")));
/// assert_eq!(hybrid_arc.arcs().len(), hybrid_arc.jumps().len() + 1);
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone)]
pub struct Trajectory<M, E, S> {
    arcs: Vec<Arc<M, S>>,
    jumps: Vec<Jump<M, E, S>>,
    pieces: Vec<Stored>,
    coefficients: Vec<S>,
    doubts: Doubts<M, E>,
    end: Time,
}

impl<M: fmt::Debug, E: fmt::Debug, S: State> fmt::Debug for Trajectory<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { arcs, jumps, doubts, .. } = self;
        f.debug_struct("Trajectory")
            .field("arcs", arcs)
            .field("jumps", jumps)
            .field("doubts", doubts)
            .finish_non_exhaustive()
    }
}

/// A trajectory of the automaton `A`.
pub type TrajectoryOf<A> = Trajectory<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

impl<M: Copy + PartialEq, E: Copy + PartialEq, S: State> Trajectory<M, E, S> {
    /// Empty, from `state` in `mode` at `start`: for
    /// [`Simulation::drive`](crate::Simulation::drive), where others observe beside it.
    ///
    /// ```
    /// use saltus::{Certificate, Hybrid, Simulation, Time, Trajectory};
    /// let clock = Hybrid::new().mode("tick", |_t, _x: &f64| -1.0).edge("tick", "tick", |_t, x| *x, |_t, _x| 1.0);
    /// let (mut trajectory, mut certificate) = (Trajectory::starting("tick", 1.0, Time::new(0.0)), Certificate::new());
    /// let end = Simulation::of(&clock).drive("tick", 1.0, 0.0..2.5, &mut (&mut trajectory, &mut certificate))?;
    /// trajectory.finish(end.time);
    /// assert_eq!((trajectory.jumps().len(), trajectory.at(2.5)), (2, Some(0.5)));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn starting(mode: M, state: S, start: Time) -> Self {
        let arc = Arc { mode, start, state, j: 0, first_piece: 0 };
        Self {
            arcs: vec![arc],
            jumps: Vec::new(),
            pieces: Vec::new(),
            coefficients: Vec::new(),
            doubts: Doubts::new(),
            end: start,
        }
    }

    /// Records a piece; says how many bytes it takes.
    #[inline]
    pub(crate) fn push_piece(&mut self, piece: &Piece<'_, S>) -> usize {
        let first = self.coefficients.len();
        let (start, span, scale) = (piece.start(), piece.span(), piece.scale());
        self.coefficients.extend_from_slice(piece.coefficients());
        let len = piece.coefficients().len();
        self.pieces.push(Stored { start, span, scale, first, len });
        self.end = start.after(span);
        self.doubts.settle(self.end, |_| ());
        size_of::<Stored>() + size_of_val(piece.coefficients()) + heap(piece.coefficients())
    }

    /// Records a jump and the arc that begins there; says how many bytes they take.
    #[inline]
    pub(crate) fn push_jump(&mut self, jump: Jump<M, E, S>) -> usize {
        self.end = jump.time;
        let (mode, state, start, j) = (jump.to, jump.after.clone(), jump.time, jump.j);
        self.arcs.push(Arc { mode, start, state, j, first_piece: self.pieces.len() });
        self.doubts.end_arc(start, jump.edge(), |_, _| ());
        let elsewhere = heap([&jump.before, &jump.after, &jump.after]); // the last is the arc's
        self.jumps.push(jump);
        size_of::<Arc<M, S>>() + size_of::<Jump<M, E, S>>() + elsewhere
    }

    pub(crate) fn push_doubt(&mut self, doubt: &Inspection<M, E>) {
        self.doubts.add(doubt);
    }

    /// The run ended at this moment, which the end of its last piece may miss by a rounding.
    pub fn finish(&mut self, end: Time) {
        self.end = end;
        self.doubts.end_arc(end, None, |_, _| ());
    }

    /// How much memory what is recorded takes.
    #[inline]
    pub(crate) fn bytes(&self) -> usize {
        let of_jumps = heap(self.jumps.iter().flat_map(|jump| [&jump.before, &jump.after]));
        let elsewhere = heap(self.arcs.iter().map(Arc::state)) + of_jumps + heap(&self.coefficients);
        self.arcs.len() * (size_of::<Arc<M, S>>() + size_of::<Jump<M, E, S>>())
            + self.pieces.len() * size_of::<Stored>()
            + self.coefficients.len() * size_of::<S>()
            + size_of_val(self.doubts.list())
            + elsewhere
    }

    /// The run got no further than this.
    pub(crate) fn settle(&mut self, end: Time) {
        self.doubts.end_arc(end, None, |_, _| ());
    }
}

impl<M: Copy, E, S: State> Trajectory<M, E, S> {
    /// The jumps in order.
    #[must_use]
    pub fn jumps(&self) -> &[Jump<M, E, S>] {
        &self.jumps
    }

    /// The arcs in order, one more than the jumps.
    #[must_use]
    pub fn arcs(&self) -> &[Arc<M, S>] {
        &self.arcs
    }

    /// The pieces of arc `index` (as in [`arcs`](Self::arcs)) in order; none if the arc has no
    /// duration or there is no such arc.
    pub fn pieces(&self, index: usize) -> impl Iterator<Item = Piece<'_, S>> {
        self.pieces[self.piece_range(index)].iter().map(|p| self.piece(p))
    }

    /// Where a crossing may have been missed: the searches of guards that left a doubt, in order;
    /// empty where none was.
    ///
    /// Each says for people which edge, when, why and what to do; see [`Inspection`].
    /// [`Certificate`](crate::Certificate) has all searches.
    #[must_use]
    pub fn doubts(&self) -> &[Inspection<M, E>] {
        self.doubts.list()
    }

    /// When the trajectory starts.
    #[must_use]
    pub fn start(&self) -> Time {
        self.arcs.first().map_or(self.end, |arc| arc.start)
    }

    /// When it ends.
    #[must_use]
    pub const fn end(&self) -> Time {
        self.end
    }

    /// The state x⁺(t), after any jumps at `t`; `None` outside the trajectory.
    #[must_use]
    pub fn at(&self, t: f64) -> Option<S> {
        let index = self.arc_at(t)?;
        Some(self.state_in(index, t))
    }

    /// The state x⁻(t), before any jumps at `t`; the same as [`at`](Self::at) where there is none.
    #[must_use]
    pub fn before(&self, t: f64) -> Option<S> {
        let first = self.jumps.partition_point(|jump| jump.t() < t);
        match self.jumps.get(first) {
            Some(jump) if jump.t() == t => Some(jump.before.clone()),
            _ => self.at(t),
        }
    }

    /// The mode at `t`, after any jumps.
    #[must_use]
    pub fn mode_at(&self, t: f64) -> Option<M> {
        self.arc_at(t).map(|index| self.arcs[index].mode)
    }

    fn arc_at(&self, t: f64) -> Option<usize> {
        if t < self.start().seconds() || t > self.end.seconds() || t.is_nan() {
            return None;
        }
        self.arcs.partition_point(|arc| arc.start.seconds() <= t).checked_sub(1)
    }

    fn state_in(&self, index: usize, t: f64) -> S {
        // At its own time an arc starts from x⁺, though the double may lie a rounding after the
        // moment.
        if t == self.arcs[index].start.seconds() {
            return self.arcs[index].state.clone();
        }
        let pieces = &self.pieces[self.piece_range(index)];
        let next = pieces.partition_point(|piece| piece.start.seconds() <= t);
        match next.checked_sub(1).and_then(|i| pieces.get(i)) {
            None => self.arcs[index].state.clone(),
            Some(stored) => {
                let s = Time::new(t).since(stored.start).clamp(0.0, stored.span);
                self.piece(stored).at(s)
            }
        }
    }

    fn piece_range(&self, index: usize) -> std::ops::Range<usize> {
        let end = self.arcs.get(index + 1).map_or(self.pieces.len(), |next| next.first_piece);
        let start = self.arcs.get(index).map_or(end, |arc| arc.first_piece);
        start..end
    }

    fn piece(&self, stored: &Stored) -> Piece<'_, S> {
        let coefficients = &self.coefficients[stored.first..stored.first + stored.len];
        Piece::new(stored.start, stored.span, stored.scale, coefficients)
    }
}

/// How many bytes states hold on the heap.
#[inline]
fn heap<'s, S: State + 's>(states: impl IntoIterator<Item = &'s S>) -> usize {
    states.into_iter().map(State::heap).sum()
}

impl<A: Automaton> Observer<A> for TrajectoryOf<A> {
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        self.push_piece(piece);
        ControlFlow::Continue(())
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.push_jump(jump.clone());
        ControlFlow::Continue(())
    }
    fn inspection(&mut self, inspection: &InspectionOf<A>) {
        if inspection.evidence.doubt().is_some() {
            self.push_doubt(inspection);
        }
    }
}
