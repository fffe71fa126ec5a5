"""KV310 to KV321: what the sweep of one joint says about its axis, its direction and its limits.

A wrong axis or pivot drives the child into its parent at once and to both sides; a wrong limit lets it go for a
while to one side; a wrong parent brings it together with other bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kinematify.geometry.scene import relative, transformed
from kinematify.validation.finding import Blame, Severity
from kinematify.validation.geometry.remark import (
    SLIMMER,
    UNSEEN,
    Remark,
    configuration,
    in_document_order,
    joint_value,
    length,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from kinematify.geometry.overlap import Overlap
    from kinematify.geometry.rest import Allowance
    from kinematify.geometry.scene import Scene
    from kinematify.geometry.sweep import JointSweep, Meeting, Side


@dataclass(frozen=True, kw_only=True, eq=False)
class MotionCase:
    """One joint with its sweep, as the checks look at it."""

    scene: Scene
    overlap: Overlap
    allowance: Allowance
    sweep: JointSweep
    visible: Callable[[int], JointSweep] | None
    """The sweep of a leader by visual geometry; None where that is the same."""

    @cached_property
    def joint(self) -> str:
        """Its name."""
        return self.sweep.travel.joint

    @cached_property
    def blocked(self) -> dict[float, Meeting]:
        """For each side the first own meeting, if one gets too deep within the declared range."""
        firsts = {side.sign: self.own_first(side) for side in self.sweep.sides}
        return {sign: meeting for sign, meeting in firsts.items() if meeting is not None and meeting.inside}

    def own_first(self, side: Side) -> Meeting | None:
        """Where the child first meets its parent on a side, within the declared range or beyond."""
        return next((meeting for meeting in side.meetings if meeting.pair in self.sweep.own), None)

    def way(self, side: Side) -> float:
        """How far the child goes to a side before it meets its parent [rad or m]."""
        meeting = self.own_first(side)
        return abs((side.reached if meeting is None else meeting.first) - self.sweep.travel.rest)

    def early(self, side: Side) -> bool:
        """Whether a side is blocked at once."""
        return self.own_first(side) is not None and self.way(side) < self.scene.settings.early * self.sweep.travel.range

    def side(self, sign: float) -> Side:
        """The side of a sign."""
        return self.sweep.sides[0 if sign < 0 else 1]

    def value(self, value: float) -> str:
        """A value of the joint in words."""
        return joint_value(value, turns=self.sweep.travel.turns)

    def remark(self, meeting: Meeting, message: str, remedy: str, *, severity: Severity | None = None) -> Remark:
        """A remark about a meeting; an error if it is clearly too deep, and not in the collision geometry alone."""
        seen = meeting.depth if severity is Severity.NOTE else self.seen(meeting)
        unseen = seen == 0.0
        wrong = min(meeting.depth, seen) > self.scene.settings.wrong * self.scene.size
        return Remark(
            message=f"{message} {UNSEEN}" if unseen else message,
            remedy=SLIMMER if unseen else remedy,
            severity=severity or (Severity.ERROR if wrong else Severity.WARNING),
            blame=Blame.PHYSICS if unseen else None,
            joint=self.joint,
            pair=in_document_order(self.scene, meeting.pair),
            q=configuration(self.scene, {self.sweep.leader: meeting.at}),
            value=meeting.depth,
            limit=self.allowance.tolerance(meeting.pair),
            unit="m",
        )

    def seen(self, meeting: Meeting) -> float:
        """How deep the visible geometry of the two gets into each other [m], 0 where it stays clear."""
        if self.visible is None:
            return meeting.depth
        found = [seen for side in self.visible(self.sweep.leader).sides for seen in side.meetings]
        return max((seen.depth for seen in found if seen.pair == meeting.pair and seen.inside), default=0.0)

    def words(self, meeting: Meeting) -> str:
        """What meets, how deep and where."""
        first, second = in_document_order(self.scene, meeting.pair)
        deep = "go through each other by" if meeting.passed else "get into each other by"
        return f"{first} and {second} {deep} {length(meeting.depth)} at {self.value(meeting.at)}"


def through_parent(case: MotionCase) -> Iterator[Remark]:
    """KV310: blocked at once, to both sides or to the only one that is permitted."""
    limited = case.sweep.travel.limited  # a file that states no limits claims nothing about how far the joint goes
    for sign, meeting in case.blocked.items():
        side, other = case.side(sign), case.side(-sign)
        if not case.early(side):
            continue
        where = (
            f"Moving {case.joint} alone, the child meets its parent at {case.value(meeting.first)} already "
            f"(declared up to {case.value(side.declared)}): {case.words(meeting)}."
        )
        if case.early(other):
            yield case.remark(
                meeting,
                f"{where} The other way it meets it at {case.value(case.own_first(other).first)}: blocked to both "  # type: ignore[union-attr]
                "sides at once, the axis or its place is wrong, or the type.",
                "Move the joint's <origin> onto the hinge or guide and align <axis> with it; if the part slides, or "
                "turns, write that type."
                if limited
                else "Give the joint the limits that the contacts show; or correct its axis, place or type.",
                severity=None if limited else Severity.WARNING,
            )
            return
        if _one_sided(case, sign):
            yield case.remark(
                meeting,
                f"{where} The other way, which is not permitted, it is free up to "
                f"{case.value(case.sweep.travel.rest - sign * case.way(other))}: the joint moves into its parent.",
                "Reverse <axis>, or swap the limits together with their signs.",
            )


def _one_sided(case: MotionCase, sign: float) -> bool:
    """Whether only the blocked side is permitted to speak of, and the other one is free for half of the range."""
    other, travel = case.side(-sign), case.sweep.travel
    permitted = abs(other.declared - travel.rest)
    return permitted < case.scene.settings.early * travel.range and case.way(other) >= 0.5 * travel.range


def beyond_free_travel(case: MotionCase) -> Iterator[Remark]:
    """KV312: a declared end beyond the free travel, to one side; or a range that is far smaller than it."""
    told = any(case.early(case.side(s)) and (case.early(case.side(-s)) or _one_sided(case, s)) for s in case.blocked)
    for sign, meeting in case.blocked.items():
        side, travel = case.side(sign), case.sweep.travel
        beyond = abs(side.declared - meeting.first)
        if told or beyond < case.scene.settings.late * travel.range:
            continue
        end = "upper" if sign > 0 else "lower"
        yield case.remark(
            meeting,
            f"{case.joint} is declared to go to {case.value(side.declared)}, but its child meets its parent at "
            f"{case.value(meeting.first)}: {case.words(meeting)}.",
            f'Write {end}="{meeting.first:.4g}"; if the part should go farther, its axis or its place is wrong.'
            if travel.limited
            else "Give the joint limits, or correct its axis.",
            severity=None if travel.limited else Severity.WARNING,
        )
    yield from _small_range(case)


def _small_range(case: MotionCase) -> Iterator[Remark]:
    travel = case.sweep.travel
    low, high = case.sweep.free
    if travel.limited and 0.0 < travel.range < case.scene.settings.small_range * (high - low):
        yield Remark(
            message=f"{case.joint} is declared over {case.value(travel.range)} only; nothing is in its way over "
            f"{case.value(high - low)}.",
            remedy="Check the unit of the limits; nothing to do if the stop is not modelled.",
            severity=Severity.NOTE,
            joint=case.joint,
            value=travel.range,
            limit=high - low,
            unit=travel.unit,
        )


def into_others(case: MotionCase) -> Iterator[Remark]:
    """KV311: bodies that are not neighbours; the deepest of those that no other joint can clear, or one note."""
    found = [m for side in case.sweep.sides for m in side.meetings if m.pair not in case.sweep.own and m.inside]
    stuck = [meeting for meeting in found if not _clearable(case, meeting)]
    if not found:
        return
    worst = max(stuck or found, key=lambda meeting: meeting.depth)
    more = f" ({len(found) - 1} more pairs meet.)" if len(found) > 1 else ""
    begin = f"Moving {case.joint} alone, {case.words(worst)}, from {case.value(worst.first)} on"
    if stuck:
        yield case.remark(
            worst,
            f"{begin}, wherever the other joints stand.{more}",
            "If one of them carries the other, correct <parent>; otherwise end the range before, or correct the axis.",
            severity=Severity.WARNING,
        )
        return
    yield case.remark(
        worst,
        f"{begin}, unless another joint has moved out of the way before.{more}",
        "Nothing to do; move the other joint first.",
        severity=Severity.NOTE,
    )


def _clearable(case: MotionCase, meeting: Meeting) -> bool:
    """Whether some other joint at one of its ends keeps the two apart where they are deepest."""
    scene = case.scene
    rows = []
    for leader in scene.between(meeting.pair) - {case.sweep.leader}:
        for end in (scene.travels[leader].lower, scene.travels[leader].upper):
            row = scene.mechanism.rest.copy()
            row[case.sweep.leader], row[leader] = meeting.at, end
            rows.append(row)
    if not rows:
        return False
    T = relative(scene.poses(np.array(rows)), meeting.pair)
    hit = case.overlap.collide(meeting.pair, T) | case.overlap.may_contain(meeting.pair, T)
    if not hit.all():
        return True
    allowed = case.allowance.at_rest(meeting.pair) + case.allowance.tolerance(meeting.pair)
    return not meeting.passed and bool((case.overlap.depth(meeting.pair, T) <= allowed).any())


def lost_contact(case: MotionCase) -> Iterator[Remark]:
    """KV320: a child that leaves its parent."""
    scene = case.scene
    limit = scene.settings.lost * scene.size
    gaps = [item for side in case.sweep.sides for item in side.gaps]
    for pair in sorted({pair for pair, _, _ in gaps}):
        gap, value = max((gap, value) for other, gap, value in gaps if other == pair)
        rest = case.allowance.gap(pair)
        if gap - rest <= limit:
            continue
        connection = scene.connection_of[pair]
        parent, child = scene.bodies[connection.parent].name, scene.bodies[connection.child].name
        what = "turns away from its hinge" if case.sweep.travel.turns else "leaves its guide"
        yield Remark(
            message=f"{child} is {length(gap)} away from {parent} at {case.value(value)} of {case.joint} "
            f"({length(rest)} at rest): it {what}.",
            remedy="Align <axis> and <origin> with the hinge or guide, check the type, or reduce the limits.",
            severity=Severity.ERROR if gap - rest > scene.settings.far * scene.size else Severity.WARNING,
            joint=case.joint,
            pair=in_document_order(scene, pair),
            q=configuration(scene, {case.sweep.leader: value}),
            value=gap - rest,
            limit=limit,
            unit="m",
        )


def out_of_guide(case: MotionCase) -> Iterator[Remark]:
    """KV321: a slide whose range is longer than the part of it that is beside its parent.

    What stands on its parent, as a lid does, has no guide, and may be lifted off.
    """
    travel, scene = case.sweep.travel, case.scene
    if travel.turns or not travel.limited:
        return
    for pair in sorted(case.sweep.own):
        connection = scene.connection_of[pair]
        for side in case.sweep.sides:
            way = abs(side.declared - travel.rest)
            guide = _guide(case, connection.parent, connection.child, side)
            if guide <= scene.settings.hover * scene.size or way <= scene.settings.guide * guide:
                continue
            child, parent = scene.bodies[connection.child].name, scene.bodies[connection.parent].name
            yield Remark(
                message=f"{case.joint} slides {child} by {length(way)}, but only {length(guide)} of it stand beside "
                f"{parent} along the axis: at the end of its range it has left it.",
                remedy=f'Write {"upper" if side.sign > 0 else "lower"}="{travel.rest + side.sign * 0.8 * guide:.4g}" '
                "(four fifths of its guide), or correct <axis>.",
                joint=case.joint,
                pair=in_document_order(scene, pair),
                q=configuration(scene, {case.sweep.leader: side.declared}),
                value=way,
                limit=scene.settings.guide * guide,
                unit="m",
            )


def _guide(case: MotionCase, parent: int, child: int, side: Side) -> float:
    """Way after which the trailing end of the child has passed the leading end of the parent [m]."""
    scene = case.scene
    rows = np.tile(scene.mechanism.rest, (2, 1))
    rows[1, case.sweep.leader] = side.declared
    poses = scene.poses(rows)
    motion = poses[1, child, :3, 3] - poses[0, child, :3, 3]
    moved = float(np.linalg.norm(motion))
    if moved == 0.0:
        return 0.0
    along = motion / moved
    ends = [transformed(scene.bodies[body].solid.points, poses[0, body]) @ along for body in (parent, child)]
    return float(ends[0].max() - ends[1].min())
