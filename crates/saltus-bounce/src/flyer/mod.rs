//! A ball in the plane or in space, among walls: effects, walls, restitution and grip are type
//! parameters.

mod automaton;
mod contact;
mod grip;
mod moving;
mod stance;

use std::marker::PhantomData;

use nalgebra::SVector;

use crate::effects::{Effect, JetMotion, JetSum, Motion};
use crate::parameter::ParameterError;
use crate::restitution::{Cor, Restitution};
use crate::walls::{Face, MOST_FACES, Walls};

pub(crate) use automaton::OF_CONTACT;
pub use grip::{Block, Grip, Keeps, Rolls};
pub use moving::{Moving, Turning};
pub use stance::{Event, Stance};

/// A ball that flies under the effects E among the walls W, in N coordinates, the last of which
/// points up.
///
/// It rebounds by the law R across a wall and by the grip G along it, relative to the wall's own
/// motion. State: [`Moving`], position and velocity, and spin only if S is one. A ball that has
/// come to rest on a wall is in contact with it: it slides, with friction where there is some, or
/// holds on (it lies still, is carried by a wall that moves, or rolls). With φ the wall's margin
/// and n its unit normal, in contact
///
/// ```text
/// x'' = a + λ n + f,   λ = -(d²φ/dt² by a and the wall alone)/|∂φ/∂p|     the normal force per mass
/// slides:   f = -μ λ along the slip     until the slip is zero, or λ falls to zero and it leaves
/// holds:    f = -(slip's change by a) α/(1 + α)     until |f| > μ λ and it slides, or λ falls to zero and it leaves
/// ```
///
/// In space a slip that begins slowly is along the push at first ([`Stance::Yield`]), for its
/// direction would be stiff.
///
/// Every mode is entered and left because of a force; there is no threshold of speed. Under uniform
/// effects ([`Effect::uniform`]) flights, and contacts with planes at rest, are exact parabolas,
/// and rides on floors that move have a formula: no step is taken. Else they are stepped.
///
/// Where an effect has a kink that flights pass through ([`Effect::kink`]; quadratic drag, v|v|,
/// has one at v = 0 in a single coordinate), a flight has a second edge, [`Event::Turn`], so that
/// no step goes across it.
///
/// Limits: contact with several walls at once is a [`Stance::Corner`] of planes at rest, without
/// friction. No pivoting and no rolling friction.
///
/// ```
/// use nalgebra::vector;
/// use saltus::Simulation;
/// use saltus_bounce::effects::Gravity;
/// use saltus_bounce::walls::Plane;
/// use saltus_bounce::{Cor, Flyer, Moving, Stance};
///
/// // Dropped on a smooth slope of 30 degrees: it bounces down, then slides.
/// let slope = Plane::incline(-std::f64::consts::FRAC_PI_6)?;
/// let ball = Flyer::new(Gravity::new(9.81)?, slope, Cor::new(0.5)?)?;
/// let start = Moving::new(vector![0.0, 1.0], vector![0.0, 0.0]);
/// let run = Simulation::of(&ball).run(Stance::FLIGHT, start, 0.0..10.0)?;
/// assert!(matches!(run.end.mode, Stance::Slide { .. }));
/// assert_eq!(run.end.stats.steps, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flyer<const N: usize, S, E, W, R = Cor, G = ()> {
    effects: E,
    walls: W,
    restitution: R,
    grip: G,
    expanded: bool,
    spin: PhantomData<S>,
}

impl<const N: usize, E: Effect<N>, W: Walls<N>, R: Restitution> Flyer<N, (), E, W, R> {
    /// A ball whose spin does not matter, among smooth walls.
    ///
    /// # Errors
    /// [`ParameterError`] if a cell has more than [`MOST_FACES`] faces.
    pub fn new(effects: E, walls: W, restitution: R) -> Result<Self, ParameterError> {
        Self::gripped(effects, walls, restitution, ())
    }
}

impl<const N: usize, S: Turning, E: Effect<N, S>, W: Walls<N>, R: Restitution, G: Grip<N, S>> Flyer<N, S, E, W, R, G> {
    /// A ball that walls hold by `grip`: [`Rolls`] for a ball that spins, [`Block`] for a body that
    /// does not, [`Keeps`] for a fixed loss.
    ///
    /// # Errors
    /// [`ParameterError`] if a cell has more than [`MOST_FACES`] faces.
    pub fn gripped(effects: E, walls: W, restitution: R, grip: G) -> Result<Self, ParameterError> {
        let most = (0..walls.cells()).map(|cell| walls.faces(cell)).max().unwrap_or(0);
        if most > MOST_FACES {
            const GIVE: &str = "at most 13; cut space into cells";
            const { assert!(MOST_FACES == 13) };
            return Err(ParameterError::new("a number of faces of one cell", most as f64, GIVE));
        }
        Ok(Self { effects, walls, restitution, grip, expanded: false, spin: PhantomData })
    }

    /// Advances flights in the plane and in space by Taylor series, where forces change and every
    /// effect has one ([`Effect::series`]): fewer steps, of an order that the tolerance asks for,
    /// and a smaller error.
    ///
    /// Limits: on a line the kink of drag is stepped to; contacts are stepped.
    #[must_use]
    pub fn by_series(mut self) -> Self {
        let rest = JetMotion::new([0.0.into(); N], [0.0.into(); 3]);
        self.expanded = N > 1 && self.effects.series(&rest, &mut JetSum::default());
        self
    }

    /// The walls.
    #[must_use]
    pub const fn walls(&self) -> &W {
        &self.walls
    }

    /// The effects.
    #[must_use]
    pub const fn effects(&self) -> &E {
        &self.effects
    }

    /// The stance and state of a ball that lies on `face` at time `t` and is not to bounce: in
    /// contact if it is pressed, in flight if not; its position and the velocity across the wall
    /// are made those of the wall.
    #[must_use]
    pub fn lying(&self, face: Face, t: f64, x: Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        self.settled(face, t, x)
    }

    /// Whether flights pass through a kink of the acceleration.
    #[inline]
    fn turns(&self) -> bool {
        let still = Motion { t: 0.0, position: SVector::zeros(), velocity: SVector::zeros(), spin: S::NONE };
        self.effects.kink(&still).is_some()
    }

    /// Whether a contact with `face` is the same always and everywhere: forces are constant.
    #[inline]
    fn steady(&self, face: Face) -> bool {
        self.effects.uniform() && self.walls.straight(face)
    }
}
