"""Content of another format: the URDF's tree, what is seen, the pieces that collide, usable masses.

The pieces are those that the file has. Engines take the hull of a mesh for the mesh, so that a drawer would be solid
and its cabinet too: a file whose meshes are not convex gets the pieces that `kinematify fix` writes.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.config import load_config
from kinematify.geometry.rest_pairs import overlapping_links
from kinematify.geometry.scene import read_scene
from kinematify.model.collision import collides_as_it_is, fit_collision
from kinematify.model.masses import prepared_inertials
from kinematify.robot.appearance import Material, plain, surfaces
from kinematify.robot.material_files import write_texture
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Link, Shape

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kinematify.config.validation import PrepareSettings, ValidationSettings
    from kinematify.model.masses import PreparedInertial
    from kinematify.robot.appearance import Surface, Texture
    from kinematify.robot.robot import Robot


GREY = Material().color
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
    """Links that are not to collide, since they are in each other at rest."""
    notes: tuple[str, ...]
    """What was made up or changed, one sentence each."""


def body_name(link: str) -> str:
    """Name of a link where `WORLD` is taken."""
    return f"{link}_link" if link == WORLD else link


def renaming_notes(content: Content) -> list[str]:
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
    model = read_robot(urdf, package_dirs=package_dirs, appearance=True)
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
    return Content(
        robot=replace(robot, links=links),
        settings=settings.prepare,
        apart=overlapping_links(read_scene(robot, settings.geometry)),
        notes=tuple(_notes(model, inertials, made=made)),
    )


def _notes(model: Robot, inertials: dict[str, PreparedInertial], *, made: bool) -> list[str]:
    weighed = [link.name for link in model.links if inertials[link.name].mass_added and link.has_geometry]
    notes = list(model.notes)
    if made:
        notes.append(
            "Not all meshes that collide are convex, as engines take them to be: what collides is the convex pieces "
            "that kinematify fix makes, carved by the motion."
        )
    if weighed:
        notes.append(f"{len(weighed)} links state no usable mass and weigh what their volume suggests: "
                     f"{', '.join(weighed[:4])}{', ...' if len(weighed) > 4 else ''}.")  # fmt: skip
    return notes


def _visuals(link: Link) -> tuple[Shape, ...]:
    """Return what is seen: collision geometry where there is nothing else, as viewers do."""
    shown = [
        shape
        for shape in link.visuals or link.collisions
        if shape.kind != "mesh" or len(np.unique(shape.mesh.faces)) >= _LEAST_VERTICES
    ]
    return tuple(Shape(mesh=shape.mesh, color=shape.color) if shape.kind == "mesh" else shape for shape in shown)


def shown_surfaces(shape: Shape) -> tuple[Surface, ...]:
    """Return what is seen of a shape, cut into its materials; one that states none has its colour, or grey."""
    appearance = shape.mesh.appearance or plain(shape.color or GREY, len(shape.mesh.faces))
    return surfaces(shape.mesh.vertices, shape.mesh.faces, appearance)


class MeshFiles:
    """A folder beside the exported file; every mesh is written once, under a name of its own."""

    def __init__(self, out: Path) -> None:
        """Create the folder ``<stem>_meshes`` beside `out`.

        Raises:
            OSError: It cannot be created.
        """
        self.folder = out.parent / f"{out.stem}_meshes"
        self.folder.mkdir(exist_ok=True)
        self._count = 0
        self._textures: dict[Texture, str] = {}

    def write(self, shape: Shape, link: str) -> str:
        """Write a mesh in its link's frame, with its materials beside it, and return its file name."""
        name = self._name(link, "obj")
        appearance = shape.mesh.appearance
        says_more = appearance is not None and (len(appearance.materials) > 1 or appearance.is_textured)
        write_obj(
            self.folder / name, shape.mesh.vertices, shape.mesh.faces, OBJ_DIGITS, appearance if says_more else None
        )
        return name

    def write_surface(self, surface: Surface, link: str) -> str:
        """Write the faces of one material, with their places in its texture but without the material."""
        name = self._name(link, "obj")
        write_obj(self.folder / name, surface.vertices, surface.faces, OBJ_DIGITS, uv=surface.uv)
        return name

    def write_texture(self, texture: Texture) -> str:
        """Write a picture once and return its file name."""
        if texture not in self._textures:
            self._textures[texture] = self._name("texture", "png")
            write_texture(self.folder / self._textures[texture], texture)
        return self._textures[texture]

    def _name(self, link: str, suffix: str) -> str:
        name = f"{self._count:03d}_{re.sub(r'[^A-Za-z0-9_-]', '_', link)[:60]}.{suffix}"
        self._count += 1
        return name
