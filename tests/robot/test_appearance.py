"""Materials of meshes: joined, cut apart, averaged."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import trimesh

from kinematify.robot.appearance import (
    MAX_MATERIALS,
    Appearance,
    Material,
    Texture,
    joined,
    linear_of,
    painted,
    plain,
)
from kinematify.robot.mesh_file import read_meshes

if TYPE_CHECKING:
    from pathlib import Path

RED, BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)
SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]])


def _chequered() -> Appearance:
    """A square with a picture of two columns, red at the left and blue at the right."""
    pixels = np.zeros((2, 2, 4), dtype=np.uint8)
    pixels[:, 0], pixels[:, 1] = (255, 0, 0, 255), (0, 0, 255, 255)
    return Appearance(
        materials=(Material(color=(1.0, 1.0, 1.0, 1.0), texture=Texture(name="halves", pixels=pixels)),),
        material_of_face=np.zeros(2, dtype=np.int64),
        uv=SQUARE[HALVES][:, :, :2],
    )


def test_a_texture_is_seen_at_its_place() -> None:
    appearance = _chequered()
    near_left, near_right = np.array([[0.1, 0.2, 0.7]]), np.array([[0.1, 0.8, 0.1]])
    assert appearance.colors_at(np.array([1]), near_left)[0] == pytest.approx(RED)
    assert appearance.colors_at(np.array([0]), near_right)[0] == pytest.approx(BLUE)


def test_what_is_joined_keeps_its_colours_and_shares_equal_ones() -> None:
    both = joined([plain(RED, 2), None, plain(RED, 1), plain(BLUE, 1)], [2, 1, 1, 1])
    assert both is not None
    seen = [both.materials[k].color for k in both.material_of_face]
    assert seen == [RED, RED, Material().color, RED, BLUE]
    assert len(both.materials) == 3
    assert joined([None, None], [1, 2]) is None


def test_many_colours_become_few_that_are_near() -> None:
    random = np.random.default_rng(3)
    smooth = np.column_stack([np.linspace(0.0, 1.0, 5000), np.full(5000, 0.4), np.full(5000, 0.2), np.ones(5000)])
    appearance = painted(smooth[random.permutation(5000)])
    assert len(appearance.materials) <= MAX_MATERIALS
    seen = np.array([appearance.materials[k].color for k in painted(smooth).material_of_face])
    assert np.abs(seen - smooth).max() < 0.02
    few = painted(smooth[:: 5000 // 40])
    assert np.array([few.materials[k].color for k in few.material_of_face]) == pytest.approx(smooth[:: 5000 // 40])


def test_colours_of_vertices_are_multiplied_as_light_by_those_of_the_material(tmp_path: Path) -> None:
    mesh = trimesh.creation.box()
    mesh.visual = trimesh.visual.ColorVisuals(mesh, vertex_colors=np.tile([[128, 128, 128, 255]], (8, 1)))
    path = tmp_path / "a.gltf"
    written: Any = mesh.export
    content = {name: bytes(data) for name, data in written(file_type="gltf").items()}
    said = json.loads(content.pop("model.gltf"))
    said["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 1.0, 1.0, 1.0], "roughnessFactor": 0.3}}]
    said["meshes"][0]["primitives"][0]["material"] = 0
    path.write_text(json.dumps(said))
    for name, data in content.items():
        (tmp_path / name).write_bytes(data)
    (read,) = read_meshes(path, appearance=True)
    assert read.appearance is not None
    (material,) = read.appearance.materials
    red, green = linear_of(np.array(material.color[:2]))
    assert (red, green) == pytest.approx((0.5 * 128 / 255, 128 / 255), abs=0.002)
    assert (material.metallic, material.roughness) == (1.0, 0.3)
