//! What acts on a ball in flight: accelerations that are added up at compile time.
//!
//! A tuple of effects is an effect, `()` is none: `(Gravity, QuadraticDrag)` evaluates these two
//! and nothing else. The number of coordinates N and the kind of spin S are types: a scene without
//! spin keeps none, and there [`Magnus`] does not compile.
//!
//! The last coordinate points up, in every dimension: (y), (x, y), (x, y, z).

mod buoyancy;
mod gravity;
mod jets;
mod linear_drag;
mod magnus;
mod quadratic_drag;
mod spin_decay;
mod wind;

use std::fmt::Debug;

use nalgebra::{SVector, Vector3};

pub use buoyancy::{AddedMass, Buoyancy};
pub use gravity::{Gravity, STANDARD_GRAVITY};
pub use jets::{JetMotion, JetSum};
pub use linear_drag::LinearDrag;
pub use magnus::Magnus;
pub use quadratic_drag::QuadraticDrag;
pub use spin_decay::SpinDecay;
pub use wind::Wind;

/// The density of dry air at 15 °C and 101 325 Pa in kg/m³ (ISO 2533:1975, the standard atmosphere
/// at sea level).
pub const AIR_DENSITY: f64 = 1.225;

/// The viscosity of the same air in Pa s (ISO 2533:1975).
pub const AIR_VISCOSITY: f64 = 1.789_4e-5;

/// The spin of a ball: none `()`, in the plane `f64`, in space [`Vector3`]; in rad/s.
pub trait Spin: Copy + Debug + PartialEq {
    /// No spin.
    const NONE: Self;
    /// The sum of two spins.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// This spin `factor` times.
    #[must_use]
    fn times(self, factor: f64) -> Self;
}

impl Spin for () {
    const NONE: Self = ();
    #[inline]
    fn plus(self, (): Self) -> Self {}
    #[inline]
    fn times(self, _factor: f64) -> Self {}
}

impl Spin for f64 {
    const NONE: Self = 0.0;
    #[inline]
    fn plus(self, other: Self) -> Self {
        self + other
    }
    #[inline]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
}

impl Spin for Vector3<f64> {
    const NONE: Self = Self::new(0.0, 0.0, 0.0);
    #[inline]
    fn plus(self, other: Self) -> Self {
        self + other
    }
    #[inline]
    fn times(self, factor: f64) -> Self {
        self * factor
    }
}

/// A moment of a flight, as an effect sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<const N: usize, S = ()> {
    /// The time in s.
    pub t: f64,
    /// The place of the ball's centre or lowest point, in m; no effect here depends on which.
    pub position: SVector<f64, N>,
    /// The velocity in m/s; inside a [`Wind`] relative to the air.
    pub velocity: SVector<f64, N>,
    /// The spin in rad/s.
    pub spin: S,
}

/// Something that accelerates a ball in flight, or changes its spin.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::effects::{Effect, Gravity, LinearDrag, Motion};
/// let scene = (Gravity::new(9.81)?, LinearDrag::new(0.5)?);
/// let motion = Motion { t: 0.0, position: vector![0.0, 2.0], velocity: vector![4.0, -2.0], spin: () };
/// assert_eq!(scene.acceleration(&motion), vector![-2.0, -8.81]);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
pub trait Effect<const N: usize, S: Spin = ()> {
    /// Promises that the acceleration is the same everywhere and always, and that the spin stays:
    /// flights are then exact parabolas.
    #[inline]
    fn uniform(&self) -> bool {
        false
    }

    /// The acceleration in m/s².
    fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N>;

    /// The rate of change of the spin in rad/s².
    #[inline]
    fn spin_rate(&self, _motion: &Motion<N, S>) -> S {
        S::NONE
    }

    /// The number that falls through zero where the acceleration has a kink that flights pass
    /// through. `None` where it is smooth.
    ///
    /// A stepper keeps its order if a step ends at the kink.
    #[inline]
    fn kink(&self, _motion: &Motion<N, S>) -> Option<f64> {
        None
    }

