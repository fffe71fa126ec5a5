"""Context of the checks of one engine, computed when first asked for and kept for the others."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from kinematify.model.collision_pieces import Method
from kinematify.robot.mechanism import LeaderMechanism, sweep_rows
from kinematify.robot.read import read_robot
from kinematify.simulation.configurations import pose_configurations
from kinematify.simulation.contacts import touching
from kinematify.simulation.drive import drive_all
from kinematify.simulation.engines import open_engine
from kinematify.simulation.prepared import load_prepared
from kinematify.simulation.servos import servos

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kinematify.config.validation import EngineSettings
    from kinematify.geometry.scene import Scene
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.mechanism import Travel
    from kinematify.robot.robot import Robot
    from kinematify.simulation.configurations import Configurations
    from kinematify.simulation.contacts import Touching
    from kinematify.simulation.drive import Driven, DriveSession
    from kinematify.simulation.engine import Dropped, Engine, EngineModel, FreeRun, Measured, PhysicsModel, Simulation
    from kinematify.simulation.engines import EngineEntry
    from kinematify.simulation.prepared import Prepared
    from kinematify.simulation.servos import Servos
    from kinematify.validation.stage import StageRequest


@dataclass(frozen=True, kw_only=True)
class RunEnd:
    """End of a run."""

    when: str
    """As words that follow "while"."""
    speed: float
    """The largest of a link [m/s]."""
    warnings: tuple[str, ...]
    """Those of the engine that ended it; empty if it went on to the end."""
    joint: str | None = None
    """The one that was driven."""
    drive_speed: float = 0.0
    """The largest speed that it was commanded to give a link [m/s]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class EngineContext:
    """A model in an engine, and its runs."""

    request: StageRequest
    entry: EngineEntry
    ends: list[RunEnd] = field(default_factory=list)
    """Of the runs that took place so far."""

    @property
    def settings(self) -> EngineSettings:
        """Thresholds, servos and times."""
        return self.request.settings.engines

    @cached_property
    def declared(self) -> Robot:
        """The file without its geometry."""
        return read_robot(self.request.urdf, geometry="none")

    @cached_property
    def prepared(self) -> Prepared:
        """Return what the engine is given."""
        return load_prepared(self.request.work)

    @cached_property
    def surfaces(self) -> Scene:
        """Return what the file declares to collide; engines do without, and only drives that are stopped ask for it."""
        from kinematify.geometry.scene import read_scene  # noqa: PLC0415 - for these only

        return read_scene(self._whole, self.request.settings.geometry)

    @cached_property
    def visible_surfaces(self) -> Scene | None:
        """Return what is visible; None where it is what collides."""
        from kinematify.geometry.scene import read_scene, simplified, visible_shapes  # noqa: PLC0415

        if not simplified(self._whole):
            return None
        return read_scene(self._whole, self.request.settings.geometry, visible_shapes, solids=self.surfaces.solids)

    @cached_property
    def _whole(self) -> Robot:
        from kinematify.validation.left_model import model_of  # noqa: PLC0415

        return model_of(self.request)

    @cached_property
    def mechanism(self) -> LeaderMechanism:
        """The tree."""
        return LeaderMechanism(robot=self.declared)

    @cached_property
    def engine(self) -> Engine:
        """Loaded into this process."""
        return open_engine(self.entry.name, self.settings, self.request.work / f"{self.entry.name}.log")

    @cached_property
    def model(self) -> EngineModel:
        """The model as the engine has it.

        Raises:
            Refused: It has not.
        """
        return self.engine.load(self.prepared, self.mechanism)

    @property
    def physics(self) -> PhysicsModel:
        """The same, in an engine that runs (`EngineEntry.runs`)."""
        return cast("PhysicsModel", self.model)

    @cached_property
    def rows(self) -> Configurations:
        """Where poses are compared."""
        return pose_configurations(self.declared, self.settings, self.request.settings.seed)

    @cached_property
    def seen(self) -> Measured:
        """Return what the engine says along the sweep of every joint."""
        rows = self.mechanism.sweep(self.settings.sweep_samples)
        return self.physics.measure(self.mechanism.all_values(rows))

    @cached_property
    def sweep(self) -> Touching:
        """Contacts of bodies along the sweep of every joint."""
        return touching(
            self.seen.contacts,
            self.mechanism,
            self.prepared,
            rows=1 + len(self.mechanism.travels) * self.settings.sweep_samples,
            tolerance=self.settings.contact_depth * self.physics.size,
        )

    @cached_property
    def servos(self) -> Servos:
        """One for each leader."""
        seen, resistance = self.seen, self.physics.resistance
        return servos(self.mechanism, seen.inertia, seen.gravity, resistance, self.settings)

    @cached_property
    def simulation(self) -> Simulation:
        """Where runs take place."""
        return self.physics.simulation(self.sweep, self.seen, self.servos)

    @cached_property
    def efforts(self) -> FloatArray:
        """Declared effort of every leader [N m or N]; infinite where none is declared or masses are made up."""
        efforts = np.full(len(self.mechanism.travels), np.inf)
        for leader, travel in enumerate(self.mechanism.travels):
            effort = self.declared.joint_by_name[travel.joint].effort
            carried = self.mechanism.moved[leader][self.mechanism.body_of_link]
            links = [self.prepared.link_by_name[name] for name in self.mechanism.links]
            made_up = any(
                link.mass_added and link.method is not Method.NONE
                for link, moves in zip(links, carried, strict=True)
                if moves
            )
            if effort is not None and effort > 0.0 and not made_up:
                efforts[leader] = effort
        return efforts

    @cached_property
    def held(self) -> FreeRun:
        """Held at rest by servos no stronger than `efforts`."""
        return self._kept("it was held at rest", self.simulation.hold(self.efforts, self.settings.passive_seconds))

    @cached_property
    def released(self) -> FreeRun:
        """Without servos, damping and friction."""
        return self._kept("it was released", self.simulation.release(self.settings.passive_seconds))

    @cached_property
    def released_finely(self) -> FreeRun:
        """The same with smaller time steps, as long as it is looked at."""
        long = self.settings.step_seconds if self.entry.keeps_energy else self.settings.passive_seconds
        return self.simulation.release(long, fine=True)

    def _kept(self, when: str, run: FreeRun) -> FreeRun:
        self.ends.append(RunEnd(when=when, speed=run.fastest, warnings=run.warnings))
        return run

    @cached_property
    def drives(self) -> DriveSession:
        """Every joint driven to both ends."""
        session = drive_all(
            self.simulation,
            self.physics,
            self.mechanism,
            self.prepared,
            seen=self.seen.contacts,
            sweep=self.sweep,
            settings=self.settings,
            remaining=lambda: self.request.remaining,
        )
        for end in session.ends:
            travel = self.mechanism.travels[end.drive.leader]
            self.ends.append(
                RunEnd(
                    when=f"{travel.joint} was driven to {end.drive.end:.4g} {travel.unit}",
                    speed=end.fastest,
                    warnings=end.warnings,
                    joint=travel.joint,
                    drive_speed=float(np.abs(end.drive.speed).max()) * (self.physics.size if travel.turns else 1.0),
                )
            )
        return session

    @cached_property
    def dropped(self) -> Dropped:
        """On a floor."""
        end = self.simulation.drop()
        self.ends.append(RunEnd(when="it was dropped", speed=end.speed, warnings=end.warnings))
        return end

    def travel(self, driven: Driven) -> Travel:
        """Return the way of the joint that is driven."""
        return self.mechanism.travels[driven.drive.leader]

    def arrived(self, driven: Driven) -> bool:
        """True if the joint got to its end."""
        return abs(driven.drive.end - driven.reached) <= self.settings.reach * self.travel(driven).range

    def separates(self, leader: int) -> NDArray[np.bool_]:
        """Which pairs of `drives.sweep` a joint moves against each other, shape (pairs,)."""
        moved = self.mechanism.moved[leader]
        first, second = self.drives.sweep.bodies.T
        result: NDArray[np.bool_] = moved[first] != moved[second]
        return result

    def links_on_the_way(self, driven: Driven, index: int) -> tuple[str, str]:
        """Names of the two links of a pair of `drives.sweep` that get deepest into each other on the way of a joint."""
        rows, _ = self._towards(driven)
        return self.drives.sweep.pair(index, self.mechanism.links, (*driven.rows, *rows.tolist()))

    def excess_towards(self, driven: Driven) -> tuple[FloatArray, FloatArray]:
        """Excess of each pair between rest and the end by kinematics alone (pairs, n), and the joint's values (n,)."""
        rows, values = self._towards(driven)
        return self.drives.sweep.excess[:, rows], values

    def _towards(self, driven: Driven) -> tuple[IntArray, FloatArray]:
        """Rows of `sweep` between rest and the end of a joint, and its values there, (n,) each."""
        travel, rows = self.travel(driven), sweep_rows(driven.drive.leader, self.settings.sweep_samples)
        values = np.linspace(travel.lower, travel.upper, self.settings.sweep_samples)
        side = values >= travel.rest if driven.drive.end == travel.upper else values <= travel.rest
        return np.arange(rows.start, rows.stop)[side], values[side]
