"""Pinocchio, which only reads: the joints of a file, their limits, and where they put every link."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pinocchio as pin

from kinematify.simulation.engine import Unloadable

if TYPE_CHECKING:
    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.world import OpenedFile

_OPEN = """import pinocchio as pin
model = pin.buildModelFromUrdf({path!r})
"""
_JOINTS = (
    _OPEN
    + """for name, joint in zip(list(model.names)[1:], list(model.joints)[1:]): k = joint.idx_q; \
ends = (-float("inf"), float("inf")) if joint.nq == 2 else (model.lowerPositionLimit[k], model.upperPositionLimit[k]); \
print(name, *ends)
"""
)


class PinocchioEngine:
    """Pinocchio, what it can of `Engine`: a file as `buildModelFromUrdf` reads it, which opens no mesh."""

    code: ClassVar = {"joints": _JOINTS}
    keyed = False
    link_code: ClassVar = dict[str, str]()
    time_step = 1.0

    def __init__(self, content: OpenedFile) -> None:
        """Load it.

        Raises:
            Unloadable: Pinocchio does not open it, or moves a link in other ways than by turning or sliding.
        """
        urdf, self.root = content.urdf, content.root
        self.facts = {"path": str(urdf)}
        try:
            self._model = model = pin.buildModelFromUrdf(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(**self.facts)) from error
        if any(joint.nv != 1 for joint in list(model.joints)[1:]):
            raise Unloadable(reproduction=_JOINTS.format(**self.facts))
        self.joints = tuple(model.names)[1:]  # the first is the world
        self.limits = {}
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            ends = (float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q]))
            self.limits[name] = ends if joint.nq == 1 else (-np.inf, np.inf)

        self.joint_code = {name: number for number, name in enumerate(self.joints)}

    def place(self, values: FloatArray, *, contacts: bool) -> None:
        """Implement `Engine`; a joint that turns without end is a point on a circle."""
        del contacts
        self._q = q = pin.neutral(self._model)
        for value, joint in zip(values, list(self._model.joints)[1:], strict=True):
            q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value

    def link_poses(self) -> dict[str, FloatArray]:
        """Implement `Engine`."""
        model, data = self._model, self._model.createData()
        pin.framesForwardKinematics(model, data, self._q)
        frames = zip(model.frames, data.oMf, strict=True)
        return {frame.name: place.homogeneous for frame, place in frames if frame.type == pin.FrameType.BODY}


ENGINE = PinocchioEngine
