"""One answer of the loop: a tree with a joint for every edge; and what happened in each round, as plain data."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

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
        """Return a key that equal plans share: tree, types, lines and ranges to 6 digits."""
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


@dataclass(frozen=True, kw_only=True)
class PlanChange:
    """One decision that was taken again."""

    part: str
    """Whose joint, or whose parent, it is."""
    what: str
    """``parent``, ``type``, ``axis``, ``range``, ``fixed`` or ``contacts``."""
    before: str
    after: str
    why: str
    """The evidence, one sentence."""


@dataclass(frozen=True, kw_only=True)
class Round:
    """One plan with what the simulation said of it."""

    number: int
    """0 is the inference as it was."""
    tier: str
    """``geometry``, ``engines`` or ``task``: how far it was simulated."""
    changes: tuple[PlanChange, ...]
    """What was chosen again before it was simulated."""
    motion_errors: int
    """By the exact geometry alone, which every tier has."""
    errors: int = 0
    """About motion or the task, by all that it was simulated by."""
    warnings: int = 0
    failed: tuple[str, ...] = ()
    """``CHECK joint`` of every error and warning about motion."""
    suspected: tuple[str, ...] = ()
    """What the feedback points to, one phrase each."""
    score: float = 0.0
    """Sum of the scores of the chosen candidates below the best ones, and of all log odds against them; 0 at best."""
    seconds: float = 0.0
    refused: tuple[str, ...] = ()
    """Changes that would have hidden a failure rather than fixed it, with the reason."""


@dataclass(frozen=True, kw_only=True)
class History:
    """All rounds, which one was kept, and why the loop ended."""

    rounds: tuple[Round, ...]
    kept: int
    """Number of the round that was written."""
    ended: str
    """Why there was no further round."""
    tier: str
    seconds: float
    candidates: int
    """Joints that were simulated beside the chosen ones."""

    @property
    def changed(self) -> tuple[PlanChange, ...]:
        """Everything that differs between the inference and the round that was kept."""
        return tuple(change for item in self.rounds[: self.kept + 1] for change in item.changes)

    def as_json(self) -> dict[str, Any]:
        """JSON values."""
        return asdict(self)
