"""Request to the library: a family with values, or mechanisms on a body; and how two objects stand together."""

from __future__ import annotations

import difflib
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from kinematify.errors import InputError
from kinematify.generate.composer.attached import attached
from kinematify.generate.composer.compose import compose
from kinematify.generate.composer.recount import recounted
from kinematify.generate.composer.resized import fitted_values, stretched
from kinematify.generate.described import known_families
from kinematify.generate.procedural.family import build
from kinematify.generate.procedural.language.parts import looking, opened
from kinematify.generate.procedural.language.sizes import OVERALL
from kinematify.generate.procedural.language.understand import handle_choice
from kinematify.robot.transforms import rotation_about

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from kinematify.assembly.part import Part
    from kinematify.generate.composer.compose import Composition, MechanismSpec
    from kinematify.generate.composer.resized import Resize
    from kinematify.generate.procedural.blueprint import Blueprint, BlueprintJoint
    from kinematify.generate.procedural.family import Family
    from kinematify.generate.procedural.language.compare import Fitting
    from kinematify.generate.procedural.parameter import Value
    from kinematify.robot.arrays import FloatArray

_SCALES = 3.0  # to so many times the usual size and as much smaller, walls and gaps stay those of such an object
_HELD, _LARGE_SCALES = 0.5, 1.5  # tools are of very different sizes [m]; furniture and vehicles are not
_GAP = 0.05  # between several [m]
_TOY_LENGTH, _TOY_SCALE = 0.4, 0.2  # longest side [m], and at most so much smaller than usual
_BESIDE = 0.3  # between what stands side by side [m]
_LEVEL = 2e-3  # of a surface that something stands on [m]
_GRID = 15  # places along either side at which it is looked for
_STANDS = 0.4  # share of an object's length and depth that it needs to stand on
_HANDS = ("right_hand", "left_hand", "palm")
_GRASP = 5e-4  # between a hand and what it holds [m]


@dataclass(frozen=True, kw_only=True)
class Request:
    """A family with what was asked for."""

    family: str
    values: Mapping[str, Value]
    composition: Composition | None = None
    """Of mechanisms on a body, where no family builds it."""
    added: tuple[MechanismSpec, ...] = ()
    """Mechanisms that such an object has not, and that are put on it where there is a place."""
    counts: tuple[tuple[tuple[str, ...], int], ...] = ()
    """Names of parts, and how many there are to be instead, where there is a place for them."""
    handles: tuple[Fitting, ...] = ()
    """Handles of some parts alone."""
    resized: tuple[Resize, ...] = ()
    """Sizes of parts."""
    looks: tuple[tuple[tuple[str, ...], str, str], ...] = ()
    """Names of parts, and the material or the colour of these alone."""
    opened: tuple[tuple[tuple[str, ...], str, float], ...] = ()
    """Names of parts, and how far these alone are open: see `opened`."""
    overall: tuple[str, float] | None = None
    """A size of the whole [m] that it is scaled to."""
    may_scale: bool = False
    """No size was asked for: it may be larger where a part is to slide farther."""
    copies: int = 1
    """How many, side by side."""
    other: Request | None = None
    """What it holds, stands on or is beside."""
    is_toy: bool = False
    """It is small: all of it is scaled."""
    how: str = ""
    """``holding``, ``on``, ``carrying`` or ``beside`` the other one; not empty if it need not move."""

    def build(self, *, seed: int | None = None) -> Blueprint:
        """Build the object; a seed draws what was not asked for.

        Raises:
            InputError: A value is out of its bounds.
        """
        blueprint = self._large_enough(seed)
        if self.copies > 1:  # of which one may look otherwise, or be open
            width = float(np.ptp(_closed(blueprint).assembly.bounds, axis=0)[0])
            blueprint = blueprint.repeated(self.copies, width + _GAP)
        for names, material, color in self.looks:
            blueprint = looking(blueprint, names, material, color)
        for names, how, much in self.opened:
            with suppress(InputError):  # who compares it with the sentence reports it
                blueprint = opened(blueprint, [name for name in names if name in blueprint.joint_above], how, much)
        if self.is_toy:
            longest = float(np.ptp(_closed(blueprint).assembly.bounds, axis=0).max())
            blueprint = blueprint.scaled(min(max(_TOY_LENGTH / longest, _TOY_SCALE), 1.0))
        return blueprint if self.other is None else _JOINED[self.how](blueprint, self.other.build(seed=seed))

    def _large_enough(self, seed: int | None) -> Blueprint:
        """Build an object whose slides can go as far as `opened` asks, if one is found.

        The side along which a part slides grows if nothing was asked of it, else the whole.
        """
        made = self._single(seed)
        for names, how, much in self.opened:
            slides = [joint for joint in made.joints if joint.child in names and not joint.kind.turns]
            for request in (self, *self._larger(made, slides[0], much)) if how == "range" and slides else ():
                with suppress(InputError):
                    larger = made if request is self else request._single(seed)
                    opened(larger, names, how, much)
                    return larger
        return made

    def _larger(self, made: Blueprint, joint: BlueprintJoint, much: float) -> Iterator[Request]:
        """Requests for larger objects: so much deeper, deeper by that share, larger by that share."""
        there, side = joint.upper - joint.lower, OVERALL[int(np.argmax(np.abs(joint.axis)))]
        now = made.parameters.get(side)
        if isinstance(now, float) and side not in self.values:
            for size in (now + 1.05 * (much - there), 1.05 * now * much / there):
                yield replace(self, values={**self.values, side: size})
        whole = np.ptp(_closed(made).assembly.bounds, axis=0)
        if self.may_scale and much < (_SCALES if whole.max() < _HELD else _LARGE_SCALES) * there:
            yield replace(self, overall=(OVERALL[0], 1.001 * float(whole[0]) * much / there))

    def _single(self, seed: int | None) -> Blueprint:
        if self.composition is not None:
            made = compose(self.composition, seed=seed, may_stand_still=bool(self.how))
        else:
            family = known_families()[self.family]
            values = fitted_values(family, tuple(self.values.items()), seed, self.resized)
            made = build(family, values, seed=seed)
            for fitting in self.handles:
                made = _with_handles(made, family, values, seed, fitting)
        if self.overall is not None:
            made = _scaled_to(made, *self.overall)
        for item in self.resized:
            with suppress(InputError):  # as above
                made = stretched(made, item)
        for names, count in self.counts:
            with suppress(InputError):  # as above
                made = recounted(made, [name for name in names if name in made.joint_above], count)
        for mechanism in self.added:
            with suppress(InputError):  # as above
                made = attached(made, mechanism)
        return made


