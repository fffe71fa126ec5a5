"""The stage `agreement`: what the engines left behind, compared with each other and the analytical model (KV6xx)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.simulation.engines import ENGINES
from kinematify.validation.checks import checks_of

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def run(request: StageRequest, recorder: Recorder) -> None:
    """Compare the engines that were asked for, by what they left in the folder of the run."""
    from kinematify.validation.engine_results import EngineResults

    chosen = tuple(engine for engine in request.engines if ENGINES[engine].prepared)
    left = EngineResults(request, chosen, request.failures)
    for check in checks_of("KV6"):
        if not check.engines:
            recorder.run(check, left)
