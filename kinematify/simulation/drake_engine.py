"""Drake (extra ``drake``): discrete time steps with its implicit contact solver and implicit servos; and raw files."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from lxml import etree
from pydrake.geometry import (
    AddCompliantHydroelasticPropertiesForHalfSpace,
    AddContactMaterial,
    CollisionFilterDeclaration,
    DefaultProximityProperties,
    GeometrySet,
    HalfSpace,
    ProximityProperties,
    SceneGraphConfig,
)
from pydrake.math import RigidTransform
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import (
    AddMultibodyPlant,
    AddMultibodyPlantSceneGraph,
    CoulombFriction,
    MultibodyPlantConfig,
)
from pydrake.multibody.tree import PdControllerGains, PrismaticJoint, RevoluteJoint
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from kinematify.simulation.configurations import GRAVITY
from kinematify.simulation.contacts import deepest
from kinematify.simulation.engine import FINER, LoadedJoint, LoadedRobot, Measured, Refused
from kinematify.simulation.raw_model import NO_NUMBERS, MovesFreely, Reproductions, RunningFile, Unloadable
from kinematify.simulation.servos import acting_pairs, commands
from kinematify.simulation.stepped import count_steps, drive_run, drop_run, free_run

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from pathlib import Path

    from kinematify.config.validation import EngineSettings
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.mechanism import LeaderMechanism
    from kinematify.simulation.contacts import Contacts, Touching
    from kinematify.simulation.engine import DriveRun, Dropped, FreeRun
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.raw_model import Start
    from kinematify.simulation.servos import Drive, Servos

_RESERVED = ("world", "WorldBody")
"""Drake's names of the outside; links of these names are loaded under other ones."""
_FRICTION = 0.5
"""Of the floor."""
_SLAB, _MODULUS = 0.1, 1e7
"""Thickness [m] and stiffness [Pa] of the floor."""
_ABOVE = 1e-3
"""Height above the floor of what does not touch it [m], as far as one cares."""
_CHATTER = ("half spaces",)
"""In warnings about our own floor."""


class _Said(logging.Handler):
    """Keeps what is logged."""

    def __init__(self) -> None:
        super().__init__(level=logging.WARNING)
        self.texts: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        text = record.getMessage()
        if not any(words in text for words in _CHATTER):
            self.texts.append(text)


class DrakeEngine:
    """Implementation of `kinematify.simulation.engine.Engine`."""

    def __init__(self, settings: EngineSettings, log: Path) -> None:
        """Keep Drake's warnings."""
        del log
        self.settings, self.said, logger = settings, _Said(), logging.getLogger("drake")
        logger.addHandler(self.said)
        logger.propagate = False

    @staticmethod
    def load_raw(urdf: Path, root: str, package_dirs: Sequence[Path]) -> DrakeFile:
        """Load a file as users do."""
        return DrakeFile(urdf, root, package_dirs)

    def load(self, prepared: Prepared, mechanism: LeaderMechanism) -> DrakeModel:
        """Load a prepared file."""
        model = DrakeModel(engine=self, prepared=prepared, mechanism=mechanism)
        assert model.looking  # what it refuses, it refuses here
        return model

    def messages(self) -> list[str]:
        """Drake's warnings."""
        return list(dict.fromkeys(" ".join(text.split()) for text in self.said.texts))


