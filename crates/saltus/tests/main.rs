//! The laws of the engine by its public interface, one program: what they share is compiled and
//! linked once, and they run side by side. `cargo test -p saltus walls::` runs one file of them.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

// Automata of functions are compiled there, once for all test programs.
use saltus_instances as _;

mod methods;

// Where a guard falls, and where it does not.
mod anew;
mod at_ends;
mod clocks;
mod domain;
mod entering;
mod far;
mod grazing;
mod late;
mod leaps;
mod many_guards;
mod many_walls;
mod missed;
mod own_times;
mod plastic;
mod poles;
mod promises;
mod retaken;
mod scales;
mod sliding;
mod staying;
mod stops;
mod touching;
mod units;
mod walls;

// Flows and how they are stepped.
mod series;
mod signals;
mod sparse;
mod steppers;
mod stiffness;
mod vectors;

// Models, runs and what is made of them.
mod backwards;
mod bad_input;
mod contract;
mod distance;
mod endings;
mod samples;
mod surfaces;
