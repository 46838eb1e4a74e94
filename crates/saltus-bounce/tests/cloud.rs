//! A handful of balls in a box: laws, and what an event costs.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use proptest::prelude::*;
use saltus::{EndingOf, Simulation, Stop};
use saltus_bounce::cloud::{Swarm, Touch};
use saltus_bounce::line::{Lying, Row};
use saltus_bounce::{Cloud, Cor, Line};
use saltus_cases::cases;

fn cor(e: f64) -> Cor {
    Cor::new(e).unwrap()
}

/// 64 balls on a grid in a box of 8 m, with velocities that no symmetry connects.
fn grid<const D: usize>(columns: usize) -> ([[f64; D]; 64], [[f64; D]; 64]) {
    let centre = |n: usize, k: usize| 8.0 / columns as f64 * ((n / columns.pow(k as u32) % columns) as f64 + 0.5);
    let velocity = |n: usize, k: usize| (1.0 + n as f64 * 0.754_877 + k as f64 * 0.569_84).fract() * 2.0 - 1.0;
    (
        std::array::from_fn(|n| std::array::from_fn(|k| centre(n, k))),
        std::array::from_fn(|n| std::array::from_fn(|k| velocity(n, k))),
    )
}

fn gas<const D: usize>(columns: usize, gravity: f64, end: f64) -> (Cloud<D, 64>, Swarm<D, 64>, EndingOf<Cloud<D, 64>>) {
    let masses = std::array::from_fn(|n| 1.0 + (n % 5) as f64);
    let radii = std::array::from_fn(|n| 0.2 + 0.05 * (n % 4) as f64);
    let pull = std::array::from_fn(|k| if k + 1 == D { -gravity } else { 0.0 });
    let cloud = Cloud::new(masses, radii, cor(1.0)).unwrap().with_gravity(pull).unwrap();
    let cloud = cloud.in_box([0.0; D], [8.0; D], cor(1.0)).unwrap();
    let (centres, velocities) = grid::<D>(columns);
    let start = cloud.placed(centres, velocities).unwrap();
    let ending = Simulation::of(&cloud).drive((), start, 0.0..end, &mut ()).unwrap();
    (cloud, start, ending)
}

/// An elastic gas keeps its energy, in the plane and in space, with gravity and without; no ball
/// leaves the box or enters another.
#[test]
fn a_gas_of_sixty_four() {
    fn check<const D: usize>(columns: usize, gravity: f64) {
        let began = std::time::Instant::now();
        let (cloud, start, end) = gas::<D>(columns, gravity, 10.0);
        let each = began.elapsed() / u32::try_from(end.jumps).unwrap();
        println!("{D} dimensions, g = {gravity}: {} impacts, {each:?} each", end.jumps);
        assert!(end.stop == Stop::Time && end.jumps > 200, "{:?}, {} impacts", end.stop, end.jumps);
        let (before, after) = (cloud.energy(&start), cloud.energy(&end.state));
        assert!((after / before - 1.0).abs() < 1e-13, "{before} {after}");
        for (x, n) in end.state.centres.iter().zip(0..) {
            let radius = 0.2 + 0.05 * f64::from(n % 4);
            assert!(x.iter().all(|&x| x >= radius - 1e-14 && x <= 8.0 - radius + 1e-14));
        }
    }
    let (one, two) = (gas::<2>(8, 0.0, 1.0).2, gas::<2>(8, 0.0, 1.0).2);
    assert_eq!((one.state, one.jumps), (two.state, two.jumps));
    check::<2>(8, 0.0);
    check::<2>(8, 9.81);
    check::<3>(4, 0.0);
    check::<3>(4, 9.81);
}

/// Touches at one time, but for rounding, in the order of their names.
fn in_order(mut touches: Vec<(f64, String)>) -> Vec<(f64, String)> {
    let at_one_time = |one: &(f64, String), next: &(f64, String)| next.0 - one.0 < 1e-12;
    touches.chunk_by_mut(at_one_time).for_each(|touches| touches.sort_by(|one, other| one.1.cmp(&other.1)));
    touches
}

