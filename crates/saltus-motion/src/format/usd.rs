//! USD as text. Time codes are frames. Y is up and (x, y, up) becomes (x, up, -y), or z is and it
//! stays.

use std::fmt::Write;

use super::{Ball, Export, Node, colour};
use crate::curve::{Between, Curve};
use crate::motion::Point;
use crate::space::Up;

/// A place for each frame, and one where a contact begins between two.
pub(super) fn samples(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    stage(export, balls, |usd, name, curve, row| {
        let _ = writeln!(usd, "    double3 xformOp:{name}.timeSamples = {{");
        let rows = curve.keys.iter().map(|key| (key.t, row(key.place)));
        timed(usd, export, curve.between == Between::Hold, rows);
        vec![format!("\"xformOp:{name}\"")]
    })
}

/// Rows of time samples. They are joined by lines: a drawing that stands has one at both of its
/// frames.
fn timed<const N: usize>(
    usd: &mut String,
    export: &Export<'_>,
    held: bool,
    rows: impl Iterator<Item = (f64, [f64; N])>,
) {
    let mut rows = rows.peekable();
    while let Some((t, row)) = rows.next() {
        let frame = export.frames.number(t);
        let cells: Vec<String> = row.iter().map(|c| (c + 0.0).to_string()).collect();
        let _ = writeln!(usd, "        {frame}: ({}),", cells.join(", "));
        if held && rows.peek().is_some() {
            let _ = writeln!(usd, "        {}: ({}),", frame + 1.0, cells.join(", "));
        }
    }
    usd.push_str("    }\n");
}

/// A spline for each axis: Bézier curves whose tangents reach a third of the way.
pub(super) fn splines(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    stage(export, balls, |usd, name, curve, row| {
        let kind = match curve.between {
            Between::Cubic => "curve",
            Between::Line => "linear",
            Between::Hold => "held",
        };
        let mut order = Vec::new();
        for (axis, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
            let _ = writeln!(usd, "    double xformOp:{name}{letter}.spline = {{\n        bezier,");
            let mut before = None;
            for (n, key) in curve.keys.iter().enumerate() {
                let frame = export.frames.number(key.t);
                let after = curve.keys.get(n + 1).map(|next| export.frames.number(next.t));
                let slope = |velocity: Point| row(velocity)[axis] * export.frames.rate.frame() + 0.0;
                let _ = write!(usd, "        {frame}: {}", row(key.place)[axis] + 0.0);
                if let Some(before) = before.filter(|_| kind == "curve") {
                    let _ = write!(usd, "; pre ({}, {})", (frame - before) / 3.0, slope(key.enter));
                }
                let _ = match after {
                    Some(after) if kind == "curve" => {
                        write!(usd, "; post curve ({}, {})", (after - frame) / 3.0, slope(key.leave))
                    }
                    Some(_) => write!(usd, "; post {kind}"),
                    None => Ok(()),
                };
                usd.push_str(",\n");
                before = Some(frame);
            }
            usd.push_str("    }\n");
            order.push(format!("\"xformOp:{name}{letter}\""));
        }
        order
    })
}

/// The map of (x, y, up) into the stage.
type Lie = fn(Point) -> Point;

/// The maps of places, and of scales, which have no sign.
fn lies(export: &Export<'_>) -> [Lie; 2] {
    match export.space.up {
        Some(Up::Z) => [|place| place; 2],
        Some(Up::Y) | None => [|[x, y, up]| [x, up, 0.0 - y], |[x, y, along]| [x, along, y]],
    }
}

/// One operation that moves: written to the text under its name, the names of the attributes
/// returned.
type Move<'a> = &'a dyn Fn(&mut String, &str, &Curve, Lie) -> Vec<String>;

