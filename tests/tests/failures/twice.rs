//! Events that fire twice, runs that get stuck or never end.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Entry, ErrorKind, Hybrid, Jump, JumpOf, Observer, Simulation, Stop};

use super::{Down, Flight, G, PATHS, Path, Up, assert_crossings, ball, crossings, of_time, watched, watched_affine};

/// A guard that is not a number in part of the span makes a search loop for ever; here an error
/// names guard, time and state.
#[test]
fn a_guard_that_is_not_a_number() {
    let automaton = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).edge(
        "run",
        "run",
        |_t, x| if (0.3..0.4).contains(x) { f64::NAN } else { 0.5 - x },
        |_t, _x| 0.0,
    );
    let failed = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Guard);
    assert_eq!(failed.error.edge(), Some("run -> run (edge 0)"));
    assert!((failed.error.t() - 0.3).abs() < 0.1 && (0.3..0.4).contains(&failed.error.state()[0]), "{}", failed.error);
}

/// A flow that is singular a few spacings of time before the start asks for ever shorter steps;
/// here the run says so.
#[test]
fn steps_below_the_spacing_of_time() {
    let automaton = Hybrid::new().mode("run", |t: f64, _y: &f64| 1.0 / (t - 1.0));
    let failed = Simulation::of(&automaton).run("run", 0.0, 1.0 + 1e-15..2.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::StepSize, "{}", failed.error);
}

/// Products of guard values underflow when signs are compared by them; values of 1e-300 cross like
/// any other.
#[test]
fn tiny_guard_values() {
    for scale in [1e-300, 1e-160, 1e300] {
        assert_crossings(&of_time(|t| scale * (0.3 - t), 0.0..1.0), &[(0.3, Down)], 1e-16);
        assert_crossings(&of_time(|t| scale * (0.3 - t) * (t - 0.7), 0.0..1.0), &[(0.3, Up), (0.7, Down)], 2e-16);
        let automaton = watched_affine(|_t, _x: &f64| scale, move |_t, x| 0.3 * scale - x);
        let run = Simulation::of(&automaton).run("run", 0.0, 0.0..1.0).unwrap();
        assert_crossings(&crossings(&run), &[(0.3, Down)], 1e-15);
    }
}

/// A crossing at the time of an output is handled before or after it; y' = t mod 1 has y(10) = 5.
#[test]
fn a_sawtooth_with_a_crossing_at_the_output() {
    let automaton = Hybrid::new().mode("run", |_t, x: &Vector2<f64>| vector![1.0, x[0]]).edge(
        "run",
        "run",
        |_t, x| 1.0 - x[0],
        |_t, x| vector![0.0, x[1]],
    );
    let run = Simulation::of(&automaton).run("run", vector![0.0, 0.0], 0.0..10.0).unwrap();
    assert_eq!(run.trajectory.jumps().len(), 10);
    assert!((run.end.state[1] - 5.0).abs() < 1e-14 && run.end.state[0] == 0.0, "{:?}", run.end.state);
    for (n, jump) in run.trajectory.jumps().iter().enumerate() {
        assert!((jump.t() - (n + 1) as f64).abs() <= 4e-15, "{jump:?}");
    }
}

/// Two equal guards each re-arm the other in an endless loop; here both are taken, once each, at
/// one time.
#[test]
fn two_identical_guards() {
    for path in PATHS {
        let automaton = Hybrid::new()
            .mode("run", |_t, x: &Flight| vector![x[1], -G])
            .edge_with("run", "run", path.edge(|_t, x: &Flight| x[0] - 0.5, |_t, x| *x))
            .entry(Entry::Wait)
            .edge_with("run", "run", path.edge(|_t, x: &Flight| x[0] - 0.5, |_t, x| *x))
            .entry(Entry::Wait);
        let automaton = path.prepare(automaton, "run", super::parabola(G));
        let run = Simulation::of(&automaton).run("run", vector![1.0, 0.0], 0.0..1.0).unwrap();
        let places: Vec<usize> = run.trajectory.jumps().iter().map(|jump| jump.edge().unwrap().place).collect();
        assert_eq!(places, [0, 1], "{path:?}: {:?}", run.trajectory.jumps());
        assert_eq!(run.trajectory.jumps()[0].t(), run.trajectory.jumps()[1].t(), "{path:?}");
        assert_eq!(run.end.stop, Stop::Time);
    }
}

