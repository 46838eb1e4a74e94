//! Binary glTF 2.0. Y is up: (x, y, up) becomes (x, up, -y).

use std::f64::consts::{PI, TAU};

use serde_json::{Value, json};

use super::{Ball, Export, ExportError, colour};
use crate::curve::{Between, Curve};
use crate::motion::Point;
use crate::turn::Turn;

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
    materials: Vec<Value>,
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
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        self.accessors.push(json!({
            "bufferView": view, "componentType": FLOAT, "count": rows.len(),
            "type": kind,
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

    /// A material, made where it is first used.
    fn material(&mut self, name: &str, [r, g, b]: [f64; 3]) -> usize {
        let material = json!({
            "name": name, "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.7 },
        });
        let found = self.materials.iter().position(|other| *other == material);
        found.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        })
    }

    fn mesh(&mut self, name: &str, shape: &Shape, materials: &[usize]) -> Value {
        let position = self.floats(&shape.positions, Some(ARRAY));
        let normal = self.floats(&shape.normals, Some(ARRAY));
        let primitives = materials.iter().zip(&shape.indices).map(|(material, indices)| {
            let indices = self.indices(indices);
            json!({ "attributes": { "POSITION": position, "NORMAL": normal }, "indices": indices, "material": material })
        });
        json!({ "name": name, "primitives": primitives.collect::<Vec<_>>() })
    }

    /// A ball; one that turns is in two colours, which show its turning.
    fn ball(&mut self, number: usize, ball: &Ball<'_>, turns: bool) -> Value {
        let mut shape = sphere(ball.track.radius);
        let mut materials = vec![self.material("ball", colour(number))];
        if turns {
            materials.push(self.material("stripe", [0.95, 0.8, 0.6]));
        } else {
            shape.indices = vec![shape.indices.concat()];
        }
        self.mesh(&ball.track.name, &shape, &materials)
    }
}

#[derive(Default)]
struct Shape {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// The indices of triangles, by colour.
    indices: Vec<Vec<u16>>,
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
    shape.indices = vec![Vec::new(); 2];
    for ring in 0..RINGS {
        for side in 0..SIDES {
            let indices = &mut shape.indices[usize::from(side / (SIDES / 4) % 2 == 1)];
            let a = ring * (SIDES + 1) + side;
            let b = a + SIDES + 1;
            if ring > 0 {
                indices.extend([a, a + 1, b + 1]);
            }
            if ring < RINGS - 1 {
                indices.extend([a, b + 1, b]);
            }
        }
    }
    shape
}

/// A strip below a line of the ground; `None` for one without length, or with more corners than
/// indices reach.
fn strip(line: &[[f64; 2]], depth: f64) -> Option<Shape> {
    let mut shape = Shape::default();
    let mut indices = Vec::new();
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
        indices.extend([0, 1, 2, 0, 2, 3].map(|k| from + k));
    }
    shape.indices.push(indices);
    (!shape.positions.is_empty()).then_some(shape)
}

/// Channels of an animation.
struct Channels<'a> {
    buffer: &'a mut Buffer,
    samplers: Vec<Value>,
    channels: Vec<Value>,
}

/// Times have to rise in single precision too: of two that do not, the place and the way in of the
/// earlier, the way out of the later.
#[allow(clippy::cast_possible_truncation)] // single precision is what the format holds
fn rising<K: Copy>(keys: &[K], t: impl Fn(&K) -> f64, join: impl Fn(&mut K, &K)) -> (Vec<K>, Vec<[f32; 1]>) {
    let mut keys = keys.to_vec();
    keys.dedup_by(|later, earlier| {
        let same = t(later) as f32 <= t(earlier) as f32;
        if same {
            join(earlier, later);
        }
        same
    });
    let times = keys.iter().map(|key| [t(key) as f32]).collect();
    (keys, times)
}

impl Channels<'_> {
    fn push<const N: usize>(&mut self, (node, path): (usize, &str), times: &[[f32; 1]], rows: &[[f32; N]], kind: &str) {
        let (input, output) = (self.buffer.floats(times, None), self.buffer.floats(rows, None));
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": { "node": node, "path": path } }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": kind }));
    }

    /// Tangents are velocities in m/s; the player multiplies by the time between keys.
    fn curve(&mut self, target: (usize, &str), curve: &Curve, row: impl Fn(Point) -> [f32; 3]) {
        let (keys, times) = rising(&curve.keys, |key| key.t, |earlier, later| earlier.leave = later.leave);
        let (rows, kind): (Vec<[f32; 3]>, _) = match curve.between {
            Between::Cubic => {
                let rows = keys.iter().flat_map(|key| [key.enter, key.place, key.leave].map(&row));
                (rows.collect(), "CUBICSPLINE")
            }
            Between::Line => (keys.iter().map(|key| row(key.place)).collect(), "LINEAR"),
            Between::Hold => (keys.iter().map(|key| row(key.place)).collect(), "STEP"),
        };
        self.push(target, &times, &rows, kind);
    }

    /// Straight lines between quaternions are the shortest ways between orientations.
    #[allow(clippy::cast_possible_truncation)] // single precision is what the format holds
    fn turns(&mut self, node: usize, turns: &[Turn], held: bool) {
        let (keys, times) = rising(turns, |turn| turn.t, |earlier, later| *earlier = *later);
        let row = |turn: &Turn| {
            let [x, y, up, w] = turn.quaternion;
            [x, up, -y, w].map(|c| c as f32 + 0.0)
        };
        let rows: Vec<[f32; 4]> = keys.iter().map(row).collect();
        self.push((node, "rotation"), &times, &rows, if held { "STEP" } else { "LINEAR" });
    }
}

