"""Every form of input becomes an assembly: which files are opened, which way is up, what the unit is."""

from __future__ import annotations

import math
import stat
import tempfile
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.assemble import assemble, check_finite, natural_key, part_names
from kinematify.assembly.holders import hint_of_many, parts_of_holders, why_pieces
from kinematify.assembly.pieces import baked, connected_sheets, labelled_parts
from kinematify.assembly.scenes import one_object
from kinematify.assembly.units import METRE, UNITLESS, in_metres, size_warnings
from kinematify.config import load_config
from kinematify.errors import AssemblyError, InputError
from kinematify.robot.description import SUFFIXES, form_of
from kinematify.robot.lengths import length_text
from kinematify.robot.mesh_file import read_meshes, to_z_up
from kinematify.robot.mesh_paths import CAD_SUFFIXES, GLTF_SUFFIXES, MESH_SUFFIXES
from kinematify.robot.raw_mesh import RawMesh, merged
from kinematify.robot.read import read_robot
from kinematify.robot.robot import forward_kinematics, rest_configuration, rigid_groups
from kinematify.robot.vectors import referenced

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import AssemblyConfig
    from kinematify.robot.arrays import FloatArray


UP_CHOICES = ("auto", "x", "y", "z", "-x", "-y", "-z")
PIECES_CHOICES = ("auto", "group", "cut", "keep")
PART_SUFFIXES = (*MESH_SUFFIXES, *CAD_SUFFIXES)
"""Files that an assembly can be given as."""
_SILENT_SUFFIXES = (".mtl", ".bin", ".png", ".jpg", ".jpeg", ".json", ".txt", ".md")
"""Files beside meshes that nobody takes for a part."""
_ON_GROUND, _BELOW_GROUND = 0.005, 0.1
"""Of the object's diagonal: what is nearer lies on the ground, what is lower is under it."""
_STANDS, _LIES = 0.5, 0.1
"""Shares of a footprint with which an object rests for certain, and hardly can."""


@dataclass(frozen=True, kw_only=True)
class _Given:
    """Files found under the path."""

    meshes: Sequence[RawMesh]
    """One per part, in the frame and unit of the file but z up."""
    warnings: tuple[str, ...] = ()
    segmented: bool = True
    """The meshes are rigid parts, not pieces of them."""
    up_by_standard: bool = False
    """y was taken for up because glTF says so, and nobody else did."""


@dataclass(frozen=True, kw_only=True)
class _Reading:
    """Options of reading files."""

    up: str
    scale: float | None
    labels: Path | None
    pieces: str
    config: AssemblyConfig


