//! Balls that meet, and what becomes of those that lie.

use nalgebra::Vector3;
use saltus::Automaton;

use super::{Flock, Flying};
use crate::effects::Effect;
use crate::flyer::{Flyer, Grip, Moving, Stance};
use crate::restitution::{Cor, Restitution};
use crate::walls::{Face, Walls};

/// How close two balls are, relative to the scene's size, whose bounces have accumulated.
const NEAR: f64 = 1e-7;
/// And how slowly they approach, in m/s.
const SLOW: f64 = 3e-5;
/// How strong a pull, in m/s², is more than rounding and steps leave.
const PULL: f64 = 1e-9;
/// How far from each other two things that touch may be for rounding, relative to the scene's size;
/// and how far inside each other what approaches is put after a jump, so that the next one is due
/// beyond doubt: several edges fall at one time here, and a root that has just been taken counts as
/// spent.
const TOUCHES: f64 = 32.0 * f64::EPSILON;
/// How often a place is put right for its rounding.
const MOST_MOVES: usize = 4;

type Ball = Moving<3, Vector3<f64>>;

impl<E, W, R, G> Flyer<3, Vector3<f64>, E, W, R, G>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
{
    /// How fast it parts from `face`, and beside what speeds.
    fn parting(&self, face: Face, t: f64, x: &Ball) -> (f64, f64) {
        let (normal, speed) = self.normal(face, t, x);
        (x.velocity.dot(&normal) - speed, x.velocity.norm() + speed.abs())
    }

    /// Beside `face` and not inside, for all that rounding says.
    pub(super) fn outside(&self, face: Face, t: f64, x: &Ball) -> Ball {
        self.beyond_rounding(face, t, x, 0.0, |margin| margin >= 0.0)
    }

    /// Moved across `face` until its margin `is` as wanted: by roundings only.
    fn beyond_rounding(&self, face: Face, t: f64, x: &Ball, to: f64, is: impl Fn(f64) -> bool) -> Ball {
        let mut x = *x;
        for _ in 0..MOST_MOVES {
            let margin = self.walls().margin(face, t, &x.position);
            if is(margin) {
                break;
            }
            let gradient = self.walls().gradient(face, t, &x.position);
            let by = to - if to < 0.0 { margin } else { 2.0 * margin };
            x.position = moved(&x.position, &(gradient * (by / gradient.norm_squared())));
        }
        x
    }

    /// In flight beside faces that it is on but for rounding: inside those that it approaches, so
    /// that it meets them at once, outside others.
    pub(super) fn sided(&self, cell: usize, t: f64, x: &Ball) -> Ball {
        let mut x = *x;
        for face in (0..self.walls().faces(cell)).map(|index| Face { cell, index }) {
            let margin = self.walls().margin(face, t, &x.position);
            let length = self.walls().gradient(face, t, &x.position).norm();
            let wall = length > 0.0 && self.walls().leads(face, t, &x.position).is_none();
            let size = TOUCHES * (1.0 + x.position.norm()) * length;
            if wall && margin.abs() <= size {
                let parting = self.parting(face, t, &x).0;
                if parting < 0.0 {
                    x = self.beyond_rounding(face, t, &x, -2.0 * size, |margin| margin <= -size);
                } else if parting > 0.0 {
                    x = self.outside(face, t, &x);
                }
            }
        }
        x
    }

    /// What a ball does whose velocity another has changed: it goes on lying where it neither
    /// leaves nor is pressed in.
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
                let x = faces.fold(*x, |x, face| self.outside(face, t, &self.on(face, t, &x)));
                (Stance::Flight { cell }, x)
            }
            Stance::Slide { face, .. } | Stance::Yield { face, .. } | Stance::Hold { face } => {
                self.settled(face, t, *x)
            }
            Stance::Corner { .. } => (stance, *x),
        }
    }
}

/// p + `by`, each coordinate at least to the next number that way.
fn moved(p: &Vector3<f64>, by: &Vector3<f64>) -> Vector3<f64> {
    p.zip_map(by, |p, by| match p + by {
        same if by > 0.0 && same == p => p.next_up(),
        same if by < 0.0 && same == p => p.next_down(),
        moved => moved,
    })
}

