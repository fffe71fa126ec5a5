"""The answer of a run: parts, contacts, trees, joints and what the user should know."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from kinematify.contact.graph import pair
from kinematify.model.build import build_model
from kinematify.pipeline.linkages import Closing, SharedAxis, close_chains
from kinematify.robot.lengths import length_text
from kinematify.robot.mechanism import joints_between, widest_opening

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config, TopologyConfig
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.contact.tree import KinematicTree
    from kinematify.geometry.sweep import JointSweep
    from kinematify.grouping.groups import Grouping
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from kinematify.joints.candidate import JointEstimate
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.mechanism import LoopOpening
    from kinematify.robot.robot import Robot


@dataclass(frozen=True, kw_only=True, eq=False)
class CutChain:
    """Two parts that turn on one pin, and that hang together by other joints, too."""

    parts: tuple[str, str]
    line: BearingLine
    """Of the pin, world frame."""
    joints: tuple[str, ...]
    """The others of the chain, from one part to the other."""
    opening: LoopOpening
    """What happens to the pin when a joint moves alone."""
    closing: Closing = field(default_factory=Closing)
    """What was written for it."""

    @property
    def description(self) -> str:
        """Where the chain closes, how that is written, and what to do, in words."""
        first, second = self.parts
        return (
            f"{first} and {second} share a pin, and a chain closes there ({', '.join(self.joints)}). A URDF is a tree, "
            f"so it has no joint between them. {self._closed}"
        )

    @property
    def _closed(self) -> str:
        closing, opens = self.closing, length_text(self.opening.distance)
        if closing.loop is None:
            return (
                "Closed there, its joints could not move, so no loop joint was written: "
                f"moving {self.opening.joint} alone pulls it apart by {opens}. One of these joints may be wrong."
            )
        if closing.driver is None:
            return f"The loop joint {closing.loop} closes it."
        how = "by <mimic>, which is exact here" if closing.by == "mimic" else "as the loop joint makes them"
        return f"The loop joint {closing.loop} closes it: {closing.driver} drives it, and the others follow {how}."


def closed_chains(
    assembly: Assembly,
    bearings: Mapping[Pair, EdgeBearing],
    tree: KinematicTree,
    robot: Robot,
    config: TopologyConfig,
) -> Iterator[CutChain]:
    """Find the pins that a tree leaves out and that its motion pulls apart.

    Args:
        assembly: The parts.
        bearings: Of their contacts.
        tree: The chosen one.
        robot: What the tree became; a link is named as its part.
        config: `pin_score` and `pin_opens`.
    """
    names = assembly.names
    allowed = config.pin_opens * assembly.diagonal
    used = {pair(parent, child) for parent, child in tree.edges()}
    for ends, bearing in bearings.items():
        if ends in used or not bearing.lines or bearing.lines[0].score < config.pin_score:
            continue
        line, parts = bearing.lines[0], (names[ends[0]], names[ends[1]])
        opening = widest_opening(robot, parts, line.pivot)
        if opening is not None and opening.distance > allowed:
            yield CutChain(
                parts=parts,
                line=line,
                joints=joints_between(robot, parts),
                opening=opening,
            )


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
    vision: Mapping[str, Any] | None = None
    """Answers of a vision-language model about joints (`kinematify.vision`), as JSON values; None if none was asked."""
    grouping: Grouping | None = None
    """How pieces became the parts; None where the parts were given."""
    report: Any = None
    """What `kinematify.validate` said of the folder that was written, or the error that kept it from an answer."""
    provenance: Mapping[str, Any] | None = None
    """Who made the parts, from what (`kinematify.generate.providers`), as JSON values; None where that is not known."""

    @cached_property
    def swept(self) -> dict[str, JointSweep]:
        """Motions of its joints that were simulated; a copy with other joints has to be simulated again."""
        return {}

    @property
    def doubtful(self) -> tuple[str, ...]:
        """Parts whose joint is to be looked at, since its confidence is below `DOUBTFUL`; the least sure first."""
        below = sorted((joint.confidence, joint.child) for joint in self.joints if joint.confidence < DOUBTFUL)
        return tuple(self.assembly.names[child] for _, child in below)

    @property
    def closed_chains(self) -> tuple[CutChain, ...]:
        """Pins that the tree had to leave out, and that its motion would pull apart."""
        return self._closed[1]

    @property
    def model(self) -> KinematicModel:
        """The kinematic model of the best tree, with loop joints where its chains close."""
        return self._closed[0]

    @cached_property
    def _closed(self) -> tuple[KinematicModel, tuple[CutChain, ...]]:
        name = _model_name(self.assembly.source)
        tree = build_model(self.assembly, self.trees[0], self.joints, name=name, config=self.config.model)
        found = closed_chains(self.assembly, self.bearings, self.trees[0], tree.robot, self.config.topology)
        chains = sorted(found, key=lambda chain: -chain.line.score)
        if not chains:
            return tree, ()
        pins = [SharedAxis(links=chain.parts, axis=chain.line.axis, pivot=chain.line.pivot) for chain in chains]
        kind = dict(zip(self.assembly.names, self.graph.alike.kind.tolist(), strict=True))
        model, closings = close_chains(tree, pins, kind, self.assembly.diagonal)
        closed = (replace(chain, closing=closing) for chain, closing in zip(chains, closings, strict=True))
        return model, tuple(closed)


def _model_name(source: str) -> str:
    stem = source.replace("\\", "/").rstrip("/").rsplit("/", 1)[-1].split(".")[0]
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in stem) or "model"
