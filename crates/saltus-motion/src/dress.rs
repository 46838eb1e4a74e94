//! What moves besides the place: form and orientation as keys.

use crate::curve::{APART, Between, COMPARED, Curve, Key, between, longest};
use crate::motion::{Point, Stretch, Track, UP, dot};
use crate::rate::Frames;
use crate::shape::{Form, Pose};
use crate::turn::{Orientation, Quaternion, Turn, aimed, back, fastest, product, times, turns};

/// The error of a form between keys, as a part of the ball's radius.
pub(crate) const FINE: f64 = 1e-4;
/// How far apart two keys stand where an orientation leaps, as a share of a frame. Blender merges
/// keys that are 0.01 frame apart, and so turns through the leap for a whole frame; the test
/// `a_leap_of_the_axis_has_keys_that_blender_keeps_apart` holds it.
const BESIDE: f64 = 0.02;
/// The error of an orientation between keys, in rad.
const TURNED: f64 = 0.01;

/// The form and the orientation of one ball as keys.
///
/// A point of a round ball about its centre is turned by `spin`, made longer by `scale`, turned by
/// `aim`, and moved by `offset` and by the path.
#[derive(Clone, Debug)]
pub(crate) struct Dress {
    /// The vector from the path to the centre that is shown.
    pub(crate) offset: Curve,
    /// Across, across and along.
    pub(crate) scale: Curve,
    /// The turns that take up to the axis; empty where that is up always.
    pub(crate) aim: Vec<Turn>,
    /// Empty for a ball that does not turn.
    pub(crate) spin: Vec<Turn>,
    /// The turning as an angle about y in rad, from up towards x, counted on over whole turns: of a
    /// path of cubics, for a ball that turns about y alone.
    pub(crate) about: Option<Curve>,
}

fn scale(pose: &Pose) -> Point {
    let across = 1.0 / pose.along.sqrt();
    [across, across, pose.along]
}

fn index(track: &Track, t: f64) -> usize {
    track.stretches.partition_point(|stretch| stretch.start() <= t).max(1) - 1
}

/// Offset and scale at `t` within [a, b], with their slopes there.
fn pair(track: &Track, form: &Form, index: usize, [a, b]: [f64; 2], t: f64) -> [Key; 2] {
    let of = |t: f64| {
        let pose = form.pose(track, index, t);
        [pose.offset, scale(&pose)]
    };
    // Differences of third order: exact for cubics, inside the span.
    let h = (b - a) / 64.0 * if t + 3.0 * (b - a) / 64.0 > b { -1.0 } else { 1.0 };
    let (p, rows) = (of(t), [1.0, 2.0, 3.0].map(|k| of(t + k * h)));
    [0, 1].map(|n| {
        let slope = std::array::from_fn(|axis| {
            let row = |k: usize| rows[k][n][axis];
            (-11.0 * p[n][axis] + 18.0 * row(0) - 9.0 * row(1) + 2.0 * row(2)) / (6.0 * h)
        });
        Key { t, place: p[n], enter: slope, leave: slope, contact: false }
    })
}

