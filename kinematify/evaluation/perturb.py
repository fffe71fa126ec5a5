"""Input that is a little wrong, as real input is: what the inference has to bear and the refinement to mend.

Every perturbation is seeded and touches the parts, the contact graph or the tolerance alone, so that the truth stays
what it was. A part that was cut in two is scored as one where the answer fixes the pieces to each other.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from trimesh.intersections import slice_faces_plane

from benchmarks.degrade import DEGRADATIONS, with_parts
from kinematify.assembly.assemble import simplified
from kinematify.contact.build import build_contact_graph
from kinematify.evaluation.prediction import Prediction
from kinematify.geometry.surface import part_surfaces
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.random import Generator

    from benchmarks.degrade import Degrade
    from kinematify.assembly.part import Assembly, Part
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph
    from kinematify.robot.arrays import FloatArray

CLEAN = "clean"
NOISE = 0.02
"""Vertices are moved by up to this share of the smallest side of their part's box."""
MISSING, SPURIOUS = 2, 3
"""Contacts that are left out, and that are made up."""
_REACH = 10.0  # contacts are made up between parts up to this multiple of the tolerance apart, nearest ones if none is
_MARK = "_piece"
_TILT = np.radians(10.0)  # planes of cuts stand square to the part within about this


@dataclass(frozen=True, kw_only=True, eq=False)
class Perturbed:
    """What an inference is given."""

    assembly: Assembly
    config: Config
    graph: ContactGraph | None = None
    """Contacts where they are not measured."""
    pieces: Mapping[str, str] = field(default_factory=dict)
    """Name of a piece that was cut off -> the part that it was cut from."""


def perturbed(name: str, assembly: Assembly, config: Config, *, seed: int) -> Perturbed:
    """Perturb an object.

    Args:
        name: `CLEAN`, or one of `PERTURBATIONS` or `DEGRADED`.
        assembly: The parts as they are.
        config: Of the inference.
        seed: Draws what is perturbed.
    """
    return _HOW[name](assembly, config, np.random.default_rng([seed, len(assembly.parts)]))


