//! Bouncing balls as hybrid automata.
//!
//! [`Ball`] bounces up and down, [`Flyer`] in the plane and in space among [`walls`], [`Compliant`]
//! on a floor that gives, [`Line`], [`Cloud`] and [`Flock`] are several balls; run them with
//! [`saltus::Simulation`], or frame by frame as [`Live`]. [`Drop`] has the simplest ball's impacts
//! and apexes in closed form. [`units`] reads quantities as people write them; whole scenes from
//! TOML are the crate `saltus-scene`.

mod ball;
mod ballistic;
pub mod cloud;
pub mod compliant;
pub mod contact;
pub mod effects;
pub mod flight;
pub mod flock;
mod flyer;
pub mod friction;
mod impact;
pub mod line;
mod live;
pub mod materials;
mod parameter;
pub mod restitution;
mod sphere;
mod stable;
pub mod units;
pub mod walls;

pub use ball::{Ball, Floor, GravityError, Mode, Phase, SmoothFlight, Turn};
pub use ballistic::Drop;
pub use cloud::Cloud;
pub use compliant::Compliant;
pub use effects::STANDARD_GRAVITY;
pub use flock::Flock;
pub use flyer::{Block, Event, Flyer, Grip, Keeps, Moving, Rolls, Stance, Turning};
pub use line::Line;
pub use live::{Frame, Live};
pub use parameter::ParameterError;
pub use restitution::{Cor, CorError, Restitution};
pub use sphere::Sphere;
