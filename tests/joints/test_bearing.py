"""Bearing lines: exact on known bearings, refined along true gradients, moving with the object."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematify.assembly.part import Assembly, Part
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.generate.procedural.solids import bore, box, cylinder
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_evidence import contact_centroid, contact_sides, thin, whole_side
from kinematify.joints.bearings.bearing_fit import fit_bearings, normal_pair_lines
from kinematify.joints.bearings.line import Line, Lines, join
from kinematify.joints.bearings.refine_lines import (
    across_axis,
    circle_rows,
    line_frames,
    moved_lines,
    refine_line,
    refine_lines,
    surface_rows,
)
from kinematify.joints.bearings.scores import circle_support, line_support, surface_support
from kinematify.robot.transforms import rotation_about
from tests.known import known_object, posed, turning
from tests.objects import BUILDERS

if TYPE_CHECKING:
    from kinematify.config import BearingConfig
    from kinematify.joints.bearings.bearing_evidence import Sides
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from tests.known import KnownJoint, KnownObject

CONFIG = load_config()
BEARING = CONFIG.bearing
WITH_BEARINGS = (
    "hinge_pin", "barrel_hinge_door", "knob", "scissors", "laptop", "piano_box", "lever", "wheel", "universal_joint",
    "gimbal", "finger_hand", "serial_arm",
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
    return contact_sides(surfaces, graph.edges[0], diagonal=assembly.diagonal, config=BEARING), assembly.diagonal


def best(known: KnownObject, joint: KnownJoint, found: dict[tuple[int, int], EdgeBearing]) -> BearingLine:
    a, b = sorted((known.index[joint.parent], known.index[joint.child]))
    return found[a, b].lines[0]


def angle_deg(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(first, second)), abs(first @ second))))


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
@pytest.mark.parametrize("name", ["hinge_pin", "knob", "wheel"])
def test_other_sizes_are_as_exact(name: str, seed: int) -> None:
    known = BUILDERS[name](seed=seed)
    assert_exact(known, fitted(known))


@pytest.mark.parametrize("name", ["edge_door", "drawer", "sliding_lid", "button"])
def test_contacts_without_bearing_score_low(name: str) -> None:
    lines = [line for bearing in bearings_of(name).values() for line in bearing.lines]
    assert all(line.score < 0.02 for line in lines)
    assert all(line.circles == 0.0 for line in lines)


@pytest.mark.parametrize("name", ["hinge_pin", "finger_hand"])
def test_lines_are_scored_distinct_and_best_first(name: str) -> None:
    diagonal = BUILDERS[name]().assembly.diagonal
    for pair, bearing in bearings_of(name).items():
        assert (bearing.a, bearing.b) == pair
        scores = [line.score for line in bearing.lines]
        assert scores == sorted(scores, reverse=True)
        assert 0 < len(scores) <= BEARING.keep
        for line in bearing.lines:
            values = (
                line.surface_a,
                line.surface_b,
                line.circles_a,
                line.circles_b,
                line.surface,
                line.circles,
                line.score,
            )
            assert all(0.0 <= value <= 1.0 for value in values)
            assert np.linalg.norm(line.axis) == pytest.approx(1.0)
            assert (line.pivot - bearing.centroid) @ line.axis == pytest.approx(0.0, abs=1e-9)
        where = Lines(
            axes=np.array([line.axis for line in bearing.lines]),
            points=np.array([line.pivot for line in bearing.lines]),
        )
        kept = where.distinct(99, angle=BEARING.apart_angle, distance=BEARING.apart * diagonal)
        assert kept == list(range(len(scores)))


# ---- one-sided evidence ----------------------------------------------------------------------------------------------


def wheel_in_a_square_well() -> KnownObject:
    """Only the wheel is round; it hangs in the well without axle."""
    block = box((-0.2, -0.09, -0.2), (0.2, 0.09, 0.1)) - box((-0.11, -0.062, -0.09), (0.11, 0.062, 0.2))
    disc = cylinder(0.1, (0.0, -0.06, 0.02), (0.0, 0.06, 0.02))
    return known_object("well", {"block": block, "wheel": disc}, turning("block", "wheel", (0, 1, 0), (0, 0, 0.02)))


def test_a_wheel_in_a_square_well_turns_about_its_own_axis() -> None:
    known = wheel_in_a_square_well()
    found = fitted(known)[0, 1]
    one_sided = [line for line in found.lines if line.surface_a == 0.0]
    assert len(one_sided) == 1
    assert one_sided[0].surface_b > BEARING.turned_support
    assert one_sided[0].score == pytest.approx(BEARING.turned_score * one_sided[0].surface_b)
    assert found.lines[0] is one_sided[0]
    assert angle_deg(one_sided[0].axis, known.joints[0].axis) < 0.1
    assert line_distance(one_sided[0], known.joints[0]) < 2e-3 * known.assembly.diagonal


def test_long_rods_do_not_turn_about_themselves() -> None:
    """A rod that leans in a corner of a square post may be hinged at its end."""
    post, rod = box((0, 0, 0), (0.1, 0.1, 0.5)), cylinder(0.02, (0.121, 0.05, 0.0), (0.121, 0.05, 0.5))
    lines = fitted(known_object("rod", {"post": post, "rod": rod}))[0, 1].lines
    assert all(line.surface_a > 0.0 for line in lines)


def test_two_sided_bearings_need_no_one_sided_line() -> None:
    assert all(line.surface_a > 0 and line.surface_b > 0 for line in bearings_of("wheel")[0, 1].lines)


# ---- evidence --------------------------------------------------------------------------------------------------------


def test_evidence_is_weighted_by_nearness() -> None:
    sides, _ = sides_of("hinge_pin")
    for side in sides:
        assert len(side.points) == len(side.normals) == len(side.weights) > 100
        assert np.all((side.edge_weights >= np.exp(-4.6)) & (side.edge_weights <= 1.0))
        assert len(side.circle_weights) == len(side.circle_axes) > 0
    assert np.linalg.norm(contact_centroid(sides)[:2]) < 0.005  # near the pin


def test_thinning_keeps_the_edges() -> None:
    side = sides_of("hinge_pin")[0][0]
    few = thin(side, 50)
    assert len(few.points) == len(few.weights) == 50
    assert few.tangents is side.tangents
    assert thin(side, 10**6) is side


def test_nothing_near_gives_the_centre_of_nothing() -> None:
    empty = replace(thin(sides_of("knob")[0][0], 1), points=np.empty((0, 3)), weights=np.empty(0))
    assert np.array_equal(contact_centroid((empty, empty)), np.zeros(3))


# ---- scores ----------------------------------------------------------------------------------------------------------


def axle_side(segments: int = 64) -> tuple[object, Line]:
    solid = cylinder(0.1, (0, 0, -0.5), (0, 0, 0.5), segments=segments).to_mesh64()
    part = Part(name="axle", vertices=solid.vert_properties[:, :3], faces=solid.tri_verts)
    surface = part_surfaces(Assembly(parts=(part,), source="test"), config=CONFIG.surface)[0]
    return whole_side(surface, 2000), Line(axis=UP, point=np.zeros(3))


def test_a_cylinder_supports_its_own_axis_only() -> None:
    side, axis = axle_side()
    wall = 0.1 * 2 * np.pi / (0.1 * 2 * np.pi + 2 * np.pi * 0.01)  # share of the wall in the area
    assert line_support(side, axis, BEARING) == pytest.approx(wall + BEARING.flange_weight * (1 - wall), abs=0.01)
    assert line_support(side, Line(axis=UP, point=np.array([0.05, 0, 0])), BEARING) < 0.1
    assert line_support(side, Line(axis=np.array([1.0, 0, 0]), point=np.zeros(3)), BEARING) < 0.1


def test_many_lines_score_as_each_alone() -> None:
    side, _ = axle_side()
    rng = np.random.default_rng(0)
    axes = rng.normal(size=(600, 3))
    lines = Lines(axes=axes / np.linalg.norm(axes, axis=1)[:, None], points=rng.normal(size=(600, 3)))
    support = surface_support(side, lines, BEARING)
    assert support.shape == (600,)
    assert [line_support(side, lines[k], BEARING) for k in (0, 255, 256, 599)] == pytest.approx(
        support[[0, 255, 256, 599]]
    )


def test_no_lines_have_no_scores() -> None:
    side, _ = axle_side()
    assert surface_support(side, Lines(axes=np.empty((0, 3)), points=np.empty((0, 3))), BEARING).shape == (0,)


def test_circles_count_where_they_run_around_the_line() -> None:
    sides, diagonal = sides_of("knob")
    axis = bearings_of("knob")[0, 1].lines[0].line
    aside = Line(axis=axis.axis, point=axis.point + 0.02 * diagonal * across_axis(axis.axis)[0])
    for side in sides:
        assert circle_support(side, axis, diagonal=diagonal, config=BEARING) > 0.5
        assert circle_support(side, aside, diagonal=diagonal, config=BEARING) < 0.3


# ---- refinement ------------------------------------------------------------------------------------------------------

STEP = 1e-6


@settings(max_examples=10)
@given(seed=st.integers(0, 10**6), name=st.sampled_from(["hinge_pin", "knob", "wheel"]))
def test_the_gradient_of_the_residuals_is_their_difference_quotient(seed: int, name: str) -> None:
    """Radii are frozen in the linearisation, so the residuals are compared times their radius."""
    sides, diagonal = sides_of(name)
    rng = np.random.default_rng(seed)
    axis = rng.normal(size=3)
    line = Line(axis=axis / np.linalg.norm(axis), point=contact_centroid(sides) + 0.1 * diagonal * rng.normal(size=3))
    lines = Lines(axes=line.axis[None], points=line.point[None])
    frames, spread = line_frames(lines.axes), 0.3 * diagonal
    for side in sides:
        for rows_of, numerators in ((surface_rows, surface_numerators), (circle_rows, circle_numerators)):
            extra = {"share": 1.0} if rows_of is circle_rows else {}
            rows = rows_of(side, lines, frames, spread=spread, tolerance=0.1, **extra)
            here, radius = numerators(side, line, line)
            assert np.allclose(rows.rest[0] * radius, here, atol=1e-9)
            for column in range(4):
                step = STEP * np.eye(4)[column]
                ahead, back = (
                    numerators(side, moved_lines(lines, frames, sign * step[None], spread=spread)[0], line)[0]
                    for sign in (1, -1)
                )
                quotient = (ahead - back) / (2 * STEP)
                assert np.allclose(
                    rows.design[0, column] * radius, quotient, atol=1e-6 * max(1.0, np.abs(quotient).max())
                )


def surface_numerators(side: object, line: Line, frozen: Line) -> tuple[np.ndarray, np.ndarray]:
    """n . (u x (x - p)) at `line`, radii at `frozen`."""
    radius = np.linalg.norm(np.cross(side.points - frozen.point, frozen.axis), axis=1)
    return np.einsum("ij,ij->i", side.normals, np.cross(line.axis, side.points - line.point)), radius


def circle_numerators(side: object, line: Line, frozen: Line) -> tuple[np.ndarray, np.ndarray]:
    """t . u and t . (m - p) with the part along the frozen axis taken away."""
    arm = side.middles - line.point
    frozen_arm = side.middles - frozen.point
    radius = np.linalg.norm(np.cross(frozen_arm, frozen.axis), axis=1)
    along = (frozen_arm @ frozen.axis) * (side.tangents @ frozen.axis)
    outward = np.einsum("ij,ij->i", side.tangents, arm) - along
    return np.concatenate([side.tangents @ line.axis, outward]), np.concatenate([np.ones(len(radius)), radius])


@settings(max_examples=20)
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


def test_lines_are_refined_together_as_each_alone() -> None:
    sides, diagonal = sides_of("knob")
    rng = np.random.default_rng(0)
    axes = rng.normal(size=(20, 3))
    points = contact_centroid(sides) + 0.05 * diagonal * rng.normal(size=(20, 3))
    lines = Lines(axes=axes / np.linalg.norm(axes, axis=1)[:, None], points=points)
    tolerances = np.array([BEARING.normal_tolerance_sine] * 2)
    for tilting in (True, False):
        found = refine_lines(sides, lines, tolerances, BEARING, turning=tilting)
        alone = [refine_line(sides, line, tolerances, BEARING, turning=tilting) for line in lines]
        assert np.allclose(found.axes, [line.axis for line in alone], atol=1e-9)
        assert np.allclose(found.points, [line.point for line in alone], atol=1e-9 * diagonal)
        assert np.allclose(found.axes, lines.axes) != tilting


def test_pairs_of_normals_meet_on_the_axis_of_a_cylinder() -> None:
    side, _ = axle_side()
    wall = np.abs(side.normals[:, 2]) < 0.5
    walls = replace(side, points=side.points[wall], normals=side.normals[wall], weights=side.weights[wall])
    lines = normal_pair_lines(walls, 200, np.random.default_rng(0))
    assert len(lines) > 150
    assert np.allclose(np.abs(lines.axes), UP, atol=1e-9)
    assert np.linalg.norm(lines.points[:, :2], axis=1).max() < 0.005


# ---- lines -----------------------------------------------------------------------------------------------------------


def test_lines_know_their_feet_and_repetitions() -> None:
    axes = np.array([[0, 0, 1.0], [0, 0, -1.0], [0, 0, 1.0], [1.0, 0, 0]])
    lines = Lines(axes=axes, points=np.array([[0, 0, 0], [1e-4, 0, 7.0], [1.0, 0, 0], [0, 0, 0]]))
    assert lines.distinct(9, angle=2.0, distance=0.01) == [0, 2, 3]
    assert lines.distinct(2, angle=2.0, distance=0.01) == [0, 2]
    assert np.allclose(lines[1].foot(np.array([5.0, 5.0, 3.0])), [1e-4, 0, 3.0])
    assert np.allclose(lines.through_feet(np.array([5.0, 5.0, 3.0])).points[1], [1e-4, 0, 3.0])
    assert [line.axis.tolist() for line in join([lines, lines.subset([3])])] == [*axes.tolist(), [1.0, 0.0, 0.0]]


# ---- laws ------------------------------------------------------------------------------------------------------------


def transform(turn: np.ndarray, shift: np.ndarray, scale: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * turn, shift
    return matrix


@settings(max_examples=4)
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


@settings(max_examples=4)
@given(scale=st.floats(1e-3, 1e3), shift=st.floats(-3.0, 3.0))
def test_scores_do_not_change_with_size_and_place(scale: float, shift: float) -> None:
    line = fitted(posed(BUILDERS["knob"](), transform(np.eye(3), np.full(3, scale * shift), scale)))[0, 1].lines[0]
    before = bearings_of("knob")[0, 1].lines[0]
    assert line.score == pytest.approx(before.score, rel=1e-3)
    assert np.allclose(line.pivot / scale - shift, before.pivot, atol=1e-5)


@pytest.mark.parametrize("name", ["universal_joint", "piano_box"])
def test_permuting_the_parts_permutes_the_bearings(name: str) -> None:
    """Scores depend on what is drawn, so that they are equal only if draws do not depend on numbers of parts."""
    known = BUILDERS[name]()
    permuted = replace(known, parts=known.parts[::-1])
    found = fitted(permuted)
    assert_exact(permuted, found)
    here, there = (
        sorted(line.score for item in each.values() for line in item.lines) for each in (found, bearings_of(name))
    )
    np.testing.assert_allclose(here, there, atol=1e-9)


@pytest.mark.parametrize("name", ["knob", "gimbal"])
def test_what_is_drawn_as_for_rough_parts_does_not_depend_on_their_order(name: str) -> None:
    config = BEARING.model_copy(update={"directed_pairs": BEARING.rough_directed_pairs})
    known = BUILDERS[name]()
    last = len(known.parts) - 1
    found, permuted = fitted(known, config), fitted(replace(known, parts=known.parts[::-1]), config)
    for (a, b), bearing in found.items():
        there = permuted[last - b, last - a]
        for line, other in zip(bearing.lines, there.lines, strict=True):
            assert abs(line.axis @ other.axis) == pytest.approx(1.0, abs=1e-9)
            assert [line.score, line.surface_a] == pytest.approx([other.score, other.surface_b], abs=1e-9)


def test_the_same_seed_gives_the_same_lines() -> None:
    again = fitted(BUILDERS["hinge_pin"]())[0, 1].lines
    assert [line.axis.tolist() for line in again] == [
        line.axis.tolist() for line in bearings_of("hinge_pin")[0, 1].lines
    ]


def test_a_bore_that_is_no_bearing_neighbour_is_ignored() -> None:
    """A second bore far from the contact does not move the line."""
    plate = box((-0.1, -0.1, -0.02), (0.1, 0.1, 0.0)) - bore(0.01, 3e-4, (0, 0, -1), (0, 0, 1))
    drilled = plate - cylinder(0.02, (0.06, 0.06, -1), (0.06, 0.06, 1))
    pin = cylinder(0.01, (0, 0, -0.019), (0, 0, 0.02))
    for body in (plate, drilled):
        known = known_object("plate", {"plate": body, "pin": pin}, turning("plate", "pin", (0, 0, 1), (0, 0, 0)))
        line = fitted(known)[0, 1].lines[0]
        assert angle_deg(line.axis, UP) < 0.1
        assert line_distance(line, known.joints[0]) < 2e-3 * known.assembly.diagonal
