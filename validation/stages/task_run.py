"""The stage `task`: a robot uses the object (KV7xx)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.validation.checks import checks_of

if TYPE_CHECKING:
    from kinematify.validation.stage import Recorder, StageRequest


def run(request: StageRequest, recorder: Recorder) -> None:
    """Carry out the task of a request; see `kinematify.validation.stage`."""
    from kinematify.validation.task.pull_task import PullTask

    if request.task is None:
        return
    task = PullTask(request, request.task)
    first, *others = checks_of("KV7")
    with recorder.check(first.id) as result:
        first.run(result, task)
    if result.is_fatal or result.reason is not None:
        recorder.skip(others, f"the task cannot be set up, see {first.id}")
        return
    task.plan()
    for check in others:
        for engine in check.engines or (None,):
            if engine is None or engine in request.task_engines:
                recorder.run(check, task, engine)
