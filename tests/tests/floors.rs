//! Balls among walls: inclines, boxes, stairs, lifts, curved ground, contact and its end, each
//! against a closed form.

use std::f64::consts::TAU;

use proptest::prelude::{Just, Strategy};
use proptest::prop_oneof;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use saltus::nalgebra::{Vector2, Vector3, vector};
use saltus::{Auto, Dop853, Rodas5P, Simulation, State, Stop, Tsit5};
use saltus_bounce::effects::{Gravity, LinearDrag, Wind};
use saltus_bounce::friction::Friction;
use saltus_bounce::walls::{Cuboid, Face, Lift, MOST_FACES, Plane, Round, Stairs, Table, Walls};
use saltus_bounce::{Block, Cor, Event, Flyer, Moving, Rolls, Sphere, Stance};
use saltus_scene::Scene;

const FLOOR: Face = Face { cell: 0, index: 0 };

fn cor(e: f64) -> Cor {
    Cor::new(e).unwrap()
}

fn gravity(g: f64) -> Gravity {
    Gravity::new(g).unwrap()
}

/// A block on an incline, shot up it: it slides, stops, and stays or slides back as friction
/// decides.
#[test]
fn a_block_shot_up_an_incline() {
    let (g, angle, v) = (9.81_f64, 0.5_f64, 3.0);
    let up = vector![angle.cos(), angle.sin()];
    for mu in [0.0, 0.2, 0.5, 0.6, 1.0] {
        let block = Block::new(mu).unwrap();
        let ball = Flyer::gripped(gravity(g), Plane::incline(angle).unwrap(), cor(0.5), block).unwrap();
        let (stance, x) = ball.lying(FLOOR, 0.0, Moving::new(vector![0.0, 0.0], up * v));
        let run = Simulation::of(&ball).run(stance, x, 0.0..3.0).unwrap();
        assert_eq!(run.end.stats.steps, 0);
        let (rise, hold) = (g * (angle.sin() + mu * angle.cos()), g * (angle.sin() - mu * angle.cos()));
        let stops = v / rise;
        let top = 0.5 * v * stops;
        let down = if hold > 0.0 { 0.5 * hold * (3.0 - stops).powi(2) } else { 0.0 };
        assert!((run.end.state.position.dot(&up) - (top - down)).abs() < 1e-13, "mu = {mu}: {run:?}");
        if mu > 0.0 {
            assert!((run.trajectory.jumps()[0].t() - stops).abs() < 1e-15);
            assert_eq!(matches!(run.end.mode, Stance::Hold { .. }), hold <= 0.0, "mu = {mu}");
        }
    }
}

/// A ball set down sliding begins to roll after v/(7/2 μ g), at 5/7 of its speed (a solid sphere);
/// on a slope it rolls at 5/7 of what slides.
#[test]
fn from_sliding_to_rolling() {
    let (g, mu, radius) = (9.81, 0.3, 0.1);
    let grip = Rolls { ball: Sphere::solid(radius, 1.0).unwrap(), friction: Friction::rigid(mu).unwrap() };
    let ball = Flyer::gripped(gravity(g), Plane::floor(0.0).unwrap(), cor(0.5), grip).unwrap();
    let (stance, x) = ball.lying(FLOOR, 0.0, Moving::new(vector![0.0, 0.0], vector![7.0, 0.0]).spinning(0.0));
    let run = Simulation::of(&ball).run(stance, x, 0.0..3.0).unwrap();
    let rolls = &run.trajectory.jumps()[0];
    assert!((rolls.t() - 2.0 / (mu * g)).abs() < 1e-15);
    assert!((run.end.state.velocity[0] - 5.0).abs() < 1e-14 && (run.end.state.spin + 5.0 / radius).abs() < 1e-12);
    assert_eq!((run.end.mode, run.end.stats.steps), (Stance::Hold { face: FLOOR }, 0));

    for (angle, rolls) in [(0.5_f64, true), (0.9, false)] {
        // It rolls where (2/7) tan α ≤ μ.
        let ball = Flyer::gripped(gravity(g), Plane::incline(-angle).unwrap(), cor(0.5), grip).unwrap();
        let (stance, x) = ball.lying(FLOOR, 0.0, Moving::new(vector![0.0, 0.0], vector![0.0, 0.0]).spinning(0.0));
        let run = Simulation::of(&ball).run(stance, x, 0.0..1.0).unwrap();
        let a = if rolls { 5.0 / 7.0 * g * angle.sin() } else { g * (angle.sin() - mu * angle.cos()) };
        assert_eq!(matches!(run.end.mode, Stance::Hold { .. }), rolls);
        assert!((run.end.state.velocity.norm() - a).abs() < 1e-14, "{:?}", run.end.state);
    }
}

