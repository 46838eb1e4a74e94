//! What a wall does along itself: nothing, a fixed loss, friction without spin, friction with it.

use nalgebra::{SVector, Vector2, Vector3};

use super::Turning;
use crate::friction::{Friction, Rebound};
use crate::parameter::{ParameterError, between, not_negative};
use crate::restitution::Restitution;
use crate::sphere::Sphere;
use crate::walls::Face;

/// The tangential half of a law of impact, and of contact.
///
/// In contact: with μ = [`coefficient`](Self::coefficient) and the normal force λ per mass,
/// friction is at most μλ per mass, against the slip; a contact without slip holds while that
/// suffices.
pub trait Grip<const N: usize, S: Turning> {
    /// Velocity and spin after an impact on the wall with unit `normal`; `velocity` relative to the
    /// wall.
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: SVector<f64, N>,
        spin: S,
        normal: &SVector<f64, N>,
    ) -> Rebound<SVector<f64, N>, S>;

    /// The grip of one face, where faces differ; the default is the same for all.
    #[inline]
    fn on(&self, face: Face) -> impl Grip<N, S>
    where
        Self: Sized,
    {
        let _ = face;
        self
    }

    /// Coulomb's μ in contact.
    fn coefficient(&self) -> f64 {
        0.0
    }

    /// The velocity of the point of contact along the wall, linear in velocity and spin; and
    /// without a velocity linear in `normal`, of any length.
    fn slip(&self, velocity: SVector<f64, N>, spin: S, normal: &SVector<f64, N>) -> SVector<f64, N> {
        let _ = spin;
        velocity - normal * velocity.dot(normal)
    }

    /// The share of a slip's change that friction has to make up for: 1 without spin, α/(1 + α) for
    /// a sphere.
    fn share(&self) -> f64 {
        1.0
    }

    /// The change of spin by the `friction` per mass.
    fn torque(&self, friction: &SVector<f64, N>, normal: &SVector<f64, N>) -> S {
        let _ = (friction, normal);
        S::NONE
    }
}

impl<const N: usize, S: Turning, G: Grip<N, S>> Grip<N, S> for &G {
    #[inline]
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: SVector<f64, N>,
        spin: S,
        normal: &SVector<f64, N>,
    ) -> Rebound<SVector<f64, N>, S> {
        (**self).impact(restitution, velocity, spin, normal)
    }
    #[inline]
    fn coefficient(&self) -> f64 {
        (**self).coefficient()
    }
    #[inline]
    fn slip(&self, velocity: SVector<f64, N>, spin: S, normal: &SVector<f64, N>) -> SVector<f64, N> {
        (**self).slip(velocity, spin, normal)
    }
    #[inline]
    fn share(&self) -> f64 {
        (**self).share()
    }
    #[inline]
    fn torque(&self, friction: &SVector<f64, N>, normal: &SVector<f64, N>) -> S {
        (**self).torque(friction, normal)
    }
}

/// The normal part of an impact: the gain of velocity along the normal, (1 + e) times the speed of
/// approach.
fn gain<const N: usize, R: Restitution>(restitution: &R, velocity: &SVector<f64, N>, normal: &SVector<f64, N>) -> f64 {
    let approach = (-velocity.dot(normal)).max(0.0);
    approach + restitution.rebound(approach)
}

/// Smooth walls: velocity along them and spin stay.
impl<const N: usize, S: Turning> Grip<N, S> for () {
    #[inline]
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: SVector<f64, N>,
        spin: S,
        normal: &SVector<f64, N>,
    ) -> Rebound<SVector<f64, N>, S> {
        Rebound { velocity: velocity + normal * gain(restitution, &velocity, normal), spin }
    }
}

/// Each impact keeps the same share of the velocity along the wall; contact is smooth.
///
/// ```
/// use saltus_bounce::Keeps;
/// assert!(Keeps::new(0.9).is_ok() && Keeps::new(1.1).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keeps(f64);

impl Keeps {
    /// The share kept.
    ///
    /// # Errors
    /// [`ParameterError`] unless 0 ≤ `share` ≤ 1.
    pub fn new(share: f64) -> Result<Self, ParameterError> {
        let give = "a number from 0 (it stops along the wall) to 1 (it keeps all)";
        Ok(Self(between("a share of velocity that is kept", share, 0.0, 1.0, give)?))
    }
}

