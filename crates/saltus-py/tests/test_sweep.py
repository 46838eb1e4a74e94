"""Sweeps: the rows of the tool, the same to the byte however they are made, and after any kill."""

import concurrent.futures
import csv
import importlib.util
import json
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pandas
import polars
import pyarrow
import pyarrow.parquet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import saltus

ROOT = Path(__file__).parents[3]
SQUASH = ROOT / "examples/scenes/squash.toml"
DROP = {"restitution": 0.8, "ball": {"height": "1 m"}}
GRID = {"restitution": "0.5:0.9:40", "ball.height": [0.5, 1.0, 2.0]}


def swept(**how):
    return saltus.sweep(DROP, **{"vary": GRID, "progress": False, **how})


def bytes_of(rows):
    """The sorted result, with what it belongs to."""
    sink = pyarrow.BufferOutputStream()
    pyarrow.parquet.write_table(rows.table(), sink)
    return sink.getvalue().to_pybytes()


@pytest.mark.parametrize(
    ("path", "vary", "random"),
    [
        ("squash.toml", ["restitution=0.3:0.9:7", "ball.height=50cm:2m:4"], None),
        ("squash.toml", ["restitution=0.3:1.2:7"], None),  # some refused
        ("topspin.toml", ["gravity=earth,moon,mars", "restitution=0.5:0.9:3"], None),
        ("squash.toml", ["restitution=0.3:0.9", "ball.height=10cm:10m:log"], 50),
    ],
)
def test_the_rows_of_the_tool(tool, path, vary, random):
    scene = ROOT / "examples/scenes" / path
    options = [part for text in vary for part in ("--vary", text)]
    options += [] if random is None else ["--random", str(random)]
    said = subprocess.run([tool, "-q", "sweep", scene, *options], capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    names, *theirs = csv.reader(said.stdout.splitlines())
    keys = dict(text.split("=") for text in vary)
    rows = saltus.sweep(scene, vary=keys, random=random, chunk=5, progress=False)
    table = rows.table()
    assert table.column_names == names and table.num_rows == rows.runs == len(theirs)
    for name, cells in zip(names, zip(*theirs)):
        ours = table[name].to_pylist()
        read = str if table.schema.field(name).type == pyarrow.string() else float
        assert ours == [read(cell) if cell else None for cell in cells], name


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_rows_are_the_same_to_the_byte_however_they_are_made(cluster, tmp_path):
    first = bytes_of(swept())
    processes = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=processes) as pool:
        ways = {
            "folder": swept(into=tmp_path / "a", chunk=13),
            "parts of their own": swept(into=tmp_path / "b"),
            "processes": swept(into=tmp_path / "c", on=pool, chunk=13),
            "cluster": swept(into=tmp_path / "d", on=cluster, chunk=13),
            "cluster to memory": swept(on=cluster, chunk=11),
        }
    assert {name: bytes_of(rows) == first for name, rows in ways.items()} == dict.fromkeys(ways, True)
    parts = [sorted(path.name for path in (tmp_path / name).iterdir()) for name in "acd"]
    assert parts[0] == parts[1] == parts[2] and not any(name.startswith(".") for name in parts[0])
    for name in parts[0]:
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "d" / name).read_bytes()


RAY = f"""
import sys, ray, saltus
ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
saltus.sweep({DROP!r}, vary={GRID!r}, into=sys.argv[1], on="ray", chunk=13, progress=False)
"""


