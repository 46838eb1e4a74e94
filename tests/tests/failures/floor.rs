//! Falling through the floor, accumulating impacts, plastic and resting contact.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Hybrid, RunOf, Simulation, Stop};
use saltus_bounce::{Ball, Cor, Mode};

use super::{Flight, G, PATHS, Path, ball, lowest, pieces};

fn dropped(e: f64, end: f64, path: Path) -> RunOf<Hybrid<'static, Flight>> {
    // The automaton outlives the run's record, which holds no reference to it.
    let automaton = ball(G, e, path);
    Simulation::of(&automaton).run("flight", vector![1.0, 0.0], 0.0..end).unwrap()
}

/// The times of rest of a ball dropped from 1 m, from the geometric series.
const RESTS: [(f64, usize, f64); 4] = [
    (0.5, 52, 1.355_261_854_357_876_9),
    (0.7, 99, 2.559_939_058_231_545_2),
    (0.8, 0, 4.065_785_563_073_630_6),
    (0.9, 322, 8.583_325_077_599_889),
];

fn a_ball_comes_to_rest_on_every_path_on(paths: &[Path]) {
    for &path in paths {
        for (e, impacts, rest) in RESTS {
            let run = dropped(e, 20.0, path);
            let jumps = run.trajectory.jumps();
            let last = jumps.last().unwrap();
            assert_eq!((last.to, run.end.stop), ("rest", Stop::Time), "{path:?}, e = {e}");
            assert_eq!(jumps.iter().filter(|jump| jump.to == "rest").count(), 1);
            let tolerance = if path == Path::ExactAffine { 4e-15 * rest } else { 1e-13 };
            assert!((last.t() - rest).abs() <= tolerance, "{path:?}, e = {e}: rest at {}", last.t());
            assert_eq!(run.end.state, vector![0.0, 0.0]);
            assert_eq!(run.trajectory.at(rest + 1e-9).unwrap(), vector![0.0, 0.0]);
            assert!(lowest(&run) >= 0.0, "{path:?}, e = {e}: {:e} below the floor", lowest(&run));
            if path == Path::ExactAffine && impacts > 0 {
                assert_eq!(jumps.len(), impacts + 1, "e = {e}");
            }
        }
    }
}

/// A code that waits after each impact falls through the floor once flights are shorter than the
/// wait; here it rests, once, above the floor.
#[test]
fn a_ball_comes_to_rest_on_every_path() {
    a_ball_comes_to_rest_on_every_path_on(&[Path::ExactAffine, Path::Exact]);
}

/// The same by steps, without an exact arc.
#[test]
fn a_ball_comes_to_rest_on_every_path_by_steps() {
    a_ball_comes_to_rest_on_every_path_on(&[Path::Affine, Path::General]);
}

/// Three thousand impacts, the last of them shorter than time resolves.
#[test]
fn a_lively_ball_comes_to_rest() {
    let ball = Ball::new(G, Cor::new(0.99).unwrap()).unwrap();
    let run = Simulation::of(&ball).run(Mode::Flight, Ball::dropped_from(1.0), 0.0..1e3).unwrap();
    let rest = run.trajectory.jumps().last().unwrap();
    assert_eq!(rest.to, Mode::Rest);
    assert!((rest.t() - 89.899_036_339_072_5).abs() < 3e-13, "{}", rest.t());
    assert_eq!(run.trajectory.jumps().len(), 3164);
    assert!(lowest(&run) >= 0.0);
}

