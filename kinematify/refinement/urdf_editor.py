"""A URDF that is edited in place: what no method is asked to change stays, comments and order included."""

from __future__ import annotations

import copy
import difflib
import os
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from lxml import etree

from kinematify.errors import AssemblyError, DescriptionError, OutputError
from kinematify.model.collision import fit_collision
from kinematify.model.dynamics import with_dynamics
from kinematify.model.masses import prepared_inertials
from kinematify.robot.mesh_file import read_meshes
from kinematify.robot.mesh_paths import find_mesh, near_mesh
from kinematify.robot.obj_file import OBJ_DIGITS, write_obj
from kinematify.robot.raw_mesh import merged
from kinematify.robot.robot import Inertial, Robot
from kinematify.robot.transforms import rpy_of
from kinematify.robot.urdf_geometry import geometry_source
from kinematify.robot.urdf_numbers import origin_transform
from kinematify.robot.urdf_text import parse_description, read_text, with_prefixes
from kinematify.robot.write import numbers, robot_element
from kinematify.validation.asset.rigid_bodies import Rooms
from kinematify.validation.asset.slips import fits_box, slip_of

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping, Sequence

    from lxml.etree import _Element

    from kinematify.config import Config
    from kinematify.config.validation import PrepareSettings, ValidationSettings
    from kinematify.model.collision import FittedCollision
    from kinematify.robot.raw_mesh import RawMesh
    from kinematify.robot.robot import Link, LinkMesh

_FILES = ("mesh", "texture")
"""Elements whose ``filename`` names a file."""


@dataclass(frozen=True, kw_only=True)
class Diff:
    """One change of an element."""

    title: str
    """What was changed, one sentence."""
    lines: str
    """Unified diff of the element as XML."""


