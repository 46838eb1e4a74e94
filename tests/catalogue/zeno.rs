//! Impacts that accumulate, rest, and what only seems to accumulate.

use saltus::nalgebra::{Vector2, Vector3, vector};
use saltus::{ErrorKind, Hybrid, JumpOf, Polynomial, RunOf, Simulation, Stop};
use saltus_bounce::effects::Gravity;
use saltus_bounce::walls::{Face, Plane};
use saltus_bounce::{Ball, Cor, Event, Flyer, Mode, Moving, Stance};

use crate::report::Report;
use crate::samples::Samples;

cases! {
    e_half = "zeno-e0.5";
    e_nine_tenths = "zeno-e0.9";
    e_almost_one = "zeno-e0.999999", long: "23 million impacts: run it with --release -- --ignored";
    plastic = "zeno-plastic";
    elastic_million = "elastic-1e6";
    tiny_height = "tiny-height";
    rest_on_floor = "rest-on-floor";
    floor_start_up = "floor-start-up";
    below_floor = "below-floor";
    without_gravity = "g-zero";
    incline = "incline";
    false_zeno = "false-zeno";
    closing_wall = "closing-wall";
}

/// The ball of a case's g and e.
pub(crate) fn ball(case: &Report) -> Ball {
    Ball::new(case.param("g"), Cor::new(case.param("e")).unwrap()).unwrap()
}

/// Lets it go.
pub(crate) fn run(case: &mut Report, start: Vector2<f64>, span: std::ops::Range<f64>) -> RunOf<Ball> {
    let run = Simulation::of(&ball(case)).run(Mode::Flight, start, span).unwrap();
    case.ran(&run.end.stats);
    run
}

/// Drops it from the case's height.
pub(crate) fn dropped(case: &mut Report, end: f64) -> RunOf<Ball> {
    let start = vector![case.param("h"), 0.0];
    run(case, start, 0.0..end)
}

pub(crate) fn impact(run: &RunOf<Ball>, n: usize) -> &JumpOf<Ball> {
    &run.trajectory.jumps()[n - 1]
}

pub(crate) fn comes_to_rest(run: &RunOf<Ball>) -> &JumpOf<Ball> {
    run.trajectory.jumps().iter().find(|jump| jump.to == Mode::Rest).unwrap()
}

fn impacts_until(run: &RunOf<Ball>, t: f64) -> f64 {
    run.trajectory.jumps().iter().filter(|jump| jump.t() <= t && jump.edge().is_some()).count() as f64
}

fn first_slower(run: &RunOf<Ball>, speed: f64) -> f64 {
    run.trajectory.jumps().iter().find(|jump| jump.after[1] < speed).unwrap().j as f64
}

fn e_half(case: &mut Report) {
    let run = dropped(case, 10.0);
    for n in [1, 2, 10, 40] {
        case.check(&format!("t_{n}"), impact(&run, n).t());
    }
    case.check("v_post_40", impact(&run, 40).after[1]);
    case.check("t_zeno", comes_to_rest(&run).t());
    case.check("n_slow", first_slower(&run, 1e-6));
    let x = run.trajectory.at(4.2).unwrap();
    case.check("x(4.2)", x[0]);
    case.check("v(4.2)", x[1]);
    case.check("n(4.2)", impacts_until(&run, 4.2));
    case.check("x(10)", run.end.state[0]);
    case.check("v(10)", run.end.state[1]);
}

fn e_nine_tenths(case: &mut Report) {
    let run = dropped(case, 20.0);
    for n in [1, 10, 100, 200] {
        case.check(&format!("t_{n}"), impact(&run, n).t());
    }
    case.check("v_post_200", impact(&run, 200).after[1]);
    case.check("t_zeno", comes_to_rest(&run).t());
    case.check("n_slow", first_slower(&run, 1e-9));
    let x = run.trajectory.at(8.0).unwrap();
    case.check("x(8)", x[0]);
    case.check("v(8)", x[1]);
    case.check("n(8)", impacts_until(&run, 8.0));
    case.check("x(20)", run.end.state[0]);
    case.check("v(20)", run.end.state[1]);
}

fn e_almost_one(case: &mut Report) {
    let (ball, numbers, times) = (ball(case), [1, 1000, 1_000_000], [500_000.0]);
    let (mut slow, mut rest) = (0, f64::NAN);
    let mut samples = Samples::new(&numbers, &times, |jump: &JumpOf<Ball>| {
        if slow == 0 && jump.after[1] < 1e-3 {
            slow = jump.j;
        }
        if jump.to == Mode::Rest {
            rest = jump.t();
        }
    });
    let simulation = Simulation::of(&ball).most_jumps(100_000_000);
    let end = simulation.drive(Mode::Flight, vector![case.param("h"), 0.0], 0.0..1e6, &mut samples).unwrap();
    case.ran(&end.stats);
    assert_eq!((end.stop, end.mode), (Stop::Time, Mode::Rest));
    for n in numbers {
        case.check(&format!("t_{n}"), samples.jump(n).t());
    }
    case.check("v_post_1000000", samples.jump(1_000_000).after[1]);
    let (x, n) = samples.state(0);
    case.check("x(500000)", x[0]);
    case.check("v(500000)", x[1]);
    case.check("n(500000)", n as f64);
    case.check("n_slow", slow as f64);
    case.check("t_zeno", rest);
}

