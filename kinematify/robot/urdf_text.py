"""The text of a URDF as an XML tree: no entity is expanded, no DTD is loaded, no oversized file is opened.

`read_text` survives what is not well-formed and says where; `parse_description` raises instead. What is no URDF at all
is refused by both with what to do instead.
"""

from __future__ import annotations

import difflib
import os
import re
import stat
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

from lxml import etree

from kinematify.errors import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from lxml.etree import _Element

MAX_URDF_BYTES = 50_000_000
"""Larger files hold no robot: the largest known ones stay below 1 MB."""

_DECLARATION = re.compile(rb"<\?xml\s[^>]*\?>")
_VERSION = re.compile(rb"""(\sversion\s*=\s*)(["'])[^"']*\2""")
_BEGINNINGS = {
    b"glTF": "a GLB mesh",
    b"PK\x03\x04": "a ZIP archive (perhaps a 3MF mesh or a USDZ scene)",
    b"\x1f\x8b": "a file packed with gzip",
    b"\x7fELF": "a program",
    b"\x89PNG": "a picture",
    b"%PDF": "a PDF document",
    b"solid ": "an STL mesh",
    b"ply\n": "a PLY mesh",
    b"OFF": "an OFF mesh",
}
_ROOTS = {
    "COLLADA": ("a COLLADA mesh", "Give the URDF that uses the mesh."),
    "package": ("the manifest of a ROS package", "Give a .urdf file of the package."),
    "launch": ("a ROS launch file", "Give the URDF that it loads."),
    "html": ("a web page", "Download the raw file instead of the page that shows it."),
}
_DECLARED = re.compile(rb"\bxmlns:([A-Za-z_][\w.-]*)\s*=")
_PREFIX = re.compile(rb"(?:</?|\s)([A-Za-z_][\w.-]*):[A-Za-z_]")
_DEFINITIONS = ("property", "macro", "arg")
"""Elements of xacro that do nothing unless something calls them: expanded files often keep some."""
_EXPRESSION = re.compile(r"\$\{|\$\((?:arg|optenv|env|eval)\b")
"""Of xacro; a mere ``$(find NAME)`` is a path that can be missing without harm."""
_WORDS = re.compile(rb"<(robot|link|joint)[\s>/]")


@dataclass(frozen=True, kw_only=True)
class UrdfText:
    """The text of a document and, if it is well-formed, its tree."""

    text: bytes
    robot: _Element | None
    """The root element; None where the text is not well-formed."""
    syntax_errors: tuple[tuple[int, str], ...] = ()
    """Line and what the parser says."""


def read_text(path: Path, roots: Sequence[str] = ("robot",)) -> UrdfText:
    """Read and parse a document.

    Args:
        path: What the user gave.
        roots: Names that its root may have.

    Raises:
        DescriptionError: It is missing, cannot be opened, or is something else than a URDF; says what to do.
    """
    text = _bytes(path)
    try:
        robot = parse_text(text)
    except etree.XMLSyntaxError:
        _refuse_foreign_text(path, text)
        return UrdfText(text=text, robot=None, syntax_errors=tuple(syntax_errors(text)))
    if robot.tag not in roots or robot.tag == "robot":
        _refuse_foreign_tree(path, robot)
    _name_meshes_of_mujoco(robot, path.parent)
    return UrdfText(text=text, robot=robot)


def _name_meshes_of_mujoco(robot: _Element, folder: Path) -> None:
    """Write the paths of meshes that lie only where the document tells MuJoCo to look, which drops folders of names."""
    for compiler in robot.iterfind("mujoco/compiler[@meshdir]"):
        for mesh in robot.iter("mesh"):
            name = mesh.get("filename", "")
            found = f"{compiler.get('meshdir')}/{name.rsplit('/', 1)[-1]}"
            if not (folder / name).is_file() and (folder / found).is_file():
                mesh.set("filename", found)


def parse_description(path: Path, roots: Sequence[str] = ("robot",)) -> _Element:
    """Return the root element; entities, DOCTYPE and oversized files are refused before anything is expanded.

    Args:
        path: The file.
        roots: Names that the root may have.

    Raises:
        DescriptionError: The file cannot be read, is not well-formed, or is of another format.
    """
    source = read_text(path, roots)
    if source.robot is None:
        line, message = source.syntax_errors[0]
        raise DescriptionError(
            f"The description {path} is not well-formed XML: {message} (line {line}). Correct it there."
        )
    if has_doctype(source.robot):
        raise DescriptionError(
            f"The description {path} declares a DOCTYPE, which no URDF needs and which can hide attacks. Remove it."
        )
    return source.robot


def parse_text(text: bytes) -> _Element:
    """Return the root element of a document, comments and processing instructions omitted.

    Raises:
        lxml.etree.XMLSyntaxError: It is not well-formed, or deeper or larger than the limits of the parser.
    """
    root = etree.fromstring(with_prefixes(text), _parser())
    space = etree.QName(root).namespace
    if space and etree.QName(root).localname == "robot":  # Drake's files state one, which every reader ignores
        for element in root.iter(f"{{{space}}}*"):
            element.tag = etree.QName(element).localname
    return root


