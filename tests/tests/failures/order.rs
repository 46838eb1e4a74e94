//! Crossings at the start, their order, several at one time, and both limits.

use saltus::cross::{Start, first_fall};
use saltus::nalgebra::{Vector2, Vector4, vector};
use saltus::{Automaton, Edges, Entry, ErrorKind, Hybrid, Refusal, Reversed, Simulation, Stop};

use super::{Down, Flight, G, PATHS, Path, Up, assert_crossings, ball, of_time, throw};

/// A crossing at absolute time zero is missed where the spacing of numbers is taken at zero; it is
/// found at exactly zero.
#[test]
fn a_crossing_at_time_zero() {
    assert_crossings(&of_time(|t| -t, -10.0..10.0), &[(0.0, Down)], 0.0);
    assert_crossings(&of_time(|t| t, -10.0..10.0), &[(0.0, Up)], 5e-15);
    assert_crossings(&of_time(|t| -t, -1e-300..10.0), &[(0.0, Down)], 0.0);
}

/// A guard that is zero at the start ends the run at once or is never looked at again; its later
/// crossing fires.
#[test]
fn a_guard_that_is_zero_at_the_start() {
    // Watched in both directions, the rise from zero is a fall of the guard's negative, which is
    // taken at the start.
    assert_crossings(&of_time(|t| t * (2.0 - t), 0.0..3.0), &[(0.0, Up), (2.0, Down)], 5e-16);
    assert_crossings(&of_time(|t| -t.sin(), 0.0..4.0), &[(0.0, Down), (std::f64::consts::PI, Up)], 1e-15);
    for path in PATHS {
        assert_crossings(&throw(G, vector![5.0, 3.0], 5.0, 0.9, path), &[(0.0, Up), (6.0 / G, Down)], 1e-14);
    }
}

fn a_guard_that_falls_from_zero_at_the_start_on(paths: &[Path]) {
    for &path in paths {
        assert_crossings(&throw(G, vector![5.0, -3.0], 5.0, 0.9, path), &[(0.0, Down)], 0.0);
        assert_crossings(&throw(G, vector![5.0, 0.0], 5.0, 0.9, path), &[(0.0, Down)], 0.0);
    }
}

/// A guard that falls from zero at the start is taken there, once.
#[test]
fn a_guard_that_falls_from_zero_at_the_start() {
    a_guard_that_falls_from_zero_at_the_start_on(&[Path::ExactAffine, Path::Exact]);
}

/// The same by steps.
#[test]
fn a_guard_that_falls_from_zero_at_the_start_by_steps() {
    a_guard_that_falls_from_zero_at_the_start_on(&[Path::Affine, Path::General]);
}

/// The order of the list beats the order of time in some codes; the earlier crossing is the first.
#[test]
fn the_earlier_crossing_is_first() {
    for path in PATHS {
        for floor_first in [true, false] {
            let levels = if floor_first { [0.0, 0.9] } else { [0.9, 0.0] };
            let automaton = Hybrid::new()
                .mode("flight", |_t, x: &Flight| vector![x[1], -G])
                .edge_with("flight", "flight", path.edge(move |_t, x: &Flight| x[0] - levels[0], |_t, x| *x).terminal())
                .edge_with(
                    "flight",
                    "flight",
                    path.edge(move |_t, x: &Flight| x[0] - levels[1], |_t, x| *x).terminal(),
                );
            let automaton = path.prepare(automaton, "flight", super::parabola(G));
            let run = Simulation::of(&automaton).first_step(2.0).run("flight", vector![1.0, 0.0], 0.0..2.0).unwrap();
            let Stop::Terminal { edge } = run.end.stop else { unreachable!("{:?}", run.end.stop) };
            assert_eq!(edge.place, usize::from(floor_first), "{path:?}");
            let t = run.trajectory.jumps()[0].t();
            assert!((t - 0.142_857_142_857_142_85).abs() < 1e-14, "{path:?}: {t}");
        }
    }
}

/// Balls that fall side by side, eight of them with the same height.
struct Balls;

impl Automaton for Balls {
    type Mode = ();
    type State = [f64; 16];
    type Edge = usize;

    fn flow(&self, (): (), _t: f64, x: &[f64; 16]) -> [f64; 16] {
        std::array::from_fn(|i| if i % 2 == 0 { x[i + 1] } else { -G })
    }
    fn edges(&self, (): ()) -> Edges<'_, usize> {
        Edges::indexed(8, |i| i)
    }
    fn guard(&self, edge: usize, _t: f64, x: &[f64; 16]) -> f64 {
        x[2 * edge]
    }
    fn reset(&self, (): (), edge: usize, _t: f64, x: &[f64; 16]) -> Result<((), [f64; 16]), Refusal> {
        let mut after = *x;
        (after[2 * edge], after[2 * edge + 1]) = (0.0, -0.5 * x[2 * edge + 1]);
        Ok(((), after))
    }
}

