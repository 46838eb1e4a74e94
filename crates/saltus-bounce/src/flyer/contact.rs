//! Forces in contact, and what follows from them.

use nalgebra::SVector;

use super::{Flyer, Grip, Moving, Stance, Turning};
use crate::effects::Effect;
use crate::restitution::Restitution;
use crate::walls::{Face, Walls};

/// A slip this much smaller than it began has ended, but for rounding and the tolerance of steps;
/// in space it turns on the way.
const ENDED: f64 = 1e-6;
/// A slip that began along the push has a direction of its own from this share of what the push
/// would have made of it.
pub(super) const VEERS: f64 = 3e-3;
/// The distance from a second wall, relative to the scene's size, within which bounces have
/// accumulated at a corner.
const NEAR: f64 = 1e-9;

/// The forces on a ball in contact.
pub(super) struct Touch<const N: usize, S> {
    pub(super) normal: SVector<f64, N>,
    /// λ in m/s².
    pub(super) force: f64,
    /// The acceleration by the effects.
    pub(super) free: SVector<f64, N>,
    /// The change of spin by the effects.
    pub(super) spin_rate: S,
    /// The change of slip by the effects and by the turning of the normal, without friction.
    pub(super) slip_rate: SVector<f64, N>,
}

/// The tangent (n₁, -n₀) in two coordinates, else zero.
#[inline]
fn tangent<const N: usize>(n: &SVector<f64, N>) -> SVector<f64, N> {
    let mut tangent = SVector::zeros();
    if N == 2 {
        tangent[0] = n[1];
        tangent[1] = -n[0];
    }
    tangent
}

/// Whether there is no slip at all.
#[inline]
pub(super) fn none<const N: usize>(slip: &SVector<f64, N>) -> bool {
    slip.iter().all(|&part| part == 0.0)
}

/// The slip in the form of [`Stance::Slide`].
#[inline]
fn noted<const N: usize>(slip: &SVector<f64, N>, normal: &SVector<f64, N>) -> SVector<f64, N> {
    if N == 2 {
        let mut along = SVector::zeros();
        along[0] = slip.dot(&tangent(normal));
        along
    } else {
        *slip
    }
}

/// The component of `slip` along the slip that was written down, positive until it ends.
#[inline]
pub(super) fn forwards<const N: usize>(
    slip: &SVector<f64, N>,
    along: &SVector<f64, N>,
    normal: &SVector<f64, N>,
) -> f64 {
    if N == 2 { slip.dot(&tangent(normal)) * along[0].signum() } else { slip.dot(along) / along.norm() }
}

impl<const N: usize, S: Turning, E: Effect<N, S>, W: Walls<N>, R: Restitution, G: Grip<N, S>> Flyer<N, S, E, W, R, G> {
    #[inline]
    pub(super) fn touch(&self, face: Face, t: f64, x: &Moving<N, S>) -> Touch<N, S> {
        let gradient = self.walls.gradient(face, t, &x.position);
        let length = gradient.norm();
        let normal = gradient / length;
        let motion = x.at(t);
        let free = self.effects.acceleration(&motion);
        let spin_rate = self.effects.spin_rate(&motion);
        let force = -(self.walls.bend(face, t, &x.position, &x.velocity) + gradient.dot(&free)) / length;
        let mut slip_rate = self.grip.slip(free, spin_rate, &normal);
        if N > 2 && !self.walls.straight(face) {
            let turning = self.grip.slip(SVector::zeros(), x.spin, &(self.turning(face, t, x, &normal) / length));
            slip_rate += turning - normal * turning.dot(&normal);
        }
        Touch { normal, force, free, spin_rate, slip_rate }
    }

    /// The rate at which the gradient of `face` turns on the way of the ball, across the `normal`.
    fn turning(&self, face: Face, t: f64, x: &Moving<N, S>, normal: &SVector<f64, N>) -> SVector<f64, N> {
        // Of vᵀHv + 2v·m + c, a difference in each direction tells Hv + m.
        let size = if x.velocity.norm() > 0.0 { x.velocity.norm() } else { 1.0 };
        let mut change = SVector::<f64, N>::zeros();
        for k in 0..N {
            let mut step = SVector::<f64, N>::zeros();
            step[k] = size;
            let [ahead, behind] = [x.velocity + step, x.velocity - step];
            let bend = |v: &SVector<f64, N>| self.walls.bend(face, t, &x.position, v);
            change[k] = (bend(&ahead) - bend(&behind)) / (4.0 * size);
        }
        change - normal * change.dot(normal)
    }

