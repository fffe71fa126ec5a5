"""Derived geometry of a part: smooth normals, feature edges and circles, exact distances, fair samples."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.assembly.part import Part
from kinematify.geometry.surface import PartSurface
from kinematify.robot.transforms import rotation_about

CREASE = np.deg2rad(30.0)
TURN = rotation_about(np.array([0.6, 0.0, 0.8]), 0.7)
SHIFT = np.array([0.3, -2.0, 5.0])


def surface_of(mesh: trimesh.Trimesh) -> PartSurface:
    return PartSurface(Part(name="part", vertices=mesh.vertices, faces=mesh.faces), crease_angle=CREASE)


def posed_cylinder(sections: int = 16) -> PartSurface:
    """A cylinder of radius 0.5 and height 2 about the line SHIFT + t TURN z."""
    mesh = trimesh.creation.cylinder(radius=0.5, height=2.0, sections=sections)
    mesh.apply_transform(np.vstack([np.column_stack([TURN, SHIFT]), [0, 0, 0, 1]]))
    return surface_of(mesh)


BUMPY = trimesh.creation.icosphere(subdivisions=2)
BUMPY.vertices += np.random.default_rng(0).normal(scale=0.02, size=BUMPY.vertices.shape)


# ---- normals ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sections", [16, 24, 64])
def test_smooth_normals_of_a_faceted_cylinder_are_radial(sections: int) -> None:
    samples = posed_cylinder(sections).sample(4000)
    local = (samples.points - SHIFT) @ TURN
    normals = samples.normals @ TURN
    wall = np.abs(normals[:, 2]) < 0.5
    radial = local[wall, :2] / np.linalg.norm(local[wall, :2], axis=1)[:, None]
    miss = np.abs(radial[:, 0] * normals[wall, 1] - radial[:, 1] * normals[wall, 0])
    assert wall.mean() == pytest.approx(0.8, abs=0.02)
    # Facet normals miss by up to 180 / sections deg; interpolation leaves what the split of the quads causes.
    assert np.rad2deg(miss.max()) < 0.35 * 180 / sections
    assert np.abs(normals[wall, 2]).max() < 1e-9
    assert np.allclose(np.abs(normals[~wall, 2]), 1.0)


def test_normals_do_not_bend_over_sharp_edges() -> None:
    corners = surface_of(trimesh.creation.box((1.0, 2.0, 3.0))).corner_normals
    assert np.allclose(np.sort(np.abs(corners), axis=2), [0.0, 0.0, 1.0])


def test_seams_of_unwelded_meshes_are_smooth() -> None:
    welded = trimesh.creation.cylinder(radius=0.5, height=2.0, sections=24)
    loose = Part(
        name="part", vertices=welded.triangles.reshape(-1, 3), faces=np.arange(len(welded.faces) * 3).reshape(-1, 3)
    )
    apart = PartSurface(loose, crease_angle=CREASE)
    together = surface_of(welded)
    assert len(apart.welded[0]) == len(together.welded[0])
    assert np.allclose(apart.sample(500).normals, together.sample(500).normals)


# ---- features --------------------------------------------------------------------------------------------------------


def test_feature_edges_of_a_box_are_its_twelve_edges() -> None:
    pieces = surface_of(trimesh.creation.box((1.0, 2.0, 3.0))).feature_pieces
    assert sorted(pieces.lengths.round(9)) == [1.0] * 4 + [2.0] * 4 + [3.0] * 4
    assert np.allclose(np.sort(np.abs(pieces.tangents), axis=1), [0.0, 0.0, 1.0])


def test_boundaries_of_open_meshes_are_features() -> None:
    sheet = Part(
        name="sheet",
        vertices=np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]),
        faces=np.array([[0, 1, 2], [0, 2, 3]]),
    )
    assert len(PartSurface(sheet, crease_angle=CREASE).feature_edges) == 4


def test_feature_circles_have_the_axis_and_centre_of_the_rims() -> None:
    circles = posed_cylinder(32).feature_circles
    assert len(circles.lengths) >= 2 * 32
    centres = (circles.centres - SHIFT) @ TURN
    assert np.allclose(np.abs(circles.axes @ TURN), [0, 0, 1], atol=1e-9)
    assert np.allclose(np.abs(centres), [0, 0, 1], atol=1e-9)
    assert np.allclose(np.linalg.norm(circles.on_circle - circles.centres, axis=1), 0.5)


# ---- distance --------------------------------------------------------------------------------------------------------


@settings(max_examples=20)
@given(shift=st.floats(-1e4, 1e4), seed=st.integers(0, 1000))
def test_distance_to_a_box_is_exact_inside_and_outside_and_far_from_the_origin(shift: float, seed: int) -> None:
    half = np.array([0.5, 1.0, 1.5])
    mesh = trimesh.creation.box(2 * half)
    mesh.apply_translation([shift] * 3)
    local = np.random.default_rng(seed).uniform(-3, 3, (50, 3))
    beyond = np.abs(local) - half
    exact = np.where(
        (beyond > 0).any(axis=1), np.linalg.norm(np.maximum(beyond, 0), axis=1), np.abs(beyond.max(axis=1))
    )
    assert np.allclose(surface_of(mesh).distance(local + shift), exact, atol=1e-9)


# ---- samples ---------------------------------------------------------------------------------------------------------
