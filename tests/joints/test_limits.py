"""Opening direction and limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from kinematify import infer
from kinematify.generate.families import FAMILIES
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.pieces.bearing_pieces import barrel
from kinematify.generate.procedural.solids import box, cylinder
from kinematify.joints.choice import limits
from kinematify.joints.choice.limits import find_range
from kinematify.robot.joint_type import JointType
from tests.joints.joint_scenes import CONFIG, estimates_of, infer_joints, scene_of
from tests.known import KnownObject, known_object, sliding, turning
from tests.objects import BUILDERS

if TYPE_CHECKING:
    from manifold3d import Manifold


@pytest.mark.parametrize("name", ["edge_door", "drawer", "piano_box"])
def test_positive_motion_opens(name: str) -> None:
    known = BUILDERS[name]()
    estimates = estimates_of(name)
    for joint in known.joints:
        estimate = estimates[joint.child]
        assert float(estimate.axis @ joint.axis) > 0.9, joint.child
        assert estimate.upper > 0.0
        assert estimate.lower <= 0.0


@pytest.mark.parametrize("name", ["edge_door", "drawer", "knob", "wheel"])
def test_reversing_the_given_axis_gives_the_same_joint(name: str) -> None:
    known = BUILDERS[name]()
    joint = known.joints[0]
    scene = scene_of(known, joint.child)
    there = find_range(scene, joint.kind, joint.axis, joint.pivot, CONFIG.joints)
    back = find_range(scene, joint.kind, -joint.axis, joint.pivot, CONFIG.joints)
    assert there.sign == -back.sign
    assert there.facts == back.facts


def test_limits_bound_the_designed_range_from_above() -> None:
    known = BUILDERS["drawer"]()
    estimate = estimates_of("drawer")["drawer"]
    assert estimate.upper >= 0.9 * known.joints[0].upper
    length = np.ptp(known.parts[1].vertices[:, 1])
    assert estimate.upper <= length


def test_a_door_opens_to_a_right_angle_at_most() -> None:
    known = BUILDERS["edge_door"]()
    estimate = estimates_of("edge_door")[known.joints[0].child]
    assert estimate.upper == pytest.approx(np.radians(CONFIG.joints.limits.panel_deg), abs=0.2)


def test_a_knob_turns_without_end() -> None:
    estimate = estimates_of("knob")["knob"]
    assert estimate.kind is JointType.CONTINUOUS
    assert (estimate.lower, estimate.upper) == (-np.inf, np.inf)


def test_wheels_turn_without_end_though_they_hang_on_castors() -> None:
    """Castors, wheels, gas spring, seat and back are a chain as that of an arm, but wheels stand on the floor."""
    blueprint = build(FAMILIES["office_chair"], {"castors": 4}, seed=0)
    names = [part.name for part in blueprint.assembly.parts]
    found = {names[joint.child]: joint for joint in infer(blueprint.assembly).joints}
    wheels = [joint for name, joint in found.items() if name.startswith("wheel_")]
    assert len(wheels) == 4
    assert all(joint.kind is JointType.CONTINUOUS for joint in wheels)
    assert found["back"].kind is JointType.REVOLUTE


def test_arms_have_limits_to_both_sides() -> None:
    for estimate in estimates_of("serial_arm").values():
        assert -np.pi <= estimate.lower < 0.0 < estimate.upper <= np.pi


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_leaf_opens_to_the_side_of_its_barrels(side: float) -> None:
    """Two leaves in a plane that both turn freely; only the barrels between them tell which way they fold."""
    level = side * 0.03
    anchors = ((-0.03, -0.006, 0.0, 0.02), (0.006, 0.03, 0.0, 0.02))
    halves = barrel(0.1, 0.008, 4e-4, anchors)
    solids = {}
    for name, half, (left, right) in zip(("fixed", "leaf"), halves, ((-0.4, -0.01), (0.01, 0.4)), strict=True):
        knuckles = half if side < 0 else half.mirror((0, 1, 0))
        solids[name] = box((left, -0.015, -0.5), (right, 0.015, 0.5))
        solids[name] += knuckles.translate((0, level, -0.3)) + knuckles.translate((0, level, 0.3))
    joint = turning("fixed", "leaf", (0, 0, side), (0, level, 0), limits=(0.0, 2.5))
    found = infer_joints(known_object("fold", solids, joint))["leaf"]
    assert float(found.axis @ joint.axis) > 0.99


def test_a_level_disc_on_top_that_is_larger_than_a_button_is_lifted() -> None:
    """It is small beside its pot, as buttons are, but covers a mouth."""
    pot = cylinder(0.12, (0, 0, 0), (0, 0, 0.2)) - cylinder(0.02, (0, 0, 0.1), (0, 0, 0.3))
    pot -= cylinder(0.0253, (0, 0, 0.19), (0, 0, 0.3))
    joint = sliding("pot", "disc", (0, 0, 1), (0, 0, 0.2), (0.0, 0.05))
    known = known_object("pot", {"pot": pot, "disc": cylinder(0.025, (0, 0, 0.1902), (0, 0, 0.206))}, joint)
    scene = scene_of(known, "disc")
    assert 0.5 < scene.smallness < 1.0
    found = find_range(scene, JointType.PRISMATIC, np.array([0.0, 0.0, 1.0]), joint.pivot, CONFIG.joints)
    assert found.sign > 0.0
    assert found.ahead.motion >= 0.006


def test_a_button_on_the_foot_of_a_lamp_is_pressed_down() -> None:
    """The middle of the lamp lies above the button, and what hangs on the post makes a machine of joints in series."""
    foot = box((-0.1, -0.1, 0), (0.1, 0.1, 0.03)) - box((-0.0105, -0.0905, 0.018), (0.0105, -0.0695, 0.1))
    solids = {"lamp": foot + cylinder(0.01, (0, 0, 0.02), (0, 0, 0.6))}
    solids["button"] = box((-0.01, -0.09, 0.022), (0.01, -0.07, 0.033))
    joints = [sliding("lamp", "button", (0, 0, -1), (0, -0.08, 0.03), (0.0, 0.003))]
    for k in range(3):
        solids[f"link_{k}"] = box((-0.02, 0.011 + 0.05 * k, 0.5), (0.02, 0.06 + 0.05 * k, 0.52))
        joints.append(
            turning(f"link_{k - 1}" if k else "lamp", f"link_{k}", (0, 0, 1), (0, 0.011 + 0.05 * k, 0.5), (-1, 1))
        )
    scene = scene_of(known_object("lamp", solids, *joints), "button")
    assert scene.serial
    found = find_range(scene, JointType.PRISMATIC, np.array([0.0, 0.0, 1.0]), joints[0].pivot, CONFIG.joints)
    assert found.sign < 0.0
    assert found.ahead.motion < 0.011


def test_what_stands_at_its_stop_opens_to_a_right_angle_at_most() -> None:
    """Two crossed levers on a rivet whose jaws meet; the other way round nothing stops them."""

    def lever(side: float) -> Manifold:
        jaw = box((0.004, -0.15, 0), (0.024, -0.02, 0.012)) + box((-0.012, -0.03, 0), (0.024, 0.03, 0.012))
        grip = box((0.002, 0.02, 0), (0.022, 0.16, 0.012))
        return (jaw + grip).mirror((1, 0, 0)) if side < 0 else jaw + grip

    rivet = cylinder(0.006, (0, 0, -0.001), (0, 0, 0.0262))
    solids = {"lever": lever(1.0) + rivet}
    solids["other"] = lever(-1.0).translate((0, 0, 0.0124)) - cylinder(0.0063, (0, 0, -1), (0, 0, 1))
    solids["lever"] += box((0.0, -0.15, 0), (0.004, -0.13, 0.02))
    joint = turning("lever", "other", (0, 0, 1), (0, 0, 0.012), (0.0, 1.0))
    scene = scene_of(known_object("pliers", solids, joint), "other")
    found = find_range(scene, JointType.REVOLUTE, np.array([0.0, 0.0, 1.0]), joint.pivot, CONFIG.joints)
    assert found.free[0].motion > np.radians(100.0)
    assert found.free[1].motion < np.radians(CONFIG.joints.limits.stopped_deg)
    assert found.ahead.motion == pytest.approx(np.radians(CONFIG.joints.limits.panel_deg))


@pytest.mark.parametrize("share", [0.0, 0.6])
def test_what_stands_ajar_opens_to_a_right_angle_from_its_stop(share: float) -> None:
    """Arms of glasses stop at the frame one way, and meet nothing the other way round."""
    made = build(FAMILIES["eyeglasses"], {"open": share}, seed=7)
    joints = [turning(joint.parent, joint.child, joint.axis, joint.pivot, (0.0, 1.0)) for joint in made.joints]
    parts = made.assembly.parts
    glasses = KnownObject(name="glasses", parts=parts, joints=tuple(joints), root=parts[0].name)
    for estimate in infer_joints(glasses).values():
        assert estimate.upper - estimate.lower == pytest.approx(np.pi / 2, abs=0.15)
        assert estimate.lower == pytest.approx(-share * np.pi / 2, abs=0.15)


def test_both_ends_say_what_stops_them() -> None:
    """A flap that its body stops, a door and a knob."""
    body = box((0, 0, 0), (0.2, 0.3, 0.02)) + box((0, 0, 0.02), (0.2, 0.02, 0.2))
    flap = box((0.02, 0.14, 0.021), (0.18, 0.15, 0.12))
    joint = turning("body", "flap", (1, 0, 0), (0.1, 0.145, 0.0205), (0.0, 1.0))
    scene = scene_of(known_object("stand", {"body": body, "flap": flap}, joint), "flap")
    found = find_range(scene, JointType.REVOLUTE, np.array([1.0, 0.0, 0.0]), joint.pivot, CONFIG.joints)
    assert all(stop for stop in found.facts["stops"])
    assert [way.stop for way in found.free] == ["contact with body"] * 2
    door = estimates_of("edge_door")["door"]
    assert door.stops == ("the given pose", "typical range")
    assert estimates_of("knob")["knob"].stops == ("", "")


def test_what_meets_nothing_is_not_limited_by_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """A bar on a post with room all round, if it is no wheel: its range is what is usual, not half turns."""
    monkeypatch.setattr(limits, "is_continuous", lambda *_: False)
    post = cylinder(0.01, (0, 0, 0), (0, 0, 0.1))
    handle = box((-0.1, -0.008, 0.1), (0.1, 0.008, 0.115)) - cylinder(0.0102, (0, 0, 0.09), (0, 0, 0.11))
    post += cylinder(0.01, (0, 0, 0.1), (0, 0, 0.11))
    joint = turning("post", "handle", (0, 0, 1), (0, 0, 0.1), (-1.0, 1.0))
    scene = scene_of(known_object("tap", {"post": post, "handle": handle}, joint), "handle")
    found = find_range(scene, JointType.REVOLUTE, np.array([0.0, 0.0, 1.0]), joint.pivot, CONFIG.joints)
    assert {way.stop for way in found.free} == {"none found"}
    assert found.ahead == found.back
    assert found.ahead.motion == pytest.approx(np.radians(CONFIG.joints.limits.unmet_deg))
