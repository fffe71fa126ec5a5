"""Meshes as generators, scanners and hasty exports leave them; every operator is seeded and leaves the truth alone.

A mesh operator takes the parts of an object and returns as many, in the same order, under the same names. A part that
was cut is scored as one where the answer fixes the pieces to each other. Lengths are shares of the object's diagonal.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import fast_simplification
import igl
import numpy as np
from trimesh.intersections import slice_faces_plane

from kinematify.assembly.assemble import simplified
from kinematify.assembly.part import Assembly, Part
from kinematify.evaluation.metrics import Prediction
from kinematify.geometry.convex import convex_hull, thickened
from kinematify.geometry.surface import PartSurface
from kinematify.robot.joint_type import JointType
from kinematify.robot.weld import welded

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.random import Generator

    from kinematify.config import Config
    from kinematify.robot.arrays import FloatArray

    Degrade = Callable[[Assembly, Generator], Assembly]

VERTEX_NOISE = 5e-4
"""Standard deviation of the place of every vertex."""
HOLES = 0.05
"""Share of the faces that are dropped."""
GROWN = 0.005
"""What every part grows by on each side of its box, so that neighbours stand in each other by up to twice as much."""
GAP = 0.01
"""Gap that opens between touching parts."""
OPEN_REACH = 2.5e-3
"""Faces this near to another part are missing from parts that were cut out of one shell."""
_OPEN_MOST = 0.5  # share of a part's area that goes missing at most
_NEARLY = 1.1  # times the faces that were asked for
_MARK = "_piece"
_TILT = np.radians(10.0)  # planes of cuts are square to the part within about this
_HULL_THICKNESS = 1e-4  # flat parts get a hull of this thickness


def voxels(resolution: int) -> Degrade:
    """Remesh every part on a grid of 1/`resolution` of the diagonal."""

    def remeshed(assembly: Assembly, rng: Generator) -> Assembly:
        # Exact signed distances come with torch, which takes seconds to import.
        from benchmarks.voxels import voxel_remeshed  # noqa: PLC0415

        seed = int(rng.integers(2**31))
        return with_parts(
            assembly, [voxel_remeshed(part, assembly.diagonal / resolution, seed=seed) for part in assembly.parts]
        )

    return remeshed


def vertex_noise(assembly: Assembly, rng: Generator) -> Assembly:
    """Vertices at one place move together, so that meshes stay closed."""

    def shaken(part: Part) -> Part:
        places, index = np.unique(part.vertices, axis=0, return_inverse=True)
        moved = places + VERTEX_NOISE * assembly.diagonal * rng.normal(size=places.shape)
        return replace(part, vertices=moved[index.reshape(-1)])

    return with_parts(assembly, [shaken(part) for part in assembly.parts])


def decimated(faces: int) -> Degrade:
    """Collapse edges until every part has at most about `faces` faces."""

    def fewer(part: Part) -> Part:
        if len(part.faces) <= faces:
            return part
        vertices, triangles = welded(part.vertices, part.faces, 1e-7)
        thin = igl.qslim(np.asfortranarray(vertices), np.asfortranarray(triangles.astype(np.int32)), faces)[:2]
        for haste in (3, 5, 7):
            if 0 < len(thin[1]) <= _NEARLY * faces:
                break  # else it met an edge of more than two faces; the other one is rougher the hastier it is
            thin = fast_simplification.simplify(vertices.copy(), triangles.copy(), target_count=faces, agg=haste)
        return replace(part, vertices=np.asarray(thin[0], dtype=np.float64), faces=np.asarray(thin[1], dtype=np.int64))

    return lambda assembly, rng: with_parts(assembly, [fewer(part) for part in assembly.parts])


def hulls(assembly: Assembly, rng: Generator) -> Assembly:
    """Every part becomes its convex hull."""

    def hull(part: Part) -> Part:
        points = part.vertices[np.unique(part.faces)]
        vertices, faces = convex_hull(thickened(points, _HULL_THICKNESS * assembly.diagonal))
        return replace(part, vertices=vertices, faces=faces)

    return with_parts(assembly, [hull(part) for part in assembly.parts])


def holes(assembly: Assembly, rng: Generator) -> Assembly:
    """Single faces are missing, at random."""

    def pierced(part: Part) -> Part:
        kept = rng.permutation(len(part.faces))[: max(round((1.0 - HOLES) * len(part.faces)), 1)]
        return replace(part, faces=part.faces[np.sort(kept)])

    return with_parts(assembly, [pierced(part) for part in assembly.parts])


def flipped(assembly: Assembly, rng: Generator) -> Assembly:
    """Every second face, at random, is turned inside out."""

    def turned(part: Part) -> Part:
        faces = part.faces.copy()
        chosen = rng.random(len(faces)) < 0.5
        faces[chosen] = faces[chosen][:, ::-1]
        return replace(part, faces=faces)

    return with_parts(assembly, [turned(part) for part in assembly.parts])


def gaps(assembly: Assembly, rng: Generator) -> Assembly:
    """Every part shrinks about the middle of its box by half a gap on each side, but to no less than half."""
    return with_parts(assembly, [_resized(part, -0.5 * GAP * assembly.diagonal) for part in assembly.parts])


def interpenetrating(assembly: Assembly, rng: Generator) -> Assembly:
    """Every part grows about the middle of its box on each side, but to no more than one and a half."""
    return with_parts(assembly, [_resized(part, GROWN * assembly.diagonal) for part in assembly.parts])


def _resized(part: Part, by: float) -> Part:
    middle, sides = part.bounds.mean(axis=0), np.ptp(part.bounds, axis=0)
    factors = np.clip(1.0 + 2.0 * by / np.maximum(sides, 1e-12), 0.5, 1.5)
    return replace(part, vertices=middle + factors * (part.vertices - middle))


def opened(assembly: Assembly, rng: Generator) -> Assembly:
    """Parts lack their surface where they lie on another one, as if cut out of one closed shell.

    The nearest faces go first; half of a part's area is kept in any case.
    """
    surfaces = [PartSurface(part, crease_angle=0.5) for part in assembly.parts]
    reach = OPEN_REACH * assembly.diagonal
    return with_parts(assembly, [_without_covered(k, assembly, surfaces, reach) for k in range(len(assembly.parts))])


def _without_covered(k: int, assembly: Assembly, surfaces: list[PartSurface], reach: float) -> Part:
    part = assembly.parts[k]
    corners = part.vertices[part.faces]
    probes = np.concatenate([corners, corners.mean(axis=1, keepdims=True)], axis=1)
    farthest = np.full(len(part.faces), np.inf)
    lower, upper = part.bounds[0] - reach, part.bounds[1] + reach
    for other, surface in zip(assembly.parts, surfaces, strict=True):
        if other is part or (other.bounds[0] > upper).any() or (other.bounds[1] < lower).any():
            continue
        distances = surface.distance(probes.reshape(-1, 3)).reshape(-1, 4)
        farthest = np.minimum(farthest, distances.max(axis=1))
    order = np.argsort(farthest, kind="stable")
    share = np.cumsum(part.face_areas[order]) / max(part.area, 1e-300)
    gone = order[(farthest[order] <= reach) & (share <= _OPEN_MOST)]
    return replace(part, faces=np.delete(part.faces, gone, axis=0))


@dataclass(frozen=True, kw_only=True, eq=False)
class DegradedParts:
    """Parts that an inference is given instead of an object's own."""

    assembly: Assembly
    pieces: Mapping[str, str] = field(default_factory=dict)
    """Name of a piece that was cut off -> the part that it was cut from."""

    def rejoined(self, prediction: Prediction, index: Mapping[str, int]) -> tuple[Prediction, int]:
        """Return a prediction over the parts before they were cut, and how many cuts came out as fixed."""
        return without_pieces(prediction, {index[piece]: index[whole] for piece, whole in self.pieces.items()})


