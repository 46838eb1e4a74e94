//! What an impact costs: the ball through the public interface against the same recursion written
//! by hand.
//!
//! `cargo bench -p saltus-bounce`; quote ratios of one run on one machine, not times.

#![allow(clippy::unwrap_used)] // a benchmark of a run that fails should stop

use std::hint::black_box;
use std::ops::ControlFlow;

use divan::Bencher;
use divan::counter::ItemsCount;
use saltus::nalgebra::{Vector2, vector};
use saltus::{Automaton, Hybrid, JumpOf, Observer, Polynomial, Simulation};
use saltus_bounce::effects::{Gravity, QuadraticDrag};
use saltus_bounce::flight::{LinearDragFlight, QuadraticDragFlight, VerticalFlight};
use saltus_bounce::walls::Plane;
use saltus_bounce::{Ball, Cor, Flyer, Live, Mode, Moving, Phase, Stance};

const IMPACTS: usize = 1000;
const GRAVITY: f64 = 9.8;
const COR: f64 = 0.999;

fn main() {
    divan::main();
}

/// Keeps the time of the last impact.
struct Last(f64);

impl<A: Automaton> Observer<A> for Last {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
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
    let ball = ball.affine();
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

const DRAG: f64 = 0.1;

/// Flight after flight from its formula.
fn flights_by_hand(flight: &impl VerticalFlight) -> f64 {
    let (mut t, mut start) = (0.0, black_box(vector![1.0, 0.0]));
    for _ in 0..IMPACTS {
        let Some(impact) = flight.impact(&start) else { return t };
        t += impact.time;
        start = vector![0.0, COR * impact.speed];
    }
    t
}

#[divan::bench]
fn linear_drag_by_hand(bencher: Bencher) {
    let flight = LinearDragFlight::new(GRAVITY, DRAG).unwrap();
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| flights_by_hand(black_box(&flight)));
}

#[divan::bench]
fn linear_drag(bencher: Bencher) {
    let ball = Ball::of(LinearDragFlight::new(GRAVITY, DRAG).unwrap(), Cor::new(COR).unwrap());
    let simulation = Simulation::of(&ball).most_jumps(IMPACTS);
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| {
        let mut last = Last(0.0);
        simulation.drive(Mode::Flight, black_box(vector![1.0, 0.0]), 0.0..1e6, &mut last).unwrap();
        last.0
    });
}

#[divan::bench]
fn quadratic_drag_by_hand(bencher: Bencher) {
    let flight = QuadraticDragFlight::new(GRAVITY, DRAG).unwrap();
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| flights_by_hand(black_box(&flight)));
}

/// Two jumps an impact: the apex and the floor.
#[divan::bench]
fn quadratic_drag(bencher: Bencher) {
    let ball = Ball::of(QuadraticDragFlight::new(GRAVITY, DRAG).unwrap(), Cor::new(COR).unwrap());
    let simulation = Simulation::of(&ball).most_jumps(2 * IMPACTS);
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| {
        let mut last = Last(0.0);
        simulation.drive(Phase::Falling, black_box(vector![1.0, 0.0]), 0.0..1e6, &mut last).unwrap();
        last.0
    });
}

#[divan::bench]
fn planar_gravity(bencher: Bencher) {
    let floor = Plane::floor(0.0).unwrap();
    let ball = Flyer::new(Gravity::new(GRAVITY).unwrap(), floor, Cor::new(COR).unwrap()).unwrap();
    let simulation = Simulation::of(&ball).most_jumps(IMPACTS);
    bencher.counter(ItemsCount::new(IMPACTS)).bench(|| {
        let mut last = Last(0.0);
        let start = Moving::new(black_box(vector![0.0, 1.0]), vector![1.0, 0.0]);
        simulation.drive(Stance::FLIGHT, start, 0.0..1e6, &mut last).unwrap();
        last.0
    });
}

#[divan::bench]
fn planar_drag_by_steps(bencher: Bencher) {
    let effects = (Gravity::new(GRAVITY).unwrap(), QuadraticDrag::new(DRAG).unwrap());
    let ball = Flyer::new(effects, Plane::floor(0.0).unwrap(), Cor::new(COR).unwrap()).unwrap();
    let simulation = Simulation::of(&ball).most_jumps(100);
    bencher.counter(ItemsCount::new(100_usize)).bench(|| {
        let mut last = Last(0.0);
        let start = Moving::new(black_box(vector![0.0, 1.0]), vector![1.0, 0.0]);
        simulation.drive(Stance::FLIGHT, start, 0.0..1e6, &mut last).unwrap();
        last.0
    });
}

/// A second of sixty frames, an item being one ball and frame.
#[divan::bench]
fn frames_of_gravity(bencher: Bencher) {
    let ball = Ball::new(GRAVITY, Cor::new(0.8).unwrap()).unwrap();
    let simulation = Simulation::of(&ball);
    bencher
        .counter(ItemsCount::new(60_usize))
        .with_inputs(|| Live::start(&ball, simulation, Mode::Flight, vector![1.0, 0.0], 0.0..60.0).unwrap())
        .bench_values(|mut live| {
            let mut height = 0.0;
            for _ in 0..60 {
                height += live.advance(1.0 / 60.0, |_| {}).unwrap().state[0];
            }
            height
        });
}

#[divan::bench]
fn frames_of_planar_drag(bencher: Bencher) {
    let effects = (Gravity::new(GRAVITY).unwrap(), QuadraticDrag::new(DRAG).unwrap());
    let ball = Flyer::new(effects, Plane::floor(0.0).unwrap(), Cor::new(0.8).unwrap()).unwrap();
    let simulation = Simulation::of(&ball);
    let start = Moving::new(vector![0.0, 1.0], vector![1.0, 0.0]);
    bencher
        .counter(ItemsCount::new(60_usize))
        .with_inputs(|| Live::start(&ball, simulation, Stance::FLIGHT, start, 0.0..60.0).unwrap())
        .bench_values(|mut live| {
            let mut height = 0.0;
            for _ in 0..60 {
                height += live.advance(1.0 / 60.0, |_| {}).unwrap().state.position[1];
            }
            height
        });
}
