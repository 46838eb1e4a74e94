//! Comparing runs whose jumps differ by a hair.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Closeness, Dop853, Hybrid, Polynomial, RunOf, Simulation};

type Ball = Hybrid<'static, Vector2<f64>>;

fn ball(g: f64, e: f64) -> Ball {
    Hybrid::new().mode("flight", move |_, x: &Vector2<f64>| vector![x[1], -g]).edge(
        "flight",
        "flight",
        |_, x| x[0],
        move |_, x| vector![0.0, -e * x[1]],
    )
}

fn run(ball: &Ball, height: f64, end: f64) -> RunOf<Ball> {
    Simulation::of(ball).stepper(Dop853).tolerance(1e-13).run("flight", vector![height, 0.0], 0.0..end).unwrap()
}

/// Compared at the very time of the third impact, one run has bounced and the other has not.
#[test]
fn at_an_impact_the_difference_at_one_time_means_nothing() {
    let (one, other) = (ball(10.0, 1.0), ball(10.0, 1.0));
    let (one, other) = (run(&one, 45.0, 16.0), run(&other, 45.0 * (1.0 - 1e-12), 16.0));
    let pointwise = (one.trajectory.at(15.0 - 1e-12).unwrap() - other.trajectory.at(15.0 - 1e-12).unwrap())[1].abs();
    assert!((pointwise - 60.0).abs() < 1e-6, "{pointwise}");
    let apart = Closeness::new(1.0, [1.0, 10.0]).until(15.0).distance(&one.trajectory, &other.trajectory);
    assert!(1e-13 < apart && apart < 1e-9, "{apart:e}");
    // The limits at the third impact.
    let third = one.trajectory.jumps()[2];
    assert!((third.before[1] + 30.0).abs() < 1e-9 && (third.after[1] - 30.0).abs() < 1e-9);
}

#[test]
fn a_hair_of_restitution_is_a_hair_of_distance() {
    let closeness = Closeness::new(1.0, [1.0, 1.0]);
    let (a, b) = (ball(9.81, 0.8), ball(9.81, 0.8 + 1e-9));
    let (a, b) = (run(&a, 1.0, 2.0).trajectory, run(&b, 1.0, 2.0).trajectory);
    let impact = a.jumps()[2].t();
    let pointwise = (a.at(impact).unwrap() - b.at(impact).unwrap())[1].abs();
    assert!((pointwise - a.jumps()[2].after[1] * 1.8 / 0.8).abs() < 1e-6, "{pointwise}");
    let apart = closeness.distance(&a, &b);
    assert!(1e-9 < apart && apart < 1e-7, "{apart:e}");
    assert!((closeness.distance(&b, &a) - apart).abs() <= 1e-5 * apart, "symmetric");
    // Ten times the hair, ten times the distance.
    let c = ball(9.81, 0.8 + 1e-8);
    let farther = closeness.distance(&a, &run(&c, 1.0, 2.0).trajectory);
    assert!((farther / apart - 10.0).abs() < 1e-3, "{}", farther / apart);
}

#[test]
fn equal_runs_have_no_distance() {
    let a = ball(9.81, 0.8);
    let (one, other) = (run(&a, 1.0, 6.0), run(&a, 1.0, 6.0)); // to the Zeno limit
    assert!(one.trajectory.jumps().len() > 100);
    assert_eq!(Closeness::new(1.0, [1.0]).distance(&one.trajectory, &other.trajectory), 0.0);
}

/// The lines x = t and x = t + d: between the ends half of d is time and half is state; at the
/// ends, where one line has nothing earlier or later, all of it is state.
#[test]
fn time_and_state_share_the_distance() {
    let line = Hybrid::new().mode("on", |_, _: &f64| 1.0).exact("on", |_, x| Polynomial::from([*x, 1.0]));
    let d = 1e-3;
    let from = |x: f64, t: f64| Simulation::of(&line).run("on", x, t..2.0).unwrap().trajectory;
    let (a, b) = (from(0.0, 0.0), from(d, 0.0));
    for (time, state) in [(1.0, 1.0), (1.0, 3.0), (1e-3, 1.0), (1e-9, 1.0)] {
        let apart = Closeness::new(time, [state]).distance(&a, &b);
        assert!((apart - d / state).abs() < 1e-5 * d / state, "{apart:e}");
    }
    // The same line later: the part that is missing is as far away as it is long.
    let apart = Closeness::new(2.0, [100.0]).distance(&a, &from(0.5, 0.5));
    assert!((apart - 0.25).abs() < 1e-6, "{apart}");
}

