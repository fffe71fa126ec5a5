"""What goes wrong on the viewer's page or with what it shows is reported, and nothing is lost."""

from __future__ import annotations

import json
import os
import struct
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import trimesh

from kinematify.assembly.load import load_assembly
from kinematify.pipeline.infer_assembly import infer
from kinematify.pipeline.record import write_inference
from tests.browser import opened, wait_until
from tests.objects import BUILDERS
from tests.view.pages import PATIENCE, mistakes, picture, press, served

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from kinematify.robot.arrays import IntArray

_NOBODY = 65534
_COLORS = 2500
"""Of each of two parts."""


@contextmanager
def read_only(folder: Path) -> Iterator[None]:
    """A folder that may only be read, not even by the superuser's own process, which else may write everything."""
    before = os.geteuid()
    opened_up = [path for path in folder.parents if before == 0 and not path.stat().st_mode & 0o001]
    modes = {path: path.stat().st_mode for path in (folder, folder.parent, *opened_up)}
    for path, mode in modes.items():
        path.chmod(mode & ~0o222 | 0o555)
    if before == 0:
        os.seteuid(_NOBODY)
    try:
        yield
    finally:
        os.seteuid(before)
        for path, mode in modes.items():
            path.chmod(mode)


def test_a_read_only_folder_is_reported_and_stays_as_it_is(tmp_path: Path) -> None:
    folder = tmp_path / "safe" / "model"
    write_inference(infer(BUILDERS["edge_door"]().assembly), folder, preview=False)
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    with served(folder, 18170) as window, opened(window.url) as (page, reported):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        joint = next(iter(window.viewer.values))
        window.viewer.choose(joint)
        page.get_by_text(f"{joint} moves").first.wait_for(timeout=PATIENCE)
        window.viewer.try_candidate(joint, 1)
        with read_only(folder):
            press(page, "Keep this")
            page.get_by_text("Nothing was changed").first.wait_for(timeout=PATIENCE)
        assert "permissions" in page.inner_text("body")
        assert not mistakes(reported)
        assert before == {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        press(page, "Keep this")
        page.get_by_text("The same from the command line").wait_for(timeout=PATIENCE)
    assert before[folder / "model.urdf"] != (folder / "model.urdf").read_bytes(), "kept when it may be written again"


def _many_materials(path: Path) -> None:
    """A GLB of two boxes, one upon the other, in which every triangle has a material of its own."""
    box = trimesh.creation.box((0.4, 0.4, 0.2))
    for _ in range(4):
        box = box.subdivide()
    faces = box.faces[: _COLORS + 572].astype(np.uint32)
    colors = np.random.default_rng(0).uniform(0.6, 1.0, (2 * _COLORS, 3)) * [1.0, 0.1, 0.1]
    runs = [*np.arange(_COLORS), len(faces)]
    positions, indices = box.vertices.astype(np.float32).tobytes(), faces.tobytes()
    corner = {"bufferView": 0, "componentType": 5126, "count": len(box.vertices), "type": "VEC3",
              "min": box.bounds[0].tolist(), "max": box.bounds[1].tolist()}  # fmt: skip
    of_faces = [
        {"bufferView": 1, "componentType": 5125, "count": 3 * int(end - start), "type": "SCALAR",
         "byteOffset": 12 * int(start)}
        for start, end in pairwise(runs)
    ]  # fmt: skip
    said = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "low", "mesh": 0}, {"name": "high", "mesh": 1, "translation": [0.0, 0.2, 0.0]}],
        "meshes": [
            {"primitives": [
                {"attributes": {"POSITION": 0}, "indices": 1 + k, "material": part * _COLORS + k}
                for k in range(_COLORS)
            ]}
            for part in range(2)
        ],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [*color, 1.0]}} for color in colors.tolist()],
        "accessors": [corner, *of_faces],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(positions)},
            {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices)},
        ],
        "buffers": [{"byteLength": len(positions) + len(indices)}],
    }  # fmt: skip
    text = json.dumps(said).encode()
    text += b" " * (-len(text) % 4)
    binary = positions + indices
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)


def test_a_file_of_5000_materials_is_shown_in_its_colours(tmp_path: Path) -> None:
    _many_materials(tmp_path / "many.glb")
    assembly = load_assembly(tmp_path / "many.glb")
    assert any("more than 64 materials" in warning for warning in assembly.warnings)
    write_inference(infer(assembly), tmp_path / "model", preview=False)
    with served(tmp_path / "model", 18180) as window, opened(window.url) as (page, reported):
        page.wait_for_selector("text=At rest", timeout=PATIENCE)
        wait_until(page, lambda: _red(picture(page)) > 0.03)
        assert not mistakes(reported)


def _red(pixels: IntArray) -> float:
    """Share of a picture."""
    return float(((pixels[:, :, 0] > 120) & (pixels[:, :, 1:].max(axis=2) < pixels[:, :, 0] - 40)).mean())
