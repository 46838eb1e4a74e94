//! A scene as data: every number in it is checked, every law is made.

use saltus_bounce::effects::Gravity;
use saltus_bounce::friction::Friction;

use super::air::Effects;
use super::ball::Ball;
use super::contact::Contact;
use super::floor::Floor;
use super::restitution::Law;
use super::run::{Picture, Run};
use super::source::Source;

/// A scene: balls, what acts on them, what they bounce on. SI units; vectors are (x, y, up).
///
/// ```
/// use saltus_scene::Scene;
/// let toml = br#"
///     gravity = "moon"
///     restitution = 0.8
///     [ball]
///     height = "150 cm"
/// "#;
/// let scene = Scene::parse("moon.toml", toml)?;
/// assert_eq!((scene.dimensions, scene.gravity.value()), (1, 1.62));
/// assert_eq!(scene.balls[0].lowest().z, 1.5);
/// assert_eq!(scene.law(0, 0).unwrap().constant().unwrap().value(), 0.8);
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// The number of coordinates: 1 (up), 2 (x, up) or 3 (x, y, up).
    pub dimensions: usize,
    /// The balls, at least one.
    pub balls: Vec<Ball>,
    /// Gravity, downwards.
    pub gravity: Gravity,
    /// The other effects in flight.
    pub effects: Effects,
    /// Floors, walls and boxes; may be empty.
    pub floors: Vec<Floor>,
    /// The law of contact of balls and floors.
    pub contact: Contact,
    /// Restitution between balls; `None` for one ball.
    pub collision: Option<Law>,
    /// Friction between balls.
    pub collision_friction: Friction,
    /// The end of the run, and its steps.
    pub run: Run,
    /// The kinds of pictures.
    pub picture: Picture,
    /// Restitution by floor, then by ball; empty rows where contact takes time.
    pub(super) laws: Vec<Vec<Law>>,
    pub(super) source: Source,
}

impl Scene {
    /// The name of a ball, counted from 0, or its number where it has none.
    #[must_use]
    pub fn ball_name(&self, ball: usize) -> String {
        let name = self.balls.get(ball).and_then(|ball| ball.name.clone());
        name.unwrap_or_else(|| format!("ball {}", ball + 1))
    }

    /// The law of restitution of a ball on a floor, both counted from 0; `None` where contact takes
    /// time or there is no such pair.
    #[must_use]
    pub fn law(&self, ball: usize, floor: usize) -> Option<&Law> {
        self.laws.get(floor)?.get(ball)
    }
}
