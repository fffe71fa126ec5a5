"""A file in MuJoCo as an object on a floor: nothing holds its base."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.simulation.engine_file import Unloadable

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

_PART = "object "
_FAR = 1e3
"""Height above the floor from which an object is let down [m]."""


def stand(urdf: Path, values: Mapping[str, float], seconds: float) -> dict[str, float]:
    """Set a file on a floor with its lowest point, and leave it alone.

    Args:
        urdf: The file.
        values: Of its joints [rad or m].
        seconds: How long.

    Returns:
        How far its base has moved [m] and turned [rad], how deep the deepest contact is [m], and how many contacts
        there are with the floor.

    Raises:
        Unloadable: MuJoCo does not build it, such as without any mass.
    """
    try:
        world, source = mujoco.MjSpec(), mujoco.MjSpec.from_file(str(urdf))
        source.compiler.fusestatic = False
        world.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0.0, 0.0, 1.0])
        base = world.worldbody.add_body()
        base.add_freejoint()
        world.attach(source, prefix=_PART, frame=base.add_frame())
        model = world.compile()
    except ValueError as error:
        raise Unloadable(str(error)) from error
    data = mujoco.MjData(model)
    for name, value in values.items():
        data.qpos[model.joint(_PART + name).qposadr] = value
    data.qpos[2] = _FAR
    mujoco.mj_forward(model, data)
    gaps = [mujoco.mj_geomDistance(model, data, 0, geom, 2.0 * _FAR, None) for geom in range(1, model.ngeom)]
    data.qpos[2] -= min(gaps, default=_FAR)
    start, turn = data.qpos[:7].copy(), np.zeros(3)
    mujoco.mj_step(model, data, nstep=round(seconds / model.opt.timestep))
    mujoco.mju_subQuat(turn, data.qpos[3:7], start[3:])
    return {
        "moved": float(np.linalg.norm(data.qpos[:3] - start[:3])),
        "turned": float(np.linalg.norm(turn)),
        "deepest": max((-float(contact.dist) for contact in data.contact), default=0.0),
        "on_floor": float(sum(0 in contact.geom for contact in data.contact)),
    }
