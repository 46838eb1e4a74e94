"""Hybrid systems of plain functions, bouncing balls, and the coefficient of restitution.

- :class:`Hybrid`: flows, guards and resets as plain functions, run at compiled speed
- :func:`fit`: from a table of bounces to a COR with its uncertainty and a verdict
- :func:`simulate`, :func:`explain`, :func:`accuracy`, :func:`solve`: scenes of bouncing balls
- :func:`sweep`: a scene many times, here or on many machines
"""

from ._core import RunError, SaltusError, SceneError, TableError, __version__
from ._fit import Cor, Finding, Fit, fit
from ._hybrid import Hybrid, TracingWarning
from ._picture import Svg
from ._runs import Ensemble, Gradient, Run
from ._scene import Accuracy, Moment, Motion, Scene, Solved, accuracy, explain, simulate, solve
from ._sweep import Sweep, sweep

__all__ = [
    "Cor",
    "Ensemble",
    "Finding",
    "Fit",
    "Gradient",
    "Hybrid",
    "Moment",
    "Motion",
    "Run",
    "RunError",
    "SaltusError",
    "Scene",
    "SceneError",
    "Solved",
    "Svg",
    "Sweep",
    "TableError",
    "TracingWarning",
    "__version__",
    "accuracy",
    "explain",
    "fit",
    "simulate",
    "solve",
    "sweep",
]
