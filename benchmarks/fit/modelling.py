"""Ways in which people model the same mechanism: the joints stay, and what is drawn of parts and hardware changes.

Independent of the family. The exact joints of a blueprint hold for every way of modelling, also where solids then
stand in each other or no longer touch, as in most files that one finds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import Manifold, Mesh64

from kinematify.generate.procedural.solids import box

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint

    Solids = dict[str, Manifold]


def augment(blueprint: Blueprint, way: str, *, rng: np.random.Generator) -> Blueprint:
    """Return the same mechanism as another hand would have modelled it.

    Args:
        blueprint: Clean solids.
        way: Of `WAYS`.
        rng: Draws sizes, and which parts it concerns.
    """
    solids = {part.name: _solid(part) for part in blueprint.parts}
    changed = WAYS[way](blueprint, solids, rng)
    parts = tuple(
        part if changed[part.name] is solids[part.name] else _with_mesh(part, changed[part.name])
        for part in blueprint.parts
    )
    return replace(blueprint, parts=parts, parameters={**blueprint.parameters, "modelled": way})


def _solid(part: Part) -> Manifold:
    # Parts are read-only, which manifold3d does not take.
    return Manifold(Mesh64(vert_properties=np.array(part.vertices), tri_verts=np.array(part.faces, dtype=np.uint64)))


def _with_mesh(part: Part, solid: Manifold) -> Part:
    mesh = solid.to_mesh64()
    if len(mesh.tri_verts) == 0:
        return part  # nothing would be left of it
    return replace(part, vertices=mesh.vert_properties[:, :3], faces=mesh.tri_verts)


def _as_drawn(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """With its hardware, bored and with clearance."""
    return solids


def _solid_in_solid(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """No bores and no cavities: what carries a part is solid where the part stands in it."""
    result = dict(solids)
    for joint in blueprint.joints:
        carrier = solids[joint.parent]
        result[joint.parent] = result[joint.parent] + (solids[joint.child].hull() ^ carrier.hull())
    return result


def _filled_contact(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Pins stand in barrels that were never bored."""
    result = dict(solids)
    for joint in blueprint.joints:
        result[joint.parent] = result[joint.parent] + (solids[joint.child] ^ solids[joint.parent].hull())
    return result


def _without_hardware(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Every moving part is a plain convex body, cut off where it would stand in its carrier."""
    result = dict(solids)
    for joint in blueprint.joints:
        result[joint.child] = solids[joint.child].hull() - solids[joint.parent]
    return result


def _boxes(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Every moving part is the box around it, as in quick models; it stands in whatever it stands in."""
    moving = {joint.child for joint in blueprint.joints}
    bounds = {name: solid.bounding_box() for name, solid in solids.items()}
    return {name: box(bounds[name][:3], bounds[name][3:]) if name in moving else solids[name] for name in solids}


def _hulls(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Everything convex, as collision models are."""
    return {name: solid.hull() for name, solid in solids.items()}


def _apart(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Gaps of up to ten millimetres, or a fortieth of the part, all around every moving part."""
    result = dict(solids)
    for joint in blueprint.joints:
        bounds = np.array(solids[joint.child].bounding_box())
        size = np.maximum(bounds[3:] - bounds[:3], 1e-9)
        middle = 0.5 * (bounds[:3] + bounds[3:])
        gap = min(0.01, 0.025 * float(size.max())) * float(rng.uniform(0.2, 1.0))
        factor = np.maximum(1.0 - 2.0 * gap / size, 0.5)
        result[joint.child] = solids[joint.child].translate(-middle).scale(factor).translate(middle)
    return result


def _swollen(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Moving parts a little too large, so that they overlap what is around them."""
    result = dict(solids)
    for joint in blueprint.joints:
        bounds = np.array(solids[joint.child].bounding_box())
        middle = 0.5 * (bounds[:3] + bounds[3:])
        factor = 1.0 + float(rng.uniform(0.004, 0.03))
        result[joint.child] = solids[joint.child].translate(-middle).scale((factor,) * 3).translate(middle)
    return result


def _decimated(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Few triangles, so that round is no longer round."""
    share = float(rng.uniform(0.005, 0.02))
    return {name: solid.simplify(share * _size(solid)) for name, solid in solids.items()}


def _size(solid: Manifold) -> float:
    bounds = np.array(solid.bounding_box())
    return float(np.linalg.norm(bounds[3:] - bounds[:3]))


def _hollow(blueprint: Blueprint, solids: Solids, rng: np.random.Generator) -> Solids:
    """Every part has a second wall inside, as of shells with a thickness."""
    factor = float(rng.uniform(0.9, 0.98))
    result = {}
    for name, solid in solids.items():
        bounds = np.array(solid.bounding_box())
        middle = 0.5 * (bounds[:3] + bounds[3:])
        inner = solid.translate(-middle).scale((factor,) * 3).translate(middle) ^ solid
        result[name] = solid - inner if inner.volume() > 0.0 else solid
    return result


WAYS: dict[str, Callable[[Blueprint, Solids, np.random.Generator], Solids]] = {
    "as_drawn": _as_drawn,
    "solid_in_solid": _solid_in_solid,
    "filled_contact": _filled_contact,
    "without_hardware": _without_hardware,
    "boxes": _boxes,
    "hulls": _hulls,
    "apart": _apart,
    "swollen": _swollen,
    "decimated": _decimated,
    "hollow": _hollow,
}
"""Every way of modelling."""
