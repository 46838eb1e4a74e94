//! A thermostat: heat until 21 °C, wait until 19 °C.
//!
//! `cargo run --example thermostat` switches a hundred thousand times and compares with the closed
//! form.

use std::error::Error;

use saltus::{Hybrid, Simulation};
use saltus_examples::gallery;
use saltus_plot::{Background, Panels};

fn main() -> Result<(), Box<dyn Error>> {
    // The room loses heat at this rate (1/h) to the outside; the heater gives 5 °C an hour.
    let (loss, outside, heater, low, high) = (0.1, 10.0, 5.0, 19.0, 21.0);
    let room = Hybrid::new()
        .mode("heats", move |_t, x: &f64| heater - loss * (x - outside))
        .mode("waits", move |_t, x| -loss * (x - outside))
        .switch("heats", "waits", move |_t, x| high - x)
        .affine()
        .switch("waits", "heats", move |_t, x| x - low)
        .affine();
    let run = Simulation::of(&room).tolerance(1e-13).run("heats", 20.0, 0.0..1.26e5)?;

    let trajectory = &run.trajectory;
    let picture = Panels::of(trajectory)
        .named(["temperature (°C)"])
        .title("A thermostat")
        .over(0.0..12.0)
        .time("h")
        .background(Background::Adaptive);
    gallery("thermostat", &picture.svg()?)?;

    // Between two temperatures the room takes the logarithm of the ratio of their distances from
    // where it tends.
    let tends = outside + heater / loss;
    let time = |from: f64, to: f64, limit: f64| ((from - limit) / (to - limit)).ln() / loss;
    let period = time(high, low, outside) + time(low, high, tends);
    let exact = time(20.0, high, tends) + 50_000.0 * period;
    let switch = trajectory.jumps().get(100_000).ok_or("too few switches")?;
    println!("switch 100 001 after {:.9} h (exact {exact:.9}): see docs/program/gallery/thermostat.svg", switch.t());
    assert!((switch.t() / exact - 1.0).abs() < 2e-11);
    Ok(())
}
