"""Words for looks do what they say, from the sentence to the materials of a GLB."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest

from kinematify.config import load_config
from kinematify.formats.export_model import export
from kinematify.generate.blueprint_files import write_blueprint
from kinematify.generate.procedural.materials import COLORS, MATERIALS, grain_coordinates, wood_grain
from kinematify.generate.sentence import from_text
from tests.sentences import said_of


def materials_of(sentence):
    """Part -> names of its materials, the one that it is made of first."""
    parts = from_text(sentence).build().parts
    return {part.name: [material.name for material in part.appearance.materials] for part in parts}


@pytest.mark.parametrize(
    ("sentence", "part", "names"),
    [
        ("a walnut dresser with six drawers in two columns and brass knobs", "drawer_1", ["walnut", "brass"]),
        ("a red cabinet with two doors and golden handles", "door_2", ["red wood", "gold metal"]),
        ("a cabinet with glass doors", "door_1", ["glass", "metal"]),
        ("a white fridge with blue doors", "door_1", ["blue metal", "metal"]),
        ("a tool trolley with six drawers and golden handles", "drawer_6", ["steel", "gold metal"]),
        ("a cart with brass handles and a walnut door", "door_1", ["walnut", "brass"]),
        ("a cart with four wheels", "wheel_1", ["rubber"]),
    ],
)
def test_parts_and_their_handles_look_as_they_are_said_to(sentence, part, names):
    assert materials_of(sentence)[part] == names


def test_handles_that_are_not_there_are_refused():
    assert "handles" in said_of("a cart with two wheels and golden handles")


def test_a_handle_is_of_its_own_material_and_the_rest_of_the_part_is_not():
    door = from_text("a red cabinet with one door and golden handles").build().parts[1]
    look = door.appearance
    of_handle = door.vertices[door.faces[look.material_of_face == 1]].reshape(-1, 3)
    of_panel = door.vertices[door.faces[look.material_of_face == 0]].reshape(-1, 3)
    assert of_handle[:, 1].min() < of_panel[:, 1].min() - 0.02, "it stands out to the front"
    assert of_handle[:, 1].max() < of_panel[:, 1].max()
    assert look.materials[1].color[:3] == COLORS["gold"]
    assert look.materials[1].metallic == 1.0
    assert look.materials[0].metallic == 0.0
    assert door.color == COLORS["red"]


def test_looks_change_neither_meshes_nor_what_a_seed_draws():
    plain, painted = (
        from_text(text).build(seed=3)
        for text in ("a cabinet with two doors", "a cabinet with two doors, golden handles")
    )
    assert [part.mesh_hash for part in plain.parts] == [part.mesh_hash for part in painted.parts]
    assert [part.density for part in plain.parts] == [part.density for part in painted.parts]


def test_the_grain_has_no_seam_and_runs_along_a_board():
    pixels = wood_grain().pixels[..., 1].astype(float)
    inside = np.abs(np.diff(pixels, axis=1)).mean()
    assert np.abs(pixels[:, 0] - pixels[:, -1]).mean() < 2.0 * inside + 1.0
    assert np.abs(np.diff(pixels, axis=0)).mean() > 3.0 * inside, "it changes across, not along"
    board = from_text("a pine folding table").build().parts[0]
    uv = grain_coordinates(board.vertices, board.faces)
    top = np.flatnonzero((board.vertices[board.faces][:, :, 2] > board.bounds[1, 2] - 1e-6).all(axis=1))
    spread = np.ptp(uv[top].reshape(-1, 2), axis=0)
    long, wide = np.ptp(board.bounds, axis=0)[:2]
    assert spread[0] / spread[1] == pytest.approx(long / wide / 3.0, rel=1e-6), (
        "a picture is three times as long as wide"
    )


def test_a_glb_has_transparent_glass_rough_rubber_and_grain(tmp_path):
    write_blueprint(from_text("an oak cart with four casters and a glass door").build(), tmp_path, load_config())
    export(tmp_path / "model.urdf", "glb", tmp_path / "cart.glb")
    content = (tmp_path / "cart.glb").read_bytes()
    length = struct.unpack("<I", content[12:16])[0]
    described = json.loads(content[20 : 20 + length])
    by_name = {material["name"]: material["pbrMetallicRoughness"] for material in described["materials"]}
    glass = next(material for material in described["materials"] if material["alphaMode"] == "BLEND")
    assert glass["name"].startswith("door_1")
    assert glass["pbrMetallicRoughness"]["baseColorFactor"][3] == pytest.approx(MATERIALS["glass"].opacity, abs=0.01)
    assert by_name["caster_1_wheel_0"]["roughnessFactor"] == pytest.approx(0.95, abs=0.01)
    assert "baseColorTexture" in by_name["body_0"]
    assert described["images"]