class UrdfEditor:
    """The document, and the files that are to be written with it."""

    def __init__(self, model: Path, out: Path, package_dirs: Sequence[Path] = ()) -> None:
        """Read the document.

        Args:
            model: The URDF; it is not changed.
            out: File to write; its collision meshes get a folder beside it.
            package_dirs: Folders in which ``package://`` names are looked up.

        Raises:
            DescriptionError: `model` is no URDF that can be parsed.
            OutputError: `out` is `model`.
        """
        if out.resolve() == model.resolve():
            raise OutputError(f"{out} is the model itself, which stays as it is. Give another file with -o.")
        parse_description(model)
        parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
        self.root = etree.fromstring(with_prefixes(read_text(model).text), parser)
        self._changes: list[str] = []
        self._path_changes: list[str] = []
        self.diffs: list[Diff] = []
        self._model, self.out, self._package_dirs = model, out, tuple(package_dirs)
        self._folder, self._copies_folder = Path(f"{out.stem}_collision"), Path(f"{out.stem}_meshes")
        self._copies: dict[str, RawMesh] = {}
        """Meshes in another format than the given file, by what the document names."""
        self._pieces: dict[str, dict[str, LinkMesh]] = {}
        self._written: set[str] = set()

    @property
    def changes(self) -> tuple[str, ...]:
        """Return what is other than in the given file, one sentence each; paths as they were written last."""
        return (*self._changes, *self._path_changes)

    def say(self, sentence: str) -> None:
        """Keep what was changed in an element that `link` or `joint` returned."""
        self._changes.append(sentence)

    def link(self, name: str) -> _Element:
        """Element of a link."""
        return next(element for element in self.root.iterchildren("link") if element.get("name") == name)

    def joint(self, name: str) -> _Element:
        """Element of a joint."""
        return next(element for element in self.root.iterchildren("joint") if element.get("name") == name)

    @contextmanager
    def diffed(self, title: str, *elements: _Element) -> Iterator[None]:
        """Keep what is changed inside in elements as a unified diff."""
        before = [copy.deepcopy(element) for element in elements]
        yield
        lines = []
        for old, new in zip(before, elements, strict=True):
            name = f"{new.tag} {new.get('name')}"
            lines += list(
                difflib.unified_diff(xml_of(old).splitlines(), xml_of(new).splitlines(), name, name, lineterm="", n=1)
            )
        self.diffs.append(Diff(title=title, lines="\n".join(lines)))

    def carve(
        self,
        robot: Robot,
        links: frozenset[str],
        config: Config,
        settings: ValidationSettings,
        most_cut: float = 1.0,
    ) -> FittedCollision:
        """Give links collision pieces that leave the joints free; the others keep what they have.

        Args:
            robot: What the document says; pieces are made of its collision shapes, of visual ones where a link has no
                others.
            links: Names.
            config: Clearance.
            settings: How surfaces are taken apart, and when they block a motion.
            most_cut: Share of the volume of its pieces that a link may lose to the motion; one that would lose more
                keeps what it has.

        Returns:
            The pieces, with what could not be made free.
        """
        given = (robot, config.collision, settings.prepare, settings.geometry)
        fitted = fit_collision(*given, only=links)
        harmed = {item.link for item in fitted.links if item.link in links and item.carved > most_cut}
        if harmed:  # the others leave room for what these keep
            links -= harmed
            others = fit_collision(*given, only=links)
            lost = tuple(item for item in fitted.links if item.link in harmed)
            kept = tuple(item for item in others.links if item.link not in harmed)
            fitted = replace(others, links=(*kept, *lost))
        before = robot.link_by_name
        for link in fitted.robot.links:
            if link.name not in links or not link.collisions or _same(link, before[link.name]):
                continue
            element = self.link(link.name)
            had = len(element.findall("collision"))
            meshes = [shape for shape in link.collisions if shape.kind == "mesh" and shape.file is not None]
            self._pieces[link.name] = {shape.file.name: shape.mesh for shape in meshes if shape.file is not None}
            shapes = tuple(
                shape if shape.file is None else replace(shape, file=self._folder / shape.file.name)
                for shape in link.collisions
            )
            _replaced(element, "collision", _written(replace(link, collisions=shapes)).findall("collision"))
            self._changes.append(
                f"{link.name}: {_counted(len(shapes), 'collision piece')} instead of "
                f"{_counted(had, 'shape') if had else 'the visual geometry'}"
            )
        return fitted

    def export_obj(self, unread: Mapping[str, Collection[str]]) -> list[str]:
        """Name copies as OBJ, with colours, of meshes in formats that engines do not read.

        Args:
            unread: Suffixes of these formats, by ``visual`` and ``collision``.

        Returns:
            Meshes that cannot be read, one sentence each.
        """
        named: dict[str, list[_Element]] = {}
        for tag, suffixes in unread.items():
            for mesh in self.root.iterfind(f"link/{tag}/geometry/mesh"):
                if Path(mesh.get("filename", "")).suffix.lower() in suffixes:
                    named.setdefault(mesh.get("filename", ""), []).append(mesh)
        failed, before = [], len(self._copies)
        for name, elements in named.items():
            found = self._found(name, (self._model.parent.resolve(), *self._mesh_folders()))
            try:
                if found is None:
                    raise AssemblyError("It is not there.")
                mesh = merged(read_meshes(found[1], appearance=True), found[1].stem)
            except AssemblyError as error:
                failed.append(f"{name} is not written as OBJ: {error}")
                continue
            copy_name = (self._copies_folder / f"{len(self._copies)}_{found[1].stem}.obj").as_posix()
            self._copies[copy_name] = mesh
            for element in elements:
                element.set("filename", copy_name)
        if len(self._copies) > before:
            formats = " and ".join(sorted({Path(name).suffix.lower() for name in named}))
            added = _counted(len(self._copies) - before, "mesh", "meshes")
            self._changes.append(f"{added} as OBJ in {self._copies_folder}, since an engine reads no {formats}")
        return failed

    def write_rpy(self) -> None:
        """Write rotations as roll, pitch and yaw, where they are quaternions."""
        turned = [origin for origin in self.root.iter("origin") if "quat_xyzw" in origin.attrib]
        for origin in turned:
            parent = origin.getparent()
            if parent is not None:
                origin.set("rpy", numbers(rpy_of(origin_transform(parent, "the file")[:3, :3])))
                del origin.attrib["quat_xyzw"]
        self.say(f"{_counted(len(turned), 'rotation')} as rpy instead of quat_xyzw")

    def settle_shapes(self) -> None:
        """Name the mesh that is meant where a path leads nowhere, and drop elements without geometry that can be read.

        The only collision of a link stays, since without it the link would pass through everything.
        """
        folder = self._model.parent.resolve()
        source = geometry_source(self._model, self._package_dirs)
        for link in self.root.iterchildren("link"):
            for element in (*link.findall("visual"), *link.findall("collision")):
                if source.is_usable(element):
                    continue
                mesh = element.find("geometry/mesh")
                name = "" if mesh is None else mesh.get("filename", "")
                near = near_mesh(name, folder, self._package_dirs) if name else None
                others = [item for item in link.findall(str(element.tag)) if item is not element]
                if near is not None and mesh is not None and self._found(name, [folder, *self._mesh_folders()]) is None:
                    mesh.set("filename", Path(os.path.relpath(near, folder)).as_posix())
                    self.say(f"{link.get('name')}: {name!r} of a {element.tag} is {mesh.get('filename')!r}")
                elif element.tag == "visual" or any(map(source.is_usable, others)):
                    link.remove(element)
                    self.say(f"{link.get('name')}: no {xml_of(element)}, which has no geometry that can be read")

    def set_inertia(self, robot: Robot, links: Collection[str], settings: PrepareSettings) -> list[str]:
        """Write mass and inertia of the geometry for links whose own ones no engine can use, or repair one entry.

        Returns:
            Names of the links that got them.
        """
        bare = replace(robot, links=tuple(replace(link, inertial=_unturned(link.inertial)) for link in robot.links))
        made, by_shape = prepared_inertials(robot, settings), prepared_inertials(bare, settings)
        done = []
        for name in links:
            link, given = robot.link_by_name[name], made[name]
            room = Rooms().of([*link.visuals, *link.collisions])
            slip = None if link.inertial is None else slip_of(link.inertial, room)
            if slip is not None:
                given = replace(given, tensor=slip.tensor)
                what = f"{slip.entry} {slip.right:.6g} instead of {slip.given:.6g}"
            elif given.mass_added:
                what = f"mass and inertia of its geometry, {given.mass:.3g} kg"
            elif given.inertia_added:
                given = given if room is None or fits_box(given, room) else by_shape[name]
                what = "a sound inertia"
            else:
                continue
            plain = Inertial(mass=given.mass, center_of_mass=given.center_of_mass, tensor=given.tensor)
            link = replace(link, inertial=plain, collisions=())
            _replaced(self.link(name), "inertial", _written(link).findall("inertial"), at_front=True)
            self._changes.append(f"{name}: {what}")
            done.append(name)
        return done

    def center(self, robot: Robot, name: str, settings: PrepareSettings) -> None:
        """Move the centre of mass of a link to that of its geometry, if it has any."""
        link, inertial = robot.link_by_name[name], self.link(name).find("inertial")
        if inertial is None or not link.has_geometry:
            return
        alone = Robot(name=name, links=(replace(link, inertial=None),), joints=())
        center = prepared_inertials(alone, settings)[name].center_of_mass
        _origin(inertial).set("xyz", numbers(center))
        self._changes.append(
            f"{name}: centre of mass at {' '.join(f'{value:.4g}' for value in center)}, in its geometry"
        )

    def set_friction(self, robot: Robot) -> None:
        """Write friction and damping for joints that have none."""
        moved = with_dynamics(robot, measured=True)
        for before, after in zip(robot.joints, moved.joints, strict=True):
            if after.damping != before.damping or after.friction != before.friction:
                values = {"damping": repr(after.damping), "friction": repr(after.friction)}
                _replaced(self.joint(after.name), "dynamics", [etree.Element("dynamics", values)])
                self._changes.append(f"{after.name}: damping {after.damping:g}, friction {after.friction:g}")

    def write(self) -> Path:
        """Write the document, with paths that hold from its folder, and its meshes.

        Raises:
            OutputError: It cannot be written.
        """
        folder = self.out.parent / self._folder
        pieces = {name: mesh for of_link in self._pieces.values() for name, mesh in of_link.items()}
        document = copy.deepcopy(self.root.getroottree()).getroot()
        self._settle_paths(document)
        try:
            self.out.parent.mkdir(parents=True, exist_ok=True)
            for name in self._written - set(pieces):
                (folder / name).unlink(missing_ok=True)
            for name, mesh in pieces.items():
                folder.mkdir(exist_ok=True)
                write_obj(folder / name, mesh.vertices, mesh.faces, OBJ_DIGITS)
            for copy_name, copied in self._copies.items():
                (self.out.parent / self._copies_folder).mkdir(exist_ok=True)
                write_obj(self.out.parent / copy_name, copied.vertices, copied.faces, OBJ_DIGITS, copied.appearance)
            self._written = set(pieces)
            document.getroottree().write(str(self.out), xml_declaration=True, encoding="utf-8")
        except OSError as error:
            raise OutputError(
                f"{self.out} cannot be written ({error.strerror or error}). Give another place with -o."
            ) from error
        return self.out

    def _settle_paths(self, document: _Element) -> None:
        """Make paths of files mean the same from the new folder, for engines that know no packages.

        Pieces have names beside the new file, and MuJoCo looks for all meshes in ``meshdir``, so that goes.
        """
        self._path_changes = []
        before, after = self._model.parent.resolve(), self.out.parent.resolve()
        files = [element for tag in _FILES for element in document.iter(tag) if element.get("filename")]
        named = [element.get("filename", "") for element in files]
        own = {(self._folder / name).as_posix() for of_link in self._pieces.values() for name in of_link}
        own |= set(self._copies)
        if before == after and not own and not any("://" in name or "\\" in name for name in named):
            return
        compilers, folders = list(document.iterfind("mujoco/compiler")), self._mesh_folders()
        rewritten = []
        for element, name in zip(files, named, strict=True):
            written = name if name in own else self._path(name, (before, *folders), after)
            if written != name:
                element.set("filename", written)
                rewritten.append(name)
        for compiler in compilers:
            for attribute in ("meshdir", "assetdir"):
                if attribute in compiler.attrib:
                    del compiler.attrib[attribute]
                    self._path_changes.append(f"mujoco compiler: no {attribute}, since paths are relative to the file")
            if compiler.get("strippath") == "true":
                compiler.set("strippath", "false")
                self._path_changes.append('mujoco compiler: strippath="false", since paths are relative to the file')
        if rewritten:
            count = len(set(rewritten))
            self._path_changes.append(
                f"paths of {_counted(count, 'file')} are relative to {self.out.name}, such as {rewritten[0]}"
            )

    def _path(self, name: str, folders: Sequence[Path], after: Path) -> str:
        """Return what to write for a file; what is absolute, or found nowhere, stays."""
        found = None if Path(name).is_absolute() else self._found(name, folders)
        if found is None or ("://" not in name and "\\" not in name and found[0] == after):
            return name
        return Path(os.path.relpath(found[1].resolve(), after)).as_posix()

    def _found(self, name: str, folders: Sequence[Path]) -> tuple[Path, Path] | None:
        """Where a file is: the folder from which it was found, and its path."""
        for folder in folders:
            try:
                return folder, find_mesh(name, folder, self._package_dirs, "the file")
            except DescriptionError:
                continue
        return None

    def _mesh_folders(self) -> list[Path]:
        """Where MuJoCo looks for meshes."""
        compilers, folder = self.root.iterfind("mujoco/compiler"), self._model.parent.resolve()
        return [folder / (item.get("meshdir") or item.get("assetdir") or "") for item in compilers]


