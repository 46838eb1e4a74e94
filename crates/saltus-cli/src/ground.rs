//! Names of balls and the outline of what they bounce on.

use saltus_bounce::scene::{Floor, Scene, Shape};
use saltus_plot::Stroke;

/// What a ball is called.
pub(super) fn name(scene: &Scene, ball: usize) -> String {
    let name = scene.balls.get(ball).and_then(|ball| ball.name.clone());
    name.unwrap_or_else(|| format!("ball {}", ball + 1))
}

/// Floors and walls as far as the balls get, `reach` sideways and up.
pub(super) fn outline(scene: &Scene, reach: [[f64; 2]; 2]) -> Vec<Stroke> {
    let [[left, right], [low, high]] = reach;
    let more = 0.04 * (right - left).max(high - low);
    let reach = [[left - more, right + more], [low, high + more]];
    scene.floors.iter().flat_map(|floor| shape(floor, reach)).collect()
}

fn shape(floor: &Floor, [[left, right], [low, high]]: [[f64; 2]; 2]) -> Vec<Stroke> {
    match floor.shape {
        Shape::Level { height } => Stroke::polygon(&[[left, height], [right, height]]),
        Shape::Incline { angle, height } => {
            let at = |x: f64| [x, height + x * angle.tan()];
            Stroke::polygon(&[at(left), at(right)])
        }
        Shape::Wall { across_y: false, at, .. } => Stroke::polygon(&[[at, low], [at, high]]),
        Shape::Wall { .. } => Vec::new(),
        Shape::Box { size, height, open } => {
            let (x, top) = (0.5 * size.x, height + size.z);
            let mut corners = vec![[-x, top], [-x, height], [x, height], [x, top]];
            if !open {
                corners.push([-x, top]);
            }
            Stroke::polygon(&corners)
        }
        Shape::Stairs { top, from, tread, rise, count } => {
            /// More steps than can be told apart.
            const MOST: u32 = 2000;
            let mut corners = vec![[left.min(from), top]];
            for k in 0..count.unwrap_or(MOST).min(MOST) {
                let step = f64::from(k);
                let edge = from + tread * step;
                if edge > right {
                    break;
                }
                corners.extend([[edge, top - rise * step], [edge, top - rise * (step + 1.0)]]);
            }
            if let Some(&[_, level]) = corners.last() {
                corners.push([right, level]);
            }
            corners.retain(|corner| corner[0] >= left);
            Stroke::polygon(&corners)
        }
        Shape::Parabola { curvature, centre, height } => {
            let (d, span) = (left - centre, right - left);
            let y = vec![height + 0.5 * curvature * d * d, curvature * d, 0.5 * curvature];
            vec![Stroke::new(span, vec![left, 1.0], y)]
        }
        Shape::Sine { amplitude, wavelength, phase, height } => {
            /// Points of a wave, or of all of them.
            const POINTS: f64 = 24.0;
            let step = (wavelength / POINTS).max((right - left) / 2000.0);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most 2000
            let count = ((right - left) / step).ceil() as u32;
            let at = |k: u32| {
                let x = left + (right - left) * f64::from(k) / f64::from(count.max(1));
                [x, height + amplitude * (std::f64::consts::TAU * x / wavelength + phase).sin()]
            };
            Stroke::polygon(&(0..=count).map(at).collect::<Vec<_>>())
        }
        _ => Vec::new(),
    }
}
