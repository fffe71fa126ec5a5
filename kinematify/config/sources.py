"""Generators of parts that are not ours."""

from __future__ import annotations

from kinematify.config.base import StageConfig
from kinematify.config.services import ServiceConfig


class RodinConfig(ServiceConfig):
    """Hyper3D Rodin and its splitting into parts (BANG), the generator of the paper (section III-A)."""

    url: str
    """Beginning of every address; the variable RODIN_API_URL wins."""
    tier: str
    """Model that makes the shape."""
    mesh_mode: str
    """``Raw`` triangles or ``Quad``."""
    material: str
    """``PBR``, ``Shaded``, ``All`` or ``None``."""
    strength: int
    """How finely the shape is split, 2 to 12."""
    shape_credits: float
    """What a shape is expected to cost."""
    parts_credits: float
    """What the splitting is expected to cost."""
    job_seconds: float
    """A job has so long to be done [s]."""


class LanguageModelConfig(ServiceConfig):
    """A language model that writes blueprints."""

    model: str
    """Name of the model at the service; the variable KINEMATIFY_LLM_MODEL wins."""
    rounds: int
    """Answers at most: the first one, and those that mend it."""
    answer_tokens: int
    """Of one answer at most."""


class SourcesConfig(StageConfig):
    """Where parts come from."""

    rodin: RodinConfig
    language_model: LanguageModelConfig
    command_seconds: float
    """A program of the user's has so long [s]."""
