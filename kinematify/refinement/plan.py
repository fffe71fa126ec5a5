"""One answer of the loop: a tree with a joint for every edge, and how it is told from others."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.model.build import build_model

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.candidate import JointEstimate
    from kinematify.model.kinematic_model import KinematicModel


@dataclass(frozen=True, kw_only=True, eq=False)
class Plan:
    """A mechanism that can be simulated."""

    assembly: Assembly
    config: Config
    tree: KinematicTree
    joints: tuple[JointEstimate, ...]
    """One per edge, in the order of `tree.edges()`."""

    @cached_property
    def model(self) -> KinematicModel:
        """Its kinematic model; names of joints follow from those of the parts, whatever the tree."""
        return build_model(self.assembly, self.tree, self.joints, name="model", config=self.config.model)

    @cached_property
    def joint_of(self) -> Mapping[str, str]:
        """Name of the joint above each part, by the part's name."""
        return {joint.child: joint.name for joint in self.model.joints}

    @cached_property
    def signature(self) -> tuple[object, ...]:
        """What two plans share that are the same for every purpose: tree, types, lines and ranges to 6 digits."""
        return self.tree.parents, tuple(_signature(joint) for joint in self.joints)

    def index(self, child: str) -> int:
        """Position of the joint above a part."""
        number = self.assembly.names.index(child)
        return next(k for k, joint in enumerate(self.joints) if joint.child == number)

    def with_joint(self, joint: JointEstimate) -> Plan:
        """The same plan with another joint for one edge."""
        joints = tuple(joint if item.child == joint.child else item for item in self.joints)
        return replace(self, joints=joints)


def _signature(joint: JointEstimate) -> tuple[object, ...]:
    numbers = (*joint.axis, *joint.pivot, joint.lower, joint.upper)
    return joint.child, joint.kind.value, tuple(float(np.round(number, 6)) for number in numbers)
