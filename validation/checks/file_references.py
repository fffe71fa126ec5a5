"""KV141 and KV142: the mesh files that the document names, not opened yet."""

from __future__ import annotations

import os
import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from kinematify.errors import DescriptionError
from kinematify.robot.mesh_paths import MESH_SUFFIXES, find_mesh, near_mesh
from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.check import check
from kinematify.validation.document import shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

_BY_ENGINES = (".obj", ".stl")
_DRIVE = re.compile(r"[A-Za-z]:[\\/]")


@dataclass(frozen=True, kw_only=True)
class _Reference:
    """A mesh element."""

    link: str
    filename: str
    line: int
    path: Path | None
    """None where there is no such file."""
    fault: str
    """Why there is none."""
    collides: bool
    """It belongs to a collision element."""


@check("KV141", title="Mesh files exist", fails="A mesh file is missing", severity=Severity.ERROR, cause=Cause.ASSET)
def missing_files(result: OpenCheck, urdf: Urdf) -> None:
    """Every file name leads to a file, through packages where it says so; for what is only seen it is a warning. All
    else is checked without the element.

    Why it matters: The link is invisible and collides with nothing, or the model does not load.

    Remedy: Put the file there, correct the path, or name the package's folder with --package-dir.
    """
    # what a link shows and collides with is often one file
    missing = {(item.link, item.filename): item for item in reversed([*_references(urdf)]) if item.path is None}
    felt = {(item.link, item.filename) for item in _references(urdf) if item.collides}
    for key, reference in reversed(missing.items()):
        near = near_mesh(reference.filename, urdf.folder, urdf.package_dirs)
        result.find(
            reference.fault,
            _remedy(reference.filename)
            if near is None
            else f"There is {os.path.relpath(near, urdf.folder)}; `kinematify fix` writes that path.",
            severity=None if key in felt else Severity.WARNING,
            link=reference.link,
            line=reference.line,
            harmless=True,
        )


def _remedy(filename: str) -> str:
    if "$(" in filename or "${" in filename:
        return "This is an expression of xacro: expand the file with `xacro FILE > robot.urdf`."
    if filename.startswith(("package://", "model://")):
        package = filename.split("/")[2]
        return f"Name the folder of the package {package}, or the one that holds it, with --package-dir."
    if filename.startswith(("http://", "https://")):
        return "Download the mesh and write its path relative to the URDF."
    if _DRIVE.match(filename):
        return "This path is on the drive of a Windows machine: copy the mesh and write its path relative to the URDF."
    if filename.startswith(("/", "file:")):
        return "Absolute paths hold on one machine only: write the path relative to the URDF."
    return "Put the file there, or correct the path; `kinematify fix` leaves the element out."


@check(
    "KV142",
    title="Mesh formats can be read",
    fails="A mesh format cannot be read everywhere",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
)
def unknown_formats(result: OpenCheck, urdf: Urdf) -> None:
    """Every mesh is of a format that is read here, a warning where only a visual is not, which the other checks then do
    without; formats that MuJoCo does not read are a note.

    Why it matters: Each reader knows other formats; what it does not know it drops or refuses.

    Remedy: Convert the mesh to OBJ or binary STL.
    """
    converted: dict[str, list[_Reference]] = defaultdict(list)
    for reference in _references(urdf):
        suffix = PurePosixPath(reference.filename.replace("\\", "/")).suffix.lower()
        if suffix not in MESH_SUFFIXES:
            result.find(
                f"The mesh {shown(reference.filename)} of the link {reference.link} is of no format that can be read.",
                f"Convert it to one of {', '.join(MESH_SUFFIXES)}, for example with Blender.",
                severity=None if reference.collides else Severity.WARNING,
                link=reference.link,
                line=reference.line,
                harmless=True,
            )
        elif suffix not in _BY_ENGINES:
            converted[suffix].append(reference)
    for suffix, references in converted.items():
        result.find(
            f"Meshes in {suffix} files: {len(references)}. MuJoCo reads OBJ and binary STL only; they are "
            "converted for the checks.",
            "Export OBJ or binary STL as well if MuJoCo is to load the file itself.",
            severity=Severity.NOTE,
            value=len(references),
            line=references[0].line,
        )


def _references(urdf: Urdf) -> Iterator[_Reference]:
    """Mesh elements with a file name; those without have a check of their own."""
    for link, element in urdf.shapes():
        for mesh in element.iterfind("geometry/mesh"):
            filename = mesh.get("filename") or ""
            if filename.strip():
                path, fault = _found(filename, link, urdf)
                yield _Reference(
                    link=link,
                    filename=filename,
                    line=line_of(mesh),
                    path=path,
                    fault=fault,
                    collides=element.tag == "collision",
                )


def _found(filename: str, link: str, urdf: Urdf) -> tuple[Path | None, str]:
    try:
        return find_mesh(filename, urdf.folder, urdf.package_dirs, f"link {link}"), ""
    except DescriptionError as error:
        return None, str(error)
