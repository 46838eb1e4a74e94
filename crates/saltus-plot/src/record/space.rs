//! The path in space, and the ball at equal times.

use crate::{Chart, Disc, Measure, PlotError, Stroke};
use saltus_scene::plan::{Moment, Record, Segment};
use saltus_scene::{Floor, Shape};

use super::title;

/// The most frames of a picture of equal times.
const FRAMES: u32 = 40;

/// The reach of the balls, sideways along any of `axes` and up, with their radii.
fn reach(record: &Record, axes: &[usize]) -> [[f64; 2]; 2] {
    let scene = record.scene();
    let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for (n, ball) in scene.balls.iter().enumerate() {
        let r = ball.radius.unwrap_or(0.0);
        for segment in record.segments(n) {
            for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let m = segment.at(part * segment.span);
                for x in axes.iter().map(|&axis| m.position[axis]) {
                    reach[0] = [reach[0][0].min(x - r), reach[0][1].max(x + r)];
                }
                let z = m.height() + r;
                reach[1] = [reach[1][0].min(z - r), reach[1][1].max(z + r)];
            }
        }
    }
    reach
}

/// The paths of the centres; in space up over x and up over y.
pub(super) fn path(record: &Record) -> Result<Chart, PlotError> {
    let scene = record.scene();
    if scene.dimensions == 1 {
        return Err(PlotError::Missing(
            "a ball that only moves up and down has no path: draw another kind, or give the scene a sideways velocity",
        ));
    }
    let across = if scene.dimensions == 2 { "x" } else { "x or y" };
    let mut chart = Chart::new(&title(scene), (across, Measure::Length), ("Height", Measure::Length)).to_scale();
    let axes: &[(&str, usize)] = if scene.dimensions == 2 { &[("", 0)] } else { &[("over x", 0), ("over y", 1)] };
    for ball in 0..record.balls() {
        let r = scene.balls[ball].radius.unwrap_or(0.0);
        for &(axis, k) in axes {
            let label = if record.balls() > 1 { format!("{} {axis}", scene.ball_name(ball)) } else { axis.to_owned() };
            let strokes = record.segments(ball).into_iter().map(|segment| {
                let across = segment.coefficients.iter().map(|c| c.position[k]).collect();
                arc(&segment, across, r)
            });
            chart = chart.line(label.trim(), strokes);
            let disc = |m: Moment| Disc { at: [m.position[k], m.height() + r], radius: r, full: false };
            chart = chart.discs([0.0, record.until()].into_iter().filter_map(|t| record.at(ball, t)).map(disc));
        }
    }
    let sideways: Vec<usize> = axes.iter().map(|&(_, k)| k).collect();
    Ok(chart.ground(outline(record, reach(record, &sideways))))
}

/// The way of a ball's centre in a segment, exact as the segment is: what is across it, and up.
fn arc(segment: &Segment, across: Vec<f64>, radius: f64) -> Stroke {
    let mut up: Vec<f64> = segment.coefficients.iter().map(Moment::height).collect();
    up[0] += radius;
    Stroke::new(segment.span, across, up)
}

/// The balls at equal times and the arcs of their centres, to scale: the first and the last full,
/// those between pale. One that only moves up and down is drawn frame beside frame.
pub(super) fn ghost(record: &Record) -> Chart {
    let scene = record.scene();
    let reach = reach(record, &[0]);
    let size = (reach[0][1] - reach[0][0]).max(reach[1][1] - reach[1][0]);
    let aside = scene.dimensions == 1;
    let mut chart = Chart::new(
        &title(scene),
        (if aside { "Frames, side by side" } else { "x" }, Measure::Length),
        ("Height", Measure::Length),
    );
    chart = chart.to_scale();
    let radius = |ball: usize| scene.balls[ball].radius.unwrap_or(size / 60.0);
    let widest = (0..record.balls()).map(radius).fold(0.0, f64::max);
    // A film strip is no wider than twice its height.
    let step = (2.5 * widest).max(2.0 * size / f64::from(FRAMES));
    // Frame beside frame, time goes from left to right.
    let pace = step * f64::from(FRAMES) / record.until().max(f64::MIN_POSITIVE);
    for ball in 0..record.balls() {
        let r = radius(ball);
        let strokes = record.segments(ball).into_iter().map(|segment| {
            let across = if aside {
                vec![pace * segment.start, pace]
            } else {
                segment.coefficients.iter().map(|c| c.position.x).collect()
            };
            arc(&segment, across, r)
        });
        let label = if record.balls() > 1 { scene.ball_name(ball) } else { String::new() };
        chart = chart.line(&label, strokes);
        for frame in 0..=FRAMES {
            let t = record.until() * f64::from(frame) / f64::from(FRAMES);
            let Some(m) = record.at(ball, t) else { continue };
            let x = if aside { step * f64::from(frame) } else { m.position.x };
            let full = frame == 0 || frame == FRAMES;
            chart = chart.discs([Disc { at: [x, m.height() + r], radius: r, full }]);
        }
    }
    if aside && let grounds @ [_, ..] = &super::height::grounds(record)[..] {
        let across = |s: &Stroke| Stroke::new(s.span, s.x.iter().map(|x| pace * x).collect(), s.y.clone());
        return chart.ground(grounds.iter().flatten().map(across));
    }
    let ends = if aside { [-step, step * f64::from(FRAMES + 1)] } else { reach[0] };
    chart.ground(outline(record, [ends, reach[1]]))
}

/// Floors and walls as far as the balls get, `reach` sideways and up; floors that move where they
/// are first and last.
fn outline(record: &Record, reach: [[f64; 2]; 2]) -> Vec<Stroke> {
    let [[left, right], [low, high]] = reach;
    let more = 0.04 * (right - left).max(high - low);
    let reach = [[left - more, right + more], [low, high + more]];
    let drawn = |floor: &Floor| match (&floor.shape, &floor.motion) {
        (Shape::Level { height }, Some(motion)) => {
            let at = |t: f64| height + motion.offset(t);
            let line = |level: f64| Stroke::between([reach[0][0], level], [reach[0][1], level]);
            vec![line(at(0.0)), line(at(record.until()))]
        }
        _ => shape(floor, reach),
    };
    record.scene().floors.iter().flat_map(drawn).collect()
}

fn shape(floor: &Floor, reach: [[f64; 2]; 2]) -> Vec<Stroke> {
    let [[left, right], _] = reach;
    match floor.shape {
        Shape::Stairs { .. } => {
            let mut corners = floor.outline(reach);
            corners.retain(|corner| corner[0] >= left);
            Stroke::polygon(&corners)
        }
        Shape::Parabola { curvature, centre, height } => {
            let (d, span) = (left - centre, right - left);
            let y = vec![height + 0.5 * curvature * d * d, curvature * d, 0.5 * curvature];
            vec![Stroke::new(span, vec![left, 1.0], y)]
        }
        _ => Stroke::polygon(&floor.outline(reach)),
    }
}
