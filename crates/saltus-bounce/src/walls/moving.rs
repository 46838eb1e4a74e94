//! Level floors that move up and down: a vibrating table, a lift on a schedule, any motion from its
//! formula.

use std::fmt;

use nalgebra::SVector;

use super::{Face, Walls};
use crate::parameter::{ParameterError, finite, not_negative};

/// The motion of a level floor: its height in m, velocity in m/s and acceleration in m/s².
trait Motion {
    fn at(&self, t: f64) -> [f64; 3];
    /// h(t) - h(from), without cancellation where that can be had.
    fn moved(&self, from: f64, t: f64) -> f64 {
        self.at(t)[0] - self.at(from)[0]
    }
    fn changes(&self, _t: f64) -> Option<f64> {
        None
    }
}

macro_rules! level_floor {
    ($floor:ty $(, $parameter:ident)*) => {
        impl<const N: usize, $($parameter: Fn(f64) -> f64),*> Walls<N> for $floor {
            #[inline]
            fn margin(&self, _: Face, t: f64, p: &SVector<f64, N>) -> f64 {
                p[N - 1] - self.at(t)[0]
            }
            #[inline]
            fn gradient(&self, _: Face, _: f64, _: &SVector<f64, N>) -> SVector<f64, N> {
                let mut up = SVector::zeros();
                up[N - 1] = 1.0;
                up
            }
            #[inline]
            fn rate(&self, _: Face, t: f64, _: &SVector<f64, N>) -> f64 {
                -self.at(t)[1]
            }
            #[inline]
            fn bend(&self, _: Face, t: f64, _: &SVector<f64, N>, _: &SVector<f64, N>) -> f64 {
                -self.at(t)[2]
            }
            #[inline]
            fn carried(&self, _: Face, from: f64, t: f64) -> Option<(f64, f64)> {
                Some((self.moved(from, t), self.at(t)[1]))
            }
            fn changes(&self, t: f64) -> Option<f64> {
                Motion::changes(self, t)
            }
        }
    };
}

/// A level floor that vibrates: h = m + A sin(ωt + φ).
///
/// What lies on it leaves where h'' < -g, at the phase asin(g/(Aω²)), if Aω² > g. Source: A. B.
/// Pippard, *The Physics of Vibration* (1978), chapter 9; N. B. Tufillaro et al., *An Experimental
/// Approach to Nonlinear Dynamics and Chaos* (1992), chapter 1.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Table, Walls};
/// let table = Table::new(0.01, 50.0)?;
/// assert_eq!(table.rate(Face::default(), 0.0, &vector![0.0]), -0.5);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    amplitude: f64,
    frequency: f64,
    phase: f64,
    mean: f64,
}

impl Table {
    /// A vibration of the amplitude A in m and the angular frequency ω in rad/s; φ = 0, m = 0.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite and not negative.
    pub fn new(amplitude: f64, frequency: f64) -> Result<Self, ParameterError> {
        Ok(Self {
            amplitude: not_negative("an amplitude in m", amplitude)?,
            frequency: not_negative("an angular frequency in rad/s", frequency)?,
            phase: 0.0,
            mean: 0.0,
        })
    }

    /// This vibration with the phase φ in rad at t = 0, about the height m = `mean` in m.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite.
    pub fn shifted(self, phase: f64, mean: f64) -> Result<Self, ParameterError> {
        Ok(Self { phase: finite("a phase in rad", phase)?, mean: finite("a height in m", mean)?, ..self })
    }
}

impl Motion for Table {
    #[inline]
    fn at(&self, t: f64) -> [f64; 3] {
        let Self { amplitude: a, frequency: w, phase, mean } = self;
        let (sin, cos) = (w * t + phase).sin_cos();
        [mean + a * sin, a * w * cos, -a * w * w * sin]
    }
}

level_floor!(Table);

