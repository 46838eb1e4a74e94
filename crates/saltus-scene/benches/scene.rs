//! What a scene costs over the same motion composed by hand, its plan and its run, both recorded;
//! and what a flock costs over a cloud.
//!
//! `cargo bench -p saltus-scene --bench scene`; quote ratios of one run on one machine, not times.

#![allow(clippy::unwrap_used)] // a benchmark of a run that fails should stop

use std::hint::black_box;

use divan::Bencher;
use saltus::Simulation;
use saltus::nalgebra::vector;
use saltus_bounce::{Ball, Cor, Mode};
use saltus_scene::Scene;
use saltus_scene::plan::Model;

const UNTIL: f64 = 10.0;

fn main() {
    divan::main();
}

/// Some fifty impacts, the limit of them, and rest.
fn bouncing() -> Scene {
    scene("gravity = 9.8\nrestitution = 0.55\nball = { height = 1 }\nrun = { until = 10 }\n")
}

/// A thousand impacts.
fn lively() -> Scene {
    scene("gravity = 9.8\nrestitution = 0.999\nball = { height = 1 }\nrun = { until = 10000, most_jumps = 1000 }\n")
}

fn scene(toml: &str) -> Scene {
    Scene::parse("bench", toml.as_bytes()).unwrap()
}

#[divan::bench]
fn bouncing_by_hand(bencher: Bencher) {
    bencher.bench(|| {
        let ball = Ball::new(black_box(9.8), Cor::new(black_box(0.55)).unwrap()).unwrap();
        Simulation::of(&ball).run(Mode::Flight, black_box(vector![1.0, 0.0]), 0.0..UNTIL).unwrap()
    });
}

#[divan::bench]
fn bouncing_by_scene(bencher: Bencher) {
    let scene = bouncing();
    bencher.bench(|| black_box(&scene).plan().unwrap().run().unwrap());
}

/// The plan alone, with its explanation.
#[divan::bench]
fn bouncing_planned(bencher: Bencher) {
    let scene = bouncing();
    bencher.bench(|| black_box(&scene).plan().unwrap());
}

/// A plan is made once and run as often as is wanted.
#[divan::bench]
fn bouncing_by_plan(bencher: Bencher) {
    let plan = bouncing().plan().unwrap();
    bencher.bench(|| black_box(&plan).run().unwrap());
}

/// Five smooth balls in a box, without loss: a cloud. A spin of one of them makes them a flock, of
/// the same motion.
fn balls(spin: &str) -> Scene {
    let ball = |n: u32| {
        let x = 0.16 * f64::from(n) - 0.32;
        let (up, across) = (0.1 + 0.05 * f64::from(n), 0.5 - 0.2 * f64::from(n));
        format!("[[ball]]\nradius = 0.02\nmass = 0.03\nposition = [{x}, 0, {up}]\nvelocity = [{across}, 0.3, 0.1]\n")
    };
    let balls: String = (0..5).map(ball).collect();
    scene(&format!(
        "restitution = 1\nfloor = {{ kind = 'box', size = [1, 1, 1] }}\nrun = {{ until = 1e9, most_jumps = 1000 }}\n{balls}{spin}"
    ))
}

#[divan::bench]
fn balls_by_cloud(bencher: Bencher) {
    let plan = balls("").plan().unwrap();
    assert_eq!(plan.explain().model, Model::Cloud);
    bencher.bench(|| black_box(&plan).run().unwrap());
}

#[divan::bench]
fn balls_by_flock(bencher: Bencher) {
    let plan = balls("spin = [0, 0, 0]\n").plan().unwrap();
    assert_eq!(plan.explain().model, Model::Flock);
    bencher.bench(|| black_box(&plan).run().unwrap());
}

#[divan::bench]
fn lively_by_hand(bencher: Bencher) {
    bencher.bench(|| {
        let ball = Ball::new(black_box(9.8), Cor::new(black_box(0.999)).unwrap()).unwrap();
        let simulation = Simulation::of(&ball).most_jumps(1000);
        simulation.run(Mode::Flight, black_box(vector![1.0, 0.0]), 0.0..1e4).unwrap()
    });
}

#[divan::bench]
fn lively_by_scene(bencher: Bencher) {
    let scene = lively();
    bencher.bench(|| black_box(&scene).plan().unwrap().run().unwrap());
}
