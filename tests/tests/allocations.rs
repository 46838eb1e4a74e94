//! The loop does not allocate: not for a step, not for a crossing, not for a jump.
//!
//! Counting allocations takes an allocator of our own, and that takes `unsafe`; so they are counted
//! by a library.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use allocation_counter::measure;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Dop853, Hybrid, Simulation};
use saltus_bounce::{Ball, Cor, Mode};
use saltus_instances as _;

#[test]
fn exact_arcs() {
    let ball = Ball::new(9.8, Cor::new(0.99).unwrap()).unwrap();
    let simulation = Simulation::of(&ball);
    let counted = measure(|| {
        simulation.drive(Mode::Flight, vector![1.0, 0.0], 0.0..100.0, &mut ()).unwrap();
    });
    assert_eq!(counted.count_total, 0, "three thousand impacts and rest");
}

#[test]
fn steps_with_every_kind_of_guard() {
    let ball = Hybrid::new()
        .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8 - 0.1 * x[1] * x[1].abs()])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.9 * x[1]])
        .edge("flight", "flight", |_t, x| 100.0 - x[0] * x[0], |_t, x| *x);
    let simulation = Simulation::of(&ball);
    let counted = measure(|| {
        simulation.drive("flight", vector![1.0, 0.0], 0.0..3.0, &mut ()).unwrap();
        simulation.stepper(Dop853).drive("flight", vector![1.0, 0.0], 0.0..3.0, &mut ()).unwrap();
    });
    assert_eq!(counted.count_total, 0);
}

#[test]
fn series_make_room_once_for_a_run() {
    let ball = Hybrid::new()
        .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.8 - 0.1 * x[1] * x[1].abs()])
        .series("flight", |_t, [_, v]| [v, -9.8 - 0.1 * (v * v.abs())])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.9 * x[1]])
        .affine();
    let allocations = |jumps: usize| {
        let simulation = Simulation::of(&ball).most_jumps(jumps);
        let counted = measure(|| {
            simulation.drive("flight", vector![1.0, 0.0], 0.0..100.0, &mut ()).unwrap();
        });
        counted.count_total
    };
    assert_eq!(allocations(3), allocations(30));
}
