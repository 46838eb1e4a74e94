"""Sweeps: a scene run many times, here or on many machines, into parts that are whole or absent."""

from __future__ import annotations

import importlib.util
import json
import os
import re
import uuid
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._engines import results
from ._fit import _columns
from ._scene import Scene, Source

Values = Union[str, Sequence[Any], ArrayLike]
Kept = Union[str, list[str], NDArray[np.float64]]

PLAN = _core.SWEEP_PLAN
"""What the parts of a folder belong to; readers of Parquet pass over names that begin so."""

KEY = _core.SWEEP_KEY.encode()
"""Under which a part has the plan of its sweep."""


def _kept(values: Values, key: str) -> Kept:
    """Values as numbers or as words; as text, as the tool has them: ``0.5:0.9:41``."""
    if isinstance(values, str):
        return values
    array = np.asarray(values)
    if array.ndim != 1 or not len(array):
        raise ValueError(f"the values of {key!r} are no list: give numbers, words, or text such as '0.5:0.9:41'")
    if array.dtype.kind in "iuf":
        finite = np.isfinite(array)
        if not finite.all():
            raise ValueError(f"value {int(finite.argmin())} of {key!r} is no number")
        return array.astype(float)
    words = [str(value).lower() if isinstance(value, (bool, np.bool_)) else value for value in array.tolist()]
    for place, word in enumerate(words):
        if not isinstance(word, str):
            raise ValueError(f"value {place} of {key!r} is a {type(word).__name__}: values are numbers, or all of them text")
    return words


def _listed(values: Kept) -> str | list[Any]:
    return values.tolist() if isinstance(values, np.ndarray) else values


class _Plan:
    """What rows depend on, and how they are made."""

    def __init__(self, scene: Scene, vary: dict[str, Kept], design: bool, asked: dict[str, Any]) -> None:
        self.scene, self.vary, self.design, self.asked = scene, vary, design, {**asked, "rows": design}
        self.said = _core.sweep_identity(*self._whole())
        self.what = json.loads(self.said)
        self.runs = int(self.what["runs"])

    def _whole(self) -> tuple[str, bytes, list[tuple[str, Any]], dict[str, Any]]:
        every = [(key, _listed(values)) for key, values in self.vary.items()]
        return self.scene.name, self.scene.toml.encode(), every, self.asked

    def values(self, start: int, stop: int) -> list[tuple[str, str | list[Any]]]:
        """What varies; of a design the first row, which says whether all is well, and some others."""
        if not self.design:
            return [(key, _listed(values)) for key, values in self.vary.items()]
        return [(key, [*_listed(values[:1]), *_listed(values[start:stop])]) for key, values in self.vary.items()]

    def pace(self) -> int:
        """How many rows are a part, as long as rows take here."""
        return _core.sweep_pace(*self._whole())

    def task(self, start: int, stop: int) -> tuple[Any, ...]:
        """What :func:`_made` makes rows of: not the whole design."""
        runs = (1, 1 + stop - start) if self.design else (start, stop)
        scene = "scene", self.scene.toml.encode()
        return start, runs, scene, self.values(start, stop), self.asked, self.said


def _made(
    start: int,
    runs: tuple[int, int],
    scene: tuple[str, bytes],
    values: list[tuple[str, Any]],
    asked: dict[str, Any],
    said: str,
    cores: bool = False,
) -> tuple[int, bytes]:
    """Rows from ``start`` on as a file of Parquet, which is the same to the byte wherever it is made."""
    import pyarrow
    import pyarrow.parquet

    if (asks := json.loads(said)["saltus"]) != _core.__version__:
        raise _core.SaltusError(f"a worker has saltus {_core.__version__}, and this sweep is by {asks}")
    columns: dict[str, Any] = {}
    for header, column in _core.sweep_rows(*scene, values, asked, runs, cores):
        if isinstance(column, list):
            columns[header] = pyarrow.array(column, pyarrow.string())
        else:
            columns[header] = pyarrow.array(column, mask=column < 0 if column.dtype.kind == "i" else np.isnan(column))
    columns["run"] = pyarrow.array(np.arange(start, start + runs[1] - runs[0]))
    table = pyarrow.table(columns).replace_schema_metadata({KEY: said.encode()})
    sink = pyarrow.BufferOutputStream()
    pyarrow.parquet.write_table(table, sink, compression="zstd")
    return start, sink.getvalue().to_pybytes()


