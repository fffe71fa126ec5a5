"""Closed chains: the joints of a loop move together, so that one of them drives the others along a curve.

The curve is traced from the pose in which the file is given, by steps along the null space of the loop equations, each
corrected by Gauss-Newton (Allgower and Georg, Numerical Continuation Methods, 1990). A dead point of one joint is no
obstacle, since no joint is the parameter of the curve.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import Closure, forward_kinematics, rest_configuration

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Joint, LoopJoint, Robot

_STEP = 0.02
"""Of the curve [rad, or sizes of the linkage]: linear interpolation between two points is right to 5e-5 of the size."""
_MOST_STEPS = 3000
_FLAT = 5e-3
"""Motions whose share of the loop equations is smaller are free: axes of bearings are parallel to 0.1 deg."""
_OPEN = 1e-3
"""A gap beyond this share of the linkage's size does not close."""
_LEAST_SHARE = 0.1
"""Where a joint moves by less than this share of a step, it is near its dead point and cannot drive."""
_WHOLE = 0.98
"""A joint that drives this share of the curve drives it all but for its dead points."""
_SAME = 0.03
"""The curve is closed where it comes so near to its begin [rad, or sizes of the linkage]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Linkage:
    """The loops that share joints, and how these joints move together."""

    loops: tuple[str, ...]
    joints: tuple[str, ...]
    """Joints of the loops that follow none by `<mimic>`, in the order of the document."""
    mobility: int
    """Motions that the loops leave: 0 is a rigid frame, 1 has one driver."""
    driver: str | None
    """Joint that moves the others; None where there is no one such joint."""
    curve: FloatArray
    """Values of `joints` along the motion, the driver's rising, shape (n, joints); empty without a driver."""
    turns_around: bool
    """The driver turns by whole turns, and the curve is one of them."""
    stops: tuple[str, str]
    """What ends the curve at its begin and its end: the joint whose limit is reached, or why it cannot go on."""

    def closure(self, joint: str) -> Closure:
        """Return how a joint follows the driver."""
        driver, own = (self.curve[:, self.joints.index(name)] for name in (self.driver or "", joint))
        return Closure(joint=self.driver or "", at=driver, values=own, repeats=self.turns_around)


def loop_gaps(robot: Robot, q: dict[str, float]) -> dict[str, float]:
    """Return how far both ends of every loop are apart [m], by loop; `q` as for `forward_kinematics`."""
    poses = forward_kinematics(robot, q)
    return {
        loop.name: float(
            np.linalg.norm(
                np.subtract(
                    *(poses[link] @ np.append(point, 1.0) for link, point in zip(loop.links, loop.points, strict=True))
                )
            )
        )
        for loop in robot.loops
    }


def with_closures(robot: Robot) -> Robot:
    """Return the robot whose passive joints of closed chains follow the driver of their chain."""
    following = {
        name: linkage.closure(name)
        for linkage in linkages(robot)
        if linkage.driver is not None
        for name in linkage.joints
        if name != linkage.driver
    }
    joints = tuple(replace(joint, closure=following.get(joint.name)) for joint in robot.joints)
    return replace(robot, joints=joints) if following else robot


def linkages(robot: Robot) -> Iterator[Linkage]:
    """Find the closed chains of a robot, each with its motion within the limits of its joints.

    Loops that share joints are one linkage. A loop that `<mimic>` joints keep closed has one joint and is no linkage.

    Args:
        robot: Its closures have no effect.
    """
    open_chain = replace(robot, joints=tuple(replace(joint, closure=None) for joint in robot.joints))
    for loops in _sharing(open_chain):
        chain = _Chain(open_chain, loops)
        if len(chain.joints) > 1:
            yield chain.linkage()


def _sharing(robot: Robot) -> list[list[LoopJoint]]:
    """Loops in groups that share leading joints."""
    groups: list[tuple[set[str], list[LoopJoint]]] = []
    for loop in robot.loops:
        joints = {_led(robot, joint)[0] for side in sides(robot, loop.links) for joint in side if _moves(joint)}
        apart = [group for group in groups if not group[0] & joints]
        shared = [group for group in groups if group[0] & joints]
        merged = set().union(joints, *(names for names, _ in shared)), [*(i for _, g in shared for i in g), loop]
        groups = [*apart, merged]
    return [loops for _, loops in groups]


