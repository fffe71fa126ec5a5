"""Settings of a night: objects, poses, models, engines and checks. Thresholds are in `evaluation/nightly/runs.py`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from kinematify.config import StageConfig, load

if TYPE_CHECKING:
    from pathlib import Path


class NightlySettings(StageConfig):
    """All of it."""

    name: str = "nightly"
    """Of the settings; results state it."""
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
    engines: list[str] = Field(["mujoco", "pybullet", "pinocchio"])
    """Engines of the validation, by name."""
    # all but those of an arm (KV7xx): opening all objects takes hours, those of `pulled` are opened
    checks: list[str] = Field(["KV*"], min_length=1)
    """Checks of the validation, ids or patterns; those of file and meshes always run."""
    timeout: float = Field(900.0, gt=0.0)  # the slowest object takes 40 s on a free machine
    """Wall time of one inference, and of one validation with all around it [s]."""
    budget: float = Field(600.0, gt=0.0)  # the load of the machine must not decide which checks ran
    """Time budget of one validation, and of each of its stages [s]."""


def load_nightly(given: str | Path | NightlySettings = "nightly", **overrides: Any) -> NightlySettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return load(NightlySettings, given, **overrides)
