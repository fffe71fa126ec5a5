"""Objects whose joints are known.

Lengths are metres, angles radians, coordinates the world frame with z up; every joint stands at zero in the
configuration that the parts are given in. The solids are those of `kinematify.generate.procedural`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold, Mesh64

from kinematify.assembly.part import Assembly, Part
from kinematify.generate.procedural.blueprint import BlueprintJoint
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from trimesh import Trimesh

    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.solids import Point
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class KnownJoint(BlueprintJoint):
    """The truth about one joint, in world coordinates."""

    stops: tuple[bool, bool] = (False, False)
    """Whether the geometry itself blocks motion a little below `lower` and a little above `upper`."""


@dataclass(frozen=True, kw_only=True, eq=False)
class KnownObject:
    """Closed part meshes in one configuration and the tree of joints that connects them."""

    name: str
    parts: tuple[Part, ...]
    joints: tuple[KnownJoint, ...]
    root: str

    @property
    def assembly(self) -> Assembly:
        """What the inference is given: the parts alone."""
        return Assembly(parts=self.parts, source=self.name)

    @property
    def index(self) -> dict[str, int]:
        """Part name -> position in `parts`."""
        return {part.name: k for k, part in enumerate(self.parts)}

    def subtree(self, name: str) -> frozenset[str]:
        """Names of the part `name` and of all that it carries."""
        children = [joint.child for joint in self.joints if joint.parent == name]
        return frozenset({name}).union(*(self.subtree(child) for child in children))


def transformed(part: Part, transform: FloatArray) -> Part:
    """Return the part moved by `transform`, shape (4, 4)."""
    return Part(name=part.name, vertices=part.vertices @ transform[:3, :3].T + transform[:3, 3], faces=part.faces)


def posed(known: KnownObject, transform: FloatArray) -> KnownObject:
    """Return the object, truth included, moved rigidly by `transform`, shape (4, 4)."""
    turn, shift = np.asarray(transform)[:3, :3], np.asarray(transform)[:3, 3]
    joints = tuple(replace(joint, axis=turn @ joint.axis, pivot=turn @ joint.pivot + shift) for joint in known.joints)
    return replace(known, parts=tuple(transformed(part, transform) for part in known.parts), joints=joints)


def with_yaw(known: KnownObject, angle: float) -> KnownObject:
    """Return the object turned about the world's up axis by `angle` [rad]."""
    transform = np.eye(4)
    transform[:3, :3] = rotation_about(np.array([0.0, 0.0, 1.0]), angle)
    return posed(known, transform)


def moved(known: KnownObject, values: Mapping[str, float]) -> KnownObject:
    """Return the object with its joints moved; the new configuration is the new zero of every joint.

    Args:
        known: the object.
        values: child part name -> joint value [rad or m].
    """
    poses = {known.root: np.eye(4)}
    waiting = list(known.joints)
    while waiting:
        joint = waiting.pop(0)
        if joint.parent in poses:
            poses[joint.child] = poses[joint.parent] @ joint.motion(values.get(joint.child, 0.0))
        else:
            waiting.append(joint)
    joints = tuple(
        replace(
            joint,
            axis=poses[joint.parent][:3, :3] @ joint.axis,
            pivot=poses[joint.parent][:3, :3] @ joint.pivot + poses[joint.parent][:3, 3],
            lower=joint.lower - values.get(joint.child, 0.0),
            upper=joint.upper - values.get(joint.child, 0.0),
        )
        for joint in known.joints
    )
    return replace(known, parts=tuple(transformed(part, poses[part.name]) for part in known.parts), joints=joints)


def shuffled(known: KnownObject, seed: int) -> KnownObject:
    """Return the object with its parts listed in a random order."""
    order = np.random.default_rng(seed).permutation(len(known.parts))
    return replace(known, parts=tuple(known.parts[k] for k in order))


def known_object(name: str, solids: Mapping[str, Manifold], *joints: KnownJoint) -> KnownObject:
    """Return the object whose first solid is the root."""
    parts = []
    for part_name, solid in solids.items():
        mesh = solid.to_mesh64()
        parts.append(Part(name=part_name, vertices=mesh.vert_properties[:, :3], faces=mesh.tri_verts))
    return KnownObject(name=name, parts=tuple(parts), joints=joints, root=parts[0].name)


def turning(
    parent: str, child: str, axis: Point, pivot: Point, limits: tuple[float, float] | None = None, **more: object
) -> KnownJoint:
    """Return a revolute joint, or a continuous one where there are no limits."""
    kind = JointType.CONTINUOUS if limits is None else JointType.REVOLUTE
    lower, upper = limits or (-np.inf, np.inf)
    return KnownJoint(parent=parent, child=child, kind=kind, axis=axis, pivot=pivot, lower=lower, upper=upper, **more)


def sliding(
    parent: str, child: str, axis: Point, pivot: Point, limits: tuple[float, float], **more: object
) -> KnownJoint:
    """Return a prismatic joint; `pivot` is any point of the child."""
    return KnownJoint(
        parent=parent, child=child, kind=JointType.PRISMATIC, axis=axis, pivot=pivot,
        lower=limits[0], upper=limits[1], **more,
    )  # fmt: skip


def fixed(parent: str, child: str) -> KnownJoint:
    """Return a joint that does not move."""
    return KnownJoint(
        parent=parent, child=child, kind=JointType.FIXED, axis=(0, 0, 1), pivot=(0, 0, 0), lower=0.0, upper=0.0
    )


def part_of(mesh: Trimesh, name: str = "part") -> Part:
    """Return a mesh as a part."""
    return Part(name=name, vertices=mesh.vertices, faces=mesh.faces)


def solid_of(part: Part) -> Manifold:
    """Return a part, or a body of a blueprint, as a solid."""
    return Manifold(Mesh64(vert_properties=np.array(part.vertices), tri_verts=np.array(part.faces, dtype=np.uint64)))


def angle_deg(first: FloatArray, second: FloatArray) -> float:
    """Angle between two lines through the origin."""
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(first, second)), abs(first @ second))))


def carried(blueprint: Blueprint, name: str) -> set[str]:
    """A part and all that hangs on it."""
    found = {name}
    for joint in blueprint.joints:
        if joint.parent in found:
            found.add(joint.child)
    return found


def varied(seed: int | None, spread: float = 0.12) -> Callable[[float], float]:
    """Return a function that scales a size at random by up to `spread`; without a seed sizes stay as they are."""
    rng = np.random.default_rng(seed)
    return lambda size: size if seed is None else size * rng.uniform(1.0 - spread, 1.0 + spread)
