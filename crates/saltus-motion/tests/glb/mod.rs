//! Animations of glTF, read by its own crate.

use gltf::animation::util::{ReadOutputs, Rotations};
use gltf::animation::{Interpolation, Property};

/// One channel of an animation: times, and rows of which three belong to a key of a cubic.
pub(crate) struct Channel {
    pub(crate) node: usize,
    pub(crate) property: Property,
    pub(crate) times: Vec<f64>,
    pub(crate) rows: Vec<Vec<f64>>,
    kind: Interpolation,
}

impl Channel {
    pub(crate) fn at(&self, t: f64) -> Vec<f64> {
        let (times, rows) = (&self.times, &self.rows);
        let step = if self.kind == Interpolation::CubicSpline { 3 } else { 1 };
        let value = |n: usize| &rows[step * n + step / 2];
        if t <= times[0] {
            return value(0).clone();
        }
        if t >= times[times.len() - 1] {
            return value(times.len() - 1).clone();
        }
        let n = times.partition_point(|&key| key <= t);
        let h = times[n] - times[n - 1];
        let u = (t - times[n - 1]) / h;
        let (p, q) = (value(n - 1), value(n));
        if self.property == Property::Rotation {
            // As the specification has it: spherical, by the shortest way.
            let dot: f64 = p.iter().zip(q).map(|(a, b)| a * b).sum();
            let angle = dot.abs().min(1.0).acos();
            if angle < 1e-6 {
                return p.clone();
            }
            let (a, b) = (((1.0 - u) * angle).sin() / angle.sin(), dot.signum() * (u * angle).sin() / angle.sin());
            return p.iter().zip(q).map(|(p, q)| a * p + b * q).collect();
        }
        let cubic = |k: usize| {
            let (m, w) = (h * rows[3 * n - 1][k], h * rows[3 * n][k]);
            let (uu, uuu) = (u * u, u * u * u);
            (2.0 * uuu - 3.0 * uu + 1.0) * p[k]
                + (uuu - 2.0 * uu + u) * m
                + (3.0 * uu - 2.0 * uuu) * q[k]
                + (uuu - uu) * w
        };
        (0..3).map(|k| if step == 3 { cubic(k) } else { p[k] + (q[k] - p[k]) * u }).collect()
    }
}

/// The channels of both animations.
pub(crate) fn channels(glb: &[u8]) -> Vec<Vec<Channel>> {
    let glb = gltf::Gltf::from_slice(glb).unwrap();
    let blob = glb.blob.clone().unwrap();
    let row = |row: &[f32]| row.iter().copied().map(f64::from).collect::<Vec<f64>>();
    let channel = |channel: gltf::animation::Channel<'_>| {
        let reader = channel.reader(|_| Some(&blob));
        let rows = match reader.read_outputs().unwrap() {
            ReadOutputs::Translations(rows) => rows.map(|r| row(&r)).collect(),
            ReadOutputs::Scales(rows) => rows.map(|r| row(&r)).collect(),
            ReadOutputs::Rotations(Rotations::F32(rows)) => rows.map(|r| row(&r)).collect(),
            _ => panic!("no such channel is written"),
        };
        Channel {
            node: channel.target().node().index(),
            property: channel.target().property(),
            times: reader.read_inputs().unwrap().map(f64::from).collect(),
            rows,
            kind: channel.sampler().interpolation(),
        }
    };
    glb.animations().map(|animation| animation.channels().map(channel).collect()).collect()
}

fn rotated([x, y, z, w]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let twice = cross([x, y, z], v).map(|c| 2.0 * c);
    let more = cross([x, y, z], twice);
    std::array::from_fn(|k| v[k] + w * twice[k] + more[k])
}

/// The volume of the ball, of what it is when round, and the height of its lowest point in m.
pub(crate) fn seen(channels: &[Channel], radius: f64, t: f64) -> (f64, f64) {
    let at = |node: usize, property: Property| {
        channels.iter().find(|c| c.node == node && c.property == property).map(|c| c.at(t))
    };
    // The path, and squash and stretch about the ball's middle, of the only ball.
    let path = at(0, Property::Translation).unwrap();
    let (Some(offset), Some(scale)) = (at(2, Property::Translation), at(2, Property::Scale)) else {
        return (1.0, path[1]);
    };
    let turn = at(2, Property::Rotation).map_or([0.0, 0.0, 0.0, 1.0], |q| q.try_into().unwrap());
    // The lowest point of an ellipsoid is as far below its middle as its axes reach together.
    let axes = [[scale[0], 0.0, 0.0], [0.0, scale[1], 0.0], [0.0, 0.0, scale[2]]];
    let reach = axes.map(|axis| rotated(turn, axis)[1].powi(2)).iter().sum::<f64>().sqrt();
    (scale.iter().product(), path[1] + offset[1] - radius * reach)
}
