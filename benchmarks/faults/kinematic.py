"""Faults of one joint that leave the model at rest as it was: only its motion is wrong.

A moved pivot takes the child's link frame with it, so what stands in that frame moves back; a new parent gets the
child where it stood.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.faults.fault import Fault, PlantedFault, link_part, words
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration, rigid_groups
from kinematify.robot.transforms import rotation_about, rpy_of
from kinematify.validation.finding import Cause

if TYPE_CHECKING:
    from lxml.etree import _Element

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, Robot

PIVOT_SHARE = 0.2
"""How far a pivot is moved, fraction of the part's diagonal."""
ONE_SIDED = 0.5
"""A range is one-sided if its shorter side is below this fraction of its longer one; only these can be flipped."""


@dataclass(frozen=True, eq=False)
class _Model:
    """What the faults need to know of the untouched model."""

    robot: Robot

    @cached_property
    def body_of(self) -> dict[str, int]:
        """Rigid group of every link."""
        groups = rigid_groups(self.robot)
        return {link: index for index, group in enumerate(groups) for link in group.links}

    @cached_property
    def bodies(self) -> list[str]:
        """Names of links with geometry, one for each rigid group that has any."""
        groups = [group for group in rigid_groups(self.robot) if group.has_geometry]
        links = self.robot.link_by_name
        return [next(name for name in group.links if links[name].has_geometry) for group in groups]

    @cached_property
    def poses(self) -> dict[str, FloatArray]:
        """Pose of every link at rest."""
        return forward_kinematics(self.robot, rest_configuration(self.robot))

    def carried(self, joint: Joint) -> set[str]:
        """Links that a joint moves."""
        found = [joint.child]
        for link in found:
            found.extend(below.child for below in self.robot.joints_below[link])
        return set(found)

    def size(self, joint: Joint) -> float:
        """Diagonal of the part that a joint moves [m]; 0 if it has no geometry."""
        link = self.robot.link_by_name[joint.child]
        return link_part(link).diagonal if link.has_geometry else 0.0


def movable_joints(robot: Robot) -> list[Joint]:
    """Joints that a fault can be planted in: they move geometry against geometry, and no other joint follows them."""
    model = _Model(robot)
    leaders = {joint.mimic.joint for joint in robot.joints if joint.mimic is not None}
    with_geometry = {model.body_of[name] for name in model.bodies}
    return [
        joint
        for joint in robot.joints
        if joint.kind is not JointType.FIXED
        and joint.mimic is None
        and joint.name not in leaders
        and model.size(joint) > 0.0
        and model.body_of[joint.parent] in with_geometry
    ]


def _element(robot: _Element, joint: Joint) -> _Element:
    return next(item for item in robot.findall("joint") if item.get("name") == joint.name)


def _child(element: _Element, tag: str) -> _Element:
    found = element.find(tag)
    if found is None:
        found = element.makeelement(tag, {})
        element.append(found)
    return found


def _planted(joint: Joint, how: str) -> PlantedFault:
    return PlantedFault(how=how, joint=joint.name, links=(joint.child,))


def _across(axis: FloatArray, random: np.random.Generator) -> FloatArray:
    """A random unit vector across an axis."""
    vector = random.normal(size=3)
    vector -= (vector @ axis) * axis
    return np.asarray(vector / np.linalg.norm(vector))


