//! Several balls on a line: cascades, collapse, and a billiard that counts the digits of π.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::ops::ControlFlow;

use proptest::prelude::*;
use saltus::{Cause, Jump, Observer, Run, Simulation, Stop};
use saltus_bounce::line::{Contact, Lying, Row};
use saltus_bounce::{Cor, Drop, Line};
use saltus_tests::reference::Case;

fn cor(e: f64) -> Cor {
    Cor::new(e).unwrap()
}

fn run<const N: usize>(line: &Line<N>, start: Row<N>, end: f64) -> Run<Line<N>> {
    Simulation::of(line).run(Lying::NONE, start, 0.0..end).unwrap()
}

/// Balls that touch, the first of them coming in from a distance of 1 m at 1 m/s.
fn cradle<const N: usize>(e: f64) -> Run<Line<N>> {
    let mut start = Row { gaps: [0.0; N], velocities: [0.0; N] };
    (start.gaps[0], start.gaps[1], start.velocities[0]) = (-1.0, 1.0, 1.0);
    run(&Line::new([1.0; N], cor(e)).unwrap(), start, 2.0)
}

#[test]
fn cradles() {
    let case = Case::named("cradle-5-1");
    let five = cradle::<5>(case.param("e"));
    case.check("n_pair", five.trajectory.jumps().len() as f64);
    for (i, v) in five.state.velocities.into_iter().enumerate() {
        case.check(&format!("v_{}", i + 1), v);
    }
    let case = Case::named("cradle-3-e0.9");
    let three = cradle::<3>(case.param("e"));
    case.check("n_pair", three.trajectory.jumps().len() as f64);
    for (i, v) in three.state.velocities.into_iter().enumerate() {
        case.check(&format!("v_{}", i + 1), v);
    }
    assert!(three.trajectory.jumps().iter().all(|jump| jump.t() == 1.0));
}

#[test]
fn stacked_gap() {
    let case = Case::named("stacked-gap");
    let [g, lower, upper, h, gap] = ["g", "M", "m", "h", "gap"].map(|name| case.param(name));
    let line = Line::new([lower, upper], cor(1.0)).unwrap().with_gravity(g).unwrap().on_floor();
    let run = run(&line, Row::at([h, h + gap], [0.0; 2]), 0.6);
    let jumps = run.trajectory.jumps();
    assert_eq!(jumps.len(), 2);
    case.check("t_floor", jumps[0].t());
    case.check("dt_contact", jumps[1].time.since(jumps[0].time));
    let [lower, upper] = jumps[1].after.velocities;
    case.check("v_lower", lower);
    case.check("v_upper", upper);
    case.check("apex_upper", jumps[1].after.positions()[1] + upper * upper / (2.0 * g));
}

#[test]
fn chain() {
    let case = Case::named("chain-3");
    let line = Line::new([1.0, case.param("mu"), 1.0], cor(1.0)).unwrap();
    let run = run(&line, Row::at([0.0, 1.0, 3.0], [1.0, 0.0, -0.5]), 10.0);
    let jumps = run.trajectory.jumps();
    case.check("n_collisions", jumps.len() as f64);
    case.check("t_first", jumps[0].t());
    case.check("t_last", jumps[jumps.len() - 1].t());
    for (i, v) in run.state.velocities.into_iter().enumerate() {
        case.check(&format!("v_{}", i + 1), v);
    }
}

#[test]
fn inelastic_collapse() {
    let case = Case::named("inelastic-collapse");
    let line = Line::new([1.0; 3], cor(case.param("e"))).unwrap();
    let run = run(&line, Row::at([0.0, 1.0, 2.5], [1.0, 0.0, -1.0]), 5.0);
    let jumps = run.trajectory.jumps();
    let limit = jumps.iter().find(|jump| jump.cause == Cause::Zeno).unwrap();
    case.check("t_collapse", limit.t());
    case.check("x_collapse", limit.after.positions()[0]);
    let close = |jump: &&Jump<Line<3>>| jump.after.gaps[1] < 1e-6 && jump.after.gaps[2] < 1e-6;
    case.check("n_gap_1e-6", jumps.iter().find(close).unwrap().j as f64);
    for (x, v) in run.state.positions().into_iter().zip(run.state.velocities) {
        case.check("x_i(5)", x);
        case.check("v_i(5)", v);
    }
    assert_eq!((run.state.gaps[1], run.state.gaps[2]), (0.0, 0.0));
}