def sides(robot: Robot, links: tuple[str, str]) -> tuple[list[Joint], list[Joint]]:
    """Return the joints from where the ways to two links part to each of them, fixed ones included."""
    ways = []
    for link in links:
        way: list[Joint] = []
        while (above := robot.joint_above.get(way[-1].parent if way else link)) is not None:
            way.append(above)
        ways.append(way[::-1])
    first, second = ways
    shared = next((k for k, (a, b) in enumerate(zip(first, second, strict=False)) if a is not b), None)
    shared = min(len(first), len(second)) if shared is None else shared
    return first[shared:], second[shared:]


def _led(robot: Robot, joint: Joint) -> tuple[str, float, float]:
    """The joint that leads one, with multiplier and offset."""
    multiplier, offset = 1.0, 0.0
    while joint.mimic is not None:
        multiplier, offset = multiplier * joint.mimic.multiplier, offset + multiplier * joint.mimic.offset
        joint = robot.joint_by_name[joint.mimic.joint]
    return joint.name, multiplier, offset


@dataclass(frozen=True, kw_only=True, eq=False)
class _Side:
    """The way from where a loop parts to one of its ends."""

    joints: list[tuple[Joint, str, float, float]]
    """Each with what leads it, multiplier and offset."""
    point: FloatArray
    """The end, frame of the last link [m], shape (3,)."""


