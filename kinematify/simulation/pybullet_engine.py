"""PyBullet: files as `loadURDF` loads them, their base fixed, their motors as they are, and worlds."""

from __future__ import annotations

import ctypes
import os
import re
import tempfile
from contextlib import suppress
from itertools import combinations
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pybullet as bullet

from kinematify.robot.urdf_numbers import passing_links
from kinematify.robot.urdf_text import parse_description
from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.engine_file import EngineFile, Unloadable
from kinematify.simulation.pybullet_body import Client, text_of
from kinematify.simulation.pybullet_world import PybulletWorld

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.simulation.engine_file import Push
    from kinematify.simulation.world import WorldSpec


def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> PybulletFile:
    """Load a file as users do; PyBullet looks for packages by itself."""
    del package_dirs
    return PybulletFile(urdf, root)


def open_world(spec: WorldSpec) -> PybulletWorld:
    """Build a world that runs."""
    return PybulletWorld(spec)


def _without_contacts(lines: str) -> str:
    """Code in which links pass through each other."""
    return lines.replace("p.URDF_USE_SELF_COLLISION", "0")


_LOAD = """import pybullet as p
p.connect(p.DIRECT); p.setGravity(0, 0, -9.81); rest = {values}; push = 0.0
body = p.loadURDF({path!r}, useFixedBase=True, flags=p.URDF_USE_SELF_COLLISION); \
[p.resetJointState(body, k, q) for k, q in rest.items()]; \
[p.setCollisionFilterPair(body, body, a, b, 0) for a, b in {silent}]
"""
_OPEN = """import pybullet as p
p.connect(p.DIRECT); body = p.loadURDF({path!r}, useFixedBase=True)
"""
_JOINTS = (
    _OPEN
    + """joints = [p.getJointInfo(body, k) for k in range(p.getNumJoints(body))]
for info in joints: ends = info[8:10] if info[8] <= info[9] else (-float("inf"), float("inf")); \
info[2] == p.JOINT_FIXED or print("\\n", info[1].decode(), *ends)
"""
)
_OVERLAP = (
    _LOAD
    + """p.performCollisionDetection()
print("\\n", max(-contact[8] for contact in p.getContactPoints(body, body) if set(contact[3:5]) == {links}))
"""
)
_REST = (
    _LOAD
    + """seen = [p.getJointState(body, {joint})[0] for _ in range({steps}) if not p.stepSimulation()]
print("\\n", min(seen), max(seen))
"""
)
_PUSH = (
    _LOAD
    + """p.setGravity(0, 0, 0); moved, clip = {moved}, lambda f: min(max(f, -{force!r}), {force!r})
seen = [rest[{joint}]]; [p.setJointMotorControl2(body, k, p.VELOCITY_CONTROL, force=0) for k, _, _ in moved]
for _ in range({steps}): slow = {speed!r} - p.getJointState(body, {joint})[1]; \
push = clip(push + {integral!r} * slow); \
p.setJointMotorControl2(body, {joint}, p.TORQUE_CONTROL, force=clip({proportional!r} * slow + push)); \
p.stepSimulation(); state = {{k: p.getJointState(body, k) for k in rest}}; \
way = sum(w * (state[k][0] - rest[k]) for k, _, w in moved); speed = sum(w * state[k][1] for k, _, w in moved); \
ratio = {{k: r for k, r, _ in moved}}; \
[p.resetJointState(body, k, q + ratio.get(k, 0) * way, ratio.get(k, 0) * speed) for k, q in rest.items()]; \
seen.append(p.getJointState(body, {joint})[0])
print("\\n", {farthest}(seen))
"""
)
_RELEASE = (
    _without_contacts(_LOAD)
    + """import numpy as np
[p.resetJointState(body, k, rest[k], v) for k, v in {speeds}.items()]
[p.setJointMotorControl2(body, k, p.VELOCITY_CONTROL, force=0) for k in rest]; links = range(p.getNumJoints(body))
local = lambda s: np.reshape(p.getMatrixFromQuaternion(s[1]), (3, 3)).T @ s[7]
energy = lambda: sum(d[0] * (9.81 * s[0][2] + 0.5 * np.dot(s[6], s[6])) + 0.5 * np.dot(d[2], local(s)**2) \
for d, s in ((p.getDynamicsInfo(body, k), p.getLinkState(body, k, 1, 1)) for k in links))
seen = [energy()] + [energy() for k in range({steps}) if not p.stepSimulation() and k % {looks} == {looks} - 1]
print("\\n", max(seen) - seen[0])
"""
)
_MARK = re.compile(r"b3(?:Warning|Error)\[[^\]]*\]:")
"""Before each message that PyBullet prints."""
_NO_FAULT = "No inertial data"
"""Beginning of what it prints of many files that it loads."""
_TIME_STEP = 1.0 / 240.0
_FASTEST = 100.0
"""Speed that Bullet lets no joint exceed [rad/s or m/s]."""
_MOTOR = 240.0
"""Of a joint that was pushed, afterwards [N or N m]: about what motors have when a file is loaded."""


