"""KV101 to KV106: the file as XML, its size, and elements that are unknown or stand in the wrong place."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.robot.urdf_text import has_doctype
from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem, line_of, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_text import UrdfText
    from kinematify.validation.precheck.urdf import Urdf

_CHILDREN = {
    "robot": {"link", "joint", "material", "transmission", "gazebo", "sensor"},
    "link": {"inertial", "visual", "collision"},
    "joint": {
        "origin", "parent", "child", "axis", "limit", "mimic", "dynamics", "calibration", "safety_controller",
    },
    "inertial": {"origin", "mass", "inertia"},
    "visual": {"origin", "geometry", "material"},
    "collision": {"origin", "geometry", "material"},
    "geometry": {"mesh", "box", "cylinder", "sphere", "capsule"},
    "material": {"color", "texture"},
}  # fmt: skip
"""What URDF defines; below `transmission`, `gazebo` and `sensor` anything may stand."""
_EXTENSIONS = {
    "robot": {"mujoco", "ros2_control", "deformable", "drake", "isaac_sim", "collision_filter"},
    "link": {"contact", "self_filter", "audio_source", "gravity", "kinematic", "surface", "self_collision_checking"},
    "joint": {"hardwareInterface", "joint_properties"},
    "collision": {"verbose"},
    "material": {"specular"},
}
"""What readers of robots add; it is read by them and by nobody else."""
_REPEATABLE = {"robot": _CHILDREN["robot"], "link": {"visual", "collision"}}
_HOMES: dict[str, set[str]] = defaultdict(set)
for _parent, _children in _CHILDREN.items():
    for _child in _children:
        _HOMES[_child].add(_parent)
_DOCTYPE = re.compile(rb"<!(DOCTYPE|ENTITY)\b")


def syntax_problems(source: UrdfText) -> Iterator[Problem]:
    """KV101."""
    for line, message in source.syntax_errors:
        yield Problem(
            message=f"The text is not well-formed XML: {message}.",
            remedy=f"Correct line {line}; a file that ends too early was cut off while it was written or copied.",
            line=line,
        )


def doctype_problems(source: UrdfText) -> Iterator[Problem]:
    """KV102."""
    declared = _DOCTYPE.search(source.text) if source.robot is None else has_doctype(source.robot)
    if declared:
        found = _DOCTYPE.search(source.text)
        yield Problem(
            message="The file declares a DOCTYPE or entities, which no URDF needs and which can fill the memory.",
            remedy="Delete the declaration and write the values of its entities where they are used.",
            line=1 if found is None else source.text.count(b"\n", 0, found.start()) + 1,
        )


def cap_problems(urdf: Urdf) -> Iterator[Problem]:
    """KV103."""
    settings = urdf.settings
    depths = urdf.depths(urdf.roots)
    elements = sum(1 for _ in urdf.robot.iter(etree.Element))
    for what, count, most in (
        ("XML elements", elements, settings.max_elements),
        ("links", len(urdf.links), settings.max_links),
        ("joints", len(urdf.joints), settings.max_links),
        ("joints one below the other", max(depths.values(), default=0), settings.max_depth),
    ):
        if count > most:
            yield Problem(
                message=f"The file has {count} {what}; at most {most} are handed to engines, some of which hang or "
                "crash with more.",
                remedy="Split the model, or merge links that fixed joints hold together.",
                value=count,
                limit=most,
            )


def long_text(urdf: Urdf) -> Iterator[Problem]:
    """KV104."""
    settings = urdf.settings
    lengths = [len(line) for line in urdf.text.split(b"\n")]
    longest = max(lengths)
    if longest > settings.max_line_bytes:
        yield Problem(
            message=f"The longest of the lines has {longest} bytes; PyBullet fails to parse lines of about 8 KB.",
            remedy="Write one tag per line (`xmllint --format`). Engines are given a copy with short lines here.",
            value=longest,
            limit=settings.max_line_bytes,
            unit="bytes",
            line=lengths.index(longest) + 1,
        )
    for element in (urdf.robot, *urdf.links, *(joint.element for joint in urdf.joints)):
        name = element.get("name") or ""
        if len(name) > settings.max_name:
            yield Problem(
                message=f"The name of a <{element.tag}> has {len(name)} characters; PyBullet crashes with very long "
                "names.",
                remedy=f"Use at most {settings.max_name} characters.",
                value=len(name),
                limit=settings.max_name,
                line=line_of(element),
            )


def displaced_elements(urdf: Urdf) -> Iterator[Problem]:
    """KV105: more than once where it may stand once, or known but in the wrong place."""
    for parent in _structure(urdf.robot):
        counts = Counter(child.tag for child in parent if isinstance(child.tag, str))
        for tag, count in counts.items():
            single = tag in _CHILDREN[parent.tag] - _REPEATABLE.get(parent.tag, set())
            if single and count > 1 and parent.tag != "geometry":  # geometries have a check of their own
                yield _repeated(parent, tag, count)
        for child in parent:
            if _is_displaced(child, parent):
                yield _displaced(child, parent)


def _repeated(parent: _Element, tag: str, count: int) -> Problem:
    second = parent.findall(tag)[1]
    return Problem(
        message=f"{_called(parent)} has {count} <{tag}> elements; readers differ in which of them they take.",
        remedy=f"Keep one <{tag}>.",
        value=count,
        limit=1,
        line=line_of(second),
        link=_owner(parent, "link"),
        joint=_owner(parent, "joint"),
    )


def _displaced(child: _Element, parent: _Element) -> Problem:
    homes = " or ".join(f"<{home}>" for home in sorted(_HOMES[child.tag]))
    return Problem(
        message=f"A <{child.tag}> {shown(child.get('name'))} stands inside {_called(parent)}, where no reader looks.",
        remedy=f"Move it into {homes}, or delete it.",
        line=line_of(child),
        link=_owner(parent, "link"),
        joint=_owner(parent, "joint"),
    )


def unknown_elements(urdf: Urdf) -> Iterator[Problem]:
    """KV106, one note per kind of element."""
    found: dict[tuple[str, str], list[_Element]] = defaultdict(list)
    for parent in _structure(urdf.robot):
        for child in parent:
            if _is_unknown(child, parent) and not _is_displaced(child, parent):
                found[str(parent.tag), str(child.tag)].append(child)
    for (parent_tag, tag), elements in found.items():
        close = next((known for known in _CHILDREN[parent_tag] if known.lower() == tag.lower()), None)
        yield Problem(
            message=f"URDF has no <{tag}> inside <{parent_tag}>; what it says is ignored (found: {len(elements)}).",
            remedy=f"Write <{close}>: tags are case-sensitive." if close else "Delete it if nothing reads it.",
            severity=Severity.WARNING if close else None,
            value=len(elements),
            line=line_of(elements[0]),
        )


PROBES = {"KV104": long_text, "KV105": displaced_elements, "KV106": unknown_elements}


def _structure(robot: _Element) -> Iterator[_Element]:
    """Elements whose children URDF defines, from the robot downward; extensions are not entered."""
    waiting = [robot]
    while waiting:
        element = waiting.pop()
        yield element
        waiting.extend(
            child for child in reversed(element) if child.tag in _CHILDREN and element.tag in _HOMES[child.tag]
        )


def _is_unknown(child: _Element, parent: _Element) -> bool:
    if not isinstance(child.tag, str) or child.tag.startswith("{"):
        return False  # an entity, or an extension with a namespace of its own
    return child.tag not in _CHILDREN[parent.tag] | _EXTENSIONS.get(parent.tag, set()) and ":" not in child.tag


def _is_displaced(child: _Element, parent: _Element) -> bool:
    """True for what URDF has elsewhere; shapes in odd places are told by the checks of shapes."""
    return _is_unknown(child, parent) and child.tag in _HOMES and parent.tag != "geometry"


def _called(element: _Element) -> str:
    owner = next((f"the {tag} {name}" for tag in ("link", "joint") if (name := _owner(element, tag))), "the robot")
    return owner if element.tag in ("robot", "link", "joint") else f"a <{element.tag}> of {owner}"


def _owner(element: _Element, tag: str) -> str | None:
    """Name of the link or joint that an element is or belongs to."""
    return next((item.get("name") for item in (element, *element.iterancestors()) if item.tag == tag), None)
