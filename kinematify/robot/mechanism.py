"""Mechanism of a tree: which joints lead, how far they go, what each one moves."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import sides
from kinematify.robot.robot import forward_kinematics, joint_ends, joint_values, rest_configuration, rigid_groups

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.robot.arrays import BoolArray, FloatArray, IntArray
    from kinematify.robot.robot import Robot


_NEARBY = 1e-3
"""Slopes of curves are taken over twice this [rad or m]."""
_DEAD = 1e-3
"""Slopes below are those of a dead point."""


@dataclass(frozen=True, kw_only=True)
class Travel:
    """The way of a joint that leads: unlimited joints turn by half a turn either way."""

    joint: str
    turns: bool
    limited: bool
    """False where the ends are none of the model's."""
    lower: float
    """[rad or m]."""
    rest: float
    """[rad or m]."""
    upper: float
    """[rad or m]."""

    @property
    def range(self) -> float:
        """[rad or m]."""
        return self.upper - self.lower

    @property
    def far_end(self) -> float:
        """End of the range that is farther from rest: where the joint is open [rad or m]."""
        return self.upper if self.upper - self.rest >= self.rest - self.lower else self.lower

    @property
    def unit(self) -> str:
        """Unit of its values."""
        return "rad" if self.turns else "m"


@dataclass(frozen=True, kw_only=True, eq=False)
class LeaderMechanism:
    """A tree, its leading joints and its bodies (links held together by fixed joints)."""

    robot: Robot
    standing: Mapping[str, float] = field(default_factory=dict)
    """Leaders that rest elsewhere than they would, and where [rad or m]."""

    @cached_property
    def travels(self) -> tuple[Travel, ...]:
        """Travels of every joint that is neither fixed nor a follower, in the order of the document."""
        leaders = self.robot.leaders
        rest = {**rest_configuration(self.robot), **self.standing}
        lower, upper = joint_ends(leaders)
        return tuple(
            Travel(
                joint=joint.name,
                turns=joint.kind.turns,
                limited=joint.is_limited and not joint.endless,
                lower=float(low),
                rest=rest[joint.name],
                upper=float(high),
            )
            for joint, low, high in zip(leaders, lower, upper, strict=True)
        )

    @cached_property
    def links(self) -> tuple[str, ...]:
        """In the order of the document."""
        return tuple(link.name for link in self.robot.links)

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """Every joint that is not fixed, followers included, in the order of the document."""
        return tuple(joint.name for joint in self.robot.joints if joint.kind is not JointType.FIXED)

    @cached_property
    def body_of_link(self) -> IntArray:
        """Index of the rigid body of each link, shape (L,); the root's is 0."""
        bodies = {name: k for k, group in enumerate(rigid_groups(self.robot)) for name in group.links}
        return np.array([bodies[name] for name in self.links], dtype=np.int64)

    @cached_property
    def moved(self) -> BoolArray:
        """Which bodies a leader moves, its followers' included, shape (leaders, bodies)."""
        row = {name: np.abs(self.leads[k]) > 0.0 for k, name in enumerate(self.joints)}
        body = dict(zip(self.links, self.body_of_link.tolist(), strict=True))
        moved = np.zeros((int(self.body_of_link.max()) + 1, len(self.travels)), dtype=bool)
        for joint in self.robot.joints_downward:
            moved[body[joint.child]] |= moved[body[joint.parent]] | row.get(joint.name, np.False_)
        result: BoolArray = moved.T
        return result

    @cached_property
    def leads(self) -> FloatArray:
        """Motion of every joint per motion of each leader, shape (joints, leaders).

        Multipliers of mimic joints; slopes at rest of joints that follow a curve, at a dead point their mean size.
        """
        slopes = (self._followed(np.eye(len(self.travels))) - self._at_zero).T
        for row in self._curved:
            slopes[row] = self._slopes(row)
        return slopes

    def leads_at(self, leaders: FloatArray) -> FloatArray:
        """`leads` where the leaders have these values (leaders,): the slopes of curves there, (joints, leaders)."""
        if not self._curved:
            return self.leads
        steps = _NEARBY * np.eye(len(leaders))
        ahead, behind = (self.all_values(leaders + sign * steps) for sign in (1.0, -1.0))
        slopes: FloatArray = (ahead - behind).T / (2.0 * _NEARBY)
        return slopes

    @cached_property
    def rest(self) -> FloatArray:
        """Values of the leaders at rest [rad or m], shape (leaders,)."""
        return np.array([travel.rest for travel in self.travels])

    @cached_property
    def values_at_rest(self) -> FloatArray:
        """Values of all `joints` at rest [rad or m], shape (joints,)."""
        values: FloatArray = self.all_values(self.rest[None])[0]
        return values

    def all_values(self, leaders: FloatArray) -> FloatArray:
        """Return the values of all `joints` [rad or m], shape (n, joints), for rows of leaders (n, leaders)."""
        values: FloatArray = self._at_zero + leaders @ self.leads.T
        column = {name: k for k, name in enumerate(self.joints)}
        for row in self._curved:
            joint = self.robot.joint_by_name[self.joints[row]]
            if joint.closure is not None:
                values[:, row] = joint.closure.follow(values[:, column[joint.closure.joint]])
            elif joint.mimic is not None:
                values[:, row] = joint.mimic.multiplier * values[:, column[joint.mimic.joint]] + joint.mimic.offset
        return values

    def sweep(self, samples: int) -> FloatArray:
        """Rows of leaders: rest, then each leader from end to end while the others rest.

        Returns:
            Shape (1 + leaders * samples, leaders) [rad or m].
        """
        rows = np.tile(self.rest, (1 + len(self.travels) * samples, 1))
        for k, travel in enumerate(self.travels):
            rows[1 + k * samples : 1 + (k + 1) * samples, k] = np.linspace(travel.lower, travel.upper, samples)
        return rows

    @cached_property
    def _curved(self) -> tuple[int, ...]:
        """Rows of joints that follow along a curve, or mimic one that does, each after what it follows."""
        if all(joint.closure is None for joint in self.robot.joints):
            return ()
        found: dict[str, int] = {}
        waiting = [self.robot.joint_by_name[name] for name in self.joints]
        for _ in waiting:
            for row, joint in enumerate(waiting):
                if joint.closure is not None or (joint.mimic is not None and joint.mimic.joint in found):
                    found.setdefault(joint.name, row)
        return tuple(found.values())

    def _slopes(self, row: int) -> FloatArray:
        joint = self.robot.joint_by_name[self.joints[row]]
        if joint.closure is None:
            assert joint.mimic is not None
            return joint.mimic.multiplier * self._slopes(self.joints.index(joint.mimic.joint))
        column = [travel.joint for travel in self.travels].index(joint.closure.joint)
        near = self.travels[column].rest + np.array([-_NEARBY, _NEARBY])
        values, at = joint.closure.follow(near), np.clip(near, joint.closure.at[0], joint.closure.at[-1])
        slope = float(np.diff(values)[0]) / max(float(np.diff(at)[0]), 1e-12)
        if abs(slope) < _DEAD:
            slope = float(np.abs(np.diff(joint.closure.values)).sum()) / float(np.ptp(joint.closure.at))
        slopes = np.zeros(len(self.travels))
        slopes[column] = slope
        return slopes

    @cached_property
    def _at_zero(self) -> FloatArray:
        first: FloatArray = self._followed(np.zeros((1, len(self.travels))))[0]
        return first

    def _followed(self, leaders: FloatArray) -> FloatArray:
        names = [travel.joint for travel in self.travels]
        rows = [joint_values(self.robot, dict(zip(names, row.tolist(), strict=True))) for row in leaders]
        return np.array([[row[name] for name in self.joints] for row in rows]).reshape(len(leaders), len(self.joints))


