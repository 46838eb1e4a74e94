//! A Python script for Maya. Y is up: (x, y, up) becomes (x, up, -y).

use serde_json::json;

use super::{Export, ExportError};
use crate::curve::{Between, Curve, Key};

/// What is not sure is in which unit Maya counts the slope of a tangent: the script tries, reads the curve back, and bakes frames if neither fits.
const SCRIPT: &str = r#"
import json
import math
from maya import cmds

DATA = json.loads(r'''@DATA@''')
ATTRIBUTES = ("translateX", "translateY", "translateZ")


def when(key):
    return "%.12gsec" % (key["t"] + DATA["shift"])


def worst(node, ball):
    """How far the curves are from the motion in the middle between keys, in m."""
    found = 0.0
    for axis, attribute in enumerate(ATTRIBUTES):
        for check in ball["checks"]:
            value = cmds.getAttr(node + "." + attribute, time=check["frame"])
            found = max(found, abs(value - check["place"][axis]))
    return found


def tangents(node, ball, per_unit):
    for axis, attribute in enumerate(ATTRIBUTES):
        for key in ball["keys"]:
            at = (when(key), when(key))
            angles = [math.degrees(math.atan(key[side][axis] * per_unit)) for side in ("enter", "leave")]
            cmds.keyTangent(node, attribute=attribute, time=at, lock=False)
            cmds.keyTangent(node, attribute=attribute, time=at, inTangentType="fixed", outTangentType="fixed")
            cmds.keyTangent(node, attribute=attribute, time=at, inAngle=angles[0], outAngle=angles[1])


def bake(node, ball):
    for attribute in ATTRIBUTES:
        cmds.cutKey(node, attribute=attribute, clear=True)
    for key in ball["frames"]:
        for axis, attribute in enumerate(ATTRIBUTES):
            cmds.setKeyframe(node, attribute=attribute, time=when(key), value=key["place"][axis],
                             inTangentType="linear", outTangentType="linear")


cmds.currentUnit(linear="m", time=DATA["time"])
for ball in DATA["balls"]:
    node = cmds.polySphere(radius=ball["radius"], name="ball")[0]
    # The ball stands on its origin, so that height 0 is touch.
    cmds.move(0, ball["radius"], 0, node + ".vtx[*]", relative=True)
    kind = ball["tangent"]
    for key in ball["keys"]:
        for axis, attribute in enumerate(ATTRIBUTES):
            extra = {} if kind == "fixed" else {"outTangentType": kind}
            cmds.setKeyframe(node, attribute=attribute, time=when(key), value=key["place"][axis], **extra)
    if kind == "fixed":
        small = 1e-6 * DATA["size"]
        for per_unit in (DATA["frame"], 1.0, 100.0 * DATA["frame"], 100.0):
            tangents(node, ball, per_unit)
            if worst(node, ball) <= small:
                print("saltus: %s is exact to %.2g m" % (ball["name"], worst(node, ball)))
                break
        else:
            bake(node, ball)
            print("saltus: %s: tangents could not be set exactly; every frame has a key instead" % ball["name"])
for strip in DATA["ground"]:
    for a, b, c, d in strip:
        cmds.polyCreateFacet(point=[a, b, c, d], name="ground")
cmds.playbackOptions(minTime=DATA["range"][0], maxTime=DATA["range"][1],
                     animationStartTime=DATA["range"][0], animationEndTime=DATA["range"][1])
"#;

/// What Maya calls a frame rate.
fn unit(export: &Export<'_>) -> Result<&'static str, ExportError> {
    let rate = export.frames.rate;
    Ok(match rate.fraction() {
        (15, 1) => "game",
        (24, 1) => "film",
        (25, 1) => "pal",
        (30, 1) => "ntsc",
        (48, 1) => "show",
        (50, 1) => "palf",
        (60, 1) => "ntscf",
        (12, 1) => "12fps",
        (120, 1) => "120fps",
        (24_000, 1001) => "23.976fps",
        (30_000, 1001) => "29.97fps",
        (48_000, 1001) => "47.952fps",
        (60_000, 1001) => "59.94fps",
        _ => {
            return Err(ExportError(format!(
                "Maya has no rate of {rate} frames per second: use 12, 15, 24, 25, 30, 48, 50, 60, 120, 23.976, 29.97, 47.952 or 59.94"
            )));
        }
    })
}

fn turned([x, y, up]: [f64; 3]) -> [f64; 3] {
    [x, up, 0.0 - y]
}

pub(super) fn script(export: &Export<'_>, curves: &[Curve]) -> Result<String, ExportError> {
    let frames = export.frames;
    let balls = export.motion.tracks.iter().zip(curves).map(|(track, curve)| {
        let key = |key: &Key| {
            json!({ "t": key.t, "place": turned(key.place), "enter": turned(key.enter), "leave": turned(key.leave) })
        };
        let check = |pair: &[Key]| {
            let t = 0.5 * (pair[0].t + pair[1].t);
            json!({ "frame": frames.number(t), "place": turned(curve.at(t)) })
        };
        let baked = track.samples(frames, false);
        json!({
            "name": track.name, "radius": track.radius, "keys": curve.keys.iter().map(key).collect::<Vec<_>>(),
            "tangent": match curve.between {
                Between::Cubic => "fixed",
                Between::Line => "linear",
                Between::Hold => "step",
            },
            "checks": curve.keys.windows(2).map(check).collect::<Vec<_>>(),
            "frames": baked.keys.iter().map(key).collect::<Vec<_>>(),
        })
    });
    let depth = super::depth(export.motion);
    let strip = |line: &Vec<[f64; 2]>| {
        let face = |pair: &[[f64; 2]]| {
            let ([a, b], [c, d]) = (pair[0], pair[1]);
            [[a, b, depth], [c, d, depth], [c, d, -depth], [a, b, -depth]]
        };
        line.windows(2).map(face).collect::<Vec<_>>()
    };
    let [[left, right], [low, high]] = export.motion.reach();
    let data = json!({
        "time": unit(export)?, "frame": frames.rate.frame(), "shift": f64::from(frames.first) * frames.rate.frame(),
        "range": export.range(), "size": (right - left).max(high - low).max(1.0),
        "balls": balls.collect::<Vec<_>>(), "ground": export.motion.ground.iter().map(strip).collect::<Vec<_>>(),
    });
    // A raw string of Python ends at three quotes only, and JSON has none.
    let data = data.to_string().replace('\'', "\\u0027");
    let head = "# Maya: Script Editor, Python, File > Load Script. Written by saltus.\n";
    Ok(format!("{head}{}", SCRIPT.trim_start().replace("@DATA@", &data)))
}
