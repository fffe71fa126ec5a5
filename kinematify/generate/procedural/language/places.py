"""Where parts are, with all joints at their zero: at a place of the whole, on, in, above, between or inside others."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kinematify.assembly.part import Part
    from kinematify.generate.procedural.blueprint import Blueprint
    from kinematify.generate.procedural.language.specification import PartSpecification
    from kinematify.robot.arrays import FloatArray

EDGE = 1e-3  # [m] within which something is as far out as another thing
PLACES = {
    "left": (-1, 0, 0), "right": (1, 0, 0), "top": (0, 0, 1), "upper": (0, 0, 1), "uppermost": (0, 0, 1),
    "bottom": (0, 0, -1), "lower": (0, 0, -1), "lowest": (0, 0, -1), "underside": (0, 0, -1), "underneath": (0, 0, -1),
    "front": (0, -1, 0), "back": (0, 1, 0), "rear": (0, 1, 0), "first": (0, 0, 0),
}  # fmt: skip
"""Words for a place -> where it is, seen from the middle; fronts look along -y."""
MIDDLE = ("middle", "center", "centre", "central", "between")
_SIDE = ("side", "end")
_WITHIN = ("inside", "inner")
_ABOVE = {"above": 1, "over": 1, "below": -1, "under": -1, "beneath": -1, "underneath": -1}
_BEFORE = {"in front of": -1, "behind": 1}
_LOOSE = ("of", "for", "with", "from", "to", "between")
"""Prepositions that say no place beside another part; of all others the parts meet."""
_BESIDE = ("beside", "next", "near", "by")
_NEAR, _FAR = 0.35, 0.3  # of half the whole: so near its middle is central, and so far from it is at a side
_EDGE_SHARE = 0.1  # of a side, near which something is at that side
_MOSTLY = 0.7  # of its box, that is in another box
_TOUCH = 0.02  # [m] between what touches, with handles and gaps


def wrong_place(
    closed: Blueprint, place: str, chosen: Sequence[Part], found: Sequence[Part], *, on_each: bool = False
) -> str | None:
    """Return what is wrong with where parts are; None if they are at a place of the whole.

    Args:
        closed: The object with all joints at their zero.
        place: As in `PLACES`, or a word for the middle, a side, a corner, the inside or the outside.
        chosen: The parts that are meant.
        found: All parts that are called so.
        on_each: On each side.
    """
    bounds = {part.name: part.bounds for part in closed.parts}
    boxes, base = [bounds[part.name] for part in chosen], closed.parts[0].bounds
    aside = np.array([box.mean(axis=0) for box in boxes]) - base.mean(axis=0)
    toward = PLACES.get(place)
    if toward is not None:
        along = aside @ np.array(toward)
        names = {part.name for part in chosen}
        others = [bounds[part.name].mean(axis=0) - base.mean(axis=0) for part in found if part.name not in names]
        if others and any(toward):  # chosen by its place: there the others are not
            return None if along.max() > min(np.array(others) @ np.array(toward)) + EDGE else "none is apart there"
        least = EDGE if toward[0] else -EDGE  # what is in the middle is neither left nor right
        return None if along.max() > least else "elsewhere"
    if len(chosen) < len(found) or place[:1].isdigit():
        return None
    half = np.maximum(0.5 * np.ptp(base, axis=0), EDGE)
    if place in MIDDLE:
        is_there = bool((np.abs(aside.mean(axis=0)) / half < _NEAR)[[0, 2]].any())
    elif place in _SIDE:
        apart = (aside / half > _FAR).any(axis=0) & (aside / half < -_FAR).any(axis=0)
        is_there = all(_reaches(box, base) for box in boxes) and (not on_each or bool(apart[:2].any()))
    elif place == "corner":
        is_there = bool(((np.abs(aside) / half > _FAR).sum(axis=1) > 1).all())
    else:
        within = [share_within(box, base) > _MOSTLY for box in boxes]
        is_there = all(within) if place in _WITHIN else not any(within)
    return None if is_there else "elsewhere"


def wrong_relation(preposition: str, chosen: Sequence[Part], others: Sequence[Part]) -> str | None:
    """Return what is wrong with where parts are, seen from others; None if they are there.

    Args:
        preposition: ``above``, ``in front of``, ``each``: on each of them.
        chosen: The parts that are meant.
        others: The parts that they are above, or in front of; not empty.
    """
    if preposition in _ABOVE:
        sign = _ABOVE[preposition]
        heights = [[sign * float(part.bounds.mean(axis=0)[2]) for part in group] for group in (chosen, others)]
        return None if min(heights[0]) > max(heights[1]) else f"not {preposition} it"
    pairs = [(one, other) for one in chosen for other in others]
    if preposition in _BEFORE:
        return None if any(_is_before(*pair, _BEFORE[preposition]) for pair in pairs) else "elsewhere"
    if preposition == "between" and len(others) > 1:
        middles = np.array([part.bounds.mean(axis=0) for part in others])
        low, high = middles.min(axis=0) + EDGE, middles.max(axis=0) - EDGE
        own = np.array([part.bounds.mean(axis=0) for part in chosen])
        return None if ((low < own) & (own < high)).any(axis=1).all() else "not between them"
    if preposition == "each":
        on_each = all(any(touch(one, other) for one in chosen) for other in others)
        return None if len(chosen) >= len(others) and on_each else f"{len(chosen)} built"
    meet = _is_beside if preposition in _BESIDE else touch
    return None if preposition in _LOOSE or any(meet(*pair) for pair in pairs) else "elsewhere"


def touch(one: Part, other: Part) -> bool:
    """True if the boxes of two parts meet, or nearly so."""
    (low, high), (other_low, other_high) = one.bounds, other.bounds
    return bool((np.minimum(high, other_high) - np.maximum(low, other_low) > -_TOUCH).all())


def mirrored(closed: Blueprint, found: Sequence[Part]) -> str | None:
    """Return what is wrong with two parts that are to be mirror images across a plane from front to back."""
    bounds = {part.name: part.bounds for part in closed.parts}
    boxes = [bounds[part.name] for part in found]
    middle = np.mean([box.mean(axis=0)[0] for box in boxes])
    images = [box[::-1, 0] * -1.0 + 2.0 * middle for box in boxes]
    same = len(boxes) == 2 and np.allclose(images[0], boxes[1][:, 0], atol=EDGE)
    return None if same else "not mirrored"


def chosen_by_place(found: Sequence[Part], part: PartSpecification) -> list[Part]:
    """Those that are meant: of several, the one that is furthest in the place that is said."""
    said = [claim.value for claim in part.claims if claim.about == "place"]
    found = [item for item in found if set(said) & set(item.name.split("_"))] or found
    places = [PLACES[place] for place in said if place in PLACES]
    central = bool(set(MIDDLE) & set(said))
    ordinal = next((place.split(" ") for place in said if place[0].isdigit()), None)
    if not (places or central or ordinal) or part.count is None or part.count >= len(found):
        return list(found)
    middles = np.array([item.bounds.mean(axis=0) for item in found])
    spread = np.where(np.ptp(middles, axis=0) > EDGE, np.ptp(middles, axis=0), 1.0)
    if ordinal:  # counted from the top, or from the left where they stand side by side
        stacked = np.ptp(middles, axis=0)[2] > np.ptp(middles, axis=0)[0]
        toward = PLACES.get(ordinal[1], (0, 0, 1) if stacked else (-1, 0, 0))
        order = np.argsort(-(middles @ np.array(toward, dtype=np.float64)), kind="stable")
        return [found[order[int(ordinal[0]) - 1]]] if int(ordinal[0]) <= len(found) else list(found)
    if central:
        aside = np.linalg.norm((middles - (middles.max(axis=0) + middles.min(axis=0)) / 2.0) / spread, axis=1)
        return [found[k] for k in np.argsort(aside, kind="stable")[: part.count]]
    reach = (middles / spread) @ np.sum(places, axis=0, dtype=np.float64)
    return [found[k] for k in np.argsort(-reach, kind="stable")[: part.count]]


def number_there(closed: Mapping[str, FloatArray], names: Sequence[str], place: str) -> int | None:
    """Return how many parts are at a place and not at the opposite one; None where no place says so.

    Args:
        closed: Middles of parts, shape (3,) each [m].
        names: The parts.
        place: As in `PLACES`.
    """
    toward = np.array(PLACES.get(place, (0, 0, 0)))
    along = np.array([closed[name] for name in names]) @ toward
    if not toward.any() or np.ptp(along) <= EDGE:
        return None
    return int(np.sum(along > (along.max() + along.min()) / 2.0 + EDGE))


def share_within(box: FloatArray, other: FloatArray) -> float:
    """Share of a box that is in another one, by its volume."""
    shared = np.minimum(box[1], other[1]) - np.maximum(box[0], other[0])
    return float(np.prod(np.clip(shared, 0.0, None)) / max(float(np.prod(np.ptp(box, axis=0))), EDGE**3))


def _reaches(box: FloatArray, other: FloatArray) -> bool:
    """True if a box comes near a side of another one, or out of it."""
    near = _EDGE_SHARE * np.ptp(other, axis=0)[:2]
    return bool((np.abs(box[:, :2] - other[:, :2]) < near).any() or share_within(box, other) < _MOSTLY)


def _is_beside(one: Part, other: Part) -> bool:
    """True if two parts meet or are as high, no farther from each other than the larger of them is long."""
    (low, high), (other_low, other_high) = one.bounds, other.bounds
    between = np.maximum(low, other_low) - np.minimum(high, other_high)
    far = max(float((high - low).max()), float((other_high - other_low).max()))
    return touch(one, other) or bool(between[2] < 0.0 and between.max() < far)


def _is_before(one: Part, other: Part, sign: int) -> bool:
    """True if a part is in front of another one (sign -1) or behind it (1), and not beside it."""
    (low, high), (other_low, other_high) = one.bounds, other.bounds
    across = np.minimum(high, other_high) - np.maximum(low, other_low)
    return bool(across[0] > 0.0 and across[2] > 0.0 and sign * (low + high - other_low - other_high)[1] > 0.0)
