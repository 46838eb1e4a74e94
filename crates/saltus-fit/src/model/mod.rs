//! The models of motion: what the heights and times of a bouncing ball should be.

mod altered;
mod contacts;
mod drag;
mod dual;
mod flight;
mod heights;
mod lasting;
mod law;
mod physics;
mod places;
mod problem;
mod trajectory;

pub(crate) use altered::{lowered_at_most, missed, raised, released_higher, rescaled, telling, without_air};
pub(crate) use contacts::Contacts;
pub(crate) use drag::Air;
pub(crate) use dual::Dual;
pub(crate) use flight::{FOLLOWED, Flight, FlightTrial, LONGEST_CONTACT, READINGS};
pub(crate) use heights::Heights;
pub(crate) use lasting::{BEFORE, LASTING};
pub(crate) use law::CorLaw;
pub(crate) use physics::{BEND, HARDEST, LIGHT_DRAG, LOSSLESS, ORDINARY_DRAG, PHYSICAL_DRAG, VAGUE};
pub(crate) use places::{FLOOR, GRAVITY, SPEED, TIME};
pub(crate) use problem::{Bounds, Model};
pub(crate) use trajectory::{LEAST_DRAG, Law, Sample, Trajectory};
