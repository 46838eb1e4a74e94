//! A handful of balls in a box, in the plane or in space.

mod flight;
mod meet;
mod swarm;

use std::fmt;

use saltus::{About, Automaton, Edges, Entry, Fall, Refusal, Solution};

use crate::parameter::{ParameterError, finite, positive};
use crate::restitution::{Cor, Restitution};

pub use flight::Flight;
pub(crate) use meet::balls as meeting_of_balls;
use meet::dot;
pub use swarm::Swarm;

/// N smooth balls in D dimensions that bounce off each other and off the walls of a box, under
/// gravity or without.
///
/// State [`Swarm`]; one mode, free flight on parabolas; edges [`Touch`]. Of two balls the relative
/// motion is a straight line, since gravity pulls both alike, and the time of their meeting the
/// root of a quadratic; of a ball and a wall likewise. At an impact the velocity along the line of
/// centres is turned round by the law of restitution; the one across it stays.
///
/// Impacts at one time are taken in a fixed order: pairs (0, 1), (0, 2), …, (N-2, N-1), then the
/// walls ball by ball; each again if it must be. Nothing is drawn at random: the same start gives
/// the same run.
///
/// As an automaton an event costs a look at all N(N-1)/2 pairs: meant for a handful of balls. For
/// up to some 64 of them, or for long runs, there is [`Cloud::flight`], which looks only at what an
/// impact has changed.
///
/// Limits: no spin, no friction. A lossy ball that bounces to rest, or lossy balls that collapse,
/// end the run with [`Stop::Zeno`](saltus::Stop::Zeno): what lies beyond is not modelled; on a line
/// it is, see [`Line`](crate::Line). Source: B. J. Alder and T. E. Wainwright, J. Chem. Phys. 31,
/// 459 (1959), doi:10.1063/1.1730376.
///
/// ```
/// use saltus::Simulation;
/// use saltus_bounce::{Cloud, Cor};
///
/// // One disc meets another that rests, half covered: the second leaves along the line of centres.
/// let cloud = Cloud::new([1.0, 1.0], [0.5, 0.5], Cor::new(1.0)?)?;
/// let start = cloud.placed([[0.0, 0.0], [2.0, 0.5]], [[1.0, 0.0], [0.0, 0.0]])?;
/// let run = Simulation::of(&cloud).run((), start, 0.0..3.0)?;
/// let [u, v] = run.end.state.velocities;
/// assert!((v[1] / v[0] - 0.5 / 0.75_f64.sqrt()).abs() < 1e-15);
/// assert!((u[0] * v[0] + u[1] * v[1]).abs() < 1e-15); // at right angles
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cloud<const D: usize, const N: usize, R = Cor> {
    masses: [f64; N],
    radii: [f64; N],
    gravity: [f64; D],
    law: R,
    walls: Option<Walls<D, R>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Walls<const D: usize, R> {
    low: [f64; D],
    high: [f64; D],
    law: R,
}

/// The edge: an impact of two balls, or of a ball and a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Touch {
    /// An impact of two balls, the one of lower number first.
    Balls(usize, usize),
    /// A ball and the wall at the low end of an axis.
    Low {
        /// The ball.
        ball: usize,
        /// The axis.
        axis: usize,
    },
    /// A ball and the wall at the high end of an axis.
    High {
        /// The ball.
        ball: usize,
        /// The axis.
        axis: usize,
    },
}

impl<const D: usize, const N: usize, R: Restitution + Copy> Cloud<D, N, R> {
    /// Balls of `masses` in kg and `radii` in m, which meet by the law `restitution`; no walls, no
    /// gravity.
    ///
    /// # Errors
    /// [`ParameterError`] unless every mass and radius is finite and positive.
    pub fn new(masses: [f64; N], radii: [f64; N], restitution: R) -> Result<Self, ParameterError> {
        for (mass, radius) in masses.into_iter().zip(radii) {
            positive("a mass in kg", mass)?;
            positive("a radius in m", radius)?;
        }
        Ok(Self { masses, radii, gravity: [0.0; D], law: restitution, walls: None })
    }

    /// This cloud under a gravity in m/s², by components.
    ///
    /// # Errors
    /// [`ParameterError`] unless it is finite.
    pub fn with_gravity(self, gravity: [f64; D]) -> Result<Self, ParameterError> {
        for part in gravity {
            finite("a component of gravity in m/s^2", part)?;
        }
        Ok(Self { gravity, ..self })
    }