@dataclass(frozen=True, kw_only=True, eq=False)
class _World:
    """A diagram with one model in it, and a context."""

    mechanism: LeaderMechanism
    diagram: Any
    plant: Any
    scene: Any
    instance: Any
    names: tuple[str, ...]
    """Of the links in the document's order, as Drake knows them."""
    failure: list[str] = field(default_factory=list)
    """Why the last run ended early."""

    @cached_property
    def context(self) -> Any:
        return self.diagram.CreateDefaultContext()

    @property
    def plant_context(self) -> Any:
        return self.plant.GetMyContextFromRoot(self.context)

    @cached_property
    def bodies(self) -> list[Any]:
        """Bodies of each link, None for lost ones."""
        plant = self.plant
        return [plant.GetBodyByName(name) if plant.HasBodyNamed(name) else None for name in self.names]

    @cached_property
    def joints(self) -> list[Any]:
        """Joints of each of `LeaderMechanism.joints`, None for lost ones."""
        plant = self.plant
        found = [plant.GetJointByName(n) if plant.HasJointNamed(n) else None for n in self.mechanism.joints]
        return [joint if isinstance(joint, RevoluteJoint | PrismaticJoint) else None for joint in found]

    @cached_property
    def positions(self) -> list[int]:
        """Address of each joint among positions."""
        return [joint.position_start() for joint in self.joints]

    @cached_property
    def velocities(self) -> list[int]:
        """Address of each joint among velocities."""
        return [joint.velocity_start() for joint in self.joints]

    @cached_property
    def link_of_geometry(self) -> dict[Any, int]:
        """Link of each collision shape."""
        return {
            shape: link
            for link, body in enumerate(self.bodies)
            for shape in self.plant.GetCollisionGeometriesForBody(body)
        }

    def place(self, values: FloatArray) -> None:
        """Set all joints, shape (J,) [rad or m], and stop them."""
        for joint, value in zip(self.joints, values.tolist(), strict=True):
            if isinstance(joint, RevoluteJoint):
                joint.set_angle(self.plant_context, value)
                joint.set_angular_rate(self.plant_context, 0.0)
            else:
                joint.set_translation(self.plant_context, value)
                joint.set_translation_rate(self.plant_context, 0.0)

    def values(self) -> FloatArray:
        """Values of all joints [rad or m], shape (J,)."""
        return np.asarray(self.plant.GetPositions(self.plant_context)[self.positions])

    def poses(self) -> FloatArray:
        """Poses of all links, shape (L, 4, 4)."""
        context = self.plant_context
        return np.array([self.plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4() for body in self.bodies])

    def query(self) -> Any:
        """Return what sees the shapes."""
        return self.scene.get_query_output_port().Eval(self.scene.GetMyContextFromRoot(self.context))

    def touching(self) -> Iterator[tuple[int, int, float]]:
        """(link, link, depth [m]) of all contacts between links.

        The depth of a contact between meshes is an upper bound; the signed distance of the same pair is the depth.
        """
        link_of, query = self.link_of_geometry, self.query()
        for pair in query.ComputePointPairPenetration():
            if pair.id_A in link_of and pair.id_B in link_of:
                depth = -query.ComputeSignedDistancePairClosestPoints(pair.id_A, pair.id_B).distance
                yield link_of[pair.id_A], link_of[pair.id_B], float(depth)

    def pressing(self) -> frozenset[tuple[int, int]]:
        """Pairs of bodies that touch."""
        body = self.mechanism.body_of_link
        pairs = ((int(body[a]), int(body[b])) for a, b, _ in self.touching())
        return frozenset((min(pair), max(pair)) for pair in pairs)

    def sunk(self) -> float:
        """Return how deep a link is in the floor [m]; where none touches it, a little above."""
        link_of = self.link_of_geometry
        pairs = self.query().ComputePointPairPenetration()
        depths = [pair.depth for pair in pairs if (pair.id_A in link_of) != (pair.id_B in link_of)]
        return float(max(depths, default=-_ABOVE))

    def fastest(self) -> float:
        """Largest speed of a link's frame [m/s]."""
        speeds = [
            np.linalg.norm(self.plant.EvalBodySpatialVelocityInWorld(self.plant_context, body).translational())
            for body in self.bodies
        ]
        return float(max(speeds, default=0.0))

    def energy(self) -> tuple[float, float]:
        """Potential and kinetic [J]."""
        context = self.plant_context
        return float(self.plant.CalcPotentialEnergy(context)), float(self.plant.CalcKineticEnergy(context))

    def act(self, pairs: Iterable[tuple[int, int]], *, on: bool) -> None:
        """Make these pairs of links act on each other, or not."""
        manager = self.scene.collision_filter_manager(self.scene.GetMyContextFromRoot(self.context))
        for first, second in pairs:
            sets = (GeometrySet(self.plant.GetCollisionGeometriesForBody(self.bodies[k])) for k in (first, second))
            rule = CollisionFilterDeclaration()
            manager.Apply(rule.AllowBetween(*sets) if on else rule.ExcludeBetween(*sets))

    def steps(self, count: int, step: float, targets: FloatArray | None = None) -> Iterator[int]:
        """Simulate, yielding after every step; ends early where Drake gives up, with its reason in `failure`.

        Args:
            count: Steps.
            step: Time step [s].
            targets: Of each servo, shape (count, leaders); None without servos.
        """
        simulator = Simulator(self.diagram, self.context)
        plant, context = self.plant, self.plant_context
        desired = plant.get_desired_state_input_port(self.instance)
        self.context.SetTime(0.0)
        try:
            simulator.Initialize()
            for number in range(count):
                if targets is not None:
                    desired.FixValue(context, np.concatenate([targets[number], np.zeros(targets.shape[1])]))
                simulator.AdvanceTo((number + 1) * step)
                if not np.isfinite(plant.GetPositionsAndVelocities(context)).all():
                    self.failure.append("a value is not finite")
                    return
                yield number
        except RuntimeError as error:
            self.failure.append(" ".join(str(error).split())[:200])


