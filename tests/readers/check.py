#!/usr/bin/env python3
"""Exports scenes in every format, reads the files by the programs they are for, and compares heights with the simulation.

    cargo build --release --bin saltus
    python3 tests/readers/check.py [target/release/saltus] [--blender] [--matrix] [--only=blender,usd] [--rate=30]

With --matrix every example scene at several frame rates, with and without squash, and a table for docs/use/motion.md at the end. With --only those readers alone,
and contacts and sounds; with --rate the rows at that frame rate alone.

Needs Python and, for what each reads, Node and Chromium; what is not there is said and left out. The readers, at the versions below, are installed
under target/readers: Pixar's USD, rlottie, Khronos' glTF validator, three.js, lottie-web, LottieFiles' dotlottie-web, and with --blender Blender 4.5 and 5.0 as
modules (300 MB each; they want Python 3.11). The exit status is 1 if a file is wrong.
"""
import bisect
import csv
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import venv
import wave
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
INSTALLED = ROOT / "target" / "readers"
PYTHON = ["usd-core==26.11", "rlottie-python==1.3.8", "numpy==1.26.4"]
# One of them to a process, and so to an environment.
BLENDERS = {"blender": "bpy==5.0.1", "blender-4.5": "bpy==4.5.15"}
NODE = ["gltf-validator@2.0.0-dev.3.10", "three@0.187.0", "lottie-web@5.13.0", "@lottiefiles/dotlottie-web@0.80.0"]

SQUASH = """gravity = "9.8 m/s^2"
restitution = 0.55
ball = { radius = "2 cm", height = "1 m", name = "squash ball" }
"""
SCENES = {path.stem: path.read_text() for path in sorted((ROOT / "examples/scenes").glob("*.toml"))} | {"drop": SQUASH}
# Scene, options, unit and axis.
CASES = [
    ("drop", [], []),
    ("drop", ["--fps", "29.97", "--first-frame", "1"], []),
    ("drop", ["--snap", "gravity", "--squash", "0.3", "--stretch", "0.1"], []),
    ("drop", ["--loop", "--squash", "0.3"], []),
    ("drop", ["--apexes"], []),
    ("topspin", [], []),
    ("topspin", [], ["--units", "cm", "--up", "z"]),
    ("topspin", [], ["--units", "in"]),
    ("slow-contact", ["--squash", "law", "--stretch", "0.2"], []),
    ("slow-contact", ["--squash", "law", "--stretch", "0.2"], ["--units", "mm", "--up", "z"]),
]
RATES = ["24", "29.97", "30", "60"]
SHAPED = ["--squash", "0.3", "--stretch", "0.1"]
MATRIX = [(name, ["--fps", rate, *shape], []) for name in SCENES for rate in RATES for shape in ([], SHAPED)]
# What can be in another unit, with z upwards.
SPACES = {"usd", "usd-splines", "usdz", *BLENDERS}
# Those that are read from pictures of whole frames.
DRAWN = {"rlottie"}
# What is read by more than one program, by the format's name.
FORMATS = {"rlottie": "lottie", "blender-4.5": "blender"}
# How exact a reader may be, beside what the export promises: single precision in Blender, glTF and on screens.
READER = 2e-5
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}


def run(*command, **more):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **more)
    if done.returncode:
        raise RuntimeError("%s\n%s" % (" ".join(map(str, command)), (done.stdout + done.stderr)[-2000:]))
    return done


def environment(name, packages):
    """The interpreter of an environment with these packages."""
    python = INSTALLED / name / "bin" / "python"
    if not python.exists():
        venv.create(INSTALLED / name, with_pip=True)
    run(python, "-m", "pip", "install", "-q", *packages)
    return python


def install(blender):
    """The interpreters with the readers, by name, and whether Node has its own."""
    pythons = {"python": environment("python", PYTHON)}
    for name, package in BLENDERS.items() if blender else []:
        pythons[name] = environment(name, [package])
    node = shutil.which("node") and shutil.which("npm")
    if node:
        modules = INSTALLED / "node"
        modules.mkdir(parents=True, exist_ok=True)
        (modules / "package.json").write_text('{"private": true}')
        run("npm", "install", "--silent", *NODE, cwd=modules)
        for script in ("glb.mjs", "dotlottie.mjs"):
            shutil.copy(HERE / script, modules)
    return pythons, bool(node)


def page(folder, svg, player, lottie, times):
    """What a browser finds on the page."""
    text = (HERE / "page.html").read_text()
    measure = (HERE / "measure.js").read_text()
    marks = [("@SVG@", svg), ("@MEASURE@", measure), ("@PLAYER@", player), ("@TIMES@", json.dumps(times)), ("@LOTTIE@", lottie)]
    for mark, value in marks:
        text = text.replace(mark, value)
    return dumped(folder, text)


