//! Balls that meet, and what becomes of those that lie.

use nalgebra::Vector3;
use saltus::Automaton;

use super::{Flock, Flying};
use crate::effects::Effect;
use crate::flyer::{Flyer, Grip, Moving, Stance};
use crate::restitution::{Cor, Restitution};
use crate::walls::{Face, Walls};

/// The distance of two balls, relative to the scene's size, within which bounces have accumulated.
const NEAR: f64 = 1e-7;
/// The speed of approach in m/s within which bounces have accumulated.
const SLOW: f64 = 3e-5;
/// The least pull, in m/s², that is more than rounding and the error of steps.
const PULL: f64 = 1e-9;

type Ball = Moving<3, Vector3<f64>>;

impl<E, W, R, G> Flyer<3, Vector3<f64>, E, W, R, G>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
{
    /// The speed at which it parts from `face`, and the size of the two speeds of which that is the
    /// difference.
    fn parting(&self, face: Face, t: f64, x: &Ball) -> (f64, f64) {
        let (normal, speed) = self.normal(face, t, x);
        (x.velocity.dot(&normal) - speed, x.velocity.norm() + speed.abs())
    }

    /// The stance and state of a ball whose velocity another has changed: it goes on lying where it
    /// neither leaves nor is pressed in.
    pub(super) fn pushed(&self, stance: Stance<3>, t: f64, x: &Ball) -> (Stance<3>, Ball) {
        let cell = stance.cell();
        let faces = (0..self.walls().faces(cell)).filter(|&index| stance.touches(index));
        let faces = faces.map(|index| Face { cell, index });
        let stays = |face: Face| {
            let (parting, size) = self.parting(face, t, x);
            parting.abs() <= 8.0 * f64::EPSILON * size
        };
        match stance {
            Stance::Flight { .. } => (stance, *x),
            _ if !faces.clone().all(stays) => {
                let x = faces.fold(*x, |x, face| self.on(face, t, &x));
                (Stance::Flight { cell }, x)
            }
            Stance::Slide { face, .. } | Stance::Yield { face, .. } | Stance::Hold { face } => {
                self.settled(face, t, *x)
            }
            Stance::Corner { .. } => (stance, *x),
        }
    }
}

impl<const N: usize, E, W, R, G, C> Flock<N, E, W, R, G, C>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
    C: Restitution,
{
    /// A ball as it is met: on the face that it is in contact with, from which steps let it drift.
    fn met(&self, ball: usize, t: f64, x: &Flying<N>) -> Ball {
        let moving = x.ball(ball);
        match x.stances().of(ball) {
            Stance::Slide { face, .. } | Stance::Yield { face, .. } | Stance::Hold { face } => {
                self.balls[ball].1.on(face, t, &moving)
            }
            Stance::Flight { .. } | Stance::Corner { .. } => moving,
        }
    }

    /// The vector from centre to centre, and the velocity of the second relative to the first.
    pub(super) fn apart(&self, i: usize, j: usize, t: f64, x: &Flying<N>) -> (Vector3<f64>, Vector3<f64>) {
        let (a, b) = (self.met(i, t, x), self.met(j, t, x));
        let mut between = b.position - a.position;
        between[2] += self.balls[j].0.radius() - self.balls[i].0.radius();
        (between, b.velocity - a.velocity)
    }

    pub(super) fn reach(&self, i: usize, j: usize) -> f64 {
        self.balls[i].0.radius() + self.balls[j].0.radius()
    }

    /// Two balls have met.
    pub(super) fn collided(
        &self,
        i: usize,
        j: usize,
        restitution: &impl Restitution,
        t: f64,
        x: &Flying<N>,
    ) -> Flying<N> {
        let (between, change) = self.apart(i, j, t, x);
        let distance = between.norm();
        let mut after = *x;
        if distance == 0.0 {
            return after;
        }
        let normal = between / distance;
        if change.dot(&normal) < 0.0 {
            let balls = [i, j].map(|ball| x.ball(ball));
            let hit = self.friction.collision(
                [&self.balls[i].0, &self.balls[j].0],
                restitution,
                balls.map(|ball| ball.velocity),
                balls.map(|ball| ball.spin),
                normal,
            );
            for ((ball, before), hit) in [i, j].into_iter().zip(balls).zip(hit) {
                let moving = Moving { velocity: hit.velocity, spin: hit.spin, ..before };
                let (stance, moving) = self.balls[ball].1.pushed(x.stances().of(ball), t, &moving);
                after.put(ball, stance, moving);
            }
        }
        after
    }

    /// The gap of two balls, larger than the distance where they are far apart: (r² - R²) / 2R,
    /// with r from centre to centre and the sum R of the radii. Negative where they overlap;
    /// without a kink where the centres would pass each other.
    pub(super) fn gap(&self, i: usize, j: usize, t: f64, x: &Flying<N>) -> f64 {
        let (distance, reach) = (self.apart(i, j, t, x).0.norm(), self.reach(i, j));
        (distance - reach) * (0.5 * (distance + reach) / reach)
    }

    /// The rate of the gap.
    fn rate(&self, i: usize, j: usize, t: f64, x: &Flying<N>) -> f64 {
        let (between, change) = self.apart(i, j, t, x);
        change.dot(&between) / between.norm()
    }

    /// The second derivative of the gap.
    fn bend(&self, i: usize, j: usize, t: f64, x: &Flying<N>) -> f64 {
        let (between, change) = self.apart(i, j, t, x);
        let (distance, rate) = (between.norm(), self.rate(i, j, t, x));
        let pull = self.flow(x.stances(), t, x);
        let pull = (pull.ball(j).velocity - pull.ball(i).velocity).dot(&between) / distance;
        pull + (change.norm_squared() - rate * rate) / distance
    }

    /// The state beyond infinitely many impacts: what bounced on a wall lies there; two balls that
    /// nothing presses together part.
    pub(super) fn accumulated(&self, t: f64, x: &Flying<N>) -> Option<Flying<N>> {
        let count = self.balls.len();
        let mut after = *x;
        let mut any = false;
        for ball in 0..count {
            let (stance, flyer) = (x.stances().of(ball), &self.balls[ball].1);
            if flyer.ends_on_a_face(stance, t, &x.ball(ball)) {
                let (stance, moving) = flyer.accumulated(stance, t, &x.ball(ball));
                after.put(ball, stance, moving);
                any = true;
            }
        }
        let inelastic = Cor::new(0.0).ok()?;
        for (i, j) in (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j))) {
            let rate = self.rate(i, j, t, &after);
            if self.gap(i, j, t, &after).abs() <= NEAR * (1.0 + after.ball(i).position.norm()) && rate.abs() <= SLOW {
                if self.bend(i, j, t, &after) < -PULL {
                    return None;
                }
                any |= rate < 0.0;
                after = self.collided(i, j, &inelastic, t, &after);
            }
        }
        any.then_some(after)
    }
}
