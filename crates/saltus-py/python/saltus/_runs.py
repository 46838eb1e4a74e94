"""What comes of a hybrid system: a run, many of them, derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._picture import Svg

if TYPE_CHECKING:
    from ._hybrid import Hybrid

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class Gradient:
    """Derivatives of a run.

    ``by`` names what they are by; ``end[k]`` is how the state at the end depends on ``by[k]``, at
    fixed time; ``times[k, n]`` how the time of jump n does, NaN of the end of a slide that loses
    both its flows at once.
    """

    by: list[str]
    end: Numbers
    times: Numbers


@dataclass(frozen=True)
class Ensemble:
    """What came of many runs, a row each: when, where and why each ended.

    ``limit`` is when jumps accumulate, where that ended a run; ``why`` says of runs that failed why.
    """

    t: Numbers
    state: Numbers
    mode: NDArray[np.str_]
    jumps: NDArray[np.int64]
    stop: NDArray[np.str_]
    limit: Numbers
    why: dict[int, str]

    def __len__(self) -> int:
        return len(self.t)


class Run:
    """A recorded run of a :class:`Hybrid`.

    ``stop`` says why it ended: ``"time"``, ``"terminal"``, ``"forever"`` (nothing happens any
    more), ``"zeno"`` (jumps accumulate at ``limit``), ``"resolution"`` (they come closer together
    than rounding can tell), or the limit that was reached: ``"jumps"``, ``"steps"``, ``"bytes"``,
    ``"cascade"``.
    """

    def __init__(self, hybrid: Hybrid, core: _core.Run, start: tuple[Any, ...], options: dict[str, Any]) -> None:
        self._hybrid, self._core, self._start, self._options = hybrid, core, start, options
        self._names = (*hybrid._modes, "")
        self.stop, self.limit, self.t, mode, state, self.count = core.end()
        self.mode = self._names[mode]
        self.state: Numbers = np.array(state)

    @cached_property
    def _modes(self) -> NDArray[np.str_]:
        # Made where it is asked for: it takes as long as a short run.
        return np.array(self._names)

    def __reduce__(self) -> Any:
        # A run is the same to the bit wherever it is made again.
        return _again, (self._hybrid, self._start, self._options)

    @property
    def jumps(self) -> NDArray[np.void]:
        """The jumps: ``t``, ``from``, ``to``, ``edge`` (its place among those out of its mode:
        edges, what a surface adds, clocks; -1 at a limit), and the states ``before`` and ``after``."""
        columns = self._core.jumps()
        n, names = len(self._hybrid.names), self._modes.dtype
        kinds = [("t", float), ("from", names), ("to", names), ("edge", int)]
        table = np.empty(len(columns["t"]), dtype=[*kinds, ("before", float, (n,)), ("after", float, (n,))])
        for name, values in columns.items():
            table[name] = self._modes[values] if name in ("from", "to") else values
        return table

    def at(self, t: ArrayLike, *, before: bool = False) -> Numbers:
        """The states at the times, after any jumps there, or before them; NaN outside the run."""
        times = np.asarray(t, dtype=float)
        states = self._core.at(np.ascontiguousarray(times.ravel()), before)
        return states.reshape(*times.shape, len(self._hybrid.names))

    def mode_at(self, t: ArrayLike) -> NDArray[np.str_]:
        """The modes at the times; empty outside the run."""
        times = np.asarray(t, dtype=float)
        modes = self._modes[self._core.modes(np.ascontiguousarray(times.ravel()))]
        return modes.reshape(times.shape)

    @property
    def cost(self) -> dict[str, int]:
        """What it cost: jumps, steps accepted and rejected, exact arcs, stiff steps, evaluations."""
        return self._core.cost()

    @property
    def doubts(self) -> list[str]:
        """Where a crossing may have been missed, and what to do; empty where none was."""
        return self._core.doubts()

    def plot(self, across: str | None = None, up: str | None = None) -> Svg:
        """A picture: the coordinates against time, or one of them against another."""
        names = self._hybrid.names
        if across is None or up is None:
            return Svg(self._core.picture(names))
        for name in (across, up):
            if name not in names:
                raise ValueError(f"there is no coordinate {name!r}: there are {', '.join(names)}")
        return Svg(self._core.phase(names.index(across), names.index(up), names))

    def _repr_svg_(self) -> str:
        return self.plot()

    def __repr__(self) -> str:
        limit = "" if self.limit is None else f" at {self.limit:.6g} s"
        return f"<saltus.Run: {self.count} jumps, {self.stop}{limit}, in {self.mode!r} at t = {self.t:.6g} s>"


def _again(hybrid: Hybrid, start: tuple[Any, ...], options: dict[str, Any]) -> Run:
    return hybrid.run(*start, **options)
