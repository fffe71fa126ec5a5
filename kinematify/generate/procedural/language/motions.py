"""Words for how parts move and where to, and whether a joint moves so."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kinematify.robot.joint_type import JointType

if TYPE_CHECKING:
    from collections.abc import Callable

    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.robot.arrays import FloatArray

_VERBS = {
    "slides": "slide extend retract", "turns": "turn rotate pivot twist", "swivels": "swivel",
    "swings": "hinge swing oscillate", "tilts": "tilt recline tip", "flips": "flip", "spins": "spin revolve",
    "folds": "fold collapse unfold", "moves": "move adjust travel", "rises": "lift raise rise", "sinks": "lower drop",
}  # fmt: skip
"""How a part may move -> verbs that say so."""
_DOUBLED = ("flip", "tip", "spin", "swivel", "drop")
"""Verbs whose last letter may be doubled: flipping."""


def _forms(verb: str, ends: tuple[str, ...]) -> set[str]:
    stems = [verb.removesuffix("e"), *([verb + verb[-1]] if verb in _DOUBLED else [])]
    return {stem + end for stem in stems for end in ends}


def _said_of(*ends: str) -> dict[str, str]:
    return {form: moves for moves, verbs in _VERBS.items() for verb in verbs.split() for form in _forms(verb, ends)}


MOTIONS = {
    **{verb + end: moves for moves, verbs in _VERBS.items() for verb in verbs.split() for end in ("", "s")},
    **_said_of("ing", "able", "ible"), "hinged": "swings",
    **dict.fromkeys(("telescopic", "extendable"), "slides"),
    "telescoping": "slides", "rolls": "slides", "roll": "slides", "foldaway": "folds", "rotary": "turns",
    "revolving": "turns", "movable": "moves", "moving": "moves",
}  # fmt: skip
"""Words for how a part moves, before its noun or behind it."""
BARE = frozenset(word for word in MOTIONS if not word.endswith(("s", "ing", "ed", "able", "ible", "ic")))
"""Verbs that a singular noun right before them makes a noun."""
DONE = _said_of("ed")
"""The same behind `can be`."""
PARTICLES = ("drop", "pull", "fold", "swing", "flip", "roll", "lift", "pop", "slide", "tilt", "tip", "push", "hinge")
"""Before a word for where to, they say a motion: `a drop-down door`."""
GOING = ("open", "opens", "opening", "go", "goes", "going", "come", "comes")
"""Verbs that say where to and not how."""
WAYS = {
    "left": (-1, 0, 0), "right": (1, 0, 0), "up": (0, 0, 1), "upward": (0, 0, 1), "down": (0, 0, -1),
    "downward": (0, 0, -1), "out": (0, -1, 0), "outward": (0, -1, 0), "forward": (0, -1, 0), "inward": (0, 1, 0),
    "back": (0, 1, 0), "backward": (0, 1, 0), "vertically": (0, 0, 1), "horizontally": (1, 0, 0),
    "vertical": (0, 0, 1), "horizontal": (1, 0, 0),
}  # fmt: skip
"""Words for where a part goes when it opens; fronts look along -y."""
LINES = ("vertically", "horizontally", "vertical", "horizontal")
"""Of these, those that say a line, and not which way along it."""
_SLANT = 0.2  # of a part's way that must go where it is said to go; a door goes out as much as aside
_QUARTER = 0.5 * math.pi
_FOLDED = math.radians(40.0)  # at least, of what folds
_ABOUT, _LARGE = 0.2, 0.3  # of a part's diagonal from its middle to its axis; of the whole's diagonal


def goes(blueprint: Blueprint, joint: BlueprintJoint, way: str) -> bool:
    """True if a part goes somewhere when it opens."""
    part = next(part for part in blueprint.parts if part.name == joint.child)
    value = min(joint.upper, _QUARTER) if joint.kind.turns else joint.upper
    middle = part.bounds.mean(axis=0)
    moved: FloatArray = (joint.motion(value) @ np.append(middle, 1.0))[:3] - middle
    toward = np.array(WAYS[way], dtype=np.float64)
    if way in ("inward", "outward"):  # across a door or a lid, which is thin there
        thin = np.eye(3)[int(np.argmin(np.ptp(part.bounds, axis=0)))]
        inward = np.sign((blueprint.assembly.bounds.mean(axis=0) - middle) @ thin) * thin
        toward = inward if way == "inward" else -inward
    along = float(moved @ toward)
    return (abs(along) if way in LINES else along) > _SLANT * float(np.linalg.norm(moved)) > 0.0


def turns_about_itself(blueprint: Blueprint, joint: BlueprintJoint) -> bool:
    """True if a large part turns about its middle, as a swivel chair does and a cabinet with a door does not."""
    bounds = next(part for part in blueprint.parts if part.name == joint.child).bounds
    middle, size = bounds.mean(axis=0), float(np.linalg.norm(np.ptp(bounds, axis=0)))
    aside = float(np.linalg.norm(np.cross(joint.axis, middle - joint.pivot)))
    whole = float(np.linalg.norm(np.ptp(blueprint.assembly.bounds, axis=0)))
    return bool(joint.kind.turns) and aside < _ABOUT * size and size > _LARGE * whole


def _lies(joint: BlueprintJoint) -> bool:
    return bool(abs(joint.axis[2]) < _SLANT)


_MOVES: dict[str, Callable[[Blueprint, BlueprintJoint], bool]] = {
    "slides": lambda made, joint: joint.kind is JointType.PRISMATIC,
    "turns": lambda made, joint: joint.kind.turns,
    "swivels": lambda made, joint: joint.kind.turns and not (joint.kind is JointType.CONTINUOUS and _lies(joint)),
    "swings": lambda made, joint: joint.kind is JointType.REVOLUTE,
    "tilts": lambda made, joint: joint.kind is JointType.REVOLUTE and _lies(joint),
    "flips": lambda made, joint: joint.kind.turns and _lies(joint) and "wheel" not in joint.child,
    "spins": lambda made, joint: joint.kind is JointType.CONTINUOUS,
    "folds": lambda made, joint: joint.kind is JointType.REVOLUTE and joint.upper - joint.lower > _FOLDED,
    "moves": lambda made, joint: joint.kind is not JointType.FIXED,
    # What slides up can be lowered again.
    "rises": lambda made, joint: goes(made, joint, "vertically" if joint.kind is JointType.PRISMATIC else "up"),
    "sinks": lambda made, joint: goes(made, joint, "vertically" if joint.kind is JointType.PRISMATIC else "down"),
}


def moves_so(blueprint: Blueprint, joint: BlueprintJoint, how: str) -> bool:
    """True if a joint moves as one of the values of `MOTIONS` says."""
    return _MOVES[how](blueprint, joint)