class Sweep:
    """The rows of a sweep: :func:`sweep` makes it, and ``saltus.Sweep(folder)`` opens one.

    ``folder`` is where its parts are, ``None`` in memory; ``plan`` what its rows depend on, and
    ``plan["hash"]`` one number for all that.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder: Path | None = Path(folder)
        self._parts: dict[str, bytes] = {}
        try:
            self.plan: dict[str, Any] = json.loads((self.folder / PLAN).read_bytes())
        except (OSError, ValueError) as error:
            raise _core.SaltusError(f"'{self.folder}' is no folder of a sweep: {error}") from error

    @property
    def runs(self) -> int:
        """How many runs there are in all."""
        return int(self.plan["runs"])

    @property
    def missing(self) -> list[tuple[int, int]]:
        """Which runs are not there yet: of each part that is missing the first, and that after its last."""
        return [(start, stop) for start, stop in self._all() if not self._has(start, stop)]

    def parts(self) -> Iterator[Any]:
        """The rows as tables of Arrow, one after the other: in order, and never all in memory."""
        import pyarrow
        import pyarrow.parquet

        for start, stop in self._all():
            if self._has(start, stop):
                yield pyarrow.parquet.read_table(self._source(start))

    def table(self) -> Any:
        """The rows that are there as one table of Arrow, in order."""
        import pyarrow

        return pyarrow.concat_tables(self.parts())

    def to_frame(self) -> Any:
        """The rows that are there as a pandas frame, in order."""
        return self.table().to_pandas()

    def __repr__(self) -> str:
        missing = sum(stop - start for start, stop in self.missing)
        left = f", {missing} of them missing" if missing else ""
        return f"<saltus.Sweep in {str(self.folder) if self.folder else 'memory'}: {self.runs} runs{left}>"

    def _all(self) -> list[tuple[int, int]]:
        return _core.sweep_parts(self.runs, self.plan["chunk"])

    def _name(self, start: int) -> str:
        return _core.sweep_part(start, self.runs)

    def _source(self, start: int) -> Any:
        if self.folder is not None:
            return self.folder / self._name(start)
        import pyarrow

        return pyarrow.BufferReader(self._parts[self._name(start)])

    def _has(self, start: int, stop: int) -> bool:
        """Whether a part is there and whole; that of another sweep is refused."""
        import pyarrow
        import pyarrow.parquet

        try:
            found = pyarrow.parquet.read_metadata(self._source(start))
        except (KeyError, OSError, pyarrow.ArrowInvalid):
            return False
        said = json.loads((found.metadata or {}).get(KEY, b"{}"))
        if said.get("hash") != self.plan["hash"]:
            raise _core.SaltusError(f"'{self._source(start)}' belongs to another sweep: name another folder")
        return bool(found.num_rows == stop - start)

    def _put(self, start: int, part: bytes) -> None:
        if self.folder is None:
            self._parts[self._name(start)] = part
        else:
            _write(self.folder / self._name(start), part)

    def _tidy(self) -> None:
        """Removes what writers that were killed have left; who still writes finds the part there."""
        for left in self.folder.glob(".*.part") if self.folder else ():
            left.unlink(missing_ok=True)


def _write(path: Path, content: bytes, anew: bool = True) -> None:
    """Writes a file that is whole or absent: under another name, which then becomes its own."""
    beside = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        with open(beside, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        _named(beside, path, anew)
    finally:
        beside.unlink(missing_ok=True)


def _named(beside: Path, path: Path, anew: bool) -> None:
    """Gives a file its name; of several that begin a folder the first wins, and all go by it."""
    if not anew:
        try:
            os.link(beside, path)
            return
        except FileExistsError:
            return
        except OSError:  # a file system without links
            pass
    try:
        os.replace(beside, path)
    except FileNotFoundError:
        # Another writer wrote the same, and removed what it took for left over.
        if not path.exists():
            raise


def _opened(plan: _Plan, into: str | os.PathLike[str] | None, chunk: int | None) -> Sweep:
    """Takes a folder, or memory, for a plan."""
    if into is None:
        sweep = Sweep.__new__(Sweep)
        sweep.folder, sweep._parts, sweep.plan = None, {}, {**plan.what, "chunk": chunk or plan.pace()}
        return sweep
    folder = Path(into)
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / PLAN).exists():
        # Parts come after their plan: rows of another layout would stand beside those to come.
        if any(folder.glob("part-*.parquet")) and not (folder / PLAN).exists():
            raise _core.SaltusError(f"'{folder}' has parts and no {PLAN}: it is not known whose; name another folder")
        whole = {**plan.what, "chunk": chunk or plan.pace()}
        _write(folder / PLAN, json.dumps(whole, indent=1).encode(), anew=False)
    sweep = Sweep(folder)
    if how := _core.sweep_difference(plan.said, (folder / PLAN).read_text(encoding="utf-8")):
        raise _core.SaltusError(f"'{folder}' holds another sweep: {how}; name another folder")
    if chunk not in (None, sweep.plan["chunk"]):
        raise ValueError(f"the parts in '{folder}' have {sweep.plan['chunk']} rows, and not {chunk}")
    return sweep


def _share(part: str | None) -> tuple[int, int]:
    """The k and n of ``part``: this is the k-th of n that share the work."""
    found = re.fullmatch(r"(\d+)/(\d+)", part or "1/1")
    if not found or not 1 <= int(found[1]) <= int(found[2]):
        raise ValueError(f"{part!r} is no part: write it as '1/4', the first of four")
    return int(found[1]), int(found[2])


def _bar(wanted: bool, runs: int) -> Any:
    """A bar of tqdm, where it is installed."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(total=runs, unit=" runs", disable=not wanted)