    /// This cloud in a box from the corner `low` to the corner `high`, in m, whose walls are met by
    /// the law `restitution`.
    ///
    /// # Errors
    /// [`ParameterError`] unless both are finite and the box has an inside.
    pub fn in_box(self, low: [f64; D], high: [f64; D], restitution: R) -> Result<Self, ParameterError> {
        for (low, high) in low.into_iter().zip(high) {
            positive("the size of a box in m", finite("a corner of a box in m", high)? - low)?;
        }
        Ok(Self { walls: Some(Walls { low, high, law: restitution }), ..self })
    }

    /// The state of balls with these centres in m and velocities in m/s.
    ///
    /// # Errors
    /// [`OverlapError`] if two balls overlap, or one and a wall.
    pub fn placed(&self, centres: [[f64; D]; N], velocities: [[f64; D]; N]) -> Result<Swarm<D, N>, OverlapError> {
        let swarm = Swarm { centres, velocities };
        let overlap = self.edges(()).iter().find(|&touch| self.guard(touch, 0.0, &swarm) < 0.0);
        match overlap {
            Some(touch) => Err(OverlapError { touch, depth: -self.guard(touch, 0.0, &swarm) }),
            None => Ok(swarm),
        }
    }

    /// The total momentum in kg m/s.
    #[must_use]
    pub fn momentum(&self, x: &Swarm<D, N>) -> [f64; D] {
        std::array::from_fn(|k| self.masses.iter().zip(&x.velocities).map(|(m, v)| m * v[k]).sum())
    }

    /// The kinetic and potential energy in J, zero at rest at the origin.
    #[must_use]
    pub fn energy(&self, x: &Swarm<D, N>) -> f64 {
        let balls = self.masses.iter().zip(&x.velocities).zip(&x.centres);
        balls.map(|((m, v), x)| m * (0.5 * dot(v, v) - dot(&self.gravity, x))).sum()
    }

    /// The place of ball j relative to ball i, and its velocity.
    #[inline]
    fn relative(x: &Swarm<D, N>, i: usize, j: usize) -> ([f64; D], [f64; D]) {
        let r = std::array::from_fn(|k| x.centres[j][k] - x.centres[i][k]);
        (r, std::array::from_fn(|k| x.velocities[j][k] - x.velocities[i][k]))
    }

    /// The impact of two balls.
    fn impact(&self, i: usize, j: usize, x: &mut Swarm<D, N>) {
        let (r, v) = Self::relative(x, i, j);
        let distance = dot(&r, &r).sqrt();
        let normal = r.map(|r| r / distance);
        let approach = (-dot(&normal, &v)).max(0.0);
        let change = approach + self.law.rebound(approach);
        let (m, n) = (self.masses[i], self.masses[j]);
        for (k, normal) in normal.into_iter().enumerate() {
            x.velocities[i][k] -= n / (m + n) * change * normal;
            x.velocities[j][k] += m / (m + n) * change * normal;
        }
    }
}

/// Edge `k` of N balls in D dimensions: pairs in the order of their numbers, then walls.
fn touch<const D: usize, const N: usize>(k: usize) -> Touch {
    let pairs = N * N.saturating_sub(1) / 2;
    if k < pairs {
        // Row i begins at i (2N - 1 - i)/2; the root is exact there.
        #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let i = {
            let width = (2 * N - 1) as f64;
            (0.5 * (width - (width * width - 8.0 * k as f64).sqrt())) as usize
        };
        Touch::Balls(i, i + 1 + k - i * (2 * N - 1 - i) / 2)
    } else {
        let (ball, side) = ((k - pairs) / (2 * D), (k - pairs) % (2 * D));
        if side < D { Touch::Low { ball, axis: side } } else { Touch::High { ball, axis: side - D } }
    }
}

impl<const D: usize, const N: usize, R: Restitution + Copy> Cloud<D, N, R> {
    /// The state after a touch.
    fn touched(&self, touch: Touch, x: &Swarm<D, N>) -> Swarm<D, N> {
        let mut after = *x;
        match (touch, &self.walls) {
            (Touch::Balls(i, j), _) => self.impact(i, j, &mut after),
            (Touch::Low { ball, axis }, Some(walls)) => {
                let v = &mut after.velocities[ball][axis];
                *v = walls.law.rebound((-*v).max(0.0));
                after.centres[ball][axis] = walls.low[axis] + self.radii[ball];
            }
            (Touch::High { ball, axis }, Some(walls)) => {
                let v = &mut after.velocities[ball][axis];
                *v = -walls.law.rebound(v.max(0.0));
                after.centres[ball][axis] = walls.high[axis] - self.radii[ball];
            }
            (_, None) => {}
        }
        after
    }

