"""Parts that were cut apart are distinguished from parts that merely meet, and come out fixed to each other."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from objects import BUILDERS

from benchmarks.degrade import cut_in_bands, degraded
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.seams import find_cuts
from kinematify.geometry.surface import part_surfaces
from kinematify.pipeline.infer_assembly import infer
from kinematify.robot.joint_type import JointType
from tests.inferred import inferred
from tests.known import part_of

CONFIG = load_config()
X = np.array([1.0, 0.0, 0.0])


def cuts(*parts: Part) -> set[tuple[int, int]]:
    named = tuple(Part(name=f"p{k}", vertices=part.vertices, faces=part.faces) for k, part in enumerate(parts))
    assembly = Assembly(parts=named, source="test")
    return set(find_cuts(assembly, part_surfaces(assembly, config=CONFIG.surface), CONFIG.seam))


SOLIDS = {
    "box": trimesh.creation.box((1, 0.3, 0.2)),
    "tube": trimesh.creation.annulus(0.1, 0.2, 1.0).apply_transform(
        trimesh.transformations.rotation_matrix(np.pi / 2, [0, 1, 0])
    ),
    "ball": trimesh.creation.icosphere(subdivisions=3),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_what_a_plane_cut_apart_is_found_the_base_included(name: str) -> None:
    tilted = np.array([1.0, 0.1, -0.1]) / np.linalg.norm([1.0, 0.1, -0.1])
    pieces = cut_in_bands(part_of(SOLIDS[name], name), tilted, [-0.1, 0.15])
    assert cuts(*pieces) == {(0, 1), (1, 2)}


def test_a_sheet_cut_across_is_found() -> None:
    sheet = Part(
        name="sheet",
        vertices=np.array([[0, 0, 0], [1, 0, 0], [1, 0.5, 0], [0, 0.5, 0.0]]),
        faces=[[0, 1, 2], [0, 2, 3]],
    )
    assert cuts(*cut_in_bands(sheet, X, [0.4])) == {(0, 1)}


@pytest.mark.parametrize(("boards", "found"), [(8, True), (0, False)])
def test_a_ragged_cut_through_boards_is_found_and_a_zigzag_around_a_door_is_not(boards: int, found: bool) -> None:
    """Faces of a cupboard with shelves fall to either half as their centres do; the door's outline follows its mesh."""
    front = trimesh.creation.box((1, 0.6, 1)).subdivide_to_size(0.13)
    shelves = [trimesh.creation.box((0.9, 0.5, 0.02)).apply_translation((0, 0, 0.1 * k - 0.4)) for k in range(boards)]
    mesh = trimesh.util.concatenate([front, *(shelf.subdivide_to_size(0.2) for shelf in shelves)])
    centres = mesh.triangles_center
    door = (centres[:, 1] < -0.29) & (np.abs(centres[:, [0, 2]]).max(axis=1) < 0.3)
    side = centres[:, 0] > 0.03 * np.sin(40 * centres[:, 2]) if boards else door
    assert side.any()
    assert (
        cuts(*(part_of(mesh.submesh([np.flatnonzero(half)])[0], "half") for half in (side, ~side))) != set()
    ) is found


def test_closed_parts_that_meet_are_no_pieces() -> None:
    left, right = (trimesh.creation.box((0.5, 0.3, 0.2)).apply_translation((x, 0, 0)) for x in (-0.25, 0.25))
    assert cuts(part_of(left, "a"), part_of(right, "b")) == set()


def test_a_lid_cut_out_of_a_shell_along_its_corner_is_no_piece() -> None:
    shell = trimesh.creation.box((1, 1, 1))
    lid = shell.face_normals[:, 2] > 0.5
    body, top = (Part(name="p", vertices=shell.vertices, faces=shell.faces[chosen]) for chosen in (~lid, lid))
    assert cuts(body, top) == set()


def test_a_door_flush_in_its_body_that_has_a_back_of_its_own_is_no_piece() -> None:
    """The sides go straight on over the seam, but the door is closed at the back and the body has an opening there."""
    body, door = cut_in_bands(part_of(trimesh.creation.box((1, 1, 1)), "fridge"), X, [0.3])
    opening = trimesh.creation.box((0.1, 0.8, 0.8)).apply_translation((0.25, 0, 0))
    inside = opening.submesh([opening.face_normals[:, 0] < 0.5], append=True)
    hollow = trimesh.util.concatenate([trimesh.Trimesh(body.vertices, body.faces), inside])
    assert cuts(door, part_of(hollow, "body")) == set()


@pytest.mark.parametrize(("name", "kind", "seed"), [("nested_drawer", "cut-2", 0), ("hinge_pin", "cut-3", 1)])
def test_pieces_come_out_fixed_and_the_other_joints_as_without_the_cut(name: str, kind: str, seed: int) -> None:
    assembly = BUILDERS[name]().assembly
    whole = inferred(name)
    given = degraded(kind, assembly, CONFIG, seed=seed)
    assert given.pieces
    found = infer(given.assembly, config=CONFIG)
    names = found.assembly.names
    fixed = {names[joint.child] for joint in found.joints if joint.kind is JointType.FIXED}
    assert fixed == set(given.pieces)
    assert {names[joint.parent] for joint in found.joints if names[joint.child] in fixed} == set(given.pieces.values())
    moving = {names[joint.child]: joint for joint in found.joints if joint.kind is not JointType.FIXED}
    assert set(moving) == {assembly.names[joint.child] for joint in whole.joints}
    for joint in whole.joints:
        same = moving[assembly.names[joint.child]]
        assert same.kind is joint.kind
        assert abs(float(same.axis @ joint.axis)) > np.cos(np.radians(1.0))
    assert any("cut apart" in warning for warning in found.warnings)
    assert set(found.graph.by_pair) >= set(found.bearings)
