"""The stage of the checks that hold each declared joint against the contact geometry."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.config import load_config
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.validation.catalogue.evidence import CHECKS
from kinematify.validation.evidence.bodies import read_bodies
from kinematify.validation.evidence.judge import better_joint, doubts_about
from kinematify.validation.evidence.measure import measure_joints
from kinematify.validation.left_model import model_of
from kinematify.validation.report import JointSummary

if TYPE_CHECKING:
    from typing import Any

    from kinematify.assembly.truth import TrueJoint
    from kinematify.robot.robot import RobotDescription
    from kinematify.validation.evidence.bodies import Bodies
    from kinematify.validation.evidence.judge import Alternative, Doubt
    from kinematify.validation.stage import Recorder, StageRequest

CONFIG = "evidence"
"""The configuration of the scorers; coarser than that of the inference, for the joint is known already."""


def run(request: StageRequest, recorder: Recorder) -> None:
    """Judge every joint between two bodies with geometry; see `kinematify.validation.stage`."""
    if not recorder.wants(*(check.id for check in CHECKS)):
        return
    description = model_of(request).kinematics
    seed = request.settings.seed
    bodies = read_bodies(description, load_config(CONFIG), seed=seed)
    if bodies is None or not bodies.truth.joints:
        _tell(recorder, [], skipped="no joint moves a body with geometry against another one")
        return
    found: list[tuple[TrueJoint, Doubt]] = []
    judged = 0
    for measures in measure_joints(bodies, request.settings.evidence, seed=seed):
        doubts = doubts_about(bodies, measures, request.settings.evidence)
        found += [(measures.joint, doubt) for doubt in doubts]
        recorder.summarise(_summary(description, bodies, measures.joint, better_joint(measures, doubts)))
        judged += 1
        if request.remaining == 0.0:
            break
    left = len(bodies.truth.joints) - judged
    _tell(recorder, found, skipped=f"time ran out before {left} of the joints" if left else None, judged=judged)


def _tell(recorder: Recorder, found: list[tuple[TrueJoint, Doubt]], *, skipped: str | None, judged: int = 0) -> None:
    for known in CHECKS:
        with recorder.check(known.id) as check:
            check.measured["joints"] = judged
            for joint, doubt in found:
                if doubt.check == known.id:
                    check.find(
                        doubt.message,
                        doubt.remedy,
                        severity=doubt.severity,
                        joint=joint.source,
                        q={joint.source: joint.value},
                        value=doubt.value,
                        limit=doubt.limit,
                        unit=doubt.unit,
                    )
            if skipped is not None:
                check.skip(skipped)


def _summary(
    description: RobotDescription, bodies: Bodies, joint: TrueJoint, better: Alternative | None
) -> JointSummary:
    declared = description.joint_by_name[joint.source]
    limited = declared.kind in (JointType.REVOLUTE, JointType.PRISMATIC)
    return JointSummary(
        joint=joint.source,
        kind=declared.kind.value,
        declared_limits=(declared.lower, declared.upper) if limited else None,
        best_alternative=None if better is None else _at_zero(description, bodies, joint, better),
    )


def _at_zero(description: RobotDescription, bodies: Bodies, joint: TrueJoint, better: Alternative) -> dict[str, Any]:
    """The better joint in the world frame at zero: where the parent carries it from its place at rest."""
    carrier = bodies.truth.part_links[joint.parent][0]
    T_world_rest = forward_kinematics(description, rest_configuration(description))[carrier]
    T_zero_rest = forward_kinematics(description, {})[carrier] @ np.linalg.inv(T_world_rest)
    return {
        "kind": better.kind.value,
        "axis": (T_zero_rest[:3, :3] @ better.axis).tolist(),
        "pivot": (T_zero_rest[:3, :3] @ better.pivot + T_zero_rest[:3, 3]).tolist(),
        "score": better.score,
    }
