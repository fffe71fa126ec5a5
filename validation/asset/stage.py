"""The stage `asset`: mesh files first (KV15x), then everything that the file declares beside its kinematics (KV2xx)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.asset import collision, drives, inertias, limits, masses
from kinematify.validation.asset.bodies import measure
from kinematify.validation.asset.meshes import check_mesh_files
from kinematify.validation.left_model import leave_model

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kinematify.validation.asset.bodies import Physics
    from kinematify.validation.precheck.problem import Problem
    from kinematify.validation.stage import Recorder, StageRequest

    Probe = Callable[[Physics], Iterator[Problem]]

PROBES: dict[str, Probe] = {**masses.PROBES, **inertias.PROBES, **limits.PROBES, **drives.PROBES, **collision.PROBES}


def run(request: StageRequest, recorder: Recorder) -> None:
    """Tell KV150 to KV159, and KV201 to KV243 where the meshes can be read."""
    model = check_mesh_files(request, recorder)
    if model is not None:
        leave_model(model, request.work)
    if model is None or not recorder.wants(*PROBES):
        return
    physics = measure(model, request.settings.physics)
    for name, probe in sorted(PROBES.items()):
        with recorder.check(name) as check:
            reason = _inapplicable(name, physics)
            if reason is not None:
                check.skip(reason)
                continue
            for problem in probe(physics):
                problem.add_to(check)


def _inapplicable(name: str, physics: Physics) -> str | None:
    """Why a check has nothing to look at, or None."""
    joints = [joint.joint for joint in physics.model.joints]
    if name in _OF_MOTION and all(joint.kind == "fixed" for joint in joints):
        return "no joint moves"
    if name in _OF_MASS and not any(body.mass > 0.0 for body in physics.bodies):
        return "no link has a mass"
    if name == "KV225" and all(joint.mimic is None for joint in joints):
        return "no joint follows another"
    if name in _OF_COLLISION and not physics.collision:
        return "no link has collision geometry"
    return None


_OF_MOTION = ("KV201", "KV209", "KV220", "KV221", "KV222", "KV223", "KV224", "KV226")
_OF_MASS = ("KV203", "KV204", "KV205", "KV206", "KV207", "KV208", "KV209", "KV226")
_OF_COLLISION = ("KV241", "KV242", "KV243")