def load_assembly(
    path: str | Path,
    *,
    config: AssemblyConfig | None = None,
    up: str = "auto",
    scale: float | None = None,
    labels: str | Path | None = None,
    pieces: str = "auto",
    number: int | None = None,
) -> Assembly:
    """Load an object in one static configuration as rigid parts.

    One part is: a node of a GLB, glTF or COLLADA file, an instance of a part in a STEP file, a file of a folder, a
    group or object of an OBJ, an object of a 3MF, a label of a mesh with labels, or a rigid group of links of a URDF,
    whose joints are not looked at. A ZIP may hold any of these. Parts are in natural order of their names. Ground truth
    written by `erase` is never opened.

    A mesh without labels is split into connected pieces, of which several may be one rigid part: the assembly is then
    not `segmented`, and `kinematify.infer` groups its pieces. Their `original_names` are those of their nodes.

    Args:
        path: File or folder.
        config: Limits and tolerances; those of the default configuration if absent.
        up: ``auto`` (y for glTF as its standard says, what a COLLADA file states, z for all else), or the axis that
            points up: ``x``, ``y``, ``z``, ``-x``, ``-y`` or ``-z`` (upside down). The input is turned to z up.
        scale: Metres per unit of the input; None takes the unit that a file states, else metres, or
            millimetres where the object is longer than `config.largest`.
        labels: Labels per triangle of a single mesh.
        pieces: ``auto`` as described; ``group`` splits a file of several nodes or groups into pieces as well, where
            those are not the rigid parts; ``keep`` takes every node, group or connected piece for a rigid part.
        number: Of the object, from left to right, where a mesh that is not segmented shows several.

    Raises:
        AssemblyError: The input cannot become an assembly; the message names the file and the remedy.
        DescriptionError: A URDF cannot be read.
        EnvironmentFault: A STEP file needs a package that is not installed.
    """
    path = Path(path)
    config = config or load_config().assembly
    _check_arguments(up, scale)
    if pieces not in PIECES_CHOICES:
        raise InputError(f"The word {pieces!r} for pieces is unknown. Choose one of {', '.join(PIECES_CHOICES)}.")
    reading = _Reading(
        up=up, scale=scale, labels=None if labels is None else Path(labels), pieces=pieces, config=config
    )
    given = _given(path, reading)
    scaled, lengths = in_metres(given.meshes, scale, config)
    given = replace(given, meshes=tuple(scaled))
    if labels is None and (not given.segmented or pieces in ("group", "cut")):
        given = _in_pieces(given, reading, path)
    meshes, far = _near_origin(sorted(given.meshes, key=lambda mesh: natural_key(mesh.name)))
    notes = dict.fromkeys(note for mesh in meshes for note in mesh.notes)
    unread = [f"Not read of the file: {'; '.join([*notes][:8])}."] if notes else []
    assembly = assemble(meshes, source=str(path), config=config, warnings=(*given.warnings, *unread, *far))
    doubts = size_warnings(assembly, scale, config)
    if given.up_by_standard:
        doubts += _up_warnings(assembly)
    asked = {"--up": up, "--scale": scale, "--labels": labels, "--pieces": pieces, "--object": number}
    options = tuple(str(word) for item in asked.items() if item[1] not in ("auto", None) for word in item)
    loaded = replace(
        assembly, lengths=lengths, options=options, segmented=given.segmented, warnings=(*assembly.warnings, *doubts)
    )
    return loaded if given.segmented and number is None else one_object(loaded, number)


def _check_arguments(up: str, scale: float | None) -> None:
    if up not in UP_CHOICES:
        raise InputError(f"The up axis {up!r} is unknown. Choose one of {', '.join(UP_CHOICES)}.")
    if scale is not None and not (math.isfinite(scale) and scale > 0.0):
        raise InputError(f"The scale {scale} is not usable. Give metres per unit, above zero: 0.001 for millimetres.")


def _given(path: Path, reading: _Reading) -> _Given:
    if path.is_dir():
        _refuse_labels(path, reading)
        return _folder(path, reading)
    if not path.is_file():
        raise AssemblyError(f"There is no file or folder {path}. Check the path.")
    suffix = path.suffix.lower()
    if suffix == ".zip":
        return _archive(path, reading)
    if suffix in SUFFIXES or (suffix == ".xml" and form_of(path) != "urdf"):
        _refuse_labels(path, reading)
        return _description(path, reading)
    if suffix in PART_SUFFIXES:
        return _single_file(path, reading)
    raise AssemblyError(
        f"The file {path} is not an input that can be read. Give a folder or ZIP of mesh files, a description "
        f"({', '.join(SUFFIXES)}), or one of "
        f"{', '.join(PART_SUFFIXES)}."
    )


def _refuse_labels(path: Path, reading: _Reading) -> None:
    if reading.labels is not None:
        raise AssemblyError(f"Labels belong to one mesh, but {path} holds several parts already. Leave --labels out.")


def _folder(folder: Path, reading: _Reading) -> _Given:
    """One part per mesh file; other files are named in a warning."""
    try:
        entries = sorted(folder.iterdir(), key=lambda entry: natural_key(entry.name))
    except OSError as error:
        raise AssemblyError(f"The folder {folder} cannot be read ({error.strerror}). Check its permissions.") from error
    visible = [entry for entry in entries if not entry.name.startswith(".")]
    files = [entry for entry in visible if entry.is_file() and entry.suffix.lower() in PART_SUFFIXES]
    if not files:
        raise AssemblyError(
            f"The folder {folder} holds no mesh file. Put one file per rigid part in it ({', '.join(PART_SUFFIXES)})"
            f"{_instead(visible)}."
        )
    if len(files) > reading.config.max_parts:
        raise AssemblyError(
            f"The folder {folder} holds {len(files)} mesh files; at most {reading.config.max_parts} parts are accepted "
            "(assembly.max_parts). Join what is rigid."
        )
    ignored = [
        entry.name
        for entry in visible
        if entry not in files and (entry.is_dir() or entry.suffix.lower() not in _SILENT_SUFFIXES)
    ]
    warnings = (f"Not read, because they are no mesh files: {', '.join(ignored[:20])}.",) if ignored else ()
    meshes = tuple(_whole_file(file, reading) for file in files)
    return _Given(meshes=meshes, warnings=warnings, up_by_standard=_up_by_standard(files, reading))


