"""Pins that two bodies share though no joint joins them: there a linkage closes, which a tree of joints cannot say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from kinematify.robot.mechanism import widest_opening

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.joints.bearings.scores import BearingLine
    from kinematify.robot.robot import Robot
    from kinematify.validation.evidence.bodies_at_rest import Bodies


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedPin:
    """Two bodies that are round about one line where they touch, and come apart there."""

    links: tuple[str, str]
    line: BearingLine
    """World frame at rest."""
    joint: str
    """Leader that opens it most when it moves alone."""
    value: float
    """Where that leader stands then [rad or m]."""
    opens: float
    """How far the two ends of the pin are apart there [m]."""
    allowed: float
    """[m]"""


def shared_pins(bodies: Bodies, robot: Robot) -> Iterator[SharedPin]:
    """Find pins between bodies that are no neighbours in the tree and that its motion pulls apart.

    Mimic joints that keep a linkage closed keep its pins closed, too; these are omitted.

    Args:
        bodies: The model at rest, with what bears on what.
        robot: The same model.
    """
    settings = bodies.config.topology
    neighbours = {frozenset(edge) for edge in bodies.tree.edges()}
    allowed = settings.pin_opens * bodies.diagonal
    for pair, bearing in bodies.bearings.items():
        if frozenset(pair) in neighbours or not bearing.lines or bearing.lines[0].score < settings.pin_score:
            continue
        first, second = (bodies.links[body] for body in pair)
        opening = widest_opening(robot, (first, second), bearing.lines[0].pivot)
        if opening is not None and opening.distance > allowed:
            yield SharedPin(
                links=(first, second),
                line=bearing.lines[0],
                joint=opening.joint,
                value=opening.value,
                opens=opening.distance,
                allowed=allowed,
            )
