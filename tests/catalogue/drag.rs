//! Balls in air: by the closed forms of their flights, and by steps.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Auto, Dop853, Hybrid, Jump, Rodas5P, Run, RunOf, Simulation, State, Stop};
use saltus_bounce::effects::{Gravity, QuadraticDrag};
use saltus_bounce::flight::{LinearDragFlight, QuadraticDragFlight};
use saltus_bounce::walls::Plane;
use saltus_bounce::{Ball, Cor, Event, Floor, Flyer, Keeps, Mode, Moving, Phase, Stance, Turn};

use crate::report::Report;

cases! {
    quadratic_moderate = "qdrag-moderate";
    quadratic_strong = "qdrag-strong";
    linear_moderate = "ldrag-moderate";
    linear_weak = "ldrag-weak";
    projectile = "qdrag-projectile";
}

/// The jumps by which the ball meets the floor.
fn impacts<M: Copy, E: Copy + PartialEq, S: State>(run: &Run<M, E, S>, floor: E) -> Vec<Jump<M, E, S>> {
    run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(floor)).cloned().collect()
}

/// When the bounces are over: the last jump.
fn rest<M: Copy, E: Copy + PartialEq + std::fmt::Debug, S: State>(run: &Run<M, E, S>) -> f64 {
    let last = run.trajectory.jumps().last().unwrap();
    assert_eq!(last.edge(), None, "the bounces accumulate");
    last.t()
}

/// Its flights from their closed forms.
fn quadratic(case: &mut Report, end: f64, last: usize) {
    let [g, k, e, h] = case.params(["g", "k", "e", "h"]);
    let ball = Ball::of(QuadraticDragFlight::new(g, k).unwrap(), Cor::new(e).unwrap());
    let run = Simulation::of(&ball).run(Phase::Falling, vector![h, 0.0], 0.0..end).unwrap();
    case.ran(&run.end.stats);
    assert_eq!((run.end.mode, run.end.stop, run.end.stats.steps), (Phase::Rest, Stop::Time, 0));
    let impacts = impacts(&run, Turn::Floor);
    for n in [1, last] {
        case.check(&format!("t_{n}"), impacts[n - 1].t());
        case.check(&format!("v_pre_{n}"), impacts[n - 1].before[1]);
    }
    let apex = run.trajectory.jumps().iter().find(|jump| jump.edge() == Some(Turn::Apex)).unwrap();
    case.check("apex_1", apex.after[0]);
    case.check("t_zeno", rest(&run));
}

/// The same ball by steps: up and down are two smooth modes, the apex an edge between them.
fn parted(case: &Report) -> Hybrid<'static, Vector2<f64>> {
    let [g, k, e] = case.params(["g", "k", "e"]);
    Hybrid::new()
        .mode("down", move |_t, x: &Vector2<f64>| vector![x[1], k * x[1] * x[1] - g])
        .mode("up", move |_t, x| vector![x[1], -g - k * x[1] * x[1]])
        .edge("down", "up", |_t, x| x[0], move |_t, x| vector![0.0, -e * x[1]])
        .affine()
        .edge("up", "down", |_t, x| x[1], |_t, x| *x)
        .affine()
        .exact("rest", |_t, x| [*x].into())
        .beyond("down", "rest", |_t, _x| vector![0.0, 0.0])
        .beyond("up", "rest", |_t, _x| vector![0.0, 0.0])
}

fn check_parted(case: &mut Report, run: &RunOf<Hybrid<'_, Vector2<f64>>>, last: usize) {
    case.ran(&run.end.stats);
    assert_eq!((run.end.mode, run.end.stop), ("rest", Stop::Time));
    let jumps = run.trajectory.jumps();
    let impacts: Vec<_> = jumps.iter().filter(|jump| jump.to == "up").collect();
    for n in [1, last] {
        case.check(&format!("t_{n}"), impacts[n - 1].t());
        case.check(&format!("v_pre_{n}"), impacts[n - 1].before[1]);
    }
    case.check("apex_1", jumps[1].after[0]);
    case.check("t_zeno", rest(run));
}

fn quadratic_moderate(case: &mut Report) {
    quadratic(case, 20.0, 6);
    let (ball, start) = (parted(case), vector![case.param("h"), 0.0]);
    let simulation = Simulation::of(&ball).stepper(Auto::from(Dop853)).tolerance(1e-13).absolute_tolerance(1e-25);
    let run = simulation.run("down", start, 0.0..20.0).unwrap();
    check_parted(case, &run, 6);
}

fn quadratic_strong(case: &mut Report) {
    quadratic(case, 400.0, 4);
    let (ball, start) = (parted(case), vector![case.param("h"), 0.0]);
    let simulation = Simulation::of(&ball).stepper(Auto::from(Rodas5P)).tolerance(1e-13).absolute_tolerance(1e-22);
    let run = simulation.run("down", start, 0.0..400.0).unwrap();
    check_parted(case, &run, 4);
}

fn linear(case: &mut Report) {
    let [g, c, e, h] = case.params(["g", "c", "e", "h"]);
    let ball = Ball::of(LinearDragFlight::new(g, c).unwrap(), Cor::new(e).unwrap());
    let run = Simulation::of(&ball).run(Mode::Flight, vector![h, 0.0], 0.0..20.0).unwrap();
    case.ran(&run.end.stats);
    assert_eq!((run.end.mode, run.end.stop, run.end.stats.steps), (Mode::Rest, Stop::Time, 0));
    let impacts = impacts(&run, Floor);
    for n in [1, 2, 6] {
        case.check(&format!("t_{n}"), impacts[n - 1].t());
    }
    for n in [1, 6] {
        case.check(&format!("v_pre_{n}"), impacts[n - 1].before[1]);
    }
    case.check("t_zeno", rest(&run));
}

fn linear_moderate(case: &mut Report) {
    linear(case);
}

fn linear_weak(case: &mut Report) {
    linear(case);
}

fn projectile(case: &mut Report) {
    let [g, k, s, mu, e] = case.params(["g", "k", "s", "mu", "e"]);
    let effects = (Gravity::new(g).unwrap(), QuadraticDrag::new(k).unwrap());
    let floor = Plane::floor(0.0).unwrap();
    let ball = Flyer::gripped(effects, floor, Cor::new(e).unwrap(), Keeps::new(mu).unwrap()).unwrap();
    let start = Moving::new(vector![0.0, 0.0], vector![s, s]);
    let run = Simulation::of(&ball)
        .stepper(Auto::from(Dop853))
        .tolerance(1e-13)
        .run(Stance::FLIGHT, start, 0.0..20.0)
        .unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps().iter();
    for (n, impact) in (1..=3).zip(jumps.filter(|jump| matches!(jump.edge(), Some(Event::Meet(_))))) {
        case.check(&format!("t_{n}"), impact.t());
        case.check(&format!("x_{n}"), impact.before.position[0]);
        case.check(&format!("w_pre_{n}"), impact.before.velocity[1]);
    }
    assert!(matches!(run.end.mode, Stance::Slide { .. }), "{:?}", run.end.mode);
}
