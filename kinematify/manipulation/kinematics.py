"""The arm as a chain: where its tool is, and which values of its joints bring it to a pose (Pinocchio)."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree
from scipy.spatial import KDTree
from scipy.stats import qmc

from kinematify.errors import EnvironmentFault
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.write import robot_element
from kinematify.versions import not_installed

try:
    import pinocchio as pin
except ImportError as error:
    raise EnvironmentFault(not_installed("A robot arm", "pin", "coal", "ompl")) from error

if TYPE_CHECKING:
    from kinematify.manipulation.manipulator import TaskRobot
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

_ITERATIONS = 40  # of inverse kinematics: from the nearest sample a dozen are enough
_DAMPING = 0.02  # of its least squares, relative to the remaining error
_CENTERING = 0.02  # share of the way back to the middle of the range in each step, as far as there is freedom
_LARGEST_STEP = 0.4  # of a joint [rad or m]: beyond that the linear model means nothing
_SAME_PLACE, _SAME_TURN = 5e-5, 5e-4  # error of the tool that counts as none [m, rad]
_RADIAN = 0.2  # an error of direction of one radian counts like so much error of position [m]: of a hand of 20 cm
_BATCH = 14  # two to this power configurations represent what the arm can reach


class Arm:
    """Arm and fingers of a robot, all other joints at rest; frame: the robot's root link."""

    def __init__(self, robot: TaskRobot, *, seed: int = 0) -> None:
        """Read the robot.

        Args:
            robot: As planning needs it.
            seed: Of restarts and of the samples that represent what can be reached.
        """
        self.robot, self._seed = robot, seed
        self.declared = read_robot(robot.urdf)
        text = etree.tostring(robot_element(_without_endless_joints(self.declared)), encoding="unicode")
        self.model = self._reduced(pin.buildModelFromXML(text))
        self._data = self.model.createData()
        self._tool = self.model.getFrameId(robot.tool)
        joints = [self.model.joints[self.model.getJointId(name)] for name in robot.arm_joints]
        self._rows = np.array([joint.idx_q for joint in joints])
        self._columns = np.array([joint.idx_v for joint in joints])
        self._fingers = np.array([self.model.joints[self.model.getJointId(n)].idx_q for n in robot.finger_joints])
        self.lower = np.asarray(self.model.lowerPositionLimit[self._rows], dtype=np.float64)
        self.upper = np.asarray(self.model.upperPositionLimit[self._rows], dtype=np.float64)
        self.home = np.clip(np.array(robot.home, dtype=np.float64), self.lower, self.upper)

    @property
    def dof(self) -> int:
        """Number of arm joints."""
        return len(self._rows)

    def full(self, q: FloatArray, gap: float) -> FloatArray:
        """Values of arm joints (dof,) as a configuration of `model`, the pads `gap` apart [m]."""
        values = pin.neutral(self.model)
        values[self._rows] = q
        values[self._fingers] = self.robot.fingers_at(gap)
        return np.asarray(values)

    def pose(self, q: FloatArray) -> FloatArray:
        """Pose of the tool, shape (4, 4)."""
        return np.asarray(self._placement(q).homogeneous).copy()

    def jacobian(self, q: FloatArray) -> FloatArray:
        """Jacobian of the tool, in its own frame, linear part first, shape (6, dof)."""
        values = pin.neutral(self.model)
        values[self._rows] = q
        return np.asarray(pin.computeFrameJacobian(self.model, self._data, values, self._tool, pin.LOCAL))[
            :, self._columns
        ]

    def error(self, q: FloatArray, target: FloatArray) -> FloatArray:
        """Twist from the tool to a pose (4, 4), in the tool's frame, linear part first, shape (6,)."""
        return np.asarray(pin.log6(self._placement(q).actInv(pin.SE3(target))).vector)

    def manipulability(self, q: FloatArray) -> float:
        """Smallest singular value of the Jacobian, lengths in units of half a metre; 0 where a motion is lost."""
        scaled = self.jacobian(q) * np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])[:, None]
        return float(np.linalg.svd(scaled, compute_uv=False)[min(5, self.dof - 1)])

    def solve(self, target: FloatArray, start: FloatArray, *, center: bool = True) -> FloatArray | None:
        """Move the tool to a pose by damped least squares, joints kept within their limits.

        Args:
            target: Pose of the tool, shape (4, 4).
            start: Values to begin with, shape (dof,).
            center: Use what freedom is left to stay away from the limits.

        Returns:
            Values of the arm joints, shape (dof,), or None where it did not get there.
        """
        q = np.clip(start, self.lower, self.upper)
        goal, middle = pin.SE3(target), 0.5 * (self.lower + self.upper)
        weight = _CENTERING / np.maximum(self.upper - self.lower, 1e-6) ** 2
        for _ in range(_ITERATIONS):
            gap = self._placement(q).actInv(goal)
            error = np.asarray(pin.log6(gap).vector)
            if np.linalg.norm(error[:3]) < _SAME_PLACE and np.linalg.norm(error[3:]) < _SAME_TURN:
                return q
            jacobian = self.jacobian(q)
            gram = jacobian @ jacobian.T + _DAMPING * (1e-3 + float(error @ error)) * np.eye(6)
            step = jacobian.T @ np.linalg.solve(gram, error)
            if center:
                wish = -weight * (q - middle)
                step += wish - jacobian.T @ np.linalg.solve(gram, jacobian @ wish)
            largest = float(np.abs(step).max())
            q = np.clip(q + step * min(1.0, _LARGEST_STEP / max(largest, 1e-9)), self.lower, self.upper)
        return None

    def solve_all(self, target: FloatArray, tries: int) -> list[FloatArray]:
        """Values that bring the tool to a pose, from the samples that come nearest, those that are the same once."""
        found: list[FloatArray] = []
        for row in self._nearest(target, tries):
            q = self.solve(target, self.samples[row])
            if q is not None and all(float(np.abs(q - other).max()) > 0.2 for other in found):
                found.append(q)
        return found

    @cached_property
    def samples(self) -> FloatArray:
        """Configurations that represent what the arm can do, shape (n, dof)."""
        sobol = qmc.Sobol(self.dof, scramble=True, seed=self._seed)
        return np.asarray(self.lower + sobol.random_base2(_BATCH) * (self.upper - self.lower))

    @cached_property
    def sampled_poses(self) -> FloatArray:
        """Poses of the tool in `samples`, shape (n, 4, 4)."""
        return np.stack([np.asarray(self._placement(q).homogeneous) for q in self.samples])

    def distances(self, targets: FloatArray) -> FloatArray:
        """Return how far the nearest sample is from poses (n, 4, 4): metres and half metres per radian, shape (n,)."""
        return np.asarray(self._map.query(_features(targets))[0])

    @cached_property
    def shoulder(self) -> FloatArray:
        """Place of the first turning joint that is not upright at home, root frame [m], shape (3,)."""
        pin.forwardKinematics(self.model, self._data, self.full(self.home, 0.0))
        tilting = [joint for joint in self._turning if abs(self._direction(joint)[2]) < 0.7]
        joint = (tilting or self._turning or [1])[0]
        return np.asarray(self._data.oMi[joint].translation).copy()

    @cached_property
    def reach(self) -> float:
        """Distance from the shoulder that the tool seldom exceeds [m]."""
        return float(np.quantile(np.linalg.norm(self.sampled_poses[:, :3, 3] - self.shoulder, axis=1), 0.95))

    @cached_property
    def forward(self) -> float:
        """Direction in which the arm works: that of the tool at home, or of all it reaches, about the upright [rad]."""
        for place in (self.pose(self.home)[:3, 3], self.sampled_poses[:, :3, 3].mean(axis=0)):
            offset = place - self.shoulder
            if float(np.linalg.norm(offset[:2])) > 0.1 * self.reach:
                return float(np.arctan2(offset[1], offset[0]))
        return 0.0

    @property
    def _turning(self) -> list[int]:
        joints = [self.declared.joint_by_name[name] for name in self.robot.arm_joints]
        return [self.model.getJointId(joint.name) for joint in joints if joint.kind.turns]

    def _direction(self, joint: int) -> FloatArray:
        """Axis of a joint at home, root frame, shape (3,)."""
        name = self.model.names[joint]
        return np.asarray(self._data.oMi[joint].rotation @ self.declared.joint_by_name[name].axis)

    @cached_property
    def _map(self) -> KDTree:
        return KDTree(_features(self.sampled_poses))

    def _nearest(self, target: FloatArray, count: int) -> list[int]:
        rows = self._map.query(_features(target[None])[0], k=count)[1]
        return [int(row) for row in np.atleast_1d(rows)]

    def _placement(self, q: FloatArray) -> pin.SE3:
        values = pin.neutral(self.model)
        values[self._rows] = q
        pin.forwardKinematics(self.model, self._data, values)
        return pin.updateFramePlacement(self.model, self._data, self._tool)

    def _reduced(self, model: pin.Model) -> pin.Model:
        """The same model with every joint at rest that is neither of the arm nor of the fingers."""
        moving = {*self.robot.arm_joints, *self.robot.finger_joints}
        locked = [k for k in range(1, model.njoints) if model.names[k] not in moving]
        q = pin.neutral(model)
        for k in range(1, model.njoints):
            joint = model.joints[k]
            if joint.nq == 1:
                low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
                q[joint.idx_q] = min(max(0.0, low), high) if low <= high else 0.0
        return pin.buildReducedModel(model, locked, q)


def damped_step(jacobian: FloatArray, twist: FloatArray, damping: float) -> FloatArray:
    """Joint motion for a twist by damped least squares, shape (dof,)."""
    gram = jacobian @ jacobian.T + damping**2 * np.eye(6)
    return np.asarray(jacobian.T @ np.linalg.solve(gram, twist))


def _features(poses: FloatArray) -> FloatArray:
    """Position and approach direction of poses (n, 4, 4), shape (n, 6); the last joint sees to the rest."""
    return np.concatenate([poses[:, :3, 3], _RADIAN * poses[:, :3, 2]], axis=1)


def _without_endless_joints(robot: Robot) -> Robot:
    """Endless joints as joints of one turn: planners want one number per joint, and limits."""
    return replace(
        robot,
        joints=tuple(
            replace(joint, kind=JointType.REVOLUTE, lower=-np.pi, upper=np.pi, effort=50.0, velocity=1.0)
            if joint.kind is JointType.CONTINUOUS
            else joint
            for joint in robot.joints
        ),
    )
