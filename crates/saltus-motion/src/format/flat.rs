//! A ball in the plane of x and up, as groups within groups, each moved by one number.

use std::fmt::Write;

use super::Ball;
use super::view::View;
use crate::curve::Curve;
use crate::ease::{Ease, eases};
use crate::turn::Turn;

/// The effect of a number; sizes in units of the picture, angles in degrees with the clock.
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

/// The channels of a ball, from the outermost inwards: along the path, from there to the centre,
/// squash, spin. The innermost holds a disc about its origin.
pub(super) fn channels(ball: &Ball<'_>, view: &View) -> Vec<Channel> {
    let shaped = ball.flat.as_ref().or(ball.dress.as_ref()).filter(|dress| dress.shaped());
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
        within.push(turning("a", &dress.aim));
        within.push(of("w", Moves::ScaleX, &dress.scale, 0, &|s| s));
        within.push(of("h", Moves::ScaleY, &dress.scale, 2, &|s| s));
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
