"""The stage of the checks that hold each declared joint, and each pin without one, against the contact geometry."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.checks import checks_of
from kinematify.validation.summary import summary_of

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest

CONFIG = "evidence"
"""The configuration of the scorers; coarser than that of the inference, for the joint is known already."""


def run(request: StageRequest, recorder: Recorder) -> None:
    """Judge every joint between two bodies with geometry; see `kinematify.validation.stage`."""
    from kinematify.config import load_config
    from kinematify.validation.evidence.bodies_at_rest import read_bodies
    from kinematify.validation.evidence.case import JointCase, better_joint
    from kinematify.validation.evidence.loop_pins import shared_pins
    from kinematify.validation.evidence.measure import measure_joints
    from kinematify.validation.model_cache import model_of

    of_joints, of_pins = checks_of("KV34"), checks_of("KV35")
    checks = of_joints + of_pins
    if not recorder.is_selected(*(check.id for check in checks)):
        return
    robot, seed = model_of(request), request.settings.seed
    bodies = read_bodies(robot, load_config(CONFIG), seed=seed)
    if bodies is None or not bodies.truth.joints:
        recorder.skip(checks, "no joint moves a body with geometry against another one")
        return
    settings = request.settings.evidence
    every = measure_joints(bodies, settings, seed=seed)
    all_cases = (
        JointCase(bodies=bodies, measures=measures, settings=settings, every=every, doubted=request.doubted)
        for measures in every
    )
    cases = [case for case in all_cases if request.remaining and (not case.examined or case.measures.posterior)]
    left = len(every) - len(cases)
    for check in of_joints:
        with recorder.check(check.id) as result:
            result.measured["joints"] = len(cases)
            for case in cases:
                check.run(result, case)
            if left:
                result.leave(f"{left} of the joints")
    pins = () if left else tuple(shared_pins(bodies, robot))
    for check in of_pins:
        with recorder.check(check.id) as result:
            for pin in pins:
                check.run(result, pin)
            if left:
                result.leave("the pins, and before that some of the joints")
    for case in cases:
        joint = robot.joint_by_name[case.measures.joint.source]
        recorder.summarise(summary_of(joint, best_alternative=better_joint(robot, case)))
