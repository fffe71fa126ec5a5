"""KV30x to KV33x: collision along the motion, by exact geometry."""

from __future__ import annotations

from kinematify.validation.catalogue.check import Check
from kinematify.validation.finding import Blame, Severity

CHECKS: tuple[Check, ...] = (
    Check(
        id="KV301",
        title="bodies without a joint between them are apart at rest",
        severity=Severity.ERROR,
        blame=Blame.ASSET,
        verifies="Of every pair of bodies that no joint joins (links held together by fixed joints are one body), the "
        "deepest point of one in the other is measured in the exact meshes: above geometry.rest_overlap of the model's "
        "size it is a warning, above geometry.wrong an error if the visible meshes overlap as much. A body inside "
        "another one counts as overlap.",
        matters="Engines push overlapping bodies apart in the first step, with whatever force it takes.",
        remedy="Correct the mesh or its origin; check that both parts hang on the right parent.",
    ),
    Check(
        id="KV302",
        title="parent and child overlap only at their joint",
        severity=Severity.WARNING,
        blame=Blame.ASSET,
        verifies="The deepest point of a part in the one that carries it is less than geometry.rest_joined of the "
        "smaller part's size. Small overlaps at a bearing are common and tolerated from then on.",
        matters="A part that is buried in its parent cannot be judged along its motion, and engines that collide "
        "neighbours push it out.",
        remedy="Correct the mesh or its origin, or cut the hole that the part stands in.",
    ),
    Check(
        id="KV303",
        title="parts touch what carries them",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="At rest, a moving part is less than geometry.hover of the model's size away from the body that its "
        "joint hangs it on.",
        matters="A part in the air often has the wrong parent or the wrong origin.",
        remedy="Check parent and origin of the joint; accept it where the bearing is not modelled.",
    ),
    Check(
        id="KV304",
        title="what is tolerated, and why",
        severity=Severity.NOTE,
        blame=Blame.ASSET,
        verifies="Nothing: it lists the pairs whose contact other checks do not count (joined and in contact at rest, "
        "in contact at rest, in contact in more than geometry.always of all configurations, fixed together), with the "
        "overlap that each may reach, and the links that are judged by their visual geometry.",
        matters="A check that ignores pairs silently can be made to pass by ignoring more of them.",
        remedy="Nothing to do.",
    ),
    Check(
        id="KV310",
        title="a joint does not drive its child into its parent",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Each joint is moved alone, over its range and beyond. A child that gets deeper into its parent than "
        "at rest (geometry.tolerance) before geometry.early of the range is through, to both sides, says that axis, "
        "place or type is wrong; to the only permitted side, with the other one free, that the direction is. "
        "Above geometry.wrong it is an error, unless the joint has no limits, or only the collision geometry meets and "
        "not what is visible.",
        matters="The joint is stuck in every engine, or the part passes through the wall that carries it.",
        remedy="Correct axis and origin, the type, or the direction, as the message says.",
    ),
    Check(
        id="KV311",
        title="a joint does not drive its child into other bodies",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="While each joint moves alone over its range, bodies that are no neighbours do not meet. If another "
        "joint can clear the way (a door before the drawer behind it), it is a note.",
        matters="Parts that always meet hang on the wrong parent, or the range is too wide.",
        remedy="Correct the parent, or end the range before the contact.",
    ),
    Check(
        id="KV312",
        title="limits fit the free travel",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="The range does not end beyond the place where the child meets its parent (by more than "
        "geometry.late of the range): a warning, above geometry.wrong of depth an error, unless the joint has no "
        "limits, or only the collision geometry meets. A rail may go through a solid carriage as it does at rest. A "
        "range below geometry.small_range of the free travel is a note.",
        matters="Controllers drive to the declared end; what they meet before it bends, breaks or explodes.",
        remedy="Write the measured end as the limit.",
    ),
    Check(
        id="KV320",
        title="parts stay with what carries them",
        severity=Severity.ERROR,
        blame=Blame.KINEMATICS,
        verifies="Along the range, the gap between child and parent grows by less than geometry.lost of the model's "
        "size; beyond geometry.far it is an error.",
        matters="A hinge about the wrong line swings the part away from it, and a slide that is too long drops it.",
        remedy="Align axis and origin with the hinge or guide, or reduce the limits.",
    ),
    Check(
        id="KV321",
        title="a slide ends before its guide does",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="A sliding part still stands beside its parent at the end of its range: the way is below "
        "geometry.guide of the length along the axis that both share.",
        matters="A drawer that is pulled out farther than it is long falls, but not in an engine.",
        remedy="Reduce the limit to about four fifths of the guide.",
    ),
    Check(
        id="KV330",
        title="two joints at once",
        severity=Severity.NOTE,
        blame=Blame.KINEMATICS,
        verifies="Every two joints that can bring the same two bodies together are moved over a grid of their values.",
        matters="Doors and drawers that stop one another are common; a planner must know.",
        remedy="Nothing to do.",
    ),
    Check(
        id="KV331",
        title="free configurations of all joints",
        severity=Severity.WARNING,
        blame=Blame.KINEMATICS,
        verifies="Quasi-random configurations of all joints (geometry.random_rows Sobol points); the share that is "
        "free is measured. A warning only if none is.",
        matters="Sampling planners and random resets need free configurations.",
        remedy="Check limits and parents if hardly any is free.",
    ),
    Check(
        id="KV332",
        title="engines' hulls leave the motion free",
        severity=Severity.WARNING,
        blame=Blame.PHYSICS,
        verifies="Where the exact surfaces are clear, so are the convex hulls of the collision shapes, which engines "
        "collide instead (neighbours only if the parent is the base).",
        matters="A drawer in a hollow cabinet is stuck in an engine although nothing is wrong with its joint.",
        remedy="Cut the collision meshes into convex pieces.",
    ),
)
