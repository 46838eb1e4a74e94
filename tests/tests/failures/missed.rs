//! Crossings that a search for sign changes between step ends does not see.

use std::ops::ControlFlow;

use saltus::nalgebra::vector;
use saltus::step::{Auto, Dop853, Rodas5P, Tsit5};
use saltus::{Entry, Hybrid, Jump, JumpOf, Observer, Piece, Simulation};

use super::{
    Down, Flight, G, PATHS, Path, Up, Way, assert_crossings, ball, crossings, of_time, throw, watched, watched_affine,
};

/// A search for sign changes between step ends finds one of three roots; they are -6, -2 and 2.
#[test]
fn three_roots_of_a_cubic() {
    let automaton = watched(|t, _y: &f64| 3.0 * t * t + 12.0 * t - 4.0, |_t, y| *y);
    for automaton in [watched_affine(|t, _y: &f64| 3.0 * t * t + 12.0 * t - 4.0, |_t, y| *y), automaton] {
        let run = Simulation::of(&automaton).run("run", -120.0, -8.0..4.0).unwrap();
        assert_crossings(&crossings(&run), &[(-6.0, Up), (-2.0, Down), (2.0, Up)], 1e-12);
    }
}

/// A guard with three zeros on a line that one step covers; 2.5 and 5 are both found.
#[test]
fn a_line_through_a_guard_of_degree_three() {
    let guard = |_t: f64, y: &f64| (2.5 - y) * (5.0 - y) * (0.0 - y);
    let automaton = watched(|_t, _y: &f64| 1.0, guard);
    for (start, expected) in [(-1.0, &[(0.0, Down), (2.5, Up), (5.0, Down)][..]), (0.25, &[(2.5, Up), (5.0, Down)])] {
        for step in [0.1, 1.0, 10.0] {
            let run = Simulation::of(&automaton).first_step(step).run("run", start, start..10.0).unwrap();
            assert_crossings(&crossings(&run), expected, 1e-14);
        }
    }
}

/// Near the apex of a throw two crossings lie milliseconds to nanoseconds apart; both step ends are
/// on one side.
#[test]
fn two_crossings_nine_milliseconds_apart() {
    let cases = [
        (1e-4, 1.005_645_106_512_622_9, 1.014_680_185_541_675_4),
        (1e-8, 1.010_107_370_167_218, 1.010_197_720_957_508_6),
        (1e-12, 1.010_152_092_798_360_4, 1.010_152_996_306_263_2),
    ];
    for path in PATHS {
        for (above, up, down) in cases {
            let v = (2.0 * G * (5.0 + above)).sqrt();
            // The crossing speed turns roundings of a height of 5 m, and of v, into roundings of
            // time.
            let crossing_speed = (2.0 * G * above).sqrt();
            let roundings = if matches!(path, Path::ExactAffine | Path::Exact) { 4.0 } else { 64.0 };
            let tolerance = roundings * 5.0 * f64::EPSILON / crossing_speed;
            assert_crossings(&throw(G, vector![0.0, v], 5.0, 2.0, path), &[(up, Up), (down, Down)], tolerance);
        }
    }
}

/// A throw that just reaches the level, in representable numbers: a touch is no crossing, and no
/// impact.
#[test]
fn a_touch_at_the_apex_is_no_crossing() {
    for path in [Path::ExactAffine, Path::Exact] {
        assert_crossings(&throw(8.0, vector![0.0, 4.0], 1.0, 0.9, path), &[], 0.0);
    }
}

/// A root that lies exactly on the start of the flight hides the impact; launched from zero the
/// ball comes down after 2 v / g.
#[test]
fn a_launch_from_exactly_the_floor() {
    for path in PATHS {
        let automaton = ball(G, 0.5, path);
        let run = Simulation::of(&automaton).run("flight", vector![0.0, 5.0], 0.0..1.2).unwrap();
        let times: Vec<f64> = run.trajectory.jumps().iter().map(Jump::t).collect();
        assert_eq!(times.len(), 1, "{path:?}: {times:?}");
        assert!((times[0] - 1.020_408_163_265_306_1).abs() < 1e-14, "{path:?}: {times:?}");
    }
}

fn crossings_at_dyadic_fractions_on(paths: &[Path], last: i32) {
    for &path in paths {
        for k in (4..=last).step_by(2) {
            let level = 1.0 - 0.5_f64.powi(k);
            let half = 0.5_f64.powi(k / 2 + 1);
            // The slope is 8 half; the height near one is resolved to a quarter of EPSILON, in
            // steps to a few roundings.
            let roundings = if matches!(path, Path::ExactAffine | Path::Exact) { 2.0 } else { 64.0 };
            let tolerance = roundings * 0.25 * f64::EPSILON / (8.0 * half) + f64::EPSILON;
            let deep = 0.5_f64.powi(k) >= 8.0 * f64::EPSILON || matches!(path, Path::ExactAffine);
            if tolerance > 0.5 * half || !deep {
                continue; // closer than the rounding of steps, or of the height: nothing can be said
            }
            let got = throw(8.0, vector![0.0, 4.0], level, 0.9, path);
            assert_crossings(&got, &[(0.5 - half, Up), (0.5 + half, Down)], tolerance);
        }
    }
}

