"""infer(): segmented meshes become ranked kinematic trees with joints (paper, Algorithm 1)."""

from __future__ import annotations

import math
import resource
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from kinematify.config import load_config
from kinematify.contact.build import build_contact_graph
from kinematify.contact.seams import find_cuts, joined, largest_piece, rigid_pieces
from kinematify.errors import InputError
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.choice.compound import compounds, described
from kinematify.joints.choice.decide import estimate_joints
from kinematify.joints.hypotheses.bearing import fit_bearings
from kinematify.joints.measure.edge_tests import journal_pairs, leaf_pairs, passing_pairs
from kinematify.joints.measure.quality import edge_quality
from kinematify.joints.measure.workspace import PartCache
from kinematify.model.build import build_model
from kinematify.pipeline.pieces import joints_of_pieces, pair_of_pieces, tree_of_pieces
from kinematify.topology.evidence import EdgeEvidence, coaxial_carriers
from kinematify.topology.quality import on_cycles
from kinematify.topology.search import search_trees
from kinematify.topology.stats import assembly_stats

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph
    from kinematify.joints.candidate import JointEstimate
    from kinematify.joints.hypotheses.bearing_line import BearingLine, EdgeBearing
    from kinematify.model.kinematic_model import KinematicModel
    from kinematify.pipeline.pieces import Groups
    from kinematify.topology.evidence import Pair
    from kinematify.topology.tree import KinematicTree

    Progress = Callable[[str, float], None]


@dataclass(frozen=True, kw_only=True, eq=False)
class Inference:
    """Everything that was inferred, with every alternative that was kept."""

    assembly: Assembly
    config: Config
    graph: ContactGraph
    bearings: Mapping[Pair, EdgeBearing]
    """Bearing lines of every contact edge, keyed (a, b) with a < b; empty where the method fits none."""
    trees: tuple[KinematicTree, ...]
    """Best first; `joints` belong to the first."""
    joints: tuple[JointEstimate, ...]
    """One per edge of `trees[0]`, in the order of `trees[0].edges()`."""
    timings: Mapping[str, float]
    """Wall time of every stage [s]."""
    peak_mb: float
    """Peak resident memory of the process so far [MB]."""
    warnings: tuple[str, ...] = field(default=())
    """What the user should know, one sentence each; those of the assembly included."""
    refinement: Mapping[str, Any] | None = None
    """Rounds of simulation and choosing again (`kinematify.refine`), as JSON values; None where there were none."""
    provenance: Mapping[str, Any] | None = None
    """Who made the parts, from what (`kinematify.generate.providers`), as JSON values; None where that is not known."""

    @cached_property
    def model(self) -> KinematicModel:
        """The kinematic model of the best tree."""
        return build_model(
            self.assembly, self.trees[0], self.joints, name=_model_name(self.assembly.source), config=self.config.model
        )


def infer(
    assembly: Assembly,
    *,
    config: Config | None = None,
    base: str | None = None,
    graph: ContactGraph | None = None,
    progress: Progress | None = None,
) -> Inference:
    """Infer the kinematic tree and all joints of an assembly (paper, Algorithm 1).

    Args:
        assembly: Rigid parts in one configuration, world frame, z up, metres.
        config: All stages, the default ones if absent; `config.seed` makes the answer reproducible.
        base: Name of the part that is the base link, where it is known.
        graph: The contacts, where they are known already.
        progress: Called with the name of each stage and the share of the work done before it, in [0, 1].

    Raises:
        InputError: `base` is no part of the assembly.
    """
    config = config or load_config()
    clock = _StageClock(progress or (lambda stage, share: None))
    root = _base_index(assembly, base)
    with clock.stage("contacts", 0.0):
        surfaces = part_surfaces(assembly, config=config.surface)
        cuts = find_cuts(assembly, surfaces, config.seam) if graph is None else {}
        groups = rigid_pieces(len(assembly.parts), cuts)
        if graph is None:
            graph = build_contact_graph(assembly, surfaces, config=config.contact, seed=config.seed)
    if 1 < len(groups) < len(assembly.parts):
        return _inferred_joined(assembly, graph, groups, base=root, config=config, clock=clock)
    bearings: dict[Pair, EdgeBearing] = {}
    if config.joints.method == "geometry":
        with clock.stage("bearings", 0.2):
            bearings = fit_bearings(assembly, surfaces, graph, config=config.bearing, seed=config.seed)
    with clock.stage("tree", 0.6):
        evidence = gather_evidence(assembly, graph, bearings, config)
        trees = search_trees(graph, assembly_stats(assembly), evidence, config.topology, seed=config.seed, base=root)
    with clock.stage("joints", 0.7):
        joints = choose_joints(assembly, graph, trees[0], bearings, config)
        joints = _with_doubt_of_parents(joints, trees, config.joints.confidence.parent_margin)
    clock.progress("done", 1.0)
    return Inference(
        assembly=assembly,
        config=config,
        graph=graph,
        bearings=MappingProxyType(bearings),
        trees=trees,
        joints=joints,
        timings=MappingProxyType(clock.seconds),
        peak_mb=_peak_mb(),
        warnings=(
            *assembly.warnings,
            *_doubtful_base(assembly, trees, config.topology.base_doubt),
            *_floating_parts(assembly, graph, trees[0]),
            *_compound_joints(assembly, joints, graph, config),
            *_followed_twins(assembly, joints, bearings),
        ),
    )


