"""Scenes of bouncing balls: run, explained, solved."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._fit import Amount
from ._picture import Svg

Numbers = NDArray[np.float64]
Source = Union["Scene", str, "os.PathLike[str]", bytes, Mapping[str, Any], None]

EXTENSIONS = {
    ".csv": "csv",
    ".glb": "glb",
    ".gltf": "gltf",
    ".html": "html",
    ".lottie": "dotlottie",
    ".svg": "svg",
    ".usda": "usd",
    ".usdz": "usdz",
    ".wav": "wav",
}


def _toml(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        # The escapes of JSON are among those of TOML, but for the delete character.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_toml(str(key))} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    raise TypeError(f"a scene holds numbers, text, lists and tables, and no {type(value).__name__}")


class Scene:
    """A scene as text, which can be kept, compared and sent.

    ``source`` is a path, text in TOML, a dict, or nothing; ``keys`` are keys of the scene, which go
    before those of a dict. docs/use/scenes.md lists the keys. Amounts are numbers in SI units, or text
    with a unit.

    >>> import saltus
    >>> saltus.Scene(restitution=0.8, ball={"height": "1 m"}).toml
    'restitution = 0.8\\nball = { "height" = "1 m" }\\n'
    """

    def __init__(self, source: Source = None, /, **keys: Any) -> None:
        self.name, self.toml = "scene", ""
        if isinstance(source, (Scene, str, bytes, os.PathLike)) and keys:
            raise TypeError("keys go with a dict, or alone: change the text of a scene, or give all by keys")
        if isinstance(source, Scene):
            self.name, self.toml = source.name, source.toml
        elif isinstance(source, bytes):
            self.toml = source.decode("utf-8")
        elif isinstance(source, str) and ("\n" in source or "=" in source):
            self.toml = source
        elif isinstance(source, (str, os.PathLike)):
            self.name = os.fspath(source)
            try:
                self.toml = Path(source).read_bytes().decode("utf-8")
            except OSError as error:
                raise _core.SceneError(f"cannot read '{self.name}': {error.strerror}") from error
            except UnicodeDecodeError as error:
                raise _core.SceneError(f"'{self.name}' is no text in UTF-8") from error
        elif isinstance(source, Mapping) or source is None:
            every = {**(source or {}), **keys}
            self.toml = "".join(f"{key} = {_toml(value)}\n" for key, value in every.items())
        else:
            raise TypeError(f"a {type(source).__name__} is no scene: give a path, TOML, a dict or keys")

    def __repr__(self) -> str:
        return f"<saltus.Scene {self.name!r}>"

    def __eq__(self, other: object) -> bool:
        return self.toml == other.toml if isinstance(other, Scene) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.toml)


class Moment(NamedTuple):
    """A ball at some times: ``position`` (its lowest point; x, y, up) in m, ``velocity`` in m/s,
    ``spin`` in rad/s."""

    position: Numbers
    velocity: Numbers
    spin: Numbers


class Motion:
    """A run of a scene: :func:`simulate` makes it.

    ``end`` says why it ended: ``"time"``, or a limit, which ``why`` says in a sentence; ``until``
    is when, in s; ``rest`` from when on all is at rest, if it is.
    """

    def __init__(self, scene: Scene, core: _core.Motion, options: tuple[Any, ...]) -> None:
        self.scene, self._core, self._options = scene, core, options
        self.end, self.why, self.until, self.rest = core.end()

    def __reduce__(self) -> Any:
        # A run is the same to the bit wherever it is made again.
        return _again, (self.scene, self._options)

    @property
    def balls(self) -> int:
        """How many balls there are."""
        return self._core.balls()

    def at(self, t: ArrayLike, ball: int = 0, *, before: bool = False) -> Moment:
        """A ball at the times in s, after any jump there, or before it; NaN outside the run."""
        times = np.asarray(t, dtype=float)
        rows = self._core.at(np.ascontiguousarray(times.ravel()), ball, before).reshape(*times.shape, 3, 3)
        return Moment(rows[..., 0, :], rows[..., 1, :], rows[..., 2, :])

    def height(self, t: ArrayLike, ball: int = 0) -> Numbers:
        """The height of a ball's lowest point at the times, in m."""
        return self.at(t, ball).position[..., 2]

    def energy(self, t: ArrayLike, ball: int = 0) -> Numbers:
        """Of a ball at the times, per mass: g h + v²/2 in J/kg, with the scene's own gravity."""
        moment = self.at(t, ball)
        energy: Numbers = self.gravity * moment.position[..., 2] + 0.5 * np.sum(moment.velocity**2, axis=-1)
        return energy

    @property
    def gravity(self) -> float:
        """Gravity, downwards, in m/s²."""
        return self._core.gravity()

    @property
    def impacts(self) -> NDArray[np.void]:
        """The impacts: ``t``, ``ball``, ``floor`` or ``other`` ball (-1: none), the speeds of
        ``approach`` and ``rebound`` in m/s, ``cor``, and of contacts that take time ``duration``,
        ``force`` (N) and ``deformation`` (m)."""
        columns = self._core.impacts()
        table = np.empty(len(columns["t"]), dtype=[(name, values.dtype) for name, values in columns.items()])
        for name, values in columns.items():
            table[name] = values
        return table

    def apexes(self, ball: int = 0) -> Numbers:
        """The tops of a ball's flights: rows of the time in s and the height in m."""
        return np.array(self._core.apexes(ball), dtype=float).reshape(-1, 2)

    def table(self, *, every: float | None = None, fps: float | None = None) -> dict[str, Any]:
        """Columns by name: both sides of every jump, the end, and samples where they are asked for,
        every so many seconds or so many times a second."""
        return {name: np.asarray(values) for name, values in self._core.table(every, fps)}

    def to_frame(self, *, every: float | None = None, fps: float | None = None) -> Any:
        """:meth:`table` as a pandas frame."""
        import pandas

        return pandas.DataFrame(self.table(every=every, fps=fps))

    def to_json(self, *, every: float | None = None, fps: float | None = None) -> str:
        """What the tool writes with ``--format json``; docs/use/simulating.md describes it."""
        return self._core.json(every, fps)

    @property
    def cost(self) -> dict[str, int]:
        """What it cost: jumps, steps, evaluations of flows and of guards."""
        return self._core.cost()

    @property
    def doubts(self) -> list[str]:
        """Where a jump may have been missed; empty where none was."""
        return self._core.doubts()

    def plot(self, kind: str | None = None) -> Svg:
        """A picture: ``"height"``, ``"velocity"``, ``"energy"``, ``"phase"``, ``"path"``,
        ``"ladder"``, ``"hysteresis"`` or ``"ghost"``; what the scene asks for unless given."""
        return Svg(self._core.picture(kind))

    def export(
        self, path: str | os.PathLike[str], *, to: str | None = None, fps: float | str = 24, tolerance: float = 1e-4
    ) -> str:
        """Writes a file for animators, and gives the line that says how good it is.

        The format is that of the extension (``.glb``, ``.gltf``, ``.usda``, ``.usdz``,
        ``.lottie``, ``.svg``, ``.html``, ``.csv``, ``.wav``), or ``to``, by its name in
        docs/use/motion.md. ``tolerance`` is how far keys may be from the motion, in m.
        """
        extension = Path(path).suffix.lower()
        if to is None and extension not in EXTENSIONS:
            raise ValueError(f"no format goes by the extension '{extension}': say to=")
        content, says = self._core.file(to or EXTENSIONS[extension], str(fps), tolerance)
        Path(path).write_bytes(content)
        return says

    def _repr_svg_(self) -> str:
        return self.plot()

    def __str__(self) -> str:
        return self._core.text().rstrip()

    def __repr__(self) -> str:
        return f"<saltus.Motion of {self.scene.name!r}: {len(self.impacts)} impacts until {self.until:.6g} s ({self.end})>"