@dataclass(frozen=True, kw_only=True)
class LoopOpening:
    """Distance by which a shared pin comes apart when one joint moves alone."""

    joint: str
    """Leader that opens it most."""
    value: float
    """Where that leader stands then [rad or m]."""
    distance: float
    """Between the two ends of the pin there [m]."""


def widest_opening(robot: Robot, links: tuple[str, str], point: FloatArray) -> LoopOpening | None:
    """Move each leader that moves one of two links without the other to its ends; None where there is no such leader.

    Mimic joints that keep a linkage closed keep its pins closed, too.

    Args:
        robot: A tree.
        links: The two that share a pin.
        point: Of the pin, frame of the root link at rest [m], shape (3,).
    """
    mechanism = LeaderMechanism(robot=robot)
    first, second = (int(mechanism.body_of_link[mechanism.links.index(link)]) for link in links)
    rest = {travel.joint: travel.rest for travel in mechanism.travels}
    at_rest = forward_kinematics(robot, rest)
    found = []
    for travel, moved in zip(mechanism.travels, mechanism.moved, strict=True):
        if not (moved[first] or moved[second]):
            continue
        for value in (travel.lower, travel.upper):
            if value == travel.rest:
                continue
            poses = forward_kinematics(robot, {**rest, travel.joint: value})
            ends = [poses[link] @ np.linalg.inv(at_rest[link]) @ np.append(point, 1.0) for link in links]
            found.append(
                LoopOpening(joint=travel.joint, value=value, distance=float(np.linalg.norm(ends[0] - ends[1])))
            )
    return max(found, key=lambda opening: opening.distance, default=None)


def joints_between(robot: Robot, links: tuple[str, str]) -> tuple[str, ...]:
    """Return the joints of the tree on the way from one link to another, fixed ones omitted."""
    first, second = sides(robot, links)
    return tuple(joint.name for joint in (*first[::-1], *second) if joint.kind is not JointType.FIXED)
