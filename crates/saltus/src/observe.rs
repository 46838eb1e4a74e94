//! Who is told of pieces and jumps as they come: nobody, a recorder, or the user.

use std::fmt;
use std::ops::{ControlFlow, Range};

use crate::automaton::Automaton;
use crate::copies::copied;
use crate::cross::Evidence;
use crate::time::Time;
use crate::trajectory::{Jump, Piece, Trajectory};

/// How the guard of one edge was searched over one step, or over one exact arc.
///
/// ```
/// use saltus::cross::Evidence;
/// use saltus::{Hybrid, Simulation};
///
/// // A guard that swings more than a million times a second is too fast to be followed through a step.
/// let fast = Hybrid::new()
///     .mode("wait", |_t, _x: &f64| 1.0)
///     .terminal("wait", |t, _x| 1.5 + (1e7 * t).sin());
/// let run = Simulation::of(&fast).run("wait", 0.0, 0.0..1.0)?;
///
/// let doubt = run.trajectory.doubts().last().unwrap();
/// assert!(matches!(doubt.evidence, Evidence::Unresolved { .. }));
/// assert_eq!(doubt.doubt().map(|when| when.end), Some(1.0));
/// assert!(doubt.to_string().contains("varies too fast"));
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(
        serialize = "A::Mode: serde::Serialize, A::Edge: serde::Serialize",
        deserialize = "A::Mode: serde::Deserialize<'de>, A::Edge: serde::Deserialize<'de>"
    ))
)]
#[non_exhaustive]
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

copied!(Inspection);

impl<A: Automaton> Inspection<A> {
    /// Between which times, in seconds, a crossing may have been missed; `None` where the search leaves no doubt.
    #[must_use]
    pub fn doubt(&self) -> Option<Range<f64>> {
        let (from, to) = when(self.evidence)?;
        Some(self.start.after(from).seconds()..self.start.after(to).seconds())
    }

    /// The same doubt up to `end`; `None` if it lies after that.
    pub(crate) fn until(self, end: Time) -> Option<Self> {
        let span = self.span.min(end.since(self.start));
        let (from, to) = when(self.evidence)?;
        (from < span).then(|| Self { span, evidence: between(self.evidence, from, to.min(span)), ..self })
    }

    /// Takes in a later doubt of the same kind that follows without a gap; says whether it did.
    pub(crate) fn extended_by(&mut self, later: &Self) -> bool {
        let (Some((from, to)), Some((next, end))) = (when(self.evidence), when(later.evidence)) else {
            return false;
        };
        let after = later.start.since(self.start);
        let same = std::mem::discriminant(&self.evidence) == std::mem::discriminant(&later.evidence);
        let follows = same && after + next <= to + 4.0 * f64::EPSILON * to.abs();
        if follows {
            self.span = after + later.span;
            self.evidence = between(self.evidence, from, to.max(after + end));
        }
        follows
    }

    /// The same with time running the other way.
    pub(crate) fn turned(&self, negative: impl Fn(Time) -> Time) -> Self {
        let &Self { start, span, evidence, .. } = self;
        let evidence = when(evidence).map_or(evidence, |(from, to)| between(evidence, span - to, span - from));
        Self { start: negative(start.after(span)), evidence, ..*self }
    }
}

/// From when to when a doubt lasts.
const fn when(evidence: Evidence) -> Option<(f64, f64)> {
    match evidence {
        Evidence::Grazing { from, to }
        | Evidence::Rounding { from, to }
        | Evidence::Unresolved { from, to }
        | Evidence::Discontinuous { from, to } => Some((from, to)),
        Evidence::Excluded | Evidence::Isolated => None,
    }
}

/// The same doubt, from another time to another.
const fn between(evidence: Evidence, from: f64, to: f64) -> Evidence {
    match evidence {
        Evidence::Grazing { .. } => Evidence::Grazing { from, to },
        Evidence::Rounding { .. } => Evidence::Rounding { from, to },
        Evidence::Unresolved { .. } => Evidence::Unresolved { from, to },
        Evidence::Discontinuous { .. } => Evidence::Discontinuous { from, to },
        known => known,
    }
}

impl<A: Automaton> fmt::Debug for Inspection<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, edge, start, span, evidence } = self;
        write!(f, "{mode:?} edge {edge:?} from t = {} for {span} s: {evidence:?}", start.seconds())
    }
}

impl<A: Automaton> fmt::Display for Inspection<A> {
    /// What is known, where, and, of a doubt, what to do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mode, edge, start, span, evidence } = self;
        let Range { start: from, end: to } =
            self.doubt().unwrap_or_else(|| start.seconds()..start.after(*span).seconds());
        write!(f, "edge {edge:?} in mode {mode:?}, t = {from} to {to}: ")?;
        f.write_str(match evidence {
            Evidence::Excluded => "not crossed; bounds on its guard leave no room",
            Evidence::Isolated => "searched until no part had room for more than one crossing",
            Evidence::Grazing { .. } => {
                "its guard comes as close to zero as the error of the step, and turns: whether it is crossed there \
                 is not decided. If that matters, lower Simulation::tolerance"
            }
            Evidence::Rounding { .. } => {
                "its guard is zero but for rounding and was taken for a touch; two crossings may hide there. \
                 If that matters, write the guard so that it does not cancel"
            }
            Evidence::Unresolved { .. } => {
                "its guard varies too fast to be followed, and a crossing may have been missed. \
                 Shorten Simulation::longest_step, or give the guard a slower form"
            }
            Evidence::Discontinuous { .. } => {
                "its guard changes sign without coming near zero: a pole is no crossing, a leap is taken for one. \
                 Write the guard so that it is continuous"
            }
        })
    }
}

/// Is told of each piece and each jump of a run, in order; may end the run.
///
/// The order of a step is: one [`inspection`](Self::inspection) per edge, the [`piece`](Self::piece) up to the first crossing or the end of
/// the step (none if it has no duration), the [`jump`](Self::jump) if there is one.
/// The methods do nothing unless written. `()` observes nothing, for free; a pair of observers are two; `&mut` an observer is one;
/// [`Trajectory`] and [`Certificate`](crate::Certificate) are observers.
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
    /// A stretch of the arc in `mode` is done. `Break` ends the run with [`Stop::Observer`](crate::Stop::Observer).
    fn piece(&mut self, mode: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let _ = (mode, piece);
        ControlFlow::Continue(())
    }

    /// Whether pieces are wanted. If not, some may not be told of: those of a mode without edges are then not even computed.
    fn wants_pieces(&self) -> bool {
        true
    }

    /// A jump was made. `Break` ends the run just after it.
    fn jump(&mut self, jump: &Jump<A>) -> ControlFlow<()> {
        let _ = jump;
        ControlFlow::Continue(())
    }

    /// The guard of an edge was searched for a crossing, over the whole step: also beyond a crossing of another edge that ends it.
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

impl<A: Automaton, O: Observer<A> + ?Sized> Observer<A> for &mut O {
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
    fn inspection(&mut self, inspection: &Inspection<A>) {
        if inspection.evidence.is_doubtful() {
            self.push_doubt(inspection);
        }
    }
}
