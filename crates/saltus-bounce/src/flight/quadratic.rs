//! Vertical flight with quadratic drag: two smooth modes, rising and falling.

use std::f64::consts::LN_2;

use nalgebra::{Vector2, vector};

use super::{Apex, Impact, VerticalFlight};
use crate::parameter::{ParameterError, not_negative};
use crate::stable::{artanh_ratio, ln_1p, log_ratio, phi1, ratio};

/// v' = -g - k v|v|: rising, v = w tan(atan(v₀/w) - ωs); falling, v = -w tanh(artanh(u₀/w) + ωs).
///
/// g in m/s², k in 1/m; terminal velocity w = √(g/k), rate ω = √(gk). k = ρ C A/(2m) from the
/// density of the air, the drag coefficient, the area of the cross-section and the mass. The apex
/// is at s = atan(v₀/w)/ω, ln(1 + v₀²/w²)/(2k) above the start; a fall through h from speed u ends
/// at the speed √(u² e^(-2kh) + w² (1 - e^(-2kh))). Evaluated by addition theorems, not as written:
/// neither k → 0, nor g → 0, nor a start faster than terminal, nor a fall of 10⁵ times 1/k loses
/// digits.
///
/// Limits: a constant drag coefficient, that is Reynolds numbers between some 10³ and the drag
/// crisis (3×10⁵ for a smooth sphere). Source: I. Newton, *Principia* (1687), book 2, propositions
/// 8 and 9.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::flight::{QuadraticDragFlight, VerticalFlight};
/// let flight = QuadraticDragFlight::new(9.81, 0.1)?;
/// let impact = flight.impact(&vector![20.0, 0.0]).unwrap();
/// assert!((impact.time - 2.714_447_414_842_532).abs() < 1e-14);
/// assert!((impact.speed - 9.813_421_208_987_984).abs() < 1e-14);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticDragFlight {
    gravity: f64,
    drag: f64,
    /// ω = √(gk).
    rate: f64,
    /// 1/w² = k/g, the share of drag in the acceleration per square of the speed.
    share: f64,
    /// 1/(2k).
    length: f64,
}

/// Beside one it is nothing, yet it is far from the smallest numbers, which have few digits.
const NOTHING: f64 = 1e-280;

impl QuadraticDragFlight {
    /// A flight under `gravity` in m/s² with k = `drag` in 1/m.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite and not negative.
    pub fn new(gravity: f64, drag: f64) -> Result<Self, ParameterError> {
        let gravity = not_negative("a gravity in m/s^2", gravity)?;
        let drag = not_negative("a quadratic drag in 1/m", drag)?;
        let drag = if drag.is_subnormal() { 0.0 } else { drag };
        let share = if gravity > 0.0 { drag / gravity } else { 0.0 };
        Ok(Self { gravity, drag, rate: gravity.sqrt() * drag.sqrt(), share, length: 0.5 / drag })
    }

    /// The acceleration with drag downwards, as on the way up, whatever the sign of the velocity.
    #[inline]
    pub(crate) fn rising(&self, velocity: f64) -> f64 {
        -self.gravity - self.drag * velocity * velocity
    }

    /// The rise within `s` seconds from `v` upwards, at most until the apex, and the velocity then.
    fn risen(&self, s: f64, v: f64) -> (f64, f64) {
        let (g, k, z) = (self.gravity, self.drag, self.rate * s);
        // cos ωs + (v/w) sin ωs = 1 + k b
        let half = ratio(f64::sin, 0.5 * z);
        let b = s * (v * ratio(f64::sin, z) - 0.5 * g * s * half * half);
        let tan = s * ratio(f64::tan, z);
        (b * log_ratio(k * b), ((v - g * tan) / (1.0 + k * v * tan)).max(0.0))
    }

    /// The depth fallen after `s` seconds from `u` downwards, and the speed then.
    fn fallen(&self, s: f64, u: f64) -> (f64, f64) {
        let (g, k, z) = (self.gravity, self.drag, self.rate * s);
        let tanh = s * ratio(f64::tanh, z);
        let speed = (u + g * tanh) / (1.0 + k * u * tanh);
        let depth = if z <= 20.0 {
            // cosh ωs + (u/w) sinh ωs = 1 + k b
            let half = ratio(f64::sinh, 0.5 * z);
            let b = s * (u * ratio(f64::sinh, z) + 0.5 * g * s * half * half);
            b * log_ratio(k * b)
        } else {
            // The same with e^(ωs)/2 taken out; e^(-2ωs) < 1e-17 is nothing beside 1.
            (z + (0.5 * (u * (k / g).sqrt() - 1.0)).ln_1p()) / k
        };
        (depth, speed)
    }
}

impl VerticalFlight for QuadraticDragFlight {
    #[inline]
    fn acceleration(&self, velocity: f64) -> f64 {
        -self.gravity - self.drag * velocity * velocity.abs()
    }

    fn after(&self, s: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let (y, v) = (x[0], x[1]);
        if v <= 0.0 {
            let (depth, speed) = self.fallen(s, -v);
            return vector![y - depth, -speed];
        }
        match self.apex(v) {
            Some(apex) if s > apex.time => {
                let (depth, speed) = self.fallen(s - apex.time, 0.0);
                vector![y + apex.rise - depth, -speed]
            }
            _ => {
                let (rise, velocity) = self.risen(s, v);
                vector![y + rise, velocity]
            }
        }
    }

    fn apex(&self, velocity: f64) -> Option<Apex> {
        let (v, g) = (velocity, self.gravity);
        (v > 0.0 && g > 0.0).then(|| {
            let (time, share) = (v / g, v * v * self.share);
            // The next fall waits for the rise: no more divisions than must be.
            let rise = if share < NOTHING { 0.5 * v * time } else { self.length * ln_1p(share) };
            Apex { time: time * ratio(f64::atan, self.rate * time), rise }
        })
    }

    fn fall(&self, depth: f64, speed: f64) -> Option<Impact> {
        let (g, k, u) = (self.gravity, self.drag, speed);
        if depth == 0.0 {
            return Some(Impact { time: 0.0, speed });
        }
        let through = -2.0 * k * depth;
        // e^(-2kh) and the same less one, neither by cancellation
        let (left, lost) = if through > -LN_2 {
            let lost = through.exp_m1();
            (1.0 + lost, lost)
        } else {
            let left = through.exp();
            (left, left - 1.0)
        };
        // (1 - e^(-2kh))/(2k)
        let reach = if through > -NOTHING { depth } else { -lost * self.length };
        let end = (u * u * left + 2.0 * g * reach).sqrt();
        if g == 0.0 {
            return (u > 0.0).then(|| Impact { time: depth / u * phi1(k * depth), speed: u * (-k * depth).exp() });
        }
        // Of tanh ωs = ω (u₁ - u)/(g - k u u₁), with the zeros at u₁ = u and at u = w divided out:
        // positive terms only.
        let sum = end + u * left;
        let t = 2.0 * reach / sum;
        let tanh = self.rate * t;
        let time = if tanh < 0.5 {
            t * artanh_ratio(tanh)
        } else {
            // artanh from 1 - tanh, which is a quotient of positive terms too, times e^(-2kh).
            let w = g / self.rate;
            let rest = (1.0 + tanh) * (w + end) * sum / ((w + u) * (u + end));
            (k * depth + 0.5 * rest.ln()) / self.rate
        };
        Some(Impact { time, speed: end })
    }
}
