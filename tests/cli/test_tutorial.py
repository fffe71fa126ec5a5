"""examples/tutorial.ipynb is a notebook without outputs, and its cells run in their order."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from tests.places import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

NOTEBOOK = ROOT / "examples" / "tutorial.ipynb"


def test_every_cell_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    notebook = json.loads(NOTEBOOK.read_text("utf-8"))
    assert notebook["nbformat"] == 4
    names: dict[str, object] = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            assert not cell["outputs"], "outputs would become old: clear them before committing"
            exec("".join(cell["source"]), names)
    reported = capsys.readouterr().out
    assert "drawer_left_joint    prismatic  body -> drawer_left" in reported
    assert "open and at rest: True" in reported
    assert "(84, 84, 3) uint8" in reported
