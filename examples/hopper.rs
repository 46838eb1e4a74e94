//! A vertical hopper: a mass on a springy leg, which loses nothing.
//!
//! `cargo run --example hopper` hops a thousand times and compares with the closed form.

use std::error::Error;

use saltus::{Hybrid, Simulation};
use saltus_examples::{Figure, gallery};

fn main() -> Result<(), Box<dyn Error>> {
    let (mass, stiffness, leg, g, start) = (80.0, 2e4, 1.0, 9.81, 1.2); // kg, N/m, m, m/s², m
    let fall = move |_t: f64, x: &[f64; 2]| [*x, [x[1], -g], [-0.5 * g, 0.0]].into();
    let hopper = Hybrid::new()
        .exact("fall", fall)
        .switch("fall", "stance", move |_t, x| x[0] - leg)
        .affine()
        .mode("stance", move |_t, x| [x[1], stiffness / mass * (leg - x[0]) - g])
        .switch("stance", "rise", move |_t, x| leg - x[0])
        .affine()
        .exact("rise", fall)
        .switch("rise", "fall", |_t, x| x[1])
        .affine();
    let run = Simulation::of(&hopper).tolerance(1e-13).run("fall", [start, 0.0], 0.0..650.0)?;

    let trajectory = &run.trajectory;
    let heights = |mode: &'static str| {
        (0..1280).map(move |k| f64::from(k) * 1e-3).map(move |t| {
            let in_mode = trajectory.mode_at(t).is_some_and(|m| (m == "stance") == (mode == "stance"));
            [t, trajectory.at(t).filter(|_| in_mode).map_or(f64::NAN, |x| x[0])]
        })
    };
    let picture = Figure::new("A vertical hopper", "time (s)", "height of the mass (m)")
        .line("in flight", heights("flight"))
        .line("on its leg", heights("stance"));
    gallery("hopper", &picture.svg())?;

    // A fall, a swing of the spring past its rest by v/ω and g/ω², a rise.
    let (touchdown, omega) = ((2.0 * (start - leg) / g).sqrt(), (stiffness / mass).sqrt());
    let stance = 2.0 / omega * (std::f64::consts::PI - (g * touchdown * omega / g).atan());
    let period = 2.0 * touchdown + stance;
    let apexes: Vec<_> = trajectory.jumps().iter().filter(|jump| jump.to == "fall").collect();
    let thousandth = apexes.get(999).ok_or("fewer than a thousand hops")?;
    println!(
        "hop 1000 after {:.12} s (exact {:.12}) to {:.12} m: see docs/program/gallery/hopper.svg",
        thousandth.t(),
        1000.0 * period,
        thousandth.after[0]
    );
    assert!((thousandth.t() / (1000.0 * period) - 1.0).abs() < 2e-11);
    assert!((thousandth.after[0] / start - 1.0).abs() < 2e-11);
    Ok(())
}