def without_pieces(prediction: Prediction, pieces: Mapping[int, int]) -> tuple[Prediction, int]:
    """A prediction in which pieces that are fixed to each other are one part again.

    Args:
        prediction: Over all parts.
        pieces: Index of a piece -> that of the part that it was cut from.

    Returns:
        The prediction over what is left, and how many cuts came out as fixed.
    """
    whole = {part: part for part in prediction.parents}
    fixed = {joint.child for joint in prediction.joints if joint.kind == JointType.FIXED}
    for child, parent in prediction.parents.items():
        if child in fixed and pieces.get(child, child) == pieces.get(parent, parent):
            kept, gone = sorted((_whole(whole, child), _whole(whole, parent)), key=lambda part: part in pieces)
            whole[gone] = kept
    parents = {
        _whole(whole, part): -1 if above < 0 else _whole(whole, above)
        for part, above in prediction.parents.items()
        if above < 0 or _whole(whole, part) != _whole(whole, above)
    }
    joints = tuple(
        replace(joint, parent=_whole(whole, joint.parent), child=_whole(whole, joint.child))
        for joint in prediction.joints
        if _whole(whole, joint.parent) != _whole(whole, joint.child)
    )
    return Prediction(parents=parents, joints=joints), sum(part != above for part, above in whole.items())


