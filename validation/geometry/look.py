"""Context of the checks by geometry, measured when first asked for: overlaps at rest, the sweep of each joint.

The FCL trees and signed distances of the bodies are built once and shared by all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.overlap import OverlapQueries, boxes_meet
from kinematify.geometry.rest_pairs import DepthAllowance
from kinematify.geometry.scene import inverse, read_scene, relative, simplified, visible_shapes
from kinematify.geometry.sweep import Sweeper
from kinematify.geometry.together import looked_at, random_rows
from kinematify.robot.joint_type import JointType
from kinematify.robot.transforms import transformed

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from kinematify.geometry.scene import Connection, Pair, Scene
    from kinematify.geometry.solid import Solid
    from kinematify.geometry.sweep import JointSweep, Meeting, SweepSide
    from kinematify.geometry.together import JudgedConfigurations
    from kinematify.robot.arrays import FloatArray

_ALIKE = 0.8
"""Share of the points in contact that stay the same where one part slides along another one."""
_ALONG = 9
"""Places on the way at which a contact is looked at again."""
_NEARLY = 0.01
"""What ranges of +-3.14 leave out of half a turn [rad]."""
BY_FILE = "contype, conaffinity or <exclude>"
"""Reason of a pair that the file itself keeps from colliding."""


class GeometryContext:
    """A model at rest and in motion, by exact geometry."""

    def __init__(
        self,
        scene: Scene,
        *,
        seed: int = 0,
        in_time: Callable[[], bool] = lambda: True,
        compare_visible: bool = False,
        disabled: Mapping[frozenset[str], str] | None = None,
    ) -> None:
        """Keep what is looked at.

        Args:
            scene: The bodies with their collision geometry.
            seed: Of the quasi-random configurations.
            in_time: False from when on no further joint may be begun.
            compare_visible: Measure the visual geometry as well where it is another one.
            disabled: Pairs of links that the SRDF leaves out, with its reason, or that the file keeps from colliding.
        """
        self.scene = scene
        self.overlap = OverlapQueries(scene)
        self.allowance = DepthAllowance(scene, self.overlap)
        self.sweeper = Sweeper(scene, self.overlap, self.allowance)
        self.in_time = in_time
        self.seed, self._compare_visible = seed, compare_visible
        self.disabled = disabled or {}

    @cached_property
    def visible(self) -> GeometryContext | None:
        """The same of the visual geometry; None where the collision geometry is a copy of it."""
        if not self._compare_visible or not simplified(self.scene.model):
            return None
        scene = read_scene(self.scene.model, self.scene.settings, visible_shapes, solids=self.scene.solids, thin=True)
        same = [body.group for body in scene.bodies] == [body.group for body in self.scene.bodies]
        return GeometryContext(scene) if same else None

    @cached_property
    def whole(self) -> Sweeper:
        """Sweeps of the visible geometry with all of its triangles: with fewer, parts that fit closely meet."""
        return Sweeper.of(read_scene(self.scene.model, self.scene.settings, visible_shapes))

    def thinned(self, pair: Pair) -> bool:
        """True if one of two bodies may be measured with fewer triangles than it has: about two a vertex."""
        most = self.scene.settings.most_faces
        return any(2 * len(points) > most for body in pair for points in self.scene.bodies[body].shapes)

    @cached_property
    def bare(self) -> frozenset[int]:
        """Bodies without collision geometry in a model that has some: they are judged by what is visible of them."""
        links = self.scene.model.link_by_name
        solid = [any(links[name].collisions for name in body.links) for body in self.scene.bodies]
        return frozenset(index for index, collides in enumerate(solid) if not collides) if any(solid) else frozenset()

    def collides(self, pair: Pair) -> bool:
        """True if both bodies have collision geometry, or no body of the model has any."""
        return not self.bare & set(pair)

    def felt_by_engines(self, pair: Pair) -> bool:
        """True if engines collide two bodies by default: neighbours pass each other, but for those of the base."""
        return pair not in self.scene.connection_of or self.scene.bodies[pair[0]].group == 0

    def left_out_by(self, pair: Pair, values: Mapping[int, float]) -> str | None:
        """Return what leaves out the two links of two bodies that meet, see `links_at`; None if nothing does."""
        reason = self.disabled.get(frozenset(self.links_at(pair, values))) if self.disabled else None
        return None if reason is None else f"its {BY_FILE}" if reason == BY_FILE else "the SRDF"

    def thickness(self, pair: Pair) -> float:
        """Thickness of the thinner of two bodies [m]: no penetration is deeper."""
        return min(_thickness(solid) for solid in self.overlap.solids(pair))

    def shown(self, pair: Pair) -> bool:
        """True if both bodies are visible; where no visual could be read, nobody sees whether they overlap."""
        links = self.scene.model.link_by_name
        return all(any(links[name].visuals for name in self.scene.bodies[body].links) for body in pair)

    def clear(self, pair: Pair, values: Mapping[int, float]) -> bool:
        """True if the visible surfaces of two bodies do not meet, both being visible.

        Args:
            pair: The bodies.
            values: Leaders that are not at rest [rad or m].
        """
        visible = self.visible
        if visible is None or not self.shown(pair):
            return False
        row = self.scene.mechanism.rest.copy()
        row[list(values)] = list(values.values())
        T = relative(visible.scene.poses(row[None]), pair)
        inside = visible.overlap.may_contain(pair, T)[0] and visible.overlap.depth(pair, T)[0] > 0.0
        return not (inside or visible.overlap.collide(pair, T)[0])

    @cached_property
    def sweeps(self) -> list[JointSweep]:
        """Sweeps of the joints, as many as there is time for."""
        found = []
        for leader in range(len(self.scene.travels)):
            if not self.in_time():
                break
            found.append(self.sweeper.sweep(leader))
        return found

    @cached_property
    def left(self) -> str | None:
        """Which joints were omitted."""
        left = [travel.joint for travel in self.scene.travels[len(self.sweeps) :]]
        return f"{len(left)} joints: {', '.join(left)}" if left else None

    @cached_property
    def motions(self) -> list[JointMotion]:
        """The joints in motion."""
        return [JointMotion(look=self, sweep=sweep) for sweep in self.sweeps]

    @cached_property
    def random(self) -> JudgedConfigurations | None:
        """Quasi-random configurations; None where no joint moves or time is up."""
        if not self.scene.travels or not self.in_time():
            return None
        return looked_at(self.scene, self.overlap, self.allowance, random_rows(self.scene, self.seed))

    def links_at(self, pair: Pair, values: Mapping[int, float]) -> tuple[str, str]:
        """Return the links of two bodies that are deepest in each other, or else nearest, in the order of the document.

        Args:
            pair: The bodies.
            values: Leaders that are not at rest [rad or m].
        """
        row = self.scene.mechanism.rest.copy()
        row[list(values)] = list(values.values())
        T = relative(self.scene.poses(row[None]), pair)
        firsts, seconds = (self._links_of(body) for body in pair)
        if len(firsts) * len(seconds) == 1:
            return self.in_order(*self.scene.name(pair))
        overlap, bodies = self._overlap_of_links, self._links_apart.bodies
        links = [(first, second) for first in firsts for second in seconds]
        near = [two for two in links if boxes_meet(*overlap.solids(two), T)[0]]
        depth, best = max(((float(overlap.depth(two, T)[0]), two) for two in near), default=(0.0, links[0]))
        if depth == 0.0:
            best = min(links, key=lambda two: overlap.gap(two, T[0]))
        return self.in_order(*(bodies[link].name for link in best))

    def in_order(self, first: str, second: str) -> tuple[str, str]:
        """Names of two links in the order of the document."""
        names = [link.name for link in self.scene.model.links]
        return (first, second) if names.index(first) < names.index(second) else (second, first)

    def parent_and_child(self, connection: Connection, values: Mapping[int, float]) -> tuple[str, str]:
        """The same of two neighbours, the parent first."""
        first, second = self.links_at(connection.pair, values)
        return (first, second) if first in self.scene.bodies[connection.parent].links else (second, first)

    def is_known(self, connection: Connection) -> bool:
        """True if no link that its joints join lacks a shape, so that their gap is what it seems."""
        joints = map(self.scene.model.joint_by_name.__getitem__, connection.joints)
        return self.scene.model.lacking.isdisjoint(name for item in joints for name in (item.parent, item.child))

    def on_an_axle(self, connection: Connection) -> bool:
        """True if a child turns without end about a line that runs through its parent's box too, as wheels do."""
        joint = self.scene.model.joint_by_name[connection.joints[-1]]
        if joint.kind is not JointType.CONTINUOUS:
            return False
        T = relative(self.scene.at_rest[None], (connection.parent, connection.child))[0]
        parent, child = (self.scene.bodies[body].solid for body in (connection.parent, connection.child))
        return _runs_through_box(child, np.zeros(3), joint.axis) and _runs_through_box(
            parent, T[:3, 3], T[:3, :3] @ joint.axis
        )

    def _links_of(self, body: int) -> list[int]:
        """Links with geometry of a body, as bodies of `_links_apart`."""
        group = self.scene.bodies[body].group
        return [link for link, apart in enumerate(self._links_apart.bodies) if apart.group == group]

    @cached_property
    def _links_apart(self) -> Scene:
        """Every link in the frame of its body, for the names of places."""
        return read_scene(self.scene.model, self.scene.settings, by_link=True, solids=self.scene.solids, thin=True)

    @cached_property
    def _overlap_of_links(self) -> OverlapQueries:
        return OverlapQueries(self._links_apart)


