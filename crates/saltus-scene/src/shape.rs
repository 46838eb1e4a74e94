//! Properties of the shape of a floor: whether a ball may start there, the direction of its push,
//! and its outline.
//!
//! One match for each question, all of them here: who adds a shape answers them, and gives it its
//! keys in `floor.rs` and its wall in `plan/surroundings.rs`.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::error::short;
use super::{Ball, Floor, Shape};

/// The overlap that rounding may make, relative to the numbers involved.
const ROUNDING: f64 = 1e-12;
/// The greatest number of steps that an outline of stairs shows.
const MOST_STEPS: u32 = 2000;
/// Points of the outline of a curve, and of each of its waves.
const POINTS: u32 = 400;

/// The height of ground over x, its slope and its second derivative.
pub(super) type Graph = [f64; 3];

impl Shape {
    /// The kind of floor, in a word.
    pub(super) const fn word(&self) -> &'static str {
        match self {
            Self::Level { .. } => "floor",
            Self::Incline { .. } => "incline",
            Self::Stairs { .. } => "stairs",
            Self::Wall { .. } => "wall",
            Self::Box { .. } => "box",
            Self::Parabola { .. } | Self::Sine { .. } => "curve",
            Self::Polyline { .. } => "polyline",
        }
    }

    /// The ground over x, of a shape that is smooth and neither level nor straight.
    pub(super) fn curve(&self, x: f64) -> Option<Graph> {
        match *self {
            Self::Parabola { curvature, centre, height } => {
                let d = x - centre;
                Some([height + 0.5 * curvature * d * d, curvature * d, curvature])
            }
            Self::Sine { amplitude, wavelength, phase, height } => {
                let k = TAU / wavelength;
                let (sin, cos) = (k * x + phase).sin_cos();
                Some([height + amplitude * sin, amplitude * k * cos, -amplitude * k * k * sin])
            }
            _ => None,
        }
    }

    /// The greatest second derivative of a curve: a ball whose radius is not below its inverse may
    /// not fit into it.
    pub(super) fn hollow(&self) -> f64 {
        match self {
            Self::Parabola { curvature, .. } => *curvature,
            Self::Sine { amplitude, wavelength, .. } => amplitude * (TAU / wavelength).powi(2),
            _ => 0.0,
        }
    }
}

/// The piece of a polyline over x, and where that is on it: its first point and its slope.
fn piece(points: &[[f64; 2]], x: f64) -> ([f64; 2], f64) {
    let next = points.partition_point(|point| point[0] <= x).clamp(1, points.len().saturating_sub(1));
    let ([x0, z0], [x1, z1]) = (points[next - 1], points[next]);
    ([x0, z0], (z1 - z0) / (x1 - x0))
}

/// The number of steps down at x.
fn down(x: f64, from: f64, tread: f64, count: Option<u32>) -> f64 {
    let steps = if x < from { 0.0 } else { ((x - from) / tread).floor() + 1.0 };
    count.map_or(steps, |count| steps.min(f64::from(count)))
}

impl Floor {
    /// The reason why the ball cannot start where it does.
    pub(super) fn blocked(&self, ball: &Ball) -> Option<String> {
        let (low, centre, r) = (ball.lowest(), ball.centre(), ball.radius.unwrap_or(0.0));
        let offset = self.motion.as_ref().map_or(0.0, |motion| motion.offset(0.0));
        // An exact height is compared exactly; a centre only up to the rounding of its radius.
        let slack = ROUNDING * if low == centre { 0.0 } else { centre.z.abs() + r };
        let below = |level: f64, what: &str| {
            (low.z < level - slack).then(|| {
            format!(
                "the ball starts below the {what}, at a height of {} m: the {what} is at {} m there, start at or above it",
                short(low.z),
                short(level)
            )
        })
        };
        match self.shape {
            Shape::Level { height } => below(height + offset, "floor"),
            Shape::Stairs { top, from, tread, rise, count } => {
                below(top - rise * down(centre.x, from, tread, count), "step")
            }
            Shape::Parabola { .. } | Shape::Sine { .. } => {
                below(self.shape.curve(centre.x).map_or(f64::NEG_INFINITY, |[height, ..]| height), "curve")
            }
            Shape::Polyline { ref points } => {
                let ([x, z], slope) = piece(points, centre.x);
                below(z + slope * (centre.x - x), "polyline")
            }
            Shape::Incline { angle, height } => {
                let gap = (centre.z - height) * angle.cos() - centre.x * angle.sin();
                let room = r - ROUNDING * (r + centre.norm());
                (gap < room).then(|| {
                format!("the ball starts inside the incline: its centre is {} m from it, move it to {r} m (its radius) or more", short(gap))
            })
            }
            Shape::Wall { across_y, at, .. } => {
                let gap = (if across_y { centre.y } else { centre.x } - at).abs();
                (gap < r * (1.0 - ROUNDING)).then(|| {
                format!("the ball starts inside the wall: its centre is {} m from it, move it to {r} m (its radius) or more", short(gap))
            })
            }
            Shape::Box { size, height, open } => {
                let from_bottom = centre - Vector3::new(0.0, 0.0, height);
                let room = |half: f64, at: f64| half - at.abs() >= r * (1.0 - ROUNDING);
                let lid = open || size.z - from_bottom.z >= r * (1.0 - ROUNDING);
                let sides = room(0.5 * size.x, centre.x) && (size.y == 0.0 || room(0.5 * size.y, centre.y));
                (!sides || !lid || from_bottom.z < r * (1.0 - ROUNDING)).then(|| {
                format!(
                    "the ball does not start inside the box, which reaches from x = {} m to {} m and from {height} m to {} m up: move it, its radius counted",
                    -0.5 * size.x,
                    0.5 * size.x,
                    height + size.z
                )
            })
            }
        }
    }

