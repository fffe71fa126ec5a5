"""PyBullet as an engine: a world of its own per purpose."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet
from scipy.spatial.transform import Rotation

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.contacts import Contacts
from kinematify.simulation.engine import (
    FINER,
    SLOW_SECONDS,
    DriveRun,
    Dropped,
    FreeRun,
    LoadedJoint,
    LoadedModel,
    Measured,
    Refused,
)
from kinematify.simulation.pybullet_world import PybulletBody, load, text_of
from kinematify.simulation.servos import acting_pairs

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Touching
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.servos import Drive, Servos

_CHATTER = ("pybullet build time", "numActiveThreads", "argc=", "started thread", "stopping threads", "Thread with")
_DECIMALS = 6
"""Of joint values [rad or m] at which contacts are looked at."""
_FREE_LOOKS = 24
"""Times at which speeds and energies of a free run are measured."""
_POSITION_GAIN = 0.2
"""Share of the error that a motor takes back per step: fast, and without overshoot."""
_UNLIMITED = 1e9
"""Force [N m or N] that no motion needs."""
_DIVERGED = ("a value is not finite",)


def open_engine(settings: EngineSettings, log: Path) -> PybulletEngine:
    """Return PyBullet, which says what it has to say in the log of its process."""
    return PybulletEngine(settings=settings, log=log)


@dataclass(frozen=True, kw_only=True, eq=False)
class PybulletEngine:
    """See `kinematify.simulation.engine.Engine`."""

    settings: EngineSettings
    log: Path

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> PybulletModel:
        """Load a prepared file; a second time with a free base, because a fixed one has no mass."""
        step = self.settings.pybullet_time_step
        try:
            fixed = load(mechanism, prepared.urdf, step=step, looking=True)
            free = load(mechanism, prepared.urdf, step=step, fixed=False)
        except Refused as refusal:
            said = self._printed() or [str(refusal)]
            raise Refused(" ".join(said[-3:])[:400].rstrip(".")) from refusal
        masses = free.masses()
        free.disconnect()
        return PybulletModel(engine=self, prepared=prepared, looking=fixed, masses=masses)

    def messages(self) -> list[str]:
        """What it has printed, without what it always prints."""
        return list(dict.fromkeys(self._printed()))

    def _printed(self) -> list[str]:
        ctypes.CDLL(None).fflush(None)
        try:
            lines = self.log.read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError:
            return []
        return [line.strip() for line in lines if line.strip() and not any(word in line for word in _CHATTER)]


@dataclass(frozen=True, kw_only=True, eq=False)
class PybulletModel:
    """See `kinematify.simulation.engine.PhysicsModel`."""

    engine: PybulletEngine
    prepared: Prepared
    looking: PybulletBody
    """Everything collides in it."""
    masses: dict[str, float]
    """[kg], keyed by link."""

    @cached_property
    def loaded(self) -> LoadedModel:
        """What became of joints and masses."""
        joints = {}
        for info in self.looking.joint_infos:
            if info[2] in {bullet.JOINT_REVOLUTE, bullet.JOINT_PRISMATIC}:
                unlimited = info[8] > info[9]
                joints[text_of(info[1])] = LoadedJoint(
                    turns=info[2] == bullet.JOINT_REVOLUTE,
                    lower=-np.inf if unlimited else info[8],
                    upper=np.inf if unlimited else info[9],
                )
        return LoadedModel(joints=joints, masses=self.masses, total_mass=sum(self.masses.values()))

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return self.looking.complete

    @property
    def size(self) -> float:
        """Of the model [m]."""
        return self.looking.size

    @property
    def resistance(self) -> FloatArray:
        """Damping and friction of all joints, shape (2, J)."""
        infos = [self.looking.joint_infos[index] for index in self.looking.indices]
        return np.array([[info[6] for info in infos], [info[7] for info in infos]]).reshape(2, -1)

    @cached_property
    def ignored_pairs(self) -> frozenset[tuple[int, int]]:
        """Pairs of links whose inflated shapes touch at rest; how deep they get is measured beside."""
        self.looking.place(self.values_at_rest)
        return frozenset((min(a, b), max(a, b)) for _, a, b, depth in self.looking.contacts(0) if depth > 0.0)

    @property
    def values_at_rest(self) -> FloatArray:
        """Of all joints [rad or m], shape (J,)."""
        mechanism = self.looking.mechanism
        values: FloatArray = mechanism.all_values(mechanism.rest[None])[0]
        return values

    def measure(self, values: FloatArray, *, dynamic: int) -> Measured:
        """Set the model to every row and look."""
        looking = self.looking
        gravity = np.zeros_like(values)
        matrices: list[FloatArray] = []
        found: list[tuple[int, int, int, float]] = []
        states: list[list[tuple[tuple[float, ...], ...]]] = []
        for row, q in enumerate(values):
            looking.place(q)
            found += looking.contacts(row)
            if row < dynamic:
                matrices.append(looking.mass_matrix(q) if len(q) else np.zeros((0, 0)))
            states.append(looking.link_states())
            gravity[row] = looking.gravity(q) if len(q) else 0.0
        return Measured(
            T_world_link=_link_transforms(looking, states),
            contacts=looking.corrected(found),
            gravity=gravity,
            inertia=np.array(matrices).reshape(len(matrices), values.shape[1], values.shape[1]),
        )

    def contacts(self, values: FloatArray) -> Contacts:
        """Contacts in every row.

        PyBullet finds boxes metres deep in each other where their edges are parallel but for the noise of a motor.
        """
        found: list[tuple[int, int, int, float]] = []
        for row, q in enumerate(np.round(values, _DECIMALS)):
            self.looking.place(q)
            found += self.looking.contacts(row)
        return self.looking.corrected(found)

    def simulation(self, sweep: Touching, seen: Measured, servos: Servos) -> PybulletSimulation:
        """Choose the forces of the motors."""
        # A leader and its follower may balance each other's weight; here each is moved by a motor of its own.
        mechanism, margin = self.looking.mechanism, self.engine.settings.servo_margin
        own = seen.gravity[:, [mechanism.joints.index(travel.joint) for travel in mechanism.travels]]
        unbalanced = np.abs(own - servos.holding).max(axis=0, initial=0.0)
        return PybulletSimulation(model=self, sweep=sweep, force=servos.force + margin * unbalanced)

    def world(self, *, fixed: bool = True) -> PybulletBody:
        """Load into a new world, see `load`."""
        step = self.engine.settings.pybullet_time_step
        return load(self.looking.mechanism, self.prepared.urdf, step=step, fixed=fixed)


@dataclass(frozen=True, kw_only=True, eq=False)
class PybulletSimulation:
    """See `kinematify.simulation.engine.Simulation`."""

    model: PybulletModel
    sweep: Touching
    force: FloatArray
    """What the motor of each leader may exert while it is driven [N m or N], shape (leaders,)."""
    batch: int = 1
    """Drives take place one after the other."""

    @property
    def step(self) -> float:
        """Time step [s]."""
        return self.model.engine.settings.pybullet_time_step

    @cached_property
    def _free_world(self) -> PybulletBody:
        """Where nothing is driven."""
        world = self.model.world()
        world.act(self.model.ignored_pairs, on=False)
        return world

    @cached_property
    def _drive_world(self) -> PybulletBody:
        """Pairs act on each other in it only in drives in which they get too deep."""
        world = self.model.world()
        world.silence()
        return world

    def hold(self, efforts: FloatArray, seconds: float) -> FreeRun:
        """Hold the model by motors."""
        _Motors(self._free_world, self.model.values_at_rest).hold(efforts)
        return self._free(_steps(seconds, self.step))

    def release(self, seconds: float, *, fine: bool = False) -> FreeRun:
        """Let the model go."""
        world, finer = self._free_world, FINER if fine else 1
        bullet.setPhysicsEngineParameter(fixedTimeStep=self.step / finer, physicsClientId=world.client)
        world.place(self.model.values_at_rest)
        world.release(ideal=True)
        run = self._free(finer * _steps(seconds, self.step))
        bullet.setPhysicsEngineParameter(fixedTimeStep=self.step, physicsClientId=world.client)
        return replace(run, q=run.q[finer - 1 :: finer])

    def _free(self, steps: int) -> FreeRun:
        world, mechanism = self._free_world, self.model.looking.mechanism
        leaders = [mechanism.joints.index(travel.joint) for travel in mechanism.travels]
        looks = set(np.linspace(0, steps - 1, _FREE_LOOKS).astype(int).tolist())
        values: list[list[float]] = []
        energies = [self._energy(*world.state()[:2])]
        fastest = 0.0
        for step in range(steps):
            bullet.stepSimulation(physicsClientId=world.client)
            q, v, _ = world.state()
            if not np.isfinite([q, v]).all():
                break
            values.append([q[column] for column in leaders])
            if step in looks:
                energies.append(self._energy(q, v))
                fastest = max(fastest, world.fastest_link())
        return FreeRun(
            q=np.array(values).reshape(-1, len(leaders)),
            energy=np.array(energies),
            fastest=fastest,
            warnings=_DIVERGED if len(values) < steps else (),
        )

    def _energy(self, q: list[float], v: list[float]) -> tuple[float, float]:
        """Potential energy of all links but the root, and kinetic energy [J]."""
        world = self._free_world
        states, speeds = world.link_states(), np.array(v)
        links = zip(world.mechanism.links, world.link.tolist(), strict=True)
        weights = [
            (GRAVITY * self.model.prepared.link_by_name[name].mass, states[index][0][2])
            for name, index in links
            if index >= 0
        ]
        inertia = self.model.looking.mass_matrix(np.array(q))
        return sum(weight * height for weight, height in weights), float(0.5 * speeds @ inertia @ speeds)

    def drive(self, drives: Sequence[Drive]) -> list[DriveRun]:
        """Drive a joint to an end, the others held."""
        return [self._drive(drive) for drive in drives]

    def _drive(self, drive: Drive) -> DriveRun:
        world, mechanism = self._drive_world, self.model.looking.mechanism
        column = mechanism.joints.index(mechanism.travels[drive.leader].joint)
        force = float(self.force[drive.leader])
        samples = self.model.engine.settings.sweep_samples
        pairs = acting_pairs(mechanism, self.sweep, drive, self.model.ignored_pairs, samples)
        world.act(pairs, on=True)
        motors = _Motors(world, self.model.values_at_rest)
        motors.hold(_UNLIMITED)
        looks = set(drive.looks.tolist())
        values, forces, fastest = [], [], 0.0
        pressed: frozenset[tuple[int, int]] = frozenset()
        for step, (target, speed) in enumerate(zip(drive.reference.tolist(), drive.speed.tolist(), strict=True)):
            motors.command(column, target, speed, force)
            bullet.stepSimulation(physicsClientId=world.client)
            q, _, torques = world.state()
            if not np.isfinite(q).all():
                break
            motors.follow(q)
            values.append(q)
            forces.append(torques[column])
            if step in looks:
                fastest = max(fastest, world.fastest_link())
            if step == drive.arrived - 1:
                pressed = world.touching_bodies()
        world.act(pairs, on=False)
        return DriveRun(
            q=np.array(values).reshape(-1, len(mechanism.joints)),
            force=np.array(forces),
            pressed=pressed,
            fastest=fastest,
            warnings=_DIVERGED if len(values) < len(drive.reference) else (),
        )

    def drop(self) -> Dropped:
        """Let the model fall on a floor."""
        world, settings = self.model.world(fixed=False), self.model.engine.settings
        client = world.client
        world.act(self.model.ignored_pairs, on=False)
        _Motors(world, self.model.values_at_rest).hold(np.inf)
        height = _lowest(world) - settings.drop
        shape = bullet.createCollisionShape(bullet.GEOM_PLANE, physicsClientId=client)
        floor = bullet.createMultiBody(0.0, shape, basePosition=[0.0, 0.0, height], physicsClientId=client)
        steps, window = _steps(settings.drop_seconds, self.step), _steps(SLOW_SECONDS, self.step)
        early = _centres(world)
        for step in range(steps):
            bullet.stepSimulation(physicsClientId=client)
            if step == steps - 1 - window:
                early = _centres(world)
        late = _centres(world)
        near = bullet.getClosestPoints(world.body, floor, 1e-3, physicsClientId=client)
        world.disconnect()
        if not np.isfinite(late).all():
            return Dropped(depth=np.inf, speed=np.inf, warnings=_DIVERGED)
        margins = {index: float(world.margin[link]) for link, index in enumerate(world.link.tolist())}
        return Dropped(
            depth=max((-point[8] - margins[point[3]] for point in near), default=-1e-3),
            speed=float(np.linalg.norm(late - early, axis=1).max()) / (window * self.step),
            warnings=(),
        )


class _Motors:
    """Position motors on all joints; followers follow what their leaders do, which PyBullet does not care for."""

    def __init__(self, world: PybulletBody, rest: FloatArray) -> None:
        """Place the model at rest, values of all joints, shape (J,)."""
        self._world, self._rest = world, rest
        mechanism = world.mechanism
        self._leaders = [mechanism.joints.index(travel.joint) for travel in mechanism.travels]
        self._followers = [k for k in range(len(mechanism.joints)) if k not in self._leaders]
        world.place(rest)

    def hold(self, force: float | FloatArray) -> None:
        """Hold all joints at rest, with one force or one for each leader [N m or N]; followers without limit."""
        forces = np.full(len(self._rest), _UNLIMITED)
        forces[self._leaders] = np.minimum(force, _UNLIMITED)
        for column, value in enumerate(self._rest.tolist()):
            self.command(column, value, 0.0, float(forces[column]))

    def follow(self, q: list[float]) -> None:
        """Command the followers to where their leaders stand."""
        if self._followers:
            values = self._world.mechanism.all_values(np.array(q)[None, self._leaders])[0]
            for column in self._followers:
                self.command(column, float(values[column]), 0.0, _UNLIMITED)

    def command(self, column: int, target: float, speed: float, force: float) -> None:
        """Command one of `LeaderMechanism.joints`."""
        bullet.setJointMotorControl2(
            self._world.body,
            self._world.indices[column],
            bullet.POSITION_CONTROL,
            targetPosition=target,
            targetVelocity=speed,
            force=force,
            positionGain=_POSITION_GAIN,
            velocityGain=1.0,
            physicsClientId=self._world.client,
        )


def _steps(seconds: float, step: float) -> int:
    return max(2, round(seconds / step))


def _link_transforms(loaded: PybulletBody, states: list[list[tuple[tuple[float, ...], ...]]]) -> FloatArray:
    """Return the pose of every link's frame in every row, the fixed root at the origin, shape (n, L, 4, 4)."""
    transforms = np.tile(np.eye(4), (len(states), len(loaded.link), 1, 1))
    moving = np.flatnonzero(loaded.link >= 0)
    picked = loaded.link[moving].tolist()
    if picked and states:
        placed = transforms[:, moving]
        placed[..., :3, 3] = [[row[index][4] for index in picked] for row in states]
        turned = np.array([row[index][5] for row in states for index in picked])
        placed[..., :3, :3] = Rotation.from_quat(turned).as_matrix().reshape(len(states), len(picked), 3, 3)
        transforms[:, moving] = placed
    return transforms


def _lowest(world: PybulletBody) -> float:
    """Height of the lowest point of all collision shapes [m]; the boxes around them are a little too large."""
    heights: list[float] = [
        bullet.getAABB(world.body, index, physicsClientId=world.client)[0][2]
        for index in world.link.tolist()
        if bullet.getCollisionShapeData(world.body, index, physicsClientId=world.client)
    ]
    return min(heights)


def _centres(world: PybulletBody) -> FloatArray:
    """Centres of mass of all links, shape (L, 3)."""
    base, _ = bullet.getBasePositionAndOrientation(world.body, physicsClientId=world.client)
    return np.array([base, *(state[0] for state in world.link_states())])