def _scaled_to(blueprint: Blueprint, size: str, metres: float) -> Blueprint:
    """Return an object that is so wide, deep or high when it is closed.

    Raises:
        InputError: Its joints and walls would be too small or too large for what they are.
    """
    there = float(np.ptp(_closed(blueprint).assembly.bounds, axis=0)[OVERALL.index(size)])
    factor = metres / there
    if not 1.0 / _SCALES <= factor <= _SCALES:
        raise InputError(
            f"The {size} of a {known_families()[blueprint.family].title} cannot be {metres:g} m; it can be from "
            f"{there / _SCALES:.2g} m to {there * _SCALES:.2g} m."
        )
    return blueprint.scaled(factor)


def _with_handles(
    made: Blueprint, family: Family, values: Mapping[str, Value], seed: int | None, fitting: Fitting
) -> Blueprint:
    """Return an object of which some parts are as they would be if all had another handle."""
    names, noun, color, material = fitting
    own = {"handle": handle_choice(family, noun), "handle_color": color, "handle_material": material}
    chosen = {name: value for name, value in own.items() if value}
    like = {part.name: part for part in build(family, {**values, **chosen}, seed=seed).parts}
    if not chosen or not like.keys() >= set(names):
        return made
    said = {f"handle of {name}": " ".join(filter(None, fitting[1:])) for name in names}
    parts = tuple(like[part.name] if part.name in names else part for part in made.parts)
    return replace(made, parts=parts, parameters={**made.parameters, **said})


def _holding(blueprint: Blueprint, held: Blueprint) -> Blueprint:
    """Return an object with another one at the outer side of its hand, its thinnest side towards the hand."""
    hand = hand_of(blueprint)
    bounds = held.assembly.bounds
    thinnest = int(np.argmin(np.ptp(bounds, axis=0)))
    # A turn about x stands what lies; one about z turns what is narrow, its front then looks along x.
    turn = rotation_about(np.eye(3)[0 if thinnest == 2 else 2], 0.0 if thinnest == 1 else 0.5 * np.pi)
    outward = -1.0 if hand.bounds.mean(axis=0)[1] < 0.0 else 1.0
    place = np.eye(4)
    place[:3, :3] = turn
    corners = bounds @ turn.T
    middle, half = corners.mean(axis=0), 0.5 * np.abs(np.ptp(corners, axis=0))
    place[:3, 3] = hand.bounds.mean(axis=0) - middle
    reach = 0.5 * float(np.ptp(hand.bounds, axis=0)[1]) + half[1] + _GRASP
    place[1, 3] += outward * reach
    return blueprint.carrying(held, hand.name, place)


