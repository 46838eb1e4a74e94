//! A block on a moving belt that sticks, is carried along, and slips back: why chalk squeaks.
//!
//! `cargo run --example stick_slip` compares a hundred cycles with the closed form.

use std::error::Error;

use saltus::nalgebra::{self, Vector2, vector};
use saltus::{Hybrid, Simulation};
use saltus_examples::gallery;
use saltus_plot::{Background, Phase};

fn main() -> Result<(), Box<dyn Error>> {
    // kg, N/m, m/s, and the friction that holds and that drags, in N.
    let (mass, spring, belt, holds, drags) = (1.0, 4.0, 0.25, 1.0, 0.6);
    let block = Hybrid::new()
        .mode("stick", move |_t, _x: &Vector2<f64>| vector![belt, 0.0])
        .switch("stick", "slip", move |_t, x| holds - spring * x[0])
        .affine()
        .mode("slip", move |_t, x| vector![x[1], (drags - spring * x[0]) / mass])
        .edge("slip", "stick", move |_t, x| belt - x[1], move |_t, x| vector![x[0], belt])
        .affine();
    let run = Simulation::of(&block).tolerance(1e-13).run("stick", vector![0.0, belt], 0.0..330.0)?;

    let trajectory = &run.trajectory;
    let picture = Phase::of(trajectory, "place", "velocity")
        .named(["place (m)", "velocity (m/s)"])
        .title("A block on a moving belt")
        .over(0.0..8.0)
        .background(Background::Adaptive);
    gallery("stick_slip", &picture.svg()?)?;

    // It slips about drags/spring, from where the spring beats the holding friction, until it has
    // the belt's velocity again.
    let omega: f64 = (spring / mass).sqrt();
    let reach = (holds - drags) / spring;
    let slip = 2.0 * (std::f64::consts::PI - (reach * omega / belt).atan()) / omega;
    let period = slip + 2.0 * reach / belt;
    let slips: Vec<f64> = trajectory.jumps().iter().filter(|jump| jump.to == "slip").map(|jump| jump.t()).collect();
    let hundredth = slips.get(99).ok_or("fewer than a hundred cycles")?;
    let exact = holds / spring / belt + 99.0 * period;
    println!("slip 100 at {hundredth:.12} s (exact {exact:.12}): see docs/program/gallery/stick_slip.svg");
    assert!((hundredth / exact - 1.0).abs() < 5e-12);
    Ok(())
}
