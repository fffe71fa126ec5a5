"""The bodies of a model at rest, and what is derived from them once: surfaces, contacts, bearings, declared tree."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from kinematify.assembly.assemble import simplified
from kinematify.assembly.erasure import erase
from kinematify.assembly.part import Assembly
from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.tree import KinematicTree
from kinematify.geometry.part_stats import assembly_stats
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_edge, score_line
from kinematify.joints.choice.edges import edge_qualities
from kinematify.joints.features.pins import find_pins
from kinematify.robot.robot import forward_kinematics, rest_configuration

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.truth import GroundTruth
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph
    from kinematify.geometry.surface import PartSurface
    from kinematify.joints.bearings.line import Line
    from kinematify.joints.bearings.scores import BearingLine, EdgeBearing
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

Pair = tuple[int, int]
"""Two bodies, the lower index first."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bodies:
    """A model in its rest configuration; links that fixed joints hold together are one body."""

    assembly: Assembly
    truth: GroundTruth
    """The declared joints between the bodies, world frame at rest."""
    links: tuple[str, ...]
    """First link with geometry of every body."""
    joint_frames: Mapping[str, FloatArray]
    """Frame of the axis of each joint, world frame at rest, shape (4, 4)."""
    tree: KinematicTree
    """Which body carries which, as the file says; body i is part i of the assembly."""
    surfaces: Sequence[PartSurface]
    graph: ContactGraph
    bearings: Mapping[Pair, EdgeBearing]
    config: Config

    @property
    def diagonal(self) -> float:
        """Diagonal of the model [m]."""
        return self.assembly.diagonal

    @cached_property
    def qualities(self) -> Mapping[Pair, float]:
        """Return how good each contact is for the tree, in [0, 1] (`joints.choice.edges`)."""
        pins = find_pins(self.assembly, self.graph, self.bearings, self.config)
        return edge_qualities(self.graph, assembly_stats(self.assembly), self.bearings, pins)

    def score_line(self, pair: Pair, line: Line) -> BearingLine:
        """Return how well the contact of two bodies, which must touch, turns into itself about a line."""
        edge = self.graph.by_pair[pair]
        return score_line(self.surfaces, edge, line, diagonal=self.diagonal, config=self.config.bearing)


def read_bodies(robot: Robot, config: Config, *, seed: int) -> Bodies | None:
    """Pose the bodies at rest and find their contacts; None where fewer than two bodies have geometry.

    Args:
        robot: Links, meshes and joints as declared.
        config: How evidence is gathered.
        seed: Seed of all samples.
    """
    if not any(link.has_geometry for link in robot.links):
        return None
    erased = erase(robot, shuffle=False)
    poses = forward_kinematics(robot, rest_configuration(robot))
    if len(erased.parts) < 2 or -1 in (joint.parent for joint in erased.truth.joints):
        return None
    most = config.assembly.max_part_faces
    parts = [part if len(part.faces) <= most else simplified(part, config.assembly) for part in erased.parts]
    assembly = Assembly(parts=tuple(parts), source=robot.name)
    surfaces = part_surfaces(assembly, config=config.surface)
    graph = build_contact_graph(assembly, surfaces, config=config.contact, seed=seed)
    bearings = {
        pair: fit_edge(surfaces, edge, diagonal=assembly.diagonal, config=config.bearing, seed=seed)
        for pair, edge in graph.by_pair.items()
    }
    return Bodies(
        assembly=assembly,
        truth=erased.truth,
        links=tuple(
            next(link for link in links if robot.link_by_name[link].has_geometry) for links in erased.truth.part_links
        ),
        joint_frames={joint.name: poses[joint.parent] @ joint.T_parent_child for joint in robot.joints},
        tree=KinematicTree(parents=erased.truth.parents),
        surfaces=surfaces,
        graph=graph,
        bearings=bearings,
        config=config,
    )