/// Roots on round fractions of the flight are found once each: heights 1 - 2^-k are crossed at
/// 0.5 -+ 2^-(k/2+1).
#[test]
fn crossings_at_dyadic_fractions() {
    crossings_at_dyadic_fractions_on(&[Path::ExactAffine], 48);
}

/// The same on every path, within a few units in the last place of the apex; where a formula tells,
/// within two.
#[test]
fn crossings_at_dyadic_fractions_to_the_last_digit() {
    crossings_at_dyadic_fractions_on(&PATHS, 52);
}

/// One step spans the whole flight and both its ends are below the floor; the impact inside is
/// found without a limit on the step.
#[test]
fn a_flight_inside_one_step() {
    let impact = (5.0 + (25.0_f64 - 2.0 * G * 0.1).sqrt()) / G;
    for path in PATHS {
        let automaton = Hybrid::new()
            .mode("flight", |_t, x: &Flight| vector![x[1], -G])
            .edge_with("flight", "flight", path.edge(|_t, x: &Flight| x[0], |_t, x| *x).terminal())
            .entry(Entry::Wait);
        let automaton = path.prepare(automaton, "flight", super::parabola(G));
        let run = Simulation::of(&automaton)
            .tolerance(1e-3)
            .first_step(3.0)
            .run("flight", vector![-0.1, 5.0], 0.0..3.0)
            .unwrap();
        assert_eq!(run.trajectory.jumps().len(), 1, "{path:?}");
        assert!((run.trajectory.jumps()[0].t() - impact).abs() < 1e-13, "{path:?}: {:?}", run.trajectory.jumps());
        assert!(run.end.stats.steps <= 1, "{path:?}: {:?}", run.end.stats);
    }
}

/// Crossings on the ends of fixed steps are seen twice or not at all; 0.5 and 0.6 are found once
/// each.
#[test]
fn crossings_on_the_ends_of_fixed_steps() {
    let automaton = watched(|_t, _x: &f64| 1.0, |t, _x| (t - 0.5) * (t - 0.6));
    for step in [0.1, 0.05, 0.3, 1.0] {
        let run = Simulation::of(&automaton).first_step(step).longest_step(step).run("run", 0.0, 0.0..1.0).unwrap();
        assert_crossings(&crossings(&run), &[(0.5, Down), (0.6, Up)], 2e-16);
    }
}

fn oscillator(stepper: Auto) -> Vec<(f64, Way)> {
    let automaton = watched(|_t, x: &Flight| vector![x[1], -x[0]], |_t, x| x[0] - 0.999);
    let run = Simulation::of(&automaton).stepper(stepper).tolerance(1e-9).run("run", vector![0.0, 1.0], 0.0..20.0);
    crossings(&run.unwrap())
}

/// A dense output that is completed too late loses events with some methods; every method gives the
/// same list.
#[test]
fn every_method_finds_the_same_crossings() {
    let (turn, first) = (std::f64::consts::TAU, 0.999_f64.asin());
    let expected: Vec<_> = (0..3)
        .flat_map(|n| {
            let whole = turn * f64::from(n);
            [(whole + first, Up), (whole + std::f64::consts::PI - first, Down)]
        })
        .collect();
    for found in [Tsit5.into(), Dop853.into(), Rodas5P.into()].map(oscillator) {
        assert_crossings(&found, &expected, 1e-5);
    }
}

/// A condition that holds for 25 ms between two outputs is not seen at either; it starts a delay
/// that ends at 0.55.
#[test]
fn a_short_condition_between_outputs() {
    let automaton = Hybrid::new()
        .mode("waiting", |_t, _c: &f64| 1.0)
        .edge("waiting", "delay", |t, _c| (t - 0.45) * (t - 0.475), |_t, _c| 0.0)
        .mode("delay", |_t, _c| 1.0)
        .edge("delay", "done", |_t, c| 0.1 - c, |_t, c| *c)
        .mode("done", |_t, _c| 0.0);
    let run = Simulation::of(&automaton).first_step(0.1).run("waiting", 0.0, 0.0..1.0).unwrap();
    let jumps = run.trajectory.jumps();
    assert_eq!((jumps.len(), run.end.mode), (2, "done"));
    assert!((jumps[0].t() - 0.45).abs() < 1e-15 && (jumps[1].t() - 0.55).abs() < 1e-15, "{jumps:?}");
}

