//! What a run leaves behind: arcs on hybrid time (t, j), the jumps between them, and both limits at each jump.

use std::fmt;
use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::copies::{copied, shown};
use crate::inspection::{Doubts, Inspection};
use crate::jump::Jump;
use crate::observe::Observer;
use crate::piece::Piece;
use crate::time::Time;

/// An arc: the stay in one mode between two jumps. Between two jumps at one time it has no duration.
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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "A::Mode: serde::Serialize, A::State: serde::Serialize",
        deserialize = "A::Mode: serde::Deserialize<'de>, A::State: serde::Deserialize<'de>"
    ))
)]
pub struct Arc<A: Automaton> {
    mode: A::Mode,
    start: Time,
    state: A::State,
    j: usize,
    first_piece: usize,
}

copied!(Arc);

impl<A: Automaton> fmt::Debug for Arc<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, start, state, j, .. } = self;
        write!(f, "{mode:?} from (t = {}, j = {j}) at {state:?}", start.seconds())
    }
}

impl<A: Automaton> Arc<A> {
    /// The mode.
    #[must_use]
    pub fn mode(&self) -> A::Mode {
        self.mode
    }

    /// When the arc starts.
    #[must_use]
    pub const fn start(&self) -> Time {
        self.start
    }

    /// The state it starts from.
    #[must_use]
    pub const fn state(&self) -> &A::State {
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
/// At a jump the state has two limits: [`before`](Self::before) and [`at`](Self::at). Several jumps may share one time.
/// Any time within it can be asked for; that changes nothing about the jumps.
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
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "A::Mode: serde::Serialize, A::State: serde::Serialize, A::Edge: serde::Serialize",
        deserialize = "A::Mode: serde::Deserialize<'de>, A::State: serde::Deserialize<'de>, A::Edge: serde::Deserialize<'de>"
    ))
)]
pub struct Trajectory<A: Automaton> {
    arcs: Vec<Arc<A>>,
    jumps: Vec<Jump<A>>,
    pieces: Vec<Stored>,
    coefficients: Vec<A::State>,
    doubts: Doubts<A>,
    end: Time,
}

impl<A: Automaton> Clone for Trajectory<A> {
    fn clone(&self) -> Self {
        let Self { arcs, jumps, pieces, coefficients, doubts, end } = self;
        Self {
            arcs: arcs.clone(),
            jumps: jumps.clone(),
            pieces: pieces.clone(),
            coefficients: coefficients.clone(),
            doubts: doubts.clone(),
            end: *end,
        }
    }
}

shown!(Trajectory { arcs, jumps, doubts, .. });

impl<A: Automaton> Trajectory<A> {
    /// Empty, from `state` in `mode` at `start`: for [`Simulation::drive`](crate::Simulation::drive), where others observe beside it.
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
    pub fn starting(mode: A::Mode, state: A::State, start: Time) -> Self {
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

    pub(crate) fn push_piece(&mut self, piece: &Piece<'_, A::State>) {
        let first = self.coefficients.len();
        let (start, span, scale) = (piece.start(), piece.span(), piece.scale());
        self.coefficients.extend_from_slice(piece.coefficients());
        let len = piece.coefficients().len();
        self.pieces.push(Stored { start, span, scale, first, len });
        self.end = start.after(span);
        self.doubts.settle(self.end);
    }

    pub(crate) fn push_jump(&mut self, jump: Jump<A>) {
        self.end = jump.time;
        let (mode, state, start, j) = (jump.to, jump.after, jump.time, jump.j);
        self.arcs.push(Arc { mode, start, state, j, first_piece: self.pieces.len() });
        self.jumps.push(jump);
        self.doubts.settle(jump.time);
    }

    pub(crate) fn push_doubt(&mut self, doubt: &Inspection<A>) {
        self.doubts.add(doubt);
    }

    /// The run ended at this moment, which the end of its last piece may miss by a rounding.
    pub fn finish(&mut self, end: Time) {
        self.end = end;
        self.doubts.settle(end);
    }

    /// How much memory what is recorded takes.
    #[inline]
    pub(crate) fn bytes(&self) -> usize {
        self.arcs.len() * (size_of::<Arc<A>>() + size_of::<Jump<A>>())
            + self.pieces.len() * size_of::<Stored>()
            + self.coefficients.len() * size_of::<A::State>()
            + size_of_val(self.doubts.list())
    }

    /// The run got no further than this.
    pub(crate) fn settle(&mut self, end: Time) {
        self.doubts.settle(end);
    }

    /// The jumps in order.
    #[must_use]
    pub fn jumps(&self) -> &[Jump<A>] {
        &self.jumps
    }

    /// The arcs in order, one more than the jumps.
    #[must_use]
    pub fn arcs(&self) -> &[Arc<A>] {
        &self.arcs
    }

    /// The pieces of arc `index` (as in [`arcs`](Self::arcs)) in order; none if the arc has no duration or there is no such arc.
    pub fn pieces(&self, index: usize) -> impl Iterator<Item = Piece<'_, A::State>> {
        self.pieces[self.piece_range(index)].iter().map(|p| self.piece(p))
    }

    /// Where a crossing may have been missed: the searches of guards that left a doubt, in order; empty where none was.
    ///
    /// Each says for people which edge, when, why and what to do; see [`Inspection`]. [`Certificate`](crate::Certificate) has all searches.
    #[must_use]
    pub fn doubts(&self) -> &[Inspection<A>] {
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
    pub fn at(&self, t: f64) -> Option<A::State> {
        let index = self.arc_at(t)?;
        Some(self.state_in(index, t))
    }

    /// The state x⁻(t), before any jumps at `t`; the same as [`at`](Self::at) where there is none.
    #[must_use]
    pub fn before(&self, t: f64) -> Option<A::State> {
        let first = self.jumps.partition_point(|jump| jump.t() < t);
        match self.jumps.get(first) {
            Some(jump) if jump.t() == t => Some(jump.before),
            _ => self.at(t),
        }
    }

    /// The mode at `t`, after any jumps.
    #[must_use]
    pub fn mode_at(&self, t: f64) -> Option<A::Mode> {
        self.arc_at(t).map(|index| self.arcs[index].mode)
    }

    fn arc_at(&self, t: f64) -> Option<usize> {
        if t < self.start().seconds() || t > self.end.seconds() || t.is_nan() {
            return None;
        }
        self.arcs.partition_point(|arc| arc.start.seconds() <= t).checked_sub(1)
    }

    fn state_in(&self, index: usize, t: f64) -> A::State {
        // At its own time an arc starts from x⁺, though the double may lie a rounding after the moment.
        if t == self.arcs[index].start.seconds() {
            return self.arcs[index].state;
        }
        let pieces = &self.pieces[self.piece_range(index)];
        let next = pieces.partition_point(|piece| piece.start.seconds() <= t);
        match next.checked_sub(1).and_then(|i| pieces.get(i)) {
            None => self.arcs[index].state,
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

    fn piece(&self, stored: &Stored) -> Piece<'_, A::State> {
        let coefficients = &self.coefficients[stored.first..stored.first + stored.len];
        Piece::new(stored.start, stored.span, stored.scale, coefficients)
    }
}

impl<A: Automaton> Observer<A> for Trajectory<A> {
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        self.push_piece(piece);
        ControlFlow::Continue(())
    }
    fn jump(&mut self, jump: &Jump<A>) -> ControlFlow<()> {
        self.push_jump(*jump);
        ControlFlow::Continue(())
    }
    fn inspection(&mut self, inspection: &Inspection<A>) {
        if inspection.evidence.is_doubtful() {
            self.push_doubt(inspection);
        }
    }
}
