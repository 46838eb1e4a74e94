//! Height against time.

use crate::{Background, HeightTime, Stroke};
use saltus_scene::Motion;
use saltus_scene::plan::{Moment, Record, With};

/// The least number of straight pieces in which ground is drawn: one for two dots of a page.
const PIECES: f64 = 400.0;
/// The greatest number of pieces, beyond which none is visible.
const MOST: f64 = 4000.0;
/// The number of pieces of a vibration, each within half a per cent of its amplitude.
const OF_PERIOD: f64 = 32.0;

pub(super) fn picture(record: &Record) -> HeightTime {
    let scene = record.scene();
    let mut picture = HeightTime::new(&super::title(scene)).caption(&super::caption(record));
    for ball in 0..record.balls() {
        let label = if record.balls() == 1 { String::new() } else { scene.ball_name(ball) };
        let strokes = record.segments(ball).into_iter().map(|segment| {
            let heights = segment.coefficients.iter().map(Moment::height).collect();
            Stroke::over_time(segment.start, segment.span, heights)
        });
        picture = picture.motion(&label, strokes);
    }
    for ground in grounds(record) {
        picture = picture.ground(ground);
    }
    if scene.floors.is_empty() {
        picture = picture.floorless();
    }
    let impacts = record.impacts().into_iter();
    let contacts = impacts.filter(|impact| matches!(impact.with, With::Floor(_))).map(|impact| impact.t);
    picture.contacts(contacts).background(Background::Adaptive)
}

/// The height of the highest floor where a ball is at a time.
pub(super) fn ground(record: &Record, ball: usize, t: f64) -> Option<f64> {
    let x = record.at(ball, t)?.position.x;
    record.scene().floors.iter().filter_map(|floor| floor.level(x, t)).reduce(f64::max)
}

/// The ground below each ball over time, each once; none where all of it lies at height zero, or
/// where there is none.
pub(super) fn grounds(record: &Record) -> Vec<Vec<Stroke>> {
    let (scene, until) = (record.scene(), record.until());
    let fast = scene.floors.iter().map(|floor| match floor.motion {
        Some(Motion::Sine { frequency, .. }) => OF_PERIOD * frequency * until,
        _ => 0.0,
    });
    let count = fast.fold(PIECES, f64::max).min(MOST).ceil();
    let mut grounds: Vec<Vec<Stroke>> = Vec::new();
    for ball in 0..record.balls() {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
        let times = (0..=count as u32).map(|k| until * (f64::from(k) / count));
        let at = |t: f64| Some([t, ground(record, ball, t)?]);
        let points: Vec<[f64; 2]> = times.filter_map(at).collect();
        let edges = points.windows(2).flat_map(|pair| edge(at, [pair[0], pair[1]]).into_iter().flatten());
        let mut points: Vec<[f64; 2]> = points.iter().copied().chain(edges).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let ground = joined(&points);
        if ground.iter().any(|stroke| stroke.reach()[1] != (0.0, 0.0)) && !grounds.contains(&ground) {
            grounds.push(ground);
        }
    }
    grounds
}