/// In space a ball that slides across its spin bends until it rolls, along the direction that
/// impulse and angular momentum give.
#[test]
fn a_billiard_ball_with_side_spin() {
    let (g, mu, radius) = (9.81, 0.2, 0.03);
    let grip = Rolls { ball: Sphere::solid(radius, 0.2).unwrap(), friction: Friction::rigid(mu).unwrap() };
    let ball = Flyer::gripped(gravity(g), Plane::<3>::floor(0.0).unwrap(), cor(0.5), grip).unwrap();
    let start = Moving::new(vector![0.0, 0.0, 0.0], vector![2.0, 0.0, 0.0]).spinning(vector![-40.0, 0.0, 5.0]);
    let (stance, x) = ball.lying(FLOOR, 0.0, start);
    let run = Simulation::of(&ball).tolerance(1e-12).run(stance, x, 0.0..3.0).unwrap();
    // The slip keeps its direction, so the path is a parabola; v ends as (5 v + 2 R n×ω... )/7 of
    // the start.
    let rolls = vector![2.0 * 5.0 / 7.0, 40.0 * radius * 2.0 / 7.0, 0.0];
    assert_eq!(run.end.mode, Stance::Hold { face: FLOOR });
    assert!((run.end.state.velocity - rolls).norm() < 1e-9, "{:?}", run.end.state);
    let slip = vector![2.0, -40.0 * radius, 0.0].norm();
    assert!((run.trajectory.jumps()[0].t() - slip * 2.0 / 7.0 / (mu * g)).abs() < 1e-9);
    assert_eq!(run.end.state.spin[2], 5.0);
}

/// A ball in a bowl slides for ever; one on a hilltop slides off, and leaves a sphere at the height
/// 2R/3 (cos = 2/3).
#[test]
fn curved_ground() {
    let (g, radius) = (9.81, 0.5);
    let hill = Round::obstacle(vector![0.0, 0.0], radius).unwrap();
    let ball = Flyer::new(gravity(g), hill, cor(0.5)).unwrap();
    let off = 1e-3_f64;
    let start = Moving::new(vector![radius * off.sin(), radius * off.cos()], vector![0.0, 0.0]);
    let (stance, x) = ball.lying(FLOOR, 0.0, start);
    let run = Simulation::of(&ball).stepper(Auto::from(Dop853)).tolerance(1e-12).run(stance, x, 0.0..4.0).unwrap();
    let leave = &run.trajectory.jumps()[0];
    assert!(matches!(leave.edge(), Some(Event::Leave(_))));
    assert!((leave.after.position[1] / radius - 2.0 / 3.0 * off.cos()).abs() < 1e-9, "{leave:?}");
    assert!((leave.after.position.norm() - radius).abs() < 1e-12);

    let bowl = Flyer::new(gravity(g), Round::bowl(vector![0.0, 0.0], radius).unwrap(), cor(0.5)).unwrap();
    let start = Moving::new(vector![0.3, 0.0], vector![0.0, 0.0]);
    let run = Simulation::of(&bowl)
        .stepper(Auto::from(Dop853))
        .tolerance(1e-11)
        .run(Stance::FLIGHT, start, 0.0..20.0)
        .unwrap();
    assert!(matches!(run.end.mode, Stance::Slide { .. }), "{:?}", run.end.mode);
    assert!((run.end.state.position.norm() - radius).abs() < 1e-8);
}

