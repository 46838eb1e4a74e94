"""The coefficient of restitution (COR) from a table."""

from __future__ import annotations

import csv
import html
import io
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Union

import numpy as np

from . import _core
from ._picture import Svg

Amount = Union[float, str]
"""A number in SI units, or text with its unit, such as ``"5 mm"``."""


@dataclass(frozen=True)
class Cor:
    """A coefficient of restitution.

    ``value`` is the best one, ``standard_error`` its standard error (``None`` where there is none to
    give), ``low`` and ``high`` the ends of the 95 % interval. All are numbers without a unit.
    """

    value: float
    standard_error: float | None
    low: float
    high: float

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % interval."""
        return self.low, self.high

    def __float__(self) -> float:
        return self.value


@dataclass(frozen=True)
class Finding:
    """Something that a fit found.

    ``severity`` is ``"refusal"``, ``"doubt"`` or ``"note"``, ``kind`` its name in
    docs/use/fitting.md, ``at`` where in the table it is, ``numbers`` what belongs to its kind.
    """

    kind: str
    severity: str
    at: Mapping[str, Any]
    numbers: Mapping[str, Any]


class Fit:
    """What a fit found: :func:`fit` makes it.

    In a notebook it shows its picture and what it says; ``print`` writes what it says.
    """

    def __init__(self, report: _core.Report) -> None:
        self._report = report
        self._json = report.json()
        self.data: dict[str, Any] = json.loads(self._json)
        """The report as the tool writes it with ``--format json``."""

    @classmethod
    def from_json(cls, text: str) -> Fit:
        """A fit read back from :meth:`to_json`, or from what the tool wrote.

        Its pictures have the fitted motion and not the readings, which the table has.
        """
        return cls(_core.Report.from_json(text))

    def to_json(self) -> str:
        """The report as JSON, for programs; docs/use/fitting.md describes it."""
        return self._json

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return Fit.from_json, (self._json,)

    def __eq__(self, other: object) -> bool:
        return self.data == other.data if isinstance(other, Fit) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    @property
    def verdict(self) -> str:
        """``"trusted"``, ``"doubtful"`` or ``"refused"``."""
        return str(self.data["verdict"])

    @property
    def reason(self) -> str:
        """What the verdict rests on, in a clause."""
        return str(self.data["reason"])

    @property
    def cor(self) -> Cor | None:
        """The COR; ``None`` where the table does not determine one, or has several groups."""
        cor = self.data["cor"]
        return None if cor is None else Cor(**cor)

    @property
    def interval(self) -> tuple[float, float] | None:
        """The 95 % interval of the COR; ``None`` where there is none."""
        return None if self.cor is None else self.cor.interval

    @property
    def findings(self) -> list[Finding]:
        """What was found, that which the verdict rests on first."""

        def finding(data: dict[str, Any]) -> Finding:
            rest = {key: value for key, value in data.items() if key not in ("kind", "severity", "at")}
            return Finding(data["kind"], data["severity"], data["at"], rest)

        return [finding(data) for data in self.data["findings"]]

    @property
    def left_aside(self) -> list[dict[str, Any]]:
        """What the table holds and was not used, each with its place and the reason."""
        return list(self.data["left_aside"])

    @property
    def warnings(self) -> list[str]:
        """What to look at before the number is used."""
        return list(self.data["warnings"])

    @property
    def groups(self) -> dict[str, Fit]:
        """The fits of a table's groups (balls, surfaces, sheets) by name; empty for one group."""
        return {name: Fit(report) for name, report in self._report.groups()}

    def plot(self, kind: str = "motion") -> Svg | None:
        """A picture; ``None`` where there is nothing to draw.

        ``kind`` is ``"motion"`` (height against time), ``"cor"`` (against the speed of impact),
        ``"ladder"`` (the apexes, bounce by bounce) or ``"profile"`` (the cost of other CORs, where
        the fit was asked for ``profiles``).
        """
        picture = self._report.picture(kind)
        return None if picture is None else Svg(picture)

    def scene(self) -> str | None:
        """The fitted motion as a scene, in TOML, for :func:`saltus.simulate`; ``None`` without a COR."""
        return self._report.scene()

    def __str__(self) -> str:
        return self._report.text().rstrip()

    def __repr__(self) -> str:
        cor = self.cor
        number = "no COR" if cor is None else f"COR {cor.value:.4f}, 95 % in [{cor.low:.4f}, {cor.high:.4f}]"
        return f"<saltus.Fit {self.data['table']!r}: {self.verdict}, {number}>"

    def _repr_html_(self) -> str:
        return f"<figure>{self.plot() or ''}<figcaption><pre>{html.escape(str(self))}</pre></figcaption></figure>"


