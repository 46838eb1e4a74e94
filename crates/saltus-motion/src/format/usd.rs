//! USD as text. Y is up, metres; time codes are frames. (x, y, up) becomes (x, up, -y).

use std::fmt::Write;

use super::Export;
use crate::curve::{Between, Curve};

/// A place for each frame, and one where a contact begins between two.
pub(super) fn samples(export: &Export<'_>, curves: &[Curve]) -> String {
    stage(export, curves, |usd, curve| {
        usd.push_str("    double3 xformOp:translate.timeSamples = {\n");
        let held = curve.between == Between::Hold;
        for (n, key) in curve.keys.iter().enumerate() {
            let [x, y, up] = key.place;
            let frame = export.frames.number(key.t);
            let _ = writeln!(usd, "        {frame}: ({}, {}, {}),", x + 0.0, up + 0.0, 0.0 - y);
            // Samples are joined by lines: a drawing that stands has one at both of its frames.
            if held && n + 1 < curve.keys.len() {
                let _ = writeln!(usd, "        {}: ({}, {}, {}),", frame + 1.0, x + 0.0, up + 0.0, 0.0 - y);
            }
        }
        usd.push_str("    }\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n");
    })
}

/// A spline for each axis: Bézier curves whose tangents reach a third of the way.
pub(super) fn splines(export: &Export<'_>, curves: &[Curve]) -> String {
    stage(export, curves, |usd, curve| {
        let kind = match curve.between {
            Between::Cubic => "curve",
            Between::Line => "linear",
            Between::Hold => "held",
        };
        for (name, axis, sign) in [("X", 0, 1.0), ("Y", 2, 1.0), ("Z", 1, -1.0)] {
            let _ = writeln!(usd, "    double xformOp:translate{name}.spline = {{\n        bezier,");
            let mut before = None;
            for (n, key) in curve.keys.iter().enumerate() {
                let frame = export.frames.number(key.t);
                let after = curve.keys.get(n + 1).map(|next| export.frames.number(next.t));
                let slope = |velocity: [f64; 3]| sign * velocity[axis] * export.frames.rate.frame() + 0.0;
                let _ = write!(usd, "        {frame}: {}", sign * key.place[axis] + 0.0);
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
        }
        let order = "\"xformOp:translateX\", \"xformOp:translateY\", \"xformOp:translateZ\"";
        let _ = writeln!(usd, "    uniform token[] xformOpOrder = [{order}]");
    })
}

fn stage(export: &Export<'_>, curves: &[Curve], motion: impl Fn(&mut String, &Curve)) -> String {
    let [first, last] = export.range();
    let fps = export.frames.rate.per_second();
    let mut usd = format!(
        "#usda 1.0\n(\n    defaultPrim = \"Scene\"\n    doc = {}\n    metersPerUnit = 1\n    upAxis = \"Y\"\n    startTimeCode = {first}\n    endTimeCode = {last}\n    timeCodesPerSecond = {fps}\n    framesPerSecond = {fps}\n)\n\ndef Xform \"Scene\"\n{{\n",
        quoted(&export.motion.title)
    );
    for (n, (track, curve)) in export.motion.tracks.iter().zip(curves).enumerate() {
        let radius = track.radius;
        let _ = writeln!(usd, "def Xform \"Ball{}\" (\n    displayName = {}\n)\n{{", n + 1, quoted(&track.name));
        motion(&mut usd, curve);
        let _ = write!(
            usd,
            "    def Sphere \"Shape\"\n    {{\n        double radius = {radius}\n        float3[] extent = [({0}, {0}, {0}), ({radius}, {radius}, {radius})]\n        color3f[] primvars:displayColor = [(0.85, 0.33, 0.1)]\n        double3 xformOp:translate = (0, {radius}, 0)\n        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n    }}\n}}\n",
            -radius
        );
    }
    let depth = super::depth(export.motion);
    for (n, line) in export.motion.ground.iter().filter(|line| line.len() > 1).enumerate() {
        let points: Vec<String> =
            line.iter().flat_map(|&[x, up]| [depth, -depth].map(|z| format!("({x}, {up}, {z})"))).collect();
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
