//! Height against time.

use crate::{Arc, Background, HeightTime};
use saltus_scene::plan::{Record, With};
use saltus_scene::{Floor, Motion, Shape};

pub(super) fn picture(record: &Record) -> HeightTime {
    let scene = record.scene();
    let mut picture = HeightTime::new(&super::title(scene)).caption(&super::caption(record));
    let floor = scene.floors.iter().find_map(|floor| moving(floor, record.until()));
    for ball in 0..record.balls() {
        let label = match (record.balls(), &floor) {
            (1, None) => String::new(),
            (1, Some(_)) => "ball".to_owned(),
            _ => scene.ball_name(ball),
        };
        let arcs = record.segments(ball).into_iter().map(|segment| {
            let heights = segment.coefficients.iter().map(saltus_scene::plan::Moment::height).collect();
            Arc::new(segment.start, segment.span, heights)
        });
        picture = picture.motion(&label, arcs);
    }
    if let Some(arcs) = floor {
        picture = picture.motion("floor", arcs);
    }
    let impacts = record.impacts().into_iter();
    let contacts = impacts.filter(|impact| matches!(impact.with, With::Floor(_))).map(|impact| impact.t);
    picture.contacts(contacts).background(Background::Adaptive)
}

/// How a floor that moves goes, in pieces of an eighth of its period or from point to point of its
/// schedule.
fn moving(floor: &Floor, until: f64) -> Option<Vec<Arc>> {
    /// More pieces than can be told apart.
    const MOST: f64 = 4000.0;
    let (Shape::Level { height }, Some(motion)) = (&floor.shape, &floor.motion) else { return None };
    match motion {
        Motion::Sine { amplitude, frequency, phase } => {
            let span = (1.0 / (8.0 * frequency)).max(until / MOST);
            let w = std::f64::consts::TAU * frequency;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
            let count = (until / span).ceil() as u32;
            let arc = |k: u32| {
                let start = f64::from(k) * span;
                let at = |t: f64| {
                    let (sin, cos) = (w * t + phase).sin_cos();
                    (height + amplitude * sin, amplitude * w * cos)
                };
                let ((a, u), (b, v)) = (at(start), at(start + span));
                // Cubic with the heights and velocities of both ends.
                let (d, s) = ((b - a) / span, span);
                Arc::new(
                    start,
                    span.min(until - start),
                    vec![a, u, (3.0 * d - 2.0 * u - v) / s, (u + v - 2.0 * d) / (s * s)],
                )
            };
            Some((0..count).map(arc).collect())
        }
        Motion::Schedule(points) => {
            let mut knots = vec![[0.0, motion.offset(0.0)]];
            knots.extend(points.iter().copied().filter(|point| point[0] > 0.0 && point[0] < until));
            knots.push([until, motion.offset(until)]);
            let arc = |pair: &[[f64; 2]]| {
                let ([s, low], [e, high]) = (pair[0], pair[1]);
                Arc::new(s, e - s, vec![height + low, if e > s { (high - low) / (e - s) } else { 0.0 }])
            };
            Some(knots.windows(2).map(arc).collect())
        }
        _ => None,
    }
}