/// On curved ground in space the normal turns on the way: what rolls goes on rolling, spinning or
/// not.
#[test]
fn rolling_in_a_bowl() {
    let (g, mu, size, radius) = (9.81, 0.9, 0.5, 0.02);
    let body = Sphere::hollow(radius, 0.1).unwrap();
    let grip = Rolls { ball: body, friction: Friction::rigid(mu).unwrap() };
    let bowl = Round::bowl(vector![0.0, 0.0, 0.0], size).unwrap();
    let ball = Flyer::gripped(gravity(g), bowl, cor(0.5), grip).unwrap();
    for about in [0.0, 5.0] {
        // Along the bowl, level; it rolls, and spins besides.
        let (normal, velocity) = (-vector![0.6, 0.0, -0.8], vector![0.0, 1.2, 0.0]);
        let spin = normal.cross(&velocity) / radius + normal * about;
        let start = Moving::new(vector![0.3, 0.0, -0.4], velocity).spinning(spin);
        let energy = |x: &Moving<3, Vector3<f64>>| {
            0.5 * x.velocity.norm_squared()
                + 0.5 * body.inertia_factor() * radius * radius * x.spin.norm_squared()
                + g * x.position[2]
        };
        let (stance, x) = ball.lying(FLOOR, 0.0, start);
        assert_eq!(stance, Stance::Hold { face: FLOOR });
        let run = Simulation::of(&ball).tolerance(1e-12).run(stance, x, 0.0..3.0).unwrap();
        assert_eq!(run.end.mode, stance, "{:?}", run.trajectory.jumps());
        let n = -run.end.state.position / size;
        let slip = run.end.state.velocity - run.end.state.spin.cross(&n) * radius;
        assert!(slip.norm() < 1e-8, "slips by {} m/s, spinning by {about}", slip.norm());
        assert!((energy(&run.end.state) - energy(&x)).abs() < 1e-9, "{}", energy(&run.end.state) - energy(&x));
        assert!((run.end.state.position.norm() - size).abs() < 1e-9);
        // It has not stayed level, where the normal would turn about the vertical only.
        assert!((run.end.state.position[2] + 0.4).abs() > 1e-3);
    }
}

