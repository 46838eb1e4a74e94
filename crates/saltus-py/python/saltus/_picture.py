"""Pictures that a notebook shows."""

from __future__ import annotations

import os
from pathlib import Path


class Svg(str):
    """A picture as SVG: text that a notebook draws."""

    def _repr_svg_(self) -> str:
        return str(self)

    def __repr__(self) -> str:
        return f"<saltus.Svg of {len(self)} characters>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it to a file."""
        Path(path).write_text(self, encoding="utf-8")
