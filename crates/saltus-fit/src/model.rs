//! The models of motion: what the heights and times of a bouncing ball should be.

mod contacts;
mod flight;
mod heights;

pub(crate) use contacts::{Contacts, Moment};
pub(crate) use flight::{Flight, FlightTrial};
pub(crate) use heights::{Height, Heights};
