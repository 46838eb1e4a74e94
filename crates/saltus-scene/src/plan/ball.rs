//! One ball that moves up and down over a level floor: exact arcs and closed forms, no steps.

use nalgebra::{Vector2, Vector3};
use saltus::{JumpOf, Polynomial};

use super::explain::Advance;
use super::record::{Moment, With};
use super::runner::{BoundModel, Runner};
use super::view::{Collision, SceneEvent, SceneView};
use super::{PlanError, failed};
use crate::Law;
use saltus_bounce::flight::{Apex, Impact, LinearDragFlight, QuadraticDragFlight, VacuumFlight, VerticalFlight};
use saltus_bounce::{Floor, Mode, Phase, SmoothFlight, Turn};

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

/// A flight without an apex edge, chosen as a plan is made: the engine is compiled once for all.
struct Smooth(Box<dyn SmoothFlight + Send + Sync>);

impl VerticalFlight for Smooth {
    fn acceleration(&self, velocity: f64) -> f64 {
        self.0.acceleration(velocity)
    }
    fn after(&self, s: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.0.after(s, x)
    }
    fn apex(&self, velocity: f64) -> Option<Apex> {
        self.0.apex(velocity)
    }
    fn fall(&self, depth: f64, speed: f64) -> Option<Impact> {
        self.0.fall(depth, speed)
    }
    fn impact(&self, x: &Vector2<f64>) -> Option<Impact> {
        self.0.impact(x)
    }
}

impl SmoothFlight for Smooth {
    fn polynomial(&self, x: &Vector2<f64>) -> Option<Polynomial<Vector2<f64>>> {
        self.0.polynomial(x)
    }
}

type Ball<F> = saltus_bounce::Ball<F, Law>;

pub(super) fn runner(vertical: Vertical, law: &Law) -> Result<Box<dyn Runner>, PlanError> {
    let Vertical { gravity, drag, floor: (owner, level), height, velocity } = vertical;
    let start = Vector2::new(height, velocity);
    let view = BallView { owner, level };
    let flight: Box<dyn SmoothFlight + Send + Sync> = match drag {
        Drag::None => Box::new(VacuumFlight::new(gravity).map_err(failed)?),
        Drag::Linear(rate) => Box::new(LinearDragFlight::new(gravity, rate).map_err(failed)?),
        Drag::Quadratic(k) => {
            let ball = Ball::of(QuadraticDragFlight::new(gravity, k).map_err(failed)?, *law);
            return Ok(BoundModel::boxed(ball, view, Phase::of(&start), start));
        }
    };
    Ok(BoundModel::boxed(Ball::of(Smooth(flight), *law), view, Mode::Flight, start))
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

impl SceneView<Ball<Smooth>> for BallView {
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
    fn scene_event(&self, _: &Ball<Smooth>, _: &JumpOf<Ball<Smooth>>, _: Floor) -> SceneEvent {
        self.floor()
    }
    fn modes(&self, _: &Ball<Smooth>) -> Vec<Mode> {
        vec![Mode::Flight, Mode::Rest]
    }
    fn edge(&self, _: &Ball<Smooth>, _: Mode, _: Floor) -> String {
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

impl SceneView<Ball<QuadraticDragFlight>> for BallView {
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
        _: &Ball<QuadraticDragFlight>,
        _: &JumpOf<Ball<QuadraticDragFlight>>,
        turn: Turn,
    ) -> SceneEvent {
        match turn {
            Turn::Floor => self.floor(),
            Turn::Apex => SceneEvent { balls: [Some(0), None], ..SceneEvent::of("apex") },
        }
    }
    fn modes(&self, _: &Ball<QuadraticDragFlight>) -> Vec<Phase> {
        vec![Phase::Rising, Phase::Falling, Phase::Rest]
    }
    fn edge(&self, _: &Ball<QuadraticDragFlight>, _: Phase, turn: Turn) -> String {
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
