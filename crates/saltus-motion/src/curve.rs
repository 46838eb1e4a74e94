//! Motion as keys: exact cubics between contacts, or samples on frames.

use crate::bound::{Miss, apart, difference};
use crate::motion::{Piece, Point, Stretch, Track, norm};
use crate::rate::Frames;

/// Keys closer than this share of a frame are one: programs merge them anyhow.
pub(crate) const APART: f64 = 0.01;
/// The number of points between two keys at which a form or a turning is compared with the motion.
pub(crate) const COMPARED: u32 = 16;

/// A place at a time, with the velocities on both sides of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// The time in s.
    pub t: f64,
    /// The place in m.
    pub place: Point,
    /// The velocity just before, in m/s.
    pub enter: Point,
    /// The velocity just after, in m/s.
    pub leave: Point,
    /// Whether a contact begins here.
    pub contact: bool,
}

/// The interpolation between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Between {
    /// The cubic with the places and velocities at both ends (Hermite's); a flight under gravity is
    /// one.
    Cubic,
    /// A straight line.
    Line,
    /// The first key stays.
    Hold,
}

/// Keys, and the interpolation between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The keys in order of time, at least one.
    pub keys: Vec<Key>,
    /// The interpolation, the same between all.
    pub between: Between,
}

impl Curve {
    /// The place at `t` in s; before the first key and after the last one, theirs.
    ///
    /// Of a cubic, with h the time between the keys and u from 0 to 1 in it:
    /// p₀ (1 + 2u)(1 - u)² + h v₀ u (1 - u)² + p₁ u² (3 - 2u) - h v₁ u² (1 - u).
    #[must_use]
    pub fn at(&self, t: f64) -> Point {
        let next = self.keys.partition_point(|key| key.t <= t);
        match (next.checked_sub(1).and_then(|n| self.keys.get(n)), self.keys.get(next)) {
            (Some(a), Some(b)) => between(self.between, a, b, t),
            (Some(only), None) | (None, Some(only)) => only.place,
            (None, None) => [0.0; 3],
        }
    }

    /// The greatest distance between curve and motion in m, from above: in height, and along all
    /// axes. Of drawings that stand it is that at their own times.
    #[must_use]
    pub fn error(&self, track: &Track) -> Miss {
        if self.between == Between::Hold {
            return self.keys.iter().fold(Miss::default(), |miss, key| {
                let (p, q) = (key.place, track.at(key.t));
                let off: Point = std::array::from_fn(|axis| p[axis] - q[axis]);
                miss.or(Miss { height: off[2].abs(), place: norm(&off) })
            });
        }
        let pieces: Vec<Piece> = (0..self.keys.len().saturating_sub(1)).map(|n| self.piece(n)).collect();
        let last = pieces.last().map_or(0.0, |piece| piece.start + piece.span);
        let rest = Piece { start: track.end(), span: last - track.end(), ..still(track.at(track.end())) };
        apart(pieces.iter(), track.pieces().chain([&rest]))
    }

    /// The interpolation between a key, by index, and the next, in powers of time. The last key
    /// stays.
    pub(crate) fn piece(&self, n: usize) -> Piece {
        let Some(a) = self.keys.get(n) else { return still([0.0; 3]) };
        let b = self.keys.get(n + 1).unwrap_or(a);
        Piece { start: a.t, span: b.t - a.t, ..powers(self.between, a, b) }
    }

    /// The piece at `t` in s: the later one, where two meet.
    pub(crate) fn piece_at(&self, t: f64) -> Piece {
        self.piece(self.keys.partition_point(|key| key.t <= t).saturating_sub(1))
    }
}

