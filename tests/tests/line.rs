//! Several balls on a line: stacks that come to rest, what is kept, and mirrors.

use proptest::prelude::*;
use saltus::{RunOf, Simulation, Stop};
use saltus_bounce::line::{Contact, Lying, Row};
use saltus_bounce::{Cor, Drop, Line};
use saltus_cases::cases;

fn cor(e: f64) -> Cor {
    Cor::new(e).unwrap()
}

fn run<const N: usize>(line: &Line<N>, start: Row<N>, end: f64) -> RunOf<Line<N>> {
    Simulation::of(line).run(Lying::NONE, start, 0.0..end).unwrap()
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
    assert_eq!((run.end.mode, run.end.state), (Lying::balls(1), Row { gaps: [0.0], velocities: [0.0] }));
}

/// A stack of lossy balls comes to rest on the floor, all of it, and lies until it is hit.
#[test]
fn a_stack_comes_to_rest() {
    for e in [0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8] {
        let line = Line::new([1.0, 0.7, 0.5], cor(e)).unwrap().with_gravity(9.81).unwrap().on_floor();
        let run = run(&line, Row { gaps: [1.0, 0.3, 0.2], velocities: [0.0; 3] }, 60.0);
        assert_eq!((run.end.stop, run.end.mode), (Stop::Time, Lying::balls(3)), "e = {e}");
        assert_eq!(run.end.state, Row { gaps: [0.0; 3], velocities: [0.0; 3] });
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
    #![proptest_config(ProptestConfig { cases: cases(64), failure_persistence: None, ..ProptestConfig::default() })]

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

    /// Whatever is stacked and dropped, energy never rises, no ball passes another, and the run
    /// ends as it should. A ball that bounces on one that bounces waits for infinitely many impacts
    /// below it at each of its own: a stack of four may take a million before it lies.
    #[test]
    fn stacks(
        logs in prop::array::uniform4(-1.0..1.0_f64), gaps in prop::array::uniform4(0.0..0.5_f64), e in 0.0..0.8_f64,
    ) {
        let line = Line::new(logs.map(|log| 10.0_f64.powf(log)), cor(e)).unwrap().with_gravity(9.81).unwrap().on_floor();
        let start = Row { gaps, velocities: [0.0; 4] };
        let run = Simulation::of(&line).most_jumps(2_000_000).run(Lying::NONE, start, 0.0..30.0).unwrap();
        prop_assert_eq!((run.end.stop, run.end.mode, run.end.state.velocities), (Stop::Time, Lying::balls(4), [0.0; 4]));
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
        let of = |run: &RunOf<Line<4>>, flip: bool| -> Vec<(Contact, f64)> {
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
