"""How far a slide stays in its guide, and the ranges that follow from it."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify.generate.procedural.solids import bore, box, cylinder
from kinematify.joints.choice.limits import find_range, guided_share, guided_travel
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import scene_of
from tests.known import known_object, sliding

if TYPE_CHECKING:
    from kinematify.joints.features.edge_scene import JointScene

GAP = 3e-4
X = np.array([1.0, 0.0, 0.0])
Z = np.array([0.0, 0.0, 1.0])


@cache
def telescope() -> JointScene:
    """A rod of 0.3 m inside a tube, whose other 0.2 m stand out of it."""
    tube = cylinder(0.03, (0, 0, 0), (0, 0, 0.32)) - cylinder(0.02 + GAP, (0, 0, 0.02), (0, 0, 1))
    solids = {"tube": tube, "rod": cylinder(0.02, (0, 0, 0.02 + GAP), (0, 0, 0.52))}
    return scene_of(known_object("telescope", solids, sliding("tube", "rod", Z, (0, 0, 0), (0, 0.2))), "rod")


@cache
def carriage() -> JointScene:
    """A block of 0.06 m in the middle of a square rail of 0.6 m."""
    block = box((-0.03, -0.03, -0.03), (0.03, 0.03, 0.03)) - box(
        (-1, -0.01 - GAP, -0.01 - GAP), (1, 0.01 + GAP, 0.01 + GAP)
    )
    solids = {"rail": box((-0.3, -0.01, -0.01), (0.3, 0.01, 0.01)), "block": block}
    return scene_of(known_object("carriage", solids, sliding("rail", "block", X, (0, 0, 0), (-0.25, 0.25))), "block")


@cache
def collar() -> JointScene:
    """A ring of 0.03 m low on a rod of 1 m, with a knob at its top."""
    rod = (
        cylinder(0.01, (0, 0, 0), (0, 0, 1))
        + cylinder(0.03, (0, 0, 0.98), (0, 0, 1.0))
        + cylinder(0.03, (0, 0, 0), (0, 0, 0.02))
    )
    ring = cylinder(0.02, (0, 0, 0.05), (0, 0, 0.08)) - bore(0.01, GAP, (0, 0, -1), (0, 0, 2))
    solids = {"rod": rod, "ring": ring}
    return scene_of(known_object("collar", solids, sliding("rod", "ring", Z, (0, 0, 0.05), (0, 0.9))), "ring")


@cache
def push_button() -> JointScene:
    """A button with a long stem in a shell: 8 mm stand out, and a ledge stops it after 6 mm."""
    shell = cylinder(0.02, (0, 0, 0), (0, 0, 0.2)) - cylinder(0.006 + GAP, (0, 0, 0.04), (0, 0, 0.3))
    solids = {"shell": shell, "button": cylinder(0.006, (0, 0, 0.046), (0, 0, 0.208))}
    return scene_of(known_object("pen", solids, sliding("shell", "button", -Z, (0, 0, 0.2), (0, 0.006))), "button")


def test_a_telescope_leaves_its_tube_evenly_and_keeps_some_of_it() -> None:
    scene = telescope()
    share = guided_share(scene, Z, np.array([0.0, 0.15, 0.4]))
    assert share is not None
    assert share == pytest.approx([1.0, 0.5, 0.0], abs=0.1)
    assert guided_travel(scene, Z) == pytest.approx(0.8 * 0.3, abs=0.03)


def test_a_carriage_goes_to_the_ends_of_its_rail() -> None:
    scene = carriage()
    for direction in (X, -X):
        assert guided_travel(scene, direction) == pytest.approx(0.27, abs=0.03)


def test_a_collar_runs_along_its_rod_although_it_is_small() -> None:
    found = find_range(collar(), JointType.PRISMATIC, Z, np.array([0.0, 0.0, 0.05]))
    assert collar().smallness >= 1.0
    assert found.ahead.motion + found.back.motion == pytest.approx(0.93, abs=0.05)


def test_the_stem_of_a_button_is_no_travel() -> None:
    found = find_range(push_button(), JointType.PRISMATIC, -Z, np.array([0.0, 0.0, 0.2]))
    assert found.sign > 0.0
    assert 0.003 < found.ahead.motion < 0.009


def test_a_lid_that_lies_on_top_does_not_sink() -> None:
    """A plate on a rim; nothing below it would stop it but the rim, which its shrunk samples may pass."""
    pot = cylinder(0.12, (0, 0, 0), (0, 0, 0.2)) - cylinder(0.11, (0, 0, 0.01), (0, 0, 1))
    lid = cylinder(0.1095, (0, 0, 0.19), (0, 0, 0.2)) + cylinder(0.02, (0, 0, 0.199), (0, 0, 0.24))
    scene = scene_of(
        known_object("pot", {"pot": pot, "lid": lid}, sliding("pot", "lid", Z, (0, 0, 0.2), (0, 0.1))), "lid"
    )
    found = find_range(scene, JointType.PRISMATIC, Z, np.array([0.0, 0.0, 0.2]))
    assert found.sign > 0.0
    assert found.back.motion == 0.0
    assert found.ahead.motion > 0.02


def test_a_cap_that_goes_round_its_pen_is_drawn_off() -> None:
    """There is room between the tip of the pen and the end of the cap, as below a button."""
    pen = cylinder(0.005, (0, 0, 0.006), (0, 0, 0.06)) + cylinder(0.006, (0, 0, 0.06), (0, 0, 0.14))
    cap = cylinder(0.006, (0, 0, -0.002), (0, 0, 0.0575)) - cylinder(0.005 + 2e-4, (0, 0, 0.0), (0, 0, 1))
    scene = scene_of(
        known_object("pen", {"pen": pen, "cap": cap}, sliding("pen", "cap", -Z, (0, 0, 0), (0, 0.06))), "cap"
    )
    found = find_range(scene, JointType.PRISMATIC, Z, np.array([0.0, 0.0, 0.03]))
    assert found.sign < 0.0
    assert found.ahead.motion > 0.03