/// From event to event it is the same gas: the first hundred touches agree, in order and in time;
/// and after ten thousand its energy is what it was.
#[test]
fn a_flight_is_the_automaton() {
    fn check<const D: usize>(columns: usize, gravity: f64) {
        let (cloud, start, _) = gas::<D>(columns, gravity, 0.0);
        let run = Simulation::of(&cloud).most_jumps(100).run((), start, 0.0..9.0).unwrap();
        let mut flight = cloud.flight(0.0, start);
        let jumps = run.trajectory.jumps();
        let of_run = jumps.iter().map(|jump| (jump.t(), format!("{:?}", jump.edge())));
        let of_flight = jumps.iter().map(|_| {
            let edge = flight.event(1e3);
            (flight.time().seconds(), format!("{edge:?}"))
        });
        let [of_run, of_flight] = [of_run.collect(), of_flight.collect()].map(in_order);
        for ((t, edge), (other, its)) in of_run.into_iter().zip(of_flight) {
            assert_eq!(edge, its);
            assert!((t - other).abs() < 1e-9, "{t} {other}");
        }
        let began = std::time::Instant::now();
        let count = 10_000;
        assert!((0..count).all(|_| flight.event(1e6).is_some()));
        println!("{D} dimensions, g = {gravity}: {:?} each, by flight", began.elapsed() / count);
        let (before, after) = (cloud.energy(&start), cloud.energy(flight.state()));
        assert!((after / before - 1.0).abs() < 1e-12, "{before} {after}");
        let time = flight.time().seconds();
        assert_eq!((flight.event(time), flight.time().seconds()), (None, time));
    }
    check::<2>(8, 0.0);
    check::<2>(8, 9.81);
    check::<3>(4, 0.0);
    check::<3>(4, 9.81);
}

