"""Thresholds of the checks: one class per family, values with their reasons in `configs/validation.yaml`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinematify.config import StageConfig, load_values, validated

if TYPE_CHECKING:
    from pathlib import Path


class BudgetSettings(StageConfig):
    """Time and memory."""

    seconds: float
    """Wall time of a whole run [s]; checks that are left over are reported as skipped."""
    stage_seconds: float
    """Wall time of one isolated stage [s]; a stage that takes longer hangs."""
    stage_bytes: int
    """Address space of one isolated stage [bytes]."""


class FileSettings(StageConfig):
    """KV1xx: the file, the tree and the meshes."""


class PhysicsSettings(StageConfig):
    """KV2xx: declared physics."""


class PrepareSettings(StageConfig):
    """The file that engines are given: decomposition of concave collision meshes."""


class GeometrySettings(StageConfig):
    """KV30x to KV33x: collision along the motion."""


class EvidenceSettings(StageConfig):
    """KV34x to KV36x: agreement of the declared joint with the contact geometry."""


class EngineSettings(StageConfig):
    """KV4xx and KV5xx: behaviour in engines."""


class AgreementSettings(StageConfig):
    """KV6xx: agreement of engines."""

    random_rows: int
    """Quasi-random configurations beside zero, rest and the ends of every joint."""
    end_rows: int
    """Configurations at most for the ends of the joints; joints share them where there are more."""
    dynamic_rows: int
    """Configurations with mass matrix and gravity torques."""
    dynamic_numbers: int
    """Entries of all mass matrices together at most; large models have fewer configurations."""


class ValidationSettings(StageConfig):
    """All families."""

    name: str
    seed: int
    budget: BudgetSettings
    file: FileSettings
    physics: PhysicsSettings
    prepare: PrepareSettings
    geometry: GeometrySettings
    evidence: EvidenceSettings
    engines: EngineSettings
    agreement: AgreementSettings


def load_settings(name_or_path: str | Path = "validation", **overrides: Any) -> ValidationSettings:
    """Load a shipped file of settings by name, or any YAML file by path; see `kinematify.config.load_config`.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value does not fit.
    """
    return validated(ValidationSettings, {**load_values(name_or_path), **overrides}, name_or_path)