def _cell(value: Any) -> str:
    """A cell of a table as text; empty where nothing stands."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or value != value:
        return ""
    return repr(value) if isinstance(value, float) else str(value)


def _columns(table: Any) -> Mapping[str, Sequence[Any]]:
    """The columns of a frame, a dict, or an array with names."""
    if isinstance(table, Mapping):
        columns = {str(name): list(values) for name, values in table.items()}
    elif hasattr(table, "column_names"):  # pyarrow
        columns = {str(name): table[name].to_pylist() for name in table.column_names}
    elif hasattr(table, "columns") and hasattr(table, "__getitem__"):  # pandas, polars
        columns = {str(name): list(table[name]) for name in table.columns}
    elif getattr(getattr(table, "dtype", None), "names", None):
        columns = {name: list(table[name]) for name in table.dtype.names}
    else:
        what = "give a path, a frame, a dict of columns, or a list of values with unit="
        raise TypeError(f"a {type(table).__name__} is no table: {what}")
    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"the columns have not one length: {lengths}")
    if not columns:
        raise ValueError("the table has no columns")
    return columns


def _csv(columns: Mapping[str, Sequence[Any]]) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_cell(value) for value in row] for row in zip(*columns.values()))
    return text.getvalue().encode()


def _numbers(values: Any, unit: str) -> bytes:
    """Heights from the release on, contact times where they ascend, times between contacts else."""
    numbers = np.asarray(values, dtype=float)
    if numbers.ndim != 1:
        raise ValueError(f"the values have {numbers.ndim} dimensions: give a list, or a dict of columns")
    kind = _core.quantity(unit)
    if kind == "time":
        kind = "time" if bool(np.all(np.diff(numbers) >= 0)) else "interval"
    elif kind == "length":
        kind = "height"
    else:
        raise ValueError(f"'{unit}' is no unit of length or time: write it as 'cm' or 's'")
    return _csv({f"{kind}_{unit}": list(numbers)})


def _samples(table: Any, rate: float, listen: tuple[float, float] | None) -> tuple[int, Any]:
    """The rate and the samples of a sound."""
    if listen is not None:
        raise ValueError("listen is for files: give the part of the samples itself")
    samples = np.asarray(table, dtype=np.float32)
    if samples.ndim == 2:  # a column for each channel
        samples = samples.mean(axis=1, dtype=np.float32)
    if samples.ndim != 1:
        raise TypeError(f"samples of a sound are one list, or a column for each channel: not of the shape {samples.shape}")
    if int(rate) != rate or rate <= 0:
        raise ValueError(f"rate={rate} is no number of samples a second, such as 44100")
    return int(rate), samples


def fit(
    table: Any,
    unit: str | None = None,
    *,
    name: str = "table",
    sigma_height: Amount | None = None,
    sigma_time: Amount | None = None,
    sigma_zero: Amount | None = None,
    sigma_scale: float | None = None,
    gravity: Amount | None = None,
    drag: float | None = None,
    ball: Amount | None = None,
    model: str | None = None,
    height_unit: str | None = None,
    time_unit: str | None = None,
    column: str | None = None,
    group: str | Iterable[str] | None = None,
    sheet: str | None = None,
    header: Iterable[str] | None = None,
    filter: Mapping[str, Any] | None = None,
    fps: float | None = None,
    rate: int | None = None,
    listen: tuple[float, float] | None = None,
    scale: Amount | None = None,
    drop: Amount | None = None,
    zero: float | None = None,
    y_down: bool | None = None,
    losses: Iterable[str] | None = None,
    repair: bool = True,
    profiles: bool = False,
    tolerance_height: Amount | None = None,
    tolerance_time: Amount | None = None,
    bootstrap: int | None = None,
    seed: int | None = None,
    want: float | None = None,
) -> Fit:
    """The coefficient of restitution from a table, with its uncertainty and a verdict.

    ``table`` is a path or a list of paths (CSV, workbook, zip, what tracking programs write, a
    recording in WAV), a pandas or polars frame, a dict of columns, a NumPy array with names, or a
    list of values with their ``unit``. Columns are understood by their names, units among them:
    ``bounce``, ``height_cm``, ``time_s``. Missing cells are ``None`` or NaN. With ``rate`` it is the
    samples of a sound, from -1 to 1, so many a second; ``listen`` is the part of a recording to
    listen to, in s.

    Amounts are numbers in SI units or text with a unit: ``sigma_height=0.005`` is
    ``sigma_height="5 mm"``. Each option is that of ``saltus fit``, by the same name; see
    docs/use/fitting.md.

    >>> import saltus
    >>> fit = saltus.fit([100, 64, 41, 26], "cm", sigma_height="5 mm")
    >>> fit.verdict, round(fit.cor.value, 2)
    ('trusted', 0.8)
    >>> fit = saltus.fit({"bounce": [0, 1, 2, 3], "height_m": [1, 0.64, 0.41, 0.26]})
    >>> fit.cor.low < 0.8 < fit.cor.high
    True

    Raises :class:`saltus.TableError` for a table that cannot be read, :class:`ValueError` for an
    option that makes no sense.
    """
    options = {
        "sigma_height": sigma_height, "sigma_time": sigma_time, "sigma_zero": sigma_zero,
        "sigma_scale": sigma_scale, "gravity": gravity, "drag": drag, "ball": ball, "model": model,
        "height_unit": height_unit, "time_unit": time_unit, "column": column, "sheet": sheet,
        "group": [group] if isinstance(group, str) else group and list(group),
        "header": header and list(header),
        "filter": filter and [(key, _cell(value)) for key, value in filter.items()],
        "fps": fps, "listen": listen, "scale": scale, "drop": drop, "zero": zero, "y_down": y_down,
        "losses": losses and list(losses), "repair": repair, "profiles": profiles,
        "tolerance_height": tolerance_height, "tolerance_time": tolerance_time,
        "bootstrap": bootstrap, "seed": seed,
    }  # fmt: skip
    options = {key: value for key, value in options.items() if value is not None}
    options["want"] = want
    listed = isinstance(table, (list, tuple))
    if rate is not None:
        return Fit(_core.fit(options, name=name, sound=_samples(table, rate, listen)))
    if unit is not None:
        return Fit(_core.fit(options, name=name, bytes=_numbers(table, unit)))
    if isinstance(table, (str, os.PathLike)):
        return Fit(_core.fit(options, paths=[os.fspath(table)]))
    if listed and table and all(isinstance(path, (str, os.PathLike)) for path in table):
        return Fit(_core.fit(options, paths=[os.fspath(path) for path in table]))
    if listed or isinstance(table, np.ndarray) and table.dtype.names is None:
        raise TypeError("values need a unit: saltus.fit([100, 64, 41], 'cm')")
    return Fit(_core.fit(options, name=name, bytes=_csv(_columns(table))))
