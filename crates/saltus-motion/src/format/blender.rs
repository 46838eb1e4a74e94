//! A Python script for Blender: the ball, the floor, and curves whose handles make every flight an
//! exact parabola.

use serde_json::{Value, json};

use super::{Ball, Export, Node, colour};
use crate::curve::{Between, Curve, Key};
use crate::space::Unit;
use crate::turn::Turn;

/// Handles at a third of the time between keys make Blender's curve a plain cubic in time.
const SCRIPT: &str = r#"
import bpy
import json

DATA = json.loads(r'''@DATA@''')


def collection():
    """A collection of its own; what an earlier run of this script has put there is replaced."""
    found = bpy.data.collections.get(DATA["collection"])
    if found is not None and found.get("saltus"):
        for item in list(found.objects):
            data, action = item.data, item.animation_data.action if item.animation_data else None
            paints = [(paint, (bpy.data.materials,)) for paint in getattr(data, "materials", None) or []]
            bpy.data.objects.remove(item, do_unlink=True)
            for block, blocks in ((data, (bpy.data.meshes, bpy.data.cameras, bpy.data.lights)), (action, (bpy.data.actions,)), *paints):
                for kept in blocks:
                    if block is not None and block.users == 0 and kept.get(block.name) == block:
                        kept.remove(block)
                        break
    else:
        found = bpy.data.collections.new(DATA["collection"])
        bpy.context.scene.collection.children.link(found)
    found["saltus"] = True
    return found


def camera_and_light():
    """A camera from the front that sees all of the motion, and a sun; a camera that the scene has stays the one in use."""
    (left, right), (low, high) = DATA["reach"]
    middle, size = (0.5 * (left + right), 0.5 * (low + high)), max(right - left, high - low, 1e-3)
    camera = bpy.data.cameras.new("saltus camera")
    camera.clip_start, camera.clip_end = 0.01 * size, 100.0 * size
    item = bpy.data.objects.new("saltus camera", camera)
    # A lens of 50 mm on 36 mm of film sees 0.72 of its distance across, and 0.4 upwards in 16:9.
    item.location = (middle[0], -1.2 * size / 0.4, middle[1])
    item.rotation_euler = (1.5707963267948966, 0.0, 0.0)
    COLLECTION.objects.link(item)
    if bpy.context.scene.camera is None:
        bpy.context.scene.camera = item
    light = bpy.data.objects.new("saltus sun", bpy.data.lights.new("saltus sun", "SUN"))
    light.data.energy = 3.0
    light.location = (middle[0] - size, -size, high + size)
    light.rotation_euler = (0.7, 0.0, -0.5)
    COLLECTION.objects.link(light)


def curves_of(item):
    """The curves of an object's new action, before and since actions have layers."""
    item.animation_data_create()
    action = bpy.data.actions.new(item.name)
    item.animation_data.action = action
    if not hasattr(action, "slots"):
        return action.fcurves
    slot = action.slots.new(id_type="OBJECT", name=item.name)
    item.animation_data.action_slot = slot
    strip = action.layers.new("Layer").strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True).fcurves


def mesh_object(name, vertices, faces, smooth):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    for polygon in mesh.polygons:
        polygon.use_smooth = smooth
    item = bpy.data.objects.new(name, mesh)
    COLLECTION.objects.link(item)
    return item


def paint(item, name, colour):
    """A material in a colour, in the viewport and in what is rendered."""
    material = bpy.data.materials.new(name)
    material.diffuse_color = colour
    if not material.node_tree:
        material.use_nodes = True
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = colour
    item.data.materials.append(material)


def sphere(name, radius, bottom, colour, stripes, rings=16, sides=32):
    """A sphere with its bottom at a height: at 0 it stands on its origin, so that height 0 is touch."""
    from math import cos, pi, sin
    vertices = [(0.0, 0.0, bottom)]
    for ring in range(1, rings):
        a = pi * ring / rings
        for side in range(sides):
            b = 2.0 * pi * side / sides
            vertices.append((radius * sin(a) * cos(b), radius * sin(a) * sin(b), bottom + radius * (1.0 - cos(a))))
    vertices.append((0.0, 0.0, bottom + 2.0 * radius))
    last = len(vertices) - 1
    faces = []
    for side in range(sides):
        after = (side + 1) % sides
        faces.append((0, 1 + after, 1 + side))
        for ring in range(rings - 2):
            a, b = 1 + ring * sides, 1 + (ring + 1) * sides
            faces.append((a + side, a + after, b + after, b + side))
        top = 1 + (rings - 2) * sides
        faces.append((top + side, top + after, last))
    item = mesh_object(name, vertices, faces, True)
    paint(item, "ball", (*colour, 1.0))
    if stripes:
        # In two colours, so that a turning ball is seen to turn.
        paint(item, "stripe", (0.95, 0.8, 0.6, 1.0))
        for number, polygon in enumerate(item.data.polygons):
            polygon.material_index = number // rings // (sides // 4) % 2
    return item


