//! P8: many balls with quadratic drag, ten seconds each, on all cores. What counts first is how
//! many impacts each ball makes.

use std::ops::ControlFlow;
use std::time::Instant;

use cpu_time::ProcessTime;
use rayon::prelude::*;
use saltus::{Auto, Automaton, JumpOf, Observer, Simulation};
use saltus_bounce::flight::QuadraticDragFlight;
use saltus_bounce::{Cor, Phase, Restitution};

use super::problems::{Ball, DRAG};
use super::saltus::{SERIES, Stepped, Turn};
use super::{differential_equations, diffsol, floor, ivp};

/// A ball lies still when an impact would leave it less than this, in m/s: a bounce of 5e-8 m.
const LEAST: f64 = 1e-3;
const END: f64 = 10.0;

/// Ball `i` of `count`: dropped from 1 to 10 m, with a COR of 0.5 to 0.95.
fn ball(i: usize, count: usize) -> Ball {
    let golden = 0.618_033_988_749_894_9;
    let height = 1.0 + 9.0 * (i as f64 * golden).fract();
    let cor = 0.5 + 0.45 * i as f64 / (count - 1) as f64;
    Ball { height, cor, impacts: usize::MAX, ..DRAG }
}

/// A way to count a ball's impacts at a tolerance.
pub struct Way {
    pub solver: &'static str,
    pub method: &'static str,
    pub tolerant: bool,
    count: fn(Ball, f64) -> usize,
}

/// Counts the impacts within the ten seconds, and says when the last was made.
fn counting(cor: f64, run: impl FnOnce(&mut dyn FnMut(f64, f64) -> bool)) -> usize {
    let mut count = 0;
    run(&mut |t, speed| {
        let within = t <= END;
        count += usize::from(within);
        within && cor * speed >= LEAST
    });
    count
}

/// Keeps `cor` of the speed, or nothing where that is too little.
struct Settling(Cor);

impl Restitution for Settling {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        let speed = self.0.rebound(impact);
        if speed < LEAST { 0.0 } else { speed }
    }
}

/// Counts floors, and stops at the first that leaves too little speed.
struct Count {
    count: usize,
    cor: f64,
}

impl Observer<Stepped> for Count {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<Stepped>) -> ControlFlow<()> {
        if jump.edge() == Some(Turn::Floor) {
            self.count += 1;
            if -self.cor * jump.before[1] < LEAST {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }
}

struct Floors(usize);

impl<A: Automaton<Edge = saltus_bounce::Turn>> Observer<A> for Floors {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.0 += usize::from(jump.edge() == Some(saltus_bounce::Turn::Floor));
        ControlFlow::Continue(())
    }
}

fn by_ball(ball: Ball, _: f64) -> usize {
    let flight = QuadraticDragFlight::new(ball.gravity, ball.drag).unwrap();
    let automaton = saltus_bounce::Ball::of(flight, Settling(Cor::new(ball.cor).unwrap()));
    let mut floors = Floors(0);
    let start = saltus_bounce::Ball::dropped_from(ball.height);
    Simulation::of(&automaton).drive(Phase::Falling, start, 0.0..END, &mut floors).unwrap();
    floors.0
}

fn by_stepper(ball: Ball, tolerance: f64) -> usize {
    let automaton = Stepped(ball);
    impacts(&automaton, Simulation::of(&automaton).stepper(Auto::default()).tolerance(tolerance).stepped())
}

fn by_series(ball: Ball, tolerance: f64) -> usize {
    let automaton = Stepped(ball);
    impacts(&automaton, Simulation::of(&automaton).tolerance(tolerance))
}

fn impacts(Stepped(ball): &Stepped, simulation: Simulation<'_, Stepped>) -> usize {
    let mut count = Count { count: 0, cor: ball.cor };
    simulation.drive(false, [ball.height, 0.0], 0.0..END, &mut count).unwrap();
    count.count
}

/// The ways, each in the form that was the best of its crate in trials.
pub fn ways() -> Vec<Way> {
    let way = |solver, method, count| Way { solver, method, tolerant: true, count };
    vec![
        Way {
            tolerant: false,
            ..way("floor", "the textbook's formulas", |ball, _| {
                let Ball { gravity: g, drag: k, height, cor, .. } = ball;
                counting(cor, |impact| floor::textbook(g, k, height, cor, impact))
            })
        },
        Way { tolerant: false, ..way("saltus", "Ball, closed form", by_ball) },
        way("saltus", "Auto", by_stepper),
        way("saltus", SERIES, by_series),
        way("diffsol", "tsit45, apex split", |ball, tolerance| {
            counting(ball.cor, |impact| {
                diffsol::bounce(ball, tolerance, impact);
            })
        }),
        way("differential-equations", "dopri5, apex split", |ball, tolerance| {
            counting(ball.cor, |impact| differential_equations::bounce_dopri5(ball, tolerance, impact))
        }),
        way("ivp", "DOPRI5, apex split", |ball, tolerance| {
            counting(ball.cor, |impact| {
                ivp::bounce(ball, true, ivp::Explicit::Dopri5, tolerance, impact);
            })
        }),
    ]
}

/// A run of all balls.
#[derive(Clone, Copy, Debug)]
pub struct Swarm {
    pub tolerance: f64,
    pub impacts: usize,
    pub wrong: usize,
    /// CPU time of all cores together, in seconds.
    pub cpu: f64,
    /// Time on the wall, in seconds.
    pub wall: f64,
}

/// How many impacts each ball makes, by the closed formulas.
pub fn truth(balls: usize) -> Vec<usize> {
    let count = |i| {
        let ball = ball(i, balls);
        counting(ball.cor, |impact| ball.closed(impact))
    };
    (0..balls).into_par_iter().map(count).collect()
}

/// All balls by one way at one tolerance.
pub fn run(way: &Way, truth: &[usize], tolerance: f64) -> Swarm {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let balls = truth.len();
    let counts: Vec<usize> = (0..balls).into_par_iter().map(|i| (way.count)(ball(i, balls), tolerance)).collect();
    let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
    let wrong = counts.iter().zip(truth).filter(|(a, b)| a != b).count();
    Swarm { tolerance, impacts: counts.iter().sum(), wrong, cpu, wall }
}
