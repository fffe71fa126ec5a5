"""What goes into another format: the URDF's tree, what is seen, convex pieces that engines collide, usable masses.

Engines take the hull of a mesh for the mesh, so that a drawer would be solid and its cabinet too. What collides is
therefore what `kinematify validate` simulates: primitives, and meshes cut into convex pieces.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import Overlap
from kinematify.geometry.rest import Allowance
from kinematify.geometry.scene import read_scene
from kinematify.model.collision_pieces import decomposed
from kinematify.model.masses import prepared_inertials
from kinematify.robot.description import parse_description
from kinematify.robot.read import read_model

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.config.validation import PrepareSettings, ValidationSettings
    from kinematify.model.collision_pieces import Pieces
    from kinematify.model.masses import PreparedInertial
    from kinematify.robot.arrays import FloatArray, IntArray
    from kinematify.robot.declared import DeclaredJoint, DeclaredLink, DeclaredModel, DeclaredShape

GREY = (0.7, 0.7, 0.7, 1.0)
MESH = "mesh"
WORLD = "world"
"""What MuJoCo and Gazebo call the outside."""
_LEAST_VERTICES = 4  # engines refuse meshes with fewer


@dataclass(frozen=True, kw_only=True, eq=False)
class Shape:
    """One thing to be seen or to collide with, in its link's frame."""

    kind: str
    """``mesh``, ``box``, ``cylinder``, ``sphere`` or ``capsule``."""
    vertices: FloatArray
    """Triangles of all kinds, primitives tessellated; link frame [m], shape (V, 3)."""
    faces: IntArray
    """Shape (F, 3)."""
    size: tuple[float, ...]
    """Of a primitive, as in `DeclaredShape`; empty for a mesh."""
    T_link_shape: FloatArray
    """Of a primitive; the identity for a mesh, whose vertices are in the link's frame; shape (4, 4)."""
    color: tuple[float, ...]
    """Red, green, blue, opacity in [0, 1]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """A link."""

    name: str
    visuals: tuple[Shape, ...]
    collisions: tuple[Shape, ...]
    """Convex, each of them."""
    inertial: PreparedInertial


@dataclass(frozen=True, kw_only=True, eq=False)
class Content:
    """Everything that a format may hold."""

    name: str
    bodies: tuple[Body, ...]
    joints: tuple[DeclaredJoint, ...]
    """In the order of the document, fixed ones included."""
    model: DeclaredModel
    apart: tuple[tuple[str, str], ...]
    """Links that are not to collide: neighbours in the tree, and those in contact at rest."""
    settings: PrepareSettings
    """What joints without effort and velocity get."""
    notes: tuple[str, ...]
    """What was made up or changed, one sentence each."""

    @property
    def root(self) -> str:
        """Link that hangs on none."""
        return self.model.kinematics.root


def body_name(link: str) -> str:
    """Name of a link where `WORLD` is taken."""
    return f"{link}_link" if link == WORLD else link


def told_renaming(content: Content) -> list[str]:
    """A sentence where a link had to be renamed."""
    renamed = any(body.name == WORLD for body in content.bodies)
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
    model = read_model(urdf, package_dirs=package_dirs)
    inertials = prepared_inertials(model, settings.prepare)
    pieces = decomposed(model, settings.prepare)
    colors = _colors(parse_description(urdf))
    bodies = []
    for link in model.links:
        found = pieces[link.name]
        color = colors.get(link.name, ())
        hulls = [_mesh(piece.vertices, piece.faces, GREY) for piece in found.convex]
        bodies.append(
            Body(
                name=link.name,
                visuals=_visuals(link, color),
                collisions=(*(_shape(primitive, GREY) for primitive in found.primitives), *hulls),
                inertial=inertials[link.name],
            )
        )
    return Content(
        name=model.name,
        bodies=tuple(bodies),
        joints=model.joints,
        model=model,
        apart=_apart(model, settings),
        settings=settings.prepare,
        notes=tuple(_notes(model, inertials, pieces)),
    )


def _notes(model: DeclaredModel, inertials: dict[str, PreparedInertial], pieces: dict[str, Pieces]) -> list[str]:
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


def _visuals(link: DeclaredLink, colors: Sequence[tuple[float, ...]]) -> tuple[Shape, ...]:
    """What is seen: collision geometry where there is nothing else, as viewers do."""
    shown = link.visuals or link.collisions
    found = []
    for number, shape in enumerate(shown):
        if shape.kind != MESH or len(np.unique(shape.mesh.faces)) >= _LEAST_VERTICES:
            found.append(_shape(shape, colors[number] if number < len(colors) and link.visuals else GREY))
    return tuple(found)


def _shape(shape: DeclaredShape, color: tuple[float, ...]) -> Shape:
    if shape.kind == MESH:
        return _mesh(shape.mesh.vertices, shape.mesh.faces, color)
    return Shape(
        kind=shape.kind,
        vertices=shape.mesh.vertices,
        faces=shape.mesh.faces,
        size=shape.size,
        T_link_shape=shape.T_link_shape,
        color=color,
    )


def _mesh(vertices: FloatArray, faces: IntArray, color: tuple[float, ...]) -> Shape:
    return Shape(kind=MESH, vertices=vertices, faces=faces, size=(), T_link_shape=np.eye(4), color=color)


def _colors(robot: _Element) -> dict[str, list[tuple[float, ...]]]:
    """Colour of every visual element, by link; grey where none is stated."""
    named = {material.get("name"): color for material in robot.iter("material")
             for color in [_color(material)] if color is not None}  # fmt: skip
    return {
        str(link.get("name")): [_visual_color(visual, named) for visual in link.findall("visual")]
        for link in robot.findall("link")
    }


def _visual_color(visual: _Element, named: dict[str | None, tuple[float, ...]]) -> tuple[float, ...]:
    material = visual.find("material")
    if material is None:
        return GREY
    return _color(material) or named.get(material.get("name"), GREY)


def _color(material: _Element) -> tuple[float, ...] | None:
    color = material.find("color")
    try:
        values = tuple(float(word) for word in str(color.get("rgba")).split()) if color is not None else ()
    except ValueError:
        return None
    return values if len(values) == 4 and all(0.0 <= value <= 1.0 for value in values) else None


def _apart(model: DeclaredModel, settings: ValidationSettings) -> tuple[tuple[str, str], ...]:
    """Pairs of links that touch where nothing is wrong: neighbours, and what is in contact at rest."""
    scene = read_scene(model, settings.geometry)
    allowance = Allowance(scene, Overlap(scene))
    pairs = [pair for pair, rest in allowance.pairs.items() if rest.joined or rest.collide or rest.contained]
    shown = [[name for name in body.links if model.link_by_name[name].has_geometry] for body in scene.bodies]
    return tuple((first, second) for a, b in sorted(pairs) for first in shown[a] for second in shown[b])