/// Backwards, guards a hair apart come in the wrong order, and a start exactly on one raises; here
/// 2e-8, then 1e-8, then 0.
#[test]
fn backwards_through_three_guards_close_together() {
    let levels = [("a", "b", 0.0), ("b", "c", 1e-8), ("c", "d", 2e-8)];
    for exact in [true, false] {
        let clock = levels.into_iter().fold(Hybrid::new().mode("d", |_t, _x: &f64| 1.0), |clock, (from, to, level)| {
            clock
                .mode(from, |_t, _x| 1.0)
                .edge(from, to, move |_t, x| level - x, |_t, x| *x)
                .inverse(move |_t, x| x - level, |_t, x| *x)
        });
        let line = |_t: f64, x: &f64| [*x, 1.0].into();
        let clock = if exact {
            ["a", "b", "c", "d"].into_iter().fold(clock, |clock, mode| clock.exact(mode, line))
        } else {
            clock
        };
        let back = |start: f64| {
            let run = Simulation::of(&Reversed::of(&clock)).run("d", start, Reversed::span(start, -1.0)).unwrap();
            assert_eq!((run.end.mode, run.end.stop), ("a", Stop::Time));
            run.trajectory.jumps().iter().map(|jump| -jump.t()).collect::<Vec<_>>()
        };
        for start in [1.0, 2e-8] {
            let t = back(start);
            assert!(
                t.len() == 3 && t.iter().zip([2e-8, 1e-8, 0.0]).all(|(t, at)| (t - at).abs() < 1e-15),
                "{start}: {t:?}"
            );
        }
    }
}

/// Of many crossings at one time some are lost or applied to the wrong group; every ball bounces,
/// once, at the same time.
#[test]
fn eight_balls_land_together() {
    let start = std::array::from_fn(|i| if i % 2 == 0 { 1.0 } else { 0.0 });
    let run = Simulation::of(&Balls).run((), start, 0.0..0.6).unwrap();
    let jumps = run.trajectory.jumps();
    assert_eq!(jumps.iter().filter_map(|jump| jump.edge()).collect::<Vec<_>>(), (0..8).collect::<Vec<_>>());
    assert!(jumps.iter().all(|jump| jump.t() == jumps[0].t()), "{jumps:?}");
    // The same but for rounding: each bounces from where the one before left the others.
    let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
    let [height, speed] = [run.end.state[0], run.end.state[1]];
    assert!(
        speed > 0.0 && run.end.state.chunks(2).all(|ball| near(ball[0], height) && near(ball[1], speed)),
        "{:?}",
        run.end.state
    );
}

/// Two groups land at their own times: each gets its own flags.
#[test]
fn two_groups_land_in_turn() {
    let start = std::array::from_fn(|i| {
        if i % 2 == 1 {
            0.0
        } else if i < 8 {
            1.0
        } else {
            0.5
        }
    });
    let run = Simulation::of(&Balls).run((), start, 0.0..0.5).unwrap();
    let taken: Vec<usize> = run.trajectory.jumps().iter().filter_map(|jump| jump.edge()).collect();
    assert_eq!(taken, [4, 5, 6, 7, 0, 1, 2, 3]);
    let (low, high) = ((1.0_f64 / G).sqrt(), (2.0_f64 / G).sqrt());
    for jump in run.trajectory.jumps() {
        let expected = if jump.edge().unwrap() >= 4 { low } else { high };
        assert!((jump.t() - expected).abs() < 1e-13, "{jump:?}");
    }
}

/// A root is reported, not its sides, and the two ends come out swapped; here they are neighbours
/// with the right signs.
#[test]
fn the_bracket_is_two_neighbours() {
    let guards: [fn(f64) -> f64; 5] = [
        |s| 6.207 - s,
        |s| (0.3 * s).cos(),
        |s| (6.207 - s).powi(3),
        |s| 1.0 - s.exp() / 500.0,
        |s| (6.207 - s) * (s + 1e-3),
    ];
    for (k, guard) in guards.into_iter().enumerate() {
        let crossing = first_fall(guard, 10.0, Start::Open).unwrap().fall.unwrap();
        assert_eq!(crossing.inside.next_up(), crossing.outside, "guard {k}");
        assert!(guard(crossing.inside) >= 0.0 && guard(crossing.outside) < 0.0, "guard {k}: {crossing:?}");
        assert!(crossing.inside <= crossing.root && crossing.root <= crossing.outside, "guard {k}: {crossing:?}");
    }
}