@dataclass(frozen=True, kw_only=True, eq=False)
class DrakeModel:
    """Implementation of `kinematify.simulation.engine.PhysicsModel`."""

    engine: DrakeEngine
    prepared: Prepared
    mechanism: LeaderMechanism

    @cached_property
    def looking(self) -> _World:
        """Everything collides in it."""
        return self.world()

    def world(
        self,
        *,
        servos: Servos | None = None,
        force: FloatArray | None = None,
        ideal: bool = False,
        finer: int = 1,
        floor: float | None = None,
    ) -> _World:
        """Load into a world of its own.

        Args:
            servos: One for each leader; None: none.
            force: That each may exert [N m or N], infinite: no limit, shape (leaders,); None: no limits.
            ideal: Without damping in the joints.
            finer: Small steps per step.
            floor: Height of a floor [m], above which the root is free; None: the root is fixed.

        Raises:
            Refused: Drake cannot.
        """
        builder = DiagramBuilder()
        plant, scene = AddMultibodyPlantSceneGraph(builder, self.engine.settings.time_step / finer)
        plant.set_adjacent_bodies_collision_filters(False)
        plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY])
        try:
            (instance,) = Parser(plant).AddModels(str(self._urdf))
            root = plant.GetBodyByName(self._names[self.mechanism.links.index(self.mechanism.robot.root)])
            for joint in map(plant.get_joint, plant.GetJointIndices(instance) if ideal else ()):
                if joint.num_velocities() == 1:
                    joint.set_default_damping(0.0)
            if floor is None:
                plant.WeldFrames(plant.world_frame(), root.body_frame())
            else:
                _lay_floor(plant, scene, floor)
            if servos is not None:
                for leader, travel in enumerate(self.mechanism.travels):
                    limit = np.inf if force is None else float(force[leader])
                    joint = plant.GetJointByName(travel.joint)
                    servo = plant.AddJointActuator(f"kinematify servo {leader}", joint, limit)
                    gains = PdControllerGains(p=servos.stiffness[leader], d=servos.damping[leader])
                    servo.set_controller_gains(gains)
            plant.Finalize()
            diagram = builder.Build()
        except RuntimeError as error:
            raise Refused(" ".join(str(error).split())[:400].rstrip(".")) from error
        return _World(
            mechanism=self.mechanism, diagram=diagram, plant=plant, scene=scene, instance=instance, names=self._names
        )

    @property
    def _names(self) -> tuple[str, ...]:
        """Names of the links in the document's order, as Drake knows them."""
        return tuple(f"{name} link" if name in _RESERVED else name for name in self.mechanism.links)

    @cached_property
    def _urdf(self) -> Path:
        """The prepared file, or a copy beside it where a link has a reserved name."""
        if self._names == self.mechanism.links:
            return self.prepared.urdf
        renamed = dict(zip(self.mechanism.links, self._names, strict=True))
        tree = etree.parse(str(self.prepared.urdf))
        for element in tree.getroot().iter("link", "parent", "child"):
            key = "name" if element.tag == "link" else "link"
            element.set(key, renamed[str(element.get(key))])
        copy = self.prepared.urdf.with_name("drake.urdf")
        tree.write(str(copy))
        return copy

    @cached_property
    def loaded(self) -> LoadedRobot:
        """Return what became of joints and masses."""
        world = self.looking
        joints = {
            name: LoadedJoint(
                turns=isinstance(joint, RevoluteJoint),
                lower=float(joint.position_lower_limits()[0]),
                upper=float(joint.position_upper_limits()[0]),
            )
            for name, joint in zip(self.mechanism.joints, world.joints, strict=True)
            if joint is not None
        }
        bodies = zip(self.mechanism.links, world.bodies, strict=True)
        masses = {name: float(body.default_mass()) for name, body in bodies if body is not None}
        return LoadedRobot(joints=joints, masses=masses, total_mass=float(sum(masses.values())))

    @property
    def complete(self) -> bool:
        """True if no link and no joint was lost."""
        return None not in self.looking.bodies and None not in self.looking.joints

    @cached_property
    def size(self) -> float:
        """Largest side of the box around all collision shapes at zero [m], at least 1 mm."""
        self.looking.place(np.zeros(len(self.mechanism.joints)))
        corners = _corners(self.looking)
        return float(max(np.ptp(corners, axis=0).max(), 1e-3)) if len(corners) else 1.0

    @property
    def resistance(self) -> FloatArray:
        """Damping of all joints, and no friction, which Drake does not read, shape (2, J)."""
        damping = [float(joint.default_damping_vector()[0]) for joint in self.looking.joints]
        return np.array([damping, np.zeros(len(damping))])

    @cached_property
    def ignored_pairs(self) -> frozenset[tuple[int, int]]:
        """Pairs of links that touch at rest."""
        self.looking.place(self.mechanism.values_at_rest)
        return frozenset((min(a, b), max(a, b)) for a, b, _ in self.looking.touching())

    def measure(self, values: FloatArray, *, dynamic: int) -> Measured:
        """Set the model to every row and look."""
        world, plant = self.looking, self.looking.plant
        poses, gravity, matrices = [], np.zeros_like(values), []
        for row, q in enumerate(values):
            world.place(q)
            context = world.plant_context
            poses.append(world.poses())
            gravity[row] = -plant.CalcGravityGeneralizedForces(context)[world.velocities]
            if row < dynamic:
                matrices.append(plant.CalcMassMatrix(context)[np.ix_(world.velocities, world.velocities)])
        return Measured(
            T_world_link=np.array(poses),
            contacts=self.contacts(values),
            gravity=gravity,
            inertia=np.array(matrices).reshape(len(matrices), values.shape[1], values.shape[1]),
        )

    def contacts(self, values: FloatArray) -> Contacts:
        """Contacts in every row."""
        found: list[tuple[int, int, int, float]] = []
        for row, q in enumerate(values):
            self.looking.place(q)
            found += [(row, *contact) for contact in self.looking.touching()]
        table = np.array(found, dtype=np.float64).reshape(-1, 4)
        return deepest(table[:, 0].astype(np.int64), table[:, 1:3].astype(np.int64), table[:, 3])

    def simulation(self, sweep: Touching, seen: Measured, servos: Servos) -> DrakeSimulation:
        """Return what runs with servos."""
        del seen
        return DrakeSimulation(model=self, sweep=sweep, servos=servos)