# Behind the page's own script, whose functions it calls as the page's buttons do.
PLAYED = """<pre id="found"></pre><script>
@MEASURE@
{
const balls = [...document.querySelectorAll(".ball")], ground = document.querySelector(".ground");
play(false);
const rows = @TIMES@.map((t) => { go(t); return balls.map((ball) => [height(ball, ground), null]); });
document.getElementById("found").textContent = JSON.stringify({ issues: [], errors: 0, animations: { "its player": rows } });
}
</script></body>"""


def played(folder, path, times):
    """What a browser finds on a page that plays by itself."""
    script = PLAYED.replace("@MEASURE@", (HERE / "measure.js").read_text()).replace("@TIMES@", json.dumps(times))
    return dumped(folder, path.read_text().replace("</body>", script))


def dumped(folder, text):
    """What a script in a page has left in it."""
    browser = next(filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])))
    path = folder / "page.html"
    path.write_text(text)
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000", "--dump-dom"]
    shown = run(browser, *options, path.as_uri()).stdout
    found = re.search(r'<pre id="found">(.+?)</pre>', shown, re.S)
    if not found:
        raise RuntimeError("the browser found nothing")
    return json.loads(found.group(1))


def readers(pythons, node, folder):
    """For each format the reader of a file, at times in s."""
    last = lambda done: json.loads(done.stdout.strip().splitlines()[-1])
    script = lambda name, python="python": lambda path, times: last(run(pythons[python], HERE / name, path, json.dumps(times)))
    known = {kind: script("usd.py") for kind in ("usd", "usd-splines", "usdz")} | {"rlottie": script("rlottie.py")}
    known |= {name: script("blender.py", name) for name in BLENDERS if name in pythons}
    if node:
        modules = INSTALLED / "node"
        known["glb"] = lambda path, times: last(run("node", "glb.mjs", path, json.dumps(times), cwd=modules))
    if any(map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])):
        known["html"] = lambda path, times: played(folder, path, times)
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


def rate(options):
    """The frame rate that the options of an export ask for; 24 where they ask for none."""
    return options[options.index("--fps") + 1] if "--fps" in options else "24"


def length(line, words):
    """A length in m that a closing line says behind some words."""
    found = re.search(words + r" (\S+) (mm|cm|m)\b", line)
    return float(found.group(1)) * LENGTHS[found.group(2)] if found else 0.0


def promised(line):
    """What an export says of itself: the worst height error, how far the outline is moved, how deep the ball is in the ground, in m; the worst change of volume."""
    volume = re.search(r"volume kept within (\S+) %", line)
    words = ["worst height error:", "outline moved by up to", "in what it touches by up to"]
    return [length(line, each) for each in words] + [float(volume.group(1)) / 100 if volume else 0.0]


def closed(t):
    """The height of the drop by its formula."""
    height, speed, g, e = 1.0, 0.0, 9.8, 0.55
    while True:
        span = (speed + (speed * speed + 2 * g * height) ** 0.5) / g
        if span < 1e-9:
            return 0.0
        if t <= span:
            return height + speed * t - 0.5 * g * t * t
        t, height, speed = t - span, 0.0, e * (g * span - speed)


def between(keys, t):
    """The height at a time by cubics with places and velocities at both ends."""
    n = max(1, sum(key["t"] <= t for key in keys[:-1]))
    if n >= len(keys):
        return keys[-1]["place"][2]
    a, b = keys[n - 1], keys[n]
    h = b["t"] - a["t"]
    u = min(max((t - a["t"]) / h, 0.0), 1.0)
    p, q, v, w = a["place"][2], b["place"][2], h * a["leave"][2], h * b["enter"][2]
    return p * (1 + 2 * u) * (1 - u) ** 2 + v * u * (1 - u) ** 2 + q * u * u * (3 - 2 * u) - w * u * u * (1 - u)


def truth(saltus, path, options, balls, name):
    """The heights of the balls at times: those of the simulation, or, where contacts are moved or held, those of the motion as shown."""
    end = max(ball["keys"][-1]["t"] for ball in balls)
    if set(options) & {"--snap", "--squash", "--loop"}:
        times = [k / 97 for k in range(int(end * 97) + 1)]
        return {t: [between(ball["keys"], t) for ball in balls] for t in times}
    samples = json.loads(run(saltus, "-q", "simulate", path, "--fps", "97", "--format", "json").stdout)["samples"]
    heights = {}
    for sample in samples:
        if sample["t"] <= end:
            heights.setdefault(sample["t"], [0.0] * len(balls))[sample.get("ball", 0)] = sample["height"]
    if name == "drop":
        worst = max(abs(closed(t) - low[0]) for t, low in heights.items())
        assert worst < 1e-12, "the simulation is %g m off its formula" % worst
    return heights


