//! Two tanks and one hose: the textbook's Zeno automaton (R. Alur, T. Henzinger, CONCUR 1997).
//!
//! `cargo run --example tanks`: less comes in than runs out, so that the hose must be moved ever
//! faster.

use std::error::Error;

use saltus::{Hybrid, Simulation, Stop};
use saltus_examples::{Figure, gallery};

fn main() -> Result<(), Box<dyn Error>> {
    let (inflow, leaks) = (1.0, [0.6, 0.7]); // L/s
    let tanks = Hybrid::new()
        .exact("first", move |_t, x: &[f64; 2]| [*x, [inflow - leaks[0], -leaks[1]]].into())
        .exact("second", move |_t, x| [*x, [-leaks[0], inflow - leaks[1]]].into())
        .switch("first", "second", |_t, x| x[1])
        .affine()
        .switch("second", "first", |_t, x| x[0])
        .affine();
    let run = Simulation::of(&tanks).run("first", [1.0, 1.0], 0.0..8.0)?;

    // The levels are straight between the jumps.
    let trajectory = &run.trajectory;
    let level = |tank: usize| {
        let start = trajectory.arcs()[0].state();
        let corners = trajectory.jumps().iter().map(move |jump| [jump.t(), jump.before[tank]]);
        [[0.0, start[tank]]].into_iter().chain(corners)
    };
    let picture = Figure::new("Two tanks and one hose", "time (s)", "level (L)")
        .line("first tank", level(0))
        .line("second tank", level(1));
    gallery("tanks", &picture.svg())?;

    let exact = 2.0 / (leaks[0] + leaks[1] - inflow);
    let Stop::Zeno { limit } = run.end.stop else { return Err(format!("no limit: {}", run.end.stop).into()) };
    println!(
        "{} moves until {limit:.14} s (exact {exact:.14}): see docs/program/gallery/tanks.svg",
        run.end.stats.jumps
    );
    assert!((limit / exact - 1.0).abs() < 4e-14 && run.end.state.iter().all(|x| x.abs() < 1e-12));
    Ok(())
}
