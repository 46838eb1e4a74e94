//! What a tick costs beside a jump at the same time, and what a stop costs beside a step.
//!
//! `cargo bench -p saltus --bench clocks`; quote ratios of one run on one machine, not times. Times
//! are per tick, jump or stop.

#![allow(clippy::unwrap_used)] // a benchmark of a run that fails should stop

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use saltus::{Clock, Hybrid, Signal, Simulation};

const COUNT: u32 = 1000;

fn main() {
    divan::main();
}

/// A tank that fills at a rate of one and a counter of how often it was emptied.
fn tank<'a>() -> Hybrid<'a, [f64; 2]> {
    Hybrid::new().mode("fill", |_t, _x: &[f64; 2]| [1.0, 0.0])
}

fn empty(_: f64, x: &[f64; 2]) -> [f64; 2] {
    [0.0, x[1] + 1.0]
}

fn run(bencher: Bencher, model: &Hybrid<'_, [f64; 2]>, items: u32) {
    let simulation = Simulation::of(model);
    let end = f64::from(COUNT) + 0.5;
    bencher
        .counter(ItemsCount::new(items))
        .bench(|| simulation.drive("fill", black_box([0.0, 0.0]), 0.0..end, &mut ()).unwrap());
}

/// Emptied when it is full, beside edges that are never taken; their guards are functions like any
/// other.
#[divan::bench(args = [1, 4, 16])]
fn jump_by_a_guard(bencher: Bencher, edges: u32) {
    let full = |k: u32| move |_: f64, x: &[f64; 2]| f64::from(k) - x[0];
    let model = (1..=edges).fold(tank(), |tank, k| tank.edge("fill", "fill", full(k), empty));
    run(bencher, &model, COUNT);
}

/// The same, their guards promised affine.
#[divan::bench(args = [1, 4, 16])]
fn jump_by_a_promised_guard(bencher: Bencher, edges: u32) {
    let full = |k: u32| move |_: f64, x: &[f64; 2]| f64::from(k) - x[0];
    let model = (1..=edges).fold(tank(), |tank, k| tank.edge("fill", "fill", full(k), empty).affine());
    run(bencher, &model, COUNT);
}

/// Emptied at each tick of one clock, beside clocks that hardly ever tick.
#[divan::bench(args = [1, 4, 16])]
fn tick(bencher: Bencher, clocks: u32) {
    let rare = |k: u32| f64::from((k - 1) * COUNT).max(1.0);
    let model = (1..=clocks).fold(tank(), |tank, k| tank.clock("fill", "fill", Clock::every(rare(k)), empty));
    run(bencher, &model, COUNT);
}

/// At each tick of several clocks that tick together.
#[divan::bench(args = [4, 16, 64])]
fn tick_together(bencher: Bencher, clocks: u32) {
    let model = (0..clocks).fold(tank(), |tank, _| tank.clock("fill", "fill", Clock::every(1.0), empty));
    run(bencher, &model, COUNT * clocks);
}

/// Steps of the same length, without stops.
#[divan::bench]
fn step(bencher: Bencher) {
    let model = tank();
    let simulation = Simulation::of(&model).longest_step(1.0);
    bencher
        .counter(ItemsCount::new(COUNT))
        .bench(|| simulation.drive("fill", black_box([0.0, 0.0]), 0.0..f64::from(COUNT), &mut ()).unwrap());
}

/// Steps that end at stops.
#[divan::bench]
fn stop(bencher: Bencher) {
    run(bencher, &tank().stops("fill", Clock::every(1.0)), COUNT);
}

/// The inflow from a table of a sample a second, whose knots are stops.
#[divan::bench]
fn knot(bencher: Bencher) {
    let inflow = Signal::linear((0..=COUNT).map(|k| (f64::from(k), f64::from(k % 7)))).unwrap();
    let model = Hybrid::new().mode("fill", |t, _x: &[f64; 2]| [inflow.at(t), 0.0]).stops("fill", inflow.stops());
    run(bencher, &model, COUNT);
}
