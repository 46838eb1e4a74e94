//! A linear spring beside a linear damper.

use std::f64::consts::PI;

use super::{Collision, ContactLaw, happens};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::restitution::Cor;
use crate::stable::{increasing_root, phi1, ratio};

/// Kelvin–Voigt contact: F = k d + c u, until F = 0, or with tension until d = 0.
///
/// k in N/m, c in N s/m. With ω = √(k/m), ζ = c/(2mω) and G = arccos ζ/√(1 - ζ²) (arcosh
/// ζ/√(ζ² - 1) beyond critical damping): greatest deformation (v/ω) e^(-ζG) after G/ω; release
/// after 2G/ω with e = e^(-2ζG), independent of the speed, while the ball is still pressed in by c
/// e v/k. With tension: release after π/(ω√(1 - ζ²)) with e = exp(-πζ/√(1 - ζ²)), and never for ζ
/// ≥ 1. Greatest force: mωv exp(-ζ(3 arccos ζ - π)/√(1 - ζ²)) for ζ < 1/2, else c v at first touch.
///
/// Limits: the force jumps to c v at touch. After a release under pressure the ball is taken to be
/// round again at the next touch. Source: T. Schwager and T. Pöschel, Granular Matter 9, 465
/// (2007), arXiv:cond-mat/0701278.
///
/// ```
/// use saltus_bounce::{Cor, contact::{ContactLaw, KelvinVoigt}};
/// let law = KelvinVoigt::new(1e3, 4.0)?;
/// assert!((law.collision(0.5, 3.0).unwrap().cor.value() - 0.766_410_413_045_874_8).abs() < 1e-15);
/// assert!((law.with_tension().collision(0.5, 3.0).unwrap().cor.value() - 0.754_180_651_595_126_6).abs() < 1e-15);
/// // A ball of 58 g that bounces with e = 0.75 after 4 ms on the floor:
/// let tennis = KelvinVoigt::from_collision(0.058, Cor::new(0.75)?, 0.004)?;
/// assert!((tennis.collision(0.058, 7.0).unwrap().duration - 0.004).abs() < 1e-17);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KelvinVoigt {
    spring: f64,
    damper: f64,
    tension: bool,
}

