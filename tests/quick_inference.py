"""Stand-ins for `kinematify.pipeline.infer_assembly` that tests of the benchmark name by ``quick_inference:...``.

They answer at once, so that what is tested is the runner: its workers, its ledger and what it shows to an inference.
"""

from __future__ import annotations

import os
import signal
import time
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from kinematify.contact.tree import KinematicTree
from kinematify.joints.candidate import JointEstimate
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from kinematify.assembly.part import Assembly
    from kinematify.config import Config


def star(assembly: Assembly, *, config: Config) -> SimpleNamespace:
    """Hang every part on the largest one by a vertical hinge through its centroid."""
    volumes = [float((part.bounds[1] - part.bounds[0]).prod()) for part in assembly.parts]
    root = volumes.index(max(volumes))
    tree = KinematicTree(parents=tuple(-1 if node == root else root for node in range(len(volumes))))
    joints = tuple(
        JointEstimate(
            parent=parent,
            child=child,
            kind=JointType.REVOLUTE,
            axis=[0.0, 0.0, 1.0],
            pivot=assembly.parts[child].centroid,
            lower=0.0,
            upper=1.0,
            confidence=0.5,
        )
        for parent, child in tree.edges()
    )
    return SimpleNamespace(assembly=assembly, trees=(tree,), joints=joints, timings={"star": 0.0})


def slow_star(assembly: Assembly, *, config: Config) -> SimpleNamespace:
    time.sleep(0.3)
    return star(assembly, config=config)


def endless(assembly: Assembly, *, config: Config) -> SimpleNamespace:
    time.sleep(600.0)
    return star(assembly, config=config)


def crashing_on_three_parts(assembly: Assembly, *, config: Config) -> SimpleNamespace:
    if len(assembly.parts) == 3:
        os.kill(os.getpid(), signal.SIGSEGV)
    return star(assembly, config=config)


def telling_what_it_sees(assembly: Assembly, **given: Any) -> None:
    """Answer with an error that holds everything which the inference was given."""
    raise ValueError(
        f"SEEN names={assembly.names} source={assembly.source} original={dict(assembly.original_names)} "
        f"warnings={assembly.warnings} attributes={sorted(vars(assembly))} given={sorted(given)}"
    )
