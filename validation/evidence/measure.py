"""Evidence of the contact geometry for every declared joint, in figures; `judge` decides what they mean.

Candidates are those that the inference would weigh, and its fitted choice judges them, without names; the declared
joint stands among them, and its parent among all bodies that the child touches.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kinematify.joints.bearings.line import Line
from kinematify.joints.candidate import FIXED, GIVEN, SLIDE, TURN
from kinematify.joints.choice.decide import edge_features
from kinematify.joints.choice.judge import judge
from kinematify.joints.features.edge_scene import part_frames
from kinematify.joints.features.turn_cues import outwardness
from kinematify.joints.features.workspace import PartCache
from kinematify.robot.joint_type import JointType
from kinematify.robot.vectors import crossed, lengths_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from kinematify.assembly.truth import TrueJoint
    from kinematify.config import JointsConfig
    from kinematify.config.validation import EvidenceSettings
    from kinematify.joints.choice.judge import Posterior
    from kinematify.joints.features.columns import Features
    from kinematify.robot.arrays import FloatArray
    from kinematify.validation.evidence.bodies_at_rest import Bodies, Pair

    BoolArray = NDArray[np.bool_]


_BALL = 0.08  # spread of the radii; a sphere of 20 triangles has 0.07, a cube 0.16


@dataclass(frozen=True, kw_only=True, eq=False)
class ParentEvidence:
    """Evidence of the parent: how the child hangs on its declared parent, beside the other bodies that it touches."""

    touches: bool
    """The declared parent touches the child."""
    gap: float
    """Distance of the two, fraction of the model's diagonal."""
    quality: float
    """How good their contact is for the tree, in [0, 1]; 0 where they do not touch, or the child touches no other."""
    best: int | None
    """Body with the best contact, without the declared parent and what the child carries; None if there is none."""
    best_quality: float


@dataclass(frozen=True, kw_only=True, eq=False)
class LineEvidence:
    """Where the declared line lies among those that the geometry of the two bodies knows."""

    angle: float
    """Smallest angle to a known direction [deg]."""
    distance: float
    """Smallest distance to a known line along nearly the same direction, fraction of the child's diagonal; inf if there
    is none."""
    deficit: float
    """Score (`Posterior.scores`) of the best candidate of its type less that of the declared joint; 0 if it is best."""
    best_axis: FloatArray
    """Of the best candidate of the declared type, shape (3,)."""
    best_pivot: FloatArray
    """World frame at rest [m], shape (3,)."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RoomEvidence:
    """Where the child can go about or along the declared line before it meets its parent."""

    forward: float
    """Free motion towards + [rad or m], at most `reach`."""
    backward: float
    """Free motion towards - [rad or m]."""
    outward: float
    """Of a turn, the cosine between the first motion towards + and the way out of the parent. Of a slide, where the
    child is along it: 1 at the far side of the parent or beyond, -1 at the near side, 0 in the middle."""
    reach: float
    """How far was swept [rad or m]."""
    length: float
    """Size of the child along the declared line [m]."""
    ajar: bool
    """A plate that touches its parent along one edge only, so that it stands open."""
    parted: float
    """How much farther a slide is from its parent at the end of its range than at rest [m]; 0 for a turn."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointMeasures:
    """Everything that is measured of one declared joint."""

    joint: TrueJoint
    """As declared, in the world frame at rest."""
    parent: ParentEvidence
    line: LineEvidence
    room: RoomEvidence
    posterior: Posterior
    """How likely each candidate is."""
    bearing: float
    """Score of the best bearing line of the contact; 0 without one."""
    own_bearing: float
    """Score of the declared line as a bearing; 0 where there is no other to compare it with."""
    features: Features

    @property
    def slides(self) -> bool:
        """The joint is declared prismatic."""
        return self.joint.kind is JointType.PRISMATIC

    @property
    def odds_against(self) -> float:
        """Log odds of the other type against the declared one."""
        return -self.posterior.odds_prismatic if self.slides else self.posterior.odds_prismatic

    @property
    def best_other(self) -> int:
        """Position of the best candidate of the other type."""
        others = (self.posterior.hypotheses.kinds == (TURN if self.slides else SLIDE)) & ~_given(self.posterior)
        return int(np.argmax(np.where(others, self.posterior.scores, -np.inf)))

    @property
    def alone(self) -> bool:
        """It is the only joint between the two bodies; others share one contact, which then tells of no single one."""
        return self.joint.chain_length == 1


def measure_joints(
    bodies: Bodies, settings: EvidenceSettings, *, seed: int, joints: Sequence[TrueJoint] | None = None
) -> Iterator[JointMeasures]:
    """Measure every joint between two bodies, in the order of the description.

    Args:
        bodies: The model at rest.
        settings: What counts as the same line.
        seed: Seed of the surface samples.
        joints: Those to measure; all if absent.
    """
    config = bodies.config.joints
    cache = PartCache(bodies.assembly, bodies.graph, samples=config.samples, seed=seed)
    frames = part_frames(cache, bodies.tree, config)
    geometry_alone = config.confidence.model_copy(update={"cues_lead": 0.0, "name_weight": 0.0})
    for joint in bodies.truth.joints if joints is None else joints:
        edge = (joint.parent, joint.child)
        pair = _pair(*edge)
        line = Line(axis=joint.axis, point=joint.pivot)
        bearing = bodies.bearings.get(pair)
        features = edge_features(cache, bodies.tree, frames, edge, bearing, config=config, given=(line,))
        best, posterior = bearing.lines[0].score if bearing and bearing.lines else 0.0, judge(features, geometry_alone)
        yield JointMeasures(
            joint=joint,
            parent=_parent_evidence(bodies, joint),
            line=_line_evidence(features, posterior, joint, settings),
            room=_room_evidence(features, joint, config),
            posterior=posterior,
            bearing=best,
            own_bearing=bodies.score_line(pair, line).score if best > settings.bearing_score else 0.0,
            features=features,
        )


