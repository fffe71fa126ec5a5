"""Mass properties: exact for known solids, and with the laws of mechanics for all others."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.model.masses import inertial_of
from kinematify.robot.appearance import Appearance, Material
from kinematify.robot.densities import density_of
from kinematify.robot.robot import Inertial

CONFIG = load_config().model.model_copy(update={"wall_weight": 1e9})
"""All bodies are solid."""
ORIGIN = np.zeros(3)


def inertial(vertices, faces, origin=ORIGIN, thickness=1e-5) -> Inertial:
    part = Part(name="part", vertices=vertices, faces=faces)
    return inertial_of(part, origin, thickness=thickness, config=CONFIG)


def assert_physical(found: Inertial) -> None:
    low, middle, high = np.linalg.eigvalsh(found.tensor)
    assert found.mass > 0
    assert low > 0
    assert low + middle >= high


def test_box():
    mesh = trimesh.creation.box((0.2, 0.3, 0.5))
    found = inertial(mesh.vertices + np.array([1, 2, 3]), mesh.faces, origin=np.array([1, 2, 2.5]))
    mass = CONFIG.solid_density * 0.03
    assert found.source == "volume"
    assert found.mass == pytest.approx(mass)
    np.testing.assert_allclose(found.center_of_mass, (0, 0, 0.5), atol=1e-12)
    expected = mass / 12 * np.diag([0.3**2 + 0.5**2, 0.2**2 + 0.5**2, 0.2**2 + 0.3**2])
    np.testing.assert_allclose(found.tensor, expected, atol=1e-12)


def test_cylinder_and_sphere():
    cylinder = trimesh.creation.cylinder(radius=0.1, height=0.4, sections=400)
    found = inertial(cylinder.vertices, cylinder.faces)
    assert found.mass == pytest.approx(CONFIG.solid_density * np.pi * 0.01 * 0.4, rel=1e-3)
    across = found.mass * (3 * 0.01 + 0.16) / 12
    np.testing.assert_allclose(np.diag(found.tensor), (across, across, found.mass * 0.005), rtol=1e-3)
    sphere = trimesh.creation.icosphere(subdivisions=5, radius=0.3)
    found = inertial(sphere.vertices, sphere.faces)
    np.testing.assert_allclose(found.tensor, 0.4 * found.mass * 0.09 * np.eye(3), rtol=2e-3, atol=1e-9)


def test_hollow_and_inside_out_and_soup():
    outer, inner = trimesh.creation.box((2, 2, 2)), trimesh.creation.box((1, 1, 1))
    vertices = np.concatenate([outer.vertices, inner.vertices])
    hollow = np.concatenate([outer.faces, inner.faces[:, ::-1] + 8])
    found = inertial(vertices, hollow)
    assert found.mass == pytest.approx(7 * CONFIG.solid_density)
    inside_out = inertial(vertices, hollow[:, ::-1])
    assert inside_out.mass == pytest.approx(found.mass)
    np.testing.assert_allclose(inside_out.tensor, found.tensor)
    soup = inertial(vertices[hollow].reshape(-1, 3), np.arange(hollow.size).reshape(-1, 3))
    assert soup.source == "volume"
    assert soup.mass == pytest.approx(found.mass)


@pytest.mark.parametrize("case", ["open", "one face turned", "double sided", "overlapping copies"])
def test_what_encloses_nothing_definite_weighs_as_its_hull(case):
    mesh = trimesh.creation.box((0.2, 0.3, 0.5))
    faces = {
        "open": mesh.faces[1:],
        "one face turned": np.concatenate([mesh.faces[:1, ::-1], mesh.faces[1:]]),
        "double sided": np.concatenate([mesh.faces, mesh.faces[:, ::-1]]),
        "overlapping copies": np.concatenate([mesh.faces, mesh.faces]),
    }[case]
    found = inertial(mesh.vertices, faces)
    assert found.source == "hull"
    assert found.mass == pytest.approx(CONFIG.hull_density * 0.03)


@pytest.mark.parametrize(
    "vertices",
    [
        [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        [[0, 0, 0], [1, 0, 0], [2, 0, 0]],
        [[3, 3, 3], [3, 3, 3], [3, 3, 3]],
        [[0, 0, 0], [1, 1, 1e-9], [-1, 1, 2]],
    ],
    ids=["flat", "line", "point", "oblique"],
)
def test_parts_without_volume_get_a_thickness(vertices):
    found = inertial(np.array(vertices, dtype=float), np.array([[0, 1, 2]]), thickness=1e-3)
    assert found.source == "hull"
    assert_physical(found)
    np.testing.assert_allclose(found.center_of_mass, np.mean(np.array(vertices), axis=0), atol=0.4)


def test_a_body_that_is_too_heavy_to_be_solid_is_a_shell() -> None:
    mesh = trimesh.creation.box((1.0, 1.0, 1.0))
    part = Part(name="case", vertices=mesh.vertices + 2.0, faces=mesh.faces, density=7850.0)
    found = inertial_of(part, ORIGIN, thickness=1e-5, config=load_config().model)
    assert (found.source, found.mass) == ("shell", pytest.approx(6.0 * load_config().model.wall_weight))
    assert found.center_of_mass == pytest.approx([2.0, 2.0, 2.0])
    assert np.diag(found.tensor) == pytest.approx(np.full(3, found.mass * 5.0 / 18.0))  # of a hollow cube
    assert_physical(found)


def test_density_by_the_names_of_materials() -> None:
    corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]] * 4, dtype=float)
    names = ("Brushed_Steel.001", "OakVeneer", "paint")
    looks = Appearance(materials=tuple(Material(name=name) for name in names), material_of_face=np.array([0, 1, 1, 2]))
    assert density_of(looks, corners) == pytest.approx((7850.0 + 2 * 710.0) / 3)
    plain = Appearance(materials=(Material(name="paint"),), material_of_face=np.zeros(4, dtype=np.int64))
    assert density_of(plain, corners) is None
