"""Copies of a document in the folder of a run: every mesh by its absolute path, without what cannot be read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from kinematify.errors import DescriptionError
from kinematify.robot.mesh_paths import find_mesh
from kinematify.robot.urdf_numbers import UrdfDocument
from kinematify.robot.urdf_text import child_of, parse_description
from kinematify.validation.document import malformed_fields
from kinematify.validation.finding import Severity
from kinematify.validation.validated_file import DocumentCopy

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from lxml.etree import _Element

    from kinematify.validation.document import NumberField
    from kinematify.validation.finding import Observation
    from kinematify.validation.stage import StageRequest

LEFT_OUT = frozenset(("KV140", "KV141", "KV142", "KV150"))
"""Checks of shapes that reading leaves out, with a note."""
_SHAPES = ("KV138", "KV139", "KV151", "KV152")
"""Checks after whose errors a model is read without the shape that they name."""
_JOINTS = ("KV130", "KV131", "KV134", "KV136", "KV137")
"""The same with a fixed joint in place of the one that they name."""
_NUMBERS = "KV132"
"""The same with spaces for commas, which only some readers take, or without the number, and what needs it."""
_MIMICS = ("KV127", "KV128")
"""The same with a joint that follows no other one, as most engines read it."""
_NO_LIMIT = "KV136"


def readable_copy(request: StageRequest, errors: Iterable[Observation]) -> DocumentCopy | None:
    """Write a copy that can be read in spite of errors of file and meshes; None where one of them forbids it.

    Args:
        request: Names the document, where packages lie, and the folder.
        errors: Findings that keep the document from being read.
    """
    try:
        robot = parse_description(request.urdf)
    except DescriptionError:  # the text is not well-formed, which a finding says
        return None
    lacking, joints = set[str](), set[str]()
    for finding in errors:
        if finding.check == _NO_LIMIT and _turns(robot, finding.joint):
            continue  # it is read as continuous
        if finding.check in _MIMICS and finding.joint is not None:
            for mimic in [mimic for joint in _named(robot, finding.joint) for mimic in joint.findall("mimic")]:
                _blank(mimic)
        elif finding.check == _NUMBERS:
            _drop_commas(robot, finding.line)
        elif finding.check in _JOINTS and finding.joint is not None:
            _fix_joint(robot, finding.joint)
            joints.add(finding.joint)
        elif finding.check in _SHAPES and finding.link is not None:
            if not _drop_shapes(robot, finding):
                return None
            lacking.add(finding.link)
        elif finding.severity is Severity.ERROR:
            return None
    fields = malformed_fields(UrdfDocument(robot=robot))
    for field in [item for item in fields if item.element.tag != "color"]:  # nobody stops at a colour
        if field.joint is not None and field.element.tag == "origin":
            return None  # nobody knows where its link stands
        lacking.add(str(field.joint or field.link))
        joints |= _drop_number(robot, field)
    path = request.work / "readable.urdf"
    _write_resolved(robot, request, path)
    return DocumentCopy(path=path, lacking=frozenset(lacking | joints), joints=frozenset(joints))


def resolved_copy(request: StageRequest, left_out: Iterable[Observation]) -> Path:
    """Write a copy that engines open wherever packages lie: absolute paths, which MuJoCo is set to keep whole.

    Args:
        request: Names the document, where packages lie, and the folder.
        left_out: Findings of `LEFT_OUT`; the copy lacks the shapes that they are about.
    """
    robot = parse_description(request.urdf)
    for finding in left_out:
        if finding.severity is not Severity.NOTE:
            _drop_shapes(robot, finding)
    compiler = child_of(child_of(robot, "mujoco"), "compiler")
    compiler.set("strippath", "false")
    compiler.attrib.pop("meshdir", "")
    path = request.work / "resolved.urdf"
    _write_resolved(robot, request, path)
    return path


def _write_resolved(robot: _Element, request: StageRequest, path: Path) -> None:
    folder = request.urdf.resolve().parent
    for mesh in robot.iter("mesh"):
        try:
            mesh.set("filename", str(find_mesh(mesh.get("filename") or "", folder, request.package_dirs, "mesh")))
        except DescriptionError:
            continue  # the text has been checked: what is missing was reported
    # In place of a declaration and comments, so that all lines keep their numbers.
    path.write_bytes(b"\n" * (int(str(robot.sourceline)) - 1) + etree.tostring(robot, encoding="utf-8"))


def _turns(robot: _Element, name: str | None) -> bool:
    return any(joint.get("type") == "revolute" for joint in _named(robot, name))


def _named(robot: _Element, name: str | None) -> list[_Element]:
    return [joint for joint in robot.findall("joint") if joint.get("name") == name]


def _drop_commas(robot: _Element, line: int | None) -> None:
    """Write spaces for commas in the elements of a line."""
    for element in robot.iter():
        if str(element.sourceline) == str(line):
            for key, text in element.items():
                element.set(key, str(text).replace(",", " "))


def _drop_number(robot: _Element, field: NumberField) -> set[str]:
    """Drop a number, with the rule, mass or shape that it is of; returns the joint that is fixed for want of it."""
    if field.joint is not None and field.attribute in ("xyz", "lower", "upper"):
        _fix_joint(robot, field.joint)
        return {field.joint}
    del field.element.attrib[field.attribute]
    for item in (field.element, *field.element.iterancestors()):
        if item.tag in _WHOLE:
            _blank(item)
    return set()


_WHOLE = ("mimic", "inertial", "visual", "collision")


def _fix_joint(robot: _Element, name: str) -> None:
    for joint in _named(robot, name):
        joint.set("type", "fixed")
        for element in (*joint.findall("axis"), *joint.findall("limit"), *joint.findall("mimic")):
            _blank(element)


def _drop_shapes(robot: _Element, finding: Observation) -> bool:
    """Drop the shape in the line of a finding, and what names the same file in that link; False if none is there."""
    dropped = False
    for link in robot.findall("link"):
        if link.get("name") != finding.link:
            continue
        shapes = [*link.findall("visual"), *link.findall("collision")]
        named = [
            shape for shape in shapes if str(finding.line) in {str(element.sourceline) for element in shape.iter()}
        ]
        named = [shape for shape in named if _is_told(shape, finding.message)] or named  # all may be in one line
        files = {mesh.get("filename") for shape in named for mesh in shape.iter("mesh")}
        for shape in shapes:
            if shape in named or {mesh.get("filename") for mesh in shape.iter("mesh")} & files:
                dropped = True
                _blank(shape)
    return dropped


def _is_told(shape: _Element, message: str) -> bool:
    """True if a message quotes a size or a file of a shape."""
    sizes = (str(text) for item in shape.iterfind("geometry/*") for text in item.values())
    return any(text.rsplit("/", 1)[-1] in message for text in sizes)


def _blank(element: _Element) -> None:
    """Replace an element by a comment of as many lines, so that all others keep theirs."""
    parent = element.getparent()
    if parent is None:
        return
    text = etree.tostring(element, with_tail=False)
    blank = etree.Comment("\n" * text.count(b"\n"))
    blank.tail = element.tail
    parent.replace(element, blank)