def _parent_evidence(bodies: Bodies, joint: TrueJoint) -> ParentEvidence:
    carried = bodies.tree.subtree(joint.child)
    others = [body for body in bodies.graph.neighbours[joint.child] if body not in carried and body != joint.parent]
    compared = (*others, joint.parent) if others else ()  # qualities take a tenth of the stage
    quality = {body: _quality(bodies, joint.child, body) for body in compared}
    best = max(others, key=lambda body: quality[body], default=None)
    edge = bodies.graph.by_pair.get(_pair(joint.child, joint.parent))
    return ParentEvidence(
        touches=edge is not None and not edge.bridge,
        gap=bodies.gap(_pair(joint.child, joint.parent)) / bodies.diagonal,
        quality=quality.get(joint.parent, 0.0),
        best=best,
        best_quality=0.0 if best is None else quality[best],
    )


def _quality(bodies: Bodies, child: int, body: int) -> float:
    edge = bodies.graph.by_pair.get(_pair(child, body))
    if edge is None or edge.bridge:
        return 0.0
    return bodies.qualities[_pair(child, body)]


def _pair(first: int, second: int) -> Pair:
    return min(first, second), max(first, second)


def _line_evidence(
    features: Features, posterior: Posterior, joint: TrueJoint, settings: EvidenceSettings
) -> LineEvidence:
    turns, every = joint.kind is not JointType.PRISMATIC, posterior.hypotheses
    angle = 0.0 if _is_ball(features) else float(_angles(joint.axis, _known_directions(features)).min())
    of_type = every.kinds == (TURN if turns else SLIDE)
    axes, pivots, given = every.axes[of_type], every.pivots[of_type], _given(posterior)[of_type]
    scores = posterior.scores[of_type]
    aligned = _angles(joint.axis, axes) < settings.same_deg
    away = turns * lengths_of(crossed(pivots - joint.pivot, joint.axis)) / features.scene.frame.diagonal
    same = aligned & (away < settings.same_distance)
    own = max(float(scores[given].max()), float(scores[same].max(initial=-np.inf)))
    best = int(np.argmax(np.where(given, -np.inf, scores)))
    return LineEvidence(
        angle=angle,
        distance=float(away[aligned & ~given].min(initial=np.inf)),
        deficit=max(0.0, float(scores[best]) - own),
        best_axis=axes[best],
        best_pivot=pivots[best],
    )


def _given(posterior: Posterior) -> BoolArray:
    """Which candidates are the declared joint, shape (h,)."""
    return np.asarray(np.array(posterior.hypotheses.sources) == GIVEN)


def _known_directions(features: Features) -> FloatArray:
    """Directions that the geometry of the two bodies shows, whatever the type, shape (d, 3)."""
    scene = features.scene
    every = features.hypotheses
    proposed = (np.array(every.sources) != GIVEN) & (every.kinds != FIXED)
    found = [every.axes[proposed], scene.frame.axes, scene.parent_frame.axes]
    if scene.bearing is not None:
        found += [line.axis[None] for line in scene.bearing.lines]
        found += [] if scene.bearing.rail is None else [scene.bearing.rail.axis[None]]
    return np.concatenate(found)


def _is_ball(features: Features) -> bool:
    """The child has no direction at all."""
    points = features.scene.cache.samples(features.scene.child).points
    radii = lengths_of(points - points.mean(axis=0))
    return bool(radii.std() < _BALL * radii.mean())


def _angles(axis: FloatArray, axes: FloatArray) -> FloatArray:
    """Angle between a direction and others, signs apart [deg], shape (n,)."""
    return np.asarray(np.degrees(np.arccos(np.clip(np.abs(axes @ axis), 0.0, 1.0))))


def _room_evidence(features: Features, joint: TrueJoint, config: JointsConfig) -> RoomEvidence:
    scene = features.scene
    slides = joint.kind is JointType.PRISMATIC
    reach = config.slides.sweep * scene.diagonal if slides else np.radians(config.panels.sweep_deg)
    length = float(np.ptp(scene.cache.samples(scene.child).points @ joint.axis))
    every = features.hypotheses
    row = np.flatnonzero((np.array(every.sources) == GIVEN) & (every.kinds == (SLIDE if slides else TURN)))
    forward, backward = features.free_parent[row[0]] * (scene.diagonal if slides else 1.0)
    return RoomEvidence(
        forward=float(forward),
        backward=float(backward),
        outward=_side(features, joint.axis) if slides else float(outwardness(scene, every.at(row))[0]),
        reach=float(reach),
        length=length,
        ajar=bool(np.nanmax(features.columns["turn_ajar_contact"]) > 0.0),
        parted=_parted(features, joint) if slides else 0.0,
    )


def _side(features: Features, axis: FloatArray) -> float:
    scene = features.scene
    child, parent = (scene.cache.samples(part).points @ axis for part in (scene.child, scene.parent))
    apart = 0.5 * float(child.min() + child.max() - parent.min() - parent.max())
    return apart / max(0.5 * float(np.ptp(child) + np.ptp(parent)), 1e-12)


def _parted(features: Features, joint: TrueJoint) -> float:
    scene = features.scene
    points = scene.cache.samples(scene.child).points
    way = joint.upper if abs(joint.upper) >= abs(joint.lower) else joint.lower
    if not np.isfinite(way):
        return 0.0
    gaps = [float(scene.cache.distances(scene.parent, points + step * joint.axis).min()) for step in (0.0, way)]
    return gaps[1] - gaps[0]