/// Two sines d apart in phase: the distance has its peak where they are steepest, between samples,
/// and is d/2 there at equal scales.
#[test]
fn a_peak_between_samples_is_found() {
    let wave = |d: f64| Hybrid::new().mode("on", move |t: f64, _: &f64| (t + d).cos());
    let d = 1e-4;
    let (one, other) = (wave(0.0), wave(d));
    let run =
        |wave, x| Simulation::of(wave).stepper(Dop853).tolerance(1e-13).run("on", x, 0.5..8.0).unwrap().trajectory;
    let (a, b) = (run(&one, 0.5_f64.sin()), run(&other, (0.5 + d).sin()));
    let apart = Closeness::new(1.0, [0.1]).until(7.0).distance(&a, &b);
    // |t - s| = e and |d - (t - s)| = 0.1 e at a slope of one; at the start all of it is state.
    let start = ((0.5 + d).sin() - 0.5_f64.sin()) / 0.1;
    assert!((apart / start - 1.0).abs() < 1e-5, "{apart:e} {start:e}");
}

/// Against a search by brute force over both runs.
#[test]
fn the_distance_is_what_brute_force_finds() {
    let (a, b) = (ball(9.81, 0.8), ball(9.9, 0.75));
    let (a, b) = (run(&a, 1.0, 1.2).trajectory, run(&b, 1.05, 1.2).trajectory);
    let (tau, scales) = (0.3, [1.0, 4.0]);
    let apart = Closeness::new(tau, scales).distance(&a, &b);
    let samples = |run: &saltus::TrajectoryOf<Ball>| -> Vec<Vec<(f64, Vector2<f64>)>> {
        (0..run.arcs().len())
            .map(|index| {
                let pieces = run.pieces(index);
                pieces
                    .flat_map(|p| {
                        let n = 150;
                        (0..=n).map(move |k| {
                            let s = p.span() * f64::from(k) / f64::from(n);
                            (p.start().seconds() + s, p.at(s))
                        })
                    })
                    .collect()
            })
            .collect()
    };
    let (one, other) = (samples(&a), samples(&b));
    let gap = |p: &(f64, Vector2<f64>), q: &(f64, Vector2<f64>)| {
        let x = (p.1 - q.1).abs();
        ((p.0 - q.0).abs() / tau).max(x[0] / scales[0]).max(x[1] / scales[1])
    };
    let from = |one: &[Vec<(f64, Vector2<f64>)>], other: &[Vec<(f64, Vector2<f64>)>]| {
        let nearest = |p, j: usize| other[j].iter().map(|q| gap(p, q)).fold(f64::INFINITY, f64::min);
        one.iter()
            .enumerate()
            .flat_map(|(j, arc)| arc.iter().map(move |p| (p, j)))
            .map(|(p, j)| nearest(p, j))
            .fold(0.0, f64::max)
    };
    assert_eq!(one.len(), other.len());
    let brute = from(&one, &other).max(from(&other, &one));
    assert!((apart / brute - 1.0).abs() < 0.02, "{apart} {brute}");
}

#[test]
fn a_jump_that_the_other_never_makes_is_infinitely_far() {
    let a = ball(10.0, 0.8);
    let (one, other) = (run(&a, 5.0, 1.001), run(&a, 5.0, 0.999)); // the impact is at 1
    let closeness = Closeness::new(1.0, [1.0, 1.0]);
    assert_eq!(closeness.distance(&one.trajectory, &other.trajectory), f64::INFINITY);
    // Up to a horizon that both have in common, all is well.
    assert!(closeness.until(0.99).distance(&one.trajectory, &other.trajectory) < 1e-12);
}

#[test]
fn many_arcs_are_compared_in_reasonable_time() {
    let (a, b) = (ball(9.81, 1.0), ball(9.81 * (1.0 + 1e-9), 1.0));
    let (a, b) = (run(&a, 1.0, 400.0).trajectory, run(&b, 1.0, 400.0).trajectory);
    let apart = Closeness::new(1.0, [1.0, 10.0]).until(399.0).distance(&a, &b);
    assert!(1e-8 < apart && apart < 1e-6, "{apart:e}");
}
