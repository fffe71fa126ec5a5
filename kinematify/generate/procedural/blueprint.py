"""An object with exact joints: parts in the configuration in which it is shown, and how each of them moves."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.assembly.part import Assembly, Part
from kinematify.assembly.truth import GroundTruth, TrueJoint
from kinematify.robot.arrays import read_only
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import joint_motion, transformed

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Mimic


@dataclass(frozen=True, kw_only=True, eq=False)
class BlueprintJoint:
    """The exact joint between two parts; world frame, zero is the configuration of the parts."""

    parent: str
    child: str
    kind: JointType
    axis: FloatArray
    """Unit direction, shape (3,); positive motion opens, by the right hand rule or along it. Read-only."""
    pivot: FloatArray
    """A point on the axis [m], shape (3,). Read-only."""
    lower: float
    """[rad or m]; -inf for continuous."""
    upper: float
    """[rad or m]; +inf for continuous."""
    value: float = 0.0
    """How far it has moved from the pose in which it was designed [rad or m]; limits are counted from here."""
    mimic: Mimic | None = None
    """Its leader, named by the child part of that joint; offset 0, since all stand at zero."""

    def __post_init__(self) -> None:
        axis = np.asarray(self.axis, dtype=np.float64)
        object.__setattr__(self, "axis", read_only(axis / np.linalg.norm(axis), np.float64))
        object.__setattr__(self, "pivot", read_only(np.asarray(self.pivot), np.float64))

    def motion(self, value: float) -> FloatArray:
        """Return the world transform, shape (4, 4), of what the child carries when the joint moves by `value`."""
        return joint_motion(self.kind, self.axis, self.pivot, value)


@dataclass(frozen=True, kw_only=True, eq=False)
class BlueprintLoop:
    """A pin that two parts share besides the joints of the tree: it closes a chain of joints."""

    one: str
    other: str
    pivot: FloatArray
    """A point on the pin, world frame [m], shape (3,). Read-only."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "pivot", read_only(np.asarray(self.pivot), np.float64))


@dataclass(frozen=True, kw_only=True, eq=False)
class Blueprint:
    """An articulated object; the first part is the base link."""

    name: str
    family: str
    parts: tuple[Part, ...]
    """With colour and density."""
    joints: tuple[BlueprintJoint, ...]
    """One per part but the first, parents before children."""
    loops: tuple[BlueprintLoop, ...] = ()
    """What closes the chains that the tree leaves open; followers among the joints keep them closed."""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    """What it was built with, defaults and drawn values included."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "parameters", MappingProxyType(dict(self.parameters)))

    @cached_property
    def joint_above(self) -> dict[str, BlueprintJoint]:
        """Joint that carries a part, keyed by the part's name."""
        return {joint.child: joint for joint in self.joints}

    @property
    def root(self) -> str:
        """Name of the base link."""
        return self.parts[0].name

    @cached_property
    def assembly(self) -> Assembly:
        """Return what an inference is given: the parts alone."""
        return Assembly(parts=self.parts, source=self.name)

    def moved(self, values: Mapping[str, float]) -> Blueprint:
        """Move the joints; the new configuration is the zero of the result.

        Args:
            values: Child part -> joint value [rad or m]; the others stay, and those that follow another one follow.
        """
        T_new_old = {self.root: np.eye(4)}
        joints = []
        for joint in self.joints:
            above, value = T_new_old[joint.parent], values.get(joint.child, 0.0)
            if joint.mimic is not None:
                value = joint.mimic.multiplier * values.get(joint.mimic.joint, 0.0)
            T_new_old[joint.child] = above @ joint.motion(value)
            joints.append(
                replace(
                    joint,
                    axis=above[:3, :3] @ joint.axis,
                    pivot=above[:3, :3] @ joint.pivot + above[:3, 3],
                    lower=joint.lower - value,
                    upper=joint.upper - value,
                    value=joint.value + value,
                )
            )
        parts = tuple(_placed(part, T_new_old[part.name]) for part in self.parts)
        loops = tuple(
            replace(loop, pivot=(T_new_old[loop.one] @ np.append(loop.pivot, 1.0))[:3]) for loop in self.loops
        )
        return replace(self, parts=parts, joints=tuple(joints), loops=loops)

    def scaled(self, factor: float, *, mirrored: bool = False) -> Blueprint:
        """Return the object larger or smaller about the world's origin, or as a mirror shows it: left is right.

        Turns go round the other way in a mirror.
        """
        flip = np.array([-1.0 if mirrored else 1.0, 1.0, 1.0])

        def joint(given: BlueprintJoint) -> BlueprintJoint:
            way = factor if given.kind is JointType.PRISMATIC else 1.0
            return replace(
                given,
                axis=flip * given.axis * (flip[0] if given.kind.turns else 1.0),
                pivot=factor * flip * given.pivot,
                lower=way * given.lower,
                upper=way * given.upper,
                value=way * given.value,
            )

        def part(given: Part) -> Part:
            moved = replace(given, vertices=factor * flip * given.vertices)
            look = given.appearance and given.appearance.mirrored()
            return replace(moved, faces=given.faces[:, [0, 2, 1]], appearance=look) if mirrored else moved

        loops = tuple(replace(loop, pivot=factor * flip * loop.pivot) for loop in self.loops)
        return replace(self, parts=tuple(map(part, self.parts)), joints=tuple(map(joint, self.joints)), loops=loops)


def _placed(part: Part, transform: FloatArray) -> Part:
    return replace(part, vertices=transformed(part.vertices, transform))


def parents_first(joints: Sequence[BlueprintJoint]) -> tuple[BlueprintJoint, ...]:
    """Return joints in an order in which every parent link is there before its child."""
    by_parent: dict[str, list[BlueprintJoint]] = {}
    for joint in joints:
        by_parent.setdefault(joint.parent, []).append(joint)
    children = {joint.child for joint in joints}
    found = [joint for parent, below in by_parent.items() if parent not in children for joint in below]
    for joint in found:  # grows while it is walked
        found.extend(by_parent.get(joint.child, []))
    return tuple(found)


def ground_truth(blueprint: Blueprint) -> GroundTruth:
    """Return the truth about the parts of a blueprint, in their order and under their names."""
    index = {part.name: k for k, part in enumerate(blueprint.parts)}
    seed = blueprint.parameters.get("seed")
    return GroundTruth(
        name=blueprint.name,
        part_names=tuple(index),
        part_links=tuple((name,) for name in index),
        joints=tuple(
            TrueJoint(
                name=f"{joint.child}_joint",
                source=f"{joint.child}_joint",
                kind=joint.kind,
                parent=index[joint.parent],
                child=index[joint.child],
                axis=joint.axis,
                pivot=joint.pivot,
                lower=joint.lower,
                upper=joint.upper,
                value=joint.value,
                mimic=joint.mimic and replace(joint.mimic, joint=f"{joint.mimic.joint}_joint"),
            )
            for joint in blueprint.joints
        ),
        dropped=(),
        configuration={},
        pose="rest",
        seed=seed if isinstance(seed, int) else 0,
        yaw_deg=0.0,
    )
