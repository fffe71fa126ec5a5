"""Defects of the file: units, numbers, meshes, masses, as exporters and hands produce them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchmarks.faults.fault import Fault, PlantedFault, link_part, words
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import rigid_groups
from kinematify.validation.finding import Cause

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml.etree import _Element

    from kinematify.robot.robot import Joint, Link, Robot

    Random = np.random.Generator

ABSENT = "no_such_file.obj"
OFFSET_SHARE = 0.5
"""How far a collision shape is moved, fraction of the link's diagonal."""
OUTSIDE_SHARE = 2.0
"""How far a centre of mass is moved, fraction of the link's diagonal."""


def moving_links(robot: Robot) -> list[Link]:
    """Links with geometry that a joint moves; defects of mass and collision matter there."""
    fixed = set(rigid_groups(robot)[0].links)
    return [link for link in robot.links if link.has_geometry and link.name not in fixed]


# ---- joints ----------------------------------------------------------------------------------------------------------


def _joint(robot: _Element, joint: Joint) -> _Element:
    return next(item for item in robot.findall("joint") if item.get("name") == joint.name)


def _at_joint(joint: Joint, how: str) -> PlantedFault:
    return PlantedFault(how=how, joint=joint.name, links=(joint.child,))


def _zero_axis(robot: _Element, joint: Joint, model: Robot, random: Random) -> PlantedFault:
    element = _joint(robot, joint)
    axis = element.find("axis")
    if axis is None:
        axis = element.makeelement("axis", {})
        element.append(axis)
    axis.set("xyz", "0 0 0")
    return _at_joint(joint, "axis 0 0 0")


def _swapped_limits(robot: _Element, joint: Joint, model: Robot, random: Random) -> PlantedFault | None:
    limit = _joint(robot, joint).find("limit")
    if not np.isfinite(joint.upper) or limit is None:
        return None
    limit.set("lower", repr(joint.upper))
    limit.set("upper", repr(joint.lower))
    return _at_joint(joint, f"limits {joint.upper:.3g} to {joint.lower:.3g}")


def _degrees(robot: _Element, joint: Joint, model: Robot, random: Random) -> PlantedFault | None:
    limit = _joint(robot, joint).find("limit")
    if joint.kind is not JointType.REVOLUTE or limit is None:
        return None
    limit.set("lower", repr(float(np.degrees(joint.lower))))
    limit.set("upper", repr(float(np.degrees(joint.upper))))
    return _at_joint(joint, f"limits {np.degrees(joint.lower):.3g} to {np.degrees(joint.upper):.3g} in degrees")


# ---- links -----------------------------------------------------------------------------------------------------------


def _link(robot: _Element, link: Link) -> _Element:
    return next(item for item in robot.findall("link") if item.get("name") == link.name)


def _at_link(link: Link, model: Robot, how: str) -> PlantedFault:
    above = model.joint_above.get(link.name)
    return PlantedFault(how=how, joint=None if above is None else above.name, links=(link.name,))