@dataclass(frozen=True, kw_only=True, eq=False)
class DrakeSimulation:
    """Implementation of `kinematify.simulation.engine.Simulation`."""

    model: DrakeModel
    sweep: Touching
    servos: Servos
    batch: int = 1
    """Drives take place one after the other."""

    @property
    def step(self) -> float:
        """Time step [s]."""
        return self.model.engine.settings.time_step

    @property
    def _held(self) -> FloatArray:
        """Commands that hold the joints at rest, their weight made up for, shape (leaders,)."""
        targets: FloatArray = self.model.mechanism.rest + self.servos.holding[0] / self.servos.stiffness
        return targets

    def hold(self, efforts: FloatArray, seconds: float) -> FreeRun:
        """Hold the model by servos."""
        count = count_steps(seconds, self.step)
        world = self.model.world(servos=self.servos, force=efforts)
        return self._free(world, count, targets=np.repeat(self._held[None], count, axis=0))

    def release(self, seconds: float, *, fine: bool = False) -> FreeRun:
        """Make the model go."""
        finer = FINER if fine else 1
        return self._free(
            self.model.world(ideal=True, finer=finer), finer * count_steps(seconds, self.step), every=finer
        )

    def _free(self, world: _World, count: int, *, targets: FloatArray | None = None, every: int = 1) -> FreeRun:
        world.act(self.model.ignored_pairs, on=False)
        world.place(self.model.mechanism.values_at_rest)
        return free_run(world, world.steps(count, self.step / every, targets), count, every=every)

    @cached_property
    def _drive_world(self) -> _World:
        """Pairs act on each other in it only in drives in which they get too deep."""
        world = self.model.world(servos=self.servos, force=self.servos.force)
        links = [link for link, body in enumerate(world.bodies) if world.plant.GetCollisionGeometriesForBody(body)]
        world.act([(a, b) for a, b in product(links, links) if a < b], on=False)
        return world

    def drive(self, drives: Sequence[Drive]) -> list[DriveRun]:
        """Drive a joint to an end, the others held."""
        return [self._drive(drive) for drive in drives]

    def _drive(self, drive: Drive) -> DriveRun:
        world, mechanism = self._drive_world, self.model.mechanism
        samples = self.model.engine.settings.sweep_samples
        pairs = acting_pairs(mechanism, self.sweep, drive, self.model.ignored_pairs, samples)
        world.act(pairs, on=True)
        world.place(self.model.mechanism.values_at_rest)
        world.failure.clear()
        targets = commands(drive, mechanism, self.servos, samples)
        exerted = world.plant.get_net_actuation_output_port(world.instance)
        steps = world.steps(len(targets), self.step, targets)
        run = drive_run(world, steps, drive, lambda: float(exerted.Eval(world.plant_context)[drive.leader]))
        world.act(pairs, on=False)
        return run

    def drop(self) -> Dropped:
        """Make the model fall on a floor."""
        settings, looking = self.model.engine.settings, self.model.looking
        looking.place(self.model.mechanism.values_at_rest)
        height = float(_corners(looking)[:, 2].min()) - settings.drop
        world = self.model.world(servos=self.servos, floor=height)
        world.act(self.model.ignored_pairs, on=False)
        world.place(self.model.mechanism.values_at_rest)
        count = count_steps(settings.drop_seconds, self.step)
        run = world.steps(count, self.step, np.repeat(self._held[None], count, axis=0))
        return drop_run(world, run, count, self.step, places=lambda: world.poses()[:, :3, 3], depth=world.sunk)


