"""One declared joint with what the geometry of its two bodies says of it, as the checks of KV34x look at it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.assembly.assemble import simplified
from kinematify.assembly.erasure import erase
from kinematify.assembly.part import Assembly
from kinematify.contact.tree import KinematicTree
from kinematify.joints.bearings.line import Line
from kinematify.joints.choice.declared import judge
from kinematify.robot.joint_type import JointType
from kinematify.robot.robot import forward_kinematics, rest_configuration
from kinematify.robot.transforms import joint_motion

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from typing import Any

    from kinematify.config import Config
    from kinematify.config.validation import EvidenceSettings
    from kinematify.joints.choice.declared import JudgedJoint
    from kinematify.joints.features.workspace import PartCache
    from kinematify.robot.arrays import FloatArray
    from kinematify.robot.robot import Robot

    Opening = tuple[float, float]
    """Width [m], and the value of the joint, zero at rest [rad or m]."""

_LINKAGE = 0.5  # `JointScene.mechanism` from which a pair belongs to a linkage rather than to furniture

_STEPS = 4
"""Places to each side at which the contact is looked at."""


class Contact:
    """Two bodies that touch at rest, and the places where they do."""

    def __init__(self, cache: PartCache, parent: int, child: int, *, band: float) -> None:
        """Gather the places.

        Args:
            cache: The bodies at rest.
            parent: Index of the body that stands.
            child: Index of the body that moves.
            band: Places this much farther apart than the nearest are in contact too [m].
        """
        self._cache, self._parent, self._child = cache, parent, child
        found = cache.contact(parent, child, band)
        self._of_child, self._of_parent = found.points, found.parent_points
        self._at_rest = cache.distances(parent, self._of_child), cache.distances(child, self._of_parent)

    @property
    def places(self) -> int:
        """Samples of the larger side."""
        return max(len(self._of_child), len(self._of_parent))

    def opening(self, kind: JointType, line: Line, lower: float, upper: float) -> Opening:
        """Return by how much half of the contact opens most, on the side of the body on which less does, and where.

        Args:
            kind: Type of the joint.
            line: Its axis, world frame at rest.
            lower: End of the motion below rest [rad or m].
            upper: End above rest [rad or m].
        """
        values = np.concatenate([np.linspace(0.0, end, _STEPS + 1) for end in (lower, upper)])
        motions = [joint_motion(kind, line.axis, line.point, value) for value in values.tolist()]
        widths = [self._width(T[:3, :3], T[:3, 3]) for T in motions]
        widest = int(np.argmax(widths))
        return widths[widest], float(values[widest])

    def _width(self, rotation: FloatArray, shift: FloatArray) -> float:
        of_child = self._grown(self._parent, self._of_child @ rotation.T + shift, self._at_rest[0])
        return min(of_child, self._grown(self._child, (self._of_parent - shift) @ rotation, self._at_rest[1]))

    def _grown(self, body: int, places: FloatArray, before: FloatArray) -> float:
        """By how much half of some places are farther from a body than before; infinite without places."""
        return float(np.median(self._cache.distances(body, places) - before)) if len(places) else float("inf")


@dataclass(frozen=True, kw_only=True)
class JointCase:
    """One declared joint."""

    measures: JudgedJoint
    settings: EvidenceSettings
    bodies: Sequence[str]
    """First link with geometry of every body."""
    carrier: str
    """First link of the body that carries it."""
    frame: FloatArray
    """Frame of its axis, world frame at rest, shape (4, 4)."""
    doubted: Mapping[str, Sequence[str]] | None = None
    """Checks by exact geometry that speak against a joint, by joint; None where none were made."""

    @property
    def examined(self) -> bool:
        """Something measured may speak against the joint, so that it is worth to ask what our inference holds of it."""
        return self.doubted is None or self.measures.joint.source in self.doubted or self.opens

    @property
    def linkage(self) -> bool:
        """The pair belongs to a machine, not to furniture."""
        return self.measures.scene.mechanism > _LINKAGE

    @property
    def instead(self) -> str:
        """The axis to write for the line that fits best, and where that line runs, in the joint's own frame."""
        joint, line = self.measures.joint.source, self.measures
        T = self.frame
        axis = line.best_axis @ T[:3, :3]
        remedy = f'The line that fits best has <axis xyz="{_written(axis)}"/> in the joint {joint}'
        if self.measures.slides:
            return f"{remedy}."
        pivot = (line.best_pivot - T[:3, 3]) @ T[:3, :3]
        foot = pivot - (pivot @ axis) * axis
        return f"{remedy}, and runs through {_written(foot)} of the joint's frame."

    @property
    def parent(self) -> str:
        """Name of the body that carries the joint."""
        return self.bodies[self.measures.joint.parent]

    @property
    def child(self) -> str:
        """Name of the body that moves."""
        return self.bodies[self.measures.joint.child]

    @property
    def share_of_contact(self) -> float:
        """Quality of the contact with the parent over that of the best other contact; inf without another."""
        found = self.measures.parent
        return found.quality / found.best_quality if found.best_quality > 0.0 else float("inf")

    @property
    def hangs_elsewhere(self) -> bool:
        """The child touches another body and not its parent, or its parent far less; it is judged no further then."""
        found = self.measures.parent
        touches_another = found.best is not None and found.best_quality > 0.0
        return touches_another and (not found.touches or self.share_of_contact < self.settings.weak_contact)

    @property
    def lines_judged(self) -> bool:
        """Direction and place of its axis can be judged: the child touches its parent and hangs on no other body."""
        return self.measures.parent.touches and not self.hangs_elsewhere

    @property
    def unexplained(self) -> bool:
        """The axis runs along no direction that the two bodies show."""
        return self.lines_judged and self.measures.angle > self.settings.unknown_deg

    @property
    def misplaced(self) -> bool:
        """The axis runs far beside every line along its direction that the two bodies show."""
        if self.measures.slides or not self.lines_judged or self.unexplained:
            return False  # a direction that nothing shows has no place
        return self.measures.distance > self.farthest

    @property
    def farthest(self) -> float:
        """Return how far beside a line that the bodies show an axis may run, fraction of the child's diagonal."""
        return self.settings.linkage_distance if self.linkage else self.settings.unknown_distance

    @property
    def outdone(self) -> bool:
        """Another joint of its type explains the contact clearly better."""
        measures, settings = self.measures, self.settings
        usual = settings.linkage_better if self.linkage else settings.better
        if not self.judged_alone or self.unexplained or measures.deficit <= usual:
            return False  # of course another one fits better than a direction that nothing shows
        if measures.own_bearing > max(settings.bearing_score, 0.5 * measures.bearing):
            return False  # both bodies are round about the declared line about as clearly: no habit speaks against it
        return not self.linkage or self.contradicted or self.blocked > settings.blocked

    @property
    def doubts_line(self) -> bool:
        """Its line is not one that the two bodies show, or another one is likelier."""
        return self.unexplained or self.misplaced or self.outdone

    @property
    def doubts_type(self) -> bool:
        """The other type is likelier by far.

        No more than habit counts nowhere: few joints of linkages slide, but those that do are meant to, unless
        something else speaks against it, too: a bearing, a better slide, a parent in the way. Nor does anybody write
        that a part turns without end by mistake.
        """
        measures, settings = self.measures, self.settings
        likelier = self.judged_alone and measures.odds_against > settings.type_odds
        if not likelier or measures.joint.kind is JointType.CONTINUOUS:
            return False
        if not self.linkage or not measures.slides:
            return True
        return measures.deficit > settings.better or measures.scene.has_bearing or self.blocked > settings.blocked

    @property
    def contradicted(self) -> bool:
        """Both bodies are beyond doubt round about another line."""
        own = max(self.measures.own_bearing, 1e-4)
        return self.measures.scene.has_bearing and self.measures.bearing > self.settings.bearing_lead * own

    @cached_property
    def _contact(self) -> Contact | None:
        """Where child and parent touch; None at too few places to say anything."""
        joint, settings = self.measures.joint, self.settings
        band = settings.contact_band * self.measures.size
        contact = Contact(self.measures.whole.cache, joint.parent, joint.child, band=band)
        return contact if contact.places >= settings.contact_places else None

    def _opening(self, line: Line) -> Opening:
        assert self._contact is not None
        joint, size, settings = self.measures.joint, self.measures.size, self.settings
        reach = settings.longest_slide * size if self.measures.slides else np.radians(settings.widest_turn)
        return self._contact.opening(joint.kind, line, max(joint.lower, -reach), min(joint.upper, reach))

    @cached_property
    def _own(self) -> Opening | None:
        joint = self.measures.joint
        return None if self._contact is None else self._opening(Line(axis=joint.axis, point=joint.pivot))

    @property
    def opens(self) -> bool:
        """The contact opens about the declared line so far that it may do so less about another one."""
        least = min(self.settings.bearing_opens, self.settings.opens, self.settings.opens_across)
        return self._own is not None and self._own[0] > least * self.measures.size

    @cached_property
    def opened(self) -> tuple[Opening, Opening] | None:
        """Return the opening of the contact about the declared line and about the best one, if that is much less.

        None where the two bodies touch at too few places to say so, and in linkages also where the other line runs
        across the declared one without a bearing about it: what a leg without bearings touches says little.
        """
        measures, settings = self.measures, self.settings
        joint, line, size = measures.joint, measures, measures.size
        turned = float(np.degrees(np.arccos(np.clip(abs(line.best_axis @ joint.axis), 0.0, 1.0))))
        if self.contradicted:
            limit = settings.bearing_opens
        elif turned <= settings.neighbour_deg:
            limit = settings.opens
        elif self.linkage:
            return None
        else:
            limit = settings.opens_across
        own = self._own
        if own is None:
            return None
        lines = [Line(axis=sign * line.best_axis, point=line.best_pivot) for sign in (1.0, -1.0)]
        other = min(map(self._opening, lines), key=lambda opening: opening[0])
        clear = own[0] - other[0] > limit * size and other[0] < settings.stays_closed * own[0]
        return (own, other) if clear else None

    @property
    def judged_alone(self) -> bool:
        """It is the only joint between the two bodies, and hangs on no other: the contact tells of this joint."""
        return self.measures.alone and not self.hangs_elsewhere

    @property
    def blocked(self) -> float:
        """Share of the declared range in which the parent is in the way, of as much of it as was swept."""
        joint, reach, (forward, backward) = self.measures.joint, self.measures.reach, self.measures.free
        upper, lower = min(max(joint.upper, 0.0), reach), min(max(-joint.lower, 0.0), reach)
        missing = max(upper - forward, 0.0) + max(lower - backward, 0.0)
        return missing / max(upper + lower, 1e-12)


