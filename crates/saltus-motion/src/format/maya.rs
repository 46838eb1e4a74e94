//! A Python script for Maya. Y is up: (x, y, up) becomes (x, up, -y).

use serde_json::{Value, json};

use super::{Ball, Export, ExportError, Node};
use crate::curve::{APART, Between, Curve, Key};
use crate::turn::Turn;

/// What is not sure is in which unit Maya counts the slope of a tangent: the script tries, reads
/// the curve back, and bakes frames if neither fits.
const SCRIPT: &str = r#"
import json
import math
from maya import cmds

DATA = json.loads(r'''@DATA@''')
AXES = ("X", "Y", "Z")


def when(key):
    return "%.12gsec" % (key["t"] + DATA["shift"])


def worst(node, what, moves):
    """How far the curves are from the motion in the middle between keys."""
    found = 0.0
    for axis, letter in enumerate(AXES):
        for check in moves["checks"]:
            value = cmds.getAttr(node + "." + what + letter, time=check["frame"])
            found = max(found, abs(value - check["value"][axis]))
    return found


def tangents(node, what, moves, per_unit):
    for axis, letter in enumerate(AXES):
        for key in moves["keys"]:
            at = (when(key), when(key))
            attribute = what + letter
            angles = [math.degrees(math.atan(key[side][axis] * per_unit)) for side in ("enter", "leave")]
            cmds.keyTangent(node, attribute=attribute, time=at, lock=False)
            cmds.keyTangent(node, attribute=attribute, time=at, inTangentType="fixed", outTangentType="fixed")
            cmds.keyTangent(node, attribute=attribute, time=at, inAngle=angles[0], outAngle=angles[1])


def bake(node, what, moves):
    for axis, letter in enumerate(AXES):
        cmds.cutKey(node, attribute=what + letter, clear=True)
        for key in moves["frames"]:
            cmds.setKeyframe(node, attribute=what + letter, time=when(key), value=key["value"][axis],
                             inTangentType="linear", outTangentType="linear")


def key_axes(node, what, moves, small):
    kind = moves["tangent"]
    extra = {} if kind == "fixed" else {"outTangentType": kind}
    for key in moves["keys"]:
        for axis, letter in enumerate(AXES):
            cmds.setKeyframe(node, attribute=what + letter, time=when(key), value=key["value"][axis], **extra)
    if kind != "fixed":
        return
    centimetres = DATA["centimetres"]
    for per_unit in (DATA["frame"], 1.0, centimetres * DATA["frame"], centimetres):
        tangents(node, what, moves, per_unit)
        if worst(node, what, moves) <= small:
            print("saltus: %s of %s is exact to %.2g" % (what, node, worst(node, what, moves)))
            return
    bake(node, what, moves)
    print("saltus: %s of %s: tangents could not be set exactly; every frame has a key instead" % (what, node))


def key_turns(node, turns):
    for key in turns["keys"]:
        for axis, letter in enumerate(AXES):
            cmds.setKeyframe(node, attribute="rotate" + letter, time=when(key), value=key["value"][axis],
                             inTangentType="linear", outTangentType=turns["tangent"])
    if turns["slerp"]:
        # Angles about three axes are no straight way; the shortest one is.
        cmds.rotationInterpolation(*[node + ".rotate" + letter for letter in AXES], convert="quaternionSlerp")


cmds.currentUnit(linear=DATA["linear"], angle="deg", time=DATA["time"])
for ball in DATA["balls"]:
    around = None
    for number, node in enumerate(ball["nodes"]):
        if number == len(ball["nodes"]) - 1:
            item = cmds.polySphere(radius=ball["radius"], name="ball")[0]
            cmds.move(0, node["lift"], 0, item + ".vtx[*]", relative=True)
            if around:
                item = cmds.parent(item, around, relative=True)[0]
        elif around:
            item = cmds.createNode("transform", name="squash", parent=around)
        else:
            item = cmds.createNode("transform", name="path")
        around = item
        cmds.setAttr(item + ".translate", *node["still"])
        if node["place"]:
            key_axes(item, "translate", node["place"], 1e-6 * DATA["size"])
        if node["scale"]:
            key_axes(item, "scale", node["scale"], 1e-5)
        if node["turns"]:
            key_turns(item, node["turns"])
        if DATA["loops"]:
            cmds.setInfinity(item, preInfinite="cycle", postInfinite="cycle")
for strip in DATA["ground"]:
    for a, b, c, d in strip:
        # The command takes points in the units Maya works in, which are centimetres; where a corner is, is set in the scene's.
        item = cmds.polyCreateFacet(point=[a, b, c, d], name="ground")[0]
        for number, corner in enumerate((a, b, c, d)):
            cmds.xform("%s.vtx[%d]" % (item, number), worldSpace=True, translation=corner)
