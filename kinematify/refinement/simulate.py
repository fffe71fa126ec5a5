"""The cheap tier: what the exact geometry says of a plan, in this process and without a file.

The checks are those of `kinematify validate` (KV301 to KV321), so that a plan that passes here passes there. Sweeps
of joints that did not change since an earlier plan are not repeated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.refinement.world import PartsWorld
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import checks_of
from kinematify.validation.geometry.look import GeometryLook, JointMotion
from kinematify.validation.summary import JointSummary

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.config.validation import GeometrySettings
    from kinematify.geometry.sweep import JointSweep
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.robot import Joint
    from kinematify.validation.check import Check
    from kinematify.validation.finding import Finding


@dataclass(frozen=True, kw_only=True)
class MotionVerdict:
    """What a tier says of one plan."""

    findings: tuple[Finding, ...]
    joints: tuple[JointSummary, ...]
    """With the free travel of each joint that moves."""
    placements: Mapping[str, float] = field(default_factory=dict)
    """How many places of the robot were tried for each joint, if there was a task."""


class Simulator:
    """Judges plans of one assembly by exact geometry."""

    def __init__(self, model: KinematicModel, settings: GeometrySettings) -> None:
        """Keep the parts.

        Args:
            model: Any plan of the assembly.
            settings: Of the checks by geometry.
        """
        self._world = PartsWorld(model, settings)
        self._sweeps: dict[tuple[object, ...], JointSweep] = {}

    def judge(self, model: KinematicModel) -> MotionVerdict:
        """Judge a whole plan."""
        look = GeometryLook(self._world.scene(model), compare_visible=False)
        found = _findings([check for check in checks_of("KV30") if check.id != "KV304"], look)  # a table, no failure
        summaries: list[JointSummary] = []
        for leader, travel in enumerate(look.scene.travels):
            told, summary = self._joint(look, model, leader, travel.joint)
            found += told
            summaries.append(summary)
        return MotionVerdict(findings=tuple(found), joints=tuple(summaries))

    def judge_joint(self, model: KinematicModel, joint: str) -> MotionVerdict:
        """Judge one joint of a plan by its motion alone; a fixed joint has nothing to say."""
        look = GeometryLook(self._world.scene(model), compare_visible=False)
        names = [travel.joint for travel in look.scene.travels]
        if joint not in names:
            return MotionVerdict(findings=(), joints=())
        found, summary = self._joint(look, model, names.index(joint), joint)
        return MotionVerdict(findings=tuple(found), joints=(summary,))

    def _joint(
        self, look: GeometryLook, model: KinematicModel, leader: int, name: str
    ) -> tuple[list[Finding], JointSummary]:
        key = _key(model, name)
        if key not in self._sweeps:
            self._sweeps[key] = look.sweeper.sweep(leader)
        sweep = self._sweeps[key]
        if sweep.leader != leader:  # another joint became fixed or free: the same motion under another number
            sweep = self._sweeps[key] = look.sweeper.sweep(leader)
        found = _findings(checks_of("KV31", "KV32"), JointMotion(look=look, sweep=sweep))
        joint = next(item for item in model.joints if item.name == name)
        summary = JointSummary(
            joint=name, kind=joint.kind.value, declared_limits=(joint.lower, joint.upper), free_travel=sweep.free
        )
        return found, summary


def _findings(checks: Iterable[Check], context: object) -> list[Finding]:
    found: list[Finding] = []
    for check in checks:
        result = OpenCheck(id=check.id, engine=None)
        check.run(result, context)
        found += result.findings
    return found


def _key(model: KinematicModel, name: str) -> tuple[object, ...]:
    """What the sweep of a joint depends on: its line and range, and which bodies the tree moves against which."""
    joint = next(item for item in model.joints if item.name == name)
    tree = tuple(sorted((item.child, item.parent, item.kind.value == "fixed") for item in model.joints))
    return (*_line(model, joint), tree)


def _line(model: KinematicModel, joint: Joint) -> tuple[object, ...]:
    origin = model.link_by_name[joint.child].T_world_link[:3, 3]
    return (
        joint.child, joint.kind.value, joint.lower, joint.upper, joint.axis.tobytes(), origin.tobytes()
    )  # fmt: skip
