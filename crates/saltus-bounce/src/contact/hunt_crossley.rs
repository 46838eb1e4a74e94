//! Hertz contact with damping in proportion to the force.

use std::f64::consts::PI;

use super::{Collision, ContactLaw, happens};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::restitution::Cor;
use crate::stable::{increasing_root, log_excess};

/// Hunt and Crossley's contact: F = d^(3/2) (k + χ u).
///
/// k in N/m^(3/2), χ in N s/m^(5/2). A collision at speed v depends on δ = χv/k alone: e from δ(1 +
/// e) = ln((1 + δ)/(1 - δe)), about 1 - 2δ/3 for weak damping and 1/δ for strong; greatest
/// deformation ((5/2)(m v²/k)(δ - ln(1 + δ))/δ²)^(2/5). The duration has no closed form: it is a
/// quadrature with its end singularities taken out, to twelve digits for δ up to 40, six at 100.
///
/// The force is continuous at touch and release, and does not pull: within a collision u > -k/χ
/// always. Limits as for [`Hertz`](super::Hertz). Sources: K. H. Hunt and F. R. E. Crossley, J.
/// Appl. Mech. 42, 440 (1975), doi:10.1115/1.3423596; D. W. Marhefka and D. E. Orin, IEEE Trans.
/// Syst. Man Cybern. A 29, 566 (1999), doi:10.1109/3468.798060, for the exact relation.
///
/// ```
/// use saltus_bounce::{Cor, contact::{ContactLaw, HuntCrossley}};
/// let hit = HuntCrossley::new(1e6, 2.5e5)?.collision(0.1, 2.0).unwrap();
/// assert!((hit.cor.value() - 0.748_434_931_597_434_2).abs() < 1e-15);
/// assert!((hit.duration - 0.004_605_886_344_821_522).abs() < 1e-15);
/// // A ball of 58 g that comes in at 7 m/s and bounces with e = 0.75 after 4 ms:
/// let tennis = HuntCrossley::from_collision(0.058, 7.0, Cor::new(0.75)?, 0.004)?;
/// assert!((tennis.collision(0.058, 7.0).unwrap().cor.value() - 0.75).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HuntCrossley {
    constant: f64,
    damping: f64,
}

impl HuntCrossley {
    /// A Hunt–Crossley contact with k = `constant` in N/m^(3/2) and χ = `damping` in N s/m^(5/2).
    ///
    /// # Errors
    /// [`ParameterError`] unless k is finite and positive, χ finite and not negative.
    pub fn new(constant: f64, damping: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            constant: positive("a Hertz stiffness in N/m^1.5", constant)?,
            damping: not_negative("a Hunt-Crossley damping in N s/m^2.5", damping)?,
        })
    }

    /// A contact with k = `constant` in N/m^(3/2), damped so that the COR is `cor` at `speed` in
    /// m/s.
    ///
    /// # Errors
    /// [`ParameterError`] unless `cor` is above zero (no damping is enough for zero) and the others
    /// are finite and positive.
    pub fn with_cor(constant: f64, speed: f64, cor: Cor) -> Result<Self, ParameterError> {
        let e = positive("a coefficient of restitution of a damped contact", cor.value())?;
        let v = positive("a speed in m/s", speed)?;
        // The relation divided by δ²: e² ψ(-δe) = ψ(δ), ψ(z) = (z - ln(1 + z))/z².
        let delta = increasing_root(
            |delta| {
                let (low, high) = (log_excess(-delta * e), log_excess(delta));
                (e * e * low - high, -e * e * e * bend(-delta * e, low) - bend(delta, high))
            },
            0.0,
            1.0 / e,
            1.5 * (1.0 - e),
        );
        Self::new(constant, delta * positive("a Hertz stiffness in N/m^1.5", constant)? / v)
    }

    /// The law by which `mass` in kg at `speed` in m/s rebounds with `cor` after `duration` in s.
    ///
    /// # Errors
    /// [`ParameterError`] unless `cor` is above zero and the others are finite and positive.
    pub fn from_collision(mass: f64, speed: f64, cor: Cor, duration: f64) -> Result<Self, ParameterError> {
        let m = positive("a mass in kg", mass)?;
        let t = positive("a duration in s", duration)?;
        // At fixed δ the duration goes with k^(-2/5).
        let unit = Self::with_cor(1.0, speed, cor)?;
        let longer = unit.collision(m, speed).map_or(1.0, |hit| hit.duration) / t;
        let constant = longer * longer * longer.sqrt();
        Self::new(constant, unit.damping * constant)
    }
}

/// ψ'(z) for ψ(z) = (z - ln(1 + z))/z².
fn bend(z: f64, psi: f64) -> f64 {
    if z.abs() < 1e-4 { -1.0 / 3.0 + 0.5 * z } else { (1.0 / (1.0 + z) - 2.0 * psi) / z }
}

/// e and 1 - δe at the damping δ.
fn rebound(delta: f64) -> (f64, f64) {
    if delta == 0.0 {
        (1.0, 1.0)
    } else if delta < 1.0 {
        // -ε - ln(1 - ε) = δ - ln(1 + δ), ε = δe.
        let loss = delta * delta * log_excess(delta);
        let guess = delta * (1.0 - 2.0 / 3.0 * delta).max(0.3);
        let epsilon =
            increasing_root(|x| (x * x * log_excess(-x) - loss, x / (1.0 - x)), 0.0, delta.min(1.0 - 1e-9), guess);
        (epsilon / delta, 1.0 - epsilon)
    } else {
        // The same for 1 - ε = e^(-p), which ε itself would lose.
        let level = 1.0 + delta - delta.ln_1p();
        let p = increasing_root(|p| (p + (-p).exp() - level, -(-p).exp_m1()), 0.0, level, level);
        let gap = (-p).exp();
        ((1.0 - gap) / delta, gap)
    }
}

