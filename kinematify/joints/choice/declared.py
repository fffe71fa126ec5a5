"""Declared joints beside all that the inference would weigh in their place, in one pass.

Candidates are those of the inference, with the same columns, and its fitted choice judges them, without names; the
declared joint stands among them, and its parent among all bodies that the child touches.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.build_graph import build_contact_graph
from kinematify.contact.graph import pair
from kinematify.geometry.part_stats import assembly_stats
from kinematify.geometry.surface import part_surfaces
from kinematify.joints.bearings.bearing_fit import fit_edge, score_line
from kinematify.joints.bearings.line import Line
from kinematify.joints.candidate import FIXED, SLIDE, TURN
from kinematify.joints.choice.edges import edge_qualities
from kinematify.joints.choice.judge import judge as judge_edge
from kinematify.joints.features.columns import features_of
from kinematify.joints.features.edge_scene import TreeScenes
from kinematify.joints.features.pins import find_pins
from kinematify.joints.features.workspace import PartCache
from kinematify.joints.hypotheses.propose import propose
from kinematify.robot.joint_type import JointType
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Assembly
    from kinematify.assembly.truth import TrueJoint
    from kinematify.config import Config
    from kinematify.config.validation import EvidenceSettings
    from kinematify.contact.graph import Pair
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import Hypotheses
    from kinematify.joints.choice.judge import Posterior
    from kinematify.joints.features.columns import Features
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.robot.arrays import BoolArray, FloatArray


_RIVALS = 8  # of each type; what cues rank lower is never the joint that is named instead
_BALL = 0.08  # spread of the radii; a sphere of 20 triangles has 0.07, a cube 0.16


class JudgedAssembly:
    """Parts in a declared tree, and what is derived from them once for all joints."""

    def __init__(self, assembly: Assembly, tree: KinematicTree, config: Config, seed: int) -> None:
        """Find contacts and bearings; arguments as in `judge`."""
        self.assembly, self.tree, self.config = assembly, tree, config
        self.surfaces = part_surfaces(assembly, config=config.surface)
        self.graph = build_contact_graph(assembly, self.surfaces, config=config.contact, seed=seed)
        self.bearings = config.bearing.in_metres(assembly.diagonal)
        self.bearing = cache(partial(self._fitted, seed=seed))
        """Bearing lines of two parts, the lower index first; None where they do not touch."""
        self.cache = PartCache(assembly, self.graph, samples=config.joints.samples, seed=seed)
        self.scenes = TreeScenes(self.cache, tree, config.joints)

    def _fitted(self, pair: Pair, seed: int) -> EdgeBearing | None:
        edge = self.graph.by_pair.get(pair)
        return None if edge is None else fit_edge(self.surfaces, edge, config=self.bearings, seed=seed)

    @cached_property
    def qualities(self) -> Mapping[Pair, float]:
        """Return how good each contact is for the tree, in [0, 1] (`joints.choice.edges`)."""
        bearings = {pair: found for pair in self.graph.by_pair if (found := self.bearing(pair)) is not None}
        stats = assembly_stats(self.assembly)
        pins = find_pins(self.assembly, self.graph, stats, bearings, self.config)
        return edge_qualities(self.graph, stats, bearings, pins)


@dataclass(frozen=True, kw_only=True, eq=False)
class ParentEvidence:
    """Evidence of the parent: how the child hangs on its declared parent, beside the other bodies that it touches."""

    touches: bool
    """The declared parent touches the child."""
    quality: float
    """How good their contact is for the tree, in [0, 1]; 0 where they do not touch, or the child touches no other."""
    best: int | None
    """Body with the best contact, without the declared parent and what the child carries; None if there is none."""
    best_quality: float


@dataclass(frozen=True, kw_only=True, eq=False)
class JudgedJoint:
    """Everything that is measured of one declared joint, each when it is first asked for."""

    joint: TrueJoint
    """As declared, in the world frame at rest."""
    whole: JudgedAssembly
    settings: EvidenceSettings

    @property
    def size(self) -> float:
        """Diagonal of the child [m]."""
        return self.whole.scenes.frames[self.joint.child].diagonal

    @cached_property
    def scene(self) -> JointScene:
        """The two bodies."""
        edge = self.joint.parent, self.joint.child
        return self.whole.scenes.scene(edge, self.whole.bearing(pair(*edge)))

    @cached_property
    def proposed(self) -> Hypotheses:
        """Candidates that the inference would weigh, and the declared line."""
        return propose(self.scene, (self._line,))

    @property
    def _line(self) -> Line:
        return Line(axis=self.joint.axis, point=self.joint.pivot)

    @cached_property
    def features(self) -> Features:
        """What is measured of the candidates, which takes most of the time."""
        return features_of(self.scene, self.proposed, _RIVALS)

    @cached_property
    def posterior(self) -> Posterior:
        """How likely each candidate is, by geometry alone."""
        confidence = self.scene.config.confidence
        return judge_edge(self.features, confidence.model_copy(update={"cues_lead": 0.0, "name_weight": 0.0}))

    @cached_property
    def parent(self) -> ParentEvidence:
        """How it hangs on its parent."""
        joint, whole = self.joint, self.whole
        own = (*whole.tree.subtree(joint.child), joint.parent)
        others = [body for body in whole.graph.neighbours[joint.child] if body not in own]
        best = max(others, key=self._quality, default=None)
        return ParentEvidence(
            touches=self._touches(joint.parent),
            quality=self._quality(joint.parent) if others else 0.0,  # qualities take a tenth of the stage
            best=best,
            best_quality=0.0 if best is None else self._quality(best),
        )

    def _touches(self, body: int) -> bool:
        edge = self.whole.graph.by_pair.get(pair(self.joint.child, body))
        return edge is not None and not edge.bridge

    def _quality(self, body: int) -> float:
        return self.whole.qualities[pair(self.joint.child, body)] if self._touches(body) else 0.0

    @property
    def bearing(self) -> float:
        """Score of the best bearing line of the contact; 0 without one."""
        return self.scene.fitted.best_score if self.scene.fitted else 0.0

    @cached_property
    def own_bearing(self) -> float:
        """Score of the declared line as a bearing; 0 where there is no other to compare it with."""
        if self.bearing <= self.settings.bearing_score:
            return 0.0
        whole, edge = self.whole, self.whole.graph.by_pair[pair(self.joint.parent, self.joint.child)]
        return score_line(whole.surfaces, edge, self._line, whole.bearings).score

    @property
    def slides(self) -> bool:
        """The joint is declared prismatic."""
        return self.joint.kind is JointType.PRISMATIC

    @property
    def _kind(self) -> int:
        return SLIDE if self.slides else TURN

    @property
    def odds_against(self) -> float:
        """Log odds of the other type against the declared one."""
        return -self.posterior.odds_prismatic if self.slides else self.posterior.odds_prismatic

    @property
    def best_other(self) -> int:
        """Position of the best candidate of the other type."""
        return self._best(TURN if self.slides else SLIDE)

    @property
    def alone(self) -> bool:
        """It is the only joint between the two bodies; others share one contact, which then tells of no single one."""
        return self.joint.chain_length == 1

    @cached_property
    def angle(self) -> float:
        """Smallest angle to a direction that the geometry of the two bodies shows, whatever the type [deg]; 0 of balls.

        A ball has no direction at all.
        """
        scene, every = self.scene, self.proposed
        radii = lengths_of(scene.samples.points - scene.samples.points.mean(axis=0))
        if radii.std() < _BALL * radii.mean():
            return 0.0
        shown = [every.axes[~every.given & (every.kinds != FIXED)], scene.frame.axes, scene.parent_frame.axes]
        shown += [line.axis[None] for line in scene.lines]
        shown += [] if scene.rail is None else [scene.rail.axis[None]]
        return float(_angles(self.joint.axis, np.concatenate(shown)).min())

    @cached_property
    def distance(self) -> float:
        """Distance to the nearest known line of nearly the same direction, fraction of the child's diagonal, or inf."""
        every = self.proposed
        return float(self._away(every)[self._near(every) & ~every.given].min(initial=np.inf))

    def _near(self, every: Hypotheses) -> BoolArray:
        """Which candidates are of the declared type and along nearly the declared direction, shape (h,)."""
        aligned = _angles(self.joint.axis, every.axes) < self.settings.same_deg
        return np.asarray((every.kinds == self._kind) & aligned)

    def _away(self, every: Hypotheses) -> FloatArray:
        """Distances of candidates from the declared line, fractions of the child's diagonal, shape (h,)."""
        beside = lengths_of(crossed(every.pivots - self.joint.pivot, self.joint.axis))
        return (not self.slides) * beside / self.size

    @cached_property
    def best(self) -> int:
        """Position of the best candidate of the declared type."""
        return self._best(self._kind)

    def _best(self, kind: int) -> int:
        """Position of the best candidate of a type that the file does not state."""
        every = self.posterior.hypotheses
        return int(np.argmax(np.where((every.kinds == kind) & ~every.given, self.posterior.scores, -np.inf)))

    @cached_property
    def deficit(self) -> float:
        """Score (`Posterior.scores`) of the best candidate of its type less that of the declared joint, at least 0."""
        every, scores = self.posterior.hypotheses, self.posterior.scores
        same = self._near(every) & (self._away(every) < self.settings.same_distance)
        own = float(scores[(every.kinds == self._kind) & (every.given | same)].max())
        return max(0.0, float(scores[self.best]) - own)

    @property
    def best_axis(self) -> FloatArray:
        """Of the best candidate of the declared type, shape (3,)."""
        return np.asarray(self.posterior.hypotheses.axes[self.best])

    @property
    def best_pivot(self) -> FloatArray:
        """World frame at rest [m], shape (3,)."""
        return np.asarray(self.posterior.hypotheses.pivots[self.best])

    @property
    def reach(self) -> float:
        """How far was swept [rad or m]."""
        config = self.scene.config
        return config.slides.sweep * self.scene.diagonal if self.slides else float(np.radians(config.panels.sweep_deg))

    @cached_property
    def free(self) -> tuple[float, float]:
        """Free motion along the declared joint against the parent, towards + and - [rad or m], at most `reach`."""
        every = self.features.hypotheses
        row = np.argmax(every.given & (every.kinds == self._kind))
        forward, backward = self.features.free_parent[row] * (self.scene.diagonal if self.slides else 1.0)
        return float(forward), float(backward)


def judge(
    assembly: Assembly,
    tree: KinematicTree,
    declared: Sequence[TrueJoint],
    config: Config,
    settings: EvidenceSettings,
    *,
    seed: int,
) -> list[JudgedJoint]:
    """Hold declared joints against what the inference would choose, in their order.

    Args:
        assembly: The parts, at rest.
        tree: Which part carries which, as declared.
        declared: Joints of its edges, world frame at rest.
        config: How evidence is gathered.
        settings: What counts as the same line.
        seed: Seed of all samples.
    """
    whole = JudgedAssembly(assembly, tree, config, seed)
    return [JudgedJoint(joint=joint, whole=whole, settings=settings) for joint in declared]


def _angles(axis: FloatArray, axes: FloatArray) -> FloatArray:
    """Angle between a direction and others, signs apart [deg], shape (n,)."""
    return np.asarray(np.degrees(np.arccos(np.clip(np.abs(axes @ axis), 0.0, 1.0))))