def _turn_axis_20(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault:
    axis = rotation_about(_across(joint.axis, random), np.radians(20.0)) @ joint.axis
    _child(_element(robot, joint), "axis").set("xyz", words(axis))
    return _planted(joint, "axis turned by 20 deg")


def _turn_axis_90(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault:
    """About another axis of the joint's own frame, as when x and z are confused; at random for a slanted axis."""
    across = [row for row in np.eye(3) if abs(row @ joint.axis) < 1e-6]
    about = across[random.integers(len(across))] if len(across) > 1 else _across(joint.axis, random)
    _child(_element(robot, joint), "axis").set("xyz", words(rotation_about(about, np.radians(90.0)) @ joint.axis))
    return _planted(joint, "axis turned by 90 deg")


def _move_pivot(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault | None:
    if not joint.kind.turns:
        return None  # the place of a slide's axis means nothing
    shift = PIVOT_SHARE * _Model(model).size(joint) * _across(joint.axis, random)
    origin = _child(_element(robot, joint), "origin")
    origin.set("xyz", words(joint.T_parent_child[:3, 3] + joint.T_parent_child[:3, :3] @ shift))
    _shift_frame(robot, joint.child, -shift)
    return _planted(joint, f"pivot moved by {np.linalg.norm(shift):.3g} m across the axis")


def _shift_frame(robot: _Element, link: str, shift: FloatArray) -> None:
    """Move everything that stands in a link's frame."""
    element = next(item for item in robot.findall("link") if item.get("name") == link)
    below = [item for item in robot.findall("joint") if _child(item, "parent").get("link") == link]
    for item in (*element.findall("visual"), *element.findall("collision"), *element.findall("inertial"), *below):
        origin = _child(item, "origin")
        before = np.array((origin.get("xyz") or "0 0 0").split(), dtype=np.float64)
        origin.set("xyz", words(before + shift))


def _swap_type(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault:
    """The range becomes one of about the same motion at the middle of the part."""
    lever = 0.5 * _Model(model).size(joint)
    element = _element(robot, joint)
    if joint.kind.turns:
        limits = np.clip(np.array([joint.lower, joint.upper]), -1.0, 1.0) * lever
        element.set("type", "prismatic")
    else:
        limits = np.clip(np.array([joint.lower, joint.upper]) / lever, -np.pi, np.pi)
        element.set("type", "revolute")
    _set_limits(element, *limits)
    return _planted(joint, f"{joint.kind.value} written as {element.get('type')}")


def _set_limits(element: _Element, lower: float, upper: float) -> None:
    limit = _child(element, "limit")
    limit.set("lower", repr(float(lower)))
    limit.set("upper", repr(float(upper)))
    for name in ("effort", "velocity"):
        limit.set(name, limit.get(name) or "10")


def _double_range(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault | None:
    """A range that begins at zero keeps its beginning; others grow about their middle."""
    if not np.isfinite(joint.upper):
        return None
    lower, upper = joint.lower, joint.upper
    width = upper - lower
    if min(abs(lower), abs(upper)) < 0.1 * width:
        _set_limits(_element(robot, joint), 2 * lower, 2 * upper)
    else:
        _set_limits(_element(robot, joint), lower - 0.5 * width, upper + 0.5 * width)
    return _planted(joint, f"range of {width:.3g} doubled")


def _flip(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault | None:
    """Only where the range is one-sided: turning the axis of a symmetric one round changes nothing."""
    short, long = sorted((abs(joint.lower), abs(joint.upper)))
    if not np.isfinite(long) or short >= ONE_SIDED * long or joint.lower > 0.0 or joint.upper < 0.0:
        return None
    _child(_element(robot, joint), "axis").set("xyz", words(-joint.axis))
    return _planted(joint, "direction flipped")


def _change_parent(robot: _Element, joint: Joint, model: Robot, random: np.random.Generator) -> PlantedFault | None:
    known = _Model(model)
    carried = known.carried(joint)
    own = known.body_of[joint.parent]
    others = [name for name in known.bodies if name not in carried and known.body_of[name] != own]
    if not others:
        return None
    parent = others[random.integers(len(others))]
    T_parent_child = np.linalg.inv(known.poses[parent]) @ known.poses[joint.parent] @ joint.T_parent_child
    element = _element(robot, joint)
    _child(element, "parent").set("link", parent)
    origin = _child(element, "origin")
    origin.set("xyz", words(T_parent_child[:3, 3]))
    origin.set("rpy", words(rpy_of(T_parent_child[:3, :3])))
    return _planted(joint, f"parent {joint.parent} replaced by {parent}")


_ONLY = frozenset({Cause.KINEMATICS})

KINEMATIC_FAULTS = (
    Fault(name="axis turned by 20 deg", kinematic=True, causes=_ONLY, plant_joint=_turn_axis_20),
    Fault(name="axis turned by 90 deg", kinematic=True, causes=_ONLY, plant_joint=_turn_axis_90),
    Fault(name="pivot moved by 20 % of the part", kinematic=True, causes=_ONLY, plant_joint=_move_pivot),
    Fault(name="type swapped", kinematic=True, causes=_ONLY, plant_joint=_swap_type),
    Fault(name="range doubled", kinematic=True, causes=_ONLY, plant_joint=_double_range),
    Fault(name="direction flipped", kinematic=True, causes=_ONLY, plant_joint=_flip),
    Fault(name="wrong parent", kinematic=True, causes=_ONLY, plant_joint=_change_parent),
)
