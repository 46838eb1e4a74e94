"""What the pages say runs."""

import re
from pathlib import Path

import numpy as np
import pandas
import pytest

ROOT = Path(__file__).parents[3]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", ["README.md", "crates/saltus-py/README.md", "docs/program/python.md"])
def test_the_python_of_a_page_runs(page, tmp_path, monkeypatch, capsys):
    blocks = BLOCK.findall((ROOT / page).read_text())
    assert blocks
    table = pandas.DataFrame({"bounce": [0, 1, 2, 3], "height_cm": [100, 64, 41, 26]})
    table.to_csv(tmp_path / "bounces.csv", index=False)
    (tmp_path / "topspin.toml").write_bytes((ROOT / "examples/scenes/topspin.toml").read_bytes())
    monkeypatch.chdir(tmp_path)
    names = {"frame": table, "e_values": np.linspace(0.5, 0.9, 5)}
    for block in blocks:
        exec(compile(block, page, "exec"), names)  # noqa: S102
    if page == "README.md":
        out = capsys.readouterr().out
        assert out.startswith("trusted 0.799") and "zeno at 4.06371 s" in out
