#!/usr/bin/env python3
"""Exports scenes in every format, reads the files by the programs they are for, and compares heights with the simulation.

    cargo build --release --bin saltus
    python3 tests/readers/check.py [target/release/saltus] [--blender]

Needs Python and, for what each reads, Node and Chromium; what is not there is said and left out. The readers, at the versions below, are installed
under target/readers: Pixar's USD, Khronos' glTF validator, three.js, lottie-web, LottieFiles' dotlottie-web, and with --blender Blender as a module (300 MB; its
version 5.0 wants Python 3.11). The exit status is 1 if a file is wrong.
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
INSTALLED = ROOT / "target" / "readers"
PYTHON = ["usd-core==26.11"]
BLENDER = ["bpy==5.0.1"]
NODE = ["gltf-validator@2.0.0-dev.3.10", "three@0.187.0", "lottie-web@5.13.0", "@lottiefiles/dotlottie-web@0.80.0"]

SQUASH = """gravity = "9.8 m/s^2"
restitution = 0.55
ball = { radius = "2 cm", height = "1 m", name = "squash ball" }
"""
SCENES = {
    "drop": SQUASH,
    "topspin": (ROOT / "examples/scenes/topspin.toml").read_text(),
    "slow contact": (ROOT / "examples/scenes/slow-contact.toml").read_text(),
}
# Scene, options, unit and axis, and whether heights are those of the simulation at the same times.
CASES = [
    ("drop", [], [], True),
    ("drop", ["--fps", "29.97", "--first-frame", "1"], [], True),
    ("drop", ["--snap", "gravity", "--squash", "0.3", "--stretch", "0.1"], [], False),
    ("drop", ["--loop", "--squash", "0.3"], [], False),
    ("topspin", [], [], True),
    ("topspin", [], ["--units", "cm", "--up", "z"], True),
    ("topspin", [], ["--units", "in"], True),
    ("slow contact", ["--squash", "law", "--stretch", "0.2"], [], False),
    ("slow contact", ["--squash", "law", "--stretch", "0.2"], ["--units", "mm", "--up", "z"], False),
]
# What can be in another unit, with z upwards.
SPACES = {"usd", "usd-splines", "usdz", "blender"}
# How exact a reader may be, beside what the export promises: single precision in Blender, glTF and on screens.
READER = 2e-5
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}


def run(*command, **more):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **more)
    if done.returncode:
        raise RuntimeError("%s\n%s" % (" ".join(map(str, command)), (done.stdout + done.stderr)[-2000:]))
    return done


def install(blender):
    """The interpreter with the readers, and whether Node has its own."""
    python = INSTALLED / "python" / "bin" / "python"
    if not python.exists():
        venv.create(INSTALLED / "python", with_pip=True)
    run(python, "-m", "pip", "install", "-q", *PYTHON, *(BLENDER if blender else []))
    node = shutil.which("node") and shutil.which("npm")
    if node:
        modules = INSTALLED / "node"
        modules.mkdir(parents=True, exist_ok=True)
        (modules / "package.json").write_text('{"private": true}')
        run("npm", "install", "--silent", *NODE, cwd=modules)
        for script in ("glb.mjs", "dotlottie.mjs"):
            shutil.copy(HERE / script, modules)
    return python, bool(node)


def page(folder, svg, player, lottie, times):
    """What a browser finds on the page."""
    browser = next(filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])))
    text = (HERE / "page.html").read_text()
    for mark, value in [("@SVG@", svg), ("@PLAYER@", player), ("@TIMES@", json.dumps(times)), ("@LOTTIE@", lottie)]:
        text = text.replace(mark, value)
    path = folder / "page.html"
    path.write_text(text)
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"]
    dumped = run(browser, *options, path.as_uri()).stdout
    found = re.search(r'<pre id="found">(.+?)</pre>', dumped, re.S)
    if not found:
        raise RuntimeError("the browser found nothing")
    return json.loads(found.group(1))


def readers(python, node, blender, folder):
    """For each format the reader of a file, at times in s."""
    last = lambda done: json.loads(done.stdout.strip().splitlines()[-1])
    script = lambda name: lambda path, times: last(run(python, HERE / name, path, json.dumps(times)))
    known = {"usd": script("usd.py"), "usd-splines": script("usd.py"), "usdz": script("usd.py")}
    if blender:
        known["blender"] = script("blender.py")
    if node:
        modules = INSTALLED / "node"
        known["glb"] = lambda path, times: last(run("node", "glb.mjs", path, json.dumps(times), cwd=modules))
    if any(map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])):
        known["svg"] = lambda path, times: page(folder, path.read_text(), "", "null", times)
        if node:
            player = INSTALLED / "node/node_modules/lottie-web/build/player/lottie_svg.min.js"
            known["lottie"] = lambda path, times: page(folder, "", player.read_text(), path.read_text(), times)

            def dotlottie(path, times):
                """The player for packages says what it plays; heights are those of the animation in it."""
                played = last(run("node", "dotlottie.mjs", path, cwd=modules))
                with zipfile.ZipFile(path) as archive:
                    animation = archive.read("a/%s.json" % played["animations"][0]).decode()
                document = json.loads(animation)
                frames = document["op"] - document["ip"]
                found = page(folder, "", player.read_text(), animation, times)
                if played["version"] != "2" or abs(played["frames"] - frames) > 1e-6 * frames:
                    found["errors"] += 1
                    found["issues"].append("it plays %s, of %s frames" % (played, frames))
                return found

            known["dotlottie"] = dotlottie
    return known


def promised(line):
    """What an export says of itself: the worst height error in m, and the worst change of volume."""
    number, unit = re.search(r"worst height error: (\S+) (mm|cm|m)\b", line).groups()
    volume = re.search(r"volume kept within (\S+) %", line)
    return float(number) * LENGTHS[unit], float(volume.group(1)) / 100 if volume else 0.0


def radius(scene):
    number, unit = re.search(r'radius = "(\S+) (\w+)"', scene).groups()
    return float(number) * LENGTHS[unit]


def closed(t):
    """The height of the drop by its formula."""
    height, speed, g, e = 1.0, 0.0, 9.8, 0.55
    while True:
        span = (speed + (speed * speed + 2 * g * height) ** 0.5) / g
        if t <= span:
            return height + speed * t - 0.5 * g * t * t
        t, height, speed = t - span, 0.0, e * (g * span - speed)


def main():
    blender = "--blender" in sys.argv
    named = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    saltus = Path(named[0] if named else ROOT / "target/release/saltus").resolve()
    python, node = install(blender)
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        known = readers(python, node, blender, folder)
        for name in {"glb", "svg", "lottie", "dotlottie", "blender"} - known.keys():
            print("left out, for its reader is not here: %s" % name)
        for scene, options, space, same in CASES:
            path = folder / "scene.toml"
            path.write_text(SCENES[scene])
            samples = json.loads(run(saltus, "-q", "simulate", path, "--fps", "97", "--format", "json").stdout)["samples"]
            keys = json.loads(run(saltus, "-q", "export", path, *options, "--to", "json").stdout)["balls"][0]["keys"]
            end = max(key["t"] for key in keys if key["contact"] or key is keys[-1])
            rest = [key["t"] for key in keys if key["contact"]][-1]
            truth = {s["t"]: s["height"] for s in samples if s["t"] <= (rest if same else end)}
            if scene == "drop" and same:
                worst = max(abs(closed(t) - height) for t, height in truth.items())
                assert worst < 1e-12, "the simulation is %g m off its formula" % worst
            times = sorted(truth)
            for kind, read in sorted(known.items()):
                if space and kind not in SPACES:
                    continue
                file = folder / ("ball." + {"usd-splines": "usda", "usd": "usda", "blender": "py", "lottie": "json", "dotlottie": "lottie"}.get(kind, kind))
                said = run(saltus, "export", path, *options, *space, "--to", kind, "--force", "-o", file).stderr
                height, volume = promised(said)
                found = read(file, times)
                for animation, rows in found["animations"].items():
                    scale = radius(SCENES[scene]) if kind in ("svg", "lottie", "dotlottie") else 1.0
                    lows = [scale * row[0] for row in rows]
                    off = max(abs(low - truth[t]) for low, t in zip(lows, times)) if same else None
                    below = max(0.0, -min(lows))
                    volumes = [abs(row[1] - 1) for row in rows if row[1] is not None]
                    bad = below > READER + (0 if same else 1e-4) or (off or 0) > height * 1.02 + READER or found["errors"]
                    bad = bad or max(volumes, default=0.0) > 1.05 * volume + 1e-4
                    wrong += bool(bad)
                    print("%-5s %-12s %-44s %-12s %-20s height %-9s below 0 by %.1e m, volume %s" % (
                        "WRONG" if bad else "ok", scene, " ".join(options + space), kind, animation,
                        "-" if off is None else "%.1e" % off, below, "%.2f %%" % (100 * max(volumes)) if volumes else "-"))
                for issue in found["issues"]:
                    print("      %s: %s" % (kind, issue))
    print("%d wrong" % wrong)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
