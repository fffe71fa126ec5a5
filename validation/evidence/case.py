"""One declared joint with what the geometry of its two bodies says of it, as the checks of KV34x look at it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.validation.summary import JointSummary

if TYPE_CHECKING:
    from collections.abc import Collection
    from typing import Any

    from kinematify.config.validation import EvidenceSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot
    from kinematify.validation.evidence.bodies import Bodies
    from kinematify.validation.evidence.measure import JointMeasures

_LINKAGE = 0.5  # `JointScene.mechanism` from which a pair belongs to a linkage rather than to furniture
_SMALL = 0.5  # `JointScene.smallness` from which a part is a button or knob


@dataclass(frozen=True, kw_only=True)
class JointCase:
    """One declared joint."""

    bodies: Bodies
    measures: JointMeasures
    settings: EvidenceSettings

    @property
    def linkage(self) -> bool:
        """The pair belongs to a machine, not to furniture."""
        return self.measures.weighed.scene.mechanism > _LINKAGE

    @property
    def small(self) -> bool:
        """The child is a button, a knob or a lever."""
        return self.measures.weighed.scene.smallness > _SMALL

    @property
    def closed_panel(self) -> bool:
        """The child is a door or lid that is shut."""
        panel = self.measures.weighed.scene.panel and not self.measures.room.ajar
        return panel and not self.measures.slides and not self.linkage

    @property
    def parent(self) -> str:
        """Name of the body that carries the joint."""
        return self.bodies.links[self.measures.joint.parent]

    @property
    def child(self) -> str:
        """Name of the body that moves."""
        return self.bodies.links[self.measures.joint.child]

    @property
    def share_of_contact(self) -> float:
        """Quality of the contact with the parent over that of the best other contact; inf without another."""
        found = self.measures.parent
        return found.quality / found.best_quality if found.best_quality > 0.0 else float("inf")

    @property
    def hangs_elsewhere(self) -> bool:
        """The child touches another body and not its parent, or its parent far less; it is judged no further then."""
        found = self.measures.parent
        touches_another = found.best is not None and found.best_quality > 0.0
        return touches_another and (not found.touches or self.share_of_contact < self.settings.weak_contact)

    @property
    def lines_judged(self) -> bool:
        """Direction and place of its axis can be judged: the child touches its parent and hangs on no other body."""
        return self.measures.parent.touches and not self.hangs_elsewhere

    @property
    def unexplained(self) -> bool:
        """The axis runs along no direction that the two bodies show."""
        return self.lines_judged and self.measures.line.angle > self.settings.unknown_deg

    @property
    def judged_alone(self) -> bool:
        """It is the only joint between the two bodies, and hangs on no other: the contact tells of this joint."""
        return self.measures.alone and not self.hangs_elsewhere

    @property
    def blocked(self) -> float:
        """Share of the declared range in which the parent is in the way, of as much of it as was swept."""
        joint, room = self.measures.joint, self.measures.room
        upper, lower = min(max(joint.upper, 0.0), room.reach), min(max(-joint.lower, 0.0), room.reach)
        missing = max(upper - room.forward, 0.0) + max(lower - room.backward, 0.0)
        return missing / max(upper + lower, 1e-12)


@dataclass(frozen=True, kw_only=True, eq=False)
class Alternative:
    """A joint that explains the contact better than the declared one."""

    kind: JointType
    axis: FloatArray
    """Unit direction, world frame at rest, shape (3,)."""
    pivot: FloatArray
    """A point on the axis, world frame at rest [m], shape (3,)."""
    score: float
    """By how much it leads over the declared joint."""


def better_joint(measures: JointMeasures, doubts: Collection[str]) -> Alternative | None:
    """Return the joint that the geometry speaks for instead.

    Args:
        measures: Of the declared joint.
        doubts: Ids of the checks that speak against it; None is returned where none of them is about its line or type.
    """
    if not {"KV342", "KV343", "KV344", "KV345"} & set(doubts):
        return None
    line = measures.line
    if "KV345" not in doubts:
        kind = JointType.PRISMATIC if measures.slides else JointType.REVOLUTE
        return Alternative(kind=kind, axis=line.best_axis, pivot=line.best_pivot, score=line.deficit)
    turns, slides, score = measures.weighed.turns.proposed, measures.weighed.slides.proposed, measures.odds_against
    if measures.slides:
        return Alternative(kind=JointType.REVOLUTE, axis=turns.lines.axes[0], pivot=turns.lines.pivots[0], score=score)
    return Alternative(kind=JointType.PRISMATIC, axis=slides.axes[0], pivot=measures.anchor, score=score)


def summary_of(robot: Robot, case: JointCase, doubts: Collection[str]) -> JointSummary:
    """Return what the report tells of the joint besides its checks, `doubts` as for `better_joint`."""
    joint = case.measures.joint
    declared = robot.joint_by_name[joint.source]
    limited = declared.kind in (JointType.REVOLUTE, JointType.PRISMATIC)
    better = better_joint(case.measures, doubts)
    return JointSummary(
        joint=joint.source,
        kind=declared.kind.value,
        declared_limits=(declared.lower, declared.upper) if limited else None,
        best_alternative=None if better is None else _at_zero(robot, case, better),
    )


def _at_zero(robot: Robot, case: JointCase, better: Alternative) -> dict[str, Any]:
    """The better joint in the world frame at zero: where the parent carries it from its place at rest."""
    carrier = case.bodies.truth.part_links[case.measures.joint.parent][0]
    T_world_rest = forward_kinematics(robot, rest_configuration(robot))[carrier]
    T_zero_rest = forward_kinematics(robot, {})[carrier] @ np.linalg.inv(T_world_rest)
    return {
        "kind": better.kind.value,
        "axis": (T_zero_rest[:3, :3] @ better.axis).tolist(),
        "pivot": (T_zero_rest[:3, :3] @ better.pivot + T_zero_rest[:3, 3]).tolist(),
        "score": better.score,
    }
