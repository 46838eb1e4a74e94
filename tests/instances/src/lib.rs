//! Runs of automata of functions over the states that test programs share, compiled once.
//!
//! Where code is hardly optimised, as tests are, rustc takes a generic function from a crate below
//! that has compiled it for the same types. A test program that imports this crate, if only by
//! `use saltus_instances as _;`, compiles none of the engine for these states.

use saltus::nalgebra::{Vector2, Vector3, Vector4};
use saltus::{Hybrid, Simulation, State};

/// Runs `hybrid` from each number, recorded and not, by the stepper that is chosen at run time.
pub fn numbers(hybrid: &Hybrid<'_, f64>, x: f64) -> bool {
    runs(hybrid, x)
}

/// The same in the plane, as an array.
pub fn pairs(hybrid: &Hybrid<'_, [f64; 2]>, x: [f64; 2]) -> bool {
    runs(hybrid, x)
}

/// The same in the plane, as a vector.
pub fn planes(hybrid: &Hybrid<'_, Vector2<f64>>, x: Vector2<f64>) -> bool {
    runs(hybrid, x)
}

/// The same in space.
pub fn spaces(hybrid: &Hybrid<'_, Vector3<f64>>, x: Vector3<f64>) -> bool {
    runs(hybrid, x)
}

/// The same with two places and two velocities.
pub fn quads(hybrid: &Hybrid<'_, Vector4<f64>>, x: Vector4<f64>) -> bool {
    runs(hybrid, x)
}

fn runs<S: State>(hybrid: &Hybrid<'_, S>, x: S) -> bool {
    let simulation = Simulation::of(hybrid);
    let recorded = simulation.run("", x.clone(), 0.0..1.0).is_ok();
    recorded && simulation.drive("", x, 0.0..1.0, &mut ()).is_ok()
}
