"""Results that the engine stages left in the folder of a run, with the model it belongs to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics, rigid_groups
from kinematify.simulation.configurations import agreement_configurations, read_poses
from kinematify.simulation.engines import ENGINES
from kinematify.simulation.prepared import load_prepared
from kinematify.validation.finding import not_finished

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.config.validation import AgreementSettings
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.robot import Robot
    from kinematify.simulation.configurations import Configurations, EnginePoses
    from kinematify.simulation.prepared import Prepared
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.stage import StageRequest

EXACT = "geometry"
"""Under this name the geometry stage leaves its contacts."""
_SMALLEST_MODEL = 0.01
"""Models below this size are compared as if they had it [m]."""


@dataclass(frozen=True, eq=False)
class EngineResults:
    """Results to compare, read when a check first asks for it."""

    request: StageRequest
    """Its folder holds what the stages left."""
    chosen: tuple[str, ...]
    """Engines that were asked for."""
    failures: Mapping[str, str]
    """Why a stage did not end by itself, keyed by engine."""

    @cached_property
    def settings(self) -> AgreementSettings:
        """Thresholds."""
        return self.request.settings.agreement

    @cached_property
    def model(self) -> Robot:
        """The file without its geometry."""
        return read_robot(self.request.urdf, geometry="none")

    @cached_property
    def prepared(self) -> Prepared:
        """Return what the engines loaded."""
        return load_prepared(self.request.work)

    @cached_property
    def rows(self) -> Configurations:
        """Where everything was computed."""
        return agreement_configurations(self.model, self.settings, self.request.settings.seed)

    @cached_property
    def own(self) -> FloatArray:
        """T_world_link as Kinematify has it, shape (n, L, 4, 4)."""
        poses = [forward_kinematics(self.model, self.rows.named(row)) for row in range(len(self.rows.q))]
        return np.array([[row[link] for link in self.rows.links] for row in poses])

    @cached_property
    def size(self) -> float:
        """Extent of all link frames in all rows [m]."""
        points = self.own[..., :3, 3].reshape(-1, 3)
        return max(float(np.linalg.norm(np.ptp(points, axis=0))), _SMALLEST_MODEL)

    @cached_property
    def engines(self) -> dict[str, EnginePoses]:
        """Return what each engine left, keyed by engine; what does not fit the model is as good as absent."""
        found = {engine: read_poses(self.request.work, engine) for engine in self.chosen}
        return {engine: poses for engine, poses in found.items() if poses is not None and self._fits(poses)}

    @cached_property
    def exact(self) -> EnginePoses | None:
        """Contacts by exact geometry, if the geometry stage left them."""
        poses = read_poses(self.request.work, EXACT)
        return poses if poses is not None and self._fits(poses) else None

    def _fits(self, poses: EnginePoses) -> bool:
        rows = self.rows
        same = (poses.links, poses.joints, poses.q.shape) == (rows.links, rows.joints, rows.q.shape)
        return same and bool(np.allclose(poses.q, rows.q))

    @cached_property
    def body(self) -> IntArray:
        """Index of the rigid body of each link, shape (L,)."""
        of = {link: k for k, group in enumerate(rigid_groups(self.model)) for link in group.links}
        return np.array([of[link] for link in self.rows.links], dtype=np.int64)

    @cached_property
    def ancestors(self) -> dict[str, set[str]]:
        """Joints above each joint."""
        above: dict[str, set[str]] = {}
        carrier = self.model.joint_above
        for joint in self.model.joints_downward:
            parent = carrier.get(joint.parent)
            above[joint.name] = set() if parent is None else above[parent.name] | {parent.name}
        return above

    def say_absent(self, check: OpenCheck, wanted: Iterable[str], there: Iterable[str]) -> None:
        """Name the engines that should have been compared and were not; the check is then no pass."""
        missing = [engine for engine in wanted if engine in self.chosen and engine not in there]
        if missing:
            reasons = (
                f"{ENGINES[e].title} {self.failures.get(e, 'left no figures, see its own checks')}" for e in missing
            )
            reason = f"not everything could be compared: {'; '.join(reasons)}"
            if self.request.late.intersection(missing):
                check.skip(not_finished(reason))
            else:
                check.block(reason)
