"""Content of another format: the URDF's tree, what is seen, the pieces that collide, usable masses.

The pieces are those that the file has. Engines take the hull of a mesh for the mesh, so that a drawer would be solid
and its cabinet too: a file whose meshes are not convex gets the pieces that `kinematify fix` writes.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinematify.config import load_config
from kinematify.formats.extensions import Extensions, read_extensions
from kinematify.geometry.rest_pairs import overlapping_links
from kinematify.geometry.scene import read_scene
from kinematify.model.collision import collides_as_it_is, fit_collision
from kinematify.model.masses import prepared_inertials
from kinematify.model.simulable import lacks_drive, unless_negative
from kinematify.robot.appearance import Material, plain, surfaces
from kinematify.robot.joint_type import JointType
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Link, Shape, joint_values

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings, ValidationSettings
    from kinematify.model.masses import PreparedInertial
    from kinematify.robot.appearance import Surface
    from kinematify.robot.robot import Joint, Robot


GREY = Material().color
"""Of shapes whose colour the file does not state."""
WORLD = "world"
"""What MuJoCo and Gazebo call the outside."""
_RESERVED = {"mjcf": {WORLD}, "sdf": {WORLD}, "usd": {"joints", "materials", "physics_scene"}, "glb": {WORLD}}
"""Names that no link may have, by format."""
_LEAST_VERTICES = 4  # engines refuse meshes with fewer
_ROUNDING = 1e-9
"""Change of a tensor that nobody needs to read of, fraction of its largest entry."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Content:
    """Everything that a format may hold."""

    robot: Robot
    """Collision shapes are convex, each of them, and meshes stand in the frame of their link; every link that is not a
    mere frame has a mass."""
    settings: PrepareSettings
    """What joints without effort and velocity get where a format demands them."""
    apart: tuple[tuple[str, str], ...]
    """Links that are not to collide, since they are in each other at rest."""
    notes: tuple[str, ...]
    """What was made up or changed, one sentence each."""
    old_links: tuple[str, ...]
    """Names in the URDF of the links of `robot`, which have those of the format."""
    old_joints: tuple[str, ...]
    extensions: Extensions
    """By the names of `robot`."""

    @property
    def root_joint(self) -> str:
        """A name for what fixes the root link to the outside."""
        taken = {*self.robot.link_by_name, *self.robot.joint_by_name, *(loop.name for loop in self.robot.loops)}
        return _allowed(["root_joint"], "", taken, "joint")[0]

    @property
    def undriven(self) -> tuple[Joint, ...]:
        """Joints that move by themselves and state no effort above zero."""
        return tuple(joint for joint in self.robot.joints if joint.leads and not (joint.effort or 0.0) > 0.0)


def read_content(urdf: Path, to: str, settings: ValidationSettings, *, package_dirs: Sequence[Path] = ()) -> Content:
    """Read a URDF and make what engines need.

    Args:
        urdf: The file.
        to: The format, which decides what links and joints may be named.
        settings: Of decomposition, masses and contacts at rest.
        package_dirs: Where packages lie (``package://``).

    Raises:
        InputError: The URDF cannot be used.
    """
    read = read_robot(urdf, package_dirs=package_dirs, appearance=True)
    model = _renamed(replace(read, joints=tuple(_engine_joint(read, joint) for joint in read.joints)), to)
    made = not collides_as_it_is(model)
    robot = model
    if made:
        robot = fit_collision(model, load_config().collision, settings.prepare, settings.geometry).robot
    inertials = prepared_inertials(model, settings.prepare)
    links = tuple(
        Link(
            name=link.name,
            inertial=inertials[link.name] if inertials[link.name].mass > 0.0 else None,
            visuals=_visuals(link),
            collisions=tuple(Shape(mesh=shape.mesh) if shape.kind == "mesh" else shape for shape in link.collisions),
        )
        for link in robot.links
    )
    old_links, old_joints = ([item.name for item in items] for items in (read.links, read.joints))
    return Content(
        robot=replace(robot, links=links),
        settings=settings.prepare,
        apart=overlapping_links(read_scene(robot, settings.geometry)),
        notes=(
            *(_physical_notes(read, model, inertials, made=made) if to != "glb" else ()),
            *_notes(read, model, settings.prepare, to),
        ),
        old_links=tuple(old_links),
        old_joints=tuple(old_joints),
        extensions=read_extensions(
            urdf,
            dict(zip(old_links, (link.name for link in links), strict=True)),
            dict(zip(old_joints, (joint.name for joint in robot.joints), strict=True)),
        ),
    )


def _engine_joint(robot: Robot, joint: Joint) -> Joint:
    """Without damping and friction below zero, which engines refuse; one that follows a fixed joint is held there."""
    joint = replace(joint, damping=unless_negative(joint.damping), friction=unless_negative(joint.friction))
    leader = joint
    while leader.mimic is not None:
        leader = robot.joint_by_name[leader.mimic.joint]
    if leader is joint or leader.kind is not JointType.FIXED:
        return joint
    T = joint.T_parent_child @ joint.motion(joint_values(robot, {})[joint.name])
    return replace(joint, kind=JointType.FIXED, T_parent_child=T, mimic=None, lower=0.0, upper=0.0)


def _renamed(robot: Robot, to: str) -> Robot:
    """Give names that the format allows; allowed ones are kept."""
    reserved = _RESERVED.get(to)
    if reserved is None:
        return robot
    links = _allowed([link.name for link in robot.links], to, reserved, "link")
    # SDFormat knows no two siblings of one name; elsewhere joints are no siblings of links.
    taken = {WORLD, *links} if to == "sdf" else set[str]()
    joints = _allowed([*robot.joint_by_name, *(loop.name for loop in robot.loops)], to, taken, "joint")
    return replace(with_names(robot, links, joints), name=_allowed([robot.name], to, reserved, "model")[0])


