"""KV110 to KV112: names of links and joints."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING

from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.check import check
from kinematify.validation.document import shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

_HARMFUL = re.compile(r"""[\s<>&"'/\\|*?:;,]""")


@check("KV110", title="Names are present", fails="Names are missing", severity=Severity.ERROR, cause=Cause.ASSET)
def missing_names(result: OpenCheck, urdf: Urdf) -> None:
    """Every link and joint has a name; the robot should have one.

    Why it matters: Without a name nothing can refer to it; most readers stop.

    Remedy: Name it.
    """
    for element in _named(urdf):
        if not (element.get("name") or "").strip():
            result.find(
                f"A <{element.tag}> has no name, so that nothing can refer to it.",
                f'Write <{element.tag} name="..."> with a name that no other {element.tag} has.',
                line=line_of(element),
            )
    if not (urdf.robot.get("name") or "").strip():
        result.find(
            "The <robot> has no name; PyBullet and urdfdom want one.",
            'Write <robot name="...">.',
            severity=Severity.WARNING,
            line=line_of(urdf.robot),
        )


@check("KV111", title="Names are unique", fails="Names are used twice", severity=Severity.ERROR, cause=Cause.ASSET)
def repeated_names(result: OpenCheck, urdf: Urdf) -> None:
    """No two links, and no two joints, have the same name.

    Why it matters: Readers keep one of the two, and not the same one.

    Remedy: Rename one of them, and correct what refers to it.
    """
    seen: dict[tuple[str, str], list[_Element]] = defaultdict(list)
    for element in _named(urdf):
        if name := element.get("name"):
            seen[str(element.tag), name].append(element)
    for (tag, name), elements in seen.items():
        if len(elements) > 1:
            lines = ", ".join(str(line_of(element)) for element in elements[:8])
            result.find(
                f"{len(elements)} {tag}s have the name {shown(name)} (lines {lines}).",
                f"Give every {tag} a name of its own, and correct what refers to it.",
                value=len(elements),
                limit=1,
                line=line_of(elements[1]),
                joint=name if tag == "joint" else None,
                link=name if tag == "link" else None,
            )


@check(
    "KV112",
    title="Names are usable elsewhere",
    fails="Names break other tools",
    severity=Severity.WARNING,
    cause=Cause.ASSET,
)
def odd_names(result: OpenCheck, urdf: Urdf) -> None:
    """Names hold no spaces, slashes, quotes and the like; a link below a joint is not called world.

    Why it matters: USD, ROS and MuJoCo change or refuse such names, so that results cannot be matched.

    Remedy: Use letters, digits and underscores.
    """
    for element in _named(urdf):
        name = element.get("name") or ""
        bad = _HARMFUL.search(name)
        if bad is not None:
            _odd(result, element, f"holds {bad.group()!r}, which paths and other formats give a meaning of its own")
        elif element.tag == "link" and name == "world" and name not in urdf.roots:
            _odd(result, element, "is what MuJoCo calls the fixed world, but the link hangs on a joint")


def _odd(result: OpenCheck, element: _Element, why: str) -> None:
    name = element.get("name")
    result.find(
        f"The name {shown(name)} of a {element.tag} {why}.",
        "Use letters, digits and underscores, beginning with a letter.",
        line=line_of(element),
        joint=name if element.tag == "joint" else None,
        link=name if element.tag == "link" else None,
    )


def _named(urdf: Urdf) -> Iterator[_Element]:
    yield from urdf.links
    yield from (joint.element for joint in urdf.joints)