    /// A time `s` later, without a touch.
    fn flown(&self, (): (), _t: f64, x: &Swarm<D, N>, s: f64) -> Swarm<D, N> {
        let mut after = *x;
        for (centre, velocity) in after.centres.iter_mut().zip(&mut after.velocities) {
            for k in 0..D {
                let bend = s * self.gravity[k];
                centre[k] += s * (velocity[k] + 0.5 * bend);
                velocity[k] += bend;
            }
        }
        after
    }
}

impl<const D: usize, const N: usize, R: Restitution + Copy> Automaton for Cloud<D, N, R> {
    type Mode = ();
    type State = Swarm<D, N>;
    type Edge = Touch;

    fn flow(&self, (): (), _t: f64, x: &Swarm<D, N>) -> Swarm<D, N> {
        Swarm { centres: x.velocities, velocities: [self.gravity; N] }
    }

    fn edges(&self, (): ()) -> Edges<'_, Touch> {
        let pairs = N * N.saturating_sub(1) / 2;
        Edges::indexed(if self.walls.is_some() { pairs + 2 * D * N } else { pairs }, touch::<D, N>)
    }

    #[inline]
    fn guard(&self, touch: Touch, _t: f64, x: &Swarm<D, N>) -> f64 {
        match (touch, &self.walls) {
            (Touch::Balls(i, j), _) => {
                let r = Self::relative(x, i, j).0;
                dot(&r, &r).sqrt() - (self.radii[i] + self.radii[j])
            }
            (Touch::Low { ball, axis }, Some(walls)) => x.centres[ball][axis] - (walls.low[axis] + self.radii[ball]),
            (Touch::High { ball, axis }, Some(walls)) => (walls.high[axis] - self.radii[ball]) - x.centres[ball][axis],
            (_, None) => f64::INFINITY,
        }
    }

    fn reset(&self, (): (), touch: Touch, _t: f64, x: &Swarm<D, N>) -> Result<((), Swarm<D, N>), Refusal> {
        Ok(((), self.touched(touch, x)))
    }
    /// Balls that overlap by rounding part or meet at once: [`falls`](Automaton::falls) decides.
    #[inline]
    fn about(&self, _: Touch) -> About {
        About::new().entry(Entry::Wait)
    }

    #[inline]
    fn solution(&self, (): (), _t: f64, _x: &Swarm<D, N>) -> Solution<Self> {
        Solution::Formula(Self::flown)
    }

    #[inline]
    fn falls(&self, (): (), touch: Touch, _t: f64, x: &Swarm<D, N>) -> Fall<Swarm<D, N>> {
        self.meeting(touch, x).map_or(Fall::Never, Fall::After)
    }
}

/// Balls placed where others, or a wall, already are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverlapError {
    touch: Touch,
    depth: f64,
}

impl OverlapError {
    /// The pair that overlaps.
    #[must_use]
    pub const fn touch(&self) -> Touch {
        self.touch
    }
}

impl fmt::Display for OverlapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.touch {
            Touch::Balls(i, j) => write!(f, "balls {i} and {j} overlap by {} m: move them apart", self.depth),
            Touch::Low { ball, axis } | Touch::High { ball, axis } => {
                write!(f, "ball {ball} reaches {} m through a wall of axis {axis}: move it inside", self.depth)
            }
        }
    }
}

impl std::error::Error for OverlapError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_in_order() {
        fn check<const N: usize>() {
            let pairs: Vec<_> = (0..N * (N - 1) / 2).map(touch::<2, N>).collect();
            let expected: Vec<_> = (0..N).flat_map(|i| (i + 1..N).map(move |j| Touch::Balls(i, j))).collect();
            assert_eq!(pairs, expected);
        }
        check::<1>();
        check::<2>();
        check::<3>();
        check::<64>();
        check::<301>();
        assert_eq!(touch::<2, 2>(1), Touch::Low { ball: 0, axis: 0 });
        assert_eq!(touch::<2, 2>(8), Touch::High { ball: 1, axis: 1 });
    }
}