def key_axes(curves, path, moves):
    """Keys of a curve for each axis; how far they are from what was asked for."""
    found = 0.0
    for axis, keys, checks in zip(moves["axes"], moves["keys"], moves["checks"]):
        curve = curves.new(path, index=axis)
        curve.keyframe_points.add(len(keys))
        for point, (frame, value, left, right) in zip(curve.keyframe_points, keys):
            point.co = (frame, value)
            point.interpolation = moves["interpolation"]
            point.handle_left_type = point.handle_right_type = "FREE"
            point.handle_left = left
            point.handle_right = right
        curve.update()
        if DATA["loops"]:
            curve.modifiers.new(type="CYCLES")
        for frame, value in checks:
            found = max(found, abs(curve.evaluate(frame) - value))
    return found


def key_turns(item, curves, turns):
    """Turning, straight from key to key."""
    item.rotation_mode = turns["mode"]
    path = "rotation_quaternion" if turns["mode"] == "QUATERNION" else "rotation_euler"
    for index, values in turns["values"]:
        curve = curves.new(path, index=index)
        curve.keyframe_points.add(len(values))
        for point, frame, value in zip(curve.keyframe_points, turns["frames"], values):
            point.co = (frame, value)
            point.interpolation = turns["interpolation"]
        curve.update()
        if DATA["loops"]:
            curve.modifiers.new(type="CYCLES")


COLLECTION = collection()
scene = bpy.context.scene
scene.render.fps = DATA["fps"]
scene.render.fps_base = DATA["fps_base"]
scene.frame_start, scene.frame_end = DATA["range"]
if DATA["unit"]:
    # A length of 1 is one of these, and Blender shows it as one; metres are what a scene has that is left alone.
    scene.unit_settings.system = DATA["unit"]["system"]
    scene.unit_settings.scale_length = DATA["unit"]["metres"]
    scene.unit_settings.length_unit = DATA["unit"]["name"]
worst = 0.0
for ball in DATA["balls"]:
    around = None
    for number, node in enumerate(ball["nodes"]):
        if number == len(ball["nodes"]) - 1:
            item = sphere(node["name"], ball["radius"], node["bottom"], ball["colour"], node["turns"] or node["about"])
        else:
            item = bpy.data.objects.new(node["name"], None)
            item.empty_display_size = ball["radius"]
            COLLECTION.objects.link(item)
        item.parent = around
        item.location = node["still"]
        around = item
        if not (node["place"] or node["scale"] or node["turns"] or node["about"]):
            continue
        curves = curves_of(item)
        if node["place"]:
            worst = max(worst, key_axes(curves, "location", node["place"]))
        if node["scale"]:
            worst = max(worst, ball["radius"] * key_axes(curves, "scale", node["scale"]))
        if node["about"]:
            item.rotation_mode = "XYZ"
            worst = max(worst, ball["radius"] * key_axes(curves, "rotation_euler", node["about"]))
        elif node["turns"]:
            key_turns(item, curves, node["turns"])
for number, (vertices, faces) in enumerate(DATA["ground"]):
    item = mesh_object("ground" if number == 0 else "ground %d" % number, vertices, faces, False)
    paint(item, "ground", (0.6, 0.6, 0.6, 1.0))
camera_and_light()
scene.frame_set(DATA["range"][0])
print("saltus: %d balls; the curves are within %.2g %s of the motion" % (len(DATA["balls"]), worst, DATA["lengths"]))
if worst > 1e-5 * DATA["size"]:
    print("saltus: that is more than single precision explains: please do not trust these curves")
"#;

pub(super) fn script(export: &Export<'_>, balls: &[Ball<'_>]) -> String {
    let frames = export.frames;
    let (per, seconds) = frames.rate.fraction();
    // Whole frames per second over a base, as Blender keeps them: 24000/1001 is 24 over 1.001.
    let nominal = f64::from(per) / f64::from(seconds);
    let fps = nominal.ceil();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most 1000
    let whole = fps as u32;
    let balls = balls.iter().enumerate().map(|(number, ball)| {
        let mut nodes: Vec<Value> = ball.nodes().iter().map(|node| chained(export, node, ball.held())).collect();
        let mut bottom = -ball.track.radius;
        if ball.dress.is_none() {
            // A ball that stays round and does not turn is one object that stands on its origin.
            nodes.truncate(1);
            bottom = 0.0;
        }
        if let Some(inner) = nodes.last_mut() {
            inner["bottom"] = json!(bottom);
        }
        json!({ "radius": ball.track.radius, "colour": colour(number), "nodes": nodes })
    });
    let [[left, right], [low, high]] = export.motion.reach();
    let data = json!({
        "unit": unit(export.space.unit), "lengths": export.space.unit.symbol(), "fps": whole, "fps_base": fps / nominal, "range": export.range(), "loops": export.motion.loops,
        "collection": collection(&export.motion.title), "reach": export.motion.reach(),
        "balls": balls.collect::<Vec<_>>(), "ground": ground(export), "size": (right - left).max(high - low).max(1.0),
    });
    // A raw string of Python ends at three quotes only, and JSON has none.
    let data = data.to_string().replace('\'', "\\u0027");
    let head = "# Blender 4 and 5: blender --python FILE, or the Scripting tab. Written by saltus.\n";
    format!("{head}{}", SCRIPT.trim_start().replace("@DATA@", &data).replace("\"fps\":", "\n\"fps\":"))
}