/// The numbers of the nodes that are the path, the squash and the shape of each ball.
fn numbered(ball: usize, balls: usize, nodes: usize) -> Vec<usize> {
    // The paths of all balls come first, then what they carry.
    if nodes == 2 { vec![ball, balls + ball] } else { vec![ball, 2 * balls + ball, balls + ball] }
}

/// One animation: the channels of each ball.
fn animation(name: &str, balls: &[Ball<'_>], buffer: &mut Buffer) -> Value {
    let mut out = Channels { buffer, samplers: Vec::new(), channels: Vec::new() };
    for (n, ball) in balls.iter().enumerate() {
        let nodes = ball.nodes();
        for (number, node) in numbered(n, balls.len(), nodes.len()).into_iter().zip(&nodes) {
            if let Some(place) = node.place {
                out.curve((number, "translation"), place, turned);
            }
            if !node.turns.is_empty() {
                out.turns(number, node.turns, ball.held());
            }
            if let Some(scale) = node.scale {
                out.curve((number, "scale"), scale, |[x, y, along]| single([x, along, y]));
            }
        }
    }
    json!({ "name": name, "samplers": out.samplers, "channels": out.channels })
}

/// The balls are the first nodes; each stands on its origin, so that height 0 is touch.
fn parts(export: &Export<'_>, shown: &[Ball<'_>], exact: &[Ball<'_>]) -> (Value, Vec<u8>) {
    let motion = export.motion;
    let mut buffer = Buffer::default();
    let mut meshes = Vec::new();
    let count = motion.tracks.len();
    // Of each ball its path and what is at its end; then, if there are any, the nodes between.
    let (mut paths, mut shapes, mut between) = (Vec::new(), Vec::new(), Vec::new());
    for (n, ball) in shown.iter().enumerate() {
        let nodes = ball.nodes();
        let numbers = numbered(n, count, nodes.len());
        for (k, node) in nodes.iter().enumerate() {
            let start = node.place.map_or(node.still, |place| place.at(0.0));
            let mut value = json!({ "name": node.name, "translation": turned(start) });
            if let Some(inner) = numbers.get(k + 1) {
                value["children"] = json!([inner]);
                if k == 0 { paths.push(value) } else { between.push(value) }
            } else {
                value["mesh"] = json!(meshes.len());
                meshes.push(buffer.ball(n, ball, !node.turns.is_empty()));
                shapes.push(value);
            }
        }
    }
    let mut nodes = [paths, shapes, between].concat();
    let carried = nodes.len();
    let depth = super::depth(motion);
    for shape in motion.ground.iter().filter_map(|line| strip(line, depth)) {
        nodes.push(json!({ "name": "ground", "mesh": meshes.len() }));
        let material = buffer.material("ground", [0.6, 0.6, 0.6]);
        meshes.push(buffer.mesh("ground", &shape, &[material]));
    }
    // The order matters: a reader that plays only one takes the first, and some cannot read cubics.
    let mut animations = vec![animation("frames", shown, &mut buffer)];
    if exact.iter().any(|ball| ball.path.between == Between::Cubic) {
        animations.push(animation("exact", exact, &mut buffer));
    }
    let roots: Vec<usize> = (0..count).chain(carried..nodes.len()).collect();
    let (per, seconds) = export.frames.rate.fraction();
    let document = json!({
        "asset": {
            "version": "2.0", "generator": concat!("saltus ", env!("CARGO_PKG_VERSION")),
            "extras": { "title": motion.title, "fps": [per, seconds], "startFrame": export.frames.first, "loops": motion.loops },
        },
        "scene": 0, "scenes": [{ "name": motion.title, "nodes": roots }], "nodes": nodes, "meshes": meshes,
        "materials": buffer.materials,
        "animations": animations, "accessors": buffer.accessors, "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    (document, buffer.bytes)
}

/// All of it as text, the numbers in base64 (RFC 4648).
pub(super) fn text(export: &Export<'_>, shown: &[Ball<'_>], exact: &[Ball<'_>]) -> Result<String, ExportError> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut document, bytes) = parts(export, shown, exact);
    let mut uri = String::from("data:application/octet-stream;base64,");
    for three in bytes.chunks(3) {
        let bits = three.iter().fold(0_u32, |bits, &byte| bits << 8 | u32::from(byte)) << (8 * (3 - three.len()));
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k) & 63) as usize];
            uri.push(if k <= three.len() { char::from(digit) } else { '=' });
        }
    }
    document["buffers"][0]["uri"] = json!(uri);
    Ok(serde_json::to_string(&document)? + "\n")
}

/// The file as one binary.
pub(super) fn binary(export: &Export<'_>, shown: &[Ball<'_>], exact: &[Ball<'_>]) -> Result<Vec<u8>, ExportError> {
    let (document, bytes) = parts(export, shown, exact);
    let mut text = serde_json::to_vec(&document)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = |bytes: usize| {
        u32::try_from(bytes)
            .map_err(|_| ExportError("the file would be larger than 4 GB: end the motion earlier".into()))
    };
    let mut file = Vec::new();
    file.extend(b"glTF");
    file.extend(2_u32.to_le_bytes());
    file.extend(length(12 + 8 + text.len() + 8 + bytes.len())?.to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bytes)] {
        file.extend(length(chunk.len())?.to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    Ok(file)
}
