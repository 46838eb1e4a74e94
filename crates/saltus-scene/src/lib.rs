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
mod scene;
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

pub use air::{Decay, Effects, Linear, Quadratic};
pub use animation::{Departure, Squash, Stage, Staging, at_most, length, rounded_up};
pub use ball::{Ball, Start};
pub use contact::Contact;
pub use error::{Error, SceneError};
pub use floor::{Floor, Shape};
pub use motion::Motion;
pub use plan::{Plan, Record};
pub use read::ReadError;
pub use report::{Sampling, Table, Values};
pub use restitution::Law;
pub use run::{Kind, Picture, Run, Stepper};
pub use scene::Scene;
pub use schema::schema;
pub use template::Template;
