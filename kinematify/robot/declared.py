"""What a URDF declares, complete: kinematics, geometry of both kinds, mass, effort, and the lines where it says so."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only

if TYPE_CHECKING:
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import DescribedJoint, LinkMesh, RobotDescription


@dataclass(frozen=True, kw_only=True, eq=False)
class DeclaredInertial:
    """The `inertial` element of a link, turned into the link frame."""

    mass: float
    """[kg], as written."""
    center_of_mass: FloatArray
    """Link frame [m], shape (3,). Read-only."""
    tensor: FloatArray
    """About the centre of mass, axes of the link frame [kg m^2], shape (3, 3). Read-only."""
    line: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "center_of_mass", read_only(self.center_of_mass, np.float64))
        object.__setattr__(self, "tensor", read_only(self.tensor, np.float64))


@dataclass(frozen=True, kw_only=True, eq=False)
class DeclaredShape:
    """One `visual` or `collision` element."""

    kind: str
    """``mesh``, ``box``, ``cylinder``, ``sphere`` or ``capsule``."""
    mesh: LinkMesh
    """Its triangles in the link frame [m]; primitives are tessellated."""
    file: Path | None
    """Mesh file, resolved; None for primitives."""
    scale: FloatArray
    """Scale of a mesh as written, ones for primitives, shape (3,). Read-only."""
    size: tuple[float, ...]
    """Box: x, y, z; cylinder and capsule: radius, length; sphere: radius [m]; empty for a mesh."""
    T_link_shape: FloatArray
    """The element's origin, shape (4, 4). Read-only."""
    line: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "scale", read_only(self.scale, np.float64))
        object.__setattr__(self, "T_link_shape", read_only(self.T_link_shape, np.float64))


@dataclass(frozen=True, kw_only=True, eq=False)
class DeclaredLink:
    """A link with everything that the file says about it."""

    name: str
    inertial: DeclaredInertial | None
    visuals: tuple[DeclaredShape, ...]
    collisions: tuple[DeclaredShape, ...]
    line: int

    @property
    def has_geometry(self) -> bool:
        """True if it has a visual or a collision shape."""
        return bool(self.visuals or self.collisions)


@dataclass(frozen=True, kw_only=True, eq=False)
class DeclaredJoint:
    """A joint with what simulators need beside its kinematics."""

    joint: DescribedJoint
    declared_kind: str
    """Type as written, e.g. ``floating``, which `joint` reads as fixed."""
    has_limit: bool
    """True if there is a `limit` element."""
    effort: float | None
    """[N m or N]; None where absent."""
    velocity: float | None
    """[rad/s or m/s]; None where absent."""
    damping: float | None
    friction: float | None
    line: int

    @property
    def name(self) -> str:
        """Name of the joint."""
        return self.joint.name


@dataclass(frozen=True, kw_only=True, eq=False)
class DeclaredModel:
    """A URDF that passed the pre-check: a tree of single-axis joints with readable meshes."""

    path: Path
    """The URDF file, absolute."""
    name: str
    links: tuple[DeclaredLink, ...]
    joints: tuple[DeclaredJoint, ...]
    kinematics: RobotDescription
    """The same tree for `assembly.robot`; link meshes are the visual ones, collision where there are none."""

    @cached_property
    def link_by_name(self) -> dict[str, DeclaredLink]:
        """Links keyed by name."""
        return {link.name: link for link in self.links}

    @cached_property
    def joint_by_name(self) -> dict[str, DeclaredJoint]:
        """Joints keyed by name."""
        return {joint.name: joint for joint in self.joints}

    @cached_property
    def moving(self) -> tuple[DeclaredJoint, ...]:
        """Joints that move by themselves (neither fixed nor mimic), in the order of the document."""
        return tuple(j for j in self.joints if j.joint.kind != "fixed" and j.joint.mimic is None)
