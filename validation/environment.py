"""With what a report was made."""

from __future__ import annotations

import platform
from typing import TYPE_CHECKING, Any

from kinematify import __version__
from kinematify.versions import package_versions

if TYPE_CHECKING:
    from kinematify.config.validation import ValidationSettings

_PACKAGES = (
    "numpy", "scipy", "trimesh", "libigl", "python-fcl", "mujoco", "pybullet", "pin",
)  # fmt: skip


def environment(settings: ValidationSettings, *, seconds: float, interrupted: bool) -> dict[str, Any]:
    """Versions, machine, seed, settings and time of a run."""
    return {
        "kinematify": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "versions": package_versions(_PACKAGES),
        "seed": settings.seed,
        "seconds": round(seconds, 3),
        "interrupted": interrupted,
        "settings": settings.model_dump(),
    }