/// A ball in a corner meets both walls at one time; one instant, two jumps, and the same result in
/// either order.
#[test]
fn both_walls_of_a_corner() {
    let wall = |x_first: bool| {
        let flow = |_t: f64, x: &Vector4<f64>| vector![x[2], x[3], 0.0, 0.0];
        let (first, second) = if x_first { (0, 1) } else { (1, 0) };
        let automaton = Hybrid::new().mode("run", flow);
        [first, second].into_iter().fold(automaton, |automaton, k: usize| {
            automaton.edge(
                "run",
                "run",
                move |_t, x: &Vector4<f64>| x[k],
                move |_t, x| {
                    let mut after = *x;
                    (after[k], after[k + 2]) = (0.0, -x[k + 2]);
                    after
                },
            )
        })
    };
    for (vx, vy) in [(-1.0, -2.0), (-2.0, -1.0), (-0.7, -0.3)] {
        let [one, two] = [true, false].map(|x_first| {
            let automaton = wall(x_first);
            let start = vector![-0.5 * vx, -0.5 * vy, vx, vy];
            let run = Simulation::of(&automaton).run("run", start, 0.0..1.0).unwrap();
            let times: Vec<f64> = run.trajectory.jumps().iter().map(saltus::Jump::t).collect();
            assert_eq!(times.len(), 2, "{times:?}");
            assert!(times[0] == times[1] && (times[0] - 0.5).abs() <= 1.2e-16, "{times:?}");
            run.end.state
        });
        assert!((one - two).norm() < 1e-15, "{one:?} {two:?}");
        assert!((one - vector![-0.5 * vx, -0.5 * vy, -vx, -vy]).norm() < 1e-15, "{one:?}");
    }
}

/// Compared at the time of an impact the velocities are those before or after it; h = 45, g = 10:
/// impacts at 3, 9 and 15.
#[test]
fn both_limits_at_an_impact() {
    for path in PATHS {
        let automaton = ball(10.0, 1.0, path);
        let run = Simulation::of(&automaton).run("flight", vector![45.0, 0.0], 0.0..15.0 + 1e-9).unwrap();
        let jumps = run.trajectory.jumps();
        assert_eq!(jumps.len(), 3, "{path:?}");
        for (jump, t) in jumps.iter().zip([3.0, 9.0, 15.0]) {
            assert!((jump.t() - t).abs() < 2e-13, "{path:?}: {jump:?}");
            assert!(
                (jump.before[1] + 30.0).abs() < 1e-12 && (jump.after[1] - 30.0).abs() < 1e-12,
                "{path:?}: {jump:?}"
            );
            assert_eq!(run.trajectory.before(jump.t()).unwrap(), jump.before);
            assert_eq!(run.trajectory.at(jump.t()).unwrap(), jump.after);
        }
    }
}

/// A root between the time asked for and the end of the step inside is lost; it is found in the
/// next run, and in its direction only.
#[test]
fn a_root_after_the_time_asked_for() {
    let automaton = Hybrid::new()
        .mode("run", |_t, x: &Vector2<f64>| vector![x[1], -x[0]])
        .terminal("run", |_t, x| x[0] - 0.5)
        .entry(Entry::Wait);
    let simulation = Simulation::of(&automaton).first_step(1.0);
    // x = cos t falls through 0.5 at pi/3, rises at 5 pi/3, falls again at 7 pi/3.
    let early = simulation.run("run", vector![1.0, 0.0], 0.0..1.0).unwrap();
    assert_eq!((early.end.stop, early.trajectory.jumps().len()), (Stop::Time, 0));
    let next = simulation.run("run", early.end.state, 1.0..4.0).unwrap();
    assert!((next.trajectory.jumps()[0].t() - std::f64::consts::FRAC_PI_3).abs() < 1e-8);
    let after = simulation.run("run", next.end.state, next.trajectory.end().seconds()..10.0).unwrap();
    // A new run begins on the wall, falling: the first fall is the one it starts at, at most; no
    // rise is taken.
    let times: Vec<f64> = after.trajectory.jumps().iter().map(saltus::Jump::t).collect();
    assert_eq!(times.len(), 1, "{times:?}");
    let rising = simulation.run("run", vector![0.4, 0.9], 0.0..1.0).unwrap();
    assert_eq!(rising.trajectory.jumps().len(), 0, "rises through 0.5 within 0.2 s");
}

/// A state changed between two runs so that a guard is already negative is passed over; here the
/// model decides, and refuses unless told.
#[test]
fn a_state_changed_to_violate_a_guard() {
    for (entry, outcome) in [(Entry::Refuse, None), (Entry::Fire, Some(1)), (Entry::Wait, Some(0))] {
        let automaton = Hybrid::new()
            .mode("filling", |_t, _x: &f64| 1.0)
            .edge("filling", "full", |_t, x| 2.0 - x, |_t, x| *x)
            .entry(entry)
            .mode("full", |_t, _x| 0.0);
        let simulation = Simulation::of(&automaton);
        let first = simulation.run("filling", 0.0, 0.0..1.0).unwrap();
        assert!((first.end.state - 1.0).abs() < 1e-14);
        match (simulation.run("filling", first.end.state + 5.0, 1.0..2.0), outcome) {
            (Err(failed), None) => assert_eq!(failed.error.kind(), ErrorKind::Entry),
            (Ok(run), Some(jumps)) => {
                assert_eq!(run.trajectory.jumps().len(), jumps);
                assert!(run.trajectory.jumps().iter().all(|jump| jump.t() == 1.0));
            }
            (result, outcome) => unreachable!("{entry:?}: {result:?} instead of {outcome:?}"),
        }
    }
}
