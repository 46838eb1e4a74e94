//! Binary glTF 2.0. Y is up: (x, y, up) becomes (x, up, -y).

use std::f64::consts::{PI, TAU};

use serde_json::{Value, json};

use super::{Export, ExportError};
use crate::curve::{Between, Curve};
use crate::motion::Point;

const FLOAT: u32 = 5126;
const SHORT: u32 = 5123;
const ARRAY: u32 = 34962;
const INDICES: u32 = 34963;

/// The binary part and its table of contents.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Rows of floats, with their bounds.
    fn floats<const N: usize>(&mut self, rows: &[[f32; N]], target: Option<u32>) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes, target);
        let bound = |pick: fn(f32, f32) -> f32, from: f32| -> Vec<f64> {
            (0..N).map(|k| f64::from(rows.iter().map(|row| row[k]).fold(from, pick))).collect()
        };
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": rows.len(),
            "type": if N == 1 { "SCALAR" } else { "VEC3" },
            "min": bound(f32::min, f32::INFINITY), "max": bound(f32::max, f32::NEG_INFINITY),
        }));
        self.accessors.len() - 1
    }

    fn indices(&mut self, indices: &[u16]) -> usize {
        let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(INDICES));
        self.accessors.push(json!({
            "bufferView": view, "componentType": SHORT, "count": indices.len(), "type": "SCALAR",
        }));
        self.accessors.len() - 1
    }

    fn mesh(&mut self, name: &str, shape: &Shape, material: usize) -> Value {
        let position = self.floats(&shape.positions, Some(ARRAY));
        let normal = self.floats(&shape.normals, Some(ARRAY));
        let indices = self.indices(&shape.indices);
        json!({ "name": name, "primitives": [{
            "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices, "material": material,
        }] })
    }
}

#[derive(Default)]
struct Shape {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    indices: Vec<u16>,
}

#[allow(clippy::cast_possible_truncation)] // single precision is what the format holds
fn single(p: [f64; 3]) -> [f32; 3] {
    p.map(|x| x as f32 + 0.0)
}

fn turned([x, y, up]: Point) -> [f32; 3] {
    single([x, up, -y])
}

/// A ball around the origin.
fn sphere(radius: f64) -> Shape {
    const RINGS: u16 = 16;
    const SIDES: u16 = 32;
    let mut shape = Shape::default();
    for ring in 0..=RINGS {
        let (sin, cos) = (PI * f64::from(ring) / f64::from(RINGS)).sin_cos();
        for side in 0..=SIDES {
            let angle = TAU * f64::from(side % SIDES) / f64::from(SIDES);
            let normal = [sin * angle.cos(), cos, sin * angle.sin()];
            shape.positions.push(single(normal.map(|n| n * radius)));
            shape.normals.push(single(normal));
        }
    }
    for ring in 0..RINGS {
        for side in 0..SIDES {
            let a = ring * (SIDES + 1) + side;
            let b = a + SIDES + 1;
            if ring > 0 {
                shape.indices.extend([a, a + 1, b + 1]);
            }
            if ring < RINGS - 1 {
                shape.indices.extend([a, b + 1, b]);
            }
        }
    }
    shape
}

/// A strip below a line of the ground; `None` for one without length, or with more corners than indices reach.
fn strip(line: &[[f64; 2]], depth: f64) -> Option<Shape> {
    let mut shape = Shape::default();
    for pair in line.windows(2) {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        let length = (x1 - x0).hypot(y1 - y0);
        if length == 0.0 {
            continue;
        }
        let normal = single([(y0 - y1) / length, (x1 - x0) / length, 0.0]);
        let from = u16::try_from(shape.positions.len()).ok().filter(|&from| from < u16::MAX - 4)?;
        for (x, y, z) in [(x0, y0, depth), (x1, y1, depth), (x1, y1, -depth), (x0, y0, -depth)] {
            shape.positions.push(single([x, y, z]));
            shape.normals.push(normal);
        }
        shape.indices.extend([0, 1, 2, 0, 2, 3].map(|k| from + k));
    }
    (!shape.positions.is_empty()).then_some(shape)
}