def _units_of_link(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    factor = 1000.0 if random.random() < 0.5 else 0.001
    if not _scaled([_link(robot, link)], factor):
        return None
    return _at_link(link, model, f"meshes scaled by {factor:g}")


def _units_of_all(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    factor = 1000.0 if random.random() < 0.5 else 0.001
    if not _scaled(robot.findall("link"), factor):
        return None
    return PlantedFault(how=f"all meshes scaled by {factor:g}", joint=None, links=())


def _scaled(links: Sequence[_Element], factor: float) -> int:
    meshes = [mesh for link in links for mesh in link.iter("mesh")]
    for mesh in meshes:
        before = np.array((mesh.get("scale") or "1 1 1").split(), dtype=np.float64)
        mesh.set("scale", words(before * factor))
    return len(meshes)


def _inertia(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    inertia = _link(robot, link).find("inertial/inertia")
    if inertia is None:
        return None
    first, second = (float(inertia.get(key) or 0.0) for key in ("ixx", "iyy"))
    changes = [
        ("ixx is negative", {"ixx": -abs(first)}),
        ("izz is ten times ixx + iyy", {"izz": 10.0 * (first + second)}),
        ("ixy makes it indefinite", {"ixy": 3.0 * float(np.sqrt(abs(first * second)))}),
        ("all entries are zero", dict.fromkeys(("ixx", "iyy", "izz", "ixy", "ixz", "iyz"), 0.0)),
    ]
    how, values = changes[random.integers(len(changes))]
    for key, value in values.items():
        inertia.set(key, repr(value))
    return _at_link(link, model, f"inertia: {how}")


def _mass(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    mass = _link(robot, link).find("inertial/mass")
    if mass is None:
        return None
    before = float(mass.get("value") or 0.0)
    value = [0.0, -before, 1e6 * before][random.integers(3)]
    mass.set("value", repr(value))
    return _at_link(link, model, f"mass {value:.3g} kg instead of {before:.3g} kg")


def _missing_mesh(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    meshes = list(_link(robot, link).iter("mesh"))
    if not meshes:
        return None
    meshes[random.integers(len(meshes))].set("filename", f"meshes/{ABSENT}")
    return _at_link(link, model, "a mesh file is missing")


def _missing_collision(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    element = _link(robot, link)
    shapes = element.findall("collision")
    for shape in shapes:
        element.remove(shape)
    return _at_link(link, model, "no collision geometry") if shapes else None


def _offset_collision(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    way = random.normal(size=3)
    shift = OFFSET_SHARE * link_part(link).diagonal * way / np.linalg.norm(way)
    shapes = _link(robot, link).findall("collision")
    for shape in shapes:
        _move_origin(shape, shift)
    return _at_link(link, model, f"collision geometry moved by {np.linalg.norm(shift):.3g} m") if shapes else None


def _move_origin(element: _Element, shift: np.ndarray) -> None:
    origin = element.find("origin")
    if origin is None:
        origin = element.makeelement("origin", {})
        element.insert(0, origin)
    before = np.array((origin.get("xyz") or "0 0 0").split(), dtype=np.float64)
    origin.set("xyz", words(before + shift))


def _mass_outside(robot: _Element, link: Link, model: Robot, random: Random) -> PlantedFault | None:
    inertial = _link(robot, link).find("inertial")
    if inertial is None:
        return None
    way = random.normal(size=3)
    shift = OUTSIDE_SHARE * link_part(link).diagonal * way / np.linalg.norm(way)
    _move_origin(inertial, shift)
    return _at_link(link, model, f"centre of mass moved by {np.linalg.norm(shift):.3g} m")


_KINEMATICS, _PHYSICS, _ASSET = (frozenset({cause}) for cause in (Cause.KINEMATICS, Cause.PHYSICS, Cause.ASSET))

FILE_DEFECTS = (
    Fault(name="units of one link", kinematic=False, causes=_ASSET, plant_link=_units_of_link),
    Fault(name="units of all links", kinematic=False, causes=_ASSET, plant_link=_units_of_all),
    Fault(name="zero axis", kinematic=False, causes=_KINEMATICS, plant_joint=_zero_axis),
    Fault(name="swapped limits", kinematic=False, causes=_KINEMATICS, plant_joint=_swapped_limits),
    Fault(name="degrees for radians", kinematic=False, causes=_KINEMATICS, plant_joint=_degrees),
    Fault(name="bad inertia", kinematic=False, causes=_PHYSICS, plant_link=_inertia),
    Fault(name="bad mass", kinematic=False, causes=_PHYSICS, plant_link=_mass),
    Fault(name="missing mesh file", kinematic=False, causes=_ASSET, plant_link=_missing_mesh),
    Fault(name="missing collision geometry", kinematic=False, causes=_PHYSICS, plant_link=_missing_collision),
    Fault(name="offset collision geometry", kinematic=False, causes=_PHYSICS, plant_link=_offset_collision),
    Fault(name="centre of mass outside", kinematic=False, causes=_PHYSICS, plant_link=_mass_outside),
)
