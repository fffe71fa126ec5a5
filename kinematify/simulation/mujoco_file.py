"""A file in MuJoCo as `MjModel.from_xml_path` loads it."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.simulation.raw_model import (
    MovesFreely,
    Pushed,
    PushProgress,
    ReleaseRun,
    Reproductions,
    RestRun,
    RunningFile,
    Unloadable,
    deepest_first,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.raw_model import Overlap, Push

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


class MujocoFile(RunningFile):
    """See `RunningFile`."""

    code = Reproductions(
        joints=_JOINTS,
        overlap=_OVERLAP,
        rest=_REST,
        push=_PUSH.replace("{off}", ""),
        push_alone=_PUSH.replace("{off}", _NO_CONTACTS),
        release=_RELEASE,
    )

    def __init__(self, urdf: Path, root: str, package_dirs: Sequence[Path] = ()) -> None:
        """Load it; MuJoCo knows no packages.

        Raises:
            Unloadable: MuJoCo does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        del package_dirs
        self._file, self._root = {"path": str(urdf)}, root
        try:
            self._model = mujoco.MjModel.from_xml_path(str(urdf))
        except ValueError as error:
            raise Unloadable(str(error), _OPEN.format(path=str(urdf))) from error
        if self._model.nq != self._model.nv or self._model.nv != self._model.njnt:
            raise MovesFreely(_OPEN.format(path=str(urdf)) + "print(model.jnt_type)\n")
        self._data = mujoco.MjData(self._model)
        self.joints = tuple(self._model.joint(k).name for k in range(self._model.njnt))
        ranges = zip(self.joints, self._model.jnt_limited, self._model.jnt_range.tolist(), strict=True)
        self.limits = {name: tuple(ends) if limited else (-np.inf, np.inf) for name, limited, ends in ranges}
        self.time_step = float(self._model.opt.timestep)

    def _place(self, values: Mapping[str, float]) -> FloatArray:
        mujoco.mj_resetData(self._model, self._data)
        rest = np.array([values[name] for name in self.joints])
        self._data.qpos[:] = rest
        mujoco.mj_forward(self._model, self._data)
        return rest

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """See `RunningFile`."""
        self._place(values)
        return self._overlaps()

    def _overlaps(self) -> tuple[Overlap, ...]:
        mujoco.mj_forward(self._model, self._data)
        depths: dict[tuple[str, str], float] = {}
        for contact in self._data.contact:
            bodies = sorted(int(self._model.geom_bodyid[geom]) for geom in contact.geom)
            names = [self._model.body(body).name if body else self._root for body in bodies]
            pair = (names[0], names[1])
            depths[pair] = max(depths.get(pair, 0.0), -float(contact.dist))
        return deepest_first(depths)

    @contextmanager
    def _without(self, *, contacts: bool, gravity: bool = False) -> Iterator[None]:
        """Switch contacts or gravity off for a run."""
        option = self._model.opt
        flags, down = option.disableflags, option.gravity.copy()
        option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT) if contacts else 0
        option.gravity[:] *= not gravity
        yield
        option.disableflags, option.gravity[:] = flags, down

    def _complaint(self) -> str | None:
        """Warnings of numbers that are none."""
        bad = (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
        broken = [item.name.removeprefix("mjWARN_") for item in bad if self._data.warning[item].number]
        return f"MuJoCo warns {', '.join(broken)}" if broken else None

    def rest(self, values: Mapping[str, float], seconds: float, *, contacts: bool) -> RestRun:
        """See `RunningFile`."""
        self._place(values)
        seen = np.empty((round(seconds / self.time_step), self._model.nq))
        with self._without(contacts=not contacts):
            for row in seen:
                mujoco.mj_step(self._model, self._data)
                row[:] = self._data.qpos
        return RestRun(values=seen, complaint=self._complaint())

    def release(self, values: Mapping[str, float], speeds: Mapping[str, float], seconds: float) -> ReleaseRun:
        """See `RunningFile`."""
        self._place(values)
        self._data.qvel[:] = [speeds[name] for name in self.joints]
        seen = np.empty((round(seconds / self.time_step), 2))
        self._model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        with self._without(contacts=True):
            for row in seen:
                mujoco.mj_step(self._model, self._data)
                row[:] = self._data.energy  # of the state before the step
        self._model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        return ReleaseRun(energy=seen, complaint=self._complaint())

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """See `RunningFile`."""
        self._place(values)
        inverse = np.zeros((self._model.nv, self._model.nv))
        mujoco.mj_solveM(self._model, self._data, inverse, np.eye(self._model.nv))
        return np.asarray(1.0 / np.diagonal(inverse))

    def push(self, push: Push, values: Mapping[str, float], *, contacts: bool) -> Pushed:
        """See `RunningFile`."""
        rest, joint, data = self._place(values), self.joints.index(push.joint), self._data
        moved = [self.joints.index(name) for name in push.moved]
        ratios, weights = np.array(push.ratios), np.array(push.weights)
        progress = PushProgress(start=values[push.joint], push=push, time_step=self.time_step)
        step = 0
        with self._without(contacts=not contacts, gravity=True):
            for step in range(1, push.steps + 1):
                data.qfrc_applied[joint] = progress.force(float(data.qvel[joint]))
                mujoco.mj_step(self._model, data)
                way, speed = weights @ (data.qpos - rest)[moved], weights @ data.qvel[moved]
                data.qpos[:], data.qvel[:] = rest, 0.0
                data.qpos[moved] += ratios * way
                data.qvel[moved] = ratios * speed
                if not progress.goes_on(float(data.qpos[joint]), step):
                    break
            found = self._overlaps()
        return Pushed(farthest=progress.value, steps=step, overlaps=found)

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return sorted({"world" if name == self._root else name for name in links})
