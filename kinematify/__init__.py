"""Kinematify: a shape goes in, a mechanism that works in simulation comes out.

From the meshes of an object to a model, and from a model to a verdict:

    parts = kinematify.load_assembly("examples/cabinet")     # a folder, GLB, OBJ, ZIP ...: one mesh per rigid part
    inference = kinematify.infer(parts)                      # the tree and the joints, with all alternatives
    kinematify.write_inference(inference, "out/example")     # model.urdf, meshes, inference.json, preview.png
    report = kinematify.validate("out/example/model.urdf")   # MuJoCo, PyBullet, Pinocchio, FCL: verdict and findings
    kinematify.refine(inference)                             # simulate, use what failed, choose again
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
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinematify.assembly.load import load_assembly
    from kinematify.assembly.part import Assembly, Part
    from kinematify.batch import batch
    from kinematify.config import load_config
    from kinematify.contact.graph import ContactGraph
    from kinematify.contact.tree import KinematicTree
    from kinematify.errors import KinematifyError
    from kinematify.evaluation.nightly.run_night import nightly
    from kinematify.evaluation.run_benchmark import bench
    from kinematify.formats.export_model import export
    from kinematify.generate import generate
    from kinematify.joints.candidate import JointCandidate
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.inference import Inference
    from kinematify.pipeline.record import write_inference
    from kinematify.refinement.loop import Refinement, refine
    from kinematify.refinement.repair import fix
    from kinematify.validation.finding import Finding
    from kinematify.validation.run import validate
    from kinematify.validation.run.report import ValidationReport
    from kinematify.view.loaded import LoadedModel, load
    from kinematify.vision.infer_object import infer

__version__ = "0.2.0"

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
    "write_inference",
]

_HOMES = {
    "Assembly": "kinematify.assembly.part",
    "ContactGraph": "kinematify.contact.graph",
    "Finding": "kinematify.validation.finding",
    "Inference": "kinematify.pipeline.inference",
    "JointCandidate": "kinematify.joints.candidate",
    "KinematicModel": "kinematify.model.kinematic_model",
    "KinematicTree": "kinematify.contact.tree",
    "KinematifyError": "kinematify.errors",
    "LoadedModel": "kinematify.view.loaded",
    "Part": "kinematify.assembly.part",
    "Refinement": "kinematify.refinement",
    "ValidationReport": "kinematify.validation.run.report",
    "batch": "kinematify.batch",
    "bench": "kinematify.evaluation.run_benchmark",
    "export": "kinematify.formats.export_model",
    "fix": "kinematify.refinement.repair",
    "generate": "kinematify.generate",
    "infer": "kinematify.vision.infer_object",
    "load": "kinematify.view.loaded",
    "load_assembly": "kinematify.assembly.load",
    "load_config": "kinematify.config",
    "nightly": "kinematify.evaluation.nightly.run_night",
    "refine": "kinematify.refinement",
    "validate": "kinematify.validation.run",
    "write_inference": "kinematify.pipeline.record",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
