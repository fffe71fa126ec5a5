"""KV110 to KV113: names of links and joints, and what Isaac Sim makes of them."""

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
_NO_PRIM = re.compile(r"[^A-Za-z0-9_]|^[0-9]")
"""What the name of a USD prim does not hold."""


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


@check(
    "KV113",
    title="Isaac Sim keeps names and order of joints",
    fails="Isaac Sim changes names or order of joints",
    severity=Severity.NOTE,
    cause=Cause.ENGINE,
)
def of_isaac(result: OpenCheck, urdf: Urdf) -> None:
    """Only with `--isaac`. Names are names of USD prims as they are, and the joints that turn or slide are in the order
    of PhysX: breadth first from the root, children in the order of the file. Isaac Sim itself is not run.

    Why it matters: The entries of actions and observations belong to other joints, and prims are not found by name.

    Remedy: Find joints by their names, not by their place, and write names of letters, digits and underscores.
    """
    remedy = "Find joints by their names, and write names of letters, digits and underscores."
    for tag in ("link", "joint"):
        new = {name: _prim(name) for item in _named(urdf) if item.tag == tag and (name := item.get("name"))}
        changed = [f"{shown(name)} to {prim}" for name, prim in new.items() if name != prim]
        same = len(new) - len({*new.values()})
        if changed:
            result.find(
                f"Isaac Sim changes {len(changed)} names of {tag}s, such as {changed[0]}; {same} then name others too.",
                remedy,
                severity=Severity.WARNING if same else None,
            )
    moving = [edge for edge in urdf.edges if edge.kind in ("revolute", "continuous", "prismatic")]
    rank = {link: number for number, link in enumerate(urdf.depths(urdf.roots))}
    order = sorted(moving, key=lambda edge: rank.get(edge.parent, 0))
    if order != moving:
        result.find(f"Isaac Sim orders the joints so: {', '.join(edge.name for edge in order)}.", remedy)


def _prim(name: str) -> str:
    """Return the name that the importer of Isaac Sim writes, by its manual ("Conventions" of the URDF importer)."""
    prim = _NO_PRIM.sub("_", name)
    return f"a{prim}" if prim != name and prim.startswith("_") else prim


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