/// ∫ f over 0..=end, where f may grow like x^(-3/5) towards 0: the double exponential rule.
fn integral(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 64.0;
    (-290..=210).fold(0.0, |sum, n| {
        let tau = f64::from(n) * STEP;
        let x = 1.0 / (1.0 + (-PI * tau.sinh()).exp());
        // 1 - x, without cancellation
        let rest = 1.0 / (1.0 + (PI * tau.sinh()).exp());
        let weight = PI * tau.cosh() * x * rest;
        if weight > 0.0 { sum + STEP * end * weight * f(end * x) } else { sum }
    })
}

/// The durations of compression and of restitution, in units of (m v/k) D^(-3/2), D = ((5/2) m
/// v²/k)^(2/5).
///
/// (d/D)^(5/2) = Φ(y) = ∫ y dy/(1 + δy) from y = u/v to 1, written in the distance from either end;
/// dt = -dy Φ^(-3/5)/(1 + δy).
fn durations(delta: f64, e: f64, gap: f64) -> (f64, f64) {
    let compression = integral(1.0, |x| {
        let y = x / (1.0 + delta);
        let phi = y - y * y * log_excess(-delta * y);
        phi.powf(-0.6) / (1.0 + delta - delta * x)
    });
    let restitution = integral(e, |x| {
        let y = x / gap;
        let phi = if delta * y > 0.5 {
            ((delta * y).ln_1p() - delta * x) / (delta * delta)
        } else {
            y * e - y * y * log_excess(delta * y)
        };
        phi.powf(-0.6) / (gap + delta * x)
    });
    (compression, restitution)
}

impl ContactLaw for HuntCrossley {
    #[inline]
    fn force(&self, deformation: f64, rate: f64) -> f64 {
        let d = deformation.max(0.0);
        d * d.sqrt() * (self.constant + self.damping * rate)
    }

    #[inline]
    fn stiffness(&self, deformation: f64, rate: f64) -> f64 {
        1.5 * deformation.max(0.0).sqrt() * (self.constant + self.damping * rate)
    }

    #[inline]
    fn damping(&self, deformation: f64, _rate: f64) -> f64 {
        let d = deformation.max(0.0);
        self.damping * d * d.sqrt()
    }

    fn collision(&self, mass: f64, speed: f64) -> Option<Collision> {
        if !happens(mass, speed) {
            return None;
        }
        let (k, m, v) = (self.constant, mass, speed);
        let delta = self.damping * v / k;
        let (e, gap) = rebound(delta);
        let size = (2.5 * m / k * v * v).powf(0.4);
        let (compression, restitution) = durations(delta, e, gap);
        let unit = m / k * v / (size * size.sqrt());
        Some(Collision {
            cor: Cor::within(e),
            duration: unit * (compression + restitution),
            compression: unit * compression,
            deformation: size * log_excess(delta).powf(0.4),
            force: k * size * size.sqrt() * hardest(delta),
        })
    }
}

/// The greatest of Φ^(3/5) (1 + δy): where (3/5) y = δ Φ, in compression.
fn hardest(delta: f64) -> f64 {
    let phi = |y: f64| {
        let x = (1.0 - y) / (1.0 + delta);
        x - x * x * log_excess(-delta * x)
    };
    let y = increasing_root(
        |y| (0.6 * y - delta * phi(y), 0.6 + delta * y / (1.0 + delta * y)),
        0.0,
        1.0,
        delta / (1.2 + delta),
    );
    phi(y).powf(0.6) * (1.0 + delta * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Cor and duration are found again, for weak damping and strong.
        #[test]
        fn a_planted_collision(e in 0.03..=1.0_f64, log_t in -6.0..0.0_f64, m in 1e-3..10.0_f64, v in 1e-3..100.0_f64) {
            let t = 10.0_f64.powf(log_t);
            let hit = HuntCrossley::from_collision(m, v, Cor::new(e).unwrap(), t).unwrap().collision(m, v).unwrap();
            prop_assert!((hit.cor.value() / e - 1.0).abs() < 1e-14 && (hit.duration / t - 1.0).abs() < 1e-12, "{hit:?}");
        }

        /// The relation between e and δ holds, over the change of formula at δ = 1 and down to no
        /// damping at all.
        #[test]
        fn the_exact_relation(log_delta in -12.0..1.5_f64) {
            let delta = 10.0_f64.powf(log_delta);
            let (e, gap) = rebound(delta);
            let (low, high) = (e * e * log_excess(-delta * e), log_excess(delta));
            prop_assert!((low - high).abs() < 1e-14 / gap, "{delta}: {e}");
            prop_assert!(delta > 0.1 || (e - (1.0 - 2.0 / 3.0 * delta)).abs() < delta * delta + 1e-15);
        }
    }

    /// Without damping it is Hertz's law.
    #[test]
    fn hertz_is_the_limit() {
        let hertz = super::super::Hertz::new(1e8).unwrap().collision(0.1, 2.0).unwrap();
        for chi in [0.0, 1e-10] {
            let hit = HuntCrossley::new(1e8, chi).unwrap().collision(0.1, 2.0).unwrap();
            assert_eq!(hit.cor, hertz.cor);
            for (got, expected) in [
                (hit.duration, hertz.duration),
                (hit.compression, hertz.compression),
                (hit.deformation, hertz.deformation),
                (hit.force, hertz.force),
            ] {
                assert!((got / expected - 1.0).abs() < 1e-14, "{got} {expected}");
            }
        }
    }
}