def _lay_floor(plant: Any, scene: Any, height: float) -> None:
    """Add a floor that gives way over surfaces: at a single point per pair of shapes, models would rock and sink in."""
    rigid = DefaultProximityProperties(compliance_type="rigid")
    scene.set_config(SceneGraphConfig(default_proximity_properties=rigid))
    properties = ProximityProperties()
    AddCompliantHydroelasticPropertiesForHalfSpace(_SLAB, _MODULUS, properties)
    AddContactMaterial(friction=CoulombFriction(_FRICTION, _FRICTION), properties=properties)
    place = RigidTransform([0.0, 0.0, height])
    plant.RegisterCollisionGeometry(plant.world_body(), place, HalfSpace(), "floor", properties)


def _corners(world: _World) -> FloatArray:
    """Vertices of the convex pieces of links, and corners of the boxes around primitives, world frame, shape (n, 3)."""
    query = world.query()
    inspector = query.inspector()
    signs = np.array(list(product((-1.0, 1.0), repeat=3)))
    corners = []
    for shape in world.link_of_geometry:
        hull = inspector.GetConvexHull(shape)
        if hull is None:
            box = inspector.GetObbInGeometryFrame(shape)
            places = box.pose() @ (signs * box.half_width()).T
        else:
            places = np.array([hull.vertex(k) for k in range(hull.num_vertices())]).T
        corners.append((query.GetPoseInWorld(shape) @ places).T)
    return np.concatenate(corners) if corners else np.zeros((0, 3))