/// Both sides of the edge between two points, where the ground falls or rises there at once, as
/// from step to step: of a slope half the way is half the height.
fn edge(at: impl Fn(f64) -> Option<[f64; 2]>, [mut a, mut b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    /// The part of the height that the better half has to keep for there to be an edge.
    const KEPT: f64 = 0.9;
    /// The number of halvings of the time: to a thousandth of a dot.
    const HALVINGS: u32 = 10;
    for _ in 0..HALVINGS {
        let (m, whole) = (at(0.5 * (a[0] + b[0]))?, (b[1] - a[1]).abs());
        let [first, last] = [a, b].map(|end| (m[1] - end[1]).abs());
        if first.max(last) < KEPT * whole || whole == 0.0 {
            return None;
        }
        if first > last { b = m } else { a = m }
    }
    Some([a, b])
}

/// Straight strokes through points, one for all that lie on one line.
fn joined(points: &[[f64; 2]]) -> Vec<Stroke> {
    /// The distance of a point from a line, as a part of the range of heights, up to which it lies
    /// on it.
    const NEAR: f64 = 1e-9;
    let heights = points.iter().map(|point| point[1]);
    let near = NEAR * (heights.clone().fold(f64::NEG_INFINITY, f64::max) - heights.fold(f64::INFINITY, f64::min));
    let mut corners: Vec<[f64; 2]> = Vec::new();
    for &[t, h] in points {
        while let [.., [s, a], [m, b]] = corners[..]
            && (a + (h - a) * ((m - s) / (t - s)) - b).abs() <= near
        {
            corners.pop();
        }
        corners.push([t, h]);
    }
    let stroke = |pair: &[[f64; 2]]| {
        let ([s, a], [t, b]) = (pair[0], pair[1]);
        Stroke::over_time(s, t - s, vec![a, (b - a) / (t - s)])
    };
    corners.windows(2).map(stroke).collect()
}

#[cfg(test)]
mod tests {
    use saltus_scene::Scene;

    use super::*;

    /// The scene's ground, and at how many impacts a ball was met on it.
    fn met(toml: &str) -> (Vec<Vec<Stroke>>, usize) {
        let record = Scene::parse("scene", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
        let grounds = grounds(&record);
        let mut count = 0;
        for impact in record.impacts().iter().filter(|impact| matches!(impact.with, With::Floor(_))) {
            let low = record.at(impact.ball, impact.t).unwrap().height();
            let at = |ground: &Vec<Stroke>| {
                let on = |stroke: &&Stroke| stroke.start().0 <= impact.t && impact.t <= stroke.end().0;
                let stroke = ground.iter().find(on).unwrap();
                stroke.at(impact.t - stroke.start().0).1
            };
            let near = grounds.iter().map(at).map(|floor| (low - floor).abs()).fold(f64::INFINITY, f64::min);
            // Straight pieces cut corners and waves a little.
            assert!(near < 5e-3 || grounds.is_empty(), "{near} m at {} s of\n{toml}", impact.t);
            count += 1;
        }
        (grounds, count)
    }

    #[test]
    fn balls_bounce_on_the_ground_that_is_drawn() {
        let thrown = "restitution = 0.7\nball = { position = [-0.9, 1], velocity = [0.4, 0] }\nrun = { until = 3 }\n";
        let fallen = "restitution = 0.5\nball = { height = 0.2 }\nrun = { until = 3 }\n";
        for (scene, floor, least) in [
            (thrown, "{ kind = 'stairs', from = -0.8, tread = 0.3, rise = 0.2, count = 5 }", 3),
            (thrown, "{ kind = 'incline', angle = -0.2 }", 3),
            (thrown, "{ kind = 'parabola', curvature = 0.5 }", 3),
            (thrown, "{ kind = 'sine', amplitude = 0.05, wavelength = 0.7 }", 3),
            (thrown, "{ kind = 'polyline', points = [[-2, 0.5], [0, 0], [2, 0.5]] }", 3),
            (thrown, "[{ height = -0.3 }, { kind = 'incline', angle = -0.3 }]", 3),
            (fallen, "{ height = -0.7 }", 3),
            (fallen, "{ motion = { amplitude = 0.01, frequency = 20 } }", 5),
            (fallen, "{ motion = { schedule = [[0, 0], [0.5, 0.1]] } }", 3),
        ] {
            let (grounds, count) = met(&format!("{scene}floor = {floor}\n"));
            assert!(grounds.len() == 1 && count >= least, "{floor}: {count} on {}", grounds.len());
        }
        // Between treads the ground is upright, within a thousandth of a dot of a page.
        let (grounds, _) =
            met(&format!("{thrown}floor = {{ kind = 'stairs', from = -0.8, tread = 0.3, rise = 0.2 }}\n"));
        let (level, edges): (Vec<&Stroke>, Vec<&Stroke>) =
            grounds[0].iter().partition(|stroke| stroke.start().1 == stroke.end().1);
        assert!(level.len() == edges.len() + 1 && edges.len() >= 3, "{grounds:?}");
        assert!(edges.iter().all(|edge| edge.span < 3.0 / PIECES / 1000.0), "{edges:?}");
        // The floor of old pictures, and what many balls share, is drawn once or not at all.
        assert!(met(fallen).0.is_empty());
        let two = "ball = [{ mass = 1, radius = 0.01, height = 1 }, { mass = 1, radius = 0.01, height = 2 }]\n";
        let two = format!("restitution = 0.5\n{two}floor = {{ height = -1 }}\nrun = {{ until = 2 }}\n");
        let (grounds, _) = met(&two);
        assert!(grounds.len() == 1 && grounds[0].len() == 1, "{grounds:?}");
    }
}
