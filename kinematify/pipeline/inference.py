"""The answer of a run: parts, contacts, trees, joints and what the user should know."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from kinematify.model.build import build_model
from kinematify.pipeline.closed_chains import closed_chains

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.closed_chains import ClosedChain
    from kinematify.topology.tree import KinematicTree

DOUBTFUL = 0.5
"""Joints of less confidence are named as those to look at first."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Inference:
    """Everything that was inferred, with every alternative that was kept."""

    assembly: Assembly
    config: Config
    graph: ContactGraph
    bearings: Mapping[Pair, EdgeBearing]
    """Bearing lines of every contact edge, keyed (a, b) with a < b; empty where the method fits none."""
    trees: tuple[KinematicTree, ...]
    """Best first; `joints` belong to the first."""
    joints: tuple[JointEstimate, ...]
    """One per edge of `trees[0]`, in the order of `trees[0].edges()`."""
    timings: Mapping[str, float]
    """Wall time of every stage [s]."""
    peak_mb: float
    """Peak resident memory of the process so far [MB]."""
    warnings: tuple[str, ...] = field(default=())
    """What the user should know, one sentence each; those of the assembly included."""
    refinement: Mapping[str, Any] | None = None
    """Rounds of simulation and choosing again (`kinematify.refine`), as JSON values; None where there were none."""
    hints: tuple[str, ...] = ()
    """What the user said of joints, as it is typed behind ``--hint``; in force already."""
    provenance: Mapping[str, Any] | None = None
    """Who made the parts, from what (`kinematify.generate.providers`), as JSON values; None where that is not known."""

    @property
    def doubtful(self) -> tuple[str, ...]:
        """Parts whose joint is to be looked at, since its confidence is below `DOUBTFUL`; the least sure first."""
        below = sorted((joint.confidence, joint.child) for joint in self.joints if joint.confidence < DOUBTFUL)
        return tuple(self.assembly.names[child] for _, child in below)

    @cached_property
    def closed_chains(self) -> tuple[ClosedChain, ...]:
        """Pins that the tree had to leave out; they come apart when its joints move."""
        found = closed_chains(self.assembly, self.bearings, self.trees, self.model.robot, self.config.topology)
        return tuple(found)

    @cached_property
    def model(self) -> KinematicModel:
        """The kinematic model of the best tree."""
        return build_model(
            self.assembly, self.trees[0], self.joints, name=_model_name(self.assembly.source), config=self.config.model
        )


def _model_name(source: str) -> str:
    stem = source.replace("\\", "/").rstrip("/").rsplit("/", 1)[-1].split(".")[0]
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in stem) or "model"
