"""The finished model: links with frames, meshes and inertia, and joints between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.arrays import read_only
from kinematify.robot.robot import Link, Robot

if TYPE_CHECKING:
    from kinematify.assembly.part import Part
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Inertial, Joint, LoopJoint


@dataclass(frozen=True, kw_only=True, eq=False)
class ModelLink:
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
class KinematicModel:
    """A kinematic tree of links and joints; the root link's frame is the world frame of the input."""

    name: str
    links: tuple[ModelLink, ...]
    joints: tuple[Joint, ...]
    loops: tuple[LoopJoint, ...] = ()
    """What closes chains of joints besides."""

    @cached_property
    def link_by_name(self) -> dict[str, ModelLink]:
        """Links keyed by name."""
        return {link.name: link for link in self.links}

    @cached_property
    def robot(self) -> Robot:
        """The tree with its masses, without shapes: for forward kinematics and whatever else needs no mesh."""
        links = tuple(Link(name=link.name, inertial=link.inertial) for link in self.links)
        return Robot(name=self.name, links=links, joints=self.joints, loops=self.loops)

    @property
    def root(self) -> str:
        """Name of the base link."""
        return self.robot.root