fn a_floor_at_any_height_on(paths: &[Path]) {
    for &path in paths {
        for floor in [1.0, -3.7, 1234.5] {
            let automaton = Hybrid::new()
                .mode("flight", |_t, x: &Flight| vector![x[1], -G])
                .edge_with(
                    "flight",
                    "flight",
                    path.edge(move |_t, x: &Flight| x[0] - floor, move |_t, x| vector![floor, -0.5 * x[1]]),
                )
                .mode("rest", |_t, _x| vector![0.0, 0.0])
                .beyond("flight", "rest", move |_t, _x| vector![floor, 0.0]);
            let automaton = path.prepare(automaton, "flight", super::parabola(G));
            let run = Simulation::of(&automaton).run("flight", vector![floor + 1.0, 0.0], 0.0..4.0).unwrap();
            assert_eq!(
                (run.end.mode, run.end.stop),
                ("rest", Stop::Time),
                "{path:?}, floor at {floor}: {:?}",
                run.end.stop
            );
            let rest = run.trajectory.jumps().last().unwrap().t();
            // Heights are resolved to the spacing of numbers at the floor, and so are flights to
            // its root.
            let resolved = 4.0 * (8.0 * f64::EPSILON * (1.0 + floor.abs()) / G).sqrt();
            assert!((rest - 1.355_261_854_357_876_9).abs() < resolved, "{path:?}, floor at {floor}: rest at {rest}");
            assert!(lowest(&run) >= floor, "{path:?}, floor at {floor}: lowest {}", lowest(&run));
        }
    }
}

/// The impacts accumulate on a floor that is not at zero, where rounding hides the flights long
/// before time does.
#[test]
fn a_floor_at_any_height() {
    a_floor_at_any_height_on(&[Path::ExactAffine]);
}

/// The same where the guard is not promised affine, or by steps.
#[test]
fn a_floor_at_any_height_by_steps() {
    a_floor_at_any_height_on(&[Path::Exact, Path::Affine, Path::General]);
}

/// Without rebound a re-armed guard never fires again and the ball falls; here it lies in contact
/// for ever.
#[test]
fn a_plastic_impact_happens_once() {
    for path in PATHS {
        let run = dropped(0.0, 1e4, path);
        let impact = &run.trajectory.jumps()[0];
        assert!((impact.t() - 0.451_753_951_452_625_6).abs() < 1e-14, "{path:?}: {}", impact.t());
        let impacts = run.trajectory.jumps().iter().filter(|jump| jump.edge().is_some()).count();
        assert_eq!((impacts, run.end.mode, run.end.state), (1, "rest", vector![0.0, 0.0]), "{path:?}");
    }
    // With a contact mode of its own: one impact, and the floor carries m g.
    let mass = 0.058;
    let automaton = Hybrid::new()
        .mode("flight", |_t, x: &Flight| vector![x[1], -G])
        .edge("flight", "contact", |_t, x| x[0], |_t, _x| vector![0.0, 0.0])
        .mode("contact", |_t, _x| vector![0.0, 0.0])
        .edge("contact", "flight", move |_t, _x| mass * G, |_t, x| *x);
    let run = Simulation::of(&automaton).run("flight", vector![1.0, 0.0], 0.0..1e4).unwrap();
    assert_eq!((run.trajectory.jumps().len(), run.end.mode, run.end.state), (1, "contact", vector![0.0, 0.0]));
}

/// Lifting the ball by a hair after each impact stores millions of points past the limit; the
/// record is as long as the impacts are many.
#[test]
fn the_record_grows_with_the_impacts_only() {
    for path in PATHS {
        let (short, long) = (dropped(0.8, 4.1, path), dropped(0.8, 1e6, path));
        if matches!(path, Path::ExactAffine | Path::Exact) {
            assert_eq!(short.trajectory.jumps().len(), long.trajectory.jumps().len(), "{path:?}");
        }
        let impacts = long.trajectory.jumps().len();
        assert!(pieces(&long) <= 4 * impacts + 100, "{path:?}: {} pieces for {impacts} impacts", pieces(&long));
    }
}

fn a_ball_stopped_below_a_least_speed_on(paths: &[Path]) {
    for &path in paths {
        let automaton = Hybrid::new()
            .mode("flight", |_t, x: &Flight| vector![x[1], -9.81])
            .edge_with("flight", "flight", path.edge(|_t, x: &Flight| x[0], |_t, x| vector![0.0, -0.7 * x[1]]))
            .edge("flight", "rest", |_t, x| if x[0] == 0.0 { x[1] - 0.1 } else { 1.0 }, |_t, _x| vector![0.0, 0.0])
            .entry(saltus::Entry::Fire)
            .mode("rest", |_t, _x| vector![0.0, 0.0]);
        let automaton = path.prepare(automaton, "flight", super::parabola(9.81));
        let run = Simulation::of(&automaton).run("flight", vector![1.0, 0.0], 0.0..3.0).unwrap();
        let bounces = run.trajectory.jumps().iter().filter(|jump| jump.to == "flight").count();
        let rest = run.trajectory.jumps().last().unwrap();
        assert_eq!((bounces, rest.to), (11, "rest"), "{path:?}");
        assert!((rest.t() - 2.499_113_314_224_620_7).abs() < 1e-13, "{path:?}: {}", rest.t());
    }
}

