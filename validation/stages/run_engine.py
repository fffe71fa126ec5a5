"""The stage of one engine: load, pose, contacts at rest, hold, drive, push, release, drop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.simulation.engines import ENGINES
from kinematify.validation.checks import CHECKS
from kinematify.validation.summary import JointCurve

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.validation.engine_context import EngineContext
    from kinematify.validation.stage import Recorder, StageRequest

_LOAD, _REST = "01", "03"
_GATHERING = ("07", "10")
"""Numbers of the checks that look at all runs; these come last."""
_ORDER = (_LOAD, "02", _REST, "04", "08", "12", "05", "06", "09", "13", "11", *_GATHERING)
_LOADS, _AGREES = "KV606", "KV601"
"""Of an engine that only computes."""


def run(request: StageRequest, recorder: Recorder, *, engine: str) -> None:
    """Tell all checks of an engine; see `kinematify.validation.stage`.

    Args:
        request: Of the run; `prepared.urdf` is read from its folder.
        recorder: Called with the results.
        engine: Of `ENGINES`.
    """
    from kinematify.validation.engine_context import EngineContext

    context = EngineContext(request=request, entry=ENGINES[engine])
    if context.entry.runs:
        _run(context, recorder)
    else:
        _compute(context, recorder)


def _compute(context: EngineContext, recorder: Recorder) -> None:
    """Load the model into an engine that only computes, and compare its poses."""
    name = context.entry.name
    with recorder.check(_LOADS, name) as result:
        CHECKS[_LOADS].run(result, context)
    with recorder.check(_AGREES, name) as result:
        if "model" in vars(context) and context.model.complete:
            CHECKS[_AGREES].run(result, context)
        else:
            result.block(f"{context.entry.title} does not load the model as it is in the file ({_LOADS})")


def _run(context: EngineContext, recorder: Recorder) -> None:
    entry = context.entry
    checks = {number: CHECKS[entry.family + number] for number in _ORDER}
    joints, most = len(context.mechanism.joints), entry.most_joints
    too_many = None if most is None or joints <= most else f"{entry.title} handles {most} moving joints"
    gathering = recorder.wants(*(checks[number].id for number in _GATHERING))
    obstacle: str | None = None
    for number, check in checks.items():
        # What no check wants is not recorded; those that gather need all runs.
        if number != _LOAD and not gathering and not recorder.wants(check.id):
            continue
        with recorder.check(check.id, entry.name) as result:
            if too_many:
                result.skip(f"{too_many}; the model has {joints}")
            elif obstacle:
                result.block(obstacle)
            else:
                check.run(result, context)
        if number == _LOAD and not ("model" in vars(context) and context.model.complete):
            obstacle = f"{entry.title} does not load the model as it is in the file ({check.id})"
        elif number == _REST and not obstacle and "sweep" not in vars(context):
            obstacle = f"the contacts at rest could not be measured ({check.id})"
        if number == "05" and "drives" in vars(context):
            for curve in _curves(context):
                recorder.summarise(curve)


def _curves(context: EngineContext) -> Iterator[JointCurve]:
    """Yield how the joints were driven, for whoever draws it."""
    for item in context.drives.driven:
        commanded, reached, force, depth = (tuple(map(float, row)) for row in item.looks)
        yield JointCurve(
            joint=context.travel(item).joint,
            engine=context.entry.name,
            upper=bool(item.drive.end == context.travel(item).upper),
            commanded=commanded,
            reached=reached,
            force=force,
            depth=depth,
        )
