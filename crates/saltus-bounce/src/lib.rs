//! Bouncing balls as hybrid automata.
//!
//! [`Ball`] is the automaton; run it with [`saltus::Simulation`]. [`Drop`] has the same ball's impacts and apexes in closed form.
//! [`units`] reads quantities as people write them; `scene`, behind the feature of this name, whole scenes from TOML.

mod ball;
mod ballistic;
pub mod cloud;
pub mod compliant;
pub mod contact;
pub mod effects;
pub mod flight;
pub mod friction;
pub mod line;
pub mod materials;
mod parameter;
pub mod restitution;
#[cfg(feature = "scene")]
pub mod scene;
mod sphere;
mod stable;
pub mod units;

pub use ball::{Ball, Floor, GravityError, Mode, STANDARD_GRAVITY};
pub use ballistic::Drop;
pub use cloud::Cloud;
pub use compliant::Compliant;
pub use line::Line;
pub use parameter::ParameterError;
pub use restitution::{Cor, CorError, Restitution};
pub use sphere::Sphere;
