//! Lift by spin.

use nalgebra::{Vector2, Vector3};

use super::jets::times;
use super::{Effect, JetMotion, JetSum, Motion};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::sphere::Sphere;

/// Magnus lift: a = (ρA/2m) C |v|² along ω×v, with the lift coefficient C = κ S/(1 + σ S).
///
/// S = R |ω×v|/v², the spin parameter: the speed of the surface over that of the ball, spin along
/// the flight not counted. v relative to the air in m/s, ω in rad/s. With σ = 0 the lift is linear,
/// a = (ρA/2m) κ R ω×v. Backspin lifts, topspin presses down.
///
/// κ = 1, σ = 0 is a fair account of baseballs for S below 0.3; κ = 1, σ = 2, that is C = 1/(2 +
/// v/(Rω)), of tennis balls. Smooth balls near the drag crisis have an inverse effect, which this
/// law has not. Sources: A. M. Nathan, Am. J. Phys. 76, 119 (2008), doi:10.1119/1.2805242; A.
/// Štěpánek, Am. J. Phys. 56, 138 (1988), doi:10.1119/1.15692.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::{Sphere, effects::{AIR_DENSITY, Effect, Magnus, Motion}};
/// let baseball = Sphere::solid(0.0366, 0.145)?;
/// let lift = Magnus::new(&baseball, AIR_DENSITY, 1.0, 0.0)?;
/// // 42 m/s with backspin of 30 turns a second: S = 0.164, and four tenths of gravity.
/// let spin = 30.0 * std::f64::consts::TAU;
/// let motion = Motion { t: 0.0, position: vector![0.0, 1.8], velocity: vector![42.0, 0.0], spin };
/// let a = lift.acceleration(&motion);
/// assert!(a[0] == 0.0 && (a[1] - 5.15).abs() < 0.01);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnus {
    /// (ρA/2m) κ R.
    slope: f64,
    /// σ R, in m.
    saturation: f64,
}

impl Magnus {
    /// The lift of `ball` in air of `density` in kg/m³, with κ = `slope` and σ = `saturation`.
    ///
    /// # Errors
    /// [`ParameterError`] unless the density is finite and positive, κ and σ finite and not
    /// negative.
    pub fn new(ball: &Sphere, density: f64, slope: f64, saturation: f64) -> Result<Self, ParameterError> {
        let density = positive("a density in kg/m^3", density)?;
        let slope = not_negative("a lift coefficient per spin parameter", slope)?;
        Ok(Self {
            slope: 0.5 * density * ball.cross_section() / ball.mass() * slope * ball.radius(),
            saturation: not_negative("a saturation of lift", saturation)? * ball.radius(),
        })
    }

    /// Lift over ω×v where the spin is slow, (ρA/2m) κR, without a unit.
    #[must_use]
    pub const fn slope(&self) -> f64 {
        self.slope
    }

    /// The factor of ω×v, from |ω×v| and v².
    #[inline]
    fn factor(&self, cross: f64, square: f64) -> f64 {
        // Also right where v = 0: there ω×v is zero, and so is the lift.
        if cross == 0.0 { 0.0 } else { self.slope * square / (square + self.saturation * cross) }
    }
}

/// The plane, with spin positive from the first axis towards the second.
impl Effect<2, f64> for Magnus {
    #[inline]
    fn acceleration(&self, motion: &Motion<2, f64>) -> Vector2<f64> {
        let (v, w) = (motion.velocity, motion.spin);
        let square = v.norm_squared();
        Vector2::new(-v[1], v[0]) * (w * self.factor(w.abs() * square.sqrt(), square))
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, 2>, sum: &mut JetSum<'j, 2>) -> bool {
        let ([x, up], [w, ..]) = (motion.velocity, motion.spin);
        let mut factor = w * self.slope;
        if self.saturation > 0.0 {
            // |w|: the spin of a flight dies away, and keeps its sign.
            let across = w * if w.value() < 0.0 { -self.saturation } else { self.saturation };
            factor *= motion.speed / (motion.speed + across);
        }
        sum.accelerate([up * -factor, x * factor]);
        true
    }
}

/// Space, with spin by the right-hand rule.
impl Effect<3, Vector3<f64>> for Magnus {
    #[inline]
    fn acceleration(&self, motion: &Motion<3, Vector3<f64>>) -> Vector3<f64> {
        let cross = motion.spin.cross(&motion.velocity);
        cross * self.factor(cross.norm(), motion.velocity.norm_squared())
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, 3>, sum: &mut JetSum<'j, 3>) -> bool {
        let ([vx, vy, vz], [wx, wy, wz]) = (motion.velocity, motion.spin);
        let cross = [wy * vz - wz * vy, wz * vx - wx * vz, wx * vy - wy * vx];
        let [x, y, z] = cross;
        if self.saturation == 0.0 {
            sum.accelerate(times(&cross, self.slope.into()));
            return true;
        }
        let across = (x * x + y * y + z * z).sqrt() * self.saturation;
        let square = motion.speed * motion.speed;
        let factor = square * self.slope / (square + across);
        sum.accelerate(times(&cross, factor));
        true
    }
}
