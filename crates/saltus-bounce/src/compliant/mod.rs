//! A ball whose contact with the floor takes time.

mod contacts;
mod linear;

use nalgebra::{Vector2, vector};
use saltus::{About, Automaton, Edges, Fall, Refusal, Solution};

use crate::contact::ContactLaw;
use crate::parameter::{ParameterError, not_negative, positive};

pub use contacts::Contact;
use linear::Linear;

/// A ball that falls on a floor and is deformed: five stages, and the moments between them.
///
/// State: height y of the undeformed ball's lowest point in m, negative in contact, and velocity v
/// upwards in m/s.
///
/// ```text
/// Fall         y' = v, v' = -g               until y falls through 0                     first contact
/// Compression  y' = v, v' = -g + F(-y, -v)/m until the rate of deformation -v does       greatest deformation
/// Restitution  the same                      until the law's margin does                 lift-off
///                                            or v does                                   least deformation
/// Rise         y' = v, v' = -g               until v does                                apex
/// Lying        as in compression             for ever
/// ```
///
/// Flights are exact parabolas. Contacts are solved by formula where the law is linear
/// ([`KelvinVoigt`](crate::contact::KelvinVoigt)), else by steps: take [`Dop853`](saltus::Dop853),
/// and an absolute tolerance far below the deformation.
///
/// A ball that turns back before lift-off never leaves again: what is left of its energy is below
/// what would bring it to lift-off, and it does not grow. It is [`Stage::Lying`] from then on,
/// swinging about the static deformation. There is no Zeno limit, and the number of flights is
/// finite if the law is lossy.
///
/// A law that releases the ball under pressure (`KelvinVoigt` without tension) lets the rest of the
/// deformation go at once: the next contact is at y = 0. If the ball does not rise that far, the
/// floor follows, and contact begins anew at the apex.
///
/// Limits: one coordinate, no drag; mass and deformation as in the law's own limits.
///
/// ```
/// use saltus::Simulation;
/// use saltus_bounce::{Compliant, contact::KelvinVoigt};
///
/// let ball = Compliant::new(0.058, 9.81, KelvinVoigt::new(2e4, 6.0)?)?;
/// let (stage, start) = ball.released(1.0, 0.0);
/// let run = Simulation::of(&ball).run(stage, start, 0.0..1.5)?;
/// let contacts = ball.contacts(&run.trajectory);
/// assert_eq!(contacts.len(), 2);
/// let first = contacts[0];
/// assert!((first.speed - (2.0 * 9.81_f64).sqrt()).abs() < 1e-14);
/// assert!((first.cor.unwrap() - 0.77).abs() < 0.01 && first.duration.unwrap() < 6e-3);
/// // The loop of force over deformation: its area is the energy lost.
/// let hysteresis = ball.hysteresis(&run.trajectory, &first, 200);
/// assert!(hysteresis.iter().all(|[d, f]| *d >= 0.0 && *f <= first.force));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliant<L> {
    mass: f64,
    gravity: f64,
    law: L,
}

/// The mode of the ball.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Flight, until first contact.
    Fall,
    /// Contact, while the deformation grows.
    Compression,
    /// Contact, while the deformation decreases.
    Restitution,
    /// Flight, until the apex.
    Rise,
    /// Contact without end.
    Lying,
}

/// The moments between the stages: the edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// The ball touches the floor.
    FirstContact,
    /// The rate of deformation falls through zero.
    GreatestDeformation,
    /// The law's margin falls through zero.
    LiftOff,
    /// The ball turns back before lift-off.
    LeastDeformation,
    /// The ball turns in the air.
    Apex,
}

impl<L: ContactLaw> Compliant<L> {
    /// A ball of `mass` in kg under `gravity` in m/s², on a floor that it meets by `law`.
    ///
    /// # Errors
    /// [`ParameterError`] unless the mass is finite and positive, the gravity finite and not
    /// negative.
    pub fn new(mass: f64, gravity: f64, law: L) -> Result<Self, ParameterError> {
        Ok(Self { mass: positive("a mass in kg", mass)?, gravity: not_negative("a gravity in m/s^2", gravity)?, law })
    }

    /// The law of contact.
    pub const fn law(&self) -> &L {
        &self.law
    }

