//! The ball among walls as a hybrid automaton.

use nalgebra::SVector;
use saltus::{About, Automaton, Clocks, Edges, Entry, Jet, Limit, Refusal, Series, Solution, State, Ticking};

use super::contact::{VEERS, forwards, none};
use super::{Event, Flyer, Grip, Moving, Stance, Turning};
use crate::effects::{Effect, JetMotion, JetSum};
use crate::restitution::Restitution;
use crate::walls::{Face, Walls};

/// The entry of edges that end or change a contact: a contact may be over where it begins.
pub(crate) const OF_CONTACT: Entry = Entry::Fire;

impl<const N: usize, S: Turning, E: Effect<N, S>, W: Walls<N>, R: Restitution, G: Grip<N, S>> Flyer<N, S, E, W, R, G> {
    /// x' in `stance`.
    #[inline]
    fn rate(&self, stance: Stance<N>, t: f64, x: &Moving<N, S>) -> Moving<N, S> {
        let (velocity, spin) = match stance {
            Stance::Flight { .. } => {
                let motion = x.at(t);
                (self.effects.acceleration(&motion), self.effects.spin_rate(&motion))
            }
            Stance::Slide { face, .. } | Stance::Yield { face, .. } | Stance::Hold { face } => {
                let touch = self.touch(face, t, x);
                let friction = match stance {
                    Stance::Yield { since, .. } => self.yielding(face, since, t, x, &touch),
                    _ if N > 2 => self.friction(stance, &touch, &self.slip(face, t, x).0),
                    _ => self.friction(stance, &touch, &SVector::zeros()),
                };
                let spin = touch.spin_rate.plus(self.grip.torque(&friction, &touch.normal));
                (touch.free + touch.normal * touch.force + friction, spin)
            }
            Stance::Corner { cell, faces } => {
                let motion = x.at(t);
                let free = self.effects.acceleration(&motion);
                (self.within(cell, faces, t, x, free), self.effects.spin_rate(&motion))
            }
        };
        Moving { position: x.velocity, velocity, spin }
    }

    /// The flow of a flight over jets, for a state of as many coordinates as [`Moving`] has, in its
    /// order: places, velocities, spin. An automaton whose states are lists advances this ball by
    /// the same series.
    pub fn expand<X: State>(&self, _: Stance<N>, series: &mut Series<'_, X>) {
        match 2 * N + S::LEN {
            4 => series.flow::<4>(|_, x| self.jets(x)),
            5 => series.flow::<5>(|_, x| self.jets(x)),
            6 => series.flow::<6>(|_, x| self.jets(x)),
            9 => series.flow::<9>(|_, x| self.jets(x)),
            _ => {}
        }
    }

