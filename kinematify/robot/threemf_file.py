"""3MF files, by lib3mf of the consortium: objects in several part files, components, colours, names of slicers."""

from __future__ import annotations

import re
import zipfile
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any

import lib3mf
import numpy as np
from lxml import etree

from kinematify.robot.appearance import Appearance, Material
from kinematify.robot.mesh_paths import CAD_SUFFIXES, MESH_SUFFIXES
from kinematify.robot.raw_mesh import RawMesh, compacted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from kinematify.robot.arrays import FloatArray

_UNITS = ("micron", "millimeter", "centimeter", "inch", "foot", "meter")
"""In the order of lib3mf's numbers."""
_SETTINGS = ("Metadata/model_settings.config", "Metadata/Slic3r_PE_model.config")
"""Where Bambu Studio and OrcaSlicer, and PrusaSlicer, keep the names of parts."""
_TAG = re.compile(rb"<(?:[\w.-]+:)?(object|component)\b([^>]*)>")
_REQUIRED = re.compile(rb"requiredextensions\s*=\s*[\"']([^\"']*)")
_HEAD = 10_000
_ATTRIBUTE = re.compile(rb"([\w.:-]+)\s*=\s*[\"']([^\"']*)")
_MOST = 10_000
"""Times that a file may show its meshes; components of components multiply."""
_UNSUPPORTED = 0x8092
"""lib3mf's warning of a required extension that it does not read."""
_PART = ("", "normal_part", "ModelPart")
"""What slicers call that which is printed; modifiers, blockers and negative volumes are something else."""


def read_3mf(path: Path, *, appearance: bool = False) -> tuple[RawMesh, ...]:
    """Read the meshes of the build, or, where a slicer says which triangles are a part, these parts.

    Raises:
        OSError, ValueError, KeyError, zipfile.BadZipFile, lib3mf.ELib3MFException: It cannot be read, or needs an
            extension that is not.
    """
    with zipfile.ZipFile(path) as archive:
        required = _checked(archive)
        settings = [archive.read(name) for name in _SETTINGS if name in archive.namelist()]
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.ReadFromFile(str(path))
    if any(reader.GetWarning(k)[0] == _UNSUPPORTED for k in range(reader.GetWarningCount())):
        raise ValueError(
            f"it needs an extension that is not read (requiredextensions {required}); export it as plain 3MF"
        )
    content = _Content(model=model, parts=_slicer_parts(settings), appearance=appearance)
    items = model.GetBuildItems()
    meshes: list[RawMesh] = []
    while items.MoveNext():
        item = items.GetCurrent()
        shown = item.GetObjectResource()
        meshes += content.meshes(shown, _matrix(item.GetObjectTransform()), (), label=item.GetPartNumber())
    unit = _UNITS[int(model.GetUnit())]
    return tuple(replace(mesh, unit=unit, notes=tuple(content.unread)) for mesh in meshes)


def _checked(archive: zipfile.ZipFile) -> str:
    """Refuse components that multiply meshes, at which lib3mf never ends; return what extensions the file requires."""
    shown: dict[tuple[str, bytes], int] = {}
    required: dict[str, None] = {}
    names = [name for name in archive.namelist() if name.lower().endswith(".model")]
    for name in sorted(
        names, key=lambda name: name.lower() == "3d/3dmodel.model"
    ):  # the one that refers to others last
        text = archive.read(name)
        if text[:2] in (b"\xff\xfe", b"\xfe\xff"):
            text = text.decode("utf-16").encode()
        own, count = b"", 0
        for tag, written in _TAG.findall(text):
            stated = {key.rpartition(b":")[2]: value for key, value in _ATTRIBUTE.findall(written)}
            if tag == b"object":
                own, count = stated.get(b"id", b""), 0
            else:
                place = stated.get(b"path", b"").decode("utf-8", "replace").lstrip("/") or name
                count += shown.get((place, stated.get(b"objectid", b"")), 1)
                if count > _MOST:
                    raise ValueError(f"its components show a mesh more than {_MOST} times")
            shown[name, own] = max(count, 1)
        required |= dict.fromkeys(found.decode("utf-8", "replace") for found in _REQUIRED.findall(text[:_HEAD]))
    return " ".join(required)


def _matrix(transform: Any) -> FloatArray:
    """Shape (4, 4), of lib3mf's transform of rows."""
    matrix = np.eye(4)
    matrix[:3] = np.array([list(row) for row in transform.Fields], dtype=np.float64).T
    return matrix


def _rows(structures: list[Any], kind: str, width: int) -> Any:
    """Structures of lib3mf as an array, shape (n, width)."""
    return np.frombuffer(b"".join(map(bytes, structures)), kind).reshape(-1, width)


@dataclass(frozen=True, kw_only=True)
class _Part:
    """What a slicer says of a part."""

    name: str
    kind: str
    first: int
    last: int
    """Triangles of the object's mesh; -1 where the part is an object of its own."""


