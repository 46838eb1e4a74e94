//! How a picture departs from the motion it shows: bounds, not samples.

use crate::bound::most;
use crate::curve::{Between, Curve};
use crate::dress::Dress;
use crate::ease::extremes;
use crate::motion::{Piece, Point, Stretch, Track, UP, dot, norm};
use crate::turn::{MOST, Quaternion, Turn, apart, axis, fastest, turned};

/// The slack of a bound of lengths, as a part of the ball's radius.
const FINE: f64 = 1e-5;

/// The departure of a picture from the motion that it shows, and its error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shown {
    /// The least length along the axis, as a part of a diameter.
    pub least: f64,
    /// The greatest length along the axis, as a part of a diameter.
    pub most: f64,
    /// The largest distance of a point of the outline from that of a round ball, in m.
    pub moved: f64,
    /// The largest error of the volume, as a part of that of the ball, between keys too.
    pub volume: f64,
    /// The largest depth of the ball below the height of its lowest point, or in what it touches,
    /// in m.
    pub sunk: f64,
    /// The number of keys of orientation that are added so that none is half a turn from the next.
    pub added: usize,
}

impl Shown {
    /// A round ball that does not turn.
    const ROUND: Self = Self { least: 1.0, most: 1.0, moved: 0.0, volume: 0.0, sunk: 0.0, added: 0 };

    /// The same lengths in another unit, of which `factor` make one of this.
    pub(crate) const fn times(self, factor: f64) -> Self {
        Self { moved: self.moved * factor, sunk: self.sunk * factor, ..self }
    }

    pub(crate) const fn or(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            most: self.most.max(other.most),
            moved: self.moved.max(other.moved),
            volume: self.volume.max(other.volume),
            sunk: self.sunk.max(other.sunk),
            added: self.added + other.added,
        }
    }
}

/// A span between neighbours among all keys: place, size and aim of the ball in powers of time.
struct Span<'a> {
    stretch: &'a Stretch,
    radius: f64,
    path: Piece,
    offset: Piece,
    scale: Piece,
    aim: &'a [Turn],
    /// The rate at which the aim turns, in rad/s: an even one.
    rate: f64,
}

impl<'a> Span<'a> {
    fn of(dress: &'a Dress, track: &'a Track, path: &Curve, [a, b]: [f64; 2]) -> Self {
        let middle = 0.5 * (a + b);
        let part = |curve: &Curve| {
            let piece = curve.piece_at(middle);
            // Before the first key and after the last one the curve stands.
            let s = (a - piece.start).clamp(0.0, piece.span);
            piece.part(s, b - a)
        };
        let [p, q] = [a, b].map(|t| turned(&dress.aim, t));
        let aim = &dress.aim[..];
        let stretch = track.stretch(middle);
        let [path, offset, scale] = [path, &dress.offset, &dress.scale].map(part);
        Self { stretch, radius: track.radius, path, offset, scale, aim, rate: apart(p, q) / (b - a) }
    }

    /// The greatest of what is shown, from above, and what is shown elsewhere.
    fn shown(&self, known: Shown) -> Shown {
        let (r, span) = (self.radius, [0.0, self.scale.span]);
        let [size, rate, second] = [0, 1, 2].map(|order| self.scale.bound(order));
        let largest = |c: Point| c.into_iter().fold(0.0, f64::max);
        let volume = (0..3).map(|n| {
            let [a, b, c] = [n, (n + 1) % 3, (n + 2) % 3];
            second[a] * size[b] * size[c] + 2.0 * size[a] * rate[b] * rate[c]
        });
        let moved = norm(&self.offset.bound(2)) + r * largest(second);
        Shown {
            volume: most(span, volume.sum(), FINE, known.volume, |s| {
                (self.scale.at(s).into_iter().product::<f64>() - 1.0).abs()
            }),
            moved: most(span, moved, FINE * r, known.moved, |s| {
                let (offset, [across, _, along]) = (self.offset.at(s), self.scale.at(s));
                let shift = [offset[0], offset[1], offset[2] - r];
                norm(&shift) + r * (along - 1.0).abs().max((across - 1.0).abs())
            }),
            ..known
        }
    }

    /// An upper bound of the depth of the ball in what it touches, or `known` where that is larger.
    ///
    /// In the direction n it reaches |D Rᵀ n| from its centre, D its lengths and R its aim: a norm,
    /// which is below its chord and an eighth of h² max |(D Rᵀ n)″|; Rᵀ n turns at an even rate.
    fn sunk(&self, flat: bool, known: f64) -> f64 {
        let (r, span) = (self.radius, [0.0, self.scale.span]);
        let largest = |order: usize| self.scale.bound(order).into_iter().fold(0.0, f64::max);
        let mut curvature = r * (largest(2) + 2.0 * largest(1) * self.rate + largest(0) * self.rate * self.rate);
        let contact = self.stretch.contact.filter(|_| !self.stretch.flight);
        // A flat picture shows no depth across its plane.
        if contact.is_some_and(|contact| flat && contact.normal[1] != 0.0) {
            return known;
        }
        let normal = contact.map_or(UP, |contact| contact.normal);
        let sizes = normal.map(f64::abs);
        curvature += dot(&sizes, &self.offset.bound(2));
        let touch = contact.map(|_| self.stretch.at(self.stretch.start()));
        if touch.is_some() {
            curvature += dot(&sizes, &self.path.bound(2));
        }
        // From where a round ball touches, which is its lowest point on a level floor only.
        let gap = |s: f64| {
            let offset = self.offset.at(s);
            let Some(touch) = touch else { return offset[2] };
            let p = self.path.at(s);
            dot(&normal, &std::array::from_fn(|k| p[k] + offset[k] - touch[k] - r * UP[k] + r * normal[k]))
        };
        most(span, curvature, FINE * r, known, |s| {
            let [across, _, along] = self.scale.at(s);
            let cos = dot(&axis(self.aimed(s)), &normal);
            r * (along * cos).hypot(across * (1.0 - cos * cos).max(0.0).sqrt()) - gap(s)
        })
    }

    fn aimed(&self, s: f64) -> Quaternion {
        turned(self.aim, self.scale.start + s)
    }
}

impl Dress {
    /// The departure of a ball whose place is shown by `path`; `flat` in a picture of the plane.
    pub(crate) fn shown(&self, track: &Track, path: &Curve, flat: bool) -> Shown {
        let mut shown = Shown::ROUND;
        let fast = |turn: &&Turn| {
            let stretch = track.stretch(turn.t);
            let inside = turn.t > stretch.start() && turn.t < stretch.end();
            inside && fastest(stretch) * stretch.span() > MOST
        };
        if self.about.is_none() {
            shown.added = self.spin.iter().filter(fast).count();
        }
        if !self.shaped() {
            return shown;
        }
        let [least, most] = extremes(&self.scale, 2);
        (shown.least, shown.most) = (shown.least.min(least), shown.most.max(most));
        let aims = self.aim.iter().map(|turn| turn.t);
        let keys = [path, &self.scale, &self.offset].into_iter().flat_map(|curve| &curve.keys).map(|key| key.t);
        let starts = track.stretches.iter().map(Stretch::start);
        let mut stops: Vec<f64> = keys.chain(aims).chain(starts).collect();
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        for pair in stops.windows(2) {
            // A drawing that stands is what it is when it is drawn.
            let until = if path.between == Between::Hold { pair[0].next_up() } else { pair[1] };
            let span = Span::of(self, track, path, [pair[0], until]);
            shown = span.shown(shown);
            shown.sunk = span.sunk(flat, shown.sunk);
        }
        shown
    }
}
