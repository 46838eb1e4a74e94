//! Newton's cradle: five balls that hang side by side and touch.
//!
//! `cargo run --example cradle`: at each impact the velocity passes from ball to ball, four jumps
//! at one time.

use std::error::Error;
use std::f64::consts::{PI, TAU};

use saltus::nalgebra::SVector;
use saltus::{Hybrid, Simulation};
use saltus_examples::{Figure, gallery};

/// Displacements of the five balls, in ball diameters, then their velocities; time in units that
/// give a swing 2π.
type Balls = SVector<f64, 10>;

fn main() -> Result<(), Box<dyn Error>> {
    let swing = |_t: f64, x: &Balls| Balls::from_fn(|i, _| if i < 5 { x[i + 5] } else { -x[i - 5] });
    let cradle = (0..4).fold(Hybrid::new().mode("hang", swing), |cradle, left: usize| {
        let gap = move |_t: f64, x: &Balls| x[left + 1] - x[left];
        // Equal balls that lose nothing exchange their velocities.
        cradle
            .edge("hang", "hang", gap, move |_t, x| {
                let mut after = *x;
                after.swap_rows(left + 5, left + 6);
                after
            })
            .affine()
    });
    let mut start = Balls::zeros();
    start[0] = -1.5;
    let run = Simulation::of(&cradle).tolerance(1e-12).run("hang", start, 0.0..4.0 * PI)?;

    let ball = |i: usize| {
        let trajectory = &run.trajectory;
        (0..=600)
            .map(move |k| f64::from(k) * TAU / 300.0)
            .filter_map(move |t| Some([t / TAU, trajectory.at(t)?[i] + i as f64]))
    };
    let picture = (0..5)
        .fold(Figure::new("Newton's cradle", "time (swings)", "place (ball diameters)"), |picture, i| {
            picture.line(&format!("ball {}", i + 1), ball(i))
        });
    gallery("cradle", &picture.svg())?;

    // After a quarter of a swing the first ball hits at velocity 1.5, and the last leaves with it.
    let first = run.trajectory.jumps().get(..4).ok_or("too few jumps")?;
    let after = first[3].after;
    println!(
        "four jumps at t = {:.12}, velocities {:?}: see docs/program/gallery/cradle.svg",
        first[0].t(),
        &after.as_slice()[5..]
    );
    assert!(first.iter().all(|jump| jump.t() == first[0].t() && (jump.t() - 0.5 * PI).abs() < 1e-12));
    assert!(after.rows(5, 4).iter().all(|v| *v == 0.0) && (after[9] - 1.5).abs() < 1e-12);
    Ok(())
}