    /// x' in flight over jets.
    #[inline(always)]
    fn jets<'j, const K: usize>(&self, x: [Jet<'j>; K]) -> [Jet<'j>; K] {
        let (mut velocity, mut spin) = ([Jet::from(0.0); N], [Jet::from(0.0); 3]);
        velocity.iter_mut().zip(x.iter().skip(N)).for_each(|(to, from)| *to = *from);
        spin.iter_mut().zip(x.iter().skip(2 * N)).for_each(|(to, from)| *to = *from);
        let mut sum = JetSum::<N>::default();
        self.effects.series(&JetMotion::new(velocity, spin), &mut sum);
        let rates = [velocity, sum.acceleration()];
        let mut rate = x;
        rate.iter_mut().zip(rates.iter().flatten()).for_each(|(to, from)| *to = *from);
        rate.iter_mut().skip(2 * N).zip(&sum.spin_rate()).for_each(|(to, from)| *to = *from);
        rate
    }

    /// Whether forces are constant in `stance`.
    #[inline]
    fn uniform(&self, stance: Stance<N>) -> bool {
        self.effects.uniform()
            && match stance {
                Stance::Flight { .. } | Stance::Corner { .. } => true,
                // In space friction turns with the slip.
                Stance::Slide { face, along } => (N <= 2 || none(&along)) && self.walls.straight(face),
                Stance::Yield { face, .. } | Stance::Hold { face } => self.walls.straight(face),
            }
    }

    /// The events that may end a stance, in the order in which they are taken at one time: what
    /// [`Automaton::edges`] gives, for a stance whose directions have K coordinates. K may be more
    /// than N, where directions go on with zeros.
    #[inline]
    pub fn events<const K: usize>(&self, stance: Stance<K>) -> Edges<'_, Event<K>> {
        let cell = stance.cell();
        let faces = (0..self.walls.faces(cell)).filter(|&index| !stance.touches(index));
        let meets = faces.map(|index| Event::Meet(Face { cell, index }));
        match stance {
            Stance::Flight { .. } => meets.chain(self.turns().then_some(Event::Turn)).collect(),
            Stance::Corner { .. } => meets.collect(),
            Stance::Slide { face, along } => {
                let leaves = (!self.steady(face)).then_some(Event::Leave(face));
                let stops = (!none(&along)).then_some(Event::Stop { face, along });
                meets.chain(leaves).chain(stops).collect()
            }
            Stance::Yield { face, push, since } => {
                let ends = [Event::Leave(face), Event::Stop { face, along: push }, Event::Veer { face, push, since }];
                meets.chain((!self.steady(face)).then_some(ends).into_iter().flatten()).collect()
            }
            Stance::Hold { face } => {
                let moves = !self.steady(face);
                meets.chain(moves.then_some(Event::Leave(face))).chain(moves.then_some(Event::Slip(face))).collect()
            }
        }
    }

    /// The events that may end a contact by itself, in a fixed order: leaving, the end of a slip,
    /// friction that gives way, a slip that finds its direction.
    pub(crate) fn end(&self, stance: Stance<N>, place: usize) -> Option<Event<N>> {
        let is = |event: &Event<N>| match event {
            Event::Leave(_) => place == 0,
            Event::Stop { .. } => place == 1,
            Event::Slip(_) => place == 2,
            Event::Veer { .. } => place == 3,
            Event::Meet(_) | Event::Change | Event::Turn => false,
        };
        if matches!(stance, Stance::Flight { .. }) { None } else { self.edges(stance).iter().find(is) }
    }

    /// A ride on a face that moves, without friction that depends on how it is pressed.
    #[inline]
    fn ridden(&self, stance: Stance<N>) -> Option<Face> {
        match stance {
            Stance::Hold { face } if self.effects.uniform() => Some(face),
            Stance::Slide { face, along } if self.effects.uniform() && none(&along) => Some(face),
            _ => None,
        }
    }

    /// A time `s` later on a ride.
    fn carried(&self, stance: Stance<N>, t: f64, x: &Moving<N, S>, s: f64) -> Moving<N, S> {
        let carried = self.ridden(stance).and_then(|face| Some((face, self.walls.carried(face, t, t + s)?)));
        let Some((face, (moved, speed))) = carried else { return *x };
        let touch = self.touch(face, t, x);
        let length = self.walls.gradient(face, t, &x.position).norm();
        let n = touch.normal;
        let friction = self.friction(stance, &touch, &SVector::zeros());
        let a = touch.free - n * touch.free.dot(&n) + friction;
        let v = x.velocity - n * x.velocity.dot(&n);
        Moving {
            position: x.position + (v + a * (0.5 * s)) * s + n * (moved / length),
            velocity: v + a * s + n * (speed / length),
            spin: x.spin.plus(self.grip.torque(&friction, &n).times(s)),
        }
    }
}

