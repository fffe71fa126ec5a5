"""The stage `prepare`: it tells no checks, it writes what the engine stages load."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def run(request: StageRequest, recorder: Recorder) -> None:
    """Write `prepared.urdf` and `prepared.json` (`kinematify.simulation.prepared`)."""
    from kinematify.simulation.prepared import prepare
    from kinematify.validation.left_model import model_of

    del recorder  # what was changed is reported by the checks that look at it
    prepare(model_of(request), request.work, request.settings.prepare)