impl Curve {
    /// This curve with a key at the top of every flight of the track: a drawing that stands is of a
    /// whole frame, the nearest.
    pub(crate) fn topped(mut self, track: &Track, frames: Frames) -> Self {
        let frame = frames.rate.frame();
        for stretch in track.stretches.iter().filter(|stretch| stretch.flight) {
            let top = key(stretch, stretch.top().1);
            let t = if self.between == Between::Hold { (top.t / frame).round() * frame } else { top.t };
            let next = self.keys.partition_point(|key| key.t <= t);
            let near = [next.checked_sub(1), Some(next)].into_iter().flatten();
            let near = near.filter_map(|n| self.keys.get(n).map(|key| (n, (key.t - t).abs())));
            match near.filter(|(_, off)| *off < APART * frame).map(|(n, _)| n).next() {
                // What is a contact as well stays where the ball touches.
                Some(n) if self.between != Between::Cubic && !self.keys[n].contact => self.keys[n].place = top.place,
                Some(_) => {}
                None if next == 0 || next == self.keys.len() => {}
                None if self.between == Between::Cubic => self.keys.insert(next, self.key(t)),
                None => self.keys.insert(next, Key { t, ..top }),
            }
        }
        self
    }

    /// The place at `t` in s, with its velocities: a key that changes nothing there.
    pub(crate) fn key(&self, t: f64) -> Key {
        let next = self.keys.partition_point(|key| key.t <= t);
        let still = |key: &Key| Key { t, ..*key };
        match (next.checked_sub(1).and_then(|n| self.keys.get(n)), self.keys.get(next)) {
            (Some(a), _) if a.t == t => *a,
            (Some(a), Some(b)) => {
                let (h, u) = (b.t - a.t, (t - a.t) / (b.t - a.t));
                let slope = std::array::from_fn(|axis| {
                    let d = (b.place[axis] - a.place[axis]) / h;
                    match self.between {
                        Between::Hold => 0.0,
                        Between::Line => d,
                        Between::Cubic => {
                            let (v, w) = (a.leave[axis], b.enter[axis]);
                            v + u * (6.0 * d - 4.0 * v - 2.0 * w + u * 3.0 * (v + w - 2.0 * d))
                        }
                    }
                });
                Key { t, place: between(self.between, a, b, t), enter: slope, leave: slope, contact: false }
            }
            (Some(only), None) | (None, Some(only)) => still(only),
            (None, None) => Key { t, place: [0.0; 3], enter: [0.0; 3], leave: [0.0; 3], contact: false },
        }
    }
}

pub(crate) fn between(how: Between, a: &Key, b: &Key, t: f64) -> Point {
    let h = b.t - a.t;
    let u = if h > 0.0 { (t - a.t) / h } else { 0.0 };
    let w = 1.0 - u;
    std::array::from_fn(|axis| {
        let (p, q) = (a.place[axis], b.place[axis]);
        match how {
            Between::Hold => p,
            Between::Line => p + (q - p) * u,
            Between::Cubic => {
                let (v, z) = (h * a.leave[axis], h * b.enter[axis]);
                p * (1.0 + 2.0 * u) * w * w + v * u * w * w + q * u * u * (3.0 - 2.0 * u) - z * u * u * w
            }
        }
    })
}

/// A place in which nothing moves.
fn still(place: Point) -> Piece {
    Piece { start: 0.0, span: 0.0, coefficients: vec![place], spin: Vec::new() }
}

/// The interpolation between two keys in powers of the time since the first.
fn powers(how: Between, a: &Key, b: &Key) -> Piece {
    let h = b.t - a.t;
    let per = if h > 0.0 { 1.0 / h } else { 0.0 };
    let row = |of: &dyn Fn(usize) -> f64| -> Point { std::array::from_fn(of) };
    let d = row(&|axis| (b.place[axis] - a.place[axis]) * per);
    let mut piece = still(a.place);
    match how {
        Between::Hold => {}
        Between::Line => piece.coefficients.push(d),
        Between::Cubic => {
            let (v, w) = (a.leave, b.enter);
            let second = row(&|axis| (3.0 * d[axis] - 2.0 * v[axis] - w[axis]) * per);
            let third = row(&|axis| (v[axis] + w[axis] - 2.0 * d[axis]) * per * per);
            piece.coefficients.extend([v, second, third]);
        }
    }
    piece
}

fn key(stretch: &Stretch, t: f64) -> Key {
    let slope = stretch.slope(t);
    Key { t, place: stretch.at(t), enter: slope, leave: slope, contact: false }
}