impl<const N: usize, E, W, R, G, C> Flock<N, E, W, R, G, C>
where
    E: Effect<3, Vector3<f64>>,
    W: Walls<3>,
    R: Restitution,
    G: Grip<3, Vector3<f64>>,
    C: Restitution,
{
    /// From centre to centre, and by how much the velocity of the second exceeds that of the first.
    pub(super) fn apart(&self, i: usize, j: usize, x: &Flying<N>) -> (Vector3<f64>, Vector3<f64>) {
        let (a, b) = (x.ball(i), x.ball(j));
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
        let (between, change) = self.apart(i, j, x);
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
        self.parted(i, j, after)
    }

    /// Two balls that touch, not overlapping by their rounding.
    fn parted(&self, i: usize, j: usize, x: Flying<N>) -> Flying<N> {
        self.moved_until(i, j, x, 0.0, |gap| gap >= 0.0)
    }

    /// How far two balls are from touching; negative where they overlap.
    pub(super) fn gap(&self, i: usize, j: usize, x: &Flying<N>) -> f64 {
        self.apart(i, j, x).0.norm() - self.reach(i, j)
    }

    /// One of two balls moved towards or from the other until the gap `is` as wanted, by roundings
    /// only. What lies stays where it is, if it can.
    fn moved_until(&self, i: usize, j: usize, mut x: Flying<N>, to: f64, is: impl Fn(f64) -> bool) -> Flying<N> {
        let flies = |ball: usize| matches!(x.stances().of(ball), Stance::Flight { .. });
        let (ball, side) = if flies(j) || !flies(i) { (j, 1.0) } else { (i, -1.0) };
        for _ in 0..MOST_MOVES {
            let (between, _) = self.apart(i, j, &x);
            let distance = between.norm();
            let gap = distance - self.reach(i, j);
            if is(gap) || distance == 0.0 {
                break;
            }
            let mut moving = x.ball(ball);
            let by = to - if to < 0.0 { gap } else { 2.0 * gap };
            moving.position = moved(&moving.position, &(between * (side * by / distance)));
            x.put(ball, x.stances().of(ball), moving);
        }
        x
    }

    /// How fast two balls part.
    fn rate(&self, i: usize, j: usize, x: &Flying<N>) -> f64 {
        let (between, change) = self.apart(i, j, x);
        change.dot(&between) / between.norm()
    }

    /// How fast that changes.
    fn bend(&self, i: usize, j: usize, t: f64, x: &Flying<N>) -> f64 {
        let (between, change) = self.apart(i, j, x);
        let (distance, rate) = (between.norm(), self.rate(i, j, x));
        let pull = self.flow(x.stances(), t, x);
        let pull = (pull.ball(j).velocity - pull.ball(i).velocity).dot(&between) / distance;
        pull + (change.norm_squared() - rate * rate) / distance
    }

    /// Whether two balls that touch are pressed together, and part so slowly that no number tells
    /// how far they get.
    fn lies_upon(&self, i: usize, j: usize, t: f64, x: &Flying<N>, rate: f64) -> bool {
        let bend = self.bend(i, j, t, x);
        bend < -PULL && rate * rate <= -2.0 * bend * TOUCHES * (1.0 + x.ball(i).position.norm())
    }

    /// After a jump: what touches but for rounding is put on the side that its velocity tells, so
    /// that what approaches meets at once.
    pub(super) fn sided(&self, t: f64, mut x: Flying<N>) -> Flying<N> {
        let count = self.balls.len();
        for (ball, (_, flyer)) in self.balls.iter().enumerate() {
            if let stance @ Stance::Flight { cell } = x.stances().of(ball) {
                let moving = flyer.sided(cell, t, &x.ball(ball));
                x.put(ball, stance, moving);
            }
        }
        for (i, j) in (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j))) {
            let size = TOUCHES * (1.0 + x.ball(i).position.norm());
            if self.gap(i, j, &x).abs() <= size {
                let rate = self.rate(i, j, &x);
                if rate < 0.0 || self.lies_upon(i, j, t, &x, rate) {
                    x = self.moved_until(i, j, x, -2.0 * size, |gap| gap <= -size);
                } else if rate > 0.0 {
                    x = self.parted(i, j, x);
                }
            }
        }
        x
    }

    /// What lies beyond infinitely many impacts: what bounced on a wall lies there; two balls that
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
            let rate = self.rate(i, j, &after);
            if self.gap(i, j, &after).abs() <= NEAR * (1.0 + after.ball(i).position.norm()) && rate.abs() <= SLOW {
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
