"""Which stage tells which checks, and in which order they run."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from kinematify.simulation.engines import ENGINES
from kinematify.validation.checks import checks_of
from kinematify.validation.isolation import Stage
from kinematify.validation.stages import (
    asset,
    evidence_stage,
    geometry,
    loaded_file,
    task_run,
)

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence

    from kinematify.simulation.engines import EngineEntry
    from kinematify.validation.check import Check

CheckKey = tuple[str, str | None]
"""Id of a check and the engine it runs in."""


def asset_stage() -> Stage:
    """Meshes and declared physics; what comes later needs readable meshes."""
    imports = ("kinematify.validation.asset.rigid_bodies", "kinematify.validation.asset.mesh_look")
    return Stage(
        name="asset",
        run=asset.run,
        checks=keys(checks_of("KV15", "KV2")),
        imports=imports,
    )


def geometry_stage() -> Stage:
    """Exact geometry at rest and in motion."""
    return Stage(
        name="geometry",
        run=geometry.run,
        checks=keys(checks_of("KV30", "KV31", "KV32", "KV33")),
        imports=("kinematify.validation.geometry.look",),
    )


def stages_of(chosen: Sequence[str]) -> list[Stage]:
    """All stages of a run without a task, in some engines."""
    return [asset_stage(), geometry_stage(), *later_stages(chosen)]


def later_stages(chosen: Sequence[str]) -> list[Stage]:
    """What comes after the geometry, which tells how far every joint is free and which ones are in doubt.

    The evidence of the contacts, and the untouched file in each engine.
    """
    parts = ("bodies_at_rest", "case", "measure", "loop_pins")
    evidence = Stage(
        name="evidence",
        run=evidence_stage.run,
        checks=keys(checks_of("KV34", "KV35")),
        imports=tuple(f"kinematify.validation.evidence.{name}" for name in parts),
    )
    return [evidence] + [
        Stage(
            name=f"{name} as loaded",
            run=partial(loaded_file.run, engine=name),
            checks=tuple(key for key in keys(checks_of("KV8")) if key[1] == name),
            imports=("kinematify.validation.as_loaded_context",),
            library=_library(ENGINES[name]),
        )
        for name in chosen
        if any(name in check.engines for check in checks_of("KV8"))
    ]


def _library(engine: EngineEntry) -> str | None:
    """Return what can be loaded once for all stages of an engine; none that may be missing."""
    return None if engine.prints_when_loaded else engine.module


def task_stage() -> Stage:
    """A robot uses the object; it comes after all others, since it wants to know which joints they doubt."""
    return Stage(name="task", run=task_run.run, checks=keys(checks_of("KV7")))


def needed(stages: Sequence[Stage], selected: Collection[str]) -> list[Stage]:
    """Return the stages that tell a selected check."""
    return [stage for stage in stages if any(check in selected for check, _ in stage.checks)]


def keys(checks: Iterable[Check]) -> tuple[CheckKey, ...]:
    """(id, engine) of every result that the checks give."""
    return tuple((check.id, engine) for check in checks for engine in (check.engines or (None,)))
