//! The loop does not allocate: not for a step, not for a crossing, not for a jump.
//!
//! Counting allocations takes an allocator of our own, and that takes `unsafe`; so they are counted
//! by a library.

use allocation_counter::measure;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Auto, Dop853, Hybrid, Simulation, State, Tsit5, Vector};
use saltus_bounce::{Ball, Cor, Mode};

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

/// A vector that is dropped leaves its memory to the next one: after a first run, which makes room,
/// no step, no crossing and no jump allocates.
#[test]
fn a_step_of_any_length_allocates_nothing() {
    let n = 100;
    let tanks = Hybrid::new()
        .mode("drain", |_t, x: &Vector| x.with(|i| -x[i] / (1.0 + i as f64)))
        .edge("drain", "drain", |_t, x| x[0] - 0.1, |_t, x| x.with(|i| if i == 0 { 1.0 } else { x[i] }))
        .affine()
        .edge("drain", "drain", |_t, x| x[1] * x[1] - 0.01, |_t, x| x.with(|i| if i == 1 { 1.0 } else { x[i] }));
    for method in [Auto::new(), Tsit5.into(), Dop853.into()] {
        let simulation = Simulation::of(&tanks).stepper(method);
        let start = Vector::from(vec![1.0; n]);
        let run = || simulation.drive("drain", start.clone(), 0.0..20.0, &mut ()).unwrap();
        assert!(run().jumps > 10 && run().jumps > 10);
        let counted = measure(|| drop(run()));
        assert_eq!(counted.count_total, 0, "{method:?}");
    }
}

/// Of a recording that is dropped a few vectors are kept, whatever it held.
#[test]
fn what_is_dropped_is_given_back() {
    let n = 1000;
    let still = |list: Vec<Vector>| drop(list);
    let counted = measure(|| still((0..1000).map(|_| Vector::from_fn(n, |_| 1.0)).collect()));
    let kept = counted.bytes_current / (8 * n as i64);
    assert!((0..=200).contains(&kept), "{kept} vectors of {n} coordinates are kept");
}