    /// The acceleration over [`Jet`](saltus::Jet)s, added to a sum, and whether that is all that
    /// the effect does: flights are then advanced by Taylor series where
    /// [`Flyer::by_series`](crate::Flyer::by_series) is set. An effect of other effects is complete
    /// where each of them is.
    ///
    /// ```
    /// use nalgebra::vector;
    /// use saltus::Simulation;
    /// use saltus_bounce::effects::{Effect, Gravity, JetMotion, JetSum, Motion};
    /// use saltus_bounce::{Cor, Flyer, Moving, Stance, walls::Plane};
    ///
    /// /// A force against the velocity that does not depend on the speed.
    /// struct Rubbing(f64);
    ///
    /// impl Effect<2> for Rubbing {
    ///     fn acceleration(&self, motion: &Motion<2>) -> nalgebra::Vector2<f64> {
    ///         motion.velocity * (-self.0 / motion.velocity.norm())
    ///     }
    ///     fn series<'j>(&self, motion: &JetMotion<'j, 2>, sum: &mut JetSum<'j, 2>) -> bool {
    ///         sum.accelerate(motion.velocity.map(|v| v * -self.0 / motion.speed));
    ///         true
    ///     }
    /// }
    ///
    /// let ball = Flyer::new((Gravity::EARTH, Rubbing(0.5)), Plane::floor(0.0)?, Cor::new(0.8)?)?;
    /// let start = Moving::new(vector![0.0, 1.0], vector![3.0, 1.0]);
    /// let end = |ball| Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..1.0).map(|run| run.end);
    /// let (stepped, expanded) = (end(ball)?, end(Flyer::new((Gravity::EARTH, Rubbing(0.5)), Plane::floor(0.0)?, Cor::new(0.8)?)?.by_series())?);
    /// assert!((stepped.state.position - expanded.state.position).norm() < 1e-7);
    /// assert!(expanded.stats.steps < stepped.stats.steps);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline(always)]
    fn series<'j>(&self, _motion: &JetMotion<'j, N>, _sum: &mut JetSum<'j, N>) -> bool {
        false
    }
}

impl<const N: usize, S: Spin> Effect<N, S> for () {
    #[inline(always)]
    fn series<'j>(&self, _motion: &JetMotion<'j, N>, _sum: &mut JetSum<'j, N>) -> bool {
        true
    }

    #[inline]
    fn uniform(&self) -> bool {
        true
    }

    #[inline]
    fn acceleration(&self, _motion: &Motion<N, S>) -> SVector<f64, N> {
        SVector::zeros()
    }
}

/// An effect that a scene may name: none costs one comparison.
impl<const N: usize, S: Spin, E: Effect<N, S>> Effect<N, S> for Option<E> {
    #[inline]
    fn uniform(&self) -> bool {
        self.as_ref().is_none_or(Effect::uniform)
    }

    #[inline]
    fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N> {
        self.as_ref().map_or(SVector::zeros(), |effect| effect.acceleration(motion))
    }

    #[inline]
    fn spin_rate(&self, motion: &Motion<N, S>) -> S {
        self.as_ref().map_or(S::NONE, |effect| effect.spin_rate(motion))
    }

    #[inline]
    fn kink(&self, motion: &Motion<N, S>) -> Option<f64> {
        self.as_ref()?.kink(motion)
    }

    #[inline(always)]
    fn series<'j>(&self, motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
        self.as_ref().is_none_or(|effect| effect.series(motion, sum))
    }
}