impl<const N: usize, S: Turning, E: Effect<N, S>, W: Walls<N>, R: Restitution, G: Grip<N, S>> Automaton
    for Flyer<N, S, E, W, R, G>
{
    type Mode = Stance<N>;
    type State = Moving<N, S>;
    type Edge = Event<N>;

    #[inline]
    fn flow(&self, stance: Stance<N>, t: f64, x: &Moving<N, S>) -> Moving<N, S> {
        self.rate(stance, t, x)
    }

    #[inline]
    fn edges(&self, stance: Stance<N>) -> Edges<'_, Event<N>> {
        self.events(stance)
    }

    #[inline]
    fn guard(&self, event: Event<N>, t: f64, x: &Moving<N, S>) -> f64 {
        match event {
            Event::Meet(face) => self.walls.margin(face, t, &x.position),
            Event::Leave(face) => self.touch(face, t, x).force,
            Event::Stop { face, along } => {
                let (slip, normal) = self.slip(face, t, x);
                forwards(&slip, &along, &normal)
            }
            Event::Slip(face) => self.cone(face, &self.touch(face, t, x)),
            Event::Veer { face, push, since } => {
                let (slip, normal) = self.slip(face, t, x);
                VEERS * push.norm() * (t - since) - forwards(&slip, &push, &normal)
            }
            Event::Change => 1.0, // the clock takes it
            Event::Turn => self.effects.kink(&x.at(t)).unwrap_or(1.0),
        }
    }

    #[inline]
    fn reset(
        &self,
        stance: Stance<N>,
        event: Event<N>,
        t: f64,
        x: &Moving<N, S>,
    ) -> Result<(Stance<N>, Moving<N, S>), Refusal> {
        Ok(match event {
            Event::Meet(face) => match self.walls.leads(face, t, &x.position) {
                Some(cell) => (Stance::Flight { cell }, *x),
                None => self.struck(stance, face, t, x),
            },
            Event::Leave(face) => (Stance::Flight { cell: face.cell }, self.beside(face, t, x)),
            Event::Stop { face, along } => self.stopped(face, &along, t, x),
            Event::Slip(face) => self.slipped(face, t, x),
            Event::Veer { face, .. } => {
                (Stance::Slide { face, along: self.slip(face, t, x).0 }, self.beside(face, t, x))
            }
            Event::Change => match stance {
                Stance::Slide { face, .. } | Stance::Yield { face, .. } | Stance::Hold { face } => {
                    self.changed(stance, face, t, x)
                }
                Stance::Flight { .. } | Stance::Corner { .. } => (stance, *x),
            },
            Event::Turn => (stance, *x),
        })
    }

    #[inline]
    fn about(&self, event: Event<N>) -> About {
        let about = About::new().affine_if(match event {
            Event::Meet(face) | Event::Stop { face, .. } | Event::Veer { face, .. } => self.walls.straight(face),
            Event::Turn => true,
            Event::Leave(_) | Event::Slip(_) | Event::Change => false,
        });
        match event {
            Event::Meet(_) => about,
            Event::Leave(_) | Event::Slip(_) | Event::Stop { .. } | Event::Veer { .. } | Event::Change => {
                about.entry(OF_CONTACT)
            }
            Event::Turn => about.entry(Entry::Wait),
        }
    }

    #[inline]
    fn solution(&self, stance: Stance<N>, t: f64, x: &Moving<N, S>) -> Solution<Self> {
        if self.uniform(stance) {
            let rate = self.rate(stance, t, x);
            let half = Moving { position: rate.velocity * 0.5, velocity: SVector::zeros(), spin: S::NONE };
            Solution::Polynomial([*x, rate, half].into())
        } else if self.ridden(stance).is_some_and(|face| self.walls.carried(face, t, t).is_some()) {
            Solution::Formula(Self::carried)
        } else if self.expanded && matches!(stance, Stance::Flight { .. }) {
            Solution::Series(Self::expand)
        } else {
            Solution::Steps
        }
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(Stance<N>, Moving<N, S>)> {
        Some(self.accumulated(limit.mode, limit.t, limit.x))
    }

    #[inline]
    fn clocks(&self, _: Stance<N>) -> Clocks<'_, Event<N>> {
        // The walls alone decide it: a scene in which none changes has no clock.
        let changing = self.walls.changes(f64::NEG_INFINITY).is_some();
        if changing { Clocks::asked(self, Event::Change) } else { Clocks::none() }
    }
}

/// The changes of the walls' motions.
impl<const N: usize, S: Turning, E: Effect<N, S>, W: Walls<N>, R: Restitution, G: Grip<N, S>> Ticking
    for Flyer<N, S, E, W, R, G>
{
    fn after(&self, t: f64) -> Option<f64> {
        self.walls.changes(t)
    }
}
