"""The stage of the untouched file in one engine, with the engine's defaults (KV8xx)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.checks import checks_of

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def run(request: StageRequest, recorder: Recorder, *, engine: str) -> None:
    """Tell all checks of the file as an engine loads it; see `kinematify.validation.stage`."""
    from kinematify.validation.as_loaded_context import AsLoadedContext

    context = AsLoadedContext(request=request, engine=engine)
    for check in checks_of("KV8"):
        if engine in check.engines:
            recorder.run(check, context, engine)
