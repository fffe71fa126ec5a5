"""`kinematify batch --engine ray` on two nodes of this machine, of which one is lost in the middle."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from kinematify.cli.app import run
from tests.batch.assets import manifest_lines, wait_for, write_assets

pytest.importorskip("ray", reason="the extra `ray` is not installed")

COUNT = 8


def test_a_node_that_is_lost_loses_no_object(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from ray.cluster_utils import Cluster

    monkeypatch.setenv("RAY_AUTH_MODE", "disabled")
    write_assets(tmp_path / "assets", COUNT)
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    try:
        second = cluster.add_node(num_cpus=1)
        words = ["batch", str(tmp_path / "assets/*.glb"), "-o", str(tmp_path / "out"), "--steps", "infer", "--up", "z"]
        words += ["--engine", "ray", "--address", cluster.address]
        command = subprocess.Popen(
            [sys.executable, "-m", "kinematify", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        wait_for(tmp_path / "out" / "manifest.jsonl", 2)
        cluster.remove_node(second, allow_graceful=False)
        _, said = command.communicate(timeout=240.0)
    finally:
        cluster.shutdown()
    assert command.returncode == 0, said
    records = manifest_lines(tmp_path / "out")
    assert sorted(record["object"] for record in records) == [f"knob_{number}" for number in range(COUNT)]
    assert {record["status"] for record in records} == {"ok"}


def test_a_cluster_that_is_not_there_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (asset,) = write_assets(tmp_path / "assets", 1)
    assert run(["batch", str(asset), "-o", str(tmp_path / "out"), "--engine", "ray", "--address", "auto"]) == 3
    assert "The Ray cluster auto cannot be reached" in capsys.readouterr().err
