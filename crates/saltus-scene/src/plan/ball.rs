//! One ball that moves up and down over a level floor: exact arcs and closed forms, no steps.

use nalgebra::{Vector2, Vector3};
use saltus::{Automaton, JumpOf};

use super::explain::Advance;
use super::record::{Moment, With};
use super::runner::{BoundModel, Runner};
use super::view::{Collision, SceneEvent, SceneView};
use super::{PlanError, failed};
use crate::Law;
use saltus_bounce::flight::{LinearDragFlight, QuadraticDragFlight, VacuumFlight};
use saltus_bounce::restitution::{Cor, Restitution};
use saltus_bounce::{Ball, Floor, Mode, Phase, SmoothFlight, Turn};

/// The drag on a vertical ball.
#[derive(Clone, Copy, Debug)]
pub(super) enum Drag {
    None,
    Linear(f64),
    Quadratic(f64),
}

/// The parameters of the model, in SI units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertical {
    /// Downwards, less what buoyancy and added mass leave of it.
    pub(super) gravity: f64,
    pub(super) drag: Drag,
    /// The number of the floor in the scene, and its height.
    pub(super) floor: (usize, f64),
    /// The height above the floor.
    pub(super) height: f64,
    pub(super) velocity: f64,
}

pub(super) fn runner(vertical: Vertical, law: &Law) -> Result<Box<dyn Runner>, PlanError> {
    match law.constant() {
        Some(cor) => with::<Cor>(vertical, cor),
        None => with::<Law>(vertical, *law),
    }
}

fn with<R>(vertical: Vertical, law: R) -> Result<Box<dyn Runner>, PlanError>
where
    R: Restitution + Copy + Send + Sync + 'static,
{
    let Vertical { gravity, drag, floor: (owner, level), height, velocity } = vertical;
    let start = Vector2::new(height, velocity);
    let view = BallView { owner, level };
    Ok(match drag {
        Drag::None => {
            let ball = Ball::of(VacuumFlight::new(gravity).map_err(failed)?, law);
            BoundModel::boxed(ball, view, Mode::Flight, start)
        }
        Drag::Linear(rate) => {
            let ball = Ball::of(LinearDragFlight::new(gravity, rate).map_err(failed)?, law);
            BoundModel::boxed(ball, view, Mode::Flight, start)
        }
        Drag::Quadratic(k) => {
            let ball = Ball::of(QuadraticDragFlight::new(gravity, k).map_err(failed)?, law);
            BoundModel::boxed(ball, view, Phase::of(&start), start)
        }
    })
}

/// Reads a vertical ball over a floor at a height.
struct BallView {
    owner: usize,
    level: f64,
}

impl BallView {
    fn linear(x: &Vector2<f64>) -> Moment {
        let up = |up: f64| Vector3::new(0.0, 0.0, up);
        Moment { position: up(x[0]), velocity: up(x[1]), spin: Vector3::zeros() }
    }

    fn origin(&self) -> Moment {
        Moment { position: Vector3::new(0.0, 0.0, self.level), ..Moment::ZERO }
    }

    fn floor(&self) -> SceneEvent {
        let collision = Collision { with: With::Floor(self.owner), normal: Vector3::z(), speed: 0.0 };
        SceneEvent { edge: "floor", balls: [Some(0), None], collision: Some(collision) }
    }
}

/// A flight without an apex edge that this crate plans: all smooth ones there are, and no other.
trait Smooth: SmoothFlight {}
impl Smooth for VacuumFlight {}
impl Smooth for LinearDragFlight {}

impl<F: Smooth, R: Restitution> SceneView<Ball<F, R>> for BallView
where
    Ball<F, R>: Automaton<Mode = Mode, Edge = Floor, State = Vector2<f64>>,
{
    type Stepper = super::method::NoStepper;

    fn linear(&self, x: &Vector2<f64>, _: usize) -> Moment {
        Self::linear(x)
    }
    fn origin(&self, _: usize) -> Moment {
        self.origin()
    }
    fn mode(&self, mode: Mode, _: usize) -> &'static str {
        match mode {
            Mode::Flight => "flight",
            Mode::Rest => "rest",
        }
    }
    fn flies(&self, mode: Mode, _: usize) -> bool {
        mode == Mode::Flight
    }
    fn rests(&self, mode: Mode, _: &Vector2<f64>) -> bool {
        mode == Mode::Rest
    }
    fn scene_event(&self, _: &Ball<F, R>, _: &JumpOf<Ball<F, R>>, _: Floor) -> SceneEvent {
        self.floor()
    }
    fn modes(&self, _: &Ball<F, R>) -> Vec<Mode> {
        vec![Mode::Flight, Mode::Rest]
    }
    fn edge(&self, _: &Ball<F, R>, _: Mode, _: Floor) -> String {
        "floor".to_owned()
    }
    fn why(&self, mode: Mode, advance: Advance) -> &'static str {
        match (mode, advance) {
            (Mode::Rest, _) => "nothing moves",
            (_, Advance::Exact) => "the acceleration is constant: a parabola, and its impact a quadratic's root",
            _ => "linear drag is solved by exponentials, and its impact by a root of them",
        }
    }
}

impl<R: Restitution> SceneView<Ball<QuadraticDragFlight, R>> for BallView {
    type Stepper = super::method::NoStepper;

    fn linear(&self, x: &Vector2<f64>, _: usize) -> Moment {
        Self::linear(x)
    }
    fn origin(&self, _: usize) -> Moment {
        self.origin()
    }
    fn apex_jump(&self) -> Option<(Phase, Phase)> {
        Some((Phase::Rising, Phase::Falling))
    }
    fn mode(&self, phase: Phase, _: usize) -> &'static str {
        match phase {
            Phase::Rising => "rising",
            Phase::Falling => "falling",
            Phase::Rest => "rest",
        }
    }
    fn flies(&self, phase: Phase, _: usize) -> bool {
        phase != Phase::Rest
    }
    fn rests(&self, phase: Phase, _: &Vector2<f64>) -> bool {
        phase == Phase::Rest
    }
    fn scene_event(
        &self,
        _: &Ball<QuadraticDragFlight, R>,
        _: &JumpOf<Ball<QuadraticDragFlight, R>>,
        turn: Turn,
    ) -> SceneEvent {
        match turn {
            Turn::Floor => self.floor(),
            Turn::Apex => SceneEvent { balls: [Some(0), None], ..SceneEvent::of("apex") },
        }
    }
    fn modes(&self, _: &Ball<QuadraticDragFlight, R>) -> Vec<Phase> {
        vec![Phase::Rising, Phase::Falling, Phase::Rest]
    }
    fn edge(&self, _: &Ball<QuadraticDragFlight, R>, _: Phase, turn: Turn) -> String {
        match turn {
            Turn::Apex => "apex: the velocity falls through zero".to_owned(),
            Turn::Floor => "floor".to_owned(),
        }
    }
    fn why(&self, phase: Phase, _: Advance) -> &'static str {
        match phase {
            Phase::Rising => "quadratic drag on the way up is solved by tangents and logarithms",
            Phase::Falling => "quadratic drag on the way down is solved by hyperbolic functions",
            Phase::Rest => "nothing moves",
        }
    }
}
