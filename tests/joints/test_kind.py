"""Types of joints on known objects."""

from __future__ import annotations

import pytest

from kinematify import infer
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.generate.registry import build
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import (
    infer_joints,
)
from tests.known import known_object, sliding, turning


@pytest.mark.parametrize("seed", range(2))
def test_a_drawer_behind_the_whole_front_of_a_cabinet_slides(seed: int) -> None:
    """Half as deep as its front is high: no door, for it is inside its body."""
    inference = infer(build("cabinet", {"doors": 0, "drawers": 1}, seed=seed).assembly)
    assert [joint.kind for joint in inference.joints] == [JointType.PRISMATIC]


def test_a_gantry_slides_on_its_rails() -> None:
    """Its bridge and its ram are thin as doors are, but rails hold them."""
    inference = infer(build("gantry", seed=0).assembly)
    assert [joint.kind for joint in inference.joints] == [JointType.PRISMATIC] * 3


def test_bars_in_short_sleeves_slide_in_machines() -> None:
    """The ram of a coarse gantry and the spline of an arm: their rails are faint, but nothing about them is round."""
    for family, child, style in (("gantry", "ram", "coarse"), ("scara", "spindle", "remeshed")):
        blueprint = build(family, {"style": style}, seed=0)
        names = [part.name for part in blueprint.assembly.parts]
        found = {names[item.child]: item.kind for item in infer(blueprint.assembly).joints}
        assert found[child] is JointType.PRISMATIC, family


def test_a_round_plug_with_room_behind_it_is_pressed() -> None:
    body = box((-0.2, 0, 0), (0.2, 0.1, 0.1)) - cylinder(0.0103, (0, -1, 0.05), (0, 0.02, 0.05))
    plug = cylinder(0.01, (0, -0.006, 0.05), (0, 0.016, 0.05))
    joint = sliding("body", "plug", (0, 1, 0), (0, 0, 0.05), (0.0, 0.003))
    estimate = infer_joints(known_object("panel", {"body": body, "plug": plug}, joint))["plug"]
    assert estimate.kind is JointType.PRISMATIC
    assert abs(float(estimate.axis[1])) > 0.999


@pytest.mark.parametrize(("depth", "slides"), [(0.2, True), (0.03, False)])
def test_a_rod_deep_in_a_tube_is_drawn_out_and_a_short_one_turns(depth: float, slides: bool) -> None:
    """The rod of a gas spring and a shaft with its seat: round, loose, alike but for how deep they are held."""
    tube = cylinder(0.026, (0, 0, 0), (0, 0, 0.25)) - cylinder(0.0145, (0, 0, 0.249 - depth), (0, 0, 1))
    rod = cylinder(0.014, (0, 0, 0.25 - depth), (0, 0, 0.27)) + cylinder(0.06, (0, 0, 0.26), (0, 0, 0.28))
    joint = sliding("tube", "rod", (0, 0, 1), (0, 0, 0), (0.0, 0.1))
    estimate = infer_joints(known_object("spring", {"tube": tube, "rod": rod}, joint))["rod"]
    assert (estimate.kind is JointType.PRISMATIC) is slides
    assert abs(float(estimate.axis[2])) > 0.999


@pytest.mark.parametrize(("depth", "slides"), [(0.08, True), (0.004, False)])
def test_a_plate_deep_in_a_shaft_travels_and_a_flush_one_is_a_lid(depth: float, slides: bool) -> None:
    shaft = box((-0.08, -0.15, 0), (0.08, 0.15, 0.2)) - box((-0.05, -0.12, 0.02), (0.05, 0.12, 1.0))
    top = 0.2 - depth
    plate = box((-0.0497, -0.1197, top - 0.006), (0.0497, 0.1197, top))
    joint = sliding("body", "plate", (0, 0, 1), (0, 0, top), (-0.1, 0.0))
    estimate = infer_joints(known_object("shaft", {"body": shaft, "plate": plate}, joint))["plate"]
    assert (estimate.kind is JointType.PRISMATIC) is slides
    if slides:
        assert abs(float(estimate.axis[2])) > 0.999


def test_a_round_flap_in_pins_across_its_mouth_swings() -> None:
    bin_ = cylinder(0.15, (0, 0, 0), (0, 0, 0.4)) - cylinder(0.146, (0, 0, 0.004), (0, 0, 1.0))
    bin_ -= cylinder(0.0045, (-1, 0, 0.36), (1, 0, 0.36))
    flap = cylinder(0.14, (0, 0, 0.357), (0, 0, 0.363))
    for side in (-1, 1):
        flap += cylinder(0.004, (0.139 * side, 0, 0.36), (0.146 * side, 0, 0.36))
        flap += cylinder(0.004, (0.146 * side, 0, 0.36), (0.15 * side, 0, 0.36), segments=24)
    joint = turning("bin", "flap", (1, 0, 0), (0, 0, 0.36), (-1.0, 1.0))
    estimate = infer_joints(known_object("bin", {"bin": bin_, "flap": flap}, joint))["flap"]
    assert estimate.kind.turns
    assert abs(float(estimate.axis[0])) > 0.999