def _slicer_parts(settings: list[bytes]) -> dict[tuple[int, int], list[_Part]]:
    """Parts by the numbers of their object and of the component, which is -1 where parts are ranges of triangles."""
    found: dict[tuple[int, int], list[_Part]] = {}
    for text in settings:
        root = etree.fromstring(text, etree.XMLParser(resolve_entities=False, no_network=True))
        for part in root.iter("part", "volume"):
            stated = {item.get("key"): item.get("value", "") for item in part.iter("metadata")}
            stem = PurePosixPath(stated.get("name", "").replace("\\", "/"))
            made = _Part(
                name=stem.stem if stem.suffix.lower() in (*MESH_SUFFIXES, *CAD_SUFFIXES) else stem.name,
                kind=part.get("subtype") or stated.get("volume_type", ""),
                first=int(part.get("firstid", -1)),
                last=int(part.get("lastid", -1)),
            )
            holder = part.getparent()
            key = -1 if holder is None else int(holder.get("id", -1)), int(part.get("id", -1))
            found.setdefault(key, []).append(made)
    return found


@dataclass(kw_only=True)
class _Content:
    """A model and what was read of it."""

    model: Any
    parts: Mapping[tuple[int, int], list[_Part]]
    appearance: bool
    unread: dict[str, None] = field(default_factory=dict)
    read: dict[int, RawMesh] = field(default_factory=dict)
    """Mesh of every object with one, in its own frame."""
    shown: int = 0

    def meshes(
        self, item: Any, T_world_item: FloatArray, above: tuple[tuple[int, str], ...], owner: int = -1, label: str = ""
    ) -> Iterator[RawMesh]:
        """Meshes of an object and of its components, the latter named by the slicer or by their objects."""
        number, unique = item.GetModelResourceID(), item.GetUniqueResourceID()
        known = self.parts.get((owner, number)) or self.parts.get((number, -1)) or self.parts.get((number, number), [])
        name = label or item.GetName() or (known[0].name if owner >= 0 and known else "") or f"object_{number}"
        self.shown += 1
        if self.shown > _MOST:
            raise ValueError(f"it shows meshes more than {_MOST} times")
        holders = (*above, (self.shown, name))
        if item.IsComponentsObject():
            whole = self.model.GetComponentsObjectByID(item.GetResourceID())
            for k in range(whole.GetComponentCount()):
                part = whole.GetComponent(k)
                yield from self.meshes(
                    part.GetObjectResource(), T_world_item @ _matrix(part.GetTransform()), holders, number
                )
            return
        if not item.IsMeshObject() or int(item.GetType()) not in _SOLID:
            self.unread[f"the {_TYPES.get(int(item.GetType()), 'volume')} {name}"] = None
            return
        if unique not in self.read:
            self.read[unique] = self._mesh(item)
        mesh = self.read[unique].placed(T_world_item)
        for part in known or [_Part(name=name, kind="", first=-1, last=-1)]:
            if part.kind not in _PART:
                self.unread[f"the {part.kind} {part.name}"] = None
                continue
            own = mesh if part.first < 0 else compacted(mesh.of_faces(np.arange(part.first, part.last + 1)))
            yield replace(own, name=part.name or name, holders=(*holders[:-1], (self.shown, part.name or name)))

    def _mesh(self, item: Any) -> RawMesh:
        mesh = self.model.GetMeshObjectByID(item.GetResourceID())
        if mesh.BeamLattice().GetBeamCount():
            self.unread["beams"] = None
        vertices = _rows(mesh.GetVertices(), "<f4", 3).astype(np.float64)
        faces = _rows(mesh.GetTriangleIndices(), "<u4", 3).astype(np.int64)
        looks = self._looks(mesh) if self.appearance and len(faces) else None
        return RawMesh(name="", vertices=vertices, faces=faces, appearance=looks)

    def _looks(self, mesh: Any) -> Appearance | None:
        """Base materials and colours of the first corner of every triangle."""
        stated = _rows(mesh.GetAllTriangleProperties(), "<u4", 4)[:, :2]
        resource, number, usual = mesh.GetObjectLevelProperty()
        if usual:
            stated = np.where(stated[:, :1] == 0, [[resource, number]], stated)
        distinct, index = np.unique(stated, axis=0, return_inverse=True)
        materials = [self._material(int(group), int(k)) for group, k in distinct]
        if not any(materials):
            return None
        known = tuple(material or Material() for material in materials)
        return Appearance(materials=known, material_of_face=index.reshape(-1))

    def _material(self, group: int, number: int) -> Material | None:
        kind = self.model.GetPropertyTypeByID(group).name if group else ""
        if kind == "BaseMaterial":
            palette = self.model.GetBaseMaterialGroupByID(group)
            name, color = palette.GetName(number), palette.GetDisplayColor(number)
        elif kind == "Colors":
            name, color = "", self.model.GetColorGroupByID(group).GetColor(number)
        else:
            self.unread |= dict.fromkeys([f"{kind} properties"] if kind else [])
            return None
        red, green, blue, opacity = (value / 255.0 for value in (color.Red, color.Green, color.Blue, color.Alpha))
        return Material(name=name, color=(red, green, blue, opacity))


_SOLID = (0, 1, 4)
_TYPES = {2: "support", 3: "solid support"}