class PybulletFile(EngineFile):
    """See `EngineFile`: a file as `loadURDF` loads it, its base fixed, its motors as they are.

    Contacts of links are those of `URDF_USE_SELF_COLLISION`, but for links that fixed joints alone hold together, for
    those of neighbours (as `URDF_MERGE_FIXED_LINKS` has it), and for links that the file declares not to collide with
    their own model.
    """

    code: ClassVar = {
        "joints": _JOINTS,
        "overlap": _OVERLAP,
        "rest": _REST,
        "push": _PUSH,
        "push_alone": _without_contacts(_PUSH),
        "release": _RELEASE.replace("{looks}", "8"),
    }

    look_steps = 8

    def __init__(self, urdf: Path, root: str) -> None:
        """Load it.

        Raises:
            Unloadable: PyBullet does not open it.
        """
        self._path, self._root, self.time_step = urdf, root, _TIME_STEP
        self._passing = passing_links(parse_description(urdf))
        world = self._opened(contacts=True, seen=True)
        self._now, self._worlds = world, {True: world}
        self._file = {"path": str(urdf), "silent": world.ignored_pairs}
        infos, self._links = world.infos, world.links
        self._index = {text_of(info[1]): k for k, info in enumerate(infos) if info[2] != bullet.JOINT_FIXED}
        self._places = list(self._index.values())
        self.joints = tuple(self._index)
        self.limits = {
            name: infos[k][8:10] if infos[k][8] <= infos[k][9] else (-np.inf, np.inf) for name, k in self._index.items()
        }
        above = {k: info[16] for k, info in enumerate(infos)}
        self._below = {k: [link for link in above if k in _chain(above, link)] for k in self._index.values()}

    def begin(
        self,
        values: Mapping[str, float],
        speeds: Mapping[str, float] | None = None,
        *,
        contacts: bool,
        gravity: bool = True,
        released: Sequence[int] | None = None,
    ) -> None:
        """See `EngineFile`: the world as it was after loading; motors of joints that were released are put back."""
        world = self._worlds.get(contacts)
        if world is None or (released is None and world.pushed):
            world = self._opened(contacts=contacts, seen=False)
        self._now = self._worlds[contacts] = world
        world.client.restoreState(world.state)
        for name, k in self._index.items():
            world.client.resetJointState(world.body, k, values[name], 0.0 if speeds is None else speeds[name])
        world.client.setGravity(0.0, 0.0, -GRAVITY if gravity else 0.0)
        freed = [self._places[number] for number in released or ()]
        for k in world.freed - set(freed):
            world.client.setJointMotorControl2(world.body, k, bullet.VELOCITY_CONTROL, force=_MOTOR)
        for k in freed:
            world.client.setJointMotorControl2(world.body, k, bullet.VELOCITY_CONTROL, force=0)
        world.freed, world.pushed = set(freed), world.pushed or bool(freed)

    def _opened(self, *, contacts: bool, seen: bool) -> _LoadedWorld:
        return _LoadedWorld(self._path, contacts=contacts, seen=seen, root=self._root, passing=self._passing)

    def poses(self, values: Mapping[str, float]) -> dict[str, FloatArray]:
        """See `EngineFile`; of all links but the base."""
        self.begin(values, contacts=True)
        world, links = self._now, [link for link in self._links if link != -1]
        states = world.client.getLinkStates(world.body, links, computeForwardKinematics=True) if links else ()
        return {
            self._links[link]: np.column_stack([np.reshape(bullet.getMatrixFromQuaternion(state[5]), (3, 3)), state[4]])
            for link, state in zip(links, states, strict=True)
        }

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """See `EngineFile`."""
        for done in range(1, count + 1):
            self._now.client.stepSimulation()
            if done % every == 0:
                yield done

    def state(self) -> tuple[FloatArray, FloatArray]:
        """See `EngineFile`."""
        states = self._now.client.getJointStates(self._now.body, self._places)
        return np.array([state[0] for state in states]), np.array([state[1] for state in states])

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """See `EngineFile`."""
        self._now.client.resetJointStatesMultiDof(
            self._now.body, self._places, q[:, None].tolist(), v[:, None].tolist()
        )

    def apply(self, joint: int, force: float) -> None:
        """See `EngineFile`."""
        self._now.client.setJointMotorControl2(self._now.body, self._places[joint], bullet.TORQUE_CONTROL, force=force)

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """See `EngineFile`."""
        world = self._now
        world.client.performCollisionDetection()
        for contact in world.client.getContactPoints(world.body, world.body):
            first, second = sorted(contact[3:5])
            yield self._links[first], self._links[second], -contact[8]

    def energy(self) -> tuple[float, float]:
        """See `EngineFile`; of all links but the base."""
        world, links = self._now, [link for link in self._links if link != -1]
        states = world.client.getLinkStates(world.body, links, computeLinkVelocity=True, computeForwardKinematics=True)
        potential = kinetic = 0.0
        for link, state in zip(links, states, strict=True):
            mass, _, tensor, *_ = world.client.getDynamicsInfo(world.body, link)
            turning = np.reshape(bullet.getMatrixFromQuaternion(state[1]), (3, 3)).T @ state[7]
            potential += GRAVITY * mass * state[0][2]
            kinetic += 0.5 * (mass * np.dot(state[6], state[6]) + np.dot(tensor, turning**2))
        return potential, float(kinetic)

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """See `EngineFile`; the motors of the others hold them within a step."""
        self.begin(values, contacts=True, released=())
        return np.array([self._inertia(self._now, k) for k in self._places])

    def _inertia(self, world: _LoadedWorld, joint: int) -> float:
        """Of what hangs on a joint; PyBullet's own mass matrix fails where a tensor is unsymmetric by 1e-13."""
        info = world.client.getJointInfo(world.body, joint)
        frame = world.client.getLinkState(world.body, joint, computeForwardKinematics=True)
        axis = np.array(bullet.rotateVector(frame[5], info[13]))
        total = 0.0
        for link in self._below[joint]:
            mass, _, tensor, *_ = world.client.getDynamicsInfo(world.body, link)
            centre, turned, *_ = world.client.getLinkState(world.body, link, computeForwardKinematics=True)
            if info[2] == bullet.JOINT_PRISMATIC:
                total += mass
                continue
            arm = np.cross(axis, np.subtract(centre, frame[4]))
            local = np.array(bullet.getMatrixFromQuaternion(turned)).reshape(3, 3).T @ axis
            total += mass * float(arm @ arm) + float(local @ (np.array(tensor) * local))
        return total

    def max_safe_force(self, values: Mapping[str, float]) -> FloatArray:
        """See `EngineFile`.

        Bullet lets no joint be faster than 100 rad/s within a step either, before motors hold the others: a joint that
        is light where those give way is thrown back by more.
        """
        torques, speeds = 1e-2 * self.inertias(values), []
        self.begin(values, contacts=False, gravity=False, released=range(len(self._places)))
        for joint, torque in enumerate(torques.tolist()):
            for k, value in zip(self._places, self.row(values).tolist(), strict=True):
                self._now.client.resetJointState(self._now.body, k, value)
            self.apply(joint, torque)
            self._now.client.stepSimulation()
            speeds.append(abs(float(self.state()[1][joint])))
        del self._worlds[False]
        return 0.5 * _FASTEST * torques / np.maximum(speeds, 1e-12)

    def motor(self, joint: str, values: Mapping[str, float], target: float, seconds: float) -> float:
        """See `EngineFile`; the motors of the other joints hold them, gravity is off."""
        self.begin(values, contacts=False, gravity=False, released=())
        for name, k in self._index.items():
            wanted = target if name == joint else values[name]
            self._now.client.setJointMotorControl2(self._now.body, k, bullet.POSITION_CONTROL, targetPosition=wanted)
        sign, farthest, index = np.sign(target - values[joint]), values[joint], self._index[joint]
        for _ in self.steps(self._steps(seconds)):
            farthest = sign * max(sign * farthest, sign * self._now.client.getJointState(self._now.body, index)[0])
        del self._worlds[False]  # its motors are others than those of the file as it is loaded
        return float(sign * min(sign * farthest, sign * target))

    def _script_values(self, values: Mapping[str, float]) -> object:
        return {k: float(values[name]) for name, k in self._index.items()}

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return {k for k, name in self._links.items() if name in links}

    def _index_of(self, joint: str) -> int:
        return self._index[joint]

    def _moved_in_code(self, push: Push) -> object:
        return list(zip([self._index[name] for name in push.moved], push.ratios, push.weights, strict=True))


