"""The cheap tier: what the exact geometry says of a plan, in this process and without a file.

The judges are those of `kinematify validate` (KV301 to KV321), so that a plan that passes here passes there. Sweeps
of joints that did not change since an earlier plan are not repeated.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from kinematify.geometry.overlap import Overlap
from kinematify.geometry.rest import Allowance
from kinematify.geometry.sweep import Sweeper
from kinematify.refinement.world import World
from kinematify.validation.geometry import judge_motion
from kinematify.validation.geometry.judge_motion import MotionCase
from kinematify.validation.geometry.judge_rest import hovering, neighbours, strangers
from kinematify.validation.report import JointSummary
from kinematify.validation.stage import OpenCheck

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from kinematify.config.validation import GeometrySettings
    from kinematify.geometry.sweep import JointSweep
    from kinematify.model.kinematic_model import Joint, KinematicModel
    from kinematify.refinement.world import WorldScene
    from kinematify.validation.finding import Finding
    from kinematify.validation.geometry.remark import Remark

_MOTION: dict[str, Callable[[MotionCase], Iterator[Remark]]] = {
    "KV310": judge_motion.through_parent,
    "KV311": judge_motion.into_others,
    "KV312": judge_motion.beyond_free_travel,
    "KV320": judge_motion.lost_contact,
    "KV321": judge_motion.out_of_guide,
}


@dataclass(frozen=True, kw_only=True)
class Verdict:
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
        self._world = World(model, settings)
        self._sweeps: dict[tuple[object, ...], JointSweep] = {}

    def judge(self, model: KinematicModel) -> Verdict:
        """Judge a whole plan."""
        look = _Look(self._world.scene(model))
        found = list(_findings("KV301", strangers(look.scene, look.allowance, None)))
        found += _findings("KV302", neighbours(look.scene, look.overlap, look.allowance, None))
        found += _findings("KV303", hovering(look.scene, look.allowance))
        summaries: list[JointSummary] = []
        for leader, travel in enumerate(look.scene.travels):
            told, summary = self._joint(look, model, leader, travel.joint)
            found += told
            summaries.append(summary)
        return Verdict(findings=tuple(found), joints=tuple(summaries))

    def judge_joint(self, model: KinematicModel, joint: str) -> Verdict:
        """Judge one joint of a plan by its motion alone; a fixed joint has nothing to say."""
        look = _Look(self._world.scene(model))
        names = [travel.joint for travel in look.scene.travels]
        if joint not in names:
            return Verdict(findings=(), joints=())
        found, summary = self._joint(look, model, names.index(joint), joint)
        return Verdict(findings=tuple(found), joints=(summary,))

    def _joint(self, look: _Look, model: KinematicModel, leader: int, name: str) -> tuple[list[Finding], JointSummary]:
        key = _key(model, name)
        if key not in self._sweeps:
            self._sweeps[key] = look.sweeper.sweep(leader)
        sweep = self._sweeps[key]
        if sweep.leader != leader:  # another joint became fixed or free: the same motion under another number
            sweep = self._sweeps[key] = look.sweeper.sweep(leader)
        case = MotionCase(scene=look.scene, overlap=look.overlap, allowance=look.allowance, sweep=sweep, visible=None)
        found = [finding for check, judge in _MOTION.items() for finding in _findings(check, judge(case))]
        joint = next(item for item in model.joints if item.name == name)
        summary = JointSummary(
            joint=name, kind=joint.kind.value, declared_limits=(joint.lower, joint.upper), free_travel=sweep.free
        )
        return found, summary


class _Look:
    """A scene with what asks it."""

    def __init__(self, scene: WorldScene) -> None:
        self.scene = scene
        self.overlap = Overlap(scene)
        self.allowance = Allowance(scene, self.overlap)
        self.sweeper = Sweeper(scene, self.overlap, self.allowance)


def _findings(check: str, remarks: Iterator[Remark]) -> Iterator[Finding]:
    opened = OpenCheck(id=check, engine=None)
    for remark in remarks:
        remark.add_to(opened)
    yield from opened.findings


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
