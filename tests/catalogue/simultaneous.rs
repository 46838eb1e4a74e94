//! Several contacts at one time or nearly so: corners, cradles, cascades, collapse, and a billiard
//! that counts the digits of π.

use std::f64::consts::PI;

use saltus::nalgebra::vector;
use saltus::{
    About, Automaton, Cause, Edges, Entry, Hybrid, JumpOf, Polynomial, Refusal, RunOf, Simulation, Solution, Stop,
};
use saltus_bounce::line::{Lying, Row};
use saltus_bounce::walls::Plane;
use saltus_bounce::{Cor, Flyer, Line, Moving, Stance};

use crate::report::Report;
use crate::samples::Samples;

cases! {
    corner = "corner-exact";
    wedge_60 = "wedge-60";
    wedge_generic = "wedge-generic";
    cradle_of_five = "cradle-5-1";
    cradle_of_three = "cradle-3-e0.9";
    stacked_gap = "stacked-gap";
    chain = "chain-3";
    inelastic_collapse = "inelastic-collapse";
    galperin_0 = "galperin-0";
    galperin_1 = "galperin-1";
    galperin_3 = "galperin-3";
    galperin_5 = "galperin-5";
    galperin_7 = "galperin-7", long: "31 million impacts: run it with --release -- --ignored";
    noncommuting_resets = "noncommuting-resets";
    cascade = "cascade-1000";
}

/// In either order of the walls.
fn corner(case: &mut Report) {
    let [ex, ey] = case.params(["ex", "ey"]);
    for order in [[(0, ex), (1, ey)], [(1, ey), (0, ex)]] {
        let flight = Hybrid::new().exact("run", |_t, x: &[f64; 4]| Polynomial::from([*x, [x[2], x[3], 0.0, 0.0]]));
        let ball = order.into_iter().fold(flight, |ball, (k, e): (usize, f64)| {
            let reset = move |_t: f64, x: &[f64; 4]| {
                let mut after = *x;
                after[k + 2] *= -e;
                after
            };
            ball.edge("run", "run", move |_t, x| x[k], reset)
        });
        let run = Simulation::of(&ball).run("run", [1.0, 1.0, -1.0, -1.0], 0.0..3.0).unwrap();
        case.ran(&run.end.stats);
        case.check("n_resets", run.trajectory.jumps().len() as f64);
        for jump in run.trajectory.jumps() {
            case.check("t_event", jump.t());
        }
        for (name, ours) in ["x(3)", "y(3)", "u(3)", "w(3)"].into_iter().zip(run.end.state) {
            case.check(name, ours);
        }
    }
}

/// What a ball does that flies towards the vertex of a wedge, `aside` of its bisector.
struct Out {
    reflections: usize,
    direction: f64,
    /// Whether two of the reflections share one time.
    at_once: bool,
}

fn wedge(case: &mut Report, aside: f64) -> Result<Out, String> {
    let alpha = case.param("alpha");
    let walls = [vector![0.0, 1.0], vector![alpha.sin(), -alpha.cos()]].map(|normal| Plane::wall(normal, 0.0).unwrap());
    let ball = Flyer::new((), walls, Cor::new(1.0).unwrap()).unwrap();
    let (sin, cos) = (0.5 * alpha).sin_cos();
    let start = Moving::new(vector![cos - aside * sin, sin + aside * cos], vector![-cos, -sin]);
    let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..3.0).map_err(|failed| failed.error.to_string())?;
    case.ran(&run.end.stats);
    let jumps = run.trajectory.jumps();
    Ok(Out {
        reflections: jumps.len(),
        direction: run.end.state.velocity[1].atan2(run.end.state.velocity[0]),
        at_once: jumps.windows(2).any(|pair| pair[0].t() == pair[1].t()),
    })
}

/// From both sides of the bisector: how many reflections, and where it goes.
fn both_sides(case: &mut Report) -> [Out; 2] {
    let sides = [1e-9, -1e-9].map(|aside| wedge(case, aside).unwrap());
    for (side, out) in ["plus", "minus"].into_iter().zip(&sides) {
        case.check(&format!("n_{side}"), out.reflections as f64);
        case.check(&format!("dir_{side}"), out.direction);
    }
    sides
}

fn wedge_60(case: &mut Report) {
    both_sides(case);
}