_LOAD = """import numpy as np; from pydrake.all import *
builder = DiagramBuilder(); plant, scene = AddMultibodyPlant(MultibodyPlantConfig(), builder); \
parser = Parser(plant); [parser.package_map().PopulateFromFolder(folder) for folder in {folders}]
parser.AddModels({path!r}); plant.WeldFrames(plant.world_frame(), plant.GetFrameByName({root!r})); \
plant.mutable_gravity_field().set_gravity_vector({gravity}); plant.Finalize(); diagram = builder.Build()
context = diagram.CreateDefaultContext(); state = plant.GetMyContextFromRoot(context); \
simulator = Simulator(diagram, context); rest = np.array({values}); plant.SetPositions(state, rest)
"""
_NO_CONTACTS = """bodies = [plant.get_body(k) for k in plant.GetBodyIndices(ModelInstanceIndex(2))]; \
scene.collision_filter_manager(scene.GetMyContextFromRoot(context)).Apply(CollisionFilterDeclaration().ExcludeWithin(\
GeometrySet([shape for body in bodies for shape in plant.GetCollisionGeometriesForBody(body)])))
"""
_JOINTS = (
    _LOAD
    + """joints = [plant.get_joint(k) for k in plant.GetJointIndices()]
for joint in joints: joint.num_velocities() == 1 and print(joint.name(), *joint.position_lower_limits(), \
*joint.position_upper_limits())
"""
)
_OVERLAP = (
    _LOAD
    + """query = scene.get_query_output_port().Eval(scene.GetMyContextFromRoot(context)); \
name = lambda shape: plant.GetBodyFromFrameId(query.inspector().GetFrameId(shape)).name()
pairs = [pair for pair in query.ComputePointPairPenetration() if {{name(pair.id_A), name(pair.id_B)}} == {links}]
print(np.max([-query.ComputeSignedDistancePairClosestPoints(pair.id_A, pair.id_B).distance for pair in pairs]))
"""
)
_REST = (
    _LOAD
    + """seen = [simulator.AdvanceTo((k + 1) * {step!r}) and plant.GetPositions(state)[{joint}] for k in range({steps})]
print(np.min(seen), np.max(seen))
"""
)
_PUSH = (
    _LOAD
    + """{off}port = plant.get_applied_generalized_force_input_port(); push = 0.0; seen = [rest[{joint}]]
moved, ratios, weights, tau = {moved}, np.array({ratios}), np.array({weights}), np.zeros(plant.num_velocities())
for k in range({steps}): slow = {speed!r} - plant.GetVelocities(state)[{joint}]; \
push = np.clip(push + {integral!r} * slow, -{force!r}, {force!r}); \
tau[{joint}] = np.clip({proportional!r} * slow + push, -{force!r}, {force!r}); \
port.FixValue(state, tau); simulator.AdvanceTo((k + 1) * {step!r}); \
q, v = rest.copy(), np.zeros_like(rest); q[moved] += ratios * (weights @ (plant.GetPositions(state) - rest)[moved]); \
v[moved] = ratios * (weights @ plant.GetVelocities(state)[moved]); \
plant.SetPositionsAndVelocities(state, np.r_[q, v]); seen.append(q[{joint}])
print(np.{farthest}(seen))
"""
)
_RELEASE = (
    _LOAD
    + _NO_CONTACTS
    + """plant.SetVelocities(state, {speeds})
energy = lambda: plant.CalcPotentialEnergy(state) + plant.CalcKineticEnergy(state)
seen = [energy()] + [simulator.AdvanceTo(k * {step!r}) and energy() for k in range({looks}, {steps} + 1, {looks})]
print(np.max(seen) - seen[0])
"""
)
_EARTH, _NOWHERE = (0.0, 0.0, -9.81), (0.0, 0.0, 0.0)


