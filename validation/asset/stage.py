"""The stage `asset`: mesh files first (KV15x), then everything that the file declares beside its kinematics (KV2xx)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.asset.bodies import measure
from kinematify.validation.asset.meshes import check_mesh_files
from kinematify.validation.checks import checks_of
from kinematify.validation.left_model import leave_model

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def run(request: StageRequest, recorder: Recorder) -> None:
    """Tell KV150 to KV159, and KV201 to KV243 where the meshes can be read."""
    model = check_mesh_files(request, recorder)
    if model is None:
        return
    leave_model(model, request.work)
    declared = checks_of("KV2")
    if recorder.wants(*(check.id for check in declared)):
        physics = measure(model, request.settings.physics)
        for check in declared:
            recorder.run(check, physics)