/// The operations of a node.
fn operations(usd: &mut String, export: &Export<'_>, node: &Node<'_>, held: bool, moves: Move<'_>) {
    let mut order = Vec::new();
    let [lie, lie_scale] = lies(export);
    match node.place {
        Some(place) => order.extend(moves(usd, "translate", place, lie)),
        None if node.still != [0.0; 3] => {
            let [x, y, z] = lie(node.still);
            let _ = writeln!(usd, "    double3 xformOp:translate = ({x}, {y}, {z})");
            order.push("\"xformOp:translate\"".to_owned());
        }
        None => {}
    }
    if !node.turns.is_empty() {
        usd.push_str("    quatd xformOp:orient.timeSamples = {\n");
        let rows = node.turns.iter().map(|turn| {
            let [x, y, up, w] = turn.quaternion;
            let [x, y, z] = lie([x, y, up]);
            (turn.t, [w, x, y, z])
        });
        timed(usd, export, held, rows);
        order.push("\"xformOp:orient\"".to_owned());
    }
    if let Some(scale) = node.scale {
        order.extend(moves(usd, "scale", scale, lie_scale));
    }
    if !order.is_empty() {
        let _ = writeln!(usd, "    uniform token[] xformOpOrder = [{}]", order.join(", "));
    }
}

fn stage(
    export: &Export<'_>,
    balls: &[Ball<'_>],
    moves: impl Fn(&mut String, &str, &Curve, Lie) -> Vec<String>,
) -> String {
    let [first, last] = export.range();
    let fps = export.frames.rate.per_second();
    let mut usd = format!(
        "#usda 1.0\n(\n    defaultPrim = \"Scene\"\n    doc = {}\n    metersPerUnit = {}\n    upAxis = \"{}\"\n    startTimeCode = {first}\n    endTimeCode = {last}\n    timeCodesPerSecond = {fps}\n    framesPerSecond = {fps}\n)\n\ndef Xform \"Scene\"\n{{\n",
        quoted(&export.motion.title),
        export.space.unit.metres(),
        export.space.up.unwrap_or(Up::Y).name().to_uppercase()
    );
    for (n, ball) in balls.iter().enumerate() {
        let (radius, [red, green, blue]) = (ball.track.radius, colour(n));
        let _ = writeln!(usd, "def Xform \"Ball{}\" (\n    displayName = {}\n)\n{{", n + 1, quoted(&ball.track.name));
        let nodes = ball.nodes();
        for (k, node) in nodes.iter().enumerate() {
            match k {
                0 => {}
                k if k + 1 < nodes.len() => usd.push_str("    def Xform \"Squash\"\n    {\n"),
                _ => {
                    let _ = write!(
                        usd,
                        "    def Sphere \"Shape\"\n    {{\n    double radius = {radius}\n    float3[] extent = [({0}, {0}, {0}), ({radius}, {radius}, {radius})]\n    color3f[] primvars:displayColor = [({red}, {green}, {blue})]\n",
                        -radius
                    );
                }
            }
            operations(&mut usd, export, node, ball.held(), &moves);
        }
        usd.push_str(&"    }\n".repeat(nodes.len() - 1));
        usd.push_str("}\n");
    }
    let (depth, [lie, _]) = (super::depth(export.motion), lies(export));
    for (n, line) in export.motion.ground.iter().filter(|line| line.len() > 1).enumerate() {
        let points: Vec<String> = line
            .iter()
            .flat_map(|&[x, up]| [-depth, depth].map(|y| lie([x, y, up])))
            .map(|[x, y, z]| format!("({x}, {y}, {z})"))
            .collect();
        let faces: Vec<String> =
            (1..line.len()).map(|k| format!("{}, {}, {}, {}", 2 * k - 2, 2 * k, 2 * k + 1, 2 * k - 1)).collect();
        let _ = write!(
            usd,
            "def Mesh \"Ground{}\"\n{{\n    uniform bool doubleSided = true\n    uniform token subdivisionScheme = \"none\"\n    point3f[] points = [{}]\n    int[] faceVertexCounts = [{}]\n    int[] faceVertexIndices = [{}]\n    color3f[] primvars:displayColor = [(0.6, 0.6, 0.6)]\n}}\n",
            n + 1,
            points.join(", "),
            vec!["4"; faces.len()].join(", "),
            faces.join(", ")
        );
    }
    usd.push_str("}\n");
    usd
}

/// A string on one line between quotes.
fn quoted(text: &str) -> String {
    let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    format!("\"{}\"", clean.replace('\\', "\\\\").replace('"', "\\\""))
}