/// Offset and scale as few cubics, both with keys at the same times.
fn cubics(track: &Track, form: &Form, frames: Frames) -> [Curve; 2] {
    let mut keys: Vec<[Key; 2]> = Vec::new();
    for index in 0..track.stretches.len() {
        for span in form.smooth(track, index).windows(2) {
            let (from, to) = (span[0], span[1]);
            let at = |t: f64| pair(track, form, index, [from, to], t);
            let fits = |a: f64, b: f64| {
                let (p, q) = (at(a), at(b));
                (1..COMPARED).all(|k| {
                    let t = a + (b - a) * f64::from(k) / f64::from(COMPARED);
                    let pose = form.pose(track, index, t);
                    let off = |n: usize, truth: Point, unit: f64| {
                        let shown = between(Between::Cubic, &p[n], &q[n], t);
                        shown.iter().zip(truth).all(|(a, b)| (a - b).abs() <= FINE * unit)
                    };
                    off(0, pose.offset, track.radius) && off(1, scale(&pose), 1.0)
                })
            };
            let first = at(from);
            match keys.last_mut() {
                Some(last) => *last = [0, 1].map(|n| Key { enter: last[n].enter, ..first[n] }),
                None => keys.push(first),
            }
            let mut a = from;
            while a < to {
                a = if fits(a, to) { to } else { longest(a, to, |b| fits(a, b)) };
                keys.push(at(a));
            }
        }
    }
    // Keys closer than a hundredth of a frame are one.
    keys.dedup_by(|later, earlier| {
        let one = later[0].t - earlier[0].t < APART * frames.rate.frame();
        if one {
            *earlier = [0, 1].map(|n| Key { leave: later[n].leave, ..earlier[n] });
        }
        one
    });
    [0, 1].map(|n| Curve { keys: keys.iter().map(|pair| pair[n]).collect(), between: Between::Cubic })
}

/// Offset and scale at the times of a path's keys.
fn sampled(track: &Track, form: &Form, path: &Curve) -> [Curve; 2] {
    let poses = path.keys.iter().map(|key| (key.t, form.pose(track, index(track, key.t), key.t)));
    let (offsets, scales): (Vec<Key>, Vec<Key>) = poses
        .map(|(t, pose)| {
            let key = |place: Point| Key { t, place, enter: [0.0; 3], leave: [0.0; 3], contact: false };
            (key(pose.offset), key(scale(&pose)))
        })
        .unzip();
    [offsets, scales].map(|keys| Curve { keys, between: path.between })
}

/// The axis, which has two directions, in the one that is given. A ball that goes straight up and
/// down has one axis for both.
fn direction(form: &Form, track: &Track, (index, sign): (usize, f64), t: f64) -> Point {
    let [x, y, up] = form.pose(track, index, t).axis;
    if x.hypot(y) < 1e-9 { UP.map(|c| c * sign) } else { [x, y, up].map(|c| c * sign) }
}

/// The direction in each stretch that is nearest to that at the end of the one before.
fn signs(form: &Form, track: &Track) -> Vec<f64> {
    let mut last = UP;
    let near = |(index, stretch): (usize, &Stretch)| {
        let start = direction(form, track, (index, 1.0), stretch.start());
        let sign = if index > 0 && dot(&start, &last) < 0.0 { -1.0 } else { 1.0 };
        last = direction(form, track, (index, sign), stretch.end());
        sign
    };
    track.stretches.iter().enumerate().map(near).collect()
}

/// Keys of an orientation, by stretch; `at` gives it with how exact it has to be, `rate` bounds its
/// rate in a stretch, in rad/s.
fn keyed(
    track: &Track,
    frames: Frames,
    path: &Curve,
    rate: impl Fn(&Stretch) -> f64,
    at: impl Fn(usize, f64) -> (Quaternion, f64),
) -> Vec<Turn> {
    if path.between == Between::Hold {
        return turns(path.keys.iter().map(|key| (key.t, at(index(track, key.t), key.t).0)));
    }
    let close = BESIDE * frames.rate.frame();
    let mut keys: Vec<(f64, Quaternion)> = Vec::new();
    for (n, stretch) in track.stretches.iter().enumerate() {
        let span = [stretch.start(), stretch.end()];
        let mut own = 0;
        for (k, t) in times(span, rate(stretch), |t| at(n, t).0, |t| at(n, t).1).into_iter().enumerate() {
            let q = at(n, t).0;
            let last = keys.last().copied().filter(|(last, _)| t - last < close);
            match last {
                // Where a stretch ends one way and the next begins another, two keys stand close
                // together, in the air: in contact the axis is the normal.
                Some((last, before)) if k == 0 && dot(&before, &q).abs() < 1.0 - 1e-12 => {
                    if stretch.flight {
                        keys.push((last + close, q));
                    } else {
                        keys.pop();
                        let before = (t - close).max(keys.last().map_or(0.0, |key| key.0 + 0.5 * close));
                        keys.push((before, at(n.max(1) - 1, before).0));
                        keys.push((t, q));
                    }
                }
                Some(_) if own > 1 => {
                    keys.pop();
                    keys.push((t, q));
                    continue;
                }
                Some(_) => continue,
                None => keys.push((t, q)),
            }
            own += 1;
        }
    }
    turns(keys)
}

