"""A cup and a container as one object: the cup hangs on three joints that lift it, carry it over and tilt it.

The planner of pulls then does the rest: what the hand holds moves along these joints, upright until it tilts about its
lip, and the lip stays above the middle of the container.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.errors import InputError
from kinematify.geometry.scene import read_scene, visible_shapes
from kinematify.manipulation.copies import write_scaled
from kinematify.manipulation.place import ObjectMotion, object_box
from kinematify.manipulation.sizes import sizing
from kinematify.model.urdf_elements import numbers, roll_pitch_yaw
from kinematify.robot.description import parse_description
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_model
from kinematify.robot.robot import forward_kinematics, joint_values, rest_configuration
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.config.task import PourSettings
    from kinematify.config.validation import ValidationSettings
    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.declared import DeclaredModel

LIFT, CARRY, TILT = "pour_lift", "pour_carry", "pour_tilt"
_ROOT, _PIVOT, _CUP, _INTO = "pour_table", "pour_pivot", "cup_", "into_"
_LIP = 0.1  # of the cup's height: its uppermost part, where it is widest towards the container
_EXTRA = 0.1  # of range beyond what is needed [m or rad]


@dataclass(frozen=True, kw_only=True, eq=False)
class Vessel:
    """A cup or a container at its real size."""

    urdf: Path
    box: FloatArray
    """Lowest and highest corner at rest, frame of the root link [m], shape (2, 3)."""
    points: FloatArray
    """Corners of all shapes at rest, frame of the root link [m], shape (n, 3)."""

    @property
    def middle(self) -> FloatArray:
        """Middle of the underside, frame of the root link [m], shape (3,)."""
        return np.append(self.box.mean(axis=0)[:2], self.box[0, 2])


@dataclass(frozen=True, kw_only=True, eq=False)
class Pour:
    """The object that was made, and how far each joint moves."""

    urdf: Path
    lift: float
    """[m]."""
    carry: float
    """[m]."""
    tilt: float
    """[rad]."""


def read_vessel(urdf: Path, path: Path, settings: ValidationSettings, scale: float | None = None) -> Vessel:
    """Write a cup or container at its real size to `path` and measure it.

    Raises:
        InputError: It cannot be read, has no geometry, or its size makes no sense.
        OSError: The file cannot be written.
    """
    model = read_model(urdf)
    scene = read_scene(model, settings.geometry, visible_shapes)
    if not scene.bodies:
        raise InputError(f"{urdf} has no geometry, so nothing can be poured from it or into it. Give another model.")
    write_scaled(urdf, sizing(urdf, model.name, object_box(scene), scale=scale).factor, path)
    scene = read_scene(read_model(path), settings.geometry, visible_shapes)
    points = [corners @ T[:3, :3].T + T[:3, 3] for body, T in zip(scene.bodies, scene.at_rest, strict=True)
              for corners in body.shapes]  # fmt: skip
    return Vessel(urdf=path, box=object_box(scene), points=np.concatenate(points))


def write_pour(cup: Vessel, into: Vessel, yaw: float, path: Path, settings: PourSettings) -> Pour:
    """Write both as one object; the container stands in direction x from the cup.

    Args:
        cup: What is poured from.
        into: What is poured into.
        yaw: Turn of the cup about the upright [rad].
        path: File to write.
        settings: Distances and the tilt.

    Raises:
        OSError: The file cannot be written.
    """
    turn = rotation_about(np.array([0.0, 0.0, 1.0]), yaw)
    standing = (cup.points - cup.middle) @ turn.T
    height = float(standing[:, 2].max())
    upper = standing[standing[:, 2] > (1.0 - _LIP) * height]
    lip = np.array([float(upper[:, 0].max()), 0.0, height])
    half = 0.5 * float(np.ptp(into.box[:, 0]))
    apart = float(standing[:, 0].max()) + half + settings.apart
    rim = float(into.box[1, 2] - into.box[0, 2])
    pour = Pour(
        urdf=path,
        lift=max(settings.least_lift, rim + settings.above - height),
        carry=apart - float(lip[0]),
        tilt=float(np.radians(settings.tilt_deg)),
    )
    document = etree.Element("robot", name="pour")
    etree.SubElement(document, "link", name=_ROOT)
    tops = [_add_vessel(document, vessel, prefix) for vessel, prefix in ((cup, _CUP), (into, _INTO))]
    stand = np.eye(4)
    stand[:3, 3] = np.array([apart, 0.0, 0.0]) - into.middle
    _add_joint(document, f"{_INTO}stands", (_ROOT, tops[1]), stand)
    links = [_ROOT, "pour_lifted", "pour_carried", _PIVOT]
    at_lip = np.eye(4)
    at_lip[:3, 3] = lip
    for link in links[1:]:
        etree.SubElement(document, "link", name=link)
    _add_joint(document, LIFT, (links[0], links[1]), np.eye(4), "prismatic", axis=2, reach=pour.lift)
    _add_joint(document, CARRY, (links[1], links[2]), np.eye(4), "prismatic", axis=0, reach=pour.carry)
    _add_joint(document, TILT, (links[2], links[3]), at_lip, "revolute", axis=1, reach=pour.tilt)
    hang = np.eye(4)
    hang[:3, :3] = turn
    hang[:3, 3] = -turn @ cup.middle - lip
    _add_joint(document, f"{_CUP}hangs", (_PIVOT, tops[0]), hang)
    etree.ElementTree(document).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")
    return pour


def pour_motion(scene: Scene, pour: Pour, settings: PourSettings) -> ObjectMotion:
    """Lift, carry and tilt one after the other, in equal steps; the shares of the way stand for values."""
    counts = [
        max(2, round(pour.lift / settings.step)),
        max(2, round(pour.carry / settings.step)),
        max(2, round(pour.tilt / np.radians(settings.step_deg))),
    ]
    names = [travel.joint for travel in scene.travels]
    rows = [np.zeros(len(names))]
    for name, end, count in zip((LIFT, CARRY, TILT), (pour.lift, pour.carry, pour.tilt), counts, strict=True):
        for value in np.linspace(0.0, end, count + 1)[1:]:
            row = rows[-1].copy()
            row[names.index(name)] = value
            rows.append(row)
    table = np.array(rows)
    links = [forward_kinematics(scene.model.kinematics, dict(zip(names, row.tolist(), strict=True))) for row in table]
    return ObjectMotion(
        joint=TILT,
        T_world_object=np.eye(4),
        values=np.linspace(0.0, 1.0, len(table)),
        rows=table,
        link_poses=np.stack([poses[_PIVOT] for poses in links]),
        body_poses=scene.poses(table),
    )


def _add_vessel(document: _Element, vessel: Vessel, prefix: str) -> str:
    """Add the links of a vessel with its joints fixed at rest; returns the name of its root."""
    source, model = parse_description(vessel.urdf), read_model(vessel.urdf)
    values = joint_values(model.kinematics, rest_configuration(model.kinematics))
    for material in source.iter("material"):
        if material.get("name"):
            material.set("name", prefix + str(material.get("name")))
    for element in [*source.findall("material"), *source.findall("link")]:
        if element.tag == "link":
            element.set("name", prefix + str(element.get("name")))
        document.append(element)
    for joint in model.kinematics.joints:
        motion = joint.motion(values[joint.name]) if joint.kind is not JointType.FIXED else np.eye(4)
        _add_joint(document, prefix + joint.name, (prefix + joint.parent, prefix + joint.child),
                   joint.T_parent_child @ motion)  # fmt: skip
    return prefix + _root(model)


def _root(model: DeclaredModel) -> str:
    return model.kinematics.root


def _add_joint(
    document: _Element, name: str, links: tuple[str, str], T: FloatArray, kind: str = "fixed", *, axis: int = 0,
    reach: float = 0.0,
) -> None:  # fmt: skip
    joint = etree.SubElement(document, "joint", name=name, type=kind)
    etree.SubElement(joint, "parent", link=links[0])
    etree.SubElement(joint, "child", link=links[1])
    etree.SubElement(joint, "origin", xyz=numbers(T[:3, 3]), rpy=numbers(roll_pitch_yaw(T[:3, :3])))
    if kind != "fixed":
        etree.SubElement(joint, "axis", xyz=numbers(np.eye(3)[axis]))
        ends = {"lower": numbers([-_EXTRA]), "upper": numbers([reach + _EXTRA])}
        etree.SubElement(joint, "limit", {**ends, "effort": "100", "velocity": "10"})
