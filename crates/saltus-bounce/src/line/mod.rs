//! Several balls on a line: stacked balls, Newton's cradle, chains, billiards that compute π.

mod collapse;
mod row;
mod stack;

use saltus::{About, Automaton, Edges, Limit, Refusal, Solution};

use crate::impact::impact;
use crate::parameter::{ParameterError, not_negative, positive};
use crate::restitution::{Cor, Restitution};

pub use row::Row;

/// N balls on a line, with a floor below the first and a wall beyond the last if wanted, and
/// gravity towards the floor.
///
/// State [`Row`]; mode [`Lying`], the number of balls that lie still on the floor, stacked; edges
/// [`Contact`]: contact 0 is between floor and first ball, contact i between the balls i - 1 and i,
/// contact N between last ball and wall. Between contacts every ball flies on its parabola, and
/// every gap is a polynomial of degree two at most, whose first root has all its digits.
///
/// **Impacts** are of two bodies at a time, each with the restitution of its contact at the speed
/// of approach. Where several contacts close at one time they are taken in their order from the
/// floor up, until none approaches: a cascade, in which one contact may take part more than once.
/// The outcome of simultaneous impacts is a matter of the model, not of numerics: this one is that
/// of tiny gaps, closed from the left.
///
/// **Collapse.** With enough loss infinitely many impacts happen in a finite time. Contacts that go
/// on colliding up to the limit are closed: such balls have one velocity from then on, that of
/// their centre of mass, or zero if the floor is among them, and the gaps between them stay zero.
/// The balls that lie on the floor lie until something hits them. Under gravity an impact on balls
/// that stand on the floor in touch is one jump: it is handed down and up, impact by impact, until
/// none of them approaches, or only at a speed that is rounding (10⁻¹⁴) beside the greatest of a
/// ball that falls; what then has no speed lies.
///
/// Limits: no spin, no attraction: touching balls that are pulled apart part. Source for collapse:
/// S. `McNamara` and W. R. Young, Phys. Fluids A 4, 496 (1992), doi:10.1063/1.858323.
///
/// ```
/// use saltus::Simulation;
/// use saltus_bounce::{Cor, Line, line::{Lying, Row}};
///
/// // Newton's cradle: five balls that touch, one of them comes in.
/// let cradle = Line::new([1.0; 5], Cor::new(1.0)?)?;
/// let start = Row { gaps: [-1.0, 1.0, 0.0, 0.0, 0.0], velocities: [1.0, 0.0, 0.0, 0.0, 0.0] };
/// let run = Simulation::of(&cradle).run(Lying::NONE, start, 0.0..2.0)?;
/// assert_eq!(run.end.state.velocities, [0.0, 0.0, 0.0, 0.0, 1.0]);
/// assert!(run.trajectory.jumps().iter().all(|jump| jump.t() == 1.0));
///
/// // A tennis ball on a basketball, both dropped from 1 m: nine times as high is the limit.
/// let stack = Line::new([0.6, 0.058], Cor::new(1.0)?)?.with_gravity(9.81)?.on_floor();
/// let run = Simulation::of(&stack).run(Lying::NONE, Row { gaps: [1.0, 1e-9], velocities: [0.0; 2] }, 0.0..0.6)?;
/// let upper = run.trajectory.jumps()[1].after.velocities[1];
/// assert!((upper * upper / (2.0 * 9.81) - 7.0088).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<const N: usize, R = Cor> {
    masses: [f64; N],
    laws: [R; N],
    gravity: f64,
    floor: bool,
    wall: Option<(f64, R)>,
}

/// The number of balls that lie still on the floor, one upon the other; the mode.
///
/// It also remembers how fast the balls have been; two modes are equal if as many balls lie.
#[derive(Clone, Copy, Debug)]
pub struct Lying {
    balls: usize,
    fastest: f64,
}

impl Lying {
    /// The mode in which no ball lies.
    pub const NONE: Self = Self::balls(0);

    /// The first `count` balls lie.
    #[must_use]
    pub const fn balls(count: usize) -> Self {
        Self { balls: count, fastest: 0.0 }
    }

    /// The number of balls that lie.
    #[must_use]
    pub const fn count(self) -> usize {
        self.balls
    }
}

impl PartialEq for Lying {
    fn eq(&self, other: &Self) -> bool {
        self.balls == other.balls
    }
}

/// A place of contact, by the ball above it; the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact(pub usize);

impl<const N: usize, R: Restitution + Copy> Line<N, R> {
    /// Balls of `masses` in kg from left to right, all of which meet by the law `restitution`; no
    /// floor, no wall, no gravity.
    ///
    /// # Errors
    /// [`ParameterError`] unless every mass is finite and positive.
    pub fn new(masses: [f64; N], restitution: R) -> Result<Self, ParameterError> {
        for mass in masses {
            positive("a mass in kg", mass)?;
        }
        Ok(Self { masses, laws: [restitution; N], gravity: 0.0, floor: false, wall: None })
    }

    /// This line with a floor at 0, below the first ball.
    #[must_use]
    pub fn on_floor(self) -> Self {
        Self { floor: true, ..self }
    }

