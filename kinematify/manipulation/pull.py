"""The pull: hand and part are one body, and the object's own joint says where the hand must be at every moment.

A pull is followed by inverse kinematics from pose to pose, out of the middle of the range to both ends: what freedom
the arm has left keeps it away from its limits.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.manipulation.kinematics import damped_step

if TYPE_CHECKING:
    from kinematify.manipulation.collision_world import CollisionWorld
    from kinematify.manipulation.kinematics import Arm
    from kinematify.manipulation.robot_place import ObjectMotion, RobotPlacement
    from kinematify.robot.arrays import FloatArray

LIMIT, SINGULAR, JUMP, SELF, OBJECT, FLOOR, UNREACHED, ITSELF = (
    "arm limit", "singularity", "jump", "self-collision", "arm against object", "arm against floor", "out of reach",
    "object against itself",
)  # fmt: skip
_RESTARTS = 3  # samples of the arm from which inverse kinematics starts
JUMP_AT = 0.6  # 25 poses over a turn of the wrist
"""Larger changes of a joint from one pose to the next are no continuous motion [rad or m]."""
_NEAR_LIMIT = 0.005  # of its range: a joint that is so near is at its limit
_SINGULAR = 0.02  # smallest singular value of the Jacobian (lengths in half metres) that an arm can follow with
_KINDS = {"self": SELF, "object": OBJECT, "floor": FLOOR}


@dataclass(frozen=True, kw_only=True)
class Stop:
    """Cause that ends a pull."""

    kind: str
    """One of the names of this module."""
    words: str
    """The same as words that follow "because"."""
    pair: tuple[str, str] | None = None
    """Who collides, the robot's link first."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Pull:
    """Distance over which the arm can take the part from one place."""

    place: RobotPlacement
    path: FloatArray
    """Arm joints [rad or m], shape (m, dof)."""
    values: FloatArray
    """Of the object's joint, from rest on [rad or m], shape (m,)."""
    fraction: float
    """Share of the range."""
    stop: Stop | None
    """What ends it; None if it is complete."""


class Puller:
    """Follows one joint of the object with one arm."""

    def __init__(self, arm: Arm, world: CollisionWorld, motion: ObjectMotion) -> None:
        """Keep what is given."""
        self.arm, self.world, self.motion = arm, world, motion

    def follow(self, place: RobotPlacement, *, column: bool, from_start: bool = False) -> Pull | Stop:
        """Follow the joint as far as the arm can from a place.

        Args:
            place: Place and grasp.
            column: The robot stands on a column.
            from_start: Begin at rest instead of in the middle: goes farther where not all can be reached.

        Returns:
            The pull that goes farthest, or what keeps it from beginning.
        """
        self.world.place(place.T_world_base, self.motion.T_world_object, column=column)
        targets = np.asarray(np.linalg.inv(place.T_world_base) @ self.motion.link_poses @ place.T_link_tool)
        anchor = 0 if from_start else len(targets) // 2
        best: Pull | None = None
        stop: Stop | None = None
        for q in self.arm.solve_all(targets[anchor], _RESTARTS):
            stop = self._blocked(q, anchor, place)
            if stop is not None:
                continue
            back, stop = self._continued(q, targets, range(anchor - 1, -1, -1), place)
            if stop is not None:
                continue
            on, stop = self._continued(q, targets, range(anchor + 1, len(targets)), place)
            pull = self._pull(place, np.array([*reversed(back), q, *on]), stop)
            if best is None or pull.fraction > best.fraction:
                best = pull
            if pull.stop is None:
                break
        return best or stop or Stop(kind=UNREACHED, words="its inverse kinematics finds no posture at the grasp")

    def _continued(
        self, q: FloatArray, targets: FloatArray, rows: range, place: RobotPlacement
    ) -> tuple[list[FloatArray], Stop | None]:
        """Go on from a posture to further poses until something stops it."""
        found: list[FloatArray] = []
        before = q
        for row in rows:
            now = self.arm.solve(targets[row], q + (q - before) if found else q)
            if now is None:
                return found, self._why_not(q, targets[row])
            if float(np.abs(now - q).max()) > JUMP_AT:
                return found, Stop(kind=JUMP, words="its posture would have to change all at once")
            stop = self._blocked(now, row, place)
            if stop is not None:
                return found, stop
            found.append(now)
            before, q = q, now
        return found, None

    def _blocked(self, q: FloatArray, row: int, place: RobotPlacement) -> Stop | None:
        self.world.pose_object(self.motion.body_poses[row], place.grasp.spread)
        hit = self.world.hit(q, holding=True)
        if hit is None:
            return None
        words = f"its {hit.first} meets {hit.second}" + (" of the object" if hit.kind == "object" else "")
        return Stop(kind=_KINDS[hit.kind], words=words, pair=(hit.first, hit.second))

    def _why_not(self, q: FloatArray, target: FloatArray) -> Stop:
        """Why inverse kinematics gets no farther than a posture."""
        arm, near = self.arm, _NEAR_LIMIT * (self.arm.upper - self.arm.lower)
        step = damped_step(arm.jacobian(q), arm.error(q, target), 0.01)
        held = ((q < arm.lower + near) & (step < 0.0)) | ((q > arm.upper - near) & (step > 0.0))
        if held.any():
            name = arm.robot.arm_joints[int(np.argmax(held * np.abs(step)))]
            return Stop(kind=LIMIT, words=f"its {name} is at the end of its range")
        if arm.manipulability(q) < _SINGULAR:
            return Stop(kind=SINGULAR, words="it is stretched out or its wrist is aligned (singular)")
        return Stop(kind=UNREACHED, words="the next pose is out of its reach")

    def _pull(self, place: RobotPlacement, path: FloatArray, stop: Stop | None) -> Pull:
        values = self.motion.values[: len(path)]
        whole = float(self.motion.values[-1] - self.motion.values[0])
        fraction = abs(float(values[-1] - values[0]) / whole)
        return Pull(place=place, path=path, values=values, fraction=fraction, stop=stop)
