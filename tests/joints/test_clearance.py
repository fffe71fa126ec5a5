"""Keys, skirts, beads and grooves decide between sliding and turning; open panels and drawers know where they close."""

from __future__ import annotations

import pytest

from kinematify.generate.procedural.blueprint import Blueprint
from kinematify.generate.registry import build
from kinematify.joints.candidate import JointEstimate
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import infer_joints
from tests.known import KnownJoint, KnownObject


def known(blueprint: Blueprint) -> KnownObject:
    fields = ("parent", "child", "kind", "axis", "pivot", "lower", "upper")
    joints = tuple(KnownJoint(**{name: getattr(joint, name) for name in fields}) for joint in blueprint.joints)
    return KnownObject(name=blueprint.name, root=blueprint.root, parts=blueprint.parts, joints=joints)


def estimates(family: str, **given: float | int | str) -> dict[str, JointEstimate]:
    return infer_joints(known(build(family, given)))


def test_a_round_button_with_a_square_foot_slides() -> None:
    found = estimates("button_panel", shape="round", buttons=2, columns=2, knobs=1)
    assert found["button_1"].kind is JointType.PRISMATIC
    assert found["button_1"].axis[1] > 0.99  # inwards
    assert found["knob_1"].kind.turns


def test_a_cap_behind_a_bead_turns_and_a_stopper_slides() -> None:
    assert estimates("bottle", cap="screw")["cap"].kind.turns
    assert estimates("bottle", cap="pull")["cap"].kind is JointType.PRISMATIC


def test_splines_make_the_button_of_a_pen_slide() -> None:
    assert estimates("pen", mechanism="click")["button"].kind is JointType.PRISMATIC


def test_knobs_in_a_row_turn_although_buttons_in_a_row_are_pressed() -> None:
    found = estimates("button_panel", buttons=3, columns=3, knobs=3, shape="square")
    assert all(found[f"knob_{k}"].kind.turns for k in (1, 2, 3))
    assert all(found[f"button_{k}"].kind is JointType.PRISMATIC for k in (1, 2, 3))


def test_knobs_on_rough_shafts_turn_in_a_row() -> None:
    """Bumps hide the shaft from the search for journals, the bearing has it all the same."""
    found = estimates("oven", style="bumpy", knobs=3)
    assert all(found[f"knob_{k}"].kind.turns for k in (1, 2, 3))


def test_the_hook_of_a_crane_slides_on_its_two_ropes() -> None:
    """Thin ropes stop few samples, and the jib makes a machine of it, in which keys are doubted."""
    assert estimates("crane", kind="tower")["hook"].kind is JointType.PRISMATIC


def test_a_round_cap_that_a_thread_holds_is_not_lifted() -> None:
    cap = estimates("bottle", cap="screw", width=0.06, height=0.2, neck=0.028)["cap"]
    assert cap.kind.turns
    assert cap.evidence["retained"] == 1.0
    assert cap.evidence["round_lid"] == 0.0


@pytest.mark.parametrize("opened", [0.0, 0.4])
def test_an_open_door_closes_to_where_it_belongs(opened: float) -> None:
    blueprint = build("cabinet", {"doors": 1, "drawers": 1, "open": opened})
    found = infer_joints(known(blueprint))
    for joint in blueprint.joints:
        estimate = found[joint.child]
        assert float(estimate.axis @ joint.axis) > 0.99, joint.child
        span = joint.upper - joint.lower
        assert abs(estimate.lower - joint.lower) < 0.15 * span, (joint.child, estimate.lower, joint.lower)