def _unturned(inertial: Inertial | None) -> Inertial | None:
    """Without a tensor."""
    return None if inertial is None else replace(inertial, tensor=np.zeros((3, 3)))


def _same(link: Link, before: Link) -> bool:
    """True if a link kept its primitives."""
    return [id(shape) for shape in link.collisions] == [id(shape) for shape in before.collisions]


def _counted(number: int, noun: str, several: str = "") -> str:
    return f"{number} {noun if number == 1 else several or f'{noun}s'}"


def _written(link: Link) -> _Element:
    return robot_element(Robot(name=link.name, links=(replace(link, visuals=()),), joints=()))[0]


def xml_of(element: _Element) -> str:
    """An element as it is written in its file, without what is around it."""
    alone = copy.deepcopy(element)
    etree.cleanup_namespaces(alone)
    return etree.tostring(alone, encoding="unicode", with_tail=False)


def _origin(element: _Element) -> _Element:
    """Its <origin>, made where there is none."""
    found = element.find("origin")
    if found is None:
        found = etree.Element("origin", xyz="0 0 0", rpy="0 0 0")
        found.tail = element.text
        element.insert(0, found)
    return found


def _replaced(parent: _Element, tag: str, elements: Sequence[_Element], *, at_front: bool = False) -> None:
    """Put elements in the place of those of the same tag, else at the end or the front."""
    old = parent.findall(tag)
    place = parent.index(old[0]) if old else 0 if at_front else len(parent)
    for element in old:
        parent.remove(element)
    for number, element in enumerate(elements):
        etree.indent(element, space="  ", level=2)
        element.tail = "\n    "
        parent.insert(place + number, element)
