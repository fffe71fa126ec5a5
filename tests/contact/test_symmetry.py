"""Clusters of congruent parts: copies, turned copies and mirror images belong together, other shapes do not."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.voxels import voxel_remeshed
from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.alike import find_clusters
from kinematify.generate.procedural.solids import box, cylinder, union
from kinematify.geometry.surface import part_surfaces
from kinematify.robot.transforms import rotation_about

CONFIG = load_config()
MIRROR = np.diag([1.0, -1.0, 1.0])


def hook(arm: float = 0.6, knob: float = 0.3) -> Part:
    """A chiral part: three bars along three axes with a knob at the end."""
    solid = union(
        box((0, 0, 0), (1.0, 0.2, 0.2)),
        box((0.8, 0, 0), (1.0, arm, 0.2)),
        box((0.8, arm - 0.2, 0), (1.0, arm, 0.5)),
        cylinder(0.5 * knob, (0, 0.1, 0.1), (-knob, 0.1, 0.1)),
    )
    mesh = solid.to_mesh64()
    return Part(name="hook", vertices=mesh.vert_properties[:, :3], faces=mesh.tri_verts)


def placed(part: Part, name: str, turn: np.ndarray, shift: tuple[float, float, float]) -> Part:
    faces = part.faces if np.linalg.det(turn) > 0 else part.faces[:, ::-1]
    return Part(name=name, vertices=part.vertices @ turn.T + np.asarray(shift), faces=faces)


def clusters_of(*parts: Part) -> tuple[tuple[int, ...], ...]:
    assembly = Assembly(parts=parts, source="test")
    return find_clusters(assembly, part_surfaces(assembly, config=CONFIG.surface), config=CONFIG.contact, seed=0)


@settings(max_examples=10)
@given(seed=st.integers(0, 10**6), mirrored=st.booleans())
def test_turned_and_mirrored_copies_cluster(seed: int, mirrored: bool) -> None:
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    turn = rotation_about(axis / np.linalg.norm(axis), rng.uniform(0, np.pi)) @ (MIRROR if mirrored else np.eye(3))
    copy = placed(hook(), "copy", turn, tuple(rng.uniform(-3, 3, 3)))
    assert clusters_of(hook(), copy) == ((0, 1),)


def test_copies_remeshed_on_a_coarse_grid_still_cluster() -> None:
    turn = rotation_about(np.ones(3) / np.sqrt(3), np.radians(45))
    copies = [voxel_remeshed(part, 0.14) for part in (hook(), placed(hook(), "copy", turn, (3.03, 0, 0)))]
    areas = sorted(part.area for part in copies)
    assert areas[0] < 0.88 * areas[1]  # beyond the tolerance of smooth parts
    assert clusters_of(*copies) == ((0, 1),)


@pytest.mark.parametrize("other", [hook(arm=1.0), hook(knob=0.45)], ids=["longer arm", "thicker knob"])
def test_different_shapes_do_not_cluster(other: Part) -> None:
    assert clusters_of(hook(), placed(other, "other", np.eye(3), (3, 0, 0))) == ()


def test_a_lid_and_a_tray_of_nearly_its_size_do_not_cluster() -> None:
    def shell(x: float, y: float, z: float, wall: float) -> Part:
        outer, hollow = trimesh.creation.box((x, y, z)), trimesh.creation.box((x - 2 * wall, y - 2 * wall, z))
        mesh = outer.difference(hollow.apply_translation((0, 0, wall)))
        return Part(name="shell", vertices=mesh.vertices, faces=mesh.faces)

    tray = shell(0.38, 0.17, 0.043, 0.003)
    assert clusters_of(shell(0.4, 0.2, 0.02, 0.004), placed(tray, "tray", np.eye(3), (1, 0, 0))) == ()


def test_the_same_shape_in_another_size_does_not_cluster() -> None:
    larger = Part(name="larger", vertices=1.1 * hook().vertices, faces=hook().faces)
    assert clusters_of(hook(), larger) == ()
