//! One ball that moves up and down and is deformed as it meets a level floor.

use nalgebra::{Vector2, Vector3};
use saltus::{JumpOf, TrajectoryOf};

use super::explain::Advance;
use super::record::{Impact, Moment, Press, With};
use super::runner::{BoundModel, Runner};
use super::view::{SceneEvent, SceneView};
use super::{PlanError, failed};
use crate::Contact;
use saltus_bounce::Compliant;
use saltus_bounce::compliant::{Moment as Edge, Stage};
use saltus_bounce::contact::ContactLaw;

/// The parameters of the model, in SI units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pressed {
    pub(super) mass: f64,
    pub(super) gravity: f64,
    /// The number of the floor in the scene, and its height.
    pub(super) floor: (usize, f64),
    /// The height above the floor.
    pub(super) height: f64,
    pub(super) velocity: f64,
}

/// The runner, and an absolute tolerance far below the deformation where contacts are stepped.
pub(super) fn runner(pressed: Pressed, contact: Contact) -> Result<(Box<dyn Runner>, Option<f64>), PlanError> {
    match contact {
        Contact::KelvinVoigt(law) => with(pressed, law),
        Contact::Hertz(law) => with(pressed, law),
        Contact::HuntCrossley(law) => with(pressed, law),
        Contact::Rigid => Err(PlanError::new("[contact]", "a rigid contact takes no time: give a restitution")),
    }
}

fn with<L>(pressed: Pressed, law: L) -> Result<(Box<dyn Runner>, Option<f64>), PlanError>
where
    L: ContactLaw + Send + Sync + 'static,
{
    let Pressed { mass, gravity, floor: (owner, level), height, velocity } = pressed;
    let speed = (velocity * velocity + 2.0 * gravity * height.max(0.0)).sqrt();
    let absolute = match (law.linear(), law.collision(mass, speed)) {
        (None, Some(collision)) => Some((1e-12 * collision.deformation).max(f64::MIN_POSITIVE)),
        _ => None,
    };
    let ball = Compliant::new(mass, gravity, law).map_err(failed)?;
    let (stage, start) = ball.released(height, velocity);
    Ok((BoundModel::boxed(ball, CompliantView { owner, level }, stage, start), absolute))
}

struct CompliantView {
    owner: usize,
    level: f64,
}

impl<L: ContactLaw + Send + Sync + 'static> SceneView<Compliant<L>> for CompliantView {
    type Stepper = saltus::Auto;

    fn linear(&self, x: &Vector2<f64>, _: usize) -> Moment {
        let up = |up: f64| Vector3::new(0.0, 0.0, up);
        Moment { position: up(x[0]), velocity: up(x[1]), spin: Vector3::zeros() }
    }
    fn origin(&self, _: usize) -> Moment {
        Moment { position: Vector3::new(0.0, 0.0, self.level), ..Moment::ZERO }
    }
    fn mode(&self, stage: Stage, _: usize) -> &'static str {
        match stage {
            Stage::Fall => "fall",
            Stage::Compression => "compression",
            Stage::Restitution => "restitution",
            Stage::Rise => "rise",
            Stage::Lying => "lying",
        }
    }
    fn flies(&self, stage: Stage, _: usize) -> bool {
        !stage.is_contact()
    }
    fn rests(&self, _: Stage, _: &Vector2<f64>) -> bool {
        false // it swings about its static deformation, ever less
    }
    fn scene_event(&self, _: &Compliant<L>, _: &JumpOf<Compliant<L>>, edge: Edge) -> SceneEvent {
        let name = match edge {
            Edge::FirstContact => "first contact",
            Edge::GreatestDeformation => "greatest deformation",
            Edge::LiftOff => "lift-off",
            Edge::LeastDeformation => "least deformation",
            Edge::Apex => "apex",
        };
        SceneEvent { balls: [Some(0), None], ..SceneEvent::of(name) }
    }
    fn modes(&self, _: &Compliant<L>) -> Vec<Stage> {
        vec![Stage::Fall, Stage::Compression, Stage::Restitution, Stage::Rise, Stage::Lying]
    }
    fn edge(&self, _: &Compliant<L>, _: Stage, edge: Edge) -> String {
        match edge {
            Edge::FirstContact => "first contact: the height falls through the floor's",
            Edge::GreatestDeformation => "greatest deformation: its rate falls through zero",
            Edge::LiftOff => "lift-off: the law's margin falls through zero",
            Edge::LeastDeformation => "least deformation: the ball turns back before it leaves",
            Edge::Apex => "apex: the velocity falls through zero",
        }
        .to_owned()
    }
    fn why(&self, stage: Stage, advance: Advance) -> &'static str {
        match (stage.is_contact(), advance) {
            (false, _) => "the acceleration is constant: a parabola",
            (true, Advance::Formula) => {
                "spring and damper are linear: exponentials, with the times of turning and release"
            }
            _ => {
                "the force is no linear function of the deformation; steps follow it, for its time scale is the contact's own"
            }
        }
    }
    fn contacts(&self, model: &Compliant<L>, run: &TrajectoryOf<Compliant<L>>) -> Option<Vec<Impact>> {
        let impact = |contact: saltus_bounce::compliant::Contact| Impact {
            t: contact.touch,
            ball: 0,
            with: With::Floor(self.owner),
            approach: contact.speed,
            rebound: contact.cor.map(|cor| cor * contact.speed),
            press: Some(Press { duration: contact.duration, force: contact.force, deformation: contact.deformation }),
        };
        Some(model.contacts(run).into_iter().map(impact).collect())
    }
    fn hysteresis(
        &self,
        model: &Compliant<L>,
        run: &TrajectoryOf<Compliant<L>>,
        contact: usize,
        count: usize,
    ) -> Vec<[f64; 2]> {
        let contacts = model.contacts(run);
        contacts.get(contact).map_or_else(Vec::new, |contact| model.hysteresis(run, contact, count))
    }
}