    /// The same ball, of this mass and under this gravity, by another law: a model that chooses
    /// its law as it runs hands its contacts to one that knows it.
    ///
    /// ```
    /// use saltus_bounce::Compliant;
    /// use saltus_bounce::contact::{HuntCrossley, KelvinVoigt};
    ///
    /// let ball = Compliant::new(0.05, 9.81, KelvinVoigt::new(2e4, 1.0)?)?;
    /// let hard = HuntCrossley::new(1e6, 0.1)?;
    /// assert_eq!(ball.by(hard), Compliant::new(0.05, 9.81, hard)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub const fn by<K: ContactLaw>(&self, law: K) -> Compliant<K> {
        Compliant { mass: self.mass, gravity: self.gravity, law }
    }

    /// The stage and state of a ball let go at `height` in m with `velocity` upwards in m/s;
    /// pressed into the floor if the height is negative.
    #[must_use]
    pub fn released(&self, height: f64, velocity: f64) -> (Stage, Vector2<f64>) {
        let stage = if height < 0.0 {
            Stage::Compression
        } else if velocity > 0.0 {
            Stage::Rise
        } else {
            Stage::Fall
        };
        let stage = if stage == Stage::Compression && velocity > 0.0 { Stage::Restitution } else { stage };
        (stage, vector![height, velocity])
    }

    /// The force of the floor on the ball in N, in the state `x` of a stage in contact.
    #[must_use]
    pub fn force(&self, x: &Vector2<f64>) -> f64 {
        self.law.force(-x[0], -x[1])
    }

    /// A time `s` later in contact, by a law that is linear.
    fn pressed(&self, _: Stage, _t: f64, x: &Vector2<f64>, s: f64) -> Vector2<f64> {
        let Some(contact) = self.linear() else { return x.map(|_| f64::NAN) };
        let [d, u] = contact.after(s, [-x[0], -x[1]]);
        vector![-d, -u]
    }

    fn linear(&self) -> Option<Linear> {
        self.law.linear().map(|law| Linear::new(law, self.mass, self.mass * self.gravity))
    }
}

impl Stage {
    /// Whether the floor presses.
    #[must_use]
    pub const fn is_contact(self) -> bool {
        matches!(self, Self::Compression | Self::Restitution | Self::Lying)
    }
}

impl<L: ContactLaw> Automaton for Compliant<L> {
    type Mode = Stage;
    type State = Vector2<f64>;
    type Edge = Moment;

    #[inline]
    fn flow(&self, stage: Stage, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let push = if stage.is_contact() { self.force(x) / self.mass } else { 0.0 };
        vector![x[1], push - self.gravity]
    }

    #[inline]
    fn edges(&self, stage: Stage) -> Edges<'_, Moment> {
        match stage {
            Stage::Fall => Edges::from([Moment::FirstContact]),
            Stage::Compression => Edges::from([Moment::GreatestDeformation]),
            Stage::Restitution => Edges::from([Moment::LiftOff, Moment::LeastDeformation]),
            Stage::Rise => Edges::from([Moment::Apex]),
            Stage::Lying => Edges::none(),
        }
    }

    #[inline]
    fn guard(&self, moment: Moment, _t: f64, x: &Vector2<f64>) -> f64 {
        match moment {
            Moment::FirstContact => x[0],
            Moment::GreatestDeformation => -x[1],
            Moment::LiftOff => self.law.margin(-x[0], -x[1]),
            Moment::LeastDeformation | Moment::Apex => x[1],
        }
    }

    #[inline]
    fn about(&self, moment: Moment) -> About {
        About::new().affine_if(moment != Moment::LiftOff)
    }

    #[inline]
    fn reset(&self, _: Stage, moment: Moment, _t: f64, x: &Vector2<f64>) -> Result<(Stage, Vector2<f64>), Refusal> {
        Ok(match moment {
            Moment::FirstContact => (Stage::Compression, vector![0.0, x[1]]),
            Moment::GreatestDeformation => (Stage::Restitution, vector![x[0], 0.0]),
            Moment::LiftOff => (Stage::Rise, *x),
            Moment::LeastDeformation => (Stage::Lying, vector![x[0], 0.0]),
            Moment::Apex if x[0] < 0.0 => (Stage::Compression, vector![x[0], 0.0]),
            Moment::Apex => (Stage::Fall, vector![x[0], 0.0]),
        })
    }

    #[inline]
    fn solution(&self, stage: Stage, _t: f64, x: &Vector2<f64>) -> Solution<Self> {
        let g = self.gravity;
        if !stage.is_contact() {
            Solution::Polynomial([*x, vector![x[1], -g], vector![-0.5 * g, 0.0]].into())
        } else if self.law.linear().is_some() {
            Solution::Formula(Self::pressed)
        } else {
            Solution::Steps
        }
    }

    fn falls(&self, _: Stage, moment: Moment, _t: f64, x: &Vector2<f64>) -> Fall<Vector2<f64>> {
        let Some(contact) = self.linear() else { return Fall::Unknown };
        let pressed = [-x[0], -x[1]];
        let time = match moment {
            Moment::LiftOff => contact.release(pressed),
            Moment::GreatestDeformation | Moment::LeastDeformation => contact.turn(pressed),
            Moment::FirstContact | Moment::Apex => return Fall::Unknown, // on a parabola
        };
        time.map_or(Fall::Never, Fall::After)
    }
}