def sweep(
    scene: Source = None,
    /,
    *,
    vary: Mapping[str, Values] | None = None,
    design: Any = None,
    keys: Iterable[str] | None = None,
    random: int | None = None,
    seed: int = 1,
    into: str | os.PathLike[str] | None = None,
    on: Any = None,
    chunk: int | None = None,
    part: str | None = None,
    columns: Sequence[str] | None = None,
    until: float | None = None,
    most_jumps: int | None = None,
    progress: bool = True,
    **given: Any,
) -> Sweep:
    """Runs a scene many times with other values: a row for each run, as ``saltus sweep`` has it.

    ``vary`` gives values for keys of the scene, every one of which goes with every other, the last
    key fastest: ``"0.5:0.9:41"``, ``"1m:10m:100:log"``, or a list of numbers in SI units or of
    text. With ``random`` so many runs draw from all instead. ``design`` gives the values of each
    run: a frame, a dict of columns, or an array of rows with its ``keys``, as SALib makes them.

    Rows go to the folder ``into``, in parts of Parquet of ``chunk`` rows; without it, to memory.
    A part is whole or absent: a sweep that was killed is gone on with by the same call, and several
    may write to one folder. ``part="2/8"`` makes the second of eight shares, for eight machines.

    Without ``chunk`` a part is as many rows as one core makes in half a second.

    ``on`` says where: on all cores of this machine, on a Dask ``Client``, on an executor of
    ``concurrent.futures``, or by ``"ray"``. Rows are the same to the bit.

    >>> import saltus
    >>> rows = saltus.sweep(ball={"height": "1 m"}, vary={"restitution": "0.5:0.9:5"}, progress=False)
    >>> rows.to_frame()[["restitution", "impacts"]].values.tolist()[0]
    [0.5, 52.0]

    Raises :class:`saltus.SceneError` for what is wrong with the first run, and
    :class:`saltus.SaltusError` where the folder holds another sweep or the engine gives up. A later
    run that comes to nothing is a row that says so under ``end`` and ``why``.
    """
    if (vary is None) == (design is None):
        raise TypeError("give vary= for a grid or random draws, or design= for rows of your own")
    if design is not None and (random is not None or not isinstance(design, np.ndarray) and keys is not None):
        raise TypeError("keys= go with an array, and random= with vary=")
    if isinstance(design, np.ndarray) and design.dtype.names is None:
        names = list(keys or ())
        if design.ndim != 2 or design.shape[1] != len(names):
            raise ValueError(f"the design has the shape {design.shape}, and there are {len(names)} keys=")
        design = dict(zip(names, design.T))
    if importlib.util.find_spec("pyarrow") is None:
        raise ImportError("sweeps are tables of Arrow: pip install pyarrow")
    made = Scene(scene, **given)
    given_values = _columns(design) if vary is None else vary
    kept = {key: _kept(values, key) for key, values in given_values.items()}
    if design is not None and any(isinstance(values, str) for values in kept.values()):
        raise ValueError("a design has a value for each run")
    asked = {
        "random": random,
        "seed": seed,
        "until_s": until,
        "most_jumps": most_jumps,
        "asked": None if columns is None else list(columns),
    }
    if random is not None and random < 1 or seed < 0:
        raise ValueError(f"random={random} and seed={seed}: draw one run or more, by a seed of zero or more")
    if chunk is not None and chunk < 1:
        raise ValueError(f"a part has one row or more, and not {chunk}")
    k, n = _share(part)
    plan = _Plan(made, kept, design is not None, asked)
    rows = _opened(plan, into, chunk)
    bar = _bar(progress, sum(stop - start for start, stop in rows._all()[k - 1 :: n]))

    def tasks() -> Iterator[tuple[Any, ...]]:
        for start, stop in rows._all()[k - 1 :: n]:
            if not rows._has(start, stop):
                yield plan.task(start, stop)
            elif bar is not None:
                bar.update(stop - start)

    try:
        for start, content in results(_made, tasks(), on):
            rows._put(start, content)
            if bar is not None:
                bar.update(min(rows.plan["chunk"], rows.runs - start))
    finally:
        if bar is not None:
            bar.close()
    if not rows.missing:
        rows._tidy()
    return rows
