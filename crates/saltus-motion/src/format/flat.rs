//! A ball in the plane of x and up, as groups within groups, each moved by one number.

use std::fmt::Write;

use super::Ball;
use super::view::View;
use crate::curve::Curve;
use crate::dress::Dress;
use crate::ease::{Ease, eases};
use crate::turn::{Turn, axis, turned as turned_to};

/// What a number does; sizes in units of the picture, angles in degrees with the clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moves {
    X,
    Y,
    Turn,
    ScaleX,
    ScaleY,
}

/// One number as it goes.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    pub(super) name: &'static str,
    pub(super) moves: Moves,
    pub(super) eases: Vec<Ease>,
}

/// From the outermost inwards: along the path, from there to the centre, squash, spin. The
/// innermost holds a disc about its origin.
pub(super) fn channels(ball: &Ball<'_>, view: &View) -> Vec<Channel> {
    let shaped = ball.dress.as_ref().filter(|dress| dress.shaped());
    let of = |name, moves, curve: &Curve, axis, to: &dyn Fn(f64) -> f64| {
        let mapped = |ease: Ease| Ease { value: ease.value.map(to), ..ease };
        Channel { name, moves, eases: eases(curve, axis).into_iter().map(mapped).collect() }
    };
    let lift = if shaped.is_some() { 0.0 } else { ball.track.radius };
    let mut channels = vec![
        of("x", Moves::X, &ball.path, 0, &|x| view.x(x)),
        of("y", Moves::Y, &ball.path, 2, &|up| view.y(up + lift)),
    ];
    let turning = |name, turns: &[Turn]| Channel { name, moves: Moves::Turn, eases: turned(turns, ball.held()) };
    let mut within = Vec::new();
    if let Some(dress) = shaped {
        within.push(of("u", Moves::X, &dress.offset, 0, &|x| x * view.scale));
        within.push(of("v", Moves::Y, &dress.offset, 2, &|up| -up * view.scale));
        if dress.aim.iter().all(|turn| turn.quaternion[0] == 0.0 && turn.quaternion[2] == 0.0) {
            within.push(turning("a", &dress.aim));
            within.push(of("w", Moves::ScaleX, &dress.scale, 0, &|s| s));
            within.push(of("h", Moves::ScaleY, &dress.scale, 2, &|s| s));
        } else {
            within.extend(seen(dress, ball.held()));
        }
    }
    if let Some(dress) = &ball.dress {
        within.push(match &dress.about {
            Some(about) => of("s", Moves::Turn, about, 0, &f64::to_degrees),
            None => turning("s", &dress.spin),
        });
    }
    // What does nothing is left out.
    let idle = |channel: &Channel| {
        let rest = if matches!(channel.moves, Moves::ScaleX | Moves::ScaleY) { 1.0 } else { 0.0 };
        channel.eases.iter().flat_map(|ease| ease.value).all(|value| value == rest)
    };
    channels.extend(within.into_iter().filter(|channel| !idle(channel)));
    channels
}

/// Between keys of a form that leaves the plane its picture is looked at so often.
const SEEN: u32 = 4;

/// What the plane shows of a ball whose axis leaves it: turn, length across and length along.
///
/// A ball that is longer by c along the unit axis a and by b across it is seen as an ellipse, whose
/// matrix is b² + (c² - b²) p pᵀ with p what the plane sees of a: as long as √(b² + (c² - b²) p²)
/// along p, and b across it.
fn seen(dress: &Dress, held: bool) -> [Channel; 3] {
    let mut keys: Vec<f64> =
        dress.aim.iter().map(|turn| turn.t).chain(dress.scale.keys.iter().map(|key| key.t)).collect();
    keys.sort_by(f64::total_cmp);
    keys.dedup();
    let part = |pair: &[f64], k: u32| pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(SEEN);
    let mut times: Vec<f64> = keys.windows(2).flat_map(|pair| (0..SEEN).map(move |k| part(pair, k))).collect();
    times.extend(keys.last());
    let mut last = 0.0;
    let shown: Vec<[f64; 3]> = times
        .iter()
        .map(|&t| {
            let ([across, _, along], [x, _, up]) = (dress.scale.at(t), axis(turned_to(&dress.aim, t)));
            let square = x * x + up * up;
            if square > 0.0 {
                // An axis has two directions: the one nearer to the last.
                let angle = x.atan2(up).to_degrees();
                last = angle - 180.0 * ((angle - last) / 180.0).round();
            }
            [last, across, (across * across + (along * along - across * across) * square).sqrt()]
        })
        .collect();
    let channel = |name, moves, part: usize| Channel {
        name,
        moves,
        eases: (1..times.len())
            .map(|n| Ease {
                t: [times[n - 1], times[n]],
                value: [shown[n - 1][part], shown[n][part]],
                handles: (!held).then_some([1.0 / 3.0, 2.0 / 3.0]),
            })
            .collect(),
    };
    [channel("a", Moves::Turn, 0), channel("w", Moves::ScaleX, 1), channel("h", Moves::ScaleY, 2)]
}

/// Even turns, in degrees with the clock.
fn turned(turns: &[Turn], held: bool) -> Vec<Ease> {
    let ease = |pair: &[Turn]| Ease {
        t: [pair[0].t, pair[1].t],
        value: [pair[0], pair[1]].map(|turn| 0.0 - turn.angle.to_degrees()),
        handles: (!held).then_some([1.0 / 3.0, 2.0 / 3.0]),
    };
    turns.windows(2).map(ease).collect()
}

/// A curve as exact cubics of an SVG path, whose points are written by `point`.
pub(super) fn cubics(curve: &Curve, point: impl Fn([f64; 3]) -> String) -> String {
    let mut path = String::new();
    for (n, pair) in curve.keys.windows(2).enumerate() {
        let third = (pair[1].t - pair[0].t) / 3.0;
        let [p, q] = [pair[0].place, pair[1].place];
        let out = std::array::from_fn(|axis| p[axis] + third * pair[0].leave[axis]);
        let back = std::array::from_fn(|axis| q[axis] - third * pair[1].enter[axis]);
        if n == 0 {
            let _ = write!(path, "M{}", point(p));
        }
        let _ = write!(path, "C{} {} {}", point(out), point(back), point(q));
    }
    path
}
