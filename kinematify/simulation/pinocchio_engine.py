"""Pinocchio, which only reads: the joints of a file, their limits, and where they put every link."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pinocchio as pin

from kinematify.simulation.engine_file import EngineFile, Unloadable

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray

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


class PinocchioFile(EngineFile):
    """See `EngineFile`: a file as `buildModelFromUrdf` reads it, which opens no mesh."""

    code: ClassVar = {"joints": _JOINTS}

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: Pinocchio does not open it, or moves a link in other ways than by turning or sliding.
        """
        del root
        self._file = {"path": str(urdf)}
        try:
            self._model = model = pin.buildModelFromUrdf(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(**self._file)) from error
        if any(joint.nv != 1 for joint in list(model.joints)[1:]):
            raise Unloadable(reproduction=_JOINTS.format(**self._file))
        self.joints = tuple(model.names)[1:]  # the first is the world
        self.limits = {}
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            ends = (float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q]))
            self.limits[name] = ends if joint.nq == 1 else (-np.inf, np.inf)

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """See `EngineFile`; a joint that turns without end is a point on a circle."""
        model, data = self._model, self._model.createData()
        q = pin.neutral(model)
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            value = values[name]
            q[joint.idx_q : joint.idx_q + joint.nq] = (np.cos(value), np.sin(value)) if joint.nq == 2 else value
        pin.framesForwardKinematics(model, data, q)
        frames = zip(model.frames, data.oMf, strict=True)
        return {frame.name: place.homogeneous[:3] for frame, place in frames if frame.type == pin.FrameType.BODY}


FILE = PinocchioFile
