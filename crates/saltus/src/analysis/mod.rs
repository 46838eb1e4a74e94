//! What is made of runs and models: derivatives, return maps, time reversed, distances, costs.

pub(crate) mod distance;
pub(crate) mod frames;
#[cfg(feature = "num-dual")]
pub(crate) mod linearize;
#[cfg(feature = "num-dual")]
pub mod return_map;
pub(crate) mod reverse;
pub(crate) mod work;
