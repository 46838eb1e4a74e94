//! Scenes as people write them: a TOML file with balls, floors and the effects that are wanted,
//! read into a [`Scene`].
//!
//! A scene is data. It does not say how it is to be run; every number in it has been checked, every
//! law is made. What the keys mean, with units and defaults, is in `docs/scenes.md`; [`schema`]
//! gives it to editors.

pub mod accuracy;
mod air;
mod animation;
mod ball;
mod check;
mod contact;
mod error;
mod file;
mod floor;
mod kinds;
mod motion;
mod number;
pub mod plan;
mod read;
mod report;
mod restitution;
mod run;
mod schema;
mod shape;
pub mod solve;
mod source;
mod space;
pub mod sweep;
mod template;
mod value;
pub mod vary;

#[cfg(test)]
mod tests;

use std::path::Path;

use source::Source;

pub use air::{Decay, Effects, Linear, Quadratic};
pub use animation::{Departure, Squash, Stage, Staging, length};
pub use ball::{Ball, Start};
pub use contact::Contact;
pub use error::{Error, SceneError};
pub use floor::{Floor, Shape};
pub use motion::Motion;
pub use plan::{Plan, Record};
pub use report::{Sampling, Table, Values};
pub use restitution::Law;
pub use run::{Kind, Picture, Run, Stepper};
pub use schema::schema;
pub use template::Template;

use saltus_bounce::effects::Gravity;
use saltus_bounce::friction::Friction;

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
    /// How many coordinates it needs: 1 (up), 2 (x, up) or 3 (x, y, up).
    pub dimensions: usize,
    /// At least one.
    pub balls: Vec<Ball>,
    /// Downwards.
    pub gravity: Gravity,
    /// What else acts in flight.
    pub effects: Effects,
    /// Floors, walls and boxes; may be empty.
    pub floors: Vec<Floor>,
    /// How balls and floors touch.
    pub contact: Contact,
    /// Restitution between balls; `None` for one ball.
    pub collision: Option<Law>,
    /// Friction between balls.
    pub collision_friction: Friction,
    /// When it ends and how it is stepped.
    pub run: Run,
    /// What is drawn.
    pub picture: Picture,
    /// Restitution by floor, then by ball; empty rows where contact takes time.
    laws: Vec<Vec<Law>>,
    source: Source,
}

impl Scene {
    /// The largest file that is read, in bytes.
    pub const LARGEST: usize = 1 << 20;

    /// Reads a scene from TOML; `name` stands for the file in messages. A byte-order mark is passed
    /// over.
    ///
    /// # Errors
    /// [`SceneError`], with line, column and advice, when the text is no TOML or no scene: an
    /// unknown key, a wrong unit, a number outside its domain, settings that contradict each other,
    /// a ball inside a floor, a run without end.
    pub fn parse(name: &str, toml: &[u8]) -> Result<Self, SceneError> {
        Self::parse_with(name, toml, Run::default())
    }

    /// The same, where what `run` says goes before what the text says under `[run]`: so a scene
    /// that says no end can be given one.
    ///
    /// ```
    /// use saltus_scene::{Run, Scene};
    /// let endless = b"restitution = 1\nball = { height = '1 m' }\n";
    /// assert!(Scene::parse("drop.toml", endless).is_err());
    /// let mut run = Run::default();
    /// run.until = Some(5.0);
    /// assert_eq!(Scene::parse_with("drop.toml", endless, run)?.run.until, Some(5.0));
    /// # Ok::<(), saltus_scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn parse_with(name: &str, toml: &[u8], run: Run) -> Result<Self, SceneError> {
        read::scene(name, toml, run)
    }

    /// Reads a scene from a file.
    ///
    /// # Errors
    /// [`ReadError`]: the file cannot be read, or its content is no scene.
    ///
    /// ```
    /// use saltus_scene::Scene;
    /// let error = Scene::read("no/such/scene.toml").unwrap_err();
    /// assert!(error.to_string().starts_with("cannot read 'no/such/scene.toml'"));
    /// ```
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        read::from_path(path.as_ref())
    }

    /// What a ball is called, counted from 0: its name, or its number.
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

/// A scene file that could not be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum ReadError {
    /// The file itself.
    File {
        /// Its path.
        path: std::path::PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// What stands in it.
    Scene(SceneError),
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File { path, error } => write!(f, "cannot read '{}': {error}", path.display()),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {}
