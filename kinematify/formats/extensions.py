"""What a URDF states beyond links and joints: extensions of Gazebo, ROS and others, carried where a format can."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lxml import etree

from kinematify.robot.urdf_text import parse_description

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from lxml.etree import _Element

_KNOWN = {
    "robot": "name version link joint material loop_joint ball_constraint",
    "link": "name inertial visual collision",
    "inertial": "origin mass inertia",
    "visual": "origin geometry material",
    "collision": "origin geometry concave",
    "joint": "name type origin parent child axis limit dynamics mimic",
    "limit": "lower upper effort velocity",
    "dynamics": "damping friction",
    "mimic": "joint multiplier offset",
}
"""Children and attributes that `Robot` holds."""


@dataclass(kw_only=True, eq=False)
class Extensions:
    """What a document states that a `Robot` does not hold."""

    elements: list[tuple[str, str, _Element]] = field(default_factory=list)
    """Tag and name of the element that has it (``robot``, ``link`` or ``joint``), and a whole element."""
    lost: Counter[str] = field(default_factory=Counter)
    """What only an element in `elements` holds, by its name."""
    dropped: Counter[str] = field(default_factory=Counter)
    """What no format holds."""
    surfaces: dict[str, list[float]] = field(default_factory=dict)
    """Coefficients of friction of links, along and across."""
    springs: dict[str, list[float]] = field(default_factory=dict)
    """Of joints: stiffness [N m/rad or N/m] and rest value [rad or m]."""


def read_extensions(urdf: Path, links: Mapping[str, str], joints: Mapping[str, str]) -> Extensions:
    """Read what a `Robot` leaves out.

    Args:
        urdf: The file.
        links: New name by old name.
        joints: New name by old name.

    Raises:
        DescriptionError: The file is no URDF.
    """
    found = Extensions()
    document = parse_description(urdf)
    _walk(document, ("robot", ""), found)
    carried = (
        (found.surfaces, links, ("mu1", "mu2")),
        (found.springs, joints, ("springStiffness", "springReference")),
    )
    for element in document.findall("gazebo"):
        reference = element.get("reference", "")
        for kept, names, keys in carried:
            values = [_number(element, key) for key in keys]
            if reference in names and values[0] is not None:
                other = values[0] if names is links else 0.0
                kept[names[reference]] = [values[0], other if values[1] is None else values[1]]
                found.lost.subtract(
                    f"gazebo {key}" for key, value in zip(keys, values, strict=True) if value is not None
                )
    return found


def _number(parent: _Element, tag: str) -> float | None:
    element = parent.find(tag)
    try:
        value = float("nan" if element is None else element.get("value") or element.text or "nan")
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _walk(element: _Element, owner: tuple[str, str], found: Extensions) -> None:
    tag = etree.QName(element).localname
    known = _KNOWN[tag].split()
    found.dropped.update(f"{tag} {key}" for key in map(str, element.attrib) if key not in known)
    for child in element.iterchildren("*"):
        name = etree.QName(child).localname
        if name in _KNOWN and name in known:
            _walk(child, (name, child.get("name", "")) if name in ("link", "joint") else owner, found)
        elif name not in known and owner[0] != tag:
            found.dropped[f"{tag} {name}"] += 1
        elif name not in known:
            found.elements.append((*owner, child))
            inside = [f"gazebo {etree.QName(item).localname}" for item in child.iterchildren("*")]
            found.lost.update(inside if name == "gazebo" else [name if tag == "robot" else f"{tag} {name}"])