/// A ball that rolls off a hill begins to slip before it leaves. In space as in the plane, where a
/// slip has one direction; and elsewhere by any stepper alike.
#[test]
fn a_ball_that_rolls_off_a_hill() {
    let (g, mu, size, radius) = (9.81, 0.3, 1.0, 0.02);
    let grip = Rolls { ball: Sphere::solid(radius, 0.1).unwrap(), friction: Friction::rigid(mu).unwrap() };
    let plane = {
        let hill = Round::obstacle(vector![0.0, 0.0], size).unwrap();
        let ball = Flyer::gripped(gravity(g), hill, cor(0.5), grip).unwrap();
        let start = Moving::new(vector![0.0, size], vector![0.4, 0.0]).spinning(-0.4 / radius);
        let (stance, x) = ball.lying(FLOOR, 0.0, start);
        Simulation::of(&ball).stepper(Auto::from(Dop853)).tolerance(1e-13).run(stance, x, 0.0..1.0).unwrap()
    };
    let hill = Round::obstacle(vector![0.0, 0.0, 0.0], size).unwrap();
    let ball = Flyer::gripped(gravity(g), hill, cor(0.5), grip).unwrap();
    let across = |at: Vector3<f64>, v: Vector3<f64>| {
        let start = Moving::new(at, v).spinning((at / size).cross(&v) / radius);
        ball.lying(FLOOR, 0.0, start)
    };
    // Down a meridian that no axis knows.
    let down = vector![0.6, 0.8, 0.0];
    let (stance, x) = across(vector![0.0, 0.0, size], down * 0.4);
    let run = Simulation::of(&ball).stepper(Auto::from(Dop853)).tolerance(1e-13).run(stance, x, 0.0..1.0).unwrap();
    let is = |event: Option<&Event<3>>, wanted: &str| event.is_some_and(|e| format!("{e:?}").starts_with(wanted));
    let when = |wanted: &str| run.trajectory.jumps().iter().find(|j| is(j.edge().as_ref(), wanted)).unwrap().t();
    let flat = |wanted: &str| {
        let jumps = plane.trajectory.jumps();
        jumps.iter().find(|j| j.edge().is_some_and(|e| format!("{e:?}").starts_with(wanted))).unwrap().t()
    };
    assert!((when("Slip") - flat("Slip")).abs() < 1e-10 && (when("Leave") - flat("Leave")).abs() < 1e-10);
    assert!(when("Slip") < when("Veer") && when("Veer") < when("Leave"));
    assert!((run.end.state.velocity.dot(&down) - plane.end.state.velocity[0]).abs() < 1e-9);
    assert!((run.end.state.velocity[2] - plane.end.state.velocity[1]).abs() < 1e-9);
    assert!((run.end.state.spin.norm() - plane.end.state.spin.abs()).abs() < 1e-7, "{:?}", run.end.state.spin);

    // Across the hill the push turns on the way.
    let (stance, x) = across(vector![0.6, 0.0, 0.8], vector![-0.3, 0.9, 0.225]);
    let best = Simulation::of(&ball).stepper(Auto::from(Dop853)).tolerance(1e-13).run(stance, x, 0.0..0.8).unwrap();
    assert!(
        matches!(best.end.mode, Stance::Flight { .. }) && best.trajectory.jumps().len() == 3,
        "{:?}",
        best.end.mode
    );
    let off = |x: &Moving<3, Vector3<f64>>| {
        (x.velocity - best.end.state.velocity).norm() + (x.spin - best.end.state.spin).norm() * radius
    };
    let explicit = Simulation::of(&ball).stepper(Auto::from(Tsit5)).tolerance(1e-10).run(stance, x, 0.0..0.8).unwrap();
    let stiff = Simulation::of(&ball).stepper(Auto::from(Rodas5P)).tolerance(1e-8).run(stance, x, 0.0..0.8).unwrap();
    assert!(
        off(&explicit.end.state) < 1e-8 && off(&stiff.end.state) < 1e-6,
        "{} {}",
        off(&explicit.end.state),
        off(&stiff.end.state)
    );
    assert!(
        explicit.end.stats.steps < 2000 && stiff.end.stats.steps < 2000,
        "{} {}",
        explicit.end.stats.steps,
        stiff.end.stats.steps
    );
}

/// Wind presses a block on a table that shakes: it holds while μ(g + h'' + k h') > k w, slips from
/// where that ends, and not before.
#[test]
fn a_block_that_slips_when_the_table_sinks() {
    let (g, mu, rate, wind) = (9.81, 0.4, 0.5, 5.0);
    let (amplitude, omega) = (0.005, 30.0);
    let blown = Wind::new(vector![wind, 0.0], LinearDrag::new(rate).unwrap()).unwrap();
    let table = Table::new(amplitude, omega).unwrap();
    let ball = Flyer::gripped((gravity(g), blown), table, cor(0.0), Block::new(mu).unwrap()).unwrap();
    let (stance, x) = ball.lying(FLOOR, 0.0, Moving::new(vector![0.0, 0.0], vector![0.0, 0.0]));
    assert_eq!(stance, Stance::Hold { face: FLOOR });
    let run = Simulation::of(&ball).tolerance(1e-12).run(stance, x, 0.0..0.2).unwrap();
    let slip = &run.trajectory.jumps()[0];
    let most = amplitude * omega * omega.hypot(rate);
    let known = ((rate / omega).atan() + ((g - rate * wind / mu) / most).asin()) / omega;
    assert!(matches!(slip.edge(), Some(Event::Slip(_))) && (slip.t() - known).abs() < 1e-12, "{slip:?}, {known}");
    // x'' = k (w - x') - μ(g + h'' + k h') until the slip ends.
    let stop = &run.trajectory.jumps()[1];
    assert!(matches!(stop.edge(), Some(Event::Stop { .. })), "{stop:?}");
    let (t, mut v) = (stop.t() - slip.t(), 0.0);
    for k in 0..10_000 {
        let rates = |t: f64, v: f64| {
            let (sin, cos) = (omega * (slip.t() + t)).sin_cos();
            let pressed = g + amplitude * omega * (rate * cos - omega * sin);
            rate * (wind - v) - mu * pressed
        };
        let h = t / 1e4;
        let now = f64::from(k) * h;
        v += h * rates(now + 0.5 * h, v + 0.5 * h * rates(now, v));
    }
    assert!(v.abs() < 1e-9 && t > 0.01, "{v} m/s after {t} s");
    assert_eq!(stop.to, Stance::Hold { face: FLOOR });
}