def _whole(whole: Mapping[int, int], part: int) -> int:
    while whole[part] != part:
        part = whole[part]
    return part


DEGRADATIONS: Mapping[str, Degrade] = {
    "voxels-300": voxels(300),
    "voxels-150": voxels(150),
    "vertex-noise": vertex_noise,
    "faces-1000": decimated(1000),
    "faces-300": decimated(300),
    "hulls": hulls,
    "holes": holes,
    "flipped": flipped,
    "gaps": gaps,
    "interpenetration": interpenetrating,
    "open": opened,
}
"""Name of a degradation -> what it does to an object."""


OVER_SEGMENTED = {"cut-2": 2, "cut-3": 3}
"""Name of a degradation -> number of pieces that one part is cut into."""
DEGRADED = (*DEGRADATIONS, *OVER_SEGMENTED)
"""Rough input that the inference is measured on."""


def degraded(name: str, assembly: Assembly, config: Config, *, seed: int) -> DegradedParts:
    """Degrade an object, as the benchmark asks for it.

    Args:
        name: One of `DEGRADED`.
        assembly: The parts as they are.
        config: Of the inference; heavy meshes are simplified by it, as those that a user loads are.
        seed: Draws what is done.
    """
    rng = np.random.default_rng([seed, len(assembly.parts)])
    if name in OVER_SEGMENTED:
        return _cut(assembly, OVER_SEGMENTED[name], rng)
    rough = DEGRADATIONS[name](assembly, rng)
    most = config.assembly.max_part_faces
    parts = [part if len(part.faces) <= most else simplified(part, config.assembly) for part in rough.parts]
    return DegradedParts(assembly=with_parts(assembly, parts))


def _cut(assembly: Assembly, count: int, rng: Generator) -> DegradedParts:
    """One part is cut by planes across its longest direction, tilted a little, at places that keep all pieces large."""
    chosen = int(rng.integers(len(assembly.parts)))
    part = assembly.parts[chosen]
    direction = np.eye(3)[int(np.argmax(np.ptp(part.bounds, axis=0)))] + np.tan(_TILT) * rng.uniform(-1, 1, size=3)
    direction /= np.linalg.norm(direction)
    low, high = np.quantile(part.vertices[part.faces].mean(axis=1) @ direction, [0.02, 0.98])
    shares = (np.arange(1, count) + rng.uniform(-0.2, 0.2, size=count - 1)) / count
    bands = cut_in_bands(part, direction, (low + shares * (high - low)).tolist())
    pieces = [piece for piece in bands if piece.area > 1e-3 * part.area]
    if len(pieces) < count:
        return DegradedParts(assembly=assembly)
    return _in_pieces(assembly, chosen, pieces)


def cut_in_bands(part: Part, direction: FloatArray, offsets: Sequence[float]) -> list[Part]:
    """Cut a part by parallel planes, triangles too; the pieces are open and meet edge to edge.

    Args:
        part: Any mesh.
        direction: Unit normal of the planes, shape (3,).
        offsets: Where the planes stand along it, ascending [m].

    Returns:
        One piece more than there are planes, from below; a piece without faces where a plane misses the part.
    """
    bands, rest = [], part
    for offset in offsets:
        below, rest = (_half(rest, sign * direction, sign * offset) for sign in (-1.0, 1.0))
        bands.append(below)
    return [*bands, rest]


def _half(part: Part, normal: FloatArray, offset: float) -> Part:
    """What lies on the positive side of a plane."""
    if not len(part.faces):
        return part
    # Face indices are kept in the order of the mesh, so that both halves interpolate their common edges alike.
    vertices, faces, _ = slice_faces_plane(  # type: ignore[no-untyped-call]
        part.vertices, part.faces, normal, offset * normal
    )
    return replace(part, vertices=vertices, faces=faces)


def _in_pieces(assembly: Assembly, chosen: int, pieces: Sequence[Part]) -> DegradedParts:
    """The assembly with one part in pieces; the largest one keeps its name."""
    name = assembly.parts[chosen].name
    first, *others = sorted(pieces, key=lambda piece: -piece.area)
    named = [replace(piece, name=f"{name}{_MARK}{number}") for number, piece in enumerate(others, start=1)]
    parts = list(assembly.parts)
    parts[chosen] = first
    return DegradedParts(assembly=with_parts(assembly, [*parts, *named]), pieces={piece.name: name for piece in named})


def with_parts(assembly: Assembly, parts: list[Part]) -> Assembly:
    """The assembly with other parts."""
    return Assembly(parts=tuple(parts), source=assembly.source)
