//! When a contact with a linear law turns and ends.

use crate::contact::{ContactLaw, KelvinVoigt};
use crate::stable::increasing_root;

/// A linear contact of a mass under a constant load: m d'' + c d' + k (d - d₀) = 0 about the static
/// deformation d₀ = load/k.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    law: KelvinVoigt,
    mass: f64,
    load: f64,
    /// ω₀² = k/m.
    square: f64,
    /// β = c/(2m).
    beta: f64,
}

impl Linear {
    pub(super) fn new(law: KelvinVoigt, mass: f64, load: f64) -> Self {
        Self { law, mass, load, square: law.stiffness(0.0, 0.0) / mass, beta: 0.5 * law.damping(0.0, 0.0) / mass }
    }

    /// Deformation and rate after `s` seconds.
    pub(super) fn after(&self, s: f64, x: [f64; 2]) -> [f64; 2] {
        self.law.after(s, x, self.mass, self.load)
    }

    /// The first s > 0 with tan(ωs)/ω = `opposite`/`adjacent`, for `opposite` ≥ 0 and ω² = ω₀² -
    /// β²; tanh beyond critical damping.
    fn angle(&self, opposite: f64, adjacent: f64) -> Option<f64> {
        let off = self.square - self.beta * self.beta;
        if off > 0.0 {
            let omega = off.sqrt();
            return Some((omega * opposite).atan2(adjacent) / omega);
        }
        let rate = (-off).sqrt();
        let quotient = opposite / adjacent;
        if !(quotient > 0.0 && rate * quotient < 1.0) {
            None
        } else if rate == 0.0 {
            Some(quotient)
        } else {
            Some((rate * quotient).atanh() / rate)
        }
    }

    /// The time at which the rate of a solution z of the free equation next changes its sign:
    /// tan(ωs)/ω = z'/(βz' + ω₀²z).
    fn turn_of(&self, z: f64, rate: f64) -> Option<f64> {
        let upwards = rate > 0.0 || (rate == 0.0 && z < 0.0);
        let adjacent = self.beta * rate + self.square * z;
        if adjacent == 0.0 && rate == 0.0 {
            return None; // at rest
        }
        self.angle(rate.abs(), if upwards { adjacent } else { -adjacent })
    }

    /// The time at which the deformation is next greatest or least.
    pub(super) fn turn(&self, [d, u]: [f64; 2]) -> Option<f64> {
        self.turn_of(d - self.load / self.law.stiffness(d, u), u)
    }

    /// The time at which the contact ends, during restitution.
    ///
    /// Its margin, the force or (with tension) the deformation, is the static one plus a solution z
    /// of the free equation. z falls from where it is zero to its least value: the margin is zero
    /// in between, or never again, since later swings are smaller.
    pub(super) fn release(&self, x: [f64; 2]) -> Option<f64> {
        let [d, u] = x;
        let (k, c) = (self.law.stiffness(d, u), self.law.damping(d, u));
        let (level, z, rate) = if self.law.has_tension() {
            let level = self.load / k;
            (level, d - level, u)
        } else {
            let z = self.law.force(d, u) - self.load;
            (self.load, z, k * u - c * z / self.mass)
        };
        let (zero, least) = if z > 0.0 {
            let zero = self.angle(z, -(rate + self.beta * z))?;
            if level == 0.0 {
                return Some(zero);
            }
            (zero, zero + self.angle(1.0, self.beta)?)
        } else if rate < 0.0 {
            (0.0, self.turn_of(z, rate)?)
        } else {
            return None;
        };
        let lost = |s: f64| {
            let [d, u] = self.after(s, x);
            let rate =
                if self.law.has_tension() { u } else { k * u + c * (self.load - self.law.force(d, u)) / self.mass };
            (-self.law.margin(d, u), -rate)
        };
        (lost(least).0 > 0.0).then(|| increasing_root(lost, zero, least, 0.5 * (zero + least)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// The rate and the margin are zero when announced, not before, and they fall there.
        #[test]
        fn turns_and_releases(
            zeta in 0.0..3.0_f64, log_k in 2.0..12.0_f64, load in 0.0..20.0_f64, v in 1e-3..10.0_f64, tension in any::<bool>(),
        ) {
            let (k, mass) = (10.0_f64.powf(log_k), 0.7);
            let law = KelvinVoigt::new(k, 2.0 * zeta * (k * mass).sqrt()).unwrap();
            let law = if tension { law.with_tension() } else { law };
            let contact = Linear::new(law, mass, load);
            let start = [0.0, v];
            let Some(turn) = contact.turn(start) else {
                prop_assert!(zeta > 1.0); // creeps to the static deformation
                return Ok(());
            };
            let [d, u] = contact.after(turn, start);
            prop_assert!(u.abs() < 1e-12 * v && d > 0.0, "{u}");
            for part in [0.1, 0.5, 0.99] {
                prop_assert!(contact.after(part * turn, start)[1] > 0.0);
            }
            let top = [d, 0.0];
            let (release, next) = (contact.release(top), contact.turn(top));
            let end = release.or(next).unwrap_or(100.0 * turn);
            if let Some(release) = release {
                let [d, u] = contact.after(release, top);
                prop_assert!(law.margin(d, u).abs() <= 1e-12 * law.margin(top[0], 0.0), "{d} {u}");
                prop_assert!(next.is_none_or(|next| next >= release || !tension));
            }
            for part in [0.1, 0.5, 0.99] {
                let [d, u] = contact.after(part * end, top);
                prop_assert!(law.margin(d, u) > 0.0 && (u <= 0.0 || release.is_some()), "{part}: {d} {u}");
            }
        }
    }
}