    /// The unit normal of `face` and its speed along it.
    #[inline]
    pub(crate) fn normal(&self, face: Face, t: f64, x: &Moving<N, S>) -> (SVector<f64, N>, f64) {
        let gradient = self.walls.gradient(face, t, &x.position);
        let length = gradient.norm();
        (gradient / length, -self.walls.rate(face, t, &x.position) / length)
    }

    /// The state with its position put on `face`.
    #[inline]
    pub(crate) fn on(&self, face: Face, t: f64, x: &Moving<N, S>) -> Moving<N, S> {
        let gradient = self.walls.gradient(face, t, &x.position);
        let margin = self.walls.margin(face, t, &x.position);
        Moving { position: x.position - gradient * (margin / gradient.norm_squared()), ..*x }
    }

    /// The state put on `face`, and no longer moving across it.
    pub(super) fn beside(&self, face: Face, t: f64, x: &Moving<N, S>) -> Moving<N, S> {
        let mut x = self.on(face, t, x);
        let (normal, speed) = self.normal(face, t, &x);
        x.velocity += normal * (speed - x.velocity.dot(&normal));
        x
    }

    /// The slip on `face`, none if it is no more than the rounding of its parts.
    #[inline]
    pub(super) fn slip(&self, face: Face, t: f64, x: &Moving<N, S>) -> (SVector<f64, N>, SVector<f64, N>) {
        let (normal, speed) = self.normal(face, t, x);
        let relative = x.velocity - normal * speed;
        let along = self.grip.slip(relative, S::NONE, &normal);
        let slip = self.grip.slip(relative, x.spin, &normal);
        let rounding = 64.0 * f64::EPSILON * (along.norm() + (slip - along).norm());
        (if slip.norm() <= rounding { SVector::zeros() } else { slip }, normal)
    }

    /// The state put on `face`, where it neither moves across it nor slips.
    fn held(&self, face: Face, t: f64, x: &Moving<N, S>) -> Moving<N, S> {
        let mut x = self.beside(face, t, x);
        let (slip, normal) = self.slip(face, t, &x);
        let taken = slip * -self.grip.share();
        x.velocity += taken;
        x.spin = x.spin.plus(self.grip.torque(&taken, &normal));
        x
    }

    /// Friction per mass.
    #[inline]
    pub(super) fn friction(&self, stance: Stance<N>, touch: &Touch<N, S>, slip: &SVector<f64, N>) -> SVector<f64, N> {
        match stance {
            Stance::Hold { .. } => touch.slip_rate * -self.grip.share(),
            Stance::Slide { face, along } if !none(&along) => {
                let direction = if N == 2 {
                    tangent(&touch.normal) * along[0].signum()
                } else {
                    // Past its end a slip goes on as it was, so that a step may look there.
                    let slip = if slip.dot(&along) > 0.0 { *slip } else { along };
                    slip / slip.norm()
                };
                direction * (-self.grip.on(face).coefficient() * touch.force)
            }
            _ => SVector::zeros(),
        }
    }

    /// Friction per mass on a slip that has only begun, in space.
    ///
    /// Of s' = p - c s/|s| the direction is as stiff as |p|/|s|, and drawn to that of p. It lies
    /// behind it by c|s|/|p|² times its turning, to second order in s and |p| - c: that is what
    /// friction is against here, and |s| is all that is left to find.
    pub(super) fn yielding(
        &self,
        face: Face,
        since: f64,
        t: f64,
        x: &Moving<N, S>,
        touch: &Touch<N, S>,
    ) -> SVector<f64, N> {
        let most = self.grip.on(face).coefficient() * touch.force;
        let towards = |touch: &Touch<N, S>| {
            let size = touch.slip_rate.norm();
            if size > 0.0 { touch.slip_rate / size } else { SVector::zeros() }
        };
        let push = towards(touch);
        let against = push * -most;
        let slip = self.slip(face, t, x).0.dot(&push);
        // No look ahead: the motion of walls may change there.
        let h = 0.125 * (t - since);
        if slip == 0.0 || h <= 0.0 {
            return against;
        }
        let velocity = touch.free + touch.normal * touch.force + against;
        let spin = touch.spin_rate.plus(self.grip.torque(&against, &touch.normal));
        let before = |h: f64| {
            let back = Moving {
                position: x.position - x.velocity * h,
                velocity: x.velocity - velocity * h,
                spin: x.spin.plus(spin.times(-h)),
            };
            towards(&self.touch(face, t - h, &back))
        };
        let turning = (push * 3.0 - before(h) * 4.0 + before(2.0 * h)) / (2.0 * h);
        let lag = most / self.grip.share() * slip / touch.slip_rate.norm_squared();
        let behind = push - turning * lag;
        behind * (-most / behind.norm())
    }

