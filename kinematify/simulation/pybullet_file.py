"""A file in PyBullet as `loadURDF` loads it: its base fixed, its motors as they are."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import pybullet as bullet

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.loaded_file import Progress, Pushed, RestRun, Unloadable, deepest_first

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from kinematify.simulation.loaded_file import Overlap, Push

_LOAD = """import pybullet as p
p.connect(p.DIRECT); p.setGravity(0, 0, -9.81); rest = {values}; push = 0.0
body = p.loadURDF({path!r}, useFixedBase=True, flags=p.URDF_USE_SELF_COLLISION); \
[p.resetJointState(body, k, q) for k, q in rest.items()]
"""
_REST = (
    _LOAD
    + """seen = [p.getJointState(body, {joint})[0] for _ in range({steps}) if p.stepSimulation() is None]
print(min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """p.setJointMotorControl2(body, {joint}, p.VELOCITY_CONTROL, force=0); \
clip = lambda f: min(max(f, -{force!r}), {force!r})
for _ in range({steps}): slow = {speed!r} - p.getJointState(body, {joint})[1]; \
push = clip(push + {integral!r} * slow); \
weight = p.calculateInverseDynamics(body, [p.getJointState(body, k)[0] for k in rest], [0.0] * len(rest), \
[0.0] * len(rest))[{row}]; \
p.setJointMotorControl2(body, {joint}, p.TORQUE_CONTROL, force=weight + clip({proportional!r} * slow + push)); \
p.stepSimulation(); [p.resetJointState(body, k, q) for k, q in rest.items() if k != {joint}]
print(p.getJointState(body, {joint})[0])
"""
)
_TIME_STEP = 1.0 / 240.0
_MOTOR = 240.0
"""Of a joint that was pushed, afterwards [N or N m]: about what motors have when a file is loaded."""


