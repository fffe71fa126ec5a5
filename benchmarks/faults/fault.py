"""A fault that can be planted, and the good models that faults are planted in."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.assembly.part import Part
from kinematify.config import load_config
from kinematify.model.masses import inertial_of
from kinematify.robot.read import read_robot

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from lxml.etree import _Element

    from kinematify.evaluation.datasets import BenchObject
    from kinematify.robot.robot import Joint, Link, Robot
    from kinematify.validation.finding import Cause


@dataclass(frozen=True, kw_only=True)
class PlantedFault:
    """Where a fault was planted."""

    how: str
    """What was done, with numbers."""
    joint: str | None
    """Joint that must be named, or the joint that carries the link."""
    links: tuple[str, ...]
    """Links of which one may be named instead; empty where the whole model is wrong and any name is right."""


JointPlanter = Callable[["_Element", "Joint", "Robot", "np.random.Generator"], PlantedFault | None]
"""Changes the robot element in place; None where the fault would change nothing, so that there is none."""
LinkPlanter = Callable[["_Element", "Link", "Robot", "np.random.Generator"], PlantedFault | None]


@dataclass(frozen=True, kw_only=True)
class Fault:
    """A kind of fault."""

    name: str
    kinematic: bool
    """A motion is wrong; otherwise the file is."""
    causes: frozenset[Cause]
    """A finding must put one of these."""
    plant_joint: JointPlanter | None = None
    plant_link: LinkPlanter | None = None


UNTOUCHED = "untouched"


@dataclass(frozen=True, kw_only=True)
class BaseModel:
    """A good model on disk."""

    name: str
    folder: Path
    """Faulty copies are written beside it, so that they share its meshes."""

    @property
    def urdf(self) -> Path:
        """The untouched URDF."""
        return self.folder / f"{UNTOUCHED}.urdf"

    def tree(self) -> etree._Element:
        """The robot element, for changing."""
        return etree.parse(self.urdf, etree.XMLParser(remove_comments=True)).getroot()

    def robot(self) -> Robot:
        """Links, joints and meshes."""
        return read_robot(self.urdf, geometry="shown")


def write_base(item: BenchObject, work: Path) -> BaseModel:
    """Give an object what it lacks and write it into a folder of its own, with a link to its meshes."""
    folder = work / item.name
    folder.mkdir(parents=True, exist_ok=True)
    meshes = folder / "meshes"
    if not meshes.is_symlink():
        meshes.symlink_to(item.urdf.resolve().parent / "meshes")
    base = BaseModel(name=item.name, folder=folder)
    robot = read_robot(item.urdf, geometry="shown")
    root = etree.parse(item.urdf, etree.XMLParser(remove_blank_text=True, remove_comments=True)).getroot()
    for link in root.findall("link"):
        _complete(link, robot.link_by_name[link.get("name") or ""])
    write_model(root, base.urdf)
    return base


def write_model(robot: etree._Element, path: Path) -> None:
    """Write a robot element as a URDF file."""
    etree.ElementTree(robot).write(path, pretty_print=True, xml_declaration=True, encoding="utf-8")


def _complete(element: etree._Element, link: Link) -> None:
    if not link.has_geometry:
        return
    if element.find("collision") is None:
        for visual in element.findall("visual"):
            collision = copy.deepcopy(visual)
            collision.tag = "collision"
            element.append(collision)
    if element.find("inertial") is None:
        element.insert(0, _inertial(link_part(link)))


def link_part(link: Link) -> Part:
    """All geometry of a link as one part, in the link frame."""
    counts = np.cumsum([0, *(len(mesh.vertices) for mesh in link.meshes)])
    return Part(
        name=link.name,
        vertices=np.concatenate([mesh.vertices for mesh in link.meshes]),
        faces=np.concatenate([mesh.faces + start for mesh, start in zip(link.meshes, counts, strict=False)]),
    )


def _inertial(part: Part) -> etree._Element:
    config = load_config().model
    mass = inertial_of(part, np.zeros(3), thickness=config.min_thickness * part.diagonal, config=config)
    element = etree.Element("inertial")
    etree.SubElement(element, "origin", xyz=words(mass.center_of_mass), rpy="0 0 0")
    etree.SubElement(element, "mass", value=repr(float(mass.mass)))
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = mass.tensor.tolist()
    moments = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    etree.SubElement(element, "inertia", {key: repr(value) for key, value in moments.items()})
    return element


def words(numbers: np.ndarray | list[float]) -> str:
    """Numbers as URDF writes vectors, without loss."""
    return " ".join(repr(float(value)) for value in numbers)