def _inferred_joined(
    assembly: Assembly,
    graph: ContactGraph,
    groups: Groups,
    *,
    base: int | None,
    config: Config,
    clock: _StageClock,
) -> Inference:
    """Infer with the pieces of every part that was cut as one, and fix them to each other in the answer."""
    mains = [largest_piece(assembly, group) for group in groups]
    named = next((assembly.names[main] for main, group in zip(mains, groups, strict=True) if base in group), None)
    whole = infer(joined(assembly, groups), config=config, base=named, progress=clock.progress)
    trees = tuple(tree_of_pieces(tree, groups, mains) for tree in whole.trees)
    bearings = {pair_of_pieces(pair, mains): bearing for pair, bearing in whole.bearings.items()}
    known = {pair: bearing for pair, bearing in bearings.items() if pair in graph.by_pair}
    return replace(
        whole,
        assembly=assembly,
        graph=graph,
        bearings=MappingProxyType(known),
        trees=trees,
        joints=joints_of_pieces(assembly, trees[0], whole.joints, groups, mains),
        timings=MappingProxyType({name: clock.seconds.get(name, 0.0) + t for name, t in whole.timings.items()}),
        warnings=(*assembly.warnings, *whole.warnings, *_cut_parts(assembly, groups, mains)),
    )


def _cut_parts(assembly: Assembly, groups: Groups, mains: Sequence[int]) -> list[str]:
    """Tell of parts that were cut into pieces."""
    warnings = []
    for main, group in zip(mains, groups, strict=True):
        others = [assembly.names[piece] for piece in group if piece != main]
        if others:
            warnings.append(
                f"{' and '.join(others)} and {assembly.names[main]} are one part that was cut apart: their open rims "
                "coincide, and the surface goes on. They are fixed to each other."
            )
    return warnings


def gather_evidence(
    assembly: Assembly, graph: ContactGraph, bearings: Mapping[Pair, EdgeBearing], config: Config
) -> dict[Pair, EdgeEvidence]:
    """What the tree search needs to know of each contact edge: quality and line of its best joint, and what holds it.

    Costly questions are asked only of edges whose answer the search needs: those that others could replace and that
    have no clear bearing or join congruent parts, and those between parts that a third one bears on the same line.
    """
    lines = {pair: bearing.lines[0] for pair, bearing in bearings.items() if bearing.lines}
    evidence = {
        pair: EdgeEvidence(
            quality=edge_quality(edge, bearings.get(pair), config.quality),
            axis=lines[pair].axis if pair in lines else None,
            point=lines[pair].pivot if pair in lines else None,
        )
        for pair, edge in graph.by_pair.items()
    }
    topology = config.topology
    bounds = {"angle": topology.stack_deg, "distance": topology.stack_distance * assembly.diagonal}
    carriers = coaxial_carriers(evidence, **bounds)
    contested = [pair for pair in on_cycles(graph.by_pair, graph.n_parts) if pair in lines]
    doubtful = [
        pair for pair in contested if evidence[pair].quality < topology.journal_quality or _are_twins(graph, pair)
    ]
    cache = PartCache(assembly, graph, samples=config.joints.samples, seed=config.seed)
    journals = journal_pairs(cache, doubtful, config.joints)
    passing = passing_pairs(cache, {pair: lines[pair] for pair in carriers}, config.joints)
    triples = sorted({tuple(sorted((a, b, c))) for (a, b), found in carriers.items() for c in found})
    adjacent, skipping = leaf_pairs(cache, triples, lines, passing, config.joints)
    return {
        pair: replace(
            item,
            has_journal=pair in journals,
            passing=pair in passing,
            is_adjacent_leaf=pair in adjacent,
            skips_leaf=pair in skipping,
        )
        for pair, item in evidence.items()
    }


def _are_twins(graph: ContactGraph, pair: Pair) -> bool:
    first, second = (graph.cluster_of[part] for part in pair)
    return first >= 0 and first == second