/// Two equal guards, the first of which turns the ball round: the second is looked at again and is
/// not taken.
#[test]
fn two_identical_guards_of_which_one_bounces() {
    for path in PATHS {
        let automaton = Hybrid::new()
            .mode("run", |_t, x: &Flight| vector![x[1], -G])
            .edge_with("run", "run", path.edge(|_t, x: &Flight| x[0], |_t, x| vector![0.0, -0.5 * x[1]]))
            .edge_with("run", "run", path.edge(|_t, x: &Flight| x[0], |_t, x| vector![0.0, -0.25 * x[1]]));
        let automaton = path.prepare(automaton, "run", super::parabola(G));
        let run = Simulation::of(&automaton).run("run", vector![1.0, 0.0], 0.0..1.2).unwrap();
        assert!(
            run.trajectory.jumps().iter().all(|jump| jump.edge().unwrap().place == 0),
            "{path:?}: {:?}",
            run.trajectory.jumps()
        );
        assert_eq!(run.trajectory.jumps().len(), 3);
    }
}

/// A reset throws two other guards over at once; they are taken in the order in which they are
/// listed, and the run ends.
#[test]
fn a_reset_that_trips_two_other_guards() {
    let automaton = Hybrid::new()
        .mode("run", |_t, _x: &[f64; 3]| [1.0, 0.0, 0.0])
        .edge("run", "run", |_t, x| 0.5 - x[0], |_t, x| [x[0] - 10.0, -1.0, -1.0])
        .entry(Entry::Fire)
        .edge("run", "run", |_t, x| x[1], |_t, x| [x[0], 1.0, x[2]])
        .entry(Entry::Fire)
        .edge("run", "run", |_t, x| x[2], |_t, x| [x[0], x[1], 1.0])
        .entry(Entry::Fire);
    let run = Simulation::of(&automaton).run("run", [0.0, 1.0, 1.0], 0.0..1.0).unwrap();
    let taken: Vec<_> = run.trajectory.jumps().iter().map(|jump| jump.edge().unwrap().place).collect();
    assert_eq!(taken, [0, 1, 2]);
    assert!(run.trajectory.jumps().iter().all(|jump| jump.t() == run.trajectory.jumps()[0].t()));
    assert!((run.trajectory.jumps()[0].t() - 0.5).abs() < 1e-15);
    assert_eq!(run.end.stop, Stop::Time);
}

/// A reset flips the sign of its own guard while another root lies in the first half of the next
/// search: no bracket breaks.
#[test]
fn a_reset_that_flips_its_own_guard() {
    // The guard is s (0.1 - (x - 1)²), with s turned round by the reset: zeros at 1 -+ sqrt(0.1).
    let root = 0.1_f64.sqrt();
    for step in [0.01, 0.1, 1.0, 10.0] {
        let automaton = Hybrid::new().mode("run", |_t, _x: &Vector2<f64>| vector![1.0, 0.0]).edge(
            "run",
            "run",
            |_t, x| x[1] * ((x[0] - 1.0).powi(2) - 0.1),
            |_t, x| vector![x[0], -x[1]],
        );
        let run = Simulation::of(&automaton).first_step(step).run("run", vector![0.0, 1.0], 0.0..3.0).unwrap();
        let times: Vec<f64> = run.trajectory.jumps().iter().map(Jump::t).collect();
        assert_eq!(times.len(), 2, "{times:?}");
        assert!((times[0] - (1.0 - root)).abs() < 1e-14 && (times[1] - (1.0 + root)).abs() < 1e-14, "{times:?}");
    }
}

/// A crossing less than one spacing of time from a step's end, on either side of it, is one
/// crossing.
#[test]
fn a_crossing_one_spacing_from_a_step_end() {
    for at in [1.0_f64, 0.1, 0.3, 0.7] {
        for moment in [at.next_down().next_down(), at.next_down(), at, at.next_up(), at.next_up().next_up()] {
            let automaton = watched(|_t, _x: &f64| 1.0, move |t, _x| moment - t);
            let simulation = Simulation::of(&automaton).first_step(0.1).longest_step(0.1);
            let run = simulation.run("run", 0.0, 0.0..2.0).unwrap();
            assert_crossings(&crossings(&run), &[(moment, Down)], 0.0);
            // And the end of the span in place of a step's end.
            let run = Simulation::of(&automaton).run("run", 0.0, 0.0..at).unwrap();
            let expected = if moment <= at { &[(moment, Down)][..] } else { &[] };
            assert!(run.trajectory.jumps().len() == 1 || moment >= at, "{moment} before the end {at}");
            assert_crossings(&crossings(&run)[..expected.len()], expected, 0.0);
        }
    }
}

