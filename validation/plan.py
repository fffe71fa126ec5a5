"""Which stage tells which checks, and in which order they run."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from kinematify.simulation.engines import ENGINES
from kinematify.validation import engine_stage
from kinematify.validation.catalogue import agreement, task
from kinematify.validation.checks import CHECKS, checks_of
from kinematify.validation.isolation import Stage

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from kinematify.validation.catalogue import Check

DEFAULT_ENGINES = tuple(name for name, engine in ENGINES.items() if engine.extra is None)
"""Engines that every installation has; FCL and the exact geometry are always there."""

CheckKey = tuple[str, str | None]
"""Id of a check and the engine it runs in."""


def asset_stage() -> Stage:
    """Meshes and declared physics; what comes later needs readable meshes."""
    return Stage(name="asset", function="kinematify.validation.asset.stage:run", checks=keys(checks_of("KV15", "KV2")))


def later_stages(chosen: Sequence[str]) -> list[Stage]:
    """Everything that moves the model, the longest first; engines that were not chosen are left out."""
    stages = [
        Stage(name="prepare", function="kinematify.validation.prepare_stage:run", checks=()),
        Stage(
            name="geometry",
            function="kinematify.validation.geometry.stage:run",
            checks=keys(checks_of("KV30", "KV31", "KV32", "KV33")),
        ),
        Stage(name="evidence", function="kinematify.validation.evidence.stage:run", checks=keys(checks_of("KV34"))),
    ]
    for engine in chosen:
        checks = tuple(key for key in keys(tuple(CHECKS.values())) if key[1] == engine)
        function = partial(engine_stage.run, engine=engine)
        stages.append(Stage(name=engine, function=function, checks=checks, after=("prepare",)))
    return stages


def agreement_stage() -> Stage:
    """Compares what the engines left; it comes after all of them, whether they ended well or not."""
    checks = tuple(key for key in keys(agreement.CHECKS) if key[1] is None)
    return Stage(name="agreement", function="kinematify.validation.agreement:run", checks=checks)


def task_stage(seconds: float) -> Stage:
    """A robot uses the object; it comes after all others, since it wants to know which joints they doubt."""
    return Stage(
        name="task", function="kinematify.validation.task.stage:run", checks=keys(task.CHECKS), seconds=seconds
    )


def needed(stages: Sequence[Stage], selected: Collection[str]) -> list[Stage]:
    """Return the stages that tell a selected check, with those that they come after; the agreement needs all."""
    if any(check.id in selected for check in agreement.CHECKS):
        return list(stages)
    wanted = [stage for stage in stages if any(check in selected for check, _ in stage.checks)]
    names = {stage.name for stage in wanted} | {name for stage in wanted for name in stage.after}
    return [stage for stage in stages if stage.name in names]


def keys(checks: Sequence[Check]) -> tuple[CheckKey, ...]:
    """(id, engine) of every result that the checks give."""
    return tuple((check.id, engine) for check in checks for engine in (check.engines or (None,)))