/// The condition "time is 10" is met exactly or not at all, depending on the outputs; here always,
/// also at the end of the span.
#[test]
fn a_moment_is_met_whatever_the_steps() {
    for end in [10.0, 10.5, 20.0] {
        for step in [0.1, 0.3, 1.0, 7.0, 100.0] {
            let automaton = Hybrid::new()
                .mode("run", |_t, _x: &f64| 1.0)
                .edge("run", "after", |t, _x| 10.0 - t, |_t, x| *x)
                .mode("after", |_t, _x| 0.0);
            let run = Simulation::of(&automaton).first_step(step).longest_step(step).run("run", 0.0, 0.0..end).unwrap();
            assert_eq!(run.trajectory.jumps().len(), 1, "end {end}, step {step}");
            assert_eq!(run.trajectory.jumps()[0].t(), 10.0);
        }
    }
}

/// Collects jumps while reading the height at every multiple of a period, as an output grid would.
struct Grid {
    period: f64,
    next: u32,
    read: u32,
    jumps: Vec<(u64, u64)>,
}

impl Observer<Hybrid<'static, Flight>> for Grid {
    fn piece(&mut self, _: &'static str, piece: &Piece<'_, Flight>) -> ControlFlow<()> {
        let start = piece.start().seconds();
        while f64::from(self.next) * self.period < start + piece.span() {
            self.read += u32::from(piece.at(f64::from(self.next) * self.period - start)[0].is_finite());
            self.next += 1;
        }
        ControlFlow::Continue(())
    }
    fn jump(&mut self, jump: &JumpOf<Hybrid<'static, Flight>>) -> ControlFlow<()> {
        self.jumps.push((jump.t().to_bits(), jump.after[1].to_bits()));
        ControlFlow::Continue(())
    }
}

/// Events are late by up to an output step, or lost inside one; here the list is the same to the
/// last bit for every grid.
#[test]
fn the_events_do_not_depend_on_the_output() {
    for path in PATHS {
        let automaton = ball(G, 0.8, path);
        let lists = [1e-4, 1e-3, 0.01, 0.1, 1.0].map(|period| {
            let mut grid = Grid { period, next: 0, read: 0, jumps: Vec::new() };
            Simulation::of(&automaton).drive("flight", vector![1.0, 0.0], 0.0..3.0, &mut grid).unwrap();
            assert!(f64::from(grid.read) * period > 2.9);
            grid.jumps
        });
        assert!(lists[0].len() >= 6 && lists.iter().all(|list| *list == lists[0]), "{path:?}");
    }
}

/// A guard cubed has the same crossings, to a third of the digits by interpolation and to all of
/// them by sign.
#[test]
fn a_guard_cubed() {
    for steep in [1, 3] {
        let automaton = watched(|_t, x: &Flight| vector![x[1], -G], move |_t, x| (x[0] - 3.0).powi(steep));
        let run = Simulation::of(&automaton).run("run", vector![0.0, 10.0], 0.0..2.0).unwrap();
        let expected = [(0.365_436_467_923_215_8, Up), (1.675_379_858_607_396_5, Down)];
        assert_crossings(&crossings(&run), &expected, 1e-13);
    }
    let automaton = watched(|_t, x: &Flight| vector![x[1], -G], |_t, x| x[0].powi(3));
    let run = Simulation::of(&automaton).run("run", vector![50.0, 0.0], 0.0..4.0).unwrap();
    assert_crossings(&crossings(&run), &[(3.194_382_824_999_699_6, Down)], 1e-13);
}

/// A guard squared only touches zero: it makes no jump, and the run goes on.
#[test]
fn a_guard_squared_makes_no_jump() {
    let automaton = watched(|_t, x: &Flight| vector![x[1], -G], |_t, x| (x[0] - 3.0).powi(2));
    let run = Simulation::of(&automaton).run("run", vector![0.0, 10.0], 0.0..2.0).unwrap();
    assert_crossings(&crossings(&run), &[], 0.0);
}

/// A guard narrower than any sample of the search but for its zeros: 32 roots of a Chebyshev
/// polynomial in one span.
#[test]
fn thirty_two_crossings_in_one_span() {
    let expected: Vec<(f64, Way)> = (0..32)
        .map(|k| ((f64::from(63 - 2 * k) * std::f64::consts::PI / 64.0).cos(), if k % 2 == 0 { Down } else { Up }))
        .collect();
    let got = of_time(|t| (32.0 * t.clamp(-1.0, 1.0).acos()).cos(), -1.0..1.0);
    assert_crossings(&got, &expected, 1e-14);
}
