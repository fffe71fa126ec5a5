"""Other people's URDFs made to work in engines: collision pieces carved by the motion, missing masses and friction.

The document is edited in place: what is not mentioned in `Fix.changes` stays as it is, comments and order included.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.errors import OutputError
from kinematify.model.collision import fit_collision
from kinematify.model.dynamics import with_dynamics
from kinematify.model.masses import prepared_inertials
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.read import read_robot
from kinematify.robot.robot import Inertial, Robot
from kinematify.robot.write import robot_element

if TYPE_CHECKING:
    from collections.abc import Sequence

    from lxml.etree import _Element

    from kinematify.config import Config
    from kinematify.config.validation import ValidationSettings
    from kinematify.model.collision import FittedCollision
    from kinematify.robot.robot import Link

_PLACEHOLDER = 1e3
"""Efforts and velocities of this size, and limits, are no numbers that someone has measured."""


@dataclass(frozen=True, kw_only=True)
class Fix:
    """A file that was written."""

    path: Path
    changes: tuple[str, ...]
    """What is other than in the given file, one sentence each."""
    left: tuple[str, ...]
    """What was seen and left as it is."""


def fix_urdf(
    model: Path, out: Path, config: Config, settings: ValidationSettings, *, package_dirs: Sequence[Path] = ()
) -> Fix:
    """Write a URDF that engines simulate as they read it.

    Args:
        model: The URDF; it is not changed.
        out: File to write; its collision meshes stand in a folder beside it.
        config: Clearance and friction.
        settings: How surfaces are taken apart, and when they block a motion.
        package_dirs: Folders in which ``package://`` names are looked up.

    Raises:
        DescriptionError: `model` cannot be read.
        OutputError: `out` is `model`, or cannot be written.
    """
    if out.resolve() == model.resolve():
        raise OutputError(f"{out} is the model itself, which stays as it is. Give another file with -o.")
    robot = read_robot(model, package_dirs=package_dirs)
    fitted = fit_collision(robot, config.collision, settings.prepare, settings.geometry)
    inertials = prepared_inertials(robot, settings.prepare)
    weighed = replace(robot, links=tuple(replace(link, inertial=inertials[link.name]) for link in robot.links))
    moved = with_dynamics(weighed, config.dynamics, measured=True)
    document = etree.parse(str(model), etree.XMLParser(resolve_entities=False))
    root, changes = document.getroot(), list[str]()
    folder = Path(f"{out.stem}_collision")
    links = {element.get("name"): element for element in root.iterchildren("link")}
    for link in fitted.robot.links:
        made = inertials[link.name]
        shapes = tuple(
            replace(shape, file=folder / shape.file.name) if shape.file is not None else shape
            for shape in link.collisions
        )
        given = replace(link, collisions=shapes, visuals=(), inertial=Inertial(
            mass=made.mass, center_of_mass=made.center_of_mass, tensor=made.tensor
        ))  # fmt: skip
        written = robot_element(Robot(name=robot.name, links=(given,), joints=()))[0]
        if shapes:
            _replaced(links[link.name], "collision", written.findall("collision"))
            changes.append(f"{link.name}: {len(shapes)} collision pieces instead of {_collisions(robot, link)}")
        if (made.mass_added or made.inertia_added) and link.has_geometry:
            _replaced(links[link.name], "inertial", written.findall("inertial"))
            changes.append(f"{link.name}: mass properties of its geometry, {made.mass:.3g} kg")
    joints = {element.get("name"): element for element in root.iterchildren("joint")}
    for before, after in zip(robot.joints, moved.joints, strict=True):
        if after.damping != before.damping or after.friction != before.friction:
            values = {"damping": repr(after.damping), "friction": repr(after.friction)}
            _replaced(joints[after.name], "dynamics", [etree.Element("dynamics", values)])
            changes.append(f"{after.name}: damping {after.damping:g}, friction {after.friction:g}")
    _moved_meshes(root, model.resolve().parent, out.resolve().parent)
    _write(document, fitted, folder, out)
    return Fix(path=out, changes=tuple(changes), left=tuple(_left(robot, fitted)))


def _collisions(robot: Robot, link: Link) -> str:
    before = len(robot.link_by_name[link.name].collisions)
    return f"{before} shapes" if before else "the visual geometry"


def _replaced(parent: _Element, tag: str, elements: Sequence[_Element]) -> None:
    """Put elements in the place of those of the same tag, else at the end."""
    old = parent.findall(tag)
    place = parent.index(old[0]) if old else len(parent)
    for element in old:
        parent.remove(element)
    for number, element in enumerate(elements):
        element.tail = "\n    "
        etree.indent(element, space="  ", level=2)
        parent.insert(place + number, element)


def _moved_meshes(root: _Element, before: Path, after: Path) -> None:
    """Let mesh paths that are relative to the file mean the same from another folder."""
    for mesh in root.iter("mesh"):
        name = mesh.get("filename", "")
        if before != after and name and "://" not in name and not Path(name).is_absolute() and (before / name).exists():
            mesh.set("filename", Path(os.path.relpath(before / name, after)).as_posix())


def _write(document: etree._ElementTree, fitted: FittedCollision, folder: Path, out: Path) -> None:
    shapes = [shape for link in fitted.robot.links for shape in link.collisions if shape.file is not None]
    try:
        (out.parent / folder).mkdir(parents=True, exist_ok=True)
        for shape in shapes:
            if shape.file is not None and shape.kind == "mesh":
                write_obj(out.parent / folder / shape.file.name, shape.mesh.vertices, shape.mesh.faces, OBJ_DIGITS)
        document.write(str(out), xml_declaration=True, encoding="utf-8")
    except OSError as error:
        raise OutputError(
            f"{out} cannot be written ({error.strerror or error}). Give another place with -o."
        ) from error


def _left(robot: Robot, fitted: FittedCollision) -> list[str]:
    said = [
        f"{item.joint}: {item.links[0]} and {item.links[1]} meet from {item.at:.3g} on and get "
        f"{item.depth * 1e3:.0f} mm into each other, by their surfaces; that stays"
        for item in fitted.blocked
    ]
    said += [
        f"{joint}: {first} and {second} still meet, each has one piece left" for joint, first, second in fitted.jams
    ]
    said += [
        f"{item.link}: its surface has so many triangles that it was looked at on a grid, {item.thinned * 1e3:.2g} mm "
        "off at most; it stays as it is"
        for item in fitted.links
        if item.thinned
    ]
    for joint in robot.leaders:
        numbers = {"lower": joint.lower, "upper": joint.upper, "effort": joint.effort, "velocity": joint.velocity}
        odd = [
            name for name, value in numbers.items() if value is not None and _PLACEHOLDER <= abs(value) < float("inf")
        ]
        if odd:
            said.append(f"{joint.name}: {' and '.join(odd)} look like placeholders")
    return said
