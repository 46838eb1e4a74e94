//! The vertical ball: its flight and its restitution are type parameters, and it costs what they
//! cost.

mod parted;
mod smooth;

use nalgebra::{Vector2, vector};

use crate::flight::{VacuumFlight, VerticalFlight};
use crate::parameter::{ParameterError, finite};
use crate::restitution::{Cor, Restitution};

pub use parted::{Phase, Turn};
pub use smooth::{Floor, Mode, SmoothFlight};

/// A ball that flies up and down and bounces on a level floor; by default gravity and a constant
/// [`Cor`], nothing else.
///
/// State: height y of the ball's lowest point *above the floor* in m, velocity v upwards in m/s; so
/// the last bounces keep their digits wherever the floor lies ([`with_floor`](Self::with_floor),
/// [`height`](Self::height)). At the [`Floor`] v⁺ is the restitution law's rebound. The bounces
/// accumulate; beyond their limit, or after an impact without rebound, the ball lies in `Rest`.
///
/// | flight F | modes | solution |
/// |---|---|---|
/// | [`VacuumFlight`], the default | [`Mode`]: `Flight`, `Rest` | a parabola, its impact by a square root |
/// | [`LinearDragFlight`](crate::flight::LinearDragFlight) | [`Mode`] | its formula |
/// | [`QuadraticDragFlight`](crate::flight::QuadraticDragFlight) | [`Phase`]: `Rising`, `Falling`, `Rest` | its formula, smooth in each |
///
/// No step is taken, at any height, speed or restitution. Limits: no motion sideways (see
/// [`Flyer`](crate::Flyer)); contact takes no time.
///
/// ```
/// use saltus::{Simulation, Stop};
/// use saltus_bounce::{Ball, Cor, Mode};
///
/// let ball = Ball::new(9.8, Cor::new(0.5)?)?;
/// let run = Simulation::of(&ball).run(Mode::Flight, Ball::dropped_from(1.0), 0.0..4.0)?;
///
/// assert_eq!(run.end.mode, Mode::Rest);
/// let rest = run.trajectory.jumps().last().unwrap();
/// assert!((rest.t() - 1.355_261_854_357_877).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// With drag, and a restitution that falls with the speed of impact:
///
/// ```
/// use saltus::Simulation;
/// use saltus_bounce::flight::QuadraticDragFlight;
/// use saltus_bounce::restitution::Linear;
/// use saltus_bounce::{Ball, Cor, Phase};
///
/// let ball = Ball::of(QuadraticDragFlight::new(9.81, 0.1)?, Linear::new(Cor::new(0.8)?, -0.01, 0.0, 20.0)?);
/// let run = Simulation::of(&ball).run(Phase::Falling, Ball::dropped_from(20.0), 0.0..20.0)?;
/// assert_eq!((run.end.mode, run.end.stats.steps), (Phase::Rest, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<F = VacuumFlight, R = Cor> {
    flight: F,
    restitution: R,
    floor: f64,
}

impl Ball {
    /// A ball under `gravity` in m/s², downwards.
    ///
    /// # Errors
    /// [`GravityError`] unless `gravity` is finite and not negative.
    pub fn new(gravity: f64, cor: Cor) -> Result<Self, GravityError> {
        let flight = VacuumFlight::new(gravity).map_err(|_| GravityError { gravity })?;
        Ok(Self::of(flight, cor))
    }

    /// The state of a ball let go at rest from `height` in m above the floor.
    #[must_use]
    pub fn dropped_from(height: f64) -> Vector2<f64> {
        vector![height, 0.0]
    }

    /// The state of a ball at `height` in m above the floor that moves upwards at `velocity` in
    /// m/s.
    #[must_use]
    pub fn launched_from(height: f64, velocity: f64) -> Vector2<f64> {
        vector![height, velocity]
    }
}

impl<F: VerticalFlight, R: Restitution> Ball<F, R> {
    /// A ball that flies by the law `flight` and rebounds by the law `restitution`, its floor at
    /// height zero.
    #[must_use]
    pub const fn of(flight: F, restitution: R) -> Self {
        Self { flight, restitution, floor: 0.0 }
    }

    /// This ball over a floor at `height` in m. The state still counts from the floor.
    ///
    /// ```
    /// use saltus_bounce::{Ball, Cor};
    /// let ball = Ball::new(9.81, Cor::new(0.8)?)?.with_floor(320.0)?;
    /// assert_eq!(ball.height(&Ball::dropped_from(1.5)), 321.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ParameterError`] unless `height` is finite.
    pub fn with_floor(self, height: f64) -> Result<Self, ParameterError> {
        Ok(Self { floor: finite("a height of a floor in m", height)?, ..self })
    }

    /// The height of the floor in m.
    #[must_use]
    pub const fn floor(&self) -> f64 {
        self.floor
    }

    /// The height of the ball's lowest point in the state `x`, in the coordinates in which the
    /// floor has its height, in m.
    #[must_use]
    pub fn height(&self, x: &Vector2<f64>) -> f64 {
        self.floor + x[0]
    }

    /// The law of flight.
    #[must_use]
    pub const fn flight(&self) -> &F {
        &self.flight
    }

    /// The law of impact.
    #[must_use]
    pub const fn restitution(&self) -> &R {
        &self.restitution
    }

    /// The speed after an impact that is met with `velocity` upwards, in m/s.
    #[inline]
    fn rebound(&self, velocity: f64) -> f64 {
        // Rounding may leave a ball on the floor with a velocity just above zero, for which no law
        // has a value.
        self.restitution.rebound((-velocity).max(0.0)).max(0.0)
    }
}

/// A number that is no gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GravityError {
    gravity: f64,
}

impl std::fmt::Display for GravityError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} m/s^2 is not a gravity: give a finite number, zero or more (9.81 on Earth, 1.62 on the Moon)",
            self.gravity
        )
    }
}

impl std::error::Error for GravityError {}
