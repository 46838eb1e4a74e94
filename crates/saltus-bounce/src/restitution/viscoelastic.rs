//! Restitution of viscoelastic spheres: e falls slowly from 1 as the impact quickens.

use super::{Cor, Restitution};
use crate::parameter::{ParameterError, not_negative, positive};
use crate::stable::increasing_root;

/// A viscoelastic sphere: e = 1 - C₁ x² + C₂ x⁴ ∓ …, x² = β v^(1/5), C₁ = 1.15345, C₂ = (3/5) C₁².
///
/// The contact force is F = k (d^(3/2) + (3/2) A √d d'), never tensile, and β = (3/2) A
/// (k/m)^(2/5), where k is the Hertz stiffness in N/m^(3/2), A the dissipation time in s, m the
/// effective mass in kg, v the speed of impact in m/s. The series diverges; the law evaluated is
/// the Padé approximant e = (1 + 0.501086 x)/(1 + 0.501086 x + 1.15345 x² + 0.577977 x³ + 0.532178
/// x⁴).
///
/// Limits: against direct integration of the force it errs by 5e-5 in e at x² = 0.1 (e = 0.89),
/// 7e-4 at 0.3 (0.72), 5e-3 at 1 (0.39). No plastic deformation, no adhesion; slow against sound.
/// Sources: R. Ramírez et al., Phys. Rev. E 60, 4465 (1999), doi:10.1103/PhysRevE.60.4465; T.
/// Schwager and T. Pöschel, Phys. Rev. E 78, 051304 (2008), doi:10.1103/PhysRevE.78.051304; P.
/// Müller and T. Pöschel, Phys. Rev. E 84, 021302 (2011), doi:10.1103/PhysRevE.84.021302.
///
/// ```
/// use saltus_bounce::restitution::{Cor, Restitution, Viscoelastic};
/// let ice = Viscoelastic::through(Cor::new(0.6)?, 0.01)?; // e = 0.6 at 1 cm/s
/// assert!((ice.cor(0.01).value() - 0.6).abs() < 1e-15);
/// assert!(ice.cor(0.001) > ice.cor(0.01));
/// assert_eq!(ice.cor(0.0).value(), 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viscoelastic {
    /// √β.
    root_beta: f64,
}

const PADE: [f64; 4] = [0.501_086, 1.153_45, 0.577_977, 0.532_178];

impl Viscoelastic {
    /// Viscoelastic impact by the dissipation time A in s, the Hertz stiffness k in N/m^(3/2) and
    /// the effective mass m in kg.
    ///
    /// # Errors
    /// [`ParameterError`] unless A is finite and not negative, k and m finite and positive.
    pub fn new(dissipation: f64, stiffness: f64, mass: f64) -> Result<Self, ParameterError> {
        let a = not_negative("a dissipation time in s", dissipation)?;
        let k = positive("a Hertz stiffness in N/m^1.5", stiffness)?;
        let m = positive("a mass in kg", mass)?;
        Ok(Self { root_beta: (1.5 * a).sqrt() * (k / m).powf(0.2) })
    }

    /// The law that gives `cor` at the speed `impact` in m/s.
    ///
    /// # Errors
    /// [`ParameterError`] unless `cor` is above zero (the law never reaches it) and `impact` is
    /// finite and positive.
    pub fn through(cor: Cor, impact: f64) -> Result<Self, ParameterError> {
        let e = positive("a coefficient of restitution that a viscoelastic sphere can have", cor.value())?;
        let v = positive("a speed of impact in m/s", impact)?;
        // 1/e - 1 = (…) grows with x; beyond the first step the root lies below the one of the
        // leading term.
        let lost = |x: f64| {
            let [a, b, c, d] = PADE;
            let over = x * x * (b + x * (c + x * d));
            let slope = x * (2.0 * b + x * (3.0 * c + x * 4.0 * d));
            let under = 1.0 + a * x;
            (over / under - (1.0 - e) / e, (slope * under - over * a) / (under * under))
        };
        let largest = 1.0 + (4.0 * (1.0 - e) / e).cbrt();
        let x = increasing_root(lost, 0.0, largest, ((1.0 - e) / (e * PADE[1])).sqrt());
        Ok(Self { root_beta: x / v.powf(0.1) })
    }

    /// e at the speed `impact` in m/s.
    #[must_use]
    pub fn cor(&self, impact: f64) -> Cor {
        let [a, b, c, d] = PADE;
        let x = self.root_beta * impact.max(0.0).powf(0.1);
        let top = 1.0 + a * x;
        Cor::within(top / (top + x * x * (b + x * (c + x * d))))
    }
}

impl Restitution for Viscoelastic {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        self.cor(impact).rebound(impact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The force law integrated by Runge and Kutta until it would pull.
    #[test]
    fn the_integrated_contact() {
        for (beta, integrated, error) in
            [(0.001, 0.998_847_357, 1e-8), (0.1, 0.892_858_9, 5e-5), (0.3, 0.722_085, 7e-4), (1.0, 0.393_931, 5e-3)]
        {
            let e = Viscoelastic::new(beta / 1.5, 1.0, 1.0).unwrap().cor(1.0).value();
            assert!((e - integrated).abs() < error, "{beta}: {e}");
        }
    }

    proptest! {
        #[test]
        fn a_planted_law_is_found_again(e in 0.01..=1.0_f64, log_v in -6.0..6.0_f64) {
            let v = 10.0_f64.powf(log_v);
            let law = Viscoelastic::through(Cor::new(e).unwrap(), v).unwrap();
            prop_assert!((law.cor(v).value() - e).abs() < 1e-14, "{} {}", law.cor(v).value(), e);
        }
    }
}
