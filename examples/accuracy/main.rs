//! What accuracy costs: work–precision of seven systems, each against its closed form, a published
//! value, or a tighter run.
//!
//! `cargo run --release --example accuracy` measures and rewrites the tables of
//! `docs/trust/accuracy.md` and its pictures.

mod dragged;
mod page;
mod systems;

use std::error::Error;
use std::process::Command;

use saltus::{Automaton, RunOf, Simulation, WorkPrecision};

use page::Section;

/// The tolerances tried.
const TOLERANCES: [f64; 11] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13];

/// Measures a method at every tolerance. One that breaks off is left out: it has no error to show.
fn sweep<A, Q, M>(work: &mut WorkPrecision<A, Q>, name: &str, simulation: Simulation<'_, A, M>)
where
    A: Automaton,
    Q: Fn(&RunOf<A>) -> Vec<f64>,
    M: saltus::step::Stepper,
{
    for tolerance in TOLERANCES {
        let _ = work.measure(name, &simulation.tolerance(tolerance));
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let sections: Vec<Section> = vec![
        systems::ball()?,
        systems::drag()?,
        systems::contact()?,
        systems::hopper()?,
        systems::table()?,
        systems::arenstorf()?,
        systems::van_der_pol()?,
    ];
    for section in &sections {
        section.draw()?;
    }
    page::rewrite(&sections, &machine())?;
    println!("docs/trust/accuracy.md and {} pictures are written", sections.len());
    Ok(())
}

/// What it was measured on, and with.
fn machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu.lines().find_map(|line| line.strip_prefix("model name").and_then(|rest| rest.split_once(": ")));
    let cores = std::thread::available_parallelism().map_or(0, std::num::NonZero::get);
    let rustc = Command::new("rustc").arg("--version").output().ok();
    let rustc = rustc.and_then(|output| String::from_utf8(output.stdout).ok()).unwrap_or_default();
    format!(
        "{}, {cores} cores; {}; saltus {}",
        model.map_or("an unknown processor", |(_, model)| model.trim()),
        rustc.trim(),
        env!("CARGO_PKG_VERSION")
    )
}
