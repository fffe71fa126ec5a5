"""What must be opened before a joint can be: the door before the drawer behind it.

A part that runs into another one is not lost where a further joint moves that one away: a robot opens the other joint
first, as a person would, and finds the object standing like that.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import OverlapQueries
from kinematify.geometry.rest import DepthAllowance
from kinematify.geometry.sweep import Sweeper
from kinematify.manipulation.grasp import opening_sign

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.config.planning import PlanSettings
    from kinematify.geometry.scene import Scene
    from kinematify.robot.mechanism import Travel


@dataclass(frozen=True, kw_only=True)
class Freedom:
    """How far the object lets one of its joints go, whoever pulls."""

    share: float = 1.0
    """Of the way from rest to the open end, in [0, 1]."""
    pair: tuple[str, str] | None = None
    """Who meets at the end of it."""
    helpers: tuple[int, ...] = ()
    """Other leaders that move the two against each other."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Clearing:
    """An object as it stands when the turn of a joint comes."""

    scene: Scene
    freedom: Freedom
    """Of the joint, in this scene."""
    first: Mapping[str, float] = field(default_factory=dict)
    """Joints that were opened before, and where to [rad or m]."""


def pull_end(travel: Travel, settings: PlanSettings) -> float:
    """Value at which a joint counts as open: the farther end of its range from rest [rad or m]."""
    if not travel.limited:
        return travel.rest + settings.range_turn
    return travel.upper if opening_sign(travel) > 0.0 else travel.lower


def clear_way(scene: Scene, joint: str, settings: PlanSettings) -> Clearing:
    """Open other joints until one can be opened.

    Args:
        scene: The object at rest.
        joint: Leading joint that is to be opened.
        settings: What counts as open, and how many others may be opened first.

    Returns:
        The object with the others opened; as it is where that would not help.
    """
    leader = [travel.joint for travel in scene.travels].index(joint)
    start = found = Clearing(scene=scene, freedom=_freedom(scene, leader, settings))
    for _ in range(settings.openers):
        if found.freedom.share >= settings.opened:
            break
        steps = [_with(found, scene, helper, leader, settings) for helper in found.freedom.helpers]
        better = [step for step in steps if step.freedom.share > found.freedom.share]
        if not better:
            break
        found = max(better, key=lambda step: step.freedom.share)
    return found if found.freedom.share >= settings.opened else start


def _with(before: Clearing, scene: Scene, helper: int, leader: int, settings: PlanSettings) -> Clearing:
    """Open one more joint."""
    travel = scene.travels[helper]
    first = {**before.first, travel.joint: pull_end(travel, settings)}
    opened = scene.standing(first)
    return Clearing(scene=opened, freedom=_freedom(opened, leader, settings), first=first)


def _freedom(scene: Scene, leader: int, settings: PlanSettings) -> Freedom:
    """How far a leader goes while all others rest."""
    overlap = OverlapQueries(scene)
    sweep = Sweeper(scene, overlap, DepthAllowance(scene, overlap)).sweep(leader)
    travel = scene.travels[leader]
    end = pull_end(travel, settings)
    side = sweep.sides[0 if end < travel.rest else 1]
    deep = scene.settings.wrong * scene.size
    meeting = next((m for m in side.meetings if m.inside and m.depth > deep), None)
    if meeting is None:
        return Freedom()
    return Freedom(
        share=float(np.clip((meeting.first - travel.rest) / (end - travel.rest), 0.0, 1.0)),
        pair=scene.name(meeting.pair),
        helpers=tuple(sorted(scene.between(meeting.pair) - {leader})),
    )