def _thickness(solid: Solid) -> float:
    """Extent of a solid along its thinnest direction [m]: of its box, or of its points where they are askew in it."""
    centred = solid.points - solid.points.mean(axis=0)
    thinnest = np.linalg.eigh(centred.T @ centred)[1][:, 0]
    return min(float((solid.high - solid.low).min()), float(np.ptp(centred @ thinnest)))


def _runs_through_box(solid: Solid, point: FloatArray, axis: FloatArray) -> bool:
    """True if a line runs through the box of a solid, body frame."""
    slope = np.where(axis == 0.0, 1e-12, axis)
    ends = np.sort([(solid.low - point) / slope, (solid.high - point) / slope], axis=0)
    return bool(ends[0].max() <= ends[1].min())


@dataclass(frozen=True, kw_only=True, eq=False)
class JointMotion:
    """One joint that moves alone, over its range and beyond."""

    look: GeometryContext
    sweep: JointSweep

    @property
    def scene(self) -> Scene:
        """The bodies."""
        return self.look.scene

    @property
    def joint(self) -> str:
        """Its name."""
        return self.sweep.travel.joint

    @property
    def has_stops(self) -> bool:
        """True if the file says where it stops: it has limits, and they are not half a turn to both sides."""
        travel = self.sweep.travel
        half_turns = travel.turns and max(travel.lower, -travel.upper) < -(np.pi - _NEARLY)
        return travel.limited and not half_turns

    def late(self, meeting: Meeting) -> bool:
        """True if it turns by `geometry.early_turn` before two bodies meet."""
        travel = self.sweep.travel
        return travel.turns and abs(meeting.first - travel.rest) > np.radians(self.scene.settings.early_turn)

    def parted(self, pair: Pair) -> tuple[float, float]:
        """Return how much farther apart than at rest a pair gets at most [m], and at which value [rad or m]."""
        return self._parted(self.look, pair, (gap for side in self.sweep.sides for gap in side.gaps))

    def seen_parted(self, pair: Pair) -> tuple[float, float]:
        """The same of what is visible: collision shapes are often stubs that leave bearings and guides out."""
        look = self.look.visible
        if look is None:
            return self.parted(pair)
        gaps = (gap for sign in (-1.0, 1.0) for gap in look.sweeper.widest(self.sweep.leader, pair, sign))
        return self._parted(look, pair, gaps)

    def _parted(
        self, look: GeometryContext, pair: Pair, gaps: Iterable[tuple[Pair, float, float]]
    ) -> tuple[float, float]:
        own = ((gap, value) for other, gap, value in gaps if other == pair)
        gap, value = max(own, default=(0.0, self.sweep.travel.rest))
        return gap - look.allowance.gap(pair), value

    @cached_property
    def blocked(self) -> dict[float, Meeting]:
        """For each side the first own meeting, if one gets too deep within the declared range and stops the joint."""
        firsts = {side.sign: self.own_first(side) for side in self.sweep.sides}
        return {sign: meeting for sign, meeting in firsts.items() if meeting is not None and meeting.inside}

    def own_first(self, side: SweepSide) -> Meeting | None:
        """Where the child first meets its parent on a side, within the declared range or beyond."""
        return next((m for m in side.meetings if m.pair in self.sweep.own and self.counts(m)), None)

    def counts(self, meeting: Meeting) -> bool:
        """True if a meeting counts: a contact that is alike all along is no stop, and what does not collide is seen.

        Where the file gives a body no collision geometry, its visible surfaces must meet the other's visible ones.
        """
        if not meeting.inside:
            return self.look.collides(meeting.pair)
        return (self.look.collides(meeting.pair) or self.seen(meeting) > 0.0) and not self._alike[
            meeting.pair, meeting.at
        ]

    @cached_property
    def _alike(self) -> dict[tuple[Pair, float], bool]:
        """For each meeting within the declared range, keyed by its pair and place, whether it is alike all along."""
        return {
            (meeting.pair, meeting.at): self._is_alike(meeting, side)
            for side in self.sweep.sides
            for meeting in side.meetings
            if meeting.inside
        }

    def _is_alike(self, meeting: Meeting, side: SweepSide) -> bool:
        """True if the same points of what moves are in the other body from soon after the onset to the declared end.

        A carriage on a rail is so; what a stop meets gets deeper, and what goes through a wall gets there with others.
        """
        travel, pair = self.sweep.travel, meeting.pair
        if abs(side.declared - meeting.first) < 0.5 * abs(side.declared - travel.rest):
            return False
        rows = self.look.sweeper.rows(self.sweep.leader, np.linspace(meeting.first, side.declared, _ALONG)[1:])
        T = relative(self.scene.poses(rows), pair)
        fixed, moving = self.look.overlap.solids(pair)
        if not self.scene.mechanism.moved[self.sweep.leader][self.scene.bodies[pair[1]].group]:
            fixed, moving, T = moving, fixed, inverse(T)
        if not len(fixed.shells.closed):
            return False
        points = moving.points @ T[:, :3, :3].transpose(0, 2, 1) + T[:, None, :3, 3]
        within = fixed.deepest(points.reshape(-1, 1, 3)).reshape(points.shape[:2]) > 0.0
        always, ever = within.all(axis=0), within.any(axis=0)
        return bool(always.any() and always.sum() >= _ALIKE * ever.sum())

    def penetration(self, meeting: Meeting) -> float:
        """Return the depth of two bodies in each other [m]: at most the thinner one, and what a slide has moved."""
        deep = min(meeting.depth, self.look.thickness(meeting.pair))
        moved = abs(meeting.at - meeting.first)
        return deep if self.sweep.travel.turns or moved == 0.0 else min(deep, moved)

    @property
    def left(self) -> float:
        """Share of the declared range that is free around rest."""
        return self._share(meeting.first for meeting in self.blocked.values())

    @property
    def stuck(self) -> bool:
        """True if it gets deeper into its parent than it may within `geometry.early` of its range."""
        return self._share(meeting.deep for meeting in self.blocked.values()) < self.scene.settings.early

    def _share(self, stops: Iterable[float]) -> float:
        travel, stops = self.sweep.travel, list(stops)
        low = max([travel.lower, *(value for value in stops if value <= travel.rest)])
        high = min([travel.upper, *(value for value in stops if value >= travel.rest)])
        return max(high - low, 0.0) / travel.range if travel.range else 0.0

    def free_way(self, side: SweepSide) -> float:
        """Return how far the child goes to a side before it meets its parent [rad or m]."""
        meeting = self.own_first(side)
        return abs((side.reached if meeting is None else meeting.first) - self.sweep.travel.rest)

    def early(self, side: SweepSide) -> bool:
        """True if a side is blocked at once."""
        limit = self.scene.settings.early * self.sweep.travel.range
        return self.own_first(side) is not None and self.free_way(side) < limit

    def one_sided(self, sign: float) -> bool:
        """True if only the blocked side is permitted to speak of, and the other one is free for half of the range."""
        other, travel = self.side(-sign), self.sweep.travel
        permitted = abs(other.declared - travel.rest)
        return permitted < self.scene.settings.early * travel.range and self.free_way(other) >= 0.5 * travel.range

    def side(self, sign: float) -> SweepSide:
        """The side of a sign."""
        return self.sweep.sides[0 if sign < 0 else 1]

    def seen(self, meeting: Meeting) -> float:
        """Return the depth that the visible geometry of two reaches on that side [m], 0 where it stays clear."""
        visible = self.look.visible
        key = meeting.pair, -1.0 if meeting.at < self.sweep.travel.rest else 1.0
        if key not in self._seen:
            seen = meeting if visible is None else visible.sweeper.meeting(self.sweep.leader, *key)
            if seen is not None and (visible or self.look).thinned(meeting.pair):
                seen = self.look.whole.meeting(self.sweep.leader, *key)
            self._seen[key] = 0.0 if seen is None else seen.depth
        return self._seen[key]

    @cached_property
    def _seen(self) -> dict[tuple[Pair, float], float]:
        """Depths of what is visible, by pair and side."""
        return {}

    def clearable(self, meeting: Meeting) -> bool:
        """True if the other joints between the two keep them apart somewhere, where this one brings them deepest."""
        scene = self.scene
        others = sorted(scene.between(meeting.pair) - {self.sweep.leader})
        if not others:
            return False
        spread = random_rows(scene, self.look.seed)
        rows = np.tile(scene.mechanism.rest, (2 * len(others) + len(spread), 1))
        for number, leader in enumerate(others):  # one at one of its ends, or all anywhere
            rows[2 * number : 2 * number + 2, leader] = scene.travels[leader].lower, scene.travels[leader].upper
        rows[2 * len(others) :, others] = spread[:, others]
        rows[:, self.sweep.leader] = meeting.at
        overlap, allowance = self.look.overlap, self.look.allowance
        T = relative(scene.poses(rows), meeting.pair)
        hit = overlap.collide(meeting.pair, T) | overlap.may_contain(meeting.pair, T)
        if not hit.all():
            return True
        allowed = allowance.at_rest(meeting.pair) + allowance.tolerance(meeting.pair)
        return not meeting.passed and bool((overlap.depth(meeting.pair, T) <= allowed).any())

    def guide(self, connection: Connection, side: SweepSide, *, visible: bool = False) -> tuple[float, float]:
        """Return the way after which the trailing end of the child has passed the leading end of the parent [m]."""
        scene = (self.look.visible or self.look).scene if visible else self.scene
        rows = np.tile(scene.mechanism.rest, (2, 1))
        rows[1, self.sweep.leader] = side.declared
        poses = scene.poses(rows)
        motion = poses[1, connection.child, :3, 3] - poses[0, connection.child, :3, 3]
        moved = float(np.linalg.norm(motion))
        if moved == 0.0:
            return 0.0, 0.0
        along = motion / moved
        parent, child = (
            transformed(scene.bodies[body].solid.points, poses[0, body]) @ along
            for body in (connection.parent, connection.child)
        )
        guide = float(parent.max() - child.min())
        return guide, guide / max(float(np.ptp(child)), 1e-12)
