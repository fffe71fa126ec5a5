"""Bodies and the joints between them, as MJCF, SDF and USD state them, as a tree whose frames lie at the joints."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import DescriptionError
from kinematify.robot.joint_type import JointType
from kinematify.robot.linkage import with_closures
from kinematify.robot.robot import Joint, Link, LinkMesh, LoopJoint, Robot

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Shape

WORLD = "world"
"""The link that represents the outside where a format fixes bodies to it."""
_UPRIGHT = 1e-9
_SHOWN = 4
Losses = defaultdict[str, list[str]]
"""Names of what a file holds and a robot does not, by its kind."""
Edge = tuple[Joint, "FloatArray"]
"""A joint whose `T_parent_child` is the joint's frame in the parent body, with its frame in the child body; its axis is
in the joint's frame."""


def tree_of(
    name: str,
    path: Path,
    bodies: Sequence[Link],
    edges: Sequence[Edge],
    *,
    poses: Mapping[str, FloatArray],
    loops: Iterable[LoopJoint] = (),
    notes: Sequence[str] = (),
    losses: Losses,
) -> Robot:
    """Return a robot whose link frames have the axes of the bodies and lie at the joints above them.

    Joints may be stated from the child to the parent. A joint between two links that the tree connects already closes a
    loop at its origin. Bodies that nothing holds are fixed to the root where they are. An upright world without shapes
    that holds one body is left out, as URDF does.

    Args:
        name: Of the robot.
        path: The file.
        bodies: With shapes and masses in their own frames; `WORLD` among them if it has shapes.
        edges: The joints, the tree's before those that close loops.
        poses: T_world_body of each body but `WORLD`.
        loops: Points that two bodies share, in their own frames.
        notes: What is read with another meaning, one sentence each.
        losses: What is not read.

    Raises:
        DescriptionError: There is no body.
    """
    if not any(body.name != WORLD or body.visuals or body.collisions for body in bodies):
        raise DescriptionError(f"The description {path} holds no body. Give a model with at least one.")
    notes = [*notes, *_sentences(losses)]
    if all(body.name != WORLD for body in bodies) and any(WORLD in (joint.parent, joint.child) for joint, _ in edges):
        bodies = [Link(name=WORLD), *bodies]
    bodies, edges = _without_empty_world(bodies, edges)
    children = {joint.child for joint, _ in edges}
    order = sorted((body.name for body in bodies), key=lambda body: (body != WORLD, body in children))
    joints: dict[str, Joint] = {}
    closing = list(loops)
    offsets: dict[str, FloatArray] = {}
    above: dict[str, list[Edge]] = {body: [] for body in order}
    for joint, T_child_joint in edges:
        above[joint.parent].append((joint, T_child_joint))
        above[joint.child].append(_reversed(joint, T_child_joint))
    roots: list[str] = []
    for start in order:
        if start in offsets:
            continue
        roots.append(start)
        offsets[start] = np.zeros(3)
        waiting = [start]
        for body in waiting:
            for joint, T_child_joint in above[body]:
                if joint.child not in offsets:
                    offsets[joint.child] = T_child_joint[:3, 3]
                    joints[joint.name] = _at_child(joint, T_child_joint, offsets[body])
                    waiting.append(joint.child)
    for joint, T_child_joint in edges:
        if joint.name not in joints:
            points = (joint.T_parent_child[:3, 3], T_child_joint[:3, 3])
            closing.append(LoopJoint(name=joint.name, links=(joint.parent, joint.child), points=points))
            if joint.declared_kind != "ball":
                notes.append(f"The joint {joint.name} closes a loop and is read as a point that both links share.")
    links = [_moved(body, offsets[body.name]) for body in bodies]
    if len(roots) > 1:
        notes.append(f"Bodies that nothing holds are read as fixed where they are: {', '.join(roots[1:])}.")
        T_root_world = np.linalg.inv(poses[roots[0]]) if roots[0] != WORLD else np.eye(4)
        joints |= {f"{body}_free": _free(roots[0], body, T_root_world @ poses[body]) for body in roots[1:]}
    in_file = {joint.name: number for number, (joint, _) in enumerate(edges)}
    robot = Robot(
        name=name,
        links=tuple(links),
        joints=tuple(sorted(joints.values(), key=lambda joint: in_file.get(joint.name, len(in_file)))),
        loops=tuple(
            replace(loop, points=(loop.points[0] - offsets[loop.links[0]], loop.points[1] - offsets[loop.links[1]]))
            for loop in closing
        ),
        path=path.resolve(),
        notes=tuple(notes),
    )
    return with_closures(robot) if robot.loops else robot


def _sentences(losses: Mapping[str, Sequence[str]]) -> list[str]:
    """One sentence for each kind of thing that a file holds and a robot does not, with some of their names."""
    found = []
    for what, names in losses.items():
        shown = ", ".join(name for name in names[:_SHOWN] if name)
        more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
        found.append(f"Not read ({len(names)}): {what}" + (f": {shown}{more}." if shown else "."))
    return found


def _without_empty_world(bodies: Sequence[Link], edges: Sequence[Edge]) -> tuple[Sequence[Link], Sequence[Edge]]:
    at_world = [edge for edge in edges if WORLD in (edge[0].parent, edge[0].child)]
    empty = any(body.name == WORLD and not body.visuals and not body.collisions for body in bodies)
    if not empty or len(at_world) != 1 or len(bodies) < 2:
        return bodies, edges
    ((joint, T_child_joint),) = at_world
    turned = joint.T_parent_child[:3, :3] @ T_child_joint[:3, :3].T
    if joint.kind is not JointType.FIXED or not np.allclose(turned, np.eye(3), atol=_UPRIGHT):
        return bodies, edges
    return [body for body in bodies if body.name != WORLD], [edge for edge in edges if edge[0] is not joint]


def _free(root: str, body: str, T_root_body: FloatArray) -> Joint:
    kind, name = JointType.FIXED, f"{body}_free"
    return Joint(name=name, kind=kind, parent=root, child=body, T_parent_child=T_root_body, declared_kind="floating")


def _reversed(joint: Joint, T_child_joint: FloatArray) -> Edge:
    turned = replace(joint, parent=joint.child, child=joint.parent, T_parent_child=T_child_joint, axis=-joint.axis)
    return turned, joint.T_parent_child


def _at_child(joint: Joint, T_child_joint: FloatArray, offset: FloatArray) -> Joint:
    """A joint in the axes of its child body, from the frame of the parent link."""
    rotation = T_child_joint[:3, :3]
    T = joint.T_parent_child.copy()
    T[:3, 3] -= offset
    T[:3, :3] = T[:3, :3] @ rotation.T
    return replace(joint, T_parent_child=T, axis=rotation @ joint.axis)


def _moved(body: Link, offset: FloatArray) -> Link:
    """A body with its frame at a point of it."""
    if not offset.any():
        return body
    inertial = body.inertial
    return replace(
        body,
        inertial=inertial and replace(inertial, center_of_mass=inertial.center_of_mass - offset),
        visuals=tuple(_moved_shape(shape, offset) for shape in body.visuals),
        collisions=tuple(_moved_shape(shape, offset) for shape in body.collisions),
    )


def _moved_shape(shape: Shape, offset: FloatArray) -> Shape:
    T = shape.T_link_shape.copy()
    T[:3, 3] -= offset
    mesh = LinkMesh(vertices=shape.mesh.vertices - offset, faces=shape.mesh.faces, appearance=shape.mesh.appearance)
    return replace(shape, mesh=mesh, T_link_shape=T)