def _instead(entries: list[Path]) -> str:
    """Return what the user may have meant."""
    urdf = next((entry for entry in entries if entry.suffix.lower() == ".urdf"), None)
    return f", or give the description {urdf} itself" if urdf else ""


def _whole_file(path: Path, reading: _Reading) -> RawMesh:
    """All that a file holds as one part; an empty mesh stays, to be set aside by name."""
    meshes = _read(path, reading, empty_ok=True)
    if not meshes:
        return RawMesh(name=path.stem, vertices=np.empty((0, 3)), faces=np.empty((0, 3), dtype=np.int64))
    return merged(meshes, path.stem)


def _archive(path: Path, reading: _Reading) -> _Given:
    with tempfile.TemporaryDirectory(prefix="kinematify-") as folder:
        unpack(path, Path(folder), reading.config.max_archive_bytes)
        try:
            return _unpacked(path, Path(folder), reading)
        except InputError as error:
            # The user knows the archive, not the folder that it was unpacked to.
            message = str(error).replace(f"{folder}/", "").replace(folder, path.name)
            raise type(error)(f"In the archive {path}: {message}") from error


def _unpacked(archive: Path, folder: Path, reading: _Reading) -> _Given:
    files = [file for file in folder.rglob("*") if file.is_file()]
    urdfs = [file for file in files if file.suffix.lower() == ".urdf"]
    meshes = [file for file in files if file.suffix.lower() in PART_SUFFIXES]
    if len(urdfs) == 1:
        return _given(urdfs[0], reading)
    if len(meshes) == 1:
        return _given(meshes[0], reading)
    places = sorted({file.parent for file in meshes})
    if len(places) != 1:
        raise AssemblyError(
            f"The archive {archive} holds mesh files in {len(places)} folders and {len(urdfs)} URDF files. Pack one "
            "folder of mesh files, one mesh file, or one URDF with its meshes."
        )
    return _given(places[0], reading)


def _description(path: Path, reading: _Reading) -> _Given:
    """Rigid groups of links at rest; everything else that the description says is dropped."""
    robot = read_robot(path, geometry="parts", appearance=True)
    poses = forward_kinematics(robot, rest_configuration(robot))
    groups = [group for group in rigid_groups(robot) if group.has_geometry]
    meshes = tuple(
        _upright(replace(baked(robot, group, poses), unit=METRE), "z" if reading.up == "auto" else reading.up)
        for group in groups
    )
    return _Given(meshes=meshes, warnings=robot.notes)


def _single_file(path: Path, reading: _Reading) -> _Given:
    meshes = [replace(mesh, name=mesh.name or path.stem) for mesh in _read(path, reading, empty_ok=False)]
    if reading.labels is not None:
        return _Given(meshes=labelled_parts(merged(meshes, path.stem), reading.labels))
    standard = _up_by_standard([path], reading)
    if len(meshes) < 2 or reading.pieces == "keep":
        return _Given(meshes=meshes, segmented=len(meshes) > 1, up_by_standard=standard)
    for mesh in meshes:
        check_finite(mesh, str(path))
    meshes, joined = parts_of_holders(meshes)
    warnings = [f"Nodes without names of their own are one part each: {'; '.join(joined[:8])}."] if joined else []
    why = why_pieces(meshes, reading.config.weld) if len(meshes) > 1 and reading.pieces == "auto" else ""
    if why and len(connected_sheets(merged(meshes, path.stem), reading.config.weld)) > 1:
        warnings.append(
            f"The {len(meshes)} nodes or groups of the file {why}: they are read as one mesh, in pieces to be grouped. "
            "If each of them is a part, give --pieces keep."
        )
        meshes = [merged(meshes, path.stem)]
    elif reading.pieces == "auto":
        warnings += hint_of_many(meshes)
    return _Given(meshes=meshes, segmented=len(meshes) > 1, up_by_standard=standard, warnings=tuple(warnings))