/// A level floor whose height, velocity and acceleration are functions of time.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Shaken, Walls};
/// let sinking = Shaken::new(|t: f64| -0.5 * t * t, |t| -t, |_| -1.0);
/// assert_eq!(sinking.margin(Face::default(), 2.0, &vector![0.0]), 2.0);
/// ```
#[derive(Clone, Copy)]
pub struct Shaken<H, V, A> {
    height: H,
    velocity: V,
    acceleration: A,
}

impl<H: Fn(f64) -> f64, V: Fn(f64) -> f64, A: Fn(f64) -> f64> Shaken<H, V, A> {
    /// A floor of the `height` in m, its derivative `velocity` and the second one `acceleration`,
    /// all smooth.
    #[must_use]
    pub const fn new(height: H, velocity: V, acceleration: A) -> Self {
        Self { height, velocity, acceleration }
    }
}

impl<H, V, A> fmt::Debug for Shaken<H, V, A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shaken").finish_non_exhaustive()
    }
}

impl<H: Fn(f64) -> f64, V: Fn(f64) -> f64, A: Fn(f64) -> f64> Motion for Shaken<H, V, A> {
    #[inline]
    fn at(&self, t: f64) -> [f64; 3] {
        [(self.height)(t), (self.velocity)(t), (self.acceleration)(t)]
    }
}

level_floor!(Shaken<H, V, A>, H, V, A);

/// A level floor on a schedule: between given times its acceleration is constant.
///
/// Its height and velocity have no jumps; its acceleration jumps at each time, and a ball that it
/// carries looks again whether it is still carried.
///
/// ```
/// use nalgebra::vector;
/// use saltus_bounce::walls::{Face, Lift, Walls};
/// // Up at 2 m/s² for a second, steady for two, and to a stop.
/// let lift = Lift::new(0.0, 0.0, &[(0.0, 2.0), (1.0, 0.0), (3.0, -2.0), (4.0, 0.0)])?;
/// assert_eq!(lift.margin(Face::default(), 9.0, &vector![6.0]), 0.0);
/// assert_eq!(Walls::<1>::changes(&lift, 1.0), Some(3.0));
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lift {
    /// The start of each stretch, and height, velocity and acceleration there.
    stretches: Vec<(f64, [f64; 3])>,
}

impl Lift {
    /// A floor at `height` in m at the first time, moving at `velocity` in m/s until then; from
    /// each time in s on with the acceleration beside it, in m/s².
    ///
    /// # Errors
    /// [`ParameterError`] unless all numbers are finite and the times rise.
    pub fn new(height: f64, velocity: f64, schedule: &[(f64, f64)]) -> Result<Self, ParameterError> {
        let (mut h, mut v) = (finite("a height in m", height)?, finite("a velocity in m/s", velocity)?);
        let mut last = (schedule.first().map_or(0.0, |first| first.0), 0.0);
        let mut stretches = vec![(f64::NEG_INFINITY, [h, v, 0.0])];
        for &(t, a) in schedule {
            let s = finite("a time of a schedule in s", t)? - last.0;
            if s < 0.0 || s == 0.0 && stretches.len() > 1 {
                return Err(ParameterError::new("the next time of a schedule", t, "times in rising order"));
            }
            (h, v) = (h + s * (v + 0.5 * last.1 * s), v + last.1 * s);
            stretches.push((t, [h, v, finite("an acceleration in m/s^2", a)?]));
            last = (t, a);
        }
        Ok(Self { stretches })
    }
}

impl Motion for Lift {
    #[inline]
    fn at(&self, t: f64) -> [f64; 3] {
        let k = self.stretches.partition_point(|stretch| stretch.0 <= t).max(1) - 1;
        let (from, [h, v, a]) = self.stretches[k];
        let first = self.stretches.get(1).map_or(0.0, |first| first.0);
        let s = t - if from.is_finite() { from } else { first };
        [h + s * (v + 0.5 * a * s), v + a * s, a]
    }
    fn changes(&self, t: f64) -> Option<f64> {
        self.stretches.iter().map(|stretch| stretch.0).find(|&from| from > t)
    }
}

level_floor!(Lift);