/// Counts jumps; keeps the first, the last and the one at a quarter of all.
struct Count {
    quarter: usize,
    seen: usize,
    first: f64,
    last: f64,
    at_quarter: Option<Jump<Line<2>>>,
}

impl Observer<Line<2>> for Count {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &Jump<Line<2>>) -> ControlFlow<()> {
        self.seen += 1;
        self.last = jump.t();
        if self.seen == 1 {
            self.first = self.last;
        }
        if self.seen == self.quarter {
            self.at_quarter = Some(*jump);
        }
        ControlFlow::Continue(())
    }
}

fn galperin(n: i32) {
    let case = Case::named(&format!("galperin-{n}"));
    let big = 100.0_f64.powi(n);
    let line = Line::new([1.0, big], cor(1.0)).unwrap().on_floor();
    let digits = (std::f64::consts::PI * 10.0_f64.powi(n)) as usize;
    let mut count = Count { quarter: (digits / 4).max(1), seen: 0, first: 0.0, last: 0.0, at_quarter: None };
    let simulation = Simulation::of(&line).most_jumps(100_000_000);
    let began = std::time::Instant::now();
    let end = simulation.drive(Lying::NONE, Row::at([1.0, 2.0], [0.0, -1.0]), 0.0..10.0, &mut count).unwrap();
    println!("galperin-{n}: {} impacts in {:?}", count.seen, began.elapsed());
    case.check("n_collisions", count.seen as f64);
    case.check("t_first", count.first);
    case.check("v_big_final", end.state.velocities[1]);
    case.check("v_small_final", end.state.velocities[0]);
    let quarter = count.at_quarter.unwrap();
    case.check("v_big_quarter", quarter.after.velocities[1]);
    case.check("v_small_quarter", quarter.after.velocities[0]);
    case.check("t_quarter", quarter.t());
    case.check("t_last", count.last);
}

#[test]
fn galperin_0() {
    galperin(0);
}

#[test]
fn galperin_1() {
    galperin(1);
}

#[test]
fn galperin_3() {
    galperin(3);
}

#[test]
fn galperin_5() {
    galperin(5);
}

#[test]
#[ignore = "31415926 impacts take over five seconds: run it with --release"]
fn galperin_7() {
    galperin(7);
}

/// A single ball on the floor is the ball of the closed form, rest included.
#[test]
fn one_ball_bounces_and_rests() {
    let line = Line::new([0.1], cor(0.5)).unwrap().with_gravity(9.8).unwrap().on_floor();
    let run = run(&line, Row { gaps: [1.0], velocities: [0.0] }, 4.0);
    let drop = Drop::new(1.0, 9.8, cor(0.5));
    for n in 1..=10 {
        let t = run.trajectory.jumps()[n - 1].t();
        assert!((t - drop.impact_time(n as u32)).abs() < 1e-15, "{n}: {t}");
    }
    let rest = run.trajectory.jumps().last().unwrap();
    assert!((rest.t() - drop.rest_time().unwrap()).abs() < 1e-15);
    assert_eq!((run.mode, run.state), (Lying::balls(1), Row { gaps: [0.0], velocities: [0.0] }));
}

/// A stack of lossy balls comes to rest on the floor, all of it, and lies until it is hit.
#[test]
fn a_stack_comes_to_rest() {
    for e in [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8] {
        let line = Line::new([1.0, 0.7, 0.5], cor(e)).unwrap().with_gravity(9.81).unwrap().on_floor();
        let run = run(&line, Row { gaps: [1.0, 0.3, 0.2], velocities: [0.0; 3] }, 60.0);
        assert_eq!((run.stop, run.mode), (Stop::Time, Lying::balls(3)), "e = {e}");
        assert_eq!(run.state, Row { gaps: [0.0; 3], velocities: [0.0; 3] });
    }
}

