"""One answer of the loop: an inference that can be simulated; and what happened in each round, as plain data."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from kinematify.model.build import build_model

if TYPE_CHECKING:
    from kinematify.joints.candidate import JointEstimate
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference


@dataclass(frozen=True, kw_only=True, eq=False)
class Plan:
    """A mechanism that can be simulated: the best tree of an inference with its joints."""

    inference: Inference

    @cached_property
    def model(self) -> KinematicModel:
        """Its kinematic model as a tree; names of joints follow from those of the parts, whatever the tree."""
        given = self.inference
        return build_model(given.assembly, given.trees[0], given.joints, name="model", config=given.config.model)

    def joint(self, child: str) -> JointEstimate:
        """The joint above a part."""
        number = self.inference.assembly.names.index(child)
        return next(joint for joint in self.inference.joints if joint.child == number)

    def with_joint(self, joint: JointEstimate) -> Plan:
        """The same plan with another joint for one edge."""
        joints = tuple(joint if item.child == joint.child else item for item in self.inference.joints)
        return Plan(inference=replace(self.inference, joints=joints))


@dataclass(frozen=True, kw_only=True)
class PlanChange:
    """One decision that was taken again."""

    part: str
    """Whose joint, or whose parent, it is."""
    what: str
    """``parent``, ``type``, ``axis``, ``range`` or ``fixed``."""
    before: str
    after: str
    why: str
    """The evidence, one sentence."""


@dataclass(frozen=True, kw_only=True)
class Round:
    """One plan with what the simulation said of it."""

    number: int
    """0 is the inference as it was."""
    changes: tuple[PlanChange, ...]
    """What was chosen again before it was simulated."""
    errors: int
    """About motion."""
    warnings: int
    failed: tuple[str, ...]
    """``CHECK joint`` of every error and warning about motion."""
    suspected: tuple[str, ...]
    """What the feedback points to, one phrase each."""
    score: float
    """Sum of the scores of the chosen candidates below the best ones, and of all log odds against them; 0 at best."""
    seconds: float
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