/// Down the stairs: each impact is on a tread or on a riser where there is one, and nothing is ever
/// inside a step.
#[test]
fn stairs() {
    let stairs = Stairs::down(5, 1.0, 0.3, 0.2).unwrap();
    let inside = |p: &Vector2<f64>| p[1] < 1.0 - 0.2 * (p[0] / 0.3).floor().clamp(0.0, 5.0) - 1e-12;
    for e in [0.0, 0.3, 0.7, 0.9] {
        for u in [0.2, 0.7, 1.0, 2.5, -0.4] {
            let ball = Flyer::new(gravity(9.81), stairs.clone(), cor(e)).unwrap();
            let start = Moving::new(vector![0.1, 1.4], vector![u, 0.0]);
            let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..40.0).unwrap();
            assert_eq!((run.end.stop, run.end.stats.steps), (Stop::Time, 0));
            for k in 0..1200 {
                let x = run.trajectory.at(0.01 * f64::from(k)).unwrap();
                assert!(!inside(&x.position), "e = {e}, u = {u}: {x:?}");
            }
            if u > 0.0 {
                assert_eq!(run.end.mode.cell(), 5, "e = {e}, u = {u}: down to the last");
                assert!(
                    (run.end.state.velocity - vector![u, 0.0]).norm() < 1e-9,
                    "e = {e}, u = {u}: {:?}",
                    run.end.state
                );
            }
        }
    }
    // Up against a riser, along a tread that it slides on; and exactly onto an edge.
    let ball = Flyer::new(gravity(9.81), stairs.clone(), cor(0.5)).unwrap();
    let tread = Face { cell: 2, index: 0 };
    let (stance, x) = ball.lying(tread, 0.0, Moving::new(vector![0.8, 0.6], vector![-1.0, 0.0]));
    let run = Simulation::of(&ball).run(stance, x, 0.0..0.5).unwrap();
    assert!((run.trajectory.jumps()[0].t() - 0.2).abs() < 1e-14);
    assert!((run.end.state.velocity - vector![0.5, 0.0]).norm() < 1e-14 && run.end.mode == stance);
    let ball = Flyer::new(gravity(10.0), Stairs::new(vec![0.0], vec![0.0, -1.0]).unwrap(), cor(0.5)).unwrap();
    let run = Simulation::of(&ball).most_jumps(1).run(
        Stance::FLIGHT,
        Moving::new(vector![-3.0, 45.0], vector![1.0, 0.0]),
        0.0..9.0,
    );
    let jump = run.unwrap().trajectory.jumps()[0];
    assert_eq!((jump.t(), jump.edge()), (3.0, Some(Event::Meet(FLOOR))));
}

/// A lift that starts, and one that drops away faster than a ball falls.
#[test]
fn lifts() {
    let lift = Lift::new(0.0, 0.0, &[(1.0, -20.0), (1.5, 0.0)]).unwrap();
    let ball = Flyer::new(gravity(10.0), lift, cor(0.0)).unwrap();
    let (stance, x) = ball.lying(FLOOR, 0.0, Moving::new(vector![0.0], vector![0.0]));
    let run = Simulation::of(&ball).run(stance, x, 0.0..4.0).unwrap();
    let edges: Vec<_> = run.trajectory.jumps().iter().map(|jump| (jump.t(), jump.edge().unwrap())).collect();
    // It falls freely from 1 s; the floor sinks at 10 m/s from 2.5 m below: 5 s² = 2.5 + 10 (s -
    // 1/2) at s = 1 + 1/√2.
    assert_eq!(edges.iter().filter(|edge| edge.1 == Event::Change).count(), 2);
    assert!((edges[0].0 - 1.0).abs() < 2e-16 && matches!(edges[0].1, Event::Leave(_)), "{edges:?}");
    let lands = edges.last().unwrap().0;
    assert!((lands - 2.0 - 0.5_f64.sqrt()).abs() < 1e-14, "{edges:?}");
    assert_eq!(run.end.mode, Stance::Slide { face: FLOOR, along: vector![0.0] });
    assert!((run.end.state.position[0] + 2.5 + 10.0 * 2.5).abs() < 1e-13);
}

