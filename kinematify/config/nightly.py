"""What a night runs and when it calls a change a regression; values with their reasons in `configs/nightly.yaml`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from kinematify.config import StageConfig, load_values, validated

if TYPE_CHECKING:
    from pathlib import Path


class GateSettings(StageConfig):
    """How much worse one run may be than the same run of the night that it is compared with."""

    angle_deg: float = Field(ge=0.0)
    """Mean axis angle [deg]."""
    line_m: float = Field(ge=0.0)
    """Mean distance of axis lines [m]."""
    ted: float = Field(ge=0.0)
    """Tree edit distance."""
    types: float = Field(ge=0.0)
    """Share of joints of the right type."""
    root: float = Field(ge=0.0)
    """1 where the root is right."""
    limit_iou: float = Field(ge=0.0)
    """Mean overlap of limits."""
    opens: float = Field(ge=0.0)
    """Share of joints that open in the positive direction."""
    as_loaded: float = Field(ge=0.0)
    """Share of joints that move in the untouched file, in the engine that moves the fewest."""
    opened: float = Field(ge=0.0)
    """Mean share of the ranges that an arm opens."""


class SmokeSettings(StageConfig):
    """A night small enough for a test suite."""

    sentences: list[str] = Field(min_length=1)
    """What the built-in generator makes."""
    conditions: list[str]
    """As in `NightlySettings`."""
    engines: list[str]
    """As in `NightlySettings`."""


class NightlySettings(StageConfig):
    """All of it."""

    name: str
    version: int
    """Part of every scenario."""
    data: str | None
    """As `kinematify.evaluation.datasets.find_objects` takes it."""
    infer_config: str
    """Name or path of the configuration of the inference."""
    validation_config: str
    """Name or path of the settings of the validation."""
    conditions: list[str] = Field(min_length=1)
    """Poses in which every object is inferred."""
    sources: list[Literal["truth", "inferred"]]
    """Models of every object that are validated."""
    pulled: list[str]
    """Names or patterns of objects whose published model an arm opens."""
    pull_budget: float = Field(gt=0.0)
    """Time budget of that [s]."""
    engines: list[Literal["mujoco", "pybullet", "pinocchio"]]
    """Engines of the validation."""
    checks: list[str] = Field(min_length=1)
    """Checks of the validation, ids or patterns; those of file and meshes always run."""
    timeout: float = Field(gt=0.0)
    """Wall time of one inference [s]."""
    validation_timeout: float = Field(gt=0.0)
    """Wall time of one validation with all around it [s]."""
    budget: float = Field(gt=0.0)
    """Time budget of one validation, and of each of its stages [s]."""
    gates: GateSettings
    problem_angle: float = Field(gt=0.0)
    """Axis angle from which a joint counts as wrong [deg]."""
    problem_line: float = Field(gt=0.0)
    """Distance of axis lines from which a joint counts as wrong, share of the object's diagonal."""
    problem_limits: float = Field(gt=0.0)
    """Overlap of limits below which they count as wrong."""
    gate_severities: list[Literal["error", "warning"]]
    """Severities of new findings that fail a night."""
    gate_newly_skipped: bool
    """Whether a check that ran before and does not any more fails a night."""
    slower: float = Field(gt=1.0)
    """Factor of time from which a run is reported as slower, or as faster."""
    slower_seconds: float = Field(ge=0.0)
    """Difference that it must have as well [s]."""
    shown_nights: int = Field(gt=0)
    """Nights in the trend pages, the latest."""
    smoke: SmokeSettings


def load_nightly(name_or_path: str | Path = "nightly", **overrides: Any) -> NightlySettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return validated(NightlySettings, {**load_values(name_or_path), **overrides}, name_or_path)
