//! The view of a model in the scene: what its states, modes and jumps mean there.

use nalgebra::Vector3;
use saltus::step::Stepper;
use saltus::{Automaton, Cause, JumpOf, Piece, TrajectoryOf};

use super::explain::Advance;
use super::method::Method;
use super::record::{Impact, Moment, Segment, With};

/// A jump as an event of the scene.
pub(super) struct SceneEvent {
    pub(super) edge: &'static str,
    /// The balls that take part; none means all.
    pub(super) balls: [Option<usize>; 2],
    pub(super) collision: Option<Collision>,
}

impl SceneEvent {
    /// Something that is no impact, with ball 0 or with all.
    pub(super) const fn of(edge: &'static str) -> Self {
        Self { edge, balls: [None; 2], collision: None }
    }
}

/// An impact: with what, along which normal, and how fast that itself moves along it.
pub(super) struct Collision {
    pub(super) with: With,
    pub(super) normal: Vector3<f64>,
    pub(super) speed: f64,
}

/// The view of a model in the scene: what its states, modes and jumps mean there.
pub(super) trait SceneView<A: Automaton>: Send + Sync + 'static {
    /// The stepper to compile the model for: the whole choice, or, where a formula solves every
    /// mode, one that takes no step.
    type Stepper: Stepper + From<Method>;
    fn balls(&self) -> usize {
        1
    }
    /// The part of a moment that is linear in the state.
    fn linear(&self, x: &A::State, ball: usize) -> Moment;
    /// The part that is added to it.
    fn origin(&self, ball: usize) -> Moment {
        let _ = ball;
        Moment::ZERO
    }
    fn mode(&self, mode: A::Mode, ball: usize) -> &'static str;
    fn flies(&self, mode: A::Mode, ball: usize) -> bool;
    /// Whether nothing moves any more.
    fn rests(&self, mode: A::Mode, x: &A::State) -> bool;
    /// The modes before and after the jump at an apex, where a flight has one.
    fn apex_jump(&self) -> Option<(A::Mode, A::Mode)> {
        None
    }
    /// A jump by an edge.
    fn scene_event(&self, model: &A, jump: &JumpOf<A>, edge: A::Edge) -> SceneEvent;
    /// The modes a run may enter, as far as they differ in how they are advanced.
    fn modes(&self, model: &A) -> Vec<A::Mode>;
    /// The name of an edge in a list, in a mode.
    fn edge(&self, model: &A, mode: A::Mode, edge: A::Edge) -> String;
    /// The names of the edges of a mode in a list.
    fn edges(&self, model: &A, mode: A::Mode) -> Vec<String> {
        model.edges(mode).iter().map(|edge| self.edge(model, mode, edge)).collect()
    }
    /// The reason why a mode is advanced as it is.
    fn why(&self, mode: A::Mode, advance: Advance) -> &'static str;
    /// Contacts that take time.
    fn contacts(&self, model: &A, run: &TrajectoryOf<A>) -> Option<Vec<Impact>> {
        let _ = (model, run);
        None
    }
    fn hysteresis(&self, model: &A, run: &TrajectoryOf<A>, contact: usize, count: usize) -> Vec<[f64; 2]> {
        let _ = (model, run, contact, count);
        Vec::new()
    }
}

/// A ball in a state.
pub(super) fn moment<A: Automaton>(view: &impl SceneView<A>, x: &A::State, ball: usize) -> Moment {
    view.linear(x, ball) + view.origin(ball)
}

/// A ball along a piece.
pub(super) fn segment<A: Automaton>(
    view: &impl SceneView<A>,
    mode: A::Mode,
    piece: &Piece<'_, A::State>,
    ball: usize,
) -> Segment {
    let mut factor = 1.0;
    let mut coefficients: Vec<Moment> = Vec::with_capacity(piece.coefficients().len());
    for c in piece.coefficients() {
        coefficients.push(view.linear(c, ball) * factor);
        factor /= piece.scale();
    }
    if let Some(first) = coefficients.first_mut() {
        *first = *first + view.origin(ball);
    }
    let (start, span) = (piece.start().seconds(), piece.span());
    Segment { start, span, mode: view.mode(mode, ball), flight: view.flies(mode, ball), coefficients }
}

pub(super) fn scene_event<A: Automaton>(model: &A, view: &impl SceneView<A>, jump: &JumpOf<A>) -> SceneEvent {
    match jump.cause {
        Cause::Edge(edge) => view.scene_event(model, jump, edge),
        _ => SceneEvent::of("zeno"),
    }
}

/// The impact that a jump is; `None` if it is none.
pub(super) fn impact<A: Automaton>(model: &A, view: &impl SceneView<A>, jump: &JumpOf<A>) -> Option<Impact> {
    let scene_event = scene_event(model, view, jump);
    let Collision { with, normal, speed } = scene_event.collision?;
    let ball = scene_event.balls[0].unwrap_or(0);
    let approach = |x: &A::State| {
        let other = match with {
            With::Ball(other) => moment(view, x, other).velocity.dot(&normal),
            With::Floor(_) => speed,
        };
        other - moment(view, x, ball).velocity.dot(&normal)
    };
    let (before, after) = (approach(&jump.before), -approach(&jump.after));
    // What comes to lie where it starts hits nothing. Rounding may leave a hair of the wrong sign.
    (before > 0.0 || after > 0.0).then(|| Impact {
        t: jump.t(),
        ball,
        with,
        approach: before.max(0.0),
        rebound: Some(after.max(0.0)),
        press: None,
    })
}
