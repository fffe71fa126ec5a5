"""Pinocchio, which only reads: the joints of a file and their limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from kinematify.simulation.raw_model import MovesFreely, RawEngineModel, Reproductions, Unloadable

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

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


def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> PinocchioFile:
    """Load a file as users do."""
    del root, package_dirs
    return PinocchioFile(urdf)


class PinocchioFile(RawEngineModel):
    """See `RawEngineModel`: a file as `buildModelFromUrdf` reads it, which opens no mesh."""

    code = Reproductions(joints=_JOINTS)

    def __init__(self, urdf: Path) -> None:
        """Load it.

        Raises:
            Unloadable: Pinocchio does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        self._file = {"path": str(urdf)}
        try:
            model = pin.buildModelFromUrdf(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(**self._file)) from error
        if any(joint.nv != 1 for joint in list(model.joints)[1:]):
            raise MovesFreely(_JOINTS.format(**self._file))
        self.joints = tuple(model.names)[1:]  # the first is the world
        self.limits = {}
        for name, joint in zip(self.joints, list(model.joints)[1:], strict=True):
            ends = (float(model.lowerPositionLimit[joint.idx_q]), float(model.upperPositionLimit[joint.idx_q]))
            self.limits[name] = ends if joint.nq == 1 else (-np.inf, np.inf)