def read_cases(
    robot: Robot,
    config: Config,
    settings: EvidenceSettings,
    doubted: Mapping[str, Sequence[str]] | None,
    *,
    seed: int,
) -> list[JointCase]:
    """Pose the bodies at rest and hold every joint between two of them against what they show, as the file orders them.

    Args:
        robot: Links, meshes and joints as declared; links that fixed joints hold together are one body.
        config: How evidence is gathered.
        settings: What it means.
        doubted: See `JointCase.doubted`.
        seed: Seed of all samples.
    """
    if not any(link.has_geometry for link in robot.links):
        return []
    erased = erase(robot, shuffle=False)
    poses, truth = forward_kinematics(robot, rest_configuration(robot)), erased.truth
    if len(erased.parts) < 2 or -1 in (joint.parent for joint in truth.joints):
        return []
    most = config.assembly.max_part_faces
    parts = [part if len(part.faces) <= most else simplified(part, config.assembly) for part in erased.parts]
    assembly = Assembly(parts=tuple(parts), source=robot.name)
    bodies = [next(name for name in links if robot.link_by_name[name].has_geometry) for links in truth.part_links]
    declared = robot.joint_by_name
    return [
        JointCase(
            measures=measures,
            settings=settings,
            bodies=bodies,
            carrier=truth.part_links[measures.joint.parent][0],
            frame=poses[declared[measures.joint.source].parent] @ declared[measures.joint.source].T_parent_child,
            doubted=doubted,
        )
        for measures in judge(assembly, KinematicTree(parents=truth.parents), truth.joints, config, settings, seed=seed)
    ]


def _written(vector: FloatArray) -> str:
    """Numbers as a file has them."""
    return " ".join(f"{value + 0.0:.4g}" for value in np.round(vector, 6))


def better_joint(robot: Robot, case: JointCase) -> dict[str, Any] | None:
    """Return the joint that the geometry speaks for instead; None where its line and its type are not in doubt.

    Its line is in the world frame at zero, where the parent carries it from its place at rest.
    """
    measures = case.measures
    if not case.examined or not (case.doubts_type or case.doubts_line):
        return None
    found, best = measures.posterior.hypotheses, measures.best_other if case.doubts_type else measures.best
    T_world_rest = forward_kinematics(robot, rest_configuration(robot))[case.carrier]
    T_zero_rest = forward_kinematics(robot, {})[case.carrier] @ np.linalg.inv(T_world_rest)
    return {
        "kind": measures.posterior.kind(best).value,
        "axis": (T_zero_rest[:3, :3] @ found.axes[best]).tolist(),
        "pivot": (T_zero_rest[:3, :3] @ found.pivots[best] + T_zero_rest[:3, 3]).tolist(),
        "score": measures.odds_against if case.doubts_type else measures.deficit,
    }
