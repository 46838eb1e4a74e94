//! From a scene to something that runs.

use saltus_bounce::Cor;
use saltus_bounce::scene::{Contact, Effects, Kind, Law, Scene, Shape};

use crate::error::Error;

/// A ball on a level floor, under gravity alone. SI units; heights above the floor.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) gravity: f64,
    pub(crate) cor: Cor,
    pub(crate) height: f64,
    pub(crate) velocity: f64,
    pub(crate) until: Option<f64>,
    pub(crate) most_jumps: Option<u32>,
    pub(crate) title: Option<String>,
    /// What the user should know before the run.
    pub(crate) note: Option<String>,
}

/// How a scene is run; the one place where what cannot be run yet is refused.
pub(crate) fn plan(scene: &Scene) -> Result<Plan, Error> {
    let not_yet = |what: &str| Err(Error::new(format!("the scene is right, but {what} cannot be simulated yet")));
    let [ball] = &scene.balls[..] else { return not_yet("several balls") };
    if scene.dimensions > 1 {
        return not_yet("motion other than up and down");
    }
    if let Some(effect) = effect(&scene.effects) {
        return not_yet(effect);
    }
    if scene.contact != Contact::Rigid {
        return not_yet("contact that takes time");
    }
    let [floor] = &scene.floors[..] else { return not_yet("any number of floors but one") };
    let Shape::Level { height: level } = floor.shape else { return not_yet("a floor that is not level") };
    if floor.motion.is_some() {
        return not_yet("a floor that moves");
    }
    let Some(law) = scene.law(0, 0) else { return not_yet("a floor without restitution") };
    let Some(cor) = law.constant() else { return not_yet("restitution that depends on the speed") };
    if scene.picture.kind != Kind::Height {
        return not_yet("a picture other than height against time");
    }
    Ok(Plan {
        gravity: scene.gravity.value(),
        cor,
        height: ball.lowest().z - level,
        velocity: ball.velocity.z,
        until: scene.run.until,
        most_jumps: scene.run.most_jumps,
        title: scene.picture.title.clone(),
        note: note(law, cor),
    })
}

/// The first effect in the air that the scene names.
fn effect(effects: &Effects) -> Option<&'static str> {
    [
        (effects.linear.is_some() || effects.quadratic.is_some(), "drag"),
        (effects.buoyancy, "buoyancy"),
        (effects.added_mass, "added mass"),
        (effects.lift.is_some(), "lift by spin"),
        (effects.spin_decay.is_some(), "decay of spin"),
        (effects.wind.is_some(), "wind"),
    ]
    .into_iter()
    .find_map(|(named, what)| named.then_some(what))
}

/// A range is said to be one, with its source, where a run takes one number of it.
fn note(law: &Law, cor: Cor) -> Option<String> {
    let [low, high] = law.range(0.0);
    let taken = format!("this run takes {:.4}; `restitution = {{ pick = 0 }}` to `1` takes another", cor.value());
    match law {
        Law::Preset { preset, .. } => Some(format!("{preset}: {taken}")),
        Law::Range { .. } => Some(format!("COR between {low} and {high}: {taken}")),
        _ => None,
    }
}
