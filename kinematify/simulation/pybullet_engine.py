"""PyBullet as an engine: a world of its own per purpose."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import pybullet as bullet
from scipy.spatial.transform import Rotation

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.contacts import Contacts
from kinematify.simulation.engine import FINER, LoadedJoint, LoadedRobot, Measured, Refused
from kinematify.simulation.pybullet_body import PybulletBody, load, text_of
from kinematify.simulation.pybullet_raw import PybulletFile
from kinematify.simulation.pybullet_world import PybulletWorld
from kinematify.simulation.servos import acting_pairs
from kinematify.simulation.stepped import count_steps, drive_run, drop_run, free_run

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Touching
    from kinematify.simulation.engine import DriveRun, Dropped, FreeRun
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.servos import Drive, Servos
    from kinematify.simulation.world import WorldSpec

_CHATTER = ("pybullet build time", "numActiveThreads", "argc=", "started thread", "stopping threads", "Thread with")
_DECIMALS = 6
"""Of joint values [rad or m] at which contacts are looked at."""
_POSITION_GAIN = 0.2
"""Share of the error that a motor takes back per step: fast, and without overshoot."""
_UNLIMITED = 1e9
"""Force [N m or N] that no motion needs."""


@dataclass(frozen=True, eq=False)
class PybulletEngine:
    """PyBullet as `kinematify.simulation.engine.Engine`; it says what it has to say in the log of its process."""

    settings: EngineSettings
    log: Path

    @staticmethod
    def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> PybulletFile:
        """Load a file as users do; PyBullet looks for packages by itself."""
        del package_dirs
        return PybulletFile(urdf, root)

    @staticmethod
    def open_world(spec: WorldSpec) -> PybulletWorld:
        """Build a world that runs."""
        return PybulletWorld(spec)

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
        free.client.disconnect()
        return PybulletModel(engine=self, prepared=prepared, looking=fixed, masses=masses)

    def messages(self) -> list[str]:
        """Return what it has printed, without what it always prints."""
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
    """Prepared model in PyBullet."""

    engine: PybulletEngine
    prepared: Prepared
    looking: PybulletBody
    """Everything collides in it."""
    masses: dict[str, float]
    """[kg], keyed by link."""

    @cached_property
    def loaded(self) -> LoadedRobot:
        """Return what became of joints and masses."""
        joints = {}
        for info in self.looking.joint_infos:
            if info[2] in {bullet.JOINT_REVOLUTE, bullet.JOINT_PRISMATIC}:
                unlimited = info[8] > info[9]
                joints[text_of(info[1])] = LoadedJoint(
                    turns=info[2] == bullet.JOINT_REVOLUTE,
                    lower=-np.inf if unlimited else info[8],
                    upper=np.inf if unlimited else info[9],
                )
        return LoadedRobot(joints=joints, masses=self.masses, total_mass=sum(self.masses.values()))

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return self.looking.complete

    @property
    def size(self) -> float:
        """Size of the model [m]."""
        return self.looking.size

    @property
    def resistance(self) -> FloatArray:
        """Damping and friction of all joints, shape (2, J)."""
        infos = [self.looking.joint_infos[index] for index in self.looking.indices]
        return np.array([[info[6] for info in infos], [info[7] for info in infos]]).reshape(2, -1)

    @cached_property
    def ignored_pairs(self) -> frozenset[tuple[int, int]]:
        """Pairs of links whose inflated shapes touch at rest; how deep they get is measured beside."""
        self.looking.place(self.looking.mechanism.values_at_rest)
        return frozenset((min(a, b), max(a, b)) for _, a, b, depth in self.looking.contacts(0) if depth > 0.0)

    def poses(self, values: FloatArray) -> FloatArray:
        """Where every link is in every row."""
        return self.measure(values).T_world_link

    def measure(self, values: FloatArray) -> Measured:
        """Set the model to every row and look."""
        looking = self.looking
        gravity = np.zeros_like(values)
        found: list[tuple[int, int, int, float]] = []
        states: list[list[tuple[tuple[float, ...], ...]]] = []
        for row, q in enumerate(values):
            looking.place(q)
            found += looking.contacts(row)
            states.append(looking.link_states())
            gravity[row] = looking.gravity(q) if len(q) else 0.0
        return Measured(
            T_world_link=_link_transforms(looking, states),
            contacts=looking.corrected(found),
            gravity=gravity,
            inertia=looking.mass_matrix(values[0]) if values.shape[1] else np.zeros((0, 0)),
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
    """Simulation of a prepared model in PyBullet."""

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
        run = _Run(self.model, self._free_world)
        run.hold(efforts)
        count = count_steps(seconds, self.step)
        return free_run(run, run.steps(count), count)

    def release(self, seconds: float, *, fine: bool = False) -> FreeRun:
        """Make the model go."""
        world, finer = self._free_world, FINER if fine else 1
        world.client.setPhysicsEngineParameter(fixedTimeStep=self.step / finer)
        run, count = _Run(self.model, world), finer * count_steps(seconds, self.step)
        world.release(ideal=True)
        result = free_run(run, run.steps(count), count, every=finer)
        world.client.setPhysicsEngineParameter(fixedTimeStep=self.step)
        return result

    def drive(self, drives: Sequence[Drive]) -> list[DriveRun]:
        """Drive a joint to an end, the others held."""
        return [self._drive(drive) for drive in drives]

    def _drive(self, drive: Drive) -> DriveRun:
        body, mechanism = self._drive_world, self.model.looking.mechanism
        column = mechanism.joints.index(mechanism.travels[drive.leader].joint)
        samples = self.model.engine.settings.sweep_samples
        pairs = acting_pairs(mechanism, self.sweep, drive, self.model.ignored_pairs, samples)
        body.act(pairs, on=True)
        run = _Run(self.model, body)
        run.hold(_UNLIMITED)
        targets = zip(drive.reference.tolist(), drive.speed.tolist(), strict=True)
        orders = ((column, target, speed, float(self.force[drive.leader])) for target, speed in targets)
        result = drive_run(run, run.steps(len(drive.reference), orders), drive, lambda: run.torques[column])
        body.act(pairs, on=False)
        return result

    def drop(self) -> Dropped:
        """Make the model fall on a floor."""
        body, settings = self.model.world(fixed=False), self.model.engine.settings
        client = body.client
        body.act(self.model.ignored_pairs, on=False)
        run = _Run(self.model, body)
        run.hold(np.inf)
        height = _lowest(body) - settings.drop
        shape = client.createCollisionShape(bullet.GEOM_PLANE)
        floor = client.createMultiBody(0.0, shape, basePosition=[0.0, 0.0, height])
        count = count_steps(settings.drop_seconds, self.step)
        margins = {index: float(body.margin[link]) for link, index in enumerate(body.link.tolist())}

        def depth() -> float:
            near = client.getClosestPoints(body.body, floor, 1e-3)
            return max((-point[8] - margins[point[3]] for point in near), default=-1e-3)

        dropped = drop_run(run, run.steps(count), count, self.step, places=lambda: _centres(body), depth=depth)
        client.disconnect()
        return dropped


class _Run:
    """A run of a model with position motors on all joints, a `SteppedWorld`.

    Followers follow what their leaders do, which PyBullet does not care for.
    """

    def __init__(self, model: PybulletModel, world: PybulletBody) -> None:
        """Place the model at rest."""
        self._model, self._world, self.mechanism = model, world, world.mechanism
        self._leaders = [self.mechanism.joints.index(travel.joint) for travel in self.mechanism.travels]
        passive = {self.mechanism.joints.index(name) for name in world.passive}
        self._followers = [k for k in range(len(self.mechanism.joints)) if k not in {*self._leaders, *passive}]
        self.failure: tuple[str, ...] = ()
        world.place(self.mechanism.values_at_rest)

    def steps(self, count: int, orders: Iterable[tuple[int, float, float, float]] | None = None) -> Iterator[int]:
        """Simulate; ends where a value is not finite.

        Args:
            count: Steps.
            orders: For every step the order to a motor (`command`), the followers then follow; None: no order.
        """
        order = iter(orders or ())
        for step in range(count):
            if orders is not None:
                self.command(*next(order))
            self._world.client.stepSimulation()
            self._q, self._v, self.torques = self._world.state()
            if not np.isfinite([self._q, self._v]).all():
                self.failure = ("a value is not finite",)
                return
            if orders is not None and self._followers:
                values = self.mechanism.all_values(np.array(self._q)[None, self._leaders])[0]
                for column in self._followers:
                    self.command(column, float(values[column]), 0.0, _UNLIMITED)
            yield step

    def values(self) -> FloatArray:
        """Values of all joints [rad or m], shape (J,)."""
        return np.array(self._q)

    def fastest(self) -> float:
        """Largest speed of a centre of mass [m/s]."""
        return self._world.fastest_link()

    def pressing(self) -> frozenset[tuple[int, int]]:
        """Pairs of bodies that press against each other."""
        return self._world.touching_bodies()

    def energy(self) -> tuple[float, float]:
        """Potential energy of all links but the root, and kinetic energy [J]."""
        states, (q, v, _) = self._world.link_states(), self._world.state()
        links = zip(self.mechanism.links, self._world.link.tolist(), strict=True)
        masses = self._model.prepared.link_by_name
        weights = [(GRAVITY * masses[name].mass, states[index][0][2]) for name, index in links if index >= 0]
        speeds, inertia = np.array(v), self._model.looking.mass_matrix(np.array(q))
        return sum(weight * height for weight, height in weights), float(0.5 * speeds @ inertia @ speeds)

    def hold(self, force: float | FloatArray) -> None:
        """Hold all joints at rest, with one force or one for each leader [N m or N]; followers without limit."""
        rest = self.mechanism.values_at_rest
        forces = np.full(len(rest), _UNLIMITED)
        forces[self._leaders] = np.minimum(force, _UNLIMITED)
        for column in (*self._leaders, *self._followers):
            self.command(column, float(rest[column]), 0.0, float(forces[column]))

    def command(self, column: int, target: float, speed: float, force: float) -> None:
        """Command one of `LeaderMechanism.joints`."""
        self._world.client.setJointMotorControl2(
            self._world.body,
            self._world.indices[column],
            bullet.POSITION_CONTROL,
            targetPosition=target,
            targetVelocity=speed,
            force=force,
            positionGain=_POSITION_GAIN,
            velocityGain=1.0,
        )


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
        world.client.getAABB(world.body, index)[0][2]
        for index in world.link.tolist()
        if world.client.getCollisionShapeData(world.body, index)
    ]
    return min(heights)


def _centres(world: PybulletBody) -> FloatArray:
    """Centres of mass of all links, shape (L, 3)."""
    base, _ = world.client.getBasePositionAndOrientation(world.body)
    return np.array([base, *(state[0] for state in world.link_states())])
