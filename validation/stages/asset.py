"""The stage `asset`: mesh files first (KV15x), then everything that the file declares beside its kinematics (KV2xx)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.checks import checks_of
from kinematify.validation.finding import Status

if TYPE_CHECKING:
    from kinematify.robot.robot import Robot
    from kinematify.validation.stage import Recorder, StageRequest

_GUARDS = checks_of("KV150", "KV151", "KV152")
"""After an error of these nothing else can open the meshes."""


def run(request: StageRequest, recorder: Recorder) -> None:
    """Tell KV150 to KV159, and KV201 to KV243 where the meshes can be read."""
    from kinematify.validation.asset.rigid_bodies import measure
    from kinematify.validation.model_cache import cache_model

    model = check_mesh_files(request, recorder)
    if model is None:
        return
    cache_model(model, request.work)
    declared = checks_of("KV2")
    if recorder.is_selected(*(check.id for check in declared)):
        physics = measure(model, request.settings.physics)
        for check in declared:
            recorder.run(check, physics)


def check_mesh_files(request: StageRequest, recorder: Recorder) -> Robot | None:
    """Tell KV150 to KV159 and return the model, or None where a mesh keeps it from being read.

    Args:
        request: Names the document, which has passed the pre-check.
        recorder: Told every check; the later ones are blocked where a mesh cannot be used.
    """
    from kinematify.validation.asset.mesh_look import MeshContext

    look, usable = MeshContext(request), True
    for check in _GUARDS:
        with recorder.check(check.id) as result:
            check.run(result, look)
        usable &= not result.is_fatal and result.status is not Status.BLOCKED
    others = [check for check in checks_of("KV15") if check not in _GUARDS]
    if not usable:
        for check in others:
            with recorder.check(check.id) as result:
                result.block("a mesh cannot be used")
        return None
    for check in others:
        recorder.run(check, look)
    return look.model