def _in_pieces(given: _Given, reading: _Reading, path: Path) -> _Given:
    """Connected pieces in place of meshes; those of several meshes have the name of theirs."""
    sheets: list[RawMesh] = []
    for mesh, name in zip(given.meshes, part_names([mesh.name for mesh in given.meshes]), strict=True):
        check_finite(mesh, str(path))
        found = connected_sheets(mesh, reading.config.weld, cut=reading.pieces == "cut") or (mesh,)
        sheets += [replace(sheet, name=name) for sheet in found] if len(given.meshes) > 1 else found
    if len(sheets) == 1 and reading.pieces != "cut":
        _report_folds(path, connected_sheets(sheets[0], reading.config.weld, cut=True))
    return replace(given, meshes=tuple(sheets), segmented=reading.pieces == "keep")


def _report_folds(path: Path, cut: Sequence[RawMesh]) -> None:
    """Refuse one surface that folds inwards around what may be parts: it is not cut without being asked.

    Raises:
        AssemblyError: There are several, with the size, faces and place of each but the widest.
    """
    wide = sorted(cut, key=lambda sheet: -float(np.linalg.norm(np.ptp(sheet.vertices, axis=0))))
    said = [
        f"{' x '.join(f'{side:.3g}' for side in np.ptp(sheet.vertices, axis=0))} m ({len(sheet.faces)} faces around "
        f"{', '.join(f'{x:.3g}' for x in sheet.vertices.mean(axis=0))})"
        for sheet in wide[1:]
    ]
    if said:
        raise AssemblyError(
            f"{path} is one surface. It could be cut where it folds inwards, around {'; '.join(said[:5])}"
            f"{f' and {len(said) - 5} more' if len(said) > 5 else ''}. Give --pieces cut to cut it there and group the "
            "pieces, or --labels."
        )


def _read(path: Path, reading: _Reading, *, empty_ok: bool) -> tuple[RawMesh, ...]:
    """Meshes of a file, z up."""
    size, allowed = path.stat().st_size, reading.config.max_archive_bytes
    if size > allowed:
        raise AssemblyError(
            f"The file {path} has {size} bytes; at most {allowed} are read (assembly.max_archive_bytes). Simplify it."
        )
    if path.suffix.lower() == ".3mf":
        check_packed_mesh(path, allowed)
    usual = "" if path.suffix.lower() in UNITLESS else METRE
    found = read_meshes(path, empty_ok=empty_ok, appearance=True)
    meshes = tuple(replace(mesh, unit=mesh.unit or usual) for mesh in found)
    if reading.up != "auto":
        return tuple(_upright(mesh, reading.up) for mesh in meshes)
    usual = "y" if path.suffix.lower() in GLTF_SUFFIXES else "z"
    return tuple(_upright(mesh, mesh.up or usual) for mesh in meshes)


def _upright(mesh: RawMesh, up: str) -> RawMesh:
    """Turn the axis that points up to z; from y a quarter turn about x, so that the front stays in front."""
    return mesh if up == "z" else mesh.moved(to_z_up(up))


def _near_origin(meshes: Sequence[RawMesh]) -> tuple[Sequence[RawMesh], list[str]]:
    """Move what lies so far away that engines, which count in float32, cannot tell its points apart; say so."""
    points = np.concatenate([referenced(mesh.vertices, mesh.faces) for mesh in meshes])
    if not len(points) or not np.isfinite(points).all():
        return meshes, []
    low, high = points.min(axis=0), points.max(axis=0)
    if np.abs([low, high]).max() <= _FAR * np.linalg.norm(high - low):
        return meshes, []
    centre = np.round(0.5 * (low + high), 3)
    centre[2] = low[2] if high[2] > low[2] else centre[2]
    away = length_text(float(np.linalg.norm(centre)))
    said = (
        f"The object lies {away} from the origin, where engines round its shape off. The model is stored about its "
        f"own centre: add ({', '.join(f'{value:.10g}' for value in centre)}) m for the coordinates of the file."
    )
    return [mesh.moved(np.eye(3), -centre) for mesh in meshes], [said]


_FAR = 1000.0
"""Sizes of the object; float32 has seven digits, and contacts need three of them."""