/// On a floor that rises a ball that hardly rebounds soon does so by less than its velocity can
/// tell: it has come to lie there.
#[test]
fn a_rebound_below_the_rounding_of_velocity() {
    for e in [1e-7, 1e-8, 1e-9, 1e-10, 1e-12] {
        for speed in (1..60).map(|k| 0.1 * f64::from(k)) {
            let toml = format!(
                "gravity = 24.8\nrestitution = {e}\n[ball]\nradius = 0.005\nheight = 0.0\nvelocity = {}\n\
                 [floor]\nmotion = {{ schedule = [[0.0, 0.0], [0.2, 0.1]] }}\n[run]\nuntil = 0.15\n",
                -speed
            );
            let record = Scene::parse("rising.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
            let height = record.at(0, 0.15).unwrap().height();
            assert!((height - 0.075).abs() < 1e-14, "{e} {speed}: at {height}");
        }
    }
}

/// Balls on a table that shakes, from the first second to the last of a quarter of an hour: each
/// lands, lies, is let go and lands again, once each time, and is recorded in a few pieces.
#[test]
fn a_shaken_table_from_any_hour() {
    let (mut runner, turns) = (TestRunner::deterministic(), 20.0);
    let any = (
        0.7..5.7_f64,
        0.3..2.8,
        prop_oneof![Just(0.0), 0.0..0.95],
        prop_oneof![Just(0.0), 0.0..10.0],
        0.0..TAU,
        0.0..1.0,
    );
    for late in [0.0, 1.0, 30.0, 1000.0] {
        for _ in 0..150 {
            let (omega, strength, e, mean, phase, height) = any.new_tree(&mut runner).unwrap().current();
            let (g, omega) = (9.81, omega.exp());
            let amplitude = strength * g / (omega * omega);
            let table = Table::new(amplitude, omega).unwrap().shifted(phase, mean).unwrap();
            let ball = Flyer::new(gravity(g), table, cor(e)).unwrap();
            let start = Moving::new(vector![mean + amplitude * (1.0 + 5.0 * height)], vector![0.0]);
            let span = late..late + turns * TAU / omega;
            let run = Simulation::of(&ball).most_jumps(5000).run(Stance::FLIGHT, start, span).unwrap();
            let says = format!("omega {omega}, strength {strength}, e {e}, mean {mean}, phase {phase}, from {late} s");
            assert_eq!(run.end.stop, Stop::Time, "{says}");
            assert!(
                table.margin(FLOOR, run.trajectory.end().seconds(), &run.end.state.position) > -1e-12 * (1.0 + mean),
                "{says}"
            );
            let jumps = run.trajectory.jumps();
            let leaves = jumps.iter().filter(|jump| matches!(jump.edge(), Some(Event::Leave(_)))).count();
            assert!(leaves as f64 <= turns + 1.0, "{leaves} times let go, {says}");
            let pieces: usize = (0..run.trajectory.arcs().len()).map(|k| run.trajectory.pieces(k).count()).sum();
            assert!(pieces < 64 * (jumps.len() + 1) + 640, "{pieces} pieces of {} arcs, {says}", jumps.len() + 1);
        }
    }
}

/// A ball comes to rest in the corner of a tilted box, against two walls.
#[test]
fn a_corner() {
    let tilt = 0.3_f64;
    let walls = [
        Plane::wall(vector![-tilt.sin(), tilt.cos()], 0.0).unwrap(),
        Plane::wall(vector![tilt.cos(), tilt.sin()], 0.0).unwrap(),
    ];
    for e in [0.0, 0.4, 0.8] {
        let ball = Flyer::new(gravity(9.81), walls, cor(e)).unwrap();
        let start = Moving::new(vector![0.6, 1.0], vector![0.5, 0.0]);
        let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..60.0).unwrap();
        assert_eq!(run.end.mode, Stance::Corner { cell: 0, faces: 3 }, "e = {e}");
        assert!(
            run.end.state.position.norm() < 1e-9 && run.end.state.velocity.norm() == 0.0,
            "e = {e}: {:?}",
            run.end.state
        );
    }
}

