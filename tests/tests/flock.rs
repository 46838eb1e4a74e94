//! Several balls that spin, rub, lie and fly in air: against each ball alone, against closed forms,
//! against the cloud.

use nalgebra::{Vector3, vector};
use saltus::{Simulation, Stop};
use saltus_bounce::effects::{Gravity, QuadraticDrag};
use saltus_bounce::flight::{QuadraticDragFlight, VerticalFlight};
use saltus_bounce::flock::Flying;
use saltus_bounce::friction::Friction;
use saltus_bounce::walls::Plane;
use saltus_bounce::{Cor, Flock, Flyer, Moving, Rolls, Sphere};
use saltus_scene::Scene;
use saltus_scene::plan::{Advance, End, Model, Record, With};

fn scene(toml: &str) -> Scene {
    Scene::parse("test.toml", toml.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn run(toml: &str) -> (Model, Record) {
    let plan = scene(toml).plan().unwrap_or_else(|error| panic!("{error}"));
    (plan.explain().model, plan.run().unwrap_or_else(|error| panic!("{error}")))
}

/// A ball that rolls hits an equal one full: what rolls at last is 2/7 and 5/7 of the speed.
/// Nothing is stepped.
#[test]
fn a_full_hit_on_a_table() {
    let (ball, e) = (Sphere::solid(0.03, 0.17).unwrap(), Cor::new(1.0).unwrap());
    let cushion = Cor::new(0.5).unwrap();
    let grip = Rolls { ball, friction: Friction::rigid(0.2).unwrap() };
    let each = Flyer::gripped(Gravity::EARTH, Plane::floor(0.0).unwrap(), cushion, grip).unwrap();
    let flock = Flock::<2, _, _, _, _>::new([(ball, each), (ball, each)], e, Friction::NONE).unwrap();
    let rolling = Moving::new(vector![0.0, 0.0, 0.0], vector![0.7, 0.0, 0.0]).spinning(vector![0.0, 0.7 / 0.03, 0.0]);
    let still = Moving::new(vector![0.5, 0.0, 0.0], Vector3::zeros()).spinning(Vector3::zeros());
    let run = Simulation::of(&flock).tolerance(1e-12).run(
        saltus_bounce::flock::Stances::FLIGHT,
        Flying::new(&[rolling, still]),
        0.0..3.0,
    );
    let state = run.unwrap().end.state;
    for (n, share) in [(0, 2.0 / 7.0), (1, 5.0 / 7.0)] {
        let (v, w) = (state.ball(n).velocity, state.ball(n).spin);
        assert!((v - vector![0.7 * share, 0.0, 0.0]).norm() < 1e-9, "{n}: {v}");
        assert!((w - vector![0.0, v.x / 0.03, 0.0]).norm() < 1e-6, "{n}: {w}");
    }
}

/// Far from each other balls move as each would alone: in air, with spin and friction, down stairs,
/// on a table that shakes.
#[test]
fn far_apart_each_is_alone() {
    let around = [
        "friction = 0.3\ndrag = { coefficient = 0.47 }\nmagnus = { slope = 1 }\nspin_decay = { time = '3 s' }\nair = { wind = ['-2 m/s', '1 m/s', '0 m/s'] }\nfloor = { kind = 'incline', angle = '5 deg' }\n",
        "friction = 0.3\nfloor = { kind = 'stairs', tread = '30 cm', rise = '17 cm', count = 4 }\n",
        "friction = 0.2\nfloor = { motion = { amplitude = '2 mm', frequency = '14 Hz' } }\n",
        "friction = 0.2\nfloor = { motion = { schedule = [['0.5 s', '0 m'], ['0.7 s', '10 cm'], ['1 s', '0 cm']] } }\n",
        "friction = 0.3\nbuoyancy = true\nfloor = { kind = 'parabola', curvature = '1 1/m' }\n",
    ];
    let balls = [
        "radius = '2 cm'\nmass = '20 g'\nposition = ['-40 cm', '0 m', '50 cm']\nvelocity = ['1 m/s', '0.2 m/s', '0 m/s']\nspin = ['1 rev/s', '-5 rev/s', '2 rev/s']\n",
        "shape = 'hollow'\nradius = '3 cm'\nmass = '30 g'\nposition = ['10 cm', '50 m', '40 cm']\nvelocity = ['0.3 m/s', '0 m/s', '1 m/s']\nspin = ['0 rev/s', '3 rev/s', '1 rev/s']\n",
    ];
    for around in around {
        let text = |kept: &[&str]| {
            let head = if kept.len() == 1 { "[ball]\n" } else { "[[ball]]\n" };
            let tables: String = kept.iter().map(|ball| format!("{head}{ball}")).collect();
            format!("restitution = 0.4\n{around}{tables}[run]\nuntil = '2.5 s'\ntolerance = 1e-11\n")
        };
        let (model, both) = run(&text(&balls));
        assert_eq!(both.end(), End::Time, "{around}");
        assert_eq!(model, Model::Flock);
        for (n, ball) in balls.iter().enumerate() {
            let (model, alone) = run(&text(&[ball]));
            assert_eq!((model, alone.end()), (Model::Flyer, End::Time), "{around}");
            for k in 0..=25 {
                let t = f64::from(k) / 10.0;
                let (one, other) = (alone.at(0, t).unwrap(), both.at(n, t).unwrap());
                let off = (one.position - other.position).norm();
                assert!(off < 1e-6, "ball {n} at {t} s is off by {off:e} m: {around}");
            }
        }
    }
}

/// Without loss and friction it is the cloud, impact for impact.
#[test]
fn without_loss_it_is_the_cloud() {
    let ball = |x: f64, up: f64, u: f64, r: f64| {
        format!("[[ball]]\nradius = {r}\nmass = {}\nposition = [{x}, {up}]\nvelocity = [{u}, 0.3]\n", 30.0 * r)
    };
    let balls = [ball(-0.15, 0.2, 0.5, 0.02), ball(0.15, 0.25, -0.4, 0.03), ball(0.0, 0.1, 0.1, 0.025)].concat();
    let walls = "[floor]\nkind = 'box'\nsize = ['50 cm', '50 cm']\n[run]\nuntil = '1 s'\n";
    let (model, cloud) = run(&format!("restitution = 1\n{balls}{walls}"));
    assert_eq!(model, Model::Cloud);
    // A spin about no axis that matters makes it a flock.
    let spinning = balls.replacen("radius", "spin = '1 rev/s'\nradius", 1);
    let (model, flock) = run(&format!("restitution = 1\n{spinning}{walls}"));
    assert_eq!(model, Model::Flock);
    assert_eq!(flock.cost().steps, 0);
    let (cloud, flock) = (cloud.impacts(), flock.impacts());
    assert!(cloud.len() > 12 && cloud.len() == flock.len(), "{} {}", cloud.len(), flock.len());
    for (a, b) in cloud.iter().zip(&flock) {
        assert!((a.t - b.t).abs() < 1e-7 && (a.ball, a.with) == (b.ball, b.with), "{a:?} {b:?}");
    }
}

/// A lossy handful comes to rest: nothing overlaps, nothing sinks, energy only falls, and smooth
/// flights are never stepped.
#[test]
fn a_handful_comes_to_rest() {
    let balls: String = (0..4)
        .map(|n| {
            let n = f64::from(n);
            format!(
                "[[ball]]\nradius = {}\nmass = {}\nposition = [{}, {}, {}]\nvelocity = [{}, 0.4, 0.0]\n",
                0.02 + 0.003 * n,
                0.02 + 0.01 * n,
                0.11 * n - 0.16,
                0.03 * n - 0.05,
                0.2 + 0.05 * n,
                1.0 - 0.5 * n
            )
        })
        .collect();
    for friction in ["0.0", "0.3"] {
        let text = format!(
            "restitution = 0.6\nfriction = {friction}\ncollisions = {{ restitution = 0.7, friction = {friction} }}\n{balls}[floor]\nkind = 'box'\nsize = [0.5, 0.5, 0.6]\n[run]\nuntil = '8 s'\n"
        );
        let scene = scene(&text);
        let plan = scene.plan().unwrap();
        assert_eq!(plan.explain().model, Model::Flock);
        let record = plan.run().unwrap();
        assert_eq!(record.end(), End::Time);
        let mass = |n: usize| scene.balls[n].mass.unwrap();
        let radius = |n: usize| scene.balls[n].radius.unwrap();
        let mut before = f64::INFINITY;
        for k in 0..=800 {
            let t = f64::from(k) / 100.0;
            let moments: Vec<_> = (0..4).map(|n| record.at(n, t).unwrap()).collect();
            let mut energy = 0.0;
            for (n, a) in moments.iter().enumerate() {
                assert!(a.height() > -1e-12, "ball {n} at {t} s is at {}", a.height());
                energy += mass(n)
                    * (0.5 * a.velocity.norm_squared()
                        + 0.2 * (radius(n) * a.spin).norm_squared()
                        + 9.80665 * a.height());
                for (m, b) in moments[..n].iter().enumerate() {
                    let mut apart = a.position - b.position;
                    apart.z += radius(n) - radius(m);
                    assert!(apart.norm() > radius(n) + radius(m) - 1e-9, "{n} and {m} at {t} s");
                }
            }
            assert!(energy <= before * (1.0 + 1e-9) + 1e-12, "{energy} after {before} at {t} s");
            before = energy;
        }
        assert!((0..4).all(|n| record.at(n, 8.0).unwrap().height() < 1e-12), "friction {friction}");
        assert!(record.impacts().iter().any(|impact| matches!(impact.with, With::Ball(_))));
        if friction == "0.0" {
            assert_eq!(record.cost().steps, 0);
            assert!(plan.explain().modes.iter().all(|mode| mode.advance == Advance::Exact));
        }
    }
}

/// In air the heavier ball above catches up with the lighter one: when, by the closed forms of the
/// two falls.
#[test]
fn a_heavy_ball_catches_up_in_air() {
    let text = "restitution = 0.5\ndrag = { coefficient = 0.47 }\nfloor = []\n\
        ball = [{ radius = '2 cm', mass = '2.7 g', position = ['0 m', '10.02 m'] }, { radius = '2 cm', mass = '46 g', position = ['0 m', '10.52 m'] }]\n\
        run = { until = '3 s', tolerance = 1e-12 }\n";
    let scene_of = scene(text);
    let (model, record) = run(text);
    assert_eq!(model, Model::Flock);
    let falls = [0, 1].map(|n| {
        let drag = scene_of.effects.quadratic_drag(&scene_of.balls[n]).unwrap().per_length();
        QuadraticDragFlight::new(9.80665, drag).unwrap()
    });
    let height = |n: usize, t: f64| falls[n].after(t, &vector![[10.0, 10.5][n], 0.0])[0];
    let gap = |t: f64| height(1, t) - height(0, t) - 0.04;
    let (mut low, mut high) = (0.1, 3.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if gap(middle) > 0.0 { low = middle } else { high = middle }
    }
    let first = record.impacts()[0];
    assert!((first.t - low).abs() < 1e-9, "{} {low}", first.t);
}

/// A ball that would come to rest upon another ends the run, and the run says so.
#[test]
fn a_ball_upon_a_ball_ends_the_run() {
    let text = "restitution = 0.5\ndrag = { coefficient = 0.47 }\n\
        ball = [{ radius = '2 cm', mass = '20 g', position = ['0 m', '12 cm'] }, { radius = '2 cm', mass = '20 g', position = ['0 m', '22 cm'] }]\n\
        run = { until = '5 s' }\n";
    let (model, record) = run(text);
    assert_eq!(model, Model::Flock);
    assert!(matches!(record.end(), End::Zeno { limit } if limit < 2.0), "{:?}", record.end());
    // Balls that have no place sideways do the same.
    let vertical = text.replace("position = ['0 m', ", "height = ").replace("cm'] }", "cm' }");
    let (model, record) = run(&vertical);
    assert_eq!(model, Model::Flock);
    assert!(matches!(record.end(), End::Zeno { limit } if limit < 2.0), "{:?}", record.end());
}

/// As a library: effects by type, and what ends a run that is not modelled is a value.
#[test]
fn by_type() {
    let (ball, e) = (Sphere::solid(0.03, 0.05).unwrap(), Cor::new(0.5).unwrap());
    let air = (Gravity::EARTH, QuadraticDrag::sphere(&ball, 1.2, 0.47).unwrap());
    let grip = Rolls { ball, friction: Friction::NONE };
    let each = Flyer::gripped(air, Plane::floor(0.0).unwrap(), e, grip).unwrap();
    assert!(Flock::<1, _, _, _, _>::new([(ball, each), (ball, each)], e, Friction::NONE).is_err());
    let flock = Flock::<3, _, _, _, _>::new([(ball, each), (ball, each)], e, Friction::NONE).unwrap();
    let at = |up: f64| Moving::new(vector![0.0, 0.0, up], Vector3::zeros()).spinning(Vector3::zeros());
    let start = Flying::new(&[at(0.1), at(0.3)]);
    let run = Simulation::of(&flock).run(start.stances(), start, 0.0..5.0).unwrap();
    assert!(matches!(run.end.stop, Stop::Zeno { .. }), "{:?}", run.end.stop);
}
