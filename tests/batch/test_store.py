"""`kinematify batch` from a store into a store: an S3 server of this machine."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from kinematify.cli.app import run
from tests.batch.assets import write_assets

pytest.importorskip("s3fs", reason="the extra `cloud` is not installed")
moto_server = pytest.importorskip("moto.server", reason="moto is not installed")

URDF = """<robot name="boxes">
<link name="base"><visual><geometry><mesh filename="../stone.obj"/></geometry></visual></link>
<link name="lid"><visual><geometry><box size=".1 .1 .1"/></geometry></visual></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="lid"/></joint>
</robot>"""
STONE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


@pytest.fixture
def store(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The file system of a server with an empty bucket."""
    import s3fs

    server = moto_server.ThreadedMotoServer(port=0, verbose=False)
    logging.getLogger("werkzeug").setLevel(logging.ERROR)  # it prints every request
    server.start()
    host, port = server.get_host_and_port()
    monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://{host}:{port}")
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.setenv(name, "testing")
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    s3fs.S3FileSystem.clear_instance_cache()
    fs = s3fs.S3FileSystem()
    fs.mkdir("bucket")
    try:
        yield fs
    finally:
        server.stop()
        s3fs.S3FileSystem.clear_instance_cache()


def test_a_library_in_a_store_is_converted_there(
    store: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_assets(tmp_path / "assets" / "deep", 2)
    (tmp_path / "assets" / "deep" / "boxes.urdf").write_text(URDF)
    (tmp_path / "assets" / "stone.obj").write_text(STONE)
    store.put(str(tmp_path / "assets"), "bucket/", recursive=True)
    words = ["batch", "s3://bucket/assets/**/*.glb", "s3://bucket/assets/**/*.urdf", "-o", "s3://bucket/out"]
    words += ["--steps", "infer", "--up", "z", "--workers", "1", "--json", "-"]
    assert run(words) == 0
    answer = json.loads(capsys.readouterr().out)
    assert {record["object"]: record["status"] for record in answer["records"]} == {
        "deep-knob_0": "ok", "deep-knob_1": "ok", "deep-boxes": "ok",
    }  # fmt: skip
    assert next(record["parts"] for record in answer["records"] if record["object"] == "deep-boxes") == 2
    found = {path.removeprefix("bucket/out/") for path in store.find("bucket/out")}
    assert found >= {"manifest.jsonl", "index.html", "objects/deep-knob_1/model.urdf"}
    assert any(path.startswith("objects/deep-knob_1/meshes/") for path in found)
    assert run([*words, "--resume"]) == 0
    assert json.loads(capsys.readouterr().out)["new"] == 0