    /// This line under a gravity in m/s² towards the floor.
    ///
    /// # Errors
    /// [`ParameterError`] unless it is finite and not negative.
    pub fn with_gravity(self, gravity: f64) -> Result<Self, ParameterError> {
        Ok(Self { gravity: not_negative("a gravity in m/s^2", gravity)?, ..self })
    }

    /// This line with a wall beyond the last ball, which meets it by `restitution` where the gaps
    /// add up to `length` in m.
    ///
    /// # Errors
    /// [`ParameterError`] unless the length is finite and positive.
    pub fn up_to_wall(self, length: f64, restitution: R) -> Result<Self, ParameterError> {
        Ok(Self { wall: Some((positive("a length in m", length)?, restitution)), ..self })
    }

    /// This line with another law for one contact: 0 is the floor's, i that of the balls i - 1 and
    /// i. Other numbers change nothing.
    #[must_use]
    pub fn contact(mut self, contact: usize, restitution: R) -> Self {
        if let Some(law) = self.laws.get_mut(contact) {
            *law = restitution;
        }
        self
    }

    /// The total momentum in kg m/s.
    #[must_use]
    pub fn momentum(&self, x: &Row<N>) -> f64 {
        self.masses.iter().zip(x.velocities).map(|(m, v)| m * v).sum()
    }

    /// The kinetic and potential energy in J, zero at rest at position zero.
    #[must_use]
    pub fn energy(&self, x: &Row<N>) -> f64 {
        let balls = self.masses.iter().zip(x.velocities).zip(x.positions());
        balls.map(|((m, v), y)| m * (0.5 * v * v + self.gravity * y)).sum()
    }

    /// The state after an impact at `contact`.
    fn closed(&self, contact: usize, x: &Row<N>) -> Row<N> {
        let mut after = *x;
        let v = &mut after.velocities;
        if contact == N {
            let Some((length, law)) = self.wall.filter(|_| N > 0) else { return after };
            v[N - 1] = -law.rebound(v[N - 1].max(0.0));
            after.gaps[N - 1] += length - x.gaps.iter().sum::<f64>();
        } else {
            let below = if contact == 0 { 0.0 } else { v[contact - 1] };
            let speed = (below - v[contact]).max(0.0);
            let rebound = self.laws[contact].rebound(speed);
            if contact == 0 {
                v[0] = rebound;
            } else {
                let masses = [self.masses[contact - 1], self.masses[contact]];
                let pair = impact(masses, [below, v[contact]], speed, rebound);
                [v[contact - 1], v[contact]] = pair;
            }
            after.gaps[contact] = 0.0;
        }
        after
    }

    /// The acceleration of ball `i` in m/s² if `lying` balls lie.
    const fn acceleration(&self, i: usize, lying: usize) -> f64 {
        if i < lying { 0.0 } else { -self.gravity }
    }
}

impl<const N: usize, R: Restitution + Copy> Automaton for Line<N, R> {
    type Mode = Lying;
    type State = Row<N>;
    type Edge = Contact;

    #[inline]
    fn flow(&self, lying: Lying, _t: f64, x: &Row<N>) -> Row<N> {
        let lying = lying.balls;
        let rate = |i: usize| x.velocities[i] - if i == 0 { 0.0 } else { x.velocities[i - 1] };
        let velocities = std::array::from_fn(|i| self.acceleration(i, lying));
        Row { gaps: std::array::from_fn(rate), velocities }
    }

    #[inline]
    fn edges(&self, _: Lying) -> Edges<'_, Contact> {
        match (self.floor, self.wall.is_some()) {
            (true, true) => Edges::indexed(N + 1, Contact),
            (true, false) => Edges::indexed(N, Contact),
            (false, true) => Edges::indexed(N, |i| Contact(i + 1)),
            (false, false) => Edges::indexed(N.saturating_sub(1), |i| Contact(i + 1)),
        }
    }

    #[inline]
    fn guard(&self, Contact(contact): Contact, _t: f64, x: &Row<N>) -> f64 {
        match (x.gaps.get(contact), &self.wall) {
            (Some(gap), _) => *gap,
            (None, Some((length, _))) => length - x.gaps.iter().sum::<f64>(),
            (None, None) => f64::INFINITY,
        }
    }

    #[inline]
    fn about(&self, _: Contact) -> About {
        About::new().affine()
    }

    #[inline]
    fn reset(&self, lying: Lying, contact: Contact, _t: f64, x: &Row<N>) -> Result<(Lying, Row<N>), Refusal> {
        Ok(self.struck(contact, lying, x))
    }

    #[inline]
    fn solution(&self, lying: Lying, t: f64, x: &Row<N>) -> Solution<Self> {
        let (slope, lying) = (self.flow(lying, t, x), lying.balls);
        let bend = |i: usize| {
            let below = if i == 0 { 0.0 } else { self.acceleration(i - 1, lying) };
            0.5 * (self.acceleration(i, lying) - below)
        };
        let bend = Row { gaps: std::array::from_fn(bend), velocities: [0.0; N] };
        Solution::Polynomial([*x, slope, bend].into())
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Lying, Row<N>)> {
        let closed = self.collapsing(limit.mode, limit.x);
        Some(self.merged(limit.mode, &closed, limit.x))
    }
}
