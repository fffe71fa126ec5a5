"""A whole engine in one file: each joint moves by itself, stops at its limits, and links pass through each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics
from kinematify.simulation.engine_file import EngineFile, Unloadable
from kinematify.simulation.engines import EngineEntry

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray

ENTRY = EngineEntry(name="point", title="Point", packages=("numpy",), in_module=__name__)


class PointFile(EngineFile):
    """A file: of each joint the mass or the inertia of the link below it counts, and nothing weighs."""

    code: ClassVar = {"joints": "print(open({path!r}).read())\n"}

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: It is no tree.
        """
        del root
        try:
            self._robot = robot = read_robot(urdf, geometry="none")
        except DescriptionError as error:
            raise Unloadable(str(error)) from error
        moving = [joint for joint in robot.joints if joint.kind is not JointType.FIXED]
        self._file, self.time_step = {"path": str(urdf)}, 1e-3
        self.joints = tuple(joint.name for joint in moving)
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

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """See `EngineFile`."""
        return {name: T[:3] for name, T in forward_kinematics(self._robot, dict(values)).items()}

    def begin(
        self,
        values: Mapping[str, float],
        speeds: Mapping[str, float] | None = None,
        *,
        contacts: bool,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """See `EngineFile`; there are no contacts, no gravity and no motors."""
        del contacts, gravity, released
        self._q, self._force = self.row(values), np.zeros(len(self.joints))
        self._v = np.zeros(len(self.joints)) if speeds is None else self.row(speeds)

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """See `EngineFile`."""
        for done in range(1, count + 1):
            self._v += self.time_step * self._force / self._inertia
            q = self._q + self.time_step * self._v
            self._q = np.clip(q, self._low, self._high)
            self._v[self._q != q] = 0.0
            self._force[:] = 0.0
            if done % every == 0:
                yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """See `EngineFile`."""
        return self._q.copy(), self._v.copy()

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """See `EngineFile`."""
        self._q, self._v = q.copy(), v.copy()

    def apply(self, joint: int, force: float) -> None:
        """See `EngineFile`."""
        self._force[joint] = force

    def energy(self) -> tuple[float, float]:
        """See `EngineFile`."""
        return 0.0, float(0.5 * self._inertia @ self._v**2)

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """See `EngineFile`."""
        yield from ()

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """See `EngineFile`."""
        del values
        return self._inertia


FILE = PointFile