def simulate(
    scene: Source = None,
    /,
    *,
    until: float | None = None,
    most_jumps: int | None = None,
    tolerance: float | None = None,
    **keys: Any,
) -> Motion:
    """Runs a scene: a path, TOML, a dict, or its keys as arguments; see :class:`Scene`.

    ``until`` is when to stop, in s; without it the run ends where nothing happens any more.

    >>> import saltus
    >>> motion = saltus.simulate(gravity=9.8, restitution=0.5, ball={"height": "4.9 m"})
    >>> motion.impacts["t"][:3].round(12).tolist(), round(motion.rest, 12)
    ([1.0, 2.0, 2.5], 3.0)
    >>> round(float(motion.height(0.5)), 12)
    3.675

    Raises :class:`saltus.SceneError` with line, column and advice where the scene is none.
    """
    made = scene if isinstance(scene, Scene) and not keys else Scene(scene, **keys)
    options = (until, most_jumps, tolerance)
    return Motion(made, _core.simulate(made.name, made.toml.encode(), *options), options)


def _again(scene: Scene, options: tuple[Any, ...]) -> Motion:
    return Motion(scene, _core.simulate(scene.name, scene.toml.encode(), *options), options)


def explain(scene: Source = None, /, **keys: Any) -> str:
    """How a scene would be run, and why: what acts, and how each mode is advanced."""
    made = Scene(scene, **keys)
    return _core.explain(made.name, made.toml.encode())


