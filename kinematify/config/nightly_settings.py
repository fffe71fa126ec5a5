"""Settings of a night: runs and thresholds of a regression."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from kinematify.config import StageConfig, load, section

if TYPE_CHECKING:
    from pathlib import Path


class GateSettings(StageConfig):
    """Thresholds of a regression: the largest loss of a run against the same run of the compared night that is none.

    The inference is deterministic, so that these values only cover other versions of numeric libraries.
    """

    angle_deg: float = Field(0.1, ge=0.0)
    """Mean axis angle [deg]."""
    line_m: float = Field(1.0e-4, ge=0.0)
    """Mean distance of axis lines [m]."""
    ted: float = Field(0.5, ge=0.0)  # whole numbers
    """Tree edit distance."""
    types: float = Field(0.001, ge=0.0)  # one wrong joint of 30 is 0.03
    """Share of joints of the right type."""
    root: float = Field(0.5, ge=0.0)
    """1 where the root is right."""
    limit_iou: float = Field(0.01, ge=0.0)  # the grid of a sweep moves a limit by less
    """Mean overlap of limits."""
    opens: float = Field(0.001, ge=0.0)
    """Share of joints that open in the positive direction."""
    as_loaded: float = Field(0.001, ge=0.0)
    """Share of joints that move in the untouched file, in the engine that moves the fewest."""
    opened: float = Field(0.05, ge=0.0)  # plans follow the seed, but numeric libraries may turn them
    """Mean share of the ranges that an arm opens."""


class SmokeSettings(StageConfig):
    """A night small enough for a test suite (`--smoke`): less than a minute."""

    sentences: list[str] = Field(["a cabinet with one door", "a cabinet with one drawer"], min_length=1)
    """What the built-in generator makes."""
    conditions: list[str] = Field(["rest"])
    """As in `NightlySettings`."""
    engines: list[str] = Field(["mujoco"])
    """As in `NightlySettings`."""


class NightlySettings(StageConfig):
    """All of it."""

    name: str = "nightly"
    """Of the settings; results state it."""
    version: int = 1  # raised by hand when a scenario changes in a way that no hash sees: starts new series
    """Part of every scenario."""
    data: str | None = None  # folder of URDFs with known joints; null: KINEMATIFY_BENCH, else ../shared/bench
    """As `kinematify.evaluation.datasets.find_objects` takes it."""
    # the inference as users have it; its values are the method's and no part of the scenario
    infer_config: str = "default"
    """Name or path of the configuration of the inference."""
    validation_config: str = "validation"
    """Name or path of the settings of the validation."""
    # those of the benchmark's protocol
    conditions: list[str] = Field(["rest", "random-0", "random-1", "random-2", "yaw37"], min_length=1)
    """Poses in which every object is inferred."""
    # the published models, and ours as inferred from their parts
    sources: list[Literal["truth", "inferred"]] = Field(["truth", "inferred"])
    """Models of every object that are validated."""
    # ten kinds of doors, drawers and lids that an arm opens
    pulled: list[str] = Field(
        [
            "cabinet_40147",
            "dishwasher_11700",
            "door_9128",
            "drawer_cabinet_20279",
            "fridge_11178",
            "laptop_10040",
            "microwave_7128",
            "oven_7138",
            "trash_can_102181",
            "washing_machine_103480",
        ]
    )
    """Names or patterns of objects whose published model an arm opens."""
    pull_budget: float = Field(120.0, gt=0.0)  # half a minute each on a free machine
    """Time budget of that [s]."""
    engines: list[str] = Field(["mujoco", "pybullet", "pinocchio"])
    """Engines of the validation, by name."""
    # all but those of an arm (KV7xx): opening all objects takes hours, those of `pulled` are opened
    checks: list[str] = Field(["KV*"], min_length=1)
    """Checks of the validation, ids or patterns; those of file and meshes always run."""
    timeout: float = Field(900.0, gt=0.0)  # the slowest object takes 40 s on a free machine
    """Wall time of one inference [s]."""
    validation_timeout: float = Field(900.0, gt=0.0)  # for a hang of the validator itself, beyond its own budget
    """Wall time of one validation with all around it [s]."""
    budget: float = Field(600.0, gt=0.0)  # the load of the machine must not decide which checks ran
    """Time budget of one validation, and of each of its stages [s]."""
    gates: GateSettings = section()
    problem_angle: float = Field(5.0, gt=0.0)  # S2O and others use the same
    """Axis angle from which a joint counts as wrong [deg]."""
    problem_line: float = Field(0.02, gt=0.0)
    """Distance of axis lines from which a joint counts as wrong, share of the object's diagonal."""
    problem_limits: float = Field(0.5, gt=0.0)  # they are upper bounds by nature
    """Overlap of limits below which they count as wrong."""
    gate_severities: list[Literal["error", "warning"]] = Field(
        ["error"]
    )  # new warnings are listed and do not fail the night
    """Severities of new findings that fail a night."""
    gate_newly_skipped: bool = True  # a check that no longer runs guards nothing
    """Whether a check that ran before and does not any more fails a night."""
    slower: float = Field(1.5, gt=1.0)  # timing is only reported
    """Factor of time from which a run is reported as slower, or as faster."""
    slower_seconds: float = Field(1.0, ge=0.0)  # shared machines vary by a third
    """Difference that it must have as well [s]."""
    shown_nights: int = Field(60, gt=0)  # two months in the list
    """Nights in the list of all, the latest."""
    smoke: SmokeSettings = section()


def load_nightly(name_or_path: str | Path = "nightly", **overrides: Any) -> NightlySettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return load(NightlySettings, name_or_path, **overrides)
