"""Hybrid systems of plain functions, bouncing balls, and the coefficient of restitution.

- :class:`Hybrid`: flows, guards and resets as plain functions, run at compiled speed
- :func:`fit`: from a table of bounces to a COR with its uncertainty and a verdict
"""

from ._core import RunError, SaltusError, SceneError, TableError, __version__
from ._fit import Cor, Finding, Fit, fit
from ._hybrid import Ensemble, Gradient, Hybrid, Run, TracingWarning
from ._picture import Svg

__all__ = [
    "Cor",
    "Ensemble",
    "Finding",
    "Fit",
    "Gradient",
    "Hybrid",
    "Run",
    "RunError",
    "SaltusError",
    "SceneError",
    "Svg",
    "TableError",
    "TracingWarning",
    "__version__",
    "fit",
]
