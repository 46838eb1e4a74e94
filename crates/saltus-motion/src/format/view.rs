//! The plane of x and up on a flat picture.

use crate::motion::Motion;

/// The longer side of a picture in its own units.
const LONGER: f64 = 720.0;
/// The least radius of a ball in units of the picture.
const LEAST: f64 = 3.0;
/// Room around, as a share of the longer side.
const ROOM: f64 = 0.06;

/// A view to scale, x to the right and heights upwards, where the picture's own axis points down.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Units of the picture per m.
    pub(super) scale: f64,
    pub(super) width: f64,
    pub(super) height: f64,
    left: f64,
    top: f64,
}

impl View {
    pub(super) fn of(motion: &Motion) -> Self {
        let [[left, right], [low, high]] = motion.reach();
        let longer = (right - left).max(high - low).max(1e-9);
        let room = ROOM * longer;
        let scale = LONGER / (longer + 2.0 * room);
        let side = |low: f64, high: f64| ((high - low + 2.0 * room) * scale).ceil();
        Self { scale, width: side(left, right), height: side(low, high), left: left - room, top: high + room }
    }

    /// The radius that a ball is drawn with: its own, but three units at least, so that it is
    /// visible.
    pub(super) fn radius(&self, radius: f64) -> f64 {
        (radius * self.scale).max(LEAST)
    }

    pub(super) fn x(&self, x: f64) -> f64 {
        (x - self.left) * self.scale
    }

    pub(super) fn y(&self, up: f64) -> f64 {
        (self.top - up) * self.scale
    }
}