class Accuracy:
    """What accuracy costs in a scene: :func:`accuracy` measures it.

    ``recommended`` is the cheapest setting that meets the target, ``None`` if none does;
    ``reference`` what every run is compared with, and ``reference_error`` how far that may be off.
    ``trials`` has a dict for each setting tried, ``effects`` one for each effect left out or put
    in: ``run``, ``error`` (``impacts_s``, ``apexes_m``, ``places_m``, ``energy_share``), ``steps``,
    ``flows``, ``guards``, ``seconds``, or ``refused``. docs/trust/accuracy.md describes them.
    """

    def __init__(self, text: str) -> None:
        self._json = text
        self._data: dict[str, Any] = json.loads(text)

    @property
    def recommended(self) -> dict[str, Any] | None:
        """The cheapest setting that meets the target: ``run``, ``stepper``, ``tolerance``."""
        found: dict[str, Any] | None = self._data["recommended"]
        return found

    @property
    def reference(self) -> str:
        """What every run is compared with."""
        found: str = self._data["reference"]
        return found

    @property
    def reference_error(self) -> dict[str, Any]:
        """How far the reference itself may be off."""
        found: dict[str, Any] = self._data["reference_error"]
        return found

    @property
    def trials(self) -> list[dict[str, Any]]:
        """The settings tried."""
        found: list[dict[str, Any]] = self._data["trials"]
        return found

    @property
    def effects(self) -> list[dict[str, Any]]:
        """The effects left out or put in."""
        found: list[dict[str, Any]] = self._data["effects"]
        return found

    def json(self) -> str:
        """All of it, as ``saltus accuracy --format json`` writes it."""
        return self._json

    def __repr__(self) -> str:
        best = "no setting meets the target" if self.recommended is None else self.recommended["run"]
        return f"<saltus.Accuracy: {best}>"


def accuracy(
    scene: Source = None,
    /,
    *,
    length: Amount | None = "1 mm",
    time: Amount | None = "1 ms",
    until: float | None = None,
    **keys: Any,
) -> Accuracy:
    """What accuracy costs in a scene, and which setting to take for places within a ``length`` and
    impacts within a ``time``; ``None`` for either that does not matter. ``until`` is when to stop,
    in s.

    The scene is run by each stepper to ten tolerances, and frame by frame, and every run is
    compared with a reference: by formulas where they solve the scene.

    >>> import saltus
    >>> saltus.accuracy(restitution=0.8, ball={"height": "1 m"})
    <saltus.Accuracy: formulas>

    Raises :class:`saltus.SceneError` for a scene that cannot be run, :class:`ValueError` for a
    length or a time that makes no sense.
    """
    made = Scene(scene, **keys)
    return Accuracy(_core.accuracy(made.name, made.toml.encode(), length, time, until))


class Solved(NamedTuple):
    """The ``scene`` found, whether it ``meets`` every wish, and what is said of each."""

    scene: Scene
    meets: bool
    says: list[str]


def solve(
    wishes: str | Iterable[str],
    free: str | Iterable[str],
    scene: Source = None,
    *,
    fps: float = 24.0,
    first_frame: int = 0,
) -> Solved:
    """The scene in which wishes come true: docs/use/directing.md has wishes and freedoms.

    >>> import saltus
    >>> solved = saltus.solve("touch 1 at frame 24", free="throw")
    >>> solved.meets, round(float(saltus.simulate(solved.scene).impacts["t"][0]), 6)
    (True, 1.0)
    """
    wanted = [wishes] if isinstance(wishes, str) else list(wishes)
    loose = [free] if isinstance(free, str) else list(free)
    begin = None if scene is None else Scene(scene)
    given = None if begin is None else (begin.name, begin.toml.encode())
    toml, meets, says = _core.solve(wanted, loose, given, fps, first_frame)
    return Solved(Scene(toml), meets, says)