macro_rules! tuple_of_effects {
    ($first:ident $($other:ident)*) => {
        impl<const N: usize, S: Spin, $first: Effect<N, S>, $($other: Effect<N, S>),*> Effect<N, S> for ($first, $($other,)*) {
            #[inline]
            fn uniform(&self) -> bool {
                #[allow(non_snake_case)]
                let ($first, $($other,)*) = self;
                $first.uniform() $(&& $other.uniform())*
            }

            #[inline]
            fn acceleration(&self, motion: &Motion<N, S>) -> SVector<f64, N> {
                #[allow(non_snake_case)]
                let ($first, $($other,)*) = self;
                $first.acceleration(motion) $(+ $other.acceleration(motion))*
            }

            #[inline]
            fn spin_rate(&self, motion: &Motion<N, S>) -> S {
                #[allow(non_snake_case)]
                let ($first, $($other,)*) = self;
                $first.spin_rate(motion) $(.plus($other.spin_rate(motion)))*
            }

            #[inline]
            fn kink(&self, motion: &Motion<N, S>) -> Option<f64> {
                #[allow(non_snake_case)]
                let ($first, $($other,)*) = self;
                $first.kink(motion) $(.or_else(|| $other.kink(motion)))*
            }

            #[inline(always)]
            fn series<'j>(&self, motion: &JetMotion<'j, N>, sum: &mut JetSum<'j, N>) -> bool {
                #[allow(non_snake_case)]
                let ($first, $($other,)*) = self;
                $first.series(motion, sum) $(&& $other.series(motion, sum))*
            }
        }
    };
}