def choose_joints(
    assembly: Assembly,
    graph: ContactGraph,
    tree: KinematicTree,
    bearings: Mapping[Pair, EdgeBearing],
    config: Config,
) -> tuple[JointEstimate, ...]:
    """The joint of every edge of a tree, in the order of `tree.edges()`, by the method of the configuration."""
    if config.joints.method == "geometry":
        return estimate_joints(assembly, graph, tree, bearings, config=config.joints, seed=config.seed)
    # torch takes seconds to import, and only this branch needs it.
    from kinematify.paper.joints import estimate_paper_joints  # noqa: PLC0415

    return estimate_paper_joints(assembly, graph, tuple(tree.edges()), config=config)


def _with_doubt_of_parents(
    joints: Sequence[JointEstimate], trees: Sequence[KinematicTree], margin: float
) -> tuple[JointEstimate, ...]:
    """Joints with less confidence where trees that are nearly as good hang the part on another one."""
    best = trees[0]
    found = []
    for joint in joints:
        rivals: dict[int, float] = {}
        for tree in trees[1:]:
            above = tree.parents[joint.child]
            if above != joint.parent:
                rivals[above] = max(rivals.get(above, -math.inf), tree.reward)
        right = 1.0 / (1.0 + sum(math.exp((reward - best.reward) / margin) for reward in rivals.values()))
        evidence = {**joint.evidence, "parent_likely": right}
        found.append(replace(joint, confidence=joint.confidence * right, evidence=evidence))
    return tuple(found)


class _StageClock:
    """Times the stages and tells who waits."""

    def __init__(self, progress: Progress) -> None:
        self.progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str, share: float) -> Iterator[None]:
        self.progress(name, share)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start


def _base_index(assembly: Assembly, base: str | None) -> int | None:
    if base is None:
        return None
    if base not in assembly.names:
        raise InputError(f"There is no part {base} to be the base link. The parts are {', '.join(assembly.names)}.")
    return assembly.names.index(base)


def _doubtful_base(assembly: Assembly, trees: Sequence[KinematicTree], doubt: float) -> list[str]:
    """Warn where another part would serve as base link nearly as well."""
    best = trees[0]
    rivals = [tree.root for tree in trees if tree.root != best.root and tree.reward >= best.reward - doubt]
    if not rivals:
        return []
    others = " or ".join(assembly.names[part] for part in dict.fromkeys(rivals))
    taken = assembly.names[best.root]
    said = f"Which part stands still is not clear: {taken} was taken, {others} would do nearly as well. "
    return [said + "Give --base to choose."]


def _compound_joints(
    assembly: Assembly, joints: Sequence[JointEstimate], graph: ContactGraph, config: Config
) -> list[str]:
    """Tell of joints that are one mechanism together."""
    found = compounds(assembly, joints, graph.clusters, config.joints.compound)
    return [described(compound, assembly.names) for compound in found]


def _followed_twins(
    assembly: Assembly, joints: Sequence[JointEstimate], bearings: Mapping[Pair, EdgeBearing]
) -> list[str]:
    """Tell which joints took their line from congruent ones."""
    said = []
    for joint in joints:
        a, b = min(joint.parent, joint.child), max(joint.parent, joint.child)
        bearing = bearings.get((a, b))
        if bearing is None or not bearing.follows or not _runs_along(joint, bearing.lines[0]):
            continue
        models = [f"{assembly.names[one]} and {assembly.names[other]}" for one, other in bearing.follows]
        own = f"{assembly.names[joint.parent]} and {assembly.names[joint.child]}"
        said.append(f"{own} turn as their congruent twins do ({'; '.join(models)})")
    if not said:
        return []
    return [f"{'. '.join(said)}. By itself, the rough contact shows another line; what all twins show was taken."]


def _runs_along(joint: JointEstimate, line: BearingLine) -> bool:
    """Whether a joint has the direction of a line, to 1 deg."""
    return bool(abs(float(joint.axis @ line.axis)) > math.cos(math.radians(1.0)))


def _floating_parts(assembly: Assembly, graph: ContactGraph, tree: KinematicTree) -> list[str]:
    """Warn of tree edges between parts that do not touch."""
    warnings = []
    for parent, child in tree.edges():
        pair = (min(parent, child), max(parent, child))
        edge = graph.by_pair.get(pair)
        if edge is None or edge.bridge:
            gap = "" if edge is None else f" ({edge.gap / assembly.diagonal:.2%} of the object's diagonal apart)"
            warnings.append(
                f"{assembly.names[child]} touches nothing; it hangs on {assembly.names[parent]}, the nearest part{gap}."
            )
    return warnings


def _model_name(source: str) -> str:
    stem = source.replace("\\", "/").rstrip("/").rsplit("/", 1)[-1].split(".")[0]
    return "".join(letter if letter.isascii() and letter.isalnum() else "_" for letter in stem) or "model"


def _peak_mb() -> float:
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024 * 1024 if sys.platform == "darwin" else 1024)
