//! Several balls that spin, rub, lie or fly in air, among whatever floors and walls a scene has.

use nalgebra::Vector3;
use saltus::{Automaton, JumpOf};

use super::explain::Advance;
use super::flyer::{self, FloorsView, Grips, InWind, Laws, SpinEffects};
use super::record::{Moment, With};
use super::runner::{BoundModel, Runner};
use super::surroundings::Surroundings;
use super::view::{Collision, SceneEvent, SceneView};
use super::{MOST_IN_SPACE, PlanError, failed};
use crate::{Law, Scene};
use saltus_bounce::effects::AddedMass;
use saltus_bounce::flock::{Flock, Flying, Happens, Meeting, Stances};
use saltus_bounce::walls::Walls;
use saltus_bounce::{Event, Flyer, Sphere, Stance};

type Model = Flock<MOST_IN_SPACE, AddedMass<InWind<3, SpinEffects>>, Surroundings<3>, Laws, Grips, Law>;

/// The runner of several balls; in the plane, and on a vertical line, they keep coordinates in
/// which nothing happens.
pub(super) fn runner(scene: &Scene) -> Result<Box<dyn Runner>, PlanError> {
    let count = scene.balls.len();
    if count > MOST_IN_SPACE {
        let says = format!("{count} balls are too many: a scene runs with up to {MOST_IN_SPACE}");
        return Err(PlanError::new("[[ball]]", &says));
    }
    let Some(between) = scene.collision else {
        return Err(PlanError::new("[collisions]", "no restitution is given between the balls"));
    };
    let mut balls = Vec::with_capacity(count);
    let mut starts = Vec::with_capacity(count);
    let mut stances = Stances::FLIGHT;
    for (n, ball) in scene.balls.iter().enumerate() {
        let Some(radius) = ball.radius else {
            return Err(PlanError::new("[[ball]]", "balls that meet in space need a size: give each a `radius`"));
        };
        let sphere = Sphere::with_inertia(radius, ball.mass.unwrap_or(1.0), ball.inertia).map_err(failed)?;
        let (walls, laws, grips) = flyer::gripped::<3>(scene, n)?;
        let effects = flyer::rigid(scene, ball, flyer::spinning_air::<3>(scene, ball)?)?;
        let start = flyer::start::<3>(ball).spinning(ball.spin.unwrap_or_default());
        stances = stances.with(n, Stance::Flight { cell: flyer::clear(&walls, &start.position)? });
        balls.push((sphere, Flyer::gripped(effects, walls, laws, grips).map_err(flyer::crowded)?));
        starts.push(start);
    }
    let flock = Model::new(balls, between, scene.collision_friction).map_err(failed)?;
    let rubs = scene.floors.iter().any(|floor| floor.friction.coefficient() > 0.0);
    let view = FlockView { among: FloorsView::new(scene, rubs), count };
    Ok(BoundModel::boxed(flock, view, stances, Flying::new(&starts).doing(stances)))
}

struct FlockView {
    among: FloorsView,
    count: usize,
}

impl SceneView<Model> for FlockView {
    type Stepper = saltus::Auto;

    fn balls(&self) -> usize {
        self.count
    }
    fn linear(&self, x: &Flying<MOST_IN_SPACE>, ball: usize) -> Moment {
        let ball = x.ball(ball);
        Moment { position: ball.position, velocity: ball.velocity, spin: ball.spin }
    }
    fn mode(&self, stances: Stances<MOST_IN_SPACE>, ball: usize) -> &'static str {
        flyer::named(stances.of(ball), 3)
    }
    fn flies(&self, stances: Stances<MOST_IN_SPACE>, ball: usize) -> bool {
        matches!(stances.of(ball), Stance::Flight { .. })
    }
    fn rests(&self, stances: Stances<MOST_IN_SPACE>, x: &Flying<MOST_IN_SPACE>) -> bool {
        let still = |ball: usize| {
            let moving = x.ball(ball);
            !self.flies(stances, ball) && moving.velocity.norm() == 0.0 && moving.spin.norm() == 0.0
        };
        (0..self.count).all(still) && !self.among.acts().1
    }
    fn scene_event(&self, model: &Model, jump: &JumpOf<Model>, meeting: Meeting) -> SceneEvent {
        match model.happens(meeting, &jump.from) {
            Happens::Balls(i, j) => {
                let [first, second] = [i, j].map(|ball| {
                    let above = Vector3::z() * model.balls()[ball].0.radius();
                    jump.before.ball(ball).position + above
                });
                let normal = (second - first).normalize();
                let collision = Collision { with: With::Ball(i), normal, speed: 0.0 };
                SceneEvent { edge: "ball", balls: [Some(j), Some(i)], collision: Some(collision) }
            }
            Happens::To(ball, event) => {
                let walls = model.balls()[ball].1.walls();
                self.among.event_of(walls, ball, jump.t(), jump.before.ball(ball).position.as_slice(), event)
            }
            Happens::Change => SceneEvent::of("schedule"),
            Happens::Nothing => SceneEvent::of("nothing"),
        }
    }
    fn modes(&self, model: &Model) -> Vec<Stances<MOST_IN_SPACE>> {
        let mut modes = vec![Stances::FLIGHT];
        let (rubs, _) = self.among.acts();
        let mut slip = Vector3::zeros();
        slip.x = if rubs { 1.0 } else { 0.0 };
        let walls = model.balls()[0].1.walls();
        for face in
            walls.all(0).filter(|&face| !walls.straight(face) || walls.gradient(face, 0.0, &Vector3::zeros()).z > 0.0)
        {
            modes.push(Stances::FLIGHT.with(0, Stance::Slide { face, along: slip }));
            if rubs {
                modes.push(Stances::FLIGHT.with(0, Stance::Hold { face }));
            }
        }
        modes
    }
    fn edge(&self, model: &Model, stances: Stances<MOST_IN_SPACE>, meeting: Meeting) -> String {
        match model.happens(meeting, &stances) {
            Happens::Balls(i, j) => format!("balls {} and {}", i + 1, j + 1),
            Happens::To(ball, event) => {
                let listed = self.among.listed(model.balls()[ball].1.walls(), event);
                let between = if matches!(event, Event::Meet(_)) { " and" } else { "," };
                format!("ball {}{between} {listed}", ball + 1)
            }
            Happens::Change => "schedule".to_owned(),
            Happens::Nothing => "nothing".to_owned(),
        }
    }
    fn edges(&self, model: &Model, stances: Stances<MOST_IN_SPACE>) -> Vec<String> {
        let edges = model.edges(stances);
        let mut list = vec!["each pair of balls".to_owned()];
        let events = edges.iter().filter_map(|meeting| match model.happens(meeting, &stances) {
            Happens::To(0, event) => Some(event),
            _ => None,
        });
        let walls = model.balls()[0].1.walls();
        let listed = events.map(|event| match event {
            Event::Meet(_) => format!("each ball and {}", self.among.listed(walls, event)),
            event => self.among.listed(walls, event),
        });
        list.extend(listed);
        list
    }
    fn why(&self, stances: Stances<MOST_IN_SPACE>, advance: Advance) -> &'static str {
        FloorsView::because(stances.of(0), advance)
    }
}
