//! The models of motion: what the heights and times of a bouncing ball should be.

mod contacts;
mod drag;
mod dual;
mod flight;
mod heights;
mod lasting;
mod law;
mod trajectory;

pub(crate) use contacts::{Contacts, Moment};
pub(crate) use drag::Air;
pub(crate) use dual::Dual;
pub(crate) use flight::{Flight, FlightTrial};
pub(crate) use heights::{Height, Heights};
pub(crate) use lasting::{BEFORE, LASTING};
pub(crate) use law::CorLaw;
pub(crate) use trajectory::{FLOOR, GRAVITY, LEAST_DRAG, Law, SPEED, Sample, TIME, Trajectory};
