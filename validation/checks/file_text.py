"""KV101 to KV106: the file as XML, its size, and elements that are unknown or stand in the wrong place."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.robot.urdf_numbers import line_of
from kinematify.robot.urdf_text import has_doctype, undeclared_prefixes
from kinematify.validation.check import check
from kinematify.validation.document import finite_numbers, shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.robot.urdf_text import UrdfText
    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

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
    "robot": {"mujoco", "ros2_control", "deformable", "drake", "isaac_sim", "collision_filter", "loop_joint"},
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


@check(
    "KV101",
    title="The file is well-formed XML",
    fails="The file is not well-formed XML",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    guard=True,
)
def syntax_problems(result: OpenCheck, source: UrdfText) -> None:
    """The XML parser reads the whole file.

    Why it matters: No reader loads a file that breaks off or holds a stray sign; some crash instead of saying
    where.

    Remedy: Correct the line that is named; if the file ends too early, export or copy it again.
    """
    for line, message in source.syntax_errors:
        result.find(
            f"The text is not well-formed XML: {message}.",
            f"Correct line {line}; a file that ends too early was cut off while it was written or copied.",
            line=line,
        )


@check(
    "KV102",
    title="No DOCTYPE and no entities",
    fails="The file has a DOCTYPE or entities",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    guard=True,
)
def doctype_problems(result: OpenCheck, source: UrdfText) -> None:
    """The file declares neither a DOCTYPE nor entities.

    Why it matters: A few lines of entities can unfold to gigabytes, and external ones read files of the machine. No
    URDF needs them.

    Remedy: Delete the declaration and write the values where they are used.
    """
    declared = _DOCTYPE.search(source.text) if source.robot is None else has_doctype(source.robot)
    if declared:
        found = _DOCTYPE.search(source.text)
        result.find(
            "The file declares a DOCTYPE or entities, which no URDF needs and which can fill the memory.",
            "Delete the declaration and write the values of its entities where they are used.",
            line=1 if found is None else source.text.count(b"\n", 0, found.start()) + 1,
        )


@check(
    "KV103",
    title="The file stays within the caps",
    fails="The file is larger than the caps",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
    guard=True,
)
def cap_problems(result: OpenCheck, urdf: Urdf) -> None:
    """Elements, links and joints, and how deep links hang one below the other, stay below `max_elements`, `max_links`
    and `max_depth`.

    Why it matters: A chain of 20,000 links hangs MuJoCo and crashes Pinocchio; no known robot has more than about
    150.

    Remedy: Split the model, or merge links that fixed joints hold together.
    """
    settings = urdf.settings
    depths = urdf.depths(urdf.roots)
    elements = sum(1 for _ in urdf.robot.iter(etree.Element))
    counts = (
        ("XML elements", elements, settings.max_elements),
        ("links", len(urdf.links), settings.max_links),
        ("joints", len(urdf.joints), settings.max_links),
        ("joints one below the other", max(depths.values(), default=0), settings.max_depth),
    )
    many = [(what, count, most) for what, count, most in counts if count > most]
    if many:
        listed = " and ".join(f"{count} {what} (at most {most})" for what, count, most in many)
        result.find(
            f"The file has {listed}: some engines hang or crash with more.",
            "Split the model, or merge links that fixed joints hold together.",
            value=many[0][1],
            limit=many[0][2],
        )


@check(
    "KV104",
    title="Lines and names are short enough",
    fails="Lines or names are too long",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
)
def long_text(result: OpenCheck, urdf: Urdf) -> None:
    """No line is longer than `max_line_bytes`, no name longer than `max_name`.

    Why it matters: PyBullet fails on lines of 8 KB and crashes on a robot name of 1,100 characters.

    Remedy: Format the file with one tag per line; shorten the names.
    """
    settings = urdf.settings
    lengths = [len(line) for line in urdf.text.split(b"\n")]
    longest = max(lengths)
    if longest > settings.max_line_bytes:
        result.find(
            f"The longest of the lines has {longest} bytes; PyBullet fails to parse lines of about 8 KB.",
            "Write one tag per line (`xmllint --format`). Engines are given a copy with short lines here.",
            value=longest,
            limit=settings.max_line_bytes,
            unit="bytes",
            line=lengths.index(longest) + 1,
        )
    for element in (urdf.robot, *urdf.links, *(joint.element for joint in urdf.joints)):
        name = element.get("name") or ""
        if len(name) > settings.max_name:
            result.find(
                f"The name of a <{element.tag}> has {len(name)} characters; PyBullet crashes with very long names.",
                f"Use at most {settings.max_name} characters.",
                value=len(name),
                limit=settings.max_name,
                line=line_of(element),
            )


@check(
    "KV105",
    title="Elements stand once and in their place",
    fails="Elements are repeated or misplaced",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
)
def displaced_elements(result: OpenCheck, urdf: Urdf) -> None:
    """Elements that may occur once in their parent occur once, and known elements are where URDF expects them.

    Why it matters: With two <origin> elements one reader takes the first, another the last; a <link> inside a
    <link> is not there for any.

    Remedy: Keep one element, in the place that the finding names.
    """
    for parent in _structure(urdf.robot):
        counts = Counter(child.tag for child in parent if isinstance(child.tag, str))
        for tag, count in counts.items():
            single = tag in _CHILDREN[parent.tag] - _REPEATABLE.get(parent.tag, set())
            if single and count > 1 and parent.tag != "geometry":  # geometries have a check of their own
                _repeated(result, parent, tag, count)
        for child in parent:
            if _is_displaced(child, parent):
                _displaced(result, child, parent)


def _repeated(result: OpenCheck, parent: _Element, tag: str, count: int) -> None:
    second = parent.findall(tag)[1]
    result.find(
        f"{_called(parent)} has {count} <{tag}> elements; readers differ in which of them they take.",
        f"Keep one <{tag}>.",
        value=count,
        limit=1,
        line=line_of(second),
        link=_owner(parent, "link"),
        joint=_owner(parent, "joint"),
    )


def _displaced(result: OpenCheck, child: _Element, parent: _Element) -> None:
    homes = " or ".join(f"<{home}>" for home in sorted(_HOMES[child.tag]))
    name = child.get("name")
    called = f"<{child.tag}>" if name is None else f"<{child.tag}> {shown(name)}"
    result.find(
        f"The {called} is inside {_called(parent)}, where no reader looks.",
        f"Move it into {homes}, or delete it.",
        line=line_of(child),
        link=_owner(parent, "link"),
        joint=_owner(parent, "joint"),
    )


@check("KV106", title="Elements are known", fails="Elements are unknown", severity=Severity.NOTE, cause=Cause.ASSET)
def unknown_elements(result: OpenCheck, urdf: Urdf) -> None:
    """Elements that neither URDF nor the usual extensions define are counted by kind, and definitions of xacro that
    nothing calls; prefixes of vendors (`drake:`) are declared.

    Why it matters: A tag with a typing mistake is ignored in silence, with all that it says.

    Remedy: Correct the tag, or delete it if nothing reads it.
    """
    # one note per kind of element
    found: dict[tuple[str, str], list[_Element]] = defaultdict(list)
    for parent in _structure(urdf.robot):
        for child in parent:
            if _is_unknown(child, parent) and not _is_displaced(child, parent):
                found[str(parent.tag), str(child.tag)].append(child)
    left = [element for element in urdf.robot.iter("{*}property", "{*}macro") if "xacro" in str(element.tag)]
    if left:
        result.find(
            f"Definitions of xacro are left that nothing calls: {len(left)}. They are passed over.",
            "Delete them; readers of robots ignore them.",
            value=len(left),
            line=line_of(left[0]),
        )
    if undeclared := b", ".join(undeclared_prefixes(urdf.text)).decode():
        result.find(
            f"Prefixes are used that the file does not declare: {undeclared}. Readers of robots pass over them, strict "
            "readers of XML refuse the file.",
            'Declare each of them at <robot>, as in xmlns:NAME="urn:NAME".',
        )
    for (parent_tag, tag), elements in found.items():
        close = next((known for known in _CHILDREN[parent_tag] if known.lower() == tag.lower()), None)
        result.find(
            f"URDF has no <{tag}> inside <{parent_tag}>; what it says is ignored (found: {len(elements)}).",
            f"Write <{close}>: tags are case-sensitive." if close else "Delete it if nothing reads it.",
            severity=Severity.WARNING if close else None,
            value=len(elements),
            line=line_of(elements[0]),
        )


@check(
    "KV107",
    title="Rotations are written as every reader knows",
    fails="Rotations are written as few readers know",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
)
def quaternions(result: OpenCheck, urdf: Urdf) -> None:
    """No rotation is written as quat_xyzw of URDF 1.1 and later, unless it is none. All other checks read it.

    Why it matters: MuJoCo, PyBullet, Pinocchio and most importers skip the attribute without a word and do not turn
    the frame.

    Remedy: Write roll, pitch and yaw (rpy); `kinematify fix` does it.
    """
    turned = [
        origin
        for origin in urdf.robot.iter("origin")
        if len(quaternion := finite_numbers(origin.get("quat_xyzw") or "") or []) == 4 and any(quaternion[:3])
    ]
    if turned:
        parent = turned[0].getparent()
        owner = urdf.robot if parent is None else parent
        result.find(
            f"{_called(owner)} has quat_xyzw={shown(turned[0].get('quat_xyzw'))} (in the file: {len(turned)}); MuJoCo, "
            "PyBullet and Pinocchio skip the attribute and do not turn the frame.",
            "Write rpy instead; `kinematify fix` does it.",
            value=len(turned),
            line=line_of(turned[0]),
            link=_owner(owner, "link"),
            joint=_owner(owner, "joint"),
        )


@check(
    "KV108",
    title="The whole description is read",
    fails="Something of the description is not read",
    severity=Severity.NOTE,
    cause=Cause.ASSET,
)
def losses(result: OpenCheck, urdf: Urdf) -> None:
    """An MJCF, SDF or USD holds nothing that a URDF cannot say: each kind of thing that is not read is a note.

    Why it matters: The model that is checked is the file without it.

    Remedy: Nothing, unless the model depends on it; MuJoCo opens an MJCF itself for the checks of the file as loaded.
    """
    for sentence in urdf.losses:
        result.find(sentence, "Check what depends on it in an engine that reads the format.")


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
    """True for what URDF has elsewhere; the checks of shapes report shapes in odd places."""
    return _is_unknown(child, parent) and child.tag in _HOMES and parent.tag != "geometry"


def _called(element: _Element) -> str:
    owner = next((f"the {tag} {name}" for tag in ("link", "joint") if (name := _owner(element, tag))), "the robot")
    return owner if element.tag in ("robot", "link", "joint") else f"a <{element.tag}> of {owner}"


def _owner(element: _Element, tag: str) -> str | None:
    """Name of the link or joint that an element is or belongs to."""
    return next((item.get("name") for item in (element, *element.iterancestors()) if item.tag == tag), None)