/// Into the vertex itself the future is not unique; that both walls are met at once is said by two
/// jumps at one time.
fn wedge_generic(case: &mut Report) {
    let sides = both_sides(case);
    let outcome = match wedge(case, 0.0) {
        Err(_) => "error".to_owned(),
        Ok(out) => {
            let like = sides.iter().zip(["dir_plus", "dir_minus"]);
            let name = like.into_iter().find(|(side, _)| (side.direction - out.direction).abs() < 1e-12);
            let flag = if out.at_once { "flagged" } else { "silently" };
            format!("{}-{flag}", name.map_or("neither", |(_, name)| name))
        }
    };
    case.outcome("offset0", outcome);
}

fn on_line<const N: usize>(case: &mut Report, line: &Line<N>, start: Row<N>, end: f64) -> RunOf<Line<N>> {
    let run = Simulation::of(line).run(Lying::NONE, start, 0.0..end).unwrap();
    case.ran(&run.end.stats);
    run
}

/// Balls that touch, the first of them coming in from a distance of 1 m at 1 m/s.
fn cradle<const N: usize>(case: &mut Report) {
    let mut start = Row { gaps: [0.0; N], velocities: [0.0; N] };
    (start.gaps[0], start.gaps[1], start.velocities[0]) = (-1.0, 1.0, 1.0);
    let line = Line::new([1.0; N], Cor::new(case.param("e")).unwrap()).unwrap();
    let run = on_line(case, &line, start, 2.0);
    case.check("n_pair", run.trajectory.jumps().len() as f64);
    for (i, v) in (1..).zip(run.end.state.velocities) {
        case.check(&format!("v_{i}"), v);
    }
    assert!(run.trajectory.jumps().iter().all(|jump| jump.t() == 1.0));
}

fn cradle_of_five(case: &mut Report) {
    cradle::<5>(case);
}

fn cradle_of_three(case: &mut Report) {
    cradle::<3>(case);
}

fn stacked_gap(case: &mut Report) {
    let [g, lower, upper, h, gap] = case.params(["g", "M", "m", "h", "gap"]);
    let line = Line::new([lower, upper], Cor::new(1.0).unwrap()).unwrap().with_gravity(g).unwrap().on_floor();
    let run = on_line(case, &line, Row::at([h, h + gap], [0.0; 2]), 0.6);
    let jumps = run.trajectory.jumps();
    assert_eq!(jumps.len(), 2);
    case.check("t_floor", jumps[0].t());
    case.check("dt_contact", jumps[1].time.since(jumps[0].time));
    let [lower, upper] = jumps[1].after.velocities;
    case.check("v_lower", lower);
    case.check("v_upper", upper);
    let apex = jumps[1].after.positions()[1] + upper * upper / (2.0 * g);
    case.check("apex_upper", apex);
    case.check("height_ratio_limit", apex / h);
}

fn chain(case: &mut Report) {
    let line = Line::new([1.0, case.param("mu"), 1.0], Cor::new(1.0).unwrap()).unwrap();
    let run = on_line(case, &line, Row::at([0.0, 1.0, 3.0], [1.0, 0.0, -0.5]), 10.0);
    let jumps = run.trajectory.jumps();
    case.check("n_collisions", jumps.len() as f64);
    case.check("t_first", jumps[0].t());
    case.check("t_last", jumps[jumps.len() - 1].t());
    for (i, v) in (1..).zip(run.end.state.velocities) {
        case.check(&format!("v_{i}"), v);
    }
}

fn inelastic_collapse(case: &mut Report) {
    let line = Line::new([1.0; 3], Cor::new(case.param("e")).unwrap()).unwrap();
    let run = on_line(case, &line, Row::at([0.0, 1.0, 2.5], [1.0, 0.0, -1.0]), 5.0);
    let jumps = run.trajectory.jumps();
    let limit = jumps.iter().find(|jump| jump.cause == Cause::Zeno).unwrap();
    case.check("t_collapse", limit.t());
    case.check("x_collapse", limit.after.positions()[0]);
    let close = |jump: &&JumpOf<Line<3>>| jump.after.gaps[1] < 1e-6 && jump.after.gaps[2] < 1e-6;
    case.check("n_gap_1e-6", jumps.iter().find(close).unwrap().j as f64);
    for (x, v) in run.end.state.positions().into_iter().zip(run.end.state.velocities) {
        case.check("x_i(5)", x);
        case.check("v_i(5)", v);
    }
    assert_eq!((run.end.state.gaps[1], run.end.state.gaps[2]), (0.0, 0.0));
}

