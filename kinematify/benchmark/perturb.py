"""Input that is a little wrong, as real input is: what the refinement has to mend.

Every perturbation is seeded and touches the parts, the contact graph or the tolerance alone, so that the truth stays
what it was. A part that was cut in two is scored as one where the answer fixes the pieces to each other.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.part import Assembly, Part
from kinematify.benchmark.prediction import Prediction
from kinematify.contact.build import build_contact_graph
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.candidate import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.random import Generator

    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph

CLEAN = "clean"
NOISE = 0.02
"""Vertices are moved by up to this share of the smallest side of their part's box."""
GAP = 0.01
"""Gap that opens between touching parts, fraction of the object's diagonal."""
MISSING, SPURIOUS = 2, 3
"""Contacts that are left out, and that are made up."""
_REACH = 10.0  # contacts are made up between parts up to this multiple of the tolerance apart, nearest ones if none is
_MARK = "_piece"


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
        name: One of `PERTURBATIONS`.
        assembly: The parts as they are.
        config: Of the inference.
        seed: Draws what is perturbed.
    """
    return _HOW[name](assembly, config, np.random.default_rng([seed, len(assembly.parts)]))


def without_pieces(prediction: Prediction, pieces: Mapping[int, int]) -> Prediction:
    """A prediction in which pieces that are fixed to what they were cut from are one part with it again.

    Args:
        prediction: Over all parts.
        pieces: Index of a piece -> that of the part that it was cut from.
    """
    parents, joints = dict(prediction.parents), list(prediction.joints)
    for piece, main in pieces.items():
        fixed = {joint.child for joint in joints if joint.kind == JointType.FIXED}
        if parents[piece] == main and piece in fixed:
            gone = piece
        elif parents[main] == piece and main in fixed:
            gone = main
            parents[main] = parents[piece]
            joints = [item for item in joints if item.child != main]
            joints = [replace(item, child=main) if item.child == piece else item for item in joints]
        else:
            continue
        parents = {part: main if above == piece else above for part, above in parents.items() if part != piece}
        joints = [replace(item, parent=main) if item.parent == piece else item for item in joints]
        joints = [item for item in joints if not (gone == piece and item.child == piece)]
    return Prediction(parents=parents, joints=tuple(joints))


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

    return Perturbed(assembly=_with(assembly, [shaken(part) for part in assembly.parts]), config=config)


def _gaps(assembly: Assembly, config: Config, rng: Generator) -> Perturbed:
    """Every part shrinks about the middle of its box by half a gap on each side, but to no less than half."""

    def shrunk(part: Part) -> Part:
        middle, sides = part.bounds.mean(axis=0), np.ptp(part.bounds, axis=0)
        factors = np.maximum(1.0 - GAP * assembly.diagonal / np.maximum(sides, 1e-12), 0.5)
        return replace(part, vertices=middle + factors * (part.vertices - middle))

    return Perturbed(assembly=_with(assembly, [shrunk(part) for part in assembly.parts]), config=config)


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
    piece = Part(name=f"{part.name}{_MARK}", vertices=part.vertices, faces=part.faces[side])
    parts = [replace(item, faces=item.faces[~side]) if item is part else item for item in assembly.parts]
    return Perturbed(assembly=_with(assembly, [*parts, piece]), config=config, pieces={piece.name: part.name})


PERTURBATIONS = (
    "tolerance-half",
    "tolerance-double",
    "noise",
    "contacts-missing",
    "contacts-spurious",
    "split",
    "gaps",
)
"""Names, `CLEAN` left out."""
_HOW: dict[str, Callable[[Assembly, Config, Generator], Perturbed]] = {
    CLEAN: _clean,
    "tolerance-half": _tolerance(0.5),
    "tolerance-double": _tolerance(2.0),
    "noise": _noise,
    "contacts-missing": _missing,
    "contacts-spurious": _spurious,
    "split": _split,
    "gaps": _gaps,
}


def _with(assembly: Assembly, parts: list[Part]) -> Assembly:
    return Assembly(parts=tuple(parts), source=assembly.source)


def _graph(assembly: Assembly, config: Config, factor: float) -> ContactGraph:
    contact = config.contact.model_copy(update={"tolerance": factor * config.contact.tolerance})
    surfaces = part_surfaces(assembly, config=config.surface)
    return build_contact_graph(assembly, surfaces, config=contact, seed=config.seed)
