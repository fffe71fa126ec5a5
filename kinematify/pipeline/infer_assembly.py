"""infer(): segmented meshes become ranked kinematic trees with joints (paper, Algorithm 1)."""

from __future__ import annotations

import resource
import sys
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from kinematify.assembly.load import load_assembly
from kinematify.assembly.part import Assembly
from kinematify.config import load_config
from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.seams import find_cuts, joined, rigid_pieces
from kinematify.errors import InputError
from kinematify.geometry.surface import part_surfaces
from kinematify.grouping.groups import Grouping, confidence_of, fixed_merged, group_pieces, unsure, with_doubtful
from kinematify.joints.bearings.bearing_fit import fit_bearings
from kinematify.pipeline.heading import principal_heading, rotated, with_heading
from kinematify.pipeline.inference import Inference
from kinematify.pipeline.piece_report import inference_of_pieces, piece_standing_for
from kinematify.pipeline.stages import choose_joints, find_trees, with_doubt_of_parents
from kinematify.pipeline.warnings import warnings_of
from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointEstimate

    Progress = Callable[[str, float], None]


class StageClock:
    """Times the stages and tells who waits."""

    def __init__(self, progress: Progress | None) -> None:
        """Start with no stage.

        Args:
            progress: Called with the name of each stage and the share of the work done before it, in [0, 1].
        """
        self.progress = progress or (lambda stage, share: None)
        self.seconds: dict[str, float] = {}
        """Wall time of every stage that has ended [s]."""

    @contextmanager
    def stage(self, name: str, share: float) -> Iterator[None]:
        """Time what is done inside; `share` of all work is done before it."""
        self.progress(name, share)
        start = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - start


def peak_mb() -> float:
    """Peak resident memory of the process so far [MB]."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1024 * 1024 if sys.platform == "darwin" else 1024)


def infer(
    assembly: Assembly | Grouping | str | Path,
    *,
    config: Config | None = None,
    base: str | None = None,
    graph: ContactGraph | None = None,
    progress: Progress | None = None,
) -> Inference:
    """Infer the kinematic tree and all joints of an assembly (paper, Algorithm 1).

    Pieces of a mesh that is not segmented become rigid parts first (`kinematify.grouping`).

    Args:
        assembly: Rigid parts in one configuration, world frame, z up, metres, or pieces of a mesh or their grouping;
            or the file or folder that `kinematify.load_assembly` reads them from, whose arguments say what is up and
            how long the unit is.
        config: All stages, the default ones if absent; `config.seed` makes the answer reproducible.
        base: Name of the part that is the base link, where it is known.
        graph: The contacts, where they are known already.
        progress: Called with the name of each stage and the share of the work done before it, in [0, 1].

    Raises:
        InputError: `base` is no part of the assembly.
        AssemblyError: The file or folder cannot become an assembly.
    """
    config = config or load_config()
    if isinstance(assembly, str | Path):
        assembly = load_assembly(assembly, config=config.assembly)
    clock = StageClock(progress)
    if isinstance(assembly, Assembly) and not assembly.segmented:
        with clock.stage("groups", 0.0):
            assembly = group_pieces(assembly, config.grouping)
    if isinstance(assembly, Grouping):
        found = infer(assembly.assembly, config=config, base=base, graph=graph, progress=progress)
        if base is None and graph is None:
            assembly, found = _with_doubtful_pieces(assembly, found, config, progress)
        merged = fixed_merged(assembly, found.joints, config.grouping)
        if merged is not assembly and (base is None or base in merged.assembly.names):
            return infer(merged, config=config, base=base, progress=progress)
        seconds = MappingProxyType({**clock.seconds, **found.timings})
        warnings = (*assembly.messages, *unsure(assembly, found.joints, config.grouping), *found.warnings)
        joints = tuple(_with_doubt_of_group(joint, assembly.groups[joint.child].moves) for joint in found.joints)
        return replace(found, grouping=assembly, joints=joints, timings=seconds, warnings=warnings)
    if base is not None and base not in assembly.names:
        raise InputError(f"There is no part {base} to be the base link. The parts are {', '.join(assembly.names)}.")
    angle = principal_heading(assembly) if graph is None and config.joints.method == "geometry" else 0.0
    if angle != 0.0:
        return with_heading(infer_rigid_parts(rotated(assembly, -angle), config, base, None, clock), assembly, angle)
    return infer_rigid_parts(assembly, config, base, graph, clock)


def _with_doubt_of_group(joint: JointEstimate, likely: float | None) -> JointEstimate:
    """The joint with less confidence where its part may be no moving part."""
    if likely is None or joint.kind is JointType.FIXED:
        return joint
    evidence = {**joint.evidence, "group_likely": likely}
    return replace(joint, confidence=joint.confidence * likely, evidence=evidence)


def infer_rigid_parts(
    assembly: Assembly, config: Config, base: str | None, graph: ContactGraph | None, clock: StageClock
) -> Inference:
    """Return what `infer` returns of rigid parts whose walls stand along the axes of the world, as far as they can."""
    with clock.stage("contacts", 0.0):
        surfaces = part_surfaces(assembly, config=config.surface)
        cuts = find_cuts(assembly, surfaces, config.seam) if graph is None and config.seam.join else {}
        pieces = rigid_pieces(len(assembly.parts), cuts)
        if graph is None:
            graph = build_contact_graph(assembly, surfaces, config=config.contact, seed=config.seed)
    if 1 < len(pieces) < len(assembly.parts):
        main = piece_standing_for(base, assembly, pieces)
        whole = infer_rigid_parts(joined(assembly, pieces), config, main, None, StageClock(clock.progress))
        return inference_of_pieces(whole, assembly, graph, pieces, clock.seconds)
    bearings: dict[Pair, EdgeBearing] = {}
    if config.joints.method == "geometry":
        with clock.stage("bearings", 0.2):
            bearings = fit_bearings(assembly, surfaces, graph, config=config.bearing, seed=config.seed)
    with clock.stage("tree", 0.6):
        root = None if base is None else assembly.names.index(base)
        trees = find_trees(assembly, graph, bearings, config, base=root)
    with clock.stage("joints", 0.7):
        joints = choose_joints(assembly, graph, trees[0], bearings, config)
        joints = with_doubt_of_parents(joints, trees[0])
    clock.progress("done", 1.0)
    return Inference(
        assembly=assembly,
        config=config,
        graph=graph,
        bearings=MappingProxyType(bearings),
        trees=trees,
        joints=joints,
        timings=MappingProxyType(clock.seconds),
        peak_mb=peak_mb(),
        warnings=warnings_of(assembly, graph, bearings, trees, joints, config=config),
    )


def _with_doubtful_pieces(
    grouping: Grouping, found: Inference, config: Config, progress: Progress | None
) -> tuple[Grouping, Inference]:
    """Groups whose joints are surer with their doubtful pieces have them, if all joints together are surer then."""
    everything = [number for number, _ in grouping.doubtful]
    if not everything:
        return grouping, found
    before = confidence_of(found.joints, config.grouping)
    fuller = infer(with_doubtful(grouping, everything).assembly, config=config, progress=progress)
    after = confidence_of(fuller.joints, config.grouping)
    chosen = [number for number in everything if after.get(number, 0.0) > before.get(number, 0.0)]
    if not chosen:
        return grouping, found
    tried = with_doubtful(grouping, chosen)
    if chosen != everything:
        fuller = infer(tried.assembly, config=config, progress=progress)
    better = sum(confidence_of(fuller.joints, config.grouping).values()) > sum(before.values())
    return (tried, fuller) if better else (grouping, found)