/// A ball that is stopped below a least speed, against the closed form: eleven impacts.
#[test]
fn a_ball_stopped_below_a_least_speed() {
    a_ball_stopped_below_a_least_speed_on(&[Path::ExactAffine, Path::Exact]);
}

/// The same by steps, without an exact arc.
#[test]
fn a_ball_stopped_below_a_least_speed_by_steps() {
    a_ball_stopped_below_a_least_speed_on(&[Path::Affine, Path::General]);
}

/// A rimless wheel too slow to go on rocks between two legs, each reset swapping the guards; it
/// comes to stand on both.
#[test]
fn a_wheel_that_rocks_comes_to_stand() {
    let (alpha, gamma) = (std::f64::consts::FRAC_PI_8, 0.03);
    let loss = (2.0 * alpha).cos();
    let automaton = Hybrid::new()
        .mode("roll", |_t, x: &Vector2<f64>| vector![x[1], 9.81 * x[0].sin()])
        .edge("roll", "roll", move |_t, x| gamma + alpha - x[0], move |_t, x| vector![x[0] - 2.0 * alpha, loss * x[1]])
        .edge(
            "roll",
            "roll",
            move |_t, x| x[0] - (gamma - alpha),
            move |_t, x| vector![x[0] + 2.0 * alpha, loss * x[1]],
        )
        .mode("stand", |_t, _x| vector![0.0, 0.0])
        .beyond("roll", "stand", |_t, x| vector![x[0], 0.0]);
    let run = Simulation::of(&automaton).run("roll", vector![0.0, 0.5], 0.0..20.0).unwrap();
    assert_eq!((run.end.mode, run.end.stop), ("stand", Stop::Time), "{:?}", run.end.state);
    assert!(run.trajectory.jumps().len() < 1000, "{} jumps", run.trajectory.jumps().len());
    let on_leg = (run.end.state[0] - gamma).abs() - alpha;
    assert!(on_leg.abs() < 1e-12 && run.end.state[1] == 0.0, "{:?}", run.end.state);
}

/// A ball at rest has a guard that stays at zero: no sign changes, so a search alone keeps it on
/// the floor for ever or lets it fall.
#[test]
fn a_resting_ball_is_pulled_off() {
    // The pull F = m g t exceeds the weight from t = 1 on: the force of contact m g (1 - t) falls
    // through zero.
    let automaton = Hybrid::new()
        .mode("contact", |_t, _x: &Flight| vector![0.0, 0.0])
        .edge("contact", "flight", |t, _x| G * (1.0 - t), |_t, x| *x)
        .mode("flight", |t, x| vector![x[1], G * (t - 1.0)])
        .edge("flight", "contact", |_t, x| x[0], |_t, _x| vector![0.0, 0.0]);
    let run = Simulation::of(&automaton).run("contact", vector![0.0, 0.0], 0.0..2.0).unwrap();
    assert_eq!((run.trajectory.jumps().len(), run.end.mode), (1, "flight"), "{:?}", run.trajectory.jumps());
    assert_eq!(run.trajectory.jumps()[0].t(), 1.0);
    assert!(
        (run.end.state[0] - G / 6.0).abs() < 1e-12 && (run.end.state[1] - G / 2.0).abs() < 1e-12,
        "{:?}",
        run.end.state
    );
    assert!(lowest(&run) >= 0.0, "{:e}", lowest(&run));
}

/// The same with the promise that the height is affine in the state.
#[test]
fn a_resting_ball_is_pulled_off_with_an_affine_floor() {
    let automaton = Hybrid::new()
        .mode("contact", |_t, _x: &Flight| vector![0.0, 0.0])
        .edge("contact", "flight", |t, _x| G * (1.0 - t), |_t, x| *x)
        .mode("flight", |t, x| vector![x[1], G * (t - 1.0)])
        .edge("flight", "contact", |_t, x| x[0], |_t, _x| vector![0.0, 0.0])
        .affine();
    let run = Simulation::of(&automaton).run("contact", vector![0.0, 0.0], 0.0..2.0).unwrap();
    assert_eq!((run.trajectory.jumps().len(), run.end.mode), (1, "flight"), "{:?}", run.trajectory.jumps());
    assert!((run.end.state[0] - G / 6.0).abs() < 1e-12, "{:?}", run.end.state);
}