class PybulletFile:
    """See `kinematify.simulation.loaded_file.LoadedFile`; contacts of links are those of `URDF_USE_SELF_COLLISION`."""

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: PyBullet does not open it.
        """
        self._path, self._root, self.time_step = urdf, root, _TIME_STEP
        world = _World(urdf, contacts=True)
        self._worlds = {True: world}
        infos = [world.do(bullet.getJointInfo, k) for k in range(world.do(bullet.getNumJoints))]
        self._links = {-1: root, **{k: info[12].decode() for k, info in enumerate(infos)}}
        self._index = {info[1].decode(): k for k, info in enumerate(infos) if info[2] != bullet.JOINT_FIXED}
        self.joints: Sequence[str] = tuple(self._index)
        self._inertias: dict[str, float] | None = None

    def _world(self, values: Mapping[str, float], *, contacts: bool, as_loaded: bool = False) -> _World:
        """A world as it was after loading, with the joints at `values`; its motors too where that is asked for."""
        world = self._worlds.get(contacts)
        if world is None or (as_loaded and world.pushed):
            world = self._worlds[contacts] = _World(self._path, contacts=contacts)
        bullet.restoreState(world.state, physicsClientId=world.client)
        for name, k in self._index.items():
            world.do(bullet.resetJointState, k, values[name])
        return world

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """See `LoadedFile`."""
        world = self._world(values, contacts=True)
        return self._overlaps(world)

    def _overlaps(self, world: _World) -> tuple[Overlap, ...]:
        bullet.performCollisionDetection(physicsClientId=world.client)
        depths: dict[tuple[str, str], float] = {}
        for contact in world.do(bullet.getContactPoints, world.body):
            first, second = sorted(contact[3:5])
            pair = (self._links[first], self._links[second])
            depths[pair] = max(depths.get(pair, 0.0), -contact[8])
        return deepest_first(depths)

    def rest(self, values: Mapping[str, float], seconds: float, *, contacts: bool) -> RestRun:
        """See `LoadedFile`."""
        world = self._world(values, contacts=contacts, as_loaded=True)
        seen = np.empty((round(seconds / self.time_step), len(self.joints)))
        for row in seen:
            bullet.stepSimulation(physicsClientId=world.client)
            row[:] = [state[0] for state in world.do(bullet.getJointStates, list(self._index.values()))]
        finite = bool(np.isfinite(seen).all())
        return RestRun(values=seen, complaint=None if finite else "the values of joints are no numbers any more")

    def inertia(self, joint: str, values: Mapping[str, float]) -> float:
        """See `LoadedFile`."""
        if self._inertias is None:
            world = self._world(values, contacts=True)
            matrix = np.array(world.do(bullet.calculateMassMatrix, [values[name] for name in self.joints]))
            self._inertias = dict(zip(self.joints, np.diagonal(matrix).tolist(), strict=True))
        return self._inertias[joint]  # the motors of the others hold them within a step

    def push(self, push: Push, values: Mapping[str, float], *, contacts: bool) -> Pushed:
        """See `LoadedFile`."""
        world, joint, row = self._world(values, contacts=contacts), self._index[push.joint], list(self._index)
        held = [(k, values[name]) for name, k in self._index.items() if k != joint]
        world.pushed = True
        world.do(bullet.setJointMotorControl2, joint, bullet.VELOCITY_CONTROL, force=0)
        progress = Progress(start=values[push.joint], push=push, time_step=self.time_step)
        step, grown, still = 0, 0.0, [0.0] * len(row)
        places = list(self._index.values())
        for step in range(1, push.steps + 1):
            states = world.do(bullet.getJointStates, places)
            slow = push.speed - states[row.index(push.joint)][1]
            grown = min(max(grown + push.integral * slow, -push.force), push.force)
            force = min(max(push.proportional * slow + grown, -push.force), push.force)
            weight = world.do(bullet.calculateInverseDynamics, [state[0] for state in states], still, still)
            force += weight[row.index(push.joint)]
            world.do(bullet.setJointMotorControl2, joint, bullet.TORQUE_CONTROL, force=force)
            bullet.stepSimulation(physicsClientId=world.client)
            for k, value in held:
                world.do(bullet.resetJointState, k, value)
            if not progress.goes_on(world.do(bullet.getJointState, joint)[0], step):
                break
        found = self._overlaps(world)
        world.do(bullet.setJointMotorControl2, joint, bullet.VELOCITY_CONTROL, force=_MOTOR)
        return Pushed(farthest=progress.value, steps=step, overlaps=found)

    def lines_of_rest(self, joint: str, values: Mapping[str, float], seconds: float) -> str:
        """See `LoadedFile`."""
        return _REST.format(**self._facts(joint, values), steps=round(seconds / self.time_step))

    def lines_of_push(self, push: Push, values: Mapping[str, float], steps: int) -> str:
        """See `LoadedFile`."""
        row = self.joints.index(push.joint)
        return _PUSH.format(**{**vars(push), **self._facts(push.joint, values), "steps": steps, "row": row})

    def _facts(self, joint: str, values: Mapping[str, float]) -> dict[str, Any]:
        return {
            "path": str(self._path),
            "values": {k: float(values[name]) for name, k in self._index.items()},
            "joint": self._index[joint],
        }


class _World:
    """A world with one file in it."""

    def __init__(self, urdf: Path, *, contacts: bool) -> None:
        self.client, self.pushed = bullet.connect(bullet.DIRECT), False
        weakref.finalize(self, bullet.disconnect, physicsClientId=self.client)
        bullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=self.client)
        flags = bullet.URDF_USE_SELF_COLLISION if contacts else 0
        try:
            self.body = bullet.loadURDF(str(urdf), useFixedBase=True, flags=flags, physicsClientId=self.client)
        except bullet.error as error:
            raise Unloadable(" ".join(str(error).split())) from error
        self.state = bullet.saveState(physicsClientId=self.client)

    def do(self, function: Any, *arguments: Any, **named: Any) -> Any:
        """Call a function of PyBullet for the body."""
        return function(self.body, *arguments, **named, physicsClientId=self.client)
