//! Backwards in time, also through jumps, for automata whose resets have an inverse.

use std::borrow::Cow;
use std::ops::Range;

use crate::automaton::clocks::Clock;
use crate::automaton::edges::Edges;
use crate::automaton::solution::Solution;
use crate::automaton::{About, Automaton, Entry};
use crate::error::Refusal;
use crate::inspection::Inspection;
use crate::jump::Jump;
use crate::piece::Piece;
use crate::state::State;
use crate::time::Time;
use crate::trajectory::{Arc, Trajectory, TrajectoryOf};

/// An automaton whose jumps can be undone.
///
/// Forwards, an edge is taken where its guard falls to zero and its reset maps x⁻ to x⁺. Backwards,
/// the same edge is *undone* in the mode it leads to, where the state meets the image of the reset:
/// the states x⁺ that the reset can give. The model says
///
/// - which edges lead [into](Self::edges_into) a mode,
/// - the [`image`](Self::image) margin of such an edge, positive within the mode's domain and zero
///   on the image of its reset,
/// - the inverse of the reset, [`undo`](Self::undo): x⁻ from x⁺.
///
/// Where two jumps lead to the same state the past is not unique; the image margins are then to
/// tell them apart, or the first edge listed is undone. A reset that forgets (a ball that lands and
/// stays, a speed set to zero) has no inverse, and no past to be found.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Automaton, Edges, Invertible, Refusal, Reversed, Simulation};
///
/// /// A ball that keeps 0.7 of its speed at each impact.
/// struct Ball;
///
/// impl Automaton for Ball {
///     type Mode = ();
///     type State = Vector2<f64>; // height in m, velocity in m/s
///     type Edge = ();
///     fn flow(&self, _: (), _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
///         vector![x[1], -9.81]
///     }
///     fn edges(&self, _: ()) -> Edges<'_, ()> {
///         Edges::from([()])
///     }
///     fn guard(&self, _: (), _t: f64, x: &Vector2<f64>) -> f64 {
///         x[0]
///     }
///     fn reset(&self, _: (), _: (), _t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
///         Ok(((), vector![0.0, -0.7 * x[1]]))
///     }
/// }
///
/// impl Invertible for Ball {
///     fn edges_into(&self, _: ()) -> Edges<'_, ()> {
///         Edges::from([()])
///     }
///     fn image(&self, _: (), _t: f64, x: &Vector2<f64>) -> f64 {
///         x[0] // an impact leaves the ball on the floor
///     }
///     fn undo(&self, _: (), _t: f64, x: &Vector2<f64>) -> ((), Vector2<f64>) {
///         ((), vector![0.0, -x[1] / 0.7])
///     }
/// }
///
/// let there = Simulation::of(&Ball).run((), vector![1.0, 0.0], 0.0..1.5)?;
/// let backwards = Reversed::of(&Ball);
/// let back = Simulation::of(&backwards).run((), there.end.state, Reversed::span(1.5, 0.0))?;
/// assert!((back.end.state - vector![1.0, 0.0]).norm() < 1e-9);
/// assert_eq!(back.trajectory.jumps().len(), 2);
/// # Ok::<(), saltus::Error>(())
/// ```
pub trait Invertible: Automaton {
    /// The edges that lead into `mode`, in the order in which they are undone where time cannot
    /// tell them apart.
    fn edges_into(&self, mode: Self::Mode) -> Edges<'_, Self::Edge>;

    /// The margin towards the image of the reset of `edge`: positive where the mode it leads to can
    /// have been for a while, zero where the jump must just have happened. Backwards in time, the
    /// jump is undone where it falls through zero.
    fn image(&self, edge: Self::Edge, t: f64, x: &Self::State) -> f64;

    /// The mode and state just before `edge` was taken, from the state `x` just after.
    fn undo(&self, edge: Self::Edge, t: f64, x: &Self::State) -> (Self::Mode, Self::State);

    /// What to do when the image margin of `edge` is already negative as its mode is entered
    /// backwards. The default refuses, with an error.
    fn undo_entry(&self, edge: Self::Edge) -> Entry {
        let _ = edge;
        Entry::Refuse
    }

    /// Whether a run backwards can be in `mode`, as [`Automaton::validate`]: not if an edge into it
    /// has no inverse, say. By default it can.
    ///
    /// # Errors
    /// A sentence that says what is wrong and what to do.
    fn validate_backwards(&self, mode: Self::Mode) -> Result<(), String> {
        let _ = mode;
        Ok(())
    }

    /// Promises that the image margin of `edge` is a·x + b with constants a and b; see
    /// [`About::affine`].
    fn image_affine(&self, edge: Self::Edge) -> bool {
        let _ = edge;
        false
    }
}

/// An [`Invertible`] automaton with time running backwards: itself an [`Automaton`], in the time
/// s = -t.
///
/// | forwards | reversed |
/// |---|---|
/// | t | s = -t, exactly |
/// | x' = f(t, x) | dx/ds = -f(-s, x) |
/// | edges out of a mode, guards | edges into it, [images](Invertible::image) |
/// | reset, x⁻ to x⁺ | [undo](Invertible::undo), x⁺ to x⁻ |
/// | terminal edges, what lies beyond a Zeno limit | none: a limit has no last jump to undo |
/// | [stops](Automaton::stops) at t | stops at s = -t; of a clock by a function they are an error |
/// | clocks ([`Automaton::clocks`]) | none, unless [`edges_into`](Invertible::edges_into) lists them with a margin in time |
///
/// Run it as it is, over [`Reversed::span`]; [`forwards`](Self::forwards) turns the trajectory
/// round again. Errors that the flow forwards damps grow backwards at the same rate: a ball of COR
/// e multiplies them by 1/e per bounce.
#[derive(Debug)]
pub struct Reversed<'a, A> {
    automaton: &'a A,
}

