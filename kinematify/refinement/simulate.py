"""Simulation of plans by exact geometry, in this process.

The checks are those of `kinematify validate` (KV301 to KV321), so that a plan that passes here passes there. All bodies
of its scene stand in the world frame at rest: the checks then run on any tree with any joints, and what is costly about
the parts (FCL trees, signed distances) is built once. Sweeps of joints that did not change since an earlier plan are
not repeated, so that a candidate costs only the sweep of its own joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.scene import Scene, SceneBody
from kinematify.geometry.solid import Solid
from kinematify.processes.forked import each
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import Joint, Link, LinkMesh, Robot, Shape, rigid_groups
from kinematify.robot.vectors import as_one
from kinematify.validation.check import OpenCheck
from kinematify.validation.checks import checks_of
from kinematify.validation.finding import JointSummary
from kinematify.validation.geometry.look import GeometryContext, JointMotion

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from kinematify.assembly.part import Part
    from kinematify.config.validation import GeometrySettings
    from kinematify.geometry.sweep import JointSweep
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.check import Check
    from kinematify.validation.finding import Observation

_UNIT_SHARE = 1e-3  # of the largest part: a good unit for FCL, which takes short lengths for none


@dataclass(frozen=True, kw_only=True, eq=False)
class WorldScene(Scene):
    """A scene whose bodies stand in the world frame; joints move them about lines given there."""

    lines: Mapping[str, FloatArray]
    """A point on the axis of every joint, world frame at rest [m], shape (3,)."""

    def poses(self, leaders: FloatArray) -> FloatArray:
        """Motion of every body from where it is at rest, rows of leaders (n, leaders) -> (n, B, 4, 4)."""
        values = self.mechanism.all_values(leaders)
        column = {name: k for k, name in enumerate(self.mechanism.joints)}
        poses = np.broadcast_to(np.eye(4), (len(leaders), len(self._groups), 4, 4)).copy()
        for group, joint, above, _ in self._steps:
            motions = _motions_about(joint, self.lines[joint.name], values[:, column[joint.name]])
            poses[:, group] = poses[:, above] @ motions
        return np.ascontiguousarray(poses[:, [body.group for body in self.bodies]])


def _in_world_frame(model: KinematicModel, visuals: Mapping[str, Part]) -> Robot:
    """The same tree with all link frames in the world frame; the lines of the joints are distinguished from it."""
    return Robot(
        name=model.name,
        links=tuple(
            Link(name=name, visuals=(Shape(mesh=LinkMesh(vertices=part.vertices, faces=part.faces)),))
            for name, part in visuals.items()
        ),
        joints=tuple(
            Joint(
                name=joint.name,
                kind=joint.kind,
                parent=joint.parent,
                child=joint.child,
                T_parent_child=np.eye(4),
                axis=joint.axis,
                lower=joint.lower,
                upper=joint.upper,
            )
            for joint in model.joints
        ),
    )


def _motions_about(joint: Joint, point: FloatArray, values: FloatArray) -> FloatArray:
    """Motion of a joint about its line in the world frame at many values [rad or m], shape (n, 4, 4)."""
    motions = joint.motions(values)
    if joint.kind.turns:
        motions[:, :3, 3] = point - motions[:, :3, :3] @ point
    return motions


@dataclass(frozen=True, kw_only=True)
class MotionVerdict:
    """What exact geometry says of a plan."""

    findings: tuple[Observation, ...]
    joints: tuple[JointSummary, ...]
    """With the free travel of each joint that moves."""
    sweeps: tuple[JointSweep, ...]
    """Of the same joints."""


class Simulator:
    """Judges plans of one assembly by exact geometry."""

    def __init__(self, model: KinematicModel, settings: GeometrySettings) -> None:
        """Keep the parts.

        Args:
            model: Any plan of the assembly.
            settings: Of the checks by geometry.
        """
        self._settings = settings
        self._parts = {link.name: link.collision_parts or (link.visual,) for link in model.links}
        self._visuals = {link.name: link.visual for link in model.links}
        self._unit = _UNIT_SHARE * max(part.diagonal for parts in self._parts.values() for part in parts)
        self._solid = cache(self._new_solid)
        self._sweeps: dict[tuple[tuple[object, ...], int], JointSweep] = {}

    def judge(self, model: KinematicModel, child: str | None = None) -> MotionVerdict:
        """Judge a whole plan, or the joint above one part by its motion alone; a fixed joint has nothing to say.

        What lies beyond a range only matters where a joint is blocked within it.
        """
        look = GeometryContext(self._scene(model))
        found = _findings(checks_of("KV30"), look) if child is None else []
        travels = [
            (leader, travel.joint)
            for leader, travel in enumerate(look.scene.travels)
            if child in (None, model.robot.joint_by_name[travel.joint].child)
        ]
        # Another joint may have become fixed or free: the same motion under another number.
        keys = [(_key(model, name), leader) for leader, name in travels]
        new = [key for key in keys if key not in self._sweeps]
        self._sweeps |= zip(new, each(lambda key: look.sweeper.sweep(key[1], far=False), new), strict=True)
        summaries: list[JointSummary] = []
        for (_, name), key in zip(travels, keys, strict=True):
            sweep = self._sweeps[key]
            found += _findings(checks_of("KV31", "KV32"), JointMotion(look=look, sweep=sweep))
            joint = model.robot.joint_by_name[name]
            summaries.append(
                JointSummary(
                    joint=name,
                    kind=joint.kind.value,
                    declared_limits=(joint.lower, joint.upper),
                    free_travel=sweep.free,
                )
            )
        return MotionVerdict(
            findings=tuple(found), joints=tuple(summaries), sweeps=tuple(self._sweeps[key] for key in keys)
        )

    def _scene(self, model: KinematicModel) -> WorldScene:
        """A plan as the checks see it."""
        robot = _in_world_frame(model, self._visuals)
        groups = rigid_groups(robot)
        origins = {link.name: link.T_world_link[:3, 3] for link in model.links}
        return WorldScene(
            model=robot,
            mechanism=LeaderMechanism(robot=robot),
            bodies=tuple(
                SceneBody(
                    name=group.links[0],
                    links=group.links,
                    group=index,
                    solid=self._solid(tuple(sorted(group.links))),
                    shapes=(),
                )
                for index, group in enumerate(groups)
            ),
            settings=self._settings,
            unit=self._unit,
            lines={joint.name: origins[joint.child] for joint in model.joints},
        )

    def _new_solid(self, links: tuple[str, ...]) -> Solid:
        return Solid(
            *as_one((part.vertices, part.faces) for link in links for part in self._parts[link]),
            unit=self._unit,
            hole=self._settings.hole,
            points=self._settings.points,
        )


def _findings(checks: Iterable[Check], context: object) -> list[Observation]:
    found: list[Observation] = []
    for check in checks:
        result = OpenCheck(id=check.id, engine=None)
        check.run(result, context)
        found += result.findings
    return found


def _key(model: KinematicModel, name: str) -> tuple[object, ...]:
    """Return the key of the sweep of a joint: its line and range, and which bodies the tree moves against which."""
    joint = model.robot.joint_by_name[name]
    tree = tuple(sorted((item.child, item.parent, item.kind.value == "fixed") for item in model.joints))
    origin = model.link_by_name[joint.child].T_world_link[:3, 3]
    line = joint.axis.tobytes(), origin.tobytes()
    return joint.child, joint.kind.value, joint.lower, joint.upper, *line, tree