class _Chain:
    """The equations of loops that share joints, in their leading joints."""

    def __init__(self, robot: Robot, loops: Sequence[LoopJoint]) -> None:
        self._robot, self._loops = robot, loops
        self._ends = [
            _Side(joints=[(joint, *_led(robot, joint)) for joint in side], point=point)
            for loop in loops
            for side, point in zip(sides(robot, loop.links), loop.points, strict=True)
        ]
        moved = {leader for side in self._ends for joint, leader, *_ in side.joints if _moves(joint)}
        self.joints = tuple(joint.name for joint in robot.joints if joint.name in moved and _moves(joint))
        rest = rest_configuration(robot)
        self._index = {name: k for k, name in enumerate(self.joints)}
        self._start = np.array([rest[name] for name in self.joints])
        self._size = self._reach()
        self._turns = np.array([robot.joint_by_name[name].kind.turns for name in self.joints], dtype=bool)
        self._unit = np.where(self._turns, 1.0, self._size)
        self._low, self._high = self._bounds()

    def linkage(self) -> Linkage:
        """Trace the motion to both sides."""
        tangent, mobility = self._first_tangent()
        empty = Linkage(
            loops=tuple(loop.name for loop in self._loops), joints=self.joints, mobility=mobility, driver=None,
            curve=np.zeros((0, len(self.joints))), turns_around=False, stops=("", ""),
        )  # fmt: skip
        if mobility != 1 or tangent is None:
            return empty
        forward, end = self._trace(tangent)
        if end == _AROUND:
            turn, forward = self._whole_turn(forward), forward[:-1]  # the last row is the first one again
            half = len(forward) // 2
            rows = np.concatenate([forward[half:] - turn, forward[:half]])
            return self._driven(empty, rows, len(forward) - half, around=True, stops=("", ""))
        backward, begin = self._trace(-tangent)
        rows = np.concatenate([backward[:0:-1], forward])
        return self._driven(empty, rows, len(backward) - 1, around=False, stops=(begin, end))

    def _driven(self, empty: Linkage, rows: FloatArray, rest: int, *, around: bool, stops: tuple[str, str]) -> Linkage:
        """Choose the joint that drives, the one nearest the root of those that rise all along."""
        if len(rows) < 2:
            return empty
        steps = np.diff(rows, axis=0) / self._unit
        steps /= np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-300)
        spans = [_monotone(steps[:, k], rest) for k in range(len(self.joints))]
        depth = {joint.name: k for k, joint in enumerate(self._robot.joints_downward)}
        longest = max(end - begin for begin, end in spans)
        driver = min(
            (k for k, (begin, end) in enumerate(spans) if end - begin >= _WHOLE * longest),
            key=lambda k: depth[self.joints[k]],
        )
        begin, end = spans[driver]
        whole = (begin, end) == (0, len(rows) - 1)
        dead = f"{self.joints[driver]} is at its dead point"
        stops = stops[0] if begin == 0 else dead, stops[1] if end == len(rows) - 1 else dead
        curve = rows[begin : end + 1]
        turns = abs(float(np.ptp(curve[:, driver]))) / (2.0 * np.pi)
        # What is nearly a parallelogram comes back to its begin after two turns: it does not repeat each turn.
        around = around and whole and abs(turns - 1.0) < _SAME / np.pi
        if around:
            curve = np.concatenate([curve, curve[:1] + self._whole_turn(curve)])
        if curve[-1, driver] < curve[0, driver]:
            curve, stops = curve[::-1], stops[::-1]
        stops = ("", "") if around else stops
        return replace(empty, driver=self.joints[driver], curve=curve, turns_around=around, stops=stops)

    def _whole_turn(self, curve: FloatArray) -> FloatArray:
        """By how many whole turns each joint has turned along a curve that comes back to its begin [rad], (joints,)."""
        turned = np.round((curve[-1] - curve[0]) / (2.0 * np.pi)) * 2.0 * np.pi
        return np.asarray(np.where(self._turns, turned, 0.0))

    def _bounds(self) -> tuple[FloatArray, FloatArray]:
        joints = [self._robot.joint_by_name[name] for name in self.joints]
        low = np.array([-np.inf if joint.endless else joint.lower for joint in joints])
        high = np.array([np.inf if joint.endless else joint.upper for joint in joints])
        return np.minimum(low, self._start), np.maximum(high, self._start)

    def _reach(self) -> float:
        """Largest distance between points that the equations know [m]."""
        points = [point for side in self._ends for _, point, _ in self._walk(side, self._start)]
        return max(float(np.linalg.norm(np.ptp(points, axis=0))), 1e-9)

    def _walk(
        self, side: _Side, x: FloatArray
    ) -> Iterator[tuple[tuple[int, float, bool] | None, FloatArray, FloatArray]]:
        """Where every joint of a side stands [m], (3,), with its column, multiplier, whether it turns, and its axis.

        The last one is the end of the side; what does not move has no column.
        """
        T = np.eye(4)
        for joint, leader, multiplier, offset in side.joints:
            T = T @ joint.T_parent_child
            moves = (self._index[leader], multiplier, joint.kind.turns) if _moves(joint) else None
            yield moves, T[:3, 3], T[:3, :3] @ joint.axis
            T = T @ joint.motion(self._value(leader, multiplier, offset, x))
        yield None, (T @ np.append(side.point, 1.0))[:3], np.zeros(3)

    def _value(self, leader: str, multiplier: float, offset: float, x: FloatArray) -> float:
        return multiplier * float(x[self._index[leader]]) + offset if leader in self._index else 0.0

    def _equations(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Gaps of all loops in sizes of the linkage, (3L,), and their derivative by scaled values, (3L, joints)."""
        ends = [self._end(side, x) for side in self._ends]
        gaps = [one[0] - other[0] for one, other in zip(ends[::2], ends[1::2], strict=True)]
        slopes = [one[1] - other[1] for one, other in zip(ends[::2], ends[1::2], strict=True)]
        return np.concatenate(gaps) / self._size, np.concatenate(slopes) * self._unit / self._size

    def _end(self, side: _Side, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Where a side of a loop ends [m], (3,), and how it moves with each joint, (3, joints)."""
        *passed, (_, end, _) = self._walk(side, x)
        slope = np.zeros((3, len(self.joints)))
        for moves, pivot, axis in passed:
            if moves is not None:
                column, multiplier, turns = moves
                slope[:, column] += multiplier * (np.cross(axis, end - pivot) if turns else axis)
        return end, slope

    def _free(self, x: FloatArray) -> FloatArray:
        """Unit motions that keep the loops closed, in rows."""
        _, slope = self._equations(x)
        _, sizes, rows = np.linalg.svd(slope)
        rank = int((sizes > _FLAT * max(float(sizes[0]), 1e-12)).sum())
        return np.asarray(rows[rank:])

    def _corrected(self, x: FloatArray) -> FloatArray | None:
        """The nearest values that close the loops; None where there are none nearby."""
        for _ in range(12):
            gap, slope = self._equations(x)
            move = np.linalg.pinv(slope, rcond=_FLAT) @ gap
            x = x - move * self._unit
            if float(np.linalg.norm(move)) < 1e-11:
                break
        return x if float(np.abs(self._equations(x)[0]).max()) < _OPEN else None

    def _first_tangent(self) -> tuple[FloatArray | None, int]:
        """A motion from rest, and how many there are nearby: rest may be flat, where more than one begins."""
        if float(np.abs(self._equations(self._start)[0]).max()) > _OPEN:
            return None, 1
        free = self._free(self._start)
        if len(free) < 2:
            return (free[0] if len(free) else None), len(free)
        signs = np.array(np.meshgrid(*[[1.0, 0.0, -1.0]] * min(len(free), 3))).reshape(min(len(free), 3), -1).T
        tried = [row / np.linalg.norm(row) for row in signs if row.any()]
        found = []
        for row in tried:
            tangent = row @ free[: len(row)]
            moved = self._corrected(self._start + 5.0 * _STEP * tangent * self._unit)
            if moved is not None and float(np.linalg.norm((moved - self._start) / self._unit)) > _STEP:
                found.append((len(self._free(moved)), (moved - self._start) / self._unit))
        mobility, tangent = min(found, key=lambda item: item[0], default=(0, None))
        return (None, mobility) if tangent is None else (tangent / np.linalg.norm(tangent), mobility)

    def _trace(self, tangent: FloatArray) -> tuple[FloatArray, str]:
        """Values from rest along a motion, (n, joints), and what ends it."""
        rows, x, along = [self._start], self._start, tangent
        for count in range(_MOST_STEPS):
            new = self._corrected(x + _STEP * along * self._unit)
            if new is None or float(np.linalg.norm((new - x) / self._unit)) > 3.0 * _STEP:
                return np.array(rows), "the loop cannot close beyond"
            crossed = np.maximum(self._low - new, new - self._high) / self._unit
            if float(crossed.max()) > 1e-9:
                joint = int(crossed.argmax())
                edge = self._low[joint] if new[joint] < self._low[joint] else self._high[joint]
                share = (edge - x[joint]) / (new[joint] - x[joint])
                last = self._corrected(x + float(share) * (new - x))
                rows += [] if last is None or share < 1e-6 else [last]
                return np.array(rows), self.joints[joint]
            rows.append(new)
            apart = (new - self._start) / self._unit
            apart = np.where(self._turns, (apart + np.pi) % (2.0 * np.pi) - np.pi, apart)
            if count > 20 and float(np.linalg.norm(apart)) < 0.51 * _STEP:
                return np.array(rows), _AROUND
            free = self._free(new)
            turned = free.T @ (free @ along) if len(free) else new - x
            x, along = new, turned / max(float(np.linalg.norm(turned)), 1e-12)
        return np.array(rows), "it moves farther than was looked at"


_AROUND = "around"


def _monotone(steps: FloatArray, rest: int) -> tuple[int, int]:
    """First and last row around `rest` between which a joint moves one way, fast enough to drive."""
    begin = end = rest
    for sign in (1.0, -1.0):
        low = high = rest
        while high < len(steps) and sign * steps[high] > _LEAST_SHARE:
            high += 1
        while low > 0 and sign * steps[low - 1] > _LEAST_SHARE:
            low -= 1
        if high - low > end - begin:
            begin, end = low, high
    return begin, end


def _moves(joint: Joint) -> bool:
    return joint.kind is not JointType.FIXED
