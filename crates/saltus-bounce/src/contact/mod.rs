//! Contact that takes time: the force between ball and floor while the ball is deformed.
//!
//! The deformation d in m is positive while the ball is pressed in, its rate u = d' in m/s positive
//! while it is being pressed further: for a level floor at height zero and a ball's lowest point at
//! y with velocity v, d = -y and u = -v. The force F in N pushes the ball out: m u' = -F (+ m g).
//!
//! A rigid impact with its COR is the limit of infinite stiffness: [`ContactLaw::collision`] gives
//! that COR, and the duration of the contact.

mod hertz;
mod hunt_crossley;
mod kelvin_voigt;

use crate::restitution::Cor;

pub use hertz::{Elastic, Hertz};
pub use hunt_crossley::HuntCrossley;
pub use kelvin_voigt::KelvinVoigt;

/// The outcome of a contact without other forces (gravity, drag), by the speed of impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// The effective coefficient of restitution: speed at release over speed at touch.
    pub cor: Cor,
    /// The time from touch to release, in s.
    pub duration: f64,
    /// The time from touch to the greatest deformation, in s.
    pub compression: f64,
    /// The greatest deformation, in m.
    pub deformation: f64,
    /// The greatest force, in N.
    pub force: f64,
}

/// A law of force for a ball in contact.
///
/// ```
/// use saltus_bounce::contact::{ContactLaw, Hertz};
/// let law = Hertz::new(1e9)?;
/// let hit = law.collision(0.1, 2.0).unwrap();
/// assert!((hit.duration - 0.000_280_148_869_868_221_37).abs() < 1e-17);
/// assert!((hit.force - law.force(hit.deformation, 0.0)).abs() < 1e-11);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
pub trait ContactLaw {
    /// The force in N at `deformation` in m, which changes at `rate` in m/s; zero without
    /// deformation, except for a damper that is hit at once.
    fn force(&self, deformation: f64, rate: f64) -> f64;

    /// ∂F/∂d in N/m, for stiff steppers.
    fn stiffness(&self, deformation: f64, rate: f64) -> f64;

    /// ∂F/∂u in N s/m.
    fn damping(&self, deformation: f64, rate: f64) -> f64;

    /// Positive while the contact lasts; it ends where this falls through zero.
    fn margin(&self, deformation: f64, _rate: f64) -> f64 {
        deformation
    }

    /// This law, if it is a linear one: the motion in contact then has a formula, and no step is
    /// taken.
    fn linear(&self) -> Option<KelvinVoigt> {
        None
    }

    /// The collision of `mass` in kg at `speed` in m/s without other forces; `None` if it never
    /// ends, or for a mass or a speed that is not above zero.
    fn collision(&self, mass: f64, speed: f64) -> Option<Collision>;
}

/// Whether this is a collision at all.
fn happens(mass: f64, speed: f64) -> bool {
    mass > 0.0 && speed > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn laws(k: f64, damping: f64) -> [Box<dyn ContactLaw>; 4] {
        let voigt = KelvinVoigt::new(k, damping * (0.1 * k).sqrt()).unwrap();
        [
            Box::new(Hertz::new(k).unwrap()),
            Box::new(voigt),
            Box::new(voigt.with_tension()),
            Box::new(HuntCrossley::new(k, damping * k).unwrap()),
        ]
    }

    proptest! {
        /// The derivatives are those of the force.
        #[test]
        fn derivatives(k in 1e3..1e6_f64, damping in 0.0..2.0_f64, d in 1e-4..1e-2_f64, u in -0.4..0.4_f64) {
            for law in laws(k, damping) {
                let (hd, hu) = (1e-4 * d, 1e-4);
                let by_d = (law.force(d + hd, u) - law.force(d - hd, u)) / (2.0 * hd);
                let by_u = (law.force(d, u + hu) - law.force(d, u - hu)) / (2.0 * hu);
                prop_assert!((by_d - law.stiffness(d, u)).abs() <= 1e-7 * by_d.abs() + 1e-6);
                prop_assert!((by_u - law.damping(d, u)).abs() <= 1e-7 * by_u.abs() + 1e-6);
            }
        }

        /// Integrated by Runge and Kutta, the contact ends when, as fast as, and after a
        /// deformation as great as announced.
        #[test]
        fn integrated_contacts(damping in 0.0..1.5_f64, log_k in 3.0..12.0_f64, v in 0.01..10.0_f64) {
            let (k, m) = (10.0_f64.powf(log_k), 0.1);
            for (n, law) in laws(k, damping).iter().enumerate() {
                let Some(hit) = law.collision(m, v) else { continue };
                let steps = 4000;
                let h = hit.duration / f64::from(steps);
                let (mut d, mut u, mut deepest, mut hardest) = (0.0_f64, v, 0.0_f64, law.force(0.0, v));
                let slope = |d: f64, u: f64| (u, -law.force(d.max(0.0), u) / m);
                for _ in 0..steps {
                    let a = slope(d, u);
                    let b = slope(d + 0.5 * h * a.0, u + 0.5 * h * a.1);
                    let c = slope(d + 0.5 * h * b.0, u + 0.5 * h * b.1);
                    let e = slope(d + h * c.0, u + h * c.1);
                    d += h / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + e.0);
                    u += h / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + e.1);
                    deepest = deepest.max(d);
                    hardest = hardest.max(law.force(d.max(0.0), u));
                }
                prop_assert!((u + hit.cor.value() * v).abs() < 1e-5 * v, "law {n}: {u} {hit:?}");
                prop_assert!(law.margin(d, u).abs() < 1e-4 * law.margin(hit.deformation, 0.0), "law {n}: {d} {hit:?}");
                prop_assert!((deepest / hit.deformation - 1.0).abs() < 1e-5, "law {n}: {deepest} {hit:?}");
                // Hunt and Crossley's greatest force has no closed form short of a root; it is
                // announced all the same.
                prop_assert!((hardest / hit.force - 1.0).abs() < 1e-5, "law {n}: {hardest} {hit:?}");
                prop_assert!(hit.compression < hit.duration);
            }
        }
    }
}
