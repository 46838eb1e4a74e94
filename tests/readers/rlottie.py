"""What rlottie draws of a Lottie: the lowest point of each ball in every frame, in radii above where the ground starts, and how much of that a fifth of a pixel is."""
import json
import math
import sys

import numpy
from rlottie_python import LottieAnimation

LEAST = 2000  # pixels along the longer side
BLUR = 0.2  # of a pixel: what an edge that is drawn in 256 shades does not tell

document = json.loads(open(sys.argv[1]).read())
# A whole number: both sides have whole pixels, and the picture fills them.
scale = math.ceil(LEAST / max(document["w"], document["h"]))
width, height = (scale * document[side] for side in ("w", "h"))
drawn = [layer for layer in document["layers"] if layer["ty"] == 4]
# Layers with shapes: the balls in order, and the ground last.
*balls, ground = drawn
line = next(item for item in ground["shapes"][0]["it"] if item["ty"] == "sh")
start = line["ks"]["k"]["v"][0][1]


def disc(ball):
    """The radius of a ball and how many times as large it is drawn, about its centre."""
    parts = next(shape for shape in ball["shapes"] if shape["nm"] == "ball")["it"]
    part = lambda kind: next(part for part in parts if part["ty"] == kind)["s"]["k"][0]
    return 0.5 * part("el"), part("tr") / 100


def lows(ball, larger):
    """The lowest point in each frame, in the file's pixels."""
    alone = [layer for layer in document["layers"] if layer["ty"] != 4 or layer is ball]
    player = LottieAnimation.from_data(json.dumps(document | {"layers": alone}))
    for frame in range(player.lottie_animation_get_totalframe()):
        pixels = player.lottie_animation_render(frame, width=width, height=height)
        covered = numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 4)[..., 3].max(axis=1) / 255.0
        if not covered.any():
            raise SystemExit("frame %d is blank" % frame)
        # From the highest to the lowest row that anything is in, and how much of them.
        rows = numpy.nonzero(covered)[0]
        top, low = rows[0] + 1 - covered[rows[0]], rows[-1] + covered[rows[-1]]
        yield 0.5 * (low + top + (low - top) / larger) / scale


discs = [disc(ball) for ball in balls]
columns = [[(start - low) / radius for low in lows(ball, larger)] for ball, (radius, larger) in zip(balls, discs)]
rows = [[[low, None] for low in row] for row in zip(*columns)]
found = {"issues": [], "errors": 0, "animations": {"rlottie": rows}}
print("\n" + json.dumps(found | {"blur": [BLUR / (scale * radius) for radius, _ in discs]}))
