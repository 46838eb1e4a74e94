"""Hybrid systems of plain functions, bouncing balls, and the coefficient of restitution.

- :func:`fit`: from a table of bounces to a COR with its uncertainty and a verdict
"""

from ._core import RunError, SaltusError, SceneError, TableError, __version__
from ._fit import Cor, Finding, Fit, fit
from ._picture import Svg

__all__ = [
    "Cor",
    "Finding",
    "Fit",
    "RunError",
    "SaltusError",
    "SceneError",
    "Svg",
    "TableError",
    "__version__",
    "fit",
]
