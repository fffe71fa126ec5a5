"""From a path to the XML tree of a URDF; what is no URDF at all is refused with what to do instead."""

from __future__ import annotations

import difflib
import os
import re
import stat
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.urdf_document import MAX_URDF_BYTES, parse_text, syntax_errors

if TYPE_CHECKING:
    from pathlib import Path

    from lxml.etree import _Element

_BEGINNINGS = {
    b"glTF": "a GLB mesh",
    b"PK\x03\x04": "a ZIP archive (perhaps a 3MF mesh or a USDZ scene)",
    b"\x1f\x8b": "a file packed with gzip",
    b"PXR-USDC": "a binary USD scene",
    b"#usda": "a USD scene",
    b"\x7fELF": "a program",
    b"\x89PNG": "a picture",
    b"%PDF": "a PDF document",
    b"solid ": "an STL mesh",
    b"ply\n": "a PLY mesh",
    b"OFF": "an OFF mesh",
}
_ROOTS = {
    "mujoco": ("MJCF, the format of MuJoCo", "Convert it, for example with mjcf2urdf, and give the URDF."),
    "sdf": ("SDF, the format of Gazebo", "Convert it, for example with `sdf2urdf`, and give the URDF."),
    "gazebo": ("an old SDF file", "Convert it, for example with `sdf2urdf`, and give the URDF."),
    "COLLADA": ("a COLLADA mesh", "Give the URDF that uses the mesh."),
    "package": ("the manifest of a ROS package", "Give a .urdf file of the package."),
    "launch": ("a ROS launch file", "Give the URDF that it loads."),
    "html": ("a web page", "Download the raw file instead of the page that shows it."),
}
_XACRO = "Expand it first: `xacro {path} > robot.urdf` (pip install xacro, or ROS), and give robot.urdf."
_WORDS = re.compile(rb"<(robot|link|joint)[\s>/]")


@dataclass(frozen=True, kw_only=True)
class UrdfText:
    """The text of a document and, if it is well-formed, its tree."""

    text: bytes
    robot: _Element | None
    """The root element; None where the text is not well-formed."""
    syntax_errors: tuple[tuple[int, str], ...] = ()
    """Line and what the parser says."""


def read_text(path: Path) -> UrdfText:
    """Read and parse a document.

    Args:
        path: What the user gave.

    Raises:
        DescriptionError: It is missing, cannot be opened, or is something else than a URDF; says what to do.
    """
    text = _bytes(path)
    try:
        robot = parse_text(text)
    except etree.XMLSyntaxError:
        _refuse_foreign_text(path, text)
        return UrdfText(text=text, robot=None, syntax_errors=tuple(syntax_errors(text)))
    _refuse_foreign_tree(path, robot)
    return UrdfText(text=text, robot=robot)


def _bytes(path: Path) -> bytes:
    try:
        status = path.stat()
    except FileNotFoundError as error:
        raise DescriptionError(_missing(path)) from error
    except OSError as error:  # among them: a link in a circle, a folder that may not be entered
        raise DescriptionError(f"The description {path} cannot be read: {error.strerror}. Check the path.") from error
    if stat.S_ISDIR(status.st_mode):
        raise DescriptionError(_folder(path))
    if not stat.S_ISREG(status.st_mode):
        raise DescriptionError(f"{path} is neither a file nor a folder. Give a URDF file.")
    if status.st_size > MAX_URDF_BYTES:
        raise DescriptionError(
            f"The description {path} has {status.st_size} bytes; a URDF has at most {MAX_URDF_BYTES}. Is it a mesh?"
        )
    try:
        return path.read_bytes()
    except OSError as error:
        raise DescriptionError(
            f"The description {path} cannot be read: {error.strerror}. Check who may read it."
        ) from error


def _missing(path: Path) -> str:
    if os.path.lexists(path):
        return f"{path} is a symbolic link to a file that is not there. Give the file itself."
    try:
        beside = os.listdir(path.parent)  # noqa: PTH208  # names only, and of the first folder only
    except OSError:
        beside = []
    near = difflib.get_close_matches(path.name, beside, n=1)
    hint = f"Did you mean {path.parent / near[0]}?" if near else "Check the path."
    return f"There is no file {path}. {hint}"


def _folder(path: Path) -> str:
    models = sorted(path.glob("*.urdf"))
    hint = f"Give a file, such as {models[0]}." if models else "It holds no .urdf file itself. Give a URDF file."
    return f"{path} is a folder. {hint}"


def _refuse_foreign_text(path: Path, text: bytes) -> None:
    """Name what is not XML at all; broken XML that may well be a URDF is let pass."""
    if not text.strip():
        raise DescriptionError(f"The file {path} is empty. Give a URDF file.")
    kind = next((kind for start, kind in _BEGINNINGS.items() if text.startswith(start)), None)
    if kind is not None:
        raise DescriptionError(f"The file {path} is {kind}, not a URDF. Give the URDF that uses it.")
    if b"<xacro:" in text:
        raise DescriptionError(f"The file {path} is a xacro file, not a URDF. {_XACRO.format(path=path)}")
    if _WORDS.search(text.replace(b"\x00", b"")) is None:
        what = "a binary file" if b"\x00" in text[:1024] else "no XML with links and joints"
        raise DescriptionError(f"The file {path} is {what}, not a URDF. Give a URDF: XML that begins with <robot>.")


def _refuse_foreign_tree(path: Path, root: _Element) -> None:
    name = etree.QName(root).localname
    if name in _ROOTS:
        what, remedy = _ROOTS[name]
        raise DescriptionError(f"The file {path} is {what}, not a URDF. {remedy}")
    if root.tag != "robot":
        raise DescriptionError(f"The file {path} begins with <{root.tag}>, not <robot>, so it is no URDF. Give a URDF.")
    if any("xacro" in (etree.QName(element).namespace or "") for element in root.iter(etree.Element)):
        raise DescriptionError(f"The file {path} is a xacro file, not a URDF. {_XACRO.format(path=path)}")
    tags = {element.tag for element in root}
    if "link" not in tags and tags & {"group", "disable_collisions", "group_state", "end_effector"}:
        raise DescriptionError(
            f"The file {path} is an SRDF, which adds to a URDF and holds no links itself. Give the URDF that belongs "
            "to it."
        )
