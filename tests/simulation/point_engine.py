"""A whole engine in one file: each joint moves by itself, stops at its limits, and links pass through each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.simulation.engine import Unloadable
from kinematify.simulation.engines import EngineEntry

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.simulation.world import OpenedFile

ENTRY = EngineEntry(name="point", title="Point", packages=("numpy",), in_module=__name__)


class PointEngine:
    """What it can of `Engine`: of each joint the mass or the inertia of the link below it counts, nothing weighs."""

    code: ClassVar = {"joints": "print(open({path!r}).read())\n"}
    keyed, look_steps, time_step = False, 1, 1e-3
    link_code: ClassVar = dict[str, str]()

    def __init__(self, content: OpenedFile) -> None:
        """Load it.

        Raises:
            Unloadable: It is no tree.
        """
        try:
            self._robot = robot = read_robot(content.urdf, geometry="none")
        except DescriptionError as error:
            raise Unloadable(str(error)) from error
        moving = [joint for joint in robot.joints if joint.kind is not JointType.FIXED]
        self.facts, self.root, self.links = {"path": str(content.urdf)}, content.root, ()
        self.joints = tuple(joint.name for joint in moving)
        self.joint_code = {name: number for number, name in enumerate(self.joints)}
        self.limits = {joint.name: (joint.lower, joint.upper) for joint in moving}
        below = [(joint, robot.link_by_name[joint.child].inertial) for joint in moving]
        self._inertia = np.array(
            [
                1.0 if body is None else joint.axis @ body.tensor @ joint.axis if joint.kind.turns else body.mass
                for joint, body in below
            ]
        )
        self._low, self._high = np.array(list(self.limits.values())).reshape(-1, 2).T
        self._q, self._v, self._force = np.zeros((3, len(moving)))

    def place(
        self,
        values: FloatArray,
        *,
        speeds: FloatArray | None = None,
        contacts: bool = True,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Implement `Engine`; there are no contacts, no gravity and no motors."""
        del contacts, gravity, released
        self._q, self._force = values, np.zeros(len(values))
        self._v = np.zeros(len(values)) if speeds is None else speeds

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `Engine`."""
        self._q, self._v = q.copy(), v.copy()

    def step(self, count: int = 1) -> None:
        """Implement `Engine`."""
        for _ in range(count):
            self._v = self._v + self.time_step * self._force / self._inertia
            q = self._q + self.time_step * self._v
            self._q = np.clip(q, self._low, self._high)
            self._v[self._q != q] = 0.0
            self._force[:] = 0.0

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Implement `Engine`."""
        return self._q.copy(), self._v.copy()

    def link_poses(self) -> dict[str, FloatArray]:
        """Implement `Engine`."""
        values = dict(zip(self.joints, self._q.tolist(), strict=True))
        return dict(forward_kinematics(self._robot, values))

    def contacts(self) -> tuple[IntArray, FloatArray]:
        """Implement `Engine`."""
        return np.empty((0, 2), dtype=np.int64), np.empty(0)

    def warnings(self) -> dict[str, int]:
        """Implement `Engine`."""
        return {}

    def energy(self) -> tuple[float, float]:
        """Implement `Engine`."""
        return 0.0, float(0.5 * self._inertia @ self._v**2)

    def inertias(self, values: FloatArray) -> FloatArray:
        """Implement `Engine`."""
        del values
        return self._inertia

    def max_safe_force(self, values: FloatArray) -> FloatArray:
        """Implement `Engine`."""
        return np.full(len(values), np.inf)

    def apply(self, joint: int, force: float) -> None:
        """Implement `Engine`."""
        self._force[joint] = force


ENGINE = PointEngine
