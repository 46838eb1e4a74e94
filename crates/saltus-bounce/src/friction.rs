//! Oblique impacts of a spinning sphere: restitution across the wall, friction along it.

use nalgebra::{Vector2, Vector3};

use crate::impact::impact;
use crate::parameter::{ParameterError, between, not_negative};
use crate::restitution::Restitution;
use crate::sphere::Sphere;

/// Friction at an impact, by Walton's three numbers: the impulse along the wall is that of sliding,
/// μ times the normal impulse, but no more than turns the slip u of the point of contact into -β₀
/// u.
///
/// Per unit of mass, with the speed vₙ of approach, its rebound e vₙ and α = I/(m R²):
/// J = min( μ (1 + e) vₙ, (1 + β₀) |u| α/(1 + α) ), against the slip.
///
/// μ ≥ 0: Coulomb's coefficient. β₀, 0..=1: tangential restitution of an impact that grips; at 0
/// ([`Friction::rigid`]) a gripping ball leaves rolling, at 1 the slip comes back whole (a
/// superball).
///
/// Guarantees: energy never rises; a tangential impulse opposes the slip; the spin about the normal
/// is not touched. Limits: no microslip, so measured balls pass more gradually from sliding to
/// gripping; no pivoting friction. Sources: E. J. Routh, *Dynamics of a System of Rigid Bodies*
/// (1905), part 1, chapter 4; O. R. Walton in M. C. Roco (ed.), *Particulate Two-Phase Flow*
/// (1993), chapter 25; S. F. Foerster et al., Phys. Fluids 6, 1108 (1994), doi:10.1063/1.868282.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::{Cor, Sphere, friction::Friction};
/// let ball = Sphere::solid(0.03, 0.05)?;
/// let up = vector![0.0, 1.0];
/// // It grips: it leaves rolling, v = -R ω, with 5/7 of its speed along the floor.
/// let after = Friction::rigid(0.5)?.planar(&ball, Cor::new(0.8)?, vector![1.4, -2.0], 0.0, up);
/// assert!((after.velocity - vector![1.0, 1.6]).norm() < 1e-15);
/// assert!((after.spin + 1.0 / 0.03).abs() < 1e-13);
/// // It slides: friction takes μ (1 + e) vₙ.
/// let after = Friction::rigid(0.1)?.planar(&ball, Cor::new(0.8)?, vector![9.0, -2.0], 0.0, up);
/// assert!((after.velocity - vector![9.0 - 0.36, 1.6]).norm() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    coefficient: f64,
    gripping: f64,
}

/// Velocity and spin just after an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound<V, S> {
    /// The velocity of the centre, in m/s, relative to the wall.
    pub velocity: V,
    /// The spin in rad/s.
    pub spin: S,
}

impl Friction {
    /// No friction: velocity along the wall and spin stay.
    pub const NONE: Self = Self { coefficient: 0.0, gripping: 0.0 };

    /// A rigid sphere: it slides throughout with Coulomb's `coefficient` μ, or grips and leaves
    /// rolling.
    ///
    /// # Errors
    /// [`ParameterError`] unless μ is finite and not negative.
    pub fn rigid(coefficient: f64) -> Result<Self, ParameterError> {
        Self::walton(coefficient, 0.0)
    }