def without_pieces(prediction: Prediction, pieces: Mapping[int, int]) -> tuple[Prediction, int]:
    """A prediction in which pieces that are fixed to each other are one part again.

    Args:
        prediction: Over all parts.
        pieces: Index of a piece -> that of the part that it was cut from.

    Returns:
        The prediction over what is left, and how many cuts were mended.
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


# ---- what is done --------------------------------------------------------------------------------------------------


def _clean(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
    return Perturbed(assembly=assembly, config=config)


def _tolerance(factor: float) -> Callable[[Assembly, Config, Generator], Perturbed]:
    def scaled(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
        contact = config.contact.model_copy(update={"tolerance": factor * config.contact.tolerance})
        return Perturbed(assembly=assembly, config=config.model_copy(update={"contact": contact}))

    return scaled


def _noise(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
    """Vertices at one place move together, so that meshes stay closed."""

    def shaken(part: Part) -> Part:
        places, index = np.unique(part.vertices, axis=0, return_inverse=True)
        reach = NOISE * float(np.sort(np.ptp(places, axis=0))[0] or np.sort(np.ptp(places, axis=0))[1])
        way = rng.normal(size=places.shape)
        way *= reach * rng.random((len(places), 1)) / np.linalg.norm(way, axis=1)[:, None]
        return replace(part, vertices=(places + way)[index.reshape(-1)])

    return Perturbed(assembly=with_parts(assembly, [shaken(part) for part in assembly.parts]), config=config)


def _mesh(degrade: Degrade) -> Callable[[Assembly, Config, Generator], Perturbed]:
    """Degraded meshes; heavy ones are simplified as those that a user loads are."""

    def degraded(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
        rough = degrade(assembly, rng)
        most = config.assembly.max_part_faces
        parts = [part if len(part.faces) <= most else simplified(part, config.assembly) for part in rough.parts]
        return Perturbed(assembly=with_parts(assembly, parts), config=config)

    return degraded


def _missing(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
    graph = _graph(assembly, config, 1.0)
    touching = [index for index, edge in enumerate(graph.edges) if not edge.bridge]
    gone = set(rng.permutation(touching)[:MISSING].tolist())
    edges = tuple(edge for index, edge in enumerate(graph.edges) if index not in gone)
    return Perturbed(assembly=assembly, config=config, graph=replace(graph, edges=edges))


def _spurious(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
    graph = _graph(assembly, config, 1.0)
    wide = _graph(assembly, config, _REACH)
    others = [edge for edge in wide.edges if (edge.a, edge.b) not in graph.by_pair and not edge.bridge]
    chosen = [others[index] for index in rng.permutation(len(others))[:SPURIOUS].tolist()]
    told = [replace(edge, gap=0.0, bridge=False) for edge in chosen]
    edges = tuple(sorted((*graph.edges, *told), key=lambda edge: (edge.a, edge.b)))
    return Perturbed(assembly=assembly, config=config, graph=replace(graph, edges=edges))


def _split(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
    """One part is cut along the edges of its mesh, across its longest direction."""
    able = [index for index, part in enumerate(assembly.parts) if len(part.faces) >= 8]
    if not able:
        return Perturbed(assembly=assembly, config=config)
    chosen = int(rng.choice(able))
    part = assembly.parts[chosen]
    centres = part.vertices[part.faces].mean(axis=1)
    along = int(np.argmax(np.ptp(part.bounds, axis=0)))
    side = centres[:, along] > np.median(centres[:, along])
    if side.all() or not side.any():
        return Perturbed(assembly=assembly, config=config)
    return _in_pieces(assembly, config, chosen, [replace(part, faces=part.faces[half]) for half in (~side, side)])


def _cut(count: int) -> Callable[[Assembly, Config, Generator], Perturbed]:
    """One part is cut by planes across its longest direction, tilted a little, at places that keep all pieces large."""

    def cut(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
        chosen = int(rng.integers(len(assembly.parts)))
        part = assembly.parts[chosen]
        direction = np.eye(3)[int(np.argmax(np.ptp(part.bounds, axis=0)))] + np.tan(_TILT) * rng.uniform(-1, 1, size=3)
        direction /= np.linalg.norm(direction)
        low, high = np.quantile(part.vertices[part.faces].mean(axis=1) @ direction, [0.02, 0.98])
        shares = (np.arange(1, count) + rng.uniform(-0.2, 0.2, size=count - 1)) / count
        bands = cut_in_bands(part, direction, (low + shares * (high - low)).tolist())
        pieces = [piece for piece in bands if piece.area > 1e-3 * part.area]
        if len(pieces) < count:
            return Perturbed(assembly=assembly, config=config)
        return _in_pieces(assembly, config, chosen, pieces)

    return cut


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


def _in_pieces(assembly: Assembly, config: Config, chosen: int, pieces: Sequence[Part]) -> Perturbed:
    """The assembly with one part in pieces; the largest one keeps its name."""
    name = assembly.parts[chosen].name
    first, *others = sorted(pieces, key=lambda piece: -piece.area)
    named = [replace(piece, name=f"{name}{_MARK}{number}") for number, piece in enumerate(others, start=1)]
    parts = list(assembly.parts)
    parts[chosen] = first
    return Perturbed(
        assembly=with_parts(assembly, [*parts, *named]), config=config, pieces={piece.name: name for piece in named}
    )


PERTURBATIONS = (
    "tolerance-half",
    "tolerance-double",
    "noise",
    "contacts-missing",
    "contacts-spurious",
    "split",
    "gaps",
)
"""Faulty input that the refinement is measured on; `CLEAN` left out."""
OVER_SEGMENTED = ("cut-2", "cut-3")
DEGRADED = (*DEGRADATIONS, *OVER_SEGMENTED)
"""Rough input that the inference is measured on; `CLEAN` left out."""
_HOW: dict[str, Callable[[Assembly, Config, Generator], Perturbed]] = {
    CLEAN: _clean,
    "tolerance-half": _tolerance(0.5),
    "tolerance-double": _tolerance(2.0),
    "noise": _noise,
    "contacts-missing": _missing,
    "contacts-spurious": _spurious,
    "split": _split,
    "cut-2": _cut(2),
    "cut-3": _cut(3),
    **{name: _mesh(degrade) for name, degrade in DEGRADATIONS.items()},
}


def _graph(assembly: Assembly, config: Config, factor: float) -> ContactGraph:
    contact = config.contact.model_copy(update={"tolerance": factor * config.contact.tolerance})
    surfaces = part_surfaces(assembly, config=config.surface)
    return build_contact_graph(assembly, surfaces, config=contact, seed=config.seed)