/// Run, turned round, and run again: the balls are back, as far as chaos lets them.
#[test]
fn elastic_flights_can_be_turned_round() {
    let (cloud, start, end) = gas::<2>(8, 9.81, 0.5);
    let mut back = end.state;
    for v in back.velocities.as_flattened_mut() {
        *v = -*v;
    }
    let home = Simulation::of(&cloud).drive((), back, 0.0..0.5, &mut ()).unwrap();
    assert!(home.jumps == end.jumps && end.jumps > 30, "{}", end.jumps);
    for (a, b) in home.state.centres.as_flattened().iter().zip(start.centres.as_flattened()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// In one dimension a cloud is a line.
#[test]
fn one_dimension() {
    let masses = [1.0, 3.0, 0.5, 2.0];
    let velocities = [1.0, 0.3, -0.2, -1.0];
    let cloud = Cloud::new(masses, [0.1; 4], cor(0.9)).unwrap().in_box([0.0], [8.0], cor(0.9)).unwrap();
    let start = cloud.placed([[1.0], [2.0], [3.5], [5.0]], velocities.map(|v| [v])).unwrap();
    let one = Simulation::of(&cloud).run((), start, 0.0..20.0).unwrap();
    let line = Line::new(masses, cor(0.9)).unwrap().on_floor().up_to_wall(8.0 - 0.8, cor(0.9)).unwrap();
    let row = Row { gaps: [0.9, 0.8, 1.3, 1.3], velocities };
    let other = Simulation::of(&line).run(Lying::NONE, row, 0.0..20.0).unwrap();
    let (a, b) = (one.trajectory.jumps(), other.trajectory.jumps());
    assert!(a.len() == b.len() && a.len() > 15, "{} {}", a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        let place = match a.edge().unwrap() {
            Touch::Balls(_, j) => j,
            Touch::Low { .. } => 0,
            Touch::High { .. } => 4,
        };
        assert_eq!(place, b.edge().unwrap().0);
        assert!((a.t() - b.t()).abs() < 1e-12 * b.t());
    }
}

/// A ball that hits two others at once takes them in order; hit exactly in the corner, both walls.
#[test]
fn simultaneous() {
    let cloud = Cloud::new([1.0], [0.5], cor(1.0)).unwrap().in_box([0.0; 2], [4.0; 2], cor(1.0)).unwrap();
    let start = cloud.placed([[1.5, 1.5]], [[-1.0, -1.0]]).unwrap();
    let run = Simulation::of(&cloud).run((), start, 0.0..2.0).unwrap();
    let jumps = run.trajectory.jumps();
    assert_eq!((jumps.len(), jumps[0].t(), jumps[1].t()), (2, 1.0, 1.0));
    assert_eq!(run.end.state.velocities, [[1.0, 1.0]]);

    let cloud = Cloud::new([1.0; 3], [0.5; 3], cor(1.0)).unwrap();
    let start = cloud.placed([[0.0, 0.0], [2.0, 0.5], [2.0, -0.5]], [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]).unwrap();
    let run = Simulation::of(&cloud).run((), start, 0.0..4.0).unwrap();
    let jumps = run.trajectory.jumps();
    assert!(jumps.len() >= 2 && jumps.iter().all(|jump| (jump.t() - jumps[0].t()).abs() < 1e-15));
    let (before, after) = (cloud.momentum(&start), cloud.momentum(&run.end.state));
    assert!((before[0] - after[0]).abs() < 1e-15 && (before[1] - after[1]).abs() < 1e-15);
}

/// A start with balls in each other or in a wall is refused.
#[test]
fn overlaps() {
    let cloud = Cloud::new([1.0; 2], [0.5; 2], cor(1.0)).unwrap().in_box([0.0; 2], [4.0; 2], cor(1.0)).unwrap();
    let error = cloud.placed([[1.0, 1.0], [1.5, 1.0]], [[0.0; 2]; 2]).unwrap_err();
    assert_eq!(error.to_string(), "balls 0 and 1 overlap by 0.5 m: move them apart");
    let error = cloud.placed([[1.0, 1.0], [3.75, 1.0]], [[0.0; 2]; 2]).unwrap_err();
    assert_eq!(error.to_string(), "ball 1 reaches 0.25 m through a wall of axis 0: move it inside");
    assert!(Cloud::<2, 2>::new([1.0; 2], [0.5, 0.0], cor(1.0)).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(64), failure_persistence: None, ..ProptestConfig::default() })]

    /// Without walls momentum is kept; energy never rises, whatever the masses.
    #[test]
    fn momentum_and_energy(
        logs in prop::array::uniform6(-6.0..6.0_f64), v in prop::array::uniform6(prop::array::uniform3(-1.0..1.0_f64)), e in 0.3..=1.0_f64,
    ) {
        let masses = logs.map(|log| 10.0_f64.powf(log));
        let cloud = Cloud::new(masses, [0.4; 6], cor(e)).unwrap();
        let centres: [[f64; 3]; 6] = std::array::from_fn(|n| [(n % 2) as f64, (n / 2 % 2) as f64, (n / 4) as f64]);
        let inwards = std::array::from_fn(|n| std::array::from_fn(|k| v[n][k] + 0.5 - centres[n][k]));
        let start = cloud.placed(centres, inwards).unwrap();
        let run = Simulation::of(&cloud).most_jumps(1000).run((), start, 0.0..3.0).unwrap();
        let before = cloud.momentum(&start);
        let mut last = cloud.energy(&start);
        let size: f64 = masses.iter().zip(inwards).map(|(m, v): (_, [f64; 3])| m * v.iter().map(|v| v.abs()).sum::<f64>()).sum();
        for jump in run.trajectory.jumps() {
            let after = cloud.momentum(&jump.after);
            prop_assert!(before.iter().zip(after).all(|(a, b)| (a - b).abs() <= 1e-13 * size));
            let energy = cloud.energy(&jump.after);
            prop_assert!(energy <= last * (1.0 + 1e-13));
            last = energy;
        }
        prop_assert!(e < 1.0 || (last / cloud.energy(&start) - 1.0).abs() < 1e-12);
    }
}
