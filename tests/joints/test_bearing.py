"""Bearing lines: exact on known bearings, refined along true gradients, moving with the object."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_evidence import contact_centroid, contact_sides
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.joints.bearings.line import Line
from kinematify.joints.bearings.refine_lines import (
    refine_line,
)
from kinematify.robot.transforms import rotation_about
from tests.known import angle_deg, known_object, posed, turning
from tests.objects import BUILDERS

if TYPE_CHECKING:
    from kinematify.config import BearingConfig
    from kinematify.joints.bearings.bearing_evidence import Sides
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from tests.known import KnownJoint, KnownObject

CONFIG = load_config()
BEARING = CONFIG.bearing
WITH_BEARINGS = (
    "hinge_pin", "barrel_hinge_door", "knob", "lever", "wheel", "universal_joint",
    "serial_arm",
)  # fmt: skip
UP = np.array([0.0, 0.0, 1.0])


def fitted(known: KnownObject, config: BearingConfig = BEARING) -> dict[tuple[int, int], EdgeBearing]:
    assembly = known.assembly
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    return fit_bearings(assembly, surfaces, graph, config=config, seed=0)


@cache
def bearings_of(name: str) -> dict[tuple[int, int], EdgeBearing]:
    return fitted(BUILDERS[name]())


@cache
def sides_of(name: str) -> tuple[Sides, float]:
    """Evidence of both parts of the only contact of an object, and the object's diagonal."""
    assembly = BUILDERS[name]().assembly
    surfaces = part_surfaces(assembly, config=CONFIG.surface)
    graph = build_contact_graph(assembly, surfaces, config=CONFIG.contact, seed=0)
    return contact_sides(surfaces, graph.edges[0], config=BEARING.in_metres(assembly.diagonal)), assembly.diagonal


def best(known: KnownObject, joint: KnownJoint, found: dict[tuple[int, int], EdgeBearing]) -> BearingLine:
    a, b = sorted((known.index[joint.parent], known.index[joint.child]))
    return found[a, b].lines[0]


def line_distance(line: BearingLine, joint: KnownJoint) -> float:
    return float(np.linalg.norm(np.cross(line.pivot - joint.pivot, joint.axis)))


def assert_exact(known: KnownObject, found: dict[tuple[int, int], EdgeBearing]) -> None:
    """Within 0.1 deg and 0.2 % of the diagonal."""
    for joint in known.joints:
        line = best(known, joint, found)
        assert angle_deg(line.axis, joint.axis) < 0.1, joint.child
        assert line_distance(line, joint) < 2e-3 * known.assembly.diagonal, joint.child
        assert line.score > BEARING.turned_score, joint.child
        assert line.circles > 0.5, joint.child


# ---- known bearings --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", WITH_BEARINGS)
def test_the_best_line_is_the_true_axis(name: str) -> None:
    assert_exact(BUILDERS[name](), bearings_of(name))


@pytest.mark.parametrize("seed", [1])
@pytest.mark.parametrize("name", ["hinge_pin", "wheel"])
def test_other_sizes_are_as_exact(name: str, seed: int) -> None:
    known = BUILDERS[name](seed=seed)
    assert_exact(known, fitted(known))


@pytest.mark.parametrize("name", ["edge_door", "drawer", "sliding_lid", "button"])
def test_contacts_without_bearing_score_low(name: str) -> None:
    lines = [line for bearing in bearings_of(name).values() for line in bearing.lines]
    assert all(line.score < 0.02 for line in lines)
    assert all(line.circles == 0.0 for line in lines)


# ---- one-sided evidence ----------------------------------------------------------------------------------------------


def wheel_in_a_square_well() -> KnownObject:
    """Only the wheel is round; it hangs in the well without axle."""
    block = box((-0.2, -0.09, -0.2), (0.2, 0.09, 0.1)) - box((-0.11, -0.062, -0.09), (0.11, 0.062, 0.2))
    disc = cylinder(0.1, (0.0, -0.06, 0.02), (0.0, 0.06, 0.02))
    return known_object("well", {"block": block, "wheel": disc}, turning("block", "wheel", (0, 1, 0), (0, 0, 0.02)))