impl Track {
    /// The fewest cubics that stay within `tolerance` in m of the motion: one for each flight under
    /// gravity alone, and that one exact.
    ///
    /// Where more acts, each cubic is as long as the tolerance lets it be. Keys closer than 0.01
    /// frame are one.
    #[must_use]
    pub fn keys(&self, tolerance: f64, frames: Frames) -> Curve {
        let mut keys: Vec<Key> = Vec::new();
        for stretch in &self.stretches {
            let mut first = key(stretch, stretch.start());
            first.contact = stretch.contact.is_some();
            match keys.last_mut() {
                // Two stretches meet in one key, with a velocity on each side.
                Some(last) => *last = Key { enter: last.enter, ..first },
                None => keys.push(first),
            }
            let end = key(stretch, stretch.end());
            while let Some(&from) = keys.last().filter(|from| from.t < end.t) {
                let fits = |to: f64| fits(stretch, &from, &key(stretch, to), tolerance);
                let to = if fits(end.t) { end.t } else { longest(from.t, end.t, fits) };
                keys.push(key(stretch, to));
            }
        }
        let mut curve = Curve { keys, between: Between::Cubic };
        part(&mut curve.keys, APART * frames.rate.frame());
        curve
    }

    /// The motion on frames, straight from one to the next; `exact_contacts` also puts a sample
    /// where a contact begins between two frames. On twos every second frame, held.
    #[must_use]
    pub fn samples(&self, frames: Frames, exact_contacts: bool) -> Curve {
        let (step, end) = (frames.step(), self.end());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
        let count = (end / step - 1e-6).ceil().max(0.0) as u32;
        let sample = |t: f64| {
            let stretch = self.stretch(t);
            Key { t, ..key(stretch, t) }
        };
        let mut keys: Vec<Key> = (0..=count).map(|k| sample(f64::from(k) * step)).collect();
        // Where the ball leaves after a contact that took time its velocity jumps too.
        let leaves =
            self.stretches.windows(2).filter(|pair| !pair[0].flight && pair[1].flight && pair[1].contact.is_none());
        let breaks = self.contacts().map(|t| (t, true)).chain(leaves.map(|pair| (pair[1].start(), false)));
        for (contact, begins) in breaks {
            let nearest = (contact / step).round() * step;
            let on_frame = (contact - nearest).abs() < APART * frames.rate.frame();
            if on_frame {
                let near = keys.iter_mut().find(|key| (key.t - nearest).abs() < 0.5 * step);
                if let Some(key) = near {
                    *key = Key { contact: begins || key.contact, place: self.at(contact), ..*key };
                }
            } else if exact_contacts && !frames.on_twos {
                let at = keys.partition_point(|key| key.t < contact);
                keys.insert(at, Key { contact: begins, ..sample(contact) });
            }
        }
        // Contacts that differ by rounding alone are one sample.
        part(&mut keys, APART * frames.rate.frame());
        Curve { keys, between: if frames.on_twos { Between::Hold } else { Between::Line } }
    }
}

/// Whether the cubic between two keys stays within `tolerance` of the motion, on every axis.
fn fits(stretch: &Stretch, a: &Key, b: &Key, tolerance: f64) -> bool {
    let cubic = Piece { start: a.t, span: b.t - a.t, ..powers(Between::Cubic, a, b) };
    let from = stretch.pieces.partition_point(|piece| piece.start + piece.span <= a.t);
    let within = stretch.pieces[from..].iter().take_while(|piece| piece.start < b.t);
    within
        .map(|piece| (piece, [piece.start.max(a.t), (piece.start + piece.span).min(b.t)]))
        .filter(|(_, span)| span[1] > span[0])
        .all(|(piece, span)| difference(&cubic, piece, span).stays(tolerance))
}

/// The longest of the spans from `a` that fit; some progress always.
pub(crate) fn longest(a: f64, b: f64, fits: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (a, b);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if fits(middle) { low = middle } else { high = middle }
    }
    if low > a { low } else { high }
}

/// Makes keys that are closer than `apart` in s one: the place and the way out of the later, the
/// way in of the earlier; contacts stay.
fn part(keys: &mut Vec<Key>, apart: f64) {
    keys.dedup_by(|later, earlier| {
        let one = later.t - earlier.t < apart;
        if one {
            let kept = if later.contact && !earlier.contact { *later } else { *earlier };
            *earlier =
                Key { t: kept.t, place: kept.place, enter: earlier.enter, leave: later.leave, contact: kept.contact };
        }
        one
    });
}
