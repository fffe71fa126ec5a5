"""KV138 to KV140: the geometry elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lxml import etree

from kinematify.robot.urdf_numbers import line_of
from kinematify.validation.check import check
from kinematify.validation.document import cause_of, finite_numbers, shown
from kinematify.validation.finding import Cause, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

    from kinematify.validation.check import OpenCheck
    from kinematify.validation.document import Urdf

_SIZES = {"box": ("size",), "sphere": ("radius",), "cylinder": ("radius", "length"), "capsule": ("radius", "length")}
_KNOWN = ("mesh", *_SIZES)


@check(
    "KV138",
    title="Sizes of primitives are above zero",
    fails="A primitive has no usable size",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
)
def bad_sizes(result: OpenCheck, urdf: Urdf) -> None:
    """Every length of a box, sphere, cylinder or capsule is above zero. A length of zero is a warning: such a shape
    counts as none, and all other checks leave it out.

    Why it matters: PyBullet accepts a negative size and collides with something else than the picture shows. MuJoCo
    refuses a size of zero.

    Remedy: Write the true size in metres, or delete the element.
    """
    for link, element, shape in _shapes(urdf):
        for attribute in _SIZES.get(str(shape.tag), ()):
            values = finite_numbers(shape.get(attribute) or "")
            if values and min(values) <= 0.0:
                result.find(
                    f"The <{shape.tag}> of a {element.tag} of the link {link} has {attribute}="
                    f"{shown(shape.get(attribute))}; every length must be above zero.",
                    "Write the true size in metres, or delete the element.",
                    severity=Severity.WARNING if min(values) == 0.0 else None,
                    cause=cause_of(element),
                    link=link,
                    value=min(values),
                    limit=0.0,
                    unit="m",
                    line=line_of(shape),
                )


@check(
    "KV139",
    title="Scales of meshes are plausible",
    fails="The scale of a mesh is implausible",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
)
def bad_scales(result: OpenCheck, urdf: Urdf) -> None:
    """No factor of a mesh scale is zero (`zero_scale`); a negative one is a note.

    Why it matters: A mesh scaled by zero vanishes; a mirrored one is inside out for some readers.

    Remedy: Write the factor from the unit of the mesh to metres.
    """
    for link, element, shape in _shapes(urdf):
        scale = finite_numbers(shape.get("scale") or "") if shape.tag == "mesh" else None
        if not scale:
            continue
        smallest = min(scale, key=abs)
        if abs(smallest) <= urdf.settings.zero_scale:
            result.find(
                f"The mesh of a {element.tag} of the link {link} is scaled by {shown(shape.get('scale'))}, "
                "which leaves nothing of it.",
                "Write 1 1 1, or 0.001 0.001 0.001 for a mesh in millimetres.",
                link=link,
                value=smallest,
                limit=urdf.settings.zero_scale,
                line=line_of(shape),
            )
        elif min(scale) < 0.0:
            result.find(
                f"The mesh of a {element.tag} of the link {link} is mirrored by its scale "
                f"{shown(shape.get('scale'))}; some readers turn it inside out.",
                "Mirror the mesh itself and write a positive scale.",
                severity=Severity.NOTE,
                link=link,
                value=min(scale),
                limit=0.0,
                line=line_of(shape),
            )


@check(
    "KV140",
    title="Geometry elements are complete",
    fails="A geometry element is incomplete",
    severity=Severity.ERROR,
    cause=Cause.ASSET,
)
def malformed_shapes(result: OpenCheck, urdf: Urdf) -> None:
    """Every visual and collision holds one known shape with the attributes that it needs; for a visual it is a warning.
    All else is checked without the element.

    Why it matters: Readers stop, or drop the shape in silence.

    Remedy: Give every visual and collision one complete shape.
    """
    for link, element in urdf.shapes():
        fault = _fault(element)
        if fault is not None:
            message, remedy = fault
            result.find(
                f"A {element.tag} of the link {link} {message}.",
                remedy,
                severity=Severity.WARNING if element.tag == "visual" else None,
                cause=cause_of(element),
                link=link,
                line=line_of(element),
                harmless=True,
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


def _shapes(urdf: Urdf) -> Iterator[tuple[str, _Element, _Element]]:
    """Name of the link, visual or collision element, and every element inside its geometry."""
    for link, element in urdf.shapes():
        for geometry in element.findall("geometry"):
            yield from ((link, element, shape) for shape in geometry.iterchildren(etree.Element))
