//! Squash and stretch: the form of a ball, of one volume always.

use crate::motion::{Contact, Motion, MotionError, Piece, Point, Stretch, Track, UP, dot, norm};
use crate::rate::Frames;

/// The amounts of squash and stretch of a ball.
///
/// A ball that is 1 + a as long along one axis is 1/√(1 + a) as wide across it, so that its volume
/// stays. In flight the axis is that of the velocity, and a = `stretch` · (speed/greatest speed)²,
/// which comes and goes within a drawing of a contact: at touch the ball is round. In contact the
/// axis is the normal of what is met. A contact that takes time squashes as its law has it, by a
/// multiple that makes the greatest deformation `squash`; one that is held squashes by a =
/// -`squash` · (speed/fastest impact) · 4u(1 - u), where u goes from 0 to 1 while it is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shape {
    /// The part by which the ball is shorter at its greatest squash: from 0 to 0.9.
    pub squash: f64,
    /// The part by which the ball is longer at the greatest speed: from 0 to 2.
    pub stretch: f64,
    /// The time for which a contact is held, in s, as by [`Motion::held`].
    pub hold: f64,
}

impl Shape {
    /// The error of a shape, in words.
    pub(crate) fn check(&self) -> Result<(), String> {
        match self {
            Self { squash, .. } if !(0.0..=0.9).contains(squash) => {
                Err(format!("the ball cannot lose {squash} of its height: squash it by 0 to 0.9"))
            }
            Self { stretch, .. } if !(0.0..=2.0).contains(stretch) => {
                Err(format!("the ball cannot be {stretch} of its length longer: stretch it by 0 to 2"))
            }
            Self { hold, .. } if !(hold.is_finite() && *hold >= 0.0) => {
                Err(format!("a contact cannot be held for {hold} s"))
            }
            _ => Ok(()),
        }
    }
}

/// The form of a ball at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The vector from the point that [`Track::at`] gives to the centre that is shown, in m.
    pub offset: Point,
    /// The axis of squash or stretch, of length 1.
    pub axis: Point,
    /// The length along the axis, as a part of that of a round ball; across, it is 1/√ of that.
    pub along: f64,
}

/// Squash and stretch of one motion: [`Motion::form`].
#[derive(Clone, Copy, Debug)]
pub struct Form {
    shape: Shape,
    /// The time in which a stretch comes and goes, in s.
    ramp: f64,
    /// The greatest speed in flight and the fastest impact of an instant, in m/s.
    fastest: [f64; 2],
    /// The greatest deformation of a contact that takes time, of the ball's radius.
    deepest: f64,
    /// Whether the first stretch comes after the last.
    loops: bool,
}

/// The deformation of a contact that takes time, in m.
fn depth(stretch: &Stretch, contact: &Contact, t: f64) -> f64 {
    let (touch, place) = (stretch.at(stretch.start()), stretch.at(t));
    dot(&contact.normal, &std::array::from_fn(|axis| touch[axis] - place[axis]))
}

/// Points in which a polynomial is looked at for its greatest value.
fn looks(piece: &Piece) -> impl Iterator<Item = f64> {
    const POINTS: u32 = 32;
    let (start, span) = (piece.start, piece.span);
    (0..=POINTS).map(move |k| start + span * f64::from(k) / f64::from(POINTS))
}

impl Motion {
    /// The greatest deformation of a contact that takes time, by its law, as a part of the ball's
    /// radius; 0 where every contact is an instant.
    #[must_use]
    pub fn deformation(&self) -> f64 {
        let of = |track: &Track| {
            let pressed = track.stretches.iter().filter_map(|stretch| {
                let contact = stretch.contact.filter(|contact| contact.pressed)?;
                let depths = stretch.pieces.iter().flat_map(looks).map(|t| depth(stretch, &contact, t));
                Some(depths.fold(0.0, f64::max))
            });
            pressed.fold(0.0, f64::max) / track.radius
        };
        self.tracks.iter().map(of).fold(0.0, f64::max)
    }

    /// Makes every contact last `hold` in s at least: one of an instant as a pause, with the ball
    /// where it touches; one that takes time by slowing it down. What comes after is as much later.
    /// A ball that stays where it lands is not held.
    ///
    /// # Errors
    /// [`MotionError`] with several balls: they would not meet any more.
    pub fn held(&self, hold: f64) -> Result<Self, MotionError> {
        let [track] = &self.tracks[..] else {
            let says = "several balls cannot wait for each other on the floor: only one ball can be held, and squashed in impacts of an instant";
            return Err(MotionError(says.to_owned()));
        };
        let mut stretches: Vec<Stretch> = Vec::with_capacity(2 * track.stretches.len());
        let mut now = 0.0;
        for stretch in &track.stretches {
            let mut stretch = stretch.clone();
            if let Some(contact) = stretch.contact.filter(|_| stretch.flight) {
                let coefficients = vec![stretch.at(stretch.start())];
                let pause = Piece { start: now, span: hold, coefficients, spin: Vec::new() };
                stretches.push(Stretch { contact: Some(contact), flight: false, pieces: vec![pause] });
                stretch.contact = None;
                now += hold;
            }
            let pressed = stretch.contact.is_some_and(|contact| contact.pressed);
            let factor = if pressed { (hold / stretch.span()).max(1.0) } else { 1.0 };
            for piece in &mut stretch.pieces {
                *piece = piece.slowed(factor, now);
                now += piece.span;
            }
            stretches.push(stretch);
        }
        Ok(Self { tracks: vec![Track { stretches, ..track.clone() }], ..self.clone() })
    }