impl<const N: usize, S: Turning> Grip<N, S> for Keeps {
    #[inline]
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: SVector<f64, N>,
        spin: S,
        normal: &SVector<f64, N>,
    ) -> Rebound<SVector<f64, N>, S> {
        let along = velocity.dot(normal);
        let gain = gain(restitution, &velocity, normal);
        Rebound { velocity: (velocity - normal * along) * self.0 + normal * (along + gain), spin }
    }
}

/// Coulomb friction on a body that does not turn, a sliding block: at an impact the impulse along
/// the wall is μ times the normal one, at most what stops the slip.
///
/// ```
/// use saltus_bounce::Block;
/// assert!(Block::new(0.3).is_ok() && Block::new(-0.1).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block(f64);

impl Block {
    /// A grip with Coulomb's `coefficient` μ.
    ///
    /// # Errors
    /// [`ParameterError`] unless μ is finite and not negative.
    pub fn new(coefficient: f64) -> Result<Self, ParameterError> {
        Ok(Self(not_negative("a coefficient of friction", coefficient)?))
    }
}

impl<const N: usize> Grip<N, ()> for Block {
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: SVector<f64, N>,
        spin: (),
        normal: &SVector<f64, N>,
    ) -> Rebound<SVector<f64, N>, ()> {
        let gain = gain(restitution, &velocity, normal);
        let slip = self.slip(velocity, spin, normal);
        let speed = slip.norm();
        let left = if speed > 0.0 { (1.0 - self.0 * gain / speed).max(0.0) } else { 0.0 };
        Rebound { velocity: slip * left + normal * (velocity.dot(normal) + gain), spin }
    }
    fn coefficient(&self) -> f64 {
        self.0
    }
}

/// Friction on a sphere that spins: [`Friction`]'s law at impacts; sliding with its μ, or rolling,
/// in contact.
///
/// ```
/// use saltus_bounce::{Rolls, Sphere, friction::Friction};
/// let grip = Rolls { ball: Sphere::solid(0.03, 0.05)?, friction: Friction::rigid(0.3)? };
/// # let _ = grip;
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rolls {
    /// The ball.
    pub ball: Sphere,
    /// The friction of the ball on every wall.
    pub friction: Friction,
}

impl Rolls {
    fn lever(&self) -> f64 {
        1.0 / (self.ball.inertia_factor() * self.ball.radius())
    }
}

impl Grip<2, f64> for Rolls {
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: Vector2<f64>,
        spin: f64,
        normal: &Vector2<f64>,
    ) -> Rebound<Vector2<f64>, f64> {
        self.friction.planar(&self.ball, restitution, velocity, spin, *normal)
    }
    fn coefficient(&self) -> f64 {
        self.friction.coefficient()
    }
    fn slip(&self, velocity: Vector2<f64>, spin: f64, normal: &Vector2<f64>) -> Vector2<f64> {
        let tangent = Vector2::new(normal[1], -normal[0]);
        tangent * (velocity.dot(&tangent) + self.ball.radius() * spin)
    }
    fn share(&self) -> f64 {
        self.ball.inertia_factor() / (1.0 + self.ball.inertia_factor())
    }
    fn torque(&self, friction: &Vector2<f64>, normal: &Vector2<f64>) -> f64 {
        (friction[0] * normal[1] - friction[1] * normal[0]) * self.lever()
    }
}

impl Grip<3, Vector3<f64>> for Rolls {
    fn impact<R: Restitution>(
        &self,
        restitution: &R,
        velocity: Vector3<f64>,
        spin: Vector3<f64>,
        normal: &Vector3<f64>,
    ) -> Rebound<Vector3<f64>, Vector3<f64>> {
        self.friction.spatial(&self.ball, restitution, velocity, spin, *normal)
    }
    fn coefficient(&self) -> f64 {
        self.friction.coefficient()
    }
    fn slip(&self, velocity: Vector3<f64>, spin: Vector3<f64>, normal: &Vector3<f64>) -> Vector3<f64> {
        velocity - normal * velocity.dot(normal) - spin.cross(normal) * self.ball.radius()
    }
    fn share(&self) -> f64 {
        self.ball.inertia_factor() / (1.0 + self.ball.inertia_factor())
    }
    fn torque(&self, friction: &Vector3<f64>, normal: &Vector3<f64>) -> Vector3<f64> {
        -normal.cross(friction) * self.lever()
    }
}