/// A ball that lies is hit through the ball upon it.
#[test]
fn a_stack_is_hit() {
    let line = Line::new([1.0, 1.0, 1.0], cor(1.0)).unwrap().with_gravity(10.0).unwrap().on_floor();
    let start = Row { gaps: [0.0, 0.0, 5.0], velocities: [0.0; 3] };
    let run = Simulation::of(&line).run(Lying::balls(2), start, 0.0..1.5).unwrap();
    // The speed is handed down to the floor and back up; what it leaves lies on.
    let jumps = run.trajectory.jumps();
    assert_eq!((jumps.len(), jumps[0].edge(), jumps[0].t()), (1, Some(Contact(2)), 1.0));
    assert_eq!((jumps[0].to, jumps[0].after.velocities), (Lying::balls(2), [0.0, 0.0, 10.0]));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Without a floor momentum is kept, and energy never rises, whatever the masses.
    #[test]
    fn momentum_and_energy(
        logs in prop::array::uniform5(-6.0..6.0_f64), gaps in prop::array::uniform5(0.1..1.0_f64),
        velocities in prop::array::uniform5(-3.0..3.0_f64), e in 0.6..=1.0_f64,
    ) {
        let masses = logs.map(|log| 10.0_f64.powf(log));
        let line = Line::new(masses, cor(e)).unwrap();
        let start = Row { gaps, velocities };
        let run = Simulation::of(&line).most_jumps(2000).run(Lying::NONE, start, 0.0..3.0).unwrap();
        let (momentum, energy) = (line.momentum(&start), line.energy(&start));
        let mut last = energy;
        for jump in run.trajectory.jumps() {
            let x = &jump.after;
            let size: f64 = masses.iter().zip(x.velocities).map(|(m, v)| m * v.abs()).sum::<f64>().max(1e-300);
            let most: f64 = masses.iter().zip(velocities).map(|(m, v)| m * v.abs()).sum();
            prop_assert!((line.momentum(x) - momentum).abs() <= 1e-13 * size.max(most), "{jump:?}");
            prop_assert!(line.energy(x) <= last * (1.0 + 1e-13), "{} {last}", line.energy(x));
            last = line.energy(x);
            prop_assert!(jump.before.gaps[1..].iter().all(|&gap| gap >= -1e-12), "{:?}", jump.before);
        }
        if e == 1.0 {
            prop_assert!((last - energy).abs() <= 1e-12 * energy);
        }
    }

    /// Whatever is stacked and dropped, energy never rises, no ball passes another, and the run ends as it should. A ball that bounces on one that
    /// bounces waits for infinitely many impacts below it at each of its own: a stack of four may take a million before it lies.
    #[test]
    fn stacks(
        logs in prop::array::uniform4(-1.0..1.0_f64), gaps in prop::array::uniform4(0.0..0.5_f64), e in 0.0..0.8_f64,
    ) {
        let line = Line::new(logs.map(|log| 10.0_f64.powf(log)), cor(e)).unwrap().with_gravity(9.81).unwrap().on_floor();
        let start = Row { gaps, velocities: [0.0; 4] };
        let run = Simulation::of(&line).most_jumps(2_000_000).run(Lying::NONE, start, 0.0..30.0).unwrap();
        prop_assert_eq!((run.stop, run.mode, run.state.velocities), (Stop::Time, Lying::balls(4), [0.0; 4]));
        let mut last = line.energy(&start);
        for jump in run.trajectory.jumps() {
            let energy = line.energy(&jump.after);
            prop_assert!(energy <= last + 1e-13 * line.energy(&start), "{energy} {last} {jump:?}");
            last = energy;
            prop_assert!(jump.before.gaps.iter().all(|&gap| gap >= -1e-14), "{:?}", jump.before);
        }
    }

    /// Seen in a mirror, balls that never meet three at a time do the same.
    #[test]
    fn the_mirror(gaps in prop::array::uniform3(0.1..1.0_f64), v in prop::array::uniform4(-2.0..2.0_f64), e in 0.5..=1.0_f64) {
        let masses = [1.0, 3.0, 0.5, 2.0];
        let line = Line::new(masses, cor(e)).unwrap();
        let mut mirrored = masses;
        mirrored.reverse();
        let mirror = Line::new(mirrored, cor(e)).unwrap();
        let one = run(&line, Row { gaps: [0.0, gaps[0], gaps[1], gaps[2]], velocities: v }, 2.0);
        let two = run(&mirror, Row { gaps: [0.0, gaps[2], gaps[1], gaps[0]], velocities: [-v[3], -v[2], -v[1], -v[0]] }, 2.0);
        let of = |run: &Run<Line<4>>, flip: bool| -> Vec<(Contact, f64)> {
            let edges = run.trajectory.jumps().iter().map(|jump| (jump.edge().unwrap(), jump.t()));
            edges.map(|(Contact(i), t)| (Contact(if flip { 4 - i } else { i }), t)).collect()
        };
        let (one, two) = (of(&one, false), of(&two, true));
        prop_assert_eq!(one.len(), two.len());
        for (a, b) in one.iter().zip(&two) {
            prop_assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}
