"""KV138 to KV140: the geometry elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from kinematify.validation.finding import Severity
from kinematify.validation.precheck.numbers import finite_numbers
from kinematify.validation.precheck.problem import Problem, blame_of, line_of, shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.validation.precheck.urdf import Urdf

_SIZES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "capsule": ("radius", "length")}
_KNOWN = ("mesh", *_SIZES)


def bad_sizes(urdf: Urdf) -> Iterator[Problem]:
    """KV138."""
    for link, element, shape in _shapes(urdf):
        for attribute in _SIZES.get(str(shape.tag), ()):
            values = finite_numbers(shape.get(attribute) or "")
            if values and min(values) <= 0.0:
                yield Problem(
                    message=f"The <{shape.tag}> of a {element.tag} of the link {link} has {attribute}="
                    f"{shown(shape.get(attribute))}; every length must be above zero.",
                    remedy="Write the true size in metres, or delete the element.",
                    blame=blame_of(element),
                    link=link,
                    value=min(values),
                    limit=0.0,
                    unit="m",
                    line=line_of(shape),
                )


def bad_scales(urdf: Urdf) -> Iterator[Problem]:
    """KV139."""
    for link, element, shape in _shapes(urdf):
        scale = finite_numbers(shape.get("scale") or "") if shape.tag == "mesh" else None
        if not scale:
            continue
        smallest = min(scale, key=abs)
        if abs(smallest) <= urdf.settings.zero_scale:
            yield Problem(
                message=f"The mesh of a {element.tag} of the link {link} is scaled by {shown(shape.get('scale'))}, "
                "which leaves nothing of it.",
                remedy="Write 1 1 1, or 0.001 0.001 0.001 for a mesh in millimetres.",
                link=link,
                value=smallest,
                limit=urdf.settings.zero_scale,
                line=line_of(shape),
            )
        elif min(scale) < 0.0:
            yield Problem(
                message=f"The mesh of a {element.tag} of the link {link} is mirrored by its scale "
                f"{shown(shape.get('scale'))}; some readers turn it inside out.",
                remedy="Mirror the mesh itself and write a positive scale.",
                severity=Severity.NOTE,
                link=link,
                value=min(scale),
                limit=0.0,
                line=line_of(shape),
            )


def malformed_shapes(urdf: Urdf) -> Iterator[Problem]:
    """KV140."""
    for link, element in urdf.shapes():
        fault = _fault(element)
        if fault is not None:
            message, remedy = fault
            yield Problem(
                message=f"A {element.tag} of the link {link} {message}.",
                remedy=remedy,
                blame=blame_of(element),
                link=link,
                line=line_of(element),
            )


def _fault(element: _Element) -> tuple[str, str] | None:
    geometry = element.find("geometry")
    if geometry is None:
        return "has no <geometry>", f"Add one, or delete the <{element.tag}>."
    shapes = list(geometry)
    if len(shapes) != 1:
        return f"has {len(shapes)} shapes in its <geometry>; there must be one", (
            f"Give every shape a <{element.tag}> of its own."
            if shapes
            else f"Add a mesh, box, cylinder or sphere, or delete the <{element.tag}>."
        )
    shape = shapes[0]
    if shape.tag not in _KNOWN:
        return f"has a <{shape.tag}>, which URDF does not have", "Use a mesh, box, cylinder or sphere."
    absent = [name for name in _SIZES.get(str(shape.tag), ("filename",)) if not (shape.get(name) or "").strip()]
    if absent:
        return f"has a <{shape.tag}> without {' and '.join(absent)}", f'Write <{shape.tag} {absent[0]}="..."/>.'
    return None


PROBES = {"KV138": bad_sizes, "KV139": bad_scales, "KV140": malformed_shapes}


def _shapes(urdf: Urdf) -> Iterator[tuple[str, _Element, _Element]]:
    """Name of the link, visual or collision element, and every element inside its geometry."""
    for link, element in urdf.shapes():
        for geometry in element.findall("geometry"):
            yield from ((link, element, shape) for shape in geometry.iterchildren(etree.Element))
