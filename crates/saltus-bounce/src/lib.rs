//! Bouncing balls as hybrid automata.
//!
//! [`Ball`] is the automaton; run it with [`saltus::Simulation`]. [`Drop`] has the same ball's impacts and apexes in closed form.
//! [`units`] reads quantities as people write them.

mod ball;
mod ballistic;
mod restitution;
pub mod units;

pub use ball::{Ball, Floor, GravityError, Mode, STANDARD_GRAVITY};
pub use ballistic::Drop;
pub use restitution::{Cor, CorError};
