"""Plain functions as formulas: each is called once with symbols, and what it does to them is kept."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from . import _core


class Untraceable(Exception):
    """Why a function is no formula, and how to write it so that it is one."""


Key = tuple[str, int, int, int, float]


class Symbol:
    """A number of a formula that is not known yet."""

    __slots__ = ("args", "number", "op")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, op: str, *args: Any, number: float = 0.0) -> None:
        self.op, self.args, self.number = op, args, number

    # Arithmetic, with numbers on either side.
    def __add__(self, other: Any) -> Any:
        return _two("add", self, other)

    def __radd__(self, other: Any) -> Any:
        return _two("add", other, self)

    def __sub__(self, other: Any) -> Any:
        return _two("sub", self, other)

    def __rsub__(self, other: Any) -> Any:
        return _two("sub", other, self)

    def __mul__(self, other: Any) -> Any:
        return _two("mul", self, other)

    def __rmul__(self, other: Any) -> Any:
        return _two("mul", other, self)

    def __truediv__(self, other: Any) -> Any:
        return _two("div", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _two("div", other, self)

    def __pow__(self, power: Any) -> Any:
        if not isinstance(power, Symbol):
            return Symbol("power", self, number=float(power))
        if power.op == "constant":
            return Symbol("power", self, number=power.number)
        return Symbol("exp", power * Symbol("log", self))

    def __rpow__(self, base: Any) -> Any:
        return Symbol("exp", self * float(np.log(base)))

    def __neg__(self) -> Symbol:
        return Symbol("neg", self)

    def __pos__(self) -> Symbol:
        return self

    def __abs__(self) -> Symbol:
        return Symbol("abs", self)

    # What decides.
    def __gt__(self, other: Any) -> Condition:
        return Condition(self - other)

    def __lt__(self, other: Any) -> Condition:
        return Condition(other - self)

    __ge__ = __gt__
    __le__ = __lt__

    def __eq__(self, other: object) -> Any:
        raise Untraceable("a formula cannot ask whether two numbers are equal")

    __ne__ = __eq__

    def __bool__(self) -> bool:
        raise Untraceable(DECIDES)

    def __float__(self) -> float:
        raise Untraceable("functions of `math`, and float(), take no symbols: use those of numpy, as numpy.sin")

    __int__ = __index__ = __round__ = __floor__ = __ceil__ = __trunc__ = __float__

    def __mod__(self, other: Any) -> Any:
        raise Untraceable("a remainder leaps: make it an edge with a reset")

    __rmod__ = __floordiv__ = __rfloordiv__ = __mod__

    # What numpy asks of its elements.
    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **rest: Any) -> Any:
        if method != "__call__" or any(isinstance(value, np.ndarray) for value in inputs):
            return getattr(ufunc, method)(*(_array(value) for value in inputs), **rest)
        return _apply(ufunc, *inputs)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        return _function(function, args, kwargs)


DECIDES = (
    "it decides by a value: write numpy.where(a > b, one, other), numpy.minimum, numpy.maximum or abs,"
    " or two modes with an edge between"
)


class Condition:
    """Whether a symbol is above zero."""

    __slots__ = ("by",)

    def __init__(self, by: Any) -> None:
        self.by = by

    def __bool__(self) -> bool:
        raise Untraceable(DECIDES)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        return _function(function, args, kwargs)


class Symbols(np.ndarray):
    """A state of symbols: an array, whose functions work element by element."""

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **rest: Any) -> Any:
        inputs = tuple(np.asarray(value) if isinstance(value, Symbols) else value for value in inputs)
        if method != "__call__" or ufunc not in FUNCTIONS:
            return _symbols(getattr(ufunc, method)(*inputs, **rest))
        return _each(lambda *values: _apply(ufunc, *values), *inputs)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function in (np.where, np.clip):
            return _function(function, args, kwargs)
        return _symbols(super().__array_function__(function, types, args, kwargs))


def _symbols(value: Any) -> Any:
    return value.view(Symbols) if isinstance(value, np.ndarray) and value.dtype == object else value


def _array(value: Any) -> Any:
    return _symbols(np.array(value, dtype=object)) if isinstance(value, Symbol) else value


def _each(function: Callable[..., Any], *values: Any) -> Any:
    """A function of numbers, element by element of arrays."""
    if not any(isinstance(value, np.ndarray) for value in values):
        return function(*values)
    return _symbols(np.frompyfunc(function, len(values), 1)(*values))


def _function(function: Any, args: Any, kwargs: Any) -> Any:
    """What numpy's functions do with symbols."""
    if function is np.where and len(args) == 3:
        return _each(_choose, *args)
    if function is np.clip and len(args) == 3:
        return np.minimum(np.maximum(args[0], args[1]), args[2])
    raise Untraceable(f"numpy.{function.__name__} takes no symbols")


def _choose(condition: Any, one: Any, other: Any) -> Any:
    if not isinstance(condition, Condition):
        return one if condition else other
    return Symbol("choose", _lift(condition.by), _lift(one), _lift(other))


