//! The ball: two modes, one edge, exact arcs.

use nalgebra::{Vector2, vector};
use saltus::{Automaton, Edges, Polynomial};

use crate::restitution::Cor;

/// Gravity on Earth by convention, 9.80665 m/s² (third General Conference on Weights and Measures, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// A ball that flies freely and bounces on a level floor at height zero: gravity and a constant [`Cor`], nothing else.
///
/// State: height y of the ball's lowest point in m, velocity v upwards in m/s. In [`Mode::Flight`] y' = v, v' = -g; the edge
/// [`Floor`] is taken where y falls through zero, and v⁺ = -e v⁻. The bounces accumulate; beyond their limit, or after an
/// impact without rebound, the ball lies in [`Mode::Rest`].
///
/// Every arc is an exact parabola: no step is taken, at any height, speed or COR.
///
/// ```
/// use saltus::{Simulation, Stop};
/// use saltus_bounce::{Ball, Cor, Mode};
///
/// let ball = Ball::new(9.8, Cor::new(0.5)?)?;
/// let run = Simulation::of(&ball).run(Mode::Flight, Ball::dropped_from(1.0), 0.0..4.0)?;
///
/// assert_eq!(run.mode, Mode::Rest);
/// let rest = run.trajectory.jumps().last().unwrap();
/// assert!((rest.t() - 1.355_261_854_357_877).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    gravity: f64,
    cor: Cor,
}

/// What the ball is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// In the air.
    Flight,
    /// Lying on the floor.
    Rest,
}

/// The one edge: the ball meets the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Floor;

impl Ball {
    /// A ball under `gravity` in m/s², downwards.
    ///
    /// # Errors
    /// [`GravityError`] unless `gravity` is finite and not negative.
    pub fn new(gravity: f64, cor: Cor) -> Result<Self, GravityError> {
        if gravity.is_finite() && gravity >= 0.0 { Ok(Self { gravity, cor }) } else { Err(GravityError { gravity }) }
    }

    /// The state of a ball let go at rest from `height` in m.
    #[must_use]
    pub fn dropped_from(height: f64) -> Vector2<f64> {
        vector![height, 0.0]
    }

    /// The state of a ball at `height` in m that moves upwards at `velocity` in m/s.
    #[must_use]
    pub fn launched_from(height: f64, velocity: f64) -> Vector2<f64> {
        vector![height, velocity]
    }
}

impl Automaton for Ball {
    type Mode = Mode;
    type State = Vector2<f64>;
    type Edge = Floor;

    #[inline]
    fn flow(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        match mode {
            Mode::Flight => vector![x[1], -self.gravity],
            Mode::Rest => vector![0.0, 0.0],
        }
    }

    #[inline]
    fn edges(&self, mode: Mode) -> Edges<Floor> {
        match mode {
            Mode::Flight => Edges::from([Floor]),
            Mode::Rest => Edges::none(),
        }
    }

    #[inline]
    fn guard(&self, Floor: Floor, _t: f64, x: &Vector2<f64>) -> f64 {
        x[0]
    }

    #[inline]
    fn affine(&self, Floor: Floor) -> bool {
        true
    }

    #[inline]
    fn reset(&self, Floor: Floor, _t: f64, x: &Vector2<f64>) -> (Mode, Vector2<f64>) {
        let rebound = self.cor.rebound(-x[1]);
        let mode = if rebound > 0.0 { Mode::Flight } else { Mode::Rest };
        (mode, vector![0.0, rebound.max(0.0)])
    }

    #[inline]
    fn exact(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Option<Polynomial<Vector2<f64>>> {
        Some(match mode {
            Mode::Flight => Polynomial::from([*x, vector![x[1], -self.gravity], vector![-0.5 * self.gravity, 0.0]]),
            Mode::Rest => Polynomial::from([*x]),
        })
    }

    fn beyond(&self, _mode: Mode, _t: f64, _x: &Vector2<f64>) -> Option<(Mode, Vector2<f64>)> {
        Some((Mode::Rest, vector![0.0, 0.0]))
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
