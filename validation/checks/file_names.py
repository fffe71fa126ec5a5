"""KV110 to KV112: names of links and joints."""

from __future__ import annotations

import re
from collections import defaultdict
from typing import TYPE_CHECKING

from kinematify.validation.finding import Severity
from kinematify.validation.precheck.problem import Problem, line_of, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.validation.precheck.urdf import Urdf

_HARMFUL = re.compile(r"""[\s<>&"'/\\|*?:;,]""")
_IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def missing_names(urdf: Urdf) -> Iterator[Problem]:
    """KV110."""
    for element in _named(urdf):
        if not (element.get("name") or "").strip():
            yield Problem(
                message=f"A <{element.tag}> has no name, so that nothing can refer to it.",
                remedy=f'Write <{element.tag} name="..."> with a name that no other {element.tag} has.',
                line=line_of(element),
            )
    if not (urdf.robot.get("name") or "").strip():
        yield Problem(
            message="The <robot> has no name; PyBullet and urdfdom want one.",
            remedy='Write <robot name="...">.',
            severity=Severity.WARNING,
            line=line_of(urdf.robot),
        )


def repeated_names(urdf: Urdf) -> Iterator[Problem]:
    """KV111."""
    seen: dict[tuple[str, str], list[_Element]] = defaultdict(list)
    for element in _named(urdf):
        if name := element.get("name"):
            seen[str(element.tag), name].append(element)
    for (tag, name), elements in seen.items():
        if len(elements) > 1:
            lines = ", ".join(str(line_of(element)) for element in elements[:8])
            yield Problem(
                message=f"{len(elements)} {tag}s have the name {shown(name)} (lines {lines}).",
                remedy=f"Give every {tag} a name of its own, and correct what refers to it.",
                value=len(elements),
                limit=1,
                line=line_of(elements[1]),
                joint=name if tag == "joint" else None,
                link=name if tag == "link" else None,
            )


def odd_names(urdf: Urdf) -> Iterator[Problem]:
    """KV112."""
    plain = []
    for element in _named(urdf):
        name = element.get("name") or ""
        bad = _HARMFUL.search(name)
        if bad is not None:
            yield _odd(element, f"holds {bad.group()!r}, which paths and other formats give a meaning of its own")
        elif element.tag == "link" and name == "world" and name not in urdf.roots:
            yield _odd(element, "is what MuJoCo calls the fixed world, but the link hangs on a joint")
        elif name and not _IDENTIFIER.fullmatch(name):
            plain.append(element)
    if plain:
        yield Problem(
            message=f"Names that are no identifiers: {len(plain)}, the first is {shown(plain[0].get('name'))}. USD and "
            "many scripts will change them.",
            remedy="Use letters, digits and underscores, beginning with a letter.",
            severity=Severity.NOTE,
            value=len(plain),
            line=line_of(plain[0]),
        )


PROBES = {"KV110": missing_names, "KV111": repeated_names, "KV112": odd_names}


def _odd(element: _Element, why: str) -> Problem:
    name = element.get("name")
    return Problem(
        message=f"The name {shown(name)} of a {element.tag} {why}.",
        remedy="Use letters, digits and underscores, beginning with a letter.",
        line=line_of(element),
        joint=name if element.tag == "joint" else None,
        link=name if element.tag == "link" else None,
    )


def _named(urdf: Urdf) -> Iterator[_Element]:
    yield from urdf.links
    yield from (joint.element for joint in urdf.joints)