    /// Walton's law: `coefficient` μ, and the tangential restitution β₀ = `gripping` of an impact
    /// that does not slide throughout.
    ///
    /// # Errors
    /// [`ParameterError`] unless μ is finite and not negative and 0 ≤ β₀ ≤ 1.
    pub fn walton(coefficient: f64, gripping: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            coefficient: not_negative("a coefficient of friction", coefficient)?,
            gripping: between(
                "a tangential restitution",
                gripping,
                0.0,
                1.0,
                "a number from 0 (a gripping ball leaves rolling) to 1 (its slip comes back whole)",
            )?,
        })
    }

    /// Coulomb's μ.
    #[must_use]
    pub const fn coefficient(&self) -> f64 {
        self.coefficient
    }

    /// The impact of a sphere on a wall in the plane.
    ///
    /// `normal`: unit vector out of the wall; `velocity` of the centre relative to the wall in m/s;
    /// `spin` in rad/s, positive from the first axis towards the second. A ball that is not
    /// approaching (v·n ≥ 0) is left alone.
    #[must_use]
    pub fn planar(
        &self,
        ball: &Sphere,
        restitution: impl Restitution,
        velocity: Vector2<f64>,
        spin: f64,
        normal: Vector2<f64>,
    ) -> Rebound<Vector2<f64>, f64> {
        let approach = -velocity.dot(&normal);
        if approach <= 0.0 {
            return Rebound { velocity, spin };
        }
        let gain = approach + restitution.rebound(approach);
        let tangent = Vector2::new(normal[1], -normal[0]);
        // The point of contact lies at -R n: with the wall below, its velocity along the wall is v
        // + R ω.
        let slip = velocity.dot(&tangent) + ball.radius() * spin;
        let push = -self.push(ball, slip.abs(), gain) * slip.signum();
        Rebound {
            velocity: velocity + normal * gain + tangent * push,
            spin: spin + push / (ball.inertia_factor() * ball.radius()),
        }
    }

    /// The impact of a sphere on a wall in space: as [`planar`](Self::planar), `spin` a vector by
    /// the right-hand rule.
    #[must_use]
    pub fn spatial(
        &self,
        ball: &Sphere,
        restitution: impl Restitution,
        velocity: Vector3<f64>,
        spin: Vector3<f64>,
        normal: Vector3<f64>,
    ) -> Rebound<Vector3<f64>, Vector3<f64>> {
        let approach = -velocity.dot(&normal);
        if approach <= 0.0 {
            return Rebound { velocity, spin };
        }
        let gain = approach + restitution.rebound(approach);
        let slip = velocity + normal * approach - spin.cross(&normal) * ball.radius();
        let speed = slip.norm();
        let push = if speed > 0.0 { slip * (-self.push(ball, speed, gain) / speed) } else { Vector3::zeros() };
        Rebound {
            velocity: velocity + normal * gain + push,
            spin: spin - normal.cross(&push) / (ball.inertia_factor() * ball.radius()),
        }
    }

    /// The impact of two spheres in space; `normal`: unit vector from the first centre to the
    /// second.
    ///
    /// The law of a wall with the mass mᵣ = m₁m₂/(m₁ + m₂) for the normal impulse (1 + e) mᵣ vₙ,
    /// and 1/(Σ (1 + 1/α)/m) for the one that stops the slip **v** - (R₁**ω**₁ + R₂**ω**₂) × **n**
    /// of the relative velocity **v** along the plane of contact. Momentum and angular momentum
    /// stay, energy never rises. Balls that do not approach are left alone. Domain and sources as
    /// for the law itself.
    ///
    /// ```
    /// use nalgebra::{Vector3, vector};
    /// use saltus_bounce::{Cor, Sphere, friction::Friction};
    /// // A billiard ball with side spin hits one at rest, and throws it to the side.
    /// let ball = Sphere::solid(0.028, 0.17)?;
    /// let still = Vector3::zeros();
    /// let (velocities, spins) = ([vector![1.0, 0.0, 0.0], still], [vector![0.0, 0.0, 20.0], still]);
    /// let [cue, object] = Friction::rigid(0.05)?.collision([&ball; 2], Cor::new(0.95)?, velocities, spins, vector![1.0, 0.0, 0.0]);
    /// assert!(object.velocity[1] > 0.04 && (cue.velocity + object.velocity - velocities[0]).norm() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn collision(
        &self,
        balls: [&Sphere; 2],
        restitution: impl Restitution,
        velocities: [Vector3<f64>; 2],
        spins: [Vector3<f64>; 2],
        normal: Vector3<f64>,
    ) -> [Rebound<Vector3<f64>, Vector3<f64>>; 2] {
        let along = velocities.map(|velocity| velocity.dot(&normal));
        let approach = along[0] - along[1];
        let mut after = std::array::from_fn(|i| Rebound { velocity: velocities[i], spin: spins[i] });
        if approach <= 0.0 {
            return after;
        }
        let rebound = restitution.rebound(approach);
        let masses = balls.map(Sphere::mass);
        let parted = impact(masses, along, approach, rebound);
        let turned = spins[0] * balls[0].radius() + spins[1] * balls[1].radius();
        let slip = velocities[1] - velocities[0] + normal * approach - turned.cross(&normal);
        let speed = slip.norm();
        // Each impulse as what it does to the lighter ball, so that no mass is too large beside the
        // other.
        let (light, heavy) = if masses[0] <= masses[1] { (0, 1) } else { (1, 0) };
        let ratio = masses[light] / masses[heavy];
        let ease = (1.0 + 1.0 / balls[light].inertia_factor()) + (1.0 + 1.0 / balls[heavy].inertia_factor()) * ratio;
        let sliding = self.coefficient * (approach + rebound) / (1.0 + ratio);
        let push = sliding.min((1.0 + self.gripping) * speed / ease);
        let push = if speed > 0.0 { slip * (push / speed) } else { Vector3::zeros() };
        for (i, ball) in balls.into_iter().enumerate() {
            let share = if i == light { 1.0 } else { ratio };
            let side = if i == 0 { push } else { -push } * share;
            after[i].velocity += normal * (parted[i] - along[i]) + side;
            let lever = if i == 0 { normal } else { -normal } / (ball.inertia_factor() * ball.radius());
            after[i].spin += lever.cross(&side);
        }
        after
    }

    /// The tangential impulse per mass: what sliding gives, or what gripping needs, whichever is
    /// less.
    #[inline]
    fn push(&self, ball: &Sphere, slip: f64, gain: f64) -> f64 {
        let alpha = ball.inertia_factor();
        (self.coefficient * gain).min((1.0 + self.gripping) * slip * (alpha / (1.0 + alpha)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::restitution::Cor;
    use nalgebra::vector;
    use proptest::prelude::*;

    fn energy(ball: &Sphere, v: f64, w: f64) -> f64 {
        0.5 * ball.mass() * (v * v + ball.inertia_factor() * (ball.radius() * w).powi(2))
    }

    proptest! {
        /// Energy never rises, the slip shrinks or turns round by at most β₀, and angular momentum
        /// about the point of contact stays.
        #[test]
        fn planar_impacts(
            mu in 0.0..3.0_f64, beta in 0.0..=1.0_f64, e in 0.0..=1.0_f64, alpha in 0.01..0.66_f64, radius in 0.001..2.0_f64,
            vt in -20.0..20.0_f64, vn in -20.0..-1e-9_f64, rw in -20.0..20.0_f64, tilt in 0.0..6.3_f64,
        ) {
            let ball = Sphere::with_inertia(radius, 0.2, alpha).unwrap();
            let (n, t) = (vector![tilt.cos(), tilt.sin()], vector![tilt.sin(), -tilt.cos()]);
            let (v, w) = (n * vn + t * vt, rw / radius);
            let after = Friction::walton(mu, beta).unwrap().planar(&ball, Cor::new(e).unwrap(), v, w, n);
            let before = energy(&ball, v.norm(), w);
            prop_assert!(energy(&ball, after.velocity.norm(), after.spin) <= before * (1.0 + 1e-13));
            prop_assert!((after.velocity.dot(&n) + e * vn).abs() < 1e-13);
            let slip = |v: Vector2<f64>, w: f64| v.dot(&t) + radius * w;
            let (old, new) = (slip(v, w), slip(after.velocity, after.spin));
            prop_assert!(new * old.signum() <= old.abs() + 1e-12 && new * old.signum() >= -beta * old.abs() - 1e-12);
            let momentum = |v: Vector2<f64>, w: f64| v.dot(&t) - alpha * radius * w;
            prop_assert!((momentum(v, w) - momentum(after.velocity, after.spin)).abs() < 1e-12);
        }

        /// The plane is a slice of space.
        #[test]
        fn a_plane_in_space(
            mu in 0.0..1.0_f64, beta in 0.0..=1.0_f64, e in 0.0..=1.0_f64, vt in -9.0..9.0_f64, vn in -9.0..9.0_f64, w in -99.0..99.0_f64,
        ) {
            let (ball, law) = (Sphere::hollow(0.05, 0.2).unwrap(), Friction::walton(mu, beta).unwrap());
            let e = Cor::new(e).unwrap();
            let flat = law.planar(&ball, e, vector![vt, vn], w, vector![0.0, 1.0]);
            let deep = law.spatial(&ball, e, vector![vt, vn, 0.0], vector![0.0, 0.0, w], vector![0.0, 1.0, 0.0]);
            prop_assert!((deep.velocity - vector![flat.velocity[0], flat.velocity[1], 0.0]).norm() < 1e-13);
            prop_assert!((deep.spin - vector![0.0, 0.0, flat.spin]).norm() < 1e-11);
        }

        #[test]
        fn spatial_impacts_lose_energy(
            mu in 0.0..3.0_f64, beta in 0.0..=1.0_f64, v in prop::array::uniform3(-9.0..9.0_f64), rw in prop::array::uniform3(-9.0..9.0_f64),
            n in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let n = Vector3::from(n);
            prop_assume!(n.norm() > 0.1);
            let (ball, n) = (Sphere::solid(0.5, 0.2).unwrap(), n.normalize());
            let (v, w) = (Vector3::from(v), Vector3::from(rw) / 0.5);
            let after = Friction::walton(mu, beta).unwrap().spatial(&ball, Cor::new(0.9).unwrap(), v, w, n);
            prop_assert!(energy(&ball, after.velocity.norm(), after.spin.norm()) <= energy(&ball, v.norm(), w.norm()) * (1.0 + 1e-13));
            prop_assert!((after.spin.dot(&n) - w.dot(&n)).abs() < 1e-11);
        }
    }

    proptest! {
        /// Momentum and angular momentum stay, energy never rises, the slip shrinks or turns round
        /// by at most β₀.
        #[test]
        fn collisions(
            mu in 0.0..2.0_f64, beta in 0.0..=1.0_f64, e in 0.0..=1.0_f64, ratio in -6.0..6.0_f64,
            v in prop::array::uniform2(prop::array::uniform3(-9.0..9.0_f64)), w in prop::array::uniform2(prop::array::uniform3(-99.0..99.0_f64)),
            n in prop::array::uniform3(-1.0..1.0_f64),
        ) {
            let n = Vector3::from(n);
            prop_assume!(n.norm() > 0.1);
            let n = n.normalize();
            let balls = [Sphere::solid(0.05, 0.2).unwrap(), Sphere::hollow(0.11, 0.2 * 10_f64.powf(ratio)).unwrap()];
            let (v, w) = (v.map(Vector3::from), w.map(Vector3::from));
            let law = Friction::walton(mu, beta).unwrap();
            let after = law.collision([&balls[0], &balls[1]], Cor::new(e).unwrap(), v, w, n);
            let (v2, w2) = (after.map(|ball| ball.velocity), after.map(|ball| ball.spin));
            let of = |f: &dyn Fn(usize) -> f64| (0..2).map(f).sum::<f64>();
            let inertia = |i: usize| balls[i].inertia_factor() * balls[i].mass() * balls[i].radius().powi(2);
            let energy = |v: [Vector3<f64>; 2], w: [Vector3<f64>; 2]| {
                of(&|i| 0.5 * balls[i].mass() * v[i].norm_squared() + 0.5 * inertia(i) * w[i].norm_squared())
            };
            prop_assert!(energy(v2, w2) <= energy(v, w) * (1.0 + 1e-12));
            let places = [n * -balls[0].radius(), n * balls[1].radius()];
            let angular = |v: [Vector3<f64>; 2], w: [Vector3<f64>; 2]| {
                (0..2).map(|i| places[i].cross(&v[i]) * balls[i].mass() + w[i] * inertia(i)).sum::<Vector3<f64>>()
            };
            let size = of(&|i| balls[i].mass() * (1.0 + v[i].norm() + v2[i].norm()) + inertia(i) * (w[i].norm() + w2[i].norm()));
            prop_assert!(((0..2).map(|i| (v2[i] - v[i]) * balls[i].mass()).sum::<Vector3<f64>>()).norm() <= 1e-13 * size);
            prop_assert!((angular(v2, w2) - angular(v, w)).norm() <= 1e-13 * size);
            let slip = |v: [Vector3<f64>; 2], w: [Vector3<f64>; 2]| {
                let u = v[1] - v[0];
                u - n * u.dot(&n) - (w[0] * balls[0].radius() + w[1] * balls[1].radius()).cross(&n)
            };
            let (old, new) = (slip(v, w), slip(v2, w2));
            let left = if old.norm() > 0.0 { new.dot(&old) / old.norm() } else { 0.0 };
            prop_assert!(left <= old.norm() + 1e-9 && left >= -beta * old.norm() - 1e-9);
        }

        /// A ball that is heavy beyond all measure is a wall.
        #[test]
        fn a_wall_is_a_heavy_ball(mu in 0.0..2.0_f64, beta in 0.0..=1.0_f64, e in 0.0..=1.0_f64, v in prop::array::uniform3(-9.0..9.0_f64), w in prop::array::uniform3(-99.0..99.0_f64)) {
            let (ball, wall) = (Sphere::solid(0.05, 0.2).unwrap(), Sphere::solid(1.0, 1e16).unwrap());
            let (v, w, n) = (Vector3::from(v), Vector3::from(w), vector![0.6, 0.0, 0.8]);
            let (law, e) = (Friction::walton(mu, beta).unwrap(), Cor::new(e).unwrap());
            let [_, after] = law.collision([&wall, &ball], e, [Vector3::zeros(), v], [Vector3::zeros(), w], n);
            let flat = law.spatial(&ball, e, v, w, n);
            prop_assert!((after.velocity - flat.velocity).norm() < 1e-13 && (after.spin - flat.spin).norm() < 1e-11);
        }
    }

    /// A superball thrown with backspin comes back: R. L. Garwin, Am. J. Phys. 37, 88 (1969).
    #[test]
    fn a_superball_reverses() {
        let ball = Sphere::solid(0.025, 0.05).unwrap();
        let law = Friction::walton(100.0, 1.0).unwrap();
        let after = law.planar(&ball, Cor::new(1.0).unwrap(), vector![1.0, -1.0], 0.0, vector![0.0, 1.0]);
        assert!((after.velocity - vector![3.0 / 7.0, 1.0]).norm() < 1e-15);
        assert!((after.spin * 0.025 + 10.0 / 7.0).abs() < 1e-14);
    }
}
