"""Candidate lines of turning joints and their ranking."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematify.generate.procedural.solids import box
from kinematify.joints.features.ranking import Ranked
from tests.joints.joint_scenes import infer_joints, ranked_turns, scene_of
from tests.known import known_object, turning
from tests.objects import BUILDERS


def off_line(axis: np.ndarray, pivot: np.ndarray, line_axis: np.ndarray, line_pivot: np.ndarray) -> tuple[float, float]:
    """Angle [deg] and distance of two nearly parallel lines."""
    angle = np.degrees(np.arccos(min(1.0, abs(float(axis @ line_axis)))))
    return angle, float(np.linalg.norm(np.cross(pivot - line_pivot, line_axis)))


@pytest.mark.parametrize("name", ["edge_door", "hinge_pin", "barrel_hinge_door"])
def test_the_true_line_is_among_the_candidates_and_wins(name: str) -> None:
    known = BUILDERS[name]()
    joint = known.joints[0]
    scene = scene_of(known, joint.child)
    ranked = ranked_turns(scene)
    angle, distance = off_line(ranked.lines.axes[0], ranked.lines.pivots[0], joint.axis, joint.pivot)
    assert angle < 2.0
    assert distance < 0.04 * scene.diagonal


def door_with_handle(side: float) -> object:
    """A closed door without hinges in a frame that is the same on both sides; only the handle tells."""
    body = box((-0.3, 0.0, 0.0), (0.3, 0.4, 0.8)) - box((-0.28, -0.1, 0.02), (0.28, 0.38, 0.78))
    panel = box((-0.29, -0.022, 0.01), (0.29, -0.002, 0.79))
    panel += box((side * 0.24 - 0.01, -0.06, 0.3), (side * 0.24 + 0.01, -0.01, 0.5))
    joint = turning("body", "door", (0, 0, 1), (-side * 0.29, -0.012, 0), limits=(0.0, 1.5))
    return known_object("handled", {"body": body, "door": panel}, joint)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_the_hinge_is_opposite_the_handle(side: float) -> None:
    scene = scene_of(door_with_handle(side), "door")
    ranked = ranked_turns(scene)
    assert abs(ranked.lines.axes[0][2]) > 0.99
    assert np.sign(ranked.lines.pivots[0][0]) == -side


def weak_evidence(*axes_and_scores: tuple[tuple[float, float, float], float]) -> Ranked:
    """The elbow of an arm whose bearing lines are those given, all too weak to decide."""
    known = BUILDERS["serial_arm"]()
    scene = scene_of(known, known.joints[1].child)
    assert scene.mechanism == 1.0
    assert scene.fitted is not None
    best = scene.lines[0]
    weak = replace(best, surfaces=(0.0, 0.0))
    lines = tuple(replace(weak, axis=np.asarray(axis), score=score) for axis, score in axes_and_scores)
    unsure = replace(scene, fitted=replace(scene.fitted, lines=lines))
    assert not unsure.has_bearing
    return ranked_turns(unsure)


def test_axes_of_machines_run_along_their_parts() -> None:
    ranked = weak_evidence(((0.6, 0.0, 0.8), 0.005), ((0.0, 1.0, 0.0), 0.0045), ((1.0, 0.0, 0.0), 0.0045))
    square = {
        tuple(axis.round(3).tolist()): cue
        for axis, cue, source in zip(ranked.lines.axes, ranked.cues["square"], ranked.lines.sources, strict=True)
        if source == "weak_bearing"
    }
    assert square == {(0.6, 0.0, 0.8): 0.0, (0.0, 1.0, 0.0): 1.0, (1.0, 0.0, 0.0): 1.0}
    assert ranked.cues["square"][ranked.lines.sources == "box_edge"].max() == 0.0


def test_thick_high_doors_side_by_side_are_hinged_at_their_outer_edges() -> None:
    """Half as thick as wide, as in a fridge: neither drawers, nor hinged above or below."""
    body = box((-0.2, 0.0, 0.0), (0.2, 0.5, 1.0)) - box((-0.18, -0.1, 0.02), (0.18, 0.48, 0.98))
    solids, joints = {"body": body}, []
    for k, side in enumerate((-1, 1)):
        inner, outer = 0.001 * side, 0.2 * side
        solids[f"door_{k}"] = box((min(inner, outer), -0.098, 0.001), (max(inner, outer), -0.001, 0.999))
        joints.append(turning("body", f"door_{k}", (0, 0, side), (outer, -0.001, 0), (0.0, 1.8)))
    found = infer_joints(known_object("fridge", solids, *joints))
    for k, side in enumerate((-1, 1)):
        estimate = found[f"door_{k}"]
        assert estimate.kind.turns
        assert abs(float(estimate.axis[2])) > 0.999
        assert np.sign(estimate.pivot[0]) == side
        assert abs(float(estimate.pivot[0])) > 0.15