def _less(a: Any, b: Any) -> Any:
    return _choose(Condition(_lift(b) - _lift(a)), a, b)


FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.add: lambda a, b: a + b,
    np.subtract: lambda a, b: a - b,
    np.multiply: lambda a, b: a * b,
    np.divide: lambda a, b: a / b,
    np.power: lambda a, b: a**b,
    np.negative: lambda a: -a,
    np.positive: lambda a: a,
    np.square: lambda a: a * a,
    np.reciprocal: lambda a: 1.0 / a,
    np.absolute: abs,
    np.fabs: abs,
    np.greater: lambda a, b: a > b,
    np.greater_equal: lambda a, b: a > b,
    np.less: lambda a, b: a < b,
    np.less_equal: lambda a, b: a < b,
    np.minimum: _less,
    np.maximum: lambda a, b: -_less(-_lift(a), -_lift(b)),
    np.arctan2: lambda a, b: Symbol("atan2", _lift(a), _lift(b)),
    np.hypot: lambda a, b: Symbol("sqrt", _lift(a * a + b * b)),
    np.sinh: lambda a: 0.5 * (Symbol("exp", a) - Symbol("exp", -a)),
    np.cosh: lambda a: 0.5 * (Symbol("exp", a) + Symbol("exp", -a)),
    **{
        ufunc: (lambda name: lambda a: Symbol(name, a))(name)
        for ufunc, name in [
            (np.sqrt, "sqrt"),
            (np.exp, "exp"),
            (np.log, "log"),
            (np.sin, "sin"),
            (np.cos, "cos"),
            (np.tan, "tan"),
            (np.arctan, "atan"),
            (np.tanh, "tanh"),
        ]
    },
}


def _apply(ufunc: Any, *values: Any) -> Any:
    """One of numpy's functions of symbols; of numbers alone, as it is."""
    if not any(isinstance(value, (Symbol, Condition)) for value in values):
        return ufunc(*values)
    if ufunc not in FUNCTIONS:
        raise Untraceable(f"numpy.{ufunc.__name__} is not among the functions that formulas have")
    return FUNCTIONS[ufunc](*values)


def _lift(value: Any) -> Symbol:
    return value if isinstance(value, Symbol) else Symbol("constant", number=float(value))


def _two(op: str, a: Any, b: Any) -> Any:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return NotImplemented
    return Symbol(op, _lift(a), _lift(b))


def _listed(outputs: Sequence[Symbol]) -> tuple[list[Key], list[int]]:
    """The operations in order, each kind once, and the places of the outputs."""
    ops: list[Key] = []
    places: dict[int, int] = {}
    seen: dict[Key, int] = {}
    for output in outputs:
        stack = [output]
        while stack:
            symbol = stack[-1]
            ahead = [arg for arg in symbol.args if isinstance(arg, Symbol) and id(arg) not in places]
            if ahead:
                stack.extend(ahead)
                continue
            stack.pop()
            args = [places[id(arg)] if isinstance(arg, Symbol) else arg for arg in symbol.args]
            a, b, c = (*args, 0, 0, 0)[:3]
            key = (symbol.op, a, b, c, symbol.number)
            # Zero and minus zero, and no number, are told apart by what they are written as.
            place = seen.setdefault((*key[:4], repr(symbol.number)), len(ops))  # type: ignore[arg-type]
            if place == len(ops):
                ops.append(key)
            places[id(symbol)] = place
    return ops, [places[id(output)] for output in outputs]


class Parameters:
    """The parameters of a system by their names: ``p.drag``."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"there is no parameter {name!r}: there are {', '.join(self.__dict__) or 'none'}")


class Formula:
    """What a function became: data, that is kept and sent where the function cannot be."""

    def __init__(self, ops: list[Key], outputs: list[int], coordinates: int, parameters: int) -> None:
        self._data = ops, outputs, coordinates, parameters
        self.core = _core.Tape(ops, outputs, coordinates, parameters)

    def __reduce__(self) -> Any:
        return Formula, self._data


def trace(function: Callable[..., Any], coordinates: int, names: Sequence[str], scalar: bool) -> Formula:
    """The formula of a function of (t, x), or of (t, x, p) where there are parameters.

    Raises :class:`Untraceable` with the reason.
    """
    x = np.empty(coordinates, dtype=object)
    x[:] = [Symbol("coordinate", i) for i in range(coordinates)]
    p = Parameters({name: Symbol("parameter", i) for i, name in enumerate(names)})
    given = [Symbol("time"), x.view(Symbols), *([p] if names else [])]
    try:
        result = function(*given)
        if isinstance(result, Condition) or result is None:
            raise Untraceable("it gives no number")
        results = [result] if scalar else result
        flat = np.array(list(results) if not isinstance(results, np.ndarray) else results, dtype=object).ravel()
        outputs = [_lift(value.item() if isinstance(value, np.ndarray) else value) for value in flat]
    except Untraceable:
        raise
    except Exception as error:
        raise Untraceable(f"{type(error).__name__}: {error}") from error
    ops, places = _listed(outputs)
    return Formula(ops, places, coordinates, len(names))