def test_ray_makes_the_same_rows(tmp_path):
    pytest.importorskip("ray")
    # In a process of its own, for it stays.
    done = subprocess.run([sys.executable, "-c", RAY, str(tmp_path)], capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    rows = saltus.Sweep(tmp_path)
    assert rows.missing == [] and bytes_of(rows) == bytes_of(swept())


SCENE = "restitution = 0.8\nball = { height = '1 m' }\n"


def shared(tool, folder, scene=SCENE):
    """The tool's sweep and Python's of one scene, as two that write to one folder."""
    path = folder / "drop.toml"
    path.write_bytes(scene.encode())
    rows = folder / "rows"

    def by_tool(*options):
        vary = ["--vary", "restitution=0.5:0.9:40", "--vary", "ball.height=0.5,1,2"]
        done = subprocess.run([tool, "sweep", path, *vary, "--into", rows, *options], capture_output=True, text=True)
        return done.returncode, done.stderr

    def by_python(**options):
        return saltus.sweep(path, **{"vary": GRID, "into": rows, "progress": False, **options})

    return rows, by_tool, by_python


def test_a_folder_of_the_tool_is_gone_on_with(tool, tmp_path):
    folder, by_tool, by_python = shared(tool, tmp_path)
    assert by_tool("--chunk", "13", "--part", "2/2")[0] == 0
    theirs = {path.name: path.read_bytes() for path in folder.iterdir()}
    rows = saltus.Sweep(folder)
    assert len(rows.missing) == 5
    rows = by_python()
    assert rows.missing == [] and len(list(folder.iterdir())) == 11
    assert theirs == {name: (folder / name).read_bytes() for name in theirs}, "what is there is not made again"
    assert rows.table().replace_schema_metadata().equals(swept().table().replace_schema_metadata())
    assert pandas.read_parquet(folder).equals(swept().to_frame())
    assert polars.read_parquet(folder / "*.parquet").height == 120
    said = {pyarrow.parquet.read_metadata(path).metadata[b"saltus"] for path in folder.glob("*.parquet")}
    assert len(said) == 1 and json.loads(said.pop())["scene"] == SCENE
    # The tool finds all of it done.
    assert by_tool() == (0, "") and len(list(folder.iterdir())) == 11


def test_a_folder_of_python_is_gone_on_with_by_the_tool(tool, tmp_path):
    folder, by_tool, by_python = shared(tool, tmp_path)
    by_python(chunk=13, part="1/2")
    ours = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert by_tool("--part", "1/2")[0] == 0 and {path.name: path.read_bytes() for path in folder.iterdir()} == ours
    # A part that is torn, and what one who was killed has left.
    torn = folder / "part-026.parquet"
    torn.write_bytes(torn.read_bytes()[:-9])
    (folder / ".part-013.parquet.0123.part").write_bytes(b"left")
    assert by_tool() == (0, "")
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["_sweep.json", *(f"part-{start:03}.parquet" for start in range(0, 120, 13))]
    assert all((folder / name).read_bytes() == ours[name] for name in ours if name != torn.name)
    rows = saltus.Sweep(folder)
    assert rows.missing == [] and rows.table()["run"].to_pylist() == list(range(120))
    assert rows.table().replace_schema_metadata().equals(swept().table().replace_schema_metadata())
    assert by_python().missing == []


@pytest.mark.parametrize("scene", [SCENE.replace("\n", "\r\n"), "\ufeff" + SCENE, SCENE + "# größer\n"])
def test_scenes_are_one_however_their_lines_end(tool, tmp_path, scene):
    _, by_tool, by_python = shared(tool, tmp_path, scene=scene)
    by_python(chunk=40, part="1/3")
    assert by_tool("--part", "2/3")[0] == 0
    assert by_python(part="3/3").missing == []


def test_both_write_to_one_folder_at_once(tool, tmp_path):
    whole = swept().table().replace_schema_metadata()
    for attempt in range(4):
        (tmp_path / str(attempt)).mkdir()
        folder, by_tool, by_python = shared(tool, tmp_path / str(attempt))
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            ways = [pool.submit(by_tool, "--chunk", "3"), pool.submit(by_python, chunk=3)] * 2
            assert all(way.result() for way in ways) and ways[0].result()[0] == 0
        rows = saltus.Sweep(folder)
        assert rows.missing == [] and len(list(folder.iterdir())) == 41
        assert rows.table().replace_schema_metadata().equals(whole)


@pytest.mark.parametrize("parts", [1, 9])
def test_killed_here_and_gone_on_with_by_the_tool(tool, tmp_path, unbroken, parts):
    """And killed there, and gone on with here."""
    scene = tmp_path / "drag.toml"
    scene.write_text(saltus.Scene({"drag": {"per_length": 0.1}, **DROP}).toml)
    vary = ["--vary", "restitution=0.5:0.99:60", "--vary", "ball.height=1m:10m:50"]
    folder = tmp_path / "rows"
    process = begun(folder, parts)
    process.kill()
    process.communicate()
    there = {path.name: path.stat().st_ino for path in folder.glob("part-*")}
    tools = subprocess.Popen([tool, "-q", "sweep", scene, *vary, "--into", folder], stderr=subprocess.PIPE)
    end = time.monotonic() + 60
    while tools.poll() is None and len(list(folder.glob("part-*"))) < len(there) + 10:
        assert time.monotonic() < end
    tools.kill()
    assert b"another sweep" not in tools.communicate()[1]
    assert len(list(folder.glob("part-*"))) >= len(there) + 10
    assert subprocess.run([sys.executable, "-c", SLOW, str(folder)]).returncode == 0
    rows = saltus.Sweep(folder)
    assert there == {name: (folder / name).stat().st_ino for name in there}, "what is there is not made again"
    assert rows.missing == [] and bytes_of(rows) == unbroken


@pytest.mark.parametrize(
    ("tools", "ours"),
    [
        (["--until", "2s"], {"until": 2}),
        (["--most-jumps", "7"], {"most_jumps": 7}),
        (["--columns", "impacts,rest_s"], {"columns": ["impacts", "rest_s"]}),
        (["--random", "30", "--seed", "5"], {"random": 30, "seed": 5}),
    ],
)
def test_what_is_another_sweep_is_so_for_both_in_the_same_words(tool, tmp_path, tools, ours):
    for name in "abc":
        (tmp_path / name).mkdir()
    folder, by_tool, by_python = shared(tool, tmp_path / "a")
    by_python(**ours, chunk=10, part="1/3")
    made = {path.name: path.read_bytes() for path in folder.iterdir()}
    code, tools_words = by_tool()
    with pytest.raises(saltus.SaltusError, match="holds another sweep") as refused:
        by_python()
    assert code == 2 and str(refused.value) in tools_words, tools_words
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == made
    assert by_tool(*tools, "--part", "2/3")[0] == 0 and by_python(**ours, part="3/3").missing == []
    # And one that the tool began.
    folder, by_tool, by_python = shared(tool, tmp_path / "b")
    assert by_tool(*tools, "--chunk", "10")[0] == 0 and by_python(**ours).missing == []
    code, tools_words = by_tool()
    with pytest.raises(saltus.SaltusError, match="holds another sweep") as refused:
        by_python()
    assert code == 2 and str(refused.value) in tools_words, tools_words
    # A part of it in a folder of another.
    name = next(folder.glob("part-*")).name
    (folder / name).replace(tmp_path / "a/rows" / name)
    _, by_tool, by_python = shared(tool, tmp_path / "c")
    assert by_tool("--chunk", "10")[0] == 0
    (tmp_path / "a/rows" / name).replace(tmp_path / "c/rows/part-010.parquet")
    code, tools_words = by_tool()
    with pytest.raises(saltus.SaltusError, match="belongs to another sweep") as refused:
        by_python()
    assert code == 2 and str(refused.value) in tools_words, tools_words


def test_a_folder_is_read_by_others(tmp_path):
    rows = swept(into=tmp_path, chunk=50)
    assert pandas.read_parquet(tmp_path).equals(rows.to_frame())
    assert polars.read_parquet(tmp_path / "*.parquet").height == rows.runs == 120
    said = json.loads(pyarrow.parquet.read_metadata(tmp_path / "part-000.parquet").metadata[b"saltus"])
    assert said["hash"] == rows.plan["hash"] == saltus.Sweep(tmp_path).plan["hash"]
    assert said["vary"][1] == {"key": "ball.height", "values": GRID["ball.height"]} and said["runs"] == 120
    assert len(said["vary"][0]["values"]) == 40 and "restitution" in said["scene"]


def test_each_of_several_machines_makes_its_share(tmp_path):
    whole = bytes_of(swept())
    for k, there in [(2, 30), (4, 60), (1, 90)]:
        rows = swept(into=tmp_path, part=f"{k}/4", chunk=6)
        assert rows.table().num_rows == there and len(rows.missing) == (120 - there) // 6
    rows = swept(into=tmp_path, part="3/4", chunk=6)
    assert bytes_of(rows) == whole and rows.missing == []


@settings(max_examples=25, deadline=None)
@given(chunk=st.integers(1, 40), gone=st.sets(st.integers(0, 119)), torn=st.integers(0, 119), cut=st.floats(0, 1), padded=st.sampled_from([None, b"\0", b"\xff"]))
def test_what_is_missing_or_torn_is_made_again(tmp_path_factory, chunk, gone, torn, cut, padded):
    folder = tmp_path_factory.mktemp("sweep")
    rows = swept(into=folder, chunk=chunk)
    whole, names = bytes_of(rows), sorted(path.name for path in folder.glob("*.parquet"))
    for k in gone:
        (folder / names[k % len(names)]).unlink(missing_ok=True)
    last = folder / names[torn % len(names)]
    if last.exists():
        content = last.read_bytes()
        kept = int(cut * len(content))
        last.write_bytes(content[:kept] if padded is None or kept == len(content) else content[:kept] + padded * (len(content) - kept))
    (folder / ".part-0.parquet.0123.part").write_bytes(b"left by one who was killed")
    again = swept(into=folder)
    assert bytes_of(again) == whole and again.missing == []
    assert sorted(path.name for path in folder.iterdir()) == ["_sweep.json", *names]


def test_a_design_has_a_row_for_each_run(tmp_path):
    random = np.random.default_rng(7)
    values = np.column_stack([random.uniform(0.5, 1.1, 200), random.uniform(0.2, 3, 200)])
    keys = ["restitution", "ball.height"]
    first = saltus.sweep(DROP, design=values, keys=keys, chunk=17, progress=False)
    columns = dict(zip(keys, values.T))
    ways = {
        "frame": saltus.sweep(DROP, design=pandas.DataFrame(columns), chunk=17, progress=False),
        "polars": saltus.sweep(DROP, design=polars.DataFrame(columns), progress=False),
        "folder": saltus.sweep(DROP, design=columns, into=tmp_path, chunk=50, progress=False),
    }
    assert {name: bytes_of(rows) == bytes_of(first) for name, rows in ways.items()} == dict.fromkeys(ways, True)
    frame = first.to_frame()
    assert frame["restitution"].tolist() == values[:, 0].tolist() and frame["run"].tolist() == list(range(200))
    refused = frame["end"] == "refused"
    assert refused.equals(frame["restitution"] > 1) and frame["why"].notna().equals(refused)
    for k in np.flatnonzero(~refused)[:5]:
        ball = saltus.simulate(restitution=values[k, 0], ball={"height": values[k, 1]})
        assert frame["first_impact_s"][k] == ball.impacts["t"][0]
    with pytest.raises(saltus.SaltusError, match="holds another sweep: its `vary` is"):
        saltus.sweep(DROP, design=values[::-1], keys=keys, into=tmp_path, progress=False)


def test_words_of_a_design_have_units():
    rows = saltus.sweep(DROP, design={"ball.height": ["20 cm", "1 m"], "gravity": ["moon", "earth"]}, progress=False)
    assert rows.to_frame()["ball.height"].tolist() == ["20 cm", "1 m"]
    alone = saltus.simulate(restitution=0.8, ball={"height": "20 cm"}, gravity="moon")
    assert rows.to_frame()["first_impact_s"][0] == alone.impacts["t"][0]


def test_two_writers_of_one_folder_lose_and_double_nothing(tmp_path):
    failures, rows = [], []

    def write(into):
        try:
            rows.append(swept(into=into, chunk=3))
        except BaseException as error:  # noqa: BLE001
            failures.append(error)

    for attempt in range(5):
        threads = [threading.Thread(target=write, args=[tmp_path / str(attempt)]) for _ in range(4)]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]
        names = sorted(path.name for path in (tmp_path / str(attempt)).iterdir())
        assert len(names) == 41 and failures == []
    assert {bytes_of(one) for one in rows} == {bytes_of(swept())}