/// Counts what it is told.
#[derive(Default)]
struct Count(usize);

impl Observer<Hybrid<'static, Flight>> for Count {
    fn jump(&mut self, _: &JumpOf<Hybrid<'static, Flight>>) -> std::ops::ControlFlow<()> {
        self.0 += 1;
        std::ops::ControlFlow::Continue(())
    }
}

/// A driver that reports an event at every step counts too many; here one impact is one jump,
/// however short the steps.
#[test]
fn as_many_events_as_impacts() {
    for path in [Path::Affine, Path::General] {
        for step in [1e-3, 0.01, 0.1, 1.0] {
            let automaton = ball(G, 0.8, path);
            let mut count = Count::default();
            let simulation = Simulation::of(&automaton).longest_step(step);
            let ending = simulation.drive("flight", vector![1.0, 0.0], 0.0..3.0, &mut count).unwrap();
            assert_eq!((count.0, ending.jumps), (6, 6), "{path:?}, step {step}");
        }
    }
}

/// A reset that leaves the state one unit in the last place above or below the wall makes the guard
/// fire again at once.
#[test]
fn a_reset_one_unit_off_the_wall() {
    for path in PATHS {
        for left in [1.0_f64.next_down(), 1.0, 1.0_f64.next_up()] {
            let floor = path.edge(|_t, x: &Flight| x[0] - 1.0, move |_t, x| vector![left, -0.8 * x[1]]);
            let automaton =
                Hybrid::new().mode("flight", |_t, x: &Flight| vector![x[1], -G]).edge_with("flight", "flight", floor);
            let automaton = path.prepare(automaton, "flight", super::parabola(G));
            let run = Simulation::of(&automaton).run("flight", vector![2.0, 0.0], 0.0..3.0).unwrap();
            assert_eq!(run.trajectory.jumps().len(), 6, "{path:?}, left at {left:?}: {:?}", run.trajectory.jumps());
            for pair in run.trajectory.jumps().windows(2) {
                let flight = pair[1].t() - pair[0].t();
                assert!((flight - 2.0 * pair[0].after[1] / G).abs() < 1e-13, "{path:?}: {flight}");
            }
        }
    }
}

/// Switching a billion times a second fills memory or never ends; here the run ends with its limit,
/// and says what switched how fast.
#[test]
fn a_thermostat_with_a_hair_of_hysteresis() {
    let (low, high) = (20.0, 20.0 + 1e-9);
    let automaton = Hybrid::new()
        .mode("heating", |_t, x: &f64| 30.0 - x)
        .mode("cooling", |_t, x| 10.0 - x)
        .edge("heating", "cooling", move |_t, x| high - x, |_t, x| *x)
        .edge("cooling", "heating", move |_t, x| x - low, |_t, x| *x);
    let run = Simulation::of(&automaton).most_jumps(10_000).run("heating", 20.0, 0.0..1.0).unwrap();
    assert_eq!(run.end.stop, Stop::Jumps { most: 10_000 });
    let jumps = run.trajectory.jumps();
    assert!(jumps.windows(2).all(|pair| pair[0].to == pair[1].from && pair[0].edge() != pair[1].edge()));
    // Up and down by 1e-9 at 10 degrees a second each; a temperature near 20 is resolved to
    // 3.6e-15.
    let rate = jumps.len() as f64 / run.trajectory.end().seconds();
    assert!((rate / 1e10 - 1.0).abs() < 1e-4, "{rate} switches a second");
}

/// A guard is left alone after its own crossing until it has risen: it falls once, then rises, then
/// falls again.
#[test]
fn crossings_in_turn_without_a_pause() {
    let expected = [(0.25, Down), (0.250_000_01, Up), (0.250_000_02, Down)];
    let got = of_time(|t| (0.25 - t) * (0.250_000_01 - t) * (0.250_000_02 - t), 0.0..1.0);
    assert_crossings(&got, &expected, 1e-15);
}
