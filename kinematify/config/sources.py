"""Generators of parts that are not ours."""

from __future__ import annotations

from kinematify.config.base import StageConfig


class RodinConfig(StageConfig):
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
    first_pause: float
    """Before a request is repeated for the first time, and between looks at a job at first [s]."""
    longest_pause: float
    """Pauses double up to this [s]."""
    tries: int
    """Attempts of a request before the network or the service counts as down."""
    answer_seconds: float
    """The service has so long to answer a request [s]."""
    job_seconds: float
    """A job has so long to be done [s]."""
    most_bytes: int
    """Larger files are not fetched [bytes]."""


class SourcesConfig(StageConfig):
    """Where parts come from."""

    rodin: RodinConfig
    command_seconds: float
    """A program of the user's has so long [s]."""
