//! A ball from closures: three lines of physics, a picture, and a check against the closed form.
//!
//! `cargo run --example bounce` writes `bounce.svg`.

use std::error::Error;

use saltus::nalgebra::{self, Vector2, vector};
use saltus::{Hybrid, Simulation};
use saltus_bounce::{Cor, Drop};
use saltus_plot::{HeightTime, Stroke};

fn main() -> Result<(), Box<dyn Error>> {
    let (height, gravity, cor) = (1.0, 9.81, Cor::new(0.7)?);

    let ball = Hybrid::new()
        .mode("flight", move |_t, x: &Vector2<f64>| vector![x[1], -gravity])
        .edge("flight", "flight", |_t, x| x[0], move |_t, x| vector![0.0, -cor.value() * x[1]])
        .mode("rest", |_t, _x| vector![0.0, 0.0])
        .beyond("flight", "rest", |_t, _x| vector![0.0, 0.0]);
    let run = Simulation::of(&ball).run("flight", vector![height, 0.0], 0.0..3.0)?;

    let trajectory = &run.trajectory;
    let arcs = (0..trajectory.arcs().len()).flat_map(|arc| trajectory.pieces(arc)).map(|piece| {
        // A piece is a polynomial in (t - start)/scale; the picture wants one in seconds.
        let mut unit = 1.0;
        let heights = piece.coefficients().iter().map(|c| {
            let height = c[0] / unit;
            unit *= piece.scale();
            height
        });
        Stroke::over_time(piece.start().seconds(), piece.span(), heights.collect())
    });
    let impacts: Vec<f64> = trajectory.jumps().iter().filter(|jump| jump.to == "flight").map(|jump| jump.t()).collect();
    let picture =
        HeightTime::new("A ball that keeps 0.7 of its speed").motion("", arcs).contacts(impacts.iter().copied());
    std::fs::write("bounce.svg", picture.svg()?)?;

    let exact = Drop::new(height, gravity, cor);
    let worst = (1_u32..).zip(&impacts).map(|(n, t)| (t - exact.impact_time(n)).abs()).fold(0.0, f64::max);
    let rest = trajectory.jumps().last().map_or(0.0, |jump| jump.t());
    println!("{} impacts, none more than {worst:.1e} s off; at rest after {rest:.6} s: see bounce.svg", impacts.len());
    assert!(worst < 1e-12 && run.end.mode == "rest");
    Ok(())
}
