"""Kinematify: a shape goes in, a mechanism that works in simulation comes out.

The public names below load on first use, so that `import kinematify` loads no engine and no torch.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinematify.assembly.load import load_assembly
    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import load_config
    from kinematify.contact.graph import ContactGraph
    from kinematify.contact.tree import KinematicTree
    from kinematify.errors import KinematifyError
    from kinematify.formats.export import export
    from kinematify.joints.candidate import JointCandidate
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.infer import infer
    from kinematify.pipeline.inference import Inference
    from kinematify.pipeline.record import write_inference
    from kinematify.refinement.loop import Refinement, refine
    from kinematify.validation.finding import Finding
    from kinematify.validation.run import validate
    from kinematify.validation.run.report import ValidationReport
    from kinematify.view.loaded import LoadedModel, load

__version__ = "0.1.0"

__all__ = [
    "Assembly",
    "ContactGraph",
    "Finding",
    "Inference",
    "JointCandidate",
    "KinematicModel",
    "KinematicTree",
    "KinematifyError",
    "LoadedModel",
    "Part",
    "Refinement",
    "ValidationReport",
    "__version__",
    "export",
    "infer",
    "load",
    "load_assembly",
    "load_config",
    "refine",
    "validate",
    "write_inference",
]

_HOMES = {
    "Assembly": "kinematify.assembly.part",
    "ContactGraph": "kinematify.contact.graph",
    "Finding": "kinematify.validation.finding",
    "Inference": "kinematify.pipeline",
    "JointCandidate": "kinematify.joints.candidate",
    "KinematicModel": "kinematify.model.kinematic_model",
    "KinematicTree": "kinematify.contact.tree",
    "KinematifyError": "kinematify.errors",
    "LoadedModel": "kinematify.view.loaded",
    "Part": "kinematify.assembly.part",
    "Refinement": "kinematify.refinement",
    "ValidationReport": "kinematify.validation.run.report",
    "export": "kinematify.formats.export",
    "infer": "kinematify.pipeline",
    "load": "kinematify.view.loaded",
    "load_assembly": "kinematify.assembly.load",
    "load_config": "kinematify.config",
    "refine": "kinematify.refinement",
    "validate": "kinematify.validation.run",
    "write_inference": "kinematify.pipeline",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