class DrakeFile(RunningFile):
    """`RunningFile`: a file as `Parser` adds it to a plant with the default time step, its first link welded."""

    look_steps = 10
    code = Reproductions(
        joints=_JOINTS,
        overlap=_OVERLAP,
        rest=_REST,
        push=_PUSH.replace("{gravity}", f"{_NOWHERE}").replace("{off}", ""),
        push_alone=_PUSH.replace("{gravity}", f"{_NOWHERE}").replace("{off}", _NO_CONTACTS),
        release=_RELEASE.replace("{looks}", "10"),
    )

    def __init__(self, urdf: Path, root: str, package_dirs: Sequence[Path]) -> None:
        """Load it.

        Raises:
            Unloadable: Drake does not open it.
            MovesFreely: It moves a link in other ways than by turning or sliding.
        """
        self._path, self._root, self._folders = urdf, root, [str(folder) for folder in package_dirs]
        self.time_step = float(MultibodyPlantConfig().time_step)
        self._file = {
            "path": str(urdf), "root": root, "folders": self._folders, "gravity": _EARTH, "step": self.time_step,
        }  # fmt: skip
        self._worlds: dict[tuple[bool, bool], _RawWorld] = {}
        plant = self._world(contacts=True).plant
        moving = [plant.get_joint(index) for index in plant.GetJointIndices()]
        moving = sorted((joint for joint in moving if joint.num_velocities()), key=lambda joint: joint.position_start())
        self.joints = tuple(joint.name() for joint in moving)
        if not all(isinstance(joint, RevoluteJoint | PrismaticJoint) for joint in moving):
            raise MovesFreely(self.lines_of_joints())
        self.limits = {
            joint.name(): (float(joint.position_lower_limits()[0]), float(joint.position_upper_limits()[0]))
            for joint in moving
        }

    def _world(self, *, contacts: bool, gravity: bool = True) -> _RawWorld:
        known = self._worlds.get((contacts, gravity))
        if known is None:
            known = _loaded(self._path, self._root, self._folders, contacts=contacts, gravity=gravity)
            self._worlds[contacts, gravity] = known
        return known

    def _start(self, start: Start) -> None:
        self._now = self._world(contacts=start.contacts, gravity=start.gravity)
        self.set_state(start.q, start.v)
        self.apply(0, 0.0)

    def steps(self, count: int, every: int = 1) -> Iterator[int]:
        """Implement `RunningFile`."""
        return self._now.steps(count, self.time_step, every)

    @property
    def complaint(self) -> str | None:
        """Why the last run ended early."""
        return self._now.complaint

    def state(self) -> tuple[FloatArray, FloatArray]:
        """Implement `RunningFile`."""
        plant, state = self._now.plant, self._now.state
        return np.array(plant.GetPositions(state)), np.array(plant.GetVelocities(state))

    def set_state(self, q: FloatArray, v: FloatArray) -> None:
        """Implement `RunningFile`."""
        self._now.plant.SetPositionsAndVelocities(self._now.state, np.concatenate([q, v]))

    def apply(self, joint: int, force: float) -> None:
        """Implement `RunningFile`."""
        forces = np.zeros(len(self.joints))
        forces[joint : joint + 1] = force
        self._now.plant.get_applied_generalized_force_input_port().FixValue(self._now.state, forces)

    def energy(self) -> tuple[float, float]:
        """Implement `RunningFile`."""
        plant, state = self._now.plant, self._now.state
        return float(plant.CalcPotentialEnergy(state)), float(plant.CalcKineticEnergy(state))

    def touching(self) -> Iterator[tuple[str, str, float]]:
        """Implement `RunningFile`; of shapes that may touch; the signed distance of a pair is its depth."""
        world = self._now
        query = world.scene.get_query_output_port().Eval(world.scene.GetMyContextFromRoot(world.context))
        for pair in query.ComputePointPairPenetration():
            first, second = sorted((world.link_of[pair.id_A], world.link_of[pair.id_B]))
            depth = -float(query.ComputeSignedDistancePairClosestPoints(pair.id_A, pair.id_B).distance)
            yield first, second, depth

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """Implement `RunningFile`."""
        self.begin(values, contacts=True)
        return np.asarray(1.0 / np.diagonal(np.linalg.inv(self._now.plant.CalcMassMatrix(self._now.state))))

    def _links_in_code(self, links: tuple[str, str]) -> object:
        return set(links)