def with_names(robot: Robot, links: Sequence[str], joints: Sequence[str]) -> Robot:
    """Return a robot with other names of its links, and of its joints and perhaps its loops, in their order."""
    link_of = dict(zip(robot.link_by_name, links, strict=True))
    joint_of = dict(zip(robot.joint_by_name, joints, strict=False))

    def led(rule: Any) -> Any:
        return rule and replace(rule, joint=joint_of[rule.joint])

    loops = joints[len(robot.joints) :] or [loop.name for loop in robot.loops]
    return replace(
        robot,
        links=tuple(replace(link, name=link_of[link.name]) for link in robot.links),
        joints=tuple(
            replace(
                joint, name=joint_of[joint.name], parent=link_of[joint.parent], child=link_of[joint.child],
                mimic=led(joint.mimic), closure=led(joint.closure),
            )
            for joint in robot.joints
        ),
        loops=tuple(
            replace(loop, name=name, links=(link_of[loop.links[0]], link_of[loop.links[1]]))
            for loop, name in zip(robot.loops, loops, strict=True)
        ),
    )  # fmt: skip


def _allowed(names: Sequence[str], to: str, taken: Collection[str], what: str) -> list[str]:
    """Return a name for each; what is allowed keeps its own, others get theirs from what is left."""
    free = {name for name in names if _spelled(name, to) == name and name not in taken}
    used = {*taken, *free}
    found = []
    for name in names:
        stem = chosen = _spelled(name, to)
        number = 1
        while chosen in used and name not in free:
            chosen = f"{stem}_{what}" if number == 1 else f"{stem}_{what}_{number}"
            number += 1
        free.discard(name)
        used.add(chosen)
        found.append(chosen)
    return found


def _spelled(name: str, to: str) -> str:
    if to == "sdf":  # "::" separates scopes, and "__" at both ends is reserved
        name = name.replace("::", "_")
        return f"x{name}" if name[:2] == name[-2:] == "__" else name
    if to == "usd" and not name.isidentifier():
        name = re.sub(r"\W", "_", name)
        return name if name.isidentifier() else f"_{name}"
    return name


def _notes(read: Robot, model: Robot, settings: PrepareSettings, to: str) -> Iterable[str]:
    yield from read.notes
    for what, names, others in (
        ("link", list(read.link_by_name), list(model.link_by_name)),
        ("joint", list(read.joint_by_name), list(model.joint_by_name)),
    ):
        for old, new in zip(names, others, strict=True):
            if old != new:
                yield f"The {what} {old!r} is named {new!r}: its name is reserved, taken or not allowed here."
    for before, joint in zip(read.joints, model.joints, strict=True):
        if before.kind is not joint.kind:
            value = f"{joint_values(read, {})[before.name]:g} {'rad' if before.kind.turns else 'm'}"
            yield f"The joint {joint.name} follows a joint that is fixed, and is written as fixed at {value}."
        if to == "urdf" and lacks_drive(joint):
            yield (
                f"The joint {joint.name} states an effort of {joint.effort or 0:g} and a speed of "
                f"{joint.velocity or 0:g}; in place of zero it gets {settings.effort:g} and {settings.velocity:g}."
            )
    for link in model.links:
        if len(_visuals(link)) < len(link.visuals or link.collisions):
            yield f"What is seen of the link {link.name} leaves out meshes of fewer than {_LEAST_VERTICES} points."


def _physical_notes(read: Robot, model: Robot, inertials: dict[str, PreparedInertial], *, made: bool) -> Iterable[str]:
    if made:
        yield (
            "Not all meshes that collide are convex, as engines take them to be: what collides is the convex pieces "
            "that kinematify fix makes, carved by the motion."
        )
    for source, became in (("", "weigh what their volume suggests"), ("ball", "get a mass that is next to none")):
        added = [
            name for name, item in inertials.items() if item.mass_added and (item.source == "ball") == bool(source)
        ]
        if added:
            yield f"{len(added)} links state no usable mass and {became}: {', '.join(added)}."
    for link in model.links:
        after, before = inertials[link.name], link.inertial
        slack = _ROUNDING * float(np.abs(after.tensor).max())
        if before and not after.mass_added and np.abs(after.tensor - before.tensor).max() > slack:
            stated, written = (
                ", ".join(f"{moment:.5g}" for moment in np.linalg.eigvalsh(item.tensor)) for item in (before, after)
            )
            yield f"The inertia of the link {link.name} is changed, as no body has it: moments {stated} to {written}."
    for declared, joint in zip(read.joints, model.joints, strict=True):
        for key in ("damping", "friction"):
            if getattr(declared, key) != getattr(joint, key):
                yield f"The {key} of the joint {joint.name} is below zero ({getattr(declared, key):g}) and omitted."


def _visuals(link: Link) -> tuple[Shape, ...]:
    """Return what is seen: collision geometry where there is nothing else, as viewers do."""
    shown = [
        shape
        for shape in link.visuals or link.collisions
        if shape.kind != "mesh" or len(np.unique(shape.mesh.faces)) >= _LEAST_VERTICES
    ]
    return tuple(Shape(mesh=shape.mesh, color=shape.plain_color) if shape.kind == "mesh" else shape for shape in shown)


def shown_surfaces(shape: Shape) -> tuple[Surface, ...]:
    """Return what is seen of a shape, cut into its materials; one that states none has its colour, or grey."""
    appearance = shape.mesh.appearance or plain(shape.color or GREY, len(shape.mesh.faces))
    return surfaces(shape.mesh.vertices, shape.mesh.faces, appearance)