    /// The squash and stretch of this motion.
    #[must_use]
    pub fn form(&self, shape: Shape, frames: Frames) -> Form {
        let stretches = || self.tracks.iter().flat_map(|track| &track.stretches);
        let speeds = stretches().filter(|stretch| stretch.flight).flat_map(|stretch| {
            stretch.pieces.iter().flat_map(looks).map(|t| norm(&stretch.slope(t))).collect::<Vec<f64>>()
        });
        let impacts = stretches().filter_map(|stretch| stretch.contact).filter(|contact| !contact.pressed);
        let fastest = [speeds.fold(0.0, f64::max), impacts.map(|contact| contact.speed).fold(0.0, f64::max)];
        Form { shape, ramp: frames.step(), fastest, deepest: self.deformation(), loops: self.loops }
    }
}

impl Form {
    /// The form of a ball in a stretch of its motion, by index, at `t` in s.
    #[must_use]
    pub fn pose(&self, track: &Track, index: usize, t: f64) -> Pose {
        let (r, stretch) = (track.radius, &track.stretches[index]);
        let round = Pose { offset: UP.map(|c| c * r), axis: UP, along: 1.0 };
        match stretch.contact.filter(|_| !stretch.flight) {
            None if stretch.flight => {
                let v = stretch.slope(t);
                let speed = norm(&v);
                let share = if self.fastest[0] > 0.0 { (speed / self.fastest[0]).powi(2) } else { 0.0 };
                let along = 1.0 + self.shape.stretch * share * self.risen(track, index, t);
                let axis = if speed > 0.0 { v.map(|c| c / speed) } else { UP };
                // The lowest point stays where it is.
                Pose { offset: UP.map(|c| c * r * support(along, axis[2])), axis, along }
            }
            None => round,
            Some(contact) => {
                let normal = contact.normal;
                let (deep, along) = if contact.pressed {
                    let deep = depth(stretch, &contact, t) / r;
                    (deep, 1.0 - if self.deepest > 0.0 { self.shape.squash / self.deepest } else { 0.0 } * deep)
                } else {
                    let hard = if self.fastest[1] > 0.0 { contact.speed / self.fastest[1] } else { 0.0 };
                    let held = self.shape.hold.min(stretch.span());
                    let u = if held > 0.0 { ((t - stretch.start()) / held).clamp(0.0, 1.0) } else { 0.0 };
                    (0.0, 1.0 - self.shape.squash * hard * 4.0 * u * (1.0 - u))
                };
                // A contact pulls its law's deformation a little above zero where it parts.
                let along = along.max(0.1);
                let centre = |axis: usize| r * (round.axis[axis] + (deep + along - 1.0) * normal[axis]);
                Pose { offset: std::array::from_fn(centre), axis: normal, along }
            }
        }
    }

    /// The part of the stretch, from 0 at a contact to 1 a drawing away from it.
    fn risen(&self, track: &Track, index: usize, t: f64) -> f64 {
        let [after, before] = self.touches(track, index);
        let away = |touch: Option<f64>| touch.map_or(f64::INFINITY, |touch| (t - touch).abs() / self.ramp);
        away(after).min(away(before)).min(1.0)
    }

    /// The times at which a flight starts and ends in a contact, in s.
    fn touches(&self, track: &Track, index: usize) -> [Option<f64>; 2] {
        let stretch = &track.stretches[index];
        let before = index.checked_sub(1).and_then(|before| track.stretches.get(before));
        let after = track.stretches.get(index + 1).or_else(|| track.stretches.first().filter(|_| self.loops));
        let starts = stretch.contact.is_some() || before.is_some_and(|before| !before.flight);
        let ends = after.is_some_and(|after| after.contact.is_some() || !after.flight);
        [starts.then(|| stretch.start()), ends.then(|| stretch.end())]
    }

    /// The spans in which the form of a ball changes smoothly: their ends in s, of a stretch by
    /// index.
    pub(crate) fn smooth(&self, track: &Track, index: usize) -> Vec<f64> {
        let stretch = &track.stretches[index];
        let (start, end) = (stretch.start(), stretch.end());
        let mut times = vec![start, end];
        if stretch.flight && self.shape.stretch > 0.0 {
            let [after, before] = self.touches(track, index);
            let half = if after.is_some() && before.is_some() { 0.5 } else { 1.0 };
            let ramp = self.ramp.min(half * (end - start));
            times.extend(after.map(|t| t + ramp));
            times.extend(before.map(|t| t - ramp));
        } else if stretch.contact.is_some_and(|contact| !contact.pressed) && self.shape.squash > 0.0 {
            times.push(start + self.shape.hold.min(end - start));
        }
        times.sort_by(f64::total_cmp);
        times.dedup_by(|b, a| *b - *a < 1e-9 * b.max(1.0));
        times
    }
}

/// The reach of an ellipsoid of semi-axes `along` and 1/√`along` in a direction of which `cos` is
/// the part along the axis.
pub(crate) fn support(along: f64, cos: f64) -> f64 {
    ((along * cos).powi(2) + (1.0 - cos * cos).max(0.0) / along).sqrt()
}
