//! Several balls that each fly as a [`Flyer`], and that meet.

mod automaton;
mod meet;
mod state;

use nalgebra::Vector3;

use crate::effects::Effect;
use crate::flyer::{Event, Flyer, Grip, Stance};
use crate::friction::Friction;
use crate::parameter::ParameterError;
use crate::restitution::{Cor, Restitution};
use crate::sphere::Sphere;
use crate::walls::{Face, Walls};

pub use state::{Flying, Stances};

/// A ball of a flock: as a body, and as it flies.
pub type Member<E, W, R, G> = (Sphere, Flyer<3, Vector3<f64>, E, W, R, G>);

/// Spheres in space, at most N, each a [`Flyer`] with effects, walls, restitution and grip of its
/// own, that bounce off each other.
///
/// State [`Flying`]; mode [`Stances`], what each ball is doing; edges [`Meeting`]. Positions are
/// those of the lowest points. At an impact of two balls the law of `restitution` holds along the
/// line of centres, and [`Friction::collision`] across it. A ball that lies, slides or rolls and is
/// hit goes on from there: pushed into what it lies on, it strikes that at the same time.
///
/// Where the effects are uniform everything that flies, lies on a plane, or slides there smoothly
/// is on a parabola, no step is taken, and the meeting of two balls in flight is the root of a
/// quadratic. Else the balls are stepped together.
///
/// Several balls that touch at one time are taken pair by pair in the order of their numbers, then
/// the walls, each again if it must be.
///
/// Limits: a ball does not rest upon another. Where bounces between two balls accumulate and
/// something presses them together, the run ends with [`Stop::Zeno`](saltus::Stop::Zeno). Where
/// nothing does, they part at no speed.
///
/// ```
/// use nalgebra::{Vector3, vector};
/// use saltus::Simulation;
/// use saltus_bounce::effects::{Gravity, QuadraticDrag};
/// use saltus_bounce::friction::Friction;
/// use saltus_bounce::walls::Plane;
/// use saltus_bounce::{Cor, Flock, Flyer, Moving, Rolls, Sphere, flock::Flying};
///
/// // Two balls in air, dropped side by side: one rolls against the other.
/// let (ball, e) = (Sphere::solid(0.03, 0.05)?, Cor::new(0.6)?);
/// let grip = Rolls { ball, friction: Friction::rigid(0.3)? };
/// let air = (Gravity::EARTH, QuadraticDrag::sphere(&ball, 1.2, 0.47)?);
/// let each = Flyer::gripped(air, Plane::floor(0.0)?, e, grip)?;
/// let flock = Flock::<2, _, _, _, _>::new([(ball, each), (ball, each)], e, Friction::NONE)?;
/// let at = |x: f64, u: f64| Moving::new(vector![x, 0.0, 0.1], vector![u, 0.0, 0.0]).spinning(Vector3::zeros());
/// let start = Flying::new(&[at(0.0, 0.5), at(0.5, 0.0)]);
/// let run = Simulation::of(&flock).run(start.stances(), start, 0.0..5.0)?;
/// let [first, second] = [0, 1].map(|ball| run.end.state.ball(ball).position[0]);
/// assert!(first < second - 0.06 && second > 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Flock<const N: usize, E, W, R = Cor, G = (), C = Cor> {
    balls: Vec<Member<E, W, R, G>>,
    restitution: C,
    friction: Friction,
    /// The greatest number of faces that a cell has.
    faces: usize,
}

/// The edge, by the number of its place in the order of edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meeting(pub(super) usize);

/// The event that a [`Meeting`] is in a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Happens {
    /// An impact of two balls, the one of lower number first.
    Balls(usize, usize),
    /// Something happens to one ball.
    To(usize, Event<3>),
    /// A wall changes its motion, at a time of its schedule.
    Change,
    /// No event: the edge belongs to a stance in which the ball is not.
    Nothing,
}

/// The number of edges that may end a contact, in this order.
const ENDS: usize = 4;
/// The edge that the clock takes.
const CHANGE: Meeting = Meeting(usize::MAX);

impl<const N: usize, E, W, R, G, C> Flock<N, E, W, R, G, C>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
    C: Restitution,
{
    /// Balls with what each flies among and under, which meet each other by `restitution` and
    /// `friction`.
    ///
    /// # Errors
    /// [`ParameterError`] if there are more than N.
    pub fn new(
        balls: impl IntoIterator<Item = Member<E, W, R, G>>,
        restitution: C,
        friction: Friction,
    ) -> Result<Self, ParameterError> {
        let balls: Vec<_> = balls.into_iter().collect();
        if balls.len() > N {
            return Err(ParameterError::new(
                "a number of balls",
                balls.len() as f64,
                "at most as many as the type says",
            ));
        }
        let most = |walls: &W| (0..walls.cells()).map(|cell| walls.faces(cell)).max().unwrap_or(0);
        let faces = balls.iter().map(|(_, flyer)| most(flyer.walls())).max().unwrap_or(0);
        Ok(Self { balls, restitution, friction, faces })
    }

    /// The balls.
    #[must_use]
    pub fn balls(&self) -> &[Member<E, W, R, G>] {
        &self.balls
    }

    fn pairs(&self) -> usize {
        self.balls.len() * self.balls.len().saturating_sub(1) / 2
    }

    /// Whether two balls meet, or a ball a face: what else there is ends a contact.
    fn is_meeting(&self, Meeting(place): Meeting) -> bool {
        place < self.pairs() + self.balls.len() * self.faces
    }

    /// The event that `meeting` is where the stances of the balls are `stances`.
    #[must_use]
    pub fn happens(&self, meeting: Meeting, stances: &Stances<N>) -> Happens {
        if meeting == CHANGE {
            return Happens::Change;
        }
        let (count, pairs) = (self.balls.len(), self.pairs());
        let Meeting(mut place) = meeting;
        if place < pairs {
            let mut first = 0;
            while place >= count - 1 - first {
                place -= count - 1 - first;
                first += 1;
            }
            return Happens::Balls(first, first + 1 + place);
        }
        place -= pairs;
        let meets = place < count * self.faces;
        let (ball, local) = if meets {
            (place / self.faces, place % self.faces)
        } else {
            ((place - count * self.faces) / ENDS, (place - count * self.faces) % ENDS)
        };
        let Some((_, flyer)) = self.balls.get(ball) else { return Happens::Nothing };
        let stance = stances.of(ball);
        let event = if meets {
            let face = Face { cell: stance.cell(), index: local };
            let meets = local < flyer.walls().faces(face.cell) && !stance.touches(local);
            meets.then_some(Event::Meet(face))
        } else {
            flyer.end(stance, local)
        };
        event.map_or(Happens::Nothing, |event| Happens::To(ball, event))
    }

    /// The number of edges: those of contacts only where there is one.
    fn count(&self, stances: &Stances<N>) -> usize {
        let balls = self.balls.len();
        let flies = (0..balls).all(|ball| matches!(stances.of(ball), Stance::Flight { .. }));
        self.pairs() + balls * (self.faces + if flies { 0 } else { ENDS })
    }
}
