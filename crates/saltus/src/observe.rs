//! Who is given pieces and jumps as they come: nobody, a recorder, or the user.

use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::inspection::InspectionOf;
use crate::jump::JumpOf;
use crate::piece::Piece;

/// Is given each piece and each jump of a run, in order; may end the run.
///
/// The order of a step is: one [`inspection`](Self::inspection) per edge, the
/// [`piece`](Self::piece) up to the first crossing or the end of the step (none if it has no
/// duration), the [`jump`](Self::jump) if there is one. The methods do nothing unless written. `()`
/// observes nothing, for free; a pair of observers are two; `&mut` an observer is one;
/// [`Trajectory`](crate::Trajectory) and [`Certificate`](crate::Certificate) are observers.
///
/// ```
/// use std::ops::ControlFlow;
/// use saltus::{Automaton, JumpOf, Observer};
///
/// /// Ends the run at the third jump.
/// struct Third(u32);
/// impl<A: Automaton> Observer<A> for Third {
///     fn jump(&mut self, _: &JumpOf<A>) -> ControlFlow<()> {
///         self.0 += 1;
///         if self.0 == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
///     }
/// }
///
/// let clock = saltus::Hybrid::new()
///     .mode("tick", |_t, _x: &f64| -1.0)
///     .edge("tick", "tick", |_t, x| *x, |_t, _x| 1.0);
/// let end = saltus::Simulation::of(&clock).drive("tick", 1.0, 0.0..10.0, &mut Third(0))?;
/// assert_eq!((end.stop, end.jumps), (saltus::Stop::Observer, 3));
/// assert!((end.time.seconds() - 3.0).abs() < 1e-12);
/// # Ok::<(), saltus::Error>(())
/// ```
pub trait Observer<A: Automaton> {
    /// A stretch of the arc in `mode` is done. `Break` ends the run with
    /// [`Stop::Observer`](crate::Stop::Observer).
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let _ = (mode, piece);
        ControlFlow::Continue(())
    }

    /// Whether pieces are wanted. If not, some may be left out: those of a mode without edges
    /// are then not even computed.
    fn wants_pieces(&self) -> bool {
        true
    }

    /// A jump was made. `Break` ends the run just after it.
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        let _ = jump;
        ControlFlow::Continue(())
    }

    /// The guard of an edge was searched for a crossing, over the whole step: also beyond a
    /// crossing of another edge that ends it.
    fn inspection(&mut self, inspection: &InspectionOf<A>) {
        let _ = inspection;
    }
}

impl<A: Automaton> Observer<A> for () {
    #[inline]
    fn wants_pieces(&self) -> bool {
        false
    }
}

impl<A: Automaton, O: Observer<A> + ?Sized> Observer<A> for &mut O {
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        (**self).piece(mode, piece)
    }
    fn wants_pieces(&self) -> bool {
        (**self).wants_pieces()
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        (**self).jump(jump)
    }
    fn inspection(&mut self, inspection: &InspectionOf<A>) {
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
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        let (first, second) = (self.0.jump(jump), self.1.jump(jump));
        if first.is_break() { first } else { second }
    }
    fn inspection(&mut self, inspection: &InspectionOf<A>) {
        self.0.inspection(inspection);
        self.1.inspection(inspection);
    }
}