/// A floor far from the origin, and not level: bounces still end, in the end and at the right time.
#[test]
fn floors_far_away() {
    let (g, e) = (9.81_f64, 0.7);
    for height in [0.0, 1.0, -3.7, 1e3, 1e6] {
        let ball = Flyer::new(gravity(g), Plane::floor(height).unwrap(), cor(e)).unwrap();
        let start = Moving::new(vector![0.0, height + 1.0], vector![1.0, 0.0]);
        let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..9.0).unwrap();
        let rest = run.trajectory.jumps().last().unwrap();
        assert!(matches!(run.end.mode, Stance::Slide { .. }), "{height}: {:?}", run.end.mode);
        let limit = (2.0 / g).sqrt() * (1.0 + e) / (1.0 - e);
        assert!((rest.t() - limit).abs() < 4e-15 * (1.0 + height.abs()), "{height}: {} {limit}", rest.t());
        assert!((run.end.state.position[0] - 9.0).abs() < 1e-12);
    }
}

/// No coordinate for what is not named.
#[test]
fn coordinates() {
    assert_eq!(Moving::new(vector![0.0, 0.0], vector![0.0, 0.0]).len(), 4);
    assert_eq!(size_of::<Moving<2>>(), 32);
    assert_eq!(size_of::<Moving<2, f64>>(), 40);
    let many = |count| Flyer::new(gravity(9.81), vec![Plane::<2>::floor(0.0).unwrap(); count], cor(0.5));
    assert!(many(MOST_FACES).is_ok() && many(MOST_FACES + 1).is_err());
    assert_eq!(Walls::<2>::faces(&Cuboid::between(vector![0.0, 0.0], vector![1.0, 1.0]).unwrap(), 0), 4);
}

/// A ball rolls down a hill that curves away below it, so fast that its way in flight is hardly
/// flatter than the hill: it leaves as the third power of time, for long below the rounding of the
/// hill's distance, and does not come back.
#[test]
fn hills_are_left_at_hardly_more_than_the_speed_to_leave_them() {
    let mut runner = TestRunner::deterministic();
    let balls = (4.9..5.3_f64, -100.0..100.0_f64, 0.35..0.45_f64, 0.0..0.3_f64, 6.0..12.0_f64);
    let mut left = 0;
    for k in 0..2000 {
        let (speed, spin, curvature, friction, digits) = balls.new_tree(&mut runner).unwrap().current();
        let (tolerance, drag) =
            (10.0_f64.powf(-digits), if k % 2 == 0 { "" } else { "drag = { per_length = 1e-9 }\n" });
        let toml = format!(
            "restitution = 0.9\nfriction = {friction}\n{drag}[ball]\nradius = 0.2\nmass = 0.01\nposition = [0.0, 0.2]\n\
             velocity = [{speed}, 0.0]\nspin = {spin}\n[[floor]]\nkind = \"parabola\"\ncurvature = -{curvature}\n\
             [run]\nuntil = 1.0\ntolerance = {tolerance}"
        );
        let record = Scene::parse("hill.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
        let Some(lift) = record.events().into_iter().find(|event| event.edge == "lift-off") else { continue };
        left += 1;
        assert_eq!(record.events().last(), Some(&lift), "{toml}");
        // In flight only gravity acts, and a drag of next to nothing, by which it is stepped: the
        // speed across does not change any more.
        let [across, end] = [lift.t, 1.0].map(|t| record.at(0, t).unwrap().velocity.x);
        assert!((across - end).abs() < 1e-6, "{across} {end}\n{toml}");
    }
    assert!(left > 500, "{left}");
}