def measure(found, truths, balls, start, flat, blur):
    """For an animation how far heights are off, in m, beside what a picture is blurred by, how far below the height 0 and the motion, and how far volumes are from 1."""
    off = below = volume = 0.0
    for rows, heights in zip(found, truths):
        assert len(rows) == len(balls), "%d balls instead of %d" % (len(rows), len(balls))
        for (low, size), height, ball, radii in zip(rows, heights, balls, blur):
            low = start + ball["radius"] * low if flat else low
            # Towards the truth.
            low += min(max(height - low, -radii * ball["radius"]), radii * ball["radius"])
            off, below = max(off, abs(low - height)), max(below, min(0.0, height) - low)
            volume = max(volume, abs(size - 1) if size is not None else 0.0)
    return off, below, volume


SUFFIXES = {"usd-splines": "usda", "usd": "usda", "blender": "py", "lottie": "json", "dotlottie": "lottie"}
FLAT = {"html", "svg", "lottie", "dotlottie"}


def case(saltus, folder, known, name, options, space):
    """A scene in every format: kind, animation, what is measured, what is said, issues."""
    path = folder / "scene.toml"
    path.write_text(SCENES[name])
    # As exact as its keys can be: what the files are compared with.
    try:
        shown = json.loads(run(saltus, "-q", "export", path, *options, "--tolerance", "1e-6m", "--to", "json").stdout)
    except RuntimeError as refused:
        print("      %s %s: %s" % (name, " ".join(options), str(refused).splitlines()[-1]))
        return
    balls, start = shown["balls"], shown["ground"][0][0][1] if shown["ground"] else None
    level = start is not None and all(up == 0 for line in shown["ground"] for _, up in line)
    heights = truth(saltus, path, options, balls, name)
    for kind, late, off, count, bad in [] if space else sounds(saltus, folder, path, options, shown):
        yield kind, "%d contacts" % count, (off, late), None, bad, []
    for kind, read in sorted(known.items()):
        to = FORMATS.get(kind, kind)
        # Flat pictures are measured from the ground.
        flat = to in FLAT
        if space and kind not in SPACES or flat and start is None:
            continue
        file = folder / ("ball." + SUFFIXES.get(to, to))
        said = promised(run(saltus, "export", path, *options, *space, "--to", to, "--force", "-o", file).stderr)
        found = read(file, list(heights))
        true = heights.values()
        if kind in DRAWN:
            frames = [k * shown["fps"][1] / shown["fps"][0] for k in range(len(balls[0]["frames"]))]
            true = [[between(ball["keys"], t) for ball in balls] for t in frames]
        for animation, rows in found["animations"].items():
            off, below, volume = measure(rows, true, balls, start, flat, found.get("blur", [0.0] * len(balls)))
            height, moved, sunk, kept = said
            bad = off > height + moved + READER or volume > kept + READER or found["errors"]
            bad = bad or (level and below > height + sunk + READER)
            yield kind, animation, (off, below if level else 0.0, volume), said, bad, found["issues"]


def listed(file):
    """The contacts of a table: ball, time in s, height in m, speed in m/s."""
    with open(file, newline="") as rows:
        return [(row["ball"], float(row["time_s"]), float(row["height_m"]), float(row["speed_m_per_s"])) for row in csv.DictReader(rows)]


def heard(file, hits):
    """How late the ticks of a sound are, in s at most: the first sample that is as loud as a tick at its start, and no tick where there is no contact."""
    with wave.open(str(file)) as sound:
        rate, count = sound.getframerate(), sound.getnframes()
        assert (sound.getnchannels(), sound.getsampwidth(), rate) == (1, 2, 48000), "a wrong kind of sound"
        samples = struct.unpack("<%dh" % count, sound.readframes(count))
    hits = [hit for hit in hits if hit[3] > 0.0]
    fastest, late = max((hit[3] for hit in hits), default=0.0), 0.0
    for n, (_, t, _, speed) in enumerate(hits):
        # One that rings is not told from the next, nor a tick of less than a step of 16 bits.
        alone = n == 0 or t - hits[n - 1][1] > 0.04
        loud = 0.8 * 32767 * speed / fastest
        if alone and loud > 4.0 and (n + 1 == len(hits) or hits[n + 1][1] - t > 0.001):
            first = next((k for k in range(max(0, int(t * rate) - 480), count) if abs(samples[k]) > 0.9 * loud), count)
            late = max(late, abs(first / rate - t))
    begins = [hit[1] for hit in hits]
    for k, sample in enumerate(samples):
        here = bisect.bisect_right(begins, k / rate + 1e-6)
        assert sample == 0 or here and k / rate - begins[here - 1] < 0.041, "a tick at %g s without a contact" % (k / rate)
    return late