/// A unit as Blender sets it; metres are not set.
fn unit(unit: Unit) -> Option<Value> {
    let (system, name) = match unit {
        Unit::Metre => return None,
        Unit::Centimetre => ("METRIC", "CENTIMETERS"),
        Unit::Millimetre => ("METRIC", "MILLIMETERS"),
        Unit::Inch => ("IMPERIAL", "INCHES"),
        Unit::Foot => ("IMPERIAL", "FEET"),
    };
    Some(json!({ "system": system, "name": name, "metres": unit.metres() }))
}

/// The name of the collection: Blender's names have 63 bytes at most.
fn collection(title: &str) -> String {
    const MOST: usize = 63;
    let name = format!("saltus: {title}");
    let mut end = name.len().min(MOST);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    name[..end].to_owned()
}

/// A node as the script reads it.
fn chained(export: &Export<'_>, node: &Node<'_>, held: bool) -> Value {
    let frames = export.frames;
    // The axes of the curve, and what they are in Blender.
    let moves = |curve: &Curve, axes: &[(usize, usize)]| {
        let keys: Vec<Vec<_>> = axes.iter().map(|&(axis, _)| axis_keys(export, curve, axis)).collect();
        let middles: Vec<f64> = curve.keys.windows(2).map(|pair| 0.5 * (pair[0].t + pair[1].t)).collect();
        let check = |axis: usize| middles.iter().map(|&t| [frames.number(t), curve.at(t)[axis]]).collect::<Vec<_>>();
        json!({
            "axes": axes.iter().map(|axis| axis.1).collect::<Vec<_>>(),
            "keys": keys, "checks": axes.iter().map(|axis| check(axis.0)).collect::<Vec<_>>(),
            "interpolation": match curve.between {
                Between::Cubic => "BEZIER",
                Between::Line => "LINEAR",
                Between::Hold => "CONSTANT",
            },
        })
    };
    // In the plane of x and up one angle does, and may count whole turns.
    let flat = node.turns.iter().all(|turn| turn.quaternion[0] == 0.0 && turn.quaternion[2] == 0.0);
    let values = |of: &dyn Fn(&Turn) -> f64| node.turns.iter().map(of).collect::<Vec<f64>>();
    let turns = (!node.turns.is_empty() && node.about.is_none()).then(|| {
        json!({
            "mode": if flat { "XYZ" } else { "QUATERNION" },
            "interpolation": if held { "CONSTANT" } else { "LINEAR" },
            "frames": values(&|turn| frames.number(turn.t)),
            "values": if flat {
                vec![(1, values(&|turn| 0.0 - turn.angle))]
            } else {
                [3, 0, 1, 2].into_iter().enumerate().map(|(index, part)| (index, values(&|turn| turn.quaternion[part]))).collect()
            },
        })
    });
    let all = |curve: &Curve| moves(curve, &[(0, 0), (1, 1), (2, 2)]);
    json!({
        "name": node.name, "still": node.still, "place": node.place.map(all), "scale": node.scale.map(all), "turns": turns,
        "about": node.about.map(|curve| moves(curve, &[(0, 1)])),
    })
}

/// Frame, value, left handle, right handle.
fn axis_keys(export: &Export<'_>, curve: &Curve, axis: usize) -> Vec<(f64, f64, [f64; 2], [f64; 2])> {
    let frames = export.frames;
    let handle = |key: &Key, slope: f64, by: f64| [frames.number(key.t + by), key.place[axis] + slope * by];
    let third = |a: Option<&Key>, b: Option<&Key>| a.zip(b).map_or(frames.rate.frame(), |(a, b)| b.t - a.t) / 3.0;
    let keys = curve.keys.iter().enumerate().map(|(n, key)| {
        let before = third(n.checked_sub(1).and_then(|n| curve.keys.get(n)), Some(key));
        let after = third(Some(key), curve.keys.get(n + 1));
        let left = handle(key, key.enter[axis], -before);
        (frames.number(key.t), key.place[axis], left, handle(key, key.leave[axis], after))
    });
    keys.collect()
}

/// The vertices and the faces of a strip.
type Strip = (Vec<[f64; 3]>, Vec<[usize; 4]>);

/// Each line of the ground as a strip.
fn ground(export: &Export<'_>) -> Vec<Strip> {
    let depth = super::depth(export.motion);
    let strip = |line: &Vec<[f64; 2]>| {
        let vertices = line.iter().flat_map(|&[x, up]| [[x, -depth, up], [x, depth, up]]).collect();
        (vertices, (1..line.len()).map(|n| [2 * n - 2, 2 * n, 2 * n + 1, 2 * n - 1]).collect())
    };
    export.motion.ground.iter().map(strip).collect()
}
