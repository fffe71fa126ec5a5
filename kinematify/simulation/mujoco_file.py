"""A file in MuJoCo as `MjModel.from_xml_path` loads it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import mujoco
import numpy as np

from kinematify.simulation.loaded_file import Progress, Pushed, RestRun, Unloadable, deepest_first

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.loaded_file import Overlap, Push

_LOAD = """import mujoco, numpy as np
model = mujoco.MjModel.from_xml_path({path!r}); data = mujoco.MjData(model)
data.qpos[:] = {values}; mujoco.mj_forward(model, data); rest = data.qpos.copy(); push = 0.0
"""
_REST = (
    _LOAD
    + """seen = [data.qpos[{joint}] for _ in range({steps}) if mujoco.mj_step(model, data) is None]
print(min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """for _ in range({steps}): slow = {speed!r} - data.qvel[{joint}]; \
push = np.clip(push + {integral!r} * slow, -{force!r}, {force!r}); \
data.qfrc_applied[:] = data.qfrc_bias; \
data.qfrc_applied[{joint}] += np.clip({proportional!r} * slow + push, -{force!r}, {force!r}); \
mujoco.mj_step(model, data); \
data.qpos[:] = np.where(np.arange(model.nq) == {joint}, data.qpos, rest); \
data.qvel[:] = np.where(np.arange(model.nv) == {joint}, data.qvel, 0.0)
print(data.qpos[{joint}])
"""
)


class MujocoFile:
    """See `kinematify.simulation.loaded_file.LoadedFile`."""

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: MuJoCo does not open it, or moves a link in other ways than by turning or sliding.
        """
        self._path, self._root = urdf, root
        try:
            self._model = mujoco.MjModel.from_xml_path(str(urdf))
        except ValueError as error:
            raise Unloadable(" ".join(str(error).split())) from error
        if self._model.nq != self._model.nv or self._model.nv != self._model.njnt:
            raise Unloadable("it gives links other joints than hinges and slides")
        self._data = mujoco.MjData(self._model)
        self.joints: Sequence[str] = tuple(self._model.joint(k).name for k in range(self._model.njnt))
        self.time_step = float(self._model.opt.timestep)

    def _place(self, values: Mapping[str, float]) -> FloatArray:
        mujoco.mj_resetData(self._model, self._data)
        rest = np.array([values[name] for name in self.joints])
        self._data.qpos[:] = rest
        mujoco.mj_forward(self._model, self._data)
        return rest

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """See `LoadedFile`."""
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

    def rest(self, values: Mapping[str, float], seconds: float, *, contacts: bool) -> RestRun:
        """See `LoadedFile`."""
        self._place(values)
        seen = np.empty((round(seconds / self.time_step), self._model.nq))
        flags = self._model.opt.disableflags
        if not contacts:
            self._model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        for row in seen:
            mujoco.mj_step(self._model, self._data)
            row[:] = self._data.qpos
        self._model.opt.disableflags = flags
        warned = [mujoco.mjtWarning(k) for k, item in enumerate(self._data.warning) if item.number]
        bad = {mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC}
        broken = [item.name.removeprefix("mjWARN_") for item in warned if item in bad]
        return RestRun(values=seen, complaint=f"MuJoCo warns {', '.join(broken)}" if broken else None)

    def inertia(self, joint: str, values: Mapping[str, float]) -> float:
        """See `LoadedFile`."""
        self._place(values)
        unit = np.zeros((1, self._model.nv))
        unit[0, self.joints.index(joint)] = 1.0
        answer = np.zeros_like(unit)
        mujoco.mj_solveM(self._model, self._data, answer, unit)
        return 1.0 / float(answer[0, self.joints.index(joint)])

    def push(self, push: Push, values: Mapping[str, float], *, contacts: bool) -> Pushed:
        """See `LoadedFile`."""
        rest, joint, data = self._place(values), self.joints.index(push.joint), self._data
        held = np.arange(self._model.nv) != joint
        progress = Progress(start=values[push.joint], push=push, time_step=self.time_step)
        flags = self._model.opt.disableflags
        if not contacts:
            self._model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        step, grown = 0, 0.0
        for step in range(1, push.steps + 1):
            slow = push.speed - float(data.qvel[joint])
            grown = min(max(grown + push.integral * slow, -push.force), push.force)
            force = min(max(push.proportional * slow + grown, -push.force), push.force)
            data.qfrc_applied[:] = data.qfrc_bias  # what holds the others bears their weight too
            data.qfrc_applied[joint] += force
            mujoco.mj_step(self._model, data)
            data.qpos[held], data.qvel[held] = rest[held], 0.0
            if not progress.goes_on(float(data.qpos[joint]), step):
                break
        found = self._overlaps()
        self._model.opt.disableflags = flags
        return Pushed(farthest=progress.value, steps=step, overlaps=found)

    def lines_of_rest(self, joint: str, values: Mapping[str, float], seconds: float) -> str:
        """See `LoadedFile`."""
        steps = round(seconds / self.time_step)
        return _REST.format(**self._facts(joint, values), steps=steps)

    def lines_of_push(self, push: Push, values: Mapping[str, float], steps: int) -> str:
        """See `LoadedFile`."""
        return _PUSH.format(**{**vars(push), **self._facts(push.joint, values), "steps": steps})

    def _facts(self, joint: str, values: Mapping[str, float]) -> dict[str, object]:
        return {
            "path": str(self._path),
            "values": [float(values[name]) for name in self.joints],
            "joint": self.joints.index(joint),
        }
