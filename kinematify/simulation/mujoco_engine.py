"""MuJoCo: files as `MjModel.from_xml_path` loads them, and worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import mujoco
import numpy as np

from kinematify.simulation.engine_file import EngineFile, Unloadable
from kinematify.simulation.mujoco_world import MujocoWorld

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.world import WorldSpec


def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> MujocoFile:
    """Load a file as users do; MuJoCo knows no packages."""
    del package_dirs
    return MujocoFile(urdf, root)


def open_world(spec: WorldSpec) -> MujocoWorld:
    """Build a world that runs."""
    return MujocoWorld(spec)


_OPEN = """import mujoco, numpy as np
model = mujoco.MjModel.from_xml_path({path!r})
"""
_JOINTS = (
    _OPEN
    + """for k in range(model.njnt): ends = model.jnt_range[k] if model.jnt_limited[k] else (-np.inf, np.inf); \
print(model.joint(k).name, *ends)
"""
)
_LOAD = """import mujoco, numpy as np
model = mujoco.MjModel.from_xml_path({path!r}); data = mujoco.MjData(model)
data.qpos[:] = {values}; mujoco.mj_forward(model, data); rest = data.qpos.copy(); push = 0.0
"""
_NO_CONTACTS = "model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT\n"
_OVERLAP = (
    _LOAD
    + """name = lambda geom: model.body(model.geom_bodyid[geom]).name
print(max(-contact.dist for contact in data.contact if {{name(geom) for geom in contact.geom}} == set({links})))
"""
)
_REST = (
    _LOAD
    + """seen = [data.qpos[{joint}] for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """{off}model.opt.gravity[:] = 0.0; seen = [rest[{joint}]]
moved, ratios, weights = {moved}, np.array({ratios}), np.array({weights})
for _ in range({steps}): slow = {speed!r} - data.qvel[{joint}]; \
push = np.clip(push + {integral!r} * slow, -{force!r}, {force!r}); \
data.qfrc_applied[{joint}] = np.clip({proportional!r} * slow + push, -{force!r}, {force!r}); \
mujoco.mj_step(model, data); \
way, speed = weights @ (data.qpos - rest)[moved], weights @ data.qvel[moved]; \
data.qpos[:] = rest; data.qvel[:] = 0.0; data.qpos[moved] += ratios * way; data.qvel[moved] = ratios * speed; \
seen.append(data.qpos[{joint}])
print({farthest}(seen))
"""
)
_RELEASE = (
    _LOAD
    + _NO_CONTACTS
    + """model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY; data.qvel[:] = {speeds}
seen = [sum(data.energy) for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(max(seen) - seen[0])
"""
)


class MujocoFile(EngineFile):
    """Raw model: a file as `MjModel.from_xml_path` loads it."""

    code: ClassVar = {
        "joints": _JOINTS,
        "overlap": _OVERLAP,
        "rest": _REST,
        "push": _PUSH.replace("{off}", ""),
        "push_alone": _PUSH.replace("{off}", _NO_CONTACTS),
        "release": _RELEASE,
    }

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: MuJoCo does not open it, or moves a link in other ways than by turning or sliding.
        """
        self._file, self._root = {"path": str(urdf)}, root
        try:
            self._model = mujoco.MjModel.from_xml_path(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(path=str(urdf))) from error
        if self._model.nq != self._model.nv or self._model.nv != self._model.njnt:
            raise Unloadable(reproduction=_OPEN.format(path=str(urdf)) + "print(model.jnt_type)\n")
        self._data, option = mujoco.MjData(self._model), self._model.opt
        self._flags, self._gravity = option.disableflags, option.gravity.copy()
        option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self.joints = tuple(self._model.joint(k).name for k in range(self._model.njnt))
        ranges = zip(self.joints, self._model.jnt_limited, self._model.jnt_range.tolist(), strict=True)
        self.limits = {name: tuple(ends) if limited else (-np.inf, np.inf) for name, limited, ends in ranges}
        self.time_step = float(option.timestep)

    def begin(
        self,
        values: Mapping[str, float],
        speeds: Mapping[str, float] | None = None,
        *,
        contacts: bool,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """Implement `EngineFile`; MuJoCo gives a URDF no motors."""
        del released
        model, data, option = self._model, self._data, self._model.opt
        option.disableflags, option.gravity[:] = self._flags, self._gravity
        mujoco.mj_resetData(model, data)
        data.qpos[:] = self.row(values)
        mujoco.mj_forward(model, data)
        data.qvel[:] = 0.0 if speeds is None else self.row(speeds)
        mujoco.mj_energyVel(model, data)
        option.disableflags |= 0 if contacts else int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        option.gravity[:] *= gravity

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """Implement `EngineFile`; links that fixed joints join are one."""
        self.begin(values, contacts=False)
        bodies = map(self._data.body, range(1, self._model.nbody))
        return {body.name: np.column_stack([body.xmat.reshape(3, 3), body.xpos]) for body in bodies}

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """Implement `EngineFile`."""
        for done in range(every, count + 1, every):
            mujoco.mj_step(self._model, self._data, nstep=every)
            yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Implement `EngineFile`."""
        return self._data.qpos.copy(), self._data.qvel.copy()

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `EngineFile`."""
        self._data.qpos[:], self._data.qvel[:] = q, v

    def apply(self, joint: int, force: float) -> None:
        """Implement `EngineFile`."""
        self._data.qfrc_applied[joint] = force

    def energy(self) -> tuple[float, float]:
        """Implement `EngineFile`; of the state before the last step."""
        return float(self._data.energy[0]), float(self._data.energy[1])

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """Implement `EngineFile`."""
        mujoco.mj_forward(self._model, self._data)
        for contact in self._data.contact:
            bodies = sorted(int(self._model.geom_bodyid[geom]) for geom in contact.geom)
            first, second = (self._model.body(body).name if body else self._root for body in bodies)
            yield first, second, -float(contact.dist)

    @property
    def complaint(self) -> str | None:
        """Warnings of numbers that are none."""
        bad = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
        broken = [item.name.removeprefix("mjWARN_") for item in bad if self._data.warning[item].number]
        return f"MuJoCo warns {', '.join(broken)}" if broken else None

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """Implement `EngineFile`."""
        self.begin(values, contacts=True)
        inverse = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_solveM(self._model, self._data, inverse, np.eye(self._model.nv))
        return np.asarray(1.0 / np.diagonal(inverse))

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return sorted({"world" if name == self._root else name for name in links})
