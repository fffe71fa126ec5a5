"""Boxes with a lid: hinged, sliding in grooves, or lifted off straight."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematify.generate.procedural.family import family
from kinematify.generate.procedural.pieces.lids import BackEdge, add_barrels
from kinematify.generate.procedural.solids import box, cylinder, tray

if TYPE_CHECKING:
    from manifold3d import Manifold

    from kinematify.generate.procedural.family import Values
    from kinematify.generate.procedural.workshop import Workshop


def _build(values: Values, workshop: Workshop) -> None:
    {"hinged": _hinged, "sliding": _sliding, "loose": _loose}[values.choice("lid")](values, workshop)


def _hinged(values: Values, workshop: Workshop) -> None:
    """A lid that turns up about the upper back edge."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    wall, clearance = values.number("wall"), values.number("clearance")
    level = height + clearance
    workshop.body("body", tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall))
    lid = box((-0.5 * width, 0, level), (0.5 * width, depth, level + wall))
    if values.choice("top") == "round":
        lid += _vault(width, depth, level + 0.5 * wall, max(wall, min(0.35 * depth, 0.4 * height)))
    grip = box((-0.12 * width, -0.012, level), (0.12 * width, 0.1 * depth, level + 0.3 * wall))
    workshop.body("lid", lid, grip)
    pivot: tuple[float, float, float] = (0.0, depth, level)
    kind = values.choice("hinge")
    if kind != "edge":
        edge = BackEdge(y=depth, level=level, below=height, above=wall, clearance=clearance)
        whole = kind == "piano"
        places, length = ((0.0,), 0.9 * width) if whole else ((-0.3 * width, 0.3 * width), min(0.05, 0.3 * width))
        radius, knuckles = min(0.004, 0.5 * wall), 9 if whole else 3
        pivot = add_barrels(workshop, ("body", "lid"), edge, places, length=length, radius=radius, knuckles=knuckles)
    workshop.turns("lid", "body", (-1, 0, 0), pivot, (0.0, 1.9), rest=values.number("open"))


def _vault(width: float, depth: float, level: float, rise: float) -> Manifold:
    """What stands on the lid of a treasure chest: a part of a cylinder that rises over the depth."""
    radius = 0.5 * rise + 0.125 * depth * depth / rise
    centre = (0.5 * depth, level + rise - radius)
    whole = cylinder(radius, (-0.5 * width, *centre), (0.5 * width, *centre), segments=96)
    return whole.trim_by_plane((0, 0, 1), level)


def _sliding(values: Values, workshop: Workshop) -> None:
    """A lid that is drawn out along -y in grooves of the side walls, as of a pencil box."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    wall, clearance = values.number("wall"), values.number("clearance")
    level, thick, groove = height - 2.0 * wall, wall, 0.5 * wall
    body = tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall)
    half = 0.5 * width - wall + groove
    slot = box((-half, -1.0, level), (half, depth - wall + groove, level + thick))
    mouth = box((wall - 0.5 * width, -1.0, level), (0.5 * width - wall, wall + 1e-3, height + 1.0))
    workshop.body("body", body - slot - mouth)
    gap = min(clearance, 0.25 * wall)
    lid = box((gap - half, 0, level + gap), (half - gap, depth - wall + groove - gap, level + thick - gap))
    notch = box((-0.1 * width, 0.08 * depth, level), (0.1 * width, 0.08 * depth + 0.006, level + thick + 0.3 * wall))
    workshop.body("lid", lid, notch.trim_by_plane((0, 0, 1), level + 0.5 * thick))
    workshop.slides("lid", "body", (0, -1, 0), (0, 0, level), (0.0, 0.85 * depth), rest=values.number("open"))


def _loose(values: Values, workshop: Workshop) -> None:
    """A lid that reaches over the rim and is lifted off."""
    width, depth, height = (values.number(name) for name in ("width", "depth", "height"))
    wall, gap = values.number("wall"), max(values.number("clearance"), 2e-4)
    workshop.body("body", tray((-0.5 * width, 0, 0), (0.5 * width, depth, height), wall))
    out = gap + wall
    skirt = max(2.0 * wall, 0.2 * height)
    lower = (-0.5 * width - out, -out, height - skirt)
    cap = box(lower, (0.5 * width + out, depth + out, height + gap + wall))
    inner = box((-0.5 * width - gap, -gap, height - skirt - 1.0), (0.5 * width + gap, depth + gap, height + gap))
    workshop.body("lid", cap - inner)
    travel = (0.0, 1.2 * skirt)
    workshop.slides("lid", "body", (0, 0, 1), (0, 0.5 * depth, height), travel, rest=values.number("open"))


FAMILY = family("box", _build)
