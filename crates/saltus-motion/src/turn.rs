//! Turning: orientations from spins, and keys between which the shortest way is the right one.

use crate::curve::{COMPARED, longest};
use crate::motion::{Piece, Point, Stretch, Track, dot, norm};

/// An orientation (x, y, up, w) of length 1.
pub(crate) type Quaternion = [f64; 4];

/// The orientation of a ball that has not turned.
pub(crate) const STRAIGHT: Quaternion = [0.0, 0.0, 0.0, 1.0];

/// Keys are less than this apart, in rad: half a turn would leave the way open.
pub(crate) const MOST: f64 = 2.5;

/// The points at which the angle of a spin that changes its axis is summed, in each piece.
const STEPS: u32 = 64;

/// An orientation at a time; from one to the next by the shortest way, evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// The time in s.
    pub t: f64,
    /// The orientation as a quaternion (x, y, up, w).
    pub quaternion: [f64; 4],
    /// The angle in rad from x towards up, counted on over whole turns: what a picture of the plane
    /// of x and up shows.
    pub angle: f64,
}

/// First `b`, then `a`.
pub(crate) fn product([ax, ay, az, aw]: Quaternion, [bx, by, bz, bw]: Quaternion) -> Quaternion {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

fn unit<const N: usize>(a: [f64; N]) -> [f64; N] {
    let length = dot(&a, &a).sqrt();
    a.map(|a| a / length)
}

/// The turn by the angle |v| about v.
fn about(v: Point) -> Quaternion {
    let angle = norm(&v);
    let by = if angle > 1e-8 { (0.5 * angle).sin() / angle } else { 0.5 };
    [v[0] * by, v[1] * by, v[2] * by, (0.5 * angle).cos()]
}

/// The least turn that takes up to `axis`, of length 1.
pub(crate) fn aimed([x, y, up]: Point) -> Quaternion {
    let side = x.hypot(y);
    if side < 1e-12 {
        return if up > 0.0 { STRAIGHT } else { [0.0, 1.0, 0.0, 0.0] };
    }
    let half = 0.5 * side.atan2(up);
    [-y / side * half.sin(), x / side * half.sin(), 0.0, half.cos()]
}

/// The axis to which a turn takes up.
pub(crate) fn axis([x, y, z, w]: Quaternion) -> Point {
    [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)]
}

pub(crate) const fn back([x, y, z, w]: Quaternion) -> Quaternion {
    [-x, -y, -z, w]
}

/// The angle between two orientations in rad, by the shortest way.
pub(crate) fn apart(a: Quaternion, b: Quaternion) -> f64 {
    let [x, y, z, w] = product(back(a), b);
    2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs())
}

/// Evenly from `a` to `b` by the shortest way.
pub(crate) fn slerp(a: Quaternion, b: Quaternion, u: f64) -> Quaternion {
    let sign = if dot(&a, &b) < 0.0 { -1.0 } else { 1.0 };
    let angle = 0.5 * apart(a, b);
    let (p, q) = if angle < 1e-8 {
        (1.0 - u, u)
    } else {
        (((1.0 - u) * angle).sin() / angle.sin(), (u * angle).sin() / angle.sin())
    };
    unit(std::array::from_fn(|k| p * a[k] + sign * q * b[k]))
}

/// The orientation at `t` in s between keys.
pub(crate) fn turned(turns: &[Turn], t: f64) -> Quaternion {
    let next = turns.partition_point(|turn| turn.t <= t);
    match (next.checked_sub(1).and_then(|n| turns.get(n)), turns.get(next)) {
        (Some(a), Some(b)) => slerp(a.quaternion, b.quaternion, (t - a.t) / (b.t - a.t)),
        (Some(only), None) | (None, Some(only)) => only.quaternion,
        (None, None) => STRAIGHT,
    }
}

/// The orientation of a ball at any time, from its spin: q' = ½ ω q.
#[derive(Debug)]
pub(crate) struct Orientation<'a> {
    /// The pieces, each with the orientation at its start.
    pieces: Vec<(&'a Piece, Quaternion)>,
}