def _standing_on(blueprint: Blueprint, carrier: Blueprint) -> Blueprint:
    """Return an object on the middle of another one.

    Raises:
        InputError: There is no level place of its size.
    """
    bounds, below = blueprint.assembly.bounds, carrier.parts[0].bounds[:, :2]

    def heights_at(places: FloatArray) -> FloatArray:
        return np.array([max(_height(part, place) for part in carrier.parts) for place in places])

    # Where it is level may be less than its bounds: a cart has a push handle behind it.
    over = below[0] + np.ptp(below, axis=0) * (np.indices((_GRID, _GRID)).reshape(2, -1).T + 0.5) / _GRID
    level = _height(carrier.parts[0], below.mean(axis=0))
    flat = over[np.abs(heights_at(over) - level) < _LEVEL] if np.isfinite(level) else over[:0]
    footprint, room = np.ptp(bounds, axis=0)[:2], np.ptp(flat, axis=0) if len(flat) else np.zeros(2)
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2.0 if len(flat) else below.mean(axis=0)
    half = 0.4 * np.minimum(footprint, room)
    heights = heights_at(middle + half * np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]))
    if (room < _STANDS * footprint).any() or not (np.isfinite(heights).all() and np.ptp([*heights, level]) < _LEVEL):
        raise InputError(
            f"There is no level place for a {blueprint.family.replace('_', ' ')} on a "
            f"{carrier.family.replace('_', ' ')}. Ask for them apart."
        )
    place = np.eye(4)
    place[:3, 3] = [*(middle - bounds.mean(axis=0)[:2]), level - bounds[0, 2] + _GRASP]
    on = carrier.carrying(blueprint, carrier.root, place)
    return replace(on, name=blueprint.name, family=blueprint.family)


def _height(part: Part, place: FloatArray) -> float:
    """Highest point of a part above a place x, y; minus infinity where there is none."""
    corners = part.vertices[part.faces]
    a, b, c = (corners[:, k, :2] - place for k in range(3))
    shares = np.stack([p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0] for p, q in ((b, c), (c, a), (a, b))], axis=1)
    total = shares.sum(axis=1)
    inside = (np.abs(total) > 1e-12) & ((shares * np.sign(total)[:, None]) >= 0.0).all(axis=1)
    z = (shares[inside] * corners[inside, :, 2]).sum(axis=1) / total[inside]
    return float(z.max(initial=-np.inf))


def _beside(blueprint: Blueprint, other: Blueprint) -> Blueprint:
    """Return an object with another one on its right, on the same floor."""
    here, there = blueprint.assembly.bounds, other.assembly.bounds
    place = np.eye(4)
    place[:3, 3] = [here[1, 0] + _BESIDE - there[0, 0], (here - there).mean(axis=0)[1], here[0, 2] - there[0, 2]]
    return blueprint.carrying(other, blueprint.root, place)


def hand_of(blueprint: Blueprint) -> Part:
    """Its hand.

    Raises:
        InputError: It has none.
    """
    found = next((part for name in _HANDS for part in blueprint.parts if part.name == name), None)
    if found is None:
        raise InputError(f"A {blueprint.family.replace('_', ' ')} has no hand to hold anything with. Leave that out.")
    return found


def _closed(blueprint: Blueprint) -> Blueprint:
    return blueprint.moved({joint.child: -joint.value for joint in blueprint.joints})


_JOINED: Mapping[str, Callable[[Blueprint, Blueprint], Blueprint]] = {
    "holding": _holding,
    "on": _standing_on,
    "carrying": lambda carrier, other: replace(_standing_on(other, carrier), name=carrier.name, family=carrier.family),
    "beside": _beside,
}


def from_category(name: str, settings: Mapping[str, str]) -> Request:
    """Take a category with settings as they are typed.

    Raises:
        InputError: There is no such category; the message names the nearest.
    """
    return Request(family=find_family(name).name, values=dict(settings))


def find_family(name: str) -> Family:
    """Return the family of a name, in any letter case, with spaces or underscores.

    Raises:
        InputError: There is none; the message names the nearest.
    """
    wanted = name.strip().lower().replace(" ", "_").replace("-", "_")
    families = known_families()
    words = {word.replace(" ", "_"): name for name, family in families.items() for word in (name, *family.words)}
    if wanted in words:
        return families[words[wanted]]
    near = [words[match] for match in difflib.get_close_matches(wanted, words, n=3, cutoff=0.6)]
    hint = f"Did you mean {' or '.join(dict.fromkeys(near))}?" if near else f"There are {', '.join(families)}."
    raise InputError(f"There is no category {name!r}. {hint}")