/// A threshold on the impact speed swallows the last visible bounces; here the heights go down by
/// e² each until far below one frame.
#[test]
fn bounces_shrink_evenly_below_one_frame() {
    let run = dropped(0.5, 2.0, Path::ExactAffine);
    let jumps = run.trajectory.jumps();
    let mut flight = 2.0 * 0.451_753_951_452_625_6;
    let mut shown = 0;
    for pair in jumps.windows(2).take_while(|pair| pair[1].edge().is_some()) {
        flight *= 0.5;
        let got = pair[1].time.since(pair[0].time);
        assert!((got - flight).abs() <= 1e-14 * flight, "flight {got} instead of {flight}");
        shown += usize::from(got >= 1.0 / 60.0);
    }
    assert_eq!(shown, 5); // 0.452, 0.226, 0.113, 0.056 and 0.028 s
    // Drawn at 60 frames a second, no frame is above the envelope of its bounce nor below the
    // floor.
    for frame in 0..=120_u32 {
        let t = f64::from(frame) / 60.0;
        let bounce = jumps.iter().filter(|jump| jump.edge().is_some() && jump.t() <= t).count();
        let height = run.trajectory.at(t).unwrap()[0];
        let envelope = 0.25_f64.powi(bounce as i32);
        assert!((0.0..=envelope * (1.0 + 1e-14)).contains(&height), "frame {frame}: {height}");
    }
}

fn an_elastic_ball_keeps_its_height_on(paths: &[Path]) {
    for &path in paths {
        let automaton = ball(G, 1.0, path);
        let run = Simulation::of(&automaton).most_jumps(1000).run("flight", vector![10.0, 0.0], 0.0..1e5).unwrap();
        assert_eq!(run.end.stop, Stop::Jumps { most: 1000 }, "{path:?}");
        // Rounding alone, a walk of a thousand steps of one unit in the last place.
        let allowed = if path == Path::ExactAffine { 1e-13 } else { 1e-11 };
        for jump in run.trajectory.jumps() {
            let apex = jump.after[1] * jump.after[1] / (2.0 * G);
            assert!((apex / 10.0 - 1.0).abs() < allowed, "{path:?}, impact {}: {apex}", jump.j);
        }
    }
}

/// An elastic ball loses height in steps, more with finer ones at times; here a thousand impacts
/// leave it at 10 m.
#[test]
fn an_elastic_ball_keeps_its_height() {
    an_elastic_ball_keeps_its_height_on(&[Path::ExactAffine, Path::Exact]);
}

/// The same by steps, without an exact arc.
#[test]
fn an_elastic_ball_keeps_its_height_by_steps() {
    an_elastic_ball_keeps_its_height_on(&[Path::Affine, Path::General]);
}

/// A rebound that depends on the step gives one height for every COR; here the heights are e² to
/// twelve digits.
#[test]
fn rebounds_are_as_high_as_the_cor_says() {
    for path in PATHS {
        for (e, ratio) in [(0.3, 0.09), (0.5, 0.25), (0.8, 0.64), (0.95, 0.9025)] {
            let run = dropped(e, 1.0, path);
            let v = run.trajectory.jumps()[0].after[1];
            assert!((v * v / (2.0 * G) - ratio).abs() < 1e-12, "{path:?}, e = {e}");
        }
    }
}

/// A ball let go on the floor, with a rest that is a constant and not a flow.
#[test]
fn a_ball_let_go_on_the_floor_stays() {
    for path in PATHS {
        let automaton = ball(G, 0.5, path);
        let run = Simulation::of(&automaton).run("flight", vector![0.0, 0.0], 0.0..10.0).unwrap();
        assert_eq!((run.end.mode, run.end.state, run.end.stop), ("rest", vector![0.0, 0.0], Stop::Time), "{path:?}");
    }
}