def sounds(saltus, folder, path, options, shown):
    """The list of contacts and the sound of a scene: kind, how late they are in s, how far off in m, whether they are wrong."""
    files = {kind: folder / ("ball." + kind) for kind in ("contacts", "wav")}
    for kind, file in files.items():
        run(saltus, "-q", "export", path, *options, "--to", kind, "--force", "-o", file)
    hits, ends = listed(files["contacts"]), {ball["name"]: ball for ball in shown["balls"]}
    keys = {name: [key["t"] for key in ball["keys"]] for name, ball in ends.items()}
    # Every contact is a key of its ball, and lies where the ball is then.
    late = max((min(abs(t - key) for key in keys[name]) for name, t, *_ in hits), default=0.0)
    off = max((abs(height - between(ends[name]["keys"], t)) for name, t, height, _ in hits), default=0.0)
    # Keys nearer to each other than a hundredth of a frame are one.
    per, seconds = shown["fps"]
    fastest = max((speed for *_, speed in hits), default=0.0)
    yield "contacts", late, off, len(hits), late > 0.01 * seconds / per or off > READER + late * fastest
    late = heard(files["wav"], hits)
    yield "wav", late, 0.0, len(hits), late > 1 / 48000 + 1e-6


def main():
    flags = [argument for argument in sys.argv[1:] if argument.startswith("--")]
    named = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    saltus = Path(named[0] if named else ROOT / "target/release/saltus").resolve()
    pythons, node = install("--blender" in flags)
    wrong, table, times = 0, {}, {}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        known = readers(pythons, node, folder)
        for name in {"glb", "html", "svg", "lottie", "dotlottie", *BLENDERS} - known.keys():
            print("left out, for its reader is not here: %s" % name)
        only = [flag.removeprefix("--only=").split(",") for flag in flags if flag.startswith("--only=")]
        known = {kind: read for kind, read in known.items() if not only or kind in only[0]}
        rates = [flag.removeprefix("--rate=") for flag in flags if flag.startswith("--rate=")]
        rows = MATRIX if "--matrix" in flags else CASES
        for name, options, space in [row for row in rows if not rates or rate(row[1]) in rates]:
            for kind, animation, measured, said, bad, issues in case(saltus, folder, known, name, options, space):
                wrong += bool(bad)
                if said is None:
                    print("%-5s %-16s %-44s %-11s %-20s at most %.2e s late, %.2e m off" % (
                        "WRONG" if bad else "ok", name, " ".join(options), kind, animation, measured[1], measured[0]), flush=True)
                    row = times.setdefault(kind, [0, 0.0])
                    row[0], row[1] = row[0] + 1, max(row[1], measured[1])
                    continue
                print("%-5s %-16s %-44s %-11s %-20s off %.2e of %.2e + %.2e, below 0 by %.1e of %.1e, volume %.2f %% of %.2f %%" % (
                    "WRONG" if bad else "ok", name, " ".join(options + space), kind, animation,
                    measured[0], said[0], said[1], measured[1], said[2], 100 * measured[2], 100 * said[3]), flush=True)
                for issue in issues:
                    print("      %s: %s" % (kind, issue))
                round_, row = "--squash" not in options, table.setdefault(kind, {})
                if round_ or measured[2] >= row.get(False, (0.0, 0.0, 0))[0]:
                    pair = (measured[0], said[0]) if round_ else (measured[2], said[3])
                    row[round_] = max(row.get(round_, (0.0, 0.0)), pair)
                row["count"] = row.get("count", 0) + 1
    print("\n| format | files | worst height error, read | the line says | worst change of volume, read | the line says |\n|---|---|---|---|---|---|")
    for kind, row in sorted(table.items()):
        (off, height), (volume, kept) = row.get(True, (0.0, 0.0)), row.get(False, (0.0, 0.0))
        print("| `%s` | %d | %.3f mm | %.2f mm | %.3f %% | %.2f %% |" % (kind, row["count"], 1e3 * off, 1e3 * height, 100 * volume, 100 * kept))
    for kind, (count, late) in sorted(times.items()):
        print("%d files of %s: contacts at most %.2e s late" % (count, kind, late))
    print("%d wrong" % wrong)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