fn plastic(case: &mut Report) {
    let run = dropped(case, 3.0);
    case.check("t_1", impact(&run, 1).t());
    case.check("n_impacts", run.trajectory.jumps().len() as f64);
    case.check("x(3)", run.end.state[0]);
    case.check("v(3)", run.end.state[1]);
    assert_eq!(run.end.mode, Mode::Rest);
}

/// A million impacts without loss: neither time nor energy drifts.
fn elastic_million(case: &mut Report) {
    let ([g, h], numbers, times) = (case.params(["g", "h"]), [1, 1000, 1_000_000], [451_523.5]);
    let mut drift = 0.0_f64;
    let mut samples = Samples::new(&numbers, &times, |jump: &JumpOf<Ball>| {
        drift = drift.max((jump.after[1] * jump.after[1] / (2.0 * g * h) - 1.0).abs());
    });
    let end = Simulation::of(&ball(case)).drive(Mode::Flight, vector![h, 0.0], 0.0..9.0305e5, &mut samples).unwrap();
    case.ran(&end.stats);
    assert_eq!(end.stop, Stop::Time);
    for n in numbers {
        case.check(&format!("t_{n}"), samples.jump(n).t());
    }
    let (x, n) = samples.state(0);
    case.check("n(451523.5)", n as f64);
    case.check("x(451523.5)", x[0]);
    case.check("max_rel_energy_drift", drift);
}

fn tiny_height(case: &mut Report) {
    let run = dropped(case, 1e-5);
    case.check("t_1", impact(&run, 1).t());
    case.check("t_5", impact(&run, 5).t());
    case.check("v_post_5", impact(&run, 5).after[1]);
    case.check("t_zeno", comes_to_rest(&run).t());
    let x = run.trajectory.at(1e-6).unwrap();
    case.check("x(1e-6)", x[0]);
    case.check("v(1e-6)", x[1]);
    case.check("n(1e-6)", impacts_until(&run, 1e-6));
}

fn rest_on_floor(case: &mut Report) {
    let run = run(case, vector![0.0, 0.0], 0.0..10.0);
    case.check("x(10)", run.end.state[0]);
    case.check("v(10)", run.end.state[1]);
    case.outcome("events", run.trajectory.jumps().len());
    assert_eq!(run.end.mode, Mode::Rest);
}

fn floor_start_up(case: &mut Report) {
    let start = vector![0.0, case.param("v0")];
    let run = run(case, start, 0.0..2.0);
    case.check("t_1", impact(&run, 1).t());
    case.check("t_2", impact(&run, 2).t());
    case.check("t_zeno", comes_to_rest(&run).t());
    case.check("x(0.3)", run.trajectory.at(0.3).unwrap()[0]);
    case.check("x(2)", run.end.state[0]);
}

fn below_floor(case: &mut Report) {
    let ball = ball(case);
    let refused = Simulation::of(&ball).run(Mode::Flight, vector![-1e-3, 0.0], 0.0..1.0).unwrap_err();
    assert_eq!(refused.error.kind(), ErrorKind::Entry);
    case.outcome("a_outcome", "error");
    let still = run(case, vector![-1e-18, 0.0], 0.0..1.0);
    case.check("b_x(1)", still.end.state[0]);
    let up = run(case, vector![-1e-18, 1.0], 0.0..1.0);
    case.check("c_t_1", impact(&up, 1).t());
}

fn without_gravity(case: &mut Report) {
    let down = run(case, vector![1.0, -1.0], 0.0..5.0);
    case.check("run1_t_1", impact(&down, 1).t());
    case.check("run1_x(5)", down.end.state[0]);
    case.check("run1_n", down.trajectory.jumps().len() as f64);
    let still = run(case, vector![1.0, 0.0], 0.0..5.0);
    case.check("run2_x(5)", still.end.state[0]);
    case.check("run2_n", still.trajectory.jumps().len() as f64);
}