impl<'a> Orientation<'a> {
    /// `None` for a ball that does not turn.
    pub(crate) fn of(track: &'a Track) -> Option<Self> {
        let spins = |piece: &Piece| piece.spin.iter().flatten().any(|&w| w != 0.0);
        let pieces = || track.stretches.iter().flat_map(|stretch| &stretch.pieces);
        pieces().any(spins).then(|| {
            let mut q = STRAIGHT;
            let from = |piece: &'a Piece| {
                let start = q;
                q = unit(product(spun(piece, piece.span), q));
                (piece, start)
            };
            Self { pieces: pieces().map(from).collect() }
        })
    }

    pub(crate) fn at(&self, t: f64) -> Quaternion {
        let next = self.pieces.partition_point(|(piece, _)| piece.start <= t).max(1);
        let (piece, start) = self.pieces[next - 1];
        product(spun(piece, (t - piece.start).clamp(0.0, piece.span)), start)
    }
}

/// The turn of a ball `s` seconds into a piece: exact where the axis stands, else in steps of the
/// middle's spin.
fn spun(piece: &Piece, s: f64) -> Quaternion {
    let Some(first) = piece.spin.iter().find(|c| norm(c) > 0.0) else { return STRAIGHT };
    let aside = |c: &Point| {
        let along = dot(c, first) / dot(first, first);
        norm(&std::array::from_fn(|k| c[k] - along * first[k])) > 1e-12 * norm(c)
    };
    if piece.spin.iter().any(aside) {
        let h = s / f64::from(STEPS);
        return (0..STEPS).fold(STRAIGHT, |q, k| {
            let w = piece.spin_at(h * (f64::from(k) + 0.5));
            product(about(w.map(|w| w * h)), q)
        });
    }
    let angle = piece
        .spin
        .iter()
        .enumerate()
        .rev()
        .fold([0.0; 3], |sum: Point, (k, c)| std::array::from_fn(|axis| sum[axis] * s + c[axis] / (k + 1) as f64));
    about(angle.map(|a| a * s))
}

/// The fastest spin in a stretch, in rad/s, looked at in 16 points of each piece.
pub(crate) fn fastest(stretch: &Stretch) -> f64 {
    let points = |piece: &'_ Piece| -> f64 {
        let at = |k: u32| norm(&piece.spin_at(piece.span * f64::from(k) / f64::from(COMPARED)));
        (0..=COMPARED).map(at).fold(0.0, f64::max)
    };
    stretch.pieces.iter().map(points).fold(0.0, f64::max)
}

/// The times of keys from `from` to `to`, as few as keep even turns between them within what is
/// `allowed` in rad, and each less than half a turn; `fastest` in rad/s bounds the turns that
/// points do not show.
pub(crate) fn times(
    [from, to]: [f64; 2],
    fastest: f64,
    at: impl Fn(f64) -> Quaternion,
    allowed: impl Fn(f64) -> f64,
) -> Vec<f64> {
    let fits = |a: f64, b: f64| {
        if (b - a) * fastest > MOST {
            return false;
        }
        let (p, q) = (at(a), at(b));
        let (mut sum, mut last) = (0.0, p);
        for k in 1..=COMPARED {
            let u = f64::from(k) / f64::from(COMPARED);
            let t = a + (b - a) * u;
            let here = at(t);
            sum += apart(last, here);
            last = here;
            if sum > MOST || (k < COMPARED && apart(slerp(p, q, u), here) > allowed(t)) {
                return false;
            }
        }
        true
    };
    let mut times = vec![from];
    let mut a = from;
    while a < to {
        a = if fits(a, to) { to } else { longest(a, to, |b| fits(a, b)) };
        times.push(a);
    }
    times
}

/// Orientations at times, with the signs of neighbours alike and angles counted on.
pub(crate) fn turns(keys: impl IntoIterator<Item = (f64, Quaternion)>) -> Vec<Turn> {
    let mut turns: Vec<Turn> = Vec::new();
    for (t, q) in keys {
        // A turn in the plane of x and up is one about y: from up towards x.
        let turn = match turns.last() {
            None => Turn { t, quaternion: q, angle: -2.0 * q[1].atan2(q[3]) },
            Some(last) => {
                let sign = if dot(&last.quaternion, &q) < 0.0 { -1.0 } else { 1.0 };
                let [_, y, _, w] = product(q, back(last.quaternion)).map(|c| c * sign);
                Turn { t, quaternion: q.map(|c| c * sign), angle: last.angle - 2.0 * y.atan2(w) }
            }
        };
        turns.push(turn);
    }
    turns
}
