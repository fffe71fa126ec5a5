"""The text of a URDF as an XML tree: no entity is expanded, no DTD is loaded, no oversized file is opened."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, cast

from lxml import etree

from kinematify.errors import DescriptionError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from lxml.etree import _Element

MAX_URDF_BYTES = 50_000_000
"""Larger files hold no robot: the largest known ones stay below 1 MB."""

_DECLARATION = re.compile(rb"<\?xml\s[^>]*\?>")
_VERSION = re.compile(rb"""(\sversion\s*=\s*)(["'])[^"']*\2""")


def parse_description(path: Path) -> _Element:
    """Return the robot element; entities, DOCTYPE and oversized files are refused before anything is expanded.

    Raises:
        DescriptionError: The file cannot be read, is not well-formed, or is no URDF.
    """
    try:
        size = path.stat().st_size
        text = path.read_bytes() if size <= MAX_URDF_BYTES else b""
    except OSError as error:
        raise DescriptionError(f"The description {path} cannot be read: {error.strerror}. Check the path.") from error
    if size > MAX_URDF_BYTES:
        raise DescriptionError(
            f"The description {path} has {size} bytes; a URDF has at most {MAX_URDF_BYTES}. Is it a mesh?"
        )
    try:
        robot = parse_text(text)
    except etree.XMLSyntaxError as error:
        raise DescriptionError(f"The description {path} is not well-formed XML: {error}. Correct it there.") from error
    if has_doctype(robot):
        raise DescriptionError(
            f"The description {path} declares a DOCTYPE, which no URDF needs and which can hide attacks. Remove it."
        )
    if robot.tag != "robot":
        raise DescriptionError(
            f"The description {path} begins with <{robot.tag}>, not <robot>. Give a URDF; expand xacro files with "
            "`xacro FILE > robot.urdf`, and convert MJCF or SDF first."
        )
    return robot


def parse_text(text: bytes) -> _Element:
    """Return the root element of a document, comments and processing instructions left out.

    Raises:
        lxml.etree.XMLSyntaxError: It is not well-formed, or deeper or larger than the limits of the parser.
    """
    return etree.fromstring(with_plain_declaration(text), _parser())


def syntax_errors(text: bytes) -> list[tuple[int, str]]:
    """Return line and message of everything that keeps `parse_text` from reading a text."""
    parser = _parser()
    try:
        etree.fromstring(with_plain_declaration(text), parser)
    except etree.XMLSyntaxError as error:
        # The log of the exception holds the errors of earlier documents too; that of the parser does not.
        log = cast("Iterable[Any]", parser.error_log)
        return [(entry.line, entry.message.strip()) for entry in log] or [(error.lineno or 1, str(error))]
    return []


def _parser() -> etree.XMLParser:
    return etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False, remove_comments=True, remove_pis=True
    )


def has_doctype(root: _Element) -> bool:
    """True if the document of `root` declares a DOCTYPE."""
    return etree.ElementTree(root).docinfo.internalDTD is not None


def with_plain_declaration(text: bytes) -> bytes:
    """Return the text with an XML declaration that parsers take.

    Files with ``<?xml version="0.0" ?>``, or with a comment before the declaration, are common, because the readers of
    ROS and PyBullet never look at it. Lines keep their numbers.
    """
    declaration = _DECLARATION.search(text[:4096])
    if declaration is None:
        return text
    if text[: declaration.start()].strip(b"\xef\xbb\xbf") == b"":
        mended = _VERSION.sub(rb"\1\g<2>1.0\2", declaration.group())
    else:
        mended = b"\n" * declaration.group().count(b"\n")
    return text[: declaration.start()] + mended + text[declaration.end() :]
