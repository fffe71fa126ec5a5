"""`batch` from a store into a store: fsspec's file system in memory, with a worker in this process."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from fsspec.implementations.memory import MemoryFileSystem

from kinematify.batch.run_batch import batch
from kinematify.cli.app import run
from tests.batch.assets import write_assets

URDF = """<robot name="boxes">
<link name="base"><visual><geometry><mesh filename="../stone.obj"/></geometry></visual></link>
<link name="lid"><visual><geometry><box size=".1 .1 .1"/></geometry></visual></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="lid"/></joint>
</robot>"""
STONE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


class Here:
    """One worker, which is this process: no other one sees its memory."""

    capacity = 1

    def start(self) -> Here:
        return self

    def wait(self, workers: Collection[Any]) -> list[Any]:
        return list(workers)

    def submit(self, call: Callable[[], Any], timeout: float) -> None:
        self.call = call

    def result(self) -> tuple[Any, bool]:
        return self.call(), True

    def stop(self) -> None:
        """Nothing is left to end."""


def test_a_library_in_a_store_is_converted_there(tmp_path: Path) -> None:
    write_assets(tmp_path / "assets" / "deep", 2)
    (tmp_path / "assets" / "deep" / "boxes.urdf").write_text(URDF)
    (tmp_path / "assets" / "stone.obj").write_text(STONE)
    store = MemoryFileSystem()
    store.put(str(tmp_path / "assets"), "/bucket/", recursive=True)
    inputs = ("memory://bucket/assets/**/*.glb", "memory://bucket/assets/**/*.urdf")
    run_in_store = partial(batch, inputs, "memory://bucket/out", steps=("infer",), up="z", engine=Here())
    done = run_in_store()
    assert {record.object: record.status for record in done.records} == dict.fromkeys(
        ("deep-knob_0", "deep-knob_1", "deep-boxes"), "ok"
    )
    assert next(record.parts for record in done.records if record.object == "deep-boxes") == 2
    found = {path.removeprefix("/bucket/out/") for path in store.find("/bucket/out")}
    assert found >= {"manifest.jsonl", "objects/deep-knob_1/model.urdf"}
    assert any(path.startswith("objects/deep-knob_1/meshes/") for path in found)
    assert run_in_store(resume=True).new == 0


def test_a_store_whose_package_is_missing_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "s3fs", None)
    assert run(["batch", "s3://bucket/*.glb", "-o", str(tmp_path / "out")]) == 3
    assert "pip install 's3fs" in capsys.readouterr().err
