"""Policies written by hand: what a learned one is compared with, and where demonstrations come from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kinematify.envs.drawer_pull import JOINT, JOINT_STEP, TOOL_STEP, TURN_STEP
from kinematify.envs.goal import CONTROL_STEP
from kinematify.envs.open_part import POSITION
from kinematify.envs.worlds import HAND_SPEED
from kinematify.manipulation.execute import eased
from kinematify.manipulation.kinematics import damped_step

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.envs.drawer_pull import DrawerPullEnv
    from kinematify.envs.open_part import OpenPartEnv
    from kinematify.robot.arrays import FloatArray

_SPEED = 0.5  # of opening [ways/s]
_REACH_SPEED = 0.6  # share of the fastest that actions allow
_PULL_SPEED = 0.35  # [ways/s]
_PULL_ROWS = 40
_TURN_WEIGHT = 0.05  # of a radian over a metre, where an arm cannot reach a pose
_NEAREST_DAMPING, _NEAREST_STEPS = 0.02, 40
_SURE = 0.01  # the part is taken so far beyond what counts as open, where fingers have slipped
_SLIP, _MOST_SLIP = 0.005, 0.2  # shares of the way that are made good per step, and in all
_GRIP_SECONDS = 0.6
_AHEAD = 0.04  # the part is taken so far beyond what counts as open
_GAIN, _SUM = 0.7, 0.35  # shares of an error of speed that are made good in a step
_SETTLE = 0.35  # speed wanted per share of the way that is left, over 0.05 s


class HandExpert:
    """Opens a part in OpenPart: a speed along the way out, less near its end, and a force that keeps it."""

    def __init__(self, env: OpenPartEnv) -> None:
        """Take what the observation does not tell: control and goal."""
        self._control, self._goal = env.control, min(env.open_fraction + _AHEAD, 0.995)
        self._slots = env.goal.slots
        self._push = 0.0
        facts, target = env.facts, env.target
        # Change of speed by a full action [ways/s]: heavy lids have weak hands, light ones strong hands.
        change = facts.hand.force * target.path_ratio / facts.inertia * CONTROL_STEP / abs(target.range)
        self._gain, self._sum = min(_GAIN / change, 1.0), min(_SUM / change, 0.5)

    def begin(self) -> None:
        """Forget the episode before."""
        self._push = 0.0

    def act(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the action for what is seen."""
        share, speed = float(observation[0]), float(observation[self._slots])
        direction = observation[3 * self._slots + 6 : 3 * self._slots + 9]
        wanted = float(np.clip((self._goal - share) / _SETTLE, -_SPEED, _SPEED))
        if self._control == POSITION:
            return np.asarray(np.clip(wanted / HAND_SPEED * direction, -1.0, 1.0), dtype=np.float32)
        # The force that keeps the speed is found on the way; weight, friction and damping are not known.
        self._push = float(np.clip(self._push + self._sum * (wanted - speed), -1.0, 1.0))
        action = (self._push + self._gain * (wanted - speed)) * direction
        return np.asarray(np.clip(action, -1.0, 1.0), dtype=np.float32)