tuple_of_effects!(A);
tuple_of_effects!(A B);
tuple_of_effects!(A B C);
tuple_of_effects!(A B C D);
tuple_of_effects!(A B C D E);
tuple_of_effects!(A B C D E F);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sphere;
    use nalgebra::{Vector1, Vector2, vector};
    use proptest::prelude::*;

    fn at<const N: usize, S: Spin>(velocity: SVector<f64, N>, spin: S) -> Motion<N, S> {
        Motion { t: 0.0, position: SVector::zeros(), velocity, spin }
    }

    #[test]
    fn the_same_effects_in_one_two_and_three_dimensions() {
        let scene = (Gravity::EARTH, LinearDrag::new(0.3).unwrap(), QuadraticDrag::new(0.1).unwrap());
        let up: Vector1<f64> = scene.acceleration(&at(vector![-5.0], ()));
        let flat = scene.acceleration(&at(vector![0.0, -5.0], ()));
        let deep = scene.acceleration(&at(vector![0.0, 0.0, -5.0], ()));
        assert_eq!((flat, deep), (vector![0.0, up[0]], vector![0.0, 0.0, up[0]]));
        assert!((up[0] - (-9.806_65 + 1.5 + 2.5)).abs() < 1e-15);
        assert_eq!(Effect::<2>::acceleration(&(), &at(vector![1.0, 1.0], ())), vector![0.0, 0.0]);
    }

    /// A sum of effects has no series if one of them has none.
    #[test]
    fn no_series_holds_less_than_all() {
        struct Unsaid;
        impl Effect<2> for Unsaid {
            fn acceleration(&self, motion: &Motion<2>) -> SVector<f64, 2> {
                -motion.velocity
            }
        }
        fn says_all(effect: &impl Effect<2>) -> bool {
            effect.series(&JetMotion::new([1.0.into(); 2], [0.0.into(); 3]), &mut JetSum::default())
        }
        let (ball, gust) = (Sphere::hollow(0.033, 0.058).unwrap(), vector![1.0, 0.0]);
        assert!(!says_all(&Unsaid) && !says_all(&Some(Unsaid)) && says_all(&None::<Unsaid>) && says_all(&()));
        assert!(!says_all(&(Gravity::EARTH, Unsaid)) && !says_all(&(Unsaid, Gravity::EARTH)));
        assert!(!says_all(&Wind::new(gust, Unsaid).unwrap()) && says_all(&Wind::new(gust, Gravity::EARTH).unwrap()));
        assert!(!says_all(&AddedMass::new(&ball, AIR_DENSITY, Unsaid).unwrap()));
    }

    proptest! {
        /// Lift does no work, drag always takes energy, and a ball that moves with the wind feels
        /// neither.
        #[test]
        fn work(v in prop::array::uniform3(-40.0..40.0_f64), w in prop::array::uniform3(-300.0..300.0_f64), sigma in 0.0..3.0_f64) {
            let (v, w) = (Vector3::from(v), Vector3::from(w));
            let ball = Sphere::hollow(0.033, 0.058).unwrap();
            let lift = Magnus::new(&ball, AIR_DENSITY, 1.0, sigma).unwrap();
            let drag = (LinearDrag::new(0.1).unwrap(), QuadraticDrag::sphere(&ball, AIR_DENSITY, 0.5).unwrap());
            let motion = at(v, w);
            prop_assert!(lift.acceleration(&motion).dot(&v).abs() <= 1e-11 * v.norm_squared());
            prop_assert!(drag.acceleration(&motion).dot(&v) <= 0.0);
            let still = Wind::new(v, (lift, drag)).unwrap();
            prop_assert_eq!(still.acceleration(&motion), Vector3::zeros());
            let calm = Wind::new(Vector3::zeros(), (lift, drag)).unwrap();
            prop_assert_eq!(calm.acceleration(&motion), (lift, drag).acceleration(&motion));
        }

        /// Over jets an effect does what it does over numbers.
        #[test]
        fn series(v in prop::array::uniform3(-40.0..40.0_f64), w in prop::array::uniform3(-300.0..300.0_f64), sigma in 0.0..3.0_f64, wind in -9.0..9.0_f64) {
            let ball = Sphere::hollow(0.033, 0.058).unwrap();
            let each = (
                QuadraticDrag::sphere(&ball, AIR_DENSITY, 0.5).unwrap(),
                LinearDrag::new(0.1).unwrap(),
                Magnus::new(&ball, AIR_DENSITY, 1.0, if sigma < 0.5 { 0.0 } else { sigma }).unwrap(),
                SpinDecay::in_flight(&ball, 0.01).unwrap(),
            );
            let lift = Buoyancy::new(&ball, AIR_DENSITY, Gravity::EARTH).unwrap();
            macro_rules! agrees {
                ($n:literal, $velocity:expr, $spin:expr, $coordinates:expr) => {{
                    let air = Wind::new(SVector::<f64, $n>::repeat(wind), each).unwrap();
                    let all = AddedMass::new(&ball, AIR_DENSITY, (Gravity::EARTH, Some(lift), air)).unwrap();
                    let motion = at($velocity, $spin);
                    let jets = JetMotion::<$n>::new(std::array::from_fn(|i| motion.velocity[i].into()), $coordinates.map(f64::into));
                    let mut sum = JetSum::default();
                    prop_assert!(Effect::<$n, _>::series(&all, &jets, &mut sum));
                    let (a, turns) = (all.acceleration(&motion), all.spin_rate(&motion));
                    for (jet, a) in sum.acceleration().iter().zip(a.iter()) {
                        prop_assert!((jet.value() - a).abs() <= 1e-11 * (1.0 + a.abs().max(motion.velocity.norm_squared())));
                    }
                    (sum.spin_rate().map(saltus::Jet::value), turns)
                }};
            }
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
            let (flat, rate) = agrees!(2, vector![v[0], v[1]], w[0], [w[0], 0.0, 0.0]);
            prop_assert!(close(flat[0], rate));
            let (deep, rate) = agrees!(3, Vector3::from(v), Vector3::from(w), w);
            prop_assert!((0..3).all(|i| close(deep[i], rate[i])));
        }

        /// The plane is a slice of space: the vertical plane (x, up) with spin about the axis that
        /// completes it.
        #[test]
        fn planar_lift(v in prop::array::uniform2(-40.0..40.0_f64), w in -300.0..300.0_f64, sigma in 0.0..3.0_f64) {
            let lift = Magnus::new(&Sphere::solid(0.02, 0.05).unwrap(), AIR_DENSITY, 1.0, sigma).unwrap();
            let flat = lift.acceleration(&at(Vector2::from(v), w));
            // (x, z) in space turns from x to z about -y.
            let deep = lift.acceleration(&at(vector![v[0], 0.0, v[1]], vector![0.0, -w, 0.0]));
            prop_assert!((deep - vector![flat[0], 0.0, flat[1]]).norm() <= 1e-12 * flat.norm());
        }
    }
}