@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        (lambda into: swept(vary=None), TypeError, "design= for rows"),
        (lambda into: swept(vary={"resitution": [0.5]}), saltus.SceneError, "restitution"),
        (lambda into: swept(vary={"restitution": [0.5, float("nan")]}), ValueError, "value 1 of 'restitution' is no number"),
        (lambda into: swept(vary={"restitution": []}), ValueError, "no list"),
        (lambda into: swept(vary={"restitution": [0.5, "0.6"]}), saltus.SceneError, "restitution"),
        (lambda into: swept(vary={"restitution": [None, 0.5]}), ValueError, "value 0 of 'restitution' is a NoneType"),
        (lambda into: swept(vary={"restitution": "a:b"}), ValueError, "'a' is not a number"),
        (lambda into: swept(vary={"ball.height": ["1 m\""]}), ValueError, "without quotes"),
        (lambda into: swept(vary={"a b": [1]}), ValueError, "'a b' is no key"),
        (lambda into: swept(vary=None, design=np.ones((3, 2)), keys=["restitution"]), ValueError, r"shape \(3, 2\)"),
        (lambda into: swept(vary=None, design={"restitution": [0.5], "ball.height": [1, 2]}), ValueError, "not one length"),
        (lambda into: swept(vary=None, design={"restitution": [0.5]}, random=3), TypeError, "random= with vary="),
        (lambda into: swept(part="5/4"), ValueError, "'5/4' is no part"),
        (lambda into: swept(part="0/4"), ValueError, "'0/4' is no part"),
        (lambda into: swept(chunk=0), ValueError, "one row or more"),
        (lambda into: swept(random=0), ValueError, "one run or more"),
        (lambda into: swept(random=3, seed=-1), ValueError, "a seed of zero or more"),
        (lambda into: swept(columns=["colour"]), ValueError, "'colour' is no column"),
        (lambda into: swept(on=7), TypeError, "do not run on a int"),
        (lambda into: [swept(into=into), swept(into=into, until=1.0)], saltus.SaltusError, "its `until_s` is null, here it is 1.0; name another"),
        (lambda into: [swept(into=into), swept(into=into, vary={"restitution": [0.5]})], saltus.SaltusError, "its `vary` is"),
        (lambda into: [swept(into=into, chunk=9), swept(into=into, chunk=5)], ValueError, "have 9 rows, and not 5"),
        (lambda into: saltus.Sweep(into), saltus.SaltusError, "no folder of a sweep"),
        (lambda into: swept(into=ROOT / "README.md"), OSError, "README"),
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_in_words(tmp_path, given, error, says):
    with pytest.raises(error, match=says):
        given(tmp_path)


