//! Several smooth balls in the plane or in space, in a box or over a level floor.

use nalgebra::Vector3;
use saltus::{Automaton, Coords, Edges, JumpOf};

use super::explain::Advance;
use super::listed::{Kin, Listed};
use super::record::{Moment, With};
use super::runner::{BoundModel, Runner};
use super::view::{Collision, SceneEvent, SceneView};
use super::{MOST_IN_SPACE, PlanError, failed};
use crate::{Law, Scene, Shape};
use saltus_bounce::Cloud;
use saltus_bounce::cloud::{Swarm, Touch};

/// A centre and a velocity of each ball.
const COORDINATES: usize = 6 * MOST_IN_SPACE;

/// Any number of balls.
type Model = Listed<(), Touch, COORDINATES>;

impl<const N: usize> Kin<(), Touch> for Cloud<3, N, Law> {
    fn common((): ()) {}
    fn own((): ()) {}
    fn own_edge(touch: Touch) -> Touch {
        touch
    }
    fn edges(&self, (): ()) -> Edges<'_, Touch> {
        Automaton::edges(self, ())
    }
}

/// The place of a wall that there is not: no ball gets there, and its square is a finite number.
const NOWHERE: f64 = 1e150;

/// The places of walls: low and high ends of (x, y, up), and the floor that each is of.
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
    owners: [[usize; 2]; 3],
}

/// The tightest of the scene's planes on each side.
fn bounds(scene: &Scene) -> Result<Bounds, PlanError> {
    let mut bounds = Bounds { low: [-NOWHERE; 3], high: [NOWHERE; 3], owners: [[0; 2]; 3] };
    let mut tighten = |axis: usize, high: bool, at: f64, owner: usize| {
        let end = if high { &mut bounds.high[axis] } else { &mut bounds.low[axis] };
        if high == (at < *end) {
            *end = at;
            bounds.owners[axis][usize::from(high)] = owner;
        }
    };
    for (owner, floor) in scene.floors.iter().enumerate() {
        if floor.motion.is_some() {
            return Err(PlanError::floor(
                owner,
                "several balls over a floor that moves are not simulated: leave `motion` out",
            ));
        }
        match floor.shape {
            Shape::Level { height } => tighten(2, false, height, owner),
            Shape::Wall { across_y, at, faces_up } => tighten(usize::from(across_y), !faces_up, at, owner),
            Shape::Box { size, height, open } => {
                tighten(2, false, height, owner);
                if !open {
                    tighten(2, true, height + size.z, owner);
                }
                for axis in [0, 1].into_iter().filter(|&axis| size[axis] > 0.0) {
                    tighten(axis, false, -0.5 * size[axis], owner);
                    tighten(axis, true, 0.5 * size[axis], owner);
                }
            }
            _ => {
                let says = "several balls are simulated in a box, between walls and over a level floor: choose one of these, or one ball";
                return Err(PlanError::floor(owner, says));
            }
        }
    }
    Ok(bounds)
}

/// Whether a cloud is a complete model of the scene: its walls are those of a box, met by one law,
/// and no ball ever comes to rest.
pub(super) fn suffices(scene: &Scene) -> bool {
    let elastic = |law: Option<&Law>| law.and_then(Law::constant).is_some_and(|cor| cor.value() == 1.0);
    let laws =
        || (0..scene.floors.len()).flat_map(|floor| (0..scene.balls.len()).map(move |ball| scene.law(ball, floor)));
    let lasting = scene.gravity.value() == 0.0 || laws().all(elastic) && elastic(scene.collision.as_ref());
    let first = scene.law(0, 0);
    lasting && laws().all(|law| law == first) && bounds(scene).is_ok()
}

pub(super) fn runner(scene: &Scene) -> Result<Box<dyn Runner>, PlanError> {
    macro_rules! sized {
        ($($n:literal)*) => {
            match scene.balls.len() {
                $($n => with::<$n>(scene),)*
                n => Err(PlanError::new("[[ball]]", &format!("{n} balls are too many: a scene runs with up to {MOST_IN_SPACE} that leave their line"))),
            }
        };
    }
    sized!(2 3 4 5)
}

