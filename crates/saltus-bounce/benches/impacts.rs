//! What an impact costs: the ball through the public interface against the same recursion written by hand.
//!
//! `cargo bench -p saltus-bounce`; quote ratios of one run on one machine, not times.

#![allow(clippy::unwrap_used)] // a benchmark of a run that fails should stop

use std::hint::black_box;
use std::ops::ControlFlow;

use divan::Bencher;
use divan::counter::ItemsCount;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Hybrid, Jump, Observer, Polynomial, Simulation};
use saltus_bounce::{Ball, Cor, Mode};

const IMPACTS: usize = 1000;
const GRAVITY: f64 = 9.8;
const COR: f64 = 0.999;

fn main() {
    divan::main();
}

/// Keeps the time of the last impact.
struct Last(f64);

impl Observer<Ball> for Last {
    fn jump(&mut self, jump: &Jump<Ball>) -> ControlFlow<()> {
        self.0 = jump.t();
        ControlFlow::Continue(())
    }
}

/// One square root an impact: the speed from the height, the height from the speed.
#[divan::bench]
fn by_hand(bencher: Bencher) {
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| {
        let (mut t, mut height, g, e) = (0.0, black_box(1.0_f64), black_box(GRAVITY), black_box(COR));
        let mut rise = 0.0;
        for _ in 0..IMPACTS {
            let fall = (2.0 * height / g).sqrt();
            t += rise + fall;
            let speed = e * g * fall;
            height = speed * speed / (2.0 * g);
            rise = speed / g;
        }
        t
    });
}

#[divan::bench]
fn ball_observed(bencher: Bencher) {
    let ball = Ball::new(GRAVITY, Cor::new(COR).unwrap()).unwrap();
    let simulation = Simulation::of(&ball).most_jumps(IMPACTS);
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| {
        let mut last = Last(0.0);
        simulation.drive(Mode::Flight, black_box(vector![1.0, 0.0]), 0.0..1e6, &mut last).unwrap();
        last.0
    });
}

#[divan::bench]
fn ball_recorded(bencher: Bencher) {
    let ball = Ball::new(GRAVITY, Cor::new(COR).unwrap()).unwrap();
    let simulation = Simulation::of(&ball).most_jumps(IMPACTS);
    bencher
        .counter(ItemsCount::new(IMPACTS))
        .bench(|| simulation.run(Mode::Flight, black_box(vector![1.0, 0.0]), 0.0..1e6).unwrap());
}

/// The same ball from closures, solved exactly.
#[divan::bench]
fn closures_exact(bencher: Bencher) {
    let ball = closures().exact("flight", |_t, x: &Vector2<f64>| {
        Polynomial::from([*x, vector![x[1], -GRAVITY], vector![-0.5 * GRAVITY, 0.0]])
    });
    let ball = ball.affine("flight", "flight");
    let simulation = Simulation::of(&ball).most_jumps(IMPACTS);
    bencher
        .counter(ItemsCount::new(IMPACTS))
        .bench(|| simulation.drive("flight", black_box(vector![1.0, 0.0]), 0.0..1e6, &mut ()).unwrap());
}

/// The same ball from closures, stepped, its guard a function like any other.
#[divan::bench]
fn closures_stepped(bencher: Bencher) {
    let ball = closures();
    let simulation = Simulation::of(&ball).most_jumps(IMPACTS);
    bencher
        .counter(ItemsCount::new(IMPACTS))
        .bench(|| simulation.drive("flight", black_box(vector![1.0, 0.0]), 0.0..1e6, &mut ()).unwrap());
}

fn closures() -> Hybrid<'static, Vector2<f64>> {
    Hybrid::new().mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -GRAVITY]).edge(
        "flight",
        "flight",
        |_t, x| x[0],
        |_t, x| vector![0.0, -COR * x[1]],
    )
}