def test_a_million_rows_take_bounded_memory(tmp_path):
    script = f"""
import resource, saltus
vary = {{"restitution": "0.1:0.9:1000", "ball.height": "1m:2m:1000"}}
def sweep(part):
    saltus.sweep(restitution=0.5, ball={{"height": "1 m"}}, vary=vary, most_jumps=1, into={str(tmp_path)!r}, part=part,
                 columns=["impacts", "first_impact_s"], progress=False)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
first = sweep("1/20")
print(sweep(None) - first)
"""
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    assert saltus.Sweep(tmp_path).missing == [] and int(said.stdout) < 60_000  # kB
    assert sum(part.num_rows for part in saltus.Sweep(tmp_path).parts()) == 1_000_000


def test_a_part_of_another_sweep_is_refused(tmp_path):
    swept(into=tmp_path / "a", chunk=30)
    swept(into=tmp_path / "b", chunk=30, until=1.0)
    (tmp_path / "b/part-030.parquet").replace(tmp_path / "a/part-030.parquet")
    with pytest.raises(saltus.SaltusError, match="part-030.parquet' belongs to another sweep"):
        swept(into=tmp_path / "a")


def test_a_part_with_other_rows_is_made_again(tmp_path):
    rows = swept(into=tmp_path, chunk=30)
    part = tmp_path / "part-030.parquet"
    pyarrow.parquet.write_table(pyarrow.parquet.read_table(part).slice(0, 29), part)
    assert rows.missing == [(30, 60)] and bytes_of(swept(into=tmp_path)) == bytes_of(swept())


