//! A ball on ground that goes straight from point to point, against a reference that knows only
//! distances.

use nalgebra::{Vector2, vector};
use saltus_scene::plan::Record;
use saltus_scene::{Kind, Scene};

const G: f64 = 9.81;

/// The point of the ground that is nearest to `p`; the ground goes on straight beyond its ends.
fn nearest(points: &[[f64; 2]], p: Vector2<f64>) -> Vector2<f64> {
    let last = points.len() - 2;
    let of = |(k, pair): (usize, &[[f64; 2]])| {
        let (a, b) = (Vector2::from(pair[0]), Vector2::from(pair[1]));
        let share = (p - a).dot(&(b - a)) / (b - a).norm_squared();
        let low = if k == 0 { f64::NEG_INFINITY } else { 0.0 };
        let high = if k == last { f64::INFINITY } else { 1.0 };
        a + (b - a) * share.clamp(low, high)
    };
    let all = points.windows(2).enumerate().map(of);
    all.min_by(|a, b| (a - p).norm().total_cmp(&(b - p).norm())).unwrap()
}

/// Impact times of a ball that loses a part of its normal speed where its centre comes within a
/// radius of the ground: small steps, then halving.
fn reference(points: &[[f64; 2]], radius: f64, cor: f64, start: [[f64; 2]; 2], count: usize) -> Vec<f64> {
    const STEP: f64 = 2e-4;
    let (mut x, mut v): (Vector2<f64>, Vector2<f64>) = (start[0].into(), start[1].into());
    let (mut t, mut times) = (0.0, Vec::new());
    while times.len() < count {
        let at = |s: f64| x + v * s + vector![0.0, -0.5 * G * s * s];
        let gap = |s: f64| {
            let p = at(s);
            (p - nearest(points, p)).norm() - radius
        };
        let mut high = STEP;
        while gap(high) > 0.0 {
            high += STEP;
            assert!(high < 10.0, "it never lands");
        }
        let mut low = high - STEP;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if gap(middle) > 0.0 { low = middle } else { high = middle }
        }
        let p = at(low);
        let normal = (p - nearest(points, p)).normalize();
        let u = v + vector![0.0, -G * low];
        (x, v) = (p, u - normal * ((1.0 + cor) * u.dot(&normal)));
        t += low;
        times.push(t);
    }
    times
}

fn run(points: &[[f64; 2]], radius: f64, cor: f64, [[x, up], [vx, vz]]: [[f64; 2]; 2], until: f64) -> Record {
    let toml = format!(
        "gravity = {G}\nrestitution = {cor}\nfloor = {{ kind = 'polyline', points = {points:?} }}\nrun = {{ until = {until} }}\n\
         ball = {{ radius = {radius}, mass = 1, position = [{x}, {up}], velocity = [{vx}, {vz}] }}\n"
    );
    Scene::parse("polyline", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap()
}

/// Sides, outward corners and inward ones, met by a ball from many places.
#[test]
fn impacts_are_those_of_the_distance_to_the_ground() {
    let points = [[-1.0, 0.6], [-0.3, 0.0], [0.2, 0.25], [0.6, 0.1], [1.3, 0.7]];
    let mut met = 0;
    for k in 0..24 {
        let start = [[-0.8 + 0.08 * f64::from(k), 1.4], [0.3 - 0.05 * f64::from(k), 0.0]];
        let times = reference(&points, 0.08, 0.8, start, 5);
        let record = run(&points, 0.08, 0.8, start, times[4] + 1e-4);
        let impacts = record.impacts();
        assert!(impacts.len() >= 5, "{k}: {impacts:?}, {times:?}");
        for (impact, t) in impacts.iter().zip(&times) {
            // An impact's error grows by some ten times at each corner that is met.
            assert!((impact.t - t).abs() < 1e-7, "{k}: {} for {t}", impact.t);
        }
        met += impacts.len();
    }
    assert!(met >= 120);
}

/// A point that slides without friction down a side of 45° into the corner of a right angle meets
/// the other side head on, and stays.
#[test]
fn who_slides_into_an_inward_corner_meets_the_other_side() {
    let points = [[-1.0, 1.0], [0.0, 0.0], [1.0, 1.0]];
    let radius = 1e-6;
    let record = run(&points, radius, 0.0, [[-0.5, 0.5 + 2.0 * radius], [0.0, 0.0]], 3.0);
    let there = record.at(0, 3.0).unwrap();
    assert!(there.position.x.abs() < 1e-5 && there.velocity.norm() < 1e-9, "{there:?}");
    // √(2 s/a) for s = 0.5 √2 and a = g/√2.
    let slides = (2.0 * 0.5 * 2.0 / G).sqrt();
    let last = record.impacts().last().unwrap().t;
    assert!((last - slides).abs() < 1e-3, "{last} for {slides}");
}

/// It is drawn, and exported.
#[test]
fn it_has_an_outline() {
    let points = [[-1.0, 0.6], [0.0, 0.0], [1.0, 0.2]];
    let record = run(&points, 0.05, 0.5, [[-0.2, 0.5], [0.0, 0.0]], 1.0);
    let floor = &record.scene().floors[0];
    let near = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12;
    let outline = floor.outline([[-2.0, 0.5], [0.0, 1.0]]);
    let known = [[-2.0, 1.2], [-1.0, 0.6], [0.0, 0.0], [0.5, 0.1]];
    assert!(outline.iter().zip(known).all(|(&a, b)| near(a, b)) && outline.len() == 4, "{outline:?}");
    assert_eq!(record.motion().unwrap().ground.len(), 1);
    assert_eq!(record.scene().picture.kind, Kind::Height);
}

#[test]
fn what_is_no_polyline_is_refused() {
    for (points, says) in [
        ("[[0, 0]]", "a polyline has two points or more"),
        ("[[0, 0], [0, 1]]", "the polyline has x = 0 m after 0 m"),
        ("[[0, 0], ['1 s', 1]]", "is not a unit of length but of time"),
        ("[[-1, 0.5], [0, 0.5], [0.1, 0], [0.2, 0.5], [1, 0.5]]", "does not fit between two corners"),
    ] {
        let toml = format!(
            "restitution = 0.5\nfloor = {{ kind = 'polyline', points = {points} }}\nrun = {{ until = 1 }}\nball = {{ radius = 0.3, mass = 1, position = [0, 3] }}\n"
        );
        let error = match Scene::parse("polyline", toml.as_bytes()) {
            Err(error) => error.to_string(),
            Ok(scene) => scene.plan().map(|_| String::new()).unwrap_or_else(|error| error.to_string()),
        };
        assert!(error.contains(says), "{points}: {error}");
    }
}