class ArmExpert:
    """Opens a part in DrawerPull: along the plan to the hold, fingers together, along the joint's motion, and stay.

    It knows what a policy does not: the plan, and where the object was drawn.
    """

    def __init__(self, env: DrawerPullEnv) -> None:
        """Take the plan."""
        self._env, self._step, self._way = env, 0, np.empty((0, 0))
        self._end = self._beyond = 0.0

    def begin(self) -> None:
        """Lay out the way of an episode that has just begun."""
        reach, pull = self._reach(), self._pull()
        closing = round(_GRIP_SECONDS / CONTROL_STEP)
        settling = np.tile(pull[-1], (1, 1))
        self._way = np.concatenate([reach, np.tile(reach[-1], (closing, 1)), pull, settling])
        self._grips_from, self._step, self._beyond = len(reach), 0, 0.0

    def act(self, observation: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the action for this moment; at the end of the way, pull on as long as the part is not open."""
        env = self._env
        if self._step >= len(self._way) and float(observation[0]) < env.open_fraction + _SURE:
            self._beyond = min(self._beyond + _SLIP, _MOST_SLIP)
            self._way = np.concatenate([self._way, self._posture(self._end + self._beyond, self._way[-1])[None]])
        row = self._way[min(self._step, len(self._way) - 1)]
        gripper = -1.0 if self._step >= self._grips_from else 1.0
        self._step += 1
        wanted = env.wanted
        if env.control == JOINT:
            motion = (row - wanted) / JOINT_STEP
        else:
            turn = env.plan.T_world_base[:3, :3] @ env.robot.arm.pose(wanted)[:3, :3]
            twist = env.robot.arm.error(wanted, env.robot.arm.pose(row))
            motion = np.concatenate([turn @ twist[:3] / TOOL_STEP, turn @ twist[3:] / TURN_STEP])
        return np.asarray(np.clip(np.append(motion, gripper), -1.0, 1.0), dtype=np.float32)

    def _reach(self) -> FloatArray:
        """Arm joints from where they are to the hold, rows of one step each."""
        env, plan = self._env, self._env.plan
        now, planned = env.world.link_poses()[env.target.link], plan.T_world_object @ self._link_at(env.target.closed)
        shift = now @ np.linalg.inv(planned)
        rows = [env.wanted]
        for row in plan.reach[1:]:
            target = shift @ plan.T_world_base @ env.robot.arm.pose(row)
            rows.append(self._solved(target, row))
        return _paced(np.array(rows), _REACH_SPEED * JOINT_STEP)

    def _pull(self) -> FloatArray:
        """Arm joints from the hold to the open end."""
        env, plan = self._env, self._env.plan
        start = float(env.goal.fraction(env.reading()))
        end = self._end = min(env.open_fraction + _AHEAD, plan.fraction, 0.995)
        shares = np.linspace(start, end, _PULL_ROWS)
        values = env.target.closed + shares * env.target.range
        sign = np.sign(env.target.range)
        guesses = np.stack([np.interp(sign * values, sign * plan.opened, column) for column in plan.pull.T], axis=1)
        rows = [self._posture(shares[0], guesses[0])]
        for share, motion in zip(shares[1:].tolist(), np.diff(guesses, axis=0), strict=True):
            rows.append(self._posture(share, rows[-1] + motion))  # from the plan alone elbows would jump to and fro
        least = (end - start) / _PULL_ROWS / (_PULL_SPEED * CONTROL_STEP)
        return _paced(np.array(rows), _REACH_SPEED * JOINT_STEP, least)

    def _posture(self, share: float, guess: FloatArray) -> FloatArray:
        """Arm joints where a share of the way is open, near a guess."""
        env = self._env
        root = env.world.link_poses()[env.articulated_object.declared.root]
        return self._solved(root @ self._link_at(env.target.value(share)) @ env.plan.T_link_tool, guess)

    def _solved(self, target: FloatArray, guess: FloatArray) -> FloatArray:
        """Arm joints that bring the tool to a pose of the world, near a guess, or as near to the pose as they can."""
        arm = self._env.robot.arm
        goal = np.linalg.inv(self._env.plan.T_world_base) @ target
        found = arm.solve(goal, guess, center=False)
        return self._nearest(goal, guess) if found is None else found

    def _nearest(self, goal: FloatArray, guess: FloatArray) -> FloatArray:
        """Arm joints at which the tool is nearly at a place, turned as it can be: a bar may turn between the pads."""
        arm, q = self._env.robot.arm, guess
        weight = np.array([1.0, 1.0, 1.0, _TURN_WEIGHT, _TURN_WEIGHT, _TURN_WEIGHT])
        for _ in range(_NEAREST_STEPS):
            step = damped_step(weight[:, None] * arm.jacobian(q), weight * arm.error(q, goal), _NEAREST_DAMPING)
            q = np.clip(q + step, arm.lower, arm.upper)
        return np.asarray(q)

    def _link_at(self, value: float) -> FloatArray:
        """Link that is opened, frame of the object's root, shape (4, 4)."""
        return self._env.articulated_object.link_pose(self._env.target.joint, value, self._env.plan.first)


def _paced(rows: FloatArray, step: float, least: float = 1e-9) -> FloatArray:
    """Rows on the same way, none farther from the one before than `step` in any joint, with a smooth start and end.

    Args:
        rows: Arm joints [rad or m], shape (n, dof).
        step: [rad or m].
        least: Time from row to row at least, in steps.
    """
    times = np.maximum(np.abs(np.diff(rows, axis=0)).max(axis=1) / step, least)
    along = np.concatenate([[0.0], np.cumsum(times)])
    return eased(rows, along, max(2, int(np.ceil(1.5 * along[-1]))))
