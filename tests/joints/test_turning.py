"""What goes round and round, and what turns between stops, as the fitted trees say it."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.fit.trees import turning_recipe_key
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.joints.choice.limits import find_range
from kinematify.joints.choice.scorer import TURNING_WEIGHTS, shipped_scorer
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import infer_joints, scene_of
from tests.known import known_object, turning

Y, Z = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])


def wheel(gap: float):
    """A wheel with its axle in a block; its tyre stands in the mudguard by as much as the gap is negative [m]."""
    block = box((-0.3, -0.1, 0.0), (0.3, 0.1, 0.2)) - cylinder(0.0101, (0, 0.0, 0.05), (0, 0.2, 0.05))
    guard = box((-0.12, 0.1, 0.05 + 0.1 + gap), (0.12, 0.16, 0.2))
    tyre = cylinder(0.1, (0, 0.11, 0.05), (0, 0.15, 0.05)) + cylinder(0.01, (0, 0.01, 0.05), (0, 0.12, 0.05))
    joint = turning("body", "wheel", Y, (0.0, 0.13, 0.05), (-np.inf, np.inf))
    return scene_of(known_object("cart", {"body": block + guard, "wheel": tyre}, joint), "wheel")


@pytest.mark.parametrize("gap", [0.01, -0.002])
def test_a_wheel_goes_round_even_where_its_tyre_stands_in_the_mudguard(gap: float) -> None:
    found = find_range(wheel(gap), JointType.REVOLUTE, Y, np.array([0.0, 0.13, 0.05]))
    assert found.kind is JointType.CONTINUOUS


def test_a_door_does_not() -> None:
    shell = box((0, 0, 0), (0.6, 0.5, 0.8)) - box((0.02, -1, 0.02), (0.58, 0.48, 0.78))
    joint = turning("shell", "door", -Z, (0.0, -0.01, 0.4), (0.0, 1.6))
    known = known_object("cabinet", {"shell": shell, "door": box((0, -0.021, 0), (0.6, -0.001, 0.8))}, joint)
    found = find_range(scene_of(known, "door"), JointType.REVOLUTE, -Z, np.array([0.0, -0.01, 0.4]))
    assert found.kind is JointType.REVOLUTE


def test_the_weights_are_of_the_recipe() -> None:
    shipped = shipped_scorer(TURNING_WEIGHTS)
    assert shipped.provenance["recipe"] == turning_recipe_key(shipped.measurements)


def test_handles_in_a_row_agree_on_going_round() -> None:
    """The middle one of three alike crank knobs looks more like a knob than those near the ends of their panel."""
    panel, solids, joints = box((-0.3, 0.0, 0.0), (0.3, 0.1, 0.14)), {}, []
    for k, x in enumerate((-0.2, 0.0, 0.2)):
        panel -= cylinder(0.0052, (x, -0.01, 0.07), (x, 0.015, 0.07))
        stem = cylinder(0.005, (x, -0.005, 0.07), (x, 0.014, 0.07))
        turned = cylinder(0.01, (x, -0.023, 0.07), (x, -0.001, 0.07)) + stem
        solids[f"knob_{k}"] = turned + box((x - 0.002, -0.027, 0.03), (x + 0.002, -0.022, 0.07))
        joints.append(turning("panel", f"knob_{k}", Y, (x, 0.0, 0.07), (-3.0, 3.0)))
    known = known_object("row", {"panel": panel, **solids}, *joints)
    alone = [find_range(scene_of(known, joint.child), JointType.REVOLUTE, Y, np.array(joint.pivot)) for joint in joints]
    assert len({one.kind for one in alone}) == 2
    found = infer_joints(known)
    assert all(abs(joint.axis @ Y) > 0.99 for joint in found.values())
    assert len({joint.kind for joint in found.values()}) == 1