def test_a_wheel_in_a_square_well_turns_about_its_own_axis() -> None:
    known = wheel_in_a_square_well()
    found = fitted(known)[0, 1]
    one_sided = [line for line in found.lines if line.surfaces[0] == 0.0]
    assert len(one_sided) == 1
    assert one_sided[0].surfaces[1] > BEARING.turned_support
    assert one_sided[0].score == pytest.approx(BEARING.turned_score * one_sided[0].surfaces[1])
    assert found.lines[0] is one_sided[0]
    assert angle_deg(one_sided[0].axis, known.joints[0].axis) < 0.1
    assert line_distance(one_sided[0], known.joints[0]) < 2e-3 * known.assembly.diagonal


def test_long_rods_do_not_turn_about_themselves() -> None:
    """A rod that leans in a corner of a square post may be hinged at its end."""
    post, rod = box((0, 0, 0), (0.1, 0.1, 0.5)), cylinder(0.02, (0.121, 0.05, 0.0), (0.121, 0.05, 0.5))
    lines = fitted(known_object("rod", {"post": post, "rod": rod}))[0, 1].lines
    assert all(line.surfaces[0] > 0.0 for line in lines)


# ---- evidence --------------------------------------------------------------------------------------------------------


# ---- scores ----------------------------------------------------------------------------------------------------------


# ---- refinement ------------------------------------------------------------------------------------------------------


@settings(max_examples=5)
@given(seed=st.integers(0, 10**6), name=st.sampled_from(["knob", "wheel"]))
def test_refinement_returns_from_one_degree(seed: int, name: str) -> None:
    sides, _ = sides_of(name)
    joint = BUILDERS[name]().joints[0]
    rng = np.random.default_rng(seed)
    tilt, way = rng.normal(size=(2, 3))
    axis = rotation_about(tilt / np.linalg.norm(tilt), np.deg2rad(1.0)) @ joint.axis
    centre = Line(axis=joint.axis, point=joint.pivot).foot(contact_centroid(sides))
    start = Line(axis=axis, point=centre + 2e-4 * way / np.linalg.norm(way))
    tolerances = np.geomspace(BEARING.normal_tolerance_sine, BEARING.fine_tolerance_sine, 8)
    found = refine_line(sides, start, tolerances, BEARING)
    assert np.linalg.norm(found.axis) == pytest.approx(1.0)
    assert angle_deg(found.axis, joint.axis) < 0.1
    assert np.linalg.norm(np.cross(found.point - joint.pivot, joint.axis)) < 1e-4


# ---- lines -----------------------------------------------------------------------------------------------------------


# ---- laws ------------------------------------------------------------------------------------------------------------


def transform(turn: np.ndarray, shift: np.ndarray, scale: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * turn, shift
    return matrix


@settings(max_examples=2)
@given(seed=st.integers(0, 10**6), scale=st.floats(1e-3, 1e3))
def test_lines_move_turn_and_grow_with_the_object(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    turn = rotation_about(axis / np.linalg.norm(axis), rng.uniform(0, np.pi))
    shift = scale * rng.normal(size=3)
    known = BUILDERS["hinge_pin"]()
    placed = posed(known, transform(turn, shift, scale))
    line = fitted(placed)[0, 1].lines[0]
    before = bearings_of("hinge_pin")[0, 1].lines[0]
    assert angle_deg(line.axis, turn @ known.joints[0].axis) < 0.1
    assert np.linalg.norm(np.cross(line.pivot - shift, turn @ UP)) < 2e-3 * placed.assembly.diagonal
    assert line.score == pytest.approx(before.score, rel=0.25)  # the diagonal of the upright box changes
