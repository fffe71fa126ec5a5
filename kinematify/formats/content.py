"""What goes into another format: the URDF's tree, what is seen, convex pieces that engines collide, usable masses.

Engines take the hull of a mesh for the mesh, so that a drawer would be solid and its cabinet too. What collides is
therefore what `kinematify validate` simulates: primitives, and meshes cut into convex pieces.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import Overlap
from kinematify.geometry.rest import Allowance
from kinematify.geometry.scene import read_scene
from kinematify.model.collision_pieces import decomposed
from kinematify.model.masses import prepared_inertials
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Link, LinkMesh, Shape

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings, ValidationSettings
    from kinematify.model.collision_pieces import Pieces
    from kinematify.model.masses import PreparedInertial
    from kinematify.robot.robot import Robot

GREY = (0.7, 0.7, 0.7, 1.0)
"""Of shapes whose colour the file does not state."""
WORLD = "world"
"""What MuJoCo and Gazebo call the outside."""
_LEAST_VERTICES = 4  # engines refuse meshes with fewer


@dataclass(frozen=True, kw_only=True, eq=False)
class Content:
    """Everything that a format may hold."""

    robot: Robot
    """Collision shapes are convex, each of them, and meshes stand in the frame of their link; every link that is not a
    mere frame has a mass."""
    settings: PrepareSettings
    """What joints without effort and velocity get where a format demands them."""
    apart: tuple[tuple[str, str], ...]
    """Links that are not to collide: neighbours in the tree, and those in contact at rest."""
    notes: tuple[str, ...]
    """What was made up or changed, one sentence each."""


def body_name(link: str) -> str:
    """Name of a link where `WORLD` is taken."""
    return f"{link}_link" if link == WORLD else link


def told_renaming(content: Content) -> list[str]:
    """A sentence where a link had to be renamed."""
    renamed = WORLD in content.robot.link_by_name
    return [f"The link {WORLD!r} is named {body_name(WORLD)!r}, since the outside is called so."] if renamed else []


def read_content(urdf: Path, settings: ValidationSettings, *, package_dirs: Sequence[Path] = ()) -> Content:
    """Read a URDF and make what engines need.

    Args:
        urdf: The file.
        settings: Of decomposition, masses and contacts at rest.
        package_dirs: Where packages lie (``package://``).

    Raises:
        InputError: The URDF cannot be used.
    """
    model = read_robot(urdf, package_dirs=package_dirs)
    inertials = prepared_inertials(model, settings.prepare)
    pieces = decomposed(model, settings.prepare)
    links = tuple(
        Link(
            name=link.name,
            inertial=inertials[link.name] if inertials[link.name].mass > 0.0 else None,
            visuals=_visuals(link),
            collisions=(
                *pieces[link.name].primitives,
                *(
                    Shape(mesh=LinkMesh(vertices=piece.vertices, faces=piece.faces))
                    for piece in pieces[link.name].convex
                ),
            ),
        )
        for link in model.links
    )
    return Content(
        robot=replace(model, links=links),
        settings=settings.prepare,
        apart=_apart(model, settings),
        notes=tuple(_notes(model, inertials, pieces)),
    )


def _notes(model: Robot, inertials: dict[str, PreparedInertial], pieces: dict[str, Pieces]) -> list[str]:
    weighed = [link.name for link in model.links if inertials[link.name].mass_added and link.has_geometry]
    notes = []
    cut = [name for name, found in pieces.items() if len(found.convex) > 1]
    if cut:
        farthest = max(cut, key=lambda name: pieces[name].gap)
        notes.append(
            f"The collision geometry of {len(cut)} links is several convex pieces each; they reach at most "
            f"{1e3 * pieces[farthest].gap:.2g} mm beyond the surface ({farthest})."
        )
    if weighed:
        notes.append(f"{len(weighed)} links state no usable mass and weigh what their volume suggests: "
                     f"{', '.join(weighed[:4])}{', ...' if len(weighed) > 4 else ''}.")  # fmt: skip
    free = [joint.name for joint in model.joints if joint.declared_kind in ("floating", "planar")]
    if free:
        notes.append(f"Joints that are floating or planar are written as fixed: {', '.join(free)}.")
    return notes


def _visuals(link: Link) -> tuple[Shape, ...]:
    """What is seen: collision geometry where there is nothing else, as viewers do."""
    shown = [
        shape
        for shape in link.visuals or link.collisions
        if shape.kind != "mesh" or len(np.unique(shape.mesh.faces)) >= _LEAST_VERTICES
    ]
    return tuple(Shape(mesh=shape.mesh, color=shape.color) if shape.kind == "mesh" else shape for shape in shown)


def _apart(model: Robot, settings: ValidationSettings) -> tuple[tuple[str, str], ...]:
    """Pairs of links that touch where nothing is wrong: neighbours, and what is in contact at rest."""
    scene = read_scene(model, settings.geometry)
    allowance = Allowance(scene, Overlap(scene))
    pairs = [pair for pair, rest in allowance.pairs.items() if rest.joined or rest.collide or rest.contained]
    shown = [[name for name in body.links if model.link_by_name[name].has_geometry] for body in scene.bodies]
    return tuple((first, second) for a, b in sorted(pairs) for first in shown[a] for second in shown[b])
