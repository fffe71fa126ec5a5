"""Typed configuration: one class per stage, with every value, its reason beside it, and its meaning below.

Lengths are fractions of the assembly's diagonal unless a field says otherwise, so that nothing depends on units.
A YAML file states only what differs, from these values or from those of the file that it names with `extends:`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinematify.config.base import CONFIG_FOLDER, StageConfig, load, section
from kinematify.config.bearing_settings import BearingConfig, RailConfig
from kinematify.config.cavl_settings import CavlConfig
from kinematify.config.joint_settings import (
    ConfidenceConfig,
    FramesConfig,
    FrontCuesConfig,
    JointsConfig,
    JournalConfig,
    LimitsConfig,
    RailsConfig,
    SweepConfig,
)
from kinematify.config.output_settings import CollisionConfig, ModelConfig, PreviewConfig
from kinematify.config.services import ServiceConfig, SourcesConfig, VisionConfig
from kinematify.config.shapes import (
    AssemblyConfig,
    ContactConfig,
    GroupingConfig,
    NeuralSdfConfig,
    SdfConfig,
    SeamConfig,
    SurfaceConfig,
)
from kinematify.config.tree_settings import TopologyConfig
from kinematify.errors import ConfigError
from kinematify.versions import is_installed, not_installed

if TYPE_CHECKING:
    from pathlib import Path

__all__ = [
    "CONFIG_FOLDER",
    "AssemblyConfig",
    "BearingConfig",
    "CavlConfig",
    "CollisionConfig",
    "ConfidenceConfig",
    "Config",
    "ContactConfig",
    "FramesConfig",
    "FrontCuesConfig",
    "GroupingConfig",
    "JointsConfig",
    "JournalConfig",
    "LimitsConfig",
    "ModelConfig",
    "NeuralSdfConfig",
    "PreviewConfig",
    "RailConfig",
    "RailsConfig",
    "SdfConfig",
    "SeamConfig",
    "ServiceConfig",
    "StageConfig",
    "SurfaceConfig",
    "SweepConfig",
    "TopologyConfig",
    "VisionConfig",
    "load",
    "load_config",
    "section",
]


class Config(StageConfig):
    """All stages."""

    name: str = "default"
    """Of the configuration; models and reports state it."""
    seed: int = 0
    """Of whatever is sampled."""
    assembly: AssemblyConfig = section()
    surface: SurfaceConfig = section()
    contact: ContactConfig = section()
    grouping: GroupingConfig = section()
    seam: SeamConfig = section()
    bearing: BearingConfig = section()
    model: ModelConfig = section()
    collision: CollisionConfig = section()
    preview: PreviewConfig = section()
    joints: JointsConfig = section()
    topology: TopologyConfig = section()
    sdf: SdfConfig = section()
    cavl: CavlConfig = section()
    sources: SourcesConfig = section()
    vision: VisionConfig = section()


def load_config(given: str | Path | Config = "default", **overrides: Any) -> Config:
    """Load a shipped configuration by name (``default``, ``paper``) or any YAML file by path.

    Args:
        given: ``default``, for the values of the classes; name of a file in `kinematify/configs`; a path; or a
            configuration.
        overrides: Top-level values that replace those of the file, e.g. ``seed=7``; None replaces nothing.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, a value has the wrong type, or torch is not installed
            and the method of the paper needs it.
    """
    config = load(Config, given, **overrides)
    if config.joints.method == "cavl" and not is_installed("torch"):
        raise ConfigError(not_installed(f"The configuration {config.name}", "torch"))
    return config
