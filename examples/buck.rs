//! A buck converter with pulse-width modulation and a sampled controller, and a load that doubles.
//!
//! `cargo run --example buck` draws current, voltage and duty: see docs/program/gallery/buck.svg.

use std::error::Error;

use saltus::{Clock, Hybrid, Simulation, State};
use saltus_examples::gallery;
use saltus_plot::{Background, Panels};

/// Coil, capacitor, and what the controller holds from sample to sample.
#[derive(Clone, Copy, Debug, State)]
struct Buck {
    #[unit("A")]
    current: f64,
    #[unit("V")]
    voltage: f64,
    /// The part of a period in which the switch is closed.
    duty: f64,
    /// The time since the period began.
    #[unit("s")]
    ramp: f64,
}

const SOURCE: f64 = 12.0; // V
const WANTED: f64 = 5.0; // V
const INDUCTANCE: f64 = 200e-6; // H
const CAPACITY: f64 = 100e-6; // F
const PERIOD: f64 = 50e-6; // s
const STEP: f64 = 3e-3; // s, when the load doubles
const GAIN: f64 = 55.0; // 1/(V s), of the integral in the controller

fn flow(source: f64) -> impl Fn(f64, &Buck) -> Buck {
    move |t, x| {
        let load = if t < STEP { 4.0 } else { 2.0 }; // Ω
        let current = (source - x.voltage) / INDUCTANCE;
        Buck { current, voltage: (x.current - x.voltage / load) / CAPACITY, duty: 0.0, ramp: 1.0 }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // Each period the voltage is sampled, the duty moves by its error, and the switch closes.
    let sample = |_t: f64, x: &Buck| {
        let duty = (x.duty + GAIN * PERIOD * (WANTED - x.voltage)).clamp(0.0, 0.95);
        Buck { duty, ramp: 0.0, ..*x }
    };
    let converter = Hybrid::new()
        .mode("closed", flow(SOURCE))
        .mode("open", flow(0.0))
        .switch("closed", "open", |_t, x| x.duty * PERIOD - x.ramp)
        .affine()
        .clock("open", "closed", Clock::every(PERIOD), sample)
        .stops("closed", Clock::at([STEP]))
        .stops("open", Clock::at([STEP]));
    let start = Buck { current: 0.0, voltage: 0.0, duty: 0.3, ramp: 0.0 };
    let simulation = Simulation::of(&converter).tolerance(1e-12);
    let run = simulation.run("closed", start, 0.0..30e-3)?;

    let picture = Panels::of(&run.trajectory)
        .title("A buck converter")
        .caption("12 V to 5 V, switched at 20 kHz; the load doubles at 3 ms")
        .panel(["voltage"])
        .panel(["current"])
        .panel(["duty"])
        .over(0.0..6e-3)
        .background(Background::Adaptive);
    gallery("buck", &picture.svg()?)?;

    // An integral is at rest only where what it samples is what is wanted.
    let last = run.trajectory.jumps().iter().rfind(|jump| jump.to == "closed").ok_or("the switch never closes")?;
    println!("sampled at {:.3} ms: {:.12} V, duty {:.6}", 1e3 * last.t(), last.before.voltage, last.before.duty);
    assert!((last.before.voltage - WANTED).abs() < 1e-9);
    // So much more each period as the current rises while the switch is closed; the ripple of the
    // voltage is below a thousandth.
    let ripple = run.trajectory.jumps().iter().rfind(|jump| jump.to == "open").ok_or("the switch never opens")?;
    let rise = ripple.before.current - last.before.current;
    let exact = (SOURCE - WANTED) * last.after.duty * PERIOD / INDUCTANCE;
    assert!((rise / exact - 1.0).abs() < 5e-3, "{rise} {exact}");
    Ok(())
}
