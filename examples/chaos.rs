//! A ball on a vibrating table: order, period doubling, chaos.
//!
//! `cargo run --release --example chaos` draws the attractors of 1000 tables, from 1000 impacts on
//! each.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use rayon::prelude::*;
use saltus::nalgebra::{self, Vector2, vector};
use saltus::{About, Automaton, Edges, Entry, JumpOf, Limit, Observer, Refusal, Simulation, Solution};
use saltus_examples::{Figure, gallery};

const G: f64 = 9.81; // m/s²
const OMEGA: f64 = 50.0; // rad/s
const COR: f64 = 0.8;
const SLOW: f64 = 1e-5; // m/s; after a slower rebound the ball rides on the table

/// A table that moves as A sin(ω t), and a ball.
struct Table {
    amplitude: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Ball {
    Flies,
    Rides, // until the table falls away faster than the ball would
}

impl Table {
    fn place(&self, t: f64) -> f64 {
        self.amplitude * (OMEGA * t).sin()
    }
    fn speed(&self, t: f64) -> f64 {
        self.amplitude * OMEGA * (OMEGA * t).cos()
    }
}

impl Automaton for Table {
    type Mode = Ball;
    type State = Vector2<f64>;
    type Edge = Ball; // the mode that is left

    fn flow(&self, ball: Ball, t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        vector![x[1], if ball == Ball::Flies { -G } else { -OMEGA * OMEGA * self.place(t) }]
    }
    fn solution(&self, ball: Ball, _t: f64, x: &Vector2<f64>) -> Solution<Self> {
        match ball {
            Ball::Flies => Solution::Polynomial([*x, vector![x[1], -G], vector![-0.5 * G, 0.0]].into()),
            Ball::Rides => Solution::Steps,
        }
    }
    fn edges(&self, ball: Ball) -> Edges<'_, Ball> {
        Edges::from([ball])
    }
    fn guard(&self, ball: Ball, t: f64, x: &Vector2<f64>) -> f64 {
        if ball == Ball::Flies { x[0] - self.place(t) } else { G - OMEGA * OMEGA * self.place(t) }
    }
    fn reset(&self, _: Ball, ball: Ball, t: f64, x: &Vector2<f64>) -> Result<(Ball, Vector2<f64>), Refusal> {
        let rebound = COR * (self.speed(t) - x[1]);
        Ok(match ball {
            Ball::Flies if rebound > SLOW => (Ball::Flies, vector![x[0], self.speed(t) + rebound]),
            Ball::Flies => (Ball::Rides, vector![self.place(t), self.speed(t)]),
            Ball::Rides => (Ball::Flies, *x),
        })
    }
    #[inline]
    fn about(&self, _: Ball) -> About {
        About::new().entry(Entry::Fire)
    }
    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Ball, Vector2<f64>)> {
        Some((Ball::Rides, vector![self.place(limit.t), self.speed(limit.t)]))
    }
}

/// Notes the phases of the table, from -1/4 to 3/4, at the impacts after the first `skip`.
struct Phases {
    skip: usize,
    found: Vec<f64>,
}

impl Observer<Table> for Phases {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<Table>) -> ControlFlow<()> {
        if jump.j > self.skip && jump.from == Ball::Flies {
            self.found.push((jump.t() * OMEGA / TAU + 0.25).rem_euclid(1.0) - 0.25);
        }
        ControlFlow::Continue(())
    }
}

fn attractor(strength: f64) -> Result<Vec<[f64; 2]>, saltus::Error> {
    let mut phases = Phases { skip: 700, found: Vec::new() };
    // Thrown up at 0.6 m/s, for about one period of the table. The guard varies with the table,
    // faster than a flight does.
    let table = Table { amplitude: strength * G / (OMEGA * OMEGA) };
    let simulation = Simulation::of(&table).longest_step(0.25 * TAU / OMEGA).most_jumps(1000);
    let end = simulation.drive(Ball::Flies, vector![0.0, 0.6], 0.0..1e3, &mut phases)?;
    assert!(end.jumps >= 1000, "the ball is lost at {strength}");
    Ok(phases.found.into_iter().map(|phase| [strength, phase]).collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let strengths: Vec<f64> = (0..1000).map(|k| 0.95 + 5e-4 * f64::from(k)).collect();
    let began = std::time::Instant::now();
    let attractors = strengths.par_iter().map(|&strength| attractor(strength)).collect::<Result<Vec<_>, _>>()?;
    let picture =
        Figure::new("A ball on a vibrating table", "acceleration of the table, Aω²/g", "phase of the impact, of 1")
            .cloud("", attractors.concat())
            .across(0.95, 1.45)
            .up(-0.25, 0.75);
    gallery("chaos", &picture.svg())?;

    // Until its period doubles, the ball is hit once in each period, where Γ cos φ = π (1 - e)/(1 +
    // e).
    let cos = PI * (1.0 - COR) / (1.0 + COR);
    let doubles = cos.hypot(2.0 * (1.0 + COR * COR) / (1.0 + COR).powi(2));
    let ordered = attractors.concat().into_iter().filter(|[strength, _]| *strength < doubles - 0.02);
    let off = ordered.map(|[strength, phase]| (phase - (cos / strength).acos() / TAU).abs()).fold(0.0, f64::max);
    println!(
        "a million impacts in {:.1?}, phases exact to {off:.0e}: see docs/program/gallery/chaos.svg",
        began.elapsed()
    );
    assert!(off < 1e-10);
    Ok(())
}