def test_parts_without_a_plan_are_nobodys(tmp_path):
    swept(into=tmp_path, chunk=30)
    (tmp_path / "_sweep.json").unlink()
    with pytest.raises(saltus.SaltusError, match="not known whose"):
        swept(into=tmp_path, chunk=20)


def test_without_pyarrow_it_is_said_what_to_install(monkeypatch):
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *rest: None if name == "pyarrow" else find(name, *rest))
    with pytest.raises(ImportError, match="pip install pyarrow"):
        swept()


def test_the_first_of_two_plans_stays(tmp_path):
    for content in (b"first", b"second"):
        saltus._sweep._write(tmp_path / "_sweep.json", content, anew=False)
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"first"]


def test_a_worker_of_another_version_is_refused(monkeypatch):
    # The plan is said to be by another version than that which makes its rows.
    said = saltus._sweep._made
    other = lambda *task: said(*task[:5], task[5].replace('"saltus":"', '"saltus":"9.'), *task[6:])  # noqa: E731
    monkeypatch.setattr(saltus._sweep, "_made", other)
    with pytest.raises(saltus.SaltusError, match="a worker has saltus"):
        swept()


# -- killed


SLOW = f"""
import sys, saltus
vary = {{"restitution": "0.5:0.99:60", "ball.height": "1m:10m:50"}}
folder, on = sys.argv[1], None
if len(sys.argv) > 2:
    import distributed
    on = distributed.Client(sys.argv[2])
saltus.sweep({{"drag": {{"per_length": 0.1}}, **{DROP!r}}}, vary=vary, into=folder, on=on, chunk=20, progress=False)
"""


