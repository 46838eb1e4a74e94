//! What a guard's value may be off for rounding, as a mode is entered, is the same part of the
//! motion in every unit.

use saltus::nalgebra::{self, Vector2, vector};
use saltus::{Edge, ErrorKind, Hybrid, Simulation, Stop};

/// A ball that falls from one `unit` on a floor, whose reset leaves it `below` the floor by this
/// part of the fall.
fn bounces(unit: f64, below: f64) -> Result<usize, ErrorKind> {
    let floor = Edge::new(|_t, x: &Vector2<f64>| x[0], move |_t, x: &Vector2<f64>| vector![-below * unit, -0.8 * x[1]]);
    let flight = move |_t: f64, x: &Vector2<f64>| vector![x[1], -unit];
    let ball = Hybrid::new().mode("flight", flight).edge_with("flight", "flight", floor);
    let simulation = Simulation::of(&ball).absolute_tolerance(1e-12 * unit);
    match simulation.run("flight", vector![unit, 0.0], 0.0..6.0) {
        Ok(run) => {
            assert_eq!(run.end.stop, Stop::Time);
            Ok(run.trajectory.jumps().len())
        }
        Err(failed) => Err(failed.error.kind()),
    }
}

#[test]
fn a_reset_is_off_by_the_rounding_of_the_motion() {
    for unit in (-40..=40).map(|k| 10_f64.powi(k)) {
        // A fall of √2 s, and flights of 1.6 √2 s and 0.8 times that: three impacts in 6 s.
        assert_eq!(bounces(unit, 0.0), Ok(3), "{unit:e}");
        // A few units in the last place of the fall are rounding; a millionth of a millionth is
        // not.
        for roundings in [0.5, 1.0, 2.0, 4.0] {
            assert_eq!(bounces(unit, roundings * f64::EPSILON), Ok(3), "{unit:e}, {roundings} roundings");
        }
        for part in [1e-12, 1e-9, 1e-3] {
            assert_eq!(bounces(unit, part), Err(ErrorKind::Entry), "{unit:e}, {part:e} of the fall");
        }
    }
}

/// A start is stated to within the absolute tolerance.
#[test]
fn a_start_is_off_by_the_absolute_tolerance() {
    for unit in (-40..=40).map(|k| 10_f64.powi(k)) {
        let flight = move |_t: f64, x: &Vector2<f64>| vector![x[1], -unit];
        let floor = |_t: f64, x: &Vector2<f64>| vector![0.0, -0.8 * x[1]];
        let ball = Hybrid::new().mode("flight", flight).edge("flight", "flight", |_t, x: &Vector2<f64>| x[0], floor);
        let simulation = Simulation::of(&ball).absolute_tolerance(1e-12 * unit);
        let thrown = |below: f64| simulation.run("flight", vector![-below * unit, unit], 0.0..3.0);
        for below in [0.0, 1e-18, 1e-13, 1e-12] {
            let run = thrown(below).unwrap_or_else(|error| panic!("{unit:e}, {below:e}: {error}"));
            let first = run.trajectory.jumps()[0].t();
            assert!((first - 2.0).abs() < 1e-11, "{unit:e}, {below:e}: {first}");
        }
        assert!(thrown(1e-9).is_err(), "{unit:e}");
    }
}
