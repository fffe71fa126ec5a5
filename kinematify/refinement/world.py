"""A plan of a mechanism as a scene of the validator, without a file: all bodies stand in the world frame at rest.

The checks by geometry (KV30x to KV32x) then run on any tree with any joints, and what is costly about the parts (FCL
trees, signed distances) is built once for all of them: a candidate costs only the sweep of its own joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.scene import Scene, SceneBody
from kinematify.geometry.solid import Solid
from kinematify.robot.joint_type import JointType
from kinematify.robot.mechanism import LeaderMechanism
from kinematify.robot.robot import Joint, Link, LinkMesh, Robot, Shape, rigid_groups

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.assembly.part import Part
    from kinematify.config.validation import GeometrySettings
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.robot.arrays import FloatArray

_UNIT_SHARE = 1e-3  # of the largest part: a good unit for FCL, which takes short lengths for none


@dataclass(frozen=True, kw_only=True, eq=False)
class WorldScene(Scene):
    """A scene whose bodies stand in the world frame; joints move them about lines given there."""

    lines: Mapping[str, FloatArray]
    """A point on the axis of every joint, world frame at rest [m], shape (3,)."""

    def poses(self, leaders: FloatArray) -> FloatArray:
        """Motion of every body from where it stands at rest, rows of leaders (n, leaders) -> (n, B, 4, 4)."""
        values = self.mechanism.all_values(leaders)
        column = {name: k for k, name in enumerate(self.mechanism.joints)}
        poses = np.broadcast_to(np.eye(4), (len(leaders), len(self._groups), 4, 4)).copy()
        for group, joint, above, _ in self._steps:
            motions = _motions_about(joint, self.lines[joint.name], values[:, column[joint.name]])
            poses[:, group] = poses[:, above] @ motions
        return np.ascontiguousarray(poses[:, [body.group for body in self.bodies]])


class PartsWorld:
    """The parts of one assembly, from which scenes are made; solids are built when first asked for."""

    def __init__(self, model: KinematicModel, settings: GeometrySettings) -> None:
        """Keep the collision geometry of a model; all plans of the same assembly share it.

        Args:
            model: Any plan of the assembly.
            settings: Of the checks by geometry.
        """
        self.settings = settings
        self._parts = {link.name: link.collision_parts or (link.visual,) for link in model.links}
        self._visuals = {link.name: link.visual for link in model.links}
        self._unit = _UNIT_SHARE * max(part.diagonal for parts in self._parts.values() for part in parts)
        self._solids: dict[tuple[str, ...], Solid] = {}

    def scene(self, model: KinematicModel) -> WorldScene:
        """A plan as the checks see it."""
        robot = _in_world_frame(model, self._visuals)
        groups = rigid_groups(robot)
        origins = {link.name: link.T_world_link[:3, 3] for link in model.links}
        return WorldScene(
            model=robot,
            mechanism=LeaderMechanism(robot=robot),
            bodies=tuple(
                SceneBody(
                    name=group.links[0], links=group.links, group=index, solid=self._solid(group.links), shapes=()
                )
                for index, group in enumerate(groups)
            ),
            settings=self.settings,
            unit=self._unit,
            stand_ins=(),
            lines={joint.name: origins[joint.child] for joint in model.joints},
        )

    def _solid(self, links: tuple[str, ...]) -> Solid:
        key = tuple(sorted(links))
        if key not in self._solids:
            parts = [part for link in key for part in self._parts[link]]
            starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
            self._solids[key] = Solid(
                np.concatenate([part.vertices for part in parts]),
                np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)]),
                unit=self._unit,
                hole=self.settings.hole,
                points=self.settings.points,
            )
        return self._solids[key]


def _in_world_frame(model: KinematicModel, visuals: Mapping[str, Part]) -> Robot:
    """The same tree with all link frames in the world frame; the lines of the joints are told apart from it."""
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
    motions = np.broadcast_to(np.eye(4), (len(values), 4, 4)).copy()
    if joint.kind is JointType.PRISMATIC:
        motions[:, :3, 3] = values[:, None] * joint.axis
    elif joint.kind.turns:
        x, y, z = joint.axis
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        sine, versine = np.sin(values)[:, None, None], (1.0 - np.cos(values))[:, None, None]
        motions[:, :3, :3] += sine * cross + versine * (cross @ cross)
        motions[:, :3, 3] = point - motions[:, :3, :3] @ point
    return motions
