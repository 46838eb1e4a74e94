//! Curved ground as a ball of some radius meets it: the curve that its centre follows is parallel
//! to the ground.

use nalgebra::{SVector, Vector2};

use crate::Shape;
use crate::error::short;
use saltus_bounce::walls::{Face, Walls};

/// Ground y = f(x) and the radius of the ball on it.
///
/// The centre over the foot u of its perpendicular is at x = u - R f'(u)/w, y = f(u) + R/w with w =
/// √(1 + f'²): parallel curves share their tangents, so dy/dx = f'(u) and d²y/dx² = f''(u)/(1 - R
/// f''/w³). In a hollow narrower than the ball there is no such curve, and it is refused.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    shape: Shape,
    radius: f64,
}

impl Curve {
    pub(super) fn of(shape: Shape, radius: f64) -> Result<Self, String> {
        let hollow = shape.hollow();
        if radius * hollow >= 1.0 {
            let narrow = short(1.0 / hollow);
            return Err(format!(
                "the ball's radius of {radius} m does not fit into the hollow, whose radius of curvature is {narrow} m: make one smaller or the other wider"
            ));
        }
        Ok(Self { shape, radius })
    }

    /// f, f' and f''.
    fn ground(&self, x: f64) -> [f64; 3] {
        self.shape.curve(x).unwrap_or_default()
    }

    /// The foot of the perpendicular from a centre over x: the root of a rising function, by Newton
    /// within a bracket.
    fn foot(&self, x: f64) -> f64 {
        let r = self.radius;
        if r == 0.0 {
            return x;
        }
        let (mut low, mut high) = (x - r, x + r);
        let mut u = x;
        for _ in 0..100 {
            let [_, slope, curve] = self.ground(u);
            let w = slope.hypot(1.0);
            let off = (u - x) - r * slope / w;
            if off > 0.0 {
                high = u;
            } else {
                low = u;
            }
            let step = off / (1.0 - r * curve / (w * w * w));
            let next = if (low..=high).contains(&(u - step)) { u - step } else { 0.5 * (low + high) };
            if (next - u).abs() <= 4.0 * f64::EPSILON * (x.abs() + r) {
                return next;
            }
            u = next;
        }
        u
    }

    /// The height of the lowest point over x, its slope and curve.
    fn level(&self, x: f64) -> [f64; 3] {
        let r = self.radius;
        let [height, slope, curve] = self.ground(self.foot(x));
        let w = slope.hypot(1.0);
        // R/w - R without cancellation.
        let sunk = -r * slope * slope / (w * (1.0 + w));
        [height + sunk, slope, curve / (1.0 - r * curve / (w * w * w))]
    }
}

impl Walls<2> for Curve {
    fn margin(&self, _: Face, _: f64, p: &Vector2<f64>) -> f64 {
        p[1] - self.level(p[0])[0]
    }
    fn gradient(&self, _: Face, _: f64, p: &Vector2<f64>) -> SVector<f64, 2> {
        Vector2::new(-self.level(p[0])[1], 1.0)
    }
    fn bend(&self, _: Face, _: f64, p: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        -self.level(p[0])[2] * v[0] * v[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parallel_curve_keeps_its_distance_and_its_derivatives() {
        let shape = Shape::Sine { amplitude: 0.1, wavelength: 1.0, phase: 0.3, height: 0.2 };
        let curve = Curve::of(shape.clone(), 0.15).unwrap();
        for n in 0..50 {
            let x = f64::from(n) * 0.04;
            let [y, slope, bend] = curve.level(x);
            let centre = y + 0.15;
            let near = (0..20_000)
                .map(|k| {
                    let u = x - 0.2 + f64::from(k) * 2e-5;
                    (u - x).hypot(curve.ground(u)[0] - centre)
                })
                .fold(f64::INFINITY, f64::min);
            assert!((near - 0.15).abs() < 1e-8, "{x}: {near}");
            let h = 1e-4;
            let (low, high) = (curve.level(x - h), curve.level(x + h));
            assert!(((high[0] - low[0]) / (2.0 * h) - slope).abs() < 1e-5 * (1.0 + slope.abs()));
            assert!(((high[1] - low[1]) / (2.0 * h) - bend).abs() < 1e-4 * (1.0 + bend.abs()));
        }
        assert!(Curve::of(shape, 0.3).is_err());
    }
}