impl<A> Clone for Reversed<'_, A> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A> Copy for Reversed<'_, A> {}

impl Reversed<'_, ()> {
    /// The span of s = -t for a run from `from` back to `to`, in seconds.
    ///
    /// ```
    /// use saltus::Reversed;
    /// assert_eq!(Reversed::span(1.0, -1.0), -1.0..1.0);
    /// ```
    #[must_use]
    pub const fn span(from: f64, to: f64) -> Range<f64> {
        -from..-to
    }
}

impl<'a, A: Invertible> Reversed<'a, A> {
    /// `automaton`, backwards in time.
    #[must_use]
    pub const fn of(automaton: &'a A) -> Self {
        Self { automaton }
    }

    /// A trajectory of the reversed automaton as one of the automaton itself: in t, from past to
    /// future, each jump with its limits in that order.
    ///
    /// The same arcs to rounding: pieces are expanded about their other end.
    #[must_use]
    pub fn forwards(&self, backwards: &TrajectoryOf<Self>) -> TrajectoryOf<A> {
        let (arcs, jumps) = (backwards.arcs(), backwards.jumps());
        let last = &arcs[jumps.len()]; // there is one more arc than jumps
        let end =
            backwards.pieces(jumps.len()).last().map_or_else(|| last.state().clone(), |piece| piece.at(piece.span()));
        let mut trajectory = Trajectory::starting(last.mode(), end, negative(backwards.end()));
        for index in (0..arcs.len()).rev() {
            let pieces: Vec<_> = backwards.pieces(index).collect();
            let mut next = arcs.get(index + 1).map_or(backwards.end(), Arc::start);
            for piece in pieces.iter().rev() {
                trajectory.push_piece(&Piece::new(negative(next), piece.span(), piece.scale(), &turned(piece)));
                next = piece.start();
            }
            if let Some(jump) = index.checked_sub(1).map(|before| &jumps[before]) {
                let Jump { time, cause, from, before, to, after, .. } = jump.clone();
                let (time, j) = (negative(time), jumps.len() - index + 1);
                trajectory.push_jump(Jump { time, j, cause, from: to, before: after, to: from, after: before });
            }
        }
        for doubt in backwards.doubts().iter().rev() {
            let Inspection { mode, edge, start, span, evidence } = doubt.turned(negative);
            trajectory.push_doubt(&Inspection { mode, edge, start, span, evidence });
        }
        trajectory.finish(negative(backwards.start()));
        trajectory
    }
}

/// The moment -t.
fn negative(t: Time) -> Time {
    let hi = t.seconds();
    Time::new(-hi).after(-t.since(Time::new(hi)))
}

/// The coefficients about the end of a piece in time that runs back from there: of q(u) =
/// p(span/scale - u).
fn turned<S: State>(piece: &Piece<'_, S>) -> Vec<S> {
    let mut c = piece.coefficients().to_vec();
    let shift = piece.span() / piece.scale();
    // Taylor's shift by Horner's rule, then every odd power changes sign.
    for low in 0..c.len() {
        for k in (low..c.len().saturating_sub(1)).rev() {
            c[k] = c[k].with(|i| c[k].get(i) + shift * c[k + 1].get(i));
        }
    }
    for odd in c.iter_mut().skip(1).step_by(2) {
        *odd = odd.with(|i| -odd.get(i));
    }
    c
}

impl<A: Invertible> Automaton for Reversed<'_, A> {
    type Mode = A::Mode;
    type State = A::State;
    type Edge = A::Edge;

    fn flow(&self, mode: A::Mode, s: f64, x: &A::State) -> A::State {
        let flow = self.automaton.flow(mode, -s, x);
        flow.with(|i| -flow.get(i))
    }

    fn edges(&self, mode: A::Mode) -> Edges<'_, A::Edge> {
        self.automaton.edges_into(mode)
    }

    fn guard(&self, edge: A::Edge, s: f64, x: &A::State) -> f64 {
        self.automaton.image(edge, -s, x)
    }

    fn reset(&self, _: A::Mode, edge: A::Edge, s: f64, x: &A::State) -> Result<(A::Mode, A::State), Refusal> {
        Ok(self.automaton.undo(edge, -s, x))
    }

    fn stops(&self, mode: A::Mode) -> Cow<'_, [Clock]> {
        self.automaton.stops(mode).iter().map(Clock::reversed).collect()
    }

    #[inline]
    fn about(&self, edge: A::Edge) -> About {
        About::new().entry(self.automaton.undo_entry(edge)).affine_if(self.automaton.image_affine(edge))
    }

    fn solution(&self, mode: A::Mode, s: f64, x: &A::State) -> Solution<Self> {
        match self.automaton.solution(mode, -s, x) {
            Solution::Polynomial(polynomial) => {
                Solution::Polynomial(polynomial.map(|k, c| if k % 2 == 1 { c.with(|i| -c.get(i)) } else { c.clone() }))
            }
            Solution::Sparse(sparsity) => Solution::Sparse(sparsity),
            _ => Solution::Steps,
        }
    }

    /// Of a flow: that of an image is not asked for.
    fn refusal(&self, mode: A::Mode, edge: Option<A::Edge>, s: f64, x: &A::State) -> Option<Refusal> {
        if edge.is_some() { None } else { self.automaton.refusal(mode, None, -s, x) }
    }

    fn validate(&self, mode: A::Mode, s: f64, x: &A::State) -> Result<(), String> {
        self.automaton.validate(mode, -s, x)?;
        self.automaton.validate_backwards(mode)
    }
}