impl KelvinVoigt {
    /// Without tension, with the stiffness k = `spring` in N/m and c = `damper` in N s/m.
    ///
    /// # Errors
    /// [`ParameterError`] unless k is finite and positive, c finite and not negative.
    pub fn new(spring: f64, damper: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            spring: positive("a stiffness in N/m", spring)?,
            damper: not_negative("a damping in N s/m", damper)?,
            tension: false,
        })
    }

    /// The law, without tension, by which `mass` in kg rebounds with `cor` after `duration` in s.
    ///
    /// # Errors
    /// [`ParameterError`] unless `cor` is above zero (no damping is enough for zero) and the others
    /// are finite and positive.
    pub fn from_collision(mass: f64, cor: Cor, duration: f64) -> Result<Self, ParameterError> {
        let m = positive("a mass in kg", mass)?;
        let t = positive("a duration in s", duration)?;
        let lost = -positive("a coefficient of restitution of a damped spring", cor.value())?.ln();
        let zeta = increasing_root(
            |zeta| {
                let g = swing(zeta);
                let off = (1.0 - zeta) * (1.0 + zeta);
                let bend = if off.abs() < 1e-6 { -1.0 / 3.0 } else { (zeta * g - 1.0) / off };
                (2.0 * zeta * g - lost, 2.0 * (g + zeta * bend))
            },
            0.0,
            (0.5 * lost).exp(),
            lost / PI,
        );
        let omega = 2.0 * swing(zeta) / t;
        Self::new(m * omega * omega, 2.0 * zeta * m * omega)
    }

    /// The law with tension by which `mass` in kg rebounds with `cor` after `duration` in s.
    ///
    /// # Errors
    /// [`ParameterError`] unless `cor` is above zero (no damping is enough for zero) and the others
    /// are finite and positive.
    pub fn from_sticky_collision(mass: f64, cor: Cor, duration: f64) -> Result<Self, ParameterError> {
        let m = positive("a mass in kg", mass)?;
        let t = positive("a duration in s", duration)?;
        let lost = -positive("a coefficient of restitution of a damped spring", cor.value())?.ln();
        // The motion is a damped half wave of frequency π/t, whose speed decays at the rate
        // c/(2m) = lost/t.
        let (frequency, decay) = (PI / t, lost / t);
        let law = Self::new(m * (frequency * frequency + decay * decay), 2.0 * m * decay)?;
        Ok(law.with_tension())
    }

    /// This spring and damper with adhesion: the contact pulls at its end, and ends only where the
    /// deformation does.
    #[must_use]
    pub const fn with_tension(self) -> Self {
        Self { tension: true, ..self }
    }

    /// Whether the contact pulls before it ends.
    #[must_use]
    pub const fn has_tension(&self) -> bool {
        self.tension
    }

    /// The damping ratio ζ = c/(2√(km)) of a ball of `mass` in kg.
    #[must_use]
    pub fn damping_ratio(&self, mass: f64) -> f64 {
        0.5 * self.damper / (self.spring * mass).sqrt()
    }

    /// Deformation and rate after `s` seconds of contact from `[d, u]`, of `mass` in kg under a
    /// constant `load` in N (its weight, on a level floor): the exact solution, as long as the
    /// contact lasts.
    ///
    /// ```
    /// use saltus_bounce::contact::KelvinVoigt;
    /// let law = KelvinVoigt::new(1e4, 20.0)?;
    /// let [d, u] = law.after(60.0, [0.0, 1.0], 1.0, 9.81);
    /// assert!((d - 9.81e-4).abs() < 1e-18 && u.abs() < 1e-15); // at rest, d = m g/k
    /// # Ok::<(), saltus_bounce::ParameterError>(())
    /// ```
    #[must_use]
    pub fn after(&self, s: f64, [d, u]: [f64; 2], mass: f64, load: f64) -> [f64; 2] {
        let square = self.spring / mass;
        let beta = 0.5 * self.damper / mass;
        let sink = load / self.spring;
        let off = square - beta * beta;
        // e^(-βs) cos ωs and e^(-βs) sin(ωs)/ω, or cosh and sinh beyond critical damping, as
        // decaying exponentials; and how much of the way to the static deformation the load alone
        // has gone from rest, 1 - cos - β sin.
        let (cos, sin, way) = if off >= 0.0 {
            let (omega, decay) = (off.sqrt(), (-beta * s).exp());
            let (cos, sin) = (decay * (omega * s).cos(), decay * s * ratio(f64::sin, omega * s));
            (cos, sin, 1.0 - cos - beta * sin)
        } else {
            let rate = (-off).sqrt();
            // The slow rate β - rate as a quotient, which does not cancel.
            let slower = square / (beta + rate);
            let slow = (-slower * s).exp();
            let fast = (-2.0 * rate * s).exp();
            let sin = slow * s * phi1(-2.0 * rate * s);
            (0.5 * slow * (1.0 + fast), sin, -(-slower * s).exp_m1() - slower * sin)
        };
        let way = if s * s * square.max(beta * beta) < SOON { soon(square, beta, s) } else { way };
        // Beside a great load a shallow deformation has all its digits.
        [d * (cos + beta * sin) + u * sin + sink * way, u * (cos - beta * sin) - square * (d - sink) * sin]
    }
}

/// The square of the part of its own time, 1/ω or 1/β, below which the way from rest is a short
/// series: beyond it, what the closed form cancels is less than a factor of ten. The test
/// `shallow_contacts_have_all_digits` fails without it.
const SOON: f64 = 0.25;

/// The way w from rest to the static deformation, w'' + 2βw' + ω²w = ω² with w = w' = 0, by its
/// Taylor series; `square` is ω².
fn soon(square: f64, beta: f64, s: f64) -> f64 {
    let (mut last, mut term) = (0.0_f64, 0.5 * square * s * s);
    let mut way = 0.0;
    let mut n = 1.0;
    while way + (term.abs() + last.abs()) != way {
        way += term;
        n += 1.0;
        (last, term) = (term, -s * (2.0 * beta * n * term + square * s * last) / (n * (n + 1.0)));
    }
    way
}

/// G(ζ) = arccos ζ/√(1 - ζ²), continued beyond 1.
fn swing(zeta: f64) -> f64 {
    let root = ((1.0 - zeta) * (1.0 + zeta)).abs().sqrt();
    if root == 0.0 {
        1.0
    } else if zeta < 1.0 {
        root.atan2(zeta) / root
    } else {
        (zeta - 1.0 + root).ln_1p() / root
    }
}

impl ContactLaw for KelvinVoigt {
    #[inline]
    fn force(&self, deformation: f64, rate: f64) -> f64 {
        self.spring * deformation + self.damper * rate
    }

    #[inline]
    fn stiffness(&self, _deformation: f64, _rate: f64) -> f64 {
        self.spring
    }

    #[inline]
    fn damping(&self, _deformation: f64, _rate: f64) -> f64 {
        self.damper
    }

    #[inline]
    fn margin(&self, deformation: f64, rate: f64) -> f64 {
        if self.tension { deformation } else { self.force(deformation, rate) }
    }

