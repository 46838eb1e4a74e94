//! A billiard that counts the digits of π (G. Galperin, Regular and Chaotic Dynamics 8 (2003) 375).
//!
//! `cargo run --example pi`: a heavy block pushes a light one against a wall. With 100ⁿ times the
//! mass there are ⌊10ⁿ π⌋ collisions.

use std::error::Error;

use saltus::{Hybrid, RunOf, Simulation};
use saltus_examples::{Figure, gallery};

/// Where the small block is, how far the big one is from it, and the velocities of both.
type Blocks = [f64; 4];

fn blocks(mass: f64) -> Hybrid<'static, Blocks> {
    Hybrid::new()
        .exact("slide", |_t, x: &Blocks| [*x, [x[2], x[3] - x[2], 0.0, 0.0]].into())
        .edge(
            "slide",
            "slide",
            |_t, x| x[1],
            move |_t, &[place, gap, small, big]| {
                let pull = 2.0 * (big - small) / (1.0 + mass);
                [place, gap, small + mass * pull, big - pull]
            },
        )
        .affine()
        .edge("slide", "slide", |_t, x| x[0], |_t, &[place, gap, small, big]| [place, gap, -small, big])
        .affine()
}

fn collide(blocks: &Hybrid<'static, Blocks>) -> Result<RunOf<Hybrid<'static, Blocks>>, saltus::Error> {
    Ok(Simulation::of(blocks).run("slide", [1.0, 1.0, 0.0, -1.0], 0.0..1e4)?)
}

fn main() -> Result<(), Box<dyn Error>> {
    // Energy is a circle in the velocities √M V and v; each collision is a chord between two of its
    // points.
    let hundred = blocks(100.0);
    let run = collide(&hundred)?;
    let states = run.trajectory.arcs().iter().map(|arc| *arc.state());
    let chords = states.map(|[_, _, small, big]| [big, small / 10.0]);
    let circle = (0..=180).map(|k| (f64::from(k) * 2.0_f64.to_radians()).sin_cos()).map(|(y, x)| [x, y]);
    let picture = Figure::new(
        "31 collisions: the first two digits of π",
        "velocity of the block of mass 100",
        "velocity of the block of mass 1, by 10",
    )
    .line("collisions", chords)
    .line("energy", circle)
    .equal();
    gallery("pi", &picture.svg())?;

    let mut counts = Vec::new();
    for digits in 0..=4 {
        let pair = blocks(100_f64.powi(digits));
        counts.push(collide(&pair)?.end.stats.jumps);
    }
    println!("{counts:?} collisions: see docs/program/gallery/pi.svg");
    assert_eq!(counts, [3, 31, 314, 3141, 31415]);
    Ok(())
}
