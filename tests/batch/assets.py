"""Assets to convert, and the processes of a run."""

from __future__ import annotations

import json
import os
import signal
import time
from pathlib import Path
from typing import Any

import trimesh

from tests.household import knob


def write_assets(folder: Path, count: int) -> list[Path]:
    """Write knobs of some sizes, a GLB each, and return the files."""
    folder.mkdir(parents=True, exist_ok=True)
    return [write_knob(folder / f"knob_{number}.glb", number) for number in range(count)]


def write_knob(path: Path, seed: int) -> Path:
    scene = trimesh.Scene()
    for part in knob(seed=seed).assembly.parts:
        mesh = trimesh.Trimesh(part.vertices, part.faces, process=False)
        scene.add_geometry(mesh, node_name=part.name, geom_name=part.name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(scene.export(file_type="glb"))
    return path


def manifest_lines(out: Path, name: str = "manifest.jsonl") -> list[dict[str, Any]]:
    """What stands in the manifest; every line has to be whole."""
    return [json.loads(line) for line in (out / name).read_text().splitlines()]


def wait_for(path: Path, lines: int = 1) -> None:
    """Wait until a file has so many lines."""
    deadline = time.monotonic() + 300.0
    while time.monotonic() < deadline and not (path.is_file() and path.read_text().count("\n") >= lines):
        time.sleep(0.05)


def kill(pid: int) -> None:
    """End a process at once, if it is there."""
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        return