/// As a ball on a plane, and as an automaton of four coordinates along and across the slope.
fn incline(case: &mut Report) {
    let [g, e, n0, a] = case.params(["g", "e", "n0", "a"]);
    let slope = Plane::incline(a).unwrap();
    let (normal, down) = (*slope.normal(), vector![-a.cos(), -a.sin()]);
    let ball = Flyer::new(Gravity::new(g).unwrap(), slope, Cor::new(e).unwrap()).unwrap();
    let start = Moving::new(normal * n0, vector![0.0, 0.0]);
    let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..10.0).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    let impacts: Vec<_> = jumps.iter().filter(|jump| matches!(jump.edge(), Some(Event::Meet(_)))).collect();
    case.check("t_1", impacts[0].t());
    case.check("t_20", impacts[19].t());
    let slides = jumps.iter().find(|jump| jump.edge().is_none()).unwrap();
    case.check("t_zeno", slides.t());
    case.check("s(t_zeno)", slides.after.position.dot(&down));
    case.check("s(10)", run.end.state.position.dot(&down));
    case.check("u(10)", run.end.state.velocity.dot(&down));
    case.check("n(10)", run.end.state.position.dot(&normal));
    case.check("w(10)", run.end.state.velocity.dot(&normal));
    assert_eq!(run.end.mode, Stance::Slide { face: Face { cell: 0, index: 0 }, along: vector![0.0, 0.0] });

    let (along, across) = (g * a.sin(), g * a.cos());
    let ball = Hybrid::new()
        .exact("flight", move |_t, x: &[f64; 4]| {
            Polynomial::from([*x, [x[2], x[3], along, -across], [0.5 * along, -0.5 * across, 0.0, 0.0]])
        })
        .edge("flight", "flight", |_t, x| x[1], move |_t, x| [x[0], 0.0, x[2], -e * x[3]])
        .affine()
        .beyond("flight", "slide", |_t, x| [x[0], 0.0, x[2], 0.0])
        .exact("slide", move |_t, x| Polynomial::from([*x, [x[2], 0.0, along, 0.0], [0.5 * along, 0.0, 0.0, 0.0]]));
    let run = Simulation::of(&ball).run("flight", [0.0, n0, 0.0, 0.0], 0.0..10.0).unwrap();
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    case.check("t_1", jumps[0].t());
    case.check("t_20", jumps[19].t());
    case.check("t_zeno", jumps.last().unwrap().t());
    case.check("s(t_zeno)", jumps.last().unwrap().after[0]);
    for (name, ours) in ["s(10)", "n(10)", "u(10)", "w(10)"].into_iter().zip(run.end.state) {
        case.check(name, ours);
    }
}

/// Durations that shrink like 1/n: a million impacts and no limit.
fn false_zeno(case: &mut Report) {
    let [g, h, c] = case.params(["g", "h", "c"]);
    let ball = Hybrid::new()
        .exact("flight", move |_t, x: &Vector2<f64>| Polynomial::from([*x, vector![x[1], -g], vector![-0.5 * g, 0.0]]))
        .edge("flight", "flight", |_t, x| x[0], move |_t, x| vector![0.0, -x[1] / (1.0 - x[1] / c)])
        .affine();
    let (numbers, times) = ([1, 10, 1000, 1_000_000], [2.0]);
    let mut samples = Samples::new(&numbers, &times, |_| {});
    let end = Simulation::of(&ball).drive("flight", vector![h, 0.0], 0.0..3.4, &mut samples).unwrap();
    case.ran(&end.stats);
    assert_eq!(end.stop, Stop::Time);
    for n in numbers {
        case.check(&format!("t_{n}"), samples.jump(n).t());
    }
    case.check("v_post_1000", samples.jump(1000).after[1]);
    let (x, n) = samples.state(0);
    case.check("n(2)", n as f64);
    case.check("x(2)", x[0]);
    case.check("v(2)", x[1]);
}

/// Place and velocity of the ball, and where the wall is; impacts accumulate at 1/u without a loss,
/// and no ratio of durations says so.
fn closing_wall(case: &mut Report) {
    let [u, v0] = case.params(["u", "v0"]);
    let ball = Hybrid::new()
        .exact("between", move |_t, x: &Vector3<f64>| Polynomial::from([*x, vector![x[1], 0.0, -u]]))
        .edge("between", "between", |_t, x| x[0], |_t, x| vector![0.0, -x[1], x[2]])
        .affine()
        .edge("between", "between", |_t, x| x[2] - x[0], move |_t, x| vector![x[2], -x[1] - 2.0 * u, x[2]])
        .affine();
    let simulation = Simulation::of(&ball).most_jumps(20_001);
    let run = simulation.run("between", vector![0.0, v0, 1.0], 0.0..8.0).unwrap();
    case.ran(&run.end.stats);
    // It ends by the limit asked for, and says so.
    assert_eq!(run.end.stop, Stop::Jumps { most: 20_001 });
    let hits: Vec<_> = run.trajectory.jumps().iter().filter(|jump| jump.edge().unwrap().place == 1).collect();
    for n in [1, 2, 10, 1000, 10_000] {
        case.check(&format!("t_{n}"), hits[n - 1].t());
        case.check(&format!("L_{n}"), hits[n - 1].after[2]);
    }
    case.check("speed_10000", -hits[9999].after[1]);
}
