"""The finished model: links with frames, meshes and inertia, and joints between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.candidate import JointType
from kinematify.robot.arrays import read_only

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.robot.arrays import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Inertial:
    """Mass properties of a link, expressed in the link frame."""

    mass: float
    """[kg]."""
    center_of_mass: FloatArray
    """Link frame [m], shape (3,). Read-only."""
    tensor: FloatArray
    """Inertia about the centre of mass, axes of the link frame [kg m^2], shape (3, 3). Read-only."""
    source: str
    """``volume`` for a closed mesh, ``hull`` for the convex hull of an open or flat one."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "center_of_mass", read_only(self.center_of_mass, np.float64))
        object.__setattr__(self, "tensor", read_only(self.tensor, np.float64))


@dataclass(frozen=True, kw_only=True, eq=False)
class Link:
    """One rigid body; its frame has world orientation and its origin on the axis of its joint."""

    name: str
    part: Part
    """The mesh that was inferred from, in world coordinates of the input configuration."""
    T_world_link: FloatArray
    """Link frame at zero configuration, shape (4, 4). Read-only."""
    inertial: Inertial
    fixed_visuals: tuple[Part, ...] = ()
    """Set-aside meshes that ride on this link, world coordinates."""
    original: Part | None = None
    """The mesh as it was given, where `part` is a simplified one; world coordinates."""
    collision_parts: tuple[Part, ...] = ()
    """Meshes that stand in for the part in collisions, world coordinates; empty: the part itself."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "T_world_link", read_only(self.T_world_link, np.float64))

    @property
    def visual(self) -> Part:
        """The mesh that files and pictures show, world coordinates."""
        return self.original or self.part


@dataclass(frozen=True, kw_only=True, eq=False)
class Joint:
    """A URDF joint; the joint frame is the child link's frame."""

    name: str
    kind: JointType
    parent: str
    child: str
    T_parent_child: FloatArray
    """Child frame in the parent frame at q = 0, shape (4, 4). Read-only."""
    axis: FloatArray
    """Unit direction in the joint frame, shape (3,). Read-only."""
    lower: float
    """[rad or m]; -inf for continuous."""
    upper: float
    """[rad or m]; +inf for continuous."""
    effort: float
    """[N m or N]."""
    velocity: float
    """[rad/s or m/s]."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "T_parent_child", read_only(self.T_parent_child, np.float64))
        object.__setattr__(self, "axis", read_only(self.axis, np.float64))


@dataclass(frozen=True, kw_only=True, eq=False)
class KinematicModel:
    """A kinematic tree of links and joints; the root link's frame is the world frame of the input."""

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]

    @cached_property
    def link_by_name(self) -> dict[str, Link]:
        """Links keyed by name."""
        return {link.name: link for link in self.links}

    @cached_property
    def root(self) -> str:
        """Name of the base link."""
        children = {joint.child for joint in self.joints}
        return next(link.name for link in self.links if link.name not in children)
