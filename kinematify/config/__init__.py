"""Typed configuration: one class per stage, values in `configs/*.yaml` where each has its reason.

Lengths are fractions of the assembly's diagonal unless a field says otherwise, so that nothing depends on units.
A YAML file may name another one with `extends:` and then states only what differs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinematify.config.base import CONFIG_FOLDER, StageConfig, load_values, validated
from kinematify.config.bearings import BearingConfig, RailConfig
from kinematify.config.cavl import CavlConfig
from kinematify.config.joints import (
    ClearanceConfig,
    CompoundConfig,
    ConfidenceConfig,
    FramesConfig,
    FrontCuesConfig,
    GateConfig,
    JointsConfig,
    JournalConfig,
    KindConfig,
    LimitsConfig,
    PanelsConfig,
    RailsConfig,
    RockersConfig,
    SlidesConfig,
    SweepConfig,
)
from kinematify.config.output import CollisionConfig, DynamicsConfig, ModelConfig, PreviewConfig
from kinematify.config.refinement import FeedbackConfig, RefineConfig
from kinematify.config.services import ServiceConfig, VisionConfig
from kinematify.config.shapes import (
    AssemblyConfig,
    ContactConfig,
    NeuralSdfConfig,
    SdfConfig,
    SeamConfig,
    SurfaceConfig,
)
from kinematify.config.sources import RodinConfig, SourcesConfig
from kinematify.config.trees import BaseConfig, RewardWeights, TopologyConfig

if TYPE_CHECKING:
    from pathlib import Path

__all__ = [
    "CONFIG_FOLDER",
    "AssemblyConfig",
    "BaseConfig",
    "BearingConfig",
    "CavlConfig",
    "ClearanceConfig",
    "CollisionConfig",
    "CompoundConfig",
    "ConfidenceConfig",
    "Config",
    "ContactConfig",
    "DynamicsConfig",
    "FeedbackConfig",
    "FramesConfig",
    "FrontCuesConfig",
    "GateConfig",
    "JointsConfig",
    "JournalConfig",
    "KindConfig",
    "LimitsConfig",
    "ModelConfig",
    "NeuralSdfConfig",
    "PanelsConfig",
    "PreviewConfig",
    "RailConfig",
    "RailsConfig",
    "RefineConfig",
    "RewardWeights",
    "RockersConfig",
    "RodinConfig",
    "SdfConfig",
    "SeamConfig",
    "ServiceConfig",
    "SlidesConfig",
    "SourcesConfig",
    "StageConfig",
    "SurfaceConfig",
    "SweepConfig",
    "TopologyConfig",
    "VisionConfig",
    "load_config",
    "load_values",
    "validated",
]


class Config(StageConfig):
    """All stages."""

    name: str
    seed: int
    assembly: AssemblyConfig
    surface: SurfaceConfig
    contact: ContactConfig
    seam: SeamConfig
    bearing: BearingConfig
    model: ModelConfig
    collision: CollisionConfig
    dynamics: DynamicsConfig
    preview: PreviewConfig
    joints: JointsConfig
    topology: TopologyConfig
    sdf: SdfConfig
    cavl: CavlConfig
    refine: RefineConfig
    sources: SourcesConfig
    vision: VisionConfig


def load_config(name_or_path: str | Path = "default", **overrides: Any) -> Config:
    """Load a shipped configuration by name (``default``, ``fast``, ``paper``) or any YAML file by path.

    Args:
        name_or_path: Name of a file in `kinematify/configs` without suffix, or a path.
        overrides: Top-level values that replace those of the file, e.g. ``seed=7``.

    Raises:
        ConfigError: The name is unknown, the YAML is malformed, or a value has the wrong type.
    """
    return validated(Config, {**load_values(name_or_path), **overrides}, name_or_path)
