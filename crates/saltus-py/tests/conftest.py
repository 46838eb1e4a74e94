"""What the tests share: the tool, whose words and numbers the package has."""

import os
import shutil
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def tool() -> str:
    """The command `saltus` of this source."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", Path(__file__).parents[3] / "target"))
    there = [path for profile in ("debug", "release") if (path := target / profile / "saltus").exists()]
    path = os.environ.get("SALTUS_TOOL") or (str(there[0]) if there else shutil.which("saltus"))
    assert path, "build the tool: cargo build --bin saltus"
    return path
