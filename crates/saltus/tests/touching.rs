//! Bodies that touch each other and lie still but for rounding, which moves them by 1e-17 and lets
//! them collide without end or order.

#![allow(clippy::unwrap_used)] // in what the tests share

use std::f64::consts::PI;

use saltus::nalgebra::SVector;
use saltus::{Hybrid, Simulation, Stop};
use saltus_instances as _;

/// Displacements of five balls that hang side by side, in ball diameters, then their velocities.
type Balls = SVector<f64, 10>;

#[test]
fn a_cradle_swings_on_whatever_its_start() {
    let swing = |_t: f64, x: &Balls| Balls::from_fn(|i, _| if i < 5 { x[i + 5] } else { -x[i - 5] });
    let cradle = (0..4).fold(Hybrid::new().mode("hang", swing), |cradle, left: usize| {
        let gap = move |_t: f64, x: &Balls| x[left + 1] - x[left];
        cradle
            .edge("hang", "hang", gap, move |_t, x| {
                let mut after = *x;
                after.swap_rows(left + 5, left + 6);
                after
            })
            .affine()
    });
    for k in 0..200 {
        let mut start = Balls::zeros();
        start[0] = -1.5 + 0.005 * f64::from(k);
        let tolerance = [1e-8, 1e-10, 1e-12, 1e-13][k as usize % 4];
        let run = Simulation::of(&cradle).tolerance(tolerance).run("hang", start, 0.0..4.0 * PI).unwrap();
        assert_eq!(run.end.stop, Stop::Time, "from {}", start[0]);
        assert!((run.end.state - start).norm() < 1e-5, "from {}: {}", start[0], run.end.state);
    }
}