def begun(folder, parts, *args):
    """A sweep in another process, as soon as it has made some parts."""
    process = subprocess.Popen([sys.executable, "-c", SLOW, str(folder), *args], stderr=subprocess.PIPE)
    end = time.monotonic() + 60
    while len(list(Path(folder).glob("part-*"))) < parts:
        assert process.poll() is None and time.monotonic() < end, process.stderr.read()
        time.sleep(0.002)
    return process


@pytest.fixture(scope="module")
def unbroken(tmp_path_factory):
    folder = tmp_path_factory.mktemp("unbroken")
    assert subprocess.run([sys.executable, "-c", SLOW, str(folder)]).returncode == 0
    return bytes_of(saltus.Sweep(folder))


@pytest.mark.parametrize("parts", [0, 1, 20, 100])
def test_a_killed_sweep_goes_on(tmp_path, unbroken, parts):
    process = begun(tmp_path, parts)
    process.kill()
    process.wait()
    process.stderr.close()
    there = {path.name: path.stat().st_ino for path in tmp_path.glob("part-*")}
    if (tmp_path / "_sweep.json").exists():
        assert (parts == 0) or saltus.Sweep(tmp_path).table().num_rows >= 20 * parts
    assert subprocess.run([sys.executable, "-c", SLOW, str(tmp_path)]).returncode == 0
    assert bytes_of(saltus.Sweep(tmp_path)) == unbroken
    assert there == {name: (tmp_path / name).stat().st_ino for name in there}, "what is there is not made again"


class Processes:
    """A scheduler and two workers, each a process of its own."""

    def __init__(self):
        self.all = []

    def start(self, kind, *args):
        process = subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.dask_{kind}", *args],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
        self.all.append(process)
        return process

    def cluster(self, folder):
        file = str(folder / "scheduler.json")
        scheduler = self.start("scheduler", "--scheduler-file", file, "--port", "0", "--no-dashboard")
        end = time.monotonic() + 30
        while not Path(file).exists():
            assert time.monotonic() < end
            time.sleep(0.05)
        address = json.loads(Path(file).read_text())["address"]
        options = ["--nthreads", "1", "--no-dashboard", "--no-nanny"]
        return address, scheduler, [self.start("worker", address, *options) for _ in range(2)]

    def end(self):
        for process in self.all:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.fixture
def processes():
    pytest.importorskip("distributed")
    all = Processes()
    yield all
    all.end()


def test_a_worker_is_killed_and_the_sweep_ends_as_if_nothing_had_happened(tmp_path, unbroken, processes):
    address, _, (worker, _) = processes.cluster(tmp_path)
    rows = tmp_path / "rows"
    process = begun(rows, 10, address)
    os.killpg(worker.pid, signal.SIGKILL)
    assert process.poll() is None and len(list(rows.glob("part-*"))) < 140
    _, says = process.communicate(timeout=120)
    assert process.returncode == 0, says
    assert bytes_of(saltus.Sweep(rows)) == unbroken


def test_the_scheduler_is_killed_and_the_same_call_goes_on(tmp_path, unbroken, processes):
    address, scheduler, _ = processes.cluster(tmp_path)
    rows = tmp_path / "rows"
    process = begun(rows, 10, address)
    os.killpg(scheduler.pid, signal.SIGKILL)
    _, says = process.communicate(timeout=120)
    assert process.returncode != 0 and b"SaltusError: the engine gave up after" in says
    made = saltus.Sweep(rows)
    assert made.table().num_rows >= 200 and len(made.missing) > 0
    (tmp_path / "again").mkdir()
    address, _, _ = processes.cluster(tmp_path / "again")
    assert subprocess.run([sys.executable, "-c", SLOW, str(rows), address]).returncode == 0
    assert bytes_of(saltus.Sweep(rows)) == unbroken
