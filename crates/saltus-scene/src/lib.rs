//! Scenes of bouncing balls from TOML files: balls, floors and the effects that act, read into a
//! [`Scene`].
//!
//! A scene is data, without a method to run it; every number in it has been checked, every law is
//! made. The keys are [below](#the-keys-of-a-scene), and all of them with units and defaults in
//! `docs/use/scenes.md` of the project; [`schema`] gives them to editors.
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
//!
//! # The keys of a scene
//!
//! What a scene does not name does not act. A quantity is text with a unit or a bare number in the
//! SI unit; vectors are `[x, up]` or in space `[x, y, up]`, one or the other throughout. Keys of
//! the top come before the first `[table]`; what is not understood is an error that says what is.
//!
//! ```
//! # use saltus_scene::Scene;
//! # use saltus_scene::plan::With;
//! let toml = br#"
//! gravity = "9.81 m/s^2"                 # or a name, such as "moon"; 9.80665 without it
//! restitution = 0.75                     # or a law over the speed of impact
//! friction = 0.4                         # turns the ball, which needs a radius
//! buoyancy = true                        # the air lifts the ball; `added_mass` likewise
//! drag = { coefficient = 0.5 }           # quadratic; `rate` in 1/s is linear
//! magnus = { slope = 1 }                 # lift by spin
//! spin_decay = { time = "20 s" }         # to 1/e
//! air = { wind = ["-2 m/s", "0 m/s"] }   # and `density`, `viscosity`
//! run = { until = "4 s" }                # where it would not end by itself
//! picture = { kind = "path" }            # and `title`
//!
//! [ball]                                 # or [[ball]], several times, and `collisions`
//! name = "tennis ball"
//! radius = "33 mm"
//! mass = "58 g"
//! shape = "hollow"                       # "solid" without it
//! position = ["0 m", "1 m"]              # of the centre; or `height`, of the lowest point
//! velocity = ["20 m/s", "3 m/s"]
//! spin = "-20 rev/s"                     # topspin is negative
//!
//! [[floor]]                              # without any, one level floor at height 0
//! kind = "incline"                       # level, stairs, box, parabola, sine, polyline
//! angle = "5 deg"
//!
//! [[floor]]
//! kind = "wall"
//! at = "12 m"
//! restitution = 0.6                      # its own
//! "#;
//! let record = Scene::parse("court.toml", toml)?.plan()?.run()?;
//! let with: Vec<With> = record.impacts().iter().take(3).map(|impact| impact.with).collect();
//! assert_eq!(with, [With::Floor(0), With::Floor(1), With::Floor(0)]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In place of a restitution a `contact` takes time: `contact = { law = "kelvin-voigt", cor = 0.6,
//! time = "4 ms" }`, or Hertz's and Hunt and Crossley's laws.

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
mod parts;
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
