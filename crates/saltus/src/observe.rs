//! Who is told of pieces and jumps as they come: nobody, a recorder, or the user.

use std::fmt;
use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::cross::Evidence;
use crate::time::Time;
use crate::trajectory::{Jump, Piece, Trajectory};

/// How the guard of one edge was searched over one step, or over one exact arc.
pub struct Inspection<A: Automaton> {
    /// The mode.
    pub mode: A::Mode,
    /// The edge.
    pub edge: A::Edge,
    /// Where the step starts.
    pub start: Time,
    /// How far the search went, in seconds; infinite on an exact arc of a run without an end.
    pub span: f64,
    /// What is known: no crossing, one that was isolated, or where rounding or haste hides one. Times count from `start`.
    pub evidence: Evidence,
}

impl<A: Automaton> fmt::Debug for Inspection<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, edge, start, span, evidence } = self;
        write!(f, "{mode:?} edge {edge:?} from t = {} for {span} s: {evidence:?}", start.seconds())
    }
}

/// Is told of each piece and each jump of a run, in order; may end the run.
///
/// Both methods do nothing unless written. `()` observes nothing, for free; a pair of observers are two.
///
/// ```
/// use std::ops::ControlFlow;
/// use saltus::{Automaton, Jump, Observer};
///
/// /// Ends the run at the third jump.
/// struct Third(u32);
/// impl<A: Automaton> Observer<A> for Third {
///     fn jump(&mut self, _: &Jump<A>) -> ControlFlow<()> {
///         self.0 += 1;
///         if self.0 == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
///     }
/// }
/// ```
pub trait Observer<A: Automaton> {
    /// A stretch of the arc in `mode` is done.
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let _ = (mode, piece);
        ControlFlow::Continue(())
    }

    /// Whether pieces are wanted. If not, some may not be told of: those of a mode without edges are then not even computed.
    fn wants_pieces(&self) -> bool {
        true
    }

    /// A jump was made.
    fn jump(&mut self, jump: &Jump<A>) -> ControlFlow<()> {
        let _ = jump;
        ControlFlow::Continue(())
    }

    /// The guard of an edge was searched for a crossing.
    fn inspection(&mut self, inspection: &Inspection<A>) {
        let _ = inspection;
    }
}

impl<A: Automaton> Observer<A> for () {
    #[inline]
    fn wants_pieces(&self) -> bool {
        false
    }
}

impl<A: Automaton, O: Observer<A>> Observer<A> for &mut O {
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        (**self).piece(mode, piece)
    }
    fn wants_pieces(&self) -> bool {
        (**self).wants_pieces()
    }
    fn jump(&mut self, jump: &Jump<A>) -> ControlFlow<()> {
        (**self).jump(jump)
    }
    fn inspection(&mut self, inspection: &Inspection<A>) {
        (**self).inspection(inspection);
    }
}

impl<A: Automaton, O: Observer<A>, P: Observer<A>> Observer<A> for (O, P) {
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let (first, second) = (self.0.piece(mode, piece), self.1.piece(mode, piece));
        if first.is_break() { first } else { second }
    }
    fn wants_pieces(&self) -> bool {
        self.0.wants_pieces() || self.1.wants_pieces()
    }
    fn jump(&mut self, jump: &Jump<A>) -> ControlFlow<()> {
        let (first, second) = (self.0.jump(jump), self.1.jump(jump));
        if first.is_break() { first } else { second }
    }
    fn inspection(&mut self, inspection: &Inspection<A>) {
        self.0.inspection(inspection);
        self.1.inspection(inspection);
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
}