    /// The margin of friction before it gives way: μ²λ|λ| - |f|².
    #[inline]
    pub(super) fn cone(&self, face: Face, touch: &Touch<N, S>) -> f64 {
        let mu = self.grip.on(face).coefficient();
        let needed = self.grip.share() * self.grip.share() * touch.slip_rate.norm_squared();
        mu * mu * touch.force * touch.force.abs() - needed
    }

    /// A ball on `face` that does not rebound: in contact, or at once in flight if nothing presses
    /// it.
    pub(crate) fn settled(&self, face: Face, t: f64, x: Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        let x = self.beside(face, t, &x);
        let touch = self.touch(face, t, &x);
        if touch.force < 0.0 {
            return (Stance::Flight { cell: face.cell }, x);
        }
        if self.grip.on(face).coefficient() == 0.0 {
            return (Stance::Slide { face, along: SVector::zeros() }, x);
        }
        let (slip, normal) = self.slip(face, t, &x);
        let along = noted(&slip, &normal);
        (if none(&along) { self.without_slip(face, t, &touch) } else { Stance::Slide { face, along } }, x)
    }

    /// Friction holds it, or it begins to slide.
    fn without_slip(&self, face: Face, t: f64, touch: &Touch<N, S>) -> Stance<N> {
        if self.cone(face, touch) >= 0.0 { Stance::Hold { face } } else { self.slipping(face, t, touch) }
    }

    /// Friction has given way: what it could not hold slips the way it is pushed.
    ///
    /// In space that direction is stiff while the slip is small: see [`Self::yielding`].
    fn slipping(&self, face: Face, t: f64, touch: &Touch<N, S>) -> Stance<N> {
        let push = touch.slip_rate;
        let held = self.grip.on(face).coefficient() * touch.force / self.grip.share();
        if N > 2 && push.norm() - held < VEERS * push.norm() {
            Stance::Yield { face, push, since: t }
        } else {
            Stance::Slide { face, along: noted(&push, &touch.normal) }
        }
    }

    /// Friction gives way.
    pub(super) fn slipped(&self, face: Face, t: f64, x: &Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        let x = self.held(face, t, x);
        (self.slipping(face, t, &self.touch(face, t, &x)), x)
    }

    /// The slip has no component left along what it was: it goes on another way, or has ended but
    /// for rounding, which friction takes.
    pub(super) fn stopped(
        &self,
        face: Face,
        along: &SVector<f64, N>,
        t: f64,
        x: &Moving<N, S>,
    ) -> (Stance<N>, Moving<N, S>) {
        let (slip, normal) = self.slip(face, t, x);
        // A slip that ends while it is still along what it was is no more than the rounding of its
        // guard: it would have no end any more.
        let turned = 2.0 * forwards(&slip, along, &normal) < slip.norm();
        if N > 2 && turned && slip.norm() > ENDED * along.norm() {
            return (Stance::Slide { face, along: noted(&slip, &normal) }, self.beside(face, t, x));
        }
        let x = self.held(face, t, x);
        (self.without_slip(face, t, &self.touch(face, t, &x)), x)
    }

    /// An impact on `face`, from flight or from contact with other faces.
    pub(super) fn struck(&self, from: Stance<N>, face: Face, t: f64, x: &Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        let faces = self.walls.faces(face.cell);
        let held = (0..faces).filter(|&index| from.touches(index) && index != face.index);
        // What it was in contact with, it may leave: from where it is, without the rounding of the
        // way along it.
        let x = held.clone().fold(*x, |x, index| self.on(Face { index, ..face }, t, &x));
        let mut x = self.on(face, t, &x);
        let (normal, speed) = self.normal(face, t, &x);
        let relative = x.velocity - normal * speed;
        let law = self.restitution.on(face);
        let after = self.grip.on(face).impact(&law, relative, x.spin, &normal);
        (x.velocity, x.spin) = (after.velocity + normal * speed, after.spin);
        let rebounds = law.rebound((-relative.dot(&normal)).max(0.0)) > 0.0;
        let stays = |index: usize, x: &Moving<N, S>| {
            let (normal, speed) = self.normal(Face { index, ..face }, t, x);
            (x.velocity.dot(&normal) - speed).abs() <= 8.0 * f64::EPSILON * (relative.norm() + speed.abs())
        };
        let mask = held.filter(|&index| stays(index, &x)).fold(0, |mask, index| mask | 1 << index);
        match (mask, rebounds) {
            (0, true) => (Stance::Flight { cell: face.cell }, x),
            (0, false) => self.settled(face, t, x),
            (mask, true) => self.among(face.cell, mask, t, x),
            (mask, false) => self.among(face.cell, mask | 1 << face.index, t, x),
        }
    }