/// The runner of N balls; in the plane they keep a third coordinate, in which nothing happens.
fn with<const N: usize>(scene: &Scene) -> Result<Box<dyn Runner>, PlanError> {
    let Some(between) = scene.collision else {
        return Err(PlanError::new("[collisions]", "no restitution is given between the balls"));
    };
    let balls = &scene.balls;
    let mut radii = [0.0; N];
    for (i, radius) in radii.iter_mut().enumerate() {
        *radius = balls[i]
            .radius
            .ok_or_else(|| PlanError::new("[[ball]]", "balls that meet in space need a size: give each a `radius`"))?;
    }
    let vector = |v: Vector3<f64>| [v.x, v.y, v.z];
    let masses: [f64; N] = std::array::from_fn(|i| balls[i].mass.unwrap_or(1.0));
    let gravity = [0.0, 0.0, -scene.gravity.value()];
    let bounds = bounds(scene)?;
    let laws: Vec<Law> = (0..scene.floors.len())
        .flat_map(|floor| (0..N).filter_map(move |ball| scene.law(ball, floor).copied()))
        .collect();
    if let Some(other) = laws.iter().position(|law| *law != laws[0]) {
        return Err(PlanError::floor(
            other / N,
            "several balls meet all walls by one law: give the same restitution to all",
        ));
    }
    let mut cloud = Cloud::new(masses, radii, between).and_then(|cloud| cloud.with_gravity(gravity)).map_err(failed)?;
    if let Some(law) = laws.first() {
        cloud = cloud.in_box(bounds.low, bounds.high, *law).map_err(failed)?;
    }
    let centres: [[f64; 3]; N] = std::array::from_fn(|i| vector(balls[i].centre()));
    let velocities: [[f64; 3]; N] = std::array::from_fn(|i| vector(balls[i].velocity));
    let view = CloudView { radii: radii.into(), owners: bounds.owners };
    let (cloud, (), start) = Model::of(cloud, (), Swarm { centres, velocities })?;
    Ok(BoundModel::boxed(cloud, view, (), start))
}

struct CloudView {
    radii: Vec<f64>,
    owners: [[usize; 2]; 3],
}

/// The centre of a ball.
fn centre(x: &[f64], ball: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&x[3 * ball..3 * ball + 3])
}

impl SceneView<Model> for CloudView {
    type Stepper = super::method::NoStepper;

    fn balls(&self) -> usize {
        self.radii.len()
    }
    fn linear(&self, x: &Coords<COORDINATES>, ball: usize) -> Moment {
        let velocity = centre(&x[3 * self.radii.len()..], ball);
        Moment { position: centre(x, ball), velocity, spin: Vector3::zeros() }
    }
    fn origin(&self, ball: usize) -> Moment {
        Moment { position: Vector3::new(0.0, 0.0, -self.radii[ball]), ..Moment::ZERO }
    }
    fn mode(&self, (): (), _: usize) -> &'static str {
        "flight"
    }
    fn flies(&self, (): (), _: usize) -> bool {
        true
    }
    fn rests(&self, (): (), _: &Coords<COORDINATES>) -> bool {
        false
    }
    fn scene_event(&self, _: &Model, jump: &JumpOf<Model>, touch: Touch) -> SceneEvent {
        let wall = |ball: usize, axis: usize, side: f64, end: usize| {
            let mut normal = [0.0; 3];
            normal[axis] = side;
            let collision =
                Collision { with: With::Floor(self.owners[axis][end]), normal: Vector3::from(normal), speed: 0.0 };
            let edge = if axis == 2 && end == 0 { "floor" } else { "wall" };
            SceneEvent { edge, balls: [Some(ball), None], collision: Some(collision) }
        };
        match touch {
            Touch::Balls(i, j) => {
                let apart = centre(&jump.before, j) - centre(&jump.before, i);
                let collision = Collision { with: With::Ball(i), normal: apart / apart.norm(), speed: 0.0 };
                SceneEvent { edge: "ball", balls: [Some(j), Some(i)], collision: Some(collision) }
            }
            Touch::Low { ball, axis } => wall(ball, axis, 1.0, 0),
            Touch::High { ball, axis } => wall(ball, axis, -1.0, 1),
        }
    }
    fn modes(&self, _: &Model) -> Vec<()> {
        vec![()]
    }
    fn edge(&self, _: &Model, (): (), touch: Touch) -> String {
        match touch {
            Touch::Balls(..) => "each pair of balls".to_owned(),
            Touch::Low { .. } | Touch::High { .. } => "each ball and each wall".to_owned(),
        }
    }
    fn why(&self, (): (), _: Advance) -> &'static str {
        "gravity pulls all alike: flights are parabolas, and the meeting of two balls is a quadratic's root"
    }
}
