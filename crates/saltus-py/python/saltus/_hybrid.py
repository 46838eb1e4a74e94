"""Hybrid systems of plain functions: flows, guards, resets."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._runs import Ensemble, Gradient, Numbers, Run
from ._trace import Formula, Parameters, Untraceable, trace

Function = Callable[..., Any]
Kept = Union[Formula, Function]

METHODS = ("auto", "series", "steps", "tsit5", "dop853", "rodas5p")

PLAIN = frozenset({float, int})


class TracingWarning(UserWarning):
    """A function could not be traced: it is called in Python, a hundred times slower."""


@dataclass
class _Edge:
    to: str
    guard: Kept
    reset: Kept | None
    entry: str
    terminal: bool


Ticks = tuple[Union[float, None], Union[list[float], None], Union[float, None], bool]
"""When a clock ticks: its period, its times, its phase, and whether also as a run starts."""


@dataclass
class _Slide:
    above: str
    below: str
    surface: Formula


@dataclass
class _Mode:
    flow: Kept | _Slide | None = None
    edges: list[_Edge] = field(default_factory=list)
    clocks: list[tuple[str, Ticks, Kept | None]] = field(default_factory=list)
    beyond: tuple[str, Kept | None] | None = None


class Hybrid:
    """A hybrid system: in each mode a flow x' = f(t, x), out of each mode edges.

    ``coordinates`` is how many numbers a state has (at most 64), or their names; ``parameters``
    the names of the parameters (at most 64), or their values by name. Functions take ``(t, x)``,
    or ``(t, x, p)`` where there are parameters, which stand in ``p`` by name.

    Each function is called once with symbols, and runs as a formula from then on: numbers of
    Python that it reads are taken as they are at that time. Arithmetic, powers, ``abs``,
    ``numpy.where``, ``minimum``, ``maximum``, ``clip``, ``sqrt``, ``exp``, ``log``, ``sin``,
    ``cos``, ``tan``, ``arctan``, ``arctan2``, ``tanh``, ``sinh``, ``cosh`` and ``hypot`` are
    formulas. A function that is none is called where its value is wanted, and a
    :class:`TracingWarning` says so once.

    >>> import saltus
    >>> ball = (
    ...     saltus.Hybrid(["height", "velocity"], {"g": 9.81, "e": 0.8})
    ...     .mode("flight", lambda t, x, p: [x[1], -p.g])
    ...     .edge("flight", "flight", lambda t, x, p: x[0], lambda t, x, p: [0.0, -p.e * x[1]])
    ... )
    >>> run = ball.run("flight", [1.0, 0.0], (0.0, 6.0))
    >>> run.stop, round(run.limit, 9)
    ('zeno', 4.063712769)
    >>> run.jumps["t"][:2].round(4).tolist()
    [0.4515, 1.174]
    """

    def __init__(
        self,
        coordinates: int | Sequence[str],
        parameters: Sequence[str] | Mapping[str, float] = (),
    ) -> None:
        counted = isinstance(coordinates, int)
        self.names = [f"x{i}" for i in range(coordinates)] if counted else list(coordinates)  # type: ignore[arg-type]
        self.parameters = list(parameters)
        self.values = {k: float(v) for k, v in parameters.items()} if isinstance(parameters, Mapping) else {}
        all = [*self.names, *self.parameters]
        twice = [name for place, name in enumerate(all) if name in all[:place]]
        if twice:
            raise ValueError(f"two coordinates or parameters are named {twice[0]!r}: give each a name of its own")
        self._modes: dict[str, _Mode] = {}
        self._said: set[str] = set()
        self._built: _core.Hybrid | None = None

    def _kept(self, function: Function | Formula, scalar: bool, what: str) -> Kept:
        if isinstance(function, Formula):
            return function
        if not callable(function):
            raise TypeError(f"{what} is a {type(function).__name__} and no function of (t, x)")
        _takes(function, "(t, x, p), for there are parameters" if self.parameters else "(t, x)", what)
        try:
            return trace(function, len(self.names), self.parameters, scalar)
        except Untraceable as why:
            if what not in self._said:
                self._said.add(what)
                says = f"{what} is called in Python, a hundred times slower than a formula: {why}"
                warnings.warn(says, TracingWarning, stacklevel=4)
            return function

    def _mode(self, name: str) -> _Mode:
        self._built = None
        return self._modes.setdefault(name, _Mode())

    def mode(self, name: str, flow: Function) -> Hybrid:
        """Declares a mode by its flow, in units of the state per second."""
        self._mode(name).flow = self._kept(flow, False, f"the flow of {name}")
        return self

    def edge(
        self,
        source: str,
        to: str,
        guard: Function,
        reset: Function | None = None,
        *,
        entry: str = "refuse",
        terminal: bool = False,
    ) -> Hybrid:
        """Adds an edge, taken where its guard falls through zero.

        ``reset`` gives the state after it, which is that before it otherwise. ``entry`` says what to
        do where the guard is below zero as the mode is entered: ``"refuse"``, ``"wait"`` until it
        has risen, or ``"fire"`` at once. A ``terminal`` edge ends the run.
        """
        what = f"the edge {source} -> {to}"
        kept = None if reset is None else self._kept(reset, False, f"the reset of {what}")
        edge = _Edge(to, self._kept(guard, True, f"the guard of {what}"), kept, entry, terminal)
        self._mode(source).edges.append(edge)
        return self

    def clock(
        self,
        source: str,
        to: str,
        reset: Function | None = None,
        *,
        every: float | None = None,
        at: Sequence[float] | None = None,
        after: float | None = None,
        from_start: bool = False,
    ) -> Hybrid:
        """Adds an edge that a clock takes: ``every`` so many seconds, ``at`` given times, or both for
        times that are repeated.

        Tick k is at k times the period, rounded once, and ``after`` shifts all ticks. A tick at the
        very start of a run is over, unless it is taken ``from_start``. All that is due at one
        instant is taken, each once: crossings first, then clocks in the order declared.

        >>> import saltus
        >>> control = saltus.Hybrid(["level", "inflow"]).mode("run", lambda t, x: [x[1] - x[0], 0.0])
        >>> control.clock("run", "run", lambda t, x: [x[0], x[1] + 0.5 * (1 - x[0])], every=0.1)
        <saltus.Hybrid: level, inflow; run>
        >>> run = control.run("run", [0.0, 0.0], (0.0, 20.0))
        >>> run.count, run.state.round(3).tolist()
        (200, [1.0, 1.0])
        """
        if every is None and at is None:
            raise TypeError("a clock ticks every= so many seconds, at= given times, or both")
        what = f"the reset of the clock {source} -> {to}"
        kept = None if reset is None else self._kept(reset, False, what)
        times = None if at is None else [float(time) for time in at]
        self._mode(source).clocks.append((to, (every, times, after, from_start), kept))
        return self

    def slide(self, mode: str, above: str, below: str, surface: Function) -> Hybrid:
        """Declares the mode along a surface between two others, in Filippov's sense.

        ``surface`` is above zero in the mode ``above`` and below zero in ``below``, and needs no
        edges of yours. Where both flows lead towards it the run goes on in ``mode``, along the one
        mixture of them that stays on it, until one of them leads away; where both lead to the same
        side it crosses. Where both lead away, or neither leads anywhere, the future is not unique,
        and the run ends.

        >>> import saltus
        >>> block = saltus.Hybrid(["place", "speed"], {"belt": 1.0, "rub": 3.0})
        >>> block = block.mode("slower", lambda t, x, p: [x[1], -x[0] + p.rub])
        >>> block = block.mode("faster", lambda t, x, p: [x[1], -x[0] - p.rub])
        >>> block = block.slide("sticks", "faster", "slower", lambda t, x, p: x[1] - p.belt)
        >>> run = block.run("slower", [0.0, 0.0], (0.0, 20.0))
        >>> run.jumps["to"][:2].tolist()  # it is carried along until the spring holds 3 N
        ['sticks', 'slower']
        >>> round(float(run.jumps["before"][1, 0]), 12)
        3.0
        """
        try:
            kept = surface if isinstance(surface, Formula) else trace(surface, len(self.names), self.parameters, True)
        except Untraceable as why:
            says = f"the surface of {mode} must be a formula, for a slide needs its slope: {why}"
            raise TypeError(says) from why
        self._mode(mode).flow = _Slide(above, below, kept)
        return self

    def beyond(self, source: str, to: str, reset: Function | None = None) -> Hybrid:
        """Says in which mode and state a run goes on where jumps out of ``source`` accumulate."""
        kept = None if reset is None else self._kept(reset, False, f"what lies beyond {source}")
        self._mode(source).beyond = (to, kept)
        return self

    @property
    def called(self) -> bool:
        """Whether a function is called in Python, for it could not be traced."""
        modes = self._modes.values()
        kept = [f for m in modes for f in [m.flow, *(g for e in m.edges for g in (e.guard, e.reset))]]
        kept += [mode.beyond[1] for mode in modes if mode.beyond] + [c[2] for m in modes for c in m.clocks]
        return any(function is not None and not isinstance(function, (Formula, _Slide)) for function in kept)

    def __repr__(self) -> str:
        return f"<saltus.Hybrid: {', '.join(self.names)}; {', '.join(self._modes)}>"

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_built": None}

    def _core(self) -> _core.Hybrid:
        if self._built is not None:
            return self._built
        places = {name: place for place, name in enumerate(self._modes)}

        def place(name: str, says: str) -> int:
            if self._modes.get(name, _Mode()).flow is None:
                raise ValueError(f"{says} mode {name!r}, which is not declared: there are {', '.join(places)}")
            return places[name]

        def given(kept: Kept | _Slide | None) -> Any:
            return None if isinstance(kept, _Slide) else kept.core if isinstance(kept, Formula) else kept

        modes, slides = [], []
        for name, mode in self._modes.items():
            place(name, "an edge leads out of")
            edges = [
                (place(e.to, "an edge leads to"), given(e.guard), given(e.reset), e.entry, e.terminal)
                for e in mode.edges
            ]
            clocks = [(place(to, "a clock leads to"), ticks, given(reset)) for to, ticks, reset in mode.clocks]
            beyond = mode.beyond and (place(mode.beyond[0], "beyond a limit lies"), given(mode.beyond[1]))
            modes.append((name, given(mode.flow), edges, clocks, beyond))
            if isinstance(mode.flow, _Slide):
                sides = [place(side, "a surface lies beside") for side in (mode.flow.above, mode.flow.below)]
                if any(isinstance(self._modes[side].flow, _Slide) for side in (mode.flow.above, mode.flow.below)):
                    raise ValueError(f"{name} lies between modes that slide themselves: there is one surface between two flows")
                slides.append(([*sides, places[name]], mode.flow.surface.core))
        self._built = _core.Hybrid(len(self.names), len(self.parameters), modes, slides)
        return self._built

    def _place(self, mode: str) -> int:
        names = list(self._modes)
        if mode not in names:
            raise ValueError(f"there is no mode {mode!r}: there are {', '.join(names) or 'none'}")
        return names.index(mode)

    def _state(self, state: ArrayLike | Mapping[str, float]) -> list[float]:
        """The coordinates in order."""
        if isinstance(state, Mapping):
            wrong = [name for name in [*state, *self.names] if (name in state) != (name in self.names)]
            if wrong:
                says = "is no coordinate" if wrong[0] in state else "is missing from the state"
                raise ValueError(f"{wrong[0]!r} {says}: there are {', '.join(self.names)}")
            state = [state[name] for name in self.names]
        # Most are plain lists, and an array of two numbers takes as long to make as a short run.
        if isinstance(state, list) and PLAIN.issuperset(map(type, state)):
            return [float(value) for value in state]
        return [float(value) for value in np.asarray(state, dtype=float).ravel()]

    def _values(self, parameters: Mapping[str, Any] | None) -> dict[str, Any]:
        values: dict[str, Any] = {**self.values, **(parameters or {})}
        for name in values:
            if name not in self.parameters:
                raise ValueError(f"there is no parameter {name!r}: there are {', '.join(self.parameters) or 'none'}")
        missing = [name for name in self.parameters if name not in values]
        if missing:
            raise ValueError(f"parameters without a value: {', '.join(missing)}")
        return {name: values[name] for name in self.parameters}

    def run(
        self,
        mode: str,
        state: ArrayLike | Mapping[str, float],
        span: tuple[float, float],
        parameters: Mapping[str, float] | None = None,
        *,
        method: str = "auto",
        rtol: float = 1e-9,
        atol: float | None = None,
        longest_step: float | None = None,
        most_jumps: int = 10_000_000,
        most_steps: int = 100_000_000,
        most_bytes: int = 1 << 30,
    ) -> Run:
        """Runs from a state in a mode, over a span of time (start, end) in seconds, and records.

        The state is a list of its coordinates, or has them by name.

        ``method`` is ``"auto"``: a polynomial where the flow has one, else its Taylor series;
        ``"steps"``: a method by tolerance, and one for stiff flows where a flow is stiff;
        ``"tsit5"``, ``"dop853"`` or ``"rodas5p"`` (for stiff flows). ``rtol`` is the error
        allowed per step, relative to each coordinate, ``atol`` that near zero.

        Raises :class:`saltus.RunError` where the run fails, with ``.t``, ``.mode`` and ``.state``;
        what a called function raised is its cause.
        """
        options = _options(method, rtol, atol, longest_step, most_jumps, most_steps, most_bytes)
        values = self._values(parameters)
        numbers = [float(value) for value in values.values()]
        named = Parameters(values) if values else None
        start = self._state(state)
        begin = self._place(mode), start, _span(span)
        core = self._core().run(begin, numbers, named, options)
        return Run(self, core, (mode, start, span, parameters), options)

    def gradient(
        self,
        mode: str,
        state: ArrayLike | Mapping[str, float],
        span: tuple[float, float],
        parameters: Mapping[str, float] | None = None,
        *,
        by: Iterable[str] | None = None,
        method: str = "auto",
        rtol: float = 1e-9,
        atol: float | None = None,
        longest_step: float | None = None,
        most_jumps: int = 10_000_000,
        most_steps: int = 100_000_000,
    ) -> Gradient:
        """How the state at the end, and the times of the jumps, depend on parameters and coordinates.

        ``by`` are names of parameters, and of coordinates for the state at the start; all parameters
        unless given. Derivatives are carried along the flow, through every jump (saltation) and
        through slides, whose states forget what leads off the surface: not differences of runs. All
        functions must be formulas.

        >>> import saltus
        >>> ball = (
        ...     saltus.Hybrid(["height", "velocity"], {"g": 9.81, "e": 0.8})
        ...     .mode("flight", lambda t, x, p: [x[1], -p.g])
        ...     .edge("flight", "flight", lambda t, x, p: x[0], lambda t, x, p: [0.0, -p.e * x[1]])
        ... )
        >>> gradient = ball.gradient("flight", [1.0, 0.0], (0.0, 1.0), by=["g", "height"])
        >>> gradient.times.round(6).tolist()  # t = √(2 h/g)
        [[-0.023013], [0.225762]]
        >>> block = (  # each swing takes 2 rub/k off, and after two of them it sticks
        ...     saltus.Hybrid(["place", "speed"], {"k": 100.0, "rub": 3.0})
        ...     .mode("forth", lambda t, x, p: [x[1], -p.k * x[0] - p.rub])
        ...     .mode("back", lambda t, x, p: [x[1], -p.k * x[0] + p.rub])
        ...     .slide("sticks", "forth", "back", lambda t, x, p: x[1])
        ... )
        >>> gradient = block.gradient("back", [0.1, 0.0], (0.0, 10.0), by=["rub", "place"])
        >>> gradient.end[:, 0].round(9).tolist()
        [-0.04, 1.0]
        """
        if self.called:
            raise ValueError("derivatives need formulas: a function of this system is called in Python")
        options = _options(method, rtol, atol, longest_step, most_jumps, most_steps, 1 << 62)
        values = self._values(parameters)
        names = list(self.parameters if by is None else by)
        places = []
        for name in names:
            if name not in self.parameters and name not in self.names:
                known = ", ".join([*self.parameters, *self.names])
                raise ValueError(f"there is neither a parameter nor a coordinate {name!r}: there are {known}")
            initial = name not in self.parameters
            places.append((initial, (self.names if initial else self.parameters).index(name)))
        numbers = [float(value) for value in values.values()]
        begin = self._place(mode), self._state(state), _span(span)
        rows = self._core().gradient(begin, numbers, places, options)
        end = np.array([row[0] for row in rows]).reshape(len(names), len(self.names))
        return Gradient(names, end, np.array([row[1] for row in rows], dtype=float).reshape(len(names), -1))

    def ensemble(
        self,
        mode: str,
        states: ArrayLike,
        span: tuple[float, float],
        parameters: Mapping[str, ArrayLike] | None = None,
        *,
        method: str = "auto",
        rtol: float = 1e-9,
        atol: float | None = None,
        longest_step: float | None = None,
        most_jumps: int = 10_000_000,
        most_steps: int = 100_000_000,
    ) -> Ensemble:
        """Runs from many states, or with many values of the parameters, on all cores.

        ``states`` has a row for each run, or one row for all; a parameter is a number, or has a
        value for each run. A run that fails is a row with ``stop`` ``"failed"``, and says why in
        ``why``. The arrays are the same to the bit on any number of cores.
        """
        options = _options(method, rtol, atol, longest_step, most_jumps, most_steps, 1 << 62)
        values = {name: np.asarray(value, dtype=float).ravel() for name, value in self._values(parameters).items()}
        rows = np.atleast_2d(np.asarray(states, dtype=float))
        count = max([len(rows), *map(len, values.values())])
        for what, length in [("states", len(rows)), *((name, len(value)) for name, value in values.items())]:
            if length not in (1, count):
                raise ValueError(f"{what} has {length} rows, and others have {count}: give as many, or one")
        if rows.shape[1] != len(self.names):
            raise ValueError(f"the states have {rows.shape[1]} coordinates and not {len(self.names)}")
        if self.called and self.parameters:
            raise ValueError("many runs with parameters need formulas: a function of this system is called in Python")
        flat = np.ascontiguousarray(np.broadcast_to(rows, (count, rows.shape[1]))).ravel()
        columns = [np.broadcast_to(value, count) for value in values.values()]
        table = np.ascontiguousarray(np.column_stack(columns)).ravel() if columns else np.empty(0)
        begin = self._place(mode), _span(span)
        came = self._core().ensemble(begin, flat, table, count, options)
        names = np.array([*self._modes, ""])
        stops = np.array(came["stop"])
        return Ensemble(
            came["t"], came["state"], names[came["mode"]], came["jumps"], stops, came["limit"], dict(came["why"])
        )


def _takes(function: Function, given: str, what: str) -> None:
    """Refuses a function that cannot be called with what it is given."""
    try:
        signature = inspect.signature(function)
    except ValueError:  # some that are compiled have none
        return
    try:
        signature.bind(*range(given.split(")")[0].count(",") + 1))
    except TypeError as error:
        raise TypeError(f"{what} takes {signature}, and is called with {given}") from error


def _span(span: tuple[float, float]) -> tuple[float, float]:
    try:
        start, end = span
        return float(start), float(end)
    except (TypeError, ValueError) as error:
        raise TypeError(f"the span {span!r} is no (start, end) in seconds") from error


def _options(
    method: str,
    rtol: float,
    atol: float | None,
    longest_step: float | None,
    most_jumps: int,
    most_steps: int,
    most_bytes: int,
) -> dict[str, Any]:
    if method not in METHODS:
        raise ValueError(f"{method!r} is no method: use one of {', '.join(METHODS)}")
    for name, value in (("rtol", rtol), ("atol", atol), ("longest_step", longest_step)):
        plain = type(value) is float or (value is None and name != "rtol")
        if not plain and not isinstance(value, (float, int, np.number)):
            raise TypeError(f"{name} is a {type(value).__name__} and no number")
    for name, count in (("most_jumps", most_jumps), ("most_steps", most_steps), ("most_bytes", most_bytes)):
        if not isinstance(count, (int, np.integer)):
            raise TypeError(f"{name} is a {type(count).__name__} and no whole number")
        if count < 0:
            raise ValueError(f"{name} is {count}: it is zero or more")
    return {
        "method": method,
        "rtol": rtol,
        "atol": atol,
        "longest_step": longest_step,
        "most_jumps": most_jumps,
        "most_steps": most_steps,
        "most_bytes": most_bytes,
    }
