//! What a picture of the plane of x and up shows of a ball whose axis leaves the plane.

use crate::curve::{Between, Curve, Key};
use crate::dress::{Dress, FINE};
use crate::turn::{STRAIGHT, axis, turned, turns};

/// The most halvings of the time between two keys: an axis that passes across the plane turns there
/// through half a turn at once, while the outline of the ball is round.
const HALVINGS: u32 = 8;

/// An ellipse: the angle from up towards x in rad, the length across and along, of a round ball.
type Ellipse = [f64; 3];

/// The ellipse as a matrix, which changes smoothly where angle and lengths leap.
fn matrix([angle, across, along]: Ellipse) -> [f64; 3] {
    let ([sin, cos], more) = ([angle.sin(), angle.cos()], along * along - across * across);
    [across * across + more * sin * sin, more * sin * cos, across * across + more * cos * cos]
}

impl Dress {
    /// The form as an ellipse in the plane, whose axis stays in it; `None` where it does anyway.
    ///
    /// A ball that is longer by c along the unit axis a and by b across it has an ellipse as its
    /// outline, whose matrix is b² + (c² - b²) p pᵀ with p the projection of a: as long as √(b² +
    /// (c² - b²) p²) along p, and b across it. Angle and lengths go straight from key to key, as
    /// many as keep the ellipse within what a form may be off by.
    pub(crate) fn flattened(&self) -> Option<Self> {
        if !self.shaped() || self.aim.iter().all(|turn| turn.quaternion[0] == 0.0 && turn.quaternion[2] == 0.0) {
            return None;
        }
        let held = self.scale.between == Between::Hold;
        let mut stops: Vec<f64> =
            self.aim.iter().map(|turn| turn.t).chain(self.scale.keys.iter().map(|key| key.t)).collect();
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        let mut keys: Vec<(f64, Ellipse)> = Vec::new();
        for t in stops {
            while keys.last().is_none_or(|&(last, _)| last < t) {
                let (b, near) = match keys.last() {
                    Some(&(a, [near, ..])) => (if held { t } else { self.straight_until(a, t, near) }, near),
                    None => (t, 0.0),
                };
                keys.push((b, self.ellipse(b, near)));
            }
        }
        let key = |&(t, [_, across, along]): &(f64, Ellipse)| Key {
            t,
            place: [across, across, along],
            enter: [0.0; 3],
            leave: [0.0; 3],
            contact: false,
        };
        let between = if held { Between::Hold } else { Between::Line };
        let scale = Curve { keys: keys.iter().map(key).collect(), between };
        let aim = turns(keys.iter().map(|&(t, [angle, ..])| (t, [0.0, (0.5 * angle).sin(), 0.0, (0.5 * angle).cos()])));
        Some(Self { offset: self.offset.clone(), scale, aim, spin: self.spin.clone(), about: self.about.clone() })
    }

    /// The ellipse at `t` in s, of whose two directions the one nearer to an angle counts.
    fn ellipse(&self, t: f64, near: f64) -> Ellipse {
        let aim = if self.aim.is_empty() { STRAIGHT } else { turned(&self.aim, t) };
        let ([across, _, along], [x, _, up]) = (self.scale.at(t), axis(aim));
        let square = x * x + up * up;
        let half = std::f64::consts::PI;
        let angle = if square > 0.0 { x.atan2(up) } else { near };
        let angle = angle - half * ((angle - near) / half).round();
        [angle, across, (across * across + (along * along - across * across) * square).sqrt()]
    }

    /// Until when angle and lengths may go straight from a time: to another, or a half of the way,
    /// or of that.
    fn straight_until(&self, a: f64, mut b: f64, near: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (a + b);
            if middle <= a || self.straight([a, b], near) {
                break;
            }
            b = middle;
        }
        b
    }

    /// Whether angle and lengths may go straight from a time to another.
    fn straight(&self, [a, b]: [f64; 2], near: f64) -> bool {
        let p = self.ellipse(a, near);
        let q = self.ellipse(b, p[0]);
        [0.25, 0.5, 0.75].into_iter().all(|u| {
            let shown = matrix(std::array::from_fn(|k| p[k] + (q[k] - p[k]) * u));
            let there = matrix(self.ellipse(a + (b - a) * u, p[0]));
            // A length is off by half as much as its square.
            shown.into_iter().zip(there).all(|(shown, there)| (shown - there).abs() <= 2.0 * FINE)
        })
    }
}