@dataclass(kw_only=True, eq=False)
class _RawWorld:
    """A diagram with one file in it, and a context."""

    diagram: Any
    plant: Any
    scene: Any
    context: Any
    link_of: Mapping[Any, str]
    """Of each collision shape."""
    complaint: str | None = None
    """Why the last run ended early."""

    @property
    def state(self) -> Any:
        """The plant's part of the context."""
        return self.plant.GetMyContextFromRoot(self.context)

    def steps(self, count: int, step: float, looks: int = 1) -> Iterator[int]:
        """Simulate, yielding the number of steps done after every few; ends early where Drake gives up."""
        self.complaint = None
        self.context.SetTime(0.0)
        simulator = Simulator(self.diagram, self.context)
        try:
            simulator.Initialize()
            for done in range(looks, count + 1, looks):
                simulator.AdvanceTo(done * step)
                if not np.isfinite(self.plant.GetPositionsAndVelocities(self.state)).all():
                    self.complaint = NO_NUMBERS
                    return
                yield done
        except RuntimeError as error:
            self.complaint = " ".join(str(error).split())[:200]


def _loaded(urdf: Path, root: str, folders: Sequence[str], *, contacts: bool, gravity: bool) -> _RawWorld:
    builder = DiagramBuilder()
    plant, scene = AddMultibodyPlant(MultibodyPlantConfig(), builder)
    parser = Parser(plant)
    for folder in folders:
        parser.package_map().PopulateFromFolder(folder)
    try:
        (model,) = parser.AddModels(str(urdf))
        plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(root))
        plant.mutable_gravity_field().set_gravity_vector(_EARTH if gravity else _NOWHERE)
        plant.Finalize()
        diagram = builder.Build()
    except RuntimeError as error:
        lines = _LOAD.partition("context =")[0].format(path=str(urdf), root=root, folders=folders, gravity=_EARTH)
        raise Unloadable(str(error), lines) from error
    bodies = [plant.get_body(index) for index in plant.GetBodyIndices(model)]
    link_of = {shape: body.name() for body in bodies for shape in plant.GetCollisionGeometriesForBody(body)}
    context = diagram.CreateDefaultContext()
    if not contacts:
        off = CollisionFilterDeclaration().ExcludeWithin(GeometrySet(list(link_of)))
        scene.collision_filter_manager(scene.GetMyContextFromRoot(context)).Apply(off)
    return _RawWorld(diagram=diagram, plant=plant, scene=scene, context=context, link_of=link_of)
