"""Kinematify: a shape goes in, a mechanism that works in simulation comes out.

From the meshes of an object to a model, and from a model to a verdict:

    parts = kinematify.load_assembly("examples/cabinet")     # a folder, GLB, OBJ, ZIP ...: one mesh per rigid part
    inference = kinematify.infer(parts, "out/example")       # model.urdf, meshes, all alternatives of every joint
    report = kinematify.validate("out/example/model.urdf")   # MuJoCo, PyBullet, Pinocchio, FCL: verdict and findings
    kinematify.refine("out/example", "out/refined")          # simulate, use what failed, choose again
    kinematify.fix("robot.urdf", "fixed.urdf")               # what validate finds, repaired where that is certain
    kinematify.export("out/example/model.urdf", "mjcf", "out/example.xml")
    kinematify.generate("a cabinet with two doors", "out/cabinet")

A model of a file, with its poses, meshes and a viewer:

    robot = kinematify.load("out/example")
    robot.joints, robot.pose({"drawer_left": 0.2}), robot.show()

`kinematify.load_config("default")` returns all settings; every error derives from `kinematify.KinematifyError`.
Gymnasium environments are in `kinematify.envs`. The names below load on first use, so that `import kinematify` loads no
engine and no torch.
"""

from __future__ import annotations

import importlib
import inspect
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinematify.assembly.load import load_assembly
    from kinematify.assembly.part import Assembly, Part
    from kinematify.batch.run_batch import batch
    from kinematify.config import load_config
    from kinematify.contact.graph import ContactGraph
    from kinematify.contact.tree import KinematicTree
    from kinematify.creation.generate_model import generate
    from kinematify.creation.generated_model import GeneratedModel
    from kinematify.errors import KinematifyError
    from kinematify.evaluation.accuracy import bench
    from kinematify.evaluation.nightly.run_night import nightly
    from kinematify.formats.export_model import export
    from kinematify.joints.candidate import JointCandidate
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference
    from kinematify.pipeline.record import write_inference
    from kinematify.refinement.loop import Refinement, refine
    from kinematify.refinement.repair import fix
    from kinematify.validation.finding import Finding
    from kinematify.validation.formats.report_files import write_reports
    from kinematify.validation.run.model_validation import validate
    from kinematify.validation.run.report import ValidationReport
    from kinematify.view.loaded import LoadedModel, load
    from kinematify.view.show_model import view
    from kinematify.vision.infer_object import infer

__version__ = "0.2.0"

__all__ = [
    "Assembly",
    "ContactGraph",
    "Finding",
    "GeneratedModel",
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
    "batch",
    "bench",
    "export",
    "fix",
    "generate",
    "infer",
    "load",
    "load_assembly",
    "load_config",
    "nightly",
    "refine",
    "validate",
    "view",
    "write_inference",
    "write_reports",
]

_HOMES = {
    "Assembly": "kinematify.assembly.part",
    "ContactGraph": "kinematify.contact.graph",
    "Finding": "kinematify.validation.finding",
    "GeneratedModel": "kinematify.creation.generated_model",
    "Inference": "kinematify.pipeline.inference",
    "JointCandidate": "kinematify.joints.candidate",
    "KinematicModel": "kinematify.model.kinematic_model",
    "KinematicTree": "kinematify.contact.tree",
    "KinematifyError": "kinematify.errors",
    "LoadedModel": "kinematify.view.loaded",
    "Part": "kinematify.assembly.part",
    "Refinement": "kinematify.refinement.loop",
    "ValidationReport": "kinematify.validation.run.report",
    "batch": "kinematify.batch.run_batch",
    "bench": "kinematify.evaluation.accuracy",
    "export": "kinematify.formats.export_model",
    "fix": "kinematify.refinement.repair",
    "generate": "kinematify.creation.generate_model",
    "infer": "kinematify.vision.infer_object",
    "load": "kinematify.view.loaded",
    "load_assembly": "kinematify.assembly.load",
    "load_config": "kinematify.config",
    "nightly": "kinematify.evaluation.nightly.run_night",
    "refine": "kinematify.refinement.loop",
    "validate": "kinematify.validation.run.model_validation",
    "view": "kinematify.view.show_model",
    "write_inference": "kinematify.pipeline.record",
    "write_reports": "kinematify.validation.formats.report_files",
}
_PACKAGES = ("batch", "generate", "view")
"""Public names that are packages, too."""


class _Function(ModuleType):
    """A package that is called as its function: `kinematify.batch` is both."""

    @property
    def __signature__(self) -> inspect.Signature:
        """That of the function, for `help` and `inspect`."""
        return inspect.signature(_loaded(self.__name__.rpartition(".")[2]))

    def __call__(self, *values: Any, **options: Any) -> Any:
        """Call the function."""
        return _loaded(self.__name__.rpartition(".")[2])(*values, **options)


class _Kinematify(ModuleType):
    """This module; Python sets a package in it when something of that is imported."""

    def __setattr__(self, name: str, value: Any) -> None:
        """Set a name; a package that is a public function becomes callable."""
        if name in _PACKAGES:
            value.__class__ = _Function
        super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Kinematify


def _loaded(name: str) -> Any:
    return getattr(importlib.import_module(_HOMES[name]), name)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name in _PACKAGES:
        return importlib.import_module(f"{__name__}.{name}")
    value = globals()[name] = _loaded(name)
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
