//! The fluid that the ball displaces: it lifts, and it has to be moved.

use nalgebra::SVector;

use super::gravity::upwards;
use super::jets::times;
use super::{Effect, Gravity, JetMotion, JetSum, Motion, Spin};
use crate::parameter::{ParameterError, not_negative};
use crate::sphere::Sphere;

/// Buoyancy: a = +g r along the last coordinate, where r is the density of the fluid over that of
/// the ball.
///
/// Beside [`Gravity`] it leaves g (1 - r): negative, upwards, for a ball lighter than its fluid. In
/// air r is 3×10⁻³ for a tennis ball, 1.5×10⁻² for a table-tennis ball. Source: Archimedes, *On
/// Floating Bodies*, book 1, propositions 5 to 7.
///
/// ```
/// use saltus_bounce::{Sphere, effects::{AIR_DENSITY, Buoyancy, Gravity}};
/// let ball = Sphere::hollow(0.02, 0.0027)?; // table tennis
/// let lift = Buoyancy::new(&ball, AIR_DENSITY, Gravity::EARTH)?;
/// assert!((lift.net_gravity() / Gravity::EARTH.value() - 0.984_796).abs() < 1e-6);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buoyancy {
    gravity: Gravity,
    ratio: f64,
}

impl Buoyancy {
    /// The buoyancy of `ball` in a fluid of `density` in kg/m³ under `gravity`.
    ///
    /// # Errors
    /// [`ParameterError`] unless the density is finite and not negative.
    pub fn new(ball: &Sphere, density: f64, gravity: Gravity) -> Result<Self, ParameterError> {
        Ok(Self { gravity, ratio: not_negative("a density in kg/m^3", density)? / ball.density() })
    }

    /// The net gravity, g (1 - r), in m/s² downwards.
    #[must_use]
    pub const fn net_gravity(self) -> f64 {
        self.gravity.value() * (1.0 - self.ratio)
    }
}

impl<const N: usize, S: Spin> Effect<N, S> for Buoyancy {
    #[inline]
    fn uniform(&self) -> bool {
        true
    }

    #[inline]
    fn acceleration(&self, _motion: &Motion<N, S>) -> SVector<f64, N> {
        upwards(self.gravity.value() * self.ratio)
    }

    #[inline(always)]
    fn series<'j>(&self, _motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        sum.lift(self.gravity.value() * self.ratio);
        true
    }
}

/// Effects on a ball that drags half its own volume of fluid along: every acceleration is divided
/// by 1 + r/2.
///
/// r: the density of the fluid over that of the ball. Put all effects inside, gravity and buoyancy
/// too. For a sphere far from walls, in a fluid at rest or in uniform steady motion; the force of
/// the wake's history is left out. Source: H. Lamb, *Hydrodynamics* (1932), section 92.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::{Sphere, effects::{AddedMass, Buoyancy, Effect, Gravity, Motion}};
/// let bubble = Sphere::hollow(0.01, 1e-9)?; // next to nothing, in water: it starts at 2 g upwards
/// let scene = AddedMass::new(&bubble, 1000.0, (Gravity::EARTH, Buoyancy::new(&bubble, 1000.0, Gravity::EARTH)?))?;
/// let rest = Motion { t: 0.0, position: vector![0.0], velocity: vector![0.0], spin: () };
/// assert!((scene.acceleration(&rest)[0] / Gravity::EARTH.value() - 2.0).abs() < 1e-5);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AddedMass<E> {
    share: f64,
    effects: E,
}

impl<E> AddedMass<E> {
    /// `effects` on `ball` in a fluid of `density` in kg/m³.
    ///
    /// # Errors
    /// [`ParameterError`] unless the density is finite and not negative.
    pub fn new(ball: &Sphere, density: f64, effects: E) -> Result<Self, ParameterError> {
        let ratio = not_negative("a density in kg/m^3", density)? / ball.density();
        Ok(Self { share: 1.0 / (1.0 + 0.5 * ratio), effects })
    }

    /// The ball's share of the mass that is moved, 1/(1 + r/2).
    #[must_use]
    pub const fn share(&self) -> f64 {
        self.share
    }
}

impl<const N: usize, S: Spin, E: Effect<N, S>> Effect<N, S> for AddedMass<E> {
    #[inline]
    fn uniform(&self) -> bool {
        self.effects.uniform()
    }

    #[inline]
    fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N> {
        self.effects.acceleration(motion) * self.share
    }

    #[inline]
    fn spin_rate(&self, motion: &Motion<N, S>) -> S {
        self.effects.spin_rate(motion)
    }

    #[inline]
    fn kink(&self, motion: &Motion<N, S>) -> Option<f64> {
        self.effects.kink(motion)
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        if self.share == 1.0 {
            return self.effects.series(motion, sum);
        }
        let mut inner = JetSum::default();
        let all = self.effects.series(motion, &mut inner);
        sum.accelerate(times(&inner.acceleration(), self.share.into()));
        sum.turn(inner.spin_rate());
        all
    }
}