def syntax_errors(text: bytes) -> list[tuple[int, str]]:
    """Return line and message of everything that keeps `parse_text` from reading a text."""
    parser = _parser()
    try:
        etree.fromstring(with_prefixes(text), parser)
    except etree.XMLSyntaxError as error:
        # The log of the exception holds the errors of earlier documents too; that of the parser does not.
        log = cast("Iterable[Any]", parser.error_log)
        return [(entry.line, entry.message.strip()) for entry in log] or [(error.lineno or 1, str(error))]
    return []


def _parser() -> etree.XMLParser:
    return etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )


def with_prefixes(text: bytes) -> bytes:
    """Return what every parser of XML takes: a declaration that is one, and every prefix declared.

    Vendors write drake:NAME without, and readers of robots never ask.
    """
    text = with_plain_declaration(text)
    names = b"".join(b' xmlns:%s="urn:%s"' % (prefix, prefix) for prefix in undeclared_prefixes(text))
    return re.sub(rb"<robot\b", lambda found: found.group() + names, text, count=1) if names else text


def undeclared_prefixes(text: bytes) -> list[bytes]:
    """Return the prefixes of elements and attributes that a text does not declare."""
    return sorted({*_PREFIX.findall(text)} - {*_DECLARED.findall(text)} - {b"xml", b"xmlns"})


def has_doctype(root: _Element) -> bool:
    """True if the document of `root` declares a DOCTYPE."""
    return etree.ElementTree(root).docinfo.internalDTD is not None


def with_plain_declaration(text: bytes) -> bytes:
    """Return the text with an XML declaration that parsers take.

    Files with ``<?xml version="0.0" ?>``, with a comment before the declaration, or with a zero byte at their end are
    common, because the readers of ROS, MuJoCo and PyBullet never look at it. Lines keep their numbers.
    """
    if b"\x00" not in (whole := text.rstrip(b"\x00")):
        text = whole
    declaration = _DECLARATION.search(text[:4096])
    if declaration is None:
        return text
    if text[: declaration.start()].strip(b"\xef\xbb\xbf") == b"":
        mended = _VERSION.sub(rb"\1\g<2>1.0\2", declaration.group())
    else:
        mended = b"\n" * declaration.group().count(b"\n")
    return text[: declaration.start()] + mended + text[declaration.end() :]


def _bytes(path: Path) -> bytes:
    try:
        status = path.stat()
    except FileNotFoundError as error:
        raise DescriptionError(missing_file(path)) from error
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


def missing_file(path: Path) -> str:
    """Say that there is no such file or folder, with the nearest name beside it."""
    if os.path.lexists(path):
        return f"{path} is a symbolic link that leads nowhere or in a circle. Give the file itself."
    try:
        beside = os.listdir(path.parent)  # noqa: PTH208  # names only, and of the first folder only
    except OSError:
        beside = []
    near = difflib.get_close_matches(path.name, beside, n=1)
    hint = f"Did you mean {path.parent / near[0]}?" if near else "Check the path."
    return f"There is no file or folder {path}. {hint}"


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
    if _WORDS.search(text.replace(b"\x00", b"")) is None:
        what = "a binary file" if b"\x00" in text[:1024] else "no XML with links and joints"
        raise DescriptionError(f"The file {path} is {what}, not a URDF. Give a URDF: XML that begins with <robot>.")


def calls_xacro(root: _Element) -> bool:
    """True if the document has to be expanded: it calls a macro, or an expression stands outside of definitions."""
    for element in root.iter(etree.Element):
        names = [etree.QName(item) for item in (element, *element.iterancestors())]
        within = any("xacro" in (name.namespace or "") and name.localname in _DEFINITIONS for name in names)
        if within:
            continue
        values = (str(value) for value in element.attrib.values())
        if "xacro" in (names[0].namespace or "") or any(map(_EXPRESSION.search, values)):
            return True
    return False


def _refuse_foreign_tree(path: Path, root: _Element) -> None:
    name = etree.QName(root).localname
    if name in _ROOTS:
        what, remedy = _ROOTS[name]
        raise DescriptionError(f"The file {path} is {what}, not a URDF. {remedy}")
    if root.tag != "robot":
        raise DescriptionError(f"The file {path} begins with <{root.tag}>, not <robot>, so it is no URDF. Give a URDF.")
    tags = {element.tag for element in root}
    if "link" not in tags and tags & {"group", "disable_collisions", "group_state", "end_effector"}:
        raise DescriptionError(
            f"The file {path} is an SRDF, which adds to a URDF and holds no links itself. Give the URDF that belongs "
            "to it."
        )


def child_of(element: etree._Element, tag: str) -> etree._Element:
    """Return the first child of a tag, which is made if there is none."""
    found = element.find(tag)
    return etree.SubElement(element, tag) if found is None else found
