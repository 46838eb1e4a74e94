"""What Blender makes of its script: the lowest point and the volume of the ball at given times, in metres, and what the script says of itself."""
import contextlib
import io
import json
import math
import sys

import bpy

path, times = sys.argv[1], json.loads(sys.argv[2])
bpy.ops.wm.read_factory_settings(use_empty=True)
said = io.StringIO()
with contextlib.redirect_stdout(said):
    exec(compile(open(path).read(), path, "exec"), {"__name__": "__main__"})
scene = bpy.context.scene
fps = scene.render.fps / scene.render.fps_base
ball = max((item for item in scene.objects if item.type == "MESH"), key=lambda item: len(item.data.vertices))
heights = [vertex.co.z for vertex in ball.data.vertices]
radius = 0.5 * (max(heights) - min(heights))
middle = min(heights) + radius
rows = []
for t in times:
    frame = scene.frame_start + t * fps
    whole = math.floor(frame)
    scene.frame_set(whole, subframe=frame - whole)
    world = ball.matrix_world
    up = math.sqrt(sum(world[2][k] ** 2 for k in range(3)))
    low = world[2][2] * middle + world[2][3] - radius * up
    rows.append([scene.unit_settings.scale_length * low, world.to_3x3().determinant()])
name = "Blender " + bpy.app.version_string
wrong = [line for line in said.getvalue().splitlines() if "do not trust" in line]
print("\n" + json.dumps({"issues": wrong, "errors": len(wrong), "animations": {name: rows}}))