    /// The wall that carries the ball has changed its motion: if its velocity jumped, it strikes
    /// the ball or leaves it behind.
    pub(super) fn changed(&self, from: Stance<N>, face: Face, t: f64, x: &Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        let (normal, speed) = self.normal(face, t, x);
        let parting = x.velocity.dot(&normal) - speed;
        // A schedule without jumps of velocity leaves roundings.
        if parting.abs() <= 1e-12 * (speed.abs() + x.velocity.norm()) {
            self.settled(face, t, *x)
        } else if parting < 0.0 {
            self.struck(from, face, t, x)
        } else {
            (Stance::Flight { cell: face.cell }, *x)
        }
    }

    /// Bounces have accumulated: on one face, or where several meet.
    pub(crate) fn accumulated(&self, from: Stance<N>, t: f64, x: &Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        let cell = from.cell();
        let distance = |index: usize| self.distance(Face { cell, index }, t, x);
        let free = (0..self.walls.faces(cell)).filter(|&index| !from.touches(index));
        let Some(nearest) = free.min_by(|&a, &b| distance(a).total_cmp(&distance(b))) else { return (from, *x) };
        let size = NEAR * (1.0 + x.position.norm());
        let meets = |index: usize| {
            let stands = || self.stands(Face { cell, index }, t, x);
            index == nearest || from.touches(index) || distance(index) <= size && stands()
        };
        let mask = (0..self.walls.faces(cell)).filter(|&index| meets(index)).fold(0, |mask, index| mask | 1 << index);
        self.among(cell, mask, t, *x)
    }

    /// Whether the ball is so near to a face that it does not touch, and so slow there, that its
    /// bounces may have accumulated.
    pub(crate) fn ends_on_a_face(&self, from: Stance<N>, t: f64, x: &Moving<N, S>) -> bool {
        let cell = from.cell();
        let mut free =
            (0..self.walls.faces(cell)).filter(|&index| !from.touches(index)).map(|index| Face { cell, index });
        let near = 100.0 * NEAR * (1.0 + x.position.norm());
        free.any(|face| self.distance(face, t, x) <= near && self.stands(face, t, x))
    }

    /// The distance of the ball from `face`; infinite where that is no wall.
    fn distance(&self, face: Face, t: f64, x: &Moving<N, S>) -> f64 {
        let length = self.walls.gradient(face, t, &x.position).norm();
        let wall = length > 0.0 && self.walls.leads(face, t, &x.position).is_none();
        if wall { self.walls.margin(face, t, &x.position).abs() / length } else { f64::INFINITY }
    }

    /// Whether it neither leaves nor approaches `face`, to the accuracy of bounces that accumulate.
    fn stands(&self, face: Face, t: f64, x: &Moving<N, S>) -> bool {
        let (normal, speed) = self.normal(face, t, x);
        (x.velocity.dot(&normal) - speed).abs() <= NEAR.sqrt()
    }

    /// The stance and state of a ball in contact with the faces of a mask.
    fn among(&self, cell: usize, faces: u16, t: f64, mut x: Moving<N, S>) -> (Stance<N>, Moving<N, S>) {
        let nearest = Face { cell, index: faces.trailing_zeros() as usize };
        let of_mask = |index: &usize| faces >> index & 1 == 1;
        let all = (0..self.walls.faces(cell)).filter(of_mask);
        if faces.count_ones() == 1 || all.clone().any(|index| !self.walls.straight(Face { cell, index })) {
            return self.settled(nearest, t, x);
        }
        for index in all {
            x = self.on(Face { cell, index }, t, &x);
        }
        x.velocity = self.within(cell, faces, t, &x, x.velocity);
        (Stance::Corner { cell, faces }, x)
    }

    /// The part of `v` along all the faces of a mask.
    pub(super) fn within(
        &self,
        cell: usize,
        faces: u16,
        t: f64,
        x: &Moving<N, S>,
        v: SVector<f64, N>,
    ) -> SVector<f64, N> {
        let mut v = v;
        let mut directions = [SVector::<f64, N>::zeros(); N];
        let mut count = 0;
        for index in (0..self.walls.faces(cell)).filter(|index| faces >> index & 1 == 1) {
            let mut n = self.walls.gradient(Face { cell, index }, t, &x.position);
            let before = n.norm();
            for d in &directions[..count] {
                n -= d * n.dot(d);
            }
            if count < N && n.norm() > 1e-12 * before {
                directions[count] = n / n.norm();
                v -= directions[count] * v.dot(&directions[count]);
                count += 1;
            }
        }
        if count == N { SVector::zeros() } else { v }
    }
}
