"""Scenes: the motion of the tool, from text, dicts and keys."""

import json
import pickle
import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import saltus

ROOT = Path(__file__).parents[3]
SCENES = sorted((ROOT / "examples/scenes").glob("*.toml"))


def said(tool, *args):
    done = subprocess.run([tool, "-q", *args], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.name)
def test_the_same_motion_as_the_tool(tool, path):
    motion = saltus.simulate(path)
    assert motion.to_json(fps=24) == said(tool, "simulate", path, "--format", "json", "--fps", "24")
    assert str(motion) == said(tool, "simulate", path).rstrip()
    assert saltus.explain(path) == said(tool, "explain", path)
    assert motion.plot() == said(tool, "simulate", path, "--plot", "-")
    frame = motion.to_frame(every=0.05)
    lines = said(tool, "simulate", path, "--format", "csv", "--every", "50ms").splitlines()
    assert list(frame.columns) == lines[0].split(",") and len(frame) == len(lines) - 1
    assert [float(line.split(",")[0]) for line in lines[1:]] == frame["time_s"].tolist()


def test_text_dict_keys_and_file_are_one_scene(tmp_path):
    keys = {"restitution": 0.8, "ball": {"height": "1 m", "name": 'a "ball"'}, "run": {"until": 2.0}}
    text = saltus.Scene(keys).toml
    path = tmp_path / "ball.toml"
    path.write_text(text)
    ways = [keys, text, text.encode(), path, str(path), saltus.Scene(path)]
    times = [saltus.simulate(way).impacts["t"].tolist() for way in ways]
    times.append(saltus.simulate(**keys).impacts["t"].tolist())
    assert all(t == times[0] for t in times) and len(times[0]) == 3


@settings(max_examples=100, deadline=None)
@given(st.text())
def test_any_name_is_written_so_that_it_is_read_back(name):
    scene = saltus.Scene(restitution=0.5, ball={"height": 1.0, "name": name})
    try:
        motion = saltus.simulate(scene)
    except saltus.SceneError as error:
        assert "name" in str(error) or name in str(error)
    else:
        assert motion.rest > 0


@settings(max_examples=60, deadline=None)
@given(st.floats(0.2, 0.95), st.floats(0.1, 10))
def test_both_limits_and_energy(cor, height):
    motion = saltus.simulate(gravity=9.8, restitution=cor, ball={"height": height}, most_jumps=20)
    t = motion.impacts["t"][:5]
    before, after = motion.at(t, before=True), motion.at(t)
    assert after.velocity[:, 2] == pytest.approx(-cor * before.velocity[:, 2], rel=1e-12)
    assert before.position == pytest.approx(after.position, abs=1e-12)
    middle = 0.5 * (t[1:] + t[:-1])
    assert motion.energy(middle) == pytest.approx(9.8 * height * cor ** (2 * np.arange(1, 5)), rel=1e-9)
    assert motion.apexes()[0] == pytest.approx([t[0] + cor * t[0], cor**2 * height], rel=1e-9)


@pytest.mark.parametrize("name", ["glb", "gltf", "usda", "usdz", "lottie", "svg", "html", "csv", "wav"])
def test_exports_are_those_of_the_tool(tool, tmp_path, name):
    path = ROOT / "examples/scenes/squash.toml"
    says = saltus.simulate(path).export(tmp_path / f"a.{name}")
    said(tool, "export", path, "-o", tmp_path / f"b.{name}")
    assert (tmp_path / f"a.{name}").read_bytes() == (tmp_path / f"b.{name}").read_bytes()
    assert "error" in says or "keys" in says or says


def test_a_fit_goes_on_as_a_scene():
    scene = saltus.fit([100, 64, 41, 26], "cm", sigma_height="5 mm").scene()
    motion = saltus.simulate(scene)
    assert motion.impacts["cor"][0] == pytest.approx(0.8, abs=0.01)


