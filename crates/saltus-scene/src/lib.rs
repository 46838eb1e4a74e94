//! Scenes of bouncing balls from TOML files: balls, floors and the effects that act, read into a
//! [`Scene`].
//!
//! A scene is data, without a method to run it; every number in it has been checked, every law is
//! made. What the keys mean, with units and defaults, is in `docs/use/scenes.md`; [`schema`] gives
//! it to editors.
//!
//! A scene is planned, and run: a [`Record`] is all that happened. From there a few lines lead to a
//! table, to JSON, to a file for animators, and to a picture; [`Plan::explain`], written with `{}`,
//! says what acts and how it is advanced. In `Cargo.toml`:
//!
//! ```toml
//! saltus-scene = { path = "…/crates/saltus-scene" }
//! saltus-motion = { path = "…/crates/saltus-motion" } # files for animators
//! saltus-plot = { path = "…/crates/saltus-plot", features = ["scene"] } # pictures
//! ```
//!
//! ```
//! use saltus_motion::{Format, Frames};
//! use saltus_scene::{Sampling, Scene, Staging};
//!
//! let toml = b"restitution = 0.75
//! [ball]
//! name = 'tennis ball'
//! radius = '33 mm'
//! position = ['0 m', '1 m']
//! velocity = ['2 m/s', '0 m/s']
//! ";
//! // Or `Scene::read("scene.toml")`.
//! let scene = Scene::parse("scene.toml", toml)?;
//! let record = scene.plan()?.run()?;
//! for impact in record.impacts().iter().take(3) {
//!     println!("{:.3} s at {:.2} m/s", impact.t, impact.approach);
//! }
//!
//! // Samples every 10 ms, for a spreadsheet; `record.json(..)` for programs.
//! let csv = record.table(Some(Sampling::Every(0.01)))?.csv();
//! assert!(csv.starts_with("time_s,"));
//!
//! // Keys for animators, 24 frames a second, within 0.1 mm; `glb.bytes` is the file.
//! let stage = Staging::new(Frames::new("24".parse()?)).stage(&record)?;
//! let glb = stage.file(Format::Glb, 1e-4)?;
//! assert!(glb.bytes.starts_with(b"glTF"));
//! println!("{}", stage.says(&glb));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A picture is `saltus_plot::record::svg(&record, Kind::Height)`, by the crate `saltus-plot` with
//! its feature `scene`. Many runs with other values are a [`sweep`]; a scene that does what is
//! wished for is found by [`solve`]; what accuracy costs is measured by [`accuracy`].

pub mod accuracy;
mod air;
mod animation;
mod ball;
mod cell;
mod check;
mod column;
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