    /// The normal of a floor or wall that changed a velocity by `change`; of a curve, below x.
    pub(super) fn normal(&self, change: Vector3<f64>, x: f64) -> Vector3<f64> {
        let steep = |slope: f64| Vector3::new(-slope, 0.0, 1.0).normalize();
        let (across, along, up) = (Vector3::x(), Vector3::y(), Vector3::z());
        let sides = match self.shape {
            Shape::Incline { angle, .. } => vec![steep(angle.tan())],
            Shape::Stairs { .. } => vec![up, across],
            Shape::Wall { across_y, .. } => {
                let axis = if across_y { along } else { across };
                vec![axis, -axis]
            }
            Shape::Box { .. } => vec![up, across, -across, along, -along, -up],
            Shape::Parabola { .. } | Shape::Sine { .. } => {
                vec![steep(self.shape.curve(x).map_or(0.0, |[_, slope, _]| slope))]
            }
            // A corner pushes along the change of the velocity itself, between the normals of its
            // sides.
            Shape::Polyline { .. } => vec![change.try_normalize(0.0).unwrap_or(up)],
            Shape::Level { .. } => vec![up],
        };
        sides
            .into_iter()
            .reduce(|best, side| if side.dot(&change) > best.dot(&change) { side } else { best })
            .unwrap_or(up)
    }

    /// The height of the floor at x in m and t in s; none of a wall.
    ///
    /// ```
    /// use saltus_scene::Scene;
    /// let toml = b"restitution = 0.5\nball = { position = [0, 1] }\nfloor = { kind = 'stairs', tread = 0.3, rise = 0.2, count = 4 }\n";
    /// let scene = Scene::parse("stairs.toml", toml)?;
    /// assert_eq!(scene.floors[0].level(0.5, 0.0), Some(-0.4));
    /// # Ok::<(), saltus_scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn level(&self, x: f64, t: f64) -> Option<f64> {
        let still = match self.shape {
            Shape::Level { height } | Shape::Box { height, .. } => height,
            Shape::Incline { angle, height } => height + x * angle.tan(),
            Shape::Stairs { top, from, tread, rise, count } => top - rise * down(x, from, tread, count),
            Shape::Wall { .. } => return None,
            Shape::Parabola { .. } | Shape::Sine { .. } => self.shape.curve(x)?[0],
            Shape::Polyline { ref points } => {
                let ([x0, z], slope) = piece(points, x);
                z + slope * (x - x0)
            }
        };
        Some(still + self.motion.as_ref().map_or(0.0, |motion| motion.offset(t)))
    }

    /// The outline, in x and up, of a floor or wall that has any, within
    /// `[[left, right], [low, high]]`; none of one across y.
    #[must_use]
    pub fn outline(&self, [[left, right], [low, high]]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        match self.shape {
            Shape::Level { height } => vec![[left, height], [right, height]],
            Shape::Incline { angle, height } => [left, right].map(|x| [x, height + x * angle.tan()]).to_vec(),
            Shape::Wall { across_y: false, at, .. } => vec![[at, low], [at, high]],
            Shape::Box { size, height, open } => {
                let (x, top) = (0.5 * size.x, height + size.z);
                let mut corners = vec![[-x, top], [-x, height], [x, height], [x, top]];
                corners.extend((!open).then_some([-x, top]));
                corners
            }
            Shape::Stairs { top, from, tread, rise, count } => {
                let mut corners = vec![[left.min(from), top]];
                let steps = (0..count.unwrap_or(MOST_STEPS).min(MOST_STEPS)).map(f64::from);
                for step in steps.take_while(|step| from + tread * step <= right) {
                    let edge = from + tread * step;
                    corners.extend([[edge, top - rise * step], [edge, top - rise * (step + 1.0)]]);
                }
                let level = corners.last().map_or(top, |corner| corner[1]);
                corners.push([right, level]);
                corners
            }
            Shape::Wall { across_y: true, .. } => Vec::new(),
            Shape::Parabola { .. } | Shape::Sine { .. } => {
                let x = |k: u32| left + (right - left) * f64::from(k) / f64::from(POINTS);
                let height = |x: f64| self.shape.curve(x).map_or(0.0, |[height, ..]| height);
                (0..=POINTS).map(|k| [x(k), height(x(k))]).collect()
            }
            Shape::Polyline { ref points } => {
                let end = |x: f64| {
                    let ([x0, z], slope) = piece(points, x);
                    [x, z + slope * (x - x0)]
                };
                let inner = points.iter().copied().filter(|point| left < point[0] && point[0] < right);
                [end(left)].into_iter().chain(inner).chain([end(right)]).collect()
            }
        }
    }
}
