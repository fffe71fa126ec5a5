"""Pins that two bodies share though no joint joins them: there a linkage closes, which a tree of joints cannot say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.mechanism import Mechanism
from kinematify.robot.robot import forward_kinematics

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.config.validation import EvidenceSettings
    from kinematify.joints.hypotheses.bearing_line import BearingLine
    from kinematify.robot.robot import Robot
    from kinematify.validation.evidence.bodies import Bodies


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


def shared_pins(bodies: Bodies, robot: Robot, settings: EvidenceSettings) -> Iterator[SharedPin]:
    """Find pins between bodies that are no neighbours in the tree and that its motion pulls apart.

    Mimic joints that keep a linkage closed keep its pins closed, too; these are left out.

    Args:
        bodies: The model at rest, with what bears on what.
        robot: The same model.
        settings: `pin_score` and `pin_opens`.
    """
    neighbours = {frozenset(edge) for edge in bodies.tree.edges()}
    travels = Mechanism(robot=robot).travels
    rest = {travel.joint: travel.rest for travel in travels}
    ends = [(travel.joint, end) for travel in travels for end in (travel.lower, travel.upper) if end != travel.rest]
    at_rest = forward_kinematics(robot, rest)
    moved = [forward_kinematics(robot, {**rest, joint: end}) for joint, end in ends]
    allowed = settings.pin_opens * bodies.diagonal
    for pair, bearing in bodies.bearings.items():
        if frozenset(pair) in neighbours or not bearing.lines or bearing.lines[0].score < settings.pin_score:
            continue
        first, second = (bodies.links[body] for body in pair)
        pin = np.append(bearing.lines[0].pivot, 1.0)
        apart = []
        for poses in moved:
            ends_of_pin = [poses[link] @ np.linalg.inv(at_rest[link]) @ pin for link in (first, second)]
            apart.append(float(np.linalg.norm(ends_of_pin[0] - ends_of_pin[1])))
        widest = int(np.argmax(apart)) if apart else 0
        if apart and apart[widest] > allowed:
            joint, value = ends[widest]
            yield SharedPin(
                links=(first, second),
                line=bearing.lines[0],
                joint=joint,
                value=value,
                opens=apart[widest],
                allowed=allowed,
            )
