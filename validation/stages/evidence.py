"""The stage of the checks that hold each declared joint against the contact geometry."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config import load_config
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.validation.checks import checks_of
from kinematify.validation.evidence.bodies import read_bodies
from kinematify.validation.evidence.case import JointCase, better_joint
from kinematify.validation.evidence.measure import measure_joints
from kinematify.validation.left_model import model_of
from kinematify.validation.report import JointSummary

if TYPE_CHECKING:
    from typing import Any

    from kinematify.assembly.truth import TrueJoint
    from kinematify.robot.robot import Robot
    from kinematify.validation.evidence.bodies import Bodies
    from kinematify.validation.evidence.case import Alternative
    from kinematify.validation.stage import Recorder, StageRequest

CONFIG = "evidence"
"""The configuration of the scorers; coarser than that of the inference, for the joint is known already."""


def run(request: StageRequest, recorder: Recorder) -> None:
    """Judge every joint between two bodies with geometry; see `kinematify.validation.stage`."""
    checks = checks_of("KV34")
    if not recorder.wants(*(check.id for check in checks)):
        return
    robot, seed = model_of(request), request.settings.seed
    bodies = read_bodies(robot, load_config(CONFIG), seed=seed)
    if bodies is None or not bodies.truth.joints:
        recorder.skip(checks, "no joint moves a body with geometry against another one")
        return
    cases = []
    for measures in measure_joints(bodies, request.settings.evidence, seed=seed):
        cases.append(JointCase(bodies=bodies, measures=measures, settings=request.settings.evidence))
        if request.remaining == 0.0:
            break
    left = len(bodies.truth.joints) - len(cases)
    doubts: dict[str | None, set[str]] = defaultdict(set)
    for check in checks:
        with recorder.check(check.id) as result:
            result.measured["joints"] = len(cases)
            for case in cases:
                check.run(result, case)
            if left:
                result.skip(f"time ran out before {left} of the joints")
        for finding in result.findings:
            doubts[finding.joint].add(check.id)
    for case in cases:
        joint = case.measures.joint
        better = better_joint(case.measures, doubts[joint.source])
        recorder.summarise(_summary(robot, bodies, joint, better))


def _summary(robot: Robot, bodies: Bodies, joint: TrueJoint, better: Alternative | None) -> JointSummary:
    declared = robot.joint_by_name[joint.source]
    limited = declared.kind in (JointType.REVOLUTE, JointType.PRISMATIC)
    return JointSummary(
        joint=joint.source,
        kind=declared.kind.value,
        declared_limits=(declared.lower, declared.upper) if limited else None,
        best_alternative=None if better is None else _at_zero(robot, bodies, joint, better),
    )


def _at_zero(robot: Robot, bodies: Bodies, joint: TrueJoint, better: Alternative) -> dict[str, Any]:
    """The better joint in the world frame at zero: where the parent carries it from its place at rest."""
    carrier = bodies.truth.part_links[joint.parent][0]
    T_world_rest = forward_kinematics(robot, rest_configuration(robot))[carrier]
    T_zero_rest = forward_kinematics(robot, {})[carrier] @ np.linalg.inv(T_world_rest)
    return {
        "kind": better.kind.value,
        "axis": (T_zero_rest[:3, :3] @ better.axis).tolist(),
        "pivot": (T_zero_rest[:3, :3] @ better.pivot + T_zero_rest[:3, 3]).tolist(),
        "score": better.score,
    }