cmds.playbackOptions(minTime=DATA["range"][0], maxTime=DATA["range"][1],
                     animationStartTime=DATA["range"][0], animationEndTime=DATA["range"][1])
"#;

/// The name of a frame rate in Maya.
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

/// A node as the script reads it.
fn chained(export: &Export<'_>, node: &Node<'_>, ball: &Ball<'_>) -> Value {
    let frames = export.frames;
    let baked = ball.track.samples(frames, true);
    // A frame on which a contact is, but for a share that programs take for the frame, shows the
    // contact.
    let near = |t: f64| ball.track.contacts().find(|contact| (contact - t).abs() < APART * frames.rate.frame());
    let own = |t: f64| near(t).unwrap_or(t);
    let moves = |curve: &Curve, row: fn([f64; 3]) -> [f64; 3]| {
        let key = |key: &Key| json!({ "t": key.t, "value": row(key.place), "enter": row(key.enter), "leave": row(key.leave) });
        let check = |pair: &[Key]| {
            let t = 0.5 * (pair[0].t + pair[1].t);
            json!({ "frame": frames.number(t), "value": row(curve.at(t)) })
        };
        json!({
            "keys": curve.keys.iter().map(key).collect::<Vec<_>>(),
            "tangent": match curve.between {
                Between::Cubic => "fixed",
                Between::Line => "linear",
                Between::Hold => "step",
            },
            "checks": curve.keys.windows(2).map(check).collect::<Vec<_>>(),
            "frames": baked.keys.iter().map(|at| key(&Key { t: at.t, ..curve.key(own(at.t)) })).collect::<Vec<_>>(),
        })
    };
    let flat = node.turns.iter().all(|turn| turn.quaternion[0] == 0.0 && turn.quaternion[2] == 0.0);
    let turn = |turn: &Turn| {
        // About z in the plane of x and up.
        let value = if flat { [0.0, 0.0, turn.angle] } else { euler(turn.quaternion) };
        json!({ "t": turn.t, "value": value.map(f64::to_degrees) })
    };
    let turns = (!node.turns.is_empty()).then(|| {
        json!({
            "keys": node.turns.iter().map(turn).collect::<Vec<_>>(), "slerp": !flat && !ball.held(),
            "tangent": if ball.held() { "step" } else { "linear" },
        })
    });
    json!({
        "still": turned(node.still), "place": node.place.map(|curve| moves(curve, turned)),
        "scale": node.scale.map(|curve| moves(curve, |[x, y, along]| [x, along, y])), "turns": turns,
    })
}

/// Angles about x, then y, then z, in rad, y upwards.
fn euler([x, up, y, w]: [f64; 4]) -> [f64; 3] {
    // The same turn with y upwards, and z where -y was.
    let (x, y, z) = (x, y, -up);
    let sin = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0);
    let about_x = (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y));
    let about_z = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    [about_x, sin.asin(), about_z]
}

pub(super) fn script(export: &Export<'_>, balls: &[Ball<'_>]) -> Result<String, ExportError> {
    let frames = export.frames;
    let balls = balls.iter().map(|ball| {
        let mut nodes: Vec<Value> = ball.nodes().iter().map(|node| chained(export, node, ball)).collect();
        let mut lift = 0.0;
        if ball.dress.is_none() {
            // A ball that stays round and does not turn is one object that stands on its origin, so
            // that height 0 is touch.
            nodes.truncate(1);
            lift = ball.track.radius;
        }
        if let Some(inner) = nodes.last_mut() {
            inner["lift"] = json!(lift);
        }
        json!({ "name": ball.track.name, "radius": ball.track.radius, "nodes": nodes })
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
        "time": unit(export)?, "linear": export.space.unit.symbol(), "centimetres": 100.0 * export.space.unit.metres(), "frame": frames.rate.frame(), "shift": f64::from(frames.first) * frames.rate.frame(),
        "range": export.range(), "size": (right - left).max(high - low).max(1.0),
        "loops": export.motion.loops, "balls": balls.collect::<Vec<_>>(), "ground": export.motion.ground.iter().map(strip).collect::<Vec<_>>(),
    });
    // A raw string of Python ends at three quotes only, and JSON has none.
    let data = data.to_string().replace('\'', "\\u0027");
    let head = "# Maya: Script Editor, Python, File > Load Script. Written by saltus.\n";
    Ok(format!("{head}{}", SCRIPT.trim_start().replace("@DATA@", &data)))
}
