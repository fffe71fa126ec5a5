"""Chains of joints that close: which joint was cut, since a URDF is a tree, and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.contact.graph import pair
from kinematify.robot.closed_chain import joints_between, widest_opening
from kinematify.robot.lengths import length_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import TopologyConfig
    from kinematify.contact.graph import Pair
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from kinematify.robot.closed_chain import Opening
    from kinematify.robot.robot import Robot
    from kinematify.topology.tree import KinematicTree


@dataclass(frozen=True, kw_only=True, eq=False)
class ClosedChain:
    """Two parts that turn on one pin, and that hang together by other joints, too."""

    parts: tuple[str, str]
    line: BearingLine
    """Of the pin, world frame."""
    joints: tuple[str, ...]
    """The others of the chain, from one part to the other."""
    opening: Opening
    """What happens to the pin when a joint moves alone."""
    reward: float
    """Of the tree that was taken."""
    rival: float | None
    """Of the best tree that keeps the joint instead; None where none was kept."""

    @property
    def told(self) -> str:
        """Which joint was cut, why, and what to do, in words."""
        first, second = self.parts
        kept = "no tree that was kept has it"
        if self.rival is not None:
            kept = f"the best one that has it is worth no more ({self.rival:.3f})"
        return (
            f"{first} and {second} share a pin, and a chain closes there ({', '.join(self.joints)}). A URDF is a tree, "
            f"so the joint between them was cut: of all trees this one is worth most ({self.reward:.3f}), {kept}. "
            f"Moving {self.opening.joint} alone pulls it apart by {length_text(self.opening.distance)}. Close it in "
            "the engine (<equality><connect> in MuJoCo, createConstraint in PyBullet), or let joints follow (<mimic>)."
        )


def closed_chains(
    assembly: Assembly,
    bearings: Mapping[Pair, EdgeBearing],
    trees: Sequence[KinematicTree],
    robot: Robot,
    config: TopologyConfig,
) -> Iterator[ClosedChain]:
    """Find the pins that the best tree leaves out and that its motion pulls apart.

    Args:
        assembly: The parts.
        bearings: Of their contacts.
        trees: Best first.
        robot: What the best tree became; a link is named as its part.
        config: `pin_score` and `pin_opens`.
    """
    best, names = trees[0], assembly.names
    allowed = config.pin_opens * assembly.diagonal
    used = {pair(parent, child) for parent, child in best.edges()}
    for ends, bearing in bearings.items():
        if ends in used or not bearing.lines or bearing.lines[0].score < config.pin_score:
            continue
        line, parts = bearing.lines[0], (names[ends[0]], names[ends[1]])
        opening = widest_opening(robot, parts, line.pivot)
        if opening is not None and opening.distance > allowed:
            rivals = [tree.reward for tree in trees if ends in {pair(*edge) for edge in tree.edges()}]
            yield ClosedChain(
                parts=parts,
                line=line,
                joints=joints_between(robot, parts),
                opening=opening,
                reward=best.reward,
                rival=max(rivals, default=None),
            )