fn galperin(case: &mut Report) {
    let power = case.param("N") as i32;
    let line = Line::new([1.0, 100.0_f64.powi(power)], Cor::new(1.0).unwrap()).unwrap().on_floor();
    let quarter = ((PI * 10.0_f64.powi(power)) as usize / 4).max(1);
    let (mut first, mut last, mut spacing) = (None, saltus::Time::new(0.0), f64::INFINITY);
    let numbers = [quarter];
    let mut samples = Samples::new(&numbers, &[], |jump: &JumpOf<Line<2>>| {
        if first.is_some() {
            spacing = spacing.min(jump.time.since(last));
        }
        first = first.or(Some(jump.t()));
        last = jump.time;
    });
    let simulation = Simulation::of(&line).most_jumps(100_000_000);
    let end = simulation.drive(Lying::NONE, Row::at([1.0, 2.0], [0.0, -1.0]), 0.0..10.0, &mut samples).unwrap();
    case.ran(&end.stats);
    assert_eq!(end.stop, Stop::Time);
    let at_quarter = *samples.jump(quarter);
    case.check("n_collisions", end.jumps as f64);
    case.check("t_first", first.unwrap());
    case.check("t_last", last.seconds());
    case.check("t_quarter", at_quarter.t());
    case.check("v_big_final", end.state.velocities[1]);
    case.check("v_small_final", end.state.velocities[0]);
    case.check("v_big_quarter", at_quarter.after.velocities[1]);
    case.check("v_small_quarter", at_quarter.after.velocities[0]);
    case.check("min_event_spacing", spacing);
}

fn galperin_0(case: &mut Report) {
    galperin(case);
}

fn galperin_1(case: &mut Report) {
    galperin(case);
}

fn galperin_3(case: &mut Report) {
    galperin(case);
}

fn galperin_5(case: &mut Report) {
    galperin(case);
}

fn galperin_7(case: &mut Report) {
    galperin(case);
}

/// Crossings at one time are taken in the order in which the edges are declared.
fn noncommuting_resets(case: &mut Report) {
    for a_first in [true, false] {
        let clock = Hybrid::new().exact("run", |_t, x: &[f64; 2]| Polynomial::from([*x, [0.0, 1.0]]));
        let a = |clock: Hybrid<'static, [f64; 2]>| {
            clock.edge("run", "run", |_t, x| 1.0 - x[1], |_t, x| [x[0] + 1.0, x[1]]).entry(Entry::Wait)
        };
        let b = |clock: Hybrid<'static, [f64; 2]>| {
            clock.edge("run", "run", |_t, x| 2.0 - 2.0 * x[1], |_t, x| [2.0 * x[0], x[1]]).entry(Entry::Wait)
        };
        let automaton = if a_first { b(a(clock)) } else { a(b(clock)) };
        let run = Simulation::of(&automaton).run("run", [1.0, 0.0], 0.0..2.0).unwrap();
        case.ran(&run.end.stats);
        case.check("n_resets", run.trajectory.jumps().len() as f64);
        case.outcome(if a_first { "x(2)_A_first" } else { "x(2)_B_first" }, run.end.state[0]);
    }
}

/// A clock and a counter; each edge makes the guard of the next one true.
struct Cascade;

impl Automaton for Cascade {
    type Mode = usize;
    type State = f64;
    type Edge = usize;
    fn flow(&self, _: usize, _t: f64, _c: &f64) -> f64 {
        1.0
    }
    fn edges(&self, j: usize) -> Edges<'_, usize> {
        if j < 1000 { Edges::from([j]) } else { Edges::none() }
    }
    fn guard(&self, edge: usize, _t: f64, c: &f64) -> f64 {
        if edge == 0 { 1.0 - c } else { -1.0 }
    }
    fn reset(&self, _: usize, edge: usize, _t: f64, c: &f64) -> Result<(usize, f64), Refusal> {
        Ok((edge + 1, *c))
    }
    #[inline]
    fn about(&self, _: usize) -> About {
        About::new().entry(Entry::Fire)
    }
    fn solution(&self, _: usize, _t: f64, c: &f64) -> Solution<Self> {
        Solution::Polynomial([*c, 1.0].into())
    }
}

fn cascade(case: &mut Report) {
    let run = Simulation::of(&Cascade).run(0, 0.0, 0.0..2.0).unwrap();
    case.ran(&run.end.stats);
    case.check("j(2)", run.end.mode as f64);
    case.check("t_last_event", run.trajectory.jumps().last().unwrap().t());
}