def _up_by_standard(files: Sequence[Path], reading: _Reading) -> bool:
    return reading.up == "auto" and any(file.suffix.lower() in GLTF_SUFFIXES for file in files)


def _up_warnings(assembly: Assembly) -> tuple[str, ...]:
    """Tell of an object that was turned from y up to z up, and that looks as if z had been up before."""
    points = np.concatenate([referenced(part.vertices, part.faces) for part in assembly.parts])
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.linalg.norm(high - low))
    # The file's z is -y now, and its y is z.
    if abs(high[1]) < _ON_GROUND * size and low[2] < -_BELOW_GROUND * size:
        looks = "its lowest point is at z = 0 and it reaches below y = 0"
    elif _foot(points, 1, high[1]) > _STANDS and _foot(points, 2, low[2]) < _LIES:
        looks = "it has a broad foot at its lowest z, and next to none at its lowest y"
    else:
        return ()
    return (f"The file was read with y up, as glTF has it, but {looks}. If it lies on its back, give --up z.",)


def _foot(points: FloatArray, axis: int, end: float) -> float:
    """Share of the object's extent across an axis that what lies at one end of it spans."""
    extent = np.ptp(points, axis=0)
    across = [other for other in range(3) if other != axis]
    at_end = points[np.abs(points[:, axis] - end) < _ON_GROUND * float(np.linalg.norm(extent))]
    return float(np.prod(np.ptp(at_end[:, across], axis=0) / np.maximum(extent[across], 1e-300)))


def unpack(archive: Path, folder: Path, max_bytes: int) -> None:
    """Unpack a ZIP into an existing folder, keeping its subfolders.

    Args:
        archive: The ZIP.
        folder: Where to.
        max_bytes: Cap on the unpacked size, as declared and as found.

    Raises:
        AssemblyError: It is no ZIP, is damaged or encrypted, names a file outside itself, holds a link, or is too big.
    """
    try:
        with zipfile.ZipFile(archive) as opened:
            entries = [entry for entry in opened.infolist() if not entry.is_dir()]
            for entry in entries:
                entry.filename = entry.filename.replace("\\", "/")  # as some programs for Windows write it
                _check_entry(archive, entry)
            _check_size(archive, sum(entry.file_size for entry in entries), max_bytes)
            # zipfile reads no more of an entry than it declares.
            opened.extractall(folder, [entry for entry in entries if _is_wanted(entry.filename)])
    # zipfile raises NotImplementedError where it does not know the compression, RuntimeError where one is encrypted.
    except (zipfile.BadZipFile, zipfile.LargeZipFile, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        raise AssemblyError(
            f"The archive {archive} cannot be unpacked ({error}). It may be damaged: pack the mesh files again."
        ) from error


def check_packed_mesh(path: Path, max_bytes: int) -> None:
    """Refuse a 3MF, which is a ZIP inside, that would unpack to more than `max_bytes`.

    Raises:
        AssemblyError: It is too big. A damaged file passes: reading it gives the better message.
    """
    try:
        with zipfile.ZipFile(path) as opened:
            declared = sum(entry.file_size for entry in opened.infolist())
    except (zipfile.BadZipFile, OSError):
        return
    _check_size(path, declared, max_bytes)


def _check_entry(archive: Path, entry: zipfile.ZipInfo) -> None:
    name = entry.filename
    outside = name.startswith("/") or ".." in name.split("/") or ":" in name.split("/")[0]
    if outside or stat.S_ISLNK(entry.external_attr >> 16):
        raise AssemblyError(
            f"The archive {archive} holds {entry.filename!r}, which leads outside of the archive. Pack plain files "
            "with relative paths only; do not trust this archive."
        )
    if entry.flag_bits & 1:
        raise AssemblyError(f"The archive {archive} is encrypted. Unpack it yourself and give the folder.")


def _check_size(archive: Path, found: int, allowed: int) -> None:
    if found > allowed:
        raise AssemblyError(
            f"The archive {archive} unpacks to more than {allowed} bytes (assembly.max_archive_bytes). Simplify the "
            "meshes, or raise the limit in the configuration if you trust the archive."
        )


def _is_wanted(name: str) -> bool:
    # Dot files and __MACOSX hold attributes of the machine that packed the archive.
    return not any(word.startswith((".", "__MACOSX")) for word in PurePosixPath(name).parts)