/// One animation: a channel for each ball. Tangents are velocities in m/s; the player multiplies by the time between keys.
#[allow(clippy::cast_possible_truncation)] // single precision is what the format holds
fn animation(name: &str, curves: &[Curve], buffer: &mut Buffer) -> Value {
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for (node, curve) in curves.iter().enumerate() {
        // Times have to rise in single precision too.
        let mut keys = curve.keys.clone();
        keys.dedup_by(|later, earlier| {
            let same = later.t as f32 <= earlier.t as f32;
            if same {
                earlier.leave = later.leave;
            }
            same
        });
        let times: Vec<[f32; 1]> = keys.iter().map(|key| [key.t as f32]).collect();
        let (values, kind): (Vec<[f32; 3]>, _) = match curve.between {
            Between::Cubic => {
                let rows = keys.iter().flat_map(|key| [key.enter, key.place, key.leave].map(turned));
                (rows.collect(), "CUBICSPLINE")
            }
            Between::Line => (keys.iter().map(|key| turned(key.place)).collect(), "LINEAR"),
            Between::Hold => (keys.iter().map(|key| turned(key.place)).collect(), "STEP"),
        };
        let (input, output) = (buffer.floats(&times, None), buffer.floats(&values, None));
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": "translation" } }));
        samplers.push(json!({ "input": input, "output": output, "interpolation": kind }));
    }
    json!({ "name": name, "samplers": samplers, "channels": channels })
}

/// The balls are the first nodes; each stands on its origin, so that height 0 is touch.
pub(super) fn binary(export: &Export<'_>, shown: &[Curve], exact: &[Curve]) -> Result<Vec<u8>, ExportError> {
    let motion = export.motion;
    let mut buffer = Buffer::default();
    let (mut nodes, mut meshes) = (Vec::new(), Vec::new());
    let count = motion.tracks.len();
    for (n, track) in motion.tracks.iter().enumerate() {
        let start = turned(track.at(0.0));
        nodes.push(json!({ "name": track.name, "translation": start, "children": [count + n] }));
    }
    for track in &motion.tracks {
        nodes.push(json!({ "name": format!("{} shape", track.name), "mesh": meshes.len(), "translation": [0.0, track.radius, 0.0] }));
        meshes.push(buffer.mesh(&track.name, &sphere(track.radius), 0));
    }
    let depth = super::depth(motion);
    for shape in motion.ground.iter().filter_map(|line| strip(line, depth)) {
        nodes.push(json!({ "name": "ground", "mesh": meshes.len() }));
        meshes.push(buffer.mesh("ground", &shape, 1));
    }
    // The order matters: a reader that plays only one takes the first, and some cannot read cubics.
    let mut animations = vec![animation("frames", shown, &mut buffer)];
    if exact.iter().any(|curve| curve.between == Between::Cubic) {
        animations.push(animation("exact", exact, &mut buffer));
    }
    let roots: Vec<usize> = (0..count).chain(2 * count..nodes.len()).collect();
    let (per, seconds) = export.frames.rate.fraction();
    let material = |name: &str, colour: [f64; 4]| {
        json!({
            "name": name, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.7 },
        })
    };
    let document = json!({
        "asset": {
            "version": "2.0", "generator": concat!("saltus ", env!("CARGO_PKG_VERSION")),
            "extras": { "title": motion.title, "fps": [per, seconds], "startFrame": export.frames.first },
        },
        "scene": 0, "scenes": [{ "name": motion.title, "nodes": roots }], "nodes": nodes, "meshes": meshes,
        "materials": [material("ball", [0.85, 0.33, 0.1, 1.0]), material("ground", [0.6, 0.6, 0.6, 1.0])],
        "animations": animations, "accessors": buffer.accessors, "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    let mut text = serde_json::to_vec(&document)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = |bytes: usize| {
        u32::try_from(bytes)
            .map_err(|_| ExportError("the file would be larger than 4 GB: end the motion earlier".into()))
    };
    let mut file = Vec::new();
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend(length(12 + 8 + text.len() + 8 + buffer.bytes.len())?.to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &buffer.bytes)] {
        file.extend(length(chunk.len())?.to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}