def _chain(above: Mapping[int, int], link: int) -> list[int]:
    """A link and all that it hangs on but the base."""
    return [] if link == -1 else [link, *_chain(above, above[link])]


def _printed(load: Callable[[], object]) -> str:
    """What PyBullet prints of a file while it refuses it; its exception does not say why."""
    library, streams = ctypes.CDLL(None), (1, 2)
    kept = [os.dup(stream) for stream in streams]
    with tempfile.TemporaryFile() as file:
        try:
            for stream in streams:
                os.dup2(file.fileno(), stream)
            with suppress(bullet.error):
                load()
            library.fflush(None)
        finally:
            for stream, copy in zip(streams, kept, strict=True):
                os.dup2(copy, stream)
                os.close(copy)
        file.seek(0)
        said = _MARK.split(file.read().decode("utf-8", "replace"))
    words = [" ".join(item.split()) for item in said]
    return "; ".join(item for item in dict.fromkeys(words) if item and not item.startswith(_NO_FAULT))


class _LoadedWorld:
    """A world with one file in it."""

    def __init__(self, urdf: Path, *, contacts: bool, seen: bool, root: str, passing: frozenset[str]) -> None:
        """Load a file.

        Args:
            urdf: The file.
            contacts: Links collide with each other.
            seen: With its visual geometry, which takes nearly all of the time and moves nothing.
            root: Name of the first link.
            passing: Links that collide with no other one.
        """
        self.client, self.pushed = Client(), False
        self.freed: set[int] = set()
        """Joints without motors now; `pushed`: some were so once."""
        self.client.setGravity(0.0, 0.0, -GRAVITY)
        flags = (bullet.URDF_USE_SELF_COLLISION if contacts else 0) | (0 if seen else bullet.URDF_IGNORE_VISUAL_SHAPES)
        try:
            self.body = self.client.loadURDF(str(urdf), useFixedBase=True, flags=flags)
        except bullet.error as error:
            printed = _printed(lambda: self.client.loadURDF(str(urdf), flags=flags))
            words = f"{error} It prints: {printed}" if printed else str(error)
            raise Unloadable(words, _OPEN.format(path=str(urdf))) from error
        self.infos = [self.client.getJointInfo(self.body, k) for k in range(self.client.getNumJoints(self.body))]
        self.links = {-1: root, **{k: text_of(info[12]) for k, info in enumerate(self.infos)}}
        self.ignored_pairs = self._silent_pairs(passing) if contacts else []
        """Indices of two links each that do not collide."""
        for first, second in self.ignored_pairs:
            self.client.setCollisionFilterPair(self.body, self.body, first, second, 0)
        self.state = self.client.saveState()

    def _silent_pairs(self, passing: frozenset[str]) -> list[tuple[int, int]]:
        """Pairs that a fixed joint connects, that only one moving joint parts, or that pass by declaration."""
        infos, names, top = self.infos, self.links, {-1: -1}
        for k, info in enumerate(infos):  # parents come first
            top[k] = top[info[16]] if info[2] == bullet.JOINT_FIXED else k
        above = {k: top[infos[k][16]] if k >= 0 else None for k in set(top.values())}
        solid = [k for k in top if self.client.getCollisionShapeData(self.body, k)]
        return [
            (a, b)
            for a, b in combinations(solid, 2)
            if top[a] == top[b] or top[a] == above[top[b]] or top[b] == above[top[a]] or {names[a], names[b]} & passing
        ]
