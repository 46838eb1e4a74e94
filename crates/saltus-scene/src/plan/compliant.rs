//! One ball that moves up and down and is deformed as it meets a level floor.

use nalgebra::{Vector2, Vector3};
use saltus::{JumpOf, TrajectoryOf};

use super::explain::Advance;
use super::record::{Impact, Moment, Press, With};
use super::runner::{BoundModel, Runner};
use super::view::{SceneEvent, SceneView};
use super::{PlanError, failed};
use crate::Contact;
use saltus_bounce::compliant::{Moment as Edge, Stage};
use saltus_bounce::contact::{Collision, ContactLaw, Hertz, HuntCrossley, KelvinVoigt};

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

/// A law that is chosen as a plan is made: the engine is compiled once for all.
#[derive(Clone, Copy, Debug)]
enum Chosen {
    KelvinVoigt(KelvinVoigt),
    Hertz(Hertz),
    HuntCrossley(HuntCrossley),
}

/// Runs `$do` with the law.
macro_rules! of_law {
    ($self:ident, $law:ident, $do:expr) => {
        match $self {
            Self::KelvinVoigt($law) => $do,
            Self::Hertz($law) => $do,
            Self::HuntCrossley($law) => $do,
        }
    };
}

impl ContactLaw for Chosen {
    #[inline]
    fn force(&self, deformation: f64, rate: f64) -> f64 {
        of_law!(self, law, law.force(deformation, rate))
    }
    fn stiffness(&self, deformation: f64, rate: f64) -> f64 {
        of_law!(self, law, law.stiffness(deformation, rate))
    }
    fn damping(&self, deformation: f64, rate: f64) -> f64 {
        of_law!(self, law, law.damping(deformation, rate))
    }
    #[inline]
    fn margin(&self, deformation: f64, rate: f64) -> f64 {
        of_law!(self, law, law.margin(deformation, rate))
    }
    #[inline]
    fn linear(&self) -> Option<KelvinVoigt> {
        of_law!(self, law, law.linear())
    }
    fn collision(&self, mass: f64, speed: f64) -> Option<Collision> {
        of_law!(self, law, law.collision(mass, speed))
    }
}

type Compliant = saltus_bounce::Compliant<Chosen>;

/// The runner, and an absolute tolerance far below the deformation where contacts are stepped.
pub(super) fn runner(pressed: Pressed, contact: Contact) -> Result<(Box<dyn Runner>, Option<f64>), PlanError> {
    let law = match contact {
        Contact::KelvinVoigt(law) => Chosen::KelvinVoigt(law),
        Contact::Hertz(law) => Chosen::Hertz(law),
        Contact::HuntCrossley(law) => Chosen::HuntCrossley(law),
        Contact::Rigid => {
            return Err(PlanError::new("[contact]", "a rigid contact takes no time: give a restitution"));
        }
    };
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

impl SceneView<Compliant> for CompliantView {
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
    fn scene_event(&self, _: &Compliant, _: &JumpOf<Compliant>, edge: Edge) -> SceneEvent {
        let name = match edge {
            Edge::FirstContact => "first contact",
            Edge::GreatestDeformation => "greatest deformation",
            Edge::LiftOff => "lift-off",
            Edge::LeastDeformation => "least deformation",
            Edge::Apex => "apex",
        };
        SceneEvent { balls: [Some(0), None], ..SceneEvent::of(name) }
    }
    fn modes(&self, _: &Compliant) -> Vec<Stage> {
        vec![Stage::Fall, Stage::Compression, Stage::Restitution, Stage::Rise, Stage::Lying]
    }
    fn edge(&self, _: &Compliant, _: Stage, edge: Edge) -> String {
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
    fn contacts(&self, model: &Compliant, run: &TrajectoryOf<Compliant>) -> Option<Vec<Impact>> {
        let impact = |contact: saltus_bounce::compliant::Contact| Impact {
            t: contact.touch,
            ball: 0,
            with: With::Floor(self.owner),
            approach: contact.speed,
            rebound: contact.cor.map(|cor| cor * contact.speed),
            press: Some(Press { duration: contact.duration, force: contact.force, deformation: contact.deformation }),
        };
        let contacts = match *model.law() {
            Chosen::KelvinVoigt(law) => model.by(law).contacts(run),
            Chosen::Hertz(law) => model.by(law).contacts(run),
            Chosen::HuntCrossley(law) => model.by(law).contacts(run),
        };
        Some(contacts.into_iter().map(impact).collect())
    }
    fn hysteresis(
        &self,
        model: &Compliant,
        run: &TrajectoryOf<Compliant>,
        contact: usize,
        count: usize,
    ) -> Vec<[f64; 2]> {
        let contacts = model.contacts(run);
        contacts.get(contact).map_or_else(Vec::new, |contact| model.hysteresis(run, contact, count))
    }
}