def test_a_run_is_pickled():
    motion = saltus.simulate(restitution=0.8, ball={"height": 1.0}, until=1.5)
    again = pickle.loads(pickle.dumps(motion))
    assert again.to_json() == motion.to_json() and again.until == 1.5


def test_wishes_come_true():
    solved = saltus.solve(["touch 1 at frame 24", "apex 2 at 60cm"], ["throw", "cor"])
    motion = saltus.simulate(solved.scene)
    assert solved.meets and len(solved.says) >= 2
    assert motion.impacts["t"][0] == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        (lambda: saltus.simulate("there is none.toml"), saltus.SceneError, "cannot read 'there is none.toml'"),
        (lambda: saltus.simulate(resitution=0.5), saltus.SceneError, "restitution"),
        (lambda: saltus.simulate(restitution=1.5, ball={"height": 1.0}), saltus.SceneError, "1.5"),
        (lambda: saltus.simulate(restitution=0.5, ball={"height": "1 kg"}), saltus.SceneError, "kg"),
        (lambda: saltus.simulate(restitution=float("nan"), ball={"height": 1.0}), saltus.SceneError, "nan|NaN"),
        (lambda: saltus.simulate(restitution=0.5, ball=object()), TypeError, "no object"),
        (lambda: saltus.simulate(7), TypeError, "int is no scene"),
        (lambda: saltus.simulate("restitution = 0.5\n", ball={}), TypeError, "keys go with"),
        (lambda: saltus.solve("jump at once", "throw"), ValueError, "jump at once"),
        (lambda: saltus.solve("touch 1 at frame 24", "colour"), saltus.SceneError, "colour"),
        (lambda: saltus.simulate(restitution=0.5, ball={"height": 1.0}).plot("x"), ValueError, "'x' is no picture"),
        (lambda: saltus.simulate(restitution=0.5, ball={"height": 1.0}).export("a.doc"), ValueError, "'.doc'"),
        (lambda: saltus.simulate(restitution=0.5, ball={"height": 1.0}).table(every=0), ValueError, "samples"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_in_words(given, error, says):
    with pytest.raises(error, match=says):
        given()


def test_the_report_of_a_scene_is_json():
    motion = saltus.simulate(restitution=0.8, ball={"height": 1.0})
    assert json.loads(motion.to_json())["schema"] == 1
    assert motion.table()["mode"][0] == "flight" and motion.balls == 1 and motion.doubts == []
    assert np.isnan(motion.height(1e6)) and np.isnan(motion.at(0.1, ball=3).position).all()


def test_accuracy_says_what_the_tool_says(tool):
    scene = ROOT / "examples/scenes/topspin.toml"
    costs = saltus.accuracy(scene, length="1 um", time=None)
    said = subprocess.run(
        [tool, "-q", "accuracy", scene, "--target", "1um", "--format", "json"], capture_output=True, text=True
    )
    tools = json.loads(said.stdout)
    # Times differ from run to run.
    alike = [{key: row[key] for key in row if not key.startswith("seconds")} for row in costs.trials]
    assert alike == [{key: row[key] for key in row if not key.startswith("seconds")} for row in tools["trials"]]
    assert costs.reference == tools["reference"] and costs.recommended["run"]
    assert len(costs.effects) == len(tools["effects"])
    assert costs.recommended["run"] in repr(costs)
    assert json.loads(costs.json())["target"] == {"length_m": 1e-6}


def test_an_accuracy_that_makes_no_sense():
    with pytest.raises(ValueError, match="not above zero"):
        saltus.accuracy(restitution=0.8, ball={"height": "1 m"}, length=0.0)
    with pytest.raises(ValueError, match="unit"):
        saltus.accuracy(restitution=0.8, ball={"height": "1 m"}, length="1 s")
    assert saltus.accuracy(restitution=0.8, ball={"height": "1 m"}, length=1e-300).recommended is None
