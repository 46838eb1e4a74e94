"""What Blender makes of its script: the lowest point and the volume of each ball at given times, in metres, and what the script says of itself."""
import contextlib
import io
import json
import math
import sys

import bpy

path, times = sys.argv[1], json.loads(sys.argv[2])
bpy.ops.wm.read_factory_settings(use_empty=True)
said = io.StringIO()
kept = []
# Run again, it replaces what it has made.
for _ in range(2):
    with contextlib.redirect_stdout(said):
        script = {"__name__": "__main__"}
        exec(compile(open(path).read(), path, "exec"), script)
    blocks = ("objects", "meshes", "materials", "actions", "cameras", "lights", "collections")
    kept.append({name: len(getattr(bpy.data, name)) for name in blocks})
scene = bpy.context.scene
fps = scene.render.fps / scene.render.fps_base
# In the order in which the script has made them; the ground is a strip of few corners.
balls = [item for item in script["COLLECTION"].objects if item.type == "MESH" and len(item.data.vertices) > 100]
rows = []


def shown(ball):
    heights = [vertex.co.z for vertex in ball.data.vertices]
    radius = 0.5 * (max(heights) - min(heights))
    middle = min(heights) + radius
    world = ball.matrix_world
    up = math.sqrt(sum(world[2][k] ** 2 for k in range(3)))
    low = world[2][2] * middle + world[2][3] - radius * up
    return [scene.unit_settings.scale_length * low, world.to_3x3().determinant()]


for t in times:
    frame = scene.frame_start + t * fps
    whole = math.floor(frame)
    scene.frame_set(whole, subframe=frame - whole)
    rows.append([shown(ball) for ball in balls])
name = "Blender " + bpy.app.version_string
wrong = [line for line in said.getvalue().splitlines() if "do not trust" in line]
wrong += [] if kept[0] == kept[1] else ["run twice it leaves %s, once %s" % (kept[1], kept[0])]
print("\n" + json.dumps({"issues": wrong, "errors": len(wrong), "animations": {name: rows}}))
