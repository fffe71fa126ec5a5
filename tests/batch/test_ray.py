"""`kinematify batch --engine ray` on a node of this machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from kinematify.cli.app import run
from tests.batch.assets import manifest_lines, write_assets

if TYPE_CHECKING:
    from pathlib import Path

pytest.importorskip("ray", reason="the extra `ray` is not installed")


def test_workers_of_ray_convert_every_object(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAY_AUTH_MODE", "disabled")
    write_assets(tmp_path / "assets", 2)
    words = ["batch", str(tmp_path / "assets/*.glb"), "-o", str(tmp_path / "out"), "--steps", "infer", "--up", "z"]
    assert run([*words, "--engine", "ray"]) == 0
    records = {record["object"]: record["status"] for record in manifest_lines(tmp_path / "out")}
    assert records == {f"knob_{number}": "ok" for number in range(2)}