/// The angle about y in rad by which a ball has turned, as few cubics: of one that turns about y
/// alone. An angle is a motion on a line, and has keys as one.
fn angle(track: &Track, frames: Frames) -> Option<Curve> {
    let spins = || track.stretches.iter().flat_map(|stretch| &stretch.pieces).flat_map(|piece| &piece.spin);
    if !spins().all(|&[x, _, up]| x == 0.0 && up == 0.0) {
        return None;
    }
    let mut turned = track.clone();
    let mut from = 0.0;
    for piece in turned.stretches.iter_mut().flat_map(|stretch| &mut stretch.pieces) {
        let integral = piece.spin.iter().zip(1_u32..).map(|([_, y, _], k)| [y / f64::from(k), 0.0, 0.0]);
        piece.coefficients = std::iter::once([from, 0.0, 0.0]).chain(integral).collect();
        from = piece.at(piece.span)[0];
    }
    Some(turned.keys(TURNED, frames))
}

impl Dress {
    /// The form and the orientation that go with a path; `None` where neither changes. A ball that
    /// turns about one axis has its angle too, where `turns` are counted.
    pub(crate) fn of(track: &Track, form: Option<&Form>, path: &Curve, frames: Frames, turns: bool) -> Option<Self> {
        let orientation = Orientation::of(track);
        if form.is_none() && orientation.is_none() {
            return None;
        }
        let [offset, scale] = match form {
            None => {
                let still = |place: Point| Curve {
                    keys: vec![Key { t: 0.0, place, enter: [0.0; 3], leave: [0.0; 3], contact: false }],
                    between: path.between,
                };
                [still(UP.map(|c| c * track.radius)), still([1.0; 3])]
            }
            Some(form) if path.between == Between::Cubic => cubics(track, form, frames),
            Some(form) => sampled(track, form, path),
        };
        let signs = form.map_or_else(Vec::new, |form| signs(form, track));
        let facing = |index: usize, t: f64| {
            form.map_or(([0.0, 0.0, 0.0, 1.0], TURNED), |form| {
                let (q, along) =
                    (aimed(direction(form, track, (index, signs[index]), t)), form.pose(track, index, t).along);
                // A ball that is nearly round does not show where its axis is.
                (q, 3.0 * FINE / (along - 1.0).abs().max(0.001))
            })
        };
        let mut aim = keyed(track, frames, path, |_| 0.0, facing);
        let turned = |n: usize, t: f64| {
            let q = orientation.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |orientation| orientation.at(t));
            product(back(facing(n, t).0), q)
        };
        let spin = match &orientation {
            Some(_) => keyed(track, frames, path, fastest, |n, t| (turned(n, t), TURNED.min(facing(n, t).1))),
            None => Vec::new(),
        };
        if aim.iter().all(|turn| turn.angle == 0.0 && turn.quaternion[3].abs() == 1.0) {
            aim.clear();
        }
        // Where the form is aimed as well, the spin is what is left to turn.
        let about = orientation.filter(|_| turns && path.between == Between::Cubic && aim.is_empty());
        let about = about.and_then(|_| angle(track, frames));
        Some(Self { offset, scale, aim, spin, about })
    }

    /// Whether the form changes at all.
    pub(crate) const fn shaped(&self) -> bool {
        self.scale.keys.len() > 1
    }
}
