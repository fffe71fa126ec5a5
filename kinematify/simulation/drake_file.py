"""A file in Drake as its `Parser` adds it to a plant with the default time step, the first link welded to the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from pydrake.geometry import CollisionFilterDeclaration, GeometrySet
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlant, MultibodyPlantConfig
from pydrake.multibody.tree import PrismaticJoint, RevoluteJoint
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

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
_LOOK_STEPS = 10
"""Between two looks at the energy."""


class DrakeFile(RunningFile):
    """See `RunningFile`."""

    code = Reproductions(
        joints=_JOINTS,
        overlap=_OVERLAP,
        rest=_REST,
        push=_PUSH.replace("{gravity}", f"{_NOWHERE}").replace("{off}", ""),
        push_alone=_PUSH.replace("{gravity}", f"{_NOWHERE}").replace("{off}", _NO_CONTACTS),
        release=_RELEASE.replace("{looks}", f"{_LOOK_STEPS}"),
    )

    def __init__(self, urdf: Path, root: str, package_dirs: Sequence[Path] = ()) -> None:
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

    def _row(self, values: Mapping[str, float]) -> FloatArray:
        return np.array([values[name] for name in self.joints])

    def overlaps(self, values: Mapping[str, float]) -> tuple[Overlap, ...]:
        """See `RawEngineModel`."""
        world = self._world(contacts=True)
        world.place(self._row(values))
        return world.overlaps()

    def rest(self, values: Mapping[str, float], seconds: float, *, contacts: bool) -> RestRun:
        """See `RunningFile`."""
        world = self._world(contacts=contacts)
        world.place(self._row(values))
        seen = [world.positions for _ in world.steps(round(seconds / self.time_step), self.time_step)]
        return RestRun(values=np.array(seen).reshape(-1, len(self.joints)), complaint=world.complaint)

    def release(self, values: Mapping[str, float], speeds: Mapping[str, float], seconds: float) -> ReleaseRun:
        """See `RunningFile`."""
        world = self._world(contacts=False)
        world.place(self._row(values), self._row(speeds))
        seen = [world.energy]
        seen += [world.energy for _ in world.steps(round(seconds / self.time_step), self.time_step, _LOOK_STEPS)]
        return ReleaseRun(energy=np.array(seen), complaint=world.complaint)

    def inertias(self, values: Mapping[str, float]) -> FloatArray:
        """See `RunningFile`."""
        world = self._world(contacts=True)
        world.place(self._row(values))
        return np.asarray(1.0 / np.diagonal(np.linalg.inv(world.plant.CalcMassMatrix(world.state))))

    def push(self, push: Push, values: Mapping[str, float], *, contacts: bool) -> Pushed:
        """See `RunningFile`."""
        world, rest = self._world(contacts=contacts, gravity=False), self._row(values)
        world.place(rest)
        moved = [self.joints.index(name) for name in push.moved]
        ratios, weights = np.array(push.ratios), np.array(push.weights)
        progress = PushProgress(start=values[push.joint], push=push, time_step=self.time_step)
        port, force = world.plant.get_applied_generalized_force_input_port(), np.zeros(len(rest))
        done, force[moved[0]] = 0, progress.force(0.0)
        port.FixValue(world.state, force)
        for done in world.steps(push.steps, self.time_step):
            q, v = rest.copy(), np.zeros_like(rest)
            speed = float(weights @ world.plant.GetVelocities(world.state)[moved])
            q[moved] += ratios * (weights @ (world.positions - rest)[moved])
            v[moved] = ratios * speed
            world.plant.SetPositionsAndVelocities(world.state, np.concatenate([q, v]))
            if not progress.goes_on(float(q[moved[0]]), done):
                break
            force[moved[0]] = progress.force(speed)
            port.FixValue(world.state, force)
        port.FixValue(world.state, np.zeros(len(rest)))
        return Pushed(farthest=progress.value, steps=done, overlaps=world.overlaps())

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

    def place(self, values: FloatArray, speeds: FloatArray | None = None) -> None:
        """Set all joints [rad or m] and their speeds, 0 if not given."""
        still = np.zeros_like(values) if speeds is None else speeds
        self.plant.SetPositionsAndVelocities(self.state, np.concatenate([values, still]))

    @property
    def positions(self) -> FloatArray:
        """Of all joints [rad or m]."""
        return np.array(self.plant.GetPositions(self.state))

    @property
    def energy(self) -> tuple[float, float]:
        """Potential and kinetic [J]."""
        return float(self.plant.CalcPotentialEnergy(self.state)), float(self.plant.CalcKineticEnergy(self.state))

    def overlaps(self) -> tuple[Overlap, ...]:
        """Of shapes that may touch; the signed distance of a pair is its depth."""
        query = self.scene.get_query_output_port().Eval(self.scene.GetMyContextFromRoot(self.context))
        depths: dict[tuple[str, str], float] = {}
        for pair in query.ComputePointPairPenetration():
            first, second = sorted((self.link_of[pair.id_A], self.link_of[pair.id_B]))
            depth = -float(query.ComputeSignedDistancePairClosestPoints(pair.id_A, pair.id_B).distance)
            depths[first, second] = max(depths.get((first, second), 0.0), depth)
        return deepest_first(depths)

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
                    self.complaint = "the values of joints are no numbers any more"
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