    #[inline]
    fn linear(&self) -> Option<Self> {
        Some(*self)
    }

    fn collision(&self, mass: f64, speed: f64) -> Option<Collision> {
        let omega = (self.spring / mass).sqrt();
        let zeta = self.damping_ratio(mass);
        let g = swing(zeta);
        let root = ((1.0 - zeta) * (1.0 + zeta)).max(0.0).sqrt();
        let (e, duration) = if self.tension {
            ((-PI * zeta / root).exp(), PI / (omega * root))
        } else {
            ((-2.0 * zeta * g).exp(), 2.0 * g / omega)
        };
        let late = zeta * (PI - 3.0 * zeta.acos()) / root;
        let force = if zeta < 0.5 { mass * omega * speed * late.exp() } else { self.damper * speed };
        (happens(mass, speed) && duration.is_finite()).then(|| Collision {
            cor: Cor::within(e),
            duration,
            compression: g / omega,
            deformation: speed / omega * (-zeta * g).exp(),
            force,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// However slow the touch and however great the load: two spans in turn are one, to the
        /// digits of what the ball has moved, and a short one is that of a constant force.
        #[test]
        fn shallow_contacts_have_all_digits(zeta in prop_oneof![Just(0.0), 0.0..4.0], touch in -12.0..1.0, part in -9.0..1.0) {
            let (m, k, g) = (0.1, 1e4_f64, 9.81);
            let law = KelvinVoigt::new(k, 2.0 * zeta * (k * m).sqrt()).unwrap();
            let (u, s) = (10f64.powf(touch), 10f64.powf(part) * (m / k).sqrt());
            let after = |s, x| law.after(s, x, m, m * g);
            let [whole, halves] = [after(s, [0.0, u]), after(0.5 * s, after(0.5 * s, [0.0, u]))];
            let far = u * s + g * s * s;
            prop_assert!((whole[0] - halves[0]).abs() <= 40.0 * f64::EPSILON * far, "{whole:?} {halves:?}");
            if part < -6.0 {
                let bent = far * s * (k / m).sqrt() * (1.0 + 2.0 * zeta);
                prop_assert!((whole[0] - u * s - 0.5 * g * s * s).abs() <= bent, "{whole:?}");
            }
        }

        /// Cor and duration are found again, from light damping to far beyond critical.
        #[test]
        fn a_planted_collision(e in 1e-6..=1.0_f64, log_t in -6.0..0.0_f64, m in 1e-3..10.0_f64) {
            let t = 10.0_f64.powf(log_t);
            let hit = KelvinVoigt::from_collision(m, Cor::new(e).unwrap(), t).unwrap().collision(m, 2.0).unwrap();
            prop_assert!((hit.cor.value() / e - 1.0).abs() < 1e-13 && (hit.duration / t - 1.0).abs() < 1e-13, "{hit:?}");
            let hit = KelvinVoigt::from_sticky_collision(m, Cor::new(e).unwrap(), t).unwrap().collision(m, 2.0).unwrap();
            prop_assert!((hit.cor.value() / e - 1.0).abs() < 1e-12 && (hit.duration / t - 1.0).abs() < 1e-12, "{hit:?}");
        }

        /// The exact solution starts where it should, composes, and ends the collision as
        /// announced.
        #[test]
        fn the_solution(zeta in 0.0..3.0_f64, s in 0.0..0.01_f64, load in 0.0..10.0_f64) {
            let law = KelvinVoigt::new(1e5, zeta * 2.0 * (0.1 * 1e5_f64).sqrt()).unwrap();
            let start = [1e-4, 0.5];
            let (whole, half) = (law.after(s, start, 0.1, load), law.after(0.5 * s, start, 0.1, load));
            let twice = law.after(0.5 * s, half, 0.1, load);
            prop_assert!((whole[0] - twice[0]).abs() < 1e-15 && (whole[1] - twice[1]).abs() < 1e-12);
            let still = law.after(0.0, start, 0.1, load);
            prop_assert!((still[0] - start[0]).abs() < 1e-19 && still[1] == start[1]);
            let hit = law.collision(0.1, 2.0).unwrap();
            let [d, u] = law.after(hit.duration, [0.0, 2.0], 0.1, 0.0);
            prop_assert!((u + 2.0 * hit.cor.value()).abs() < 1e-13 && law.force(d, u).abs() < 1e-11);
            let [d, u] = law.after(hit.compression, [0.0, 2.0], 0.1, 0.0);
            prop_assert!(u.abs() < 1e-13 && (d - hit.deformation).abs() < 1e-16);
        }
    }
}
