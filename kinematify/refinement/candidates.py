"""Every near-best joint of a tree edge as a joint of its own: with opening direction, limits and evidence.

The inference keeps its candidates as lines with scores; to be simulated, a candidate needs the range that it would
have been given had it been chosen. A joint that is none of them is scored as the inference would have scored it.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.contact.graph import pair
from kinematify.joints.bearings.line import Line
from kinematify.joints.candidate import SLIDE, TURN, JointEstimate
from kinematify.joints.choice.decide import edge_features
from kinematify.joints.choice.judge import judge
from kinematify.joints.choice.limits import find_range
from kinematify.joints.features.edge_scene import TreeScenes
from kinematify.joints.features.workspace import PartCache
from kinematify.robot.joint_type import JointType
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from kinematify.assembly.part import Assembly
    from kinematify.config import Config
    from kinematify.contact.graph import ContactGraph, Pair
    from kinematify.contact.tree import KinematicTree
    from kinematify.joints.bearings.scores import EdgeBearing
    from kinematify.joints.candidate import JointCandidate
    from kinematify.joints.features.edge_scene import JointScene
    from kinematify.paper.joints import PaperJoints

_SAME = np.cos(np.radians(1.0))  # directions that no check tells apart


class CandidateJoints:
    """Makes joints of candidates, for any tree over the same parts."""

    def __init__(
        self, assembly: Assembly, graph: ContactGraph, bearings: Mapping[Pair, EdgeBearing], config: Config
    ) -> None:
        """Keep what the inference had; samples and ray scenes are made when first asked for."""
        self._assembly, self._graph, self._bearings, self._all = assembly, graph, bearings, config
        self._config = config.joints
        self._cache = PartCache(assembly, graph, samples=config.joints.samples, seed=config.seed)
        self._wholes: dict[tuple[int, ...], TreeScenes] = {}
        self._scenes: dict[tuple[tuple[int, ...], int], JointScene] = {}
        self._scores: dict[tuple[object, ...], float] = {}

    @cached_property
    def _paper(self) -> PaperJoints:
        # torch takes seconds to import, and only the paper's method needs it.
        from kinematify.paper.joints import PaperJoints  # noqa: PLC0415

        return PaperJoints(self._assembly, self._graph, self._all)

    def realise(self, tree: KinematicTree, joint: JointEstimate, candidate: JointCandidate) -> JointEstimate:
        """The joint that a candidate of an edge would be.

        Args:
            tree: The tree that the edge belongs to.
            joint: What was chosen for the edge; it is returned where the candidate is that same joint.
            candidate: One of its alternatives.
        """
        if is_same(joint, candidate):
            return joint
        if self._config.method == "cavl":
            return self._paper.realise(joint, candidate)
        scene = self.scene(tree, (joint.parent, joint.child))
        found = find_range(scene, candidate.kind, candidate.axis, candidate.pivot)
        return replace(
            joint,
            axis=found.sign * candidate.axis,
            pivot=candidate.pivot,
            evidence={**joint.evidence, **found.evidence},
            **found.facts,
        )

    def scene(self, tree: KinematicTree, edge: tuple[int, int]) -> JointScene:
        """All that is known of one tree edge before a joint is proposed."""
        key = (tree.parents, edge[1])
        if key not in self._scenes:
            if tree.parents not in self._wholes:
                self._wholes[tree.parents] = TreeScenes(self._cache, tree, self._config)
            self._scenes[key] = self._wholes[tree.parents].scene(edge, self._bearings.get(pair(*edge)))
        return self._scenes[key]

    def score(self, tree: KinematicTree, joint: JointEstimate) -> float:
        """Score of a joint below that of the best candidate of its edge [log odds]; 0 for the best and for fixed ones.

        Args:
            tree: The tree that the edge belongs to.
            joint: One of its candidates, or another one, which is measured beside them.
        """
        best = max((candidate.score for candidate in joint.alternatives), default=0.0)
        known = next((candidate.score - best for candidate in joint.alternatives if is_same(joint, candidate)), None)
        if known is not None:
            return known
        if joint.kind is JointType.FIXED or not joint.alternatives:
            return 0.0
        key = (tree.parents, joint.child, joint.kind.turns, joint.axis.tobytes(), joint.pivot.tobytes())
        if key not in self._scores:
            self._scores[key] = (
                self._paper.measure(joint).score - best
                if self._config.method == "cavl"
                else self._measured(tree, joint)
            )
        return self._scores[key]

    def _measured(self, tree: KinematicTree, joint: JointEstimate) -> float:
        """Score of a joint that was not proposed, beside all that were."""
        scene = self.scene(tree, (joint.parent, joint.child))
        features = edge_features(scene, [Line(axis=joint.axis, point=joint.pivot)])
        judged = judge(features, self._config.confidence)
        hypotheses = judged.hypotheses
        apart = 1.0 - np.abs(hypotheses.axes @ joint.axis)
        if joint.kind.turns:
            apart += lengths_of(crossed(hypotheses.pivots - joint.pivot, joint.axis)) / judged.size
        apart[hypotheses.kinds != (TURN if joint.kind.turns else SLIDE)] = np.inf
        return float(judged.scores[int(np.argmin(apart))] - judged.scores.max())


def is_same(joint: JointEstimate, candidate: JointCandidate) -> bool:
    """True if a candidate is the joint that was chosen: type, direction, and place for what turns."""
    if joint.kind is JointType.FIXED or joint.kind.turns != candidate.kind.turns:
        return False
    if abs(float(joint.axis @ candidate.axis)) < _SAME:
        return False
    if not joint.kind.turns:
        return True
    apart = float(np.linalg.norm(crossed(candidate.pivot - joint.pivot, joint.axis)))
    return apart < 1e-9 + 1e-6 * float(np.linalg.norm(candidate.pivot))


def described(joint: JointEstimate) -> str:
    """Type and axis, e.g. ``revolute about (0, 0, 1)``."""
    if joint.kind is JointType.FIXED:
        return "fixed"
    axis = ", ".join(f"{value + 0.0:.2g}" for value in joint.axis.round(3))
    if joint.kind is JointType.PRISMATIC:
        return f"{joint.kind.value} along ({axis})"
    place = ", ".join(f"{value + 0.0:.3g}" for value in joint.pivot)
    return f"{joint.kind.value} about ({axis}) through ({place})"


def ranged(joint: JointEstimate) -> str:
    """Range with its unit, e.g. ``0 to 90 deg``."""
    if joint.kind is JointType.FIXED:
        return "none"
    if not math.isfinite(joint.upper - joint.lower):
        return "unlimited"
    if joint.kind.turns:
        return f"{math.degrees(joint.lower):z.3g} to {math.degrees(joint.upper):.3g} deg"
    return f"{joint.lower * 1e3:z.3g} to {joint.upper * 1e3:.3g} mm"
